//! Chains of structures.

use std::ffi::c_void;

use openxr_sys as sys;

/// Returns the structure of a type in a chain, if it contains one.
///
/// # Safety
/// The chain was passed to a call by the application, and `T` is the structure of the type `ty`.
pub unsafe fn find<'a, T>(chain: *const c_void, ty: sys::StructureType) -> Option<&'a T> {
    // SAFETY: same contract.
    unsafe { find_output::<T>(chain.cast_mut(), ty)?.as_ref() }
}

/// Returns the place of the structure of a type in a chain that the runtime fills in, if it contains one.
///
/// # Safety
/// Those of [`find`].
pub unsafe fn find_output<T>(chain: *mut c_void, ty: sys::StructureType) -> Option<*mut T> {
    let mut structure = chain.cast::<sys::BaseOutStructure>();
    // SAFETY: every structure of a chain begins with this header, and its type tells what it is.
    unsafe {
        while let Some(header) = structure.as_ref() {
            if header.ty == ty {
                return Some(structure.cast());
            }
            structure = header.next;
        }
    }
    None
}
