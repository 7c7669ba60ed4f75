//! The checked scene from the file's tables.
use std::{
    collections::{BTreeMap, HashMap},
    sync::Arc,
};

use super::{
    Camera, CameraKind, Light, Material, MaterialKind, Object, PathClassError, Scene, Shape, Source, Texture,
    assets::Assets,
    edges,
    error::SceneError,
    file::{CameraFile, Colour, DiffuseFile, Floats, LightFile, MaterialFile, ObjectFile, SceneFile},
    imports::imports,
    index::index,
    light::light,
    load::Files,
    locate::Key,
    motion::Motion,
    motion_files,
    object::object,
    patch,
    sky::sky,
};

/// Parts of a metal's complex index.
const METALS: std::ops::RangeInclusive<f64> = 0.0..=100.0;
/// Sine between a camera's axis and its up vector below which the picture has no upright.
const PARALLEL: f64 = 1e-6;
/// Degrees: fields of view whose tangent single precision still tells from zero and from infinity.
const FIELDS: std::ops::RangeInclusive<f64> = 0.001..=179.9;

/// Checks every value and resolves every name; `source` still lacks its hash.
pub fn build(name: String, file: SceneFile, source: Source, root: &Key, files: &Files) -> Result<Scene, SceneError> {
    let unit = root.key("unit").number(file.unit, 1e-9..=1e9, "metres per unit of length", "1 means metres")?;
    let mut assets = Assets::new(files, &source.resolved);
    let mut materials = each(root, "materials", &file.materials, |key, name, written| {
        Ok(Material { name, kind: material(key, written, &mut assets)? })
    })?;
    let mut lights = each(root, "lights", &file.lights, |key, name, written| {
        Ok(Light { name, kind: light(key, written, unit, &mut assets)? })
    })?;
    let sky = file.sky.as_ref().map(|written| sky(&root.key("sky"), written, &mut assets)).transpose()?;
    let imported = imports(root, &file.imports, unit, &materials, &mut assets)?;
    materials.extend(imported.materials);
    materials.sort_by(|a, b| a.name.cmp(&b.name));
    let mut objects = each(root, "objects", &file.objects, |key, name, written| {
        object(key, name, written, unit, &materials, &mut assets)
    })?;
    let brought: Vec<Object> = resolved(imported.objects, &materials).collect();
    let unplaced: Vec<String> = brought.iter().filter_map(|object| unplaced(object, &materials)).collect();
    objects.extend(brought);
    objects.sort_by(|a, b| a.name.cmp(&b.name));
    lights.extend(imported.lights);
    lights.sort_by(|a, b| a.name.cmp(&b.name));
    let (region, extent) = patch::regions(root, &file.region, file.extent.as_ref(), unit, (&objects, &materials))?;
    let mut scene = Scene {
        name,
        title: file.title,
        source: Source { hash: assets.hash(), ..source },
        paths: file.paths.parse().map_err(|error: PathClassError| {
            let classes = "reflect-1, transmit-1, transmit-2 or all:N";
            root.key("paths").fault(classes, format!("`{}`", error.0), "name the class of the scene's caustic")
        })?,
        region,
        extent,
        exposure: root.key("exposure").number(
            file.exposure,
            -64.0..=64.0,
            "an exposure in EV",
            "0 is plain, each EV doubles",
        )?,
        cameras: cameras(&root.key("cameras"), &file.cameras, unit)?,
        warnings: [imported.warnings, unplaced, assets.warnings, edges::warnings(&objects, &materials)].concat(),
        imports: imported.imports,
        objects,
        materials,
        lights,
        sky,
        time: 0.0,
        motion: None,
    };
    scene.cameras.extend(imported.cameras);
    scene.cameras.insert("region".to_owned(), patch::camera(&scene));
    scene.motion = motion(&scene, &file.objects, &file.lights, root, unit)?.map(Arc::new);
    Ok(scene.at(0.0))
}

/// How it moves, if anything does.
fn motion(
    scene: &Scene,
    objects: &BTreeMap<String, ObjectFile>,
    lights: &BTreeMap<String, LightFile>,
    root: &Key,
    unit: f64,
) -> Result<Option<Motion>, SceneError> {
    let mut motion = Motion { objects: Vec::new(), lights: Vec::new(), hash: scene.source.hash.clone() };
    for (index, object) in scene.objects.iter().enumerate() {
        // What is imported stands still.
        let Some(file) = objects.get(&object.name) else { continue };
        let key = root.key("objects").key(&object.name);
        let moved = motion_files::object(&key, object, file, index == scene.region.receiver, unit)?;
        motion.objects.extend(moved.map(|moved| (index, moved)));
    }
    for (index, light) in scene.lights.iter().enumerate() {
        let Some(file) = lights.get(&light.name) else { continue };
        let moved = motion_files::light(&root.key("lights").key(&light.name), light, file, unit)?;
        motion.lights.extend(moved.map(|moved| (index, moved)));
    }
    Ok((!motion.objects.is_empty() || !motion.lights.is_empty()).then_some(motion))
}

/// The objects, each with the index of the material that it was given by name.
fn resolved(objects: Vec<(Object, String)>, materials: &[Material]) -> impl Iterator<Item = Object> {
    let index: HashMap<&str, usize> = materials.iter().enumerate().map(|(k, m)| (m.name.as_str(), k)).collect();
    objects.into_iter().map(move |(object, name)| Object { material: index[name.as_str()], ..object })
}

