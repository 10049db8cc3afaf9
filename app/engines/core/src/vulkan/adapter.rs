//! The limits and formats of the physical device.

use ash::vk;

use super::formats::{aspects, is_depth};
use super::{Host, Options, VulkanError};
use crate::synthesis::backend::check_size;
use crate::synthesis::{HoleMark, Holes};

/// A physical device and its properties.
pub(super) struct Adapter {
    instance: ash::Instance,
    physical_device: vk::PhysicalDevice,
    pub(super) properties: vk::PhysicalDeviceProperties,
}

impl Adapter {
    /// # Safety
    /// The host's instance and physical device belong together and outlive the adapter.
    pub(super) unsafe fn new(host: &Host) -> Adapter {
        let (instance, physical_device) = (host.instance.clone(), host.physical_device);
        // SAFETY: the caller's physical device belongs to the instance.
        let properties = unsafe { instance.get_physical_device_properties(physical_device) };
        Adapter { instance, physical_device, properties }
    }

    pub(super) fn memory(&self) -> vk::PhysicalDeviceMemoryProperties {
        // SAFETY: `Adapter::new` asks for a physical device of this instance.
        unsafe { self.instance.get_physical_device_memory_properties(self.physical_device) }
    }

    /// Returns the properties of a queue family, which must support graphics.
    pub(super) fn graphics_family(&self, index: u32) -> Result<vk::QueueFamilyProperties, VulkanError> {
        // SAFETY: `Adapter::new` asks for a physical device of this instance.
        let families =
            unsafe { self.instance.get_physical_device_queue_family_properties(self.physical_device) };
        let family = families.get(index as usize).copied();
        family
            .filter(|family| family.queue_flags.contains(vk::QueueFlags::GRAPHICS))
            .ok_or(VulkanError::QueueFamily(index))
    }

    /// Checks that the device can do what the options ask for.
    pub(super) fn check_options(&self, options: &Options) -> Result<(), VulkanError> {
        self.check_image_size("a largest source", options.max_source_size)?;
        self.check_image_size("a largest target", options.max_target_size)?;
        // Integer formats cannot be blended, so this excludes them.
        let blended = vk::FormatFeatureFlags::COLOR_ATTACHMENT_BLEND;
        self.check_format(options.color_format, blended, "a target's colour")?;
        if let Some(format) = options.depth_format {
            let attachment = vk::FormatFeatureFlags::DEPTH_STENCIL_ATTACHMENT;
            let role = "a target's depth";
            if !is_depth(format) {
                return Err(VulkanError::Format { format, role });
            }
            self.check_format(format, attachment, role)?;
        }
        check_holes(options)
    }

    pub(super) fn check_image_size(&self, what: &'static str, size: [u32; 2]) -> Result<(), VulkanError> {
        Ok(check_size(what, size, [self.properties.limits.max_image_dimension2_d; 2])?)
    }

    pub(super) fn check_format(
        &self,
        format: vk::Format,
        features: vk::FormatFeatureFlags,
        role: &'static str,
    ) -> Result<(), VulkanError> {
        // SAFETY: `Adapter::new` asks for a physical device of this instance.
        let properties =
            unsafe { self.instance.get_physical_device_format_properties(self.physical_device, format) };
        if properties.optimal_tiling_features.contains(features) {
            Ok(())
        } else {
            Err(VulkanError::Format { format, role })
        }
    }
}

/// Checks that open holes can be marked.
fn check_holes(options: &Options) -> Result<(), VulkanError> {
    let aspects = options.depth_format.map_or(vk::ImageAspectFlags::empty(), aspects);
    let refuse = |what| Err(VulkanError::Holes(what));
    match options.holes {
        Holes::Open(HoleMark::Stencil) if !aspects.contains(vk::ImageAspectFlags::STENCIL) => refuse(
            "the depth format has no stencil for the mark; choose D32_SFLOAT_S8_UINT or D24_UNORM_S8_UINT",
        ),
        Holes::Open(HoleMark::Depth) if aspects.is_empty() => {
            refuse("there is no depth for the mark; give a depth format")
        }
        _ => Ok(()),
    }
}
