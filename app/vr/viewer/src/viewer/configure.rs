//! Changes of the settings while the viewer runs.

use std::path::PathBuf;

use super::{Viewer, profiling};
use crate::adaptive::Controller;
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
        let (choice, pipeline) = (self.method.choice, self.method.pipeline);
        if let Err(error) = self.remake(&before) {
            self.settings = before;
            (self.method.choice, self.method.pipeline) = (choice, pipeline);
            return Err(error.into());
        }
        if self.settings.ipd != before.ipd {
            self.ipd.chosen = self.settings.ipd;
        }
        if self.settings.hud != before.hud {
            self.caption.is_shown = self.settings.hud;
        }
        let has_moved = self.settings.viewpoint != before.viewpoint;
        if has_moved {
            self.scene.go_to(self.settings.viewpoint);
        }
        if has_moved || self.changes_quality(&before) {
            self.measure_again();
        }
        if self.settings.duration != before.duration {
            self.stats.reopen();
        }
        if let Some(attached) = &self.attached
            && self.settings.profiling != before.profiling
        {
            attached.gl.set_profiling(profiling(&self.settings));
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
        if settings.scene == self.settings.scene {
            return Ok(None);
        }
        SceneSource::find(&settings.scene, folders).map(Some)
    }

    fn changes_quality(&self, before: &Settings) -> bool {
        (self.settings.adaptive, self.settings.render_scale) != (before.adaptive, before.render_scale)
    }

    /// Recreates renderer and session if their settings changed.
    fn remake(&mut self, before: &Settings) -> Result<(), GlError> {
        if self.changes_quality(before) {
            self.controller = Controller::new();
        }
        let method_differs = self.settings.method != before.method;
        if method_differs {
            self.method.choice = self.settings.method;
        }
        let gl = self.attached.as_ref().map(|attached| attached.gl.clone());
        if let Some(gl) = &gl {
            self.choose_pipeline(gl);
        }
        let settings = &self.settings;
        let driver = gl.as_ref().map(|gl| gl.capabilities());
        let render = render_settings(settings, driver);
        let renderer_differs = render != render_settings(before, driver);
        if let Some(gl) = &gl
            && let Some(shown) = &mut self.scene.shown
            && renderer_differs
        {
            shown.prepared.renderer = Renderer::new(gl, &render, &shown.prepared.scene)?;
        }
        let options_differ =
            stereo_options(settings, settings.pipeline) != stereo_options(before, before.pipeline);
        if renderer_differs || options_differ || method_differs {
            self.make_session()?;
        }
        Ok(())
    }
}
