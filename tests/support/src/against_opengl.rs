//! Compares pictures of the passes on another graphics interface with those of OpenGL. All rows are counted from the
//! bottom, places in images from the top.

use std::cell::RefCell;
use std::rc::Rc;

use rand::{Rng, SeedableRng};

use crate::in_memory::{self, InMemory, SynthesizedImage};
use crate::posed;
use yoro::eyes::{
    DepthConvention, DepthRange, DisparityMap, Eye, EyePair, Frustum, GuardBand, MotionMap, MotionWarp, Pose,
    PoseWarp, VectorsOf, View, Warp,
};
use yoro::opengl::{self, Context, Destination, Options, Outputs};
use yoro::synthesis::backend::WarpKind;
use yoro_context::{Backend, Headless};
use yoro_gl::{self as gl, Filter, RenderTarget, Texture};

/// A rendered eye, with rows from the bottom.
pub struct Picture<W = Warp> {
    pub warp: W,
    pub rgba: Vec<u8>,
    pub depth: Vec<f32>,
}

/// Returns a slanted wall with boxes and wires in front of it. Colours differ from pixel to pixel, but so smoothly that
/// an error of position causes a proportional error of colour.
pub fn picture<W: WarpKind>(warp: &W, range: DepthRange, seed: u64) -> Picture<W> {
    let [w, h] = warp.sizes()[0].map(|n| n as usize);
    let mut rng = rand_pcg::Pcg32::seed_from_u64(seed);
    let mut z: Vec<f32> =
        (0..w * h).map(|i| 4.0 + 3.0 * (i % w) as f32 / w as f32 + 0.01 * (i / w) as f32).collect();
    let mut paint = vec![0u32; w * h];
    for number in 1..12 {
        let (x, y) = (rng.random_range(0..w), rng.random_range(0..h));
        let wire = rng.random_bool(0.3);
        let (bw, bh) =
            if wire { (1, h) } else { (rng.random_range(1..w / 3 + 2), rng.random_range(1..h / 2 + 2)) };
        let (near, slope) = (rng.random_range(0.5..3.0f32), rng.random_range(-0.01..0.01f32));
        for j in y..(y + bh).min(h) {
            for i in x..(x + bw).min(w) {
                let here = (near + slope * (i - x) as f32).max(0.4);
                if here < z[j * w + i] {
                    (z[j * w + i], paint[j * w + i]) = (here, number);
                }
            }
        }
    }
    let rgba = (0..w * h).flat_map(|i| {
        let (x, y, number) = (i % w, i / w, paint[i]);
        [(x * 5 + number as usize * 40) as u8, (y * 3 + x) as u8, (number * 20) as u8, (200 + number) as u8]
            .map(|value| if (value / 64) % 2 == 0 { value } else { 255 - value })
    });
    Picture { warp: *warp, rgba: rgba.collect(), depth: z.iter().map(|z| range.depth(*z)).collect() }
}

pub fn eyes(size: [u32; 2], dominant: Eye, range: DepthRange) -> EyePair {
    let frustum = Frustum::symmetric(1.2, size[0] as f32 / size[1] as f32);
    EyePair::parallel(Pose::IDENTITY, frustum, 0.063, range, size, dominant)
}

/// Returns standard, reversed and infinite depth ranges, and one reversed by swapped planes as in OpenXR.
pub fn ranges() -> [DepthRange; 4] {
    let standard = DepthRange { near: 0.3, far: 100.0, convention: DepthConvention::Standard };
    [
        standard,
        DepthRange { convention: DepthConvention::Reversed, ..standard },
        DepthRange { far: f32::INFINITY, convention: DepthConvention::Reversed, near: 0.1 },
        DepthRange::from_distances(100.0, 0.3),
    ]
}

/// The pipelines on OpenGL ES.
pub struct Gl {
    pub headless: Headless,
    gather: RefCell<InMemory>,
}

impl Gl {
    pub fn open() -> Gl {
        let headless = Headless::open(Backend::Egl).expect("EGL is set up by `cargo xtask setup`");
        let mut gather = opengl::Gather::new(headless.gl(), &Options::default(), in_memory::OUTPUTS).unwrap();
        let synthesize = Box::new(move |source, warp: &Warp, target: &Destination| {
            gather.synthesize(source, warp, target)
        });
        let gather = RefCell::new(InMemory::new(headless.gl(), synthesize));
        Gl { headless, gather }
    }

