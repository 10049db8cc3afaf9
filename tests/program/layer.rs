//! `yoro layer`, which installs and removes the OpenXR API layer where loaders look for it.

use std::fs;
use std::path::{Path, PathBuf};

use crate::program::{Run, finish, yoro};

const NAME: &str = "XR_APILAYER_YORO_one_view";

fn layer(folder: &Path, arguments: &[&str]) -> Run {
    let mut command = yoro(["layer"].iter().chain(arguments));
    command.current_dir(folder).env("XDG_DATA_HOME", folder.join("data"));
    command.env("XDG_CONFIG_HOME", folder.join("config")).env("XDG_STATE_HOME", folder.join("state"));
    finish(&mut command)
}

/// Returns the path of a library of this build: the layer or the simulated runtime.
fn library(name: &str) -> PathBuf {
    Path::new(env!("CARGO_BIN_EXE_yoro")).with_file_name("deps").join(name)
}

/// Returns the path of the layer's library as an argument.
fn own_library() -> String {
    library("libyoro_openxr_layer.so").into_os_string().into_string().unwrap()
}

#[test]
fn the_layer_is_installed_listed_and_removed() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let own = own_library();
    for (kind, options) in [("explicit", &[][..]), ("implicit", &["--implicit"])] {
        let install = [&["install", "--library", &own], options].concat();
        let installed = layer(folder, &install);
        assert_eq!(installed.code, Some(0), "{}", installed.stderr);
        let file = folder.join(format!("data/openxr/1/api_layers/{kind}.d/{NAME}.json"));
        let manifest: serde_json::Value = serde_json::from_slice(&fs::read(&file).unwrap()).unwrap();
        assert_eq!(manifest["api_layer"]["name"], NAME);
        let library = manifest["api_layer"]["library_path"].as_str().unwrap();
        assert!(fs::read(library).unwrap() == fs::read(&own).unwrap());
        let status = layer(folder, &["status"]);
        assert_eq!(status.code, Some(0), "{}", status.stderr);
        assert!(status.stdout.contains(&file.display().to_string()), "{}", status.stdout);
        assert!(status.stdout.contains(concat!("version ", env!("CARGO_PKG_VERSION"))), "{}", status.stdout);

        let removed = layer(folder, &["remove"]);
        assert_eq!(removed.code, Some(0), "{}", removed.stderr);
        assert_eq!(fs::read_dir(folder.join("data")).unwrap().count(), 0, "folders are left");
    }
    assert!(layer(folder, &["status"]).stdout.contains("not installed"));
    assert_eq!(layer(folder, &["remove"]).code, Some(0));
}

/// If the library is not a layer, every program that uses the layer fails to start.
#[test]
fn a_library_that_is_not_the_layer_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::write(folder.join("text.so"), "no library").unwrap();
    fs::copy(library("libyoro_openxr_stub.so"), folder.join("runtime.so")).unwrap();
    for (file, what) in [
        ("text.so", "cannot be loaded"),
        ("/bin/ls", "cannot be loaded"),
        ("runtime.so", "is a library, but no OpenXR API layer"),
    ] {
        for task in [&["install", "--implicit"][..], &["install"], &["run"]] {
            let program: &[&str] = if task == ["run"] { &["--", "true"] } else { &[] };
            layer(folder, &[task, &["--library", file], program].concat()).refuses(&[
                file,
                what,
                "libyoro_openxr_layer.so",
            ]);
        }
    }
    assert!(!folder.join("data").exists());

    // The same if the library is replaced later.
    assert_eq!(layer(folder, &["install", "--library", &own_library()]).code, Some(0));
    let installed = folder.join("data/yoro/libyoro_openxr_layer.so");
    fs::copy(folder.join("runtime.so"), &installed).unwrap();
    layer(folder, &["status"]).refuses(&["data/yoro/libyoro_openxr_layer.so", "no OpenXR API layer"]);
}

#[test]
fn a_link_in_place_of_the_library_is_replaced() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let target = folder.join("somebody's");
    fs::write(&target, "somebody's").unwrap();
    let installed = folder.join("data/yoro/libyoro_openxr_layer.so");
    fs::create_dir_all(installed.parent().unwrap()).unwrap();
    std::os::unix::fs::symlink(&target, &installed).unwrap();
    assert_eq!(layer(folder, &["install", "--library", &own_library()]).code, Some(0));
    assert_eq!(fs::read_to_string(&target).unwrap(), "somebody's");
    assert!(!installed.is_symlink() && installed.is_file());
}

/// Loaders interpret XDG_DATA_HOME relative to each program's current folder, and split it at colons.
#[test]
fn folders_where_no_loader_looks_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let colon = folder.path().join("a:b");
    for (data, what) in [("data", "absolute"), (colon.to_str().unwrap(), "colon")] {
        for task in [&["install", "--library", &own_library()][..], &["status"], &["remove"]] {
            let mut command = yoro(["layer"].iter().chain(task));
            command.current_dir(folder.path()).env("XDG_DATA_HOME", data).env("HOME", folder.path());
            finish(&mut command).refuses(&[data, "XDG_DATA_HOME", what]);
        }
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn status_tells_mistakes_in_the_settings_of_every_application() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let file = folder.join("config/yoro/layer.toml");
    fs::create_dir_all(file.parent().unwrap()).unwrap();
    fs::write(&file, "guard_band = 1.0\n[application.Hello]\noffer = 'off'\n").unwrap();
    assert_eq!(layer(folder, &["status"]).code, Some(0));
    fs::write(&file, "[application.Hello]\ndominant = 'middle'\n").unwrap();
    layer(folder, &["status"]).refuses(&["layer.toml", "[application.Hello]", "`left` or `right`"]);
    fs::remove_file(&file).unwrap();
    fs::create_dir(&file).unwrap();
    let status = layer(folder, &["status"]);
    status.refuses(&["layer.toml", "mend it or remove it"]);
    assert!(!status.stdout.contains("not there"), "{}", status.stdout);
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
    fs::remove_file(&log).unwrap();
    fs::create_dir(&log).unwrap();
    layer(folder.path(), &["log"]).refuses(&["layer.log", "remove it"]);
}

#[test]
fn impossible_runs_and_installations_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let own = own_library();
    layer(folder.path(), &["run", "--library", &own, "--", "no-such-program"]).refuses(&["no-such-program"]);
    layer(folder.path(), &["install", "--library", "gone.so"]).refuses(&["gone.so"]);
    let run = layer(
        folder.path(),
        &["run", "--library", &own, "--", "sh", "-c", "ls \"$XR_API_LAYER_PATH\"; exit 7"],
    );
    assert_eq!(run.code, Some(7), "{}", run.stderr);
    assert!(run.stdout.contains(NAME), "{}", run.stdout);
}
