//! The gather pipeline against its f64 reference, and the laws that it must keep, on every available GL backend.

mod any_view;
mod guessed_depth;
mod holes;
mod host;
mod levels;
mod motion;
mod parts;
mod reference;
mod state;

use std::rc::Rc;

use rand::{Rng, SeedableRng};

use in_memory::{OUTPUTS, Synthesize};
use laws::{Subject, on_every_backend, open_es_300, pair, positions, row, scene};
use reference::{Picture, gather_row};
use yoro::eyes::{DepthConvention, DepthRange, DisparityMap, Eye, EyePair, Frustum, GuardBand, Pose, Warp};
use yoro::opengl::{Context, Gather, Options};
use yoro::synthesis::{SOURCE_MAP_FIXED, SOURCE_MAP_HOLE};
use yoro_context::{Backend, Headless};
use yoro_test_support::{in_memory, laws, posed};

laws!([subject()]);

#[test]
fn asymmetric_frusta_agree_with_the_symmetric_view() {
    laws::asymmetric_frusta_agree_with_the_symmetric_view(&[subject()]);
}

fn subject() -> Subject {
    Subject { name: "gather".into(), make: Box::new(synthesize) }
}

fn synthesize(gl: &Rc<Context>) -> Synthesize {
    let mut gather = Gather::new(gl, &Options::default(), OUTPUTS).unwrap();
    Box::new(move |source, warp, target| gather.synthesize(source, warp, target))
}

/// The largest allowed distance in pixels of a source column from the reference's: an eighth of a pixel in tiles with a
/// law, half from the tiles' planes and half from the law (`PLANAR` in `include/planes.glsl`).
const BOUND: f64 = 0.125;

fn agrees_with_reference(gl: &Rc<Context>) {
    for (seed, dominant, convention, guard) in [
        (1, Eye::Right, DepthConvention::Standard, GuardBand::None),
        (2, Eye::Left, DepthConvention::Standard, GuardBand::Pixels(21)),
        (3, Eye::Right, DepthConvention::Reversed, GuardBand::Distance(0.5)),
        (4, Eye::Left, DepthConvention::Reversed, GuardBand::None),
    ] {
        let p = pair([150, 40], dominant, 0.063, convention);
        let warp = p.synthesis_views(guard).unwrap().warp;
        let (rgba, depth) = scene(warp.source_size, p.depth, seed);
        is_its_reference(gl, &rgba, &depth, &warp, &format!("case {seed}"));
    }
}

fn is_its_reference(gl: &Rc<Context>, rgba: &[u8], depth: &[f32], warp: &Warp, what: &str) {
    let result = subject().in_memory(gl).run(rgba, depth, warp);
    let (ws, wt) = (warp.source_size[0] as usize, warp.target_size[0] as usize);
    let last_row = warp.source_size[1] as i32 - 1;
    let mirrored = warp.target_eye == Eye::Right;
    let picture = Picture { rgba, depth, warp };
    let mut different = 0;
    for y in 0..warp.target_size[1] as usize {
        let source_y = y as i32 - warp.row_offset;
        let depth_row = row(depth, source_y.clamp(0, last_row) as usize, ws);
        for (t, entry) in gather_row(&positions(depth_row, warp), &[], wt).iter().enumerate() {
            let x = if mirrored { wt - 1 - t } else { t };
            let got = result.source_map[y * wt + x];
            let hole = got & SOURCE_MAP_HOLE != 0;
            let source = (got & !SOURCE_MAP_HOLE) as f64 / SOURCE_MAP_FIXED as f64;
            // Positions within rounding of a decision (a pixel centre exactly on an edge) may differ.
            if hole != entry.hole || (source - entry.source).abs() > BOUND {
                different += 1;
                continue;
            }
            let color = picture.color(&entry.at(source), f64::from(source_y));
            let got = &result.rgba[(y * wt + x) * 4..][..4];
            let error = got.iter().zip(color).map(|(got, want)| (f64::from(*got) - want).abs());
            let is_same = error.fold(0.0, f64::max) <= 1.6;
            // So may a tap of a hole.
            assert!(is_same || entry.is_blended(), "{what} ({x}, {y}): {got:?} for {color:?}");
            different += u32::from(!is_same);
        }
    }
    let total = result.source_map.len() as u32;
    println!("{what}: {different} of {total} pixels differ");
    assert!(different * 1000 <= total, "{what}: {different} of {total} pixels differ");
}

/// A red square in front of blue: where a silhouette covers part of a pixel, the pixel is mixed in that proportion.
#[test]
fn gather_blends_silhouettes_by_coverage() {
    on_every_backend(|gl| blends_silhouettes_by_coverage(gl, &subject()));
}

