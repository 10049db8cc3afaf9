//! Structures that grow with versions: each begins with its size, as the program knows it.

use std::mem::MaybeUninit;
use std::ptr;

use crate::result::{Failure, YORO_ERROR_NULL, YORO_ERROR_STRUCT_SIZE};

/// Larger than any structure of any version: such a size was never set.
const LARGEST: usize = 1 << 16;

/// A structure of the interface that begins with `struct_size`.
///
/// # Safety
/// `repr(C)`, its first field is the `u32` `struct_size`, and it is made of numbers and nullable pointers: all bits
/// zero are a value.
pub(crate) unsafe trait Versioned: Copy {
    /// Its name, for sentences.
    const NAME: &'static str;
    /// Its size in the first version that has it.
    const FIRST_SIZE: usize;
}

/// Implements [`Versioned`] for a structure. `since` is the first field that its first version did not have; without it
/// the structure has not grown yet.
macro_rules! versioned {
    ($name:ident) => {
        versioned!($name, size_of::<$name>());
    };
    ($name:ident since $field:ident) => {
        versioned!($name, std::mem::offset_of!($name, $field));
    };
    ($name:ident, $first_size:expr) => {
        // SAFETY: numbers and nullable pointers behind a u32.
        unsafe impl crate::versioned::Versioned for $name {
            const NAME: &'static str = stringify!($name);
            const FIRST_SIZE: usize = $first_size;
        }
    };
}
pub(crate) use versioned;

/// Checks fields that are zero until a later version gives them a meaning.
pub(crate) fn check_reserved(what: &str, fields: &[u32]) -> Result<(), Failure> {
    match fields.iter().find(|field| **field != 0) {
        None => Ok(()),
        Some(field) => Err(Failure::value(format!("reserved of {what} is {field}: give 0"))),
    }
}

/// Returns the size that the caller states, checked.
///
/// # Safety
/// `pointer` is null or leads to a structure, or to fewer bytes than that but at least four.
unsafe fn stated_size<T: Versioned>(pointer: *const T, what: &'static str) -> Result<usize, Failure> {
    if pointer.is_null() {
        return Err(Failure::new(YORO_ERROR_NULL, format!("{what} is NULL: give a {}", T::NAME)));
    }
    // SAFETY: the pointer leads to at least four bytes; alignment is not needed.
    let size = unsafe { pointer.cast::<u32>().read_unaligned() } as usize;
    if !(T::FIRST_SIZE..=LARGEST).contains(&size) {
        return Err(Failure::new(
            YORO_ERROR_STRUCT_SIZE,
            format!("struct_size of {what} is {size}: set it to sizeof({})", T::NAME),
        ));
    }
    Ok(size)
}

/// Copies a structure that the caller filled. Fields that an older program does not know are zero. Refuses fields that
/// a newer program sets and this library does not know.
///
/// # Safety
/// As [`stated_size`], and as many bytes as the structure states can be read.
pub(crate) unsafe fn read<T: Versioned>(pointer: *const T, what: &'static str) -> Result<T, Failure> {
    // SAFETY: the contract includes that of `stated_size`.
    let size = unsafe { stated_size(pointer, what) }?;
    let known = size_of::<T>();
    let bytes = pointer.cast::<u8>();
    // SAFETY: the bytes of the structure, as many as it states.
    if (known..size).any(|i| unsafe { bytes.add(i).read() } != 0) {
        return Err(Failure::new(
            YORO_ERROR_STRUCT_SIZE,
            format!("{what} sets fields that this version of the library does not know: use a newer library"),
        ));
    }
    let mut value = MaybeUninit::<T>::zeroed();
    // SAFETY: at most the size of both; all zeros and what the caller sets are values of the structure.
    unsafe {
        ptr::copy_nonoverlapping(bytes, value.as_mut_ptr().cast(), size.min(known));
        Ok(value.assume_init())
    }
}

/// Checks that [`write`] will be able to write here.
///
/// # Safety
/// As [`stated_size`].
pub(crate) unsafe fn check_output<T: Versioned>(
    pointer: *const T,
    what: &'static str,
) -> Result<(), Failure> {
    // SAFETY: the contract is that of `stated_size`.
    unsafe { stated_size(pointer, what) }?;
    Ok(())
}

/// Fills a structure of the caller up to the size that the caller knows; `struct_size` stays.
///
/// # Safety
/// As [`read`], and the bytes can be written.
pub(crate) unsafe fn write<T: Versioned>(
    pointer: *mut T,
    what: &'static str,
    value: &T,
) -> Result<(), Failure> {
    // SAFETY: the contract includes that of `stated_size`.
    let size = unsafe { stated_size(pointer, what) }?;
    let first = size_of::<u32>();
    // SAFETY: behind struct_size, at most the size of both; zeros beyond what this library knows.
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

    // SAFETY: numbers behind a u32.
    unsafe impl Versioned for Grown {
        const NAME: &'static str = "Grown";
        const FIRST_SIZE: usize = 8;
    }

    fn read_words(words: &[u32]) -> Result<Grown, i32> {
        // SAFETY: the words hold what they state, or state what is refused.
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
            // SAFETY: the words hold what they state.
            unsafe { write::<Grown>(words.as_mut_ptr().cast(), "it", &value) }.unwrap();
            assert_eq!(words, expected);
        }
    }
}
