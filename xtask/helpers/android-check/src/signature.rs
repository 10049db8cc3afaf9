//! Checks the signature as Android does.

use std::path::Path;
use std::process::Command;

use anyhow::{Context as _, bail};
use xtask::ndk::sdk;

use super::report::Report;

/// What the certificates of the keys say that Android's tools make for development.
const DEBUG: &str = "CN=Android Debug";

/// Adds a row for the signature. `any_key` accepts one for debugging.
///
/// # Errors
/// Fails if apksigner cannot be started.
pub fn check(apk: &Path, any_key: bool, report: &mut Report) -> anyhow::Result<()> {
    let output = Command::new(sdk::build_tool("apksigner")?)
        // The oldest Android that supports v2 signatures. For later versions, apksigner accepts v3 alone.
        .args(["verify", "--verbose", "--print-certs", "--min-sdk-version", "24"])
        .arg(apk)
        .output()
        .context("apksigner cannot be started")?;
    let text = String::from_utf8_lossy(&output.stdout);
    let errors = String::from_utf8_lossy(&output.stderr);
    row(output.status.success(), &text, &errors, any_key, report);
    Ok(())
}

/// Adds a row for the signature of a bundle, which is that of a JAR. `any_key` accepts one for debugging.
///
/// # Errors
/// Fails if keytool cannot be started or cannot read the bundle.
pub fn check_jar(bundle: &Path, any_key: bool, report: &mut Report) -> anyhow::Result<()> {
    let mut keytool = Command::new("keytool");
    keytool.args(["-J-Duser.language=en", "-printcert", "-jarfile"]).arg(bundle);
    let output = keytool
        .output()
        .context("keytool cannot be started: install a Java runtime (default-jre-headless)")?;
    let text = String::from_utf8_lossy(&output.stdout);
    if !output.status.success() {
        // It writes its errors to standard output.
        let told = text.lines().next().unwrap_or_default();
        bail!("the signature of {} cannot be read: {told}", bundle.display());
    }
    match text.lines().find_map(|line| line.strip_prefix("Owner: ")) {
        Some(signer) => {
            report.row("signature", format!("of the jar, by {signer}"), refusal(signer, any_key));
        }
        None => report.row("signature", "none", Some("no store takes it".to_owned())),
    }
    Ok(())
}

/// Returns why a store refuses the key.
fn refusal(signer: &str, any_key: bool) -> Option<String> {
    (!any_key && signer.contains(DEBUG)).then(|| {
        "a key for debugging, which no store takes: name yours by CARGO_APK_RELEASE_KEYSTORE, and build it anew"
            .to_owned()
    })
}

fn row(verified: bool, text: &str, errors: &str, any_key: bool, report: &mut Report) {
    let scheme = |name: &str| {
        let line = text.lines().find_map(|line| line.strip_prefix(&format!("Verified using {name} scheme")));
        line.is_some_and(|line| line.trim_end().ends_with("true"))
    };
    let schemes: Vec<&str> = ["v2", "v3"].into_iter().filter(|name| scheme(name)).collect();
    let signer = text.lines().find_map(|line| line.split_once("certificate DN: ")).map(|(_, name)| name);
    let found = match signer {
        Some(signer) => format!("{} by {signer}", schemes.join(" and ")),
        None => "none".to_owned(),
    };
    let problem = if !verified {
        let told = errors.lines().find_map(|line| line.strip_prefix("ERROR: "));
        Some(told.unwrap_or("apksigner does not verify it").to_owned())
    } else if schemes.len() < 2 {
        Some("should be v2 and v3".to_owned())
    } else {
        refusal(signer.unwrap_or_default(), any_key)
    };
    report.row("signature", found, problem);
}

#[cfg(test)]
mod tests {
    use super::*;

    const GOOD: &str = "Verifies\n\
        Verified using v1 scheme (JAR signing): false\n\
        Verified using v2 scheme (APK Signature Scheme v2): true\n\
        Verified using v3 scheme (APK Signature Scheme v3): true\n\
        Number of signers: 1\n\
        Signer #1 certificate DN: CN=Android Debug, O=Android, C=US\n";

    fn report(verified: bool, text: &str, errors: &str) -> Report {
        let mut report = Report::default();
        row(verified, text, errors, true, &mut report);
        report
    }

    #[test]
    fn both_schemes_are_wanted() {
        let good = report(true, GOOD, "");
        assert!(good.passed());
        assert_eq!(good.rows[0].found, "v2 and v3 by CN=Android Debug, O=Android, C=US");
        assert!(!report(true, &GOOD.replace("v3): true", "v3): false"), "").passed());
    }

    #[test]
    fn a_store_takes_no_key_for_debugging() {
        let mut report = Report::default();
        row(true, GOOD, "", false, &mut report);
        row(true, &GOOD.replace("Android Debug", "Ada"), "", false, &mut report);
        let problems: Vec<_> = report.rows.iter().map(|row| row.problem.as_deref()).collect();
        assert!(problems[0].unwrap().contains("no store takes") && problems[1].is_none());
    }

    #[test]
    fn an_unsigned_file_fails_with_apksigners_words() {
        let bad = report(false, "", "DOES NOT VERIFY\nERROR: Missing META-INF/MANIFEST.MF\n");
        assert_eq!(bad.rows[0].problem.as_deref(), Some("Missing META-INF/MANIFEST.MF"));
        assert_eq!(bad.rows[0].found, "none");
    }
}
