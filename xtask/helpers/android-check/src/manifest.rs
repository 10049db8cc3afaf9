//! Compares the manifest in an APK, as `aapt2` reads it, with the one that it should have. cargo-apk ignores keys that it
//! does not know, so only the result shows what Android will see.

use std::path::Path;
use std::process::Command;

use anyhow::{Context as _, bail};
use xtask::ndk::sdk;

use crate::check::{Report, Store, shortened};

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
    /// The package and its version.
    pub title: String,
}

impl Manifest {
    /// Reads an APK's manifest.
    ///
    /// # Errors
    /// Fails if aapt2 is missing, or cannot read the manifest.
    pub fn read(apk: &Path) -> anyhow::Result<Self> {
        let dump = |what: &[&str]| {
            let output = Command::new(sdk::build_tool("aapt2")?).arg("dump").args(what).arg(apk).output();
            let output = output.context("aapt2 cannot be started")?;
            if !output.status.success() {
                let message = String::from_utf8_lossy(&output.stderr).into_owned();
                bail!("the manifest of {} cannot be read: {}", apk.display(), message.trim());
            }
            Ok(String::from_utf8_lossy(&output.stdout).into_owned())
        };
        let badging = dump(&["badging"])?;
        let value = |line: &str, key: &str| {
            let line = badging.lines().find(|text| text.starts_with(line))?;
            Some(line.split_once(&format!(" {key}='"))?.1.split('\'').next()?.to_owned())
        };
        let name = value("package:", "name").unwrap_or_default();
        let version = value("package:", "versionName").unwrap_or_default();
        Ok(Self {
            icon: value("application:", "icon").unwrap_or_default(),
            title: format!("{name} {version}"),
            tree: dump(&["xmltree", "--file", "AndroidManifest.xml"])?,
        })
    }

    fn application_has(&self, attribute: &str) -> bool {
        self.tree.lines().any(|line| {
            let parts = line.split_once('=').map(|(name, value)| (name.contains(attribute), value.trim()));
            parts == Some((true, "true"))
        })
    }

    /// True for a debug build.
    pub fn is_debuggable(&self) -> bool {
        self.application_has(":debuggable(")
    }

    /// True if libraries are unpacked at installation rather than mapped out of the APK.
    pub fn unpacks_libraries(&self) -> bool {
        self.application_has(":extractNativeLibs(")
    }

    /// Adds rows for what the manifest lacks, and for what it should not have.
    pub fn check(&self, store: Store, report: &mut Report) {
        let kind = if self.is_debuggable() { ", debuggable" } else { "" };
        report.row("application", format!("{}{kind}", self.title), None);
        compare(&elements(&self.tree), store, report);
    }
}

/// Returns the elements that have attributes, each as `name attribute=value ...` with the attributes sorted.
fn elements(tree: &str) -> Vec<String> {
    let mut elements: Vec<(&str, Vec<String>)> = Vec::new();
    for line in tree.lines().map(str::trim_start) {
        if let Some(element) = line.strip_prefix("E: ") {
            elements.push((element.split(' ').next().unwrap_or_default(), Vec::new()));
        } else if let (Some(attribute), Some((_, attributes))) =
            (line.strip_prefix("A: "), elements.last_mut())
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
                attributes.push(format!("{name}={value}"));
            }
        }
    }
    let with_attributes = elements.into_iter().filter(|(_, attributes)| !attributes.is_empty());
    let text = |(name, mut attributes): (&str, Vec<String>)| {
        attributes.sort();
        format!("{name} {}", attributes.join(" "))
    };
    with_attributes.map(text).collect()
}

fn compare(elements: &[String], store: Store, report: &mut Report) {
    let place = if store == Store::Quest { "quest" } else { "common" };
    let mut unknown = elements.to_vec();
    let mut missing = Vec::new();
    for line in WANTED.lines() {
        let Some((mark, rest)) = line.split_once(' ') else { continue };
        if mark != "every" && mark != place {
            continue;
        }
        let (element, consequence) = rest.split_once(" # ").unwrap_or((rest, "it is needed"));
        match unknown.iter().position(|found| found == element.trim()) {
            Some(at) => _ = unknown.swap_remove(at),
            None => missing.push(format!("no {}: {consequence}", element.trim())),
        }
    }
    let found = format!("{} elements", elements.len());
    report.row("manifest", found, (!missing.is_empty()).then(|| shortened(&missing)));
    if !unknown.is_empty() {
        let problem = "not in xtask/helpers/android-check/src/manifest.txt".to_owned();
        report.row("more in it", shortened(&unknown), Some(problem));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wanted(place: &str) -> Vec<String> {
        let lines = WANTED.lines().filter_map(|line| line.split_once(' '));
        let of_place = lines.filter(|(mark, _)| *mark == "every" || *mark == place);
        of_place.map(|(_, rest)| rest.split(" # ").next().unwrap().trim().to_owned()).collect()
    }

    fn report(elements: &[String], store: Store) -> Report {
        let mut report = Report::default();
        compare(elements, store, &mut report);
        report
    }

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
        let manifest = Manifest { tree: tree.into(), icon: String::new(), title: String::new() };
        assert!(manifest.is_debuggable() && !manifest.unpacks_libraries());
    }

    #[test]
    fn what_is_missing_and_what_is_more_is_seen() {
        assert!(
            report(&wanted("common"), Store::Play).passed()
                && report(&wanted("quest"), Store::Quest).passed()
        );
        let mut other = wanted("common");
        assert!(!report(&other, Store::Quest).passed());
        let camera = other.iter_mut().find(|element| element.contains("permission.CAMERA")).unwrap();
        *camera = camera.replace("CAMERA", "RECORD_AUDIO");
        let text = report(&other, Store::None).to_string();
        assert!(text.contains("it could not scan a viewer's code"), "{text}");
        assert!(text.contains("more in it  uses-permission name=android.permission.RECORD_AUDIO"), "{text}");
    }
}
