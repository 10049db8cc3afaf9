//! A setting: one row of the table of settings.

use toml::Value;

use crate::settings::{SETTINGS, Settings};
use crate::value::{Choice, SettingValue, plain, shown};

/// The prefix of Android's system properties that are settings: `adb shell setprop debug.yoro.method mono`.
pub const PROPERTY_PREFIX: &str = "debug.yoro.";

/// A setting of the viewer, one row of [`SETTINGS`]: its name, its effect, and the values it takes.
pub struct Setting {
    /// The key in files, `key=value` texts, intent extras and system properties; the name of the command line option,
    /// if the program has one for it.
    pub key: &'static str,
    help: &'static str,
    /// The placeholder for the value on the command line, if it is not the key.
    pub value_name: Option<&'static str>,
    /// The default that `auto` stands for, if the default depends on something else.
    pub auto: Option<&'static str>,
    /// The help of the command line's option `--no-KEY`, for settings that are `true` by default.
    pub off_help: Option<&'static str>,
    /// The names of the possible values; empty if there are too many to list.
    pub choices: &'static [Choice],
    /// True if the value is `true` or `false`.
    pub is_bool: bool,
    /// True if the value may be `auto`, which leaves it to the program.
    pub is_optional: bool,
    get: fn(&Settings) -> Option<Value>,
    set: fn(&mut Settings, &Value) -> Result<(), String>,
    range: Option<Range>,
}

/// The values that a setting accepts, in addition to the constraints of its type.
struct Range {
    contains: fn(&Settings) -> bool,
    remedy: &'static str,
}

impl Setting {
    /// Returns the setting with this key.
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

    /// Restricts the values to those for which `contains` is true; `remedy` says which these are.
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

    /// Returns the help as one line of Markdown, without a full stop.
    pub fn help(&self) -> String {
        self.help.split_whitespace().collect::<Vec<_>>().join(" ").trim_end_matches('.').to_owned()
    }

    /// Returns the setting's row in docs/settings.md.
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

    /// Returns the default as a text that [`Settings::apply`] accepts.
    pub fn default(&self) -> String {
        self.text(&Settings::default())
    }

    /// Returns the value in `settings` as a text that [`Settings::apply`] accepts.
    pub fn text(&self, settings: &Settings) -> String {
        match self.value(settings) {
            None => "auto".into(),
            Some(Value::Array(list)) => list.iter().map(plain).collect::<Vec<_>>().join(","),
            Some(value) => plain(&value),
        }
    }

    /// Returns the value in `settings`; `None` if it is left to the program.
    pub(crate) fn value(&self, settings: &Settings) -> Option<Value> {
        (self.get)(settings)
    }

    /// Sets the value in `settings`.
    ///
    /// # Errors
    /// The remedy; the settings stay unchanged.
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

    /// Sets the value in `settings` from a text: a list is written as in TOML or separated by commas, `auto` leaves the
    /// value to the program, and an empty text changes nothing.
    ///
    /// # Errors
    /// The value as it was understood, and the remedy; the settings stay unchanged.
    pub fn parse_into(&self, settings: &mut Settings, text: &str) -> Result<(), (String, String)> {
        let text = text.trim();
        if text.is_empty() {
            return Ok(());
        }
        // A number, a Boolean or a list in TOML; anything else is a plain word.
        let typed = format!("x = {text}").parse::<toml::Table>().ok().and_then(|mut table| table.remove("x"));
        if typed.as_ref().is_some_and(|value| self.set(settings, value).is_ok()) {
            return Ok(());
        }
        let word = Value::from(text);
        let shown = shown(typed.as_ref().unwrap_or(&word));
        self.set(settings, &word).map_err(|remedy| (shown, remedy))
    }
}
