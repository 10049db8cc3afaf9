//! Compiles the synthesis programs for mobile GPUs.

use serde_json::Value;
use xtask::maintain::estimate::{Compilers, Options, report};
use yoro_context::{Backend, Headless};
use yoro_tests::programs::{self, Variants};

/// Two generations of Adreno and one of Mali. All programs on all GPUs would take minutes.
const GPUS: [&str; 3] = ["a650", "a740", "g57"];

#[test]
fn synthesis_programs_neither_spill_nor_starve_mobile_gpus() {
    let Some(folder) = std::env::var_os("YORO_TEST_SHADER_COMPILERS") else {
        let without = std::env::var_os("YORO_TEST_WITHOUT_SHADER_COMPILERS").is_some();
        assert!(without, "run `cargo xtask test shader_cost`, or set YORO_TEST_WITHOUT_SHADER_COMPILERS=1");
        return;
    };
    let headless = Headless::open(Backend::Egl).unwrap();
    let made = programs::make(headless.gl(), Variants::Extreme).unwrap();
    let texts = serde_json::to_value(programs::texts(&made).unwrap()).unwrap();
    let Value::Array(programs) = texts else { panic!("no list") };
    let options = Options {
        filter: Some("synthesis/".to_owned()),
        gpus: GPUS.map(|gpu| gpu.parse().unwrap()).to_vec(),
        bless: false,
    };
    let (text, passed) = report(&options, &Compilers::at(folder.into()), programs).unwrap();
    assert!(passed, "{text}");
    for gpu in GPUS {
        assert!(text.contains(&format!("({gpu})\n")), "{text}");
    }
    for defines in ["DEPTH_PAIRS", "WRITE_DEPTH SOURCE_MAP", "WRITE_DEPTH DEPTH_PAIRS BLOOM"] {
        let name = format!("synthesis/gather/march.frag {defines} ");
        assert!(text.matches(&name).count() >= GPUS.len(), "{name}: {text}");
    }
}
