//! The OpenXR loader of an application that contains an API layer: what it uses of Khronos's loader.
//!
//! The layer's library and manifest come from its AAR, and are placed in the application's package as Gradle would. The
//! library is loaded like the application's own. The loader finds the manifest among the assets, negotiates with the
//! layer whenever an instance is created, and ends the chain with the simulated runtime.

use std::collections::BTreeMap;
use std::ffi::{CStr, c_char, c_void};
use std::sync::OnceLock;

use anyhow::{Context, Result, ensure};
use openxr_sys as sys;
use serde::Deserialize;
use sys::{Handle as _, pfn};

use crate::library::Library;
use crate::openxr;

/// The file name of an application's loader.
const FILE: &str = "libopenxr_loader.so";
/// The handle that `dlopen` returns for the loader.
const HANDLE: usize = 0x10ad;
/// The folder of implicit layers' manifests in an application's assets.
const MANIFESTS: &str = "openxr/1/api_layers/implicit.d/";

#[derive(Deserialize)]
struct Manifest {
    api_layer: ApiLayer,
}

/// A layer as described by its manifest.
#[derive(Deserialize)]
struct ApiLayer {
    name: String,
    library_path: String,
    #[serde(default)]
    instance_extensions: Vec<Extension>,
}

#[derive(Deserialize)]
struct Extension {
    name: String,
    extension_version: String,
}

/// The layer and its functions.
struct Layer {
    manifest: ApiLayer,
    negotiate: pfn::NegotiateLoaderApiLayerInterface,
    /// The function of the instance that was created last. It is the same for all instances.
    get_instance_proc_addr: OnceLock<pfn::GetInstanceProcAddr>,
}

static LAYER: OnceLock<Layer> = OnceLock::new();

/// Registers the layer in these assets with the loader. Its library must have been loaded.
///
/// # Errors
/// Fails if there is no manifest of an implicit layer, or it belongs to another library.
pub fn install(assets: &BTreeMap<String, Vec<u8>>, library: &Library) -> Result<()> {
    let manifest = assets.iter().find(|(path, _)| path.starts_with(MANIFESTS));
    let (path, bytes) = manifest.with_context(|| format!("there is no manifest in assets/{MANIFESTS}"))?;
    let manifest: Manifest =
        serde_json::from_slice(bytes).with_context(|| format!("assets/{path} is no layer's manifest"))?;
    let manifest = manifest.api_layer;
    ensure!(
        library.path.to_string_lossy().ends_with(&format!("/{}", manifest.library_path)),
        "assets/{path} names {}, and the library is {:?}",
        manifest.library_path,
        library.path
    );
    const NEGOTIATE: &str = "xrNegotiateLoaderApiLayerInterface";
    let negotiate = library
        .symbol(NEGOTIATE)
        .with_context(|| format!("{:?} does not export {NEGOTIATE}", library.path))?;
    // SAFETY: a layer's function with this name has this type.
    let negotiate = unsafe { std::mem::transmute::<usize, pfn::NegotiateLoaderApiLayerInterface>(negotiate) };
    LAYER.get_or_init(|| Layer { manifest, negotiate, get_instance_proc_addr: OnceLock::new() });
    Ok(())
}

/// Returns the handle of the loader, or `None` for any other name or if the application contains no layer.
pub fn open(name: &str) -> Option<*mut c_void> {
    (name == FILE && LAYER.get().is_some()).then_some(HANDLE as *mut c_void)
}

/// Returns a symbol of the loader, null if the loader does not have it, or `None` if the handle is another library's.
pub fn symbol(handle: *mut c_void, name: &CStr) -> Option<*mut c_void> {
    let get: pfn::GetInstanceProcAddr = get_instance_proc_addr;
    let has = name == c"xrGetInstanceProcAddr";
    (handle as usize == HANDLE).then_some(if has { get as *mut c_void } else { std::ptr::null_mut() })
}

/// Returns the layer. The loader can only be opened if there is one.
fn layer() -> &'static Layer {
    LAYER.get().expect("the loader is opened where there is a layer")
}

/// Returns a function of the runtime that needs no instance.
///
/// # Safety
/// The function must be of type `T`.
unsafe fn of_runtime<T: Copy>(name: &CStr) -> Result<T, sys::Result> {
    let mut function = None;
    // SAFETY: the name is terminated, and there is room for a function.
    let result = unsafe { runtime()?(sys::Instance::NULL, name.as_ptr(), &mut function) };
    match (result, function) {
        (sys::Result::SUCCESS, Some(function)) => {
            // SAFETY: both are function pointers, and the caller gives the type that the function has in OpenXR.
            Ok(unsafe { std::mem::transmute_copy::<pfn::VoidFunction, T>(&function) })
        }
        (sys::Result::SUCCESS, None) => Err(sys::Result::ERROR_FUNCTION_UNSUPPORTED),
        (failed, _) => Err(failed),
    }
}

