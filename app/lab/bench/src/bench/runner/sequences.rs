//! Measuring along a part of the camera path, and counting what the synthesis executes.

use image::RgbImage;

use super::{Runner, milliseconds};
use crate::bench::bandwidth;
use crate::bench::contender::Band;
use crate::bench::executed::{Device, Meter};
use crate::bench::holes::HoleFinder;
use crate::bench::motion::Motion;
use crate::bench::record::{Measurement, Record, metric};
use crate::bench::suite::Job;
use crate::bench::views::{self, Views};
use crate::metrics::{Channels, Comparison, FlickerMeter, psnr};
use crate::picture;
use yoro::eyes::{Eye, EyePair};
use yoro_files::interrupt;
use yoro_render::PreparedScene;

impl Runner<'_> {
    pub(super) fn flicker(&mut self, job: &Job, prepared: &mut PreparedScene) -> anyhow::Result<()> {
        let views = Views::along_path(job, prepared, views::STEP)?;
        let mut field = self.field(job, prepared, &views, false)?;
        let mut finder = HoleFinder::new(self.gl)?;
        let mut measurements = field.measurements(job, 0);
        let mut last: Option<(Vec<RgbImage>, Vec<bool>)> = None;
        self.bar.set_message(job.setting.to_string());
        for (i, pair) in views.pairs.iter().enumerate() {
            prepared.set_time(i as f64 / views::STEP_RATE)?;
            let holes = finder.find(prepared, pair)?;
            let mut images = Vec::new();
            for (_, entrant) in &mut field.entrants {
                interrupt::check()?;
                entrant.render(prepared, pair, &mut field.frame)?;
                images.push(picture::eye_image(&field.frame, pair.dominant.other()));
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

    /// Renders every contender's frames in order, each once, as a viewer does. The recorded use of the guard band is
    /// that of two frames earlier.
    pub(super) fn guard_band(&mut self, job: &Job, prepared: &mut PreparedScene) -> anyhow::Result<()> {
        let views = Views::along_path(job, prepared, views::HEADSET_STEP)?;
        let mut field = self.field(job, prepared, &views, true)?;
        let mut measurements = field.measurements(job, 0);
        self.bar.set_message(job.setting.to_string());
        let count = field.entrants.len();
        for (i, pair) in views.pairs.iter().enumerate() {
            prepared.set_time(i as f64 / views::HEADSET_RATE)?;
            let mut images = vec![RgbImage::default(); count];
            for turn in 0..count {
                interrupt::check()?;
                let at = (turn + i) % count;
                let entrant = &mut field.entrants[at].1;
                let time = entrant.render(prepared, pair, &mut field.frame)?;
                measurements[at].push(metric::FRAME_MS, milliseconds(time.wall));
                if let Some(used) = entrant.guard_band() {
                    measurements[at].push(metric::GUARD_COLUMNS, f64::from(used.columns));
                    measurements[at].push(metric::UNDRAWN, f64::from(used.undrawn));
                }
                images[at] = picture::eye_image(&field.frame, pair.dominant.other());
                self.bar.inc(1);
            }
            let truth = border(&images[0], pair)?;
            for at in 1..count {
                measurements[at].push(metric::PSNR, psnr(&images[at], &images[0], Channels::Rgb)?.0);
                let border = psnr(&border(&images[at], pair)?, &truth, Channels::Rgb)?;
                measurements[at].push(metric::BORDER_PSNR, border.0);
            }
        }
        prepared.set_time(0.0)?;
        self.finish_round(job, 0, field.first, measurements)
    }

    /// Renders every contender's frames in order, each once, as a viewer does, and compares those after the history is
    /// filled.
    pub(super) fn history(
        &mut self,
        job: &Job,
        motion: Motion,
        prepared: &mut PreparedScene,
    ) -> anyhow::Result<()> {
        let views = Views::of_motion(job, prepared, motion)?;
        let [settling, measured] = views.split_at_last(job.frames);
        let mut field = self.field(job, prepared, &measured, true)?;
        self.bar.set_message(job.setting.to_string());
        let count = field.entrants.len();
        for (i, pair) in settling.pairs.iter().enumerate() {
            prepared.set_time(i as f64 / views::HEADSET_RATE)?;
            for (_, entrant) in &mut field.entrants {
                interrupt::check()?;
                entrant.render(prepared, pair, &mut field.frame)?;
            }
        }
        let mut measurements = field.measurements(job, 0);
        let mut finder = HoleFinder::new(self.gl)?;
        let mut last: Option<(Vec<RgbImage>, Vec<bool>)> = None;
        for (i, pair) in measured.pairs.iter().enumerate() {
            prepared.set_time((settling.pairs.len() + i) as f64 / views::HEADSET_RATE)?;
            let mut images = vec![RgbImage::default(); count];
            for turn in 0..count {
                interrupt::check()?;
                let at = (turn + i) % count;
                let entrant = &mut field.entrants[at].1;
                let time = entrant.render(prepared, pair, &mut field.frame)?;
                measurements[at].push(metric::FRAME_MS, milliseconds(time.wall));
                if let Some(used) = entrant.history() {
                    let served = 1.0 - f64::from(used.unknown) / f64::from(used.uncovered);
                    measurements[at].push(metric::SERVED, served);
                    let eye = f64::from(pair.size[0]) * f64::from(pair.size[1]);
                    measurements[at].push(metric::RENDERED_BESIDES, f64::from(used.rendered) / eye);
                }
                images[at] = picture::eye_image(&field.frame, pair.dominant.other());
                self.bar.inc(1);
            }
            let holes = finder.find(prepared, pair)?;
            for at in 1..count {
                interrupt::check()?;
                measurements[at].push_comparison(&Comparison::of(&images[at], &images[0], Some(&holes))?);
            }
            if let Some((before, holes_before)) = &last {
                let meter = FlickerMeter::new([&before[0], &images[0]], [holes_before, &holes])?;
                measurements[0].push_flicker(&metric::CHANGES, &meter.change());
                for at in 1..count {
                    let flicker = meter.flicker([&before[at], &images[at]])?;
                    measurements[at].push_flicker(&metric::FLICKERS, &flicker);
                }
            }
            last = Some((images, holes));
        }
        let pictures = last.map(|(images, _)| images).unwrap_or_default();
        for ((contender, _), image) in field.entrants.iter().zip(&pictures) {
            self.save_picture(job, *contender, image)?;
        }
        prepared.set_time(0.0)?;
        self.finish_round(job, 0, field.first, measurements)
    }

    pub(super) fn bandwidth(&mut self, job: &Job, prepared: &mut PreparedScene) -> anyhow::Result<()> {
        let views = Views::along_path(job, prepared, views::STEP)?;
        self.bar.set_message(job.setting.to_string());
        let bar = &self.bar;
        let mut step = || -> anyhow::Result<()> {
            bar.inc(1);
            Ok(interrupt::check()?)
        };
        let streams = bandwidth::run(self.gl, prepared, &views.pairs, &job.bandwidth, &mut step)?;
        let mut facts = views.facts(job, prepared);
        // Each value is that of a whole sequence at one quantizer.
        facts.frames = job.bandwidth.quantizers.iter().map(|quantizer| format!("QP {quantizer}")).collect();
        let measurement = |(stream, values): (&str, bandwidth::Values)| Measurement {
            values,
            ..Measurement::new(&job.setting, stream, 0)
        };
        let measurements = streams.into_iter().map(measurement).collect();
        self.finish_round(job, 0, vec![Record::Scene(facts)], measurements)
    }

    pub(super) fn executed(
        &mut self,
        job: &Job,
        device: &Device,
        prepared: &mut PreparedScene,
    ) -> anyhow::Result<()> {
        let views = Views::spread(job, prepared)?;
        let mut meter = Meter::new(self.gl, *device)?;
        let mut measurement = Measurement::new(&job.setting, device.name, 0);
        self.bar.set_message(job.setting.to_string());
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

/// Returns the columns at the outer border of the eye that is not dominant in which surfaces at half a metre need a
/// guard band, the widest one that is measured.
fn border(image: &RgbImage, pair: &EyePair) -> anyhow::Result<RgbImage> {
    let width = pair.synthesis_views(Band::HalfMetre.guard_band())?.guard_columns.min(image.width());
    let left = match pair.dominant.other() {
        Eye::Left => 0,
        Eye::Right => image.width() - width,
    };
    Ok(image::imageops::crop_imm(image, left, 0, width, image.height()).to_image())
}
