//! The input and output of a frame: its times, and a report.

/// The times of a frame, on the monotonic clock of the sensors' timestamps where the platform has one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameTiming {
    /// The present time in nanoseconds.
    pub now_ns: i64,
    /// The time at which the frame is expected to be seen, in nanoseconds.
    pub expected_display_ns: i64,
    /// Refresh rate of the display in Hz; 0 if unknown.
    pub refresh_hz: f32,
}

/// The state of the scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SceneState {
    /// Being loaded or generated; a progress bar is shown.
    #[default]
    Loading,
    /// Shown.
    Ready,
    /// Cannot be loaded. The reason is shown to the user, and returned by [`Viewer::failure`](crate::Viewer::failure).
    Failed,
}

/// A report on a presented frame, which tells the platform what to do next.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PresentReport {
    /// The state of the scene.
    pub scene: SceneState,
    /// Number of the display's refreshes by which this frame was late.
    pub late_refreshes: u32,
    /// GPU time in milliseconds of a frame a few frames ago, if it is measured.
    pub gpu_ms: Option<f32>,
    /// A second has passed: collect a [`DeviceState`](yoro_settings::telemetry::DeviceState) and call
    /// [`Viewer::telemetry`](crate::Viewer::telemetry).
    pub telemetry_due: bool,
    /// The session's `duration` has passed since the scene was first shown, and its questions are answered: log
    /// [`Viewer::summary`](crate::Viewer::summary) and end the program, or configure a longer `duration`. True in only one
    /// report.
    pub session_over: bool,
}
