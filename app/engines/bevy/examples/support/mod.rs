//! Shared by the examples and the tests: a room to look at, and an application without a window.
#![allow(dead_code)]

use bevy::app::{PluginGroupBuilder, PluginsState};
use bevy::camera::RenderTarget;
use bevy::diagnostic::{DiagnosticPath, DiagnosticsStore};
use bevy::log::LogPlugin;
use bevy::prelude::*;
use bevy::render::diagnostic::RenderDiagnosticsPlugin;
use bevy::render::pipelined_rendering::PipelinedRenderingPlugin;
use bevy::render::render_asset::RenderAssets;
use bevy::render::render_resource::{TextureFormat, TextureUsages};
use bevy::render::renderer::{RenderDevice, RenderQueue};
use bevy::render::settings::{InstanceFlags, RenderCreation, WgpuSettings};
use bevy::render::texture::GpuImage;
use bevy::render::{RenderApp, RenderPlugin};
use bevy::window::ExitCondition;
use bevy::winit::WinitPlugin;
use bevy_yoro::YoroPlugin;
use bevy_yoro::yoro_wgpu::wgpu;
use image::RgbImage;

/// Marks the glass in the room.
#[derive(Component)]
pub struct Glass;

/// Returns the camera's transform in the room.
pub fn viewpoint() -> Transform {
    Transform::from_xyz(0.0, 1.6, 2.4).looking_at(Vec3::new(0.0, 1.2, -3.0), Vec3::Y)
}

/// Spawns a room with a chequered floor, a striped wall, columns with balls on them, a lamp and a pane of glass.
pub fn room(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let mut matte = |color: Srgba| {
        materials.add(StandardMaterial { base_color: color.into(), perceptual_roughness: 0.9, ..default() })
    };
    let stone = [matte(Srgba::rgb(0.72, 0.69, 0.62)), matte(Srgba::rgb(0.30, 0.36, 0.44))];
    let paint = [matte(Srgba::rgb(0.70, 0.28, 0.22)), matte(Srgba::rgb(0.85, 0.80, 0.68))];
    let accents = [
        matte(Srgba::rgb(0.20, 0.55, 0.45)),
        matte(Srgba::rgb(0.85, 0.60, 0.15)),
        matte(Srgba::rgb(0.45, 0.30, 0.65)),
    ];
    let tile = meshes.add(Cuboid::new(0.6, 0.1, 0.6));
    for x in -7..7i32 {
        for z in -12..5i32 {
            let at = Transform::from_xyz(0.6 * x as f32 + 0.3, -0.05, 0.6 * z as f32);
            let material = stone[(x + z).rem_euclid(2) as usize].clone();
            commands.spawn((Mesh3d(tile.clone()), MeshMaterial3d(material), at));
        }
    }
    let stripe = meshes.add(Cuboid::new(0.35, 4.0, 0.1));
    for i in -12..12i32 {
        let at = Transform::from_xyz(0.35 * i as f32 + 0.175, 2.0, -7.0);
        let material = paint[i.rem_euclid(2) as usize].clone();
        commands.spawn((Mesh3d(stripe.clone()), MeshMaterial3d(material), at));
    }
    let column = meshes.add(Cylinder::new(0.16, 1.0));
    let ball = meshes.add(Sphere::new(0.24).mesh().uv(48, 24));
    for i in 0..9 {
        let (x, z) = (0.95 * ((i * 4) % 9) as f32 - 3.8, 0.7 - 0.75 * i as f32);
        commands.spawn((
            Mesh3d(column.clone()),
            MeshMaterial3d(stone[i % 2].clone()),
            Transform::from_xyz(x, 0.5, z),
        ));
        commands.spawn((
            Mesh3d(ball.clone()),
            MeshMaterial3d(accents[i % 3].clone()),
            Transform::from_xyz(x, 1.24, z),
        ));
    }
    let glow = StandardMaterial { emissive: LinearRgba::rgb(12.0, 9.0, 5.0), ..default() };
    commands.spawn((
        Mesh3d(meshes.add(Sphere::new(0.12))),
        MeshMaterial3d(materials.add(glow)),
        Transform::from_xyz(0.9, 2.1, -1.2),
    ));
    let glass = StandardMaterial {
        base_color: Color::srgba(0.25, 0.55, 0.85, 0.35),
        alpha_mode: AlphaMode::Blend,
        ..default()
    };
    commands.spawn((
        Glass,
        Mesh3d(meshes.add(Cuboid::new(0.5, 0.7, 0.02))),
        MeshMaterial3d(materials.add(glass)),
        Transform::from_xyz(-0.45, 1.35, 1.1).with_rotation(Quat::from_rotation_y(0.4)),
    ));
    commands.spawn((
        DirectionalLight { illuminance: 6000.0, ..default() },
        Transform::from_xyz(1.5, 4.0, 3.0).looking_at(Vec3::new(0.0, 1.0, -2.0), Vec3::Y),
    ));
    commands.spawn((PointLight::default(), Transform::from_xyz(-1.5, 3.0, 1.5)));
}

