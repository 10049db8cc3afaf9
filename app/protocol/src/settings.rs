//! Settings of the viewer: defaults < file < overrides.

use std::fmt::{self, Display};
use std::io::Read;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use toml::{Table, Value};

use crate::choices::{
    AntiAliasing, DEFAULT_IPD, DisplayKind, ImBufferSize, MAX_IPD, MAX_POINT_LIGHTS, MSAA, Method,
    Performance, Pipeline, RendererKind, ScreenSize, Ssao,
};
use yoro::eyes::{Eye, GuardBand};
use yoro::synthesis::Edges;

/// Largest settings file in bytes.
const MAX_FILE: u64 = 1 << 20;

/// Why settings cannot be used: one sentence with the key and the remedy.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SettingsError {
    /// The file cannot be read.
    #[error("the settings file {path} cannot be read ({source}): check its path and permissions")]
    Read {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: std::io::Error,
    },
    /// The file is not TOML.
    #[error("the settings file {path} is not TOML ({what}): write lines such as scene = \"prototype\"")]
    Syntax {
        /// The file.
        path: PathBuf,
        /// The parser's words.
        what: String,
    },
    /// A key that does not exist.
    #[error("{origin}: there is no setting \"{key}\"; choose one of {}", KEYS.join(", "))]
    UnknownKey {
        /// The file, or the override.
        origin: String,
        /// The key.
        key: String,
    },
    /// A value that does not fit its key.
    #[error("{origin}: the setting \"{key}\" cannot be {value}: {remedy}")]
    Value {
        /// The file, or the override.
        origin: String,
        /// The key.
        key: String,
        /// The value given.
        value: String,
        /// What is possible.
        remedy: String,
    },
    /// An override that is not `key=value`.
    #[error("\"{0}\" is not a setting: write key=value, such as method=yoro")]
    NoPair(String),
}

/// All settings of the viewer. As TOML, and as `key=value`, keys are written with hyphens.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default, rename_all = "kebab-case")]
pub struct Settings {
    /// A built-in scene, or an OBJ, glTF or GLB file, by its path or by its name in one of the platform's
    /// scene folders.
    pub scene: String,
    /// Seed of a built-in scene.
    pub seed: u64,
    /// Which of the scene's viewpoints the viewer stands at, from 0; beyond the last it starts over.
    pub viewpoint: usize,
    /// The stereo method to start with.
    pub method: Method,
    /// The methods that a tap goes through.
    pub methods: Vec<Method>,
    /// Synthesis pipeline.
    pub pipeline: Pipeline,
    /// ImBuffer of the paper's pipeline: a divisor (`2`) or a size (`512x512`).
    #[serde(with = "as_text")]
    pub imbuffer: ImBufferSize,
    /// Paper's pipeline: interpolate between ImBuffer entries.
    pub linear_interpolation: bool,
    /// Paper's pipeline: rows of the patcher's kernel, 1 to 15.
    pub kernel_height: u32,
    /// Paper's pipeline: whole columns and one depth sample per ImBuffer pixel, as the text says.
    pub strict: bool,
    /// How much wider the dominant eye is rendered: `none`, `40px`, or metres; by default as the pipeline needs.
    #[serde(with = "optional_as_text", skip_serializing_if = "Option::is_none")]
    pub guard_band: Option<GuardBand>,
    /// When anti-aliasing runs; by default as the pipeline needs.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub anti_aliasing: Option<AntiAliasing>,
    /// What the synthesis takes the rendered eye's edges for; by default what fits the renderer.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub edges: Option<Edges>,
    /// Render objects nearer than this (metres) for both eyes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub near_field: Option<f32>,
    /// Switch to two real renders while most of the view is too near.
    pub switch: bool,
    /// The method `hybrid`: the far field starts where the disparity between the eyes is this many pixels.
    pub split_disparity: f32,
    /// The viewer: `v1`, `v2`, the URI of its QR code, or the path of a parameter file.
    pub viewer: String,
    /// The size of the whole screen behind the lenses; by default what the device says of its pixels.
    #[serde(with = "optional_as_text", skip_serializing_if = "Option::is_none")]
    pub screen: Option<ScreenSize>,
    /// The eye that is rendered.
    pub dominant: Eye,
    /// Distance between the eyes in metres; by default that of the viewer's lenses, or of the headset.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ipd: Option<f32>,
    /// Rendered pixels per screen pixel at the lens's centre, per axis, 0.25 to 2; the upper limit when
    /// `adaptive` is on.
    pub render_scale: f32,
    /// Adapt render scale and ImBuffer to the display's rate and the device's temperature.
    pub adaptive: bool,
    /// Turn the finished image to the newest head pose.
    pub timewarp: bool,
    /// Correct the lenses' chromatic aberration.
    pub chromatic: bool,
    /// Show the HUD.
    pub hud: bool,
    /// How a view is rendered.
    pub renderer: RendererKind,
    /// Forward renderer: samples in each pixel, 1, 2 or 4.
    pub msaa: u32,
    /// Edge of the sun's shadow map in texels, 0 for no shadows.
    pub shadow_map: u32,
    /// Ambient occlusion; the forward renderer has none.
    pub ssao: Ssao,
    /// Glow around what is brighter than white.
    pub bloom: bool,
    /// Point lights that light a view, at most 24.
    pub point_lights: usize,
    /// Length of the session in seconds, after which its summary is logged.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub duration: Option<f32>,
    /// What is asked after `duration`, to be answered on a slider; a `-` in a question is shown as a space.
    pub questions: Vec<String>,
    /// Ratings go from 1 (worst) to this, 2 to 100.
    pub best_rating: u32,
    /// Who answers, in the log. Words and numbers.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub participant: Option<String>,
    /// Number of the trial, in the log.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub trial: Option<u32>,
    /// End the program after `duration` and the questions.
    pub auto_exit: bool,
    /// On what the eyes are shown.
    pub display: DisplayKind,
    /// Refreshes per second. Headsets: the nearest of what the runtime offers; by default the runtime's choice. Phones: what
    /// Android is asked for; by default the rate that the display has at the start.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub refresh_rate: Option<f32>,
    /// How fast the processors should run.
    pub performance: Performance,
    /// Phones: Android's scheduler is told how long each frame takes, where it takes such hints (Android 13).
    pub performance_hints: bool,
    /// Headsets: the depth of both eyes goes to the compositor, where it takes it. Counts when a session begins.
    pub submit_depth: bool,
    /// Headsets: one view in place of two, where the runtime or an API layer offers that. Counts when a session begins.
    pub one_view: bool,
    /// Measure the GPU time of each stage, where the driver has timer queries.
    pub profiling: bool,
    /// Name of this run in the log line, for scripts that start several.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub run: Option<String>,
}

