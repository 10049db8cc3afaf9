//! Estimating the cost of whole frames on GPUs that are not available here.

use anyhow::Context as _;

use super::foveation::Way;
use super::{Runner, left_out};
use crate::bench::contender::Contender;
use crate::bench::job::Job;
use crate::bench::prepared::PreparedContender;
use crate::bench::record::{Measurement, Record, metric};
use crate::bench::views::Views;
use yoro::eyes::{DepthConvention, DepthRange, EyePair, FoveationLevel};
use yoro_estimate::{FrameModel, GPUS, Lamps, MULTIVIEW, March, Meter};
use yoro_files::interrupt;
use yoro_render::stereo::{Method, Pipeline, StereoFrame};
use yoro_render::{DepthReader, PreparedScene, Selection, ViewTargets};

/// The contender whose passes are counted.
const GATHER: Contender = Contender::Synthesized(Pipeline::Gather);
/// The slots of the passes of `gather` as [`Meter`] names them, and the names of the passes.
const PASSES: [(&str, &str); 3] = [
    (metric::SLOTS_TILES, "gather tiles"),
    (metric::SLOTS_SPANS, "gather spans"),
    (metric::SLOTS_MARCH, "gather march"),
];

impl Runner<'_> {
    pub(super) fn whole_frames(&mut self, job: &Job, prepared: &mut PreparedScene) -> anyhow::Result<()> {
        let views = Views::spread(job, prepared)?;
        let model = FrameModel::new()?;
        let mut records = vec![Record::Scene(views.facts(job, prepared))];
        let mut contenders = Vec::new();
        for &contender in &job.contenders {
            let Some((method, options)) = contender.method() else { continue };
            match PreparedContender::new(self.gl, method, &job.render, &options) {
                Ok(ready) => contenders.push((contender, ready)),
                Err(error) => {
                    records.push(left_out(job, contender, &error));
                    self.bar.inc(views.pairs.len() as u64);
                }
            }
        }
        let mut meters = Vec::new();
        if contenders.iter().any(|(contender, _)| *contender == GATHER) {
            for gpu in GPUS {
                let meter = Meter::new(self.gl, gpu, prepared.renderer.nearest_depth())?;
                meters.push((gpu.gpu, meter));
            }
        }
        let mut foveated = Way::both(self.gl, job, FoveationLevel::Medium)?;
        let mut frame = StereoFrame::new(self.gl, job.eyes.size)?;
        let mut measurements: Vec<Measurement> = Vec::new();
        let mut push = |name: &str, metric: String, value: f64| {
            let at = measurements.iter().position(|m| m.contender == name).unwrap_or_else(|| {
                measurements.push(Measurement::new(&job.conditions, name, 0));
                measurements.len() - 1
            });
            measurements[at].push(metric, value);
        };
        self.bar.set_message(job.conditions.to_string());
        for pair in &views.pairs {
            let mut lamps = self.lamps(prepared, pair)?;
            let counts = meters.first_mut().map(|(_, meter)| meter.count(prepared, pair)).transpose()?;
            let values = |meter: &Meter, march: March| {
                counts.as_ref().map(|(views, pixels)| meter.values(views, pixels, pair.size, march))
            };
            let find = |values: &[(&str, f64)], metric: &str| {
                values.iter().find(|(name, _)| *name == metric).map_or(0.0, |(_, value)| *value)
            };
            let first = meters.first().and_then(|(_, meter)| values(meter, March::default()));
            let laws = first.map_or(0.0, |values| find(&values, metric::LAW_PIXEL));
            for (contender, ready) in &mut contenders {
                interrupt::check()?;
                let recorder = self.recorder.as_ref().context("whole frames need a recorder")?;
                recorder.start();
                ready.render(prepared, pair, &mut frame)?;
                let commands = recorder.take();
                let name = contender.name();
                let costs =
                    model.frame(&commands, pair.size, &mut lamps, laws).with_context(|| name.clone())?;
                costs.into_iter().for_each(|(metric, value)| push(&name, metric, value));
                if *contender == Contender::Method(Method::Instanced) {
                    let costs = model.multiview(&commands, pair.size, &mut lamps)?;
                    costs.into_iter().for_each(|(metric, value)| push(MULTIVIEW, metric, value));
                }
                if *contender == GATHER {
                    for (gpu, meter) in &meters {
                        let values = values(meter, March::of(&commands)).unwrap_or_default();
                        for (metric, pass) in PASSES {
                            push(&name, format!("slots/{gpu}/{pass}"), find(&values, metric));
                        }
                    }
                }
                self.bar.inc(1);
            }
            for way in &mut foveated {
                interrupt::check()?;
                let recorder = self.recorder.as_ref().context("whole frames need a recorder")?;
                recorder.start();
                way.render_levels(prepared, pair)?;
                let commands = recorder.take();
                // Shares of the eye's pixels, and the counts, of the levels that are synthesized.
                let mut levels = Vec::new();
                if way.is_synthesis
                    && let Some((_, meter)) = meters.first_mut()
                {
                    for views in way.views(&reversed(pair))? {
                        let pixels = |size: [u32; 2]| f64::from(size[0]) * f64::from(size[1]);
                        let share = pixels(views.target.size) / pixels(pair.size);
                        levels.push((share, meter.count_views(prepared, &views)?, views));
                    }
                }
                let each = |meter: &Meter, metric: &str| -> Vec<(f64, f64)> {
                    let march = March::of(&commands);
                    let of = levels.iter().map(|(share, counts, views)| {
                        (*share, find(&meter.values(views, counts, views.target.size, march), metric))
                    });
                    of.collect()
                };
                let sum =
                    |parts: &[(f64, f64)]| parts.iter().map(|(share, value)| share * value).sum::<f64>();
                let laws = meters.first().map_or(0.0, |(_, meter)| {
                    let parts = each(meter, metric::LAW_PIXEL);
                    sum(&parts) / parts.iter().map(|(share, _)| share).sum::<f64>().max(f64::MIN_POSITIVE)
                });
                let costs =
                    model.frame(&commands, pair.size, &mut lamps, laws).with_context(|| way.name.clone())?;
                costs.into_iter().for_each(|(metric, value)| push(&way.name, metric, value));
                for (gpu, meter) in meters.iter().filter(|_| way.is_synthesis) {
                    for (metric, pass) in PASSES {
                        push(&way.name, format!("slots/{gpu}/{pass}"), sum(&each(meter, metric)));
                    }
                }
                self.bar.inc(1);
            }
        }
        self.finish_round(job, 0, records, measurements)
    }

    /// Returns the lights that reach the surfaces visible to the dominant eye.
    fn lamps(&self, prepared: &mut PreparedScene, pair: &EyePair) -> anyhow::Result<Lamps> {
        let view = reversed(pair).view(pair.dominant);
        let mut targets = ViewTargets::default();
        let PreparedScene { renderer, scene } = prepared;
        let rendered = renderer.render(&mut targets, scene, &view, Selection::All)?;
        let mut reader = DepthReader::new(self.gl)?;
        reader.copy(&rendered.depth, view.size)?;
        Ok(Lamps::new(&view, &reader.read(), &scene.lights))
    }
}

/// Returns the eyes with the only depth that can be carried.
fn reversed(pair: &EyePair) -> EyePair {
    let depth = DepthRange { convention: DepthConvention::Reversed, ..pair.depth };
    EyePair { depth, ..*pair }
}
