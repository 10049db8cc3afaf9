//! Image barriers between writers and readers.

use ash::vk;

use super::commands::Commands;
use super::formats::{aspects, range};
use super::{ImageState, LayerImage};

/// The largest number of barriers in a frame: two source images, two target images, and two intermediate images.
const MAX: usize = 6;

/// Barriers that are recorded with one command.
pub(super) struct Barriers {
    list: [vk::ImageMemoryBarrier<'static>; MAX],
    count: usize,
    before: vk::PipelineStageFlags,
    after: vk::PipelineStageFlags,
}

impl Barriers {
    pub(super) fn new() -> Barriers {
        let none = vk::PipelineStageFlags::empty();
        Barriers { list: Default::default(), count: 0, before: none, after: none }
    }

    /// Adds the barrier of an image that the caller registered.
    pub(super) fn registered(&mut self, image: &LayerImage, from: ImageState, to: ImageState) {
        self.add(image.image, range(aspects(image.format), image.layer), from, to);
    }

    /// Adds the barrier of an intermediate image.
    pub(super) fn intermediate(&mut self, image: vk::Image, from: ImageState, to: ImageState) {
        self.add(image, range(vk::ImageAspectFlags::COLOR, 0), from, to);
    }

    /// Adds a barrier unless the layout stays and nothing was or will be written.
    fn add(&mut self, image: vk::Image, range: vk::ImageSubresourceRange, from: ImageState, to: ImageState) {
        if from.layout == to.layout && !writes(from.access) && !writes(to.access) {
            return;
        }
        self.list[self.count] = vk::ImageMemoryBarrier::default()
            .src_access_mask(from.access)
            .dst_access_mask(to.access)
            .old_layout(from.layout)
            .new_layout(to.layout)
            .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .image(image)
            .subresource_range(range);
        self.count += 1;
        self.before |= from.stages;
        self.after |= to.stages;
    }

    pub(super) fn record(&self, commands: &Commands) {
        let (list, none) = (&self.list[..self.count], vk::DependencyFlags::empty());
        if !list.is_empty() {
            // Stage masks must not be empty here: the first stage waits for nothing, and nothing waits for the last
            // one.
            let or = |stages: vk::PipelineStageFlags, none| if stages.is_empty() { none } else { stages };
            let before = or(self.before, vk::PipelineStageFlags::TOP_OF_PIPE);
            let after = or(self.after, vk::PipelineStageFlags::BOTTOM_OF_PIPE);
            // SAFETY: `Commands::new` asks for a recording buffer and live images. `Pipeline::record` asks that the
            // images are in their states `before` when the commands are executed.
            unsafe {
                commands.device.cmd_pipeline_barrier(commands.buffer, before, after, none, &[], &[], list);
            }
        }
    }
}

fn writes(access: vk::AccessFlags) -> bool {
    access.intersects(
        vk::AccessFlags::SHADER_WRITE
            | vk::AccessFlags::COLOR_ATTACHMENT_WRITE
            | vk::AccessFlags::DEPTH_STENCIL_ATTACHMENT_WRITE
            | vk::AccessFlags::TRANSFER_WRITE
            | vk::AccessFlags::HOST_WRITE
            | vk::AccessFlags::MEMORY_WRITE,
    )
}
