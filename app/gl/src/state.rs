//! Fixed-function state, set as a whole by each pass, so that none depends on what ran before it.

use glow::HasContext;

use crate::Context;

/// More rows than any framebuffer has.
const TALLEST: i32 = 1 << 20;

/// Which depth passes the depth test.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DepthTest {
    /// No test, no write.
    Off,
    /// Smaller passes and is written.
    Less,
    /// Larger passes and is written.
    Greater,
    /// The depth that is there passes: with that of the far plane, where nothing was drawn.
    Equal,
    /// Everything passes and is written.
    Always,
}

/// How a fragment meets what is there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Blend {
    /// Replaces it.
    Off,
    /// Is added to it.
    Add,
    /// Is mixed with it by the fragment's alpha; the target's alpha (its luma) stays.
    Over,
}

/// Depth test, blending and culling of a draw.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RasterState {
    /// Depth test.
    pub depth: DepthTest,
    /// Blending of all colour attachments.
    pub blend: Blend,
    /// Whether back faces (clockwise) are culled.
    pub cull: bool,
}

impl RasterState {
    /// A pass over the whole screen.
    pub const SCREEN: RasterState = RasterState { depth: DepthTest::Off, blend: Blend::Off, cull: false };
    /// A pass over the whole screen that writes depth, too.
    pub const SCREEN_DEPTH: RasterState = RasterState { depth: DepthTest::Always, ..RasterState::SCREEN };
}

impl Context {
    /// Sets depth test, blending and culling; stencil test and dithering are off, everything is written. The scissor test
    /// is off but within [`Context::within_columns`].
    pub fn set_raster_state(&self, state: &RasterState) {
        let gl = self.raw();
        // SAFETY: state calls with valid enums.
        unsafe {
            let toggle = |capability, on| if on { gl.enable(capability) } else { gl.disable(capability) };
            toggle(glow::DEPTH_TEST, state.depth != DepthTest::Off);
            gl.depth_func(match state.depth {
                DepthTest::Off | DepthTest::Less => glow::LESS,
                DepthTest::Greater => glow::GREATER,
                DepthTest::Equal => glow::EQUAL,
                DepthTest::Always => glow::ALWAYS,
            });
            gl.depth_mask(true);
            gl.color_mask(true, true, true, true);
            toggle(glow::BLEND, state.blend != Blend::Off);
            match state.blend {
                Blend::Off => {}
                Blend::Add => gl.blend_func(glow::ONE, glow::ONE),
                Blend::Over => {
                    gl.blend_func_separate(glow::SRC_ALPHA, glow::ONE_MINUS_SRC_ALPHA, glow::ZERO, glow::ONE)
                }
            }
            toggle(glow::CULL_FACE, state.cull);
            toggle(glow::SCISSOR_TEST, self.columns.get().is_some());
            if let Some([first, end]) = self.columns.get() {
                gl.scissor(first as i32, 0, end.saturating_sub(first) as i32, TALLEST);
            }
            gl.disable(glow::STENCIL_TEST);
            gl.disable(glow::DITHER);
        }
    }

    /// Draws only within some columns of whatever framebuffer is bound, `[first, end]` from the left, as far as `body` sets
    /// its state by [`Context::set_raster_state`]; `None` for all columns. Clearing is not bounded.
    pub fn within_columns<R>(&self, columns: Option<[u32; 2]>, body: impl FnOnce() -> R) -> R {
        let before = self.columns.replace(columns);
        let result = body();
        self.columns.set(before);
        result
    }

    /// The columns that draws are bounded to now, by [`Context::within_columns`].
    pub fn columns(&self) -> Option<[u32; 2]> {
        self.columns.get()
    }

    /// Keeps the next draws from writing colour, until the state is set again: for programs that write depth alone into a
    /// target that has colour, too. Without it colour would be undefined, and WebGL refuses to draw.
    pub fn mask_color(&self) {
        // SAFETY: no object is involved.
        unsafe { self.raw().color_mask(false, false, false, false) }
    }

