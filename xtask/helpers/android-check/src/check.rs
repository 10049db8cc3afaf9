//! Checks whether Android will install and start an APK, and whether a store takes it, by the tools of Android's SDK and
//! what these do not see.

use std::collections::BTreeMap;
use std::fmt;
use std::fs::{self, File};
use std::io::Read as _;
use std::path::Path;
use std::process::Command;

use anyhow::{Context as _, bail};
use xtask::ndk::sdk;
use xtask::ndk::target::{ARCHITECTURES, PAGE};
use zip::ZipArchive;

use crate::manifest::Manifest;
use crate::{bundle, library};

/// Maximum size in bytes of a release with its built-in scenes.
const MAX_SIZE: u64 = 8_000_000;
/// What the certificates of the keys say that Android's tools make for development.
const DEBUG_KEY: &str = "CN=Android Debug";

/// Whom an APK or a bundle is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Store {
    /// No store: everybody.
    None,
    /// Meta Horizon Store, as of 5 March 2026: an immersive application has a target API level of 32 to 34, libraries for
    /// arm64 alone, head tracking required, and the headsets by name
    /// (<https://developers.meta.com/horizon/resources/publish-mobile-manifest>), a signature of scheme 2, and no
    /// permission that it does not use (<https://github.com/meta-quest/agentic-tools>, hz-store-submit, 17 June 2026).
    Quest,
    /// Google Play, as of 24 November 2026: target API level 36, libraries for 64 bits, pages of 16 KiB, a bundle
    /// (<https://developer.android.com/google/play/requirements/target-sdk>).
    Play,
}

/// The result of a check.
#[derive(Debug)]
struct Row {
    what: String,
    found: String,
    problem: Option<String>,
}

/// The results of all checks.
#[derive(Debug, Default)]
pub struct Report(Vec<Row>);

impl Report {
    /// True if no row has a problem.
    pub fn passed(&self) -> bool {
        self.0.iter().all(|row| row.problem.is_none())
    }

    /// Adds a row.
    pub fn row(&mut self, what: impl Into<String>, found: impl Into<String>, problem: Option<String>) {
        self.0.push(Row { what: what.into(), found: found.into(), problem });
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let width = self.0.iter().map(|row| row.what.len()).max().unwrap_or(0);
        for Row { what, found, problem } in &self.0 {
            match problem {
                None => writeln!(f, "  ok    {what:width$}  {found}")?,
                Some(problem) => writeln!(f, "  FAIL  {what:width$}  {found}: {problem}")?,
            }
        }
        Ok(())
    }
}

/// Joins names to a list, which is shortened if there are too many.
pub fn shortened(names: &[String]) -> String {
    const SHOWN: usize = 5;
    match names.len().checked_sub(SHOWN) {
        Some(more @ 1..) => format!("{} and {more} more", names[..SHOWN].join(", ")),
        _ => names.join(", "),
    }
}

/// Runs all checks on an APK or a bundle. With `any_key`, stores take what was signed for debugging; with `any_size`, it may
/// be as large as one that is not optimized as a whole.
///
/// # Errors
/// Fails if the file is neither, or a tool for the checks is missing.
pub fn check(path: &Path, store: Store, any_key: bool, any_size: bool) -> anyhow::Result<Report> {
    let shown = path.display();
    let file = File::open(path)
        .with_context(|| format!("{shown} cannot be read (`cargo xtask apk` says where it puts an APK)"))?;
    let size = file.metadata().with_context(|| format!("{shown} cannot be read"))?.len();
    let zip = ZipArchive::new(file);
    let zip =
        zip.with_context(|| format!("{shown} is damaged or no APK: build it anew by `cargo xtask apk`"))?;
    let mut report = Report::default();
    let any_key = any_key || store == Store::None;
    let refuse_form = |report: &mut Report, found: &str, right: &str| {
        report.row("form", found, Some(format!("should be {right}")));
    };
    if zip.index_for_name(bundle::CONFIG).is_some() {
        if store == Store::Quest {
            refuse_form(&mut report, "bundle", "an APK: cargo xtask apk --release --quest");
        }
        // The APK is checked without its alignment, which is up to the store.
        let apk = path.with_extension("checked.apk");
        bundle::check(path, &apk, &mut report)?;
        jar_signature(path, any_key, &mut report)?;
        Manifest::read(&apk)?.check(store, &mut report);
        libraries(&apk, store, &mut report)?;
        fs::remove_file(&apk).with_context(|| format!("{} cannot be removed", apk.display()))?;
        return Ok(report);
    }
    if zip.index_for_name("AndroidManifest.xml").is_none() {
        bail!("{shown} is an archive without AndroidManifest.xml, and so no APK: name the .apk file");
    }
    if store == Store::Play {
        refuse_form(&mut report, "APK", "a bundle: cargo xtask apk --release --bundle");
    }
    let manifest = Manifest::read(path)?;
    let too_large = (size > MAX_SIZE && !manifest.is_debuggable() && !any_size)
        .then(|| format!("a release must be under {} MB", MAX_SIZE / 1_000_000));
    report.row("size", format!("{:.2} MB", size as f64 / 1e6), too_large);
    manifest.check(store, &mut report);
    let problem = zip.index_for_name(&manifest.icon).is_none().then(|| "no such file".to_owned());
    report.row("icon", &manifest.icon, problem);
    signature(path, any_key, &mut report)?;
    let zipalign = tool("zipalign", &["-c", "-v", "4"], path)?;
    let problem = misaligned(&zipalign.text, manifest.unpacks_libraries());
    report.row("alignment", "4 bytes; libraries that are mapped, 16 KiB", problem);
    libraries(path, store, &mut report)?;
    Ok(report)
}

