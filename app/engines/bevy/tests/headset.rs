//! A session with an OpenXR runtime: compares both layers with the same eyes, rendered by a second stereo camera in the
//! same frames.
//!
//! It needs a runtime: `cargo xtask bevy test` starts Monado with a simulated headset.

#[path = "../examples/support/mod.rs"]
mod support;

use bevy::camera::{ManualTextureViewHandle, RenderTarget};
use bevy::log::LogPlugin;
use bevy::prelude::*;
use bevy::render::renderer::RenderDevice;
use bevy::render::texture::ManualTextureViews;
use bevy::render::{Render, RenderApp};
use bevy_mod_openxr::init::{OxrInitPlugin, should_run_frame_loop};
use bevy_mod_openxr::render::{OxrRenderPlugin, XR_TEXTURE_INDEX, insert_texture_views};
use bevy_mod_openxr::resources::{
    OxrCurrentSessionConfig, OxrFrameState, OxrSessionConfig, OxrSwapchainImages,
};
use bevy_mod_openxr::{add_xr_plugins, features::handtracking::HandTrackingPlugin};
use bevy_mod_xr::session::{XrRenderSystems, XrTrackingRoot};
use bevy_yoro::openxr::XrStereoCamera;
use bevy_yoro::yoro_wgpu::wgpu;
use bevy_yoro::{Eye, Foveation, StereoMode, YoroPlugin};
use image::RgbImage;
use support::{finish, psnr, read, rendered, room, windowless};

/// The number of frames that are shown: 25 in each mode with either eye rendered, and 25 foveated.
const FRAMES: u32 = 125;

/// Replaces the swapchain's textures, whose usage does not allow reading, by readable ones. The runtime shows its own
/// textures.
fn readable_layers(
    mut images: ResMut<OxrSwapchainImages>,
    config: Res<OxrCurrentSessionConfig>,
    device: Res<RenderDevice>,
    mut readable: Local<Option<&'static [wgpu::Texture]>>,
) {
    let texture = |_| {
        device.wgpu_device().create_texture(&wgpu::TextureDescriptor {
            label: Some("layers"),
            size: wgpu::Extent3d {
                width: config.resolution.x,
                height: config.resolution.y,
                depth_or_array_layers: 2,
            },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: config.format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT
                | wgpu::TextureUsages::COPY_DST
                | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        })
    };
    images.0 = readable.get_or_insert_with(|| images.iter().map(texture).collect::<Vec<_>>().leak());
}

/// Renders frames until one is to be shown.
fn shown(app: &mut App) {
    for _ in 0..1000 {
        app.update();
        if app.world().get_resource::<OxrFrameState>().is_some_and(|state| state.should_render) {
            return;
        }
    }
    panic!("the runtime shows nothing");
}

fn layer(app: &App, eye: usize) -> RgbImage {
    let views = app.sub_app(RenderApp).world().resource::<ManualTextureViews>();
    let view = views.get(&ManualTextureViewHandle(XR_TEXTURE_INDEX + eye as u32)).expect("a layer");
    read(app, view.texture_view.texture(), eye as u32)
}

#[test]
#[ignore = "needs an OpenXR runtime: `cargo xtask bevy test` starts Monado"]
fn both_layers_show_the_eyes() {
    let mut app = App::new();
    let plugins = add_xr_plugins(windowless())
        .set(OxrInitPlugin { synchronous_pipeline_compilation: true, ..default() })
        .set(OxrRenderPlugin { spawn_cameras: false, ..default() })
        .enable::<LogPlugin>()
        .disable::<HandTrackingPlugin>();
    let size = UVec2::new(320, 320);
    app.add_plugins((plugins, YoroPlugin))
        .insert_resource(OxrSessionConfig { resolutions: Some(vec![size]), ..default() })
        .add_systems(Startup, room)
        .add_systems(Update, |mut root: Single<&mut Transform, With<XrTrackingRoot>>| {
            **root = Transform::from_xyz(0.0, 0.2, 2.0);
        });
    app.sub_app_mut(RenderApp).add_systems(
        Render,
        readable_layers
            .run_if(should_run_frame_loop)
            .before(insert_texture_views)
            .in_set(XrRenderSystems::PreRender),
    );
    finish(&mut app);

    // A second camera renders the other eye in the same frames. The one with the higher order fills the layers.
    let world = app.world_mut();
    let truth = world
        .spawn((XrStereoCamera { mode: StereoMode::Rendered, dominant: Eye::Left, ..default() }, Msaa::Off))
        .id();
    let camera = world.spawn((XrStereoCamera::default(), Camera { order: 10, ..default() }, Msaa::Off)).id();
    for frame in 0..FRAMES {
        let (dominant, made) =
            if frame / 50 == 1 { (Eye::Left, Eye::Right) } else { (Eye::Right, Eye::Left) };
        let foveation = (frame >= 100).then_some(Foveation::MEDIUM);
        let mode = if frame % 50 < 25 { StereoMode::Opaque } else { StereoMode::Finished };
        if frame % 25 == 0 {
            let mut stereo = app.world_mut().get_mut::<XrStereoCamera>(camera).unwrap();
            (stereo.mode, stereo.dominant, stereo.foveation) = (mode, dominant, foveation);
            app.world_mut().get_mut::<XrStereoCamera>(truth).unwrap().dominant = made;
        }
        shown(&mut app);
        // The first frame of a mode, which must not flash, and the last one.
        if frame == 0 || !matches!(frame % 25, 0 | 24) {
            continue;
        }
        let image = |camera| {
            let RenderTarget::Image(image) = app.world().get::<RenderTarget>(camera).unwrap() else {
                panic!("the camera renders into an image");
            };
            rendered(&app, &image.handle)
        };
        let level = if image(camera).height() < size.y { "foveated" } else { "whole" };
        assert_eq!(level == "foveated", foveation.is_some(), "frame {frame} is {level}");
        let truth = image(truth);
        let layers = [0, 1].map(|eye| layer(&app, eye));
        let made = made as usize;
        let (value, same) = (psnr(&layers[made], &truth), psnr(&layers[1 - made], &truth));
        println!(
            "{mode:?}, {dominant:?} eye rendered, {level}: {value:.2} dB, the rendered eye in its place {same:.2} dB"
        );
        if let Some(folder) = std::env::var_os("OUT").map(std::path::PathBuf::from) {
            let name = |eye| folder.join(format!("{mode:?}-{dominant:?}-{level}-{eye}.png").to_lowercase());
            for (image, eye) in layers.iter().chain([&truth]).zip(["left", "right", "truth"]) {
                image.save(name(eye)).unwrap();
            }
        }
        assert!(value > 27.0 && value > same + 5.0, "{mode:?}, {dominant:?} eye rendered: {value:.2} dB");
    }
}
