//! The paper's own figures, which are printed beside ours and marked as the paper's.
//!
//! Source: "You Only Render Once", MobiSys '25: image quality per scene over 29,128 image groups, and mean frame rates
//! over six phones and a Quest 2. The scenes, cameras and machines are not ours: the figures say what to expect, not
//! what to reproduce.

use serde::Serialize;

/// The paper's figures for one of its scenes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PaperScene {
    /// The scene's name in the paper.
    pub name: &'static str,
    /// PSNR of the synthesized eye in dB.
    pub psnr: f64,
    /// SSIM of the synthesized eye; the paper does not name the window.
    pub ssim: f64,
    /// Frames per second of YORO.
    pub fps_yoro: f64,
    /// Frames per second of conventional rendering: two full passes.
    pub fps_conventional: f64,
    /// Frames per second of the hybrid rendering of Fink et al.
    pub fps_fink: f64,
}

impl PaperScene {
    /// Returns the frame time of YORO divided by that of conventional rendering.
    pub fn frame_time_ratio(&self) -> f64 {
        self.fps_conventional / self.fps_yoro
    }
}

/// The eight scenes in the paper's order.
pub const SCENES: [PaperScene; 8] = [
    scene("Bistro", 31.99, 0.9505, [34.9, 17.7, 16.9]),
    scene("Chat", 29.79, 0.9697, [51.6, 23.3, 21.0]),
    scene("Conference", 34.68, 0.9805, [53.2, 24.3, 22.4]),
    scene("Sponza", 41.90, 0.9802, [50.6, 23.4, 20.5]),
    scene("LostEmpire", 39.25, 0.9747, [48.0, 22.5, 20.0]),
    scene("Prototype", 32.98, 0.9751, [51.0, 22.8, 21.5]),
    scene("SciFiCity", 29.58, 0.9516, [39.3, 18.9, 19.6]),
    scene("UnityChan", 28.74, 0.9643, [49.4, 22.7, 21.4]),
];

/// The paper's averages over its image groups and scenes.
pub const AVERAGE: PaperScene = scene("average", 34.09, 0.9679, [47.26, 21.96, 20.42]);

const fn scene(name: &'static str, psnr: f64, ssim: f64, fps: [f64; 3]) -> PaperScene {
    PaperScene { name, psnr, ssim, fps_yoro: fps[0], fps_conventional: fps[1], fps_fink: fps[2] }
}

