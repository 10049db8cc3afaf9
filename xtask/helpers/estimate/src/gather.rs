//! What the synthesis executes.
//!
//! The runs of the parts of `gather` are counted on real frames, by a copy of its shaders into which `cargo xtask
//! maintain estimate` has written counters. A GPU runs a part as often as the slowest pixel of a wave does. The sizes of
//! the parts are those that Mesa's compilers make of the same source without some of them.

use std::rc::Rc;

use anyhow::ensure;

use crate::costs::Work;
use crate::gpus::Device;
use crate::traffic::MARCH;
use crate::waves::{combine, wave_size};
use yoro::eyes::SynthesisViews;
use yoro::opengl::{Gather, Options, Outputs};
use yoro::synthesis::Uniforms;
use yoro_gl::{Context, Filter, Format, RenderTarget};
use yoro_render::{DepthResolve, PreparedScene, ViewTargets};
use yoro_test_support::record::RecordedPass;

/// The size of a tile in pixels. The first two passes draw one fragment per tile.
const TILE: [u32; 2] = [16, 8];
/// The number of row pairs of a tile, and thus of trips of its loop.
const TILE_TRIPS: f64 = TILE[1] as f64 / 2.0;
/// Bytes read and written for each pixel, counting every texel once: depth for the tiles, colour, target, and both
/// maps.
const BYTES: f64 = 4.0 + 4.0 + 4.0 + 2.0 * 2.0 * 16.0 / (TILE[0] * TILE[1]) as f64;
/// Bytes of depth that the march reads for a pixel whose tile has no law.
const DEPTH_BYTES: f64 = 4.0;

/// The largest number of source tiles that a law is made of (`LAW_TILES` in `include/laws.glsl`).
const LAW_TILES: f64 = 4.0;

/// A variant of the march.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct March {
    /// True if it adds bloom.
    pub bloom: bool,
    /// True if it writes depth, for surfaces that are drawn over the synthesized eye.
    pub depth: bool,
    /// True if it leaves holes open.
    pub open: bool,
}

impl March {
    /// Returns the variant that a recorded frame runs.
    pub fn of(passes: &[RecordedPass]) -> March {
        let draws = passes.iter().filter(|pass| pass.declaration.name == MARCH).flat_map(|pass| &pass.draws);
        let defines = draws.flat_map(|draw| draw.program.defines.iter().map(|(name, _)| name.as_str()));
        defines.fold(March::default(), |march, name| March {
            bloom: march.bloom || name == "BLOOM",
            depth: march.depth || name == "WRITE_DEPTH",
            open: march.open || name == "OPEN_HOLES",
        })
    }
}

/// The parts of the march that are counted.
const COUNTED: [&str; 9] =
    ["law", "short way", "short step", "long way", "segment", "event", "crossing", "fill", LAW_TEST];
/// The test of a march with open holes whether a law's surface ends in the row; it runs where that may be.
const LAW_TEST: &str = "test of a law";
/// How often each of [`COUNTED`] runs: for one pixel, or the maximum over a wave's pixels.
type Trips = [f64; 9];

/// Returns the trips of a pixel. Either its tile has a law, or it goes the short way.
fn trips([ways, segments, events, crossings]: [u8; 4]) -> Trips {
    let bit = |i: u8| f64::from(ways >> i & 1);
    let law = bit(5);
    let [segments, events, crossings] = [segments, events, crossings].map(f64::from);
    [law, 1.0 - law, f64::from(ways & 7), bit(4), segments, events, crossings, bit(3), law * bit(6)]
}

