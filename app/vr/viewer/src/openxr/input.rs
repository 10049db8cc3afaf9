//! Controllers, through OpenXR's action system.
//!
//! | control | Touch and Pico controllers | simple controller | does |
//! |---|---|---|---|
//! | select | trigger, A, X | select | next method; held: opens the menu, in the menu recenters |
//! | menu | menu, B, Y | menu | HUD; held: as above |
//! | stick left, right | thumbstick | | previous method, next method |
//! | stick up, down | thumbstick | | next scene, next viewpoint |
//! | squeeze and stick | grip and thumbstick | | moves the eyes a millimetre further apart or closer |
//! | aim | aim | aim | in the menu: points at a tile |

use glam::Vec2;
use openxr as xr;

use super::error::{XrError, call};
use super::session::to_pose;
use crate::event::Event;
use yoro::eyes::Pose;

/// A button that is held for longer than this has another meaning, in nanoseconds.
const LONG_NS: i64 = 600_000_000;
/// The stick counts as pushed above `PUSHED` and as released below `LET_GO`.
const PUSHED: f32 = 0.7;
const LET_GO: f32 = 0.4;
/// Period at which a stick that stays pushed repeats, in nanoseconds.
const REPEAT_NS: i64 = 250_000_000;

/// Pico's controllers (XR_BD_controller_interaction; the last one is what the runtime of Pico 4 Ultra reports). They
/// have all the inputs of Touch controllers. Without these profiles, a runtime can only map them to
/// `simple_controller`, which has neither stick nor squeeze.
const PICO: [&str; 3] = [
    "/interaction_profiles/bytedance/pico_neo3_controller",
    "/interaction_profiles/bytedance/pico4_controller",
    "/interaction_profiles/bytedance/pico4s_controller",
];

/// The state of the controls at one time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Controls {
    select: bool,
    menu: bool,
    squeeze: bool,
    /// X to the right and Y up, each -1 to 1.
    stick: Vec2,
}

/// A button.
#[derive(Clone, Copy, Debug, Default)]
struct Button {
    /// The time at which it was pressed. Once it has counted as held, `is_spent` is set and nothing more happens.
    since_ns: Option<i64>,
    is_spent: bool,
}

impl Button {
    /// Returns the resulting event, if any.
    fn update(&mut self, is_down: bool, now_ns: i64, short: Event, long: Event) -> Option<Event> {
        match (is_down, self.since_ns) {
            (true, None) => {
                *self = Button { since_ns: Some(now_ns), is_spent: false };
                None
            }
            (true, Some(since)) if !self.is_spent && now_ns - since >= LONG_NS => {
                self.is_spent = true;
                Some(long)
            }
            (true, Some(_)) => None,
            (false, since) => {
                self.since_ns = None;
                (since.is_some() && !self.is_spent).then_some(short)
            }
        }
    }
}

/// The previous state of the controls.
#[derive(Clone, Copy, Debug, Default)]
struct Memory {
    select: Button,
    menu: Button,
    /// The time at which the pushed stick last had an effect.
    pushed_ns: Option<i64>,
}

impl Memory {
    fn update(&mut self, controls: Controls, now_ns: i64, events: &mut Vec<Event>) {
        if self.select.since_ns.is_some() != controls.select {
            events.push(if controls.select { Event::Press } else { Event::Release });
        }
        events.extend(self.select.update(controls.select, now_ns, Event::Tap, Event::LongPress));
        events.extend(self.menu.update(controls.menu, now_ns, Event::ToggleHud, Event::LongPress));
        let Vec2 { x, y } = controls.stick;
        let reach = x.abs().max(y.abs());
        if reach < LET_GO {
            self.pushed_ns = None;
        }
        if reach < PUSHED {
            return;
        }
        // While the stick is held, only the distance between the eyes keeps changing.
        let again = controls.squeeze && self.pushed_ns.is_some_and(|then| now_ns - then >= REPEAT_NS);
        if self.pushed_ns.is_some() && !again {
            return;
        }
        self.pushed_ns = Some(now_ns);
        let is_sideways = x.abs() > y.abs();
        let is_more = if is_sideways { x > 0.0 } else { y > 0.0 };
        events.push(match (controls.squeeze, is_sideways, is_more) {
            (true, _, true) => Event::IpdUp,
            (true, _, false) => Event::IpdDown,
            (false, true, true) => Event::Tap,
            (false, true, false) => Event::PreviousMethod,
            (false, false, true) => Event::NextScene,
            (false, false, false) => Event::NextViewpoint,
        });
    }
}

