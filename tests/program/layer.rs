//! `yoro layer`: the OpenXR API layer put where loaders look, and taken away again.

use std::fs;
use std::path::Path;

use crate::program::{Run, finish, yoro};

const NAME: &str = "XR_APILAYER_YORO_one_view";

fn layer(folder: &Path, arguments: &[&str]) -> Run {
    let mut command = yoro(["layer"].iter().chain(arguments));
    command.current_dir(folder).env("XDG_DATA_HOME", folder.join("data"));
    command.env("XDG_CONFIG_HOME", folder.join("config")).env("XDG_STATE_HOME", folder.join("state"));
    finish(&mut command)
}

#[test]
fn the_layer_is_installed_listed_and_removed() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::write(folder.join("layer.so"), "the library").unwrap();
    for (kind, options) in [("explicit", &[][..]), ("implicit", &["--implicit"])] {
        let install = [&["install", "--library", "layer.so"], options].concat();
        let installed = layer(folder, &install);
        assert_eq!(installed.code, Some(0), "{}", installed.stderr);
        let file = folder.join(format!("data/openxr/1/api_layers/{kind}.d/{NAME}.json"));
        let manifest: serde_json::Value = serde_json::from_slice(&fs::read(&file).unwrap()).unwrap();
        assert_eq!(manifest["api_layer"]["name"], NAME);
        let library = manifest["api_layer"]["library_path"].as_str().unwrap();
        assert_eq!(fs::read_to_string(library).unwrap(), "the library");
        assert!(layer(folder, &["status"]).stdout.contains(&file.display().to_string()));

        let removed = layer(folder, &["remove"]);
        assert_eq!(removed.code, Some(0), "{}", removed.stderr);
        assert!(!file.exists() && !Path::new(library).exists());
    }
    assert!(layer(folder, &["status"]).stdout.contains("not installed"));
    assert_eq!(layer(folder, &["remove"]).code, Some(0));
}

#[test]
fn the_log_of_the_last_program_is_shown() {
    let folder = tempfile::tempdir().unwrap();
    layer(folder.path(), &["log"]).refuses(&["layer.log", "yoro layer run"]);
    let log = folder.path().join("state/yoro/layer.log");
    fs::create_dir_all(log.parent().unwrap()).unwrap();
    fs::write(&log, "yoro layer: HelloXR: renders one view\n").unwrap();
    let shown = layer(folder.path(), &["log"]);
    assert_eq!((shown.code, shown.stdout.as_str()), (Some(0), "yoro layer: HelloXR: renders one view\n"));
}

#[test]
fn impossible_runs_and_installations_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let library = folder.path().join("layer.so");
    fs::write(&library, "the library").unwrap();
    layer(folder.path(), &["run", "--library", "layer.so", "--", "no-such-program"])
        .refuses(&["no-such-program"]);
    layer(folder.path(), &["install", "--library", "gone.so"]).refuses(&["gone.so"]);
    let run = layer(
        folder.path(),
        &["run", "--library", "layer.so", "--", "sh", "-c", "ls \"$XR_API_LAYER_PATH\"; exit 7"],
    );
    assert_eq!(run.code, Some(7), "{}", run.stderr);
    assert!(run.stdout.contains(NAME), "{}", run.stdout);
}
