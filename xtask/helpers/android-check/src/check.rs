//! Checks whether Android will install and start an APK, and whether a store takes it, by the tools of Android's SDK and
//! what these do not see.

use std::fs;
use std::path::Path;
use std::process::Command;

use anyhow::Context as _;
use xtask::console::run;
use xtask::ndk::sdk;
use xtask::ndk::target::{ARCHITECTURES, PAGE};

use crate::manifest::Manifest;
use crate::{bundle, library};

/// Maximum size in bytes of a release with its built-in scenes.
const MAX_SIZE: u64 = 8_000_000;

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

/// The results of all checks.
#[derive(Debug, Default)]
pub struct Report {
    /// A line for each.
    pub text: String,
    /// True if one has found a problem.
    pub failed: bool,
}

impl Report {
    /// Adds a row: what was checked, what was found, and what is wrong with it.
    pub fn row(&mut self, what: &str, found: &str, problem: Option<String>) {
        self.failed |= problem.is_some();
        self.text += &match problem {
            None => format!("  ok    {what:17}  {found}\n"),
            Some(problem) => format!("  FAIL  {what:17}  {found}: {problem}\n"),
        };
    }
}

/// Runs all checks on an APK or a bundle, apart from the rules `any-key` (it may be signed for debugging) and `any-size` (it
/// may be as large as one that is not optimized as a whole).
pub fn check(path: &Path, store: Store, apart_from: &[&str]) -> anyhow::Result<Report> {
    let size = fs::metadata(path).with_context(|| format!("{} cannot be read", path.display()))?.len();
    let files = bundle::unzip(path)?;
    let has = |name: &str| files.iter().any(|(file, _)| file == name);
    let mut report = Report::default();
    let any_key = store == Store::None || apart_from.contains(&"any-key");
    if has(bundle::CONFIG) {
        let right = (store == Store::Quest).then_some("an APK: cargo xtask apk --release --quest");
        report.row("form", "bundle", right.map(|right| format!("should be {right}")));
        // The APK is checked without its alignment, which is up to the store.
        let apk = path.with_extension("checked.apk");
        bundle::check(files, &apk, &mut report)?;
        let keytool = ["-J-Duser.language=en", "-printcert", "-jarfile"];
        let certificate = run(Command::new("keytool").args(keytool).arg(path))?;
        let signer = certificate.lines().find_map(|line| line.strip_prefix("Owner: "));
        let problem = signer.map_or(Some("no store takes it".into()), |signer| refusal(signer, any_key));
        report.row("signature", signer.unwrap_or("none"), problem);
        Manifest::read(&apk)?.check(store, &mut report);
        libraries(&bundle::unzip(&apk)?, store, &mut report);
        fs::remove_file(&apk).with_context(|| format!("{} cannot be removed", apk.display()))?;
        return Ok(report);
    }
    let right = (store == Store::Play).then_some("a bundle: cargo xtask apk --release --bundle");
    report.row("form", "APK", right.map(|right| format!("should be {right}")));
    let manifest = Manifest::read(path)?;
    let is_small = size <= MAX_SIZE || manifest.has(":debuggable(") || apart_from.contains(&"any-size");
    let problem = (!is_small).then(|| format!("a release must be under {} MB", MAX_SIZE / 1_000_000));
    report.row("size", &format!("{:.2} MB", size as f64 / 1e6), problem);
    manifest.check(store, &mut report);
    report.row("icon", &manifest.icon, (!has(&manifest.icon)).then(|| "no such file".into()));
    // The oldest Android that supports v2 signatures. For later versions, apksigner accepts v3 alone.
    let verify = ["verify", "--verbose", "--print-certs", "--min-sdk-version", "24"];
    let (signer, problem) =
        verdict(run(Command::new(sdk::build_tool("apksigner")?).args(verify).arg(path)), any_key);
    report.row("signature", &signer, problem);
    let zipalign = Command::new(sdk::build_tool("zipalign")?).args(["-c", "-v", "4"]).arg(path).output();
    let zipalign = zipalign.context("zipalign cannot be started")?.stdout;
    let problem = misaligned(&String::from_utf8_lossy(&zipalign), manifest.has(":extractNativeLibs("));
    report.row("alignment", "4 bytes; libraries that are mapped, 16 KiB", problem);
    libraries(&files, store, &mut report);
    Ok(report)
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
    (!wrong.is_empty()).then(|| wrong.join(", "))
}

/// Checks that there are libraries for the store's processors, and each of them.
fn libraries(files: &bundle::Files, store: Store, report: &mut Report) {
    let architectures = if store == Store::Quest { &ARCHITECTURES[..1] } else { &ARCHITECTURES };
    for architecture in architectures {
        let name = format!("lib/{}/libyoro_android.so", architecture.abi);
        if !files.iter().any(|(file, _)| *file == name) {
            report.row("library", "none", Some(format!("{name} is not in it")));
        }
    }
    for (name, content) in files {
        if let Some(name) = name.strip_prefix("lib/") {
            library::check(name, content, architectures, report);
        }
    }
}

/// Returns who has signed an APK, and what is wrong with that, by what apksigner says.
fn verdict(verified: anyhow::Result<String>, any_key: bool) -> (String, Option<String>) {
    let text = match verified {
        Ok(text) => text,
        Err(error) => return ("none".into(), Some(error.to_string())),
    };
    let signer = text.lines().find_map(|line| line.split_once("certificate DN: ")).unwrap_or_default().1;
    let is_by = |scheme: &str| {
        let mut lines =
            text.lines().filter(|line| line.starts_with(&format!("Verified using {scheme} scheme")));
        lines.any(|line| line.trim_end().ends_with("true"))
    };
    let problem = if is_by("v2") && is_by("v3") {
        refusal(signer, any_key)
    } else {
        Some("should be v2 and v3".into())
    };
    (signer.to_owned(), problem)
}

/// Returns why a store refuses the key: Android's tools name those for development so.
fn refusal(signer: &str, any_key: bool) -> Option<String> {
    (!any_key && signer.contains("CN=Android Debug")).then(|| {
        "a key for debugging, which no store takes: name yours by CARGO_APK_RELEASE_KEYSTORE, and build it anew"
            .to_owned()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

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
        let of = |text: &str, any_key| verdict(Ok(text.to_owned()), any_key);
        assert_eq!(of(GOOD, true), ("CN=Android Debug, C=US".to_owned(), None));
        assert!(of(GOOD, false).1.unwrap().contains("no store takes"));
        assert_eq!(of(&GOOD.replace("Android Debug", "Ada"), false).1, None);
        assert!(of(&GOOD.replace("v3): true", "v3): false"), true).1.is_some());
    }
}
