//! The figures of one run, and the reasons for excluding it.

use crate::farm;
use std::collections::BTreeMap;

use serde::Serialize;

use crate::capture::{Capture, Fault, FaultKind, Outcome, Sample};
use crate::reading::LEAST_MILLIVOLTS;
use yoro_report::stats::median;

/// Voltage that the paper uses to compute energy from battery percent.
pub const PAPER_VOLTS: f64 = 3.7;
/// Minimum fraction of the planned time for which a run must have frame rates.
pub const LEAST_COVERED: f64 = 0.8;
/// Maximum relative difference between current x voltage and the charge counter that is not reported.
pub const COUNTER_TOLERANCE: f64 = 0.1;
/// Factor from milliampere-hours to microampere-hours.
pub(super) const MILLI: f64 = 1e3;
/// Minimum charge of a full battery in microampere-hours. If the counter implies less, it counts milliampere-hours.
const LEAST_FULL_UAH: f64 = 100_000.0;
/// Relative tolerance for recognising the counter of one cell by the battery's capacity divided by the number of cells.
const CELL_TOLERANCE: f64 = 0.25;
/// Ratio of another power estimate to current x voltage that suggests the current of one of two cells.
const TWICE: std::ops::Range<f64> = 1.6..2.6;
/// Two samples enclose a gap, which is not bridged, if their distance exceeds the usual one by this factor.
const GAP: f64 = 2.5;

/// A measured quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Quantity {
    Power,
    Fps,
    FrameTime,
    /// 99th percentile of the times between frames, mean over the seconds.
    FrameTimeP99,
    GpuTime,
    Stale,
    Temperature,
    Rise,
    Cpu,
    Memory,
}

impl Quantity {
    /// All quantities in the order of tables.
    pub const ALL: [Quantity; 10] = {
        use Quantity::*;
        [Power, Fps, FrameTime, FrameTimeP99, GpuTime, Stale, Temperature, Rise, Cpu, Memory]
    };

    /// Returns name and unit in tables, number of decimals, and whether two values are compared by their ratio.
    fn row(self) -> (&'static str, &'static str, usize, bool) {
        match self {
            Quantity::Power => ("power", "mW", 0, true),
            Quantity::Fps => ("frame rate", "FPS", 1, true),
            Quantity::FrameTime => ("frame time", "ms", 2, true),
            Quantity::FrameTimeP99 => ("frame time p99", "ms", 2, true),
            Quantity::GpuTime => ("GPU time", "ms", 2, true),
            Quantity::Stale => ("stale frames", "1/s", 2, false),
            Quantity::Temperature => ("temperature", "°C", 1, false),
            Quantity::Rise => ("temperature rise", "K", 1, false),
            Quantity::Cpu => ("CPU", "% of a core", 1, true),
            Quantity::Memory => ("memory", "MB", 1, true),
        }
    }

    /// Returns the quantity's name in tables.
    pub fn name(self) -> &'static str {
        self.row().0
    }

    /// Returns the quantity's unit in tables.
    pub fn unit(self) -> &'static str {
        self.row().1
    }

    /// Returns the number of decimals in tables.
    pub fn decimals(self) -> usize {
        self.row().2
    }

    /// True if two values are compared by their ratio. Temperatures, whose zero is arbitrary, and stale frames, which
    /// may be 0, are compared by their difference.
    pub fn is_ratio(self) -> bool {
        self.row().3
    }
}

/// Power integrated from current x voltage.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Integrated {
    pub milliwatts: f64,
    pub seconds: f64,
}

impl Integrated {
    /// True if no phone or headset that renders takes this power. Charging, up to 0, is excluded elsewhere.
    pub fn is_implausible(&self) -> bool {
        self.milliwatts > 0.0 && !(100.0..=30_000.0).contains(&self.milliwatts)
    }
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
    pub device: String,
    pub simulated: bool,
    pub experiment: Option<String>,
    pub method: String,
    pub scene: String,
    pub repetition: u32,
    pub started_unix_s: f64,
    /// Factor on current x voltage: the number of battery cells if the device reports the current of one, otherwise 1.
    pub cells: u32,
    pub planned_s: f64,
    /// Time in seconds for which samples are close enough to each other.
    pub covered_s: f64,
    pub gaps: usize,
    pub values: BTreeMap<Quantity, f64>,
    pub integrated: Option<Integrated>,
    pub counted: Option<Counted>,
    pub by_level: Option<ByLevel>,
    pub faults: Vec<Fault>,
    /// Reasons for which the run, or only its power, is excluded.
    pub exclusions: Vec<Exclusion>,
}

