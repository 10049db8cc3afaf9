//! A synthesized view, which can be shown again as long as the application shows the same image.

use std::sync::Arc;

use openxr_sys as sys;
use yoro::eyes::Eye;

use super::chain::sub_image;
use super::rewrite::Eyes;
use super::target::Acquired;
use super::vectors::EyeVectors;
use crate::geometry::{Rectangle, Split, pose, xr_fov, xr_pose};
use crate::motion::MotionInfo;
use crate::swapchain::Swapchain;

/// Two images that the application submits. While it shows them again, they stay equal.
#[derive(Clone, Copy, PartialEq)]
pub struct Images {
    /// Swapchain, array layer and rectangle of each.
    parts: [(sys::Swapchain, u32, [i32; 4]); 2],
    /// The number of releases of their images. The images are unchanged while it stays the same.
    releases: [u64; 2],
}

impl Images {
    pub fn new(swapchains: &[Arc<Swapchain>], images: [&sys::SwapchainSubImage; 2]) -> Images {
        let parts = images.map(|part| {
            let sys::Rect2Di { offset, extent } = part.image_rect;
            (part.swapchain, part.image_array_index, [offset.x, offset.y, extent.width, extent.height])
        });
        let releases = images.map(|part| {
            let swapchain = swapchains.iter().find(|swapchain| swapchain.handle == part.swapchain);
            swapchain.map_or(0, |swapchain| swapchain.releases())
        });
        Images { parts, releases }
    }
}

/// The inputs of a synthesized image, except for the pose.
#[derive(Clone, Copy, PartialEq)]
pub struct Key {
    /// Colour and depth.
    images: Images,
    fov: [f32; 4],
    planes: [f32; 4],
    upside_down: bool,
}

impl Key {
    pub fn new(
        swapchains: &[Arc<Swapchain>],
        view: &sys::CompositionLayerProjectionView,
        info: &sys::CompositionLayerDepthInfoKHR,
        upside_down: bool,
    ) -> Key {
        let images = Images::new(swapchains, [&view.sub_image, &info.sub_image]);
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
    /// Colour and depth of the other eye.
    pub color: Acquired,
    pub depth: Option<Acquired>,
    /// The vectors of both eyes, if the application submitted some that could be moved.
    pub vectors: Option<EyeVectors>,
}

impl Synthesized {
    /// Returns the motion vectors of both eyes for the application's, if they were made of the same images.
    pub fn motions(
        &self,
        swapchains: &[Arc<Swapchain>],
        info: Option<MotionInfo>,
    ) -> Option<[MotionInfo; 2]> {
        let (vectors, info) = self.vectors.zip(info)?;
        vectors.infos(swapchains, &info)
    }

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
            sub_image: part(eye, &view.sub_image, self.color),
        });
        let depths = self.depth.map(|target| {
            Eye::BOTH.map(|eye| sys::CompositionLayerDepthInfoKHR {
                next: std::ptr::null(),
                sub_image: part(eye, &info.sub_image, target),
                ..*info
            })
        });
        Eyes { views, depths, motions: None }
    }
}
