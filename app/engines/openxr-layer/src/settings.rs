//! User settings. Environment variables (on Android, system properties) set them for one run, a file for one
//! application or for all.

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use serde::Deserialize;
use serde::de::{Deserializer, Error as _};
use toml::{Table, Value};
use yoro::eyes::{Eye, GuardBand};

use crate::xdg;

/// The position of the configuration with one view in the list of view configurations.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum OfferedAs {
    /// It is the only one: calls for others are refused.
    Only,
    /// Before the runtime's own.
    First,
    /// After the runtime's own.
    Last,
    /// It is not offered, and everything is passed through.
    Off,
}

/// The settings of one application. [openxr-layer.md](../../../../docs/openxr-layer.md) describes them for users.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Settings {
    /// The position of the configuration with one view.
    pub offer: OfferedAs,
    /// The eye that the application renders.
    #[serde(deserialize_with = "eye")]
    pub dominant: Eye,
    /// The width that is rendered beyond both eyes' views.
    #[serde(deserialize_with = "guard_band")]
    pub guard_band: GuardBand,
    /// True if one eye's image is recommended to be tiny to applications that begin in stereo, and replaced.
    #[serde(deserialize_with = "switch")]
    pub shrink: bool,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings {
            offer: OfferedAs::First,
            dominant: Eye::Right,
            guard_band: GuardBand::Distance(1.0),
            shrink: false,
        }
    }
}

/// The keys of the file. The environment variables are `YORO_LAYER_` followed by a key in capitals.
const KEYS: [&str; 4] = ["offer", "dominant", "guard_band", "shrink"];

fn eye<'de, D: Deserializer<'de>>(value: D) -> Result<Eye, D::Error> {
    let name = String::deserialize(value)?;
    let eye = Eye::BOTH.into_iter().find(|eye| eye.name() == name);
    eye.ok_or_else(|| D::Error::unknown_variant(&name, &["left", "right"]))
}

fn switch<'de, D: Deserializer<'de>>(value: D) -> Result<bool, D::Error> {
    match String::deserialize(value)?.as_str() {
        "on" => Ok(true),
        "off" => Ok(false),
        other => Err(D::Error::unknown_variant(other, &["on", "off"])),
    }
}

/// Reads a text or, since it needs no quotes, a number of metres.
fn guard_band<'de, D: Deserializer<'de>>(value: D) -> Result<GuardBand, D::Error> {
    let text = match Value::deserialize(value)? {
        Value::String(text) => text,
        other => other.to_string(),
    };
    GuardBand::from_str(&text).map_err(|_| {
        let remedy = "give none, pixels such as 40px, or metres such as 1.0";
        D::Error::custom(format!("{text:?} is no guard band: {remedy}"))
    })
}

/// A mistake in the settings.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{place}: {reason}; mend it or remove it")]
pub struct SettingsError {
    /// The file, with the section of a single application, or the variable.
    place: String,
    /// What is wrong, and what would be right, in one line.
    reason: String,
}

impl SettingsError {
    fn new(place: String, reason: impl ToString) -> SettingsError {
        // serde names the key on a line of its own.
        let reason = reason.to_string().trim_end().replace('\n', " ");
        SettingsError { place, reason }
    }
}

/// The settings file: keys for all applications, and those for single ones.
#[derive(Deserialize)]
struct SettingsFile {
    #[serde(default)]
    application: BTreeMap<String, Table>,
    #[serde(flatten)]
    all: Table,
}

/// Values from one place.
struct Source {
    place: String,
    /// The only application that they are meant for, or `None` for all.
    application: Option<String>,
    values: Table,
}

/// Returns the mistakes in the settings of every application that the file names, and in those for all applications.
pub fn mistakes() -> Vec<SettingsError> {
    mistakes_in(read_file(), variable)
}

