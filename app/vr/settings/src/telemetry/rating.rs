//! The line with an answer: `rating,v=2,participant=P03,trial=4,method=yoro,...,question=image-quality,value=4.5`.
//!
//! Scripts rely on its keys, as on those of [`Line`](super::Line). The answer comes last and has one decimal, so that a
//! truncated line is never taken for another answer.

use std::fmt::{self, Display};
use std::str::FromStr;

use super::text::{LineError, Na, Reader, VERSION, word};

/// The first field of every line.
const BEGIN: &str = "rating";

/// One answer of a participant.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rating {
    /// The participant's name.
    pub participant: Option<String>,
    /// Number of the trial.
    pub trial: Option<u32>,
    /// Stereo method.
    pub method: String,
    /// Synthesis pipeline; missing for methods without synthesis.
    pub pipeline: Option<String>,
    /// Scene.
    pub scene: String,
    /// The question.
    pub question: String,
    /// The answer; 1 is the worst.
    pub rating: f64,
}

impl Rating {
    /// True if the text begins like a line with an answer.
    pub fn is_line(text: &str) -> bool {
        text.trim_start().strip_prefix(BEGIN).is_some_and(|rest| rest.starts_with(','))
    }
}

impl Display for Rating {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(
            f,
            "{BEGIN},v={VERSION},participant={},trial={},method={},pipeline={},scene={},question={},value={:.1}",
            Na(self.participant.as_deref().map(word), 64, ""),
            Na(self.trial, 0, ""),
            word(&self.method),
            Na(self.pipeline.as_deref().map(word), 64, ""),
            word(&self.scene),
            word(&self.question),
            self.rating,
        )
    }
}

impl FromStr for Rating {
    type Err = LineError;

    fn from_str(text: &str) -> Result<Rating, LineError> {
        let reader = Reader::of(text, BEGIN)?;
        let name = |key| reader.word(key).map(|name| name.map(str::to_owned));
        Ok(Rating {
            participant: name("participant")?,
            trial: reader.number("trial")?,
            method: reader.text("method")?.into(),
            pipeline: name("pipeline")?,
            scene: reader.text("scene")?.into(),
            question: reader.text("question")?.into(),
            rating: answer(reader.text("value")?)?,
        })
    }
}

fn answer(text: &str) -> Result<f64, LineError> {
    let one_decimal = text.split_once('.').is_some_and(|(_, decimals)| decimals.len() == 1);
    let answer = text.parse().ok().filter(|_| one_decimal);
    answer.ok_or_else(|| LineError::Value { key: "value", value: text.into() })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn example() -> Rating {
        Rating {
            participant: Some("P03".into()),
            trial: Some(4),
            method: "yoro".into(),
            pipeline: Some("gather".into()),
            scene: "street".into(),
            question: "image-quality".into(),
            rating: 4.5,
        }
    }

    #[test]
    fn a_line_is_written_and_read_in_its_documented_form() {
        let text = "rating,v=2,participant=P03,trial=4,method=yoro,pipeline=gather,scene=street,question=image-quality,value=4.5";
        assert_eq!(example().to_string(), text);
        assert_eq!(text.parse(), Ok(example()));
        assert!(Rating::is_line(text) && !Rating::is_line("ratings"));
    }

    #[test]
    fn names_cannot_break_the_line() {
        let rating =
            Rating { participant: None, trial: None, question: "good, or bad=?".into(), ..example() };
        let read: Rating = rating.to_string().parse().unwrap();
        assert_eq!((read.participant, read.trial, read.question.as_str()), (None, None, "good--or-bad--"));
    }

    #[test]
    fn damaged_lines_say_where() {
        let text = example().to_string();
        assert_eq!("v=2,t=0".parse::<Rating>(), Err(LineError::Version));
        assert_eq!(text.replace("v=2", "v=1").parse::<Rating>(), Err(LineError::Version));
        assert_eq!(text[..60].parse::<Rating>(), Err(LineError::Missing("scene")));
        for value in ["4.x", "4.", "4", "inf", "na"] {
            let twisted = text.replace("4.5", value).parse::<Rating>();
            assert_eq!(twisted, Err(LineError::Value { key: "value", value: value.into() }));
        }
    }
}
