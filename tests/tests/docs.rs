//! Checks that files named in documents exist.

use std::fs;
use std::path::{Path, PathBuf};

/// Extensions that make a word in backticks a file of this repository.
const ENDINGS: [&str; 9] = [".rs", ".toml", ".md", ".frag", ".vert", ".comp", ".glsl", ".py", ".json"];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap()
}

/// Finds all Markdown files except build results.
fn documents(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if path.is_dir() {
            if !name.starts_with('.') && !["target", "out"].contains(&name.as_str()) {
                documents(&path, found);
            }
        } else if name.ends_with(".md") {
            found.push(path);
        }
    }
}

/// Returns file and anchor of links, `](file#anchor)`. Omits links to other sites.
fn links(text: &str) -> impl Iterator<Item = (&str, Option<&str>)> {
    let targets = text.split("](").skip(1).filter_map(|rest| rest.split_once(')')).map(|(target, _)| target);
    targets.filter(|target| !target.contains("://")).map(|target| match target.split_once('#') {
        Some((file, anchor)) => (file, Some(anchor)),
        None => (target, None),
    })
}

/// True if a document has a heading of this anchor: its words in lower case, without punctuation, joined by `-`.
fn has_heading(text: &str, anchor: &str) -> bool {
    let mut in_code = false;
    text.lines().any(|line| {
        in_code ^= line.starts_with("```");
        let heading = line.trim_start_matches('#').trim().to_lowercase();
        let kept = heading.chars().filter(|c| c.is_alphanumeric() || [' ', '-', '_'].contains(c));
        !in_code && line.starts_with('#') && kept.map(|c| if c == ' ' { '-' } else { c }).eq(anchor.chars())
    })
}

/// Returns the words in backticks that are paths from the root: they begin with one of its folders and end like a file.
fn paths(text: &str) -> impl Iterator<Item = &str> {
    let folders = ["app/", "android/", "docs/", "scenes/", "shaders-glsl/", "tests/", "xtask/"];
    let words = text.split('`').skip(1).step_by(2);
    words.filter(move |word| {
        folders.iter().any(|folder| word.starts_with(folder))
            && ENDINGS.iter().any(|ending| word.ends_with(ending))
            && !word.contains(['*', '<', ' ', 'N'])
    })
}

#[test]
fn every_link_and_path_leads_somewhere() {
    let mut files = Vec::new();
    documents(root(), &mut files);
    assert!(files.len() > 10, "the documents are gone");
    let mut lost = Vec::new();
    for file in &files {
        let text = fs::read_to_string(file).unwrap();
        let folder = file.parent().unwrap();
        let name = file.strip_prefix(root()).unwrap().display();
        for (target, anchor) in links(&text) {
            let path = if target.is_empty() { file.clone() } else { folder.join(target) };
            if !path.exists() {
                lost.push(format!("{name}: {target}"));
            } else if let Some(anchor) = anchor
                && !has_heading(&fs::read_to_string(path).unwrap(), anchor)
            {
                lost.push(format!("{name}: {target}#{anchor}"));
            }
        }
        let named = paths(&text).filter(|path| !root().join(path).exists());
        lost.extend(named.map(|path| format!("{name}: {path}")));
    }
    assert!(lost.is_empty(), "these do not exist:\n{}", lost.join("\n"));
}
