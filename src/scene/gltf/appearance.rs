//! Materials, lights and cameras of a file as ours.
use std::ops::RangeInclusive;

use glam::{DAffine3, DVec3};

use super::{Document, GltfFault, fault, json, named, names, textures::textured};
use crate::scene::{Beam, Camera, CameraKind, LightKind, MaterialKind};

/// Metals are mirrors from here on, others from here down: there is nothing between the two.
const METAL: f64 = 0.5;
/// What is rougher sends a beam back so wide (half of it beyond 14°) that a diffuse surface is nearer to it than a mirror.
const ROUGH: f64 = 0.5;
/// Of glass: what the specification says where a file says nothing.
const IOR: f64 = 1.5;
/// 1/m: the most that a scene may write. A colour of 0 would be absorbed without end.
const BLACKEST: f64 = 1e12;
const SHARE: RangeInclusive<f64> = 0.0..=1.0;
/// W/m² or W/sr, as in a scene file.
const STRENGTHS: RangeInclusive<f64> = 0.0..=1e12;
/// Degrees, as in a scene file.
const FIELDS: RangeInclusive<f64> = 0.001..=179.9;
const CORRECT: &str = "correct it, or export the file again";

/// A material as ours, and what of it is left out.
pub struct Look {
    pub kind: MaterialKind,
    pub missing: Vec<String>,
}

impl Document {
    /// The name of a material as it is shown; that of primitives without one is `default`.
    pub fn material_name(&self, index: Option<usize>) -> String {
        let Some(index) = index else { return "default".to_owned() };
        names::shown(self.json.materials.get(index).and_then(|m| m.name.as_deref()), "material", index)
    }

    /// Of every material.
    pub fn material_names(&self) -> Vec<String> {
        (0..self.json.materials.len()).map(Some).chain([None]).map(|index| self.material_name(index)).collect()
    }
}

fn within(path: String, value: f64, range: RangeInclusive<f64>, what: &str) -> Result<f64, GltfFault> {
    if range.contains(&value) {
        return Ok(value);
    }
    Err(fault(path, format!("{what} from {} to {:e}", range.start(), range.end()), value.to_string(), CORRECT))
}

