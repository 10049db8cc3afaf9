//! Errors as messages of the command line: one sentence, followed by the option that provides its remedy, since
//! libraries do not know the options.

use yoro_bench::bench::{Blank, BlankView};
use yoro_context::ContextError;
use yoro_devices::adb::{DeviceError, quoted};
use yoro_files::FileError;

/// Returns the message for an error in one line: its sentence, and the option that provides the remedy, if any.
pub fn of(error: &anyhow::Error) -> String {
    let sentence = one_line(&sentence(error));
    option(error).map_or_else(|| sentence.clone(), |option| format!("{sentence} ({option})"))
}

/// Returns a message without control characters, which quoted files may contain.
pub fn one_line(text: &str) -> String {
    let parts = text.split(char::is_control).map(str::trim).filter(|part| !part.is_empty());
    parts.collect::<Vec<_>>().join(" ")
}

/// Returns an error followed by its causes. A cause that the error's own message already contains is not repeated.
pub fn sentence(error: &anyhow::Error) -> String {
    error.chain().skip(1).fold(error.to_string(), |message, cause| {
        // Errors of files tell these in their own words.
        let cause = cause.downcast_ref().map_or_else(|| cause.to_string(), yoro_files::remedy);
        if message.contains(&cause) { message } else { format!("{message}: {cause}") }
    })
}

/// Returns the option that provides the remedy of an error, for the end of the message.
fn option(error: &anyhow::Error) -> Option<String> {
    error.chain().find_map(|cause| {
        if let Some(error) = cause.downcast_ref::<DeviceError>() {
            return match error {
                DeviceError::NoAdb(_) => Some("--adb FILE".into()),
                DeviceError::Several(_) => Some("--serial SERIAL, --all".into()),
                DeviceError::NotInstalled { serial, .. } => Some(format!("--serial {}", quoted(serial))),
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
        if let Some(error) = cause.downcast_ref::<BlankView>() {
            return plane(error.blank);
        }
        let other_out = matches!(cause.downcast_ref(), Some(FileError::OtherRun(_) | FileError::InUse(_)));
        other_out.then(|| "--out".into())
    })
}

/// Returns the option that moves the plane by which a view shows nothing.
pub fn plane(blank: Blank) -> Option<String> {
    match blank {
        Blank::Elsewhere => None,
        Blank::Beyond { enough, .. } => Some(format!("--far {enough}")),
        Blank::Before { enough, .. } => Some(format!("--near {enough}")),
    }
}

#[cfg(test)]
mod tests {
    use std::io;

    use anyhow::Context as _;

    use super::*;

    #[test]
    fn a_cause_is_told_once() {
        let source = io::Error::other("the disk is gone");
        let error = anyhow::Error::new(FileError::Read { path: "a.obj".into(), source }).context("scene 1");
        assert_eq!(sentence(&error), "scene 1: cannot read a.obj: the disk is gone");
        let error = Err::<(), _>(io::Error::other("full")).context("out.png").unwrap_err();
        assert_eq!(of(&error), "out.png: full");
        let source = io::Error::from(io::ErrorKind::StorageFull);
        let full = of(&FileError::Write { path: "a.mp4".into(), source }.into());
        assert_eq!(full, "cannot write a.mp4: the disk is full; free some space or choose another place");
    }

    #[test]
    fn a_message_is_one_line_that_can_be_read() {
        let error = anyhow::anyhow!("a.jpg is damaged (Error:\r\n\tno marker\u{1b}[31m): copy it again\n");
        assert_eq!(of(&error), "a.jpg is damaged (Error: no marker [31m): copy it again");
    }

    #[test]
    fn a_remedy_has_its_option() {
        let message = of(&ContextError::NotEgl.into());
        assert!(message.ends_with(" (--gl egl)"), "{message}");
    }
}