/// The keys of [`Settings`], in order.
pub const KEYS: &[&str] = &[
    "scene",
    "seed",
    "viewpoint",
    "method",
    "methods",
    "pipeline",
    "imbuffer",
    "linear-interpolation",
    "kernel-height",
    "strict",
    "guard-band",
    "anti-aliasing",
    "edges",
    "near-field",
    "switch",
    "split-disparity",
    "viewer",
    "screen",
    "dominant",
    "ipd",
    "render-scale",
    "adaptive",
    "timewarp",
    "chromatic",
    "hud",
    "renderer",
    "msaa",
    "shadow-map",
    "ssao",
    "bloom",
    "point-lights",
    "duration",
    "questions",
    "best-rating",
    "participant",
    "trial",
    "auto-exit",
    "display",
    "refresh-rate",
    "performance",
    "performance-hints",
    "submit-depth",
    "one-view",
    "profiling",
    "run",
];

/// Keys that may be left to the program: the value `auto` takes them back.
const OPTIONAL: &[&str] = &[
    "guard-band",
    "anti-aliasing",
    "edges",
    "near-field",
    "screen",
    "ipd",
    "duration",
    "participant",
    "trial",
    "refresh-rate",
    "run",
];

impl Default for Settings {
    fn default() -> Settings {
        Settings {
            scene: "prototype".into(),
            seed: 1,
            viewpoint: 0,
            method: Method::Yoro,
            methods: vec![Method::Yoro, Method::Conventional, Method::Mono],
            pipeline: Pipeline::default(),
            imbuffer: ImBufferSize::Divisor(1),
            linear_interpolation: true,
            kernel_height: 3,
            strict: false,
            guard_band: None,
            anti_aliasing: None,
            edges: None,
            near_field: None,
            switch: true,
            split_disparity: 1.0,
            viewer: "v2".into(),
            screen: None,
            dominant: Eye::Right,
            ipd: None,
            render_scale: 1.0,
            adaptive: false,
            timewarp: true,
            chromatic: false,
            hud: true,
            renderer: RendererKind::default(),
            msaa: 4,
            // Phones: half of what the desktop program takes by default.
            shadow_map: 2048,
            ssao: Ssao::Half,
            bloom: true,
            point_lights: MAX_POINT_LIGHTS / 2,
            duration: None,
            questions: Vec::new(),
            best_rating: 5,
            participant: None,
            trial: None,
            auto_exit: false,
            display: DisplayKind::Auto,
            refresh_rate: None,
            performance: Performance::default(),
            performance_hints: true,
            submit_depth: true,
            one_view: false,
            profiling: true,
            run: None,
        }
    }
}

