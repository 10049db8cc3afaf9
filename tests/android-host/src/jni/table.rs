//! The functions of JNI, in the tables of jni-sys.

#![allow(non_snake_case)]

use std::cell::{Cell, RefCell};
use std::ffi::{c_char, c_void};
use std::sync::{Arc, Mutex, OnceLock};

use jni_sys::{
    JNI_EDETACHED, JNI_ERR, JNI_OK, JNI_VERSION_1_6, JNIEnv, JNIInvokeInterface_, JNINativeInterface_,
    JavaVM, jboolean, jfieldID, jfloat, jint, jmethodID, jobject, jvalue,
};

use super::objects::Kind;
use super::strings::*;
use super::{Data, Member, Object, Value, answers};
use crate::bionic::{text, thread_name};
use crate::host::{fatal, host};
use crate::thunk;

pub(super) type Env = *mut JNIEnv;

thread_local! {
    /// Local references by frame, if the thread is attached. This has no destructor, since thread-local values of the
    /// application are destroyed later than the host's and may still call JNI.
    static FRAMES: Cell<Option<&'static RefCell<Vec<Vec<usize>>>>> = const { Cell::new(None) };
}

/// Returns the local references of the calling thread.
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

/// Attaches the main thread, as the system does before it creates an activity.
pub fn attach_main_thread() {
    attach();
}

/// Returns a global reference to a new activity.
pub fn activity_reference() -> jobject {
    host().jni.add(Object::new("android/app/NativeActivity", Data::None), Kind::Global)
}

/// Deletes a reference that [`activity_reference`] returned.
pub fn release_activity(activity: jobject) {
    host().jni.remove(activity, Kind::Global);
}

/// Creates a table whose functions all end the run with a message that contains their index, until they are replaced.
fn table<T>(name: &str) -> &'static mut T {
    let count = size_of::<T>() / size_of::<usize>();
    let names: Vec<_> =
        (0..count).map(|index| format!("the function of index {index} of JNI's {name}")).collect();
    let traps = thunk::traps(&names).unwrap_or_else(|error| fatal(format!("JNI: {error:#}")));
    // SAFETY: both tables are unions of structs of function pointers. There are as many traps, which are functions.
    unsafe { &mut *traps.leak().as_mut_ptr().cast::<T>() }
}

/// Returns the JNI environment, which all threads share.
pub fn environment() -> Env {
    static ENVIRONMENT: OnceLock<usize> = OnceLock::new();
    let address = *ENVIRONMENT.get_or_init(|| {
        let table = table::<JNINativeInterface_>("JNIEnv");
        // SAFETY: every field of this version contains a function, as ensured by `table`.
        fill(unsafe { &mut table.v1_6 });
        Box::into_raw(Box::new(std::ptr::from_ref(table))) as usize
    });
    address as Env
}

/// Returns the virtual machine.
pub fn virtual_machine() -> *mut JavaVM {
    static MACHINE: OnceLock<usize> = OnceLock::new();
    let address = *MACHINE.get_or_init(|| {
        let table = table::<JNIInvokeInterface_>("JavaVM");
        // SAFETY: every field of this version contains a function, as ensured by `table`.
        let functions = unsafe { &mut table.v1_4 };
        functions.AttachCurrentThread = AttachCurrentThread;
        functions.AttachCurrentThreadAsDaemon = AttachCurrentThread;
        functions.DetachCurrentThread = DetachCurrentThread;
        functions.GetEnv = GetEnv;
        Box::into_raw(Box::new(std::ptr::from_ref(table))) as usize
    });
    address as *mut JavaVM
}

/// Enters all implemented functions into the table.
fn fill(table: &mut jni_sys::JNINativeInterface__1_6) {
    macro_rules! put {
        ($($function:ident)*) => { $(table.$function = $function;)* };
    }
    put! {
        GetVersion FindClass GetSuperclass IsAssignableFrom ExceptionOccurred ExceptionDescribe
        ExceptionClear ExceptionCheck FatalError PushLocalFrame PopLocalFrame EnsureLocalCapacity NewLocalRef
        NewGlobalRef NewWeakGlobalRef DeleteLocalRef DeleteGlobalRef DeleteWeakGlobalRef IsSameObject
        GetObjectClass IsInstanceOf GetMethodID GetFieldID NewObjectA CallObjectMethodA CallBooleanMethodA
        CallIntMethodA CallFloatMethodA CallVoidMethodA GetObjectField
        GetBooleanField GetIntField GetFloatField SetFloatField NewStringUTF
        GetStringUTFChars ReleaseStringUTFChars GetArrayLength NewObjectArray GetObjectArrayElement
        SetObjectArrayElement MonitorEnter MonitorExit GetJavaVM
    }
    // A static call passes a class in place of the object, and is otherwise the same.
    table.GetStaticMethodID = GetMethodID;
    table.GetStaticFieldID = GetFieldID;
    table.CallStaticObjectMethodA = CallObjectMethodA;
    table.CallStaticBooleanMethodA = CallBooleanMethodA;
    table.CallStaticIntMethodA = CallIntMethodA;
    table.CallStaticFloatMethodA = CallFloatMethodA;
    table.CallStaticVoidMethodA = CallVoidMethodA;
    table.GetStaticObjectField = GetObjectField;
    table.GetStaticBooleanField = GetBooleanField;
    table.GetStaticIntField = GetIntField;
    table.GetStaticFloatField = GetFloatField;
}

