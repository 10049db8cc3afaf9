//! The functions of JNI themselves.

#![allow(non_snake_case)]

use std::cell::{Cell, RefCell};
use std::collections::HashMap;
use std::ffi::{CString, c_char, c_void};
use std::sync::{Arc, Mutex, OnceLock};

use super::objects::Kind;
use super::{Argument, Data, Member, Object, Value, answers};
use crate::bionic::{text, thread_name};
use crate::host::{fatal, host, lock};
use crate::thunk;

/// Functions of JNI in the order of their table.
const SLOTS: [&str; 236] = [
    "reserved0",
    "reserved1",
    "reserved2",
    "reserved3",
    "GetVersion",
    "DefineClass",
    "FindClass",
    "FromReflectedMethod",
    "FromReflectedField",
    "ToReflectedMethod",
    "GetSuperclass",
    "IsAssignableFrom",
    "ToReflectedField",
    "Throw",
    "ThrowNew",
    "ExceptionOccurred",
    "ExceptionDescribe",
    "ExceptionClear",
    "FatalError",
    "PushLocalFrame",
    "PopLocalFrame",
    "NewGlobalRef",
    "DeleteGlobalRef",
    "DeleteLocalRef",
    "IsSameObject",
    "NewLocalRef",
    "EnsureLocalCapacity",
    "AllocObject",
    "NewObject",
    "NewObjectV",
    "NewObjectA",
    "GetObjectClass",
    "IsInstanceOf",
    "GetMethodID",
    "CallObjectMethod",
    "CallObjectMethodV",
    "CallObjectMethodA",
    "CallBooleanMethod",
    "CallBooleanMethodV",
    "CallBooleanMethodA",
    "CallByteMethod",
    "CallByteMethodV",
    "CallByteMethodA",
    "CallCharMethod",
    "CallCharMethodV",
    "CallCharMethodA",
    "CallShortMethod",
    "CallShortMethodV",
    "CallShortMethodA",
    "CallIntMethod",
    "CallIntMethodV",
    "CallIntMethodA",
    "CallLongMethod",
    "CallLongMethodV",
    "CallLongMethodA",
    "CallFloatMethod",
    "CallFloatMethodV",
    "CallFloatMethodA",
    "CallDoubleMethod",
    "CallDoubleMethodV",
    "CallDoubleMethodA",
    "CallVoidMethod",
    "CallVoidMethodV",
    "CallVoidMethodA",
    "CallNonvirtualObjectMethod",
    "CallNonvirtualObjectMethodV",
    "CallNonvirtualObjectMethodA",
    "CallNonvirtualBooleanMethod",
    "CallNonvirtualBooleanMethodV",
    "CallNonvirtualBooleanMethodA",
    "CallNonvirtualByteMethod",
    "CallNonvirtualByteMethodV",
    "CallNonvirtualByteMethodA",
    "CallNonvirtualCharMethod",
    "CallNonvirtualCharMethodV",
    "CallNonvirtualCharMethodA",
    "CallNonvirtualShortMethod",
    "CallNonvirtualShortMethodV",
    "CallNonvirtualShortMethodA",
    "CallNonvirtualIntMethod",
    "CallNonvirtualIntMethodV",
    "CallNonvirtualIntMethodA",
    "CallNonvirtualLongMethod",
    "CallNonvirtualLongMethodV",
    "CallNonvirtualLongMethodA",
    "CallNonvirtualFloatMethod",
    "CallNonvirtualFloatMethodV",
    "CallNonvirtualFloatMethodA",
    "CallNonvirtualDoubleMethod",
    "CallNonvirtualDoubleMethodV",
    "CallNonvirtualDoubleMethodA",
    "CallNonvirtualVoidMethod",
    "CallNonvirtualVoidMethodV",
    "CallNonvirtualVoidMethodA",
    "GetFieldID",
    "GetObjectField",
    "GetBooleanField",
    "GetByteField",
    "GetCharField",
    "GetShortField",
    "GetIntField",
    "GetLongField",
    "GetFloatField",
    "GetDoubleField",
    "SetObjectField",
    "SetBooleanField",
    "SetByteField",
    "SetCharField",
    "SetShortField",
    "SetIntField",
    "SetLongField",
    "SetFloatField",
    "SetDoubleField",
    "GetStaticMethodID",
    "CallStaticObjectMethod",
    "CallStaticObjectMethodV",
    "CallStaticObjectMethodA",
    "CallStaticBooleanMethod",
    "CallStaticBooleanMethodV",
    "CallStaticBooleanMethodA",
    "CallStaticByteMethod",
    "CallStaticByteMethodV",
    "CallStaticByteMethodA",
    "CallStaticCharMethod",
    "CallStaticCharMethodV",
    "CallStaticCharMethodA",
    "CallStaticShortMethod",
    "CallStaticShortMethodV",
    "CallStaticShortMethodA",
    "CallStaticIntMethod",
    "CallStaticIntMethodV",
    "CallStaticIntMethodA",
    "CallStaticLongMethod",
    "CallStaticLongMethodV",
    "CallStaticLongMethodA",
    "CallStaticFloatMethod",
    "CallStaticFloatMethodV",
    "CallStaticFloatMethodA",
    "CallStaticDoubleMethod",
    "CallStaticDoubleMethodV",
    "CallStaticDoubleMethodA",
    "CallStaticVoidMethod",
    "CallStaticVoidMethodV",
    "CallStaticVoidMethodA",
    "GetStaticFieldID",
    "GetStaticObjectField",
    "GetStaticBooleanField",
    "GetStaticByteField",
    "GetStaticCharField",
    "GetStaticShortField",
    "GetStaticIntField",
    "GetStaticLongField",
    "GetStaticFloatField",
    "GetStaticDoubleField",
    "SetStaticObjectField",
    "SetStaticBooleanField",
    "SetStaticByteField",
    "SetStaticCharField",
    "SetStaticShortField",
    "SetStaticIntField",
    "SetStaticLongField",
    "SetStaticFloatField",
    "SetStaticDoubleField",
    "NewString",
    "GetStringLength",
    "GetStringChars",
    "ReleaseStringChars",
    "NewStringUTF",
    "GetStringUTFLength",
    "GetStringUTFChars",
    "ReleaseStringUTFChars",
    "GetArrayLength",
    "NewObjectArray",
    "GetObjectArrayElement",
    "SetObjectArrayElement",
    "NewBooleanArray",
    "NewByteArray",
    "NewCharArray",
    "NewShortArray",
    "NewIntArray",
    "NewLongArray",
    "NewFloatArray",
    "NewDoubleArray",
    "GetBooleanArrayElements",
    "GetByteArrayElements",
    "GetCharArrayElements",
    "GetShortArrayElements",
    "GetIntArrayElements",
    "GetLongArrayElements",
    "GetFloatArrayElements",
    "GetDoubleArrayElements",
    "ReleaseBooleanArrayElements",
    "ReleaseByteArrayElements",
    "ReleaseCharArrayElements",
    "ReleaseShortArrayElements",
    "ReleaseIntArrayElements",
    "ReleaseLongArrayElements",
    "ReleaseFloatArrayElements",
    "ReleaseDoubleArrayElements",
    "GetBooleanArrayRegion",
    "GetByteArrayRegion",
    "GetCharArrayRegion",
    "GetShortArrayRegion",
    "GetIntArrayRegion",
    "GetLongArrayRegion",
    "GetFloatArrayRegion",
    "GetDoubleArrayRegion",
    "SetBooleanArrayRegion",
    "SetByteArrayRegion",
    "SetCharArrayRegion",
    "SetShortArrayRegion",
    "SetIntArrayRegion",
    "SetLongArrayRegion",
    "SetFloatArrayRegion",
    "SetDoubleArrayRegion",
    "RegisterNatives",
    "UnregisterNatives",
    "MonitorEnter",
    "MonitorExit",
    "GetJavaVM",
    "GetStringRegion",
    "GetStringUTFRegion",
    "GetPrimitiveArrayCritical",
    "ReleasePrimitiveArrayCritical",
    "GetStringCritical",
    "ReleaseStringCritical",
    "NewWeakGlobalRef",
    "DeleteWeakGlobalRef",
    "ExceptionCheck",
    "NewDirectByteBuffer",
    "GetDirectBufferAddress",
    "GetDirectBufferCapacity",
    "GetObjectRefType",
    "GetModule",
    "IsVirtualThread",
    "GetStringUTFLengthAsLong",
];

