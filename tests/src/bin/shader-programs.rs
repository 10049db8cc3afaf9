//! Prints the text of every shader program as JSON, for the compilers of `cargo xtask maintain estimate`.

use std::collections::BTreeSet;
use std::io;

use yoro_context::{Backend, Headless};
use yoro_gl::Capabilities;
use yoro_tests::programs::{self, Variants};

/// What the drivers of phones lack or have: without the first, the renderer carries depth; with it, it reads samples.
const LIMITS: [fn(&mut Capabilities); 2] = [
    |capabilities| capabilities.multisample_textures = false,
    |capabilities| capabilities.tile_samples = false,
];

fn main() -> anyhow::Result<()> {
    let mut made = BTreeSet::new();
    for limit in LIMITS {
        let headless = Headless::open_limited(Backend::Egl, limit)?;
        made.extend(programs::make(headless.gl(), Variants::Extreme)?);
    }
    Ok(serde_json::to_writer(io::stdout().lock(), &programs::texts(&made)?)?)
}
