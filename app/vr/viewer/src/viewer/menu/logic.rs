//! The menu's logic, without GL: which tile is pointed at, and which is chosen.

use glam::{Quat, Vec2, Vec3};

use yoro::eyes::Pose;
use yoro_lenses::{Tiles, board_hit, board_pose, tile_at};

/// How long a tile has to be looked at to be chosen, in nanoseconds.
const DWELL_NS: i64 = 1_500_000_000;
/// How long the user has to look down to open the menu, in nanoseconds.
const DOWN_NS: i64 = 1_000_000_000;
/// The user looks down if the Y coordinate of the head's forward direction is below this: 50 degrees below the horizon.
const DOWN: f32 = -0.766;
/// Number of steps in which a tile's progress bar fills.
const STEPS: f32 = 24.0;

/// A tile of the menu. The variants are in the order of the tiles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::viewer) enum Item {
    Recenter,
    Scene,
    Viewpoint,
    Method,
    Eye,
    Lenses,
    Distance,
    Quality,
    Hud,
    Compare,
    Reset,
    Close,
}

impl Item {
    pub const ALL: [Item; 12] = [
        Item::Recenter,
        Item::Scene,
        Item::Viewpoint,
        Item::Method,
        Item::Eye,
        Item::Lenses,
        Item::Distance,
        Item::Quality,
        Item::Hud,
        Item::Compare,
        Item::Reset,
        Item::Close,
    ];
}

/// A tile and which half of it: 1 for the right half (next, more), -1 for the left half (previous, less).
pub(in crate::viewer) type Choice = (Item, isize);

/// The menu, whether open or not.
#[derive(Default)]
pub(in crate::viewer) struct Menu {
    /// The pose of the open panel, relative to the viewpoint.
    pub board: Option<Pose>,
    /// The head's pose in the last frame.
    head: Option<Pose>,
    /// The point on the panel that is pointed at, 0 to 1 from the lower left.
    pub hit: Option<Vec2>,
    /// The tile that is pointed at.
    pub pointed: Option<Choice>,
    /// The time from which that tile has been pointed at.
    since_ns: i64,
    is_spent: bool,
    /// The time from which the head has looked down; `Some(None)` once this has opened the menu.
    down: Option<Option<i64>>,
    is_pressed: bool,
    /// The panel's content.
    pub tiles: Tiles,
}

impl Menu {
    /// Opens the menu in front of the head.
    pub fn open(&mut self) {
        self.board = Some(board_pose(self.head.unwrap_or(Pose::IDENTITY)));
        (self.hit, self.pointed, self.is_pressed) = (None, None, false);
    }

    /// Closes the menu.
    pub fn close(&mut self) {
        (self.board, self.hit, self.pointed, self.is_pressed) = (None, None, None, false);
    }

    /// Records that the trigger was pressed or released.
    pub fn press(&mut self, is_pressed: bool) {
        self.is_pressed = is_pressed && self.board.is_some();
    }

    /// True while two real renders are to be compared: the trigger is held on the tile, or the tile has been looked at
    /// for long enough.
    pub fn is_comparing(&self) -> bool {
        matches!(self.pointed, Some((Item::Compare, _))) && (self.is_pressed || self.is_spent)
    }

    /// Updates the menu with the direction of the head. Opens it if the user has looked down for long enough, and
    /// returns the tile that has been looked at for long enough. If a ray along the -Z of one of `rays` hits the panel,
    /// it points instead of the head, and then only the trigger chooses a tile.
    pub fn look(&mut self, head: Pose, rays: [Option<Pose>; 2], now_ns: i64) -> Look {
        self.head = Some(head);
        let Some(board) = &self.board else { return self.look_down(head, now_ns) };
        let by_ray = rays.iter().flatten().find_map(|ray| board_hit(board, ray));
        self.hit = by_ray.or_else(|| board_hit(board, &head));
        if by_ray.is_some() {
            (self.since_ns, self.is_spent) = (now_ns, false);
        }
        let tile = self
            .hit
            .and_then(|at| tile_at(at, Item::ALL.len()))
            .map(|(i, share)| (i, if share < 0.5 { -1 } else { 1 }));
        let pointed = tile.map(|(i, step)| (Item::ALL[i], step));
        if pointed != self.pointed {
            // Both halves of the comparison's tile do the same.
            let is_same =
                matches!((pointed, self.pointed), (Some((Item::Compare, _)), Some((Item::Compare, _))));
            self.pointed = pointed;
            if !is_same {
                (self.since_ns, self.is_spent) = (now_ns, false);
            }
        }
        let share = if self.is_spent { 0.0 } else { (now_ns - self.since_ns) as f32 / DWELL_NS as f32 };
        self.tiles.pointed = tile.map(|(i, _)| (i, (share * STEPS).floor() / STEPS));
        match pointed {
            Some(choice) if share >= 1.0 => {
                self.is_spent = true;
                Look::Choose(choice)
            }
            _ => Look::Nothing,
        }
    }

    fn look_down(&mut self, head: Pose, now_ns: i64) -> Look {
        if head.forward().y > DOWN {
            self.down = None;
            return Look::Nothing;
        }
        match self.down {
            None => self.down = Some(Some(now_ns)),
            Some(Some(since)) if now_ns - since >= DOWN_NS => {
                self.down = Some(None);
                // The panel stands at the horizon. The top of a head that looks down points to the body's front.
                let ahead = head.forward() + head.orientation * Vec3::Y;
                let heading = Quat::from_rotation_y((-ahead.x).atan2(-ahead.z));
                self.open();
                self.board = Some(board_pose(Pose { position: head.position, orientation: heading }));
                return Look::Open;
            }
            Some(_) => {}
        }
        Look::Nothing
    }

