//! Everything that only Java can be asked for.

use std::ffi::c_void;
use std::sync::OnceLock;

use android_activity::AndroidApp;
use jni::objects::{JObject, JString};
use jni::refs::Global;
use jni::vm::JavaVM;
use jni::{Env, JValue, jni_sig, jni_str};
use yoro_viewer::openxr::runtime::{Broker, Rows};

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

/// What the sticky intent `ACTION_BATTERY_CHANGED` says, as it says it.
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

/// What Android says of the display that the activity is on.
#[derive(Clone, Copy, Debug)]
pub struct DisplayMetrics {
    /// Pixels per inch along both axes of the picture: of the display's mode.
    pub dpi: [f32; 2],
    /// Width and height of the picture in pixels, which the user may have made others than the mode's.
    pub size: [i32; 2],
    /// Width and height of the display's mode in pixels, in the device's natural position.
    pub mode: [i32; 2],
    /// Refreshes per second; 0 where the answer is implausible.
    pub refresh_hz: f32,
    /// `Surface.ROTATION_*`: how often the picture is turned by 90 degrees.
    pub rotation: i32,
}

/// The activity as Java sees it. Any thread may ask; a thread stays attached to Java until it ends.
#[derive(Clone)]
pub struct Java {
    vm: JavaVM,
    app: AndroidApp,
}

impl Java {
    /// The activity of an application.
    pub fn new(app: &AndroidApp) -> Java {
        // SAFETY: the process has one Java VM, which is there as long as the process is.
        Java { vm: unsafe { JavaVM::from_raw(app.vm_as_ptr().cast()) }, app: app.clone() }
    }

    /// Asks the activity; an exception is logged, cleared and means no answer.
    fn ask<T>(
        &self,
        what: &str,
        question: impl FnOnce(&mut Env, &JObject) -> jni::errors::Result<T>,
    ) -> Option<T> {
        self.try_ask(question).inspect_err(|error| log::debug!("{what}: {error}")).ok()
    }

