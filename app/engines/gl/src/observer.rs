//! What passes read and write, as they declare it where they draw, for whoever estimates what frames cost.

use std::rc::Rc;

use crate::{Context, Destination, Format, ProgramRecipe, Texture};

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

impl From<&Texture> for Image {
    fn from(texture: &Texture) -> Image {
        texture.image()
    }
}

impl Destination {
    /// Returns the rectangle as an image of one sample, whatever a tile has, in a format that the framebuffer must have.
    pub fn image(&self, format: Format) -> Image {
        Image { format, size: self.size, samples: 1 }
    }
}

/// An image that a pass samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Read {
    /// The sampler's uniform; `copied` for what is copied or averaged without a program.
    pub uniform: &'static str,
    /// The image.
    pub image: Image,
}

/// An image that a pass draws into.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Write {
    /// The image.
    pub image: Image,
    /// True if its contents are read from memory first.
    pub is_loaded: bool,
    /// True if its contents are written to memory afterwards.
    pub is_stored: bool,
}

/// What a pass declares.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Declaration {
    /// The name given to [`Context::pass`].
    pub name: &'static str,
    /// What it reads.
    pub reads: Vec<Read>,
    /// What it writes.
    pub writes: Vec<Write>,
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
#[derive(Clone, Copy, Debug)]
pub struct Draw<'a> {
    /// The program.
    pub program: &'a Rc<ProgramRecipe>,
    /// The triangles.
    pub shape: Shape,
    /// Width and height of the viewport in pixels.
    pub area: [u32; 2],
}

/// Is told what a context does. Each method does nothing unless it is implemented, and none may use other objects of this
/// library, which would be observed meanwhile.
pub trait Observer {
    /// A program has been linked.
    fn program_made(&mut self, _recipe: &Rc<ProgramRecipe>) {}
    /// A pass begins, perhaps within another one.
    fn pass_begins(&mut self, _pass: &Declaration) {}
    /// The innermost pass ends.
    fn pass_ends(&mut self) {}
    /// A draw call follows.
    fn draw_begins(&mut self, _gl: &Context, _draw: &Draw) {}
    /// The draw call has been made.
    fn draw_ends(&mut self, _gl: &Context) {}
}

/// An observer, and the state that it is told with each draw call.
pub(crate) struct Observed {
    pub(crate) observer: Box<dyn Observer>,
    pub(crate) program: Option<Rc<ProgramRecipe>>,
    pub(crate) area: [u32; 2],
}

impl Context {
    /// Tells an observer of all that follows; `None` ends it.
    pub fn set_observer(&self, observer: Option<Box<dyn Observer>>) {
        let observed = observer.map(|observer| Observed { observer, program: None, area: [0, 0] });
        *self.observed.borrow_mut() = observed;
    }

    /// Does something whose passes draw into images that stay in a tile, from which a later pass writes the result: none of
    /// them stores what it writes.
    pub fn within_tile<R>(&self, body: impl FnOnce() -> R) -> R {
        let before = self.is_in_tile.replace(true);
        let result = body();
        self.is_in_tile.set(before);
        result
    }

    /// Does something with the observer, if there is one.
    pub(crate) fn observe(&self, tell: impl FnOnce(&mut Observed)) {
        if let Some(observed) = &mut *self.observed.borrow_mut() {
            tell(observed);
        }
    }

    /// Makes a draw call, and tells of it.
    pub(crate) fn drawing(&self, shape: Shape, draw: impl FnOnce()) {
        self.observe(|Observed { observer, program, area }| {
            if let Some(program) = program {
                observer.draw_begins(self, &Draw { program, shape, area: *area });
            }
        });
        draw();
        self.observe(|Observed { observer, program, .. }| {
            if program.is_some() {
                observer.draw_ends(self);
            }
        });
    }

    /// Returns a pass, to be declared and run. `name` is that of its KHR_debug group and of its timer.
    pub fn pass(&self, name: &'static str) -> Pass<'_> {
        let is_observed = self.observed.borrow().is_some();
        let declaration = is_observed.then(|| Declaration { name, reads: Vec::new(), writes: Vec::new() });
        Pass { gl: self, name, declaration }
    }
}

/// A pass that declares what it reads and writes where it draws:
/// `gl.pass("outlines").read("color_map", color).write(target.images()).run(|| ...)`. Unless somebody
/// [observes](Context::set_observer) the context, declarations cost nothing.
#[must_use = "a pass does nothing until it is run"]
pub struct Pass<'a> {
    gl: &'a Context,
    name: &'static str,
    /// `None` if nobody observes.
    declaration: Option<Declaration>,
}

impl Pass<'_> {
    /// Declares an image that the pass samples through a uniform.
    pub fn read(mut self, uniform: &'static str, image: impl Into<Image>) -> Self {
        if let Some(declaration) = &mut self.declaration {
            declaration.reads.push(Read { uniform, image: image.into() });
        }
        self
    }

    /// Declares images that the pass clears or overwrites, and stores, unless it is [within a tile](Context::within_tile).
    pub fn write(self, images: impl IntoIterator<Item = Image>) -> Self {
        let is_stored = !self.gl.is_in_tile.get();
        self.draw_into(images, false, is_stored)
    }

    /// Declares images that the pass loads, changes and stores.
    pub fn load(self, images: impl IntoIterator<Item = Image>) -> Self {
        self.draw_into(images, true, true)
    }

    /// Declares images that the pass draws into without memory traffic of its own: they are discarded, or a pass before or
    /// after this one in the same tile has stored or stores them.
    pub fn in_tile(self, images: impl IntoIterator<Item = Image>) -> Self {
        self.draw_into(images, false, false)
    }

    fn draw_into(
        mut self,
        images: impl IntoIterator<Item = Image>,
        is_loaded: bool,
        is_stored: bool,
    ) -> Self {
        if let Some(declaration) = &mut self.declaration {
            let writes = images.into_iter().map(|image| Write { image, is_loaded, is_stored });
            declaration.writes.extend(writes);
        }
        self
    }

    /// Runs the pass inside a KHR_debug group and, while profiling, with a timer.
    pub fn run<R>(self, body: impl FnOnce() -> R) -> R {
        let Pass { gl, name, declaration } = self;
        if let Some(declaration) = &declaration {
            gl.observe(|observed| observed.observer.pass_begins(declaration));
        }
        let result = gl.grouped(name, body);
        if declaration.is_some() {
            gl.observe(|observed| observed.observer.pass_ends());
        }
        result
    }
}
