//! Floor 1, the only room with unsafe code: Vulkan 1.3 from the loader to a timed, validated frame.
//!
//! A frame is data before it is API calls: a [`Plan`] names buffers, images and passes; a [`Program`] allocates and
//! compiles exactly that list once, and records it every frame. Nobody writes a barrier by hand: [`access`] derives
//! each from the two accesses on its sides. Every handle is owned by a type that drops it.
#![allow(unsafe_code)]

pub mod access;
mod capture;
mod chain;
mod choose;
mod device;
mod error;
mod loader;
mod memory;
mod messages;
mod pipeline;
mod plan;
mod program;
mod record;
mod reflect;
mod screen;
mod shader;
mod show;
mod staging;
mod surface;
mod timer;

pub use access::Access;
pub use choose::{DeviceChoice, DeviceInfo, Feature, list_devices};
pub use device::{Calls, Gpu, GpuOptions};
pub use error::GpuError;
pub use loader::{LayerInfo, LoaderInfo, inspect_loader, try_validation};
pub use memory::{Buffer, Format, Image};
pub use plan::{
    Binding, Blend, BufferDecl, BufferId, Depth, Draw, Groups, ImageDecl, ImageId, LeftOut, Lifetime, PassBuilder,
    PassDecl, Phase, Plan, Resource, Row, Stream, Target, Topology, Work,
};
pub use program::{Program, Reused};
pub use reflect::{BlockMember, Reflection};
pub use screen::{Look, Screen};
pub use shader::{ShaderKind, Sources, spirv_version};
pub use show::SHOW;
pub use surface::OnScreen;
pub use timer::{FrameTimes, PassCounters};
