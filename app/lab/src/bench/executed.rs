//! What the synthesis executes on GPUs that are not here: an estimate.
//!
//! The loops of `gather` are counted where they run, in its own shaders on real frames. Each GPU runs a loop as often as
//! the slowest pixel of a wave; the sizes of loops and of what stands around them are those that Mesa's compilers
//! make of the same text (`docs/shader-cost.csv`). Rates of GPUs are assumptions: [`DEVICES`].

use std::rc::Rc;

use anyhow::Context as _;

use super::record::metric;
use yoro::eyes::{EyePair, GuardBand, SynthesisViews};
use yoro::synthesis::{Gather, Source, Synthesis, Uniforms};
use yoro_gl::{Context, Destination, Filter, Format, RenderTarget};
use yoro_render::{PreparedScene, Selection, ViewTargets};

/// The committed table of `cargo tools shader-cost`.
const TABLE: &str = include_str!("../../../../docs/shader-cost.csv");
/// Pixels of a tile, one fragment of the first two passes.
const TILE: [u32; 2] = [16, 8];
/// Row pairs of a tile: trips of its loop.
const TILE_TRIPS: f64 = TILE[1] as f64 / 2.0;
/// Bytes that are read and written for each pixel, every texel once: depth for the tiles and for the march, colour, target.
const BYTES: f64 = 16.0;

/// A GPU, and the size of an eye on the device that has it. The rates are assumptions from public figures, one issue slot
/// for each lane and clock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Device {
    /// What it is called in results.
    pub name: &'static str,
    /// [`TABLE`]'s name of the GPU.
    gpu: &'static str,
    /// Pixels of an eye.
    pub size: [u32; 2],
    /// Lanes times clock, per second.
    pub slots: f64,
    /// Texture instructions per second.
    pub fetches: f64,
    /// Bytes of memory per second.
    pub bytes: f64,
}

/// The devices of the suite `shader-cost`.
pub const DEVICES: [Device; 3] = [
    // Adreno 650: 768 lanes at 0.5 GHz.
    Device { name: "quest-2", gpu: "a650", size: [1832, 1920], slots: 0.384e12, fetches: 12e9, bytes: 40e9 },
    // Adreno 740.
    Device { name: "quest-3", gpu: "a740", size: [1680, 1760], slots: 1.0e12, fetches: 28.8e9, bytes: 60e9 },
    // Mali-G57 MC2 at 0.95 GHz: 32 lanes and 4 texels in each of two cores.
    Device { name: "mali-g57", gpu: "g57", size: [1200, 1080], slots: 0.061e12, fetches: 7.6e9, bytes: 17e9 },
];

/// How often the loops of the march run, as [`Gather::counting`] tells it: of one pixel, or the largest of a wave.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Trips {
    short: f64,
    fill: f64,
    /// 1 where a pixel goes the long way.
    goes_on: f64,
    columns: f64,
    rounds: f64,
    tiles: f64,
}

impl Trips {
    fn of([packed, columns, rounds, tiles]: [u8; 4]) -> Trips {
        Trips {
            short: f64::from(packed & 15),
            fill: f64::from(packed >> 4 & 3),
            goes_on: f64::from(packed >> 7),
            columns: columns.into(),
            rounds: rounds.into(),
            tiles: tiles.into(),
        }
    }

    fn max(self, other: Trips) -> Trips {
        Trips {
            short: self.short.max(other.short),
            fill: self.fill.max(other.fill),
            goes_on: self.goes_on.max(other.goes_on),
            columns: self.columns.max(other.columns),
            rounds: self.rounds.max(other.rounds),
            tiles: self.tiles.max(other.tiles),
        }
    }
}

/// Issue slots and texture instructions.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Work {
    slots: f64,
    fetches: f64,
}

impl Work {
    fn plus(self, times: f64, other: Work) -> Work {
        Work { slots: self.slots + times * other.slots, fetches: self.fetches + times * other.fetches }
    }
}

/// A program of the table: what it executes if every loop runs once, and its loops.
#[derive(Clone, Debug, PartialEq)]
struct Listing {
    all: Work,
    loops: Vec<Work>,
    lanes: u32,
}

impl Listing {
    /// The program's row; of a loop what stands in loops inside it is left out.
    fn of(gpu: &str, program: &str) -> anyhow::Result<Listing> {
        let find = || {
            let columns = TABLE.lines().map(|line| line.split(',').collect::<Vec<_>>());
            let row =
                columns.into_iter().find(|row| row.len() == 12 && row[0] == gpu && row[1] == program)?;
            let mut loops: Vec<Work> = Vec::new();
            let mut outermost = 0;
            for text in row[11].split_whitespace() {
                let body = text.trim_start_matches('>');
                let (slots, fetches) = body.split_once('/')?;
                let work = Work { slots: slots.parse().ok()?, fetches: fetches.parse().ok()? };
                match text.len() - body.len() {
                    0 => outermost = loops.len(),
                    1 => loops[outermost] = loops[outermost].plus(-1.0, work),
                    _ => return None,
                }
                loops.push(work);
            }
            let all = Work { slots: row[4].parse().ok()?, fetches: row[8].parse().ok()? };
            // Mali's waves have 16 lanes; its rows do not say so.
            Some(Listing { all, loops, lanes: row[7].parse().unwrap_or(16) })
        };
        find().with_context(|| format!("docs/shader-cost.csv has no readable row {gpu},{program}: renew it with cargo tools shader-cost --bless"))
    }

