//! A runtime's library: loading it and negotiating with it.

use std::collections::HashMap;
use std::ffi::c_void;
use std::mem;
use std::path::PathBuf;
use std::ptr;

use libloading::Library;
use openxr::sys::{self, Handle as _, pfn};

use super::error::Failure;

/// The version of the interface between loaders and runtimes.
const INTERFACE: u32 = 1;

/// The Java side of an Android application, for `xrInitializeLoaderKHR`.
#[derive(Clone, Copy, Debug)]
pub struct JavaContext {
    vm: *mut c_void,
    activity: *mut c_void,
}

impl JavaContext {
    /// Creates it from a `JavaVM*` and a JNI reference to the `android.app.Activity`.
    ///
    /// # Safety
    /// Both pointers must remain valid for as long as the context is used; the reference must be a global one.
    pub unsafe fn new(vm: *mut c_void, activity: *mut c_void) -> JavaContext {
        JavaContext { vm, activity }
    }
}

/// `XrLoaderInitInfoAndroidKHR`, which `openxr` declares only for Android but the tests need everywhere.
#[repr(C)]
struct LoaderInitInfoAndroid {
    ty: sys::StructureType,
    next: *const c_void,
    application_vm: *mut c_void,
    application_context: *mut c_void,
}

/// A library that a place names.
#[derive(Debug)]
pub(super) struct Candidate {
    /// A path, or a plain name.
    pub(super) library: PathBuf,
    /// Symbols of the functions whose names differ from the specification.
    pub(super) functions: HashMap<String, String>,
}

impl Candidate {
    /// Loads a runtime and negotiates versions with it. Returns its `xrGetInstanceProcAddr` and the version of the API.
    pub(super) fn negotiate(
        &self,
        java: Option<&JavaContext>,
    ) -> Result<(pfn::GetInstanceProcAddr, sys::Version), Failure> {
        let library = self.open()?;
        // SAFETY: the functions of a runtime have the types that the specification gives them.
        let (initialize, negotiate) = unsafe {
            (
                self.function::<pfn::InitializeLoaderKHR>(&library, "xrInitializeLoaderKHR"),
                self.function::<pfn::NegotiateLoaderRuntimeInterface>(
                    &library,
                    "xrNegotiateLoaderRuntimeInterface",
                ),
            )
        };
        let negotiate = negotiate.map_err(|symbol| self.no_symbol(symbol, "runtime"))?;
        // A runtime that exports this function wants it called before the negotiation; others want it after.
        let initialize = initialize.ok();
        if let (Some(java), Some(initialize)) = (java, initialize) {
            self.initialize(initialize, java)?;
        }
        let loader = sys::NegotiateLoaderInfo {
            struct_type: sys::NegotiateLoaderInfo::TYPE,
            struct_version: sys::NegotiateLoaderInfo::VERSION,
            struct_size: mem::size_of::<sys::NegotiateLoaderInfo>(),
            min_interface_version: INTERFACE,
            max_interface_version: INTERFACE,
            min_api_version: sys::Version::new(1, 0, 0),
            // The largest version that a loader of OpenXR 1 passes; the runtime compares it with its own newest one.
            max_api_version: sys::Version::new(1, 0x3ff, 0xfff),
        };
        let mut request = sys::NegotiateRuntimeRequest {
            struct_type: sys::NegotiateRuntimeRequest::TYPE,
            struct_version: sys::NegotiateRuntimeRequest::VERSION,
            struct_size: mem::size_of::<sys::NegotiateRuntimeRequest>(),
            runtime_interface_version: 0,
            runtime_api_version: sys::Version::new(0, 0, 0),
            get_instance_proc_addr: None,
        };
        // SAFETY: both structures are complete and outlive the call.
        let result = unsafe { negotiate(&loader, &mut request) };
        if result.into_raw() < 0 {
            return Err(self.fails(format!("refuses loader interface 1 with OpenXR 1 ({result})")));
        }
        let (interface, api) = (request.runtime_interface_version, request.runtime_api_version);
        if interface != INTERFACE || api.major() != 1 {
            return Err(self.fails(format!(
                "negotiates loader interface {interface} and OpenXR {}.{}; needed are interface 1 and OpenXR 1",
                api.major(),
                api.minor()
            )));
        }
        let get = request.get_instance_proc_addr;
        let get =
            get.ok_or_else(|| self.fails("negotiates well and gives no xrGetInstanceProcAddr".into()))?;
        if let (Some(java), None) = (java, initialize) {
            self.initialize_by(get, java)?;
        }
        keep(library);
        Ok((get, api))
    }