const OK: i32 = 0;
const DETACHED: i32 = -2;
const VERSION: i32 = 0x0001_0006;

/// `JNIEnv*` points to a pointer to the table; one serves all threads.
static ENVIRONMENT: OnceLock<Box<usize>> = OnceLock::new();
static MACHINE: OnceLock<Box<usize>> = OnceLock::new();

thread_local! {
    /// Local references by frame, when the thread is attached. It has no destructor: the application's own thread-local
    /// values go later than the host's and may still call JNI.
    static FRAMES: Cell<Option<&'static RefCell<Vec<Vec<usize>>>>> = const { Cell::new(None) };
}

/// The local references of the calling thread.
fn frames() -> &'static RefCell<Vec<Vec<usize>>> {
    FRAMES.get().unwrap_or_else(|| {
        fatal(format!("JNI was called on the thread {}, which is not attached", thread_name()))
    })
}

fn attach() {
    if FRAMES.get().is_none() {
        FRAMES.set(Some(Box::leak(Box::new(RefCell::new(vec![Vec::new()])))));
    }
}

/// Buffers of `GetStringUTFChars` and `GetStringChars` by address.
static CHARACTERS: Mutex<Option<HashMap<usize, Box<[u8]>>>> = Mutex::new(None);

type Handle = usize;

