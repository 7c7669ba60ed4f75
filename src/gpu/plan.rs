//! A frame as data: what is allocated, what is run, and what was left out and why.
//!
//! The plan that is printed is the very list that is recorded.

mod sizes;

use std::sync::Arc;

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

/// What a pass runs.
#[derive(Clone, Debug, PartialEq)]
pub enum Work {
    /// A dispatch.
    Compute {
        /// The `.comp` file.
        shader: String,
        /// Work groups.
        groups: [u32; 3],
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

    /// Begins a compute pass: one sentence, ended by [`PassBuilder::dispatch`].
    pub fn pass(&mut self, name: &str) -> PassBuilder<'_> {
        PassBuilder {
            pass: PassDecl {
                name: name.to_owned(),
                phase: Phase::Frame,
                work: Work::Compute { shader: String::new(), groups: [0; 3], local: 64 },
                bindings: Vec::new(),
                attributes: Vec::new(),
                push: Vec::new(),
                defines: Vec::new(),
                provided: Vec::new(),
            },
            targets: Vec::new(),
            depth: None,
            streamed: None,
            plan: self,
        }
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

/// A pass being said.
pub struct PassBuilder<'p> {
    plan: &'p mut Plan,
    pass: PassDecl,
    targets: Vec<Target>,
    depth: Option<Depth>,
    streamed: Option<Stream>,
}

impl PassBuilder<'_> {
    /// Runs in another phase than the frame.
    pub fn phase(mut self, phase: Phase) -> Self {
        self.pass.phase = phase;
        self
    }

    fn bind(mut self, name: &str, resource: Resource, access: Access) -> Self {
        self.pass.bindings.push(Binding { name: name.to_owned(), resource, access, optional: false });
        self
    }

    /// A storage buffer read by any stage of the pass.
    pub fn read(self, name: &str, buffer: BufferId) -> Self {
        self.bind(name, Resource::Buffer(buffer), Access::GraphicsRead)
    }

    /// A storage buffer that a variant of the shader may not use.
    pub fn offer(self, name: &str, buffer: BufferId) -> Self {
        let mut pass = self.read(name, buffer);
        pass.pass.bindings.iter_mut().rev().take(1).for_each(|b| b.optional = true);
        pass
    }

    /// A storage buffer written by a compute shader.
    pub fn write(self, name: &str, buffer: BufferId) -> Self {
        self.bind(name, Resource::Buffer(buffer), Access::ComputeWrite)
    }

    /// Resources under the names they are paired with, buffers read and images fetched.
    pub fn with<'n>(self, resources: impl IntoIterator<Item = (&'n str, Resource)>) -> Self {
        resources.into_iter().fold(self, |pass, (name, resource)| match resource {
            Resource::Buffer(buffer) => pass.read(name, buffer),
            Resource::Image(image) => pass.fetch(name, image),
        })
    }

    /// An image fetched texel by texel.
    pub fn fetch(self, name: &str, image: ImageId) -> Self {
        self.bind(name, Resource::Image(image), Access::GraphicsSample)
    }

    /// A storage image written by a compute shader.
    pub fn store(self, name: &str, image: ImageId) -> Self {
        self.bind(name, Resource::Image(image), Access::ComputeWrite)
    }

    /// A colour attachment.
    pub fn target(mut self, image: ImageId, layer: u32, clear: Option<[f32; 4]>, blend: Blend) -> Self {
        self.targets.push(Target { image, layer: Some(layer), clear, blend });
        self
    }

    /// Draws to all layers of an image at once; each vertex says to which.
    pub fn target_layers(mut self, image: ImageId, clear: Option<[f32; 4]>, blend: Blend) -> Self {
        self.targets.push(Target { image, layer: None, clear, blend });
        self
    }

    /// A depth attachment.
    pub fn depth(mut self, image: ImageId, clear: bool) -> Self {
        self.depth = Some(Depth { image, clear });
        self
    }

    /// A buffer of one element a vertex: the attribute of the next location, from 0 on.
    pub fn attribute(mut self, buffer: BufferId, format: Format) -> Self {
        self.pass.attributes.push((buffer, format));
        self
    }

    /// Streams out what the geometry shader emits.
    pub fn stream(mut self, to: Stream) -> Self {
        self.streamed = Some(to);
        self
    }

    /// Push constants.
    pub fn push<T: bytemuck::NoUninit>(mut self, value: &T) -> Self {
        self.pass.push = bytemuck::bytes_of(value).to_vec();
        self
    }

    /// A preprocessor definition.
    pub fn define(mut self, name: &str, value: impl ToString) -> Self {
        self.pass.defines.push((name.to_owned(), value.to_string()));
        self
    }

    /// A virtual include, and the file that stands for it.
    pub fn provide(mut self, name: &str, file: &str) -> Self {
        self.pass.provided.push((name.to_owned(), file.to_owned()));
        self
    }

    /// Ends the sentence with a dispatch of work groups of `local` invocations.
    pub fn dispatch(mut self, shader: &str, groups: [u32; 3], local: u32) {
        for binding in &mut self.pass.bindings {
            binding.access = match binding.access {
                Access::GraphicsRead => Access::ComputeRead,
                Access::GraphicsSample => Access::ComputeSample,
                other => other,
            };
        }
        self.pass.work = Work::Compute { shader: shader.to_owned(), groups, local };
        self.plan.passes.push(self.pass);
    }

    /// Ends the sentence with copies of whole images to buffers of as many bytes.
    pub fn copy(mut self, copies: Vec<(ImageId, BufferId)>) {
        self.pass.work = Work::Copy { copies };
        self.plan.passes.push(self.pass);
    }

    /// Ends the sentence with draws.
    pub fn draw(self, shaders: &[&str], topology: Topology, draws: Vec<Draw>) {
        self.raster(shaders, topology, draws, None);
    }

    /// Ends the sentence with a draw of what was streamed out before, as many points as the counter says: attribute 0,
    /// of that format.
    pub fn draw_stream(self, shaders: &[&str], from: Stream, format: Format) {
        self.attribute(from.vertices, format).raster(shaders, Topology::Points, Vec::new(), Some(from));
    }

    fn raster(mut self, shaders: &[&str], topology: Topology, draws: Vec<Draw>, drawn: Option<Stream>) {
        self.pass.work = Work::Raster {
            shaders: shaders.iter().map(|s| s.to_string()).collect(),
            targets: self.targets,
            depth: self.depth,
            topology,
            draws,
            drawn,
            streamed: self.streamed,
        };
        self.plan.passes.push(self.pass);
    }

    /// Ends the sentence with one triangle that covers the targets.
    pub fn screen(self, fragment: &str) {
        let draws = vec![Draw { vertices: 3, first_vertex: 0, instances: 1, first_instance: 0 }];
        self.draw(&["passes/screen.vert", fragment], Topology::Triangles, draws);
    }
}
