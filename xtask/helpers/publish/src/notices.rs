//! The notices that others' licences ask for: who wrote what is in a file, and under which terms.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use anyhow::Context as _;
use xtask::folders::{files, read, root};

use crate::licences::chosen;
use crate::packages::{self, Package};

/// A licence's name, and words that only its text has.
const MARKS: [(&str, &str); 7] = [
    ("MIT", "Permission is hereby granted, free of charge"),
    ("ISC", "Permission to use, copy, modify, and"),
    ("BSD-2-Clause", "Redistribution and use in source and binary forms"),
    ("BSD-3-Clause", "Redistribution and use in source and binary forms"),
    ("Zlib", "This software is provided"),
    ("Unicode-3.0", "UNICODE LICENSE"),
    ("BSL-1.0", "Boost Software License"),
];
const APACHE: &str = "Apache-2.0";
/// Folders are searched for licences down to this depth.
const MAX_DEPTH: usize = 2;
/// What else may be in a file: a package that contains it, its name, and its licence.
const MORE: [(&str, &str, &str); 1] =
    [("yoro-lenses", "The font B612 Mono (SIL Open Font License 1.1)", "app/vr/lenses/fonts/OFL.txt")];

/// Returns the notices of all that a package for a target contains, built with these arguments of cargo's.
pub fn text(package: &str, target: &str, features: &[&str]) -> anyhow::Result<String> {
    let known = packages::all("Cargo.toml")?;
    let contained = packages::contained(package, target, features)?;
    let mut notices = Notices::default();
    for package in contained.iter().filter_map(|key| known.get(key)) {
        notices.add(package)?;
    }
    for (user, title, file) in MORE {
        if contained.iter().any(|(name, _)| name == user) {
            let text = text_of(&root().join(file))?;
            notices.texts.entry(text).or_default().push(title.to_owned());
        }
    }
    notices.write()
}

/// Texts, each with the names of those to whom it belongs.
#[derive(Default)]
struct Notices {
    apache: Vec<String>,
    texts: BTreeMap<String, Vec<String>>,
}

impl Notices {
    fn add(&mut self, package: &Package) -> anyhow::Result<()> {
        let Package { name, version, folder, .. } = package;
        let licences: Vec<String> = chosen(package)?.iter().map(ToString::to_string).collect();
        let files = licence_files(folder);
        let title = format!("{name} {version} ({})", licences.join(" and "));
        let is_apache = |licence: &String| licence.starts_with(APACHE);
        if licences.iter().any(is_apache) {
            self.apache.push(format!("{name} {version}"));
        }
        if licences.iter().all(is_apache) {
            // Section 4d: the texts of NOTICE files have to be passed on.
            for file in files.iter().filter(|file| is_called(file, "NOTICE")) {
                self.texts.entry(text_of(file)?).or_default().push(format!("{title}, its NOTICE"));
            }
        }
        let texts = files.iter().map(|file| text_of(file)).collect::<anyhow::Result<Vec<_>>>()?;
        for licence in licences.iter().filter(|licence| !is_apache(licence)) {
            let mark = MARKS.iter().find(|(known, _)| known == licence).map(|(_, mark)| mark);
            let is_own = |text: &&String| mark.is_some_and(|mark| one_line(text).contains(mark));
            let mut own: Vec<String> = texts.iter().filter(is_own).cloned().collect();
            if own.is_empty() {
                own.push(standard(package, licence)?);
            }
            for text in own {
                let titles = self.texts.entry(text).or_default();
                if !titles.contains(&title) {
                    titles.push(title.clone());
                }
            }
        }
        Ok(())
    }

