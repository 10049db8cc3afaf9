//! Settings from outside, from the weakest to the strongest source: defaults < file < menu < intent extras < system
//! properties < the user's changes before Android stopped the activity.

pub mod writer;

use std::path::PathBuf;

use yoro_settings::{PROPERTY_PREFIX, SETTINGS, Setting, Settings};

/// The optional prefix of intent extras. Extras of the system contain other dots.
const EXTRA_PREFIX: &str = "yoro.";
/// The settings file in the application's external folder.
pub const FILE_NAME: &str = "yoro.toml";

/// A setting as text: key and value.
pub type Pair = (String, String);

/// The sources of settings, each overriding those before it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sources {
    /// The path of a TOML file, which may be missing.
    pub file: Option<PathBuf>,
    /// The menu's changes, including those before a restart. A named run (setting `run`, as in runs of `yoro device`)
    /// ignores them.
    pub menu: Vec<Pair>,
    /// Extras of the intent that started the activity.
    pub extras: Vec<Pair>,
    /// System properties, without their prefix.
    pub properties: Vec<Pair>,
    /// Changes that the user had made when Android stopped the activity.
    pub saved: Vec<Pair>,
}

impl Sources {
    /// Sets the present system properties. A property that has changed since the last call overrides the user's own
    /// changes. Returns true if any property has changed.
    pub fn set_properties(&mut self, properties: Vec<Pair>) -> bool {
        if properties == self.properties {
            return false;
        }
        self.saved.retain(|(key, _)| value(&self.properties, key) == value(&properties, key));
        self.properties = properties;
        true
    }

    /// True if the run has a name: it is a measurement, which the user's menu settings must not affect.
    pub fn is_named_run(&self) -> bool {
        let extras = self.extras.iter().filter_map(|(key, _)| extra_key(key));
        extras.chain(self.properties.iter().map(|(key, _)| key.as_str())).any(|key| key == "run")
    }

    /// True if no settings came from a computer, so a person has started the application by hand.
    pub fn is_by_hand(&self) -> bool {
        self.properties.is_empty() && !self.extras.iter().any(|(key, _)| extra_key(key).is_some())
    }

    /// True if a viewer was chosen, by the user or in the file.
    pub fn has_viewer(&self) -> bool {
        let is_in_file = |path: &PathBuf| {
            let mut settings = Settings { viewer: String::new(), ..Settings::default() };
            path.exists() && (settings.apply_file_leniently(path), !settings.viewer.is_empty()).1
        };
        value(&self.menu, "viewer").is_some() || self.file.as_ref().is_some_and(is_in_file)
    }

    /// Stores settings of the menu, replacing earlier values.
    pub fn keep(&mut self, pairs: impl IntoIterator<Item = Pair>) {
        for (key, value) in pairs {
            self.menu.retain(|(other, _)| *other != key);
            self.menu.push((key, value));
        }
    }

    /// Returns the settings, and one sentence for each mistake; a wrong setting keeps its value.
    pub fn resolve(&self) -> (Settings, Vec<String>) {
        let mut settings = Settings::default();
        let mut mistakes = Vec::new();
        if let Some(path) = self.file.as_ref().filter(|path| path.exists()) {
            mistakes.extend(settings.apply_file_leniently(path).iter().map(ToString::to_string));
        }
        let extras = self.extras.iter().filter_map(|(key, value)| Some((extra_key(key)?, value)));
        let saved = self.saved.iter().map(|(key, value)| (key.as_str(), value));
        let properties = self.properties.iter().map(|(key, value)| (key.as_str(), value));
        let menu = if self.is_named_run() { &[][..] } else { &self.menu };
        let menu = menu.iter().map(|(key, value)| (key.as_str(), value));
        let layers = [
            ("the settings of the menu", menu.collect()),
            ("the intent's extras", extras.collect::<Vec<_>>()),
            ("the system properties debug.yoro.*", properties.collect()),
            ("the saved state", saved.collect()),
        ];
        for (origin, pairs) in layers {
            for (key, value) in pairs {
                if let Err(error) = settings.apply(&format!("{key}={value}")) {
                    mistakes.push(format!("in {origin}: {error}"));
                }
            }
        }
        mistakes.extend(settings.contradiction().map(|error| error.to_string()));
        (settings, mistakes)
    }
}

