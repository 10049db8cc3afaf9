//! The state of the runtime, and the entry point of every call.

use std::cell::Cell;
use std::collections::{BTreeMap, HashMap, VecDeque};
use std::ffi::c_void;
use std::sync::atomic::Ordering;
use std::sync::{Arc, Mutex};

use glam::{Quat, Vec3};
use openxr_sys as sys;
use sys::{Handle, Result as Code};

use crate::action::Actions;
use crate::log::{Entry, Log};
use crate::script::{At, Script, State, What};
use crate::session::Session;
use crate::space::Space;
use crate::swapchain::Swapchain;

/// An array that an application asks for in two calls: first its length, then its elements.
pub struct Array<T> {
    pub capacity: u32,
    count: *mut u32,
    pub items: *mut T,
}

impl<T> Array<T> {
    /// Wraps the array of a call.
    ///
    /// # Safety
    /// `count` is writable, and `items` has room for `capacity` items, unless they are null.
    pub unsafe fn new(capacity: u32, count: *mut u32, items: *mut T) -> Array<T> {
        Array { capacity, count, items }
    }

    /// Changes the type of the items.
    ///
    /// # Safety
    /// The items are structures of this type.
    pub unsafe fn cast<U>(self) -> Array<U> {
        Array { capacity: self.capacity, count: self.count, items: self.items.cast() }
    }

    /// Refuses items, of the first `count`, that do not state the type of their structure.
    pub fn check_types(&self, count: usize, ty: sys::StructureType) -> Result<(), Refusal> {
        given(self.capacity > 0 && self.items.is_null(), "the array")?;
        for i in 0..count.min(self.capacity as usize) {
            // SAFETY: `new` requires room for `capacity` items, and these are structures, which begin with their type.
            let stated = unsafe { (*self.items.add(i).cast::<sys::BaseInStructure>()).ty };
            forbid_if(stated != ty, Code::ERROR_VALIDATION_FAILURE, format!("{stated:?} is the wrong type"))?;
        }
        Ok(())
    }

    /// Writes the length and, if the capacity is not 0, the elements.
    pub fn fill<V>(self, values: &[V], write: impl Fn(&mut T, &V)) -> Answer {
        given(self.count.is_null(), "the count")?;
        given(self.capacity > 0 && self.items.is_null(), "the array")?;
        // SAFETY: `new` requires a place for the count, and room for `capacity` items.
        unsafe {
            *self.count = values.len() as u32;
            if self.capacity == 0 {
                return DONE;
            }
            if (self.capacity as usize) < values.len() {
                return Err(Code::ERROR_SIZE_INSUFFICIENT.into());
            }
            for (i, value) in values.iter().enumerate() {
                write(&mut *self.items.add(i), value);
            }
        }
        DONE
    }
}

/// The result of a refused call. It has a violation if the application has broken the specification.
pub struct Refusal {
    pub result: sys::Result,
    pub violation: Option<String>,
}

impl From<sys::Result> for Refusal {
    fn from(result: sys::Result) -> Refusal {
        Refusal { result, violation: None }
    }
}

/// Returns the refusal of a call that the specification forbids.
pub fn forbidden(result: sys::Result, what: impl Into<String>) -> Refusal {
    Refusal { result, violation: Some(what.into()) }
}

/// Refuses a call as forbidden by the specification if `is_wrong`.
pub fn forbid_if(is_wrong: bool, result: sys::Result, what: impl Into<String>) -> Result<(), Refusal> {
    if is_wrong { Err(forbidden(result, what)) } else { Ok(()) }
}

/// Refuses a null pointer that the specification does not allow.
pub fn given(is_null: bool, what: &str) -> Result<(), Refusal> {
    forbid_if(is_null, Code::ERROR_VALIDATION_FAILURE, format!("{what} is null"))
}

/// Refuses a call with an unknown handle.
pub fn found<T>(object: Option<T>, what: &str) -> Result<T, Refusal> {
    object.ok_or_else(|| forbidden(Code::ERROR_HANDLE_INVALID, what))
}

pub type Answer = Result<sys::Result, Refusal>;
pub const DONE: Answer = Ok(Code::SUCCESS);

