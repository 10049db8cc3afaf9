//! The phone's screen as Android describes it.

use yoro_lenses::{Rotation, Screen};

use crate::platform::java::{DisplayMetrics, Java};

/// The screen as Android last described it.
pub struct ScreenState {
    metrics: Option<DisplayMetrics>,
    /// Refresh rate in Hz; 0 if unknown.
    pub refresh_hz: f32,
    /// True if Android has changed something since then.
    pub is_stale: bool,
}

impl ScreenState {
    /// Creates a state in which nothing is known yet.
    pub fn new() -> ScreenState {
        ScreenState { metrics: None, refresh_hz: 0.0, is_stale: true }
    }

    /// Returns the pixels per inch along the picture's width; 0 if unknown.
    pub fn dpi(&self) -> f32 {
        self.metrics.as_ref().map_or(0.0, |metrics| dpi(metrics)[0])
    }

    /// Returns the picture's rotation.
    pub fn rotation(&self) -> Rotation {
        self.metrics.as_ref().map_or_else(Rotation::default, |metrics| rotation(metrics.rotation))
    }

    /// Returns the screen of a window of this size.
    pub fn of_window(&mut self, size: [u32; 2], java: &Java) -> Screen {
        if std::mem::take(&mut self.is_stale) {
            self.metrics = java.display_metrics().or(self.metrics);
            if let Some(metrics) = &self.metrics {
                self.refresh_hz = metrics.refresh_hz;
            }
        }
        let dpi = self.metrics.as_ref().map_or([0.0; 2], dpi);
        Screen { size, dpi, rotation: self.rotation() }
    }
}

/// Returns the picture's pixels per inch. If the user has chosen a lower resolution, Android still reports those of the
/// display's mode, to which the picture is scaled up.
fn dpi(metrics: &DisplayMetrics) -> [f32; 2] {
    let longest = |size: [i32; 2]| size[0].max(size[1]) as f32;
    let scale = longest(metrics.size) / longest(metrics.mode);
    if scale.is_finite() && scale > 0.0 { metrics.dpi.map(|dpi| dpi * scale) } else { metrics.dpi }
}

/// Converts `Surface.ROTATION_*`, the picture's rotation relative to the device's natural orientation, which the
/// sensors' axes use: upright for phones, on the side for many tablets and for headsets.
fn rotation(surface_rotation: i32) -> Rotation {
    match surface_rotation {
        1 => Rotation::LandscapeLeft,
        3 => Rotation::LandscapeRight,
        _ => Rotation::Portrait,
    }
}
