//! The GL state of a host's renderer: set for synthesis, saved and restored.
//!
//! The table in the documentation of `yoro::opengl::Pipeline` is the contract that this file keeps.

use glow::HasContext;

use crate::{Capabilities, Context, Destination, GlApi, GlError};

/// The number of texture units in use, starting with unit 0.
const UNITS: usize = 4;
/// The unit whose texture is filtered: the source's colour.
const FILTERED_UNIT: u32 = 1;
/// The units with array textures: the source's depth and colour.
const ARRAY_UNITS: [u32; 2] = [0, 1];
/// The number of draw buffers in use: colour and a source map.
const DRAW_BUFFERS: usize = 2;
/// EXT_depth_bounds_test.
const DEPTH_BOUNDS_TEST: u32 = 0x8890;
/// Of `EXT_texture_sRGB_decode`.
const TEXTURE_SRGB_DECODE: u32 = 0x8A48;
const SKIP_DECODE: i32 = 0x8A4A;
/// For the compatibility profile.
const ALPHA_TEST: u32 = 0x0BC0;
const POLYGON_STIPPLE: u32 = 0x0B42;

/// glIsEnabledi: capability, index.
pub(crate) type IsEnabledIndexed = unsafe extern "system" fn(u32, u32) -> u8;
/// glGetBooleani_v: state, index, values.
pub(crate) type GetBooleanIndexed = unsafe extern "system" fn(u32, u32, *mut u8);

/// Queries of single draw buffers, which glow does not wrap.
#[derive(Clone, Copy)]
pub(crate) struct IndexedQueries {
    pub(crate) is_enabled: IsEnabledIndexed,
    pub(crate) get_boolean: GetBooleanIndexed,
}

/// The state in this context that drawing depends on, and the samplers that synthesis uses.
pub(crate) struct Host {
    /// Capabilities (`glEnable`) that are off while a pipeline runs; at most 32.
    switches: Vec<u32>,
    /// True if blending and colour masks can be set for each draw buffer: OpenGL ES 3.2 and the desktop.
    indexed: bool,
    queries: Option<IndexedQueries>,
    /// True if sRGB encoding of framebuffers can be switched.
    encoding: bool,
    polygon_mode: bool,
    /// True if there are several viewports, as on the desktop. Shaders draw to the first one, and only its state is
    /// changed.
    viewports: bool,
    nearest: glow::Sampler,
    linear: glow::Sampler,
    /// Filters, and does not decode sRGB; `None` if the driver always decodes.
    stored: Option<glow::Sampler>,
}

