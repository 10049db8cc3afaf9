//! The GL contract: pictures do not depend on the host's state, and the host's state can be preserved.

use std::rc::Rc;

use glow::HasContext;

use super::laws::{on_every_backend, pair, scene};
use yoro::eyes::{DepthConvention, Eye, GuardBand, Warp};
use yoro::opengl::{Context, Destination, Gather, GlApi, GlState, Options, Outputs, Source};
use yoro::synthesis::{HoleMark, Holes};
use yoro_gl::{Filter, Format, RenderTarget, Texture};

pub const OUTPUTS: Outputs = Outputs { depth: true, source_map: true, srgb: false, holes: Holes::Filled };
/// GL_DEPTH_BOUNDS_TEST_EXT.
const DEPTH_BOUNDS_TEST: u32 = 0x8890;

/// Compiles the pipeline with [`OUTPUTS`].
pub fn gather(gl: &Rc<Context>, gl_state: GlState) -> Gather {
    gather_with(gl, gl_state, Holes::Filled)
}

fn gather_with(gl: &Rc<Context>, gl_state: GlState, holes: Holes) -> Gather {
    Gather::new(gl, &Options { gl_state, ..Options::default() }, Outputs { holes, ..OUTPUTS }).unwrap()
}

/// Every way to treat holes that writes depth.
const HOLES: [Holes; 2] = [Holes::Filled, Holes::Open(HoleMark::Stencil)];

pub fn warp(size: [u32; 2]) -> Warp {
    let eyes = pair(size, Eye::Right, 0.063, DepthConvention::Standard);
    eyes.synthesis_views(GuardBand::Pixels(9)).unwrap().warp
}

/// The objects that an engine lends: textures with filters that synthesis must not use, one of them with a compare
/// mode, and a target.
pub struct Lent {
    color: Texture,
    depth: Texture,
    target: RenderTarget,
    pub warp: Warp,
    /// The content of `color`.
    rgba: Vec<u8>,
}

impl Lent {
    pub fn new(gl: &Rc<Context>, size: [u32; 2], color: Format) -> Lent {
        let warp = warp(size);
        let (rgba, depth) =
            scene(warp.source_size, pair(size, Eye::Right, 0.063, DepthConvention::Standard).depth, 21);
        let color_texture = Texture::new(gl, warp.source_size, color, Filter::Linear).unwrap();
        color_texture.upload(&rgba);
        let depth_texture = Texture::new(gl, warp.source_size, Format::Depth32F, Filter::Compare).unwrap();
        let bytes: Vec<u8> = depth.iter().flat_map(|z| z.to_ne_bytes()).collect();
        depth_texture.upload(&bytes);
        for texture in [&color_texture, &depth_texture] {
            texture.bind(0);
            for (name, value) in [
                (glow::TEXTURE_MIN_FILTER, glow::NEAREST_MIPMAP_LINEAR),
                (glow::TEXTURE_MAG_FILTER, glow::NEAREST),
                (glow::TEXTURE_WRAP_S, glow::REPEAT),
                (glow::TEXTURE_WRAP_T, glow::MIRRORED_REPEAT),
            ] {
                // SAFETY: a bound texture, valid values.
                unsafe { gl.raw().tex_parameter_i32(glow::TEXTURE_2D, name, value as i32) };
            }
        }
        let formats = [(color, Filter::Nearest), (Format::R32Ui, Filter::Nearest)];
        let target =
            RenderTarget::new(gl, warp.target_size, &formats, Some(Format::Depth32FStencil8)).unwrap();
        Lent { color: color_texture, depth: depth_texture, target, warp, rgba }
    }

    pub fn source(&self) -> Source {
        Source::new(self.color.raw(), self.depth.raw())
    }

    pub fn target(&self) -> Destination {
        Destination::whole(&self.target)
    }

    /// Returns colour, source map and depth, the last one as bits.
    pub fn picture(&self, gl: &Rc<Context>) -> (Vec<u8>, Vec<u32>, Vec<u32>) {
        let size = self.warp.target_size;
        (
            self.target.read_rgba8(0, [0, 0], size),
            self.target.read_u32(1, [0, 0], size),
            read_depth(gl, self.target.depth().raw(), size),
        )
    }
}

