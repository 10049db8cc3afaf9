//! Estimating the cost of whole frames on GPUs that are not available here.

use anyhow::Context as _;

use super::{Runner, left_out};
use crate::bench::contender::Contender;
use crate::bench::entrant::Entrant;
use crate::bench::executed::Meter;
use crate::bench::frame::{FrameModel, GPUS, Lamps, LayersMeter, MULTIVIEW};
use crate::bench::record::{Measurement, Record, metric};
use crate::bench::suite::Job;
use crate::bench::views::Views;
use yoro::eyes::EyePair;
use yoro::synthesis::Edges;
use yoro_files::interrupt;
use yoro_render::stereo::{Method, Pipeline, StereoFrame};
use yoro_render::{DepthReader, PreparedScene, Selection, ViewTargets};

/// The slots of the passes of `gather` as [`Meter`] names them, and the names of the passes.
const GATHER: [(&str, &str); 3] = [
    (metric::SLOTS_TILES, "gather tiles"),
    (metric::SLOTS_SPANS, "gather spans"),
    (metric::SLOTS_MARCH, "gather march"),
];

impl Runner<'_> {
    pub(super) fn whole_frames(&mut self, job: &Job, prepared: &mut PreparedScene) -> anyhow::Result<()> {
        let views = Views::spread(job, prepared)?;
        let model = FrameModel::new()?;
        let mut records = vec![Record::Scene(views.facts(job, prepared))];
        let mut entrants = Vec::new();
        for &contender in &job.contenders {
            let Some((method, options)) = contender.method() else { continue };
            match Entrant::new(self.gl, method, &job.render, &options) {
                Ok(entrant) => entrants.push((contender, entrant)),
                Err(error) => {
                    records.push(left_out(job, contender, &error));
                    self.bar.inc(views.pairs.len() as u64);
                }
            }
        }
        let mut meters = Vec::new();
        if entrants.iter().any(|(contender, _)| is_gather(contender)) {
            for gpu in GPUS {
                meters.push((gpu.gpu, Meter::new(self.gl, gpu)?));
            }
        }
        let mut layers = None;
        if entrants.iter().any(|(contender, _)| layers_of(contender).is_some()) {
            layers = Some(LayersMeter::new(self.gl)?);
        }
        let mut frame = StereoFrame::new(self.gl, job.eyes.size)?;
        let mut measurements: Vec<Measurement> = Vec::new();
        let mut push = |name: &str, metric: String, value: f64| {
            let at = measurements.iter().position(|m| m.contender == name).unwrap_or_else(|| {
                measurements.push(Measurement::new(&job.setting, name, 0));
                measurements.len() - 1
            });
            measurements[at].push(metric, value);
        };
        self.bar.set_message(job.setting.to_string());
        for pair in &views.pairs {
            let mut lamps = self.lamps(prepared, pair)?;
            for (contender, entrant) in &mut entrants {
                interrupt::check()?;
                self.gl.record();
                entrant.render(prepared, pair, &mut frame)?;
                let commands = self.gl.take_record();
                let name = contender.name();
                let costs = model.frame(&commands, pair.size, &mut lamps).with_context(|| name.clone())?;
                costs.into_iter().for_each(|(metric, value)| push(&name, metric, value));
                if *contender == Contender::Method(Method::Instanced) {
                    let costs = model.multiview(&commands, pair.size, &mut lamps)?;
                    costs.into_iter().for_each(|(metric, value)| push(MULTIVIEW, metric, value));
                }
                self.bar.inc(1);
            }
            let counts = meters.first_mut().map(|(_, meter)| meter.count(prepared, pair)).transpose()?;
            let values =
                |meter: &Meter| counts.as_ref().map(|(views, pixels)| meter.values(views, pixels, pair.size));
            for (gpu, meter) in &meters {
                let values = values(meter).unwrap_or_default();
                for (metric, pass) in GATHER {
                    let value =
                        values.iter().find(|(name, _)| *name == metric).map_or(0.0, |(_, value)| *value);
                    for contender in entrants.iter().map(|(contender, _)| contender).filter(|c| is_gather(c))
                    {
                        push(&contender.name(), format!("slots/{gpu}/{pass}"), value);
                    }
                }
            }
            if let Some(layers) = &mut layers {
                let counts = layers.count(prepared, pair)?;
                for contender in entrants.iter().map(|(contender, _)| contender) {
                    let Some(edges) = layers_of(contender) else { continue };
                    for (metric, value) in model.layers(&counts, edges)? {
                        push(&contender.name(), metric, value);
                    }
                }
            }
        }
        self.finish_round(job, 0, records, measurements)
    }

    /// Returns the lights that reach the surfaces visible to the dominant eye.
    fn lamps(&self, prepared: &mut PreparedScene, pair: &EyePair) -> anyhow::Result<Lamps> {
        let view = pair.view(pair.dominant);
        let mut targets = ViewTargets::default();
        let PreparedScene { renderer, scene } = prepared;
        let rendered = renderer.render(&mut targets, scene, &view, Selection::All)?;
        let mut reader = DepthReader::new(self.gl)?;
        reader.copy(rendered.depth, view.size)?;
        Ok(Lamps::new(&view, &reader.read(), &scene.lights))
    }
}

/// True if the contender synthesizes with the pipeline gather from hard edges.
fn is_gather(contender: &Contender) -> bool {
    matches!(contender, Contender::Yoro(Pipeline::Gather) | Contender::Edges(Edges::Hard))
}

/// Returns the kind of edges if the contender synthesizes from layers.
fn layers_of(contender: &Contender) -> Option<Edges> {
    match contender {
        Contender::Edges(edges) if *edges != Edges::Hard => Some(*edges),
        _ => None,
    }
}
