//! Queries and requests that only Java can serve.

mod bindings;

use std::ffi::c_void;
use std::fs::File;
use std::os::fd::FromRawFd as _;
use std::sync::OnceLock;

use android_activity::AndroidApp;
use jni::Env;
use jni::errors::Result as JavaResult;
use jni::objects::{JObject, JObjectArray, JString};
use jni::refs::Global;
use jni::vm::JavaVM;
use jni::{jni_sig, jni_str};
use yoro_viewer::openxr::runtime::{Broker, Rows};

use crate::share::Given;
use bindings::{
    Activity, BatteryManager, Cursor, DisplayMetrics as Metrics, Intent, IntentFilter, PowerManager, Toast,
    Uri,
};

/// `BatteryManager.BATTERY_PROPERTY_*`.
#[derive(Clone, Copy, Debug)]
#[repr(i32)]
pub enum BatteryProperty {
    /// Remaining charge in microampere-hours.
    ChargeCounter = 1,
    /// Current, in microamperes by the specification.
    CurrentNow = 2,
    /// Level in percent.
    Capacity = 4,
    /// `BATTERY_STATUS_*`.
    Status = 6,
}

/// The extras of the sticky intent `ACTION_BATTERY_CHANGED`, in its units.
#[derive(Clone, Copy, Debug, Default)]
pub struct BatteryIntent {
    /// Level in units of `scale`.
    pub level: Option<i32>,
    /// Level of a full battery.
    pub scale: Option<i32>,
    /// Millivolts.
    pub voltage: Option<i32>,
    /// Tenths of a degree Celsius.
    pub temperature: Option<i32>,
    /// `BATTERY_PLUGGED_*`, 0 on battery.
    pub plugged: Option<i32>,
    /// `BATTERY_STATUS_*`.
    pub status: Option<i32>,
}

/// `Intent.FLAG_ACTIVITY_LAUNCHED_FROM_HISTORY`.
const LAUNCHED_FROM_HISTORY: i32 = 0x0010_0000;
const CAMERA: &str = "android.permission.CAMERA";
/// The actions with which other applications share something.
const SEND: &str = "android.intent.action.SEND";
const VIEW: &str = "android.intent.action.VIEW";

/// Metrics of the display that the activity is on.
#[derive(Clone, Copy, Debug)]
pub struct DisplayMetrics {
    /// Pixels per inch along both axes of the picture, for the display's mode.
    pub dpi: [f32; 2],
    /// Width and height of the picture in pixels; the user may have chosen a resolution other than the mode's.
    pub size: [i32; 2],
    /// Width and height of the display's mode in pixels, in the device's natural orientation.
    pub mode: [i32; 2],
    /// Refreshes per second; 0 if the reported value is implausible.
    pub refresh_hz: f32,
    /// `Surface.ROTATION_*`: the picture's rotation in steps of 90 degrees.
    pub rotation: i32,
}

/// The activity as Java sees it. It can be used on any thread; a thread stays attached to Java until it ends.
#[derive(Clone)]
pub struct Java {
    vm: JavaVM,
    app: AndroidApp,
}

impl Java {
    /// Returns the activity of an application.
    pub fn new(app: &AndroidApp) -> Java {
        // SAFETY: the process has one Java VM, which exists as long as the process.
        Java { vm: unsafe { JavaVM::from_raw(app.vm_as_ptr().cast()) }, app: app.clone() }
    }

    /// Queries the activity. An exception is logged and cleared, and gives `None`.
    fn ask<T>(&self, what: &str, question: impl FnOnce(&mut Env, &Activity) -> JavaResult<T>) -> Option<T> {
        self.try_ask(question).inspect_err(|error| log::debug!("{what}: {error}")).ok()
    }

