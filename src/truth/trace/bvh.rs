//! A bounding volume hierarchy in float64: built by the surface area heuristic, walked nearest child first.

use glam::DVec3;

/// Primitives of a leaf at most.
const LEAF: usize = 4;
/// Levels split by the surface area heuristic; deeper ones are halved, which ends after log2(n) more.
const HEURISTIC_LEVELS: usize = 40;
/// [`HEURISTIC_LEVELS`] and the halvings of 2^32 primitives.
const STACK: usize = HEURISTIC_LEVELS + 34;
/// Boxes are grown by this share of the scene's largest coordinate: the roundings of a slab test, thousands of times.
const ROOM: f64 = 1e-12;

type Bounds = [DVec3; 2];

#[derive(Clone, Debug)]
struct Node {
    bounds: Bounds,
    /// First child (the second follows) or, of a leaf, first place in `order`.
    first: u32,
    /// Primitives of a leaf; 0 of an inner node.
    count: u32,
}

/// The tree over boxes.
#[derive(Clone, Debug, Default)]
pub struct Bvh {
    nodes: Vec<Node>,
    order: Vec<u32>,
}

impl Bvh {
    /// Over the boxes of primitives, in their order.
    pub fn over(boxes: &[Bounds]) -> Self {
        let mut tree = Self { nodes: vec![], order: (0..boxes.len() as u32).collect() };
        if boxes.is_empty() {
            return tree;
        }
        let whole = boxes.iter().copied().reduce(join).unwrap_or_default();
        let room = ROOM * whole[0].abs().max(whole[1].abs()).max_element();
        let grown: Vec<Bounds> = boxes.iter().map(|b| [b[0] - room, b[1] + room]).collect();
        tree.nodes.push(Node { bounds: whole, first: 0, count: 0 });
        let mut open = vec![(0, 0..boxes.len(), 0)];
        while let Some((index, range, level)) = open.pop() {
            let part = &mut tree.order[range.clone()];
            let bounds = part.iter().map(|&i| grown[i as usize]).reduce(join).unwrap_or_default();
            let node = if part.len() <= LEAF {
                Node { bounds, first: range.start as u32, count: part.len() as u32 }
            } else {
                let middle = range.start + split(part, &grown, level);
                let first = tree.nodes.len();
                tree.nodes.extend([Node { bounds, first: 0, count: 0 }, Node { bounds, first: 0, count: 0 }]);
                open.extend([(first, range.start..middle, level + 1), (first + 1, middle..range.end, level + 1)]);
                Node { bounds, first: first as u32, count: 0 }
            };
            tree.nodes[index] = node;
        }
        tree
    }

    /// Calls `visit` with each primitive whose box the ray meets before the distance that `visit` last returned.
    pub fn walk(&self, o: DVec3, d: DVec3, mut far: f64, mut visit: impl FnMut(u32, f64) -> f64) {
        let inverse = d.recip();
        let (mut stack, mut height) = ([(0u32, 0.0f64); STACK], 0);
        let root = self.nodes.first().and_then(|n| enter(&n.bounds, o, inverse, far));
        if let Some(near) = root {
            (stack[0], height) = ((0, near), 1);
        }
        while height > 0 {
            height -= 1;
            let (index, near) = stack[height];
            if near > far {
                continue;
            }
            let node = &self.nodes[index as usize];
            for &primitive in &self.order[node.first as usize..][..node.count as usize * usize::from(node.count > 0)] {
                far = visit(primitive, far);
            }
            if node.count > 0 {
                continue;
            }
            let children = [node.first, node.first + 1];
            let mut met = children.map(|c| (c, enter(&self.nodes[c as usize].bounds, o, inverse, far)));
            // The nearer one comes off the stack first.
            if met[0].1.unwrap_or(f64::INFINITY) < met[1].1.unwrap_or(f64::INFINITY) {
                met.swap(0, 1);
            }
            for (child, near) in met {
                if let Some(near) = near {
                    stack[height] = (child, near);
                    height += 1;
                }
            }
        }
    }
}

fn join(a: Bounds, b: Bounds) -> Bounds {
    [a[0].min(b[0]), a[1].max(b[1])]
}

fn half_area([low, high]: Bounds) -> f64 {
    let s = high - low;
    s.x * s.y + s.y * s.z + s.z * s.x
}

/// Sorts along the longest side of the centres and says how many go to the first child.
fn split(part: &mut [u32], boxes: &[Bounds], level: usize) -> usize {
    let centre = |i: u32| boxes[i as usize][0] + boxes[i as usize][1];
    let spread = part.iter().map(|&i| [centre(i); 2]).reduce(join).unwrap_or_default();
    let side = spread[1] - spread[0];
    let axis = (0..3).fold(0, |best, k| if side[k] > side[best] { k } else { best });
    part.sort_by(|&a, &b| centre(a)[axis].total_cmp(&centre(b)[axis]).then(a.cmp(&b)));
    if level >= HEURISTIC_LEVELS {
        return part.len() / 2;
    }
    let mut after = vec![0.0; part.len()];
    let mut bounds = boxes[part[part.len() - 1] as usize];
    for k in (1..part.len()).rev() {
        bounds = join(bounds, boxes[part[k] as usize]);
        after[k] = half_area(bounds) * (part.len() - k) as f64;
    }
    let mut best = (f64::INFINITY, part.len() / 2);
    bounds = boxes[part[0] as usize];
    for k in 1..part.len() {
        let cost = half_area(bounds) * k as f64 + after[k];
        if cost < best.0 {
            best = (cost, k);
        }
        bounds = join(bounds, boxes[part[k] as usize]);
    }
    best.1
}

/// Where the ray enters the box, not before 0, if it does before `far`. A NaN (0·∞) constrains nothing.
fn enter([low, high]: &Bounds, o: DVec3, inverse: DVec3, far: f64) -> Option<f64> {
    let (mut near, mut end) = (0.0f64, far);
    for k in 0..3 {
        let (a, b) = ((low[k] - o[k]) * inverse[k], (high[k] - o[k]) * inverse[k]);
        near = near.max(a.min(b));
        end = end.min(a.max(b));
    }
    (near <= end).then_some(near)
}
