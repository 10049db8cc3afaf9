//! Samples, edges and outlines on small scenes.

use glam::Vec3;

use super::tests::{Rig, depths, open, picture, scene, settings, view};
use super::*;
use crate::fixture::quad;
use yoro::eyes::{DepthConvention, DepthRange, Frustum, Pose, View};
use yoro_assets::{Alpha, Material, Model, Scene, ShadingStyle, Sky, Viewpoint};
use yoro_context::{Backend, Headless};
use yoro_gl::Capabilities;
use yoro_test_support::record::Recorder;

const SIZE: [u32; 2] = [96, 64];

/// Settings without bloom.
fn with_samples(msaa: u32) -> RenderSettings {
    RenderSettings { msaa, bloom: false, ..settings() }
}

/// A driver without multisample textures, which carries depth through averages.
fn carrying() -> Headless {
    Headless::open_limited(Backend::Egl, |capabilities| capabilities.multisample_textures = false).unwrap()
}

/// A driver of OpenGL ES 3.0 without extensions.
fn least() -> Headless {
    Headless::open_limited(Backend::Egl, Capabilities::limit_to_es_300).unwrap()
}

/// Surfaces of one colour each, independent of light, from near to far. The last is a wall that fills the view.
fn flat(quads: &[(Vec3, Alpha, [Vec3; 3])]) -> Scene {
    let mut model = Model::default();
    for (i, &(emissive, alpha, [corner, across, up])) in quads.iter().enumerate() {
        let (diffuse, specular) = (Vec3::ZERO, Vec3::ZERO);
        model.materials.push(Material { diffuse, specular, emissive, alpha, ..Material::default() });
        quad(&mut model, i, corner, across, up);
    }
    Scene {
        name: "flat".into(),
        model,
        style: ShadingStyle::Realistic,
        sky: Sky { sun_color: Vec3::ZERO, ..Sky::default() },
        lights: Vec::new(),
        viewpoints: vec![Viewpoint { position: Vec3::ZERO, target: Vec3::NEG_Z }],
        ..Scene::default()
    }
}

const WALL: [Vec3; 3] = [Vec3::new(-20.0, -20.0, -9.0), Vec3::new(40.0, 0.0, 0.0), Vec3::new(0.0, 40.0, 0.0)];
/// Covers the left part of the view up to a slanted edge.
const SLANTED: [Vec3; 3] = [Vec3::new(-9.0, -9.0, -4.0), Vec3::new(8.0, 0.0, 0.0), Vec3::new(2.2, 18.0, 0.0)];
const BRIGHT: Vec3 = Vec3::new(0.9, 0.8, 0.7);
const DARK: Vec3 = Vec3::new(0.02, 0.03, 0.04);

fn straight_on(convention: DepthConvention) -> View {
    View {
        pose: Pose::IDENTITY,
        frustum: Frustum::symmetric(1.0, SIZE[0] as f32 / SIZE[1] as f32),
        depth: DepthRange { near: 0.2, far: 500.0, convention },
        size: SIZE,
    }
}

/// Returns the share of `b` in a pixel that is a mix of `a` and `b` in display values, by the channel in which they
/// differ most.
fn share(pixel: &[u8], a: &[u8], b: &[u8]) -> f32 {
    let channel = (0..3).max_by_key(|&i| a[i].abs_diff(b[i])).unwrap();
    let of = |p: &[u8]| f32::from(p[channel]);
    (of(pixel) - of(a)) / (of(b) - of(a))
}

fn pixel(picture: &[u8], x: u32, y: u32) -> &[u8] {
    &picture[((y * SIZE[0] + x) * 4) as usize..][..4]
}

#[test]
fn an_edge_is_the_mean_of_its_samples() {
    let head = open();
    let scene = flat(&[(BRIGHT, Alpha::Opaque, SLANTED), (DARK, Alpha::Opaque, WALL)]);
    for convention in [DepthConvention::Standard, DepthConvention::Reversed] {
        let mut rig = Rig::new(head.gl(), scene.clone(), &with_samples(4));
        let view = straight_on(convention);
        let drawn = rig.draw(&view);
        let picture = drawn.color.read_rgba8(0, [0, 0], SIZE);
        let (bright, dark) = (pixel(&picture, 2, 32).to_vec(), pixel(&picture, 93, 32).to_vec());
        let depths = depths(head.gl(), &drawn.depth, &view);
        let mut seen = [0; 5];
        let mut sum = 0.0;
        for (p, depth) in picture.chunks(4).zip(&depths) {
            let share = share(p, &dark, &bright);
            let quarters = (share * 4.0).round();
            assert!((share - quarters / 4.0).abs() < 0.01, "{p:?} of {dark:?} and {bright:?}");
            seen[quarters as usize] += 1;
            sum += share;
            let distance = if quarters > 0.0 { 4.0 } else { 9.0 };
            assert!((view.depth.distance(*depth) - distance).abs() < 1e-2, "the nearest sample's depth");
        }
        assert!(seen.iter().all(|count| *count > 5), "{seen:?}");
        // The edge is a straight line in tangents, so its mean over the view's rows is where it crosses the middle row.
        let tangent = (SLANTED[0].x + 8.0 + 2.2 * 0.5) / 4.0;
        let column = (tangent - view.frustum.left) / view.frustum.width() * SIZE[0] as f32;
        let mean = sum / SIZE[1] as f32;
        assert!((mean - column).abs() < 0.05, "{mean} columns instead of {column}");
    }
    assert_eq!(head.gl().take_errors(), None);
}

