//! The guides of the site: the documents of the repository as HTML, in the same folders. A README becomes its folder's
//! `index.html`.

use std::collections::{BTreeMap, BTreeSet};
use std::ffi::OsStr;
use std::path::{Component, Path, PathBuf};

use pulldown_cmark::{CowStr, Event, Options, Parser, Tag, TagEnd, html};
use xtask::folders::{copy, read_text, root, write};

/// The folder of the guides in the site.
pub const FOLDER: &str = "guides";
/// The document from which all others are found.
const FIRST: &str = "README.md";

/// A page, with places for what is in it.
const PAGE: &str = include_str!("../site/page.html");

/// What each page of the site but the first has on top: a title, and a path in the site.
const PAGES: [(&str, &str); 6] = [
    ("Try it", "index.html"),
    ("How it works", "guides/docs/method.html"),
    ("Guides", "guides/index.html"),
    ("Rust API", "api/index.html"),
    ("Results", "guides/docs/results.html"),
    ("Downloads", "downloads.html"),
];

/// Writes the first document and all that can be reached from it, with pictures and other files that they link to.
pub fn write_all(site: &Path) -> anyhow::Result<()> {
    let out = site.join(FOLDER);
    let mut open = vec![PathBuf::from(FIRST)];
    let mut seen: BTreeSet<PathBuf> = open.iter().cloned().collect();
    while let Some(document) = open.pop() {
        let source = root().join(&document);
        if document.extension() != Some(OsStr::new("md")) {
            copy(&source, &out.join(&document))?;
            continue;
        }
        let text = read_text(&source)?;
        let mut linked = Vec::new();
        let guide = guide(&text, |target| {
            let (path, anchor) = target.split_once('#').map_or((target, ""), |(path, anchor)| (path, anchor));
            if path.is_empty() || path.contains("://") {
                return Some(target.to_owned());
            }
            let file = joined(document.parent().unwrap_or(Path::new("")), path)?;
            // Nothing lists a folder on every host.
            if root().join(&file).is_dir() {
                return None;
            }
            linked.push(file);
            let anchor = if anchor.is_empty() { String::new() } else { format!("#{anchor}") };
            Some(address(Path::new(path)) + &anchor)
        });
        let place = Path::new(FOLDER).join(address(&document));
        write_page(site, &place, &guide)?;
        open.extend(linked.into_iter().filter(|file| seen.insert(file.clone())));
    }
    Ok(())
}

/// Returns the site's path of a document's page; a file that is no document keeps its own.
fn address(document: &Path) -> String {
    let named = match document.file_name().and_then(OsStr::to_str) {
        Some("README.md") => document.with_file_name("index.html"),
        Some(name) if name.ends_with(".md") => document.with_extension("html"),
        _ => document.to_owned(),
    };
    named.display().to_string()
}

/// Returns the path from the root of a path from a folder. `None` if it leads out.
fn joined(folder: &Path, path: &str) -> Option<PathBuf> {
    let mut whole = PathBuf::new();
    for part in folder.join(path).components() {
        match part {
            Component::ParentDir => whole.pop().then_some(())?,
            Component::Normal(name) => whole.push(name),
            _ => {}
        }
    }
    Some(whole)
}

/// A document as HTML.
pub struct Guide {
    pub title: String,
    pub body: String,
}

