//! Synthesis in the application's OpenGL or OpenGL ES context, whose state is restored afterwards.

mod binding;
mod timer;

use std::mem::ManuallyDrop;
use std::num::NonZeroU32;
use std::rc::Rc;
use std::time::Duration;

use glow::HasContext as _;
use yoro::opengl::{Context, Destination, Gather, GlApi, GlError, GlState, Options, Outputs, Source};

pub use binding::{Binding, Current};

use crate::geometry::Rectangle;
use crate::reason::Reason;
use crate::synthesizer::{self, Image, Job};
use timer::Timer;

/// The pipeline in the application's context.
pub struct Synthesizer {
    binding: Binding,
    /// Deleted only while the context is current.
    objects: ManuallyDrop<Objects>,
}

/// The objects in the context. They are used only while it is current.
struct Objects {
    context: Rc<Context>,
    pipeline: Option<(Outputs, Gather)>,
    /// Framebuffers by the colour and depth that are attached to them.
    targets: Vec<([Option<Image>; 2], glow::Framebuffer)>,
    /// Copies of colour and depth, used if only a part of an image is submitted.
    copies: [Option<Copy>; 2],
    timer: Option<Timer>,
}

/// A texture, its format and its size.
struct Copy {
    texture: glow::Texture,
    format: i64,
    size: [u32; 2],
}

// SAFETY: the objects of a context are used only while it is current, on one thread at a time, and so are the reference
// counts next to them: `Frames` is locked meanwhile.
unsafe impl Send for Synthesizer {}

impl Synthesizer {
    /// Creates a pipeline in the context.
    ///
    /// # Safety
    /// The binding's context exists until this is dropped.
    pub unsafe fn new(binding: Binding) -> Result<Synthesizer, Reason> {
        // SAFETY: the context exists and is current; these are its entry points.
        let objects = unsafe {
            let _current = binding.make_current()?;
            let glow = glow::Context::from_loader_function_cstr(|name| binding.load(name));
            let context = Context::with_loader(glow, |name| binding.load(name))?;
            let timer = Timer::new(&binding, &context);
            Objects { context, pipeline: None, targets: Vec::new(), copies: [None, None], timer }
        };
        Ok(Synthesizer { binding, objects: ManuallyDrop::new(objects) })
    }
}

impl Drop for Synthesizer {
    fn drop(&mut self) {
        // SAFETY: the context exists, and its objects are no longer used. If it is current elsewhere, they remain until
        // it is destroyed.
        unsafe {
            if let Ok(_current) = self.binding.make_current() {
                self.objects.delete();
                ManuallyDrop::drop(&mut self.objects);
            }
        }
    }
}

impl synthesizer::Synthesizer for Synthesizer {
    unsafe fn synthesize(&mut self, job: &Job) -> Result<Option<Duration>, Reason> {
        // SAFETY: the context exists, and its images are not in use.
        unsafe {
            let _current = self.binding.make_current()?;
            self.objects.synthesize(job)
        }
    }

    fn forget(&mut self, images: &[u64]) {
        let uses = |image: &Image| images.contains(&image.image);
        let attached = |target: &[Option<Image>; 2]| target.iter().flatten().any(uses);
        if !self.objects.targets.iter().any(|(target, _)| attached(target)) {
            return;
        }
        // SAFETY: the context exists. If it is current elsewhere, the framebuffers remain until it is destroyed.
        let current = unsafe { self.binding.make_current() };
        let Objects { context, targets, .. } = &mut *self.objects;
        targets.retain(|(target, framebuffer)| {
            let keep = !attached(target);
            if !keep && current.is_ok() {
                // SAFETY: made here, and no longer used.
                unsafe { context.raw().delete_framebuffer(*framebuffer) };
            }
            keep
        });
    }
}

fn texture(name: u64) -> Result<glow::Texture, Reason> {
    let name = u32::try_from(name).ok().and_then(NonZeroU32::new);
    Ok(glow::NativeTexture(name.ok_or(Reason::Beyond)?))
}

