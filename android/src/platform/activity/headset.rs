//! The activity's headset: whether it is the display, and its steps.

use std::sync::OnceLock;

use yoro_context::android::Window;
use yoro_settings::DisplayKind;
use yoro_viewer::Viewer;
use yoro_viewer::openxr::{Android, Headset, Options, Step, runtime};

use super::{Activity, context};
use crate::platform::display::{Display, DisplayError};

/// The OpenXR runtime. Its library stays in the process and is initialised only once for all activities.
static RUNTIME: OnceLock<runtime::Runtime> = OnceLock::new();

impl Activity {
    /// Chooses the display, and logs the reason in one line.
    pub(super) fn choose_display(&mut self) {
        if std::mem::replace(&mut self.is_display_chosen, true) {
            return;
        }
        let settings = self.configuration.resolve();
        if settings.display == DisplayKind::Cardboard {
            log::info!("display: Cardboard-compatible viewer, since the settings say so");
            return;
        }
        let found = match self.find_runtime() {
            Ok(found) => found,
            Err(reason) => {
                let is_usual = reason.nothing_installed() && settings.display == DisplayKind::Auto;
                return self.do_without_headset(&reason.to_string(), is_usual);
            }
        };
        let line = found.found().to_string();
        match self.open_headset(found) {
            Ok(()) => log::info!("display: headset, by {line}"),
            Err(reason) => self.do_without_headset(&reason.to_string(), false),
        }
    }

    /// Finds the runtime of this device, once per process.
    fn find_runtime(&self) -> Result<runtime::Runtime, runtime::NotFound> {
        if let Some(found) = RUNTIME.get() {
            return Ok(found.clone());
        }
        let java = self.java.application_context().map(|context| {
            // SAFETY: the pointers are the process's VM, and a global reference that is never deleted.
            unsafe { runtime::JavaContext::new(self.app.vm_as_ptr(), context) }
        });
        let found = runtime::find(&runtime::android_places(), &self.java, java.as_ref())?;
        Ok(RUNTIME.get_or_init(|| found).clone())
    }

    /// Uses the device's own screen, because there is no headset or no headset any more. On a headset the application
    /// ends instead, since its wearer would not see that screen but an endless loading sign. `is_usual` is true if
    /// nothing is wrong: most phones are not headsets.
    fn do_without_headset(&mut self, reason: &str, is_usual: bool) {
        if self.java.is_headset() {
            log::error!("display: none, since {reason}; this is a headset, so the application ends");
            self.finish();
        } else if is_usual {
            log::info!("display: Cardboard-compatible viewer, since {reason}");
        } else {
            log::warn!("display: Cardboard-compatible viewer, since {reason}");
        }
    }

    fn open_headset(&mut self, found: runtime::Runtime) -> Result<(), DisplayError> {
        // SAFETY: the pointers are the process's VM, and a global reference that lives as long as `self.app`.
        let android = unsafe { Android::new(self.app.vm_as_ptr(), self.app.activity_as_ptr()) };
        let window = match self.window.take() {
            Some(window) => window,
            None => Window::open()?,
        };
        let window = self.window.insert(window);
        let gl = context(&mut self.gl, window)?;
        self.configuration.check_pictures(gl);
        let mut viewer = self.configuration.make_viewer(Viewer::new)?;
        viewer.attach(gl.clone())?;
        self.configuration.greet(&mut viewer);
        let options = Options { android: Some(android) };
        let headset = Headset::open(found, &*window, gl, viewer, options)?;
        self.display = Display::Headset(Box::new(headset));
        Ok(())
    }

    /// Makes a frame, unless the runtime wants none.
    pub(super) fn step_headset(&mut self) {
        let (Display::Headset(headset), Some(window)) = (&mut self.display, &self.window) else { return };
        self.input.events.drain(..).for_each(|event| headset.event(event));
        match headset.step(window) {
            Ok(Step::Idle) => {}
            Ok(Step::Frame(frame)) => {
                if let Some(report) = frame.report {
                    self.after_frame(&report);
                }
            }
            Ok(Step::Ended) => self.finish(),
            // This activity has lost the headset, for instance with its session. The headset used neither the window
            // nor the refreshes and sensors, so both are started here as if the activity had just come to the front.
            Err(error) => {
                self.summarize();
                self.is_summarized = false;
                self.display = Display::None;
                self.do_without_headset(&error.to_string(), false);
                self.open_window();
                if self.is_resumed {
                    self.resume();
                }
            }
        }
    }
}
