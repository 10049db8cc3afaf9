//! The figures of one run, and the reasons for excluding it.

use std::collections::BTreeMap;

use serde::Serialize;

use crate::capture::{Capture, FaultKind, Outcome, RunInfo, Sample};
use crate::farm;
use crate::reading::LEAST_MILLIVOLTS;
use yoro_report::stats::{mean, median};

/// Voltage that the paper uses to compute energy from battery percent.
pub const PAPER_VOLTS: f64 = 3.7;
/// Minimum fraction of the planned time for which a run must have frame rates.
pub const LEAST_COVERED: f64 = 0.8;
/// Maximum relative difference between current x voltage and the charge counter that is not reported.
pub const COUNTER_TOLERANCE: f64 = 0.1;
/// Factor from milliampere-hours to microampere-hours.
pub const MILLI: f64 = 1e3;
/// Minimum charge of a full battery in microampere-hours. If the counter implies less, it counts milliampere-hours.
const LEAST_FULL_UAH: f64 = 100_000.0;
/// Relative tolerance for recognising the counter of one cell by the battery's capacity divided by the number of cells.
const CELL_TOLERANCE: f64 = 0.25;
/// Ratio of another power estimate to current x voltage that suggests the current of one of two cells.
const TWICE: std::ops::Range<f64> = 1.6..2.6;
/// Two samples enclose a gap, which is not bridged, if their distance exceeds the usual one by this factor.
const GAP: f64 = 2.5;

/// A measured quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Quantity {
    Power,
    Fps,
    Stale,
    FrameTime,
    /// 99th percentile of the times between frames, mean over the seconds.
    FrameTimeP99,
    GpuTime,
    Temperature,
    Rise,
    Cpu,
    Memory,
}

/// How a quantity is shown in tables.
pub struct Shown {
    pub name: &'static str,
    pub unit: &'static str,
    pub decimals: usize,
    /// True if two values are compared by their ratio. Temperatures, whose zero is arbitrary, and stale frames, which may
    /// be 0, are compared by their difference.
    pub is_ratio: bool,
}

impl Quantity {
    /// All quantities in the order of tables.
    pub const ALL: [Quantity; 10] = {
        use Quantity::*;
        [Power, Fps, Stale, FrameTime, FrameTimeP99, GpuTime, Temperature, Rise, Cpu, Memory]
    };

    pub fn shown(self) -> Shown {
        let (name, unit, decimals, is_ratio) = match self {
            Quantity::Power => ("power", "mW", 0, true),
            Quantity::Fps => ("frame rate", "FPS", 1, true),
            Quantity::Stale => ("stale frames", "1/s", 2, false),
            Quantity::FrameTime => ("frame time", "ms", 2, true),
            Quantity::FrameTimeP99 => ("frame time p99", "ms", 2, true),
            Quantity::GpuTime => ("GPU time", "ms", 2, true),
            Quantity::Temperature => ("temperature", "°C", 1, false),
            Quantity::Rise => ("temperature rise", "K", 1, false),
            Quantity::Cpu => ("CPU", "% of a core", 1, true),
            Quantity::Memory => ("memory", "MB", 1, true),
        };
        Shown { name, unit, decimals, is_ratio }
    }
}

/// Power integrated from current x voltage.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Integrated {
    pub milliwatts: f64,
    pub seconds: f64,
}

/// Power from the battery's charge counter.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Counted {
    /// Change of charge x mean voltage / time between the counter's first and last step, in milliwatts.
    pub milliwatts: f64,
    pub integrated_milliwatts: f64,
    /// Time between the counter's first and last step in seconds.
    pub seconds: f64,
    /// Factor from the counter's values to microampere-hours of the whole battery.
    pub scale: f64,
}

impl Counted {
    /// Returns by which fraction the counter's power exceeds current x voltage: 0.1 is 10 %.
    pub fn disagreement(&self) -> f64 {
        self.milliwatts / self.integrated_milliwatts - 1.0
    }
}

/// Power by the paper's method: battery percent x capacity x 3.7 V.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ByLevel {
    pub milliwatts: f64,
    /// The method's resolution: the power, in milliwatts, that uses one percent of the battery in this time.
    pub step_milliwatts: f64,
}

/// An exclusion and its reason.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Exclusion {
    /// True if only the run's power is excluded, false if the whole run is.
    pub power_only: bool,
    pub name: &'static str,
    pub reason: String,
}

