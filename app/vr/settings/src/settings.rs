//! The settings of the viewer: the table of settings, and how files and texts change them.

use std::fmt::{self, Display};
use std::io::Read;
use std::path::Path;

use toml::{Table, Value};

use crate::choices::{
    DisplayKind, FrameRate, HoleMethod, MSAA, Method, MethodChoice, Performance, Pipeline, Timewarp,
};
use crate::quantities::{ImBufferSize, Ipd, ScreenSize};
use crate::setting::Setting;
use crate::value::{SettingValue, shown};
use yoro::eyes::{Eye, FoveationLevel, GuardBand};

/// The largest settings file in bytes.
const MAX_FILE: u64 = 1 << 20;

/// An error in settings: one sentence with the key and the remedy.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub struct SettingsError(String);

impl SettingsError {
    fn value(origin: &str, key: &str, value: &str, remedy: &str) -> SettingsError {
        SettingsError(format!("{origin}: the setting \"{key}\" cannot be {value}: {remedy}"))
    }
}

/// Generates [`Settings`], their defaults and [`SETTINGS`] from the same rows. A field's documentation is its help.
macro_rules! settings {
    ($(
        $(#[doc = $help:literal])+
        $key:literal $field:ident: $type:ty = $default:expr $(; $option:ident($($argument:expr),+))*,
    )+) => {
        /// All settings of the viewer; [`SETTINGS`] has a row for each.
        #[derive(Clone, Debug, PartialEq)]
        pub struct Settings {
            $( $(#[doc = $help])+ pub $field: $type, )+
        }

        impl Default for Settings {
            fn default() -> Settings {
                Settings { $($field: $default,)+ }
            }
        }

        /// The table of settings. Files, `key=value` texts, intent extras, system properties and the table in
        /// docs/settings.md follow it, and options of the command line for the keys that the program groups.
        pub static SETTINGS: &[Setting] = &[$(
            Setting::new::<$type>(
                $key,
                concat!($($help, "\n"),+),
                |settings| settings.$field.write(),
                |settings, value| {
                    settings.$field = SettingValue::read(value)?;
                    Ok(())
                },
            )$(.$option($($argument),+))*,
        )+];
    };
}

settings! {
    /// A built-in scene, or an OBJ, glTF or GLB file, by its path or by its name in one of the platform's scene folders.
    "scene" scene: String = "prototype".into();
        range(|s| !s.scene.trim().is_empty(), "name a built-in scene or a file"),
    /// The scene's viewpoint to stand at, from 0; numbers beyond the last one start over.
    "viewpoint" viewpoint: usize = 0,
    /// The stereo method to start with; `auto` measures `conventional` and `yoro` on the device and uses the cheaper one, or
    /// with rendered holes the best of three that holds the rate.
    "method" method: MethodChoice = MethodChoice::Auto,
    /// The pipeline that synthesizes the other eye.
    "pipeline" pipeline: Pipeline = Pipeline::default(),
    /// paper: ImBuffer resolution, as a divisor from 1 to 64 (the paper: 1, 2, 4, 8, 16) or a fixed size (512x512).
    "imbuffer" imbuffer: ImBufferSize = ImBufferSize::Divisor(1); value_name("N|WxH"),
    /// paper: interpolate between ImBuffer entries.
    "linear-interpolation" linear_interpolation: bool = true;
        off_help("paper: do not interpolate between ImBuffer entries"),
    /// paper: whole source columns and one depth sample per ImBuffer pixel, as the text says.
    "strict" strict: bool = false,
    /// How much wider the dominant eye is rendered: `none`, pixels (`40px`; with foveation those of the wide layer), or
    /// complete from a distance in metres (`1.0`).
    "guard-band" guard_band: Option<GuardBand> = None;
        value_name("none|Npx|METRES");
        auto("1.0; paper: none"),
    /// yoro: what becomes of pixels that the rendered eye does not show. `rendered` is the best quality; it draws opaque
    /// surfaces twice, but shades few of them again.
    "holes" holes: HoleMethod = HoleMethod::default(),
    /// Switch to two real renders while most of the view is too near.
    "switch" switch: bool = true;
        off_help("Never switch to two real renders, however near everything is"),
    /// Headsets whose runtime makes frames from colour, depth and motion vectors: with yoro and conventional, render
    /// every second frame and leave the others to the runtime.
    "frame-rate" frame_rate: FrameRate = FrameRate::default(),
    /// The viewer: v1, v2, the URI of its QR code, or a parameter file.
    "viewer" viewer: String = "v2".into(),
    /// Viewers that the menu and the start screen offer besides v1 and v2: the last ones chosen.
    "recent-viewers" recent_viewers: Vec<String> = Vec::new(),
    /// Size of the whole screen behind the lenses, such as `158x71mm`: measure it if the device reports it wrongly.
    "screen" screen: Option<ScreenSize> = None; auto("what the device says"),
    /// The eye that is rendered.
    "dominant" dominant: Eye = Eye::Right,
    /// Distance between the eyes in metres, 0 to 0.08.
    "ipd" ipd: Option<Ipd> = None; auto("that of the lenses, or the headset's"),
    /// Rendered pixels per screen pixel at the lens's centre, per axis, 0.25 to 2; the upper limit when `adaptive` is on.
    /// Headsets: a factor on the size that the runtime recommends.
    "render-scale" render_scale: f32 = 1.0;
        range(|s| (0.25..=2.0).contains(&s.render_scale), "give a factor from 0.25 to 2"),
    /// Render each eye at full density only around its axis, as far as 30 (`low`) or 20 degrees (`medium`, `high`). Beyond,
    /// with half (`low`, `medium`) or a third of the pixels along each axis.
    "foveation" foveation: Option<FoveationLevel> = None; auto("headsets: medium; others, and all measurements: off"),
    /// Lower render scale and ImBuffer to hold the display's refresh rate and to spare a hot device.
    "adaptive" adaptive: bool = false,
    /// Phones: how the finished image follows the head after rendering. `position` copies the depth of both eyes and adds
    /// three passes to each; not with `foveation`.
    "timewarp" timewarp: Timewarp = Timewarp::default(),
    /// Show the HUD.
    "hud" hud: bool = true; off_help("Hide the HUD"),
    /// Samples in each pixel, 1, 2 or 4, as far as the driver has them.
    "msaa" msaa: u32 = 4; value_name("N"); range(|s| MSAA.contains(&s.msaa), "give 1, 2 or 4"),
    /// Edge of the sun's shadow map in texels, at most 8192; 0 for no shadows.
    "shadow-map" shadow_map: u32 = 2048; range(|s| s.shadow_map <= 8192, "give texels from 0 to 8192"),
    /// Glow around what is brighter than white.
    "bloom" bloom: bool = true,
    /// Length of the session in seconds. Then its summary is logged, the questions are asked, and the program ends.
    "duration" duration: Option<f32> = None;
        range(|s| s.duration.is_none_or(is_positive), "give seconds above 0, or auto");
        auto("no end"),
    /// Questions to ask after `duration`, answered on a slider, such as `image-quality,comfort`; a `-` is shown as a space.
    "questions" questions: Vec<String> = Vec::new(),
    /// The person who answers, for the log: words and numbers.
    "participant" participant: Option<String> = None,
    /// Number of the trial, for the log.
    "trial" trial: Option<u32> = None,
    /// The display that shows the eyes; read at start-up only.
    "display" display: DisplayKind = DisplayKind::Auto,
    /// Refreshes per second. Headsets: the nearest of the rates that the runtime offers. Phones: the rate that Android is
    /// asked for (Android 11).
    "refresh-rate" refresh_rate: Option<f32> = None;
        range(|s| s.refresh_rate.is_none_or(|hz| (1.0..=1000.0).contains(&hz)), "give refreshes per second, such as 90, or auto");
        auto("headsets: the runtime's own; phones: the rate at the start"),
    /// Clock level of the processors. Phones: the two sustained levels are Android's sustained performance mode.
    "performance" performance: Performance = Performance::SustainedHigh,
    /// Headsets: one view instead of two, if the runtime or an API layer such as yoro's offers that. Meant for
    /// `method=mono`, which renders only one view; read when a session begins.
    "one-view" one_view: bool = false,
    /// Measure the GPU time of each stage, where the driver has timer queries.
    "profiling" profiling: bool = true,
    /// A name for this run in the log line; `yoro device` tells its runs apart by it.
    "run" run: Option<String> = None,
}

fn is_positive(number: f32) -> bool {
    number > 0.0 && number.is_finite()
}

impl Settings {
    /// Returns the defaults for measurements and pictures, in which nothing depends on the device: the method is yoro, and
    /// nothing is foveated.
    pub fn measured() -> Settings {
        let foveation = Some(FoveationLevel::Off);
        Settings { method: Method::Synthesized.into(), foveation, ..Settings::default() }
    }

    /// Returns the defaults, changed as by [`Settings::changed`].
    pub fn resolve<S: AsRef<str>>(
        file: Option<&Path>,
        overrides: impl IntoIterator<Item = S>,
    ) -> Result<Settings, SettingsError> {
        Settings::default().changed(file, overrides)
    }

    /// Returns these settings, changed first by a TOML file, if given, then by `key=value` texts in order. An empty
    /// value changes nothing, since a system property that was unset reads as empty.
    pub fn changed<S: AsRef<str>>(
        self,
        file: Option<&Path>,
        overrides: impl IntoIterator<Item = S>,
    ) -> Result<Settings, SettingsError> {
        let mut settings = self;
        if let Some(error) = file.and_then(|path| settings.apply_file_leniently(path).into_iter().next()) {
            return Err(error);
        }
        for pair in overrides {
            settings.apply(pair.as_ref())?;
        }
        settings.contradiction().map_or(Ok(settings), Err)
    }

    /// Returns what is wrong with two settings together, of which the first one has no effect; `None` if nothing is.
    pub fn contradiction(&self) -> Option<SettingsError> {
        let foveation = self.foveation.filter(|level| *level != FoveationLevel::Off);
        if let Some(level) = foveation.filter(|_| self.timewarp == Timewarp::Position) {
            let reason = "timewarp=position do not go together, since that moves whole eyes";
            return Some(SettingsError(format!(
                "foveation={} and {reason}: leave one of them out",
                level.name()
            )));
        }
        if (self.pipeline, self.holes) == (Pipeline::Paper, HoleMethod::Rendered)
            && self.method.first() == Method::Synthesized
        {
            let reason = "the paper's pipeline fills its holes";
            return Some(SettingsError(format!(
                "pipeline=paper and holes=rendered do not go together, since {reason}: leave one of them out"
            )));
        }
        let writes_motion = [Method::Synthesized, Method::Conventional].contains(&self.method.first());
        (self.frame_rate != FrameRate::Full && !writes_motion).then(|| {
            let reason = "do not go together, since only yoro and conventional write motion vectors";
            SettingsError(format!(
                "frame-rate={} and method={} {reason}: leave one of them out",
                self.frame_rate.name(),
                self.method.name()
            ))
        })
    }

    /// Applies whatever is valid in a TOML file, and returns the errors, for programs that cannot simply be restarted.
    pub fn apply_file_leniently(&mut self, path: &Path) -> Vec<SettingsError> {
        let mut text = String::new();
        let read = std::fs::File::open(path).and_then(|file| file.take(MAX_FILE).read_to_string(&mut text));
        if let Err(reason) = read {
            let path = path.display();
            return vec![SettingsError(format!(
                "the settings file {path} cannot be read ({reason}): check its path and permissions"
            ))];
        }
        let table: Table = match text.parse() {
            Ok(table) => table,
            Err(error) => {
                let what = toml::de::Error::message(&error).trim().replace('\n', " ");
                return vec![SettingsError(format!(
                    "the settings file {} is not TOML ({what}): write lines such as scene = \"prototype\"",
                    path.display()
                ))];
            }
        };
        let origin = path.display().to_string();
        table.into_iter().filter_map(|(key, value)| self.set(&origin, key, &value).err()).collect()
    }

    /// Returns each setting as key and value, as [`Settings::apply`] reads them.
    pub fn pairs(&self) -> Vec<(String, String)> {
        SETTINGS.iter().map(|setting| (setting.key.to_owned(), setting.text(self))).collect()
    }

    fn set(&mut self, origin: &str, key: String, value: &Value) -> Result<(), SettingsError> {
        let set = find(origin, &key)?.set(self, value);
        set.map_err(|remedy| SettingsError::value(origin, &key, &shown(value), &remedy))
    }

    /// Sets one setting by a text `key=value`. Lists are written as in TOML or separated by commas; `auto` resets a
    /// setting that has no fixed default.
    ///
    /// # Errors
    /// [`SettingsError`]; the settings stay unchanged.
    pub fn apply(&mut self, pair: &str) -> Result<(), SettingsError> {
        let (key, text) = pair.split_once('=').ok_or_else(|| {
            let what = format!("\"{pair}\" is not a setting: write key=value, such as method=yoro");
            SettingsError(what)
        })?;
        let key = key.trim();
        let parsed = find(pair, key)?.parse_into(self, text);
        parsed.map_err(|(value, remedy)| SettingsError::value(pair, key, &value, &remedy))
    }
}

/// Writes one line with `key=value` for each setting.
impl Display for Settings {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        for (i, setting) in SETTINGS.iter().enumerate() {
            let space = if i == 0 { "" } else { " " };
            let value = setting.value(self).filter(|value| !value.is_float());
            let text = value.map_or_else(|| setting.text(self), |value| value.to_string());
            write!(f, "{space}{}={text}", setting.key)?;
        }
        Ok(())
    }
}

/// Returns the setting with a key from a file or a text.
fn find(origin: &str, key: &str) -> Result<&'static Setting, SettingsError> {
    Setting::find(key).ok_or_else(|| {
        let keys = SETTINGS.iter().map(|setting| setting.key).collect::<Vec<_>>().join(", ");
        SettingsError(format!("{origin}: there is no setting \"{key}\"; choose one of {keys}"))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn with(pairs: &[&str]) -> Result<Settings, SettingsError> {
        Settings::resolve(None, pairs)
    }

    #[track_caller]
    fn refused(pair: &str, naming: &[&str]) {
        let message = with(&[pair]).unwrap_err().to_string();
        assert!(!message.contains('\n'), "{message}");
        for name in naming {
            assert!(message.contains(name), "{name} is not in: {message}");
        }
    }

    #[test]
    fn every_kind_of_value_can_be_overridden() {
        let settings = with(&[
            "scene=/sdcard/a room.obj",
            "method=conventional",
            "pipeline=paper",
            "imbuffer=256x128",
            "guard-band=none",
            "screen=158x70.5 mm",
            "dominant=left",
            "ipd=0.06",
            "adaptive=true",
            "viewpoint=7",
            "msaa=2",
            "duration=30",
            "viewer=https://g.co/cardboard",
            "hud=",
        ])
        .unwrap();
        assert_eq!(settings.scene, "/sdcard/a room.obj");
        assert_eq!(settings.method, Method::Conventional.into());
        assert_eq!(settings.imbuffer, ImBufferSize::Fixed([256, 128]));
        assert_eq!((settings.guard_band, settings.ipd), (Some(GuardBand::None), Some(Ipd::nearest(0.06))));
        assert_eq!(settings.screen.unwrap().metres(), [0.158, 0.0705]);
        assert_eq!((settings.dominant, settings.duration), (Eye::Left, Some(30.0)));
        assert!(settings.adaptive && settings.hud && settings.msaa == 2);
        assert_eq!(settings.pipeline, Pipeline::Paper);
        let again =
            with(&["ipd=0.06", "ipd=auto", "imbuffer=4", "method=mono", "method=auto", "guard-band=0.5"])
                .unwrap();
        assert_eq!((again.ipd, again.imbuffer), (None, ImBufferSize::Divisor(4)));
        assert_eq!(again.guard_band, Some(GuardBand::Distance(0.5)));
        assert_eq!((again.method, settings.viewpoint), (MethodChoice::Auto, 7));
    }

    #[test]
    fn mistakes_name_key_and_remedy() {
        refused("speed=3", &["\"speed\"", "render-scale"]);
        refused("speed=", &["\"speed\""]);
        refused("method", &["method", "key=value"]);
        refused("method=fast", &["\"method\"", "fast", "auto", "conventional"]);
        refused("ipd=0.2", &["\"ipd\"", &Ipd::MAX.to_string(), &Ipd::DEFAULT.to_string()]);
        refused("msaa=8", &["\"msaa\"", "1, 2 or 4"]);
        refused("renderer=forward", &["\"renderer\""]);
        refused("ipd=wide", &["\"ipd\"", "wide"]);
        refused("imbuffer=0", &["\"imbuffer\"", "64"]);
        refused("imbuffer=a", &["\"imbuffer\"", "512x512"]);
        refused("guard-band=far", &["\"guard-band\"", "40px"]);
        refused("adaptive=yes", &["\"adaptive\"", "yes"]);
        refused("render-scale=9", &["0.25"]);
        refused("viewpoint=-1", &["\"viewpoint\""]);
        refused("display=oculus", &["\"display\"", "openxr", "cardboard"]);
        refused("screen=158x71", &["\"screen\"", "158x71mm", "auto"]);
        refused("screen=15.8x7.1mm", &["30 to 400"]);
        refused("frame-rate=36", &["\"frame-rate\"", "full"]);
        refused("refresh-rate=0", &["\"refresh-rate\"", "auto"]);
    }

    #[test]
    fn settings_without_effect_beside_others_are_refused() {
        let refused = |one: &str, other: &str| {
            let message = with(&[one, other]).unwrap_err().to_string();
            assert!(
                message.starts_with(&format!("{one} and {other} do not go together, since ")),
                "{message}"
            );
        };
        refused("foveation=medium", "timewarp=position");
        refused("pipeline=paper", "holes=rendered");
        let without =
            Method::ALL.into_iter().filter(|m| ![Method::Synthesized, Method::Conventional].contains(m));
        for method in without {
            for rate in ["half", "auto"] {
                refused(&format!("frame-rate={rate}"), &format!("method={}", method.name()));
            }
        }
        for pairs in [["foveation=off", "timewarp=position"], ["frame-rate=half", "method=auto"]] {
            assert!(with(&pairs).is_ok(), "{pairs:?}");
        }
    }

    #[test]
    fn a_file_comes_before_overrides() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("yoro.toml");
        std::fs::write(&path, "method = \"mono\"\nipd = 0.06\nquestions = [\"a\"]\nguard-band = 2\n")
            .unwrap();
        let settings = Settings::resolve(Some(&path), ["method=conventional"]).unwrap();
        assert_eq!((settings.method, settings.ipd), (Method::Conventional.into(), Some(Ipd::nearest(0.06))));
        assert_eq!(settings.guard_band, Some(GuardBand::Distance(2.0)));
        for (text, naming) in [
            ("speed = 3\n", "\"speed\""),
            ("ipd = \"wide\"\n", "\"ipd\""),
            ("ipd = = 3\n", "not TOML"),
            ("[method]\nx = 1\n", "\"method\""),
        ] {
            std::fs::write(&path, text).unwrap();
            let message = Settings::resolve(Some(&path), [""; 0]).unwrap_err().to_string();
            assert!(message.contains(naming) && message.contains("yoro.toml"), "{message}");
            assert!(!message.contains('\n'), "{message}");
        }
        let missing = folder.path().join("none.toml");
        assert!(Settings::resolve(Some(&missing), [""; 0]).unwrap_err().to_string().contains("none.toml"));
    }

    #[test]
    fn each_setting_as_a_text_is_read_again() {
        let settings =
            with(&["ipd=0.061", "questions=a,b", "imbuffer=512x512", "scene=a b", "run=7", "trial=3"])
                .unwrap();
        let mut read = Settings { viewpoint: 99, hud: false, ..Settings::default() };
        for (key, value) in settings.pairs() {
            read.apply(&format!("{key}={value}")).unwrap();
        }
        assert_eq!(read, settings);
        let line = settings.to_string();
        assert!(line.starts_with("scene=\"a b\" viewpoint=0 "), "{line}");
        assert!(line.contains("questions=[\"a\", \"b\"]") && line.contains(" ipd=0.061 "), "{line}");
        assert!(line.contains("duration=auto"), "{line}");
    }

    /// docs/settings.md lists every setting. If YORO_BLESS is set in the environment, the list is rewritten.
    #[test]
    fn the_document_has_the_table() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../docs/settings.md");
        let text = std::fs::read_to_string(path).unwrap();
        let head = "| key | default | meaning |\n|---|---|---|\n";
        let begin = text.find(head).unwrap() + head.len();
        let end = begin + text[begin..].find("\n\n").unwrap() + 1;
        let table: String = SETTINGS.iter().map(Setting::markdown).collect();
        if std::env::var_os("YORO_BLESS").is_some() {
            std::fs::write(path, format!("{}{table}{}", &text[..begin], &text[end..])).unwrap();
        } else {
            assert_eq!(text[begin..end], table, "run this test with YORO_BLESS=1");
        }
    }

    proptest::proptest! {
        #[test]
        fn any_text_is_taken_or_refused(row in 0usize..SETTINGS.len(), value in ".{0,12}") {
            let _ = with(&[&format!("{}={value}", SETTINGS[row].key)]);
        }
    }
}
