//! The phone's camera, used to find a viewer's QR code. libcamera2ndk and AImageReader run on a thread of their own,
//! since opening a camera takes a noticeable part of a second, and reading a code a part of a frame.

use std::ffi::{CStr, c_char, c_int, c_void};
use std::ptr::{self, NonNull};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use crate::platform::system::Library;
use crate::share::scan::{Luma, best_size};
use crate::share::{Shared, address_in_text};

/// The interval at which a new picture is looked for.
const PERIOD: Duration = Duration::from_millis(40);
/// The longest duration of a scan. After this the camera is closed.
const LONGEST: Duration = Duration::from_secs(60);
/// A camera that delivers no picture for this long counts as lost.
const SILENT: Duration = Duration::from_secs(5);

const LOST: &str = "The camera was lost, as to another application: touch the tile again.";
const NONE: &str = "This device has no camera that yoro can use: share the address or a picture of the code.";
/// Shown to the user if yoro is not permitted to use the camera.
pub const REFUSED: &str = "yoro may not use the camera: allow it in the system's settings for yoro, or share the \
    address or a picture of the code.";

/// The thread's results since they were last taken.
#[derive(Default)]
struct Found {
    /// See [`Luma::shown`].
    picture: Option<Vec<u8>>,
    outcome: Option<Result<Shared, String>>,
}