/// A fence with alpha 0 in half of its columns.
#[test]
fn cut_out_edges_cover_samples_by_alpha() {
    let head = open();
    let mut fence = flat(&[(BRIGHT, Alpha::Cutout(0.5), SLANTED), (DARK, Alpha::Opaque, WALL)]);
    fence.model.textures = vec![picture(16, true, |x, _| [255, 255, 255, if x % 8 < 4 { 255 } else { 0 }])];
    fence.model.materials[0].diffuse_map = Some(0);
    let view = straight_on(DepthConvention::Standard);
    let [one, four] = [1, 4].map(|samples| {
        let picture = Rig::new(head.gl(), fence.clone(), &with_samples(samples)).render(&view);
        let dark = pixel(&picture, 93, 32).to_vec();
        let bright = picture.chunks(4).max_by_key(|p| p[0]).unwrap().to_vec();
        let shares: Vec<f32> = picture.chunks(4).map(|p| share(p, &dark, &bright)).collect();
        let mixed = shares.iter().filter(|s| **s > 0.1 && **s < 0.9).count();
        (mixed, shares.iter().sum::<f32>() / shares.len() as f32)
    });
    assert_eq!(one.0, 0, "one sample is there or not");
    assert!(four.0 > 100, "{} pixels are mixed", four.0);
    assert!((one.1 - four.1).abs() < 0.02, "as much is left: {} and {}", one.1, four.1);
    assert_eq!(head.gl().take_errors(), None);
}

/// Every way gives the same picture; at edges it differs in which sample's depth it takes.
#[test]
fn drivers_differ_in_depth_at_edges_alone() {
    let (best, carrying, least) = (open(), carrying(), least());
    for style in [ShadingStyle::Realistic, ShadingStyle::Anime] {
        let view = view(DepthConvention::Reversed);
        let drawn = [&best, &carrying, &least].map(|head| {
            let mut rig = Rig::new(head.gl(), scene(style), &with_samples(4));
            let way = rig.renderer.depth_resolve;
            let drawn = rig.draw(&view);
            let picture = drawn.color.read_rgba8(0, [0, 0], view.size);
            (way, picture, depths(head.gl(), &drawn.depth, &view))
        });
        let [(way, expected, nearest), others @ ..] = drawn;
        assert_eq!(way, DepthResolve::Samples);
        for (way, picture, depth) in others {
            let off = |(a, b): (&[u8], &[u8])| (0..3).any(|i| a[i].abs_diff(b[i]) > 2);
            let off = expected.chunks(4).zip(picture.chunks(4)).filter(|pair| off(*pair)).count();
            // Outlines of resolved pictures are not smooth.
            let most = if style == ShadingStyle::Anime { depth.len() / 6 } else { 0 };
            assert!(off <= most, "{style:?}, {way:?}: {off} of {} pixels differ", depth.len());
            // Depth is that of a sample: never nearer than the nearest, but for the rounding of half floats and the
            // slope of a surface within a pixel.
            let farther = nearest.iter().zip(&depth).filter(|(a, b)| **b < **a * 0.98).count();
            let nearer = nearest.iter().zip(&depth).filter(|(a, b)| **b > **a * 1.02).count();
            assert!(farther > 20 && farther < depth.len() / 6, "{way:?}: {farther} of {}", depth.len());
            assert!(nearer < depth.len() / 200, "{way:?}: {nearer} of {}", depth.len());
        }
    }
    for head in [best, carrying, least] {
        assert_eq!(head.gl().take_errors(), None);
    }
}