impl Settings {
    /// The defaults, changed by a TOML file if there is one, then by `key=value` texts in order. An empty value
    /// changes nothing: that is what a system property that was taken back reads as.
    ///
    /// # Errors
    /// [`SettingsError`].
    pub fn resolve<S: AsRef<str>>(
        file: Option<&Path>,
        overrides: impl IntoIterator<Item = S>,
    ) -> Result<Settings, SettingsError> {
        let mut settings = Settings::default();
        if let Some(path) = file {
            settings.apply_file(path)?;
        }
        for pair in overrides {
            settings.apply(pair.as_ref())?;
        }
        Ok(settings)
    }

    /// Changes the settings by a TOML file.
    ///
    /// # Errors
    /// [`SettingsError`]; the settings stay as they were.
    pub fn apply_file(&mut self, path: &Path) -> Result<(), SettingsError> {
        let mut changed = self.clone();
        match changed.apply_file_leniently(path).into_iter().next() {
            Some(error) => Err(error),
            None => {
                *self = changed;
                Ok(())
            }
        }
    }

    /// Changes the settings by what is right in a TOML file, and says what is wrong: for programs that nobody can
    /// start again at once.
    pub fn apply_file_leniently(&mut self, path: &Path) -> Vec<SettingsError> {
        let mut text = String::new();
        let read = std::fs::File::open(path).and_then(|file| file.take(MAX_FILE).read_to_string(&mut text));
        if let Err(source) = read {
            return vec![SettingsError::Read { path: path.into(), source }];
        }
        let table: Table = match text.parse() {
            Ok(table) => table,
            Err(error) => {
                let what = toml::de::Error::message(&error).trim().replace('\n', " ");
                return vec![SettingsError::Syntax { path: path.into(), what }];
            }
        };
        let origin = path.display().to_string();
        table.into_iter().filter_map(|(key, value)| self.set(&origin, &key, &[value]).err()).collect()
    }

    /// Changes one setting by a text `key=value`. Lists are written as in TOML or separated by commas; `auto`
    /// takes back a setting that has no fixed default.
    ///
    /// # Errors
    /// [`SettingsError`]; the settings stay as they were.
    pub fn apply(&mut self, pair: &str) -> Result<(), SettingsError> {
        let (key, text) = pair.split_once('=').ok_or_else(|| SettingsError::NoPair(pair.into()))?;
        let (key, text) = (key.trim(), text.trim());
        if text.is_empty() {
            return if KEYS.contains(&key) { Ok(()) } else { Err(unknown(pair, key)) };
        }
        // What a text means is the key's matter: try the kinds of TOML first, then plain words.
        let typed = format!("x = {text}").parse::<Table>().ok().and_then(|mut table| table.remove("x"));
        let words = || text.split(',').map(|word| Value::from(word.trim())).collect::<Vec<_>>();
        let candidates: Vec<Value> =
            typed.into_iter().chain([Value::from(text), Value::Array(words())]).collect();
        self.set(pair, key, &candidates)
    }

    /// Sets one key to the first of the candidates that fits.
    fn set(&mut self, origin: &str, key: &str, candidates: &[Value]) -> Result<(), SettingsError> {
        if !KEYS.contains(&key) {
            return Err(unknown(origin, key));
        }
        let fault = |value: &Value, remedy: String| SettingsError::Value {
            origin: origin.into(),
            key: key.into(),
            value: value.to_string(),
            remedy,
        };
        let table = Table::try_from(&*self).map_err(|e| fault(&candidates[0], e.to_string()))?;
        let mut first_error = None;
        for value in candidates {
            let mut table = table.clone();
            if OPTIONAL.contains(&key) && value.as_str() == Some("auto") {
                table.remove(key);
            } else {
                table.insert(key.into(), value.clone());
            }
            match table.try_into::<Settings>() {
                Ok(settings) => {
                    settings.check(key).map_err(|remedy| fault(value, remedy))?;
                    *self = settings;
                    return Ok(());
                }
                Err(error) => {
                    let reason = error.message().trim().replace('\n', " ");
                    // Of a plain word, the complaint about words is the one that helps.
                    if first_error.is_none() || value.is_str() {
                        first_error = Some(fault(value, reason));
                    }
                }
            }
        }
        Err(first_error.unwrap_or_else(|| unknown(origin, key)))
    }

