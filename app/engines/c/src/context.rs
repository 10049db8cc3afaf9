//! The context: the synthesis in one GL context or on one Vulkan device, guarded against use by two threads at once.

use std::any::Any;
use std::cell::UnsafeCell;
use std::ptr;
use std::sync::atomic::{AtomicU8, Ordering};

use crate::result::{
    Failure, YORO_ERROR_API, YORO_ERROR_BUSY, YORO_ERROR_INTERNAL, YORO_ERROR_NULL, YoroMessages, YoroResult,
    catch_errors,
};
use crate::versioned::{self, Versioned, versioned};

/// The synthesis in one GL context or on one Vulkan device: compiled shaders and small buffers.
///
/// Use it from one thread at a time. A second thread receives YORO_ERROR_BUSY. For OpenGL that must be the thread on
/// which the GL context is current; for Vulkan it can be any thread.
pub struct YoroContext {
    state: AtomicU8,
    messages: YoroMessages,
    backend: UnsafeCell<Box<dyn Backend>>,
}

const READY: u8 = 0;
const BUSY: u8 = 1;
/// A call has panicked, so the contents may be inconsistent.
const BROKEN: u8 = 2;

/// The part of a context that is specific to one API.
pub(crate) trait Backend: Any {
    /// Returns the name of the API, for error messages.
    fn api(&self) -> &'static str;

    fn capabilities(&self) -> YoroCapabilities;

    /// Returns the times of a frame, or `None` if there are none yet.
    fn times(&mut self) -> Result<Option<YoroTimes>, Failure>;
}

/// The API of a YoroContext.
pub type YoroApi = u32;
/// OpenGL ES.
pub const YORO_API_OPENGL_ES: YoroApi = 0;
/// Desktop OpenGL.
pub const YORO_API_OPENGL: YoroApi = 1;
/// Vulkan.
pub const YORO_API_VULKAN: YoroApi = 2;

/// The driver of a YoroContext and its limits.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct YoroCapabilities {
    /// sizeof(YoroCapabilities), set by the caller.
    pub struct_size: u32,
    /// The API of the context.
    pub api: YoroApi,
    /// Major version of the API: 3 for 3.1.
    pub api_major: u32,
    /// Minor version of the API: 1 for 3.1.
    pub api_minor: u32,
    /// 1 if the CPU renders (llvmpipe, SwiftShader).
    pub software: u32,
    /// Largest width and height of an image in pixels.
    pub max_image_size: u32,
    /// Bytes of the buffers that the context has allocated on the GPU.
    pub buffer_bytes: u64,
    /// Name of the GPU or its driver in UTF-8, terminated by 0, and truncated if it is too long.
    pub device: [u8; 128],
}

versioned!(YoroCapabilities);

impl YoroCapabilities {
    pub(crate) fn set_device(&mut self, name: &str) {
        let length = name.floor_char_boundary(self.device.len() - 1);
        self.device[..length].copy_from_slice(&name.as_bytes()[..length]);
    }
}

/// Returns the driver of a context and its limits.
///
/// Call it on the thread that may use the context; for OpenGL with the GL context current. It changes no GL state.
///
/// @param context      The context.
/// @param capabilities Receives the limits. The caller sets struct_size.
/// @pre context is alive.
/// @return YORO_ERROR_NULL, YORO_ERROR_STRUCT_SIZE, YORO_ERROR_BUSY.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn yoro_capabilities(
    context: *mut YoroContext,
    capabilities: *mut YoroCapabilities,
) -> YoroResult {
    // SAFETY: the header requires pointers that are null or point to live objects of their types.
    unsafe {
        enter(context, |backend| versioned::write(capabilities, "capabilities", &backend.capabilities()))
    }
}

/// The GPU times of one frame, in nanoseconds. All are 0 until the first are known.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct YoroTimes {
    /// sizeof(YoroTimes), set by the caller.
    pub struct_size: u32,
    /// 1 if the times are known.
    pub is_known: u32,
    /// Time to find the bounds of the displacements, or of the depths, in each tile.
    pub tiles_ns: u64,
    /// Time to find the part of the source to search for each tile of the target.
    pub spans_ns: u64,
    /// Time of the search, which writes the target.
    pub march_ns: u64,
}

versioned!(YoroTimes);

impl YoroTimes {
    pub(crate) const UNKNOWN: YoroTimes = YoroTimes {
        struct_size: size_of::<YoroTimes>() as u32,
        is_known: 0,
        tiles_ns: 0,
        spans_ns: 0,
        march_ns: 0,
    };
}

