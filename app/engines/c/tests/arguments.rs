//! Every kind of wrong argument returns the code that the header promises.

mod common;

use std::ffi::c_char;
use std::ptr::{null, null_mut};

use common::{
    Mistakes, check_codes, framebuffer, gl_info, good_eyes, left_handed, matrices_of, messages, texture,
    views_of, views_of_matrices, zeroed,
};
use glow::HasContext as _;
use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};
use yoro_c::*;
use yoro_context::{Backend, Headless};

#[test]
fn impossible_eyes_return_their_codes() {
    let nan = f32::NAN;
    let code_of = |eyes: &YoroEyes| {
        let mut noted = Vec::new();
        let code = views_of(&YoroEyes { messages: messages(&mut noted), ..*eyes }).unwrap_err();
        if code == YORO_ERROR_STRUCT_SIZE {
            assert!(noted.is_empty(), "nothing is known of such a structure");
        } else {
            assert_eq!(noted.len(), 1);
            assert_eq!(noted[0].0, code);
            assert!(noted[0].1.len() > 30, "{}", noted[0].1);
        }
        code
    };
    let table: &Mistakes<YoroEyes> = &[
        (&|e| e.struct_size = 0, YORO_ERROR_STRUCT_SIZE),
        (&|e| e.struct_size -= 1, YORO_ERROR_STRUCT_SIZE),
        (&|e| e.struct_size = u32::MAX, YORO_ERROR_STRUCT_SIZE),
        (&|e| e.rendered = 2, YORO_ERROR_VALUE),
        (&|e| e.width = 0, YORO_ERROR_VALUE),
        (&|e| e.height = 0, YORO_ERROR_VALUE),
        (&|e| e.width = u32::MAX, YORO_ERROR_TOO_LARGE),
        (&|e| e.poses[0].orientation = [0.0; 4], YORO_ERROR_VALUE),
        (&|e| e.poses[1].position[2] = nan, YORO_ERROR_VALUE),
        (&|e| e.poses[1].position[2] = f32::INFINITY, YORO_ERROR_VALUE),
        (&|e| e.fovs[0].angle_up = nan, YORO_ERROR_VALUE),
        (&|e| e.fovs[0].angle_up = 1.6, YORO_ERROR_VALUE),
        (&|e| e.fovs[0].angle_right = -0.9, YORO_ERROR_VALUE),
        (&|e| e.near_z = 0.0, YORO_ERROR_VALUE),
        (&|e| e.near_z = nan, YORO_ERROR_VALUE),
        (&|e| e.far_z = 0.05, YORO_ERROR_VALUE),
        (&|e| e.depth = 2, YORO_ERROR_VALUE),
        (&|e| e.rows = 2, YORO_ERROR_VALUE),
        (&|e| e.clip = 3, YORO_ERROR_VALUE),
        (&|e| e.guard_band = nan, YORO_ERROR_VALUE),
        (&|e| e.guard_band = -1.0, YORO_ERROR_VALUE),
        (&|e| e.flags = 4, YORO_ERROR_VALUE),
        (&|e| e.poses[0].orientation = [0.0, 0.1, 0.0, 0.995], YORO_ERROR_EYES_CANTED),
        (&|e| e.poses[0].position[1] = 1.5, YORO_ERROR_EYES_OFF_AXIS),
        (&|e| (e.poses[0].position[0], e.guard_band) = (-1e7, 0.0), YORO_ERROR_EYES_IPD),
        (&|e| e.poses.swap(0, 1), YORO_ERROR_EYES_IPD),
        (&|e| e.fovs[0].angle_left = -0.9, YORO_ERROR_EYES_DENSITY),
        (&|e| (e.fovs[0].angle_up, e.fovs[0].angle_down) = (0.61, -0.5897), YORO_ERROR_EYES_ROWS),
    ];
    let eyes = good_eyes();
    check_codes(&eyes, table, code_of);
    let mut views: YoroViews = zeroed(|v: &mut YoroViews| &mut v.struct_size);
    views.struct_size = 12;
    // SAFETY: null, or structures of at least the size that they state.
    unsafe {
        assert_eq!(yoro_views_from_eyes(null(), &mut views), YORO_ERROR_NULL);
        assert_eq!(yoro_views_from_eyes(&eyes, null_mut()), YORO_ERROR_NULL);
        assert_eq!(yoro_views_from_eyes(&eyes, &mut views), YORO_ERROR_STRUCT_SIZE);
        assert_eq!(yoro_views_from_matrices(null(), &mut views), YORO_ERROR_NULL);
    }
}

