//! Barriers as a pure function of the accesses on their two sides; no device, no state but what is passed in.
//!
//! One coarse policy: a resource is written by one pass and then read by any number of passes. A read waits for the last
//! write (once per kind of read); a write waits for every read since, or for the last write if there was none.

use ash::vk::{AccessFlags2 as A, ImageLayout as L, PipelineStageFlags2 as S};

/// What a pass does with a resource.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Access {
    /// Nothing yet: contents undefined.
    None,
    /// Storage read in a compute shader.
    ComputeRead,
    /// Storage write, or read and write, in a compute shader.
    ComputeWrite,
    /// Sampled or fetched in a compute shader.
    ComputeSample,
    /// Storage read in a vertex or geometry shader.
    VertexRead,
    /// Sampled or fetched in a vertex or geometry shader.
    VertexSample,
    /// Storage read in a fragment shader.
    FragmentRead,
    /// Sampled or fetched in a fragment shader.
    FragmentSample,
    /// Storage read in any graphics stage.
    GraphicsRead,
    /// Sampled or fetched in any graphics stage.
    GraphicsSample,
    /// Colour attachment, blended or not.
    Color,
    /// Depth attachment, tested and written.
    Depth,
    /// Vertex attributes fetched by fixed function.
    VertexAttributes,
    /// Indirect draw or dispatch arguments, or a transform-feedback byte count drawn from.
    Indirect,
    /// Transform feedback: captured vertices written.
    StreamWrite,
    /// Transform feedback: counter written at the end of capture.
    StreamCounterWrite,
    /// Transform feedback: counter read to append, then written again.
    StreamCounterAppend,
    /// Source of a copy or blit.
    CopyRead,
    /// Target of a copy, fill, clear or update.
    CopyWrite,
    /// Read by the CPU after the fence.
    HostRead,
    /// Handed to the window system, behind a semaphore.
    Present,
}

/// Stages, accesses and image layout of one access.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Scope {
    /// Pipeline stages.
    pub stages: S,
    /// Memory accesses.
    pub access: A,
    /// Layout that an image must have.
    pub layout: L,
}

/// A barrier between two accesses. For buffers the layouts mean nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Barrier {
    /// What must have finished.
    pub from: Scope,
    /// What waits.
    pub to: Scope,
}

