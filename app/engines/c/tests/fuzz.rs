//! Random and special numbers, names of other objects, other contexts and other threads: whatever a host does with checks,
//! it gets a documented result, and nothing that is not finite.

mod common;

use std::ptr::{null, null_mut};

use common::{
    Random, create, framebuffer, gl_info, good_eyes, images, is_documented, levels_of, matrices_of, medium,
    motion_of, outcome, pose_warp_of, texture, views_of, views_of_matrices, zeroed,
};
use glow::HasContext as _;
use yoro_c::*;
use yoro_context::{Backend, Headless};

const PURE_CALLS: usize = 100_000;
const GL_CALLS: usize = 12_000;

/// Structures that are right, and make warps of all kinds.
struct Good {
    eyes: YoroEyes,
    foveation: YoroFoveation,
    view: YoroView,
}

impl Good {
    fn new() -> Good {
        let eyes = good_eyes();
        let view = YoroView {
            width: 120,
            height: 90,
            pose: eyes.poses[1],
            fov: eyes.fovs[1],
            ..YoroView::default()
        };
        Good { eyes, foveation: medium(), view }
    }
}

fn warp_between(poses: &YoroPoses, source: &YoroView, target: &YoroView) -> Result<YoroPoseWarp, YoroResult> {
    pose_warp_of(&YoroPoses { source, target, messages: good_eyes().messages, ..*poses })
}

fn good_poses(eyes: &YoroEyes) -> YoroPoses {
    let mut poses: YoroPoses = zeroed(|p: &mut YoroPoses| &mut p.struct_size);
    (poses.near_z, poses.far_z) = (eyes.near_z, eyes.far_z);
    poses
}

/// Returns numbers of a result that must be finite, or nothing for a documented error.
fn numbers<T>(outcome: Result<T, YoroResult>, of: impl FnOnce(T) -> Vec<f64>) -> Vec<f64> {
    outcome.map(of).unwrap_or_else(|code| {
        assert!(is_documented(code), "{code}");
        Vec::new()
    })
}

fn of_views(views: &YoroViews) -> Vec<f64> {
    assert!(views.source.width <= 1 << 17 && views.source.width >= views.rendered.width);
    let each = [&views.source, &views.rendered, &views.synthesized].into_iter();
    let matrices = each.flat_map(|view| view.view.into_iter().chain(view.projection)).map(f64::from);
    matrices.chain([views.warp.offset, views.warp.scale]).collect()
}

