//! RGBD videos of the iPhone application Record3D: depth as hue on the left, colour on the right.
//!
//! The format is taken from open players, such as Record3D's own for browsers. The hue of a pixel is its distance, from
//! red at the nearest through green and blue to red at the farthest. A JSON object in the file's metadata describes the
//! camera.

use std::io::{self, Read, Seek, SeekFrom};

use image::{GrayImage, Luma, RgbImage};
use serde::Deserialize;
use yoro::eyes::{Eye, MEAN_IPD};

use super::{Planes, Rgbd};

/// The beginning of the JSON object.
const BEGIN: &[u8] = br#"{"intrinsic"#;
/// The most metadata to search, in bytes.
const METADATA_LIMIT: u64 = 64 << 20;
/// The default distances in metres of the hues 0 and 1.
const DEFAULT_RANGE: [f32; 2] = [0.0, 3.0];
/// The nearest distance that phones measure, in metres. Pixels without a measurement are red.
const NEAREST: f32 = 0.1;

/// The camera of a video.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(rename_all = "camelCase")]
struct Camera {
    /// Focal lengths and principal point in pixels: a matrix in column-major order.
    intrinsic_matrix: [f32; 9],
    /// Distances of the hues 0 and 1 in metres.
    range_of_encoded_depth: Option<[f32; 2]>,
}

/// A recording's views, and the distances of its hues.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Recording {
    pub(crate) rgbd: Rgbd,
    /// Distances of the hues 0 and 1 in metres.
    range: [f32; 2],
}

/// Describes pictures of this size in pixels, or says why that fails. `None` if the file has no such metadata.
///
/// # Errors
/// The file cannot be read.
pub(crate) fn find(
    file: &mut (impl Read + Seek),
    length: u64,
    size: [u32; 2],
) -> io::Result<Option<Result<Recording, String>>> {
    let bytes = metadata(file, length)?;
    let Some(at) = bytes.windows(BEGIN.len()).rposition(|window| window == BEGIN) else { return Ok(None) };
    // Other metadata may follow.
    let camera = serde_json::Deserializer::from_slice(&bytes[at..]).into_iter::<Camera>().next();
    let camera = camera.expect("there is a text").map_err(|error| error.to_string());
    Ok(Some(camera.and_then(|camera| camera.recording(size))))
}

/// Returns the contents of all boxes of an MP4 file except for those of the video itself.
fn metadata(file: &mut (impl Read + Seek), length: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let mut at = 0;
    while at + 8 <= length {
        file.seek(SeekFrom::Start(at))?;
        let mut header = [0; 8];
        file.read_exact(&mut header)?;
        let [size, kind] = [&header[..4], &header[4..]].map(|four| four.try_into().unwrap_or([0; 4]));
        let (size, header) = match u32::from_be_bytes(size) {
            0 => (length - at, 8),
            1 if at + 16 <= length => {
                let mut large = [0; 8];
                file.read_exact(&mut large)?;
                (u64::from_be_bytes(large), 16)
            }
            size => (u64::from(size), 8),
        };
        let Some(end) = at.checked_add(size).filter(|end| size >= header && *end <= length) else { break };
        if &kind != b"mdat" && bytes.len() as u64 + size <= METADATA_LIMIT {
            file.take(size - header).read_to_end(&mut bytes)?;
        }
        at = end;
    }
    Ok(bytes)
}

impl Camera {
    /// Returns the description of pictures of this size in pixels: exactly what the camera sees, and the same directions
    /// for the other eye. That is level with the camera, so only the horizontal position of the principal point matters.
    fn recording(&self, [width, height]: [u32; 2]) -> Result<Recording, String> {
        let [focal_x, _, _, _, focal_y, _, center_x, ..] = self.intrinsic_matrix;
        let [low, high] = self.range_of_encoded_depth.unwrap_or(DEFAULT_RANGE);
        if width % 2 != 0 {
            return Err(format!("pictures of {width} pixels have no two halves"));
        }
        let columns = width / 2;
        let angle = |pixels: f32, focal: f32| (pixels / focal).atan();
        let rgbd = Rgbd {
            size: [columns, height],
            eye: Eye::Right,
            guard_columns: 0,
            outer_columns: 0,
            mirrored: false,
            fov_y: 2.0 * angle(height as f32 / 2.0, focal_y),
            // The outer side of the right eye is on the right.
            outer_inner: Some([angle(columns as f32 - center_x, focal_x), angle(center_x, focal_x)]),
            ipd: MEAN_IPD,
            nearest: low.max(NEAREST),
            farthest: high,
        };
        let inside = center_x > 0.0 && center_x < columns as f32;
        match inside && low >= 0.0 && rgbd.is_valid() {
            true => Ok(Recording { rgbd, range: [low, high] }),
            false => Err("its camera has parameters that are out of range".into()),
        }
    }
}

