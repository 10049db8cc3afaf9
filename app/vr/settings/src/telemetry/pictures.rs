//! The line about a pipeline's pictures:
//! `pictures,v=2,pipeline=gather,rendered=48.20dB,synthesized=41.71dB,least=30.00dB,passed=true`.
//!
//! Scripts rely on its keys, as on those of [`Line`](super::Line).

use std::fmt::{self, Display};
use std::str::FromStr;

use super::text::{LineError, Na, Reader, VERSION, word};

/// The first field of every line.
const BEGIN: &str = "pictures";

/// The comparison of a pipeline's pictures on a device with the stored ones.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pictures {
    /// Synthesis pipeline.
    pub pipeline: String,
    /// PSNR of the rendered eye in dB; missing if the driver cannot run the pipeline.
    pub rendered_db: Option<f64>,
    /// PSNR of the synthesized eye in dB.
    pub synthesized_db: Option<f64>,
    /// The least PSNR in dB that both eyes must have.
    pub least_db: f64,
}

impl Pictures {
    /// True if the text begins like a line about pictures.
    pub fn is_line(text: &str) -> bool {
        text.trim_start().strip_prefix(BEGIN).is_some_and(|rest| rest.starts_with(",v="))
    }

    /// True if both eyes reach the least PSNR.
    pub fn passed(&self) -> bool {
        [self.rendered_db, self.synthesized_db].iter().all(|db| db.is_some_and(|db| db >= self.least_db))
    }
}

impl Display for Pictures {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(
            f,
            "{BEGIN},v={VERSION},pipeline={},rendered={},synthesized={},least={:.2}dB,passed={}",
            word(&self.pipeline),
            Na(self.rendered_db, 2, "dB"),
            Na(self.synthesized_db, 2, "dB"),
            self.least_db,
            self.passed(),
        )
    }
}

impl FromStr for Pictures {
    type Err = LineError;

    fn from_str(text: &str) -> Result<Pictures, LineError> {
        let reader = Reader::of(text, BEGIN)?;
        let decibels = |key: &'static str| match reader.word(key)? {
            None => Ok(None),
            Some(text) => {
                let number = text.strip_suffix("dB").and_then(|number| number.parse::<f64>().ok());
                let number = number.filter(|number| number.is_finite());
                number.map(Some).ok_or_else(|| LineError::Value { key, value: text.into() })
            }
        };
        let pictures = Pictures {
            pipeline: reader.text("pipeline")?.into(),
            rendered_db: decibels("rendered")?,
            synthesized_db: decibels("synthesized")?,
            least_db: decibels("least")?.ok_or(LineError::Missing("least"))?,
        };
        // This key is the last one, so that a truncated line is rejected.
        let passed = reader.text("passed")?;
        if passed != pictures.passed().to_string() {
            return Err(LineError::Value { key: "passed", value: passed.into() });
        }
        Ok(pictures)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_written_and_read_in_its_documented_form() {
        let text =
            "pictures,v=2,pipeline=gather,rendered=48.20dB,synthesized=41.71dB,least=30.00dB,passed=true";
        let pictures = Pictures {
            pipeline: "gather".into(),
            rendered_db: Some(48.2),
            synthesized_db: Some(41.71),
            least_db: 30.0,
        };
        assert!(Pictures::is_line(text) && !Pictures::is_line("pictures, of"));
        assert_eq!((pictures.to_string().as_str(), text.parse()), (text, Ok(pictures.clone())));
        for missing in [
            Pictures { synthesized_db: Some(12.0), ..pictures.clone() },
            Pictures { rendered_db: None, synthesized_db: None, ..pictures },
        ] {
            assert!(!missing.passed());
            assert_eq!(missing.to_string().parse(), Ok(missing));
        }
    }

    #[test]
    fn damaged_lines_are_refused() {
        let text =
            "pictures,v=2,pipeline=gather,rendered=48.20dB,synthesized=41.71dB,least=30.00dB,passed=true";
        for cut in 0..text.len() {
            assert!(text[..cut].parse::<Pictures>().is_err(), "{}", &text[..cut]);
        }
        for (from, to) in [("48.20dB", "x"), ("48.20dB", "infdB"), ("48.20dB", "8.20dB"), ("v=2", "v=1")] {
            assert!(text.replace(from, to).parse::<Pictures>().is_err(), "{to}");
        }
    }
}