impl Access {
    /// Stages, memory accesses and layout.
    pub fn scope(self) -> Scope {
        let geometry = S::VERTEX_SHADER | S::GEOMETRY_SHADER;
        let (stages, access, layout) = match self {
            Self::None => (S::NONE, A::NONE, L::UNDEFINED),
            Self::ComputeRead => (S::COMPUTE_SHADER, A::SHADER_STORAGE_READ, L::GENERAL),
            Self::ComputeWrite => (S::COMPUTE_SHADER, A::SHADER_STORAGE_READ | A::SHADER_STORAGE_WRITE, L::GENERAL),
            Self::ComputeSample => (S::COMPUTE_SHADER, A::SHADER_SAMPLED_READ, L::SHADER_READ_ONLY_OPTIMAL),
            Self::VertexRead => (geometry, A::SHADER_STORAGE_READ, L::GENERAL),
            Self::VertexSample => (geometry, A::SHADER_SAMPLED_READ, L::SHADER_READ_ONLY_OPTIMAL),
            Self::FragmentRead => (S::FRAGMENT_SHADER, A::SHADER_STORAGE_READ, L::GENERAL),
            Self::FragmentSample => (S::FRAGMENT_SHADER, A::SHADER_SAMPLED_READ, L::SHADER_READ_ONLY_OPTIMAL),
            Self::GraphicsRead => (geometry | S::FRAGMENT_SHADER, A::SHADER_STORAGE_READ, L::GENERAL),
            Self::GraphicsSample => {
                (geometry | S::FRAGMENT_SHADER, A::SHADER_SAMPLED_READ, L::SHADER_READ_ONLY_OPTIMAL)
            }
            Self::Color => (
                S::COLOR_ATTACHMENT_OUTPUT,
                A::COLOR_ATTACHMENT_READ | A::COLOR_ATTACHMENT_WRITE,
                L::COLOR_ATTACHMENT_OPTIMAL,
            ),
            Self::Depth => (
                S::EARLY_FRAGMENT_TESTS | S::LATE_FRAGMENT_TESTS,
                A::DEPTH_STENCIL_ATTACHMENT_READ | A::DEPTH_STENCIL_ATTACHMENT_WRITE,
                L::DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
            ),
            Self::VertexAttributes => (S::VERTEX_INPUT, A::VERTEX_ATTRIBUTE_READ, L::GENERAL),
            Self::Indirect => (S::DRAW_INDIRECT, A::INDIRECT_COMMAND_READ, L::GENERAL),
            Self::StreamWrite => (S::TRANSFORM_FEEDBACK_EXT, A::TRANSFORM_FEEDBACK_WRITE_EXT, L::GENERAL),
            Self::StreamCounterWrite => {
                (S::TRANSFORM_FEEDBACK_EXT, A::TRANSFORM_FEEDBACK_COUNTER_WRITE_EXT, L::GENERAL)
            }
            Self::StreamCounterAppend => (
                S::TRANSFORM_FEEDBACK_EXT | S::DRAW_INDIRECT,
                A::TRANSFORM_FEEDBACK_COUNTER_READ_EXT | A::TRANSFORM_FEEDBACK_COUNTER_WRITE_EXT,
                L::GENERAL,
            ),
            Self::CopyRead => (S::ALL_TRANSFER, A::TRANSFER_READ, L::TRANSFER_SRC_OPTIMAL),
            Self::CopyWrite => (S::ALL_TRANSFER, A::TRANSFER_WRITE, L::TRANSFER_DST_OPTIMAL),
            Self::HostRead => (S::HOST, A::HOST_READ, L::GENERAL),
            Self::Present => (S::NONE, A::NONE, L::PRESENT_SRC_KHR),
        };
        Scope { stages, access, layout }
    }

    /// True if the access changes the contents (or may).
    pub fn writes(self) -> bool {
        matches!(
            self,
            Self::ComputeWrite
                | Self::Color
                | Self::Depth
                | Self::StreamWrite
                | Self::StreamCounterWrite
                | Self::StreamCounterAppend
                | Self::CopyWrite
        )
    }
}

/// The barrier that lets `next` follow `previous`: none if nothing has to wait and the layout stays.
pub fn barrier(previous: Access, next: Access) -> Option<Barrier> {
    let (mut from, to) = (previous.scope(), next.scope());
    let layout_stays = from.layout == to.layout;
    if (previous == Access::None || !previous.writes() && !next.writes()) && layout_stays {
        return None;
    }
    if !previous.writes() {
        from.access = A::NONE; // a read makes nothing to flush: the execution dependency alone is enough
    }
    Some(Barrier { from, to })
}

/// What happened to a resource since its last write.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct History {
    write: Access,
    reads: Vec<Access>,
    layout: L,
    /// Stages that the last change of layout was made visible to; a later read elsewhere chains on them.
    relaid: S,
}

impl Default for History {
    fn default() -> Self {
        Self { write: Access::None, reads: Vec::with_capacity(8), layout: L::UNDEFINED, relaid: S::NONE }
    }
}

impl History {
    /// The barrier before `next`, and the history after it. `is_image`: whether layouts matter.
    pub fn advance(&mut self, next: Access, is_image: bool) -> Option<Barrier> {
        let relayout = is_image && self.layout != next.scope().layout;
        let fresh = self.write == Access::None && self.reads.is_empty() && !is_image;
        let found = if fresh {
            None
        } else if next.writes() || relayout {
            self.after_all(next)
        } else {
            self.after_write(next)
        };
        let found = found.map(|b| Barrier { from: Scope { layout: self.layout, ..b.from }, ..b });
        if relayout {
            self.layout = next.scope().layout;
            self.relaid = next.scope().stages;
        }
        if next.writes() {
            self.write = next;
            self.reads.clear();
        } else {
            if relayout {
                self.reads.clear(); // the layout change itself waited for them, and later writes wait for it
            }
            if !self.reads.contains(&next) {
                self.reads.push(next);
            }
        }
        found
    }