/// Reads depth as bits, with its own pass: OpenGL ES cannot read depth back directly. Leaves a state in which nothing keeps
/// draws from being visible.
pub fn read_depth(gl: &Rc<Context>, depth: glow::Texture, size: [u32; 2]) -> Vec<u32> {
    let raw = gl.raw();
    let fragment = "void main() { bits = floatBitsToUint(texelFetch(depth, ivec2(gl_FragCoord.xy), 0).r); }";
    let program = program(
        gl,
        "void main() { gl_Position = vec4(float(gl_VertexID / 2) * 4.0 - 1.0, float(gl_VertexID % 2) * 4.0 - 1.0, 0.0, 1.0); }",
        &format!("uniform highp sampler2D depth; out uint bits; {fragment}"),
    );
    let target = RenderTarget::new(gl, size, &[(Format::R32Ui, Filter::Nearest)], None).unwrap();
    clean(gl);
    target.bind();
    // SAFETY: live objects; the vertex array has no attributes.
    unsafe {
        let vertex_array = raw.create_vertex_array().unwrap();
        raw.active_texture(glow::TEXTURE0);
        raw.bind_texture(glow::TEXTURE_2D, Some(depth));
        raw.tex_parameter_i32(glow::TEXTURE_2D, glow::TEXTURE_COMPARE_MODE, glow::NONE as i32);
        raw.use_program(Some(program));
        raw.bind_vertex_array(Some(vertex_array));
        raw.draw_arrays(glow::TRIANGLES, 0, 3);
        raw.use_program(None);
        raw.bind_vertex_array(None);
        raw.delete_program(program);
        raw.delete_vertex_array(vertex_array);
    }
    target.read_u32(0, [0, 0], size)
}

pub fn program(gl: &Context, vertex: &str, fragment: &str) -> glow::Program {
    let raw = gl.raw();
    // SAFETY: names are created here.
    unsafe {
        let program = raw.create_program().unwrap();
        for (kind, text) in [(glow::VERTEX_SHADER, vertex), (glow::FRAGMENT_SHADER, fragment)] {
            let shader = raw.create_shader(kind).unwrap();
            raw.shader_source(
                shader,
                &format!("#version 300 es\nprecision highp float;\nprecision highp int;\n{text}\n"),
            );
            raw.compile_shader(shader);
            assert!(raw.get_shader_compile_status(shader), "{}", raw.get_shader_info_log(shader));
            raw.attach_shader(program, shader);
            raw.delete_shader(shader);
        }
        raw.link_program(program);
        assert!(raw.get_program_link_status(program), "{}", raw.get_program_info_log(program));
        program
    }
}

/// Returns all capabilities of this context for `glEnable` that keep a pixel from being what a shader wrote.
fn switches(gl: &Context) -> Vec<u32> {
    let desktop = gl.capabilities().api == GlApi::Desktop;
    let has = |name: &str| gl.raw().supported_extensions().contains(name);
    let mut all = vec![
        glow::BLEND,
        glow::CULL_FACE,
        glow::DEPTH_TEST,
        glow::DITHER,
        glow::POLYGON_OFFSET_FILL,
        glow::PRIMITIVE_RESTART_FIXED_INDEX,
        glow::RASTERIZER_DISCARD,
        glow::SAMPLE_ALPHA_TO_COVERAGE,
        glow::SAMPLE_COVERAGE,
        glow::SCISSOR_TEST,
        glow::STENCIL_TEST,
    ];
    if gl.capabilities().compute {
        all.push(glow::SAMPLE_MASK);
    }
    if desktop || has("GL_EXT_sRGB_write_control") {
        all.push(glow::FRAMEBUFFER_SRGB);
    }
    if has("GL_EXT_depth_bounds_test") {
        all.push(DEPTH_BOUNDS_TEST);
    }
    if gl.capabilities().clip_distances {
        all.extend((0..8).map(|i| glow::CLIP_DISTANCE0 + i));
    }
    if desktop {
        all.extend([
            glow::COLOR_LOGIC_OP,
            glow::POLYGON_SMOOTH,
            glow::PRIMITIVE_RESTART,
            glow::SAMPLE_ALPHA_TO_ONE,
        ]);
    }
    all
}

