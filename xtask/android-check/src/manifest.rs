//! The manifest in the APK, as aapt reads it: cargo-apk ignores what it does not know, so that only this tells what
//! Android is told.

use std::path::Path;
use std::process::Command;

use anyhow::{Context as _, bail};
use yoro_tools::ndk::sdk;
use yoro_tools::ndk::target::{ARCHITECTURES, MIN_API, NATIVE_LIBRARIES, PROPERTIES, TARGET_API};

use super::archive::Archive;
use super::report::Report;

const PACKAGE: &str = "io.github.yoro";
const ACTIVITY: &str = "android.app.NativeActivity";
const LIBRARY: &str = "yoro_android";
/// What the application asks the user or the system for: OpenXR runtimes may want to be asked.
const PERMISSIONS: [&str; 2] =
    ["org.khronos.openxr.permission.OPENXR", "org.khronos.openxr.permission.OPENXR_SYSTEM"];
/// Whom it means to talk to: without that Android hides them.
const AUTHORITIES: &str = "org.khronos.openxr.runtime_broker;org.khronos.openxr.system_runtime_broker";
const SERVICES: [&str; 2] =
    ["org.khronos.openxr.OpenXRRuntimeService", "org.khronos.openxr.OpenXRApiLayerService"];
/// What makes it an immersive application on headsets, besides the launcher's category.
const IMMERSIVE: [&str; 3] = [
    "com.oculus.intent.category.VR",
    "com.htc.intent.category.VRAPP",
    "org.khronos.openxr.intent.category.IMMERSIVE_HMD",
];
/// Facts about the application that headsets ask for, and the values that they take. `true` may be a boolean or a text.
const META_DATA: [(&str, &[&str]); 3] = [
    ("com.oculus.vr.focusaware", &["true", "0xffffffff"]),
    ("pvr.app.type", &["vr"]),
    ("pvr.sdk.version", &["OpenXR"]),
];
/// Headsets by Meta that it has to be made for by name, and all, for those that do not know the later names.
const DEVICES: [&str; 2] = ["all", "quest3"];
/// Everything that may change while the activity goes on: locale, touchscreen, keyboard, keyboardHidden, navigation,
/// orientation, screenLayout, uiMode, screenSize, smallestScreenSize, density, layoutDirection, colorMode, fontScale.
const CONFIG_CHANGES: u64 = 0x4000_7ffc;

/// An element of the manifest with its attributes; values are texts without quotes or numbers like `0x1d`.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
struct Element {
    name: String,
    attributes: Vec<(String, String)>,
}

impl Element {
    fn text(&self, attribute: &str) -> &str {
        let found = self.attributes.iter().find(|(name, _)| name == attribute);
        found.map_or("", |(_, value)| value.as_str())
    }

    fn number(&self, attribute: &str) -> Option<u64> {
        u64::from_str_radix(self.text(attribute).strip_prefix("0x")?, 16).ok()
    }

    /// Booleans are stored as all ones or zero.
    fn is(&self, attribute: &str) -> Option<bool> {
        self.number(attribute).map(|value| value != 0)
    }
}

/// What Android is told.
#[derive(Debug)]
pub struct Manifest {
    elements: Vec<Element>,
    /// The icon's file, which only a look into the resources tells.
    icon: String,
}

impl Manifest {
    /// Has aapt read it.
    ///
    /// # Errors
    /// When aapt is missing, or cannot read the manifest.
    pub fn read(apk: &Path) -> anyhow::Result<Self> {
        let aapt = sdk::build_tool("aapt")?;
        let dump = |what: &str, file: Option<&str>| {
            let output = Command::new(&aapt).args(["dump", what]).arg(apk).args(file).output();
            let output = output.with_context(|| format!("{} cannot be started", aapt.display()))?;
            if !output.status.success() {
                let told = String::from_utf8_lossy(&output.stderr).into_owned();
                bail!("the manifest of {} cannot be read: {}", apk.display(), told.trim());
            }
            Ok(String::from_utf8_lossy(&output.stdout).into_owned())
        };
        Ok(Self::parse(&dump("xmltree", Some("AndroidManifest.xml"))?, &dump("badging", None)?))
    }

