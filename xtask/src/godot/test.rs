//! Tests of the add-on, by the pictures of the demo project and Godot's output.

use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

use anyhow::{Context as _, bail};

use crate::cargo;
use crate::folders::{make_parent, remove, target_folder};
use crate::package::{Target, package};

use super::pictures::{Case, Quality, compare};
use super::project;
use super::session::Session;

const RENDERERS: [&str; 2] = ["mobile", "forward_plus"];
/// Time limit of a run. None takes longer on two busy processor cores.
const LIMIT: Duration = Duration::from_secs(300);

/// A scene of the project, and the pictures that it writes.
struct Scene {
    name: &'static str,
    headset: bool,
    cases: &'static [Case],
}

const SCENES: [Scene; 2] = [
    Scene {
        name: "screen",
        headset: false,
        cases: &[
            ["plain", "left", "plain"],
            ["plain-holes", "left", "plain"],
            ["swapped", "right", "plain"],
            ["swapped-holes", "right", "plain"],
            ["ipd0", "left", "ipd0"],
            ["msaa", "left", "msaa"],
            ["msaa-holes", "left", "msaa"],
            ["glow", "left", "glow"],
            ["linear", "left", "linear"],
            ["resized", "left", "resized"],
            ["lamp", "left", "lamp"],
            ["auto", "left", "plain"],
        ],
    },
    Scene {
        name: "headset",
        headset: true,
        cases: &[
            ["plain", "left", "plain"],
            ["plain-holes", "left", "plain"],
            ["msaa", "left", "msaa"],
            ["msaa-holes", "left", "msaa"],
            ["swapped", "right", "plain"],
            ["resized", "left", "resized"],
        ],
    },
];
/// In all scenes: what the inset shows of either eye, with levels and without them; all else of the synthesized one,
/// against an eye that is rendered with the same levels; and its inset with rendered holes.
const LEVELS: [Case; 6] = [
    ["fovea", "left", "fovea"],
    ["whole", "left", "fovea"],
    ["rendered-fovea", "right", "fovea"],
    ["rendered-whole", "right", "fovea"],
    ["rest", "left", "rest"],
    ["fovea-holes", "left", "fovea"],
];
/// Maximum loss of the fovea by levels.
const LOSS: Quality = Quality { psnr: 0.1, ssim: 0.001 };
/// Minimum similarity of the synthesized eye to Godot's: PSNR in dB before and after tone mapping, and SSIM.
const MIN_PSNR: f64 = 35.0;
const TONE_MAPPED: f64 = 32.5;
const MIN_SSIM: f64 = 0.975;
/// Minimum gain in PSNR over showing the same image to both eyes, in dB.
const GAIN: f64 = 10.0;
/// Minimum gain in PSNR by rendered holes over filled ones, in dB.
const HOLES_GAIN: f64 = 0.5;
/// Minimum PSNR in dB if the distance between the eyes is 0, where nothing has to move.
const IDENTITY: f64 = 60.0;
/// Maximum difference of the rendered pose from the shown one, in radians and metres.
const LAG: f64 = 1e-4;
/// What the scenes and the editor's script print if all is well.
const FACTS: &str = include_str!("facts.txt");
/// What Godot 4.6 prints at exit for any project with OpenXR on Monado, and what the add-on rightly says of a scene.
const USUAL: [&str; 3] = [
    "YoroCamera3D: there is no preview, since the camera's projection is not a perspective",
    "Attempt to disconnect a nonexistent connection from '<OpenXRSpatialEntityExtension",
    "RID allocations of type 'N9OpenXRAPI18InteractionProfileE' were leaked at exit",
];

/// Runs all tests, and prints a line per picture. Without Godot, skips them with a message.
pub fn test() -> anyhow::Result<()> {
    let session = match Session::begin() {
        Ok(session) => session,
        Err(error) => {
            println!("Godot cannot be had here: the add-on's tests were left out: {error:#}");
            return Ok(());
        }
    };
    let start = Instant::now();
    package(&[Target::Godot])?;
    let project = project()?.display().to_string();
    let folder = target_folder()?.join("godot-tests");
    remove(&folder)?;
    let mut faults = Vec::new();
    let import = folder.join("import");
    make_parent(&import.join("log"))?;
    let headless = ["--path", &project, "--xr-mode", "off", "--headless", "--import"];
    faults.extend(errors(&session.godot(&headless, &import, LIMIT)?));
    faults.extend(edit(&session, &project, &folder.join("editor"))?);
    let program = cargo::program("yoro")?;
    let program = program.get_program().to_owned();
    for scene in &SCENES {
        for renderer in RENDERERS {
            let what = format!("{} {renderer}", scene.name);
            let run = folder.join(what.replace(' ', "-"));
            make_parent(&run.join("log"))?;
            let printed = play(&session, scene, renderer, &project, &run)?;
            let mut found = errors(&printed);
            found.extend(missing(scene, &printed));
            let cases: Vec<Case> = scene.cases.iter().chain(&LEVELS).copied().collect();
            match compare(&mut || Command::new(&program), &run, &cases) {
                Ok(figures) => {
                    found.extend(lost(&figures[scene.cases.len()..][..4]));
                    found.extend(hardly_gained(&cases, &figures));
                    for ([case, ..], [made, same]) in cases.iter().zip(figures) {
                        println!(
                            "{what} {case}: {:.2} dB, SSIM {:.4}; the same image to both eyes {:.2} dB, {:.4}",
                            made.psnr, made.ssim, same.psnr, same.ssim
                        );
                        found.extend(too_far(scene, case, made, same));
                    }
                }
                Err(error) => found.push(format!("{error:#}")),
            }
            faults.extend(found.into_iter().map(|fault| format!("{what}: {fault}")));
        }
    }
    println!("Godot: {} s", start.elapsed().as_secs());
    if !faults.is_empty() {
        bail!("the add-on has faults; logs and pictures are in {}:\n{}", folder.display(), faults.join("\n"));
    }
    Ok(())
}

