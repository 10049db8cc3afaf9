//! docs/features.toml says what works where: each tick names a test, and the documents' tables are made of it.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use serde::Deserialize;

/// The documents with a table, the folder that links in the list lead to from there, and whether the table is for those
/// who call yoro themselves.
const TABLES: [(&str, &str, bool); 2] =
    [("README.md", "docs/engines.md", false), ("docs/engines.md", "", true)];
/// The ways in that make these calls themselves.
const CALLERS: [&str; 5] = ["wgpu", "Vulkan", "OpenGL", "C", "kit"];
const MARKS: [char; 3] = ['¹', '²', '³'];

#[derive(Deserialize)]
struct List {
    ways: Vec<String>,
    feature: Vec<Feature>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Feature {
    name: String,
    /// True if only those who call yoro themselves need to know.
    #[serde(default)]
    calls: bool,
    works: BTreeMap<String, String>,
    #[serde(default)]
    missing: Vec<String>,
    #[serde(default)]
    yours: Vec<String>,
    #[serde(default)]
    notes: BTreeMap<String, String>,
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap().to_owned()
}

fn list() -> List {
    toml::from_str(&fs::read_to_string(root().join("docs/features.toml")).unwrap()).unwrap()
}

/// Returns a way's name, without its link.
fn plain(way: &str) -> &str {
    way.trim_start_matches('[').split(']').next().unwrap()
}

/// Returns the heads of a table's columns. Those who call yoro themselves have followed the links already.
fn heads(list: &List, calls: bool) -> Vec<&str> {
    let all = list.ways.iter().map(String::as_str);
    if calls { all.map(plain).filter(|way| CALLERS.contains(way)).collect() } else { all.collect() }
}

/// Returns a table, and a line with its notes.
fn table(list: &List, document: &str, calls: bool) -> String {
    let heads = heads(list, calls);
    let mut text = format!("| |{}|\n|---|{}\n", heads.join("|"), ":-:|".repeat(heads.len()));
    let mut notes: Vec<&str> = Vec::new();
    for feature in list.feature.iter().filter(|feature| feature.calls == calls) {
        let cell = |way: &&str| {
            let way = plain(way);
            let mark = match feature.works.contains_key(way) {
                true => "✓",
                false if feature.missing.iter().any(|missing| missing == way) => "–",
                false => "·",
            };
            let note = feature.notes.get(way).map(|note| {
                let known = notes.iter().position(|known| known == note);
                MARKS[known.unwrap_or_else(|| {
                    notes.push(note);
                    notes.len() - 1
                })]
            });
            note.map_or_else(|| mark.to_owned(), |note| format!("{mark} {note}"))
        };
        let cells: Vec<String> = heads.iter().map(cell).collect();
        let name = feature.name.replace("](#", &format!("]({document}#"));
        text += &format!("| {name} |{}|\n", cells.join("|"));
    }
    let notes: Vec<String> = MARKS.iter().zip(notes).map(|(mark, note)| format!("{mark} {note}")).collect();
    format!("{text}\n{}\n", notes.join(" "))
}

/// With YORO_BLESS in the environment, the tables are rewritten.
#[test]
fn the_documents_have_the_tables() {
    let list = list();
    for (file, document, calls) in TABLES {
        let path = root().join(file);
        let text = fs::read_to_string(&path).unwrap();
        let first = heads(&list, calls)[0];
        let begin = text.find(&format!("| |{first}|")).unwrap_or_else(|| panic!("{file} has no such table"));
        let line = |from: usize| from + text[from..].find("\n\n").unwrap() + 2;
        // The table, and the paragraph with its notes.
        let end = line(line(begin)) - 1;
        let expected = table(&list, document, calls);
        if std::env::var_os("YORO_BLESS").is_some() {
            fs::write(path, format!("{}{expected}{}", &text[..begin], &text[end..])).unwrap();
        } else {
            assert_eq!(text[begin..end], expected, "{file}: `cargo xtask maintain renew` renews it");
        }
    }
}

#[test]
fn what_works_has_a_test() {
    let list = list();
    for feature in &list.feature {
        let mut told: Vec<&str> = feature.works.keys().map(String::as_str).collect();
        told.extend(feature.missing.iter().chain(&feature.yours).map(String::as_str));
        told.sort_unstable();
        let mut every: Vec<&str> = heads(&list, feature.calls).into_iter().map(plain).collect();
        every.sort_unstable();
        assert_eq!(told, every, "{}: each way once", feature.name);
        assert!(feature.notes.keys().all(|way| told.contains(&way.as_str())), "{}", feature.name);
        for test in feature.works.values() {
            let (file, name) = test.split_once("::").unwrap();
            let text =
                fs::read_to_string(root().join(file)).unwrap_or_else(|error| panic!("{file}: {error}"));
            // Godot's tests are rows of a table, with their names in quotes.
            let has_it =
                |line: &str| line.contains(&format!("fn {name}(")) || line.contains(&format!("\"{name}\""));
            assert!(text.lines().any(has_it), "{}: {file} has no test {name}", feature.name);
        }
    }
}
