//! The start screen: handles touches, draws itself, and lists the viewers to choose from.

mod logic;

use glam::{Vec2, Vec3};

use super::Viewer;
use crate::event::Action;
pub(super) use logic::StartScreen;
use logic::{Hint, OTHER, Tile, VIEWERS};
use yoro_gl::Destination;
use yoro_lenses::{Rotation, ViewerParams, tile_at};

/// The viewers that are always offered, as the settings name them.
const BUILTIN: [&str; 2] = ["v1", "v2"];

impl Viewer {
    /// Enables the start screen, which then appears when the phone is held upright, and the signs in the corners. For
    /// applications that a person has started by hand.
    pub fn offer_start_screen(&mut self) {
        self.start.is_offered = true;
    }

    /// True if the start screen appears when the phone is held upright.
    pub fn offers_start_screen(&self) -> bool {
        self.start.is_offered
    }

    /// True while the start screen is shown instead of the scene.
    pub fn is_start_screen(&self) -> bool {
        self.start.is_shown
    }

    /// Shows the start screen, with `message` instead of its explanation unless it is empty.
    pub fn show_start_screen(&mut self, message: &str) -> Action {
        if !self.start.is_shown {
            self.pause();
        }
        self.menu.close();
        self.start.show(message);
        self.start.is_scanning = false;
        self.write_start_screen();
        Action::StartScreen(true)
    }

    /// Performs the choice at a point on the panel, 0 to 1 from the lower left. `None` is a key, which starts.
    pub(crate) fn touch_start_screen(&mut self, at: Option<Vec2>) -> Action {
        let tile = match at {
            Some(at) => tile_at(at, Tile::ALL.len()).map(|(i, share)| (Tile::ALL[i], share)),
            None => Some((Tile::Start, 0.0)),
        };
        self.start.message.clear();
        let was_scanning = std::mem::take(&mut self.start.is_scanning);
        let action = match tile {
            Some((Tile::Viewer(i), _)) => match self.viewers().get(i) {
                Some(viewer) => self.choose_viewer(&viewer.clone()),
                None => Action::Nothing,
            },
            Some((Tile::Scan, _)) if was_scanning => Action::Scan(false),
            // Shown if there is no camera, or if it may not be used.
            Some((Tile::Scan, _)) => {
                OTHER.clone_into(&mut self.start.message);
                Action::Scan(true)
            }
            Some((Tile::Share, share)) if share < 0.5 => Action::ShareLog,
            Some((Tile::Share, _)) => Action::ShareNotices,
            Some((Tile::Reset, _)) => self.reset(),
            Some((Tile::Start, _)) => {
                // From now on the viewer counts as chosen by the user, even if it is the default.
                self.keep(&[("viewer", self.settings.viewer.clone())]);
                self.start.leave();
                self.resume();
                Action::StartScreen(false)
            }
            None => Action::Nothing,
        };
        self.write_start_screen();
        action
    }

    /// Explains the picture to the user once the scene is shown.
    pub fn explain(&mut self) {
        self.start.hint = Hint::Explanation;
    }

    /// True while the start screen shows the picture of the phone's camera.
    pub fn is_scanning(&self) -> bool {
        self.start.is_scanning
    }

    /// Shows the picture of the phone's camera on the start screen: luma of [`yoro_lenses::Board::PICTURE`] pixels,
    /// rows from the bottom.
    pub fn show_camera(&mut self, picture: &[u8]) {
        if !std::mem::replace(&mut self.start.is_scanning, true) {
            self.write_start_screen();
        }
        if let Some(attached) = &mut self.attached {
            attached.board.set_picture(picture);
        }
    }

    /// Records the up direction in the picture's axes at a time. Returns true if this shows the start screen.
    pub(crate) fn tilt(&mut self, up: Vec3, rotation: Rotation, now_ns: i64) -> bool {
        self.now_ns = now_ns;
        let is_upright = self.start.tilt(up, rotation, now_ns);
        if is_upright {
            self.show_start_screen("");
        }
        is_upright
    }

    /// Returns the viewers to choose from, in the form of the setting `viewer`.
    pub(super) fn viewers(&self) -> Vec<String> {
        let (own, recent) = (&self.settings.viewer, &self.settings.recent_viewers);
        let own = (!recent.contains(own)).then_some(own);
        let mut viewers: Vec<String> = BUILTIN.map(str::to_owned).into();
        for viewer in own.into_iter().chain(recent) {
            if !viewers.contains(viewer) {
                viewers.push(viewer.clone());
            }
        }
        viewers.truncate(VIEWERS);
        viewers
    }

    /// Returns a viewer's vendor and model.
    pub(super) fn viewer_name(&self, viewer: &str) -> [String; 2] {
        if BUILTIN.contains(&viewer) {
            return ["Cardboard".into(), viewer.into()];
        }
        match ViewerParams::find_in(viewer, &self.folders) {
            Ok(params) => [params.vendor, params.model],
            Err(_) => [viewer.into(), String::new()],
        }
    }

    /// Asks for a viewer. A new viewer becomes the first of the recent ones; a known one keeps its place.
    pub fn choose_viewer(&mut self, viewer: &str) -> Action {
        let chosen = ("viewer", viewer.to_owned());
        let mut recent = self.settings.recent_viewers.clone();
        if BUILTIN.contains(&viewer) || recent.iter().any(|other| other == viewer) {
            return self.want(&[chosen]);
        }
        recent.insert(0, viewer.to_owned());
        recent.truncate(VIEWERS - BUILTIN.len());
        self.want(&[chosen, ("recent-viewers", recent.join(","))])
    }

    /// Writes the start screen's texts.
    pub(crate) fn write_start_screen(&mut self) {
        if !self.start.is_shown {
            return;
        }
        let viewers = self.viewers();
        let chosen = viewers.iter().position(|viewer| *viewer == self.settings.viewer);
        let names: Vec<_> = viewers.iter().map(|viewer| self.viewer_name(viewer)).collect();
        let synthesized = self.synthesized_eye();
        self.start.write(&names, chosen, synthesized);
    }

    /// Fills a window with the start screen.
    pub(crate) fn draw_start_screen(&mut self, window: &Destination) {
        let Some(attached) = &mut self.attached else { return };
        attached.board.set(&self.start.tiles);
        attached.board.draw_flat(window, self.start.is_scanning);
        // Discards the GPU times: this is not a frame of the session.
        attached.pass_times.clear();
        attached.gl.end_timed_frame(&mut attached.pass_times);
    }

    /// Draws the signs in the window's upper corners, if a person has started the application by hand.
    pub(crate) fn draw_corners(&self, side: u32, window: &Destination) {
        if let Some(attached) = self.attached.as_ref().filter(|_| self.start.is_offered) {
            attached.board.draw_corners(side, window);
        }
    }
}
