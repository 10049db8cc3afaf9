//! The subcommands of the program `yoro`, one file each.

pub mod args;
pub mod bench;
pub mod choices;
pub mod compare;
pub mod dataset;
pub mod device;
pub mod eyes;
pub mod info;
pub mod layer;
pub mod machine;
pub mod message;
pub mod outputs;
pub mod render;
pub mod report;
pub mod run;
pub mod scenes;
pub mod settings;
pub mod study;
pub mod synthesize;
pub mod terminal;
pub mod view;
pub mod xr;
