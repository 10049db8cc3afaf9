//! A record of the GPU commands of frames, for models of their cost on other GPUs.

use std::collections::HashMap;
use std::rc::Rc;

use glow::HasContext;

use crate::{Blend, Context, DepthTest, Format, GlApi, ProgramRecipe, RasterState};

/// A texture, or an image with several samples per pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Image {
    /// The format.
    pub format: Format,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Samples per pixel.
    pub samples: u32,
}

/// The images that a framebuffer draws into. All commands for one framebuffer share one `Rc`.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Attachments {
    /// The colour attachments.
    pub color: Vec<Image>,
    /// The depth attachment, if there is one.
    pub depth: Option<Image>,
}

/// The triangles of a draw call.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// One triangle that covers the viewport.
    Screen,
    /// A part of a mesh.
    Mesh {
        /// Number of indices of all instances together.
        indices: u64,
        /// Number of vertices to shade: the indices' share of the mesh's vertices, as if each vertex were shaded once
        /// per instance.
        vertices: u64,
        /// Size of a vertex in bytes.
        vertex_bytes: u32,
    },
}

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
    /// The triangles.
    pub shape: Shape,
    /// True if the colour attachments are written.
    pub writes_color: bool,
    /// True if the draw is blended with the colour attachments.
    pub blends: bool,
    /// True if the depth attachment is tested or written.
    pub uses_depth: bool,
    /// True if the depth attachment is written.
    pub writes_depth: bool,
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
    /// Copies or averages `size` pixels of colour, or of depth, into another framebuffer.
    Copy {
        /// The innermost pass.
        pass: &'static str,
        /// The source.
        from: Option<Rc<Attachments>>,
        /// The target.
        to: Option<Rc<Attachments>>,
        /// Width and height in pixels.
        size: [u32; 2],
        /// True for depth, false for the first colour attachment.
        depth: bool,
    },
}

/// The commands so far, and the state that draw calls depend on.
#[derive(Default)]
pub(crate) struct Recorder {
    commands: Vec<Command>,
    /// The query of each command's passed samples.
    queries: Vec<Option<glow::Query>>,
    passes: Vec<&'static str>,
    program: Option<(glow::Program, Rc<ProgramRecipe>)>,
    textures: HashMap<glow::Program, HashMap<String, Image>>,
    framebuffer: Option<glow::Framebuffer>,
    viewport: [u32; 2],
    state: Option<RasterState>,
    masks_color: bool,
    masks_depth: bool,
}

impl Recorder {
    fn push(&mut self, command: Command, query: Option<glow::Query>) {
        self.commands.push(command);
        self.queries.push(query);
    }

    pub(crate) fn enter(&mut self, pass: &'static str) {
        self.passes.push(pass);
    }

    pub(crate) fn leave(&mut self) {
        self.passes.pop();
    }

    fn pass(&self) -> &'static str {
        self.passes.last().copied().unwrap_or("")
    }

    pub(crate) fn bind(&mut self, raw: glow::Program, recipe: &Rc<ProgramRecipe>) {
        self.program = Some((raw, recipe.clone()));
    }

    pub(crate) fn sample(&mut self, program: glow::Program, name: &str, image: Image) {
        self.textures.entry(program).or_default().insert(name.to_owned(), image);
    }

    pub(crate) fn draw_into(&mut self, framebuffer: Option<glow::Framebuffer>) {
        self.framebuffer = framebuffer;
    }

    pub(crate) fn view(&mut self, size: [u32; 2]) {
        self.viewport = size;
    }

    pub(crate) fn set_state(&mut self, state: &RasterState) {
        (self.state, self.masks_color, self.masks_depth) = (Some(*state), false, false);
    }

    pub(crate) fn mask_color(&mut self) {
        self.masks_color = true;
    }

    pub(crate) fn mask_depth(&mut self) {
        self.masks_depth = true;
    }

    /// Sets the state of a screen pass that writes depth or not, as synthesis does for its target.
    pub(crate) fn set_depth_write(&mut self, on: bool) {
        let depth = if on { DepthTest::Always } else { DepthTest::Off };
        self.set_state(&RasterState { depth, ..RasterState::SCREEN });
    }

    fn draw(&self, gl: &Context, shape: Shape) -> Option<Draw> {
        let (raw, program) = self.program.as_ref()?;
        let mut textures: Vec<_> = self.textures.get(raw).into_iter().flatten().collect();
        textures.sort_by_key(|(name, _)| *name);
        let [mut width, height] = self.viewport;
        if let Some([first, end]) = gl.columns() {
            width = end.min(width).saturating_sub(first);
        }
        let state = self.state.unwrap_or(RasterState::SCREEN);
        let uses_depth = state.depth != DepthTest::Off;
        Some(Draw {
            pass: self.pass(),
            program: program.clone(),
            target: gl.target(self.framebuffer),
            textures: textures.into_iter().map(|(name, image)| (name.clone(), *image)).collect(),
            area: [width, height],
            shape,
            writes_color: !self.masks_color,
            blends: state.blend != Blend::Off,
            uses_depth,
            writes_depth: uses_depth && !self.masks_depth && state.depth != DepthTest::Equal,
            samples_passed: None,
        })
    }
}

