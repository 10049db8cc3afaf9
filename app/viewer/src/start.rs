//! The start screen: when it comes into view, and its tiles, without GL.

use crate::caption::wrap;
use glam::Vec3;
use yoro_lenses::{HEADING_COLUMNS, PICTURE_COLUMNS, Rotation, TILE_COLUMNS, Tiles};

/// The phone stands upright when its top is up by more than this within its own plane: the sine of 50 degrees.
const UPRIGHT: f32 = 0.766;
/// It lies in landscape again when its top is up or down by less than this: the sine of 30 degrees.
const LANDSCAPE: f32 = 0.5;
/// Who reads an upright phone leans it back: its screen points up by this and more, the sine of 15 degrees. Behind
/// lenses, it points to the eyes of one who lies on a side, and hardly ever up.
const LEANS_BACK: f32 = 0.259;
/// It lies on a table, neither upright nor in landscape, when its screen points up by more than this: the sine of 70
/// degrees.
const FLAT: f32 = 0.94;
/// Standing upright for so long brings the start screen into view, in nanoseconds.
const UPRIGHT_NS: i64 = 1_000_000_000;
/// The viewers that there is room for.
pub(crate) const VIEWERS: usize = 4;
/// Says how to get another viewer's parameters without yoro's own scan.
pub(crate) const OTHER: &str = "Another viewer: scan the code on it with your camera application and share its address \
    with yoro, or share a picture of the code. It has no code: try v2, then v1.";
/// Says what to do while yoro scans.
const SCAN: &str = "Hold the phone a hand's width before the code on the viewer, in even light. Or scan it with your \
    camera application, and share its address with yoro.";
/// What is seen, in lines of the HUD; the eye's name comes between the first two.
const EXPLANATION: [&str; 2] = [
    "The ",
    " eye's picture is made up\nMenu, Compare: both eyes rendered\nFigures: FPS, ms a frame, Celsius\nHold, or look down: the menu",
];

/// A tile of the start screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Tile {
    /// One of the viewers.
    Viewer(usize),
    Scan,
    Log,
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
        Tile::Log,
        Tile::Reset,
        Tile::Start,
    ];
}

/// What the HUD says once the scene is in view.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Hint {
    #[default]
    None,
    /// How the menu is opened.
    Menu,
    /// What is seen, as well.
    Explanation,
}

impl Hint {
    /// Returns the lines for the HUD; `made_up` is the eye that is synthesized.
    pub fn text(self, made_up: &str) -> Option<String> {
        let [before, after] = EXPLANATION;
        match self {
            Hint::None => None,
            Hint::Menu => Some("Hold, or look down: the menu".into()),
            Hint::Explanation => Some([before, made_up, after].concat()),
        }
    }
}

/// The start screen, in view or not.
#[derive(Default)]
pub(crate) struct StartScreen {
    /// True if a person has started the application by hand: only then it comes into view.
    pub is_offered: bool,
    pub is_shown: bool,
    /// A sentence in place of the explanation.
    pub message: String,
    /// What the first frame of the scene says.
    pub hint: Hint,
    /// True while the phone's camera looks for a code.
    pub is_scanning: bool,
    pub tiles: Tiles,
    /// The phone stands upright since.
    upright_since: Option<i64>,
    /// True from leaving the screen until the phone lies in landscape.
    is_on_its_way: bool,
}

impl StartScreen {
    /// Brings it into view.
    pub fn show(&mut self, message: &str) {
        self.is_shown = true;
        message.clone_into(&mut self.message);
    }

    /// The user starts: an upright phone means nothing until it lies in landscape.
    pub fn leave(&mut self) {
        (self.is_shown, self.upright_since, self.is_on_its_way) = (false, None, true);
        if self.hint == Hint::None {
            self.hint = Hint::Menu;
        }
    }

    /// Notes which way is up in the picture: X to its right, Y to its top, Z out of the screen. True if the phone has
    /// come to stand upright.
    pub fn tilt(&mut self, up: Vec3, rotation: Rotation, now_ns: i64) -> bool {
        if !self.is_offered || self.is_shown {
            return false;
        }
        let top = match rotation {
            Rotation::LandscapeLeft => -up.x,
            Rotation::LandscapeRight => up.x,
            // A tablet, whose picture is wide when it stands upright.
            Rotation::Portrait => 0.0,
        };
        // Within the screen's plane: it may lean back.
        let top = if up.z < FLAT { top / up.truncate().length().max(0.1) } else { 0.0 };
        self.is_on_its_way &= top.abs() >= LANDSCAPE;
        if top < UPRIGHT || up.z < LEANS_BACK || self.is_on_its_way {
            self.upright_since = None;
            return false;
        }
        now_ns - *self.upright_since.get_or_insert(now_ns) >= UPRIGHT_NS
    }

    /// Writes the texts: the names of the viewers, which of them is chosen, and the eye that is made up.
    pub fn write(&mut self, viewers: &[[String; 2]], chosen: Option<usize>, made_up: &str) {
        let cut = |name: &String| name.chars().take(TILE_COLUMNS).collect::<String>();
        let tile = |tile: &Tile| match *tile {
            Tile::Viewer(i) => viewers
                .get(i)
                .map_or_else(String::new, |[maker, model]| format!("{}\n{}", cut(maker), cut(model))),
            Tile::Scan if self.is_scanning => "Stop\nscanning".into(),
            Tile::Scan => "Scan a\nnew viewer".into(),
            Tile::Log => "Share\nthe log".into(),
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
            "By yoro, the {made_up} eye's picture is made up.\n\
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
