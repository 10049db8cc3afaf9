//! The symbols that Android's public libraries export.

/// The lists from which the stand-in NDK is made. Those of EGL, GLES and libandroid are complete; the others contain
/// what Rust's std and this project use.
pub const LISTS: [(&str, &str); 8] = [
    ("libEGL", include_str!("../../ndk/symbols/libEGL.txt")),
    ("libGLESv2", include_str!("../../ndk/symbols/libGLESv2.txt")),
    ("libGLESv3", include_str!("../../ndk/symbols/libGLESv3.txt")),
    ("libandroid", include_str!("../../ndk/symbols/libandroid.txt")),
    ("libc", include_str!("../../ndk/symbols/libc.txt")),
    ("libdl", include_str!("../../ndk/symbols/libdl.txt")),
    ("liblog", include_str!("../../ndk/symbols/liblog.txt")),
    ("libm", include_str!("../../ndk/symbols/libm.txt")),
];

/// A public symbol.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Symbol<'a> {
    /// The symbol's name.
    pub name: &'a str,
    /// True for data, false for a function.
    pub object: bool,
}

/// Returns the symbols of a list that exist in an API level.
pub fn listed(list: &str, api: u32) -> impl Iterator<Item = Symbol<'_>> {
    let mut since = 0;
    list.lines().filter(|line| !line.starts_with('#') && !line.is_empty()).filter_map(move |line| {
        if let Some(level) = line.strip_prefix('@') {
            since = level.parse().unwrap_or(u32::MAX);
            return None;
        }
        let (name, object) = line.strip_suffix(":object").map_or((line, false), |name| (name, true));
        (since <= api).then_some(Symbol { name, object })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ndk::target::MIN_API;

    #[test]
    fn every_list_is_sorted_and_free_of_doubles() {
        for (library, list) in LISTS {
            let names: Vec<_> = listed(list, MIN_API).map(|symbol| symbol.name).collect();
            assert!(names.len() > 3, "{library}");
            assert!(names.is_sorted_by(|a, b| a < b), "{library}");
        }
    }

    #[test]
    fn an_unwinder_is_public_since_api_30() {
        let libc = LISTS.iter().find(|(name, _)| *name == "libc").unwrap().1;
        assert!(listed(libc, 30).any(|symbol| symbol.name == "_Unwind_Resume"));
        assert!(!listed(libc, 29).any(|symbol| symbol.name == "_Unwind_Resume"));
    }
}