/// Returns a Bevy application without a window. Each `update` renders one frame, with all of its pipelines compiled.
pub fn headless() -> App {
    let mut app = App::new();
    let rendering = RenderPlugin {
        render_creation: RenderCreation::Automatic(Box::new(WgpuSettings {
            instance_flags: InstanceFlags::empty(),
            ..default()
        })),
        synchronous_pipeline_compilation: true,
        ..default()
    };
    app.add_plugins((windowless().set(rendering), RenderDiagnosticsPlugin, YoroPlugin))
        .add_systems(Startup, room);
    finish(&mut app);
    app
}

/// Returns Bevy's plugins without those for windows and for pipelined rendering.
pub fn windowless() -> PluginGroupBuilder {
    DefaultPlugins
        .set(WindowPlugin { primary_window: None, exit_condition: ExitCondition::DontExit, ..default() })
        .disable::<PipelinedRenderingPlugin>()
        .disable::<WinitPlugin>()
        .disable::<LogPlugin>()
}

/// Waits for the device, as an event loop does.
pub fn finish(app: &mut App) {
    while app.plugins_state() == PluginsState::Adding {
        bevy::tasks::tick_global_task_pools_on_main_thread();
    }
    app.finish();
    app.cleanup();
}

/// Returns an image of this size in pixels that cameras can render to, and that can be read back.
pub fn target(app: &mut App, size: [u32; 2]) -> Handle<Image> {
    let mut image = Image::new_target_texture(size[0], size[1], TextureFormat::Rgba8UnormSrgb, None);
    image.texture_descriptor.usage |= TextureUsages::COPY_SRC;
    app.world_mut().resource_mut::<Assets<Image>>().add(image)
}

/// Renders four frames, after which everything has arrived, and returns the contents of the image.
pub fn picture(app: &mut App, image: &Handle<Image>) -> RgbImage {
    for _ in 0..4 {
        app.update();
    }
    rendered(app, image)
}

/// Returns the fragments that Bevy shades in a pass, on average over the views that have the pass in some frames.
pub fn shaded(app: &mut App, pass: &str) -> f64 {
    let path = DiagnosticPath::from_components(["render", pass, "fragment_shader_invocations"]);
    let mut store = app.world_mut().resource_mut::<DiagnosticsStore>();
    store.get_mut(&path).into_iter().for_each(|diagnostic| diagnostic.clear_history());
    for _ in 0..6 {
        app.update();
    }
    let store = app.world().resource::<DiagnosticsStore>();
    store.get(&path).and_then(|diagnostic| diagnostic.average()).expect("the device counts fragments")
}

/// Returns the contents of an image after the last frame.
pub fn rendered(app: &App, image: &Handle<Image>) -> RgbImage {
    let images = app.sub_app(RenderApp).world().resource::<RenderAssets<GpuImage>>();
    read(app, &images.get(image).expect("the image is on the device").texture, 0)
}

/// Returns one layer of a texture of 4 bytes per pixel, red first.
pub fn read(app: &App, texture: &wgpu::Texture, layer: u32) -> RgbImage {
    let world = app.sub_app(RenderApp).world();
    let (device, queue) = (world.resource::<RenderDevice>().wgpu_device(), world.resource::<RenderQueue>());
    let (width, height) = (texture.width(), texture.height());
    let pitch = (4 * width).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: u64::from(pitch * height),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut encoder = device.create_command_encoder(&default());
    let from = wgpu::TexelCopyTextureInfo {
        texture,
        mip_level: 0,
        origin: wgpu::Origin3d { x: 0, y: 0, z: layer },
        aspect: wgpu::TextureAspect::All,
    };
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(pitch), rows_per_image: None };
    let to = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
    encoder.copy_texture_to_buffer(from, to, wgpu::Extent3d { width, height, depth_or_array_layers: 1 });
    queue.submit([encoder.finish()]);
    buffer.slice(..).map_async(wgpu::MapMode::Read, |mapped| mapped.expect("the buffer can be read"));
    device.poll(wgpu::PollType::wait_indefinitely()).expect("the device finishes");
    let data = buffer.slice(..).get_mapped_range();
    RgbImage::from_fn(width, height, |x, y| {
        let i = (y * pitch + 4 * x) as usize;
        image::Rgb([data[i], data[i + 1], data[i + 2]])
    })
}

/// Returns the left and the right half of a picture.
pub fn halves(both: &RgbImage) -> [RgbImage; 2] {
    let (width, height) = (both.width() / 2, both.height());
    [0, width].map(|x| image::imageops::crop_imm(both, x, 0, width, height).to_image())
}

/// Returns the peak signal-to-noise ratio in dB.
pub fn psnr(image: &RgbImage, truth: &RgbImage) -> f64 {
    let squares = image.iter().zip(truth.iter()).map(|(a, b)| f64::from(a.abs_diff(*b)).powi(2));
    10.0 * (255f64.powi(2) * truth.len() as f64 / squares.sum::<f64>()).log10()
}

/// Returns the structural similarity (SSIM) of the greyscale images.
pub fn ssim(image: &RgbImage, truth: &RgbImage) -> f64 {
    let [image, truth] = [image, truth].map(image::imageops::grayscale);
    let algorithm = image_compare::Algorithm::MSSIMSimple;
    image_compare::gray_similarity_structure(&algorithm, &image, &truth).expect("pictures of one size").score
}

/// Returns the render target for an image.
pub fn into_image(image: &Handle<Image>) -> RenderTarget {
    RenderTarget::Image(image.clone().into())
}
