//! The versions of Android and the processors that the application is built for, as in android/Cargo.toml.

/// The API level of the oldest supported Android (Android 10).
pub const MIN_API: u32 = 29;
/// The target API level.
pub const TARGET_API: u32 = 36;
/// The target API level of the APK for Meta's store, which takes 32 to 34 of immersive applications.
pub const QUEST_TARGET_API: u32 = 34;
/// The largest page size of devices in bytes, which Android requires new applications to support.
pub const PAGE: u64 = 16 * 1024;

/// The file name of the OpenXR loader that the application looks for in its APK.
pub const LOADER: &str = "libopenxr_loader.so";

/// The processors that the APK contains libraries for.
pub const ARCHITECTURES: [Architecture; 2] = [
    Architecture { triple: "aarch64-linux-android", abi: "arm64-v8a", machine: 183 },
    Architecture { triple: "x86_64-linux-android", abi: "x86_64", machine: 62 },
];

/// A processor's names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Architecture {
    /// The target triple of Rust and LLVM.
    pub triple: &'static str,
    /// Android's name, which is the folder in the APK.
    pub abi: &'static str,
    /// The value of `e_machine` in ELF files.
    pub machine: u16,
}
