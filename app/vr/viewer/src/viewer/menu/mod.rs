//! The menu: opens it, performs what the user chooses, and draws it.

mod logic;

use super::Viewer;
use super::input::IPD_STEP;
use crate::error::ViewerError;
use crate::event::Action;
pub(super) use logic::Menu;
use logic::{Choice, Item, Look};
use yoro::eyes::{Eye, EyePair, Pose};
use yoro_gl::Destination;
use yoro_render::stereo::StereoSession;
use yoro_settings::{HoleMethod, Pipeline, Setting, Settings, Timewarp};

/// A quality level: its name, and the settings that it stands for.
struct QualityLevel {
    name: &'static str,
    render_scale: f32,
    adaptive: bool,
    msaa: u32,
    foveation: &'static str,
    holes: HoleMethod,
}

const QUALITIES: [QualityLevel; 3] = [
    QualityLevel {
        name: "saving",
        render_scale: 0.7,
        adaptive: true,
        msaa: 2,
        foveation: "medium",
        holes: HoleMethod::Filled,
    },
    QualityLevel {
        name: "balanced",
        render_scale: 1.0,
        adaptive: false,
        msaa: 4,
        foveation: "auto",
        holes: HoleMethod::Filled,
    },
    QualityLevel {
        name: "best",
        render_scale: 1.4,
        adaptive: false,
        msaa: 4,
        foveation: "off",
        holes: HoleMethod::Rendered,
    },
];

impl Viewer {
    /// Updates the menu with the head's pose relative to the viewpoint and the rays of controllers, each along its
    /// pose's -Z. Opens the menu when the user has looked down for a second, and performs what was chosen by looking.
    ///
    /// # Errors
    /// Those of [`Viewer::event`].
    pub fn look(&mut self, head: Pose, rays: [Option<Pose>; 2]) -> Result<Action, ViewerError> {
        self.stats.look(head.orientation, self.now_ns);
        if self.stats.question().is_some() {
            self.menu.close();
            return Ok(Action::Nothing);
        }
        let before = self.menu.pointed;
        let action = match self.menu.look(head, rays, self.now_ns) {
            Look::Nothing => {
                let note = |choice: Option<Choice>| match choice {
                    Some((item @ (Item::Lenses | Item::Close), _)) => Some(item),
                    _ => None,
                };
                if note(self.menu.pointed) != note(before) {
                    self.write_menu();
                }
                Action::Nothing
            }
            Look::Open => self.open_menu(),
            Look::Choose(choice) => self.choose(choice)?,
        };
        self.compare();
        Ok(action)
    }

    pub(super) fn open_menu(&mut self) -> Action {
        if self.menu.board.is_none() {
            self.menu.open();
        }
        self.write_menu();
        if let Some(Err(error)) = self.session.as_mut().map(StereoSession::prepare_comparison) {
            log::warn!("nothing to compare with: {error}");
        }
        Action::Menu(true)
    }

    pub(super) fn press(&mut self, is_pressed: bool) {
        self.menu.press(is_pressed);
        self.compare();
    }

    fn compare(&mut self) {
        let is_comparing = self.menu.is_comparing();
        if self.session.as_mut().is_some_and(|session| session.compare(is_comparing)) {
            log::info!("compare: {}", if is_comparing { "two real renders" } else { self.method().name() });
            let message = if is_comparing { "both eyes rendered" } else { "" };
            self.caption.announce(message.into(), self.now_ns);
        }
    }

    /// Chooses the tile that is pointed at, if any.
    pub(super) fn choose_pointed(&mut self) -> Result<Action, ViewerError> {
        let Some(choice) = self.menu.pointed else { return Ok(Action::Nothing) };
        self.menu.spend();
        self.choose(choice)
    }

