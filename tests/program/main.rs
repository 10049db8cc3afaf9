//! The program `yoro` from end to end.

mod program;

mod compare;
mod interrupt;
mod memory;
mod mistakes;
mod pair;
mod render;
mod run;
mod scenes;
mod synthesize;
mod view;
