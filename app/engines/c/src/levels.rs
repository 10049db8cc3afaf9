//! The levels of a foveated view, and how an eye is composed of them.

use glam::Vec3;
use yoro::eyes::{
    Composition, Eye, EyePair, Foveation, FoveationLevel, Gaze, InsetPlace, LevelPlace, ViewLayer,
};

use crate::eyes::YoroEyes;
use crate::result::{Failure, YORO_ERROR_NULL, YoroResult, catch_errors};
use crate::versioned::{self, Given, versioned};
use crate::views::{YoroViews, guard_band, views, views_by};

/// The strength of foveation, as OpenXR's runtimes name it.
pub type YoroFoveationLevel = u32;
/// All pixels everywhere.
pub const YORO_FOVEATION_OFF: YoroFoveationLevel = 0;
/// An inset of 30 degrees around the gaze, half of the pixels along each axis beyond.
pub const YORO_FOVEATION_LOW: YoroFoveationLevel = 1;
/// An inset of 20 degrees, half of the pixels along each axis beyond.
pub const YORO_FOVEATION_MEDIUM: YoroFoveationLevel = 2;
/// An inset of 20 degrees, a third of the pixels along each axis beyond.
pub const YORO_FOVEATION_HIGH: YoroFoveationLevel = 3;

/// How much of the eyes' images is rendered with all pixels.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct YoroFoveation {
    /// sizeof(YoroFoveation).
    pub struct_size: u32,
    /// The strength.
    pub level: YoroFoveationLevel,
    /// Angle in radians around the gaze that has all pixels. 0: that of the level.
    pub radius: f32,
    /// Pixels of the wide view for each pixel of an eye's image, along each axis, at most 1. 0: that of the level.
    pub density: f32,
    /// The distance in metres from which on the other eye's inset is complete. 0: 0.5.
    pub nearest: f32,
    /// Angle in radians beyond the radius over which the inset fades into the wide view. 0: a hard seam.
    pub fade: f32,
    /// 0: the inset lies around each eye's own axis. 1: around `gaze`, for both.
    pub tracked: u32,
    /// A direction in the world, of any length.
    pub gaze: [f32; 3],
}

versioned!(YoroFoveation);

/// How an eye's image is made of its levels. yoro_levels_from_eyes fills it. It can be copied and kept.
///
/// Places in images are from 0 to 1, from the left and from row 0. The place p in the eye's image is the place scale * p
/// + offset in that of a level.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct YoroComposition {
    /// Width of the eye's image in pixels.
    pub width: u32,
    /// Height of the eye's image in pixels.
    pub height: u32,
    /// Width of the wide level's image in pixels.
    pub wide_width: u32,
    /// Height of the wide level's image in pixels.
    pub wide_height: u32,
    /// Width of the inset's image in pixels; 0 if there is only one level.
    pub inset_width: u32,
    /// Height of the inset's image in pixels; 0 if there is only one level.
    pub inset_height: u32,
    /// Columns and rows over which the inset fades in; 0 for a hard seam.
    pub inset_fade: [f32; 2],
    /// Places in the wide level.
    pub wide_scale: [f64; 2],
    /// Places in the wide level.
    pub wide_offset: [f64; 2],
    /// Places in the inset.
    pub inset_scale: [f64; 2],
    /// Places in the inset.
    pub inset_offset: [f64; 2],
    /// Of the synthesized eye: with the depth d, what the inset shows at the place x comes from the place
    /// a * x + b + c * d of the rendered image, whose borders are -1 and 1; these are a, b and c.
    /// Zeros for the rendered eye.
    pub inset_source: [f64; 3],
}

/// Computes the levels of a foveated view: a wide one of few pixels, and an inset of all of them where the eyes look.
/// Render and synthesize each as the views of yoro_views_from_eyes, then compose each eye: yoro_gl_compose,
/// yoro_vk_compose, or your own pass with the shader kit. The guard band of the eyes is that of the wide level.
///
/// Call it from any thread, without a context. It allocates and keeps nothing. Sizes do not depend on a tracked gaze.
///
/// @param eyes         The eyes.
/// @param foveation    What is rendered with all pixels.
/// @param wide         Receives the views of the wide level. The caller sets struct_size.
/// @param inset        Receives the views of the inset, all zeros if there is only one level: without foveation, or if
///                     an inset would save no pixels. The caller sets struct_size.
/// @param compositions Receives how to compose the left and the right eye.
/// @pre All pointers point to structures, of the sizes that they state, and `compositions` to two.
/// @return YORO_ERROR_VALUE for an impossible foveation; those of yoro_views_from_eyes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn yoro_levels_from_eyes(
    eyes: *const YoroEyes,
    foveation: *const YoroFoveation,
    wide: *mut YoroViews,
    inset: *mut YoroViews,
    compositions: *mut YoroComposition,
) -> YoroResult {
    catch_errors(|told| {
        // SAFETY: the header requires pointers to structures of the sizes that they state.
        let eyes = unsafe { versioned::read(eyes, "eyes") }?;
        *told = eyes.messages;
        // SAFETY: as above.
        let foveation = unsafe {
            versioned::check_output(wide, "wide")?;
            versioned::check_output(inset, "inset")?;
            versioned::read(foveation, "foveation")?
        };
        if compositions.is_null() {
            return Err(Failure::new(YORO_ERROR_NULL, "compositions is NULL: give two YoroCompositions"));
        }
        let (result, own) = foveation.levels(&eyes)?;
        // SAFETY: as above; the write needs no alignment.
        unsafe {
            versioned::write(wide, "wide", &own[0])?;
            versioned::write(inset, "inset", &own[1])?;
            compositions.cast::<[YoroComposition; 2]>().write_unaligned(result);
        }
        Ok(())
    })
}