#[test]
fn flags_make_canted_and_uneven_eyes_usable() {
    let mut eyes = good_eyes();
    eyes.fovs[0].angle_left = -0.9;
    eyes.flags = YORO_EYES_EVEN;
    let views = views_of(&eyes).unwrap();
    assert_eq!(views.synthesized.fov.angle_right.max(0.8), views.synthesized.fov.angle_right);
    eyes.poses[0].orientation = [0.0, 0.05, 0.0, 0.998_749_2];
    assert_eq!(views_of(&eyes), Err(YORO_ERROR_EYES_CANTED));
    eyes.flags = YORO_EYES_PARALLEL;
    let views = views_of(&eyes).unwrap();
    assert_eq!(views.synthesized.pose.orientation, views.rendered.pose.orientation);
}

#[test]
fn impossible_matrices_return_their_codes() {
    let eyes = good_eyes();
    let good = matrices_of(&views_of(&eyes).unwrap(), &eyes);
    assert!(views_of_matrices(&good).is_ok());
    let code_of = |matrices: &YoroMatrices| {
        let mut noted = Vec::new();
        let given = YoroMatrices { messages: messages(&mut noted), ..*matrices };
        let code = views_of_matrices(&given).unwrap_err();
        assert_eq!(noted.len(), usize::from(code != YORO_ERROR_STRUCT_SIZE));
        code
    };
    let transposed = |m: [f32; 16]| std::array::from_fn(|i| m[i % 4 * 4 + i / 4]);
    let table: &Mistakes<YoroMatrices> = &[
        (&|m| m.struct_size = 3, YORO_ERROR_STRUCT_SIZE),
        (&|m| m.rendered = 9, YORO_ERROR_VALUE),
        (&|m| m.width = 0, YORO_ERROR_VALUE),
        (&|m| m.clip = 9, YORO_ERROR_VALUE),
        (&|m| m.rows = 9, YORO_ERROR_VALUE),
        (&|m| m.units_per_metre = -1.0, YORO_ERROR_VALUE),
        (&|m| m.units_per_metre = f32::NAN, YORO_ERROR_VALUE),
        (&|m| m.view = [[0.0; 16]; 2], YORO_ERROR_MATRIX),
        (&|m| m.projection = [[0.0; 16]; 2], YORO_ERROR_MATRIX),
        (&|m| m.projection[0][5] = f32::NAN, YORO_ERROR_MATRIX),
        (&|m| m.view[1][12] = f32::INFINITY, YORO_ERROR_MATRIX),
        (&|m| m.view[0].iter_mut().take(12).for_each(|n| *n *= 2.0), YORO_ERROR_MATRIX),
        (&|m| m.view = m.view.map(transposed), YORO_ERROR_MATRIX),
        (&|m| m.projection = m.projection.map(transposed), YORO_ERROR_MATRIX),
        // An orthographic projection.
        (&|m| (m.projection[0][11], m.projection[0][15]) = (0.0, 1.0), YORO_ERROR_MATRIX),
        // A projection for Vulkan, where y points down.
        (&|m| m.clip = YORO_CLIP_VULKAN, YORO_ERROR_MATRIX),
        // Different planes for one eye.
        (&|m| m.projection[0][14] *= 1.5, YORO_ERROR_MATRIX),
        // One eye left-handed.
        (&|m| m.view[0][..3].iter_mut().for_each(|n| *n = -*n), YORO_ERROR_MATRIX),
        (&|m| (m.view[0][12], m.guard_band) = (1e7, 0.0), YORO_ERROR_EYES_IPD),
        (&|m| m.view[0][13] += 0.01, YORO_ERROR_EYES_OFF_AXIS),
        (&|m| m.view.swap(0, 1), YORO_ERROR_EYES_IPD),
    ];
    check_codes(&good, table, code_of);
    // What is row-major as a whole is called so.
    let sentence = |change: &dyn Fn(&mut YoroMatrices)| {
        let mut noted = Vec::new();
        let mut matrices = YoroMatrices { messages: messages(&mut noted), ..good };
        change(&mut matrices);
        views_of_matrices(&matrices).unwrap_err();
        noted[0].1.contains("transpose")
    };
    assert!(sentence(&|m| m.view = m.view.map(transposed)));
    assert!(sentence(&|m| m.projection = m.projection.map(transposed)));
    assert!(!sentence(&|m| m.projection = [[0.0; 16]; 2]));
}

