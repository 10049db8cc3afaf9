//! Sources that are parts of larger textures or layers of arrays: the picture is the same as from separate textures.

use std::rc::Rc;

use glow::HasContext;
use rand::{Rng, SeedableRng};

use super::laws::{on_every_backend, open_es_300, pair, scene};
use super::state::snapshot;
use yoro::eyes::{DepthConvention, Eye, GuardBand, Warp};
use yoro::opengl::{Context, Destination, Gather, GlState, Options, Outputs, Part, Source, buffer_bytes};
use yoro::synthesis::Holes;
use yoro_context::{Backend, Headless};
use yoro_gl::{Filter, Format, RenderTarget};

/// The corner of every source in its textures.
pub const ORIGIN: [u32; 2] = [5, 3];
const MARGIN: [u32; 2] = [9, 6];
const LAYER: u32 = 1;

/// A rendered eye in memory.
pub struct Picture {
    pub warp: Warp,
    pub rgba: Vec<u8>,
    pub depth: Vec<u8>,
}

impl Picture {
    fn new(size: [u32; 2], dominant: Eye, seed: u64) -> Picture {
        let eyes = pair(size, dominant, 0.063, DepthConvention::Reversed);
        let warp = eyes.synthesis_views(GuardBand::Pixels(9)).unwrap().warp;
        let (rgba, depth) = scene(warp.source_size, eyes.depth, seed);
        Picture { warp, rgba, depth: depth.iter().flat_map(|z| z.to_ne_bytes()).collect() }
    }
}

/// A colour and a depth texture, optionally arrays of two layers, with noise around the source.
pub struct Textures {
    gl: Rc<Context>,
    names: [glow::Texture; 2],
}

impl Textures {
    pub fn new(gl: &Rc<Context>, picture: &Picture, parts: bool, layers: bool) -> (Textures, Source) {
        let size = picture.warp.source_size;
        let (origin, image_size) =
            if parts { (ORIGIN, [0, 1].map(|i| ORIGIN[i] + size[i] + MARGIN[i])) } else { ([0, 0], size) };
        let target = if layers { glow::TEXTURE_2D_ARRAY } else { glow::TEXTURE_2D };
        let ([w, h], [x, y], [iw, ih]) =
            (size.map(|n| n as i32), origin.map(|n| n as i32), image_size.map(|n| n as i32));
        let mut rng = rand_pcg::Pcg32::seed_from_u64(3);
        let raw = gl.raw();
        let texture = |format: Format, own: &[u8], noise: &[u8]| {
            let (internal, channels, kind) = format.gl();
            // SAFETY: a new texture; the slices are as long as GL reads.
            unsafe {
                let texture = raw.create_texture().unwrap();
                raw.bind_texture(target, Some(texture));
                raw.pixel_store_i32(glow::UNPACK_ALIGNMENT, 1);
                let upload = |layer: i32, [x, y]: [i32; 2], [w, h]: [i32; 2], bytes: &[u8]| {
                    let data = glow::PixelUnpackData::Slice(Some(bytes));
                    if layers {
                        raw.tex_sub_image_3d(target, 0, x, y, layer, w, h, 1, channels, kind, data);
                    } else {
                        raw.tex_sub_image_2d(target, 0, x, y, w, h, channels, kind, data);
                    }
                };
                if layers {
                    raw.tex_storage_3d(target, 1, internal, iw, ih, 2);
                    upload(0, [0, 0], [iw, ih], noise);
                } else {
                    raw.tex_storage_2d(target, 1, internal, iw, ih);
                }
                upload(LAYER as i32, [0, 0], [iw, ih], noise);
                upload(LAYER as i32, [x, y], [w, h], own);
                raw.bind_texture(target, None);
                texture
            }
        };
        let noise: Vec<u8> = (0..iw * ih * 4).map(|_| rng.random()).collect();
        let color = texture(Format::Rgba8, &picture.rgba, &noise);
        let noise: Vec<u8> = (0..iw * ih).flat_map(|_| rng.random::<f32>().to_ne_bytes()).collect();
        let depth = texture(Format::Depth32F, &picture.depth, &noise);
        let part = parts.then_some(Part { origin, image_size });
        let layer = if layers { LAYER } else { 0 };
        let source = Source { part, layer, ..Source::new(color, depth) };
        (Textures { gl: gl.clone(), names: [color, depth] }, source)
    }
}

impl Drop for Textures {
    fn drop(&mut self) {
        // SAFETY: created in `new`.
        unsafe { self.names.iter().for_each(|name| self.gl.raw().delete_texture(*name)) };
    }
}

/// Returns the synthesized colour and source map.
fn run(gl: &Rc<Context>, gather: &mut Gather, source: Source, warp: &Warp) -> (Vec<u8>, Vec<u32>) {
    let formats = [(Format::Rgba8, Filter::Nearest), (Format::R32Ui, Filter::Nearest)];
    let target = RenderTarget::new(gl, warp.target_size, &formats, None).unwrap();
    gather.synthesize(source, warp, &Destination::whole(&target)).unwrap();
    (target.read_rgba8(0, [0, 0], warp.target_size), target.read_u32(1, [0, 0], warp.target_size))
}

