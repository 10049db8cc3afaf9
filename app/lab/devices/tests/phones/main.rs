//! Runs and experiments on simulated devices, in virtual time.

mod conditions;
mod experiments;
mod replay;
mod runs;

use std::collections::BTreeSet;
use std::path::Path;

use yoro_devices::capture::{self, Capture, FaultKind};
use yoro_devices::report::DeviceReport;

/// Reads the run in a folder.
fn read(folder: &Path) -> Capture {
    capture::read(folder).unwrap()
}

fn kinds(capture: &Capture) -> Vec<FaultKind> {
    let kinds: BTreeSet<FaultKind> = capture.info.faults.iter().map(|fault| fault.kind).collect();
    kinds.into_iter().collect()
}

fn fault(kind: &str, rest: &str) -> String {
    format!("[[device.fault]]\nkind = \"{kind}\"\n{rest}\n")
}

/// Returns the report of all captures in a folder, as a value of JSON and as Markdown.
fn report(folder: &Path) -> (serde_json::Value, String) {
    let runs = capture::find(&[folder.into()]).unwrap();
    let set = runs.into_iter().map(|run| (run.clone(), read(&run))).collect();
    let report = DeviceReport::new(&[set], "conventional", &Default::default(), "a test".into());
    (serde_json::from_str(&report.to_json().unwrap()).unwrap(), report.to_markdown())
}
