//! Compares both modes with a second camera of Bevy's, on any device that wgpu finds.

mod auto;
mod holes;
mod levels;
#[path = "../../examples/support/mod.rs"]
mod support;

use bevy::anti_alias::taa::TemporalAntiAliasing;
use bevy::camera::visibility::RenderLayers;
use bevy::camera::{Exposure, Hdr};
use bevy::core_pipeline::tonemapping::DebandDither;
use bevy::pbr::{DistanceFog, FogFalloff, ScreenSpaceAmbientOcclusion};
use bevy::post_process::bloom::Bloom;
use bevy::prelude::*;
use bevy_yoro::{Eye, StereoCamera, StereoMode};
use image::RgbImage;
use support::{Glass, halves, into_image, picture, psnr, ssim, target, viewpoint};

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

    /// Compares the synthesized eye in both modes with the rendered one, requires at least these values in dB, and
    /// returns the values. The rendered eye must be the same with and without synthesis, and the synthesized eye must
    /// be closer to the truth than the rendered eye in its place. Pictures of all modes are written to the tests'
    /// folder.
    fn check(&mut self, what: &str, at_least: [f64; 2]) -> [f64; 2] {
        let truth = self.in_mode(StereoMode::Rendered);
        save(&truth, what, StereoMode::Rendered);
        let truth = halves(&truth);
        let (dominant, other) = match self.stereo().dominant {
            Eye::Left => (0, 1),
            Eye::Right => (1, 0),
        };
        let same = [psnr, ssim].map(|metric| metric(&truth[dominant], &truth[other]));
        let modes = [StereoMode::Opaque, StereoMode::Finished];
        let values = modes.map(|mode| {
            let made = self.in_mode(mode);
            save(&made, what, mode);
            let made = halves(&made);
            let kept = psnr(&made[dominant], &truth[dominant]);
            assert!(kept > 45.0, "{what}, {mode:?}: the rendered eye changed, {kept:.2} dB");
            [psnr, ssim].map(|metric| metric(&made[other], &truth[other]))
        });
        let text = |[psnr, ssim]: [f64; 2]| format!("{psnr:.2} / {ssim:.4}");
        let [opaque, finished] = values.map(text);
        println!(
            "{what}: Opaque {opaque}, Finished {finished}, the rendered eye in its place {}",
            text(same)
        );
        for ([psnr, ssim], least) in values.into_iter().zip(at_least) {
            assert!(psnr >= least, "{what}: {psnr:.2} dB, {least} expected");
            assert!(
                psnr > same[0] + 5.0 && ssim > same[1],
                "{what}: {psnr:.2} dB / {ssim:.4}, {same:.4?} for the rendered eye in its place"
            );
        }
        values.map(|[psnr, _]| psnr)
    }

    /// Checks that with temporal anti-aliasing the finished image is synthesized, and that both eyes are rendered in
    /// the mode for opaque surfaces.
    fn check_temporal_anti_aliasing(&mut self) {
        let settled = |stage: &mut Stage, mode| {
            stage.in_mode(mode);
            for _ in 0..3 {
                stage.picture();
            }
            let picture = stage.picture();
            save(&picture, "temporal", mode);
            halves(&picture)
        };
        let [left, right] = settled(self, StereoMode::Rendered);
        let rendered = settled(self, StereoMode::Opaque);
        let kept = psnr(&rendered[0], &left);
        assert!(kept > 40.0, "Opaque with temporal anti-aliasing does not render both eyes: {kept:.2} dB");
        let finished = settled(self, StereoMode::Finished);
        let [same, value] = [&right, &finished[0]].map(|eye| (psnr(eye, &left), ssim(eye, &left)));
        println!("temporal anti-aliasing: Finished {value:.4?}, the rendered eye in its place {same:.4?}");
        assert!(value.0 > same.0 + 5.0 && value.1 > same.1, "{value:.4?}, {same:.4?} for the rendered eye");
    }

    /// Runs `check` with a new camera that also has these components.
    fn with(&mut self, components: impl Bundle, check: impl FnOnce(&mut Stage)) {
        self.app.world_mut().despawn(self.camera);
        self.camera = spawn(&mut self.app, &self.image);
        // Occlusion is visible in ambient light only.
        let light = AmbientLight { brightness: 1500.0, ..default() };
        self.app.world_mut().entity_mut(self.camera).insert((light, components));
        check(self);
    }
}