/// A scan in progress. Dropping it closes the camera.
pub struct Scan {
    found: Arc<Mutex<Found>>,
    is_over: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl Scan {
    /// Starts a scan. `is_upside_down` is true for a screen whose rotation is `Surface.ROTATION_270`.
    pub fn begin(is_upside_down: bool) -> Scan {
        let (found, is_over) = (Arc::new(Mutex::new(Found::default())), Arc::new(AtomicBool::new(false)));
        let (to, over) = (found.clone(), is_over.clone());
        let work = move || {
            if let Some(outcome) = scan(&to, &over, is_upside_down).transpose() {
                lock(&to).outcome = Some(outcome);
            }
        };
        let thread = thread::Builder::new().name("yoro-camera".into()).spawn(work);
        let thread = thread.map_err(|error| lock(&found).outcome = Some(Err(error.to_string()))).ok();
        Scan { found, is_over, thread }
    }

    /// Returns the newest picture, if there is a new one.
    pub fn picture(&self) -> Option<Vec<u8>> {
        lock(&self.found).picture.take()
    }

    /// Returns the viewer that was found, or the reason why the scan has failed.
    pub fn outcome(&self) -> Option<Result<Shared, String>> {
        lock(&self.found).outcome.take()
    }
}

impl Drop for Scan {
    fn drop(&mut self) {
        self.is_over.store(true, Ordering::Release);
        if let Some(thread) = self.thread.take() {
            _ = thread.join();
        }
    }
}

fn lock(found: &Mutex<Found>) -> MutexGuard<'_, Found> {
    found.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Scans until a code is found or the scan is dropped.
fn scan(found: &Mutex<Found>, is_over: &AtomicBool, turned: bool) -> Result<Option<Shared>, String> {
    let (start, is_lost) = (Instant::now(), AtomicBool::new(false));
    let functions = Functions::load().ok_or(NONE)?;
    let camera = Camera::open(&functions, &is_lost)?;
    let mut last_picture = start;
    while !is_over.load(Ordering::Acquire) {
        if is_lost.load(Ordering::Acquire) || last_picture.elapsed() > SILENT {
            return Err(LOST.into());
        }
        if start.elapsed() > LONGEST {
            return Err("No code was seen for a minute: touch the tile again, in better light.".into());
        }
        let text = camera.look(|picture| {
            lock(found).picture = Some(picture.shown(turned));
            picture.read_qr()
        });
        if text.is_some() {
            last_picture = Instant::now();
        }
        if let Some(text) = text.flatten() {
            return address_in_text(&text).map(Some);
        }
        thread::sleep(PERIOD);
    }
    Ok(None)
}

/// An NDK handle; never null when it is used.
type Handle = *mut c_void;

/// `ACameraIdList`.
#[repr(C)]
struct IdList {
    count: c_int,
    ids: *const *const c_char,
}

/// `ACameraMetadata_const_entry`.
#[repr(C)]
struct Entry {
    tag: u32,
    kind: u8,
    count: u32,
    data: *const c_void,
}

/// `ACameraDevice_StateCallbacks`.
#[repr(C)]
struct DeviceCallbacks {
    context: Handle,
    on_disconnected: unsafe extern "C" fn(Handle, Handle),
    on_error: unsafe extern "C" fn(Handle, Handle, c_int),
}

/// `ACameraCaptureSession_stateCallbacks`.
#[repr(C)]
struct SessionCallbacks {
    context: Handle,
    on_closed: unsafe extern "C" fn(Handle, Handle),
    on_ready: unsafe extern "C" fn(Handle, Handle),
    on_active: unsafe extern "C" fn(Handle, Handle),
}

unsafe extern "C" fn on_disconnected(is_lost: Handle, _device: Handle) {
    // SAFETY: the context points to the flag, which outlives the device.
    unsafe { &*is_lost.cast::<AtomicBool>() }.store(true, Ordering::Release);
}

unsafe extern "C" fn on_error(is_lost: Handle, device: Handle, error: c_int) {
    log::info!("the camera reports error {error}");
    // SAFETY: as in `on_disconnected`.
    unsafe { on_disconnected(is_lost, device) };
}

unsafe extern "C" fn on_session(_context: Handle, _session: Handle) {}

/// `ACAMERA_ERROR_*`: the camera or too many cameras are in use; the permission is missing.
const IN_USE: [c_int; 2] = [-10010, -10011];
const PERMISSION_DENIED: c_int = -10013;
/// `ACAMERA_LENS_FACING`, and its value for a camera at the back.
const LENS_FACING: u32 = 0x8_0005;
const BACK: u8 = 1;
/// `ACAMERA_SCALER_AVAILABLE_STREAM_CONFIGURATIONS`: a sequence of format, width, height, and 1 for inputs.
const STREAM_CONFIGURATIONS: u32 = 0xD_000A;
/// `AIMAGE_FORMAT_YUV_420_888`.
const YUV: c_int = 0x23;
/// `TEMPLATE_PREVIEW`, with continuous autofocus.
const PREVIEW: c_int = 1;
/// Two, so that one picture can be read while the next arrives.
const PICTURES: c_int = 2;

/// Declares functions of libraries, found by name, with the types of the NDK's headers.
macro_rules! functions {
    ($($library:literal: [$($field:ident = $name:literal: fn($($argument:ty),*) $(-> $result:ty)?),* $(,)?]);* $(;)?) => {
        /// The functions of the camera and of pictures.
        struct Functions {
            $($($field: unsafe extern "C" fn($($argument),*) $(-> $result)?,)*)*
        }

        impl Functions {
            /// Finds all functions; `None` if one is missing.
            fn load() -> Option<Functions> {
                $(let library = Library::open($library);
                // SAFETY: the types are those of the NDK's headers.
                $(let $field = unsafe { library.function($name)? };)*)*
                Some(Functions { $($($field,)*)* })
            }
        }
    };
}

functions! {
    c"libcamera2ndk.so": [
        manager_create = c"ACameraManager_create": fn() -> Handle,
        manager_delete = c"ACameraManager_delete": fn(Handle),
        get_ids = c"ACameraManager_getCameraIdList": fn(Handle, *mut *mut IdList) -> c_int,
        delete_ids = c"ACameraManager_deleteCameraIdList": fn(*mut IdList),
        get_characteristics = c"ACameraManager_getCameraCharacteristics": fn(Handle, *const c_char, *mut Handle) -> c_int,
        get_entry = c"ACameraMetadata_getConstEntry": fn(Handle, u32, *mut Entry) -> c_int,
        metadata_free = c"ACameraMetadata_free": fn(Handle),
        open = c"ACameraManager_openCamera": fn(Handle, *const c_char, *mut DeviceCallbacks, *mut Handle) -> c_int,
        close = c"ACameraDevice_close": fn(Handle) -> c_int,
        create_request = c"ACameraDevice_createCaptureRequest": fn(Handle, c_int, *mut Handle) -> c_int,
        request_free = c"ACaptureRequest_free": fn(Handle),
        target_create = c"ACameraOutputTarget_create": fn(Handle, *mut Handle) -> c_int,
        target_free = c"ACameraOutputTarget_free": fn(Handle),
        add_target = c"ACaptureRequest_addTarget": fn(Handle, Handle) -> c_int,
        container_create = c"ACaptureSessionOutputContainer_create": fn(*mut Handle) -> c_int,
        container_free = c"ACaptureSessionOutputContainer_free": fn(Handle),
        output_create = c"ACaptureSessionOutput_create": fn(Handle, *mut Handle) -> c_int,
        output_free = c"ACaptureSessionOutput_free": fn(Handle),
        add_output = c"ACaptureSessionOutputContainer_add": fn(Handle, Handle) -> c_int,
        create_session = c"ACameraDevice_createCaptureSession": fn(Handle, Handle, *const SessionCallbacks, *mut Handle) -> c_int,
        session_close = c"ACameraCaptureSession_close": fn(Handle),
        repeat = c"ACameraCaptureSession_setRepeatingRequest": fn(Handle, Handle, c_int, *mut Handle, *mut c_int) -> c_int,
    ];
    c"libmediandk.so": [
        reader_new = c"AImageReader_new": fn(i32, i32, c_int, c_int, *mut Handle) -> c_int,
        reader_delete = c"AImageReader_delete": fn(Handle),
        get_window = c"AImageReader_getWindow": fn(Handle, *mut Handle) -> c_int,
        acquire = c"AImageReader_acquireLatestImage": fn(Handle, *mut Handle) -> c_int,
        image_delete = c"AImage_delete": fn(Handle),
        get_width = c"AImage_getWidth": fn(Handle, *mut i32) -> c_int,
        get_height = c"AImage_getHeight": fn(Handle, *mut i32) -> c_int,
        get_row_stride = c"AImage_getPlaneRowStride": fn(Handle, c_int, *mut i32) -> c_int,
        get_pixel_stride = c"AImage_getPlanePixelStride": fn(Handle, c_int, *mut i32) -> c_int,
        get_data = c"AImage_getPlaneData": fn(Handle, c_int, *mut *mut u8, *mut c_int) -> c_int,
    ];
}

/// An NDK object that is freed when this is dropped.
struct Owned {
    handle: NonNull<c_void>,
    free: unsafe extern "C" fn(Handle),
}

impl Owned {
    /// Takes what a call creates. `make` gets the place for the handle and returns the call's status.
    fn make(
        free: unsafe extern "C" fn(Handle),
        make: impl FnOnce(*mut Handle) -> c_int,
    ) -> Result<Owned, c_int> {
        let mut handle = ptr::null_mut();
        let status = make(&raw mut handle);
        match NonNull::new(handle).filter(|_| status == 0) {
            Some(handle) => Ok(Owned { handle, free }),
            None => Err(status),
        }
    }