/// Mean frame times over the paper's devices by number of triangles ("Computational Complexity").
pub struct Complexity {
    /// Millions of triangles.
    pub triangles: [f64; 9],
    /// The systems: the method here that corresponds to each, and its times in ms.
    pub systems: [(&'static str, [f64; 9]); 4],
}

/// The paper's four systems. The text's "51.40 %" leaves out the smallest scene.
pub const COMPLEXITY: Complexity = Complexity {
    triangles: [1.584, 3.024, 4.464, 5.904, 7.344, 8.784, 10.224, 11.664, 13.104],
    systems: [
        ("yoro-paper", [18.80, 25.13, 37.01, 48.58, 60.82, 74.38, 87.26, 97.86, 111.08]),
        ("conventional", [25.27, 48.26, 70.73, 93.87, 119.00, 145.42, 170.53, 193.35, 217.85]),
        ("hybrid", [24.63, 41.65, 57.83, 75.36, 96.87, 119.37, 139.49, 155.33, 178.17]),
        ("instanced", [22.21, 37.11, 52.89, 72.99, 90.59, 111.12, 127.42, 145.56, 164.99]),
    ],
};

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

/// CPU load and memory in one scene. Each array has YORO, conventional rendering and Fink et al.
pub struct Overhead {
    /// CPU load in percent.
    pub cpu: [f64; 3],
    /// Memory in MB.
    pub memory: [f64; 3],
}

/// The overhead in each of [`SCENES`]: "System Overhead" and Table "image quality".
pub const OVERHEAD: [Overhead; 8] = [
    overhead([42.4, 55.4, 44.8], [52.2, 56.9, 55.8]),
    overhead([33.2, 52.0, 48.6], [70.2, 72.5, 72.1]),
    overhead([35.2, 50.3, 46.8], [60.3, 63.1, 62.4]),
    overhead([32.4, 54.6, 47.9], [51.3, 53.8, 53.3]),
    overhead([30.5, 50.3, 45.7], [50.5, 52.9, 52.4]),
    overhead([39.5, 55.9, 50.0], [56.1, 57.7, 57.2]),
    overhead([41.4, 48.2, 48.5], [61.7, 63.5, 62.4]),
    overhead([28.2, 54.9, 48.9], [61.8, 63.5, 62.4]),
];

/// The methods here that correspond to the columns of [`Overhead`].
pub const OVERHEAD_METHODS: [&str; 3] = ["yoro-paper", "conventional", "hybrid"];

const fn overhead(cpu: [f64; 3], memory: [f64; 3]) -> Overhead {
    Overhead { cpu, memory }
}

/// Power in mW in each of [`SCENES`]: YORO, conventional rendering, Fink et al. Computed from battery percentage,
/// capacity and 3.7 V; means over the devices.
pub const POWER: [[f64; 3]; 8] = [
    [367.0, 501.0, 441.0],
    [292.0, 391.0, 430.0],
    [318.0, 402.0, 441.0],
    [308.0, 430.0, 465.0],
    [289.0, 398.0, 410.0],
    [351.0, 486.0, 481.0],
    [431.0, 577.0, 525.0],
    [387.0, 569.0, 556.0],
];

/// A device of Table "Performance on different mobile devices": YORO's change over conventional in percent.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PaperDevice {
    /// The device's name in the paper.
    pub name: &'static str,
    /// Battery capacity in milliampere-hours.
    pub capacity_mah: f64,
    /// Change of power.
    pub power: f64,
    /// Change of the frame rate.
    pub fps: f64,
    /// Change of the "execution time", which is the inverse of the frame rate for all devices but the Quest 3.
    pub time: f64,
    /// Change of memory.
    pub memory: f64,
}

/// The eight devices, in the paper's order.
pub const DEVICES: [PaperDevice; 8] = [
    device("Honor 8", 3000.0, [-35.0, 149.64, -59.94, -2.13]),
    device("Honor 30", 4000.0, [-24.0, 142.65, -58.79, -2.33]),
    device("Honor 30s", 4000.0, [-25.0, 151.51, -60.24, -2.26]),
    device("Samsung Galaxy S10", 3400.0, [-31.0, 169.77, -62.93, -4.64]),
    device("Samsung Galaxy S21 5G", 4000.0, [-15.0, 133.57, -57.19, -4.57]),
    device("Xiaomi MI 6", 3350.0, [-49.0, 139.31, -58.21, -4.55]),
    device("Meta Quest 2", 3636.0, [-6.0, 49.03, -32.87, -1.26]),
    device("Meta Quest 3", 5050.0, [-4.0, 22.63, -17.49, -2.90]),
];

const fn device(name: &'static str, capacity_mah: f64, percent: [f64; 4]) -> PaperDevice {
    let [power, fps, time, memory] = percent;
    PaperDevice { name, capacity_mah, power, fps, time, memory }
}

/// A question of "User Study on Immersive Experience": YORO against conventional rendering, 14 participants, eight
/// scenes, ratings on a slider from 1 to 5.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PaperQuestion {
    /// The question's name.
    pub name: &'static str,
    /// The statistic t of the paired t-test.
    pub t: f64,
    /// Its two-sided p.
    pub p: f64,
    /// Cohen's d_z.
    pub d_z: f64,
    /// The power, computed post hoc.
    pub power: f64,
    /// The interval of the difference. It is a 95 % interval: no other confidence agrees with that t and n, although
    /// two one-sided tests at 5 % call for 90 %.
    pub interval: [f64; 2],
    /// The lower p of the two one-sided tests, with bounds -0.5 and 0.5.
    pub p_lower: f64,
    /// The upper p of the same tests.
    pub p_upper: f64,
}

