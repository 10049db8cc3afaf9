//! `yoro report`: results of `yoro bench` in, a page and tables out.

use std::fs;
use std::path::Path;

use crate::program::{folder, run, succeed};

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
fn files_without_results_are_refused() {
    let at = &folder();
    write(at, "good.jsonl", &format!("{HEADER}\n{ROUND}\n"));
    write(at, "damaged.jsonl", &format!("{HEADER}\n{{\"record\":\"measure\n{ROUND}\n"));
    write(at, "begun.jsonl", &format!("{HEADER}\n{}", &ROUND[..300]));
    fs::create_dir(at.join("folder.jsonl")).unwrap();
    fs::create_dir(at.join("out")).unwrap();
    write(at, "out/report.html", "made earlier");
    write(at, "file", "");
    for (line, naming) in [
        ("report nowhere.jsonl", &["nowhere.jsonl does not exist"][..]),
        ("report folder.jsonl", &["folder.jsonl is a folder"]),
        ("report good.jsonl damaged.jsonl", &["damaged.jsonl, line 2 is damaged"]),
        ("report begun.jsonl", &["begun.jsonl holds no finished round"]),
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
