//! Scenes that move: where everything is at a time. The one source for truth, device, eye and reports.
use std::sync::Arc;

use glam::{DMat3, DQuat, DVec3};

use super::{
    LightKind, Scene, Shape,
    deform::Deformers,
    flow::Flow,
    patch,
    track::{Direction, Track},
};

/// How a scene moves.
#[derive(Clone, Debug)]
pub struct Motion {
    /// By index into [`Scene::objects`].
    pub objects: Vec<(usize, ObjectMotion)>,
    /// By index into [`Scene::lights`].
    pub lights: Vec<(usize, LightMotion)>,
    /// Of the scene as it is written, whatever the time.
    pub hash: String,
}

/// How an object moves: bent in its place, then scaled and turned about it, then carried to where it is.
#[derive(Clone, Debug)]
pub struct ObjectMotion {
    /// As it is written.
    pub rest: Shape,
    /// How its surface runs, before anything else.
    pub flow: Option<Flow>,
    /// Its `center`, `base` or `vertex` as written, m.
    pub place: DVec3,
    pub position: Option<Track<DVec3>>,
    pub rotate: Option<Track<DQuat>>,
    pub scale: Option<Track<f64>>,
    /// Of meshes alone.
    pub deformers: Deformers,
    /// s; after it everything begins again.
    pub period: Option<f64>,
}

/// How a light moves and shines; a track that its kind cannot follow is refused in a file.
#[derive(Clone, Debug)]
pub struct LightMotion {
    pub rest: LightKind,
    pub position: Option<Track<DVec3>>,
    pub direction: Option<Track<Direction>>,
    pub power: Option<Track<[f64; 3]>>,
    pub period: Option<f64>,
}

impl Scene {
    /// The scene at a time, s: exact at the keys, interpolated in float64 between them. A scene that stands still is the
    /// same at any time, and so is its hash; that of one that moves names the time. What is no finite number is time 0.
    pub fn at(&self, time: f64) -> Scene {
        let Some(motion) = self.motion.clone() else { return self.clone() };
        let mut scene = self.clone();
        scene.time = if time.is_finite() { time } else { 0.0 };
        for (index, object) in &motion.objects {
            scene.objects[*index].shape = object.at(scene.time);
        }
        for (index, light) in &motion.lights {
            scene.lights[*index].kind = light.at(scene.time);
        }
        scene.source.hash = hash_at(&motion.hash, scene.time);
        scene.cameras.insert("region".to_owned(), patch::camera(&scene));
        scene
    }

    /// Whether time changes anything in it.
    pub fn moves(&self) -> bool {
        self.motion.is_some()
    }

    /// Whether time changes more of an object than its place, its size and how it is turned.
    pub fn deforms(&self, object: usize) -> bool {
        let of = |motion: &Arc<Motion>| motion.objects.iter().any(|(k, m)| *k == object && m.deforms());
        self.motion.as_ref().is_some_and(of)
    }

    /// What of an object changes with time, as scene files name it.
    pub fn object_motion(&self, object: usize) -> Vec<&'static str> {
        let of = |motion: &Arc<Motion>| motion.objects.iter().find(|(k, _)| *k == object).map(|(_, m)| m.moves());
        self.motion.as_ref().and_then(of).unwrap_or_default()
    }

    /// What of a light changes with time, as scene files name it.
    pub fn light_motion(&self, light: usize) -> Vec<&'static str> {
        let of = |motion: &Arc<Motion>| motion.lights.iter().find(|(k, _)| *k == light).map(|(_, m)| m.moves());
        self.motion.as_ref().and_then(of).unwrap_or_default()
    }

    /// The first and the last time named by a key, s; none where nothing is keyed.
    pub fn keyed_span(&self) -> Option<[f64; 2]> {
        let motion = self.motion.as_ref()?;
        let objects = motion.objects.iter().flat_map(|(_, object)| object.spans());
        let lights = motion.lights.iter().flat_map(|(_, light)| light.spans());
        objects.chain(lights).reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])
    }
}

/// Of a scene that moves at one time.
pub fn hash_at(hash: &str, time: f64) -> String {
    // -0 is 0.
    blake3::hash(format!("{hash} at {}", time + 0.0).as_bytes()).to_hex().to_string()
}

/// Within the period that has begun last.
fn wrapped(time: f64, period: Option<f64>) -> f64 {
    period.map_or(time, |period| time.rem_euclid(period))
}

