use super::*;
use crate::scene::Scene;

/// Some dozen roundings on numbers of order ten.
const ROUNDING: f64 = 1e-13;

fn scene(name: &str, set: &[(&str, &str)]) -> Scene {
    let set: Vec<_> = set.iter().map(|(k, v)| ((*k).to_owned(), (*v).to_owned())).collect();
    Scene::load(name, &set).unwrap()
}

fn ray(o: [f64; 3], d: [f64; 3]) -> Ray {
    Ray { o: o.into(), d: DVec3::from(d).normalize(), left: None }
}

#[test]
fn sphere_and_floor_by_hand() {
    let scene = scene("glass-sphere", &[]);
    let space = Space::new(&scene);
    let hit = space.nearest(&ray([0.6, 5.0, 0.0], [0.0, -1.0, 0.0]), mask::ALL).unwrap();
    assert!((hit.distance - 4.2).abs() < ROUNDING && (hit.p - DVec3::new(0.6, 0.8, 0.0)).length() < ROUNDING);
    assert!((hit.ng - DVec3::new(0.6, 0.8, 0.0)).length() < ROUNDING);
    let through = space.nearest(&hit.ray(DVec3::NEG_Y), mask::ALL).unwrap();
    assert!((through.p - DVec3::new(0.6, -0.8, 0.0)).length() < ROUNDING, "{through:?}");
    let floor = space.nearest(&through.ray(DVec3::NEG_Y), mask::ALL).unwrap();
    assert!((floor.p - DVec3::new(0.6, -1.5, 0.0)).length() < ROUNDING && floor.ng == DVec3::Y);
    let beside = ray([0.6, 5.0, 0.0], [0.0, -1.0, 0.0]);
    assert!(space.blocked(&beside, 4.3, mask::ALL) && !space.blocked(&beside, 4.1, mask::ALL));
    assert!(!space.blocked(&beside, 6.4, mask::DIFFUSE) && space.blocked(&beside, 6.6, mask::DIFFUSE));
}

/// Rays that touch the ball, by less than rounding inside and outside: each is met or not, and goes on as a unit vector.
#[test]
fn tangent_rays_are_met_or_missed_and_finite() {
    let scene = scene("glass-sphere", &[]);
    let space = Space::new(&scene);
    let mut met = 0;
    for beside in [0.0, 1e-17, 1e-16, 3e-16, 1e-15, 1e-12, 1e-9] {
        for side in [-1.0, 1.0] {
            let ray = ray([1.0 + side * beside, 5.0, 0.0], [0.0, -1.0, 0.0]);
            let found = space.nearest(&ray, mask::ALL).expect("the floor at least");
            assert!(found.p.is_finite() && found.ng.is_normalized(), "{beside}: {found:?}");
            if !space.material(&found).is_specular() {
                continue;
            }
            met += 1;
            let (through, back) = (found.transmit(ray.d, 1.0, 1.5), found.reflect(ray.d, 1.0, 1.5));
            for bend in through.into_iter().chain([back]) {
                assert!(bend.d.is_normalized() && (0.0..=1.0).contains(&bend.share), "{beside}: {bend:?}");
            }
            // What touches is reflected whole, and goes on as it came.
            assert!((back.d - ray.d).length() < 1e-3 && back.share > 0.99, "{beside}: {back:?}");
        }
    }
    assert!(met >= 4, "{met} of the rays that lie inside by more than rounding");
}

#[test]
fn the_hierarchy_finds_what_trying_every_primitive_finds() {
    let scene = scene("bunny", &[]);
    let space = Space::new(&scene);
    for k in 0..400 {
        let turn = f64::from(k) * 2.399;
        let o = DVec3::new(2.0 * turn.cos(), 0.1 + f64::from(k) * 3e-3, 2.0 * turn.sin());
        let to = DVec3::new(0.3 * (turn * 3.1).sin(), 0.6, 0.3 * (turn * 1.7).cos());
        let ray = Ray { o, d: (to - o).normalize(), left: None };
        let tried = space.parts.iter().filter_map(|p| p.primitive.meet(&ray, 0.0, false)).map(|m| m.0);
        let found = space.nearest(&ray, mask::ALL).map_or(f64::INFINITY, |s| s.distance);
        assert_eq!(found, tried.fold(f64::INFINITY, f64::min), "ray {k}");
    }
}

#[test]
fn no_ray_slips_between_two_triangles() {
    let at = |i: i32, j: i32| DVec3::new(f64::from(i), (f64::from(i * 7 + j * 13)).sin(), f64::from(j)) / 3.0;
    let mut sheet = vec![];
    for (i, j) in (0..20).flat_map(|i| (0..20).map(move |j| (i, j))) {
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        sheet.extend([[a, b, c], [a, c, d]].map(|t| Primitive::Triangle(t, [DVec3::Y; 3])));
    }
    let eye = DVec3::new(2.9, 50.0, 3.3);
    for (i, j) in (1..20).flat_map(|i| (1..20).map(move |j| (i, j))) {
        for target in [at(i, j), 0.3 * at(i, j) + 0.7 * at(i + 1, j), 0.5 * (at(i, j) + at(i - 1, j - 1))] {
            let ray = Ray { o: eye, d: (target - eye).normalize(), left: None };
            assert!(sheet.iter().any(|t| t.meet(&ray, 0.0, false).is_some()), "slipped through at {target}");
        }
    }
}

#[test]
fn self_intersection_has_no_scale() {
    for unit in ["1e-3", "1.0", "1e3"] {
        let scene = scene("glass-sphere", &[("unit", unit)]);
        let space = Space::new(&scene);
        let scale: f64 = unit.parse().unwrap();
        // Inside the glass at nearly grazing incidence: each chord is as long as the one before.
        let first = space.nearest(&ray([0.0, 0.0, 0.0], [1.0, 0.0, 0.0]), mask::ALL).unwrap();
        let d = DVec3::new(-0.01, 1.0, 0.0).normalize();
        let chord = 2.0 * scale * -d.dot(first.ng);
        let mut at = space.nearest(&first.ray(d), mask::SPECULAR).unwrap();
        let mut d = d;
        for _ in 0..50 {
            assert!((at.distance / chord - 1.0).abs() < 1e-10, "{unit}: {} against {chord}", at.distance);
            d = at.reflect(d, 1.0, 1.0).d;
            at = space.nearest(&at.ray(d), mask::SPECULAR).unwrap();
        }
    }
}

#[test]
fn a_bent_ray_stays_on_its_side() {
    let tilted = DVec3::new(0.9, 0.3, 0.0).normalize();
    let s = Surface { distance: 0.0, p: DVec3::ZERO, ng: DVec3::Y, ns: tilted, object: 0, material: 0, primitive: 0 };
    for degrees in -89..=89 {
        let angle = f64::from(degrees).to_radians();
        let d = DVec3::new(angle.sin(), -angle.cos(), 0.0);
        assert!(s.reflect(d, 1.0, 1.5).d.y > 0.0, "{degrees}°");
        assert!(s.transmit(d, 1.0, 1.5).is_none_or(|t| t.d.y < 0.0), "{degrees}°");
        assert!(s.transmit(d, 1.5, 1.0).is_none_or(|t| t.d.y < 0.0), "{degrees}°");
        assert!(s.reflect(-d, 1.0, 1.5).d.y < 0.0 && s.transmit(-d, 1.0, 1.5).is_none_or(|t| t.d.y > 0.0));
    }
}
