//! The laws that every pipeline keeps, on every available GL backend, and pictures to test them with.
//!
//! [`laws!`](crate::laws!) makes a test of each. yoro's pipeline and the paper's in `yoro-render` share this file.

use std::fmt;
use std::rc::Rc;

use rand::{Rng, SeedableRng};

use crate::in_memory::{InMemory, Synthesize};
use yoro::eyes::{DepthConvention, DepthRange, DisparityMap, Eye, EyePair, Frustum, GuardBand, Pose, Warp};
use yoro::synthesis::SOURCE_MAP_HOLE;
use yoro_context::{Backend, Headless};
use yoro_gl::{Capabilities, Context};

/// A function that makes a pipeline.
type Make = Box<dyn Fn(&Rc<Context>) -> Synthesize>;

/// A pipeline under test, with its name.
pub struct Subject {
    pub name: String,
    /// Makes the pipeline with the outputs that [`InMemory`] needs.
    pub make: Make,
}

impl Subject {
    pub fn in_memory(&self, gl: &Rc<Context>) -> InMemory {
        InMemory::new(gl, (self.make)(gl))
    }
}

impl fmt::Debug for Subject {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(&self.name)
    }
}

/// Defines a test of each law, for the subjects that an expression returns.
#[macro_export]
macro_rules! laws {
    ($subjects:expr) => {
        $crate::laws! { $subjects;
            ipd_zero_is_the_identity
            a_plane_shifts_by_its_disparity
            dominant_left_is_the_mirror_of_dominant_right
            a_repeated_run_is_bit_identical
            a_hole_takes_nothing_nearer_than_its_background
            one_pixel_and_odd_sizes_work
            depth_that_is_no_number_ends
        }
    };
    ($subjects:expr; $($law:ident)*) => {$(
        #[test]
        fn $law() {
            $crate::laws::$law(&$subjects);
        }
    )*};
}

/// Returns EGL, and OSMesa where it is: Mesa 25.1 removed it.
pub fn backends() -> &'static [Backend] {
    // `cargo xtask test` sets this on systems without OSMesa.
    let without_osmesa = std::env::var_os("YORO_TEST_WITHOUT_OSMESA").is_some();
    if without_osmesa { &[Backend::Egl] } else { &[Backend::Egl, Backend::Osmesa] }
}

/// Runs a test body on every backend.
pub fn on_every_backend(body: impl Fn(&Rc<Context>)) {
    for &backend in backends() {
        let headless = Headless::open(backend).expect("EGL and OSMesa are set up by `cargo xtask setup`");
        body(headless.gl());
        assert_eq!(headless.gl().take_errors(), None, "{backend:?}");
        assert_eq!(headless.gl().object_count(), 0, "{backend:?} leaks GL objects");
    }
}

/// Runs a test body for each pipeline on EGL and on OSMesa.
fn for_each(subjects: &[Subject], body: impl Fn(&Rc<Context>, &Subject)) {
    on_every_backend(|gl| subjects.iter().for_each(|subject| body(gl, subject)));
}

/// Opens EGL as a driver that has only OpenGL ES 3.0.
pub fn open_es_300() -> Headless {
    Headless::open_limited(Backend::Egl, Capabilities::limit_to_es_300)
        .expect("EGL is set up by `cargo xtask setup`")
}

pub fn pair(size: [u32; 2], dominant: Eye, ipd: f32, convention: DepthConvention) -> EyePair {
    let depth = DepthRange { near: 0.3, far: 100.0, convention };
    let frustum = Frustum::symmetric(1.2, size[0] as f32 / size[1] as f32);
    EyePair::parallel(Pose::IDENTITY, frustum, ipd, depth, size, dominant)
}

