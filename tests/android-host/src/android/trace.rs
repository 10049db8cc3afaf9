//! ATrace: tracing is always off.

#![allow(non_snake_case)]

use std::ffi::c_char;

use crate::exports::{Export, System, exports};

/// Returns the functions of this module that libandroid.so exports.
pub fn exports() -> Vec<Export> {
    exports![
        System::Android, 23: [ATrace_beginSection, ATrace_endSection, ATrace_isEnabled];
        System::Android, 29: [ATrace_beginAsyncSection, ATrace_endAsyncSection, ATrace_setCounter];
    ]
}

extern "C" fn ATrace_isEnabled() -> bool {
    false
}

extern "C" fn ATrace_beginSection(_name: *const c_char) {}

extern "C" fn ATrace_endSection() {}

extern "C" fn ATrace_beginAsyncSection(_name: *const c_char, _cookie: i32) {}

extern "C" fn ATrace_endAsyncSection(_name: *const c_char, _cookie: i32) {}

extern "C" fn ATrace_setCounter(_name: *const c_char, _value: i64) {}