/// Returns the times of the passes in an earlier frame. Call it once a frame, before the synthesis; it does not wait
/// for the GPU.
///
/// OpenGL: the times are those of a frame a few frames ago, if `timed` of YoroGlInfo is 1 and the driver has reliable
/// timer queries. Those of CPU rasterizers are not. Vulkan: the times are those of the frame recorded `timed_frames`
/// (of YoroVkInfo) calls of yoro_vk_record ago, on queue families with timestamps.
///
/// Thread and preconditions are as for yoro_capabilities.
///
/// @param context The context.
/// @param times   Receives the times. The caller sets struct_size.
/// @pre For Vulkan the commands of that frame have been executed.
/// @return YORO_ERROR_DEVICE_LOST, YORO_ERROR_NULL, YORO_ERROR_STRUCT_SIZE, YORO_ERROR_BUSY.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn yoro_times(context: *mut YoroContext, times: *mut YoroTimes) -> YoroResult {
    // SAFETY: the header requires pointers that are null or point to live objects of their types.
    unsafe {
        enter(context, |backend| {
            versioned::check_output(times, "times")?;
            let known = backend.times()?.map(|known| YoroTimes { is_known: 1, ..known });
            versioned::write(times, "times", &known.unwrap_or(YoroTimes::UNKNOWN))
        })
    }
}

/// Destroys a context and its objects on the GPU. Does nothing if the context is NULL.
///
/// Call it on the thread that may use the context. For OpenGL the GL context must be current. For Vulkan the device
/// must have executed all recorded commands. Destroy the YoroContext before the GL context or device. Deleted GL
/// objects are unbound; other GL state is unchanged.
///
/// @param context The context, or NULL.
/// @pre context is alive and no other thread uses it.
/// @return YORO_ERROR_BUSY if another thread is inside a function with the context; nothing is destroyed then.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn yoro_destroy(context: *mut YoroContext) -> YoroResult {
    catch_errors(|messages| {
        // SAFETY: the header requires pointers that are null or point to live objects of their types.
        let Some(alive) = (unsafe { context.as_ref() }) else { return Ok(()) };
        *messages = alive.messages;
        // The context stays busy for good: of two threads that arrive at once only one continues.
        let take = |state| (state != BUSY).then_some(BUSY);
        alive.state.fetch_update(Ordering::Acquire, Ordering::Acquire, take).map_err(|_| busy())?;
        // SAFETY: `create` made it, and the exchange let nobody else in.
        drop(unsafe { Box::from_raw(context) });
        Ok(())
    })
}

fn busy() -> Failure {
    Failure::new(
        YORO_ERROR_BUSY,
        "another thread is inside a function with this YoroContext: use it from one thread at a time",
    )
}

/// Runs the body of a function that creates a context. `messages` returns the callback in `info`, and `make` makes the
/// part of the context that is specific to one API.
///
/// # Safety
/// `info` is null or points to as many bytes as it states; `context` is null or writable.
pub(crate) unsafe fn create<I: Versioned, B: Backend>(
    info: *const I,
    context: *mut *mut YoroContext,
    messages: impl FnOnce(&I) -> YoroMessages,
    make: impl FnOnce(&I) -> Result<B, Failure>,
) -> YoroResult {
    catch_errors(|told| {
        if !context.is_null() {
            // SAFETY: the caller passes a writable pointer.
            unsafe { context.write(ptr::null_mut()) };
        }
        // SAFETY: the caller passes a pointer to as many bytes as the structure states.
        let info = unsafe { versioned::read(info, "info") }?;
        *told = messages(&info);
        if context.is_null() {
            return Err(Failure::new(
                YORO_ERROR_NULL,
                "context is NULL: give a pointer that receives the new context",
            ));
        }
        let backend = UnsafeCell::new(Box::new(make(&info)?) as Box<dyn Backend>);
        let made = YoroContext { state: AtomicU8::new(READY), messages: *told, backend };
        // SAFETY: as above.
        unsafe { context.write(Box::into_raw(Box::new(made))) };
        Ok(())
    })
}

/// Runs the body of a function that computes how much memory the buffers of a context will take.
///
/// # Safety
/// `info` is null or points to as many bytes as it states; `bytes` is null or writable.
pub(crate) unsafe fn write_bytes<I: Versioned>(
    info: *const I,
    bytes: *mut u64,
    messages: impl FnOnce(&I) -> YoroMessages,
    work_out: impl FnOnce(&I) -> Result<u64, Failure>,
) -> YoroResult {
    catch_errors(|told| {
        // SAFETY: the caller passes a pointer to as many bytes as the structure states.
        let info = unsafe { versioned::read(info, "info") }?;
        *told = messages(&info);
        if bytes.is_null() {
            return Err(Failure::new(
                YORO_ERROR_NULL,
                "bytes is NULL: give a pointer that receives the number",
            ));
        }
        let number = work_out(&info)?;
        // SAFETY: the caller passes a writable pointer.
        unsafe { bytes.write(number) };
        Ok(())
    })
}