    fn parse(tree: &str, badging: &str) -> Self {
        let mut elements: Vec<Element> = Vec::new();
        for line in tree.lines().map(str::trim_start) {
            if let Some(element) = line.strip_prefix("E: ") {
                let name = element.split(' ').next().unwrap_or_default().to_owned();
                elements.push(Element { name, attributes: Vec::new() });
            } else if let (Some(attribute), Some(element)) = (line.strip_prefix("A: "), elements.last_mut())
                && let Some((name, value)) = attribute.split_once('=')
            {
                let name = name.split('(').next().unwrap_or_default();
                // `"text" (Raw: "text")`, `(type 0x10)0x1d (Raw: "29")`, or a resource: `@0x7f050000`.
                let value = match value.strip_prefix('"') {
                    Some(text) => text.split('"').next(),
                    None => {
                        let typed = value.strip_prefix("(type ").and_then(|rest| rest.split_once(')'));
                        typed.map_or(value, |(_, number)| number).split(' ').next()
                    }
                }
                .unwrap_or_default();
                element.attributes.push((name.to_owned(), value.to_owned()));
            }
        }
        let application = badging.lines().find(|line| line.starts_with("application:")).unwrap_or_default();
        let icon = application.split_once("icon='").and_then(|(_, rest)| rest.split('\'').next());
        Self { elements, icon: icon.unwrap_or_default().to_owned() }
    }

    fn all<'a>(&'a self, name: &'a str) -> impl Iterator<Item = &'a Element> {
        self.elements.iter().filter(move |element| element.name == name)
    }

    /// The first of its name; one without attributes when there is none.
    fn one(&self, name: &str) -> Element {
        self.all(name).next().cloned().unwrap_or_default()
    }

    /// A build for development.
    pub fn is_debuggable(&self) -> bool {
        self.one("application").is("android:debuggable") == Some(true)
    }

    /// Libraries are unpacked at installation, not mapped out of the APK.
    pub fn unpacks_libraries(&self) -> bool {
        self.one("application").is("android:extractNativeLibs") != Some(false)
    }

    /// Adds a row for everything that matters.
    pub fn check(&self, archive: &Archive, report: &mut Report) {
        let manifest = self.one("manifest");
        let package = manifest.text("package");
        let problem = (package != PACKAGE).then(|| format!("should be {PACKAGE}"));
        let kind = if self.is_debuggable() { ", debuggable" } else { "" };
        report.row("package", format!("{package} {}{kind}", manifest.text("android:versionName")), problem);

        let sdk = self.one("uses-sdk");
        let level = |attribute| sdk.number(attribute).map_or("none".to_owned(), |level| level.to_string());
        let levels =
            format!("{}, made for {}", level("android:minSdkVersion"), level("android:targetSdkVersion"));
        report.equal("API level", &levels, &format!("{MIN_API}, made for {TARGET_API}"));

        self.check_features(report);
        let permissions: Vec<&str> =
            self.all("uses-permission").map(|element| element.text("android:name")).collect();
        report.equal("permissions", &permissions.join(" "), &PERMISSIONS.join(" "));
        self.check_activity(archive, report);

        let application = self.one("application");
        let problem = (!archive.has(&self.icon)).then(|| "no such file".to_owned());
        report.row("icon", self.icon.as_str(), problem);
        report.equal("label", application.text("android:label"), "yoro");
        let extracted = self.unpacks_libraries();
        let problem = (!extracted && archive.compresses_libraries())
            .then(|| "compressed libraries must be unpacked (extract_native_libs)".to_owned());
        report.row("libraries", if extracted { "unpacked at installation" } else { "in the APK" }, problem);
    }

    fn check_features(&self, report: &mut Report) {
        let version = self.all("uses-feature").find_map(|element| element.number("android:glEsVersion"));
        let shown = version.map(|v| format!("{}.{}", v >> 16, v & 0xffff)).unwrap_or_default();
        report.equal("OpenGL ES", &shown, "3.0");
        let named = self.all("uses-feature").filter(|element| !element.text("android:name").is_empty());
        let (optional, required): (Vec<_>, Vec<_>) =
            named.partition(|element| element.is("android:required") == Some(false));
        let names = |elements: &[&Element]| {
            let names: Vec<&str> = elements.iter().map(|element| element.text("android:name")).collect();
            names.join(" ")
        };
        let missing = !optional.iter().any(|e| e.text("android:name") == "android.hardware.vr.headtracking");
        let problem = if !required.is_empty() {
            Some(format!("{} shuts devices out: required = false", names(&required)))
        } else {
            missing.then(|| "android.hardware.vr.headtracking should be optional".to_owned())
        };
        report.row("optional", names(&optional), problem);
    }

