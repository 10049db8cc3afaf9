//! Changes of the synthesis' shaders for measurements: copies that count how often their parts run, and copies without
//! some of the parts, whose differences are the parts' costs.
//!
//! Each change names the text that it replaces, and fails if the shader does not have it any more.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context as _, ensure};
use serde_json::Value;

use crate::folders::{root, target_folder, write};

/// The file whose text is both counted and compiled in parts.
const MARCH: &str = "synthesis/gather/march.frag";
const SEGMENTS: &str = "include/segments.glsl";

/// A replacement of a text.
type Patch = (&'static str, &'static str);

/// A part of the march that can be left out: its bit in the table's `PARTS`, and the changes that leave it out.
const PARTS: [(u32, &[Patch]); 6] = [
    (1, &[("if (span.y != 0u) {", "if (false) {")]),
    (2, &[("color = searched(span.x, surface);", "discard;")]),
    (4, &[("if (!done) {", "if (false) {")]),
    (
        8,
        &[
            ("if (at.x >= 0.0 && at.x < end && is_event(at.a, at.b)) {", "if (false) {"),
            ("if (!crosses && at.x < end && is_event(at.a, at.b)) {", "if (false) {"),
        ],
    ),
    (16, &[("if (surface.hole) {", "if (false) {")]),
    (32, &[("while (crosses && x < last) {", "while (false) {")]),
];

/// What is compiled in parts: macros, and the bits of the parts that are kept. Each adds a part to the one before: the law;
/// the first steps; the search over segments; events; the fill; crossings.
const VARIANTS: [(&str, &[u32]); 6] = [
    ("", &[1, 2, 6, 14, 30, 62]),
    ("DEPTH_PAIRS", &[1, 2, 6, 14, 30, 62]),
    ("WRITE_DEPTH", &[1]),
    ("DEPTH_PAIRS WRITE_DEPTH", &[1]),
    ("BLOOM", &[1]),
    ("OPEN_HOLES", &[1, 2]),
];

/// The counters, by their index: first steps, segments, holes, events, steps to a segment's crossing, one that is not used,
/// pixels that search over segments, and pixels with a law. Each is increased after a text. Whether a law's surface may end
/// is written without a counter.
const COUNTERS: [(usize, &str, &str); 7] = [
    (0, MARCH, "max(at.b, -1.0) >= at.a; at.x += 1.0) {"),
    (1, SEGMENTS, "while (x <= end && !found) {"),
    (2, SEGMENTS, "if (surface.hole) {"),
    (3, SEGMENTS, "bool meet(inout Beside beside, Search at) {"),
    (4, SEGMENTS, "while (crosses && x < last) {"),
    (6, MARCH, "if (!done) {"),
    (7, MARCH, "if (span.y != 0u) {"),
];
/// What declares them, before this text, and what writes them in place of the colour, before that one.
const DECLARATION: (&str, Patch) =
    (SEGMENTS, ("TEXTURE(2) uniform", "int trips[8] = int[8](0, 0, 0, 0, 0, 0, 0, 0);\nTEXTURE(2) uniform"));
const RESULT: (&str, Patch) = (
    MARCH,
    (
        "#ifdef WRITE_DEPTH\n    gl_FragDepth",
        "    int ways = trips[0] | min(trips[2], 1) << 3 | trips[6] << 4 | trips[7] << 5 | int(span.w) << 6;\n    \
         color = vec4(ways, trips[1], trips[3], trips[4]) / 255.0;\n#ifdef WRITE_DEPTH\n    gl_FragDepth",
    ),
);

fn patched(text: &str, (from, to): Patch) -> anyhow::Result<String> {
    ensure!(
        text.contains(from),
        "the march has no \"{from}\" any more: name its parts anew in xtask/src/maintain/estimate/patches.rs"
    );
    Ok(text.replacen(from, to, 1))
}

/// Returns a text of the march with those of its parts whose bits are set.
fn with_parts(text: &str, bits: u32) -> anyhow::Result<String> {
    let left_out = PARTS.iter().filter(|(bit, _)| bits & bit == 0);
    left_out.flat_map(|(_, patches)| *patches).try_fold(text.to_owned(), |text, patch| patched(&text, *patch))
}

/// Adds the march in parts to programs as written by `shader-programs`.
///
/// # Errors
/// Fails if a program is not there, or the march has changed.
pub fn add_parts(programs: &mut Vec<Value>) -> anyhow::Result<()> {
    for (macros, kept) in VARIANTS {
        let name = [MARCH, macros].join(" ").trim_end().to_owned();
        let words = |name: &str| name.split(' ').map(str::to_owned).collect::<BTreeSet<_>>();
        let is_whole =
            |program: &&Value| program["name"].as_str().is_some_and(|own| words(own) == words(&name));
        let whole = programs.iter().find(is_whole).cloned();
        let whole = whole.with_context(|| format!("no program is called {name}"))?;
        for bits in kept {
            let mut program = whole.clone();
            program["name"] = format!("{name} PARTS={bits}").into();
            let text = program["stages"][1]["text"].as_str().context("a program has no text")?;
            program["stages"][1]["text"] = with_parts(text, *bits)?.into();
            programs.push(program);
        }
    }
    Ok(())
}

/// Returns the text of a file with its counters.
fn counting(file: &str, text: String) -> anyhow::Result<String> {
    let mut text = text;
    for (counter, _, after) in COUNTERS.into_iter().filter(|(_, at, _)| *at == file) {
        ensure!(text.contains(after), "{file} has no \"{after}\" any more: name it anew in patches.rs");
        text = text.replacen(after, &format!("{after} ++trips[{counter}];"), 1);
    }
    for (_, patch) in [DECLARATION, RESULT].into_iter().filter(|(at, _)| *at == file) {
        text = patched(&text, patch)?;
    }
    Ok(text)
}

/// Writes all shaders, with counters in those of the march, below target/, and returns the folder.
///
/// # Errors
/// Fails if a file cannot be read or written, or if the march has changed.
pub fn counting_shaders() -> anyhow::Result<PathBuf> {
    let to = target_folder()?.join("counting-shaders");
    copy(&root().join("shaders-glsl"), &to, Path::new(""))?;
    Ok(to)
}

fn copy(from: &Path, to: &Path, inner: &Path) -> anyhow::Result<()> {
    let folder = from.join(inner);
    for entry in fs::read_dir(&folder).with_context(|| format!("{} cannot be read", folder.display()))? {
        let inner = inner.join(entry?.file_name());
        let path = from.join(&inner);
        if path.is_dir() {
            copy(from, to, &inner)?;
        } else if path.extension().is_some_and(|ending| ["glsl", "vert", "frag"].iter().any(|e| ending == *e))
        {
            let text =
                fs::read_to_string(&path).with_context(|| format!("{} cannot be read", path.display()))?;
            write(&to.join(&inner), counting(&inner.to_string_lossy(), text)?)?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(file: &str) -> String {
        fs::read_to_string(root().join("shaders-glsl").join(file)).unwrap()
    }

    #[test]
    fn the_march_has_the_parts_that_are_left_out_and_counted() {
        let whole = text(SEGMENTS) + &text(MARCH);
        assert_eq!(with_parts(&whole, 63).unwrap(), whole);
        assert_eq!(with_parts(&whole, 0).unwrap().matches("if (false) {").count(), 5);
        assert!(patched(&whole, ("nowhere", "")).is_err());
        for (file, count) in [(MARCH, 3), (SEGMENTS, 4)] {
            assert_eq!(counting(file, text(file)).unwrap().matches("++trips[").count(), count, "{file}");
        }
    }
}