    /// Queries the activity. An exception is cleared and returned.
    fn try_ask<T>(&self, question: impl FnOnce(&mut Env, &Activity) -> JavaResult<T>) -> JavaResult<T> {
        self.vm.attach_current_thread(|env| {
            let raw = self.app.activity_as_ptr() as jni::sys::jobject;
            // SAFETY: the pointer is a global reference that android-activity owns and keeps as long as `app` lives.
            let activity = unsafe { env.as_cast_raw::<Global<Activity<'static>>>(&raw)? };
            question(env, &activity)
        })
    }

    /// Returns the display's metrics; `None` if Java does not provide them.
    pub fn display_metrics(&self) -> Option<DisplayMetrics> {
        self.ask("the display", |env, activity| {
            let display = activity.get_window_manager(env)?.get_default_display(env)?;
            let mode = display.get_mode(env)?;
            // The metrics of the whole display; those of the resources exclude the parts reserved for the system.
            let metrics = Metrics::new(env)?;
            display.get_real_metrics(env, &metrics)?;
            let refresh_hz = display.get_refresh_rate(env)?;
            let is_plausible = (10.0..1000.0).contains(&refresh_hz);
            Ok(DisplayMetrics {
                dpi: [metrics.xdpi(env)?, metrics.ydpi(env)?],
                size: [metrics.width_pixels(env)?, metrics.height_pixels(env)?],
                mode: [mode.get_physical_width(env)?, mode.get_physical_height(env)?],
                refresh_hz: if is_plausible { refresh_hz } else { 0.0 },
                rotation: display.get_rotation(env)?,
            })
        })
    }

    /// True if this is a headset, on which showing a window instead is useless. Phones for Daydream also have
    /// `android.hardware.vr.headtracking`, but in version 0, with three degrees of freedom.
    pub fn is_headset(&self) -> bool {
        const FEATURES: [(&str, i32); 2] =
            [("android.hardware.vr.headtracking", 1), ("android.software.xr.api.openxr", 0)];
        let answer = self.ask("the package manager", |env, activity| {
            let manager = activity.get_package_manager(env)?;
            for (name, version) in FEATURES {
                let name = JString::new(env, name)?;
                if manager.has_system_feature(env, &name, version)? {
                    return Ok(true);
                }
            }
            Ok(false)
        });
        answer.unwrap_or_default()
    }

    /// Returns a global JNI reference to the application's context, if Java has one. It lasts as long as the process,
    /// for libraries that keep it after the activity is gone.
    pub fn application_context(&self) -> Option<*mut c_void> {
        static CONTEXT: OnceLock<Option<Global<JObject<'static>>>> = OnceLock::new();
        let context = CONTEXT.get_or_init(|| {
            self.ask("the application's context", |env, activity| {
                let context = activity.get_application_context(env)?;
                env.new_global_ref(context)
            })
        });
        context.as_ref().map(|context| context.as_raw().cast())
    }

    /// Turns sustained performance mode on or off, if the device has it: clock rates that can be held for long instead
    /// of higher ones that cannot. Returns true if the device has it.
    pub fn sustain_performance(&self, is_on: bool) -> bool {
        let is_offered = self.ask("the power manager", |env, activity| {
            let name = JString::new(env, "power")?;
            let manager = activity.get_system_service(env, &name)?;
            env.cast_local::<PowerManager>(manager)?.is_sustained_performance_mode_supported(env)
        });
        let is_offered = is_offered.unwrap_or_default();
        if is_offered {
            self.on_main_thread("sustained performance mode", move |env, activity| {
                activity.get_window(env)?.set_sustained_performance_mode(env, is_on)
            });
        }
        is_offered
    }

    /// Returns the extras of the intent that started the activity, as texts.
    pub fn extras(&self) -> Vec<(String, String)> {
        let extras = self.ask("the intent's extras", |env, activity| {
            let mut pairs = Vec::new();
            let intent = activity.get_intent(env)?;
            if intent.is_null() {
                return Ok(pairs);
            }
            let bundle = intent.get_extras(env)?;
            if bundle.is_null() {
                return Ok(pairs);
            }
            let keys = bundle.key_set(env)?.iterator(env)?;
            while keys.has_next(env)? {
                let Some(key) = keys.next(env)? else { break };
                let key = env.cast_local::<JString>(key)?;
                let value = bundle.get(env, &key)?;
                if !value.is_null() {
                    pairs.push((key.try_to_string(env)?, text(env, &value)?));
                }
            }
            Ok(pairs)
        });
        extras.unwrap_or_default()
    }

    /// True if the activity was started by an intent with which another application shares something. What is shared
    /// while the activity runs does not arrive: `onNewIntent` is a Java method that NativeActivity does not pass on.
    pub fn is_shared(&self) -> bool {
        let is_shared = self.ask("the shared", |env, activity| {
            let intent = activity.get_intent(env)?;
            // An activity started again from the list of recent applications gets the intent of its first start.
            if intent.is_null() || intent.get_flags(env)? & LAUNCHED_FROM_HISTORY != 0 {
                return Ok(false);
            }
            let action = intent.get_action(env)?;
            Ok(!action.is_null() && [SEND, VIEW].contains(&action.try_to_string(env)?.as_str()))
        });
        is_shared.unwrap_or_default()
    }

    /// Returns what another application shares, if [`Java::is_shared`]. The file's owner may take long to answer.
    pub fn given(&self) -> Given {
        let given = self.ask("the shared", |env, activity| {
            let intent = activity.get_intent(env)?;
            let action = intent.get_action(env)?.try_to_string(env)?;
            let uri = match action.as_str() {
                SEND => {
                    // A picture may be accompanied by text.
                    let name = JString::new(env, "android.intent.extra.STREAM")?;
                    let stream = intent.get_parcelable_extra(env, &name)?;
                    if stream.is_null() {
                        let name = JString::new(env, "android.intent.extra.TEXT")?;
                        let shared = intent.get_char_sequence_extra(env, &name)?;
                        let shared = if shared.is_null() { None } else { Some(text(env, &shared)?) };
                        return Ok(shared.map(Given::Text));
                    }
                    env.cast_local::<Uri>(stream)?
                }
                _ => intent.get_data(env)?,
            };
            if uri.is_null() {
                return Ok(None);
            }
            let address = text(env, &uri)?;
            if address.starts_with("http://") || address.starts_with("https://") {
                return Ok(Some(Given::Text(address)));
            }
            // The file may be one of yoro's own.
            if address.starts_with("file:") {
                return Ok(Some(Given::Closed));
            }
            let last = address.rsplit('/').next().unwrap_or_default().to_owned();
            let shown = query(env, activity, &address, &["_display_name"]).ok().flatten();
            env.exception_clear();
            let shown = shown.and_then(|rows| rows.into_iter().flatten().flatten().next());
            let file = open(env, activity, &uri, "r").ok().flatten();
            env.exception_clear();
            Ok(Some(file.map_or(Given::Closed, |file| Given::File(file, shown.unwrap_or(last)))))
        });
        given.flatten().unwrap_or(Given::Closed)
    }

    /// True if the user lets yoro use the camera.
    pub fn may_use_camera(&self) -> bool {
        const GRANTED: i32 = 0;
        let answer = self.ask("the permission", |env, activity| {
            let name = JString::new(env, CAMERA)?;
            activity.check_self_permission(env, &name)
        });
        answer == Some(GRANTED)
    }

    /// Asks the user for permission to use the camera. The answer is known when the activity is in the foreground
    /// again. If the user has refused twice, Android answers without asking.
    pub fn ask_for_camera(&self) {
        self.on_main_thread("the permission", |env, activity| {
            let names = env.new_object_type_array::<JString>(1, JString::null())?;
            let name = JString::new(env, CAMERA)?;
            names.set_element(env, 0, &name)?;
            activity.request_permissions(env, &names, 1)
        });
    }

    /// Lets the user share a text with another application. An intent can hold at most half a megabyte.
    pub fn share(&self, title: &'static str, shared: String) {
        self.on_main_thread("sharing", move |env, activity| {
            let action = JString::new(env, SEND)?;
            let intent = Intent::new(env, &action)?;
            let kind = JString::new(env, "text/plain")?;
            intent.set_type(env, &kind)?;
            let (name, value) =
                (JString::new(env, "android.intent.extra.TEXT")?, JString::new(env, &shared)?);
            intent.put_extra(env, &name, &value)?;
            let title = JString::new(env, title)?;
            let chooser = Intent::create_chooser(env, &intent, title.as_char_sequence())?;
            activity.start_activity(env, &chooser)
        });
    }

    /// Raises the screen's brightness to the maximum, or returns it to the user's setting.
    pub fn raise_brightness(&self, is_raised: bool) {
        // BRIGHTNESS_OVERRIDE_FULL and BRIGHTNESS_OVERRIDE_NONE.
        let brightness = if is_raised { 1.0 } else { -1.0 };
        self.on_main_thread("the brightness", move |env, activity| {
            let window = activity.get_window(env)?;
            let attributes = window.get_attributes(env)?;
            attributes.set_screen_brightness(env, brightness)?;
            window.set_attributes(env, &attributes)
        });
    }

    /// True while the device is awake, or if it does not say.
    pub fn is_awake(&self) -> bool {
        let answer = self.ask("the power manager", |env, activity| {
            let name = JString::new(env, "power")?;
            let manager = activity.get_system_service(env, &name)?;
            env.cast_local::<PowerManager>(manager)?.is_interactive(env)
        });
        answer.unwrap_or(true)
    }

    /// Returns the number of the game loop's scenario for which the activity was started; `None` for any other start.
    pub fn scenario(&self) -> Option<i32> {
        let scenario = self.ask("the intent's scenario", |env, activity| {
            let intent = activity.get_intent(env)?;
            let action = if intent.is_null() { JString::null() } else { intent.get_action(env)? };
            if action.is_null() || action.try_to_string(env)? != "com.google.intent.action.TEST_LOOP" {
                return Ok(None);
            }
            let name = JString::new(env, "scenario")?;
            intent.get_int_extra(env, &name, 0).map(Some)
        });
        scenario.flatten()
    }

    /// Opens the file for a game loop's results that the intent's data names; `None` if it names none or Android
    /// refuses.
    pub fn results(&self) -> Option<File> {
        let file = self.ask("the game loop's results", |env, activity| {
            let uri = activity.get_intent(env)?.get_data(env)?;
            if uri.is_null() {
                return Ok(None);
            }
            open(env, activity, &uri, "w")
        });
        file.flatten()
    }

    /// Returns one of the battery's properties; `None` if the device does not support it, which Android reports as
    /// `Integer.MIN_VALUE`.
    pub fn battery(&self, property: BatteryProperty) -> Option<i32> {
        let value = self.ask("the battery manager", |env, activity| {
            let name = JString::new(env, "batterymanager")?;
            let manager = activity.get_system_service(env, &name)?;
            env.cast_local::<BatteryManager>(manager)?.get_int_property(env, property as i32)
        });
        value.filter(|value| *value != i32::MIN)
    }

    /// Returns the system's last broadcast about the battery.
    pub fn battery_intent(&self) -> BatteryIntent {
        let answer = self.ask("the battery's intent", |env, activity| {
            let action = JString::new(env, "android.intent.action.BATTERY_CHANGED")?;
            let filter = IntentFilter::new(env, &action)?;
            // Without a receiver the call registers nothing and only returns the last broadcast.
            let intent = activity.register_receiver(env, JObject::null(), &filter)?;
            if intent.is_null() {
                return Ok(BatteryIntent::default());
            }
            let mut number = |name: &str| -> JavaResult<Option<i32>> {
                let name = JString::new(env, name)?;
                let value = intent.get_int_extra(env, &name, i32::MIN)?;
                Ok(Some(value).filter(|value| *value != i32::MIN))
            };
            Ok(BatteryIntent {
                level: number("level")?,
                scale: number("scale")?,
                voltage: number("voltage")?,
                temperature: number("temperature")?,
                plugged: number("plugged")?,
                status: number("status")?,
            })
        });
        answer.unwrap_or_default()
    }

    /// Hides the system's bars, also after the user has swiped them in. They return when another window gets the focus,
    /// so this must be called whenever the focus returns.
    pub fn hide_system_bars(&self) {
        // SYSTEM_UI_FLAG_* LAYOUT_STABLE | LAYOUT_HIDE_NAVIGATION | LAYOUT_FULLSCREEN | HIDE_NAVIGATION | FULLSCREEN |
        // IMMERSIVE_STICKY: deprecated since API 30, but the only way that works from API 29 on.
        const FLAGS: i32 = 0x100 | 0x200 | 0x400 | 0x2 | 0x4 | 0x1000;
        self.on_main_thread("the system's bars", |env, activity| {
            activity.get_window(env)?.get_decor_view(env)?.set_system_ui_visibility(env, FLAGS)
        });
    }

    /// Shows a sentence over the screen's content.
    pub fn toast(&self, sentence: &str) {
        const LENGTH_LONG: i32 = 1;
        let sentence = sentence.to_owned();
        self.on_main_thread("a toast", move |env, activity| {
            let text = JString::new(env, &sentence)?;
            Toast::make_text(env, activity, text.as_char_sequence(), LENGTH_LONG)?.show(env)
        });
    }

    /// Asks Android to end the activity. The usual events follow, up to `Destroy`.
    pub fn finish(&self) {
        self.on_main_thread("the activity's end", |env, activity| activity.finish(env));
    }

    /// Runs something on the activity's main thread, since views belong to the thread that created them.
    fn on_main_thread(
        &self,
        what: &'static str,
        action: impl FnOnce(&mut Env, &Activity) -> JavaResult<()> + Send + 'static,
    ) {
        let java = self.clone();
        self.app.run_on_java_main_thread(Box::new(move || {
            java.ask(what, action);
        }));
    }
}

/// Content providers, through `ContentResolver.query`.
impl Broker for Java {
    fn query(&self, uri: &str, columns: &[&str]) -> Result<Option<Rows>, String> {
        self.try_ask(|env, activity| query(env, activity, uri, columns)).map_err(|error| error.to_string())
    }
}

/// Opens the file that a URI names, through the content resolver; `None` if there is none.
fn open(env: &mut Env, activity: &Activity, uri: &Uri, mode: &str) -> JavaResult<Option<File>> {
    let mode = JString::new(env, mode)?;
    let opened = activity.get_content_resolver(env)?.open_file_descriptor(env, uri, &mode)?;
    if opened.is_null() {
        return Ok(None);
    }
    // SAFETY: a detached descriptor belongs to the caller, and nothing else closes it.
    Ok(Some(unsafe { File::from_raw_fd(opened.detach_fd(env)?) }))
}

/// Returns all rows of a provider's table; `None` if there is no provider.
fn query(env: &mut Env, activity: &Activity, uri: &str, columns: &[&str]) -> JavaResult<Option<Rows>> {
    let resolver = activity.get_content_resolver(env)?;
    let uri = JString::new(env, uri)?;
    let uri = Uri::parse(env, &uri)?;
    let names = env.new_object_type_array::<JString>(columns.len(), JString::null())?;
    for (i, column) in columns.iter().enumerate() {
        let name = JString::new(env, column)?;
        names.set_element(env, i, &name)?;
    }
    let (none, nothing) = (JObjectArray::<JString>::null(), JString::null());
    let cursor = resolver.query(env, &uri, &names, &nothing, &none, &nothing)?;
    if cursor.is_null() {
        return Ok(None);
    }
    let rows = read_rows(env, &cursor, columns);
    cursor.close(env)?;
    rows.map(Some)
}

fn read_rows(env: &mut Env, cursor: &Cursor, columns: &[&str]) -> JavaResult<Rows> {
    let mut indices = Vec::new();
    for column in columns {
        let name = JString::new(env, column)?;
        indices.push(cursor.get_column_index(env, &name)?);
    }
    let mut rows = Rows::new();
    while cursor.move_to_next(env)? {
        let mut row = Vec::new();
        for &index in &indices {
            // A column that does not exist has the index -1.
            let cell = if index < 0 { JString::null() } else { cursor.get_string(env, index)? };
            row.push(if cell.is_null() { None } else { Some(cell.try_to_string(env)?) });
        }
        rows.push(row);
    }
    Ok(rows)
}

/// Returns the result of `toString()`.
fn text(env: &mut Env, object: &JObject) -> JavaResult<String> {
    let string = env.call_method(object, jni_str!("toString"), jni_sig!("()Ljava/lang/String;"), &[])?.l()?;
    env.cast_local::<JString>(string)?.try_to_string(env)
}
