//! The pipeline for any view against its f64 reference, its laws, and gather where both apply.

use glam::{DVec2, Vec3};

use super::laws::{on_every_backend, pair, scene};
use super::posed::{MOTIONS, moved, run};
use super::reference::{Color, filled, mix};
use yoro::eyes::{DepthConvention, Eye, EyePair, GuardBand, PoseWarp, View};
use yoro::opengl::{AnyView, GlError, Options, Outputs, Part};

/// Returns a view of `size`, and a moved and turned copy of it.
fn views(size: [u32; 2], way: Vec3, turn: [f32; 3], convention: DepthConvention) -> [View; 2] {
    let source = pair(size, Eye::Left, 0.0, convention).view(Eye::Left);
    [source, moved(&source, (way, turn))]
}

/// Marches in f64 over all samples of the segment. Returns the colour of a target pixel, and its stored depth.
fn reference(rgba: &[u8], depth: &[f32], warp: &PoseWarp, pixel: DVec2) -> (Color, f64) {
    let size = warp.source_size.map(|n| n as usize);
    let [c, m] = warp.source_law;
    let ray = warp.homography * pixel.extend(1.0);
    // Converts the inverse distance from the source to that from the target, and that to a source pixel.
    let from_target = |s: f64| s * ray.z / (1.0 - s * warp.epipole.z);
    let at = |depth: f64| warp.source_pixel(pixel, from_target(c + m * depth)) - 0.5;
    let (far_at, near_at) = (at(warp.far_depth), at(warp.nearest));
    let whole = near_at - far_at;
    let steep = usize::from(whole.y.abs() > whole.x.abs());
    let (long, beside) = (steep, 1 - steep);
    let sense = if whole[long] > 0.0 { -1.0 } else { 1.0 };
    let slope = if whole[long] == 0.0 { 0.0 } else { whole[beside] / whole[long] };
    let law = -sense * whole[long] / (warp.nearest - warp.far_depth);
    let last = [size[long] as f64 - 1.0, size[beside] as f64 - 1.0];
    let index = |i: f64, j: f64| {
        let mut at = [0; 2];
        (at[long], at[beside]) = (i as usize, j as usize);
        at[1] * size[0] + at[0]
    };
    let landing = |i: f64, d: f64| sense * (i - far_at[long]) + law * (d - warp.far_depth);
    let sample = |i: f64| {
        let j = (far_at[beside] + slope * (i - far_at[long])).clamp(0.0, last[1]);
        let (low, t) = (j.floor(), j.fract());
        let [here, next] = [low, (low + 1.0).min(last[1])].map(|j| f64::from(depth[index(i, j)]));
        if (law * (next - here)).abs() < 1.0 {
            (j, here + t * (next - here))
        } else {
            (low + f64::from(t >= 0.5), if t >= 0.5 { next } else { here })
        }
    };
    let color = |i: f64, j: f64| -> Color {
        let (low, high, t) = (index(i, j.floor()), index(i, j.ceil()), j.fract());
        std::array::from_fn(|c| f64::from(rgba[low * 4 + c]) * (1.0 - t) + f64::from(rgba[high * 4 + c]) * t)
    };
    let first = (sense * (sense * far_at[long] - whole[long].abs()).floor()).clamp(0.0, last[0]);
    let end = (sense * ((sense * far_at[long]).floor() + 1.0)).clamp(0.0, last[0]);
    let mut here = (first, sample(first));
    let mut b = landing(first, here.1.1);
    let border = if sense > 0.0 { 0.0 } else { last[0] };
    let mut edge = (first == border && b > 0.0).then_some(here);
    let (mut rim, mut found) = (None, None);
    let steps = if edge.is_some() && b < 0.5 { 0 } else { (sense * (end - first)) as i64 };
    for n in 1..=steps {
        let before = here;
        let a = b;
        let i = first + sense * n as f64;
        here = (i, sample(i));
        b = landing(i, here.1.1);
        if a > 0.0 {
            continue;
        }
        if b > 0.0 && b - a >= 2.0 && b < 1.0 {
            rim = rim.or(Some(here));
        } else if b <= 0.0 && b.max(-1.0) < a {
            rim = rim.or(Some(before));
        }
        if b > 0.0 {
            if b - a < 2.0 || a > -0.5 {
                let t = if b - a < 2.0 { -a / (b - a) } else { 0.0 };
                found = Some((
                    mix(color(before.0, before.1.0), color(here.0, here.1.0), t),
                    before.1.1 + t * (here.1.1 - before.1.1),
                ));
                break;
            }
            if edge.is_none_or(|(_, (_, d))| law * (before.1.1 - d) < 0.0) {
                edge = Some(before);
            }
        }
    }
    let (mut seen, mut seen_depth) = found.unwrap_or_else(|| {
        let (i, (j, d)) = edge.unwrap_or(here);
        let away = landing(i, d).abs();
        let tap = |distance: f64| {
            let tap = (j.round() + distance).clamp(0.0, last[1]);
            (law * (f64::from(depth[index(i, tap)]) - d), color(i, tap))
        };
        (if away >= 0.5 { filled(color(i, j), away, tap) } else { color(i, j) }, d)
    });
    if let Some((i, (j, d))) = rim {
        let coverage = 1.0 - landing(i, d).abs();
        seen = mix(seen, color(i, j), coverage);
        seen_depth = if coverage >= 0.5 { d } else { seen_depth };
    }
    let stored = (from_target(c + m * seen_depth) - warp.target_law[0]) / warp.target_law[1];
    (seen, stored.clamp(0.0, 1.0))
}

