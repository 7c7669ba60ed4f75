//! A camera that the mouse moves about its target.

use glam::{DQuat, DVec2, DVec3};

use crate::scene::{Camera, CameraKind};

/// A drag over the window's height turns by this, radians.
const TURN: f64 = std::f64::consts::PI;
/// The nearest that the eye comes to straight above or below its target, radians.
const POLE: f64 = 0.01;
/// The distance after a notch of the wheel.
const NOTCH: f64 = 0.9;
/// Notches that a single event may count for: a wheel that reports nonsense loses no scene.
const MOST_NOTCHES: f64 = 10.0;

/// Turns the eye about its target, as if the scene were held by the mouse. `drag`: of the window's height, y downwards.
pub(super) fn orbit(camera: &mut Camera, drag: DVec2) {
    let arm = DQuat::from_axis_angle(camera.up, -TURN * drag.x) * (camera.position - camera.target);
    let right = camera.up.cross(arm).normalize_or(DVec3::X);
    let polar = arm.angle_between(camera.up);
    let tilted = (polar - TURN * drag.y).clamp(POLE, std::f64::consts::PI - POLE);
    camera.position = camera.target + DQuat::from_axis_angle(right, tilted - polar) * arm;
}

/// Comes nearer by notches of the wheel; a view without a centre shows less.
pub(super) fn zoom(camera: &mut Camera, notches: f64) {
    let factor = NOTCH.powf(notches.clamp(-MOST_NOTCHES, MOST_NOTCHES));
    match &mut camera.kind {
        CameraKind::Pinhole { .. } => {
            camera.position = camera.target + factor * (camera.position - camera.target);
        }
        CameraKind::Orthographic { height, width } => {
            *height *= factor;
            width.iter_mut().for_each(|width| *width *= factor);
        }
    }
}

/// Moves eye and target so that the target follows the mouse. `drag`: of the window's height, y downwards.
pub(super) fn pan(camera: &mut Camera, drag: DVec2) {
    let arm = camera.position - camera.target;
    let right = camera.up.cross(arm).normalize_or(DVec3::X);
    let up = arm.cross(right).normalize_or(camera.up);
    let height = match camera.kind {
        CameraKind::Pinhole { fov_y } => 2.0 * (0.5 * fov_y.to_radians()).tan() * arm.length(),
        CameraKind::Orthographic { height, .. } => height,
    };
    let aside = height * (up * drag.y - right * drag.x);
    camera.position += aside;
    camera.target += aside;
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{passes::eye, view::Extent};

    fn camera() -> Camera {
        Camera {
            kind: CameraKind::Pinhole { fov_y: 40.0 },
            position: DVec3::new(1.0, 3.0, 4.0),
            target: DVec3::new(0.5, 0.0, -0.5),
            up: DVec3::Y,
            hides_specular: false,
        }
    }

    fn seen(camera: &Camera, point: DVec3) -> DVec2 {
        let everything = Extent { points: vec![], spheres: vec![(DVec3::ZERO, 10.0)] };
        eye::view(camera, [400, 200], &everything).project(point).unwrap()
    }

    #[test]
    fn an_orbit_keeps_target_and_distance_and_never_goes_over_the_top() {
        let mut moved = camera();
        let distance = camera().position.distance(camera().target);
        for drag in [DVec2::new(0.3, 0.1), DVec2::new(-1.7, 5.0), DVec2::new(0.2, -9.0), DVec2::new(0.0, 0.4)] {
            orbit(&mut moved, drag);
            assert!((moved.position.distance(moved.target) - distance).abs() < 1e-12);
            assert!((seen(&moved, moved.target) - DVec2::splat(0.5)).length() < 1e-12);
            let polar = (moved.position - moved.target).angle_between(DVec3::Y);
            assert!(polar > 0.99 * POLE && polar < std::f64::consts::PI - 0.99 * POLE, "{polar}");
        }
    }

    #[test]
    fn what_is_nearer_than_the_target_follows_a_drag() {
        let near = camera().target + 0.1 * (camera().position - camera().target);
        for drag in [DVec2::new(0.02, 0.0), DVec2::new(0.0, 0.02), DVec2::new(-0.02, 0.01)] {
            let mut moved = camera();
            orbit(&mut moved, drag);
            let aside = seen(&moved, near) - DVec2::splat(0.5);
            assert!(aside.dot(drag) > 0.0, "{drag} moved it by {aside}");
        }
    }

    #[test]
    fn a_panned_target_is_where_the_mouse_is() {
        let mut moved = camera();
        let target = moved.target;
        pan(&mut moved, DVec2::new(0.2, -0.1));
        // The window is twice as wide as it is high.
        assert!((seen(&moved, target) - DVec2::new(0.6, 0.4)).length() < 1e-12, "{}", seen(&moved, target));
    }

    #[test]
    fn the_wheel_comes_nearer_and_goes_back() {
        let mut moved = camera();
        zoom(&mut moved, 2.0);
        let nearer = moved.position.distance(moved.target) / camera().position.distance(moved.target);
        assert!((nearer - 0.81).abs() < 1e-12);
        zoom(&mut moved, -2.0);
        assert!(moved.position.distance(camera().position) < 1e-12);
        zoom(&mut moved, 1e9);
        assert!(moved.position.is_finite() && moved.position.distance(moved.target) > 0.1);
    }
}
