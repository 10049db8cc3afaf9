use std::cell::RefCell;
use std::collections::HashMap;
use std::ffi::{OsString, c_void};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

use serde_json::json;

use super::*;

/// Compiles `fixture.rs`, once per process, since a library that was found is never unloaded.
fn fixture() -> &'static Path {
    static LIBRARY: OnceLock<PathBuf> = OnceLock::new();
    LIBRARY.get_or_init(|| {
        let folder = std::env::current_exe().unwrap().with_file_name("openxr-runtime-fixture");
        fs::create_dir_all(&folder).unwrap();
        let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/openxr/runtime/fixture.rs");
        let library = folder.join("libfixture.so");
        // Another process may be using the existing library.
        let new = folder.join(format!("libfixture.{}.so", std::process::id()));
        let rustc = Command::new("rustc")
            .args(["--edition", "2021", "--crate-type", "cdylib", "-Cpanic=abort", "-o"])
            .args([&new, &source])
            .output()
            .expect("tests are compiled by rustc");
        assert!(rustc.status.success(), "{}", String::from_utf8_lossy(&rustc.stderr));
        fs::rename(new, &library).unwrap();
        library
    })
}

/// A folder with one manifest.
struct Written {
    folder: tempfile::TempDir,
}

impl Written {
    fn new(text: impl ToString) -> Written {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("runtime.json"), text.to_string()).unwrap();
        Written { folder }
    }

    /// Writes a manifest of the fixture, with functions renamed.
    fn fixture(functions: &[(&str, &str)]) -> Written {
        let functions: HashMap<_, _> = functions.iter().copied().collect();
        Written::new(json!({
            "file_format_version": "1.0.0",
            "runtime": { "library_path": fixture(), "functions": functions, "name": "fixture" },
        }))
    }

    fn path(&self) -> PathBuf {
        self.folder.path().join("runtime.json")
    }

    fn find(&self, java: Option<&JavaContext>) -> Result<Runtime, NotFound> {
        find(&[RuntimeSource::Manifest(self.path())], &NoBroker, java)
    }

    /// Returns the failure's sentence without this folder's path.
    fn failure(&self) -> String {
        let error = self.find(None).unwrap_err();
        assert!(!error.nothing_installed(), "{error}");
        let fixture = fixture().display().to_string();
        let folder = format!("{}/", self.folder.path().display());
        error.to_string().replace(&fixture, "libfixture.so").replace(&folder, "")
    }
}

const PREFIX: &str = "no OpenXR runtime was found: ";

#[test]
fn a_manifest_leads_to_an_entry() {
    let manifest = Written::fixture(&[]);
    let runtime = manifest.find(None).unwrap();
    assert_eq!(runtime.found().api_version, Some((1, 1, 54)));
    assert_eq!(
        runtime.found().to_string(),
        format!("OpenXR 1.1.54 runtime {} by {}", fixture().display(), manifest.path().display())
    );
    let entry = runtime.entry().unwrap();
    assert_eq!(entry.enumerate_extensions().unwrap(), openxr::ExtensionSet::default());
}

#[test]
fn a_library_is_relative_to_the_real_manifest() {
    let text = json!({ "file_format_version": "1.0.0", "runtime": { "library_path": "./lib/r.so" } });
    let manifest = Written::new(text);
    fs::create_dir(manifest.folder.path().join("lib")).unwrap();
    fs::copy(fixture(), manifest.folder.path().join("lib/r.so")).unwrap();
    let elsewhere = tempfile::tempdir().unwrap();
    let link = elsewhere.path().join("active_runtime.json");
    std::os::unix::fs::symlink(manifest.path(), &link).unwrap();
    let runtime = find(&[RuntimeSource::Manifest(link)], &NoBroker, None).unwrap();
    assert!(runtime.found().library.ends_with("lib/r.so"));
}

