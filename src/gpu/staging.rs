//! New contents for a program whose plan has changed in nothing else: copied from memory that is mapped all along.

use ash::vk;
use gpu_allocator::MemoryLocation;
use std::sync::Arc;

use super::{
    access::Access,
    device::Shared,
    error::GpuError,
    memory::Buffer,
    plan::{BufferDecl, BufferId, Lifetime, Plan},
    program::Program,
    record::buffer_barrier,
};

/// Room for the contents that may change, each in its own place, and those that wait to be copied.
pub(super) struct Staging {
    buffer: Option<Buffer>,
    /// Of each buffer of the plan that has one.
    places: Vec<Option<u64>>,
    waiting: Vec<usize>,
}

impl Staging {
    pub fn new(shared: &Arc<Shared>, plan: &Plan) -> Result<Self, GpuError> {
        let mut end = 0;
        let place = |decl: &BufferDecl| {
            decl.may_change().then(|| {
                let at = end;
                end += decl.bytes.next_multiple_of(4);
                at
            })
        };
        let places = plan.buffers.iter().map(place).collect();
        let make = || Buffer::create(shared, "staging", end, MemoryLocation::CpuToGpu);
        Ok(Self { buffer: (end > 0).then(make).transpose()?, places, waiting: Vec::new() })
    }

    /// Whether a buffer of the device holds what the plan says.
    pub fn is_settled(&self, index: usize) -> bool {
        !self.waiting.contains(&index)
    }

    /// Keeps new bytes of a buffer until the next run.
    fn keep(&mut self, index: usize, bytes: &[u8]) {
        let place = self.places.get(index).copied().flatten().map(|at| at as usize);
        let memory = self.buffer.as_mut().and_then(Buffer::mapped_mut);
        let room = place.zip(memory).and_then(|(at, memory)| memory.get_mut(at..at + bytes.len()));
        if let Some(room) = room {
            room.copy_from_slice(bytes);
            if !self.waiting.contains(&index) {
                self.waiting.push(index);
            }
        }
    }
}

impl BufferDecl {
    /// Whether a plan for another time may give it other contents.
    pub fn may_change(&self) -> bool {
        self.content.is_some() && self.lifetime == Lifetime::Frame
    }
}

impl Plan {
    /// Adds a buffer that holds `items` from the start, and others at another time where the scene moves.
    pub fn upload<T: bytemuck::NoUninit>(&mut self, name: &str, items: &[T]) -> BufferId {
        let lifetime = if self.moves { Lifetime::Frame } else { Lifetime::Persistent };
        self.hold(name, items, lifetime)
    }

    /// Adds a buffer that holds `items` whatever the time.
    pub fn upload_once<T: bytemuck::NoUninit>(&mut self, name: &str, items: &[T]) -> BufferId {
        self.hold(name, items, Lifetime::Persistent)
    }

    fn hold<T: bytemuck::NoUninit>(&mut self, name: &str, items: &[T], lifetime: Lifetime) -> BufferId {
        self.hold_bytes(name, bytemuck::cast_slice(items).into(), lifetime)
    }

    /// As [`Self::upload_once`], of bytes that are shared: none are copied where a scene moves.
    pub fn upload_shared(&mut self, name: &str, content: Arc<[u8]>) -> BufferId {
        self.hold_bytes(name, content, Lifetime::Persistent)
    }

    fn hold_bytes(&mut self, name: &str, content: Arc<[u8]>, lifetime: Lifetime) -> BufferId {
        self.buffers.push(BufferDecl {
            name: name.to_owned(),
            bytes: content.len() as u64,
            content: Some(content),
            lifetime,
        });
        BufferId(self.buffers.len() - 1)
    }

    /// Bytes of the mapped memory through which contents change.
    pub fn staging_bytes(&self) -> u64 {
        self.buffers.iter().filter(|b| b.may_change()).map(|b| b.bytes.next_multiple_of(4)).sum()
    }

    /// Whether another plan runs the same passes on the same resources: all but contents that may change are equal.
    pub(super) fn differs_in_contents_alone(&self, other: &Self) -> bool {
        let alike = |(a, b): (&BufferDecl, &BufferDecl)| {
            let same = a.name == b.name && a.bytes == b.bytes && a.lifetime == b.lifetime;
            same && a.content.is_some() == b.content.is_some() && (a.may_change() || a.content == b.content)
        };
        self.buffers.len() == other.buffers.len()
            && self.buffers.iter().zip(&other.buffers).all(alike)
            && self.images == other.images
            && self.passes == other.passes
    }
}

impl Program {
    /// Takes over the contents of a plan that differs from this one in nothing else: they are there from the next run on.
    /// False, and nothing changes, where more differs.
    pub fn refresh(&mut self, plan: &Plan) -> bool {
        if !self.plan.differs_in_contents_alone(plan) {
            return false;
        }
        for index in 0..plan.buffers.len() {
            let (old, new) = (&self.plan.buffers[index].content, &plan.buffers[index].content);
            if old != new {
                self.staging.keep(index, new.as_deref().unwrap_or_default());
                self.plan.buffers[index].content = new.clone();
            }
        }
        true
    }

    /// Records the copies that wait.
    ///
    /// # Safety
    /// The program's command buffer is recording, and nothing that reads the staging memory is pending.
    pub(super) unsafe fn copy_waiting(&mut self) {
        let commands = self.commands();
        for index in std::mem::take(&mut self.staging.waiting) {
            let (Some(staging), Some(at)) = (&self.staging.buffer, self.staging.places[index]) else { continue };
            let target = &self.buffers[index];
            let before = target.history.borrow_mut().advance(Access::CopyWrite, false);
            self.barriers(commands, before.iter().map(|b| buffer_barrier(b, target)).collect(), Vec::new());
            let region = [vk::BufferCopy { src_offset: at, dst_offset: 0, size: self.plan.buffers[index].bytes }];
            // SAFETY: both buffers hold the region and live as long as the program; the host wrote before the submit.
            unsafe { self.shared.device.cmd_copy_buffer(commands, staging.handle, target.handle, &region) }
        }
    }
}
