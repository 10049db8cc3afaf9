//! Motion vectors of the other eye: the maps are the core's.

mod common;

use std::ptr::{null, null_mut};

use common::{core, create, gl_info, good_eyes, images, motion_of as warps, views_of, zeroed};
use yoro::eyes::{GuardBand, MotionWarp, Ndc, VectorSpace, VectorsOf};
use yoro_c::*;
use yoro_context::{Backend, Headless};

fn previous_eyes() -> YoroEyes {
    let mut eyes = good_eyes();
    for (pose, side) in eyes.poses.iter_mut().zip([-0.5, 0.5]) {
        pose.position = [0.066 * side, 1.58, 0.04];
    }
    eyes
}

fn the_cores(eyes: &YoroEyes, previous: &YoroEyes, space: VectorSpace) -> [MotionWarp; 2] {
    let [now, then] =
        [eyes, previous].map(|eyes| core(eyes).synthesis_views(GuardBand::Distance(1.0)).unwrap());
    [now.motion(&then, space).unwrap(), now.own_motion(&then, space).unwrap()]
}

#[test]
fn the_law_is_the_cores() {
    let (eyes, previous) = (good_eyes(), previous_eyes());
    for (clip, ndc) in [(YORO_CLIP_OPENGL, Ndc::MinusOneToOne), (YORO_CLIP_VULKAN, Ndc::ZeroToOne)] {
        let [eyes, previous] = [YoroEyes { clip, ..eyes }, YoroEyes { clip, ..previous }];
        let got = warps(&eyes, &previous, YORO_VECTORS_EYE).unwrap();
        let space = VectorSpace { ndc, of: VectorsOf::Eye };
        for (got, want) in got.iter().zip(the_cores(&eyes, &previous, space)) {
            let law = want.law;
            assert_eq!([got.per_z, got.per_depth, got.constant], [law.per_z, law.per_depth, law.constant]);
            assert_eq!(
                [got.warp.source_width, got.warp.target_height],
                [want.warp.source_size[0], want.warp.target_size[1]]
            );
        }
        assert!(got[0].per_z != 0.0 && got[0].per_depth != 0.0 && got[1].per_z == 0.0);
    }
    assert_eq!(warps(&eyes, &previous, 2).err(), Some(YORO_ERROR_VALUE));
    // Another guard band: the rendered view's coordinates have changed.
    let wider = YoroEyes { guard_band: 0.3, ..previous };
    assert_eq!(warps(&eyes, &wider, YORO_VECTORS_SOURCE).err(), Some(YORO_ERROR_VALUE));
    assert!(warps(&eyes, &wider, YORO_VECTORS_EYE).is_ok());
    let mut motion: YoroMotion = zeroed(|m: &mut YoroMotion| &mut m.struct_size);
    // SAFETY: what is refused.
    assert_eq!(unsafe { yoro_motion_warp(&motion, null_mut(), null_mut()) }, YORO_ERROR_NULL);
    motion.struct_size = 4;
    // SAFETY: as above.
    assert_eq!(unsafe { yoro_motion_warp(&motion, null_mut(), null_mut()) }, YORO_ERROR_STRUCT_SIZE);
}

#[test]
fn a_context_of_motion_takes_motion_warps_alone() {
    let headless = Headless::open(Backend::Egl).unwrap();
    let mut noted = Vec::new();
    let kind = YORO_WARP_KIND_MOTION;
    let info = YoroGlInfo { outputs: YORO_OUTPUT_DEPTH, warp_kind: kind, ..gl_info(&mut noted) };
    let eyes = good_eyes();
    let [warp, _] = warps(&eyes, &previous_eyes(), YORO_VECTORS_EYE).unwrap();
    let source_size = [warp.warp.source_width, warp.warp.source_height];
    let target_size = [warp.warp.target_width, warp.warp.target_height];
    let images = images(headless.gl().raw(), glow::RGBA16F, source_size, target_size);
    let context = create(&info).unwrap();
    // SAFETY: complete structures, a live, current context, and checks are on.
    unsafe {
        // Once it is prepared, a frame allocates nothing: the buffers stay as they are.
        let buffers = || {
            let mut capabilities: YoroCapabilities = zeroed(|c: &mut YoroCapabilities| &mut c.struct_size);
            assert_eq!(yoro_capabilities(context, &mut capabilities), YORO_OK);
            capabilities.buffer_bytes
        };
        assert_eq!(yoro_gl_prepare_motion(context, &warp), YORO_OK, "{noted:?}");
        let (prepared, mut bytes) = (buffers(), 0);
        assert_eq!(yoro_gl_buffer_bytes(&info, &warp.warp, &mut bytes), YORO_OK);
        assert_eq!(prepared, bytes);
        assert_eq!(yoro_gl_prepare(context, &warp.warp), YORO_ERROR_VALUE);
        assert_eq!(yoro_gl_prepare_motion(context, null()), YORO_ERROR_NULL);
        assert_eq!(yoro_gl_synthesize_motion(context, &warp, &images), YORO_OK, "{noted:?}");
        assert_eq!(buffers(), prepared);
        let views = views_of(&eyes).unwrap();
        assert_eq!(yoro_gl_synthesize(context, &views.warp, &images), YORO_ERROR_VALUE);
        assert_eq!(yoro_gl_synthesize_motion(context, null(), &images), YORO_ERROR_NULL);
        for damaged in [
            YoroMotionWarp { per_z: f64::NAN, ..warp },
            YoroMotionWarp { vectors: 7, ..warp },
            YoroMotionWarp { reserved: 1, ..warp },
            YoroMotionWarp { warp: YoroWarp { target_width: 0, ..warp.warp }, ..warp },
        ] {
            assert_eq!(yoro_gl_synthesize_motion(context, &damaged, &images), YORO_ERROR_VALUE);
        }
        assert_eq!(yoro_destroy(context), YORO_OK);
    }
}
