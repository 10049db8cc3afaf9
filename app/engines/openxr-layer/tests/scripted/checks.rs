//! Compares what the runtime receives with references.

use yoro::eyes::{DepthRange, EyePair, Frustum, GuardBand, Pose};
use yoro::vulkan::{Frame, Gather, ImageState, Options, SourceImages, TargetImages};
use yoro_openxr_stub::log;
use yoro_openxr_stub::script::Script;

use crate::client::{Client, Planes};
use crate::habits::{D32, Habits};
use crate::harness::{Gpu, READ, WRITTEN};
use crate::scene;
use crate::world::Seen;

/// Returns the views of a frame's first projection layer.
pub fn views_of(layers: &[log::Layer]) -> &[log::View] {
    let mut views = layers.iter().filter_map(|layer| match layer {
        log::Layer::Projection { views } => Some(views.as_slice()),
        _ => None,
    });
    views.next().expect("there is a projection layer")
}

pub fn pose_of(view: &log::View) -> Pose {
    Pose { position: view.position.into(), orientation: glam::Quat::from_array(view.orientation) }
}

pub fn frustum_of(view: &log::View) -> Frustum {
    let [left, right, up, down] = view.fov_degrees.map(f32::to_radians);
    Frustum::from_fov(left, right, up, down)
}

/// Returns the PSNR in dB over red, green and blue.
pub fn psnr(a: &[u8], b: &[u8]) -> f64 {
    assert_eq!(a.len(), b.len());
    let color = |i: &usize| i % 4 != 3;
    let squares = (0..a.len()).filter(color).map(|i| f64::from(a[i].abs_diff(b[i])).powi(2));
    10.0 * (255f64.powi(2) * a.len() as f64 * 0.75 / squares.sum::<f64>()).log10()
}

/// Renders the reference for a view that was submitted to the runtime.
pub fn truth(view: &log::View, samples: u32) -> Vec<u8> {
    let [.., width, height] = view.image.rect.map(|n| n as u32);
    scene::render(pose_of(view), frustum_of(view), [width, height], samples).rgba
}

/// Checks that both eyes' images are like the references at the submitted poses.
pub fn assert_seen(seen: &Seen, habits: &Habits, what: &str) {
    let views = seen.views();
    assert_eq!(views.len(), 2, "{what}");
    let (own, other) = (habits.dominant().index(), habits.dominant().other().index());
    let [own, other] = [own, other].map(|eye| psnr(&seen.picture(eye), &truth(&views[eye], habits.samples)));
    println!("{what}: the dominant eye {own:.1} dB, the synthesized one {other:.1} dB");
    assert!(own > 45.0, "{what}: the dominant eye's image is none of that eye: {own} dB");
    assert!(other > 31.0, "{what}: the other eye's image is none of that eye: {other} dB");
}

/// Checks that the runtime found no violation, and that each session has these numbers of synthesized and other frames.
pub fn assert_counts(seen: &Seen, counts: &[[u64; 2]], what: &str) {
    assert!(seen.violations().is_empty(), "{what}: {:?}", seen.violations());
    assert_eq!(seen.counts(), counts, "{what}: {}", seen.layer_log);
}

/// Does the checks of [`assert_counts`], and those of [`assert_seen`] for the last images.
pub fn assert_sessions(seen: &Seen, habits: &Habits, counts: &[[u64; 2]], what: &str) {
    assert_counts(seen, counts, what);
    assert_seen(seen, habits, what);
}

