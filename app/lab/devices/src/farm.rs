//! Device farms: the command that starts the application's game loops on many devices, and captures of the results.
//!
//! Firebase Test Lab has a folder `MODEL-VERSION-LOCALE-ORIENTATION` for each device. In it, `logcat` is the device's
//! log, and `game_loop_results/results_scenario_N.json` are the results of scenario N: lines of the log without times,
//! despite the extension. AWS Device Farm offers artefacts with other names for download, one set per device. Lines are
//! therefore recognised by their content; the names of files only decide which files are read.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use yoro_files as files;
use yoro_settings::telemetry::{LOG_TAG, Line, Pictures};

use crate::DataError;
use crate::capture::{DeviceInfo, Fault, FaultKind, Outcome, RunInfo, Sample, VERSION, Writer};
use crate::log::{self, Kind, SIMULATED_MARK};
use crate::reading::{LineContent, Reading};

/// How the run names of game loops begin: `loop-SCENARIO-STEP`.
const RUN: &str = "loop-";
/// Start of the runs of scenario 1, each of which checks the pictures of one pipeline.
pub(crate) const PICTURE_CHECK: &str = "loop-1-";
/// Seconds at the beginning of a step that are discarded as warm-up.
const WARM_UP_S: f64 = 5.0;
/// Full names or extensions of the files that are read.
const LOGS: [&str; 4] = ["logcat", "log", "txt", "json"];

/// Returns the command that plays scenarios on devices of Firebase Test Lab. A device is a model of `gcloud firebase
/// test android models list`, optionally with `=` and a version.
pub fn command(apk: &str, scenarios: &[u32], devices: &[String]) -> String {
    let scenarios: Vec<String> = scenarios.iter().map(u32::to_string).collect();
    let mut command = format!(
        "gcloud firebase test android run --type game-loop --app {apk} --scenario-numbers {} --timeout 25m",
        scenarios.join(",")
    );
    for device in devices {
        let (model, version) = device.split_once('=').unwrap_or((device, ""));
        let version = if version.is_empty() { String::new() } else { format!(",version={version}") };
        command += &format!(" \\\n    --device model={model}{version},orientation=landscape");
    }
    command
}

/// Writes a capture for each step on each device to `OUT/DEVICE/RUN`, and returns their descriptions.
///
/// If several files have lines of the same step, such as the log and the results, a file with the whole step is
/// preferred, then the one with the most samples.
pub fn read(folder: &Path, out: &Path) -> Result<Vec<RunInfo>, DataError> {
    let mut found: BTreeMap<(String, String), Step> = BTreeMap::new();
    let is_log = |path: &Path| path.ends_with(LOGS[0]) || files::has_extension(path, &LOGS);
    for path in files::find_wanted(folder, is_log)? {
        let bytes = files::read(&folder.join(&path))?;
        let device = device_name(folder, &path);
        for run in runs(&bytes) {
            let step = Step::read(&bytes, &run);
            let key = (device.clone(), run);
            if found.get(&key).is_none_or(|before| before.rank() < step.rank()) {
                found.insert(key, step);
            }
        }
    }
    if found.is_empty() {
        return Err(DataError::Unusable(format!(
            "no file below {} has a line of a game loop (run={RUN}...): name the folder with a folder for each device, with archives unpacked",
            folder.display()
        )));
    }
    found.into_iter().map(|((device, run), step)| step.write(&device, &run, out)).collect()
}

/// Returns the name of the device's folder: the first part of `path`, or the name of `folder` itself.
fn device_name(folder: &Path, path: &Path) -> String {
    let first = path.parent().and_then(|parent| parent.iter().next());
    let first = first.filter(|name| *name != "game_loop_results");
    let own = || folder.canonicalize().ok()?.file_name().map(ToOwned::to_owned);
    let name = first.map(ToOwned::to_owned).or_else(own).unwrap_or_default();
    name.to_string_lossy().into_owned()
}

fn lines(bytes: &[u8]) -> impl Iterator<Item = &[u8]> {
    bytes.split_inclusive(|byte| *byte == b'\n')
}

/// Returns the run names of the game loop steps in a log.
fn runs(bytes: &[u8]) -> BTreeSet<String> {
    let run = |line: &[u8]| match log::parse(&log::text(line)) {
        Kind::Entry(entry) if entry.tag == LOG_TAG => entry.message.parse::<Line>().ok()?.run,
        _ => None,
    };
    // The name becomes a folder's name.
    let is_name = |run: &String| {
        run.starts_with(RUN) && run.bytes().all(|byte| byte.is_ascii_alphanumeric() || byte == b'-')
    };
    lines(bytes).filter_map(run).filter(is_name).collect()
}

/// Parses the result of the picture check in a line, if it belongs to this step's pipeline.
fn pictures(text: &str, run: &str) -> Option<Pictures> {
    let Kind::Entry(entry) = log::parse(text) else { return None };
    let read: Pictures = (entry.tag == LOG_TAG).then_some(entry.message)?.parse().ok()?;
    run.strip_prefix(PICTURE_CHECK).is_some_and(|pipeline| pipeline == read.pipeline).then_some(read)
}

