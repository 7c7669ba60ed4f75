//! The rule by which a scene's receiver region is framed, held for every shipped scene.
//!
//! Sphere scenes: the square of ±1.5 radii about the axis; mirrors: a square about ring or focus that holds 99 %. Elsewhere: the smallest rectangle that holds 99 % of the
//! flux of the scene's path class, or the whole receiver. For the mesh that takes a ray trace, done here in float64.
use glam::{DVec2, DVec3, Vec3A};
use nephroid::{
    scene::{Canonical, LightKind, MaterialKind, Region, Scene, Shape},
    truth::{light::Photons, trace::Space},
};
use obvhs::{
    BvhBuildParams,
    aabb::Aabb,
    bvh2::{Bvh2, builder::build_bvh2},
    ray::{Ray, RayHit},
};

use std::f64::consts::TAU;

/// The share of flux that a region must hold.
const SHARE: f64 = 0.99;
/// Tangent of the steepest place of the pool, which is 0.6.
const STEEPEST: f64 = 0.6;
/// Photons a side of the light's square: 9·10⁴ land.
const SIDE: usize = 1024;
/// Cells a side of the flux histogram; a border is found to within one of them, 0.06 m.
const CELLS: usize = 200;
/// 900 photons lie outside, which alone is ±0.0003 of the flux; measured 0.0001, and from 0.0001 to 0.001 as their
/// number changes, for a single photon's ray may cross the whole floor.
const SHARE_NOISE: f64 = 0.002;
/// One histogram cell on each side is 3 % of the area; measured 0.995.
const AREA_SLACK: f64 = 1.05;