    fn check_activity(&self, archive: &Archive, report: &mut Report) {
        let activity = self.one("activity");
        report.equal("activity", activity.text("android:name"), ACTIVITY);
        let has = |element, name: &str| self.all(element).any(|e| e.text("android:name") == name);
        let problem = if activity.is("android:exported") != Some(true) {
            Some("not exported: Android does not start it")
        } else if !has("action", "android.intent.action.MAIN")
            || !has("category", "android.intent.category.LAUNCHER")
        {
            Some("no intent filter with MAIN and LAUNCHER: it would not be among the applications")
        } else {
            None
        };
        report.row("launcher", "exported, MAIN, LAUNCHER", problem.map(str::to_owned));

        let value = |name: &str| {
            let data = self.all("meta-data").find(|e| e.text("android:name") == name);
            data.map(|element| element.text("android:value").to_owned()).unwrap_or_default()
        };
        report.row("headsets", "immersive by OpenXR", self.no_headset(&has, &value));

        let landscape = activity.number("android:screenOrientation") == Some(0);
        let themed = !self.one("application").text("android:theme").is_empty();
        let changes = activity.number("android:configChanges").unwrap_or(0);
        let lost = CONFIG_CHANGES & !changes;
        let problem = if !landscape {
            Some("orientation should be landscape".to_owned())
        } else if lost != 0 {
            Some(format!("changes {lost:#x} of configChanges would start it anew"))
        } else if activity.is("android:resizeableActivity") != Some(false) {
            Some("should not be resizeable: in a split screen the lenses' centres are wrong".to_owned())
        } else {
            (!themed).then(|| "the theme is missing: a title bar would be in the picture".to_owned())
        };
        report.row("screen", "landscape, full, goes on when the device changes", problem);

        let name = self.all("meta-data").find(|e| e.text("android:name") == "android.app.lib_name");
        let name = name.map(|element| element.text("android:value")).unwrap_or_default();
        let absent: Vec<String> = ARCHITECTURES
            .iter()
            .map(|architecture| format!("lib/{}/lib{name}.so", architecture.abi))
            .filter(|path| !archive.has(path))
            .collect();
        let problem = if name != LIBRARY {
            Some(format!("should be {LIBRARY}"))
        } else {
            (!absent.is_empty()).then(|| format!("{} is not in the APK", absent.join(", ")))
        };
        report.row("its library", name, problem);
    }
}

impl Manifest {
    /// Why headsets would not start it as an immersive application, or not let it find its runtime.
    fn no_headset(
        &self,
        has: &dyn Fn(&'static str, &str) -> bool,
        value: &dyn Fn(&str) -> String,
    ) -> Option<String> {
        if let Some(category) = IMMERSIVE.iter().find(|category| !has("category", category)) {
            return Some(format!("no category {category}: headsets would show a flat panel"));
        }
        if self.one("provider").text("android:authorities") != AUTHORITIES {
            return Some("no queries for the runtime brokers: headsets would show a flat panel".to_owned());
        }
        if let Some(service) = SERVICES.iter().find(|service| !has("action", service)) {
            return Some(format!("no query for {service}: an installed runtime would not reach its service"));
        }
        let optional = |name: &&&str| {
            let mut libraries = self.all("uses-native-library");
            libraries.any(|e| e.text("android:name") == **name && e.is("android:required") == Some(false))
        };
        if let Some(library) = NATIVE_LIBRARIES.iter().find(|name| !optional(name)) {
            return Some(format!(
                "{library} should be an optional uses-native-library: Android would not load it"
            ));
        }
        let property = |(name, value): &&(&str, &str)| {
            let mut properties = self.all("property");
            properties.any(|e| e.text("android:name") == *name && e.text("android:value") == *value)
        };
        if let Some((name, value)) = PROPERTIES.iter().find(|wanted| !property(wanted)) {
            return Some(format!(
                "the property {name} should be {value}: Android XR would show a flat panel"
            ));
        }
        if let Some((name, fit)) = META_DATA.iter().find(|(name, fit)| !fit.contains(&value(name).as_str())) {
            return Some(format!("the meta-data {name} should be {}", fit[0]));
        }
        let devices = value("com.oculus.supportedDevices");
        let missing = DEVICES.iter().find(|device| !devices.split('|').any(|listed| listed == **device));
        missing.map(|device| format!("com.oculus.supportedDevices should list {device}"))
    }
}

#[cfg(test)]
mod tests {
    use zip::CompressionMethod;

    use super::super::archive::tests::archive;
    use super::*;

    const TREE: &str = include_str!("testdata/xmltree.txt");
    const BADGING: &str = include_str!("testdata/badging.txt");
    const FILES: [&str; 3] = [
        "res/mipmap-anydpi-v26/ic_launcher.xml",
        "lib/arm64-v8a/libyoro_android.so",
        "lib/x86_64/libyoro_android.so",
    ];

    fn report(tree: &str, badging: &str, files: &[&str]) -> Report {
        let archive = Archive::read(&archive(files, CompressionMethod::Deflated, 1)).unwrap();
        let mut report = Report::default();
        Manifest::parse(tree, badging).check(&archive, &mut report);
        report
    }

