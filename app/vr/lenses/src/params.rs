//! The parameters of a Cardboard-compatible viewer: built in, or from a URI (the viewer's QR code) or a file.

use std::path::{Path, PathBuf};

use base64::Engine as _;
use base64::engine::general_purpose::URL_SAFE_NO_PAD;
use prost::Message;

/// First word of a parameter file.
const SENTINEL: u32 = 0x3558_7a2b;
/// The URI of the first viewer, which contains no parameters.
const V1_URI: &str = "g.co/cardboard";
/// The part before the parameters in every other URI.
const URI_PREFIX: &str = "google.com/cardboard/cfg?p=";
/// Maximum size of a parameter file in bytes; real ones have about a hundred.
const MAX_FILE: u64 = 64 << 10;

/// An error in viewer parameters, one sentence with the remedy.
#[derive(Debug, thiserror::Error)]
pub enum ParamsError {
    /// The file cannot be read, or has neither the stored format nor a URI.
    #[error("{0}")]
    File(String),
    /// The text is not a viewer's URI, or is a damaged one.
    #[error("{0}")]
    Uri(String),
}

/// The edge of the screen from which the lenses' position is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, prost::Enumeration)]
#[repr(i32)]
pub enum VerticalAlignment {
    /// The phone stands on a tray; the lenses are [`ViewerParams::tray_to_lens`] above it.
    Bottom = 0,
    /// The screen is centred behind the lenses.
    Center = 1,
    /// The lenses are [`ViewerParams::tray_to_lens`] below the upper edge.
    Top = 2,
}

/// A viewer. Lengths are in metres, angles in degrees as viewers state them.
#[derive(Clone, Debug, PartialEq)]
pub struct ViewerParams {
    /// The maker.
    pub vendor: String,
    /// The model.
    pub model: String,
    /// Distance from the screen to the lenses.
    pub screen_to_lens: f32,
    /// Distance between the lenses' centres.
    pub inter_lens: f32,
    /// Distance from the tray to the lenses' centres; ignored if the screen is centred.
    pub tray_to_lens: f32,
    /// Largest half-angles of the left eye: outer (left), inner (right), bottom, top.
    pub fov_degrees: [f32; 4],
    /// Coefficients of the distortion polynomial, k1 first.
    pub distortion: Vec<f32>,
    /// The edge by which the screen is aligned.
    pub alignment: VerticalAlignment,
}

/// The message in a viewer's QR code. Its other fields are not needed here and are skipped.
#[derive(Clone, PartialEq, prost::Message)]
struct DeviceParams {
    #[prost(string, optional, tag = "1")]
    vendor: Option<String>,
    #[prost(string, optional, tag = "2")]
    model: Option<String>,
    #[prost(float, optional, tag = "3")]
    screen_to_lens: Option<f32>,
    #[prost(float, optional, tag = "4")]
    inter_lens: Option<f32>,
    #[prost(float, repeated, packed = "true", tag = "5")]
    left_eye_fov: Vec<f32>,
    #[prost(float, optional, tag = "6")]
    tray_to_lens: Option<f32>,
    #[prost(float, repeated, packed = "true", tag = "7")]
    distortion: Vec<f32>,
    #[prost(enumeration = "VerticalAlignment", optional, tag = "11")]
    alignment: Option<i32>,
}

impl ViewerParams {
    /// Returns the first Cardboard viewer.
    pub fn v1() -> ViewerParams {
        ViewerParams {
            vendor: "Google, Inc.".into(),
            model: "Cardboard v1".into(),
            screen_to_lens: 0.042,
            inter_lens: 0.060,
            tray_to_lens: 0.035,
            fov_degrees: [40.0; 4],
            distortion: vec![0.441, 0.156],
            alignment: VerticalAlignment::Bottom,
        }
    }

    /// Returns the viewer of 2015, which has larger lenses. Most viewers today are like it.
    pub fn v2() -> ViewerParams {
        ViewerParams {
            vendor: "Google, Inc.".into(),
            model: "Cardboard I/O 2015".into(),
            screen_to_lens: 0.039,
            inter_lens: 0.064,
            tray_to_lens: 0.035,
            fov_degrees: [60.0; 4],
            distortion: vec![0.34, 0.55],
            alignment: VerticalAlignment::Bottom,
        }
    }

