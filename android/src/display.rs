//! On what the eyes look.

use std::path::PathBuf;

use yoro_context::android::WindowError;
use yoro_protocol::Settings;
use yoro_viewer::openxr::{Headset, XrError};
use yoro_viewer::{Cardboard, Viewer, ViewerError};

/// On what the eyes look; it owns the application that draws there.
#[derive(Default)]
pub enum Display {
    /// Nothing yet.
    #[default]
    None,
    /// The phone's screen, behind lenses.
    Cardboard(Box<Cardboard>),
    /// What a runtime of OpenXR drives.
    Headset(Box<Headset>),
}

impl Display {
    /// The application, on whatever it is shown.
    pub fn viewer(&self) -> Option<&Viewer> {
        match self {
            Display::None => None,
            Display::Cardboard(cardboard) => Some(cardboard.viewer()),
            Display::Headset(headset) => Some(headset.viewer()),
        }
    }

    /// The application, for telemetry.
    pub fn viewer_mut(&mut self) -> Option<&mut Viewer> {
        match self {
            Display::None => None,
            Display::Cardboard(cardboard) => Some(cardboard.viewer_mut()),
            Display::Headset(headset) => Some(headset.viewer_mut()),
        }
    }

    /// The phone behind lenses, if that is what it is.
    pub fn cardboard(&self) -> Option<&Cardboard> {
        match self {
            Display::Cardboard(cardboard) => Some(cardboard),
            Display::None | Display::Headset(_) => None,
        }
    }

    /// As [`Display::cardboard`].
    pub fn cardboard_mut(&mut self) -> Option<&mut Cardboard> {
        match self {
            Display::Cardboard(cardboard) => Some(cardboard),
            Display::None | Display::Headset(_) => None,
        }
    }

    /// Whether a runtime of OpenXR says when to draw, and where.
    pub fn is_headset(&self) -> bool {
        matches!(self, Display::Headset(_))
    }

    /// Takes over other settings.
    ///
    /// # Errors
    /// As [`Cardboard::configure`]; the settings before stay.
    pub fn configure(&mut self, settings: Settings, folders: &[PathBuf]) -> Result<(), ViewerError> {
        match self {
            Display::None => Ok(()),
            Display::Cardboard(cardboard) => cardboard.configure(settings, folders),
            Display::Headset(headset) => headset.viewer_mut().configure(settings, folders),
        }
    }
}

/// Why there is nothing to see.
#[derive(Debug, thiserror::Error)]
pub enum DisplayError {
    /// The window.
    #[error(transparent)]
    Window(#[from] WindowError),
    /// The application.
    #[error(transparent)]
    Viewer(#[from] ViewerError),
    /// The headset.
    #[error(transparent)]
    Xr(#[from] XrError),
}
