//! libcamera2ndk.so and the AImageReader of libmediandk.so: a single camera at the back, which sees the script's
//! picture.

#![allow(non_snake_case)]

use std::collections::HashMap;
use std::ffi::{c_char, c_int, c_void};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicI32, AtomicU64, AtomicUsize, Ordering};

use crate::exports::{Export, System, exports};
use crate::host::{host, lock};
use crate::script::Device;

type Handle = *mut c_void;

/// `ACAMERA_ERROR_*` and `AMEDIA_*`.
const DISCONNECTED: c_int = -10002;
const NOT_FOUND: c_int = -10004;
const PERMISSION_DENIED: c_int = -10013;
const NO_BUFFER: c_int = -30001;
/// `ACAMERA_LENS_FACING` and `ACAMERA_SCALER_AVAILABLE_STREAM_CONFIGURATIONS`.
const LENS_FACING: u32 = 0x8_0005;
const STREAM_CONFIGURATIONS: u32 = 0xD_000A;
/// Format, width, height, and 1 for inputs. The formats are JPEG (0x100) and YUV_420_888 (0x23).
static CONFIGURATIONS: [i32; 16] =
    [0x100, 4000, 3000, 0, 0x23, 4000, 3000, 0, 0x23, 640, 480, 0, 0x23, 320, 240, 0];
static BACK: u8 = 1;
/// Time between two pictures in nanoseconds.
const PERIOD: u64 = 33_333_333;
/// Unused bytes at the end of each row.
const PADDING: usize = 64;

/// The simulated camera.
pub struct Camera {
    /// The file with the picture that it sees, or `None` without a camera.
    sees: Mutex<Option<std::path::PathBuf>>,
    /// True if the user allows the application to use it.
    pub is_allowed: AtomicBool,
    /// True between the application's request for permission and the answer.
    pub is_asked: AtomicBool,
    /// True while another application uses it.
    is_taken: AtomicBool,
    objects: Mutex<HashMap<usize, &'static str>>,
    last: AtomicUsize,
    /// The application's callback for a lost camera, and its context. 0 while no camera is open.
    on_disconnected: AtomicUsize,
    context: AtomicUsize,
    is_repeating: AtomicBool,
    size: [AtomicI32; 2],
    last_picture: AtomicU64,
    /// The luma of the image that the application holds, and its row stride.
    image: Mutex<(Vec<u8>, usize)>,
}

impl Camera {
    /// Creates the camera of a device.
    pub fn new(device: &Device) -> Self {
        Self {
            sees: Mutex::new(device.camera.clone()),
            is_allowed: AtomicBool::new(false),
            is_asked: AtomicBool::new(false),
            is_taken: AtomicBool::new(false),
            objects: Mutex::default(),
            last: AtomicUsize::new(0xca_0000),
            on_disconnected: AtomicUsize::new(0),
            context: AtomicUsize::new(0),
            is_repeating: AtomicBool::new(false),
            size: Default::default(),
            last_picture: AtomicU64::new(0),
            image: Mutex::default(),
        }
    }

    /// Makes it see another picture.
    pub fn see(&self, file: std::path::PathBuf) {
        *lock(&self.sees) = Some(file);
        self.is_taken.store(false, Ordering::Release);
    }

    /// Lets another application take it.
    pub fn take(&self) {
        self.is_taken.store(true, Ordering::Release);
        let function = self.on_disconnected.load(Ordering::Acquire);
        if function == 0 {
            crate::host::fatal("the script takes a camera that is not open");
        }
        // SAFETY: the application's function has this type and gets its own context. It ignores the device.
        unsafe {
            let function: unsafe extern "C" fn(Handle, Handle) = std::mem::transmute(function);
            function(self.context.load(Ordering::Acquire) as Handle, std::ptr::null_mut());
        }
    }