impl Host {
    pub(crate) fn new(
        gl: &glow::Context,
        capabilities: &Capabilities,
        queries: Option<IndexedQueries>,
    ) -> Result<Host, GlError> {
        let has = |name: &str| super::capabilities::has_extension(gl, name);
        let desktop = capabilities.api == GlApi::Desktop;
        let mut switches = vec![
            glow::SCISSOR_TEST,
            glow::STENCIL_TEST,
            glow::DEPTH_TEST,
            glow::CULL_FACE,
            glow::DITHER,
            glow::POLYGON_OFFSET_FILL,
            glow::RASTERIZER_DISCARD,
            glow::SAMPLE_ALPHA_TO_COVERAGE,
            glow::SAMPLE_COVERAGE,
        ];
        // Primitive restart is always on in WebGL, which has no enum for it.
        if cfg!(not(target_arch = "wasm32")) {
            switches.push(glow::PRIMITIVE_RESTART_FIXED_INDEX);
        }
        if desktop || capabilities.version >= (3, 1) {
            switches.push(glow::SAMPLE_MASK);
        }
        let encoding = desktop || has("GL_EXT_sRGB_write_control");
        if encoding {
            switches.push(glow::FRAMEBUFFER_SRGB);
        }
        if has("GL_EXT_depth_bounds_test") {
            switches.push(DEPTH_BOUNDS_TEST);
        }
        if desktop {
            switches.extend([
                glow::PRIMITIVE_RESTART,
                glow::COLOR_LOGIC_OP,
                glow::POLYGON_SMOOTH,
                glow::SAMPLE_ALPHA_TO_ONE,
            ]);
        }
        // SAFETY: every context of OpenGL 3.2 or later has the value.
        let profile = || unsafe { gl.get_parameter_i32(glow::CONTEXT_PROFILE_MASK) as u32 };
        if desktop && profile() & glow::CONTEXT_COMPATIBILITY_PROFILE_BIT != 0 {
            switches.extend([ALPHA_TEST, POLYGON_STIPPLE]);
        }
        if capabilities.clip_distances {
            // SAFETY: the enum exists if the context has clip distances.
            let count = unsafe { gl.get_parameter_i32(glow::MAX_CLIP_DISTANCES) }.clamp(0, 8) as u32;
            switches.extend((0..count).map(|i| glow::CLIP_DISTANCE0 + i));
        }
        let sampler = |filter: u32| {
            // SAFETY: the parameters are valid for a sampler, which `delete` deletes.
            unsafe {
                let sampler = gl
                    .create_sampler()
                    .map_err(|reason| GlError::Object { what: "a sampler".into(), reason })?;
                for (name, value) in [
                    (glow::TEXTURE_MIN_FILTER, filter),
                    (glow::TEXTURE_MAG_FILTER, filter),
                    (glow::TEXTURE_WRAP_S, glow::CLAMP_TO_EDGE),
                    (glow::TEXTURE_WRAP_T, glow::CLAMP_TO_EDGE),
                ] {
                    gl.sampler_parameter_i32(sampler, name, value as i32);
                }
                Ok(sampler)
            }
        };
        let stored = || {
            let sampler = sampler(glow::LINEAR)?;
            // SAFETY: the parameter exists with the extension.
            unsafe { gl.sampler_parameter_i32(sampler, TEXTURE_SRGB_DECODE, SKIP_DECODE) };
            Ok(sampler)
        };
        debug_assert!(switches.len() <= 32);
        let indexed = desktop || capabilities.version >= (3, 2);
        Ok(Host {
            switches,
            indexed,
            queries: queries.filter(|_| indexed),
            encoding,
            polygon_mode: desktop,
            viewports: desktop,
            nearest: sampler(glow::NEAREST)?,
            linear: sampler(glow::LINEAR)?,
            stored: has("GL_EXT_texture_sRGB_decode").then(stored).transpose()?,
        })
    }

    /// Turns a switch on or off. With a viewport array, the scissor test is that of the first viewport.
    ///
    /// # Safety
    /// The context is current and has the switch.
    unsafe fn set_switch(&self, gl: &glow::Context, switch: u32, on: bool) {
        // SAFETY: the caller's context has the switch, and one for each viewport if there are several.
        unsafe {
            match (self.viewports && switch == glow::SCISSOR_TEST, on) {
                (true, true) => gl.enable_draw_buffer(switch, 0),
                (true, false) => gl.disable_draw_buffer(switch, 0),
                (false, true) => gl.enable(switch),
                (false, false) => gl.disable(switch),
            }
        }
    }

    /// Sets the depth range; that of the first viewport if there are several.
    ///
    /// # Safety
    /// The context is current.
    unsafe fn set_depth_range(&self, gl: &glow::Context, range: [f32; 2]) {
        // SAFETY: desktop contexts have the function for several viewports.
        unsafe {
            if self.viewports {
                gl.depth_range_f64_slice(0, 1, &[range.map(f64::from)]);
            } else {
                gl.depth_range_f32(range[0], range[1]);
            }
        }
    }

    /// Sets the viewport; the first one if there are several.
    ///
    /// # Safety
    /// The context is current.
    pub(crate) unsafe fn set_viewport(&self, gl: &glow::Context, viewport: [f32; 4]) {
        // SAFETY: desktop contexts have the function for several viewports.
        unsafe {
            if self.viewports {
                // Mesa clamps the numbers in place, so they must not be constants.
                let own = std::hint::black_box([viewport]);
                gl.viewport_f32_slice(0, 1, &own);
            } else {
                let [x, y, width, height] = viewport.map(|n| n as i32);
                gl.viewport(x, y, width, height);
            }
        }
    }

    /// Sets the scissor box; that of the first viewport if there are several.
    ///
    /// # Safety
    /// The context is current.
    unsafe fn set_scissor_box(&self, gl: &glow::Context, [x, y, width, height]: [i32; 4]) {
        // SAFETY: desktop contexts have the function for several viewports; sizes are not negative.
        unsafe {
            if self.viewports {
                gl.scissor_slice(0, 1, &[[x, y, width, height]]);
            } else {
                gl.scissor(x, y, width, height);
            }
        }
    }