/// The figures of one run.
#[derive(Clone, Debug, Serialize)]
pub struct Run {
    pub folder: String,
    /// Index of the given folder that contains the run. The same repetition in another folder counts as a further one.
    pub set: usize,
    /// The device's name in tables.
    pub device_name: String,
    #[serde(flatten)]
    pub info: RunInfo,
    /// Factor on current x voltage: the number of battery cells if the device reports the current of one, otherwise 1.
    pub cells: u32,
    /// Time in seconds for which samples are close enough to each other.
    pub covered_s: f64,
    pub gaps: usize,
    pub values: BTreeMap<Quantity, f64>,
    pub integrated: Option<Integrated>,
    pub counted: Option<Counted>,
    pub by_level: Option<ByLevel>,
    /// Reasons for which the run, or only its power, is excluded.
    pub exclusions: Vec<Exclusion>,
}

impl Run {
    /// Computes the figures of a capture. `cells` is 1 if the device reports the current of the whole battery.
    pub fn of(capture: &Capture, folder: String, set: usize, device_name: String, cells: u32) -> Run {
        let info = &capture.info;
        let window = info.warm_up_s..=info.warm_up_s + info.duration_s;
        let samples: Vec<&Sample> = capture.samples.iter().filter(|s| window.contains(&s.time_s)).collect();
        let longest_step = GAP * usual_step(&samples).unwrap_or(1.0);
        let series = |value: fn(&Sample) -> Option<f64>, factor: f64| -> Vec<(f64, f64)> {
            samples.iter().filter_map(|sample| Some((sample.time_s, factor * value(sample)?))).collect()
        };
        let power = series(milliwatts, f64::from(cells));
        let scale = counter_scale(&samples, info.device.capacity_mah, cells);
        let charge = series(|s| s.charge_uah, scale);
        // By frame rates, since other values may have continued while the application drew nothing.
        let fps = series(|s| s.fps, 1.0);
        let integrated = integrate(&power, longest_step);

        let mut run = Run {
            folder,
            set,
            device_name,
            info: info.clone(),
            cells,
            covered_s: steps(&fps, longest_step).map(|(a, b)| b.0 - a.0).sum(),
            gaps: fps.windows(2).filter(|pair| pair[1].0 - pair[0].0 > longest_step).count(),
            values: BTreeMap::new(),
            integrated,
            counted: count(&charge, &series(voltage, 1.0), &power, longest_step, scale),
            by_level: by_level(&series(|s| s.level_percent, 1.0), info.device.capacity_mah),
            exclusions: Vec::new(),
        };
        if let Some((name, reason)) = run.exclusion_reason() {
            run.leave_out(name, reason);
        } else if let Some((name, reason)) = run.without_power(capture, &samples) {
            run.exclusions.push(Exclusion { power_only: true, name, reason });
        }
        let mean = |value: fn(&Sample) -> Option<f64>| mean(samples.iter().filter_map(|s| value(s)));
        let celsius: Vec<f64> = samples.iter().filter_map(|s| s.battery_celsius).collect();
        let values = [
            (Quantity::Power, integrated.map(|integrated| integrated.milliwatts)),
            (Quantity::Fps, mean(|s| s.fps)),
            (Quantity::Stale, mean(|s| s.stale)),
            // Frame and GPU times are weighted by frames, since a second of slow frames has fewer of them.
            (Quantity::FrameTime, mean_over_frames(&samples, |s| s.frame_ms)),
            (Quantity::FrameTimeP99, mean(|s| s.p99_ms)),
            (Quantity::GpuTime, mean_over_frames(&samples, |s| s.gpu_ms)),
            (Quantity::Temperature, mean(|s| s.battery_celsius)),
            (Quantity::Rise, celsius.first().zip(celsius.last()).map(|(first, last)| last - first)),
            (Quantity::Cpu, mean(|s| s.cpu_percent)),
            (Quantity::Memory, mean(|s| s.rss_mb)),
        ];
        let counts = values.into_iter().filter(|(quantity, _)| run.counts(*quantity));
        run.values = counts.filter_map(|(quantity, value)| Some((quantity, value?))).collect();
        run
    }

    /// True if the run's value of this quantity counts.
    pub fn counts(&self, quantity: Quantity) -> bool {
        self.exclusions.iter().all(|exclusion| exclusion.power_only && quantity != Quantity::Power)
    }

