//! Images of both eyes of a scene at rest, to compare a driver's pictures with stored ones.

use std::rc::Rc;

use super::{Method, Pipeline, StereoError, StereoFrame, StereoOptions, StereoSession};
use crate::prepared::PreparedScene;
use crate::view::RenderSettings;
use yoro::eyes::{DepthRange, Eye, EyePair, Frustum};
use yoro_assets::Scene;
use yoro_gl::Context;
use yoro_settings::Ipd;

/// Renders the right eye of a scene's first viewpoint and synthesizes the left one with each pipeline at its default
/// settings. Returns both images, left first: RGBA with rows from the bottom, `size` pixels square, 60 degrees wide.
///
/// # Errors
/// [`StereoError`] if the driver refuses the scene, a shader or an image.
pub fn stills(
    gl: &Rc<Context>,
    scene: Scene,
    pipelines: &[Pipeline],
    size: u32,
) -> Result<Vec<[Vec<u8>; 2]>, StereoError> {
    let (head, size) = (scene.viewpoints[0].pose(), [size; 2]);
    let frustum = Frustum::symmetric(60f32.to_radians(), 1.0);
    let pair = EyePair::parallel(head, frustum, Ipd::DEFAULT.metres(), DepthRange::PAPER, size, Eye::Right);
    let settings = RenderSettings::default();
    let mut scene = PreparedScene::new(gl, scene, &settings)?;
    let mut frame = StereoFrame::new(gl, size)?;
    let mut both = |&pipeline: &Pipeline| {
        // Never two renders, however near everything is.
        let options = StereoOptions { policy: None, ..StereoOptions::of_pipeline(pipeline) };
        let mut session = StereoSession::new(gl, Method::Synthesized.into(), &settings, &options)?;
        session.frame(&mut scene, &pair.into(), frame.fit(size)?, None)?;
        Ok(Eye::BOTH.map(|eye| frame.eye(eye).read_rgba8(0, [0, 0], size)))
    };
    pipelines.iter().map(&mut both).collect()
}
