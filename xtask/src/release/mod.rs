//! Everything that is published, in one folder: `cargo xtask release`.

mod items;
mod program;
mod summary;

use std::fs;
use std::path::{Path, PathBuf, absolute};
use std::process::Command;
use std::time::Instant;

use anyhow::{Context as _, bail};
use clap::ValueEnum as _;

use crate::apt::{self, Need};
use crate::console::run;
use crate::folders::{copy, copy_folder, make, remove, root, write};
use crate::rust::{self, Rust};
use crate::{setup, site, web};

pub use items::Item;

/// The checksums of all files, as `sha256sum --check` reads them.
pub const SUMS: &str = "SHA256SUMS";
/// What each file is for.
pub const SUMMARY: &str = "RELEASE.md";

/// Builds these items, or all if none is given, into a folder. Files of other items that are in it stay.
pub fn release(out: &Path, only: &[Item]) -> anyhow::Result<()> {
    let start = Instant::now();
    let out = absolute(out).context("the current folder is gone: change to another")?;
    make(&out)?;
    let is_wanted = |item: &&Item| only.is_empty() || only.contains(item);
    let items: Vec<Item> = Item::value_variants().iter().filter(is_wanted).copied().collect();
    let commit = commit(&out)?;
    check_origin(&out, &commit)?;
    apt::install_missing(needs, true)?;
    let mut times = Vec::new();
    for item in items.iter().filter(|item| **item != Item::Site) {
        let begin = Instant::now();
        println!("release: {}", item.name());
        for made in item.make()? {
            let name = made.file_name().context("a file without a name was made")?;
            if made.is_dir() {
                bail!("{} is a folder: it cannot be published", made.display());
            }
            copy(&made, &out.join(name))?;
        }
        // Now, so that the folder is complete if the next item fails.
        write_sums(&out)?;
        write(&out.join(SUMMARY), summary::text(&out, &commit)?)?;
        times.push((item.name(), begin.elapsed()));
    }
    if items.contains(&Item::Site) {
        let begin = Instant::now();
        println!("release: {}", Item::Site.name());
        let has_files = !files(&out)?.is_empty();
        let built = site::build(has_files.then_some(&*out))?;
        let folder = out.join("site");
        remove(&folder)?;
        copy_folder(&built, &folder)?;
        times.push((Item::Site.name(), begin.elapsed()));
    }
    for (name, time) in times {
        println!("{name:16} {:>5} s", time.as_secs());
    }
    println!("{} in {} s", out.display(), start.elapsed().as_secs());
    Ok(())
}

/// Returns what all items need beside a compiler.
fn needs() -> Vec<Need> {
    let rust = Rust::for_target(web::TRIPLE).map(|(rust, _)| rust);
    vec![
        Need::program("xz", &["xz-utils"]),
        Need::program("strip", &["binutils"]),
        setup::cpp(),
        // Without it, the program's encoder of H.264 has no code for this processor.
        Need::program("nasm", &["nasm"]),
        rust::source(rust.as_ref()),
    ]
}

/// Returns the commit that is built, and says if there are changes beside it, apart from the folder of the release.
fn commit(out: &Path) -> anyhow::Result<String> {
    let git = |arguments: &[&str]| {
        let text = run(Command::new("git").current_dir(root()).args(arguments));
        Ok::<_, anyhow::Error>(text.context("a release is built from a clone")?.trim().to_owned())
    };
    let commit = git(&["rev-parse", "HEAD"])?;
    let made = out.strip_prefix(root()).map(|folder| format!(":(exclude){}", folder.display()));
    let paths = [".".to_owned()].into_iter().chain(made).collect::<Vec<_>>();
    let mut status = vec!["status", "--porcelain", "--"];
    status.extend(paths.iter().map(String::as_str));
    let is_clean = git(&status)?.is_empty();
    Ok(if is_clean { commit } else { format!("{commit}, with changes that were not committed") })
}

/// Fails if the folder has files that were not built from this commit.
fn check_origin(out: &Path, commit: &str) -> anyhow::Result<()> {
    let known = fs::read_to_string(out.join(SUMMARY)).unwrap_or_default();
    if !files(out)?.is_empty() && !known.contains(&summary::origin(commit)) {
        bail!(
            "{} has files that were not built from {commit}: empty it, or name another folder by --out",
            out.display()
        );
    }
    Ok(())
}

/// Returns the files in the folder that are published, by name: not those that describe them.
fn files(out: &Path) -> anyhow::Result<Vec<PathBuf>> {
    let entries = fs::read_dir(out).with_context(|| format!("{} cannot be read", out.display()))?;
    let mut found = entries.map(|entry| Ok(entry?.path())).collect::<anyhow::Result<Vec<_>>>()?;
    found.retain(|path| path.is_file() && !path.ends_with(SUMS) && !path.ends_with(SUMMARY));
    found.sort();
    Ok(found)
}

/// Writes the checksums of all files.
fn write_sums(out: &Path) -> anyhow::Result<()> {
    let names = files(out)?.into_iter().filter_map(|path| path.file_name().map(ToOwned::to_owned));
    let sums = out.join(SUMS);
    write(&sums, run(Command::new("sha256sum").args(names).current_dir(out))?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_has_files_of_one_commit() {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path();
        let refusal = |commit: &str| check_origin(out, commit).err().map(|error| error.to_string());
        assert_eq!(refusal("abc"), None);
        write(&out.join("yoro-0.1.0.apk"), "").unwrap();
        assert!(refusal("abc").unwrap().contains("not built from abc: empty it"));
        write(&out.join(SUMMARY), summary::text(out, "abc").unwrap()).unwrap();
        assert_eq!(refusal("abc"), None);
        assert!(refusal("abc, with changes that were not committed").is_some() && refusal("ab").is_some());
    }
}
