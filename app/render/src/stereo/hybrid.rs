//! The far field rendered once, from between the eyes, and shared; the near field rendered for both eyes.
//!
//! After Fink et al., "Hybrid Mono-Stereo Rendering in Virtual Reality" (IEEE VR 2019), from its description: beyond a
//! distance the eyes' images differ by less than can be seen. The split is made per pixel, by the clip planes, and the
//! images are put together before bloom and tone mapping.

use std::rc::Rc;

use glam::IVec2;

use super::finish::Finish;
use super::method::{EyeTarget, StereoError, StereoMethod};
use super::options::{AntiAliasing, StereoOptions};
use crate::render::{
    DepthImage, FinishTargets, GBuffer, GpuScene, Layout, LightTargets, RenderSettings, Renderer, Role,
    RoleKind, depth_test,
};
use yoro::eyes::{DepthConvention, Eye, EyePair, EyesError, GuardBand, Pose, View};
use yoro_gl::{Context, GlError, Program, RasterState, RenderTarget, ShaderSource};

/// The far field starts this much nearer than the near field ends, so that no crack opens where a surface that is
/// seen at an angle passes from one to the other.
const OVERLAP: f32 = 0.95;

/// What is drawn for each eye and what for both, as near and far plane in metres; `None` for nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Split {
    pub(super) near: Option<[f32; 2]>,
    pub(super) far: Option<[f32; 2]>,
}

impl Split {
    /// As [`Split::new`], but all is near where nothing of the scene is far.
    pub(super) fn of_scene(
        pair: &EyePair,
        threshold: f32,
        renderer: &Renderer,
        scene: &GpuScene,
        far_view: &View,
    ) -> Split {
        let split = Split::new(pair, threshold);
        match split.far.filter(|&slice| renderer.sees_any(scene, far_view, slice)) {
            Some(_) => split,
            None => Split { near: Some([pair.depth.near, pair.depth.far]), far: None },
        }
    }

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

/// Two renders of what is near, one of what is far.
///
/// Before the far field is drawn, its pixels that the near field hides from both eyes are marked in its depth buffer:
/// they are neither rasterized nor lit. Each eye's lighting skips the pixels that show the far field. Where nothing is
/// far the frame is that of two full renders and costs as much.
pub struct Hybrid {
    gl: Rc<Context>,
    threshold: f32,
    /// By [`Eye::index`].
    near: [GBuffer; 2],
    far: GBuffer,
    far_light: LightTargets,
    /// Of the eye that is being lit.
    light: LightTargets,
    image: FinishTargets,
    hidden: Program,
    far_depth: Program,
    finish: Finish,
}

impl Hybrid {
    /// Makes the targets.
    ///
    /// # Errors
    /// [`GlError`] when the driver refuses a target or a program.
    pub fn new(
        gl: &Rc<Context>,
        settings: &RenderSettings,
        options: &StereoOptions,
    ) -> Result<Hybrid, GlError> {
        let g_buffer = || GBuffer::new(gl, Layout::Single, [1, 1], DepthConvention::Standard);
        Ok(Hybrid {
            gl: gl.clone(),
            threshold: options.split_disparity,
            near: [g_buffer()?, g_buffer()?],
            far: g_buffer()?,
            far_light: LightTargets::new(gl, [1, 1], settings)?,
            light: LightTargets::new(gl, [1, 1], settings)?,
            image: FinishTargets::new(gl, [1, 1], settings)?,
            hidden: Program::new(gl, ShaderSource::Screen("stereo/hidden.frag"), &[])?,
            far_depth: Program::new(gl, ShaderSource::Screen("stereo/far_depth.frag"), &[])?,
            finish: Finish::new(gl, settings, options.anti_aliasing != AntiAliasing::Off)?,
        })
    }

    /// Marks the far field's pixels that the near field hides from both eyes.
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

