//! A frame as data: what is allocated, what is run, and what was left out and why.
//!
//! The plan that is printed is the very list that is recorded.

mod builder;
mod sizes;

use std::sync::Arc;

pub use builder::PassBuilder;

use super::{access::Access, memory::Format};

/// When a pass runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Phase {
    /// Once, before the first frame.
    Prepare,
    /// Every frame, timed.
    Frame,
    /// Once, outside the timed frames: counts and sums for the report.
    Account,
}

/// How long a resource's contents mean something.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Lifetime {
    /// Written once, kept.
    Persistent,
    /// Written anew every frame; of contents, whenever the scene has moved.
    Frame,
}

/// A buffer of a plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct BufferId(pub(super) usize);

/// An image of a plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct ImageId(pub(super) usize);

/// Either.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Resource {
    /// A buffer.
    Buffer(BufferId),
    /// An image.
    Image(ImageId),
}

/// A buffer to allocate.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BufferDecl {
    /// Its name in `plan`, `--dump` and captures.
    pub name: String,
    /// Its size.
    pub bytes: u64,
    /// What it holds from the start.
    pub content: Option<Arc<[u8]>>,
    /// Its lifetime.
    pub lifetime: Lifetime,
}

/// An image to allocate.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ImageDecl {
    /// Its name in `plan`, `--dump` and captures.
    pub name: String,
    /// Width and height, texels.
    pub extent: [u32; 2],
    /// Array layers; `array` images are seen as arrays even with one layer.
    pub layers: u32,
    /// Whether shaders see an array.
    pub array: bool,
    /// Texel format.
    pub format: Format,
    /// Its lifetime.
    pub lifetime: Lifetime,
}

impl ImageDecl {
    /// Bytes of all texels.
    pub fn bytes(&self) -> u64 {
        u64::from(self.extent[0]) * u64::from(self.extent[1]) * u64::from(self.layers) * self.format.bytes()
    }
}

/// A resource bound to a name of the shader.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Binding {
    /// The name in GLSL.
    pub name: String,
    /// What is bound.
    pub resource: Resource,
    /// What the pass does with it.
    pub access: Access,
    /// A variant of the shader may not use it.
    pub optional: bool,
}

/// How fragments join what is there.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Blend {
    /// They replace it.
    Replace,
    /// They are added to it.
    Add,
}

/// A colour attachment.
#[derive(Clone, Debug, PartialEq)]
pub struct Target {
    /// The image.
    pub image: ImageId,
    /// The layer drawn to; `None`: every vertex names its own (`gl_Layer`).
    pub layer: Option<u32>,
    /// Cleared to this first; else kept.
    pub clear: Option<[f32; 4]>,
    /// How fragments are joined.
    pub blend: Blend,
}

/// A depth attachment; smaller is nearer.
#[derive(Clone, Debug, PartialEq)]
pub struct Depth {
    /// The image.
    pub image: ImageId,
    /// Cleared to 1 first; else kept.
    pub clear: bool,
}

/// What vertices make.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Topology {
    /// Points.
    Points,
    /// Triangles.
    Triangles,
}

/// One draw. Shaders pull what they need, but for what a pass gives as vertex attributes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Draw {
    /// Vertices.
    pub vertices: u32,
    /// `gl_VertexIndex` of the first vertex.
    pub first_vertex: u32,
    /// Instances.
    pub instances: u32,
    /// `gl_InstanceIndex` of the first instance.
    pub first_instance: u32,
}

/// Vertices that a geometry shader streams out (transform feedback), from the buffer's start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stream {
    /// Where they go.
    pub vertices: BufferId,
    /// Four bytes: how many bytes were written.
    pub counter: BufferId,
}

/// Work groups of a dispatch along three axes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Groups {
    /// So many.
    Fixed([u32; 3]),
    /// As many as the device has counted (an indirect dispatch): groups along each axis, and the points that they share.
    Counted(Row),
}

/// A row of words that a pass before counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Row {
    /// Rows of [`Self::WORDS`] words.
    pub rows: BufferId,
    /// Which of them.
    pub row: u32,
}

impl Row {
    /// Words of a row.
    pub const WORDS: usize = 4;
    /// Bytes of a row.
    pub const BYTES: u64 = 4 * Self::WORDS as u64;
}