fn mistakes_in(
    file: Result<Vec<Source>, SettingsError>,
    environment: impl Fn(&str) -> Option<OsString>,
) -> Vec<SettingsError> {
    let mistake = |source: Source| {
        let error = Settings::deserialize(source.values).err()?;
        Some(SettingsError::new(source.place, error))
    };
    match file {
        Ok(sections) => sections.into_iter().chain(variables(environment)).filter_map(mistake).collect(),
        Err(error) => vec![error],
    }
}

/// Returns the sections of the settings file, which are none if it does not exist.
fn read_file() -> Result<Vec<Source>, SettingsError> {
    let Some(path) = path() else { return Ok(Vec::new()) };
    match std::fs::read_to_string(&path) {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(Vec::new()),
        Err(error) => Err(SettingsError::new(path.display().to_string(), error)),
        Ok(text) => sections(&path, &text),
    }
}

/// Returns the sections of the file, first that for all applications.
fn sections(path: &Path, text: &str) -> Result<Vec<Source>, SettingsError> {
    let path = path.display().to_string();
    let file: SettingsFile =
        toml::from_str(text).map_err(|error| SettingsError::new(path.clone(), error.message()))?;
    let mut sources = vec![Source { place: path.clone(), application: None, values: file.all }];
    sources.extend(file.application.into_iter().map(|(name, values)| Source {
        place: format!("{path}, [application.{name}]"),
        application: Some(name),
        values,
    }));
    Ok(sources)
}

/// Returns the settings of the environment.
fn variables(environment: impl Fn(&str) -> Option<OsString>) -> impl Iterator<Item = Source> {
    KEYS.into_iter().filter_map(move |key| {
        let place = format!("YORO_LAYER_{}", key.to_ascii_uppercase());
        let value = environment(&place)?.to_string_lossy().into_owned();
        let values = Table::from_iter([(key.to_owned(), Value::String(value))]);
        Some(Source { place, application: None, values })
    })
}

/// Returns the path of the settings file, `$XDG_CONFIG_HOME/yoro/layer.toml` (`~/.config` if that is not set), or
/// `None` without a home folder.
pub fn path() -> Option<PathBuf> {
    Some(xdg::folder("XDG_CONFIG_HOME", ".config")?.join("yoro/layer.toml"))
}

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

impl Settings {
    /// Returns the settings of an application. The environment takes precedence over the file's settings for this
    /// application, those over the file's settings for all, and those over the defaults. A section or a variable with a
    /// mistake is returned as an error, and changes nothing.
    pub fn of(application: &str) -> (Settings, Vec<SettingsError>) {
        Settings::resolve(application, read_file(), variable)
    }

