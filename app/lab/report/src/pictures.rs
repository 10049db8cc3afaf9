//! Pictures of one view, which the page shows in turn.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use image::RgbImage;
use image::codecs::jpeg::JpegEncoder;
use image::imageops::thumbnail;
use serde::Serialize;

/// Pictures of equal size that show one view. The page switches between them in place, so that differences move.
#[derive(Clone, Debug, Default, Serialize)]
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
#[derive(Clone, Debug, Serialize)]
pub struct Picture {
    /// What its button says.
    pub label: String,
    /// A sentence about it.
    pub caption: String,
    /// The picture, with row 0 at the top.
    #[serde(skip)]
    pub image: RgbImage,
    /// True for a picture without fine detail, such as an error map, for which half the size is enough.
    pub is_map: bool,
}

/// Which picture is that of the other eye.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct OtherEye {
    /// Its place among the pictures.
    pub picture: usize,
    /// True if that eye is the left one.
    pub is_left: bool,
}

/// The qualities of JPEG, up to 100, and how often width and height are halved, in the order in which they are tried until
/// a page's pictures fit.
pub(crate) const ENCODINGS: [(u8, u32); 5] = [(90, 0), (80, 0), (66, 0), (80, 1), (66, 2)];

impl Picture {
    /// Returns the picture as the text of a `data:` address.
    pub(crate) fn data_uri(&self, quality: u8, halvings: u32) -> image::ImageResult<String> {
        let halvings = halvings.max(u32::from(self.is_map));
        let [width, height] = [self.image.width(), self.image.height()].map(|n| (n >> halvings).max(1));
        let mut jpeg = Vec::new();
        let encoder = JpegEncoder::new_with_quality(&mut jpeg, quality);
        match halvings {
            0 => self.image.write_with_encoder(encoder)?,
            _ => thumbnail(&self.image, width, height).write_with_encoder(encoder)?,
        }
        Ok(format!("data:image/jpeg;base64,{}", STANDARD.encode(jpeg)))
    }
}
