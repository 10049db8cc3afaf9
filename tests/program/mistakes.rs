//! Mistakes of new users: each is answered with one sentence, and damages no file.

use std::fs;
use std::path::Path;
use std::process::Stdio;

use image::RgbImage;

use crate::pair;
use crate::program::{finish, folder, run, yoro};

fn color_and_depth(dir: &Path) {
    yoro_media::save_color(&dir.join("color.png"), &pair::color(0.5)).unwrap();
    yoro_media::save_depth(&dir.join("depth.png"), &pair::metres(0.5)).unwrap();
}

const PALETTE_OF_FOUR_BYTES: &[u8] =
    b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\x10\0\0\0\x10\x08\x03\0\0\0(-\x0fS\
    \0\0\0\x04PLTE\x01\x02\x03\x04#\xdb\x8a\xab\
    \0\0\0\rIDATx\xdac`\x18\x05\xc8\0\0\x01\x10\0\x01\x7f\xcd\x03\xb5\0\0\0\0IEND\xaeB`\x82";

#[test]
fn files_that_are_no_pictures_are_refused() {
    let at = &folder();
    color_and_depth(at);
    let whole = fs::read(at.join("color.png")).unwrap();
    fs::write(at.join("half.png"), &whole[..whole.len() / 2]).unwrap();
    yoro_media::save_color(&at.join("small.png"), &RgbImage::new(64, 48)).unwrap();
    fs::write(at.join("out.png"), "made earlier").unwrap();
    for (color, depth, naming) in [
        ("nowhere.png", "depth.png", &["nowhere.png does not exist", "check the path"][..]),
        ("half.png", "depth.png", &["half.png is damaged"]),
        ("small.png", "depth.png", &["small.png is 64x48", "depth.png is 160x120", "one size"]),
        ("color.png", "color.png", &["color.png is a colour image", "grey"]),
        ("color.png", ".", &[". is a folder and color.png is a file"]),
    ] {
        run(at, &format!("synthesize --color {color} --depth {depth} --out out.png")).refuses(naming);
        run(at, &format!("synthesize --color {color} --depth {depth} --out new/out.png")).refuses(naming);
    }
    assert_eq!(fs::read(at.join("out.png")).unwrap(), b"made earlier");
    assert!(!at.join("new").exists(), "a folder for nothing");
    // A palette of four bytes, on which the decoder panics (png 0.18.1), and a JPEG with nothing but a header, for
    // which the decoder prints two lines.
    fs::write(at.join("palette.png"), PALETTE_OF_FOUR_BYTES).unwrap();
    fs::write(at.join("header.jpg"), b"\xff\xd8\xff\xe0\0\x10JFIF\0").unwrap();
    for name in ["palette.png", "header.jpg"] {
        run(at, &format!("compare {name} color.png")).refuses(&[name, "is damaged"]);
        let model = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl m\nf 1/1 2/1 3/1\n";
        fs::write(at.join("m.obj"), model).unwrap();
        fs::write(at.join("m.mtl"), format!("newmtl m\nmap_Kd {name}\n")).unwrap();
        run(at, "render m.obj --size 64x64 --out out").refuses(&["the texture", name]);
    }
}

#[test]
fn files_that_are_no_scenes_are_refused() {
    let at = &folder();
    fs::write(at.join("damaged.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 zero\nf 1 2 3\n").unwrap();
    fs::write(at.join("scene.blend"), "BLENDER").unwrap();
    for (scene, naming) in [
        ("bistroo", &["\"bistroo\"", "choose one of", "prototype"][..]),
        ("damaged.obj", &["damaged.obj: up to line 3"]),
        ("scene.blend", &["scene.blend is not a scene", ".obj"]),
    ] {
        run(at, &format!("render {scene} --size 64x64 --out out")).refuses(naming);
    }
    assert!(!at.join("out").exists());
    run(at, "run prototype bistroo").refuses(&["\"bistroo\""]);
    run(at, "render prototype --pose 99 --out out").refuses(&["--pose 99", "poses 0 to"]);
}

#[test]
fn outputs_that_cannot_be_written() {
    let at = &folder();
    color_and_depth(at);
    fs::write(at.join("file"), "made earlier").unwrap();
    fs::create_dir(at.join("folder.png")).unwrap();
    let synthesize = "synthesize --color color.png --depth depth.png --depth-encoding metres";
    for (out, naming) in [
        ("file/out.png", &["file is not a folder"][..]),
        ("folder.png", &["folder.png is a folder"]),
        ("out.gif", &["out.gif", ".png"]),
        ("/proc/out.png", &["cannot write /proc/out.png"]),
    ] {
        run(at, &format!("{synthesize} --out {out}")).refuses(naming);
    }
    run(at, "render prototype --size 64x64 --out file").refuses(&["file is not a folder"]);
    run(at, "render prototype --size 64x64 --out /proc/out").refuses(&["/proc/out"]);
    run(at, "run prototype --out file").refuses(&["file is not a folder"]);
    run(at, "scenes export prototype file").refuses(&["file is not a folder"]);
    assert_eq!(fs::read(at.join("file")).unwrap(), b"made earlier");
}

#[test]
fn options_out_of_range() {
    let at = &folder();
    color_and_depth(at);
    for (line, naming) in [
        ("render prototype --ipd 0.2", &["--ipd", "0.063"][..]),
        ("render prototype --ipd 63mm", &["--ipd"]),
        ("render prototype --size 8x8", &["--size", "16 to 4096"]),
        ("render prototype --size big", &["--size", "1024x1024"]),
        ("render prototype --msaa 3", &["give 1, 2 or 4"]),
        ("render prototype --near 10 --far 5", &["--near 10 must be less than --far 5"]),
        ("render prototype --near 0", &["--near"]),
        ("render prototype --fov-y-degrees 190", &["--fov-y-degrees", "1 to 170"]),
        ("render prototype --frames 0", &["--frames"]),
        ("render prototype --pipeline magic", &["--pipeline", "gather"]),
        ("view prototype --png view.png --set history=full", &["no setting \"history\"", "choose one of"]),
        ("view prototype --png view.png --set duration=1e300", &["cannot be 1e300: give seconds above 0"]),
        ("view prototype --png view.png --set msaa=", &["--set msaa= has no value"]),
        ("render prototype --imbuffer 0", &["--imbuffer", "512x512"]),
        ("render prototype --position 1,2", &["--position", "three numbers"]),
        ("render prototype --position 1e38,0,0", &["--position", "up to 100000 m from the origin"]),
        ("render prototype --half-angles-degrees 95,10", &["--half-angles-degrees", "1 to 85"]),
        ("render prototype --guard-band wide", &["--guard-band", "none"]),
        ("render", &["<SCENE>"]),
        ("rendr prototype", &["rendr", "render"]),
        ("synthesize --color color.png --depth depth.png --out o.png --near 5 --far 1", &["--near 5"]),
        ("synthesize --color color.png --depth depth.png --out o.png --depth-gamma 0", &["--depth-gamma"]),
    ] {
        run(at, line).refuses(naming);
    }
    assert_eq!(fs::read_dir::<&Path>(at).unwrap().count(), 2, "something was written");
}

#[test]
fn a_machine_without_gl_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    fs::create_dir(dir.path().join("out")).unwrap();
    let picture = dir.path().join("out/prototype.left.png");
    fs::write(&picture, "made earlier").unwrap();
    let without_egl = |line: &str| {
        let nowhere = dir.path().join("nowhere.json");
        let mut command = yoro(line.split(' '));
        finish(command.current_dir(dir.path()).env("__EGL_VENDOR_LIBRARY_FILENAMES", nowhere))
    };
    without_egl("render prototype --gl egl").refuses(&[
        "no OpenGL ES context by EGL",
        "apt install",
        "--gl osmesa",
    ]);
    assert_eq!(fs::read(&picture).unwrap(), b"made earlier");
    if std::env::var_os("YORO_TEST_WITHOUT_OSMESA").is_none() {
        let run = without_egl("info --gl auto");
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        assert!(run.stdout.contains("osmesa: "), "{}", run.stdout);
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_behind_standard_output_is_an_error() {
    let dir = tempfile::tempdir().unwrap();
    color_and_depth(dir.path());
    for line in ["scenes", "scenes --json", "compare color.png color.png --json"] {
        let full = fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
        let mut command = yoro(line.split(' '));
        finish(command.current_dir(dir.path()).stdout(full))
            .refuses(&["cannot write standard output: the disk is full"]);
    }
}

#[test]
fn a_closed_pipe_is_no_error() {
    let mut command = yoro(["scenes"]);
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert_eq!(String::from_utf8_lossy(&output.stderr), "");
    assert_eq!(output.status.code(), Some(0));
}

#[test]
fn one_process_at_a_time_appends_to_a_file() {
    let at = &folder();
    let held = yoro_files::append(&at.join("results.jsonl")).unwrap();
    let bench = "bench scenes --quick --rounds 1 --size 32x32 --scene prototype --out results.jsonl";
    run(at, bench).refuses(&["results.jsonl is being written by another yoro", "--out"]);
    drop(held);
}

#[test]
fn numbers_have_a_remedy() {
    let dir = tempfile::tempdir().unwrap();
    for (line, remedy) in [
        ("run prototype --rounds x", "give a whole number from 1 to 1000"),
        ("dataset --groups=-1 prototype", "give a whole number from 1 to 1000000"),
        ("render prototype --seed 1.5", "give a whole number from 0"),
        ("render prototype --pose=-2", "give a whole number from 0"),
        ("render prototype --frames 99999999999", "give a whole number from 1 to 100000"),
        ("view --png v.png --yaw-degrees left", "give degrees from -360 to 360"),
        ("device farm husky --scenarios 4", "give a whole number from 1 to 3"),
        ("study plan --participants none", "give a whole number from 1 to 1000"),
    ] {
        let output = run(dir.path(), line);
        assert!(output.code == Some(2) && output.stderr.contains(remedy), "{line}: {}", output.stderr);
    }
}

/// No output is written if another one cannot be.
#[test]
fn every_output_is_checked_before_the_first() {
    let dir = tempfile::tempdir().unwrap();
    color_and_depth(dir.path());
    let line = "synthesize --color color.png --depth depth.png --out o.png --disparity-out x.txt";
    run(dir.path(), line).refuses(&["x.txt", ".exr"]);
    assert!(!dir.path().join("o.png").exists());
}
