//! The window's life: opened when the window system is ready, drawn until it is closed.

use std::{sync::Arc, thread, time::Duration};

use glam::DVec2;
use winit::{
    application::ApplicationHandler,
    dpi::PhysicalSize,
    event::{ElementState, MouseButton, MouseScrollDelta, WindowEvent},
    event_loop::ActiveEventLoop,
    window::{Window, WindowId},
};

use super::{
    Viewing, Watched, WindowError,
    keys::{self, Action},
    live::Live,
    orbit, reason,
};
use crate::renderer::Job;

/// A window without pixels is asked again after this.
const REST: Duration = Duration::from_millis(20);
/// Pixels of a touch pad that are a notch of a wheel.
const PIXELS_A_NOTCH: f64 = 40.0;

/// What winit drives.
pub(super) struct App {
    job: Job,
    viewing: Viewing,
    live: Option<Live>,
    held: bool,
    /// Where the mouse is, and the button that drags.
    mouse: DVec2,
    drag: Option<MouseButton>,
    outcome: Option<Result<Watched, WindowError>>,
}

impl App {
    pub fn new(job: Job, viewing: Viewing) -> Self {
        Self { job, viewing, live: None, held: false, mouse: DVec2::ZERO, drag: None, outcome: None }
    }

    /// What came of it.
    pub fn finish(self) -> Result<Watched, WindowError> {
        self.outcome.unwrap_or_else(|| Err(WindowError::Failed("it was closed before its first frame".to_owned())))
    }

    fn open(&self, events: &ActiveEventLoop) -> Result<Live, WindowError> {
        let [width, height] = self.job.size;
        let attributes =
            Window::default_attributes().with_title("nephroid").with_inner_size(PhysicalSize::new(width, height));
        let window =
            events.create_window(attributes).map_err(|error| WindowError::NoDisplay(reason(&error.to_string())))?;
        Live::new(Arc::new(window), self.job.clone(), self.viewing.clone())
    }

    /// Ends on an error; a window that was closed takes its leave first.
    fn end(&mut self, events: &ActiveEventLoop, error: Option<WindowError>) {
        let outcome = match (error, self.live.as_mut()) {
            (Some(error), _) => Err(error),
            (None, Some(live)) => live.leave(),
            (None, None) => return events.exit(),
        };
        self.outcome.get_or_insert(outcome);
        self.live = None; // before the connection that its window needs
        events.exit();
    }

    fn draw(&mut self, events: &ActiveEventLoop) {
        let Some(live) = self.live.as_mut() else { return };
        match live.draw() {
            Ok(true) if live.is_done() => self.end(events, None),
            Ok(true) => {}
            Ok(false) => thread::sleep(REST),
            Err(error) => self.end(events, Some(error)),
        }
    }

    fn act(&mut self, events: &ActiveEventLoop, action: Action) {
        let Some(live) = self.live.as_mut() else { return };
        match action {
            Action::Quit => self.end(events, None),
            Action::Help => (self.viewing.say)(&keys::help()),
            Action::Hold => self.held = !self.held,
            Action::NextMethod => match live.next_method() {
                Ok(said) => said.iter().for_each(|line| (self.viewing.say)(line)),
                Err(error) => self.end(events, Some(error)),
            },
            Action::Layer(_) | Action::NextLayer | Action::Time(_) | Action::Exposure(_) | Action::Reset => {
                live.change(action);
            }
        }
    }

    /// A drag from where the mouse was.
    fn moved(&mut self, to: DVec2) {
        let by = to - self.mouse;
        self.mouse = to;
        let (Some(live), Some(button)) = (self.live.as_mut(), self.drag) else { return };
        let drag = by / live.height();
        match button {
            MouseButton::Left => orbit::orbit(&mut live.camera, drag),
            _ => orbit::pan(&mut live.camera, drag),
        }
    }

    fn scrolled(&mut self, delta: MouseScrollDelta) {
        let notches = match delta {
            MouseScrollDelta::LineDelta(_, lines) => f64::from(lines),
            MouseScrollDelta::PixelDelta(pixels) => pixels.y / PIXELS_A_NOTCH,
        };
        if let Some(live) = self.live.as_mut() {
            orbit::zoom(&mut live.camera, notches);
        }
    }
}

impl ApplicationHandler for App {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        if self.live.is_some() || self.outcome.is_some() {
            return;
        }
        match self.open(events) {
            Ok(live) => self.live = Some(live),
            Err(error) => self.end(events, Some(error)),
        }
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        match event {
            WindowEvent::RedrawRequested => return self.draw(events),
            WindowEvent::CloseRequested => self.end(events, None),
            WindowEvent::KeyboardInput { event, .. } if event.state == ElementState::Pressed => {
                let repeats = |action: &Action| matches!(action, Action::Time(_) | Action::Exposure(_));
                let action = keys::action(&event.logical_key).filter(|action| !event.repeat || repeats(action));
                action.into_iter().for_each(|action| self.act(events, action));
            }
            WindowEvent::CursorMoved { position, .. } => self.moved(DVec2::new(position.x, position.y)),
            WindowEvent::MouseInput { state, button, .. } => {
                self.drag = (state == ElementState::Pressed).then_some(button);
            }
            WindowEvent::MouseWheel { delta, .. } => self.scrolled(delta),
            WindowEvent::Resized(_) => {}
            _ => return,
        }
        // What was changed is shown, held or not.
        self.live.iter().for_each(Live::request);
    }

    fn about_to_wait(&mut self, _: &ActiveEventLoop) {
        self.live.iter().filter(|_| !self.held).for_each(Live::request);
    }
}
