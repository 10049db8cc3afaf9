//! Desktop OpenGL on the CPU by libOSMesa, loaded at run time.

use std::ffi::{CStr, CString, c_char, c_int, c_uchar, c_uint, c_void};

const LIBRARIES: [&str; 3] = ["libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"];

const OSMESA_FORMAT: c_int = 0x22;
const OSMESA_DEPTH_BITS: c_int = 0x30;
const OSMESA_PROFILE: c_int = 0x33;
const OSMESA_CORE_PROFILE: c_int = 0x34;
const OSMESA_COMPAT_PROFILE: c_int = 0x35;
const OSMESA_CONTEXT_MAJOR_VERSION: c_int = 0x36;
const OSMESA_CONTEXT_MINOR_VERSION: c_int = 0x37;
const SIZE: usize = 16;

type CreateContextAttribs = unsafe extern "C" fn(*const c_int, *mut c_void) -> *mut c_void;
type MakeCurrent = unsafe extern "C" fn(*mut c_void, *mut c_void, c_uint, c_int, c_int) -> c_uchar;
type GetProcAddress = unsafe extern "C" fn(*const c_char) -> *const c_void;
type DestroyContext = unsafe extern "C" fn(*mut c_void);

/// A current OSMesa context; destroyed when dropped.
pub(super) struct OsmesaContext {
    context: *mut c_void,
    destroy: DestroyContext,
    get_proc_address: GetProcAddress,
    /// OSMesa's own buffer, which is not drawn to: everything is rendered into framebuffers.
    _pixels: Box<[u8]>,
    _library: libloading::Library,
}

impl OsmesaContext {
    /// Opens a context of the core profile, or of the compatibility profile.
    pub(super) fn open(compatibility: bool) -> Result<(OsmesaContext, glow::Context), String> {
        // SAFETY: the library's functions have the signatures of GL/osmesa.h; the attribute list ends with 0;
        // the pixels live as long as the context.
        unsafe {
            let library = LIBRARIES
                .iter()
                .find_map(|name| libloading::Library::new(name).ok())
                .ok_or_else(|| format!("{} could not be loaded", LIBRARIES[0]))?;
            let missing = |e: libloading::Error| format!("libOSMesa is too old ({e})");
            let create =
                *library.get::<CreateContextAttribs>(b"OSMesaCreateContextAttribs\0").map_err(missing)?;
            let make_current = *library.get::<MakeCurrent>(b"OSMesaMakeCurrent\0").map_err(missing)?;
            let get_proc_address =
                *library.get::<GetProcAddress>(b"OSMesaGetProcAddress\0").map_err(missing)?;
            let destroy = *library.get::<DestroyContext>(b"OSMesaDestroyContext\0").map_err(missing)?;
            let attributes = [
                OSMESA_FORMAT,
                glow::RGBA as c_int,
                OSMESA_DEPTH_BITS,
                24,
                OSMESA_PROFILE,
                if compatibility { OSMESA_COMPAT_PROFILE } else { OSMESA_CORE_PROFILE },
                OSMESA_CONTEXT_MAJOR_VERSION,
                4,
                OSMESA_CONTEXT_MINOR_VERSION,
                5,
                0,
            ];
            let context = create(attributes.as_ptr(), std::ptr::null_mut());
            if context.is_null() {
                return Err("it offers no OpenGL 4.5 context".into());
            }
            let mut pixels = vec![0u8; SIZE * SIZE * 4].into_boxed_slice();
            let size = SIZE as c_int;
            let current = make_current(context, pixels.as_mut_ptr().cast(), glow::UNSIGNED_BYTE, size, size);
            let this =
                OsmesaContext { context, destroy, get_proc_address, _pixels: pixels, _library: library };
            if current == 0 {
                return Err("its context cannot be made current".into());
            }
            let gl = glow::Context::from_loader_function(|name| {
                CString::new(name).map_or(std::ptr::null(), |name| get_proc_address(name.as_ptr()))
            });
            Ok((this, gl))
        }
    }
}

impl OsmesaContext {
    /// Returns a GL function by name, or null.
    pub(super) fn entry_point(&self, name: &CStr) -> *const c_void {
        // SAFETY: the library is still loaded; the name ends with a zero.
        unsafe { (self.get_proc_address)(name.as_ptr()) }
    }
}

impl Drop for OsmesaContext {
    fn drop(&mut self) {
        // SAFETY: created in `open`, destroyed once; the library is still loaded.
        unsafe { (self.destroy)(self.context) }
    }
}
