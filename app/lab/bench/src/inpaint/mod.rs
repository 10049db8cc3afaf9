//! Patchers, which fill the holes of a reprojected image.
//!
//! A synthesis pipeline fills its own holes. Patchers fill those of any reprojected image, so that they can be compared
//! on the same one. A patcher fills every hole and changes no other pixel.
//!
//! | patcher | after | runs on |
//! |---|---|---|
//! | [`PatcherKind::Paper`] | Algorithm 3 as corrected | GPU |
//! | [`PatcherKind::Gather`] | the fill of [`yoro::opengl::Gather`] | GPU |
//! | [`PatcherKind::Median`] | Noori et al.: median of the valid ones of 5x5 neighbours | GPU |
//! | [`PatcherKind::Xiao`] | Xiao et al. 2022: background filter of 29x29 pixels | GPU |
//! | [`PatcherKind::Telea`] | Telea 2004: fast marching | CPU, holes in parallel |
//! | [`PatcherKind::NavierStokes`] | Bertalmio et al. 2001, in fast marching order | CPU, holes in parallel |
//! | [`PatcherKind::Neural`] | a small pix2pix-style generator from an ONNX file; needs the feature `neural` | CPU, rten's threads |

mod march;
#[cfg(feature = "neural")]
mod neural;
mod patcher;
#[cfg(test)]
mod reference;
mod screen;
#[cfg(test)]
mod tests;

use std::path::PathBuf;
use std::rc::Rc;

use yoro_gl::Context;

pub use patcher::{HOLE, PatchTime, Patched, Patcher, PatcherKind, Reprojected, VALID};

/// The options of all patchers.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PatcherOptions {
    /// The ONNX file of the neural patcher; `None` for the built-in model.
    pub model: Option<PathBuf>,
}

/// Creates a patcher: compiles its shaders or loads its model.
///
/// # Errors
/// If the driver refuses a shader or the model is unsuitable.
pub fn create(
    gl: &Rc<Context>,
    kind: PatcherKind,
    #[cfg_attr(not(feature = "neural"), expect(unused_variables))] options: &PatcherOptions,
) -> anyhow::Result<Box<dyn Patcher>> {
    Ok(match kind {
        PatcherKind::Paper | PatcherKind::Gather | PatcherKind::Median | PatcherKind::Xiao => {
            Box::new(screen::Screen::new(gl, kind)?)
        }
        PatcherKind::Telea => Box::new(march::March::new(march::Rule::Telea)),
        PatcherKind::NavierStokes => Box::new(march::March::new(march::Rule::NavierStokes)),
        #[cfg(feature = "neural")]
        PatcherKind::Neural => Box::new(neural::Neural::new(options.model.as_deref())?),
        #[cfg(not(feature = "neural"))]
        PatcherKind::Neural => anyhow::bail!(
            "this build has no neural patcher: build it with --features neural, or choose another patcher"
        ),
    })
}