/// What a pass runs.
#[derive(Clone, Debug, PartialEq)]
pub enum Work {
    /// A dispatch.
    Compute {
        /// The `.comp` file.
        shader: String,
        /// Work groups.
        groups: Groups,
        /// Invocations a work group.
        local: u32,
    },
    /// Copies of whole images to buffers, layer by layer, texel by texel: nothing is converted.
    Copy {
        /// From, to.
        copies: Vec<(ImageId, BufferId)>,
    },
    /// Draws into targets.
    Raster {
        /// The stages' files, `.vert` first.
        shaders: Vec<String>,
        /// Colour attachments.
        targets: Vec<Target>,
        /// Depth attachment.
        depth: Option<Depth>,
        /// What vertices make.
        topology: Topology,
        /// The draws.
        draws: Vec<Draw>,
        /// A draw of as many vertices, instances, first vertex and first instance as the device has counted.
        counted: Option<Row>,
        /// A stream to draw after them: its vertices are attribute 0.
        drawn: Option<Stream>,
        /// What is streamed out.
        streamed: Option<Stream>,
    },
}

/// One pass.
#[derive(Clone, Debug, PartialEq)]
pub struct PassDecl {
    /// A stable path such as `light/photons`: timer row, debug label, and what an error names.
    pub name: String,
    /// When it runs.
    pub phase: Phase,
    /// What it runs.
    pub work: Work,
    /// Resources by shader name.
    pub bindings: Vec<Binding>,
    /// Buffers whose elements are vertex attributes, by location, and the format of an element.
    pub attributes: Vec<(BufferId, Format)>,
    /// Push constants.
    pub push: Vec<u8>,
    /// Preprocessor definitions.
    pub defines: Vec<(String, String)>,
    /// Virtual includes and the files that stand for them.
    pub provided: Vec<(String, String)>,
}

/// A pass that the scene or the settings do not need.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LeftOut {
    /// The pass.
    pub name: String,
    /// Why.
    pub reason: String,
}

/// Everything of a frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Plan {
    /// Buffers.
    pub buffers: Vec<BufferDecl>,
    /// Images.
    pub images: Vec<ImageDecl>,
    /// Passes in the order they are recorded.
    pub passes: Vec<PassDecl>,
    /// Passes left out.
    pub left_out: Vec<LeftOut>,
    /// Of a scene that moves: contents may be others at another time.
    pub moves: bool,
}

impl Plan {
    /// Adds a buffer that passes fill.
    pub fn buffer(&mut self, name: &str, bytes: u64, lifetime: Lifetime) -> BufferId {
        self.buffers.push(BufferDecl { name: name.to_owned(), bytes, content: None, lifetime });
        BufferId(self.buffers.len() - 1)
    }

    /// Adds an image.
    pub fn image(&mut self, name: &str, extent: [u32; 2], format: Format, lifetime: Lifetime) -> ImageId {
        self.images.push(ImageDecl { name: name.to_owned(), extent, layers: 1, array: false, format, lifetime });
        ImageId(self.images.len() - 1)
    }

    /// Adds an image that shaders see as an array.
    pub fn image_array(
        &mut self,
        name: &str,
        extent: [u32; 2],
        layers: u32,
        format: Format,
        lifetime: Lifetime,
    ) -> ImageId {
        self.images.push(ImageDecl { name: name.to_owned(), extent, layers, array: true, format, lifetime });
        ImageId(self.images.len() - 1)
    }

    /// Says that a pass is not needed, and why.
    pub fn leave_out(&mut self, name: &str, reason: impl Into<String>) {
        self.left_out.push(LeftOut { name: name.to_owned(), reason: reason.into() });
    }

    /// The buffer or image of that name.
    pub fn find(&self, name: &str) -> Option<Resource> {
        let buffer = self.buffers.iter().position(|b| b.name == name).map(|i| Resource::Buffer(BufferId(i)));
        buffer.or_else(|| self.images.iter().position(|i| i.name == name).map(|i| Resource::Image(ImageId(i))))
    }

    /// The name of a resource.
    pub fn name_of(&self, resource: Resource) -> &str {
        match resource {
            Resource::Buffer(b) => &self.buffers[b.0].name,
            Resource::Image(i) => &self.images[i.0].name,
        }
    }

    /// An image as it was declared.
    pub fn image_decl(&self, image: ImageId) -> &ImageDecl {
        &self.images[image.0]
    }

    /// Width and height of an image.
    pub fn image_extent(&self, image: ImageId) -> [u32; 2] {
        self.image_decl(image).extent
    }
}
