//! Times of the passes.

use std::collections::VecDeque;
use std::time::Duration;
#[cfg(not(target_arch = "wasm32"))]
use std::time::Instant;

use glow::HasContext;
#[cfg(target_arch = "wasm32")]
use web_time::Instant;

use crate::{Capabilities, GlApi};

/// GL_GPU_DISJOINT_EXT of EXT_disjoint_timer_query: true if the clock was disturbed since this was last queried.
const GPU_DISJOINT: u32 = 0x8FBB;
/// Results are read this many frames late, when they are usually available without waiting.
const FRAMES_LATE: usize = 4;

/// How passes are timed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Profiling {
    /// Passes are not timed.
    Off,
    /// Timer queries if they are reliable, otherwise nothing. Does not wait, so that it can be used while frames are
    /// shown.
    Queries,
    /// Timer queries if they are reliable, otherwise [`Profiling::Finish`].
    Auto,
    /// glFinish before and after each pass, and a CPU clock. Needed on a CPU rasterizer, whose timer queries cover only
    /// the last tile.
    Finish,
}

/// The measured time of one pass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PassTime {
    /// The name given to [`crate::Context::pass`].
    pub name: &'static str,
    /// GPU time or, with [`Profiling::Finish`], wall-clock time.
    pub time: Duration,
}

enum Record {
    Clock(Duration),
    Query(glow::Query),
    /// A query whose result GL leaves undefined.
    Undefined(glow::Query),
}

