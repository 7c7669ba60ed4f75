//! One import: node by node.
use std::{
    collections::{BTreeMap, HashMap},
    rc::Rc,
    sync::Arc,
};

use glam::{DAffine3, DVec3};

use super::{Import, Imported, told::Told};
use crate::scene::{
    Light, Material, Mesh, Object, Shape,
    gltf::{Body, Document, GltfFault, Group, Names, camera, fault, light, look, mapped, shown},
    measure::LARGEST,
};

/// How much longer than another a stretched length may become: of the seven digits of single precision, in which rays are
/// taken to a mesh's own space, three remain. What is flatter is stretched in a mesh of its own.
const STRETCH: f64 = 1e4;
/// Sizes, in a mesh's own units and of one of them in metres, that single precision holds with their squares.
const SIZES: std::ops::RangeInclusive<f64> = 1e-9..=1e9;

/// A glTF file on its way into a scene.
pub struct Importer<'a> {
    pub name: &'a str,
    pub file: &'a str,
    pub document: &'a Document,
    pub to_world: DAffine3,
    /// Metres a unit of the file.
    pub scale: f64,
    /// None leaves its lights out.
    pub watts_per_lumen: Option<f64>,
    /// Objects that it may bring.
    pub most: usize,
    /// By the file's names, the scene's.
    pub replaced: &'a BTreeMap<String, String>,
}

/// A node, its name and its map to the world, in metres.
struct Node {
    index: usize,
    name: String,
    world: DAffine3,
}

/// The box about what was brought so far.
type Extent = Option<[DVec3; 2]>;

impl Importer<'_> {
    /// Adds what the file brings.
    pub fn run(self, all: &mut Imported) -> Result<(), GltfFault> {
        let nodes: Vec<Node> = self.document.placed()?.into_iter().map(|at| self.node(at.node, at.world)).collect();
        let mut told = Told::of(self.document);
        let mut import = Import {
            name: self.name.to_owned(),
            file: self.file.to_owned(),
            scale: self.scale,
            objects: 0,
            triangles: 0,
            materials: 0,
            lights: 0,
            cameras: 0,
        };
        let extent = self.objects(&nodes, all, &mut import, &mut told)?;
        self.lights(&nodes, all, &mut import, &mut told)?;
        self.cameras(&nodes, extent, all, &mut import)?;
        all.warnings.extend(told.warnings(&format!("`{}` ({})", self.name, self.file)));
        if import.objects + import.lights + import.cameras == 0 {
            let remedy = "check that this is the right file, and that its scene is not empty";
            return Err(fault("", "triangles, lights or cameras in the nodes of the scene", "none", remedy));
        }
        all.imports.push(import);
        Ok(())
    }

    fn node(&self, index: usize, world: DAffine3) -> Node {
        let json = &self.document.json;
        let node = &json.nodes[index];
        let of_mesh = || node.mesh.and_then(|mesh| json.meshes.get(mesh)?.name.as_deref());
        let of_camera = || node.camera.and_then(|camera| json.cameras.get(camera)?.name.as_deref());
        let of_light = || {
            let light = node.extensions.light.as_ref()?.light;
            json.extensions.lights.as_ref()?.lights.get(light)?.name.as_deref()
        };
        let name = node.name.as_deref().or_else(of_mesh).or_else(of_camera).or_else(of_light);
        Node { index, name: shown(name, "node", index), world: self.to_world * world }
    }

    /// An object for each material of each node's mesh.
    fn objects(
        &self,
        nodes: &[Node],
        all: &mut Imported,
        import: &mut Import,
        told: &mut Told,
    ) -> Result<Extent, GltfFault> {
        let (mut names, mut bodies) = (Names::default(), HashMap::<usize, Rc<Body>>::new());
        let mut materials = Materials { importer: self, names: Names::default(), known: HashMap::new() };
        let mut extent = Extent::None;
        for node in nodes {
            let Some(index) = self.document.json.nodes[node.index].mesh else { continue };
            let body = match bodies.get(&index) {
                Some(body) => body.clone(),
                None => {
                    let body = Rc::new(self.document.body(self.file, index, &format!("nodes[{}].mesh", node.index))?);
                    told.body(&body);
                    bodies.entry(index).or_insert(body).clone()
                }
            };
            for group in &body.groups {
                let Some((mesh, to_world)) = self.place(node, group, &mut extent)? else {
                    told.flat += 1;
                    continue;
                };
                if import.objects == self.most {
                    let expected = format!("at most {} objects from a file of this size", self.most);
                    let remedy = "join meshes, or export fewer nodes";
                    return Err(fault(format!("nodes[{}]", node.index), expected, "more", remedy));
                }
                let material = materials.of(group.material, all, import, told)?;
                let several =
                    if body.groups.len() > 1 { Some(self.document.material_name(group.material)) } else { None };
                let of_group = several.map(|material| format!("/{material}")).unwrap_or_default();
                let name = names.give(&format!("{}/{}{of_group}", self.name, node.name));
                import.objects += 1;
                import.triangles += mesh.triangles.len();
                let shape = Shape::Mesh { mesh, to_world };
                all.objects.push((Object { name, shape, material: 0, visible_to_camera: true }, material));
            }
        }
        Ok(extent)
    }

    /// The group's mesh in the world; none where the node leaves nothing of it.
    fn place(
        &self,
        node: &Node,
        group: &Group,
        extent: &mut Extent,
    ) -> Result<Option<(Arc<Mesh>, DAffine3)>, GltfFault> {
        let path = format!("nodes[{}]", node.index);
        let [low, high] = group.bounds;
        let corner = |k: usize| DVec3::from_array(std::array::from_fn(|axis| [low, high][k >> axis & 1][axis]));
        let corners = (0..8).map(|k| node.world.transform_point3(corner(k)));
        let about = corners.map(|p| [p, p]).reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])]).unwrap_or_default();
        if !about.iter().all(|p| p.abs().max_element() <= LARGEST) {
            let remedy = "scale the import down, or move the node nearer";
            let found = format!("up to [{:e}, {:e}, {:e}]", about[1].x, about[1].y, about[1].z);
            return Err(fault(path, format!("coordinates within ±{LARGEST:e} m"), found, remedy));
        }
        let placed = if awkward(&node.world, [low, high]) {
            self.document.spend(&path, group.mesh.triangles.len())?;
            let linear = DAffine3 { translation: DVec3::ZERO, ..node.world };
            let mesh = mapped(&group.mesh, &linear);
            if !has_area(&mesh) {
                return Ok(None);
            }
            (Arc::new(mesh), DAffine3::from_translation(node.world.translation))
        } else {
            group.placed(node.world)
        };
        *extent = Some(extent.map_or(about, |[low, high]| [low.min(about[0]), high.max(about[1])]));
        Ok(Some(placed))
    }

    fn lights(
        &self,
        nodes: &[Node],
        all: &mut Imported,
        import: &mut Import,
        told: &mut Told,
    ) -> Result<(), GltfFault> {
        let Some(watts_per_lumen) = self.watts_per_lumen else { return Ok(()) };
        let mut names = Names::default();
        for node in nodes {
            let Some(of_node) = &self.document.json.nodes[node.index].extensions.light else { continue };
            let path = format!("nodes[{}].extensions.KHR_lights_punctual.light", node.index);
            let (kind, ends) = light(self.document, of_node.light, &path, &node.world, watts_per_lumen)?;
            told.ranges += usize::from(ends);
            let name = names.give(&format!("{}/{}", self.name, node.name));
            all.lights.push(Light { name, kind });
            import.lights += 1;
        }
        Ok(())
    }

    fn cameras(
        &self,
        nodes: &[Node],
        extent: Extent,
        all: &mut Imported,
        import: &mut Import,
    ) -> Result<(), GltfFault> {
        let center = extent.map(|[low, high]| 0.5 * (low + high));
        let mut names = Names::default();
        for node in nodes {
            let Some(index) = self.document.json.nodes[node.index].camera else { continue };
            let path = format!("nodes[{}].camera", node.index);
            let made = camera(self.document, index, &path, (&node.world, self.scale), center)?;
            all.cameras.insert(names.give(&format!("{}/{}", self.name, node.name)), made);
            import.cameras += 1;
        }
        Ok(())
    }
}

