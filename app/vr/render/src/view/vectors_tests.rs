//! Motion vectors of views, against positions in f64.

use std::rc::Rc;

use glam::{DMat4, DQuat, DVec3, DVec4, Quat, Vec3};

use super::moving_tests::{CUBE_VELOCITY, FENCE_TURN, moving};
use super::tests::{Rig, open, settings, view};
use super::vectors::{Step, VectorPass};
use super::*;
use yoro::eyes::{DepthConvention, Eye, Frustum, Ndc, Pose, View};
use yoro_assets::motion::{Interpolation, Node, Track};
use yoro_assets::{Motion, Scene};
use yoro_gl::{Context, Destination, Filter, Format, RenderTarget};

fn to_clip(view: &View) -> DMat4 {
    view.wgpu_projection().as_dmat4() * view.pose.view_matrix().as_dmat4()
}

/// Every pixel has the vector of its place in the world: by depth and poses where nothing moves, else by the motion of the
/// surface that it shows. At the size of the image and at a smaller one with another frustum, in both conventions.
#[test]
fn vectors_are_those_of_what_has_moved() {
    let head = open();
    let gl = head.gl();
    for (msaa, convention, ndc) in
        [(1, DepthConvention::Standard, Ndc::ZeroToOne), (4, DepthConvention::Reversed, Ndc::MinusOneToOne)]
    {
        let settings = RenderSettings { msaa, bloom: false, ..settings() };
        let mut rig = Rig::new(gl, moving(), &settings);
        let [before, seconds] = [1.2, 1.25];
        let rendered = view(DepthConvention::Reversed);
        let depth = yoro::eyes::DepthRange { convention, ..rendered.depth };
        let turn = Quat::from_euler(glam::EulerRot::YXZ, 0.02, -0.015, 0.01);
        let then = Pose {
            position: rendered.pose.position + Vec3::new(0.02, -0.01, 0.04),
            orientation: rendered.pose.orientation * turn,
        };
        for time in [before, seconds] {
            rig.renderer.set_time(&mut rig.scene, time).unwrap();
        }
        let mut targets = rig.renderer.targets(Layout::Single).unwrap();
        let views = std::slice::from_ref(&rendered);
        rig.renderer.draw_all(&mut targets, &(&rig.scene).into(), views, true, None).unwrap();
        let f = rendered.frustum;
        let smaller = View {
            size: [70, 60],
            frustum: Frustum { left: f.left * 0.9, right: f.right * 0.8, ..f },
            ..rendered
        };
        for now in [rendered, smaller] {
            let [eye, then] = [rendered.pose, then].map(|pose| View { pose, depth, ..rendered });
            let now = View { depth, ..now };
            let formats = [(Format::Rgba32F, Filter::Nearest)];
            let target =
                RenderTarget::new(gl, [90 + now.size[0], 5 + now.size[1]], &formats, Some(Format::Depth32F));
            let target = target.unwrap();
            let to = Destination { origin: [3, 2], size: now.size, ..Destination::whole(&target) };
            let image = targets.depth(rendered.size, Eye::Left, [0, 0]);
            let mut pass = VectorPass::new(gl, false).unwrap();
            let step = Step { view: now, now: eye, then, ndc };
            pass.draw_moving(&rig.scene, &step).unwrap();
            pass.write(RenderedDepth { depth: &image, view: &rendered }, &step, [0, 0], &to).unwrap();
            let got = target.read_rgba32f(0, to.origin, now.size);
            check(gl, &target, &to, &step, (&got, before, seconds));
            assert_eq!(gl.take_errors(), None);
        }
    }
}

/// After a long step, surfaces have the vectors of what stands still, and so has what jumps in a short one: here all, or
/// only the cube, which leaps, appears, is too fast, or starts over, while the fence goes on.
#[test]
fn a_jump_is_no_motion() {
    let head = open();
    let gl = head.gl();
    let fastest = |scene: Scene, times: &[f64]| fastest_vectors(gl, scene, times);
    let times = [1.0, 1.1, 1.1, 2.4, 2.55];
    let [jump, step, again, late, after] = fastest(moving(), &times)[..] else { panic!("{times:?}") };
    assert!(step > 0.01, "{step}");
    // The clock starts over after 2.5 seconds, where everything leaps back.
    assert!([jump, again, late, after].iter().all(|v| *v < 1e-5), "{:?}", [jump, again, late, after]);

    let with_cube = |change: &dyn Fn(&mut Motion)| {
        let mut scene = moving();
        scene.motion.nodes[0] = Node::default();
        change(&mut scene.motion);
        scene
    };
    let still = fastest(with_cube(&|_| ()), &[1.0, 1.1])[1];
    assert!(still > 1e-3, "the fence: {still}");
    let track = |times: [f32; 2], values: [f32; 6]| Track {
        times: times.into(),
        values: values.into(),
        ..Track::default()
    };
    let leap = [0.0, 0.0, 0.0, -0.2, 0.3, 0.6];
    let step = Interpolation::Step;
    let jumps: [(&str, &dyn Fn(&mut Motion)); 4] = [
        ("leaps", &|motion| {
            motion.nodes[0].moves = Some(Track { interpolation: step, ..track([0.0, 1.05], leap) })
        }),
        ("appears", &|motion| {
            let grows = track([0.0, 1.05], [0.0, 0.0, 0.0, 1.0, 1.0, 1.0]);
            motion.nodes[0].grows = Some(Track { interpolation: step, ..grows });
        }),
        ("is too fast", &|motion| {
            motion.nodes[0].moves = Some(track([1.04, 1.05], [0.0, 0.0, 0.0, -1.0, 0.5, 0.0]))
        }),
        ("starts over", &|motion| {
            motion.loops.push(0.35);
            motion.nodes[0].moves = Some(Track { clock: 1, ..track([0.0, 0.35], leap) });
        }),
    ];
    for (what, change) in jumps {
        let [_, got] = fastest(with_cube(change), &[1.0, 1.1])[..] else { panic!("{what}") };
        // The cube may hide a part of the fence.
        assert!((0.5 * still..still + 1e-4).contains(&got), "{what}: {got}, and the fence alone {still}");
    }
    let moves =
        |motion: &mut Motion| motion.nodes[0].moves = Some(track([1.0, 1.2], [0.0, 0.0, 0.0, 0.8, 0.1, 0.0]));
    let slow = fastest(with_cube(&moves), &[1.0, 1.1])[1];
    assert!(slow > 1.5 * still, "the cube moves by {slow}, the fence by {still}");
}

