//! Histories on OpenGL: the wall behind a box has a colour that only the history has.

mod common;

use std::num::NonZeroU32;
use std::ptr::{null, null_mut};

use common::{framebuffer, gl_info, good_eyes, messages, texture, views_of, zeroed};
use glow::HasContext;
use yoro_c::*;
use yoro_context::{Backend, Headless};

const SIZE: [u32; 2] = [160, 120];
/// Depth values of the wall and of the box in front of it.
const WALL: f32 = 0.98;
const BOX: f32 = 0.9;

/// Fills the rectangle [x, y, width, height] with colour and depth.
unsafe fn fill(gl: &glow::Context, target: u32, [x, y, w, h]: [i32; 4], [r, g, b]: [f32; 3], depth: f32) {
    // SAFETY: the context is current, and the framebuffer is its own.
    unsafe {
        gl.bind_framebuffer(glow::FRAMEBUFFER, NonZeroU32::new(target).map(glow::NativeFramebuffer));
        gl.enable(glow::SCISSOR_TEST);
        gl.scissor(x, y, w, h);
        gl.clear_color(r, g, b, 1.0);
        gl.clear_depth_f32(depth);
        gl.clear(glow::COLOR_BUFFER_BIT | glow::DEPTH_BUFFER_BIT);
        gl.disable(glow::SCISSOR_TEST);
    }
}

/// Returns the names of a colour texture, a depth texture, and a framebuffer of both.
unsafe fn image(gl: &glow::Context, size: [u32; 2]) -> [u32; 3] {
    // SAFETY: the context is current.
    unsafe {
        let color = texture(gl, glow::TEXTURE_2D, glow::RGBA8, size);
        let depth = texture(gl, glow::TEXTURE_2D, glow::DEPTH_COMPONENT24, size);
        let attachments = [(glow::COLOR_ATTACHMENT0, color), (glow::DEPTH_ATTACHMENT, depth)];
        [color, depth, framebuffer(gl, &attachments)]
    }
}

fn history(
    eyes: &YoroEyes,
    strips: &[*const YoroView],
    noted: &mut Vec<(YoroResult, String)>,
) -> YoroHistory {
    let mut history: YoroHistory = zeroed(|h: &mut YoroHistory| &mut h.struct_size);
    history.count = strips.len() as u32;
    history.strips[..strips.len()].copy_from_slice(strips);
    (history.near_z, history.far_z) = (eyes.near_z, eyes.far_z);
    (history.depth, history.rows, history.messages) = (eyes.depth, eyes.rows, messages(noted));
    history
}

fn strips_of(history: &YoroHistory, synthesized: &YoroView) -> Result<YoroStrips, YoroResult> {
    let mut strips = YoroStrips { to_history: [[0.0; 16]; YORO_MOST_STRIPS], count: 0, reserved: [0; 3] };
    // SAFETY: complete structures.
    match unsafe { yoro_strips(history, synthesized, &mut strips) } {
        YORO_OK => Ok(strips),
        code => Err(code),
    }
}

#[test]
fn what_is_uncovered_shows_the_history() {
    let headless = Headless::open(Backend::Egl).unwrap();
    let gl = headless.gl().raw();
    let eyes = good_eyes();
    let views = views_of(&eyes).unwrap();
    let mut noted = Vec::new();
    let mut info = gl_info(&mut noted);
    info.history = 1;
    let mut context = null_mut();
    // SAFETY: complete structures, a live, current context, and checks are on.
    unsafe {
        assert_eq!(yoro_gl_create(&info, &mut context), YORO_OK, "{noted:?}");
        let [w, h] = [views.source.width, views.source.height].map(|n| n as i32);
        let source = image(gl, [w as u32, h as u32]);
        fill(gl, source[2], [0, 0, w, h], [0.0, 1.0, 0.0], WALL);
        fill(gl, source[2], [w / 2 - 20, 0, 40, h], [1.0, 0.0, 0.0], BOX);
        let former = image(gl, SIZE);
        fill(gl, former[2], [0, 0, 160, 120], [0.0, 0.0, 1.0], WALL);
        let target = image(gl, SIZE);
        let mut images: YoroGlImages = zeroed(|i: &mut YoroGlImages| &mut i.struct_size);
        [images.color_texture, images.depth_texture, _] = source;
        images.framebuffer = target[2];
        [images.history_color_texture, images.history_depth_texture, _] = former;
        // Counts the blue pixels in the lower and in the upper half.
        let blue = |strips: *const YoroStrips| {
            let images = YoroGlImages { strips, ..images };
            assert_eq!(yoro_gl_synthesize(context, &views.warp, &images), YORO_OK);
            let mut pixels = vec![0u8; 160 * 120 * 4];
            gl.bind_framebuffer(
                glow::FRAMEBUFFER,
                Some(glow::NativeFramebuffer(NonZeroU32::new(target[2]).unwrap())),
            );
            let data = glow::PixelPackData::Slice(Some(&mut pixels));
            gl.read_pixels(0, 0, 160, 120, glow::RGBA, glow::UNSIGNED_BYTE, data);
            let count = |half: &[u8]| half.chunks_exact(4).filter(|pixel| pixel[2] > 200).count();
            let (lower, upper) = pixels.split_at(pixels.len() / 2);
            [count(lower), count(upper)]
        };
        assert_eq!(blue(null()), [0, 0]);
        let view: *const YoroView = &views.synthesized;
        let mut noted = Vec::new();
        let whole = strips_of(&history(&eyes, &[view], &mut noted), &views.synthesized).unwrap();
        // 63 mm * 77.7 pixels * (1 / 0.99 m - 1 / 4.77 m) are 3.9 columns.
        assert_eq!(blue(&whole), [4 * 60; 2]);
        let half = strips_of(&history(&eyes, &[null(), view], &mut noted), &views.synthesized).unwrap();
        assert_eq!(blue(&half), [0, 4 * 60], "strips are counted from row 0");
        assert!(noted.is_empty(), "{noted:?}");

        let with = |change: &dyn Fn(&mut YoroGlImages)| {
            let mut changed = YoroGlImages { strips: &whole, ..images };
            change(&mut changed);
            yoro_gl_synthesize(context, &views.warp, &changed)
        };
        assert_eq!(with(&|i| i.history_depth_texture = 0), YORO_ERROR_VALUE);
        assert_eq!(with(&|i| i.history_depth_texture = former[0]), YORO_ERROR_FORMAT);
        assert_eq!(with(&|i| i.history_color_texture = target[0]), YORO_ERROR_FORMAT);
        let made_up = YoroStrips { count: 9, ..whole };
        assert_eq!(with(&|i| i.strips = &made_up), YORO_ERROR_VALUE);
        assert_eq!(yoro_destroy(context), YORO_OK);
        // A context without a history.
        let mut noted = Vec::new();
        assert_eq!(
            yoro_gl_create(&YoroGlInfo { history: 2, ..gl_info(&mut noted) }, &mut context),
            YORO_ERROR_VALUE
        );
        assert_eq!(yoro_gl_create(&gl_info(&mut noted), &mut context), YORO_OK);
        images.strips = &whole;
        assert_eq!(yoro_gl_synthesize(context, &views.warp, &images), YORO_ERROR_VALUE);
        assert_eq!(yoro_destroy(context), YORO_OK);
    }
}

