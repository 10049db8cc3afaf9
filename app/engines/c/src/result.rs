//! Result codes, their texts, and error messages.

use std::any::Any;
use std::borrow::Cow;
use std::ffi::{CStr, CString, c_char, c_void};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::ptr;

use yoro::eyes::EyesError;
use yoro::opengl::GlError;

/// The result of a function: YORO_OK, or one of the negative YORO_ERROR_ codes.
pub type YoroResult = i32;

/// Success.
pub const YORO_OK: YoroResult = 0;
/// A pointer that must not be NULL is NULL.
pub const YORO_ERROR_NULL: YoroResult = -1;
/// struct_size is not the size of the structure, or a newer program sets fields that this library does not know.
pub const YORO_ERROR_STRUCT_SIZE: YoroResult = -2;
/// A value is out of its range: not finite, a size of zero, an unknown constant, or planes out of order.
pub const YORO_ERROR_VALUE: YoroResult = -3;
/// A matrix is not a rigid view or not a perspective projection, or the two eyes' matrices do not match.
pub const YORO_ERROR_MATRIX: YoroResult = -4;
/// The eyes look in different directions. Use YORO_EYES_PARALLEL, or render both eyes.
pub const YORO_ERROR_EYES_CANTED: YoroResult = -5;
/// The eyes do not lie on one horizontal line. Use YORO_EYES_PARALLEL.
pub const YORO_ERROR_EYES_OFF_AXIS: YoroResult = -6;
/// The left eye lies to the right of the right eye, or surfaces at the near plane move by more pixels than can be
/// synthesized (4095, in images that are wider).
pub const YORO_ERROR_EYES_IPD: YoroResult = -7;
/// The eyes' images have different tangents per pixel. Use YORO_EYES_EVEN.
pub const YORO_ERROR_EYES_DENSITY: YoroResult = -8;
/// The rows of one eye's image lie between the rows of the other's. Use YORO_EYES_EVEN.
pub const YORO_ERROR_EYES_ROWS: YoroResult = -9;
/// An image is wider or higher than the driver, or any driver, can render.
pub const YORO_ERROR_TOO_LARGE: YoroResult = -10;
/// No GL context is current on this thread, or the loader does not return the API's entry points.
pub const YORO_ERROR_NO_CONTEXT: YoroResult = -11;
/// The GL context or the driver is too old, or lacks a feature that was asked for.
pub const YORO_ERROR_UNSUPPORTED: YoroResult = -12;
/// A texture, image or framebuffer does not exist, or has the wrong format, type or size.
pub const YORO_ERROR_FORMAT: YoroResult = -13;
/// The driver refused a shader, an object or a command.
pub const YORO_ERROR_DRIVER: YoroResult = -14;
/// The YoroContext was created for a different API than the function's.
pub const YORO_ERROR_API: YoroResult = -15;
/// Another thread is inside a function with this YoroContext.
pub const YORO_ERROR_BUSY: YoroResult = -16;
/// No memory is left on the host or on the device.
pub const YORO_ERROR_MEMORY: YoroResult = -17;
/// The Vulkan device is lost: create both it and the YoroContext again.
pub const YORO_ERROR_DEVICE_LOST: YoroResult = -18;
/// The id is not registered with this YoroContext, or was released.
pub const YORO_ERROR_NOT_REGISTERED: YoroResult = -19;
/// An internal error of the library. Afterwards the YoroContext returns only this error, and can only be destroyed.
pub const YORO_ERROR_INTERNAL: YoroResult = -20;

/// Receives an error message: one sentence that names the fault and the remedy, in UTF-8, valid during the call only.
/// It is called on the thread of the failing function, before that returns. It must not throw, and must not call yoro
/// with the same context.
pub type YoroMessageCallback =
    Option<unsafe extern "C" fn(user: *mut c_void, result: YoroResult, sentence: *const c_char)>;

/// The receiver of error messages.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct YoroMessages {
    /// Called for each error; may be NULL.
    pub callback: YoroMessageCallback,
    /// The first argument of the callback.
    pub user: *mut c_void,
}

/// Returns a short text for a result, such as "the eyes are canted", and "unknown result" for other numbers. The text
/// lives as long as the library.
///
/// Call it from any thread.
#[unsafe(no_mangle)]
pub extern "C" fn yoro_result_text(result: YoroResult) -> *const c_char {
    text(result).as_ptr()
}

fn text(result: YoroResult) -> &'static CStr {
    match result {
        YORO_OK => c"no error",
        YORO_ERROR_NULL => c"a pointer is NULL",
        YORO_ERROR_STRUCT_SIZE => c"struct_size is wrong",
        YORO_ERROR_VALUE => c"a value is out of range",
        YORO_ERROR_MATRIX => c"the matrices are no views or no perspective projections",
        YORO_ERROR_EYES_CANTED => c"the eyes are canted",
        YORO_ERROR_EYES_OFF_AXIS => c"the eyes do not lie on one horizontal line",
        YORO_ERROR_EYES_IPD => c"the distance between the eyes is out of range",
        YORO_ERROR_EYES_DENSITY => c"the eyes have different pixel densities",
        YORO_ERROR_EYES_ROWS => c"the rows of the eyes' images do not meet",
        YORO_ERROR_TOO_LARGE => c"an image is too large",
        YORO_ERROR_NO_CONTEXT => c"no GL context is current",
        YORO_ERROR_UNSUPPORTED => c"the driver lacks what is needed",
        YORO_ERROR_FORMAT => c"an image is missing or has another format, type or size",
        YORO_ERROR_DRIVER => c"the driver refused",
        YORO_ERROR_API => c"the context belongs to another API",
        YORO_ERROR_BUSY => c"another thread uses the context",
        YORO_ERROR_MEMORY => c"no memory is left",
        YORO_ERROR_DEVICE_LOST => c"the Vulkan device is lost",
        YORO_ERROR_NOT_REGISTERED => c"the images are not registered",
        YORO_ERROR_INTERNAL => c"an error of yoro itself",
        _ => c"unknown result",
    }
}

