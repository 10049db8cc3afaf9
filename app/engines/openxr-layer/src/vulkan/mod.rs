//! Synthesis on the application's Vulkan device and queue.

use std::ffi::c_void;
use std::sync::OnceLock;
use std::time::Duration;

use ash::vk;
use ash::vk::Handle as _;
use openxr_sys as sys;
use yoro::vulkan::{
    Frame, Gather, Host, ImageState, LayerImage, Options, SourceId, SourceImages, TargetId, TargetImages,
};

use crate::reason::Reason;
use crate::synthesizer::{self, Image, Job, TIMEOUT};

/// The number of frames whose commands may be pending at once.
const FRAMES: usize = 3;

/// The device and the queue of a session.
#[derive(Clone, Copy)]
pub struct Binding {
    instance: vk::Instance,
    physical_device: vk::PhysicalDevice,
    device: vk::Device,
    queue_family: u32,
    queue: u32,
}

impl Binding {
    /// Returns the device and the queue that a graphics binding names.
    pub fn new(binding: &sys::GraphicsBindingVulkanKHR) -> Binding {
        let raw = |handle: *const c_void| handle as u64;
        Binding {
            instance: vk::Instance::from_raw(raw(binding.instance)),
            physical_device: vk::PhysicalDevice::from_raw(raw(binding.physical_device)),
            device: vk::Device::from_raw(raw(binding.device)),
            queue_family: binding.queue_family_index,
            queue: binding.queue_index,
        }
    }
}

/// Command buffers and a pipeline, for one session.
pub struct Synthesizer {
    // Declared before the other objects of the device, because it must be dropped first.
    pipeline: Option<(Gather, Options)>,
    sources: Vec<([Image; 2], SourceId)>,
    targets: Vec<([Option<Image>; 2], TargetId)>,
    instance: ash::Instance,
    device: ash::Device,
    binding: Binding,
    queue: vk::Queue,
    pool: vk::CommandPool,
    slots: [Slot; FRAMES],
    frame: usize,
}

#[derive(Clone, Copy, Default)]
struct Slot {
    commands: vk::CommandBuffer,
    /// Signalled when `commands` is not pending.
    fence: vk::Fence,
}

/// Returns Vulkan's loader, which the application has loaded as well.
fn entry() -> Option<&'static ash::Entry> {
    static ENTRY: OnceLock<Option<ash::Entry>> = OnceLock::new();
    // SAFETY: the system's library, which is never unloaded.
    ENTRY.get_or_init(|| unsafe { ash::Entry::load().ok() }).as_ref()
}

impl Synthesizer {
    /// Creates command buffers on the device.
    ///
    /// # Safety
    /// The binding's handles are valid until this is dropped.
    pub unsafe fn new(binding: Binding) -> Result<Synthesizer, Reason> {
        let entry = entry().ok_or(Reason::NoLibrary("Vulkan's loader"))?;
        // SAFETY: handles of the application's session.
        let (instance, device) = unsafe {
            let instance = ash::Instance::load(entry.static_fn(), binding.instance);
            let device = ash::Device::load(instance.fp_v1_0(), binding.device);
            (instance, device)
        };
        // SAFETY: all objects belong to this device.
        unsafe {
            let queue = device.get_device_queue(binding.queue_family, binding.queue);
            let info = vk::CommandPoolCreateInfo::default()
                .flags(vk::CommandPoolCreateFlags::RESET_COMMAND_BUFFER)
                .queue_family_index(binding.queue_family);
            let pool = device.create_command_pool(&info, None).map_err(Reason::Vulkan)?;
            // From here on, dropping the synthesizer destroys what was created.
            let mut synthesizer = Synthesizer {
                pipeline: None,
                sources: Vec::new(),
                targets: Vec::new(),
                instance,
                device,
                binding,
                queue,
                pool,
                slots: [Slot::default(); FRAMES],
                frame: 0,
            };
            let device = &synthesizer.device;
            let info = vk::CommandBufferAllocateInfo::default()
                .command_pool(pool)
                .command_buffer_count(FRAMES as u32);
            let commands = device.allocate_command_buffers(&info).map_err(Reason::Vulkan)?;
            let signalled = vk::FenceCreateInfo::default().flags(vk::FenceCreateFlags::SIGNALED);
            for (slot, commands) in synthesizer.slots.iter_mut().zip(commands) {
                *slot =
                    Slot { commands, fence: device.create_fence(&signalled, None).map_err(Reason::Vulkan)? };
            }
            Ok(synthesizer)
        }
    }

