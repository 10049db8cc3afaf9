//! Structures that grow from version to version. Each begins with its size, as the calling program knows it.

use std::mem::MaybeUninit;
use std::ptr;

use crate::result::{Failure, YORO_ERROR_NULL, YORO_ERROR_STRUCT_SIZE};

/// Larger than any structure of any version. A larger struct_size was never initialized.
const LARGEST: usize = 1 << 16;

/// A structure of the interface that begins with `struct_size`.
///
/// # Safety
/// The type is `repr(C)`, its first field is `struct_size: u32`, and it consists of numbers and nullable pointers, so
/// that all bits zero are a valid value.
pub(crate) unsafe trait Versioned: Copy {
    /// The name of the structure, for error messages.
    const NAME: &'static str;
    /// The size in the first version that has the structure.
    const FIRST_SIZE: usize;
}

/// Implements [`Versioned`] for a structure that has not grown yet.
macro_rules! versioned {
    ($name:ident) => {
        // SAFETY: a u32, followed by numbers and nullable pointers.
        unsafe impl crate::versioned::Versioned for $name {
            const NAME: &'static str = stringify!($name);
            const FIRST_SIZE: usize = size_of::<$name>();
        }
    };
}
pub(crate) use versioned;

/// A structure without a size, which the library fills in and a program gives back.
pub(crate) trait Given: Copy {
    /// What it is in the core.
    type Core: 'static;
    /// What is wrong with NULL, and where to get the structure.
    const MISSING: &'static str;

    /// Returns the core's value, with rows ordered as here. Checks the numbers, since programs may have made them up.
    fn checked(&self) -> Result<Self::Core, Failure>;
}

/// Reads and checks a structure that the program gives back.
///
/// # Safety
/// `pointer` is null or points to such a structure.
pub(crate) unsafe fn given<T: Given>(pointer: *const T) -> Result<T::Core, Failure> {
    if pointer.is_null() {
        return Err(Failure::new(YORO_ERROR_NULL, T::MISSING));
    }
    // SAFETY: the pointer is not null, so it points to a structure; the read needs no alignment.
    unsafe { pointer.read_unaligned() }.checked()
}

/// Checks fields that must be zero until a later version gives them a meaning.
pub(crate) fn check_reserved(what: &str, fields: &[u32]) -> Result<(), Failure> {
    match fields.iter().find(|field| **field != 0) {
        None => Ok(()),
        Some(field) => Err(Failure::value(format!("reserved of {what} is {field}: give 0"))),
    }
}

/// Checks and returns the size that the caller states.
///
/// # Safety
/// `pointer` is null, or at least four bytes can be read from it.
unsafe fn stated_size<T: Versioned>(pointer: *const T, what: &'static str) -> Result<usize, Failure> {
    if pointer.is_null() {
        return Err(Failure::new(YORO_ERROR_NULL, format!("{what} is NULL: give a {}", T::NAME)));
    }
    // SAFETY: at least four bytes are readable; the read needs no alignment.
    let size = unsafe { pointer.cast::<u32>().read_unaligned() } as usize;
    if !(T::FIRST_SIZE..=LARGEST).contains(&size) {
        return Err(Failure::new(
            YORO_ERROR_STRUCT_SIZE,
            format!("struct_size of {what} is {size}: set it to sizeof({})", T::NAME),
        ));
    }
    Ok(size)
}

/// Copies a structure that the caller filled in. Fields that an older program does not know are zero. Fails if a newer
/// program sets fields that this library does not know.
///
/// # Safety
/// As for [`stated_size`], and as many bytes as the structure states are readable.
pub(crate) unsafe fn read<T: Versioned>(pointer: *const T, what: &'static str) -> Result<T, Failure> {
    // SAFETY: the contract includes that of `stated_size`.
    let size = unsafe { stated_size(pointer, what) }?;
    let known = size_of::<T>();
    let bytes = pointer.cast::<u8>();
    // SAFETY: the structure has as many bytes as it states.
    if (known..size).any(|i| unsafe { bytes.add(i).read() } != 0) {
        return Err(Failure::new(
            YORO_ERROR_STRUCT_SIZE,
            format!("{what} sets fields that this version of the library does not know: use a newer library"),
        ));
    }
    let mut value = MaybeUninit::<T>::zeroed();
    // SAFETY: copies at most the size of both; all zeros and the caller's bytes are values of the structure.
    unsafe {
        ptr::copy_nonoverlapping(bytes, value.as_mut_ptr().cast(), size.min(known));
        Ok(value.assume_init())
    }
}