fn loader_info() -> sys::NegotiateLoaderInfo {
    sys::NegotiateLoaderInfo {
        struct_type: sys::NegotiateLoaderInfo::TYPE,
        struct_version: sys::NegotiateLoaderInfo::VERSION,
        struct_size: size_of::<sys::NegotiateLoaderInfo>(),
        min_interface_version: 1,
        max_interface_version: 1,
        min_api_version: sys::Version::new(1, 0, 0),
        max_api_version: sys::Version::new(1, 0x3ff, 0xfff),
    }
}

/// Returns the runtime's function that returns all others. The runtime is known; Khronos's loader asks the broker.
fn runtime() -> Result<pfn::GetInstanceProcAddr, sys::Result> {
    let mut request = sys::NegotiateRuntimeRequest {
        struct_type: sys::NegotiateRuntimeRequest::TYPE,
        struct_version: sys::NegotiateRuntimeRequest::VERSION,
        struct_size: size_of::<sys::NegotiateRuntimeRequest>(),
        runtime_interface_version: 0,
        runtime_api_version: sys::Version::new(0, 0, 0),
        get_instance_proc_addr: None,
    };
    let library = openxr::library().ok_or(sys::Result::ERROR_RUNTIME_UNAVAILABLE)?;
    let negotiate = openxr::symbol(library, c"xrNegotiateLoaderRuntimeInterface");
    // SAFETY: a runtime's function with this name has this type, and null becomes `None`.
    let negotiate = unsafe {
        std::mem::transmute::<*mut c_void, Option<pfn::NegotiateLoaderRuntimeInterface>>(
            negotiate.unwrap_or(std::ptr::null_mut()),
        )
    };
    let negotiate = negotiate.ok_or(sys::Result::ERROR_RUNTIME_UNAVAILABLE)?;
    // SAFETY: the structures are complete.
    match unsafe { negotiate(&loader_info(), &mut request) } {
        sys::Result::SUCCESS => request.get_instance_proc_addr.ok_or(sys::Result::ERROR_RUNTIME_UNAVAILABLE),
        refused => Err(refused),
    }
}

unsafe extern "system" fn get_instance_proc_addr(
    instance: sys::Instance,
    name: *const c_char,
    function: *mut Option<pfn::VoidFunction>,
) -> sys::Result {
    // SAFETY: the application passes a terminated name.
    let wanted = unsafe { CStr::from_ptr(name) };
    // If there is an instance, its topmost layer answers.
    let next = if instance == sys::Instance::NULL { None } else { layer().get_instance_proc_addr.get() };
    if let Some(next) = next {
        // SAFETY: the application's call is passed on.
        return unsafe { next(instance, name, function) };
    }
    macro_rules! own {
        ($($name:literal => $function:ident: $kind:ident,)*) => {
            match wanted.to_bytes() {
                $($name => {
                    let own: pfn::$kind = $function;
                    // SAFETY: whoever asks for this name calls the function with this type.
                    Ok(unsafe { std::mem::transmute::<pfn::$kind, pfn::VoidFunction>(own) })
                })*
                // The runtime's own function, since the loader does not use Java. SAFETY: the function is returned
                // unchanged under the requested name.
                b"xrInitializeLoaderKHR" => unsafe { of_runtime(wanted) },
                _ => Err(sys::Result::ERROR_HANDLE_INVALID),
            }
        };
    }
    let own = own! {
        b"xrGetInstanceProcAddr" => get_instance_proc_addr: GetInstanceProcAddr,
        b"xrCreateInstance" => create_instance: CreateInstance,
        b"xrEnumerateApiLayerProperties" => enumerate_api_layer_properties: EnumerateApiLayerProperties,
        b"xrEnumerateInstanceExtensionProperties" => enumerate_instance_extension_properties: EnumerateInstanceExtensionProperties,
    };
    let (result, found) = match own {
        Ok(found) => (sys::Result::SUCCESS, Some(found)),
        Err(result) => (result, None),
    };
    // SAFETY: the caller provides room for a function.
    unsafe { function.write(found) };
    result
}

/// Returns a text as an array of characters. Truncates it if it is too long.
fn characters<const N: usize>(text: &str) -> [c_char; N] {
    let mut characters = [0; N];
    for (to, from) in characters[..N - 1].iter_mut().zip(text.bytes()) {
        *to = from as c_char;
    }
    characters
}

/// Answers the two calls by which OpenXR's callers query an array: first its length, then its elements.
///
/// # Safety
/// `count` must have room for a number, and `place` for `capacity` elements.
unsafe fn answer<T: Copy>(all: &[T], capacity: u32, count: *mut u32, place: *mut T) -> sys::Result {
    // SAFETY: OpenXR's callers provide room for the count, and for as many elements as they say.
    unsafe {
        count.write(all.len() as u32);
        if capacity != 0 && (capacity as usize) < all.len() {
            return sys::Result::ERROR_SIZE_INSUFFICIENT;
        }
        if capacity != 0 {
            std::ptr::copy_nonoverlapping(all.as_ptr(), place, all.len());
        }
    }
    sys::Result::SUCCESS
}

