//! Checks the manifest in the APK as aapt reads it. cargo-apk ignores keys that it does not know, so only the result
//! shows what Android will see.

use std::path::Path;
use std::process::Command;

use anyhow::{Context as _, bail};
use xtask::ndk::sdk;
use xtask::ndk::target::{MIN_API, NATIVE_LIBRARIES, PROPERTIES};

use super::archive::Archive;
use super::report::Report;
use super::store::Store;

const PACKAGE: &str = "io.github.yoro";
const LIBRARY: &str = "yoro_android";
/// Permissions that the application requests. It uses the camera to scan a viewer's code, and OpenXR runtimes may
/// require permissions of their own.
const PERMISSIONS: [&str; 3] = [
    "android.permission.CAMERA",
    "org.khronos.openxr.permission.OPENXR",
    "org.khronos.openxr.permission.OPENXR_SYSTEM",
];
/// Meta headsets that the manifest must name, and `all` for headsets that do not know the later names.
const DEVICES: [&str; 2] = ["all", "quest3"];
/// The list in the APK for Meta's store.
const QUEST_DEVICES: &str = "quest2|questpro|quest3|quest3s";
/// The categories of the action MAIN in the APK for Meta's store: the two that it demands, and Khronos's.
const QUEST_CATEGORIES: &str = "android.intent.category.LAUNCHER com.oculus.intent.category.VR \
                                org.khronos.openxr.intent.category.IMMERSIVE_HMD";
/// Changes that must not restart the activity: locale, touchscreen, keyboard, keyboardHidden, navigation, orientation,
/// screenLayout, uiMode, screenSize, smallestScreenSize, density, layoutDirection, colorMode, fontScale.
const CONFIG_CHANGES: u64 = 0x4000_7ffc;

const DEVICE_LIST: &str = "com.oculus.supportedDevices";
const NAME: &str = "android:name";
const VALUE: &str = "android:value";
const MIME_TYPE: &str = "android:mimeType";
const REQUIRED: &str = "android:required";
/// Any value, as long as there is one.
const ANY: &str = "*";

/// An element that the manifest must have, with these attributes.
struct Rule<'a> {
    element: &'a str,
    attributes: &'a [(&'a str, &'a str)],
    /// The consequence if it is missing.
    consequence: &'a str,
}

const fn rule<'a>(element: &'a str, attributes: &'a [(&'a str, &'a str)], consequence: &'a str) -> Rule<'a> {
    Rule { element, attributes, consequence }
}

const NO_LAUNCHER: &str = "it would not be among the applications";
const FLAT: &str = "headsets would show a flat panel";
const NO_SERVICE: &str = "an installed runtime would not reach its service";

