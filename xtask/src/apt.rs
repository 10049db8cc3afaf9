//! System requirements, and apt, which installs them.

use std::env;
use std::ffi::OsStr;
use std::io::{self, IsTerminal as _, Write as _};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::{Mutex, MutexGuard, PoisonError};

use anyhow::{Context as _, bail};

/// Held while apt updates lists or installs packages. In Debian's container images, a hook after every update, even
/// that of a private state, removes the downloaded packages that have not been installed yet.
static TURN: Mutex<()> = Mutex::new(());

/// Waits until no other thread updates lists or installs.
pub fn turn() -> MutexGuard<'static, ()> {
    TURN.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Something that is needed, and where it is or how to get it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Need {
    /// The name, for people.
    pub what: &'static str,
    /// The path, or the problem.
    pub found: Result<String, String>,
    /// What to do if it is missing.
    pub remedy: String,
    /// The Debian packages that contain it.
    pub packages: &'static [&'static str],
}

impl Need {
    /// Looks for a program in PATH.
    pub fn program(name: &'static str, packages: &'static [&'static str]) -> Self {
        let found = find_program(name).map(|path| path.display().to_string());
        Self {
            what: name,
            found: found.ok_or_else(|| "not in PATH".to_owned()),
            remedy: format!("apt-get install {}", packages.join(" ")),
            packages,
        }
    }

    /// Looks for a file or folder.
    pub fn file(what: &'static str, path: &Path, remedy: &str, packages: &'static [&'static str]) -> Self {
        let shown = path.display();
        Self {
            what,
            found: if path.exists() { Ok(shown.to_string()) } else { Err(format!("{shown} is missing")) },
            remedy: remedy.to_owned(),
            packages,
        }
    }
}

/// Installs what is missing. Asks first unless `yes`.
pub fn install_missing(needs: impl Fn() -> Vec<Need>, yes: bool) -> anyhow::Result<()> {
    /// Locked so that a second thread does not miss packages that the first one is installing.
    static PROVIDING: Mutex<()> = Mutex::new(());
    let _providing = PROVIDING.lock().unwrap_or_else(PoisonError::into_inner);
    let missing = || needs().into_iter().filter(|need| need.found.is_err()).collect::<Vec<_>>();
    let at_first = missing();
    let groups: Vec<&[&str]> =
        at_first.iter().map(|need| need.packages).filter(|packages| !packages.is_empty()).collect();
    if !groups.is_empty() && find_program("apt-get").is_some() {
        consent(&groups.concat(), yes)?;
        if let Err(error) = install(&groups) {
            eprintln!("warning: {error:#}");
        }
    }
    let still = missing();
    if still.is_empty() {
        return Ok(());
    }
    let sentences: Vec<String> =
        still.iter().map(|need| format!("{} is missing ({})", need.what, need.remedy)).collect();
    bail!("{}", sentences.join(", "))
}

/// Returns the path of a program in PATH.
pub fn find_program(name: impl AsRef<OsStr>) -> Option<PathBuf> {
    let path = env::var_os("PATH")?;
    env::split_paths(&path).map(|folder| folder.join(name.as_ref())).find(|program| program.is_file())
}

/// True if [`install`] needs no password and no confirmation.
pub fn installs_by_itself() -> bool {
    is_root() && find_program("apt-get").is_some()
}

/// Asks whether to install packages, unless `yes`.
fn consent(packages: &[&str], yes: bool) -> anyhow::Result<()> {
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

/// Runs `apt-get update`, then installs each group separately, so that a package that this distribution does not have
/// only affects its own group. Never removes installed packages.
pub fn install(groups: &[&[&str]]) -> anyhow::Result<()> {
    let by_hand = format!("apt-get install {}", groups.concat().join(" "));
    let sudo = match (is_root(), find_program("sudo")) {
        (true, _) => false,
        (false, Some(_)) => true,
        (false, None) => bail!("not root and no sudo here: have root run `{by_hand}`"),
    };
    let _turn = turn();
    if let Err(error) = apt_get(sudo, &["update"]) {
        // The old lists often suffice, and a broken third-party source should not stop the installation.
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
    // sudo drops the environment, so `env` sets it after sudo.
    let words: &[&str] = if sudo { &["sudo", "env"] } else { &["env"] };
    let mut command = Command::new(words[0]);
    command.args(&words[1..]).args(["DEBIAN_FRONTEND=noninteractive", "apt-get", "--quiet"]).args(arguments);
    eprintln!("$ {}apt-get {}", if sudo { "sudo " } else { "" }, arguments.join(" "));
    // Keeps the caller's standard output clean.
    let status = command.stdin(Stdio::null()).stdout(io::stderr()).status();
    let status = status.with_context(|| format!("{} cannot be started", words[0]))?;
    if !status.success() {
        bail!("apt-get {} failed", arguments.join(" "));
    }
    Ok(())
}
