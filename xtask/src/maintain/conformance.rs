//! The automatic cases of Khronos's OpenXR conformance tests, on [Monado](super::monado) alone and through the API layer.
//! Whoever runs them has built the suite; their results are compared with a table.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::os::unix::fs::symlink;
use std::path::Path;
use std::process::{Command, Stdio};

use anyhow::{Context as _, ensure};

use super::{hello_xr, monado};
use crate::folders::{files, make, read_text, remove, root, target_folder, write};
use crate::godot::session::Screen;
use crate::package::layer::{LIBRARY, MANIFEST, explicit_manifest};
use crate::{cargo, console};

/// The results that are known: a letter for each run of each way, and the case.
const TABLE: &str = include_str!("conformance.txt");
const GRAPHICS: [&str; 2] = ["Vulkan2", "OpenGL"];
/// What Xvfb lacks, and the suite's window code asks for.
const VIDEO_MODES: &str = include_str!("video_modes.c");
const LAYER: &str = "XR_APILAYER_YORO_one_view";
/// The suite's layer that checks calls. The suite puts it below all others that it is not told about.
const CHECKS: &str = "XR_APILAYER_KHRONOS_runtime_conformance";

/// A way to run the suite with each of the graphics.
struct Way {
    name: &'static str,
    arguments: &'static [&'static str],
    /// Layers, beginning with the one nearest to the suite.
    layers: &'static [&'static str],
}

const WAYS: [Way; 4] = [
    Way { name: "alone", arguments: &[], layers: &[] },
    Way { name: "stereo", arguments: &[], layers: &[CHECKS, LAYER] },
    Way { name: "mono", arguments: &["-V", "Mono"], layers: &[CHECKS, LAYER] },
    Way { name: "mono-checked-below", arguments: &["-V", "Mono"], layers: &[LAYER, CHECKS] },
];

/// The letters of each case: P passed, S skipped, F failed, - absent.
type Cases = BTreeMap<String, String>;

/// Runs the suite in the folder of its program in every way. Returns a report, and true if all results are the table's.
pub(crate) fn perform(suite: &Path) -> anyhow::Result<(String, bool)> {
    let program = suite.join("conformance_cli");
    ensure!(program.is_file(), "{} is missing: give the folder in which it was built", program.display());
    let programs = hello_xr::make()?;
    let arguments = ["build", "--quiet", "--package", "yoro-openxr-layer"];
    cargo::perform(cargo::cargo().args(arguments), "the layer does not compile")?;
    let folder = target_folder()?.join("conformance");
    gather(suite, &folder.join("suite"))?;
    let (source, modes) = (folder.join("video_modes.c"), folder.join("video_modes.so"));
    write(&source, VIDEO_MODES)?;
    console::run(Command::new("cc").args(["-shared", "-fPIC", "-o"]).args([&modes, &source]))?;
    let screen = Screen::start()?;
    let (mut found, mut report) = (Cases::new(), String::new());
    let runs = GRAPHICS.iter().flat_map(|graphics| WAYS.iter().map(move |way| (graphics, way)));
    for (column, (graphics, way)) in runs.enumerate() {
        let mut command = Command::new(programs.join("run"));
        command.env("DISPLAY", &screen.display).env("LD_PRELOAD", &modes);
        let name = format!("{graphics}-{}", way.name);
        eprintln!("{name}: some minutes");
        let cases = outcomes(&run(command, graphics, way, &folder, &folder.join(&name), &programs)?);
        let [passed, failed, skipped] =
            ['P', 'F', 'S'].map(|it| cases.values().filter(|is| **is == it).count());
        report += &format!("{name}: {passed} passed, {failed} failed, {skipped} skipped\n");
        note(&mut found, &cases, column);
    }
    let table: String = found.iter().map(|(case, letters)| format!("{letters} {case}\n")).collect();
    write(&folder.join("conformance.txt"), &table)?;
    let differences = differences(TABLE, &table);
    report += &differences;
    Ok((report, differences.is_empty()))
}

/// Runs the suite once, with a runtime of its own, and returns the report of its reporter.
fn run(
    mut command: Command,
    graphics: &str,
    way: &Way,
    folder: &Path,
    place: &Path,
    programs: &Path,
) -> anyhow::Result<String> {
    remove(place)?;
    make(place)?;
    let (result, log) = (place.join("result.xml"), File::create(place.join("log"))?);
    let _service = monado::start(&programs.join("monado-service"), place)?;
    command.arg("./conformance_cli").args([
        "exclude:[interactive]",
        "-T",
        "--apiVersion",
        "1.1",
        "-G",
        graphics,
    ]);
    command.args(way.arguments).arg("--reporter").arg(format!("ctsxml::out={}", result.display()));
    command.envs(["XDG_RUNTIME_DIR", "XDG_CONFIG_HOME", "XDG_STATE_HOME"].map(|name| (name, place)));
    let driver = "monado/root/usr/share/vulkan/icd.d/lvp_icd.json";
    command.env("VK_DRIVER_FILES", target_folder()?.join(driver));
    if !way.layers.is_empty() {
        command.env("XR_ENABLE_API_LAYERS", way.layers.join(":"));
    }
    command.current_dir(folder.join("suite")).stdin(Stdio::null()).stdout(log.try_clone()?).stderr(log);
    // Its exit status says no more than its results.
    command.status().context("the suite cannot be started")?;
    read_text(&result).with_context(|| format!("it ended early: see {}", place.join("log").display()))
}

