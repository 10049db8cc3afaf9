//! Sources on OpenGL that are parts or layers of their textures, what is written to the target, memory use, and times.

mod common;

use std::ptr::null;

use common::{create, framebuffer, gl_info, good_eyes, images, texture, views_of, zeroed};
use glow::HasContext;
use yoro_c::*;
use yoro_context::{Backend, Headless};

/// Size of the textures, which are larger than the source and have two layers.
const IMAGE: [u32; 2] = [300, 200];
const ORIGIN: [u32; 2] = [40, 30];

#[test]
fn parts_and_layers_are_taken_and_a_layer_is_drawn() {
    let headless = Headless::open(Backend::Egl).unwrap();
    let gl = headless.gl().raw();
    let views = views_of(&good_eyes()).unwrap();
    for layers in [false, true] {
        let mut noted = Vec::new();
        let mut info = gl_info(&mut noted);
        info.sources = YORO_GL_SOURCE_PARTS | if layers { YORO_GL_SOURCE_LAYERS } else { 0 };
        let kind = if layers { glow::TEXTURE_2D_ARRAY } else { glow::TEXTURE_2D };
        let context = create(&info).unwrap();
        let mut images: YoroGlImages = zeroed(|i: &mut YoroGlImages| &mut i.struct_size);
        (images.source_x, images.source_y) = (ORIGIN[0], ORIGIN[1]);
        (images.image_width, images.image_height) = (IMAGE[0], IMAGE[1]);
        images.layer = layers.into();
        // SAFETY: complete structures, a live, current context, and checks are on.
        unsafe {
            images.color_texture = texture(gl, kind, glow::RGBA8, IMAGE);
            images.depth_texture = texture(gl, kind, glow::DEPTH_COMPONENT24, IMAGE);
            // With multiview, the other eye is a layer too.
            let target = texture(gl, glow::TEXTURE_2D_ARRAY, glow::RGBA8, [160, 120]);
            let drawn = gl.create_framebuffer().unwrap();
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(drawn));
            let name = std::num::NonZeroU32::new(target).map(glow::NativeTexture);
            gl.framebuffer_texture_layer(glow::FRAMEBUFFER, glow::COLOR_ATTACHMENT0, name, 0, 1);
            images.framebuffer = drawn.0.get();
            assert_eq!(yoro_gl_synthesize(context, &views.warp, &images), YORO_OK, "{noted:?}");

            let with = |change: &dyn Fn(&mut YoroGlImages)| {
                let mut changed = images;
                change(&mut changed);
                yoro_gl_synthesize(context, &views.warp, &changed)
            };
            assert_eq!(with(&|i| i.source_x = IMAGE[0] - 10), YORO_ERROR_TOO_LARGE);
            assert_eq!(with(&|i| i.source_y = u32::MAX), YORO_ERROR_TOO_LARGE);
            assert_eq!(with(&|i| i.image_width = 0), YORO_ERROR_TOO_LARGE);
            assert_eq!(with(&|i| i.image_width += 1), YORO_ERROR_FORMAT);
            assert_eq!(with(&|i| i.layer = 2), if layers { YORO_ERROR_FORMAT } else { YORO_ERROR_VALUE });
            // The kind of texture that was not chosen.
            let other = if layers { glow::TEXTURE_2D } else { glow::TEXTURE_2D_ARRAY };
            let other = texture(gl, other, glow::RGBA8, IMAGE);
            assert_eq!(with(&|i| i.color_texture = other), YORO_ERROR_FORMAT);
            assert_eq!(yoro_destroy(context), YORO_OK);
        }
    }
    assert_eq!(headless.gl().take_errors(), None);
}

/// Draws a triangle of this depth over the whole framebuffer, and returns true if it is seen in the middle.
fn is_seen(gl: &glow::Context, framebuffer: u32, depth: f32) -> bool {
    let position =
        format!("vec4(vec2(gl_VertexID / 2, gl_VertexID % 2) * 4.0 - 1.0, {depth:.3} * 2.0 - 1.0, 1.0)");
    let vertex = format!("void main() {{ gl_Position = {position}; }}");
    let fragment = "precision highp float; out vec4 color; void main() { color = vec4(0, 1, 0, 1); }";
    let mut rgba = [0; 4];
    // SAFETY: the context is current, the objects are its own, and the vertex array has no attributes.
    unsafe {
        let program = gl.create_program().unwrap();
        for (stage, text) in [(glow::VERTEX_SHADER, vertex.as_str()), (glow::FRAGMENT_SHADER, fragment)] {
            let shader = gl.create_shader(stage).unwrap();
            gl.shader_source(shader, &format!("#version 300 es\n{text}"));
            gl.compile_shader(shader);
            gl.attach_shader(program, shader);
        }
        gl.link_program(program);
        gl.use_program(Some(program));
        let name = std::num::NonZeroU32::new(framebuffer).map(glow::NativeFramebuffer);
        gl.bind_framebuffer(glow::FRAMEBUFFER, name);
        gl.clear_buffer_f32_slice(glow::COLOR, 0, &[0.0; 4]);
        gl.viewport(0, 0, 160, 120);
        gl.enable(glow::DEPTH_TEST);
        gl.draw_arrays(glow::TRIANGLES, 0, 3);
        gl.disable(glow::DEPTH_TEST);
        gl.read_pixels(
            80,
            60,
            1,
            1,
            glow::RGBA,
            glow::UNSIGNED_BYTE,
            glow::PixelPackData::Slice(Some(&mut rgba)),
        );
    }
    rgba[1] == 255
}