impl YoroFoveation {
    /// Returns the core's foveation.
    fn core(&self) -> Result<Option<Foveation>, Failure> {
        let level = match self.level {
            YORO_FOVEATION_OFF => FoveationLevel::Off,
            YORO_FOVEATION_LOW => FoveationLevel::Low,
            YORO_FOVEATION_MEDIUM => FoveationLevel::Medium,
            YORO_FOVEATION_HIGH => FoveationLevel::High,
            other => {
                return Err(Failure::value(format!("{other} is no level: give a YORO_FOVEATION_ constant")));
            }
        };
        let or = |own: f32, level: f32| if own == 0.0 { level } else { own };
        Ok(level.foveation().map(|of_level| Foveation {
            radius: or(self.radius, of_level.radius),
            density: or(self.density, of_level.density),
            nearest: or(self.nearest, of_level.nearest),
            fade: self.fade,
        }))
    }

    /// Returns the compositions of both eyes, and the views of the wide level and of the inset.
    fn levels(&self, eyes: &YoroEyes) -> Result<([YoroComposition; 2], [YoroViews; 2]), Failure> {
        let (foveation, own) = (self.core()?, eyes.checked()?);
        let gaze = match self.tracked {
            0 => Gaze::Axes(own.axes),
            1 => Gaze::Direction(Vec3::from_array(self.gaze)),
            other => return Err(Failure::value(format!("tracked is {other}: give 0 or 1"))),
        };
        let guard = guard_band(eyes.guard_band);
        let levels = own.pair.stereo_views(foveation.as_ref(), gaze)?;
        let wide = own.with_matrices(views(levels.wide.eyes, guard, own.rows_down)?);
        let inset = match levels.inset {
            Some(layer) => {
                let inset = |pair: &EyePair| ViewLayer { eyes: *pair, ..layer }.synthesis_views(guard);
                own.with_matrices(views_by(layer.eyes, own.rows_down, inset)?)
            }
            None => YoroViews::default(),
        };
        let compositions = Eye::BOTH.map(|eye| YoroComposition::new(&levels.composition(eye), own.rows_down));
        Ok((compositions, [wide, inset]))
    }
}

impl YoroComposition {
    /// Returns a composition whose rows are counted from the bottom, or from the top if `down`.
    fn new(core: &Composition, down: bool) -> YoroComposition {
        let turned = if down { core.rows_from_top() } else { *core };
        let wide = turned.wide;
        let mut own = YoroComposition {
            width: core.size[0],
            height: core.size[1],
            wide_width: wide.size[0],
            wide_height: wide.size[1],
            wide_scale: wide.scale,
            wide_offset: wide.offset,
            ..YoroComposition::default()
        };
        if let Some(inset) = turned.inset {
            [own.inset_width, own.inset_height] = inset.place.size;
            (own.inset_scale, own.inset_offset) = (inset.place.scale, inset.place.offset);
            own.inset_fade = inset.fade;
            own.inset_source = inset.source.unwrap_or_default();
        }
        own
    }
}

impl Given for YoroComposition {
    type Core = Composition;
    const MISSING: &'static str = "composition is NULL: give one of yoro_levels_from_eyes";

    fn checked(&self) -> Result<Composition, Failure> {
        let sizes = [[self.width, self.height], [self.wide_width, self.wide_height]];
        let has_inset = self.inset_width > 0 && self.inset_height > 0;
        let numbers = [self.wide_scale, self.wide_offset, self.inset_scale, self.inset_offset];
        let numbers = numbers.iter().flatten().chain(&self.inset_source);
        let is_whole = sizes.iter().flatten().all(|side| (1..=1 << 16).contains(side))
            && [self.inset_width, self.inset_height].iter().all(|side| *side <= 1 << 16)
            // Written so that NaN fails too.
            && numbers.copied().all(|number| number.abs() < 1e9)
            && self.inset_fade.iter().all(|pixels| *pixels >= 0.0);
        if !is_whole {
            return Err(Failure::value("a composition is impossible: take it from yoro_levels_from_eyes"));
        }
        let inset = has_inset.then_some(InsetPlace {
            place: LevelPlace {
                size: [self.inset_width, self.inset_height],
                scale: self.inset_scale,
                offset: self.inset_offset,
            },
            fade: self.inset_fade,
            source: (self.inset_source != [0.0; 3]).then_some(self.inset_source),
        });
        let wide = LevelPlace { size: sizes[1], scale: self.wide_scale, offset: self.wide_offset };
        Ok(Composition { size: sizes[0], wide, inset })
    }
}