    /// Returns what OpenGL draws. It receives the picture upside down, so that tiles contain the same rows as on other
    /// interfaces, whose rows are counted from the top.
    pub fn run(&self, picture: &Picture) -> SynthesizedImage {
        let Picture { warp, rgba, depth } = picture;
        let [source_rows, target_rows] = [warp.source_size[1], warp.target_size[1]];
        let (rgba, depth) = (flipped(rgba, source_rows), flipped(depth, source_rows));
        let drawn = self.gather.borrow_mut().run(&rgba, &depth, &warp.rows_from_top());
        SynthesizedImage {
            rgba: flipped(&drawn.rgba, target_rows),
            source_map: flipped(&drawn.source_map, target_rows),
        }
    }
}

/// Returns the rows in the opposite order.
pub fn flipped<T: Copy>(values: &[T], rows: u32) -> Vec<T> {
    values.chunks_exact(values.len() / rows as usize).rev().flatten().copied().collect()
}

/// Returns warps to poses of a moving head, in all depth ranges, with targets of other sizes than the source.
pub fn pose_warps() -> Vec<(PoseWarp, DepthRange)> {
    let ranges = ranges().into_iter().cycle();
    let of = |(motion, range)| {
        let source = eyes([97, 71], Eye::Left, range).view(Eye::Left);
        let target = View { size: [90, 75], ..posed::moved(&source, motion) };
        (PoseWarp::new(&source, &target).unwrap(), range)
    };
    posed::MOTIONS.into_iter().zip(ranges).map(of).collect()
}

/// Returns laws of motion for both eyes in all depth ranges, in which no term is zero. A picture's colours serve as vectors.
pub fn motion_warps() -> Vec<(MotionWarp, DepthRange)> {
    let of = |(i, range)| {
        let views = eyes([150, 41], Eye::BOTH[i % 2], range).synthesis_views(GuardBand::Pixels(13)).unwrap();
        let of = [VectorsOf::Source, VectorsOf::Eye][i / 2];
        let law = MotionMap { per_z: -0.2, per_depth: 0.1, constant: 0.15, of };
        (MotionWarp { warp: views.warp, law }, range)
    };
    ranges().into_iter().enumerate().map(of).collect()
}

impl Gl {
    /// Synthesizes any view on OpenGL ES, with its depth.
    pub fn any_view(&self, picture: &Picture<PoseWarp>) -> posed::Image {
        posed::run(self.headless.gl(), &picture.rgba, &picture.depth, &picture.warp, None)
    }

    /// Synthesizes motion vectors on OpenGL ES, with depth. Tiles contain the same rows as on other interfaces.
    pub fn motion(&self, picture: &Picture<MotionWarp>) -> posed::Image {
        let Picture { warp: MotionWarp { warp, law }, rgba, depth } = picture;
        let [source_rows, target_rows] = [warp.source_size[1], warp.target_size[1]];
        let (rgba, depth) = (flipped(rgba, source_rows), flipped(depth, source_rows));
        let warp = MotionWarp { warp: warp.rows_from_top(), law: *law };
        let drawn = posed::run(self.headless.gl(), &rgba, &depth, &warp, None);
        posed::Image { rgba: flipped(&drawn.rgba, target_rows), depth: flipped(&drawn.depth, target_rows) }
    }
}

/// Checks that all channels are nearly equal, except for a few pixels whose positions lie within rounding of a
/// decision.
pub fn assert_equal(got: &[u8], want: &[u8], channels: usize, what: &str) {
    assert_eq!(got.len(), want.len());
    let differs = |(a, b): (&[u8], &[u8])| a[..channels].iter().zip(b).any(|(a, b)| a.abs_diff(*b) > 1);
    let different = got.chunks_exact(4).zip(want.chunks_exact(4)).filter(|&pair| differs(pair)).count();
    assert!(different * 4000 <= got.len() / 4, "{what}: {different} of {} pixels differ", got.len() / 4);
}

