//! A record of the GPU commands of frames, for models of their cost on other GPUs.

use std::cell::RefCell;
use std::collections::HashMap;
use std::rc::Rc;

use glow::HasContext;

use yoro_gl::{
    Aspect, Attachments, Blend, Context, DepthTest, Event, GlApi, Image, Observer, ProgramRecipe,
    RasterState, Shape,
};

/// A draw call.
#[derive(Clone, Debug, PartialEq)]
pub struct Draw {
    /// The name given to the innermost [`Context::pass`]; empty outside of passes.
    pub pass: &'static str,
    /// The program.
    pub program: Rc<ProgramRecipe>,
    /// The framebuffer; `None` for one that does not belong to this library.
    pub target: Option<Rc<Attachments>>,
    /// The textures that the program samples, with the names of their uniforms, sorted by name.
    pub textures: Vec<(String, Image)>,
    /// The number of columns and rows of the viewport that are drawn.
    pub area: [u32; 2],
    /// The same of the viewport with which the framebuffer was bound, of which the current one may be a part.
    pub view: [u32; 2],
    /// The triangles.
    pub shape: Shape,
    /// True if the draw is blended with the colour attachments.
    pub blends: bool,
    /// True if the depth attachment is tested or written.
    pub uses_depth: bool,
    /// True if the depth attachment is written.
    pub writes_depth: bool,
    /// True if a mask lets only some of each pixel's samples through.
    pub masks_samples: bool,
    /// Samples that passed the depth test and were not discarded. Counted by desktop GL only.
    pub samples_passed: Option<u64>,
}

/// A command to the GPU.
#[derive(Clone, Debug, PartialEq)]
pub enum Command {
    /// Draws.
    Draw(Draw),
    /// Clears colour and, if the flag is set, depth.
    Clear(Option<Rc<Attachments>>, bool),
    /// Discards the contents of colour, depth or both.
    Discard(Option<Rc<Attachments>>, [bool; 2]),
    /// Copies or averages `size` pixels of an attachment into another framebuffer's first attachment of its kind.
    Copy {
        /// The innermost pass.
        pass: &'static str,
        /// The source.
        from: Option<Rc<Attachments>>,
        /// The target.
        to: Option<Rc<Attachments>>,
        /// Width and height in pixels.
        size: [u32; 2],
        /// The attachment of the source.
        aspect: Aspect,
    },
}

/// What a recorder knows of a context's objects, the commands so far, and the state that draw calls depend on.
#[derive(Default)]
struct State {
    /// True between [`Recorder::start`] and [`Recorder::take`].
    records: bool,
    commands: Vec<Command>,
    /// The query of each command's passed samples.
    queries: Vec<Option<glow::Query>>,
    /// The query of the draw call that is being made.
    open: Option<glow::Query>,
    /// Sizes and formats of the textures.
    images: HashMap<glow::Texture, Image>,
    framebuffers: HashMap<glow::Framebuffer, Rc<Attachments>>,
    programs: Vec<Rc<ProgramRecipe>>,
    passes: Vec<&'static str>,
    program: Option<(glow::Program, Rc<ProgramRecipe>)>,
    textures: HashMap<glow::Program, HashMap<String, Image>>,
    framebuffer: Option<glow::Framebuffer>,
    viewport: [u32; 2],
    /// The viewport that came with the framebuffer; `None` until it comes.
    view: Option<[u32; 2]>,
    raster: Option<RasterState>,
    masks_depth: bool,
    masks_samples: bool,
}

