//! Compares built-in scenes with golden images.

use std::rc::Rc;

use image::{Rgb, RgbImage};
use yoro::eyes::{Eye, EyeOptions, Foveation, Gaze};
use yoro_context::Headless;
use yoro_gl::Context;
use yoro_render::stereo::{Method, Pipeline, StereoFrame, StereoOptions, StereoSession, stills};
use yoro_render::{PreparedScene, RenderSettings};
use yoro_test_support::laws::backends;
use yoro_tests::golden;

const SIZE: u32 = 256;

/// Renders both eyes, left first, at a built-in scene's first viewpoint with each pipeline. The left is synthesized.
fn render(gl: &Rc<Context>, name: &str, pipelines: &[Pipeline]) -> anyhow::Result<Vec<[RgbImage; 2]>> {
    let scene = yoro_scenes::build(name, yoro_scenes::DEFAULT_SEED)?;
    let frames = stills(gl, scene, pipelines, SIZE)?;
    Ok(frames.into_iter().map(|both| both.map(|rgba| image(&rgba))).collect())
}

fn image(rgba: &[u8]) -> RgbImage {
    RgbImage::from_fn(SIZE, SIZE, |x, y| {
        let i = (((SIZE - 1 - y) * SIZE + x) * 4) as usize;
        Rgb([rgba[i], rgba[i + 1], rgba[i + 2]])
    })
}

/// Compares all images before failing, so that one run shows all changes.
fn check(images: &[(String, &RgbImage)]) {
    let failures: Vec<String> = images
        .iter()
        .filter_map(|(name, image)| golden::check(name, image).err())
        .map(|error| format!("{error:#}"))
        .collect();
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn every_pipeline_gives_its_golden_image() {
    let headless = Headless::open(backends()[0]).unwrap();
    let frames = render(headless.gl(), "prototype", &Pipeline::ALL).unwrap();
    let mut images = vec![("prototype-rendered".to_owned(), &frames[0][1])];
    for (pipeline, [left, _]) in Pipeline::ALL.iter().zip(&frames) {
        images.push((format!("prototype-{}", pipeline.name()), left));
    }
    check(&images);
}

#[test]
fn scenes_give_their_golden_images() {
    let headless = Headless::open(backends()[0]).unwrap();
    for name in ["talk", "stage"] {
        let frames = render(headless.gl(), name, &[Pipeline::default()]).unwrap();
        check(&[(name.to_owned(), &frames[0][0])]);
    }
}

/// An eye of 90 degrees that is composed of its levels: all pixels to 20 degrees, half of them along each axis beyond.
#[test]
fn a_foveated_eye_gives_its_golden_image() -> anyhow::Result<()> {
    let headless = Headless::open(backends()[0])?;
    let gl = headless.gl();
    let scene = yoro_scenes::build("prototype", yoro_scenes::DEFAULT_SEED)?;
    let eyes = EyeOptions { size: [SIZE; 2], fov_y: 90f32.to_radians(), ..EyeOptions::default() };
    let pair = eyes.pair(scene.viewpoints[0].pose());
    let options = StereoOptions { policy: None, ..StereoOptions::default() };
    let settings = RenderSettings::default();
    let mut scene = PreparedScene::new(gl, scene, &settings)?;
    let mut session = StereoSession::new(gl, Method::Synthesized.into(), &settings, &options)?;
    let mut frame = StereoFrame::new(gl, pair.size)?;
    let views = pair.stereo_views(Some(&Foveation::MEDIUM), Gaze::Axes(pair.axes()))?;
    session.frame(&mut scene, &views, frame.fit(pair.size)?, None)?;
    check(&[("prototype-foveated".to_owned(), &image(&frame.rgba(Eye::Left)))]);
    Ok(())
}

#[test]
fn backends_agree_on_every_pipeline() {
    let frames: Vec<_> = backends()
        .iter()
        .map(|&backend| {
            let headless = Headless::open(backend).unwrap();
            render(headless.gl(), "prototype", &Pipeline::ALL).unwrap()
        })
        .collect();
    for other in &frames[1..] {
        for (pipeline, (a, b)) in Pipeline::ALL.iter().zip(frames[0].iter().zip(other)) {
            for eye in Eye::BOTH {
                if let Err(error) = golden::compare(&b[eye.index()], &a[eye.index()]) {
                    panic!("{} eye by {}: {error}", eye.name(), pipeline.name());
                }
            }
        }
    }
}
