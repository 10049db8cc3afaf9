//! Other settings while the viewer runs.

use std::path::PathBuf;

use super::{Controller, Quality, SceneSource, Settings, Viewer, ViewerError};
use crate::gl::{Context, Profiling};
use crate::render::Renderer;
use crate::synthesis::Pipeline;

impl Viewer {
    /// Takes over other settings; only what differs from the ones before is made again. What the user has changed by
    /// hand stays, unless that very setting differs.
    ///
    /// # Errors
    /// [`ViewerError::NoScene`], and [`ViewerError::Gl`] when the driver cannot do what is asked for; the settings
    /// before stay.
    pub fn configure(&mut self, settings: Settings, folders: &[PathBuf]) -> Result<(), ViewerError> {
        // What may fail by a mistake in the settings comes first.
        let source = self.other_scene(&settings, folders)?;
        if let Some(graphics) = &self.graphics
            && settings.method != self.settings.method
        {
            settings.method.supported(graphics.gl.capabilities())?;
        }
        let before = std::mem::replace(&mut self.settings, settings);
        let in_use = (self.method, self.pipeline);
        if let Err(error) = self.remake(&before) {
            self.settings = before;
            (self.method, self.pipeline) = in_use;
            return Err(error);
        }
        let settings = &self.settings;
        if settings.ipd != before.ipd {
            self.ipd = settings.ipd;
        }
        if settings.hud != before.hud {
            self.hud_shown = settings.hud;
        }
        if settings.viewpoint != before.viewpoint {
            self.viewpoint = settings.viewpoint % self.viewpoints.len().max(1);
        }
        if settings.adaptive != before.adaptive || settings.render_scale != before.render_scale {
            self.controller = Controller::new();
            self.quality = Quality::FULL;
        }
        if settings.duration != before.duration {
            self.questionnaire = None;
            self.is_over = false;
        }
        if let Some(graphics) = &self.graphics
            && settings.profiling != before.profiling
        {
            let profiling = if settings.profiling { Profiling::Queries } else { Profiling::Off };
            graphics.gl.set_profiling(profiling);
        }
        self.folders = folders.to_vec();
        if let Some(source) = source {
            self.viewpoint = self.settings.viewpoint;
            self.load_scene(source);
        }
        Ok(())
    }

    fn other_scene(
        &self,
        settings: &Settings,
        folders: &[PathBuf],
    ) -> Result<Option<SceneSource>, ViewerError> {
        if (&settings.scene, settings.seed) == (&self.settings.scene, self.settings.seed) {
            return Ok(None);
        }
        SceneSource::find(&settings.scene, settings.seed, folders).map(Some)
    }

    /// Makes renderer and method again, if the settings before were others.
    fn remake(&mut self, before: &Settings) -> Result<(), ViewerError> {
        if self.settings.method != before.method {
            self.method = self.settings.method;
        }
        if let Some(graphics) = &self.graphics {
            self.choose_pipeline(&graphics.gl.clone());
        }
        let (render, options) = (self.settings.render_settings(), self.settings.stereo_options());
        let renderer_differs = render != before.render_settings();
        if let Some(graphics) = &mut self.graphics
            && let Some(stage) = &mut graphics.stage
            && renderer_differs
        {
            stage.renderer = Renderer::new(&graphics.gl, &render, &stage.scene)?;
        }
        if renderer_differs || options != before.stereo_options() || self.settings.method != before.method {
            self.make_method()?;
        }
        Ok(())
    }

    /// The pipeline of the settings, or the one that every driver can do.
    pub(super) fn choose_pipeline(&mut self, gl: &Context) {
        self.pipeline = self.settings.pipeline;
        if self.pipeline != Pipeline::Gather && !gl.capabilities().compute {
            log::warn!(
                "{} has no compute shaders (OpenGL ES 3.1), which the pipeline {} needs: gather is used instead",
                gl.capabilities().renderer,
                self.pipeline.name()
            );
            self.pipeline = Pipeline::Gather;
        }
    }
}

