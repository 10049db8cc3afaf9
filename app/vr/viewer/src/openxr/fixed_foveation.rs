//! The runtime's own foveation of the eyes' images (XR_FB_foveation): for the pass that composes their levels.
//!
//! A compositor's density on one image suits no pass that writes depth or is synthesized from, so it is off while whole
//! eyes are drawn. Composed levels have fewer pixels at the border anyway.

use glow::HasContext;
use openxr as xr;
use xr::sys;

use super::error::{XrError, call, check, optional};
use super::graphics::make_current;
use super::images::EyeImages;
use yoro::eyes::FoveationLevel;
use yoro_context::Graphics;
use yoro_gl::Context;

/// The extension of OpenGL ES that a runtime's foveation of its images needs.
const GL_EXTENSION: &str = "GL_QCOM_texture_foveated";

/// Enables the extensions if all of them are offered.
pub(super) fn enable(offered: &xr::ExtensionSet, enabled: &mut xr::ExtensionSet) {
    let all = offered.fb_foveation && offered.fb_foveation_configuration && offered.fb_swapchain_update_state;
    enabled.fb_foveation = all;
    enabled.fb_foveation_configuration = all;
    enabled.fb_swapchain_update_state = all;
}

/// Returns the flags for images whose density can change; `None` if the runtime has no foveation.
pub(super) fn flags(
    session: &xr::Session<xr::OpenGlEs>,
    gl: &Context,
) -> Option<sys::SwapchainCreateFoveationFlagsFB> {
    session.instance().exts().fb_foveation.as_ref()?;
    // Without the flag, which needs the extension, the runtime chooses the means, or has none.
    let has_extension = gl.raw().supported_extensions().contains(GL_EXTENSION);
    let scaled = sys::SwapchainCreateFoveationFlagsFB::SCALED_BIN;
    Some(if has_extension { scaled } else { sys::SwapchainCreateFoveationFlagsFB::EMPTY })
}

/// The density of the eyes' images.
pub(super) struct FixedFoveation {
    /// The level that was set last.
    level: FoveationLevel,
    /// True after the runtime has refused a level.
    is_refused: bool,
}

impl FixedFoveation {
    /// Returns the density of new images, which is full; `None` if the runtime has no foveation.
    pub fn new(session: &xr::Session<xr::OpenGlEs>) -> Option<FixedFoveation> {
        session.instance().exts().fb_foveation.as_ref()?;
        Some(FixedFoveation { level: FoveationLevel::Off, is_refused: false })
    }

    /// Sets the density, if it changes. A runtime that refuses it is not asked again.
    pub fn set(
        &mut self,
        graphics: &dyn Graphics,
        session: &xr::Session<xr::OpenGlEs>,
        eyes: &EyeImages,
        level: FoveationLevel,
    ) -> Result<(), XrError> {
        if self.is_refused || level == self.level {
            return Ok(());
        }
        self.level = level;
        let set = apply(graphics, session, eyes, level);
        if optional("the runtime's own foveation is not used", set)?.is_none() {
            self.is_refused = true;
            // One of two swapchains may have taken it, and whole eyes need full density.
            let _ = apply(graphics, session, eyes, FoveationLevel::Off);
        }
        Ok(())
    }
}

/// Calls xrCreateFoveationProfileFB, and xrUpdateSwapchainFB for each of the eyes' swapchains.
fn apply(
    graphics: &dyn Graphics,
    session: &xr::Session<xr::OpenGlEs>,
    eyes: &EyeImages,
    level: FoveationLevel,
) -> Result<(), XrError> {
    let level = match level {
        FoveationLevel::Off => xr::FoveationLevelFB::NONE,
        FoveationLevel::Low => xr::FoveationLevelFB::LOW,
        FoveationLevel::Medium => xr::FoveationLevelFB::MEDIUM,
        FoveationLevel::High => xr::FoveationLevelFB::HIGH,
    };
    let dynamic = xr::FoveationDynamicFB::DISABLED;
    let profile = xr::FoveationLevelProfile { level, vertical_offset: 0.0, dynamic };
    let profile = session.create_foveation_profile(Some(profile));
    make_current(graphics)?;
    let profile = call("xrCreateFoveationProfileFB", profile)?;
    let Some(update) = &session.instance().exts().fb_swapchain_update_state else { return Ok(()) };
    let state = sys::SwapchainStateFoveationFB {
        ty: sys::SwapchainStateFoveationFB::TYPE,
        next: std::ptr::null_mut(),
        flags: sys::SwapchainStateFoveationFlagsFB::EMPTY,
        profile: profile.as_raw(),
    };
    eyes.swapchains().try_for_each(|swapchain| {
        // SAFETY: the swapchain and the profile are live, and the structure states its type.
        let result = unsafe { (update.update_swapchain)(swapchain, std::ptr::from_ref(&state).cast()) };
        make_current(graphics)?;
        check("xrUpdateSwapchainFB", result).map(drop)
    })
}
