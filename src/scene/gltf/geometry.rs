//! Triangles of a mesh, by material.
use std::{cell::OnceCell, collections::HashMap, sync::Arc};

use glam::{DAffine3, DVec3, Vec2, Vec3};

use super::{
    Document, EXPORT, GltfFault,
    accessor::{Accessor, Component, Wanted},
    fault,
    json::Primitive,
    named,
};
use crate::scene::{Mesh, mesh::vertex_normals};

const POSITIONS: Wanted = Wanted {
    kind: "VEC3",
    components: &[Component::F32, Component::I8, Component::U8, Component::I16, Component::U16],
    told: "positions as VEC3 of float (or, quantized, of 8 or 16 bits)",
};
const NORMALS: Wanted = Wanted {
    kind: "VEC3",
    components: &[Component::F32, Component::I8, Component::I16],
    told: "normals as VEC3 of float (or, quantized, of 8 or 16 bits)",
};
const COORDINATES: Wanted = Wanted {
    kind: "VEC2",
    components: &[Component::F32, Component::U8, Component::U16],
    told: "texture coordinates as VEC2 of float (or of 8 or 16 bits)",
};
const INDICES: Wanted = Wanted {
    kind: "SCALAR",
    components: &[Component::U8, Component::U16, Component::U32],
    told: "indices as SCALAR of unsigned whole numbers",
};
/// Modes of primitives; those below are points and lines.
const TRIANGLES: usize = 4;
const STRIP: usize = 5;
const FAN: usize = 6;

/// What a mesh of the file holds.
#[derive(Default)]
pub struct Body {
    /// In the order in which the materials come.
    pub groups: Vec<Group>,
    /// Primitives of points or lines, which are left out.
    pub thin: usize,
    pub morphs: bool,
    /// Vertices whose normal was zero, and is now the mean of the triangles about them.
    pub mended: usize,
}

/// The triangles of one material: a closed body stays closed, in however many primitives it comes.
pub struct Group {
    pub material: Option<usize>,
    /// Whether vertices have colours of their own.
    pub coloured: bool,
    pub mesh: Arc<Mesh>,
    /// Corners of the box about the mesh, in its own units.
    pub bounds: [DVec3; 2],
    mirrored: OnceCell<Arc<Mesh>>,
}

impl Group {
    /// The mesh as a map places it, and a map that turns nothing inside out: a mirror's is taken into the mesh.
    pub fn placed(&self, world: DAffine3) -> (Arc<Mesh>, DAffine3) {
        if world.matrix3.determinant() >= 0.0 {
            return (self.mesh.clone(), world);
        }
        let mirrored = self.mirrored.get_or_init(|| Arc::new(mapped(&self.mesh, &MIRROR)));
        (mirrored.clone(), world * MIRROR)
    }
}

const MIRROR: DAffine3 =
    DAffine3 { matrix3: glam::DMat3::from_cols(DVec3::NEG_X, DVec3::Y, DVec3::Z), translation: DVec3::ZERO };

/// The mesh under a map, whatever it does to sizes; counter-clockwise from outside still.
pub fn mapped(mesh: &Mesh, map: &DAffine3) -> Mesh {
    let mut mapped = mesh.clone();
    let m = map.matrix3;
    // Cofactors take normals along even where there is no inverse; they turn with the determinant's sign.
    let cofactors =
        glam::DMat3::from_cols(m.y_axis.cross(m.z_axis), m.z_axis.cross(m.x_axis), m.x_axis.cross(m.y_axis));
    let mirrors = m.determinant() < 0.0;
    let turn = if mirrors { -1.0 } else { 1.0 };
    let largest = [m.x_axis, m.y_axis, m.z_axis].map(DVec3::length).into_iter().fold(f64::MIN_POSITIVE, f64::max);
    let unit = cofactors * (turn / (largest * largest));
    mapped.positions.iter_mut().for_each(|p| *p = map.transform_point3(p.as_dvec3()).as_vec3());
    let normal = |n: &Vec3| (unit * n.as_dvec3()).try_normalize().map_or(Vec3::Y, |n| n.as_vec3());
    mapped.normals.iter_mut().for_each(|n| *n = normal(n));
    if mirrors {
        mapped.triangles.iter_mut().for_each(|corners| corners.swap(1, 2));
    }
    mapped
}

