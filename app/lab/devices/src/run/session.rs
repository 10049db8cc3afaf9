//! A run while it is captured.

use std::path::Path;
use std::time::Duration;

use indicatif::ProgressBar;

use super::{Found, Plan, refuse_charger};
use crate::adb::{Device, DeviceError, now, sleep};
use crate::capture::{Fault, FaultKind, Outcome, RunInfo, Sample, Writer};
use crate::follow::{Event, Follower};
use crate::held_settings::HeldSettings;
use crate::phone;
use crate::reading::{LineContent, Reading};
use yoro_files::interrupt;
use yoro_scenes::BUILTINS;
use yoro_settings::Settings;

/// Maximum seconds that the application may take to load a scene and show it.
const START_TIMEOUT_S: f64 = 180.0;
/// Seconds without a line after which the session checks whether the application still runs.
const SILENCE_S: f64 = 15.0;
/// Maximum seconds for which a device may be lost, during a run and between runs.
pub(crate) const LOST_TIMEOUT_S: f64 = 300.0;
/// Maximum seconds that Android may take to start.
const BOOT_TIMEOUT_S: f64 = 180.0;
/// Maximum number of times that the application is started again in a run.
const RESTARTS: u32 = 3;
/// Seconds for which the application runs longer than the run, so that the last second is logged.
const MARGIN_S: f64 = 1.5;
/// Tolerance in Hz between the display's refresh rate and the one it is held at, since 60 may be 59.94.
const REFRESH_TOLERANCE_HZ: f64 = 1.0;
/// Interval at which waits check for interrupts and silence.
const POLL_INTERVAL: Duration = Duration::from_secs(1);

/// Makes a run and captures it into a folder. Sets the bar's position to the seconds of the run, and its message to
/// what is happening. A failed run leaves a capture as well, whose outcome says so.
///
/// # Errors
/// [`DeviceError`] if there is no capture, or if further runs would be useless.
pub(crate) fn capture(
    device: &Device,
    found: &Found,
    plan: &Plan,
    held: &mut HeldSettings,
    folder: &Path,
    bar: &ProgressBar,
) -> Result<RunInfo, DeviceError> {
    phone::wake(device);
    let battery = phone::battery(device)?;
    if plan.power && (battery.plugged() || battery.held) {
        refuse_charger(device)?;
    }
    held.renew(device)?;
    let started_unix_s = now();
    let info = plan.info(found, started_unix_s, battery.celsius);
    let label = format!("r{}-{:x}", plan.order, (started_unix_s * 1e3) as u64);
    let mut session = Session {
        device,
        plan,
        bar,
        follower: Follower::new(device)?,
        reading: Reading::new(Some(label.clone())),
        label,
        writer: Writer::create(folder, info)?,
        own_faults: Vec::new(),
        restarts: 0,
        heard_s: started_unix_s,
        silent_since_s: started_unix_s,
        delay_s: 0.0,
        has_ended: false,
        refresh_is_told: false,
    };
    for refused in &held.refused {
        session.own_faults.push(Fault { kind: FaultKind::NotPinned, at_s: None, detail: refused.clone() });
    }
    session.renew_faults()?;
    let (warmest, celsius) = (plan.warmest_celsius, battery.celsius);
    if let (Some(warmest), Some(celsius)) = (warmest, celsius)
        && celsius > warmest
    {
        let detail =
            format!("the battery had {celsius:.1} C at the start, {warmest:.1} C were wanted at most");
        session.fault(FaultKind::TooWarm, 0.0, detail)?;
    }
    let outcome = match session.start() {
        // A lost device also ends the log. The application is started again when the device is back.
        Err(error) if !error.is_lost() => Err(error),
        _ => session.follow(),
    };
    let stopped = phone::stop(device);
    match outcome {
        Ok(outcome) => {
            session.renew_faults()?;
            let info = session.writer.finish(outcome)?;
            // If the device is gone, nothing can keep running on it.
            if let Err(error) = stopped {
                log::debug!("{error}");
            }
            Ok(info)
        }
        Err(error) => {
            let outcome = match &error {
                DeviceError::Refused { .. } => Outcome::Failed { reason: error.to_string() },
                _ => Outcome::Interrupted { reason: error.to_string() },
            };
            // Report the first error of a full disk, not those that follow from it.
            let noted = session.renew_faults().and_then(|()| Ok(session.writer.finish(outcome)?));
            if let Err(again) = noted {
                log::debug!("{again}");
            }
            Err(error)
        }
    }
}
/// A run that is being captured.
struct Session<'a> {
    device: &'a Device,
    plan: &'a Plan,
    bar: &'a ProgressBar,
    follower: Follower<'a>,
    reading: Reading,
    label: String,
    writer: Writer,
    /// Faults of the connection. The other faults come from the log.
    own_faults: Vec<Fault>,
    restarts: u32,
    /// Time of the last sample.
    heard_s: f64,
    /// Start of the current silence: the last sample or the last start of the application.
    silent_since_s: f64,
    /// Delay in seconds of the lines that the device kept while it was lost.
    delay_s: f64,
    /// True once the application has logged its summary.
    has_ended: bool,
    refresh_is_told: bool,
}

