//! The float64 reference: photons traced exactly on the CPU, and closed forms.
//!
//! It shares no code with the GPU path: only scenes, meshes and optics of the lowest floor.
//!
//! * [`trace`]: rays and surfaces. [`light`]: photons from the lights to the first diffuse surface, by path class.
//! * [`estimate`]: a caustic's irradiance by photons counted in pixels, or by cells of light spread over them.
//! * [`Run`]: an estimate through a camera with its variance; direct light and the mask beside it.
//! * [`backward`]: rays from a receiver up to the sun, to count how few of them are of use.
//! * [`closed`]: what is known without photons.
//!
//! Pixels that look at or through specular objects see no caustic here; the mask names them. Biases: [`trace::APART`] (coincident
//! surfaces), media nested deeper than sixteen, paths of more than 256 surfaces; of cells besides, what they leave unresolved.

pub mod backward;
pub mod closed;
mod direct;
pub mod estimate;
mod eye;
pub mod light;
mod run;
pub mod trace;

pub use estimate::Estimator;
pub use run::{Goal, Run, Standing, Task, VERSION};