/// The lines of a step.
struct Step {
    pictures: Option<Pictures>,
    reading: Reading,
    samples: Vec<Sample>,
    log: Vec<u8>,
    is_whole: bool,
    simulated: bool,
}

impl Step {
    fn read(bytes: &[u8], run: &str) -> Step {
        let (reading, samples) = (Reading::new(Some(run.into())), Vec::new());
        let mut step =
            Step { pictures: None, reading, samples, log: Vec::new(), is_whole: false, simulated: false };
        let mut is_last = false;
        for line in lines(bytes) {
            let text = log::text(line);
            step.simulated |= text.starts_with(SIMULATED_MARK);
            step.pictures = pictures(&text, run).or(step.pictures);
            match step.reading.line(&text, None) {
                LineContent::Sample(sample) => {
                    step.samples.push(*sample);
                    is_last = true;
                }
                LineContent::Summary => step.is_whole |= is_last,
                LineContent::Other if text.contains(",run=") => is_last = false,
                LineContent::Damaged(_) | LineContent::Other => {}
            }
            step.log.extend_from_slice(line);
        }
        // The steps of a scenario share one session, so move each step's times to its own start.
        let begin = step.samples.first().map_or(0.0, |first| first.time_s - 1.0);
        step.samples.iter_mut().for_each(|sample| sample.time_s -= begin);
        step
    }

    fn rank(&self) -> (bool, usize) {
        (self.is_whole, self.samples.len())
    }

    fn write(self, device: &str, run: &str, out: &Path) -> Result<RunInfo, DataError> {
        let length = self.samples.last().map_or(0.0, |last| last.time_s);
        let warm_up_s = if length > 2.0 * WARM_UP_S { WARM_UP_S } else { 0.0 };
        let mut faults = self.reading.faults();
        if self.samples.iter().all(|sample| sample.current_ma.is_none() || sample.plugged.is_none()) {
            let detail = "a farm's devices hang on chargers, and the log does not say otherwise".into();
            faults.push(Fault { kind: FaultKind::PluggedIn, at_s: None, detail });
        }
        if let Some(pictures) = self.pictures.filter(|pictures| !pictures.passed()) {
            faults.push(Fault { kind: FaultKind::Pictures, at_s: None, detail: pictures.to_string() });
        }
        let scene = self.reading.methods().first().map_or("unknown", |(_, scene)| scene);
        let info = RunInfo {
            version: VERSION,
            device: device_info(device, self.simulated),
            experiment: None,
            // The methods of scenario 2 are compared. Steps of other scenarios are not repetitions of them.
            method: run.strip_prefix("loop-2-").unwrap_or(run).into(),
            scene: scene.into(),
            repetition: 1,
            order: 1,
            settings: BTreeMap::new(),
            started_unix_s: 0.0,
            duration_s: length - warm_up_s,
            warm_up_s,
            start_celsius: self.samples.first().and_then(|sample| sample.battery_celsius),
            application: None,
            outcome: Outcome::Complete,
            faults,
        };
        let mut writer = Writer::create(&out.join(device).join(run), info)?;
        writer.log(&self.log)?;
        self.samples.iter().try_for_each(|sample| writer.sample(sample))?;
        writer.finish(if self.is_whole {
            Outcome::Complete
        } else {
            Outcome::Interrupted {
                reason: "the step has no summary: the farm ended it, or it crashed".into(),
            }
        })
    }
}

