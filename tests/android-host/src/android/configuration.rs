//! AConfiguration: the device's screen and language.

#![allow(non_snake_case)]

use std::ffi::{c_char, c_void};

use crate::exports::{Export, System, exports};
use crate::host::host;

/// A configuration: the values that depend on the script.
#[derive(Clone, Copy, Default)]
pub struct AConfiguration {
    sdk: i32,
    landscape: bool,
}

/// Returns the functions of this module that libandroid.so exports.
pub fn exports() -> Vec<Export> {
    exports![
        System::Android, 1: [
            AConfiguration_copy, AConfiguration_delete, AConfiguration_fromAssetManager, AConfiguration_getCountry,
            AConfiguration_getDensity, AConfiguration_getKeyboard, AConfiguration_getKeysHidden,
            AConfiguration_getLanguage, AConfiguration_getMcc, AConfiguration_getMnc, AConfiguration_getNavHidden,
            AConfiguration_getNavigation, AConfiguration_getOrientation, AConfiguration_getScreenLong,
            AConfiguration_getScreenSize, AConfiguration_getSdkVersion, AConfiguration_getTouchscreen,
            AConfiguration_getUiModeNight, AConfiguration_getUiModeType, AConfiguration_new,
        ];
    ]
}

extern "C" fn AConfiguration_new() -> *mut AConfiguration {
    host().count("configurations", 1);
    Box::into_raw(Box::default())
}

unsafe extern "C" fn AConfiguration_delete(configuration: *mut AConfiguration) {
    host().count("configurations", -1);
    // SAFETY: by contract the configuration was made by `AConfiguration_new` and is deleted once.
    drop(unsafe { Box::from_raw(configuration) });
}

extern "C" fn AConfiguration_fromAssetManager(configuration: &mut AConfiguration, _manager: *const c_void) {
    let host = host();
    let (width, height) = host.window.size();
    *configuration = AConfiguration { sdk: host.device.sdk, landscape: width >= height };
}

extern "C" fn AConfiguration_copy(to: &mut AConfiguration, from: &AConfiguration) {
    *to = *from;
}

unsafe extern "C" fn AConfiguration_getLanguage(_configuration: &AConfiguration, out: *mut c_char) {
    // SAFETY: the caller gives room for two characters.
    unsafe { std::ptr::copy_nonoverlapping(c"en".as_ptr(), out, 2) };
}

unsafe extern "C" fn AConfiguration_getCountry(_configuration: &AConfiguration, out: *mut c_char) {
    // SAFETY: the caller gives room for two characters.
    unsafe { std::ptr::copy_nonoverlapping(c"US".as_ptr(), out, 2) };
}

macro_rules! getters {
    ($($name:ident: $configuration:pat => $value:expr;)*) => {
        $(extern "C" fn $name($configuration: &AConfiguration) -> i32 {
            $value
        })*
    };
}

getters! {
    AConfiguration_getDensity: _ => 160;
    AConfiguration_getOrientation: configuration => if configuration.landscape { 2 } else { 1 };
    AConfiguration_getSdkVersion: configuration => configuration.sdk;
    AConfiguration_getKeyboard: _ => 1;
    AConfiguration_getKeysHidden: _ => 1;
    AConfiguration_getMcc: _ => 0;
    AConfiguration_getMnc: _ => 0;
    AConfiguration_getNavHidden: _ => 1;
    AConfiguration_getNavigation: _ => 1;
    AConfiguration_getScreenLong: _ => 1;
    AConfiguration_getScreenSize: _ => 2;
    AConfiguration_getTouchscreen: _ => 3;
    AConfiguration_getUiModeNight: _ => 1;
    AConfiguration_getUiModeType: _ => 1;
}
