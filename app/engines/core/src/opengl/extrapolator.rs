//! A rendered view as it would be a little later.

use std::rc::Rc;

use glam::Vec2;
use yoro_gl::{Context, Filter, Format, GlError, Program, RenderTarget, ShaderSource};

use super::pipeline::preserving;
use super::{Options, Outputs, Source};
use crate::eyes::Extrapolation;

/// Pixels along each side of a tile: the farthest that a surface may move and be found everywhere.
const REACH: u32 = 32;

/// Moves the surfaces of a rendered view on by their motion vectors, for frames between those that are rendered: colour and
/// depth as the same eye would see them later. [`AnyView`](super::AnyView) then takes them to the newest poses of both
/// eyes. What stands still is copied exactly, so that nothing but what moves is sampled twice.
///
/// For moving things this is better than the same without vectors by several dB. Where a runtime makes frames itself, give
/// it the vectors ([`Motion`](super::Motion)). It changes the state that [`Pipeline`](super::Pipeline) lists, or none with
/// [`GlState::Preserve`](super::GlState).
pub struct Extrapolator {
    gl: Rc<Context>,
    options: Options,
    tiles: Program,
    moving: Program,
    tile_map: RenderTarget,
    target: RenderTarget,
}

impl Extrapolator {
    /// Compiles the passes for sources that fill 2-D textures. With [`Options::depth_pairs`] they hold such.
    ///
    /// # Errors
    /// [`GlError::Unsupported`] for layers of array textures, or parts of textures; [`GlError::Shader`] if the driver refuses
    /// a shader.
    pub fn new(gl: &Rc<Context>, options: &Options) -> Result<Extrapolator, GlError> {
        if options.array_textures || options.parts {
            return Err(GlError::Unsupported("only whole 2-D textures are extrapolated".into()));
        }
        let pairs = options.depth_pairs.then(|| ("DEPTH_PAIRS", String::new()));
        let defines: Vec<_> = pairs.into_iter().collect();
        preserving(gl, options, Outputs::default(), || {
            let screen = |file| Program::new(gl, ShaderSource::Screen(file), &defines);
            let target = |format, depth| RenderTarget::new(gl, [1, 1], &[(format, Filter::Linear)], depth);
            Ok(Extrapolator {
                gl: gl.clone(),
                options: *options,
                tiles: screen("synthesis/extrapolation/tiles.frag")?,
                moving: screen("synthesis/extrapolation/move.frag")?,
                tile_map: RenderTarget::new(gl, [1, 1], &[(Format::Rgba16F, Filter::Nearest)], None)?,
                target: target(Format::Rgba8, Some(Format::Depth32F))?,
            })
        })
    }

    /// Returns the source as it would be later, in textures of its own that are valid until the next call: RGBA8, and depth
    /// of 32 bits, one value a pixel. `vectors` has three components, and any size.
    ///
    /// # Errors
    /// [`GlError`] if the size is beyond the driver's limits.
    pub fn extrapolate(
        &mut self,
        source: Source,
        (vectors, vector_size): (glow::Texture, [u32; 2]),
        step: &Extrapolation,
    ) -> Result<Source, GlError> {
        let (gl, options) = (self.gl.clone(), self.options);
        preserving(&gl, &options, Outputs { depth: true, ..Outputs::default() }, || {
            gl.set_first_unit();
            self.target.resize(step.size)?;
            self.tile_map.resize(step.size.map(|n| n.div_ceil(REACH)))?;
            gl.begin_synthesis(1, false);
            let begin = |program: &Program| {
                let pair = |[x, y]: [f64; 2]| Vec2::new(x as f32, y as f32);
                let scale = [0, 1].map(|i| f64::from(vector_size[i]) / f64::from(step.size[i]));
                program
                    .bind()
                    .texture("depth_map", 0, source.depth)
                    .texture("vector_map", 2, vectors)
                    .set("size", pair(step.size.map(f64::from)))
                    .set("vector_scale", pair(scale))
                    .set("ahead", step.ahead as f32)
                    .set("law", pair(step.law))
                    .set("former_law", pair(step.former_law))
                    .set("z_scale", step.z_scale as f32)
                    .set("from_former", step.from_former);
            };
            gl.pass("extrapolation tiles", || {
                self.tile_map.overwrite();
                begin(&self.tiles);
                gl.draw_screen();
            });
            gl.pass("extrapolation", || {
                gl.overwrite(&yoro_gl::Destination::whole(&self.target), 1, true);
                gl.set_depth_write(true);
                begin(&self.moving);
                self.moving.texture("color_map", 1, source.color).texture(
                    "tile_map",
                    3,
                    self.tile_map.color(0).raw(),
                );
                gl.draw_screen();
                gl.set_depth_write(false);
            });
            gl.end_synthesis();
            Ok(Source::new(self.target.color(0).raw(), self.target.depth().raw()))
        })
    }
}
