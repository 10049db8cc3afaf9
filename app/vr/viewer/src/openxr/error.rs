//! Errors of a headset.

use openxr as xr;
use xr::sys;

use super::runtime::NotFound;
use yoro_gl::GlError;

/// A reason why a headset cannot be used, or can no longer be used. Each is one sentence with the remedy.
#[derive(Debug, thiserror::Error)]
pub enum XrError {
    /// No runtime was found.
    #[error(transparent)]
    NotFound(#[from] NotFound),
    /// A call failed.
    #[error("{function} of the OpenXR runtime failed with XR_{result:?}: {}", remedy(function, *result))]
    Call {
        /// The function's name in the specification.
        function: &'static str,
        /// The result that it returned.
        result: sys::Result,
    },
    /// The runtime lacks an extension or needs another version of OpenGL ES, or several sessions in a row have failed.
    #[error("{0}")]
    Unusable(String),
    /// The runtime violates the specification.
    #[error("the OpenXR runtime {0}: that is a mistake in the runtime, so update it")]
    InvalidRuntimeData(String),
    /// The runtime has ended the session.
    #[error("the OpenXR runtime has ended the session by itself: a new one is begun")]
    Lost,
    /// The GL context cannot be used.
    #[error("the OpenGL ES context cannot be used with OpenXR: {0}")]
    Context(String),
    /// A GL operation failed.
    #[error(transparent)]
    Gl(#[from] GlError),
}

impl XrError {
    /// True if the session or the whole instance is lost, whatever the cause.
    pub fn is_loss(&self) -> bool {
        matches!(
            self,
            XrError::Lost
                | XrError::Call {
                    result: sys::Result::ERROR_SESSION_LOST | sys::Result::ERROR_INSTANCE_LOST,
                    ..
                }
        )
    }
}

/// Returns the error of a runtime without an extension.
pub(super) fn without(extension: &str) -> XrError {
    XrError::Unusable(format!(
        "the OpenXR runtime has no {extension}, without which it cannot take images of OpenGL ES: use another runtime"
    ))
}

/// Returns the remedy for a result.
fn remedy(function: &str, result: sys::Result) -> &'static str {
    match result {
        sys::Result::ERROR_FORM_FACTOR_UNAVAILABLE => "connect the headset, switch it on and start again",
        sys::Result::ERROR_FORM_FACTOR_UNSUPPORTED => {
            "this runtime serves no headsets, so choose another one by XR_RUNTIME_JSON"
        }
        sys::Result::ERROR_RUNTIME_UNAVAILABLE | sys::Result::ERROR_INITIALIZATION_FAILED => {
            "start the runtime's service, and look into its log"
        }
        sys::Result::ERROR_RUNTIME_FAILURE if function == "xrCreateInstance" => {
            "start the runtime's service, and look into its log"
        }
        sys::Result::ERROR_API_VERSION_UNSUPPORTED => "update the runtime: OpenXR 1.0 is needed",
        sys::Result::ERROR_OUT_OF_MEMORY | sys::Result::ERROR_LIMIT_REACHED => {
            "a smaller render-scale or scene needs less memory"
        }
        sys::Result::ERROR_GRAPHICS_DEVICE_INVALID => {
            "the runtime and this program must use the same graphics device"
        }
        sys::Result::ERROR_PERMISSION_INSUFFICIENT => "grant the permission in the system's settings",
        sys::Result::ERROR_SESSION_LOST => "a new session is begun",
        sys::Result::ERROR_INSTANCE_LOST => "the runtime was stopped or replaced, and is asked again",
        sys::Result::ERROR_FUNCTION_UNSUPPORTED => "update the runtime",
        sys::Result::TIMEOUT_EXPIRED => "the compositor does not answer, so restart the runtime",
        _ => "restart the runtime, and update it if that does not help",
    }
}

/// Converts a result, adding the name of the function that returned it.
pub(super) fn call<T>(function: &'static str, result: xr::Result<T>) -> Result<T, XrError> {
    result.map_err(|result| XrError::Call { function, result })
}

/// Does the same as [`call`] for functions that are called without the crate's wrapper.
pub(super) fn check(function: &'static str, result: sys::Result) -> Result<sys::Result, XrError> {
    if result.into_raw() >= 0 { Ok(result) } else { Err(XrError::Call { function, result }) }
}

/// Handles the result of something optional: logs why it is missing and continues, unless the session is lost.
pub(super) fn optional<T>(what: &str, result: Result<T, XrError>) -> Result<Option<T>, XrError> {
    match result {
        Ok(value) => Ok(Some(value)),
        Err(error) if error.is_loss() => Err(error),
        Err(error) => {
            log::warn!("{what}: {error}");
            Ok(None)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_sentence_names_the_call_and_a_remedy() {
        let lost = XrError::Call { function: "xrEndFrame", result: sys::Result::ERROR_SESSION_LOST };
        let text = lost.to_string();
        assert!(text.contains("xrEndFrame") && text.contains("XR_ERROR_SESSION_LOST"), "{text}");
        assert!(lost.is_loss() && XrError::Lost.is_loss());
        let other = XrError::Call { function: "xrEndFrame", result: sys::Result::from_raw(-4711) };
        assert!(!other.is_loss() && other.to_string().contains("-4711"), "{other}");
        assert!(optional("test", Err::<(), _>(lost)).is_err());
        assert!(optional("test", Err::<(), _>(other)).unwrap().is_none());
        assert!(check("xrWaitFrame", sys::Result::SESSION_LOSS_PENDING).is_ok());
    }
}
