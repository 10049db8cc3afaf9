use glam::{DVec3, Quat, Vec3};
use rand::{Rng, SeedableRng};

use super::super::{DepthRange, EyeOptions, MEAN_IPD, View};
use super::*;

/// The fields of view of headsets: outer, inner, upper and lower angle in degrees, by how far each eye is turned outwards,
/// and the size of an eye's image.
const HEADSETS: [([f32; 4], f32, [u32; 2]); 4] = [
    ([45.0, 45.0, 45.0, 45.0], 0.0, [512, 512]),
    ([52.0, 42.0, 48.0, 50.0], 0.0, [680, 700]),
    ([54.0, 40.0, 44.0, 53.0], 0.0, [600, 640]),
    ([55.0, 42.0, 52.0, 52.0], 5.0, [640, 720]),
];

const GUARD: GuardBand = GuardBand::Distance(1.0);

/// Returns the eyes of a headset, and the same eyes made parallel.
fn headset(([outer, inner, up, down], cant, size): ([f32; 4], f32, [u32; 2]), dominant: Eye) -> [EyePair; 2] {
    let head = Quat::from_euler(glam::EulerRot::YXZ, 0.4, -0.2, 0.1);
    let angles = |left: f32, right: f32| {
        let [left, right, up, down] = [-left, right, up, -down].map(f32::to_radians);
        Frustum::from_fov(left, right, up, down)
    };
    let poses = Eye::BOTH.map(|eye| Pose {
        position: head * Vec3::new(eye.side() * MEAN_IPD / 2.0, 0.0, 0.0) + Vec3::new(3.0, 1.6, -2.0),
        orientation: head * Quat::from_rotation_y(-eye.side() * cant.to_radians()),
    });
    let frusta = [angles(outer, inner), angles(inner, outer)];
    let eyes = EyePair { poses, frusta, depth: DepthRange::PAPER, size, dominant };
    [eyes, if cant == 0.0 { eyes } else { eyes.rectified().unwrap() }]
}

/// Returns the tangents at which a pose sees a point, if it is before it.
fn seen(pose: &Pose, point: DVec3) -> [f64; 2] {
    let own = pose.orientation.as_dquat().inverse() * (point - pose.position.as_dvec3());
    assert!(own.z < 0.0);
    [own.x / -own.z, own.y / -own.z]
}

fn contains(frustum: &Frustum, [x, y]: [f64; 2]) -> bool {
    let inside = |low: f32, at: f64, high: f32| f64::from(low) - 1e-5 <= at && at <= f64::from(high) + 1e-5;
    inside(frustum.left, x, frustum.right) && inside(frustum.bottom, y, frustum.top)
}

/// Checks the rule about where full density must lie: whatever either eye sees within an angle of its gaze, at the
/// distance `nearest` or farther, is in the inset of that eye, and in the inset that is rendered.
fn full_density_is_where_it_is_seen(
    eyes: &EyePair,
    levels: &StereoViews,
    gaze: [Vec3; 2],
    angle: f32,
    what: &str,
) {
    let inset = levels.inset.unwrap();
    let nearest = f64::from(Foveation::MEDIUM.nearest);
    let mut rng = rand_pcg::Pcg32::seed_from_u64(7);
    let mut checked = 0;
    for eye in Eye::BOTH {
        let (pose, own) = (&eyes.poses[eye.index()], &eyes.frusta[eye.index()]);
        let axis = gaze[eye.index()].as_dvec3().normalize();
        let aside = axis.any_orthonormal_vector();
        for i in 0..400 {
            // The border of the fovea matters most.
            let off = f64::from(angle) * if i % 2 == 0 { 1.0 } else { rng.random_range(0.0f64..1.0).sqrt() };
            let around = glam::DQuat::from_axis_angle(axis, rng.random_range(0.0..std::f64::consts::TAU));
            let direction = around * (axis * off.cos() + aside * off.sin());
            let along = direction.dot(pose.forward().as_dvec3());
            let z = if i % 3 == 0 { nearest } else { nearest / rng.random_range(1e-4..1.0) };
            // The distance that counts is the one along the axis of the eyes that are synthesized.
            let ahead = direction.dot(levels.shown.poses[0].forward().as_dvec3());
            if along <= 0.1 || ahead <= 0.1 {
                continue;
            }
            let point = pose.position.as_dvec3() + direction * (z / ahead);
            if !contains(own, seen(pose, point)) {
                continue;
            }
            checked += 1;
            let in_level = seen(&inset.eyes.poses[eye.index()], point);
            assert!(contains(&inset.eyes.frusta[eye.index()], in_level), "{what}, {eye:?}: {in_level:?}");
            let source = &inset.synthesis_views(GUARD).unwrap().source;
            assert!(contains(&source.frustum, seen(&source.pose, point)), "{what}, {eye:?}, {z} m");
        }
    }
    assert!(checked > 300, "{what}: {checked}");
}

