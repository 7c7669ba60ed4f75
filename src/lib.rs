//! Nephroid: real-time caustics methods on one set of scenes, lights and units; what each costs, and how wrong it is.
//!
//! The house, bottom to top; a room imports only from floors below it.
//!
//! | floor | rooms |
//! |---|---|
//! | 0, no Vulkan, float64 | [`optics`], [`view`], [`names`], [`places`], [`image`], [`metrics`], [`whole`], [`stats`], [`store`], [`settings`], [`scene`] |
//! | 1, the only unsafe code | [`gpu`]: device, memory, barriers, shaders, pipelines, plans, programs, timers |
//! | 2, what methods share | [`passes`]: the scene on the device, lights and photons, the eye |
//! | 3 | [`methods`]: a room per paper; [`truth`]: float64, sharing no code with floors 1 to 3 |
//! | 4 | [`renderer`]: plan → prepare → frame → read |
//! | 5 | [`lab`]: experiments, and reports as data with their writers |
//! | 6 | [`window`]: a window over the renderer |
//! | 7 | [`cli`]: the command line |

pub mod cli;
pub mod gpu;
pub mod image;
pub mod lab;
pub mod methods;
pub mod metrics;
pub mod names;
pub mod optics;
pub mod passes;
pub mod places;
pub mod renderer;
pub mod scene;
pub mod settings;
pub mod stats;
pub mod store;
pub mod truth;
pub mod view;
pub mod whole;
pub mod window;
