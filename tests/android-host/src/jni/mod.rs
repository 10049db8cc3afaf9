//! Java, simulated by a table of functions: as much as android-activity and the application use. Known calls have real
//! results ([`answers`]). Any other call returns a new object of the type in the signature, zero or false, and is
//! listed in the summary as invented.
//!
//! References are counted as in a real virtual machine: local ones per thread and frame, global ones until deleted.

pub mod answers;
mod objects;
mod strings;
mod table;

pub use objects::{Cursor, Data, Jni, Member, Object, Value};
pub use table::{activity_reference, attach_main_thread, environment, release_activity, virtual_machine};
