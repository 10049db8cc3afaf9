//! The parts of the manifest that cargo-apk cannot express.

use anyhow::Context as _;

use crate::ndk::target::{NATIVE_LIBRARIES, PROPERTIES};

/// Completes the manifest written by cargo-apk. Adds [`NATIVE_LIBRARIES`] and [`PROPERTIES`] to the application, and
/// declares it a game: from API level 36 on, Android lets only games fix their orientation on large screens.
///
/// # Errors
/// Fails if the manifest has no application.
pub fn complete(manifest: &str) -> anyhow::Result<String> {
    const END: &str = "</application>";
    let (before, after) = manifest
        .split_once(END)
        .context("cargo-apk has written a manifest without </application>: is it another version?")?;
    let libraries = NATIVE_LIBRARIES
        .map(|name| format!(r#"<uses-native-library android:name="{name}" android:required="false"/>"#));
    let properties = PROPERTIES
        .map(|(name, value)| format!(r#"<property android:name="{name}" android:value="{value}"/>"#));
    let before = before.replacen("<application", r#"<application android:appCategory="game""#, 1);
    Ok([&before, &*libraries.concat(), &*properties.concat(), END, after].concat())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_added_is_in_the_application() {
        let whole = complete("<manifest><application><activity/></application></manifest>").unwrap();
        assert_eq!(
            whole,
            "<manifest><application android:appCategory=\"game\"><activity/>\
             <uses-native-library android:name=\"libopenxr.google.so\" android:required=\"false\"/>\
             <uses-native-library android:name=\"libopenxr_forwardloader.oculus.so\" android:required=\"false\"/>\
             <property android:name=\"android.window.PROPERTY_XR_ACTIVITY_START_MODE\" \
             android:value=\"XR_ACTIVITY_START_MODE_FULL_SPACE_UNMANAGED\"/>\
             </application></manifest>"
        );
        assert!(complete("<manifest/>").unwrap_err().to_string().contains("</application>"));
    }
}
