//! The subcommands of the program `yoro`, one file each.

pub mod compare;