    fn raw(&self) -> Handle {
        self.handle.as_ptr()
    }
}

impl Drop for Owned {
    fn drop(&mut self) {
        // SAFETY: the handle was created by the counterpart of this function, and is freed only once.
        unsafe { (self.free)(self.handle.as_ptr()) };
    }
}

/// An open camera.
struct Device<'a> {
    handle: NonNull<c_void>,
    functions: &'a Functions,
}

impl Drop for Device<'_> {
    fn drop(&mut self) {
        // SAFETY: the camera was opened, and is closed only once. No callback runs afterwards.
        unsafe { (self.functions.close)(self.handle.as_ptr()) };
    }
}

/// A camera that delivers pictures. Fields are dropped in the order of declaration; each depends on those after it.
struct Camera<'a> {
    _session: Owned,
    _request: Owned,
    _target: Owned,
    _output: Owned,
    _outputs: Owned,
    _device: Device<'a>,
    /// Boxed, since the device keeps the address.
    _callbacks: Box<DeviceCallbacks>,
    reader: Owned,
    _manager: Owned,
    functions: &'a Functions,
}

impl<'a> Camera<'a> {
    /// Opens a camera at the back, or else the first one.
    fn open(f: &'a Functions, is_lost: &'a AtomicBool) -> Result<Camera<'a>, String> {
        let failed = |status: c_int| {
            log::info!("the camera answers {status}");
            match status {
                PERMISSION_DENIED => REFUSED.to_owned(),
                _ if IN_USE.contains(&status) => {
                    "Another application uses the camera: end it, and touch the tile again.".into()
                }
                _ => format!(
                    "The camera does not open (error {status}): share the address or a picture of the code."
                ),
            }
        };
        let done = |status: c_int| if status == 0 { Ok(()) } else { Err(failed(status)) };
        // SAFETY: `manager_create` has no arguments, and `to` is valid.
        let manager = Owned::make(f.manager_delete, |to| unsafe {
            *to = (f.manager_create)();
            0
        });
        let manager = manager.map_err(failed)?;
        let (id, [width, height]) = choose(f, &manager)?;
        // SAFETY: in all of these calls the handles are those of live objects, and there is room for the results.
        unsafe {
            let reader = Owned::make(f.reader_delete, |to| (f.reader_new)(width, height, YUV, PICTURES, to))
                .map_err(failed)?;
            let mut window = ptr::null_mut();
            done((f.get_window)(reader.raw(), &raw mut window))?;
            let mut callbacks = Box::new(DeviceCallbacks {
                context: ptr::from_ref(is_lost).cast_mut().cast(),
                on_disconnected,
                on_error,
            });
            let mut device = ptr::null_mut();
            done((f.open)(manager.raw(), id.as_ptr(), &raw mut *callbacks, &raw mut device))?;
            let handle = NonNull::new(device).ok_or(LOST)?;
            let device = Device { handle, functions: f };
            let outputs = Owned::make(f.container_free, |to| (f.container_create)(to)).map_err(failed)?;
            let output = Owned::make(f.output_free, |to| (f.output_create)(window, to)).map_err(failed)?;
            done((f.add_output)(outputs.raw(), output.raw()))?;
            let target = Owned::make(f.target_free, |to| (f.target_create)(window, to)).map_err(failed)?;
            let request = Owned::make(f.request_free, |to| (f.create_request)(handle.as_ptr(), PREVIEW, to))
                .map_err(failed)?;
            done((f.add_target)(request.raw(), target.raw()))?;
            let states = SessionCallbacks {
                context: ptr::null_mut(),
                on_closed: on_session,
                on_ready: on_session,
                on_active: on_session,
            };
            let session = Owned::make(f.session_close, |to| {
                (f.create_session)(handle.as_ptr(), outputs.raw(), &raw const states, to)
            })
            .map_err(failed)?;
            let mut requests = request.raw();
            let none = ptr::null_mut();
            done((f.repeat)(session.raw(), none, 1, &raw mut requests, ptr::null_mut()))?;
            log::info!("the camera gives pictures of {width} x {height}");
            Ok(Camera {
                _session: session,
                _request: request,
                _target: target,
                _output: output,
                _outputs: outputs,
                _device: device,
                _callbacks: callbacks,
                reader,
                _manager: manager,
                functions: f,
            })
        }
    }

    /// Calls `see` with the newest picture; returns `None` if there is no new one.
    fn look<T>(&self, see: impl FnOnce(Luma) -> T) -> Option<T> {
        let f = self.functions;
        // SAFETY: the reader is live, and there is room for the image.
        let image = Owned::make(f.image_delete, |to| unsafe { (f.acquire)(self.reader.raw(), to) }).ok()?;
        let (mut size, mut strides, mut data, mut length) = ([0; 2], [0; 2], ptr::null_mut(), 0);
        // SAFETY: the image is live, and there is room for the results.
        let statuses = unsafe {
            [
                (f.get_width)(image.raw(), &raw mut size[0]),
                (f.get_height)(image.raw(), &raw mut size[1]),
                (f.get_row_stride)(image.raw(), 0, &raw mut strides[0]),
                (f.get_pixel_stride)(image.raw(), 0, &raw mut strides[1]),
                (f.get_data)(image.raw(), 0, &raw mut data, &raw mut length),
            ]
        };
        if statuses != [0; 5] || data.is_null() {
            return None;
        }
        // SAFETY: the plane has `length` bytes, which are valid as long as the image lives.
        let bytes = unsafe { std::slice::from_raw_parts(data, usize::try_from(length).ok()?) };
        let natural = |[a, b]: [i32; 2]| Some([usize::try_from(a).ok()?, usize::try_from(b).ok()?]);
        Some(see(Luma { bytes, size: natural(size)?, strides: natural(strides)? }))
    }
}