    fn write(mut self) -> anyhow::Result<String> {
        let line = "=".repeat(78);
        let mut out = include_str!("../site/NOTICES.txt").to_owned();
        // Writing to a string cannot fail.
        let _ = write!(out, "\n{line}\nUnder the Apache License 2.0:\n\n");
        self.apache.sort();
        self.apache.dedup();
        for name in &self.apache {
            let _ = writeln!(out, "  {name}");
        }
        // Our own copy, whose lines are not as long as paragraphs.
        let _ = write!(out, "\n{}\n", text_of(&root().join("LICENSE-APACHE"))?);
        let mut texts: Vec<(Vec<String>, String)> =
            self.texts.into_iter().map(|(text, titles)| (titles, text)).collect();
        texts.sort();
        for (titles, text) in texts {
            let _ = write!(out, "\n{line}\n{}\n\n{text}\n", titles.join("\n"));
        }
        Ok(out)
    }
}

/// Returns SPDX's text of a licence with the package's authors, for packages that do not carry the text.
fn standard(package: &Package, licence: &str) -> anyhow::Result<String> {
    let id = spdx::license_id(licence).with_context(|| format!("SPDX does not know {licence}"))?;
    let authors = match package.authors.as_slice() {
        [] => format!("the authors of {}", package.name),
        authors => authors.join(", "),
    };
    // Placeholders are in angle brackets.
    let text = clean(id.text());
    let lines = text.lines().map(|line| match line.starts_with("Copyright") && line.contains('<') {
        true => format!("Copyright (c) {authors}"),
        false => line.to_owned(),
    });
    Ok(lines.collect::<Vec<_>>().join("\n"))
}

/// Returns the files that are called like licences, in a folder and those in it.
fn licence_files(folder: &Path) -> Vec<PathBuf> {
    let is_near = |name: &str| name.matches('/').count() <= MAX_DEPTH;
    let found = files(folder).unwrap_or_default().into_iter();
    let paths = found.filter(|(name, _)| is_near(name)).map(|(_, path)| path);
    paths.filter(|path| ["LICEN", "COPYING", "NOTICE"].iter().any(|name| is_called(path, name))).collect()
}

fn is_called(file: &Path, beginning: &str) -> bool {
    file.file_name().is_some_and(|name| name.to_string_lossy().to_uppercase().starts_with(beginning))
}

fn text_of(file: &Path) -> anyhow::Result<String> {
    Ok(clean(&String::from_utf8_lossy(&read(file)?)))
}

/// Removes spaces at the ends of lines, and empty lines at the ends of the text.
fn clean(text: &str) -> String {
    let lines: Vec<&str> = text.trim_start_matches('\u{feff}').lines().map(str::trim_end).collect();
    lines.join("\n").trim_matches('\n').to_owned()
}

fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::licences::tests::package;

    #[test]
    fn a_package_keeps_its_own_text_and_one_without_gets_its_authors() {
        let folder = tempfile::tempdir().unwrap();
        let own = "Copyright (c) Ada\n\nPermission is hereby granted,  free\nof charge, to all.  \n";
        std::fs::write(folder.path().join("LICENSE-MIT"), own).unwrap();
        std::fs::write(folder.path().join("NOTICE"), "Thanks to Grace.").unwrap();
        let mut notices = Notices::default();
        let with = |licence: &str| Package { folder: folder.path().to_owned(), ..package(licence) };
        notices.add(&with("MIT")).unwrap();
        notices.add(&with("MIT OR Apache-2.0")).unwrap();
        let authors = vec!["Edsger".to_owned()];
        notices.add(&Package { authors, name: "other".into(), ..package("MIT") }).unwrap();
        let text = notices.write().unwrap();
        assert!(text.contains("some 1.0.0 (MIT)\n\nCopyright (c) Ada\n"), "{text}");
        assert!(text.contains("other 1.0.0 (MIT)\n") && text.contains("Copyright (c) Edsger\n"), "{text}");
        assert!(text.contains("Apache License 2.0:\n\n  some 1.0.0\n") && text.contains("Thanks to Grace."));
        assert!(Notices::default().add(&package("GPL-3.0-only")).is_err());
    }
}
