//! What a picture says that it shows: enough to make its truth.

use std::fmt;

use crate::{
    image::Provenance,
    lab::{
        CompareError, Picture,
        compare_scene::{difference, paths},
        picture::REGION,
    },
    scene::{Camera, PathClass, Scene},
    truth::{Estimator, Goal, Task},
};

/// A scene through the camera `region`.
pub struct Subject {
    pub scene: Scene,
    paths: PathClass,
    size: [u32; 2],
}

impl Subject {
    /// Loads the picture's scene again, and holds that it is the same.
    pub fn of(image: &Picture) -> Result<Self, CompareError> {
        image.check_camera()?;
        let unsaid = || CompareError::Unsaid { image: image.file.clone() };
        let said = |name: &str| image.about.get(name).map(String::as_str).ok_or_else(unsaid);
        let overrides = overrides(said("scene.overrides")?).ok_or_else(unsaid)?;
        let scene = Scene::load_again(said("scene.name")?, said("scene.file")?, &overrides)
            .map_err(|reason| CompareError::Scene { image: image.file.clone(), reason: Box::new(reason) })?;
        let scene = scene.at(image.number("time_s").unwrap_or(0.0));
        if scene.source.hash != said("scene.hash")? {
            let now = Provenance::from([("scene.resolved".to_owned(), scene.source.resolved)]);
            let what = difference(&image.about, &now);
            return Err(CompareError::Changed { image: image.file.clone(), scene: scene.source.file, what });
        }
        let paths = paths(&image.about).map_or(Ok(scene.paths), |class| class.parse()).map_err(|_| unsaid())?;
        Ok(Self { scene, paths, size: image.size().map(|n| n as u32) })
    }

    /// Whether one truth is that of both.
    pub fn is_like(&self, other: &Self) -> bool {
        let of = |s: &Self| (s.scene.source.hash.clone(), s.paths, s.size);
        of(self) == of(other)
    }

    pub fn camera(&self) -> &Camera {
        &self.scene.cameras[REGION]
    }

    /// Its truth, without a goal: how far it goes, whoever makes it says.
    pub fn task(&self) -> Task {
        Task {
            estimator: Estimator::Photons,
            paths: self.paths,
            camera: REGION.to_owned(),
            size: self.size,
            seed: 0,
            goal: Goal { photons: None, noise: None },
        }
    }
}

impl fmt::Display for Subject {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [width, height] = self.size;
        let time = if self.scene.moves() { format!(" at {} s", self.scene.time) } else { String::new() };
        write!(f, "{}{time}, {}, {width}x{height}", self.scene.name, self.paths)
    }
}

/// From a JSON list of `key=value`.
fn overrides(list: &str) -> Option<Vec<(String, String)>> {
    let entries: Vec<String> = serde_json::from_str(list).ok()?;
    entries.iter().map(|entry| entry.split_once('=').map(|(k, v)| (k.to_owned(), v.to_owned()))).collect()
}
