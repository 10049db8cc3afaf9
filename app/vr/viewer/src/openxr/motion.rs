//! Motion vectors for runtimes that make frames between those that are rendered (XR_EXT_frame_synthesis,
//! XR_FB_space_warp).

use std::ffi::c_void;
use std::rc::Rc;

use openxr as xr;
use xr::sys;

use super::error::{XrError, check, optional};
use super::images::{EyeImages, ImageSpec};
use super::storage;
use yoro::eyes::{DepthConvention, DepthRange, Eye, EyePair, Ndc, Pose};
use yoro_context::Graphics;
use yoro_gl::Context;
use yoro_render::stereo::{EyeTarget, MotionTarget};

/// How a runtime takes motion vectors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Extension {
    FrameSynthesis,
    SpaceWarp,
}

/// The last frame that vectors point to.
#[derive(Clone, Copy)]
struct PreviousFrame {
    /// The eyes in the scene.
    eyes: EyePair,
    /// The place of the user's straight ahead in the scene. If it changes, the user has jumped.
    place: Pose,
}

/// The runtime's images for vectors and their depth.
pub(super) struct MotionImages {
    extension: Extension,
    vectors: EyeImages,
    depth: EyeImages,
    size: [u32; 2],
    previous: Option<PreviousFrame>,
}

/// The structure that tells a runtime of a view's vectors, chained to the view.
#[derive(Clone, Copy)]
pub(super) enum MotionInfo {
    FrameSynthesis(sys::FrameSynthesisInfoEXT),
    SpaceWarp(sys::CompositionLayerSpaceWarpInfoFB),
}

impl MotionInfo {
    /// Returns the structure.
    pub fn header(&self) -> *const c_void {
        match self {
            MotionInfo::FrameSynthesis(info) => std::ptr::from_ref(info).cast(),
            MotionInfo::SpaceWarp(info) => std::ptr::from_ref(info).cast(),
        }
    }
}

/// Enables what the runtime offers of the two extensions: one of them.
pub(super) fn enable(offered: &xr::ExtensionSet, enabled: &mut xr::ExtensionSet) {
    enabled.ext_frame_synthesis = offered.ext_frame_synthesis;
    enabled.fb_space_warp = offered.fb_space_warp && !offered.ext_frame_synthesis;
}

impl MotionImages {
    /// Makes the images for two views, if the runtime makes frames. One sentence is logged if they cannot be made.
    pub fn new(
        graphics: &dyn Graphics,
        gl: &Rc<Context>,
        session: &xr::Session<xr::OpenGlEs>,
        system: xr::SystemId,
        formats: &[u32],
    ) -> Result<Option<MotionImages>, XrError> {
        const WHAT: &str = "the runtime makes no frames";
        let extensions = session.instance().exts();
        let (extension, size) = if extensions.ext_frame_synthesis.is_some() {
            (Extension::FrameSynthesis, frame_synthesis_size(session.instance(), system))
        } else if extensions.fb_space_warp.is_some() {
            (Extension::SpaceWarp, space_warp_size(session.instance(), system))
        } else {
            return Ok(None);
        };
        let Some(size) = optional(WHAT, size)? else { return Ok(None) };
        let vectors = storage::choose(&[glow::RGBA16F], formats);
        let depth = storage::choose(&storage::DEPTH_FORMATS, formats);
        let (Some(vectors), Some(depth), false) = (vectors, depth, size.contains(&0)) else {
            log::info!("{WHAT}: it takes no motion vectors in a format of OpenGL ES");
            return Ok(None);
        };
        let images = |format, is_depth| {
            let spec = ImageSpec { format, is_depth, is_sampled: true, size, foveation: None };
            EyeImages::new(graphics, gl, session, spec)
        };
        let made = images(vectors, false).and_then(|vectors| Ok((vectors, images(depth, true)?)));
        let made = optional(WHAT, made)?;
        Ok(made.map(|(vectors, depth)| MotionImages { extension, vectors, depth, size, previous: None }))
    }