/// Writes a picture of this mode to a file.
fn save(picture: &RgbImage, what: &str, mode: StereoMode) {
    let name = format!("{what} {mode:?}.png").to_lowercase().replace(' ', "-");
    picture.save(std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join(name)).unwrap();
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
    // Without glass, both modes show the same.
    let glass: Vec<Entity> =
        stage.app.world_mut().query_filtered::<Entity, With<Glass>>().iter(stage.app.world()).collect();
    for entity in glass {
        stage.app.world_mut().entity_mut(entity).despawn();
    }
    let [opaque, finished] = stage.check("opaque alone", [30.0, 30.0]);
    assert!((opaque - finished).abs() < 0.5, "{opaque:.2} and {finished:.2} dB");
    // Without a distance between the eyes, both show the same.
    stage.stereo().ipd = 0.0;
    for mode in [StereoMode::Opaque, StereoMode::Finished] {
        let [left, right] = halves(&stage.in_mode(mode));
        let value = psnr(&left, &right);
        assert!(value > 50.0, "{mode:?}: {value:.2} dB at a distance of 0");
    }
}

#[test]
fn hdr_and_samples_are_synthesized() {
    let mut stage = Stage::new();
    let camera = stage.camera;
    stage.app.world_mut().entity_mut(camera).insert((Hdr, Bloom::NATURAL));
    stage.check("Hdr and bloom", [32.0, 29.0]);
    // Changes of the camera also apply to the other eye.
    stage.in_mode(StereoMode::Opaque);
    stage.app.world_mut().entity_mut(camera).insert(Exposure { ev100: 8.5 });
    let made = stage.picture();
    let truth = stage.in_mode(StereoMode::Rendered);
    for (made, truth) in halves(&made).iter().zip(&halves(&truth)) {
        let value = psnr(made, truth);
        assert!(value > 30.0, "another exposure: {value:.2} dB");
    }
    stage.app.world_mut().entity_mut(camera).insert(Exposure::default());
    // MSAA.
    stage.app.world_mut().entity_mut(camera).remove::<(Hdr, Bloom)>().insert(Msaa::Sample4);
    stage.check("4 samples", [36.0, 31.0]);
    stage.app.world_mut().entity_mut(camera).insert(Hdr);
    stage.check("4 samples with Hdr", [32.0, 29.0]);
}