/// The costs of the parts of gather's passes on one GPU.
struct Costs {
    /// The number of pixels in a wave of the march.
    lanes: u32,
    parts: Vec<(&'static str, Work)>,
}

impl Costs {
    /// Reads the costs on a GPU, and gives each loop a name for what it does in the shader. With `pairs`, depth is that
    /// of two samples.
    ///
    /// # Errors
    /// If the table has no entry for this GPU, or a program has an unexpected number of loops.
    fn of(gpu: &str, pairs: bool) -> anyhow::Result<Costs> {
        let table = crate::costs::Costs::of(gpu)?;
        let of = |pass: &str, more: &[&str], loops: usize| {
            let reads_depth = pairs && pass != "spans";
            let macros: Vec<&str> =
                reads_depth.then_some("DEPTH_PAIRS").into_iter().chain(more.iter().copied()).collect();
            let parts = table.parts(&format!("synthesis/gather/{pass}.frag"), &macros)?;
            let found = parts.loops.len();
            ensure!(
                found == loops,
                "{pass} {more:?} has {found} loops on {gpu}, and {loops} are named: name them anew in gather.rs"
            );
            Ok(parts)
        };
        let (tiles, spans) = (of("tiles", &[], 1)?, of("spans", &[], 3)?);
        // Each program adds one part to the previous one: see tests/src/programs.rs.
        let law = of("march", &["PARTS=1"], 0)?;
        let short = of("march", &["PARTS=2"], 1)?;
        let segments = of("march", &["PARTS=6"], 2)?;
        let events = of("march", &["PARTS=14"], 2)?;
        let fill = of("march", &["PARTS=30"], 2)?;
        let all = of("march", &["PARTS=62"], 3)?;
        let depth = of("march", &["WRITE_DEPTH", "PARTS=1"], 0)?;
        // Bloom reads no depth. What leaves pixels open is compiled for depth of one sample.
        let more = |name: &str, part: &str| {
            let of = |macros: &[&str]| table.parts("synthesis/gather/march.frag", macros);
            anyhow::Ok(of(&[name, part])?.straight.minus(of(&[part])?.straight))
        };
        // The loop over segments is the second one, the loop to a crossing is the last. Events are handled in two
        // places, one of them before the loop.
        let event = events.loops[1].minus(segments.loops[1]);
        let crossing = all.straight.minus(fill.straight);
        let long = events.straight.plus(1.0, crossing).minus(event).minus(short.straight);
        let parts = vec![
            ("tiles", tiles.straight),
            ("tiles: two rows", tiles.loops[0]),
            ("spans", spans.straight),
            ("spans: tile", spans.loops[0]),
            ("spans: plane", spans.loops[1]),
            ("spans: joint", spans.loops[2]),
            ("march: law", law.straight),
            ("march: depth of a law", depth.straight.minus(law.straight)),
            ("march: bloom", more("BLOOM", "PARTS=1")?),
            ("march: test of a law", more("OPEN_HOLES", "PARTS=1")?),
            ("march: tests of a search", more("OPEN_HOLES", "PARTS=2")?),
            ("march: short way", short.straight),
            ("march: short step", short.loops[0]),
            ("march: long way", long),
            ("march: segment", segments.loops[1]),
            ("march: event", event),
            ("march: fill", fill.total().minus(events.total())),
            ("march: crossing", all.loops[2]),
        ];
        Ok(Costs { lanes: all.lanes, parts })
    }

    /// Returns the cost of running a part once.
    fn part(&self, name: &str) -> Work {
        let found = self.parts.iter().find(|(part, _)| *part == name);
        found.unwrap_or_else(|| panic!("no part of gather is called {name}")).1
    }

    /// Returns a lower bound of what a wave executes for each of its pixels: each part as often as the pixel that runs
    /// it most often. Lanes that run parts at different times also wait for each other, which is not counted.
    fn march(&self, trips: Trips, march: March) -> Work {
        let [law, short, ..] = trips;
        let more = [
            (march.depth, "depth of a law", law),
            // Both ways end with it.
            (march.bloom, "bloom", law + short),
            (march.open, "tests of a search", short),
        ];
        let more = more.into_iter().filter(|(is_on, ..)| *is_on).map(|(_, part, times)| (part, times));
        let counted = COUNTED.into_iter().zip(trips).filter(|(part, _)| march.open || *part != LAW_TEST);
        let runs = counted.chain(more);
        runs.fold(Work::default(), |sum, (part, times)| sum.plus(times, self.part(&format!("march: {part}"))))
    }
}

/// Returns the trips of the loop of the second pass (`synthesis/gather/spans.frag`), as the mean over the target's
/// columns of tiles.
fn span_trips(views: &SynthesisViews) -> f64 {
    let warp = &views.warp;
    let Uniforms { near_displacement, far_displacement, .. } = Uniforms::new(warp, [0, 0]);
    let tile = f64::from(TILE[0]);
    let last_tile = f64::from(warp.source_size[0].div_ceil(TILE[0]) - 1);
    let columns = warp.target_size[0].div_ceil(TILE[0]);
    let trips = (0..columns).map(|column| {
        let first = f64::from(column) * tile;
        let from =
            (((first - f64::from(near_displacement) - 1.0) / tile).floor() - 1.0).clamp(0.0, last_tile);
        let to = ((first + tile - f64::from(far_displacement)) / tile).floor().clamp(0.0, last_tile);
        (to - from + 1.0).max(0.0)
    });
    trips.sum::<f64>() / f64::from(columns)
}

fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len().max(1) as f64;
    values.sum::<f64>() / count
}

