//! Chains of structures.

use std::ffi::c_void;

use openxr_sys as sys;

/// Returns the structure of a type in a chain, if it contains one.
///
/// # Safety
/// The chain was passed to a call by the application, and `T` is the structure of the type `ty`.
pub unsafe fn find<'a, T>(chain: *const c_void, ty: sys::StructureType) -> Option<&'a T> {
    let mut structure = chain.cast::<sys::BaseInStructure>();
    // SAFETY: every structure of a chain begins with this header, and its type tells what it is.
    unsafe {
        while let Some(header) = structure.as_ref() {
            if header.ty == ty {
                return structure.cast::<T>().as_ref();
            }
            structure = header.next;
        }
    }
    None
}