unsafe extern "system" fn GetEnv(_machine: *mut JavaVM, out: *mut *mut c_void, _version: jint) -> jint {
    let attached = FRAMES.get().is_some();
    // SAFETY: the caller gives room for one pointer.
    unsafe { out.write(if attached { environment().cast() } else { std::ptr::null_mut() }) };
    if attached { JNI_OK } else { JNI_EDETACHED }
}

unsafe extern "system" fn AttachCurrentThread(
    _machine: *mut JavaVM,
    out: *mut *mut c_void,
    _arguments: *mut c_void,
) -> jint {
    attach();
    // SAFETY: the caller gives room for one pointer.
    unsafe { out.write(environment().cast()) };
    JNI_OK
}

extern "system" fn DetachCurrentThread(_machine: *mut JavaVM) -> jint {
    let Some(frames) = FRAMES.take() else { return JNI_ERR };
    for handle in frames.take().into_iter().flatten() {
        host().jni.remove(handle as jobject, Kind::Local);
    }
    JNI_OK
}

/// Returns a new local reference, or null if there is no object.
pub(super) fn local(object: Option<Arc<Object>>) -> jobject {
    let Some(object) = object else { return std::ptr::null_mut() };
    let handle = host().jni.add(object, Kind::Local);
    if let Some(frame) = frames().borrow_mut().last_mut() {
        frame.push(handle as usize);
    }
    handle
}

/// Returns the object that a reference refers to. Ends the run if it is null, with `function` in the message.
pub(super) fn get(handle: jobject, function: &str) -> Arc<Object> {
    host().jni.get(handle).unwrap_or_else(|| fatal(format!("JNI: {function} was called with null")))
}

extern "system" fn GetVersion(_env: Env) -> jint {
    JNI_VERSION_1_6
}

unsafe extern "system" fn FindClass(_env: Env, name: *const c_char) -> jobject {
    // SAFETY: a terminated name by contract.
    local(Some(Object::class_of(&unsafe { text(name) })))
}

extern "system" fn GetSuperclass(_env: Env, class: jobject) -> jobject {
    match &get(class, "GetSuperclass").data {
        Data::Class(name) if name != "java/lang/Object" => local(Some(Object::class_of("java/lang/Object"))),
        _ => std::ptr::null_mut(),
    }
}

/// Returns true. Class relations are not simulated: android-activity and jni only check those that hold on a device.
extern "system" fn IsAssignableFrom(_env: Env, one: jobject, other: jobject) -> jboolean {
    get(one, "IsAssignableFrom");
    get(other, "IsAssignableFrom");
    true
}

extern "system" fn IsInstanceOf(_env: Env, _object: jobject, class: jobject) -> jboolean {
    get(class, "IsInstanceOf");
    true
}

/// Returns null, since calls never throw here.
extern "system" fn ExceptionOccurred(_env: Env) -> jobject {
    std::ptr::null_mut()
}

extern "system" fn ExceptionCheck(_env: Env) -> jboolean {
    false
}

extern "system" fn ExceptionDescribe(_env: Env) {}

extern "system" fn ExceptionClear(_env: Env) {}

unsafe extern "system" fn FatalError(_env: Env, message: *const c_char) -> ! {
    // SAFETY: a terminated message by contract.
    fatal(format!("JNI FatalError: {}", unsafe { text(message) }))
}

extern "system" fn PushLocalFrame(_env: Env, _capacity: jint) -> jint {
    frames().borrow_mut().push(Vec::new());
    JNI_OK
}

extern "system" fn PopLocalFrame(_env: Env, result: jobject) -> jobject {
    let kept = host().jni.get(result);
    let frame = {
        let mut frames = frames().borrow_mut();
        if frames.len() < 2 {
            fatal("JNI PopLocalFrame without PushLocalFrame");
        }
        frames.pop().unwrap_or_default()
    };
    for handle in frame {
        host().jni.remove(handle as jobject, Kind::Local);
    }
    local(kept)
}

extern "system" fn EnsureLocalCapacity(_env: Env, _capacity: jint) -> jint {
    JNI_OK
}

