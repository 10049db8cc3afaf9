//! Actions: the input of controllers, from the script.

use std::collections::HashMap;

use openxr_sys as sys;
use sys::{Handle, Result as Code};

use crate::instance::text;
use crate::script::State;
use crate::world::{Answer, DONE, Refusal, World, forbid_if, forbidden, found};

/// The actions of an instance.
#[derive(Default)]
pub struct Actions {
    sets: HashMap<u64, Set>,
    actions: HashMap<u64, Action>,
    /// The suggested bindings of each profile: actions, and paths of controller parts.
    bindings: HashMap<String, Vec<(u64, String)>>,
    attached: Vec<u64>,
    /// The sets that were active in the last synchronization.
    active: Vec<u64>,
    /// The values at the last two synchronizations, the last one first, by action and controller part.
    values: HashMap<(u64, String), [[f32; 2]; 2]>,
    /// The time of the last change in nanoseconds.
    changed_at: i64,
}

struct Set {
    name: String,
}

struct Action {
    set: u64,
    name: String,
    kind: sys::ActionType,
}

impl Actions {
    /// Refuses an action that does not exist.
    pub fn check(&self, action: sys::Action) -> Result<(), Refusal> {
        self.get(action).map(|_| ())
    }

    fn get(&self, action: sys::Action) -> Result<&Action, Refusal> {
        let known = self.actions.get(&action.into_raw());
        found(known, "not an action")
    }

    /// Forgets the session's state.
    pub fn detach(&mut self) {
        self.attached.clear();
        self.active.clear();
        self.values.clear();
    }
}

fn check_name(name: &str, localized: &str) -> Result<(), Refusal> {
    let good = !name.is_empty()
        && name.bytes().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || b"-_.".contains(&c));
    forbid_if(!good, Code::ERROR_NAME_INVALID, format!("{name:?} is no name"))?;
    forbid_if(
        localized.is_empty(),
        Code::ERROR_LOCALIZED_NAME_INVALID,
        format!("{name} has no localized name"),
    )
}

pub fn create_action_set(
    world: &mut World,
    instance: sys::Instance,
    info: &sys::ActionSetCreateInfo,
    out: &mut sys::ActionSet,
) -> Answer {
    let name = text(&info.action_set_name);
    check_name(&name, &text(&info.localized_action_set_name))?;
    let known = world.instance(instance)?;
    forbid_if(
        known.actions.sets.values().any(|set| set.name == name),
        Code::ERROR_NAME_DUPLICATED,
        format!("{name} exists"),
    )?;
    let handle = world.new_handle();
    world.instance(instance)?.actions.sets.insert(handle, Set { name });
    *out = sys::ActionSet::from_raw(handle);
    DONE
}

pub fn destroy_action_set(world: &mut World, set: sys::ActionSet) -> Answer {
    let removed = world.instance.as_mut().and_then(|i| i.actions.sets.remove(&set.into_raw()));
    found(removed, "not an action set")?;
    DONE
}

pub fn create_action(
    world: &mut World,
    set: sys::ActionSet,
    info: &sys::ActionCreateInfo,
    out: &mut sys::Action,
) -> Answer {
    let name = text(&info.action_name);
    check_name(&name, &text(&info.localized_action_name))?;
    let actions = &world.current()?.actions;
    let set = set.into_raw();
    forbid_if(!actions.sets.contains_key(&set), Code::ERROR_HANDLE_INVALID, "not an action set")?;
    forbid_if(
        actions.attached.contains(&set),
        Code::ERROR_ACTIONSETS_ALREADY_ATTACHED,
        format!("{name} comes after the set was attached"),
    )?;
    forbid_if(
        actions.actions.values().any(|action| action.set == set && action.name == name),
        Code::ERROR_NAME_DUPLICATED,
        format!("{name} exists"),
    )?;
    let handle = world.new_handle();
    let action = Action { set, name, kind: info.action_type };
    world.current()?.actions.actions.insert(handle, action);
    *out = sys::Action::from_raw(handle);
    DONE
}

pub fn destroy_action(world: &mut World, action: sys::Action) -> Answer {
    let removed = world.instance.as_mut().and_then(|i| i.actions.actions.remove(&action.into_raw()));
    found(removed, "not an action")?;
    DONE
}

/// The known profiles, with the extension that each requires.
const PROFILES: [(&str, Option<&str>); 5] = [
    ("/interaction_profiles/khr/simple_controller", None),
    ("/interaction_profiles/oculus/touch_controller", None),
    ("/interaction_profiles/valve/index_controller", None),
    ("/interaction_profiles/bytedance/pico_neo3_controller", Some("XR_BD_controller_interaction")),
    ("/interaction_profiles/bytedance/pico4_controller", Some("XR_BD_controller_interaction")),
];
/// Profiles that an application may try, because some runtimes know them.
const TRIED: [&str; 1] = ["/interaction_profiles/bytedance/pico4s_controller"];