/// Generates eyes that can be synthesized, in all conventions.
fn any_eyes() -> impl Strategy<Value = YoroEyes> {
    let places = (-9f32..9.0, -9f32..9.0, -3f32..3.0, -1.4f32..1.4, 0.03f32..0.075);
    let angles = (0.3f32..1.0, 0.3f32..1.0, 0.3f32..1.0, 0.3f32..1.0);
    let depth = (0.05f32..0.5, prop_oneof![Just(f32::INFINITY), 20f32..2000.0], 0u32..2);
    let choices = (0u32..2, 0u32..2, 0u32..3, prop_oneof![Just(0f32), 0.5f32..4.0], 32u32..400, 32u32..400);
    (places, angles, depth, choices).prop_map(|(place, angles, depth, choice)| {
        let mut eyes = good_eyes();
        let turn = glam::Quat::from_euler(glam::EulerRot::YXZ, place.2, place.3, 0.3);
        for (i, (pose, fov)) in eyes.poses.iter_mut().zip(&mut eyes.fovs).enumerate() {
            let side = turn * glam::Vec3::X * (place.4 * (i as f32 - 0.5));
            let position = glam::Vec3::new(place.0, 1.6, place.1) + side;
            *pose = YoroPose { orientation: turn.to_array(), position: position.to_array() };
            let (outer, inner) = (angles.0, angles.1);
            let (left, right) = if i == 0 { (outer, inner) } else { (inner, outer) };
            *fov =
                YoroFov { angle_left: -left, angle_right: right, angle_up: angles.2, angle_down: -angles.3 };
        }
        (eyes.near_z, eyes.far_z, eyes.depth) = depth;
        (eyes.rendered, eyes.rows, eyes.clip, eyes.guard_band, eyes.width, eyes.height) = choice;
        eyes
    })
}

/// Returns the column and row in pixels, counted as `rows` says, and the depth value of a point in the world.
fn project(view: &YoroView, clip: YoroClip, rows: YoroRows, point: glam::DVec3) -> [f64; 3] {
    let matrix = |m: &[f32; 16]| glam::DMat4::from_cols_array(&m.map(f64::from));
    let projected = matrix(&view.projection) * matrix(&view.view) * point.extend(1.0);
    let ndc = projected / projected.w;
    let up = if clip == YORO_CLIP_VULKAN { -ndc.y } else { ndc.y };
    let depth = if clip == YORO_CLIP_OPENGL { 0.5 * ndc.z + 0.5 } else { ndc.z };
    let row = if rows == YORO_ROWS_UP { up } else { -up };
    [(0.5 * ndc.x + 0.5) * f64::from(view.width), (0.5 * row + 0.5) * f64::from(view.height), depth]
}