#[test]
fn full_density_lies_around_each_eyes_axis() {
    for dominant in Eye::BOTH {
        for (i, rig) in HEADSETS.into_iter().enumerate() {
            for level in [FoveationLevel::Medium, FoveationLevel::High] {
                let [eyes, parallel] = headset(rig, dominant);
                let foveation = level.foveation().unwrap();
                let gaze = Gaze::Axes(eyes.axes());
                let levels = parallel.stereo_views(Some(&foveation), gaze).unwrap();
                let what = format!("headset {i}, {dominant:?}, {level:?}");
                full_density_is_where_it_is_seen(&eyes, &levels, eyes.axes(), foveation.radius, &what);
            }
        }
    }
}

/// The band must be no wider than what the nearest surface needs.
#[test]
fn the_band_of_the_inset_is_what_the_nearest_surface_needs() {
    let [eyes, _] = headset(HEADSETS[0], Eye::Right);
    let gaze = Gaze::Axes(eyes.axes());
    let levels = eyes.stereo_views(Some(&Foveation::MEDIUM), gaze).unwrap();
    let inset = levels.inset.unwrap();
    // 2 tan 20° of 2 tan 45° of 512 pixels, from pixel to pixel.
    assert_eq!(inset.eyes.size, [188, 188]);
    let columns = 256.0 * MEAN_IPD / 0.5;
    assert_eq!(inset.synthesis_views(GUARD).unwrap().source.size, [188 + columns.ceil() as u32 + 1, 188]);
    assert_eq!(levels.wide.eyes.size, [256, 256]);
    let whole = EyePair { size: [256, 256], ..eyes };
    assert_eq!(levels.wide.synthesis_views(GUARD), whole.synthesis_views(GUARD));
    // The pixels of the inset are pixels of the eye's image.
    for eye in Eye::BOTH {
        let place = levels.composition(eye).inset.unwrap().place;
        for axis in 0..2 {
            assert!((place.scale[axis] * 188.0 / 512.0 - 1.0).abs() < 1e-6, "{place:?}");
            let corner = -place.offset[axis] * 188.0;
            assert!((corner - corner.round()).abs() < 1e-3, "{place:?}");
        }
    }
}

/// A gaze wanders over and beyond all that the eyes see. No size changes, and around it is full density.
#[test]
fn a_gaze_that_moves_changes_no_size() {
    let foveation = Foveation { fade: 0.03, ..Foveation::MEDIUM };
    for dominant in Eye::BOTH {
        for (i, rig) in HEADSETS.into_iter().enumerate() {
            let [_, eyes] = headset(rig, dominant);
            let levels = |direction: Vec3| {
                let gaze = Gaze::Direction(eyes.poses[0].orientation * direction);
                eyes.stereo_views(Some(&foveation), gaze).unwrap()
            };
            let sizes = |levels: &StereoViews| {
                let inset = levels.inset.unwrap();
                let sources =
                    [levels.wide, inset].map(|layer| layer.synthesis_views(GUARD).unwrap().source.size);
                [sources[0], inset.eyes.size, sources[1]]
            };
            let first = levels(Vec3::NEG_Z);
            let mut rng = rand_pcg::Pcg32::seed_from_u64(3);
            for _ in 0..200 {
                let [x, y] = [0, 1].map(|_| rng.random_range(-2.0f32..2.0));
                let here = levels(Vec3::new(x, y, -1.0));
                let what = format!("headset {i}, {dominant:?}, gaze {x} {y}");
                assert_eq!(sizes(&here), sizes(&first), "{what}");
                let off = x.hypot(y).atan();
                if off < 0.6 {
                    let gaze = [eyes.poses[0].orientation * Vec3::new(x, y, -1.0); 2];
                    let angle = (off.tan() + foveation.radius.tan()).atan() - off;
                    full_density_is_where_it_is_seen(&eyes, &here, gaze, angle, &what);
                }
            }
            for lost in [Vec3::ZERO, Vec3::splat(f32::NAN), Vec3::Z, Vec3::new(f32::INFINITY, 0.0, -1.0)] {
                assert_eq!(sizes(&levels(lost)), sizes(&first), "headset {i}: {lost}");
            }
        }
    }
}

