//! GPU times of the passes.

use std::time::Duration;

use ash::vk;

use super::commands::Commands;
use super::objects::Objects;
use super::{PassTimes, VulkanError};

/// The timestamps of a frame, in the order of their recording.
#[derive(Clone, Copy)]
pub(super) enum Stamp {
    Begin,
    Tiles,
    Spans,
    March,
}

const STAMPS: u32 = Stamp::March as u32 + 1;

/// A ring of timestamps, in which each frame replaces the one that was recorded `frames` frames ago.
pub(super) struct Timer {
    pool: vk::QueryPool,
    frames: u32,
    recorded: u64,
    /// Nanoseconds per tick.
    period: f64,
    /// The valid bits of a timestamp.
    mask: u64,
}

impl Timer {
    /// Returns a timer, or `None` if `frames` is 0 or the queue family has no timestamps.
    pub(super) fn new(
        objects: &mut Objects,
        frames: u32,
        family: &vk::QueueFamilyProperties,
        limits: &vk::PhysicalDeviceLimits,
    ) -> Result<Option<Timer>, VulkanError> {
        if frames == 0 || family.timestamp_valid_bits == 0 {
            return Ok(None);
        }
        let info = vk::QueryPoolCreateInfo::default()
            .query_type(vk::QueryType::TIMESTAMP)
            .query_count(frames.saturating_mul(STAMPS));
        let pool = objects.create_query_pool(&info)?;
        let mask = u64::MAX >> (64 - family.timestamp_valid_bits.min(64));
        let period = f64::from(limits.timestamp_period);
        Ok(Some(Timer { pool, frames, recorded: 0, period, mask }))
    }

    fn first_query(&self) -> u32 {
        (self.recorded % u64::from(self.frames)) as u32 * STAMPS
    }

    /// Begins a frame, outside of render passes.
    pub(super) fn begin(&self, commands: &Commands) {
        // SAFETY: `Commands::new` asks for a recording buffer outside of render passes; the queries are in the pool.
        unsafe {
            commands.device.cmd_reset_query_pool(commands.buffer, self.pool, self.first_query(), STAMPS);
        }
        self.stamp(commands, Stamp::Begin);
    }

    /// Takes the time when everything recorded before has finished, so that earlier work does not count as the pass's.
    pub(super) fn stamp(&self, commands: &Commands, stamp: Stamp) {
        let (stage, query) = (vk::PipelineStageFlags::BOTTOM_OF_PIPE, self.first_query() + stamp as u32);
        // SAFETY: `Commands::new` asks for a recording buffer; the query is in the pool and `begin` has reset it.
        unsafe { commands.device.cmd_write_timestamp(commands.buffer, stage, self.pool, query) };
    }

    /// Ends a frame.
    pub(super) fn end(&mut self) {
        self.recorded += 1;
    }

    /// Returns the times of the frame whose place the next frame takes; `None` before there is one.
    ///
    /// # Safety
    /// The commands of that frame have been executed on `device`.
    pub(super) unsafe fn times(&self, device: &ash::Device) -> Result<Option<PassTimes>, VulkanError> {
        if self.recorded < self.frames.into() {
            return Ok(None);
        }
        let mut stamps = [0u64; STAMPS as usize];
        let flags = vk::QueryResultFlags::TYPE_64;
        // SAFETY: there are as many results as queries, and executed commands have written these.
        match unsafe { device.get_query_pool_results(self.pool, self.first_query(), &mut stamps, flags) } {
            Ok(()) => {}
            Err(vk::Result::NOT_READY) => return Ok(None),
            Err(result) => return Err(VulkanError::new("vkGetQueryPoolResults", result)),
        }
        let time = |end: Stamp| {
            let end = end as usize;
            let ticks = stamps[end].wrapping_sub(stamps[end - 1]) & self.mask;
            Duration::from_nanos((ticks as f64 * self.period) as u64)
        };
        Ok(Some(PassTimes {
            tiles: time(Stamp::Tiles),
            spans: time(Stamp::Spans),
            march: time(Stamp::March),
        }))
    }
}
