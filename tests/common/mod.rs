//! Shared by the integration tests: a validated device, shader probes that run shipped GLSL on lists of inputs, pictures.
#![allow(dead_code)] // each test binary uses its own part

pub mod cpu;
pub mod picture;
pub mod random;

use bytemuck::{NoUninit, Pod};
use nephroid::{
    gpu::{Gpu, GpuOptions, Lifetime, PassBuilder, Phase, Plan, Program, Sources},
    renderer::Job,
    scene::Scene,
    store::Store,
};

/// Invocations a work group of a probe.
const GROUP: u32 = 64;

/// A device with core and synchronisation validation. No device, or no layer, is a failure: skips are not silent.
pub fn gpu() -> Gpu {
    let options = GpuOptions { validation: true, ..Default::default() };
    Gpu::new(&options).expect("tests need a Vulkan device and the validation layers: run scripts/setup")
}

/// Fails on any message of the validation layers.
pub fn assert_quiet(gpu: &Gpu) {
    let messages = gpu.take_messages();
    assert!(messages.is_empty(), "validation: {messages:#?}");
}

/// Binds to a pass what a probe added to its plan.
pub type Binder = Box<dyn for<'p> FnOnce(PassBuilder<'p>) -> PassBuilder<'p>>;

/// A probe: GLSL that turns one `In q` into one `Out r`, run over a list.
pub struct Probe<'a> {
    /// Files to include.
    pub includes: &'a [&'a str],
    /// Members of `struct In`.
    pub input: &'a str,
    /// Members of `struct Out`.
    pub output: &'a str,
    /// Functions and variables before `main`.
    pub before: &'a str,
    /// Statements; read `q`, write `r`.
    pub body: &'a str,
    /// Preprocessor definitions.
    pub defines: &'a [(&'a str, &'a str)],
}

impl Default for Probe<'_> {
    fn default() -> Self {
        Self { includes: &[], input: "float x;", output: "float y;", before: "", body: "", defines: &[] }
    }
}

impl Probe<'_> {
    /// Runs it; `extra` adds buffers to the plan and gives what binds them.
    pub fn run_with<I: NoUninit, O: Pod>(
        &self,
        gpu: &Gpu,
        inputs: &[I],
        extra: impl FnOnce(&mut Plan) -> Binder,
    ) -> Vec<O> {
        let includes: String = self.includes.iter().map(|i| format!("#include \"{i}\"\n")).collect();
        let text = format!(
            "#version 460\n#extension GL_GOOGLE_include_directive : require\n\
             #extension GL_EXT_scalar_block_layout : require\n\
             layout(local_size_x = {GROUP}) in;\n{includes}\
             struct In {{ {} }};\nstruct Out {{ {} }};\n\
             layout(set = 0, binding = 20, scalar) readonly buffer Inputs {{ In at[]; }} probe_inputs;\n\
             layout(set = 0, binding = 21, scalar) writeonly buffer Outputs {{ Out at[]; }} probe_outputs;\n\
             layout(push_constant) uniform Push {{ uint count; }} push;\n{}\n\
             void main() {{\n  uint index = gl_GlobalInvocationID.x;\n  if (index >= push.count) return;\n\
             In q = probe_inputs.at[index];\n  Out r;\n{}\n  probe_outputs.at[index] = r;\n}}\n",
            self.input, self.output, self.before, self.body
        );
        let mut sources = Sources::default();
        sources.replace("probe.comp", text);
        let mut plan = Plan::default();
        let bind = extra(&mut plan);
        let from = plan.upload("inputs", inputs);
        let bytes = (inputs.len() * size_of::<O>()) as u64;
        let to = plan.buffer("outputs", bytes, Lifetime::Frame);
        let count = inputs.len() as u32;
        let pass = plan.pass("probe").read("probe_inputs", from).write("probe_outputs", to).push(&count);
        let pass = self.defines.iter().fold(bind(pass), |pass, (name, value)| pass.define(name, value));
        pass.dispatch("probe.comp", [count.div_ceil(GROUP).max(1), 1, 1], GROUP);
        let mut program = Program::new(gpu, plan, &sources, &Store::open(), None).expect("the probe is prepared");
        program.run(Phase::Frame, &[]).expect("the probe runs");
        let outputs = program.read_buffer(to).expect("the outputs are read");
        assert_quiet(gpu);
        bytemuck::pod_collect_to_vec(&outputs)
    }

    /// Runs it without a scene.
    pub fn run<I: NoUninit, O: Pod>(&self, gpu: &Gpu, inputs: &[I]) -> Vec<O> {
        self.run_with(gpu, inputs, |_| Box::new(|pass| pass))
    }
}

/// A job for a shipped scene or file with method `maps`; settings by name, `scene.` among them.
pub fn job(scene: &str, set: &[(&str, &str)], camera: &str, size: [u32; 2]) -> Job {
    let of_scene = |(key, value): &(&str, &str)| Some((key.strip_prefix("scene.")?.to_owned(), (*value).to_owned()));
    let overrides: Vec<_> = set.iter().filter_map(of_scene).collect();
    let set: Vec<_> = set.iter().filter(|(key, _)| !key.starts_with("scene.")).copied().collect();
    let scene = Scene::load(scene, &overrides).unwrap_or_else(|e| panic!("{scene}: {e}"));
    picture::job_of(scene, &set, camera, size)
}
