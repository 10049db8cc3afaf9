//! An eye made of its levels.

use std::rc::Rc;

use yoro_gl::{Context, Destination, Format, GlError, Image, Pass, Program, ShaderSource};

use super::pipeline::preserving;
use super::{GlState, Options, Outputs, Part, draw_target, target_images};
use crate::eyes::Composition;
use crate::synthesis::{LevelPlaces, LevelUniforms};

/// The image of a level, as a GL name of a 2-D texture. Filter, wrapping and sampler do not matter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LevelImage {
    /// Colour, in any filterable format and any encoding.
    pub color: glow::Texture,
    /// The rectangle of the level in its texture. For the dominant eye, the crop of the rendered image
    /// ([`SynthesisViews::dominant_crop`](crate::eyes::SynthesisViews::dominant_crop)). `None` if it fills the texture.
    pub part: Option<Part>,
}

impl LevelImage {
    /// Returns a level that fills its texture.
    pub fn new(color: glow::Texture) -> LevelImage {
        LevelImage { color, part: None }
    }

    /// Returns the lower left corner of the level in its texture, and the texture's size.
    fn part(&self, size: [u32; 2]) -> Part {
        self.part.unwrap_or(Part { origin: [0, 0], image_size: size })
    }
}

/// The image of an inset.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct InsetImage {
    /// Colour, and its place.
    pub image: LevelImage,
    /// The depth of a synthesized inset, which shows where it has holes at its border. A texture of the size of `color`.
    pub depth: Option<glow::Texture>,
}

/// The images of an eye's levels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LevelImages {
    /// The wide level.
    pub wide: LevelImage,
    /// The inset, for a [`Composition`] that has one.
    pub inset: Option<InsetImage>,
}

/// A pass that makes an eye from its levels: the inset where it covers the eye and has no hole at the border of what was
/// rendered, else the wide view, bilinearly. A pass that reads the finished eye anyway, such as that of lenses, can
/// include `include/levels.glsl` of `yoro-shaders` instead.
///
/// A call sets and changes state as one of a [`Pipeline`](super::Pipeline).
pub struct Composer {
    gl: Rc<Context>,
    options: Options,
    outputs: Outputs,
    program: Program,
}

impl Composer {
    /// Compiles the pass. `srgb` as in [`Outputs`].
    ///
    /// # Errors
    /// [`GlError::Shader`] if the driver refuses the shader.
    pub fn new(gl: &Rc<Context>, gl_state: GlState, srgb: bool) -> Result<Composer, GlError> {
        let options = Options { gl_state, ..Options::default() };
        let outputs = Outputs { srgb, ..Outputs::default() };
        let program = preserving(gl, &options, outputs, || {
            Program::new(gl, ShaderSource::Screen("synthesis/compose.frag"), &[])
        })?;
        Ok(Composer { gl: gl.clone(), options, outputs, program })
    }

    /// Composes an eye into a rectangle of its size, and overwrites all of it. No image may be attached to the target.
    pub fn compose(&self, images: &LevelImages, composition: &Composition, target: &Destination) {
        let gl = &*self.gl;
        preserving(gl, &self.options, self.outputs, || {
            gl.begin_synthesis(self.outputs.draw_buffers(), self.outputs.srgb);
            let pass = LevelImages::declare(gl.pass("compose"), composition);
            pass.write(target_images(target, self.outputs)).run(|| {
                images.set(self.program.bind(), composition, target.origin);
                gl.filter_unit(INSET_UNIT);
                draw_target(gl, target, self.outputs);
            });
            gl.end_synthesis();
        });
    }
}

/// The units of the inset's depth, of the wide level and of the inset.
const UNITS: [u32; 3] = [0, 1, INSET_UNIT];
const INSET_UNIT: u32 = 2;

impl LevelImages {
    /// Declares the colours that a pass reads to compose an eye, as textures of [`Format::Rgba8`].
    pub fn declare<'a>(pass: Pass<'a>, composition: &Composition) -> Pass<'a> {
        let color = |size| Image { format: Format::Rgba8, size, samples: 1 };
        let pass = pass.read("wide_map", color(composition.wide.size));
        match composition.inset {
            Some(inset) => pass.read("inset_map", color(inset.place.size)),
            None => pass,
        }
    }

    /// Sets the uniforms and textures that `include/levels.glsl` declares, for a pass that composes on its way. The
    /// program must be current. Uses texture units 0 to 2. Colours must be filtered linearly, and depth not at all;
    /// `target_origin` is the corner of the eye's image in its target, which only the composer's own pass uses.
    pub fn set(&self, program: &Program, composition: &Composition, target_origin: [u32; 2]) {
        let inset = composition.inset.zip(self.inset);
        let composition = Composition { inset: inset.map(|(place, _)| place), ..*composition };
        let wide = self.wide.part(composition.wide.size);
        let part = inset.map_or(Part { origin: [0, 0], image_size: [1, 1] }, |(inset, images)| {
            images.image.part(inset.place.size)
        });
        let depth = inset.and_then(|(_, images)| images.depth);
        let places = LevelPlaces {
            target: target_origin,
            wide: wide.origin,
            wide_image: wide.image_size,
            inset: part.origin,
            inset_image: part.image_size,
            depth: depth.is_some(),
        };
        LevelUniforms::new(&composition, &places).set(program);
        // Every sampler needs a texture, even one that is not sampled.
        let color = inset.map_or(self.wide.color, |(_, images)| images.image.color);
        let textures = [depth.unwrap_or(self.wide.color), self.wide.color, color];
        for ((name, unit), texture) in
            ["inset_depth", "wide_map", "inset_map"].into_iter().zip(UNITS).zip(textures)
        {
            program.texture(name, unit, texture);
        }
    }
}