/// The application looks this function up, and never calls it.
unsafe extern "system" fn enumerate_api_layer_properties(
    _: u32,
    _: *mut u32,
    _: *mut sys::ApiLayerProperties,
) -> sys::Result {
    sys::Result::ERROR_FUNCTION_UNSUPPORTED
}

/// Lists the runtime's extensions and those that the layer adds. The application never asks for a single layer's.
unsafe extern "system" fn enumerate_instance_extension_properties(
    of_layer: *const c_char,
    capacity: u32,
    count: *mut u32,
    properties: *mut sys::ExtensionProperties,
) -> sys::Result {
    if !of_layer.is_null() {
        return sys::Result::ERROR_API_LAYER_NOT_PRESENT;
    }
    let property = |name: &str, version: u32| sys::ExtensionProperties {
        ty: sys::ExtensionProperties::TYPE,
        next: std::ptr::null_mut(),
        extension_name: characters(name),
        extension_version: version,
    };
    let mut all = Vec::new();
    // SAFETY: a function with this name has this type, and there is room for as many elements as stated.
    let listed = unsafe {
        of_runtime::<pfn::EnumerateInstanceExtensionProperties>(c"xrEnumerateInstanceExtensionProperties")
            .and_then(|list| {
                let mut length = 0;
                match list(std::ptr::null(), 0, &mut length, std::ptr::null_mut()) {
                    sys::Result::SUCCESS => all.resize(length as usize, property("", 0)),
                    failed => return Err(failed),
                }
                match list(std::ptr::null(), length, &mut length, all.as_mut_ptr()) {
                    sys::Result::SUCCESS => Ok(()),
                    failed => Err(failed),
                }
            })
    };
    if let Err(failed) = listed {
        return failed;
    }
    for extension in &layer().manifest.instance_extensions {
        let more = property(&extension.name, extension.extension_version.parse().unwrap_or(0));
        if !all.iter().any(|known| known.extension_name == more.extension_name) {
            all.push(more);
        }
    }
    // SAFETY: the application's call is passed on.
    unsafe { answer(&all, capacity, count, properties) }
}

unsafe extern "system" fn create_instance(
    info: *const sys::InstanceCreateInfo,
    instance: *mut sys::Instance,
) -> sys::Result {
    let layer = layer();
    let mut request = sys::NegotiateApiLayerRequest {
        struct_type: sys::NegotiateApiLayerRequest::TYPE,
        struct_version: sys::NegotiateApiLayerRequest::VERSION,
        struct_size: size_of::<sys::NegotiateApiLayerRequest>(),
        layer_interface_version: 0,
        layer_api_version: sys::Version::new(0, 0, 0),
        get_instance_proc_addr: None,
        create_api_layer_instance: None,
    };
    let name: [c_char; sys::MAX_API_LAYER_NAME_SIZE] = characters(&layer.manifest.name);
    // SAFETY: the structures are complete, and the name is terminated.
    let agreed = unsafe { (layer.negotiate)(&loader_info(), name.as_ptr(), &mut request) };
    let functions = request.get_instance_proc_addr.zip(request.create_api_layer_instance);
    let (sys::Result::SUCCESS, Some((get, create)), Ok(runtime)) = (agreed, functions, runtime()) else {
        return sys::Result::ERROR_INITIALIZATION_FAILED;
    };
    layer.get_instance_proc_addr.get_or_init(|| get);
    let mut next = sys::ApiLayerNextInfo {
        struct_type: sys::ApiLayerNextInfo::TYPE,
        struct_version: sys::ApiLayerNextInfo::VERSION,
        struct_size: size_of::<sys::ApiLayerNextInfo>(),
        layer_name: name,
        next_get_instance_proc_addr: Some(runtime),
        next_create_api_layer_instance: Some(create_runtime_instance),
        next: std::ptr::null_mut(),
    };
    let chain = sys::ApiLayerCreateInfo {
        struct_type: sys::ApiLayerCreateInfo::TYPE,
        struct_version: sys::ApiLayerCreateInfo::VERSION,
        struct_size: size_of::<sys::ApiLayerCreateInfo>(),
        loader_instance: std::ptr::null_mut(),
        settings_file_location: [0; sys::API_LAYER_MAX_SETTINGS_PATH_SIZE],
        next_info: &mut next,
    };
    // SAFETY: the application's call is passed on, with complete structures.
    unsafe { create(info, &chain, instance) }
}

/// Creates the runtime's instance, at the end of the chain.
unsafe extern "system" fn create_runtime_instance(
    info: *const sys::InstanceCreateInfo,
    _: *const sys::ApiLayerCreateInfo,
    instance: *mut sys::Instance,
) -> sys::Result {
    // SAFETY: a function with this name has this type. The layer's call is passed on.
    unsafe {
        match of_runtime::<pfn::CreateInstance>(c"xrCreateInstance") {
            Ok(create) => create(info, instance),
            Err(failed) => failed,
        }
    }
}