    /// Checks the range of one setting; the error is the remedy.
    fn check(&self, key: &str) -> Result<(), String> {
        let positive = |n: f32| n > 0.0 && n.is_finite();
        let (fits, remedy) = match key {
            "scene" => (!self.scene.trim().is_empty(), "name a built-in scene or a file".into()),
            "methods" => (!self.methods.is_empty(), "name at least one method".into()),
            "kernel-height" => ((1..=15).contains(&self.kernel_height), "give 1 to 15 rows".into()),
            "near-field" => (self.near_field.is_none_or(positive), "give metres above 0, or auto".into()),
            "split-disparity" => (positive(self.split_disparity), "give pixels above 0, such as 1".into()),
            "ipd" => (
                self.ipd.is_none_or(|ipd| (0.0..=MAX_IPD).contains(&ipd)),
                format!(
                    "give metres from 0 to {MAX_IPD}, such as {DEFAULT_IPD}, or auto for that of the lenses"
                ),
            ),
            "render-scale" => {
                ((0.25..=2.0).contains(&self.render_scale), "give a factor from 0.25 to 2".into())
            }
            "msaa" => (MSAA.contains(&self.msaa), "give 1, 2 or 4 samples".into()),
            "shadow-map" => (self.shadow_map <= 8192, "give texels from 0 to 8192".into()),
            "point-lights" => {
                (self.point_lights <= MAX_POINT_LIGHTS, format!("give a number from 0 to {MAX_POINT_LIGHTS}"))
            }
            "refresh-rate" => (
                self.refresh_rate.is_none_or(|hz| (1.0..=1000.0).contains(&hz)),
                "give refreshes per second, such as 90, or auto".into(),
            ),
            "best-rating" => ((2..=100).contains(&self.best_rating), "give a number from 2 to 100".into()),
            "duration" => (self.duration.is_none_or(positive), "give seconds above 0, or auto".into()),
            _ => return Ok(()),
        };
        if fits { Ok(()) } else { Err(remedy) }
    }
}

/// One line: `key=value` for each setting.
impl Display for Settings {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let table = Table::try_from(self).map_err(|_| fmt::Error)?;
        for (i, key) in KEYS.iter().enumerate() {
            let space = if i == 0 { "" } else { " " };
            match table.get(*key) {
                // As they were given, not as doubles.
                Some(Value::Float(number)) => write!(f, "{space}{key}={}", *number as f32)?,
                Some(value) => write!(f, "{space}{key}={value}")?,
                None => write!(f, "{space}{key}=auto")?,
            }
        }
        Ok(())
    }
}

fn unknown(origin: &str, key: &str) -> SettingsError {
    SettingsError::UnknownKey { origin: origin.into(), key: key.into() }
}

/// A value that may be written as a number or as a word.
fn text<'de, D: Deserializer<'de>>(deserializer: D) -> Result<String, D::Error> {
    match Value::deserialize(deserializer)? {
        Value::String(text) => Ok(text),
        Value::Integer(n) => Ok(n.to_string()),
        Value::Float(n) => Ok(n.to_string()),
        other => Err(D::Error::custom(format!("it cannot be of the type {}", other.type_str()))),
    }
}

mod as_text {
    use super::*;

    pub fn serialize<T: Display, S: Serializer>(value: &T, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(value)
    }

    pub fn deserialize<'de, T, D>(deserializer: D) -> Result<T, D::Error>
    where
        T: FromStr<Err: Display>,
        D: Deserializer<'de>,
    {
        text(deserializer)?.parse().map_err(D::Error::custom)
    }
}

mod optional_as_text {
    use super::*;

    pub fn serialize<T: Display, S: Serializer>(value: &Option<T>, serializer: S) -> Result<S::Ok, S::Error> {
        match value {
            Some(value) => serializer.collect_str(value),
            None => serializer.serialize_none(),
        }
    }

    pub fn deserialize<'de, T, D>(deserializer: D) -> Result<Option<T>, D::Error>
    where
        T: FromStr<Err: Display>,
        D: Deserializer<'de>,
    {
        as_text::deserialize(deserializer).map(Some)
    }
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
    fn the_list_of_keys_is_complete() {
        let full = with(&[
            "guard-band=40px",
            "anti-aliasing=off",
            "edges=nearest",
            "near-field=1",
            "screen=158x71mm",
            "ipd=0.06",
            "duration=10",
            "run=a",
            "participant=P03",
            "trial=4",
            "refresh-rate=90",
        ]);
        let table = Table::try_from(full.unwrap()).unwrap();
        let mut keys: Vec<_> = table.keys().map(String::as_str).collect();
        let mut listed = KEYS.to_vec();
        keys.sort_unstable();
        listed.sort_unstable();
        assert_eq!(keys, listed);
    }

