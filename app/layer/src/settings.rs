//! What a user can choose: by a file for all applications and for each one, and by environment variables, on Android system
//! properties, for one run.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use serde::Deserialize;
use yoro::eyes::{Eye, GuardBand};

use crate::xdg;

/// Where in the list of view configurations the application finds the one of a single view.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum OfferedAs {
    /// It is the whole list: an application that asks for stereo gets it nevertheless.
    Only,
    /// Before the runtime's own.
    #[default]
    First,
    /// After the runtime's own.
    Last,
}

/// The settings of one application.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// `offer`, YORO_LAYER_OFFER: `only`, `first` or `last`.
    pub offer: OfferedAs,
    /// `dominant`, YORO_LAYER_DOMINANT: `left` or `right`, the eye that the application renders.
    pub dominant: Eye,
    /// `guard_band`, YORO_LAYER_GUARD_BAND: `none`, pixels (`40px`) or metres (`1.0`).
    pub guard_band: GuardBand,
    /// `shrink`, YORO_LAYER_SHRINK: `on` or `off`. An application that begins its session in stereo is told that one eye's
    /// image is tiny, and that image is replaced. Only for applications that make a swapchain for each eye, of the size
    /// that is recommended for it.
    pub shrink: bool,
    /// YORO_LAYER_CAPTURE: a folder that gets pictures of what the runtime gets, of one frame. For tests.
    pub capture: Option<PathBuf>,
    /// YORO_LAYER_TIME: an XrTime in nanoseconds at which all views and spaces are located, in place of the one that is
    /// asked for: the world stands still, so that pictures of two runs can be compared. For tests.
    pub time: Option<i64>,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings {
            offer: OfferedAs::First,
            dominant: Eye::Right,
            guard_band: GuardBand::Distance(1.0),
            shrink: false,
            capture: None,
            time: None,
        }
    }
}

/// A part of the file: what is not said is as elsewhere.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct Choices {
    offer: Option<String>,
    dominant: Option<String>,
    guard_band: Option<String>,
    shrink: Option<String>,
}

#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    offer: Option<String>,
    dominant: Option<String>,
    guard_band: Option<String>,
    shrink: Option<String>,
    /// By the name that the application gives itself in XrApplicationInfo.
    #[serde(default)]
    application: std::collections::BTreeMap<String, Choices>,
}

/// A setting that is none.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SettingsError {
    /// The file cannot be read, or is no TOML of these keys.
    #[error("{}: {reason}; mend it or remove it", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What is wrong, in one line.
        reason: String,
    },
    /// A value out of its range.
    #[error("{place}: {key} is {value:?}; give {remedy}")]
    Value {
        /// The environment or the file.
        place: String,
        /// The variable or the key.
        key: String,
        /// What it is.
        value: String,
        /// What it can be.
        remedy: &'static str,
    },
}

/// The file of settings: `$XDG_CONFIG_HOME/yoro/layer.toml`, in `~/.config` where that is not set; None without a home.
pub fn path() -> Option<PathBuf> {
    Some(xdg::folder("XDG_CONFIG_HOME", ".config")?.join("yoro/layer.toml"))
}

/// Where settings for one run are.
const VARIABLES: &str = if cfg!(target_os = "android") { "the system properties" } else { "the environment" };

#[cfg(not(target_os = "android"))]
fn variable(name: &str) -> Option<OsString> {
    std::env::var_os(name)
}

/// On Android YORO_LAYER_OFFER is the system property `debug.yoro.layer.offer`. Empty means unset: a property cannot be
/// deleted.
#[cfg(target_os = "android")]
fn variable(name: &str) -> Option<OsString> {
    let key = name.strip_prefix("YORO_LAYER_")?.to_ascii_lowercase();
    let name = std::ffi::CString::new(format!("debug.yoro.layer.{key}")).ok()?;
    let mut value = [0u8; libc::PROP_VALUE_MAX as usize];
    // SAFETY: the name ends in zero, and there is room for the longest value.
    let length = unsafe { libc::__system_property_get(name.as_ptr(), value.as_mut_ptr().cast()) };
    let value = String::from_utf8_lossy(value.get(..usize::try_from(length).ok()?)?);
    let value = value.trim();
    (!value.is_empty()).then(|| value.into())
}

impl Settings {
    /// The settings of an application: the environment's, then the file's for the application, then the file's for all, then
    /// the defaults. What is wrong is told by the errors, and left at what it would be otherwise.
    pub fn of(application: &str) -> (Settings, Vec<SettingsError>) {
        let path = path();
        let text = path.as_deref().map(std::fs::read_to_string);
        let file = match (path, text) {
            (Some(path), Some(Ok(text))) => Some((path, Ok(text))),
            (Some(path), Some(Err(error))) if error.kind() != std::io::ErrorKind::NotFound => {
                Some((path, Err(error.to_string())))
            }
            _ => None,
        };
        Settings::resolve(application, file, variable)
    }

