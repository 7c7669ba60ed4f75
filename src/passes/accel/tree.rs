//! Trees by obvhs, flattened into the one array of nodes.
use glam::Vec3A;
use obvhs::{BvhBuildParams, aabb::Aabb, bvh2::builder::build_bvh2};

use super::{
    grid::Grid,
    layout::{GRID_ENTRIES, INDEX_BITS, Node},
};

/// A node: `count` 0 for an inner one with children `first` and `first + 1`, else a leaf of so many primitives.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Branch {
    pub lo: [f32; 3],
    pub count: u32,
    pub hi: [f32; 3],
    pub first: u32,
}

/// A tree whose leaves index `order`, which holds the caller's primitives in the order of the leaves.
pub struct Tree {
    pub nodes: Vec<Branch>,
    pub order: Vec<u32>,
}

/// At most eight primitives a leaf: the shaders keep the count of a node on the stack in four bits.
const PARAMS: BvhBuildParams = BvhBuildParams::medium_build();
const _: () = assert!(PARAMS.max_prims_per_leaf < 16 && !PARAMS.pre_split);

/// One primitive a leaf.
const APART: BvhBuildParams = BvhBuildParams { max_prims_per_leaf: 1, ..PARAMS };

/// Branchs of a tree over so many primitives, at most: one a leaf.
pub fn most_nodes(primitives: usize) -> usize {
    (2 * primitives).saturating_sub(1).max(1)
}

/// Primitives of a leaf of a balanced tree.
const BALANCED_LEAF: usize = 4;

impl Tree {
    /// Of at least one box, at most `deepest` levels for up to 2^(deepest − 1) boxes.
    ///
    /// Clustering chains equal boxes one by one (n coincident triangles make a tree n deep, no better than a list);
    /// a tree too deep for the shaders' stack is thrown away for a balanced one.
    pub fn over(boxes: &[Aabb], deepest: usize) -> Tree {
        let tree = Tree::clustered(boxes, PARAMS);
        if tree.depth() <= deepest { tree } else { Tree::balanced(boxes, BALANCED_LEAF) }
    }

    /// As [`Tree::over`], with a leaf for each box: 2n − 1 nodes wherever the boxes are, and no order but the boxes' own.
    pub fn apart(boxes: &[Aabb], deepest: usize) -> Tree {
        let clustered = Tree::clustered(boxes, APART);
        let fits = clustered.depth() <= deepest && clustered.nodes.len() == most_nodes(boxes.len());
        let mut tree = if fits { clustered } else { Tree::balanced(boxes, 1) };
        for leaf in tree.nodes.iter_mut().filter(|node| node.count > 0) {
            leaf.first = tree.order[leaf.first as usize];
        }
        tree.order = (0..boxes.len() as u32).collect();
        tree
    }

    /// Halved at the median along the longest side of the centres, down to leaves of a few.
    fn balanced(boxes: &[Aabb], leaf: usize) -> Tree {
        let mut tree = Tree { nodes: vec![Branch::default()], order: (0..boxes.len() as u32).collect() };
        let mut open = vec![(0, 0..boxes.len())];
        while let Some((index, range)) = open.pop() {
            let of = |&i: &u32| boxes[i as usize];
            let part = &mut tree.order[range.clone()];
            let around = part.iter().map(of).reduce(|a, b| a.union(&b)).unwrap_or(Aabb::INVALID);
            let (count, first) = if part.len() <= leaf {
                (part.len() as u32, range.start as u32)
            } else {
                let middle = part.len() / 2;
                let centers = Aabb::from_points(&part.iter().map(|i| of(i).center()).collect::<Vec<_>>());
                let axis = centers.largest_axis();
                part.select_nth_unstable_by(middle, |a, b| of(a).center()[axis].total_cmp(&of(b).center()[axis]));
                let first = tree.nodes.len();
                open.extend([(first, range.start..range.start + middle), (first + 1, range.start + middle..range.end)]);
                tree.nodes.extend([Branch::default(); 2]);
                (0, first as u32)
            };
            tree.nodes[index] = Branch { lo: around.min.into(), count, hi: around.max.into(), first };
        }
        tree
    }

    fn clustered(boxes: &[Aabb], params: BvhBuildParams) -> Tree {
        let bvh = build_bvh2(boxes, params, &mut std::time::Duration::default());
        let node = |node: &obvhs::bvh2::node::Bvh2Node| Branch {
            lo: node.aabb().min.into(),
            count: node.prim_count,
            hi: node.aabb().max.into(),
            first: node.first_index,
        };
        Tree { nodes: bvh.nodes.iter().map(node).collect(), order: bvh.primitive_indices }
    }

