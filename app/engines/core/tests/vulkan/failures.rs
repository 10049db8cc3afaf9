//! Failing Vulkan commands: memory runs out, the device is lost.

use std::ffi::{CStr, c_void};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicI32, AtomicUsize, Ordering};

use yoro::synthesis::backend::WarpKind as _;
use yoro::vulkan::ash::{self, vk};
use yoro::vulkan::{Frame, Gather, Host, ImageState, Options, SourceImages, TargetImages, VulkanError};

use super::harness::{Gpu, Image, Rendering, with_gpu};
use super::{Setup, options, warps};

/// The device's own commands.
static REAL: OnceLock<ash::Device> = OnceLock::new();
/// The number of calls that succeed before one fails.
static LEFT: AtomicUsize = AtomicUsize::new(usize::MAX);
/// The error of the failing call.
static FAILURE: AtomicI32 = AtomicI32::new(0);

/// True if this call is the one that fails.
fn fails() -> bool {
    LEFT.fetch_update(Ordering::SeqCst, Ordering::SeqCst, |left| left.checked_sub(1)).is_err()
}

/// Replaces all commands that the pipeline calls and that can fail.
macro_rules! failing {
    ($($command:literal $field:ident($($argument:ident: $ty:ty),*);)*) => {
        mod commands {
            use super::*;

            $(pub unsafe extern "system" fn $field($($argument: $ty),*) -> vk::Result {
                if fails() {
                    // Only one call fails per run.
                    LEFT.store(usize::MAX, Ordering::SeqCst);
                    return vk::Result::from_raw(FAILURE.swap(0, Ordering::SeqCst));
                }
                // SAFETY: the arguments are passed on unchanged to the device's own command.
                unsafe { (REAL.get().unwrap().fp_v1_0().$field)($($argument),*) }
            })*
        }

        fn command(name: &CStr) -> Option<*const c_void> {
            $(if name == $command {
                return Some(commands::$field as *const c_void);
            })*
            None
        }
    };
}

type Callbacks<'a> = *const vk::AllocationCallbacks<'a>;

failing! {
    c"vkAllocateDescriptorSets" allocate_descriptor_sets(
        device: vk::Device, info: *const vk::DescriptorSetAllocateInfo<'_>, sets: *mut vk::DescriptorSet
    );
    c"vkAllocateMemory" allocate_memory(
        device: vk::Device, info: *const vk::MemoryAllocateInfo<'_>, a: Callbacks<'_>, made: *mut vk::DeviceMemory
    );
    c"vkBindImageMemory" bind_image_memory(
        device: vk::Device, image: vk::Image, memory: vk::DeviceMemory, offset: vk::DeviceSize
    );
    c"vkCreateDescriptorPool" create_descriptor_pool(
        device: vk::Device, info: *const vk::DescriptorPoolCreateInfo<'_>, a: Callbacks<'_>,
        made: *mut vk::DescriptorPool
    );
    c"vkCreateDescriptorSetLayout" create_descriptor_set_layout(
        device: vk::Device, info: *const vk::DescriptorSetLayoutCreateInfo<'_>, a: Callbacks<'_>,
        made: *mut vk::DescriptorSetLayout
    );
    c"vkCreateFramebuffer" create_framebuffer(
        device: vk::Device, info: *const vk::FramebufferCreateInfo<'_>, a: Callbacks<'_>, made: *mut vk::Framebuffer
    );
    c"vkCreateGraphicsPipelines" create_graphics_pipelines(
        device: vk::Device, cache: vk::PipelineCache, count: u32, infos: *const vk::GraphicsPipelineCreateInfo<'_>,
        a: Callbacks<'_>, made: *mut vk::Pipeline
    );
    c"vkCreateImage" create_image(
        device: vk::Device, info: *const vk::ImageCreateInfo<'_>, a: Callbacks<'_>, made: *mut vk::Image
    );
    c"vkCreateImageView" create_image_view(
        device: vk::Device, info: *const vk::ImageViewCreateInfo<'_>, a: Callbacks<'_>, made: *mut vk::ImageView
    );
    c"vkCreatePipelineLayout" create_pipeline_layout(
        device: vk::Device, info: *const vk::PipelineLayoutCreateInfo<'_>, a: Callbacks<'_>,
        made: *mut vk::PipelineLayout
    );
    c"vkCreateQueryPool" create_query_pool(
        device: vk::Device, info: *const vk::QueryPoolCreateInfo<'_>, a: Callbacks<'_>, made: *mut vk::QueryPool
    );
    c"vkCreateRenderPass" create_render_pass(
        device: vk::Device, info: *const vk::RenderPassCreateInfo<'_>, a: Callbacks<'_>, made: *mut vk::RenderPass
    );
    c"vkCreateSampler" create_sampler(
        device: vk::Device, info: *const vk::SamplerCreateInfo<'_>, a: Callbacks<'_>, made: *mut vk::Sampler
    );
    c"vkCreateShaderModule" create_shader_module(
        device: vk::Device, info: *const vk::ShaderModuleCreateInfo<'_>, a: Callbacks<'_>,
        made: *mut vk::ShaderModule
    );
    c"vkGetQueryPoolResults" get_query_pool_results(
        device: vk::Device, pool: vk::QueryPool, first: u32, count: u32, size: usize, data: *mut c_void,
        stride: vk::DeviceSize, flags: vk::QueryResultFlags
    );
}

