//! Sources on OpenGL that are parts or layers of their textures, memory use, and times.

mod common;

use std::ptr::{null, null_mut};

use common::{framebuffer, gl_info, good_eyes, texture, views_of, zeroed};
use glow::HasContext;
use yoro_c::*;
use yoro_context::{Backend, Headless};

/// Size of the textures, which are larger than the source and have two layers.
const IMAGE: [u32; 2] = [300, 200];
const ORIGIN: [u32; 2] = [40, 30];

/// Returns the names of a colour texture, which has one colour inside the source and another around it, and of a depth
/// texture.
unsafe fn textures(gl: &glow::Context, views: &YoroViews, target: u32) -> (u32, u32) {
    let [w, h] = [views.source.width, views.source.height].map(|n| n as i32);
    // SAFETY: the context is current; textures and framebuffers are its own.
    unsafe {
        let (color, depth) =
            (texture(gl, target, glow::RGBA8, IMAGE), texture(gl, target, glow::DEPTH_COMPONENT24, IMAGE));
        let drawn = gl.create_framebuffer().unwrap();
        gl.bind_framebuffer(glow::FRAMEBUFFER, Some(drawn));
        let name = |name: u32| std::num::NonZeroU32::new(name).map(glow::NativeTexture);
        if target == glow::TEXTURE_2D_ARRAY {
            gl.framebuffer_texture_layer(glow::FRAMEBUFFER, glow::COLOR_ATTACHMENT0, name(color), 0, 1);
            gl.framebuffer_texture_layer(glow::FRAMEBUFFER, glow::DEPTH_ATTACHMENT, name(depth), 0, 1);
        } else {
            gl.framebuffer_texture_2d(glow::FRAMEBUFFER, glow::COLOR_ATTACHMENT0, target, name(color), 0);
            gl.framebuffer_texture_2d(glow::FRAMEBUFFER, glow::DEPTH_ATTACHMENT, target, name(depth), 0);
        }
        gl.disable(glow::SCISSOR_TEST);
        gl.clear_color(1.0, 0.0, 0.0, 1.0);
        gl.clear_depth_f32(0.5);
        gl.clear(glow::COLOR_BUFFER_BIT | glow::DEPTH_BUFFER_BIT);
        gl.enable(glow::SCISSOR_TEST);
        gl.scissor(ORIGIN[0] as i32, ORIGIN[1] as i32, w, h);
        gl.clear_color(0.0, 1.0, 0.0, 1.0);
        gl.clear_depth_f32(1.0);
        gl.clear(glow::COLOR_BUFFER_BIT | glow::DEPTH_BUFFER_BIT);
        gl.disable(glow::SCISSOR_TEST);
        gl.bind_framebuffer(glow::FRAMEBUFFER, None);
        gl.delete_framebuffer(drawn);
        (color, depth)
    }
}

#[test]
fn parts_and_layers_are_read_and_a_layer_is_drawn() {
    let headless = Headless::open(Backend::Egl).unwrap();
    let gl = headless.gl().raw();
    let views = views_of(&good_eyes()).unwrap();
    for layers in [false, true] {
        let mut noted = Vec::new();
        let mut info = gl_info(&mut noted);
        info.sources = YORO_GL_SOURCE_PARTS | if layers { YORO_GL_SOURCE_LAYERS } else { 0 };
        let source = if layers { glow::TEXTURE_2D_ARRAY } else { glow::TEXTURE_2D };
        let mut context = null_mut();
        let mut images: YoroGlImages = zeroed(|i: &mut YoroGlImages| &mut i.struct_size);
        (images.source_x, images.source_y) = (ORIGIN[0], ORIGIN[1]);
        (images.image_width, images.image_height) = (IMAGE[0], IMAGE[1]);
        images.layer = layers.into();
        // SAFETY: complete structures, a live, current context, and checks are on.
        unsafe {
            assert_eq!(yoro_gl_create(&info, &mut context), YORO_OK, "{noted:?}");
            (images.color_texture, images.depth_texture) = textures(gl, &views, source);
            // With multiview, the other eye is a layer too.
            let target = texture(gl, glow::TEXTURE_2D_ARRAY, glow::RGBA8, [160, 120]);
            let drawn = gl.create_framebuffer().unwrap();
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(drawn));
            let name = std::num::NonZeroU32::new(target).map(glow::NativeTexture);
            gl.framebuffer_texture_layer(glow::FRAMEBUFFER, glow::COLOR_ATTACHMENT0, name, 0, 1);
            images.framebuffer = drawn.0.get();
            assert_eq!(yoro_gl_synthesize(context, &views.warp, &images), YORO_OK, "{noted:?}");
            let mut pixels = vec![0u8; 160 * 120 * 4];
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(drawn));
            let data = glow::PixelPackData::Slice(Some(&mut pixels));
            gl.read_pixels(0, 0, 160, 120, glow::RGBA, glow::UNSIGNED_BYTE, data);
            assert!(
                pixels.chunks_exact(4).all(|pixel| pixel == [0, 255, 0, 255]),
                "nothing beside the part is read"
            );

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

#[test]
fn what_was_not_chosen_is_refused() {
    let headless = Headless::open(Backend::Egl).unwrap();
    let views = views_of(&good_eyes()).unwrap();
    let mut noted = Vec::new();
    let info = gl_info(&mut noted);
    let create = |info: &YoroGlInfo| {
        let mut context = null_mut();
        // SAFETY: a complete structure, and the context is current.
        (unsafe { yoro_gl_create(info, &mut context) }, context)
    };
    assert_eq!(create(&YoroGlInfo { sources: 4, ..info }).0, YORO_ERROR_VALUE);
    assert_eq!(create(&YoroGlInfo { timed: 2, ..info }).0, YORO_ERROR_VALUE);
    let (code, context) = create(&info);
    assert_eq!(code, YORO_OK);
    let gl = headless.gl().raw();
    let size = [views.source.width, views.source.height];
    let mut images: YoroGlImages = zeroed(|i: &mut YoroGlImages| &mut i.struct_size);
    let mut times: YoroTimes = zeroed(|t: &mut YoroTimes| &mut t.struct_size);
    let mut bytes = 0;
    // SAFETY: complete structures, a live, current context, and checks are on.
    unsafe {
        images.color_texture = texture(gl, glow::TEXTURE_2D, glow::RGBA8, size);
        images.depth_texture = texture(gl, glow::TEXTURE_2D, glow::DEPTH_COMPONENT24, size);
        let target = texture(gl, glow::TEXTURE_2D, glow::RGBA8, [160, 120]);
        images.framebuffer = framebuffer(gl, &[(glow::COLOR_ATTACHMENT0, target)]);
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