/// Checks that points which both eyes see land where the warp says, and that the rendered eye's image is the crop.
fn check_law(views: &YoroViews, clip: YoroClip, rows: YoroRows, points: &[glam::DVec3]) {
    for point in points {
        let [x, y, depth] = project(&views.source, clip, rows, *point);
        let [tx, ty, target_depth] = project(&views.synthesized, clip, rows, *point);
        let [rx, ry, _] = project(&views.rendered, clip, rows, *point);
        let moved = x + views.warp.offset + views.warp.scale * depth;
        assert!((moved - tx).abs() < 0.05, "{moved} {tx}");
        assert!((y + f64::from(views.warp.row_offset) - ty).abs() < 0.06, "{y} {ty}");
        assert!((depth - target_depth).abs() < 1e-4, "{depth} {target_depth}");
        let crop = [views.crop_x, views.crop_y].map(f64::from);
        assert!(
            (x - crop[0] - rx).abs() < 0.05 && (y - crop[1] - ry).abs() < 0.05,
            "{x} {y} {rx} {ry} {crop:?}"
        );
    }
}

fn points(eyes: &YoroEyes) -> Vec<glam::DVec3> {
    let turn = glam::Quat::from_array(eyes.poses[0].orientation);
    [[0.0, 0.0, -1.0], [0.2, -0.1, -0.8], [-0.5, 0.4, -3.0], [2.0, 1.0, -15.0]]
        .map(|p| (turn * glam::Vec3::from(p) + glam::Vec3::from(eyes.poses[0].position)).as_dvec3())
        .into()
}

#[test]
fn poses_and_matrices_give_the_same_views() {
    let mut runner = TestRunner::new(Config { cases: 400, failure_persistence: None, ..Config::default() });
    let law = |eyes: YoroEyes| {
        let views = views_of(&eyes).unwrap();
        check_law(&views, eyes.clip, eyes.rows, &points(&eyes));
        let matrices = matrices_of(&views, &eyes);
        let of_matrices = views_of_matrices(&matrices).unwrap();
        check_law(&of_matrices, eyes.clip, eyes.rows, &points(&eyes));
        // Rounding may add a pixel of guard band.
        assert!(views.source.width.abs_diff(of_matrices.source.width) <= 1);
        assert_eq!(views.warp.target_eye, of_matrices.warp.target_eye);
        assert_eq!(views.warp.depth, of_matrices.warp.depth);

        let left_handed = views_of_matrices(&left_handed(matrices)).unwrap();
        let mirrored: Vec<_> =
            points(&eyes).into_iter().map(|p| 100.0 * p * glam::DVec3::new(1.0, 1.0, -1.0)).collect();
        check_law(&left_handed, eyes.clip, eyes.rows, &mirrored);
        assert!((left_handed.warp.scale - of_matrices.warp.scale).abs() < 0.02);
    };
    runner
        .run(&any_eyes(), |eyes| {
            law(eyes);
            Ok(())
        })
        .unwrap();
}

unsafe extern "C" fn load_nothing(_: *const c_char) -> YoroGlProc {
    None
}

