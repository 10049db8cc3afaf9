//! Reading and writing of values of each type of setting.

use toml::Value;
use yoro::eyes::{Eye, FoveationLevel, GuardBand};

use crate::quantities::{ImBufferSize, Ipd, ScreenSize};

/// The name of a possible value, with a line of help.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Choice {
    /// The name in files and on the command line.
    pub name: &'static str,
    help: &'static str,
}

impl Choice {
    pub(crate) const fn new(name: &'static str, help: &'static str) -> Choice {
        Choice { name, help }
    }

    /// Returns the help as one line without a full stop.
    pub fn help(&self) -> &'static str {
        self.help.trim().trim_end_matches('.')
    }
}

/// Returns a value without TOML's quotes. Numbers are written as they were given, not as doubles.
pub(crate) fn plain(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        Value::Float(number) => (*number as f32).to_string(),
        other => other.to_string(),
    }
}

/// Returns a value as a message quotes it. Numbers of many digits are written with an exponent.
pub(crate) fn shown(value: &Value) -> String {
    value.as_float().map_or_else(|| value.to_string(), |number| format!("{number:?}"))
}

/// A type that settings can have.
pub(crate) trait SettingValue: Sized {
    const CHOICES: &'static [Choice] = &[];
    const IS_BOOL: bool = false;
    const IS_OPTIONAL: bool = false;

    /// Reads a value; the error is the remedy.
    fn read(value: &Value) -> Result<Self, String>;

    /// Writes a value; `None` if it is left to the program.
    fn write(&self) -> Option<Value>;
}

impl SettingValue for bool {
    const IS_BOOL: bool = true;

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

/// Implements settings of whole numbers.
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

/// Implements settings whose types have a text form of their own, which may look like a number.
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

/// Implements settings whose values have names.
macro_rules! named {
    ($($type:ty: $choices:expr, $find:expr;)+) => { $(
        impl SettingValue for $type {
            const CHOICES: &'static [Choice] = $choices;

            fn read(value: &Value) -> Result<$type, String> {
                $find(&$crate::value::plain(value))
            }

            fn write(&self) -> Option<Value> {
                Some(self.name().into())
            }
        }
    )+ };
}

/// Returns the value with a name; the error lists all names.
pub(crate) fn find<T: Copy>(all: &[T], name: impl Fn(T) -> &'static str, text: &str) -> Result<T, String> {
    all.iter().copied().find(|value| name(*value) == text).ok_or_else(|| {
        let names: Vec<_> = all.iter().map(|value| name(*value)).collect();
        format!("choose one of {}", names.join(", "))
    })
}

named! {
    Eye: &[Choice::new("left", "The left eye"), Choice::new("right", "The right eye")],
        |text| find(&Eye::BOTH, Eye::name, text);
    FoveationLevel: &[
        Choice::new("off", "All pixels everywhere"),
        Choice::new("low", "30 degrees, half of the pixels along each axis beyond"),
        Choice::new("medium", "20 degrees, half of the pixels along each axis beyond"),
        Choice::new("high", "20 degrees, a third of the pixels along each axis beyond"),
    ],
        |text| find(&FoveationLevel::ALL, FoveationLevel::name, text);
}

pub(crate) use named;
