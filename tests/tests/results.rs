//! The tables of measurements in the documents are made of the data in docs/results, by the report's own code.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use yoro_bench::bench::{BenchReport, Results};
use yoro_report::{Block, Section, Text, Tone};

const DOCUMENTS: [&str; 3] = ["docs/results.md", "docs/performance.md", "docs/streaming.md"];
/// The lines around a table: `<!-- table FILE: TITLE -->` with a file in docs/results, and this one.
const BEGIN: &str = "<!-- table ";
const END: &str = "<!-- end -->";

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap().to_owned()
}

/// Returns a table of a file of results, and how and where it was measured.
fn table(file: &str, title: &str) -> String {
    let path = root().join("docs/results").join(file);
    if path.extension().is_some_and(|extension| extension == "txt") {
        return printed(&fs::read_to_string(path).unwrap(), title);
    }
    let report = BenchReport::new(vec![Results::read(&path).unwrap()]).unwrap().report();
    let has_table = |section: &&Section| section.tables().any(|table| table.title == title);
    let section = report.sections.iter().find(has_table).unwrap_or_else(|| panic!("{file} lacks {title}"));
    let table = section.tables().find(|table| table.title == title).unwrap();
    let place = section.blocks.iter().rev().find_map(|block| match block {
        Block::Text(Text { text, tone: Tone::Quiet }) => Some(text),
        _ => None,
    });
    format!("{}\n{}\n", table.markdown(), place.expect("where it was measured"))
}

/// Returns a table of a report that was kept as Markdown.
fn printed(report: &str, title: &str) -> String {
    let begin = report.find(&format!("**{title}**")).unwrap_or_else(|| panic!("no table {title}"));
    let rest = &report[begin..];
    let end = rest.find("\n**").or_else(|| rest.find("\n#")).unwrap_or(rest.len());
    format!("{}\n", rest[..end].trim_end())
}

/// With YORO_BLESS in the environment, the tables are rewritten.
#[test]
fn the_documents_have_the_tables_of_the_data() {
    let mut used = BTreeSet::new();
    for document in DOCUMENTS {
        let path = root().join(document);
        let text = fs::read_to_string(&path).unwrap();
        let mut expected = String::new();
        let mut rest = text.as_str();
        while let Some(at) = rest.find(BEGIN) {
            let line = rest[at..].find('\n').unwrap() + at + 1;
            let mark = rest[at..line].trim().trim_start_matches(BEGIN).trim_end_matches(" -->");
            let (file, title) = mark.split_once(": ").unwrap();
            let end = line + rest[line..].find(END).unwrap_or_else(|| panic!("{mark} has no end"));
            expected += &format!("{}\n{}\n", &rest[..line], table(file, title));
            used.insert(file.to_owned());
            rest = &rest[end..];
        }
        expected += rest;
        if std::env::var_os("YORO_BLESS").is_some() {
            fs::write(path, expected).unwrap();
        } else {
            assert!(
                text == expected,
                "{document}: `cargo xtask maintain renew` writes the tables of the data"
            );
        }
    }
    let files = fs::read_dir(root().join("docs/results")).unwrap();
    let all = files.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    assert_eq!(used, all, "the files of docs/results that a document shows");
}