/// Returns the framebuffers that are bound for drawing and for reading.
fn bound_framebuffers(gl: &glow::Context) -> [Option<glow::Framebuffer>; 2] {
    // SAFETY: queries.
    [glow::DRAW_FRAMEBUFFER_BINDING, glow::READ_FRAMEBUFFER_BINDING]
        .map(|name| unsafe { gl.get_parameter_framebuffer(name) })
}

fn bind_framebuffers(gl: &glow::Context, [draw, read]: [Option<glow::Framebuffer>; 2]) {
    // SAFETY: framebuffers of this context.
    unsafe {
        gl.bind_framebuffer(glow::DRAW_FRAMEBUFFER, draw);
        gl.bind_framebuffer(glow::READ_FRAMEBUFFER, read);
    }
}

impl Objects {
    unsafe fn synthesize(&mut self, job: &Job) -> Result<Option<Duration>, Reason> {
        let context = Rc::clone(&self.context);
        let context = &*context;
        let _silence = Silence::begin(context);
        // SAFETY: the context is current, and the images are its textures.
        let (source, framebuffer) = unsafe {
            let color = self.source(0, job.color, job.source)?;
            let depth = self.source(1, job.depth, job.source)?;
            (Source::new(color, depth), self.framebuffer([Some(job.target), job.target_depth])?)
        };
        let srgb = job.target.format == i64::from(glow::SRGB8_ALPHA8);
        let outputs = Outputs { srgb, depth: job.target_depth.is_some(), ..Outputs::default() };
        let pipeline = match &mut self.pipeline {
            Some((made_for, pipeline)) if *made_for == outputs => pipeline,
            other => {
                let options = Options { gl_state: GlState::Preserve, ..Options::default() };
                let pipeline = Gather::new(&self.context, &options, outputs)?;
                &mut other.insert((outputs, pipeline)).1
            }
        };
        let target =
            Destination { framebuffer: Some(framebuffer), origin: [0, 0], size: job.warp.target_size };
        let timing = self.timer.as_mut().and_then(|timer| timer.begin(context));
        let result = pipeline.synthesize(source, job.warp, &target);
        if let Some(timing) = timing {
            timing.end(context);
        }
        result?;
        Ok(self.timer.as_mut().and_then(|timer| timer.time(context)))
    }

    /// Returns a texture of this part of an image: the image itself, or a copy of the part.
    unsafe fn source(
        &mut self,
        which: usize,
        image: Image,
        part: Rectangle,
    ) -> Result<glow::Texture, Reason> {
        let own = texture(image.image)?;
        if image.layers == 1 && part.size == image.size {
            return Ok(own);
        }
        let capabilities = self.context.capabilities();
        let least = if capabilities.api == GlApi::Desktop { (4, 3) } else { (3, 2) };
        if capabilities.version < least {
            return Err(Reason::Part);
        }
        let gl = self.context.raw();
        let fits = |copy: &Copy| copy.format == image.format && copy.size == part.size;
        // SAFETY: textures of this context; the rectangle lies in the image, and bindings are restored.
        unsafe {
            let copy = match &mut self.copies[which] {
                Some(copy) if fits(copy) => copy,
                other => {
                    if let Some(old) = other.take() {
                        gl.delete_texture(old.texture);
                    }
                    let made = gl.create_texture();
                    let texture =
                        made.map_err(|reason| GlError::Object { what: "a texture".into(), reason })?;
                    let before = gl.get_parameter_texture(glow::TEXTURE_BINDING_2D);
                    gl.bind_texture(glow::TEXTURE_2D, Some(texture));
                    let [width, height] = part.size.map(|pixels| pixels as i32);
                    gl.tex_storage_2d(glow::TEXTURE_2D, 1, image.format as u32, width, height);
                    gl.bind_texture(glow::TEXTURE_2D, before);
                    other.insert(Copy { texture, format: image.format, size: part.size })
                }
            };
            let target = if image.layers == 1 { glow::TEXTURE_2D } else { glow::TEXTURE_2D_ARRAY };
            let ([x, y], [width, height]) =
                (part.origin.map(|pixels| pixels as i32), part.size.map(|pixels| pixels as i32));
            let (layer, to) = (image.layer as i32, (copy.texture, glow::TEXTURE_2D));
            gl.copy_image_sub_data(own, target, 0, x, y, layer, to.0, to.1, 0, 0, 0, 0, width, height, 1);
            Ok(copy.texture)
        }
    }

