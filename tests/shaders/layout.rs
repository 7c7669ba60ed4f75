//! Host and shader agree about every shared structure: SPIR-V member offsets against `offset_of!`.

use nephroid::{
    gpu::{Reflection, Sources},
    passes::{
        accel,
        account::AccountRow,
        eye::FrameData,
        sky::{SkyGradient, SkyImage},
        water::{RippleData, WaterData, WaterSine, WaterVertex, WaterWave},
    },
    store::Store,
    view::ViewData,
};
use std::{collections::BTreeMap, mem::offset_of};

/// Offsets of the members of a host structure, under the shader's name for it.
macro_rules! host {
    ($shader:literal, $ty:ty { $($member:ident),* $(,)? }) => {
        ($shader, vec![$((stringify!($member), offset_of!($ty, $member))),*])
    };
}

#[test]
fn offsets_agree() {
    let host = [
        host!("Node", accel::Node { corners, reference }),
        host!("Triangle", accel::Triangle { a, b, c }),
        host!("TriangleNormals", accel::TriangleNormals { a, b, c }),
        host!("Instance", accel::Instance { to_object, to_world, kind, material, object, detail, phase }),
        host!("Material", accel::Material { kind, ior, colour, absorption, texture }),
        host!("Slide", accel::Slide { first, size, right, up }),
        host!("Texture", accel::Texture { first, size, repeat }),
        host!("TriangleCoordinates", accel::TriangleCoordinates { a, b, c }),
        host!("Light", accel::Light { kind, vector, power, media, axis, inner, outer, slide }),
        host!("AccountRow", AccountRow { counts, bent, flux, other, absorbed }),
        host!("FrameData", FrameData { eye, time, index, seed, eye_media }),
        host!("Water", WaterData { center, u, v, n, half_size, ior }),
        host!("WaterSine", WaterSine { amplitude, number, phase }),
        host!("WaterWave", WaterWave { middle, unit, phase, wave_size, factor, vertex_size, octaves }),
        host!("WaterVertex", WaterVertex { height, normal }),
        host!("Ripple", RippleData { number, amplitude, phase }),
        host!("SkyGradient", SkyGradient { up, zenith, horizon, ground }),
        host!("SkyImage", SkyImage { size, right, up, ahead }),
        host!("View", ViewData { origin, x0, right, x1, up, y0, forward, y1, near, far, perspective, pad }),
    ];
    let defines: Vec<_> = [
        ("EVENTS", "2"),
        ("REFLECT", "0"),
        ("LIGHT_COUNT", "1"),
        ("HAS_QUADS", "1"),
        ("HAS_MESHES", "1"),
        ("HAS_TEXTURES", "1"),
        ("HAS_SLIDES", "1"),
        ("HAS_SLIDES", "1"),
        ("HAS_COORDINATES", "1"),
    ]
    .map(|(a, b)| (a.to_owned(), b.to_owned()))
    .to_vec();
    let provided = [("capture.glsl", "maps/capture.glsl"), ("raster_view.glsl", "eye/raster_view.glsl")]
        .map(|(a, b)| (a.to_owned(), b.to_owned()));
    let mut seen: BTreeMap<(String, String), usize> = BTreeMap::new();
    let plain = ["light/account.comp", "eye/direct.frag", "eye/gbuffer.vert"].map(|file| (file, Vec::new()));
    let waters = ["WATER_SINE", "WATER_WAVE", "WATER_SEA", "WATER_HEIGHTS"].map(|kind| {
        let grid = [("ACROSS", "4u"), ("ALONG", "4u"), ("LEVELS", "1"), ("OFFSETS", "0u"), ("BOUNDS_ALL", "1u")];
        let more = [(kind, "1"), ("WATER_ACROSS", "4u"), ("WATER_ALONG", "4u")].into_iter().chain(grid);
        ("waves/inverse_rays.comp", more.map(|(a, b)| (a.to_owned(), b.to_owned())).collect())
    });
    let skies = ["SKY_GRADIENT", "SKY_IMAGE"].map(|kind| ("eye/sky.frag", vec![("SKY".to_owned(), kind.to_owned())]));
    for (file, more) in plain.into_iter().chain(waters).chain(skies) {
        let defines = [defines.clone(), more].concat();
        let words = Sources::default().compile(file, &defines, &provided, &Store::none()).unwrap();
        for m in Reflection::of(&words).unwrap().members {
            let before = seen.insert((m.structure.clone(), m.member.clone()), m.offset);
            assert!(before.is_none_or(|b| b == m.offset), "{file}: {}.{} moves", m.structure, m.member);
        }
    }
    for (structure, members) in host {
        for (member, offset) in members {
            let shader = seen.get(&(structure.to_owned(), member.to_owned()));
            assert_eq!(shader, Some(&offset), "{structure}.{member}: shader, host");
        }
        let count = seen.keys().filter(|(s, _)| s == structure).count();
        assert!(count > 0, "{structure} is in no shader");
    }
}
