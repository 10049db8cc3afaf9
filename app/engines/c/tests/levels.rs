//! The levels of a foveated view, and their composition: those of the core.

mod common;

use common::{core, create, framebuffer, gl_info, good_eyes, levels_of, medium, texture, zeroed};
use yoro::eyes::{Eye, FoveationLevel, Gaze, GuardBand};
use yoro_c::*;
use yoro_context::{Backend, Headless};

/// Eyes whose insets are much smaller than their images.
fn wide_eyes() -> YoroEyes {
    let mut eyes = good_eyes();
    for fov in &mut eyes.fovs {
        *fov = YoroFov { angle_left: -0.8, angle_right: 0.85, angle_up: 0.7, angle_down: -0.75 };
    }
    eyes
}

#[test]
fn levels_are_the_cores_with_rows_from_either_end() {
    let own = wide_eyes();
    let pair = core(&own);
    let gaze = glam::Vec3::new(0.2, -0.1, -1.0);
    let foveation = FoveationLevel::Medium.foveation();
    let tracked = YoroFoveation { tracked: 1, gaze: gaze.to_array(), ..medium() };
    for (given, gaze) in [(medium(), Gaze::Axes(pair.axes())), (tracked, Gaze::Direction(gaze))] {
        let core = pair.stereo_views(foveation.as_ref(), gaze).unwrap();
        for rows in [YORO_ROWS_UP, YORO_ROWS_DOWN] {
            let ([wide, inset], compositions) = levels_of(&YoroEyes { rows, ..own }, &given).unwrap();
            for (views, level) in [(&wide, core.wide), (&inset, core.inset.unwrap())] {
                let core = level.synthesis_views(GuardBand::Distance(1.0)).unwrap();
                assert_eq!([views.source.width, views.source.height], core.source.size);
                assert_eq!([views.rendered.width, views.rendered.height], level.eyes.size);
                let crop = match rows {
                    YORO_ROWS_UP => core.dominant_crop,
                    _ => core.dominant_crop_from_top(),
                };
                assert_eq!([views.crop_x, views.crop_y], crop);
                assert!((views.source.fov.angle_left.tan() - core.source.frustum.left).abs() < 1e-5);
                assert!((views.source.fov.angle_up.tan() - core.source.frustum.top).abs() < 1e-5);
                assert!((views.warp.offset - core.warp.law.offset).abs() < 1e-3);
            }
            for (eye, own) in Eye::BOTH.into_iter().zip(compositions) {
                let core = core.composition(eye);
                let core = if rows == YORO_ROWS_DOWN { core.rows_from_top() } else { core };
                let inset = core.inset.unwrap();
                assert_eq!(
                    ([own.width, own.height], [own.wide_width, own.wide_height]),
                    (core.size, core.wide.size)
                );
                assert_eq!([own.inset_width, own.inset_height], inset.place.size);
                assert_eq!((own.inset_scale, own.inset_offset), (inset.place.scale, inset.place.offset));
                assert_eq!(own.inset_source, inset.source.unwrap_or_default());
            }
        }
    }
    let off = YoroFoveation { level: YORO_FOVEATION_OFF, ..medium() };
    let ([wide, inset], compositions) = levels_of(&own, &off).unwrap();
    assert_eq!((Ok(wide), inset.source.width), (common::views_of(&own), 0));
    assert_eq!(compositions[0].inset_width, 0);
    for wrong in [
        YoroFoveation { level: 4, ..medium() },
        YoroFoveation { tracked: 2, ..medium() },
        YoroFoveation { density: 2.0, ..medium() },
        YoroFoveation { fade: f32::NAN, ..medium() },
    ] {
        assert_eq!(levels_of(&own, &wrong).map(drop), Err(YORO_ERROR_VALUE), "{wrong:?}");
    }
    assert_eq!(
        levels_of(&own, &YoroFoveation { struct_size: 4, ..medium() }).map(drop),
        Err(YORO_ERROR_STRUCT_SIZE)
    );
}

#[test]
fn wrong_compositions_return_their_codes() {
    let headless = Headless::open(Backend::Egl).unwrap();
    let gl = headless.gl().raw();
    let eyes = wide_eyes();
    let ([_, inset], compositions) = levels_of(&eyes, &medium()).unwrap();
    let own = compositions[YORO_EYE_RIGHT as usize];
    let mut noted = Vec::new();
    let info = YoroGlInfo { composes: 1, ..gl_info(&mut noted) };
    let context = create(&info).unwrap();
    let mut levels: YoroGlLevels = zeroed(|l: &mut YoroGlLevels| &mut l.struct_size);
    // SAFETY: complete structures, a live, current context, and checks are on.
    unsafe {
        let made = |size| texture(gl, glow::TEXTURE_2D, glow::RGBA8, size);
        levels.wide_texture = made([own.wide_width, own.wide_height]);
        let image = [inset.source.width, inset.source.height];
        levels.inset_texture = made(image);
        (levels.inset_x, levels.inset_y) = (inset.crop_x, inset.crop_y);
        (levels.inset_image_width, levels.inset_image_height) = (image[0], image[1]);
        let target = made([eyes.width, eyes.height]);
        levels.framebuffer = framebuffer(gl, &[(glow::COLOR_ATTACHMENT0, target)]);
        let compose = |own: &YoroComposition, levels: &YoroGlLevels| yoro_gl_compose(context, own, levels);
        assert_eq!(compose(&own, &levels), YORO_OK, "{noted:?}");

        let with = |change: &dyn Fn(&mut YoroComposition, &mut YoroGlLevels)| {
            let (mut own, mut levels) = (own, levels);
            change(&mut own, &mut levels);
            compose(&own, &levels)
        };
        assert_eq!(with(&|_, l| l.wide_texture = 0), YORO_ERROR_VALUE);
        assert_eq!(with(&|_, l| l.inset_x += 1000), YORO_ERROR_TOO_LARGE);
        assert_eq!(with(&|_, l| l.inset_texture = l.wide_texture), YORO_ERROR_FORMAT);
        assert!(noted.last().unwrap().1.ends_with("inset_image_width and inset_image_height"), "{noted:?}");
        assert_eq!(with(&|_, l| l.inset_depth_texture = l.inset_texture), YORO_ERROR_FORMAT);
        assert_eq!(with(&|_, l| l.wide_texture = target), YORO_ERROR_FORMAT);
        assert_eq!(with(&|c, _| c.width = 0), YORO_ERROR_VALUE);
        assert_eq!(with(&|c, _| c.inset_scale[0] = f64::NAN), YORO_ERROR_VALUE);
        assert_eq!(yoro_destroy(context), YORO_OK);
        let plain = create(&YoroGlInfo { composes: 0, ..info }).unwrap();
        assert_eq!(yoro_gl_compose(plain, &own, &levels), YORO_ERROR_UNSUPPORTED);
        assert_eq!(yoro_destroy(plain), YORO_OK);
    }
}