    /// Returns the run's name in sentences.
    pub fn name(&self) -> String {
        let RunInfo { scene, method, repetition, .. } = &self.info;
        format!("{}, {scene}, {method}, repetition {repetition}", self.device_name)
    }

    /// Returns the name of another power estimate that is about twice current x voltage, which suggests that the
    /// current is that of one of two cells.
    pub fn twice_by(&self) -> Option<&'static str> {
        let integrated = self.integrated?.milliwatts;
        if self.counted.is_some_and(|counted| TWICE.contains(&(1.0 + counted.disagreement()))) {
            return Some("the charge counter");
        }
        // The level is in whole percents, so it may be off by one.
        let ByLevel { milliwatts, step_milliwatts } = self.by_level?;
        let is_sure = (milliwatts - step_milliwatts) / integrated > TWICE.start / 1.1;
        (is_sure && TWICE.contains(&(milliwatts / integrated))).then_some("the battery's level")
    }

    pub fn leave_out(&mut self, name: &'static str, reason: String) {
        self.exclusions.push(Exclusion { power_only: false, name, reason });
        self.values.clear();
    }

    /// Returns the first fault of a kind at this time or later, or of the whole run.
    fn fault(&self, kind: FaultKind, from_s: f64) -> Option<(&'static str, String)> {
        let is_it = |at_s: Option<f64>| at_s.is_none_or(|at| at >= from_s);
        let found = self.info.faults.iter().find(|fault| fault.kind == kind && is_it(fault.at_s))?;
        Some((kind.name(), found.detail.clone()))
    }

    /// Returns why the whole run is excluded. This is the first reason found, since further ones may follow from it.
    fn exclusion_reason(&self) -> Option<(&'static str, String)> {
        match &self.info.outcome {
            Outcome::Complete => {}
            Outcome::Interrupted { reason } => return Some(("interrupted", reason.clone())),
            Outcome::Failed { reason } => return Some(("failed", reason.clone())),
        }
        if self.info.method.starts_with(farm::PICTURE_CHECK) {
            let reason =
                "a few seconds that check a pipeline's pictures, warm-up included; scenario 2 measures";
            return Some(("picture check", reason.into()));
        }
        let (covered, planned) = (self.covered_s, self.info.duration_s);
        let too_short = || ("too short", format!("{covered:.0} s of {planned:.0} s have frame rates"));
        // Faults in the warm-up do not affect the measurement.
        let fault = self.fault(FaultKind::Rebooted, 0.0);
        let fault = fault.or_else(|| self.fault(FaultKind::Restarted, self.info.warm_up_s));
        fault.or_else(|| (covered < LEAST_COVERED * planned).then(too_short))
    }

    /// Returns why the run's power is excluded.
    fn without_power(&self, capture: &Capture, samples: &[&Sample]) -> Option<(&'static str, String)> {
        if let Some(plugged_in) = self.fault(FaultKind::PluggedIn, 0.0) {
            return Some(plugged_in);
        }
        let plugged =
            capture.samples.iter().filter(|s| s.plugged.is_some_and(|plugged| plugged != 0)).count();
        if plugged > 0 {
            return Some(("plugged in", format!("a charger was plugged in for {plugged} samples")));
        }
        let Some(Integrated { milliwatts, seconds }) = self.integrated else {
            if samples.iter().all(|s| s.current_ma.is_none()) {
                return Some(("no current", "the device does not give the battery's current".into()));
            }
            let volts = self.fault(FaultKind::VoltageInVolts, 0.0);
            let missing = "the device does not give current and voltage together";
            return volts.or_else(|| Some(("no current", missing.into())));
        };
        let planned = self.info.duration_s;
        if seconds < LEAST_COVERED * planned {
            let missing = format!("{seconds:.0} s of {planned:.0} s have current and voltage");
            return Some(("current missing", missing));
        }
        (milliwatts <= 0.0).then(|| ("charging", "on the mean, the battery was charged".into()))
    }
}

/// Returns the power taken from the battery in milliwatts.
fn milliwatts(sample: &Sample) -> Option<f64> {
    Some(-sample.current_ma? * voltage(sample)? / 1e3)
}

/// Returns the voltage in millivolts. Whole volts are ignored as too coarse.
fn voltage(sample: &Sample) -> Option<f64> {
    sample.voltage_mv.filter(|voltage| *voltage >= LEAST_MILLIVOLTS)
}