/// Vertices and triangles as they come together.
#[derive(Default)]
struct Soup {
    coloured: bool,
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    coordinates: Vec<Vec2>,
    /// Whether some vertices have no texture coordinates; those of the others are then no use.
    bare: bool,
}

/// The vertices of a primitive, checked.
struct Vertices<'a> {
    positions: (Accessor<'a>, String),
    normals: Option<(Accessor<'a>, String)>,
    coordinates: Option<(Accessor<'a>, String)>,
}

impl Document {
    /// Reads a mesh of the file.
    pub fn body(&self, file: &str, index: usize, used_at: &str) -> Result<Body, GltfFault> {
        let written = named(&self.json.meshes, index, used_at, "meshes")?;
        let mut body = Body::default();
        let mut soups: Vec<(Option<usize>, Soup)> = Vec::new();
        let mut place = HashMap::new();
        for (number, primitive) in written.primitives.iter().enumerate() {
            let path = format!("meshes[{index}].primitives[{number}]");
            body.morphs |= !primitive.targets.is_empty();
            let mode = primitive.mode.unwrap_or(TRIANGLES);
            if mode < TRIANGLES {
                body.thin += 1;
                continue;
            }
            if let Some(material) = primitive.material {
                named(&self.json.materials, material, &format!("{path}.material"), "materials")?;
            }
            let at = *place.entry(primitive.material).or_insert(soups.len());
            if at == soups.len() {
                soups.push((primitive.material, Soup::default()));
            }
            self.add(&path, primitive, mode, &mut soups[at].1)?;
        }
        for (material, soup) in soups.into_iter().filter(|(_, soup)| !soup.triangles.is_empty()) {
            let coloured = soup.coloured;
            let mesh = Arc::new(soup.into_mesh(file, &mut body.mended));
            let bounds = mesh.bounds(|p| p).unwrap_or_default();
            body.groups.push(Group { material, coloured, mesh, bounds, mirrored: OnceCell::new() });
        }
        Ok(body)
    }

    fn add(&self, path: &str, primitive: &Primitive, mode: usize, soup: &mut Soup) -> Result<(), GltfFault> {
        let vertices = self.vertices(path, primitive)?;
        soup.coloured |= primitive.attributes.contains_key("COLOR_0");
        soup.bare |= vertices.coordinates.is_none();
        let triangles = self.triangles(path, primitive, mode, vertices.positions.0.count)?;
        if vertices.normals.is_none() {
            // Without normals a mesh is flat, says the specification.
            for corners in triangles {
                let first = soup.positions.len() as u32;
                for index in corners {
                    soup.push(&vertices, index)?;
                }
                let [a, b, c] = [0, 1, 2].map(|k| soup.positions[first as usize + k]);
                let across = (b - a).as_dvec3().cross((c - a).as_dvec3()).try_normalize().unwrap_or(DVec3::Y).as_vec3();
                soup.normals.extend([across; 3]);
                soup.triangles.push([first, first + 1, first + 2]);
            }
            return Ok(());
        }
        // Only vertices of triangles are held: primitives may share long lists of them.
        let mut known = HashMap::new();
        for corners in triangles {
            let mut here = [0; 3];
            for (vertex, index) in here.iter_mut().zip(corners) {
                *vertex = match known.get(&index) {
                    Some(vertex) => *vertex,
                    None => {
                        let vertex = soup.push(&vertices, index)?;
                        known.insert(index, vertex);
                        vertex
                    }
                };
            }
            soup.triangles.push(here);
        }
        Ok(())
    }

    fn vertices(&self, path: &str, primitive: &Primitive) -> Result<Vertices<'_>, GltfFault> {
        let at = |name: &str| format!("{path}.attributes.{name}");
        let read = |name: &str, wanted: &Wanted| {
            let index = primitive.attributes.get(name);
            index.map(|index| Ok((self.accessor(*index, &at(name), wanted)?, at(name)))).transpose()
        };
        let Some(positions) = read("POSITION", &POSITIONS)? else {
            return Err(fault(format!("{path}.attributes"), "positions as `POSITION`", "none", EXPORT));
        };
        let (normals, coordinates) = (read("NORMAL", &NORMALS)?, read("TEXCOORD_0", &COORDINATES)?);
        for (what, other) in [("normals", &normals), ("texture coordinates", &coordinates)] {
            if let Some((other, at)) = other.as_ref().filter(|(other, _)| other.count != positions.0.count) {
                let expected = format!("as many {what} as positions, {}", positions.0.count);
                return Err(fault(at, expected, other.count.to_string(), EXPORT));
            }
        }
        Ok(Vertices { positions, normals, coordinates })
    }

    /// Corners as indices below `count`.
    fn triangles(
        &self,
        path: &str,
        primitive: &Primitive,
        mode: usize,
        count: usize,
    ) -> Result<Vec<[u32; 3]>, GltfFault> {
        let at = format!("{path}.indices");
        let indices = primitive.indices.map(|index| self.accessor(index, &at, &INDICES)).transpose()?;
        let corners = indices.as_ref().map_or(count, |indices| indices.count);
        let (triangles, sound) = match mode {
            TRIANGLES => (corners / 3, corners.is_multiple_of(3)),
            STRIP | FAN => (corners.saturating_sub(2), corners != 1 && corners != 2),
            _ => {
                let expected = "4, 5 or 6 for triangles, or 0 to 3";
                return Err(fault(format!("{path}.mode"), expected, mode.to_string(), EXPORT));
            }
        };
        if !sound {
            return Err(fault(at, "corners for whole triangles", corners.to_string(), EXPORT));
        }
        self.spend(&at, triangles)?;
        let corner = |k: usize| {
            let Some(indices) = &indices else { return Ok(k as u32) };
            let index = indices.whole(k);
            if (index as usize) < count && (index != indices.restart()) {
                return Ok(index);
            }
            let expected = format!("indices of the primitive's {count} vertices");
            Err(fault(&at, expected, format!("{index} as number {k}"), EXPORT))
        };
        let triangle = |t: usize| match mode {
            TRIANGLES => [3 * t, 3 * t + 1, 3 * t + 2],
            // Every other one is turned, so that all face one way.
            STRIP => [t, t + 1 + t % 2, t + 2 - t % 2],
            _ => [t + 1, t + 2, 0],
        };
        (0..triangles).map(triangle).map(|[a, b, c]| Ok([corner(a)?, corner(b)?, corner(c)?])).collect()
    }
}

fn finite<const N: usize>((accessor, at): &(Accessor, String), index: u32) -> Result<[f64; N], GltfFault> {
    let value: [f64; N] = accessor.floats(index as usize);
    let found = || format!("{value:?} as number {index}");
    if value.iter().all(|x| x.is_finite()) { Ok(value) } else { Err(fault(at, "finite numbers", found(), EXPORT)) }
}

impl Soup {
    /// Adds a vertex, with its normal if it has one.
    fn push(&mut self, vertices: &Vertices, index: u32) -> Result<u32, GltfFault> {
        let vertex = self.positions.len() as u32;
        self.positions.push(DVec3::from_array(finite(&vertices.positions, index)?).as_vec3());
        if let Some(normals) = &vertices.normals {
            self.normals.push(DVec3::from_array(finite(normals, index)?).normalize_or_zero().as_vec3());
        }
        if let Some(coordinates) = &vertices.coordinates {
            // There a picture's (0, 0) is its upper left.
            let [u, v] = finite(coordinates, index)?;
            self.coordinates.push(Vec2::new(u as f32, (1.0 - v) as f32));
        }
        Ok(vertex)
    }

    fn into_mesh(mut self, file: &str, mended: &mut usize) -> Mesh {
        let zeros = self.normals.iter().filter(|n| **n == Vec3::ZERO).count();
        if zeros > 0 {
            *mended += zeros;
            let made = vertex_normals(&self.positions, &self.triangles);
            for (normal, made) in self.normals.iter_mut().zip(made).filter(|(normal, _)| **normal == Vec3::ZERO) {
                *normal = made;
            }
        }
        let Soup { positions, normals, triangles, coordinates, bare, .. } = self;
        let coordinates = if bare { vec![] } else { coordinates };
        Mesh { file: file.to_owned(), positions, normals, triangles, coordinates, sheet: None }
    }
}
