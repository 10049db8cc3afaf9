//! Files that are compiled from the shaders and committed, so that building a library requires no compiler. The file
//! `SOURCES` beside them lists the compiler and the hash of each shader's text.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context as _, ensure};

const GLSLANG: &str = "glslangValidator";

/// A shader to compile.
pub struct Source {
    /// The name of the compiled file, without its extension.
    pub name: &'static str,
    /// True for a vertex shader, false for a fragment shader.
    pub vertex: bool,
    /// The text that is compiled.
    pub text: String,
}

/// A folder of compiled files.
pub struct Compiled<F> {
    /// The folder.
    pub folder: PathBuf,
    /// The extension of the files.
    pub ending: &'static str,
    /// The compiler and its version in one line, or `None` if it is not installed.
    pub compiler: Option<String>,
    /// The command that renews the files.
    pub command: &'static str,
    /// Compiles a shader.
    pub compile: F,
}

impl<F: Fn(&Source) -> anyhow::Result<Vec<u8>>> Compiled<F> {
    /// Compiles all shaders, and writes the folder.
    ///
    /// # Errors
    /// Fails without a compiler, if a shader does not compile, or if a file cannot be written.
    pub fn renew(&self, sources: &[Source]) -> anyhow::Result<()> {
        let compiler = self.compiler.as_ref().context("glslangValidator is needed: `cargo xtask setup`")?;
        for source in sources {
            write(&self.file(source), &(self.compile)(source)?)?;
        }
        write(&self.folder.join("SOURCES"), listed(compiler, sources).as_bytes())
    }

    /// Checks that the folder was made from these shaders. Compiles them again if the compiler is the one that made the
    /// folder. Otherwise prints a line saying that this was skipped.
    ///
    /// # Errors
    /// Fails if a file was not made from these shaders.
    pub fn check(&self, sources: &[Source]) -> anyhow::Result<()> {
        let command = self.command;
        let committed = fs::read_to_string(self.folder.join("SOURCES"))
            .with_context(|| format!("{} has no SOURCES: run `{command}`", self.folder.display()))?;
        let made_by = committed.lines().next().unwrap_or_default();
        ensure!(
            committed == listed(made_by, sources),
            "the shaders are not those that were compiled: run `{command}`"
        );
        match self.compiler.as_deref() {
            Some(here) if here == made_by => {
                for source in sources {
                    let kept = fs::read(self.file(source)).unwrap_or_default();
                    let name = source.name;
                    ensure!(
                        kept == (self.compile)(source)?,
                        "{name} is not what {here} makes: run `{command}`"
                    );
                }
            }
            here => println!(
                "LEFT OUT: compiling the shaders again: {} is here, not {made_by}",
                here.unwrap_or("no glslang")
            ),
        }
        Ok(())
    }

    fn file(&self, source: &Source) -> PathBuf {
        self.folder.join(format!("{}.{}", source.name, self.ending))
    }
}

fn write(file: &Path, content: &[u8]) -> anyhow::Result<()> {
    fs::write(file, content).with_context(|| format!("{} cannot be written", file.display()))
}

/// Returns the content of the file `SOURCES`.
fn listed(compiler: &str, sources: &[Source]) -> String {
    let line = |source: &Source| format!("{:016x} {}\n", hash(&source.text), source.name);
    format!("{compiler}\n{}", sources.iter().map(line).collect::<String>())
}

/// FNV-1a, which does not depend on the version of Rust.
fn hash(text: &str) -> u64 {
    text.bytes()
        .fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

/// Returns glslang's version and arguments in one line, or `None` if it is not installed.
pub fn glslang(arguments: &[&str]) -> Option<String> {
    let output = Command::new(GLSLANG).arg("--version").output().ok()?;
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let version = text.lines().next()?.trim_start_matches("Glslang Version: ");
    Some(format!("{GLSLANG} {version} {}", arguments.join(" ")))
}

/// Compiles a shader to SPIR-V with glslang.
///
/// # Errors
/// Fails if glslang cannot be run, or does not compile the shader.
pub fn spirv(source: &Source, arguments: &[&str]) -> anyhow::Result<Vec<u8>> {
    let work = tempfile::tempdir()?;
    let compiled = work.path().join("shader.spv");
    let stage = if source.vertex { "vert" } else { "frag" };
    run(source.name, &source.text, stage, &[arguments, &["-o", &compiled.to_string_lossy()]].concat())?;
    Ok(fs::read(&compiled)?)
}

/// Returns a shader's text with its macros replaced and its conditions decided, without comments.
///
/// # Errors
/// Fails if glslang cannot be run.
pub fn preprocessed(name: &str, text: &str) -> anyhow::Result<String> {
    run(name, text, "frag", &["-E"])
}

/// Runs glslang on a text, and returns what it prints.
fn run(name: &str, text: &str, stage: &str, arguments: &[&str]) -> anyhow::Result<String> {
    let work = tempfile::tempdir()?;
    let file = work.path().join(format!("shader.{stage}"));
    fs::write(&file, text)?;
    let output = Command::new(GLSLANG).args(arguments).arg(&file).output()?;
    let printed = String::from_utf8_lossy(&output.stdout).into_owned();
    ensure!(output.status.success(), "{name}: {printed}");
    Ok(printed)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn old_and_changed_files_are_noticed() {
        let folder = tempfile::tempdir().unwrap();
        let compiled = |version: &str| Compiled {
            folder: folder.path().to_owned(),
            ending: "txt",
            compiler: Some(version.to_owned()),
            command: "cargo xtask maintain x",
            compile: |source: &Source| Ok(source.text.to_uppercase().into_bytes()),
        };
        let sources = |text: &str| [Source { name: "a", vertex: false, text: text.to_owned() }];
        assert!(compiled("1").check(&sources("one")).is_err(), "an empty folder");
        compiled("1").renew(&sources("one")).unwrap();
        assert_eq!(fs::read_to_string(folder.path().join("a.txt")).unwrap(), "ONE");
        compiled("1").check(&sources("one")).unwrap();
        let error = compiled("1").check(&sources("two")).unwrap_err().to_string();
        assert_eq!(error, "the shaders are not those that were compiled: run `cargo xtask maintain x`");
        fs::write(folder.path().join("a.txt"), "other").unwrap();
        let error = compiled("1").check(&sources("one")).unwrap_err().to_string();
        assert_eq!(error, "a is not what 1 makes: run `cargo xtask maintain x`");
        // Only the compiler that made a file can detect the difference.
        compiled("2").check(&sources("one")).unwrap();
    }
}
