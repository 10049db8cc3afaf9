//! Programs of the system, and apt, which brings them.

use std::env;
use std::ffi::OsStr;
use std::io::{self, IsTerminal as _, Write as _};
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::sync::{Mutex, MutexGuard, PoisonError};

use anyhow::{Context as _, bail};

/// Whoever updates lists or installs holds this. Debian's container images run a hook after every update, even that of
/// a private state, which removes all packages that wait for installation.
static TURN: Mutex<()> = Mutex::new(());

/// Waits until no other thread updates lists or installs.
pub fn turn() -> MutexGuard<'static, ()> {
    TURN.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The file that a command's name stands for.
pub fn find_program(name: impl AsRef<OsStr>) -> Option<PathBuf> {
    let path = env::var_os("PATH")?;
    env::split_paths(&path).map(|folder| folder.join(name.as_ref())).find(|program| program.is_file())
}

/// Whether [`install`] can do its work without asking anybody for anything.
pub fn installs_by_itself() -> bool {
    is_root() && find_program("apt-get").is_some()
}

/// The packages are to be installed: because `yes` was said beforehand, or is said now.
///
/// # Errors
/// When nobody is there to be asked, or the answer is no; the remedy is in it.
pub fn consent(packages: &[&str], yes: bool) -> anyhow::Result<()> {
    let list = packages.join(" ");
    if yes {
        return Ok(());
    }
    if !io::stdin().is_terminal() {
        bail!("these packages are needed: {list}; --yes installs them, or `apt-get install {list}`");
    }
    eprint!("These packages are needed: {list}\nInstall them with apt-get now? [y/N] ");
    io::stderr().flush().ok();
    let mut answer = String::new();
    io::stdin().read_line(&mut answer).context("the answer cannot be read: use --yes")?;
    if !matches!(answer.trim().to_lowercase().as_str(), "y" | "yes") {
        bail!("nothing was installed; needed are: {list}");
    }
    Ok(())
}

/// `apt-get update`, then an installation for each group by itself, so that what is there is installed even
/// when a package does not exist in this distribution. Nothing that is installed is ever removed for it.
///
/// # Errors
/// Without root's rights, or when apt-get fails with one of the groups.
pub fn install(groups: &[&[&str]]) -> anyhow::Result<()> {
    let by_hand = format!("apt-get install {}", groups.concat().join(" "));
    let sudo = match (is_root(), find_program("sudo")) {
        (true, _) => false,
        (false, Some(_)) => true,
        (false, None) => bail!("not root and no sudo here: have root run `{by_hand}`"),
    };
    let _turn = turn();
    if let Err(error) = apt_get(sudo, &["update"]) {
        // Old lists are often good enough, and a third party's broken source is no reason to stop.
        eprintln!("warning: {error:#}");
    }
    let mut failures = Vec::new();
    for group in groups {
        let mut arguments = vec!["install", "--yes", "--no-install-recommends", "--no-remove"];
        arguments.extend(*group);
        failures.extend(apt_get(sudo, &arguments).err());
    }
    match failures.pop() {
        Some(error) => Err(error.context(format!("try `{by_hand}` by hand"))),
        None => Ok(()),
    }
}

fn is_root() -> bool {
    let id = Command::new("id").arg("-u").output();
    id.is_ok_and(|output| String::from_utf8_lossy(&output.stdout).trim() == "0")
}

fn apt_get(sudo: bool, arguments: &[&str]) -> anyhow::Result<()> {
    // sudo drops the environment; `env` sets it on the other side.
    let words: &[&str] = if sudo { &["sudo", "env"] } else { &["env"] };
    let mut command = Command::new(words[0]);
    command.args(&words[1..]).args(["DEBIAN_FRONTEND=noninteractive", "apt-get", "--quiet"]).args(arguments);
    eprintln!("$ {}apt-get {}", if sudo { "sudo " } else { "" }, arguments.join(" "));
    // What the caller prints stays clean.
    let status = command.stdin(Stdio::null()).stdout(io::stderr()).status();
    let status = status.with_context(|| format!("{} cannot be started", words[0]))?;
    if !status.success() {
        bail!("apt-get {} failed", arguments.join(" "));
    }
    Ok(())
}
