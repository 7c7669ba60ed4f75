//! An open window: a renderer, the screen it is shown on, and what the user has changed.

use std::{
    io::Write,
    sync::Arc,
    time::{Duration, Instant},
};

use winit::window::Window;

use super::{Viewing, Watched, WindowError, keys::Action, times::Times};
use crate::{
    gpu::{DeviceInfo, Gpu, Screen},
    image::{self, rgb_to_png},
    lab::{DeviceRow, Provenance},
    methods,
    passes::{extents, eye},
    renderer::{self, Frame, Job, LAYERS, Providers, Renderer},
    scene::Camera,
    view::Extent,
    whole::write_whole,
};

/// The title is set no more often than it can be read.
const TITLE_EVERY: Duration = Duration::from_millis(250);
/// How often a screenshot is tried on a window that changes under it.
const TRIES: u32 = 20;
/// Exposures beyond this show nothing that float32 holds, EV.
const MOST_EV: f64 = 60.0;

pub(super) struct Live {
    /// Where it is looked from.
    pub camera: Camera,
    /// `None` only while it is planned again.
    renderer: Option<Renderer>,
    screen: Screen,
    window: Arc<Window>,
    job: Job,
    viewing: Viewing,
    everything: Extent,
    layer: usize,
    ev: f64,
    time: f64,
    index: u32,
    timed: u32,
    /// The first frame of a plan compiles: it is no sample.
    warm: bool,
    times: Times,
    titled: Option<Instant>,
}

impl Live {
    /// Opens the device for the window, and prepares the job.
    pub fn new(window: Arc<Window>, job: Job, viewing: Viewing) -> Result<Self, WindowError> {
        let gpu = Gpu::for_window(&viewing.gpu, window.clone())?;
        (viewing.say)(&format!("device: {}", gpu.info().label()));
        let renderer = Renderer::new(&gpu, &job)?;
        Ok(Self {
            camera: job.camera()?.clone(),
            times: Times::new(renderer.stages(), viewing.frames),
            renderer: Some(renderer),
            screen: Screen::new(&gpu)?,
            window,
            everything: extents::everything(&job.scene),
            job,
            layer: 0,
            ev: viewing.ev,
            time: 0.0,
            index: 0,
            timed: 0,
            warm: false,
            titled: None,
            viewing,
        })
    }

    /// Asks for another frame.
    pub fn request(&self) {
        self.window.request_redraw();
    }

    /// Whether it has shown as many frames as were asked for.
    pub fn is_done(&self) -> bool {
        self.viewing.frames.is_some_and(|frames| self.timed >= frames)
    }

    /// Pixels down.
    pub fn height(&self) -> f64 {
        f64::from(self.job.size[1])
    }

    /// Draws a frame and shows it; false if there was nothing to show it on.
    pub fn draw(&mut self) -> Result<bool, WindowError> {
        if !self.fit()? {
            return Ok(false);
        }
        let frame = self.frame();
        let Some(renderer) = self.renderer.as_mut() else { return Ok(false) };
        let times = renderer.frame(&frame)?;
        let Some(show_ms) = renderer.show(&mut self.screen, LAYERS[self.layer], self.ev)? else { return Ok(false) };
        self.index = self.index.wrapping_add(1);
        if self.warm {
            self.times.add(&times, show_ms);
            self.timed += 1;
        }
        self.warm = true;
        self.entitle();
        Ok(true)
    }

    fn frame(&self) -> Frame {
        let moved = self.job.scene.moves().then(|| extents::everything(&self.job.scene.at(self.time)));
        let view = eye::view(&self.camera, self.job.size, moved.as_ref().unwrap_or(&self.everything));
        Frame { time: self.time, index: self.index, seed: 0, camera: Some(view) }
    }

    /// Follows the window's size; false while it has none.
    fn fit(&mut self) -> Result<bool, WindowError> {
        let Some(size) = self.screen.fit(self.window.inner_size().into())? else { return Ok(false) };
        if size != self.job.size {
            self.replan(Job { size, ..self.job.clone() })?;
        }
        Ok(true)
    }

    fn replan(&mut self, job: Job) -> Result<(), WindowError> {
        if let Some(old) = self.renderer.take() {
            let renderer = old.replan(&job)?;
            self.times = Times::new(renderer.stages(), self.viewing.frames);
            self.renderer = Some(renderer);
            self.job = job;
            self.warm = false;
        }
        Ok(())
    }