/// The hands. The right one is first, so that it takes precedence if both point at the menu.
const HANDS: [&str; 2] = ["/user/hand/right", "/user/hand/left"];

/// The controllers of a session.
pub(super) struct Input {
    /// The rays of the hands, and the action that they belong to.
    aims: [xr::Space; 2],
    _aim: xr::Action<xr::Posef>,
    select: xr::Action<bool>,
    menu: xr::Action<bool>,
    squeeze: xr::Action<bool>,
    stick: xr::Action<xr::Vector2f>,
    set: xr::ActionSet,
    memory: Memory,
}

impl Input {
    /// Creates the actions, suggests bindings and attaches them to the session, which is possible only once.
    pub fn new(instance: &xr::Instance, session: &xr::Session<xr::OpenGlEs>) -> Result<Input, XrError> {
        let set = call("xrCreateActionSet", instance.create_action_set("viewer", "Viewer", 0))?;
        let flag =
            |name: &str, label: &str| call("xrCreateAction", set.create_action::<bool>(name, label, &[]));
        let select = flag("select", "Next method")?;
        let menu = flag("menu", "HUD")?;
        let squeeze = flag("squeeze", "Change the distance between the eyes")?;
        let stick = call("xrCreateAction", set.create_action::<xr::Vector2f>("stick", "Choose", &[]))?;
        let path = |text: &str| call("xrStringToPath", instance.string_to_path(text));
        let hands = [path(HANDS[0])?, path(HANDS[1])?];
        let aim = call("xrCreateAction", set.create_action::<xr::Posef>("aim", "Point", &hands))?;
        let suggest = |profile: &str, buttons: &[(&xr::Action<bool>, &str)], sticks: &[&str]| {
            let mut bindings = Vec::new();
            for (action, input) in buttons {
                bindings.push(xr::Binding::new(*action, path(input)?));
            }
            for input in sticks {
                bindings.push(xr::Binding::new(&stick, path(input)?));
            }
            for hand in HANDS {
                bindings.push(xr::Binding::new(&aim, path(&format!("{hand}/input/aim/pose"))?));
            }
            call(
                "xrSuggestInteractionProfileBindings",
                instance.suggest_interaction_profile_bindings(path(profile)?, &bindings),
            )
        };
        let buttons = [
            (&select, "/user/hand/left/input/trigger/value"),
            (&select, "/user/hand/right/input/trigger/value"),
            (&select, "/user/hand/left/input/x/click"),
            (&select, "/user/hand/right/input/a/click"),
            (&menu, "/user/hand/left/input/menu/click"),
            (&menu, "/user/hand/left/input/y/click"),
            (&menu, "/user/hand/right/input/b/click"),
            (&squeeze, "/user/hand/left/input/squeeze/value"),
            (&squeeze, "/user/hand/right/input/squeeze/value"),
        ];
        let sticks = ["/user/hand/left/input/thumbstick", "/user/hand/right/input/thumbstick"];
        let simple = [
            (&select, "/user/hand/left/input/select/click"),
            (&select, "/user/hand/right/input/select/click"),
            (&menu, "/user/hand/left/input/menu/click"),
            (&menu, "/user/hand/right/input/menu/click"),
        ];
        let touch = suggest("/interaction_profiles/oculus/touch_controller", &buttons, &sticks);
        let simple = suggest("/interaction_profiles/khr/simple_controller", &simple, &[]);
        match (touch, simple) {
            (Ok(()), Ok(())) => {}
            (Err(error), _) | (_, Err(error)) if error.is_loss() => return Err(error),
            (Err(error), Ok(())) | (Ok(()), Err(error)) => {
                log::info!("one kind of controller is not supported: {error}")
            }
            (Err(error), Err(_)) => return Err(error),
        }
        if instance.exts().bd_controller_interaction.is_some() {
            for profile in PICO {
                match suggest(profile, &buttons, &sticks) {
                    Err(error) if error.is_loss() => return Err(error),
                    // Not every runtime with the extension supports its newest profile.
                    Err(error) => log::debug!("{profile}: {error}"),
                    Ok(()) => {}
                }
            }
        }
        call("xrAttachSessionActionSets", session.attach_action_sets(&[&set]))?;
        let ray = |hand| call("xrCreateActionSpace", aim.create_space(session, hand, xr::Posef::IDENTITY));
        let aims = [ray(hands[0])?, ray(hands[1])?];
        Ok(Input { aims, _aim: aim, select, menu, squeeze, stick, set, memory: Memory::default() })
    }