/// An error that will be returned to the caller.
#[derive(Debug)]
pub(crate) struct Failure {
    pub(crate) code: YoroResult,
    sentence: Cow<'static, str>,
}

impl Failure {
    pub(crate) fn new(code: YoroResult, sentence: impl Into<Cow<'static, str>>) -> Failure {
        Failure { code, sentence: sentence.into() }
    }

    pub(crate) fn value(sentence: impl Into<Cow<'static, str>>) -> Failure {
        Failure::new(YORO_ERROR_VALUE, sentence)
    }

    fn internal(payload: Box<dyn Any + Send>) -> Failure {
        let sentence = match (payload.downcast_ref::<String>(), payload.downcast_ref::<&str>()) {
            (Some(text), _) => text.clone(),
            (None, Some(text)) => (*text).to_owned(),
            _ => String::new(),
        };
        // Dropping the panic's payload could panic again.
        std::mem::forget(payload);
        Failure::new(YORO_ERROR_INTERNAL, format!("an error of yoro itself, please report it: {sentence}"))
    }
}

impl From<EyesError> for Failure {
    fn from(error: EyesError) -> Failure {
        let code = match error {
            EyesError::Canted { .. } => YORO_ERROR_EYES_CANTED,
            EyesError::OffAxis { .. } => YORO_ERROR_EYES_OFF_AXIS,
            EyesError::Swapped { .. } | EyesError::Displacement { .. } => YORO_ERROR_EYES_IPD,
            EyesError::Density { .. } => YORO_ERROR_EYES_DENSITY,
            EyesError::Rows { .. } => YORO_ERROR_EYES_ROWS,
            EyesError::TooLarge { .. } => YORO_ERROR_TOO_LARGE,
            _ => YORO_ERROR_VALUE,
        };
        let flag = match code {
            YORO_ERROR_EYES_CANTED | YORO_ERROR_EYES_OFF_AXIS => " (YORO_EYES_PARALLEL)",
            YORO_ERROR_EYES_DENSITY | YORO_ERROR_EYES_ROWS => " (YORO_EYES_EVEN)",
            _ => "",
        };
        if let EyesError::GuardBand(_) = error {
            return Failure::value(
                "guard_band is not a distance: give 0 for none, or a finite number of more than 0",
            );
        }
        Failure::new(code, format!("{error}{flag}"))
    }
}

impl From<GlError> for Failure {
    fn from(error: GlError) -> Failure {
        let code = match error {
            GlError::Unsupported(_) => YORO_ERROR_UNSUPPORTED,
            GlError::TooLarge { .. } => YORO_ERROR_TOO_LARGE,
            GlError::OutOfMemory { .. } => YORO_ERROR_MEMORY,
            GlError::Shader { .. } | GlError::Object { .. } => YORO_ERROR_DRIVER,
            _ => YORO_ERROR_INTERNAL,
        };
        Failure::new(code, error.to_string())
    }
}

impl YoroMessages {
    pub(crate) const NONE: YoroMessages = YoroMessages { callback: None, user: ptr::null_mut() };

    fn tell(&self, failure: &Failure) {
        let Some(callback) = self.callback else { return };
        let bytes: Vec<u8> = failure.sentence.bytes().filter(|&byte| byte != 0).collect();
        if let Ok(sentence) = CString::new(bytes) {
            // SAFETY: the caller passed a function of this type together with its argument.
            unsafe { callback(self.user, failure.code, sentence.as_ptr()) };
        }
    }
}

/// Runs the body of a function of the interface. Errors and panics become codes, and their messages go to the callback
/// that the body puts into `messages`.
pub(crate) fn catch_errors(body: impl FnOnce(&mut YoroMessages) -> Result<(), Failure>) -> YoroResult {
    let mut messages = YoroMessages::NONE;
    let outcome = catch_unwind(AssertUnwindSafe(|| body(&mut messages)));
    let Err(failure) = outcome.unwrap_or_else(|payload| Err(Failure::internal(payload))) else {
        return YORO_OK;
    };
    messages.tell(&failure);
    failure.code
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_result_has_a_text_of_its_own() {
        let texts: BTreeSet<_> = (YORO_ERROR_INTERNAL..=YORO_OK).map(text).collect();
        assert_eq!(texts.len(), (YORO_OK - YORO_ERROR_INTERNAL + 1) as usize);
        assert!(!texts.contains(text(1)));
        assert_eq!(text(i32::MIN), text(1));
    }

    #[test]
    fn a_panic_becomes_a_code_and_a_sentence() {
        unsafe extern "C" fn note(user: *mut c_void, result: YoroResult, sentence: *const c_char) {
            // SAFETY: the test's own string, and a C string as the callback requires.
            unsafe {
                *user.cast::<String>() = format!("{result} {}", CStr::from_ptr(sentence).to_str().unwrap())
            };
        }
        let mut noted = String::new();
        let code = catch_errors(|messages| {
            *messages = YoroMessages { callback: Some(note), user: (&raw mut noted).cast() };
            panic!("ou\0ch {}", 1)
        });
        assert_eq!(code, YORO_ERROR_INTERNAL);
        assert_eq!(noted, "-20 an error of yoro itself, please report it: ouch 1");
    }
}
