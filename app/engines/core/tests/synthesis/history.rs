//! Disocclusions that are taken from a history: an f64 reference of the look-up, and its laws.

use std::rc::Rc;

use glam::{DVec3, Quat};

use crate::in_memory::{Former, InMemory, OUTPUTS, SynthesizedImage};
use crate::laws::{on_every_backend, positions, row};
use crate::reference::gather_row;
use crate::sheets::{Picture, SHEETS, SIZE, eyes, in_strips, local, moved, render, unproject};
use yoro::eyes::{DepthConvention, Eye, GuardBand, Pose, View, Warp};
use yoro::synthesis::*;
use yoro_gl::Context;

/// A pipeline with its own textures.
struct Bench(InMemory);

impl Bench {
    fn new(
        gl: &Rc<Context>,
        make: impl FnOnce(&SynthesisOptions) -> Box<dyn Synthesis>,
        history: bool,
    ) -> Bench {
        Bench(InMemory::new(gl, make(&SynthesisOptions { history, ..SynthesisOptions::default() })))
    }

    fn run(&mut self, source: &Picture, warp: &Warp, history: Option<Former>) -> (Vec<u8>, Vec<u32>) {
        let SynthesizedImage { rgba, source_map } = self.0.recall(&source.rgba, &source.depth, warp, history);
        (rgba, source_map)
    }
}

/// Returns a picture as a history.
fn former(picture: &Picture, size: [u32; 2], strips: Strips) -> Option<Former<'_>> {
    Some(Former { rgba: &picture.rgba, depth: &picture.depth, size, strips })
}

/// Runs a body for each pipeline, given a function that makes the pipeline from options.
fn for_each_pipeline(body: impl Fn(&Rc<Context>, &str, &dyn Fn(&SynthesisOptions) -> Box<dyn Synthesis>)) {
    on_every_backend(|gl| {
        for variant in GatherVariant::ALL {
            body(gl, &format!("{variant:?}"), &|options| {
                Box::new(Gather::with_variant_of(gl, OUTPUTS, variant, options).unwrap())
            });
        }
        body(gl, "layers", &|options| {
            create(gl, &SynthesisOptions { edges: Edges::Nearest, ..*options }, OUTPUTS).unwrap()
        });
    });
}

fn is_hole(entry: u32) -> bool {
    entry & SOURCE_MAP_HOLE != 0
}

/// Without a history, or if all its strips are empty, the picture is that of a pipeline without histories.
#[test]
fn no_history_changes_no_bit() {
    for_each_pipeline(|gl, what, make| {
        let p = eyes(Pose::IDENTITY, Eye::Right, 0.063, DepthConvention::Standard);
        let views = p.synthesis_views(GuardBand::None).unwrap();
        let source = render(&views.source, &SHEETS);
        let plain = Bench::new(gl, make, false).run(&source, &views.warp, None);
        let mut recalling = Bench::new(gl, make, true);
        assert_eq!(recalling.run(&source, &views.warp, None), plain, "{what}");
        let empty = Strips::new(&views.target, &[None; 3]);
        assert_eq!(recalling.run(&source, &views.warp, former(&source, SIZE, empty)), plain, "{what}");
    });
}

/// Without a distance between the eyes nothing is uncovered, so nothing is taken from a history.
#[test]
fn without_a_distance_nothing_is_recalled() {
    for_each_pipeline(|gl, what, make| {
        let p = eyes(Pose::IDENTITY, Eye::Left, 0.0, DepthConvention::Reversed);
        let views = p.synthesis_views(GuardBand::None).unwrap();
        let (source, other) = (render(&views.source, &SHEETS), render(&views.target, &SHEETS[..2]));
        let strips = Strips::new(&views.target, &[Some(views.target)]);
        let (rgba, _) = Bench::new(gl, make, true).run(&source, &views.warp, former(&other, SIZE, strips));
        assert_eq!(rgba, source.rgba, "{what}");
    });
}

