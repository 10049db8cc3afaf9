//! What a tile-based GPU moves between its tiles and memory.
//!
//! It is derived from a record of a frame's commands by these rules:
//!
//! 1. Consecutive draw calls into one framebuffer are one piece of work, during which their images stay in the tiles.
//! 2. An image is read into the tiles at the start unless it is cleared, or first drawn by a triangle that covers the
//!    view without blending and without a test against its depth.
//! 3. An image is written to memory at the end if anything was drawn into it, unless it is discarded.
//! 4. Samples are averaged in the tiles if this directly follows drawing them. With
//!    [`Assumed::averages_in_memory`], they are written and read back by every `glBlitFramebuffer`.
//! 5. A triangle that covers the view reads each texel of its textures once. A mesh reads one texel of each texture per
//!    fragment. The shadow map is always read once per fragment. The march reads depth only where a tile has no law.

use std::rc::Rc;

use yoro_gl::{Aspect, Attachments, Format, Image, Shape};
use yoro_test_support::record::{Command, Draw};

/// The texture that every draw call reads at one place per fragment.
const SHADOW_MAP: &str = "shadow_map";

/// The pass that reads the depth of a tile of 16 x 8 pixels in each fragment.
const TILES: &str = "gather tiles";
/// The pass that reads depth where it needs it.
pub const MARCH: &str = "gather march";

/// What is assumed of the driver, and known of the frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Assumed {
    /// True if `glBlitFramebuffer` averages samples in memory instead of in the tiles.
    pub averages_in_memory: bool,
    /// True if the depth that is carried in two half floats ([`yoro_render::DepthResolve::InColor`]) takes 2 bytes
    /// instead of 4, as a Vulkan host stores it that resolves depth into 16 bits. A simulation: OpenGL ES cannot.
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
}

/// An image that a piece of work draws into.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Traffic {
    /// The image.
    pub image: Image,
    /// True if the image is read from memory first.
    pub loaded: bool,
    /// True if the image is written to memory.
    pub stored: bool,
    /// True if anything has drawn into or cleared the image.
    touched: bool,
    /// True if the image was read from memory before it was discarded.
    kept: bool,
    /// Bytes of a pixel.
    bytes: f64,
}

/// A piece of work on one framebuffer.
#[derive(Clone, Debug, PartialEq)]
pub struct Piece {
    /// The names of its passes, each once.
    pub passes: Vec<&'static str>,
    /// The colour attachments, then depth.
    pub images: Vec<Traffic>,
    /// The textures: name, image, and the bytes that are read.
    pub textures: Vec<(String, Image, f64)>,
    /// The columns and rows that are drawn.
    pub area: [u32; 2],
    /// The framebuffer; `None` for a copy.
    framebuffer: Option<Rc<Attachments>>,
    /// Bytes of vertices and indices that are read.
    pub vertex_bytes: f64,
}

fn pixels(size: [u32; 2]) -> f64 {
    f64::from(size[0]) * f64::from(size[1])
}

impl Piece {
    fn new(target: &Rc<Attachments>, assumed: &Assumed) -> Piece {
        let traffic = |image: &Image| Traffic {
            image: *image,
            loaded: false,
            stored: false,
            touched: false,
            kept: false,
            bytes: assumed.texel_bytes(image),
        };
        let images = target.color.iter().chain(&target.depth).map(traffic).collect();
        Piece {
            passes: Vec::new(),
            images,
            textures: Vec::new(),
            area: [0, 0],
            framebuffer: Some(target.clone()),
            vertex_bytes: 0.0,
        }
    }

    /// Returns the bytes moved for images and textures.
    pub fn bytes(&self) -> f64 {
        let moved = |t: &Traffic| (f64::from(t.loaded) + f64::from(t.stored)) * t.bytes;
        let images: f64 = self.images.iter().map(moved).sum();
        let textures: f64 = self.textures.iter().map(|(.., bytes)| bytes).sum();
        images * pixels(self.area) + textures
    }

