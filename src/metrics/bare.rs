//! E₀: how bright the judged region is without anything specular, the yardstick of a scene's errors.

use glam::DVec3;

use crate::scene::{LightKind, Object, Region, Scene, Shape};

/// Points along each side of the region (midpoint rule). A shadow's edge, the roughest thing there is, costs about one
/// point in 128^1.5 of its contrast, some 10⁻³: enough for a yardstick.
const SIDE: usize = 128;
/// Lights without size that stand for one that has a size: without shadows their sum is exact to some 10⁻³.
const SAMPLES: u32 = 16;
/// Shadow rays end this far before a light and begin this far off the receiver, relative to the region's size.
const CLEAR: f64 = 1e-9;

/// E₀ in W/m²: the mean over the scene's region, and over the bands, of the irradiance by all lights with the specular
/// objects removed; the other objects cast their shadows. Where that is 0, the sum of the lights' irradiance at the
/// region's centre on planes that face them. 0 without lights.
///
/// The error of the midpoint rule on 128² points; a point light far nearer to the receiver than 1/64 of the region's
/// side is resolved poorly.
///
/// # Examples
/// ```
/// let scene = nephroid::scene::Scene::load("glass-sphere", &[]).unwrap();
/// assert_eq!(nephroid::metrics::bare_irradiance(&scene), 1.0); // the sun overhead, 1 W/m², nothing in its way
/// ```
pub fn bare_irradiance(scene: &Scene) -> f64 {
    let casters: Vec<Caster> = scene.objects.iter().enumerate().filter_map(|at| Caster::new(scene, at)).collect();
    let lights: Vec<LightKind> = scene.lights.iter().flat_map(|light| light.kind.samples(SAMPLES)).collect();
    let each = lights.iter().map(|light| mean_irradiance(&scene.region, light, &casters));
    match each.sum::<f64>() {
        dark if dark <= 0.0 => {
            let facing = lights.iter().map(|light| Incident::at(light, scene.region.center).facing);
            facing.sum()
        }
        lit => lit,
    }
}

fn mean_irradiance(region: &Region, light: &LightKind, casters: &[Caster]) -> f64 {
    let normal = region.normal();
    let clear = CLEAR * (region.u.length() + region.v.length());
    let along = |at: usize| (2 * at + 1) as f64 / SIDE as f64 - 1.0;
    let points = (0..SIDE * SIDE).map(|at| region.center + along(at % SIDE) * region.u + along(at / SIDE) * region.v);
    let irradiance = points.map(|point| {
        let incident = Incident::at(light, point);
        let cosine = incident.towards.dot(normal);
        let origin = point + clear * normal;
        let lit = cosine > 0.0 && !casters.iter().any(|c| c.blocks(origin, incident.towards, incident.reach - clear));
        if lit { incident.facing * cosine } else { 0.0 }
    });
    irradiance.sum::<f64>() / (SIDE * SIDE) as f64
}

/// A light as a point sees it.
struct Incident {
    /// W/m² on a plane that faces the light, mean of the bands.
    facing: f64,
    /// Unit vector to the light.
    towards: DVec3,
    /// Distance to the light, m.
    reach: f64,
}

impl Incident {
    fn at(light: &LightKind, point: DVec3) -> Self {
        match light {
            LightKind::Directional { direction, irradiance } => {
                Self { facing: mean(irradiance), towards: -direction, reach: f64::INFINITY }
            }
            LightKind::Patch { position, intensity, .. }
            | LightKind::Point { position, intensity }
            | LightKind::Spot { position, intensity, .. } => {
                let way = position - point;
                let (reach, towards) = (way.length(), way.normalize_or_zero());
                // A light on the very point lights it from nowhere: the midpoint rule leaves it out.
                let share = if reach > 0.0 { light.share(-towards) / (reach * reach) } else { DVec3::ZERO };
                Self { facing: mean(&(DVec3::from(*intensity) * share).to_array()), towards, reach }
            }
            // Of what has a size, its middle.
            LightKind::Sun { .. } | LightKind::Lamp { .. } => Self::at(&light.samples(1)[0], point),
        }
    }
}

fn mean(bands: &[f64; 3]) -> f64 {
    bands.iter().sum::<f64>() / 3.0
}

/// A diffuse object that may stand between a light and the region.
struct Caster<'a> {
    shape: &'a Shape,
    low: DVec3,
    high: DVec3,
}

impl<'a> Caster<'a> {
    /// Not the receiver (it is flat, and cannot shadow itself), and nothing specular.
    fn new(scene: &'a Scene, (at, object): (usize, &'a Object)) -> Option<Self> {
        if at == scene.region.receiver || scene.materials[object.material].is_specular() {
            return None;
        }
        let [low, high] = object.shape.bounds()?;
        Some(Self { shape: &object.shape, low, high })
    }

    fn blocks(&self, origin: DVec3, direction: DVec3, reach: f64) -> bool {
        let hit = |t: f64| t > 0.0 && t < reach;
        self.is_near(origin, direction, reach)
            && match self.shape {
                Shape::Sphere { center, radius } => sphere(origin - center, direction, *radius).into_iter().any(hit),
                Shape::Quad { center, u, v } => quad(origin - center, direction, *u, *v).is_some_and(hit),
                Shape::Canonical { kind, to_world } => {
                    let to_object = to_world.inverse();
                    let (o, d) = (to_object.transform_point3(origin), to_object.transform_vector3(direction));
                    kind.meet(o, d, 0.0, false).is_some_and(hit)
                }
                Shape::Mesh { mesh, to_world } => mesh.triangles.iter().any(|corners| {
                    let [a, b, c] = corners.map(|at| to_world.transform_point3(mesh.positions[at as usize].as_dvec3()));
                    triangle(origin - a, direction, b - a, c - a).is_some_and(hit)
                }),
            }
    }

    /// Whether the ray meets the box about the object (slab test).
    fn is_near(&self, origin: DVec3, direction: DVec3, reach: f64) -> bool {
        let (a, b) = ((self.low - origin) / direction, (self.high - origin) / direction);
        // A ray inside a slab's plane gives 0/0: `min` and `max` of f64 pass over it.
        let near = [0, 1, 2].into_iter().fold(0.0, |near: f64, axis| near.max(a[axis].min(b[axis])));
        let far = [0, 1, 2].into_iter().fold(reach, |far: f64, axis| far.min(a[axis].max(b[axis])));
        near <= far
    }
}

/// Where a ray from `o`, relative to the centre, meets a sphere.
fn sphere(o: DVec3, d: DVec3, radius: f64) -> [f64; 2] {
    let middle = -o.dot(d);
    // NaN for a miss: it lies in no interval.
    let half = (radius * radius - (o + middle * d).length_squared()).sqrt();
    [middle - half, middle + half]
}

fn quad(o: DVec3, d: DVec3, u: DVec3, v: DVec3) -> Option<f64> {
    let normal = u.cross(v);
    let t = -o.dot(normal) / d.dot(normal);
    let at = o + t * d;
    let inside = |edge: DVec3| at.dot(edge).abs() <= edge.length_squared();
    (inside(u) && inside(v)).then_some(t)
}

/// Möller and Trumbore 1997.
fn triangle(o: DVec3, d: DVec3, e1: DVec3, e2: DVec3) -> Option<f64> {
    let p = d.cross(e2);
    let scale = 1.0 / e1.dot(p);
    let (u, q) = (scale * o.dot(p), o.cross(e1));
    let v = scale * d.dot(q);
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0).then(|| scale * e2.dot(q))
}