    /// What stands outside of the loops.
    fn straight(&self) -> Work {
        self.loops.iter().fold(self.all, |work, body| work.plus(-1.0, *body))
    }

    /// Columns and rows of the pixels of a wave.
    fn wave(&self) -> [u32; 2] {
        match self.lanes {
            128 => [16, 8],
            64 => [8, 8],
            _ => [4, 4],
        }
    }
}

/// The passes' programs on a GPU.
struct Programs {
    tiles: Listing,
    spans: Listing,
    march: Listing,
    /// The march as far as every pixel runs it.
    short_way: Listing,
}

impl Programs {
    fn of(gpu: &str) -> anyhow::Result<Programs> {
        let march = "synthesis/gather/march.frag TEXTURE_GATHER SHORT_WAY";
        Ok(Programs {
            tiles: Listing::of(gpu, "synthesis/gather/tiles.frag TEXTURE_GATHER")?,
            spans: Listing::of(gpu, "synthesis/gather/spans.frag")?,
            march: Listing::of(gpu, march)?,
            short_way: Listing::of(gpu, &format!("{march} SHORT_WAY_ALONE"))?,
        })
    }

    /// What a wave executes for each of its pixels at least: of each loop the most that one of its pixels runs it. Lanes
    /// that walk in different rounds wait for each other, too.
    fn wave(&self, trips: Trips) -> Work {
        // The columns' loop is there twice, of the first tiles and in each later round.
        let [short, columns, round, tiles, fill] = [0, 1, 2, 3, 5].map(|i| self.march.loops[i]);
        let every = self.short_way.straight().plus(trips.short, short);
        let rest = self.march.straight().plus(-1.0, self.short_way.straight());
        (every.plus(trips.goes_on, rest).plus(trips.rounds, round))
            .plus(trips.columns, columns)
            .plus(trips.tiles, tiles)
            .plus(trips.fill, fill)
    }
}

/// Columns and rows of an image of counts.
struct Counts<'a> {
    pixels: &'a [u8],
    size: [u32; 2],
}

impl Counts<'_> {
    /// The largest counts of each wave.
    fn waves(&self, wave: [u32; 2]) -> Vec<Trips> {
        let [width, height] = self.size;
        let across = width.div_ceil(wave[0]) as usize;
        let mut waves = vec![Trips::default(); across * height.div_ceil(wave[1]) as usize];
        for (i, pixel) in self.pixels.as_chunks().0.iter().enumerate() {
            let (x, y) = (i as u32 % width, i as u32 / width);
            let largest = &mut waves[(y / wave[1]) as usize * across + (x / wave[0]) as usize];
            *largest = largest.max(Trips::of(*pixel));
        }
        waves
    }
}

/// Mean over the columns of tiles of the target: trips of the loop of the second pass (`synthesis/gather/spans.frag`).
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

/// Counts what `gather` executes on a device.
pub struct Meter {
    device: Device,
    programs: Programs,
    gather: Gather,
    targets: ViewTargets,
    counts: RenderTarget,
}

impl Meter {
    /// Compiles the pipeline that counts.
    ///
    /// # Errors
    /// When the driver refuses it, or has no OpenGL ES 3.1; when the table lacks a program.
    pub fn new(gl: &Rc<Context>, device: Device) -> anyhow::Result<Meter> {
        Ok(Meter {
            device,
            programs: Programs::of(device.gpu)?,
            gather: Gather::counting(gl)?,
            targets: ViewTargets::default(),
            counts: RenderTarget::new(gl, [1, 1], &[(Format::Rgba8, Filter::Nearest)], None)?,
        })
    }