    pub(crate) fn delete(&self, gl: &glow::Context) {
        // SAFETY: created in `new`, deleted once.
        unsafe {
            gl.delete_sampler(self.nearest);
            gl.delete_sampler(self.linear);
            self.stored.into_iter().for_each(|sampler| gl.delete_sampler(sampler));
        }
    }
}

/// State that only some pipelines touch.
#[derive(Clone, Copy, Debug)]
pub struct Touched {
    /// The number of colour attachments that are drawn to, 1 or 2.
    pub draw_buffers: u32,
    /// True if the source's textures are arrays.
    pub arrays: bool,
    /// True if written pixels are marked.
    pub marks: bool,
}

/// What marks written pixels.
struct Marks {
    scissor_box: [i32; 4],
    /// Function, reference, mask of the function, operations, write mask; of the front and the back.
    stencil: [[i32; 7]; 2],
}

/// The queries of [`Marks::stencil`].
const STENCIL: [[u32; 7]; 2] = [
    [
        glow::STENCIL_FUNC,
        glow::STENCIL_REF,
        glow::STENCIL_VALUE_MASK,
        glow::STENCIL_FAIL,
        glow::STENCIL_PASS_DEPTH_FAIL,
        glow::STENCIL_PASS_DEPTH_PASS,
        glow::STENCIL_WRITEMASK,
    ],
    [
        glow::STENCIL_BACK_FUNC,
        glow::STENCIL_BACK_REF,
        glow::STENCIL_BACK_VALUE_MASK,
        glow::STENCIL_BACK_FAIL,
        glow::STENCIL_BACK_PASS_DEPTH_FAIL,
        glow::STENCIL_BACK_PASS_DEPTH_PASS,
        glow::STENCIL_BACK_WRITEMASK,
    ],
];

impl Marks {
    /// # Safety
    /// The context is current.
    unsafe fn saved(gl: &glow::Context) -> Marks {
        let mut scissor_box = [0; 4];
        // SAFETY: four integers are written for the box, and one for each of the others, which every context has.
        unsafe {
            gl.get_parameter_i32_slice(glow::SCISSOR_BOX, &mut scissor_box);
            Marks { scissor_box, stencil: STENCIL.map(|face| face.map(|name| gl.get_parameter_i32(name))) }
        }
    }

    /// # Safety
    /// The context is current.
    unsafe fn restore(&self, gl: &glow::Context, host: &Host) {
        // SAFETY: values that the context itself returned.
        unsafe {
            host.set_scissor_box(gl, self.scissor_box);
            for (face, values) in [glow::FRONT, glow::BACK].into_iter().zip(self.stencil) {
                let [func, reference, mask, fail, depth_fail, pass, write] = values;
                gl.stencil_func_separate(face, func as u32, reference, mask as u32);
                gl.stencil_op_separate(face, fail as u32, depth_fail as u32, pass as u32);
                gl.stencil_mask_separate(face, write as u32);
            }
        }
    }
}

/// The state that synthesis changes, as saved by [`Context::save_state`].
pub struct HostState {
    /// Bit `i` is set if switch `i` of [`Host::switches`] was on.
    switches: u32,
    /// Number of draw buffers whose state is saved.
    draw_buffers: usize,
    blend: [bool; DRAW_BUFFERS],
    color_mask: [[bool; 4]; DRAW_BUFFERS],
    depth_func: u32,
    depth_mask: bool,
    depth_range: [f32; 2],
    /// Modes of the front and the back.
    polygon_mode: [u32; 2],
    viewport: [f32; 4],
    draw_framebuffer: Option<glow::Framebuffer>,
    read_framebuffer: Option<glow::Framebuffer>,
    program: Option<glow::Program>,
    vertex_array: Option<glow::VertexArray>,
    active_unit: u32,
    textures: [Option<glow::Texture>; UNITS],
    /// Textures of [`ARRAY_UNITS`], if the pipeline touches them.
    arrays: Option<[Option<glow::Texture>; ARRAY_UNITS.len()]>,
    samplers: [Option<glow::Sampler>; UNITS],
    /// `None` if the pipeline marks nothing.
    marks: Option<Marks>,
}

