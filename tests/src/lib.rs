//! Code that the tests in `tests/tests` share: contexts, a small scene, golden images, all shader programs, multisample
//! textures. It takes a context and gives pictures and programs; no crate of the product may depend on it.

pub mod golden;
pub mod programs;
pub mod samples;
pub mod scene;

use std::rc::Rc;

use anyhow::Context as _;
use yoro_context::{Backend, Headless};
use yoro_gl::Context;
use yoro_render::RenderSettings;
use yoro_render::stereo::Method;

/// The variable that `cargo xtask test` sets on systems without OSMesa (Mesa 25.1 dropped it).
const WITHOUT_OSMESA: &str = "YORO_TEST_WITHOUT_OSMESA";

/// The backends that are tested here.
pub fn backends() -> Vec<Backend> {
    if std::env::var_os(WITHOUT_OSMESA).is_some() {
        return vec![Backend::Egl];
    }
    vec![Backend::Egl, Backend::Osmesa]
}

/// Runs a test body on every backend; afterwards there is no GL error and no GL object left.
///
/// # Errors
/// The body's, with the backend's name; when there is no context.
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

/// The variable that is set where the driver was chosen for its multiview.
pub const MULTIVIEW_EXPECTED: &str = "YORO_TEST_MULTIVIEW_EXPECTED";

/// True if a method is tested with these settings on this driver. Says what the driver lacks, but for multiview, which
/// the tests in `tests/gl/multiview.rs` bring; what a renderer has on no driver is not worth a word.
///
/// # Panics
/// If the driver lacks what it was chosen for.
pub fn is_tested(method: Method, settings: &RenderSettings, gl: &Context) -> bool {
    let Err(reason) = settings.supports(method, gl.capabilities()) else { return true };
    if settings.is_forward() && matches!(method, Method::Multiview | Method::ShadingReprojection) {
        return false;
    }
    if method != Method::Multiview {
        eprintln!("SKIPPED: {} is not tested here: {reason}", method.name());
    }
    assert!(std::env::var_os(MULTIVIEW_EXPECTED).is_none(), "{reason}");
    false
}

/// The code of the project's README is compiled with the tests of the documentation.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
struct Readme;