/// Calls everything that calls Vulkan, once.
fn everything(gpu: &Gpu, host: &Host) -> Result<(), VulkanError> {
    let (warp, setup) = (warps()[0].0, Setup::PLAIN);
    let color = gpu.image(setup.color, warp.source_size, 1);
    let depth = gpu.image(vk::Format::D32_SFLOAT, warp.source_size, 1);
    let target = gpu.image(setup.target, warp.target_size, 1);
    let (before, after) = (ImageState::DISCARDED, ImageState::SAMPLED);
    let options = Options { timed_frames: 1, ..options(&setup, warp.sizes()) };
    // SAFETY: the handles are valid, and all commands are executed before the pipeline is dropped.
    unsafe {
        let mut gather = Gather::new(host, &options)?;
        let layer = |image: &Image| image.layer(0, before, after);
        let source = SourceImages::new(layer(&color), layer(&depth), warp.source_size);
        let source = gather.register_source(&source)?;
        let target = gather.register_target(&TargetImages::new(layer(&target), warp.target_size))?;
        let frame = Frame::new(source, target);
        gpu.run(|commands| gather.record(commands, &frame, &warp))?;
        gather.pass_times()?;
    }
    Ok(())
}

/// Each call of each command fails once with each error. The error is returned, and no object is left: the validation
/// layer would report it when the device is destroyed.
#[test]
fn every_failure_comes_back_as_an_error() {
    with_gpu(Rendering::RenderPasses, |gpu| {
        let real = REAL.get_or_init(|| gpu.device.clone());
        let host = gpu.host();
        // SAFETY: the device's own commands, or such as call them.
        let device = unsafe {
            let load = |name: &CStr| {
                let own = host.instance.get_device_proc_addr(real.handle(), name.as_ptr());
                command(name).unwrap_or(own.map_or(std::ptr::null(), |own| own as *const c_void))
            };
            ash::Device::load_with(load, real.handle())
        };
        let host = Host { device: &device, ..host };
        for failure in [
            vk::Result::ERROR_OUT_OF_DEVICE_MEMORY,
            vk::Result::ERROR_OUT_OF_HOST_MEMORY,
            vk::Result::ERROR_DEVICE_LOST,
        ] {
            let mut calls = 0;
            loop {
                FAILURE.store(failure.as_raw(), Ordering::SeqCst);
                LEFT.store(calls, Ordering::SeqCst);
                let result = everything(gpu, &host);
                LEFT.store(usize::MAX, Ordering::SeqCst);
                if FAILURE.load(Ordering::SeqCst) != 0 {
                    assert_eq!(result, Ok(()));
                    break;
                }
                let error = result.expect_err("a call has failed");
                match (error, failure) {
                    (VulkanError::OutOfMemory { result, .. }, _) => assert_eq!(result, failure),
                    (VulkanError::DeviceLost { .. }, vk::Result::ERROR_DEVICE_LOST) => {}
                    _ => panic!("call {calls}: {error} for {failure:?}"),
                }
                calls += 1;
            }
            assert!(calls > 30, "only {calls} calls can fail");
        }
    });
}

/// The instance's own commands.
static INSTANCE: OnceLock<ash::Instance> = OnceLock::new();

/// Returns the properties of a device without D24S8, like many devices.
unsafe extern "system" fn properties_without_d24s8(
    physical_device: vk::PhysicalDevice,
    format: vk::Format,
    properties: *mut vk::FormatProperties,
) {
    let real = INSTANCE.get().unwrap().fp_v1_0().get_physical_device_format_properties;
    // SAFETY: the arguments are passed on unchanged, or the one structure is written that the signature names.
    unsafe {
        match format {
            vk::Format::D24_UNORM_S8_UINT => *properties = vk::FormatProperties::default(),
            _ => real(physical_device, format, properties),
        }
    }
}

#[test]
fn a_format_that_the_device_lacks_is_refused() {
    with_gpu(Rendering::RenderPasses, |gpu| {
        INSTANCE.get_or_init(|| gpu.instance_with(|_| None));
        let instance = gpu.instance_with(|name| {
            (name == c"vkGetPhysicalDeviceFormatProperties")
                .then_some(properties_without_d24s8 as *const c_void)
        });
        let host = Host { instance: &instance, ..gpu.host() };
        let (warp, setup) = (warps()[0].0, Setup::PLAIN);
        let color = gpu.image(setup.color, warp.source_size, 1);
        let depth = gpu.image(vk::Format::D32_SFLOAT, warp.source_size, 1);
        let sampled = ImageState::SAMPLED;
        let lacking = |role| VulkanError::Format { format: vk::Format::D24_UNORM_S8_UINT, role };
        // SAFETY: valid handles; nothing is made of the format that is refused.
        unsafe {
            let options = options(&setup, warp.sizes());
            let with_depth = Options { depth_format: Some(vk::Format::D24_UNORM_S8_UINT), ..options };
            assert_eq!(Gather::new(&host, &with_depth).err(), Some(lacking("a target's depth")));
            let mut gather = Gather::new(&host, &options).unwrap();
            let [color, depth] = [&color, &depth].map(|image| image.layer(0, sampled, sampled));
            let mut source = SourceImages::new(color, depth, warp.source_size);
            gather.register_source(&source).unwrap();
            source.depth.format = vk::Format::D24_UNORM_S8_UINT;
            assert_eq!(gather.register_source(&source), Err(lacking("a source's depth")));
        }
    });
}
