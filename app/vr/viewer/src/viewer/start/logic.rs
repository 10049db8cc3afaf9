//! The start screen's logic, without GL: when it appears, and its tiles.

use crate::caption::wrap;
use glam::Vec3;
use yoro_lenses::{HEADING_COLUMNS, PICTURE_COLUMNS, Rotation, TILE_COLUMNS, Tiles};

/// The phone is upright if its top points up by more than this within the screen's plane: the sine of 50 degrees.
const UPRIGHT: f32 = 0.766;
/// The phone is in landscape again if its top points up or down by less than this: the sine of 30 degrees.
const LANDSCAPE: f32 = 0.5;
/// People who read an upright phone lean it back, so its screen points up by at least this: the sine of 15 degrees.
/// Behind lenses, the screen points at the eyes of a person lying on one side, and hardly ever up.
const LEANS_BACK: f32 = 0.259;
/// The phone lies on a table, neither upright nor in landscape, if its screen points up by more than this: the sine of
/// 70 degrees.
const FLAT: f32 = 0.94;
/// How long the phone has to be upright for the start screen to appear, in nanoseconds.
const UPRIGHT_NS: i64 = 1_000_000_000;
/// The number of viewers for which the start screen has tiles.
pub(in crate::viewer) const VIEWERS: usize = 4;
/// Tells the user how to choose another viewer without yoro's own scan.
pub(in crate::viewer) const OTHER: &str = "Another viewer: scan the code on it with your camera application and share its address \
    with yoro, or share a picture of the code. It has no code: try v2, then v1.";
/// Tells the user what to do while yoro scans.
const SCAN: &str = "Hold the phone a hand's width before the code on the viewer, in even light. Or scan it with your \
    camera application, and share its address with yoro.";
/// Explains the scene to a new user, in lines of the HUD. The name of the synthesized eye goes between the two parts.
const EXPLANATION: [&str; 2] = [
    "The ",
    " eye's picture is made up\nMenu, Compare: both eyes rendered\nFigures: FPS, ms a frame, Celsius\nHold, or look down: the menu",
];

/// A tile of the start screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::viewer) enum Tile {
    /// The viewer with this index.
    Viewer(usize),
    Scan,
    /// On its left half the log is shared, on its right half the notices of others' code.
    Share,
    Reset,
    Start,
}

impl Tile {
    pub const ALL: [Tile; VIEWERS + 4] = [
        Tile::Viewer(0),
        Tile::Viewer(1),
        Tile::Viewer(2),
        Tile::Viewer(3),
        Tile::Scan,
        Tile::Share,
        Tile::Reset,
        Tile::Start,
    ];
}

/// What the HUD tells the user once the scene is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(in crate::viewer) enum Hint {
    #[default]
    None,
    /// How the menu is opened.
    Menu,
    /// How the menu is opened, and what the picture and the figures mean.
    Explanation,
}

impl Hint {
    /// Returns the lines for the HUD; `synthesized` names the synthesized eye.
    pub fn text(self, synthesized: &str) -> Option<String> {
        let [before, after] = EXPLANATION;
        match self {
            Hint::None => None,
            Hint::Menu => Some("Hold, or look down: the menu".into()),
            Hint::Explanation => Some([before, synthesized, after].concat()),
        }
    }
}

/// The start screen, whether shown or not.
#[derive(Default)]
pub(in crate::viewer) struct StartScreen {
    /// True if a person has started the application by hand; the start screen appears only then.
    pub is_offered: bool,
    pub is_shown: bool,
    /// A sentence shown instead of the explanation.
    pub message: String,
    /// What the HUD tells the user in the scene's first frame.
    pub hint: Hint,
    /// True while the phone's camera looks for a code.
    pub is_scanning: bool,
    pub tiles: Tiles,
    /// The time from which the phone has been upright.
    upright_since: Option<i64>,
    /// True from when the user leaves the start screen until the phone is in landscape.
    ignores_upright: bool,
}

impl StartScreen {
    /// Shows the start screen.
    pub fn show(&mut self, message: &str) {
        self.is_shown = true;
        message.clone_into(&mut self.message);
    }

    /// Leaves the start screen. An upright phone is ignored until it has been in landscape.
    pub fn leave(&mut self) {
        (self.is_shown, self.upright_since, self.ignores_upright) = (false, None, true);
        if self.hint == Hint::None {
            self.hint = Hint::Menu;
        }
    }

    /// Records the up direction in the picture's axes: X to its right, Y to its top, Z out of the screen. Returns true
    /// if the phone has been upright for long enough.
    pub fn tilt(&mut self, up: Vec3, rotation: Rotation, now_ns: i64) -> bool {
        if !self.is_offered || self.is_shown {
            return false;
        }
        let top = match rotation {
            Rotation::LandscapeLeft => -up.x,
            Rotation::LandscapeRight => up.x,
            // A tablet, whose picture is wide when it is upright.
            Rotation::Portrait => 0.0,
        };
        // Only the direction within the screen's plane counts, since the phone may lean back.
        let top = if up.z < FLAT { top / up.truncate().length().max(0.1) } else { 0.0 };
        self.ignores_upright &= top.abs() >= LANDSCAPE;
        if top < UPRIGHT || up.z < LEANS_BACK || self.ignores_upright {
            self.upright_since = None;
            return false;
        }
        now_ns - *self.upright_since.get_or_insert(now_ns) >= UPRIGHT_NS
    }

