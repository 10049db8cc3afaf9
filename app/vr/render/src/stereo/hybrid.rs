//! Renders the far field once, from between the eyes, for both eyes, and the near field for each eye.
//!
//! After Fink et al., "Hybrid Mono-Stereo Rendering in Virtual Reality" (IEEE VR 2019), from its description: beyond a
//! certain distance the eyes' images differ by less than can be seen. The clip planes split the scene per pixel, and
//! the images are combined before bloom and tone mapping.

use std::rc::Rc;

use glam::IVec2;

use super::finish::{EyeImage, Finish};
use super::frame::{Frame, FrameMethod, Setup};
use super::method::StereoError;
use crate::render::{
    DeferredRenderer, DepthImage, FinishTargets, ForwardRenderer, ForwardTargets, GBuffer, GpuScene, Layout,
    LightTargets, Part, RendererOfKind, Role, RoleKind, ViewRenderer, depth_test,
};
use yoro::eyes::{Eye, EyePair, EyesError, GuardBand, Pose, View};
use yoro_gl::{Context, Destination, GlError, Program, RasterState, RenderTarget, ShaderSource};

/// The far field starts at this fraction of the distance at which the near field ends, so that no crack opens where a
/// slanted surface passes from one to the other.
const OVERLAP: f32 = 0.95;

/// Renders the near field twice and the far field once. If nothing is far, the frame is the same as two full renders
/// and costs as much.
pub struct Hybrid<T> {
    threshold: f32,
    targets: T,
    finish: Finish,
}

impl<T: FieldTargets> Hybrid<T> {
    /// Makes the targets.
    pub(super) fn new(setup: &Setup) -> Result<Hybrid<T>, GlError> {
        let threshold = setup.options.split_disparity;
        Ok(Hybrid { threshold, targets: T::new(setup)?, finish: Finish::new(setup)? })
    }
}

impl<T: FieldTargets> FrameMethod for Hybrid<T> {
    type Renderer = T::Renderer;

    fn compile(&mut self, renderer: &mut T::Renderer, scene: &GpuScene) -> Result<(), GlError> {
        T::compile(renderer, scene)
    }

    fn render_frame(&mut self, frame: &Frame<T::Renderer>) -> Result<(), StereoError> {
        let fields = Fields::new(frame.pair, self.threshold, frame.scene)?;
        self.targets.draw(frame, &fields)?;
        for eye in Eye::BOTH {
            self.finish.run(&self.targets.eye(frame, &fields, eye)?, frame.to(eye));
        }
        Ok(())
    }
}

/// Near and far plane in metres of the part drawn for each eye and of the part drawn for both; `None` if empty.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Split {
    near: Option<[f32; 2]>,
    far: Option<[f32; 2]>,
}

impl Split {
    /// Splits where the disparity is `threshold` pixels: `z = f_px * IPD / threshold`.
    fn new(pair: &EyePair, threshold: f32) -> Split {
        let (near, far) = (pair.depth.near, pair.depth.far);
        let split = pair.focal_length_pixels() * pair.ipd() / threshold;
        Split {
            near: (split > near).then_some([near, split.min(far)]),
            far: (split < far).then_some([(OVERLAP * split).max(near), far]),
        }
    }
}

/// The far field of a frame, and the position of each eye's image in it.
pub(super) struct Fields {
    split: Split,
    /// The view with both frusta from between the eyes.
    view: View,
    /// Pixel of the far field that corresponds to each eye's lower left pixel.
    crops: [IVec2; 2],
}

impl Fields {
    /// Splits a frame. If nothing in the scene is far, everything is near.
    fn new(pair: &EyePair, threshold: f32, scene: &GpuScene) -> Result<Fields, EyesError> {
        let union = pair.synthesis_views(GuardBand::None)?.source;
        let view = View { pose: Pose { position: pair.middle(), ..union.pose }, ..union };
        let mut split = Split::new(pair, threshold);
        if !split.far.is_some_and(|slice| scene.is_seen(&view, slice)) {
            split = Split { near: Some([pair.depth.near, pair.depth.far]), far: None };
        }
        Ok(Fields { split, crops: crops(pair, &view), view })
    }
}

/// Returns the pixel of the far field that corresponds to each eye's lower left pixel. Rounds to whole pixels: where
/// frusta differ by a fraction, the far field is off by at most half a pixel, about as much as its lack of parallax.
fn crops(pair: &EyePair, far: &View) -> [IVec2; 2] {
    Eye::BOTH.map(|eye| {
        let (frustum, size) = (&pair.frusta[eye.index()], far.size.map(|n| n as f32));
        let x = (frustum.left - far.frustum.left) / far.frustum.width() * size[0];
        let y = (frustum.bottom - far.frustum.bottom) / far.frustum.height() * size[1];
        // The union is rounded up to whole pixels, so the eye's image always lies inside.
        let last = |whole: u32, part: u32| (whole - part.min(whole)) as i32;
        IVec2::new(
            (x.round() as i32).clamp(0, last(far.size[0], pair.size[0])),
            (y.round() as i32).clamp(0, last(far.size[1], pair.size[1])),
        )
    })
}

