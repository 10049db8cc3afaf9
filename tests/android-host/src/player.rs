//! Plays a script, acting as the user and as the part of Android that starts activities.

use std::ffi::c_void;
use std::path::PathBuf;
use std::sync::atomic::Ordering;

use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64Mcg;

use crate::android::activity::{ANativeActivity, ARect, Callbacks, Event, OnCreate, WindowEvent};
use crate::android::input::{AInputEvent, AInputQueue, MotionAction};
use crate::android::looper::{self, ALooper};
use crate::host::{Host, fatal, host, lock};
use crate::jni;
use crate::random;
use crate::script::{Key, Step};
use crate::threads;

/// The state of the activity that the script has reached.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Stage {
    /// True between `onCreate` and `onDestroy`.
    pub created: bool,
    /// True between `onStart` and `onStop`.
    pub started: bool,
    /// True between `onResume` and `onPause`.
    pub resumed: bool,
    /// True between `onNativeWindowCreated` and `onNativeWindowDestroyed`.
    pub window: bool,
    /// True while the activity has the focus.
    pub focus: bool,
}

/// Plays scripts.
pub struct Player {
    host: &'static Host,
    looper: &'static ALooper,
    create: OnCreate,
    out: PathBuf,
    activity: Option<&'static mut Activity>,
    queue: Option<&'static AInputQueue>,
    stage: Stage,
    saved: Vec<u8>,
    /// Number of the first log line that no step has waited for yet.
    log_read: usize,
}

/// An activity as seen by the library. It is kept after its end, since the library's threads may still access it.
struct Activity {
    native: ANativeActivity,
    callbacks: Callbacks,
}

/// Calls one of an activity's callbacks on the main thread, if the application has set it.
macro_rules! call {
    ($activity:ident, $function:expr $(, $argument:expr)*) => {
        if let Some(function) = $function {
            // SAFETY: the application's callback, on the main thread, with its activity and arguments that outlive the
            // call.
            unsafe { function(&raw mut $activity.native $(, $argument)*) }
        }
    };
}

/// Time that a finger stays on the screen, in nanoseconds.
const TAP: u64 = 80_000_000;

impl Player {
    /// Creates a player on the main thread, whose looper it runs.
    pub fn new(create: OnCreate, out: PathBuf) -> Self {
        jni::attach_main_thread();
        Self {
            host: host(),
            looper: looper::prepare(),
            create,
            out,
            activity: None,
            queue: None,
            stage: Stage::default(),
            saved: Vec::new(),
            log_read: 0,
        }
    }

    /// Plays all steps.
    pub fn play(&mut self, steps: &[Step]) {
        for step in steps {
            self.step(step);
        }
    }

