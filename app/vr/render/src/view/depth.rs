//! The depth of rendered views: how the nearest of a pixel's samples is had, and programs that read it.

use std::rc::Rc;

use glam::Vec4;

use yoro::eyes::DepthConvention;
use yoro_gl::{Context, Destination, Format, GlError, Program, RasterState, ShaderSource, Texture};

/// How the nearest depth of each pixel's samples gets into a texture. Averages of depth belong to no surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DepthResolve {
    /// A pixel has one sample, whose depth buffer is the texture.
    None,
    /// A second colour carries the reversed depth of two samples through the average (`include/carried.glsl`), so that no
    /// sample leaves the tile of a tile-based GPU. Views whose depth is not reversed get that of one sample.
    InColor,
    /// A pass reads all samples.
    Samples,
    /// The driver copies the depth of one sample (OpenGL ES 3.0).
    SingleSample,
}

impl DepthResolve {
    /// Returns the best way that a driver has for views with this many samples. Where outlines are drawn (`ink`), which
    /// compare samples with their neighbours, they are read if possible.
    pub(super) fn best(gl: &Context, samples: u32, ink: bool) -> DepthResolve {
        let capabilities = gl.capabilities();
        let carries = capabilities.sample_masks && capabilities.float_render_targets && !ink;
        if samples == 1 {
            DepthResolve::None
        } else if carries && capabilities.tile_samples {
            DepthResolve::InColor
        } else if capabilities.multisample_textures {
            DepthResolve::Samples
        } else if carries {
            DepthResolve::InColor
        } else {
            DepthResolve::SingleSample
        }
    }
}

/// Window depth of an image.
#[derive(Clone, Copy)]
pub struct DepthImage<'a> {
    /// A depth texture, or a texture with a float channel, without filtering.
    pub texture: &'a Texture,
    /// Pixel of the texture that corresponds to the destination's lower left pixel.
    pub origin: [u32; 2],
    /// The layer, if the texture is an array.
    pub layer: Option<u32>,
    /// True if the texture holds the reversed depth of two samples in two channels ([`DepthResolve::InColor`]).
    pub is_pair: bool,
    /// The convention of the depth.
    pub convention: DepthConvention,
}

impl DepthImage<'_> {
    /// Returns the index of the variant of a [`DepthProgram`] that reads the image.
    fn variant(&self) -> usize {
        if self.layer.is_some() { 2 } else { usize::from(self.is_pair) }
    }
}

/// A program that reads `include/depth_map.glsl`, in variants for each kind of texture. They are compiled when first
/// asked for.
pub(crate) struct DepthProgram {
    gl: Rc<Context>,
    file: &'static str,
    /// Whole textures, pairs of depths, layers.
    made: [Option<Program>; 3],
}

impl DepthProgram {
    pub(crate) fn new(gl: &Rc<Context>, file: &'static str) -> DepthProgram {
        DepthProgram { gl: gl.clone(), file, made: [const { None }; 3] }
    }

    /// Compiles the variant for whole textures or for pairs of depths, unless it is compiled already.
    pub(crate) fn prepare(&mut self, is_pair: bool) -> Result<(), GlError> {
        self.variant(usize::from(is_pair)).map(drop)
    }

    /// Binds the variant for an image, which is compiled unless it was prepared, and its texture to unit 0.
    pub(crate) fn bind(&mut self, depth: &DepthImage) -> Result<&Program, GlError> {
        let program = self.variant(depth.variant())?;
        program
            .bind()
            .texture_of("depth_map", 0, depth.texture)
            .set("view_layer", depth.layer.unwrap_or(0) as i32);
        Ok(program)
    }

    fn variant(&mut self, i: usize) -> Result<&Program, GlError> {
        let slot = &mut self.made[i];
        if slot.is_none() {
            let define = [None, Some("DEPTH_PAIRS"), Some("LAYER")][i];
            let defines: Vec<_> = define.into_iter().map(|name| (name, String::new())).collect();
            *slot = Some(Program::new(&self.gl, ShaderSource::Screen(self.file), &defines)?);
        }
        slot.as_ref().ok_or_else(|| GlError::MissingShader(self.file.into()))
    }
}

/// Copies window depth into a framebuffer's depth attachment, which may have any depth format, for compositors that
/// reproject images with it.
pub struct DepthCopy {
    gl: Rc<Context>,
    program: DepthProgram,
}

impl DepthCopy {
    /// Compiles the programs.
    ///
    /// # Errors
    /// As [`Program::new`].
    pub fn new(gl: &Rc<Context>) -> Result<DepthCopy, GlError> {
        let mut program = DepthProgram::new(gl, "render/depth_write.frag");
        let capabilities = gl.capabilities();
        for (i, is_needed) in
            [true, capabilities.sample_masks, capabilities.multiview].into_iter().enumerate()
        {
            if is_needed {
                program.variant(i)?;
            }
        }
        Ok(DepthCopy { gl: gl.clone(), program })
    }

    /// Writes the destination's depth, in this convention.
    pub fn run(&self, from: &DepthImage, to: &Destination, convention: DepthConvention) {
        self.run_scaled(from, to, convention, [[1.0; 2], [0.0; 2]]);
    }

    /// Like [`DepthCopy::run`], of what lies at `scale * p + first` in the image for a place `p` in the destination, in
    /// pixels from the lower left corners.
    pub(crate) fn run_scaled(
        &self,
        from: &DepthImage,
        to: &Destination,
        convention: DepthConvention,
        map: [[f32; 2]; 2],
    ) {
        let pass = self.gl.pass("depth copy").read("depth_map", from.texture);
        pass.write([to.image(Format::Depth32F)]).run(|| self.draw(from, to, convention, map));
    }

    /// Draws [`DepthCopy::run_scaled`] within a pass of somebody else, and no colour.
    pub(crate) fn draw(
        &self,
        from: &DepthImage,
        to: &Destination,
        convention: DepthConvention,
        [scale, first]: [[f32; 2]; 2],
    ) {
        let Some(program) = &self.program.made[from.variant()] else { return };
        self.gl.set_raster_state(&RasterState::SCREEN_DEPTH);
        self.gl.mask_colors([false; 4]);
        self.gl.overwrite(to, 0, true);
        let shift = |i: usize| from.origin[i] as f32 + first[i] - scale[i] * to.origin[i] as f32;
        program
            .bind()
            .texture_of("depth_map", 0, from.texture)
            .set("place", Vec4::new(scale[0], scale[1], shift(0), shift(1)))
            .set("reverse", from.convention != convention)
            .set("view_layer", from.layer.unwrap_or(0) as i32);
        self.gl.draw_screen();
        self.gl.set_raster_state(&RasterState::SCREEN);
    }
}