    /// Returns the rays of the hands in a space, each along its pose's -Z; `None` for a hand that is not tracked.
    pub fn rays(&self, base: &xr::Space, time: xr::Time) -> Result<[Option<Pose>; 2], XrError> {
        let mut rays = [None; 2];
        for (ray, aim) in rays.iter_mut().zip(&self.aims) {
            let place = call("xrLocateSpace", aim.locate(base, time))?;
            let flags = xr::SpaceLocationFlags::POSITION_VALID | xr::SpaceLocationFlags::ORIENTATION_VALID;
            if place.location_flags.contains(flags) {
                *ray = to_pose(&place.pose);
            }
        }
        Ok(rays)
    }

    /// Reads the controls, and adds the user's actions to `events`.
    pub fn poll(
        &mut self,
        session: &xr::Session<xr::OpenGlEs>,
        now_ns: i64,
        events: &mut Vec<Event>,
    ) -> Result<(), XrError> {
        call("xrSyncActions", session.sync_actions(&[xr::ActiveActionSet::new(&self.set)]))?;
        let flag = |action: &xr::Action<bool>| -> Result<bool, XrError> {
            let state = call("xrGetActionStateBoolean", action.state(session, xr::Path::NULL))?;
            Ok(state.is_active && state.current_state)
        };
        let stick = call("xrGetActionStateVector2f", self.stick.state(session, xr::Path::NULL))?;
        let at = Vec2::new(stick.current_state.x, stick.current_state.y);
        let controls = Controls {
            select: flag(&self.select)?,
            menu: flag(&self.menu)?,
            squeeze: flag(&self.squeeze)?,
            stick: if stick.is_active && at.is_finite() { at } else { Vec2::ZERO },
        };
        self.memory.update(controls, now_ns, events);
        Ok(())
    }

    /// Forgets pressed controls, while the system uses them.
    pub fn forget(&mut self) {
        self.memory = Memory::default();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: i64 = 1_000_000;

    fn play(steps: &[(i64, Controls)]) -> Vec<Event> {
        let (mut memory, mut events) = (Memory::default(), Vec::new());
        steps.iter().for_each(|(ms, controls)| memory.update(*controls, ms * MS, &mut events));
        events
    }

    fn stick(x: f32, y: f32) -> Controls {
        Controls { stick: Vec2::new(x, y), ..Controls::default() }
    }

    #[test]
    fn buttons_short_and_long() {
        let (none, select) = (Controls::default(), Controls { select: true, ..Controls::default() });
        let menu = Controls { menu: true, ..none };
        assert_eq!(
            play(&[(0, none), (10, select), (100, select), (200, none)]),
            [Event::Press, Event::Release, Event::Tap]
        );
        assert_eq!(
            play(&[(0, select), (700, select), (900, select), (950, none)]),
            [Event::Press, Event::LongPress, Event::Release]
        );
        assert_eq!(play(&[(0, menu), (20, none), (40, menu), (60, none)]), [Event::ToggleHud; 2]);
    }

    #[test]
    fn a_pushed_stick_counts_once_until_released() {
        let events = play(&[
            (0, stick(0.9, 0.1)),
            (10, stick(1.0, 0.0)),
            (500, stick(0.8, 0.0)),
            (510, stick(0.5, 0.0)),
            (520, stick(0.9, 0.0)),
            (530, stick(0.0, 0.0)),
            (540, stick(-0.9, 0.3)),
            (550, stick(0.0, 0.0)),
            (560, stick(0.1, 0.9)),
            (570, stick(0.0, 0.0)),
            (580, stick(0.1, -0.9)),
        ]);
        assert_eq!(events, [Event::Tap, Event::PreviousMethod, Event::NextScene, Event::NextViewpoint]);
    }

    #[test]
    fn stick_and_squeeze_change_the_ipd() {
        let apart = Controls { squeeze: true, ..stick(0.0, 1.0) };
        let closer = Controls { squeeze: true, ..stick(-1.0, 0.0) };
        let events = play(&[(0, apart), (100, apart), (260, apart), (300, stick(0.0, 0.0)), (310, closer)]);
        assert_eq!(events, [Event::IpdUp, Event::IpdUp, Event::IpdDown]);
    }
}