    fn resolve(
        application: &str,
        file: Option<(PathBuf, Result<String, String>)>,
        environment: impl Fn(&str) -> Option<OsString>,
    ) -> (Settings, Vec<SettingsError>) {
        let mut settings = Settings::default();
        let mut errors = Vec::new();
        if let Some((path, text)) = file {
            match text
                .and_then(|text| toml::from_str::<File>(&text).map_err(|error| error.message().to_owned()))
            {
                Ok(mut file) => {
                    let own = file.application.remove(application).unwrap_or_default();
                    let File { offer, dominant, guard_band, shrink, .. } = file;
                    settings.choose_of(&Choices { offer, dominant, guard_band, shrink }, &path, &mut errors);
                    settings.choose_of(&own, &path, &mut errors);
                }
                Err(reason) => errors.push(SettingsError::File { path, reason }),
            }
        }
        for key in ["offer", "dominant", "guard_band", "shrink"] {
            let name = format!("YORO_LAYER_{}", key.to_ascii_uppercase());
            if let Some(value) = environment(&name) {
                settings.choose(key, &value.to_string_lossy(), VARIABLES, &name, &mut errors);
            }
        }
        settings.capture = environment("YORO_LAYER_CAPTURE").map(PathBuf::from);
        if let Some(time) = environment("YORO_LAYER_TIME") {
            settings.choose("time", &time.to_string_lossy(), VARIABLES, "YORO_LAYER_TIME", &mut errors);
        }
        (settings, errors)
    }

    fn choose_of(&mut self, choices: &Choices, path: &Path, errors: &mut Vec<SettingsError>) {
        let place = path.display().to_string();
        let all = [
            ("offer", &choices.offer),
            ("dominant", &choices.dominant),
            ("guard_band", &choices.guard_band),
            ("shrink", &choices.shrink),
        ];
        for (key, value) in all {
            if let Some(value) = value {
                self.choose(key, value, &place, key, errors);
            }
        }
    }

    fn choose(&mut self, key: &str, value: &str, place: &str, name: &str, errors: &mut Vec<SettingsError>) {
        fn set<T>(place: &mut T, value: Option<T>) -> bool {
            value.map(|value| *place = value).is_some()
        }
        let (done, remedy) = match key {
            "offer" => {
                let offer = match value {
                    "only" => Some(OfferedAs::Only),
                    "first" => Some(OfferedAs::First),
                    "last" => Some(OfferedAs::Last),
                    _ => None,
                };
                (set(&mut self.offer, offer), "only, first or last")
            }
            "dominant" => {
                let eye = Eye::BOTH.into_iter().find(|eye| eye.name() == value);
                (set(&mut self.dominant, eye), "left or right")
            }
            "guard_band" => (
                {
                    // The application renders all of what it is offered.
                    let fixed =
                        GuardBand::from_str(value).ok().filter(|band| !matches!(band, GuardBand::Auto(_)));
                    set(&mut self.guard_band, fixed)
                },
                "none, pixels such as 40px, or metres such as 1.0",
            ),
            "shrink" => {
                let shrink = ["off", "on"].into_iter().position(|choice| choice == value);
                (set(&mut self.shrink, shrink.map(|choice| choice == 1)), "on or off")
            }
            _ => {
                let time = value.parse().ok().filter(|time| *time > 0);
                (set(&mut self.time, time.map(Some)), "nanoseconds, more than 0")
            }
        };
        if !done {
            let (place, key, value) = (place.to_owned(), name.to_owned(), value.to_owned());
            errors.push(SettingsError::Value { place, key, value, remedy });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn resolve(file: &str, environment: &[(&str, &str)]) -> (Settings, Vec<String>) {
        let file = Some((PathBuf::from("/c/yoro/layer.toml"), Ok(file.to_owned())));
        let (settings, errors) = Settings::resolve("hello", file, |name| {
            environment.iter().find(|(key, _)| *key == name).map(|(_, value)| (*value).into())
        });
        (settings, errors.iter().map(ToString::to_string).collect())
    }

    #[test]
    fn the_environment_comes_before_the_application_before_all() {
        let file = "offer = 'only'\ndominant = 'left'\n[application.hello]\noffer = 'last'\nguard_band = '20px'\nshrink = 'on'\n\
                    [application.other]\ndominant = 'right'\n";
        let (settings, errors) = resolve(file, &[]);
        assert!(errors.is_empty(), "{errors:?}");
        assert_eq!((settings.offer, settings.dominant), (OfferedAs::Last, Eye::Left));
        assert_eq!((settings.guard_band, settings.shrink), (GuardBand::Pixels(20), true));
        assert!(!resolve(file, &[("YORO_LAYER_SHRINK", "off")]).0.shrink);
        let (settings, _) =
            resolve(file, &[("YORO_LAYER_OFFER", "first"), ("YORO_LAYER_GUARD_BAND", "none")]);
        assert_eq!((settings.offer, settings.guard_band), (OfferedAs::First, GuardBand::None));
        assert_eq!(resolve("", &[]).0, Settings::default());
    }

    #[test]
    fn mistakes_are_one_sentence_each_and_change_nothing() {
        let (settings, errors) =
            resolve("offer = 'mono'", &[("YORO_LAYER_DOMINANT", "middle"), ("YORO_LAYER_TIME", "0")]);
        assert_eq!(settings, Settings::default());
        assert_eq!(
            errors,
            [
                "/c/yoro/layer.toml: offer is \"mono\"; give only, first or last",
                "the environment: YORO_LAYER_DOMINANT is \"middle\"; give left or right",
                "the environment: YORO_LAYER_TIME is \"0\"; give nanoseconds, more than 0",
            ]
        );
        let (settings, errors) = resolve("ofer = 'only'", &[]);
        assert_eq!(settings, Settings::default());
        assert!(errors[0].starts_with("/c/yoro/layer.toml: unknown field `ofer`"), "{errors:?}");
    }
}