/// Sets the state that [`Hostile`] changes to a context's initial state, with sRGB encoding off.
pub fn clean(gl: &Context) {
    let raw = gl.raw();
    // SAFETY: state calls with valid enums.
    unsafe {
        switches(gl).into_iter().for_each(|switch| raw.disable(switch));
        raw.color_mask(true, true, true, true);
        raw.depth_mask(true);
        if gl.capabilities().api == GlApi::Desktop {
            raw.polygon_mode(glow::FRONT_AND_BACK, glow::FILL);
        }
        (0..8).for_each(|unit| raw.bind_sampler(unit, None));
        for buffer in [glow::PIXEL_PACK_BUFFER, glow::PIXEL_UNPACK_BUFFER] {
            raw.bind_buffer(buffer, None);
        }
    }
}

/// The objects of a host that leaves all state as wrong as possible.
pub struct Hostile {
    sampler: glow::Sampler,
    buffer: glow::Buffer,
    vertex_array: glow::VertexArray,
    program: glow::Program,
    texture: Texture,
    targets: [RenderTarget; 2],
}

impl Hostile {
    pub fn new(gl: &Rc<Context>) -> Hostile {
        let raw = gl.raw();
        let formats = [(Format::Rgba8, Filter::Nearest); 2];
        let target = || RenderTarget::new(gl, [8, 8], &formats, Some(Format::Depth24)).unwrap();
        // SAFETY: new objects.
        unsafe {
            let sampler = raw.create_sampler().unwrap();
            for (name, value) in [
                (glow::TEXTURE_MIN_FILTER, glow::NEAREST_MIPMAP_LINEAR),
                (glow::TEXTURE_MAG_FILTER, glow::NEAREST),
                (glow::TEXTURE_WRAP_S, glow::REPEAT),
                (glow::TEXTURE_COMPARE_MODE, glow::COMPARE_REF_TO_TEXTURE),
                (glow::TEXTURE_COMPARE_FUNC, glow::NEVER),
            ] {
                raw.sampler_parameter_i32(sampler, name, value as i32);
            }
            let buffer = raw.create_buffer().unwrap();
            raw.bind_buffer(glow::ARRAY_BUFFER, Some(buffer));
            raw.buffer_data_size(glow::ARRAY_BUFFER, 64, glow::STATIC_DRAW);
            raw.bind_buffer(glow::ARRAY_BUFFER, None);
            Hostile {
                sampler,
                buffer,
                vertex_array: raw.create_vertex_array().unwrap(),
                program: program(
                    gl,
                    "void main() { gl_Position = vec4(0.0); }",
                    "out vec4 color; void main() { color = vec4(1.0); }",
                ),
                texture: Texture::new(gl, [4, 4], Format::Rgba8, Filter::Nearest).unwrap(),
                targets: [target(), target()],
            }
        }
    }

