//! The traversal of Wyman 2008 (listings of sections 3.1 and 3.2) on the CPU, over the photons of one view, in float32.

use glam::{IVec2, Vec2, Vec3};
use nephroid::{
    gpu::{BufferDecl, Plan},
    renderer::{Dump, Renderer},
    view::ViewData,
};

/// A layer of the map: `MapView` of `glsl/maps/views.glsl`.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct MapView {
    view: ViewData,
    receiver: u32,
    light: u32,
    layer: u32,
    sides: u32,
    window: [[f32; 2]; 2],
}

const ANY: u32 = u32::MAX;

/// Level 0 is the photon image; those above are a quarter each. A layer of the photon image.
struct Level {
    side: u32,
    hit: Vec<[f32; 4]>,
    normal: Vec<f32>,
    /// What is exactly known of the photons below each texel that some map takes.
    cluster: Vec<Option<Cluster>>,
}

/// Photons that are merged with exact books.
#[derive(Clone, Copy)]
struct Cluster {
    /// Receiver and layer of the map; `None` of several.
    place: Option<(u32, i32)>,
    /// Texels of the map.
    bounds: [Vec2; 2],
}

impl Cluster {
    fn joined(self, other: Self) -> Self {
        let place = self.place.filter(|_| self.place == other.place);
        let [low, high] = self.bounds;
        Self { place, bounds: [low.min(other.bounds[0]), high.max(other.bounds[1])] }
    }
}

/// When clusters are tested.
#[derive(Clone, Copy, PartialEq)]
pub enum Merge {
    None,
    Last,
    All,
    /// Up to so many texels apart.
    Exact(f32),
}

/// The photons of a frame, by layer and level, and the map's views.
pub struct Model {
    layers: Vec<Vec<Level>>,
    views: Vec<MapView>,
    map_side: f32,
    merge: Merge,
}

/// Points that each step takes, from the topmost level down, and those that are splatted; how many of them are ready.
#[derive(Debug, PartialEq)]
pub struct Counts {
    pub points: Vec<u64>,
    pub ready: u64,
}

fn texels(renderer: &Renderer, name: &str) -> Vec<Vec<[f32; 4]>> {
    match renderer.dump(name).expect("it is in the plan") {
        Dump::Image { layers, .. } => layers.iter().map(|l| bytemuck::pod_collect_to_vec(l)).collect(),
        Dump::Buffer(_) => panic!("{name} is an image"),
    }
}

fn content<'p>(plan: &'p Plan, name: &str) -> &'p BufferDecl {
    plan.buffers.iter().find(|b| b.name == name).expect("it is in the plan")
}

/// The mean of the valid children, or for what does not merge any valid one.
fn above(below: &Level) -> Level {
    let side = below.side.div_ceil(2);
    let mut level = Level { side, hit: Vec::new(), normal: Vec::new(), cluster: Vec::new() };
    for at in 0..side * side {
        let children = (0..4).map(|k| (2 * (at % side) + (k & 1), 2 * (at / side) + (k >> 1)));
        let inside = children.filter(|(x, y)| *x < below.side && *y < below.side);
        let indices = inside.map(|(x, y)| (y * below.side + x) as usize);
        let indices: Vec<usize> = indices.collect();
        level.cluster.push(indices.iter().filter_map(|&i| below.cluster[i]).reduce(Cluster::joined));
        let valid: Vec<usize> = indices.into_iter().filter(|&i| below.hit[i][3] != 0.0).collect();
        let sum = valid.iter().fold(Vec3::ZERO, |sum, &i| sum + Vec3::from_slice(&below.hit[i][..3]));
        let mean = sum * if valid.is_empty() { 0.0 } else { 1.0 / valid.len() as f32 };
        let first = valid.first().map_or((0.0, 0.0), |&i| (below.hit[i][3], below.normal[i]));
        level.hit.push([mean.x, mean.y, mean.z, first.0]);
        level.normal.push(first.1);
    }
    level
}