/// Returns warps for both eyes, in all depth ranges, with targets that are higher, lower and larger than their sources.
pub fn warps() -> Vec<(Warp, DepthRange)> {
    let mut warps = Vec::new();
    for (i, range) in ranges().into_iter().enumerate() {
        let dominant = Eye::BOTH[i % 2];
        for eye in [dominant, dominant.other()] {
            let views =
                eyes([150, 41], eye, range).synthesis_views(GuardBand::Pixels(13 * i as u32)).unwrap();
            warps.push((views.warp, range));
        }
        let whole = warps[warps.len() - 1].0;
        let lower = Warp { target_size: [150, 30], row_offset: -7 - i as i32, ..whole };
        let higher = Warp { target_size: [150, 48], row_offset: 5, ..whole };
        warps.extend([(lower, range), (higher, range)]);
    }
    warps
}

/// The sizes, law and places of a synthesis. Margins surround the source and the target in their images.
#[derive(Debug)]
pub struct RandomCase {
    pub warp: Warp,
    pub source_margins: [[u32; 2]; 2],
    pub target_margins: [[u32; 2]; 2],
    pub source_layer: u32,
    pub target_layer: u32,
}

/// The depth range of [`random_cases`].
pub const RANDOM_RANGE: DepthRange =
    DepthRange { near: 0.4, far: 20.0, convention: DepthConvention::Reversed };

/// Returns random sizes, rectangles, eyes and laws of up to 96 x 70 pixels. The last two displace by 300 pixels, one of
/// them in a part of an image.
pub fn random_cases() -> Vec<RandomCase> {
    let warp = |source_size, target_size, row_offset, offset, scale: f64| Warp {
        source_size,
        target_size,
        law: DisparityMap { offset, scale },
        row_offset,
        // Nearer surfaces must move towards larger forward columns.
        target_eye: Eye::BOTH[usize::from(scale < 0.0)],
        convention: RANDOM_RANGE.convention,
    };
    let mut rng = rand_pcg::Pcg32::seed_from_u64(11);
    let small = (0..30).map(|_| {
        let mut pair = |to: [u32; 2], from: u32| to.map(|n| rng.random_range(from..=n));
        let (source, target) = (pair([96, 70], 1), pair([96, 70], 1));
        let [source_margins, target_margins] = [0, 1].map(|_| [pair([3, 3], 0), pair([3, 3], 0)]);
        let [source_layer, target_layer] = pair([1, 1], 0);
        let (offset, scale) = (rng.random_range(-40.0..40.0), rng.random_range(-30.0..30.0));
        let warp = warp(source, target, rng.random_range(-30..30), offset, scale);
        RandomCase { warp, source_margins, target_margins, source_layer, target_layer }
    });
    let wide = [(300.0, [[0, 0], [0, 0]]), (-300.0, [[7, 3], [5, 2]])];
    let wide = wide.map(|(scale, source_margins)| RandomCase {
        warp: warp([520, 24], [500, 24], 0, 0.0, scale),
        source_margins,
        target_margins: [[0; 2]; 2],
        source_layer: 0,
        target_layer: 0,
    });
    small.chain(wide).collect()
}

/// Returns colour and depth as textures, and a target of the colour's format.
fn gl_images(gl: &Rc<Context>, picture: &Picture, format: gl::Format) -> ([Texture; 2], RenderTarget) {
    let Picture { warp, rgba, depth } = picture;
    let color = Texture::new(gl, warp.source_size, format, Filter::Linear).unwrap();
    color.upload(rgba);
    let map = Texture::new(gl, warp.source_size, gl::Format::R32F, Filter::Nearest).unwrap();
    map.upload(&depth.iter().flat_map(|value| value.to_ne_bytes()).collect::<Vec<_>>());
    let target = RenderTarget::new(gl, warp.target_size, &[(format, Filter::Nearest)], None).unwrap();
    ([color, map], target)
}

pub fn gl_srgb(gl: &Rc<Context>, picture: &Picture) -> Vec<u8> {
    let ([color, depth], target) = gl_images(gl, picture, gl::Format::Srgb8Alpha8);
    let outputs = Outputs { srgb: true, ..Outputs::default() };
    let mut gather = opengl::Gather::new(gl, &Options::default(), outputs).unwrap();
    let source = opengl::Source::new(color.raw(), depth.raw());
    gather.synthesize(source, &picture.warp, &Destination::whole(&target)).unwrap();
    target.read_rgba8(0, [0, 0], picture.warp.target_size)
}