    #[test]
    fn every_kind_of_override() {
        let settings = with(&[
            "scene=/sdcard/a room.obj",
            "method=conventional",
            "methods=mono,yoro",
            "pipeline=paper",
            "imbuffer=256x128",
            "guard-band=none",
            "screen=158x70.5 mm",
            "dominant=left",
            "ipd=0.06",
            "adaptive=true",
            "seed=7",
            "ssao=off",
            "duration=30",
            "viewer=https://g.co/cardboard",
            "hud=",
        ])
        .unwrap();
        assert_eq!(settings.scene, "/sdcard/a room.obj");
        assert_eq!(settings.methods, [Method::Mono, Method::Yoro]);
        assert_eq!(settings.imbuffer, ImBufferSize::Fixed([256, 128]));
        assert_eq!((settings.guard_band, settings.ipd), (Some(GuardBand::None), Some(0.06)));
        assert_eq!(settings.screen.unwrap().metres(), [0.158, 0.0705]);
        assert_eq!((settings.dominant, settings.duration), (Eye::Left, Some(30.0)));
        assert!(settings.adaptive && settings.hud && settings.ssao == Ssao::Off);
        assert_eq!(settings.pipeline, Pipeline::Paper);
        let again = with(&["ipd=0.06", "ipd=auto", "imbuffer=4", "methods=mono", "guard-band=0.5"]).unwrap();
        assert_eq!((again.ipd, again.imbuffer), (None, ImBufferSize::Divisor(4)));
        assert_eq!(again.guard_band, Some(GuardBand::Distance(0.5)));
        assert_eq!(again.methods, [Method::Mono]);
    }

    #[test]
    fn mistakes_name_key_and_remedy() {
        refused("speed=3", &["\"speed\"", "render-scale"]);
        refused("speed=", &["\"speed\""]);
        refused("method", &["method", "key=value"]);
        refused("method=fast", &["\"method\"", "fast", "conventional"]);
        refused("ipd=0.2", &["\"ipd\"", &MAX_IPD.to_string(), &DEFAULT_IPD.to_string()]);
        refused("split-disparity=0", &["\"split-disparity\"", "pixels"]);
        refused("msaa=8", &["\"msaa\"", "1, 2 or 4"]);
        refused("renderer=fast", &["\"renderer\"", "forward"]);
        refused("point-lights=25", &[&MAX_POINT_LIGHTS.to_string()]);
        refused("ipd=wide", &["\"ipd\"", "wide"]);
        refused("imbuffer=0", &["\"imbuffer\"", "64"]);
        refused("imbuffer=a", &["\"imbuffer\"", "512x512"]);
        refused("guard-band=far", &["\"guard-band\"", "40px"]);
        refused("adaptive=yes", &["\"adaptive\"", "yes"]);
        refused("render-scale=9", &["0.25"]);
        refused("kernel-height=40", &["15"]);
        refused("seed=-1", &["\"seed\""]);
        refused("methods=yoro,fast", &["\"methods\"", "fast"]);
        refused("display=oculus", &["\"display\"", "openxr", "cardboard"]);
        refused("screen=158x71", &["\"screen\"", "158x71mm", "auto"]);
        refused("screen=15.8x7.1mm", &["30 to 400"]);
        refused("best-rating=1", &["\"best-rating\"", "2 to 100"]);
        refused("refresh-rate=0", &["\"refresh-rate\"", "auto"]);
    }

    #[test]
    fn a_file_comes_before_overrides() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("yoro.toml");
        std::fs::write(&path, "method = \"mono\"\nipd = 0.06\nmethods = [\"mono\"]\nguard-band = 2\n")
            .unwrap();
        let settings = Settings::resolve(Some(&path), ["method=conventional"]).unwrap();
        assert_eq!((settings.method, settings.ipd), (Method::Conventional, Some(0.06)));
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
    fn what_is_printed_is_read_again() {
        let settings = with(&["ipd=0.061", "methods=mono,yoro", "imbuffer=512x512", "scene=a b"]).unwrap();
        let text = toml::to_string(&settings).unwrap();
        assert_eq!(toml::from_str::<Settings>(&text).unwrap(), settings);
        assert!(settings.to_string().contains("ipd=0.061") && settings.to_string().contains("duration=auto"));
    }

    proptest::proptest! {
        #[test]
        fn any_text_is_taken_or_refused(key in 0usize..KEYS.len(), value in ".{0,12}") {
            let _ = with(&[&format!("{}={value}", KEYS[key])]);
        }
    }
}
