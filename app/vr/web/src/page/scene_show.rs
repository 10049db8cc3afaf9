//! A scene on the canvas.

use std::rc::Rc;

use yoro::choice::Cost;
use yoro::eyes::{Eye, Pose, StereoViews};
use yoro_assets::Scene;
use yoro_gl::{Context, GlError, PassTime, Profiling, RenderTarget, Texture};
use yoro_render::stereo::{
    FrameLoad, FrameReport, FrameTargets, Method, StereoError, StereoFrame, StereoSession,
};
use yoro_render::{PreparedScene, Renderer};

use crate::settings::Settings;

/// Everything needed to show a scene.
pub struct SceneShow {
    pub prepared: PreparedScene,
    pub session: StereoSession,
    /// The images of the last frame.
    pub frame: StereoFrame,
    truth: Option<Truth>,
    /// What is seen in that frame.
    views: Option<StereoViews>,
    /// What the last frame cost, if the choice of the method is automatic.
    load: Option<FrameLoad>,
    passes: Vec<PassTime>,
}

/// A real render of both eyes, for comparison with the method's.
struct Truth {
    session: StereoSession,
    frame: StereoFrame,
}

impl SceneShow {
    /// Compiles renderer and method for a scene.
    pub fn new(gl: &Rc<Context>, settings: &Settings, scene: Scene) -> Result<SceneShow, GlError> {
        Ok(SceneShow {
            prepared: PreparedScene::new(gl, scene, &settings.render_settings())?,
            session: settings.create_session(gl, settings.choice())?,
            frame: StereoFrame::new(gl, [1, 1])?,
            truth: None,
            views: None,
            load: None,
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
        (self.truth, self.views) = (None, None);
        let render = settings.render_settings();
        let renderer = if before.render_settings() == render {
            None
        } else {
            Some(Renderer::new(gl, &render, &self.prepared.scene)?)
        };
        self.session = settings.create_session(gl, settings.choice())?;
        if let Some(renderer) = renderer {
            self.prepared.renderer = renderer;
        }
        Ok(())
    }

    /// Renders both eyes of a head, with images of `size` pixels, and the real render if the display needs it.
    pub fn render(
        &mut self,
        gl: &Rc<Context>,
        settings: &Settings,
        head: Pose,
        size: [u32; 2],
    ) -> Result<(), StereoError> {
        let views: StereoViews = settings.pair(head, size).into();
        if self.views.is_some_and(|before| before.shown.size != size) {
            self.session.measure_again();
        }
        let load = self.load.take();
        self.session.frame(&mut self.prepared, &views, self.frame.fit(size)?, load.as_ref())?;
        self.views = Some(views);
        if !settings.display.needs_truth() {
            self.truth = None;
            return Ok(());
        }
        let truth = match &mut self.truth {
            Some(truth) => truth,
            none => none.insert(Truth {
                session: settings.create_session(gl, Method::Conventional.into())?,
                frame: StereoFrame::new(gl, size)?,
            }),
        };
        truth.session.frame(&mut self.prepared, &views, truth.frame.fit(size)?, None).map(drop)
    }

    /// Renders both eyes of a phone's viewer or a headset.
    pub fn render_to(
        &mut self,
        views: &StereoViews,
        targets: FrameTargets,
    ) -> Result<FrameReport, StereoError> {
        let load = self.load.take();
        self.session.frame(&mut self.prepared, views, targets, load.as_ref())
    }

    /// Renders the last frame `count` more times, by the method or by two real renders, and waits for the GPU. Does
    /// nothing without a real render to compare with.
    pub fn repeat(&mut self, real: bool, count: u32) -> Result<(), StereoError> {
        let (Some(truth), Some(views)) = (&mut self.truth, &self.views) else { return Ok(()) };
        let (session, frame) = match real {
            true => (&mut truth.session, &mut truth.frame),
            false => (&mut self.session, &mut self.frame),
        };
        for _ in 0..count {
            session.frame(&mut self.prepared, views, frame.fit(views.shown.size)?, None)?;
        }
        // Browsers may ignore glFinish, but reading a pixel makes them wait.
        frame.eye(Eye::Left).read_rgba8(0, [0, 0], [1, 1]);
        Ok(())
    }

    /// Ends a frame that was handed to the display at `now_ms`, and counts it if the choice of the method is automatic.
    pub fn end(&mut self, gl: &Context, now_ms: f64, refresh_hz: f32) {
        let is_auto = self.session.auto().is_some();
        let wants_times = is_auto && gl.capabilities().timer_queries;
        if wants_times != gl.times_passes() {
            gl.set_profiling(if wants_times { Profiling::Queries } else { Profiling::Off });
        }
        if !is_auto {
            return;
        }
        self.passes.clear();
        let gpu = gl.end_timed_frame(&mut self.passes).map(|frames_ago| Cost {
            frames_ago,
            ms: self.passes.iter().map(|pass| pass.time.as_secs_f32() * 1e3).sum(),
        });
        self.load = Some(FrameLoad {
            ended_ns: (now_ms * 1e6) as i64,
            refresh_hz,
            display_hz: refresh_hz,
            gpu,
            ..FrameLoad::default()
        });
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