/// Returns the largest vector of a scene after each step to one of these times.
fn fastest_vectors(gl: &Rc<Context>, scene: Scene, times: &[f64]) -> Vec<f32> {
    let mut rig = Rig::new(gl, scene, &settings());
    let view = view(DepthConvention::Reversed);
    let mut targets = rig.renderer.targets(Layout::Single).unwrap();
    let formats = [(Format::Rgba32F, Filter::Nearest)];
    let target = RenderTarget::new(gl, view.size, &formats, Some(Format::Depth32F)).unwrap();
    let mut pass = VectorPass::new(gl, false).unwrap();
    let fastest = |&seconds: &f64| {
        rig.renderer.set_time(&mut rig.scene, seconds).unwrap();
        rig.renderer
            .draw_all(&mut targets, &(&rig.scene).into(), std::slice::from_ref(&view), true, None)
            .unwrap();
        let image = targets.depth(view.size, Eye::Left, [0, 0]);
        let step = Step { view, now: view, then: view, ndc: Ndc::ZeroToOne };
        pass.draw_moving(&rig.scene, &step).unwrap();
        pass.write(RenderedDepth { depth: &image, view: &view }, &step, [0, 0], &Destination::whole(&target))
            .unwrap();
        let vectors = target.read_rgba32f(0, [0, 0], view.size);
        vectors.iter().map(|v| v[0].abs().max(v[1].abs())).fold(0.0, f32::max)
    };
    times.iter().map(fastest).collect()
}

fn check(
    gl: &std::rc::Rc<yoro_gl::Context>,
    target: &RenderTarget,
    to: &Destination,
    step: &Step,
    (got, before, seconds): (&[[f32; 4]], f64, f64),
) {
    let Step { view: now, now: eye, then, ndc } = step;
    let copy = RenderTarget::new(gl, target.size(), &[(Format::Rgba32F, Filter::Nearest)], None).unwrap();
    let mut program = DepthProgram::new(gl, "render/depth_copy.frag");
    let image = DepthImage {
        texture: target.depth(),
        origin: [0, 0],
        layer: None,
        is_pair: false,
        convention: now.depth.convention,
    };
    copy.overwrite();
    program.bind(&image).unwrap();
    gl.draw_screen();
    let depth = copy.read_rgba32f(0, to.origin, now.size);
    let [width, height] = now.size.map(|n| n as usize);
    let (to_world, to_eye, then) = (to_clip(now).inverse(), to_clip(eye), to_clip(then));
    let step = seconds - before;
    // Where a surface that is seen was: still, the cube, the fence.
    let previous = |world: DVec3, i: usize| match i {
        0 => world,
        1 => world - CUBE_VELOCITY.as_dvec3() * step,
        _ => DQuat::from_rotation_y(-FENCE_TURN * step) * world,
    };
    let (mut seen, mut wrong) = ([0; 3], 0);
    for i in 0..width * height {
        let place =
            [(i % width, width), (i / width, height)].map(|(at, n)| 2.0 * (at as f64 + 0.5) / n as f64 - 1.0);
        let here = DVec3::new(place[0], place[1], f64::from(depth[i][0]));
        let Some(world) = project(to_world, here) else { continue };
        let moves = got[i][3] == 1.0;
        let off = |k: usize| {
            let was = project(then, previous(world, k)).unwrap();
            let mut want = project(to_eye, world).unwrap() - was;
            if *ndc == Ndc::MinusOneToOne {
                want.z *= 2.0;
            }
            let off = DVec3::from([0, 1, 2].map(|c| f64::from(got[i][c]))) - want;
            off.x.abs().max(off.y.abs()) * width as f64 / 2.0 + off.z.abs() * 10.0
        };
        // Half floats, and nearest depths beside the middle of a pixel.
        let allowed = if moves { 0.15 } else { 0.01 };
        match (usize::from(moves)..if moves { 3 } else { 1 }).find(|k| off(*k) < allowed) {
            Some(k) => seen[k] += 1,
            None => wrong += 1,
        }
    }
    let least = width * height / 200;
    assert!(seen[0] > 20 * least && seen[1] > least && seen[2] > least, "{seen:?}");
    assert!(wrong * 200 < width * height, "{wrong} of {seen:?}");
}

fn project(matrix: DMat4, at: DVec3) -> Option<DVec3> {
    let clip: DVec4 = matrix * at.extend(1.0);
    (clip.w != 0.0).then(|| clip.truncate() / clip.w)
}
