//! Both modes against Bevy's own second camera, on whatever device wgpu finds.

#[path = "../examples/support/mod.rs"]
mod support;

use bevy::camera::{Exposure, Hdr};
use bevy::core_pipeline::tonemapping::DebandDither;
use bevy::post_process::bloom::Bloom;
use bevy::prelude::*;
use bevy_yoro::{Eye, StereoCamera, StereoMode};
use image::RgbImage;
use support::{Glass, halves, into_image, picture, psnr, target, viewpoint};

const SIZE: [u32; 2] = [640, 320];

/// A stereo camera in the room, and the image that it renders to.
struct Stage {
    app: App,
    image: Handle<Image>,
    camera: Entity,
}

impl Stage {
    fn new() -> Stage {
        let mut app = support::headless();
        let image = target(&mut app, SIZE);
        let camera = spawn(&mut app, &image);
        Stage { app, image, camera }
    }

    fn stereo(&mut self) -> Mut<'_, StereoCamera> {
        self.app.world_mut().get_mut(self.camera).unwrap()
    }

    fn picture(&mut self) -> RgbImage {
        picture(&mut self.app, &self.image)
    }

    /// Returns the picture in a mode.
    fn in_mode(&mut self, mode: StereoMode) -> RgbImage {
        self.stereo().mode = mode;
        self.picture()
    }

    /// Checks the synthesized eye in both modes against the rendered one, by at least these values in dB, and returns the
    /// values. The rendered eye must be the same with and without synthesis, and the other one nearer to the truth than the
    /// rendered one in its place.
    fn check(&mut self, what: &str, at_least: [f64; 2]) -> [f64; 2] {
        let truth = halves(&self.in_mode(StereoMode::Rendered));
        let (dominant, other) = match self.stereo().dominant {
            Eye::Left => (0, 1),
            Eye::Right => (1, 0),
        };
        let same = psnr(&truth[dominant], &truth[other]);
        let modes = [StereoMode::Opaque, StereoMode::Finished];
        let values = modes.map(|mode| {
            let made = halves(&self.in_mode(mode));
            let kept = psnr(&made[dominant], &truth[dominant]);
            assert!(kept > 45.0, "{what}, {mode:?}: the rendered eye changed, {kept:.2} dB");
            psnr(&made[other], &truth[other])
        });
        println!("{what}: {values:.2?} dB, the rendered eye in its place {same:.2} dB");
        for (value, least) in values.into_iter().zip(at_least) {
            assert!(value >= least, "{what}: {value:.2} dB, {least} expected");
            assert!(
                value > same + 5.0,
                "{what}: {value:.2} dB, {same:.2} dB for the rendered eye in its place"
            );
        }
        values
    }
}

fn spawn(app: &mut App, image: &Handle<Image>) -> Entity {
    let stereo = StereoCamera { fov_y: 75f32.to_radians(), ..default() };
    app.world_mut().spawn((Camera3d::default(), into_image(image), viewpoint(), Msaa::Off, stereo)).id()
}

#[test]
fn the_other_eye_is_near_to_the_rendered_one() {
    let mut stage = Stage::new();
    stage.check("glass", [30.5, 28.0]);
    stage.stereo().dominant = Eye::Left;
    stage.check("left eye rendered", [30.5, 28.0]);
    // Without glass both modes see the same.
    let glass: Vec<Entity> =
        stage.app.world_mut().query_filtered::<Entity, With<Glass>>().iter(stage.app.world()).collect();
    for entity in glass {
        stage.app.world_mut().entity_mut(entity).despawn();
    }
    let [opaque, finished] = stage.check("opaque alone", [30.0, 30.0]);
    assert!((opaque - finished).abs() < 0.5, "{opaque:.2} and {finished:.2} dB");
    // Without a distance between the eyes both see the same.
    stage.stereo().ipd = 0.0;
    for mode in [StereoMode::Opaque, StereoMode::Finished] {
        let [left, right] = halves(&stage.in_mode(mode));
        let value = psnr(&left, &right);
        assert!(value > 50.0, "{mode:?}: {value:.2} dB at a distance of 0");
    }
}

