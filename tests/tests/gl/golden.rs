//! Compares built-in scenes with golden images.

use std::rc::Rc;

use image::{Rgb, RgbImage};
use yoro::eyes::Eye;
use yoro_context::Headless;
use yoro_gl::Context;
use yoro_render::stereo::{Pipeline, stills};
use yoro_tests::{backends, golden};

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

#[test]
fn backends_agree_on_every_pipeline() {
    let frames: Vec<_> = backends()
        .into_iter()
        .map(|backend| {
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