/// Returns the camera to open, preferably one at the back, and the size of its pictures.
fn choose<'a>(f: &'a Functions, manager: &Owned) -> Result<(std::ffi::CString, [i32; 2]), String> {
    let mut list = ptr::null_mut();
    // SAFETY: the manager is live, and there is room for the list.
    let status = unsafe { (f.get_ids)(manager.raw(), &raw mut list) };
    if status != 0 || list.is_null() {
        return Err(NONE.into());
    }
    /// The list of cameras, freed on drop.
    struct Ids<'a>(*mut IdList, &'a Functions);
    impl Drop for Ids<'_> {
        fn drop(&mut self) {
            // SAFETY: the list was made by the manager and is freed only once.
            unsafe { (self.1.delete_ids)(self.0) };
        }
    }
    let list: Ids<'a> = Ids(list, f);
    // SAFETY: the list is live.
    let IdList { count, ids } = unsafe { &*list.0 };
    let mut found: Option<(bool, (std::ffi::CString, [i32; 2]))> = None;
    for i in 0..usize::try_from(*count).unwrap_or_default() {
        // SAFETY: the list has `count` null-terminated strings.
        let id = unsafe { CStr::from_ptr(*ids.add(i)) };
        // SAFETY: the manager is live, the string null-terminated, and there is room for the handle.
        let made = |to| unsafe { (f.get_characteristics)(manager.raw(), id.as_ptr(), to) };
        let Ok(characteristics) = Owned::make(f.metadata_free, made) else { continue };
        let entry = |tag| {
            let mut entry = Entry { tag: 0, kind: 0, count: 0, data: ptr::null() };
            // SAFETY: the metadata is live, and there is room for the entry.
            let status = unsafe { (f.get_entry)(characteristics.raw(), tag, &raw mut entry) };
            Some(entry).filter(|entry| status == 0 && !entry.data.is_null() && entry.count > 0)
        };
        // SAFETY: the values of this tag are bytes, and there is at least one.
        let is_back = entry(LENS_FACING).is_some_and(|e| unsafe { *e.data.cast::<u8>() } == BACK);
        let Some(sizes) = entry(STREAM_CONFIGURATIONS) else { continue };
        // SAFETY: the values of this tag are `count` integers of 32 bits, valid as long as the metadata lives.
        let sizes = unsafe { std::slice::from_raw_parts(sizes.data.cast::<i32>(), sizes.count as usize) };
        let (sizes, _) = sizes.as_chunks::<4>();
        let outputs = sizes.iter().filter(|[format, _, _, input]| (*format, *input) == (YUV, 0));
        let Some(size) = best_size(outputs.map(|[_, width, height, _]| [*width, *height])) else { continue };
        if found.as_ref().is_none_or(|(was_back, _)| is_back && !was_back) {
            found = Some((is_back, (id.to_owned(), size)));
        }
    }
    found.map(|(_, camera)| camera).ok_or_else(|| NONE.into())
}