    fn draws_into(&self, target: &Rc<Attachments>) -> bool {
        self.framebuffer.as_ref().is_some_and(|own| Rc::ptr_eq(own, target))
    }

    fn name(&mut self, pass: &'static str) {
        if !self.passes.contains(&pass) {
            self.passes.push(pass);
        }
    }

    fn of_kind(&mut self, depth: bool) -> impl Iterator<Item = &mut Traffic> {
        self.images.iter_mut().filter(move |traffic| traffic.image.format.is_depth() == depth)
    }

    /// Notes that samples are written to memory, whatever is discarded later.
    fn keep(&mut self, aspect: Aspect) {
        let image = match aspect {
            Aspect::Color(i) => self.of_kind(false).nth(i),
            Aspect::Depth => self.of_kind(true).next(),
        };
        if let Some(image) = image {
            image.kept = true;
        }
    }

    fn clear(&mut self, depth: bool) {
        let cleared = |t: &mut Traffic| (t.touched, t.stored) = (true, true);
        self.of_kind(false).for_each(cleared);
        if depth {
            self.of_kind(true).for_each(cleared);
        }
    }

    fn draw(&mut self, draw: &Draw, assumed: &Assumed) {
        self.name(draw.pass);
        let covers = draw.shape == Shape::Screen;
        if pixels(draw.view) > pixels(self.area) {
            self.area = draw.view;
        }
        let touch = |t: &mut Traffic, overwritten: bool, written: bool| {
            t.loaded |= !t.touched && !overwritten;
            t.stored |= written;
            t.touched = true;
        };
        self.of_kind(false).for_each(|t| touch(t, covers && !draw.blends, true));
        if draw.uses_depth {
            self.of_kind(true).for_each(|t| touch(t, covers && draw.writes_depth, draw.writes_depth));
        }
        for (name, image) in &draw.textures {
            let mut texels = match covers && name != SHADOW_MAP {
                true if draw.pass == TILES => pixels(image.size),
                true => texels_once(image, draw.area, draw.view),
                false => fragments(draw),
            };
            if draw.pass == MARCH && name == "depth_map" {
                texels *= 1.0 - assumed.laws;
            }
            let bytes = texels * assumed.texel_bytes(image);
            match self.textures.iter_mut().find(|(other, at, _)| other == name && at == image) {
                Some((.., sum)) => *sum += bytes,
                None => self.textures.push((name.clone(), *image, bytes)),
            }
        }
        if let Shape::Mesh { indices, vertices, vertex_bytes } = draw.shape {
            self.vertex_bytes += vertices as f64 * f64::from(vertex_bytes) + 4.0 * indices as f64;
        }
    }
}

/// Returns the number of fragments of a draw call: the counted ones, or else all pixels of the view. With a mask of
/// samples, a triangle that covers the view passes fewer samples of as many pixels.
pub fn fragments(draw: &Draw) -> f64 {
    if draw.masks_samples {
        return pixels(draw.area);
    }
    let samples =
        draw.target.as_ref().and_then(|target| target.color.first()).map_or(1, |image| image.samples);
    draw.samples_passed.map_or(pixels(draw.area), |passed| passed as f64 / f64::from(samples))
}

/// Returns the number of texels that are read by a triangle that covers a part of a view, of this size. The texture may
/// hold two views side by side, and may be larger or smaller than the view.
fn texels_once(image: &Image, area: [u32; 2], view: [u32; 2]) -> f64 {
    let scale = f64::from(image.size[1]) / f64::from(view[1].max(1));
    let part = [0, 1].map(|i| f64::from(image.size[i]).min(f64::from(area[i]) * scale));
    part[0] * part[1]
}