    /// Finds a viewer by the user's text: `v1`, `v2`, a URI, or the path of a file ([`ViewerParams::load`]).
    ///
    /// # Errors
    /// [`ParamsError`].
    pub fn find(text: &str) -> Result<ViewerParams, ParamsError> {
        match text.trim() {
            "v1" => Ok(ViewerParams::v1()),
            "v2" => Ok(ViewerParams::v2()),
            uri if is_uri(uri) => ViewerParams::from_uri(uri),
            path => ViewerParams::load(Path::new(path)),
        }
    }

    /// Like [`ViewerParams::find`], but looks for files in `folders` first.
    pub fn find_in(text: &str, folders: &[PathBuf]) -> Result<ViewerParams, ParamsError> {
        match folders.iter().map(|folder| folder.join(text)).find(|path| path.is_file()) {
            Some(path) => ViewerParams::load(&path),
            None => ViewerParams::find(text),
        }
    }

    /// Decodes the URI of a viewer's QR code.
    ///
    /// # Errors
    /// [`ParamsError::Uri`].
    pub fn from_uri(uri: &str) -> Result<ViewerParams, ParamsError> {
        let fail = |reason: String| {
            ParamsError::Uri(format!(
                "\"{uri}\" is not a viewer's URI ({reason}): it reads https://google.com/cardboard/cfg?p=... as in the viewer's QR code; resolve shortened addresses first"
            ))
        };
        let rest = strip_scheme(uri.trim());
        if rest.trim_end_matches('/') == V1_URI {
            return Ok(ViewerParams::v1());
        }
        let encoded = rest.strip_prefix(URI_PREFIX).ok_or_else(|| fail("it has no parameters".into()))?;
        let encoded = encoded.split(['&', '#']).next().unwrap_or_default().trim_end_matches('=');
        let bytes = URL_SAFE_NO_PAD.decode(encoded).map_err(|e| fail(e.to_string()))?;
        ViewerParams::from_message(&bytes).map_err(fail)
    }

    /// Reads a file that holds either the stored binary format (sentinel, length, message) or a URI as text.
    pub fn load(path: &Path) -> Result<ViewerParams, ParamsError> {
        let read = || -> std::io::Result<Vec<u8>> {
            use std::io::Read;
            let mut bytes = Vec::new();
            std::fs::File::open(path)?.take(MAX_FILE).read_to_end(&mut bytes)?;
            Ok(bytes)
        };
        let file = format!("the viewer file {}", path.display());
        let remedy = "give v1, v2, a viewer's URI, or the path of a parameter file";
        let bytes =
            read().map_err(|e| ParamsError::File(format!("{file} cannot be read ({e}): {remedy}")))?;
        let remedy = "store the viewer again, or write its URI into the file";
        let fail = |reason: String| ParamsError::File(format!("{file} is damaged ({reason}): {remedy}"));
        if let Some(stored) = bytes.strip_prefix(&SENTINEL.to_be_bytes()) {
            let (length, message) =
                stored.split_first_chunk().ok_or_else(|| fail("it ends after its first word".into()))?;
            let length = u32::from_be_bytes(*length) as usize;
            let message = message
                .get(..length)
                .ok_or_else(|| fail(format!("it should hold {length} bytes and holds {}", message.len())))?;
            return ViewerParams::from_message(message).map_err(fail);
        }
        match std::str::from_utf8(&bytes) {
            Ok(text) if is_uri(text.trim()) => ViewerParams::from_uri(text),
            _ => Err(fail("it is neither a stored viewer nor a URI".into())),
        }
    }