fn blends_silhouettes_by_coverage(gl: &Rc<Context>, subject: &Subject) {
    let [w, h] = [64u32, 9];
    let mut seen = 0;
    for tenth in 0..10 {
        // Displacement of the square: 4 pixels and some tenths. The background does not move.
        let scale = 4.0 + tenth as f64 / 10.0;
        let warp = Warp {
            source_size: [w, h],
            target_size: [w, h],
            law: DisparityMap { offset: 0.0, scale },
            row_offset: 0,
            target_eye: Eye::Left,
            convention: DepthConvention::Reversed,
        };
        let square = |i: u32| (20..40).contains(&(i % w));
        let depth: Vec<f32> = (0..w * h).map(|i| if square(i) { 1.0 } else { 0.0 }).collect();
        let rgba: Vec<u8> =
            (0..w * h).flat_map(|i| if square(i) { [255, 0, 0, 255] } else { [0, 0, 255, 255] }).collect();
        let result = subject.in_memory(gl).run(&rgba, &depth, &warp);
        for x in 0..w {
            // The first and the last red sample land here; coverage falls to zero within a pixel.
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
    on_every_backend(agrees_with_reference);
}

/// Boxes as near as 5 cm in front of a far wall: the search skips what lies between the tiles that land in a pixel. It
/// finds the same as the reference, which examines every column.
#[test]
fn near_surfaces_are_found_past_skipped_tiles() {
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
            let warp = p.synthesis_views(GuardBand::Distance(1.0)).unwrap().warp;
            let (rgba, depth) = near_boxes(warp.source_size, p.depth, seed, boxes);
            let what = format!("{boxes} boxes, {dominant:?} dominant, {convention:?}");
            is_its_reference(gl, &rgba, &depth, &warp, &what);
        }
    });
}

/// A floor and two walls that meet in a corner: many tiles have a law. Sizes are odd, and the target has rows outside
/// of the source.
#[test]
fn tiles_with_laws_are_their_reference() {
    on_every_backend(|gl| {
        for (dominant, convention) in
            [(Eye::Right, DepthConvention::Standard), (Eye::Left, DepthConvention::Reversed)]
        {
            let p = pair([203, 77], dominant, 0.6, convention);
            let warp = p.synthesis_views(GuardBand::Pixels(21)).unwrap().warp;
            let warp = Warp { target_size: [203, 90], row_offset: 5, ..warp };
            let [w, h] = warp.source_size.map(|n| n as usize);
            // In 1 / metres, which is affine on a plane.
            let nearness = |x: f32, y: f32| (0.1 + 0.002 * (x - 97.3).abs()).max(0.5 - 0.012 * y);
            let depth: Vec<f32> =
                (0..w * h).map(|i| p.depth.depth(1.0 / nearness((i % w) as f32, (i / w) as f32))).collect();
            let (rgba, _) = scene(warp.source_size, p.depth, 17);
            is_its_reference(gl, &rgba, &depth, &warp, &format!("{dominant:?} dominant"));
        }
    });
}

/// Eyes 60 m apart: the nearest surfaces move by more pixels than tiles can store, and by more than the image's width.
#[test]
fn surfaces_that_move_beyond_the_image_hide_nothing() {
    on_every_backend(|gl| {
        for dominant in Eye::BOTH {
            let depth = DepthRange { near: 0.3, ..DepthRange::PAPER };
            let p = EyePair { depth, ..pair([150, 40], dominant, 60.0, DepthConvention::Standard) };
            let warp = p.synthesis_views(GuardBand::None).unwrap().warp;
            assert!(warp.law.scale.abs() > Warp::MAX_DISPLACEMENT);
            let metres = |i: u32| match (i % 150, i / 150) {
                (40..60, 5..20) => 0.31,
                (80..110, 10..30) => 150.0,
                (x, _) => 500.0 + x as f32,
            };
            let depth: Vec<f32> = (0..150 * 40).map(|i| p.depth.depth(metres(i))).collect();
            let (rgba, _) = scene(p.size, p.depth, 16);
            is_its_reference(gl, &rgba, &depth, &warp, &format!("{dominant:?} dominant"));
        }
    });
}

/// OpenGL ES 3.0 and WebGL 2 draw the same picture to the bit, by the functions that are written out for them.
#[test]
fn the_shaders_of_es_3_0_draw_the_same_picture() {
    let draw = |headless: Headless| {
        let mut drawn = Vec::new();
        for (seed, dominant, convention) in
            [(1, Eye::Right, DepthConvention::Standard), (2, Eye::Left, DepthConvention::Reversed)]
        {
            // Slow and fast changes of depth, boxes, wires; and boxes so near that the search skips tiles.
            let scattered = pair([203, 77], dominant, 0.2, convention);
            let near = EyePair { depth: DepthRange { near: 0.05, ..scattered.depth }, ..scattered };
            for p in [scattered, near] {
                let warp = p.synthesis_views(GuardBand::Pixels(21)).unwrap().warp;
                let warp = Warp { target_size: [203, 90], row_offset: 5, ..warp };
                let (rgba, depth) = match p == near {
                    true => near_boxes(warp.source_size, p.depth, seed, 6),
                    false => scene(warp.source_size, p.depth, seed),
                };
                drawn.push(subject().in_memory(headless.gl()).run(&rgba, &depth, &warp));
            }
        }
        drawn
    };
    assert!(draw(open_es_300()) == draw(Headless::open(Backend::Egl).unwrap()));
}

/// Boxes as near as 5 cm in front of a slanted wall.
fn near_boxes(size: [u32; 2], range: DepthRange, seed: u64, boxes: u32) -> (Vec<u8>, Vec<f32>) {
    let [w, h] = size.map(|n| n as usize);
    let mut rng = rand_pcg::Pcg32::seed_from_u64(seed);
    // In 1 / metres. The wall is slanted: with a flat one, whole columns might be within rounding of a decision.
    let mut nearness: Vec<f32> = (0..w * h).map(|i| 0.2 + 0.05 * (i % w) as f32 / w as f32).collect();
    for _ in 0..boxes {
        // Away from the borders: beside a surface that is cut off at a border, the shaders may fill from elsewhere than
        // the reference.
        let [x, wide] = [w / 4..w / 2, w / 20..w / 3].map(|range| rng.random_range(range));
        // A single box spans all rows: in a tile that a box covers in part, the other rows take as many steps as the
        // box's.
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
