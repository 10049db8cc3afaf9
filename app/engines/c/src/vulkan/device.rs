//! The part of a context that is specific to Vulkan.

use std::any::Any;
use std::ffi::{CStr, c_char};
use std::time::Duration;

use yoro::synthesis::backend::WarpKind;
use yoro::vulkan::ash::{Device, Instance, StaticFn, vk};
use yoro::vulkan::{AnyView, Composer, Gather, Host, Motion, PassTimes, Pipeline};

use super::types::{YoroVkInfo, check_format};
use crate::context::{Backend, YORO_API_VULKAN, YoroCapabilities, YoroTimes};
use crate::result::{Failure, YORO_ERROR_NO_CONTEXT, YORO_ERROR_NULL};
use crate::types::{Kind, other_kind, warp_kind};

/// The passes for one kind of warp.
pub(super) enum Passes {
    Eyes(Gather),
    Pose(AnyView),
    Motion(Motion),
}

impl Passes {
    /// Returns the pipeline, if it is for this kind of warp.
    pub(super) fn of<W: WarpKind + 'static>(&mut self) -> Result<&mut Pipeline<W>, Failure> {
        let (kind, pipeline): (Kind, &mut dyn Any) = match self {
            Passes::Eyes(gather) => (Kind::Gather, gather),
            Passes::Pose(any_view) => (Kind::AnyView, any_view),
            Passes::Motion(motion) => (Kind::Motion, motion),
        };
        pipeline.downcast_mut().ok_or_else(|| other_kind(kind))
    }
}

/// Calls a method that the passes of all kinds have.
macro_rules! of_passes {
    ($passes:expr, $method:ident($($argument:expr),*)) => {
        match $passes {
            Passes::Eyes(passes) => passes.$method($($argument),*),
            Passes::Pose(passes) => passes.$method($($argument),*),
            Passes::Motion(passes) => passes.$method($($argument),*),
        }
    };
}
pub(super) use of_passes;

/// The synthesis on a device.
pub(crate) struct Vulkan {
    pub(super) passes: Passes,
    pub(super) composer: Option<Composer>,
    pub(super) writes_depth: bool,
    instance: Instance,
    physical_device: vk::PhysicalDevice,
}