/// Attaches the main thread, as the system does before it creates an activity.
pub fn attach_main_thread() {
    attach();
}

/// A global reference to a new activity.
pub fn activity_reference() -> *const c_void {
    host().jni.add(Object::new("android/app/NativeActivity", Data::None), Kind::Global) as *const c_void
}

/// The end of what [`activity_reference`] gave.
pub fn release_activity(activity: *const c_void) {
    host().jni.remove(activity as Handle, Kind::Global);
}

/// `JNIEnv*`.
pub fn environment() -> *const c_void {
    let pointer = ENVIRONMENT.get_or_init(|| {
        let names: Vec<_> = SLOTS.iter().map(|name| format!("the JNI function {name}")).collect();
        let mut table = thunk::traps(&names).unwrap_or_else(|error| fatal(format!("JNI: {error:#}")));
        for (name, address) in functions() {
            let slot = SLOTS
                .iter()
                .position(|slot| *slot == name)
                .unwrap_or_else(|| fatal(format!("JNI has no function {name}")));
            table[slot] = address;
        }
        Box::new(table.leak().as_ptr() as usize)
    });
    std::ptr::from_ref::<usize>(pointer).cast()
}

/// `JavaVM*`.
pub fn virtual_machine() -> *const c_void {
    let pointer = MACHINE.get_or_init(|| {
        let names: Vec<_> = ["reserved0", "reserved1", "reserved2", "DestroyJavaVM", "", "", "", ""]
            .iter()
            .map(|name| format!("the JNI function {name}"))
            .collect();
        let mut table = thunk::traps(&names).unwrap_or_else(|error| fatal(format!("JNI: {error:#}")));
        table[4] = AttachCurrentThread as *const () as usize;
        table[5] = DetachCurrentThread as *const () as usize;
        table[6] = GetEnv as *const () as usize;
        table[7] = AttachCurrentThread as *const () as usize;
        Box::new(table.leak().as_ptr() as usize)
    });
    std::ptr::from_ref::<usize>(pointer).cast()
}

unsafe extern "C" fn GetEnv(_machine: *const c_void, out: *mut *const c_void, _version: i32) -> i32 {
    let attached = FRAMES.get().is_some();
    // SAFETY: the caller gives room for one pointer.
    unsafe { out.write(if attached { environment() } else { std::ptr::null() }) };
    if attached { OK } else { DETACHED }
}

unsafe extern "C" fn AttachCurrentThread(
    _machine: *const c_void,
    out: *mut *const c_void,
    _arguments: *const c_void,
) -> i32 {
    attach();
    // SAFETY: the caller gives room for one pointer.
    unsafe { out.write(environment()) };
    OK
}

