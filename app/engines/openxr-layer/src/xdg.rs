//! The user's folders, by the XDG Base Directory Specification.

use std::env;
use std::path::PathBuf;

/// Returns the folder that an environment variable names, or else the folder `in_home` in the user's home. `None`
/// without a home, and on Android.
pub fn folder(variable: &str, in_home: &str) -> Option<PathBuf> {
    if cfg!(target_os = "android") {
        return None;
    }
    let absolute = |name: &str| env::var_os(name).map(PathBuf::from).filter(|path| path.is_absolute());
    absolute(variable).or_else(|| absolute("HOME").map(|home| home.join(in_home)))
}