extern "system" fn NewLocalRef(_env: Env, handle: jobject) -> jobject {
    local(host().jni.get(handle))
}

extern "system" fn NewGlobalRef(_env: Env, handle: jobject) -> jobject {
    host().jni.again(handle, Kind::Global)
}

extern "system" fn NewWeakGlobalRef(_env: Env, handle: jobject) -> jobject {
    host().jni.again(handle, Kind::Weak)
}

extern "system" fn DeleteGlobalRef(_env: Env, handle: jobject) {
    host().jni.remove(handle, Kind::Global);
}

extern "system" fn DeleteWeakGlobalRef(_env: Env, handle: jobject) {
    host().jni.remove(handle, Kind::Weak);
}

extern "system" fn DeleteLocalRef(_env: Env, handle: jobject) {
    if handle.is_null() {
        return;
    }
    for frame in frames().borrow_mut().iter_mut() {
        frame.retain(|known| *known != handle as usize);
    }
    host().jni.remove(handle, Kind::Local);
}

extern "system" fn IsSameObject(_env: Env, one: jobject, other: jobject) -> jboolean {
    match (host().jni.get(one), host().jni.get(other)) {
        (Some(one), Some(other)) => {
            Arc::ptr_eq(&one, &other)
                || matches!((&one.data, &other.data), (Data::Class(one), Data::Class(other)) if one == other)
        }
        (None, None) => true,
        _ => false,
    }
}

extern "system" fn GetObjectClass(_env: Env, handle: jobject) -> jobject {
    local(Some(Object::class_of(&get(handle, "GetObjectClass").class)))
}

/// Returns the identifier of a method or a field. Either is identified by its class, name and signature.
///
/// # Safety
/// `name` and `signature` must be terminated strings.
unsafe fn member(class: jobject, name: *const c_char, signature: *const c_char) -> *const Member {
    let class = match &get(class, "the look-up of a method or a field").data {
        Data::Class(name) => name.clone(),
        _ => fatal("JNI: a method or a field of something that is no class"),
    };
    // SAFETY: the caller guarantees terminated strings.
    let (name, signature) = unsafe { (text(name), text(signature)) };
    host().jni.member(Member { class, name, signature })
}

unsafe extern "system" fn GetMethodID(
    _env: Env,
    class: jobject,
    name: *const c_char,
    signature: *const c_char,
) -> jmethodID {
    // SAFETY: JNI's callers pass terminated strings.
    unsafe { member(class, name, signature) }.cast_mut().cast()
}

unsafe extern "system" fn GetFieldID(
    _env: Env,
    class: jobject,
    name: *const c_char,
    signature: *const c_char,
) -> jfieldID {
    // SAFETY: JNI's callers pass terminated strings.
    unsafe { member(class, name, signature) }.cast_mut().cast()
}

/// Returns the arguments of a call, by the method's signature.
///
/// # Safety
/// `values` must contain a `jvalue` for each parameter.
unsafe fn arguments(signature: &str, values: *const jvalue) -> Vec<Value> {
    let parameters = signature.trim_start_matches('(').split(')').next().unwrap_or("");
    let mut result = Vec::new();
    let mut rest = parameters.chars().peekable();
    while let Some(kind) = rest.next() {
        // SAFETY: there is a value of the signature's type for each parameter. A boolean is read as a byte, so that an
        // invalid one passed by a caller is not undefined behaviour.
        let value = unsafe { &*values.add(result.len()) };
        // SAFETY: as above.
        result.push(unsafe {
            match kind {
                'Z' => Value::Boolean(value.b != 0),
                'B' => Value::Int(i32::from(value.b)),
                'C' => Value::Int(i32::from(value.c)),
                'S' => Value::Int(i32::from(value.s)),
                'I' => Value::Int(value.i),
                'F' => Value::Float(value.f),
                'L' | '[' => {
                    let mut name = kind;
                    while name == '[' {
                        name = rest.next().unwrap_or(';');
                    }
                    if name == 'L' {
                        rest.by_ref().find(|character| *character == ';');
                    }
                    Value::Object(host().jni.get(value.l))
                }
                other => fatal(format!("JNI: the signature {signature} has a parameter {other:?}")),
            }
        });
    }
    result
}

/// Returns the result of an unknown call: a new object of the type at the end of the signature, or zero.
fn invent(member: &Member) -> Value {
    host().jni.note_invented(member);
    match member.returned().chars().next() {
        Some('V') => Value::Void,
        Some('Z') => Value::Boolean(false),
        Some('F') => Value::Float(0.0),
        Some('L') => Value::object(match member.returned_class().unwrap_or_default() {
            "java/lang/String" => Object::string(""),
            "java/lang/Class" => Object::class_of("java/lang/Object"),
            class => Object::new(class, Data::None),
        }),
        Some('[') => Value::object(Object::new(member.returned(), Data::Array(Mutex::default()))),
        _ => Value::Int(0),
    }
}