    fn make(&self, kind: &'static str, to: *mut Handle) -> c_int {
        let handle = self.last.fetch_add(16, Ordering::Relaxed);
        lock(&self.objects).insert(handle, kind);
        host().count(kind, 1);
        // SAFETY: the application gives room for a handle.
        unsafe { *to = handle as Handle };
        0
    }

    fn free(&self, kind: &'static str, handle: Handle) {
        if lock(&self.objects).remove(&(handle as usize)) == Some(kind) {
            host().count(kind, -1);
        } else {
            host().violation(format!("{kind}: freed what is none"));
        }
    }

    fn check(&self, kind: &'static str, handle: *const c_void) {
        if lock(&self.objects).get(&(handle as usize)) != Some(&kind) {
            host().violation(format!("{kind}: used what is none"));
        }
    }
}

fn camera() -> &'static Camera {
    &host().camera
}

/// Returns the functions of this module.
pub fn exports() -> Vec<Export> {
    exports![
        System::Camera, 24: [
            ACameraManager_create, ACameraManager_delete, ACameraManager_getCameraIdList, ACameraManager_deleteCameraIdList,
            ACameraManager_getCameraCharacteristics, ACameraManager_openCamera, ACameraMetadata_getConstEntry, ACameraMetadata_free,
            ACameraDevice_close, ACameraDevice_createCaptureRequest, ACameraDevice_createCaptureSession, ACaptureRequest_free,
            ACaptureRequest_addTarget, ACameraOutputTarget_create, ACameraOutputTarget_free, ACaptureSessionOutputContainer_create,
            ACaptureSessionOutputContainer_free, ACaptureSessionOutputContainer_add, ACaptureSessionOutput_create,
            ACaptureSessionOutput_free, ACameraCaptureSession_close, ACameraCaptureSession_setRepeatingRequest,
        ];
        System::Media, 24: [
            AImageReader_new, AImageReader_delete, AImageReader_getWindow, AImageReader_acquireLatestImage, AImage_delete,
            AImage_getWidth, AImage_getHeight, AImage_getPlaneRowStride, AImage_getPlanePixelStride, AImage_getPlaneData,
        ];
    ]
}

/// Defines functions that free a handle of one kind.
macro_rules! frees {
    ($($name:ident $kind:literal;)*) => {
        $(extern "C" fn $name(handle: Handle) {
            camera().free($kind, handle);
        })*
    };
}

frees! {
    ACameraManager_delete "camera managers";
    ACameraMetadata_free "camera metadata";
    ACaptureRequest_free "camera requests";
    ACameraOutputTarget_free "camera targets";
    ACaptureSessionOutputContainer_free "camera containers";
    ACaptureSessionOutput_free "camera outputs";
    AImageReader_delete "image readers";
    AImage_delete "images";
}

extern "C" fn ACameraManager_create() -> Handle {
    let mut manager = std::ptr::null_mut();
    camera().make("camera managers", &raw mut manager);
    manager
}

/// `ACameraIdList`.
#[repr(C)]
struct IdList {
    count: c_int,
    ids: *const *const c_char,
}

struct Ids([*const c_char; 1]);
// SAFETY: a constant text.
unsafe impl Sync for Ids {}
static IDS: Ids = Ids([c"0".as_ptr()]);

extern "C" fn ACameraManager_getCameraIdList(manager: Handle, to: *mut *mut IdList) -> c_int {
    camera().check("camera managers", manager);
    let count = c_int::from(lock(&camera().sees).is_some());
    host().count("camera lists", 1);
    // SAFETY: the application gives room for a pointer.
    unsafe { *to = Box::into_raw(Box::new(IdList { count, ids: IDS.0.as_ptr() })) };
    0
}

extern "C" fn ACameraManager_deleteCameraIdList(list: *mut IdList) {
    host().count("camera lists", -1);
    // SAFETY: the list was made by the function above, and is freed once.
    drop(unsafe { Box::from_raw(list) });
}