/// Checks that the runtime has both eyes' depth, in the rectangles of their colour, and that it is like the references.
pub fn assert_depth(seen: &Seen, habits: &Habits, what: &str) {
    let Planes { near, far, min, max } = habits.planes;
    for (eye, view) in seen.views().iter().enumerate() {
        let depth = view.depth.as_ref().unwrap();
        assert_eq!(depth.image.rect, view.image.rect, "{what}: eye {eye}");
        assert_eq!(depth.range, [min, max], "{what}: eye {eye}");
        assert_eq!(depth.near_far, [near, far].map(|z| z.min(f32::MAX)), "{what}: eye {eye}");
        if habits.formats[1] != D32 {
            continue;
        }
        let [.., width, height] = view.image.rect.map(|n| n as u32);
        let truth = scene::render(pose_of(view), frustum_of(view), [width, height], 1).distance;
        let close = |(stored, distance): (&f32, &f32)| {
            let error = (stored - habits.planes.stored(*distance)).abs();
            // The difference between neighbouring pixels, away from silhouettes.
            error < 0.02 * (max - min) * (habits.planes.stored(0.8) - habits.planes.stored(6.0)).abs()
        };
        let got = seen.depth(eye);
        assert_eq!(got.len(), truth.len(), "{what}: eye {eye}");
        let close = got.iter().zip(&truth).filter(|pair| close(*pair)).count();
        let share = close as f64 / truth.len() as f64;
        println!("{what}: depth of eye {eye}: {share:.4} of the pixels");
        assert!(share > 0.99, "{what}: depth of eye {eye} is that of {share} of the pixels");
    }
}

/// Checks that the synthesized eye is what the core synthesizes from the same source for the submitted views.
pub fn assert_synthesized(gpu: &Gpu, seen: &Seen, client: &Client, habits: &Habits, what: &str) {
    let views = seen.views();
    let painted = client.painted.as_ref().unwrap();
    let [.., width, height] = views[0].image.rect.map(|n| n as u32);
    let eyes = EyePair {
        poses: [0, 1].map(|i| pose_of(&views[i])),
        frusta: [0, 1].map(|i| frustum_of(&views[i])),
        depth: DepthRange::from_distances(habits.planes.near, habits.planes.far),
        size: [width, height],
        dominant: habits.dominant(),
    };
    let plan = eyes.synthesis_views(GuardBand::Pixels(16)).unwrap();
    assert_eq!(plan.source.size, painted.picture.size, "{what}");
    let options = Options {
        color_format: habits.formats[0],
        max_source_size: plan.warp.source_size,
        max_target_size: plan.warp.target_size,
        ..Options::default()
    };
    let target = gpu.image(habits.formats[0], plan.warp.target_size, 1);
    // SAFETY: the images live until the commands have ended.
    unsafe {
        let mut gather = Gather::new(&gpu.host(), &options).unwrap();
        let [color, depth] = [painted.color(), painted.depth()].map(|image| image.layer(0, READ, READ));
        let source = SourceImages::new(color, depth, painted.picture.size);
        let source = gather.register_source(&source).unwrap();
        let target =
            TargetImages::new(target.layer(0, ImageState::DISCARDED, WRITTEN), plan.warp.target_size);
        let target = gather.register_target(&target).unwrap();
        gpu.run(|commands| gather.record(commands, &Frame::new(source, target), &plan.warp).unwrap());
    }
    let (want, got) = (target.read_rgba8(0, WRITTEN), seen.picture(habits.dominant().other().index()));
    let differs = |(a, b): &(&[u8], &[u8])| (0..3).any(|i| a[i].abs_diff(b[i]) > 2);
    let different = want.chunks_exact(4).zip(got.chunks_exact(4)).filter(differs).count();
    // Rounded angles may move pixels at silhouettes.
    assert!(different * 200 <= want.len() / 4, "{what}: {different} pixels are not the core's");
}

/// Checks that the views' poses and fields of view are those of the runtime's own eyes.
pub fn assert_own_eyes(seen: &Seen, script: &Script, pixels: f32, what: &str) {
    for (i, view) in seen.views().iter().enumerate() {
        let side = [-1.0, 1.0][i];
        let distance = (pose_of(view).position - glam::Vec3::X * side * 0.0315).length();
        assert!(distance < 1e-4, "{what}: eye {i} is at {:?}", view.position);
        for (got, want) in view.fov_degrees.iter().zip(script.eyes[i].fov_degrees) {
            // The angles are compared as tangents. A pixel of the headset is about 0.017.
            let error = got.to_radians().tan() - want.to_radians().tan();
            assert!(error.abs() < 1e-3 + 0.02 * pixels, "{what}: eye {i} sees {:?}", view.fov_degrees);
        }
    }
}