extern "C" fn DetachCurrentThread(_machine: *const c_void) -> i32 {
    let Some(frames) = FRAMES.take() else { return -1 };
    for handle in frames.take().into_iter().flatten() {
        host().jni.remove(handle, Kind::Local);
    }
    OK
}

fn local(object: Option<Arc<Object>>) -> Handle {
    let Some(object) = object else { return 0 };
    let handle = host().jni.add(object, Kind::Local);
    if let Some(frame) = frames().borrow_mut().last_mut() {
        frame.push(handle);
    }
    handle
}

fn get(handle: Handle, function: &str) -> Arc<Object> {
    host().jni.get(handle).unwrap_or_else(|| fatal(format!("JNI: {function} was called with null")))
}

type Env = *const c_void;

/// Every function that is answered, by name.
fn functions() -> Vec<(&'static str, usize)> {
    macro_rules! list {
        ($($function:ident),* $(,)?) => { vec![$((stringify!($function), $function as *const () as usize)),*] };
    }
    let mut all = list![
        GetVersion,
        FindClass,
        GetSuperclass,
        IsAssignableFrom,
        ExceptionOccurred,
        ExceptionDescribe,
        ExceptionClear,
        FatalError,
        PushLocalFrame,
        PopLocalFrame,
        NewGlobalRef,
        DeleteGlobalRef,
        DeleteLocalRef,
        IsSameObject,
        NewLocalRef,
        EnsureLocalCapacity,
        NewObjectA,
        GetObjectClass,
        IsInstanceOf,
        GetMethodID,
        CallObjectMethodA,
        CallBooleanMethodA,
        CallIntMethodA,
        CallLongMethodA,
        CallFloatMethodA,
        CallDoubleMethodA,
        CallVoidMethodA,
        GetObjectField,
        GetBooleanField,
        GetIntField,
        GetLongField,
        GetFloatField,
        GetDoubleField,
        NewString,
        GetStringLength,
        GetStringChars,
        ReleaseStringChars,
        GetStringRegion,
        NewStringUTF,
        GetStringUTFLength,
        GetStringUTFChars,
        ReleaseStringUTFChars,
        GetStringUTFRegion,
        GetArrayLength,
        NewObjectArray,
        GetObjectArrayElement,
        SetObjectArrayElement,
        MonitorEnter,
        MonitorExit,
        GetJavaVM,
        NewWeakGlobalRef,
        DeleteWeakGlobalRef,
        ExceptionCheck,
        GetObjectRefType,
    ];
    // A member is a class, a name and a signature, whatever kind it is. A static call has a class in the place of the object;
    // otherwise they are alike.
    all.extend([
        ("GetStaticMethodID", GetMethodID as *const () as usize),
        ("GetFieldID", GetMethodID as *const () as usize),
        ("GetStaticFieldID", GetMethodID as *const () as usize),
        ("CallStaticObjectMethodA", CallObjectMethodA as *const () as usize),
        ("CallStaticBooleanMethodA", CallBooleanMethodA as *const () as usize),
        ("CallStaticIntMethodA", CallIntMethodA as *const () as usize),
        ("CallStaticLongMethodA", CallLongMethodA as *const () as usize),
        ("CallStaticFloatMethodA", CallFloatMethodA as *const () as usize),
        ("CallStaticDoubleMethodA", CallDoubleMethodA as *const () as usize),
        ("CallStaticVoidMethodA", CallVoidMethodA as *const () as usize),
        ("GetStaticObjectField", GetObjectField as *const () as usize),
        ("GetStaticBooleanField", GetBooleanField as *const () as usize),
        ("GetStaticIntField", GetIntField as *const () as usize),
        ("GetStaticLongField", GetLongField as *const () as usize),
        ("GetStaticFloatField", GetFloatField as *const () as usize),
        ("GetStaticDoubleField", GetDoubleField as *const () as usize),
    ]);
    all
}

extern "C" fn GetVersion(_env: Env) -> i32 {
    VERSION
}