    fn step(&mut self, step: &Step) {
        if self.host.log.verbose {
            self.host.say(&format!("{:9.3} step: {step:?}", self.host.clock.seconds()));
        }
        match step {
            Step::Launch => self.play(&[
                Step::Create,
                Step::Start,
                Step::Resume,
                Step::InputQueue,
                Step::Window,
                Step::Focus,
            ]),
            Step::Quit => self.quit(),
            Step::Create => self.create(),
            Step::Start => {
                let possible = self.stage.created && !self.stage.started;
                self.advance("start", possible, "onStart", |callbacks| callbacks.onStart).started = true;
            }
            Step::Resume => {
                let possible = self.stage.started && !self.stage.resumed;
                self.advance("resume", possible, "onResume", |callbacks| callbacks.onResume).resumed = true;
            }
            Step::Pause => {
                let possible = self.stage.resumed;
                self.advance("pause", possible, "onPause", |callbacks| callbacks.onPause).resumed = false;
            }
            Step::Stop => {
                let possible = self.stage.started && !self.stage.resumed;
                self.advance("stop", possible, "onStop", |callbacks| callbacks.onStop).started = false;
            }
            Step::Destroy => self.destroy(),
            Step::InputQueue => self.input_queue(),
            Step::Window => self.window(),
            Step::WindowLost => self.window_lost(),
            Step::Resize { width, height } => {
                self.host.window.resize(*width, *height);
                if self.stage.window {
                    self.window_event("onNativeWindowResized", |callbacks| callbacks.onNativeWindowResized);
                    self.content_rect();
                }
            }
            Step::Focus => self.focus(true),
            Step::Unfocus => self.focus(false),
            Step::SaveState => self.save_state(),
            Step::LowMemory => self.event("onLowMemory", |callbacks| callbacks.onLowMemory),
            Step::ConfigurationChanged => {
                self.event("onConfigurationChanged", |callbacks| callbacks.onConfigurationChanged)
            }
            Step::Frames(count) => self.frames(*count),
            Step::Seconds(seconds) => self.seconds(*seconds),
            Step::WaitLog { text, frames } => self.wait_log(text, *frames),
            Step::WaitFinish { frames } => {
                for _ in 0..*frames {
                    if self.finish_asked() {
                        return;
                    }
                    // Counted before the frame is granted, since it may be shown at once.
                    let shown = self.host.frames.shown();
                    self.host.frames.grant(1);
                    self.wait("a frame, or the application's wish to finish", |host| {
                        host.frames.shown() > shown || host.finish_asked.load(Ordering::Acquire)
                    });
                }
                if !self.finish_asked() {
                    fatal(format!("the application has not asked for its end within {frames} frames"));
                }
            }
            Step::Idle(seconds) => self.idle(*seconds),
            Step::Tap { x, y } => self.touch(*x, *y, TAP),
            Step::LongPress { x, y, seconds } => self.touch(*x, *y, nanoseconds(*seconds)),
            Step::Key(key) => self.key(*key),
            Step::Head { yaw, pitch, roll, seconds, go_on } => {
                self.host.sensors.turn(*yaw, *pitch, *roll, self.host.clock.now(), nanoseconds(*seconds));
                if !go_on {
                    self.seconds(*seconds);
                }
            }
            Step::Battery(battery) => *lock(&self.host.battery) = Some(battery.clone()),
            Step::BatteryMissing => *lock(&self.host.battery) = None,
            Step::Thermal(thermal) => *lock(&self.host.thermal) = thermal.clone(),
            Step::Camera(picture) => self.host.camera.see(picture.clone()),
            Step::CameraLost => self.host.camera.take(),
            Step::Permission(is_allowed) => self.answer(*is_allowed),
            Step::Share(share) => *lock(&self.host.shared[0]) = Some(share.clone()),
            Step::Property { name, value } => {
                lock(&self.host.properties).insert(name.clone(), value.clone());
            }
            Step::ContextLoss => self.host.graphics.lose_context(),
            Step::Capture(name) => self.capture(name.clone()),
            Step::Mark(name) => {
                self.host.watched("mark", threads::rest);
                let mark = self.host.mark(name);
                self.host.report().marks.push(mark);
            }
            Step::Repeat { times, steps } => {
                for _ in 0..*times {
                    self.play(steps);
                }
            }
            Step::Random { seed, sequences, events } => self.random(*seed, *sequences, *events),
        }
    }

    fn expect(&self, step: &str, possible: bool) {
        if !possible {
            fatal(format!(
                "the script asks for {step} at a stage where Android never does: {:?}",
                self.stage
            ));
        }
    }

    /// Runs the main looper until `done` returns true. The message of a timeout contains `what`.
    fn wait(&self, what: &str, done: impl Fn(&Host) -> bool) {
        self.host.watched(what, || {
            while !done(self.host) {
                self.looper.pump(50, self.host.frames.event.raw());
                self.host.frames.event.clear();
            }
        });
    }

    /// Calls a callback with the gate open, since the application may answer from its frame loop.
    fn callback<T>(&mut self, what: &str, call: impl FnOnce(&mut Activity) -> T) -> T {
        let host = self.host;
        let Some(activity) = self.activity.as_deref_mut() else {
            fatal(format!("the script asks for {what} without an activity"))
        };
        host.frames.set_open(true);
        let result = host.watched(what, || call(activity));
        host.frames.set_open(false);
        self.looper.pump(0, -1);
        result
    }

    /// Calls a callback that takes only the activity.
    fn event(&mut self, what: &str, get: impl Fn(&Callbacks) -> Event) {
        self.callback(what, |activity| call!(activity, get(&activity.callbacks)));
    }

    /// Calls a callback that takes the window.
    fn window_event(&mut self, what: &str, get: impl Fn(&Callbacks) -> WindowEvent) {
        let window = &raw const self.host.window;
        self.callback(what, |activity| call!(activity, get(&activity.callbacks), window));
    }

    /// Calls a callback that Android may call in the current state. Returns the state, which the caller updates.
    fn advance(
        &mut self,
        step: &str,
        is_possible: bool,
        what: &str,
        get: impl Fn(&Callbacks) -> Event,
    ) -> &mut Stage {
        self.expect(step, is_possible);
        self.event(what, get);
        &mut self.stage
    }