    /// The next method that this device and this scene can have, none among them; what was passed over, and why.
    pub fn next_method(&mut self) -> Result<Vec<String>, WindowError> {
        let Some(features) = self.device().map(|d| d.features.clone()) else { return Ok(Vec::new()) };
        let now = self.job.providers.methods().first().map(|m| m.name());
        let at = methods::ALL.iter().position(|m| Some(m.name()) == now);
        let mut said = Vec::new();
        for method in methods::ALL.iter().skip(at.map_or(0, |at| at + 1)) {
            let lacks = renderer::lacks(*method, &self.job.settings, &features);
            let job = Job { providers: Providers::of(*method), ..self.job.clone() };
            match renderer::plan(&job) {
                Ok(_) if lacks.is_empty() => return self.replan(job).map(|()| said),
                Ok(_) => said.push(format!("{}: the device lacks {}", method.name(), lacks.join(", "))),
                Err(error) => said.push(format!("{}: {error}", method.name())),
            }
        }
        self.replan(Job { providers: Providers::default(), ..self.job.clone() }).map(|()| said)
    }

    /// What needs no new plan.
    pub fn change(&mut self, action: Action) {
        match action {
            Action::Layer(layer) => self.layer = layer.min(LAYERS.len() - 1),
            Action::NextLayer => self.layer = (self.layer + 1) % LAYERS.len(),
            Action::Time(more) => self.time += more,
            Action::Exposure(more) => self.ev = (self.ev + more).clamp(-MOST_EV, MOST_EV),
            Action::Reset => {
                (self.time, self.ev) = (0.0, self.viewing.ev);
                self.job.camera().ok().cloned().into_iter().for_each(|camera| self.camera = camera);
            }
            Action::NextMethod | Action::Hold | Action::Help | Action::Quit => {}
        }
        self.titled = None;
    }

    /// Before it closes: what it shows, written, and the times of what it has shown.
    pub fn leave(&mut self) -> Result<Watched, WindowError> {
        let path = self.viewing.screenshot.clone();
        let png = path.as_ref().map(|_| self.screenshot()).transpose()?;
        let Some(device) = self.device() else { return Err(WindowError::Failed("it has no renderer".to_owned())) };
        let [width, height] = self.job.size;
        let heading = format!("{}, camera {}, {width}x{height} pixels", self.subject(), self.job.camera);
        let watched = self.times.watched(heading, DeviceRow::from(device));
        let messages = self.renderer.iter().flat_map(|r| r.gpu().take_messages()).collect::<Vec<_>>();
        if !messages.is_empty() {
            return Err(WindowError::Validation(messages));
        }
        if let (Some(path), Some(png)) = (path, png) {
            write_whole(&path, |out| out.write_all(&png))?;
        }
        Ok(watched)
    }

    /// What the window shows, as PNG. It is shown once more for it, outside the frames.
    fn screenshot(&mut self) -> Result<Vec<u8>, WindowError> {
        for _ in 0..TRIES {
            // A window whose size has changed needs a frame of that size first.
            if !self.fit()? || !self.warm && !self.draw()? {
                continue;
            }
            let Some(renderer) = self.renderer.as_ref() else { break };
            let shown = renderer.screenshot(&mut self.screen, LAYERS[self.layer], self.ev)?;
            if let Some(colours) = shown {
                return Ok(rgb_to_png(self.job.size.map(|side| side as usize), &colours, &self.about(renderer))?);
            }
        }
        Err(WindowError::Failed("it has no pixels to make a screenshot of".to_owned()))
    }

    /// What makes the same picture again.
    fn about(&self, renderer: &Renderer) -> image::Provenance {
        let (device, arguments) = (renderer.gpu().info(), self.viewing.arguments.clone());
        let mut about = Provenance::new(&self.job, &self.frame(), device, arguments).attributes();
        let Camera { position, target, .. } = self.camera;
        let seen = [("layer", LAYERS[self.layer].to_owned()), ("exposure_ev", self.ev.to_string())];
        let from = [("position_m", position.to_string()), ("target_m", target.to_string())];
        about.extend(seen.into_iter().chain(from).map(|(name, text)| (format!("view.{name}"), text)));
        about
    }

    fn device(&self) -> Option<&DeviceInfo> {
        self.renderer.as_ref().map(|renderer| renderer.gpu().info())
    }

    /// Scene and method.
    fn subject(&self) -> String {
        let methods: Vec<_> = self.job.providers.methods().iter().map(|m| m.name()).collect();
        let methods = if methods.is_empty() { "none".to_owned() } else { methods.join(" and ") };
        format!("{}, method {methods}", self.job.scene.name)
    }

    fn entitle(&mut self) {
        if self.titled.is_some_and(|then| then.elapsed() < TITLE_EVERY) {
            return;
        }
        self.titled = Some(Instant::now());
        let device = self.device().map(|d| format!("{} ({})", d.name, d.kind)).unwrap_or_default();
        let (layer, ev, times) = (LAYERS[self.layer], self.ev, self.times.title());
        self.window.set_title(&format!("{} | {layer} at {ev:+.1} EV | {times} | {device}", self.subject()));
    }
}