/// Two surfaces of known depth, and an edge between them: each pixel has one depth or the other, never a mixture.
#[test]
fn carried_depth_is_that_of_a_sample() {
    let head = carrying();
    let scene = flat(&[(BRIGHT, Alpha::Opaque, SLANTED), (DARK, Alpha::Opaque, WALL)]);
    let view = straight_on(DepthConvention::Reversed);
    for samples in [2, 4].into_iter().filter(|n| head.gl().capabilities().samples.contains(n)) {
        let mut rig = Rig::new(head.gl(), scene.clone(), &with_samples(samples));
        assert_eq!(rig.renderer.depth_resolve, DepthResolve::InColor);
        let drawn = rig.draw(&view);
        assert!(drawn.depth.is_pair);
        for depth in depths(head.gl(), &drawn.depth, &view) {
            let distance = view.depth.distance(depth);
            assert!((distance - 4.0).abs() < 0.01 || (distance - 9.0).abs() < 0.02, "{distance} m");
        }
    }
}

/// Nobody reads the samples, and a tile-based GPU would write 48 bytes a pixel.
#[test]
fn no_sample_is_stored() {
    let head = carrying();
    let recorder = Recorder::new(head.gl());
    let mut rig = Rig::new(head.gl(), scene(ShadingStyle::Realistic), &with_samples(4));
    recorder.start();
    rig.draw(&view(DepthConvention::Reversed));
    let passes = recorder.take();
    let writes = passes.iter().flat_map(|pass| &pass.declaration.writes);
    let samples: Vec<_> = writes.filter(|write| write.image.samples > 1).collect();
    assert!(!samples.is_empty() && samples.iter().all(|write| !write.is_loaded && !write.is_stored));
}

/// The glass stands behind the slanted surface and in front of the wall.
#[test]
fn transparent_surfaces_are_tested_per_sample() {
    let head = open();
    let pane = [Vec3::new(-9.0, -9.0, -6.0), Vec3::new(14.0, 0.0, 0.0), Vec3::new(-3.0, 18.0, 0.0)];
    let glass = Vec3::new(0.1, 0.5, 0.2);
    let scene = flat(&[
        (BRIGHT, Alpha::Opaque, SLANTED),
        (DARK, Alpha::Opaque, WALL),
        (glass, Alpha::Blend(0.5), pane),
    ]);
    let mut rig = Rig::new(head.gl(), scene, &with_samples(4));
    let view = straight_on(DepthConvention::Standard);
    let drawn = rig.renderer.render_all(&mut rig.targets, &rig.scene, &view).unwrap();
    let picture = drawn.color.read_rgba8(0, [0, 0], SIZE);
    let (bright, dark) = (pixel(&picture, 2, 32).to_vec(), pixel(&picture, 93, 32).to_vec());
    let seen_through = pixel(&picture, 65, 32).to_vec();
    assert!(seen_through != dark && seen_through != bright);
    let row: Vec<&[u8]> = (0..SIZE[0]).map(|x| pixel(&picture, x, 40)).collect();
    let quarters = |a: &[u8], b: &[u8]| {
        let mixed = |p: &&&[u8]| {
            let share = share(p, a, b);
            share > 0.1 && share < 0.9 && ((share * 4.0).round() / 4.0 - share).abs() < 0.02
        };
        row.iter().filter(mixed).count()
    };
    assert!(quarters(&bright, &seen_through) > 0 && quarters(&seen_through, &dark) > 0);
    assert_eq!(head.gl().take_errors(), None);
}

#[test]
fn numbers_of_samples_that_are_not_there_are_refused() {
    let head = open();
    let gl = head.gl();
    let scene = GpuScene::upload(gl, scene(ShadingStyle::Realistic)).unwrap();
    let refusal = |settings: &RenderSettings| Renderer::new(gl, settings, &scene).err().unwrap().to_string();
    assert!(refusal(&with_samples(3)).contains("choose 1, 2 or 4"));
    for samples in [2, 4].into_iter().filter(|n| !gl.capabilities().samples.contains(n)) {
        assert!(refusal(&with_samples(samples)).contains("choose one of 1"));
    }
}

/// One object holds the targets of whichever renderer draws into it.
#[test]
fn targets_follow_the_renderers_settings() {
    let head = open();
    let gl = head.gl();
    let all = [settings(), with_samples(1), with_samples(4)];
    let scene = GpuScene::upload(gl, scene(ShadingStyle::Realistic)).unwrap();
    let view = view(DepthConvention::Standard);
    let mut shared = ViewTargets::default();
    for settings in all.iter().chain(&all) {
        let renderer = Renderer::new(gl, settings, &scene).unwrap();
        let mut own = ViewTargets::default();
        let [expected, drawn] = [&mut own, &mut shared].map(|targets| {
            let drawn = renderer.render(targets, &scene, &view).unwrap();
            drawn.color.read_rgba8(0, [0, 0], view.size)
        });
        assert!(expected == drawn, "{settings:?}");
    }
}