    fn create(&mut self) {
        self.expect("create", !self.stage.created);
        let host = self.host;
        host.finish_asked.store(false, Ordering::Release);
        *lock(&host.shared[1]) = lock(&host.shared[0]).take();
        let activity = Box::leak(Box::new(Activity {
            native: ANativeActivity {
                callbacks: std::ptr::null_mut(),
                vm: jni::virtual_machine(),
                env: jni::environment(),
                clazz: jni::activity_reference(),
                internalDataPath: host.directories.internal.as_ptr(),
                externalDataPath: host.directories.external.as_ptr(),
                sdkVersion: host.device.sdk,
                instance: std::ptr::null_mut(),
                assetManager: std::ptr::dangling(),
                obbPath: host.directories.external.as_ptr(),
            },
            callbacks: Callbacks::default(),
        }));
        activity.native.callbacks = &raw mut activity.callbacks;
        self.activity = Some(activity);
        let (create, saved) = (self.create, std::mem::take(&mut self.saved));
        self.callback("ANativeActivity_onCreate", |activity| {
            let state: *const c_void =
                if saved.is_empty() { std::ptr::null() } else { saved.as_ptr().cast() };
            // SAFETY: the application's entry point gets a complete activity, on the main thread.
            unsafe { create(&raw mut activity.native, state, saved.len()) };
        });
        self.stage.created = true;
    }

    fn destroy(&mut self) {
        self.expect("destroy", self.stage.created && !self.stage.started);
        self.input_queue_lost();
        self.event("onDestroy", |callbacks| callbacks.onDestroy);
        self.host.frames.set_open(true);
        self.wait("the end of android_main", |host| !main_runs(host));
        self.host.frames.set_open(false);
        if let Some(activity) = self.activity.take() {
            jni::release_activity(activity.native.clazz);
        }
        self.stage = Stage::default();
    }

    fn quit(&mut self) {
        if self.stage.focus {
            self.focus(false);
        }
        if self.stage.resumed {
            self.step(&Step::Pause);
        }
        if self.stage.window {
            self.window_lost();
        }
        if self.stage.started {
            self.step(&Step::Stop);
        }
        if self.stage.created {
            self.destroy();
        }
    }

    fn input_queue(&mut self) {
        self.expect("input-queue", self.stage.created && self.queue.is_none());
        let queue = AInputQueue::fresh();
        self.queue = Some(queue);
        self.callback("onInputQueueCreated", |activity| {
            call!(activity, activity.callbacks.onInputQueueCreated, queue)
        });
    }

    fn input_queue_lost(&mut self) {
        let Some(queue) = self.queue.take() else { return };
        self.callback("onInputQueueDestroyed", |activity| {
            call!(activity, activity.callbacks.onInputQueueDestroyed, queue)
        });
        // After `android_main` has ended, it can no longer detach the queue, and android-activity does not do so.
        if queue.is_attached() && main_runs(self.host) {
            self.host.violation("the input queue is still attached after onInputQueueDestroyed");
        }
    }

    fn window(&mut self) {
        self.expect("window", self.stage.created && !self.stage.window);
        self.host.window.set_alive(true);
        self.stage.window = true;
        self.window_event("onNativeWindowCreated", |callbacks| callbacks.onNativeWindowCreated);
        self.content_rect();
        self.window_event("onNativeWindowRedrawNeeded", |callbacks| callbacks.onNativeWindowRedrawNeeded);
    }

    fn window_lost(&mut self) {
        self.expect("window-lost", self.stage.window);
        self.window_event("onNativeWindowDestroyed", |callbacks| callbacks.onNativeWindowDestroyed);
        self.host.window.set_alive(false);
        self.stage.window = false;
        if self.host.graphics.live_window_surfaces() > 0 {
            self.host.violation("an EGL surface of the window is alive after onNativeWindowDestroyed");
        }
    }

    fn content_rect(&mut self) {
        let (right, bottom) = self.host.window.size();
        let rect = ARect { left: 0, top: 0, right, bottom };
        self.callback("onContentRectChanged", |activity| {
            call!(activity, activity.callbacks.onContentRectChanged, &raw const rect)
        });
    }

    fn focus(&mut self, focus: bool) {
        self.expect("focus", self.stage.created);
        self.stage.focus = focus;
        self.callback("onWindowFocusChanged", |activity| {
            call!(activity, activity.callbacks.onWindowFocusChanged, i32::from(focus))
        });
    }

    fn save_state(&mut self) {
        self.expect("save-state", self.stage.created);
        self.saved = self.callback("onSaveInstanceState", |activity| {
            let Some(function) = activity.callbacks.onSaveInstanceState else { return Vec::new() };
            let mut size = 0;
            // SAFETY: the application's callback gets its own activity and room for the size, on the main thread.
            let state = unsafe { function(&raw mut activity.native, &raw mut size) };
            if state.is_null() {
                return Vec::new();
            }
            // SAFETY: the application returns `size` bytes from malloc, which the system then owns.
            unsafe {
                let bytes = std::slice::from_raw_parts(state.cast::<u8>(), size).to_vec();
                libc::free(state);
                bytes
            }
        });
    }

    /// True if frames are expected.
    fn renders(&self) -> bool {
        self.stage.resumed && self.stage.window
    }

    fn frames(&mut self, count: u64) {
        self.expect("frames", self.renders());
        let start = self.host.frames.shown();
        self.host.frames.grant(count);
        for shown in start + 1..=start + count {
            self.wait(&format!("frame {shown}"), |host| host.frames.shown() >= shown);
        }
        self.wait_for_gate();
    }

