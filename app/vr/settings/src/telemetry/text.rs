//! The format of all log lines: `key=value` fields separated by commas, with `na` for a missing value.

use std::fmt::{self, Display};
use std::str::FromStr;

/// The version of all lines, as in the field `v`.
pub const VERSION: u32 = 2;
/// The text of a missing value.
pub(super) const MISSING: &str = "na";

/// An error in the text of a line.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum LineError {
    /// The line does not start with `v=1`.
    #[error(
        "the line does not start with v={VERSION}: it is not a telemetry line, or it is from another version of this program"
    )]
    Version,
    /// A key is missing.
    #[error("the line has no key \"{0}\": it is cut or damaged")]
    Missing(&'static str),
    /// A value does not fit its key.
    #[error("the value \"{value}\" of the key \"{key}\" cannot be read: the line is damaged")]
    Value {
        /// The key.
        key: &'static str,
        /// The text found.
        value: String,
    },
}

/// Writes a value with a number of decimals and a unit, or `na`.
pub(super) struct Na<T>(pub Option<T>, pub usize, pub &'static str);

impl<T: Display> Display for Na<T> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match &self.0 {
            Some(value) => write!(f, "{value:.*}{}", self.1, self.2),
            None => f.write_str(MISSING),
        }
    }
}

/// Replaces all characters that could end the text's field.
pub(super) fn word(text: &str) -> String {
    let plain = |c: char| if c.is_alphanumeric() || "-._/".contains(c) { c } else { '-' };
    let word: String = text.chars().map(plain).collect();
    if word.is_empty() || word == MISSING { "-".into() } else { word }
}

/// One field of a line; `value` is `None` if there is no `=`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Field<'a> {
    /// The text before the first `=`.
    pub key: &'a str,
    /// The text after the first `=`.
    pub value: Option<&'a str>,
}

impl Field<'_> {
    /// True if this field is the version of all lines.
    pub(super) fn is_version(self) -> bool {
        self.key == "v" && self.value.is_some_and(|value| value == VERSION.to_string())
    }
}

/// Splits a line at the commas outside parentheses. This also reads the lines of Meta's runtime (tag `VrApi`).
pub fn fields(line: &str) -> impl Iterator<Item = Field<'_>> {
    let mut depth = 0u32;
    line.trim()
        .split(move |c| {
            match c {
                '(' => depth += 1,
                ')' => depth = depth.saturating_sub(1),
                _ => {}
            }
            c == ',' && depth == 0
        })
        .map(|field| match field.split_once('=') {
            Some((key, value)) => Field { key, value: Some(value) },
            None => Field { key: field, value: None },
        })
}

/// The fields of a line by key.
pub(super) struct Reader<'a>(Vec<Field<'a>>);

impl<'a> Reader<'a> {
    pub fn new(line: &'a str) -> Reader<'a> {
        Reader(fields(line).collect())
    }

    /// Reads a line that starts with the field `begin` and the version.
    pub fn of(line: &'a str, begin: &str) -> Result<Reader<'a>, LineError> {
        let reader = Reader::new(line);
        match reader.0[..] {
            [first, second, ..] if first.key == begin && second.is_version() => Ok(reader),
            _ => Err(LineError::Version),
        }
    }

    pub fn text(&self, key: &'static str) -> Result<&'a str, LineError> {
        let field = self.0.iter().find(|field| field.key == key);
        field.and_then(|field| field.value).ok_or(LineError::Missing(key))
    }

    /// Returns a text; `None` if it is missing.
    pub fn word(&self, key: &'static str) -> Result<Option<&'a str>, LineError> {
        Ok(Some(self.text(key)?).filter(|text| *text != MISSING))
    }

    /// Returns a number; `None` if it is missing.
    pub fn number<T: FromStr>(&self, key: &'static str) -> Result<Option<T>, LineError> {
        let Some(text) = self.word(key)? else { return Ok(None) };
        text.parse().map(Some).map_err(|_| LineError::Value { key, value: text.into() })
    }

    /// Returns the first field.
    pub fn first(&self) -> Option<Field<'a>> {
        self.0.first().copied()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_of_metas_runtime_is_split_outside_parentheses() {
        let line = "FPS=72/72,Prd=38ms,Stale2/5/10/max=0/0/0/0,1171/441MHz,Temp=32.2C/0.0C,CPU&GPU=12.96ms,LCnt=2(DR72,LM2),GPU%=0.43";
        let found: Vec<Field> = fields(line).collect();
        assert_eq!(found.len(), 8);
        assert_eq!(found[3], Field { key: "1171/441MHz", value: None });
        assert_eq!(found[6], Field { key: "LCnt", value: Some("2(DR72,LM2)") });
    }
}