    /// Values of one frame, by metric.
    ///
    /// # Errors
    /// When the eyes cannot be synthesized, or GL refuses.
    pub fn measure(
        &mut self,
        prepared: &mut PreparedScene,
        pair: &EyePair,
    ) -> anyhow::Result<Vec<(&'static str, f64)>> {
        let views = pair.synthesis(GuardBand::Distance(1.0))?;
        let PreparedScene { renderer, scene } = prepared;
        let rendered = renderer.render(&mut self.targets, scene, &views.source, Selection::All)?;
        self.counts.resize(pair.size)?;
        let source = Source::new(rendered.color.color(0).raw(), rendered.depth.raw());
        self.gather.synthesize(source, &views.warp, &Destination::whole(&self.counts))?;
        let pixels = self.counts.read_rgba8(0, [0, 0], pair.size);
        let counts = Counts { pixels: &pixels, size: pair.size };

        let Meter { device, programs, .. } = self;
        let waves = counts.waves(programs.march.wave());
        let each = counts.waves([1, 1]);
        let march: Vec<Work> = waves.iter().map(|wave| programs.wave(*wave)).collect();
        let march = Work {
            slots: mean(march.iter().map(|work| work.slots)),
            fetches: mean(march.iter().map(|work| work.fetches)),
        };
        let tile = 1.0 / f64::from(TILE[0] * TILE[1]);
        let looped = |listing: &Listing, trips: f64| listing.straight().plus(trips, listing.loops[0]);
        let wider = f64::from(views.warp.source_size[0]) / f64::from(pair.size[0]);
        let tiles = Work::default().plus(tile * wider, looped(&programs.tiles, TILE_TRIPS));
        let spans = Work::default().plus(tile, looped(&programs.spans, span_trips(&views)));
        let all = march.plus(1.0, tiles).plus(1.0, spans);
        let ms_of = 1e3 * f64::from(pair.size[0]) * f64::from(pair.size[1]);
        Ok(vec![
            (metric::TRIPS_PIXEL, mean(each.iter().map(|trips| trips.short))),
            (metric::TRIPS_WAVE, mean(waves.iter().map(|trips| trips.short))),
            (metric::GOES_ON_PIXEL, mean(each.iter().map(|trips| trips.goes_on))),
            (metric::GOES_ON_WAVE, mean(waves.iter().map(|trips| trips.goes_on))),
            (metric::LONG_TRIPS_WAVE, mean(waves.iter().map(|trips| trips.columns))),
            (metric::SLOTS_TILES, tiles.slots),
            (metric::SLOTS_SPANS, spans.slots),
            (metric::SLOTS_MARCH, march.slots),
            (metric::SLOTS, all.slots),
            (metric::FETCHES, all.fetches),
            (metric::ALU_MS, ms_of * all.slots / device.slots),
            (metric::FETCH_MS, ms_of * all.fetches / device.fetches),
            (metric::MEMORY_MS, ms_of * BYTES / device.bytes),
        ])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_committed_table_has_what_is_needed() {
        for device in DEVICES {
            let programs = Programs::of(device.gpu).unwrap();
            assert_eq!(programs.march.loops.len(), 6, "{}", device.name);
            let [first, later] = [1, 4].map(|i| programs.march.loops[i].slots);
            assert!(
                (0.8..1.25).contains(&(later / first)),
                "{}: one text, {first} and {later} slots",
                device.name
            );
            assert_eq!(programs.short_way.loops.len(), 1, "{}", device.name);
            assert_eq!([&programs.tiles, &programs.spans].map(|listing| listing.loops.len()), [1, 1]);
            let (all, short) = (programs.march.straight(), programs.short_way.straight());
            assert!(all.slots > short.slots && short.slots > 30.0, "{}: {all:?}, {short:?}", device.name);
            assert!(
                all.fetches > short.fetches && short.fetches >= 2.0,
                "{}: {all:?}, {short:?}",
                device.name
            );
        }
        assert!(Programs::of("a999").is_err());
    }

    #[test]
    fn a_wave_takes_the_trips_of_its_slowest_pixel() {
        let mut pixels = vec![0u8; 6 * 3 * 4];
        let mut set = |x: usize, y: usize, counts: [u8; 4]| {
            pixels[(y * 6 + x) * 4..][..4].copy_from_slice(&counts);
        };
        set(0, 0, [3, 0, 0, 0]);
        set(3, 2, [1 | 2 << 4 | 128, 9, 2, 7]);
        set(5, 1, [2, 0, 0, 0]);
        let counts = Counts { pixels: &pixels, size: [6, 3] };
        let long = Trips { short: 3.0, fill: 2.0, goes_on: 1.0, columns: 9.0, rounds: 2.0, tiles: 7.0 };
        assert_eq!(counts.waves([4, 4]), [long, Trips { short: 2.0, ..Trips::default() }]);
        assert_eq!(counts.waves([1, 1]).len(), 18);
    }

    #[test]
    fn work_adds_up() {
        let body = |slots, fetches| Work { slots, fetches };
        // The third one with two loops inside.
        let loops = [(20.0, 1.0), (50.0, 1.0), (40.0, 1.0), (60.0, 1.0), (50.0, 1.0), (70.0, 4.0)];
        let march = Listing {
            all: body(390.0, 13.0),
            loops: loops.map(|(slots, fetches)| body(slots, fetches)).to_vec(),
            lanes: 128,
        };
        let short_way = Listing { all: body(100.0, 4.0), loops: vec![body(20.0, 1.0)], lanes: 128 };
        let programs = Programs { tiles: march.clone(), spans: march.clone(), march, short_way };
        let short = Trips { short: 2.0, ..Trips::default() };
        assert_eq!(programs.wave(short), body(80.0 + 40.0, 3.0 + 2.0));
        // Beyond the short way 20 slots and 1 fetch outside of the loops.
        let long = Trips { short: 1.0, fill: 2.0, goes_on: 1.0, columns: 30.0, rounds: 2.0, tiles: 3.0 };
        assert_eq!(
            programs.wave(long),
            body(100.0 + 20.0 + 80.0 + 1500.0 + 180.0 + 140.0, 4.0 + 1.0 + 2.0 + 30.0 + 3.0 + 8.0)
        );
    }
}
