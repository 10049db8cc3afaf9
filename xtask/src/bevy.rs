//! The plugin for Bevy: its example and its tests. They are a workspace of their own with its own target folder.

use std::time::Instant;

use clap::Subcommand;

use crate::folders::{make_parent, remove, root, target_folder};
use crate::maintain::{hello_xr, monado};
use crate::{cargo, setup};

#[derive(Subcommand)]
pub enum Task {
    /// Render a room in both eyes without a window, and write the pictures into out/bevy
    Run,
    /// Run the plugin's tests; those of headsets on Monado with a simulated one
    Test,
}

/// Runs the example without a window.
pub fn run() -> anyhow::Result<()> {
    setup::vulkan();
    let folder = root().join("out/bevy").display().to_string();
    perform("run", &["--example", "headless", "--", &folder], &[])
}

/// Runs all tests. Without Monado, its tests are skipped with a message.
pub fn test() -> anyhow::Result<()> {
    let start = Instant::now();
    setup::vulkan();
    // The tests print their figures.
    perform("test", &["--", "--nocapture"], &[])?;
    match hello_xr::make() {
        Ok(programs) => {
            let folder = target_folder()?.join("bevy-tests");
            remove(&folder)?;
            make_parent(&folder.join("runtime.log"))?;
            let _runtime = monado::start(&programs.join("monado-service"), &folder)?;
            let runner = format!("target.'cfg(all())'.runner=[{:?}]", programs.join("run"));
            let drivers = monado::make()?.join("root/usr/share/vulkan/icd.d/lvp_icd.json");
            let environment = [
                ("XDG_RUNTIME_DIR", folder.display().to_string()),
                ("VK_DRIVER_FILES", drivers.display().to_string()),
            ];
            let environment: Vec<(&str, &str)> =
                environment.iter().map(|(name, value)| (*name, value.as_str())).collect();
            let headset = ["--config", &runner, "--test", "headset", "--", "--ignored", "--nocapture"];
            perform("test", &headset, &environment)?;
        }
        Err(error) => println!("Monado cannot be had here: tests of headsets are skipped: {error:#}"),
    }
    println!("Bevy: {} s", start.elapsed().as_secs());
    Ok(())
}

fn perform(command: &str, more: &[&str], environment: &[(&str, &str)]) -> anyhow::Result<()> {
    let manifest = root().join("app/engines/bevy/Cargo.toml").display().to_string();
    let target = target_folder()?.join("bevy").display().to_string();
    // All commands select the same features, so that nothing is compiled twice.
    let mut cargo = cargo::cargo();
    cargo.args([command, "--locked", "--manifest-path", &manifest, "--target-dir", &target]);
    cargo.args(["--features", "openxr"]).args(more).envs(environment.iter().copied());
    cargo::perform(&mut cargo, &format!("cargo {command} failed"))
}