/// Uncovered pixels show the real scene if the history is of the same frame.
#[test]
fn a_history_of_this_frame_is_the_truth() {
    for_each_pipeline(|gl, what, make| {
        for dominant in Eye::BOTH {
            let p = eyes(moved(3.0), dominant, 0.063, DepthConvention::Standard);
            let views = p.synthesis_views(GuardBand::None).unwrap();
            let source = render(&views.source, &SHEETS);
            let truth = render(&views.target, &SHEETS);
            let strips = Strips::new(&views.target, &[Some(views.target)]);
            let (plain, map) = Bench::new(gl, make, false).run(&source, &views.warp, None);
            let (rgba, _) =
                Bench::new(gl, make, true).run(&source, &views.warp, former(&truth, SIZE, strips));
            let off = |image: &[u8], i: usize| {
                let pixels = image[i * 4..][..4].iter().zip(&truth.rgba[i * 4..][..4]);
                pixels.map(|(a, b)| a.abs_diff(*b)).max().unwrap()
            };
            let holes: Vec<usize> = (0..map.len()).filter(|i| is_hole(map[*i])).collect();
            let [before, after] =
                [&plain, &rgba].map(|image| holes.iter().filter(|i| off(image, **i) <= 2).count());
            assert!(holes.len() > 300, "{what}: {} holes", holes.len());
            // Next to a foreground, some pixels show a blended silhouette; layers blend everything that covers part of
            // a pixel.
            let least = if what == "layers" { 13 } else { 17 };
            assert!(20 * after > least * holes.len(), "{what}: {after} of {}, {before} before", holes.len());
            let worse =
                (0..map.len()).filter(|i| off(&rgba, *i) > off(&plain, *i).saturating_add(16)).count();
            assert!(50 * worse < holes.len(), "{what}: {worse} are worse, of {} holes", holes.len());
        }
    });
}

/// A history with a sheet close to the eyes, or of a room elsewhere, changes nothing.
#[test]
fn a_history_of_another_scene_changes_nothing() {
    for_each_pipeline(|gl, what, make| {
        let p = eyes(Pose::IDENTITY, Eye::Right, 0.063, DepthConvention::Reversed);
        let views = p.synthesis_views(GuardBand::None).unwrap();
        let source = render(&views.source, &SHEETS);
        let plain = Bench::new(gl, make, false).run(&source, &views.warp, None);
        let mut recalling = Bench::new(gl, make, true);
        let near = render(&views.target, &[[-50.0, 50.0, -50.0, 50.0, -0.5]]);
        let strips = Strips::new(&views.target, &[Some(views.target)]);
        // Beyond the source's borders, there is no foreground to compare the history's distance with.
        let inner = |(rgba, map): &(Vec<u8>, Vec<u32>)| -> Vec<u8> {
            let beyond = |i: &usize| !is_hole(map[*i]) || (20..140).contains(&(i % SIZE[0] as usize));
            (0..map.len()).filter(beyond).flat_map(|i| rgba[i * 4..][..4].to_vec()).collect()
        };
        let got = recalling.run(&source, &views.warp, former(&near, SIZE, strips));
        assert!(inner(&got) == inner(&plain), "{what}: nearer than the foreground");
        // A view in the opposite direction.
        let back = Pose { orientation: Quat::from_rotation_y(3.0), ..Pose::IDENTITY };
        let strips = Strips::new(&views.target, &[Some(View { pose: back, ..views.target })]);
        let got = recalling.run(&source, &views.warp, former(&near, SIZE, strips));
        assert_eq!(got, plain, "{what}: behind the head");
    });
}