/// Returns a colour picture in which every pixel differs from its neighbours, and the depth of a slanted background,
/// boxes at several distances and one-pixel wires, in metres.
pub fn scene(size: [u32; 2], range: DepthRange, seed: u64) -> (Vec<u8>, Vec<f32>) {
    let [w, h] = size.map(|n| n as usize);
    let mut rng = rand_pcg::Pcg32::seed_from_u64(seed);
    let mut z: Vec<f32> =
        (0..w * h).map(|i| 4.0 + 3.0 * (i % w) as f32 / w as f32 + 0.01 * (i / w) as f32).collect();
    for _ in 0..12 {
        let (x, y) = (rng.random_range(0..w), rng.random_range(0..h));
        let (bw, bh) = if rng.random_bool(0.4) {
            (1, h)
        } else {
            (rng.random_range(2..w / 3), rng.random_range(2..h / 2))
        };
        let (near, slope) = (rng.random_range(0.5..3.0f32), rng.random_range(-0.01..0.01f32));
        for j in y..(y + bh).min(h) {
            for i in x..(x + bw).min(w) {
                z[j * w + i] = z[j * w + i].min(near + slope * (i - x) as f32);
            }
        }
    }
    let rgba = (0..w * h * 4).map(|_| rng.random()).collect();
    (rgba, z.into_iter().map(|z| range.depth(z)).collect())
}

pub fn row<T>(image: &[T], y: usize, width: usize) -> &[T] {
    &image[y * width..][..width]
}

/// Returns the displaced positions of one source row in forward columns.
pub fn positions(depth_row: &[f32], warp: &Warp) -> Vec<f64> {
    let columns = depth_row.len();
    // For the right eye, columns are counted from the right in source and target.
    let mirrored = warp.target_eye == Eye::Right;
    (0..columns)
        .map(|x| {
            let column = if mirrored { columns - 1 - x } else { x };
            let target = column as f64 + warp.law.offset + warp.law.scale * depth_row[column] as f64;
            if mirrored { f64::from(warp.target_size[0]) - 1.0 - target } else { target }
        })
        .collect()
}

pub fn ipd_zero_is_the_identity(subjects: &[Subject]) {
    for_each(subjects, |gl, subject| {
        for dominant in Eye::BOTH {
            let p = pair([96, 33], dominant, 0.0, DepthConvention::Standard);
            let warp = p.synthesis_views(GuardBand::Pixels(5)).unwrap();
            let (rgba, depth) = scene(warp.warp.source_size, p.depth, 9);
            let result = subject.in_memory(gl).run(&rgba, &depth, &warp.warp);
            for y in 0..33 {
                let crop = warp.dominant_crop[0] as usize * 4;
                let source = &row(&rgba, y, 101 * 4)[crop..][..96 * 4];
                assert_eq!(row(&result.rgba, y, 96 * 4), source, "{subject:?} {dominant:?} row {y}");
            }
        }
    });
}

pub fn a_plane_shifts_by_its_disparity(subjects: &[Subject]) {
    for_each(subjects, |gl, subject| {
        for dominant in Eye::BOTH {
            // The depth at which f_px * IPD / z is exactly 7 pixels.
            let p = pair([128, 16], dominant, 0.063, DepthConvention::Reversed);
            let z = p.focal_length_pixels() * 0.063 / 7.0;
            let warp = p.synthesis_views(GuardBand::None).unwrap().warp;
            let (rgba, _) = scene(warp.source_size, p.depth, 10);
            let depth = vec![p.depth.depth(z); 128 * 16];
            let result = subject.in_memory(gl).run(&rgba, &depth, &warp);
            let shift: i32 = if dominant == Eye::Right { 7 } else { -7 };
            for y in 0..16 {
                for x in 8..120i32 {
                    let (got, want) = ((y * 128 + x) as usize * 4, (y * 128 + x - shift) as usize * 4);
                    for c in 0..4 {
                        // A thousandth of a pixel may remain.
                        assert!(
                            result.rgba[got + c].abs_diff(rgba[want + c]) <= 1,
                            "{subject:?} {dominant:?} ({x}, {y})"
                        );
                    }
                }
            }
        }
    });
}