impl Run {
    /// Computes the figures of a capture. `cells` is 1 if the device reports the current of the whole battery.
    pub fn of(capture: &Capture, folder: String, set: usize, device: String, cells: u32) -> Run {
        let info = &capture.info;
        let window = info.warm_up_s..=info.warm_up_s + info.duration_s;
        let samples: Vec<&Sample> = capture.samples.iter().filter(|s| window.contains(&s.time_s)).collect();
        let longest_step = GAP * usual_step(&samples).unwrap_or(1.0);
        let series = |value: fn(&Sample) -> Option<f64>| -> Vec<(f64, f64)> {
            samples.iter().filter_map(|sample| Some((sample.time_s, value(sample)?))).collect()
        };
        let mut power = series(milliwatts);
        power.iter_mut().for_each(|(_, milliwatts)| *milliwatts *= f64::from(cells));
        let mut charge = series(|s| s.charge_uah);
        let scale = counter_scale(&samples, info.device.capacity_mah, cells);
        charge.iter_mut().for_each(|(_, charge)| *charge *= scale);
        let fps = series(|s| s.fps);
        let temperature = series(|s| s.battery_celsius);
        // By frame rates, since other values may have continued while the application drew nothing.
        let (covered_s, gaps) = coverage(&fps, longest_step);
        let integrated = integrate(&power, longest_step);

        let mut run = Run {
            folder,
            set,
            device,
            simulated: info.device.simulated,
            experiment: info.experiment.clone(),
            method: info.method.clone(),
            scene: info.scene.clone(),
            repetition: info.repetition,
            started_unix_s: info.started_unix_s,
            cells,
            planned_s: info.duration_s,
            covered_s,
            gaps,
            values: BTreeMap::new(),
            integrated,
            counted: count(&charge, &series(voltage), &power, longest_step)
                .map(|counted| Counted { scale, ..counted }),
            by_level: by_level(&series(|s| s.level_percent), info.device.capacity_mah),
            faults: info.faults.clone(),
            exclusions: Vec::new(),
        };
        if let Some((name, reason)) = run.exclusion_reason(capture) {
            run.leave_out(name, reason);
        } else if let Some((name, reason)) = run.without_power(capture, &samples) {
            run.exclusions.push(Exclusion { power_only: true, name, reason });
        }
        if run.counts(Quantity::Power) {
            run.values.extend(integrated.map(|i| (Quantity::Power, i.milliwatts)));
        }
        if !run.counts(Quantity::Fps) {
            return run;
        }
        // Frame and GPU times are weighted by frames, since a second of slow frames has fewer of them.
        let values = [
            (Quantity::Fps, mean(&fps)),
            (Quantity::FrameTime, mean_over_frames(&samples, |s| s.frame_ms)),
            (Quantity::GpuTime, mean_over_frames(&samples, |s| s.gpu_ms)),
            (Quantity::FrameTimeP99, mean(&series(|s| s.p99_ms))),
            (Quantity::Stale, mean(&series(|s| s.stale))),
            (Quantity::Temperature, mean(&temperature)),
            (Quantity::Cpu, mean(&series(|s| s.cpu_percent))),
            (Quantity::Memory, mean(&series(|s| s.rss_mb))),
        ];
        run.values.extend(values.into_iter().filter_map(|(quantity, value)| Some((quantity, value?))));
        if let (Some(first), Some(last)) = (temperature.first(), temperature.last()) {
            run.values.insert(Quantity::Rise, last.1 - first.1);
        }
        run
    }

    /// True if the run's value of this quantity counts.
    pub fn counts(&self, quantity: Quantity) -> bool {
        self.exclusions.iter().all(|exclusion| exclusion.power_only && quantity != Quantity::Power)
    }

    /// Returns the run's name in sentences.
    pub fn name(&self) -> String {
        format!("{}, {}, {}, repetition {}", self.device, self.scene, self.method, self.repetition)
    }

