//! Checks that all links in the pages of a folder lead to something in it.

use std::cell::OnceCell;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Component, Path, PathBuf};

use anyhow::Context as _;
use html5gum::{DefaultEmitter, Token, Tokenizer};

/// What a page has.
#[derive(Default)]
struct Page {
    links: BTreeSet<String>,
    anchors: BTreeSet<String>,
    /// It only leads to another page, by a script that keeps the anchor.
    leads_on: bool,
}

/// Checks all links but those to other sites, which must be relative, so that the folder works at any address. Returns the
/// report, and true if each leads to a file, and to an anchor in it if it names one.
///
/// # Errors
/// Fails if the folder cannot be read.
pub fn check(folder: &Path) -> anyhow::Result<(String, bool)> {
    let mut paths = Vec::new();
    find(folder, &mut paths)?;
    let mut pages: BTreeMap<PathBuf, Page> = BTreeMap::new();
    for path in paths {
        let text = fs::read(&path).with_context(|| format!("{} cannot be read", path.display()))?;
        pages.insert(path, read(&text));
    }
    let mut problems = Vec::new();
    let mut count = 0;
    for (path, page) in &pages {
        let name = OnceCell::new();
        // rustdoc asks for lists of more implementations whether or not there are any.
        let is_followed = |link: &&String| !is_elsewhere(link) && !link.contains("trait.impl/");
        for link in page.links.iter().filter(is_followed) {
            count += 1;
            if let Err(problem) = follow(folder, path, link, &pages) {
                let name = name.get_or_init(|| path.strip_prefix(folder).unwrap_or(path).display());
                problems.push(format!("{name}: {link} {problem}\n"));
            }
        }
    }
    let passed = problems.is_empty() && count > 0;
    problems.push(format!("{count} links of {} pages followed\n", pages.len()));
    Ok((problems.concat(), passed))
}

fn follow(
    folder: &Path,
    page: &Path,
    link: &str,
    pages: &BTreeMap<PathBuf, Page>,
) -> Result<(), &'static str> {
    let (path, anchor) = link.split_once('#').unwrap_or((link, ""));
    let path = path.split('?').next().unwrap_or_default().replace("%20", " ");
    if path.starts_with('/') {
        return Err("is not relative");
    }
    let mut target = page.to_owned();
    if !path.is_empty() {
        target.pop();
        for part in Path::new(&path).components() {
            match part {
                Component::ParentDir => _ = target.pop(),
                Component::Normal(name) => target.push(name),
                _ => {}
            }
        }
    }
    if !target.starts_with(folder) {
        return Err("leads out of the site");
    }
    if target.is_dir() {
        target.push("index.html");
    }
    if !target.is_file() {
        return Err("leads nowhere");
    }
    // Lines in rustdoc's sources, such as `#10-20`, are anchors of its script.
    let is_lines = anchor.starts_with(|c: char| c.is_ascii_digit());
    match pages.get(&target) {
        Some(found) if !anchor.is_empty() && !is_lines && !found.leads_on => {
            found.anchors.contains(anchor).then_some(()).ok_or("names an anchor that is not there")
        }
        _ => Ok(()),
    }
}

/// True if a link has a scheme, such as `https:` or `data:`.
fn is_elsewhere(link: &str) -> bool {
    let scheme = link.split_once(':').map_or("", |(scheme, _)| scheme);
    !scheme.is_empty() && scheme.chars().all(|c| c.is_ascii_alphanumeric() || c == '+')
}

fn find(folder: &Path, found: &mut Vec<PathBuf>) -> anyhow::Result<()> {
    for entry in fs::read_dir(folder).with_context(|| format!("{} cannot be read", folder.display()))? {
        let path = entry?.path();
        if path.is_dir() {
            find(&path, found)?;
        } else if path.extension().is_some_and(|extension| extension == "html") {
            found.push(path);
        }
    }
    Ok(())
}

/// Reads the links and the anchors of a page.
fn read(text: &[u8]) -> Page {
    let mut page = Page::default();
    let mut emitter: DefaultEmitter = DefaultEmitter::default();
    // What looks like tags in scripts is none.
    emitter.naively_switch_states(true);
    for Ok(token) in Tokenizer::new_with_emitter(text, emitter) {
        let Token::StartTag(tag) = token else { continue };
        for (name, value) in &tag.attributes {
            let value = String::from_utf8_lossy(&value.value).into_owned();
            match name.as_slice() {
                b"href" | b"src" | b"poster" | b"data" => _ = page.links.insert(value),
                b"id" => _ = page.anchors.insert(value),
                b"http-equiv" => page.leads_on |= value == "refresh",
                b"name" if tag.name.as_slice() == b"a" => _ = page.anchors.insert(value),
                _ => {}
            }
        }
    }
    page
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_leads_nowhere_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str, text: &str| xtask::folders::write(&folder.path().join(name), text).unwrap();
        write(
            "a/index.html",
            "<h2 id=there>x</h2><a href='../b.html?q#one'><img src=\"p.png\"></a><script>'<a href=c>'</script>",
        );
        write("a/p.png", "");
        write("b.html", "<a id='one' href='a#there'>x</a><a href=https://elsewhere.example>y</a>");
        let (report, passed) = check(folder.path()).unwrap();
        assert!(passed, "{report}");
        assert_eq!(report, "3 links of 2 pages followed\n");
        let wrong = ["/b.html", "c.html", "a#gone", "../x"].map(|to| format!("<a href='{to}'>x</a>"));
        write("b.html", &format!("<p id=one>{}", wrong.concat()));
        let (report, passed) = check(folder.path()).unwrap();
        assert!(!passed);
        for problem in
            ["/b.html is not relative", "c.html leads nowhere", "a#gone names an anchor", "../x leads out"]
        {
            assert!(report.contains(&format!("b.html: {problem}")), "{report}");
        }
    }
}
