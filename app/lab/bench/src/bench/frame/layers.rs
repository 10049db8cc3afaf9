//! The cost of synthesis from layers. The runs of its loops are counted by its own shaders on real frames.

use std::rc::Rc;

use crate::bench::costs::{Costs, Parts};
use crate::bench::executed::{Counting, TILE, span_trips};
use crate::bench::waves::{combine, wave_size};
use yoro::eyes::EyePair;
use yoro::synthesis::{Edges, Layers};
use yoro_gl::Context;
use yoro_render::PreparedScene;

/// The share of the march's code outside of loops that is run by waves that end in the first loop: an estimate from the
/// listings.
const PLAIN_SHARE: f64 = 0.5;

/// Counts the loops of the march over layers. All kinds of edges count like [`Edges::Nearest`].
pub struct LayersMeter {
    counting: Counting<Layers>,
}

/// The counts of one frame.
pub struct LayerCounts {
    /// The pixels that [`Layers::counting`] writes.
    pixels: Vec<u8>,
    size: [u32; 2],
    /// The source's width divided by the target's.
    wider: f64,
    span_trips: f64,
}

impl LayersMeter {
    /// Compiles the counting pipeline.
    ///
    /// # Errors
    /// If the driver refuses it.
    pub fn new(gl: &Rc<Context>) -> anyhow::Result<LayersMeter> {
        Ok(LayersMeter { counting: Counting::new(gl, Layers::counting(gl, Edges::Nearest)?)? })
    }

    /// Counts one frame.
    ///
    /// # Errors
    /// If the eyes cannot be synthesized, or GL refuses.
    pub fn count(&mut self, prepared: &mut PreparedScene, pair: &EyePair) -> anyhow::Result<LayerCounts> {
        let (views, pixels) = self.counting.count(prepared, pair)?;
        Ok(LayerCounts {
            pixels,
            size: pair.size,
            wider: f64::from(views.warp.source_size[0]) / f64::from(pair.size[0]),
            span_trips: span_trips(&views),
        })
    }
}

impl LayerCounts {
    /// Returns the issue slots per pixel of the target, by pass.
    ///
    /// # Errors
    /// If the table lacks a shader.
    pub fn slots(&self, costs: &Costs, edges: Edges) -> anyhow::Result<[(&'static str, f64); 4]> {
        let macros: &[&str] = if edges == Edges::Multisample { &["MULTISAMPLE"] } else { &[] };
        let split = costs.parts("synthesis/layers/split.frag", macros)?;
        let tiles = costs.parts("synthesis/layers/tiles.frag", &[])?;
        let spans = costs.parts("synthesis/gather/spans.frag", &[])?;
        let march = costs.parts("synthesis/layers/march.frag", macros)?;
        // The trips of the loops at a pixel with two surfaces: taps of the estimates, taps if nothing else is found
        // (not counted), neighbours. If all samples are read: taps.
        let trips: &[f64] = if edges == Edges::Multisample { &[8.0] } else { &[12.0, 0.0, 2.0] };
        let of_split =
            |wave: &Wave| split.straight.slots + if wave.split { looped(&split, trips) } else { 0.0 };
        let tile = 1.0 / f64::from(TILE[0] * TILE[1]);
        Ok([
            ("layers split", self.wider * self.mean(split.lanes, of_split)),
            (
                "layers tiles",
                self.wider * tile * (tiles.straight.slots + looped(&tiles, &[f64::from(TILE[1])])),
            ),
            ("layers spans", tile * (spans.straight.slots + looped(&spans, &[self.span_trips]))),
            ("layers march", self.mean(march.lanes, |wave| march_slots(&march, wave))),
        ])
    }

    fn mean(&self, lanes: u32, slots: impl Fn(&Wave) -> f64) -> f64 {
        let pixels = self.pixels.as_chunks::<4>().0.iter();
        let waves =
            combine(pixels, self.size[0], wave_size(lanes), |wave: &mut Wave, pixel| wave.include(*pixel));
        waves.iter().map(slots).sum::<f64>() / waves.len().max(1) as f64
    }
}

/// The largest counts among a wave's pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Wave {
    plain: u8,
    events: u8,
    pairs: u8,
    rows: u8,
    split: bool,
}

impl Wave {
    fn include(&mut self, [plain, events, pairs, rows]: [u8; 4]) {
        self.plain = self.plain.max(plain);
        self.events = self.events.max(events);
        self.pairs = self.pairs.max(pairs);
        self.rows = self.rows.max(rows & 127);
        self.split |= rows > 127;
    }
}

fn looped(parts: &Parts, trips: &[f64]) -> f64 {
    parts.loops.iter().zip(trips).map(|(body, trips)| body.slots * trips).sum()
}

/// Returns the issue slots that a wave spends on the march.
fn march_slots(march: &Parts, wave: &Wave) -> f64 {
    let goes_on = wave.events > 0 || wave.rows > 0;
    let straight = march.straight.slots * if goes_on { 1.0 } else { PLAIN_SHARE };
    // The loop to the next event is nested in the loop over events, and follows it in the listing.
    let trips = [wave.plain, wave.events, wave.pairs, wave.rows].map(f64::from);
    straight + looped(march, &trips)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::costs::Work;

    #[test]
    fn a_wave_runs_each_loop_as_often_as_its_slowest_pixel() {
        let work = |slots| Work { slots, fetches: 0.0 };
        let march =
            Parts { straight: work(200.0), loops: [10.0, 100.0, 20.0, 30.0].map(work).into(), lanes: 128 };
        let mut wave = Wave::default();
        wave.include([3, 0, 0, 0]);
        assert_eq!(march_slots(&march, &wave), 100.0 + 30.0);
        wave.include([1, 2, 7, 128 | 5]);
        assert!(wave.split);
        assert_eq!(march_slots(&march, &wave), 200.0 + 30.0 + 200.0 + 140.0 + 150.0);
    }
}
