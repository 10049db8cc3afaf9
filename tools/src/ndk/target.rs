//! The versions of Android and the processors that the application is built for, as in android/Cargo.toml.

/// The oldest Android that the application runs on (Android 10).
pub const MIN_API: u32 = 29;
/// The Android that it is made for.
pub const TARGET_API: u32 = 36;
/// Android requires it of new applications: devices may have pages as large as this.
pub const PAGE: u64 = 16 * 1024;

/// The name of the OpenXR loader that the application looks for in its APK.
pub const LOADER: &str = "libopenxr_loader.so";

/// Libraries of OpenXR runtimes that lie on a system partition. From target API level 31 on Android refuses to load
/// such a library for an application that does not name it. Not required: each is on one maker's headsets only.
pub const NATIVE_LIBRARIES: [&str; 2] = ["libopenxr.google.so", "libopenxr_forwardloader.oculus.so"];

/// Properties of the application, by name and value: Android XR starts an OpenXR application in a space of its own only
/// if it asks for that.
pub const PROPERTIES: [(&str, &str); 1] =
    [("android.window.PROPERTY_XR_ACTIVITY_START_MODE", "XR_ACTIVITY_START_MODE_FULL_SPACE_UNMANAGED")];

/// The processors that the APK carries libraries for.
pub const ARCHITECTURES: [Architecture; 2] = [
    Architecture { triple: "aarch64-linux-android", abi: "arm64-v8a", machine: 183 },
    Architecture { triple: "x86_64-linux-android", abi: "x86_64", machine: 62 },
];

/// A processor, by its names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Architecture {
    /// Rust's and LLVM's name.
    pub triple: &'static str,
    /// Android's name: the folder in the APK.
    pub abi: &'static str,
    /// ELF's number.
    pub machine: u16,
}