    /// Asks the activity; an exception is cleared and returned.
    fn try_ask<T>(
        &self,
        question: impl FnOnce(&mut Env, &JObject) -> jni::errors::Result<T>,
    ) -> jni::errors::Result<T> {
        self.vm.attach_current_thread(|env| -> jni::errors::Result<T> {
            let raw = self.app.activity_as_ptr() as jni::sys::jobject;
            // SAFETY: a global reference that android-activity owns and keeps as long as `app` lives.
            let activity = unsafe { env.as_cast_raw::<Global<JObject<'static>>>(&raw)? };
            question(env, activity.as_ref())
        })
    }

    /// The display, if Java says anything of it.
    pub fn display_metrics(&self) -> Option<DisplayMetrics> {
        self.ask("the display", |env, activity| {
            let manager = env
                .call_method(
                    activity,
                    jni_str!("getWindowManager"),
                    jni_sig!("()Landroid/view/WindowManager;"),
                    &[],
                )?
                .l()?;
            let display = env
                .call_method(
                    &manager,
                    jni_str!("getDefaultDisplay"),
                    jni_sig!("()Landroid/view/Display;"),
                    &[],
                )?
                .l()?;
            let refresh_hz =
                env.call_method(&display, jni_str!("getRefreshRate"), jni_sig!("()F"), &[])?.f()?;
            let rotation = env.call_method(&display, jni_str!("getRotation"), jni_sig!("()I"), &[])?.i()?;
            // Of the whole display; those of the resources leave out what the system keeps for itself.
            let metrics = env.new_object(jni_str!("android/util/DisplayMetrics"), jni_sig!("()V"), &[])?;
            env.call_method(
                &display,
                jni_str!("getRealMetrics"),
                jni_sig!("(Landroid/util/DisplayMetrics;)V"),
                &[JValue::Object(&metrics)],
            )?
            .v()?;
            let x = env.get_field(&metrics, jni_str!("xdpi"), jni_sig!("F"))?.f()?;
            let y = env.get_field(&metrics, jni_str!("ydpi"), jni_sig!("F"))?.f()?;
            let width = env.get_field(&metrics, jni_str!("widthPixels"), jni_sig!("I"))?.i()?;
            let height = env.get_field(&metrics, jni_str!("heightPixels"), jni_sig!("I"))?.i()?;
            let mode = env
                .call_method(&display, jni_str!("getMode"), jni_sig!("()Landroid/view/Display$Mode;"), &[])?
                .l()?;
            let mode_width =
                env.call_method(&mode, jni_str!("getPhysicalWidth"), jni_sig!("()I"), &[])?.i()?;
            let mode_height =
                env.call_method(&mode, jni_str!("getPhysicalHeight"), jni_sig!("()I"), &[])?.i()?;
            let plausible = (10.0..1000.0).contains(&refresh_hz);
            let refresh_hz = if plausible { refresh_hz } else { 0.0 };
            Ok(DisplayMetrics {
                dpi: [x, y],
                size: [width, height],
                mode: [mode_width, mode_height],
                refresh_hz,
                rotation,
            })
        })
    }

    /// Whether this is a headset: there it is no use to show a window instead. Phones for Daydream have
    /// `android.hardware.vr.headtracking`, too, but in version 0, of three degrees of freedom.
    pub fn is_headset(&self) -> bool {
        const FEATURES: [(&str, i32); 2] =
            [("android.hardware.vr.headtracking", 1), ("android.software.xr.api.openxr", 0)];
        let answer = self.ask("the package manager", |env, activity| {
            let manager = env
                .call_method(
                    activity,
                    jni_str!("getPackageManager"),
                    jni_sig!("()Landroid/content/pm/PackageManager;"),
                    &[],
                )?
                .l()?;
            for (name, version) in FEATURES {
                let name = JString::new(env, name)?;
                let arguments = [JValue::Object(name.as_ref()), JValue::Int(version)];
                let signature = jni_sig!("(Ljava/lang/String;I)Z");
                if env.call_method(&manager, jni_str!("hasSystemFeature"), signature, &arguments)?.z()? {
                    return Ok(true);
                }
            }
            Ok(false)
        });
        answer.unwrap_or_default()
    }

    /// A global JNI reference to the application's context, which lasts as long as the process: for libraries that keep it
    /// after the activity is gone. None where Java gives none.
    pub fn application_context(&self) -> Option<*mut c_void> {
        static CONTEXT: OnceLock<Option<Global<JObject<'static>>>> = OnceLock::new();
        let context = CONTEXT.get_or_init(|| {
            self.ask("the application's context", |env, activity| {
                let signature = jni_sig!("()Landroid/content/Context;");
                let context =
                    env.call_method(activity, jni_str!("getApplicationContext"), signature, &[])?.l()?;
                env.new_global_ref(context)
            })
        });
        context.as_ref().map(|context| context.as_raw().cast())
    }

    /// Turns sustained performance mode on or off, where the device has it: clock rates that can be held for long instead of
    /// high ones that cannot. Whether the device has it.
    pub fn sustain_performance(&self, is_on: bool) -> bool {
        let is_offered = self.ask("the power manager", |env, activity| {
            let name = JString::new(env, "power")?;
            let manager = env
                .call_method(
                    activity,
                    jni_str!("getSystemService"),
                    jni_sig!("(Ljava/lang/String;)Ljava/lang/Object;"),
                    &[JValue::Object(name.as_ref())],
                )?
                .l()?;
            let question = jni_str!("isSustainedPerformanceModeSupported");
            env.call_method(&manager, question, jni_sig!("()Z"), &[])?.z()
        });
        let is_offered = is_offered.unwrap_or_default();
        if is_offered {
            self.on_main_thread("sustained performance mode", move |env, activity| {
                let window = env
                    .call_method(activity, jni_str!("getWindow"), jni_sig!("()Landroid/view/Window;"), &[])?
                    .l()?;
                let arguments = [JValue::Bool(is_on)];
                let name = jni_str!("setSustainedPerformanceMode");
                env.call_method(&window, name, jni_sig!("(Z)V"), &arguments)?.v()
            });
        }
        is_offered
    }

    /// The extras of the intent that started the activity, as texts.
    pub fn extras(&self) -> Vec<(String, String)> {
        let extras = self.ask("the intent's extras", |env, activity| {
            let intent = env
                .call_method(activity, jni_str!("getIntent"), jni_sig!("()Landroid/content/Intent;"), &[])?
                .l()?;
            if intent.is_null() {
                return Ok(Vec::new());
            }
            let bundle = env
                .call_method(&intent, jni_str!("getExtras"), jni_sig!("()Landroid/os/Bundle;"), &[])?
                .l()?;
            if bundle.is_null() {
                return Ok(Vec::new());
            }
            let keys =
                env.call_method(&bundle, jni_str!("keySet"), jni_sig!("()Ljava/util/Set;"), &[])?.l()?;
            let iterator =
                env.call_method(&keys, jni_str!("iterator"), jni_sig!("()Ljava/util/Iterator;"), &[])?.l()?;
            let mut pairs = Vec::new();
            while env.call_method(&iterator, jni_str!("hasNext"), jni_sig!("()Z"), &[])?.z()? {
                let key = env
                    .call_method(&iterator, jni_str!("next"), jni_sig!("()Ljava/lang/Object;"), &[])?
                    .l()?;
                let value = env
                    .call_method(
                        &bundle,
                        jni_str!("get"),
                        jni_sig!("(Ljava/lang/String;)Ljava/lang/Object;"),
                        &[JValue::Object(&key)],
                    )?
                    .l()?;
                if !value.is_null() {
                    pairs.push((text(env, &key)?, text(env, &value)?));
                }
            }
            Ok(pairs)
        });
        extras.unwrap_or_default()
    }

    /// One of the battery's properties; none where the device does not support it, for which Android says
    /// `Integer.MIN_VALUE`.
    pub fn battery(&self, property: BatteryProperty) -> Option<i32> {
        let value = self.ask("the battery manager", |env, activity| {
            let name = JString::new(env, "batterymanager")?;
            let manager = env
                .call_method(
                    activity,
                    jni_str!("getSystemService"),
                    jni_sig!("(Ljava/lang/String;)Ljava/lang/Object;"),
                    &[JValue::Object(name.as_ref())],
                )?
                .l()?;
            env.call_method(
                &manager,
                jni_str!("getIntProperty"),
                jni_sig!("(I)I"),
                &[JValue::Int(property as i32)],
            )?
            .i()
        });
        value.filter(|value| *value != i32::MIN)
    }

    /// What the system last broadcast of the battery.
    pub fn battery_intent(&self) -> BatteryIntent {
        let answer = self.ask("the battery's intent", |env, activity| {
            let action = JString::new(env, "android.intent.action.BATTERY_CHANGED")?;
            let filter = env.new_object(
                jni_str!("android/content/IntentFilter"),
                jni_sig!("(Ljava/lang/String;)V"),
                &[JValue::Object(action.as_ref())],
            )?;
            // Without a receiver nothing is registered: the call only returns the last broadcast.
            let intent = env
                .call_method(
                    activity,
                    jni_str!("registerReceiver"),
                    jni_sig!(
                        "(Landroid/content/BroadcastReceiver;Landroid/content/IntentFilter;)Landroid/content/Intent;"
                    ),
                    &[JValue::Object(&JObject::null()), JValue::Object(&filter)],
                )?
                .l()?;
            if intent.is_null() {
                return Ok(BatteryIntent::default());
            }
            let mut number = |name: &str| -> jni::errors::Result<Option<i32>> {
                let name = JString::new(env, name)?;
                let arguments = [JValue::Object(name.as_ref()), JValue::Int(i32::MIN)];
                let value = env
                    .call_method(&intent, jni_str!("getIntExtra"), jni_sig!("(Ljava/lang/String;I)I"), &arguments)?
                    .i()?;
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

    /// Hides the system's bars, also after the user has swiped them in. They come back with the focus of other
    /// windows, so call it whenever the focus is won.
    pub fn hide_system_bars(&self) {
        // SYSTEM_UI_FLAG_* LAYOUT_STABLE | LAYOUT_HIDE_NAVIGATION | LAYOUT_FULLSCREEN | HIDE_NAVIGATION | FULLSCREEN |
        // IMMERSIVE_STICKY: deprecated since API 30, and the one way that works from API 29 on.
        const FLAGS: i32 = 0x100 | 0x200 | 0x400 | 0x2 | 0x4 | 0x1000;
        self.on_main_thread("the system's bars", |env, activity| {
            let window = env
                .call_method(activity, jni_str!("getWindow"), jni_sig!("()Landroid/view/Window;"), &[])?
                .l()?;
            let view = env
                .call_method(&window, jni_str!("getDecorView"), jni_sig!("()Landroid/view/View;"), &[])?
                .l()?;
            env.call_method(
                &view,
                jni_str!("setSystemUiVisibility"),
                jni_sig!("(I)V"),
                &[JValue::Int(FLAGS)],
            )?
            .v()
        });
    }

    /// Shows a sentence over whatever is on the screen.
    pub fn toast(&self, sentence: &str) {
        const LENGTH_LONG: i32 = 1;
        let sentence = sentence.to_owned();
        self.on_main_thread("a toast", move |env, activity| {
            let text = JString::new(env, &sentence)?;
            let toast = env
                .call_static_method(
                    jni_str!("android/widget/Toast"),
                    jni_str!("makeText"),
                    jni_sig!("(Landroid/content/Context;Ljava/lang/CharSequence;I)Landroid/widget/Toast;"),
                    &[JValue::Object(activity), JValue::Object(text.as_ref()), JValue::Int(LENGTH_LONG)],
                )?
                .l()?;
            env.call_method(&toast, jni_str!("show"), jni_sig!("()V"), &[])?.v()
        });
    }

    /// Asks Android to end the activity. The events of its end follow, up to `Destroy`.
    pub fn finish(&self) {
        self.on_main_thread("the activity's end", |env, activity| {
            env.call_method(activity, jni_str!("finish"), jni_sig!("()V"), &[])?.v()
        });
    }

    /// Views belong to the thread that made them.
    fn on_main_thread(
        &self,
        what: &'static str,
        action: impl FnOnce(&mut Env, &JObject) -> jni::errors::Result<()> + Send + 'static,
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
        self.try_ask(|env, activity| rows(env, activity, uri, columns)).map_err(|error| error.to_string())
    }
}

/// All rows of a table.
fn rows(env: &mut Env, activity: &JObject, uri: &str, columns: &[&str]) -> jni::errors::Result<Option<Rows>> {
    let resolver = env
        .call_method(
            activity,
            jni_str!("getContentResolver"),
            jni_sig!("()Landroid/content/ContentResolver;"),
            &[],
        )?
        .l()?;
    let text = JString::new(env, uri)?;
    let uri = env
        .call_static_method(
            jni_str!("android/net/Uri"),
            jni_str!("parse"),
            jni_sig!("(Ljava/lang/String;)Landroid/net/Uri;"),
            &[JValue::Object(text.as_ref())],
        )?
        .l()?;
    let names = env.new_object_type_array::<JString>(columns.len(), JString::null())?;
    for (i, column) in columns.iter().enumerate() {
        let name = JString::new(env, column)?;
        names.set_element(env, i, &name)?;
    }
    let null = JObject::null();
    let cursor = env
        .call_method(
            &resolver,
            jni_str!("query"),
            jni_sig!(
                "(Landroid/net/Uri;[Ljava/lang/String;Ljava/lang/String;[Ljava/lang/String;Ljava/lang/String;)Landroid/database/Cursor;"
            ),
            &[
                JValue::Object(&uri),
                JValue::Object(names.as_ref()),
                JValue::Object(&null),
                JValue::Object(&null),
                JValue::Object(&null),
            ],
        )?
        .l()?;
    if cursor.is_null() {
        return Ok(None);
    }
    let read = read_rows(env, &cursor, columns);
    env.call_method(&cursor, jni_str!("close"), jni_sig!("()V"), &[])?.v()?;
    read.map(Some)
}

fn read_rows(env: &mut Env, cursor: &JObject, columns: &[&str]) -> jni::errors::Result<Rows> {
    let mut indices = Vec::new();
    for column in columns {
        let name = JString::new(env, column)?;
        let index = env
            .call_method(
                cursor,
                jni_str!("getColumnIndex"),
                jni_sig!("(Ljava/lang/String;)I"),
                &[JValue::Object(name.as_ref())],
            )?
            .i()?;
        indices.push(index);
    }
    let mut rows = Rows::new();
    while env.call_method(cursor, jni_str!("moveToNext"), jni_sig!("()Z"), &[])?.z()? {
        let mut row = Vec::new();
        for &index in &indices {
            if index < 0 {
                row.push(None);
                continue;
            }
            let cell = env
                .call_method(
                    cursor,
                    jni_str!("getString"),
                    jni_sig!("(I)Ljava/lang/String;"),
                    &[JValue::Int(index)],
                )?
                .l()?;
            row.push(if cell.is_null() {
                None
            } else {
                Some(env.cast_local::<JString>(cell)?.try_to_string(env)?)
            });
        }
        rows.push(row);
    }
    Ok(rows)
}

/// `toString()`.
fn text(env: &mut Env, object: &JObject) -> jni::errors::Result<String> {
    let string = env.call_method(object, jni_str!("toString"), jni_sig!("()Ljava/lang/String;"), &[])?.l()?;
    env.cast_local::<JString>(string)?.try_to_string(env)
}
