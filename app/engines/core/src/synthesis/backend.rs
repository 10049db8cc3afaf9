//! For crates that run the passes on another graphics interface, as `yoro-wgpu` does: sizes of buffers, uniform blocks,
//! and checks of arguments. It may change with the shaders.

use bytemuck::Pod;

use super::error::ArgumentError;
pub use super::error::{check_rectangle, check_size};
use super::uniforms::{PoseUniforms, TILE, Uniforms};
use super::{HoleMark, Holes};
use crate::eyes::{MotionWarp, PoseWarp, Warp};

/// The range of depth that a viewport maps to, unless depth marks what is written.
pub const WHOLE_DEPTH: [f32; 2] = [0.0, 1.0];

/// How the last pass marks the pixels that it writes, if holes are left open.
#[derive(Clone, Copy, Debug)]
pub struct HoleMarks {
    /// The attachment that is the mark.
    pub mark: HoleMark,
    /// The stored depths of the near plane and of the far plane. Depth is cleared to the latter.
    pub planes: [f32; 2],
}

impl HoleMarks {
    /// Returns the range of depth that the viewport maps to.
    pub fn depths(self) -> [f32; 2] {
        match self.mark {
            HoleMark::Stencil => WHOLE_DEPTH,
            HoleMark::Depth => [self.planes[0]; 2],
        }
    }
}

/// The places of source and target in their images.
#[derive(Clone, Copy, Debug)]
pub struct Places {
    /// Corner of the source in its image.
    pub source_origin: [u32; 2],
    /// Size of the source's image in pixels.
    pub image_size: [u32; 2],
    /// Corner of the target in its framebuffer or image.
    pub target_origin: [u32; 2],
    /// True if the source is a part of its image or the maps are larger than [`map_sizes`]: `PART` in the shaders.
    pub part: bool,
}

/// Returns the number of tiles of an image, in columns and rows.
pub fn tiles([columns, rows]: [u32; 2]) -> [u32; 2] {
    [columns.div_ceil(TILE[0]), rows.div_ceil(TILE[1])]
}

/// Returns the sizes of the tile map and of the span map, for the sizes of source and target in pixels. The span map has
/// the target's size in tiles, but with the source's rows between parallel eyes.
pub fn map_sizes<W: WarpKind>([source, target]: [[u32; 2]; 2]) -> [[u32; 2]; 2] {
    [tiles(source), tiles(W::searched(source, target))]
}

/// The uniform block of the passes.
pub trait UniformBlock: Pod {
    /// Sets the uniforms that the program has. The program must be current.
    #[cfg(feature = "gl")]
    fn set(&self, program: &yoro_gl::Program);
}

/// One value for each kind of warp, such as its shaders.
#[derive(Clone, Copy, Debug)]
pub struct PerKind<T> {
    /// For `Gather`.
    pub gather: T,
    /// For `Motion`: the passes of `Gather`, with vectors for colours.
    pub motion: T,
    /// For `AnyView`.
    pub any_view: T,
}

/// A kind of warp, with what the pipelines need to draw its passes.
pub trait WarpKind: Copy {
    /// The uniform block of the passes.
    type Uniforms: UniformBlock;

    /// Returns the value for this kind.
    fn of<T>(values: &PerKind<T>) -> &T;

    /// Returns the size in pixels of the image whose tiles have a span each, for the sizes of source and target.
    fn searched(source: [u32; 2], target: [u32; 2]) -> [u32; 2] {
        [target[0], source[1]]
    }

    /// Checks the number of components of the source's colour.
    ///
    /// # Errors
    /// [`ArgumentError::TwoComponents`].
    fn check_components(_components: u32) -> Result<(), ArgumentError> {
        Ok(())
    }

    /// Returns how pixels are marked whose holes are left open; `None` for [`Holes::Filled`], and for kinds that fill them.
    fn marks(&self, _holes: Holes) -> Option<HoleMarks> {
        None
    }

    /// Returns the width and height of the source and of the target in pixels.
    fn sizes(&self) -> [[u32; 2]; 2];

    /// Returns the uniforms for images whose rows are counted as the warp's.
    fn uniforms(&self, places: &Places) -> Self::Uniforms;

    /// Returns the uniforms for images whose rows are counted from the top.
    fn uniforms_from_top(&self, places: &Places) -> Self::Uniforms;
}

impl WarpKind for Warp {
    type Uniforms = Uniforms;

    fn of<T>(values: &PerKind<T>) -> &T {
        &values.gather
    }

    fn marks(&self, holes: Holes) -> Option<HoleMarks> {
        match holes {
            Holes::Filled => None,
            Holes::Open(mark) => Some(HoleMarks { mark, planes: self.convention.planes() }),
        }
    }

    fn sizes(&self) -> [[u32; 2]; 2] {
        [self.source_size, self.target_size]
    }

    fn uniforms(&self, places: &Places) -> Uniforms {
        Uniforms::of_part(self, places)
    }

    fn uniforms_from_top(&self, places: &Places) -> Uniforms {
        Uniforms::of_part(&self.rows_from_top(), places)
    }
}

impl WarpKind for MotionWarp {
    type Uniforms = Uniforms;

    fn of<T>(values: &PerKind<T>) -> &T {
        &values.motion
    }

    fn check_components(components: u32) -> Result<(), ArgumentError> {
        if components < 3 { Err(ArgumentError::TwoComponents) } else { Ok(()) }
    }

    fn sizes(&self) -> [[u32; 2]; 2] {
        self.warp.sizes()
    }

    fn uniforms(&self, places: &Places) -> Uniforms {
        Uniforms::of_part(&self.warp, places).with_motion(&self.law)
    }

    fn uniforms_from_top(&self, places: &Places) -> Uniforms {
        Uniforms::of_part(&self.warp.rows_from_top(), places).with_motion(&self.law)
    }
}

impl WarpKind for PoseWarp {
    type Uniforms = PoseUniforms;

    fn of<T>(values: &PerKind<T>) -> &T {
        &values.any_view
    }

    fn searched(_source: [u32; 2], target: [u32; 2]) -> [u32; 2] {
        target
    }

    fn sizes(&self) -> [[u32; 2]; 2] {
        [self.source_size, self.target_size]
    }

    fn uniforms(&self, places: &Places) -> PoseUniforms {
        PoseUniforms::new(self, places)
    }

    fn uniforms_from_top(&self, places: &Places) -> PoseUniforms {
        PoseUniforms::new(&self.rows_from_top(), places)
    }
}
