//! Mistakes of callers that any graphics interface would refuse.

/// An argument of a pipeline that does not fit its images or the pipeline.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ArgumentError {
    /// A size is zero, or beyond what the pipeline or the device was made for.
    #[error(
        "{what} of {}x{} pixels is not between 1x1 and {}x{}; give a size in that range, or a device or pipelines with larger limits",
        size[0], size[1], limit[0], limit[1]
    )]
    Size {
        /// The image that has the size.
        what: &'static str,
        /// Width and height.
        size: [u32; 2],
        /// The largest width and height.
        limit: [u32; 2],
    },
    /// Motion vectors lack their third component.
    #[error(
        "motion vectors of two components do not tell how a surface that comes nearer moves in the other eye (a hand at arm's length: by 8 pixels of 1024); give three, such as RGBA in half floats"
    )]
    TwoComponents,
    /// A rectangle reaches beyond its image.
    #[error(
        "{what} of {}x{} pixels at ({}, {}) reaches beyond its image of {}x{} pixels",
        size[0], size[1], origin[0], origin[1], image[0], image[1]
    )]
    Rectangle {
        /// The rectangle.
        what: &'static str,
        /// Corner on the side of row 0.
        origin: [u32; 2],
        /// Width and height.
        size: [u32; 2],
        /// Width and height of the image.
        image: [u32; 2],
    },
}

/// Checks a width and height in pixels.
///
/// # Errors
/// [`ArgumentError::Size`] if one of them is 0 or beyond the limit.
pub fn check_size(what: &'static str, size: [u32; 2], limit: [u32; 2]) -> Result<(), ArgumentError> {
    if (0..2).all(|i| (1..=limit[i]).contains(&size[i])) {
        Ok(())
    } else {
        Err(ArgumentError::Size { what, size, limit })
    }
}

/// Checks that a rectangle lies within its image.
///
/// # Errors
/// [`ArgumentError::Rectangle`].
pub fn check_rectangle(
    what: &'static str,
    origin: [u32; 2],
    size: [u32; 2],
    image: [u32; 2],
) -> Result<(), ArgumentError> {
    let fits = |i: usize| origin[i].checked_add(size[i]).is_some_and(|end| end <= image[i]);
    if fits(0) && fits(1) { Ok(()) } else { Err(ArgumentError::Rectangle { what, origin, size, image }) }
}
