//! What is in a scene: enough to choose it, and to know what its pictures will show.

use std::collections::BTreeMap;

use glam::DVec3;
use serde::Serialize;

use super::{Cell, Report, Table};
use crate::{
    metrics::bare_irradiance,
    scene::{Camera, CameraKind, Import, LightKind, Material, MaterialKind, Region, Scene, Shape, Sky},
};

/// One scene.
#[derive(Debug, Serialize)]
pub struct SceneReport {
    schema: &'static str,
    name: String,
    title: String,
    file: String,
    hash: String,
    /// What counts as the caustic.
    class: String,
    exposure_ev: f64,
    moves: bool,
    /// First and last time of a key.
    keyed_s: Option<[f64; 2]>,
    /// How bright the region is without the specular objects.
    e0_w_m2: f64,
    region: RegionRow,
    objects: Vec<ObjectRow>,
    materials: Vec<MaterialRow>,
    lights: Vec<LightRow>,
    sky: Option<SkyRow>,
    cameras: Vec<CameraRow>,
    imports: Vec<ImportRow>,
    warnings: Vec<String>,
}

#[derive(Debug, Serialize)]
struct RegionRow {
    receiver: String,
    center_m: [f64; 3],
    /// Whole edges.
    size_m: [f64; 2],
}

#[derive(Debug, Serialize)]
struct ObjectRow {
    name: String,
    shape: &'static str,
    /// Of its box in the world.
    size_m: [f64; 3],
    material: String,
    triangles: Option<u64>,
    file: Option<String>,
    visible_to_camera: bool,
    /// What of it changes with time.
    moves: Vec<&'static str>,
}

#[derive(Debug, Serialize)]
struct MaterialRow {
    name: String,
    kind: &'static str,
    /// By name, its unit included; of each band.
    #[serde(flatten)]
    values: BTreeMap<&'static str, [f64; 3]>,
    /// By whose colours the albedo is multiplied.
    texture: Option<String>,
}

#[derive(Debug, Serialize)]
struct LightRow {
    name: String,
    kind: &'static str,
    /// W/m² on a plane that faces parallel light; W/sr of a point, and on the axis of a spot; W/m²/sr of a surface.
    bands: [f64; 3],
    /// What it gives in all, mean of the bands; parallel light has no end.
    power_w: Option<f64>,
    direction: Option<[f64; 3]>,
    position_m: Option<[f64; 3]>,
    /// The picture that it projects.
    image: Option<String>,
    /// Of parallel light that has a disc.
    angular_diameter_degrees: Option<f64>,
    /// Of a surface that shines.
    area_m2: Option<f64>,
    /// What of it changes with time.
    moves: Vec<&'static str>,
}

/// What is seen where nothing is.
#[derive(Debug, Serialize)]
struct SkyRow {
    kind: &'static str,
    /// By name, W/m²/sr of each band.
    #[serde(flatten)]
    values: BTreeMap<&'static str, [f64; 3]>,
    /// The picture.
    file: Option<String>,
    up: [f64; 3],
    /// What is in the picture's middle.
    ahead: Option<[f64; 3]>,
}

#[derive(Debug, Serialize)]
struct CameraRow {
    name: String,
    kind: &'static str,
    /// Of a pinhole.
    fov_y_degrees: Option<f64>,
    /// Of an orthographic one.
    height_m: Option<f64>,
    position_m: [f64; 3],
    target_m: [f64; 3],
    hides_specular: bool,
}

/// What a glTF file brought; its things stand in the other tables, as `NAME/…`.
#[derive(Debug, Serialize)]
struct ImportRow {
    name: String,
    file: String,
    /// Metres a unit of the file.
    scale: f64,
    objects: u64,
    /// Of all of its objects.
    triangles: u64,
    /// Less those that the scene's own replace.
    materials: u64,
    lights: u64,
    cameras: u64,
}

