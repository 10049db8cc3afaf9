//! The test programs: cargo compiles them and says where they are, and each lists its tests.

use std::collections::BTreeMap;
use std::env;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::{Context as _, bail};
use serde_json::Value;
use yoro_tools::cargo;

/// A test program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Binary {
    /// For people: the package, and the target unless that is the package's library.
    pub label: String,
    /// Its package.
    pub package: String,
    /// Tests from outside, whose tests take seconds, where those inside of a library take milliseconds.
    pub integration: bool,
    executable: PathBuf,
    version: String,
    manifest: PathBuf,
}

/// A program, and the names of its tests that are chosen.
pub type Program = (Binary, Vec<String>);

impl Binary {
    /// Runs it as cargo does.
    pub fn command(&self) -> Command {
        let folder = self.manifest.parent().unwrap_or(&self.manifest);
        let mut command = Command::new(&self.executable);
        command
            .current_dir(folder)
            .env("CARGO_MANIFEST_DIR", folder)
            .env("CARGO_MANIFEST_PATH", &self.manifest)
            .env("CARGO_PKG_NAME", &self.package)
            .env("CARGO_PKG_VERSION", &self.version)
            .env("LD_LIBRARY_PATH", library_path(&self.executable))
            .stdin(Stdio::null());
        command
    }

    /// The names of its tests, in the order that it runs them in.
    ///
    /// # Errors
    /// When it does not start.
    pub fn list(&self) -> anyhow::Result<Vec<String>> {
        let output = self.command().args(["--list", "--format", "terse"]).stderr(Stdio::inherit()).output();
        let output = output.with_context(|| format!("{} cannot be started", self.executable.display()))?;
        if !output.status.success() {
            bail!("{} cannot list its tests ({})", self.label, output.status);
        }
        Ok(names(&String::from_utf8_lossy(&output.stdout)))
    }
}

/// Of `name: test` lines, the names.
fn names(listing: &str) -> Vec<String> {
    listing.lines().filter_map(|line| line.strip_suffix(": test")).map(str::to_owned).collect()
}

/// Cargo's folders of libraries, before those that this program has of cargo itself: among them Rust's own.
fn library_path(executable: &Path) -> OsString {
    let own = executable.ancestors().skip(1).take(2).map(Path::to_owned);
    let rest = env::var_os("LD_LIBRARY_PATH").unwrap_or_default();
    env::join_paths(own.chain(env::split_paths(&rest))).unwrap_or(rest)
}

/// Compiles the tests of these packages, or of the whole workspace.
///
/// # Errors
/// When something does not compile.
pub fn compile(packages: &[String]) -> anyhow::Result<Vec<Binary>> {
    let mut arguments = vec!["test", "--no-run", "--message-format=json-render-diagnostics"];
    arguments.extend(cargo::choice(packages));
    cargo::announce(&arguments);
    let messages = cargo::output(&arguments)?;
    // In an order of their own, where cargo's is that in which they are ready.
    let binaries: BTreeMap<String, Binary> =
        messages.lines().filter_map(parse).map(|binary| (binary.label.clone(), binary)).collect();
    Ok(binaries.into_values().collect())
}

/// The test program that a message of cargo's tells of.
fn parse(message: &str) -> Option<Binary> {
    let message: Value = serde_json::from_str(message).ok()?;
    if message["reason"] != "compiler-artifact" || message["profile"]["test"] != true {
        return None;
    }
    let executable = PathBuf::from(message["executable"].as_str()?);
    let (package, version) = package(message["package_id"].as_str()?)?;
    let (kind, target) = (message["target"]["kind"][0].as_str()?, message["target"]["name"].as_str()?);
    let label = match kind {
        "test" => format!("{package}::{target}"),
        "bin" | "example" => format!("{package}::{kind}/{target}"),
        _ => package.to_owned(),
    };
    Some(Binary {
        label,
        package: package.to_owned(),
        integration: kind == "test",
        executable,
        version: version.to_owned(),
        manifest: PathBuf::from(message["manifest_path"].as_str()?),
    })
}

/// Name and version of `path+file:///folder/name#version` or `path+file:///folder#name@version`.
fn package(id: &str) -> Option<(&str, &str)> {
    let (place, rest) = id.rsplit_once('#')?;
    rest.split_once('@').or_else(|| Some((place.rsplit('/').next()?, rest)))
}

#[cfg(test)]
pub mod tests {
    use super::*;

    /// A program `program` of a package.
    pub fn binary(package: &str, kind: &str) -> Binary {
        let id = format!("path+file:///w#{package}@0.1.0");
        parse(&message(&id, kind, true, "\"/w/target/debug/deps/program-1\"")).unwrap()
    }

    fn message(id: &str, kind: &str, test: bool, executable: &str) -> String {
        format!(
            r#"{{"reason":"compiler-artifact","package_id":"{id}","manifest_path":"/w/app/Cargo.toml",
            "target":{{"kind":["{kind}"],"name":"program"}},"profile":{{"test":{test}}},"executable":{executable}}}"#
        )
        .replace('\n', "")
    }

    #[test]
    fn test_programs_are_found_among_cargos_messages() {
        let label = |id, kind, test, executable| {
            parse(&message(id, kind, test, executable)).map(|binary| binary.label)
        };
        let (id, file) = ("path+file:///w/app#yoro-app@0.1.0", "\"/w/target/debug/deps/program-1\"");
        assert_eq!(label(id, "test", true, file).as_deref(), Some("yoro-app::program"));
        assert_eq!(label(id, "bin", true, file).as_deref(), Some("yoro-app::bin/program"));
        assert_eq!(label("path+file:///w/xtask#0.1.0", "lib", true, file).as_deref(), Some("xtask"));
        assert_eq!(label(id, "bin", false, file), None);
        assert_eq!(label(id, "lib", true, "null"), None);
        assert_eq!(parse("   Compiling yoro"), None);
    }

    #[test]
    fn a_test_program_runs_in_its_packages_folder() {
        let binary = binary("yoro-app", "test");
        assert!(binary.integration);
        let command = binary.command();
        assert_eq!(command.get_current_dir(), Some(Path::new("/w/app")));
        let value = |name: &str| {
            let found = command.get_envs().find(|(key, _)| *key == name).and_then(|(_, value)| value);
            found.unwrap().to_str().unwrap().to_owned()
        };
        assert_eq!(value("CARGO_MANIFEST_DIR"), "/w/app");
        assert_eq!(value("CARGO_PKG_NAME"), "yoro-app");
        assert_eq!(value("CARGO_PKG_VERSION"), "0.1.0");
        assert!(value("LD_LIBRARY_PATH").starts_with("/w/target/debug/deps:/w/target/debug"));
    }

    #[test]
    fn listings_hold_tests_only() {
        assert_eq!(names("a::b: test\nc: benchmark\n\nd: test\n"), ["a::b", "d"]);
    }
}