/// Returns what the name of a device's folder tells: `MODEL-VERSION-LOCALE-ORIENTATION`, or just a name.
fn device_info(folder: &str, simulated: bool) -> DeviceInfo {
    let parts: Vec<&str> = folder.rsplitn(4, '-').collect();
    let (model, android) = match parts[..] {
        ["landscape" | "portrait", _, version, model] => (model, format!("API {version}")),
        _ => (folder, String::new()),
    };
    DeviceInfo { serial: folder.into(), model: model.into(), android, simulated, ..DeviceInfo::default() }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use crate::capture;
    use crate::report::DeviceReport;

    fn line(t: u32, method: &str, fps: &str) -> String {
        format!(
            "v=2,t={t}.0s,method={method},pipeline=gather,scene=street,FPS={fps}/60,Stale=1,frame=13.91ms,p99=15.20ms,App=4.49ms,CPU=na,RSS=na,mA_raw=512,mA=-512,mV=3921,level=90%,uAh=na,plug=2,Tbat=31.2C,Tskin=na,thermal=0,headroom=na,scale=1.00,imbuffer=na,frames=60,status=charging,run=loop-2-{method},perf=na,auto=na"
        )
    }

    /// Folders and files as Flutter's own tests read them from Test Lab's bucket, with a log and results.
    #[test]
    fn the_results_of_two_farms_become_captures() {
        let folder = tempfile::tempdir().unwrap();
        let put = |path: &str, text: &str| {
            let path = folder.path().join(path);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, text).unwrap();
        };
        let pictures =
            "pictures,v=2,pipeline=gather,rendered=48.20dB,synthesized=12.71dB,least=30.00dB,passed=false";
        let step = line(1, "yoro", "60.0").replace("run=loop-2-yoro", "run=loop-1-gather");
        put(
            "pilot/husky-34-en-landscape/game_loop_results/results_scenario_1.json",
            &format!("{pictures}\n{step}\nv=2,summary=1,t=1.0s\n"),
        );
        let mut results = String::from("yoro 0.1.0 starts\ngame loop: scenario 2\n");
        for (step, method) in ["conventional", "yoro"].iter().enumerate() {
            let second = |t: u32| line(65 * step as u32 + t, method, ["40.0", "59.0"][step]) + "\n";
            results.extend((1..=65).map(second));
            results += "v=2,summary=1,t=65.0s\n";
        }
        // The last step was cut off.
        results += &(line(131, "mono", "60.0") + "\n");
        put("pilot/husky-34-en-landscape/game_loop_results/results_scenario_2.json", &results);
        let logcat = line(3, "yoro", "1.0");
        let logcat = format!("11-14 22:13:20.123  4242  4260 I YORO    : {logcat}\n");
        put("pilot/husky-34-en-landscape/logcat", &logcat);
        put("pilot/husky-34-en-landscape/video.mp4", "no text");
        put("pilot/Google Pixel 6/Logcat.logcat", &logcat);

        let out = folder.path().join("captures");
        let runs = read(&folder.path().join("pilot"), &out).unwrap();
        let names: Vec<_> = runs.iter().map(|run| (&*run.device.model, &*run.method)).collect();
        let expected = [
            ("Google Pixel 6", "yoro"),
            ("husky", "loop-1-gather"),
            ("husky", "conventional"),
            ("husky", "mono"),
            ("husky", "yoro"),
        ];
        assert_eq!(names, expected);
        let about = |run: &RunInfo| {
            let fault = run.faults.iter().find(|fault| fault.kind == FaultKind::Pictures);
            fault.map(|fault| fault.detail.clone())
        };
        let faults: Vec<_> = runs.iter().map(about).collect();
        assert_eq!(faults, [None, Some(pictures.to_owned()), None, None, None]);
        assert_eq!(runs[1].device.android, "API 34");
        let is_whole = |run: &RunInfo| run.outcome == Outcome::Complete;
        assert_eq!(runs.iter().map(is_whole).collect::<Vec<_>>(), [false, true, true, false, true]);
        assert!(runs.iter().all(|run| run.faults.iter().any(|fault| fault.kind == FaultKind::PluggedIn)));
        let whole = capture::read(&out.join("husky-34-en-landscape/loop-2-yoro")).unwrap();
        assert_eq!(
            (whole.samples.len(), whole.samples[0].time_s, whole.samples[64].fps),
            (65, 1.0, Some(59.0))
        );
        assert_eq!((whole.info.warm_up_s, whole.info.duration_s), (5.0, 60.0));

        // A report of both devices has frame rates, but no power.
        let set: Vec<_> = capture::find(std::slice::from_ref(&out)).unwrap().into_iter().collect();
        let set: Vec<_> = set.into_iter().map(|run| (run.clone(), capture::read(&run).unwrap())).collect();
        let report = DeviceReport::new(&[set], "conventional", &BTreeMap::new(), String::new());
        // Five seconds of a picture check are no measurement, but wrong pictures are told with the figures.
        assert!(report.left_out.iter().any(|note| note.name == "picture check"), "{:?}", report.left_out);
        assert!(report.to_text().contains("WRONG PICTURES"), "{}", report.to_text());
        let plugged = report.left_out.iter().filter(|note| note.name == "plugged in").count();
        assert_eq!(plugged, 1, "one line for all runs: {:?}", report.left_out);
        let report = serde_json::to_string(&report).unwrap();
        assert!(report.contains("husky") && report.contains("plugged in"), "{report}");

        assert!(matches!(read(&out.join("nothing"), &out), Err(DataError::File(_))));
        put("empty/logcat", "11-14 22:13:20.123  1  2 I Other: hello\n");
        assert!(matches!(read(&folder.path().join("empty"), &out), Err(DataError::Unusable(_))));
    }

    #[test]
    fn the_command_names_every_device() {
        let command = command("yoro.apk", &[1, 2], &["husky=34".into(), "shiba".into()]);
        assert_eq!(
            command,
            "gcloud firebase test android run --type game-loop --app yoro.apk --scenario-numbers 1,2 --timeout 25m \\\n    \
             --device model=husky,version=34,orientation=landscape \\\n    \
             --device model=shiba,orientation=landscape"
        );
    }
}
