//! Debian's packages, unpacked in a folder of their own: apt gets its own state for that, and nothing is installed.

use std::fs;
use std::io::Write as _;
use std::os::unix::fs::PermissionsExt as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::{Context as _, bail};

use crate::apt;

/// apt with this machine's sources, or another distribution's, but with a state of its own: for it nothing is
/// installed.
pub struct PrivateApt {
    folder: PathBuf,
    /// The first is the usual one.
    architectures: Vec<String>,
    sources: Option<PathBuf>,
}

impl PrivateApt {
    /// Keeps everything in `folder`, which [`PrivateApt::remove`] removes. `sources` are lines of a sources.list, in
    /// place of this machine's.
    ///
    /// # Errors
    /// Without Debian's tools, or when the folder cannot be written.
    pub fn new(folder: PathBuf, architectures: &[&str], sources: Option<&str>) -> anyhow::Result<Self> {
        for tool in ["apt-get", "dpkg-deb", "tar"] {
            apt::find_program(tool)
                .with_context(|| format!("{tool} is not here: only Debian's packages have all of it"))?;
        }
        for path in ["state/lists/partial", "cache/archives/partial"] {
            let path = folder.join(path);
            fs::create_dir_all(&path).with_context(|| format!("{} cannot be made", path.display()))?;
        }
        let write = |name: &str, text: &str| {
            let path = folder.join(name);
            fs::write(&path, text).with_context(|| format!("{} cannot be written", path.display()))?;
            Ok::<PathBuf, anyhow::Error>(path)
        };
        write("state/status", "")?;
        let sources = sources.map(|lines| write("sources.list", lines)).transpose()?;
        let architectures = architectures.iter().map(|&name| name.to_owned()).collect();
        Ok(Self { folder, architectures, sources })
    }

    fn command(&self, program: &str, arguments: &[&str]) -> Command {
        let own = |path: &str| self.folder.join(path).display().to_string();
        let mut command = Command::new(program);
        let mut options = vec![
            format!("APT::Architecture={}", self.architectures[0]),
            format!("APT::Architectures={}", self.architectures.join(",")),
            // The user that root's apt downloads as may not see this folder.
            "APT::Sandbox::User=root".to_owned(),
            "Acquire::Languages=none".to_owned(),
            "Acquire::Retries=3".to_owned(),
            format!("Dir::State={}", own("state")),
            format!("Dir::State::status={}", own("state/status")),
            format!("Dir::Cache={}", own("cache")),
        ];
        if let Some(sources) = &self.sources {
            options.push(format!("Dir::Etc::sourcelist={}", sources.display()));
            options.push("Dir::Etc::sourceparts=/dev/null".to_owned());
            options.push("Dir::Etc::preferencesparts=/dev/null".to_owned());
        }
        for option in options {
            command.args(["-o", &option]);
        }
        command.args(arguments).stdin(Stdio::null());
        command
    }

    fn get(&self, arguments: &[&str]) -> anyhow::Result<()> {
        eprintln!("$ apt-get {} (into {})", arguments.join(" "), self.folder.display());
        let output = self
            .command("apt-get", &["--quiet=2"])
            .args(arguments)
            .output()
            .context("apt-get cannot be started")?;
        if !output.status.success() {
            bail!("apt-get {} failed: {}", arguments[0], String::from_utf8_lossy(&output.stderr).trim());
        }
        Ok(())
    }

    /// Fetches the lists of packages.
    ///
    /// # Errors
    /// When apt-get fails.
    pub fn update(&self) -> anyhow::Result<()> {
        let _turn = apt::turn();
        self.get(&["update"])
    }

    /// The names of the packages that begin so, one per line.
    ///
    /// # Errors
    /// When apt-cache cannot be started.
    pub fn names(&self, beginning: &str) -> anyhow::Result<String> {
        let names = self.command("apt-cache", &["pkgnames", beginning]).output();
        let names = names.context("apt-cache cannot be started")?.stdout;
        Ok(String::from_utf8_lossy(&names).into_owned())
    }

    /// Downloads packages and all that they need, and returns their files. A package may be followed by `=VERSION`.
    ///
    /// # Errors
    /// When apt-get fails.
    pub fn download(&self, packages: &[String]) -> anyhow::Result<Vec<PathBuf>> {
        let mut arguments = vec!["install", "--yes", "--download-only", "--no-install-recommends"];
        arguments.extend(packages.iter().map(String::as_str));
        self.get(&arguments)?;
        let archives = self.folder.join("cache/archives");
        let entries =
            fs::read_dir(&archives).with_context(|| format!("{} cannot be read", archives.display()))?;
        let files = entries.flatten().map(|entry| entry.path());
        Ok(files.filter(|path| path.extension().is_some_and(|extension| extension == "deb")).collect())
    }

