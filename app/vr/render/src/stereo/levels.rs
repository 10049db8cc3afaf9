//! Eyes of two levels: a wide view of few pixels, and an inset of all of them where the eyes look.
//!
//! A level is a pair of eyes of its own that goes through a method of its own, whose targets have its size. Nothing is
//! allocated when an inset moves.

use std::rc::Rc;

use super::auto::SelectedMethod;
use super::method::{EyeTarget, LevelEyes, MethodReport, StereoError, StereoFrame, StereoMethod};
use super::options::{Method, StereoOptions};
use crate::view::{GpuScene, RenderSettings, Renderer};
use yoro::eyes::{Eye, EyePair, StereoViews};
use yoro::opengl::{Composer, GlState, InsetImage, LevelImage, LevelImages};
use yoro_gl::{Context, Destination, GlError};

/// The levels of the eyes of a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EyeLevels {
    /// The eyes as they are shown.
    pub shown: EyePair,
    /// The level that fills the eyes' images.
    pub wide: EyePair,
    /// The level where the eyes look; `None` if the wide one has all pixels.
    pub inset: Option<EyePair>,
}

impl From<&EyePair> for EyeLevels {
    /// Returns the one level that has all pixels.
    fn from(pair: &EyePair) -> EyeLevels {
        EyeLevels { shown: *pair, wide: *pair, inset: None }
    }
}

impl From<&StereoViews> for EyeLevels {
    fn from(levels: &StereoViews) -> EyeLevels {
        let StereoViews { shown, wide, inset, .. } = levels;
        EyeLevels { shown: *shown, wide: wide.eyes, inset: inset.map(|inset| inset.eyes) }
    }
}

impl EyeLevels {
    /// Returns the pair of each level, the wide one first.
    pub fn pairs(&self) -> impl Iterator<Item = &EyePair> {
        [Some(&self.wide), self.inset.as_ref()].into_iter().flatten()
    }
}