impl ObjectMotion {
    fn deforms(&self) -> bool {
        !self.deformers.is_empty() || self.flow.as_ref().is_some_and(Flow::deforms)
    }

    fn at(&self, time: f64) -> Shape {
        let time = wrapped(time, self.period);
        let rest = self.flow.as_ref().map_or_else(|| self.rest.clone(), |flow| flow.at(&self.rest, time));
        let turn = self.rotate.as_ref().map_or(DQuat::IDENTITY, |track| track.at(time));
        let scale = self.scale.as_ref().map_or(1.0, |track| track.at(time));
        let to = self.position.as_ref().map_or(self.place, |track| track.at(time));
        let linear = DMat3::from_quat(turn) * scale;
        let place = |p: DVec3| to + linear * (p - self.place);
        match &rest {
            Shape::Sphere { center, radius } => Shape::Sphere { center: place(*center), radius: radius * scale },
            Shape::Quad { center, u, v } => Shape::Quad { center: place(*center), u: linear * *u, v: linear * *v },
            Shape::Canonical { kind, to_world } => {
                let mut to_world = *to_world;
                (to_world.matrix3, to_world.translation) = (linear * to_world.matrix3, place(to_world.translation));
                Shape::Canonical { kind: *kind, to_world }
            }
            Shape::Mesh { mesh, to_world } => {
                let bent = (!self.deformers.is_empty()).then(|| self.deformers.apply(mesh, to_world, self.place, time));
                let mut to_world = *to_world;
                (to_world.matrix3, to_world.translation) = (linear * to_world.matrix3, place(to_world.translation));
                Shape::Mesh { mesh: bent.map_or_else(|| mesh.clone(), Arc::new), to_world }
            }
        }
    }

    fn moves(&self) -> Vec<&'static str> {
        let Self { deformers: Deformers { twist, bend, wave }, .. } = self;
        let all = [
            ("position", self.position.is_some()),
            ("rotate", self.rotate.is_some()),
            ("scale", self.scale.is_some()),
            ("twist", twist.is_some()),
            ("bend", bend.is_some()),
            ("wave", wave.is_some()),
            ("speed", self.flow.is_some()),
        ];
        all.into_iter().filter_map(|(name, moves)| moves.then_some(name)).collect()
    }

    fn spans(&self) -> Vec<[f64; 2]> {
        let [position, rotate] = [self.position.as_ref().map(Track::span), self.rotate.as_ref().map(Track::span)];
        let own = [position, rotate, self.scale.as_ref().map(Track::span)];
        own.into_iter().flatten().chain(self.deformers.spans()).collect()
    }
}

impl LightMotion {
    fn at(&self, time: f64) -> LightKind {
        let time = wrapped(time, self.period);
        let (at, way) = (self.position.as_ref().map(|t| t.at(time)), self.direction.as_ref().map(|t| t.at(time).0));
        let strength = self.power.as_ref().map(|t| t.at(time));
        let mut kind = self.rest.clone();
        match &mut kind {
            LightKind::Directional { direction, irradiance } => {
                (*direction, *irradiance) = (way.unwrap_or(*direction), strength.unwrap_or(*irradiance));
            }
            LightKind::Sun { direction, irradiance, .. } => {
                (*direction, *irradiance) = (way.unwrap_or(*direction), strength.unwrap_or(*irradiance));
            }
            LightKind::Lamp { face, radiance } => {
                (face.center, *radiance) = (at.unwrap_or(face.center), strength.unwrap_or(*radiance));
            }
            LightKind::Point { position, intensity } | LightKind::Patch { position, intensity, .. } => {
                (*position, *intensity) = (at.unwrap_or(*position), strength.unwrap_or(*intensity));
            }
            LightKind::Spot { position, intensity, beam, .. } => {
                (*position, *intensity) = (at.unwrap_or(*position), strength.unwrap_or(*intensity));
                beam.axis = way.unwrap_or(beam.axis);
            }
        }
        kind
    }

    fn moves(&self) -> Vec<&'static str> {
        let all = [
            ("position", self.position.is_some()),
            ("direction", self.direction.is_some()),
            (self.rest.power_key(), self.power.is_some()),
        ];
        all.into_iter().filter_map(|(name, moves)| moves.then_some(name)).collect()
    }

    fn spans(&self) -> Vec<[f64; 2]> {
        let [position, direction] = [self.position.as_ref().map(Track::span), self.direction.as_ref().map(Track::span)];
        [position, direction, self.power.as_ref().map(Track::span)].into_iter().flatten().collect()
    }
}
