//! A window's pictures: one pass tone-maps a layer into the swapchain's image, which is then shown.
//!
//! As a frame does, showing waits for its own end, so one image is in flight and its time is its own: the image is
//! waited for on the host before the pass, and no frame is read back to be shown.

use ash::vk;
use gpu_allocator::MemoryLocation;
use std::{
    cell::Cell,
    sync::{Arc, atomic::Ordering::Relaxed},
};

use super::{
    chain::{Chain, extent_of},
    device::{Gpu, Shared},
    error::{GpuError, Named},
    memory::{Buffer, Image},
    pipeline::Pipeline,
    plan::ImageId,
    program::Program,
    show,
    surface::Surface,
    timer::Timer,
};

/// How long an image is waited for, ns: a window that nobody sees gets none, and must still hear its keys.
const PATIENCE: u64 = 500_000_000;

/// How a layer is shown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// Exposure, EV.
    pub ev: f64,
    /// The image's fourth channel as grey, instead of its colours.
    pub alpha: bool,
}

/// The window of a device that was opened for one.
pub struct Screen {
    chain: Option<Chain>,
    /// The window has changed since the chain was made.
    stale: Cell<bool>,
    pub(super) format: vk::SurfaceFormatKHR,
    pub(super) pipeline: Arc<Pipeline>,
    pub(super) timer: Timer,
    pub(super) commands: vk::CommandBuffer,
    acquired: vk::Fence,
    done: vk::Fence,
    pub(super) shared: Arc<Shared>,
}

