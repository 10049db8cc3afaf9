//! The uniform blocks of several calls in one buffer.

use std::marker::PhantomData;

use bytemuck::NoUninit;
use wgpu::{
    BindingResource, Buffer, BufferBinding, BufferDescriptor, BufferSize, BufferUsages, Device, Queue,
};

use crate::WgpuError;

/// The number of calls that can be recorded before the first of them is submitted. The block of a call is written when
/// the next submission begins, and must not be overwritten before.
pub(crate) const CALLS: u64 = 64;

/// Returns the size of a block in bytes.
pub(crate) const fn size<T>() -> BufferSize {
    BufferSize::new(size_of::<T>() as u64).expect("the block has members")
}

/// A buffer of blocks that are used in turn.
pub(crate) struct UniformRing<T> {
    buffer: Buffer,
    stride: u64,
    next: u64,
    block: PhantomData<T>,
}

impl<T: NoUninit> UniformRing<T> {
    pub(crate) fn new(device: &Device, label: &'static str) -> UniformRing<T> {
        let alignment = u64::from(device.limits().min_uniform_buffer_offset_alignment);
        let stride = size::<T>().get().next_multiple_of(alignment);
        let buffer = device.create_buffer(&BufferDescriptor {
            label: Some(label),
            size: stride * CALLS,
            usage: BufferUsages::UNIFORM | BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        UniformRing { buffer, stride, next: 0, block: PhantomData }
    }

    /// Writes the block of a call, and returns its offset in the buffer.
    pub(crate) fn write(&mut self, queue: &Queue, block: &T) -> Result<u32, WgpuError> {
        let offset = self.next % CALLS * self.stride;
        let view = queue.write_buffer_with(&self.buffer, offset, size::<T>());
        view.ok_or(WgpuError::DeviceLost)?.copy_from_slice(bytemuck::bytes_of(block));
        self.next += 1;
        Ok(offset as u32)
    }

    /// Returns the binding of a block, for a dynamic offset.
    pub(crate) fn binding(&self) -> BindingResource<'_> {
        let buffer = &self.buffer;
        BindingResource::Buffer(BufferBinding { buffer, offset: 0, size: Some(size::<T>()) })
    }
}
