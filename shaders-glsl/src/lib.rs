//! yoro's GLSL files, and the assembly of a file and its includes into the text that a driver compiles.
//!
//! [`assemble`] takes a file's path in this package, such as `synthesis/gather/march.frag`, a GLSL version and defines,
//! and returns the text. This crate handles text only: it knows neither OpenGL nor any other graphics interface.
//!
//! Folders are named after the modules that use them. Each `#include "PATH"` is resolved once, and `#line` is added, so
//! that a driver's messages can be traced to file and line ([`Assembled::name_files`]). Engines need only the files of
//! synthesis; the feature `app` embeds all others, too. With the feature `hot-reload`, the environment variable
//! `YORO_SHADERS` may name a folder from which shaders are read instead, so that changes take effect at the next start,
//! without compiling.

use std::fmt::Write as _;

/// Embeds the content of the given files, with their paths.
macro_rules! embed {
    ($($path:literal,)*) => { &[$(($path, include_str!(concat!("../", $path)))),*] };
}

/// A file's path and content.
type File = (&'static str, &'static str);

/// The files that synthesis needs, sorted by path.
static SYNTHESIS: &[File] = embed![
    "include/any_view.glsl",
    "include/bits.glsl",
    "include/bloom.glsl",
    "include/color.glsl",
    "include/depth_map.glsl",
    "include/extensions.glsl",
    "include/fill.glsl",
    "include/interface.glsl",
    "include/laws.glsl",
    "include/levels.glsl",
    "include/planes.glsl",
    "include/segments.glsl",
    "include/silhouettes.glsl",
    "include/source.glsl",
    "include/span.glsl",
    "include/tiles.glsl",
    "include/uniforms.glsl",
    "include/version.glsl",
    "include/warp.glsl",
    "screen.vert",
    "stereo/near_fraction.frag",
    "synthesis/any_view/march.frag",
    "synthesis/any_view/spans.frag",
    "synthesis/any_view/tiles.frag",
    "synthesis/compose.frag",
    "synthesis/gather/march.frag",
    "synthesis/gather/spans.frag",
    "synthesis/gather/tiles.frag",
    "synthesis/guessed_depth.frag",
    "synthesis/march.vert",
    "synthesis/nearest_depth.frag",
];

/// All other files, sorted by path.
#[cfg(any(test, feature = "app"))]
static APP: &[File] = embed![
    "include/carried.glsl",
    "include/hdr.glsl",
    "include/hole_bloom.glsl",
    "include/imbuffer.glsl",
    "include/ink.glsl",
    "include/material.glsl",
    "include/panel.glsl",
    "include/reprojection.glsl",
    "include/seam.glsl",
    "include/shade.glsl",
    "include/surface.glsl",
    "inpaint/gather.frag",
    "inpaint/holes.glsl",
    "inpaint/median.frag",
    "inpaint/paper.frag",
    "inpaint/xiao.frag",
    "openxr/hidden.frag",
    "openxr/hidden.vert",
    "openxr/transfer.frag",
    "render/bloom_down.frag",
    "render/bloom_up.frag",
    "render/composite.frag",
    "render/curtain.vert",
    "render/depth_copy.frag",
    "render/depth_write.frag",
    "render/fill.frag",
    "render/forward.frag",
    "render/geometry.vert",
    "render/hole_ink.frag",
    "render/keep_sample.frag",
    "render/motion.frag",
    "render/motion.vert",
    "render/resolve.frag",
    "render/shadow.frag",
    "render/sky.frag",
    "render/transparent.frag",
    "render/vectors.frag",
    "stereo/paper/patch.frag",
    "stereo/paper/reproject.frag",
    "stereo/paper/scatter.comp",
    "viewer/decoded.frag",
    "viewer/hud.frag",
    "viewer/lens.frag",
    "viewer/lens.vert",
    "viewer/menu.frag",
    "viewer/show.frag",
];
#[cfg(not(any(test, feature = "app")))]
static APP: &[File] = &[];

/// The `#extension` directives, which GLSL requires before every declaration.
const EXTENSIONS: &str = "include/extensions.glsl";

/// The path of a file, requested or included, that is not part of this package.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MissingFile(pub String);

/// Returns the paths of all embedded files: those of synthesis, then the others, each sorted.
pub fn files() -> impl Iterator<Item = &'static str> {
    SYNTHESIS.iter().chain(APP).map(|(path, _)| *path)
}

/// A shader's text with its includes resolved.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Assembled {
    /// The text that the driver compiles.
    pub text: String,
    /// The files by source string number; number 0 is the text before all files.
    files: Vec<String>,
}

impl Assembled {
    /// Returns the files that the text consists of, including included ones.
    pub fn files(&self) -> &[String] {
        &self.files[1..]
    }

    /// Replaces the source string number at the start of each of a driver's messages, `NUMBER:LINE`, by the file's
    /// name. Mesa and most mobile drivers use this format.
    pub fn name_files(&self, log: &str) -> String {
        let mut named = String::new();
        for line in log.trim_end_matches(['\0', '\n']).lines() {
            let body = line.trim_start_matches("ERROR: ");
            let digits = body.find(|c: char| !c.is_ascii_digit()).unwrap_or(0);
            let file = body[..digits].parse::<usize>().ok().and_then(|n| self.files.get(n));
            if let Some(file) = file {
                named.push_str(file);
                named.push_str(&body[digits..]);
            } else {
                named.push_str(line);
            }
            named.push('\n');
        }
        named.trim_end().to_owned()
    }
}

