//! What the page lets people choose.

use std::rc::Rc;

use serde::{Deserialize, Serialize};
use yoro::eyes::{DepthRange, Eye, EyeOptions, EyePair, Pose};
use yoro_gl::{Context, GlError};
use yoro_protocol::Ipd;
use yoro_render::stereo::{self, AntiAliasing, Method, StereoMethod, StereoOptions};
use yoro_render::{RenderSettings, RendererKind};

/// How two images are shown on a flat screen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Display {
    /// The left eye's image on the left.
    #[default]
    SideBySide,
    /// The left eye's image on the right.
    CrossEyed,
    /// For glasses with a red filter on the left.
    Anaglyph,
    /// One image.
    Left,
    /// One image.
    Right,
    /// Where the eye that is not dominant differs from a real render of it.
    Difference,
    /// That eye, in turn as the method makes it and really rendered.
    Flicker,
}

impl Display {
    /// True if both images are on the screen.
    fn is_split(self) -> bool {
        matches!(self, Display::SideBySide | Display::CrossEyed)
    }

    /// Returns the width and height of what one image may fill of a canvas, in pixels.
    pub fn part(self, [width, height]: [u32; 2]) -> [u32; 2] {
        if self.is_split() { [(width / 2).max(1), height] } else { [width, height] }
    }

    /// True if the eye that is not dominant has to be rendered, too.
    pub fn needs_truth(self) -> bool {
        matches!(self, Display::Difference | Display::Flicker)
    }
}

/// The page's choices; keys that are left out are as by default, unknown ones are refused.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct Settings {
    /// How both eyes are made.
    pub method: Method,
    /// How a view is rendered.
    pub renderer: RendererKind,
    /// Samples in each pixel of the forward renderer.
    pub msaa: u32,
    /// When anti-aliasing of images with one sample a pixel runs.
    pub anti_aliasing: AntiAliasing,
    /// Distance between the eyes in metres.
    pub ipd: Ipd,
    /// The eye that is rendered.
    pub dominant: Eye,
    /// How both are shown.
    pub display: Display,
}

impl Default for Settings {
    fn default() -> Settings {
        let yoro_protocol::Settings { method, renderer, msaa, dominant, .. } = Default::default();
        Settings {
            method,
            renderer,
            msaa,
            anti_aliasing: AntiAliasing::After,
            ipd: Ipd::DEFAULT,
            dominant,
            display: Display::SideBySide,
        }
    }
}

impl Settings {
    /// Of JSON.
    ///
    /// # Errors
    /// What is wrong with it, in a sentence.
    pub fn parse(json: &str) -> Result<Settings, String> {
        serde_json::from_str(json).map_err(|error| format!("These settings cannot be used: {error}."))
    }

    /// As the desktop's.
    pub fn render_settings(&self) -> RenderSettings {
        RenderSettings { renderer: self.renderer, msaa: self.msaa, ..RenderSettings::default() }
    }

    /// As the desktop's, but that no frame is rendered twice because much of it is near: finding that out would have
    /// the browser wait for the GPU.
    pub fn stereo_options(&self) -> StereoOptions {
        StereoOptions { anti_aliasing: self.anti_aliasing, policy: None, ..StereoOptions::default() }
    }

    /// True if renderer and method of other choices are the same ones.
    pub fn makes_same(&self, other: &Settings) -> bool {
        self.method == other.method
            && self.stereo_options() == other.stereo_options()
            && self.render_settings() == other.render_settings()
    }

    /// Compiles a method for these choices.
    ///
    /// # Errors
    /// As [`stereo::create`].
    pub fn create(&self, gl: &Rc<Context>, method: Method) -> Result<Box<dyn StereoMethod>, GlError> {
        stereo::create(gl, method, &self.render_settings(), &self.stereo_options())
    }

    /// Both eyes of a head, with images of `size` pixels.
    pub fn pair(&self, head: Pose, size: [u32; 2]) -> EyePair {
        let options = EyeOptions {
            size,
            ipd: self.ipd.metres(),
            dominant: self.dominant,
            depth: DepthRange::PAPER,
            ..EyeOptions::default()
        };
        options.pair(head)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_are_checked() {
        let json = r#"{"method":"shading-reprojection","ipd":0.07,"dominant":"left","display":"cross-eyed"}"#;
        let settings = Settings::parse(json).unwrap();
        assert_eq!((settings.method, settings.dominant), (Method::ShadingReprojection, Eye::Left));
        assert_eq!(settings.anti_aliasing, AntiAliasing::After);
        assert_eq!(settings.render_settings(), RenderSettings::default());
        let forward = Settings::parse(r#"{"renderer":"forward","msaa":1}"#).unwrap();
        assert_eq!(forward.render_settings().summary(), "forward, 1 samples a pixel");
        for wrong in [
            r#"{"ipd":0.09}"#,
            r#"{"method":"none"}"#,
            r#"{"renderer":"ray"}"#,
            r#"{"colour":"red"}"#,
            r#"{"ipd":null}"#,
        ] {
            let error = Settings::parse(wrong).unwrap_err();
            assert!(error.ends_with('.'), "{error}");
        }
    }
}