/// Returns the factor from the charge counter to microampere-hours of the whole battery. The counter divided by the
/// level is the charge of a full battery, which reveals a counter in milliampere-hours or of a single cell.
fn counter_scale(samples: &[&Sample], capacity_mah: Option<f64>, cells: u32) -> f64 {
    let full = |s: &&Sample| Some(s.charge_uah? / (s.level_percent.filter(|level| *level > 0.0)? / 100.0));
    let full: Vec<f64> = samples.iter().filter_map(full).collect();
    let Some(full) = median(&full) else { return 1.0 };
    let unit = if full < LEAST_FULL_UAH { MILLI } else { 1.0 };
    let one_cell = capacity_mah.map(|capacity| capacity * 1e3 / f64::from(cells));
    let is_one_cell = one_cell.is_some_and(|one| (full * unit / one - 1.0).abs() < CELL_TOLERANCE);
    if cells > 1 && is_one_cell { unit * f64::from(cells) } else { unit }
}

fn usual_step(samples: &[&Sample]) -> Option<f64> {
    let steps: Vec<f64> = samples.windows(2).map(|pair| pair[1].time_s - pair[0].time_s).collect();
    median(&steps).filter(|step| *step > 0.0)
}

/// Returns all pairs of neighbours with no gap between them.
fn steps(series: &[(f64, f64)], longest: f64) -> impl Iterator<Item = ((f64, f64), (f64, f64))> + Clone + '_ {
    let pairs = series.windows(2).map(|pair| (pair[0], pair[1]));
    pairs.filter(move |(a, b)| b.0 > a.0 && b.0 - a.0 <= longest)
}

/// Integrates power by trapezoids over the samples' actual times.
fn integrate(power: &[(f64, f64)], longest: f64) -> Option<Integrated> {
    let steps = steps(power, longest);
    let seconds: f64 = steps.clone().map(|(a, b)| b.0 - a.0).sum();
    let millijoules: f64 = steps.map(|(a, b)| (a.1 + b.1) / 2.0 * (b.0 - a.0)).sum();
    (seconds > 0.0).then(|| Integrated { milliwatts: millijoules / seconds, seconds })
}

/// Computes power between the counter's first and last step, where it is exact. Ignores steps of unknown time in gaps.
fn count(
    charge: &[(f64, f64)],
    voltage: &[(f64, f64)],
    power: &[(f64, f64)],
    longest: f64,
    scale: f64,
) -> Option<Counted> {
    let changes: Vec<(f64, f64)> =
        steps(charge, longest).filter(|(a, b)| a.1 != b.1).map(|(_, b)| b).collect();
    let (first, last) = (*changes.first()?, *changes.last()?);
    let between = |series: &[(f64, f64)]| -> Vec<(f64, f64)> {
        series.iter().copied().filter(|(time, _)| (first.0..=last.0).contains(time)).collect()
    };
    let seconds = last.0 - first.0;
    let volts = mean(between(voltage).into_iter().map(|(_, millivolts)| millivolts / 1e3))?;
    (seconds > 0.0).then_some(Counted {
        milliwatts: (first.1 - last.1) / 1e3 * volts * 3600.0 / seconds,
        integrated_milliwatts: integrate(&between(power), longest)?.milliwatts,
        seconds,
        scale,
    })
}

fn by_level(level: &[(f64, f64)], capacity_mah: Option<f64>) -> Option<ByLevel> {
    let (first, last) = (level.first()?, level.last()?);
    let hours = (last.0 - first.0) / 3600.0;
    let percent_milliwatts = capacity_mah? / 100.0 * PAPER_VOLTS / hours;
    (hours > 0.0).then_some(ByLevel {
        milliwatts: (first.1 - last.1) * percent_milliwatts,
        step_milliwatts: percent_milliwatts,
    })
}

/// Returns the mean over the seconds, weighted by their frames.
fn mean_over_frames(samples: &[&Sample], value: fn(&Sample) -> Option<f64>) -> Option<f64> {
    let pairs = samples.iter().filter_map(|sample| Some((sample.fps?, value(sample)?)));
    let (frames, sum) = pairs.fold((0.0, 0.0), |(frames, sum), (fps, v)| (frames + fps, sum + fps * v));
    (frames > 0.0).then(|| sum / frames)
}