#[test]
fn hdr_and_samples_are_synthesized_where_they_can_be() {
    let mut stage = Stage::new();
    let camera = stage.camera;
    stage.app.world_mut().entity_mut(camera).insert((Hdr, Bloom::NATURAL));
    stage.check("Hdr and bloom", [32.0, 29.0]);
    // What changes on the camera changes for the other eye.
    stage.in_mode(StereoMode::Opaque);
    stage.app.world_mut().entity_mut(camera).insert(Exposure { ev100: 8.5 });
    let made = stage.picture();
    let truth = stage.in_mode(StereoMode::Rendered);
    for (made, truth) in halves(&made).iter().zip(&halves(&truth)) {
        let value = psnr(made, truth);
        assert!(value > 30.0, "another exposure: {value:.2} dB");
    }
    stage.app.world_mut().entity_mut(camera).insert(Exposure::default());
    // Samples.
    stage.app.world_mut().entity_mut(camera).remove::<(Hdr, Bloom)>().insert(Msaa::Sample4);
    stage.check("4 samples", [37.5, 31.0]);
    // Both eyes are rendered.
    stage.app.world_mut().entity_mut(camera).insert(Hdr);
    let truth = stage.in_mode(StereoMode::Rendered);
    let value = psnr(&stage.in_mode(StereoMode::Opaque), &truth);
    assert!(value > 60.0, "4 samples with Hdr are not rendered twice: {value:.2} dB");
}

#[test]
fn cameras_come_and_go_and_images_change_size() {
    let mut stage = Stage::new();
    let first = stage.picture();

    // Another size, then the first again.
    let (own, larger) = (stage.image.clone(), target(&mut stage.app, [800, 300]));
    for image in [&larger, &own] {
        stage.image = image.clone();
        let camera = stage.camera;
        stage.app.world_mut().entity_mut(camera).insert(into_image(image));
        let [left, right] = halves(&stage.picture());
        assert!(psnr(&left, &right) > 15.0, "both halves show the room");
    }
    assert_eq!(stage.picture(), first);
    // Another image of the same size; then another order and background for all cameras.
    let same = target(&mut stage.app, SIZE);
    stage.image = same.clone();
    let camera = stage.camera;
    stage.app.world_mut().entity_mut(camera).insert(into_image(&same));
    assert_eq!(stage.picture(), first);
    let set = |stage: &mut Stage, order, clear_color| {
        let mut camera = stage.app.world_mut().get_mut::<Camera>(camera).unwrap();
        (camera.order, camera.clear_color) = (order, clear_color);
    };
    stage.in_mode(StereoMode::Rendered);
    set(&mut stage, 7, Color::srgb(1.0, 0.0, 0.0).into());
    let [left, right] = halves(&stage.picture());
    for eye in [left, right] {
        let image::Rgb([r, g, _]) = *eye.get_pixel(5, 5);
        assert!(r > 200 && g < 50, "the background is red: {r}, {g}");
    }
    stage.stereo().mode = StereoMode::Opaque;
    set(&mut stage, 0, default());
    assert_eq!(stage.picture(), first);
    // Somebody removes the cameras beside it, whose images are then made anew.
    stage.app.world_mut().entity_mut(camera).despawn_children();
    stage.app.world_mut().entity_mut(camera).insert(DebandDither::Disabled);
    stage.app.update();
    stage.app.world_mut().entity_mut(camera).insert(DebandDither::Enabled);
    assert_eq!(stage.picture(), first);

    // A second stereo camera beside it, with the other eye rendered.
    let image = target(&mut stage.app, SIZE);
    let second = spawn(&mut stage.app, &image);
    stage.app.world_mut().get_mut::<StereoCamera>(second).unwrap().dominant = Eye::Left;
    let other = picture(&mut stage.app, &image);
    assert_eq!(stage.picture(), first);
    for (a, b) in halves(&other).iter().zip(&halves(&first)) {
        let value = psnr(a, b);
        assert!(value > 28.0, "either eye rendered: {value:.2} dB");
    }

    // The cameras beside a stereo camera go with it, and a new one shows the same.
    let cameras = |app: &mut App| app.world_mut().query::<&Camera>().iter(app.world()).count();
    let before = cameras(&mut stage.app);
    stage.app.world_mut().despawn(second);
    stage.app.update();
    assert_eq!(cameras(&mut stage.app), before - 3);
    let camera = stage.camera;
    stage.app.world_mut().despawn(camera);
    stage.app.update();
    assert_eq!(cameras(&mut stage.app), 0);
    let image = stage.image.clone();
    stage.camera = spawn(&mut stage.app, &image);
    assert_eq!(stage.picture(), first);

    // Without the component it is one camera again, for the whole image.
    let camera = stage.camera;
    stage.app.world_mut().entity_mut(camera).remove::<StereoCamera>();
    let single = stage.picture();
    assert_eq!(cameras(&mut stage.app), 1);
    let [left, right] = halves(&single);
    assert!(psnr(&left, &right) < 20.0, "one view fills the image");
}
