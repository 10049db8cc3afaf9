//! The GPU time of the synthesis.

use std::time::Duration;

use glow::HasContext as _;
use yoro::opengl::{Context, GlApi};

use super::Binding;

/// The number of frames whose times may be pending at once.
const TIMED_FRAMES: usize = 4;
/// Constants of OpenGL, and of OpenGL ES with GL_EXT_disjoint_timer_query.
const QUERY_COUNTER_BITS: u32 = 0x8864;
const GPU_DISJOINT: u32 = 0x8FBB;

/// Timestamps before and after the synthesis of each frame. Queries of elapsed time would interfere with the
/// application's.
pub struct Timer {
    queries: [[glow::Query; 2]; TIMED_FRAMES],
    /// The number of the next frame, and how many frames before it are pending.
    next: usize,
    pending: usize,
    /// True if the clock can be disturbed and the driver reports it.
    disjoint: bool,
}

/// The query for the end of a frame's synthesis.
pub struct Timing(glow::Query);

impl Timing {
    pub fn end(self, context: &Context) {
        // SAFETY: a query of this context.
        unsafe { context.raw().query_counter(self.0, glow::TIMESTAMP) }
    }
}

impl Timer {
    /// Creates the queries. Returns `None` if the driver has no timestamps.
    ///
    /// # Safety
    /// The context is that of the binding, and is current.
    pub unsafe fn new(binding: &Binding, context: &Context) -> Option<Timer> {
        type GetQuery = unsafe extern "system" fn(u32, u32, *mut i32);
        if !context.capabilities().timer_queries {
            return None;
        }
        let get_query = binding.load(c"glGetQueryiv");
        // SAFETY: a function of this name has this type, and writes one integer.
        unsafe {
            let get_query = std::mem::transmute::<*const std::ffi::c_void, Option<GetQuery>>(get_query)?;
            let mut bits = 0;
            get_query(glow::TIMESTAMP, QUERY_COUNTER_BITS, &mut bits);
            if bits == 0 {
                return None;
            }
            let mut queries = Vec::with_capacity(2 * TIMED_FRAMES);
            for _ in 0..2 * TIMED_FRAMES {
                queries.push(context.raw().create_query().ok()?);
            }
            let queries = std::array::from_fn(|i| [queries[2 * i], queries[2 * i + 1]]);
            let disjoint = context.capabilities().api == GlApi::Es;
            Some(Timer { queries, next: 0, pending: 0, disjoint })
        }
    }

    /// Begins timing a frame. Returns `None` if the largest number of frames is pending.
    pub fn begin(&mut self, context: &Context) -> Option<Timing> {
        if self.pending == TIMED_FRAMES {
            return None;
        }
        let [first, last] = self.queries[self.next % TIMED_FRAMES];
        self.next += 1;
        self.pending += 1;
        // SAFETY: a query of this context, whose last result has been read.
        unsafe { context.raw().query_counter(first, glow::TIMESTAMP) };
        Some(Timing(last))
    }

    /// Returns the time of the oldest pending frame if it is known. Does not wait.
    pub fn time(&mut self, context: &Context) -> Option<Duration> {
        if self.pending == 0 {
            return None;
        }
        let [first, last] = self.queries[(self.next - self.pending) % TIMED_FRAMES];
        let gl = context.raw();
        // SAFETY: queries of this context that have ended. The parameter exists if `disjoint` is set.
        unsafe {
            if gl.get_query_parameter_u32(last, glow::QUERY_RESULT_AVAILABLE) == 0 {
                return None;
            }
            self.pending -= 1;
            let disturbed = self.disjoint && gl.get_parameter_bool(GPU_DISJOINT);
            let [first, last] =
                [first, last].map(|query| gl.get_query_parameter_u64(query, glow::QUERY_RESULT));
            let time = last.checked_sub(first)?;
            (!disturbed).then_some(Duration::from_nanos(time))
        }
    }
    /// Deletes the queries.
    ///
    /// # Safety
    /// The context is current.
    pub unsafe fn delete(self, gl: &glow::Context) {
        // SAFETY: queries of this context, which are no longer used.
        self.queries.into_iter().flatten().for_each(|query| unsafe { gl.delete_query(query) });
    }
}
