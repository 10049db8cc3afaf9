//! The functions that each system library of the simulated device exports.

use std::collections::HashMap;
use std::sync::OnceLock;

/// A library of the public NDK.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum System {
    /// libc.so
    C,
    /// libm.so
    M,
    /// libdl.so
    Dl,
    /// liblog.so
    Log,
    /// libandroid.so
    Android,
    /// libEGL.so
    Egl,
    /// libGLESv2.so
    GlesV2,
    /// libGLESv3.so
    GlesV3,
    /// libcamera2ndk.so
    Camera,
    /// libmediandk.so
    Media,
}

impl System {
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

    /// Returns the file name, as used in DT_NEEDED and `dlopen`.
    pub fn name(self) -> &'static str {
        match self {
            Self::C => "libc.so",
            Self::M => "libm.so",
            Self::Dl => "libdl.so",
            Self::Log => "liblog.so",
            Self::Android => "libandroid.so",
            Self::Egl => "libEGL.so",
            Self::GlesV2 => "libGLESv2.so",
            Self::GlesV3 => "libGLESv3.so",
            Self::Camera => "libcamera2ndk.so",
            Self::Media => "libmediandk.so",
        }
    }

    /// Returns the library with this file name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|library| library.name() == name)
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
    if matches!(library, System::GlesV2 | System::GlesV3) {
        return crate::graphics::gl::function(name);
    }
    table().get(&(library, name)).filter(|export| export.since <= sdk).map(|export| export.address)
}