    /// Returns a framebuffer of colour and, if given, depth. It is kept until one of the images is forgotten.
    unsafe fn framebuffer(&mut self, images: [Option<Image>; 2]) -> Result<glow::Framebuffer, Reason> {
        if let Some((_, framebuffer)) = self.targets.iter().find(|(known, _)| *known == images) {
            return Ok(*framebuffer);
        }
        let gl = self.context.raw();
        // SAFETY: textures of this context; bindings are restored.
        unsafe {
            let made = gl.create_framebuffer();
            let framebuffer =
                made.map_err(|reason| GlError::Object { what: "a framebuffer".into(), reason })?;
            let before = bound_framebuffers(gl);
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(framebuffer));
            for (image, attachment) in images.iter().zip([glow::COLOR_ATTACHMENT0, glow::DEPTH_ATTACHMENT]) {
                let Some(image) = image else { continue };
                let (texture, target) = (texture(image.image).ok(), glow::FRAMEBUFFER);
                match image.layers {
                    1 => gl.framebuffer_texture_2d(target, attachment, glow::TEXTURE_2D, texture, 0),
                    _ => gl.framebuffer_texture_layer(target, attachment, texture, 0, image.layer as i32),
                }
            }
            let status = gl.check_framebuffer_status(glow::FRAMEBUFFER);
            bind_framebuffers(gl, before);
            if status != glow::FRAMEBUFFER_COMPLETE {
                gl.delete_framebuffer(framebuffer);
                let formats = images.map(|image| image.map_or(0, |image| image.format));
                let reason =
                    format!("the GL driver cannot render to the formats {formats:x?} (status 0x{status:x})");
                return Err(GlError::Unsupported(reason).into());
            }
            self.targets.push((images, framebuffer));
            Ok(framebuffer)
        }
    }

    /// Deletes the objects that do not delete themselves. Called before they are dropped.
    fn delete(&mut self) {
        let gl = self.context.raw();
        // SAFETY: made here, and no longer used.
        unsafe {
            for (_, framebuffer) in self.targets.drain(..) {
                gl.delete_framebuffer(framebuffer);
            }
            for copy in self.copies.iter_mut().filter_map(Option::take) {
                gl.delete_texture(copy.texture);
            }
            if let Some(timer) = self.timer.take() {
                timer.delete(gl);
            }
        }
    }
}

/// Keeps the layer's debug messages, such as names of passes, out of the application's debug output.
struct Silence<'a>(Option<&'a Context>);

impl Silence<'_> {
    fn begin(context: &Context) -> Silence<'_> {
        let gl = context.raw();
        // SAFETY: a capability that exists if debug groups do.
        let loud = context.capabilities().debug_groups && unsafe { gl.is_enabled(glow::DEBUG_OUTPUT) };
        if loud {
            // SAFETY: as above.
            unsafe { gl.disable(glow::DEBUG_OUTPUT) };
        }
        Silence(loud.then_some(context))
    }
}

impl Drop for Silence<'_> {
    fn drop(&mut self) {
        if let Some(context) = self.0 {
            // SAFETY: as above; it was enabled before.
            unsafe { context.raw().enable(glow::DEBUG_OUTPUT) };
        }
    }
}
