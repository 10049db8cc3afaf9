//! The menu: what is pointed at and chosen, without GL.

use glam::{Quat, Vec2, Vec3};

use yoro::eyes::Pose;
use yoro_lenses::{Tiles, board_hit, board_pose, tile_at};

/// Looking at a tile for so long chooses it, in nanoseconds.
const DWELL_NS: i64 = 1_500_000_000;
/// Looking down for so long opens the menu, in nanoseconds.
const DOWN_NS: i64 = 1_000_000_000;
/// Looking down means that straight ahead is lower than this: the sine of 50 degrees below the horizon.
const DOWN: f32 = -0.766;
/// The steps in which the bar of a tile fills.
const STEPS: f32 = 24.0;

/// A tile of the menu, in the order in which they stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Item {
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

/// A tile and its half: 1 for the next or more (right), -1 for the one before or less (left).
pub(crate) type Choice = (Item, isize);

/// The menu, open or not.
#[derive(Default)]
pub(crate) struct Menu {
    /// The place of the open panel, relative to the viewpoint.
    board: Option<Pose>,
    /// The head in the last frame.
    head: Option<Pose>,
    /// The place on the panel that is pointed at.
    hit: Option<Vec2>,
    pointed: Option<Choice>,
    /// The time since which that tile is pointed at.
    since_ns: i64,
    is_spent: bool,
    /// The time since which the head looks down; `Some(None)` when the menu was opened by that.
    down: Option<Option<i64>>,
    is_pressed: bool,
    /// What the panel shows.
    pub tiles: Tiles,
}

impl Menu {
    /// The place of the open panel, relative to the viewpoint.
    pub fn board(&self) -> Option<Pose> {
        self.board
    }

    /// The place on the panel that is pointed at, 0 to 1 from the lower left.
    pub fn hit(&self) -> Option<Vec2> {
        self.hit
    }

    /// Opens the menu where the head looks.
    pub fn open(&mut self) {
        self.board = Some(board_pose(self.head.unwrap_or(Pose::IDENTITY)));
        (self.hit, self.pointed, self.is_pressed) = (None, None, false);
    }

    /// Closes the menu.
    pub fn close(&mut self) {
        (self.board, self.hit, self.pointed, self.is_pressed) = (None, None, None, false);
    }

    /// Notes that the trigger goes down or up.
    pub fn press(&mut self, is_pressed: bool) {
        self.is_pressed = is_pressed && self.board.is_some();
    }

    /// True while two real renders are asked for: the trigger is held on the tile, or it has been looked at long
    /// enough.
    pub fn is_comparing(&self) -> bool {
        matches!(self.pointed, Some((Item::Compare, _))) && (self.is_pressed || self.is_spent)
    }

    /// Returns the tile that is pointed at.
    pub fn pointed(&self) -> Option<Choice> {
        self.pointed
    }

    /// The user looks somewhere: opens the menu if that was down for long enough, and returns the tile that has been
    /// looked at for long enough. A ray along the -Z of one of `rays` that meets the panel points in place of the head,
    /// and chooses by the trigger alone.
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
            // Either half of the tile for comparing is the same.
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
                // The panel stands at the horizon: what is up for a head that looks down is ahead for the body.
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

    /// Notes that a tile was chosen by the trigger: looking at it on does nothing more.
    pub fn spend(&mut self) {
        self.is_spent = !matches!(self.pointed, Some((Item::Compare, _)));
    }
}

/// What follows from looking somewhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Look {
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
        assert_eq!(menu.pointed().unwrap().0, Item::Recenter);
        assert_eq!(menu.look(at, [None; 2], 1499 * MS), Look::Nothing);
        assert!(menu.tiles.pointed.unwrap().1 > 0.9);
        assert!(matches!(menu.look(at, [None; 2], 1500 * MS), Look::Choose((Item::Recenter, _))));
        assert_eq!(menu.look(at, [None; 2], 9000 * MS), Look::Nothing);
        // Away and back.
        menu.look(head(60.0, 0.0), [None; 2], 9100 * MS);
        assert_eq!((menu.pointed(), menu.hit()), (None, None));
        menu.look(at, [None; 2], 9200 * MS);
        assert!(matches!(menu.look(at, [None; 2], 10_700 * MS), Look::Choose(_)));
        // Another tile.
        menu.look(head(-15.0, 2.0), [None; 2], 11_000 * MS);
        assert_eq!(menu.pointed().unwrap().0, Item::Method);
    }

    #[test]
    fn looking_down_opens_it_once_at_the_horizon() {
        let mut menu = Menu::default();
        let down = head(90.0, -85.0);
        assert_eq!(menu.look(down, [None; 2], 0), Look::Nothing);
        assert_eq!(menu.look(head(90.0, -20.0), [None; 2], 900 * MS), Look::Nothing);
        assert_eq!(menu.look(down, [None; 2], 1000 * MS), Look::Nothing);
        assert_eq!(menu.look(down, [None; 2], 2000 * MS), Look::Open);
        let board = menu.board().unwrap();
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
        assert_eq!(menu.pointed().unwrap().0, Item::Compare);
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
        // A hand at the right of the body; its ray meets the tile that the head would see at the upper left.
        let hand = Vec3::new(0.2, -0.3, -0.2);
        let target = 2.0 * head(15.0, 2.0).forward();
        let ray = Pose {
            position: hand,
            orientation: Quat::from_rotation_arc(Vec3::NEG_Z, (target - hand).normalize()),
        };
        let gaze = head(-15.0, 2.0);
        menu.look(gaze, [Some(ray), None], 0);
        assert_eq!(menu.pointed().unwrap().0, Item::Recenter);
        assert_eq!(menu.look(gaze, [Some(ray), None], 9000 * MS), Look::Nothing);
        // Past the panel: the head points again, from now on.
        let past = Pose { orientation: Quat::IDENTITY, position: Vec3::new(3.0, 0.0, 0.0) };
        assert_eq!(menu.look(gaze, [None, Some(past)], 9100 * MS), Look::Nothing);
        assert_eq!(menu.pointed().unwrap().0, Item::Method);
        assert!(matches!(menu.look(gaze, [None, Some(past)], 10_600 * MS), Look::Choose((Item::Method, _))));
        // The second of two hands.
        menu.look(gaze, [Some(past), Some(ray)], 10_700 * MS);
        assert_eq!(menu.pointed().unwrap().0, Item::Recenter);
    }
}
