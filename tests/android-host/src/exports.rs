//! The functions that each system library of the simulated device exports.

use std::collections::HashMap;
use std::sync::OnceLock;

/// A library of the public NDK, by its file name, as used in DT_NEEDED and `dlopen`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct System(pub &'static str);

#[expect(non_upper_case_globals, reason = "they read as the variants of an enum")]
impl System {
    pub const C: Self = Self("libc.so");
    pub const M: Self = Self("libm.so");
    pub const Dl: Self = Self("libdl.so");
    pub const Log: Self = Self("liblog.so");
    pub const Android: Self = Self("libandroid.so");
    pub const Egl: Self = Self("libEGL.so");
    pub const GlesV2: Self = Self("libGLESv2.so");
    pub const GlesV3: Self = Self("libGLESv3.so");
    pub const Camera: Self = Self("libcamera2ndk.so");
    pub const Media: Self = Self("libmediandk.so");

    /// All of the libraries.
    pub const ALL: [Self; 10] = [
        Self::C,
        Self::M,
        Self::Dl,
        Self::Log,
        Self::Android,
        Self::Egl,
        Self::GlesV2,
        Self::GlesV3,
        Self::Camera,
        Self::Media,
    ];

    /// Returns the library with this file name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|library| library.0 == name)
    }
}

/// An exported function.
#[derive(Clone, Copy)]
pub struct Export {
    /// Its library.
    pub library: System,
    /// Its name.
    pub name: &'static str,
    /// Its address.
    pub address: usize,
    /// The first API level that has it. 1 if it is older than all supported levels.
    pub since: i32,
}

/// Makes a list of [`Export`]s: `exports!(System::Android, 1: [ALooper_prepare, ...])`.
macro_rules! exports {
    ($($library:expr, $since:literal: [$($function:ident),* $(,)?]);* $(;)?) => {
        vec![$($($crate::exports::Export {
            library: $library,
            name: stringify!($function),
            address: $function as *const () as usize,
            since: $since,
        },)*)*]
    };
}
pub(crate) use exports;

fn table() -> &'static HashMap<(System, &'static str), Export> {
    static TABLE: OnceLock<HashMap<(System, &'static str), Export>> = OnceLock::new();
    TABLE.get_or_init(|| {
        [
            crate::bionic::exports(),
            crate::android::activity::exports(),
            crate::android::assets::exports(),
            crate::android::camera::exports(),
            crate::android::choreographer::exports(),
            crate::android::configuration::exports(),
            crate::android::input::exports(),
            crate::android::log::exports(),
            crate::android::looper::exports(),
            crate::android::sensors::exports(),
            crate::android::thermal::exports(),
            crate::android::window::exports(),
            crate::graphics::egl::exports(),
        ]
        .into_iter()
        .flatten()
        .map(|export| ((export.library, export.name), export))
        .collect()
    })
}

/// Returns the address of a function that `library` exports on a device with API level `sdk`.
pub fn find(library: System, name: &str, sdk: i32) -> Option<usize> {
    if [System::GlesV2, System::GlesV3].contains(&library) {
        return crate::graphics::gl::function(name);
    }
    table().get(&(library, name)).filter(|export| export.since <= sdk).map(|export| export.address)
}