#[test]
fn damaged_numbers_are_refused_or_make_sense() {
    let (good, mut random) = (Good::new(), Random(1));
    let matrices = matrices_of(&views_of(&good.eyes).unwrap(), &good.eyes);
    let poses = good_poses(&good.eyes);
    let mut accepted = 0;
    for call in 0..PURE_CALLS {
        // The size at the beginning is another test's, and messages stay null.
        let eyes = YoroEyes { messages: good.eyes.messages, ..random.damaged(&good.eyes, 4) };
        let found = match random.below(6) {
            0 => numbers(views_of(&eyes), |views| of_views(&views)),
            1 => {
                let damaged = random.damaged(&matrices, 4);
                let matrices = YoroMatrices { messages: good.eyes.messages, ..damaged };
                numbers(views_of_matrices(&matrices), |views| of_views(&views))
            }
            2 => {
                let foveation = random.damaged(&good.foveation, 4);
                numbers(levels_of(&eyes, &foveation), |(views, compositions)| {
                    let wide = of_views(&views[0]).into_iter();
                    let own = compositions.into_iter().flat_map(|own| {
                        [own.wide_scale, own.inset_scale, own.inset_offset]
                            .concat()
                            .into_iter()
                            .chain(own.inset_source)
                    });
                    wide.chain(own).collect()
                })
            }
            3 => {
                let previous = YoroEyes { messages: good.eyes.messages, ..random.damaged(&good.eyes, 4) };
                let vectors = random.pick(&[YORO_VECTORS_EYE, YORO_VECTORS_SOURCE, 9]);
                numbers(motion_of(&eyes, &previous, vectors), |warps| {
                    warps.into_iter().flat_map(|warp| [warp.warp.offset, warp.warp.scale]).collect()
                })
            }
            4 => {
                let [source, target] = [0; 2].map(|_| random.damaged(&good.view, 0));
                let poses = random.damaged(&poses, 4);
                numbers(warp_between(&poses, &source, &target), |warp| {
                    warp.homography
                        .into_iter()
                        .chain(warp.epipole)
                        .chain(warp.source_law)
                        .chain(warp.target_law)
                        .collect()
                })
            }
            _ => {
                let view = random.damaged(&good.view, 0);
                let mut motion: YoroHeadMotion = zeroed(|m: &mut YoroHeadMotion| &mut m.struct_size);
                (motion.rotation, motion.translation, motion.nearest) = (0.1, 0.02, 0.5);
                (motion.near_z, motion.far_z) = (0.1, 100.0);
                let damaged = random.damaged(&motion, 4);
                let motion = YoroHeadMotion { view: &view, messages: motion.messages, ..damaged };
                let mut guarded: YoroGuardedView = zeroed(|g: &mut YoroGuardedView| &mut g.struct_size);
                // SAFETY: complete structures.
                let found = outcome(unsafe { yoro_guarded_view(&motion, &mut guarded) }, guarded.view);
                numbers(found, |view| view.view.into_iter().chain(view.projection).map(f64::from).collect())
            }
        };
        accepted += usize::from(!found.is_empty());
        assert!(found.iter().all(|number| number.is_finite()), "call {call}: {found:?}");
    }
    println!("{PURE_CALLS} calls, {accepted} accepted");
    assert!((PURE_CALLS / 10..PURE_CALLS * 9 / 10).contains(&accepted), "{accepted}");
}

/// What crosses to another thread is used by one thread at a time.
struct Sent<T>(T);

// SAFETY: the sender waits for the other thread.
unsafe impl<T> Send for Sent<T> {}

impl<T: FnOnce() -> YoroResult> Sent<T> {
    fn run(self) -> YoroResult {
        (self.0)()
    }
}

/// The names that a host may confuse: right and wrong textures, a renderbuffer, and framebuffers.
fn names(gl: &glow::Context, good: &YoroGlImages, size: [u32; 2]) -> [Vec<u32>; 2] {
    // SAFETY: the context is current, and everything is its own.
    unsafe {
        let plane = |format, size| texture(gl, glow::TEXTURE_2D, format, size);
        let small = plane(glow::RGBA8, [8, 8]);
        let integers = plane(glow::RGBA8UI, size);
        let array = texture(gl, glow::TEXTURE_2D_ARRAY, glow::RGBA8, size);
        let samples = texture(gl, glow::TEXTURE_2D_MULTISAMPLE, glow::DEPTH_COMPONENT24, size);
        let renderbuffer = gl.create_renderbuffer().unwrap().0.get();
        let own = framebuffer(gl, &[(glow::COLOR_ATTACHMENT0, good.color_texture)]);
        let flat = framebuffer(gl, &[(glow::COLOR_ATTACHMENT0, small)]);
        let textures = vec![
            good.color_texture,
            good.depth_texture,
            small,
            integers,
            array,
            samples,
            renderbuffer,
            plane(glow::R32F, size),
            0,
            4_000_000,
        ];
        [textures, vec![good.framebuffer, own, flat, 0, 4_000_000]]
    }
}

