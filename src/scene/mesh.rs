//! What a mesh says of itself: its box and its normals.
use glam::{DVec3, Vec3};

use super::Mesh;

impl Mesh {
    /// Smallest and largest corner of the box about the mapped vertices; `None` without any.
    pub fn bounds(&self, map: impl Fn(DVec3) -> DVec3) -> Option<[DVec3; 2]> {
        let corners = self.positions.iter().map(|p| map(p.as_dvec3())).map(|p| [p, p]);
        corners.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])
    }
}

/// Angle-weighted vertex normals (Thürmer and Wüthrich 1998, "Computing vertex normals from polygonal facets"): the
/// sum over the triangles at a vertex of their unit normals times their angle there, whatever the tessellation.
///
/// Triangles without area count for nothing. Where nothing is left, or all cancels, the first triangle's normal
/// stands, else +Y: such a vertex bends no light, but must not be NaN.
pub fn vertex_normals(positions: &[Vec3], triangles: &[[u32; 3]]) -> Vec<Vec3> {
    let mut sums = vec![DVec3::ZERO; positions.len()];
    let mut firsts = vec![DVec3::Y; positions.len()];
    for corners in triangles.iter().rev() {
        let p = corners.map(|i| positions[i as usize].as_dvec3());
        let Some(face) = (p[1] - p[0]).cross(p[2] - p[0]).try_normalize() else { continue };
        for k in 0..3 {
            let (a, b) = (p[(k + 1) % 3] - p[k], p[(k + 2) % 3] - p[k]);
            sums[corners[k] as usize] += face * a.cross(b).length().atan2(a.dot(b));
            firsts[corners[k] as usize] = face;
        }
    }
    let unit = |(sum, first): (DVec3, DVec3)| if sum.length() > CANCELLED { sum.normalize() } else { first };
    sums.into_iter().zip(firsts).map(unit).map(|n| n.as_vec3()).collect()
}

/// Radians: opposite normals leave rounding of about 1e-15; a real vertex more than the thinnest angle of a mesh.
const CANCELLED: f64 = 1e-9;

#[cfg(test)]
mod tests {
    use super::*;

    /// Single precision of the stored normal.
    const ROUNDING: f32 = 1e-6;

    /// A cube's corner sees three faces of a right angle each, one of them cut into two triangles: still (1,1,1)/√3.
    #[test]
    fn angle_weights_ignore_the_tessellation() {
        let [o, x, y, z] = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
        let triangles = [[0, 2, 1], [0, 3, 2], [0, 1, 4], [0, 4, 3]];
        let normals = vertex_normals(&[o, x, y, z, x + z], &triangles);
        assert!((normals[0] + Vec3::splat(3.0_f32.sqrt().recip())).length() < ROUNDING, "{}", normals[0]);
    }

    #[test]
    fn triangles_without_area_and_cancelling_sheets_leave_unit_normals() {
        let positions = [Vec3::ZERO, Vec3::X, Vec3::Z, Vec3::X];
        let point = vertex_normals(&positions, &[[0, 0, 0], [0, 1, 3]]);
        assert_eq!(point, [Vec3::Y; 4]);
        let sheet = vertex_normals(&positions, &[[0, 1, 2], [0, 2, 1]]);
        assert_eq!(sheet[..3], [Vec3::NEG_Y; 3]);
    }
}
