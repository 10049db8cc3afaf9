//! Time per pass.

use std::collections::VecDeque;
use std::time::{Duration, Instant};

use glow::HasContext;

use super::{Capabilities, GlApi};

/// GL_EXT_disjoint_timer_query: something, such as a change of the clock rate, spoilt the queries.
const GPU_DISJOINT: u32 = 0x8FBB;
/// How many frames a GPU may be behind before its frames are timed no more.
const MAX_PENDING_FRAMES: usize = 8;

/// How passes are timed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Profiling {
    /// Not at all.
    Off,
    /// Timer queries where they can be trusted, else [`Profiling::Finish`].
    Auto,
    /// Timer queries where they can be trusted, else nothing; read some frames later, so that nothing ever waits:
    /// for programs that must not miss a frame. See [`super::Context::take_frame_times`].
    Queries,
    /// glFinish before and after each pass, and a CPU clock. The only right way on a CPU rasterizer, whose
    /// timer queries cover the last tile alone.
    Finish,
}

/// Measured time of one pass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PassTime {
    /// Name given to [`super::Context::pass`].
    pub name: &'static str,
    /// Time on the GPU or, on a CPU rasterizer, on the wall clock.
    pub time: Duration,
}

enum Record {
    Clock(Duration),
    Query(glow::Query),
}

/// Passes do not nest for timer queries: an inner pass of a timed one is part of it.
pub(super) struct Profiler {
    mode: Profiling,
    queries: bool,
    disjoint: bool,
    depth: usize,
    started: Option<Instant>,
    records: Vec<(&'static str, Record)>,
    pool: Vec<glow::Query>,
    late: VecDeque<Late>,
    late_frames: usize,
    in_late_pass: bool,
    /// How many of the oldest late frames are spoilt.
    spoilt: usize,
}

enum Late {
    Pass(&'static str, glow::Query),
    FrameEnd,
}

impl Profiler {
    pub(super) fn new(capabilities: &Capabilities) -> Profiler {
        Profiler {
            mode: Profiling::Off,
            queries: capabilities.timer_queries,
            disjoint: capabilities.api == GlApi::Es,
            depth: 0,
            started: None,
            records: Vec::with_capacity(64),
            pool: Vec::new(),
            late: VecDeque::with_capacity(256),
            late_frames: 0,
            in_late_pass: false,
            spoilt: 0,
        }
    }

    pub(super) fn set(&mut self, gl: &glow::Context, mode: Profiling) {
        if self.mode == mode {
            return;
        }
        self.mode = mode;
        self.take(gl);
        self.drop_late();
    }

    /// Forgets the frames whose times are not known yet. A query may be used again before its result was read.
    fn drop_late(&mut self) {
        let queries = self.late.drain(..).filter_map(|entry| match entry {
            Late::Pass(_, query) => Some(query),
            Late::FrameEnd => None,
        });
        self.pool.extend(queries);
        (self.late_frames, self.spoilt) = (0, 0);
    }

    /// Ends a frame of [`Profiling::Queries`]; fills `times` with the oldest frame's when they are known.
    pub(super) fn take_frame(&mut self, gl: &glow::Context, times: &mut Vec<PassTime>) -> bool {
        times.clear();
        if self.mode != Profiling::Queries || !self.queries {
            return false;
        }
        if self.late_frames < MAX_PENDING_FRAMES {
            self.late.push_back(Late::FrameEnd);
            self.late_frames += 1;
        }
        let last = self.late.iter().map_while(|entry| match entry {
            Late::Pass(_, query) => Some(*query),
            Late::FrameEnd => None,
        });
        // Queries finish in the order in which they began.
        // SAFETY: the queries have ended and are live; asking whether a result is there does not wait for it.
        unsafe {
            if let Some(last) = last.last()
                && gl.get_query_parameter_u32(last, glow::QUERY_RESULT_AVAILABLE) == 0
            {
                return false;
            }
            if self.disjoint && gl.get_parameter_i32(GPU_DISJOINT) != 0 {
                self.spoilt = self.late_frames;
            }
        }
        while let Some(Late::Pass(name, query)) = self.late.pop_front() {
            // SAFETY: the result is there.
            let nanoseconds = unsafe { gl.get_query_parameter_u64(query, glow::QUERY_RESULT) };
            self.pool.push(query);
            times.push(PassTime { name, time: Duration::from_nanos(nanoseconds) });
        }
        self.late_frames -= 1;
        if self.spoilt > 0 {
            self.spoilt -= 1;
            times.clear();
        }
        !times.is_empty()
    }

