//! Tests the paper's pipeline against an f64 reference of Algorithm 2, and what every pipeline must fulfil, on all GL
//! backends. Golden images show Algorithm 3's colours.

use yoro::eyes::{DepthConvention, Eye, GuardBand};
use yoro::synthesis::{SOURCE_MAP_FIXED, SOURCE_MAP_HOLE};
use yoro_render::stereo::{ImBufferSize, Paper, PaperOptions, Synthesis};
use yoro_test_support::in_memory::OUTPUTS;
use yoro_test_support::laws;
use yoro_test_support::laws::{Subject, on_every_backend, pair, positions, row, scene};

laws!([
    subject(PaperOptions::default()),
    subject(PaperOptions { strict: true, linear_interpolation: false, ..PaperOptions::default() }),
]);

#[test]
fn asymmetric_frusta_agree_with_the_symmetric_view() {
    laws::asymmetric_frusta_agree_with_the_symmetric_view(&[subject(PaperOptions::default())]);
}

fn subject(options: PaperOptions) -> Subject {
    Subject {
        name: format!("{options:?}"),
        make: Box::new(move |gl| {
            let mut paper = Paper::new(gl, OUTPUTS, options).unwrap();
            Box::new(move |source, warp, target| paper.synthesize(source, warp, target))
        }),
    }
}

/// Compares sources and holes, not colours: what Algorithm 2 finds.
#[test]
fn paper_is_its_reference() {
    on_every_backend(|gl| {
        for (seed, dominant, strict) in
            [(5, Eye::Right, true), (6, Eye::Left, true), (7, Eye::Right, false), (8, Eye::Left, false)]
        {
            let p = pair([150, 40], dominant, 0.063, DepthConvention::Standard);
            let warp = p.synthesis_views(GuardBand::Pixels(9)).unwrap().warp;
            let (rgba, depth) = scene(warp.source_size, p.depth, seed);
            let paper = PaperOptions { strict, linear_interpolation: false, ..Default::default() };
            let result = subject(paper).in_memory(gl).run(&rgba, &depth, &warp);
            let (ws, wt) = (warp.source_size[0] as usize, warp.target_size[0] as usize);
            let mut different = 0;
            for y in 0..warp.target_size[1] as usize {
                let entries = paper_row(&positions(row(&depth, y, ws), &warp), wt, strict);
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
fn imbuffer_scales_cover_every_pixel_and_keep_a_plane() {
    on_every_backend(|gl| {
        let [w, h] = [130u32, 37];
        for imbuffer in
            [2, 4, 8, 16].map(ImBufferSize::Divisor).into_iter().chain([ImBufferSize::Fixed([50, 20])])
        {
            for linear_interpolation in [false, true] {
                let paper = PaperOptions { imbuffer, linear_interpolation, ..Default::default() };
                let p = pair([w, h], Eye::Right, 0.063, DepthConvention::Standard);
                let warp = p.synthesis_views(GuardBand::None).unwrap().warp;
                let z = p.focal_length_pixels() * 0.063 / 6.0;
                let rgba: Vec<u8> = (0..w * h).flat_map(|i| [(i % w) as u8, 128, 7, 255]).collect();
                let depth = vec![p.depth.depth(z); (w * h) as usize];
                let result = subject(paper).in_memory(gl).run(&rgba, &depth, &warp);
                for y in 0..h {
                    // The border is a hole; its cells are as wide as the ImBuffer's pixels.
                    for x in 32..w {
                        let got = result.rgba[((y * w + x) * 4) as usize];
                        assert!(got.abs_diff((x - 6) as u8) <= 1, "{paper:?} ({x}, {y}): {got}");
                    }
                }
            }
        }
    });
}

/// One ImBuffer entry of Algorithm 2.
#[derive(Clone, Copy, Debug, PartialEq)]
enum ImBufferEntry {
    Valid(f64),
    Disocclusion { left: i64, width: i64 },
}

/// Algorithm 2 at scale 1, as corrected: the first writer wins in forward order, the tracker follows the running
/// maximum, and valid entries are never overwritten.
fn paper_row(p: &[f64], width: usize, strict: bool) -> Vec<ImBufferEntry> {
    let mut entries: Vec<Option<ImBufferEntry>> = vec![None; width];
    let mut reached = -1i64;
    for (x, &position) in p.iter().enumerate() {
        let target = (position + 0.5).floor() as i64;
        if target < 0 || target >= width as i64 {
            continue;
        }
        if matches!(entries[target as usize], Some(ImBufferEntry::Valid(_))) {
            continue;
        }
        for i in reached + 1..target {
            entries[i as usize] =
                Some(ImBufferEntry::Disocclusion { left: reached, width: target - reached });
        }
        let source = if strict {
            x as f64
        } else {
            (x as f64 + target as f64 - position).clamp(0.0, (p.len() - 1) as f64)
        };
        entries[target as usize] = Some(ImBufferEntry::Valid(source));
        reached = reached.max(target);
    }
    let width = width as i64;
    let rest = ImBufferEntry::Disocclusion { left: reached, width: width - reached };
    entries.into_iter().map(|e| e.unwrap_or(rest)).collect()
}
