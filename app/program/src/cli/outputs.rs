//! The files of a run, checked before anything is written: no output may replace an input, and no two outputs may have
//! the same path.

use std::collections::HashMap;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use anyhow::bail;

/// The files that a run reads and writes, as far as its options tell.
#[derive(Debug, Default)]
pub struct Files {
    inputs: Vec<PathBuf>,
    outputs: Vec<Output>,
}

#[derive(Debug)]
struct Output {
    path: PathBuf,
    what: String,
    /// True if everything in the folder belongs to this output.
    is_folder: bool,
}

impl Files {
    /// Adds files that are read. They need not exist.
    pub fn read<P: AsRef<Path>>(&mut self, paths: impl IntoIterator<Item = P>) {
        self.inputs.extend(paths.into_iter().map(|path| path.as_ref().to_owned()));
    }

    /// Adds a file that is written, with a description for messages.
    pub fn write(&mut self, path: impl Into<PathBuf>, what: impl Into<String>) {
        self.outputs.push(Output { path: path.into(), what: what.into(), is_folder: false });
    }

    /// Adds a folder in which any file may be written, with a description for messages.
    pub fn fill(&mut self, folder: impl Into<PathBuf>, what: impl Into<String>) {
        self.outputs.push(Output { path: folder.into(), what: what.into(), is_folder: true });
    }

    /// Refuses outputs that would replace inputs, and two outputs at the same path.
    pub fn check(&self) -> anyhow::Result<()> {
        let inputs: HashMap<PathBuf, &Path> =
            self.inputs.iter().map(|path| (identity(path), path.as_path())).collect();
        let mut taken: HashMap<PathBuf, &str> = HashMap::new();
        for Output { path, what, is_folder } in &self.outputs {
            // Several outputs may go to the same device.
            if !is_folder && path.exists() && !path.is_file() {
                continue;
            }
            let place = identity(path);
            let replaced = if *is_folder {
                inputs.iter().find(|(input, _)| input.starts_with(&place)).map(|(_, input)| *input)
            } else {
                inputs.get(&place).copied()
            };
            if let Some(input) = replaced {
                bail!("{} is read, so {what} cannot be written there: choose another place", input.display());
            }
            if let Some(other) = taken.insert(place, what) {
                bail!(
                    "{other} and {what} would both be written to {}: choose different places, or rename one of the inputs",
                    path.display()
                );
            }
        }
        Ok(())
    }
}

/// Returns a path that identifies a file, which need not exist.
fn identity(path: &Path) -> PathBuf {
    let whole = std::path::absolute(path).unwrap_or_else(|_| path.to_path_buf());
    let mut rest: Vec<&OsStr> = Vec::new();
    for present in whole.ancestors() {
        if let Ok(real) = present.canonicalize() {
            return real.join(rest.iter().rev().collect::<PathBuf>());
        }
        rest.extend(present.file_name());
    }
    whole
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refusal(fill: impl FnOnce(&mut Files)) -> String {
        let mut files = Files::default();
        fill(&mut files);
        files.check().map_or_else(|error| error.to_string(), |()| String::new())
    }

    #[cfg(unix)]
    #[test]
    fn no_output_replaces_an_input() {
        let dir = tempfile::tempdir().unwrap();
        let at = |name: &str| dir.path().join(name);
        std::fs::write(at("a.png"), "").unwrap();
        std::os::unix::fs::symlink(at("a.png"), at("link.png")).unwrap();
        std::fs::create_dir(at("rgb")).unwrap();
        let one = |input: &str, output: &str| {
            refusal(|files| {
                files.read([at(input)]);
                files.write(at(output), "the map");
            })
        };
        assert!(
            one("a.png", "rgb/../a.png")
                .ends_with("a.png is read, so the map cannot be written there: choose another place")
        );
        assert!(one("link.png", "a.png").contains("link.png is read"));
        assert!(one("a.png", "link.png").contains("a.png is read"));
        assert!(one("missing.png", "missing.png").contains("missing.png is read"));
        assert_eq!(one("a.png", "b.png"), "");
        let inside = |input: &str| {
            refusal(|files| {
                files.read([at(input)]);
                files.fill(at("rgb"), "pictures");
            })
        };
        assert!(inside("rgb/1.png").contains("rgb/1.png is read, so pictures"));
        assert_eq!(inside("rgb.png"), "");
        let twice = refusal(|files| {
            files.write(at("b.png"), "one");
            files.write(at("./b.png"), "the other");
        });
        assert!(twice.contains("one and the other would both be written"), "{twice}");
        let device = refusal(|files| {
            files.write("/dev/null", "one");
            files.write("/dev/null", "the other");
        });
        assert_eq!(device, "");
    }
}