    /// Writes the texts: the viewers' names, which of them is chosen, and which eye is synthesized.
    pub fn write(&mut self, viewers: &[[String; 2]], chosen: Option<usize>, synthesized: &str) {
        let cut = |name: &String| name.chars().take(TILE_COLUMNS).collect::<String>();
        let tile = |tile: &Tile| match *tile {
            Tile::Viewer(i) => viewers
                .get(i)
                .map_or_else(String::new, |[maker, model]| format!("{}\n{}", cut(maker), cut(model))),
            Tile::Scan if self.is_scanning => "Stop\nscanning".into(),
            Tile::Scan => "Scan a\nnew viewer".into(),
            Tile::Share => "Share the\nlog  notices".into(),
            Tile::Reset => "Reset\nall settings".into(),
            Tile::Start => "Start".into(),
        };
        self.tiles.tiles = Tile::ALL.iter().map(tile).collect();
        self.tiles.pointed = chosen.map(|i| (i, 1.0));
        let heading = &mut self.tiles.heading;
        heading.clear();
        if self.is_scanning {
            return wrap(heading, SCAN, HEADING_COLUMNS - PICTURE_COLUMNS);
        }
        heading.push_str(
            "Choose your viewer, touch Start, and put the phone\n\
             into the viewer, its top to the left.\n",
        );
        if !self.message.is_empty() {
            heading.push('\n');
            return wrap(heading, &self.message, HEADING_COLUMNS);
        }
        heading.push_str(&format!(
            "By yoro, the {synthesized} eye's picture is made up.\n\
             Compare, in the menu: both eyes are rendered.\n\
             Figures: frames a second, a frame's ms, degrees C.\n\
             A tap changes the method; a hold opens the menu, as\n\
             looking straight down for a second does."
        ));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use yoro_lenses::COLUMNS;

    const MS: i64 = 1_000_000;

    #[test]
    fn an_upright_phone_brings_it_into_view_but_not_on_its_way_into_the_viewer() {
        let [across, level] = [Vec3::new(-0.8, 0.0, 0.6), Vec3::Y];
        let mut start = StartScreen::default();
        let tilt =
            |start: &mut StartScreen, up: Vec3, ms: i64| start.tilt(up, Rotation::LandscapeLeft, ms * MS);
        assert!(!tilt(&mut start, across, 0) && !tilt(&mut start, across, 5000), "it was not offered");
        start.is_offered = true;
        assert!(!tilt(&mut start, across, 0) && !tilt(&mut start, level, 900));
        assert!(!tilt(&mut start, across, 1000) && tilt(&mut start, across, 2000));
        start.show("");
        assert!(!tilt(&mut start, across, 9000));
        start.leave();
        assert!(!tilt(&mut start, across, 10_000) && !tilt(&mut start, across, 19_000), "on its way");
        assert!(!tilt(&mut start, level, 20_000) && !tilt(&mut start, across, 21_000));
        assert!(tilt(&mut start, across, 22_000));
    }

    #[test]
    fn who_lies_on_a_side_or_puts_the_phone_on_a_table_goes_on_watching() {
        let mut start = StartScreen { is_offered: true, ..StartScreen::default() };
        // On the left side, on the right side and looking up, upside down in the hand, on a table, lying on the back.
        let ups = [
            Vec3::X,
            Vec3::NEG_X,
            Vec3::new(-0.9, 0.0, -0.43),
            Vec3::new(0.8, 0.0, 0.6),
            Vec3::new(-0.2, 0.0, 0.98),
            Vec3::NEG_Z,
        ];
        for (i, up) in ups.into_iter().enumerate() {
            let begin = 10_000 * i as i64 * MS;
            for ms in [0, 5000] {
                assert!(!start.tilt(up, Rotation::LandscapeLeft, begin + ms * MS), "{up}");
            }
            assert!(!start.tilt(Vec3::new(-up.x, up.y, up.z), Rotation::LandscapeRight, begin + 5001 * MS));
            assert!(!start.tilt(up, Rotation::Portrait, begin + 9000 * MS), "{up}");
        }
    }

    #[test]
    fn the_explanation_fits_the_hud() {
        for eye in ["left", "right"] {
            let text = Hint::Explanation.text(eye).unwrap();
            assert!(text.lines().count() == 4 && text.lines().all(|line| line.len() <= COLUMNS), "{text}");
        }
    }

    #[test]
    fn every_line_has_room() {
        let viewers = [["Cardboard", "v1"], ["A maker of many viewers", "Its model of 2015"]];
        let viewers = viewers.map(|names| names.map(str::to_owned));
        let mut start = StartScreen::default();
        for (message, is_scanning) in [("", false), (OTHER, false), ("", true)] {
            start.show(message);
            start.is_scanning = is_scanning;
            start.write(&viewers, Some(1), "right");
            let Tiles { heading, tiles, .. } = &start.tiles;
            let columns = HEADING_COLUMNS - if is_scanning { PICTURE_COLUMNS } else { 0 };
            assert!(heading.lines().all(|line| line.chars().count() <= columns), "{heading}");
            assert!(heading.lines().count() <= 7, "{heading}");
            for tile in tiles {
                assert!(tile.lines().count() <= 2, "{tile}");
                assert!(tile.lines().all(|line| line.chars().count() <= TILE_COLUMNS), "{tile}");
            }
        }
        assert_eq!(start.tiles.tiles[1], "A maker of m\nIts model of");
        assert_eq!(start.tiles.tiles[2], "");
    }
}
