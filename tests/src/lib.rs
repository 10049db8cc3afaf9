//! Code shared by the tests in `tests/tests`: contexts, a small scene, golden images, all shader programs. It takes a
//! context and returns pictures and programs. No crate of the product may depend on it.

pub mod golden;
pub mod programs;
pub mod scene;

use std::rc::Rc;

use anyhow::Context as _;
use yoro_context::{Backend, Headless};
use yoro_gl::Context;
use yoro_render::RenderSettings;
use yoro_render::stereo::Method;

/// The variable that `cargo xtask test` sets on systems without OSMesa, which Mesa 25.1 removed.
const WITHOUT_OSMESA: &str = "YORO_TEST_WITHOUT_OSMESA";

/// Returns the backends to test.
pub fn backends() -> Vec<Backend> {
    if std::env::var_os(WITHOUT_OSMESA).is_some() {
        return vec![Backend::Egl];
    }
    vec![Backend::Egl, Backend::Osmesa]
}

/// Runs a test body on every backend. Afterwards there must be no GL error, and no GL object left.
///
/// # Errors
/// Fails with the body's error and the backend's name, or if there is no context.
pub fn on_every_backend(body: impl Fn(&Rc<Context>) -> anyhow::Result<()>) -> anyhow::Result<()> {
    for backend in backends() {
        let headless = Headless::open(backend)?;
        let gl = headless.gl();
        body(gl).with_context(|| format!("{backend:?}"))?;
        anyhow::ensure!(gl.take_errors().is_none(), "{backend:?}: GL errors");
        anyhow::ensure!(gl.object_count() == 0, "{backend:?}: {} GL objects left", gl.object_count());
    }
    Ok(())
}

/// The variable that is set if the driver was chosen because it supports multiview.
pub const MULTIVIEW_EXPECTED: &str = "YORO_TEST_MULTIVIEW_EXPECTED";

/// True if a method can be tested with these settings on this driver. Otherwise prints what the driver lacks. Says
/// nothing about multiview, which is tested by `tests/gl/multiview.rs`.
///
/// # Panics
/// Panics if the driver lacks what it was chosen for.
pub fn is_tested(method: Method, settings: &RenderSettings, gl: &Context) -> bool {
    let Err(reason) = settings.supports(method, gl.capabilities()) else { return true };
    if method != Method::Multiview {
        eprintln!("SKIPPED: {} is not tested here: {reason}", method.name());
    }
    assert!(std::env::var_os(MULTIVIEW_EXPECTED).is_none(), "{reason}");
    false
}

/// Compiles the code of the project's README together with the doc tests.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
struct Readme;
