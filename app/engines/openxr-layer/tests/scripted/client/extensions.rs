//! Calls to functions of extensions.

use std::ffi::{CStr, c_void};
use std::ptr;

use openxr_sys as sys;
use sys::{Handle as _, ViewConfigurationType as ViewsOf, pfn};
use yoro::vulkan::ash::vk;

use super::{Chain, Client, Frame, Outcome, Submitted, check};

impl Client<'_> {
    /// Returns the near and far planes that the runtime recommends in structures chained to the configuration's views.
    pub fn chained_depth_ranges(&self, count: usize) -> Outcome<Vec<[f32; 2]>> {
        self.chained_to_sizes(count, depth_range(), planes)
    }

    /// Returns the left and right angles that are recommended in structures chained to the configuration's views.
    pub fn chained_fields_of_view(&self, count: usize) -> Outcome<Vec<[f32; 2]>> {
        let ty = sys::ViewConfigurationViewFovEPIC::TYPE;
        // SAFETY: plain data.
        let empty = sys::ViewConfigurationViewFovEPIC { ty, ..unsafe { std::mem::zeroed() } };
        self.chained_to_sizes(count, empty, |fov| {
            [fov.recommended_fov.angle_left, fov.recommended_fov.angle_right]
        })
    }

    /// Returns what the runtime writes to structures chained to the configuration's views.
    fn chained_to_sizes<T: Clone>(
        &self,
        count: usize,
        empty: T,
        read: fn(&T) -> [f32; 2],
    ) -> Outcome<Vec<[f32; 2]>> {
        let view = |next| sys::ViewConfigurationView {
            ty: sys::ViewConfigurationView::TYPE,
            next,
            // SAFETY: plain data.
            ..unsafe { std::mem::zeroed() }
        };
        chained(count, empty, read, view, |views| {
            let (mut number, room) = (0, count as u32);
            let call = self.xr.enumerate_view_configuration_views;
            let place = views.as_mut_ptr();
            // SAFETY: room for as many elements as stated.
            let result = unsafe { call(self.instance, self.system, self.views, room, &mut number, place) };
            check("xrEnumerateViewConfigurationViews", result).map(drop)
        })
    }

    /// Returns what the runtime writes to structures chained to the located views.
    pub fn chained_to_located(&self, frame: Frame, count: usize) -> Outcome<Vec<[f32; 2]>> {
        // SAFETY: plain data.
        let view = |next| sys::View { ty: sys::View::TYPE, next, ..unsafe { std::mem::zeroed() } };
        chained(count, depth_range(), planes, view, |views| self.locate_views(frame, views).map(drop))
    }

    /// Returns the reprojection modes of a view configuration.
    pub fn reprojection_modes(&self, views: ViewsOf) -> Outcome<Vec<sys::ReprojectionModeMSFT>> {
        let (mut modes, mut count) = ([sys::ReprojectionModeMSFT::DEPTH; 4], 0);
        let name = c"xrEnumerateReprojectionModesMSFT";
        // SAFETY: a function of this name has this type, and there is room for as many elements as stated.
        let result = unsafe {
            let ask: pfn::EnumerateReprojectionModesMSFT = std::mem::transmute(self.function(name));
            ask(self.instance, self.system, views, 4, &mut count, modes.as_mut_ptr())
        };
        check("xrEnumerateReprojectionModesMSFT", result)?;
        Ok(modes[..count as usize].to_vec())
    }

    /// Returns the size that the runtime recommends for a projection layer of one view.
    pub fn recommended_layer_size(&self, frame: Frame, submitted: Submitted) -> Outcome<[i32; 2]> {
        let view = sys::CompositionLayerProjectionView {
            ty: sys::CompositionLayerProjectionView::TYPE,
            next: ptr::null(),
            pose: submitted.view.raw.0,
            fov: submitted.view.raw.1,
            sub_image: submitted.color.raw(),
        };
        let layer = sys::CompositionLayerProjection {
            ty: sys::CompositionLayerProjection::TYPE,
            next: ptr::null(),
            layer_flags: sys::CompositionLayerFlags::EMPTY,
            space: self.space,
            view_count: 1,
            views: &view,
        };
        let info = sys::RecommendedLayerResolutionGetInfoMETA {
            ty: sys::RecommendedLayerResolutionGetInfoMETA::TYPE,
            next: ptr::null(),
            layer: (&raw const layer).cast(),
            predicted_display_time: frame.time,
        };
        let mut size = sys::RecommendedLayerResolutionMETA {
            ty: sys::RecommendedLayerResolutionMETA::TYPE,
            next: ptr::null_mut(),
            recommended_image_dimensions: sys::Extent2Di { width: 0, height: 0 },
            is_valid: sys::FALSE,
        };
        // SAFETY: a function of this name has this type; complete structures.
        let result = unsafe {
            let ask: pfn::GetRecommendedLayerResolutionMETA =
                std::mem::transmute(self.function(c"xrGetRecommendedLayerResolutionMETA"));
            ask(self.session, &info, &mut size)
        };
        check("xrGetRecommendedLayerResolutionMETA", result)?;
        assert_eq!(size.is_valid, sys::TRUE);
        Ok([size.recommended_image_dimensions.width, size.recommended_image_dimensions.height])
    }

    /// Returns a function of an enabled extension.
    pub(super) fn function(&self, name: &CStr) -> pfn::VoidFunction {
        let mut function = None;
        // SAFETY: a live instance, and a null-terminated name.
        let result = unsafe { (self.get)(self.instance, name.as_ptr(), &mut function) };
        assert_eq!(result, sys::Result::SUCCESS, "{name:?}");
        function.unwrap()
    }

    /// Asks for a function without an instance. Returns the result, and the value of the function pointer afterwards.
    pub fn function_without_an_instance(&self, name: &CStr) -> (sys::Result, Option<pfn::VoidFunction>) {
        let mut function = Some(self.function(c"xrWaitFrame"));
        // SAFETY: a null-terminated name, and a place for a function.
        let result = unsafe { (self.get)(sys::Instance::NULL, name.as_ptr(), &mut function) };
        (result, function)
    }

    /// Creates a swapchain of subsampled images, as applications with fixed foveation do.
    pub fn subsampled_chain(&self, format: vk::Format, size: [u32; 2]) -> Outcome<Chain> {
        let more = sys::VulkanSwapchainCreateInfoMETA {
            ty: sys::VulkanSwapchainCreateInfoMETA::TYPE,
            next: ptr::null(),
            additional_create_flags: vk::ImageCreateFlags::SUBSAMPLED_EXT.as_raw().into(),
            additional_usage_flags: 0,
        };
        let info = self.chain_info(format, size, 1);
        self.chain_of(&self.xr, &sys::SwapchainCreateInfo { next: (&raw const more).cast(), ..info })
    }

    /// Creates a swapchain whose image never changes.
    pub fn static_chain(&self, format: vk::Format, size: [u32; 2]) -> Outcome<Chain> {
        let create_flags = sys::SwapchainCreateFlags::STATIC_IMAGE;
        self.chain_of(
            &self.xr,
            &sys::SwapchainCreateInfo { create_flags, ..self.chain_info(format, size, 1) },
        )
    }
}

fn depth_range() -> sys::ViewConfigurationDepthRangeEXT {
    // SAFETY: plain data.
    let empty = unsafe { std::mem::zeroed() };
    sys::ViewConfigurationDepthRangeEXT { ty: sys::ViewConfigurationDepthRangeEXT::TYPE, ..empty }
}

fn planes(range: &sys::ViewConfigurationDepthRangeEXT) -> [f32; 2] {
    [range.recommended_near_z, range.recommended_far_z]
}

/// Makes views that each have a structure chained to them, and returns the numbers that `ask` finds there.
fn chained<V, T: Clone>(
    count: usize,
    empty: T,
    read: fn(&T) -> [f32; 2],
    view: impl Fn(*mut c_void) -> V,
    ask: impl FnOnce(&mut [V]) -> Outcome<()>,
) -> Outcome<Vec<[f32; 2]>> {
    let mut structures = vec![empty; count];
    let mut views: Vec<V> =
        structures.iter_mut().map(|structure| view(ptr::from_mut(structure).cast())).collect();
    ask(&mut views)?;
    Ok(structures.iter().map(read).collect())
}
