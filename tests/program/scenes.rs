//! `yoro scenes` and `yoro info`.

use yoro_metrics::{Channels, SsimWindow, ssim};
use yoro_scenes::BUILTINS;

use crate::program::{interrupt, run, succeed};

#[test]
fn the_list_has_every_scene() {
    let dir = tempfile::tempdir().unwrap();
    let list = succeed(dir.path(), "scenes").stdout;
    let json = succeed(dir.path(), "scenes --json").json();
    assert_eq!(json.as_array().unwrap().len(), BUILTINS.len());
    for (builtin, row) in BUILTINS.iter().zip(json.as_array().unwrap()) {
        assert!(list.contains(builtin.name), "{list}");
        assert_eq!(row["name"], builtin.name);
    }
    run(dir.path(), "scenes export moon out").refuses(&["\"moon\"", BUILTINS[0].name]);
}

#[test]
fn an_exported_scene_renders_as_the_built_in_one() {
    let dir = tempfile::tempdir().unwrap();
    let out = succeed(dir.path(), "scenes export prototype exported").stdout;
    assert!(out.starts_with("exported/prototype.obj: "), "{out}");
    let options = "--size 128x128 --outputs left,right";
    succeed(dir.path(), &format!("render prototype --out a {options}"));
    succeed(dir.path(), &format!("render exported/prototype.obj --out b {options}"));
    for eye in ["left", "right"] {
        let load = |folder: &str| {
            yoro_media::load_color(&dir.path().join(format!("{folder}/prototype.{eye}.png"))).unwrap()
        };
        let likeness = ssim(&load("b"), &load("a"), SsimWindow::Gaussian11, Channels::Rgb).unwrap();
        assert!(likeness > 0.99, "{eye}: SSIM {likeness:.4}");
    }
}

#[test]
fn an_export_ends_when_interrupted() {
    let dir = tempfile::tempdir().unwrap();
    interrupt(dir.path(), "scenes export street out", || dir.path().join("out").exists());
    assert!(!dir.path().join("out/street.obj").exists());
}

#[test]
fn info_names_the_drivers() {
    let dir = tempfile::tempdir().unwrap();
    let text = succeed(dir.path(), "info").stdout;
    assert!(text.contains("egl: ") && text.contains("shared memory"), "{text}");
    let json = succeed(dir.path(), "info --json --gl egl").json();
    assert!(json["egl"]["max_texture_size"].as_u64().unwrap() >= 2048, "{json}");
}