    /// Sets all state to wrong values.
    pub fn set(&self, gl: &Context) {
        let raw = gl.raw();
        let capabilities = gl.capabilities();
        let desktop = capabilities.api == GlApi::Desktop;
        // SAFETY: live objects and valid enums; what a version lacks is left out.
        unsafe {
            raw.color_mask(false, true, false, true);
            raw.depth_func(glow::NEVER);
            raw.depth_mask(false);
            raw.depth_range_f32(0.75, 0.25);
            raw.scissor(1, 2, 3, 4);
            raw.stencil_func(glow::NEVER, 1, 0xff);
            raw.stencil_op(glow::INVERT, glow::INVERT, glow::INVERT);
            raw.blend_func_separate(glow::ZERO, glow::ZERO, glow::DST_COLOR, glow::ONE);
            raw.blend_equation(glow::FUNC_REVERSE_SUBTRACT);
            raw.cull_face(glow::FRONT_AND_BACK);
            raw.front_face(glow::CW);
            raw.polygon_offset(3.0, 5.0);
            raw.sample_coverage(0.0, false);
            raw.clear_color(0.1, 0.2, 0.3, 0.4);
            raw.clear_depth_f32(0.5);
            raw.viewport(1, 1, 5, 3);
            switches(gl).into_iter().for_each(|switch| raw.enable(switch));
            if capabilities.compute {
                raw.bind_buffer_base(glow::SHADER_STORAGE_BUFFER, 0, Some(self.buffer));
                let (texture, format) = (Some(self.texture.raw()), glow::RGBA8);
                raw.bind_image_texture(0, texture, 0, true, 0, glow::READ_ONLY, format);
            }
            if desktop || capabilities.version >= (3, 2) {
                raw.disable_draw_buffer(glow::BLEND, 1);
                raw.color_mask_draw_buffer(1, true, false, false, true);
            }
            if desktop {
                raw.polygon_mode(glow::FRONT_AND_BACK, glow::POINT);
            }
            for (name, value) in [
                (glow::PACK_ALIGNMENT, 8),
                (glow::PACK_ROW_LENGTH, 77),
                (glow::PACK_SKIP_ROWS, 2),
                (glow::PACK_SKIP_PIXELS, 3),
                (glow::UNPACK_ALIGNMENT, 8),
                (glow::UNPACK_ROW_LENGTH, 1077),
                (glow::UNPACK_SKIP_ROWS, 1),
                (glow::UNPACK_SKIP_PIXELS, 1),
            ] {
                raw.pixel_store_i32(name, value);
            }
            for unit in 0..8 {
                raw.active_texture(glow::TEXTURE0 + unit);
                raw.bind_texture(glow::TEXTURE_2D, Some(self.texture.raw()));
                raw.bind_sampler(unit, Some(self.sampler));
            }
            raw.bind_buffer_base(glow::UNIFORM_BUFFER, 0, Some(self.buffer));
            for target in [
                glow::ARRAY_BUFFER,
                glow::UNIFORM_BUFFER,
                glow::PIXEL_PACK_BUFFER,
                glow::PIXEL_UNPACK_BUFFER,
                glow::COPY_READ_BUFFER,
            ] {
                raw.bind_buffer(target, Some(self.buffer));
            }
            raw.bind_vertex_array(Some(self.vertex_array));
            raw.use_program(Some(self.program));
            raw.bind_framebuffer(glow::DRAW_FRAMEBUFFER, Some(self.targets[0].raw()));
            raw.bind_framebuffer(glow::READ_FRAMEBUFFER, Some(self.targets[1].raw()));
        }
        assert_eq!(gl.take_errors(), None, "the test's own mistake");
    }

    pub fn delete(self, gl: &Context) {
        clean(gl);
        let raw = gl.raw();
        // SAFETY: created in `new`.
        unsafe {
            raw.use_program(None);
            raw.bind_vertex_array(None);
            raw.delete_program(self.program);
            raw.delete_vertex_array(self.vertex_array);
            raw.delete_buffer(self.buffer);
            raw.delete_sampler(self.sampler);
        }
    }
}