/// What a tool has printed.
struct Output {
    succeeded: bool,
    text: String,
    errors: String,
}

fn tool(name: &str, arguments: &[&str], file: &Path) -> anyhow::Result<Output> {
    let output = Command::new(sdk::build_tool(name)?).args(arguments).arg(file).output();
    let output = output.with_context(|| format!("{name} cannot be started"))?;
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    Ok(Output {
        succeeded: output.status.success(),
        text: text(&output.stdout),
        errors: text(&output.stderr),
    })
}

/// Finds what Android could not map in zipalign's lines `OFFSET NAME (OK)`, which know nothing of pages of 16 KiB, nor that
/// Android 11 and later refuse compressed resources.
fn misaligned(text: &str, unpacked: bool) -> Option<String> {
    let wrong = text.lines().filter_map(|line| {
        let (offset, rest) = line.trim_start().split_once(' ')?;
        let (offset, (name, verdict)) = (offset.parse::<u64>().ok()?, rest.rsplit_once(" (")?);
        let is_compressed = verdict.contains("compressed");
        let is_mapped_library = name.starts_with("lib/") && !unpacked;
        let is_wrong = verdict.starts_with("BAD")
            || is_compressed && (name == "resources.arsc" || is_mapped_library)
            || is_mapped_library && !offset.is_multiple_of(PAGE);
        is_wrong.then(|| format!("{name} at {offset} ({verdict}"))
    });
    let wrong: Vec<String> = wrong.collect();
    (!wrong.is_empty()).then(|| shortened(&wrong))
}

/// Checks that there are libraries for the store's processors, and each of them.
fn libraries(apk: &Path, store: Store, report: &mut Report) -> anyhow::Result<()> {
    let mut zip = ZipArchive::new(File::open(apk)?)?;
    let mut libraries = BTreeMap::new();
    for index in 0..zip.len() {
        let mut file = zip.by_index(index)?;
        if let Some(name) = file.name()?.strip_prefix("lib/").map(str::to_owned) {
            let mut content = Vec::new();
            file.read_to_end(&mut content).with_context(|| format!("{name} in it is damaged"))?;
            libraries.insert(name, content);
        }
    }
    let count = if store == Store::Quest { 1 } else { ARCHITECTURES.len() };
    for architecture in &ARCHITECTURES[..count] {
        let name = format!("{}/libyoro_android.so", architecture.abi);
        if !libraries.contains_key(&name) {
            report.row(
                format!("{} library", architecture.abi),
                "none",
                Some(format!("lib/{name} is not in it")),
            );
        }
    }
    for (name, content) in libraries {
        library::check(&name, &content, &ARCHITECTURES[..count], report);
    }
    Ok(())
}

fn signature(apk: &Path, any_key: bool, report: &mut Report) -> anyhow::Result<()> {
    // The oldest Android that supports v2 signatures. For later versions, apksigner accepts v3 alone.
    let arguments = ["verify", "--verbose", "--print-certs", "--min-sdk-version", "24"];
    let (found, problem) = verdict(&tool("apksigner", &arguments, apk)?, any_key);
    report.row("signature", found, problem);
    Ok(())
}