const LAUNCHER: [Rule<'_>; 3] = [
    rule("activity", &[("android:exported", "true")], "Android would not start it"),
    rule("action", &[(NAME, "android.intent.action.MAIN")], NO_LAUNCHER),
    rule("category", &[(NAME, "android.intent.category.LAUNCHER")], NO_LAUNCHER),
];
/// Rules for an immersive application that finds its OpenXR runtime.
const HEADSETS: [Rule<'_>; 6] = [
    rule("category", &[(NAME, "com.oculus.intent.category.VR")], FLAT),
    rule("category", &[(NAME, "org.khronos.openxr.intent.category.IMMERSIVE_HMD")], FLAT),
    // Android hides the runtime brokers from applications that do not declare that they use them.
    rule(
        "provider",
        &[(
            "android:authorities",
            "org.khronos.openxr.runtime_broker;org.khronos.openxr.system_runtime_broker",
        )],
        FLAT,
    ),
    rule("action", &[(NAME, "org.khronos.openxr.OpenXRRuntimeService")], NO_SERVICE),
    rule("action", &[(NAME, "org.khronos.openxr.OpenXRApiLayerService")], NO_SERVICE),
    rule("meta-data", &[(NAME, "com.oculus.vr.focusaware"), (VALUE, "true")], FLAT),
];
/// Rules of other makers' headsets, which the APK for Meta's store does not follow.
const OTHER_HEADSETS: [Rule<'_>; 3] = [
    rule("category", &[(NAME, "com.htc.intent.category.VRAPP")], FLAT),
    rule("meta-data", &[(NAME, "pvr.app.type"), (VALUE, "vr")], FLAT),
    rule("meta-data", &[(NAME, "pvr.sdk.version"), (VALUE, "OpenXR")], FLAT),
];
const NO_LOOP: &str = "device farms would not start its game loops";
const GAME_LOOPS: [Rule<'_>; 5] = [
    rule("action", &[(NAME, "com.google.intent.action.TEST_LOOP")], NO_LOOP),
    rule("category", &[(NAME, "android.intent.category.DEFAULT")], NO_LOOP),
    rule("data", &[(MIME_TYPE, "application/javascript")], NO_LOOP),
    rule("meta-data", &[(NAME, "com.google.test.loops.compatibility"), (VALUE, ANY)], NO_LOOP),
    rule("meta-data", &[(NAME, "com.google.test.loops.performance"), (VALUE, ANY)], NO_LOOP),
];
const NO_SHARING: &str = "other applications could not share a viewer's code or a model";
const SHARING: [Rule<'_>; 7] = [
    rule("action", &[(NAME, "android.intent.action.SEND")], NO_SHARING),
    rule("action", &[(NAME, "android.intent.action.VIEW")], NO_SHARING),
    rule("category", &[(NAME, "android.intent.category.BROWSABLE")], NO_SHARING),
    rule("data", &[(MIME_TYPE, "text/plain")], NO_SHARING),
    rule("data", &[(MIME_TYPE, "image/*")], NO_SHARING),
    rule("data", &[(MIME_TYPE, "model/gltf-binary")], NO_SHARING),
    rule(
        "data",
        &[
            ("android:scheme", "https"),
            ("android:host", "google.com"),
            ("android:pathPrefix", "/cardboard/cfg"),
        ],
        NO_SHARING,
    ),
];
const SCREEN: [Rule<'_>; 4] = [
    rule("application", &[("android:appCategory", "0x0")], "on a tablet the picture would be upright"),
    rule("activity", &[("android:screenOrientation", "0x0")], "the picture would be upright"),
    rule(
        "activity",
        &[("android:resizeableActivity", "false")],
        "in a split screen the lenses' centres would be wrong",
    ),
    rule("application", &[("android:theme", ANY)], "a title bar would be in the picture"),
];
const QUEST: [Rule<'_>; 3] = [
    rule(
        "uses-feature",
        &[(NAME, "android.hardware.vr.headtracking"), (REQUIRED, "true"), ("android:version", "0x1")],
        "the store refuses it",
    ),
    rule("manifest", &[("android:installLocation", "0x0")], "the store refuses it"),
    rule("manifest", &[("android:versionCode", ANY)], "the store refuses it"),
];
const OPTIONAL: [Rule<'_>; 3] = [
    optional(&[(NAME, "android.hardware.vr.headtracking"), (REQUIRED, "false")]),
    // The camera permission implies that these two are required, unless the manifest says otherwise.
    optional(&[(NAME, "android.hardware.camera"), (REQUIRED, "false")]),
    optional(&[(NAME, "android.hardware.camera.autofocus"), (REQUIRED, "false")]),
];

const fn optional<'a>(attributes: &'a [(&'a str, &'a str)]) -> Rule<'a> {
    rule("uses-feature", attributes, "devices without it would be shut out")
}

/// An element of the manifest with its attributes. Values are texts without quotes, `true`, `false`, or numbers like
/// `0x1d`.
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
}

/// The manifest of an APK.
#[derive(Debug)]
pub struct Manifest {
    elements: Vec<Element>,
    /// The icon's file name, which is only found in the resources.
    icon: String,
}

