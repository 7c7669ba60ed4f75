//! What a mesh's edges say of it: where it is open, and where its triangles do not agree on an outside.
//!
//! Vertices at equal positions count as one: seams of normals are no holes. Triangles without area at an edge are passed
//! over.
use std::collections::{BTreeMap, HashMap};

use glam::{DAffine3, DVec3};

use super::{Material, MaterialKind, Mesh, Object, Shape};

/// Edges of one triangle alone that hang together; holes that touch at a vertex count as one.
#[derive(Clone, Debug, PartialEq)]
struct Hole {
    /// All of its edges.
    length: f64,
    /// Mean of its edges by length.
    center: DVec3,
    /// For maps that stretch them.
    edges: Vec<DVec3>,
}

/// What is wrong with a mesh that should bound a medium; lengths in its own units.
#[derive(Clone, Debug, Default, PartialEq)]
struct Faults {
    /// The longest first.
    holes: Vec<Hole>,
    /// Edges whose two triangles run along them the same way: one of the two is turned over.
    flipped: usize,
    /// Edges of more than two triangles.
    crowded: usize,
    /// Closed, and wound round its inside the wrong way.
    inside_out: bool,
}

/// What a reader must know of each dielectric mesh, the objects in their order.
pub fn warnings(objects: &[Object], materials: &[Material]) -> Vec<String> {
    let mut known: HashMap<*const Mesh, Faults> = HashMap::new();
    let mut all = Vec::new();
    for object in objects {
        let dielectric = matches!(materials[object.material].kind, MaterialKind::Dielectric { .. });
        let Shape::Mesh { mesh, to_world } = &object.shape else { continue };
        if dielectric && mesh.sheet.is_none() {
            let faults = known.entry(std::sync::Arc::as_ptr(mesh)).or_insert_with(|| Faults::of(mesh));
            all.extend(faults.told(to_world).map(|fault| format!("`{}` ({}) {fault}", object.name, mesh.file)));
        }
    }
    all
}

impl Faults {
    fn of(mesh: &Mesh) -> Self {
        let welded = welded(mesh);
        let mut edges: Vec<(u32, u32, bool)> = Vec::with_capacity(3 * mesh.triangles.len());
        for corners in &mesh.triangles {
            let [a, b, c] = corners.map(|i| welded[i as usize]);
            if a != b && b != c && c != a {
                edges.extend([(a, b), (b, c), (c, a)].map(|(p, q)| (p.min(q), p.max(q), p < q)));
            }
        }
        edges.sort_unstable();
        let mut faults = Faults::default();
        let mut open = Vec::new();
        for same in edges.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
            match same {
                [(a, b, _)] => open.push((*a, *b)),
                [first, second] => faults.flipped += usize::from(first.2 == second.2),
                _ => faults.crowded += 1,
            }
        }
        faults.inside_out = open.is_empty() && faults.flipped == 0 && volume(mesh) < 0.0;
        faults.holes = holes(mesh, &open);
        faults
    }

    /// One sentence a fault, with its remedy.
    fn told(&self, to_world: &DAffine3) -> impl Iterator<Item = String> {
        let mirror = "or give it a mirror or a diffuse material";
        let open = self.holes.first().map(|largest| {
            let length: f64 = largest.edges.iter().map(|edge| to_world.transform_vector3(*edge).length()).sum();
            let at = to_world.transform_point3(largest.center);
            let (count, s) = (self.holes.len(), if self.holes.len() == 1 { "" } else { "s" });
            format!(
                "is a dielectric with {count} hole{s}, the largest {length:.4} m round about [{:.4}, {:.4}, {:.4}] m: light \
                 through a hole is inside without having entered; close the mesh, {mirror}",
                at.x, at.y, at.z
            )
        });
        let flipped = (self.flipped > 0).then(|| {
            format!(
                "is a dielectric with {} edges whose two triangles face opposite ways, so that inside and outside are \
                 mixed; turn all of them counter-clockwise seen from outside, {mirror}",
                self.flipped
            )
        });
        let crowded = (self.crowded > 0).then(|| {
            format!(
                "is a dielectric with {} edges of more than two triangles (doubled faces, or walls inside); take out those \
                 that bound nothing, {mirror}",
                self.crowded
            )
        });
        let inside_out = self.inside_out.then(|| {
            "is a dielectric turned inside out, so that its medium lies around it; turn its triangles counter-clockwise \
             seen from outside"
                .to_owned()
        });
        [open, flipped, crowded, inside_out].into_iter().flatten()
    }
}

/// For each vertex the first one at its position; −0 and 0 are one place.
fn welded(mesh: &Mesh) -> Vec<u32> {
    let place = |i: &u32| mesh.positions[*i as usize].to_array().map(|x| (x + 0.0).to_bits());
    let mut order: Vec<u32> = (0..mesh.positions.len() as u32).collect();
    order.sort_unstable_by_key(|i| (place(i), *i));
    let mut first = vec![0; order.len()];
    for same in order.chunk_by(|a, b| place(a) == place(b)) {
        same.iter().for_each(|i| first[*i as usize] = same[0]);
    }
    first
}

