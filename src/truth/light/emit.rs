//! Where photons start: over a rectangle or a cone about the specular objects, each light on its own.

use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

use super::{
    area::{Disc, Shining},
    walk::Start,
};
use crate::{
    scene::{LightKind, Scene, Shape},
    truth::trace::{Media, Ray, Space},
};

/// Rectangles and cones are wider than what they hold by this share, so that rounding cuts nothing off.
pub const MARGIN: f64 = 1e-9;

/// The photons that one light sends towards the specular objects.
#[derive(Clone, Debug)]
pub enum Emission {
    /// Parallel light through a rectangle.
    Rectangle {
        /// A corner, m.
        corner: DVec3,
        /// Edge, m.
        u: DVec3,
        /// Edge, m.
        v: DVec3,
        /// Unit direction of travel.
        d: DVec3,
        /// Flux through it, W per band.
        flux: DVec3,
    },
    /// A point light in a cone, evenly by solid angle.
    Cone {
        /// m
        apex: DVec3,
        /// Unit axis and two unit vectors across it.
        frame: [DVec3; 3],
        /// 1 − cosine of the half angle: 2 is the whole sphere.
        height: f64,
        /// Flux in it, W per band.
        flux: DVec3,
        /// What the light is in.
        media: Media,
        /// Which share of its intensity goes where.
        light: Box<LightKind>,
    },
    /// A disc of directions.
    Disc(Disc),
    /// A surface that shines.
    Shining(Shining),
}

impl Emission {
    /// Of each light in turn; none where nothing is specular.
    pub fn of(space: &Space) -> Vec<Self> {
        Self::of_each(space, &space.scene.lights.iter().map(|light| light.kind.clone()).collect::<Vec<_>>())
    }

    /// Of each of these lights in turn; none where nothing is specular.
    pub fn of_each(space: &Space, lights: &[LightKind]) -> Vec<Self> {
        let held = Held::of(space.scene);
        if held.is_empty() {
            return vec![];
        }
        let light = |kind: &LightKind| {
            Some(match kind {
                LightKind::Directional { direction, irradiance } => rectangle(*direction, *irradiance, &held, space),
                LightKind::Sun { direction, irradiance, radius } => {
                    Self::Disc(Disc::new(*direction, *radius, *irradiance, held.room(), space))
                }
                LightKind::Lamp { .. } => Self::Shining(Shining::new(kind, held.room())?),
                LightKind::Point { position, intensity } | LightKind::Patch { position, intensity, .. } => {
                    held.cone(*position).emission(*position, *intensity, kind, space.media(*position))
                }
                LightKind::Spot { position, intensity, beam, .. } => {
                    // Whichever holds less: what lies outside the other is dark, or meets nothing.
                    let (held, lit) = (held.cone(*position), Cone { axis: beam.axis, height: beam.outer.min(2.0) });
                    let cone = if held.height < lit.height { held } else { lit };
                    cone.emission(*position, *intensity, kind, space.media(*position))
                }
            })
        };
        lights.iter().filter_map(light).collect()
    }

    /// Flux of all its photons, W per band; of a spot light, if the whole cone had the intensity of its axis; of a light
    /// with a size, of the order of it.
    pub fn flux(&self) -> DVec3 {
        match self {
            Self::Rectangle { flux, .. } | Self::Cone { flux, .. } => *flux,
            Self::Disc(disc) => disc.flux(),
            Self::Shining(shining) => shining.flux(),
        }
    }

    /// Whether its light comes from more than a point or a direction.
    pub fn has_area(&self) -> bool {
        matches!(self, Self::Disc(_) | Self::Shining(_))
    }

    /// The photons of a point of the unit square, one for all bands, or one for each where they are bent apart; of a light
    /// with a size, from its point `on`, of another unit square.
    pub fn starts(&self, space: &Space, [at, on]: [DVec2; 2], flux: DVec3) -> impl Iterator<Item = Start> {
        let (whole, apart) = (self.start(space, [at, on], flux), space.scene.is_dispersive());
        let bands = if apart { 3 } else { 1 };
        let one = move |band: usize| {
            let whole = whole?;
            let flux = DVec3::AXES[band] * whole.flux;
            Some(if apart { Start { flux, band, ..whole } } else { whole })
        };
        (0..bands).filter_map(one)
    }

    /// The photon of a point of the unit square; equal areas of it carry equal flux.
    fn start(&self, space: &Space, [at, on]: [DVec2; 2], flux: DVec3) -> Option<Start> {
        Some(match self {
            Self::Disc(disc) => return disc.start(at, on, flux),
            Self::Shining(shining) => return shining.start(space, at, on, flux),
            Self::Rectangle { corner, u, v, d, .. } => {
                let ray = Ray { o: corner + at.x * u + at.y * v, d: *d, left: None };
                Start { ray, flux, media: None, band: 0 }
            }
            Self::Cone { apex, frame: [axis, x, y], height, media, light, .. } => {
                let below = height * at.x;
                let across = (below * (2.0 - below)).max(0.0).sqrt();
                let (sin, cos) = (TAU * at.y).sin_cos();
                let d = (1.0 - below) * axis + across * (cos * x + sin * y);
                let d = d.normalize();
                let flux = flux * light.share(d);
                Start { ray: Ray { o: *apex, d, left: None }, flux, media: Some(*media), band: 0 }
            }
        })
    }
}