/// As `octahedral_unpack` of `glsl/shared/octahedral.glsl`.
fn unpacked(packed: f32) -> Vec3 {
    let bits = packed as u32;
    let part = |b: u32| b as f32 / 4094.0 * 2.0 - 1.0;
    let (x, y) = (part(bits / 4096), part(bits % 4096));
    let z = 1.0 - x.abs() - y.abs();
    let folded = |v: f32, other: f32| if z >= 0.0 { v } else { (1.0 - other.abs()).copysign(v) };
    Vec3::new(folded(x, y), folded(y, x), z).normalize()
}

impl Model {
    /// From a frame that was rendered with levels down to a topmost one of `top` texels at most.
    pub fn of(renderer: &Renderer, merge: Merge, top: u32) -> Self {
        let plan = renderer.plan();
        let bytes = content(plan, "maps/views").content.clone().expect("the views are uploaded");
        let map = plan.images.iter().find(|i| i.name == "maps/map").expect("there is a map");
        let (hit, flux) = (texels(renderer, "light/photons.hit"), texels(renderer, "light/photons.flux"));
        let (views, map_side) = (bytemuck::pod_collect_to_vec(&bytes), map.extent[0] as f32);
        let mut model = Self { layers: Vec::new(), views, map_side, merge };
        let layer = |(hit, flux): (Vec<[f32; 4]>, Vec<[f32; 4]>)| {
            let (side, normal) = (hit.len().isqrt() as u32, flux.iter().map(|f| f[3]).collect::<Vec<f32>>());
            let cluster = hit.iter().zip(&normal).map(|(&hit, &normal)| model.cluster(hit, normal)).collect();
            let mut levels = vec![Level { side, hit, normal, cluster }];
            while levels.last().is_some_and(|level| level.side > top) {
                levels.extend(levels.last().map(above));
            }
            levels
        };
        model.layers = hit.into_iter().zip(flux).map(layer).collect();
        model
    }

    /// A photon that some map takes.
    fn cluster(&self, hit: [f32; 4], normal: f32) -> Option<Cluster> {
        if hit[3] == 0.0 {
            return None;
        }
        let receiver = hit[3] as u32 - 1;
        let (at, layer) = self.landing(Vec3::from_slice(&hit[..3]), unpacked(normal), receiver)?;
        Some(Cluster { place: Some((receiver, layer)), bounds: [at; 2] })
    }

    /// Where in which layer of the map a photon falls, texels.
    fn landing(&self, p: Vec3, n: Vec3, receiver: u32) -> Option<(Vec2, i32)> {
        let each = (0..).zip(&self.views).filter(|(_, v)| v.light == ANY || v.light == 0);
        each.filter(|(_, v)| v.receiver == ANY || v.receiver == receiver).find_map(|(layer, v)| {
            let view = &v.view;
            let q = p - Vec3::from(view.origin);
            let z = q.dot(view.forward.into());
            let towards = if view.perspective != 0 { q } else { view.forward.into() };
            if z < view.near || n.dot(towards) >= 0.0 {
                return None;
            }
            let depth = if view.perspective != 0 { z } else { 1.0 };
            let (x, y) = (q.dot(view.right.into()) / depth, q.dot(view.up.into()) / depth);
            let (x, y) = ((x - view.x0) / (view.x1 - view.x0), (view.y1 - y) / (view.y1 - view.y0));
            let inside = (0.0..1.0).contains(&x) && (0.0..1.0).contains(&y);
            inside.then(|| (Vec2::new(x, y) * self.map_side, layer))
        })
    }

