//! The display in use; the phone's own screen, and the performance that it asks for.

mod performance;
mod screen;

use std::path::PathBuf;

use yoro_context::android::WindowError;
use yoro_settings::Settings;
use yoro_viewer::openxr::{Headset, XrError};
use yoro_viewer::{Cardboard, Viewer, ViewerError};

pub use performance::Performance;
pub use screen::ScreenState;

/// The display in use. It owns the application that draws on it.
#[derive(Default)]
pub enum Display {
    /// No display was chosen yet.
    #[default]
    None,
    /// The phone's screen, behind lenses.
    Cardboard(Box<Cardboard>),
    /// A headset, driven by an OpenXR runtime.
    Headset(Box<Headset>),
}

impl Display {
    /// Returns the application, on either display.
    pub fn viewer(&self) -> Option<&Viewer> {
        match self {
            Display::None => None,
            Display::Cardboard(cardboard) => Some(cardboard.viewer()),
            Display::Headset(headset) => Some(headset.viewer()),
        }
    }

    /// Returns the application, on either display.
    pub fn viewer_mut(&mut self) -> Option<&mut Viewer> {
        match self {
            Display::None => None,
            Display::Cardboard(cardboard) => Some(cardboard.viewer_mut()),
            Display::Headset(headset) => Some(headset.viewer_mut()),
        }
    }

    /// Returns the phone behind lenses, if the display is one.
    pub fn cardboard(&self) -> Option<&Cardboard> {
        match self {
            Display::Cardboard(cardboard) => Some(cardboard),
            Display::None | Display::Headset(_) => None,
        }
    }

    /// Returns the phone behind lenses, if the display is one.
    pub fn cardboard_mut(&mut self) -> Option<&mut Cardboard> {
        match self {
            Display::Cardboard(cardboard) => Some(cardboard),
            Display::None | Display::Headset(_) => None,
        }
    }

    /// True if an OpenXR runtime decides when and where to draw.
    pub fn is_headset(&self) -> bool {
        matches!(self, Display::Headset(_))
    }

    /// Applies other settings.
    ///
    /// # Errors
    /// Those of [`Cardboard::configure`]; the previous settings stay.
    pub fn configure(&mut self, settings: Settings, folders: &[PathBuf]) -> Result<(), ViewerError> {
        match self {
            Display::None => Ok(()),
            Display::Cardboard(cardboard) => cardboard.configure(settings, folders),
            Display::Headset(headset) => headset.viewer_mut().configure(settings, folders),
        }
    }
}

/// A reason why nothing can be shown.
#[derive(Debug, thiserror::Error)]
pub enum DisplayError {
    /// The window cannot be used.
    #[error(transparent)]
    Window(#[from] WindowError),
    /// The application has failed.
    #[error(transparent)]
    Viewer(#[from] ViewerError),
    /// The headset has failed.
    #[error(transparent)]
    Xr(#[from] XrError),
}
