//! Foveation, against Bevy's own second camera with and without it.

use bevy::camera::{Hdr, RenderTarget};
use bevy::post_process::bloom::Bloom;
use bevy::post_process::effect_stack::Vignette;
use bevy::prelude::*;
use bevy_yoro::{Foveation, StereoMode};
use image::RgbImage;

use crate::support::{halves, psnr, shaded};
use crate::{Eye, SIZE, Stage};

/// The tangent of half of the eyes' field of view.
fn half() -> f32 {
    37.5f32.to_radians().tan()
}

/// Returns the PSNR in dB of the pixels within 20 degrees of a gaze, given as tangents, and of all others.
fn fovea_and_periphery(image: &RgbImage, truth: &RgbImage, gaze: Vec2) -> [f64; 2] {
    let half = half();
    let at = |x: u32, y: u32| {
        let place = vec2(x as f32 + 0.5, y as f32 + 0.5) / SIZE[1] as f32 * 2.0 - 1.0;
        place * vec2(half, -half)
    };
    let is_near = |x, y| at(x, y).distance(gaze) < 20f32.to_radians().tan() - 2.0 * half / SIZE[1] as f32;
    [true, false].map(|near| {
        let [image, truth] = [image, truth].map(|image| {
            let part = image.enumerate_pixels().filter(|(x, y, _)| is_near(*x, *y) == near);
            let bytes: Vec<u8> = part.flat_map(|(_, _, pixel)| pixel.0).collect();
            RgbImage::from_raw(bytes.len() as u32 / 3, 1, bytes).unwrap()
        });
        psnr(&image, &truth)
    })
}

impl Stage {
    /// Returns both eyes in a mode.
    fn eyes(&mut self, mode: StereoMode, foveation: Option<Foveation>) -> [RgbImage; 2] {
        self.stereo().foveation = foveation;
        let picture = self.in_mode(mode);
        let level = if foveation.is_some() { "foveated" } else { "whole" };
        crate::save(&picture, &format!("levels {level}"), mode);
        halves(&picture)
    }

    /// Compares foveated eyes with rendered ones: the fovea with all pixels, the periphery with the same levels.
    fn check_levels(&mut self, what: &str, periphery: f64) {
        let medium = Some(Foveation::MEDIUM);
        let truth = self.eyes(StereoMode::Rendered, None);
        let alike = self.eyes(StereoMode::Rendered, medium);
        let (other, dominant) = (0, 1);
        for mode in [StereoMode::Opaque, StereoMode::Finished] {
            let [whole, foveated] = [None, medium].map(|foveation| self.eyes(mode, foveation));
            let [own, _] = fovea_and_periphery(&foveated[dominant], &truth[dominant], Vec2::ZERO);
            let [without, _] = fovea_and_periphery(&whole[other], &truth[other], Vec2::ZERO);
            let [with, _] = fovea_and_periphery(&foveated[other], &truth[other], Vec2::ZERO);
            let [_, around] = fovea_and_periphery(&foveated[other], &alike[other], Vec2::ZERO);
            let [_, like_truth] = fovea_and_periphery(&foveated[other], &truth[other], Vec2::ZERO);
            let [_, rendered] = fovea_and_periphery(&alike[other], &truth[other], Vec2::ZERO);
            println!(
                "{what}, {mode:?}: fovea {with:.2} dB, without levels {without:.2}, of the rendered eye {own:.2}; \
                 periphery {around:.2} of two renders' with levels ({like_truth:.2}, theirs {rendered:.2} of the truth)"
            );
        }
    }
}

#[test]
fn the_fovea_has_all_pixels_and_the_periphery_is_that_of_two_renders() {
    let mut stage = Stage::new();
    stage.check_levels("room", 30.0);
    stage.stereo().dominant = Eye::Left;
    let [whole, foveated] = [None, Some(Foveation::HIGH)].map(|foveation| {
        let eyes = stage.eyes(StereoMode::Opaque, foveation);
        fovea_and_periphery(&eyes[0], &eyes[0], Vec2::ZERO);
        eyes
    });
    let [kept, _] = fovea_and_periphery(&foveated[0], &whole[0], Vec2::ZERO);
    assert!(kept > 45.0, "left eye rendered: {kept:.2} dB");
    stage.stereo().dominant = Eye::Right;
    let camera = stage.camera;
    stage.app.world_mut().entity_mut(camera).insert(Msaa::Sample4);
    stage.check_levels("4 samples", 30.0);
    stage.app.world_mut().entity_mut(camera).insert((Hdr, Bloom::NATURAL, Msaa::Off));
    stage.check_levels("bloom", 30.0);
}

#[test]
fn the_gaze_moves_and_nothing_is_created() {
    let mut stage = Stage::new();
    let truth = stage.eyes(StereoMode::Rendered, None);
    stage.stereo().gaze = Some(Dir3::NEG_Z);
    let _ = stage.eyes(StereoMode::Opaque, Some(Foveation::MEDIUM));
    let images = |stage: &Stage| {
        let world = stage.app.world();
        let RenderTarget::Image(source) = world.get::<RenderTarget>(stage.camera).unwrap() else { panic!() };
        (source.handle.id(), world.resource::<Assets<Image>>().len(), world.entities().count_spawned())
    };
    let before = images(&stage);
    for gaze in [vec2(0.3, 0.1), vec2(-0.35, -0.2), vec2(0.0, 0.37)] {
        stage.stereo().gaze = Some(Dir3::new(gaze.extend(-1.0)).unwrap());
        let eyes = stage.eyes(StereoMode::Opaque, Some(Foveation::MEDIUM));
        assert_eq!(images(&stage), before);
        let [own, around] = fovea_and_periphery(&eyes[1], &truth[1], gaze);
        let [other, _] = fovea_and_periphery(&eyes[0], &truth[0], gaze);
        println!("gaze {gaze}: {own:.2} dB, around it {around:.2}, other eye {other:.2}");
        assert!(own > 45.0 && around < 40.0, "{gaze}: {own:.2} dB, around it {around:.2}");
    }
}

#[test]
fn fewer_pixels_are_shaded() {
    let mut stage = Stage::new();
    let mut shaded = |mode, foveation, cameras: f64| {
        stage.eyes(mode, foveation);
        let passes = ["main_opaque_pass_3d", "main_transparent_pass_3d"];
        passes.map(|pass| cameras * shaded(&mut stage.app, pass))
    };
    let two = shaded(StereoMode::Rendered, None, 2.0);
    let one = shaded(StereoMode::Opaque, None, 1.0);
    let levels = shaded(StereoMode::Opaque, Some(Foveation::MEDIUM), 2.0);
    println!("two {two:?}, one {one:?}, levels {levels:?}");
}

#[test]
fn effects_of_whole_images_prevent_levels() {
    let mut stage = Stage::new();
    let plain = stage.eyes(StereoMode::Opaque, None);
    let foveated = stage.eyes(StereoMode::Opaque, Some(Foveation::MEDIUM));
    let impossible = Foveation { density: 2.0, ..Foveation::MEDIUM };
    assert!(stage.eyes(StereoMode::Opaque, Some(impossible)) == plain);
    assert!(foveated != plain);
    let camera = stage.camera;
    stage.app.world_mut().entity_mut(camera).insert(Vignette::default());
    let [whole, foveated] =
        [None, Some(Foveation::MEDIUM)].map(|foveation| stage.eyes(StereoMode::Opaque, foveation));
    assert!(whole != plain && foveated == whole);
    stage.app.world_mut().entity_mut(camera).remove::<Vignette>();
    assert!(stage.eyes(StereoMode::Opaque, None) == plain);
}