const OUTPUTS: Outputs = Outputs { depth: false, source_map: true, srgb: false, holes: Holes::Filled };

/// Checks that two pictures are equal, except for a few pixels whose positions lie within rounding of a decision.
/// Columns differ by a thousandth of a pixel at most.
fn assert_equal(got: &(Vec<u8>, Vec<u32>), want: &(Vec<u8>, Vec<u32>), what: &str) {
    let far = |(a, b): (&[u8], &[u8])| a.iter().zip(b).any(|(a, b)| a.abs_diff(*b) > 1);
    let colors = got.0.chunks_exact(4).zip(want.0.chunks_exact(4)).filter(|&pair| far(pair)).count();
    let columns = got.1.iter().zip(&want.1).filter(|(a, b)| a.abs_diff(**b) > 64).count();
    assert!(colors.max(columns) * 500 <= got.1.len(), "{what}: {colors} colours, {columns} columns differ");
}

/// Draws pictures from parts and layers, and compares them with those from textures of their own.
fn draw_parts_and_layers(gl: &Rc<Context>) -> Vec<[(Vec<u8>, Vec<u32>); 3]> {
    // A smaller picture after a larger one, and a mirrored one.
    let cases = [([97, 31], Eye::Right), ([61, 20], Eye::Right), ([61, 20], Eye::Left)];
    let pictures = cases.map(|(size, dominant)| Picture::new(size, dominant, 11));
    let mut whole = Gather::new(gl, &Options::default(), OUTPUTS).unwrap();
    let wanted = pictures.each_ref().map(|picture| {
        let (_own, source) = Textures::new(gl, picture, false, false);
        run(gl, &mut whole, source, &picture.warp)
    });
    let drawn = [(true, false), (false, true), (true, true)].map(|(parts, layers)| {
        let options = Options { parts, array_textures: layers, ..Options::default() };
        let mut gather = Gather::new(gl, &options, OUTPUTS).unwrap();
        let drawn = pictures.each_ref().map(|picture| {
            let (_part, source) = Textures::new(gl, picture, parts, layers);
            run(gl, &mut gather, source, &picture.warp)
        });
        for ((got, want), picture) in drawn.iter().zip(&wanted).zip(&pictures) {
            assert_equal(got, want, &format!("parts {parts}, layers {layers}, {:?}", picture.warp));
        }
        drawn
    });
    drawn.into()
}

#[test]
fn parts_and_layers_give_the_same_picture() {
    on_every_backend(|gl| drop(draw_parts_and_layers(gl)));
    // One after the other, since each is the thread's current context.
    let limited = draw_parts_and_layers(open_es_300().gl());
    let whole = draw_parts_and_layers(Headless::open(Backend::Egl).unwrap().gl());
    assert!(limited == whole, "the shaders of OpenGL ES 3.0 draw something else");
}

/// After the largest size, no frame allocates, whatever its size; and the memory is known beforehand.
#[test]
fn buffers_of_parts_only_grow() {
    on_every_backend(|gl| {
        let [large, small] = [[197, 70], [61, 20]].map(|size| Picture::new(size, Eye::Right, 1).warp);
        let options = Options { parts: true, ..Options::default() };
        let mut gather = Gather::new(gl, &options, OUTPUTS).unwrap();
        gather.prepare(&large).unwrap();
        let bytes = gl.texture_bytes();
        assert_eq!(bytes as u64, buffer_bytes(&large));
        gather.prepare(&small).unwrap();
        assert_eq!(gl.texture_bytes(), bytes);
        drop(gather);
        let mut fitting = Gather::new(gl, &Options { parts: false, ..options }, OUTPUTS).unwrap();
        fitting.prepare(&large).unwrap();
        fitting.prepare(&small).unwrap();
        assert_eq!(gl.texture_bytes() as u64, buffer_bytes(&small));
    });
}

#[test]
fn the_hosts_array_textures_are_preserved() {
    on_every_backend(|gl| {
        let picture = Picture::new([48, 16], Eye::Right, 2);
        let (textures, source) = Textures::new(gl, &picture, true, true);
        let options =
            Options { gl_state: GlState::Preserve, parts: true, array_textures: true, ..Options::default() };
        let formats = [(Format::Rgba8, Filter::Nearest), (Format::R32Ui, Filter::Nearest)];
        let target = RenderTarget::new(gl, picture.warp.target_size, &formats, None).unwrap();
        // SAFETY: textures of this context.
        unsafe {
            for (unit, texture) in textures.names.into_iter().enumerate() {
                gl.raw().active_texture(glow::TEXTURE0 + unit as u32);
                gl.raw().bind_texture(glow::TEXTURE_2D_ARRAY, Some(texture));
            }
        }
        let before = snapshot(gl);
        let mut gather = Gather::new(gl, &options, OUTPUTS).unwrap();
        // Depth is bound to unit 0, and colour to unit 1; the host has them the other way round.
        gather.synthesize(source, &picture.warp, &Destination::whole(&target)).unwrap();
        assert_eq!(snapshot(gl), before);
    });
}
