//! The paper's own figures, to be printed beside ours and marked as the paper's.
//!
//! Source: "You Only Render Once", MobiSys '25: image quality per scene over 29,128 image groups, and mean frame
//! rates over six phones and a Quest 2. Their scenes, cameras and machines are not ours: the figures say what to
//! expect, not what to reproduce.

use serde::Serialize;

/// What the paper reports of one of its scenes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PaperScene {
    /// Its name in the paper.
    pub name: &'static str,
    /// PSNR of the synthesized eye in dB.
    pub psnr: f64,
    /// SSIM of the synthesized eye; the paper does not name the window.
    pub ssim: f64,
    /// Frames a second, YORO.
    pub fps_yoro: f64,
    /// Frames a second, conventional: two full passes.
    pub fps_conventional: f64,
    /// Frames a second, the hybrid rendering of Fink et al.
    pub fps_fink: f64,
}

impl PaperScene {
    /// Frame time of YORO over frame time of conventional rendering.
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

/// The paper's scene called `name`; case, spaces and punctuation do not count.
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
        // Typing errors show here: the frame rates' mean over the scenes is the paper's mean.
        let mean = |value: fn(&PaperScene) -> f64| SCENES.iter().map(value).sum::<f64>() / 8.0;
        assert!((mean(|s| s.fps_yoro) - AVERAGE.fps_yoro).abs() < 0.1);
        assert!((mean(|s| s.fps_conventional) - AVERAGE.fps_conventional).abs() < 0.1);
        assert!((mean(|s| s.fps_fink) - AVERAGE.fps_fink).abs() < 0.1);
        // The quality averages weigh each image group, so they only have to lie near the scenes' mean.
        assert!((mean(|s| s.psnr) - AVERAGE.psnr).abs() < 1.0);
        assert!((mean(|s| s.ssim) - AVERAGE.ssim).abs() < 0.005);
    }
}