unsafe extern "C" fn FindClass(_env: Env, name: *const c_char) -> Handle {
    // SAFETY: a terminated name by contract.
    local(Some(Object::class_of(&unsafe { text(name) })))
}

extern "C" fn GetSuperclass(_env: Env, class: Handle) -> Handle {
    match &get(class, "GetSuperclass").data {
        Data::Class(name) if name != "java/lang/Object" => local(Some(Object::class_of("java/lang/Object"))),
        _ => 0,
    }
}

/// Class relations are not known here: android-activity and jni only check what is true on a device.
extern "C" fn IsAssignableFrom(_env: Env, one: Handle, other: Handle) -> u8 {
    get(one, "IsAssignableFrom");
    get(other, "IsAssignableFrom");
    1
}

extern "C" fn IsInstanceOf(_env: Env, _object: Handle, class: Handle) -> u8 {
    get(class, "IsInstanceOf");
    1
}

/// No call throws here.
extern "C" fn ExceptionOccurred(_env: Env) -> Handle {
    0
}

extern "C" fn ExceptionCheck(_env: Env) -> u8 {
    0
}

extern "C" fn ExceptionDescribe(_env: Env) {}

extern "C" fn ExceptionClear(_env: Env) {}

unsafe extern "C" fn FatalError(_env: Env, message: *const c_char) -> ! {
    // SAFETY: a terminated message by contract.
    fatal(format!("JNI FatalError: {}", unsafe { text(message) }))
}

extern "C" fn PushLocalFrame(_env: Env, _capacity: i32) -> i32 {
    frames().borrow_mut().push(Vec::new());
    OK
}

extern "C" fn PopLocalFrame(_env: Env, result: Handle) -> Handle {
    let kept = host().jni.get(result);
    let frame = {
        let mut frames = frames().borrow_mut();
        if frames.len() < 2 {
            fatal("JNI PopLocalFrame without PushLocalFrame");
        }
        frames.pop().unwrap_or_default()
    };
    for handle in frame {
        host().jni.remove(handle, Kind::Local);
    }
    local(kept)
}

extern "C" fn EnsureLocalCapacity(_env: Env, _capacity: i32) -> i32 {
    OK
}

extern "C" fn NewLocalRef(_env: Env, handle: Handle) -> Handle {
    local(host().jni.get(handle))
}

extern "C" fn NewGlobalRef(_env: Env, handle: Handle) -> Handle {
    host().jni.get(handle).map_or(0, |object| host().jni.add(object, Kind::Global))
}

extern "C" fn NewWeakGlobalRef(_env: Env, handle: Handle) -> Handle {
    host().jni.get(handle).map_or(0, |object| host().jni.add(object, Kind::Weak))
}

extern "C" fn DeleteGlobalRef(_env: Env, handle: Handle) {
    host().jni.remove(handle, Kind::Global);
}

extern "C" fn DeleteWeakGlobalRef(_env: Env, handle: Handle) {
    host().jni.remove(handle, Kind::Weak);
}

extern "C" fn DeleteLocalRef(_env: Env, handle: Handle) {
    if handle == 0 {
        return;
    }
    for frame in frames().borrow_mut().iter_mut() {
        frame.retain(|known| *known != handle);
    }
    host().jni.remove(handle, Kind::Local);
}

extern "C" fn IsSameObject(_env: Env, one: Handle, other: Handle) -> u8 {
    u8::from(match (host().jni.get(one), host().jni.get(other)) {
        (Some(one), Some(other)) => {
            Arc::ptr_eq(&one, &other)
                || matches!((&one.data, &other.data), (Data::Class(one), Data::Class(other)) if one == other)
        }
        (None, None) => true,
        _ => false,
    })
}

extern "C" fn GetObjectRefType(_env: Env, handle: Handle) -> i32 {
    match host().jni.kind(handle) {
        None => 0,
        Some(Kind::Local) => 1,
        Some(Kind::Global) => 2,
        Some(Kind::Weak) => 3,
    }
}

extern "C" fn GetObjectClass(_env: Env, handle: Handle) -> Handle {
    local(Some(Object::class_of(&get(handle, "GetObjectClass").class)))
}