/// Counts how often parts of `gather` run.
pub struct Counter {
    counting: Gather,
    targets: ViewTargets,
    counts: RenderTarget,
}

impl Counter {
    /// Compiles the counting pipeline, for views whose nearest depth is had in this way.
    ///
    /// # Errors
    /// If the driver refuses it.
    pub fn new(gl: &Rc<Context>, depth: DepthResolve) -> anyhow::Result<Counter> {
        let options = Options { depth_pairs: depth == DepthResolve::InColor, ..Options::default() };
        Ok(Counter {
            counting: Gather::new(gl, &options, Outputs::default())?,
            targets: ViewTargets::default(),
            counts: RenderTarget::new(gl, [1, 1], &[(Format::Rgba8, Filter::Nearest)], None)?,
        })
    }

    /// Counts for views whose depth is reversed, since no other can be carried.
    ///
    /// # Errors
    /// If the eyes cannot be synthesized, or GL refuses.
    pub fn count(&mut self, scene: &mut PreparedScene, views: SynthesisViews) -> anyhow::Result<Counted> {
        scene.synthesize(&mut self.counting, &mut self.targets, &views, &mut self.counts)?;
        Ok(Counted { pixels: self.counts.read_rgba8(0, [0, 0], views.target.size), views })
    }
}

/// The counts of a synthesized view, row by row.
pub struct Counted {
    pub views: SynthesisViews,
    pixels: Vec<u8>,
}

/// What `gather` executes for each pixel of a synthesized view on a GPU.
#[derive(Clone, Copy, Debug, Default)]
pub struct Executed {
    /// Issue slots of the first pass, the second and the third.
    pub slots: [f64; 3],
    /// Texture instructions of all three.
    pub fetches: f64,
    /// Bytes that they read and write, counting every texel once.
    pub bytes: f64,
}

impl Counted {
    /// Returns the largest counts in each wave.
    fn waves(&self, wave: [u32; 2]) -> Vec<Trips> {
        let pixels = self.pixels.as_chunks().0.iter();
        combine(pixels, self.views.target.size[0], wave, |largest: &mut Trips, pixel| {
            let own = trips(*pixel);
            *largest = std::array::from_fn(|i| largest[i].max(own[i]));
        })
    }

    /// Returns the share of the pixels whose tile has a law, 0 to 1.
    pub fn laws(&self) -> f64 {
        mean(self.waves([1, 1]).iter().map(|[law, ..]| *law))
    }