impl SceneReport {
    /// From a loaded scene.
    pub fn new(scene: &Scene) -> Self {
        Self {
            schema: "nephroid.scene/1",
            name: scene.name.clone(),
            title: scene.title.clone(),
            file: scene.source.file.clone(),
            hash: scene.source.hash.clone(),
            class: scene.paths.to_string(),
            exposure_ev: scene.exposure,
            moves: scene.moves(),
            keyed_s: scene.keyed_span(),
            e0_w_m2: bare_irradiance(scene),
            region: RegionRow::new(scene, &scene.region),
            objects: (0..scene.objects.len()).map(|object| ObjectRow::new(scene, object)).collect(),
            materials: scene.materials.iter().map(MaterialRow::new).collect(),
            lights: (0..scene.lights.len()).map(|light| LightRow::new(scene, light)).collect(),
            sky: scene.sky.as_ref().map(SkyRow::new),
            cameras: scene.cameras.iter().map(|(name, camera)| CameraRow::new(name, camera)).collect(),
            imports: scene.imports.iter().map(ImportRow::new).collect(),
            warnings: scene.warnings.clone(),
        }
    }

    /// What a reader of its pictures must know.
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }
}

impl RegionRow {
    fn new(scene: &Scene, region: &Region) -> Self {
        let receiver = scene.objects[region.receiver].name.clone();
        let size_m = [region.u, region.v].map(|half| 2.0 * half.length());
        Self { receiver, center_m: region.center.to_array(), size_m }
    }
}

impl ObjectRow {
    fn new(scene: &Scene, index: usize) -> Self {
        let object = &scene.objects[index];
        let (shape, mesh) = match &object.shape {
            Shape::Sphere { .. } => ("sphere", None),
            Shape::Quad { .. } => ("quad", None),
            Shape::Canonical { kind, .. } => (kind.name(), None),
            Shape::Mesh { mesh, .. } => (mesh.sheet.as_ref().map_or("mesh", |sheet| sheet.kind()), Some(mesh)),
        };
        Self {
            name: object.name.clone(),
            shape,
            size_m: object.shape.bounds().map_or(DVec3::ZERO, |[low, high]| high - low).to_array(),
            material: scene.materials[object.material].name.clone(),
            triangles: mesh.map(|mesh| mesh.triangles.len() as u64),
            file: mesh.map(|mesh| mesh.file.clone()).filter(|file| !file.is_empty()),
            visible_to_camera: object.visible_to_camera,
            moves: scene.object_motion(index),
        }
    }
}

impl MaterialRow {
    fn new(material: &Material) -> Self {
        let (kind, values) = match material.kind {
            MaterialKind::Diffuse { albedo, .. } => ("diffuse", vec![("albedo", albedo)]),
            MaterialKind::Dielectric { ior, absorption } => {
                ("dielectric", vec![("ior", ior), ("absorption_per_m", absorption)])
            }
            MaterialKind::Mirror { reflectance } => ("mirror", vec![("reflectance", reflectance)]),
            MaterialKind::Conductor { eta, k } => ("conductor", vec![("eta", eta), ("k", k)]),
        };
        let texture = match &material.kind {
            MaterialKind::Diffuse { texture, .. } => texture.as_ref().map(|texture| texture.picture.file.clone()),
            _ => None,
        };
        Self { name: material.name.clone(), kind, values: values.into_iter().collect(), texture }
    }

    fn text(&self) -> String {
        let value = |(name, bands): (&&str, &[f64; 3])| format!("{} {}", name.replace('_', " "), shown(*bands));
        let texture = self.texture.iter().map(|file| format!("texture {file}"));
        self.values.iter().map(value).chain(texture).collect::<Vec<_>>().join(", ")
    }
}

impl LightRow {
    fn new(scene: &Scene, index: usize) -> Self {
        let light = &scene.lights[index];
        let (kind, direction) = match &light.kind {
            LightKind::Directional { direction, .. } | LightKind::Sun { direction, .. } => {
                ("directional", Some(*direction))
            }
            LightKind::Point { .. } => ("point", None),
            LightKind::Patch { normal, .. } => ("patch", Some(*normal)),
            LightKind::Lamp { face, .. } => (if face.round { "disk" } else { "quad" }, Some(face.normal())),
            LightKind::Spot { beam, .. } => ("spot", Some(beam.axis)),
        };
        Self {
            name: light.name.clone(),
            kind,
            bands: light.kind.power(),
            power_w: light.kind.flux().map(|bands| bands.iter().sum::<f64>() / 3.0),
            direction: direction.map(|d| d.to_array()),
            position_m: light.kind.position().map(|p| p.to_array()),
            image: match &light.kind {
                LightKind::Spot { slide, .. } => slide.as_ref().map(|slide| slide.picture.file.clone()),
                _ => None,
            },
            angular_diameter_degrees: match &light.kind {
                LightKind::Sun { radius, .. } => Some(2.0 * radius.to_degrees()),
                _ => None,
            },
            area_m2: match &light.kind {
                LightKind::Lamp { face, .. } => Some(face.area()),
                _ => None,
            },
            moves: scene.light_motion(index),
        }
    }

