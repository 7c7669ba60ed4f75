//! Boxes of a tree on a grid of 2¹⁶ cells: 16 bytes a node for 32, and half the words to read on the way down.
//!
//! Based on: Mahovsky and Wyvill, Memory-Conserving Bounding Volume Hierarchies with Coherent Raytracing, 2006. Differs: one
//! grid a tree, whose cells are powers of two and whose origin is a whole number of them, so that float32 makes a corner of
//! its cells exactly, fused or not, and no box comes out smaller than it was.

use super::{layout::Node, tree::Branch};

/// Cells that a box may reach, less one for the origin's rounding and one for its own on either side.
const CELLS: f64 = 65_532.0;
/// A cell is no smaller a share of the coordinates: origin and cells together have 24 bits.
const SHARE: f64 = 1.0 / 4_194_304.0;
/// Smallest cell, so that a box of no size at the origin has one.
const LEAST: f64 = 1e-30;

/// Where the cells of a tree lie, in the units of its boxes.
#[derive(Clone, Copy)]
pub struct Grid {
    origin: [f32; 3],
    cell: [f32; 3],
}

impl Grid {
    /// About the box of a root. One at the end of float32 (where nothing is) has cells of no size.
    pub fn about(root: &Branch) -> Self {
        let mut grid = Self { origin: root.lo, cell: [0.0; 3] };
        for axis in 0..3 {
            let [lo, hi] = [root.lo, root.hi].map(|corner| f64::from(corner[axis]));
            if lo < f64::from(f32::MAX) {
                let least = ((hi - lo) / CELLS).max(lo.abs().max(hi.abs()) * SHARE).max(LEAST);
                let cell = least.log2().ceil().exp2();
                grid.cell[axis] = cell as f32;
                grid.origin[axis] = ((lo / cell).floor() * cell) as f32;
            }
        }
        grid
    }

    /// As the shaders read it.
    pub fn entries(&self) -> [Node; 2] {
        [self.origin, self.cell].map(|vector| Node { corners: vector.map(f32::to_bits), reference: 0 })
    }

    /// The box in cells, rounded outwards.
    pub fn corners(&self, branch: &Branch) -> [u32; 3] {
        std::array::from_fn(|axis| {
            let [origin, cell] = [self.origin, self.cell].map(|vector| f64::from(vector[axis]));
            if cell == 0.0 {
                return 0;
            }
            let at = |corner: [f32; 3]| (f64::from(corner[axis]) - origin) / cell;
            (at(branch.lo).floor() as u32) | (at(branch.hi).ceil() as u32) << 16
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As `node_box` of `glsl/shared/bvh.glsl` does, in float32.
    fn corner(grid: &Grid, corners: [u32; 3], half: u32) -> [f32; 3] {
        std::array::from_fn(|axis| {
            let cells = (corners[axis] >> (16 * half) & 0xffff) as f32;
            let apart = grid.origin[axis] + grid.cell[axis] * cells;
            let fused = grid.cell[axis].mul_add(cells, grid.origin[axis]);
            assert_eq!(apart, fused, "exact, so that it does not matter");
            apart
        })
    }

    #[test]
    fn a_box_on_the_grid_holds_the_box_and_little_more() {
        let mut state = 1u32;
        let mut unit = || {
            state = state.wrapping_mul(747_796_405).wrapping_add(2_891_336_453); // PCG (O'Neill 2014)
            f64::from(state >> 8) / f64::from(1 << 24)
        };
        for (at, size) in [(0.0, 1.0), (3.0, 1e-4), (-1e15, 1e15), (1e6, 1e-3), (0.0, 0.0), (5.0, 0.0), (1e-20, 1e-22)]
        {
            let lo = [0; 3].map(|_| (at * (1.0 + 0.01 * unit())) as f32);
            let root = Branch { lo, hi: lo.map(|x| x + (size * (0.5 + unit())) as f32), ..Branch::default() };
            let grid = Grid::about(&root);
            for _ in 0..1000 {
                let mut inner = root;
                for axis in 0..3 {
                    let mut ends = [unit(), unit()].map(|share| {
                        let [lo, hi] = [root.lo, root.hi].map(|corner| f64::from(corner[axis]));
                        ((lo + share * (hi - lo)) as f32).clamp(root.lo[axis], root.hi[axis])
                    });
                    ends.sort_by(f32::total_cmp);
                    [inner.lo[axis], inner.hi[axis]] = ends;
                }
                let corners = grid.corners(&inner);
                let [lo, hi] = [corner(&grid, corners, 0), corner(&grid, corners, 1)];
                for axis in 0..3 {
                    assert!(lo[axis] <= inner.lo[axis] && inner.hi[axis] <= hi[axis], "{inner:?} in {lo:?} {hi:?}");
                    let more = inner.lo[axis] - lo[axis] + (hi[axis] - inner.hi[axis]);
                    assert!(more <= 2.0 * grid.cell[axis], "{inner:?} in {lo:?} {hi:?}");
                }
            }
            let cells = |axis: usize| (root.hi[axis] - root.lo[axis]) / grid.cell[axis];
            let reach = root.lo[0].abs().max(root.hi[0].abs());
            assert!((0..3).all(|k| cells(k) <= CELLS as f32), "{at} {size}");
            assert!(size == 0.0 || cells(0) > 16_000.0 || grid.cell[0] <= reach * 2.0 * SHARE as f32, "{at} {size}");
        }
    }

    #[test]
    fn where_nothing_is_the_grid_ends() {
        let nowhere = Branch { lo: [f32::MAX; 3], hi: [f32::MAX; 3], count: 1, first: 0 };
        let grid = Grid::about(&nowhere);
        assert_eq!([0, 1].map(|half| corner(&grid, grid.corners(&nowhere), half)), [[f32::MAX; 3]; 2]);
    }
}