    /// Removes what was downloaded: unpacked packages are not needed twice.
    pub fn remove(self) {
        fs::remove_dir_all(&self.folder).ok();
    }
}

/// Puts a package's files into `root`, without running anything of it: those that fit one of the patterns `only`, if
/// there are any, and none of the patterns `without`.
///
/// # Errors
/// When the package is damaged, or there is no room.
pub fn unpack(package: &Path, root: &Path, only: &[&str], without: &[&str]) -> anyhow::Result<()> {
    // Newer distributions have all libraries below usr and expect links beside it.
    if !root.exists() {
        fs::create_dir_all(root.join("usr/lib"))
            .and_then(|()| fs::create_dir_all(root.join("usr/lib64")))
            .and_then(|()| std::os::unix::fs::symlink("usr/lib", root.join("lib")))
            .and_then(|()| std::os::unix::fs::symlink("usr/lib64", root.join("lib64")))
            .with_context(|| format!("{} cannot be made", root.display()))?;
    }
    let mut archive = Command::new("dpkg-deb")
        .arg("--fsys-tarfile")
        .arg(package)
        .stdout(Stdio::piped())
        .spawn()
        .context("dpkg-deb cannot be started")?;
    let tar = archive.stdout.take().context("dpkg-deb's output cannot be read")?;
    let mut extract = Command::new("tar");
    extract.args(["--extract", "--keep-directory-symlink", "--no-same-owner", "--directory"]).arg(root);
    extract.arg("--wildcards").args(without.iter().map(|pattern| format!("--exclude={pattern}"))).args(only);
    let extracted = extract.stdin(tar).status().context("tar cannot be started")?;
    let read = archive.wait().context("dpkg-deb is gone")?;
    if !extracted.success() || !read.success() {
        bail!("{} cannot be unpacked", package.display());
    }
    Ok(())
}

/// Releases of Debian at the place that this machine has its own Debian from, as lines of a sources.list.
///
/// # Errors
/// When this machine knows no such place.
pub fn debian_sources(releases: &[&str]) -> anyhow::Result<String> {
    let targets = Command::new("apt-get")
        .args(["indextargets", "--format", "$(REPO_URI) $(COMPONENT)", "Created-By: Packages"])
        .output()
        .context("apt-get cannot be started")?
        .stdout;
    let targets = String::from_utf8_lossy(&targets).into_owned();
    let place = debian(&targets).context("this machine has no source of Debian's packages")?;
    let line = |release: &&str| {
        format!("deb [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] {place} {release} main\n")
    };
    Ok(releases.iter().map(line).collect())
}

/// Returns the place of Debian itself among `place component` lines: not that of its security updates, nor somebody
/// else's.
fn debian(targets: &str) -> Option<&str> {
    let mut places = targets.lines().filter_map(|line| line.split_once(' '));
    let is_debian = |place: &str| place.trim_end_matches('/').ends_with("/debian");
    places.find(|(place, component)| *component == "main" && is_debian(place)).map(|(place, _)| place)
}

/// A path as a word of the shell.
pub fn quoted(path: &Path) -> String {
    format!("'{}'", path.display().to_string().replace('\'', r"'\''"))
}

/// Writes a program for the shell.
///
/// # Errors
/// When the file cannot be written.
pub fn write_launcher(launcher: &Path, text: &str) -> anyhow::Result<()> {
    fs::File::create(launcher)
        .and_then(|mut file| {
            file.write_all(format!("#!/bin/sh\n{text}").as_bytes())?;
            file.set_permissions(fs::Permissions::from_mode(0o755))
        })
        .with_context(|| format!("{} cannot be written", launcher.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn debian_itself_is_found_among_the_sources() {
        let targets = "https://example.org/apt main\nhttp://example.com/debian-security/ main\n\
                       http://example.com/debian/ contrib\nhttp://example.com/debian/ main\n";
        assert_eq!(debian(targets), Some("http://example.com/debian/"));
        assert_eq!(debian("http://example.com/ubuntu/ main\n"), None);
    }
}
