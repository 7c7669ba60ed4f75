//! Windows of the map for receivers that are no lit rectangle: diffuse objects of any shape, and the backs of quads.
//!
//! A shape is seen along the axes of its own frame, from both sides of each. A surface of unit normal n is seen by up to
//! three of these views, with cosines whose squares sum to one: each has that share of its light, and the eye adds what
//! they hold. Nothing is counted twice, there is no seam where one view takes over from another, and a view has next to
//! nothing of what it sees edge-on.
//!
//! All windows are of one size, as many in a layer as fit, 8 × 8 at most: a shape takes the eighth to the third of a map's
//! side for each of its views, and next to no memory.

use glam::{DAffine3, DMat3, DVec2, DVec3};

use super::{
    Axes, Job, RECEIVERS,
    views::{ANY, MapView, Sides},
};
use crate::{
    passes::extents,
    scene::{Canonical, Object, Scene, Shape},
    settings::Settings,
    view::{Extent, View},
};

/// Windows along a layer's side, at most.
const MOST: u32 = 8;
/// Margins that a window is wide at least: half of it shows the receiver.
const MARGINS: f64 = 4.0;
/// Least side of what a window shows, of the greatest.
const THINNEST: f64 = 1e-6;

/// What a window shows.
struct Shown {
    receiver: usize,
    /// Along `forward`, content from 0 to 1 of the window without its margins.
    view: View,
    sides: Sides,
}

/// Windows for what no rectangle of the job's holds, in layers from `first` on; `full`: texels of margin about each.
pub fn of_shapes(job: &mut Job<'_>, axes: Axes<'_>, (side, full): (u32, f64), first: usize) -> Vec<MapView> {
    if job.work.settings.choice(&RECEIVERS) != "all" {
        return Vec::new();
    }
    let shown = shown(job);
    if shown.is_empty() {
        return Vec::new();
    }
    let wide = match axes {
        Axes { splat: "fixed", merge: "exact", .. } => Some("maps.merge = exact".to_owned()),
        Axes { splat: "fixed" | "cells", .. } => None,
        _ => Some(format!("maps.splat = {}", axes.splat)),
    };
    if let Some(wide) = wide {
        let reason = format!("{wide}: its splats reach from one window into the next");
        job.work.plan.leave_out("maps/windows", reason);
        return Vec::new();
    }
    let across = across(shown.len(), (side, full));
    let window = |(k, shown): (usize, Shown)| {
        let (place, layer) = (k % (across * across), first + k / (across * across));
        let at = DVec2::new((place % across) as f64, (place / across) as f64) / across as f64;
        let view = placed(shown.view, at, 1.0 / across as f64, full / f64::from(side));
        let (low, high) = (at.as_vec2(), (at + 1.0 / across as f64).as_vec2());
        MapView {
            view: view.data(),
            receiver: shown.receiver as u32,
            light: ANY,
            layer: layer as u32,
            sides: shown.sides as u32,
            low: low.to_array(),
            high: high.to_array(),
        }
    };
    shown.into_iter().enumerate().map(window).collect()
}

/// Windows along a layer's side, of so many.
fn across(count: usize, (side, full): (u32, f64)) -> usize {
    let fit = (f64::from(side) / (MARGINS * full)).floor().max(1.0) as u32;
    (count as f64).sqrt().ceil().min(f64::from(MOST.min(fit))) as usize
}

/// Layers that windows take for the receivers `seen`.
pub fn most_layers(scene: &Scene, settings: &Settings, seen: &[usize], sizes: (u32, f64)) -> u64 {
    if settings.choice(&RECEIVERS) != "all" {
        return 0;
    }
    let views = seen.iter().map(|&receiver| match &scene.objects[receiver].shape {
        Shape::Quad { center, u, v } => usize::from(has_back(scene, *center, u.cross(*v))),
        shape => 2 * frame_and_axes(shape).1.len(),
    });
    let count: usize = views.sum();
    count.div_ceil(across(count, sizes).pow(2).max(1)) as u64
}

/// Whether light may come to a quad's back. Where the scene moves, what lies behind may change, and the views may not.
fn has_back(scene: &Scene, center: DVec3, normal: DVec3) -> bool {
    scene.moves() || lies_beyond(scene, center, -normal)
}

/// Of every receiver that the camera may see beside the region's, what no rectangle shows.
fn shown(job: &Job<'_>) -> Vec<Shown> {
    let scene = job.work.scene;
    let views = job.work.seen.iter().flat_map(|&receiver| match &scene.objects[receiver].shape {
        Shape::Quad { center, u, v } => {
            let back = has_back(scene, *center, u.cross(*v));
            let view = View::of_rectangle(*center, -*u, *v, [DVec2::ZERO; 2], job.work.everything);
            back.then_some(Shown { receiver, view, sides: Sides::Facing }).into_iter().collect::<Vec<_>>()
        }
        _ => of_object(&scene.objects[receiver], receiver, job.work.everything),
    });
    views.collect()
}

