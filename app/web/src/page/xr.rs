//! Both eyes of a headset, as WebXR has them.

use std::rc::Rc;

use yoro::eyes::{DepthRange, Eye, EyePair, GuardBand};
use yoro_gl::{Context, Destination, Format, GlError, RenderTarget};
use yoro_lenses::{Content, Hud, Placement};
use yoro_render::stereo::{DepthTarget, EyeTarget, Method, StereoError, StereoFrame, StereoMethod};
use yoro_render::{DepthCopy, PreparedScene};

use super::show::Show;
use crate::settings::Settings;
use crate::views::{VIEW_FLOATS, view};
use crate::walker::Walker;

/// Near and far plane of a WebXR session.
pub const DEPTH: DepthRange = DepthRange { near: 0.1, ..DepthRange::PAPER };

/// The images of a headset, and what draws them.
pub struct Headset {
    frame: StereoFrame,
    depth: [RenderTarget; 2],
    copy: DepthCopy,
    hud: Hud,
    /// The method that renders both eyes, once neither could be synthesized from the other.
    substitute: Option<Box<dyn StereoMethod>>,
}

impl Headset {
    /// Makes images of this size.
    ///
    /// # Errors
    /// The GPU cannot do it.
    pub fn new(gl: &Rc<Context>, size: [u32; 2]) -> Result<Headset, GlError> {
        let depth = || RenderTarget::new(gl, size, &[], Some(Format::Depth24));
        Ok(Headset {
            frame: StereoFrame::new(gl, size)?,
            depth: [depth()?, depth()?],
            copy: DepthCopy::new(gl)?,
            hud: Hud::new(gl)?,
            substitute: None,
        })
    }

    /// Gives the images another size.
    ///
    /// # Errors
    /// The GPU cannot do it.
    pub fn resize(&mut self, size: [u32; 2]) -> Result<(), GlError> {
        self.frame.resize(size)?;
        self.depth.iter_mut().try_for_each(|depth| depth.resize(size))
    }

    /// Returns the images of the last frame.
    pub fn frame(&self) -> &StereoFrame {
        &self.frame
    }

    /// Renders both eyes; `text` hangs before them. False when both were rendered because neither can be synthesized from
    /// the other.
    ///
    /// # Errors
    /// The method's.
    pub fn draw(
        &mut self,
        gl: &Rc<Context>,
        settings: &Settings,
        prepared: &mut PreparedScene,
        method: &mut dyn StereoMethod,
        pair: &EyePair,
        text: &str,
    ) -> Result<bool, StereoError> {
        let Headset { frame, depth, copy, hud, substitute } = self;
        let fits = !settings.method.needs_aligned_eyes() || pair.synthesis(GuardBand::None).is_ok();
        let method = match substitute {
            _ if fits => method,
            Some(substitute) => substitute.as_mut(),
            none => none.insert(settings.create(gl, Method::Conventional)?).as_mut(),
        };
        let colors = frame.targets();
        let to = [0, 1].map(|i| EyeTarget {
            depth: Some(DepthTarget { to: Destination::whole(&depth[i]), copy }),
            ..colors[i]
        });
        method.render_to(&mut prepared.renderer, &prepared.scene, pair, &to)?;
        if !text.is_empty() {
            let panel = hud.set(Content { text, progress: None }, Placement::Below);
            panel.draw_into_eyes(pair, &colors.map(|target| target.color));
        }
        Ok(fits)
    }

    /// Draws an eye's image and depth into the framebuffer that is bound.
    pub fn show(&self, show: &Show, eye: Eye, origin: [u32; 2], size: [u32; 2]) {
        let depth = &self.depth[eye.index()];
        debug_assert_eq!(self.frame.eye(eye).size(), depth.size());
        show.with_depth(self.frame.eye(eye).color(0), depth.depth(), origin, size);
    }
}

/// Reads both eyes as WebXR describes them, the left one first; none for anything else.
pub fn eyes(views: &[f32], settings: &Settings, walker: &Walker, size: [u32; 2]) -> Option<EyePair> {
    let (left, right) = views.split_at_checked(VIEW_FLOATS)?;
    let (left, right) = (view(left)?, view(right)?);
    Some(EyePair {
        poses: [left.0, right.0].map(|pose| walker.locate(pose)),
        frusta: [left.1, right.1],
        depth: DEPTH,
        size,
        dominant: settings.dominant,
    })
}
