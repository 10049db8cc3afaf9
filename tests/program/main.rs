//! The program `yoro` from end to end.

mod program;

mod bench;
mod compare;
mod dataset;
mod device;
mod interrupt;
mod layer;
mod memory;
mod mistakes;
mod models;
mod pair;
mod render;
mod report;
mod run;
mod scenes;
mod serve;
mod study;
mod synthesize;
mod video;
mod view;
mod web;
mod xr;

use yoro_test_support::browser;
