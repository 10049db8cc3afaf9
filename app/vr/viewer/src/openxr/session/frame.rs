//! One frame: both eyes and the HUD in the runtime's images, and the layers that show them.

use std::ffi::c_void;

use openxr as xr;
use xr::sys;

use super::eyes::{from_frustum, from_pose};
use super::state::{PanelImages, RuntimeLevel, Session};
use crate::event::Action;
use crate::openxr::description::Capture;
use crate::openxr::error::{XrError, check, optional};
use crate::openxr::images::EyeImages;
use crate::openxr::motion::{MotionInfo, ends};
use crate::viewer::Viewer;
use yoro::eyes::{Eye, EyePair, Pose, StereoViews, ViewLayer};
use yoro_context::Graphics;
use yoro_lenses::{Board, board_metres};
use yoro_render::DepthCopy;
use yoro_render::stereo::{DepthTarget, EyeTarget, FrameTargets, LayerTargets};
use yoro_settings::Ipd;

/// Both eyes and their insets.
const MAX_VIEWS: usize = 4;
/// The most times that an eye's images are made anew for another size. If a runtime's frusta change more often than that, the
/// rendered eye is copied.
const MAX_REMADE: u32 = 32;

/// The layers of a frame.
pub(super) struct Layers {
    /// The eyes as they are submitted.
    pub eyes: Option<Submitted>,
    pub panel: Option<sys::CompositionLayerQuad>,
}

/// The eyes as they are submitted, with insets if the runtime shows insets.
pub(super) struct Submitted {
    pub views: StereoViews,
    pub drawn: Drawn,
}

