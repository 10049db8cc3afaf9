//! A view in any pose near the rendered one: the warp and the guard band are the core's.

mod common;

use std::ptr::null;

use common::{
    Mistakes, check_codes, create, gl_info, good_eyes, images, outcome, pose_warp_of as warp_of, views_of,
    zeroed,
};
use glam::{DVec3, EulerRot, Quat};
use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};
use yoro::eyes::{DepthConvention, DepthRange, Frustum, HeadMotion, Pose, PoseWarp, View};
use yoro_c::*;
use yoro_context::{Backend, Headless};

const SIZE: [u32; 2] = [120, 90];
const RANGE: DepthRange = DepthRange { near: 0.1, far: 50.0, convention: DepthConvention::Reversed };

/// Returns a view as C programs have it, without matrices.
fn view(position: [f32; 3], turn: [f32; 3], [width, height]: [u32; 2]) -> YoroView {
    let [yaw, pitch, roll] = turn;
    let orientation = Quat::from_euler(EulerRot::YXZ, yaw, pitch, roll).to_array();
    YoroView {
        width,
        height,
        pose: YoroPose { orientation, position },
        fov: YoroFov { angle_left: -0.7, angle_right: 0.6, angle_up: 0.5, angle_down: -0.55 },
        ..YoroView::default()
    }
}

/// Returns the same view for the core.
fn core(view: &YoroView) -> View {
    let (pose, fov) = (view.pose, view.fov);
    View {
        pose: Pose { position: pose.position.into(), orientation: Quat::from_array(pose.orientation) },
        frustum: Frustum::from_fov(fov.angle_left, fov.angle_right, fov.angle_up, fov.angle_down),
        depth: RANGE,
        size: [view.width, view.height],
    }
}

fn poses(source: &YoroView, target: &YoroView, rows: YoroRows) -> YoroPoses {
    let mut poses: YoroPoses = zeroed(|p: &mut YoroPoses| &mut p.struct_size);
    (poses.near_z, poses.far_z, poses.depth) = (RANGE.near, RANGE.far, YORO_DEPTH_REVERSED);
    (poses.rows, poses.source, poses.target) = (rows, source, target);
    poses
}

fn the_cores(warp: &PoseWarp) -> YoroPoseWarp {
    YoroPoseWarp {
        source_width: warp.source_size[0],
        source_height: warp.source_size[1],
        target_width: warp.target_size[0],
        target_height: warp.target_size[1],
        homography: warp.homography.to_cols_array(),
        epipole: warp.epipole.to_array(),
        source_law: warp.source_law,
        target_law: warp.target_law,
        nearest: warp.nearest,
        far_depth: warp.far_depth,
    }
}

#[test]
fn the_warp_is_the_cores_with_rows_from_either_end() {
    let source = view([3.0, 1.6, -20.0], [0.0; 3], [140, 100]);
    let target = view([3.02, 1.58, -20.1], [0.05, -0.03, 0.02], SIZE);
    let expected = PoseWarp::new(&core(&source), &core(&target)).unwrap();
    assert_eq!(warp_of(&poses(&source, &target, YORO_ROWS_UP)), Ok(the_cores(&expected)));
    let down = warp_of(&poses(&source, &target, YORO_ROWS_DOWN)).unwrap();
    let down = PoseWarp {
        homography: glam::DMat3::from_cols_array(&down.homography),
        epipole: DVec3::from_array(down.epipole),
        ..expected
    };
    for k in [0.0, 0.3, 2.0] {
        let from_bottom = expected.source_pixel(glam::DVec2::new(30.5, 20.5), k);
        let from_top = down.source_pixel(glam::DVec2::new(30.5, 90.0 - 20.5), k);
        assert!((from_top.x - from_bottom.x).abs() + (100.0 - from_top.y - from_bottom.y).abs() < 1e-9);
    }

    let behind = view([3.0, 1.6, -20.0], [1.5, 0.0, 0.0], SIZE);
    let nowhere = view([f32::NAN, 0.0, 0.0], [0.0; 3], SIZE);
    let mistakes: &Mistakes<YoroPoses> = &[
        (&|p| p.target = &behind, YORO_ERROR_VALUE),
        (&|p| p.source = &nowhere, YORO_ERROR_VALUE),
        (&|p| p.near_z = 50.0, YORO_ERROR_VALUE),
        (&|p| p.depth = 2, YORO_ERROR_VALUE),
        (&|p| p.rows = 2, YORO_ERROR_VALUE),
        (&|p| p.reserved = 1, YORO_ERROR_VALUE),
        (&|p| p.target = null(), YORO_ERROR_NULL),
        (&|p| p.struct_size = 8, YORO_ERROR_STRUCT_SIZE),
    ];
    let good = poses(&source, &target, YORO_ROWS_UP);
    check_codes(&good, mistakes, |poses| warp_of(poses).unwrap_err());
}