    fn choose(&mut self, (item, step): Choice) -> Result<Action, ViewerError> {
        let action = match item {
            Item::Recenter => {
                self.menu.close();
                Action::Recenter
            }
            Item::Close => {
                self.menu.close();
                Action::Menu(false)
            }
            Item::Compare => Action::Nothing,
            Item::Scene => {
                let action = self.next_scene();
                let name = self.scene.name.clone();
                self.keep(&[("scene", name), ("viewpoint", "0".into())]);
                action
            }
            Item::Viewpoint => {
                let action = self.next_viewpoint();
                if let Action::Viewpoint(n) = action {
                    self.keep(&[("viewpoint", n.to_string())]);
                }
                action
            }
            Item::Method => {
                let action = self.other_method(step)?;
                self.keep(&[("method", self.method().name().to_owned())]);
                action
            }
            Item::Distance => {
                let action = self.change_ipd(IPD_STEP * step as f32);
                self.keep(&[("ipd", self.ipd().to_string())]);
                action
            }
            Item::Hud => {
                self.caption.is_shown = !self.caption.is_shown;
                self.keep(&[("hud", self.caption.is_shown.to_string())]);
                Action::Hud(self.caption.is_shown)
            }
            Item::Eye => {
                let other = if self.settings.dominant == Eye::Left { "right" } else { "left" };
                self.want(&[("dominant", other.into())])
            }
            Item::Lenses => {
                let viewers = self.viewers();
                let at = viewers.iter().position(|viewer| *viewer == self.settings.viewer);
                let next = viewers[at.map_or(0, |at| (at + 1) % viewers.len())].clone();
                self.choose_viewer(&next)
            }
            Item::Quality => {
                let at = self.quality().map_or(1, |at| (at + 1) % QUALITIES.len());
                let level = &QUALITIES[at];
                // The paper's pipeline has no others.
                let is_gather = self.settings.pipeline == Pipeline::Gather;
                let holes = if is_gather { level.holes } else { HoleMethod::Filled };
                // Positional timewarp moves whole eyes.
                let is_moved = self.settings.timewarp == Timewarp::Position;
                let foveation = if is_moved { "off" } else { level.foveation };
                self.want(&[
                    ("render-scale", level.render_scale.to_string()),
                    ("adaptive", level.adaptive.to_string()),
                    ("msaa", level.msaa.to_string()),
                    ("foveation", foveation.into()),
                    ("holes", holes.name().into()),
                ])
            }
            Item::Reset => self.reset(),
        };
        self.write_menu();
        Ok(action)
    }

    /// Reverts all changes made in the menu.
    pub(super) fn reset(&mut self) -> Action {
        log::info!("menu: reset");
        self.kept.clear();
        self.is_kept_new = true;
        self.wanted = Some(self.given.clone());
        Action::Settings
    }