/// Returns the pieces of work of a recorded frame.
pub fn pieces(commands: &[Command], assumed: &Assumed) -> Vec<Piece> {
    let mut pieces: Vec<Piece> = Vec::new();
    // True if the next draw call into the last piece's framebuffer belongs to that piece.
    let mut open = false;
    for command in commands {
        match command {
            Command::Clear(Some(target), depth) => {
                begin(&mut pieces, &mut open, target, assumed).clear(*depth);
            }
            Command::Draw(draw @ Draw { target: Some(target), .. }) => {
                begin(&mut pieces, &mut open, target, assumed).draw(draw, assumed);
            }
            Command::Discard(Some(target), given_up) => {
                let of = |piece: &&mut Piece| piece.draws_into(target);
                if let Some(piece) = pieces.iter_mut().rev().find(of) {
                    for (depth, _) in
                        [false, true].into_iter().zip(given_up).filter(|(_, given_up)| **given_up)
                    {
                        piece.of_kind(depth).for_each(|t| t.stored = t.kept);
                    }
                }
            }
            Command::Copy { pass, from, to, size, aspect } => {
                let image = |target: &Option<Rc<Attachments>>, color: usize| {
                    let images = target.as_ref()?;
                    if *aspect == Aspect::Depth { images.depth } else { images.color.get(color).copied() }
                };
                let color = if let Aspect::Color(i) = aspect { *i } else { 0 };
                let (Some(source), Some(target)) = (image(from, color), image(to, 0)) else { continue };
                let follows = from.as_ref().is_some_and(|from| is_of_last(&pieces, from));
                let is_average = source.samples > 1 && follows;
                let in_tile = is_average && !assumed.averages_in_memory;
                if is_average
                    && !in_tile
                    && let Some(drawn) = pieces.iter_mut().rev().find(|piece| piece.framebuffer.is_some())
                {
                    drawn.keep(*aspect);
                }
                let read = if in_tile { 0.0 } else { pixels(*size) * assumed.texel_bytes(&source) };
                pieces.push(Piece {
                    passes: vec![*pass],
                    images: vec![Traffic {
                        image: target,
                        loaded: false,
                        stored: true,
                        touched: true,
                        kept: false,
                        bytes: assumed.texel_bytes(&target),
                    }],
                    textures: vec![("copied".into(), source, read)],
                    area: *size,
                    framebuffer: None,
                    vertex_bytes: 0.0,
                });
                open = false;
            }
            Command::Clear(None, _) | Command::Draw(_) | Command::Discard(None, _) => {}
        }
    }
    pieces.retain(|piece| !piece.passes.is_empty());
    pieces
}

/// True if the last piece that is not a copy draws into this framebuffer.
fn is_of_last(pieces: &[Piece], target: &Rc<Attachments>) -> bool {
    let drawn = pieces.iter().rev().find(|piece| piece.framebuffer.is_some());
    drawn.is_some_and(|piece| piece.draws_into(target))
}

/// Returns the open piece if it draws into this framebuffer, or else a new one.
fn begin<'a>(
    pieces: &'a mut Vec<Piece>,
    open: &mut bool,
    target: &Rc<Attachments>,
    assumed: &Assumed,
) -> &'a mut Piece {
    let goes_on = *open && pieces.last().is_some_and(|piece| piece.draws_into(target));
    if !goes_on {
        pieces.push(Piece::new(target, assumed));
        *open = true;
    }
    pieces.last_mut().expect("one was pushed if there was none")
}

#[cfg(test)]
mod tests {
    use super::*;
    use yoro_gl::{Format, ProgramRecipe};

    const SIZE: [u32; 2] = [10, 4];
    const PIXELS: f64 = 40.0;

    fn image(format: Format, samples: u32) -> Image {
        Image { format, size: SIZE, samples }
    }

    fn target(color: Image, depth: Option<Image>) -> Option<Rc<Attachments>> {
        Some(Rc::new(Attachments { color: vec![color], depth }))
    }

