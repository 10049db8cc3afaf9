//! Bloom.

use std::rc::Rc;

use glam::{Vec2, Vec4};

use super::rectangle::Rectangle;
use yoro_gl::{
    Blend, Context, Filter, Format, GlError, Image, Pass, Program, RasterState, RenderTarget, ShaderSource,
    Texture,
};

/// Share of the bloom that is added to the picture.
pub const STRENGTH: f32 = 0.12;
/// Levels of the pyramid; the first has half the size of what shines.
const LEVELS: usize = 5;

/// The pyramid of images.
pub struct BloomTargets {
    levels: [RenderTarget; LEVELS],
    part: Rectangle,
}

fn level_size(size: [u32; 2], level: usize) -> [u32; 2] {
    size.map(|n| (n >> (level + 1)).max(1))
}

impl BloomTargets {
    /// Makes targets of one pixel; call [`BloomTargets::fit`] before drawing into them.
    pub fn new(gl: &Rc<Context>) -> Result<BloomTargets, GlError> {
        let format = hdr_format(gl);
        let level = || RenderTarget::new(gl, [1, 1], &[(format, Filter::Linear)], None);
        let part = Rectangle { origin: [0, 0], size: [1, 1] };
        Ok(BloomTargets { levels: [level()?, level()?, level()?, level()?, level()?], part })
    }

    /// Fits the targets to a part of a view.
    pub fn fit(&mut self, part: Rectangle) -> Result<(), GlError> {
        self.part = part;
        self.levels.iter_mut().enumerate().try_for_each(|(i, level)| level.resize(level_size(part.size, i)))
    }

    /// Returns the part of the view that shines, from the view's own corner. Beyond it, a view has the light of its border.
    pub fn part(&self) -> Rectangle {
        self.part
    }

    /// Returns the finished bloom, half the part's size.
    pub fn result(&self) -> &Texture {
        self.levels[0].color(0)
    }
}

/// Returns the scale of scene-referred colour in textures, as in `include/hdr.glsl`.
pub fn hdr_scale(gl: &Context) -> f32 {
    if gl.capabilities().float_render_targets { 1.0 } else { 0.125 }
}

/// Returns the defines of `include/hdr.glsl`.
fn hdr_defines(gl: &Context) -> Option<(&'static str, String)> {
    (!gl.capabilities().float_render_targets).then(|| ("NO_FLOAT_TARGETS", String::new()))
}

/// Returns the format of scene-referred colour. EXT_color_buffer_half_float alone allows half floats but not packed
/// floats, so this asks the driver.
pub fn hdr_format(gl: &Rc<Context>) -> Format {
    if !gl.capabilities().float_render_targets {
        return Format::Rgba8;
    }
    first_renderable(gl, [Format::R11G11B10F, Format::Rgba16F])
}

/// Returns the first format that the driver can render to, or the last one if it can render to none.
pub fn first_renderable<const N: usize>(gl: &Rc<Context>, formats: [Format; N]) -> Format {
    let renders = |f: &Format| RenderTarget::new(gl, [1, 1], &[(*f, Filter::Linear)], None).is_ok();
    formats.into_iter().find(renders).unwrap_or(formats[N - 1])
}

/// The picture of a view, a [part](BloomTargets::part) of which shines.
#[derive(Clone, Copy)]
pub struct Shining<'a> {
    /// Display-referred colour, filtered linearly: a texture, or an array of them.
    pub picture: &'a Texture,
    /// The layer, if the picture is an array.
    pub layer: Option<u32>,
    /// Lower left corner of the view in the picture, in pixels.
    pub corner: [u32; 2],
}

/// Spreads light that is brighter than white over its surroundings.
///
/// Reads the picture, and writes the pyramid, which is scene-referred. Every level is overwritten; on the way back it is
/// blended into.
pub struct BloomPass {
    gl: Rc<Context>,
    first: Program,
    /// `None` without multiview.
    first_of_layer: Option<Program>,
    down: Program,
    up: Program,
}

impl BloomPass {
    /// Compiles the programs.
    pub fn new(gl: &Rc<Context>) -> Result<BloomPass, GlError> {
        let down = |names: &[&'static str]| {
            let mut defines: Vec<_> = names.iter().map(|name| (*name, String::new())).collect();
            defines.extend(hdr_defines(gl));
            Program::new(gl, ShaderSource::Screen("render/bloom_down.frag"), &defines)
        };
        Ok(BloomPass {
            gl: gl.clone(),
            first: down(&["FIRST"])?,
            first_of_layer: gl.capabilities().multiview.then(|| down(&["FIRST", "LAYER"])).transpose()?,
            down: down(&[])?,
            up: Program::new(gl, ShaderSource::Screen("render/bloom_up.frag"), &[])?,
        })
    }

    fn declare(&self, targets: &BloomTargets, shining: &Shining) -> Pass<'_> {
        let picture = Image { size: targets.part.size, ..shining.picture.image() };
        let mut pass = self.gl.pass("bloom").read("source", picture).write(targets.levels[0].images());
        for pair in targets.levels.windows(2) {
            // Down to the smaller level, and up again.
            pass = pass.read("source", pair[0].color(0)).write(pair[1].images());
            pass = pass.read("source", pair[1].color(0)).load(pair[0].images());
        }
        pass
    }

    /// Computes the bloom of a picture that was exposed with `exposure`.
    pub fn run(&self, targets: &BloomTargets, shining: &Shining, exposure: f32) {
        let texel = |texture: &Texture| 1.0 / Vec2::from(texture.size().map(|n| n as f32));
        self.declare(targets, shining).run(|| {
            self.gl.set_raster_state(&RasterState::SCREEN);
            let first = match (shining.layer, &self.first_of_layer) {
                (Some(_), Some(program)) => program,
                _ => &self.first,
            };
            let mut from = shining.picture;
            for (i, level) in targets.levels.iter().enumerate() {
                level.overwrite();
                let program = if i == 0 { first } else { &self.down };
                program.bind().texture_of("source", 0, from).set("texel", texel(level.color(0)));
                if i == 0 {
                    set_part(program, shining, targets.part, exposure);
                }
                self.gl.draw_screen();
                from = level.color(0);
            }
            self.gl.set_raster_state(&RasterState { blend: Blend::Add, ..RasterState::SCREEN });
            for pair in targets.levels.windows(2).rev() {
                let (large, small) = (&pair[0], pair[1].color(0));
                large.bind();
                self.up
                    .bind()
                    .texture("source", 0, small.raw())
                    .set("texel", texel(large.color(0)))
                    .set("source_texel", texel(small));
                self.gl.draw_screen();
            }
        });
    }
}

/// Sets the uniforms of the first step.
fn set_part(program: &Program, shining: &Shining, part: Rectangle, exposure: f32) {
    let Shining { picture, layer, corner } = *shining;
    let origin = [0, 1].map(|i| corner[i] + part.origin[i]);
    let texel = 1.0 / Vec2::from(picture.size().map(|n| n as f32));
    let place = |v: [u32; 2]| Vec2::from(v.map(|n| n as f32)) * texel;
    let (start, extent) = (place(origin), place(part.size));
    let low = start + 0.5 * texel;
    let high = place([origin[0] + part.size[0], origin[1] + part.size[1]]) - 0.5 * texel;
    program
        .set("exposure", exposure)
        .set("color_layer", layer.unwrap_or(0) as i32)
        .set("part", Vec4::new(start.x, start.y, extent.x, extent.y))
        .set("bounds", Vec4::new(low.x, low.y, high.x, high.y));
}