/// The number of participants of the paper's study.
pub const STUDY_PARTICIPANTS: usize = 14;

/// The two questions of the study.
pub const STUDY: [PaperQuestion; 2] = [
    PaperQuestion {
        name: "image quality",
        t: 0.6196,
        p: 0.5462,
        d_z: 0.1656,
        power: 0.0887,
        interval: [-0.0559, 0.1008],
        p_lower: 1.1343e-9,
        p_upper: 3.4048e-9,
    },
    PaperQuestion {
        name: "user experience",
        t: 0.2946,
        p: 0.7730,
        d_z: 0.0787,
        power: 0.0586,
        interval: [-0.0802, 0.1055],
        p_lower: 1.1266e-8,
        p_upper: 2.0626e-8,
    },
];

/// "Comparison with Single Pass Instancing" with fewer than five lights: the method here, frames per second, and CPU
/// load in percent; means over scenes and devices.
pub const FEW_LIGHTS: [(&str, f64, f64); 4] = [
    ("yoro-paper", 68.2, 28.3),
    ("conventional", 58.2, 39.4),
    ("hybrid", 54.3, 41.7),
    ("instanced", 57.8, 46.2),
];

/// "Adaptive Shading Style": our name of the style, SSIM, PSNR in dB.
pub const STYLES: [(&str, f64, f64); 5] = [
    ("voxel", 0.964, 36.1),
    ("cartoon", 0.979, 34.0),
    ("realistic", 0.980, 41.9),
    ("low-poly", 0.963, 31.3),
    ("anime", 0.964, 28.7),
];

/// "Adjustable Interpupillary Distance": mm, SSIM, PSNR in dB. The text's mean PSNR, 31.31, is not their mean.
pub const IPD: [(f64, f64, f64); 6] = [
    (50.0, 0.9668, 34.43),
    (55.0, 0.9656, 34.16),
    (60.0, 0.9640, 33.91),
    (65.0, 0.9628, 33.68),
    (70.0, 0.9614, 33.44),
    (75.0, 0.9601, 33.19),
];

/// "Impact of Object Distance": SSIM, and PSNR in dB. The text gives nothing else for 0.5 to 3 m.
pub const DISTANCE: (f64, f64) = (0.95, 38.73);

/// A patcher in the paper's comparison.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PaperPatcher {
    /// The patcher's name here.
    pub name: &'static str,
    /// PSNR in dB.
    pub psnr: f64,
    /// SSIM; the paper does not name the window.
    pub ssim: f64,
    /// Patching time in ms on mobile devices.
    pub ms: f64,
}

/// Table "image inpainting/patching algorithms".
pub const PATCHERS: [PaperPatcher; 6] = [
    patcher("paper", 34.09, 0.9679, 0.35),
    patcher("median", 31.01, 0.9516, 0.45),
    patcher("xiao", 29.21, 0.9170, 1.02),
    patcher("telea", 32.25, 0.9542, 48.8),
    patcher("navier-stokes", 31.96, 0.9539, 28.0),
    patcher("neural", 28.07, 0.9413, 37142.0),
];

const fn patcher(name: &'static str, psnr: f64, ssim: f64, ms: f64) -> PaperPatcher {
    PaperPatcher { name, psnr, ssim, ms }
}

/// "Immersive Content Streaming" with H.264: the scene, and the kbit/s of RGB + depth and of stereo RGB. The paper does
/// not give quality, resolution or frame rate.
pub const BANDWIDTH: [(&str, f64, f64); 8] = [
    ("Bistro", 2676.0, 4627.0),
    ("SciFiCity", 4086.0, 7318.0),
    ("Conference", 1178.0, 1829.0),
    ("Sponza", 966.0, 1500.0),
    ("LostEmpire", 2492.0, 4310.0),
    ("Prototype", 1978.0, 3226.0),
    ("Chat", 1297.0, 2160.0),
    ("UnityChan", 1827.0, 2975.0),
];

