//! Pictures of one view, which the page shows in turn.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use image::RgbImage;
use image::codecs::jpeg::JpegEncoder;
use image::imageops::thumbnail;

/// Pictures of equal size that show one view. The page switches between them in place, so that differences move.
#[derive(Clone, Debug, Default)]
pub struct Pictures {
    /// The heading.
    pub title: String,
    /// A note beside the heading.
    pub note: String,
    /// The pictures in the order of their keys.
    pub pictures: Vec<Picture>,
    /// A picture of the other eye, which is shown beside them for stereo.
    pub other_eye: Option<OtherEye>,
}

/// One of the [`Pictures`].
#[derive(Clone, Debug)]
pub struct Picture {
    /// What its button says.
    pub label: String,
    /// A sentence about it.
    pub caption: String,
    /// The picture, with row 0 at the top.
    pub image: RgbImage,
    /// True for a picture without fine detail, such as an error map, for which half the size is enough.
    pub is_map: bool,
}

/// Which picture is that of the other eye.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OtherEye {
    /// Its place among the pictures.
    pub picture: usize,
    /// True if that eye is the left one.
    pub is_left: bool,
}

/// How pictures are encoded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Encoding {
    /// JPEG quality, up to 100.
    pub quality: u8,
    /// How often width and height are halved.
    pub halvings: u32,
}

/// Encodings in the order in which they are tried until a page's pictures fit.
pub(crate) const ENCODINGS: [Encoding; 5] = [
    Encoding { quality: 90, halvings: 0 },
    Encoding { quality: 80, halvings: 0 },
    Encoding { quality: 66, halvings: 0 },
    Encoding { quality: 80, halvings: 1 },
    Encoding { quality: 66, halvings: 2 },
];

impl Encoding {
    /// Returns a sentence for readers.
    pub fn note(self) -> String {
        let size = match self.halvings {
            0 => String::new(),
            n => format!(", shrunk to 1/{} of their size", 1 << n),
        };
        format!(
            "Pictures on this page are JPEG, quality {}{size}; error maps are shrunk to half. All figures were measured on the \
             images as rendered.",
            self.quality
        )
    }
}

impl Picture {
    /// Returns the picture as the text of a `data:` address.
    pub(crate) fn data_uri(&self, encoding: Encoding) -> image::ImageResult<String> {
        let halvings = encoding.halvings.max(u32::from(self.is_map));
        let [width, height] = [self.image.width(), self.image.height()].map(|n| (n >> halvings).max(1));
        let mut jpeg = Vec::new();
        let encoder = JpegEncoder::new_with_quality(&mut jpeg, encoding.quality);
        match halvings {
            0 => self.image.write_with_encoder(encoder)?,
            _ => thumbnail(&self.image, width, height).write_with_encoder(encoder)?,
        }
        Ok(format!("data:image/jpeg;base64,{}", STANDARD.encode(jpeg)))
    }
}