/// The targets of a frame of levels, by [`Eye::index`]. Each has the size of its level.
#[derive(Clone, Copy)]
pub struct LevelTargets<'a> {
    /// Targets of the wide level.
    pub wide: [EyeTarget<'a>; 2],
    /// Targets of the inset, if there is one.
    pub inset: Option<[EyeTarget<'a>; 2]>,
}

impl<'a> From<&[EyeTarget<'a>; 2]> for LevelTargets<'a> {
    fn from(to: &[EyeTarget<'a>; 2]) -> LevelTargets<'a> {
        LevelTargets { wide: *to, inset: None }
    }
}

impl<'a> LevelTargets<'a> {
    /// Returns the targets of each level, the wide one first.
    pub fn pairs(&self) -> impl Iterator<Item = &[EyeTarget<'a>; 2]> {
        [Some(&self.wide), self.inset.as_ref()].into_iter().flatten()
    }
}

/// A method for each level.
pub(super) struct LevelMethods {
    wide: Box<dyn StereoMethod>,
    inset: Option<Box<dyn StereoMethod>>,
    /// The distance in metres from which on insets are complete.
    nearest: f32,
}

impl LevelMethods {
    /// Makes the method once, and once more for insets if the options have them.
    pub(super) fn new(
        gl: &Rc<Context>,
        method: Method,
        settings: &RenderSettings,
        options: &StereoOptions,
    ) -> Result<LevelMethods, GlError> {
        let create = |options| super::create(gl, method, settings, options);
        // A runtime gets motion vectors of the wide level alone.
        let inset = StereoOptions { motion_vectors: false, ..*options };
        Ok(LevelMethods {
            wide: create(options)?,
            inset: options.inset.map(|_| create(&inset)).transpose()?,
            nearest: options.inset.unwrap_or(f32::INFINITY),
        })
    }

    fn each(&mut self) -> impl Iterator<Item = &mut Box<dyn StereoMethod>> {
        [Some(&mut self.wide), self.inset.as_mut()].into_iter().flatten()
    }

    pub(super) fn prepare(&mut self, renderer: &mut Renderer, scene: &GpuScene) -> Result<(), StereoError> {
        self.each().try_for_each(|method| method.prepare(renderer, scene))
    }

    /// Returns the wide level's report. Both eyes count as rendered if they were in either level.
    pub(super) fn report(&self) -> MethodReport {
        let wide = self.wide.report();
        let inset = self.inset.as_ref().and_then(|inset| inset.report().substituted);
        MethodReport { substituted: wide.substituted.or(inset), ..wide }
    }

    /// Renders all levels of a frame.
    pub(super) fn render(
        &mut self,
        renderer: &mut Renderer,
        scene: &GpuScene,
        levels: &EyeLevels,
        to: &LevelTargets,
    ) -> Result<(), StereoError> {
        let shown = levels.inset.map(|_| levels.shown);
        let wide = LevelEyes { eyes: levels.wide, shown, nearest: None };
        self.wide.render_level(renderer, scene, &wide, &to.wide)?;
        let Some(((inset, eyes), to)) = self.inset.as_mut().zip(levels.inset).zip(to.inset.as_ref()) else {
            return Ok(());
        };
        inset.render_level(renderer, scene, &LevelEyes { eyes, shown, nearest: Some(self.nearest) }, to)
    }
}

/// The images of a frame of levels, and the pass that makes the shown eyes from them for whoever has no last pass of its
/// own that reads an eye.
pub struct LevelFrame {
    composer: Composer,
    wide: StereoFrame,
    inset: StereoFrame,
    /// The levels that the images fit; `None` before the first frame.
    levels: Option<StereoViews>,
}

impl LevelFrame {
    /// Makes small images, to be fitted to the levels of a frame. `srgb` as in
    /// [`Outputs`](yoro::opengl::Outputs), for composing.
    ///
    /// # Errors
    /// [`GlError`] if the driver refuses.
    pub fn new(gl: &Rc<Context>, srgb: bool) -> Result<LevelFrame, GlError> {
        Ok(LevelFrame {
            composer: Composer::new(gl, GlState::Leave, srgb)?,
            wide: StereoFrame::new(gl, [1, 1])?,
            inset: StereoFrame::new(gl, [1, 1])?,
            levels: None,
        })
    }

    /// Fits the images to levels, and returns them as targets. Does nothing else while sizes stay.
    ///
    /// # Errors
    /// As [`StereoFrame::resize`].
    pub fn fit(&mut self, levels: &StereoViews) -> Result<LevelTargets<'static>, GlError> {
        self.levels = Some(*levels);
        self.wide.resize(levels.wide.eyes.size)?;
        if let Some(inset) = &levels.inset {
            self.inset.resize(inset.eyes.size)?;
        }
        Ok(LevelTargets { wide: self.wide.targets(), inset: levels.inset.map(|_| self.inset.targets()) })
    }

    /// Renders both eyes of all levels, and composes them into rectangles of the eyes' size, by [`Eye::index`].
    ///
    /// # Errors
    /// As [`SelectedMethod::render_levels`].
    pub fn render(
        &mut self,
        method: &mut SelectedMethod,
        (renderer, scene): (&mut Renderer, &GpuScene),
        levels: &StereoViews,
        to: &[Destination; 2],
    ) -> Result<(), StereoError> {
        let targets = self.fit(levels)?;
        method.render_levels(renderer, scene, &levels.into(), &targets)?;
        self.compose(to);
        Ok(())
    }

    /// Returns the images of a level and its eyes, the wide one first, to draw more over them.
    pub fn levels(&self) -> impl Iterator<Item = (&StereoFrame, &EyePair)> {
        let levels = self.levels.as_ref();
        let wide = levels.map(|levels| (&self.wide, &levels.wide.eyes));
        let inset = levels.and_then(|levels| levels.inset.as_ref()).map(|inset| (&self.inset, &inset.eyes));
        [wide, inset].into_iter().flatten()
    }

    /// Returns an eye's images and how it is composed of them, for a pass that reads the finished eye; `None` before the
    /// first frame.
    pub fn eye(&self, eye: Eye) -> Option<(LevelImages, yoro::eyes::Composition)> {
        let levels = self.levels.as_ref()?;
        let image = |frame: &StereoFrame| LevelImage::new(frame.eye(eye).color(0).raw());
        // The band of an inset reaches as near as eyes can focus: without depth, what is nearer is filled there as it is at
        // the border of a whole eye.
        let inset = levels.inset.map(|_| InsetImage { image: image(&self.inset), depth: None });
        Some((LevelImages { wide: image(&self.wide), inset }, levels.composition(eye)))
    }

    /// Composes both eyes into rectangles of their size, by [`Eye::index`]. Draws nothing before the first frame.
    pub fn compose(&self, to: &[Destination; 2]) {
        for eye in Eye::BOTH {
            if let Some((images, composition)) = self.eye(eye) {
                self.composer.compose(&images, &composition, &to[eye.index()]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::{Quat, Vec3};
    use yoro::eyes::{DepthConvention, Foveation, Gaze, GuardBand};
    use yoro_context::{Backend, Headless};

    use super::super::MethodChoice;
    use super::super::tests::{Rig, equal_share, local, pair};
    use super::*;

    /// Both eyes composed of their levels.
    fn composed(rig: &mut Rig, method: &mut SelectedMethod, levels: &StereoViews) -> [Vec<u8>; 2] {
        let gl = rig.gl();
        let mut frame = LevelFrame::new(&gl, false).unwrap();
        let shown = StereoFrame::new(&gl, levels.shown.size).unwrap();
        frame.render(method, rig.parts(), levels, &shown.colors()).unwrap();
        Eye::BOTH.map(|eye| shown.rgba(eye))
    }

    fn foveation() -> Foveation {
        Foveation { radius: 0.2, ..Foveation::MEDIUM }
    }

    fn options() -> StereoOptions {
        StereoOptions { inset: Some(foveation().nearest), policy: None, ..StereoOptions::default() }
    }

    /// Returns the pixels of an eye's image that its inset covers.
    fn fovea(rgba: &[u8], levels: &StereoViews, eye: Eye) -> Vec<u8> {
        let (shown, inset) = (&levels.shown, levels.inset.unwrap().eyes);
        let corner = |low: f32, inset: f32, extent: f32, pixels: u32| {
            ((inset - low) / extent * pixels as f32).round() as usize
        };
        let (all, own) = (&shown.frusta[eye.index()], &inset.frusta[eye.index()]);
        let x = corner(all.left, own.left, all.width(), shown.size[0]);
        let y = corner(all.bottom, own.bottom, all.height(), shown.size[1]);
        let row = |row: usize| {
            let first = ((y + row) * shown.size[0] as usize + x) * 4;
            &rgba[first..first + inset.size[0] as usize * 4]
        };
        (0..inset.size[1] as usize).flat_map(row).copied().collect()
    }

    /// In the fovea every method shows what it shows of a whole eye, and beyond it a picture of the same scene.
    #[test]
    fn the_fovea_is_that_of_a_whole_eye() {
        let head = Headless::open(Backend::Egl).unwrap();
        let gl = head.gl();
        let settings = local();
        let mut rig = Rig::new(gl, &settings);
        let methods = [Method::Conventional, Method::Instanced, Method::Mono, Method::Synthesized];
        for (method, dominant) in methods.into_iter().flat_map(|m| Eye::BOTH.map(|eye| (m, eye))) {
            let pair = pair(dominant, DepthConvention::Standard);
            let axes = Gaze::Axes(pair.axes());
            let levels = pair.levels(Some(&foveation()), axes, GuardBand::Distance(1.0)).unwrap();
            let mut subject = SelectedMethod::new(gl, method.into(), &settings, &options()).unwrap();
            let whole = rig.render(&mut subject, &pair);
            let foveated = composed(&mut rig, &mut subject, &levels);
            for eye in Eye::BOTH {
                let [want, got] = [&whole, &foveated].map(|images| fovea(&images[eye.index()], &levels, eye));
                let share = equal_share(&want, &got);
                assert!(share > 0.99, "{method:?}, {dominant:?} dominant, {eye:?}: {share} of the fovea");
                let error = |other: &[u8]| {
                    let pixels = whole[eye.index()].iter().zip(other);
                    pixels.map(|(a, b)| u64::from(a.abs_diff(*b)).pow(2)).sum::<u64>()
                };
                let [around, apart] = [eye, eye.other()].map(|eye| error(&foveated[eye.index()]));
                assert!(
                    method == Method::Mono || around * 3 < apart,
                    "{method:?}, {eye:?}: {around} {apart}"
                );
            }
        }
        assert_eq!(gl.take_errors(), None);
    }

    /// Two renders, which cost twice as much, and the automatic choice among both take the same levels. Nothing is made
    /// when a gaze moves.
    #[test]
    fn a_gaze_that_moves_allocates_nothing() {
        let head = Headless::open(Backend::Egl).unwrap();
        let gl = head.gl();
        let settings = RenderSettings { msaa: 4, ..local() };
        let mut rig = Rig::new(gl, &settings);
        let pair = pair(Eye::Right, DepthConvention::Reversed);
        for choice in [Method::Conventional.into(), Method::Synthesized.into(), MethodChoice::Auto] {
            let mut subject = SelectedMethod::new(gl, choice, &settings, &options()).unwrap();
            let mut frame = LevelFrame::new(gl, false).unwrap();
            let shown = StereoFrame::new(gl, pair.size).unwrap();
            let mut held = None;
            for i in 0..12 {
                let turn =
                    Quat::from_rotation_y(0.05 * (i - 6) as f32) * Quat::from_rotation_x(0.02 * i as f32);
                let gaze = Gaze::Direction(turn * Vec3::NEG_Z);
                let levels = pair.levels(Some(&foveation()), gaze, GuardBand::Distance(1.0)).unwrap();
                frame.render(&mut subject, rig.parts(), &levels, &shown.colors()).unwrap();
                // The first frames make what both methods need.
                if i > 2 {
                    let now = (gl.object_count(), gl.texture_bytes());
                    assert_eq!(*held.get_or_insert(now), now, "{choice:?}, gaze {i}");
                }
            }
        }
        assert_eq!(gl.take_errors(), None);
    }

    /// Lights that a view cannot all have are the same in both levels.
    #[test]
    fn levels_have_the_same_lights() {
        let head = Headless::open(Backend::Egl).unwrap();
        let gl = head.gl();
        let settings = RenderSettings { point_lights: 3, ..local() };
        let mut rig = Rig::with_lights(gl, &settings);
        let pair = pair(Eye::Right, DepthConvention::Standard);
        let axes = Gaze::Axes(pair.axes());
        let levels = pair.levels(Some(&foveation()), axes, GuardBand::Distance(1.0)).unwrap();
        let mut subject =
            SelectedMethod::new(gl, Method::Conventional.into(), &settings, &options()).unwrap();
        let whole = rig.render(&mut subject, &pair);
        let foveated = composed(&mut rig, &mut subject, &levels);
        let [want, got] = [&whole, &foveated].map(|images| fovea(&images[1], &levels, Eye::Right));
        let share = equal_share(&want, &got);
        assert!(share > 0.99, "{share} of the fovea");
    }
}