extern "C" fn ACameraManager_getCameraCharacteristics(_: Handle, _: *const c_char, to: *mut Handle) -> c_int {
    camera().make("camera metadata", to)
}

/// `ACameraMetadata_const_entry`.
#[repr(C)]
struct Entry {
    tag: u32,
    kind: u8,
    count: u32,
    data: *const c_void,
}

extern "C" fn ACameraMetadata_getConstEntry(metadata: *const c_void, tag: u32, to: *mut Entry) -> c_int {
    camera().check("camera metadata", metadata);
    let (kind, count, data) = match tag {
        LENS_FACING => (0, 1, (&raw const BACK).cast()),
        STREAM_CONFIGURATIONS => (1, CONFIGURATIONS.len() as u32, CONFIGURATIONS.as_ptr().cast()),
        _ => return NOT_FOUND,
    };
    // SAFETY: the application gives room for an entry.
    unsafe { *to = Entry { tag, kind, count, data } };
    0
}

/// `ACameraDevice_StateCallbacks`.
#[repr(C)]
struct Callbacks {
    context: Handle,
    on_disconnected: usize,
    on_error: usize,
}

extern "C" fn ACameraManager_openCamera(
    manager: Handle,
    _: *const c_char,
    callbacks: *const Callbacks,
    to: *mut Handle,
) -> c_int {
    camera().check("camera managers", manager);
    if !camera().is_allowed.load(Ordering::Acquire) {
        return PERMISSION_DENIED;
    }
    if camera().is_taken.load(Ordering::Acquire) {
        return DISCONNECTED;
    }
    // SAFETY: the application gives its callbacks.
    let callbacks = unsafe { &*callbacks };
    camera().context.store(callbacks.context as usize, Ordering::Release);
    camera().on_disconnected.store(callbacks.on_disconnected, Ordering::Release);
    camera().make("cameras", to)
}

extern "C" fn ACameraDevice_close(device: Handle) -> c_int {
    camera().on_disconnected.store(0, Ordering::Release);
    camera().is_repeating.store(false, Ordering::Release);
    camera().free("cameras", device);
    0
}

extern "C" fn ACameraDevice_createCaptureRequest(device: Handle, _: c_int, to: *mut Handle) -> c_int {
    camera().check("cameras", device);
    camera().make("camera requests", to)
}

extern "C" fn ACaptureRequest_addTarget(request: Handle, target: Handle) -> c_int {
    camera().check("camera requests", request);
    camera().check("camera targets", target);
    0
}

extern "C" fn ACameraOutputTarget_create(window: Handle, to: *mut Handle) -> c_int {
    camera().check("image readers", window);
    camera().make("camera targets", to)
}

extern "C" fn ACaptureSessionOutputContainer_create(to: *mut Handle) -> c_int {
    camera().make("camera containers", to)
}

extern "C" fn ACaptureSessionOutputContainer_add(container: Handle, output: Handle) -> c_int {
    camera().check("camera containers", container);
    camera().check("camera outputs", output);
    0
}

extern "C" fn ACaptureSessionOutput_create(window: Handle, to: *mut Handle) -> c_int {
    camera().check("image readers", window);
    camera().make("camera outputs", to)
}

extern "C" fn ACameraDevice_createCaptureSession(
    device: Handle,
    container: Handle,
    callbacks: *const c_void,
    to: *mut Handle,
) -> c_int {
    camera().check("cameras", device);
    camera().check("camera containers", container);
    if callbacks.is_null() {
        host().violation("a capture session without callbacks");
    }
    camera().make("camera sessions", to)
}

extern "C" fn ACameraCaptureSession_close(session: Handle) {
    camera().is_repeating.store(false, Ordering::Release);
    camera().free("camera sessions", session);
}

