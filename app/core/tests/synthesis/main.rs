//! The pipelines against the f64 references, and the laws that they must keep, on every GL backend here.

mod reference;
mod state;

use std::rc::Rc;

use rand::{Rng, SeedableRng};

use reference::{Entry, ImBufferEntry};
use yoro::eyes::{DepthConvention, DepthRange, DisparityLaw, Eye, EyePair, Frustum, GuardBand, Pose, Warp};
use yoro::gl::Context;
use yoro::synthesis::*;
use yoro_context::{Backend, Headless};

/// Runs a test body on EGL and on OSMesa.
fn on_every_backend(body: impl Fn(&Rc<Context>)) {
    // `cargo xtask test` says so on systems that have no OSMesa any more.
    let without_osmesa = std::env::var_os("YORO_TEST_WITHOUT_OSMESA").is_some();
    for backend in [Backend::Egl, Backend::Osmesa] {
        if backend == Backend::Osmesa && without_osmesa {
            continue;
        }
        let headless = Headless::open(backend).expect("EGL and OSMesa are set up by `cargo xtask setup`");
        body(headless.gl());
        assert_eq!(headless.gl().take_errors(), None, "{backend:?}");
        assert_eq!(headless.gl().object_count(), 0, "{backend:?} leaks GL objects");
    }
}

fn options(pipeline: Pipeline) -> SynthesisOptions {
    SynthesisOptions { pipeline, ..Default::default() }
}

/// A way to synthesize; drivers choose among the variants of the gather pipeline, tests do not.
#[derive(Clone, Copy, Debug)]
enum Subject {
    Gather(GatherVariant),
    Of(SynthesisOptions),
}

impl Subject {
    fn offline(self, gl: &Rc<Context>) -> Offline {
        match self {
            Subject::Gather(variant) => {
                let gather = Gather::with_variant(gl, Offline::OUTPUTS, variant).unwrap();
                Offline::with_pipeline(gl, Box::new(gather)).unwrap()
            }
            Subject::Of(options) => Offline::new(gl, &options).unwrap(),
        }
    }
}

fn every_subject() -> Vec<Subject> {
    let strict = PaperOptions { strict: true, linear_interpolation: false, ..Default::default() };
    let strict = SynthesisOptions { paper: strict, ..options(Pipeline::Paper) };
    let others = [options(Pipeline::Paper), strict].map(Subject::Of);
    GatherVariant::ALL.map(Subject::Gather).into_iter().chain(others).collect()
}

fn pair(size: [u32; 2], dominant: Eye, ipd: f32, convention: DepthConvention) -> EyePair {
    let depth = DepthRange { near: 0.3, far: 100.0, convention };
    let frustum = Frustum::symmetric(1.2, size[0] as f32 / size[1] as f32);
    EyePair::parallel(Pose::IDENTITY, frustum, ipd, depth, size, dominant)
}