/// Calls a method.
///
/// # Safety
/// `method` must come from `GetMethodID`, and `values` must contain a `jvalue` for each of its parameters.
unsafe fn call(receiver: jobject, method: jmethodID, values: *const jvalue) -> Value {
    // SAFETY: the identifier came from `member`, and members are never freed.
    let method = unsafe { &*method.cast::<Member>() };
    let receiver = get(receiver, &method.name);
    // SAFETY: the caller guarantees a value for each parameter.
    let arguments = unsafe { arguments(&method.signature, values) };
    let answer = answers::call(&receiver, method, &arguments).unwrap_or_else(|| invent(method));
    checked(answer, method)
}

/// Checks that a result has the type in the signature. Ends the run otherwise, since that is a mistake in the host.
fn checked(value: Value, member: &Member) -> Value {
    let promised = member.returned().chars().next().unwrap_or('V');
    let fits = match value {
        Value::Void => promised == 'V',
        Value::Boolean(_) => promised == 'Z',
        Value::Int(_) => matches!(promised, 'B' | 'C' | 'S' | 'I'),
        Value::Float(_) => promised == 'F',
        Value::Object(_) => matches!(promised, 'L' | '['),
    };
    if fits {
        value
    } else {
        fatal(format!("the host answers {}.{}{} by {value:?}", member.class, member.name, member.signature))
    }
}

unsafe extern "system" fn NewObjectA(
    _env: Env,
    class: jobject,
    method: jmethodID,
    _values: *const jvalue,
) -> jobject {
    // SAFETY: the identifier came from `member`, and members are never freed.
    let method = unsafe { &*method.cast::<Member>() };
    match &get(class, "NewObject").data {
        Data::Class(name) if method.name == "<init>" => local(Some(Object::new(name, Data::None))),
        _ => fatal("JNI: NewObject without a class or a constructor"),
    }
}

/// Defines functions that call a method with one result type. Results of other types have been rejected before.
macro_rules! calls {
    ($($function:ident: $pattern:pat => $value:expr, $type:ty;)*) => {
        $(unsafe extern "system" fn $function(_env: Env, receiver: jobject, method: jmethodID, values: *const jvalue) -> $type {
            // SAFETY: JNI's callers pass a method of `GetMethodID` and its arguments.
            match unsafe { call(receiver, method, values) } {
                $pattern => $value,
                other => fatal(format!(concat!("JNI: ", stringify!($function), " of a method that gives {:?}"), other)),
            }
        })*
    };
}

calls! {
    CallObjectMethodA: Value::Object(object) => local(object), jobject;
    CallBooleanMethodA: Value::Boolean(value) => value, jboolean;
    CallIntMethodA: Value::Int(value) => value, jint;
    CallFloatMethodA: Value::Float(value) => value, jfloat;
    CallVoidMethodA: Value::Void => (), ();
}

/// Defines functions that read a field of one type.
macro_rules! fields {
    ($($function:ident: $pattern:pat => $value:expr, $type:ty;)*) => {
        $(unsafe extern "system" fn $function(_env: Env, receiver: jobject, field: jfieldID) -> $type {
            get(receiver, stringify!($function));
            // SAFETY: the identifier came from `member`, and members are never freed.
            let field = unsafe { &*field.cast::<Member>() };
            match checked(answers::field(field).unwrap_or_else(|| invent(field)), field) {
                $pattern => $value,
                other => fatal(format!(concat!("JNI: ", stringify!($function), " of a field that holds {:?}"), other)),
            }
        })*
    };
}

fields! {
    GetObjectField: Value::Object(object) => local(object), jobject;
    GetBooleanField: Value::Boolean(value) => value, jboolean;
    GetIntField: Value::Int(value) => value, jint;
    GetFloatField: Value::Float(value) => value, jfloat;
}

unsafe extern "system" fn SetFloatField(_env: Env, receiver: jobject, field: jfieldID, value: f32) {
    get(receiver, "SetFloatField");
    // SAFETY: the identifier came from `member`, and members are never freed.
    answers::set_field(unsafe { &*field.cast::<Member>() }, value);
}

extern "system" fn MonitorEnter(_env: Env, _handle: jobject) -> jint {
    JNI_OK
}

extern "system" fn MonitorExit(_env: Env, _handle: jobject) -> jint {
    JNI_OK
}

unsafe extern "system" fn GetJavaVM(_env: Env, out: *mut *mut JavaVM) -> jint {
    // SAFETY: the caller gives room for one pointer.
    unsafe { out.write(virtual_machine()) };
    JNI_OK
}