extern "C" fn ACameraCaptureSession_setRepeatingRequest(
    session: Handle,
    _: Handle,
    count: c_int,
    requests: *const Handle,
    _: *mut c_int,
) -> c_int {
    camera().check("camera sessions", session);
    for i in 0..usize::try_from(count).unwrap_or_default() {
        // SAFETY: the application passes this many requests.
        camera().check("camera requests", unsafe { *requests.add(i) });
    }
    camera().is_repeating.store(true, Ordering::Release);
    0
}

extern "C" fn AImageReader_new(
    width: i32,
    height: i32,
    format: c_int,
    most: c_int,
    to: *mut Handle,
) -> c_int {
    let is_offered = CONFIGURATIONS.chunks_exact(4).any(|offered| *offered == [format, width, height, 0]);
    if !is_offered || most < 2 {
        host().violation(format!("an image reader of {width} x {height}, format {format}, {most} images"));
    }
    camera().size[0].store(width, Ordering::Release);
    camera().size[1].store(height, Ordering::Release);
    camera().make("image readers", to)
}

/// The reader serves as its own window.
extern "C" fn AImageReader_getWindow(reader: Handle, to: *mut Handle) -> c_int {
    camera().check("image readers", reader);
    // SAFETY: the application gives room for a handle.
    unsafe { *to = reader };
    0
}

extern "C" fn AImageReader_acquireLatestImage(reader: Handle, to: *mut Handle) -> c_int {
    let camera = camera();
    camera.check("image readers", reader);
    let now = host().clock.now();
    let is_fresh = now >= camera.last_picture.load(Ordering::Acquire) + PERIOD;
    let gives = camera.is_repeating.load(Ordering::Acquire) && !camera.is_taken.load(Ordering::Acquire);
    if !gives || !is_fresh {
        return NO_BUFFER;
    }
    camera.last_picture.store(now, Ordering::Release);
    let [width, height] = [0, 1].map(|i| camera.size[i].load(Ordering::Acquire) as usize);
    let file = lock(&camera.sees).clone().unwrap_or_default();
    let picture = match image::open(&file) {
        Ok(picture) => picture.into_luma8(),
        Err(error) => crate::host::fatal(format!("the camera cannot see {}: {error}", file.display())),
    };
    // The picture at its original size, in the centre of a grey wall.
    let stride = width + PADDING;
    let mut luma = vec![0; stride * height];
    let [left, top] = [(width, picture.width()), (height, picture.height())]
        .map(|(room, size)| room.saturating_sub(size as usize) / 2);
    for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
        let at = [x.wrapping_sub(left) as u32, y.wrapping_sub(top) as u32];
        luma[y * stride + x] = picture.get_pixel_checked(at[0], at[1]).map_or(128, |pixel| pixel.0[0]);
    }
    *lock(&camera.image) = (luma, stride);
    camera.make("images", to)
}

/// Defines getters of an image's numbers.
macro_rules! numbers {
    ($($name:ident($($plane:ty)?) $value:expr;)*) => {
        $(extern "C" fn $name(image: *const c_void, $(_: $plane,)? to: *mut i32) -> c_int {
            camera().check("images", image);
            // SAFETY: the application gives room for a number.
            unsafe { *to = $value };
            0
        })*
    };
}

numbers! {
    AImage_getWidth() camera().size[0].load(Ordering::Acquire);
    AImage_getHeight() camera().size[1].load(Ordering::Acquire);
    AImage_getPlaneRowStride(c_int) lock(&camera().image).1 as i32;
    AImage_getPlanePixelStride(c_int) 1;
}

extern "C" fn AImage_getPlaneData(
    image: *const c_void,
    _: c_int,
    to: *mut *mut u8,
    length: *mut c_int,
) -> c_int {
    camera().check("images", image);
    let mut kept = lock(&camera().image);
    // SAFETY: the application gives room for both. The bytes stay until the next image.
    unsafe { (*to, *length) = (kept.0.as_mut_ptr(), kept.0.len() as c_int) };
    0
}
