//! A check of the driver: compares every pipeline's picture with a stored one.
//!
//! The stored pictures are the golden images of the tests, rendered by Mesa's rasterizer on a desktop.

use std::rc::Rc;

use image::RgbImage;
use yoro_gl::Context;
use yoro_render::stereo::stills;
use yoro_settings::Pipeline;
use yoro_settings::telemetry::Pictures;

/// The least PSNR against the stored picture, in dB. Two drivers that follow the specification differ in rounding and
/// texture filtering; a wrong eye, a wrong shift or a missing pass costs more than that.
const LEAST_DB: f64 = 30.0;

/// Returns a stored picture by its name.
macro_rules! stored {
    ($name:literal) => {
        include_bytes!(concat!("../../../tests/golden/prototype-", $name, ".png"))
    };
}

/// Renders the prototype scene with every pipeline and compares the pictures.
pub fn check(gl: &Rc<Context>) -> Vec<Pictures> {
    Pipeline::ALL.iter().map(|&pipeline| check_pipeline(gl, pipeline)).collect()
}

fn check_pipeline(gl: &Rc<Context>, pipeline: Pipeline) -> Pictures {
    let synthesized: &[u8] = match pipeline {
        Pipeline::Gather => stored!("gather"),
        Pipeline::Paper => stored!("paper"),
    };
    let [synthesized, rendered] = [synthesized, stored!("rendered")].map(decode);
    let scene = yoro_scenes::build("prototype", yoro_scenes::DEFAULT_SEED).map_err(|error| error.to_string());
    let both = scene.and_then(|scene| {
        stills(gl, scene, &[pipeline], rendered.width()).map_err(|error| error.to_string())
    });
    let (mut rendered_db, mut synthesized_db) = (None, None);
    match &both.as_deref() {
        Ok([[left, right], ..]) => {
            (rendered_db, synthesized_db) =
                (Some(decibels(right, &rendered)), Some(decibels(left, &synthesized)));
        }
        Ok(_) => {}
        Err(reason) => log::info!("no picture by {}: {reason}", pipeline.name()),
    }
    Pictures { pipeline: pipeline.name().into(), rendered_db, synthesized_db, least_db: LEAST_DB }
}

fn decode(png: &[u8]) -> RgbImage {
    image::load_from_memory(png).expect("the picture is a part of the program").into_rgb8()
}

/// Returns the PSNR over red, green and blue of a picture, RGBA with rows from the bottom; at most 99.99 dB.
fn decibels(rgba: &[u8], stored: &RgbImage) -> f64 {
    let rows = rgba.chunks_exact(4 * stored.width() as usize).rev();
    let pixels = rows.flat_map(|row| row.as_chunks::<4>().0);
    let squares: u64 = pixels
        .zip(stored.pixels())
        .map(|(own, stored)| {
            stored.0.iter().zip(own).map(|(a, b)| u64::from(a.abs_diff(*b)).pow(2)).sum::<u64>()
        })
        .sum();
    let mean = squares as f64 / f64::from(3 * stored.width() * stored.height());
    (10.0 * (255.0 * 255.0 / mean).log10()).min(99.99)
}

#[cfg(test)]
mod tests {
    use super::*;
    use yoro_context::{Backend, Headless};

    #[test]
    fn every_pipeline_passes_and_the_other_eye_does_not() {
        let headless = Headless::open(Backend::Egl).unwrap();
        for pictures in check(headless.gl()) {
            println!("{pictures}");
            assert!(pictures.passed(), "{pictures}");
        }
        // What a driver would show that gives both eyes the same picture.
        let [rendered, synthesized] = [&stored!("rendered")[..], stored!("gather")].map(decode);
        let rows: Vec<_> = rendered.rows().rev().collect();
        let rgba: Vec<u8> =
            rows.into_iter().flatten().flat_map(|pixel| [pixel.0[0], pixel.0[1], pixel.0[2], 255]).collect();
        let (same, itself) = (decibels(&rgba, &synthesized), decibels(&rgba, &rendered));
        assert!(same < LEAST_DB - 5.0 && itself > 99.0, "{same} {itself}");
        println!("the same image: {same:.2} dB");
    }
}
