//! The images of both eyes, in the layers of which a last pass or the composer makes the eyes that are shown.

use std::rc::Rc;

use super::method::{EyeTarget, StereoFrame};
use yoro::eyes::{Composition, Eye, EyePair, StereoViews};
use yoro::opengl::{Composer, GlState, InsetImage, LevelImage, LevelImages};
use yoro_gl::{Context, Destination, GlError};

/// The targets of a frame by layer and [`Eye::index`]. Each has the size of its layer.
#[derive(Clone, Copy)]
pub struct LayerTargets<'a> {
    /// Targets of the wide layer.
    pub wide: [EyeTarget<'a>; 2],
    /// Targets of the inset, if there is one.
    pub inset: Option<[EyeTarget<'a>; 2]>,
}

impl<'a> LayerTargets<'a> {
    /// Returns the targets of each layer, the wide one first.
    pub fn layers(&self) -> impl Iterator<Item = &[EyeTarget<'a>; 2]> {
        [Some(&self.wide), self.inset.as_ref()].into_iter().flatten()
    }
}

/// Both eyes' images in layers: the wide one, and the inset of frames that have one.
pub struct StereoImages {
    gl: Rc<Context>,
    wide: StereoFrame,
    inset: Option<StereoFrame>,
    /// Made with the first eye that is composed here.
    composer: Option<Composer>,
    /// The views that the images show; `None` before the first frame.
    views: Option<StereoViews>,
}

impl StereoImages {
    /// Makes small images, which are fitted to the views of each frame.
    ///
    /// # Errors
    /// As [`StereoFrame::new`].
    pub fn new(gl: &Rc<Context>) -> Result<StereoImages, GlError> {
        let wide = StereoFrame::new(gl, [1, 1])?;
        Ok(StereoImages { gl: gl.clone(), wide, inset: None, composer: None, views: None })
    }

    /// Fits the images to views, and returns them as targets. Allocates nothing while sizes stay.
    pub(super) fn fit(&mut self, views: &StereoViews) -> Result<LayerTargets<'static>, GlError> {
        self.views = Some(*views);
        self.wide.resize(views.wide.eyes.size)?;
        let inset = match &views.inset {
            None => None,
            Some(layer) => {
                let inset = match self.inset.take() {
                    Some(inset) => inset,
                    None => StereoFrame::new(&self.gl, layer.eyes.size)?,
                };
                let inset = self.inset.insert(inset);
                inset.resize(layer.eyes.size)?;
                Some(inset.targets())
            }
        };
        Ok(LayerTargets { wide: self.wide.targets(), inset })
    }

    /// Returns the images of the wide layer: the eyes themselves in frames without an inset.
    pub fn wide(&self) -> &StereoFrame {
        &self.wide
    }

    /// Returns the images of each layer and its eyes, the wide one first, to draw more over them.
    pub fn layers(&self) -> impl Iterator<Item = (&StereoFrame, &EyePair)> {
        let views = self.views.as_ref();
        let wide = views.map(|views| (&self.wide, &views.wide.eyes));
        let inset = views.and_then(|views| Some((self.inset.as_ref()?, &views.inset.as_ref()?.eyes)));
        [wide, inset].into_iter().flatten()
    }

    /// Returns an eye's images and how it is composed of them, for a pass that reads the finished eye; `None` before the
    /// first frame.
    pub fn eye(&self, eye: Eye) -> Option<(LevelImages, Composition)> {
        let views = self.views.as_ref()?;
        let image = |frame: &StereoFrame| LevelImage::new(frame.eye(eye).color(0).raw());
        // The band of an inset reaches as near as eyes can focus: without depth, what is nearer is filled there as it is at
        // the border of a whole eye.
        let inset = self.inset.as_ref().filter(|_| views.inset.is_some());
        let inset = inset.map(|inset| InsetImage { image: image(inset), depth: None });
        Some((LevelImages { wide: image(&self.wide), inset }, views.composition(eye)))
    }

    /// Composes both eyes into rectangles of their size, by [`Eye::index`].
    pub(super) fn compose(&mut self, to: &[Destination; 2]) -> Result<(), GlError> {
        if self.composer.is_none() {
            self.composer = Some(Composer::new(&self.gl, GlState::Leave, false)?);
        }
        for eye in Eye::BOTH {
            if let (Some(composer), Some((images, composition))) = (&self.composer, self.eye(eye)) {
                composer.compose(&images, &composition, &to[eye.index()]);
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use crate::view::RenderSettings;
    use glam::{Quat, Vec3};
    use yoro::eyes::{DepthConvention, Foveation, Gaze};
    use yoro_context::{Backend, Headless};

    use super::super::tests::{Rig, equal_share, local, pair};
    use super::super::{Method, MethodChoice, StereoOptions, StereoSession};
    use super::*;

    /// Both eyes composed of their layers.
    fn composed(rig: &mut Rig, session: &mut StereoSession, views: &StereoViews) -> [Vec<u8>; 2] {
        let mut shown = StereoFrame::new(&rig.gl(), views.shown.size).unwrap();
        rig.frame(session, views, shown.fit(views.shown.size).unwrap());
        Eye::BOTH.map(|eye| shown.rgba(eye))
    }

    fn foveation() -> Foveation {
        Foveation { radius: 0.2, ..Foveation::MEDIUM }
    }

    fn options() -> StereoOptions {
        StereoOptions { policy: None, ..StereoOptions::default() }
    }

    /// Returns the pixels of an eye's image that its inset covers.
    fn fovea(rgba: &[u8], views: &StereoViews, eye: Eye) -> Vec<u8> {
        let (shown, inset) = (&views.shown, views.inset.unwrap().eyes);
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
            let views = pair.stereo_views(Some(&foveation()), axes).unwrap();
            let mut subject = StereoSession::new(gl, method.into(), &settings, &options()).unwrap();
            let whole = rig.render(&mut subject, &pair);
            let foveated = composed(&mut rig, &mut subject, &views);
            for eye in Eye::BOTH {
                let [want, got] = [&whole, &foveated].map(|images| fovea(&images[eye.index()], &views, eye));
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
            let mut subject = StereoSession::new(gl, choice, &settings, &options()).unwrap();
            let mut shown = StereoFrame::new(gl, pair.size).unwrap();
            let mut held = None;
            for i in 0..12 {
                let turn =
                    Quat::from_rotation_y(0.05 * (i - 6) as f32) * Quat::from_rotation_x(0.02 * i as f32);
                let gaze = Gaze::Direction(turn * Vec3::NEG_Z);
                let views = pair.stereo_views(Some(&foveation()), gaze).unwrap();
                rig.frame(&mut subject, &views, shown.fit(pair.size).unwrap());
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
        let views = pair.stereo_views(Some(&foveation()), axes).unwrap();
        let mut subject = StereoSession::new(gl, Method::Conventional.into(), &settings, &options()).unwrap();
        let whole = rig.render(&mut subject, &pair);
        let foveated = composed(&mut rig, &mut subject, &views);
        let [want, got] = [&whole, &foveated].map(|images| fovea(&images[1], &views, Eye::Right));
        let share = equal_share(&want, &got);
        assert!(share > 0.99, "{share} of the fovea");
    }
}
