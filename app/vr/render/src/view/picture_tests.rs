//! The forward renderer on small scenes.

use std::rc::Rc;

use glam::Vec3;

use super::tests::{Rig, depths, open, picture, scene, settings, view};
use super::*;
use crate::fixture::quad;
use yoro::eyes::{DepthConvention, DepthRange, Frustum, Pose, View};
use yoro_assets::{Alpha, Material, Model, PointLight, Scene, ShadingStyle, Sky, Viewpoint};
use yoro_estimate::{Command, Recorder};
use yoro_gl::{Context, RenderTarget};

const SIZE: [u32; 2] = [96, 64];

/// Settings without the effects that only the deferred renderer has.
fn with_samples(msaa: u32) -> RenderSettings {
    RenderSettings { renderer: RendererKind::Forward, msaa, bloom: false, ssao: false, ..settings() }
}

/// A view in whose samples drawing resumes.
const RESUMED: DrawRequest = DrawRequest { selection: Selection::All, columns: None, keeps_samples: true };

/// A scene with its forward renderer and targets.
fn forward(
    gl: &Rc<Context>,
    scene: Scene,
    settings: &RenderSettings,
) -> (GpuScene, ForwardRenderer, ForwardTargets) {
    let scene = GpuScene::upload(gl, scene).unwrap();
    let renderer = ForwardRenderer::new(gl, settings, &scene).unwrap();
    (scene, renderer, ForwardRenderer::targets(gl, settings).unwrap())
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

/// The pictures differ by the rounding of the g-buffer (8 bits for the square root of albedo) and of half floats (6
/// bits of a colour's mantissa).
#[test]
fn forward_lights_as_deferred_does() {
    let head = open();
    for style in ShadingStyle::ALL {
        let deferred = RenderSettings { renderer: RendererKind::Deferred, ..with_samples(1) };
        let [expected, ours] = [deferred, with_samples(1)].map(|settings| {
            let mut rig = Rig::new(head.gl(), scene(style), &settings);
            rig.render(&view(DepthConvention::Standard), Selection::All)
        });
        let differences = |a: &[u8], b: &[u8]| a.iter().zip(b).map(|(a, b)| a.abs_diff(*b)).max().unwrap();
        let pixels = expected.len() / 4;
        let far_off =
            expected.chunks(4).zip(ours.chunks(4)).filter(|(a, b)| differences(&a[..3], &b[..3]) > 4);
        let share = far_off.count() as f64 / pixels as f64;
        // Measured: 0; cartoon 0.5 %, where rounding moves the border of a band; anime 4.2 %, where ink takes a share
        // of the lit surface's colour instead of its albedo's.
        let bound = match style {
            ShadingStyle::Anime => 0.06,
            ShadingStyle::Cartoon => 0.01,
            _ => 0.001,
        };
        assert!(share < bound, "{style:?}: {share} of the pixels differ");
    }
    assert_eq!(head.gl().take_errors(), None);
}

#[test]
fn an_edge_is_the_mean_of_its_samples() {
    let head = open();
    let scene = flat(&[(BRIGHT, Alpha::Opaque, SLANTED), (DARK, Alpha::Opaque, WALL)]);
    for convention in [DepthConvention::Standard, DepthConvention::Reversed] {
        let mut rig = Rig::new(head.gl(), scene.clone(), &with_samples(4));
        let view = straight_on(convention);
        let drawn = rig.draw(&view, Selection::All);
        let picture = drawn.color.read_rgba8(0, [0, 0], SIZE);
        let (bright, dark) = (pixel(&picture, 2, 32).to_vec(), pixel(&picture, 93, 32).to_vec());
        let depths = depths(head.gl(), drawn.depth, &view);
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

/// In OpenGL ES 3.0 the samples are renderbuffers.
#[test]
fn without_multisample_textures_only_depth_at_edges_differs() {
    let head = open();
    let gl = head.gl();
    let settings = with_samples(4);
    for style in [ShadingStyle::Realistic, ShadingStyle::Anime] {
        let scene = GpuScene::upload(gl, scene(style)).unwrap();
        let view = view(DepthConvention::Reversed);
        let [(color, depth), (expected_color, expected_depth)] = [false, true].map(|readable| {
            let renderer = ForwardRenderer::build(gl, &settings, &scene, readable).unwrap();
            let mut targets = ForwardTargets::build(gl, Layout::Single, &settings, readable).unwrap();
            renderer.render(&mut targets, &scene, &view, &RESUMED).unwrap();
            let color = targets.color().read_rgba8(0, [0, 0], view.size);
            (color, depths(gl, targets.depth(), &view))
        });
        if style == ShadingStyle::Realistic {
            assert!(color == expected_color);
        }
        let differing = depth.iter().zip(&expected_depth).filter(|(a, b)| a != b).count();
        assert!(differing > 20 && differing < depth.len() / 4, "{differing} of {}", depth.len());
        assert!(depth.iter().zip(&expected_depth).all(|(one, nearest)| one <= nearest));
    }
    assert_eq!(gl.take_errors(), None);
}

#[test]
fn transparent_surfaces_are_tested_per_sample() {
    let head = open();
    let gl = head.gl();
    // A pane with a slanted edge of its own, behind the slanted surface and in front of the wall.
    let pane = [Vec3::new(-9.0, -9.0, -6.0), Vec3::new(14.0, 0.0, 0.0), Vec3::new(-3.0, 18.0, 0.0)];
    let glass = Vec3::new(0.1, 0.5, 0.2);
    let scene = flat(&[
        (BRIGHT, Alpha::Opaque, SLANTED),
        (DARK, Alpha::Opaque, WALL),
        (glass, Alpha::Blend(0.5), pane),
    ]);
    let (scene, renderer, mut targets) = forward(gl, scene, &with_samples(4));
    let view = straight_on(DepthConvention::Standard);
    renderer.render(&mut targets, &scene, &view, &RESUMED).unwrap();
    renderer.resume_samples(&targets, &scene, &view, None, false);
    let later = targets.color().read_rgba8(0, [0, 0], SIZE);
    renderer.render_all(&mut targets, &scene, &view, false).unwrap();
    let picture = targets.color().read_rgba8(0, [0, 0], SIZE);
    assert!(picture == later, "after the opaque surfaces were averaged, as before");
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
    assert_eq!(gl.take_errors(), None);
}

/// Nobody reads the samples of a complete image, and a tile-based GPU would write 32 bytes a pixel.
#[test]
fn samples_are_given_up_once_drawing_has_resumed() {
    let head = open();
    let recorder = Recorder::new(head.gl());
    let (scene, renderer, mut targets) = forward(head.gl(), scene(ShadingStyle::Realistic), &with_samples(4));
    let view = view(DepthConvention::Standard);
    let discarded = |draw: &mut dyn FnMut()| {
        recorder.start();
        draw();
        recorder.take().iter().any(|command| matches!(command, Command::Discard(_, [true, true])))
    };
    let mut draw = |request: &DrawRequest| {
        discarded(&mut || renderer.render(&mut targets, &scene, &view, request).unwrap())
    };
    assert!(!draw(&DrawRequest::default()), "synthesis reads their depth first");
    assert!(!draw(&RESUMED));
    assert!(discarded(&mut || renderer.resume_samples(&targets, &scene, &view, None, false)));
}

/// The samples' own depth stays float: rounding it would let surfaces show through one another.
#[test]
fn depth_of_16_bits_is_that_of_32_rounded() {
    let head = open();
    let gl = head.gl();
    for convention in [DepthConvention::Standard, DepthConvention::Reversed] {
        let view = view(convention);
        let [(fine_color, fine), (color, coarse)] = [32, 16].map(|depth_bits| {
            let settings = RenderSettings { depth_bits, ..with_samples(4) };
            let (scene, renderer, mut targets) = forward(gl, scene(ShadingStyle::Realistic), &settings);
            renderer.render(&mut targets, &scene, &view, &RESUMED).unwrap();
            let color = targets.color().read_rgba8(0, [0, 0], view.size);
            (color, depths(gl, targets.depth(), &view))
        });
        assert!(color == fine_color);
        let off = |(a, b): (&f32, &f32)| (a - b).abs() * 65535.0;
        let furthest = fine.iter().zip(&coarse).map(off).fold(0.0, f32::max);
        assert!(furthest > 0.1 && furthest < 0.51, "{convention:?}: {furthest} steps");
    }
    assert_eq!(gl.take_errors(), None);
}

#[test]
fn drawing_resumes_over_a_synthesized_eye() {
    let head = open();
    let gl = head.gl();
    for msaa in [1, 4] {
        let (scene, renderer, mut targets) = forward(gl, scene(ShadingStyle::Realistic), &with_samples(msaa));
        let mut small = view(DepthConvention::Standard);
        renderer.render(&mut targets, &scene, &small, &RESUMED).unwrap();
        small.size = [100, 90];
        let formats = [(yoro_gl::Format::Rgba8, yoro_gl::Filter::Linear)];
        let image = RenderTarget::new(gl, small.size, &formats, Some(yoro_gl::Format::Depth32F)).unwrap();
        image.bind();
        gl.clear(Some(1.0));
        gl.fill([0, 0], small.size, [0.2, 0.4, 0.6, 1.0]);
        // Nothing is drawn, so the image stays as it is.
        let nothing = Some(Selection::Nearer { from: EYE_FAR, distance: 0.01 });
        renderer.resume_samples_with(&targets, &image, &scene, &small, nothing, true);
        assert!(image.read_rgba8(0, [0, 0], small.size).chunks(4).all(|p| p[..3] == [51, 102, 153]));
        // Everything is drawn: opaque surfaces over the image.
        renderer.resume_samples_with(&targets, &image, &scene, &small, Some(Selection::All), true);
        let drawn = image.read_rgba8(0, [0, 0], small.size);
        let kept = drawn.chunks(4).filter(|p| p[..3] == [51, 102, 153]).count();
        assert!(kept > 500 && kept < 7000, "{kept} pixels of the image are left");
    }
    assert_eq!(gl.take_errors(), None);
}

/// An image has one depth in each pixel. At an edge, half of the nearer pixel lets surfaces behind it show.
#[test]
fn surfaces_over_a_loaded_image_have_soft_edges() {
    let head = open();
    let gl = head.gl();
    let pane = [Vec3::new(-9.0, -9.0, -6.0), Vec3::new(18.0, 0.0, 0.0), Vec3::new(0.0, 18.0, 0.0)];
    let glass = (Vec3::new(0.1, 0.5, 0.2), Alpha::Blend(0.5), pane);
    let scene = flat(&[(BRIGHT, Alpha::Opaque, SLANTED), (DARK, Alpha::Opaque, WALL), glass]);
    let scene = GpuScene::upload(gl, scene).unwrap();
    for convention in [DepthConvention::Standard, DepthConvention::Reversed] {
        let view = straight_on(convention);
        let [(_, image), (renderer, targets)] = [1, 4].map(|samples| {
            let settings = with_samples(samples);
            let renderer = ForwardRenderer::new(gl, &settings, &scene).unwrap();
            let mut targets = ForwardRenderer::targets(gl, &settings).unwrap();
            renderer.render(&mut targets, &scene, &view, &DrawRequest::default()).unwrap();
            (renderer, targets)
        });
        let before = image.resolved.read_rgba8(0, [0, 0], SIZE);
        renderer.resume_samples_with(&targets, &image.resolved, &scene, &view, None, false);
        let after = image.resolved.read_rgba8(0, [0, 0], SIZE);
        let (bright, dark) = (pixel(&before, 2, 32).to_vec(), pixel(&before, 93, 32).to_vec());
        let through = pixel(&after, 93, 32);
        // Half of what the pane does to the bright surface. The pane's display colour is 2 through - dark.
        let half = |i: usize| {
            let of = |p: &[u8]| f32::from(p[i]);
            0.75 * of(&bright) + 0.25 * (2.0 * of(through) - of(&dark))
        };
        for y in 0..SIZE[1] {
            let changed = |x: &u32| {
                pixel(&before, *x, y)[..3] == bright[..3] && pixel(&after, *x, y)[..3] != bright[..3]
            };
            let soft: Vec<u32> = (0..SIZE[0]).filter(changed).collect();
            assert!((1..=2).contains(&soft.len()), "row {y}: {soft:?}");
            for x in soft {
                let pixel = pixel(&after, x, y);
                assert!((0..3).all(|i| (f32::from(pixel[i]) - half(i)).abs() < 3.0), "{pixel:?} at {x}, {y}");
            }
        }
    }
    assert_eq!(gl.take_errors(), None);
}

const EYE_FAR: Vec3 = Vec3::splat(1e4);

/// A fence with alpha 0 in half of its columns.
#[test]
fn cut_out_edges_cover_samples_by_alpha() {
    let head = open();
    let mut fence = flat(&[(BRIGHT, Alpha::Cutout(0.5), SLANTED), (DARK, Alpha::Opaque, WALL)]);
    fence.model.textures = vec![picture(16, true, |x, _| [255, 255, 255, if x % 8 < 4 { 255 } else { 0 }])];
    fence.model.materials[0].diffuse_map = Some(0);
    let view = straight_on(DepthConvention::Standard);
    let [one, four] = [1, 4].map(|samples| {
        let picture =
            Rig::new(head.gl(), fence.clone(), &with_samples(samples)).render(&view, Selection::All);
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

/// Twenty lamps over a floor.
#[test]
fn light_tiles_leave_no_light_out() {
    let head = open();
    let mut many = scene(ShadingStyle::Realistic);
    let lamp = |i: i32| PointLight {
        position: Vec3::new((i % 5) as f32 * 1.5 - 3.0, 0.6, -1.0 - (i / 5) as f32 * 2.5),
        color: Vec3::new(0.9, 0.8, 0.5) * (0.3 + 0.1 * (i % 3) as f32),
        range: 1.6,
    };
    many.lights = (0..20).map(lamp).collect();
    let [deferred, forward] = [RendererKind::Deferred, RendererKind::Forward].map(|renderer| {
        let settings = RenderSettings { renderer, ..with_samples(1) };
        Rig::new(head.gl(), many.clone(), &settings).render(&view(DepthConvention::Standard), Selection::All)
    });
    let far_off = deferred.chunks(4).zip(forward.chunks(4));
    let far_off = far_off.filter(|(a, b)| (0..3).any(|i| a[i].abs_diff(b[i]) > 4)).count();
    assert!(far_off < deferred.len() / 4 / 100, "{far_off} pixels differ");
}

#[test]
fn numbers_of_samples_that_are_not_there_are_refused() {
    let head = open();
    let gl = head.gl();
    let refusal =
        |settings: &RenderSettings| ForwardRenderer::targets(gl, settings).err().unwrap().to_string();
    assert!(refusal(&with_samples(3)).contains("choose 1, 2 or 4"));
    for samples in [2, 4].into_iter().filter(|n| !gl.capabilities().samples.contains(n)) {
        assert!(refusal(&with_samples(samples)).contains("choose one of 1"));
    }
}

/// One object holds the targets of whichever renderer draws into it.
#[test]
fn targets_follow_the_renderers_kind_and_settings() {
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
            let drawn = renderer.render(targets, &scene, &view, Selection::All).unwrap();
            drawn.color.read_rgba8(0, [0, 0], view.size)
        });
        assert!(expected == drawn, "{}", settings.summary());
    }
}

/// Without readable samples (OpenGL ES 3.0), outlines read the resolved depth, even if it was not requested.
#[test]
fn outlines_work_without_readable_samples() {
    let head = open();
    let gl = head.gl();
    let settings = with_samples(4);
    let scene = GpuScene::upload(gl, scene(ShadingStyle::Anime)).unwrap();
    let view = view(DepthConvention::Standard);
    let [unwanted, wanted] = [false, true].map(|depth| {
        let renderer = ForwardRenderer::build(gl, &settings, &scene, false).unwrap();
        let mut targets = ForwardTargets::build(gl, Layout::Single, &settings, false).unwrap();
        renderer.render_all(&mut targets, &scene, &view, depth).unwrap();
        targets.color().read_rgba8(0, [0, 0], view.size)
    });
    assert!(unwanted == wanted);
    assert_eq!(gl.take_errors(), None);
}

#[test]
#[should_panic(expected = "rendered without its depth")]
fn reading_a_depth_that_was_not_requested_panics() {
    let head = open();
    let (scene, renderer, mut targets) = forward(head.gl(), scene(ShadingStyle::Realistic), &with_samples(4));
    for depth in [true, false] {
        renderer.render_all(&mut targets, &scene, &view(DepthConvention::Standard), depth).unwrap();
        targets.depth();
    }
}