unsafe extern "C" fn GetMethodID(
    _env: Env,
    class: Handle,
    name: *const c_char,
    signature: *const c_char,
) -> *const Member {
    let class = match &get(class, "the look-up of a method or a field").data {
        Data::Class(name) => name.clone(),
        _ => fatal("JNI: a method or a field of something that is no class"),
    };
    // SAFETY: terminated strings by contract.
    let (name, signature) = unsafe { (text(name), text(signature)) };
    host().jni.member(Member { class, name, signature })
}

/// The arguments of a call, by the method's signature.
///
/// # Safety
/// `values` holds a `jvalue` for each parameter.
unsafe fn arguments(signature: &str, values: *const u64) -> Vec<Argument> {
    let parameters = signature.trim_start_matches('(').split(')').next().unwrap_or("");
    let mut result = Vec::new();
    let mut rest = parameters.chars().peekable();
    while let Some(kind) = rest.next() {
        // SAFETY: the caller's promise.
        let bits = unsafe { values.add(result.len()).read_unaligned() };
        result.push(match kind {
            'Z' => Value::Boolean(bits as u8 != 0),
            'B' => Value::Int(i32::from(bits as i8)),
            'C' => Value::Int(i32::from(bits as u16)),
            'S' => Value::Int(i32::from(bits as i16)),
            'I' => Value::Int(bits as i32),
            'J' => Value::Long(bits as i64),
            'F' => Value::Float(f32::from_bits(bits as u32)),
            'D' => Value::Double(f64::from_bits(bits)),
            'L' | '[' => {
                let mut name = kind;
                while name == '[' {
                    name = rest.next().unwrap_or(';');
                }
                if name == 'L' {
                    rest.by_ref().find(|character| *character == ';');
                }
                Value::Object(host().jni.get(bits as usize))
            }
            other => fatal(format!("JNI: the signature {signature} has a parameter {other:?}")),
        });
    }
    result
}

/// A new object of the type at the end of a signature, or zero, for calls that nobody knows.
fn invent(member: &Member) -> Value {
    host().jni.note_invented(member);
    let returned = member.signature.rsplit(')').next().unwrap_or("V");
    match returned.chars().next() {
        Some('V') => Value::Void,
        Some('Z') => Value::Boolean(false),
        Some('J') => Value::Long(0),
        Some('F') => Value::Float(0.0),
        Some('D') => Value::Double(0.0),
        Some('L') => {
            let class = returned.trim_start_matches('L').trim_end_matches(';');
            Value::object(match class {
                "java/lang/String" => Object::string(""),
                "java/lang/Class" => Object::class_of("java/lang/Object"),
                _ => Object::new(class, Data::None),
            })
        }
        Some('[') => Value::object(Object::new(returned, Data::Array(Mutex::default()))),
        _ => Value::Int(0),
    }
}

/// # Safety
/// A method that came from `GetMethodID`, and a `jvalue` for each of its parameters.
unsafe fn call(receiver: Handle, method: *const Member, values: *const u64) -> Value {
    // SAFETY: members are never freed.
    let method = unsafe { &*method };
    let receiver = get(receiver, &method.name);
    // SAFETY: the caller's promise.
    let arguments = unsafe { arguments(&method.signature, values) };
    let answer = answers::call(&receiver, method, &arguments).unwrap_or_else(|| invent(method));
    checked(answer, method)
}

/// Refuses answers of another type than the signature promises: a mistake in the host.
fn checked(value: Value, member: &Member) -> Value {
    let promised = member.signature.rsplit(')').next().and_then(|kind| kind.chars().next()).unwrap_or('V');
    let fits = match value {
        Value::Void => promised == 'V',
        Value::Boolean(_) => promised == 'Z',
        Value::Int(_) => matches!(promised, 'B' | 'C' | 'S' | 'I'),
        Value::Long(_) => promised == 'J',
        Value::Float(_) => promised == 'F',
        Value::Double(_) => promised == 'D',
        Value::Object(_) => matches!(promised, 'L' | '['),
    };
    if fits {
        value
    } else {
        fatal(format!("the host answers {}.{}{} by {value:?}", member.class, member.name, member.signature))
    }
}