    /// Loads a loader. Returns its `xrGetInstanceProcAddr`.
    pub(super) fn open_loader(
        &self,
        java: Option<&JavaContext>,
    ) -> Result<pfn::GetInstanceProcAddr, Failure> {
        let library = self.open()?;
        // SAFETY: a loader exports the function with the type that the specification gives it.
        let get = unsafe { self.function::<pfn::GetInstanceProcAddr>(&library, "xrGetInstanceProcAddr") };
        let get = get.map_err(|symbol| self.no_symbol(symbol, "loader"))?;
        if let Some(java) = java {
            self.initialize_by(get, java)?;
        }
        keep(library);
        Ok(get)
    }

    fn open(&self) -> Result<Library, Failure> {
        // SAFETY: the initialisers of the system's active runtime, or of a loader that the user has chosen, are trusted
        // as those of a driver are.
        unsafe { Library::new(&self.library) }.map_err(|error| {
            // glibc's message begins with the path, which the failure contains already.
            let reason = error.to_string();
            let path = format!("{}: ", self.library.display());
            let reason = reason.strip_prefix(&path).unwrap_or(&reason);
            Failure::Unloadable(format!("{} cannot be loaded ({reason})", self.library.display()))
        })
    }

    fn no_symbol(&self, symbol: String, kind: &'static str) -> Failure {
        self.fails(format!("has no function {symbol}: it is not an OpenXR {kind}"))
    }

    fn fails(&self, what: String) -> Failure {
        Failure::Unusable(format!("{} {what}", self.library.display()))
    }

    /// Returns a function by its name in the specification. The error is the name that was looked up.
    ///
    /// # Safety
    /// `T` must be the type of the function, which must not be called after the library is unloaded.
    unsafe fn function<T: Copy>(&self, library: &Library, name: &str) -> Result<T, String> {
        let symbol = self.functions.get(name).map_or(name, String::as_str);
        // SAFETY: the caller guarantees the type.
        unsafe { library.get::<T>(symbol.as_bytes()) }.map(|found| *found).map_err(|_| symbol.into())
    }

    /// Calls `xrInitializeLoaderKHR` if `get` returns it.
    fn initialize_by(&self, get: pfn::GetInstanceProcAddr, java: &JavaContext) -> Result<(), Failure> {
        let mut function = None;
        // SAFETY: the name is null-terminated, and the null instance is allowed for this function.
        let result = unsafe { get(sys::Instance::NULL, c"xrInitializeLoaderKHR".as_ptr(), &mut function) };
        match function.filter(|_| result == sys::Result::SUCCESS) {
            // SAFETY: the function of this name has this type.
            Some(function) => unsafe {
                self.initialize(mem::transmute::<pfn::VoidFunction, pfn::InitializeLoaderKHR>(function), java)
            },
            None => Ok(()),
        }
    }

    fn initialize(&self, initialize: pfn::InitializeLoaderKHR, java: &JavaContext) -> Result<(), Failure> {
        let info = LoaderInitInfoAndroid {
            ty: sys::StructureType::LOADER_INIT_INFO_ANDROID_KHR,
            next: ptr::null(),
            application_vm: java.vm,
            application_context: java.activity,
        };
        // SAFETY: the structure is the one that Android's runtimes and loaders take, and it outlives the call.
        let result = unsafe { initialize((&raw const info).cast()) };
        if result.into_raw() < 0 {
            return Err(
                self.fails(format!("refuses to be initialised with xrInitializeLoaderKHR ({result})"))
            );
        }
        Ok(())
    }
}

/// Never unloads the library: see [`super::Runtime`].
fn keep(library: Library) {
    mem::forget(library);
}
