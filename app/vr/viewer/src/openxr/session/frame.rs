//! One frame: both eyes and the HUD in the runtime's images, and the layers that show them.

use openxr as xr;
use xr::sys;

use super::eyes::{from_frustum, from_pose};
use super::state::{PanelImages, Session};
use crate::event::Action;
use crate::openxr::description::Capture;
use crate::openxr::error::{XrError, check};
use crate::viewer::Viewer;
use yoro::eyes::{DepthConvention, DepthRange, Eye, EyePair, Pose};
use yoro_context::Graphics;
use yoro_lenses::{Board, board_metres};
use yoro_render::stereo::{DepthTarget, EyeTarget};
use yoro_settings::Ipd;

/// The layers of a frame.
pub(super) struct Layers {
    pub eyes: Option<EyePair>,
    pub panel: Option<sys::CompositionLayerQuad>,
}

impl Session {
    /// Renders both eyes and the HUD into the runtime's images.
    pub(super) fn render(
        &mut self,
        graphics: &dyn Graphics,
        viewer: &mut Viewer,
        time: xr::Time,
        capture: bool,
        captured: &mut Option<Capture>,
    ) -> Result<Layers, XrError> {
        let nothing = Layers { eyes: None, panel: None };
        let size = self.frame_size(viewer);
        let Some(native) = self.locate(viewer.settings(), time, size)? else { return Ok(nothing) };
        viewer.set_native_ipd(Ipd::nearest((native.poses[1].position - native.poses[0].position).length()));
        let shown = self.align(viewer, native);
        let head = Pose { position: shown.middle(), orientation: shown.poses[0].orientation };
        let rays = match &self.input {
            Some(input) if viewer.is_menu_open() => input.rays(&self.spaces.ahead, time)?,
            _ => [None; 2],
        };
        let looked = viewer.look(head, rays);
        if let Some(action) = self.told(looked).filter(|action| *action != Action::Nothing) {
            log::info!("{action}");
            self.recenter |= action == Action::Recenter;
        }
        let mut pair = shown;
        if let Some(ipd) = viewer.chosen_ipd() {
            let middle = pair.middle();
            let axis = (pair.poses[1].position - pair.poses[0].position)
                .try_normalize()
                .unwrap_or(pair.poses[0].right());
            for eye in Eye::BOTH {
                pair.poses[eye.index()].position = middle + axis * (eye.side() * ipd.metres() / 2.0);
            }
        }
        pair.poses = pair.poses.map(|pose| viewer.place(pose));

        self.eyes.acquire(graphics)?;
        if let Some(depth) = &mut self.depth {
            depth.images.acquire(graphics)?;
        }
        let no_image = || XrError::Nonsense("has no image to draw into".into());
        let images = self.eyes.targets(size).ok_or_else(no_image)?;
        let rendered = self.render_eyes(viewer, &pair, images)?;
        if capture && rendered {
            let eyes = images.map(|image| self.gl.read_rgba8(&image.color));
            *captured = Some(Capture { eyes, pair });
        }
        self.eyes.release(graphics)?;
        if let Some(depth) = &mut self.depth {
            depth.images.release(graphics)?;
        }
        if !rendered {
            return Ok(nothing);
        }
        let panel = self.render_panel(graphics, viewer)?;
        Ok(Layers { eyes: Some(shown), panel })
    }