/// What the runtime gets beside colour.
#[derive(Clone, Copy)]
pub(super) struct Drawn {
    /// Where the dominant eye begins in its image.
    pub origin: [u32; 2],
    /// The size in pixels of the wide eyes' depth: that of their images, or that of the level of which this program has
    /// composed them with an inset. `None` if it is not of the submitted frusta.
    pub depth_size: Option<[u32; 2]>,
    /// True if the runtime is to make the next frame.
    pub leaves_frame: bool,
    /// True if it gets motion vectors for it.
    pub has_motion: bool,
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
        let wide = frame_size(viewer, &self.wide);
        let sizes = [wide, self.inset.as_ref().map_or(wide, |inset| frame_size(viewer, inset))];
        let Some(native) = self.locate(viewer.settings(), time, sizes)? else { return Ok(nothing) };
        viewer.set_native_ipd(Ipd::nearest(native.shown.ipd()));
        let shown = self.align(viewer, native);
        let eyes = &shown.wide.eyes;
        let head = Pose { position: eyes.middle(), orientation: eyes.poses[0].orientation };
        let rays = match &self.input {
            Some(input) if viewer.is_menu_open() => input.rays(&self.spaces.ahead, time)?,
            _ => [None; 2],
        };
        let looked = viewer.look(head, rays);
        if let Some(action) = self.log_error(looked).filter(|action| *action != Action::Nothing) {
            log::info!("{action}");
            self.recenter |= action == Action::Recenter;
        }
        let poses = poses_in_scene(viewer, eyes);
        let placed = |eyes: EyePair| EyePair { poses, ..eyes };
        let placed_layer = |layer: ViewLayer| ViewLayer { eyes: placed(layer.eyes), ..layer };
        let in_scene = StereoViews {
            shown: placed(shown.shown),
            wide: placed_layer(shown.wide),
            inset: shown.inset.map(placed_layer),
            ..shown
        };
        // A runtime that shows insets composes them itself. Of one view, an API layer may need colour and depth of one size.
        let views = match self.views {
            xr::ViewConfigurationType::PRIMARY_STEREO => {
                let axes = native.shown.poses.map(|pose| viewer.place(pose).forward());
                viewer.stereo_views(&in_scene.shown, axes)
            }
            _ => in_scene,
        };
        let is_composed = in_scene.inset.is_none() && views.inset.is_some();
        self.fit_images(graphics, viewer, &views)?;
        if let Some(foveation) = &mut self.fixed_foveation {
            let level = if is_composed { viewer.settings().foveation } else { None };
            foveation.set(graphics, &self.session, &self.wide.eyes, level.unwrap_or_default())?;
        }
        self.wide.acquire(graphics)?;
        self.inset.as_mut().map_or(Ok(()), |inset| inset.acquire(graphics))?;
        let leaves_frames = viewer.uses_runtime_frame_synthesis();
        let motion = self.motion.as_mut().filter(|_| leaves_frames);
        motion.map_or(Ok(()), |motion| motion.acquire(graphics))?;
        let no_image = || XrError::InvalidRuntimeData("has no image to draw into".into());
        let targets =
            |level: &RuntimeLevel, pair: &EyePair| level.eyes.targets(pair.size).ok_or_else(no_image);
        let inset = self.inset.as_ref().zip(in_scene.inset);
        let images = LayerTargets {
            wide: targets(&self.wide, &in_scene.shown)?,
            inset: inset.map(|(own, layer)| targets(own, &layer.eyes)).transpose()?,
        };
        let rendered = self.render_eyes(viewer, &views, &images)?;
        if let Some(drawn) = rendered.filter(|_| capture) {
            let mut colors = images.wide.map(|image| image.color);
            colors[in_scene.shown.dominant.index()].origin = drawn.origin;
            let eyes = colors.map(|color| self.gl.read_rgba8(&color));
            *captured = Some(Capture { eyes, pair: in_scene.shown });
        }
        self.wide.release(graphics)?;
        self.inset.as_mut().map_or(Ok(()), |inset| inset.release(graphics))?;
        self.motion.as_mut().map_or(Ok(()), |motion| motion.release(graphics))?;
        let Some(drawn) = rendered else { return Ok(nothing) };
        let panel = self.render_panel(graphics, viewer)?;
        Ok(Layers { eyes: Some(Submitted { views: shown, drawn }), panel })
    }

    /// Makes the image of the dominant eye as large as the view of which the eye is a part, if that view can be rendered into
    /// it: then the eye need not be copied out of the view.
    fn fit_images(
        &mut self,
        graphics: &dyn Graphics,
        viewer: &Viewer,
        views: &StereoViews,
    ) -> Result<(), XrError> {
        if self.views != xr::ViewConfigurationType::PRIMARY_STEREO || !self.description.readable {
            return Ok(());
        }
        let level = &mut self.wide;
        let is_possible = |size: &[u32; 2]| (0..2).all(|i| size[i] <= level.largest[i]);
        let rendered = viewer.rendered_size(views).filter(is_possible);
        let rendered = rendered.filter(|_| self.remade < MAX_REMADE);
        let mut fit = |eye, size| level.eyes.fit(graphics, &self.gl, &self.session, eye, size);
        for eye in Eye::BOTH {
            let size = rendered.filter(|_| eye == views.shown.dominant);
            let fitted =
                size.map(|size| optional("the rendered eye is copied", fit(eye, size))).transpose()?;
            match fitted {
                Some(Some(is_new)) => self.remade += u32::from(is_new),
                Some(None) => self.remade = MAX_REMADE,
                None => fit(eye, level.size).map(drop)?,
            }
        }
        Ok(())
    }

    /// Renders both eyes into images; `None` if the viewer cannot.
    fn render_eyes(
        &mut self,
        viewer: &mut Viewer,
        views: &StereoViews,
        images: &LayerTargets<'static>,
    ) -> Result<Option<Drawn>, XrError> {
        let mut to: LayerTargets = self.storage.begin(*images)?;
        let mut colors = to.wide.map(|eye| eye.color);
        let place = viewer.place(Pose::IDENTITY);
        let copy = self.depth_copy.as_ref();
        let depth_size = views.wide.eyes.size;
        to.wide = self.wide.with_depth(copy, to.wide, depth_size);
        let mut motion = self.motion.as_mut().filter(|_| viewer.uses_runtime_frame_synthesis());
        let leaves_frame = motion.is_some();
        if let Some(motion) = &mut motion {
            to.wide = motion.targets(&self.gl, to.wide, place)?;
        }
        let inset = self.inset.as_ref().zip(to.inset).zip(views.inset);
        let targets = match inset {
            Some(((level, eyes), layer)) => {
                let inset = Some(level.with_depth(copy, eyes, layer.eyes.size));
                FrameTargets::Layers(LayerTargets { wide: to.wide, inset })
            }
            None => FrameTargets::Eyes(to.wide),
        };
        let rendered = viewer.render(views, targets);
        let origin = rendered.as_ref().map_or([0, 0], |report| report.origin);
        colors[views.shown.dominant.index()].origin = origin;
        let is_previous = leaves_frame && rendered.is_ok();
        if let Some(motion) = &mut self.motion {
            motion.remember(is_previous.then_some((views.shown, place)));
        }
        if let Some(mask) = &self.mask
            && self.realigned.is_none()
        {
            mask.draw(&views.shown.frusta, &colors);
        }
        self.storage.end(images);
        // The runtime may read the images on another queue. SAFETY: `flush` has no arguments.
        unsafe { glow::HasContext::flush(self.gl.raw()) };
        let drawn = self.log_error(rendered).map(|report| Drawn {
            origin,
            depth_size: report.has_depth.then_some(depth_size),
            leaves_frame,
            has_motion: report.has_motion,
        });
        Ok(drawn)
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
            if let Some(to) = images.destination(Board::SIZE) {
                viewer.draw_menu_image(&to);
                // SAFETY: `flush` has no arguments.
                unsafe { glow::HasContext::flush(self.gl.raw()) };
            }
            images.release(graphics)?;
            *version = None;
            let sub_image = images.sub_image([0, 0], Board::SIZE);
            return Ok(Some(quad(&self.spaces.ahead, sub_image, from_pose(&place), board_metres())));
        }
        let panel = match viewer.hud() {
            Ok(Some(panel)) => panel,
            Ok(None) => return Ok(None),
            Err(error) => {
                self.log_error::<()>(Err(error));
                return Ok(None);
            }
        };
        if *version != Some(panel.version()) {
            images.acquire(graphics)?;
            if let Some(to) = images.destination(panel.size()) {
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
        Ok(Some(quad(&self.spaces.head, images.sub_image([0, 0], panel.size()), pose, metres)))
    }

    /// Calls xrEndFrame.
    pub(super) fn end_frame(&mut self, time: xr::Time, layers: &Layers) -> Result<(), XrError> {
        let eyes = layers.eyes.as_ref();
        let wide = eyes.map(|eyes| (&self.wide, &eyes.views.wide.eyes, eyes.drawn.depth_size));
        let inset = eyes.and_then(|eyes| Some((self.inset.as_ref()?, &eyes.views.inset.as_ref()?.eyes)));
        let inset = inset.map(|(level, pair)| (level, pair, Some(pair.size)));
        let submitted = || {
            let levels = [wide, inset].into_iter().flatten();
            levels.flat_map(|level| Eye::BOTH.map(|eye| (eye, level)))
        };
        let moving = eyes.filter(|eyes| eyes.drawn.leaves_frame).zip(self.motion.as_ref());
        let motions = Eye::BOTH.map(|eye| {
            let (eyes, motion) = moving?;
            motion.info(eye, &eyes.views.wide.eyes.depth, eyes.drawn.has_motion)
        });
        // The insets, which come after the eyes, have no vectors.
        let after = |i: usize| {
            let motion = motions.get(i).and_then(Option::as_ref);
            motion.map_or(std::ptr::null(), MotionInfo::header)
        };
        let mut depths = [None; MAX_VIEWS];
        for (i, (eye, (level, pair, size))) in submitted().enumerate().take(MAX_VIEWS) {
            let depth = size.zip(level.depth.as_ref());
            depths[i] = depth.map(|(size, images)| depth_info(eye, pair, images, size, after(i)));
        }
        let mut views = [sys::CompositionLayerProjectionView {
            ty: sys::CompositionLayerProjectionView::TYPE,
            next: std::ptr::null(),
            pose: xr::Posef::IDENTITY,
            fov: xr::Fovf::default(),
            sub_image: self.wide.eyes.sub_image(Eye::Left, [0, 0], [0, 0]),
        }; MAX_VIEWS];
        let mut count = 0;
        for (i, (eye, (level, pair, _))) in submitted().enumerate().take(MAX_VIEWS) {
            let view = &mut views[i];
            view.next = depths[i].as_ref().map_or(after(i), |info| std::ptr::from_ref(info).cast());
            view.pose = from_pose(&pair.poses[eye.index()]);
            view.fov = from_frustum(&pair.frusta[eye.index()]);
            let origin = eyes.filter(|_| eye == pair.dominant).map_or([0, 0], |eyes| eyes.drawn.origin);
            view.sub_image = level.eyes.sub_image(eye, origin, pair.size);
            count += 1;
        }
        let is_one = self.views == xr::ViewConfigurationType::PRIMARY_MONO;
        let projection = eyes.map(|_| sys::CompositionLayerProjection {
            ty: sys::CompositionLayerProjection::TYPE,
            next: std::ptr::null(),
            layer_flags: xr::CompositionLayerFlags::EMPTY,
            space: self.spaces.ahead.as_raw(),
            view_count: if is_one { 1 } else { count },
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

/// Returns the size in pixels of each eye of a level in this frame, at most that of the images.
fn frame_size(viewer: &Viewer, level: &RuntimeLevel) -> [u32; 2] {
    let wanted = viewer.eye_size(level.recommended.map(|n| n as f32));
    [0, 1].map(|i| wanted[i].min(level.size[i]))
}

/// Returns the poses of the eyes in the scene, as far apart as the user has chosen.
fn poses_in_scene(viewer: &Viewer, eyes: &EyePair) -> [Pose; 2] {
    let mut poses = eyes.poses;
    if let Some(ipd) = viewer.chosen_ipd() {
        let middle = eyes.middle();
        let axis = (poses[1].position - poses[0].position).try_normalize().unwrap_or(poses[0].right());
        for eye in Eye::BOTH {
            poses[eye.index()].position = middle + axis * (eye.side() * ipd.metres() / 2.0);
        }
    }
    poses.map(|pose| viewer.place(pose))
}

/// Returns the description of an eye's depth, which lies in these images; `next` is chained to it.
fn depth_info(
    eye: Eye,
    pair: &EyePair,
    images: &EyeImages,
    size: [u32; 2],
    next: *const c_void,
) -> sys::CompositionLayerDepthInfoKHR {
    let [near_z, far_z] = ends(&pair.depth);
    sys::CompositionLayerDepthInfoKHR {
        ty: sys::CompositionLayerDepthInfoKHR::TYPE,
        next,
        sub_image: images.sub_image(eye, [0, 0], size),
        min_depth: 0.0,
        max_depth: 1.0,
        near_z,
        far_z,
    }
}

impl RuntimeLevel {
    /// Returns targets with the depth for the runtime, if it takes any.
    fn with_depth<'a>(
        &self,
        copy: Option<&'a DepthCopy>,
        eyes: [EyeTarget<'a>; 2],
        size: [u32; 2],
    ) -> [EyeTarget<'a>; 2] {
        let depth = self.depth.as_ref().and_then(|images| images.destinations(size)).zip(copy);
        let depth = depth.map(|(to, copy)| to.map(|to| DepthTarget { to, copy }));
        Eye::BOTH.map(|eye| EyeTarget { depth: depth.map(|depth| depth[eye.index()]), ..eyes[eye.index()] })
    }
}
