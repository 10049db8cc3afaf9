//! Renders the far field once, from between the eyes, for both eyes, and the near field for each eye.
//!
//! After Fink et al., "Hybrid Mono-Stereo Rendering in Virtual Reality" (IEEE VR 2019), from its description: beyond a
//! certain distance the eyes' images differ by less than can be seen. The clip planes split the scene per pixel, and
//! the images are combined before bloom.

use glam::IVec2;

use super::frame::Frame;
use super::method::{StereoError, StereoMethod};
use crate::view::{GpuScene, Layout, Renderer, Targets};
use yoro::eyes::{Eye, EyePair, EyesError, GuardBand, Pose, View};

/// The far field starts at this fraction of the distance at which the near field ends, so that no crack opens where a
/// slanted surface passes from one to the other.
const OVERLAP: f32 = 0.95;

/// Renders the near field twice and the far field once. If nothing is far, the frame is the same as two full renders
/// and costs as much.
///
/// Each eye starts from its part of the far field, colour and depth. Its near field is drawn over that sample by sample,
/// so that its edges are as smooth as all others.
pub struct Hybrid {
    threshold: f32,
    /// The targets of an eye and of the far field.
    targets: Option<[Targets; 2]>,
}

impl Hybrid {
    /// Makes it without targets; the far field starts where the disparity is `threshold` pixels.
    pub(super) fn new(threshold: f32) -> Hybrid {
        Hybrid { threshold, targets: None }
    }
}

impl StereoMethod for Hybrid {
    fn prepare(&mut self, renderer: &mut Renderer, _: &GpuScene) -> Result<(), StereoError> {
        renderer.prepare_load()?;
        if self.targets.is_none() {
            self.targets = Some([renderer.targets(Layout::Single)?, renderer.targets(Layout::Single)?]);
        }
        Ok(())
    }

    fn render(&mut self, frame: &Frame) -> Result<bool, StereoError> {
        let Some([targets, far]) = &mut self.targets else { return Ok(false) };
        let renderer = frame.renderer;
        let fields = Fields::new(&frame.pair, self.threshold, &frame.scene)?;
        if let Some(slice) = fields.split.far {
            renderer.draw_plain(far, &frame.scene, &fields.view, Some(slice))?;
        }
        for eye in Eye::BOTH {
            let (view, to) = (frame.pair.view(eye), frame.to(eye));
            let depth = frame.wants_depth(eye);
            let mut is_complete = false;
            if fields.split.far.is_some() {
                let far = (&*far, &fields.view, fields.crops[eye.index()].as_uvec2().to_array());
                renderer.draw_near(targets, &frame.scene, &view, fields.split.near, far, depth)?;
            } else {
                is_complete =
                    renderer.draw_all(targets, &frame.scene, std::slice::from_ref(&view), depth, Some(to))?;
            }
            if !is_complete {
                renderer.composite(targets, &view, Eye::Left, [0, 0], &to.color, None);
            }
            if depth {
                frame.write_depth(eye, &targets.depth(view.size, Eye::Left, [0, 0]));
            }
        }
        Ok(false)
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
struct Fields {
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
