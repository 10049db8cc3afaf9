//! One step of a session: the user's actions, then a frame.

use std::time::Instant;

use glam::Quat;
use openxr as xr;

use super::eyes::to_pose;
use super::frame::Layers;
use super::state::{Progress, Session};
use crate::event::Action;
use crate::frame::FrameTiming;
use crate::openxr::description::Frame;
use crate::openxr::error::{XrError, call, check, optional};
use crate::openxr::graphics::make_current;
use crate::viewer::Viewer;
use yoro_context::Graphics;
use yoro_settings::{Performance, Settings};

impl Session {
    /// Handles the runtime's events and makes a frame if it wants one. New states go to `states`.
    pub fn step(
        &mut self,
        graphics: &dyn Graphics,
        viewer: &mut Viewer,
        states: &mut dyn FnMut(xr::SessionState),
        capture: bool,
    ) -> Result<Progress, XrError> {
        if self.poll_events(viewer, states)? {
            return Ok(Progress::Ended);
        }
        if !self.is_running {
            self.events.clear();
            return Ok(Progress::Idle);
        }
        self.apply_settings(viewer.settings())?;
        let wait = call("xrWaitFrame", self.waiter.wait())?;
        let begin = Instant::now();
        let (time, period) = (wait.predicted_display_time, wait.predicted_display_period.as_nanos());
        let begun = self.stream.begin();
        make_current(graphics)?;
        call("xrBeginFrame", begun)?;
        let timing = FrameTiming {
            now_ns: time.as_nanos(),
            expected_display_ns: time.as_nanos(),
            refresh_hz: if period > 0 { (1e9 / period as f64) as f32 } else { 0.0 },
        };
        self.poll_input(viewer, time)?;
        viewer.begin(&timing);
        let mut layers = Layers { eyes: None, panel: None };
        let mut captured = None;
        if wait.should_render {
            layers = self.render(graphics, viewer, time, capture, &mut captured)?;
        }
        // The runtime compares vectors with the frame before, which showed nothing.
        if let (None, Some(motion)) = (&layers.eyes, &mut self.motion) {
            motion.remember(None);
        }
        let ended = self.end_frame(time, &layers);
        make_current(graphics)?;
        ended?;
        let cpu_ms = begin.elapsed().as_secs_f64() * 1e3;
        let report = match layers.eyes {
            Some(_) => self.log_error(viewer.end(&timing)),
            None => None,
        };
        Ok(Progress::Frame(Frame { report, cpu_ms, capture: captured.map(Box::new) }))
    }

    /// Reads the controllers and performs the user's actions.
    fn poll_input(&mut self, viewer: &mut Viewer, time: xr::Time) -> Result<(), XrError> {
        if self.state == xr::SessionState::FOCUSED
            && let Some(input) = &mut self.input
        {
            let polled = input.poll(&self.session, time.as_nanos(), &mut self.events);
            if optional("controllers are not used any more", polled)?.is_none() {
                self.input = None;
            }
        }
        let mut events = std::mem::take(&mut self.events);
        for event in events.drain(..) {
            match viewer.event(event) {
                Ok(Action::Nothing) => {}
                Ok(action) => {
                    log::info!("{action}");
                    self.recenter |= action == Action::Recenter;
                }
                Err(error) => log::error!("{error}"),
            }
        }
        self.events = events;
        if let Some(settings) = viewer.take_settings() {
            viewer.apply_menu(settings);
        }
        if std::mem::take(&mut self.recenter) {
            let place = call("xrLocateSpace", self.spaces.head.locate(&self.spaces.base, time))?;
            let flags = xr::SpaceLocationFlags::POSITION_VALID | xr::SpaceLocationFlags::ORIENTATION_VALID;
            if place.location_flags.contains(flags)
                && let Some(head) = to_pose(&place.pose)
            {
                let ahead = head.forward();
                let heading = Quat::from_rotation_y((-ahead.x).atan2(-ahead.z));
                let q = xr::Quaternionf { x: heading.x, y: heading.y, z: heading.z, w: heading.w };
                self.set_space(xr::Posef { orientation: q, position: place.pose.position })?;
            }
        }
        Ok(())
    }

    /// Requests the settings' refresh rate and performance level if they have changed.
    fn apply_settings(&mut self, settings: &Settings) -> Result<(), XrError> {
        let wanted = (settings.refresh_rate, settings.performance);
        let before = self.applied.replace(wanted);
        if before == Some(wanted) {
            return Ok(());
        }
        let rates = &self.description.refresh_rates;
        if let Some(hz) = settings.refresh_rate
            && before.map(|(rate, _)| rate) != Some(settings.refresh_rate)
        {
            let nearest = rates.iter().copied().min_by(|a, b| (a - hz).abs().total_cmp(&(b - hz).abs()));
            match nearest {
                Some(rate) => {
                    let asked = self.session.request_display_refresh_rate(rate);
                    let asked = call("xrRequestDisplayRefreshRateFB", asked);
                    if optional("the refresh rate stays", asked)?.is_some() {
                        log::info!("refresh rate asked for: {rate} Hz");
                    }
                }
                None => log::warn!("the runtime does not let the refresh rate be chosen: it stays"),
            }
        }
        if let Some(extension) = &self.instance.exts().ext_performance_settings
            && before.map(|(_, level)| level) != Some(settings.performance)
        {
            let level = match settings.performance {
                Performance::PowerSaving => xr::PerfSettingsLevelEXT::POWER_SAVINGS,
                Performance::SustainedLow => xr::PerfSettingsLevelEXT::SUSTAINED_LOW,
                Performance::SustainedHigh => xr::PerfSettingsLevelEXT::SUSTAINED_HIGH,
                Performance::Boost => xr::PerfSettingsLevelEXT::BOOST,
            };
            for domain in [xr::PerfSettingsDomainEXT::CPU, xr::PerfSettingsDomainEXT::GPU] {
                // SAFETY: the session is live and the enums are valid.
                let result = unsafe {
                    (extension.perf_settings_set_performance_level)(self.session.as_raw(), domain, level)
                };
                let asked = check("xrPerfSettingsSetPerformanceLevelEXT", result);
                optional("the performance level stays", asked)?;
            }
            log::info!("performance level: {level:?}");
        }
        Ok(())
    }
}