impl Context {
    /// Sets all state that a pipeline relies on and does not set in each pass: everything in the table of
    /// `yoro::opengl::Pipeline` except program, vertex array, framebuffer, viewport and textures. `draw_buffers` is
    /// the number of the target's colour attachments, 1 or 2. If `encode` is true, writes to sRGB framebuffers are
    /// encoded.
    pub fn begin_synthesis(&self, draw_buffers: u32, encode: bool) {
        let (gl, host) = (self.raw(), &self.host);
        // SAFETY: `Host::new` has checked that the enums of these state calls exist in this context.
        unsafe {
            host.switches.iter().for_each(|switch| host.set_switch(gl, *switch, false));
            if encode && host.encoding {
                gl.enable(glow::FRAMEBUFFER_SRGB);
            }
            if host.indexed {
                for buffer in 0..draw_buffers {
                    gl.disable_draw_buffer(glow::BLEND, buffer);
                    gl.color_mask_draw_buffer(buffer, true, true, true, true);
                }
            } else {
                gl.disable(glow::BLEND);
                gl.color_mask(true, true, true, true);
            }
            gl.depth_func(glow::ALWAYS);
            gl.depth_mask(true);
            host.set_depth_range(gl, [0.0, 1.0]);
            if host.polygon_mode {
                gl.polygon_mode(glow::FRONT_AND_BACK, glow::FILL);
            }
            for unit in 0..UNITS as u32 {
                let sampler = if unit == FILTERED_UNIT { host.linear } else { host.nearest };
                gl.bind_sampler(unit, Some(sampler));
            }
        }
    }

    /// Filters what is sampled from a unit, 0 to 3, until [`Context::end_synthesis`].
    pub fn filter_unit(&self, unit: u32) {
        // SAFETY: the sampler lives as long as the context.
        unsafe { self.raw().bind_sampler(unit, Some(self.host.linear)) }
    }

    /// True if synthesis can read sRGB as it is stored, without decoding it (`EXT_texture_sRGB_decode`).
    pub fn reads_stored(&self) -> bool {
        self.host.stored.is_some()
    }

    /// Makes synthesis read colour as it is stored until [`Context::end_synthesis`], if [`Context::reads_stored`].
    pub fn read_stored(&self) {
        // SAFETY: the sampler lives as long as the context.
        unsafe { self.raw().bind_sampler(FILTERED_UNIT, Some(self.host.stored.unwrap_or(self.host.linear))) }
    }

    /// Makes texture unit 0 active. New textures are bound to the active unit, so it must be one that synthesis may
    /// change.
    pub fn set_first_unit(&self) {
        // SAFETY: every context has unit 0.
        unsafe { self.raw().active_texture(glow::TEXTURE0) }
    }

    /// Turns depth writes, without a test, on or off for the next draws of a pipeline.
    pub fn set_depth_write(&self, on: bool) {
        // SAFETY: a valid enum.
        unsafe { if on { self.raw().enable(glow::DEPTH_TEST) } else { self.raw().disable(glow::DEPTH_TEST) } }
    }

    /// Clears depth and stencil in a rectangle of the bound framebuffer, for [`Context::marking_stencil`] or
    /// [`Context::marking_depth`]: depth to the farthest, and, if it is the mark, stencil to 0. Depth is written since
    /// [`Context::begin_synthesis`].
    pub fn clear_marks(&self, to: &Destination, farthest: f32, stencil: bool) {
        let (gl, host) = (self.raw(), &self.host);
        let ([x, y], [w, h]) = (to.origin.map(|n| n as i32), to.size.map(|n| n as i32));
        // SAFETY: state calls with valid enums; what the framebuffer lacks is not cleared.
        unsafe {
            host.set_scissor_box(gl, [x, y, w, h]);
            host.set_switch(gl, glow::SCISSOR_TEST, true);
            if stencil {
                gl.stencil_mask(0xff);
                gl.clear_buffer_depth_stencil(glow::DEPTH_STENCIL, 0, farthest, 0);
            } else {
                gl.clear_buffer_f32_slice(glow::DEPTH, 0, &[farthest]);
            }
            host.set_switch(gl, glow::SCISSOR_TEST, false);
        }
    }

