//! The images of both eyes, in the layers of which a last pass or the composer makes the eyes that are shown.

use std::rc::Rc;

use super::method::{DepthTarget, EyeTarget, StereoFrame};
use crate::view::{DepthCopy, DepthImage};
use yoro::eyes::{Composition, DepthConvention, Eye, EyePair, InsetPlace, StereoViews};
use yoro::opengl::{Composer, GlState, InsetImage, LevelImages, Part};
use yoro_gl::{Context, Destination, Format, GlError, RenderTarget};

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
    /// The depth of the synthesized eye; made with the first one that has an inset.
    depth: Option<SynthesizedDepth>,
    /// True if an eye of these views is synthesized, and has an inset.
    has_depth: bool,
    /// Made with the first eye that is composed here.
    composer: Option<Composer>,
    /// The views that the images show; `None` before the first frame.
    views: Option<StereoViews>,
}

/// The depth that the wide layer of the synthesized eye has, and the part of it where the inset is.
///
/// What the wide layer shows there may come from beyond the border of the image of which the inset is synthesized: near
/// things that are cut off by that border, or lie outside of it, and are in front of what the inset shows. The composer
/// shows the wide layer there.
struct SynthesizedDepth {
    wide: RenderTarget,
    inset: RenderTarget,
    copy: DepthCopy,
}

impl StereoImages {
    /// Makes small images, which are fitted to the views of each frame.
    ///
    /// # Errors
    /// As [`StereoFrame::new`].
    pub fn new(gl: &Rc<Context>) -> Result<StereoImages, GlError> {
        let wide = StereoFrame::new(gl, [1, 1])?;
        Ok(StereoImages {
            gl: gl.clone(),
            wide,
            inset: None,
            depth: None,
            has_depth: false,
            composer: None,
            views: None,
        })
    }

    /// Fits the images to views, and returns them as targets. `is_synthesized` says whether one of the eyes will be, and
    /// `parts` of which image the dominant eye is a part, in the wide layer and in the inset. Allocates nothing while sizes
    /// stay.
    pub(super) fn fit(
        &mut self,
        views: &StereoViews,
        is_synthesized: bool,
        parts: [Option<Part>; 2],
    ) -> Result<LayerTargets<'_>, GlError> {
        self.views = Some(*views);
        let [wide_part, inset_part] = parts.map(|part| Some((views.shown.dominant, part?)));
        self.wide.resize_around(views.wide.eyes.size, wide_part)?;
        let mut wide: [EyeTarget; 2] = self.wide.targets();
        self.has_depth = is_synthesized && views.inset.is_some();
        let Some(layer) = &views.inset else { return Ok(LayerTargets { wide, inset: None }) };
        let inset = match &mut self.inset {
            Some(inset) => inset,
            slot => slot.insert(StereoFrame::new(&self.gl, layer.eyes.size)?),
        };
        inset.resize_around(layer.eyes.size, inset_part)?;
        if is_synthesized {
            let depth = match &mut self.depth {
                Some(depth) => depth,
                slot => slot.insert(SynthesizedDepth::new(&self.gl)?),
            };
            depth.wide.resize(views.wide.eyes.size)?;
            depth.inset.resize(layer.eyes.size)?;
            let to = Destination::whole(&depth.wide);
            wide[views.shown.dominant.other().index()].depth = Some(DepthTarget { to, copy: &depth.copy });
        }
        Ok(LayerTargets { wide, inset: Some(inset.targets()) })
    }

    /// Completes the images after their layers were rendered.
    pub(super) fn complete(&self) {
        let (Some(views), Some(depth)) = (&self.views, self.depth.as_ref().filter(|_| self.has_depth)) else {
            return;
        };
        let Composition { wide, inset, .. } = views.composition(views.shown.dominant.other());
        let Some(InsetPlace { place: inset, .. }) = inset else { return };
        // From a pixel of the inset to its place in the eye, and on to the pixel of the wide layer.
        let map = [0, 1].map(|i| {
            let pixels = f64::from(wide.size[i]);
            let scale = wide.scale[i] / inset.scale[i] * pixels / f64::from(inset.size[i]);
            (scale, (wide.offset[i] - wide.scale[i] / inset.scale[i] * inset.offset[i]) * pixels)
        });
        let map = [map.map(|(scale, _)| scale as f32), map.map(|(_, first)| first as f32)];
        let convention = views.shown.depth.convention;
        depth.copy.run_scaled(&depth.image(convention), &Destination::whole(&depth.inset), convention, map);
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
        let inset = self.inset.as_ref().filter(|_| views.inset.is_some());
        let depth = self.depth.as_ref().filter(|_| self.has_depth && eye != views.shown.dominant);
        let depth = depth.map(|depth| depth.inset.depth().raw());
        let inset = inset.map(|inset| InsetImage { image: inset.level(eye), depth });
        Some((LevelImages { wide: self.wide.level(eye), inset }, views.composition(eye)))
    }

    /// Completes the images, and composes both eyes into their targets, by [`Eye::index`].
    pub(super) fn compose(&mut self, to: &[EyeTarget; 2]) -> Result<(), GlError> {
        self.complete();
        if self.composer.is_none() {
            self.composer = Some(Composer::new(&self.gl, GlState::Leave, false)?);
        }
        for eye in Eye::BOTH {
            if let (Some(composer), Some((images, composition))) = (&self.composer, self.eye(eye)) {
                composer.compose(&images, &composition, &to[eye.index()].color);
            }
        }
        let Some((views, depth)) = self.views.as_ref().zip(self.depth.as_ref()).filter(|_| self.has_depth)
        else {
            return Ok(());
        };
        // The wide layer's depth was written here in place of the target.
        let to = &to[views.shown.dominant.other().index()];
        if let Some(DepthTarget { to, copy }) = to.depth_of_wide(views) {
            let convention = views.shown.depth.convention;
            copy.run(&depth.image(convention), &to, convention);
        }
        Ok(())
    }
}