/// Converts Markdown. `target` returns where a link leads on the site, or `None` if nowhere: then its text remains.
pub fn guide(text: &str, mut target: impl FnMut(&str) -> Option<String>) -> Guide {
    let options = Options::ENABLE_TABLES | Options::ENABLE_STRIKETHROUGH;
    let mut events: Vec<Event<'_>> = Vec::new();
    let (mut title, mut heading, mut is_link) = (String::new(), None, Vec::new());
    let mut anchors = BTreeMap::new();
    for event in Parser::new_ext(text, options) {
        match event {
            Event::Start(Tag::Link { link_type, dest_url, title, id }) => {
                let to = target(&dest_url).map(Into::into);
                is_link.push(to.is_some());
                let link = to.map(|dest_url| Event::Start(Tag::Link { link_type, dest_url, title, id }));
                events.extend(link);
            }
            Event::End(TagEnd::Link) => {
                if is_link.pop().unwrap_or(false) {
                    events.push(event);
                }
            }
            Event::Start(Tag::Image { link_type, dest_url, title, id }) => {
                let dest_url: CowStr<'_> = target(&dest_url).map_or(dest_url, Into::into);
                events.push(Event::Start(Tag::Image { link_type, dest_url, title, id }));
            }
            Event::Start(Tag::Table(_)) => {
                events.extend([Event::Html("<div class=\"table\">".into()), event])
            }
            Event::End(TagEnd::Table) => events.extend([event, Event::Html("</div>\n".into())]),
            Event::Start(Tag::Heading { .. }) => {
                heading = Some((events.len(), String::new()));
                events.push(event);
            }
            Event::End(TagEnd::Heading(_)) => {
                events.push(event);
                let Some((at, words)) = heading.take() else { continue };
                if let Some(Event::Start(Tag::Heading { id, .. })) = events.get_mut(at) {
                    let anchor = anchor(&words);
                    let count = anchors.entry(anchor.clone()).and_modify(|count| *count += 1).or_insert(0);
                    *id = Some(if *count == 0 { anchor } else { format!("{anchor}-{count}") }.into());
                }
                if title.is_empty() {
                    title = words;
                }
            }
            Event::Text(ref words) | Event::Code(ref words) => {
                if let Some((_, text)) = &mut heading {
                    text.push_str(words);
                }
                events.push(event);
            }
            _ => events.push(event),
        }
    }
    let mut body = String::new();
    html::push_html(&mut body, events.into_iter());
    // The page's policy allows no style in a document.
    for side in ["left", "center", "right"] {
        body = body.replace(&format!(" style=\"text-align: {side}\""), &format!(" class=\"{side}\""));
    }
    Guide { title, body }
}

/// Returns a heading's anchor: its words in lower case, without punctuation, joined by `-`.
fn anchor(heading: &str) -> String {
    let lower = heading.trim().to_lowercase();
    let kept = lower.chars().filter(|c| c.is_alphanumeric() || [' ', '-', '_'].contains(c));
    kept.map(|c| if c == ' ' { '-' } else { c }).collect()
}

/// Returns the links to the pages of the site, from a page at this path in it.
pub fn navigation(place: &Path) -> String {
    let up = up(place);
    let links = PAGES.map(|(title, path)| {
        let current = if Path::new(path) == place { " aria-current=\"page\"" } else { "" };
        format!("<a href=\"{up}{path}\"{current}>{title}</a>")
    });
    links.join("\n    ")
}

/// Writes a page of the site, at this path in it.
pub fn write_page(site: &Path, place: &Path, guide: &Guide) -> anyhow::Result<()> {
    write(&site.join(place), page(place, guide))
}

fn page(place: &Path, guide: &Guide) -> String {
    let title = guide.title.replace('&', "&amp;").replace('<', "&lt;");
    let values =
        [("UP", &up(place)), ("TITLE", &title), ("NAVIGATION", &navigation(place)), ("BODY", &guide.body)];
    values.iter().fold(PAGE.to_owned(), |page, (name, value)| page.replace(&format!("@{name}@"), value))
}

/// Returns the way from a page up to the site's root.
fn up(place: &Path) -> String {
    "../".repeat(place.components().count().saturating_sub(1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_tables_and_headings_are_converted() {
        let text = "# A & `b`\n\n[in](x.md#y), [gone](out)\n\n|a|\n|-:|\n|b|\n\n## Twice\n## Twice\n";
        let of = |target: &str| (target != "out").then(|| target.replace(".md", ".html"));
        let guide = guide(text, of);
        assert_eq!(guide.title, "A & b");
        let body = &guide.body;
        assert!(body.contains("<a href=\"x.html#y\">in</a>, gone"), "{body}");
        assert!(body.contains("<h1 id=\"a--b\">") && body.contains("<h2 id=\"twice-1\">"), "{body}");
        assert!(
            body.contains("<div class=\"table\"><table>") && body.contains("<td class=\"right\">b"),
            "{body}"
        );
        let page = page(Path::new("guides/docs/method.html"), &guide);
        assert!(page.contains("href=\"../../guides/docs/method.html\" aria-current=\"page\""), "{page}");
        assert!(page.contains("<title>A &amp; b</title>"), "{page}");
    }

    #[test]
    fn documents_have_pages_in_the_same_folders() {
        assert_eq!(address(Path::new("app/README.md")), "app/index.html");
        assert_eq!(address(Path::new("../docs/web.md")), "../docs/web.html");
        assert_eq!(address(Path::new("yoro.h")), "yoro.h");
        assert_eq!(joined(Path::new("app/engines"), "../../docs/a.md").unwrap(), Path::new("docs/a.md"));
        assert_eq!(joined(Path::new("docs"), "../../a.md"), None);
    }
}
