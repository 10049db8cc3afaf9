//! A record of a context's passes: what they declare, and their draw calls with the samples that pass.

use std::cell::RefCell;
use std::rc::Rc;

use glow::HasContext;

use yoro_gl::{Context, Declaration, Draw, GlApi, Observer, ProgramRecipe, Shape};

/// A pass that has run.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordedPass {
    /// What it declares. Draw calls outside of passes belong to one without a name.
    pub declaration: Declaration,
    /// Its own draw calls, without those of passes within it.
    pub draws: Vec<RecordedDraw>,
}

/// A draw call.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordedDraw {
    pub program: Rc<ProgramRecipe>,
    pub shape: Shape,
    /// Width and height of the viewport in pixels.
    pub area: [u32; 2],
    /// Samples that passed the depth test and were not discarded. Counted by desktop GL only.
    pub samples_passed: Option<u64>,
}

/// A counter of samples that the GPU may not have finished: the pass and the draw call, by their indices.
struct Query {
    query: glow::Query,
    pass: usize,
    draw: usize,
}

#[derive(Default)]
struct State {
    /// True between [`Recorder::start`] and [`Recorder::take`].
    records: bool,
    passes: Vec<RecordedPass>,
    /// The indices of the passes that have not ended.
    open: Vec<usize>,
    queries: Vec<Query>,
    is_counting: bool,
    programs: Vec<Rc<ProgramRecipe>>,
}

impl State {
    fn begin(&mut self, declaration: &Declaration) {
        self.passes.push(RecordedPass { declaration: declaration.clone(), draws: Vec::new() });
    }
}

struct Shared(Rc<RefCell<State>>);

impl Observer for Shared {
    fn program_made(&mut self, recipe: &Rc<ProgramRecipe>) {
        self.0.borrow_mut().programs.push(recipe.clone());
    }

    fn pass_begins(&mut self, pass: &Declaration) {
        let mut state = self.0.borrow_mut();
        if state.records {
            let index = state.passes.len();
            state.open.push(index);
            state.begin(pass);
        }
    }

    fn pass_ends(&mut self) {
        self.0.borrow_mut().open.pop();
    }

    fn draw_begins(&mut self, gl: &Context, draw: &Draw) {
        let mut state = self.0.borrow_mut();
        if !state.records {
            return;
        }
        let pass = state.open.last().copied().unwrap_or_else(|| {
            state.begin(&Declaration { name: "", reads: Vec::new(), writes: Vec::new() });
            state.passes.len() - 1
        });
        let draws = &mut state.passes[pass].draws;
        let &Draw { program, shape, area } = draw;
        draws.push(RecordedDraw { program: program.clone(), shape, area, samples_passed: None });
        let draw = draws.len() - 1;
        // OpenGL ES only tells whether any sample has passed.
        if gl.capabilities().api == GlApi::Desktop {
            // SAFETY: the query is deleted by `Recorder::take`. None of this target is active, since each ends with its
            // draw call.
            let query = unsafe {
                let query = gl.raw().create_query().expect("queries are core");
                gl.raw().begin_query(glow::SAMPLES_PASSED, query);
                query
            };
            state.is_counting = true;
            state.queries.push(Query { query, pass, draw });
        }
    }

    fn draw_ends(&mut self, gl: &Context) {
        if std::mem::take(&mut self.0.borrow_mut().is_counting) {
            // SAFETY: ends the query that the draw call began.
            unsafe { gl.raw().end_query(glow::SAMPLES_PASSED) };
        }
    }
}

/// Records what a context's passes do.
pub struct Recorder {
    gl: Rc<Context>,
    state: Rc<RefCell<State>>,
}

impl Recorder {
    /// Returns the recorder of a context from now on, in place of any earlier observer.
    pub fn new(gl: &Rc<Context>) -> Recorder {
        let state = Rc::<RefCell<State>>::default();
        gl.set_observer(Some(Box::new(Shared(state.clone()))));
        Recorder { gl: gl.clone(), state }
    }

    /// Starts recording passes.
    pub fn start(&self) {
        self.state.borrow_mut().records = true;
    }

    /// Stops recording, and returns the passes since [`Recorder::start`]. Waits for the GPU.
    pub fn take(&self) -> Vec<RecordedPass> {
        let mut state = self.state.borrow_mut();
        state.records = false;
        let mut passes = std::mem::take(&mut state.passes);
        for Query { query, pass, draw } in std::mem::take(&mut state.queries) {
            // SAFETY: the query has ended; reading its result waits for it. It is deleted once.
            unsafe {
                let passed = self.gl.raw().get_query_parameter_u32(query, glow::QUERY_RESULT);
                passes[pass].draws[draw].samples_passed = Some(passed.into());
                self.gl.raw().delete_query(query);
            }
        }
        passes
    }

    /// Returns the files and defines of the programs compiled so far, in this order, repeated ones included.
    pub fn programs(&self) -> Vec<Rc<ProgramRecipe>> {
        self.state.borrow().programs.clone()
    }
}

impl Drop for Recorder {
    fn drop(&mut self) {
        self.gl.set_observer(None);
    }
}
