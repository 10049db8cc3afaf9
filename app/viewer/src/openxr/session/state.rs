//! A session with everything that belongs to it.

use std::rc::Rc;

use openxr as xr;

use crate::error::ViewerError;
use crate::event::Event;
use crate::openxr::description::{Description, Frame};
use crate::openxr::error::{XrError, call};
use crate::openxr::images::{EyeImages, Images};
use crate::openxr::input::Input;
use crate::openxr::mask::Mask;
use crate::openxr::storage::Storage;
use yoro::eyes::EyesError;
use yoro_gl::Context;
use yoro_protocol::Performance;
use yoro_render::DepthCopy;

/// The result of a step.
pub enum Progress {
    Idle,
    Frame(Frame),
    Ended,
}

/// The HUD's own images.
pub struct PanelImages {
    pub images: Images,
    /// The version of the panel that they show: [`Panel::version`](yoro_lenses::Panel::version).
    pub version: Option<u64>,
}

/// Depth of both eyes.
pub struct Depth {
    pub copy: DepthCopy,
    pub images: EyeImages,
    pub format: u32,
}

/// The spaces that poses are relative to.
pub struct Spaces {
    /// The head.
    pub head: xr::Space,
    /// The runtime's straight ahead.
    pub base: xr::Space,
    /// The user's straight ahead.
    pub ahead: xr::Space,
}

/// One session, from xrCreateInstance to the last frame. What has framebuffers goes before the images, and those before
/// the session.
pub struct Session {
    pub(super) storage: Storage,
    pub(super) mask: Option<Mask>,
    pub(super) depth: Option<Depth>,
    pub(super) eyes: EyeImages,
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
    pub(super) is_running: bool,
    /// The requests that were made by extensions.
    pub(super) applied: Option<(Option<f32>, Performance)>,
    /// The reason why the eyes are not rendered as the runtime locates them, if so.
    pub(super) realigned: Option<EyesError>,
    pub(super) recenter: bool,
    pub(super) events: Vec<Event>,
    pub(super) last_error: String,
    pub(super) description: Description,
}

impl Session {
    pub fn description(&self) -> &Description {
        &self.description
    }

    /// True if the runtime wants frames.
    pub fn is_running(&self) -> bool {
        self.is_running
    }

    /// Does what the user wants in the next frame.
    pub fn event(&mut self, event: Event) {
        self.events.push(event);
    }

    /// Asks the runtime to end the session.
    pub fn request_exit(&self) -> Result<(), XrError> {
        call("xrRequestExitSession", self.session.request_exit())
    }

    /// Returns the value of a call of the viewer, and logs its error, once if it comes with every frame.
    pub(super) fn told<T>(&mut self, result: Result<T, ViewerError>) -> Option<T> {
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

    /// Sets where straight ahead is, relative to where the runtime has it.
    pub(super) fn set_space(&mut self, pose: xr::Posef) -> Result<(), XrError> {
        let space = self.session.create_reference_space(xr::ReferenceSpaceType::LOCAL, pose);
        self.spaces.ahead = call("xrCreateReferenceSpace", space)?;
        Ok(())
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        // Whether the context is still current after a swapchain is destroyed is up to the runtime.
        self.eyes.close();
        if let Some(depth) = &mut self.depth {
            depth.images.close();
        }
        if let Some(panel) = &mut self.panel {
            panel.images.close();
        }
    }
}