    /// Records that the trigger has chosen a tile: continuing to look at it does not choose it again.
    pub fn spend(&mut self) {
        self.is_spent = !matches!(self.pointed, Some((Item::Compare, _)));
    }
}

/// The outcome of [`Menu::look`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::viewer) enum Look {
    Nothing,
    /// The menu was opened.
    Open,
    /// A tile was chosen.
    Choose(Choice),
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: i64 = 1_000_000;

    fn head(yaw_degrees: f32, pitch_degrees: f32) -> Pose {
        let turn = |axis: fn(f32) -> Quat, degrees: f32| axis(degrees.to_radians());
        let orientation =
            turn(Quat::from_rotation_y, yaw_degrees) * turn(Quat::from_rotation_x, pitch_degrees);
        Pose { orientation, ..Pose::IDENTITY }
    }

    #[test]
    fn a_tile_is_chosen_once_by_looking_at_it() {
        let mut menu = Menu::default();
        menu.look(head(0.0, 0.0), [None; 2], 0);
        menu.open();
        // The upper left tile.
        let at = head(15.0, 2.0);
        assert_eq!(menu.look(at, [None; 2], 0), Look::Nothing);
        assert_eq!(menu.pointed.unwrap().0, Item::Recenter);
        assert_eq!(menu.look(at, [None; 2], 1499 * MS), Look::Nothing);
        assert!(menu.tiles.pointed.unwrap().1 > 0.9);
        assert!(matches!(menu.look(at, [None; 2], 1500 * MS), Look::Choose((Item::Recenter, _))));
        assert_eq!(menu.look(at, [None; 2], 9000 * MS), Look::Nothing);
        // Looks away and back.
        menu.look(head(60.0, 0.0), [None; 2], 9100 * MS);
        assert_eq!((menu.pointed, menu.hit), (None, None));
        menu.look(at, [None; 2], 9200 * MS);
        assert!(matches!(menu.look(at, [None; 2], 10_700 * MS), Look::Choose(_)));
        // Another tile.
        menu.look(head(-15.0, 2.0), [None; 2], 11_000 * MS);
        assert_eq!(menu.pointed.unwrap().0, Item::Method);
    }

    #[test]
    fn looking_down_opens_it_once_at_the_horizon() {
        let mut menu = Menu::default();
        let down = head(90.0, -85.0);
        assert_eq!(menu.look(down, [None; 2], 0), Look::Nothing);
        assert_eq!(menu.look(head(90.0, -20.0), [None; 2], 900 * MS), Look::Nothing);
        assert_eq!(menu.look(down, [None; 2], 1000 * MS), Look::Nothing);
        assert_eq!(menu.look(down, [None; 2], 2000 * MS), Look::Open);
        let board = menu.board.unwrap();
        assert!(board.position.abs_diff_eq(Vec3::new(-2.0, 0.0, 0.0), 1e-3), "{}", board.position);
        menu.close();
        assert_eq!(menu.look(down, [None; 2], 9000 * MS), Look::Nothing);
    }

    #[test]
    fn comparing_lasts_as_long_as_it_is_asked_for() {
        let mut menu = Menu::default();
        menu.look(head(0.0, 0.0), [None; 2], 0);
        menu.open();
        let at = head(4.0, -8.0);
        menu.look(at, [None; 2], 0);
        assert_eq!(menu.pointed.unwrap().0, Item::Compare);
        menu.press(true);
        assert!(menu.is_comparing());
        menu.press(false);
        assert!(!menu.is_comparing());
        menu.look(at, [None; 2], 1500 * MS);
        assert!(menu.is_comparing());
        menu.look(head(15.0, 2.0), [None; 2], 1600 * MS);
        assert!(!menu.is_comparing());
    }

    #[test]
    fn a_ray_points_in_place_of_the_head_and_never_chooses_by_itself() {
        let mut menu = Menu::default();
        menu.look(head(0.0, 0.0), [None; 2], 0);
        menu.open();
        // A hand to the right of the body. Its ray hits the tile that the head would point at in the upper left.
        let hand = Vec3::new(0.2, -0.3, -0.2);
        let target = 2.0 * head(15.0, 2.0).forward();
        let ray = Pose {
            position: hand,
            orientation: Quat::from_rotation_arc(Vec3::NEG_Z, (target - hand).normalize()),
        };
        let gaze = head(-15.0, 2.0);
        menu.look(gaze, [Some(ray), None], 0);
        assert_eq!(menu.pointed.unwrap().0, Item::Recenter);
        assert_eq!(menu.look(gaze, [Some(ray), None], 9000 * MS), Look::Nothing);
        // The ray misses the panel: the head points again, and the time starts anew.
        let past = Pose { orientation: Quat::IDENTITY, position: Vec3::new(3.0, 0.0, 0.0) };
        assert_eq!(menu.look(gaze, [None, Some(past)], 9100 * MS), Look::Nothing);
        assert_eq!(menu.pointed.unwrap().0, Item::Method);
        assert!(matches!(menu.look(gaze, [None, Some(past)], 10_600 * MS), Look::Choose((Item::Method, _))));
        // The second of two hands.
        menu.look(gaze, [Some(past), Some(ray)], 10_700 * MS);
        assert_eq!(menu.pointed.unwrap().0, Item::Recenter);
    }
}
