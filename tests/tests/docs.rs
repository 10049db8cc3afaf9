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

/// Returns the targets of links, `](target)`, without anchors. Omits links to other sites.
fn links(text: &str) -> impl Iterator<Item = &str> {
    let targets = text.split("](").skip(1).filter_map(|rest| rest.split_once(')')).map(|(target, _)| target);
    targets.filter(|target| !target.contains("://")).filter_map(|target| target.split('#').next())
}

/// Returns the words in backticks that are paths from the root: they begin with one of its folders and end like a file.
fn paths(text: &str) -> impl Iterator<Item = &str> {
    let folders = [
        "app/",
        "android/",
        "docs/",
        "app/lab/devices/experiments/",
        "scenes/",
        "shaders-glsl/",
        "tests/",
        "training/",
        "xtask/",
    ];
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
        // The changelog also names paths that no longer exist.
        let history = file.ends_with("CHANGELOG.md");
        let linked = links(&text).filter(|link| !link.is_empty() && !folder.join(link).exists());
        let named = paths(&text).filter(|path| !history && !root().join(path).exists());
        let name = file.strip_prefix(root()).unwrap().display();
        lost.extend(linked.chain(named).map(|path| format!("{name}: {path}")));
    }
    assert!(lost.is_empty(), "these do not exist:\n{}", lost.join("\n"));
}

/// docs/performance.md begins with tables of the measured page on when synthesis pays. YORO_BLESS copies them again.
#[test]
fn when_it_pays_is_what_was_measured() {
    const BEGIN: &str = "<!-- when it pays: begin -->\n";
    const END: &str = "<!-- when it pays: end -->";
    let read = |path: &str| fs::read_to_string(root().join(path)).unwrap();
    let page = read("docs/results/shader-cost-frame.md");
    let (_, tables) = page.split_once("**Executed slots").expect("the first table");
    let (tables, rest) = tables.split_once("**Pass by pass").expect("the last table");
    let source = rest.lines().rfind(|line| line.starts_with("`yoro bench")).expect("command and machine");
    let expected = format!("**Executed slots{tables}{source}\n");
    let text = read("docs/performance.md");
    let (before, rest) = text.split_once(BEGIN).expect("the mark before the tables");
    let (there, after) = rest.split_once(END).expect("the mark behind the tables");
    if std::env::var_os("YORO_BLESS").is_some() {
        let renewed = format!("{before}{BEGIN}{expected}{END}{after}");
        fs::write(root().join("docs/performance.md"), renewed).unwrap();
    } else {
        assert_eq!(there, expected, "run this test with YORO_BLESS=1");
    }
}