/// The state of the process. The script and the log last over several instances.
pub struct World {
    pub script: Script,
    pub log: Log,
    /// The number of calls of each function.
    calls: BTreeMap<String, u32>,
    /// For each event of the script, true if it has happened.
    happened: Vec<bool>,
    last_handle: u64,
    /// The number of frames that were waited for.
    pub frames: u32,
    /// The display time of the last of them, in nanoseconds.
    pub now_ns: i64,
    /// The display time of the first picture, from which on the head moves.
    pub moves_from_ns: Option<i64>,
    /// The number of frames before the first picture, once there has been one.
    before_picture: Option<u32>,
    /// The number of polls that returned no event.
    pub idle_polls: u32,
    /// The number of times `xrGetSystem` found no headset.
    pub unavailable: u32,
    pub profile: Option<String>,
    pub refresh_rate: f32,
    /// True after `xrInitializeLoaderKHR`.
    pub is_initialized: bool,
    pub instance: Option<Instance>,
}

/// The instance. There is at most one.
pub struct Instance {
    pub handle: u64,
    /// The version that the application asked for.
    pub api: sys::Version,
    pub extensions: Vec<String>,
    pub lost: bool,
    pub requirements_asked: bool,
    pub events: VecDeque<Event>,
    pub paths: Vec<String>,
    pub actions: Actions,
    pub session: Option<Session>,
    pub spaces: HashMap<u64, Space>,
    pub swapchains: HashMap<u64, Swapchain>,
    /// The levels of the profiles of foveation.
    pub foveations: HashMap<u64, sys::FoveationLevelFB>,
    /// The rotation of the local space to the left, in radians.
    pub local_yaw: f32,
}

impl Instance {
    /// True if the application may use four views.
    pub fn has_quad_views(&self) -> bool {
        self.api >= sys::Version::new(1, 1, 0) || self.has(crate::instance::QUAD_VIEWS)
    }

    /// True if the application has enabled an extension.
    pub fn has(&self, extension: &str) -> bool {
        self.extensions.iter().any(|enabled| enabled == extension)
    }
}

/// Returns the first structure of a type in a chain.
///
/// # Safety
/// `next` begins a chain of structures of the types that they state, and `ty` is the type of `T`.
pub unsafe fn in_chain<'a, T>(next: *const c_void, ty: sys::StructureType) -> Option<&'a T> {
    let mut next = next.cast::<sys::BaseInStructure>();
    // SAFETY: every structure of a chain begins with this header.
    while let Some(structure) = unsafe { next.as_ref() } {
        if structure.ty == ty {
            // SAFETY: the structure has this type.
            return unsafe { next.cast::<T>().as_ref() };
        }
        next = structure.next;
    }
    None
}

/// Fills in the structures of a type in a chain of outputs.
///
/// # Safety
/// `next` begins a chain of structures of the types that they state, and `ty` is the type of `T`.
pub unsafe fn in_output<T>(next: *mut c_void, write: impl Fn(&mut T), ty: sys::StructureType) {
    let mut next = next.cast::<sys::BaseOutStructure>();
    // SAFETY: every structure of a chain begins with this header.
    while let Some(structure) = unsafe { next.as_mut() } {
        if structure.ty == ty {
            // SAFETY: the structure has this type.
            write(unsafe { &mut *next.cast::<T>() });
        }
        next = structure.next;
    }
}

/// An event for the application.
pub enum Event {
    State(State),
    InstanceLoss,
    ReferenceSpace(f32),
    Profile,
    RefreshRate(f32, f32),
    Mask,
    Lost,
}

static WORLD: Mutex<Option<World>> = Mutex::new(None);

thread_local! {
    static IS_INSIDE: Cell<bool> = const { Cell::new(false) };
}

/// True if this thread is in a call of the runtime. Allocations made there are not the caller's.
pub fn is_inside() -> bool {
    IS_INSIDE.get()
}

/// A function that receives the name of a call.
pub type Watch = Arc<dyn Fn(&str) + Send + Sync>;

/// Called before every call, outside all locks.
static WATCH: Mutex<Option<Watch>> = Mutex::new(None);

