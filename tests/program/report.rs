//! `yoro report`: results of `yoro bench` in, a page and tables out.

use std::fs;
use std::path::Path;

use image::{Rgb, RgbImage};

use crate::browser::{Browser, check_report_with_pictures};
use crate::program::{run, succeed};

const HEADER: &str = r#"{"record":"header","yoro_bench":1,"suites":["scenes"],"quick":true,"machine":{"cpu":"a CPU","cores":2,"os":"Linux","gl_renderer":"llvmpipe","gl_version":"OpenGL ES 3.2","yoro":"0.1.0","date":"2026-01-01T00:00:00Z","command":"yoro bench scenes"},"pass_clock":"finish","parameters":[{"name":"dominant eye","value":"right"}]}"#;
const ROUND: &str = r#"{"record":"scene","suite":"scenes","scene":"talk","stands_for":"Chat","style":"realistic","triangles":117000,"lights":3,"frames":["viewpoint 0"]}
{"record":"unsupported","suite":"scenes","scene":"talk","contender":"multiview","reason":"this driver has no GL_OVR_multiview2"}
{"record":"measurement","suite":"scenes","scene":"talk","contender":"conventional","round":0,"values":{"frame_ms":[100.0]}}
{"record":"measurement","suite":"scenes","scene":"talk","contender":"mono","round":0,"values":{"frame_ms":[50.0],"psnr":[20.0],"ssim":[0.5]}}
{"record":"measurement","suite":"scenes","scene":"talk","contender":"yoro-gather","round":0,"values":{"frame_ms":[60.0],"psnr":[32.5],"ssim":[0.97]}}
{"record":"round","suite":"scenes","scene":"talk","round":0}"#;

fn write(dir: &Path, name: &str, text: &str) {
    fs::write(dir.join(name), text).unwrap();
}

#[test]
fn the_page_is_shown_in_a_browser() {
    let dir = tempfile::tempdir().unwrap();
    let at = dir.path();
    write(at, "run.jsonl", &format!("{HEADER}\n{ROUND}\n"));
    for (name, shift) in [("dominant", 9), ("truth", 0), ("yoro-gather", 1)] {
        let eye =
            RgbImage::from_fn(64, 48, |x, y| Rgb([((x + shift) * 4) as u8, (y * 5) as u8, (x * y) as u8]));
        yoro_media::save_color(&at.join(format!("run.pictures/scenes/talk/{name}.png")), &eye).unwrap();
    }
    let stdout = succeed(at, "report run.jsonl --out out").stdout;
    assert!(stdout.contains("out/report.html"), "{stdout}");
    let results = fs::read_to_string(at.join("out/report.md")).unwrap();
    for needed in ["| 0.60 |", "32.50 / 0.9700", "20.00 / 0.5000", "29.79 / 0.9697", "no GL_OVR_multiview2"] {
        assert!(results.contains(needed), "{needed}: {results}");
    }
    if let Some(mut browser) = Browser::start() {
        check_report_with_pictures(&mut browser, &at.join("out/report.html"));
    }
}

#[test]
fn files_without_results_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let at = dir.path();
    write(at, "good.jsonl", &format!("{HEADER}\n{ROUND}\n"));
    write(at, "text.jsonl", "not a result\n");
    write(at, "other.jsonl", "{\"name\": \"something else\"}\n");
    write(at, "damaged.jsonl", &format!("{HEADER}\n{{\"record\":\"measure\n{ROUND}\n"));
    write(at, "begun.jsonl", &format!("{HEADER}\n{}", &ROUND[..300]));
    write(at, "newer.jsonl", "{\"record\":\"header\",\"yoro_bench\":99}\n");
    fs::create_dir(at.join("folder.jsonl")).unwrap();
    fs::create_dir(at.join("out")).unwrap();
    write(at, "out/report.html", "made earlier");
    write(at, "file", "");
    for (line, naming) in [
        ("report nowhere.jsonl", &["nowhere.jsonl does not exist"][..]),
        ("report folder.jsonl", &["folder.jsonl is a folder"]),
        ("report text.jsonl", &["text.jsonl is not a result of yoro bench"]),
        ("report other.jsonl", &["other.jsonl is not a result of yoro bench"]),
        ("report good.jsonl damaged.jsonl", &["damaged.jsonl, line 2 is damaged"]),
        ("report begun.jsonl", &["begun.jsonl holds no finished round"]),
        ("report newer.jsonl", &["newer.jsonl has version 99"]),
        ("report good.jsonl --out file", &["file is not a folder"]),
        ("report", &["<FILE.jsonl>"]),
    ] {
        let mut run = run(at, line);
        // A separate line reports what was left out of an incomplete file.
        run.stderr = run.stderr.lines().filter(|l| !l.contains("WARN")).collect::<Vec<_>>().join("\n");
        run.refuses(naming);
    }
    assert_eq!(fs::read(at.join("out/report.html")).unwrap(), b"made earlier");
    // If a file is cut off in its second round, the first round is reported.
    write(at, "cut.jsonl", &format!("{HEADER}\n{ROUND}\n{}", &ROUND[..300]));
    let run = succeed(at, "report cut.jsonl");
    assert!(run.stderr.contains("cut.jsonl"), "{}", run.stderr);
    assert_ne!(fs::read(at.join("out/report.html")).unwrap(), b"made earlier");
}
