//! A synthesized view, which can be shown again as long as the application shows the same image.

use std::sync::Arc;

use openxr_sys as sys;
use yoro::eyes::Eye;

use super::chain::sub_image;
use super::rewrite::Eyes;
use super::target::{Acquired, AcquiredImages};
use crate::geometry::{Rectangle, Split, pose, xr_fov, xr_pose};
use crate::swapchain::Swapchain;

/// The inputs of a synthesized image, except for the pose.
#[derive(Clone, Copy, PartialEq)]
pub struct Key {
    /// Colour and depth.
    images: [SubmittedImage; 2],
    fov: [f32; 4],
    planes: [f32; 4],
    upside_down: bool,
}

/// A part of a swapchain's image. While the application shows it again, it stays equal.
#[derive(Clone, Copy, PartialEq)]
struct SubmittedImage {
    swapchain: sys::Swapchain,
    layer: u32,
    /// Offset and extent.
    rectangle: [i32; 4],
    /// The number of images that were released. The image is unchanged while it stays the same.
    releases: u64,
}

impl Key {
    pub fn new(
        swapchains: &[Arc<Swapchain>],
        view: &sys::CompositionLayerProjectionView,
        info: &sys::CompositionLayerDepthInfoKHR,
        upside_down: bool,
    ) -> Key {
        let images = [&view.sub_image, &info.sub_image].map(|part| {
            let sys::Rect2Di { offset, extent } = part.image_rect;
            let swapchain = swapchains.iter().find(|swapchain| swapchain.handle == part.swapchain);
            SubmittedImage {
                swapchain: part.swapchain,
                layer: part.image_array_index,
                rectangle: [offset.x, offset.y, extent.width, extent.height],
                releases: swapchain.map_or(0, |swapchain| swapchain.releases()),
            }
        });
        let sys::Fovf { angle_left, angle_right, angle_up, angle_down } = view.fov;
        let fov = [angle_left, angle_right, angle_up, angle_down];
        let planes = [info.near_z, info.far_z, info.min_depth, info.max_depth];
        Key { images, fov, planes, upside_down }
    }
}

/// A synthesized view that the targets still hold.
pub struct Synthesized {
    pub key: Key,
    pub split: Split,
    /// The dominant eye's part of the application's image.
    pub crop: Rectangle,
    pub dominant: Eye,
    pub images: AcquiredImages,
}

impl Synthesized {
    /// Returns the views for the pose of this view, whose key is the same.
    pub fn again(
        &self,
        view: &sys::CompositionLayerProjectionView,
        info: &sys::CompositionLayerDepthInfoKHR,
    ) -> Eyes {
        let (own, other) = (self.dominant.index(), self.dominant.other().index());
        let [from, to] = [own, other].map(|eye| self.split.poses[eye]);
        let between = from.orientation.inverse() * (to.position - from.position);
        let mut split = self.split;
        split.poses[own] = pose(view.pose);
        split.poses[other] = split.poses[own].translated_local(between);
        Synthesized { split, ..*self }.eyes(view, info)
    }

    /// Returns the views of both eyes. The dominant eye's view is a part of the application's image, and the other
    /// eye's is in the targets.
    pub fn eyes(
        &self,
        view: &sys::CompositionLayerProjectionView,
        info: &sys::CompositionLayerDepthInfoKHR,
    ) -> Eyes {
        let whole = Rectangle { origin: [0; 2], size: self.split.crop.size };
        let part = |eye: Eye, own: &sys::SwapchainSubImage, target: Acquired| {
            if eye == self.dominant {
                sub_image(own.swapchain, self.crop, own.image_array_index)
            } else {
                sub_image(target.swapchain, whole, 0)
            }
        };
        let views = Eye::BOTH.map(|eye| sys::CompositionLayerProjectionView {
            ty: sys::CompositionLayerProjectionView::TYPE,
            next: std::ptr::null(),
            pose: xr_pose(self.split.poses[eye.index()]),
            fov: xr_fov(self.split.frusta[eye.index()]),
            sub_image: part(eye, &view.sub_image, self.images.color),
        });
        let depths = self.images.depth.map(|target| {
            Eye::BOTH.map(|eye| sys::CompositionLayerDepthInfoKHR {
                next: std::ptr::null(),
                sub_image: part(eye, &info.sub_image, target),
                ..*info
            })
        });
        Eyes { views, depths }
    }
}
