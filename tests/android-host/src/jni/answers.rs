//! Results of Java methods and values of fields.

use std::collections::BTreeMap;
use std::io::Write as _;
use std::os::fd::IntoRawFd as _;
use std::sync::atomic::Ordering;
use std::sync::{Arc, MutexGuard};

use crate::clock::REFRESH_HZ;
use crate::host::{Host, host, lock};
use crate::jni::{Data, Member, Object, Value};
use crate::script::Battery;

/// BatteryManager returns `Integer.MIN_VALUE` or `Long.MIN_VALUE` for "unsupported".
const UNSUPPORTED: i32 = i32::MIN;
const CAMERA: &str = "android.permission.CAMERA";
/// Pixels per inch of a phone's screen with a width of 110 mm and few pixels.
const DPI: f32 = 74.0;

/// Returns the result of a call, or `None` if the method is not known.
pub fn call(receiver: &Object, member: &Member, arguments: &[Value]) -> Option<Value> {
    let host = host();
    let text = |index: usize| match arguments.get(index) {
        Some(Value::Object(Some(object))) => object.text().map(str::to_owned),
        _ => None,
    };
    let int = |index: usize| match arguments.get(index) {
        Some(Value::Int(value)) => *value,
        _ => 0,
    };
    let texts = |index: usize| match arguments.get(index)? {
        Value::Object(Some(object)) => {
            let items = items_of(object)?;
            Some(items.iter().flatten().filter_map(|item| item.text().map(str::to_owned)).collect::<Vec<_>>())
        }
        _ => None,
    };
    let items = || items_of(receiver);
    let extras = || match &receiver.data {
        Data::Extras(extras) => Some(extras),
        _ => None,
    };
    let class = match &receiver.data {
        Data::Class(name) => name.as_str(),
        _ => receiver.class.as_str(),
    };
    Some(match member.name.as_str() {
        "<init>" => Value::Void,
        "forName" => Value::object(Object::class_of(&text(0)?.replace('.', "/"))),
        "getName" if receiver.class == "java/lang/Class" => {
            Value::object(Object::string(&class.replace('/', ".")))
        }
        "toString" => Value::object(Object::string(receiver.text().unwrap_or(class))),
        // Objects without data, of the class in the signature.
        "getApplication"
        | "getAssets"
        | "getClassLoader"
        | "getContentResolver"
        | "getContextClassLoader"
        | "getWindow"
        | "getDecorView"
        | "getWindowManager"
        | "getDefaultDisplay"
        | "getMode"
        | "getAttributes"
        | "createChooser"
        | "setType"
        | "getPackageManager"
        | "currentThread" => Value::object(Object::new(member.returned_class()?, Data::None)),
        "getApplicationContext" => Value::object(Object::new("android/app/Application", Data::None)),
        "setContextClassLoader" | "setName" | "setSystemUiVisibility" | "setAttributes" | "hide" | "show"
            if member.signature.ends_with(")V") =>
        {
            Value::Void
        }

        "setSustainedPerformanceMode" => {
            let is_on = matches!(arguments.first(), Some(Value::Boolean(true)));
            host.request(format!("sustained performance {}", if is_on { "on" } else { "off" }));
            Value::Void
        }
        "isSustainedPerformanceModeSupported" => Value::Boolean(true),
        "hasSystemFeature" => {
            let version = host.device.features.get(&text(0)?);
            Value::Boolean(version.is_some_and(|version| *version >= int(1)))
        }
        "finish" if member.signature == "()V" => {
            host.finish_asked.store(true, Ordering::Release);
            Value::Void
        }
        "parse" if class == "android/net/Uri" => Value::object(uri(&text(0)?)),
        "putExtra" => {
            let lines = text(1)?.lines().count();
            host.request(format!("{} of {lines} lines", text(0)?));
            Value::object(Object::new("android/content/Intent", Data::None))
        }
        "startActivity" => {
            host.request("another application");
            Value::Void
        }
        "checkSelfPermission" => {
            let is_allowed = text(0)? == CAMERA && host.camera.is_allowed.load(Ordering::Acquire);
            Value::Int(if is_allowed { 0 } else { -1 })
        }
        "requestPermissions" => {
            host.request("a permission");
            let asked = texts(0)?.iter().any(|name| name == CAMERA);
            host.camera.is_asked.store(asked, Ordering::Release);
            Value::Void
        }
        "isInteractive" => Value::Boolean(true),
        "query" if class == "android/content/ContentResolver" => {
            Value::Object(crate::openxr::query(&text(0)?, texts(1).unwrap_or_default()))
        }
        "getColumnIndex" | "moveToNext" | "getString" | "close"
            if matches!(receiver.data, Data::Cursor(_)) =>
        {
            let Data::Cursor(cursor) = &receiver.data else { return None };
            let row = || cursor.rows.get(cursor.moves.load(Ordering::Acquire).wrapping_sub(1));
            let cell = |column: i32| row().and_then(|row| row.get(usize::try_from(column).ok()?));
            match member.name.as_str() {
                "getColumnIndex" => {
                    let wanted = text(0)?;
                    let index = cursor.columns.iter().position(|name| *name == wanted);
                    Value::Int(index.map_or(-1, |index| index as i32))
                }
                "moveToNext" => {
                    Value::Boolean(cursor.moves.fetch_add(1, Ordering::AcqRel) < cursor.rows.len())
                }
                "getString" => Value::Object(cell(int(0)).map(|text| Object::string(text))),
                _ => Value::Void,
            }
        }
        "getSystemService" => system_service(&text(0)?),
        "registerReceiver" => Value::Object(battery_intent(host)),
        "getIntProperty" if class == "android/os/BatteryManager" => {
            Value::Int(battery_property(host, int(0)))
        }

        "getIntent" => {
            let scenario =
                host.device.game_loop.iter().map(|game| ("scenario".into(), Value::Int(game.scenario)));
            let shared = lock(&host.shared[1]).clone().filter(|shared| !shared.view).unwrap_or_default();
            let shared_text = shared.text.map(|text| Object::string(&text));
            let stream = shared.file.map(|file| uri(&file.display().to_string()));
            let shared =
                [("TEXT", shared_text), ("STREAM", stream)].into_iter().filter_map(|(key, value)| {
                    Some((format!("android.intent.extra.{key}"), Value::object(value?)))
                });
            let extras = host
                .device
                .extras
                .iter()
                .map(|(key, value)| (key.clone(), Value::object(Object::string(value))))
                .chain(scenario)
                .chain(shared)
                .collect();
            Value::object(Object::new("android/content/Intent", Data::Extras(extras)))
        }
        "getFlags" if class == "android/content/Intent" => Value::Int(0),
        "getAction" if class == "android/content/Intent" => {
            Value::object(Object::string(match (&host.device.game_loop, &*lock(&host.shared[1])) {
                (Some(_), _) => "com.google.intent.action.TEST_LOOP",
                (None, Some(shared)) if shared.view => "android.intent.action.VIEW",
                (None, Some(_)) => "android.intent.action.SEND",
                (None, None) => "android.intent.action.MAIN",
            }))
        }
        "getData" if class == "android/content/Intent" => {
            let results = host.device.game_loop.as_ref().and_then(|game| game.results.as_ref());
            let shared = lock(&host.shared[1]).clone().filter(|shared| shared.view).unwrap_or_default();
            let file = results.or(shared.file.as_ref()).map(|path| path.display().to_string());
            Value::Object(file.or(shared.text).map(|address| uri(&address)))
        }
        "openFileDescriptor" => {
            let path = text(0)?;
            let file = if text(1).as_deref() == Some("w") {
                let mut file = std::fs::File::create(path).ok()?;
                file.write_all(b"--------- simulated Android host\n").ok()?;
                Some(file)
            } else {
                let after = lock(&host.shared[1]).as_ref().map_or(0.0, |shared| shared.after);
                crate::bionic::sleep(after);
                std::fs::File::open(path).ok()
            };
            let descriptor =
                |file| Object::new("android/os/ParcelFileDescriptor", Data::File(Some(file).into()));
            Value::Object(file.map(descriptor))
        }
        "detachFd" => match &receiver.data {
            Data::File(file) => Value::Int(lock(file).take()?.into_raw_fd()),
            _ => return None,
        },
        "getExtras" => {
            let extras = extras().filter(|extras| !extras.is_empty());
            Value::Object(extras.map(|extras| Object::new("android/os/Bundle", Data::Extras(extras.clone()))))
        }
        "keySet" => list("java/util/Set", extras()?.keys()),
        "iterator" => Value::object(Object::new("java/util/Iterator", Data::Array(items()?.clone().into()))),
        "hasNext" => Value::Boolean(!items()?.is_empty()),
        "next" => Value::Object(items()?.pop().flatten()),
        "getIntExtra" => {
            let default = arguments.get(1).cloned().unwrap_or(Value::Int(0));
            let name = text(0)?;
            match extras().and_then(|extras| extras.get(&name)) {
                Some(value) if std::mem::discriminant(value) == std::mem::discriminant(&default) => {
                    value.clone()
                }
                _ => default,
            }
        }
        "getCharSequenceExtra" | "getParcelableExtra" | "get" if matches!(receiver.data, Data::Extras(_)) => {
            match extras()?.get(&text(0)?) {
                Some(value @ Value::Object(_)) => value.clone(),
                _ => Value::Object(None),
            }
        }

        // The display's size in its upright orientation: the window's, with width and height swapped.
        "getPhysicalWidth" => Value::Int(host.device.mode.map_or(host.window.size().1, |mode| mode[1])),
        "getPhysicalHeight" => Value::Int(host.device.mode.map_or(host.window.size().0, |mode| mode[0])),
        "getRefreshRate" => Value::Float(REFRESH_HZ as f32),
        "getRotation" => Value::Int(1),
        // This fills in a DisplayMetrics, whose fields are handled below.
        "getRealMetrics" => Value::Void,
        _ => return None,
    })
}

