//! User settings. Environment variables (on Android, system properties) set them for one run, a file for one
//! application or for all.

use std::ffi::OsString;
use std::path::PathBuf;
use std::str::FromStr;

use openxr_sys as sys;
use toml::{Table, Value};
use yoro::eyes::{Eye, GuardBand};

use crate::xdg;

/// The position of the configuration with one view in the list of view configurations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OfferedAs {
    /// It is the only one in the list. An application that nevertheless begins in stereo still gets stereo.
    Only,
    /// Before the runtime's own.
    First,
    /// After the runtime's own.
    Last,
    /// It is not offered, and everything is passed through.
    Off,
}

/// The settings of one application.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// The position of the configuration with one view.
    pub offer: OfferedAs,
    /// The eye that the application renders.
    pub dominant: Eye,
    /// The width that is rendered beyond both eyes' views.
    pub guard_band: GuardBand,
    /// True if an application that begins in stereo is told that one eye's image is tiny.
    pub shrink: bool,
    /// YORO_LAYER_CAPTURE: a folder for pictures of what the runtime receives in one frame.
    #[cfg(feature = "capture")]
    pub capture: Option<PathBuf>,
    /// YORO_LAYER_TIME: an XrTime in nanoseconds at which all views and spaces are located. LOCAL spaces become STAGE
    /// spaces. The world stands still, so that pictures of two runs can be compared.
    #[cfg(feature = "capture")]
    pub time: Option<i64>,
}

/// A row of the table of settings.
pub struct Setting {
    /// The key in the file. The environment variable is `YORO_LAYER_` followed by the key in capitals.
    pub key: &'static str,
    /// The values that the setting accepts, as error messages list them.
    pub values: &'static str,
    /// The value if none is given.
    pub default: &'static str,
    /// The meaning, in one sentence.
    pub help: &'static str,
    /// Sets a value. Returns `None` if it is not one of `values`.
    set: fn(&mut Settings, &str) -> Option<()>,
}

/// All settings of users.
pub const SETTINGS: [Setting; 4] = [
    Setting {
        key: "offer",
        values: "only, first, last or off",
        default: "first",
        help: "Where the list of view configurations has PRIMARY_MONO: alone, before the runtime's own, or after them; \
               `off` leaves the application alone",
        set: |settings, text| {
            settings.offer = match text {
                "only" => OfferedAs::Only,
                "first" => OfferedAs::First,
                "last" => OfferedAs::Last,
                "off" => OfferedAs::Off,
                _ => return None,
            };
            Some(())
        },
    },
    Setting {
        key: "dominant",
        values: "left or right",
        default: "right",
        help: "The eye that the application renders",
        set: |settings, text| {
            settings.dominant = Eye::BOTH.into_iter().find(|eye| eye.name() == text)?;
            Some(())
        },
    },
    Setting {
        key: "guard_band",
        values: "none, pixels such as 40px, or metres such as 1.0",
        default: "1.0",
        help: "What is rendered beyond both eyes' views: columns of pixels, or as many as objects at that distance need",
        set: |settings, text| {
            settings.guard_band = GuardBand::from_str(text).ok()?;
            Some(())
        },
    },
    Setting {
        key: "shrink",
        values: "on or off",
        default: "off",
        help: "An application that begins in stereo is told that one eye's image is tiny, and that image is replaced. \
               Only for applications that make a swapchain for each eye, of the size recommended for it",
        set: |settings, text| {
            settings.shrink = match text {
                "on" => true,
                "off" => false,
                _ => return None,
            };
            Some(())
        },
    },
];

#[cfg(feature = "capture")]
const TIME: Setting = Setting {
    key: "time",
    values: "nanoseconds, more than 0",
    default: "",
    help: "The time at which all views and spaces are located",
    set: |settings, text| {
        settings.time = Some(text.parse().ok().filter(|time| *time > 0)?);
        Some(())
    },
};

impl Setting {
    /// Returns the name of the environment variable.
    pub fn variable(&self) -> String {
        format!("YORO_LAYER_{}", self.key.to_ascii_uppercase())
    }

    /// Sets the value that `place` gives for `key`.
    fn choose(
        &self,
        settings: &mut Settings,
        value: &str,
        place: &str,
        key: &str,
    ) -> Result<(), SettingsError> {
        (self.set)(settings, value).ok_or_else(|| SettingsError::Value {
            place: place.to_owned(),
            key: key.to_owned(),
            value: value.to_owned(),
            remedy: self.values,
        })
    }
}

impl Default for Settings {
    fn default() -> Settings {
        let mut settings = Settings {
            offer: OfferedAs::First,
            dominant: Eye::Right,
            guard_band: GuardBand::None,
            shrink: false,
            #[cfg(feature = "capture")]
            capture: None,
            #[cfg(feature = "capture")]
            time: None,
        };
        for setting in SETTINGS {
            // A test checks that every default is a valid value.
            (setting.set)(&mut settings, setting.default);
        }
        settings
    }
}