    #[track_caller]
    fn changed_fails(from: &str, to: &str, what: &str) {
        assert!(TREE.contains(from), "{from}");
        let report = report(&TREE.replacen(from, to, 1), BADGING, &FILES);
        assert_eq!(report.problems(), [what], "{report}");
    }

    #[test]
    fn the_manifest_passes() {
        let report = report(TREE, BADGING, &FILES);
        assert!(report.passed(), "{report}");
        assert!(report.to_string().contains("io.github.yoro 0.1.0\n"), "{report}");
    }

    #[test]
    fn every_change_is_seen() {
        changed_fails("package=\"io.github.yoro\"", "package=\"rust.yoro\"", "package");
        changed_fails(
            "minSdkVersion(0x0101020c)=(type 0x10)0x1d",
            "minSdkVersion(0x0101020c)=(type 0x10)0x17",
            "API level",
        );
        changed_fails("targetSdkVersion(0x01010270)=(type 0x10)0x22", "x=(type 0x10)0x22", "API level");
        changed_fails("(type 0x11)0x30000", "(type 0x11)0x30001", "OpenGL ES");
        changed_fails(
            "E: application ",
            "E: uses-permission (line=1)\n A: android:name(0x01010003)=\"android.permission.CAMERA\"\n E: application ",
            "permissions",
        );
        changed_fails("A: android:required(0x0101028e)=(type 0x12)0x0", "", "optional");
        changed_fails("\"android.hardware.vr.headtracking\"", "\"android.hardware.other\"", "optional");
        changed_fails("\"android.app.NativeActivity\"", "\"android.app.Activity\"", "activity");
        changed_fails(
            "exported(0x01010010)=(type 0x12)0xffffffff",
            "exported(0x01010010)=(type 0x12)0x0",
            "launcher",
        );
        changed_fails("android.intent.category.LAUNCHER", "android.intent.category.HOME", "launcher");
        changed_fails("com.oculus.intent.category.VR", "com.oculus.intent.category.2D", "headsets");
        changed_fails("IMMERSIVE_HMD", "PANEL", "headsets");
        changed_fails("org.khronos.openxr.runtime_broker;", "", "headsets");
        changed_fails("com.htc.intent.category.VRAPP", "com.htc.intent.category.2D", "headsets");
        changed_fails("org.khronos.openxr.OpenXRRuntimeService", "org.khronos.openxr.Other", "headsets");
        changed_fails("com.oculus.vr.focusaware", "com.oculus.vr.other", "headsets");
        changed_fails("\"pvr.app.type\"", "\"pvr.app.kind\"", "headsets");
        changed_fails("\"OpenXR\" (Raw", "\"PXR\" (Raw", "headsets");
        changed_fails("quest3|", "", "headsets");
        changed_fails("\"all|", "\"", "headsets");
        changed_fails("libopenxr.google.so", "libopenxr.other.so", "headsets");
        changed_fails("libopenxr_forwardloader.oculus.so", "libother.so", "headsets");
        changed_fails("FULL_SPACE_UNMANAGED", "HOME_SPACE", "headsets");
        changed_fails(
            "screenOrientation(0x0101001e)=(type 0x10)0x0",
            "screenOrientation(0x0101001e)=(type 0x10)0x1",
            "screen",
        );
        changed_fails("(type 0x11)0x40007ffc", "(type 0x11)0x4a0", "screen");
        changed_fails(
            "resizeableActivity(0x010104f6)=(type 0x12)0x0",
            "resizeableActivity(0x010104f6)=(type 0x12)0xffffffff",
            "screen",
        );
        changed_fails("android:theme", "android:other", "screen");
        changed_fails("\"yoro_android\"", "\"yoro\"", "its library");
        changed_fails("android:label(0x01010001)=\"yoro\"", "android:label(0x01010001)=\"\"", "label");
        changed_fails(
            "extractNativeLibs(0x010104ea)=(type 0x12)0xffffffff",
            "extractNativeLibs(0x010104ea)=(type 0x12)0x0",
            "libraries",
        );
    }

    #[test]
    fn what_it_names_is_in_the_archive() {
        assert_eq!(report(TREE, BADGING, &FILES[1..]).problems(), ["icon"]);
        assert_eq!(report(TREE, BADGING, &FILES[..2]).problems(), ["its library"]);
        assert_eq!(report(TREE, "", &FILES).problems(), ["icon"]);
    }

    #[test]
    fn nothing_at_all_fails_without_a_panic() {
        let report = report("", "", &FILES);
        assert!(!report.passed());
    }
}