    /// Renders both eyes into images; returns false if the viewer cannot.
    fn render_eyes(
        &mut self,
        viewer: &mut Viewer,
        pair: &EyePair,
        images: [EyeTarget<'static>; 2],
    ) -> Result<bool, XrError> {
        let eyes = self.storage.begin(images)?;
        let depth = self.depth.as_ref().and_then(|depth| {
            Some(depth.images.destinations(pair.size)?.map(|to| DepthTarget { to, copy: &depth.copy }))
        });
        let targets = Eye::BOTH
            .map(|eye| EyeTarget { depth: depth.map(|depth| depth[eye.index()]), ..eyes[eye.index()] });
        let rendered = viewer.render_eyes(pair, &targets);
        if let Some(mask) = &self.mask
            && self.realigned.is_none()
        {
            mask.draw(&pair.frusta, &eyes.map(|eye| eye.color));
        }
        self.storage.end(images.map(|image| image.color));
        // The runtime may read the images on another queue. SAFETY: `flush` has no arguments.
        unsafe { glow::HasContext::flush(self.gl.raw()) };
        Ok(self.told(rendered).is_some())
    }

    /// Updates the image of the menu or the HUD, if one of them is to be shown.
    fn render_panel(
        &mut self,
        graphics: &dyn Graphics,
        viewer: &mut Viewer,
    ) -> Result<Option<sys::CompositionLayerQuad>, XrError> {
        let Some(PanelImages { images, version }) = &mut self.panel else { return Ok(None) };
        let quad =
            |space: &xr::Space, sub_image, pose, [width, height]: [f32; 2]| sys::CompositionLayerQuad {
                ty: sys::CompositionLayerQuad::TYPE,
                next: std::ptr::null(),
                layer_flags: xr::CompositionLayerFlags::BLEND_TEXTURE_SOURCE_ALPHA
                    | xr::CompositionLayerFlags::UNPREMULTIPLIED_ALPHA,
                space: space.as_raw(),
                eye_visibility: xr::EyeVisibility::BOTH,
                sub_image,
                pose,
                size: xr::Extent2Df { width, height },
            };
        if let Some(place) = viewer.menu_place() {
            // The dot that shows where the user points moves with each frame.
            images.acquire(graphics)?;
            if let Some(to) = images.destination(0, Board::SIZE) {
                viewer.draw_menu_image(&to);
                // SAFETY: `flush` has no arguments.
                unsafe { glow::HasContext::flush(self.gl.raw()) };
            }
            images.release(graphics)?;
            *version = None;
            let sub_image = images.sub_image(0, Board::SIZE);
            return Ok(Some(quad(&self.spaces.ahead, sub_image, from_pose(&place), board_metres())));
        }
        let panel = match viewer.hud() {
            Ok(Some(panel)) => panel,
            Ok(None) => return Ok(None),
            Err(error) => {
                self.told::<()>(Err(error));
                return Ok(None);
            }
        };
        if *version != Some(panel.version()) {
            images.acquire(graphics)?;
            if let Some(to) = images.destination(0, panel.size()) {
                panel.draw(&to);
                // SAFETY: `flush` has no arguments.
                unsafe { glow::HasContext::flush(self.gl.raw()) };
            }
            images.release(graphics)?;
            *version = Some(panel.version());
        }
        let (metres, center) = (panel.metres(), panel.center());
        let mut pose = xr::Posef::IDENTITY;
        pose.position = xr::Vector3f { x: center.x, y: center.y, z: center.z };
        Ok(Some(quad(&self.spaces.head, images.sub_image(0, panel.size()), pose, metres)))
    }

    /// Returns the size in pixels of each eye in this frame, at most that of the images.
    fn frame_size(&self, viewer: &Viewer) -> [u32; 2] {
        let wanted = viewer.eye_size(self.description.recommended.map(|n| n as f32));
        [0, 1].map(|i| wanted[i].min(self.description.size[i]))
    }

    /// Calls xrEndFrame.
    pub(super) fn end_frame(&mut self, time: xr::Time, layers: &Layers) -> Result<(), XrError> {
        let eyes = layers.eyes.as_ref();
        let depth_info = |eye: Eye| {
            let (depth, eyes) = (self.depth.as_ref()?, eyes?);
            let DepthRange { near, far, convention } = eyes.depth;
            let [near_z, far_z] = match convention {
                DepthConvention::Standard => [near, far],
                DepthConvention::Reversed => [far, near],
            };
            Some(sys::CompositionLayerDepthInfoKHR {
                ty: sys::CompositionLayerDepthInfoKHR::TYPE,
                next: std::ptr::null(),
                sub_image: depth.images.sub_image(eye, eyes.size),
                min_depth: 0.0,
                max_depth: 1.0,
                near_z,
                far_z,
            })
        };
        let depths = Eye::BOTH.map(depth_info);
        let views = eyes.map(|eyes| {
            Eye::BOTH.map(|eye| sys::CompositionLayerProjectionView {
                ty: sys::CompositionLayerProjectionView::TYPE,
                next: depths[eye.index()]
                    .as_ref()
                    .map_or(std::ptr::null(), |info| std::ptr::from_ref(info).cast()),
                pose: from_pose(&eyes.poses[eye.index()]),
                fov: from_frustum(&eyes.frusta[eye.index()]),
                sub_image: self.eyes.sub_image(eye, eyes.size),
            })
        });
        let count = if self.views == xr::ViewConfigurationType::PRIMARY_STEREO { 2 } else { 1 };
        let projection = views.as_ref().map(|views| sys::CompositionLayerProjection {
            ty: sys::CompositionLayerProjection::TYPE,
            next: std::ptr::null(),
            layer_flags: xr::CompositionLayerFlags::EMPTY,
            space: self.spaces.ahead.as_raw(),
            view_count: count,
            views: views.as_ptr(),
        });
        let mut shown = [std::ptr::null::<sys::CompositionLayerBaseHeader>(); 2];
        let headers = projection
            .as_ref()
            .map(|layer| std::ptr::from_ref(layer).cast())
            .into_iter()
            .chain(layers.panel.as_ref().map(|layer| std::ptr::from_ref(layer).cast()));
        let mut layer_count = 0;
        for (slot, header) in shown.iter_mut().zip(headers) {
            *slot = header;
            layer_count += 1;
        }
        let info = sys::FrameEndInfo {
            ty: sys::FrameEndInfo::TYPE,
            next: std::ptr::null(),
            display_time: time,
            environment_blend_mode: self.blend,
            layer_count,
            layers: shown.as_ptr(),
        };
        // SAFETY: everything that the structures point to is on this stack or in `self`.
        let result = unsafe { (self.instance.fp().end_frame)(self.session.as_raw(), &info) };
        check("xrEndFrame", result).map(drop)
    }
}