pub fn suggest_bindings(
    world: &mut World,
    instance: sys::Instance,
    suggested: &sys::InteractionProfileSuggestedBinding,
) -> Answer {
    let known = world.instance(instance)?;
    let profile = known.path(suggested.interaction_profile).unwrap_or_default().to_owned();
    let extension = match PROFILES.iter().find(|(name, _)| *name == profile) {
        Some((_, extension)) => *extension,
        None if TRIED.contains(&profile.as_str()) => {
            return Err(Code::ERROR_PATH_UNSUPPORTED.into());
        }
        None => {
            return Err(forbidden(Code::ERROR_PATH_UNSUPPORTED, format!("{profile:?} is no profile")));
        }
    };
    if let Some(extension) = extension
        && !known.has(extension)
    {
        return Err(forbidden(Code::ERROR_PATH_UNSUPPORTED, format!("{profile} without {extension}")));
    }
    forbid_if(
        !known.actions.attached.is_empty(),
        Code::ERROR_ACTIONSETS_ALREADY_ATTACHED,
        "bindings come after the sets were attached",
    )?;
    let mut bindings = Vec::new();
    for i in 0..suggested.count_suggested_bindings as usize {
        // SAFETY: the array has that many bindings.
        let binding = unsafe { &*suggested.suggested_bindings.add(i) };
        known.actions.check(binding.action)?;
        let path = known.path(binding.binding).unwrap_or_default().to_owned();
        let part = path.strip_prefix("/user/hand/left/").or(path.strip_prefix("/user/hand/right/"));
        forbid_if(
            !part.is_some_and(|part| part_exists(&profile, part, path.contains("left"))),
            Code::ERROR_PATH_UNSUPPORTED,
            format!("{profile} has no {path:?}"),
        )?;
        bindings.push((binding.action.into_raw(), path));
    }
    known.actions.bindings.insert(profile, bindings);
    DONE
}

/// True if the controller has the part according to the specification.
fn part_exists(profile: &str, part: &str, left: bool) -> bool {
    const SIMPLE: [&str; 5] =
        ["input/select/click", "input/menu/click", "input/grip/pose", "input/aim/pose", "output/haptic"];
    const TOUCH: [&str; 14] = [
        "input/squeeze/value",
        "input/trigger/value",
        "input/trigger/touch",
        "input/trigger",
        "input/squeeze",
        "input/thumbstick/x",
        "input/thumbstick/y",
        "input/thumbstick/click",
        "input/thumbstick/touch",
        "input/thumbstick",
        "input/thumbrest/touch",
        "input/grip/pose",
        "input/aim/pose",
        "output/haptic",
    ];
    const LEFT: [&str; 5] =
        ["input/x/click", "input/x/touch", "input/y/click", "input/y/touch", "input/menu/click"];
    const RIGHT: [&str; 5] =
        ["input/a/click", "input/a/touch", "input/b/click", "input/b/touch", "input/system/click"];
    let touch = TOUCH.contains(&part) || if left { LEFT.contains(&part) } else { RIGHT.contains(&part) };
    match profile {
        "/interaction_profiles/khr/simple_controller" => SIMPLE.contains(&part),
        "/interaction_profiles/oculus/touch_controller" => touch,
        "/interaction_profiles/bytedance/pico_neo3_controller"
        | "/interaction_profiles/bytedance/pico4_controller" => {
            const MORE: [&str; 3] = ["input/trigger/click", "input/squeeze/click", "input/system/click"];
            MORE.contains(&part) || touch && part != "input/thumbrest/touch"
        }
        // Parts of other profiles are not checked.
        _ => true,
    }
}

pub fn attach_action_sets(
    world: &mut World,
    session: sys::Session,
    info: &sys::SessionActionSetsAttachInfo,
) -> Answer {
    world.session(session)?;
    let actions = &mut world.current()?.actions;
    forbid_if(
        !actions.attached.is_empty(),
        Code::ERROR_ACTIONSETS_ALREADY_ATTACHED,
        "sets are attached once to a session",
    )?;
    for i in 0..info.count_action_sets as usize {
        // SAFETY: the array has that many handles.
        let set = unsafe { *info.action_sets.add(i) }.into_raw();
        forbid_if(!actions.sets.contains_key(&set), Code::ERROR_HANDLE_INVALID, "not an action set")?;
        actions.attached.push(set);
    }
    // Runtimes find controllers only once they know the actions.
    world.current()?.events.push_back(crate::world::Event::Profile);
    DONE
}

