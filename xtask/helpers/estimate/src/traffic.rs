//! What a tile-based GPU moves between its tiles and memory.
//!
//! Passes declare which images they read, load and store. An image that is loaded or stored moves once. A triangle that
//! covers the view reads each texel of its images once, a mesh one texel of each map of its material for each fragment; the shadow map
//! is always read once for each fragment, and the march reads depth only where a tile has no law. Outlines are read where they
//! are drawn. Samples are averaged in the tiles.

use yoro_gl::{Format, Image, Read, Shape};
use yoro_test_support::record::{RecordedDraw, RecordedPass};

/// The texture that every draw call reads at one place per fragment.
const SHADOW_MAP: &str = "shadow_map";
/// The name of images that are copied.
const COPIED: &str = "copied";
/// The pass that draws all samples in turn.
const CARRY: &str = "carry";
/// The pass that reads the depth of a tile of 16 x 8 pixels in each fragment.
const TILES: &str = "gather tiles";
/// The pass that reads the pixels that it draws over, and those around them.
const OUTLINES: &str = "outlines";
/// The pass that reads depth where it needs it.
pub const MARCH: &str = "gather march";

/// What is assumed of the driver, and known of the frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Assumed {
    /// True if the depth that is carried in two half floats ([`yoro_render::DepthResolve`]) takes 2 bytes instead of 4, as
    /// a Vulkan host stores it that resolves depth into 16 bits. A simulation: OpenGL ES cannot.
    pub depth_in_16_bits: bool,
    /// Share of the synthesized pixels whose tile has a law, 0 to 1.
    pub laws: f64,
}

impl Assumed {
    /// Returns the bytes of a pixel's samples in an image.
    fn texel_bytes(&self, image: &Image) -> f64 {
        let bytes = match image.format {
            Format::Rg16F if self.depth_in_16_bits => 2,
            format => format.bytes(),
        };
        bytes as f64 * f64::from(image.samples)
    }

    /// Returns the bytes that a pass moves for images and textures.
    pub fn bytes(&self, pass: &RecordedPass) -> f64 {
        let written = pass.declaration.writes.iter().map(|write| {
            let times = f64::from(write.is_loaded) + f64::from(write.is_stored);
            times * pixels(write.image.size) * self.texel_bytes(&write.image)
        });
        let read =
            pass.declaration.reads.iter().map(|read| self.texels(pass, read) * self.texel_bytes(&read.image));
        written.sum::<f64>() + read.sum::<f64>()
    }

    /// Returns the number of texels of an image that a pass moves.
    fn texels(&self, pass: &RecordedPass, Read { uniform, image }: &Read) -> f64 {
        let name = pass.declaration.name;
        match *uniform {
            COPIED => pixels(image.size),
            _ if name == TILES => pixels(image.size),
            uniform => {
                // The sky, which covers the view among meshes, reads none of their maps.
                let meshes = || pass.draws.iter().filter(|draw| draw.shape != Shape::Screen);
                if meshes().next().is_some() || uniform == SHADOW_MAP {
                    let reading = meshes().filter(|draw| has_map(draw, uniform));
                    return reading.map(|draw| fragments(pass, draw)).sum();
                }
                // A pass with several draw calls declares an image for each, or they cover what is written together.
                let areas = || pass.draws.iter().map(|draw| draw.area);
                let covered = areas().map(pixels).sum::<f64>();
                let whole = pass.declaration.writes.first().map(|write| write.image.size);
                let area = areas().find(|area| *area == image.size);
                let area = area.or_else(|| whole.filter(|size| pixels(*size) == covered));
                let area = area.or_else(|| areas().max_by(|a, b| pixels(*a).total_cmp(&pixels(*b))));
                let share = match name {
                    MARCH if uniform == "depth_map" => 1.0 - self.laws,
                    OUTLINES => pass.draws.iter().map(|draw| fragments(pass, draw)).sum::<f64>() / covered,
                    _ => 1.0,
                };
                share * area.map_or(0.0, |area| once(image, area))
            }
        }
    }
}

/// Gives the depth that the synthesis reads the format in which it was written. The library, which is not told the format,
/// declares 32 bits.
pub fn correct_depth_formats(passes: &mut [RecordedPass]) {
    let written = passes.iter().flat_map(|pass| &pass.declaration.writes).map(|write| write.image);
    let halves: Vec<Image> = written.filter(|image| image.format == Format::R16F).collect();
    for read in passes.iter_mut().flat_map(|pass| &mut pass.declaration.reads) {
        let has_size = |half: &&Image| read.uniform == "depth_map" && half.size == read.image.size;
        if read.image.samples == 1
            && let Some(half) = halves.iter().find(has_size)
        {
            read.image = *half;
        }
    }
}

/// False if the program is that of a material without this map.
fn has_map(draw: &RecordedDraw, uniform: &str) -> bool {
    let maps = ["diffuse_map", "specular_map", "emissive_map", "normal_map"];
    let macros = || draw.program.defines.iter().map(|(name, _)| name.to_lowercase());
    !maps.contains(&uniform) || macros().any(|name| name == uniform)
}

fn pixels(size: [u32; 2]) -> f64 {
    f64::from(size[0]) * f64::from(size[1])
}

/// Returns the number of texels that are read by a triangle that covers the view. The texture may hold two views side by
/// side, and may be larger or smaller than the view.
fn once(image: &Image, area: [u32; 2]) -> f64 {
    let scale = f64::from(image.size[1]) / f64::from(area[1].max(1));
    let part = [0, 1].map(|i| f64::from(image.size[i]).min(f64::from(area[i]) * scale));
    part[0] * part[1]
}