#[test]
fn the_guarded_view_is_the_cores() {
    let own = view([1.0, 1.6, 2.0], [0.1, 0.05, 0.0], SIZE);
    let expected = HeadMotion { rotation: 0.1, translation: 0.02 }.guarded(&core(&own), 0.5).unwrap();
    let mut motion: YoroHeadMotion = zeroed(|m: &mut YoroHeadMotion| &mut m.struct_size);
    (motion.rotation, motion.translation, motion.nearest) = (0.1, 0.02, 0.5);
    (motion.near_z, motion.far_z, motion.depth) = (RANGE.near, RANGE.far, YORO_DEPTH_REVERSED);
    (motion.clip, motion.view) = (YORO_CLIP_VULKAN, &own);
    let of = |motion: &YoroHeadMotion| {
        let mut guarded: YoroGuardedView = zeroed(|g: &mut YoroGuardedView| &mut g.struct_size);
        // SAFETY: complete structures, and what is refused.
        outcome(unsafe { yoro_guarded_view(motion, &mut guarded) }, guarded)
    };
    let up = of(&motion).unwrap();
    let down = of(&YoroHeadMotion { rows: YORO_ROWS_DOWN, ..motion }).unwrap();
    assert_eq!([up.crop_x, up.crop_y], expected.crop);
    assert_eq!([down.crop_x, down.crop_y], expected.crop_from_top(SIZE));
    for guarded in [up, down] {
        assert_eq!([guarded.view.width, guarded.view.height], expected.view.size);
        let want = expected.view.vulkan_projection().to_cols_array();
        let off = guarded.view.projection.iter().zip(want).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(off < 1e-5, "{:?}, {want:?}", guarded.view.projection);
    }
    assert_eq!(of(&YoroHeadMotion { translation: 0.6, ..motion }), Err(YORO_ERROR_VALUE));
    assert_eq!(of(&YoroHeadMotion { nearest: f32::NAN, ..motion }), Err(YORO_ERROR_VALUE));
    assert_eq!(of(&YoroHeadMotion { clip: 3, ..motion }), Err(YORO_ERROR_VALUE));
    assert_eq!(of(&YoroHeadMotion { view: null(), ..motion }), Err(YORO_ERROR_NULL));
}

#[test]
fn a_context_of_any_pose_takes_pose_warps_alone() {
    let headless = Headless::open(Backend::Egl).unwrap();
    let mut noted = Vec::new();
    let info =
        YoroGlInfo { outputs: YORO_OUTPUT_DEPTH, warp_kind: YORO_WARP_KIND_POSE, ..gl_info(&mut noted) };
    let source = view([0.0, 1.6, 0.0], [0.0; 3], [140, 100]);
    let target = view([0.03, 1.62, -0.1], [0.03, 0.02, 0.05], SIZE);
    let warp = warp_of(&poses(&source, &target, YORO_ROWS_UP)).unwrap();
    assert_eq!(create(&YoroGlInfo { warp_kind: 3, ..info }), Err(YORO_ERROR_VALUE));
    let context = create(&info).unwrap();
    let given = images(headless.gl().raw(), glow::RGBA8, [140, 100], SIZE);
    let views = views_of(&good_eyes()).unwrap();
    // SAFETY: complete structures, a live, current context, and checks are on.
    unsafe {
        assert_eq!(yoro_gl_prepare_pose(context, &warp), YORO_OK);
        assert_eq!(yoro_gl_synthesize_pose(context, &warp, &given), YORO_OK, "{noted:?}");
        assert_eq!(yoro_gl_synthesize(context, &views.warp, &given), YORO_ERROR_VALUE);
        assert_eq!(yoro_gl_prepare(context, &views.warp), YORO_ERROR_VALUE);
        let mut bytes = 0;
        assert_eq!(yoro_gl_buffer_bytes(&info, &views.warp, &mut bytes), YORO_ERROR_VALUE);
        assert_eq!(yoro_gl_synthesize_pose(context, null(), &given), YORO_ERROR_NULL);
        let part = YoroGlImages { source_x: 1, ..given };
        assert_eq!(yoro_gl_synthesize_pose(context, &warp, &part), YORO_ERROR_VALUE);
        let mut noted = Vec::new();
        let eyes = create(&gl_info(&mut noted)).unwrap();
        assert_eq!(yoro_gl_synthesize_pose(eyes, &warp, &given), YORO_ERROR_VALUE);
        assert_eq!(yoro_gl_prepare_pose(eyes, &warp), YORO_ERROR_VALUE);
        assert_eq!(yoro_destroy(eyes), YORO_OK);

        // Random numbers instead of those of the warp.
        let damage = (0..26usize, prop_oneof![any::<f64>(), Just(f64::NAN), Just(1e30), Just(0.0)]);
        let config = Config { cases: 400, failure_persistence: None, ..Config::default() };
        let words = size_of::<YoroPoseWarp>() / 8;
        TestRunner::new(config)
            .run(&damage, |(word, number)| {
                let mut damaged = warp;
                // The sizes stay: for other sizes the textures would be refused.
                (&raw mut damaged).cast::<f64>().add(2 + word % (words - 2)).write(number);
                let code = yoro_gl_synthesize_pose(context, &damaged, &given);
                assert!([YORO_OK, YORO_ERROR_VALUE].contains(&code), "{word}, {number}: {code}");
                Ok(())
            })
            .unwrap();
        let none = YoroPoseWarp { target_width: 0, ..warp };
        assert_eq!(yoro_gl_synthesize_pose(context, &none, &given), YORO_ERROR_VALUE);
        assert_eq!(yoro_destroy(context), YORO_OK);
    }
}
