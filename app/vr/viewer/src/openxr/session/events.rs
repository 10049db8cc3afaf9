//! Events of the runtime between frames.

use openxr as xr;
use xr::sys;

use super::state::Session;
use crate::openxr::error::{XrError, call, check, optional};
use crate::viewer::Viewer;
use yoro::eyes::Eye;

/// The most events that are handled before a frame, so that a runtime that never stops sending them cannot stop frames.
const MAX_EVENTS: usize = 64;

impl Session {
    /// Handles the runtime's events. Returns true if the session is over for good.
    pub(super) fn poll_events(
        &mut self,
        viewer: &mut Viewer,
        states: &mut dyn FnMut(xr::SessionState),
    ) -> Result<bool, XrError> {
        for _ in 0..MAX_EVENTS {
            let mut buffer = std::mem::MaybeUninit::<sys::EventDataBuffer>::uninit();
            // SAFETY: the runtime reads only `type` and `next`. The event is read only after success, when the runtime
            // has written it.
            let event = unsafe {
                let head = buffer.as_mut_ptr().cast::<sys::BaseInStructure>();
                head.write(sys::BaseInStructure { ty: sys::EventDataBuffer::TYPE, next: std::ptr::null() });
                let result = (self.instance.fp().poll_event)(self.instance.as_raw(), buffer.as_mut_ptr());
                if check("xrPollEvent", result)? == sys::Result::EVENT_UNAVAILABLE {
                    return Ok(false);
                }
                xr::Event::from_raw(&buffer)
            };
            match event {
                Some(xr::Event::SessionStateChanged(change)) if change.session() == self.session.as_raw() => {
                    states(change.state());
                    if self.change_state(change.state(), viewer)? {
                        return Ok(true);
                    }
                }
                Some(xr::Event::InstanceLossPending(_)) => return Err(XrError::Lost),
                Some(xr::Event::ReferenceSpaceChangePending(change))
                    if change.session() == self.session.as_raw()
                        && change.reference_space_type() == xr::ReferenceSpaceType::LOCAL =>
                {
                    log::info!("recentered by the system");
                    self.set_space(xr::Posef::IDENTITY)?;
                }
                Some(xr::Event::VisibilityMaskChangedKHR(change)) => {
                    if let Some(mask) = &mut self.mask {
                        let eye = Eye::BOTH.get(change.view_index() as usize).copied();
                        if let Some(eye) = eye {
                            optional("the mask stays", mask.update(&self.session, self.views, eye))?;
                        }
                    }
                }
                Some(xr::Event::DisplayRefreshRateChangedFB(change)) => {
                    let hz = change.to_display_refresh_rate();
                    log::info!("refresh rate: {hz} Hz");
                    viewer.set_display_rate(hz);
                }
                Some(xr::Event::PerfSettingsEXT(change)) => {
                    log::info!(
                        "the runtime's level of {:?} performance ({:?}): {:?}, before {:?}",
                        change.domain(),
                        change.sub_domain(),
                        change.to_level(),
                        change.from_level()
                    );
                }
                Some(xr::Event::EventsLost(lost)) => {
                    log::warn!("{} events of the runtime were lost", lost.lost_event_count());
                }
                _ => {}
            }
        }
        Ok(false)
    }

    /// Handles a new session state. Returns true if the session is over for good.
    fn change_state(&mut self, state: xr::SessionState, viewer: &mut Viewer) -> Result<bool, XrError> {
        log::info!("OpenXR session: {state:?}");
        let is_visible = |state| matches!(state, xr::SessionState::VISIBLE | xr::SessionState::FOCUSED);
        match (is_visible(self.state), is_visible(state)) {
            (false, true) => viewer.resume(),
            (true, false) => viewer.pause(),
            _ => {}
        }
        if state != xr::SessionState::FOCUSED
            && let Some(input) = &mut self.input
        {
            input.forget();
        }
        self.state = state;
        match state {
            xr::SessionState::READY if !self.is_running => {
                call("xrBeginSession", self.session.begin(self.views))?;
                self.is_running = true;
            }
            xr::SessionState::STOPPING if self.is_running => {
                self.is_running = false;
                call("xrEndSession", self.session.end())?;
            }
            xr::SessionState::LOSS_PENDING => return Err(XrError::Lost),
            xr::SessionState::EXITING => return Ok(true),
            _ => {}
        }
        Ok(false)
    }
}