    fn converges(&self, level: &Level, children: &[IVec2]) -> bool {
        let mut common = None;
        for &at in children {
            let index = (at.y as u32 * level.side + at.x as u32) as usize;
            let hit = level.hit[index];
            if hit[3] == 0.0 {
                return false;
            }
            let landing = self.landing(Vec3::from_slice(&hit[..3]), unpacked(level.normal[index]), hit[3] as u32 - 1);
            let texel = landing.map(|(at, layer)| at.floor().as_ivec2().extend(layer));
            if texel.is_none() || common.is_some_and(|c| Some(c) != texel) {
                return false;
            }
            common = texel;
        }
        common.is_some()
    }

    /// The texels below one, as far as the image goes.
    fn children(below: &Level, at: IVec2) -> Vec<IVec2> {
        let side = IVec2::splat(below.side as i32);
        (0..4).map(|k| 2 * at + IVec2::new(k & 1, k >> 1)).filter(|c| c.cmplt(side).all()).collect()
    }

    /// Whether a texel of a level holds what may be splatted.
    fn is_valid(&self, level: &Level, at: IVec2) -> bool {
        let index = (at.y as u32 * level.side + at.x as u32) as usize;
        match self.merge {
            Merge::Exact(_) => level.cluster[index].is_some(),
            _ => level.hit[index][3] != 0.0,
        }
    }

    /// Whether a texel of a level, from 1 on, is splatted as one.
    fn is_one(&self, levels: &[Level], level: usize, at: IVec2) -> bool {
        if let Merge::Exact(reach) = self.merge {
            let own = levels[level].cluster[(at.y as u32 * levels[level].side + at.x as u32) as usize];
            return own.is_some_and(|c| c.place.is_some() && (c.bounds[1] - c.bounds[0]).max_element() <= reach);
        }
        let tested = self.merge == Merge::All || self.merge == Merge::Last && level == 1;
        // What reaches beyond the photons has children that are none.
        let whole = ((at + 1) * (1 << level)).max_element() <= levels[0].side as i32;
        tested && whole && self.converges(&levels[level - 1], &Self::children(&levels[level - 1], at))
    }

    /// How many points each step takes.
    pub fn counts(&self) -> Counts {
        let steps = self.layers[0].len() - 1;
        let mut counts = Counts { points: vec![0; steps + 1], ready: 0 };
        for levels in &self.layers {
            let top = levels[steps].side as i32;
            let mut points: Vec<IVec2> = (0..top * top).map(|at| IVec2::new(at % top, at / top)).collect();
            let mut ready = 0;
            for level in (1..=steps).rev() {
                counts.points[steps - level] += points.len() as u64 + ready;
                let mut next = Vec::new();
                for at in points.into_iter().filter(|&at| self.is_valid(&levels[level], at)) {
                    if self.is_one(levels, level, at) {
                        ready += 1;
                    } else {
                        next.extend(Self::children(&levels[level - 1], at));
                    }
                }
                points = next;
            }
            counts.points[steps] += points.len() as u64 + ready;
            counts.ready += ready;
        }
        counts
    }

    /// How many splats lie below each texel of each level from 1 on, layer by layer: of valid photons and of clusters.
    pub fn splats(&self) -> Vec<Vec<Vec<u32>>> {
        let valid = |level: &Level| level.hit.iter().map(|hit| u32::from(hit[3] != 0.0)).collect();
        let of_layer = |levels: &Vec<Level>| {
            let mut counts: Vec<Vec<u32>> = vec![valid(&levels[0])];
            for level in 1..levels.len() {
                let (side, below) = (levels[level].side as i32, &counts[level - 1]);
                let texels = (0..side * side).map(|at| IVec2::new(at % side, at / side));
                let count = texels.map(|at| match self.is_valid(&levels[level], at) {
                    true if self.is_one(levels, level, at) => 1,
                    true => {
                        let children = Self::children(&levels[level - 1], at).into_iter();
                        children.map(|c| below[(c.y as u32 * levels[level - 1].side + c.x as u32) as usize]).sum()
                    }
                    false => 0,
                });
                counts.push(count.collect());
            }
            counts.split_off(1)
        };
        self.layers.iter().map(of_layer).collect()
    }
}