/// The images of near and far field, for one kind of renderer.
pub(super) trait FieldTargets: Sized {
    /// The kind of renderer.
    type Renderer: RendererOfKind;

    fn new(setup: &Setup) -> Result<Self, GlError>;

    /// See [`FrameMethod::compile`].
    fn compile(_renderer: &mut Self::Renderer, _scene: &GpuScene) -> Result<(), GlError> {
        Ok(())
    }

    /// Draws what both eyes share: the far field, if there is one.
    fn draw(&mut self, frame: &Frame<Self::Renderer>, fields: &Fields) -> Result<(), GlError>;

    /// Completes the image of one eye, after [`FieldTargets::draw`].
    fn eye(
        &mut self,
        frame: &Frame<Self::Renderer>,
        fields: &Fields,
        eye: Eye,
    ) -> Result<EyeImage<'_>, GlError>;
}

/// G-buffers of both near fields and of the far field.
///
/// Before the far field is drawn, the pixels that the near field hides from both eyes are marked in its depth buffer,
/// so that they are neither rasterized nor lit. Each eye's lighting skips the pixels that show the far field.
pub(super) struct DeferredFields {
    gl: Rc<Context>,
    /// G-buffers by [`Eye::index`].
    near: [GBuffer; 2],
    far: GBuffer,
    far_light: LightTargets,
    /// Light of the eye that is being lit.
    light: LightTargets,
    image: FinishTargets,
    hidden: Program,
    far_depth: Program,
}

impl DeferredFields {
    /// Marks the pixels of the far field that the near field hides from both eyes.
    fn mark_hidden(&self, far: &RenderTarget, view: &View, crops: &[IVec2; 2]) {
        self.gl.set_raster_state(&RasterState::SCREEN_DEPTH);
        self.gl.mask_color();
        far.bind();
        self.hidden
            .bind()
            .texture_of("left_depth", 0, self.near[0].target().depth())
            .texture_of("right_depth", 1, self.near[1].target().depth())
            .set("crops", &crops[..])
            .set("far_depth", view.depth.clear_value());
        self.gl.draw_screen();
        self.gl.set_raster_state(&RasterState::SCREEN);
    }

    /// Adds the far field's depth to an eye's depth, for a finished image whose depth is read.
    fn merge_depth(&self, eye: &RenderTarget, view: &View, crop: IVec2) {
        self.gl.pass("merge depth", || {
            let depth = depth_test(view.depth.convention);
            self.gl.set_raster_state(&RasterState { depth, ..RasterState::SCREEN });
            self.gl.mask_color();
            eye.bind();
            self.far_depth
                .bind()
                .texture_of("far_field_depth", 0, self.far.target().depth())
                .set("crop", crop)
                .set("far_depth", view.depth.clear_value());
            self.gl.draw_screen();
            self.gl.set_raster_state(&RasterState::SCREEN);
        });
    }
}

impl FieldTargets for DeferredFields {
    type Renderer = DeferredRenderer;

    fn new(&Setup { gl, settings, .. }: &Setup) -> Result<DeferredFields, GlError> {
        let g_buffer = || GBuffer::new(gl, Layout::Single);
        Ok(DeferredFields {
            gl: gl.clone(),
            near: [g_buffer()?, g_buffer()?],
            far: g_buffer()?,
            far_light: LightTargets::new(gl, settings)?,
            light: LightTargets::new(gl, settings)?,
            image: FinishTargets::new(gl, settings)?,
            hidden: Program::new(gl, ShaderSource::Screen("stereo/hidden.frag"), &[])?,
            far_depth: Program::new(gl, ShaderSource::Screen("stereo/far_depth.frag"), &[])?,
        })
    }

    fn compile(renderer: &mut DeferredRenderer, scene: &GpuScene) -> Result<(), GlError> {
        let roles = [RoleKind::Whole, RoleKind::NearField, RoleKind::FarField];
        renderer.prepare(scene, Layout::Single, &roles)
    }

    fn draw(&mut self, frame: &Frame<DeferredRenderer>, fields: &Fields) -> Result<(), GlError> {
        let Frame { renderer, scene, pair, .. } = frame;
        let Fields { split, view, crops } = fields;
        self.light.resize(pair.size)?;
        self.image.resize(pair.size)?;
        for (near, eye) in self.near.iter_mut().zip(Eye::BOTH) {
            near.fit(pair.size, pair.depth.convention)?;
            renderer.draw(near, scene, &[pair.view(eye)], split.near.map(Part::Slice), |_| {});
        }
        if split.far.is_some() {
            self.far.fit(view.size, pair.depth.convention)?;
            self.far_light.resize(view.size)?;
            let mark = |target: &RenderTarget| self.mark_hidden(target, view, crops);
            renderer.draw(&self.far, scene, &[*view], split.far.map(Part::Slice), mark);
            renderer.light(&self.far_light, &self.far, scene, view, Role::FarField);
        }
        Ok(())
    }

