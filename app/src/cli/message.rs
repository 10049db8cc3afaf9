//! An error as the command line tells it: one sentence, with the option by which its remedy is taken; libraries know no
//! options.

use yoro_context::ContextError;
use yoro_devices::adb::{DeviceError, quoted};
use yoro_devices::experiment::ExperimentError;
use yoro_lab::bench::record::RecordError;

/// The sentence, and the option of its remedy if it has one.
pub fn of(error: &anyhow::Error) -> String {
    let sentence = sentence(error);
    option(error).map_or_else(|| sentence.clone(), |option| format!("{sentence} ({option})"))
}

/// An error and what caused it. Many errors of libraries tell their cause in their own words: it is not told again.
pub fn sentence(error: &anyhow::Error) -> String {
    error.chain().skip(1).fold(error.to_string(), |told, cause| {
        let cause = cause.to_string();
        if told.contains(&cause) { told } else { format!("{told}: {cause}") }
    })
}

/// The option by which the remedy of an error is taken, for the end of the message.
fn option(error: &anyhow::Error) -> Option<String> {
    error.chain().find_map(|cause| {
        if let Some(error) = cause.downcast_ref::<DeviceError>() {
            return match error {
                DeviceError::NoAdb { .. } | DeviceError::Start { .. } => Some("--adb FILE".into()),
                DeviceError::Several { .. } => Some("--serial SERIAL, --all".into()),
                DeviceError::NotInstalled(serial) => Some(format!("--serial {}", quoted(serial))),
                DeviceError::PluggedIn { .. } => Some("--serial SERIAL, --plugged".into()),
                _ => None,
            };
        }
        if let Some(error) = cause.downcast_ref::<ContextError>() {
            return match error {
                ContextError::Egl(_) => Some("--gl osmesa".into()),
                ContextError::Osmesa(_) | ContextError::NotEgl => Some("--gl egl".into()),
                _ => None,
            };
        }
        let other_out = matches!(cause.downcast_ref(), Some(ExperimentError::Other { .. }))
            || matches!(cause.downcast_ref(), Some(RecordError::Parameters { .. }));
        other_out.then(|| "--out".into())
    })
}

#[cfg(test)]
mod tests {
    use std::io;

    use anyhow::Context as _;
    use yoro_scene::SceneError;

    use super::*;

    #[test]
    fn a_cause_is_told_once() {
        let source = io::Error::other("the disk is gone");
        let error = anyhow::Error::new(SceneError::Read { path: "a.obj".into(), source }).context("scene 1");
        let told = "scene 1: a.obj cannot be read (the disk is gone): check its permissions and the disk";
        assert_eq!(sentence(&error), told);
        let error = Err::<(), _>(io::Error::other("full")).context("out.png").unwrap_err();
        assert_eq!(of(&error), "out.png: full");
    }

    #[test]
    fn a_remedy_has_its_option() {
        let told = of(&ContextError::NotEgl.into());
        assert!(told.ends_with(" (--gl egl)"), "{told}");
    }
}