impl Context {
    /// Starts recording commands. Sizes are known only for textures and framebuffers of this library.
    pub fn record(&self) {
        *self.recorder.borrow_mut() = Some(Recorder::default());
    }

    /// Stops recording, and returns the commands since [`Context::record`]. Waits for the GPU.
    pub fn take_record(&self) -> Vec<Command> {
        let Some(recorder) = self.recorder.take() else { return Vec::new() };
        let mut commands = recorder.commands;
        for (command, query) in commands.iter_mut().zip(recorder.queries) {
            if let (Command::Draw(draw), Some(query)) = (command, query) {
                // SAFETY: the query has ended; reading its result waits for it. It is deleted once.
                unsafe {
                    let passed = self.raw().get_query_parameter_u32(query, glow::QUERY_RESULT);
                    draw.samples_passed = Some(passed.into());
                    self.raw().delete_query(query);
                }
            }
        }
        commands
    }

    /// Changes the record, if one is being made.
    pub(crate) fn recorded(&self, change: impl FnOnce(&mut Recorder)) {
        if let Some(recorder) = &mut *self.recorder.borrow_mut() {
            change(recorder);
        }
    }

    /// Runs a draw call, and records it if a record is being made.
    pub(crate) fn drawing(&self, shape: Shape, draw: impl FnOnce()) {
        let mut counts = false;
        self.recorded(|recorder| {
            let Some(recorded) = recorder.draw(self, shape) else { return };
            // OpenGL ES only tells whether any sample has passed.
            let query = if self.capabilities().api == GlApi::Desktop {
                // SAFETY: creates a query, which `take_record` deletes.
                unsafe { self.raw().create_query() }.ok()
            } else {
                None
            };
            if let Some(query) = query {
                // SAFETY: no query of this target is active, since each ends below.
                unsafe { self.raw().begin_query(glow::SAMPLES_PASSED, query) };
                counts = true;
            }
            recorder.push(Command::Draw(recorded), query);
        });
        draw();
        if counts {
            // SAFETY: ends the query that began above.
            unsafe { self.raw().end_query(glow::SAMPLES_PASSED) };
        }
    }

    pub(crate) fn record_clear(&self, depth: bool) {
        self.recorded(|recorder| {
            let target = self.target(recorder.framebuffer);
            recorder.push(Command::Clear(target, depth), None);
        });
    }

    pub(crate) fn record_discard(&self, framebuffer: glow::Framebuffer, discarded: [bool; 2]) {
        self.recorded(|recorder| {
            recorder.push(Command::Discard(self.target(Some(framebuffer)), discarded), None);
        });
    }

    pub(crate) fn record_copy(
        &self,
        from: Option<glow::Framebuffer>,
        to: Option<glow::Framebuffer>,
        size: [u32; 2],
        depth: bool,
    ) {
        self.recorded(|recorder| {
            let (pass, from, to) = (recorder.pass(), self.target(from), self.target(to));
            recorder.push(Command::Copy { pass, from, to, size, depth }, None);
        });
    }

    /// Returns the images of a framebuffer of this library.
    fn target(&self, framebuffer: Option<glow::Framebuffer>) -> Option<Rc<Attachments>> {
        self.framebuffers.borrow().get(&framebuffer?).cloned()
    }

    /// Notes the images of a framebuffer.
    pub(crate) fn note_framebuffer(&self, framebuffer: glow::Framebuffer, images: Attachments) {
        self.framebuffers.borrow_mut().insert(framebuffer, Rc::new(images));
    }

    pub(crate) fn forget_framebuffer(&self, framebuffer: glow::Framebuffer) {
        self.framebuffers.borrow_mut().remove(&framebuffer);
    }

    /// Notes the size and format of a texture.
    pub(crate) fn note_texture(&self, texture: glow::Texture, image: Image) {
        self.images.borrow_mut().insert(texture, image);
    }

    pub(crate) fn forget_texture(&self, texture: glow::Texture) {
        self.images.borrow_mut().remove(&texture);
    }

    /// Records that a program samples a texture of this library.
    pub(crate) fn record_sampled(&self, program: glow::Program, name: &str, texture: glow::Texture) {
        self.recorded(|recorder| {
            if let Some(image) = self.images.borrow().get(&texture) {
                recorder.sample(program, name, *image);
            }
        });
    }
}
