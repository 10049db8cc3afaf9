//! The pictures that a server sends of a scene.

use std::rc::Rc;

use image::{GrayImage, Luma};

use yoro::eyes::{DepthRange, Eye, EyePair, EyesError, GuardBand, HeadMotion, View};
use yoro_gl::{Context, GlError};
use yoro_media::video::{Planes, depth_luma};
use yoro_media::{depth_image, rgb_image};
use yoro_render::{PreparedScene, ViewReader};

use crate::{Content, DepthSpan, EyeView, ViewRequest};

/// The error when a picture cannot be made.
#[derive(Debug, thiserror::Error)]
pub enum StreamError {
    /// The eyes cannot be widened by the guard band.
    #[error(transparent)]
    Eyes(#[from] EyesError),
    /// With the guard band, the eyes would have too many pixels.
    #[error("the requested eyes of {0}x{1} pixels are so narrow that their guard band would have {2}x{3}")]
    Narrow(u32, u32, u32, u32),
    /// GL refused.
    #[error(transparent)]
    Gl(#[from] GlError),
}

/// By how many times a picture may be wider and higher than the requested eyes.
const WIDEST: u32 = 3;

/// The content of a stream.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// One eye and its depth, from which both eyes are made at the newest pose.
    Depth,
    /// Both eyes, rotated to the newest pose: the baseline.
    Eyes,
}

/// The largest motion of the head between rendering and display that the guard band covers: 4 degrees and 2 cm.
const MOTION: HeadMotion = HeadMotion { rotation: 0.07, translation: 0.02 };
/// The distance in metres of the nearest surface for which the guard band covers that motion.
const NEAREST: f32 = 1.0;

/// A picture to be encoded.
pub struct Picture {
    /// All parts of the picture.
    pub planes: Planes,
    /// What the parts show.
    pub content: Content,
    /// The width and height of each part, without the padding that makes them even.
    pub size: [u16; 2],
    /// True if the range of depth has changed, so that the frame must be an intra frame.
    pub new_span: bool,
}

/// Makes the pictures that a server sends of a scene.
pub struct FrameRenderer {
    reader: ViewReader,
    span: DepthSpan,
    mode: Mode,
}

impl FrameRenderer {
    /// Compiles the programs.
    ///
    /// # Errors
    /// [`GlError`] if the driver refuses.
    pub fn new(gl: &Rc<Context>, mode: Mode) -> Result<FrameRenderer, GlError> {
        Ok(FrameRenderer { reader: ViewReader::new(gl)?, span: DepthSpan::default(), mode })
    }

    /// Returns the picture that answers a request.
    ///
    /// # Errors
    /// [`StreamError`] for eyes that cannot be rendered.
    pub fn picture(
        &mut self,
        prepared: &mut PreparedScene,
        request: &ViewRequest,
    ) -> Result<Picture, StreamError> {
        let pair = EyePair {
            poses: request.eyes.map(|eye| eye.pose),
            frusta: request.eyes.map(|eye| eye.frustum),
            depth: DepthRange::PAPER,
            size: request.size.map(u32::from),
            dominant: request.dominant,
        };
        let eye_view = |view: &View| EyeView { pose: view.pose, frustum: view.frustum };
        let size = |view: &View| view.size.map(|n| n as u16);
        let guarded = |view: &View, motion: HeadMotion| {
            let ([w, h], guarded) = (pair.size, motion.guarded(view, NEAREST)?.view);
            let [width, height] = guarded.size;
            match width <= WIDEST * w && height <= WIDEST * h {
                true => Ok(guarded),
                false => Err(StreamError::Narrow(w, h, width, height)),
            }
        };
        if self.mode == Mode::Eyes {
            let still = HeadMotion { translation: 0.0, ..MOTION };
            let left = guarded(&pair.view(Eye::Left), still)?;
            let right = View { size: left.size, ..guarded(&pair.view(Eye::Right), still)? };
            let planes = self.color(prepared, &left)?.beside(&self.color(prepared, &right)?);
            let content = Content::Eyes([eye_view(&left), eye_view(&right)]);
            return Ok(Picture { planes, content, size: size(&left), new_span: false });
        }
        // The view is wide enough to synthesize the other eye from it. Eyes that are not parallel cannot be synthesized
        // from each other and are taken as they are.
        let views = pair.synthesis_views(GuardBand::Distance(NEAREST));
        let view = guarded(&views.map_or(pair.view(pair.dominant), |views| views.source), MOTION)?;
        let color = self.color(prepared, &view)?;
        let depth = depth_image(&self.reader.depth(), view.size);
        let far = view.depth.clear_value();
        let distance = |value: f32| view.depth.distance(value);
        let surfaces = depth.iter().copied().filter(|value| *value != far).map(distance);
        let (nearest, farthest) =
            surfaces.fold((f32::INFINITY, 0.0f32), |(near, far), z| (near.min(z), far.max(z)));
        let (span, new_span) = self.span.fit(nearest, farthest);
        let luma = GrayImage::from_fn(depth.width(), depth.height(), |x, y| {
            Luma([depth_luma(distance(depth.get_pixel(x, y).0[0]), span)])
        });
        let planes = color.beside(&Planes::of_gray(&luma));
        Ok(Picture { planes, content: Content::Depth(eye_view(&view), span), size: size(&view), new_span })
    }

    fn color(&mut self, prepared: &mut PreparedScene, view: &View) -> Result<Planes, StreamError> {
        let rgba = self.reader.color(&mut prepared.renderer, &prepared.scene, view)?;
        Ok(Planes::of_rgb(&rgb_image(&rgba, view.size)))
    }
}