impl Manifest {
    /// Reads an APK's manifest with aapt.
    ///
    /// # Errors
    /// Fails if aapt is missing, or cannot read the manifest.
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
                element.attributes.push((name.to_owned(), self::value(value).to_owned()));
            }
        }
        let application = badging.lines().find(|line| line.starts_with("application:")).unwrap_or_default();
        let icon = application.split_once("icon='").and_then(|(_, rest)| rest.split('\'').next());
        Self { elements, icon: icon.unwrap_or_default().to_owned() }
    }

    fn all<'a>(&'a self, name: &'a str) -> impl Iterator<Item = &'a Element> {
        self.elements.iter().filter(move |element| element.name == name)
    }

    /// Returns the first element with this name, or one without attributes if there is none.
    fn one(&self, name: &str) -> Element {
        self.all(name).next().cloned().unwrap_or_default()
    }

    /// Returns the value of the first meta-data element with this name.
    fn meta_data(&self, name: &str) -> &str {
        self.elements
            .iter()
            .find(|element| element.name == "meta-data" && element.text(NAME) == name)
            .map_or("", |element| element.text(VALUE))
    }

    /// Returns the names of elements in their order, separated by spaces.
    fn names(&self, element: &str, is: impl Fn(&Element) -> bool) -> String {
        let names: Vec<&str> = self.all(element).filter(|e| is(e)).map(|e| e.text(NAME)).collect();
        names.join(" ")
    }

    /// Returns a description of the first broken rule.
    fn broken<'a>(&self, rules: impl IntoIterator<Item = &'a Rule<'a>>) -> Option<String> {
        let keeps = |rule: &&Rule<'_>| {
            self.all(rule.element).any(|element| {
                rule.attributes.iter().all(|(attribute, wanted)| {
                    let found = element.text(attribute);
                    found == *wanted || *wanted == ANY && !found.is_empty()
                })
            })
        };
        rules.into_iter().find(|rule| !keeps(rule)).map(|Rule { element, attributes, consequence }| {
            let wanted: Vec<String> =
                attributes.iter().map(|(name, value)| format!("{name}={value}")).collect();
            format!("no {element} with {}: {consequence}", wanted.join(" "))
        })
    }

    /// True for a debug build.
    pub fn is_debuggable(&self) -> bool {
        self.one("application").text("android:debuggable") == "true"
    }

    /// True if libraries are unpacked at installation rather than mapped out of the APK.
    pub fn unpacks_libraries(&self) -> bool {
        self.one("application").text("android:extractNativeLibs") != "false"
    }

    /// Adds all rows for the manifest.
    pub fn check(&self, archive: &Archive, store: Store, report: &mut Report) {
        let manifest = self.one("manifest");
        let package = manifest.text("package");
        let problem = (package != PACKAGE).then(|| format!("should be {PACKAGE}"));
        let kind = if self.is_debuggable() { ", debuggable" } else { "" };
        report.row("package", format!("{package} {}{kind}", manifest.text("android:versionName")), problem);

        let sdk = self.one("uses-sdk");
        let level = |attribute| sdk.number(attribute).map_or("none".to_owned(), |level| level.to_string());
        let levels =
            format!("{}, made for {}", level("android:minSdkVersion"), level("android:targetSdkVersion"));
        report.equal("API level", &levels, &format!("{MIN_API}, made for {}", store.target_api()));

        let version = self.all("uses-feature").find_map(|element| element.number("android:glEsVersion"));
        let version = version.map(|v| format!("{}.{}", v >> 16, v & 0xffff)).unwrap_or_default();
        report.equal("OpenGL ES", &version, "3.0");
        let is_optional = |feature: &Element| feature.text(REQUIRED) == "false";
        let required =
            self.names("uses-feature", |feature| !feature.text(NAME).is_empty() && !is_optional(feature));
        let permissions = self.names("uses-permission", |_| true);
        if store == Store::Quest {
            report.row("required", required, self.broken(&QUEST));
            report.equal("permissions", &permissions, &PERMISSIONS[1..].join(" "));
        } else {
            let problem =
                (!required.is_empty()).then(|| format!("{required} shuts devices out: required = false"));
            let optional = self.names("uses-feature", is_optional);
            report.row("optional", optional, problem.or_else(|| self.broken(&OPTIONAL)));
            report.equal("permissions", &permissions, &PERMISSIONS.join(" "));
        }

        report.equal("activity", self.one("activity").text(NAME), "android.app.NativeActivity");
        report.row("launcher", "exported, MAIN, LAUNCHER", self.broken(&LAUNCHER));
        if store == Store::Quest {
            report.row("headset", "immersive by OpenXR", self.no_quest());
            report.equal("categories", &self.names("category", |_| true), QUEST_CATEGORIES);
            report.equal("devices", self.meta_data(DEVICE_LIST), QUEST_DEVICES);
        } else {
            report.row("headsets", "immersive by OpenXR", self.no_headset());
            report.row("game loops", "TEST_LOOP, labels", self.broken(&GAME_LOOPS));
            report.row("sharing", "viewers and models, by SEND and VIEW", self.broken(&SHARING));
        }
        let changes = self.one("activity").number("android:configChanges").unwrap_or(0);
        let lost = CONFIG_CHANGES & !changes;
        let problem = (lost != 0).then(|| format!("changes {lost:#x} of configChanges would start it anew"));
        report.row(
            "screen",
            "landscape, full, goes on when the device changes",
            self.broken(&SCREEN).or(problem),
        );
        self.check_files(archive, store, report);
    }

    /// Returns why a Quest would not start the application as immersive, or would not let it find its runtime.
    fn no_quest(&self) -> Option<String> {
        let attributes = [(NAME, NATIVE_LIBRARIES[1]), (REQUIRED, "false")];
        let library = rule("uses-native-library", &attributes, "Android would not load it");
        self.broken(HEADSETS.iter().chain([&library]))
    }

    /// Returns why headsets would not start the application as immersive, or would not let it find its runtime.
    fn no_headset(&self) -> Option<String> {
        let libraries = NATIVE_LIBRARIES.map(|name| [(NAME, name), (REQUIRED, "false")]);
        let libraries = libraries
            .iter()
            .map(|attributes| rule("uses-native-library", attributes, "Android would not load it"));
        let properties = PROPERTIES.map(|(name, value)| [(NAME, name), (VALUE, value)]);
        let properties = properties
            .iter()
            .map(|attributes| rule("property", attributes, "Android XR would show a flat panel"));
        let rules: Vec<Rule<'_>> = libraries.chain(properties).collect();
        let devices = self.meta_data(DEVICE_LIST);
        let missing = DEVICES.iter().find(|device| !devices.split('|').any(|listed| listed == **device));
        let problem = missing.map(|device| format!("{DEVICE_LIST} should list {device}"));
        self.broken(HEADSETS.iter().chain(&OTHER_HEADSETS).chain(&rules)).or(problem)
    }

    /// Adds rows for the files that the manifest refers to.
    fn check_files(&self, archive: &Archive, store: Store, report: &mut Report) {
        let problem = (!archive.has(&self.icon)).then(|| "no such file".to_owned());
        report.row("icon", self.icon.as_str(), problem);
        report.equal("label", self.one("application").text("android:label"), "yoro");
        let unpacked = self.unpacks_libraries();
        let problem = (!unpacked && archive.compresses_libraries())
            .then(|| "compressed libraries must be unpacked (extract_native_libs)".to_owned());
        report.row("libraries", if unpacked { "unpacked at installation" } else { "in the APK" }, problem);
        let name = self.meta_data("android.app.lib_name");
        let paths = store.abis().into_iter().map(|abi| format!("lib/{abi}/lib{name}.so"));
        let absent: Vec<String> = paths.filter(|path| !archive.has(path)).collect();
        let problem = if name != LIBRARY {
            Some(format!("should be {LIBRARY}"))
        } else {
            (!absent.is_empty()).then(|| format!("{} is not in the APK", absent.join(", ")))
        };
        report.row("its library", name, problem);
    }
}