/// Returns the value of a field, or `None` if the field is not known.
pub fn field(member: &Member) -> Option<Value> {
    let host = host();
    let (width, height) = host.window.size();
    Some(match (member.class.as_str(), member.name.as_str()) {
        ("android/util/DisplayMetrics", "xdpi" | "ydpi") => Value::Float(DPI),
        ("android/util/DisplayMetrics", "widthPixels") => Value::Int(width),
        ("android/util/DisplayMetrics", "heightPixels") => Value::Int(height),
        _ => return None,
    })
}

/// Sets a field.
pub fn set_field(member: &Member, value: f32) {
    if member.name == "screenBrightness" {
        host().request(format!("brightness {value}"));
    }
}

fn uri(address: &str) -> Arc<Object> {
    Object::new("android/net/Uri", Data::Text(address.to_owned()))
}

/// Returns a collection of strings in reverse order, since iterators take from the end.
fn list<'a>(class: &str, items: impl DoubleEndedIterator<Item = &'a String>) -> Value {
    let items: Vec<_> = items.rev().map(|item| Some(Object::string(item))).collect();
    Value::object(Object::new(class, Data::Array(items.into())))
}

/// Returns the items of an array or iterator.
fn items_of(object: &Object) -> Option<MutexGuard<'_, Vec<Option<Arc<Object>>>>> {
    match &object.data {
        Data::Array(items) => Some(lock(items)),
        _ => None,
    }
}