#[test]
fn an_opengl_host_may_do_anything_with_checks() {
    let headless = Headless::open(Backend::Egl).unwrap();
    let gl = headless.gl().raw();
    let (good, mut random, mut noted) = (Good::new(), Random(2), Vec::new());
    let views = views_of(&good.eyes).unwrap();
    let [motion, _] = motion_of(&good.eyes, &good.eyes, YORO_VECTORS_EYE).unwrap();
    let target = YoroView { pose: YoroPose { position: [0.04, 1.6, 0.0], ..good.view.pose }, ..good.view };
    let source = YoroView { width: views.source.width, height: views.source.height, ..good.view };
    let pose = warp_between(&good_poses(&good.eyes), &source, &target).unwrap();
    let size = [source.width, source.height];
    let right = images(gl, glow::RGBA16F, size, [160, 120]);
    let [textures, framebuffers] = names(gl, &right, size);
    let (_, [composition, _]) = levels_of(&good.eyes, &good.foveation).unwrap();
    let mut levels: YoroGlLevels = zeroed(|l: &mut YoroGlLevels| &mut l.struct_size);
    (levels.wide_texture, levels.inset_texture, levels.framebuffer) =
        (right.color_texture, right.color_texture, right.framebuffer);
    (levels.wide_image_width, levels.wide_image_height) = (size[0], size[1]);
    (levels.inset_image_width, levels.inset_image_height) = (size[0], size[1]);
    let info = YoroGlInfo { outputs: YORO_OUTPUT_DEPTH, composes: 1, ..gl_info(&mut noted) };
    let kinds = [YORO_WARP_KIND_EYES, YORO_WARP_KIND_POSE, YORO_WARP_KIND_MOTION];
    let contexts = kinds.map(|warp_kind| create(&YoroGlInfo { warp_kind, ..info }).unwrap());
    let mut accepted = 0;
    for number in 0..GL_CALLS {
        let context = random.pick(&contexts);
        let (eyes, pose, motion) =
            (random.damaged(&views.warp, 0), random.damaged(&pose, 0), random.damaged(&motion, 0));
        let (composition, mut levels) = (random.damaged(&composition, 0), random.damaged(&levels, 0));
        let mut images = random.damaged(&right, 0);
        for _ in 0..random.below(3) {
            let (texture, framebuffer) = (random.pick(&textures), random.pick(&framebuffers));
            match random.below(5) {
                0 => images.color_texture = texture,
                1 => images.depth_texture = texture,
                2 => (images.framebuffer, levels.framebuffer) = (framebuffer, framebuffer),
                3 => levels.wide_texture = texture,
                _ => levels.inset_texture = texture,
            }
        }
        let which = random.below(11);
        // SAFETY: a live context, complete structures, and checks are on.
        let call = move || unsafe {
            let mut capabilities: YoroCapabilities = zeroed(|c: &mut YoroCapabilities| &mut c.struct_size);
            match which {
                0 | 1 => yoro_gl_synthesize(context, &eyes, &images),
                2 => yoro_gl_synthesize_pose(context, &pose, &images),
                3 => yoro_gl_synthesize_motion(context, &motion, &images),
                4 => yoro_gl_prepare(context, &eyes),
                5 => yoro_gl_prepare_pose(context, &pose),
                6 => yoro_gl_prepare_motion(context, &motion),
                7 | 8 => yoro_gl_compose(context, &composition, &levels),
                9 => yoro_capabilities(context, &mut capabilities),
                _ => yoro_gl_synthesize(context, null(), null()),
            }
        };
        let code = if random.below(40) == 0 {
            let call = Sent(call);
            std::thread::scope(|scope| scope.spawn(move || call.run()).join().unwrap())
        } else {
            call()
        };
        assert!(is_documented(code), "call {number}, {which}: {code}");
        assert_eq!(
            headless.gl().take_errors().map(|errors| errors.to_string()),
            None,
            "call {number}, {which}"
        );
        accepted += usize::from(code == YORO_OK);
    }
    println!("{GL_CALLS} calls, {accepted} accepted");
    assert!((GL_CALLS / 10..GL_CALLS * 9 / 10).contains(&accepted), "{accepted}");
    // What is right is still accepted.
    // SAFETY: live contexts, complete structures, and checks are on.
    unsafe {
        assert_eq!(yoro_gl_synthesize(contexts[0], &views.warp, &right), YORO_OK);
        assert_eq!(yoro_gl_synthesize_motion(contexts[2], &motion, &right), YORO_OK);
        assert!(contexts.into_iter().all(|context| yoro_destroy(context) == YORO_OK));
        assert_eq!(yoro_destroy(null_mut()), YORO_OK);
    }
}