    /// Runs draws that set stencil to 1 in each pixel that they write, whose stencil was cleared.
    pub fn marking_stencil(&self, draws: impl FnOnce()) {
        let gl = self.raw();
        // SAFETY: state calls with valid enums.
        unsafe {
            gl.stencil_func(glow::ALWAYS, 1, 0xff);
            gl.stencil_op(glow::KEEP, glow::KEEP, glow::REPLACE);
            gl.enable(glow::STENCIL_TEST);
            draws();
            gl.disable(glow::STENCIL_TEST);
        }
    }

    /// Runs draws that set depth to the nearest in each pixel that they write, with depth writes on.
    pub fn marking_depth(&self, nearest: f32, draws: impl FnOnce()) {
        let (gl, host) = (self.raw(), &self.host);
        // SAFETY: the context is current.
        unsafe { host.set_depth_range(gl, [nearest; 2]) };
        draws();
        // SAFETY: as above.
        unsafe { host.set_depth_range(gl, [0.0, 1.0]) };
    }

    /// Unbinds the samplers, which would override the filters of the host's textures.
    pub fn end_synthesis(&self) {
        for unit in 0..UNITS as u32 {
            // SAFETY: every context has more units than are in use.
            unsafe { self.raw().bind_sampler(unit, None) }
        }
    }

    /// Returns all state that synthesis changes. Makes about 50 queries and allocates nothing.
    pub fn save_state(&self, touched: Touched) -> HostState {
        let (gl, host) = (self.raw(), &self.host);
        // SAFETY: `Host::new` has checked that the queried state exists, and the arrays are as long as what GL writes.
        unsafe {
            let integer = |name| gl.get_parameter_i32(name);
            let on = |(i, switch): (usize, &u32)| u32::from(gl.is_enabled(*switch)) << i;
            let mut state = HostState {
                switches: host.switches.iter().enumerate().map(on).sum(),
                draw_buffers: (touched.draw_buffers as usize).min(DRAW_BUFFERS),
                blend: [gl.is_enabled(glow::BLEND); DRAW_BUFFERS],
                color_mask: [gl.get_parameter_bool_array(glow::COLOR_WRITEMASK); DRAW_BUFFERS],
                depth_func: integer(glow::DEPTH_FUNC) as u32,
                depth_mask: gl.get_parameter_bool(glow::DEPTH_WRITEMASK),
                depth_range: [0.0; 2],
                polygon_mode: [glow::FILL; 2],
                viewport: [0.0; 4],
                draw_framebuffer: gl.get_parameter_framebuffer(glow::DRAW_FRAMEBUFFER_BINDING),
                read_framebuffer: gl.get_parameter_framebuffer(glow::READ_FRAMEBUFFER_BINDING),
                program: gl.get_parameter_program(glow::CURRENT_PROGRAM),
                vertex_array: gl.get_parameter_vertex_array(glow::VERTEX_ARRAY_BINDING),
                active_unit: integer(glow::ACTIVE_TEXTURE) as u32,
                textures: [None; UNITS],
                arrays: touched.arrays.then_some([None; ARRAY_UNITS.len()]),
                samplers: [None; UNITS],
                marks: touched.marks.then(|| Marks::saved(gl)),
            };
            if let Some(queries) = &host.queries {
                for i in 1..state.draw_buffers {
                    let mut mask = [0u8; 4];
                    (queries.get_boolean)(glow::COLOR_WRITEMASK, i as u32, mask.as_mut_ptr());
                    state.color_mask[i] = mask.map(|m| m != 0);
                    state.blend[i] = (queries.is_enabled)(glow::BLEND, i as u32) != 0;
                }
            }
            gl.get_parameter_f32_slice(glow::DEPTH_RANGE, &mut state.depth_range);
            gl.get_parameter_f32_slice(glow::VIEWPORT, &mut state.viewport);
            if host.polygon_mode {
                // Core contexts have one mode, and some drivers do not write the second value.
                let mut modes = [0; 2];
                gl.get_parameter_i32_slice(glow::POLYGON_MODE, &mut modes);
                state.polygon_mode =
                    [modes[0], if modes[1] == 0 { modes[0] } else { modes[1] }].map(|m| m as u32);
            }
            for unit in 0..UNITS {
                gl.active_texture(glow::TEXTURE0 + unit as u32);
                state.textures[unit] = gl.get_parameter_texture(glow::TEXTURE_BINDING_2D);
                state.samplers[unit] = gl.get_parameter_sampler(glow::SAMPLER_BINDING);
            }
            for (unit, texture) in ARRAY_UNITS.into_iter().zip(state.arrays.iter_mut().flatten()) {
                gl.active_texture(glow::TEXTURE0 + unit);
                *texture = gl.get_parameter_texture(glow::TEXTURE_BINDING_2D_ARRAY);
            }
            gl.active_texture(state.active_unit);
            state
        }
    }

