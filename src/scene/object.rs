//! Objects: shapes checked, and put in place.
use glam::{DAffine3, DVec3};

use super::{
    Material, Object, Shape,
    assets::{Assets, BESIDE},
    error::SceneError,
    file::{Floats, MeshFile, ObjectFile, QuadFile, SphereFile},
    locate::Key,
    picture,
    sea_files::{self, SeaFile, SeaSheet},
    shape_files::{self, SineFile},
    sheet_files::{self, HeightsFile, WaveFile, WaveSheet},
};

/// Cosine between a quad's edges that passes for a right angle: the rounding of decimal numbers in a file.
const SQUARE: f64 = 1e-6;
/// A mesh's largest side in its own units: beyond these its scale overflows single precision.
const SIDES: std::ops::RangeInclusive<f64> = 1e-15..=1e15;

pub fn object(
    key: &Key,
    name: String,
    file: &ObjectFile,
    unit: f64,
    materials: &[Material],
    assets: &mut Assets,
) -> Result<Object, SceneError> {
    let names = materials.iter().map(|material| material.name.as_str());
    let material = key.key("material").resolve("a material", &file.material, names)?;
    let shape = shape(key, file, unit, assets)?;
    shape_files::refuse_open_shell(key, &shape, &materials[material])?;
    picture::refuse_no_coordinates(&key.key("material"), &shape, &materials[material])?;
    Ok(Object { name, shape, material, visible_to_camera: file.visible_to_camera })
}

/// Of shapes.
const KINDS: [&str; 11] =
    ["sphere", "quad", "box", "disk", "cylinder", "paraboloid", "sine", "heights", "wave", "sea", "mesh"];

/// Of the one kind that is given.
fn shape(key: &Key, file: &ObjectFile, unit: f64, assets: &mut Assets) -> Result<Shape, SceneError> {
    let kinds = [
        file.sphere.as_ref().map(|written| sphere(&key.key("sphere"), written, unit)),
        file.quad.as_ref().map(|written| quad(&key.key("quad"), written, unit)),
        file.r#box.as_ref().map(|written| shape_files::cuboid(&key.key("box"), written, unit)),
        file.disk.as_ref().map(|written| shape_files::disk(&key.key("disk"), written, unit)),
        file.cylinder.as_ref().map(|written| shape_files::cylinder(&key.key("cylinder"), written, unit)),
        file.paraboloid.as_ref().map(|written| shape_files::paraboloid(&key.key("paraboloid"), written, unit)),
        file.sine.as_ref().map(|written| sine(&key.key("sine"), written, unit)),
        file.heights.as_ref().map(|written| heights(&key.key("heights"), written, unit, assets)),
        file.wave.as_ref().map(|written| Ok(wave(&key.key("wave"), written, unit)?.at(0.0))),
        file.sea.as_ref().map(|written| Ok(sea(&key.key("sea"), written, unit)?.at(0.0))),
        file.mesh.as_ref().map(|written| mesh(&key.key("mesh"), written, unit, assets)),
    ];
    let mut given = kinds.into_iter().flatten();
    match (given.next(), given.next()) {
        (Some(shape), None) => shape,
        _ => Err(key.one_kind(&KINDS)),
    }
}

fn sphere(key: &Key, file: &SphereFile, unit: f64) -> Result<Shape, SceneError> {
    let center = key.key("center").point(file.center, unit)?;
    Ok(Shape::Sphere { center, radius: key.key("radius").size(file.radius, unit)? })
}

fn quad(key: &Key, file: &QuadFile, unit: f64) -> Result<Shape, SceneError> {
    let [center, u, v] = rectangle(key, [file.center, file.u, file.v], unit)?;
    Ok(Shape::Quad { center, u, v })
}

fn sine(key: &Key, file: &SineFile, unit: f64) -> Result<Shape, SceneError> {
    let sheet = rectangle(key, [file.center, file.u, file.v], unit)?;
    shape_files::sine(key, file, sheet, unit)
}

fn heights(key: &Key, file: &HeightsFile, unit: f64, assets: &mut Assets) -> Result<Shape, SceneError> {
    let sides = rectangle(key, [file.center, file.u, file.v], unit)?;
    let bytes = assets.bytes(&key.key("file"), &file.file, "a readable picture", BESIDE)?;
    sheet_files::heights(key, file, &bytes, sides, unit)
}

pub fn wave(key: &Key, file: &WaveFile, unit: f64) -> Result<WaveSheet, SceneError> {
    let sides = rectangle(key, [file.center, file.u, file.v], unit)?;
    sheet_files::wave(key, file, sides, unit)
}

pub fn sea(key: &Key, file: &SeaFile, unit: f64) -> Result<SeaSheet, SceneError> {
    let sides = rectangle(key, [file.center, file.u, file.v], unit)?;
    sea_files::sea(key, file, sides, unit)
}

/// Centre and half edges at right angles.
pub fn rectangle(key: &Key, [center, u, v]: [Floats<3>; 3], unit: f64) -> Result<[DVec3; 3], SceneError> {
    let center = key.key("center").point(center, unit)?;
    let (u, v) = (key.key("u").edge(u, unit)?, key.key("v").edge(v, unit)?);
    let cosine = u.normalize().dot(v.normalize());
    if cosine.abs() > SQUARE {
        let found = format!("an angle of {:.3}°", cosine.acos().to_degrees());
        return Err(key.key("v").fault("a half edge at right angles to `u`", found, "turn one of the two"));
    }
    Ok([center, u, v])
}

/// Scaled so that its largest side, before it is turned, is `fit`; turned about x, then y, then z; its box then rests
/// on `center`.
fn mesh(key: &Key, file: &MeshFile, unit: f64, assets: &mut Assets) -> Result<Shape, SceneError> {
    let mesh = assets.mesh(&key.key("file"), &file.file)?;
    let fit = key.key("fit").size(file.fit, unit)?;
    let center = key.key("center").point(file.center, unit)?;
    let side = mesh.bounds(|p| p).map_or(0.0, |[low, high]| (high - low).max_element());
    // A mesh of one point, or of none, has no size to fit.
    let scale = if side == 0.0 { unit } else { fit / usable_side(key, side)? };
    let linear = shape_files::turned(&key.key("rotate"), file.rotate)? * scale;
    let base = mesh.bounds(|p| linear * p).map_or(DVec3::ZERO, |[low, high]| (0.5 * (low + high)).with_y(low.y));
    Ok(Shape::Mesh { mesh, to_world: DAffine3::from_mat3_translation(linear, center - base) })
}

fn usable_side(key: &Key, side: f64) -> Result<f64, SceneError> {
    key.key("file").number(side, SIDES, "a mesh with a largest side", "scale the mesh in its file")
}