/// Chains of open edges, by union of their ends; the longest first, then in the order of their vertices.
fn holes(mesh: &Mesh, open: &[(u32, u32)]) -> Vec<Hole> {
    let mut parents: HashMap<u32, u32> = open.iter().flat_map(|(a, b)| [(*a, *a), (*b, *b)]).collect();
    for (a, b) in open {
        let (a, b) = (root(&mut parents, *a), root(&mut parents, *b));
        parents.insert(a.max(b), a.min(b));
    }
    let mut sums: BTreeMap<u32, (f64, DVec3, Vec<DVec3>)> = BTreeMap::new();
    for (a, b) in open {
        let [p, q] = [*a, *b].map(|i| mesh.positions[i as usize].as_dvec3());
        let sum = sums.entry(root(&mut parents, *a)).or_default();
        let length = (q - p).length();
        (sum.0, sum.1) = (sum.0 + length, sum.1 + length * 0.5 * (p + q));
        sum.2.push(q - p);
    }
    // Two different positions are some distance apart, so no length is zero.
    let mut holes: Vec<Hole> =
        sums.into_values().map(|(length, moment, edges)| Hole { length, center: moment / length, edges }).collect();
    holes.sort_by(|a, b| b.length.total_cmp(&a.length));
    holes
}

/// The vertex that stands for all that hang together with this one; halves the way there.
fn root(parents: &mut HashMap<u32, u32>, of: u32) -> u32 {
    let mut at = of;
    while parents[&at] != at {
        let next = parents[&parents[&at]];
        parents.insert(at, next);
        at = next;
    }
    at
}

/// Six times the volume that the triangles wind round, from the first vertex, so that distance costs no digits.
fn volume(mesh: &Mesh) -> f64 {
    let origin = mesh.positions.first().map_or(DVec3::ZERO, |p| p.as_dvec3());
    let spat = |corners: &[u32; 3]| {
        let [a, b, c] = corners.map(|i| mesh.positions[i as usize].as_dvec3() - origin);
        a.dot(b.cross(c))
    };
    mesh.triangles.iter().map(spat).sum()
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    /// Sums of a few edges in float64, of float32 positions.
    const ROUNDING: f64 = 1e-6;

    /// [0, 1]³ with a vertex of its own at every corner of every triangle, as a file with flat normals has it.
    fn cube() -> Mesh {
        let corner = |k: u32| Vec3::new((k & 1) as f32, (k >> 1 & 1) as f32, (k >> 2 & 1) as f32);
        let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [7, 3, 2, 6], [0, 2, 3, 1], [7, 6, 4, 5]];
        let corners: Vec<u32> = quads.iter().flat_map(|q| [q[0], q[1], q[2], q[0], q[2], q[3]]).collect();
        let positions: Vec<Vec3> = corners.iter().map(|&k| corner(k)).collect();
        let triangles = (0..12).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
        Mesh {
            file: "cube.obj".to_owned(),
            normals: vec![Vec3::Y; positions.len()],
            positions,
            triangles,
            coordinates: vec![],
            sheet: None,
        }
    }

    #[test]
    fn a_closed_body_has_no_fault_whatever_its_vertices() {
        assert_eq!(Faults::of(&cube()), Faults::default());
        let mut signed = cube();
        signed.positions.iter_mut().step_by(2).for_each(|p| *p = p.map(|x| if x == 0.0 { -0.0 } else { x }));
        assert_eq!(Faults::of(&signed), Faults::default(), "minus zero is zero");
        let mut needles = cube();
        needles.triangles.extend([[0, 0, 1], [3, 3, 3]]);
        assert_eq!(Faults::of(&needles), Faults::default(), "what has no area bounds nothing");
    }

    #[test]
    fn holes_are_measured_where_they_are() {
        let mut open = cube();
        // The whole side x = 0, and one triangle of the side x = 1.
        open.triangles.drain(0..3);
        let Faults { holes, flipped, crowded, inside_out } = Faults::of(&open);
        assert_eq!((flipped, crowded, inside_out, holes.len()), (0, 0, false, 2));
        let [square, triangle] = [&holes[0], &holes[1]];
        assert!(
            (square.length - 4.0).abs() < ROUNDING && (square.center - DVec3::new(0.0, 0.5, 0.5)).length() < ROUNDING
        );
        let around = 2.0 + 2.0_f64.sqrt();
        assert!((triangle.length - around).abs() < ROUNDING && triangle.center.x == 1.0, "{triangle:?}");
        let map = DAffine3::from_scale_rotation_translation(DVec3::splat(2.0), glam::DQuat::IDENTITY, DVec3::X);
        let told: Vec<_> = Faults::of(&open).told(&map).collect();
        assert_eq!(told.len(), 1);
        assert!(told[0].contains("2 holes, the largest 8.0000 m round about [1.0000, 1.0000, 1.0000] m"), "{told:?}");
    }

    #[test]
    fn triangles_that_disagree_are_counted() {
        let mut flipped = cube();
        flipped.triangles[4].swap(0, 1);
        assert_eq!(Faults::of(&flipped), Faults { flipped: 3, ..Default::default() });
        let mut doubled = cube();
        doubled.triangles.push(doubled.triangles[7]);
        assert_eq!(Faults::of(&doubled), Faults { crowded: 3, ..Default::default() });
        let mut turned = cube();
        turned.triangles.iter_mut().for_each(|t| t.swap(1, 2));
        assert_eq!(Faults::of(&turned), Faults { inside_out: true, ..Default::default() });
    }

    #[test]
    fn a_mesh_of_nothing_has_no_fault() {
        let nothing = Mesh {
            file: String::new(),
            positions: vec![],
            normals: vec![],
            triangles: vec![],
            coordinates: vec![],
            sheet: None,
        };
        assert_eq!(Faults::of(&nothing), Faults::default());
    }
}
