//! The inputs of the composer.

use glam::{Vec2, Vec4};

use super::LevelUniforms;
use crate::eyes::{Composition, InsetPlace, LevelPlace};

/// A ramp so steep that the inset is seen up to its border.
const HARD: f32 = 1e6;

/// The places of the levels in their textures, and of the eye's image in its target. Corners are on the side of row 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LevelPlaces {
    /// Corner of the eye's image in its framebuffer or image, in pixels.
    pub target: [u32; 2],
    /// Corner of the wide level in its texture.
    pub wide: [u32; 2],
    /// Width and height of that texture.
    pub wide_image: [u32; 2],
    /// Corner of the inset in its texture.
    pub inset: [u32; 2],
    /// Width and height of that texture.
    pub inset_image: [u32; 2],
    /// True if the inset's depth is read.
    pub depth: bool,
}

/// The affine map of a place: `scale * place + offset` along X and Y.
#[derive(Clone, Copy)]
struct Map {
    scale: [f64; 2],
    offset: [f64; 2],
}

impl Map {
    /// Returns the map from a level's places to texture coordinates.
    fn of_part(corner: [u32; 2], size: [u32; 2], image: [u32; 2]) -> Map {
        let part = |pixels: [u32; 2]| [0, 1].map(|i| f64::from(pixels[i]) / f64::from(image[i]));
        Map { scale: part(size), offset: part(corner) }
    }

    /// Returns the map that applies `self` after `first`.
    fn after(&self, first: &LevelPlace) -> Map {
        Map {
            scale: [0, 1].map(|i| self.scale[i] * first.scale[i]),
            offset: [0, 1].map(|i| self.scale[i] * first.offset[i] + self.offset[i]),
        }
    }

    fn vector(&self) -> Vec4 {
        let [[a, b], [c, d]] = [self.scale, self.offset];
        Vec4::from([a, b, c, d].map(|n| n as f32))
    }
}

/// Returns the texture coordinates of the middles of the first and the last pixel of a part.
fn bounds(corner: [u32; 2], size: [u32; 2], image: [u32; 2]) -> Vec4 {
    let at = |i: usize, pixels: f64| ((f64::from(corner[i]) + pixels) / f64::from(image[i])) as f32;
    let last = |i: usize| f64::from(size[i]) - 0.5;
    Vec4::new(at(0, 0.5), at(1, 0.5), at(0, last(0)), at(1, last(1)))
}

impl LevelUniforms {
    /// Returns the uniforms for images whose rows are counted from the bottom.
    pub fn new(composition: &Composition, places: &LevelPlaces) -> LevelUniforms {
        let shown = Map {
            scale: composition.size.map(|pixels| 1.0 / f64::from(pixels)),
            offset: [0, 1].map(|i| -f64::from(places.target[i]) / f64::from(composition.size[i])),
        };
        let size = composition.wide.size;
        let wide = Map::of_part(places.wide, size, places.wide_image).after(&composition.wide);
        let uniforms = LevelUniforms {
            eye_place: shown.vector(),
            wide_place: wide.vector(),
            wide_bounds: bounds(places.wide, size, places.wide_image),
            // Everywhere outside of the inset.
            inset_place: Vec4::new(0.0, 0.0, -1.0, -1.0),
            inset_part: Vec4::ZERO,
            inset_bounds: Vec4::ZERO,
            inset_source: Vec4::ZERO,
            inset_ramp: Vec2::ONE,
            padding: Vec2::ZERO,
        };
        composition.inset.map_or(uniforms, |inset| uniforms.with_inset(&inset, places))
    }

    /// Returns the uniforms for images whose rows are counted from the top.
    pub fn rows_from_top(composition: &Composition, places: &LevelPlaces) -> LevelUniforms {
        LevelUniforms::new(&composition.rows_from_top(), places)
    }

    fn with_inset(self, inset: &InsetPlace, places: &LevelPlaces) -> LevelUniforms {
        let LevelPlace { size, scale, offset } = inset.place;
        let ramp = |i: usize| if inset.fade[i] > 0.0 { size[i] as f32 / inset.fade[i] } else { HARD };
        let source = inset.source.filter(|_| places.depth).unwrap_or_default().map(|n| n as f32);
        LevelUniforms {
            inset_place: Map { scale, offset }.vector(),
            inset_part: Map::of_part(places.inset, size, places.inset_image).vector(),
            inset_bounds: bounds(places.inset, size, places.inset_image),
            inset_source: Vec4::new(source[0], source[1], source[2], 0.0),
            inset_ramp: Vec2::new(ramp(0), ramp(1)),
            ..self
        }
    }
}