    /// Returns what a GPU executes with this variant of the march.
    ///
    /// # Errors
    /// If the table of costs lacks a program.
    pub fn executed(&self, device: &Device, depth: DepthResolve, variant: March) -> anyhow::Result<Executed> {
        let costs = Costs::of(device.gpu, depth == DepthResolve::InColor)?;
        let waves = self.waves(wave_size(costs.lanes));
        let march: Vec<Work> = waves.iter().map(|wave| costs.march(*wave, variant)).collect();
        let march = Work {
            slots: mean(march.iter().map(|work| work.slots)),
            fetches: mean(march.iter().map(|work| work.fetches)),
        };
        let tile = 1.0 / f64::from(TILE[0] * TILE[1]);
        let looped = |pass: &str, trips: f64, body: &str| costs.part(pass).plus(trips, costs.part(body));
        let wider = f64::from(self.views.warp.source_size[0]) / f64::from(self.views.target.size[0]);
        let tiles = Work::default().plus(tile * wider, looped("tiles", TILE_TRIPS, "tiles: two rows"));
        let spans = looped("spans", span_trips(&self.views), "spans: tile")
            .plus(LAW_TILES, costs.part("spans: plane"))
            .plus(LAW_TILES - 1.0, costs.part("spans: joint"));
        let spans = Work::default().plus(tile, spans);
        Ok(Executed {
            slots: [tiles.slots, spans.slots, march.slots],
            fetches: tiles.fetches + spans.fetches + march.fetches,
            bytes: BYTES + DEPTH_BYTES * (1.0 - self.laws()),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpus::GPUS;
    use yoro::eyes::{EyeOptions, GuardBand, Pose};

    /// Returns trips of these parts alone.
    fn named(parts: &[(&str, f64)]) -> Trips {
        COUNTED.map(|part| parts.iter().filter(|(name, _)| *name == part).map(|(_, times)| times).sum())
    }

    #[test]
    fn all_devices_have_all_parts() {
        // Bifrost's slots are tuples of two instructions.
        for device in GPUS.into_iter().filter(|device| device.gpu != "g52") {
            let costs = Costs::of(device.gpu, false).unwrap();
            let law = costs.part("march: law");
            let short = costs.part("march: short way");
            assert!(short.slots > law.slots && law.slots > 15.0, "{}: {short:?}, {law:?}", device.name);
            assert!(short.fetches > law.fetches && law.fetches >= 2.0, "{}: {short:?}", device.name);
            for part in ["tiles", "tiles: two rows", "spans", "spans: tile", "spans: plane", "spans: joint"] {
                assert!(costs.part(part).slots > 0.0, "{}: {part}", device.name);
            }
            for part in ["short step", "long way", "segment", "event", "crossing", "fill"] {
                let slots = costs.part(&format!("march: {part}")).slots;
                assert!((15.0..250.0).contains(&slots), "{}: {slots} slots of {part}", device.name);
            }
        }
        assert!(Costs::of("a999", false).is_err());
    }

    #[test]
    fn a_wave_runs_each_part_as_often_as_one_of_its_pixels() {
        let mut pixels = vec![0u8; 6 * 3 * 4];
        let mut set = |x: usize, y: usize, counts: [u8; 4]| {
            pixels[(y * 6 + x) * 4..][..4].copy_from_slice(&counts);
        };
        // All tiles have a law, except at three pixels.
        for y in 0..3 {
            (0..6).for_each(|x| set(x, y, [32, 0, 0, 0]));
        }
        set(0, 0, [3, 0, 0, 0]);
        set(3, 2, [1 | 8 | 16, 9, 2, 7]);
        set(5, 1, [2, 0, 0, 0]);
        set(4, 0, [32 | 64, 0, 0, 0]);
        let pair = EyeOptions { size: [6, 3], ..EyeOptions::default() }.pair(Pose::IDENTITY);
        let counts = Counted { pixels, views: pair.synthesis_views(GuardBand::None).unwrap() };
        let ways = [("law", 1.0), ("short way", 1.0)];
        let more = [("long way", 1.0), ("segment", 9.0), ("event", 2.0), ("crossing", 7.0), ("fill", 1.0)];
        let long = named(&[&ways[..], &[("short step", 3.0)], &more].concat());
        let short = named(&[&ways[..], &[("short step", 2.0), (LAW_TEST, 1.0)]].concat());
        assert_eq!(counts.waves([4, 4]), [long, short]);
        assert_eq!(counts.waves([1, 1]).len(), 18);
    }

    #[test]
    fn the_work_of_parts_adds_up() {
        let body = |slots, fetches| Work { slots, fetches };
        let parts = vec![
            ("march: law", body(30.0, 2.0)),
            ("march: depth of a law", body(5.0, 2.0)),
            ("march: bloom", body(50.0, 1.0)),
            ("march: test of a law", body(15.0, 3.0)),
            ("march: tests of a search", body(25.0, 4.0)),
            ("march: short way", body(80.0, 3.0)),
            ("march: short step", body(20.0, 1.0)),
            ("march: long way", body(90.0, 2.0)),
            ("march: segment", body(60.0, 2.0)),
            ("march: event", body(40.0, 0.0)),
            ("march: crossing", body(70.0, 1.0)),
            ("march: fill", body(75.0, 8.0)),
        ];
        let costs = Costs { lanes: 128, parts };
        let lawful = named(&[("law", 1.0), (LAW_TEST, 1.0)]);
        let all = March { bloom: true, depth: true, open: true };
        assert_eq!(costs.march(lawful, March::default()), body(30.0, 2.0));
        assert_eq!(costs.march(lawful, all), body(30.0 + 5.0 + 50.0 + 15.0, 2.0 + 2.0 + 1.0 + 3.0));
        let searched = [("short way", 1.0), ("short step", 2.0)];
        let short = named(&searched);
        assert_eq!(costs.march(short, March::default()), body(80.0 + 40.0, 3.0 + 2.0));
        assert_eq!(costs.march(short, all), body(120.0 + 50.0 + 25.0, 5.0 + 1.0 + 4.0));
        let more = [("long way", 1.0), ("segment", 3.0), ("event", 2.0), ("crossing", 1.0), ("fill", 1.0)];
        let long = named(&[&searched[..], &more].concat());
        let slots = 80.0 + 40.0 + 90.0 + 180.0 + 80.0 + 70.0 + 75.0;
        assert_eq!(costs.march(long, March::default()), body(slots, 3.0 + 2.0 + 2.0 + 6.0 + 1.0 + 8.0));
    }
}