fn load(name: &str) -> Scene {
    Scene::load(name, &[]).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn sphere_scenes_frame_one_and_a_half_radii() {
    for name in ["glass-sphere", "null", "diffuse"] {
        let scene = load(name);
        let Some((center, radius)) = scene.objects.iter().find_map(|object| match object.shape {
            Shape::Sphere { center, radius } => Some((center, radius)),
            _ => None,
        }) else {
            panic!("{name} has no sphere")
        };
        let region = &scene.region;
        let axis = center - region.center;
        assert_eq!(axis.cross(region.normal()), DVec3::ZERO, "{name}: about the axis");
        assert_eq!([region.u.length(), region.v.length()], [1.5 * radius; 2], "{name}");
    }
}

#[test]
fn flat_water_frames_the_receiver() {
    let scene = load("flat-water");
    let Shape::Quad { center, u, v } = scene.objects[scene.region.receiver].shape else { panic!("no quad") };
    assert_eq!([scene.region.center, scene.region.u, scene.region.v], [center, u, v]);
    assert_eq!([scene.extent.center, scene.extent.u, scene.extent.v], [center, u, v], "cut to the receiver");
}

/// Of the gem's light, which lies scattered to the floor's edge; measured 0.834.
const MOST: f64 = 0.8;

#[test]
fn gem_frames_twice_its_girdle_about_it() {
    let scene = load("gem");
    assert_eq!((scene.region.center, scene.region.u.length(), scene.region.v.length()), (DVec3::ZERO, 4.0, 4.0));
    let held = held(&scene);
    println!("gem: {held:.4}");
    assert!(held >= MOST, "holds {held}");
}

#[test]
fn room_frames_the_table() {
    let scene = load("room");
    let Shape::Quad { center, u, v } = scene.objects[scene.region.receiver].shape else { panic!("no quad") };
    assert_eq!([scene.region.center, scene.region.u, scene.region.v], [center, u, v]);
}

#[test]
fn sine_water_frames_whole_waves() {
    let scene = load("sine-water");
    let Some(wave) = scene.objects.iter().find_map(|object| match object.shape {
        Shape::Canonical { kind: Canonical::Sine { wave, .. }, to_world } => {
            Some(to_world.x_axis.length() * TAU / wave)
        }
        _ => None,
    }) else {
        panic!("no wave")
    };
    assert!((2.0 * scene.region.u.length() / wave - 2.0).abs() < 1e-12 && scene.region.center.x == 0.0, "two of them");
}

/// No sunlight gets into the region beside the pool's surface, bent or not: seen against the sun, and against the sun bent by
/// a surface of the pool's slopes, all of it lies behind the sheet.
#[test]
fn water_frames_what_the_surface_covers() {
    let scene = load("water");
    let LightKind::Directional { direction, .. } = scene.lights[0].kind else { panic!("no sun") };
    let water = scene.objects.iter().find(|o| o.name == "water").expect("water");
    let Some([low, high]) = water.shape.bounds() else { panic!("no sheet") };
    let ways = |k: usize| {
        let aside = DVec3::new((k as f64).cos(), 0.0, (k as f64).sin()) * STEEPEST;
        [direction, refract(direction, (DVec3::Y + aside).normalize(), 1.0 / 1.333).expect("into water").0]
    };
    let Region { center, u, v, .. } = scene.region;
    for (d, corner) in (0..44).flat_map(ways).flat_map(|d| [u + v, u - v, v - u, -u - v].map(|c| (d, center + c))) {
        let at = corner + d * ((low.y - corner.y) / d.y);
        let margin = (at - low).min(high - at);
        assert!(margin.x > 0.0 && margin.z > 0.0, "{corner} is lit along {d}, which passes the surface by");
    }
}

/// Share of the class's flux that lands in the region, by a few photons of the truth.
fn held(scene: &Scene) -> f64 {
    let space = Space::new(scene);
    let region = &scene.region;
    let mut inside = 0.0;
    let balance = Photons::new(&space, scene.paths, 1, 1 << 16).chunk(0, |landing| {
        let way = landing.surface.p - region.center;
        let within = |edge: DVec3| way.dot(edge).abs() <= edge.length_squared();
        if landing.surface.object == region.receiver && within(region.u) && within(region.v) {
            inside += landing.flux.element_sum();
        }
    });
    inside / balance.landed.element_sum()
}

#[test]
fn mirrors_frame_their_caustic() {
    let ring = load("ring");
    assert_eq!([ring.region.center, ring.region.u], [DVec3::ZERO, DVec3::X * 1.1], "about the axis");
    let paraboloid = load("paraboloid");
    let pixel = 2.0 * paraboloid.region.u.length() / 128.0;
    let focus = (DVec3::Y * 0.5 - paraboloid.region.center) / pixel;
    let [x, y] = [paraboloid.region.u, paraboloid.region.v].map(|edge| focus.dot(edge.normalize()));
    assert!((x + 0.5).abs() < 1e-9 && (y + 0.5).abs() < 1e-9, "the focus is the middle of a pixel: {x} {y}");
    for scene in [ring, paraboloid] {
        let held = held(&scene);
        println!("{}: {held:.4}", scene.name);
        assert!(held >= SHARE, "{} holds {held}", scene.name);
    }
}

/// The scene is judged where the sphere is lowest: all its light is in the region there, and most while it comes and goes.
#[test]
fn moving_sphere_frames_the_middle_of_its_way() {
    let scene = load("moving-sphere");
    assert_eq!([scene.region.center, scene.region.u], [DVec3::NEG_Y * 1.5, DVec3::X * 1.5], "about the beam");
    let [first, middle, last] = [0.0, 0.3, 0.6].map(|time| held(&scene.at(time)));
    println!("moving-sphere: {first:.4} {middle:.4} {last:.4}");
    assert!(middle >= SHARE && first > 0.5 && last > 0.5, "{first} {middle} {last}");
}

#[test]
fn bending_frames_its_caustic_while_the_knot_twists() {
    let scene = load("bending");
    assert_eq!([scene.region.center, scene.region.u], [DVec3::ZERO, DVec3::X * 2.5], "below the knot's middle");
    let shares = [0.0, 1.0, 2.0, 3.0].map(|time| held(&scene.at(time)));
    println!("bending: {shares:.4?}");
    assert!(shares[0] >= SHARE && shares.iter().all(|share| *share >= 0.97), "{shares:?}");
}

/// A glass mesh with a hierarchy over its triangles: candidates in single precision, hits in double.
struct Glass {
    corners: Vec<[DVec3; 3]>,
    normals: Vec<[DVec3; 3]>,
    bvh: Bvh2,
    ior: f64,
}

struct Hit {
    at: DVec3,
    triangle: usize,
    /// Geometric and interpolated normal, unit, outwards.
    geometric: DVec3,
    shading: DVec3,
}

impl Glass {
    fn of(scene: &Scene) -> Glass {
        let object = scene.objects.iter().find(|o| matches!(o.shape, Shape::Mesh { .. })).expect("a mesh");
        let (Shape::Mesh { mesh, to_world }, MaterialKind::Dielectric { ior, .. }) =
            (&object.shape, &scene.materials[object.material].kind)
        else {
            panic!("a glass mesh")
        };
        let corners: Vec<[DVec3; 3]> = mesh
            .triangles
            .iter()
            .map(|t| t.map(|i| to_world.transform_point3(mesh.positions[i as usize].as_dvec3())))
            .collect();
        let normal = |i: u32| to_world.transform_vector3(mesh.normals[i as usize].as_dvec3()).normalize();
        let normals = mesh.triangles.iter().map(|t| t.map(normal)).collect();
        let boxes: Vec<Aabb> = corners
            .iter()
            .map(|c| {
                // Padded, so that no hit falls outside a box for the rounding of its corners.
                let mut all = Aabb::from_points(&c.map(|p| p.as_vec3a()));
                all.min -= Vec3A::splat(1e-5);
                all.max += Vec3A::splat(1e-5);
                all
            })
            .collect();
        let bvh = build_bvh2(&boxes, BvhBuildParams::medium_build(), &mut Default::default());
        Glass { corners, normals, bvh, ior: ior[0] }
    }

    /// Nearest hit but for the triangle the ray starts on.
    fn hit(&self, origin: DVec3, direction: DVec3, from: Option<usize>) -> Option<Hit> {
        let ray = Ray::new_inf(origin.as_vec3a(), direction.as_vec3a());
        let mut best: Option<(f64, usize, DVec2)> = None;
        self.bvh.ray_traverse(ray, &mut RayHit::none(), |_, slot| {
            let triangle = self.bvh.primitive_indices[slot] as usize;
            let Some((t, b)) = crossing(&self.corners[triangle], origin, direction) else { return f32::INFINITY };
            if Some(triangle) == from || best.as_ref().is_some_and(|best| best.0 <= t) {
                return f32::INFINITY;
            }
            best = Some((t, triangle, b));
            t as f32
        });
        best.map(|(t, triangle, b)| {
            let [p, q, r] = self.corners[triangle];
            let [a, c, d] = self.normals[triangle];
            Hit {
                at: origin + direction * t,
                triangle,
                geometric: (q - p).cross(r - p).normalize(),
                shading: (a * (1.0 - b.x - b.y) + c * b.x + d * b.y).normalize(),
            }
        })
    }
}

/// Distance and barycentrics of q and r (Möller and Trumbore 1997).
fn crossing([p, q, r]: &[DVec3; 3], origin: DVec3, direction: DVec3) -> Option<(f64, DVec2)> {
    let (e, f, s) = (q - p, r - p, origin - p);
    let h = direction.cross(f);
    let det = e.dot(h);
    let (u, w) = (s.dot(h) / det, s.cross(e));
    let (v, t) = (direction.dot(w) / det, f.dot(w) / det);
    (det != 0.0 && u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0).then_some((t, DVec2::new(u, v)))
}

/// Refracted direction and transmittance; `None` past the critical angle. `n` faces the ray, `eta` = n_i / n_t.
fn refract(d: DVec3, n: DVec3, eta: f64) -> Option<(DVec3, f64)> {
    let ci = -d.dot(n);
    let k = 1.0 - eta * eta * (1.0 - ci * ci);
    if k < 0.0 {
        return None;
    }
    let ct = k.sqrt();
    let (s, p) = ((eta * ci - ct) / (eta * ci + ct), (ci - eta * ct) / (ci + eta * ct));
    Some(((d * eta + n * (eta * ci - ct)).normalize(), 1.0 - 0.5 * (s * s + p * p)))
}

/// Through one surface: the interpolated normal bends the ray, the geometric one decides the side; a ray bent through
/// the surface, or met from behind the interpolated normal, is bent by the geometric normal instead.
fn pass(hit: &Hit, d: DVec3, eta: f64) -> Option<(DVec3, f64)> {
    let facing = |n: DVec3| if d.dot(hit.geometric) < 0.0 { n } else { -n };
    let (geometric, shading) = (facing(hit.geometric), facing(hit.shading));
    if d.dot(shading) < 0.0 {
        let bent = refract(d, shading, eta)?;
        if bent.0.dot(geometric) < 0.0 {
            return Some(bent);
        }
    }
    refract(d, geometric, eta)
}

/// Where the photons of `transmit-2` land on the receiver, in its own metres, and their flux.
fn landings(scene: &Scene) -> Vec<(DVec2, f64)> {
    let glass = Glass::of(scene);
    let LightKind::Directional { direction, irradiance } = scene.lights[0].kind else { panic!("no sun") };
    let Shape::Quad { center, u, v } = scene.objects[scene.region.receiver].shape else { panic!("no quad") };
    let (normal, half) = (u.cross(v).normalize(), DVec2::new(u.length(), v.length()));
    let [low, high] =
        scene.objects.iter().find(|o| matches!(o.shape, Shape::Mesh { .. })).unwrap().shape.bounds().unwrap();
    let (middle, radius) = (0.5 * (low + high), 0.5 * (high - low).length());
    let (x, y) = direction.any_orthonormal_pair();
    let flux = irradiance[0] * (2.0 * radius / SIDE as f64).powi(2);
    let trace = |i: usize, j: usize| {
        let at = |k: usize| ((k as f64 + 0.5) / SIDE as f64 * 2.0 - 1.0) * radius;
        let origin = middle - direction * 2.0 * radius + x * at(i) + y * at(j);
        let first = glass.hit(origin, direction, None)?;
        let (inside, enter) = pass(&first, direction, 1.0 / glass.ior)?;
        let second = glass.hit(first.at, inside, Some(first.triangle))?;
        let (outside, leave) = pass(&second, inside, glass.ior)?;
        let t = (center - second.at).dot(normal) / outside.dot(normal);
        let third = glass.hit(second.at, outside, Some(second.triangle));
        let free = third.is_none_or(|hit| (hit.at - second.at).dot(outside) > t);
        let on = second.at + outside * t - center;
        let p = DVec2::new(on.dot(u) / half.x, on.dot(v) / half.y);
        let lands = t > 0.0 && outside.dot(normal) < 0.0 && free && p.abs().cmple(half).all();
        lands.then_some((p, flux * enter * leave))
    };
    (0..SIDE * SIDE).filter_map(|k| trace(k % SIDE, k / SIDE)).collect()
}

/// The smallest rectangle on a grid over all landings that holds `SHARE` of the flux.
fn smallest(landings: &[(DVec2, f64)]) -> [DVec2; 2] {
    let n = CELLS;
    let low = landings.iter().fold(DVec2::INFINITY, |low, l| low.min(l.0));
    let high = landings.iter().fold(DVec2::NEG_INFINITY, |high, l| high.max(l.0));
    let mut sums = vec![0.0; (n + 1) * (n + 1)];
    for (p, flux) in landings {
        let cell = ((p - low) / (high - low) * n as f64).floor().clamp(DVec2::ZERO, DVec2::splat((n - 1) as f64));
        sums[(cell.y as usize + 1) * (n + 1) + cell.x as usize + 1] += flux;
    }
    for j in 1..=n {
        for i in 1..=n {
            sums[j * (n + 1) + i] +=
                sums[(j - 1) * (n + 1) + i] + sums[j * (n + 1) + i - 1] - sums[(j - 1) * (n + 1) + i - 1];
        }
    }
    let needed = SHARE * sums[n * (n + 1) + n];
    let (mut best, mut area) = ([0, 0, n, n], n * n);
    for bottom in 0..n {
        for top in bottom + 1..=n {
            let strip = |left: usize, right: usize| {
                let row = |j: usize| sums[j * (n + 1) + right] - sums[j * (n + 1) + left];
                row(top) - row(bottom)
            };
            let mut left = 0;
            for right in 1..=n {
                while left + 1 < right && strip(left + 1, right) >= needed {
                    left += 1;
                }
                if strip(left, right) >= needed && (right - left) * (top - bottom) < area {
                    (best, area) = ([left, bottom, right, top], (right - left) * (top - bottom));
                }
            }
        }
    }
    let corner = |i: usize, j: usize| low + (high - low) * DVec2::new(i as f64, j as f64) / n as f64;
    [corner(best[0], best[1]), corner(best[2], best[3])]
}

#[test]
fn bodies_of_glass_frame_the_smallest_rectangle_that_holds_99_percent() {
    ["bunny", "knot"].into_iter().for_each(|name| frames_the_smallest(&load(name)));
}

fn frames_the_smallest(scene: &Scene) {
    let landings = landings(scene);
    let Shape::Quad { center, u, v } = scene.objects[scene.region.receiver].shape else { panic!("no quad") };
    let middle = DVec2::new(
        (scene.region.center - center).dot(u.normalize()),
        (scene.region.center - center).dot(v.normalize()),
    );
    let half = DVec2::new(scene.region.u.length(), scene.region.v.length());
    let total: f64 = landings.iter().map(|l| l.1).sum();
    let held: f64 = landings.iter().filter(|l| (l.0 - middle).abs().cmple(half).all()).map(|l| l.1).sum();
    let [low, high] = smallest(&landings);
    let name = &scene.name;
    println!("{name}: {} landed; {:.4} held; smallest {low:.3} to {high:.3}", landings.len(), held / total);
    assert!((held / total - SHARE).abs() < SHARE_NOISE, "{name} holds {}", held / total);
    let area = (high - low).element_product();
    assert!(scene.region.area() < area * AREA_SLACK, "{name}: {} m² where {area} suffice", scene.region.area());
}