impl SynthesizedDepth {
    fn new(gl: &Rc<Context>) -> Result<SynthesizedDepth, GlError> {
        let depth = || RenderTarget::new(gl, [1, 1], &[], Some(Format::Depth32F));
        Ok(SynthesizedDepth { wide: depth()?, inset: depth()?, copy: DepthCopy::new(gl)? })
    }

    /// Returns the depth of the wide layer.
    fn image(&self, convention: DepthConvention) -> DepthImage<'_> {
        DepthImage { texture: self.wide.depth(), origin: [0, 0], layer: None, is_pair: false, convention }
    }
}

#[cfg(test)]
mod tests {
    use crate::fixture::quad;
    use crate::view::RenderSettings;
    use glam::{Quat, Vec3};
    use yoro::eyes::{DepthRange, Foveation, Frustum, Gaze, Pose};
    use yoro_assets::{Material, Model, Scene};
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

    /// Two checkered boards at a distance, one on each side of the inset, before a checkered wall.
    fn boards(distance: f32) -> Scene {
        let paint = |shade: f32| Material {
            diffuse: Vec3::splat(shade),
            unlit: true,
            double_sided: true,
            ..Material::default()
        };
        let materials = [0.9, 0.1, 0.5, 0.3].map(paint).to_vec();
        let mut model = Model { materials, ..Model::default() };
        let mut checker = |first: usize, center: Vec3, edge: f32, squares: u32| {
            for i in 0..squares * squares {
                let (x, y, size) = (i % squares, i / squares, edge / squares as f32);
                let corner = center + Vec3::new(x as f32 * size, y as f32 * size, 0.0)
                    - Vec3::new(edge / 2.0, edge / 2.0, 0.0);
                quad(&mut model, first + ((x + y) % 2) as usize, corner, Vec3::X * size, Vec3::Y * size);
            }
        };
        for side in [-1.0, 1.0] {
            checker(0, Vec3::new(side * 0.4, side * 0.05, -1.0) * distance, 0.38 * distance, 4);
        }
        checker(2, Vec3::new(0.0, 0.0, -4.0), 16.0, 24);
        Scene { name: "boards".into(), model, ..super::super::tests::scene() }
    }

    #[test]
    fn near_things_are_whole_at_the_border_of_the_inset() {
        let head = Headless::open(Backend::Egl).unwrap();
        let gl = head.gl();
        let settings = local();
        for (distance, dominant) in [(0.31, Eye::Right), (0.25, Eye::Left)] {
            let mut rig = Rig::of(gl, &settings, boards(distance));
            let size = [400, 240];
            let frustum = Frustum { left: -1.0, right: 1.0, bottom: -0.6, top: 0.6 };
            let depth = DepthRange { near: 0.1, far: 100.0, convention: DepthConvention::Standard };
            let pair = EyePair::parallel(Pose::IDENTITY, frustum, 0.063, depth, size, dominant);
            let views = pair.stereo_views(Some(&Foveation::MEDIUM), Gaze::Axes(pair.axes())).unwrap();
            let mut subject =
                StereoSession::new(gl, Method::Synthesized.into(), &settings, &options()).unwrap();
            let mut truth =
                StereoSession::new(gl, Method::Conventional.into(), &settings, &options()).unwrap();
            let got = composed(&mut rig, &mut subject, &views);
            let want = composed(&mut rig, &mut truth, &views);
            let other = dominant.other();
            // The middles of both boards in the other eye, 80 pixels from the middle between the eyes.
            let aside = -other.side() * 0.0315 / distance;
            for side in [-1.0, 1.0] {
                let middle = ((1.0 + side * 0.4 + aside) * 200.0) as usize;
                let row = (120.0 + side * 10.0) as usize;
                let is_torn = |x: &usize| {
                    let at = |y: usize| (y * 400 + x) * 4;
                    let differs =
                        |y: &usize| got[other.index()][at(*y)].abs_diff(want[other.index()][at(*y)]) > 60;
                    (row - 35..row + 35).filter(differs).count() > 20
                };
                let columns: Vec<bool> = (middle - 35..middle + 35).map(|x| is_torn(&x)).collect();
                let longest = columns.split(|torn| !torn).map(<[bool]>::len).max();
                // Edges of squares are wider in the wide layer, and a pixel beside.
                assert!(longest <= Some(2), "{distance} m, {side}: {longest:?} columns are torn");
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