/// Makes a folder of links to the suite's files, with the layer's manifest: the suite looks for layers only there.
fn gather(suite: &Path, place: &Path) -> anyhow::Result<()> {
    remove(place)?;
    make(place)?;
    for (name, path) in files(suite)?.into_iter().filter(|(name, _)| !name.contains('/')) {
        symlink(fs::canonicalize(path)?, place.join(name))?;
    }
    let library = target_folder()?.join("debug").join(LIBRARY).display().to_string();
    let manifest = root().join("app/engines/openxr-layer/android").join(MANIFEST);
    write(&place.join(MANIFEST), explicit_manifest(&read_text(&manifest)?, &library))
}

/// Returns the outcome of each case, by the elements `testcase` of the suite's reporter, which have one for each section of
/// a case. A case fails if one of its sections does, and is skipped if one is.
fn outcomes(xml: &str) -> BTreeMap<String, char> {
    let mut cases = BTreeMap::new();
    for element in xml.split("<testcase ").skip(1) {
        let Some((attributes, body)) = element.split_once('>') else { continue };
        let name = attributes.split_once(" name=\"").and_then(|(_, rest)| rest.split_once('"'));
        let Some((name, _)) = name else { continue };
        let body =
            body.split("</testcase>").next().filter(|_| !attributes.ends_with('/')).unwrap_or_default();
        let outcome = match body {
            body if body.contains("<error") || body.contains("<failure") => 'F',
            body if body.contains("<skipped") => 'S',
            _ => 'P',
        };
        let case = name.split('/').next().unwrap_or(name).to_owned();
        let known = cases.entry(case).or_insert(outcome);
        let rank = |outcome| "PSF".find(outcome);
        if rank(outcome) > rank(*known) {
            *known = outcome;
        }
    }
    cases
}

/// Notes the outcomes of one run in its column.
fn note(found: &mut Cases, cases: &BTreeMap<String, char>, column: usize) {
    for case in cases.keys() {
        found.entry(case.clone()).or_insert_with(|| "-".repeat(GRAPHICS.len() * WAYS.len()));
    }
    for (case, letters) in found {
        let letter = cases.get(case).copied().unwrap_or('-');
        letters.replace_range(column..=column, letter.encode_utf8(&mut [0; 4]));
    }
}

/// Returns the rows that only one of two tables has.
fn differences(known: &str, found: &str) -> String {
    let only = |sign: char, rows: &str, others: &str| -> String {
        let rows = rows.lines().filter(|row| !others.lines().any(|other| other == *row));
        rows.map(|row| format!("{sign}{row}\n")).collect()
    };
    only('-', known, found) + &only('+', found, known)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SAMPLE: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<testsuites xmlns:cts="https://github.com/KhronosGroup/OpenXR-CTS">
  <testsuite errors="2" failures="1" skipped="1" tests="7" time="16.5">
    <properties><property name="filters" value="exclude:[interactive]"/></properties>
    <testcase classname="global" name="xrPathToString" time="0.011" status="run"/>
    <testcase classname="global" name="Swapchains/Formats/D32" time="0.1" status="run"/>
    <testcase classname="global" name="Swapchains/Formats/D16" time="0.1" status="run">
      <error message="a &lt; b" type="REQUIRE">
FAILED:
      </error>
    </testcase>
    <testcase classname="global" name="Swapchains/Others" time="0.1" status="run"/>
    <testcase classname="global" name="Cube" time="0.1" status="run">
      <skipped type="SKIP">
SKIPPED
      </skipped>
    </testcase>
    <testcase classname="global" name="Text" time="0.1" status="run">
      <system-out>
&lt;error in a text
      </system-out>
    </testcase>
    <system-out/>
  </testsuite>
</testsuites>
"#;

    #[test]
    fn a_case_is_as_bad_as_its_sections() {
        let found: Vec<(String, char)> = outcomes(SAMPLE).into_iter().collect();
        let want = [("Cube", 'S'), ("Swapchains", 'F'), ("Text", 'P'), ("xrPathToString", 'P')];
        assert_eq!(found, want.map(|(case, outcome)| (case.to_owned(), outcome)));
        // A suite that was killed leaves half a file.
        let (half, _) = SAMPLE.split_at(SAMPLE.find("FAILED").unwrap());
        assert_eq!(outcomes(half).get("Swapchains"), Some(&'F'));
        assert!(outcomes("").is_empty() && outcomes("<testcase nothing").is_empty());
    }

    #[test]
    fn other_results_than_the_tables_are_named() {
        assert_eq!(differences(TABLE, TABLE), "");
        assert_eq!(differences("PP a\nPP b\n", "PP a\nPF b\n"), "-PP b\n+PF b\n");
        // The suite's own mistake, and no other.
        assert_eq!(TABLE.lines().filter(|row| row.split(' ').next().unwrap().contains('F')).count(), 1);
    }
}