/// Returns the value of a key; the last one if there are several.
fn value<'a>(pairs: &'a [Pair], key: &str) -> Option<&'a str> {
    pairs.iter().rev().find(|(k, _)| k == key).map(|(_, value)| value.as_str())
}

/// Returns the setting that an extra names; `None` for extras that are not settings.
fn extra_key(key: &str) -> Option<&str> {
    match key.strip_prefix(EXTRA_PREFIX) {
        Some(own) => Some(own),
        None => (!key.contains('.')).then_some(key),
    }
}

/// Returns the settings in system properties; `read` returns a property by its full name. Empty means unset, since a
/// property cannot be deleted.
pub fn properties(read: impl Fn(&str) -> Option<String>) -> Vec<Pair> {
    let pair = |setting: &Setting| {
        let value = read(&format!("{PROPERTY_PREFIX}{}", setting.key))?;
        let value = value.trim();
        (!value.is_empty()).then(|| (setting.key.to_owned(), value.to_owned()))
    };
    SETTINGS.iter().filter_map(pair).collect()
}

/// Encodes settings for Android to keep while the activity is stopped.
pub fn save(pairs: &[Pair]) -> Vec<u8> {
    pairs.iter().map(|(key, value)| format!("{key}={value}\n")).collect::<String>().into_bytes()
}

/// Decodes the bytes of [`save`]. Keys that this version does not know are left out.
pub fn restore(bytes: &[u8]) -> Vec<Pair> {
    let text = String::from_utf8_lossy(bytes);
    let pair = |line: &str| {
        let (key, value) = line.split_once('=')?;
        Setting::find(key).map(|_| (key.to_owned(), value.to_owned()))
    };
    text.lines().filter_map(pair).collect()
}

#[cfg(test)]
mod tests {
    use std::collections::HashMap;

    use yoro_settings::{Ipd, Method};

    use super::*;

    fn pairs(list: &[(&str, &str)]) -> Vec<Pair> {
        list.iter().map(|(key, value)| ((*key).into(), (*value).into())).collect()
    }

