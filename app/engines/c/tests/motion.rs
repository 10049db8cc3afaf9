//! Motion vectors of the other eye: laws and pictures are the core's.

mod common;

use std::num::NonZeroU32;
use std::ptr::{null, null_mut};

use common::{framebuffer, gl_info, good_eyes, texture, views_of, zeroed};
use glow::HasContext;
use yoro::eyes::{DepthConvention, DepthRange, EyePair, Frustum, GuardBand, MotionWarp, Ndc, Pose};
use yoro::eyes::{Eye, VectorSpace, VectorsOf};
use yoro::opengl::{Destination, Motion, Options, Outputs, Source};
use yoro_c::*;
use yoro_context::{Backend, Headless};

fn former_eyes() -> YoroEyes {
    let mut eyes = good_eyes();
    for (pose, side) in eyes.poses.iter_mut().zip([-0.5, 0.5]) {
        pose.position = [0.066 * side, 1.58, 0.04];
    }
    eyes
}

fn core(eyes: &YoroEyes) -> EyePair {
    let depth = DepthRange { near: eyes.near_z, far: eyes.far_z, convention: DepthConvention::Standard };
    let fov = |f: YoroFov| Frustum::from_fov(f.angle_left, f.angle_right, f.angle_up, f.angle_down);
    let pose = |p: YoroPose| Pose {
        position: p.position.into(),
        orientation: glam::Quat::from_array(p.orientation),
    };
    let size = [eyes.width, eyes.height];
    EyePair { poses: eyes.poses.map(pose), frusta: eyes.fovs.map(fov), depth, size, dominant: Eye::Right }
}

/// Returns the warps to the other eye and to the rendered one.
fn warps(
    eyes: &YoroEyes,
    former: &YoroEyes,
    vectors: YoroVectors,
) -> Result<[YoroMotionWarp; 2], YoroResult> {
    let mut motion: YoroMotion = zeroed(|m: &mut YoroMotion| &mut m.struct_size);
    (motion.eyes, motion.former, motion.vectors) = (eyes, former, vectors);
    let mut warps = [YoroMotionWarp::default(); 2];
    let [other, own] = &mut warps;
    // SAFETY: complete structures, and what is refused.
    match unsafe { yoro_motion_warp(&motion, other, own) } {
        YORO_OK => Ok(warps),
        code => Err(code),
    }
}

fn the_cores(eyes: &YoroEyes, former: &YoroEyes, space: VectorSpace) -> [MotionWarp; 2] {
    let [now, then] =
        [eyes, former].map(|eyes| core(eyes).synthesis_views(GuardBand::Distance(1.0)).unwrap());
    [now.motion(&then, space).unwrap(), now.own_motion(&then, space).unwrap()]
}

#[test]
fn the_law_is_the_cores() {
    let (eyes, former) = (good_eyes(), former_eyes());
    for (vectors, of, clip, ndc) in [
        (YORO_VECTORS_EYE, VectorsOf::Eye, YORO_CLIP_OPENGL, Ndc::MinusOneToOne),
        (YORO_VECTORS_EYE, VectorsOf::Eye, YORO_CLIP_VULKAN, Ndc::ZeroToOne),
    ] {
        let [eyes, former] = [YoroEyes { clip, ..eyes }, YoroEyes { clip, ..former }];
        let got = warps(&eyes, &former, vectors).unwrap();
        for (got, want) in got.iter().zip(the_cores(&eyes, &former, VectorSpace { ndc, of })) {
            assert_eq!([got.per_z, got.per_depth, got.constant], {
                let law = want.law;
                [law.per_z, law.per_depth, law.constant]
            });
            assert_eq!(
                [got.warp.source_width, got.warp.target_height],
                [want.warp.source_size[0], want.warp.target_size[1]]
            );
        }
        assert!(got[0].per_z != 0.0 && got[0].per_depth != 0.0 && got[1].per_z == 0.0);
    }
    assert_eq!(warps(&eyes, &former, 2).err(), Some(YORO_ERROR_VALUE));
    // Another guard band: the rendered view's coordinates have changed.
    let wider = YoroEyes { guard_band: 0.3, ..former };
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
fn the_vectors_on_opengl_are_the_cores() {
    let headless = Headless::open(Backend::Egl).unwrap();
    let gl = headless.gl().raw();
    let mut noted = Vec::new();
    let kind = YORO_WARP_KIND_MOTION;
    let info = YoroGlInfo { outputs: YORO_OUTPUT_DEPTH, warp_kind: kind, ..gl_info(&mut noted) };
    let (eyes, former) = (good_eyes(), former_eyes());
    let [warp, _] = warps(&eyes, &former, YORO_VECTORS_EYE).unwrap();
    let space = VectorSpace { ndc: Ndc::MinusOneToOne, of: VectorsOf::Eye };
    let [core_warp, _] = the_cores(&eyes, &former, space);
    let (source_size, size) = (core_warp.warp.source_size, core_warp.warp.target_size);
    // SAFETY: complete structures, a live, current context whose objects these are, and checks are on.
    unsafe {
        let image = |size| {
            let color = texture(gl, glow::TEXTURE_2D, glow::RGBA16F, size);
            let depth = texture(gl, glow::TEXTURE_2D, glow::DEPTH_COMPONENT24, size);
            let attachments = [(glow::COLOR_ATTACHMENT0, color), (glow::DEPTH_ATTACHMENT, depth)];
            (color, depth, framebuffer(gl, &attachments))
        };
        let name = |name| NonZeroU32::new(name).map(glow::NativeFramebuffer);
        let source = image(source_size);
        gl.bind_framebuffer(glow::FRAMEBUFFER, name(source.2));
        gl.clear_color(0.25, -0.125, 0.5, 1.0);
        gl.clear_depth_f32(0.9);
        gl.clear(glow::COLOR_BUFFER_BIT | glow::DEPTH_BUFFER_BIT);
        let [mine, cores] = [image(size).2, image(size).2];
        let mut images: YoroGlImages = zeroed(|i: &mut YoroGlImages| &mut i.struct_size);
        (images.color_texture, images.depth_texture, images.framebuffer) = (source.0, source.1, mine);
        let mut context = null_mut();
        assert_eq!(yoro_gl_create(&info, &mut context), YORO_OK, "{noted:?}");
        assert_eq!(yoro_gl_synthesize_motion(context, &warp, &images), YORO_OK, "{noted:?}");
        let mut passes =
            Motion::new(headless.gl(), &Options::default(), Outputs { depth: true, ..Outputs::default() })
                .unwrap();
        let texture = |name| glow::NativeTexture(NonZeroU32::new(name).unwrap());
        let place = Destination { framebuffer: name(cores), origin: [0, 0], size };
        passes.synthesize(Source::new(texture(source.0), texture(source.1)), &core_warp, &place).unwrap();
        let read = |framebuffer| {
            let mut pixels = vec![0f32; size[0] as usize * size[1] as usize * 4];
            gl.bind_framebuffer(glow::FRAMEBUFFER, name(framebuffer));
            let bytes = bytemuck::cast_slice_mut(&mut pixels);
            let data = glow::PixelPackData::Slice(Some(bytes));
            gl.read_pixels(0, 0, size[0] as i32, size[1] as i32, glow::RGBA, glow::FLOAT, data);
            pixels
        };
        let got = read(mine);
        assert!(got == read(cores));
        let want = core_warp.vector([0.25, -0.125, 0.5], f64::from(0.9f32));
        assert!((0..3).all(|c| (f64::from(got[c]) - want[c]).abs() < 1e-3), "{:?}, {want:?}", &got[..3]);

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
