//! Frames: from the loaded scene to the frame's report, and a log line every second.

use glam::Vec3;

use super::{Attached, Viewer};
use crate::caption::Status;
use crate::error::ViewerError;
use crate::frame::{FrameTiming, PresentReport, SceneState};
use yoro::choice::Cost;
use yoro::eyes::{EyePair, Gaze, StereoViews};
use yoro_lenses::{Content, Panel, Placement};
use yoro_render::stereo::{Auto, FrameLoad, FrameReport, FrameTargets, StereoFrame, StereoSession};
use yoro_settings::telemetry::{DeviceState, Line, Rating, SessionSummary};

/// The sizes of the eyes' images are multiples of this many pixels, so that small changes need no new targets.
const SIZE_STEP: f32 = 16.0;
/// The background while no scene is shown.
const BACKDROP: [f32; 4] = [0.03, 0.035, 0.05, 1.0];

impl Viewer {
    /// Begins a frame. If a scene has finished loading, it is shown from this frame on.
    pub fn begin(&mut self, timing: &FrameTiming) {
        self.now_ns = timing.now_ns;
        self.refresh_hz = timing.refresh_hz;
        self.poll_scene();
        if self.scene_state() == SceneState::Ready
            && let Some(text) = std::mem::take(&mut self.start.hint).text(self.synthesized_eye())
        {
            self.caption.announce(text, self.now_ns);
        }
    }

    /// Returns what a pair of eyes sees with the settings' foveation. `axes` are the directions in the world along which the
    /// eyes look: [`EyePair::axes`] of the display's own eyes.
    pub fn stereo_views(&self, pair: &EyePair, axes: [Vec3; 2]) -> StereoViews {
        let foveation = self.settings.foveation.unwrap_or_default().foveation();
        pair.stereo_views(foveation.as_ref(), Gaze::Axes(axes)).unwrap_or_else(|_| (*pair).into())
    }

    /// Renders both eyes, or only a backdrop until the scene is loaded. If neither eye can be synthesized from the
    /// other (canted eyes), both are rendered, whatever the method.
    ///
    /// # Errors
    /// [`ViewerError::NoContext`], [`ViewerError::Gl`], [`ViewerError::Stereo`].
    pub fn render(&mut self, views: &StereoViews, targets: FrameTargets) -> Result<FrameReport, ViewerError> {
        let gl = &self.attached.as_ref().ok_or(ViewerError::NoContext)?.gl;
        let Some(shown) = &mut self.scene.shown else {
            targets.fill(gl, views, BACKDROP)?;
            return Ok(FrameReport { has_depth: true, ..FrameReport::default() });
        };
        shown.move_on(self.now_ns)?;
        let session = self.session.as_mut().ok_or(ViewerError::NoContext)?;
        let report = session.frame(&mut shown.prepared, views, targets, self.load.take().as_ref())?;
        self.method.log_fallback(report.fallback.clone());
        Ok(report)
    }

    /// Returns the size in pixels that the dominant eye's texture must have to be rendered into, if it can be.
    pub fn rendered_size(&self, views: &StereoViews) -> Option<[u32; 2]> {
        let (session, shown) = self.session.as_ref().zip(self.scene.shown.as_ref())?;
        session.rendered_size(&shown.prepared, views)
    }

    /// Says whether the display's runtime makes the frames between those that are rendered, from colour, depth and motion
    /// vectors.
    ///
    /// # Errors
    /// [`ViewerError::Gl`] if the method cannot be compiled for this.
    pub fn set_runtime_features(&mut self, makes_frames: bool) -> Result<(), ViewerError> {
        if std::mem::replace(&mut self.method.runtime_makes_frames, makes_frames) != makes_frames {
            self.make_session()?;
        }
        Ok(())
    }

    /// Says that the display refreshes at another rate from now on.
    pub fn set_display_rate(&mut self, hz: f32) {
        self.display_hz = hz;
    }

    /// True if the display's runtime is to make every second frame.
    pub fn uses_runtime_frame_synthesis(&self) -> bool {
        self.session.as_ref().is_some_and(StereoSession::uses_runtime_frame_synthesis)
    }

