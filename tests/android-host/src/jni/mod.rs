//! Java, played by a table of functions: enough for what android-activity and the application ask. Known questions have
//! real answers ([`answers`]); any other call is answered by a new object of the type that the signature promises, by
//! zero or by false, and listed in the summary as invented.
//!
//! References are counted like in a real virtual machine: local ones by thread and frame, global ones until deleted.

pub mod answers;
mod objects;
mod strings;
mod table;

pub use objects::{Cursor, Data, Jni, Member, Object, Value};
pub use table::{activity_reference, attach_main_thread, environment, release_activity, virtual_machine};
