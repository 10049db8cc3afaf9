//! The licences of others: what dependencies may have, and the notices that go along with each file that contains them.

use std::path::Path;
use std::process::Command;

use anyhow::{Context as _, bail};

use crate::{cargo, console};

/// The name of the notices in archives, in the APK and beside the page.
pub const FILE: &str = "NOTICES.txt";

/// Returns the notices of everything that a package contains for a target, built with these arguments of cargo's.
///
/// # Errors
/// Fails if a licence is not accepted, or cargo fails.
pub fn text(package: &str, target: &str, features: &[&str]) -> anyhow::Result<String> {
    let arguments = [&["notices", package, target], features].concat();
    let (text, _) = cargo::helper("yoro-publish", &arguments)?;
    Ok(text)
}

/// Opens an archive, and looks in its notices for those of these packages. Without a package, does nothing.
///
/// # Errors
/// Fails if some are missing.
pub fn check(archive: &Path, packages: &[&str]) -> anyhow::Result<()> {
    if packages.is_empty() {
        return Ok(());
    }
    let pattern = format!("*{FILE}");
    let is_tar = archive.extension().is_some_and(|extension| extension == "xz");
    let mut command = Command::new(if is_tar { "tar" } else { "unzip" });
    command.args(if is_tar { &["--extract", "--to-stdout", "--wildcards", "--file"][..] } else { &["-p"] });
    let text = console::run(command.arg(archive).arg(pattern));
    let text = text.with_context(|| format!("{FILE} of {} cannot be read", archive.display()))?;
    let has = |name: &str| text.lines().any(|line| line.trim_start().starts_with(&format!("{name} ")));
    if let Some(missing) = packages.iter().find(|name| !has(name)) {
        bail!("{} lacks the notice of {missing}", archive.display());
    }
    Ok(())
}

/// Checks the licences of all dependencies, and prints those that are not accepted. Returns true if all are.
///
/// # Errors
/// Fails if cargo fails.
pub fn are_accepted() -> anyhow::Result<bool> {
    let (report, passed) = cargo::helper("yoro-publish", &["licences"])?;
    console::print(&report);
    Ok(passed)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::folders::write;
    use crate::package::linux::tar;

    #[test]
    fn an_archive_without_a_notice_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let of = |text: &str| {
            write(&folder.path().join("packed/share").join(FILE), text).unwrap();
            check(&tar(folder.path(), "packed").unwrap(), &["glow", "ash"]).map_err(|error| error.to_string())
        };
        assert_eq!(of("Notices\n\n  glow 0.18.0\n\nash 0.38 (MIT)\n"), Ok(()));
        assert!(of("Notices\n\n  glow 0.18.0\n").unwrap_err().contains("lacks the notice of ash"));
        let cut = folder.path().join("cut.zip");
        write(&cut, "PK").unwrap();
        assert!(check(&cut, &["glow"]).unwrap_err().to_string().contains("cut.zip cannot be read"));
    }
}
