//! What device farms play and check.

pub mod game_loop;
pub mod pictures;