    /// Completes an eye's depth by that of the far field, for whoever needs the depth of the finished image.
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

/// The far field's view: both frusta, from between the eyes.
pub(super) fn far_view(pair: &EyePair) -> Result<View, EyesError> {
    let union = pair.synthesis(GuardBand::None)?.source;
    Ok(View { pose: Pose { position: pair.middle(), ..union.pose }, ..union })
}

/// Pixel of the far field that belongs to each eye's lower left pixel, to the nearest whole pixel: where frusta differ
/// by a fraction, the far field is off by at most half a pixel, which is what it leaves out anyway.
pub(super) fn crops(pair: &EyePair, far: &View) -> [IVec2; 2] {
    Eye::BOTH.map(|eye| {
        let (frustum, size) = (&pair.frusta[eye.index()], far.size.map(|n| n as f32));
        let x = (frustum.left - far.frustum.left) / far.frustum.width() * size[0];
        let y = (frustum.bottom - far.frustum.bottom) / far.frustum.height() * size[1];
        // The union is rounded up to whole pixels, so that the eye's image always lies inside.
        let last = |whole: u32, part: u32| (whole - part.min(whole)) as i32;
        IVec2::new(
            (x.round() as i32).clamp(0, last(far.size[0], pair.size[0])),
            (y.round() as i32).clamp(0, last(far.size[1], pair.size[1])),
        )
    })
}

impl StereoMethod for Hybrid {
    fn prepare(&mut self, renderer: &mut Renderer, scene: &GpuScene) -> Result<(), StereoError> {
        let roles = [RoleKind::Whole, RoleKind::NearField, RoleKind::FarField];
        Ok(renderer.prepare(scene, Layout::Single, &roles)?)
    }

    fn render_to(
        &mut self,
        renderer: &mut Renderer,
        scene: &GpuScene,
        pair: &EyePair,
        to: &[EyeTarget; 2],
    ) -> Result<(), StereoError> {
        self.prepare(renderer, scene)?;
        let far_view = far_view(pair)?;
        let crops = crops(pair, &far_view);
        let split = Split::of_scene(pair, self.threshold, renderer, scene, &far_view);
        self.light.resize(pair.size)?;
        self.image.resize(pair.size)?;
        for eye in Eye::BOTH {
            let near = &mut self.near[eye.index()];
            near.fit(pair.size, pair.depth.convention)?;
            renderer.draw(near, scene, &[pair.view(eye)], split.near, |_| {});
        }
        if split.far.is_some() {
            self.far.fit(far_view.size, pair.depth.convention)?;
            self.far_light.resize(far_view.size)?;
            let mark = |target: &RenderTarget| self.mark_hidden(target, &far_view, &crops);
            renderer.draw(&self.far, scene, &[far_view], split.far, mark);
            renderer.light(&self.far_light, &self.far, scene, &far_view, Role::FarField);
        }
        for eye in Eye::BOTH {
            let (view, near, crop) = (pair.view(eye), &self.near[eye.index()], crops[eye.index()]);
            let role = match split.far {
                Some(_) => Role::NearField { far: self.far_light.hdr(), crop },
                None => Role::Whole,
            };
            renderer.light(&self.light, near, scene, &view, role);
            renderer.finish(&self.image, &self.light);
            let to = &to[eye.index()];
            if split.far.is_some() && (scene.has_transparent() || to.depth.is_some()) {
                self.merge_depth(near.target(), &view, crop);
            }
            let depth = DepthImage::whole(near.target().depth());
            self.finish.eye(renderer, scene, &view, self.image.color(), depth, to)?;
        }
        Ok(())
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
        let law = pair.synthesis(GuardBand::None).unwrap().warp.law;
        assert!((law.displacement(pair.depth.depth(z) as f64) - 1.0).abs() < 1e-2);
        assert_eq!(split.far, Some([OVERLAP * z, 1000.0]));
        assert_eq!(Split::new(&pair, 0.01), Split { near: Some([0.3, 1000.0]), far: None });
        pair.poses[0] = pair.poses[1];
        assert_eq!(Split::new(&pair, 1.0), Split { near: None, far: Some([0.3, 1000.0]) });
    }

    #[test]
    fn both_eyes_lie_inside_the_far_field() {
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
            let views = pair.synthesis(GuardBand::None).unwrap();
            let far = views.source;
            let crops = crops(&pair, &far);
            assert_eq!(crops[dominant.index()].to_array(), views.dominant_crop.map(|n| n as i32));
            // The union is rounded up: its other border may lie a pixel beyond the other eye's.
            let room = far.size[0] as i32 - 640;
            assert!((0..=1).contains(&crops[0].x) && (room - 1..=room).contains(&crops[1].x), "{crops:?}");
            assert_eq!([crops[0].y, crops[1].y], [0, 0]);
            assert!(far.size[0] > 700);
        }
    }
}