impl Screen {
    /// The screen of a device opened by [`Gpu::for_window`].
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let shared = &gpu.0;
        let format = surface(shared)?.format(shared.info.physical)?;
        let info = vk::CommandBufferAllocateInfo::default().command_pool(shared.pool).command_buffer_count(1);
        let mut screen = Self {
            chain: None,
            stale: Cell::new(false),
            format,
            pipeline: show::pipeline(shared, format.format)?,
            timer: Timer::new(shared, 1)?,
            commands: vk::CommandBuffer::null(),
            acquired: vk::Fence::null(),
            done: vk::Fence::null(),
            shared: shared.clone(),
        };
        // SAFETY: the pool and the device live; each handle is owned by `screen` as it comes.
        unsafe {
            screen.acquired = shared.device.create_fence(&Default::default(), None).named("vkCreateFence")?;
            screen.done = shared.device.create_fence(&Default::default(), None).named("vkCreateFence")?;
            screen.commands = shared.device.allocate_command_buffers(&info).named("vkAllocateCommandBuffers")?[0];
        }
        Ok(screen)
    }

    /// Follows the window: the pixels that a picture must have now, or `None` while it has none. `wanted` is the size
    /// that the window says it has.
    pub fn fit(&mut self, wanted: [u32; 2]) -> Result<Option<[u32; 2]>, GpuError> {
        let surface = surface(&self.shared)?;
        let able = surface.capabilities(self.shared.info.physical)?;
        let extent = extent_of(&able, wanted);
        if self.stale.get() || self.chain.as_ref().map(|c| c.extent) != extent {
            self.chain = None; // a surface has one swapchain at a time
            self.stale.set(false);
        }
        if let (None, Some(extent)) = (&self.chain, extent) {
            self.chain = Some(Chain::new(&self.shared, surface, self.format, (&able, extent))?);
        }
        Ok(extent)
    }

    /// Shows an image of a program, or black; ms on the device. `None` if it was not shown, for the window has changed
    /// or hides: [`Self::fit`] again.
    pub fn show(&mut self, program: &Program, image: Option<ImageId>, look: Look) -> Result<Option<f64>, GpuError> {
        self.present(image.map(|id| &*program.images[id.0]), look, None)
    }

    /// As [`Self::show`], and what the window then shows: sRGB, rows from the top.
    pub fn read(
        &mut self,
        program: &Program,
        image: Option<ImageId>,
        look: Look,
    ) -> Result<Option<Vec<[u8; 3]>>, GpuError> {
        let Some(chain) = &self.chain else { return Ok(None) };
        if !chain.readable {
            return Err(GpuError::NoScreen("its window's images cannot be read back".to_owned()));
        }
        let bytes = 4 * u64::from(chain.extent[0]) * u64::from(chain.extent[1]);
        let staging = Buffer::create(&self.shared, "screenshot", bytes, MemoryLocation::GpuToCpu)?;
        if self.present(image.map(|id| &*program.images[id.0]), look, Some(&staging))?.is_none() {
            return Ok(None);
        }
        self.shared.calls.reads.fetch_add(1, Relaxed);
        let blue_first = matches!(self.format.format, vk::Format::B8G8R8A8_UNORM | vk::Format::B8G8R8A8_SRGB);
        let texels = staging.mapped().unwrap_or_default().get(..bytes as usize).unwrap_or_default();
        let colour = |t: &[u8]| if blue_first { [t[2], t[1], t[0]] } else { [t[0], t[1], t[2]] };
        Ok(Some(texels.chunks_exact(4).map(colour).collect()))
    }

    fn present(&mut self, image: Option<&Image>, look: Look, copy: Option<&Buffer>) -> Result<Option<f64>, GpuError> {
        let Some(chain) = &self.chain else { return Ok(None) };
        if image.is_some_and(|image| image.extent != chain.extent) {
            return Ok(None);
        }
        let Some(index) = self.acquire(chain)? else { return Ok(None) };
        let drawn = [vk::SemaphoreSubmitInfo::default()
            .semaphore(chain.images[index as usize].drawn)
            .stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS)];
        let shared = &self.shared;
        self.timer.reset();
        // SAFETY: the command buffer and the queries are not pending: every showing waits for its fence.
        unsafe {
            let begin = vk::CommandBufferBeginInfo::default().flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
            shared.device.begin_command_buffer(self.commands, &begin).named("vkBeginCommandBuffer")?;
            show::record(self, (chain, index as usize), (image, look), copy);
            shared.device.end_command_buffer(self.commands).named("vkEndCommandBuffer")?;
            let commands = [vk::CommandBufferSubmitInfo::default().command_buffer(self.commands)];
            let submit = [vk::SubmitInfo2::default().command_buffer_infos(&commands).signal_semaphore_infos(&drawn)];
            shared.calls.submits.fetch_add(1, Relaxed);
            shared.device.queue_submit2(shared.queue, &submit, self.done).named("vkQueueSubmit2")?;
            let (wait, chains, indices) = ([drawn[0].semaphore], [chain.handle], [index]);
            let info = vk::PresentInfoKHR::default().wait_semaphores(&wait).swapchains(&chains).image_indices(&indices);
            match chain.loader.queue_present(shared.queue, &info) {
                Ok(false) => {}
                Ok(true) | Err(vk::Result::ERROR_OUT_OF_DATE_KHR) => self.stale.set(true),
                Err(other) => return Err(other).named("vkQueuePresentKHR"),
            }
            shared.calls.waits.fetch_add(1, Relaxed);
            shared.device.wait_for_fences(&[self.done], true, u64::MAX).named("vkWaitForFences")?;
            shared.device.reset_fences(&[self.done]).named("vkResetFences")?;
        }
        Ok(Some(self.timer.times()?.1))
    }

    /// The index of an image to draw to; `None` if there is none now.
    fn acquire(&self, chain: &Chain) -> Result<Option<u32>, GpuError> {
        let device = &self.shared.device;
        // SAFETY: the fence is unsignalled and not pending: it is waited for and reset here alone.
        unsafe {
            let got = chain.loader.acquire_next_image(chain.handle, PATIENCE, vk::Semaphore::null(), self.acquired);
            let (index, suboptimal) = match got {
                Ok(got) => got,
                Err(vk::Result::TIMEOUT | vk::Result::NOT_READY) => return Ok(None),
                Err(vk::Result::ERROR_OUT_OF_DATE_KHR) => {
                    self.stale.set(true);
                    return Ok(None);
                }
                Err(other) => return Err(other).named("vkAcquireNextImageKHR"),
            };
            self.stale.set(suboptimal);
            self.shared.calls.waits.fetch_add(1, Relaxed);
            device.wait_for_fences(&[self.acquired], true, u64::MAX).named("vkWaitForFences")?;
            device.reset_fences(&[self.acquired]).named("vkResetFences")?;
            Ok(Some(index))
        }
    }
}

/// The surface of a device that was opened for a window.
fn surface(shared: &Shared) -> Result<&Surface, GpuError> {
    shared.surface.as_ref().ok_or_else(|| GpuError::NoScreen("the device was opened for no window".to_owned()))
}

impl Drop for Screen {
    fn drop(&mut self) {
        // SAFETY: nothing of this is pending after the wait; null fences are ignored, a null buffer is not freed.
        unsafe {
            let _ = self.shared.device.device_wait_idle();
            if self.commands != vk::CommandBuffer::null() {
                self.shared.device.free_command_buffers(self.shared.pool, &[self.commands]);
            }
            self.shared.device.destroy_fence(self.acquired, None);
            self.shared.device.destroy_fence(self.done, None);
        }
    }
}