pub fn dominant_left_is_the_mirror_of_dominant_right(subjects: &[Subject]) {
    for_each(subjects, |gl, subject| {
        let [w, h] = [130usize, 24];
        let right = pair([w as u32, h as u32], Eye::Right, 0.063, DepthConvention::Standard);
        let left = EyePair { dominant: Eye::Left, ..right };
        let (rgba, depth) = scene(right.size, right.depth, 11);
        let flip = |bytes: &[u8]| -> Vec<u8> {
            bytes.chunks_exact(w * 4).flat_map(|r| r.chunks_exact(4).rev().flatten().copied()).collect()
        };
        let depth_flipped: Vec<f32> = depth.chunks_exact(w).flat_map(|r| r.iter().rev().copied()).collect();
        let mut pipeline = subject.in_memory(gl);
        let warp = |p: EyePair| p.synthesis_views(GuardBand::None).unwrap().warp;
        let a = pipeline.run(&rgba, &depth, &warp(right));
        let b = pipeline.run(&flip(&rgba), &depth_flipped, &warp(left));
        let different = a.rgba.iter().zip(&flip(&b.rgba)).filter(|(a, b)| a.abs_diff(**b) > 1).count();
        assert!(different * 1000 <= a.rgba.len(), "{subject:?}: {different} of {}", a.rgba.len());
    });
}

pub fn a_repeated_run_is_bit_identical(subjects: &[Subject]) {
    for_each(subjects, |gl, subject| {
        let p = pair([200, 50], Eye::Right, 0.07, DepthConvention::Standard);
        let warp = p.synthesis_views(GuardBand::None).unwrap().warp;
        let (rgba, depth) = scene(p.size, p.depth, 12);
        let first = subject.in_memory(gl).run(&rgba, &depth, &warp);
        let mut again = subject.in_memory(gl);
        // Earlier contents of the buffers must not show through.
        let (other, other_depth) = scene(p.size, p.depth, 13);
        again.run(&other, &other_depth, &warp);
        assert_eq!(again.run(&rgba, &depth, &warp), first, "{subject:?}");
    });
}

/// A near red square in front of a far blue wall: every pixel of the other eye is red, blue or between, and what is
/// uncovered beside the square is blue.
pub fn a_hole_takes_nothing_nearer_than_its_background(subjects: &[Subject]) {
    for_each(subjects, |gl, subject| {
        for dominant in Eye::BOTH {
            let [w, h] = [160usize, 40];
            let p = pair([w as u32, h as u32], dominant, 0.063, DepthConvention::Standard);
            let warp = p.synthesis_views(GuardBand::None).unwrap().warp;
            let square = |i: usize| (60..100).contains(&(i % w)) && (10..30).contains(&(i / w));
            let depth: Vec<f32> =
                (0..w * h).map(|i| p.depth.depth(if square(i) { 0.6 } else { 8.0 })).collect();
            let rgba: Vec<u8> = (0..w * h)
                .flat_map(|i| if square(i) { [255, 0, 0, 255] } else { [0, 0, 255, 255] })
                .collect();
            let result = subject.in_memory(gl).run(&rgba, &depth, &warp);
            let mut holes = 0;
            for (i, entry) in result.source_map.iter().enumerate() {
                let color = &result.rgba[i * 4..][..4];
                assert_eq!(color[1], 0);
                assert_eq!(color[3], 255, "{subject:?}: no pixel is left unfilled");
                if entry & SOURCE_MAP_HOLE != 0 {
                    holes += 1;
                    assert_eq!(color, [0, 0, 255, 255], "{subject:?} {dominant:?} ({}, {})", i % w, i / w);
                }
            }
            let uncovered = p.focal_length_pixels() * 0.063 * (1.0 / 0.6 - 1.0 / 8.0);
            assert!(holes as f32 >= 20.0 * (uncovered - 1.0), "{subject:?}: {holes} hole pixels");
        }
    });
}