fn verdict(output: &Output, any_key: bool) -> (String, Option<String>) {
    let scheme = |name: &&&str| {
        let line =
            output.text.lines().find(|line| line.starts_with(&format!("Verified using {name} scheme")));
        line.is_some_and(|line| line.trim_end().ends_with("true"))
    };
    let schemes: Vec<&str> = ["v2", "v3"].iter().filter(scheme).copied().collect();
    let signer =
        output.text.lines().find_map(|line| line.split_once("certificate DN: ")).map(|(_, name)| name);
    let problem = if !output.succeeded {
        let error = output.errors.lines().find_map(|line| line.strip_prefix("ERROR: "));
        Some(error.unwrap_or("apksigner does not verify it").to_owned())
    } else if schemes.len() < 2 {
        Some("should be v2 and v3".to_owned())
    } else {
        refusal(signer.unwrap_or_default(), any_key)
    };
    (signer.map_or("none".to_owned(), |signer| format!("{} by {signer}", schemes.join(" and "))), problem)
}

/// Adds a row for the signature of a bundle, which is that of a JAR.
fn jar_signature(bundle: &Path, any_key: bool, report: &mut Report) -> anyhow::Result<()> {
    let arguments = ["-J-Duser.language=en", "-printcert", "-jarfile"];
    let Output { succeeded, text, .. } = tool("keytool", &arguments, bundle)?;
    if !succeeded {
        // It writes its errors to standard output.
        bail!(
            "the signature of {} cannot be read: {}",
            bundle.display(),
            text.lines().next().unwrap_or_default()
        );
    }
    match text.lines().find_map(|line| line.strip_prefix("Owner: ")) {
        Some(signer) => report.row("signature", format!("of the jar, by {signer}"), refusal(signer, any_key)),
        None => report.row("signature", "none", Some("no store takes it".to_owned())),
    }
    Ok(())
}

/// Returns why a store refuses the key.
fn refusal(signer: &str, any_key: bool) -> Option<String> {
    (!any_key && signer.contains(DEBUG_KEY)).then(|| {
        "a key for debugging, which no store takes: name yours by CARGO_APK_RELEASE_KEYSTORE, and build it anew"
            .to_owned()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_apk_is_refused_with_a_remedy() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("some.apk");
        let refusal = || check(&path, Store::None, false, false).unwrap_err().to_string();
        assert!(refusal().contains("some.apk cannot be read"));
        fs::write(&path, "no archive").unwrap();
        assert!(refusal().contains("some.apk is damaged or no APK"));
        let content = folder.path().join("content");
        xtask::folders::write(&content.join("a.txt"), "a").unwrap();
        bundle::pack(&content, &path).unwrap();
        assert!(refusal().contains("without AndroidManifest.xml"));
    }

    #[test]
    fn pages_and_resources_are_beyond_zipalign() {
        let good = "   49 AndroidManifest.xml (OK - compressed)\n 3444 resources.arsc (OK)\n16384 lib/arm64-v8a/liba.so (OK)\n";
        assert_eq!(misaligned(good, false), None);
        for (from, to) in [
            ("(OK)\n16384", "(OK)\n4096"),
            ("arsc (OK)", "arsc (OK - compressed)"),
            ("arsc (OK)", "arsc (BAD - 2)"),
        ] {
            assert!(misaligned(&good.replace(from, to), false).is_some(), "{to}");
        }
        assert_eq!(misaligned(&good.replace("16384", "4096"), true), None);
    }

    #[test]
    fn both_schemes_are_wanted_and_a_stores_own_key() {
        const GOOD: &str = "Verified using v2 scheme (APK Signature Scheme v2): true\n\
            Verified using v3 scheme (APK Signature Scheme v3): true\nSigner #1 certificate DN: CN=Android Debug, C=US\n";
        let of = |succeeded, text: &str, errors: &str, any_key| {
            verdict(&Output { succeeded, text: text.into(), errors: errors.into() }, any_key)
        };
        assert_eq!(of(true, GOOD, "", true), ("v2 and v3 by CN=Android Debug, C=US".to_owned(), None));
        assert!(of(true, GOOD, "", false).1.unwrap().contains("no store takes"));
        assert_eq!(of(true, &GOOD.replace("Android Debug", "Ada"), "", false).1, None);
        assert!(of(true, &GOOD.replace("v3): true", "v3): false"), "", true).1.is_some());
        let unsigned = of(false, "", "DOES NOT VERIFY\nERROR: Missing META-INF/MANIFEST.MF\n", true);
        assert_eq!(unsigned, ("none".to_owned(), Some("Missing META-INF/MANIFEST.MF".to_owned())));
    }
}
