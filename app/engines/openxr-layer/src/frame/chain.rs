//! Reads the structures that the application submits.

use std::sync::Arc;

use openxr_sys as sys;

use crate::geometry::{Rectangle, pose};
use crate::reason::Reason;
use crate::structures;
use crate::swapchain::{Content, Swapchain};
use crate::synthesizer::Image;

/// The application's layers of a frame.
pub type Layers<'a> = &'a [*const sys::CompositionLayerBaseHeader];

/// Returns the layers of a frame, or none if the pointer to them is null.
///
/// # Safety
/// `info` is the structure of a call of xrEndFrame.
pub unsafe fn layers(info: &sys::FrameEndInfo) -> Layers<'_> {
    if info.layers.is_null() {
        return &[];
    }
    // SAFETY: the application passes as many layers as it counts.
    unsafe { std::slice::from_raw_parts(info.layers, info.layer_count as usize) }
}

/// Returns a layer if it is a projection layer.
///
/// # Safety
/// The pointer is null, or points to a structure of the type that it states.
unsafe fn any_projection<'a>(
    layer: *const sys::CompositionLayerBaseHeader,
) -> Option<&'a sys::CompositionLayerProjection> {
    // SAFETY: every layer begins with this header, and its type tells what it is.
    unsafe {
        let is_one = layer.as_ref()?.ty == sys::CompositionLayerProjection::TYPE;
        is_one.then(|| &*layer.cast::<sys::CompositionLayerProjection>())
    }
}

/// Returns a layer if it is a projection layer with this number of views.
///
/// # Safety
/// The pointer is null, or points to a structure of the type that it states.
pub unsafe fn projection<'a>(
    layer: *const sys::CompositionLayerBaseHeader,
    views: usize,
) -> Option<&'a sys::CompositionLayerProjection> {
    // SAFETY: same contract.
    let layer = unsafe { any_projection(layer) }?;
    (layer.view_count as usize == views && !layer.views.is_null()).then_some(layer)
}

/// True if all projection layers have this number of views.
///
/// # Safety
/// The layers are those of a call of xrEndFrame.
pub unsafe fn all_have(layers: Layers, views: usize) -> bool {
    // SAFETY: the application's layers.
    layers
        .iter()
        .filter_map(|&layer| unsafe { any_projection(layer) })
        .all(|layer| layer.view_count as usize == views)
}

/// Returns the depth of a view, if its chain contains it.
///
/// # Safety
/// The view belongs to a submitted layer.
pub unsafe fn depth_of(
    view: &sys::CompositionLayerProjectionView,
) -> Option<&sys::CompositionLayerDepthInfoKHR> {
    // SAFETY: the view's chain, and the structure of this type.
    unsafe { structures::find(view.next, sys::CompositionLayerDepthInfoKHR::TYPE) }
}

/// True if the images of a layer are vertically flipped (XR_FB_composition_layer_image_layout).
///
/// # Safety
/// The layer was submitted.
pub unsafe fn is_upside_down(layer: &sys::CompositionLayerProjection) -> bool {
    let ty = sys::CompositionLayerImageLayoutFB::TYPE;
    // SAFETY: the layer's chain, and the structure of this type.
    let layout = unsafe { structures::find::<sys::CompositionLayerImageLayoutFB>(layer.next, ty) };
    layout.is_some_and(|layout| layout.flags.contains(sys::CompositionLayerImageLayoutFlagsFB::VERTICAL_FLIP))
}

/// A submitted image that the runtime does not own yet.
pub struct Held<'a> {
    /// All images of its swapchain.
    pub content: &'a Content,
    pub image: Image,
}

/// Returns the image that the application released last to a swapchain. `what` is colour or depth.
///
/// # Errors
/// [`Reason::Unknown`], [`Reason::Unreadable`], and [`Reason::Old`] if the runtime already owns the image.
pub fn held<'a>(
    swapchains: &'a [Arc<Swapchain>],
    part: &sys::SwapchainSubImage,
    what: &'static str,
) -> Result<Held<'a>, Reason> {
    let swapchain = swapchains.iter().find(|swapchain| swapchain.handle == part.swapchain);
    let swapchain = swapchain.ok_or(Reason::Unknown(what))?;
    swapchain.content.as_ref().ok_or(Reason::Unreadable(what))?;
    let (content, image) = swapchain.held().ok_or(Reason::Old(what))?;
    Ok(Held { content, image: content.image(image, part.image_array_index) })
}

/// True if xrCreateSwapchain has made the swapchain of a view, rather than a function of an extension.
pub fn is_known(swapchains: &[Arc<Swapchain>], view: &sys::CompositionLayerProjectionView) -> bool {
    swapchains.iter().any(|swapchain| swapchain.handle == view.sub_image.swapchain)
}

/// True if a view that the layer replaces has a pose, and an image within a swapchain. Otherwise the runtime must see it.
pub fn is_sound(swapchains: &[Arc<Swapchain>], view: &sys::CompositionLayerProjectionView) -> bool {
    let known = swapchains.iter().find(|swapchain| swapchain.handle == view.sub_image.swapchain);
    let has_image = known.is_some_and(|known| {
        let lies_inside = |content| rectangle(&view.sub_image, content).is_ok();
        known.releases() > 0 && known.content.as_ref().is_none_or(lies_inside)
    });
    let pose = pose(view.pose);
    has_image && pose.position.is_finite() && (pose.orientation.length() - 1.0).abs() < 0.01
}

/// Returns the rectangle of a sub-image.
///
/// # Errors
/// [`Reason::Beyond`] if it does not lie inside the swapchain.
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

/// Returns the sub-image for a rectangle in a layer of a swapchain.
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