    /// Creates a pipeline for the formats and sizes of a job, unless the existing one fits.
    unsafe fn make_pipeline(&mut self, job: &Job) -> Result<(), Reason> {
        let [source, target] = [job.color.size, job.target.size];
        let fits = |limit: [u32; 2], size: [u32; 2]| limit[0] >= size[0] && limit[1] >= size[1];
        if let Some((_, options)) = &self.pipeline
            && options.color_format == vk_format(job.target)
            && options.depth_format == job.target_depth.map(vk_format)
            && fits(options.max_source_size, source)
            && fits(options.max_target_size, target)
        {
            return Ok(());
        }
        self.wait_for_all();
        self.pipeline = None;
        self.sources.clear();
        self.targets.clear();
        let options = Options {
            color_format: vk_format(job.target),
            depth_format: job.target_depth.map(vk_format),
            max_source_size: source,
            max_target_size: target,
            timed_frames: FRAMES as u32 + 1,
            ..Options::default()
        };
        let host = Host {
            instance: &self.instance,
            physical_device: self.binding.physical_device,
            device: &self.device,
            queue_family: self.binding.queue_family,
            // The layer does not know whether the application has enabled them.
            dynamic_rendering: false,
            debug_utils: false,
        };
        // SAFETY: the handles are valid until this is dropped, which waits for its commands.
        let pipeline = unsafe { Gather::new(&host, &options).map_err(Reason::Synthesis)? };
        self.pipeline = Some((pipeline, options));
        Ok(())
    }

    unsafe fn source(&mut self, job: &Job) -> Result<SourceId, Reason> {
        let key = [job.color, job.depth];
        if let Some((_, id)) = self.sources.iter().find(|(source, _)| *source == key) {
            return Ok(*id);
        }
        let pipeline = made(&mut self.pipeline)?;
        let color = layer_image(job.color, ImageState::COLOR_ATTACHMENT, ImageState::COLOR_ATTACHMENT);
        let depth = layer_image(job.depth, ImageState::DEPTH_ATTACHMENT, ImageState::DEPTH_ATTACHMENT);
        let images = SourceImages::new(color, depth, job.color.size);
        // SAFETY: live images, which are forgotten before they are destroyed.
        let id = unsafe { pipeline.register_source(&images) }.map_err(Reason::Synthesis)?;
        self.sources.push((key, id));
        Ok(id)
    }

    unsafe fn target(&mut self, job: &Job) -> Result<TargetId, Reason> {
        let key = [Some(job.target), job.target_depth];
        if let Some((_, id)) = self.targets.iter().find(|(known, _)| *known == key) {
            return Ok(*id);
        }
        let pipeline = made(&mut self.pipeline)?;
        // SAFETY: live images, which are forgotten before they are destroyed.
        let id = unsafe {
            pipeline.register_target(&TargetImages {
                color: layer_image(job.target, ImageState::DISCARDED, ImageState::COLOR_ATTACHMENT),
                depth: job
                    .target_depth
                    .map(|depth| layer_image(depth, ImageState::DISCARDED, ImageState::DEPTH_ATTACHMENT)),
                size: [0, 1].map(|i| {
                    job.target_depth.map_or(u32::MAX, |depth| depth.size[i]).min(job.target.size[i])
                }),
            })
        };
        let id = id.map_err(Reason::Synthesis)?;
        self.targets.push((key, id));
        Ok(id)
    }

    unsafe fn wait_for(&self, slot: Slot) -> Result<(), Reason> {
        // SAFETY: this device's fence.
        let waited = unsafe { self.device.wait_for_fences(&[slot.fence], true, TIMEOUT.as_nanos() as u64) };
        match waited {
            Err(vk::Result::TIMEOUT) => Err(Reason::Late),
            result => result.map_err(Reason::Vulkan),
        }
    }

    unsafe fn begin(&self, slot: Slot) -> Result<(), Reason> {
        let info = vk::CommandBufferBeginInfo::default().flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
        // SAFETY: commands of this device that are not pending. An error may have left them being recorded.
        unsafe {
            let device = &self.device;
            device
                .reset_command_buffer(slot.commands, vk::CommandBufferResetFlags::empty())
                .and_then(|()| device.begin_command_buffer(slot.commands, &info))
                .map_err(Reason::Vulkan)
        }
    }