    /// Returns the extension's name.
    pub fn extension(&self) -> &'static str {
        match self.extension {
            Extension::FrameSynthesis => "XR_EXT_frame_synthesis",
            Extension::SpaceWarp => "XR_FB_space_warp",
        }
    }

    pub fn acquire(&mut self, graphics: &dyn Graphics) -> Result<(), XrError> {
        self.vectors.acquire(graphics)?;
        self.depth.acquire(graphics)
    }

    pub fn release(&mut self, graphics: &dyn Graphics) -> Result<(), XrError> {
        self.vectors.release(graphics)?;
        self.depth.release(graphics)
    }

    /// Returns targets that also receive vectors since the last frame; without, if there was none, or if the user has
    /// jumped since. `place` is that of the user's straight ahead in the scene.
    pub fn targets<'a>(
        &mut self,
        gl: &Rc<Context>,
        eyes: [EyeTarget<'a>; 2],
        place: Pose,
    ) -> Result<[EyeTarget<'a>; 2], XrError> {
        let previous = self.previous.filter(|previous| previous.place == place);
        let images = self.vectors.with_depth(gl, &self.depth, self.size)?;
        let Some((previous, images)) = previous.zip(images) else { return Ok(eyes) };
        // XR_EXT_frame_synthesis has one convention for z, XR_FB_space_warp that of the graphics interface. The direction of y is
        // open. On OpenGL ES, all runtimes on which Godot tried the former take it upwards, as it is here; on Vulkan, Android
        // XR's takes it downwards, Meta's and Pico's upwards (Godot's pull request 119056).
        let ndc = match self.extension {
            Extension::FrameSynthesis => Ndc::ZeroToOne,
            Extension::SpaceWarp => Ndc::MinusOneToOne,
        };
        Ok(Eye::BOTH.map(|eye| {
            let motion = MotionTarget { to: images[eye.index()], previous: previous.eyes.view(eye), ndc };
            EyeTarget { motion: Some(motion), ..eyes[eye.index()] }
        }))
    }

    /// Remembers the eyes of a frame in the scene; `None` if the next one must not be compared with it.
    pub fn remember(&mut self, frame: Option<(EyePair, Pose)>) {
        self.previous = frame.map(|(eyes, place)| PreviousFrame { eyes, place });
    }

    /// Returns the structure for an eye's vectors, whose depth is of this range. If this frame has no vectors, the structure
    /// says that no frame is to be made of it; XR_EXT_frame_synthesis says so by having none.
    pub fn info(&self, eye: Eye, range: &DepthRange, has_motion: bool) -> Option<MotionInfo> {
        use sys::CompositionLayerSpaceWarpInfoFlagsFB as SpaceWarpFlags;
        if !has_motion && self.extension == Extension::FrameSynthesis {
            return None;
        }
        let [near_z, far_z] = ends(range);
        let motion_vector_sub_image = self.vectors.sub_image(eye, [0, 0], self.size);
        let depth_sub_image = self.depth.sub_image(eye, [0, 0], self.size);
        // The user's jumps are not extrapolated at all.
        let app_space_delta_pose = xr::Posef::IDENTITY;
        let next = std::ptr::null();
        let (min_depth, max_depth) = (0.0, 1.0);
        Some(match self.extension {
            Extension::FrameSynthesis => MotionInfo::FrameSynthesis(sys::FrameSynthesisInfoEXT {
                ty: sys::FrameSynthesisInfoEXT::TYPE,
                next,
                layer_flags: sys::FrameSynthesisInfoFlagsEXT::REQUEST_RELAXED_FRAME_INTERVAL,
                motion_vector_sub_image,
                motion_vector_scale: xr::Vector4f { x: 1.0, y: 1.0, z: 1.0, w: 1.0 },
                motion_vector_offset: xr::Vector4f { x: 0.0, y: 0.0, z: 0.0, w: 0.0 },
                app_space_delta_pose,
                depth_sub_image,
                min_depth,
                max_depth,
                near_z,
                far_z,
            }),
            Extension::SpaceWarp => MotionInfo::SpaceWarp(sys::CompositionLayerSpaceWarpInfoFB {
                ty: sys::CompositionLayerSpaceWarpInfoFB::TYPE,
                next,
                layer_flags: if has_motion { SpaceWarpFlags::EMPTY } else { SpaceWarpFlags::FRAME_SKIP },
                motion_vector_sub_image,
                app_space_delta_pose,
                depth_sub_image,
                min_depth,
                max_depth,
                near_z,
                far_z,
            }),
        })
    }

    /// Deletes the framebuffers, after which nothing can be drawn.
    pub fn close(&mut self) {
        self.vectors.close();
        self.depth.close();
    }
}

