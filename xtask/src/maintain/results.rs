//! Measures what the documents say.

use std::fs;
use std::process::Command;

use anyhow::{Context as _, bail, ensure};

use super::{estimate, renew};
use crate::cargo::{cargo, perform};
use crate::folders::{copy, root, target_folder, write};

/// A file of docs/results: `SUITE.jsonl` for the first of the arguments.
struct Run {
    /// The arguments of `yoro bench`.
    arguments: &'static str,
    /// About how long it takes on two cores without a GPU.
    minutes: u32,
}

/// Suites that would take too long at 1024 x 1024 pixels an eye have smaller images.
const RUNS: [Run; 11] = [
    Run { arguments: "scenes --rounds 1", minutes: 20 },
    Run { arguments: "flicker", minutes: 12 },
    Run { arguments: "half-rate --size 384x384 --viewpoints 1", minutes: 2 },
    Run { arguments: "hard-cases", minutes: 2 },
    Run { arguments: "reprojection --size 512x512 --viewpoints 2", minutes: 5 },
    Run { arguments: "patchers --size 512x512 --viewpoints 1 --rounds 1", minutes: 2 },
    Run { arguments: "styles --size 512x512 --viewpoints 1", minutes: 2 },
    Run { arguments: "ipd --size 512x512 --viewpoints 1", minutes: 2 },
    Run { arguments: "distance --size 512x512", minutes: 2 },
    Run { arguments: "lights --size 512x512 --viewpoints 1 --rounds 2", minutes: 2 },
    Run { arguments: "complexity --size 512x512 --rounds 2", minutes: 15 },
];
/// The name of the estimate of phones, whose report is kept as text.
const ESTIMATE: &str = "estimate";
const ESTIMATE_MINUTES: u32 = 40;

impl Run {
    fn suite(&self) -> &'static str {
        self.arguments.split(' ').next().unwrap_or(self.arguments)
    }
}

/// Measures these suites, or all and the estimate of phones, and writes the tables of the documents. What was finished
/// on the same commit is not measured again.
///
/// # Errors
/// If a suite is unknown, or a run fails. The data that were there before are then unchanged.
pub fn measure(suites: &[String]) -> anyhow::Result<String> {
    let known = || RUNS.iter().map(Run::suite).chain([ESTIMATE]);
    if let Some(unknown) = suites.iter().find(|suite| known().all(|name| name != *suite)) {
        bail!("no document has figures of {unknown}: choose of {}", known().collect::<Vec<_>>().join(", "));
    }
    let is_wanted = |name: &str| suites.is_empty() || suites.iter().any(|suite| suite == name);
    let runs = || RUNS.iter().filter(|run| is_wanted(run.suite()));
    let minutes = runs().map(|run| run.minutes).chain(is_wanted(ESTIMATE).then_some(ESTIMATE_MINUTES));
    eprintln!(
        "about {} minutes on two cores without a GPU, which should be idle otherwise; after Ctrl-C the same command goes on",
        minutes.sum::<u32>()
    );
    perform(
        cargo().args(["build", "--release", "--package", "yoro-cli", "--features", "neural"]),
        "yoro does not compile",
    )?;
    let target = target_folder()?;
    let folder = target.join("results").join(commit()?);
    fs::create_dir_all(&folder).with_context(|| format!("{} cannot be made", folder.display()))?;
    let documents = root().join("docs/results");
    let mut files = Vec::new();
    for run in runs() {
        eprintln!("$ yoro bench {}", run.arguments);
        // It goes on with the default file of results, so that the command in the data has no path.
        let mut command = Command::new(target.join("release/yoro"));
        let status = command.current_dir(&folder).arg("bench").args(run.arguments.split(' ')).status();
        ensure!(
            status.context("yoro cannot be started")?.success(),
            "{} was not measured: see above",
            run.suite()
        );
        let file = folder.join("out").join(format!("bench-{}.jsonl", run.suite()));
        files.push((file, documents.join(format!("{}.jsonl", run.suite()))));
    }
    let estimate = is_wanted(ESTIMATE).then(|| estimate::frames(&[])).transpose()?;
    // Everything is measured: only now are the previous data replaced.
    for (from, to) in &files {
        copy(from, to)?;
    }
    if let Some(report) = estimate {
        write(&documents.join(ESTIMATE).with_extension("txt"), report)?;
    }
    renew::renew_results()?;
    Ok("measured: look at `git diff docs`\n".into())
}

/// Returns the commit whose code is measured.
fn commit() -> anyhow::Result<String> {
    let output = Command::new("git").args(["describe", "--always", "--dirty"]).current_dir(root()).output();
    let output = output.context("git cannot be started")?;
    ensure!(output.status.success(), "this folder is no checkout of git");
    Ok(String::from_utf8_lossy(&output.stdout).trim().to_owned())
}
