//! Eyes in large worlds, and eyes that need the flags.

mod common;

use common::{gl_info, good_eyes, left_handed, matrices_of, messages, views_of, views_of_matrices};
use glam::{DMat4, DQuat, DVec3, EulerRot};
use yoro_c::*;
use yoro_context::{Backend, Headless};

/// Returns view matrices in f32, as engines compute them, for a head at this distance in metres from the origin.
fn far_matrices(distance: f64, turn: f64, ipd: f64) -> YoroMatrices {
    let eyes = good_eyes();
    let mut matrices = matrices_of(&views_of(&eyes).unwrap(), &eyes);
    let orientation = DQuat::from_euler(EulerRot::YXZ, turn * 0.7, 0.3, 0.1).as_quat();
    let head = DQuat::from_rotation_y(turn) * DVec3::new(distance, 1.6, 0.0);
    for (i, view) in matrices.view.iter_mut().enumerate() {
        let place = head.as_vec3() + orientation * glam::Vec3::X * (ipd as f32 * (i as f32 - 0.5));
        *view = glam::Mat4::from_rotation_translation(orientation, place).inverse().to_cols_array();
    }
    matrices
}

#[test]
fn matrices_far_from_the_origin_are_not_refused() {
    let scale = |matrices: &YoroMatrices| views_of_matrices(matrices).map(|views| views.warp.scale);
    let expected = scale(&far_matrices(0.0, 0.0, 0.064)).unwrap();
    for distance in [500.0, 1500.0, 4000.0, 8000.0] {
        for turn in 0..500 {
            let got = scale(&far_matrices(distance, f64::from(turn), 0.064));
            let got = got.unwrap_or_else(|code| panic!("{distance} m, {turn}: {code}"));
            // Four roundings, relative to the distance between the eyes.
            let rounding = 4.0 * distance * f64::from(f32::EPSILON) / 0.064;
            assert!((got / expected - 1.0).abs() < rounding, "{distance} m: {got} {expected}");
        }
    }
    // An error larger than rounding is refused at any distance.
    for distance in [0.0, 1500.0] {
        let mut matrices = far_matrices(distance, 3.0, 0.064);
        matrices.view[0][13] += 0.004;
        assert_eq!(views_of_matrices(&matrices).map(drop), Err(YORO_ERROR_EYES_OFF_AXIS), "{distance} m");
    }
}

/// Returns the normalized device coordinates of a point of the world.
fn project(view: &[f32; 16], projection: &[f32; 16], point: DVec3) -> DVec3 {
    let matrix = |m: &[f32; 16]| DMat4::from_cols_array(&m.map(f64::from));
    let clip = matrix(projection) * matrix(view) * point.extend(1.0);
    clip.truncate() / clip.w
}

/// The eyes of a calibrated headset: canted, and one of them a third of a millimetre higher. In a right-handed world,
/// and in a left-handed one in centimetres with eyes that look along +Z.
#[test]
fn flags_turn_the_matrices_of_canted_and_displaced_eyes() {
    let mut eyes = good_eyes();
    for (i, side) in [(0, 1.0), (1, -1.0)] {
        eyes.poses[i].orientation = DQuat::from_rotation_y(side * 0.05).as_quat().to_array();
        eyes.poses[i].position[1] += 0.0003 * i as f32;
    }
    let mut matrices = matrices_of(&views_of(&good_eyes()).unwrap(), &eyes);
    for (view, pose) in matrices.view.iter_mut().zip(&eyes.poses) {
        let orientation = glam::Quat::from_array(pose.orientation);
        let placed = glam::Mat4::from_rotation_translation(orientation, pose.position.into());
        *view = placed.inverse().to_cols_array();
    }
    for (matrices, mirror, unit) in [(matrices, 1.0, 1.0), (left_handed(matrices), -1.0, 100.0)] {
        let mut noted = Vec::new();
        let given = YoroMatrices { messages: messages(&mut noted), ..matrices };
        assert_eq!(views_of_matrices(&given).map(drop), Err(YORO_ERROR_EYES_CANTED));
        assert!(noted[0].1.ends_with("(YORO_EYES_PARALLEL)"), "{noted:?}");
        let views = views_of_matrices(&YoroMatrices { flags: YORO_EYES_PARALLEL, ..given }).unwrap();
        let expected = views_of(&YoroEyes { flags: YORO_EYES_PARALLEL, ..eyes }).unwrap();
        assert!((views.warp.scale - expected.warp.scale).abs() < 0.01 && views.crop_x == expected.crop_x);
        // A point of the world appears where poses and angles put it, and moves as the warp says.
        for point in [DVec3::new(0.1, 1.5, -1.2), DVec3::new(-0.6, 2.0, -4.0)] {
            let in_world = point * unit * DVec3::new(1.0, 1.0, mirror);
            for (own, other) in
                [(&views.source, &expected.source), (&views.synthesized, &expected.synthesized)]
            {
                let seen = project(&own.view, &own.projection, in_world);
                let wanted = project(&other.view, &other.projection, point);
                assert!((seen - wanted).truncate().length() < 1e-5, "{seen} {wanted}");
            }
        }
    }
    assert_eq!(views_of_matrices(&YoroMatrices { flags: 8, ..matrices }).map(drop), Err(YORO_ERROR_VALUE));
    // A third of a millimetre without canting has the same remedy.
    let mut displaced = good_eyes();
    displaced.poses[1].position[1] += 0.0003;
    assert_eq!(views_of(&displaced).map(drop), Err(YORO_ERROR_EYES_OFF_AXIS));
    displaced.flags = YORO_EYES_PARALLEL;
    views_of(&displaced).unwrap();
}

/// For every near plane that is accepted, the warp is accepted too.
#[test]
fn the_warp_of_accepted_eyes_is_accepted() {
    let _headless = Headless::open(Backend::Egl).unwrap();
    let (mut noted, mut context) = (Vec::new(), std::ptr::null_mut());
    let info = gl_info(&mut noted);
    // SAFETY: a complete structure, and the context is current.
    assert_eq!(unsafe { yoro_gl_create(&info, &mut context) }, YORO_OK);
    let mut eyes = good_eyes();
    (eyes.width, eyes.height) = (2064, 8);
    let mut accepted = 0;
    for exponent in 0..60 {
        eyes.near_z = 10f32.powf(-0.1 * exponent as f32);
        let Ok(views) = views_of(&eyes) else { continue };
        accepted += 1;
        // SAFETY: a live context.
        let code = unsafe { yoro_gl_prepare(context, &views.warp) };
        assert_eq!(code, YORO_OK, "near plane at {} m: {noted:?}", eyes.near_z);
    }
    assert!(accepted > 30, "a millimetre and less: {accepted}");
    // SAFETY: alive.
    assert_eq!(unsafe { yoro_destroy(context) }, YORO_OK);
}

#[test]
fn sentences_name_what_is_wrong() {
    let sentence = |change: &dyn Fn(&mut YoroEyes)| {
        let (mut noted, mut eyes) = (Vec::new(), good_eyes());
        change(&mut eyes);
        eyes.messages = messages(&mut noted);
        assert_eq!(views_of(&eyes).map(drop), Err(YORO_ERROR_VALUE));
        noted.remove(0).1
    };
    assert!(sentence(&|e| e.width = 0).contains("width or height"));
    assert!(sentence(&|e| e.near_z = 0.0).contains("depth planes"));
    let guard_band = sentence(&|e| e.guard_band = -1.0);
    assert!(guard_band.starts_with("guard_band") && !guard_band.contains("px"), "{guard_band}");
    assert!(sentence(&|e| e.reserved = 5).contains("reserved"));
}