unsafe extern "C" fn NewObjectA(
    _env: Env,
    class: Handle,
    method: *const Member,
    _values: *const u64,
) -> Handle {
    // SAFETY: members are never freed.
    let method = unsafe { &*method };
    match &get(class, "NewObject").data {
        Data::Class(name) if method.name == "<init>" => local(Some(Object::new(name, Data::None))),
        _ => fatal("JNI: NewObject without a class or a constructor"),
    }
}

/// Functions that call a method and give one type; a value of another was refused before.
macro_rules! calls {
    ($($function:ident: $pattern:pat => $value:expr, $type:ty;)*) => {
        $(unsafe extern "C" fn $function(_env: Env, receiver: Handle, method: *const Member, values: *const u64) -> $type {
            // SAFETY: same contract as the caller's.
            match unsafe { call(receiver, method, values) } {
                $pattern => $value,
                other => fatal(format!(concat!("JNI: ", stringify!($function), " of a method that gives {:?}"), other)),
            }
        })*
    };
}

calls! {
    CallObjectMethodA: Value::Object(object) => local(object), Handle;
    CallBooleanMethodA: Value::Boolean(value) => u8::from(value), u8;
    CallIntMethodA: Value::Int(value) => value, i32;
    CallLongMethodA: Value::Long(value) => value, i64;
    CallFloatMethodA: Value::Float(value) => value, f32;
    CallDoubleMethodA: Value::Double(value) => value, f64;
    CallVoidMethodA: Value::Void => (), ();
}

/// As `calls`, for fields.
macro_rules! fields {
    ($($function:ident: $pattern:pat => $value:expr, $type:ty;)*) => {
        $(unsafe extern "C" fn $function(_env: Env, receiver: Handle, field: *const Member) -> $type {
            get(receiver, stringify!($function));
            // SAFETY: members are never freed.
            let field = unsafe { &*field };
            match checked(answers::field(field).unwrap_or_else(|| invent(field)), field) {
                $pattern => $value,
                other => fatal(format!(concat!("JNI: ", stringify!($function), " of a field that holds {:?}"), other)),
            }
        })*
    };
}

fields! {
    GetObjectField: Value::Object(object) => local(object), Handle;
    GetBooleanField: Value::Boolean(value) => u8::from(value), u8;
    GetIntField: Value::Int(value) => value, i32;
    GetLongField: Value::Long(value) => value, i64;
    GetFloatField: Value::Float(value) => value, f32;
    GetDoubleField: Value::Double(value) => value, f64;
}

// Strings. JNI's "modified UTF-8" equals UTF-8 but for NUL and characters beyond the basic plane, which do not occur here.

fn string(handle: Handle) -> String {
    get(handle, "a string function").text().unwrap_or_default().to_owned()
}

fn utf16(handle: Handle) -> Vec<u16> {
    string(handle).encode_utf16().collect()
}

/// Keeps a copy for the application until it releases it.
fn lend(bytes: Vec<u8>) -> usize {
    let bytes = bytes.into_boxed_slice();
    let address = bytes.as_ptr() as usize;
    lock(&CHARACTERS).get_or_insert_default().insert(address, bytes);
    host().count("JNI string buffers", 1);
    address
}

fn take_back(address: usize) {
    if lock(&CHARACTERS).get_or_insert_default().remove(&address).is_none() {
        fatal("JNI: characters were released that were never lent");
    }
    host().count("JNI string buffers", -1);
}

unsafe extern "C" fn NewStringUTF(_env: Env, characters: *const c_char) -> Handle {
    // SAFETY: a terminated string by contract.
    local(Some(Object::string(&unsafe { text(characters) })))
}

unsafe extern "C" fn NewString(_env: Env, characters: *const u16, length: i32) -> Handle {
    // SAFETY: `length` characters by contract.
    let characters = unsafe { std::slice::from_raw_parts(characters, length.max(0) as usize) };
    local(Some(Object::string(&String::from_utf16_lossy(characters))))
}

extern "C" fn GetStringUTFLength(_env: Env, handle: Handle) -> i32 {
    string(handle).len() as i32
}

extern "C" fn GetStringLength(_env: Env, handle: Handle) -> i32 {
    utf16(handle).len() as i32
}