    /// Decodes the protobuf message. The error is a part of a sentence.
    fn from_message(bytes: &[u8]) -> Result<ViewerParams, String> {
        let message = DeviceParams::decode(bytes).map_err(|e| e.to_string())?;
        let length = |value: Option<f32>, name: &str| match value {
            Some(metres) if (0.005..0.5).contains(&metres) => Ok(metres),
            Some(metres) => Err(format!("{name} of {metres} m is impossible")),
            None => Err(format!("{name} is missing")),
        };
        let alignment = match message.alignment {
            None => VerticalAlignment::Bottom,
            Some(n) => {
                VerticalAlignment::try_from(n).map_err(|_| format!("the alignment {n} does not exist"))?
            }
        };
        let fov_degrees = <[f32; 4]>::try_from(message.left_eye_fov.as_slice()).map_err(|_| {
            format!("it has {} field of view angles instead of 4", message.left_eye_fov.len())
        })?;
        if !fov_degrees.iter().all(|angle| (1.0..89.0).contains(angle)) {
            return Err(format!("the field of view {fov_degrees:?} is impossible"));
        }
        if message.distortion.len() > 8 || message.distortion.iter().any(|k| k.is_nan() || k.abs() > 100.0) {
            return Err(format!("the distortion {:?} is impossible", message.distortion));
        }
        Ok(ViewerParams {
            vendor: message.vendor.unwrap_or_default(),
            model: message.model.unwrap_or_default(),
            screen_to_lens: length(message.screen_to_lens, "the distance from screen to lens")?,
            inter_lens: length(message.inter_lens, "the distance between the lenses")?,
            tray_to_lens: match alignment {
                VerticalAlignment::Center => message.tray_to_lens.filter(|t| t.is_finite()).unwrap_or(0.0),
                _ => length(message.tray_to_lens, "the distance from tray to lens")?,
            },
            fov_degrees,
            distortion: message.distortion,
            alignment,
        })
    }
}

fn strip_scheme(uri: &str) -> &str {
    let rest = uri.strip_prefix("https://").or_else(|| uri.strip_prefix("http://")).unwrap_or(uri);
    rest.strip_prefix("www.").unwrap_or(rest)
}

fn is_uri(text: &str) -> bool {
    text.contains("://") || strip_scheme(text).starts_with(V1_URI) || text.contains(URI_PREFIX)
}

#[cfg(test)]
mod tests {
    use super::*;

    const V1: &str = "CgxHb29nbGUsIEluYy4SDENhcmRib2FyZCB2MR0xCCw9JY_CdT0qEAAAIEIAACBCAAAgQgAAIEI1KVwPPToIwcrhPne-Hz5YAGAB";
    const VR_ONE: &str =
        "Cg1DYXJsIFplaXNzIEFHEgZWUiBPTkUdUI0XPSW28309KhAAAEhCAABIQgAASEIAAEhCWAE1KVwPPToIzczMPQAAgD9QAGAA";
    const IO_2015: &str = "CgZHb29nbGUSEkNhcmRib2FyZCBJL08gMjAxNR0J-SA9JQHegj0qEAAAcEIAAHBCAABwQgAAcEJYADUpXA89OghX8as-YrENP1AAYAM";

    impl ViewerParams {
        /// Returns the URI with these parameters.
        pub fn to_uri(&self) -> String {
            format!("https://{URI_PREFIX}{}", URL_SAFE_NO_PAD.encode(self.to_message()))
        }

        /// Returns a file in the stored format that [`ViewerParams::load`] reads.
        pub fn to_file(&self) -> Vec<u8> {
            let message = self.to_message();
            let mut bytes = SENTINEL.to_be_bytes().to_vec();
            bytes.extend((message.len() as u32).to_be_bytes());
            bytes.extend(message);
            bytes
        }

        fn to_message(&self) -> Vec<u8> {
            DeviceParams {
                vendor: Some(self.vendor.clone()),
                model: Some(self.model.clone()),
                screen_to_lens: Some(self.screen_to_lens),
                inter_lens: Some(self.inter_lens),
                left_eye_fov: self.fov_degrees.to_vec(),
                tray_to_lens: Some(self.tray_to_lens),
                distortion: self.distortion.clone(),
                alignment: Some(self.alignment as i32),
            }
            .encode_to_vec()
        }
    }

    fn decode(parameter: &str) -> ViewerParams {
        ViewerParams::from_uri(&format!("https://google.com/cardboard/cfg?p={parameter}")).unwrap()
    }

