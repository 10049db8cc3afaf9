//! Tests of the renderer on a small scene.

use std::rc::Rc;

use glam::Vec3;

use super::*;
use crate::fixture::quad;
use bloom::{first_renderable, hdr_format};
use renderer::Outlines;
use yoro::eyes::{DepthConvention, DepthRange, Eye, EyePair, Frustum, Pose, View};
use yoro_assets::{Alpha, Material, Model, PointLight, Scene, ShadingStyle, Sky, TextureImage, Viewpoint};
use yoro_context::{Backend, Headless};
use yoro_gl::{Context, Format};

const SIZE: [u32; 2] = [144, 112];

pub fn open() -> Headless {
    Headless::open(Backend::Egl).unwrap()
}

fn cube(model: &mut Model, material: usize, center: Vec3, half: f32) {
    let axes = [Vec3::X, Vec3::Y, Vec3::Z];
    for i in 0..3 {
        let (n, a, b) = (axes[i], axes[(i + 1) % 3], axes[(i + 2) % 3]);
        for (n, a, b) in [(n, a, b), (-n, b, a)] {
            quad(model, material, center + (n - a - b) * half, a * 2.0 * half, b * 2.0 * half);
        }
    }
}

pub fn picture(size: u32, srgb: bool, texel: impl Fn(u32, u32) -> [u8; 4]) -> TextureImage {
    let rgba = (0..size * size).flat_map(|i| texel(i % size, i / size)).collect();
    TextureImage { name: format!("picture {size} {srgb}"), size: [size; 2], rgba, srgb, nearest: false }
}

/// A floor, cubes from one to twelve metres away, a row of fences, and something that glows.
pub fn scene(style: ShadingStyle) -> Scene {
    let mut model = Model {
        textures: vec![
            picture(8, true, |x, y| [if (x + y) % 2 == 0 { 220 } else { 90 }, 140, 120, 255]),
            picture(16, true, |x, _| [40, 150, 60, if x % 4 < 2 { 255 } else { 0 }]),
            picture(8, false, |x, _| [if x % 2 == 0 { 90 } else { 166 }, 128, 240, 255]),
        ],
        ..Model::default()
    };
    let plain = Material::default();
    model.materials = vec![
        Material { diffuse_map: Some(0), diffuse: Vec3::ONE, ..plain.clone() },
        Material { name: "red".into(), diffuse: Vec3::new(0.8, 0.2, 0.15), ..plain.clone() },
        Material {
            name: "fence".into(),
            diffuse_map: Some(1),
            alpha: Alpha::Cutout(0.5),
            double_sided: true,
            ..plain.clone()
        },
        Material { name: "relief".into(), normal_map: Some(2), roughness: 0.3, ..plain.clone() },
        Material { name: "lamp".into(), emissive: Vec3::new(3.0, 2.0, 1.0), ..plain.clone() },
        Material { name: "glass".into(), alpha: Alpha::Blend(0.4), ..plain },
    ];
    quad(&mut model, 0, Vec3::new(-10.0, 0.0, 10.0), Vec3::X * 20.0, Vec3::NEG_Z * 40.0);
    cube(&mut model, 1, Vec3::new(-0.5, 0.4, -1.6), 0.3);
    cube(&mut model, 3, Vec3::new(0.9, 0.7, -3.0), 0.6);
    cube(&mut model, 1, Vec3::new(-2.0, 1.0, -7.0), 1.0);
    cube(&mut model, 4, Vec3::new(2.5, 2.4, -9.0), 0.4);
    quad(&mut model, 2, Vec3::new(-3.0, 0.0, -5.0), Vec3::X * 6.0, Vec3::Y * 1.2);
    Scene {
        name: "test".into(),
        model,
        style,
        sky: Sky::default(),
        lights: (0..5)
            .map(|i| PointLight {
                position: Vec3::new(i as f32 - 2.0, 1.5, -2.0 * i as f32),
                color: Vec3::new(1.0, 0.7, 0.4),
                range: 4.0,
            })
            .collect(),
        viewpoints: vec![Viewpoint { position: EYE, target: TARGET }],
        ..Scene::default()
    }
}

const EYE: Vec3 = Vec3::new(0.1, 1.3, 0.6);
const TARGET: Vec3 = Vec3::new(0.0, 0.8, -4.0);

pub fn view(convention: DepthConvention) -> View {
    View {
        pose: Pose::look_at(EYE, TARGET),
        frustum: Frustum::symmetric(1.1, SIZE[0] as f32 / SIZE[1] as f32),
        depth: DepthRange { near: 0.2, far: 500.0, convention },
        size: SIZE,
    }
}

/// The shadow map is small because tests run on CPU rasterizers.
pub fn settings() -> RenderSettings {
    RenderSettings { shadow_map_size: 512, ..RenderSettings::default() }
}

pub struct Rig {
    pub scene: GpuScene,
    pub renderer: Renderer,
    pub targets: ViewTargets,
}

