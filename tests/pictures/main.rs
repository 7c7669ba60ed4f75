//! Pictures and accounts of the device: against closed forms, the truth and each other, on sound scenes and on hard ones, of glTF
//! files too.
//! One binary, as most of a test's building is linking.

#[path = "../common/mod.rs"]
mod common;
#[path = "../common/gltf.rs"]
mod made;

mod all_paths;
mod area_lights;
mod closed_forms;
mod dispersion;
mod energy;
mod gltf;
mod hard_cases;
mod light_types;
mod lights;
mod media_start;
mod metals;
mod mirrors;
mod motion;
mod nested;
mod null;
mod photons;
mod products;
mod shapes;
mod sheets;
mod sky;
mod slides;
mod textures;
mod tracers;