/// Returns the pixel of a view that shows a point, with centres at +0.5, and the point's distance along the axis.
fn project(view: &View, world: DVec3) -> ([f64; 2], f64) {
    let (own, f) = (local(view, world), view.frustum);
    let z = -own.z;
    let at = |x: f64, low: f32, wide: f32, n: u32| (x / z - f64::from(low)) / f64::from(wide) * f64::from(n);
    ([at(own.x, f.left, f.width(), view.size[0]), at(own.y, f.bottom, f.height(), view.size[1])], z)
}

/// The look-up for a hole's pixel in f64: the fractional place in the history's image that shows the pixel's surface.
/// `Err` if it is within rounding of a decision.
struct Lookup<'a> {
    target: &'a View,
    strips: &'a [Option<View>],
    picture: &'a Picture,
    size: [u32; 2],
}

impl Lookup<'_> {
    fn place(&self, pixel: [f64; 2], z: f64) -> Option<([f64; 2], usize)> {
        let rows = self.size[1].div_ceil(self.strips.len() as u32);
        let world = unproject(self.target, pixel, z);
        let scale = f64::from(self.size[1]) / f64::from(self.target.size[1]);
        let mut strip = (pixel[1] * scale) as usize / rows as usize;
        for _ in 0..2 {
            let (at, z) = project(self.strips.get(strip)?.as_ref()?, world);
            let inside = (0..2).all(|i| at[i] >= 0.0 && at[i] < f64::from(self.size[i]));
            if z <= 0.0 || !inside {
                return None;
            }
            let landed = at[1] as usize / rows as usize;
            if landed == strip {
                return Some((at, strip));
            }
            strip = landed;
        }
        None
    }

    /// Returns the surface's distance and its place, for a pixel whose background and foreground have these distances.
    /// `seen` returns the nearest distance that the rendered eye sees where a surface of a given distance would be.
    fn recall(
        &self,
        pixel: [f64; 2],
        background: f64,
        front: Option<f64>,
        ipd_pixels: f64,
        seen: impl Fn(f64) -> Option<f64>,
    ) -> Option<[f64; 2]> {
        let (at, strip) = self.place(pixel, background)?;
        let texel = at[1] as usize * self.size[0] as usize + at[0] as usize;
        let view = self.strips[strip].as_ref()?;
        let stored = f64::from(view.depth.distance(self.picture.depth[texel]));
        // Find the point on the pixel's ray that is at that distance from the strip's eye; the distance is linear along
        // the ray.
        let [first, second] = [1.0, 2.0].map(|z| project(view, unproject(self.target, pixel, z)).1);
        let here = 1.0 + (stored - first) / (second - first);
        let exact = project(view, unproject(self.target, pixel, here)).0;
        let away = |i: usize| (exact[i] - at[i]) * f64::from(self.target.size[i]) / f64::from(self.size[i]);
        let off = away(0).hypot(away(1));
        let pixels = |z: f64| ipd_pixels / z;
        let behind = front
            .is_none_or(|front| pixels(here) <= pixels(front) - 0.25 * (pixels(front) - pixels(background)));
        let hidden = seen(here).is_none_or(|nearest| pixels(nearest) > pixels(here) - 1.0);
        (off < 1.0 && behind && hidden).then_some(exact)
    }
}

