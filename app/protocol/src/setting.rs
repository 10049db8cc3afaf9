//! One row of the table of settings, and how values of each type are read and written.

use toml::Value;
use yoro::eyes::{Eye, GuardBand};
use yoro::synthesis::Edges;

use crate::choices::Choice;
use crate::quantities::{ImBufferSize, Ipd, ScreenSize};
use crate::settings::Settings;

/// One setting: what it is called, what it does, and which values it takes.
pub struct Setting {
    /// The key in files, `key=value` texts, intent extras and system properties; the option's name on the command line.
    pub key: &'static str,
    help: &'static str,
    /// The placeholder of the value on the command line, where it is not the key itself.
    pub value_name: Option<&'static str>,
    /// The default that `auto` stands for, for settings whose default depends on something else.
    pub auto: Option<&'static str>,
    /// Help of the command line's option `--no-KEY`, for switches that are on by default.
    pub off_help: Option<&'static str>,
    /// The names that a value can have; empty where there are too many to list.
    pub choices: &'static [Choice],
    /// True if the value is `true` or `false`.
    pub is_switch: bool,
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
            is_switch: T::IS_SWITCH,
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

    /// Returns the row of a key.
    pub fn find(key: &str) -> Option<&'static Setting> {
        crate::SETTINGS.iter().find(|setting| setting.key == key)
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

    /// Changes the value in some settings by a text: a list as in TOML or separated by commas, `auto` to leave it to the
    /// program, an empty text to change nothing.
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

/// A value without the quotes of TOML. Numbers are shown as they were given, not as doubles.
fn plain(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        Value::Float(number) => (*number as f32).to_string(),
        other => other.to_string(),
    }
}

/// A type that settings can have.
pub(crate) trait SettingValue: Sized {
    const CHOICES: &'static [Choice] = &[];
    const IS_SWITCH: bool = false;
    const IS_OPTIONAL: bool = false;

    /// Reads a value; the error is the remedy.
    fn read(value: &Value) -> Result<Self, String>;

    /// Writes a value; `None` if it is left to the program.
    fn write(&self) -> Option<Value>;
}

impl SettingValue for bool {
    const IS_SWITCH: bool = true;

    fn read(value: &Value) -> Result<bool, String> {
        value.as_bool().ok_or_else(|| "give true or false".into())
    }

    fn write(&self) -> Option<Value> {
        Some((*self).into())
    }
}

impl SettingValue for f32 {
    fn read(value: &Value) -> Result<f32, String> {
        let number = value.as_float().or_else(|| value.as_integer().map(|n| n as f64));
        number.map(|number| number as f32).ok_or_else(|| "give a number".into())
    }

    fn write(&self) -> Option<Value> {
        Some(f64::from(*self).into())
    }
}

impl SettingValue for String {
    fn read(value: &Value) -> Result<String, String> {
        value.as_str().map(str::to_owned).ok_or_else(|| "write it in quotes".into())
    }

    fn write(&self) -> Option<Value> {
        Some(self.as_str().into())
    }
}

impl<T: SettingValue> SettingValue for Vec<T> {
    const CHOICES: &'static [Choice] = T::CHOICES;

    fn read(value: &Value) -> Result<Vec<T>, String> {
        match value {
            Value::Array(list) => list.iter().map(T::read).collect(),
            Value::String(words) => words.split(',').map(|word| T::read(&word.trim().into())).collect(),
            _ => Err("give a list, such as a,b".into()),
        }
    }

    fn write(&self) -> Option<Value> {
        Some(self.iter().filter_map(T::write).collect::<Vec<_>>().into())
    }
}

impl<T: SettingValue> SettingValue for Option<T> {
    const CHOICES: &'static [Choice] = T::CHOICES;
    const IS_OPTIONAL: bool = true;

    fn read(value: &Value) -> Result<Option<T>, String> {
        if value.as_str() == Some("auto") { Ok(None) } else { T::read(value).map(Some) }
    }

    fn write(&self) -> Option<Value> {
        self.as_ref().and_then(T::write)
    }
}

/// Reads whole numbers.
macro_rules! whole {
    ($($type:ty),+) => { $(
        impl SettingValue for $type {
            fn read(value: &Value) -> Result<$type, String> {
                let number = value.as_integer().and_then(|number| number.try_into().ok());
                number.ok_or_else(|| "give a whole number from 0".into())
            }

            fn write(&self) -> Option<Value> {
                i64::try_from(*self).ok().map(Value::from)
            }
        }
    )+ };
}

whole!(u32, u64, usize);

/// Types with a text of their own, which may look like a number.
macro_rules! texts {
    ($($type:ty),+) => { $(
        impl SettingValue for $type {
            fn read(value: &Value) -> Result<$type, String> {
                plain(value).parse().map_err(|error| format!("{error}"))
            }

            fn write(&self) -> Option<Value> {
                Some(self.to_string().into())
            }
        }
    )+ };
}

texts!(GuardBand, ImBufferSize, ScreenSize);

impl SettingValue for Ipd {
    fn read(value: &Value) -> Result<Ipd, String> {
        plain(value).parse().map_err(|error: crate::IpdError| error.to_string())
    }

    fn write(&self) -> Option<Value> {
        self.metres().write()
    }
}

/// Types whose values have names.
macro_rules! named {
    ($($type:ty: $choices:expr, $find:expr;)+) => { $(
        impl SettingValue for $type {
            const CHOICES: &'static [Choice] = $choices;

            fn read(value: &Value) -> Result<$type, String> {
                $find(value.as_str().unwrap_or_default())
            }

            fn write(&self) -> Option<Value> {
                Some(self.name().into())
            }
        }
    )+ };
}

/// Names of earlier versions, and what to do about them.
const FORMER: &[(&str, &str)] = &[(
    "rowgroup",
    "the pipeline rowgroup was taken out: choose gather, which is closer to the truth on every scene",
)];

/// Returns the value of a name; the error names all.
pub(crate) fn find<T: Copy>(all: &[T], name: impl Fn(T) -> &'static str, text: &str) -> Result<T, String> {
    all.iter().copied().find(|value| name(*value) == text).ok_or_else(|| {
        if let Some((_, remedy)) = FORMER.iter().find(|(former, _)| *former == text) {
            return (*remedy).to_owned();
        }
        let names: Vec<_> = all.iter().map(|value| name(*value)).collect();
        format!("choose one of {}", names.join(", "))
    })
}

named! {
    Eye: &[Choice::new("left", "The left eye"), Choice::new("right", "The right eye")],
        |text| find(&Eye::BOTH, Eye::name, text);
    Edges: &[
        Choice::new("hard", "One surface per pixel: colour that was not anti-aliased, or was filtered afterwards"),
        Choice::new("nearest", "Anti-aliased colour, and the depth of each pixel's nearest sample: the better of the two"),
        Choice::new("sample", "Anti-aliased colour, and the depth of each pixel's first or middle sample"),
        Choice::new("multisample", "Anti-aliased colour, and the depth of every sample, of the forward renderer"),
    ], |text| find(&Edges::ALL, Edges::name, text);
}

pub(crate) use named;