/// Returns the paper's scene with this name, ignoring case, spaces and punctuation.
pub fn find(name: &str) -> Option<&'static PaperScene> {
    let plain = |name: &str| -> String {
        name.chars().filter(|c| c.is_alphanumeric()).flat_map(char::to_lowercase).collect()
    };
    SCENES.iter().find(|scene| plain(scene.name) == plain(name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scenes_are_found_by_name() {
        assert_eq!(find("Lost Empire").unwrap().psnr, 39.25);
        assert_eq!(find("unity-chan").unwrap().name, "UnityChan");
        assert_eq!(find("Teapot"), None);
    }

    #[test]
    fn the_averages_belong_to_the_rows() {
        // Catches typing errors: the mean frame rate over the scenes is the paper's mean.
        let mean = |value: fn(&PaperScene) -> f64| SCENES.iter().map(value).sum::<f64>() / 8.0;
        assert!((mean(|s| s.fps_yoro) - AVERAGE.fps_yoro).abs() < 0.1);
        assert!((mean(|s| s.fps_conventional) - AVERAGE.fps_conventional).abs() < 0.1);
        assert!((mean(|s| s.fps_fink) - AVERAGE.fps_fink).abs() < 0.1);
        // The averages of quality weigh each image group equally, so they are only near the scenes' mean.
        assert!((mean(|s| s.psnr) - AVERAGE.psnr).abs() < 1.0);
        assert!((mean(|s| s.ssim) - AVERAGE.ssim).abs() < 0.005);
    }

    #[test]
    fn the_tables_give_the_papers_own_summaries() {
        let mean = |values: Vec<f64>| values.iter().sum::<f64>() / values.len() as f64;
        let near = |ours: f64, papers: f64, within: f64| {
            assert!((ours - papers).abs() < within, "{ours} is not {papers}");
        };
        for (column, (cpu, memory)) in [(35.4, 58.02), (52.7, 60.51), (47.7, 59.75)].into_iter().enumerate() {
            near(mean(OVERHEAD.iter().map(|o| o.cpu[column]).collect()), cpu, 0.1);
            near(mean(OVERHEAD.iter().map(|o| o.memory[column]).collect()), memory, 0.1);
        }
        // The share of conventional rendering's time, without the smallest scene.
        let conventional = &COMPLEXITY.systems[1].1;
        for (method, share) in [("yoro-paper", 51.40), ("hybrid", 81.97), ("instanced", 75.96)] {
            let system = &COMPLEXITY.systems.iter().find(|s| s.0 == method).unwrap().1;
            near(mean((1..9).map(|i| 100.0 * system[i] / conventional[i]).collect()), share, 0.6);
            assert!(!self::system(method).is_empty());
        }
        near(mean(IPD.iter().map(|p| p.1).collect()), 0.963, 0.0006);
        near(mean(IPD.iter().map(|p| p.2).collect()), 33.80, 0.01);
        near(100.0 * mean(BANDWIDTH.iter().map(|b| b.1 / b.2 - 1.0).collect()), -39.6, 0.1);
        assert!(BANDWIDTH.iter().all(|b| find(b.0).is_some()));
        near(mean(STYLES.iter().map(|s| s.1).collect()), 0.97, 0.001);
        assert_eq!(PATCHERS[0].psnr, AVERAGE.psnr);
        for (column, power) in [343.0, 469.0, 469.0].into_iter().enumerate() {
            near(mean(POWER.iter().map(|p| p[column]).collect()), power, 0.6);
        }
        for device in &DEVICES[..7] {
            near(100.0 / (1.0 + device.fps / 100.0) - 100.0, device.time, 0.05);
        }
    }
}