/// A mistake in the settings.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SettingsError {
    /// The file cannot be read, or is not TOML with these keys.
    #[error("{}: {reason}; mend it or remove it", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// The mistake, in one line.
        reason: String,
    },
    /// A value that the setting does not accept.
    #[error("{place}: {key} is {value:?}; give {remedy}")]
    Value {
        /// The environment or the file.
        place: String,
        /// The variable or the key.
        key: String,
        /// The value.
        value: String,
        /// The values that the setting accepts.
        remedy: &'static str,
    },
}

/// Returns the mistakes in the settings of every application that the file names, and in those for all applications.
pub fn mistakes() -> Vec<SettingsError> {
    mistakes_in(&file())
}

fn mistakes_in(file: &Option<SettingsFile>) -> Vec<SettingsError> {
    let mut names = vec![String::new()];
    if let Some((_, Ok(text))) = file {
        let all = text.parse::<Table>().unwrap_or_default();
        let applications = all.get("application").and_then(Value::as_table);
        names.extend(applications.into_iter().flat_map(|applications| applications.keys().cloned()));
    }
    let mut mistakes: Vec<SettingsError> = Vec::new();
    for name in names {
        let (_, errors) = Settings::resolve(&name, file.clone(), variable);
        for error in errors {
            if !mistakes.contains(&error) {
                mistakes.push(error);
            }
        }
    }
    mistakes
}

/// The path of the settings file, and its text or the reason why it cannot be read.
type SettingsFile = (PathBuf, Result<String, String>);

/// Reads the settings file, if it exists.
fn file() -> Option<SettingsFile> {
    let path = path()?;
    match std::fs::read_to_string(&path) {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => None,
        text => Some((path, text.map_err(|error| error.to_string()))),
    }
}

/// Returns the path of the settings file, `$XDG_CONFIG_HOME/yoro/layer.toml` (`~/.config` if that is not set), or
/// `None` without a home folder.
pub fn path() -> Option<PathBuf> {
    Some(xdg::folder("XDG_CONFIG_HOME", ".config")?.join("yoro/layer.toml"))
}

/// The name, for error messages, of the source of settings for one run.
const VARIABLES: &str = if cfg!(target_os = "android") { "the system properties" } else { "the environment" };

#[cfg(not(target_os = "android"))]
fn variable(name: &str) -> Option<OsString> {
    std::env::var_os(name)
}

/// Returns the value of a setting's system property. That of YORO_LAYER_OFFER is `debug.yoro.layer.offer`. A property
/// cannot be deleted, so an empty one counts as unset.
#[cfg(target_os = "android")]
fn variable(name: &str) -> Option<OsString> {
    let key = name.strip_prefix("YORO_LAYER_")?.to_ascii_lowercase();
    let name = std::ffi::CString::new(format!("debug.yoro.layer.{key}")).ok()?;
    let mut value = [0u8; libc::PROP_VALUE_MAX as usize];
    // SAFETY: the name is null-terminated, and there is room for the longest value.
    let length = unsafe { libc::__system_property_get(name.as_ptr(), value.as_mut_ptr().cast()) };
    let value = String::from_utf8_lossy(value.get(..usize::try_from(length).ok()?)?);
    let value = value.trim();
    (!value.is_empty()).then(|| value.into())
}

/// Parses the file: returns the keys for all applications, and those for this one.
fn read_file(text: &str, application: &str) -> Result<[Table; 2], String> {
    let mut all: Table = text.parse().map_err(|error: toml::de::Error| error.message().to_owned())?;
    let applications = match all.remove("application") {
        None => Table::new(),
        Some(Value::Table(applications)) => applications,
        Some(_) => return Err("`application` is no table".to_owned()),
    };
    check_keys(&all)?;
    let mut own = Table::new();
    for (name, section) in applications {
        let Value::Table(section) = section else {
            return Err(format!("`application.{name}` is no table"));
        };
        check_keys(&section)?;
        if name == application {
            own = section;
        }
    }
    Ok([all, own])
}

fn check_keys(section: &Table) -> Result<(), String> {
    match section.keys().find(|key| SETTINGS.iter().all(|setting| setting.key != *key)) {
        None => Ok(()),
        Some(unknown) => {
            let keys = SETTINGS.map(|setting| format!("`{}`", setting.key)).join(", ");
            Err(format!("unknown field `{unknown}`, expected one of {keys}"))
        }
    }
}

impl Settings {
    /// Returns the settings of an application. The environment takes precedence over the file's settings for this
    /// application, those over the file's settings for all, and those over the defaults. Mistakes are returned as
    /// errors, and change nothing.
    pub fn of(application: &str) -> (Settings, Vec<SettingsError>) {
        Settings::resolve(application, file(), variable)
    }