    /// Returns the name of another power estimate that is about twice current x voltage, which suggests that the
    /// current is that of one of two cells.
    pub(super) fn twice_by(&self) -> Option<&'static str> {
        let integrated = self.integrated?.milliwatts;
        let counted = self.counted.map(|c| c.milliwatts / c.integrated_milliwatts);
        if counted.is_some_and(|ratio| TWICE.contains(&ratio)) {
            return Some("the charge counter");
        }
        // The level is in whole percents, so it may be off by one.
        let by_level = self.by_level?;
        let step = by_level.step_milliwatts;
        let is_sure = (by_level.milliwatts - step) / integrated > TWICE.start / 1.1;
        let is_close = TWICE.contains(&(by_level.milliwatts / integrated));
        (is_sure && is_close).then_some("the battery's level")
    }

    pub(super) fn leave_out(&mut self, name: &'static str, reason: String) {
        self.exclusions.push(Exclusion { power_only: false, name, reason });
        self.values.clear();
    }

    fn find(&self, kind: FaultKind) -> Option<&Fault> {
        self.faults.iter().find(|fault| fault.kind == kind)
    }

    /// Returns why the whole run is excluded. This is the first reason found, since further ones may follow from it.
    fn exclusion_reason(&self, capture: &Capture) -> Option<(&'static str, String)> {
        match &capture.info.outcome {
            Outcome::Complete => {}
            Outcome::Interrupted { reason } => return Some(("interrupted", reason.clone())),
            Outcome::Failed { reason } => return Some(("failed", reason.clone())),
        }
        if self.method.starts_with(farm::PICTURE_CHECK) {
            let reason =
                "a few seconds that check a pipeline's pictures, warm-up included; scenario 2 measures";
            return Some(("picture check", reason.into()));
        }
        if let Some(fault) = self.find(FaultKind::Rebooted) {
            return Some(("rebooted", fault.detail.clone()));
        }
        // Faults in the warm-up do not affect the measurement.
        let late = |fault: &&Fault| fault.at_s.is_none_or(|at| at >= capture.info.warm_up_s);
        if let Some(fault) = self.find(FaultKind::Restarted).filter(late) {
            return Some(("application restarted", fault.detail.clone()));
        }
        let (covered, planned) = (self.covered_s, self.planned_s);
        (covered < LEAST_COVERED * planned)
            .then(|| ("too short", format!("{covered:.0} s of {planned:.0} s have frame rates")))
    }

    /// Returns why the run's power is excluded.
    fn without_power(&self, capture: &Capture, samples: &[&Sample]) -> Option<(&'static str, String)> {
        let plugged =
            capture.samples.iter().filter(|s| s.plugged.is_some_and(|plugged| plugged != 0)).count();
        if let Some(fault) = self.find(FaultKind::PluggedIn) {
            return Some(("plugged in", fault.detail.clone()));
        }
        if plugged > 0 {
            return Some(("plugged in", format!("a charger was plugged in for {plugged} samples")));
        }
        let Some(integrated) = self.integrated else {
            let none = samples.iter().all(|s| s.current_ma.is_none());
            let what = if none { "the battery's current" } else { "current and voltage together" };
            if let Some(fault) = self.find(FaultKind::VoltageInVolts).filter(|_| !none) {
                return Some(("voltage in V", fault.detail.clone()));
            }
            return Some(("no current", format!("the device does not give {what}")));
        };
        let (seconds, planned) = (integrated.seconds, self.planned_s);
        if seconds < LEAST_COVERED * planned {
            return Some((
                "current missing",
                format!("{seconds:.0} s of {planned:.0} s have current and voltage"),
            ));
        }
        let charging = integrated.milliwatts <= 0.0;
        charging.then(|| ("charging", "on the mean, the battery was charged".into()))
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

/// Returns the time covered without gaps in seconds, and the number of gaps.
fn coverage(series: &[(f64, f64)], longest: f64) -> (f64, usize) {
    let covered = steps(series, longest).map(|(a, b)| b.0 - a.0).sum();
    let gaps = series.windows(2).filter(|pair| pair[1].0 - pair[0].0 > longest).count();
    (covered, gaps)
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
) -> Option<Counted> {
    let changes: Vec<(f64, f64)> =
        steps(charge, longest).filter(|(a, b)| a.1 != b.1).map(|(_, b)| b).collect();
    let (first, last) = (*changes.first()?, *changes.last()?);
    let between = |series: &[(f64, f64)]| -> Vec<(f64, f64)> {
        series.iter().copied().filter(|(time, _)| (first.0..=last.0).contains(time)).collect()
    };
    let seconds = last.0 - first.0;
    let volts = mean(&between(voltage))? / 1e3;
    let milliampere_hours = (first.1 - last.1) / 1e3;
    (seconds > 0.0).then_some(())?;
    Some(Counted {
        milliwatts: milliampere_hours * volts * 3600.0 / seconds,
        integrated_milliwatts: integrate(&between(power), longest)?.milliwatts,
        seconds,
        scale: 1.0,
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

fn mean(series: &[(f64, f64)]) -> Option<f64> {
    let sum: f64 = series.iter().map(|(_, value)| value).sum();
    (!series.is_empty()).then(|| sum / series.len() as f64)
}

/// Returns the mean over the seconds, weighted by their frames.
fn mean_over_frames(samples: &[&Sample], value: fn(&Sample) -> Option<f64>) -> Option<f64> {
    let pairs = samples.iter().filter_map(|sample| Some((sample.fps?, value(sample)?)));
    let (frames, sum) = pairs.fold((0.0, 0.0), |(frames, sum), (fps, v)| (frames + fps, sum + fps * v));
    (frames > 0.0).then(|| sum / frames)
}