/// The insets of a runtime that tracks both eyes: they converge on a point, and the source keeps its size.
#[test]
fn insets_that_converge_need_no_more_columns() {
    let nearest = 0.5;
    for dominant in Eye::BOTH {
        let eyes = EyeOptions { dominant, size: [300, 200], ..EyeOptions::default() }.pair(Pose::IDENTITY);
        let at = |z: f32| {
            let frusta = Eye::BOTH.map(|eye| {
                let x = 0.1 - eye.side() * MEAN_IPD / 2.0 / z;
                Frustum { left: x - 0.3, right: x + 0.3, bottom: -0.2, top: 0.2 }
            });
            EyePair { frusta, ..eyes }.inset_views(nearest).unwrap()
        };
        let far = at(1e9);
        for z in [0.5, 0.51, 0.6, 0.77, 1.0, 1.9, 5.0, 300.0] {
            let here = at(z);
            assert_eq!((here.source.size, here.target.size), (far.source.size, [300, 200]), "{z} m");
            // What the other eye shows at either border, at the nearest distance and infinitely far away, is rendered.
            let (s, t) = (here.source.frustum, here.target.frustum);
            for shift in [0.0, MEAN_IPD / nearest] {
                let shift = -dominant.side() * shift;
                assert!(s.left <= t.left + shift.min(0.0) + 1e-4 || shift > 0.0, "{z} m");
                assert!(s.left - 1e-4 <= t.left + shift, "{z} m, {dominant:?}: {s:?} {t:?}");
                assert!(s.right + 1e-4 >= t.right + shift, "{z} m, {dominant:?}: {s:?} {t:?}");
            }
        }
        let band = eyes.synthesis_views(GuardBand::Distance(nearest)).unwrap();
        let own = eyes.inset_views(nearest).unwrap();
        assert_eq!(own.source.size[0], band.source.size[0] + 1, "one column for frusta between columns");
    }
}

#[test]
fn one_level_is_what_is_rendered_today() {
    let [eyes, _] = headset(HEADSETS[1], Eye::Left);
    let gaze = Gaze::Axes(eyes.axes());
    let off = eyes.stereo_views(FoveationLevel::Off.foveation().as_ref(), gaze).unwrap();
    assert_eq!((off.wide.eyes, off.inset), (eyes, None));
    assert_eq!(off.wide.synthesis_views(GUARD), eyes.synthesis_views(GUARD));
    for eye in Eye::BOTH {
        let place = LevelPlace { size: eyes.size, scale: [1.0; 2], offset: [0.0; 2] };
        assert_eq!(off.composition(eye), Composition { size: eyes.size, wide: place, inset: None });
    }
    // An inset that would be nearly the whole view saves nothing.
    let narrow = EyeOptions::default().pair(Pose::IDENTITY);
    let low = FoveationLevel::Low.foveation();
    assert_eq!(narrow.stereo_views(low.as_ref(), Gaze::Axes(narrow.axes())).unwrap().inset, None);
}