/// Sets a function that is called with the name of every call before it begins, outside all locks. `None` removes it.
pub fn watch(watch: Option<Watch>) {
    *WATCH.lock().unwrap_or_else(std::sync::PoisonError::into_inner) = watch;
}

/// Forgets everything, and continues with this script instead of the file's.
pub fn begin(script: Script) {
    *WORLD.lock().unwrap_or_else(std::sync::PoisonError::into_inner) = Some(World::new(script));
    crate::frame::IS_BLANK.store(true, Ordering::Relaxed);
}

/// Runs a call: counts it, fails it if the script says so, and logs it if it is forbidden.
pub fn enter(call: &str, work: impl FnOnce(&mut World) -> Answer) -> sys::Result {
    if call == "xrWaitFrame" {
        crate::frame::pace();
    }
    IS_INSIDE.set(true);
    let watch = WATCH.lock().unwrap_or_else(std::sync::PoisonError::into_inner).clone();
    if let Some(watch) = watch {
        watch(call);
    }
    let result = entered(call, work);
    IS_INSIDE.set(false);
    result
}

fn entered(call: &str, work: impl FnOnce(&mut World) -> Answer) -> sys::Result {
    let mut guard = WORLD.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    let world = guard.get_or_insert_with(|| World::new(Script::load()));
    let nth = world.calls.entry(call.into()).or_insert(0);
    *nth += 1;
    let nth = *nth;
    let fault = world
        .script
        .faults
        .iter()
        .find(|fault| fault.call == call && (fault.nth == nth || fault.and_later && fault.nth <= nth));
    if let Some(fault) = fault {
        let entry = Entry::Fault { call: call.into(), nth, result: fault.result };
        world.log.write(&entry);
        return sys::Result::from_raw(fault.result);
    }
    let answer = work(world);
    match answer {
        Ok(result) => result,
        Err(Refusal { result, violation }) => {
            if let Some(what) = violation {
                world.log.write(&Entry::Violation { call: call.into(), what });
            }
            result
        }
    }
}

impl World {
    fn new(script: Script) -> World {
        World {
            log: Log::open(script.log.as_deref()),
            calls: BTreeMap::new(),
            happened: vec![false; script.events.len()],
            last_handle: 0,
            frames: 0,
            now_ns: crate::frame::BEGINNING_NS,
            moves_from_ns: None,
            before_picture: None,
            idle_polls: 0,
            unavailable: 0,
            profile: script.profile.clone(),
            refresh_rate: script.refresh_rates.first().copied().unwrap_or(72.0),
            is_initialized: false,
            instance: None,
            script,
        }
    }

    pub fn new_handle(&mut self) -> u64 {
        self.last_handle += 1;
        self.last_handle
    }

    /// Returns the instance, even if it is lost.
    pub fn any_instance(&mut self, handle: sys::Instance) -> Result<&mut Instance, Refusal> {
        let instance = self.instance.as_mut().filter(|instance| instance.handle == handle.into_raw());
        found(instance, "not an instance")
    }

    pub fn instance(&mut self, handle: sys::Instance) -> Result<&mut Instance, Refusal> {
        let instance = self.any_instance(handle)?;
        if instance.lost {
            return Err(Code::ERROR_INSTANCE_LOST.into());
        }
        Ok(instance)
    }

    /// Returns the instance that any object belongs to, unless it is lost.
    pub fn current(&mut self) -> Result<&mut Instance, Refusal> {
        let instance =
            self.instance.as_mut().ok_or_else(|| forbidden(Code::ERROR_HANDLE_INVALID, "no instance"))?;
        if instance.lost {
            return Err(Code::ERROR_INSTANCE_LOST.into());
        }
        Ok(instance)
    }

    /// Returns the session, unless it or its instance is lost.
    pub fn session(&mut self, handle: sys::Session) -> Result<&mut Session, Refusal> {
        let session = self.current()?.session.as_mut().filter(|s| s.handle == handle.into_raw());
        let session = found(session, "not a session")?;
        if session.lost {
            return Err(Code::ERROR_SESSION_LOST.into());
        }
        Ok(session)
    }

