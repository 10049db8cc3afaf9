//! Errors of reading, writing and composing pictures.

use std::path::PathBuf;

use yoro_files::FileError;

use crate::MAX_SIZE;

/// Errors of reading, writing and composing pictures.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PictureError {
    /// The file itself could not be read or written.
    #[error(transparent)]
    File(#[from] FileError),
    /// The format of the content is not supported.
    #[error("{} is not a picture that can be read: give a PNG, JPEG, EXR, TGA or BMP file", path.display())]
    UnknownFormat {
        /// The file.
        path: PathBuf,
    },
    /// The content ends early or contradicts itself.
    #[error("{} is damaged ({reason}): write or copy it again", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// The decoder's reason.
        reason: String,
    },
    /// The picture is larger than [`MAX_SIZE`].
    #[error("{} says it is {width}x{height} pixels: up to {MAX_SIZE}x{MAX_SIZE} are read", path.display())]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// Width in pixels.
        width: usize,
        /// Height in pixels.
        height: usize,
    },
    /// A colour image was given where depth is needed.
    #[error("{} is a colour image: depth must be grey (one channel, or red = green = blue)", path.display())]
    NotGrey {
        /// The file.
        path: PathBuf,
    },
    /// An EXR file has no colour.
    #[error("{} is no colour picture (its channels are {found}): give one with the channels R, G and B", path.display())]
    NoColor {
        /// The file.
        path: PathBuf,
        /// The channels it has.
        found: String,
    },
    /// An EXR file has no depth channel.
    #[error("{} has no depth channel (Z, depth, Y or R; it has {found}): name the channel Z", path.display())]
    NoDepthChannel {
        /// The file.
        path: PathBuf,
        /// The channels it has.
        found: String,
    },
    /// An EXR file covers only a part of its picture.
    #[error("{} covers only a part of its picture: save it without cropping (data window = display window)", path.display())]
    Cropped {
        /// The file.
        path: PathBuf,
    },
    /// A depth value is not a number.
    #[error("{} has a depth that is not a number at column {x}, row {y}: render it again", path.display())]
    NotANumber {
        /// The file.
        path: PathBuf,
        /// Column of the first such value.
        x: u32,
        /// Row of the first such value.
        y: u32,
    },
    /// There is no encoder for the extension.
    #[error("cannot write {}: use the extension {allowed}", path.display())]
    Extension {
        /// The file to be written.
        path: PathBuf,
        /// The possible extensions.
        allowed: &'static str,
    },
    /// Two eyes have different sizes.
    #[error("the two images differ in size ({}x{} and {}x{}): give two of one size", a.0, a.1, b.0, b.1)]
    SizesDiffer {
        /// Size of the first in pixels.
        a: (u32, u32),
        /// Size of the second in pixels.
        b: (u32, u32),
    },
}