/// With the near plane at the surfaces, or much nearer, so that spans skip most of each segment.
#[test]
fn any_view_is_its_reference() {
    on_every_backend(|gl| {
        let cases = MOTIONS.into_iter().flat_map(|motion| [(motion, 0.3), (motion, 0.05)]);
        for (seed, ((way, turn), near)) in cases.enumerate() {
            let convention = [DepthConvention::Standard, DepthConvention::Reversed][seed / 2 % 2];
            let [mut source, mut target] = views([97, 71], way, turn, convention);
            (source.depth.near, target.depth.near) = (near, near);
            target.size = [90, 75];
            let warp = PoseWarp::new(&source, &target).unwrap();
            let (rgba, depth) = scene(source.size, source.depth, seed as u64);
            let got = run(gl, &rgba, &depth, &warp, None);
            let mut different = 0;
            for y in 0..75 {
                for x in 0..90 {
                    let (color, stored) =
                        reference(&rgba, &depth, &warp, DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5));
                    let i = (y * 90 + x) as usize;
                    let off =
                        got.rgba[i * 4..][..4].iter().zip(color).map(|(a, b)| (f64::from(*a) - b).abs());
                    // Filters have 8 bits of fraction in each of two directions.
                    let same =
                        off.fold(0.0, f64::max) < 3.0 && (f64::from(got.depth[i]) - stored).abs() < 2e-5;
                    different += u32::from(!same);
                }
            }
            // Positions within rounding of a decision may differ.
            let what = format!("{way} {turn:?}, near plane at {near} m");
            assert!(different <= 90 * 75 / 500, "{what}: {different} pixels differ");
        }
    });
}

/// Returns a smoothly varying colour for a place in a view's image plane.
fn smooth(at: DVec2) -> Color {
    [at.x * 1.7, at.y * 1.3, (at.x * 0.11).sin() * 60.0 + (at.y * 0.07).cos() * 50.0 + 120.0, 255.0]
}

/// Returns colour and depth of a plane whose inverse distance is `s.x * x + s.y * y + s.z` at the source's pixel (x,
/// y).
fn plane(view: &View, s: [f64; 3]) -> (Vec<u8>, Vec<f32>) {
    let (c, m) = view.depth.inverse_distance_law();
    let pixels = (0..view.size[0] * view.size[1])
        .map(|i| DVec2::new(f64::from(i % view.size[0]) + 0.5, f64::from(i / view.size[0]) + 0.5));
    let rgba = pixels.clone().flat_map(|at| smooth(at).map(|v| v.round() as u8)).collect();
    (rgba, pixels.map(|at| ((s[0] * at.x + s[1] * at.y + s[2] - c) / m) as f32).collect())
}

