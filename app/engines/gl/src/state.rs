//! Fixed-function state, which each pass sets completely, so that no pass depends on earlier ones.

use glow::HasContext;

use crate::Context;

/// The depth test.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DepthTest {
    /// No test, no write.
    Off,
    /// Smaller depth passes and is written.
    Less,
    /// Larger depth passes and is written.
    Greater,
    /// Equal depth passes, and is not changed. With the far plane's depth: pixels where nothing was drawn.
    Equal,
    /// All depth passes and is written.
    Always,
}

/// How a fragment is combined with the pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Blend {
    /// Replaces the pixel.
    Off,
    /// Adds to the pixel.
    Add,
    /// Multiplies the pixel's colour. The target's alpha is not changed.
    Multiply,
    /// Mixes with the pixel by the fragment's alpha. The target's alpha (its luma) is not changed.
    Over,
}

/// The stencil test. What is drawn does not change stencil.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StencilTest {
    /// No test.
    Off,
    /// Pixels with this stencil pass.
    Equal(u8),
}

/// Depth test, blending, culling and stencil test of a draw.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RasterState {
    /// Depth test.
    pub depth: DepthTest,
    /// Blending of all colour attachments.
    pub blend: Blend,
    /// True to cull back faces (clockwise).
    pub cull: bool,
    /// Stencil test.
    pub stencil: StencilTest,
}

impl RasterState {
    /// A pass over the whole screen.
    pub const SCREEN: RasterState =
        RasterState { depth: DepthTest::Off, blend: Blend::Off, cull: false, stencil: StencilTest::Off };
    /// A pass over the whole screen that also writes depth.
    pub const SCREEN_DEPTH: RasterState = RasterState { depth: DepthTest::Always, ..RasterState::SCREEN };
}