/// A slanted background, boxes at several distances and one-pixel wires, in metres; and a colour picture in
/// which every pixel is different from its neighbours.
fn scene(size: [u32; 2], range: DepthRange, seed: u64) -> (Vec<u8>, Vec<f32>) {
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

fn row<T>(image: &[T], y: usize, width: usize) -> &[T] {
    &image[y * width..][..width]
}

/// Linear fetch of a row at a fractional forward column, in f64.
fn fetch(rgba: &[u8], source: f64, mirrored: bool) -> [f64; 4] {
    let last = (rgba.len() / 4 - 1) as f64;
    let column = if mirrored { last - source } else { source }.clamp(0.0, last);
    let (x, t) = (column.floor() as usize, column.fract());
    std::array::from_fn(|c| {
        let at = |x: usize| rgba[x.min(last as usize) * 4 + c] as f64;
        at(x) * (1.0 - t) + at(x + 1) * t
    })
}

type Reference = fn(&[f64], usize) -> Vec<Entry>;

fn agrees_with_reference(gl: &Rc<Context>, subject: Subject, reference: Reference) {
    for (seed, dominant, convention, guard) in [
        (1, Eye::Right, DepthConvention::Standard, GuardBand::None),
        (2, Eye::Left, DepthConvention::Standard, GuardBand::Pixels(21)),
        (3, Eye::Right, DepthConvention::Reversed, GuardBand::Distance(0.5)),
        (4, Eye::Left, DepthConvention::Reversed, GuardBand::None),
    ] {
        let p = pair([150, 40], dominant, 0.063, convention);
        let warp = p.synthesis(guard).unwrap().warp;
        let (rgba, depth) = scene(warp.source_size, p.depth, seed);
        let result = subject.offline(gl).run(&rgba, &depth, &warp).unwrap();
        is_its_reference(&result, reference, &rgba, &depth, &warp, &format!("{subject:?}, case {seed}"));
    }
}

fn is_its_reference(
    result: &SynthesizedImage,
    reference: Reference,
    rgba: &[u8],
    depth: &[f32],
    warp: &Warp,
    what: &str,
) {
    let (ws, wt) = (warp.source_size[0] as usize, warp.target_size[0] as usize);
    let mirrored = warp.target_eye == Eye::Right;
    let mut different = 0;
    for y in 0..warp.target_size[1] as usize {
        let entries = reference(&reference::positions(row(depth, y, ws), warp), wt);
        let source_row = row(rgba, y, ws * 4);
        for (t, entry) in entries.iter().enumerate() {
            let x = if mirrored { wt - 1 - t } else { t };
            let got = result.source_map[y * wt + x];
            let hole = got & SOURCE_MAP_HOLE != 0;
            let source = (got & !SOURCE_MAP_HOLE) as f64 / SOURCE_MAP_FIXED as f64;
            // Positions within rounding of a decision (a pixel centre exactly on an edge) may go either way.
            if hole != entry.hole || (source - entry.source).abs() > 2e-3 {
                different += 1;
                continue;
            }
            if !hole && entry.rim.is_none() {
                let color = fetch(source_row, source, mirrored);
                for (value, want) in result.rgba[(y * wt + x) * 4..].iter().zip(color) {
                    let error = (*value as f64 - want).abs();
                    assert!(error <= 1.6, "{what} ({x}, {y}): {value} for {want}");
                }
            }
        }
    }
    let total = result.source_map.len();
    assert!(different * 1000 <= total, "{what}: {different} of {total} pixels differ");
}

/// Half a red pixel before blue: where a silhouette covers a share of a pixel, the colour is that mixture.
#[test]
fn gather_blends_silhouettes_by_coverage() {
    on_every_backend(|gl| {
        for variant in GatherVariant::ALL {
            blends_silhouettes_by_coverage(gl, Subject::Gather(variant));
        }
    });
}

fn blends_silhouettes_by_coverage(gl: &Rc<Context>, subject: Subject) {
    let [w, h] = [64u32, 9];
    let mut seen = 0;
    for tenth in 0..10 {
        // Displacement of the square: 4 pixels and some tenths; of the background: none.
        let scale = 4.0 + tenth as f64 / 10.0;
        let warp = Warp {
            source_size: [w, h],
            target_size: [w, h],
            law: DisparityLaw { offset: 0.0, scale },
            row_offset: 0,
            target_eye: Eye::Left,
            convention: DepthConvention::Reversed,
        };
        let square = |i: u32| (20..40).contains(&(i % w));
        let depth: Vec<f32> = (0..w * h).map(|i| if square(i) { 1.0 } else { 0.0 }).collect();
        let rgba: Vec<u8> =
            (0..w * h).flat_map(|i| if square(i) { [255, 0, 0, 255] } else { [0, 0, 255, 255] }).collect();
        let result = subject.offline(gl).run(&rgba, &depth, &warp).unwrap();
        for x in 0..w {
            // The first and the last red sample lie at these places; coverage falls to nothing within a pixel.
            let (first, last) = (20.0 + scale, 39.0 + scale);
            let x_f = x as f64;
            let covered = (1.0 - (first - x_f).max(0.0)).min(1.0 - (x_f - last).max(0.0)).clamp(0.0, 1.0);
            let got = &result.rgba[((4 * w + x) * 4) as usize..][..3];
            let want = [covered * 255.0, 0.0, (1.0 - covered) * 255.0];
            seen += (covered > 0.0 && covered < 1.0) as usize;
            for c in 0..3 {
                assert!(
                    (got[c] as f64 - want[c]).abs() < 1.6,
                    "{subject:?}, scale {scale}, column {x}: {got:?} for {want:?}"
                );
            }
        }
    }
    assert!(seen >= 18, "{seen} partly covered pixels");
}

#[test]
fn gather_is_its_reference() {
    on_every_backend(|gl| {
        for variant in GatherVariant::ALL {
            agrees_with_reference(gl, Subject::Gather(variant), reference::gather_row);
        }
    });
}

#[test]
fn paper_is_its_reference() {
    on_every_backend(|gl| {
        for (seed, dominant, strict) in
            [(5, Eye::Right, true), (6, Eye::Left, true), (7, Eye::Right, false), (8, Eye::Left, false)]
        {
            let p = pair([150, 40], dominant, 0.063, DepthConvention::Standard);
            let warp = p.synthesis(GuardBand::Pixels(9)).unwrap().warp;
            let (rgba, depth) = scene(warp.source_size, p.depth, seed);
            let paper = PaperOptions { strict, linear_interpolation: false, ..Default::default() };
            let options = SynthesisOptions { paper, ..options(Pipeline::Paper) };
            let result = Offline::new(gl, &options).unwrap().run(&rgba, &depth, &warp).unwrap();
            let (ws, wt) = (warp.source_size[0] as usize, warp.target_size[0] as usize);
            let mut different = 0;
            for y in 0..warp.target_size[1] as usize {
                let entries =
                    reference::paper_row(&reference::positions(row(&depth, y, ws), &warp), wt, strict);
                for (t, entry) in entries.iter().enumerate() {
                    let x = if warp.target_eye == Eye::Right { wt - 1 - t } else { t };
                    let got = result.source_map[y * wt + x];
                    let hole = got & SOURCE_MAP_HOLE != 0;
                    let source = (got & !SOURCE_MAP_HOLE) as f64 / SOURCE_MAP_FIXED as f64;
                    let same = match entry {
                        ImBufferEntry::Valid(s) => !hole && (s - source).abs() < 2e-3,
                        ImBufferEntry::Disocclusion { left, .. } => {
                            let edge = entries.get(*left as usize);
                            hole && edge.is_none_or(
                                |e| matches!(e, ImBufferEntry::Valid(s) if (s - source).abs() < 2e-3),
                            )
                        }
                    };
                    different += !same as usize;
                }
            }
            let total = result.source_map.len();
            assert!(different * 1000 <= total, "strict {strict}: {different} of {total} pixels differ");
        }
    });
}

#[test]
fn ipd_zero_is_the_identity() {
    on_every_backend(|gl| {
        for subject in every_subject() {
            for dominant in Eye::BOTH {
                let p = pair([96, 33], dominant, 0.0, DepthConvention::Standard);
                let warp = p.synthesis(GuardBand::Pixels(5)).unwrap();
                let (rgba, depth) = scene(warp.warp.source_size, p.depth, 9);
                let result = subject.offline(gl).run(&rgba, &depth, &warp.warp).unwrap();
                for y in 0..33 {
                    let crop = warp.dominant_crop[0] as usize * 4;
                    let source = &row(&rgba, y, 101 * 4)[crop..][..96 * 4];
                    assert_eq!(row(&result.rgba, y, 96 * 4), source, "{subject:?} {dominant:?} row {y}");
                }
            }
        }
    });
}

#[test]
fn a_plane_shifts_by_its_disparity() {
    on_every_backend(|gl| {
        for subject in every_subject() {
            for dominant in Eye::BOTH {
                // Depth such that f_px * IPD / z is 7 pixels exactly.
                let p = pair([128, 16], dominant, 0.063, DepthConvention::Reversed);
                let z = p.focal_length_pixels() * 0.063 / 7.0;
                let warp = p.synthesis(GuardBand::None).unwrap().warp;
                let (rgba, _) = scene(warp.source_size, p.depth, 10);
                let depth = vec![p.depth.depth(z); 128 * 16];
                let result = subject.offline(gl).run(&rgba, &depth, &warp).unwrap();
                let shift: i32 = if dominant == Eye::Right { 7 } else { -7 };
                for y in 0..16 {
                    for x in 8..120i32 {
                        let (got, want) = ((y * 128 + x) as usize * 4, (y * 128 + x - shift) as usize * 4);
                        for c in 0..4 {
                            // A thousandth of a pixel may be left of the fraction.
                            assert!(
                                result.rgba[got + c].abs_diff(rgba[want + c]) <= 1,
                                "{subject:?} {dominant:?} ({x}, {y})"
                            );
                        }
                    }
                }
            }
        }
    });
}

#[test]
fn dominant_left_is_the_mirror_of_dominant_right() {
    on_every_backend(|gl| {
        for subject in every_subject() {
            let [w, h] = [130usize, 24];
            let right = pair([w as u32, h as u32], Eye::Right, 0.063, DepthConvention::Standard);
            let left = EyePair { dominant: Eye::Left, ..right };
            let (rgba, depth) = scene(right.size, right.depth, 11);
            let flip = |bytes: &[u8]| -> Vec<u8> {
                bytes.chunks_exact(w * 4).flat_map(|r| r.chunks_exact(4).rev().flatten().copied()).collect()
            };
            let depth_flipped: Vec<f32> =
                depth.chunks_exact(w).flat_map(|r| r.iter().rev().copied()).collect();
            let mut offline = subject.offline(gl);
            let warp = |p: EyePair| p.synthesis(GuardBand::None).unwrap().warp;
            let a = offline.run(&rgba, &depth, &warp(right)).unwrap();
            let b = offline.run(&flip(&rgba), &depth_flipped, &warp(left)).unwrap();
            let different = a.rgba.iter().zip(&flip(&b.rgba)).filter(|(a, b)| a.abs_diff(**b) > 1).count();
            assert!(different * 1000 <= a.rgba.len(), "{subject:?}: {different} of {}", a.rgba.len());
        }
    });
}

#[test]
fn a_repeated_run_is_bit_identical() {
    on_every_backend(|gl| {
        for subject in every_subject() {
            let p = pair([200, 50], Eye::Right, 0.07, DepthConvention::Standard);
            let warp = p.synthesis(GuardBand::None).unwrap().warp;
            let (rgba, depth) = scene(p.size, p.depth, 12);
            let first = subject.offline(gl).run(&rgba, &depth, &warp).unwrap();
            let mut again = subject.offline(gl);
            // Buffers that hold another picture must not show through.
            let (other, other_depth) = scene(p.size, p.depth, 13);
            again.run(&other, &other_depth, &warp).unwrap();
            assert_eq!(again.run(&rgba, &depth, &warp).unwrap(), first, "{subject:?}");
        }
    });
}

/// A near red square before a far blue wall: every pixel of the other eye is red or blue or between, and what is
/// uncovered beside the square is blue.
#[test]
fn a_hole_takes_nothing_nearer_than_its_background() {
    on_every_backend(|gl| {
        for subject in every_subject() {
            for dominant in Eye::BOTH {
                let [w, h] = [160usize, 40];
                let p = pair([w as u32, h as u32], dominant, 0.063, DepthConvention::Standard);
                let warp = p.synthesis(GuardBand::None).unwrap().warp;
                let square = |i: usize| (60..100).contains(&(i % w)) && (10..30).contains(&(i / w));
                let depth: Vec<f32> =
                    (0..w * h).map(|i| p.depth.depth(if square(i) { 0.6 } else { 8.0 })).collect();
                let rgba: Vec<u8> = (0..w * h)
                    .flat_map(|i| if square(i) { [255, 0, 0, 255] } else { [0, 0, 255, 255] })
                    .collect();
                let result = subject.offline(gl).run(&rgba, &depth, &warp).unwrap();
                let mut holes = 0;
                for (i, entry) in result.source_map.iter().enumerate() {
                    let color = &result.rgba[i * 4..][..4];
                    assert_eq!(color[1], 0);
                    assert_eq!(color[3], 255, "{subject:?}: no pixel is left unfilled");
                    if entry & SOURCE_MAP_HOLE != 0 {
                        holes += 1;
                        assert_eq!(
                            color,
                            [0, 0, 255, 255],
                            "{subject:?} {dominant:?} ({}, {})",
                            i % w,
                            i / w
                        );
                    }
                }
                let uncovered = p.focal_length_pixels() * 0.063 * (1.0 / 0.6 - 1.0 / 8.0);
                assert!(holes as f32 >= 20.0 * (uncovered - 1.0), "{subject:?}: {holes} hole pixels");
            }
        }
    });
}

#[test]
fn imbuffer_scales_cover_every_pixel_and_keep_a_plane() {
    on_every_backend(|gl| {
        let [w, h] = [130u32, 37];
        for imbuffer in
            [2, 4, 8, 16].map(ImBufferSize::Divisor).into_iter().chain([ImBufferSize::Fixed([50, 20])])
        {
            for linear_interpolation in [false, true] {
                let paper = PaperOptions { imbuffer, linear_interpolation, ..Default::default() };
                let options = SynthesisOptions { paper, ..options(Pipeline::Paper) };
                let p = pair([w, h], Eye::Right, 0.063, DepthConvention::Standard);
                let warp = p.synthesis(GuardBand::None).unwrap().warp;
                let z = p.focal_length_pixels() * 0.063 / 6.0;
                let rgba: Vec<u8> = (0..w * h).flat_map(|i| [(i % w) as u8, 128, 7, 255]).collect();
                let depth = vec![p.depth.depth(z); (w * h) as usize];
                let result = Offline::new(gl, &options).unwrap().run(&rgba, &depth, &warp).unwrap();
                for y in 0..h {
                    // The border is a hole, whose cells are as wide as the ImBuffer's pixels.
                    for x in 32..w {
                        let got = result.rgba[((y * w + x) * 4) as usize];
                        assert!(got.abs_diff((x - 6) as u8) <= 1, "{options:?} ({x}, {y}): {got}");
                    }
                }
            }
        }
    });
}

#[test]
fn asymmetric_frusta_agree_with_the_symmetric_view() {
    // The same eyes, once with a common wide frustum and once with mirrored asymmetric ones whose edges lie on the
    // same pixel grid: where both see, the pictures are equal.
    on_every_backend(|gl| {
        for pipeline in Pipeline::ALL {
            let d = 0.01f32;
            let wide = Frustum { left: -0.8, right: 0.8, bottom: -0.2, top: 0.2 };
            let mut p = pair([160, 40], Eye::Right, 0.063, DepthConvention::Standard);
            p.frusta = [wide; 2];
            let mut q = p;
            q.size = [140, 40];
            q.frusta = [Frustum { right: 0.8 - 20.0 * d, ..wide }, Frustum { left: -0.8 + 20.0 * d, ..wide }];
            let (wp, wq) = (p.synthesis(GuardBand::None).unwrap(), q.synthesis(GuardBand::None).unwrap());
            assert_eq!(wq.warp.source_size, [160, 40], "the union");
            assert_eq!(wq.dominant_crop, [20, 0]);
            let (rgba, depth) = scene(wp.warp.source_size, p.depth, 14);
            let mut offline = Offline::new(gl, &options(pipeline)).unwrap();
            let a = offline.run(&rgba, &depth, &wp.warp).unwrap();
            let b = offline.run(&rgba, &depth, &wq.warp).unwrap();
            let mut different = 0;
            for y in 0..40 {
                let (ra, rb) = (row(&a.rgba, y, 160 * 4), row(&b.rgba, y, 140 * 4));
                different += ra.iter().zip(rb).filter(|(a, b)| a.abs_diff(**b) > 1).count();
            }
            assert!(different * 1000 <= b.rgba.len(), "{pipeline:?}: {different}");
        }
    });
}

#[test]
fn one_pixel_and_odd_sizes_work() {
    on_every_backend(|gl| {
        for subject in every_subject() {
            let mut offline = subject.offline(gl);
            for size in [[1, 1], [3, 1], [1, 9], [17, 9], [1030, 2]] {
                let warp = Warp {
                    source_size: size,
                    target_size: size,
                    law: DisparityLaw { offset: 0.0, scale: 5.0 },
                    row_offset: 0,
                    target_eye: Eye::Left,
                    convention: DepthConvention::Reversed,
                };
                let count = (size[0] * size[1]) as usize;
                let rgba = vec![77u8; count * 4];
                let depth: Vec<f32> = (0..count).map(|i| (i % 5) as f32 / 4.0).collect();
                let result = offline.run(&rgba, &depth, &warp).unwrap();
                assert!(result.rgba.iter().all(|&v| v == 77), "{subject:?} {size:?}");
            }
        }
    });
}

/// Depth that is infinite or no number at all, as divisions by zero leave it: the search ends, and rows beside the
/// damaged one are what they were.
#[test]
fn depth_that_is_no_number_ends() {
    on_every_backend(|gl| {
        for subject in every_subject() {
            for convention in [DepthConvention::Standard, DepthConvention::Reversed] {
                let p = pair([96, 24], Eye::Right, 0.063, convention);
                let warp = p.synthesis(GuardBand::None).unwrap().warp;
                let (rgba, whole) = scene(p.size, p.depth, 15);
                let mut offline = subject.offline(gl);
                let want = offline.run(&rgba, &whole, &warp).unwrap();
                for value in [f32::INFINITY, f32::NEG_INFINITY, f32::NAN] {
                    let mut depth = whole.clone();
                    depth[8 * 96..16 * 96].iter_mut().skip(1).step_by(3).for_each(|d| *d = value);
                    depth[12 * 96..13 * 96].fill(value);
                    let got = offline.run(&rgba, &depth, &warp).unwrap();
                    // Fills reach six rows far.
                    assert_eq!(row(&got.rgba, 0, 96 * 4), row(&want.rgba, 0, 96 * 4), "{subject:?} {value}");
                    assert_eq!(
                        row(&got.rgba, 23, 96 * 4),
                        row(&want.rgba, 23, 96 * 4),
                        "{subject:?} {value}"
                    );
                }
            }
        }
    });
}

/// Boxes as near as 5 cm before a far wall: the search passes over what lies between the tiles that land in a pixel, and
/// finds what the reference finds that looks at every column, and to the pixel what the variant finds that does, too.
#[test]
fn near_surfaces_are_found_in_few_steps() {
    let frustum = Frustum { left: -1.1, right: 1.1, bottom: -0.16, top: 0.16 };
    let size = [840, 120];
    on_every_backend(|gl| {
        for (seed, boxes, dominant, convention) in [
            (0, 1, Eye::Right, DepthConvention::Standard),
            (1, 1, Eye::Left, DepthConvention::Reversed),
            (2, 6, Eye::Left, DepthConvention::Standard),
            (3, 6, Eye::Right, DepthConvention::Reversed),
        ] {
            let depth = DepthRange { near: 0.05, far: 100.0, convention };
            let p = EyePair::parallel(Pose::IDENTITY, frustum, 0.063, depth, size, dominant);
            let warp = p.synthesis(GuardBand::Distance(1.0)).unwrap().warp;
            let (rgba, depth) = near_boxes(warp.source_size, p.depth, seed, boxes);
            let results = GatherVariant::ALL.map(|variant| {
                (variant, Subject::Gather(variant).offline(gl).run(&rgba, &depth, &warp).unwrap())
            });
            let of_all_columns = |(variant, _): &&(_, _)| *variant == GatherVariant::Software;
            let (_, every_column) = results.iter().find(of_all_columns).unwrap();
            for (variant, result) in &results {
                let what = format!("{variant:?}, {boxes} boxes, {dominant:?} dominant, {convention:?}");
                is_its_reference(result, reference::gather_row, &rgba, &depth, &warp, &what);
                let pairs = result.source_map.iter().zip(&every_column.source_map);
                // Rounding of positions, where a pixel's middle lies on an edge.
                let different =
                    pairs.filter(|(a, b)| a.abs_diff(**b) > SOURCE_MAP_FIXED as u32 / 100).count();
                assert!(different <= 10, "{what}: {different} pixels are not those of all columns");
            }
            let counting = Box::new(Gather::counting(gl).unwrap());
            let counts = Offline::with_pipeline(gl, counting).unwrap().run(&rgba, &depth, &warp).unwrap();
            let most = counts.rgba.chunks_exact(4).map(|pixel| pixel[1]).max().unwrap();
            // Four tiles at first, and then those of the box's silhouettes: where they are slanted, two for each.
            assert!(boxes > 1 || (1..=8 * 16).contains(&most), "{most} steps past a single box");
        }
    });
}

fn near_boxes(size: [u32; 2], range: DepthRange, seed: u64, boxes: u32) -> (Vec<u8>, Vec<f32>) {
    let [w, h] = size.map(|n| n as usize);
    let mut rng = rand_pcg::Pcg32::seed_from_u64(seed);
    // Reciprocals of metres. A slanted wall: of a flat one whole columns may be within rounding of a decision.
    let mut nearness: Vec<f32> = (0..w * h).map(|i| 0.2 + 0.05 * (i % w) as f32 / w as f32).collect();
    for _ in 0..boxes {
        // Off the borders: what lies beside a surface that is cut off there may be filled from elsewhere than the reference does.
        let [x, wide] = [w / 4..w / 2, w / 20..w / 3].map(|range| rng.random_range(range));
        // A single one from the lowest row to the topmost: the rows of a tile that has a box above walk like the box's.
        let (y, high) = match boxes {
            1 => (0, h),
            _ => (rng.random_range(0..h), rng.random_range(h / 8..h / 2)),
        };
        let nearest = if boxes == 1 { 14.0 } else { 3.0 };
        let (front, slope) = (rng.random_range(nearest..16.0f32), rng.random_range(-0.01..0.01f32));
        for j in y..(y + high).min(h) {
            // Slanted sides.
            let left = (x + (j - y) / 4).min(w);
            for i in left..(left + wide).min(w) {
                let here = (front + slope * (i - left) as f32).clamp(3.0, 20.0);
                nearness[j * w + i] = nearness[j * w + i].max(here);
            }
        }
    }
    let rgba = (0..w * h * 4).map(|_| rng.random()).collect();
    (rgba, nearness.into_iter().map(|nearness| range.depth(1.0 / nearness)).collect())
}