/// The points and spheres that photons must reach.
struct Held {
    balls: Vec<(DVec3, f64)>,
}

impl Held {
    fn of(scene: &Scene) -> Self {
        let specular = scene.objects.iter().filter(|o| scene.materials[o.material].is_specular());
        let balls = specular.flat_map(|o| match &o.shape {
            Shape::Sphere { center, radius } => vec![(*center, *radius)],
            Shape::Quad { center, u, v } => [*u + *v, *u - *v, *v - *u, -*u - *v].map(|d| (center + d, 0.0)).to_vec(),
            Shape::Canonical { kind, to_world } => {
                kind.hull().into_iter().map(|p| (to_world.transform_point3(p), 0.0)).collect()
            }
            Shape::Mesh { mesh, to_world } => {
                mesh.positions.iter().map(|p| (to_world.transform_point3(p.as_dvec3()), 0.0)).collect()
            }
        });
        Self { balls: balls.collect() }
    }

    fn is_empty(&self) -> bool {
        self.balls.is_empty()
    }

    fn along(&self, axis: DVec3) -> [f64; 2] {
        let span = |(c, r): &(DVec3, f64)| [c.dot(axis) - r, c.dot(axis) + r];
        self.balls.iter().map(span).fold([f64::INFINITY, f64::NEG_INFINITY], |a, b| [a[0].min(b[0]), a[1].max(b[1])])
    }

    /// Centre of the box about it.
    fn middle(&self) -> DVec3 {
        let along = DVec3::AXES.map(|axis| self.along(axis));
        DVec3::from_array(along.map(|[low, high]| 0.5 * (low + high)))
    }

    /// Corners of a box that holds it.
    fn room(&self) -> [DVec3; 2] {
        let along = DVec3::AXES.map(|axis| self.along(axis));
        let corner = |k: usize| DVec3::from_array(along.map(|side| side[k]));
        let room = MARGIN * (corner(1) - corner(0));
        [corner(0) - room, corner(1) + room]
    }
}

/// Two unit vectors across a unit vector.
pub fn across(d: DVec3) -> [DVec3; 2] {
    let x = d.any_orthonormal_vector();
    [x, d.cross(x)]
}

fn rectangle(d: DVec3, irradiance: [f64; 3], held: &Held, space: &Space) -> Emission {
    let [x, y] = across(d);
    let wide = |axis: DVec3| {
        let [low, high] = held.along(axis);
        let room = MARGIN * (high - low);
        [low - room, high + room]
    };
    let ([x0, x1], [y0, y1]) = (wide(x), wide(y));
    // Behind everything, as seen along the light.
    let (centre, radius) = space.ball();
    let start = centre.dot(d) - radius * (1.0 + MARGIN);
    let flux = DVec3::from(irradiance) * (x1 - x0) * (y1 - y0);
    Emission::Rectangle { corner: x0 * x + y0 * y + start * d, u: (x1 - x0) * x, v: (y1 - y0) * y, d, flux }
}

/// Directions about a unit axis.
#[derive(Clone, Copy)]
struct Cone {
    axis: DVec3,
    /// 1 − cosine of the half angle.
    height: f64,
}

impl Held {
    /// The cone that holds all, seen from a point. One of a right angle and more is no convex thing, and corners that it
    /// holds do not vouch for what lies between them: it is then every direction.
    fn cone(&self, apex: DVec3) -> Cone {
        let axis = (self.middle() - apex).try_normalize();
        let lowest = |axis| self.balls.iter().map(|b| lowest_cosine(apex, axis, *b)).fold(1.0, f64::min);
        let height = (1.0 - axis.map_or(-1.0, lowest)) * (1.0 + MARGIN);
        let height = if height < 1.0 { height } else { 2.0 };
        Cone { axis: axis.unwrap_or(DVec3::Y), height }
    }
}

impl Cone {
    fn emission(self, apex: DVec3, intensity: [f64; 3], light: &LightKind, media: Media) -> Emission {
        let ([x, y], height) = (across(self.axis), self.height);
        let flux = DVec3::from(intensity) * TAU * height;
        Emission::Cone { apex, frame: [self.axis, x, y], height, flux, media, light: Box::new(light.clone()) }
    }
}

/// Cosine of the widest angle from the axis at which a ball is seen; −1 from inside it.
fn lowest_cosine(apex: DVec3, axis: DVec3, (centre, radius): (DVec3, f64)) -> f64 {
    let way = centre - apex;
    let distance = way.length();
    if distance <= radius {
        return -1.0;
    }
    let angle = way.cross(axis).length().atan2(way.dot(axis)) + (radius / distance).asin();
    if angle < std::f64::consts::PI { angle.cos() } else { -1.0 }
}