    unsafe fn submit(&mut self, slot: Slot) -> Result<(), Reason> {
        let commands = [slot.commands];
        let submits = [vk::SubmitInfo::default().command_buffers(&commands)];
        // SAFETY: recorded commands of this device, and a fence that nothing is waiting for.
        unsafe {
            self.device.reset_fences(&[slot.fence]).map_err(Reason::Vulkan)?;
            if let Err(error) = self.device.queue_submit(self.queue, &submits, slot.fence) {
                self.renew_fence();
                return Err(Reason::Vulkan(error));
            }
        }
        self.frame += 1;
        Ok(())
    }

    /// Replaces the fence of commands that could not be submitted, since they will never signal it.
    unsafe fn renew_fence(&mut self) {
        let slot = &mut self.slots[self.frame % FRAMES];
        let signalled = vk::FenceCreateInfo::default().flags(vk::FenceCreateFlags::SIGNALED);
        // SAFETY: this device's fence, which nothing is waiting for.
        unsafe {
            if let Ok(fence) = self.device.create_fence(&signalled, None) {
                self.device.destroy_fence(slot.fence, None);
                slot.fence = fence;
            }
        }
    }

    fn wait_for_all(&self) {
        for slot in self.slots.iter().filter(|slot| !slot.fence.is_null()) {
            // SAFETY: this device's fence. Errors are ignored, since waiting for a lost or hanging device is pointless.
            unsafe {
                self.device
                    .wait_for_fences(&[slot.fence], true, Duration::from_secs(5).as_nanos() as u64)
                    .ok()
            };
        }
    }
}

impl synthesizer::Synthesizer for Synthesizer {
    unsafe fn synthesize(&mut self, job: &Job) -> Result<Option<Duration>, Reason> {
        let slot = self.slots[self.frame % FRAMES];
        // SAFETY: commands and images are this device's, and the slot's commands are not pending.
        unsafe {
            self.wait_for(slot)?;
            self.make_pipeline(job)?;
            let (source, target) = (self.source(job)?, self.target(job)?);
            self.begin(slot)?;
            let pipeline = made(&mut self.pipeline)?;
            let frame = Frame { source_origin: job.source.origin, ..Frame::new(source, target) };
            pipeline.record(slot.commands, &frame, job.warp).map_err(Reason::Synthesis)?;
            self.device.end_command_buffer(slot.commands).map_err(Reason::Vulkan)?;
            self.submit(slot)?;
            // An error here only means that no times are known.
            let times = made(&mut self.pipeline)?.pass_times().ok().flatten();
            Ok(times.map(|times| times.tiles + times.spans + times.march))
        }
    }

    fn forget(&mut self, images: &[u64]) {
        let uses = |image: &Image| images.contains(&image.image);
        if !self.sources.iter().any(|(source, _)| source.iter().any(uses))
            && !self.targets.iter().any(|(target, _)| target.iter().flatten().any(uses))
        {
            return;
        }
        self.wait_for_all();
        let Some((pipeline, _)) = &mut self.pipeline else { return };
        self.sources.retain(|(source, id)| {
            let keep = !source.iter().any(uses);
            if !keep {
                // SAFETY: no command is pending.
                unsafe { pipeline.release_source(*id) };
            }
            keep
        });
        self.targets.retain(|(target, id)| {
            let keep = !target.iter().flatten().any(uses);
            if !keep {
                // SAFETY: no command is pending.
                unsafe { pipeline.release_target(*id) };
            }
            keep
        });
    }
}

/// Returns the pipeline, which must have been created.
fn made(made: &mut Option<(Gather, Options)>) -> Result<&mut Gather, Reason> {
    made.as_mut().map(|(pipeline, _)| pipeline).ok_or(Reason::Panic)
}

fn vk_image(image: Image) -> vk::Image {
    vk::Image::from_raw(image.image)
}

fn vk_format(image: Image) -> vk::Format {
    vk::Format::from_raw(image.format as i32)
}

fn layer_image(image: Image, before: ImageState, after: ImageState) -> LayerImage {
    LayerImage { image: vk_image(image), format: vk_format(image), layer: image.layer, before, after }
}

impl Drop for Synthesizer {
    fn drop(&mut self) {
        self.wait_for_all();
        self.pipeline = None;
        // SAFETY: this device's objects, which no command uses.
        unsafe {
            for slot in &self.slots {
                self.device.destroy_fence(slot.fence, None);
            }
            self.device.destroy_command_pool(self.pool, None);
        }
    }
}