/// A wall fills the view. Colour alone leaves the target's depth, YORO_OUTPUT_DEPTH writes the wall's, and what is open
/// is told from the wall by the nearest depth or by stencil. The host's state is as before.
#[test]
fn outputs_are_what_was_chosen() {
    const WALL: f32 = 0.99;
    let headless = Headless::open(Backend::Egl).unwrap();
    let gl = headless.gl().raw();
    let views = views_of(&good_eyes()).unwrap();
    let (size, target_size) = ([views.source.width, views.source.height], [160, 120]);
    for (outputs, in_front, behind) in [
        (0, true, true),
        (YORO_OUTPUT_DEPTH, true, false),
        (YORO_OUTPUT_OPEN_DEPTH, false, false),
        (YORO_OUTPUT_DEPTH | YORO_OUTPUT_OPEN_STENCIL, true, false),
    ] {
        let mut noted = Vec::new();
        let context = create(&YoroGlInfo { outputs, ..gl_info(&mut noted) }).unwrap();
        let plane = |format, size| {
            // SAFETY: the context is current.
            unsafe { texture(gl, glow::TEXTURE_2D, format, size) }
        };
        let made = |size| {
            let (color, depth) = (plane(glow::RGBA8, size), plane(glow::DEPTH24_STENCIL8, size));
            let attachments = [(glow::COLOR_ATTACHMENT0, color), (glow::DEPTH_STENCIL_ATTACHMENT, depth)];
            // SAFETY: the textures are the context's own.
            (unsafe { framebuffer(gl, &attachments) }, color, depth)
        };
        let ((source, color, depth), (target, ..)) = (made(size), made(target_size));
        // SAFETY: complete structures, live objects of the current context, and checks are on.
        unsafe {
            for (framebuffer, red, depth) in [(source, 1.0, WALL), (target, 0.0, 1.0)] {
                let name = std::num::NonZeroU32::new(framebuffer).map(glow::NativeFramebuffer);
                gl.bind_framebuffer(glow::FRAMEBUFFER, name);
                gl.clear_buffer_f32_slice(glow::COLOR, 0, &[red, 0.0, 0.0, 1.0]);
                gl.clear_buffer_depth_stencil(glow::DEPTH_STENCIL, 0, depth, 0);
            }
            let mut images: YoroGlImages = zeroed(|i: &mut YoroGlImages| &mut i.struct_size);
            (images.color_texture, images.depth_texture, images.framebuffer) = (color, depth, target);
            gl.viewport(1, 2, 3, 4);
            assert_eq!(yoro_gl_synthesize(context, &views.warp, &images), YORO_OK, "{noted:?}");
            let mut viewport = [0; 4];
            gl.get_parameter_i32_slice(glow::VIEWPORT, &mut viewport);
            assert_eq!(viewport, [1, 2, 3, 4]);
            assert_eq!(yoro_destroy(context), YORO_OK);
        }
        assert_eq!(
            [is_seen(gl, target, WALL + 0.005), is_seen(gl, target, WALL - 0.01)],
            [behind, in_front],
            "{outputs}"
        );
        if outputs & YORO_OUTPUT_OPEN_STENCIL != 0 {
            // SAFETY: the context is current.
            unsafe {
                gl.enable(glow::STENCIL_TEST);
                gl.stencil_func(glow::EQUAL, 0, 0xff);
            }
            assert!(!is_seen(gl, target, WALL - 0.02), "stencil is 1 where the wall is");
        }
    }
    assert_eq!(headless.gl().take_errors(), None);
}

#[test]
fn what_was_not_chosen_is_refused() {
    let headless = Headless::open(Backend::Egl).unwrap();
    let views = views_of(&good_eyes()).unwrap();
    let mut noted = Vec::new();
    let info = gl_info(&mut noted);
    assert_eq!(create(&YoroGlInfo { sources: 4, ..info }), Err(YORO_ERROR_VALUE));
    assert_eq!(create(&YoroGlInfo { timed: 2, ..info }), Err(YORO_ERROR_VALUE));
    let context = create(&info).unwrap();
    let size = [views.source.width, views.source.height];
    let images = images(headless.gl().raw(), glow::RGBA8, size, [160, 120]);
    let mut times: YoroTimes = zeroed(|t: &mut YoroTimes| &mut t.struct_size);
    let mut bytes = 0;
    // SAFETY: complete structures, a live, current context, and checks are on.
    unsafe {
        let synthesize = |images: &YoroGlImages| yoro_gl_synthesize(context, &views.warp, images);
        assert_eq!(synthesize(&YoroGlImages { source_x: 1, ..images }), YORO_ERROR_VALUE);
        assert_eq!(synthesize(&YoroGlImages { image_height: 1, ..images }), YORO_ERROR_VALUE);
        assert_eq!(synthesize(&YoroGlImages { layer: 1, ..images }), YORO_ERROR_VALUE);
        assert_eq!(synthesize(&images), YORO_OK);
        // The memory use is as predicted, and no times are known.
        let mut capabilities: YoroCapabilities = zeroed(|c: &mut YoroCapabilities| &mut c.struct_size);
        assert_eq!(yoro_capabilities(context, &mut capabilities), YORO_OK);
        assert_eq!(yoro_gl_buffer_bytes(&info, &views.warp, &mut bytes), YORO_OK);
        assert_eq!(bytes, capabilities.buffer_bytes);
        assert_eq!(yoro_gl_buffer_bytes(&info, null(), &mut bytes), YORO_ERROR_NULL);
        assert_eq!(yoro_times(context, &mut times), YORO_OK);
        assert_eq!(times.is_known, 0);
        assert_eq!(yoro_destroy(context), YORO_OK);
    }
}