#[test]
fn strips_of_rows_from_the_top_are_those_of_rows_from_the_bottom_turned() {
    let mut eyes = good_eyes();
    eyes.fovs.iter_mut().for_each(|fov| fov.angle_down = -0.4);
    let views = views_of(&eyes).unwrap();
    let mut former = YoroView { width: 80, height: 60, ..views.synthesized };
    former.pose.position[1] += 0.1;
    let mut noted = Vec::new();
    let mut of = |rows| {
        let mut history = history(&eyes, &[null(), &former], &mut noted);
        history.rows = rows;
        strips_of(&history, &views.synthesized).unwrap()
    };
    let [up, down] = [YORO_ROWS_UP, YORO_ROWS_DOWN].map(&mut of);
    assert_eq!((up.count, up.to_history[0], down.to_history[0]), (2, [0.0; 16], [0.0; 16]));
    let at = |strips: &YoroStrips, y: f32| {
        glam::Mat4::from_cols_array(&strips.to_history[1]).project_point3(glam::vec3(50.5, y, 0.95))
    };
    for y in [10.5, 60.0, 101.5] {
        let (from_bottom, from_top) = (at(&up, y), at(&down, 120.0 - y));
        let turned = glam::vec3(from_top.x, 60.0 - from_top.y, from_top.z);
        assert!((from_bottom - turned).length() < 1e-3, "{from_bottom}, {turned}");
    }
}

#[test]
fn impossible_histories_are_refused() {
    let eyes = good_eyes();
    let views = views_of(&eyes).unwrap();
    let small = YoroView { width: 80, height: 60, ..views.synthesized };
    let mut nowhere = views.synthesized;
    nowhere.pose.position[0] = f32::NAN;
    let mut noted = Vec::new();
    let good = history(&eyes, &[&views.synthesized, &small], &mut noted);
    let with = |change: &dyn Fn(&mut YoroHistory)| {
        let mut changed = good;
        changed.count = 1;
        change(&mut changed);
        strips_of(&changed, &views.synthesized).map(|strips| strips.count)
    };
    assert_eq!(with(&|_| ()), Ok(1));
    assert_eq!(with(&|h| h.count = 2), Err(YORO_ERROR_VALUE), "of two sizes");
    assert_eq!(with(&|h| h.count = 0), Err(YORO_ERROR_VALUE));
    assert_eq!(with(&|h| h.count = 9), Err(YORO_ERROR_VALUE));
    assert_eq!(with(&|h| h.near_z = 200.0), Err(YORO_ERROR_VALUE));
    assert_eq!(with(&|h| h.depth = 2), Err(YORO_ERROR_VALUE));
    assert_eq!(with(&|h| h.rows = 2), Err(YORO_ERROR_VALUE));
    assert_eq!(with(&|h| h.strips[0] = &nowhere), Err(YORO_ERROR_VALUE));
    assert_eq!(with(&|h| h.struct_size = 8), Err(YORO_ERROR_STRUCT_SIZE));
    // SAFETY: null pointers, which are refused.
    unsafe {
        assert_eq!(yoro_strips(&good, null(), null_mut()), YORO_ERROR_NULL);
        assert_eq!(yoro_strips(null(), &views.synthesized, null_mut()), YORO_ERROR_NULL);
    }
}