/// Whether rays cannot be taken to the mesh's own space and back in single precision.
fn awkward(world: &DAffine3, [low, high]: [DVec3; 2]) -> bool {
    let columns = world.matrix3;
    let size = [columns.x_axis, columns.y_axis, columns.z_axis].map(DVec3::length).into_iter().fold(0.0, f64::max);
    let own = (high - low).max_element().max(low.abs().max_element()).max(high.abs().max_element());
    if !SIZES.contains(&size) || !SIZES.contains(&own) {
        return true;
    }
    let back = (columns * size.recip()).inverse();
    let stretch = [back.x_axis, back.y_axis, back.z_axis].map(DVec3::length_squared).into_iter().sum::<f64>().sqrt();
    stretch.is_nan() || stretch > STRETCH
}

fn has_area(mesh: &Mesh) -> bool {
    mesh.triangles.iter().any(|corners| {
        let [a, b, c] = corners.map(|k| mesh.positions[k as usize].as_dvec3());
        (b - a).cross(c - a) != DVec3::ZERO
    })
}

/// The file's materials that are used, each made once.
struct Materials<'a> {
    importer: &'a Importer<'a>,
    names: Names,
    /// The scene's name of each.
    known: HashMap<Option<usize>, String>,
}

impl Materials<'_> {
    /// The name of the scene's material for one of the file's.
    fn of(
        &mut self,
        index: Option<usize>,
        all: &mut Imported,
        import: &mut Import,
        told: &mut Told,
    ) -> Result<String, GltfFault> {
        if let Some(name) = self.known.get(&index) {
            return Ok(name.clone());
        }
        let theirs = self.importer.document.material_name(index);
        let name = match self.importer.replaced.get(&theirs) {
            Some(ours) => ours.clone(),
            None => {
                let look = look(self.importer.document, index, self.importer.scale)?;
                let name = self.names.give(&format!("{}/{theirs}", self.importer.name));
                told.material(&name, &look);
                all.materials.push(Material { name: name.clone(), kind: look.kind });
                import.materials += 1;
                name
            }
        };
        self.known.insert(index, name.clone());
        Ok(name)
    }
}