    fn cells(&self) -> Vec<Cell> {
        let unit = match (self.position_m, self.area_m2) {
            (_, Some(_)) => "W/m2/sr",
            (Some(_), None) => "W/sr",
            (None, None) => "W/m2",
        };
        let across = self.angular_diameter_degrees.map(|degrees| format!("{degrees:.4} degrees across"));
        let area = self.area_m2.map(|area| format!("of {area:.4} m2"));
        let at = self.position_m.map(|at| format!("at {}", vector(at)));
        let along = self.direction.map(|along| format!("along {}", vector(along)));
        let image = self.image.as_ref().map(|file| format!("throws {file}"));
        let place = at.into_iter().chain(along).chain(across).chain(area).chain(image).collect::<Vec<_>>().join(", ");
        let power = self.power_w.map_or(Cell::None, |watts| Cell::Real(watts, 4));
        let strength = Cell::text(format!("{} {unit}", shown(self.bands)));
        vec![Cell::text(&self.name), Cell::text(self.kind), strength, power, Cell::text(place), moving(&self.moves)]
    }
}

impl SkyRow {
    fn new(sky: &Sky) -> Self {
        match sky {
            Sky::Gradient { up, zenith, horizon, ground } => {
                let values = [("zenith", *zenith), ("horizon", *horizon), ("ground", *ground)];
                Self {
                    kind: "gradient",
                    values: values.into_iter().collect(),
                    file: None,
                    up: up.to_array(),
                    ahead: None,
                }
            }
            Sky::Image { picture, up, ahead } => Self {
                kind: "image",
                values: BTreeMap::new(),
                file: Some(picture.file.clone()),
                up: up.to_array(),
                ahead: Some(ahead.to_array()),
            },
        }
    }

    fn text(&self) -> String {
        let of = |name: &str| self.values.get(name).map(|bands| format!("{name} {}", shown(*bands)));
        let values: Vec<_> = ["zenith", "horizon", "ground"].into_iter().filter_map(of).collect();
        self.file.clone().unwrap_or_else(|| values.join(", "))
    }
}

impl CameraRow {
    fn new(name: &str, camera: &Camera) -> Self {
        let (kind, fov_y_degrees, height_m) = match camera.kind {
            CameraKind::Pinhole { fov_y } => ("pinhole", Some(fov_y), None),
            CameraKind::Orthographic { height, .. } => ("orthographic", None, Some(height)),
        };
        let [position_m, target_m] = [camera.position, camera.target].map(|p| p.to_array());
        let hides_specular = camera.hides_specular;
        Self { name: name.to_owned(), kind, fov_y_degrees, height_m, position_m, target_m, hides_specular }
    }

    fn cells(&self) -> Vec<Cell> {
        let field = self.fov_y_degrees.map(|degrees| format!("{degrees} degrees"));
        let field = field.or(self.height_m.map(|height| format!("{height} m"))).unwrap_or_default();
        let way = format!("from {} to {}", vector(self.position_m), vector(self.target_m));
        let sees = if self.hides_specular { "no specular object" } else { "all" };
        vec![Cell::text(&self.name), Cell::text(self.kind), Cell::text(field), Cell::text(way), Cell::text(sees)]
    }
}

impl ImportRow {
    fn new(import: &Import) -> Self {
        let [objects, triangles, materials, lights, cameras] =
            [import.objects, import.triangles, import.materials, import.lights, import.cameras].map(|n| n as u64);
        let (name, file) = (import.name.clone(), import.file.clone());
        Self { name, file, scale: import.scale, objects, triangles, materials, lights, cameras }
    }