/// Runs a script that operates the editor's menu. Ignores leaks of an editor that is ended by a script.
fn edit(session: &Session, project: &str, folder: &Path) -> anyhow::Result<Vec<String>> {
    make_parent(&folder.join("log"))?;
    let script = "res://test/editor.gd";
    let arguments = ["--path", project, "--xr-mode", "off", "--headless", "--editor", "--script", script];
    let printed = session.godot(&arguments, folder, LIMIT)?;
    let faults = errors(&printed).into_iter().filter(|error| error.starts_with("SCRIPT"));
    Ok(faults.chain(unsaid("editor", &printed)).map(|fault| format!("editor: {fault}")).collect())
}

fn play(
    session: &Session,
    scene: &Scene,
    renderer: &str,
    project: &str,
    folder: &Path,
) -> anyhow::Result<String> {
    let runtime = scene.headset.then(|| session.runtime(folder)).transpose()?;
    let file = format!("res://test/{}.tscn", scene.name);
    let out = format!("out={}", folder.display());
    let godot = format!("godot={}", session.program().display());
    let xr = if scene.headset { "on" } else { "off" };
    // A hundred frames for the first renderer only, since the other one runs the same scripts.
    let frames = if renderer == RENDERERS[0] { "frames=100" } else { "frames=60" };
    let arguments = [
        "--path",
        project,
        "--audio-driver",
        "Dummy",
        "--xr-mode",
        xr,
        "--rendering-method",
        renderer,
        &file,
        "--",
        &out,
        &godot,
        frames,
    ];
    let printed = session.godot(&arguments, folder, LIMIT);
    drop(runtime);
    printed.with_context(|| format!("{} {renderer}", scene.name))
}

/// Returns unexpected errors and warnings of Godot and of scripts.
fn errors(printed: &str) -> Vec<String> {
    let is_one = |line: &&str| {
        let text = line.trim_start_matches("USER ").trim_start_matches("SCRIPT ");
        text.starts_with("ERROR:") || text.starts_with("WARNING:")
    };
    let new = |line: &&str| !USUAL.iter().any(|usual| line.contains(usual));
    let mut found: Vec<String> = printed.lines().filter(is_one).filter(new).map(str::to_owned).collect();
    found.dedup();
    found
}

/// Returns what a scene should have printed but did not.
fn missing(scene: &Scene, printed: &str) -> Vec<String> {
    let mut missing: Vec<String> = unsaid(scene.name, printed).collect();
    if scene.headset {
        match lag(printed) {
            Some(lag) if lag < LAG => {}
            lag => missing.push(format!("the rendered pose is late: {lag:?}")),
        }
    }
    missing
}

/// Returns the facts of a section that were not printed.
fn unsaid(section: &str, printed: &str) -> impl Iterator<Item = String> {
    let facts = facts(section).filter(|fact| !printed.contains(&fact.replace('$', "\n")));
    facts.map(|fact| format!("it does not say `{fact}`"))
}

fn facts(section: &str) -> impl Iterator<Item = &'static str> {
    let header = format!("[{section}]");
    let own = FACTS.lines().skip_while(move |line| *line != header).skip(1);
    own.take_while(|line| !line.starts_with('[')).filter(|line| !line.starts_with('#'))
}

/// Returns the larger number of the line `fact lag A rad, B m`.
fn lag(printed: &str) -> Option<f64> {
    let line = printed.lines().find_map(|line| line.strip_prefix("fact lag "))?;
    let (radians, metres) = line.split_once(" rad, ")?;
    let metres: f64 = metres.strip_suffix(" m")?.parse().ok()?;
    Some(radians.parse::<f64>().ok()?.max(metres))
}

