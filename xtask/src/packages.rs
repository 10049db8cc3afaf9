//! Debian packages, unpacked into a folder. apt gets a private state for this, and nothing is installed.

use std::fs;
use std::os::unix::fs::PermissionsExt as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::{Context as _, bail};

use crate::apt;
use crate::console::run;
use crate::folders::{files, make, write};

/// apt with a private state in which nothing is installed, and with this machine's or another distribution's sources.
pub struct PrivateApt {
    folder: PathBuf,
    /// The native architecture comes first.
    architectures: Vec<String>,
    sources: Option<PathBuf>,
}

impl PrivateApt {
    /// Fetches the lists of packages. Keeps all files in `folder`, which [`PrivateApt::unpack`] removes. `sources` are lines
    /// of a sources.list that replace this machine's.
    pub fn new(folder: PathBuf, architectures: &[&str], sources: Option<&str>) -> anyhow::Result<Self> {
        for tool in ["apt-get", "dpkg-deb", "tar"] {
            apt::find_program(tool)
                .with_context(|| format!("{tool} is not here: only Debian's packages have all of it"))?;
        }
        for path in ["state/lists/partial", "cache/archives/partial"] {
            make(&folder.join(path))?;
        }
        write(&folder.join("state/status"), "")?;
        let sources = sources.map(|lines| {
            let list = folder.join("sources.list");
            write(&list, lines).map(|()| list)
        });
        let sources = sources.transpose()?;
        let architectures = architectures.iter().map(|&name| name.to_owned()).collect();
        let apt = Self { folder, architectures, sources };
        let _turn = apt::turn();
        apt.get(&["update"])?;
        Ok(apt)
    }

    fn command(&self, program: &str, arguments: &[&str]) -> Command {
        let own = |path: &str| self.folder.join(path).display().to_string();
        let mut command = Command::new(program);
        let mut options = vec![
            format!("APT::Architecture={}", self.architectures[0]),
            format!("APT::Architectures={}", self.architectures.join(",")),
            // The user that apt switches to for downloads may have no access to this folder.
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
        run(self.command("apt-get", &["--quiet=2"]).args(arguments)).map(drop)
    }

    /// Returns the names of the packages that begin with `beginning`, one per line.
    pub fn names(&self, beginning: &str) -> anyhow::Result<String> {
        run(&mut self.command("apt-cache", &["pkgnames", beginning]))
    }

    /// Downloads packages and their dependencies, and returns the files. A package may be followed by `=VERSION`.
    pub fn download(&self, packages: &[String]) -> anyhow::Result<Vec<PathBuf>> {
        let mut arguments = vec!["install", "--yes", "--download-only", "--no-install-recommends"];
        arguments.extend(packages.iter().map(String::as_str));
        self.get(&arguments)?;
        let all = files(&self.folder.join("cache/archives"))?;
        Ok(all.into_iter().filter(|(name, _)| name.ends_with(".deb")).map(|(_, path)| path).collect())
    }

    /// Downloads packages with their dependencies, and unpacks them into `root`, apart from the patterns `without`.
    pub fn unpack(self, packages: &[String], root: &Path, without: &[&str]) -> anyhow::Result<()> {
        for package in self.download(packages)? {
            // qemu's packages contain a program of several megabytes for each kind of processor.
            let name = package.file_name().unwrap_or_default().to_string_lossy();
            let only: &[&str] =
                if name.starts_with("qemu-user") { &["./usr/bin/qemu-aarch64*"] } else { &[] };
            unpack(&package, root, only, without)?;
        }
        // The downloads take half of the space.
        fs::remove_dir_all(&self.folder).ok();
        Ok(())
    }
}

/// Unpacks a package's files into `root` without running any of its scripts: those that match one of the patterns
/// `only`, if there are any, and none of the patterns `without`.
pub fn unpack(package: &Path, root: &Path, only: &[&str], without: &[&str]) -> anyhow::Result<()> {
    // Newer distributions have all libraries below usr, and expect links to them in the root.
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

/// Returns lines of a sources.list for these Debian releases, from this machine's own mirror.
pub fn debian_sources(releases: &[&str]) -> anyhow::Result<String> {
    let arguments = ["indextargets", "--format", "$(REPO_URI) $(COMPONENT)", "Created-By: Packages"];
    let targets = run(Command::new("apt-get").args(arguments))?;
    let place = debian(&targets).context("this machine has no source of Debian's packages")?;
    let line = |release: &&str| {
        format!("deb [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] {place} {release} main\n")
    };
    Ok(releases.iter().map(line).collect())
}

/// Returns the URI of Debian itself among `URI component` lines, not that of its security updates or of a third party.
fn debian(targets: &str) -> Option<&str> {
    let mut places = targets.lines().filter_map(|line| line.split_once(' '));
    let is_debian = |place: &str| place.trim_end_matches('/').ends_with("/debian");
    places.find(|(place, component)| *component == "main" && is_debian(place)).map(|(place, _)| place)
}

/// Quotes a path for the shell.
pub fn quoted(path: &Path) -> String {
    format!("'{}'", path.display().to_string().replace('\'', r"'\''"))
}

/// Writes an executable shell script, with values for the names that are written `@NAME@` in its template.
pub fn fill_launcher(launcher: &Path, template: &str, values: &[(&str, &str)]) -> anyhow::Result<()> {
    let replace = |text: String, (name, value): &(&str, &str)| text.replace(&format!("@{name}@"), value);
    write_launcher(launcher, &values.iter().fold(template.to_owned(), replace))
}

/// Writes an executable shell script.
pub fn write_launcher(launcher: &Path, text: &str) -> anyhow::Result<()> {
    write(launcher, format!("#!/bin/sh\n{text}"))?;
    fs::set_permissions(launcher, fs::Permissions::from_mode(0o755))
        .with_context(|| format!("{} cannot be written", launcher.display()))
}