/// Returns all state that can be queried, as names and bits.
pub fn snapshot(gl: &Context) -> Vec<(String, Vec<i32>)> {
    let raw = gl.raw();
    let capabilities = gl.capabilities();
    let desktop = capabilities.api == GlApi::Desktop;
    let mut all = Vec::new();
    // SAFETY: queries of state that the version has, into arrays that are long enough.
    unsafe {
        for switch in switches(gl) {
            all.push((format!("switch 0x{switch:x}"), vec![raw.is_enabled(switch) as i32]));
        }
        let names: &[(u32, usize)] = &[
            (glow::ACTIVE_TEXTURE, 1),
            (glow::ARRAY_BUFFER_BINDING, 1),
            (glow::BLEND_DST_ALPHA, 1),
            (glow::BLEND_DST_RGB, 1),
            (glow::BLEND_EQUATION_ALPHA, 1),
            (glow::BLEND_EQUATION_RGB, 1),
            (glow::BLEND_SRC_ALPHA, 1),
            (glow::BLEND_SRC_RGB, 1),
            (glow::COLOR_CLEAR_VALUE, 4),
            (glow::COLOR_WRITEMASK, 4),
            (glow::COPY_READ_BUFFER_BINDING, 1),
            (glow::CULL_FACE_MODE, 1),
            (glow::CURRENT_PROGRAM, 1),
            (glow::DEPTH_CLEAR_VALUE, 1),
            (glow::DEPTH_FUNC, 1),
            (glow::DEPTH_RANGE, 2),
            (glow::DEPTH_WRITEMASK, 1),
            (glow::DRAW_FRAMEBUFFER_BINDING, 1),
            (glow::FRONT_FACE, 1),
            (glow::PACK_ALIGNMENT, 1),
            (glow::PACK_ROW_LENGTH, 1),
            (glow::PACK_SKIP_PIXELS, 1),
            (glow::PACK_SKIP_ROWS, 1),
            (glow::PIXEL_PACK_BUFFER_BINDING, 1),
            (glow::PIXEL_UNPACK_BUFFER_BINDING, 1),
            (glow::POLYGON_OFFSET_FACTOR, 1),
            (glow::POLYGON_OFFSET_UNITS, 1),
            (glow::READ_FRAMEBUFFER_BINDING, 1),
            (glow::RENDERBUFFER_BINDING, 1),
            (glow::SAMPLE_COVERAGE_INVERT, 1),
            (glow::SCISSOR_BOX, 4),
            (glow::STENCIL_BACK_FUNC, 1),
            (glow::STENCIL_BACK_PASS_DEPTH_PASS, 1),
            (glow::STENCIL_BACK_WRITEMASK, 1),
            (glow::STENCIL_FUNC, 1),
            (glow::STENCIL_FAIL, 1),
            (glow::STENCIL_REF, 1),
            (glow::STENCIL_WRITEMASK, 1),
            (glow::UNIFORM_BUFFER_BINDING, 1),
            (glow::UNPACK_ALIGNMENT, 1),
            (glow::UNPACK_ROW_LENGTH, 1),
            (glow::UNPACK_SKIP_PIXELS, 1),
            (glow::UNPACK_SKIP_ROWS, 1),
            (glow::VERTEX_ARRAY_BINDING, 1),
            (glow::VIEWPORT, 4),
        ];
        let mut ask = |name: u32, count: usize| {
            let mut values = [0f32; 8];
            raw.get_parameter_f32_slice(name, &mut values);
            all.push((format!("0x{name:x}"), values[..count].iter().map(|v| v.to_bits() as i32).collect()));
        };
        names.iter().for_each(|(name, count)| ask(*name, *count));
        if desktop {
            ask(glow::POLYGON_MODE, 1);
            ask(glow::LOGIC_OP_MODE, 1);
        }
        let mut indexed = |name: u32, index: u32| {
            let value = raw.get_parameter_indexed_i32(name, index);
            all.push((format!("0x{name:x}[{index}]"), vec![value]));
        };
        indexed(glow::UNIFORM_BUFFER_BINDING, 0);
        if capabilities.compute {
            indexed(glow::SHADER_STORAGE_BUFFER_BINDING, 0);
            indexed(glow::SAMPLE_MASK_VALUE, 0);
            for name in [
                glow::IMAGE_BINDING_NAME,
                glow::IMAGE_BINDING_LEVEL,
                glow::IMAGE_BINDING_LAYERED,
                glow::IMAGE_BINDING_LAYER,
                glow::IMAGE_BINDING_ACCESS,
                glow::IMAGE_BINDING_FORMAT,
            ] {
                indexed(name, 0);
            }
        }
        if desktop || capabilities.version >= (3, 2) {
            (0..3).for_each(|buffer| indexed(glow::BLEND, buffer));
        }
        let active = raw.get_parameter_i32(glow::ACTIVE_TEXTURE) as u32;
        for unit in 0..8 {
            raw.active_texture(glow::TEXTURE0 + unit);
            let multisample =
                capabilities.multisample_textures.then_some(glow::TEXTURE_BINDING_2D_MULTISAMPLE);
            for name in [glow::TEXTURE_BINDING_2D, glow::TEXTURE_BINDING_2D_ARRAY, glow::SAMPLER_BINDING]
                .into_iter()
                .chain(multisample)
            {
                all.push((format!("unit {unit}: 0x{name:x}"), vec![raw.get_parameter_i32(name)]));
            }
        }
        raw.active_texture(active);
    }
    all
}

#[test]
fn pictures_do_not_depend_on_the_hosts_state() {
    on_every_backend(|gl| {
        let lent = Lent::new(gl, [97, 31], Format::Rgba8);
        let hostile = Hostile::new(gl);
        for holes in HOLES {
            let run = |gl_state| {
                let mut gather = gather_with(gl, gl_state, holes);
                gather.synthesize(lent.source(), &lent.warp, &lent.target()).unwrap();
            };
            let blank = || {
                clean(gl);
                lent.target.bind();
                gl.clear(Some(0.5));
            };
            blank();
            run(GlState::Leave);
            let want = lent.picture(gl);
            assert!(want.0.iter().any(|v| *v > 200) && want.2.iter().any(|v| *v != want.2[0]), "a picture");
            for gl_state in [GlState::Leave, GlState::Preserve] {
                blank();
                hostile.set(gl);
                run(gl_state);
                assert_eq!(gl.take_errors(), None);
                assert!(lent.picture(gl) == want, "{holes:?}, {gl_state:?}");
            }
        }
        hostile.delete(gl);
    });
}

