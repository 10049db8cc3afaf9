//! Bloom.

use std::rc::Rc;

use glam::{Vec2, Vec4};

use yoro_gl::{
    Blend, Context, Filter, Format, GlError, Program, RasterState, RenderTarget, ShaderSource, Texture,
};

/// Share of the bloom that is added to the picture.
pub const STRENGTH: f32 = 0.12;
/// Levels of the pyramid; the first has half the view's size.
const LEVELS: usize = 5;

/// The pyramid of images.
pub struct BloomTargets {
    levels: [RenderTarget; LEVELS],
}

fn level_size(size: [u32; 2], level: usize) -> [u32; 2] {
    size.map(|n| (n >> (level + 1)).max(1))
}

impl BloomTargets {
    /// Makes targets of one pixel; call [`BloomTargets::resize`] before drawing into them.
    pub fn new(gl: &Rc<Context>, format: Format) -> Result<BloomTargets, GlError> {
        let level = || RenderTarget::new(gl, [1, 1], &[(format, Filter::Linear)], None);
        Ok(BloomTargets { levels: [level()?, level()?, level()?, level()?, level()?] })
    }

    /// Fits the targets to a view of `size` pixels.
    pub fn resize(&mut self, size: [u32; 2]) -> Result<(), GlError> {
        self.levels.iter_mut().enumerate().try_for_each(|(i, level)| level.resize(level_size(size, i)))
    }

    /// Returns the finished bloom, half the view's size.
    pub fn result(&self) -> &Texture {
        self.levels[0].color(0)
    }
}

/// Spreads light that is brighter than white over its surroundings.
///
/// Reads scene-referred colour, or with the define `DISPLAY_REFERRED` tone-mapped colour. Writes the pyramid, which is
/// scene-referred.
pub struct BloomPass {
    gl: Rc<Context>,
    first: Program,
    down: Program,
    up: Program,
}

impl BloomPass {
    /// Compiles the programs; `defines` are those of `include/hdr.glsl`, and `DISPLAY_REFERRED`.
    pub fn new(gl: &Rc<Context>, defines: &[(&'static str, String)]) -> Result<BloomPass, GlError> {
        let down = ShaderSource::Screen("render/bloom_down.frag");
        let mut first = defines.to_vec();
        first.push(("FIRST", String::new()));
        Ok(BloomPass {
            gl: gl.clone(),
            first: Program::new(gl, down, &first)?,
            down: Program::new(gl, down, defines)?,
            up: Program::new(gl, ShaderSource::Screen("render/bloom_up.frag"), &[])?,
        })
    }

    /// Computes the bloom of columns `[first, end]` of `source`, repeating the edge columns. The filter must be linear.
    pub fn run(&self, targets: &BloomTargets, source: &Texture, [first, end]: [u32; 2]) {
        let width = source.size()[0] as f32;
        let columns = Vec2::new(first as f32 + 0.5, end as f32 - 0.5) / width;
        self.run_with(targets, source, |program| {
            program.set("columns", columns);
        });
    }

    /// Computes the bloom of a part of a display-referred source that was exposed with `exposure`. The part has the
    /// given size in pixels and the lower left corner `origin`; only its columns `[first, end]` count.
    pub fn run_display_referred(
        &self,
        targets: &BloomTargets,
        source: &Texture,
        (origin, size): ([u32; 2], [u32; 2]),
        [first, end]: [u32; 2],
        exposure: f32,
    ) {
        let texel = 1.0 / Vec2::from(source.size().map(|n| n as f32));
        let [corner, extent] = [origin, size].map(|v| Vec2::from(v.map(|n| n as f32)) * texel);
        let [low, high] = [[origin[0] + first, origin[1]], [origin[0] + end, origin[1] + size[1]]]
            .map(|v| Vec2::from(v.map(|n| n as f32)) * texel);
        let (low, high) = (low + 0.5 * texel, high - 0.5 * texel);
        self.run_with(targets, source, |program| {
            program
                .set("exposure", exposure)
                .set("part", Vec4::new(corner.x, corner.y, extent.x, extent.y))
                .set("bounds", Vec4::new(low.x, low.y, high.x, high.y));
        });
    }

    fn run_with(&self, targets: &BloomTargets, source: &Texture, set_first: impl Fn(&Program)) {
        let texel = |texture: &Texture| 1.0 / Vec2::from(texture.size().map(|n| n as f32));
        self.gl.pass("bloom", || {
            self.gl.set_raster_state(&RasterState::SCREEN);
            let mut from = source;
            let mut program = &self.first;
            for level in &targets.levels {
                level.bind();
                program.bind().texture("source", 0, from.raw()).set("texel", texel(level.color(0)));
                set_first(program);
                self.gl.draw_screen();
                from = level.color(0);
                program = &self.down;
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