/// The views along the axes in which a shape has a surface.
fn of_object(object: &Object, receiver: usize, everything: &Extent) -> Vec<Shown> {
    let content = extents::of_object(object);
    let (frame, axes) = frame_and_axes(&object.shape);
    let views = axes.iter().flat_map(|&axis| [1.0, -1.0].map(|sign| (axis, sign)));
    let of = |(axis, sign): (usize, f64)| {
        let (out, right) = (sign * frame.col(axis), frame.col((axis + 1) % 3));
        Shown { receiver, view: along(out, right, &content, everything), sides: Sides::Shared }
    };
    views.map(of).collect()
}

/// A shape's frame, and the axes along which it is seen from both sides.
fn frame_and_axes(shape: &Shape) -> (DMat3, &'static [usize]) {
    match shape {
        Shape::Canonical { kind: Canonical::Disk, to_world } => (frame_of(to_world), &[2]),
        Shape::Canonical { kind: Canonical::Cylinder { .. }, to_world } => (frame_of(to_world), &[0, 1]),
        Shape::Canonical { to_world, .. } | Shape::Mesh { to_world, .. } => (frame_of(to_world), &[0, 1, 2]),
        Shape::Sphere { .. } | Shape::Quad { .. } => (DMat3::IDENTITY, &[0, 1, 2]),
    }
}

/// Unit axes at right angles, the first of them along the object's own.
fn frame_of(to_world: &DAffine3) -> DMat3 {
    let m = to_world.matrix3;
    let x = m.x_axis.normalize_or(DVec3::X);
    let y = (m.y_axis - m.y_axis.dot(x) * x).try_normalize().unwrap_or(x.any_orthonormal_vector());
    DMat3::from_cols(x, y, x.cross(y))
}

/// A view of the content from outside, against `out`.
fn along(out: DVec3, right: DVec3, content: &Extent, everything: &Extent) -> View {
    let (up, forward) = (out.cross(right), -out);
    let [x, y] = [right, up].map(|axis| content.along(axis));
    let (front, back) = content.along(forward);
    let (nearest, farthest) = everything.along(forward);
    let scale = (x.1 - x.0).max(y.1 - y.0).max(back - front).max(f64::MIN_POSITIVE);
    let half = (0.5 * DVec2::new(x.1 - x.0, y.1 - y.0)).max(DVec2::splat(THINNEST * scale));
    let origin = 0.5 * ((x.0 + x.1) * right + (y.0 + y.1) * up) + front * forward;
    let (near, far) = (nearest.min(front) - front - scale, farthest.max(back) - front + scale);
    View { origin, right, up, forward, low: -half, high: half, near, far, perspective: false }
}

/// A view whose content fills a window of a layer but for its margins: `at` the window's upper left, `wide` its sides and
/// `margin`, all in parts of the layer's side.
fn placed(view: View, at: DVec2, wide: f64, margin: f64) -> View {
    let margin = margin.min(wide / MARGINS);
    let metres = (view.high - view.low) / (wide - 2.0 * margin); // that the layer's side shows
    let before = DVec2::new(at.x + margin, 1.0 - at.y - wide + margin); // the layer's part left of it, and below
    let low = view.low - before * metres;
    View { low, high: low + metres, ..view }
}

/// Whether something specular lies beyond a plane, on the side of its normal.
pub fn lies_beyond(scene: &Scene, on: DVec3, normal: DVec3) -> bool {
    let specular = extents::specular(scene);
    !specular.is_empty() && specular.along(normal).1 > on.dot(normal)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Some sums and quotients of numbers of order one.
    const ROUNDING: f64 = 1e-12;

    #[test]
    fn a_window_shows_the_content_within_its_margins() {
        let content = Extent { points: vec![DVec3::new(1.0, 2.0, 3.0), DVec3::new(2.0, 5.0, 3.5)], spheres: vec![] };
        for (out, right) in [(DVec3::X, DVec3::Y), (DVec3::NEG_Z, DVec3::X)] {
            let view = along(out, right, &content, &content);
            assert!((view.right.cross(view.up) + view.forward).length() < ROUNDING, "right-handed");
            let (at, wide, margin) = (DVec2::new(0.25, 0.5), 0.25, 0.03);
            let placed = placed(view, at, wide, margin);
            let corners = content.points.iter().map(|p| placed.project(*p).expect("it lies before the view"));
            let corners: Vec<_> = corners.collect();
            let (low, high) = (corners[0].min(corners[1]), corners[0].max(corners[1]));
            assert!((low - (at + margin)).length() < ROUNDING && (high - (at + wide - margin)).length() < ROUNDING);
        }
    }

    #[test]
    fn a_frame_is_at_right_angles_whatever_the_object_is_put_through() {
        let sheared = DMat3::from_cols(DVec3::new(2.0, 0.0, 0.0), DVec3::new(1.0, 1.0, 0.0), DVec3::new(0.0, 3.0, 0.1));
        for matrix in [sheared, DMat3::ZERO, DMat3::from_rotation_y(0.4)] {
            let frame = frame_of(&DAffine3::from_mat3(matrix));
            assert!((frame.transpose() * frame - DMat3::IDENTITY).determinant().abs() < ROUNDING);
            assert!((frame.determinant() - 1.0).abs() < ROUNDING, "{frame}");
        }
    }
}