/// Returns the distances in metres that depth 0 and depth 1 stand for.
pub(super) fn ends(&DepthRange { near, far, convention }: &DepthRange) -> [f32; 2] {
    match convention {
        DepthConvention::Standard => [near, far],
        DepthConvention::Reversed => [far, near],
    }
}

/// Asks for the size of vectors by XR_EXT_frame_synthesis: one that suits both eyes.
fn frame_synthesis_size(instance: &xr::Instance, system: xr::SystemId) -> Result<[u32; 2], XrError> {
    let mut sizes = [sys::FrameSynthesisConfigViewEXT {
        ty: sys::FrameSynthesisConfigViewEXT::TYPE,
        next: std::ptr::null_mut(),
        recommended_motion_vector_image_rect_width: 0,
        recommended_motion_vector_image_rect_height: 0,
    }; 2];
    let mut views = sizes.each_mut().map(|size| sys::ViewConfigurationView {
        ty: sys::ViewConfigurationView::TYPE,
        next: std::ptr::from_mut(size).cast(),
        recommended_image_rect_width: 0,
        max_image_rect_width: 0,
        recommended_image_rect_height: 0,
        max_image_rect_height: 0,
        recommended_swapchain_sample_count: 0,
        max_swapchain_sample_count: 0,
    });
    let mut count = 0;
    // SAFETY: a live instance, and room for two views, to each of which a structure is chained.
    let result = unsafe {
        (instance.fp().enumerate_view_configuration_views)(
            instance.as_raw(),
            system,
            xr::ViewConfigurationType::PRIMARY_STEREO,
            views.len() as u32,
            &mut count,
            views.as_mut_ptr(),
        )
    };
    check("xrEnumerateViewConfigurationViews", result)?;
    Ok(sizes.iter().fold([0, 0], |[w, h], size| {
        [
            w.max(size.recommended_motion_vector_image_rect_width),
            h.max(size.recommended_motion_vector_image_rect_height),
        ]
    }))
}

/// Asks for the size of vectors by XR_FB_space_warp.
fn space_warp_size(instance: &xr::Instance, system: xr::SystemId) -> Result<[u32; 2], XrError> {
    let mut size = sys::SystemSpaceWarpPropertiesFB {
        ty: sys::SystemSpaceWarpPropertiesFB::TYPE,
        next: std::ptr::null_mut(),
        recommended_motion_vector_image_rect_width: 0,
        recommended_motion_vector_image_rect_height: 0,
    };
    // SAFETY: plain numbers, for which zeros are valid.
    let mut properties = unsafe { std::mem::zeroed::<sys::SystemProperties>() };
    properties.ty = sys::SystemProperties::TYPE;
    properties.next = std::ptr::from_mut(&mut size).cast();
    // SAFETY: a live instance, and a structure to which one of the extension is chained.
    let result = unsafe { (instance.fp().get_system_properties)(instance.as_raw(), system, &mut properties) };
    check("xrGetSystemProperties", result)?;
    Ok([size.recommended_motion_vector_image_rect_width, size.recommended_motion_vector_image_rect_height])
}