fn too_far(scene: &Scene, case: &str, made: Quality, same: Quality) -> Option<String> {
    // A headset's pictures are copied before tone mapping.
    let floor = if scene.headset || case == "linear" { MIN_PSNR } else { TONE_MAPPED };
    let sound = match case {
        "ipd0" => made.psnr >= IDENTITY,
        // Parts with more edges than the whole, which are compared with each other.
        "fovea" | "whole" | "fovea-holes" => made.psnr >= same.psnr + GAIN,
        _ => made.psnr >= floor && made.ssim >= MIN_SSIM && made.psnr >= same.psnr + GAIN,
    };
    (!sound).then(|| format!("{case} is too far from Godot's own eye: {:.2} dB, {:.4}", made.psnr, made.ssim))
}

/// Returns what rendered holes gain over the case without them, if that is too little.
fn hardly_gained(cases: &[Case], figures: &[[Quality; 2]]) -> Vec<String> {
    let find = |name: &str| Some(figures[cases.iter().position(|case| case[0] == name)?][0].psnr);
    let gain = |[case, ..]: &Case| Some((*case, find(case)? - find(case.strip_suffix("-holes")?)?));
    let small = cases.iter().filter_map(gain).filter(|(_, gain)| *gain < HOLES_GAIN);
    small.map(|(case, gain)| format!("{case} gains too little: {gain:.2} dB")).collect()
}

/// Returns what each eye's fovea loses by levels, if that is too much. The figures are the first four of [`LEVELS`].
fn lost(figures: &[[Quality; 2]]) -> impl Iterator<Item = String> {
    let losses = figures.chunks_exact(2).map(|eye| {
        let ([fovea, _], [whole, _]) = (eye[0], eye[1]);
        Quality { psnr: whole.psnr - fovea.psnr, ssim: whole.ssim - fovea.ssim }
    });
    let large = losses.filter(|loss| loss.psnr > LOSS.psnr || loss.ssim > LOSS.ssim);
    large.map(|loss| format!("a fovea loses by levels: {:.2} dB, {:.4}", loss.psnr, loss.ssim))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unusual_errors_are_found_once() {
        let usual =
            "ERROR: 10 RID allocations of type 'N9OpenXRAPI18InteractionProfileE' were leaked at exit.";
        let printed =
            format!("{usual}\nERROR: a\nERROR: a\n   at: b\nSCRIPT ERROR: c\nWARNING: 2 RIDs of type\n");
        assert_eq!(errors(&printed), ["ERROR: a", "SCRIPT ERROR: c", "WARNING: 2 RIDs of type"]);
    }

    #[test]
    fn a_late_pose_and_a_silent_scene_are_faults() {
        let said = "fact views 2\nfact auto takes what is cheaper of both: true, compiles and allocates nothing in \
                    turns: true\nfact near [false, false, true, true, false]\n\
                    fact paused true, drawn 0, rests true\nfact resumed, as before true, bytes more 0\n\
                    fact trouble \nfact lag 0.0000001 rad, 0.0000020 m\nfact done\n";
        assert_eq!(lag(said), Some(0.000_002));
        assert!(missing(&SCENES[1], said).is_empty());
        assert_eq!(missing(&SCENES[1], &said.replace("0.0000001", "0.03")).len(), 1);
        assert_eq!(missing(&SCENES[1], &said.replace("trouble ", "trouble canted")).len(), 1);
        assert_eq!(missing(&SCENES[0], said).len(), facts("screen").count() - 2);
    }

    #[test]
    fn an_eye_like_the_other_one_is_too_far() {
        let quality = |psnr| Quality { psnr, ssim: 0.98 };
        assert!(too_far(&SCENES[1], "plain", quality(36.0), quality(22.0)).is_none());
        assert!(too_far(&SCENES[1], "plain", quality(34.0), quality(22.0)).is_some());
        assert!(too_far(&SCENES[1], "plain", quality(36.0), quality(30.0)).is_some());
        assert!(too_far(&SCENES[0], "plain", quality(34.0), quality(22.0)).is_none());
        assert!(too_far(&SCENES[0], "linear", quality(34.0), quality(22.0)).is_some());
        assert!(too_far(&SCENES[0], "ipd0", quality(36.0), quality(36.0)).is_some());
    }

    #[test]
    fn rendered_holes_must_gain() {
        let figures = |holes| [36.0, holes].map(|psnr| [Quality { psnr, ssim: 0.98 }; 2]);
        let cases = &SCENES[0].cases[..2];
        assert!(hardly_gained(cases, &figures(37.5)).is_empty());
        assert_eq!(hardly_gained(cases, &figures(36.2)).len(), 1);
    }

    #[test]
    fn a_fovea_may_lose_a_tenth_of_a_decibel() {
        let figures = |fovea, ssim| {
            let others = [36.0, 50.0, 50.0, 34.0].map(|psnr| [Quality { psnr, ssim: 0.98 }; 2]);
            [[[Quality { psnr: fovea, ssim }; 2]].as_slice(), &others].concat()
        };
        assert_eq!(lost(&figures(35.95, 0.9795)).count(), 0);
        assert_eq!(lost(&figures(35.85, 0.98)).count(), 1);
        assert_eq!(lost(&figures(36.0, 0.97)).count(), 1);
    }
}
