//! Keeps the floors of `app`: a crate uses crates of its own floor and of those below, never of one above; and each keeps
//! its budget of lines.

use std::path::Path;
use std::process::Command;

use serde_json::Value;

/// Each floor, and the one that it stands on. It may use that floor and whatever that one may use.
const FLOORS: [(&str, &str); 7] = [
    ("app/program", "app/lab"),
    ("app/lab", "app/vr"),
    ("android", "app/vr"),
    ("app/vr", "scenes"),
    ("scenes", "app/base"),
    ("app/base", "app/engines"),
    ("app/engines", "shaders-glsl"),
];
const CELLAR: &str = "shaders-glsl";
/// What stands beside the house: it may use everything, and no floor may use it.
const BESIDE: [&str; 2] = ["tests", "xtask"];
/// The workspaces.
const MANIFESTS: [&str; 2] = ["Cargo.toml", "app/engines/bevy/Cargo.toml"];

/// Thousands of lines of Rust that each floor may have. Room for a new thing is made by an old one; a change that needs more
/// changes this table, and its commit says why.
const LINES: [(&str, f64); 10] = [
    ("app/engines", 40.9),
    ("app/base", 10.8),
    ("app/vr", 29.4),
    ("app/lab", 18.4),
    ("app/program", 6.2),
    ("android", 4.7),
    ("scenes", 12.9),
    ("shaders-glsl", 0.3),
    ("tests", 23.6),
    ("xtask", 10.7),
];
/// Thousands of words that all documents may have, without the tables that are made of docs/results, which nobody writes.
const WORDS: f64 = 32.4;

/// A package, and what it compiles of this repository's packages, as folders.
struct Package {
    folder: String,
    uses: Vec<String>,
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap()
}

/// Returns a folder relative to the repository.
fn relative(path: &str) -> String {
    let path = Path::new(path);
    path.strip_prefix(root()).unwrap().display().to_string()
}

/// Reads the packages of a workspace. Dependencies of tests alone do not count.
fn packages(manifest: &str) -> Vec<Package> {
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo.args(["metadata", "--no-deps", "--format-version=1", "--manifest-path"]);
    let output = cargo.arg(root().join(manifest)).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let metadata: Value = serde_json::from_slice(&output.stdout).unwrap();
    let package = |package: &Value| {
        let compiled = |dependency: &&Value| dependency["kind"] != "dev";
        let uses = package["dependencies"].as_array().unwrap().iter().filter(compiled);
        Package {
            folder: relative(package["manifest_path"].as_str().unwrap().trim_end_matches("/Cargo.toml")),
            uses: uses.filter_map(|dependency| dependency["path"].as_str()).map(relative).collect(),
        }
    };
    metadata["packages"].as_array().unwrap().iter().map(package).collect()
}

/// Returns the floor that a folder belongs to, or `None` for what stands beside the house.
fn floor(folder: &str) -> Option<&'static str> {
    let floors = FLOORS.map(|(floor, _)| floor);
    let all = [&floors[..], &[CELLAR], &BESIDE].concat();
    let found = all.into_iter().find(|floor| Path::new(folder).starts_with(floor));
    let found = found.unwrap_or_else(|| panic!("{folder} is on no floor: name it in tests/tests/floors.rs"));
    (!BESIDE.contains(&found)).then_some(found)
}

/// True if a crate of one floor may use a crate of the other.
fn may_use(floor: &str, other: &str) -> bool {
    let below = || FLOORS.iter().find(|(above, _)| *above == floor);
    floor == other || below().is_some_and(|(_, below)| may_use(below, other))
}

#[test]
fn a_floor_uses_the_floors_below_it() {
    let mut wrong = Vec::new();
    for Package { folder, uses } in MANIFESTS.into_iter().flat_map(packages) {
        let Some(own) = floor(&folder) else { continue };
        let allowed = |used: &&String| floor(used).is_some_and(|other| may_use(own, other));
        let above = uses.iter().filter(|used| !allowed(used));
        wrong.extend(above.map(|used| format!("{folder} uses {used}")));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn the_house_is_as_it_is_drawn() {
    for (above, below) in [
        ("app/program", "app/lab"),
        ("app/lab", "app/engines"),
        ("android", "app/base"),
        ("app/vr", "scenes"),
        ("app/engines", "shaders-glsl"),
    ] {
        assert!(may_use(above, below), "{above} {below}");
        assert!(!may_use(below, above), "{below} {above}");
    }
    assert!(!may_use("android", "app/lab") && !may_use("app/lab", "android"));
}

/// Returns the files of the repository below a folder that have an ending, without those that git ignores.
fn files(folder: &str, ending: &str) -> Vec<String> {
    let ending = format!(".{ending}");
    let arguments = ["ls-files", "--cached", "--others", "--exclude-standard", "--", folder];
    let output = Command::new("git").current_dir(root()).args(arguments).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let names = String::from_utf8(output.stdout).unwrap();
    let names = names.lines().filter(|name| name.ends_with(&ending));
    names.filter_map(|name| std::fs::read_to_string(root().join(name)).ok()).collect()
}

/// Returns the number of words of a document outside of the tables of data.
fn written(document: &str) -> usize {
    let mut parts = document.split("<!-- table ");
    let first = parts.next().into_iter();
    let after = parts.map(|part| part.split_once("<!-- end -->").map_or(part, |(_, after)| after));
    first.chain(after).map(|part| part.split_whitespace().count()).sum()
}

#[test]
fn the_house_keeps_its_budget() {
    let thousands = |count: usize| count as f64 / 1e3;
    let mut over = Vec::new();
    for (floor, most) in LINES {
        let lines = thousands(files(floor, "rs").iter().map(|file| file.lines().count()).sum());
        println!("{floor}: {lines:.1} of {most:.1} thousand lines");
        if lines > most {
            over.push(format!("{floor} has {lines:.1} thousand lines of Rust, and {most:.1} is its budget"));
        }
    }
    let words = thousands(files(".", "md").iter().map(|file| written(file)).sum());
    if words > WORDS {
        over.push(format!("the documents have {words:.1} thousand words, and {WORDS:.1} is their budget"));
    }
    assert!(over.is_empty(), "{}: make room, or change the table and say why", over.join("; "));
}