    fn close(a: f32, b: f32) {
        assert!((a - b).abs() < 1e-6, "{a} is not {b}");
    }

    #[test]
    fn real_codes_decode() {
        assert_eq!(URL_SAFE_NO_PAD.decode(V1).unwrap().len(), 75);
        let v1 = decode(V1);
        assert_eq!((v1.vendor.as_str(), v1.model.as_str()), ("Google, Inc.", "Cardboard v1"));
        close(v1.screen_to_lens, 0.042);
        close(v1.inter_lens, 0.06);
        close(v1.tray_to_lens, 0.035);
        assert_eq!(v1.fov_degrees, [40.0; 4]);
        assert_eq!(v1.distortion, [0.441, 0.156]);
        assert_eq!(v1.alignment, VerticalAlignment::Bottom);

        let one = decode(VR_ONE);
        close(one.screen_to_lens, 0.037);
        close(one.inter_lens, 0.062);
        assert_eq!((one.fov_degrees, one.alignment), ([50.0; 4], VerticalAlignment::Center));
        assert_eq!(one.distortion, [0.1, 1.0]);

        let io = decode(IO_2015);
        close(io.screen_to_lens, 0.0393);
        close(io.inter_lens, 0.0639);
        assert_eq!(io.fov_degrees, [60.0; 4]);
        close(io.distortion[0], 0.335826);
        close(io.distortion[1], 0.553488);
    }

    #[test]
    fn the_short_uri_is_v1() {
        for uri in ["https://g.co/cardboard", "http://g.co/cardboard/", "g.co/cardboard"] {
            assert_eq!(ViewerParams::find(uri).unwrap(), ViewerParams::v1());
        }
    }

    #[test]
    fn parameters_survive_a_round_trip() {
        let folder = tempfile::tempdir().unwrap();
        for viewer in [ViewerParams::v1(), ViewerParams::v2(), decode(VR_ONE)] {
            assert_eq!(ViewerParams::find(&viewer.to_uri()).unwrap(), viewer);
            let stored = folder.path().join("current_device_params");
            std::fs::write(&stored, viewer.to_file()).unwrap();
            assert_eq!(ViewerParams::load(&stored).unwrap(), viewer);
            let text = folder.path().join("viewer.txt");
            std::fs::write(&text, format!("{}\n", viewer.to_uri())).unwrap();
            assert_eq!(ViewerParams::find(text.to_str().unwrap()).unwrap(), viewer);
        }
    }

    #[test]
    fn mistakes_name_the_remedy() {
        let folder = tempfile::tempdir().unwrap();
        let mut cut = ViewerParams::v1().to_file();
        cut.truncate(30);
        for (name, bytes, expected) in [
            ("cut", cut.as_slice(), "should hold"),
            ("empty", b"", "neither"),
            ("word", &SENTINEL.to_be_bytes(), "ends after"),
            ("binary", &[0xff, 0xfe, 0], "neither"),
        ] {
            let path = folder.path().join(name);
            std::fs::write(&path, bytes).unwrap();
            let message = ViewerParams::load(&path).unwrap_err().to_string();
            assert!(message.contains(expected) && message.contains(name), "{message}");
        }
        for text in [
            "https://example.com",
            "https://google.com/cardboard/cfg?p=!!",
            "https://google.com/cardboard/cfg?p=",
            "https://google.com/cardboard/cfg?p=AAAA",
        ] {
            let message = ViewerParams::find(text).unwrap_err().to_string();
            assert!(message.contains(text) && message.contains("QR code"), "{message}");
        }
        let message = ViewerParams::find("no/such/file").unwrap_err().to_string();
        assert!(message.contains("no/such/file") && message.contains("v2"), "{message}");
    }

    proptest::proptest! {
        #[test]
        fn damaged_messages_never_panic(mut bytes in proptest::collection::vec(0u8.., 0..96), at in 0usize..75, xor in 1u8..) {
            let _ = ViewerParams::from_message(&bytes);
            bytes = ViewerParams::v1().to_message();
            let n = bytes.len();
            bytes[at % n] ^= xor;
            let _ = ViewerParams::from_message(&bytes);
        }
    }
}
