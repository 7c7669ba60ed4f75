//! Trees by obvhs, flattened into the one array of nodes.
use glam::Vec3A;
use obvhs::{BvhBuildParams, aabb::Aabb, bvh2::builder::build_bvh2};

use super::layout::Node;

/// A tree whose leaves index `order`, which holds the caller's primitives in the order of the leaves.
pub struct Tree {
    pub nodes: Vec<Node>,
    pub order: Vec<u32>,
}

/// At most eight primitives a leaf: the shaders keep the count of a node on the stack in four bits.
const PARAMS: BvhBuildParams = BvhBuildParams::medium_build();
const _: () = assert!(PARAMS.max_prims_per_leaf < 16 && !PARAMS.pre_split);

/// Primitives of a leaf of a balanced tree.
const BALANCED_LEAF: usize = 4;

impl Tree {
    /// Of at least one box, at most `deepest` levels for up to 2^(deepest − 1) boxes.
    ///
    /// Clustering chains equal boxes one by one (n coincident triangles make a tree n deep, no better than a list);
    /// a tree too deep for the shaders' stack is thrown away for a balanced one.
    pub fn over(boxes: &[Aabb], deepest: usize) -> Tree {
        let tree = Tree::clustered(boxes);
        if tree.depth() <= deepest { tree } else { Tree::balanced(boxes) }
    }

    /// Halved at the median along the longest side of the centres, down to leaves of a few.
    fn balanced(boxes: &[Aabb]) -> Tree {
        let mut tree = Tree { nodes: vec![Node::default()], order: (0..boxes.len() as u32).collect() };
        let mut open = vec![(0, 0..boxes.len())];
        while let Some((index, range)) = open.pop() {
            let of = |&i: &u32| boxes[i as usize];
            let part = &mut tree.order[range.clone()];
            let around = part.iter().map(of).reduce(|a, b| a.union(&b)).unwrap_or(Aabb::INVALID);
            let (count, first) = if part.len() <= BALANCED_LEAF {
                (part.len() as u32, range.start as u32)
            } else {
                let middle = part.len() / 2;
                let centers = Aabb::from_points(&part.iter().map(|i| of(i).center()).collect::<Vec<_>>());
                let axis = centers.largest_axis();
                part.select_nth_unstable_by(middle, |a, b| of(a).center()[axis].total_cmp(&of(b).center()[axis]));
                let first = tree.nodes.len();
                open.extend([(first, range.start..range.start + middle), (first + 1, range.start + middle..range.end)]);
                tree.nodes.extend([Node::default(); 2]);
                (0, first as u32)
            };
            tree.nodes[index] = Node { lo: around.min.into(), count, hi: around.max.into(), first };
        }
        tree
    }

    fn clustered(boxes: &[Aabb]) -> Tree {
        let bvh = build_bvh2(boxes, PARAMS, &mut std::time::Duration::default());
        let node = |node: &obvhs::bvh2::node::Bvh2Node| Node {
            lo: node.aabb().min.into(),
            count: node.prim_count,
            hi: node.aabb().max.into(),
            first: node.first_index,
        };
        Tree { nodes: bvh.nodes.iter().map(node).collect(), order: bvh.primitive_indices }
    }

    /// Levels, the root's among them. Without recursion: a degenerate tree may be as deep as it has leaves.
    pub fn depth(&self) -> usize {
        let mut open = vec![(0, 1)];
        let mut deepest = 0;
        while let Some((index, level)) = open.pop() {
            let node = &self.nodes[index];
            deepest = deepest.max(level);
            if node.count == 0 {
                open.extend([(node.first as usize, level + 1), (node.first as usize + 1, level + 1)]);
            }
        }
        deepest
    }

    /// The nodes with their indices moved: children by `nodes`, primitives by `primitives`.
    pub fn moved(&self, nodes: u32, primitives: u32) -> impl Iterator<Item = Node> {
        self.nodes.iter().map(move |n| Node { first: n.first + if n.count == 0 { nodes } else { primitives }, ..*n })
    }
}

/// A box about points in float32, grown by a few roundings: what a shader computes of a surface stays inside.
pub fn roomy_box(lo: glam::DVec3, hi: glam::DVec3) -> Aabb {
    /// Roundings of a point mapped to world space (four products, their sums, the stored entries), with as much again.
    const ROUNDINGS: f64 = 8.0 * f32::EPSILON as f64;
    let room = lo.abs().max(hi.abs()).max_element() * ROUNDINGS;
    let narrow = |v: glam::DVec3| Vec3A::new(v.x as f32, v.y as f32, v.z as f32);
    Aabb::new(narrow(lo - room), narrow(hi + room))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn boxes(count: usize, at: impl Fn(usize) -> f32) -> Vec<Aabb> {
        (0..count).map(|i| Aabb::new(Vec3A::splat(at(i)), Vec3A::splat(at(i) + 0.5))).collect()
    }

    /// Every primitive lies in exactly one leaf, inside the boxes of all nodes above it.
    fn check(tree: &Tree, boxes: &[Aabb]) {
        let mut seen = vec![0; boxes.len()];
        let everywhere = (Vec3A::splat(f32::NEG_INFINITY), Vec3A::splat(f32::INFINITY));
        let mut open = vec![(0usize, everywhere)];
        while let Some((index, (lo, hi))) = open.pop() {
            let node = tree.nodes[index];
            let inside = (lo.max(node.lo.into()), hi.min(node.hi.into()));
            if node.count == 0 {
                open.extend([(node.first as usize, inside), (node.first as usize + 1, inside)]);
                continue;
            }
            for &p in &tree.order[node.first as usize..][..node.count as usize] {
                seen[p as usize] += 1;
                let b = &boxes[p as usize];
                assert!(b.min.cmpge(inside.0).all() && b.max.cmple(inside.1).all(), "box {p} outside its leaf");
            }
        }
        assert!(seen.iter().all(|&n| n == 1), "{seen:?}");
    }

    #[test]
    fn leaves_hold_every_primitive_once() {
        for count in [1, 2, 3, 9, 1000] {
            let boxes = boxes(count, |i| (i * 7919 % count) as f32);
            check(&Tree::clustered(&boxes), &boxes);
            check(&Tree::balanced(&boxes), &boxes);
        }
    }

    #[test]
    fn equal_boxes_make_no_deep_tree() {
        let same = boxes(5000, |_| 1.0);
        assert!(Tree::clustered(&same).depth() > 1000, "clustering has learnt to balance: drop the other builder");
        let tree = Tree::over(&same, 24);
        check(&tree, &same);
        assert_eq!(tree.depth(), 12, "5000 halved down to 4: 11 times");
    }

    #[test]
    fn a_roomy_box_holds_its_points_in_float32() {
        let point = glam::DVec3::new(0.1, -1e9 / 3.0, 0.0);
        let b = roomy_box(point, point);
        assert!(b.min.as_dvec3().cmplt(point).all() && b.max.as_dvec3().cmpgt(point).all(), "{b:?}");
    }
}
