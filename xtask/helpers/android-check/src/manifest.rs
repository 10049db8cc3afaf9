//! Compares the manifest in an APK, as `aapt2` reads it, with the one that it should have. cargo-apk ignores keys that it
//! does not know, so only the result shows what Android will see.

use std::path::Path;
use std::process::Command;

use xtask::console::run;
use xtask::ndk::sdk;

use crate::check::{Report, Store};

/// What the manifest should have.
const WANTED: &str = include_str!("manifest.txt");
/// Attributes that depend on the tools and the build.
const IGNORED: [&str; 5] = [
    "compileSdkVersion",
    "compileSdkVersionCodename",
    "debuggable",
    "platformBuildVersionCode",
    "platformBuildVersionName",
];

/// What aapt2 says of an APK.
pub struct Manifest {
    tree: String,
    /// The icon's file name, which only the resources have.
    pub icon: String,
}

impl Manifest {
    /// Reads an APK's manifest.
    pub fn read(apk: &Path) -> anyhow::Result<Self> {
        let aapt2 = sdk::build_tool("aapt2")?;
        let dump = |what: &[&str]| run(Command::new(&aapt2).arg("dump").args(what).arg(apk));
        let badging = dump(&["badging"])?;
        let icon = badging.lines().find(|line| line.starts_with("application:"));
        let icon = icon.and_then(|line| line.split_once(" icon='")?.1.split('\'').next());
        Ok(Self {
            icon: icon.unwrap_or_default().to_owned(),
            tree: dump(&["xmltree", "--file", "AndroidManifest.xml"])?,
        })
    }

    /// True if the attribute, such as `:debuggable(`, is.
    pub fn has(&self, attribute: &str) -> bool {
        self.tree.lines().any(|line| line.contains(attribute) && line.trim_end().ends_with("=true"))
    }

    /// Adds a row for what the manifest lacks, and one for what it should not have.
    pub fn check(&self, store: Store, report: &mut Report) {
        compare(elements(&self.tree), store, report);
    }
}

/// Returns the elements that have attributes, each as `name attribute=value ...` with the attributes sorted.
fn elements(tree: &str) -> Vec<String> {
    let mut elements: Vec<Vec<String>> = Vec::new();
    for line in tree.lines().map(str::trim_start) {
        if let Some(element) = line.strip_prefix("E: ") {
            elements.push(vec![element.split(' ').next().unwrap_or_default().to_owned()]);
        } else if let (Some(attribute), Some(element)) = (line.strip_prefix("A: "), elements.last_mut())
            && let Some((name, value)) = attribute.split_once('=')
        {
            // The name is `http://...:name(0x01010003)`, the value `"text" (Raw: "text")`, a number or a resource.
            let name = name.split('(').next().and_then(|name| name.rsplit(':').next()).unwrap_or_default();
            let value = match value.strip_prefix('"') {
                Some(text) => text.split('"').next(),
                None => value.split(' ').next(),
            };
            let value = match value.unwrap_or_default() {
                _ if name.starts_with("version") && name != "version" => "*",
                resource if resource.starts_with('@') => "@",
                value => value,
            };
            if !IGNORED.contains(&name) {
                element.push(format!("{name}={value}"));
            }
        }
    }
    elements.retain(|element| element.len() > 1);
    elements.iter_mut().for_each(|element| element[1..].sort());
    elements.into_iter().map(|element| element.join(" ")).collect()
}

/// Returns the elements that an APK for a store should have, and what would happen without them.
fn wanted(store: Store) -> impl Iterator<Item = (&'static str, &'static str)> {
    let place = if store == Store::Quest { "quest" } else { "common" };
    let lines = WANTED.lines().filter_map(|line| line.split_once(' '));
    let of_place = lines.filter(move |(mark, _)| *mark == "every" || *mark == place);
    of_place.map(|(_, rest)| {
        let (element, consequence) = rest.split_once(" # ").unwrap_or((rest, "it is needed"));
        (element.trim(), consequence)
    })
}

fn compare(mut elements: Vec<String>, store: Store, report: &mut Report) {
    let found = format!("{} elements", elements.len());
    let mut missing = Vec::new();
    for (element, consequence) in wanted(store) {
        match elements.iter().position(|found| found == element) {
            Some(at) => _ = elements.swap_remove(at),
            None => missing.push(format!("no {element}: {consequence}")),
        }
    }
    report.row("manifest", &found, (!missing.is_empty()).then(|| missing.join(", ")));
    if !elements.is_empty() {
        let problem = "not in xtask/helpers/android-check/src/manifest.txt".to_owned();
        report.row("more in it", &elements.join(", "), Some(problem));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elements_are_read_from_what_aapt2_prints() {
        let tree = "N: android=http://schemas.android.com/apk/res/android (line=2)\n  E: manifest (line=2)\n\
            \x20   A: http://schemas.android.com/apk/res/android:versionCode(0x0101021b)=16777472\n\
            \x20   A: package=\"io.github.yoro\" (Raw: \"io.github.yoro\")\n\
            \x20   A: platformBuildVersionCode=29 (Raw: \"29\")\n      E: queries (line=3)\n\
            \x20     E: application (line=4)\n\
            \x20       A: http://schemas.android.com/apk/res/android:theme(0x01010000)=@0x7f050000\n\
            \x20       A: http://schemas.android.com/apk/res/android:debuggable(0x0101000f)=true\n\
            \x20       A: http://schemas.android.com/apk/res/android:extractNativeLibs(0x010104ea)=false\n";
        let expected =
            ["manifest package=io.github.yoro versionCode=*", "application extractNativeLibs=false theme=@"];
        assert_eq!(elements(tree), expected);
        let manifest = Manifest { tree: tree.into(), icon: String::new() };
        assert!(manifest.has(":debuggable(") && !manifest.has(":extractNativeLibs("));
    }

    #[test]
    fn what_is_missing_and_what_is_more_is_seen() {
        let report = |elements: &[String], store| {
            let mut report = Report::default();
            compare(elements.to_vec(), store, &mut report);
            report
        };
        let elements = |store| wanted(store).map(|(element, _)| element.to_owned()).collect::<Vec<_>>();
        let mut other = elements(Store::Play);
        assert!(!report(&other, Store::Play).failed && report(&other, Store::Quest).failed);
        assert!(!report(&elements(Store::Quest), Store::Quest).failed);
        let camera = other.iter_mut().find(|element| element.contains("permission.CAMERA")).unwrap();
        *camera = camera.replace("CAMERA", "RECORD_AUDIO");
        let text = report(&other, Store::None).text;
        assert!(text.contains("it could not scan a viewer's code"), "{text}");
        assert!(text.contains("  uses-permission name=android.permission.RECORD_AUDIO: not in "), "{text}");
    }
}
