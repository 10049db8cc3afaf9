//! What the site has beside the page and rustdoc: the guides, the downloads, and the way from one to the other.

use std::fs;
use std::path::Path;

use anyhow::Context as _;
use xtask::folders::{copy, read_text, root, write};
use xtask::release::{SUMMARY, SUMS};

use crate::guides;

/// The style sheet after the palette.
const STYLE: &str = include_str!("../site/style.css");
/// The page's place for the links to the other pages.
const PLACE: &str = "<!-- SITE -->";
/// The folder of the files of a release in the site.
const DOWNLOADS: &str = "downloads";
const NO_FILES: &str = "# Downloads\n\nThis copy of the site was made without the files of a release. `cargo xtask release` \
                        makes them: [what to build for whom](guides/index.html#downloads).\n";

/// Completes a folder that has the page and rustdoc. `release` is a folder with the files of a release.
pub fn complete(site: &Path, release: Option<&Path>) -> anyhow::Result<()> {
    guides::write_all(site)?;
    write(&site.join(guides::FOLDER).join("style.css"), style()?)?;
    let guide = |text: &str| guides::guide(text, |target| Some(target.to_owned()));
    guides::write_page(site, Path::new("api/index.html"), &guide(&crates(site)?))?;
    let text = match release {
        Some(release) => downloads(site, release)?,
        None => NO_FILES.to_owned(),
    };
    guides::write_page(site, Path::new("downloads.html"), &guide(&text))?;
    let page = site.join("index.html");
    let text = read_text(&page)?;
    let (before, after) = text.split_once(PLACE).with_context(|| format!("the page has no {PLACE}"))?;
    // The page itself is the first of the links.
    let links = guides::navigation(Path::new("index.html"));
    let links = links.split_once('\n').map_or("", |(_, others)| others).trim();
    write(&page, [before, links, after].concat())
}

/// Returns the list of the documented crates.
fn crates(site: &Path) -> anyhow::Result<String> {
    let folder = site.join("api");
    let entries = fs::read_dir(&folder).with_context(|| format!("{} cannot be read", folder.display()))?;
    let paths = entries.map(|entry| Ok(entry?.path())).collect::<anyhow::Result<Vec<_>>>()?;
    let crates = paths.iter().filter(|path| path.join("all.html").is_file());
    let mut names: Vec<_> = crates.filter_map(|path| path.file_name()?.to_str()).collect();
    names.sort_unstable();
    let lines: Vec<String> = names.iter().map(|name| format!("- [`{name}`]({name}/index.html)\n")).collect();
    Ok(format!("# Rust API\n\n{}", lines.concat()))
}

/// Returns the page's palette, and the style of the guides.
fn style() -> anyhow::Result<String> {
    let page = read_text(&root().join("app/vr/web/page/style.css"))?;
    let (palette, _) =
        page.split_once("\n* {").context("the page's style has no palette at its beginning")?;
    Ok(format!("{palette}\n{STYLE}"))
}

/// Copies the files of a release into the site, and returns their description.
fn downloads(site: &Path, release: &Path) -> anyhow::Result<String> {
    let (mut text, sums) = (read_text(&release.join(SUMMARY))?, read_text(&release.join(SUMS))?);
    let mut table = String::new();
    for (sum, name) in sums.lines().filter_map(|line| line.split_once("  ")) {
        copy(&release.join(name), &site.join(DOWNLOADS).join(name))?;
        text = text.replace(&format!("| `{name}` |"), &format!("| [`{name}`]({DOWNLOADS}/{name}) |"));
        table += &format!("| [`{name}`]({DOWNLOADS}/{name}) | `{sum}` |\n");
    }
    copy(&release.join(SUMS), &site.join(DOWNLOADS).join(SUMS))?;
    Ok(format!(
        "{text}\n## Checksums\n\n[{SUMS}]({DOWNLOADS}/{SUMS}):\n\n| file | SHA-256 |\n|---|---|\n{table}"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// rustdoc and the page's files are stand-ins here.
    #[test]
    fn pages_lead_to_each_other() {
        let folder = tempfile::tempdir().unwrap();
        let (site, release) = (folder.path().join("site"), folder.path().join("release"));
        write(&site.join("index.html"), format!("<nav>{PLACE}</nav>")).unwrap();
        write(&site.join("icon.svg"), "").unwrap();
        for name in ["index", "all"] {
            write(&site.join(format!("api/yoro/{name}.html")), "").unwrap();
        }
        complete(&site, None).unwrap();
        assert!(read_text(&site.join("api/index.html")).unwrap().contains("href=\"yoro/index.html\""));
        let page = read_text(&site.join("index.html")).unwrap();
        assert!(page.starts_with("<nav><a href=\"guides/docs/method.html\">How it works</a>"), "{page}");

        write(&site.join("index.html"), PLACE).unwrap();
        write(&release.join("yoro.apk"), "").unwrap();
        write(&release.join(SUMS), "e3b0  yoro.apk\n").unwrap();
        write(&release.join(SUMMARY), "# yoro\n\n| file |\n|---|\n| `yoro.apk` |\n").unwrap();
        complete(&site, Some(&release)).unwrap();
        assert!(read_text(&site.join("downloads.html")).unwrap().contains("href=\"downloads/yoro.apk\""));
    }
}