    pub(super) fn begin(&mut self, gl: &glow::Context, name: &'static str) {
        self.depth += 1;
        if self.mode == Profiling::Off || self.depth > 1 {
            return;
        }
        // SAFETY: one query at a time is active, since inner passes return above.
        unsafe {
            if self.mode == Profiling::Queries {
                if self.queries && self.late_frames < MAX_PENDING_FRAMES {
                    let query = self.pool.pop().map_or_else(|| gl.create_query(), Ok);
                    if let Ok(query) = query {
                        gl.begin_query(glow::TIME_ELAPSED, query);
                        self.late.push_back(Late::Pass(name, query));
                        self.in_late_pass = true;
                    }
                }
            } else if self.queries && self.mode == Profiling::Auto {
                let query = self.pool.pop().map_or_else(|| gl.create_query(), Ok);
                if let Ok(query) = query {
                    gl.begin_query(glow::TIME_ELAPSED, query);
                    self.records.push((name, Record::Query(query)));
                }
            } else {
                gl.finish();
                self.started = Some(Instant::now());
                self.records.push((name, Record::Clock(Duration::ZERO)));
            }
        }
    }

    pub(super) fn end(&mut self, gl: &glow::Context) {
        self.depth -= 1;
        if self.mode == Profiling::Off || self.depth > 0 {
            return;
        }
        // SAFETY: ends the query that `begin` started.
        unsafe {
            if self.mode == Profiling::Queries {
                if std::mem::take(&mut self.in_late_pass) {
                    gl.end_query(glow::TIME_ELAPSED);
                }
                return;
            }
            match self.records.last_mut() {
                Some((_, Record::Query(_))) => gl.end_query(glow::TIME_ELAPSED),
                Some((_, Record::Clock(time))) => {
                    gl.finish();
                    *time = self.started.take().map_or(Duration::ZERO, |t| t.elapsed());
                }
                None => {}
            }
        }
    }

    pub(super) fn delete(&mut self, gl: &glow::Context) {
        self.take(gl);
        self.drop_late();
        // SAFETY: each query was created here and is deleted once.
        self.pool.drain(..).for_each(|query| unsafe { gl.delete_query(query) });
    }

    pub(super) fn take(&mut self, gl: &glow::Context) -> Vec<PassTime> {
        let mut times = Vec::with_capacity(self.records.len());
        for (name, record) in self.records.drain(..) {
            let time = match record {
                Record::Clock(time) => time,
                Record::Query(query) => {
                    // SAFETY: the query has ended; reading its result waits for it.
                    let nanoseconds = unsafe { gl.get_query_parameter_u64(query, glow::QUERY_RESULT) };
                    self.pool.push(query);
                    Duration::from_nanos(nanoseconds)
                }
            };
            times.push(PassTime { name, time });
        }
        times
    }
}

#[cfg(all(test, feature = "desktop"))]
mod tests {
    use super::*;
    use crate::platform::{Backend, Headless};

    #[test]
    fn late_times_come_frame_by_frame_without_waiting() {
        let headless = Headless::open(Backend::Auto).unwrap();
        let (gl, capabilities) = (headless.gl().raw(), headless.gl().capabilities().clone());
        // What a CPU rasterizer's timers say is wrong, but it has them.
        let mut profiler = Profiler::new(&Capabilities { timer_queries: true, ..capabilities });
        profiler.set(gl, Profiling::Queries);
        let (mut times, mut frames) = (Vec::new(), 0);
        for _ in 0..40 {
            for name in ["geometry", "fxaa"] {
                profiler.begin(gl, name);
                profiler.begin(gl, "inner");
                profiler.end(gl);
                profiler.end(gl);
            }
            // SAFETY: no arguments.
            unsafe { gl.flush() };
            if profiler.take_frame(gl, &mut times) {
                frames += 1;
                assert_eq!(times.iter().map(|t| t.name).collect::<Vec<_>>(), ["geometry", "fxaa"]);
            }
            assert!(profiler.late_frames <= MAX_PENDING_FRAMES);
        }
        assert!(frames > 0);
        assert!(profiler.pool.len() + profiler.late.len() <= 3 * MAX_PENDING_FRAMES);
        assert!(headless.gl().take_errors().is_none());
        profiler.delete(gl);
    }

    #[test]
    fn without_timers_nothing_is_timed() {
        let headless = Headless::open(Backend::Auto).unwrap();
        let (gl, capabilities) = (headless.gl().raw(), headless.gl().capabilities().clone());
        let mut profiler = Profiler::new(&Capabilities { timer_queries: false, ..capabilities });
        profiler.set(gl, Profiling::Queries);
        let mut times = Vec::new();
        for _ in 0..10 {
            profiler.begin(gl, "geometry");
            profiler.end(gl);
            assert!(!profiler.take_frame(gl, &mut times));
        }
        assert!(profiler.late.is_empty());
    }
}
