//! What a context is told to do, for those who record or count it.

use std::rc::Rc;

use crate::{Context, Format, ProgramRecipe, RasterState};

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

/// The images that a framebuffer draws into.
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

/// A call that changes what is drawn, or draws. Textures and framebuffers of others are not announced.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum Event<'a> {
    /// A texture has its storage.
    TextureMade(glow::Texture, Image),
    /// A texture is about to be deleted.
    TextureDeleted(glow::Texture),
    /// A framebuffer has its images, or other ones than before.
    FramebufferMade(glow::Framebuffer, Attachments),
    /// A framebuffer is about to be deleted.
    FramebufferDeleted(glow::Framebuffer),
    /// A program has been linked.
    ProgramMade(&'a Rc<ProgramRecipe>),
    /// A [`Context::pass`] of this name begins.
    PassBegins(&'static str),
    /// The innermost pass ends.
    PassEnds,
    /// The framebuffer of the following draws; `None` for the window's.
    FramebufferBound(Option<glow::Framebuffer>),
    /// Width and height of the viewport in pixels.
    ViewportSet([u32; 2]),
    /// The program of the following draws.
    ProgramBound(glow::Program, &'a Rc<ProgramRecipe>),
    /// The program samples a texture through a uniform.
    TextureSampled {
        /// The program.
        program: glow::Program,
        /// The uniform's name.
        name: &'a str,
        /// The texture.
        texture: glow::Texture,
    },
    /// The state of the following draws, with all writes on.
    StateSet(RasterState),
    /// Depth writes are off until the state is set again.
    DepthMasked,
    /// Only the samples of this mask are drawn; `None` for all.
    SamplesMasked(Option<u32>),
    /// A draw call follows.
    DrawBegins(Shape),
    /// The draw call has been made.
    DrawEnds,
    /// Colour and, if `depth` is set, depth of the bound framebuffer are cleared.
    Cleared {
        /// True if depth is cleared, too.
        depth: bool,
    },
    /// Contents of a framebuffer are discarded.
    Discarded {
        /// The framebuffer.
        framebuffer: glow::Framebuffer,
        /// True if colour is discarded.
        color: bool,
        /// True if depth is discarded.
        depth: bool,
    },
    /// Pixels are copied, or samples averaged, into another framebuffer.
    Copied {
        /// The source.
        from: Option<glow::Framebuffer>,
        /// The target.
        to: Option<glow::Framebuffer>,
        /// Width and height in pixels.
        size: [u32; 2],
        /// The attachment of the source that is copied, into the first of its kind.
        aspect: Aspect,
    },
}

/// An attachment of a framebuffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Aspect {
    /// The colour attachment of this number.
    Color(usize),
    /// The depth attachment.
    Depth,
}

/// Is told what a context does.
pub trait Observer {
    /// Takes an event of the context. Must not use other objects of this library, whose events would come in between.
    fn observe(&mut self, gl: &Context, event: &Event);
}

impl Context {
    /// Tells an observer of all that follows; `None` ends it. An observer knows only the objects that were made while it
    /// was there, so that one which must know all is set before any.
    pub fn set_observer(&self, observer: Option<Box<dyn Observer>>) {
        *self.observer.borrow_mut() = observer;
    }

    pub(crate) fn tell(&self, event: Event) {
        if let Some(observer) = &mut *self.observer.borrow_mut() {
            observer.observe(self, &event);
        }
    }

    /// Runs a draw call between its two events.
    pub(crate) fn drawing(&self, shape: Shape, draw: impl FnOnce()) {
        self.tell(Event::DrawBegins(shape));
        draw();
        self.tell(Event::DrawEnds);
    }
}