    fn draw(
        pass: &'static str,
        to: &Option<Rc<Attachments>>,
        shape: Shape,
        textures: &[(&str, Image)],
    ) -> Draw {
        let is_mesh = shape != Shape::Screen;
        Draw {
            pass,
            program: ProgramRecipe { files: vec!["a.frag".into()], defines: Vec::new() }.into(),
            target: to.clone(),
            textures: textures.iter().map(|(name, image)| ((*name).to_owned(), *image)).collect(),
            area: SIZE,
            view: SIZE,
            shape,
            blends: false,
            uses_depth: is_mesh,
            writes_depth: is_mesh,
            masks_samples: false,
            samples_passed: is_mesh.then_some(4 * 30),
        }
    }

    const MESH: Shape = Shape::Mesh { indices: 6, vertices: 4, vertex_bytes: 32 };

    /// Four samples are drawn, averaged and discarded, except depth, which is kept if something reads it afterwards.
    #[test]
    fn samples_stay_in_the_tile_unless_something_reads_them() {
        let samples = target(image(Format::Rgba8, 4), Some(image(Format::Depth32F, 4)));
        let resolved = target(image(Format::Rgba8, 1), Some(image(Format::Depth32F, 1)));
        let map = [("diffuse_map", image(Format::Srgb8Alpha8, 1))];
        let copy = Command::Copy {
            pass: "resolve",
            from: samples.clone(),
            to: resolved.clone(),
            size: SIZE,
            aspect: Aspect::Color(0),
        };
        let forward = [
            Command::Clear(samples.clone(), true),
            Command::Draw(draw("surfaces", &samples, MESH, &map)),
            Command::Draw(draw("transparent", &samples, MESH, &map)),
            copy,
        ];
        let bytes = |given_up: [bool; 2], more: &[Command]| {
            let discard = [Command::Discard(samples.clone(), given_up)];
            let pieces = pieces(&[&forward[..], &discard, more].concat(), &Assumed::default());
            pieces.iter().map(|piece| (piece.passes.join(", "), piece.bytes())).collect::<Vec<_>>()
        };
        // The 30 fragments of each draw call read a texel of 4 bytes.
        let maps = 2.0 * 30.0 * 4.0;
        let named = |name: &str, bytes: f64| (name.to_owned(), bytes);
        assert_eq!(
            bytes([true, true], &[]),
            [named("surfaces, transparent", maps), named("resolve", 4.0 * PIXELS)]
        );
        let depth_only =
            Some(Rc::new(Attachments { color: Vec::new(), depth: Some(image(Format::Depth32F, 1)) }));
        let mut nearest =
            draw("nearest depth", &depth_only, Shape::Screen, &[("depth_map", image(Format::Depth32F, 4))]);
        (nearest.uses_depth, nearest.writes_depth) = (true, true);
        assert_eq!(
            bytes([true, false], &[Command::Draw(nearest)]),
            [
                named("surfaces, transparent", maps + 16.0 * PIXELS),
                named("resolve", 4.0 * PIXELS),
                named("nearest depth", (16.0 + 4.0) * PIXELS),
            ]
        );
    }

    /// A second colour carries depth; both are averaged, and all samples discarded.
    #[test]
    fn averages_in_memory_write_and_read_all_samples_that_are_averaged() {
        let pair = |samples| image(Format::Rg16F, samples);
        let color = vec![image(Format::Rgba8, 4), pair(4)];
        let samples = Some(Rc::new(Attachments { color, depth: Some(image(Format::Depth32F, 4)) }));
        let [to, depth] = [image(Format::Rgba8, 1), pair(1)].map(|image| target(image, None));
        let mut carry = draw("carry", &samples, Shape::Screen, &[]);
        (carry.masks_samples, carry.samples_passed) = (true, Some(3 * PIXELS as u64));
        assert_eq!(fragments(&carry), PIXELS);
        let average = |i, to: &Option<Rc<Attachments>>| Command::Copy {
            pass: "resolve",
            from: samples.clone(),
            to: to.clone(),
            size: SIZE,
            aspect: Aspect::Color(i),
        };
        let commands = [
            Command::Clear(samples.clone(), true),
            Command::Draw(draw("surfaces", &samples, MESH, &[])),
            Command::Draw(carry),
            average(0, &to),
            average(1, &depth),
            Command::Discard(samples.clone(), [true, true]),
        ];
        let bytes = |assumed: Assumed| -> Vec<f64> {
            pieces(&commands, &assumed).iter().map(|piece| piece.bytes() / PIXELS).collect()
        };
        assert_eq!(bytes(Assumed::default()), [0.0, 4.0, 4.0]);
        assert_eq!(bytes(Assumed { depth_in_16_bits: true, ..Assumed::default() }), [0.0, 4.0, 2.0]);
        let in_memory = Assumed { averages_in_memory: true, ..Assumed::default() };
        assert_eq!(bytes(in_memory), [16.0 + 16.0, 16.0 + 4.0, 16.0 + 4.0]);
    }