/// Times passes. A pass within another one counts as part of the outer pass, since timer queries do not nest.
pub(crate) struct Profiler {
    mode: Profiling,
    queries: bool,
    api: GlApi,
    depth: usize,
    started: Option<Instant>,
    records: Vec<(&'static str, Record)>,
    /// Records of frames whose results have not been read yet, oldest first, each with its frame number.
    frames: VecDeque<(u32, Vec<(&'static str, Record)>)>,
    /// Number of frames that have ended.
    ended: u32,
    /// The number of oldest frames whose results are invalid, since the clock was disturbed.
    disturbed: usize,
    pool: Vec<glow::Query>,
}

impl Profiler {
    pub(crate) fn new(capabilities: &Capabilities) -> Profiler {
        Profiler {
            mode: Profiling::Off,
            queries: capabilities.timer_queries,
            api: capabilities.api,
            depth: 0,
            started: None,
            records: Vec::with_capacity(64),
            frames: VecDeque::with_capacity(FRAMES_LATE + 4),
            ended: 0,
            disturbed: 0,
            pool: Vec::new(),
        }
    }

    pub(crate) fn set(&mut self, gl: &glow::Context, mode: Profiling) {
        self.mode = mode;
        self.take(gl);
    }

    pub(crate) fn is_on(&self) -> bool {
        match self.mode {
            Profiling::Off => false,
            Profiling::Queries => self.queries,
            Profiling::Auto | Profiling::Finish => true,
        }
    }

    pub(crate) fn begin(&mut self, gl: &glow::Context, name: &'static str) {
        self.depth += 1;
        if !self.is_on() || self.depth > 1 {
            return;
        }
        // SAFETY: only one query is active at a time, since inner passes return above.
        unsafe {
            if self.queries && self.mode != Profiling::Finish {
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

    /// Ends the pass's query before a draw that would make its result undefined, and that WebGL would refuse.
    pub(crate) fn make_undefined(&mut self, gl: &glow::Context) {
        if self.depth > 0
            && let Some((_, record)) = self.records.last_mut()
            && let Record::Query(query) = *record
        {
            // SAFETY: ends the query that `begin` started.
            unsafe { gl.end_query(glow::TIME_ELAPSED) };
            *record = Record::Undefined(query);
        }
    }

    pub(crate) fn end(&mut self, gl: &glow::Context) {
        self.depth -= 1;
        if !self.is_on() || self.depth > 0 {
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
                Some((_, Record::Undefined(_))) | None => {}
            }
        }
    }

    pub(crate) fn delete(&mut self, gl: &glow::Context) {
        self.take(gl);
        // SAFETY: each query was created here and is deleted once.
        self.pool.drain(..).for_each(|query| unsafe { gl.delete_query(query) });
    }

    pub(crate) fn take(&mut self, gl: &glow::Context) -> Vec<PassTime> {
        let mut times = Vec::with_capacity(self.records.len());
        while let Some((_, mut frame)) = self.frames.pop_front() {
            read(gl, &mut frame, &mut self.pool, &mut times);
        }
        read(gl, &mut self.records, &mut self.pool, &mut times);
        times
    }

    pub(crate) fn end_frame(&mut self, gl: &glow::Context, times: &mut Vec<PassTime>) -> Option<u32> {
        let number = self.ended;
        self.ended = number.wrapping_add(1);
        if self.records.is_empty() {
            return None;
        }
        let ready = |(_, frame): &(u32, Vec<(&'static str, Record)>)| match frame.last() {
            // SAFETY: the query has ended; queries of one kind finish in order.
            Some((_, Record::Query(query))) => unsafe {
                gl.get_query_parameter_u32(*query, glow::QUERY_RESULT_AVAILABLE) != 0
            },
            _ => true,
        };
        let (before, mut read_number, mut taken) = (times.len(), None, 0);
        let mut spare = Vec::new();
        if self.frames.len() >= FRAMES_LATE
            && self.frames.front().is_some_and(ready)
            && let Some((then, frame)) = self.frames.pop_front()
        {
            spare = frame;
            read_number = read(gl, &mut spare, &mut self.pool, times).then_some(then);
            taken = 1;
        }
        // SAFETY: in OpenGL ES, the extension with timer queries defines this state.
        if self.queries && self.api == GlApi::Es && unsafe { gl.get_parameter_bool(GPU_DISJOINT) } {
            self.disturbed = self.frames.len() + taken + 1;
        }
        if taken > 0 && self.disturbed > 0 {
            self.disturbed -= 1;
            times.truncate(before);
            read_number = None;
        }
        self.frames.push_back((number, std::mem::replace(&mut self.records, spare)));
        read_number.map(|then| number.wrapping_sub(then))
    }
}

/// Reads results into `times`, waiting for those that are not available yet, and returns their queries to the pool.
/// Returns false, and adds nothing, if one of them is undefined: the times of some passes would look like those of all.
fn read(
    gl: &glow::Context,
    records: &mut Vec<(&'static str, Record)>,
    pool: &mut Vec<glow::Query>,
    times: &mut Vec<PassTime>,
) -> bool {
    let is_defined = !records.iter().any(|(_, record)| matches!(record, Record::Undefined(_)));
    for (name, record) in records.drain(..) {
        let time = match record {
            Record::Clock(time) => time,
            Record::Query(query) | Record::Undefined(query) => {
                pool.push(query);
                if !is_defined {
                    continue;
                }
                // SAFETY: the query has ended; reading its result waits for it.
                Duration::from_nanos(unsafe { gl.get_query_parameter_u64(query, glow::QUERY_RESULT) })
            }
        };
        times.push(PassTime { name, time });
    }
    is_defined
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::capabilities::Loaded;
    use yoro_context::{Backend, Headless};

    const NOTHING: Loaded = Loaded { multiview: false, sample_masks: false };

    fn profiler(gl: &glow::Context, timer_queries: bool) -> Profiler {
        Profiler::new(&Capabilities { timer_queries, ..Capabilities::query(gl, NOTHING, || true).unwrap() })
    }

    /// llvmpipe has timer queries; their values do not matter here.
    #[test]
    fn query_results_come_some_frames_late() {
        let headless = Headless::open(Backend::Egl).unwrap();
        let gl = headless.gl();
        let mut profiler = profiler(gl.raw(), true);
        profiler.set(gl.raw(), Profiling::Queries);
        let mut times = Vec::new();
        for frame in 0..10 {
            for name in ["first", "second"] {
                profiler.begin(gl.raw(), name);
                profiler.end(gl.raw());
            }
            gl.finish();
            let read = profiler.end_frame(gl.raw(), &mut times);
            assert_eq!(read, (frame >= FRAMES_LATE).then_some(FRAMES_LATE as u32), "frame {frame}");
        }
        let names: Vec<_> = times.iter().map(|t| t.name).collect();
        assert_eq!(names, ["first", "second"].repeat(10 - FRAMES_LATE));
        assert_eq!(profiler.take(gl.raw()).len(), 2 * FRAMES_LATE);
        profiler.delete(gl.raw());
        assert_eq!(gl.take_errors(), None);
    }

    #[test]
    fn a_frame_with_an_undefined_time_has_none() {
        let headless = Headless::open(Backend::Egl).unwrap();
        let gl = headless.gl();
        let mut profiler = profiler(gl.raw(), true);
        profiler.set(gl.raw(), Profiling::Queries);
        let mut times = Vec::new();
        let mut told = Vec::new();
        for frame in 0..10 {
            for name in ["first", "second"] {
                profiler.begin(gl.raw(), name);
                if frame % 2 == 0 && name == "first" {
                    profiler.make_undefined(gl.raw());
                }
                profiler.end(gl.raw());
            }
            // Outside of a pass nothing is being timed.
            profiler.make_undefined(gl.raw());
            gl.finish();
            told.extend(profiler.end_frame(gl.raw(), &mut times));
            if frame == 4 {
                // A frame without passes counts, too.
                assert_eq!(profiler.end_frame(gl.raw(), &mut times), None);
            }
        }
        // Frames 1, 3 and 5, reported at the ends of frames 5, 7 and 9.
        assert_eq!((told.as_slice(), times.len()), (&[5, 5, 4][..], 6));
        profiler.take(gl.raw());
        assert!(profiler.pool.len() <= 2 * (FRAMES_LATE + 1), "queries are used again");
        profiler.delete(gl.raw());
        assert_eq!(gl.take_errors(), None);
    }

    #[test]
    fn without_queries_nothing_is_timed_and_nothing_waits() {
        let headless = Headless::open(Backend::Egl).unwrap();
        let gl = headless.gl();
        let mut profiler = profiler(gl.raw(), false);
        profiler.set(gl.raw(), Profiling::Queries);
        let mut times = Vec::new();
        profiler.begin(gl.raw(), "pass");
        profiler.end(gl.raw());
        assert_eq!((profiler.end_frame(gl.raw(), &mut times), times.len()), (None, 0));
    }
}
