//! JNI's strings and arrays.

#![allow(non_snake_case)]

use std::collections::HashMap;
use std::ffi::{CString, c_char};
use std::sync::Mutex;

use jni_sys::{jboolean, jint, jobject, jsize};

use super::table::{Env, get, local};
use super::{Data, Object};
use crate::bionic::text;
use crate::host::{fatal, host, lock};

/// The buffers of `GetStringUTFChars` and `GetStringChars`, by address.
static CHARACTERS: Mutex<Option<HashMap<usize, Box<[u8]>>>> = Mutex::new(None);

// Strings. JNI's "modified UTF-8" only differs for NUL and beyond the basic plane, which do not occur here.

fn string(handle: jobject) -> String {
    get(handle, "a string function").text().unwrap_or_default().to_owned()
}

/// Keeps a copy for the application until it is released.
fn lend(bytes: Vec<u8>) -> *const u8 {
    let bytes = bytes.into_boxed_slice();
    let address = bytes.as_ptr();
    lock(&CHARACTERS).get_or_insert_default().insert(address as usize, bytes);
    host().count("JNI string buffers", 1);
    address
}

fn take_back<T>(address: *const T) {
    if lock(&CHARACTERS).get_or_insert_default().remove(&(address as usize)).is_none() {
        fatal("JNI: characters were released that were never lent");
    }
    host().count("JNI string buffers", -1);
}

pub(super) unsafe extern "system" fn NewStringUTF(_env: Env, characters: *const c_char) -> jobject {
    // SAFETY: a terminated string by contract.
    local(Some(Object::string(&unsafe { text(characters) })))
}

pub(super) unsafe extern "system" fn GetStringUTFChars(
    _env: Env,
    handle: jobject,
    copied: *mut jboolean,
) -> *const c_char {
    if !copied.is_null() {
        // SAFETY: not null, so the caller gives room for one jboolean.
        unsafe { copied.write(true) };
    }
    lend(CString::new(string(handle)).unwrap_or_default().into_bytes_with_nul()).cast()
}

pub(super) extern "system" fn ReleaseStringUTFChars(_env: Env, _handle: jobject, characters: *const c_char) {
    take_back(characters);
}

pub(super) extern "system" fn GetArrayLength(_env: Env, handle: jobject) -> jint {
    match &get(handle, "GetArrayLength").data {
        Data::Array(items) => lock(items).len() as jsize,
        _ => fatal("JNI: GetArrayLength of something that is no array"),
    }
}

pub(super) extern "system" fn GetObjectArrayElement(_env: Env, handle: jobject, index: jsize) -> jobject {
    match &get(handle, "GetObjectArrayElement").data {
        Data::Array(items) => local(lock(items).get(index as usize).cloned().flatten()),
        _ => fatal("JNI: GetObjectArrayElement of something that is no array"),
    }
}

pub(super) extern "system" fn NewObjectArray(
    _env: Env,
    length: jsize,
    class: jobject,
    first: jobject,
) -> jobject {
    let class = match &get(class, "NewObjectArray").data {
        Data::Class(name) => format!("[L{name};"),
        _ => fatal("JNI: NewObjectArray of something that is no class"),
    };
    let first = (!first.is_null()).then(|| get(first, "NewObjectArray"));
    let items = vec![first; length.max(0) as usize];
    local(Some(Object::new(&class, Data::Array(items.into()))))
}

pub(super) extern "system" fn SetObjectArrayElement(
    _env: Env,
    handle: jobject,
    index: jsize,
    value: jobject,
) {
    let value = (!value.is_null()).then(|| get(value, "SetObjectArrayElement"));
    match &get(handle, "SetObjectArrayElement").data {
        Data::Array(items) => match lock(items).get_mut(index as usize) {
            Some(item) => *item = value,
            None => fatal("JNI: SetObjectArrayElement beyond the array"),
        },
        _ => fatal("JNI: SetObjectArrayElement of something that is no array"),
    }
}