#[test]
fn a_plane_moves_exactly() {
    on_every_backend(|gl| {
        for (n, (way, turn)) in MOTIONS.into_iter().enumerate() {
            let [source, target] = views([140, 120], way, turn, DepthConvention::Standard);
            let warp = PoseWarp::new(&source, &target).unwrap();
            for s in [[0.0, 0.0, 0.5], [0.002, -0.004, 0.8]] {
                let (rgba, depth) = plane(&source, s);
                let got = run(gl, &rgba, &depth, &warp, None);
                let mut seen = 0;
                for i in 0..140 * 120 {
                    let pixel = DVec2::new(f64::from(i % 140) + 0.5, f64::from(i / 140) + 0.5);
                    // The plane's inverse distance here: s . q = k / q.z with q = H p + k e.
                    let (h, e, s) = (warp.homography * pixel.extend(1.0), warp.epipole, glam::DVec3::from(s));
                    let k = s.dot(h) / (1.0 - s.dot(e));
                    let at = warp.source_pixel(pixel, k);
                    // Samples beside it must be in the image, too.
                    if at.min_element() < 2.0 || at.x > 138.0 || at.y > 118.0 {
                        continue;
                    }
                    seen += 1;
                    for (value, want) in got.rgba[i as usize * 4..].iter().zip(smooth(at)) {
                        let off = (f64::from(*value) - want).abs();
                        assert!(off < 1.6, "motion {n}, {pixel}: {value} for {want}");
                    }
                    let stored = (k - warp.target_law[0]) / warp.target_law[1];
                    let off = (f64::from(got.depth[i as usize]) - stored).abs();
                    assert!(off < 2e-6, "motion {n}, {pixel}, seen at {at}: depth differs by {off}");
                }
                assert!(seen > 140 * 120 * 2 / 3, "motion {n}: {seen} pixels");
            }
        }
    });
}

#[test]
fn parallel_eyes_are_those_of_gather() {
    on_every_backend(|gl| {
        for (seed, dominant, convention) in [
            (1, Eye::Right, DepthConvention::Standard),
            (2, Eye::Left, DepthConvention::Reversed),
            (3, Eye::Left, DepthConvention::Standard),
        ] {
            let eyes: EyePair = pair([150, 60], dominant, 0.063, convention);
            let views = eyes.synthesis_views(GuardBand::Pixels(9)).unwrap();
            let (rgba, depth) = scene(views.source.size, eyes.depth, seed);
            let want = super::subject().in_memory(gl).run(&rgba, &depth, &views.warp).rgba;
            let warp = PoseWarp::new(&views.source, &views.target).unwrap();
            let got = run(gl, &rgba, &depth, &warp, None).rgba;
            let off: Vec<u8> = got
                .chunks(4)
                .zip(want.chunks(4))
                .map(|(a, b)| (0..4).map(|c| a[c].abs_diff(b[c])).max().unwrap())
                .collect();
            // Every pixel has its own colour: one step of colour is a 250th of a pixel.
            let different = off.iter().filter(|&&off| off > 2).count();
            println!("case {seed}: {different} of {} pixels differ by more than 2 of 255", off.len());
            assert!(different * 1000 <= off.len(), "case {seed}: {different} of {}", off.len());
        }
    });
}

#[test]
fn a_part_is_what_the_whole_would_be() {
    on_every_backend(|gl| {
        for (way, turn) in MOTIONS {
            let [source, target] = views([61, 45], way, turn, DepthConvention::Standard);
            let warp = PoseWarp::new(&source, &target).unwrap();
            let (rgba, depth) = scene(source.size, source.depth, 7);
            let whole = run(gl, &rgba, &depth, &warp, None);
            let part = Part { origin: [5, 11], image_size: [83, 64] };
            let (mut around, mut depths) = (vec![13; 83 * 64 * 4], vec![0.0; 83 * 64]);
            for y in 0..45 {
                let at = (y + 11) * 83 + 5;
                around[at * 4..][..61 * 4].copy_from_slice(&rgba[y * 61 * 4..][..61 * 4]);
                depths[at..][..61].copy_from_slice(&depth[y * 61..][..61]);
            }
            let got = run(gl, &around, &depths, &warp, Some(part));
            // A filter's fraction may be rounded differently.
            assert!(got.rgba.iter().zip(&whole.rgba).all(|(a, b)| a.abs_diff(*b) <= 2), "{way} {turn:?}");
            assert_eq!(got.depth, whole.depth, "{way} {turn:?}");
        }
    });
}

#[test]
fn what_cannot_be_synthesized_is_refused() {
    on_every_backend(|gl| {
        let outputs = Outputs { source_map: true, ..Outputs::default() };
        let refused = AnyView::new(gl, &Options::default(), outputs);
        assert!(matches!(refused, Err(GlError::Unsupported(_))));
    });
}