impl Rig {
    pub fn new(gl: &Rc<Context>, scene: Scene, settings: &RenderSettings) -> Rig {
        let scene = GpuScene::upload(gl, scene).unwrap();
        let renderer = Renderer::new(gl, settings, &scene).unwrap();
        Rig { scene, renderer, targets: ViewTargets::default() }
    }

    pub fn draw(&mut self, view: &View) -> RenderedView<'_> {
        self.renderer.render(&mut self.targets, &self.scene, view).unwrap()
    }

    pub fn render(&mut self, view: &View) -> Vec<u8> {
        self.draw(view).color.read_rgba8(0, [0, 0], view.size)
    }
}

/// Returns the window depth of each pixel.
pub fn depths(gl: &Rc<Context>, depth: &DepthImage, view: &View) -> Vec<f32> {
    let mut reader = DepthReader::new(gl).unwrap();
    reader.copy(depth, view.size).unwrap();
    reader.read()
}

fn largest_difference(a: &[u8], b: &[u8]) -> u8 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(a, b)| a.abs_diff(*b)).max().unwrap()
}

fn mean(pixels: &[u8], channel: usize) -> f32 {
    pixels.iter().skip(channel).step_by(4).map(|&v| v as f32).sum::<f32>() / (pixels.len() / 4) as f32
}

#[test]
fn every_style_renders_its_own_picture() {
    let head = open();
    let gl = head.gl();
    let mut pictures: Vec<Vec<u8>> = Vec::new();
    for style in ShadingStyle::ALL {
        let mut rig = Rig::new(gl, scene(style), &settings());
        let picture = rig.render(&view(DepthConvention::Standard));
        assert_eq!(gl.take_errors(), None, "{style:?}");
        for channel in 0..3 {
            let mean = mean(&picture, channel);
            assert!((50.0..210.0).contains(&mean), "{style:?}: channel {channel} has mean {mean}");
        }
        pictures.push(picture);
    }
    // Low poly and voxel have the same shading. In both, this scene of flat faces looks as in the realistic style.
    for (i, j) in [(0, 1), (0, 4), (1, 4)] {
        assert!(largest_difference(&pictures[i], &pictures[j]) > 30);
    }
}

#[test]
fn both_depth_conventions_give_one_picture() {
    let head = open();
    {
        let mut rig = Rig::new(head.gl(), scene(ShadingStyle::Realistic), &settings());
        let standard = rig.render(&view(DepthConvention::Standard));
        let reversed = rig.render(&view(DepthConvention::Reversed));
        assert!(largest_difference(&standard, &reversed) <= 2);
        let mut infinite = view(DepthConvention::Reversed);
        infinite.depth.far = f32::INFINITY;
        assert!(largest_difference(&standard, &rig.render(&infinite)) <= 2);
    }
    assert_eq!(head.gl().take_errors(), None);
}

#[test]
fn depth_is_the_distance_in_the_views_convention() {
    let head = open();
    let gl = head.gl();
    let mut wall = scene(ShadingStyle::Realistic);
    wall.model.parts.clear();
    wall.model.indices.clear();
    quad(&mut wall.model, 1, EYE + Vec3::new(-3.0, -9.0, -2.5), Vec3::X * 3.0, Vec3::Y * 18.0);
    let mut rig = Rig::new(gl, wall, &settings());
    for convention in [DepthConvention::Standard, DepthConvention::Reversed] {
        let view = View { pose: Pose { position: EYE, ..Pose::IDENTITY }, ..view(convention) };
        let depths = depths(gl, &rig.draw(&view).depth, &view);
        let row = &depths[SIZE[0] as usize * 50..][..SIZE[0] as usize];
        assert!((view.depth.distance(row[40]) - 2.5).abs() < 1e-3, "{convention:?}");
        assert_eq!(row[110], view.depth.clear_value(), "{convention:?}: nothing was drawn there");
    }
}

#[test]
fn targets_follow_the_size_and_nothing_leaks() {
    let head = open();
    let gl = head.gl();
    let mut rig = Rig::new(gl, scene(ShadingStyle::Realistic), &settings());
    let (small, mut large) = (view(DepthConvention::Standard), view(DepthConvention::Standard));
    large.size = [301, 97];
    let first = rig.render(&small);
    let objects = gl.object_count();
    for _ in 0..5 {
        let picture = rig.draw(&large);
        assert_eq!((picture.color.size(), picture.depth.texture.size()), (large.size, large.size));
        assert_eq!(rig.render(&small), first, "a repeated frame is identical");
    }
    assert_eq!(gl.object_count(), objects);
    assert_eq!(gl.take_errors(), None);
    drop(rig);
    assert_eq!(gl.object_count(), 0, "everything is deleted");
}