    /// Keeps the next draws from writing depth, until the state is set again: for what is tested and blended.
    pub fn mask_depth(&self) {
        // SAFETY: no object is involved.
        unsafe { self.raw().depth_mask(false) }
    }

    /// Whether the alpha of a fragment decides how many of its pixel's samples it covers, instead of being stored.
    /// Comes after [`Context::set_raster_state`]; whoever turns it on turns it off again.
    pub fn set_alpha_to_coverage(&self, on: bool) {
        let gl = self.raw();
        // SAFETY: a valid enum.
        unsafe {
            if on {
                gl.enable(glow::SAMPLE_ALPHA_TO_COVERAGE)
            } else {
                gl.disable(glow::SAMPLE_ALPHA_TO_COVERAGE)
            }
            gl.color_mask(true, true, true, !on);
        }
    }

    /// Maps the depth of the clip volume, -1 to 1, to another part of the depth buffer's 0 to 1 than all of it.
    /// Whoever narrows it sets it back.
    pub fn set_depth_window(&self, [low, high]: [f32; 2]) {
        // SAFETY: GL clamps the values.
        unsafe { self.raw().depth_range_f32(low, high) }
    }

    /// Whether `gl_ClipDistance[0]` clips. Whoever turns it on turns it off again: programs that do not write it
    /// are undefined with it.
    pub fn set_clip_distance(&self, on: bool) {
        debug_assert!(self.capabilities().clip_distances);
        // SAFETY: a valid enum where the capability says so.
        unsafe {
            if on {
                self.raw().enable(glow::CLIP_DISTANCE0);
            } else {
                self.raw().disable(glow::CLIP_DISTANCE0);
            }
        }
    }

    /// Clears the bound framebuffer: all colour attachments to zero and, if given, depth to a value.
    pub fn clear(&self, depth: Option<f32>) {
        let gl = self.raw();
        let mut mask = glow::COLOR_BUFFER_BIT;
        // SAFETY: state calls with valid enums.
        unsafe {
            if let Some(depth) = depth {
                gl.depth_mask(true);
                gl.clear_depth_f32(depth);
                mask |= glow::DEPTH_BUFFER_BIT;
            }
            gl.disable(glow::SCISSOR_TEST);
            gl.color_mask(true, true, true, true);
            gl.clear_color(0.0, 0.0, 0.0, 0.0);
            gl.clear(mask);
        }
    }

    /// Fills a rectangle of the bound framebuffer's colour attachments; `origin` is its lower left corner in pixels.
    pub fn fill(&self, origin: [u32; 2], size: [u32; 2], color: [f32; 4]) {
        let gl = self.raw();
        let ([x, y], [w, h]) = (origin.map(|n| n as i32), size.map(|n| n as i32));
        // SAFETY: state calls with valid enums; sizes are not negative.
        unsafe {
            gl.color_mask(true, true, true, true);
            gl.enable(glow::SCISSOR_TEST);
            gl.scissor(x, y, w, h);
            gl.clear_color(color[0], color[1], color[2], color[3]);
            gl.clear(glow::COLOR_BUFFER_BIT);
            gl.disable(glow::SCISSOR_TEST);
        }
    }

    /// Sets the viewport, in pixels from the lower left corner of the framebuffer that is bound.
    pub fn set_viewport(&self, origin: [u32; 2], size: [u32; 2]) {
        let ([x, y], [w, h]) = (origin.map(|n| n as i32), size.map(|n| n as i32));
        // SAFETY: sizes are not negative.
        unsafe { self.raw().viewport(x, y, w, h) }
    }

    /// Binds a framebuffer of whatever origin (`None`: the window's) and sets the viewport, in pixels from its
    /// lower left corner.
    pub fn bind_framebuffer(&self, framebuffer: Option<glow::Framebuffer>, origin: [u32; 2], size: [u32; 2]) {
        let ([x, y], [w, h]) = (origin.map(|n| n as i32), size.map(|n| n as i32));
        // SAFETY: the caller's framebuffer is live.
        unsafe {
            self.raw().bind_framebuffer(glow::FRAMEBUFFER, framebuffer);
            self.raw().viewport(x, y, w, h);
        }
    }
}