    #[test]
    fn the_synthesis_reads_depth_where_it_needs_it() {
        let depth = Image { format: Format::Rg16F, size: [32, 16], samples: 1 };
        let to = target(Image { format: Format::Rgba8, size: [32, 16], samples: 1 }, None);
        let bytes = |pass, area| {
            let mut draw = draw(pass, &to, Shape::Screen, &[("depth_map", depth)]);
            (draw.area, draw.view) = (area, area);
            let assumed = Assumed { laws: 0.75, ..Assumed::default() };
            pieces(&[Command::Draw(draw)], &assumed)[0].textures[0].2
        };
        let all = 4.0 * 32.0 * 16.0;
        // A fragment for each tile of 16 x 8 pixels.
        assert_eq!(bytes(TILES, [2, 2]), all);
        assert_eq!(bytes(MARCH, [32, 16]), 0.25 * all);
    }

    #[test]
    fn what_goes_on_in_an_image_is_read_first() {
        let [a, b] = [0, 1].map(|_| target(image(Format::Rgba8, 1), None));
        let screen = |to| Command::Draw(draw("screen", to, Shape::Screen, &[]));
        let blended = |to| Command::Draw(Draw { blends: true, ..draw("blend", to, Shape::Screen, &[]) });
        let bytes = |commands: &[Command]| {
            pieces(commands, &Assumed::default()).iter().map(Piece::bytes).sum::<f64>()
        };
        // The image is written once, and blended with while it is in the tile.
        assert_eq!(bytes(&[screen(&a), blended(&a)]), 4.0 * PIXELS);
        // Another image is drawn in between, so that this one is written, and then read and written again.
        assert_eq!(bytes(&[screen(&a), screen(&b), blended(&a)]), (4.0 + 4.0 + 8.0) * PIXELS);
    }

    #[test]
    fn a_view_beside_another_is_half_of_the_texture() {
        let wide = Image { format: Format::Rgba8, size: [20, 4], samples: 1 };
        assert_eq!(texels_once(&wide, SIZE, SIZE), PIXELS);
        // A texture of twice the size is read in full, and so is a small one.
        assert_eq!(texels_once(&Image { size: [20, 8], ..wide }, SIZE, SIZE), 4.0 * PIXELS);
        assert_eq!(texels_once(&Image { size: [5, 2], ..wide }, SIZE, SIZE), 10.0);
        // A part of the view reads as large a part.
        assert_eq!(texels_once(&Image { size: SIZE, ..wide }, [3, 2], SIZE), 6.0);
        assert_eq!(texels_once(&Image { size: [20, 8], ..wide }, [3, 2], SIZE), 24.0);
    }

    #[test]
    fn vertices_and_indices_are_read_once() {
        let to = target(image(Format::Rgba8, 1), None);
        let pieces = pieces(&[Command::Draw(draw("surfaces", &to, MESH, &[]))], &Assumed::default());
        assert_eq!(pieces[0].vertex_bytes, 4.0 * 32.0 + 6.0 * 4.0);
    }
}