    fn resolve(
        application: &str,
        file: Result<Vec<Source>, SettingsError>,
        environment: impl Fn(&str) -> Option<OsString>,
    ) -> (Settings, Vec<SettingsError>) {
        let (mut settings, mut values, mut errors) = (Settings::default(), Table::new(), Vec::new());
        let sections = file.unwrap_or_else(|error| {
            errors.push(error);
            Vec::new()
        });
        let is_meant = |source: &Source| source.application.as_ref().is_none_or(|name| name == application);
        for source in sections.into_iter().filter(is_meant).chain(variables(environment)) {
            let mut all = values.clone();
            all.extend(source.values);
            match Settings::deserialize(all.clone()) {
                Ok(read) => (settings, values) = (read, all),
                Err(error) => errors.push(SettingsError::new(source.place, error)),
            }
        }
        (settings, errors)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn environment(variables: &[(&str, &str)]) -> impl Fn(&str) -> Option<OsString> {
        |name| variables.iter().find(|(key, _)| *key == name).map(|(_, value)| value.into())
    }

    fn resolve(file: &str, variables: &[(&str, &str)]) -> (Settings, Vec<String>) {
        let file = sections(Path::new("/c/yoro/layer.toml"), file);
        let (settings, errors) = Settings::resolve("hello", file, environment(variables));
        (settings, errors.iter().map(ToString::to_string).collect())
    }

    /// The rows of the table are the keys, and have the defaults.
    #[test]
    fn the_document_has_a_row_for_every_setting() {
        let document = include_str!("../../../../docs/openxr-layer.md");
        let (_, table) = document.split_once("| key | values | default | |\n|---|---|---|---|\n").unwrap();
        let rows: Vec<Vec<&str>> = table
            .lines()
            .map_while(|row| row.strip_prefix("| `"))
            .map(|row| row.split(" | ").map(|cell| cell.trim_matches('`')).collect())
            .collect();
        assert_eq!(rows.iter().map(|row| row[0]).collect::<Vec<_>>(), KEYS);
        let defaults: Vec<_> = rows.iter().map(|row| format!("{} = {:?}\n", row[0], row[2])).collect();
        assert_eq!(resolve(&defaults.concat(), &[]), (Settings::default(), vec![]));
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
        // A number needs no quotes.
        for (number, metres) in [("2.5", 2.5), ("1.0", 1.0), ("3", 3.0)] {
            let (settings, errors) = resolve(&format!("guard_band = {number}"), &[]);
            assert_eq!((settings.guard_band, errors), (GuardBand::Distance(metres), vec![]), "{number}");
        }
    }

    #[test]
    fn mistakes_are_one_sentence_each_and_change_nothing() {
        let file = "dominant = 'left'\n[application.hello]\noffer = 'mono'\nguard_band = 'none'\n";
        let variables = [
            ("YORO_LAYER_DOMINANT", "middle"),
            ("YORO_LAYER_GUARD_BAND", "auto"),
            ("YORO_LAYER_SHRINK", "1"),
            ("YORO_LAYER_OFFER", "last"),
        ];
        let (settings, errors) = resolve(file, &variables);
        let right = Settings { dominant: Eye::Left, offer: OfferedAs::Last, ..Settings::default() };
        assert_eq!(settings, right);
        let remedy = "give none, pixels such as 40px, or metres such as 1.0";
        let hello = "/c/yoro/layer.toml, [application.hello]: unknown variant `mono`, \
                     expected one of `only`, `first`, `last`, `off` in `offer`; mend it or remove it";
        let others = [
            "YORO_LAYER_DOMINANT: unknown variant `middle`, expected `left` or `right` in `dominant`"
                .to_owned(),
            format!("YORO_LAYER_GUARD_BAND: \"auto\" is no guard band: {remedy} in `guard_band`"),
            "YORO_LAYER_SHRINK: unknown variant `1`, expected `on` or `off` in `shrink`".to_owned(),
        ];
        let others = others.map(|error| format!("{error}; mend it or remove it"));
        assert_eq!(errors, [&[hello.to_owned()], &others[..]].concat());
    }

    #[test]
    fn a_mistake_in_the_file_names_its_section() {
        for (file, what) in [
            ("ofer = 'only'", "/c/yoro/layer.toml: unknown field `ofer`"),
            ("offer =", "/c/yoro/layer.toml: "),
            ("application = 1", "/c/yoro/layer.toml: "),
            ("guard_band = true", "/c/yoro/layer.toml: \"true\" is no guard band: give none"),
        ] {
            let (settings, errors) = resolve(file, &[]);
            assert_eq!(settings, Settings::default());
            assert!(errors.len() == 1 && errors[0].starts_with(what), "{errors:?}");
            assert!(errors[0].ends_with("; mend it or remove it") && !errors[0].contains('\n'), "{errors:?}");
        }
        let other = "dominant = 'left'\n[application.other]\ndominant = 'middle'";
        assert!(resolve(other, &[]).1.is_empty());
        let mistakes = mistakes_in(sections(Path::new("/c/yoro/layer.toml"), other), environment(&[]));
        let [mistake] = &mistakes[..] else { panic!("{mistakes:?}") };
        assert_eq!(mistake.place, "/c/yoro/layer.toml, [application.other]");
    }
}
