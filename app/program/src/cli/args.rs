//! Options that several subcommands share.

use std::fmt::{self, Display};
use std::io::Read as _;
use std::ops::{Range, RangeInclusive};
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::str::FromStr;

use anyhow::{Context as _, ensure};
use clap::builder::{StringValueParser, TypedValueParser};

use crate::cli::choices;
use yoro_bench::inpaint::{self, Patcher, PatcherKind, PatcherOptions};
use yoro_context::{Backend, ContextError, Headless};
use yoro_gl::Context;

/// The source of the GL context.
#[derive(clap::Args, Clone, Copy, Debug)]
pub struct GlArgs {
    /// Source of the GL context
    #[arg(long = "gl", value_parser = choices::backend(), default_value = Backend::default().name(), value_name = "BACKEND")]
    pub backend: Backend,
}

impl GlArgs {
    /// Opens the context and logs its driver.
    pub fn open(&self) -> Result<Headless, ContextError> {
        let headless = Headless::open(self.backend)?;
        log::info!("{}", headless.gl().capabilities().summary());
        Ok(headless)
    }
}

/// Returns the content of a saved log, or of standard input for `-`.
pub fn read_log(path: &Path) -> anyhow::Result<Vec<u8>> {
    if path.as_os_str() != "-" {
        return Ok(yoro_files::read(path)?);
    }
    let mut bytes = Vec::new();
    std::io::stdin().read_to_end(&mut bytes).context("cannot read standard input")?;
    Ok(bytes)
}

/// The patcher, where it is not the pipeline itself that fills the holes.
#[derive(clap::Args, Clone, Debug)]
pub struct PatcherArgs {
    /// Fill the holes by this patcher instead of the pipeline's own fill
    #[arg(long, value_parser = choices::patcher(), value_name = "KIND")]
    pub patcher: Option<PatcherKind>,
    /// neural: another ONNX file than the built-in model
    #[arg(long, value_name = "FILE", requires = "patcher")]
    pub model: Option<PathBuf>,
}

impl PatcherArgs {
    /// Refuses a model if the chosen patcher does not use one.
    pub fn check(&self) -> anyhow::Result<()> {
        ensure!(
            self.model.is_none() || self.patcher == Some(PatcherKind::Neural),
            "--model goes with --patcher neural only: give that, or leave it out"
        );
        Ok(())
    }

    /// Creates the patcher, if one was chosen.
    pub fn create(&self, gl: &Rc<Context>) -> anyhow::Result<Option<Box<dyn Patcher>>> {
        let options = PatcherOptions { model: self.model.clone() };
        self.patcher.map(|kind| inpaint::create(gl, kind, &options)).transpose()
    }
}

/// A part of the work, for array jobs: the `index`th of `count` parts, counted from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    index: usize,
    count: usize,
}

impl Shard {
    /// Returns this part of the positions below `total`. The parts of one `count` are consecutive, differ in size by at
    /// most one position, and together cover all positions.
    pub fn part(self, total: usize) -> Range<usize> {
        let end = |parts: usize| (total as u128 * parts as u128 / self.count as u128) as usize;
        end(self.index - 1)..end(self.index)
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.index, self.count)
    }
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Shard, String> {
        let numbers = text.split_once('/').and_then(|(i, n)| Some((i.parse().ok()?, n.parse().ok()?)));
        match numbers {
            Some((index, count)) if (1..=count).contains(&index) => Ok(Shard { index, count }),
            _ => Err("give the number of the part and of all parts, such as 1/8 up to 8/8".into()),
        }
    }
}

/// Returns a parser of whole numbers in a range, whose message says which these are.
pub fn whole<T>(range: RangeInclusive<T>) -> impl TypedValueParser<Value = T>
where
    T: FromStr + PartialOrd + Display + Clone + Send + Sync + 'static,
{
    StringValueParser::new().try_map(move |text| {
        let number = text.parse::<T>().ok().filter(|number| range.contains(number));
        number.ok_or_else(|| format!("give a whole number from {} to {}", range.start(), range.end()))
    })
}

fn number(text: &str, fits: impl Fn(f32) -> bool, advice: &str) -> Result<f32, String> {
    text.parse().ok().filter(|number| fits(*number)).ok_or_else(|| advice.into())
}

/// Parses a finite number.
pub fn parse_finite(text: &str) -> Result<f32, String> {
    number(text, f32::is_finite, "give a finite number")
}

/// Parses an angle of a turn in degrees.
pub fn parse_degrees(text: &str) -> Result<f32, String> {
    number(text, |degrees| degrees.abs() <= 360.0, "give degrees from -360 to 360")
}

/// Parses a finite number above zero.
pub fn parse_positive(text: &str) -> Result<f32, String> {
    number(text, |number| number > 0.0 && number.is_finite(), "give a number above 0")
}

/// Parses the distance of a far plane in metres, which may be infinite.
pub fn parse_far(text: &str) -> Result<f32, String> {
    number(text, |far| far > 0.0, "give metres above 0, or inf")
}

/// Parses an angle in degrees that is possible for a flat image, and returns radians.
pub fn parse_fov(text: &str) -> Result<f32, String> {
    number(text, |fov| (1.0..=170.0).contains(&fov), "give degrees from 1 to 170").map(f32::to_radians)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_beyond_a_range_are_told_the_range() {
        let command =
            clap::Command::new("x").arg(clap::Arg::new("n").long("n").value_parser(whole(1..=64u32)));
        let parse = |text: &str| command.clone().try_get_matches_from(["x", &format!("--n={text}")]);
        assert_eq!(parse("64").unwrap().get_one::<u32>("n"), Some(&64));
        for wrong in ["", "0", "65", "-1", "1.5", "x", "99999999999"] {
            let message = parse(wrong).unwrap_err().to_string();
            assert!(message.contains("give a whole number from 1 to 64"), "{message}");
        }
    }

    #[test]
    fn shards_are_everything_once() {
        for (total, count) in [(0, 3), (1, 4), (10, 1), (10, 3), (29_128, 512)] {
            let parts: Vec<_> = (1..=count).map(|index| Shard { index, count }.part(total)).collect();
            assert_eq!(
                parts.iter().flat_map(Clone::clone).collect::<Vec<_>>(),
                (0..total).collect::<Vec<_>>()
            );
            let lengths: Vec<_> = parts.iter().map(Range::len).collect();
            assert!(lengths.iter().max().unwrap() - lengths.iter().min().unwrap() <= 1);
        }
        assert_eq!("3/8".parse(), Ok(Shard { index: 3, count: 8 }));
        for wrong in ["0/8", "9/8", "1", "1/0", "-1/8", "a/b", "1/8/2", ""] {
            assert!(wrong.parse::<Shard>().is_err(), "{wrong}");
        }
    }
}
