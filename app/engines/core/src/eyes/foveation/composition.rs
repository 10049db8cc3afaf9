//! The places of the levels in an eye's image.

use super::{Eye, GuardBand, StereoViews, ViewLayer};
use crate::eyes::Frustum;

/// The levels of one eye in its image, for the composer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Composition {
    /// Width and height of the eye's image in pixels.
    pub size: [u32; 2],
    /// The wide level.
    pub wide: LevelPlace,
    /// The inset, if there is one.
    pub inset: Option<InsetPlace>,
}

/// The place of a level in its eye's image. Places in images are from 0 to 1, from the lower left corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LevelPlace {
    /// Width and height of the level's image in pixels.
    pub size: [u32; 2],
    /// The place in the level's image of the place `p` in the eye's is `scale * p + offset`.
    pub scale: [f64; 2],
    /// See `scale`.
    pub offset: [f64; 2],
}

/// The place of the inset in its eye's image, and what is shown of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InsetPlace {
    /// Its place.
    pub place: LevelPlace,
    /// Columns and rows from the border inwards over which the inset fades in; 0 for a hard seam.
    pub fade: [f32; 2],
    /// For a synthesized eye, `[across, offset, scale]`: what the inset shows at the place x, from 0 to 1, with the stored
    /// depth d comes from the place `across * x + offset + scale * d` of the rendered image, from -1 at its left border to
    /// 1. Beyond, it is a hole at the border that was filled, and the wide view shows more.
    pub source: Option<[f64; 3]>,
}

impl StereoViews {
    /// Returns how an eye is composed of its levels. The levels' images are the crop of the rendered image for the
    /// dominant eye ([`SynthesisViews::dominant_crop`](crate::eyes::SynthesisViews::dominant_crop)), and the synthesized ones for the other.
    pub fn composition(&self, eye: Eye) -> Composition {
        let shown = &self.shown.frusta[eye.index()];
        let place =
            |level: &ViewLayer| LevelPlace::new(shown, &level.eyes.frusta[eye.index()], level.eyes.size);
        let inset = self.inset.as_ref().map(|level| InsetPlace {
            place: place(level),
            fade: self.fade,
            source: (eye != self.shown.dominant).then(|| level.source()).flatten(),
        });
        Composition { size: self.shown.size, wide: place(&self.wide), inset }
    }
}

impl ViewLayer {
    /// Returns the numbers of [`InsetPlace::source`]; `None` for eyes that are not synthesized from each other.
    fn source(&self) -> Option<[f64; 3]> {
        // The guard band is that of an inset.
        let warp = self.synthesis_views(GuardBand::None).ok()?.warp;
        let per_column = 2.0 / f64::from(warp.source_size[0]);
        // Indices of columns are half a pixel less than the places of their middles, in both images.
        Some([
            f64::from(warp.target_size[0]) * per_column,
            -warp.law.offset * per_column - 1.0,
            -warp.law.scale * per_column,
        ])
    }
}

impl Composition {
    /// Returns the composition of images whose rows are counted from the top, or the other way round.
    pub fn rows_from_top(&self) -> Composition {
        let inset = self.inset.map(|inset| InsetPlace { place: inset.place.rows_from_top(), ..inset });
        Composition { wide: self.wide.rows_from_top(), inset, ..*self }
    }
}

impl LevelPlace {
    /// Returns the place of a level in an image, by the frusta of both.
    fn new(shown: &Frustum, level: &Frustum, size: [u32; 2]) -> LevelPlace {
        let along = |[low, high]: [f32; 2], [level_low, level_high]: [f32; 2]| {
            let [low, high, level_low, level_high] = [low, high, level_low, level_high].map(f64::from);
            let extent = level_high - level_low;
            ((high - low) / extent, (low - level_low) / extent)
        };
        let (across, left) = along([shown.left, shown.right], [level.left, level.right]);
        let (up, bottom) = along([shown.bottom, shown.top], [level.bottom, level.top]);
        LevelPlace { size, scale: [across, up], offset: [left, bottom] }
    }

    /// Returns the place for images whose rows are counted from the top.
    pub fn rows_from_top(&self) -> LevelPlace {
        let offset = [self.offset[0], 1.0 - self.scale[1] - self.offset[1]];
        LevelPlace { offset, ..*self }
    }
}