/// Rows that fall between the rows of the coarser level are aligned anew.
#[test]
fn eyes_with_shifted_rows_have_levels() {
    let mut eyes = EyeOptions { fov_y: 1.6, ..EyeOptions::default() }.pair(Pose::IDENTITY);
    let row = eyes.frusta[0].height() / eyes.size[1] as f32;
    eyes.frusta[1].bottom += 3.0 * row;
    eyes.frusta[1].top += 3.0 * row;
    let gaze = Gaze::Axes(eyes.axes());
    let levels = eyes.stereo_views(Some(&Foveation::MEDIUM), gaze).unwrap();
    full_density_is_where_it_is_seen(&eyes, &levels, eyes.axes(), Foveation::MEDIUM.radius, "rows");
    for eye in Eye::BOTH {
        let wide = levels.composition(eye).wide;
        let corners = [0.0, 1.0].map(|p| wide.scale[1] * p + wide.offset[1]);
        assert!(
            corners[0] >= -1e-5 && corners[1] <= 1.0 + 1e-5 && corners[1] - corners[0] > 0.98,
            "{wide:?}"
        );
        let turned = wide.rows_from_top();
        assert!(
            (turned.scale[1] * 0.25 + turned.offset[1] - (1.0 - (wide.scale[1] * 0.75 + wide.offset[1])))
                .abs()
                < 1e-12
        );
    }
}

/// The place of a surface in the source, from its place in the synthesized inset, agrees with the matrices.
#[test]
fn the_source_of_a_pixel_is_where_the_matrices_put_it() {
    for dominant in Eye::BOTH {
        let [eyes, _] = headset(HEADSETS[1], dominant);
        let levels = eyes.stereo_views(Some(&Foveation::MEDIUM), Gaze::Axes(eyes.axes())).unwrap();
        assert_eq!(levels.composition(dominant).inset.unwrap().source, None);
        let [across, offset, scale] = levels.composition(dominant.other()).inset.unwrap().source.unwrap();
        let views = levels.inset.unwrap().synthesis_views(GUARD).unwrap();
        let ndc = |view: &View, point: DVec3| {
            let clip = view.view_projection().as_dmat4() * point.extend(1.0);
            clip.truncate() / clip.w
        };
        for (x, z) in [(-0.2, 0.3), (0.0, 0.5), (0.3, 2.0), (-0.35, 100.0)] {
            let pose = eyes.poses[0];
            let point = pose.position + pose.orientation * Vec3::new(x * z, 0.1 * z, -z);
            let (there, here) = (ndc(&views.source, point.as_dvec3()), ndc(&views.target, point.as_dvec3()));
            let got = across * (here.x * 0.5 + 0.5) + offset + scale * (here.z * 0.5 + 0.5);
            assert!((got - there.x).abs() < 1e-3, "{dominant:?}, {z} m: {got} for {}", there.x);
        }
    }
}

#[test]
fn impossible_foveations_are_refused() {
    let eyes = EyeOptions::default().pair(Pose::IDENTITY);
    let own = Foveation::MEDIUM;
    for foveation in [
        Foveation { radius: 0.0, ..own },
        Foveation { radius: f32::NAN, ..own },
        Foveation { radius: 1.4, ..own },
        Foveation { fade: -0.1, ..own },
        Foveation { fade: 1.3, ..own },
        Foveation { density: 0.0, ..own },
        Foveation { density: 1.5, ..own },
        Foveation { nearest: 0.0, ..own },
        Foveation { nearest: f32::INFINITY, ..own },
    ] {
        let error = eyes.stereo_views(Some(&foveation), Gaze::Axes(eyes.axes())).unwrap_err();
        assert_eq!(error, EyesError::Foveation, "{foveation:?}");
    }
}

/// Canted eyes have layers, though neither eye can be synthesized from the other.
#[test]
fn canted_eyes_have_layers() {
    let [canted, _] = headset(HEADSETS[3], Eye::Left);
    let views = canted.stereo_views(Some(&Foveation::MEDIUM), Gaze::Axes(canted.axes())).unwrap();
    for layer in views.layers() {
        let error = layer.synthesis_views(GUARD).unwrap_err();
        assert!(matches!(error, EyesError::Canted { .. }), "{error}");
    }
    assert_eq!(views.composition(Eye::Right).inset.unwrap().source, None);
}
