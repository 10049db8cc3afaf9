//! The paper's own figures, which are printed beside ours and marked as the paper's. `paper.toml` has them, with what they
//! are. The scenes, cameras and machines are not ours: the figures say what to expect, not what to reproduce.

use std::collections::BTreeMap;
use std::sync::LazyLock;

use serde::Deserialize;

/// The figures.
pub static PAPER: LazyLock<Paper> =
    LazyLock::new(|| toml::from_str(include_str!("paper.toml")).expect("the paper's figures are complete"));

/// The methods here that correspond to the three systems whose figures an array has.
pub const SYSTEMS: [&str; 3] = ["yoro-paper", "conventional", "hybrid"];

/// The number of participants of the paper's study.
pub const STUDY_PARTICIPANTS: usize = 14;

/// What the text says of objects at a distance of 0.5 to 3 m ("Impact of Object Distance"): SSIM, and PSNR in dB.
pub const DISTANCE: [f64; 2] = [0.95, 38.73];

/// All figures of the paper.
#[derive(Debug, Deserialize)]
pub struct Paper {
    /// The eight scenes.
    pub scenes: Vec<PaperScene>,
    /// The averages over its image groups and scenes.
    pub average: PaperScene,
    /// Frame times in ms of each system by millions of triangles, which are the entry `triangles`.
    pub complexity: BTreeMap<String, Vec<f64>>,
    /// Frames a second of each system with fewer than five lights.
    pub few_lights: BTreeMap<String, f64>,
    /// SSIM and PSNR in dB of each shading style.
    pub styles: BTreeMap<String, [f64; 2]>,
    /// The points of other sweeps: quantity, SSIM, PSNR in dB.
    pub sweeps: BTreeMap<String, Vec<[f64; 3]>>,
    /// PSNR in dB, SSIM and milliseconds of each patcher.
    pub patchers: BTreeMap<String, [f64; 3]>,
    /// The devices.
    pub devices: Vec<PaperDevice>,
    /// The 95 % interval of the difference from conventional rendering by each question of the user study.
    pub study: BTreeMap<String, [f64; 2]>,
}

/// The paper's figures for one of its scenes. An array of three has those of [`SYSTEMS`].
#[derive(Debug, Deserialize)]
pub struct PaperScene {
    /// The scene's name in the paper.
    #[serde(default)]
    pub name: String,
    /// PSNR of the synthesized eye in dB.
    pub psnr: f64,
    /// SSIM of the synthesized eye.
    pub ssim: f64,
    /// Frames per second.
    pub fps: [f64; 3],
    /// CPU load in percent.
    #[serde(default)]
    pub cpu: [f64; 3],
    /// Memory in MB.
    #[serde(default)]
    pub memory: [f64; 3],
    /// Power in mW.
    #[serde(default)]
    pub power: [f64; 3],
    /// kbit/s of a stream of colour and depth, and of one of both eyes.
    #[serde(default)]
    pub kbit: [f64; 2],
}

impl PaperScene {
    /// Returns the frame time of YORO divided by that of conventional rendering.
    pub fn frame_time_ratio(&self) -> f64 {
        self.fps[1] / self.fps[0]
    }
}

/// One of the paper's devices, and YORO's change over conventional rendering in percent.
#[derive(Debug, Deserialize)]
pub struct PaperDevice {
    /// The device's name in the paper.
    pub name: String,
    /// Battery capacity in milliampere-hours.
    pub capacity_mah: f64,
    /// Change of power.
    pub power: f64,
    /// Change of the frame rate.
    pub fps: f64,
    /// Change of the "execution time".
    pub time: f64,
    /// Change of memory.
    pub memory: f64,
}

/// Returns the paper's name for the system that a method here corresponds to.
pub fn system(method: &str) -> &'static str {
    match method {
        "yoro-paper" => "YORO",
        "conventional" => "conventional",
        "hybrid" => "Fink et al.",
        "instanced" => "SPI",
        _ => "",
    }
}

/// Returns the paper's scene with this name.
pub fn find(name: &str) -> Option<&'static PaperScene> {
    PAPER.scenes.iter().find(|scene| scene.name == name)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches typing errors: the figures give the means that the paper's text has.
    #[test]
    fn the_figures_give_the_papers_own_summaries() {
        let mean = |values: Vec<f64>| crate::stats::mean(values).unwrap();
        let near = |ours: f64, papers: f64, within: f64| {
            assert!((ours - papers).abs() < within, "{ours} is not {papers}");
        };
        let of = |value: &dyn Fn(&PaperScene) -> f64| mean(PAPER.scenes.iter().map(value).collect());
        let average = &PAPER.average;
        for (i, (cpu, memory)) in [(35.4, 58.02), (52.7, 60.51), (47.7, 59.75)].into_iter().enumerate() {
            near(of(&|scene| scene.fps[i]), average.fps[i], 0.1);
            near(of(&|scene| scene.cpu[i]), cpu, 0.1);
            near(of(&|scene| scene.memory[i]), memory, 0.1);
            near(of(&|scene| scene.power[i]), [343.0, 469.0, 469.0][i], 0.6);
        }
        // The averages of quality weigh each image group equally, so they are only near the scenes' mean.
        near(of(&|scene| scene.psnr), average.psnr, 1.0);
        near(of(&|scene| scene.ssim), average.ssim, 0.005);
        near(of(&|scene| 100.0 * (scene.kbit[0] / scene.kbit[1] - 1.0)), -39.6, 0.1);
        // The share of conventional rendering's time, without the smallest scene.
        let conventional = &PAPER.complexity["conventional"];
        for (method, share) in [("yoro-paper", 51.40), ("hybrid", 81.97), ("instanced", 75.96)] {
            let times = &PAPER.complexity[method];
            near(mean((1..9).map(|i| 100.0 * times[i] / conventional[i]).collect()), share, 0.6);
            assert!(!system(method).is_empty() && PAPER.few_lights.contains_key(method));
        }
        near(mean(PAPER.sweeps["ipd"].iter().map(|p| p[1]).collect()), 0.963, 0.0006);
        near(mean(PAPER.sweeps["ipd"].iter().map(|p| p[2]).collect()), 33.80, 0.01);
        near(mean(PAPER.styles.values().map(|s| s[0]).collect()), 0.97, 0.001);
        assert_eq!(PAPER.patchers["paper"][0], average.psnr);
        for device in &PAPER.devices[..7] {
            near(100.0 / (1.0 + device.fps / 100.0) - 100.0, device.time, 0.05);
        }
    }
}