/// Checks that [`write`] can write here.
///
/// # Safety
/// As for [`stated_size`].
pub(crate) unsafe fn check_output<T: Versioned>(
    pointer: *const T,
    what: &'static str,
) -> Result<(), Failure> {
    // SAFETY: same contract as `stated_size`.
    unsafe { stated_size(pointer, what) }?;
    Ok(())
}

/// Fills in a structure of the caller, up to the size that the caller knows. Leaves `struct_size` unchanged.
///
/// # Safety
/// As for [`read`], and the bytes are writable.
pub(crate) unsafe fn write<T: Versioned>(
    pointer: *mut T,
    what: &'static str,
    value: &T,
) -> Result<(), Failure> {
    // SAFETY: the contract includes that of `stated_size`.
    let size = unsafe { stated_size(pointer, what) }?;
    let first = size_of::<u32>();
    // SAFETY: writes after struct_size, at most the size of both structures, and zeros beyond what this library knows.
    unsafe {
        let (from, to) = (ptr::from_ref(value).cast::<u8>(), pointer.cast::<u8>());
        ptr::copy_nonoverlapping(from.add(first), to.add(first), size.min(size_of::<T>()) - first);
        ptr::write_bytes(to.add(size_of::<T>().min(size)), 0, size.saturating_sub(size_of::<T>()));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq)]
    struct Grown {
        struct_size: u32,
        old: u32,
        new: u32,
    }

    // SAFETY: a u32, followed by numbers.
    unsafe impl Versioned for Grown {
        const NAME: &'static str = "Grown";
        const FIRST_SIZE: usize = 8;
    }

    fn read_words(words: &[u32]) -> Result<Grown, i32> {
        // SAFETY: the words are as many as they state, or state a size that is refused.
        unsafe { read::<Grown>(words.as_ptr().cast(), "it") }.map_err(|failure| failure.code)
    }

    #[test]
    fn an_older_program_leaves_new_fields_zero() {
        assert_eq!(read_words(&[8, 5, 9]), Ok(Grown { struct_size: 8, old: 5, new: 0 }));
        assert_eq!(read_words(&[12, 5, 9]), Ok(Grown { struct_size: 12, old: 5, new: 9 }));
    }

    #[test]
    fn a_newer_program_may_leave_its_fields_zero() {
        assert_eq!(read_words(&[16, 5, 9, 0]), Ok(Grown { struct_size: 16, old: 5, new: 9 }));
        assert_eq!(read_words(&[16, 5, 9, 1]), Err(YORO_ERROR_STRUCT_SIZE));
    }

    #[test]
    fn impossible_sizes_are_refused() {
        for size in [0, 4, 7, u32::MAX] {
            assert_eq!(read_words(&[size, 0, 0]), Err(YORO_ERROR_STRUCT_SIZE), "{size}");
        }
    }

    #[test]
    fn no_more_is_written_than_the_program_knows() {
        let value = Grown { struct_size: 0, old: 1, new: 2 };
        for (stated, expected) in [(8, [8, 1, 7, 7]), (12, [12, 1, 2, 7]), (16, [16, 1, 2, 0])] {
            let mut words = [stated, 7, 7, 7];
            // SAFETY: the words are as many as they state.
            unsafe { write::<Grown>(words.as_mut_ptr().cast(), "it", &value) }.unwrap();
            assert_eq!(words, expected);
        }
    }
}
