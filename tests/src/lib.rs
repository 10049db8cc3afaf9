//! Code shared by the tests in `tests/tests`: contexts, a small scene, golden images, all shader programs. It takes a
//! context and returns pictures and programs. No crate of the product may depend on it.

pub mod golden;
pub mod programs;
pub mod scene;

use yoro_gl::Context;
use yoro_render::RenderSettings;
use yoro_render::stereo::Method;

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
