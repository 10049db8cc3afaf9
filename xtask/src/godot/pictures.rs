//! Compares the pictures of both eyes that Godot's tests write, by `yoro compare`.

use std::path::Path;
use std::process::Command;

use anyhow::Context as _;
use serde_json::Value;

use crate::console::run;
use crate::folders::copy;

/// The similarity of two pictures.
#[derive(Clone, Copy, Debug)]
pub struct Quality {
    /// PSNR in dB over all three channels. Infinite for identical pictures.
    pub psnr: f64,
    /// SSIM of luma.
    pub ssim: f64,
}

/// A test case: the name of its pictures, the synthesized eye, and the case with Godot's pictures of the same view.
pub type Case = [&'static str; 3];

/// Compares the synthesized eye and the rendered eye of each case with what Godot draws for the synthesized eye.
pub fn compare(
    yoro: &mut dyn FnMut() -> Command,
    folder: &Path,
    cases: &[Case],
) -> anyhow::Result<Vec<[Quality; 2]>> {
    let place = |kind: &str, case: &str| folder.join("compared").join(kind).join(format!("{case}.png"));
    for [case, made, godot] in cases {
        let other = if *made == "left" { "right" } else { "left" };
        for (kind, of, mode, eye) in [
            ("made", case, "one_view", *made),
            ("truth", godot, "both_views", *made),
            // The distance between Godot's two eyes is the same in both directions.
            ("same", godot, "both_views", other),
        ] {
            if kind == "same" && case != godot {
                continue;
            }
            copy(&folder.join(format!("{of}-{mode}-{eye}.png")), &place(kind, case))?;
        }
    }
    let compared = folder.join("compared");
    let mut told = |kind: &str| {
        let folders = [compared.join(kind), compared.join("truth")];
        let text = run(yoro().args(["compare", "--json"]).args(folders))?;
        anyhow::Ok(serde_json::from_str::<Value>(&text)?)
    };
    let (made, same) = (told("made")?, told("same")?);
    let find = |told, case| quality(told, case).with_context(|| format!("{case} was not compared"));
    cases.iter().map(|[case, _, godot]| Ok([find(&made, case)?, find(&same, godot)?])).collect()
}

/// Reads a pair from the output of `yoro compare --json`.
fn quality(told: &Value, case: &str) -> Option<Quality> {
    let file = format!("{case}.png");
    let pair = told["pairs"].as_array()?.iter().find(|pair| pair["name"] == *file)?;
    let psnr = if pair["identical"] == true { f64::INFINITY } else { pair["rgb"]["psnr"].as_f64()? };
    Some(Quality { psnr, ssim: pair["luma"]["ssim_gaussian"].as_f64()? })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn identical_pictures_have_no_error() {
        let told = serde_json::json!({ "pairs": [
            { "name": "a.png", "identical": false, "rgb": { "psnr": 36.5 }, "luma": { "ssim_gaussian": 0.98 } },
            { "name": "b.png", "identical": true, "rgb": { "psnr": null }, "luma": { "ssim_gaussian": 1.0 } },
        ]});
        assert_eq!(quality(&told, "a").map(|it| (it.psnr, it.ssim)), Some((36.5, 0.98)));
        assert!(quality(&told, "b").is_some_and(|it| it.psnr.is_infinite()));
        assert!(quality(&told, "c").is_none());
    }
}
