//! Frames: from the loaded scene to the frame's report, and a log line every second.

use glam::Vec3;

use super::{Attached, Viewer};
use crate::adaptive::Load;
use crate::caption::Status;
use crate::error::ViewerError;
use crate::frame::{FrameReport, FrameTiming, SceneState};
use crate::options::stereo_options;
use yoro::choice::Cost;
use yoro::eyes::{EyePair, Gaze, StereoViews};
use yoro_lenses::{Content, Panel, Placement};
use yoro_render::stereo::{DepthTarget, EyeLevels, EyeTarget, LevelTargets};
use yoro_settings::telemetry::{DeviceState, Line, Rating, SessionSummary, ViewerState};

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

    /// Renders both eyes, or only a backdrop until the scene is loaded. If neither eye can be synthesized from the
    /// other (canted eyes), both are rendered, whatever the method.
    ///
    /// # Errors
    /// [`ViewerError::NoContext`], [`ViewerError::Gl`], [`ViewerError::Stereo`].
    pub fn render_eyes(&mut self, pair: &EyePair, to: &[EyeTarget; 2]) -> Result<(), ViewerError> {
        self.render_levels(&pair.into(), &to.into())
    }

    /// Returns the levels in which the settings' foveation renders a pair of eyes; `None` if it is rendered as a whole: by
    /// [`FoveationLevel::Off`](yoro::eyes::FoveationLevel::Off), and where neither eye can be synthesized from the other.
    /// `axes` are the directions in the world along which the eyes look: [`EyePair::axes`] of the display's own eyes.
    pub fn levels(&self, pair: &EyePair, axes: [Vec3; 2]) -> Option<StereoViews> {
        let foveation = self.settings.foveation.unwrap_or_default().foveation()?;
        let guard = stereo_options(&self.settings, self.method.pipeline()).guard_band;
        pair.levels(Some(&foveation), Gaze::Axes(axes), guard).ok().filter(|l| l.inset.is_some())
    }

    /// Renders both eyes of each level of a frame into their targets, like [`Viewer::render_eyes`]. Nobody composes them: a
    /// display does so in its last pass ([`LevelFrame::eye`](yoro_render::stereo::LevelFrame::eye)) or in one of its own
    /// ([`LevelFrame::compose`](yoro_render::stereo::LevelFrame::compose)), or its runtime does.
    ///
    /// # Errors
    /// Those of [`Viewer::render_eyes`].
    pub fn render_levels(&mut self, levels: &EyeLevels, to: &LevelTargets) -> Result<(), ViewerError> {
        let pair = &levels.shown;
        self.stats.look(pair.poses[pair.dominant.index()].orientation, self.now_ns);
        let gl = &self.attached.as_ref().ok_or(ViewerError::NoContext)?.gl;
        let Some(shown) = self.scene.shown() else {
            for EyeTarget { color, depth, .. } in to.pairs().flatten() {
                if let Some(DepthTarget { to, .. }) = depth {
                    gl.bind_framebuffer(to.framebuffer, to.origin, to.size);
                    gl.clear_rectangle(to.origin, to.size, Some(pair.depth.clear_value()));
                }
                gl.bind_framebuffer(color.framebuffer, color.origin, color.size);
                gl.fill(color.origin, color.size, BACKDROP);
            }
            return Ok(());
        };
        shown.move_on(self.now_ns)?;
        self.method.render(shown, levels, to)
    }

    /// Says what the display's runtime does: whether it makes the frames between those that are rendered, from colour, depth
    /// and motion vectors, and whether it shows insets.
    ///
    /// # Errors
    /// [`ViewerError::Gl`] if the method cannot be compiled for this.
    pub fn share_with_runtime(&mut self, makes_frames: bool, shows_insets: bool) -> Result<(), ViewerError> {
        if self.method.share_with_runtime(makes_frames, shows_insets) {
            self.make_method()?;
        }
        Ok(())
    }

    /// Says that the display refreshes at another rate from now on.
    pub fn set_display_rate(&mut self, hz: f32) {
        self.display_hz = hz;
    }

    /// True if the targets of the last frame that asked for motion vectors got them.
    pub fn has_motion(&self) -> bool {
        self.scene_state() == SceneState::Ready && self.method.has_motion()
    }

    /// True if the display's runtime is to make every second frame.
    pub fn leaves_frames_to_runtime(&self) -> bool {
        self.method.leaves_frames_to_runtime(&self.settings)
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
        let text = self.caption.text();
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

    /// Writes the text of the HUD.
    fn write_caption(&mut self) {
        if let Some(question) = self.stats.question() {
            return question.write(self.caption.text_mut());
        }
        if let Some(sentence) = self.scene.failure() {
            return self.caption.write_sentence(sentence);
        }
        let status = Status {
            frames: self.stats.last_line(),
            celsius: self.stats.celsius(),
            method: self.method_name(),
            auto: self.method.auto(),
            pipeline: self.pipeline_name(),
            loading: self.scene.is_loading().then(|| self.scene.name()),
        };
        self.caption.write_status(&status, self.now_ns);
    }

    /// Ends a frame that was handed to the display.
    ///
    /// # Errors
    /// [`ViewerError::NoContext`], and [`ViewerError::Gl`] if a method cannot be recompiled for another quality.
    pub fn end(&mut self, timing: &FrameTiming) -> Result<FrameReport, ViewerError> {
        let &FrameTiming { now_ns, mut refresh_hz, .. } = timing;
        self.now_ns = now_ns;
        // While a runtime makes every second frame, it may give the period of the display or that of the renders.
        if self.leaves_frames_to_runtime() {
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
        self.method.end_frame(now_ns, refresh_hz, gpu);
        let load = Load { now_ns, refresh_hz, late_refreshes, gpu_ms };
        let is_shown = scene == SceneState::Ready;
        if is_shown {
            self.method.judge_rate(&load, self.display_hz, &self.settings);
        }
        if self.settings.adaptive && is_shown && self.method.adapt(&load, &self.settings) {
            self.make_method()?;
        }
        let was_over = self.stats.is_over();
        if !was_over && self.stats.is_time_up(&self.settings, now_ns) && self.ask() {
            self.stats.end();
        }
        let is_over = self.stats.is_over();
        Ok(FrameReport {
            scene,
            late_refreshes,
            gpu_ms,
            telemetry_due: self.stats.is_line_due(now_ns),
            session_over: is_over && !was_over,
            exit: is_over && self.settings.auto_exit,
        })
    }

    /// Ends a second and returns its log line. Call it when a [`FrameReport`] asks for it, with the device's present
    /// state.
    pub fn telemetry(&mut self, now_ns: i64, device: &DeviceState) -> Line {
        self.method.set_thermal_headroom(device.thermal_headroom);
        let state = self.state();
        self.method.begin_second();
        self.stats.line(now_ns, &state, device)
    }

    /// Returns the viewer's own part of a log line.
    pub(super) fn state(&self) -> ViewerState {
        ViewerState {
            method: self.method_name().to_owned(),
            pipeline: self.pipeline_name().map(str::to_owned),
            scene: self.scene_name().to_owned(),
            render_scale: self.render_scale(),
            imbuffer: self.method.imbuffer_divisor(&self.settings),
            run: self.settings.run.clone(),
            auto: self.method.reason(),
        }
    }

    fn method_name(&self) -> &'static str {
        self.method.method().name()
    }

    fn pipeline_name(&self) -> Option<&'static str> {
        self.method.pipeline_name()
    }

    /// Returns the summary of the session since the scene was first shown, for the log.
    pub fn summary(&self, now_ns: i64) -> SessionSummary {
        self.stats.summary(now_ns)
    }

    /// Returns the answers so far to the settings' questions; each is logged when it is given.
    pub fn ratings(&self) -> &[Rating] {
        self.stats.ratings()
    }

    /// Returns the size in pixels of each eye's image on a display whose full size is `full`.
    pub fn eye_size(&self, full: [f32; 2]) -> [u32; 2] {
        // Methods also render a guard band beside the image.
        let limit = self.attached.as_ref().map_or(4096, |g| g.gl.capabilities().max_texture_size) / 2;
        let steps = |pixels: f32| (pixels * self.render_scale() / SIZE_STEP).round().max(4.0) * SIZE_STEP;
        full.map(|n| (steps(n) as u32).min(limit))
    }

    fn render_scale(&self) -> f32 {
        self.settings.render_scale * self.method.render_scale()
    }
}
