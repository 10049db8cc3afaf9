//! The uniforms of several calls in one buffer.

use wgpu::{Buffer, BufferDescriptor, BufferSize, BufferUsages, Device, Queue};
use yoro::synthesis::Uniforms;

use crate::WgpuError;

/// So many calls can be recorded before the first of them is submitted: what is written for one is in place when the next
/// submission begins, and must not be overwritten before.
pub(crate) const CALLS: u64 = 64;

/// Bytes of one call's uniforms.
pub(crate) const SIZE: BufferSize =
    BufferSize::new(size_of::<Uniforms>() as u64).expect("the block has members");

/// A buffer whose places are used in turn.
pub(crate) struct UniformRing {
    pub(crate) buffer: Buffer,
    stride: u64,
    next: u64,
}

impl UniformRing {
    pub(crate) fn new(device: &Device) -> UniformRing {
        let alignment = u64::from(device.limits().min_uniform_buffer_offset_alignment);
        let stride = SIZE.get().next_multiple_of(alignment);
        let buffer = device.create_buffer(&BufferDescriptor {
            label: Some("yoro uniforms"),
            size: stride * CALLS,
            usage: BufferUsages::UNIFORM | BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        UniformRing { buffer, stride, next: 0 }
    }

    /// Writes the uniforms of a call, and returns their place in the buffer.
    pub(crate) fn write(&mut self, queue: &Queue, uniforms: &Uniforms) -> Result<u32, WgpuError> {
        let offset = self.next % CALLS * self.stride;
        let view = queue.write_buffer_with(&self.buffer, offset, SIZE);
        view.ok_or(WgpuError::DeviceLost)?.copy_from_slice(bytemuck::bytes_of(uniforms));
        self.next += 1;
        Ok(offset as u32)
    }
}