#[cfg(all(test, feature = "desktop"))]
mod tests {
    use super::*;
    use crate::gl::GlError;
    use crate::platform::{Backend, Headless};
    use crate::stereo::Method;
    use crate::viewer::{Cardboard, Event, FrameTiming, Rotation, SceneState, Screen};

    const TIMING: FrameTiming = FrameTiming { now_ns: 1, expected_display_ns: 2, refresh_hz: 60.0 };

    fn viewer(headless: &Headless) -> Cardboard {
        let screen = Screen { size: [256, 128], dpi: [0.0; 2], rotation: Rotation::LandscapeLeft };
        let mut settings = Settings::default();
        for pair in ["scene=prototype", "render-scale=0.25", "shadow-map=0", "ssao=off", "bloom=false"] {
            settings.apply(pair).unwrap();
        }
        let mut viewer = Cardboard::new(settings, screen, &[]).unwrap();
        viewer.attach(headless.gl().clone()).unwrap();
        wait(&mut viewer);
        viewer
    }

    fn wait(viewer: &mut Cardboard) {
        while viewer.viewer.loader.is_some() {
            std::thread::sleep(std::time::Duration::from_millis(5));
            viewer.viewer.poll_scene();
        }
        assert_eq!(viewer.viewer.scene_state(), SceneState::Ready);
    }

    fn with(viewer: &Cardboard, pairs: &[&str]) -> Settings {
        let mut settings = viewer.viewer.settings().clone();
        pairs.iter().for_each(|pair| settings.apply(pair).unwrap());
        settings
    }

    #[test]
    fn what_differs_changes_and_nothing_else() {
        let headless = Headless::open(Backend::Auto).unwrap();
        let mut viewer = viewer(&headless);
        viewer.event(Event::IpdUp).unwrap();
        let ipd = viewer.viewer.ipd();
        viewer.configure(with(&viewer, &["method=mono", "timewarp=false", "hud=false"]), &[]).unwrap();
        assert_eq!(
            (viewer.viewer.method(), viewer.viewer.ipd(), viewer.viewer.hud_shown),
            (Method::Mono, ipd, false)
        );
        viewer.event(Event::Tap).unwrap();
        assert_ne!(viewer.viewer.method(), Method::Mono);
        let tapped = viewer.viewer.method();
        viewer.configure(with(&viewer, &["ipd=0.05", "viewer=v1", "ssao=half"]), &[]).unwrap();
        assert_eq!((viewer.viewer.method(), viewer.viewer.ipd()), (tapped, 0.05));
        assert!((viewer.optics().params().inter_lens - 0.060).abs() < 1e-6);
        viewer.configure(with(&viewer, &["ipd=auto"]), &[]).unwrap();
        assert_eq!(viewer.viewer.ipd(), viewer.optics().params().inter_lens);
        viewer.configure(with(&viewer, &["seed=2"]), &[]).unwrap();
        assert!(viewer.viewer.loader.is_some());
        wait(&mut viewer);
        viewer.render(&TIMING).unwrap();
        assert_eq!(headless.gl().take_errors(), None);
    }

    #[test]
    fn mistakes_change_nothing() {
        let headless = Headless::open(Backend::Auto).unwrap();
        let mut viewer = viewer(&headless);
        let before = viewer.viewer.settings().clone();
        for pair in ["scene=nowhere", "viewer=/no/such/file"] {
            let settings = with(&viewer, &[pair, "method=mono", "ipd=0.02"]);
            assert!(viewer.configure(settings, &[]).is_err());
            assert_eq!((viewer.viewer.settings(), viewer.viewer.method()), (&before, before.method));
        }
        if !headless.gl().capabilities().multiview {
            let settings = with(&viewer, &["method=multiview"]);
            assert!(matches!(viewer.configure(settings, &[]), Err(ViewerError::Gl(GlError::Unsupported(_)))));
            assert_eq!((viewer.viewer.settings(), viewer.viewer.method()), (&before, before.method));
        }
        viewer.render(&TIMING).unwrap();
    }
}