/// A material; without one it is the specification's. `scale` is in metres a unit of the file.
pub fn look(document: &Document, index: Option<usize>, scale: f64) -> Result<Look, GltfFault> {
    let default = json::Material::default();
    let written = match index {
        Some(index) => named(&document.json.materials, index, "materials", "materials")?,
        None => &default,
    };
    let path = index.map_or("the default material".to_owned(), |index| format!("materials[{index}]"));
    let pbr = &written.pbr_metallic_roughness;
    let of_pbr = |name: &str| format!("{path}.pbrMetallicRoughness.{name}");
    let [red, green, blue, alpha] = pbr.base_color_factor;
    let colour = [red, green, blue];
    for share in pbr.base_color_factor {
        within(of_pbr("baseColorFactor"), share, SHARE, "shares of light")?;
    }
    let metallic = within(of_pbr("metallicFactor"), pbr.metallic_factor, SHARE, "a share")?;
    let roughness = within(of_pbr("roughnessFactor"), pbr.roughness_factor, SHARE, "a roughness")?;
    let transmission = written.extensions.transmission.as_ref();
    let of_extension = |name: &str| format!("{path}.extensions.KHR_materials_{name}");
    let clear = transmission.map_or(0.0, |transmission| transmission.transmission_factor);
    within(of_extension("transmission"), clear, SHARE, "a share of light let through")?;
    let mut missing = textures(written);
    let mut lacks = |lacks: bool, what: String| missing.extend(lacks.then_some(what));
    let kind = if metallic >= METAL && roughness < ROUGH {
        lacks(metallic < 1.0, format!("what of it is no metal (metallic {metallic})"));
        lacks(roughness > 0.0, format!("its roughness {roughness}"));
        MaterialKind::Mirror { reflectance: colour }
    } else if metallic < METAL && clear > 0.0 {
        lacks(clear < 1.0, format!("what it does not let through (transmission {clear})"));
        lacks(metallic > 0.0, format!("what of it is metal (metallic {metallic})"));
        lacks(roughness > 0.0, format!("its roughness {roughness}"));
        lacks(colour != [1.0; 3], "the tint of its surface (base colour)".to_owned());
        let thick = written.extensions.volume.as_ref().is_some_and(|volume| volume.thickness_factor > 0.0);
        lacks(!thick, "the thinness of a wall (no thickness is given: it is solid)".to_owned());
        let ior = written.extensions.ior.as_ref().and_then(|ior| ior.ior).unwrap_or(IOR);
        within(of_extension("ior"), ior, 1.0..=10.0, "an index of refraction")?;
        let absorption = absorption(&of_extension("volume"), written.extensions.volume.as_ref(), scale)?;
        MaterialKind::Dielectric { ior: [ior; 3], absorption }
    } else {
        let metal = metallic >= METAL;
        lacks(metal && index.is_some(), format!("being a rough metal (roughness {roughness})"));
        lacks(!metal && roughness < ROUGH, format!("its gloss (roughness {roughness})"));
        MaterialKind::Diffuse { albedo: colour, texture: None }
    };
    lacks(written.alpha_mode != "OPAQUE" && alpha < 1.0, format!("its transparency (alpha {alpha})"));
    lacks(written.emissive_factor != [0.0; 3], "the light that it gives".to_owned());
    let kind = match (kind, &pbr.base_color_texture) {
        (MaterialKind::Diffuse { albedo, .. }, Some(info)) => {
            let (kind, lost) = textured(document, albedo, info, &of_pbr("baseColorTexture"))?;
            missing.extend(lost);
            kind
        }
        (kind, Some(_)) => {
            missing.push("its base colour texture (diffuse surfaces alone show one)".to_owned());
            kind
        }
        (kind, None) => kind,
    };
    missing.extend(written.extensions.others.keys().map(|name| format!("{name:?}")));
    Ok(Look { kind, missing })
}

/// Those of a material that are not read.
fn textures(written: &json::Material) -> Vec<String> {
    let (pbr, extensions) = (&written.pbr_metallic_roughness, &written.extensions);
    let all = [
        ("metallic and roughness", pbr.metallic_roughness_texture.is_some()),
        ("normal", written.normal_texture.is_some()),
        ("emission", written.emissive_texture.is_some()),
        ("transmission", extensions.transmission.as_ref().is_some_and(|t| t.transmission_texture.is_some())),
    ];
    all.into_iter().filter(|(_, there)| *there).map(|(name, _)| format!("its {name} texture (not read)")).collect()
}

/// −ln(colour)/distance of each band, 1/m.
fn absorption(path: &str, volume: Option<&json::Volume>, scale: f64) -> Result<[f64; 3], GltfFault> {
    let Some(volume) = volume else { return Ok([0.0; 3]) };
    within(format!("{path}.thicknessFactor"), volume.thickness_factor, 0.0..=f64::MAX, "a thickness")?;
    let colour = volume.attenuation_color.unwrap_or([1.0; 3]);
    for share in colour {
        within(format!("{path}.attenuationColor"), share, SHARE, "shares of light")?;
    }
    let Some(distance) = volume.attenuation_distance else { return Ok([0.0; 3]) };
    within(format!("{path}.attenuationDistance"), distance, f64::MIN_POSITIVE..=f64::MAX, "a distance")?;
    // A band that nothing takes from must not become 0/0, nor −0, however short the distance.
    let band = |share: f64| if share < 1.0 { (-share.ln() / (distance * scale)).clamp(0.0, BLACKEST) } else { 0.0 };
    Ok(colour.map(band))
}

