//! Measuring along a part of the camera path, and counting what the synthesis executes.

use image::RgbImage;

use super::{Runner, eye_image};
use crate::bench::holes::HoleFinder;
use crate::bench::job::Job;
use crate::bench::record::{Measurement, Record, metric};
use crate::bench::views::{self, Views};
use yoro_estimate::{Device, Meter};
use yoro_files::interrupt;
use yoro_metrics::FlickerMeter;
use yoro_render::PreparedScene;

impl Runner<'_> {
    pub(super) fn flicker(&mut self, job: &Job, prepared: &mut PreparedScene) -> anyhow::Result<()> {
        let views = Views::along_path(job, prepared, views::STEP)?;
        let mut field = self.field(job, prepared, &views, false)?;
        let mut finder = HoleFinder::new(self.gl)?;
        let mut measurements = field.measurements(job, 0);
        let mut last: Option<(Vec<RgbImage>, Vec<bool>)> = None;
        self.bar.set_message(job.conditions.to_string());
        for (i, pair) in views.pairs.iter().enumerate() {
            prepared.set_time(i as f64 / views::STEP_RATE)?;
            let holes = finder.find(prepared, pair)?;
            let mut images = Vec::new();
            for (_, ready) in &mut field.contenders {
                interrupt::check()?;
                ready.render(prepared, pair, &mut field.frame)?;
                images.push(eye_image(&field.frame, pair.dominant.other()));
                self.bar.inc(1);
            }
            if let Some((before, holes_before)) = &last {
                let meter = FlickerMeter::new([&before[0], &images[0]], [holes_before, &holes])?;
                measurements[0].push_flicker(&metric::CHANGES, &meter.change());
                for at in 1..images.len() {
                    let flicker = meter.flicker([&before[at], &images[at]])?;
                    measurements[at].push_flicker(&metric::FLICKERS, &flicker);
                }
            }
            last = Some((images, holes));
        }
        prepared.set_time(0.0)?;
        self.finish_round(job, 0, field.first, measurements)
    }

    pub(super) fn executed(
        &mut self,
        job: &Job,
        device: &Device,
        prepared: &mut PreparedScene,
    ) -> anyhow::Result<()> {
        let views = Views::spread(job, prepared)?;
        let mut meter = Meter::new(self.gl, *device, prepared.renderer.nearest_depth())?;
        let mut measurement = Measurement::new(&job.conditions, device.name, 0);
        self.bar.set_message(job.conditions.to_string());
        for pair in &views.pairs {
            interrupt::check()?;
            for (name, value) in meter.measure(prepared, pair)? {
                measurement.push(name, value);
            }
            self.bar.inc(1);
        }
        self.finish_round(job, 0, vec![Record::Scene(views.facts(job, prepared))], vec![measurement])
    }
}
