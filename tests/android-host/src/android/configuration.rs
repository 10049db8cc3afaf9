//! AConfiguration: the device's screen and language.

#![allow(non_snake_case)]

use std::ffi::{c_char, c_void};

use crate::exports::{Export, System, exports};
use crate::host::host;

/// One configuration: the values that depend on the script.
#[derive(Clone, Copy, Default)]
pub struct AConfiguration {
    density: i32,
    width_dp: i32,
    height_dp: i32,
    sdk: i32,
    landscape: bool,
}

/// Returns the functions of this module that libandroid.so exports.
pub fn exports() -> Vec<Export> {
    exports![
        System::Android, 1: [
            AConfiguration_copy, AConfiguration_delete, AConfiguration_diff, AConfiguration_fromAssetManager, AConfiguration_getCountry,
            AConfiguration_getDensity, AConfiguration_getKeyboard, AConfiguration_getKeysHidden, AConfiguration_getLanguage,
            AConfiguration_getLayoutDirection, AConfiguration_getMcc, AConfiguration_getMnc, AConfiguration_getNavHidden,
            AConfiguration_getNavigation, AConfiguration_getOrientation, AConfiguration_getScreenHeightDp, AConfiguration_getScreenLong,
            AConfiguration_getScreenSize, AConfiguration_getScreenWidthDp, AConfiguration_getSdkVersion,
            AConfiguration_getSmallestScreenWidthDp, AConfiguration_getTouchscreen, AConfiguration_getUiModeNight,
            AConfiguration_getUiModeType, AConfiguration_new,
        ];
        System::Android, 30: [AConfiguration_getScreenRound];
    ]
}

extern "C" fn AConfiguration_new() -> *mut AConfiguration {
    host().count("configurations", 1);
    Box::into_raw(Box::default())
}

unsafe extern "C" fn AConfiguration_delete(configuration: *mut AConfiguration) {
    host().count("configurations", -1);
    // SAFETY: made by new and deleted once by contract.
    drop(unsafe { Box::from_raw(configuration) });
}

extern "C" fn AConfiguration_fromAssetManager(configuration: &mut AConfiguration, _manager: *const c_void) {
    let host = host();
    let (width, height) = host.window.size();
    let dp = |pixels: i32| pixels * 160 / host.device.density.max(1);
    *configuration = AConfiguration {
        density: host.device.density,
        width_dp: dp(width),
        height_dp: dp(height),
        sdk: host.device.sdk,
        landscape: width >= height,
    };
}

extern "C" fn AConfiguration_copy(to: &mut AConfiguration, from: &AConfiguration) {
    *to = *from;
}

/// Bits of `ACONFIGURATION_*`: density 0x100, orientation 0x80, screen size 0x200.
extern "C" fn AConfiguration_diff(one: &AConfiguration, other: &AConfiguration) -> i32 {
    let bit = |differs: bool, bit: i32| if differs { bit } else { 0 };
    bit(one.density != other.density, 0x100)
        | bit(one.landscape != other.landscape, 0x80)
        | bit((one.width_dp, one.height_dp) != (other.width_dp, other.height_dp), 0x200)
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
    AConfiguration_getDensity: configuration => configuration.density;
    AConfiguration_getOrientation: configuration => if configuration.landscape { 2 } else { 1 };
    AConfiguration_getScreenWidthDp: configuration => configuration.width_dp;
    AConfiguration_getScreenHeightDp: configuration => configuration.height_dp;
    AConfiguration_getSmallestScreenWidthDp: configuration => configuration.width_dp.min(configuration.height_dp);
    AConfiguration_getSdkVersion: configuration => configuration.sdk;
    AConfiguration_getKeyboard: _ => 1;
    AConfiguration_getKeysHidden: _ => 1;
    AConfiguration_getLayoutDirection: _ => 1;
    AConfiguration_getMcc: _ => 0;
    AConfiguration_getMnc: _ => 0;
    AConfiguration_getNavHidden: _ => 1;
    AConfiguration_getNavigation: _ => 1;
    AConfiguration_getScreenLong: _ => 1;
    AConfiguration_getScreenRound: _ => 1;
    AConfiguration_getScreenSize: _ => 2;
    AConfiguration_getTouchscreen: _ => 3;
    AConfiguration_getUiModeNight: _ => 1;
    AConfiguration_getUiModeType: _ => 1;
}
