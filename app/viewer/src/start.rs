//! The start screen: when it comes into view, and its tiles, without GL.

use crate::caption::wrap;
use yoro_lenses::{HEADING_COLUMNS, TILE_COLUMNS, Tiles};

/// The phone stands upright when its picture lies on its side by more than this: the sine of 50 degrees.
const UPRIGHT: f32 = 0.766;
/// It lies in landscape again when its picture lies on its side by less than this: the sine of 30 degrees.
const LANDSCAPE: f32 = 0.5;
/// Standing upright for so long brings the start screen into view, in nanoseconds.
const UPRIGHT_NS: i64 = 1_000_000_000;
/// The viewers that there is room for.
pub(crate) const VIEWERS: usize = 4;
/// Says how to get another viewer's parameters.
pub(crate) const OTHER: &str = "Another viewer: scan the code on it with your camera application and share its address \
    with yoro, or share a picture of the code. It has no code: try v2, then v1.";

/// A tile of the start screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Tile {
    /// One of the viewers.
    Viewer(usize),
    Other,
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
        Tile::Other,
        Tile::Log,
        Tile::Reset,
        Tile::Start,
    ];
}

/// The start screen, in view or not.
#[derive(Default)]
pub(crate) struct StartScreen {
    /// True if a person has started the application by hand: only then it comes into view.
    pub is_offered: bool,
    pub is_shown: bool,
    /// A sentence in place of the explanation.
    pub message: String,
    /// True until the first frame of the scene, which says how the menu is opened.
    pub is_hint_due: bool,
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
        self.is_hint_due = true;
    }

    /// Notes how far the picture's horizontal points up, -1 to 1. True if the phone has come to stand upright.
    pub fn tilt(&mut self, sideways: f32, now_ns: i64) -> bool {
        if !self.is_offered || self.is_shown {
            return false;
        }
        self.is_on_its_way &= sideways.abs() >= LANDSCAPE;
        if sideways.abs() < UPRIGHT || self.is_on_its_way {
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
            Tile::Other => "Another\nviewer".into(),
            Tile::Log => "Share\nthe log".into(),
            Tile::Reset => "Reset\nall settings".into(),
            Tile::Start => "Start".into(),
        };
        self.tiles.tiles = Tile::ALL.iter().map(tile).collect();
        self.tiles.pointed = chosen.map(|i| (i, 1.0));
        let heading = &mut self.tiles.heading;
        heading.clear();
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

    const MS: i64 = 1_000_000;

    #[test]
    fn an_upright_phone_brings_it_into_view_but_not_on_its_way_into_the_viewer() {
        let mut start = StartScreen::default();
        assert!(!start.tilt(1.0, 0) && !start.tilt(1.0, 5000 * MS), "it was not offered");
        start.is_offered = true;
        assert!(!start.tilt(-1.0, 0) && !start.tilt(0.1, 900 * MS));
        assert!(!start.tilt(-1.0, 1000 * MS) && start.tilt(-0.9, 2000 * MS));
        start.show("");
        assert!(!start.tilt(1.0, 9000 * MS));
        start.leave();
        assert!(!start.tilt(1.0, 10_000 * MS) && !start.tilt(1.0, 19_000 * MS), "on its way");
        assert!(!start.tilt(0.2, 20_000 * MS) && !start.tilt(0.9, 21_000 * MS));
        assert!(start.tilt(0.9, 22_000 * MS));
    }

    #[test]
    fn every_line_has_room() {
        let viewers = [["Cardboard", "v1"], ["A maker of many viewers", "Its model of 2015"]];
        let viewers = viewers.map(|names| names.map(str::to_owned));
        let mut start = StartScreen::default();
        for message in ["", OTHER] {
            start.show(message);
            start.write(&viewers, Some(1), "right");
            let Tiles { heading, tiles, .. } = &start.tiles;
            assert!(heading.lines().all(|line| line.chars().count() <= HEADING_COLUMNS), "{heading}");
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