/// Tests the features of Bevy that the README's table lists.
#[test]
fn features_of_bevy_work_in_both_modes() {
    let mut stage = Stage::new();
    let mut plain = RgbImage::default();
    stage.with((), |stage| plain = stage.picture());
    stage.with(ScreenSpaceAmbientOcclusion::default(), |stage| {
        let change = psnr(&stage.picture(), &plain);
        assert!(change < 45.0, "no occlusion is seen: {change:.2} dB");
        stage.check("occlusion", [30.0, 28.0]);
    });
    let falloff = FogFalloff::Linear { start: 2.0, end: 9.0 };
    stage.with(DistanceFog { color: Color::srgb(0.6, 0.65, 0.7), falloff, ..default() }, |stage| {
        assert!(psnr(&stage.picture(), &plain) < 30.0, "no fog is seen");
        stage.check("fog", [30.0, 28.0]);
    });
    stage.with(TemporalAntiAliasing::default(), |stage| stage.check_temporal_anti_aliasing());
    // A cube that only cameras of layer 1 see.
    let mesh = stage.app.world_mut().resource_mut::<Assets<Mesh>>().add(Cuboid::from_length(0.4));
    let red = StandardMaterial::from_color(Color::srgb(0.9, 0.05, 0.05));
    let red = stage.app.world_mut().resource_mut::<Assets<StandardMaterial>>().add(red);
    let at = Transform::from_xyz(0.3, 1.5, 0.4);
    let cube =
        stage.app.world_mut().spawn((Mesh3d(mesh), MeshMaterial3d(red), at, RenderLayers::layer(1))).id();
    stage.with((), |stage| assert_eq!(stage.picture(), plain, "a camera of layer 0 does not see the cube"));
    stage.with(RenderLayers::from_layers(&[0, 1]), |stage| {
        for (eye, plain) in halves(&stage.picture()).iter().zip(&halves(&plain)) {
            assert!(psnr(eye, plain) < 40.0, "the cube is in both eyes");
        }
        stage.check("layers", [30.0, 28.0]);
    });
    stage.app.world_mut().despawn(cube);

    // Glass that shows what is behind it.
    let mut materials = stage.app.world_mut().resource_mut::<Assets<StandardMaterial>>();
    let clear = materials.add(StandardMaterial {
        base_color: Color::srgb(0.8, 0.95, 0.85),
        specular_transmission: 0.9,
        thickness: 0.2,
        ior: 1.3,
        perceptual_roughness: 0.1,
        ..default()
    });
    let mut glass =
        stage.app.world_mut().query_filtered::<&mut MeshMaterial3d<StandardMaterial>, With<Glass>>();
    let blended = glass.single(stage.app.world()).unwrap().clone();
    *glass.single_mut(stage.app.world_mut()).unwrap() = MeshMaterial3d(clear);
    stage.with((), |stage| {
        stage.check("transmission", [30.0, 27.0]);
    });
    *glass.single_mut(stage.app.world_mut()).unwrap() = blended;

    // Near and distant lines.
    stage.app.add_systems(Update, |mut gizmos: Gizmos| {
        gizmos.sphere(Isometry3d::from_translation(Vec3::new(0.2, 1.4, 0.8)), 0.3, Color::WHITE);
        gizmos.line(Vec3::new(-2.0, 0.2, -5.0), Vec3::new(2.0, 2.5, -5.0), Color::srgb(1.0, 1.0, 0.0));
    });
    stage.with((), |stage| {
        assert!(psnr(&stage.picture(), &plain) < 40.0, "no lines are seen");
        stage.check("gizmos", [30.0, 25.0]);
    });
}

#[test]
fn cameras_come_and_go_and_images_change_size() {
    let mut stage = Stage::new();
    let first = stage.picture();

    // Another size, then the first one again.
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
    // Other code removes the cameras that belong to it. They are created again, with new images.
    stage.app.world_mut().entity_mut(camera).despawn_children();
    stage.app.world_mut().entity_mut(camera).insert(DebandDither::Disabled);
    stage.app.update();
    stage.app.world_mut().entity_mut(camera).insert(DebandDither::Enabled);
    assert_eq!(stage.picture(), first);

    // A second stereo camera, which renders the other eye.
    let image = target(&mut stage.app, SIZE);
    let second = spawn(&mut stage.app, &image);
    stage.app.world_mut().get_mut::<StereoCamera>(second).unwrap().dominant = Eye::Left;
    let other = picture(&mut stage.app, &image);
    assert_eq!(stage.picture(), first);
    for (a, b) in halves(&other).iter().zip(&halves(&first)) {
        let value = psnr(a, b);
        assert!(value > 28.0, "either eye rendered: {value:.2} dB");
    }

    // The cameras that belong to a stereo camera are despawned with it, and new ones show the same.
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

    // Without the component it is a single camera again, for the whole image.
    let camera = stage.camera;
    stage.app.world_mut().entity_mut(camera).remove::<StereoCamera>();
    let single = stage.picture();
    assert_eq!(cameras(&mut stage.app), 1);
    let [left, right] = halves(&single);
    assert!(psnr(&left, &right) < 20.0, "one view fills the image");
}