    fn cells(&self) -> Vec<Cell> {
        let counts = [self.objects, self.triangles, self.materials, self.lights, self.cameras];
        let told = [Cell::text(&self.name), Cell::text(&self.file), Cell::text(self.scale.to_string())];
        told.into_iter().chain(counts.map(|count| Cell::count(Some(count)))).collect()
    }
}

impl Report for SceneReport {
    fn heading(&self) -> Vec<String> {
        let [width, height] = self.region.size_m;
        let moves = match self.keyed_s {
            Some([from, to]) => format!("moves, keys from {from} to {to} s"),
            None if self.moves => "moves, without an end".to_owned(),
            None => "stands still".to_owned(),
        };
        vec![
            format!("{}: {}", self.name, self.title),
            format!("{}, hash {}", self.file, self.hash),
            format!("caustic {}, exposure {} EV", self.class, self.exposure_ev),
            moves,
            format!("region {width} x {height} m on {}, E0 {:.4} W/m2", self.region.receiver, self.e0_w_m2),
        ]
    }

    fn tables(&self) -> Vec<Table> {
        let objects = self.objects.iter().map(|o| {
            let size = o.size_m.map(|side| format!("{side:.3}")).join(" x ");
            let file = o.file.as_ref().map_or(Cell::None, Cell::text);
            let seen = if o.visible_to_camera { "yes" } else { "no" };
            let [name, shape, material] = [o.name.as_str(), o.shape, &o.material].map(Cell::text);
            let triangles = Cell::count(o.triangles);
            vec![name, shape, Cell::text(size), material, triangles, file, Cell::text(seen), moving(&o.moves)]
        });
        let materials =
            self.materials.iter().map(|m| vec![Cell::text(&m.name), Cell::text(m.kind), Cell::text(m.text())]);
        let lights = self.lights.iter().map(LightRow::cells);
        let cameras = self.cameras.iter().map(CameraRow::cells);
        let imports: Vec<_> = self.imports.iter().map(ImportRow::cells).collect();
        let imported = ["import", "file", "m a unit", "objects", "triangles", "materials", "lights", "cameras"];
        let table = |name, columns: &[&'static str], rows| Table { name, columns: columns.to_vec(), rows };
        let mut all = vec![
            table(
                "objects",
                &["object", "shape", "size m", "material", "triangles", "file", "seen", "moves"],
                objects.collect(),
            ),
            table("materials", &["material", "kind", "what it does"], materials.collect()),
            table("lights", &["light", "kind", "strength", "power W", "place", "moves"], lights.collect()),
            table("cameras", &["camera", "kind", "field", "looks", "sees"], cameras.collect()),
        ];
        if let Some(sky) = &self.sky {
            let row = vec![Cell::text(sky.kind), Cell::text(sky.text()), Cell::text(vector(sky.up))];
            all.push(table("sky", &["sky", "seen, W/m2/sr", "up"], vec![row]));
        }
        if !imports.is_empty() {
            all.push(table("imports", &imported, imports));
        }
        all
    }

    /// The heading's figures too.
    fn csv_tables(&self) -> Vec<Table> {
        let [width, height] = self.region.size_m;
        let figures = [self.e0_w_m2, width, height, self.exposure_ev].map(|figure| Cell::Real(figure, 4));
        let words = [&self.name, &self.title, &self.class, &self.hash].map(Cell::text);
        let columns =
            ["scene", "title", "class", "hash", "e0 W/m2", "region width m", "region height m", "exposure EV"];
        let rows = vec![words.into_iter().chain(figures).collect()];
        let scene = Table { name: "scene", columns: columns.to_vec(), rows };
        [scene].into_iter().chain(self.tables()).collect()
    }
}

fn moving(names: &[&str]) -> Cell {
    if names.is_empty() { Cell::None } else { Cell::text(names.join(", ")) }
}

/// One number where all bands are alike.
fn shown([red, green, blue]: [f64; 3]) -> String {
    if red == green && green == blue { red.to_string() } else { format!("[{red}, {green}, {blue}]") }
}

fn vector(of: [f64; 3]) -> String {
    let [x, y, z] = of.map(|x| format!("{:.3}", x + 0.0));
    format!("[{x}, {y}, {z}]")
}
