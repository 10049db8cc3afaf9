//! The files of those who host the project: each command in them must be one that runs by hand.

use std::fs;
use std::path::Path;

use clap::Parser as _;
use yaml_rust2::{Yaml, YamlLoader};

use crate::Arguments;
use crate::folders::root;

/// Programs beside cargo that the host or its image has.
const PROGRAMS: [&str; 5] = ["rustup", "apt-get", "git", "gh", "test"];

/// Returns the commands of all jobs; those that a matrix names, too.
fn commands(file: &Path) -> Vec<String> {
    let text = fs::read_to_string(file).unwrap();
    let document = &YamlLoader::load_from_str(&text).unwrap()[0];
    assert!(document["name"].as_str().is_some() && !document["on"].is_badvalue(), "{}", file.display());
    let mut found = Vec::new();
    for job in document["jobs"].as_hash().unwrap().values() {
        let strings = |list: &Yaml| -> Vec<String> {
            list.as_vec().unwrap().iter().map(|item| item.as_str().unwrap().to_owned()).collect()
        };
        for step in job["steps"].as_vec().unwrap() {
            match step["run"].as_str() {
                Some("${{ matrix.command }}") => found.extend(strings(&job["strategy"]["matrix"]["command"])),
                Some(lines) => found.extend(lines.lines().map(str::to_owned)),
                None => assert!(step["uses"].as_str().is_some_and(|action| action.contains('@')), "{step:?}"),
            }
        }
    }
    found
}

#[test]
fn each_command_of_a_host_runs_by_hand() {
    let script = fs::read_to_string(root().join(".ci/run")).unwrap();
    let checks: Vec<&str> =
        script.lines().filter_map(|line| Some(line.split_once(" || status=")?.0)).collect();
    assert!(checks.len() > 2, "{script}");
    for (name, wanted) in [
        ("ci", &checks[..]),
        ("release", &["cargo xtask release --out dist"]),
        ("site", &["cargo xtask site --release dist"]),
    ] {
        let commands = commands(&root().join(".github/workflows").join(name).with_extension("yml"));
        for command in &commands {
            let words: Vec<&str> = command.split_whitespace().collect();
            if let Some(task) = command.strip_prefix("cargo xtask ") {
                let parsed = Arguments::try_parse_from(["xtask"].into_iter().chain(task.split_whitespace()));
                assert!(parsed.is_ok(), "{name}: {command}");
            } else {
                assert!(PROGRAMS.contains(&words[0]), "{name}: {command}");
            }
        }
        for command in wanted {
            assert!(commands.iter().any(|known| known == command), "{name} lacks {command}");
        }
    }
}
