//! A pass as one sentence, from [`Plan::pass`] to a dispatch, a copy or draws.

use super::{
    Binding, Blend, BufferId, Depth, Draw, Groups, ImageId, PassDecl, Phase, Plan, Resource, Row, Stream, Target,
    Topology, Work,
};
use crate::gpu::{access::Access, memory::Format};

impl Plan {
    /// Begins a compute pass: one sentence, ended by [`PassBuilder::dispatch`].
    pub fn pass(&mut self, name: &str) -> PassBuilder<'_> {
        PassBuilder {
            pass: PassDecl {
                name: name.to_owned(),
                phase: Phase::Frame,
                work: Work::Compute { shader: String::new(), groups: Groups::Fixed([0; 3]), local: 64 },
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

    /// Several of them.
    pub fn defines(self, all: &[(&str, String)]) -> Self {
        all.iter().fold(self, |pass, (name, value)| pass.define(name, value))
    }

    /// A virtual include, and the file that stands for it.
    pub fn provide(mut self, name: &str, file: &str) -> Self {
        self.pass.provided.push((name.to_owned(), file.to_owned()));
        self
    }

    /// Ends the sentence with a dispatch of work groups of `local` invocations.
    pub fn dispatch(self, shader: &str, groups: [u32; 3], local: u32) {
        self.compute(shader, Groups::Fixed(groups), local);
    }

    /// Ends the sentence with a dispatch of as many work groups as a pass before counted.
    pub fn dispatch_counted(self, shader: &str, row: Row, local: u32) {
        self.compute(shader, Groups::Counted(row), local);
    }

    fn compute(mut self, shader: &str, groups: Groups, local: u32) {
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
        self.raster(shaders, topology, draws, None, None);
    }

    /// Ends the sentence with a draw of as many points as a pass before counted.
    pub fn draw_counted(self, shaders: &[&str], row: Row) {
        self.raster(shaders, Topology::Points, Vec::new(), Some(row), None);
    }

    /// Ends the sentence with a draw of what was streamed out before, as many points as the counter says: attribute 0,
    /// of that format.
    pub fn draw_stream(self, shaders: &[&str], from: Stream, format: Format) {
        self.attribute(from.vertices, format).raster(shaders, Topology::Points, Vec::new(), None, Some(from));
    }

    fn raster(
        mut self,
        shaders: &[&str],
        topology: Topology,
        draws: Vec<Draw>,
        counted: Option<Row>,
        drawn: Option<Stream>,
    ) {
        self.pass.work = Work::Raster {
            shaders: shaders.iter().map(|s| s.to_string()).collect(),
            targets: self.targets,
            depth: self.depth,
            topology,
            draws,
            counted,
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