    #[test]
    fn the_stronger_source_wins() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join(FILE_NAME);
        std::fs::write(&file, "method = \"mono\"\nipd = 0.05\nviewpoint = 7\nscene = \"talk\"\n").unwrap();
        let sources = Sources {
            file: Some(file),
            extras: pairs(&[
                ("ipd", "0.06"),
                ("yoro.scene", "stage"),
                ("android.intent.extra.REFERRER", "x"),
            ]),
            menu: pairs(&[("viewpoint", "9"), ("ipd", "0.07")]),
            properties: pairs(&[("ipd", "0.065"), ("hud", "false")]),
            saved: pairs(&[("ipd", "0.055")]),
        };
        let (settings, mistakes) = sources.resolve();
        assert!(mistakes.is_empty(), "{mistakes:?}");
        assert_eq!(
            (settings.method, settings.ipd, settings.viewpoint),
            (Method::Mono.into(), Some(Ipd::nearest(0.055)), 9)
        );
        assert_eq!((settings.scene.as_str(), settings.hud), ("stage", false));
    }

    #[test]
    fn a_mistake_costs_one_setting_and_one_sentence() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join(FILE_NAME);
        std::fs::write(&file, "viewpoint = 7\nmethod = \"magic\"\ncolour = 1\n").unwrap();
        let sources = Sources {
            file: Some(file),
            extras: pairs(&[("ipd", "2"), ("speed", "1")]),
            properties: pairs(&[("hud", "perhaps"), ("render-scale", "0.5")]),
            ..Sources::default()
        };
        let (settings, mistakes) = sources.resolve();
        assert_eq!((settings.viewpoint, settings.render_scale), (7, 0.5));
        assert_eq!(Settings { viewpoint: 0, render_scale: 1.0, ..settings }, Settings::default());
        let expected = ["colour", "method", "ipd", "speed", "hud"];
        assert_eq!(mistakes.len(), expected.len(), "{mistakes:#?}");
        for key in expected {
            assert_eq!(
                mistakes.iter().filter(|m| m.contains(&format!("\"{key}\""))).count(),
                1,
                "{mistakes:#?}"
            );
        }
        assert!(mistakes.iter().all(|m| !m.contains('\n')), "{mistakes:#?}");
    }

    #[test]
    fn broken_and_missing_files() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join(FILE_NAME);
        let resolve = || Sources { file: Some(file.clone()), ..Sources::default() }.resolve();
        assert_eq!(resolve(), (Settings::default(), Vec::new()));
        std::fs::write(&file, "scene = = 1").unwrap();
        let (settings, mistakes) = resolve();
        assert_eq!((settings, mistakes.len()), (Settings::default(), 1));
        assert!(mistakes[0].contains(FILE_NAME));
        std::fs::write(&file, b"\xff\xfe").unwrap();
        assert_eq!(resolve().1.len(), 1);
    }

    #[test]
    fn properties_by_their_names() {
        let set = HashMap::from([
            ("debug.yoro.method", "mono"),
            ("debug.yoro.guard-band", " 40px "),
            ("debug.yoro.scene", ""),
            ("debug.other.hud", "false"),
        ]);
        let found = properties(|name| set.get(name).map(|value| (*value).to_owned()));
        assert_eq!(found, pairs(&[("method", "mono"), ("guard-band", "40px")]));
    }

    #[test]
    fn a_new_property_is_stronger_than_what_was_done_by_hand() {
        let mut sources = Sources {
            properties: pairs(&[("hud", "false")]),
            saved: pairs(&[("method", "mono"), ("ipd", "0.05")]),
            ..Sources::default()
        };
        assert!(!sources.set_properties(pairs(&[("hud", "false")])));
        assert!(sources.set_properties(pairs(&[("method", "conventional")])));
        let (settings, mistakes) = sources.resolve();
        assert_eq!(
            (settings.method, settings.ipd, settings.hud),
            (Method::Conventional.into(), Some(Ipd::nearest(0.05)), true)
        );
        assert!(mistakes.is_empty(), "{mistakes:?}");
    }

    #[test]
    fn a_named_run_knows_nothing_of_the_menu() {
        let menu = pairs(&[("method", "mono"), ("hud", "false")]);
        let mut sources = Sources { menu, extras: pairs(&[("hud", "true")]), ..Sources::default() };
        let (settings, _) = sources.resolve();
        assert_eq!((settings.method, settings.hud), (Method::Mono.into(), true));
        sources.extras = pairs(&[("yoro.run", "7")]);
        let (settings, mistakes) = sources.resolve();
        assert_eq!((settings.method, settings.hud), (Settings::default().method, true));
        assert!(mistakes.is_empty(), "{mistakes:?}");
    }

    #[test]
    fn a_start_by_hand_and_the_choice_of_a_viewer_are_known() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join(FILE_NAME);
        let mut sources = Sources {
            file: Some(file.clone()),
            extras: pairs(&[("android.intent.extra.REFERRER", "x")]),
            ..Sources::default()
        };
        assert!(sources.is_by_hand() && !sources.has_viewer());
        std::fs::write(&file, "scene = \"talk\"").unwrap();
        assert!(!sources.has_viewer());
        sources.keep(pairs(&[("hud", "true"), ("viewer", "v1")]));
        assert!(sources.has_viewer());
        sources.keep(pairs(&[("viewer", "v2")]));
        assert_eq!(sources.menu, pairs(&[("hud", "true"), ("viewer", "v2")]));
        sources.menu.clear();
        std::fs::write(&file, "viewer = \"v2\"").unwrap();
        assert!(sources.has_viewer());
        sources.extras = pairs(&[("hud", "false")]);
        assert!(!sources.is_by_hand());
        let properties = pairs(&[("hud", "false")]);
        assert!(!Sources { properties, ..Sources::default() }.is_by_hand());
    }

    #[test]
    fn saved_settings_come_back() {
        let saved = pairs(&[("method", "mono"), ("ipd", "0.064")]);
        assert_eq!(restore(&save(&saved)), saved);
        assert_eq!(restore(b"method=mono\nold-key=1\n\xff=\n=\nnonsense"), pairs(&[("method", "mono")]));
        assert_eq!(restore(b""), Vec::new());
    }
}
