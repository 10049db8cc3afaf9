//! Open holes: which pixels are left open, how they are marked, and that all others are as if holes were filled.

use std::rc::Rc;

use glow::HasContext;

use super::laws::{on_every_backend, pair, scene};
use super::near_boxes;
use super::reference::open_pixels;
use super::state::{OUTPUTS, clean, program, read_depth};
use yoro::eyes::{DepthConvention, DepthRange, Eye, EyePair, GuardBand, Warp};
use yoro::opengl::{AnyView, Context, Destination, Gather, GlError, Motion, Options, Outputs, Source};
use yoro::synthesis::{HoleMark, Holes};
use yoro_gl::{Filter, Format, RenderTarget, Texture};

/// What no source map contains.
const OPEN: u32 = u32::MAX;
/// The corner of the target in its framebuffer.
const ORIGIN: [u32; 2] = [7, 5];

/// A rendered eye in textures, and a framebuffer around the other one.
struct Rig {
    gl: Rc<Context>,
    warp: Warp,
    depth: Vec<f32>,
    textures: [Texture; 2],
    target: RenderTarget,
}

/// Colours, source map, and depth as bits, of the target's rectangle.
type Picture = (Vec<[u8; 4]>, Vec<u32>, Vec<u32>);

impl Rig {
    fn new(gl: &Rc<Context>, warp: Warp, (rgba, depth): (Vec<u8>, Vec<f32>)) -> Rig {
        let texture = |format, filter, bytes: &[u8]| {
            let texture = Texture::new(gl, warp.source_size, format, filter).unwrap();
            texture.upload(bytes);
            texture
        };
        let bytes: Vec<u8> = depth.iter().flat_map(|z| z.to_ne_bytes()).collect();
        let textures =
            [texture(Format::Rgba8, Filter::Linear, &rgba), texture(Format::R32F, Filter::Nearest, &bytes)];
        assert_eq!(rgba.len(), depth.len() * 4);
        let formats = [(Format::Rgba8, Filter::Nearest), (Format::R32Ui, Filter::Nearest)];
        let size = [0, 1].map(|i| ORIGIN[i] + warp.target_size[i] + 3);
        let target = RenderTarget::new(gl, size, &formats, Some(Format::Depth32FStencil8)).unwrap();
        Rig { gl: gl.clone(), warp, depth, textures, target }
    }

    /// Synthesizes, and writes [`OPEN`] into the source map where stencil is 0.
    fn run(&self, holes: Holes) -> Picture {
        let gl = &self.gl;
        clean(gl);
        self.target.bind();
        gl.clear(Some(0.5));
        let depth = holes != Holes::Open(HoleMark::Depth);
        let mut gather = Gather::new(gl, &Options::default(), Outputs { holes, depth, ..OUTPUTS }).unwrap();
        let source = Source::new(self.textures[0].raw(), self.textures[1].raw());
        let to =
            Destination { framebuffer: Some(self.target.raw()), origin: ORIGIN, size: self.warp.target_size };
        gather.synthesize(source, &self.warp, &to).unwrap();
        clean(gl);
        if holes == Holes::Open(HoleMark::Stencil) {
            self.fill_open(to);
        }
        assert_eq!(gl.take_errors(), None);
        let part = |all: Vec<u32>| -> Vec<u32> {
            let width = self.target.size()[0] as usize;
            let rows = all.chunks_exact(width).skip(ORIGIN[1] as usize).take(to.size[1] as usize);
            rows.flat_map(|row| row[ORIGIN[0] as usize..][..to.size[0] as usize].to_vec()).collect()
        };
        let depth = read_depth(gl, self.target.depth().raw(), self.target.size());
        let around = depth.iter().filter(|z| **z == 0.5f32.to_bits()).count();
        let area = |[w, h]: [u32; 2]| (w * h) as usize;
        assert!(
            around >= area(self.target.size()) - area(to.size),
            "the frame around the target is not touched"
        );
        let rgba = self.target.read_rgba8(0, ORIGIN, to.size);
        let colors = rgba.chunks_exact(4).map(|c| [c[0], c[1], c[2], c[3]]).collect();
        (colors, self.target.read_u32(1, ORIGIN, to.size), part(depth))
    }

