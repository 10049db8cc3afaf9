//! Changes of the settings while the viewer runs.

use std::path::PathBuf;

use super::{Viewer, profiling};
use crate::error::ViewerError;
use crate::loading::SceneSource;
use crate::options::{render_settings, stereo_options};
use yoro::eyes::FoveationLevel;
use yoro_gl::GlError;
use yoro_render::Renderer;
use yoro_settings::Settings;

impl Viewer {
    /// Applies new settings and recreates only the parts that changed. Changes that the user has made stay, unless the
    /// same setting differs.
    ///
    /// # Errors
    /// [`ViewerError::NoScene`], and [`ViewerError::Gl`] if the driver refuses. The previous settings stay in effect.
    pub fn configure(&mut self, settings: Settings, folders: &[PathBuf]) -> Result<(), ViewerError> {
        let given = settings.clone();
        self.change(settings, folders)?;
        self.given = given;
        Ok(())
    }

    /// Sets the foveation where the settings give none.
    ///
    /// # Errors
    /// As [`Viewer::configure`].
    pub fn set_default_foveation(&mut self, level: FoveationLevel) -> Result<(), ViewerError> {
        self.default_foveation = Some(level);
        let folders = self.folders.clone();
        self.change(self.settings.clone(), &folders)
    }

    /// See [`Viewer::configure`].
    pub(crate) fn change(&mut self, settings: Settings, folders: &[PathBuf]) -> Result<(), ViewerError> {
        let settings = Settings { foveation: settings.foveation.or(self.default_foveation), ..settings };
        // Everything that a mistake in the settings can make fail comes first.
        let source = self.other_scene(&settings, folders)?;
        let driver = self.attached.as_ref().map(|attached| attached.gl.capabilities());
        let (render, method_differs) =
            (render_settings(&settings, driver), settings.method != self.settings.method);
        if let Some(attached) = &self.attached
            && (method_differs || render != render_settings(&self.settings, driver))
        {
            let choice = if method_differs { settings.method } else { self.method() };
            render.supports(choice.first(), attached.gl.capabilities())?;
        }
        let before = std::mem::replace(&mut self.settings, settings);
        let in_use = self.method.choice();
        if let Err(error) = self.remake(&before) {
            self.settings = before;
            self.method.set_choice(in_use);
            return Err(error.into());
        }
        let settings = &self.settings;
        if settings.ipd != before.ipd {
            self.ipd.chosen = settings.ipd;
        }
        if settings.hud != before.hud {
            self.caption.is_shown = settings.hud;
        }
        if settings.viewpoint != before.viewpoint {
            self.scene.go_to(settings.viewpoint);
            self.method.measure_again();
        }
        if settings.adaptive != before.adaptive || settings.render_scale != before.render_scale {
            self.method.restore_quality();
            self.method.measure_again();
        }
        if settings.duration != before.duration {
            self.stats.reopen();
        }
        if let Some(attached) = &self.attached
            && settings.profiling != before.profiling
        {
            attached.gl.set_profiling(profiling(settings));
        }
        self.folders = folders.to_vec();
        if let Some(source) = source {
            self.replace_scene(source, self.settings.viewpoint);
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

    /// Recreates renderer and method if their settings changed.
    fn remake(&mut self, before: &Settings) -> Result<(), GlError> {
        let settings = &self.settings;
        let method_differs = settings.method != before.method;
        if method_differs {
            self.method.set_choice((settings.method, self.method.pipeline()));
        }
        if let Some(attached) = &self.attached {
            self.method.choose_pipeline(&attached.gl, settings);
        }
        let driver = self.attached.as_ref().map(|attached| attached.gl.capabilities());
        let render = render_settings(settings, driver);
        let renderer_differs = render != render_settings(before, driver);
        if let Some(attached) = &self.attached
            && let Some(shown) = self.scene.shown()
            && renderer_differs
        {
            shown.renderer = Renderer::new(&attached.gl, &render, &shown.scene)?;
        }
        let options_differ =
            stereo_options(settings, settings.pipeline) != stereo_options(before, before.pipeline);
        if renderer_differs || options_differ || method_differs {
            self.make_method()?;
        }
        Ok(())
    }
}
