//! How many bytes a plan takes, and a pass writes.

use super::{ImageDecl, PassDecl, Plan, Resource, Work};

impl Plan {
    /// Bytes of all buffers and images, and of the memory through which contents change.
    pub fn bytes(&self) -> u64 {
        let buffers = self.buffers.iter().map(|b| b.bytes).sum::<u64>();
        buffers + self.images.iter().map(ImageDecl::bytes).sum::<u64>() + self.staging_bytes()
    }

    /// Bytes that a pass writes: its targets and the storage it declares as written.
    pub fn bytes_written(&self, pass: &PassDecl) -> u64 {
        let stored = pass.bindings.iter().filter(|b| b.access.writes()).map(|b| match b.resource {
            Resource::Buffer(b) => self.buffers[b.0].bytes,
            Resource::Image(i) => self.images[i.0].bytes(),
        });
        let drawn = match &pass.work {
            Work::Compute { .. } => 0,
            Work::Copy { copies } => copies.iter().map(|(_, to)| self.buffers[to.0].bytes).sum(),
            Work::Raster { targets, streamed, .. } => {
                let streamed = streamed.iter().map(|s| self.buffers[s.vertices.0].bytes);
                targets.iter().map(|t| self.images[t.image.0].bytes()).chain(streamed).sum()
            }
        };
        stored.sum::<u64>() + drawn
    }
}
