//! The test programs: cargo compiles them and reports their paths, and each lists its tests.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::process::{Command, Stdio};

use anyhow::{Context as _, bail};
use serde_json::Value;

use crate::cargo;

/// A test program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Binary {
    /// The name in messages: the package, and the target unless it is the package's library.
    pub label: String,
    /// The program's package.
    pub package: String,
    /// True for integration tests. Each takes seconds, while unit tests take milliseconds.
    pub integration: bool,
    executable: PathBuf,
    /// The package's folder.
    folder: PathBuf,
}

/// A program, and the names of the selected tests.
pub type Program = (Binary, Vec<String>);

impl Binary {
    /// Returns the command that runs the program in the same folder as cargo does.
    pub fn command(&self) -> Command {
        let mut command = Command::new(&self.executable);
        command.current_dir(&self.folder).stdin(Stdio::null());
        command
    }

    /// Returns the names of the program's tests in the order in which it runs them.
    pub fn list(&self) -> anyhow::Result<Vec<String>> {
        let output = self.command().args(["--list", "--format", "terse"]).stderr(Stdio::inherit()).output();
        let output = output.with_context(|| format!("{} cannot be started", self.executable.display()))?;
        if !output.status.success() {
            bail!("{} cannot list its tests ({})", self.label, output.status);
        }
        let listing = String::from_utf8_lossy(&output.stdout);
        Ok(listing.lines().filter_map(|line| line.strip_suffix(": test")).map(str::to_owned).collect())
    }
}

/// Compiles the tests of these packages, or of the whole workspace.
pub fn compile(packages: &[String]) -> anyhow::Result<Vec<Binary>> {
    let mut arguments = vec!["test", "--no-run", "--message-format=json-render-diagnostics"];
    arguments.extend(cargo::choice(packages));
    cargo::announce(&arguments);
    let messages = cargo::output(&arguments)?;
    // Sorted by label, since cargo reports programs in the order in which they are finished.
    let binaries: BTreeMap<String, Binary> =
        messages.lines().filter_map(parse).map(|binary| (binary.label.clone(), binary)).collect();
    Ok(binaries.into_values().collect())
}

/// Parses the test program in one of cargo's messages.
fn parse(message: &str) -> Option<Binary> {
    let message: Value = serde_json::from_str(message).ok()?;
    if message["reason"] != "compiler-artifact" || message["profile"]["test"] != true {
        return None;
    }
    let executable = PathBuf::from(message["executable"].as_str()?);
    // `path+file:///folder/name#version` or `path+file:///folder#name@version`
    let (place, rest) = message["package_id"].as_str()?.rsplit_once('#')?;
    let package = rest.split_once('@').map(|(name, _)| name).or_else(|| place.rsplit('/').next())?;
    let (kind, target) = (message["target"]["kind"][0].as_str()?, message["target"]["name"].as_str()?);
    let label = match kind {
        "test" => format!("{package}::{target}"),
        "bin" | "example" => format!("{package}::{kind}/{target}"),
        _ => package.to_owned(),
    };
    let manifest = PathBuf::from(message["manifest_path"].as_str()?);
    let (package, folder) = (package.to_owned(), manifest.parent()?.to_owned());
    Some(Binary { label, package, integration: kind == "test", executable, folder })
}

#[cfg(test)]
pub mod tests {
    use std::path::Path;

    use super::*;

    /// Makes a program `program` of a package.
    pub fn binary(package: &str, kind: &str) -> Binary {
        parse(&message(&format!("path+file:///w#{package}@0.1.0"), kind, true, "\"/w/target/p\"")).unwrap()
    }

    fn message(id: &str, kind: &str, test: bool, executable: &str) -> String {
        format!(
            r#"{{"reason":"compiler-artifact","package_id":"{id}","manifest_path":"/w/app/Cargo.toml",
            "target":{{"kind":["{kind}"],"name":"program"}},"profile":{{"test":{test}}},"executable":{executable}}}"#
        )
    }

    #[test]
    fn test_programs_are_found_among_cargos_messages() {
        let label = |id, kind, test, executable| {
            parse(&message(id, kind, test, executable)).map(|binary| binary.label)
        };
        let (id, file) = ("path+file:///w/app#yoro-cli@0.1.0", "\"/w/target/debug/deps/program-1\"");
        assert_eq!(label(id, "test", true, file).as_deref(), Some("yoro-cli::program"));
        assert_eq!(label(id, "bin", true, file).as_deref(), Some("yoro-cli::bin/program"));
        assert_eq!(label("path+file:///w/xtask#0.1.0", "lib", true, file).as_deref(), Some("xtask"));
        assert_eq!(label(id, "bin", false, file), None);
        assert_eq!(parse("   Compiling yoro"), None);
        let binary = binary("yoro-cli", "test");
        assert!(binary.integration && binary.command().get_current_dir() == Some(Path::new("/w/app")));
    }
}