#[test]
fn a_plain_name_is_left_to_the_dynamic_linker() {
    let text = json!({ "file_format_version": "1.0.0", "runtime": { "library_path": "libm.so.6" } });
    let found = Written::new(text).failure();
    assert_eq!(
        found,
        format!(
            "{PREFIX}libm.so.6 has no function xrNegotiateLoaderRuntimeInterface: it is not an OpenXR runtime"
        )
    );
}

#[test]
fn damaged_manifests_are_named() {
    let cases = [
        ("{", "is not the manifest of an OpenXR runtime (EOF while parsing"),
        ("[]", "is not the manifest of an OpenXR runtime (invalid length 0"),
        (r#"{ "file_format_version": "1.0.0" }"#, "(missing field `runtime`"),
        (r#"{ "file_format_version": "1.0.0", "runtime": {} }"#, "(missing field `library_path`"),
        (
            r#"{ "file_format_version": "2.0.0", "runtime": { "library_path": "x" } }"#,
            "is of format 2.0.0; only 1.0.0 is known",
        ),
        (
            r#"{ "file_format_version": "1.0.0", "runtime": { "library_path": 7 } }"#,
            "invalid type: integer `7`",
        ),
    ];
    for (text, expected) in cases {
        let failure = Written::new(text).failure();
        assert!(failure.contains("runtime.json") && failure.contains(expected), "{text}: {failure}");
    }
    let folder = tempfile::tempdir().unwrap();
    let error = find(&[RuntimeSource::Manifest(folder.path().into())], &NoBroker, None).unwrap_err();
    assert!(error.to_string().contains("cannot be read"), "{error}");
}

#[test]
fn a_missing_or_damaged_library_is_named() {
    let text = |path: &str| json!({ "file_format_version": "1.0.0", "runtime": { "library_path": path } });
    let failure = Written::new(text("./absent.so")).failure();
    assert!(
        failure.starts_with(&format!("{PREFIX}./absent.so cannot be loaded ("))
            || failure.contains("absent.so")
    );
    assert_eq!(failure.matches("absent.so").count(), 1, "{failure}");
    let manifest = Written::new(text("./runtime.json"));
    assert!(manifest.failure().contains("runtime.json cannot be loaded"), "JSON is no library");
}

#[test]
fn failed_negotiations_name_the_reason() {
    let negotiation = |symbol| Written::fixture(&[("xrNegotiateLoaderRuntimeInterface", symbol)]).failure();
    let cases = [
        ("negotiate_refuse", "libfixture.so refuses loader interface 1 with OpenXR 1"),
        (
            "negotiate_other_interface",
            "libfixture.so negotiates loader interface 2 and OpenXR 1.1; needed are interface 1 and OpenXR 1",
        ),
        (
            "negotiate_openxr_2",
            "libfixture.so negotiates loader interface 1 and OpenXR 2.0; needed are interface 1 and OpenXR 1",
        ),
        ("negotiate_nothing", "libfixture.so negotiates well and gives no xrGetInstanceProcAddr"),
        ("absent_symbol", "libfixture.so has no function absent_symbol: it is not an OpenXR runtime"),
    ];
    for (symbol, expected) in cases {
        let failure = negotiation(symbol);
        assert!(failure.starts_with(&format!("{PREFIX}{expected}")), "{symbol}: {failure}");
    }
}

/// Numbers instead of a virtual machine and an activity; the fixture checks that they arrive.
fn java(vm: &mut u32, activity: &mut u32) -> JavaContext {
    // SAFETY: the fixture only reads a number through each pointer, and both outlive the search.
    unsafe { JavaContext::new((vm as *mut u32).cast::<c_void>(), (activity as *mut u32).cast::<c_void>()) }
}

#[test]
fn java_is_passed_before_or_after_the_negotiation() {
    let (mut vm, mut activity, mut wrong) = (17, 4, 0);
    let right = java(&mut vm, &mut activity);
    let wrong = java(&mut wrong, &mut activity);
    let exported = Written::fixture(&[("xrInitializeLoaderKHR", "initialize")]);
    let asked_for = Written::fixture(&[]);
    for manifest in [&exported, &asked_for] {
        assert!(manifest.find(Some(&right)).is_ok());
        let error = manifest.find(Some(&wrong)).unwrap_err().to_string();
        assert!(error.contains("refuses to be initialised with xrInitializeLoaderKHR"), "{error}");
    }
    let refusing = Written::fixture(&[("xrInitializeLoaderKHR", "initialize_refuse")]);
    assert!(refusing.find(Some(&right)).is_err());
    assert!(refusing.find(None).is_ok(), "without Java there is nothing to introduce");
}

#[test]
fn a_loader_is_preferred_and_optional() {
    let manifest = Written::fixture(&[]);
    let places =
        |loader: &Path| [RuntimeSource::Loader(loader.into()), RuntimeSource::Manifest(manifest.path())];
    let runtime = find(&places(fixture()), &NoBroker, None).unwrap();
    assert_eq!(runtime.found().to_string(), format!("OpenXR by the loader {}", fixture().display()));
    assert!(runtime.entry().unwrap().enumerate_extensions().is_ok());
    let without = find(&places(Path::new("libopenxr_loader_absent.so")), &NoBroker, None).unwrap();
    assert_eq!(without.found().place, RuntimeSource::Manifest(manifest.path()));
    let error = find(&places(Path::new("libm.so.6"))[..1], &NoBroker, None).unwrap_err().to_string();
    assert_eq!(
        error,
        format!("{PREFIX}libm.so.6 has no function xrGetInstanceProcAddr: it is not an OpenXR loader")
    );
}

/// A broker with scripted tables, which records its queries.
#[derive(Default)]
struct Scripted {
    tables: HashMap<String, Result<Option<Rows>, String>>,
    asked: RefCell<Vec<String>>,
}

impl Broker for Scripted {
    fn query(&self, uri: &str, columns: &[&str]) -> Result<Option<Rows>, String> {
        let (_, path) = uri.split_once("content://").unwrap();
        self.asked.borrow_mut().push(path.into());
        let rows = self.tables.get(path).cloned().unwrap_or(Ok(None))?;
        assert!(rows.iter().flatten().all(|row| row.len() == columns.len()));
        Ok(rows)
    }
}

const USER: &str = "org.khronos.openxr.runtime_broker";
const SYSTEM: &str = "org.khronos.openxr.system_runtime_broker";
const ABI: &str = if cfg!(target_arch = "aarch64") { "arm64-v8a" } else { "x86_64" };

fn active(authority: &str) -> String {
    format!("{authority}/openxr/1/abi/{ABI}/runtimes/active/")
}

fn row(cells: &[&str]) -> Vec<Option<String>> {
    cells.iter().map(|cell| Some(cell.to_string())).collect()
}

fn brokers() -> Vec<RuntimeSource> {
    android_places().into_iter().filter(|place| matches!(place, RuntimeSource::Broker(_))).collect()
}

#[test]
fn the_brokers_are_asked_in_turn() {
    let folder = fixture().parent().unwrap().to_str().unwrap();
    let mut broker = Scripted::default();
    let good = row(&["org.example.good", folder, "libfixture.so", "0"]);
    let gone = row(&["org.example.gone", "/system/app/Gone.apk!/lib/arm64-v8a", "libgone.so", "0"]);
    broker.tables.insert(active(SYSTEM), Ok(Some(vec![gone, good])));
    let runtime = find(&brokers(), &broker, None).unwrap();
    assert_eq!(runtime.found().place, RuntimeSource::Broker(SYSTEM.into()));
    assert_eq!(runtime.found().library, fixture());
    assert_eq!(*broker.asked.borrow(), [active(USER), active(SYSTEM)]);
}

#[test]
fn a_broker_renames_functions() {
    let folder = fixture().parent().unwrap().to_str().unwrap();
    for truth in ["1", "true"] {
        let mut broker = Scripted::default();
        broker
            .tables
            .insert(active(USER), Ok(Some(vec![row(&["org.example", folder, "libfixture.so", truth])])));
        let functions = format!("{USER}/openxr/1/abi/{ABI}/runtimes/org.example/functions/");
        let error = find(&brokers(), &broker, None).unwrap_err();
        assert!(
            error.to_string().contains(&format!("{USER} does not tell the function names of org.example"))
        );
        let renamed = row(&["xrNegotiateLoaderRuntimeInterface", "negotiate_refuse"]);
        broker.tables.insert(functions.clone(), Ok(Some(vec![renamed])));
        let error = find(&brokers(), &broker, None).unwrap_err();
        assert!(error.to_string().contains("refuses loader interface 1"), "{error}");
        assert!(broker.asked.borrow().contains(&functions));
    }
}

#[test]
fn a_broker_that_cannot_help_says_why() {
    let mut broker = Scripted::default();
    let error = find(&brokers(), &broker, None).unwrap_err();
    assert!(error.nothing_installed());
    assert_eq!(error.to_string(), format!("{PREFIX}no broker at {USER}; no broker at {SYSTEM}"));

    broker.tables.insert(active(USER), Ok(Some(Vec::new())));
    broker.tables.insert(active(SYSTEM), Err("java.lang.SecurityException: denied".into()));
    let error = find(&brokers(), &broker, None).unwrap_err();
    assert!(!error.nothing_installed(), "a broker that refuses is not nothing");
    assert_eq!(
        error.to_string(),
        format!(
            "{PREFIX}the broker {USER} has no active runtime; the broker {SYSTEM} cannot be asked \
             (java.lang.SecurityException: denied)"
        )
    );

    let incomplete = vec![Some("org.example".into()), None, Some("libr.so".into()), None];
    broker.tables.insert(active(USER), Ok(Some(vec![incomplete])));
    let error = find(&brokers()[..1], &broker, None).unwrap_err().to_string();
    assert_eq!(error, format!("{PREFIX}the broker {USER} names a runtime without native_lib_dir"));
}

#[test]
fn places_follow_the_conventions() {
    let linux = |variables: &[(&str, &str)]| {
        let variables: HashMap<_, _> = variables.iter().copied().collect();
        linux_places(|name| variables.get(name).map(OsString::from))
            .into_iter()
            .map(|place| place.to_string())
            .collect::<Vec<_>>()
    };
    let arch = std::env::consts::ARCH;
    let both = |folder: &str| {
        [
            format!("{folder}/openxr/1/active_runtime.{arch}.json"),
            format!("{folder}/openxr/1/active_runtime.json"),
        ]
    };
    assert_eq!(linux(&[("XR_RUNTIME_JSON", "/r.json"), ("HOME", "/h")]), ["/r.json"]);
    assert_eq!(linux(&[("HOME", "/h")]), [both("/h/.config"), both("/etc/xdg"), both("/etc")].concat());
    assert_eq!(
        linux(&[
            ("HOME", "/h"),
            ("XDG_CONFIG_HOME", "/c"),
            ("XDG_CONFIG_DIRS", "/a::/etc"),
            ("XR_RUNTIME_JSON", "")
        ]),
        [both("/c"), both("/a"), both("/etc")].concat()
    );
    let android: Vec<_> = android_places().iter().map(RuntimeSource::to_string).collect();
    assert_eq!(
        android[..3],
        ["loader libopenxr_loader.so", &format!("broker {USER}"), &format!("broker {SYSTEM}")]
    );
    assert_eq!(android[3..5], both("/product/etc"));
    assert_eq!(android.len(), 3 + 2 * 5);
    assert!(android.last().unwrap().starts_with("/system/etc/"));
}

#[test]
fn all_failures_are_listed_in_one_line() {
    let places =
        [RuntimeSource::Manifest("/absent/a.json".into()), RuntimeSource::Manifest("/absent/b.json".into())];
    let error = find(&places, &NoBroker, None).unwrap_err();
    assert!(error.nothing_installed());
    assert_eq!(
        error.to_string(),
        format!("{PREFIX}/absent/a.json does not exist; /absent/b.json does not exist")
    );
}
