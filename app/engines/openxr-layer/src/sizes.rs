//! The size of the offered view, remembered from one start to the next. It depends on the eyes' fields of view, which
//! are known only in a session. Many applications ask for the size before that, and then it must not change.

use std::fs;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value, json};

use crate::xdg;

/// The sizes in pixels of an eye and of the view that contains both.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Sizes {
    eye: [u32; 2],
    view: [u32; 2],
}

/// Returns the path of the file, `$XDG_STATE_HOME/yoro/layer-sizes.json` (`~/.local/state` if that is not set), or
/// `None` without a home folder and on Android.
pub fn path() -> Option<PathBuf> {
    Some(xdg::folder("XDG_STATE_HOME", ".local/state")?.join("yoro/layer-sizes.json"))
}

/// Returns the size in pixels that was remembered under these circumstances, scaled to an eye of this size.
pub fn recall(circumstances: &str, eye: [u32; 2]) -> Option<[u32; 2]> {
    let old = entry(&read(&path()?), circumstances)?;
    Some(scaled(eye, old.eye, old.view))
}

/// Remembers the size of the view for an eye of this size. If that fails, the next start uses an estimate.
pub fn remember(circumstances: &str, eye: [u32; 2], view: [u32; 2]) {
    if let Some(path) = path() {
        write(&path, circumstances, Sizes { eye, view });
    }
}

/// Scales `size` by the ratio of `to` to `from`, rounded up.
pub fn scaled(size: [u32; 2], from: [u32; 2], to: [u32; 2]) -> [u32; 2] {
    [0, 1].map(|i| {
        let grown = u64::from(size[i]) * u64::from(to[i]);
        u32::try_from(grown.div_ceil(u64::from(from[i].max(1)))).unwrap_or(u32::MAX)
    })
}

/// Returns the contents of the file, which are empty if it is absent or damaged.
fn read(path: &Path) -> Map<String, Value> {
    let text = fs::read_to_string(path).unwrap_or_default();
    serde_json::from_str(&text).unwrap_or_default()
}

/// Returns the sizes that were remembered, if the entry exists and is possible.
fn entry(sizes: &Map<String, Value>, circumstances: &str) -> Option<Sizes> {
    let Sizes { eye, view } = Sizes::deserialize(sizes.get(circumstances)?).ok()?;
    let can_be = |i: usize| eye[i] > 0 && (eye[i]..=eye[i].saturating_mul(16)).contains(&view[i]);
    (can_be(0) && can_be(1)).then_some(Sizes { eye, view })
}

fn write(path: &Path, circumstances: &str, new: Sizes) {
    let mut sizes = read(path);
    if entry(&sizes, circumstances) == Some(new) {
        return;
    }
    sizes.insert(circumstances.to_owned(), json!(new));
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder).ok();
    }
    // Another program may be reading the file.
    let part = path.with_extension(format!("{}.part", std::process::id()));
    if fs::write(&part, format!("{:#}\n", Value::Object(sizes))).is_ok() {
        fs::rename(&part, path).ok();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_kept_by_their_circumstances_and_a_damaged_file_is_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("state/layer-sizes.json");
        let known = |circumstances: &str| entry(&read(&path), circumstances);
        let sizes = |eye, view| Sizes { eye, view };
        assert_eq!(known("one"), None);
        write(&path, "one", sizes([100, 90], [130, 90]));
        write(&path, "two", sizes([10, 10], [12, 11]));
        write(&path, "one", sizes([100, 90], [131, 90]));
        let both = [sizes([100, 90], [131, 90]), sizes([10, 10], [12, 11])];
        assert_eq!([known("one"), known("two")], both.map(Some));
        for damaged in [
            "",
            "{",
            "[]",
            "{\"one\": 7}",
            "{\"one\": {\"eye\": [100, 90], \"view\": [131]}}",
            "{\"one\": {\"eye\": [100, 90], \"view\": [131, -90]}}",
            "{\"one\": {\"eye\": [0, 90], \"view\": [131, 90]}}",
            "{\"one\": {\"eye\": [100, 90], \"view\": [99, 90]}}",
        ] {
            fs::write(&path, damaged).unwrap();
            assert_eq!(known("one"), None, "{damaged}");
            write(&path, "one", sizes([100, 90], [130, 90]));
            assert_eq!(known("one"), Some(sizes([100, 90], [130, 90])), "{damaged}");
        }
        assert_eq!(fs::read_dir(path.parent().unwrap()).unwrap().count(), 1);
    }

    #[test]
    fn another_resolution_grows_in_proportion() {
        assert_eq!(scaled([320, 240], [320, 240], [331, 240]), [331, 240]);
        assert_eq!(scaled([640, 480], [320, 240], [331, 240]), [662, 480]);
        assert_eq!(scaled([1000, 1000], [320, 240], [331, 240]), [1035, 1000]);
    }
}