#[test]
fn the_hosts_state_is_preserved() {
    on_every_backend(|gl| {
        let (small, large) = (Lent::new(gl, [48, 16], Format::Rgba8), Lent::new(gl, [97, 31], Format::Rgba8));
        let hostile = Hostile::new(gl);
        clean(gl);
        for is_hostile in [false, true] {
            if is_hostile {
                hostile.set(gl);
            }
            let before = snapshot(gl);
            for holes in HOLES {
                let mut gather = gather_with(gl, GlState::Preserve, holes);
                assert_eq!(snapshot(gl), before, "create");
                gather.prepare(&small.warp).unwrap();
                assert_eq!(snapshot(gl), before, "prepare");
                // The second size allocates; the third call does not.
                for lent in [&small, &large, &large] {
                    gather.synthesize(lent.source(), &lent.warp, &lent.target()).unwrap();
                    assert_eq!(snapshot(gl), before, "synthesize, {holes:?}");
                }
                let beyond = Warp { target_size: [u32::MAX; 2], source_size: [u32::MAX; 2], ..small.warp };
                assert!(gather.prepare(&beyond).is_err());
                assert_eq!(snapshot(gl), before, "a call that fails");
            }
        }
        // Colour masks of single draw buffers, tested by what they let through.
        let raw = gl.raw();
        let [target, _] = &hostile.targets;
        // SAFETY: a framebuffer with two colour attachments.
        unsafe {
            raw.disable(glow::RASTERIZER_DISCARD);
            raw.disable(glow::SCISSOR_TEST);
            raw.bind_buffer(glow::PIXEL_PACK_BUFFER, None);
            (0..2).for_each(|i| raw.clear_buffer_f32_slice(glow::COLOR, i, &[1.0; 4]));
        }
        let pixel = |i| target.read_rgba8(i, [0, 0], [1, 1]);
        assert_eq!(pixel(0), [0, 255, 0, 255]);
        if gl.capabilities().api == GlApi::Desktop || gl.capabilities().version >= (3, 2) {
            assert_eq!(pixel(1), [255, 0, 0, 255]);
        }
        hostile.delete(gl);
    });
}

#[test]
fn no_sampler_is_left_behind() {
    on_every_backend(|gl| {
        let lent = Lent::new(gl, [33, 9], Format::Rgba8);
        let mut gather = gather(gl, GlState::Leave);
        gather.synthesize(lent.source(), &lent.warp, &lent.target()).unwrap();
        for unit in 0..8 {
            // SAFETY: queries of a unit that exists.
            let sampler = unsafe {
                gl.raw().active_texture(glow::TEXTURE0 + unit);
                gl.raw().get_parameter_sampler(glow::SAMPLER_BINDING)
            };
            assert_eq!(sampler, None, "unit {unit}");
        }
    });
}

/// An engine whose images are sRGB textures gets back its own values, decoded and encoded on the way. Without
/// [`Outputs::srgb`], the decoded values are stored.
#[test]
fn srgb_is_encoded_where_asked_for() {
    on_every_backend(|gl| {
        let mut lent = Lent::new(gl, [64, 16], Format::Srgb8Alpha8);
        lent.warp = pair([64, 16], Eye::Right, 0.0, DepthConvention::Standard)
            .synthesis_views(GuardBand::Pixels(9))
            .unwrap()
            .warp;
        let hostile = Hostile::new(gl);
        let [encoded, stored] = [true, false].map(|srgb| {
            hostile.set(gl);
            let mut gather = Gather::new(gl, &Options::default(), Outputs { srgb, ..OUTPUTS }).unwrap();
            gather.synthesize(lent.source(), &lent.warp, &lent.target()).unwrap();
            lent.picture(gl).0
        });
        hostile.delete(gl);
        for y in 0..16 {
            let given = &lent.rgba[y * 73 * 4 + 9 * 4..][..64 * 4];
            let got = &encoded[y * 64 * 4..][..64 * 4];
            assert!(
                given.iter().zip(got).all(|(a, b)| a.abs_diff(*b) <= 1),
                "row {y}: {given:?} became {got:?}"
            );
        }
        assert_ne!(encoded, stored, "encoding can be switched in both contexts");
    });
}