#[test]
fn impossible_contexts_return_their_codes() {
    let mut noted = Vec::new();
    let info = gl_info(&mut noted);
    let create = |info: &YoroGlInfo| {
        let mut context = std::ptr::dangling_mut();
        // SAFETY: a complete structure; nothing is current, or a context of the loader's.
        let code = unsafe { yoro_gl_create(info, &mut context) };
        assert_eq!(context.is_null(), code != YORO_OK);
        // SAFETY: null or just made.
        unsafe { yoro_destroy(context) };
        code
    };
    assert_eq!(create(&YoroGlInfo { struct_size: 5, ..info }), YORO_ERROR_STRUCT_SIZE);
    assert_eq!(create(&YoroGlInfo { composes: 2, ..info }), YORO_ERROR_VALUE);
    assert_eq!(create(&YoroGlInfo { outputs: 16, ..info }), YORO_ERROR_VALUE);
    for other in [YORO_OUTPUT_DEPTH, YORO_OUTPUT_OPEN_STENCIL] {
        let outputs = YORO_OUTPUT_OPEN_DEPTH | other;
        assert_eq!(create(&YoroGlInfo { outputs, ..info }), YORO_ERROR_VALUE);
    }
    assert_eq!(create(&YoroGlInfo { state: 2, ..info }), YORO_ERROR_VALUE);
    assert_eq!(create(&YoroGlInfo { check: 2, ..info }), YORO_ERROR_VALUE);
    assert_eq!(create(&YoroGlInfo { loader: None, ..info }), YORO_ERROR_NULL);
    assert_eq!(create(&YoroGlInfo { loader: Some(load_nothing), ..info }), YORO_ERROR_NO_CONTEXT);
    assert_eq!(create(&info), YORO_ERROR_NO_CONTEXT);
    // SAFETY: null pointers are allowed, and refused with a code.
    unsafe {
        assert_eq!(yoro_gl_create(null(), &mut null_mut()), YORO_ERROR_NULL);
        assert_eq!(yoro_gl_create(&info, null_mut()), YORO_ERROR_NULL);
        assert_eq!(yoro_gl_synthesize(null_mut(), null(), null()), YORO_ERROR_NULL);
        assert_eq!(yoro_capabilities(null_mut(), null_mut()), YORO_ERROR_NULL);
        assert_eq!(yoro_destroy(null_mut()), YORO_OK);
    }
    let _headless = Headless::open(Backend::Egl).unwrap();
    for outputs in [YORO_OUTPUT_DEPTH, YORO_OUTPUT_DEPTH | YORO_OUTPUT_OPEN_STENCIL, YORO_OUTPUT_OPEN_DEPTH] {
        assert_eq!(create(&YoroGlInfo { outputs, ..info }), YORO_OK);
    }
}

