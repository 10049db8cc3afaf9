//! The synthesis programs on compilers of mobile GPUs.

use std::fs;
use std::process::Command;

/// Two generations of Adreno and one Mali; all programs on all GPUs take minutes.
const GPUS: &str = "a650,a740,g57";

#[test]
fn synthesis_programs_neither_spill_nor_starve_mobile_gpus() {
    let Some(xtask) = std::env::var_os("YORO_TEST_SHADER_COMPILERS") else {
        let without = std::env::var_os("YORO_TEST_WITHOUT_SHADER_COMPILERS").is_some();
        assert!(without, "run `cargo xtask test shader_cost`, or set YORO_TEST_WITHOUT_SHADER_COMPILERS=1");
        return;
    };
    let printed = Command::new(env!("CARGO_BIN_EXE_shader-programs")).output().unwrap();
    assert!(printed.status.success(), "{}", String::from_utf8_lossy(&printed.stderr));
    let folder = tempfile::tempdir().unwrap();
    let programs = folder.path().join("programs.json");
    fs::write(&programs, printed.stdout).unwrap();
    let mut report = Command::new(xtask);
    report.args(["shader-cost", "synthesis/", "--gpu", GPUS, "--programs"]).arg(&programs);
    let report = report.output().unwrap();
    let text = String::from_utf8_lossy(&report.stdout);
    assert!(report.status.success(), "{text}{}", String::from_utf8_lossy(&report.stderr));
    for gpu in GPUS.split(',') {
        assert!(text.contains(&format!("({gpu})\n")), "{text}");
    }
    // As OpenGL ES 3.0, as a CPU rasterizer, as a GPU, and with a source map.
    assert_eq!(text.matches("synthesis/gather/march.frag WRITE_DEPTH ").count(), 4 * GPUS.split(',').count());
}
