//! A session with everything that belongs to it.

use std::rc::Rc;

use openxr as xr;

use crate::error::ViewerError;
use crate::event::Event;
use crate::openxr::description::{Description, Frame};
use crate::openxr::error::{XrError, call};
use crate::openxr::fixed_foveation::FixedFoveation;
use crate::openxr::images::{EyeImages, Images};
use crate::openxr::input::Input;
use crate::openxr::mask::Mask;
use crate::openxr::motion::MotionImages;
use crate::openxr::storage::Storage;
use yoro::eyes::EyesError;
use yoro_context::Graphics;
use yoro_gl::Context;
use yoro_render::DepthCopy;
use yoro_settings::Performance;

/// The result of [`Session::step`].
pub enum Progress {
    Idle,
    Frame(Frame),
    Ended,
}

/// The HUD's own images.
pub struct PanelImages {
    pub images: Images,
    /// The version of the panel that the images show: [`Panel::version`](yoro_lenses::Panel::version).
    pub version: Option<u64>,
}

/// The runtime's images of a level of the eyes: of all that they see, or of their insets.
pub struct RuntimeLevel {
    pub eyes: EyeImages,
    /// Depth for the runtime, if it takes any.
    pub depth: Option<EyeImages>,
    /// The size in pixels that the runtime recommends for each eye.
    pub recommended: [u32; 2],
    /// The size in pixels of the images of a whole eye, and the largest possible one.
    pub size: [u32; 2],
    pub largest: [u32; 2],
}

impl RuntimeLevel {
    pub(super) fn acquire(&mut self, graphics: &dyn Graphics) -> Result<(), XrError> {
        self.all().try_for_each(|images| images.acquire(graphics))
    }

    pub(super) fn release(&mut self, graphics: &dyn Graphics) -> Result<(), XrError> {
        self.all().try_for_each(|images| images.release(graphics))
    }

    fn all(&mut self) -> impl Iterator<Item = &mut EyeImages> {
        [Some(&mut self.eyes), self.depth.as_mut()].into_iter().flatten()
    }
}

/// The spaces that poses are relative to.
pub struct Spaces {
    /// The head.
    pub head: xr::Space,
    /// The runtime's reference space.
    pub base: xr::Space,
    /// The reference space turned to the user's straight ahead.
    pub ahead: xr::Space,
}

/// One session, from xrCreateInstance to the last frame. The field order is the drop order: owners of framebuffers
/// before the images, and the images before the session.
pub struct Session {
    pub(super) storage: Storage,
    pub(super) mask: Option<Mask>,
    /// `None` if the runtime has no foveation of its own.
    pub(super) fixed_foveation: Option<FixedFoveation>,
    pub(super) depth_copy: Option<DepthCopy>,
    /// `None` unless the runtime makes frames.
    pub(super) motion: Option<MotionImages>,
    pub(super) wide: RuntimeLevel,
    /// The insets, which the runtime composes with the wide views.
    pub(super) inset: Option<RuntimeLevel>,
    pub(super) panel: Option<PanelImages>,
    pub(super) input: Option<Input>,
    pub(super) spaces: Spaces,
    pub(super) waiter: xr::FrameWaiter,
    pub(super) stream: xr::FrameStream<xr::OpenGlEs>,
    pub(super) session: xr::Session<xr::OpenGlEs>,
    pub(super) instance: xr::Instance,

    pub(super) gl: Rc<Context>,
    pub(super) views: xr::ViewConfigurationType,
    pub(super) blend: xr::EnvironmentBlendMode,
    pub(super) state: xr::SessionState,
    /// True if the runtime wants frames.
    pub is_running: bool,
    /// The refresh rate and performance that were last requested through extensions.
    pub(super) applied: Option<(Option<f32>, Performance)>,
    /// The reason why the eyes are not rendered as the runtime locates them, if so.
    pub(super) realigned: Option<EyesError>,
    /// How often an eye's images were made for another size.
    pub(super) remade: u32,
    pub(super) recenter: bool,
    /// The user's actions, for the next frame.
    pub events: Vec<Event>,
    pub(super) last_error: String,
    pub description: Description,
}

impl Session {
    /// True if the runtime can make frames between those that are rendered.
    pub fn makes_frames(&self) -> bool {
        self.motion.is_some()
    }

    /// Asks the runtime to end the session.
    pub fn request_exit(&self) -> Result<(), XrError> {
        call("xrRequestExitSession", self.session.request_exit())
    }

    /// Returns the value of a viewer's call or logs its error, which is logged only once if it repeats in every frame.
    pub(super) fn log_error<T>(&mut self, result: Result<T, ViewerError>) -> Option<T> {
        match result {
            Ok(value) => Some(value),
            Err(error) => {
                let sentence = error.to_string();
                if sentence != self.last_error {
                    log::error!("{sentence}");
                    self.last_error = sentence;
                }
                None
            }
        }
    }

    /// Sets the user's straight ahead, relative to the runtime's.
    pub(super) fn set_space(&mut self, pose: xr::Posef) -> Result<(), XrError> {
        let space = self.session.create_reference_space(xr::ReferenceSpaceType::LOCAL, pose);
        if let Some(motion) = &mut self.motion {
            motion.remember(None);
        }
        self.spaces.ahead = call("xrCreateReferenceSpace", space)?;
        Ok(())
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        // After a swapchain is destroyed, the context may no longer be current, depending on the runtime.
        for level in [Some(&mut self.wide), self.inset.as_mut()].into_iter().flatten() {
            level.all().for_each(EyeImages::close);
        }
        if let Some(motion) = &mut self.motion {
            motion.close();
        }
        if let Some(panel) = &mut self.panel {
            panel.images.close();
        }
    }
}
