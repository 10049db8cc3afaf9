//! The site: the page, the guides, rustdoc of the published crates, and what can be downloaded. Any static host can serve
//! it, from any folder.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::Context as _;

use crate::folders::{copy_folder, read_text, remove, target_folder, write};
use crate::{cargo, lint, web};

/// Builds the site, and returns its folder, `target/site`. `release` is a folder with the files of a release.
pub fn build(release: Option<&Path>) -> anyhow::Result<PathBuf> {
    let start = Instant::now();
    let target = target_folder()?;
    let (folder, unfinished) = (target.join("site"), target.join("site.part"));
    remove(&unfinished)?;
    copy_folder(&web::build_once()?, &unfinished)?;
    copy_folder(&api(&target.join("site-api"))?, &unfinished.join("api"))?;
    // rustdoc's pages have scripts in them, which the page's policy does not allow.
    let headers = unfinished.join("_headers");
    write(&headers, read_text(&headers)? + "/api/*\n  ! Content-Security-Policy\n")?;
    let place = unfinished.display().to_string();
    let release = release.map(|release| release.display().to_string());
    let arguments: Vec<&str> = ["site", &place].into_iter().chain(release.as_deref()).collect();
    cargo::helper("yoro-publish", &arguments)?;
    remove(&folder)?;
    fs::rename(&unfinished, &folder).with_context(|| format!("{} cannot be written", folder.display()))?;
    println!(
        "{}: copy it to any static host, into any folder; in {:.0} s",
        folder.display(),
        start.elapsed().as_secs_f64()
    );
    Ok(folder)
}

/// Documents the published crates, and returns the folder. The target folder is its own, since the other one has the
/// documentation of the whole workspace.
fn api(target: &Path) -> anyhow::Result<PathBuf> {
    let target_text = target.display().to_string();
    let mut arguments = vec!["doc", "--locked", "--no-deps", "--all-features", "--target-dir", &target_text];
    arguments.extend(lint::PUBLISHED.iter().flat_map(|name| ["--package", name]));
    cargo::perform(cargo::cargo().args(arguments), "the crates cannot be documented")?;
    Ok(target.join("doc"))
}
