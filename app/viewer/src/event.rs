//! The user's actions and their effects.

use std::fmt;

use yoro_protocol::{Ipd, MethodChoice};

/// An action of the user.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// A tap on the screen, the viewer's trigger, or a controller's: the next method, or the tile of the menu that is
    /// pointed at.
    Tap,
    /// The method before.
    PreviousMethod,
    /// A long press: opens the menu; in the menu, straight ahead is where the head points now.
    LongPress,
    /// The trigger goes down: in the menu, comparing begins.
    Press,
    /// The trigger goes up.
    Release,
    /// Volume up: the eyes a millimetre further apart.
    IpdUp,
    /// Volume down: the eyes a millimetre closer.
    IpdDown,
    /// Shows or hides the HUD.
    ToggleHud,
    /// Goes to the scene's next viewpoint.
    NextViewpoint,
    /// Loads the next scene: the built-in ones, then the files in the scene folders.
    NextScene,
}

/// The effect of an event, for the log.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Action {
    /// The method that is used now.
    Method(MethodChoice),
    /// The head's direction starts over: that is for the display to do.
    Recenter,
    /// The menu was opened or closed.
    Menu(bool),
    /// The menu has changed settings, which the display takes: `Viewer::take_settings`.
    Settings,
    /// The start screen came into view (true), or the user starts from it: the head's direction starts over.
    StartScreen(bool),
    /// The user wants to give the log to another application: that is for the platform to do.
    ShareLog,
    /// The user wants the phone's camera to look for a viewer's code, or no longer: that is for the platform to do.
    Scan(bool),
    /// The distance between the eyes.
    Ipd(Ipd),
    /// True if the HUD is shown.
    Hud(bool),
    /// The viewpoint's number.
    Viewpoint(usize),
    /// Another scene is being loaded: [`Viewer::scene_name`](crate::Viewer::scene_name).
    Scene,
    /// The marker of the slider was moved to this rating.
    Marker(f32),
    /// A question was answered: the last of [`Viewer::ratings`](crate::Viewer::ratings).
    Answer,
    #[default]
    /// Nothing, because a question is being asked, or there is no other method, viewpoint or scene.
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