impl State {
    fn pass(&self) -> &'static str {
        self.passes.last().copied().unwrap_or("")
    }

    fn target(&self, framebuffer: Option<glow::Framebuffer>) -> Option<Rc<Attachments>> {
        self.framebuffers.get(&framebuffer?).cloned()
    }

    fn push(&mut self, command: Command, query: Option<glow::Query>) {
        if self.records {
            self.commands.push(command);
            self.queries.push(query);
        }
    }

    fn draw(&self, shape: Shape) -> Option<Draw> {
        let (raw, program) = self.program.as_ref()?;
        let mut textures: Vec<_> = self.textures.get(raw).into_iter().flatten().collect();
        textures.sort_by_key(|(name, _)| *name);
        let raster = self.raster.unwrap_or(RasterState::SCREEN);
        let uses_depth = raster.depth != DepthTest::Off;
        Some(Draw {
            pass: self.pass(),
            program: program.clone(),
            target: self.target(self.framebuffer),
            textures: textures.into_iter().map(|(name, image)| (name.clone(), *image)).collect(),
            area: self.viewport,
            view: self.view.unwrap_or(self.viewport),
            shape,
            blends: raster.blend != Blend::Off,
            uses_depth,
            writes_depth: uses_depth && !self.masks_depth && raster.depth != DepthTest::Equal,
            masks_samples: self.masks_samples,
            samples_passed: None,
        })
    }

    /// Records a draw call, and begins to count its samples.
    fn begin_draw(&mut self, gl: &Context, shape: Shape) {
        let Some(draw) = self.draw(shape).filter(|_| self.records) else { return };
        // OpenGL ES only tells whether any sample has passed.
        if gl.capabilities().api == GlApi::Desktop {
            // SAFETY: the query is deleted by `Recorder::take`. None of this target is active, since each ends with its draw
            // call.
            unsafe {
                self.open = gl.raw().create_query().ok();
                if let Some(query) = self.open {
                    gl.raw().begin_query(glow::SAMPLES_PASSED, query);
                }
            }
        }
        self.push(Command::Draw(draw), self.open);
    }

    fn observe(&mut self, gl: &Context, event: &Event) {
        match *event {
            Event::TextureMade(texture, image) => {
                self.images.insert(texture, image);
            }
            Event::TextureDeleted(texture) => {
                self.images.remove(&texture);
            }
            Event::FramebufferMade(framebuffer, ref images) => {
                self.framebuffers.insert(framebuffer, Rc::new(images.clone()));
            }
            Event::FramebufferDeleted(framebuffer) => {
                self.framebuffers.remove(&framebuffer);
            }
            Event::ProgramMade(recipe) => self.programs.push(recipe.clone()),
            Event::PassBegins(name) => self.passes.push(name),
            Event::PassEnds => {
                self.passes.pop();
            }
            Event::FramebufferBound(framebuffer) => (self.framebuffer, self.view) = (framebuffer, None),
            Event::ViewportSet(size) => {
                self.viewport = size;
                self.view.get_or_insert(size);
            }
            Event::ProgramBound(raw, recipe) => self.program = Some((raw, recipe.clone())),
            Event::TextureSampled { program, name, texture } => {
                if let Some(image) = self.images.get(&texture) {
                    self.textures.entry(program).or_default().insert(name.to_owned(), *image);
                }
            }
            Event::StateSet(raster) => {
                (self.raster, self.masks_depth) = (Some(raster), false);
            }
            Event::DepthMasked => self.masks_depth = true,
            Event::SamplesMasked(mask) => self.masks_samples = mask.is_some(),
            Event::DrawBegins(shape) => self.begin_draw(gl, shape),
            Event::DrawEnds if self.open.take().is_some() => {
                // SAFETY: ends the query that the draw call began.
                unsafe { gl.raw().end_query(glow::SAMPLES_PASSED) };
            }
            Event::Cleared { depth } => self.push(Command::Clear(self.target(self.framebuffer), depth), None),
            Event::Discarded { framebuffer, color, depth } => {
                self.push(Command::Discard(self.target(Some(framebuffer)), [color, depth]), None);
            }
            Event::Copied { from, to, size, aspect } => {
                let (pass, from, to) = (self.pass(), self.target(from), self.target(to));
                self.push(Command::Copy { pass, from, to, size, aspect }, None);
            }
            _ => {}
        }
    }
}

/// Records what a context does. Knows only the textures, framebuffers and programs that are made while it exists.
pub struct Recorder {
    gl: Rc<Context>,
    state: Rc<RefCell<State>>,
}

struct Shared(Rc<RefCell<State>>);

impl Observer for Shared {
    fn observe(&mut self, gl: &Context, event: &Event) {
        self.0.borrow_mut().observe(gl, event);
    }
}

impl Recorder {
    /// Returns the recorder of a context from now on, in place of any earlier observer.
    pub fn new(gl: &Rc<Context>) -> Recorder {
        let state = Rc::<RefCell<State>>::default();
        gl.set_observer(Some(Box::new(Shared(state.clone()))));
        Recorder { gl: gl.clone(), state }
    }

    /// Starts recording commands.
    pub fn start(&self) {
        self.state.borrow_mut().records = true;
    }

    /// Stops recording, and returns the commands since [`Recorder::start`]. Waits for the GPU.
    pub fn take(&self) -> Vec<Command> {
        let mut state = self.state.borrow_mut();
        state.records = false;
        let mut commands = std::mem::take(&mut state.commands);
        for (command, query) in commands.iter_mut().zip(std::mem::take(&mut state.queries)) {
            if let (Command::Draw(draw), Some(query)) = (command, query) {
                // SAFETY: the query has ended; reading its result waits for it. It is deleted once.
                unsafe {
                    let passed = self.gl.raw().get_query_parameter_u32(query, glow::QUERY_RESULT);
                    draw.samples_passed = Some(passed.into());
                    self.gl.raw().delete_query(query);
                }
            }
        }
        commands
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