/// Returns a file's text with its `#include`s resolved, each file once. `#version` (such as `310 es`), the defines, the
/// extensions and the precision statements come first.
///
/// # Errors
/// [`MissingFile`].
pub fn assemble(path: &str, version: &str, defines: &[(&str, String)]) -> Result<Assembled, MissingFile> {
    let mut out = Assembled { text: format!("#version {version}\n"), files: vec!["defines".into()] };
    for (name, value) in defines {
        let _ = writeln!(out.text, "#define {name} {value}");
    }
    include(EXTENSIONS, &mut out)?;
    for kind in ["float", "int", "sampler2D", "usampler2D", "sampler2DShadow", "sampler2DArray"] {
        let _ = writeln!(out.text, "precision highp {kind};");
    }
    include(path, &mut out)?;
    Ok(out)
}

fn include(path: &str, out: &mut Assembled) -> Result<(), MissingFile> {
    if out.files.iter().any(|f| f == path) {
        return Ok(());
    }
    let source = read(path)?;
    let number = out.files.len();
    out.files.push(path.to_owned());
    let _ = writeln!(out.text, "#line 1 {number}");
    for (i, line) in source.lines().enumerate() {
        let directive = line.trim_start();
        if let Some(name) = directive.strip_prefix("#include") {
            include(name.trim().trim_matches('"'), out)?;
            let _ = writeln!(out.text, "#line {} {number}", i + 2);
        } else if directive.starts_with("#version") {
            out.text.push('\n');
        } else {
            out.text.push_str(line);
            out.text.push('\n');
        }
    }
    Ok(())
}

#[cfg(feature = "hot-reload")]
fn read(path: &str) -> Result<std::borrow::Cow<'static, str>, MissingFile> {
    let Some(folder) = std::env::var_os("YORO_SHADERS") else { return embedded(path).map(Into::into) };
    let file = std::path::Path::new(&folder).join(path);
    std::fs::read_to_string(&file).map(Into::into).map_err(|_| MissingFile(file.display().to_string()))
}

#[cfg(not(feature = "hot-reload"))]
use embedded as read;

fn embedded(path: &str) -> Result<&'static str, MissingFile> {
    let find = |files: &[File]| files.binary_search_by_key(&path, |(name, _)| name).ok().map(|i| files[i].1);
    find(SYNTHESIS).or_else(|| find(APP)).ok_or_else(|| MissingFile(path.to_owned()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::{Path, PathBuf};

    fn walk(folder: &Path, found: &mut Vec<PathBuf>) {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            match path.extension().and_then(|e| e.to_str()) {
                None if path.is_dir() => walk(&path, found),
                Some("glsl" | "vert" | "frag" | "comp") => found.push(path),
                _ => {}
            }
        }
    }

    #[test]
    fn every_file_is_embedded_and_sorted() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        let mut found = Vec::new();
        walk(root, &mut found);
        let mut found: Vec<&str> =
            found.iter().map(|path| path.strip_prefix(root).unwrap().to_str().unwrap()).collect();
        found.sort_unstable();
        assert!(SYNTHESIS.is_sorted() && APP.is_sorted());
        let mut embedded: Vec<&str> = files().collect();
        embedded.sort_unstable();
        assert_eq!(embedded, found);
    }

    /// An engine has no other files.
    #[test]
    fn synthesis_includes_only_its_own_files() {
        let has = |path: &str| SYNTHESIS.iter().any(|(name, _)| *name == path);
        for (path, content) in SYNTHESIS {
            let included = content.lines().filter_map(|line| line.trim_start().strip_prefix("#include"));
            for name in included.map(|name| name.trim().trim_matches('"')) {
                assert!(has(name), "{path} includes {name}");
            }
        }
        assert!(has(EXTENSIONS));
    }

    #[test]
    fn each_file_is_included_once_with_its_lines() {
        let assembled = assemble("synthesis/gather/march.frag", "300 es", &[("A", "1".into())]).unwrap();
        assert!(assembled.text.starts_with("#version 300 es\n#define A 1\n#line 1 1\n"));
        assert!(!assembled.text.contains("#include"));
        let mut files = assembled.files().to_vec();
        assert_eq!(files.first().map(String::as_str), Some(EXTENSIONS));
        files.sort_unstable();
        files.dedup();
        assert_eq!(files.len(), assembled.files().len());
        for (number, file) in assembled.files().iter().enumerate() {
            let start = format!("#line 1 {}\n", number + 1);
            assert_eq!(assembled.text.matches(&start).count(), 1, "{file}");
        }
    }

    #[test]
    fn a_missing_file_is_named() {
        assert_eq!(assemble("no/such.frag", "300 es", &[]), Err(MissingFile("no/such.frag".into())));
    }

    #[test]
    fn driver_messages_name_the_file() {
        let assembled =
            Assembled { text: String::new(), files: vec!["defines".to_owned(), "a/b.frag".to_owned()] };
        let named = |log| assembled.name_files(log);
        assert_eq!(named("1:7(3): error: `x' undeclared\n\0"), "a/b.frag:7(3): error: `x' undeclared");
        assert_eq!(named("ERROR: 1:7: 'x' : undeclared"), "a/b.frag:7: 'x' : undeclared");
        assert_eq!(named("something else"), "something else");
    }
}