/// What must be known of an imported mesh that has a texture, its own or the scene's, and no texture coordinates.
fn unplaced(object: &Object, materials: &[Material]) -> Option<String> {
    let textured = matches!(materials[object.material].kind, MaterialKind::Diffuse { texture: Some(_), .. });
    let Shape::Mesh { mesh, .. } = &object.shape else { return None };
    (textured && mesh.coordinates.is_empty())
        .then(|| format!("`{}` has a texture and no texture coordinates: it shows one place of it", object.name))
}

/// One thing for each table under `kind`, in the order of their names.
fn each<F, T>(
    root: &Key,
    kind: &str,
    files: &BTreeMap<String, F>,
    mut make: impl FnMut(&Key, String, &F) -> Result<T, SceneError>,
) -> Result<Vec<T>, SceneError> {
    files.iter().map(|(name, file)| make(&root.key(kind).key(name), name.clone(), file)).collect()
}

fn material(key: &Key, file: &MaterialFile, assets: &mut Assets) -> Result<MaterialKind, SceneError> {
    match (&file.diffuse, &file.dielectric, &file.mirror, &file.conductor) {
        (Some(diffuse), None, None, None) => self::diffuse(&key.key("diffuse"), diffuse, assets),
        (None, Some(dielectric), None, None) => {
            let key = key.key("dielectric");
            Ok(MaterialKind::Dielectric {
                ior: index(&key.key("ior"), &dielectric.ior)?,
                absorption: key.key("absorption").strength(dielectric.absorption, "an absorption in 1/m")?,
            })
        }
        (None, None, Some(mirror), None) => {
            let reflectance = key.key("mirror").key("reflectance").share(mirror.reflectance)?;
            Ok(MaterialKind::Mirror { reflectance })
        }
        (None, None, None, Some(metal)) => {
            let key = key.key("conductor");
            let part = |name: &str, value: Colour| {
                let key = key.key(name);
                let remedy = "gold has about eta 0.4 and k 2.4 in green, silver 0.06 and 3.6";
                value
                    .0
                    .iter()
                    .try_for_each(|&band| key.number(band, METALS, "part of a complex index", remedy).map(drop))?;
                Ok(value.0)
            };
            Ok(MaterialKind::Conductor { eta: part("eta", metal.eta)?, k: part("k", metal.k)? })
        }
        _ => Err(key.one_kind(&["diffuse", "dielectric", "mirror", "conductor"])),
    }
}

fn diffuse(key: &Key, file: &DiffuseFile, assets: &mut Assets) -> Result<MaterialKind, SceneError> {
    if file.albedo.is_none() && file.texture.is_none() {
        return Err(key.key("albedo").fault("the key `albedo`, or a `texture`", "none", "add it"));
    }
    let albedo = key.key("albedo").share(file.albedo.unwrap_or(Colour([1.0; 3])))?;
    let texture =
        file.texture.as_ref().map(|name| Texture::new(key, assets.picture(&key.key("texture"), name)?, file.repeat));
    if texture.is_none() && file.repeat.is_some() {
        let remedy = "add `texture`, or take `repeat` out";
        return Err(key.key("repeat").fault("a texture to repeat", "none", remedy));
    }
    Ok(MaterialKind::Diffuse { albedo, texture: texture.transpose()? })
}

fn cameras(key: &Key, files: &BTreeMap<String, CameraFile>, unit: f64) -> Result<BTreeMap<String, Camera>, SceneError> {
    if !files.contains_key("main") {
        let remedy = "add `[cameras.main.pinhole]`: it makes the picture";
        return Err(key.fault("a camera called `main`", "none", remedy));
    }
    files.iter().map(|(name, file)| Ok((name.clone(), camera(&key.key(name), file, unit)?))).collect()
}

fn camera(key: &Key, file: &CameraFile, unit: f64) -> Result<Camera, SceneError> {
    match (&file.pinhole, &file.orthographic) {
        (Some(c), None) => {
            let key = key.key("pinhole");
            let kind = CameraKind::Pinhole {
                fov_y: key.key("fov_y").number(c.fov_y, FIELDS, "a field of view in degrees", "40 is usual")?,
            };
            aimed(&key, kind, [c.position, c.target, c.up], unit, c.hides_specular)
        }
        (None, Some(c)) => {
            let key = key.key("orthographic");
            let height = key.key("height").size(c.height, unit)?;
            let width = c.width.map(|width| key.key("width").size(width, unit)).transpose()?;
            aimed(
                &key,
                CameraKind::Orthographic { height, width },
                [c.position, c.target, c.up],
                unit,
                c.hides_specular,
            )
        }
        _ => Err(key.one_kind(&["pinhole", "orthographic"])),
    }
}

fn aimed(
    key: &Key,
    kind: CameraKind,
    [position, target, up]: [Floats<3>; 3],
    unit: f64,
    hides_specular: bool,
) -> Result<Camera, SceneError> {
    let position = key.key("position").point(position, unit)?;
    let target = key.key("target").point(target, unit)?;
    let up = key.key("up").direction(up)?;
    let Some(forward) = (target - position).try_normalize() else {
        let remedy = "move one of the two";
        return Err(key.key("target").fault("a target away from the position", "the camera's own position", remedy));
    };
    if forward.cross(up).length() < PARALLEL {
        let remedy = "choose another up vector, such as [0, 0, -1] for a camera that looks down";
        return Err(key.key("up").fault("a vector across the line of sight", "one along it", remedy));
    }
    Ok(Camera { kind, position, target, up, hides_specular })
}