#[test]
fn wrong_images_return_their_codes() {
    let headless = Headless::open(Backend::Egl).unwrap();
    let gl = headless.gl().raw();
    let mut noted = Vec::new();
    let info = YoroGlInfo { outputs: YORO_OUTPUT_DEPTH, ..gl_info(&mut noted) };
    let mut context = null_mut();
    // SAFETY: a complete structure, and the context is current.
    assert_eq!(unsafe { yoro_gl_create(&info, &mut context) }, YORO_OK);
    let views = views_of(&good_eyes()).unwrap();
    let (size, target_size) = ([views.source.width, views.source.height], [160, 120]);
    let plane = |format, size| {
        // SAFETY: the context is current.
        unsafe { texture(gl, glow::TEXTURE_2D, format, size) }
    };
    let color = plane(glow::RGBA8, size);
    let depth = plane(glow::DEPTH_COMPONENT24, size);
    let (target, target_depth) =
        (plane(glow::RGBA8, target_size), plane(glow::DEPTH_COMPONENT24, target_size));
    // SAFETY: the context is current and the textures are its own.
    let (whole, own_color, own_depth, flat, array, samples) = unsafe {
        (
            framebuffer(gl, &[(glow::COLOR_ATTACHMENT0, target), (glow::DEPTH_ATTACHMENT, target_depth)]),
            framebuffer(gl, &[(glow::COLOR_ATTACHMENT0, color), (glow::DEPTH_ATTACHMENT, target_depth)]),
            framebuffer(gl, &[(glow::COLOR_ATTACHMENT0, target), (glow::DEPTH_ATTACHMENT, depth)]),
            framebuffer(gl, &[(glow::COLOR_ATTACHMENT0, target)]),
            texture(gl, glow::TEXTURE_2D_ARRAY, glow::RGBA8, size),
            texture(gl, glow::TEXTURE_2D_MULTISAMPLE, glow::DEPTH_COMPONENT24, size),
        )
    };
    let mut good: YoroGlImages = zeroed(|i: &mut YoroGlImages| &mut i.struct_size);
    (good.color_texture, good.depth_texture, good.framebuffer) = (color, depth, whole);
    let call = |warp: &YoroWarp, images: &YoroGlImages| {
        // SAFETY: a live context, complete structures, and checks are on.
        unsafe { yoro_gl_synthesize(context, warp, images) }
    };
    assert_eq!(call(&views.warp, &good), YORO_OK, "{noted:?}");
    let (red_float, red_16) = (plane(glow::R32F, size), plane(glow::R16, size));
    let table: &Mistakes<YoroGlImages> = &[
        (&|_| (), YORO_OK),
        (&|i| i.depth_texture = red_float, YORO_OK),
        (&|i| i.depth_texture = red_16, YORO_OK),
        (&|i| i.struct_size = 7, YORO_ERROR_STRUCT_SIZE),
        (&|i| i.color_texture = 0, YORO_ERROR_VALUE),
        (&|i| i.depth_texture = 0, YORO_ERROR_VALUE),
        (&|i| i.x = u32::MAX, YORO_ERROR_VALUE),
        (&|i| i.color_texture = 4_000_000, YORO_ERROR_FORMAT),
        (&|i| i.color_texture = array, YORO_ERROR_FORMAT),
        (&|i| i.color_texture = depth, YORO_ERROR_FORMAT),
        (&|i| i.color_texture = plane(glow::RGBA8UI, size), YORO_ERROR_FORMAT),
        (&|i| i.depth_texture = samples, YORO_ERROR_FORMAT),
        (&|i| i.color_texture = plane(glow::RGBA8, [8, 8]), YORO_ERROR_FORMAT),
        (&|i| i.depth_texture = color, YORO_ERROR_FORMAT),
        (&|i| i.depth_texture = target_depth, YORO_ERROR_FORMAT),
        (&|i| i.framebuffer = flat, YORO_ERROR_FORMAT),
        (&|i| i.framebuffer = own_color, YORO_ERROR_FORMAT),
        (&|i| i.framebuffer = own_depth, YORO_ERROR_FORMAT),
        (&|i| i.x = 1, YORO_ERROR_FORMAT),
        (&|i| i.framebuffer = 4_000_000, YORO_ERROR_FORMAT),
    ];
    check_codes(&good, table, |images| {
        let code = call(&views.warp, images);
        assert_eq!(headless.gl().take_errors(), None, "{images:?}");
        code
    });
    // SAFETY: the context is current.
    let renderbuffer = unsafe {
        let renderbuffer = gl.create_renderbuffer().unwrap();
        gl.bind_renderbuffer(glow::RENDERBUFFER, Some(renderbuffer));
        gl.bind_renderbuffer(glow::RENDERBUFFER, None);
        renderbuffer.0.get()
    };
    let other = YoroGlImages { depth_texture: renderbuffer, ..good };
    assert_eq!(call(&views.warp, &other), YORO_ERROR_FORMAT);
    assert!(noted.last().unwrap().1.contains("is also a renderbuffer"), "{noted:?}");
    let mut capabilities: YoroCapabilities = zeroed(|c: &mut YoroCapabilities| &mut c.struct_size);
    // SAFETY: a live context, and null or a complete structure.
    unsafe {
        assert_eq!(yoro_gl_synthesize(context, null(), &good), YORO_ERROR_NULL);
        assert_eq!(yoro_gl_synthesize(context, &views.warp, null()), YORO_ERROR_NULL);
        assert_eq!(yoro_gl_prepare(context, null()), YORO_ERROR_NULL);
        assert_eq!(yoro_capabilities(context, &mut capabilities), YORO_OK);
    }
    assert_eq!(capabilities.api, YORO_API_OPENGL_ES);
    assert!(capabilities.buffer_bytes > 0 && capabilities.device[0] != 0);
    // SAFETY: made above, destroyed once.
    assert_eq!(unsafe { yoro_destroy(context) }, YORO_OK);
}