    /// Returns the session of an object that belongs to it.
    pub fn its_session(&mut self) -> Result<&mut Session, Refusal> {
        let session = self.current()?.session.as_mut();
        let session = found(session, "no session")?;
        if session.lost {
            return Err(Code::ERROR_SESSION_LOST.into());
        }
        Ok(session)
    }

    /// Returns the result of a successful call, which may announce the loss of the session.
    pub fn success(&mut self) -> Answer {
        let pending = self.its_session().is_ok_and(|session| session.loss_pending);
        Ok(if pending { Code::SESSION_LOSS_PENDING } else { Code::SUCCESS })
    }

    /// Returns the number of the last frame that was waited for, as the script counts frames.
    pub fn frame(&self) -> u32 {
        self.before_picture.map_or(0, |before| self.frames.saturating_sub(before + 1))
    }

    /// Notes the first picture. As long as there has been none, `look` decides whether this is the first.
    pub fn picture(&mut self, look: impl FnOnce(&mut World) -> bool) {
        if self.before_picture.is_none() && look(self) {
            // The next frame is frame 1.
            self.before_picture = Some(self.frames.saturating_sub(1));
            self.moves_from_ns = Some(self.now_ns);
            crate::frame::IS_BLANK.store(false, Ordering::Relaxed);
        }
    }

    /// Triggers the script's events of this moment.
    pub fn happen(&mut self, now: impl Fn(&At) -> bool) {
        for i in 0..self.script.events.len() {
            if !self.happened[i] && now(&self.script.events[i].at) {
                self.happened[i] = true;
                let what = self.script.events[i].what.clone();
                self.log.write(&Entry::Scripted { what: format!("{what:?}") });
                self.apply(what);
            }
        }
    }

    fn apply(&mut self, what: What) {
        let rate = self.refresh_rate;
        let Some(instance) = &mut self.instance else { return };
        let events = &mut instance.events;
        match what {
            What::LoseSession => {
                if let Some(session) = &mut instance.session {
                    session.lost = true;
                    events.push_back(Event::State(State::LossPending));
                }
            }
            What::SessionLossPending => {
                if let Some(session) = &mut instance.session {
                    session.loss_pending = true;
                    events.push_back(Event::State(State::LossPending));
                }
            }
            What::LoseInstance => {
                instance.lost = true;
                events.push_back(Event::InstanceLoss);
            }
            What::Exit => {
                if let Some(session) = &mut instance.session {
                    session.stop(events, None);
                }
            }
            What::TakeOff(polls) => {
                if let Some(session) = &mut instance.session {
                    session.stop(events, Some(self.idle_polls + polls));
                }
            }
            What::Level(level) => {
                if let Some(session) = &mut instance.session {
                    session.level = level;
                    session.settle(events);
                }
            }
            What::Recenter(degrees) => {
                instance.local_yaw += degrees.to_radians();
                events.push_back(Event::ReferenceSpace(degrees.to_radians()));
            }
            What::RefreshRate(hertz) => {
                self.refresh_rate = hertz;
                events.push_back(Event::RefreshRate(rate, hertz));
            }
            What::Profile(profile) => {
                self.profile = profile;
                events.push_back(Event::Profile);
            }
            What::MaskChanged => events.push_back(Event::Mask),
            What::EventsLost => events.push_back(Event::Lost),
        }
    }

    /// Returns the number of calls of each function.
    pub fn counts(&self) -> BTreeMap<String, u32> {
        self.calls.clone()
    }

    /// Returns the head's pose in the space of the floor, at the last frame's display time.
    pub fn head(&self) -> (Quat, Vec3) {
        self.head_at(self.now_ns)
    }

    /// Returns the head's pose in the space of the floor, at a time in nanoseconds.
    pub fn head_at(&self, time_ns: i64) -> (Quat, Vec3) {
        let seconds = self.moves_from_ns.map_or(0.0, |from| (time_ns - from).max(0) as f32 * 1e-9);
        let Script { position, velocity, yaw_degrees, .. } = &self.script;
        (
            Quat::from_rotation_y(yaw_degrees.to_radians()),
            Vec3::from(*position) + Vec3::from(*velocity) * seconds,
        )
    }
}
