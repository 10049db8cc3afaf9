//! The parts of the manifest that cargo-apk cannot express, and the manifest of the APK for Meta's store.

use anyhow::{Context as _, ensure};

use crate::ndk::target::{QUEST_TARGET_API, TARGET_API};

/// What cargo-apk has no keys for. From target API level 31 on, Android only loads an OpenXR runtime's library from a system
/// partition for an application that names it; not required, since each exists only on headsets of one maker. Android XR
/// starts an OpenXR application in a space of its own only if it has the property.
const OTHERS: &str = r#"<uses-native-library android:name="libopenxr.google.so" android:required="false"/><property android:name="android.window.PROPERTY_XR_ACTIVITY_START_MODE" android:value="XR_ACTIVITY_START_MODE_FULL_SPACE_UNMANAGED"/>"#;
const QUEST: &str =
    r#"<uses-native-library android:name="libopenxr_forwardloader.oculus.so" android:required="false"/>"#;

/// Completes the manifest written by cargo-apk: adds what it has no keys for, and declares the application a game: from API
/// level 36 on, Android lets only games fix their orientation on large screens.
pub fn complete(manifest: &str) -> anyhow::Result<String> {
    Ok(as_game(&at_the_end(manifest, &[QUEST, OTHERS].concat())?))
}

/// Changes the manifest written by cargo-apk into that of the APK for Meta's store. It must conform to
/// <https://developers.meta.com/horizon/resources/publish-mobile-manifest> (5 March 2026) or its upload fails, and may
/// ask for no permission that it does not use. What concerns other makers' headsets, phones and device farms goes, too:
/// on a Quest, nothing would use it.
pub fn for_quest(manifest: &str) -> anyhow::Result<String> {
    let mut text = manifest.to_owned();
    for (from, to) in [
        (
            format!(r#"android:targetSdkVersion="{TARGET_API}""#),
            format!(r#"android:targetSdkVersion="{QUEST_TARGET_API}""#),
        ),
        (r#" android:versionCode="#.into(), r#" android:installLocation="auto" android:versionCode="#.into()),
        (
            r#""android.hardware.vr.headtracking" android:required="false""#.into(),
            r#""android.hardware.vr.headtracking" android:required="true""#.into(),
        ),
        // Only Quest 1 needs `all`, and the store's applications do not come to it any more.
        (r#""all|quest|"#.into(), r#"""#.into()),
    ] {
        ensure!(text.contains(&from), "cargo-apk's manifest has no {from}: is it another version?");
        text = text.replacen(&from, &to, 1);
    }
    for (element, mark) in [
        ("uses-feature", "android.hardware.camera"),
        ("uses-permission", "android.permission.CAMERA"),
        ("meta-data", "pvr.app.type"),
        ("meta-data", "pvr.sdk.version"),
        ("meta-data", "com.google.test.loops"),
        ("category", "com.htc.intent.category.VRAPP"),
        ("intent-filter", "com.google.intent.action.TEST_LOOP"),
        ("intent-filter", "android.intent.action.SEND"),
        ("intent-filter", "android.intent.action.VIEW"),
    ] {
        text = without(&text, element, mark)?;
    }
    Ok(as_game(&at_the_end(&text, QUEST)?))
}

fn as_game(manifest: &str) -> String {
    manifest.replacen("<application", r#"<application android:appCategory="game""#, 1)
}

/// Adds elements to the application.
fn at_the_end(manifest: &str, elements: &str) -> anyhow::Result<String> {
    const END: &str = "</application>";
    let (before, after) = manifest
        .split_once(END)
        .context("cargo-apk has written a manifest without </application>: is it another version?")?;
    Ok([before, elements, END, after].concat())
}

/// Removes all elements of this name that contain `mark`.
fn without(manifest: &str, element: &str, mark: &str) -> anyhow::Result<String> {
    let (start, end) = (format!("<{element}"), format!("</{element}>"));
    let mut kept = String::new();
    let mut rest = manifest;
    let mut count = 0;
    while let Some(at) = rest.find(&start) {
        let (before, from) = rest.split_at(at);
        let tag = from.find('>').context("a tag has no end")? + 1;
        let length = match from[..tag].ends_with("/>") {
            true => tag,
            false => from.find(&end).context("an element has no end")? + end.len(),
        };
        kept.push_str(before);
        if from[..length].contains(mark) {
            count += 1;
        } else {
            kept.push_str(&from[..length]);
        }
        rest = &from[length..];
    }
    ensure!(count > 0, "cargo-apk's manifest has no {element} with {mark}: is it another version?");
    Ok(kept + rest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_added_is_in_the_application() {
        let whole = complete("<manifest><application><activity/></application></manifest>").unwrap();
        let (before, after) = whole.split_once("<activity/>").unwrap();
        assert_eq!(before, "<manifest><application android:appCategory=\"game\">");
        assert_eq!(after, [QUEST, OTHERS, "</application></manifest>"].concat());
        assert!(complete("<manifest/>").unwrap_err().to_string().contains("</application>"));
    }

    #[test]
    fn elements_go_with_all_that_is_in_them() {
        let text = r#"<a><b x="1"/><b><c y="2"/></b><b x="2"></b></a>"#;
        assert_eq!(without(text, "b", "\"2\"").unwrap(), r#"<a><b x="1"/></a>"#);
        assert!(without(text, "b", "\"3\"").unwrap_err().to_string().contains("no b with \"3\""));
    }
}