unsafe extern "C" fn GetStringUTFChars(_env: Env, handle: Handle, copied: *mut u8) -> usize {
    if !copied.is_null() {
        // SAFETY: not null, so the caller gives room for one jboolean.
        unsafe { copied.write(1) };
    }
    lend(CString::new(string(handle)).unwrap_or_default().into_bytes_with_nul())
}

unsafe extern "C" fn GetStringChars(_env: Env, handle: Handle, copied: *mut u8) -> usize {
    if !copied.is_null() {
        // SAFETY: not null, so the caller gives room for one jboolean.
        unsafe { copied.write(1) };
    }
    lend(utf16(handle).into_iter().chain([0]).flat_map(u16::to_ne_bytes).collect())
}

extern "C" fn ReleaseStringUTFChars(_env: Env, _handle: Handle, characters: usize) {
    take_back(characters);
}

extern "C" fn ReleaseStringChars(_env: Env, _handle: Handle, characters: usize) {
    take_back(characters);
}

unsafe extern "C" fn GetStringRegion(_env: Env, handle: Handle, start: i32, length: i32, out: *mut u16) {
    let characters = utf16(handle);
    let Some(region) = characters.get(start as usize..(start + length) as usize) else {
        fatal("JNI: GetStringRegion beyond the string")
    };
    // SAFETY: the caller gives room for `length` characters.
    unsafe { std::ptr::copy_nonoverlapping(region.as_ptr(), out, region.len()) };
}

unsafe extern "C" fn GetStringUTFRegion(_env: Env, handle: Handle, start: i32, length: i32, out: *mut u8) {
    let characters = utf16(handle);
    let Some(region) = characters.get(start as usize..(start + length) as usize) else {
        fatal("JNI: GetStringUTFRegion beyond the string")
    };
    let region = String::from_utf16_lossy(region);
    // SAFETY: the caller gives room for the region in UTF-8 and a NUL.
    unsafe {
        std::ptr::copy_nonoverlapping(region.as_ptr(), out, region.len());
        out.add(region.len()).write(0);
    }
}

extern "C" fn GetArrayLength(_env: Env, handle: Handle) -> i32 {
    match &get(handle, "GetArrayLength").data {
        Data::Array(items) => lock(items).len() as i32,
        _ => fatal("JNI: GetArrayLength of something that is no array"),
    }
}

extern "C" fn GetObjectArrayElement(_env: Env, handle: Handle, index: i32) -> Handle {
    match &get(handle, "GetObjectArrayElement").data {
        Data::Array(items) => local(lock(items).get(index as usize).cloned().flatten()),
        _ => fatal("JNI: GetObjectArrayElement of something that is no array"),
    }
}

extern "C" fn NewObjectArray(_env: Env, length: i32, class: Handle, first: Handle) -> Handle {
    let class = match &get(class, "NewObjectArray").data {
        Data::Class(name) => format!("[L{name};"),
        _ => fatal("JNI: NewObjectArray of something that is no class"),
    };
    let first = (first != 0).then(|| get(first, "NewObjectArray"));
    let items = vec![first; length.max(0) as usize];
    local(Some(Object::new(&class, Data::Array(items.into()))))
}

extern "C" fn SetObjectArrayElement(_env: Env, handle: Handle, index: i32, value: Handle) {
    let value = (value != 0).then(|| get(value, "SetObjectArrayElement"));
    match &get(handle, "SetObjectArrayElement").data {
        Data::Array(items) => match lock(items).get_mut(index as usize) {
            Some(item) => *item = value,
            None => fatal("JNI: SetObjectArrayElement beyond the array"),
        },
        _ => fatal("JNI: SetObjectArrayElement of something that is no array"),
    }
}

extern "C" fn MonitorEnter(_env: Env, _handle: Handle) -> i32 {
    OK
}

extern "C" fn MonitorExit(_env: Env, _handle: Handle) -> i32 {
    OK
}

unsafe extern "C" fn GetJavaVM(_env: Env, out: *mut *const c_void) -> i32 {
    // SAFETY: the caller gives room for one pointer.
    unsafe { out.write(virtual_machine()) };
    OK
}
