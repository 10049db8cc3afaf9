//! The choices that the page offers.

use std::rc::Rc;

use serde::{Deserialize, Serialize};
use yoro::eyes::{DepthRange, Eye, EyeOptions, EyePair, FoveationLevel, Gaze, Pose, StereoViews};
use yoro_gl::{Capabilities, Context, GlError};
use yoro_render::RenderSettings;
use yoro_render::stereo::{HoleMethod, Method, MethodChoice, StereoOptions, StereoSession};
use yoro_settings::Ipd;

/// The way in which two images are shown on a flat screen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Display {
    /// Side by side, with the left eye's image on the left.
    #[default]
    SideBySide,
    /// Side by side, with the left eye's image on the right.
    CrossEyed,
    /// One image for glasses with a red filter on the left.
    Anaglyph,
    /// Only the left eye's image.
    Left,
    /// Only the right eye's image.
    Right,
    /// The non-dominant eye: the real render left of a divider, the method's image right of it.
    Divider,
    /// As [`Display::Divider`], but with the difference of the two right of the divider.
    Difference,
    /// The two alternately, by moving the divider to either border.
    Flicker,
}

impl Display {
    /// Returns the display that shows one eye's image.
    pub fn one_eye(eye: Eye) -> Display {
        match eye {
            Eye::Left => Display::Left,
            Eye::Right => Display::Right,
        }
    }

    /// True if both images are shown side by side.
    fn is_split(self) -> bool {
        matches!(self, Display::SideBySide | Display::CrossEyed)
    }

    /// Returns width and height in pixels of the part of a canvas that is available for one image.
    pub fn part(self, [width, height]: [u32; 2]) -> [u32; 2] {
        if self.is_split() { [(width / 2).max(1), height] } else { [width, height] }
    }

    /// True if the non-dominant eye has to be rendered, too, for comparison.
    pub fn needs_truth(self) -> bool {
        matches!(self, Display::Divider | Display::Difference | Display::Flicker)
    }
}

/// The page's choices. Missing keys have their defaults, unknown keys are rejected.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct Settings {
    /// The stereo method, or the cheaper one of two.
    pub method: MethodChoice,
    /// Samples per pixel.
    pub msaa: u32,
    /// What becomes of pixels that the rendered eye does not show.
    pub holes: HoleMethod,
    /// Distance between the eyes in metres.
    pub ipd: Ipd,
    /// The eye that is rendered.
    pub dominant: Eye,
    /// The way in which both eyes are shown.
    pub display: Display,
    /// In a headset: how much of each eye is rendered with all pixels.
    pub foveation: FoveationLevel,
}

impl Default for Settings {
    fn default() -> Settings {
        let yoro_settings::Settings { msaa, dominant, .. } = Default::default();
        Settings {
            method: MethodChoice::default(),
            msaa,
            holes: HoleMethod::default(),
            ipd: Ipd::DEFAULT,
            dominant,
            display: Display::SideBySide,
            foveation: FoveationLevel::Off,
        }
    }
}

impl Settings {
    /// Parses JSON.
    ///
    /// # Errors
    /// A sentence about the error.
    pub fn parse(json: &str) -> Result<Settings, String> {
        serde_json::from_str(json).map_err(|error| format!("These settings cannot be used: {error}."))
    }

    /// Returns the renderer's settings; those without a choice are as on the desktop.
    pub fn render_settings(&self) -> RenderSettings {
        RenderSettings { msaa: self.msaa, ..RenderSettings::default() }
    }

    /// Returns the methods' options. They differ from the desktop's in one default: frames are never rendered twice because
    /// much of the view is near, since detecting that would make the browser wait for the GPU.
    pub fn stereo_options(&self) -> StereoOptions {
        StereoOptions { policy: None, holes: self.holes, ..StereoOptions::default() }
    }

    /// Returns what a headset's eyes see with the foveation.
    pub fn stereo_views(&self, pair: &EyePair) -> StereoViews {
        let views = pair.stereo_views(self.foveation.foveation().as_ref(), Gaze::Axes(pair.axes()));
        views.unwrap_or_else(|_| (*pair).into())
    }

    /// Returns the method in use, or the automatic choice between two. Displays that compare with a real render never
    /// use the automatic choice.
    pub fn choice(&self) -> MethodChoice {
        if self.display.needs_truth() { self.method.first().into() } else { self.method }
    }

    /// True if renderer and method are the same for other choices.
    pub fn makes_same(&self, other: &Settings) -> bool {
        self.choice() == other.choice()
            && self.stereo_options() == other.stereo_options()
            && self.render_settings() == other.render_settings()
    }

    /// Returns the reason why the browser does not support a method with these choices; `None` if it does.
    pub fn lacks(&self, method: Method, capabilities: &Capabilities) -> Option<String> {
        let reason = self.render_settings().supports(method, capabilities).err()?;
        // On the desktop, the advice is to use another driver.
        let browser = method == Method::Multiview && self.render_settings().supported(capabilities).is_ok();
        Some(if browser {
            "This browser has no OVR_multiview2, which headsets' browsers have: choose instanced.".into()
        } else {
            reason.to_string()
        })
    }

    /// Makes a session of a method, or of both of the automatic choice, with these choices.
    ///
    /// # Errors
    /// Those of [`StereoSession::new`].
    pub fn create_session(&self, gl: &Rc<Context>, choice: MethodChoice) -> Result<StereoSession, GlError> {
        StereoSession::new(gl, choice, &self.render_settings(), &self.stereo_options())
    }

    /// Returns both eyes of a head, with images of `size` pixels.
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
        assert_eq!((settings.method, settings.dominant), (Method::ShadingReprojection.into(), Eye::Left));
        assert_eq!(settings.render_settings(), RenderSettings::default());
        // Displays with a comparison do not use the automatic choice.
        let chosen = |json| Settings::parse(json).unwrap().choice();
        assert_eq!(chosen(r#"{"display":"anaglyph"}"#), MethodChoice::Auto);
        assert_eq!(chosen(r#"{"display":"divider"}"#), Method::Synthesized.into());
        assert_eq!(Settings::parse(r#"{"msaa":1}"#).unwrap().render_settings().msaa, 1);
        for wrong in [r#"{"ipd":0.09}"#, r#"{"method":"none"}"#, r#"{"colour":"red"}"#, r#"{"ipd":null}"#] {
            let error = Settings::parse(wrong).unwrap_err();
            assert!(error.ends_with('.'), "{error}");
        }
    }
}