/// Runs the body of a function that takes a context.
///
/// # Safety
/// `context` is null or points to a live context.
pub(crate) unsafe fn enter(
    context: *mut YoroContext,
    body: impl FnOnce(&mut dyn Backend) -> Result<(), Failure>,
) -> YoroResult {
    /// Marks the context as broken if the body panics.
    struct Leave<'a>(&'a AtomicU8);

    impl Drop for Leave<'_> {
        fn drop(&mut self) {
            let state = if std::thread::panicking() { BROKEN } else { READY };
            self.0.store(state, Ordering::Release);
        }
    }

    catch_errors(|messages| {
        // SAFETY: the caller passes a live context or null.
        let Some(context) = (unsafe { context.as_ref() }) else {
            return Err(Failure::new(YORO_ERROR_NULL, "context is NULL: create it first"));
        };
        *messages = context.messages;
        match context.state.compare_exchange(READY, BUSY, Ordering::Acquire, Ordering::Acquire) {
            Ok(_) => {}
            Err(BROKEN) => {
                return Err(Failure::new(
                    YORO_ERROR_INTERNAL,
                    "an error of yoro itself has happened in this YoroContext: destroy it",
                ));
            }
            Err(_) => return Err(busy()),
        }
        let _leave = Leave(&context.state);
        // SAFETY: the exchange let nobody else in.
        body(unsafe { &mut **context.backend.get() })
    })
}

/// Runs the body of a function that takes a context of one API. `create` is the name of the function that creates such
/// contexts.
///
/// # Safety
/// `context` is null or points to a live context.
pub(crate) unsafe fn enter_as<B: Backend>(
    context: *mut YoroContext,
    create: &str,
    body: impl FnOnce(&mut B) -> Result<(), Failure>,
) -> YoroResult {
    let downcast = |backend: &mut dyn Backend| {
        let api = backend.api();
        let Some(backend) = (backend as &mut dyn Any).downcast_mut::<B>() else {
            let sentence = format!("this YoroContext was made for {api}: create one with {create}");
            return Err(Failure::new(YORO_ERROR_API, sentence));
        };
        body(backend)
    };
    // SAFETY: the caller passes a live context or null.
    unsafe { enter(context, downcast) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gl::{YORO_GL_STATE_LEAVE, YoroGlInfo};
    use crate::result::YORO_OK;
    use std::ffi::{c_char, c_void};
    use std::ptr::null_mut;
    use yoro_context::{Backend, Headless};

    unsafe extern "C" fn load(name: *const c_char) -> crate::gl::YoroGlProc {
        type GetProcAddress = unsafe extern "C" fn(*const c_char) -> crate::gl::YoroGlProc;
        // SAFETY: libEGL is loaded, since one of its contexts is current, and it is never unloaded.
        unsafe {
            let library = std::mem::ManuallyDrop::new(libloading::Library::new("libEGL.so.1").unwrap());
            library.get::<GetProcAddress>(b"eglGetProcAddress\0").unwrap()(name)
        }
    }

    unsafe extern "C" fn count(user: *mut c_void, _: YoroResult, _: *const c_char) {
        // SAFETY: `user` is the counter below.
        unsafe { *user.cast::<u32>() += 1 };
    }

    #[test]
    fn a_second_thread_and_calls_after_a_panic_are_refused() {
        let _headless = Headless::open(Backend::Egl).unwrap();
        let mut sentences = 0u32;
        let info = YoroGlInfo {
            struct_size: size_of::<YoroGlInfo>() as u32,
            outputs: 0,
            state: YORO_GL_STATE_LEAVE,
            check: 0,
            sources: 0,
            timed: 0,
            warp_kind: 0,
            composes: 0,
            loader: Some(load),
            messages: YoroMessages { callback: Some(count), user: (&raw mut sentences).cast() },
        };
        let mut context = null_mut();
        // SAFETY: the context lives until the last line.
        unsafe {
            assert_eq!(crate::gl::yoro_gl_create(&info, &mut context), YORO_OK);
            let mut inside = [YORO_OK; 2];
            let code = enter(context, |_| {
                inside = [yoro_capabilities(context, null_mut()), yoro_destroy(context)];
                Ok(())
            });
            assert_eq!((code, inside), (YORO_OK, [YORO_ERROR_BUSY; 2]));
            assert_eq!(
                enter(context, |_| panic!("a test of panics: this is no failure")),
                YORO_ERROR_INTERNAL
            );
            assert_eq!(yoro_capabilities(context, null_mut()), YORO_ERROR_INTERNAL);
            assert_eq!(sentences, 4);
            assert_eq!(yoro_destroy(context), YORO_OK);
        }
    }
}
