//! Foveation, against Bevy's own second camera with and without it.

use bevy::camera::{Hdr, RenderTarget};
use bevy::post_process::bloom::Bloom;
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

/// Foveation that has been chosen, or none.
const MEDIUM: Option<Foveation> = Some(Foveation::MEDIUM);

impl Stage {
    /// Returns both eyes in a mode.
    fn eyes(&mut self, what: &str, mode: StereoMode, foveation: Option<Foveation>) -> [RgbImage; 2] {
        self.stereo().foveation = foveation;
        let picture = self.in_mode(mode);
        let level = if foveation.is_some() { "foveated" } else { "whole" };
        crate::save(&picture, &format!("{what} {level}"), mode);
        halves(&picture)
    }

    /// Compares foveated eyes with rendered ones, whose right eye is rendered in any case: the fovea with all pixels, in
    /// which nothing may be lost, and the periphery with the same levels, which must be at least this many dB near.
    fn check_levels(&mut self, what: &str, modes: &[(StereoMode, f64)]) {
        let rendered = [None, MEDIUM].map(|foveation| self.eyes(what, StereoMode::Rendered, foveation));
        for &(mode, at_least) in modes {
            self.check_mode(what, &rendered, mode, at_least);
        }
    }

    fn check_mode(&mut self, what: &str, rendered: &[[RgbImage; 2]; 2], mode: StereoMode, at_least: f64) {
        let [truth, alike] = rendered;
        let [whole, foveated] = [None, MEDIUM].map(|foveation| self.eyes(what, mode, foveation));
        let [kept, _] = fovea_and_periphery(&foveated[1], &truth[1], Vec2::ZERO);
        let [without, _] = fovea_and_periphery(&whole[0], &truth[0], Vec2::ZERO);
        let [fovea, _] = fovea_and_periphery(&foveated[0], &truth[0], Vec2::ZERO);
        let [_, periphery] = fovea_and_periphery(&foveated[0], &alike[0], Vec2::ZERO);
        let [_, same] = fovea_and_periphery(&alike[1], &alike[0], Vec2::ZERO);
        println!(
            "{what}, {mode:?}: fovea {fovea:.2} dB, {without:.2} without levels, {kept:.2} of the rendered eye; \
             periphery {periphery:.2}, the rendered eye in its place {same:.2}"
        );
        assert!(kept > 45.0, "{what}, {mode:?}: the rendered eye's fovea changed, {kept:.2} dB");
        assert!(
            (fovea - without).abs() < 0.1,
            "{what}, {mode:?}: {fovea:.2} dB, {without:.2} without levels"
        );
        assert!(
            periphery > at_least && periphery > same + 5.0,
            "{what}, {mode:?}: {periphery:.2}, {same:.2} dB"
        );
    }
}

#[test]
fn the_fovea_has_all_pixels_and_the_periphery_is_that_of_two_renders() {
    let mut stage = Stage::new();
    stage.check_levels("levels", &[(StereoMode::Opaque, 30.5), (StereoMode::Finished, 28.0)]);
    let camera = stage.camera;
    stage.app.world_mut().entity_mut(camera).insert((Hdr, Msaa::Sample4));
    stage.check_levels("levels with Hdr and 4 samples", &[(StereoMode::Opaque, 31.0)]);
}

#[test]
fn the_gaze_moves_and_fewer_pixels_are_shaded() {
    let mut stage = Stage::new();
    let mut shaded = |mode, foveation, cameras: f64| {
        let eyes = stage.eyes("shaded", mode, foveation);
        let passes = ["main_opaque_pass_3d", "main_transparent_pass_3d"];
        (eyes, passes.map(|pass| cameras * shaded(&mut stage.app, pass)))
    };
    let (truth, [two, _]) = shaded(StereoMode::Rendered, None, 2.0);
    let (plain, [one, glass]) = shaded(StereoMode::Opaque, None, 1.0);
    let (foveated, [levels, foveated_glass]) = shaded(StereoMode::Opaque, MEDIUM, 2.0);
    println!(
        "fragments of opaque objects: {two}, one eye {one}, levels {levels}; glass {glass}, {foveated_glass}"
    );
    assert!(one < 0.55 * two && levels < 0.95 * one && levels > 0.5 * one, "{two}, {one}, {levels}");
    assert!(foveated != plain);

    // The left eye is rendered.
    stage.stereo().dominant = Eye::Left;
    let [kept, around] =
        fovea_and_periphery(&stage.eyes("left", StereoMode::Opaque, MEDIUM)[0], &truth[0], Vec2::ZERO);
    assert!(kept > 45.0 && around < 40.0, "left eye rendered: {kept:.2} dB, around it {around:.2}");
    stage.stereo().dominant = Eye::Right;

    // Nothing is created while the gaze moves.
    stage.stereo().gaze = Some(Dir3::NEG_Z);
    stage.picture();
    let objects = |stage: &Stage| {
        let world = stage.app.world();
        let RenderTarget::Image(source) = world.get::<RenderTarget>(stage.camera).unwrap() else { panic!() };
        (source.handle.id(), world.resource::<Assets<Image>>().len(), world.entities().count_spawned())
    };
    let before = objects(&stage);
    for gaze in [vec2(0.3, 0.1), vec2(-0.35, -0.2)] {
        stage.stereo().gaze = Some(Dir3::new(gaze.extend(-1.0)).unwrap());
        let eyes = stage.eyes("gaze", StereoMode::Opaque, MEDIUM);
        assert_eq!(objects(&stage), before);
        let [own, around] = fovea_and_periphery(&eyes[1], &truth[1], gaze);
        let [other, _] = fovea_and_periphery(&eyes[0], &truth[0], gaze);
        let [without, _] = fovea_and_periphery(&plain[0], &truth[0], gaze);
        println!(
            "gaze {gaze}: {own:.2} dB, around it {around:.2}; other eye {other:.2}, {without:.2} without levels"
        );
        assert!(own > 45.0 && around < 40.0, "{gaze}: {own:.2} dB, around it {around:.2}");
        assert!((other - without).abs() < 0.1, "{gaze}: {other:.2} dB, {without:.2} without levels");
    }
    // A tracker that has lost the eyes leaves the inset where it was.
    let before_loss = stage.picture();
    stage.stereo().gaze = None;
    assert!(stage.picture() == before_loss && objects(&stage) == before);

    // What cannot be foveated has all pixels.
    let impossible = Foveation { density: 2.0, ..Foveation::MEDIUM };
    assert!(stage.eyes("impossible", StereoMode::Opaque, Some(impossible)) == plain);
    let camera = stage.camera;
    stage.app.world_mut().entity_mut(camera).insert((Hdr, Bloom::NATURAL));
    let [whole, foveated] =
        [None, MEDIUM].map(|foveation| stage.eyes("bloom", StereoMode::Opaque, foveation));
    assert!(whole != plain && foveated == whole);
}