    /// Waits until a frame has been drawn and waits to be shown.
    fn wait_for_gate(&mut self) {
        self.host.frames.set_wanted(true);
        self.wait(&format!("frame {}", self.host.frames.shown() + 1), |host| host.frames.is_waiting());
        self.host.frames.set_wanted(false);
    }

    fn until(&mut self, instant: u64) {
        while self.host.clock.now() < instant {
            self.frames(1);
        }
    }

    fn seconds(&mut self, seconds: f64) {
        self.until(self.host.clock.now() + nanoseconds(seconds));
    }

    fn idle(&mut self, seconds: f64) {
        let clock = &self.host.clock;
        let end = clock.now() + nanoseconds(seconds);
        self.host.frames.set_open(true);
        while clock.now() < end {
            clock.advance_to(clock.next_refresh(clock.now()).min(end));
            looper::settle();
            self.looper.pump(0, -1);
        }
        self.host.frames.set_open(false);
    }

    fn wait_log(&mut self, text: &str, frames: u64) {
        for _ in 0..=frames {
            if let Some(line) = self.host.log.find(self.log_read, text) {
                self.log_read = line + 1;
                return;
            }
            self.frames(1);
        }
        fatal(format!("no log line contains \"{text}\" after {frames} frames"));
    }

    fn send(&mut self, event: AInputEvent) {
        let Some(queue) = self.queue else { fatal("the script sends input without an input queue") };
        queue.push(event);
    }

    fn touch(&mut self, x: f32, y: f32, duration: u64) {
        let (width, height) = self.host.window.size();
        let (x, y) = (x * width as f32, y * height as f32);
        let down = self.host.clock.now();
        self.send(AInputEvent::Motion { action: MotionAction::Down, x, y, time: down });
        self.until(down + duration);
        self.send(AInputEvent::Motion { action: MotionAction::Up, x, y, time: self.host.clock.now() });
        self.frames(2);
    }

    fn key(&mut self, key: Key) {
        for down in [true, false] {
            self.send(AInputEvent::Key { down, code: key as i32, time: self.host.clock.now() });
            if !self.finish_asked() {
                self.frames(1);
            }
        }
    }

    /// Answers the request for a permission as the user, in a dialog in front of the activity.
    fn answer(&mut self, is_allowed: bool) {
        self.wait("the question for a permission", |host| host.camera.is_asked.load(Ordering::Acquire));
        self.focus(false);
        self.step(&Step::Pause);
        self.host.camera.is_asked.store(false, Ordering::Release);
        self.host.camera.is_allowed.store(is_allowed, Ordering::Release);
        self.step(&Step::Resume);
        self.focus(true);
    }

    fn finish_asked(&self) -> bool {
        self.host.finish_asked.load(Ordering::Acquire)
    }

    fn capture(&mut self, name: PathBuf) {
        self.expect("capture", self.renders());
        self.wait_for_gate();
        self.host.frames.request_capture();
        let picture = std::cell::RefCell::new(None);
        self.wait("the picture of a frame", |host| {
            let mut picture = picture.borrow_mut();
            if picture.is_none() {
                *picture = host.frames.captured();
            }
            picture.is_some()
        });
        let path = self.out.join(name);
        let saved = match picture.into_inner() {
            Some(Ok(image)) => image.save(&path).map_err(|error| error.to_string()),
            Some(Err(error)) => Err(error),
            None => Err("there is none".into()),
        };
        if let Err(error) = saved {
            fatal(format!("the picture {} cannot be written: {error}", path.display()));
        }
    }

    fn random(&mut self, seed: u64, sequences: u32, events: u32) {
        let mut generator = Pcg64Mcg::seed_from_u64(seed);
        for sequence in 0..sequences {
            let count = generator.random_range(1..=events.max(1));
            let mut played = Vec::new();
            for _ in 0..count {
                let step =
                    random::step(&mut generator, self.stage, self.host.device.width, self.host.device.height);
                played.push(format!("{step:?}"));
                self.host
                    .set_context(format!("random sequence {sequence} of seed {seed}: {}", played.join(", ")));
                self.step(&step);
                if self.finish_asked() {
                    self.quit();
                }
            }
            for step in random::back_to_running(self.stage) {
                self.step(&step);
            }
            self.frames(1);
            self.host.set_context(String::new());
        }
    }
}

fn nanoseconds(seconds: f64) -> u64 {
    (seconds.max(0.0) * 1e9).round() as u64
}

/// True if the thread of `android_main` exists.
fn main_runs(host: &Host) -> bool {
    std::path::Path::new(&format!("/proc/self/task/{}", host.main_thread.load(Ordering::Acquire))).exists()
}