    /// Records settings that are in use already.
    pub(super) fn keep(&mut self, pairs: &[(&'static str, String)]) {
        for (key, value) in pairs {
            log::info!("menu: {key}={value}");
            if let Err(error) = self.settings.apply(&format!("{key}={value}")) {
                log::warn!("{error}");
            }
            self.kept.retain(|(other, _)| other != key);
            self.kept.push((key, value.clone()));
        }
        self.is_kept_new = true;
    }

    /// Asks the display to apply other settings.
    pub(super) fn want(&mut self, pairs: &[(&'static str, String)]) -> Action {
        let before = self.settings.clone();
        self.keep(pairs);
        self.wanted = Some(std::mem::replace(&mut self.settings, before));
        Action::Settings
    }

    /// Returns the name of the eye that is synthesized.
    pub(super) fn synthesized_eye(&self) -> &'static str {
        if self.settings.dominant == Eye::Left { "right" } else { "left" }
    }

    fn quality(&self) -> Option<usize> {
        let Settings { render_scale, adaptive, .. } = self.settings;
        QUALITIES.iter().position(|level| (level.render_scale, level.adaptive) == (render_scale, adaptive))
    }

    /// Returns the settings that the menu asks for, once, for the display to apply.
    pub(crate) fn take_settings(&mut self) -> Option<Settings> {
        self.wanted.take()
    }

    /// Applies settings of the menu; on a mistake nothing changes.
    pub(crate) fn apply_menu(&mut self, settings: Settings) {
        let folders = self.folders.clone();
        if let Err(error) = self.change(settings, &folders) {
            log::error!("{error}; the settings stay as they were");
        }
        self.write_menu();
    }

    /// Returns the settings that the menu has changed, as keys and values, if they have changed since the last call.
    pub fn take_kept(&mut self) -> Option<Vec<(&'static str, String)>> {
        std::mem::take(&mut self.is_kept_new).then(|| self.kept.clone())
    }

    /// Writes the menu's texts.
    pub(crate) fn write_menu(&mut self) {
        if self.menu.board.is_none() {
            return;
        }
        let text =
            |key: &str| Setting::find(key).map_or_else(String::new, |setting| setting.text(&self.settings));
        let synthesized = self.synthesized_eye();
        let quality = self.quality().map_or("own", |at| QUALITIES[at].name);
        let tiles = Item::ALL.map(|item| match item {
            Item::Recenter => "Recenter".into(),
            Item::Scene => format!("Scene\n{}", self.scene.name),
            Item::Viewpoint => format!("Viewpoint\n{}", self.scene.viewpoint),
            Item::Method => format!("< Method >\n{}", self.method().name()),
            Item::Eye => format!("Own eye\n{}", text("dominant")),
            Item::Lenses => format!("Viewer\n{}", self.viewer_name(&self.settings.viewer)[1]),
            Item::Distance => format!("- Eyes     +\n{:.0} mm", self.ipd().metres() * 1e3),
            Item::Quality => format!("Quality\n{quality}"),
            Item::Hud => format!("Figures\n{}", if self.caption.is_shown { "on" } else { "off" }),
            Item::Compare => "Compare\nwhile held".into(),
            Item::Reset => "Reset\nall settings".into(),
            Item::Close => "Close".into(),
        });
        self.menu.tiles.tiles = tiles.into();
        self.menu.tiles.heading = format!(
            "By yoro, the {synthesized} eye's picture is made up.\n\
             Compare, held or looked at: both eyes are rendered.\n\
             Figures: frames a second, a frame's ms, degrees C.\n\
             {}",
            match self.menu.pointed {
                Some((Item::Lenses, _)) => "Another viewer: scan its code on the start screen.",
                Some((Item::Close, _)) => "Others' licences: assets/NOTICES.txt in the APK.",
                _ => "Look at a tile for 1.5 s, or tap. Hold: recenter.",
            }
        );
    }

    /// True while the menu is open, even if it is hidden for a comparison.
    pub fn is_menu_open(&self) -> bool {
        self.menu.board.is_some()
    }

    /// Returns the pose of the menu's panel relative to the viewpoint, while the panel is shown.
    pub fn menu_place(&self) -> Option<Pose> {
        self.menu.board.filter(|_| !self.menu.is_comparing())
    }

    /// Draws the menu over both eyes, if it is shown.
    pub fn draw_menu(&mut self, pair: &EyePair, eyes: &[Destination; 2]) {
        let Some(board) = self.menu_place() else { return };
        let board_pose = self.place(board);
        let Some(attached) = &mut self.attached else { return };
        attached.board.set(&self.menu.tiles);
        attached.board.draw_into_eyes(&board_pose, self.menu.hit, pair, eyes);
    }

    /// Fills a compositor's image of [`Board::SIZE`](yoro_lenses::Board::SIZE) with the menu.
    pub fn draw_menu_image(&mut self, to: &Destination) {
        let Some(attached) = &mut self.attached else { return };
        attached.board.set(&self.menu.tiles);
        attached.board.draw_linear(self.menu.hit, to);
    }
}