    fn eye(
        &mut self,
        frame: &Frame<DeferredRenderer>,
        fields: &Fields,
        eye: Eye,
    ) -> Result<EyeImage<'_>, GlError> {
        let Frame { renderer, scene, pair, .. } = frame;
        let (view, near, crop) = (pair.view(eye), &self.near[eye.index()], fields.crops[eye.index()]);
        let is_split = fields.split.far.is_some();
        let mut role = Role::Whole;
        if is_split {
            role = Role::NearField { far: self.far_light.hdr(), crop };
        }
        renderer.light(&self.light, near, scene, &view, role);
        renderer.finish(&self.image, &self.light);
        if is_split && (scene.has_transparent() || frame.wants_depth(eye)) {
            self.merge_depth(near.target(), &view, crop);
        }
        let (color, depth) = (self.image.color(), DepthImage::whole(near.target().depth()));
        renderer.draw_transparent(&Destination::whole(color), depth, scene, &view);
        Ok(EyeImage { color, origin: [0, 0], depth: Some(depth) })
    }
}

/// The samples of an eye and of the far field.
///
/// Each eye starts from its part of the far field, colour and depth. Its near field is drawn over that sample by
/// sample, so that its edges are as smooth as all others.
pub(super) struct ForwardFields {
    eye: ForwardTargets,
    far: ForwardTargets,
}

impl FieldTargets for ForwardFields {
    type Renderer = ForwardRenderer;

    fn new(setup: &Setup) -> Result<ForwardFields, GlError> {
        let targets = || ForwardRenderer::targets(setup.gl, setup.settings);
        Ok(ForwardFields { eye: targets()?, far: targets()? })
    }

    fn draw(&mut self, frame: &Frame<ForwardRenderer>, fields: &Fields) -> Result<(), GlError> {
        match fields.split.far {
            Some(slice) => frame.renderer.render_far(&mut self.far, frame.scene, &fields.view, slice),
            None => Ok(()),
        }
    }

    fn eye(
        &mut self,
        frame: &Frame<ForwardRenderer>,
        fields: &Fields,
        eye: Eye,
    ) -> Result<EyeImage<'_>, GlError> {
        let (renderer, scene, view) = (frame.renderer, frame.scene, frame.pair.view(eye));
        let depth = frame.wants_depth(eye);
        if fields.split.far.is_some() {
            let far = (&self.far, fields.crops[eye.index()].as_uvec2().to_array());
            renderer.render_near(&mut self.eye, scene, &view, fields.split.near, far, depth)?;
        } else {
            renderer.render_all(&mut self.eye, scene, &view, depth)?;
        }
        Ok(EyeImage::whole(&self.eye, depth))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use yoro::eyes::{DepthRange, Frustum};

    #[test]
    fn the_split_is_where_the_disparity_is_the_threshold() {
        let frustum = Frustum::symmetric(60f32.to_radians(), 1.0);
        let mut pair =
            EyePair::parallel(Pose::IDENTITY, frustum, 0.063, DepthRange::PAPER, [1024; 2], Eye::Right);
        let split = Split::new(&pair, 1.0);
        let z = split.near.unwrap()[1];
        assert!((z - 55.87).abs() < 0.01, "{z}");
        let law = pair.synthesis_views(GuardBand::None).unwrap().warp.law;
        assert!((law.displacement(pair.depth.depth(z) as f64) - 1.0).abs() < 1e-2);
        assert_eq!(split.far, Some([OVERLAP * z, 1000.0]));
        assert_eq!(Split::new(&pair, 0.01), Split { near: Some([0.3, 1000.0]), far: None });
        pair.poses[0] = pair.poses[1];
        assert_eq!(Split::new(&pair, 1.0), Split { near: None, far: Some([0.3, 1000.0]) });
    }

    #[test]
    fn the_far_field_holds_both_eyes() {
        for dominant in Eye::BOTH {
            let mut pair = EyePair::parallel(
                Pose::IDENTITY,
                Frustum::symmetric(1.0, 1.0),
                0.063,
                DepthRange::PAPER,
                [640, 500],
                dominant,
            );
            pair.frusta[0] = Frustum::from_fov(-0.9, 0.73, 0.75, -0.8);
            pair.frusta[1] = Frustum::from_fov(-0.73, 0.9, 0.75, -0.8);
            let views = pair.synthesis_views(GuardBand::None).unwrap();
            let far = views.source;
            let crops = crops(&pair, &far);
            assert_eq!(crops[dominant.index()].to_array(), views.dominant_crop.map(|n| n as i32));
            // The union is rounded up, so its other border may lie a pixel beyond the other eye's.
            let room = far.size[0] as i32 - 640;
            assert!((0..=1).contains(&crops[0].x) && (room - 1..=room).contains(&crops[1].x), "{crops:?}");
            assert_eq!([crops[0].y, crops[1].y], [0, 0]);
            assert!(far.size[0] > 700);
        }
    }
}