    /// Fits the boxes of all nodes to where the primitives are now; which lie together stays as it was.
    pub fn refit(&mut self, boxes: &[Aabb]) {
        let (mut open, mut all) = (vec![0], Vec::with_capacity(self.nodes.len()));
        while let Some(index) = open.pop() {
            all.push(index);
            let node = &self.nodes[index];
            if node.count == 0 {
                open.extend([node.first as usize, node.first as usize + 1]);
            }
        }
        // Children come after their parents.
        for index in all.into_iter().rev() {
            let Branch { count, first, .. } = self.nodes[index];
            let (first, count) = (first as usize, count as usize);
            let around = match count {
                0 => [first, first + 1].map(|child| self.bounds(child)).into_iter().reduce(|a, b| a.union(&b)),
                _ => self.order[first..first + count].iter().map(|&p| boxes[p as usize]).reduce(|a, b| a.union(&b)),
            };
            let around = around.unwrap_or(Aabb::INVALID);
            (self.nodes[index].lo, self.nodes[index].hi) = (around.min.into(), around.max.into());
        }
    }

    fn bounds(&self, node: usize) -> Aabb {
        Aabb::new(self.nodes[node].lo.into(), self.nodes[node].hi.into())
    }

    /// What a ray that meets the root is expected to cost, in boxes and primitives that it is tried against (the surface
    /// area heuristic: Goldsmith and Salmon 1987).
    pub fn cost(&self) -> f64 {
        let area = |node: usize| f64::from(self.bounds(node).half_area());
        let whole = area(0).max(f64::MIN_POSITIVE);
        let (mut open, mut sum) = (vec![0], 0.0);
        while let Some(index) = open.pop() {
            let node = &self.nodes[index];
            sum += area(index) / whole * f64::from(node.count.max(1));
            if node.count == 0 {
                open.extend([node.first as usize, node.first as usize + 1]);
            }
        }
        sum
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

    /// Entries of the tree as the shaders read it.
    pub fn entries(&self) -> usize {
        GRID_ENTRIES as usize + self.nodes.len()
    }

    /// The tree as the shaders read it: its grid, then its nodes, which begin at `entry` of all; primitives are counted from
    /// `primitive` on.
    pub fn packed(&self, entry: u32, primitive: u32) -> impl Iterator<Item = Node> {
        let grid = Grid::about(&self.nodes[0]);
        let nodes = self.nodes.iter().map(move |branch| {
            let first = branch.first + if branch.count == 0 { entry + GRID_ENTRIES } else { primitive };
            Node { corners: grid.corners(branch), reference: branch.count << INDEX_BITS | first }
        });
        grid.entries().into_iter().chain(nodes)
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
            check(&Tree::clustered(&boxes, PARAMS), &boxes);
            check(&Tree::balanced(&boxes, BALANCED_LEAF), &boxes);
        }
    }

    #[test]
    fn a_leaf_for_each_box_makes_as_many_nodes_wherever_they_are() {
        for count in [1, 2, 3, 9, 100] {
            for (what, boxes) in
                [("apart", boxes(count, |i| (i * 7919 % count) as f32)), ("equal", boxes(count, |_| 1.0))]
            {
                let tree = Tree::apart(&boxes, 24);
                check(&tree, &boxes);
                assert_eq!(tree.nodes.len(), most_nodes(count), "{count} {what}");
                assert!(tree.depth() <= 24 && tree.order.iter().enumerate().all(|(k, &p)| k == p as usize));
            }
        }
    }

    #[test]
    fn a_refitted_tree_holds_what_has_moved_and_costs_more_the_more_it_is_torn() {
        let here = boxes(1000, |i| (i * 7919 % 1000) as f32);
        let mut tree = Tree::over(&here, 40);
        let built = tree.cost();
        tree.refit(&here);
        assert_eq!(tree.cost(), built, "where nothing has moved nothing changes");
        let along = boxes(1000, |i| 3.0 + 2.0 * (i * 7919 % 1000) as f32);
        tree.refit(&along);
        check(&tree, &along);
        assert!(tree.cost() < 1.1 * built, "drawn out it is as good: {} of {built}", tree.cost());
        let torn = boxes(1000, |i| (i * 104_729 % 1000) as f32);
        tree.refit(&torn);
        check(&tree, &torn);
        assert!(tree.cost() > 10.0 * built, "{} of {built}", tree.cost());
    }

    #[test]
    fn equal_boxes_make_no_deep_tree() {
        let same = boxes(5000, |_| 1.0);
        assert!(
            Tree::clustered(&same, PARAMS).depth() > 1000,
            "clustering has learnt to balance: drop the other builder"
        );
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