/// Extracts the value of `"text" (Raw: "text")`, `(type 0x10)0x1d (Raw: "29")`, a boolean `(type 0x12)0x0`, or a
/// resource `@0x7f050000`.
fn value(dumped: &str) -> &str {
    if let Some(text) = dumped.strip_prefix('"') {
        return text.split('"').next().unwrap_or_default();
    }
    let typed = dumped.strip_prefix("(type ").and_then(|rest| rest.split_once(')'));
    let (kind, value) = typed.unwrap_or(("", dumped));
    let value = value.split(' ').next().unwrap_or_default();
    match (kind, value) {
        ("0x12", "0x0") => "false",
        ("0x12", _) => "true",
        _ => value,
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
        report_for(Store::None, tree, badging, files)
    }

    fn report_for(store: Store, tree: &str, badging: &str, files: &[&str]) -> Report {
        let archive = Archive::read(&archive(files, CompressionMethod::Deflated, 1)).unwrap();
        let mut report = Report::default();
        Manifest::parse(tree, badging).check(&archive, store, &mut report);
        report
    }

    #[test]
    fn the_manifest_passes() {
        let report = report(TREE, BADGING, &FILES);
        assert!(report.passed(), "{report}");
        assert!(report.to_string().contains("io.github.yoro 0.1.0\n"), "{report}");
    }

    #[test]
    fn every_change_is_seen() {
        let changes = [
            ("package=\"io.github.yoro\"", "package=\"rust.yoro\"", "package"),
            (
                "minSdkVersion(0x0101020c)=(type 0x10)0x1d",
                "minSdkVersion(0x0101020c)=(type 0x10)0x17",
                "API level",
            ),
            ("targetSdkVersion(0x01010270)=(type 0x10)0x24", "x=(type 0x10)0x24", "API level"),
            ("(type 0x11)0x30000", "(type 0x11)0x30001", "OpenGL ES"),
            (
                "E: application ",
                "E: uses-permission (line=1)\n A: android:name(0x01010003)=\"android.permission.RECORD_AUDIO\"\n E: application ",
                "permissions",
            ),
            ("A: android:required(0x0101028e)=(type 0x12)0x0", "", "optional"),
            ("\"android.hardware.vr.headtracking\"", "\"android.hardware.other\"", "optional"),
            ("\"android.hardware.camera\"", "\"android.hardware.other\"", "optional"),
            ("\"android.app.NativeActivity\"", "\"android.app.Activity\"", "activity"),
            ("exported(0x01010010)=(type 0x12)0xffffffff", "exported(0x01010010)=(type 0x12)0x0", "launcher"),
            ("android.intent.category.LAUNCHER", "android.intent.category.HOME", "launcher"),
            ("com.oculus.intent.category.VR", "com.oculus.intent.category.2D", "headsets"),
            ("IMMERSIVE_HMD", "PANEL", "headsets"),
            ("org.khronos.openxr.runtime_broker;", "", "headsets"),
            ("com.htc.intent.category.VRAPP", "com.htc.intent.category.2D", "headsets"),
            ("org.khronos.openxr.OpenXRRuntimeService", "org.khronos.openxr.Other", "headsets"),
            ("com.oculus.vr.focusaware", "com.oculus.vr.other", "headsets"),
            ("\"pvr.app.type\"", "\"pvr.app.kind\"", "headsets"),
            ("\"OpenXR\" (Raw", "\"PXR\" (Raw", "headsets"),
            ("quest3|", "", "headsets"),
            ("com.google.intent.action.TEST_LOOP", "com.google.intent.action.OTHER", "game loops"),
            ("application/javascript", "text/plain", "game loops"),
            ("com.google.test.loops.performance", "com.google.test.loops.other", "game loops"),
            ("android.intent.action.SEND", "android.intent.action.OTHER", "sharing"),
            ("android.intent.category.BROWSABLE", "android.intent.category.OTHER", "sharing"),
            ("\"text/plain\"", "\"text/html\"", "sharing"),
            ("\"image/*\"", "\"video/*\"", "sharing"),
            ("/cardboard/cfg", "/other", "sharing"),
            ("appCategory(0x01010545)=(type 0x10)0x0", "appCategory(0x01010545)=(type 0x10)0x1", "screen"),
            ("\"all|", "\"", "headsets"),
            ("libopenxr.google.so", "libopenxr.other.so", "headsets"),
            ("libopenxr_forwardloader.oculus.so", "libother.so", "headsets"),
            ("FULL_SPACE_UNMANAGED", "HOME_SPACE", "headsets"),
            (
                "screenOrientation(0x0101001e)=(type 0x10)0x0",
                "screenOrientation(0x0101001e)=(type 0x10)0x1",
                "screen",
            ),
            ("(type 0x11)0x40007ffc", "(type 0x11)0x4a0", "screen"),
            (
                "resizeableActivity(0x010104f6)=(type 0x12)0x0",
                "resizeableActivity(0x010104f6)=(type 0x12)0xffffffff",
                "screen",
            ),
            ("android:theme", "android:other", "screen"),
            ("\"yoro_android\"", "\"yoro\"", "its library"),
            ("android:label(0x01010001)=\"yoro\"", "android:label(0x01010001)=\"\"", "label"),
            (
                "extractNativeLibs(0x010104ea)=(type 0x12)0xffffffff",
                "extractNativeLibs(0x010104ea)=(type 0x12)0x0",
                "libraries",
            ),
        ];
        for (from, to, what) in changes {
            assert!(TREE.contains(from), "{from}");
            let report = report(&TREE.replacen(from, to, 1), BADGING, &FILES);
            assert_eq!(report.problems(), [what], "{from}: {report}");
        }
    }

    #[test]
    fn what_it_names_is_in_the_archive() {
        assert_eq!(report(TREE, BADGING, &FILES[1..]).problems(), ["icon"]);
        assert_eq!(report(TREE, BADGING, &FILES[..2]).problems(), ["its library"]);
        assert_eq!(report(TREE, "", &FILES).problems(), ["icon"]);
    }

    /// `cargo xtask apk --quest` checks the APK that it takes.
    #[test]
    fn metas_store_refuses_the_common_apk_by_each_of_its_rules() {
        let report = report_for(Store::Quest, TREE, BADGING, &FILES[..2]);
        let rules = ["API level", "required", "permissions", "categories", "devices"];
        assert_eq!(report.problems(), rules, "{report}");
        assert!(report_for(Store::Play, TREE, BADGING, &FILES).passed());
    }

    #[test]
    fn nothing_at_all_fails_without_a_panic() {
        let report = report("", "", &FILES);
        assert!(!report.passed());
    }
}