#[test]
fn transparent_surfaces_are_hidden_by_nearer_ones_only() {
    let head = open();
    let gl = head.gl();
    for convention in [DepthConvention::Standard, DepthConvention::Reversed] {
        let mut scene = scene(ShadingStyle::Realistic);
        // One pane in front of everything on the left, one behind the floor.
        quad(&mut scene.model, 5, Vec3::new(-0.5, 0.9, -0.2), Vec3::X * 0.4, Vec3::Y * 0.8);
        quad(&mut scene.model, 5, Vec3::new(-8.0, -0.5, 5.0), Vec3::X * 16.0, Vec3::NEG_Z * 30.0);
        let mut rig = Rig::new(gl, scene, &RenderSettings { bloom: false, msaa: 1, ..settings() });
        let view = view(convention);
        let before = rig.render(&view);
        let drawn = rig.renderer.render_all(&mut rig.targets, &rig.scene, &view).unwrap();
        let after = drawn.color.read_rgba8(0, [0, 0], view.size);
        let changed: Vec<usize> =
            (0..before.len() / 4).filter(|i| before[4 * i..][..3] != after[4 * i..][..3]).collect();
        assert!(changed.len() > 300, "{convention:?}: {}", changed.len());
        assert!(changed.iter().all(|i| i % (SIZE[0] as usize) < SIZE[0] as usize / 2 + 10), "{convention:?}");
        assert!(before.iter().skip(3).step_by(4).eq(after.iter().skip(3).step_by(4)), "luma stays");
        assert_eq!(gl.take_errors(), None);
    }
}

#[test]
fn textures_are_upright_and_middle_grey_stays_grey() {
    let head = open();
    let mut scene = scene(ShadingStyle::Realistic);
    scene.model = Model {
        textures: vec![picture(16, true, |_, y| if y < 8 { [255, 0, 0, 255] } else { [128, 128, 128, 255] })],
        materials: vec![Material { diffuse: Vec3::ONE, diffuse_map: Some(0), ..Material::default() }],
        ..Model::default()
    };
    scene.lights.clear();
    scene.sky.sun_direction = Vec3::new(0.0, 0.5, 1.0).normalize();
    quad(&mut scene.model, 0, Vec3::new(-5.0, -5.0, -2.0), Vec3::X * 10.0, Vec3::Y * 10.0);
    let mut rig = Rig::new(head.gl(), scene, &settings());
    let view = View { pose: Pose::IDENTITY, ..view(DepthConvention::Standard) };
    let picture = rig.render(&view);
    let pixel = |x: u32, y: u32| &picture[((y * SIZE[0] + x) * 4) as usize..][..4];
    let (top, bottom) = (pixel(70, 100), pixel(70, 12));
    assert!(top[0] > 150 && top[1] < 70, "the picture's upper half is red: {top:?}");
    assert!((110..=190).contains(&bottom[1]), "sunlit middle grey stays in the middle: {bottom:?}");
    let luma = 0.299 * bottom[0] as f32 + 0.587 * bottom[1] as f32 + 0.114 * bottom[2] as f32;
    assert!((luma - bottom[3] as f32).abs() <= 1.5, "alpha is luma: {bottom:?}");
}

#[test]
fn a_renderer_refuses_another_scene() {
    let head = open();
    let gl = head.gl();
    let mut rig = Rig::new(gl, scene(ShadingStyle::Realistic), &settings());
    let other = GpuScene::upload(gl, scene(ShadingStyle::Anime)).unwrap();
    let view = view(DepthConvention::Standard);
    assert!(rig.renderer.render(&mut rig.targets, &other, &view).is_err());
}

#[test]
fn unknown_settings_are_refused() {
    assert!(serde_json::from_str::<RenderSettings>(r#"{"shadows": 3}"#).is_err());
    let parsed: RenderSettings = serde_json::from_str(r#"{"bloom": false}"#).unwrap();
    assert_eq!(parsed, RenderSettings { bloom: false, ..RenderSettings::default() });
}

/// A GPU with only EXT_color_buffer_half_float refuses packed floats. Here a depth format stands in for them.
#[test]
fn hdr_falls_back_to_a_renderable_format() {
    let headless = open();
    let gl = headless.gl();
    let objects = gl.object_count();
    assert_eq!(first_renderable(gl, [Format::Depth16, Format::Rgba16F]), Format::Rgba16F);
    assert_eq!(hdr_format(gl), Format::R11G11B10F);
    assert_eq!((gl.take_errors(), gl.object_count()), (None, objects));
}

#[test]
fn all_levels_have_the_same_ink() {
    let of = |pixels: u32, detail: f32| {
        let frustum = Frustum::symmetric(60f32.to_radians(), 1.0);
        let pair =
            EyePair::parallel(Pose::IDENTITY, frustum, 0.063, DepthRange::PAPER, [pixels; 2], Eye::Left);
        let Outlines { width, strength } = Outlines::of(&pair.view(Eye::Left), detail);
        (width, strength)
    };
    // Half of 2, of 1 and of 3 pixels.
    assert_eq!([of(1800, 1.0), of(900, 0.5)], [(2, 1.0), (1, 1.0)]);
    assert_eq!([of(1024, 1.0), of(512, 0.5)], [(1, 1.0), (1, 0.5)]);
    assert_eq!([of(2700, 1.0), of(1350, 0.5)], [(3, 1.0), (2, 1.0)]);
    // A small picture has lines of a pixel.
    assert_eq!(of(100, 1.0), (1, 1.0));
}
