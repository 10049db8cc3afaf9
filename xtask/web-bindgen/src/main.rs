//! `yoro-web-bindgen MODULE.wasm FOLDER`: writes the module and its JavaScript as a browser loads them, and says how many
//! bytes of the module are transferred.
//!
//! A program of its own, so that only those who build the page wait for its dependencies.

use std::env;
use std::path::PathBuf;

use anyhow::Context as _;
use wasm_bindgen_cli_support::Bindgen;

fn main() -> anyhow::Result<()> {
    let mut arguments = env::args_os().skip(1).map(PathBuf::from);
    let (module, folder) =
        arguments.next().zip(arguments.next()).context("usage: yoro-web-bindgen MODULE.wasm FOLDER")?;
    Bindgen::new()
        .input_path(&module)
        .web(true)?
        .typescript(false)
        .remove_name_section(true)
        .remove_producers_section(true)
        .generate(&folder)
        .with_context(|| format!("{} cannot be made ready for browsers", module.display()))?;
    let name = module.file_stem().unwrap_or_default().to_string_lossy();
    let file = folder.join(format!("{name}_bg.wasm"));
    let bytes = std::fs::read(&file).with_context(|| format!("{} cannot be read", file.display()))?;
    let mut compressed = Vec::new();
    let parameters = brotli::enc::BrotliEncoderParams { quality: 9, ..Default::default() };
    brotli::BrotliCompress(&mut bytes.as_slice(), &mut compressed, &parameters)?;
    println!("{} {}", bytes.len(), compressed.len());
    Ok(())
}
