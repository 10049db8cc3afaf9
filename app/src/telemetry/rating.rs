//! A rating of the user study, as a log line: `rating,v=1,participant=P03,trial=4,method=yoro,scene=street,...`.
//!
//! The viewer logs one under [`LOG_TAG`](super::LOG_TAG) for each question that was answered; `yoro study collect`
//! reads them. Of several for the same trial and question the last one counts. A rating that was given without a
//! participant or a trial of a plan has `-` and 0 there. The rating stands last and has always two decimals, so that a
//! line that was cut is never taken for another rating.

use std::fmt::{self, Display};
use std::str::FromStr;

use super::line::{LineError, Reader, VERSION, fields, word};

/// How a line of a rating begins.
const BEGIN: &str = "rating";

/// What a participant answered.
#[derive(Clone, Debug, PartialEq)]
pub struct Rating {
    /// Participant, as the plan calls them; letters, digits and `-._/` (others become `-`).
    pub participant: String,
    /// Number of the trial in the participant's plan, from 1.
    pub trial: u32,
    /// Name of the method in the plan.
    pub method: String,
    /// Scene.
    pub scene: String,
    /// A short name of the question, such as `image-quality`.
    pub question: String,
    /// On the study's scale, finite; two decimals are logged.
    pub rating: f64,
}

/// Why a text is not a rating.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum RatingError {
    /// It does not start with `rating,v=1`.
    #[error(
        "the line does not start with {BEGIN},v={VERSION}: it is no rating, or one of another version of this program"
    )]
    Version,
    /// A field is missing or damaged.
    #[error(transparent)]
    Line(#[from] LineError),
}

impl Rating {
    /// The part of a line of a log that should be a rating, after tag and time; `None` in lines of other things.
    pub fn find(line: &str) -> Option<&str> {
        let start = line.find(&format!("{BEGIN},v="))?;
        // Not in the middle of a word.
        let before = line[..start].chars().next_back();
        before.is_none_or(|c| !c.is_alphanumeric()).then(|| line[start..].trim_end())
    }
}

impl Display for Rating {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(
            f,
            "{BEGIN},v={VERSION},participant={},trial={},method={},scene={},question={},rating={:.2}",
            word(&self.participant),
            self.trial,
            word(&self.method),
            word(&self.scene),
            word(&self.question),
            self.rating
        )
    }
}

impl FromStr for Rating {
    type Err = RatingError;

    fn from_str(text: &str) -> Result<Rating, RatingError> {
        let mut fields = fields(text);
        let begin = fields.next().is_some_and(|field| field.key == BEGIN && field.value.is_none());
        let reader = Reader(fields.collect());
        let version = reader.0.first().filter(|field| field.key == "v").and_then(|field| field.value);
        if !begin || version.and_then(|version| version.parse().ok()) != Some(VERSION) {
            return Err(RatingError::Version);
        }
        let text = reader.text("rating")?;
        let two_decimals = text.split_once('.').is_some_and(|(_, decimals)| decimals.len() == 2);
        let rating = text.parse::<f64>().ok().filter(|rating| two_decimals && rating.is_finite());
        let rating = rating.ok_or_else(|| LineError::Value { key: "rating", value: text.into() })?;
        Ok(Rating {
            participant: reader.text("participant")?.into(),
            trial: reader.required("trial", "")?,
            method: reader.text("method")?.into(),
            scene: reader.text("scene")?.into(),
            question: reader.text("question")?.into(),
            rating,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn example() -> Rating {
        Rating {
            participant: "P03".into(),
            trial: 4,
            method: "yoro".into(),
            scene: "street".into(),
            question: "image-quality".into(),
            rating: 4.25,
        }
    }

    #[test]
    fn what_is_written_is_read_again() {
        let text =
            "rating,v=1,participant=P03,trial=4,method=yoro,scene=street,question=image-quality,rating=4.25";
        assert_eq!(example().to_string(), text);
        assert_eq!(text.parse(), Ok(example()));
        let name = Rating { participant: "a,b=c".into(), ..example() };
        assert_eq!(name.to_string().parse::<Rating>().unwrap().participant, "a-b-c");
    }

    #[test]
    fn a_log_line_holds_one_or_not() {
        let line = format!("11-21 10:00:01.000  4242  4260 I YORO    : {}\r", example());
        assert_eq!(Rating::find(&line).unwrap().parse(), Ok(example()));
        assert_eq!(Rating::find("I YORO: v=1,t=1.0s,method=yoro"), None);
        assert_eq!(Rating::find("frating,v=1"), None);
    }

    #[test]
    fn damaged_lines_say_where() {
        let text = example().to_string();
        assert_eq!("v=1,t=1.0s".parse::<Rating>(), Err(RatingError::Version));
        assert_eq!(text.replace("v=1", "v=2").parse::<Rating>(), Err(RatingError::Version));
        assert_eq!(text[..40].parse::<Rating>(), Err(LineError::Missing("rating").into()));
        for (from, to) in [
            ("4.25", "4.xx"),
            ("4.25", "inf"),
            ("4.25", "4.2"),
            ("trial=4", "trial=na"),
            ("trial=4", "trial=-4"),
        ] {
            let twisted = text.replace(from, to).parse::<Rating>();
            assert!(matches!(twisted, Err(RatingError::Line(LineError::Value { .. }))), "{to}: {twisted:?}");
        }
    }
}