impl Recording {
    /// Returns a picture in the layout of [`Rgbd::pack`].
    pub(crate) fn packed(&self, picture: &Planes) -> Planes {
        let [hues, color] = picture.halves();
        color.beside(&Planes::of_gray(&self.depth(&hues.rgb(self.rgbd.size.into()))))
    }

    /// Converts hues to depth as in [`Rgbd`]. Pixels without a measurement are at the farthest distance.
    fn depth(&self, hues: &RgbImage) -> GrayImage {
        let [low, high] = self.range;
        GrayImage::from_fn(hues.width(), hues.height(), |x, y| {
            let distance = hue(hues.get_pixel(x, y).0).map(|hue| low + hue * (high - low));
            let measured = distance.filter(|distance| *distance >= NEAREST);
            Luma([measured.map_or(0, |distance| self.rgbd.quantize(distance))])
        })
    }
}

/// Returns the hue, 0 to 1, or `None` for colours close to grey.
fn hue(color: [u8; 3]) -> Option<f32> {
    let [r, g, b] = color.map(f32::from);
    let largest = r.max(g).max(b);
    let range = largest - r.min(g).min(b);
    if range < 64.0 {
        return None;
    }
    let sixths = match largest {
        _ if largest == r => ((g - b) / range).rem_euclid(6.0),
        _ if largest == g => (b - r) / range + 2.0,
        _ => (r - g) / range + 4.0,
    };
    Some(sixths / 6.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::Rgb;
    use std::io::Cursor;

    /// A camera whose axis is left of the centre of 60 x 32 pixels, as the application writes it.
    const CAMERA: &str = r#"{"intrinsicMatrix":[50,0,0,0,50,0,25,16,1],"rangeOfEncodedDepth":[0,4]}"#;

    /// Returns the colour of a hue, 0 to 1.
    fn color(hue: f32) -> Rgb<u8> {
        let channel = |n: f32| {
            let k = (n + hue * 6.0) % 6.0;
            (255.0 * (1.0 - k.min(4.0 - k).clamp(0.0, 1.0))).round() as u8
        };
        Rgb([channel(5.0), channel(3.0), channel(1.0)])
    }

    fn atom(kind: &[u8; 4], payload: &[u8]) -> Vec<u8> {
        [&(payload.len() as u32 + 8).to_be_bytes(), &kind[..], payload].concat()
    }

    fn found(file: &[u8]) -> Option<Result<Recording, String>> {
        find(&mut Cursor::new(file), file.len() as u64, [120, 32]).unwrap()
    }

    #[test]
    fn hues_are_what_they_were_made_of() {
        for i in 0..600 {
            let wanted = i as f32 / 600.0;
            let read = hue(color(wanted).0).unwrap();
            assert!((read - wanted).abs() < 0.5 / 255.0, "{read} in place of {wanted}");
        }
        assert_eq!([[0, 0, 0], [255, 255, 255], [90, 100, 120]].map(hue), [None; 3]);
    }

    #[test]
    fn the_camera_is_found_wherever_it_stands_but_not_in_the_video() {
        let meta = atom(b"meta", format!("key{CAMERA}more").as_bytes());
        let video = atom(b"mdat", CAMERA.as_bytes());
        let Recording { rgbd, range } =
            found(&[&atom(b"ftyp", b"mp42")[..], &video, &meta].concat()).unwrap().unwrap();
        assert_eq!((rgbd.size, rgbd.farthest, range), ([60, 32], 4.0, [0.0, 4.0]));
        assert_eq!(rgbd.outer_inner.unwrap().map(|angle| (angle.tan() * 50.0).round()), [35.0, 25.0]);
        assert!(found(&[&meta[..], &video].concat()).is_some());
        assert_eq!(found(&video), None);
        assert_eq!(found(b"no boxes at all"), None);
    }

    #[test]
    fn impossible_cameras_are_errors() {
        let with = |from: &str, to: &str| found(&atom(b"moov", CAMERA.replace(from, to).as_bytes())).unwrap();
        assert!(with("", "").is_ok() && with(",\"range", ",\"other").is_ok());
        for (from, to) in
            [("[50,", "[0,"), ("[0,4]", "[4,0]"), (",25,", ",-1,"), ("50,0,", "\"x\","), ("]}", "")]
        {
            assert!(with(from, to).is_err(), "{from} {to}");
        }
    }
}
