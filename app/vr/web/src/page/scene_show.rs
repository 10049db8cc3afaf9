//! A scene on the canvas.

use std::rc::Rc;

use yoro::choice::Cost;
use yoro::eyes::{Eye, EyePair, Pose};
use yoro_assets::Scene;
use yoro_gl::{Context, GlError, PassTime, Profiling, RenderTarget, Texture};
use yoro_render::stereo::{
    Auto, EyeLevels, LevelTargets, Method, SelectedMethod, StereoError, StereoFrame, StereoMethod,
};
use yoro_render::{PreparedScene, Renderer};

use crate::settings::Settings;

/// Everything needed to show a scene.
pub struct SceneShow {
    pub prepared: PreparedScene,
    pub method: SelectedMethod,
    /// The images of the last frame.
    pub frame: StereoFrame,
    truth: Option<Truth>,
    /// The eyes of that frame.
    pair: Option<EyePair>,
    passes: Vec<PassTime>,
}

/// A real render of both eyes, for comparison with the method's.
struct Truth {
    method: Box<dyn StereoMethod>,
    frame: StereoFrame,
}

impl SceneShow {
    /// Compiles renderer and method for a scene.
    ///
    /// # Errors
    /// The GPU does not support it.
    pub fn new(gl: &Rc<Context>, settings: &Settings, scene: Scene) -> Result<SceneShow, GlError> {
        Ok(SceneShow {
            prepared: PreparedScene::new(gl, scene, &settings.render_settings())?,
            method: settings.create_chosen(gl)?,
            frame: StereoFrame::new(gl, [1, 1])?,
            truth: None,
            pair: None,
            passes: Vec::new(),
        })
    }

    /// Compiles renderer and method for choices other than those `before`.
    ///
    /// # Errors
    /// The GPU does not support it; renderer and method then stay unchanged.
    pub fn configure(
        &mut self,
        gl: &Rc<Context>,
        settings: &Settings,
        before: &Settings,
    ) -> Result<(), GlError> {
        (self.truth, self.pair) = (None, None);
        let render = settings.render_settings();
        let renderer = if before.render_settings() == render {
            None
        } else {
            Some(Renderer::new(gl, &render, &self.prepared.scene)?)
        };
        self.method = settings.create_chosen(gl)?;
        if let Some(renderer) = renderer {
            self.prepared.renderer = renderer;
        }
        Ok(())
    }

    /// Renders both eyes of a head, with images of `size` pixels, and the real render if the display needs it.
    ///
    /// # Errors
    /// Those of the method.
    pub fn render(
        &mut self,
        gl: &Rc<Context>,
        settings: &Settings,
        head: Pose,
        size: [u32; 2],
    ) -> Result<(), StereoError> {
        let pair = settings.pair(head, size);
        if self.pair.is_some_and(|before| before.size != size) {
            self.measure_again();
        }
        let PreparedScene { renderer, scene, .. } = &mut self.prepared;
        self.method.render(renderer, scene, &pair, &mut self.frame)?;
        self.pair = Some(pair);
        if !settings.display.needs_truth() {
            self.truth = None;
            return Ok(());
        }
        let truth = match &mut self.truth {
            Some(truth) => truth,
            none => none.insert(Truth {
                method: settings.create(gl, Method::Conventional)?,
                frame: StereoFrame::new(gl, size)?,
            }),
        };
        truth.method.render(renderer, scene, &pair, &mut truth.frame)
    }

    /// Renders both eyes in levels.
    ///
    /// # Errors
    /// Those of the method.
    pub fn render_levels(&mut self, levels: &EyeLevels, to: &LevelTargets) -> Result<(), StereoError> {
        let PreparedScene { renderer, scene } = &mut self.prepared;
        self.method.render_levels(renderer, scene, levels, to)
    }

    /// Renders the last frame `count` more times, by the method or by two real renders, and waits for the GPU. Does
    /// nothing without a real render to compare with.
    ///
    /// # Errors
    /// Those of the method.
    pub fn repeat(&mut self, real: bool, count: u32) -> Result<(), StereoError> {
        let (Some(truth), Some(pair)) = (&mut self.truth, &self.pair) else { return Ok(()) };
        let PreparedScene { renderer, scene, .. } = &mut self.prepared;
        let (method, frame): (&mut dyn StereoMethod, _) =
            if real { (&mut *truth.method, &mut truth.frame) } else { (&mut self.method, &mut self.frame) };
        for _ in 0..count {
            method.render(renderer, scene, pair, frame)?;
        }
        // Browsers may ignore glFinish, but reading a pixel makes them wait.
        frame.eye(Eye::Left).read_rgba8(0, [0, 0], [1, 1]);
        Ok(())
    }

    /// Ends a frame that was handed to the display at `now_ms`, and counts it if the choice of the method is automatic.
    pub fn end(&mut self, gl: &Context, now_ms: f64, refresh_hz: f32) {
        let wants_times = self.method.auto().is_some() && gl.capabilities().timer_queries;
        if wants_times != gl.times_passes() {
            gl.set_profiling(if wants_times { Profiling::Queries } else { Profiling::Off });
        }
        let Some(auto) = self.method.auto_mut() else { return };
        self.passes.clear();
        let gpu = gl.end_timed_frame(&mut self.passes).map(|frames_ago| Cost {
            frames_ago,
            ms: self.passes.iter().map(|pass| pass.time.as_secs_f32() * 1e3).sum(),
        });
        auto.end_frame((now_ms * 1e6) as i64, refresh_hz, gpu, None);
    }

    /// Makes an automatic choice measure again, after a change of the viewpoint or the resolution.
    pub fn measure_again(&mut self) {
        if let Some(auto) = self.method.auto_mut() {
            auto.scene_changed();
        }
    }

    /// Returns the automatic choice between two methods, if there is one.
    pub fn auto(&self) -> Option<&Auto> {
        self.method.auto()
    }

    /// Returns the real render of the non-dominant eye, if the display needs it.
    pub fn real_eye(&self, settings: &Settings) -> Option<&RenderTarget> {
        Some(self.truth.as_ref()?.frame.eye(settings.dominant.other()))
    }

    /// Returns the image of [`SceneShow::real_eye`].
    pub fn real_image(&self, settings: &Settings) -> Option<&Texture> {
        Some(self.real_eye(settings)?.color(0))
    }
}