    fn resolve(
        application: &str,
        file: Option<SettingsFile>,
        environment: impl Fn(&str) -> Option<OsString>,
    ) -> (Settings, Vec<SettingsError>) {
        let mut settings = Settings::default();
        let mut errors = Vec::new();
        if let Some((path, text)) = file {
            match text.and_then(|text| read_file(&text, application)) {
                Ok(sections) => {
                    let all = path.display().to_string();
                    let places = [all.clone(), format!("{all}, [application.{application}]")];
                    let in_file = |section: &Table, setting: &Setting| match section.get(setting.key)? {
                        Value::String(text) => Some(text.clone()),
                        other => Some(other.to_string()),
                    };
                    for (section, place) in sections.iter().zip(&places) {
                        for setting in &SETTINGS {
                            let value = in_file(section, setting);
                            let chosen =
                                value.map(|value| setting.choose(&mut settings, &value, place, setting.key));
                            errors.extend(chosen.and_then(Result::err));
                        }
                    }
                }
                Err(reason) => errors.push(SettingsError::File { path, reason }),
            }
        }
        let mut from_environment = |setting: &Setting| {
            let name = setting.variable();
            if let Some(value) = environment(&name) {
                let value = value.to_string_lossy();
                errors.extend(setting.choose(&mut settings, &value, VARIABLES, &name).err());
            }
        };
        SETTINGS.iter().for_each(&mut from_environment);
        #[cfg(feature = "capture")]
        {
            from_environment(&TIME);
            settings.capture = environment("YORO_LAYER_CAPTURE").map(PathBuf::from);
        }
        (settings, errors)
    }

    /// Returns the time at which views and spaces are located, given the requested time.
    pub fn time(&self, asked: sys::Time) -> sys::Time {
        #[cfg(feature = "capture")]
        if let Some(time) = self.time {
            return sys::Time::from_nanos(time);
        }
        asked
    }

    /// True if pictures are taken.
    pub fn captures(&self) -> bool {
        #[cfg(feature = "capture")]
        return self.capture.is_some();
        #[cfg(not(feature = "capture"))]
        false
    }

    /// Returns the usage of swapchains whose images the layer reads.
    pub fn usage_to_read(&self) -> sys::SwapchainUsageFlags {
        let sampled = sys::SwapchainUsageFlags::SAMPLED;
        if self.captures() { sampled | sys::SwapchainUsageFlags::TRANSFER_SRC } else { sampled }
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

    /// The table in docs/openxr-layer.md has the rows of [`SETTINGS`], and no others.
    #[test]
    fn the_document_has_the_table_of_settings() {
        let rows = SETTINGS.map(|Setting { key, values, default, help, .. }| {
            format!("| `{key}` | {values} | `{default}` | {help} |\n")
        });
        let table = format!("| key | values | default | |\n|---|---|---|---|\n{}\n", rows.concat());
        let document = include_str!("../../../../docs/openxr-layer.md");
        assert!(document.contains(&table), "docs/openxr-layer.md must have this table:\n{table}");
    }

    #[test]
    fn every_default_is_a_value_of_its_setting() {
        for setting in SETTINGS {
            assert!((setting.set)(&mut Settings::default(), setting.default).is_some(), "{}", setting.key);
        }
        let Settings { offer, dominant, guard_band, shrink, .. } = Settings::default();
        assert_eq!((offer, dominant), (OfferedAs::First, Eye::Right));
        assert_eq!((guard_band, shrink), (GuardBand::Distance(1.0), false));
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
        let (settings, errors) = resolve(
            "offer = 'mono'\nguard_band = true",
            &[("YORO_LAYER_DOMINANT", "middle"), ("YORO_LAYER_TIME", "0")],
        );
        assert_eq!(settings, Settings::default());
        assert_eq!(
            errors,
            [
                "/c/yoro/layer.toml: offer is \"mono\"; give only, first, last or off",
                "/c/yoro/layer.toml: guard_band is \"true\"; give none, pixels such as 40px, or metres such as 1.0",
                "the environment: YORO_LAYER_DOMINANT is \"middle\"; give left or right",
                "the environment: YORO_LAYER_TIME is \"0\"; give nanoseconds, more than 0",
            ]
        );
        // A number needs no quotes.
        for (number, metres) in [("2.5", 2.5), ("1.0", 1.0), ("3", 3.0)] {
            let (settings, errors) = resolve(&format!("guard_band = {number}"), &[]);
            assert_eq!((settings.guard_band, errors), (GuardBand::Distance(metres), vec![]), "{number}");
        }
        let other = "dominant = 'left'\n[application.other]\ndominant = 'middle'";
        assert!(resolve(other, &[]).1.is_empty());
        let mistakes = mistakes_in(&Some(("/c/yoro/layer.toml".into(), Ok(other.to_owned()))));
        let mistakes: Vec<_> = mistakes.iter().map(ToString::to_string).collect();
        let want = "/c/yoro/layer.toml, [application.other]: dominant is \"middle\"; give left or right";
        assert_eq!(mistakes, [want]);
        let (settings, errors) = resolve("ofer = 'only'", &[]);
        assert_eq!(settings, Settings::default());
        assert!(errors[0].starts_with("/c/yoro/layer.toml: unknown field `ofer`"), "{errors:?}");
    }
}
