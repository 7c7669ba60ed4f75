//! Sheets: meshes that are a height over a rectangle, open interfaces as a quad is one.
//!
//! A regular grid of triangles whose vertices have the surface's own normals. Every tracer, the raster views, the eye and
//! the truth take it for the mesh that it is, so that they agree; what the triangles differ from the surface is known
//! (`tests/pictures/sheets.rs`), and falls as the square of the cells.

use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec2, DVec3};

use super::{Mesh, Ripple, Shape, WaveAt};

/// Of a mesh that is one: vertices row by row, along x first, from the corner of least x and y.
#[derive(Clone, Debug, PartialEq)]
pub struct Sheet {
    /// Along x and y.
    pub cells: [usize; 2],
    /// The longer half edge as written, which is the mesh's own unit, m.
    pub unit: f64,
    /// What its heights are samples of.
    pub relief: Relief,
}

/// What a sheet is between its vertices, for who can do better than triangles.
#[derive(Clone, Debug, PartialEq)]
pub enum Relief {
    /// Nothing is known but the vertices.
    Heights,
    /// The wave function of rendered water.
    Wave(WaveAt),
    /// A sum of waves.
    Sea(Arc<[Ripple]>),
}

impl Sheet {
    /// As scene files name it.
    pub fn kind(&self) -> &'static str {
        match self.relief {
            Relief::Heights => "heights",
            Relief::Wave(_) => "wave",
            Relief::Sea(_) => "sea",
        }
    }
}

/// A surface over a rectangle: from a place in [−1, 1]² (in half edges u and v) its height and its slopes along u and v, m and
/// metres a metre.
pub type Surface<'a> = dyn Fn(DVec2) -> (f64, DVec2) + 'a;

/// The sheet over a rectangle. Its own unit is the longer half edge, so that the map to the world scales evenly.
pub fn sheet(cells: [usize; 2], relief: Relief, file: String, [center, u, v]: [DVec3; 3], surface: &Surface) -> Shape {
    let unit = u.length().max(v.length());
    let half = DVec2::new(u.length(), v.length()) / unit;
    let [across, along] = cells;
    let count = (across + 1) * (along + 1);
    let (mut positions, mut normals) = (Vec::with_capacity(count), Vec::with_capacity(count));
    let mut coordinates = Vec::with_capacity(count);
    for row in 0..=along {
        for column in 0..=across {
            let at = DVec2::new(column as f64 / across as f64, row as f64 / along as f64) * 2.0 - 1.0;
            let (height, slope) = surface(at);
            positions.push((at * half).extend(height / unit).as_vec3());
            coordinates.push((0.5 + 0.5 * at).as_vec2());
            normals.push((-slope).extend(1.0).normalize().as_vec3());
        }
    }
    let cell = |k: usize| {
        let a = (k / across * (across + 1) + k % across) as u32;
        let d = a + across as u32 + 1;
        [[a, a + 1, d + 1], [a, d + 1, d]]
    };
    let triangles = (0..across * along).flat_map(cell).collect();
    let sheet = Sheet { cells, unit, relief };
    let mesh = Mesh { file, positions, normals, triangles, coordinates, sheet: Some(sheet) };
    let axes = DMat3::from_cols(u.normalize(), v.normalize(), u.cross(v).normalize()) * unit;
    Shape::Mesh { mesh: Arc::new(mesh), to_world: DAffine3::from_mat3_translation(axes, center) }
}

impl Mesh {
    /// How deep a point lies below the triangles of a sheet, in the mesh's own units; `None` above them, beside them, and of
    /// other meshes.
    pub fn depth_below(&self, p: DVec3) -> Option<f64> {
        let depth = self.height_at(self.sheet.as_ref()?.cells, p.truncate())? - p.z;
        (depth > 0.0).then_some(depth)
    }

    fn height_at(&self, [across, along]: [usize; 2], at: DVec2) -> Option<f64> {
        let vertex = |i: usize| self.positions.get(i).map(|p| p.as_dvec3());
        let [low, high] = [vertex(0)?, vertex(self.positions.len() - 1)?].map(DVec3::truncate);
        if !(at.cmpge(low).all() && at.cmple(high).all()) {
            return None;
        }
        let share = (at - low) / (high - low);
        let cell = |share: f64, cells: usize| ((share * cells as f64) as usize).min(cells - 1);
        let first = cell(share.y, along) * (across + 1) + cell(share.x, across);
        let [a, b] = [vertex(first)?, vertex(first + 1)?];
        let [d, c] = [vertex(first + across + 1)?, vertex(first + across + 2)?];
        let (f, g) = ((at.x - a.x) / (b.x - a.x), (at.y - a.y) / (d.y - a.y));
        Some(if f >= g { a.z + f * (b.z - a.z) + g * (c.z - b.z) } else { a.z + g * (d.z - a.z) + f * (c.z - d.z) })
    }
}
