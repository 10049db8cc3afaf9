//! Both ends of a stream on the desktop: the server's pictures, and the eyes that a viewer makes of them.

use std::rc::Rc;

use image::{GrayImage, Luma, RgbImage};

use crate::dataset::{GroupError, GroupOptions, GroupRenderer};
use crate::picture;
use yoro::eyes::{DepthRange, EyePair, EyesError, GuardBand, HeadMotion, PoseWarp, View};
use yoro::synthesis::{AnyView, Outputs, Source, SynthesisOptions};
use yoro_gl::{Context, Destination, Filter, Format, GlError, RenderTarget, Texture};
use yoro_render::PreparedScene;
use yoro_stream::{Content, DepthSpan, EyeView, ViewRequest};
use yoro_video::{Planes, depth_luma};

/// What a stream carries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// One eye and its depth, of which both eyes are made at the newest pose.
    Depth,
    /// Both eyes, turned to the newest pose: the baseline.
    Eyes,
}

/// The largest motion of the head between rendering and display that the guard band covers: 4 degrees, 2 cm.
const MOTION: HeadMotion = HeadMotion { rotation: 0.07, translation: 0.02 };
/// The nearest surface that it covers the motion for, in metres.
const NEAREST: f32 = 1.0;

/// A picture to be encoded.
pub struct Picture {
    /// Both halves.
    pub planes: Planes,
    /// What they show.
    pub content: Content,
    /// Width and height of each half, without what makes them even.
    pub size: [u16; 2],
    /// True if the range of depth has changed: the frame must be an intra frame.
    pub new_span: bool,
}

/// Makes a server's pictures of a scene.
pub struct FrameRenderer {
    groups: GroupRenderer,
    span: DepthSpan,
    mode: Mode,
}

impl FrameRenderer {
    /// Compiles what it needs.
    ///
    /// # Errors
    /// [`GlError`] when the driver refuses.
    pub fn new(gl: &Rc<Context>, mode: Mode) -> Result<FrameRenderer, GlError> {
        let options = GroupOptions { anti_aliasing: true, ..GroupOptions::default() };
        Ok(FrameRenderer { groups: GroupRenderer::new(gl, &options)?, span: DepthSpan::default(), mode })
    }

    /// Returns the picture for a request: one eye and its depth, or both eyes.
    ///
    /// # Errors
    /// [`GroupError`] for eyes that cannot be rendered.
    pub fn picture(
        &mut self,
        prepared: &mut PreparedScene,
        request: &ViewRequest,
    ) -> Result<Picture, GroupError> {
        let pair = EyePair {
            poses: request.eyes.map(|eye| eye.pose),
            frusta: request.eyes.map(|eye| eye.frustum),
            depth: DepthRange::PAPER,
            size: request.size.map(u32::from),
            dominant: request.dominant,
        };
        let guarded = |view: &View, motion: HeadMotion| Ok(motion.guarded(view, NEAREST)?.view);
        let eye_view = |view: &View| EyeView { pose: view.pose, frustum: view.frustum };
        let size = |view: &View| view.size.map(|n| n as u16);
        if self.mode == Mode::Eyes {
            let still = HeadMotion { translation: 0.0, ..MOTION };
            let views = views_of(&pair).map(|view| guarded(&view, still));
            let [left, right]: [Result<View, EyesError>; 2] = views;
            let views = [left?, right?];
            let mut eyes = Vec::new();
            for view in &views {
                eyes.push(Planes::of_rgb(&self.groups.render_one(prepared, view)?.0));
            }
            let content = Content::Eyes([eye_view(&views[0]), eye_view(&views[1])]);
            let planes = eyes[0].beside(&eyes[1]);
            return Ok(Picture { planes, content, size: size(&views[0]), new_span: false });
        }
        // Eyes that are not parallel cannot be synthesized from one another: the dominant view is taken as it is.
        let own =
            pair.synthesis_views(GuardBand::Distance(NEAREST)).map_or(pair.view(pair.dominant), |v| v.source);
        let view = guarded(&own, MOTION)?;
        let (color, depth) = self.groups.render_one(prepared, &view)?;
        let far = view.depth.clear_value();
        let distance = |value: f32| view.depth.distance(value);
        let surfaces = depth.iter().copied().filter(|value| *value != far).map(distance);
        let (nearest, farthest) =
            surfaces.fold((f32::INFINITY, 0.0f32), |(near, far), z| (near.min(z), far.max(z)));
        let (span, new_span) = self.span.fit(nearest, farthest);
        let luma = GrayImage::from_fn(depth.width(), depth.height(), |x, y| {
            Luma([depth_luma(distance(depth.get_pixel(x, y).0[0]), span)])
        });
        let planes = Planes::of_rgb(&color).beside(&Planes::of_gray(&luma));
        Ok(Picture { planes, content: Content::Depth(eye_view(&view), span), size: size(&view), new_span })
    }
}