#[test]
fn the_lookup_is_its_reference() {
    on_every_backend(|gl| {
        for variant in GatherVariant::ALL {
            for (dominant, convention, scale) in [
                (Eye::Right, DepthConvention::Standard, 1),
                (Eye::Left, DepthConvention::Reversed, 1),
                (Eye::Right, DepthConvention::Reversed, 2),
            ] {
                let what = format!("{variant:?}, {dominant:?} dominant, {convention:?}, 1/{scale}");
                let at = |head: Pose| {
                    eyes(head, dominant, 0.063, convention).synthesis_views(GuardBand::None).unwrap()
                };
                let views = at(Pose::IDENTITY);
                let size = SIZE.map(|n| n / scale);
                // One of five strips is empty.
                let strips: Vec<Option<View>> = (0..5)
                    .map(|i| (i != 3).then(|| View { size, ..at(moved(i as f32 - 6.0)).target }))
                    .collect();
                let picture = in_strips(&strips, &View { size, ..views.target });
                let source = render(&views.source, &SHEETS);
                let make = |options: &SynthesisOptions| -> Box<dyn Synthesis> {
                    Box::new(Gather::with_variant_of(gl, OUTPUTS, variant, options).unwrap())
                };
                let (plain, map) = Bench::new(gl, make, false).run(&source, &views.warp, None);
                let relation = Strips::new(&views.target, &strips);
                let (rgba, _) =
                    Bench::new(gl, make, true).run(&source, &views.warp, former(&picture, size, relation));
                let lookup = Lookup { target: &views.target, strips: &strips, picture: &picture, size };
                is_its_reference(&lookup, &source, &views.warp, [&plain, &rgba], &map, &what);
            }
        }
    });
}

fn is_its_reference(
    lookup: &Lookup,
    source: &Picture,
    warp: &Warp,
    [plain, rgba]: [&[u8]; 2],
    map: &[u32],
    what: &str,
) {
    let [w, h] = SIZE.map(|n| n as usize);
    let mirrored = warp.target_eye == Eye::Right;
    let range = lookup.target.depth;
    let focal = f64::from(SIZE[0]) / f64::from(lookup.target.frustum.width());
    let (mut holes, mut served, mut wrong) = (0, 0, 0);
    for y in 0..h {
        let depths = row(&source.depth, y, w);
        let distance = |forward: usize| {
            f64::from(range.distance(depths[if mirrored { w - 1 - forward } else { forward }]))
        };
        let p = positions(depths, warp);
        for (t, entry) in gather_row(&p, w).iter().enumerate() {
            let i = y * w + if mirrored { w - 1 - t } else { t };
            if !entry.hole || !is_hole(map[i]) || entry.rim.is_some() {
                continue;
            }
            holes += 1;
            let edge = entry.source as usize;
            let border = edge == w - 1 || (edge == 0 && p[0] > t as f64);
            let front = (!border).then(|| distance(edge + 1));
            let pixel = [(i % w) as f64 + 0.5, y as f64 + 0.5];
            let seen = |z: f64| {
                let column = (t as f64 - focal * 0.063 / z).floor();
                let inside = column >= 0.0 && column < (w - 1) as f64;
                inside.then(|| distance(column as usize).min(distance(column as usize + 1)))
            };
            let place = lookup.recall(pixel, distance(edge), front, focal * 0.063, seen);
            let (got, before) = (&rgba[i * 4..][..4], &plain[i * 4..][..4]);
            let expected = match place {
                None => [before; 2],
                Some([x, y]) => {
                    served += 1;
                    // The colour of one of the surrounding texels, or between them.
                    let column = |x: f64| x.clamp(0.0, f64::from(lookup.size[0] - 1)) as usize;
                    let line = |y: f64| y.clamp(0.0, f64::from(lookup.size[1] - 1)) as usize;
                    let texel = |x: f64, y: f64| {
                        &lookup.picture.rgba[(line(y) * lookup.size[0] as usize + column(x)) * 4..][..4]
                    };
                    [texel(x - 0.5, y - 0.5), texel(x + 0.5, y + 0.5)]
                }
            };
            let tolerance = if place.is_some() { 4 } else { 0 };
            let near = |c: usize| {
                let [a, b] = expected.map(|pixel| pixel[c]);
                (a.min(b).saturating_sub(tolerance)..=a.max(b).saturating_add(tolerance)).contains(&got[c])
            };
            wrong += usize::from(!(0..4).all(near));
        }
    }
    assert!(holes > 300 && 4 * served > holes && served < holes, "{what}: {served} of {holes}");
    // Pixels within rounding of a decision may differ.
    assert!(50 * wrong <= holes, "{what}: {wrong} of {holes} ({served} served) differ");
}