pub fn sync_actions(world: &mut World, session: sys::Session, info: &sys::ActionsSyncInfo) -> Answer {
    let focused = world.session(session)?.state == State::Focused;
    let mut active = Vec::new();
    for i in 0..info.count_active_action_sets as usize {
        // SAFETY: the array has that many sets.
        let set = unsafe { &*info.active_action_sets.add(i) }.action_set.into_raw();
        forbid_if(
            !world.current()?.actions.attached.contains(&set),
            Code::ERROR_ACTIONSET_NOT_ATTACHED,
            "the set is not attached",
        )?;
        active.push(set);
    }
    let (frame, time) = (world.frame(), world.time());
    let bound: Vec<(u64, String)> = match &world.profile {
        Some(profile) => world.instance.as_ref().and_then(|i| i.actions.bindings.get(profile)).cloned(),
        None => None,
    }
    .unwrap_or_default();
    let values: Vec<[f32; 2]> = bound.iter().map(|(_, path)| world.script.input(path, frame)).collect();
    let actions = &mut world.current()?.actions;
    actions.active = if focused { active } else { Vec::new() };
    actions.values.retain(|key, _| bound.contains(key));
    for (key, value) in bound.into_iter().zip(values) {
        let value = if focused { value } else { [0.0; 2] };
        let history = actions.values.entry(key).or_default();
        if history[0] != value {
            actions.changed_at = time.as_nanos();
        }
        *history = [value, history[0]];
    }
    if !focused {
        return Ok(Code::SESSION_NOT_FOCUSED);
    }
    world.success()
}

/// Returns the values of an action at the last two synchronizations, or `None` if nothing is bound to it.
fn state(
    world: &mut World,
    session: sys::Session,
    info: &sys::ActionStateGetInfo,
    kind: sys::ActionType,
) -> Result<Option<[[f32; 2]; 2]>, Refusal> {
    world.session(session)?;
    let instance = world.current()?;
    let action = instance.actions.get(info.action)?;
    forbid_if(
        action.kind != kind,
        Code::ERROR_ACTION_TYPE_MISMATCH,
        format!("{} is asked for as {kind:?}", action.name),
    )?;
    forbid_if(
        !instance.actions.attached.contains(&action.set),
        Code::ERROR_ACTIONSET_NOT_ATTACHED,
        format!("the set of {} is not attached", action.name),
    )?;
    if !instance.actions.active.contains(&action.set) {
        return Ok(None);
    }
    let prefix = instance.path(info.subaction_path).unwrap_or_default();
    // Of several parts, the one that is pressed most counts.
    let mut best: Option<[[f32; 2]; 2]> = None;
    let strength = |value: [f32; 2]| value[0].hypot(value[1]);
    for ((handle, path), history) in &instance.actions.values {
        if *handle != info.action.into_raw() || !path.starts_with(prefix) {
            continue;
        }
        best = Some(match best {
            None => *history,
            Some(best) => std::array::from_fn(|i| {
                if strength(history[i]) > strength(best[i]) { history[i] } else { best[i] }
            }),
        });
    }
    Ok(best)
}

/// Fills in the fields that the states of all types have.
fn put_state<T: PartialEq + Copy>(
    values: Option<[T; 2]>,
    idle: T,
    mut put: impl FnMut(T, sys::Bool32, sys::Bool32),
) -> Answer {
    let [now, before] = values.unwrap_or([idle, idle]);
    put(now, (now != before).into(), values.is_some().into());
    DONE
}

pub fn get_action_state_boolean(
    world: &mut World,
    session: sys::Session,
    info: &sys::ActionStateGetInfo,
    out: &mut sys::ActionStateBoolean,
) -> Answer {
    let values = state(world, session, info, sys::ActionType::BOOLEAN_INPUT)?;
    let time = sys::Time::from_nanos(world.current()?.actions.changed_at);
    put_state(values.map(|both| both.map(|value| value[0] >= 0.5)), false, |now, changed, active| {
        out.current_state = now.into();
        (out.changed_since_last_sync, out.is_active, out.last_change_time) = (changed, active, time);
    })
}

pub fn get_action_state_vector2f(
    world: &mut World,
    session: sys::Session,
    info: &sys::ActionStateGetInfo,
    out: &mut sys::ActionStateVector2f,
) -> Answer {
    let values = state(world, session, info, sys::ActionType::VECTOR2F_INPUT)?;
    let time = sys::Time::from_nanos(world.current()?.actions.changed_at);
    put_state(values, [0.0; 2], |[x, y], changed, active| {
        out.current_state = sys::Vector2f { x, y };
        (out.changed_since_last_sync, out.is_active, out.last_change_time) = (changed, active, time);
    })
}