/// Returns the bytes of vertices and indices that a pass reads, each once.
pub fn vertex_bytes(pass: &RecordedPass) -> f64 {
    let meshes = pass.draws.iter().map(|draw| match draw.shape {
        Shape::Mesh { indices, vertices, vertex_bytes } => {
            vertices as f64 * f64::from(vertex_bytes) + 4.0 * indices as f64
        }
        Shape::Screen => 0.0,
    });
    meshes.sum()
}

/// Returns the samples per pixel of what a pass draws into.
pub fn samples(pass: &RecordedPass) -> u32 {
    pass.declaration.writes.first().map_or(1, |write| write.image.samples)
}

/// Returns the number of fragments of a draw call: the counted ones, or else all pixels of the view. With a mask of
/// samples, a triangle that covers the view passes fewer samples of as many pixels; with several samples in a tile it
/// passes more, but shades no pixel twice.
pub fn fragments(pass: &RecordedPass, draw: &RecordedDraw) -> f64 {
    let passed = draw.samples_passed.filter(|_| pass.declaration.name != CARRY);
    let most = if draw.shape == Shape::Screen { pixels(draw.area) } else { f64::INFINITY };
    passed.map_or(pixels(draw.area), |passed| most.min(passed as f64 / f64::from(samples(pass))))
}

#[cfg(test)]
pub mod tests {
    use super::*;
    use yoro_gl::{Declaration, ProgramRecipe, Write};

    const SIZE: [u32; 2] = [10, 4];
    const PIXELS: f64 = 40.0;
    pub const MESH: Shape = Shape::Mesh { indices: 6, vertices: 4, vertex_bytes: 32 };

    fn image(format: Format, samples: u32) -> Image {
        Image { format, size: SIZE, samples }
    }

    pub fn pass(
        name: &'static str,
        file: &str,
        shape: Shape,
        reads: &[(&'static str, Image)],
    ) -> RecordedPass {
        let reads = reads.iter().map(|&(uniform, image)| Read { uniform, image }).collect();
        let writes = vec![Write { image: image(Format::Rgba8, 1), is_loaded: false, is_stored: true }];
        let maps = ["DIFFUSE_MAP"].iter().filter(|_| file == "a.frag");
        let defines = maps.map(|map| (map.to_string(), String::new())).collect();
        let program = ProgramRecipe { files: vec![file.into()], defines }.into();
        let samples_passed = (shape != Shape::Screen).then_some(30);
        let draws = vec![RecordedDraw { program, shape, area: SIZE, samples_passed }];
        RecordedPass { declaration: Declaration { name, reads, writes }, draws }
    }

    #[test]
    fn texels_are_read_once_or_for_each_fragment() {
        let map = image(Format::Rgba8, 1);
        let bytes = |name, shape, uniform| {
            Assumed { laws: 0.75, ..Assumed::default() }.bytes(&pass(
                name,
                "a.frag",
                shape,
                &[(uniform, map)],
            )) / 4.0
        };
        assert_eq!(bytes("surfaces", MESH, "diffuse_map"), PIXELS + 30.0);
        assert_eq!(bytes("surfaces", MESH, "normal_map"), PIXELS);
        assert_eq!(bytes("bloom", Shape::Screen, "source"), PIXELS + PIXELS);
        assert_eq!(bytes(MARCH, Shape::Screen, "depth_map"), PIXELS + 0.25 * PIXELS);
        assert_eq!(vertex_bytes(&pass("surfaces", "a.frag", MESH, &[])), 4.0 * 32.0 + 6.0 * 4.0);
        // A view beside another is half of the texture, and a small texture is read in full.
        let wide = Image { size: [20, 4], ..map };
        assert_eq!(once(&wide, SIZE), PIXELS);
        assert_eq!(once(&Image { size: [20, 8], ..wide }, SIZE), 4.0 * PIXELS);
        assert_eq!(once(&Image { size: [5, 2], ..wide }, SIZE), 10.0);
        let carried = pass("march", "a.frag", Shape::Screen, &[("depth_map", image(Format::Rg16F, 1))]);
        let simulated = Assumed { depth_in_16_bits: true, ..Assumed::default() };
        assert_eq!(Assumed::default().bytes(&carried) - simulated.bytes(&carried), 2.0 * PIXELS);
        // Depth that was written in half floats is read so.
        let [mut resolve, march] = ["resolve", "march"]
            .map(|name| pass(name, "a.frag", Shape::Screen, &[("depth_map", image(Format::Depth32F, 1))]));
        resolve.declaration.reads.clear();
        resolve.declaration.writes[0].image.format = Format::R16F;
        let mut passes = [resolve, march];
        let bytes = |passes: &[RecordedPass]| Assumed::default().bytes(&passes[1]);
        let before = bytes(&passes);
        correct_depth_formats(&mut passes);
        assert_eq!(before - bytes(&passes), 2.0 * PIXELS);
    }

    #[test]
    fn a_triangle_that_covers_the_view_shades_each_pixel_once() {
        let mut screen = pass("composite", "a.frag", Shape::Screen, &[]);
        screen.draws[0].samples_passed = Some(4 * PIXELS as u64);
        assert_eq!(fragments(&screen, &screen.draws[0]), PIXELS);
    }
}