    /// A write, or a change of layout, waits for every read since the last write, else for that write.
    fn after_all(&self, next: Access) -> Option<Barrier> {
        let mut merged: Option<Barrier> = None;
        for &read in &self.reads {
            if let Some(b) = barrier(read, next).or_else(|| forced(read, next)) {
                let all = merged.get_or_insert(b);
                all.from.stages |= b.from.stages;
            }
        }
        // What follows must also see the last write, which the reads alone do not make visible.
        if self.write != Access::None {
            let b = barrier(self.write, next).or_else(|| forced(self.write, next))?;
            let all = merged.get_or_insert(b);
            all.from.stages |= b.from.stages;
            all.from.access |= b.from.access;
        }
        merged.or_else(|| barrier(Access::None, next))
    }

    /// A read waits for the last write, once per kind of read.
    fn after_write(&self, next: Access) -> Option<Barrier> {
        if self.reads.contains(&next) || self.write == Access::None {
            return None;
        }
        let mut found = barrier(self.write, next).or_else(|| forced(self.write, next))?;
        found.from.stages |= self.relaid;
        Some(found)
    }
}

/// A barrier even where the two accesses alone would need none: for a layout that changes around them.
fn forced(previous: Access, next: Access) -> Option<Barrier> {
    let mut from = previous.scope();
    if !previous.writes() {
        from.access = A::NONE;
    }
    Some(Barrier { from, to: next.scope() })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_read_after_a_write_waits_and_sees() {
        let b = barrier(Access::ComputeWrite, Access::VertexSample).unwrap();
        assert_eq!(b.from.stages, S::COMPUTE_SHADER);
        assert!(b.from.access.contains(A::SHADER_STORAGE_WRITE));
        assert!(b.to.stages.contains(S::VERTEX_SHADER) && b.to.access == A::SHADER_SAMPLED_READ);
        assert_eq!((b.from.layout, b.to.layout), (L::GENERAL, L::SHADER_READ_ONLY_OPTIMAL));
    }

    #[test]
    fn a_write_after_a_read_waits_but_flushes_nothing() {
        let b = barrier(Access::FragmentRead, Access::ComputeWrite).unwrap();
        assert_eq!((b.from.stages, b.from.access), (S::FRAGMENT_SHADER, A::NONE));
    }

    #[test]
    fn two_reads_need_nothing() {
        assert_eq!(barrier(Access::ComputeRead, Access::FragmentRead), None);
        assert_eq!(barrier(Access::ComputeSample, Access::VertexSample), None);
    }

    #[test]
    fn stream_out_is_ordered_before_vertex_input_and_byte_count() {
        let vertices = barrier(Access::StreamWrite, Access::VertexAttributes).unwrap();
        assert_eq!(vertices.from.stages, S::TRANSFORM_FEEDBACK_EXT);
        assert_eq!(vertices.from.access, A::TRANSFORM_FEEDBACK_WRITE_EXT);
        assert_eq!((vertices.to.stages, vertices.to.access), (S::VERTEX_INPUT, A::VERTEX_ATTRIBUTE_READ));
        let count = barrier(Access::StreamCounterWrite, Access::Indirect).unwrap();
        assert_eq!(count.from.access, A::TRANSFORM_FEEDBACK_COUNTER_WRITE_EXT);
        assert_eq!((count.to.stages, count.to.access), (S::DRAW_INDIRECT, A::INDIRECT_COMMAND_READ));
        let append = barrier(Access::StreamCounterWrite, Access::StreamCounterAppend).unwrap();
        assert!(append.to.stages.contains(S::TRANSFORM_FEEDBACK_EXT));
        assert!(append.to.access.contains(A::TRANSFORM_FEEDBACK_COUNTER_READ_EXT));
        let reuse = barrier(Access::VertexAttributes, Access::StreamWrite).unwrap();
        assert_eq!((reuse.from.stages, reuse.to.stages), (S::VERTEX_INPUT, S::TRANSFORM_FEEDBACK_EXT));
    }

    #[test]
    fn indirect_arguments_written_by_compute_are_waited_for() {
        let b = barrier(Access::ComputeWrite, Access::Indirect).unwrap();
        assert_eq!((b.to.stages, b.to.access), (S::DRAW_INDIRECT, A::INDIRECT_COMMAND_READ));
    }

    #[test]
    fn each_kind_of_read_waits_for_the_write_once() {
        let mut h = History::default();
        h.advance(Access::ComputeWrite, false);
        assert!(h.advance(Access::ComputeRead, false).is_some());
        assert!(h.advance(Access::FragmentRead, false).is_some(), "the second kind of read must see the write too");
        assert!(h.advance(Access::FragmentRead, false).is_none());
        let b = h.advance(Access::ComputeWrite, false).unwrap();
        assert!(b.from.stages.contains(S::FRAGMENT_SHADER | S::COMPUTE_SHADER), "the write waits for both reads");
    }

    #[test]
    fn a_changed_layout_waits_for_reads_and_keeps_the_write_visible() {
        let mut h = History::default();
        h.advance(Access::Color, true);
        h.advance(Access::FragmentSample, true);
        let b = h.advance(Access::CopyRead, true).unwrap();
        assert_eq!((b.from.layout, b.to.layout), (L::SHADER_READ_ONLY_OPTIMAL, L::TRANSFER_SRC_OPTIMAL));
        assert!(b.from.stages.contains(S::FRAGMENT_SHADER | S::COLOR_ATTACHMENT_OUTPUT));
        assert!(b.from.access.contains(A::COLOR_ATTACHMENT_WRITE));
    }

    #[test]
    fn a_second_kind_of_read_waits_for_the_change_of_layout() {
        let mut h = History::default();
        h.advance(Access::Color, true);
        h.advance(Access::FragmentSample, true);
        let b = h.advance(Access::ComputeSample, true).unwrap();
        assert_eq!(b.from.layout, b.to.layout);
        assert!(b.from.stages.contains(S::FRAGMENT_SHADER), "the change was made visible to the fragment stage alone");
    }

    #[test]
    fn a_first_use_of_an_image_gives_it_its_layout() {
        let mut h = History::default();
        let b = h.advance(Access::Color, true).unwrap();
        assert_eq!((b.from.layout, b.to.layout), (L::UNDEFINED, L::COLOR_ATTACHMENT_OPTIMAL));
        assert!(History::default().advance(Access::ComputeWrite, false).is_none(), "a fresh buffer waits for nothing");
    }

    #[test]
    fn a_window_s_image_is_drawn_anew_and_handed_over() {
        let anew = barrier(Access::None, Access::Color).unwrap();
        assert_eq!((anew.from.layout, anew.from.stages), (L::UNDEFINED, S::NONE));
        for (last, stages) in [(Access::Color, S::COLOR_ATTACHMENT_OUTPUT), (Access::CopyRead, S::ALL_TRANSFER)] {
            let b = barrier(last, Access::Present).unwrap();
            assert_eq!((b.from.stages, b.to.layout), (stages, L::PRESENT_SRC_KHR));
            assert_eq!((b.to.stages, b.to.access), (S::NONE, A::NONE), "the semaphore orders what follows");
        }
    }

    #[test]
    fn writes_after_writes_wait() {
        for write in [Access::ComputeWrite, Access::Color, Access::Depth, Access::CopyWrite, Access::StreamWrite] {
            assert!(barrier(write, write).is_some(), "{write:?}");
        }
    }
}
