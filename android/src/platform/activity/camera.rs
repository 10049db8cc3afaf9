//! The activity's camera: it looks for a viewer's code while the start screen is shown.

use yoro_lenses::Rotation;

use super::Activity;
use crate::platform::camera::{REFUSED, Scan};
use crate::platform::configuration;
use crate::platform::display::Display;
use crate::share::Shared;

impl Activity {
    /// Starts a scan, or first asks for the permission.
    pub(super) fn ask_for_scan(&mut self) {
        if self.java.may_use_camera() {
            self.begin_scan();
        } else {
            self.is_asking = true;
            self.java.ask_for_camera();
        }
    }

    /// Starts to look for a viewer's code with the camera, if that is permitted.
    pub(super) fn begin_scan(&mut self) {
        if self.java.may_use_camera() {
            log::info!("the camera looks for a viewer's code");
            let is_upside_down = self.screen.rotation() == Rotation::LandscapeRight;
            self.scan = Some(Scan::begin(is_upside_down));
        } else {
            self.say(REFUSED);
        }
    }

    /// Shows the camera's picture and applies the code that it finds.
    pub(super) fn follow_scan(&mut self) {
        let (Some(scan), Display::Cardboard(cardboard)) = (&self.scan, &mut self.display) else { return };
        let sentence = match scan.outcome() {
            Some(Ok(Shared::Viewer(uri))) => {
                log::info!("scanned: the viewer {uri}");
                configuration::choose_viewer(cardboard, &uri)
            }
            // A code cannot be a file.
            Some(Ok(Shared::Scene(_))) => String::new(),
            Some(Err(sentence)) => sentence,
            None => {
                if let Some(picture) = scan.picture() {
                    cardboard.viewer_mut().show_camera(&picture);
                }
                return;
            }
        };
        self.scan = None;
        self.say(&sentence);
    }
}
