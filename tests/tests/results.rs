//! The tables and plots of measurements in the documents are made of the data in docs/results, by the report's own code.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use yoro_bench::bench::{BenchReport, Results};
use yoro_report::{Block, Report, Text, Tone};

const DOCUMENTS: [&str; 2] = ["docs/results.md", "docs/performance.md"];
/// The line before a table: `<!-- table FILE: TITLE -->` with a file in docs/results.
const TABLE: &str = "<!-- table ";
/// The line after a table.
const END: &str = "<!-- end -->";
/// The line before a picture of a plot: `<!-- plot FILE: TITLE -->`.
const PLOT: &str = "<!-- plot ";

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap().to_owned()
}

fn report(file: &str) -> Report {
    let path = root().join("docs/results").join(file);
    BenchReport::new(vec![Results::read(&path).unwrap()]).unwrap().report()
}

/// Returns a table of a file of results, and how and where it was measured.
fn table(file: &str, title: &str) -> String {
    if file.ends_with(".txt") {
        return printed(&fs::read_to_string(root().join("docs/results").join(file)).unwrap(), title);
    }
    let sections = report(file).sections;
    let tables = sections.iter().flat_map(|section| section.tables().map(move |table| (section, table)));
    let found = tables.into_iter().find(|(_, table)| table.title == title);
    let (section, table) = found.unwrap_or_else(|| panic!("{file} lacks {title}"));
    let place = section.blocks.iter().rev().find_map(|block| match block {
        Block::Text(Text { text, tone: Tone::Quiet }) => Some(text),
        _ => None,
    });
    format!("{}\n{}\n", table.markdown(), place.expect("where it was measured"))
}

/// Returns the drawing of a plot of a file of results.
fn plot(file: &str, title: &str) -> String {
    let sections = report(file).sections;
    let mut plots = sections.iter().flat_map(|section| section.plots());
    plots.find(|plot| plot.title == title).unwrap_or_else(|| panic!("{file} lacks {title}")).to_svg().unwrap()
}

/// Returns a table of a report that was kept as Markdown.
fn printed(report: &str, title: &str) -> String {
    let begin = report.find(&format!("**{title}**")).unwrap_or_else(|| panic!("no table {title}"));
    let rest = &report[begin..];
    let end = rest.find("\n**").or_else(|| rest.find("\n#")).unwrap_or(rest.len());
    format!("{}\n", rest[..end].trim_end())
}

/// Writes a file if YORO_BLESS is in the environment, and otherwise compares it.
fn check(path: &Path, expected: &str) {
    if std::env::var_os("YORO_BLESS").is_some() {
        fs::write(path, expected).unwrap();
    } else {
        let same = fs::read_to_string(path).is_ok_and(|present| present == expected);
        assert!(same, "{}: `cargo xtask maintain renew` makes it of the data", path.display());
    }
}

#[test]
fn the_documents_have_the_tables_and_plots_of_the_data() {
    let mut used = BTreeSet::new();
    for document in DOCUMENTS {
        let path = root().join(document);
        let text = fs::read_to_string(&path).unwrap();
        let mut expected = String::new();
        let mut rest = text.as_str();
        while let Some(at) = rest.find(TABLE).into_iter().chain(rest.find(PLOT)).min() {
            let line = rest[at..].find('\n').unwrap() + at + 1;
            let (is_table, mark) = match rest[at..line].strip_prefix(TABLE) {
                Some(mark) => (true, mark),
                None => (false, &rest[at + PLOT.len()..line]),
            };
            let (file, title) = mark.trim().trim_end_matches(" -->").split_once(": ").unwrap();
            used.insert(file.to_owned());
            expected += &rest[..line];
            rest = &rest[line..];
            if is_table {
                expected += &format!("{}\n", table(file, title));
                rest = &rest[rest.find(END).unwrap_or_else(|| panic!("{title} has no end"))..];
            } else {
                let (_, picture) = rest.split_once("](").unwrap();
                let picture = picture.split(')').next().unwrap();
                check(&path.with_file_name(picture), &plot(file, title));
            }
        }
        check(&path, &(expected + rest));
    }
    let files = fs::read_dir(root().join("docs/results")).unwrap();
    let all = files.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    assert_eq!(used, all, "the files of docs/results that a document shows");
}

/// What a view must cost for synthesis to be worth it is said in sentences, too.
#[test]
fn sentences_have_the_figures_of_the_estimate() {
    let estimate = fs::read_to_string(root().join("docs/results/estimate.txt")).unwrap();
    let table = printed(&estimate, "Synthesis is worth it when a view costs the GPU more than this, in ms");
    let row = |frames: &str| -> Vec<&str> {
        let row = table.lines().find_map(|line| line.strip_prefix(&format!("| {frames} | **`yoro`** |")));
        row.unwrap().trim_end_matches('|').split('|').map(str::trim).collect()
    };
    let (bloom, none) = (row("bloom"), row("no bloom"));
    let [quest_2, quest_3, frame] = [0, 1, 2].map(|i| bloom[i]);
    let sentences = [
        ("README.md", format!("{quest_3} ms on a Quest 3 or {quest_2} ms on a Quest 2")),
        (
            "docs/performance.md",
            format!("{quest_2} ms on a Quest 2, {quest_3} on a Quest 3, {frame} on a Steam Frame"),
        ),
        ("docs/performance.md", format!("(without bloom {}, {}, {}", none[0], none[1], none[2])),
    ];
    for (document, sentence) in sentences {
        let text = fs::read_to_string(root().join(document)).unwrap();
        let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(words.contains(&sentence), "{document} does not say: {sentence}");
    }
}
