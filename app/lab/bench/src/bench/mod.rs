//! `yoro bench`: every method, patcher and parameter of the paper, measured side by side.
//!
//! A [`Suite`] is a list of [jobs](Job): each is a scene and, in a sweep, one point of it. In each round of a job every
//! [`Contender`] takes its turn, and the finished round is appended to a file of [records](record). Quality is always
//! measured against a real render of the same eye, and shown beside "the same image to both eyes"
//! ([`Contender::MONO`]); cost is compared with two full renders ([`Contender::CONVENTIONAL`]).

mod blank;
mod contender;
mod frame;
mod holes;
mod job;
mod measured;
mod motion;
mod pictures;
mod prepared;
pub mod process;
pub mod record;
mod runner;
mod scenes;
mod suite;
mod summary;
mod views;

pub use blank::{Blank, BlankFinder, BlankView};
pub use contender::Contender;
pub use frame::{SUITE as FRAME_SUITE, is_limited, limit};
pub use holes::HoleFinder;
pub use job::{Job, Measure, Source, TargetPose};
pub use motion::Motion;
pub use pictures::{picture_folder, pictures_beside};
pub use prepared::{FrameTime, PreparedContender};
pub use record::{Conditions, Measurement, Record, RecordError, Results, Writer, metric};
pub use runner::{Bounds, Inputs, Runner};
pub use scenes::{LazyObject, Object};
pub use suite::{Choices, Suite};
pub use summary::text;
pub use views::spread;