    /// Draws as a host does: where stencil equals 0.
    fn fill_open(&self, to: Destination) {
        let (gl, raw) = (&self.gl, self.gl.raw());
        let corners = "vec2(gl_VertexID / 2, gl_VertexID % 2) * 4.0 - 1.0";
        let open = program(
            gl,
            &format!("void main() {{ gl_Position = vec4({corners}, 0.0, 1.0); }}"),
            "layout(location = 1) out uint open; void main() { open = 0xffffffffu; }",
        );
        gl.bind_framebuffer(to.framebuffer, to.origin, to.size);
        // SAFETY: live objects; the vertex array has no attributes.
        unsafe {
            let array = raw.create_vertex_array().unwrap();
            raw.bind_vertex_array(Some(array));
            raw.use_program(Some(open));
            raw.enable(glow::STENCIL_TEST);
            raw.stencil_func(glow::EQUAL, 0, 0xff);
            raw.stencil_op(glow::KEEP, glow::KEEP, glow::KEEP);
            raw.draw_arrays(glow::TRIANGLES, 0, 3);
            raw.disable(glow::STENCIL_TEST);
            raw.bind_vertex_array(None);
            raw.delete_vertex_array(array);
            raw.use_program(None);
            raw.delete_program(open);
        }
    }
}

fn rigs(gl: &Rc<Context>) -> Vec<Rig> {
    let mut rigs = Vec::new();
    for (seed, dominant, convention) in
        [(1, Eye::Right, DepthConvention::Standard), (2, Eye::Left, DepthConvention::Reversed)]
    {
        let scattered = pair([150, 40], dominant, 0.2, convention);
        let near = EyePair { depth: DepthRange { near: 0.05, ..scattered.depth }, ..scattered };
        for p in [scattered, near] {
            let warp = p.synthesis_views(GuardBand::Pixels(21)).unwrap().warp;
            let content = match p == near {
                true => near_boxes(warp.source_size, p.depth, seed, 6),
                false => scene(warp.source_size, p.depth, seed),
            };
            rigs.push(Rig::new(gl, warp, content));
        }
        let warp = scattered.synthesis_views(GuardBand::Pixels(21)).unwrap().warp;
        rigs.push(Rig::new(gl, warp, tiled_board(warp.source_size, scattered.depth)));
    }
    rigs
}

/// Returns the colour and the depth of a board of whole tiles before a wall: only the rows of other tiles tell where it ends.
fn tiled_board([width, height]: [u32; 2], range: DepthRange) -> (Vec<u8>, Vec<f32>) {
    let is_board = |at: u32| (32..96).contains(&(at % width)) && (8..24).contains(&(at / width));
    let pixels = (0..width * height).map(|at| if is_board(at) { ([255; 4], 1.0) } else { ([0; 4], 5.0) });
    let (rgba, depth): (Vec<[u8; 4]>, Vec<f32>) = pixels.map(|(c, z)| (c, range.depth(z))).unzip();
    (rgba.concat(), depth)
}

#[test]
fn open_pixels_are_those_of_the_reference() {
    on_every_backend(|gl| {
        for (i, rig) in rigs(gl).iter().enumerate() {
            let filled = rig.run(Holes::Filled);
            let open = rig.run(Holes::Open(HoleMark::Stencil));
            let by_depth = rig.run(Holes::Open(HoleMark::Depth));
            let [nearest, farthest] = rig.warp.convention.planes().map(f32::to_bits);
            let (mut count, mut different) = (0, 0);
            for (at, want) in open_pixels(&rig.depth, &rig.warp).into_iter().enumerate() {
                let is_open = open.1[at] == OPEN;
                count += usize::from(is_open);
                different += usize::from(is_open != want);
                let what = format!("case {i}, pixel {at}");
                assert_eq!(by_depth.2[at], if is_open { farthest } else { nearest }, "{what}");
                if is_open {
                    assert_eq!(open.2[at], farthest, "{what}");
                } else {
                    let of = |p: &Picture| (p.0[at], p.1[at]);
                    assert_eq!(of(&open), of(&filled), "{what}");
                    assert_eq!(of(&by_depth), of(&filled), "{what}");
                    assert_eq!(open.2[at], filled.2[at], "{what}");
                }
            }
            let total = open.1.len();
            println!("case {i}: {count} of {total} pixels are open, {different} differ");
            // Positions within rounding of a decision may differ.
            assert!(different * 500 <= total, "case {i}: {different} of {total} differ");
            assert!(count * 100 > total && count * 2 < total, "case {i}: {count} of {total} are open");
        }
    });
}

#[test]
fn what_cannot_be_left_open_is_refused() {
    on_every_backend(|gl| {
        let holes = Holes::Open(HoleMark::Stencil);
        let open = Outputs { holes, ..Outputs::default() };
        let both = Outputs { depth: true, holes: Holes::Open(HoleMark::Depth), ..Outputs::default() };
        let options = Options::default();
        let errors = [
            AnyView::new(gl, &options, open).err(),
            Motion::new(gl, &options, open).err(),
            Gather::new(gl, &options, both).err(),
        ];
        assert!(errors.iter().all(|error| matches!(error, Some(GlError::Unsupported(_)))), "{errors:?}");
    });
}