impl Session<'_> {
    /// Starts the application for the rest of the run.
    fn start(&mut self) -> Result<(), DeviceError> {
        // The run's time continues while the application does not run.
        let passed_s = match self.reading.samples() {
            0 => 0.0,
            _ => self.reading.time_s() + now() - self.heard_s,
        };
        let left_s = self.plan.seconds() - passed_s + MARGIN_S;
        let settings = Settings {
            duration: Some(left_s.max(MARGIN_S) as f32),
            run: Some(self.label.clone()),
            ..self.plan.settings.clone()
        };
        self.bar.set_message("starting");
        self.has_ended = false;
        self.silent_since_s = now();
        phone::start(self.device, &settings)
    }

    fn follow(&mut self) -> Result<Outcome, DeviceError> {
        loop {
            if interrupt::requested() {
                return Ok(Outcome::Interrupted { reason: "the user has stopped it".into() });
            }
            match self.follower.next(POLL_INTERVAL)? {
                Event::Line(line) => {
                    if let Some(outcome) = self.line(&line)? {
                        return Ok(outcome);
                    }
                }
                Event::Lost => {
                    self.bar.set_message("lost: connect it again");
                    self.bar.suspend(|| log::warn!("{} is lost; waiting for it", self.device.serial));
                }
                Event::Back { seconds, rebooted } => self.back(seconds, rebooted)?,
                Event::Quiet => {
                    self.delay_s = 0.0;
                    if let Some(outcome) = self.quiet()? {
                        return Ok(outcome);
                    }
                }
            }
        }
    }

    fn line(&mut self, line: &[u8]) -> Result<Option<Outcome>, DeviceError> {
        self.writer.log(line)?;
        let line = &*crate::log::text(line);
        let now = now();
        let passed_s = now - self.heard_s + self.delay_s;
        let damaged = self.reading.damaged();
        let outcome = match self.reading.line(line, Some(passed_s)) {
            LineContent::Sample(sample) => {
                (self.heard_s, self.silent_since_s) = (now, now);
                self.compare_refresh(&sample)?;
                self.writer.sample(&sample)?;
                self.show(&sample);
                self.unexpected_content(&sample)
            }
            LineContent::Summary => {
                self.has_ended = self.reading.samples() > 0;
                None
            }
            LineContent::Damaged(why) => {
                self.bar.suspend(|| log::warn!("{}: a line is left out: {why}", self.device.serial));
                None
            }
            LineContent::Other => None,
        };
        if damaged != self.reading.damaged() || self.reading.faults().len() != self.reading_faults() {
            self.renew_faults()?;
        }
        let is_over = self.reading.time_s() >= self.plan.seconds() - MARGIN_S;
        Ok(outcome.or_else(|| (is_over && self.has_ended).then_some(Outcome::Complete)))
    }

    /// Compares the display's refresh rate with the requested one: a setting may be accepted without having an effect.
    fn compare_refresh(&mut self, sample: &Sample) -> Result<(), DeviceError> {
        let (Some(wanted), Some(hz)) = (self.plan.refresh_hz, sample.refresh_hz) else { return Ok(()) };
        let is_wrong = (hz - wanted).abs() > REFRESH_TOLERANCE_HZ && sample.time_s >= self.plan.warm_up_s;
        if !is_wrong || std::mem::replace(&mut self.refresh_is_told, true) {
            return Ok(());
        }
        let detail = format!("the display runs at {hz:.0} Hz, {wanted} Hz were asked for");
        self.fault(FaultKind::RefreshRate, sample.time_s, detail)
    }

    /// Returns a failure if the device shows another method or scene than requested, by a tap or for lack of support.
    fn unexpected_content(&self, sample: &Sample) -> Option<Outcome> {
        let settings = &self.plan.settings;
        let (method, scene) = self.reading.methods().last()?;
        let failed = |what: &str, shown: &str, wanted: &str| {
            let reason =
                format!("the device showed the {what} {shown} in place of {wanted}: its log says why");
            Some(Outcome::Failed { reason })
        };
        if !method.parse().is_ok_and(|method| settings.method.may_be(method)) {
            return failed("method", method, settings.method.name());
        }
        if BUILTINS.iter().any(|known| known.name == settings.scene) && *scene != settings.scene {
            return failed("scene", scene, &settings.scene);
        }
        let wanted = settings.pipeline.name();
        match sample.other.get("pipeline") {
            Some(pipeline) if pipeline != wanted => failed("pipeline", pipeline, wanted),
            _ => None,
        }
    }

    fn show(&self, sample: &Sample) {
        let number =
            |value: Option<f64>, unit: &str| value.map_or(String::new(), |v| format!(" {v:.1} {unit}"));
        self.bar.set_position((sample.time_s as u64).min(self.plan.seconds() as u64));
        self.bar.set_message(format!(
            "{}, {}:{}{}{}",
            self.plan.method,
            self.plan.settings.scene,
            number(sample.fps, "FPS"),
            number(sample.current_ma, "mA"),
            number(sample.battery_celsius, "C"),
        ));
    }

    fn back(&mut self, seconds: f64, rebooted: bool) -> Result<(), DeviceError> {
        self.delay_s = seconds;
        let at_s = self.reading.time_s();
        if rebooted {
            let detail = "the device was started anew, and its log with it".into();
            self.own_faults.push(Fault { kind: FaultKind::Rebooted, at_s: Some(at_s), detail });
        }
        self.fault(FaultKind::Disconnected, at_s, format!("lost for {seconds:.0} s"))
    }

    /// Decides what to do after a silence.
    fn quiet(&mut self) -> Result<Option<Outcome>, DeviceError> {
        if let Some(seconds) = self.follower.lost_for() {
            let reason =
                format!("{} was lost and did not come back within {seconds:.0} s", self.device.serial);
            return Ok((seconds > LOST_TIMEOUT_S).then_some(Outcome::Interrupted { reason }));
        }
        let silent_s = now() - self.silent_since_s;
        if silent_s < SILENCE_S {
            return Ok(None);
        }
        let running = match phone::runs(self.device) {
            // Usually the log ends too, but adb may also wait for the device silently.
            Err(error) if error.is_lost() => {
                let outcome = Outcome::Interrupted { reason: error.to_string() };
                return Ok((silent_s > LOST_TIMEOUT_S).then_some(outcome));
            }
            answer => answer?,
        };
        if running {
            let reason = format!(
                "the application has said nothing for {silent_s:.0} s: the screen may be off, or something else in front"
            );
            return Ok((silent_s > START_TIMEOUT_S).then_some(Outcome::Failed { reason }));
        }
        // The application has ended, and whether it would have logged more is unknown.
        if self.reading.time_s() >= self.plan.seconds() - MARGIN_S {
            return Ok(Some(Outcome::Complete));
        }
        self.restarts += 1;
        if self.restarts > RESTARTS {
            let reason = format!(
                "the application ended {RESTARTS} times before its time: its last words are in the log"
            );
            return Ok(Some(Outcome::Failed { reason }));
        }
        match self.await_boot().and_then(|()| self.start()) {
            Err(error) if error.is_lost() => Ok(None),
            done => done.map(|()| None),
        }
    }

    /// Waits until Android has started.
    fn await_boot(&self) -> Result<(), DeviceError> {
        let begin = now();
        while now() - begin < BOOT_TIMEOUT_S && !interrupt::requested() {
            if self.device.shell(&["getprop", "sys.boot_completed"])?.trim() == "1" {
                break;
            }
            sleep(POLL_INTERVAL);
        }
        phone::wake(self.device);
        Ok(())
    }

    fn fault(&mut self, kind: FaultKind, at_s: f64, detail: String) -> Result<(), DeviceError> {
        self.own_faults.push(Fault { kind, at_s: Some(at_s), detail });
        self.renew_faults()
    }

    /// Returns the number of faults in the capture that come from the log.
    fn reading_faults(&self) -> usize {
        self.writer.info.faults.len() - self.own_faults.len()
    }

    fn renew_faults(&mut self) -> Result<(), DeviceError> {
        let faults = self.own_faults.iter().cloned().chain(self.reading.faults()).collect();
        Ok(self.writer.change(|info| info.faults = faults)?)
    }
}