/// Not for pipelines that move whole source columns, which would be rounded differently in the two views.
pub fn asymmetric_frusta_agree_with_the_symmetric_view(subjects: &[Subject]) {
    // The same eyes, once with a common wide frustum and once with mirrored asymmetric ones whose edges lie on the same
    // pixel grid: where both see, the pictures are equal.
    for_each(subjects, |gl, subject| {
        let d = 0.01f32;
        let wide = Frustum { left: -0.8, right: 0.8, bottom: -0.2, top: 0.2 };
        let mut p = pair([160, 40], Eye::Right, 0.063, DepthConvention::Standard);
        p.frusta = [wide; 2];
        let mut q = p;
        q.size = [140, 40];
        q.frusta = [Frustum { right: 0.8 - 20.0 * d, ..wide }, Frustum { left: -0.8 + 20.0 * d, ..wide }];
        let (wp, wq) =
            (p.synthesis_views(GuardBand::None).unwrap(), q.synthesis_views(GuardBand::None).unwrap());
        assert_eq!(wq.warp.source_size, [160, 40], "the union");
        assert_eq!(wq.dominant_crop, [20, 0]);
        let (rgba, depth) = scene(wp.warp.source_size, p.depth, 14);
        let mut pipeline = subject.in_memory(gl);
        let a = pipeline.run(&rgba, &depth, &wp.warp);
        let b = pipeline.run(&rgba, &depth, &wq.warp);
        let mut different = 0;
        for y in 0..40 {
            let (ra, rb) = (row(&a.rgba, y, 160 * 4), row(&b.rgba, y, 140 * 4));
            different += ra.iter().zip(rb).filter(|(a, b)| a.abs_diff(**b) > 1).count();
        }
        assert!(different * 1000 <= b.rgba.len(), "{subject:?}: {different}");
    });
}

pub fn one_pixel_and_odd_sizes_work(subjects: &[Subject]) {
    for_each(subjects, |gl, subject| {
        let mut pipeline = subject.in_memory(gl);
        for size in [[1, 1], [3, 1], [1, 9], [17, 9], [1030, 2]] {
            let warp = Warp {
                source_size: size,
                target_size: size,
                law: DisparityMap { offset: 0.0, scale: 5.0 },
                row_offset: 0,
                target_eye: Eye::Left,
                convention: DepthConvention::Reversed,
            };
            let count = (size[0] * size[1]) as usize;
            let rgba = vec![77u8; count * 4];
            let depth: Vec<f32> = (0..count).map(|i| (i % 5) as f32 / 4.0).collect();
            let result = pipeline.run(&rgba, &depth, &warp);
            assert!(result.rgba.iter().all(|&v| v == 77), "{subject:?} {size:?}");
        }
    });
}

/// With infinite or NaN depth, as divisions by zero give, the search terminates, and rows away from the damaged one do
/// not change.
pub fn depth_that_is_no_number_ends(subjects: &[Subject]) {
    for_each(subjects, |gl, subject| {
        for convention in [DepthConvention::Standard, DepthConvention::Reversed] {
            let p = pair([96, 24], Eye::Right, 0.063, convention);
            let warp = p.synthesis_views(GuardBand::None).unwrap().warp;
            let (rgba, whole) = scene(p.size, p.depth, 15);
            let mut pipeline = subject.in_memory(gl);
            let want = pipeline.run(&rgba, &whole, &warp);
            for value in [f32::INFINITY, f32::NEG_INFINITY, f32::NAN] {
                let mut depth = whole.clone();
                depth[8 * 96..16 * 96].iter_mut().skip(1).step_by(3).for_each(|d| *d = value);
                depth[12 * 96..13 * 96].fill(value);
                let got = pipeline.run(&rgba, &depth, &warp);
                // Fills reach as many rows as the hole's background is pixels away, at most twelve (`fill_hole`).
                // Here no surface moves by more than six pixels.
                assert_eq!(row(&got.rgba, 0, 96 * 4), row(&want.rgba, 0, 96 * 4), "{subject:?} {value}");
                assert_eq!(row(&got.rgba, 23, 96 * 4), row(&want.rgba, 23, 96 * 4), "{subject:?} {value}");
            }
        }
    });
}
