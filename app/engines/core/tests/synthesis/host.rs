//! Hosts with special state: deleted programs, pending errors, several viewports, the compatibility profile.

use std::ffi::{CStr, c_void};
use std::mem::transmute;

use glow::HasContext;

use super::laws::on_every_backend;
use super::state::{Lent, clean, gather, program};
use yoro::opengl::{Context, GlState};
use yoro_context::{Backend, Headless};
use yoro_gl::Format;

const STATES: [GlState; 2] = [GlState::Leave, GlState::Preserve];

/// True if the tests of desktop contexts are skipped.
fn without_osmesa() -> bool {
    std::env::var_os("YORO_TEST_WITHOUT_OSMESA").is_some()
}

fn current_program(gl: &Context) -> Option<glow::Program> {
    // SAFETY: a query.
    unsafe { gl.raw().get_parameter_program(glow::CURRENT_PROGRAM) }
}

/// GL destroys it when another program becomes current; then no program is restored.
#[test]
fn a_program_that_was_deleted_while_current_is_not_restored() {
    on_every_backend(|gl| {
        let lent = Lent::new(gl, [48, 16], Format::Rgba8);
        let mut gather = gather(gl, GlState::Preserve);
        let own = program(
            gl,
            "void main() { gl_Position = vec4(0.0); }",
            "out vec4 color; void main() { color = vec4(1.0); }",
        );
        // SAFETY: deleted once.
        unsafe {
            gl.raw().use_program(Some(own));
            gl.raw().delete_program(own);
        }
        gather.synthesize(lent.source(), &lent.warp, &lent.target()).unwrap();
        assert_eq!(gl.take_errors(), None);
        assert_eq!(current_program(gl), None);
    });
}

#[test]
fn a_dropped_pipeline_leaves_no_program_current() {
    on_every_backend(|gl| {
        let lent = Lent::new(gl, [48, 16], Format::Rgba8);
        let mut gather = gather(gl, GlState::Leave);
        gather.synthesize(lent.source(), &lent.warp, &lent.target()).unwrap();
        assert!(current_program(gl).is_some());
        drop(gather);
        assert_eq!(current_program(gl), None);
    });
}

#[test]
fn a_pending_error_of_the_host_stays() {
    on_every_backend(|gl| {
        let lent = Lent::new(gl, [48, 16], Format::Rgba8);
        for gl_state in STATES {
            // SAFETY: GL refuses this number, which is not a capability.
            unsafe { gl.raw().enable(0x1234) };
            let mut gather = gather(gl, gl_state);
            gather.synthesize(lent.source(), &lent.warp, &lent.target()).unwrap();
            drop(gather);
            assert_eq!(gl.take_errors().as_deref(), Some("INVALID_ENUM"), "{gl_state:?}");
        }
    });
}

/// Shaders draw to the first viewport; an engine may use the others.
#[test]
fn the_state_of_other_viewports_is_not_touched() {
    if without_osmesa() {
        return;
    }
    let headless = Headless::open(Backend::Osmesa).unwrap();
    let (gl, raw) = (headless.gl(), headless.gl().raw());
    type GetFloats = unsafe extern "system" fn(u32, u32, *mut f32);
    type IsEnabled = unsafe extern "system" fn(u32, u32) -> u8;
    // SAFETY: desktop contexts have both functions, with these signatures.
    let (get, is_enabled) = unsafe {
        (
            transmute::<*const c_void, GetFloats>(headless.entry_point(c"glGetFloati_v")),
            transmute::<*const c_void, IsEnabled>(headless.entry_point(c"glIsEnabledi")),
        )
    };
    let state = |index: u32| {
        let mut values = [0f32; 6];
        // SAFETY: four and two numbers are written.
        let scissor = unsafe {
            get(glow::VIEWPORT, index, values.as_mut_ptr());
            get(glow::DEPTH_RANGE, index, values[4..].as_mut_ptr());
            is_enabled(glow::SCISSOR_TEST, index)
        };
        (values, scissor)
    };
    let lent = Lent::new(gl, [48, 16], Format::Rgba8);
    for gl_state in STATES {
        // SAFETY: valid state of two viewports.
        unsafe {
            // Mesa clamps the numbers in place, so they must not be constants.
            let viewports = std::hint::black_box([[1.5, 2.25, 30.5, 20.0], [3.0, 4.5, 7.0, 9.0]]);
            raw.viewport_f32_slice(0, 2, &viewports);
            raw.depth_range_f64_slice(0, 2, &[[0.25, 0.75], [0.5, 1.0]]);
            raw.disable_draw_buffer(glow::SCISSOR_TEST, 0);
            raw.enable_draw_buffer(glow::SCISSOR_TEST, 1);
        }
        let before = [state(0), state(1)];
        let mut gather = gather(gl, gl_state);
        gather.synthesize(lent.source(), &lent.warp, &lent.target()).unwrap();
        let kept = if gl_state == GlState::Preserve { 0 } else { 1 };
        assert_eq!([state(0), state(1)][kept..], before[kept..], "{gl_state:?}");
    }
}

/// Only the compatibility profile, GLFW's and SDL's default, has alpha test and polygon stipple.
#[test]
fn a_compatibility_profile_discards_no_fragments() {
    if without_osmesa() {
        return;
    }
    let headless = Headless::compatibility().unwrap();
    let gl = headless.gl();
    let function = |name: &CStr| {
        let function = headless.entry_point(name);
        assert!(!function.is_null(), "{name:?}");
        function
    };
    const ALPHA_TEST: u32 = 0x0BC0;
    const POLYGON_STIPPLE: u32 = 0x0B42;
    type AlphaFunc = unsafe extern "system" fn(u32, f32);
    type PolygonStipple = unsafe extern "system" fn(*const [u8; 128]);
    // SAFETY: the compatibility profile has both functions, with these signatures; a stipple has 32 x 32 bits.
    unsafe {
        transmute::<*const c_void, AlphaFunc>(function(c"glAlphaFunc"))(glow::NEVER, 0.0);
        transmute::<*const c_void, PolygonStipple>(function(c"glPolygonStipple"))(&[0x55; 128]);
    }
    let lent = Lent::new(gl, [97, 31], Format::Rgba8);
    let run = |gl_state| {
        let mut gather = gather(gl, gl_state);
        gather.synthesize(lent.source(), &lent.warp, &lent.target()).unwrap();
    };
    // SAFETY: the compatibility profile has both.
    let switch = |switch: u32, on: bool| unsafe {
        if on { gl.raw().enable(switch) } else { gl.raw().disable(switch) }
    };
    let clean_all = || {
        clean(gl);
        switch(ALPHA_TEST, false);
        switch(POLYGON_STIPPLE, false);
    };
    clean_all();
    run(GlState::Leave);
    let want = lent.picture(gl);
    for (name, gl_state) in
        [ALPHA_TEST, POLYGON_STIPPLE].into_iter().flat_map(|s| STATES.map(|state| (s, state)))
    {
        lent.target().framebuffer.inspect(|_| gl.clear(None));
        switch(name, true);
        run(gl_state);
        // SAFETY: a query of a switch that the profile has.
        let on = unsafe { gl.raw().is_enabled(name) };
        assert_eq!(on, gl_state == GlState::Preserve, "0x{name:x}, {gl_state:?}");
        clean_all();
        assert!(lent.picture(gl) == want, "0x{name:x}, {gl_state:?}");
    }
}