fn views_of(pair: &EyePair) -> [View; 2] {
    yoro::eyes::Eye::BOTH.map(|eye| pair.view(eye))
}

/// Makes eyes of a stream's pictures, as the page does.
pub struct Receiver {
    gl: Rc<Context>,
    any_view: AnyView,
    shown: RenderTarget,
}

impl Receiver {
    /// Compiles what it needs.
    ///
    /// # Errors
    /// [`GlError`] when the driver refuses.
    pub fn new(gl: &Rc<Context>) -> Result<Receiver, GlError> {
        Ok(Receiver {
            gl: gl.clone(),
            any_view: AnyView::new(gl, &SynthesisOptions::default(), Outputs::default())?,
            shown: RenderTarget::new(gl, [1, 1], &[(Format::Rgba8, Filter::Linear)], None)?,
        })
    }

    /// Returns both eyes of a pair, made of a picture as it was decoded.
    ///
    /// # Errors
    /// [`GroupError`] for eyes that see nothing of the picture.
    pub fn eyes(
        &mut self,
        planes: &Planes,
        content: &Content,
        size: [u16; 2],
        pair: &EyePair,
    ) -> Result<[RgbImage; 2], GroupError> {
        let [left, right] = planes.halves();
        let [width, height] = size.map(u32::from);
        let texture = |format, filter, bytes: &[u8]| -> Result<Texture, GlError> {
            let texture = Texture::new(&self.gl, [width, height], format, filter)?;
            texture.upload(bytes);
            Ok(texture)
        };
        let color = |half: &Planes| {
            let image = half.rgb((width, height));
            let rgba: Vec<u8> =
                image.rows().rev().flatten().flat_map(|p| [p.0[0], p.0[1], p.0[2], 255]).collect();
            texture(Format::Rgba8, Filter::Linear, &rgba)
        };
        let gray = right.gray((width, height));
        let values: Vec<u8> = gray.rows().rev().flatten().map(|p| p.0[0]).collect();
        let depth = texture(Format::R8, Filter::Nearest, &values)?;
        let images = match content {
            Content::Depth(..) => vec![color(&left)?],
            Content::Eyes(_) => vec![color(&left)?, color(&right)?],
        };
        let mut eyes = Vec::new();
        for (i, target) in views_of(pair).iter().enumerate() {
            let (image, warp) = match content {
                Content::Depth(eye_view, span) => {
                    (&images[0], PoseWarp::new(&eye_view.view(size, *span), target)?)
                }
                Content::Eyes(eyes) => {
                    let source = eyes[i].view(size, [1.0, 2.0]);
                    (&images[i], PoseWarp::new(&source, target)?.rotation_only())
                }
            };
            self.shown.resize(target.size)?;
            let source = Source::new(image.raw(), depth.raw());
            self.any_view.synthesize(source, &warp, &Destination::whole(&self.shown))?;
            eyes.push(picture::rgb_image(&self.shown.read_rgba8(0, [0, 0], target.size), target.size));
        }
        let [left, right] = eyes.try_into().expect("two eyes");
        Ok([left, right])
    }
}