    /// Restores the state that [`Context::save_state`] returned.
    pub fn restore_state(&self, state: &HostState) {
        let (gl, host) = (self.raw(), &self.host);
        // SAFETY: the context itself returned these values for the same state, and synthesis deletes no object of the
        // host in between.
        unsafe {
            for (i, switch) in host.switches.iter().enumerate() {
                host.set_switch(gl, *switch, state.switches >> i & 1 != 0);
            }
            for i in 0..state.draw_buffers {
                let (on, [r, g, b, a]) = (state.blend[i], state.color_mask[i]);
                match (host.indexed, on) {
                    (true, true) => gl.enable_draw_buffer(glow::BLEND, i as u32),
                    (true, false) => gl.disable_draw_buffer(glow::BLEND, i as u32),
                    (false, true) => gl.enable(glow::BLEND),
                    (false, false) => gl.disable(glow::BLEND),
                }
                if host.indexed {
                    gl.color_mask_draw_buffer(i as u32, r, g, b, a);
                } else {
                    gl.color_mask(r, g, b, a);
                }
            }
            gl.depth_func(state.depth_func);
            gl.depth_mask(state.depth_mask);
            host.set_depth_range(gl, state.depth_range);
            if host.polygon_mode {
                match state.polygon_mode {
                    [front, back] if front == back => gl.polygon_mode(glow::FRONT_AND_BACK, front),
                    [front, back] => {
                        gl.polygon_mode(glow::FRONT, front);
                        gl.polygon_mode(glow::BACK, back);
                    }
                }
            }
            for unit in 0..UNITS {
                gl.active_texture(glow::TEXTURE0 + unit as u32);
                gl.bind_texture(glow::TEXTURE_2D, state.textures[unit]);
                gl.bind_sampler(unit as u32, state.samplers[unit]);
            }
            for (unit, texture) in ARRAY_UNITS.into_iter().zip(state.arrays.into_iter().flatten()) {
                gl.active_texture(glow::TEXTURE0 + unit);
                gl.bind_texture(glow::TEXTURE_2D_ARRAY, texture);
            }
            gl.active_texture(state.active_unit);
            // A program that was deleted while it was current was destroyed when synthesis made another one current.
            gl.use_program(state.program.filter(|program| gl.is_program(*program)));
            gl.bind_vertex_array(state.vertex_array);
            gl.bind_framebuffer(glow::DRAW_FRAMEBUFFER, state.draw_framebuffer);
            gl.bind_framebuffer(glow::READ_FRAMEBUFFER, state.read_framebuffer);
            host.set_viewport(gl, state.viewport);
            if let Some(marks) = &state.marks {
                marks.restore(gl, host);
            }
        }
    }

    /// Resets the pixel store for uploads of tightly packed pixels.
    pub(crate) fn set_tight_unpack(&self) {
        let gl = self.raw();
        // SAFETY: valid values of the pixel store.
        unsafe {
            gl.bind_buffer(glow::PIXEL_UNPACK_BUFFER, None);
            gl.pixel_store_i32(glow::UNPACK_ALIGNMENT, 1);
            for name in [glow::UNPACK_ROW_LENGTH, glow::UNPACK_SKIP_ROWS, glow::UNPACK_SKIP_PIXELS] {
                gl.pixel_store_i32(name, 0);
            }
        }
    }

    /// Resets the pixel store for readbacks of tightly packed pixels.
    pub(crate) fn set_tight_pack(&self) {
        let gl = self.raw();
        // SAFETY: valid values of the pixel store.
        unsafe {
            gl.bind_buffer(glow::PIXEL_PACK_BUFFER, None);
            gl.pixel_store_i32(glow::PACK_ALIGNMENT, 1);
            for name in [glow::PACK_ROW_LENGTH, glow::PACK_SKIP_ROWS, glow::PACK_SKIP_PIXELS] {
                gl.pixel_store_i32(name, 0);
            }
        }
    }
}
