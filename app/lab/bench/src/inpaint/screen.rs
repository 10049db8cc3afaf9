//! The patchers that are fragment shaders.

use std::rc::Rc;
use std::time::Instant;

use glam::IVec2;
use image::{GrayImage, Rgb, RgbImage};

use super::patcher::{
    HOLE, PatchTime, Patched, Patcher, PatcherKind, Reprojected, VALID, around, nearest_rows,
};
use yoro::eyes::Eye;
use yoro_gl::{Context, Filter, Format, GlError, Program, RasterState, RenderTarget, ShaderSource, Texture};

/// A fragment shader that is drawn once, or until the holes are closed, on textures of its own.
pub(super) struct Screen {
    gl: Rc<Context>,
    name: &'static str,
    program: Program,
    /// The number of pixels by which a hole shrinks in one pass; `None` if one pass closes it.
    reach: Option<u32>,
    /// True if a pass also gives filled pixels a disparity, for the next pass.
    carries_disparity: bool,
    input: Option<Input>,
    targets: [RenderTarget; 2],
}

/// Colour with validity in alpha, and disparity.
struct Input {
    color: Texture,
    disparity: Texture,
}

impl Screen {
    pub(super) fn new(gl: &Rc<Context>, kind: PatcherKind) -> Result<Screen, GlError> {
        let (name, file, reach) = match kind {
            PatcherKind::Paper => ("patch paper", "inpaint/paper.frag", None),
            PatcherKind::Gather => ("patch gather", "inpaint/gather.frag", None),
            PatcherKind::Median => ("patch median", "inpaint/median.frag", Some(2)),
            PatcherKind::Xiao => ("patch xiao", "inpaint/xiao.frag", Some(14)),
            PatcherKind::Telea | PatcherKind::NavierStokes | PatcherKind::Neural => {
                unreachable!("not a shader")
            }
        };
        let formats = [(Format::Rgba8, Filter::Nearest), (Format::R32F, Filter::Nearest)];
        let carries_disparity = kind == PatcherKind::Xiao;
        let formats = if carries_disparity { &formats[..] } else { &formats[..1] };
        let target = || RenderTarget::new(gl, [1, 1], formats, None);
        Ok(Screen {
            gl: gl.clone(),
            name,
            program: Program::new(gl, ShaderSource::Screen(file), &[])?,
            reach,
            carries_disparity,
            input: None,
            targets: [target()?, target()?],
        })
    }

    fn upload(&mut self, image: &Reprojected) -> Result<(), GlError> {
        let size = image.size();
        let input = match self.input.take() {
            Some(input) if input.color.size() == size => input,
            _ => Input {
                color: Texture::new(&self.gl, size, Format::Rgba8, Filter::Nearest)?,
                disparity: Texture::new(&self.gl, size, Format::R32F, Filter::Nearest)?,
            },
        };
        let rows = image.color.rows().rev().flatten().zip(image.mask.rows().rev().flatten());
        let rgba: Vec<u8> = rows.flat_map(|(c, m)| [c.0[0], c.0[1], c.0[2], m.0[0]]).collect();
        let disparity: Vec<f32> = image.disparity.rows().rev().flatten().map(|d| d.0[0]).collect();
        input.color.upload(&rgba);
        input.disparity.upload(bytemuck::cast_slice(&disparity));
        self.input = Some(input);
        self.targets.iter_mut().try_for_each(|target| target.resize(size))
    }

    /// Draws the passes and returns the target that holds the result.
    fn draw(&self, image: &Reprojected, input: &Input) -> &RenderTarget {
        let gl = &self.gl;
        let passes = self.reach.map_or(1, |reach| hole_depth(&image.mask).div_ceil(reach).max(1));
        let size = image.size();
        let (mut color, mut disparity) = (&input.color, &input.disparity);
        gl.set_raster_state(&RasterState::SCREEN);
        for pass in 0..passes {
            let target = &self.targets[pass as usize % 2];
            let declared = gl.pass(self.name).read("color_map", color).read("disparity_map", disparity);
            declared.write(target.images()).run(|| {
                target.bind();
                self.program
                    .bind()
                    .texture_of("color_map", 0, color)
                    .texture_of("disparity_map", 1, disparity)
                    .set("size", IVec2::new(size[0] as i32, size[1] as i32))
                    .set("mirrored", image.eye == Eye::Right);
                gl.draw_screen();
            });
            color = target.color(0);
            if self.carries_disparity {
                disparity = target.color(1);
            }
        }
        &self.targets[(passes as usize - 1) % 2]
    }
}

impl Patcher for Screen {
    fn patch(&mut self, image: &Reprojected) -> anyhow::Result<Patched> {
        let start = Instant::now();
        self.upload(image)?;
        self.gl.finish();
        let uploaded = Instant::now();
        let input = self.input.as_ref().expect("uploaded above");
        let target = self.draw(image, input);
        self.gl.finish();
        let drawn = Instant::now();
        let rgba = target.read_rgba8(0, [0, 0], image.size());
        let image = filled(&rgba, image.size());
        let transfer = (uploaded - start) + drawn.elapsed();
        Ok(Patched { image, time: PatchTime { patching: drawn - uploaded, transfer } })
    }
}

/// Returns the result as an image. A row without any valid pixel, which row-based patchers cannot fill (its alpha is
/// still 0), repeats the nearest row that has one.
fn filled(rgba: &[u8], size: [u32; 2]) -> RgbImage {
    let rows: Vec<&[u8]> = rgba.chunks_exact(size[0] as usize * 4).rev().collect();
    let source = nearest_rows(size[1], |y| rows[y as usize][3] == VALID);
    RgbImage::from_fn(size[0], size[1], |x, y| {
        let pixel = &rows[source[y as usize] as usize][x as usize * 4..];
        Rgb([pixel[0], pixel[1], pixel[2]])
    })
}

/// Returns the largest distance in pixels of a hole's pixel from the nearest valid one, with diagonal steps counting 1;
/// 0 without holes.
pub(super) fn hole_depth(mask: &GrayImage) -> u32 {
    let size: [u32; 2] = mask.dimensions().into();
    let mut is_open: Vec<bool> = mask.pixels().map(|m| m.0[0] == HOLE).collect();
    let mut ring: Vec<usize> = (0..is_open.len()).filter(|i| !is_open[*i]).collect();
    let mut depth = 0;
    loop {
        let reached = ring.iter().flat_map(|i| around(*i, size)).filter(|i| std::mem::take(&mut is_open[*i]));
        ring = reached.collect();
        if ring.is_empty() {
            return depth;
        }
        depth += 1;
    }
}
