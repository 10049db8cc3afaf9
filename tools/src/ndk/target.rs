//! What the application is built for, as in android/Cargo.toml.

/// The oldest Android that the application runs on (Android 10).
pub const MIN_API: u32 = 29;
/// The Android that it is made for.
pub const TARGET_API: u32 = 34;
/// Android requires it of new applications: devices may have pages as large as this.
pub const PAGE: u64 = 16 * 1024;

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
