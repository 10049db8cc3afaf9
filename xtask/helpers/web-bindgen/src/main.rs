//! `yoro-web-bindgen MODULE.wasm FOLDER PAGE`: writes the module and its JavaScript into FOLDER in the form that
//! browsers load. Prints three numbers: the module's bytes, its bytes as transferred, and the bytes of a first visit,
//! which also loads the texts in PAGE.
//!
//! This is a separate program so that only people who build the page have to compile its dependencies.

use std::path::{Path, PathBuf};
use std::{env, fs};

use anyhow::Context as _;
use wasm_bindgen_cli_support::Bindgen;

/// Extensions of the files that a first visit loads besides the module.
const TEXTS: [&str; 5] = ["css", "html", "js", "svg", "webmanifest"];
/// Files that only streams and videos load.
const LATER: [&str; 4] = ["stream.js", "stream-worker.js", "video-worker.js", "decoding.js"];

fn main() -> anyhow::Result<()> {
    let arguments: Vec<PathBuf> = env::args_os().skip(1).map(PathBuf::from).collect();
    let [module, folder, page] = &arguments[..] else {
        anyhow::bail!("usage: yoro-web-bindgen MODULE.wasm FOLDER PAGE");
    };
    Bindgen::new()
        .input_path(module)
        .web(true)?
        .typescript(false)
        .remove_name_section(true)
        .remove_producers_section(true)
        .generate(folder)
        .with_context(|| format!("{} cannot be made ready for browsers", module.display()))?;
    let name = module.file_stem().unwrap_or_default().to_string_lossy();
    let file = folder.join(format!("{name}_bg.wasm"));
    let transferred = compressed(&file)?;
    let visit = transferred + texts(folder)? + texts(page)?;
    println!("{} {transferred} {visit}", fs::metadata(&file)?.len());
    Ok(())
}

/// Returns the transferred bytes of a folder's texts.
fn texts(folder: &Path) -> anyhow::Result<usize> {
    let mut sum = 0;
    for entry in fs::read_dir(folder).with_context(|| format!("{} cannot be read", folder.display()))? {
        let path = entry?.path();
        let later = path.file_name().is_some_and(|name| LATER.iter().any(|later| name == *later));
        if !later && path.extension().is_some_and(|kind| TEXTS.iter().any(|text| kind == *text)) {
            sum += compressed(&path)?;
        }
    }
    Ok(sum)
}

/// Returns the transferred bytes of a file (brotli, quality 9).
fn compressed(file: &Path) -> anyhow::Result<usize> {
    let bytes = fs::read(file).with_context(|| format!("{} cannot be read", file.display()))?;
    let mut compressed = Vec::new();
    let parameters = brotli::enc::BrotliEncoderParams { quality: 9, ..Default::default() };
    brotli::BrotliCompress(&mut bytes.as_slice(), &mut compressed, &parameters)?;
    Ok(compressed.len())
}
