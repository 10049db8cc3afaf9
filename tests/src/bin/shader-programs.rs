//! Prints the text of every shader program as JSON, for the compilers of `cargo xtask maintain shader-cost`.

use std::io;

use yoro_context::{Backend, Headless};
use yoro_tests::programs::{self, Variants};

fn main() -> anyhow::Result<()> {
    let headless = Headless::open(Backend::Egl)?;
    let made = programs::make(headless.gl(), Variants::Extreme)?;
    Ok(serde_json::to_writer(io::stdout().lock(), &programs::texts(&made)?)?)
}
