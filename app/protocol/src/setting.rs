//! A setting: one row of the table of settings.

use toml::Value;

use crate::settings::{SETTINGS, Settings};
use crate::value::{Choice, SettingValue, plain};

/// The prefix of Android's system properties that are settings: `adb shell setprop debug.yoro.method mono`.
pub const PROPERTY_PREFIX: &str = "debug.yoro.";

/// One setting of the viewer, a row of [`SETTINGS`]: what it is called, what it does, and which values it takes.
pub struct Setting {
    /// The key in files, `key=value` texts, intent extras and system properties; the option's name on the command line.
    pub key: &'static str,
    help: &'static str,
    /// The placeholder of the value on the command line, where it is not the key itself.
    pub value_name: Option<&'static str>,
    /// The default that `auto` stands for, for settings whose default depends on something else.
    pub auto: Option<&'static str>,
    /// Help of the command line's option `--no-KEY`, for those that are `true` by default.
    pub off_help: Option<&'static str>,
    /// The names that a value can have; empty where there are too many to list.
    pub choices: &'static [Choice],
    /// True if the value is `true` or `false`.
    pub is_bool: bool,
    /// True if the value may be left to the program, by the value `auto`.
    pub is_optional: bool,
    get: fn(&Settings) -> Option<Value>,
    set: fn(&mut Settings, &Value) -> Result<(), String>,
    range: Option<Range>,
}

/// The values that a setting takes, beyond what its type says.
struct Range {
    contains: fn(&Settings) -> bool,
    remedy: &'static str,
}

impl Setting {
    /// Returns the setting of a key.
    pub fn find(key: &str) -> Option<&'static Setting> {
        SETTINGS.iter().find(|setting| setting.key == key)
    }

    pub(crate) const fn new<T: SettingValue>(
        key: &'static str,
        help: &'static str,
        get: fn(&Settings) -> Option<Value>,
        set: fn(&mut Settings, &Value) -> Result<(), String>,
    ) -> Setting {
        Setting {
            key,
            help,
            value_name: None,
            auto: None,
            off_help: None,
            choices: T::CHOICES,
            is_bool: T::IS_BOOL,
            is_optional: T::IS_OPTIONAL,
            get,
            set,
            range: None,
        }
    }

    /// Takes only the values for which `contains` is true; `remedy` says which these are.
    pub(crate) const fn range(mut self, contains: fn(&Settings) -> bool, remedy: &'static str) -> Setting {
        self.range = Some(Range { contains, remedy });
        self
    }

    pub(crate) const fn value_name(mut self, name: &'static str) -> Setting {
        self.value_name = Some(name);
        self
    }

    pub(crate) const fn auto(mut self, default: &'static str) -> Setting {
        self.auto = Some(default);
        self
    }

    pub(crate) const fn off_help(mut self, help: &'static str) -> Setting {
        self.off_help = Some(help);
        self
    }

    /// The help as one line of Markdown without a full stop.
    pub fn help(&self) -> String {
        self.help.split_whitespace().collect::<Vec<_>>().join(" ").trim_end_matches('.').to_owned()
    }

    /// The row of docs/viewer.md.
    #[cfg(test)]
    pub(crate) fn markdown(&self) -> String {
        let default = match (self.default().as_str(), self.auto) {
            ("", _) => "none".into(),
            (_, Some(auto)) => format!("`auto`: {auto}"),
            (default, None) => format!("`{default}`"),
        };
        let names: Vec<_> = self.choices.iter().map(|choice| format!("`{}`", choice.name)).collect();
        let names = if names.is_empty() { String::new() } else { format!(" ({})", names.join(", ")) };
        format!("| `{}` | {default} | {}{names} |\n", self.key, self.help())
    }

    /// The default as a text that [`Settings::apply`] takes.
    pub fn default(&self) -> String {
        self.text(&Settings::default())
    }

    /// The value in some settings as a text that [`Settings::apply`] takes.
    pub fn text(&self, settings: &Settings) -> String {
        match self.value(settings) {
            None => "auto".into(),
            Some(Value::Array(list)) => list.iter().map(plain).collect::<Vec<_>>().join(","),
            Some(value) => plain(&value),
        }
    }

    /// The value in some settings; `None` if it is left to the program.
    pub(crate) fn value(&self, settings: &Settings) -> Option<Value> {
        (self.get)(settings)
    }

    /// Changes the value in some settings.
    ///
    /// # Errors
    /// The remedy; the settings stay as they were.
    pub(crate) fn set(&self, settings: &mut Settings, value: &Value) -> Result<(), String> {
        let range = self.range.as_ref().filter(|_| self.choices.is_empty());
        let remedy = |reason: String| range.map_or(reason, |range| range.remedy.into());
        let mut changed = settings.clone();
        (self.set)(&mut changed, value).map_err(remedy)?;
        if let Some(range) = &self.range
            && !(range.contains)(&changed)
        {
            return Err(range.remedy.into());
        }
        *settings = changed;
        Ok(())
    }

    /// Changes the value in some settings by a text: a list as in TOML or separated by commas, `auto` to leave it to
    /// the program, an empty text to change nothing.
    ///
    /// # Errors
    /// The value as it was understood, and the remedy; the settings stay as they were.
    pub fn parse_into(&self, settings: &mut Settings, text: &str) -> Result<(), (String, String)> {
        let text = text.trim();
        if text.is_empty() {
            return Ok(());
        }
        // A number, a switch or a list in TOML; anything else is a plain word.
        let typed = format!("x = {text}").parse::<toml::Table>().ok().and_then(|mut table| table.remove("x"));
        if typed.as_ref().is_some_and(|value| self.set(settings, value).is_ok()) {
            return Ok(());
        }
        let word = Value::from(text);
        let shown = typed.as_ref().unwrap_or(&word).to_string();
        self.set(settings, &word).map_err(|remedy| (shown, remedy))
    }
}