impl Context {
    /// Sets depth test, blending, culling and stencil test. Turns off scissor test and dithering, and turns on all writes.
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
                Blend::Multiply => gl.blend_func_separate(glow::DST_COLOR, glow::ZERO, glow::ZERO, glow::ONE),
                Blend::Over => {
                    gl.blend_func_separate(glow::SRC_ALPHA, glow::ONE_MINUS_SRC_ALPHA, glow::ZERO, glow::ONE)
                }
            }
            toggle(glow::CULL_FACE, state.cull);
            gl.disable(glow::SCISSOR_TEST);
            match state.stencil {
                StencilTest::Off => gl.disable(glow::STENCIL_TEST),
                StencilTest::Equal(value) => {
                    gl.enable(glow::STENCIL_TEST);
                    gl.stencil_func(glow::EQUAL, i32::from(value), 0xff);
                    gl.stencil_op(glow::KEEP, glow::KEEP, glow::KEEP);
                }
            }
            gl.disable(glow::DITHER);
        }
    }

    /// Limits colour writes to these channels until the state is set again.
    pub fn mask_colors(&self, [red, green, blue, alpha]: [bool; 4]) {
        // SAFETY: a state call without objects.
        unsafe { self.raw().color_mask(red, green, blue, alpha) }
    }

    /// Turns off depth writes until the state is set again, for surfaces that are tested and blended.
    pub fn mask_depth(&self) {
        // SAFETY: a state call without objects.
        unsafe { self.raw().depth_mask(false) }
    }

    /// Limits what is drawn to a rectangle of the framebuffer until the state is set again; `origin` is its lower left corner
    /// in pixels. A tile-based GPU neither loads nor stores what is outside.
    pub fn clip(&self, origin: [u32; 2], size: [u32; 2]) {
        let gl = self.raw();
        let ([x, y], [w, h]) = (origin.map(|n| n as i32), size.map(|n| n as i32));
        // SAFETY: state calls with valid enums; sizes are not negative.
        unsafe {
            gl.enable(glow::SCISSOR_TEST);
            gl.scissor(x, y, w, h);
        }
    }

    /// Turns alpha to coverage on or off: a fragment's alpha determines how many samples it covers, and is not stored.
    /// Call it after [`Context::set_raster_state`], and turn it off afterwards.
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

    /// Maps depth in the clip volume, -1 to 1, to this part of the depth buffer's range 0 to 1. Set the full range
    /// again afterwards.
    pub fn set_depth_window(&self, [low, high]: [f32; 2]) {
        // SAFETY: GL clamps the values.
        unsafe { self.raw().depth_range_f32(low, high) }
    }

    /// Turns clipping by `gl_ClipDistance[0]` on or off. Turn it off afterwards: drawing with programs that do not
    /// write it is undefined while it is on.
    pub fn set_clip_distance(&self, on: bool) {
        debug_assert!(self.capabilities().clip_distances);
        // SAFETY: the enum exists if the context has clip distances.
        unsafe {
            if on {
                self.raw().enable(glow::CLIP_DISTANCE0);
            } else {
                self.raw().disable(glow::CLIP_DISTANCE0);
            }
        }
    }

    /// Clears the bound framebuffer: all colour attachments to zero, and depth to a value if one is given.
    pub fn clear(&self, depth: Option<f32>) {
        // SAFETY: a state call with a valid enum.
        unsafe { self.raw().disable(glow::SCISSOR_TEST) };
        self.clear_unmasked(depth);
    }

    /// Like [`Context::clear`], for a rectangle only; `origin` is its lower left corner in pixels.
    pub fn clear_rectangle(&self, origin: [u32; 2], size: [u32; 2], depth: Option<f32>) {
        self.clip(origin, size);
        self.clear_unmasked(depth);
        // SAFETY: a state call with a valid enum.
        unsafe { self.raw().disable(glow::SCISSOR_TEST) };
    }

    /// Clears all pixels that pass the scissor test.
    fn clear_unmasked(&self, depth: Option<f32>) {
        let gl = self.raw();
        let mut mask = glow::COLOR_BUFFER_BIT;
        // SAFETY: state calls with valid enums.
        unsafe {
            if let Some(depth) = depth {
                gl.depth_mask(true);
                gl.clear_depth_f32(depth);
                mask |= glow::DEPTH_BUFFER_BIT;
            }
            gl.color_mask(true, true, true, true);
            gl.clear_color(0.0, 0.0, 0.0, 0.0);
            gl.clear(mask);
        }
    }

    /// Fills a rectangle of the bound framebuffer's colour attachments; `origin` is its lower left corner in pixels.
    pub fn fill(&self, origin: [u32; 2], size: [u32; 2], color: [f32; 4]) {
        let gl = self.raw();
        self.clip(origin, size);
        // SAFETY: state calls with valid enums.
        unsafe {
            gl.color_mask(true, true, true, true);
            gl.clear_color(color[0], color[1], color[2], color[3]);
            gl.clear(glow::COLOR_BUFFER_BIT);
            gl.disable(glow::SCISSOR_TEST);
        }
    }

    /// Sets the viewport, in pixels from the lower left corner of the bound framebuffer.
    pub fn set_viewport(&self, origin: [u32; 2], size: [u32; 2]) {
        self.observe(|observed| observed.area = size);
        let ([x, y], [w, h]) = (origin.map(|n| n as f32), size.map(|n| n as f32));
        // SAFETY: the context is current, and sizes are not negative.
        unsafe { self.host.set_viewport(self.raw(), [x, y, w, h]) }
    }

    /// Binds any framebuffer (`None` for the window's) and sets the viewport, in pixels from its lower left corner.
    pub fn bind_framebuffer(&self, framebuffer: Option<glow::Framebuffer>, origin: [u32; 2], size: [u32; 2]) {
        // SAFETY: GL refuses a name that is not a framebuffer.
        unsafe { self.raw().bind_framebuffer(glow::FRAMEBUFFER, framebuffer) };
        self.set_viewport(origin, size);
    }
}
