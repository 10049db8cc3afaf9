//! Chains of structures.

use std::ffi::c_void;

use openxr_sys as sys;

/// Returns the structure of a type in a chain, if it contains one.
///
/// # Safety
/// The chain was passed to a call by the application, and `T` is the structure of the type `ty`.
pub unsafe fn find<'a, T>(chain: *const c_void, ty: sys::StructureType) -> Option<&'a T> {
    // SAFETY: same contract.
    unsafe { find_mut(chain.cast_mut(), ty) }.map(|found| &*found)
}

/// Returns the structure of a type in a chain of outputs, if it contains one.
///
/// # Safety
/// The contract of [`find`]; for writing, the chain is one that the call fills in.
pub unsafe fn find_mut<'a, T>(chain: *mut c_void, ty: sys::StructureType) -> Option<&'a mut T> {
    let mut structure = chain.cast::<sys::BaseOutStructure>();
    // SAFETY: every structure of a chain begins with this header, and its type tells what it is.
    unsafe {
        while !structure.is_null() && (*structure).ty != ty {
            structure = (*structure).next;
        }
        structure.cast::<T>().as_mut()
    }
}
