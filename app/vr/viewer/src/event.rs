//! The user's actions and their effects.

use std::fmt;

use yoro_settings::{Ipd, MethodChoice};

/// An action of the user.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// A tap on the screen, or the trigger of the viewer or a controller: the next method, or the tile of the menu that
    /// is pointed at.
    Tap,
    /// The previous method.
    PreviousMethod,
    /// A long press: opens the menu; in the menu, makes the head's present direction straight ahead.
    LongPress,
    /// The trigger was pressed: in the menu, starts a comparison.
    Press,
    /// The trigger was released.
    Release,
    /// Volume up: moves the eyes 1 mm further apart.
    IpdUp,
    /// Volume down: moves the eyes 1 mm closer together.
    IpdDown,
    /// Shows or hides the HUD.
    ToggleHud,
    /// Goes to the scene's next viewpoint.
    NextViewpoint,
    /// Loads the next scene; the built-in scenes come first, then the files in the scene folders.
    NextScene,
}

/// The effect of an event, for the log.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Action {
    /// The method now in use.
    Method(MethodChoice),
    /// The head's present direction becomes straight ahead. The display has to do this.
    Recenter,
    /// The menu was opened or closed.
    Menu(bool),
    /// The menu has changed settings. The display applies them, see `Viewer::take_settings`.
    Settings,
    /// The start screen was opened (true) or left (false), which makes the head's direction straight ahead.
    StartScreen(bool),
    /// The user wants to share the log with another application. The platform has to do this.
    ShareLog,
    /// The user wants to share the notices of others' code with another application. The platform has to do this.
    ShareNotices,
    /// The platform has to start (true) or stop (false) looking for a viewer's code with the phone's camera.
    Scan(bool),
    /// The distance between the eyes.
    Ipd(Ipd),
    /// True if the HUD is shown.
    Hud(bool),
    /// The HUD is now shown (true) or hidden (false).
    Viewpoint(usize),
    /// Another scene is being loaded, see [`Viewer::scene_name`](crate::Viewer::scene_name).
    Scene,
    /// The slider's marker was moved to this rating.
    Marker(f32),
    /// A question was answered; the answer is the last of [`Viewer::ratings`](crate::Viewer::ratings).
    Answer,
    #[default]
    /// Nothing, because a question is being asked, or because there is no other method, viewpoint or scene.
    Nothing,
}

impl fmt::Display for Action {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Action::Method(method) => write!(f, "method: {}", method.name()),
            Action::Recenter => f.write_str("recentered"),
            Action::Menu(is_open) => write!(f, "menu: {}", if *is_open { "open" } else { "closed" }),
            Action::Settings => f.write_str("settings of the menu"),
            Action::StartScreen(is_shown) => {
                write!(f, "start screen: {}", if *is_shown { "shown" } else { "left" })
            }
            Action::ShareLog => f.write_str("the log is shared"),
            Action::ShareNotices => f.write_str("the notices are shared"),
            Action::Scan(is_on) => write!(f, "scan: {}", if *is_on { "on" } else { "off" }),
            Action::Ipd(ipd) => write!(f, "ipd: {:.3} m", ipd.metres()),
            Action::Hud(is_shown) => write!(f, "HUD: {}", if *is_shown { "on" } else { "off" }),
            Action::Viewpoint(n) => write!(f, "viewpoint: {n}"),
            Action::Scene => f.write_str("another scene"),
            Action::Marker(rating) => write!(f, "marker: {rating}"),
            Action::Answer => f.write_str("answered"),
            Action::Nothing => f.write_str("nothing"),
        }
    }
}