    /// Returns the HUD of this frame, if it is to be shown.
    ///
    /// # Errors
    /// [`ViewerError::NoContext`].
    pub fn hud(&mut self) -> Result<Option<Panel<'_>>, ViewerError> {
        self.write_caption();
        let is_shown = self.scene_state() == SceneState::Ready;
        let is_loading = self.is_loading();
        let attached = self.attached.as_mut().ok_or(ViewerError::NoContext)?;
        let text = self.caption.text.as_str();
        if let Some(question) = self.stats.question() {
            let progress = Some(question.position());
            return Ok(Some(attached.hud.set(Content { text, progress }, Placement::Middle)));
        }
        let is_empty = !is_shown;
        if !is_empty && !self.caption.is_in_view(self.now_ns) {
            return Ok(None);
        }
        // Back and forth once every two seconds.
        let phase = (self.now_ns.rem_euclid(2_000_000_000)) as f32 * 1e-9;
        let progress = (is_empty && is_loading).then_some(1.0 - (1.0 - phase).abs());
        let placement = if is_empty { Placement::Middle } else { Placement::Below };
        Ok(Some(attached.hud.set(Content { text, progress }, placement)))
    }

    /// Draws the HUD and the menu over both eyes of a frame.
    ///
    /// # Errors
    /// [`ViewerError::NoContext`].
    pub(crate) fn draw_panels(&mut self, pair: &EyePair, frame: &StereoFrame) -> Result<(), ViewerError> {
        let colors = frame.colors();
        if let Some(panel) = self.hud()? {
            panel.draw_into_eyes(pair, &colors);
        }
        self.draw_menu(pair, &colors);
        Ok(())
    }

    /// Writes the text of the HUD.
    fn write_caption(&mut self) {
        if let Some(question) = self.stats.question() {
            return question.write(&mut self.caption.text);
        }
        if let Some(sentence) = &self.scene.failure {
            return self.caption.write_sentence(sentence);
        }
        let status = Status {
            frames: self.stats.last_line.as_ref(),
            celsius: self.stats.celsius,
            method: self.method_name(),
            auto: self.session.as_ref().and_then(StereoSession::auto),
            pipeline: self.pipeline_name(),
            loading: self.scene.is_loading().then_some(self.scene.name.as_str()),
        };
        self.caption.write_status(&status, self.now_ns);
    }

    /// Ends a frame that was handed to the display.
    ///
    /// # Errors
    /// [`ViewerError::NoContext`], and [`ViewerError::Gl`] if a method cannot be recompiled for another quality.
    pub fn end(&mut self, timing: &FrameTiming) -> Result<PresentReport, ViewerError> {
        let &FrameTiming { now_ns, mut refresh_hz, .. } = timing;
        self.now_ns = now_ns;
        // While a runtime makes every second frame, it may give the period of the display or that of the renders.
        if self.uses_runtime_frame_synthesis() {
            self.display_hz = self.display_hz.max(refresh_hz);
            refresh_hz = self.display_hz / 2.0;
        } else {
            self.display_hz = refresh_hz;
        }
        let Attached { gl, pass_times, .. } = self.attached.as_mut().ok_or(ViewerError::NoContext)?;
        pass_times.clear();
        let timed = gl.end_timed_frame(pass_times);
        let gpu = timed.map(|frames_ago| Cost {
            frames_ago,
            ms: pass_times.iter().map(|pass| pass.time.as_secs_f32() * 1e3).sum(),
        });
        let gpu_ms = gpu.map(|gpu| gpu.ms);
        let late_refreshes = self.stats.frame(now_ns, refresh_hz, pass_times, u32::from(timed.is_some()));
        let scene = self.scene_state();
        let load = FrameLoad {
            ended_ns: now_ns,
            refresh_hz,
            display_hz: self.display_hz,
            late_refreshes,
            gpu,
            thermal_headroom: self.thermal_headroom,
        };
        if scene == SceneState::Ready {
            self.load = Some(load);
            self.method.is_mixed |= self.auto().is_some_and(Auto::is_measuring);
            self.adapt(&load)?;
        }
        let session_over = !self.stats.is_over && self.stats.is_time_up(&self.settings, now_ns) && self.ask();
        self.stats.is_over |= session_over;
        Ok(PresentReport {
            scene,
            late_refreshes,
            gpu_ms,
            telemetry_due: self.stats.telemetry.is_due(now_ns),
            session_over,
        })
    }

    /// Lets the controller judge a frame with the setting `adaptive`, except while methods are being measured, since all
    /// have to have the same size. A change of the ImBuffer compiles the method again; the controller keeps this rare.
    fn adapt(&mut self, load: &FrameLoad) -> Result<(), ViewerError> {
        if !self.settings.adaptive {
            return Ok(());
        }
        if self.auto().is_some_and(Auto::is_measuring) {
            self.controller.restart();
            return Ok(());
        }
        let previous = self.controller.quality().imbuffer;
        if self.controller.frame(load).imbuffer != previous && self.imbuffer_divisor().is_some() {
            self.make_session()?;
        }
        Ok(())
    }

    /// Ends a second and returns its log line. Call it when a [`PresentReport`] asks for it, with the device's present
    /// state.
    pub fn telemetry(&mut self, now_ns: i64, device: &DeviceState) -> Line {
        self.thermal_headroom = device.thermal_headroom;
        let state = self.state();
        self.method.is_mixed = false;
        self.stats.line(now_ns, state, device)
    }

    /// Returns the viewer's own part of a log line.
    pub(super) fn state(&self) -> Line {
        Line {
            method: self.method_name().to_owned(),
            pipeline: self.pipeline_name().map(str::to_owned),
            scene: self.scene_name().to_owned(),
            render_scale: self.render_scale().into(),
            imbuffer: self.imbuffer_divisor(),
            run: self.settings.run.clone(),
            auto: self
                .auto()
                .map(|auto| if self.method.is_mixed { "measuring".into() } else { auto.to_string() }),
            ..Line::default()
        }
    }

    fn method_name(&self) -> &'static str {
        self.rendering_method().name()
    }

    /// Returns the summary of the session since the scene was first shown, for the log.
    pub fn summary(&self, now_ns: i64) -> SessionSummary {
        self.stats.telemetry.summary(now_ns)
    }

    /// Returns the answers so far to the settings' questions; each is logged when it is given.
    pub fn ratings(&self) -> &[Rating] {
        &self.stats.ratings
    }

    /// Returns the size in pixels of each eye's image on a display whose full size is `full`.
    pub fn eye_size(&self, full: [f32; 2]) -> [u32; 2] {
        // Methods also render a guard band beside the image.
        let limit = self.attached.as_ref().map_or(4096, |g| g.gl.capabilities().max_texture_size) / 2;
        let steps = |pixels: f32| (pixels * self.render_scale() / SIZE_STEP).round().max(4.0) * SIZE_STEP;
        full.map(|n| (steps(n) as u32).min(limit))
    }

    fn render_scale(&self) -> f32 {
        self.settings.render_scale * self.controller.quality().render_scale
    }
}