impl Vulkan {
    /// # Safety
    /// The handles are valid and belong together.
    pub(super) unsafe fn new(info: &YoroVkInfo) -> Result<Vulkan, Failure> {
        let null = |what: &str| Failure::new(YORO_ERROR_NULL, format!("{what} is NULL: give it"));
        let loader = info.loader.ok_or_else(|| null("loader"))?;
        let handles = [
            (info.instance == vk::Instance::null(), "instance"),
            (info.physical_device == vk::PhysicalDevice::null(), "physical_device"),
            (info.device == vk::Device::null(), "device"),
        ];
        if let Some((_, what)) = handles.into_iter().find(|(is_null, _)| *is_null) {
            return Err(null(what));
        }
        for (flag, what) in [(info.dynamic_rendering, "dynamic_rendering"), (info.composes, "composes")] {
            if flag > 1 {
                return Err(Failure::value(format!("{what} is {flag}: give 0 or 1")));
            }
        }
        check_format(info.color_format, "color_format")?;
        let writes_depth = info.depth_format != vk::Format::UNDEFINED;
        if writes_depth {
            check_format(info.depth_format, "depth_format")?;
        }
        // ash panics when a command that was not found is called. These commands lead to all others, or belong to the
        // oldest required version.
        let has = |name: &CStr| {
            // SAFETY: the header requires a live instance; the name ends with 0.
            unsafe { loader(info.instance, name.as_ptr()) }.is_some()
        };
        let needed = [
            c"vkGetDeviceProcAddr",
            c"vkGetPhysicalDeviceProperties",
            c"vkGetPhysicalDeviceProperties2",
            c"vkCreateImage",
            c"vkCmdDraw",
        ];
        if !needed.into_iter().all(has) {
            return Err(Failure::new(
                YORO_ERROR_NO_CONTEXT,
                "the loader does not return the commands of Vulkan 1.1: give vkGetInstanceProcAddr, and an instance of \
                 version 1.1 or later",
            ));
        }
        // The loader returns this command only if the extension is enabled.
        let debug_utils = has(c"vkCmdBeginDebugUtilsLabelEXT");
        // SAFETY: both types have the same signature, and "system" is C's calling convention on these platforms. the
        // header requires handles that belong together.
        let (instance, device) = unsafe {
            let get_instance_proc_addr = std::mem::transmute::<
                unsafe extern "C" fn(vk::Instance, *const c_char) -> Option<unsafe extern "C" fn()>,
                vk::PFN_vkGetInstanceProcAddr,
            >(loader);
            let instance = Instance::load(&StaticFn { get_instance_proc_addr }, info.instance);
            let device = Device::load(instance.fp_v1_0(), info.device);
            (instance, device)
        };
        let host = Host {
            instance: &instance,
            physical_device: info.physical_device,
            device: &device,
            queue_family: info.queue_family,
            dynamic_rendering: info.dynamic_rendering == 1,
            debug_utils,
        };
        let options = info.options()?;
        // SAFETY: the header requires handles that are valid, belong together, and outlive the context.
        let passes = unsafe {
            match warp_kind(info.warp_kind)? {
                Kind::AnyView => Passes::Pose(AnyView::new(&host, &options)?),
                Kind::Gather => Passes::Eyes(Gather::new(&host, &options)?),
                Kind::Motion => Passes::Motion(Motion::new(&host, &options)?),
            }
        };
        // SAFETY: as above.
        let composer = (info.composes == 1)
            .then(|| unsafe { Composer::new(&host, info.color_format, info.pipeline_cache) })
            .transpose()?;
        Ok(Vulkan { passes, composer, writes_depth, instance, physical_device: info.physical_device })
    }
}

impl From<PassTimes> for YoroTimes {
    fn from(times: PassTimes) -> YoroTimes {
        let nanoseconds = |time: Duration| time.as_nanos() as u64;
        YoroTimes {
            tiles_ns: nanoseconds(times.tiles),
            spans_ns: nanoseconds(times.spans),
            march_ns: nanoseconds(times.march),
            ..YoroTimes::UNKNOWN
        }
    }
}

impl Backend for Vulkan {
    fn times(&mut self) -> Result<Option<YoroTimes>, Failure> {
        // SAFETY: the header requires that the frame has been executed.
        let times = unsafe { of_passes!(&self.passes, pass_times()) }?;
        Ok(times.map(YoroTimes::from))
    }

    fn api(&self) -> &'static str {
        "Vulkan"
    }

    fn capabilities(&self) -> YoroCapabilities {
        // SAFETY: the header requires an instance that outlives the context.
        let properties = unsafe { self.instance.get_physical_device_properties(self.physical_device) };
        let mut capabilities = YoroCapabilities {
            struct_size: size_of::<YoroCapabilities>() as u32,
            api: YORO_API_VULKAN,
            api_major: vk::api_version_major(properties.api_version),
            api_minor: vk::api_version_minor(properties.api_version),
            software: (properties.device_type == vk::PhysicalDeviceType::CPU).into(),
            max_image_size: properties.limits.max_image_dimension2_d,
            buffer_bytes: of_passes!(&self.passes, buffer_bytes()),
            device: [0; 128],
        };
        if let Ok(name) = properties.device_name_as_c_str() {
            capabilities.set_device(&name.to_string_lossy());
        }
        capabilities
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_pass_has_its_own_time() {
        let [tiles, spans, march] = [1, 2, 3].map(Duration::from_nanos);
        let times = YoroTimes::from(PassTimes { tiles, spans, march });
        assert_eq!([times.tiles_ns, times.spans_ns, times.march_ns], [1, 2, 3]);
    }
}
