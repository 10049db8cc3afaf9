//! Reading the structures that the application submits.

use std::sync::Arc;

use openxr_sys as sys;

use crate::geometry::Rectangle;
use crate::reason::Reason;
use crate::swapchain::{Content, Swapchain};

/// The application's layers of a frame.
pub type Layers<'a> = &'a [*const sys::CompositionLayerBaseHeader];

/// Returns the layers of a frame; none if the pointer to them is null.
///
/// # Safety
/// `info` is the structure of a call of xrEndFrame.
pub unsafe fn layers(info: &sys::FrameEndInfo) -> Layers<'_> {
    if info.layers.is_null() {
        return &[];
    }
    // SAFETY: an application gives as many layers as it counts.
    unsafe { std::slice::from_raw_parts(info.layers, info.layer_count as usize) }
}

/// Returns a layer if it is a projection layer with this number of views.
///
/// # Safety
/// The pointer is null, or to a structure of the type that it says.
pub unsafe fn projection<'a>(
    layer: *const sys::CompositionLayerBaseHeader,
    views: usize,
) -> Option<&'a sys::CompositionLayerProjection> {
    // SAFETY: every layer begins with this header, and its type says what it is.
    unsafe {
        if layer.as_ref()?.ty != sys::CompositionLayerProjection::TYPE {
            return None;
        }
        let layer = &*layer.cast::<sys::CompositionLayerProjection>();
        (layer.view_count as usize == views && !layer.views.is_null()).then_some(layer)
    }
}

/// Returns the depth of a view, if its chain has it.
///
/// # Safety
/// The view is one of a submitted layer.
pub unsafe fn depth_of(
    view: &sys::CompositionLayerProjectionView,
) -> Option<&sys::CompositionLayerDepthInfoKHR> {
    let mut structure = view.next.cast::<sys::BaseInStructure>();
    // SAFETY: every structure of a chain begins with this header, and its type says what it is.
    unsafe {
        while let Some(header) = structure.as_ref() {
            if header.ty == sys::CompositionLayerDepthInfoKHR::TYPE {
                return Some(&*structure.cast::<sys::CompositionLayerDepthInfoKHR>());
            }
            structure = header.next;
        }
    }
    None
}

/// Returns the images of a swapchain and the one that the application has released last. `what` is colour or depth.
///
/// # Errors
/// [`Reason::Unreadable`], and [`Reason::Old`] if the runtime has the image already.
pub fn held<'a>(
    swapchains: &'a [Arc<Swapchain>],
    handle: sys::Swapchain,
    what: &'static str,
) -> Result<(&'a Content, u64), Reason> {
    let swapchain = swapchains.iter().find(|swapchain| swapchain.handle == handle);
    let swapchain = swapchain.filter(|known| known.content.is_some()).ok_or(Reason::Unreadable(what))?;
    swapchain.held().ok_or(Reason::Old(what))
}

/// Returns the rectangle of a sub-image.
///
/// # Errors
/// [`Reason::Beyond`] if it does not lie in the swapchain.
pub fn rectangle(sub_image: &sys::SwapchainSubImage, content: &Content) -> Result<Rectangle, Reason> {
    let (offset, extent) = (sub_image.image_rect.offset, sub_image.image_rect.extent);
    let inside = |offset: i32, extent: i32, size: u32| {
        let (offset, extent) = (u32::try_from(offset).ok()?, u32::try_from(extent).ok()?);
        (extent > 0 && offset.checked_add(extent)? <= size).then_some((offset, extent))
    };
    let columns = inside(offset.x, extent.width, content.size[0]);
    let rows = inside(offset.y, extent.height, content.size[1]);
    match (columns, rows) {
        (Some(x), Some(y)) if sub_image.image_array_index < content.array_size => {
            Ok(Rectangle { origin: [x.0, y.0], size: [x.1, y.1] })
        }
        _ => Err(Reason::Beyond),
    }
}

/// Returns the sub-image of a rectangle in a layer of a swapchain.
pub fn sub_image(swapchain: sys::Swapchain, part: Rectangle, layer: u32) -> sys::SwapchainSubImage {
    let [x, y] = part.origin.map(|pixels| pixels as i32);
    let [width, height] = part.size.map(|pixels| pixels as i32);
    sys::SwapchainSubImage {
        swapchain,
        image_rect: sys::Rect2Di {
            offset: sys::Offset2Di { x, y },
            extent: sys::Extent2Di { width, height },
        },
        image_array_index: layer,
    }
}
