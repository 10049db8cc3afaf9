//! Time per pass.

use std::time::{Duration, Instant};

use glow::HasContext;

use super::Capabilities;

/// How passes are timed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Profiling {
    /// Not at all.
    Off,
    /// Timer queries where they can be trusted, else [`Profiling::Finish`].
    Auto,
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
    depth: usize,
    started: Option<Instant>,
    records: Vec<(&'static str, Record)>,
    pool: Vec<glow::Query>,
}

impl Profiler {
    pub(super) fn new(capabilities: &Capabilities) -> Profiler {
        Profiler {
            mode: Profiling::Off,
            queries: capabilities.timer_queries,
            depth: 0,
            started: None,
            records: Vec::with_capacity(64),
            pool: Vec::new(),
        }
    }

    pub(super) fn set(&mut self, gl: &glow::Context, mode: Profiling) {
        self.mode = mode;
        self.take(gl);
    }

    pub(super) fn begin(&mut self, gl: &glow::Context, name: &'static str) {
        self.depth += 1;
        if self.mode == Profiling::Off || self.depth > 1 {
            return;
        }
        // SAFETY: one query at a time is active, since inner passes return above.
        unsafe {
            if self.queries && self.mode == Profiling::Auto {
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