fn system_service(name: &str) -> Value {
    let class = match name {
        "batterymanager" => "android/os/BatteryManager",
        "power" => "android/os/PowerManager",
        _ => return Value::Object(None),
    };
    Value::object(Object::new(class, Data::None))
}

/// Returns the sticky intent `ACTION_BATTERY_CHANGED`, or `None` for a device without a battery.
fn battery_intent(host: &Host) -> Option<Arc<Object>> {
    let Battery { level, millivolts, decidegrees, plugged, status, .. } = lock(&host.battery).clone()?;
    let extras: BTreeMap<String, Value> = [
        ("level", level),
        ("scale", 100),
        ("voltage", millivolts),
        ("temperature", decidegrees),
        ("plugged", plugged),
        ("status", status),
    ]
    .map(|(key, value)| (key.to_owned(), Value::Int(value)))
    .into_iter()
    .chain([("present".to_owned(), Value::Boolean(true))])
    .collect();
    Some(Object::new("android/content/Intent", Data::Extras(extras)))
}

fn battery_property(host: &Host, property: i32) -> i32 {
    let battery = lock(&host.battery);
    let Some(battery) = battery.as_ref() else { return UNSUPPORTED };
    match property {
        1 => battery.charge_counter.unwrap_or(UNSUPPORTED),
        2 => battery.current_now.unwrap_or(UNSUPPORTED),
        4 => battery.level,
        6 => battery.status,
        _ => UNSUPPORTED,
    }
}
