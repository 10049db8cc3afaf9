//! Tests of multiview, which headsets support, but Mesa before 25 does not.

use std::env;
use std::process::Command;

use yoro_context::{Backend, Headless};
use yoro_tests::MULTIVIEW_EXPECTED;

/// The variable with a launcher that runs a command on a driver with multiview.
const LAUNCHER: &str = "YORO_TEST_MULTIVIEW";
/// The tests that [`yoro_tests::is_tested`] restricts on a driver without multiview.
const TESTS: [&str; 5] = [
    "methods::single_pass_stereo_equals_two_renders",
    "methods::a_missing_driver_feature_is_one_sentence",
    "objects::thirty_frames_hold_as_many_objects_as_ten",
    "objects::new_sizes_and_eyes_replace_objects",
    "shaders::every_shader_compiles_in_every_variant",
];

#[test]
fn every_method_on_a_driver_that_has_it() {
    let Some(launcher) = env::var_os(LAUNCHER) else {
        if !Headless::open(Backend::Egl).unwrap().gl().capabilities().multiview {
            println!("SKIPPED: this driver has no GL_OVR_multiview2, and {LAUNCHER} names none that has it");
        }
        return;
    };
    let mut command = Command::new(launcher);
    command.arg(env::current_exe().unwrap()).args(["--exact", "--test-threads=1"]).args(TESTS);
    command.env(MULTIVIEW_EXPECTED, "1").env("YORO_TEST_WITHOUT_OSMESA", "1");
    let output = command.output().expect("the launcher starts");
    // Not printed, since names of tests have a meaning in this process's output.
    let text =
        String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
    let all = format!("{} passed; 0 failed", TESTS.len());
    assert!(output.status.success() && text.contains(&all), "{}", text.replace("\ntest ", "\n- "));
}
