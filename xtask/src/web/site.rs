//! The page's files on a host: one document, and a folder for each version of everything else. A tab that is open while
//! the page is updated therefore continues to find the files of its version.

use std::fs;
use std::hash::{DefaultHasher, Hasher as _};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::Context as _;
use yoro_files::http::POLICY;

use crate::folders::{self, copy, read, read_text, root};

/// The placeholder for the version in the page's sources.
pub const VERSION: &str = "VERSION";
/// The address of the project's repository in Cargo.toml. Empty if there is none.
const REPOSITORY: &str = env!("CARGO_PKG_REPOSITORY");
/// The source archive beside the page, which the page links to if there is no repository.
const ARCHIVE: &str = "yoro-source.tar.gz";
/// The files whose names do not depend on the version.
const LASTING: [&str; 8] = [
    "index.html",
    "offline.js",
    "icon.svg",
    "manifest.webmanifest",
    "example-color.jpg",
    "example-depth.png",
    "example.obj",
    "example.mtl",
];
/// The scripts that the page does not load as modules.
const SEPARATE: [&str; 7] = [
    "boot.js",
    "worker.js",
    "stream.js",
    "stream-worker.js",
    "video-worker.js",
    "decoding.js",
    "yoro_web_video.js",
];
/// Returns the folder of the page's sources.
pub fn sources() -> PathBuf {
    root().join("app/vr/web/page")
}

/// Completes a folder whose module is in [`VERSION`]: copies the page's sources, and names the version by a hash of it.
pub fn assemble(folder: &Path) -> anyhow::Result<()> {
    let unnamed = folder.join(VERSION);
    for path in files(&sources())? {
        let name = name(&path);
        copy(&path, &if LASTING.contains(&&*name) { folder.join(name) } else { unnamed.join(name) })?;
    }
    copy(&root().join("docs/pictures/web.jpg"), &folder.join("preview.jpg"))?;
    let source = match REPOSITORY {
        "" => archive(&folder.join(ARCHIVE)).then_some(ARCHIVE),
        address => Some(address),
    };
    let mut hash = DefaultHasher::new();
    let mut names = Vec::new();
    for path in files(&unnamed)? {
        hash.write(name(&path).as_bytes());
        hash.write(&read(&path)?);
        names.push(name(&path));
    }
    let version = format!("{:016x}", hash.finish());
    let named = folder.join(&version);
    fs::rename(&unnamed, &named).with_context(|| format!("{} cannot be written", named.display()))?;
    for name in ["index.html", "offline.js"] {
        let path = folder.join(name);
        let text = read_text(&path)?;
        folders::write(&path, fill(&text, &version, &names, source))?;
    }
    folders::write(&folder.join("_headers"), headers(&version))
}

/// Copies the built page into a folder that may hold earlier versions.
pub fn publish(built: &Path, out: &Path) -> anyhow::Result<()> {
    let mut all = folders::files(built)?;
    // The document comes last.
    all.sort_by_key(|(name, _)| name == "index.html");
    for (name, file) in all {
        copy(&file, &out.join(name))?;
    }
    println!("{}: copy it to any static host; earlier versions in it keep working", out.display());
    Ok(())
}

/// Inserts the version and its file names into a document or a script.
fn fill(text: &str, version: &str, names: &[String], source: Option<&str>) -> String {
    let scripts = names.iter().filter(|name| name.ends_with(".js") && !SEPARATE.contains(&name.as_str()));
    let modules: Vec<String> =
        scripts.map(|name| format!("<link rel=\"modulepreload\" href=\"{VERSION}/{name}\">")).collect();
    // Streams cannot work offline, so this file is not kept.
    let kept = names.iter().filter(|name| *name != "stream-worker.js");
    let list: Vec<String> = kept.map(|name| format!("'{VERSION}/{name}'")).collect();
    let source = source.map_or_else(String::new, |source| format!("<a href=\"{source}\">Source</a>"));
    text.replace("<!-- MODULES -->", &modules.join("\n"))
        .replace("/* FILES */", &list.join(", "))
        .replace("<!-- SOURCE -->", &source)
        .replace(VERSION, version)
}

/// Writes an archive of the committed source. Returns false without git, or outside of a repository.
fn archive(file: &Path) -> bool {
    let mut command = Command::new("git");
    command
        .current_dir(root())
        .args(["archive", "--format=tar.gz", "--prefix=yoro/", "--output"])
        .arg(file)
        .arg("HEAD");
    command.stderr(Stdio::null()).status().is_ok_and(|status| status.success())
}

/// Returns the HTTP headers that the page needs, in the format of Netlify and Cloudflare.
fn headers(version: &str) -> String {
    format!(
        "/*\n  Content-Security-Policy: {POLICY}\n  Cache-Control: no-cache\n\
         /{version}/*\n  ! Cache-Control\n  Cache-Control: public, max-age=31536000, immutable\n"
    )
}

/// Returns the files of a folder, without those of its folders, sorted by name.
fn files(folder: &Path) -> anyhow::Result<Vec<PathBuf>> {
    let found = folders::files(folder)?.into_iter();
    Ok(found.filter(|(name, _)| !name.contains('/')).map(|(_, path)| path).collect())
}

fn name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_earlier_version_stays_beside_the_new_one() {
        let folder = tempfile::tempdir().unwrap();
        let [built, out] = ["built", "out"].map(|name| folder.path().join(name));
        for version in ["one", "two"] {
            folders::remove(&built).unwrap();
            folders::write(&built.join(version).join("main.js"), version).unwrap();
            folders::write(&built.join("index.html"), version).unwrap();
            publish(&built, &out).unwrap();
        }
        let content = |name: &str| fs::read_to_string(out.join(name)).unwrap();
        assert_eq!(["one/main.js", "two/main.js", "index.html"].map(content), ["one", "two", "two"]);
    }

    #[test]
    fn every_file_is_asked_for_by_its_version() {
        let names = ["boot.js", "main.js", "yoro_web_bg.wasm"].map(str::to_owned);
        let page = fs::read_to_string(sources().join("index.html")).unwrap();
        let filled = fill(&page, "0123", &names, Some("source.tar.gz"));
        assert!(filled.contains("<a href=\"source.tar.gz\">Source</a>"));
        assert!(filled.contains("src=\"0123/boot.js\"") && !filled.contains(VERSION), "{filled}");
        assert_eq!(filled.matches("modulepreload").count(), 1);
        let offline = fs::read_to_string(sources().join("offline.js")).unwrap();
        assert!(fill(&offline, "0123", &names, None).contains("'0123/main.js', '0123/yoro_web_bg.wasm'"));
    }
}