/// A light of a node whose map to the world, in metres, is given; and whether it says how far it reaches, which is not read.
pub fn light(
    document: &Document,
    index: usize,
    used_at: &str,
    world: &DAffine3,
    watts_per_lumen: f64,
) -> Result<(LightKind, bool), GltfFault> {
    let lights = document.json.extensions.lights.as_ref().map_or(&[][..], |lights| lights.lights.as_slice());
    let written = named(lights, index, used_at, "lights")?;
    let path = format!("extensions.KHR_lights_punctual.lights[{index}]");
    let (intensity, colour) = (written.intensity.unwrap_or(1.0), written.color.unwrap_or([1.0; 3]));
    let power = colour.map(|band| band * intensity * watts_per_lumen);
    for band in power {
        within(format!("{path}.intensity"), band, STRENGTHS, "a strength in W/m² or W/sr")?;
    }
    let position = world.translation;
    // A point has none, and its node may be scaled to nothing.
    let axis = || direction(used_at, world, DVec3::NEG_Z);
    let kind = match written.kind.as_str() {
        "directional" => LightKind::Directional { direction: axis()?, irradiance: power },
        "point" => LightKind::Point { position, intensity: power },
        "spot" => {
            let quarter = 0.5 * std::f64::consts::PI;
            let cone = &written.spot;
            let outer = format!("{path}.spot.outerConeAngle");
            // Half a degree over a quarter turn: exporters round.
            let outer = within(outer, cone.outer_cone_angle, 2e-5..=quarter + 0.01, "a half angle in radians")?;
            let inner = format!("{path}.spot.innerConeAngle");
            let inner = within(inner, cone.inner_cone_angle, 0.0..=outer, "a half angle in radians")?;
            let height = |angle: f64| 2.0 * (0.5 * angle).sin().powi(2);
            let beam = Beam { axis: axis()?, inner: height(inner), outer: height(outer) };
            LightKind::Spot { position, intensity: power, beam, slide: None }
        }
        other => {
            let expected = "directional, point or spot";
            return Err(fault(format!("{path}.type"), expected, format!("{other:?}"), CORRECT));
        }
    };
    Ok((kind, written.range.is_some()))
}

/// A camera of a node; it looks at the point of its axis that is nearest to `center`, or a metre ahead.
pub fn camera(
    document: &Document,
    index: usize,
    used_at: &str,
    (world, scale): (&DAffine3, f64),
    center: Option<DVec3>,
) -> Result<Camera, GltfFault> {
    let written = named(&document.json.cameras, index, used_at, "cameras")?;
    let path = format!("cameras[{index}]");
    let kind = match (&written.perspective, &written.orthographic) {
        (Some(perspective), None) => {
            let degrees = perspective.yfov.to_degrees();
            let fov_y = within(format!("{path}.perspective.yfov"), degrees, FIELDS, "a field of view, in degrees")?;
            CameraKind::Pinhole { fov_y }
        }
        (None, Some(orthographic)) => {
            let height = 2.0 * orthographic.ymag.abs() * scale;
            let what = "half a height, in metres twice it";
            within(format!("{path}.orthographic.ymag"), height, 1e-9..=1e9, what)?;
            CameraKind::Orthographic { height, width: None }
        }
        _ => {
            let expected = "one of perspective and orthographic";
            return Err(fault(path, expected, "none or both", CORRECT));
        }
    };
    let (forward, up) = (direction(used_at, world, DVec3::NEG_Z)?, direction(used_at, world, DVec3::Y)?);
    let ahead = center.map(|center| (center - world.translation).dot(forward)).filter(|ahead| *ahead > scale);
    let target = world.translation + forward * ahead.unwrap_or(scale);
    Ok(Camera { kind, position: world.translation, target, up, hides_specular: false })
}

fn direction(path: &str, world: &DAffine3, axis: DVec3) -> Result<DVec3, GltfFault> {
    let along = world.transform_vector3(axis).try_normalize();
    along.ok_or_else(|| fault(path, "a node that is not scaled to nothing", "one that is", CORRECT))
}
