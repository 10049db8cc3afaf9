//! Reads what another application shares with yoro: a viewer's code as text or as a picture, or a model.

pub mod scan;

use std::fs::File;
use std::io::{self, Read, Seek as _, SeekFrom};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{self, Receiver, TryRecvError};
use std::sync::{Arc, Weak};
use std::thread;

use yoro_lenses::{ViewerParams, read_qr};

/// The largest picture and the largest model, in bytes.
const MAX_PICTURE: u64 = 64 << 20;
const MAX_MODEL: u64 = 1 << 30;
/// The limit on a picture's pixels in memory, in bytes.
const MAX_PIXELS: u64 = 192 << 20;
/// Larger pictures are scaled down to this many pixels, which still give a code several pixels per module.
const LONGEST: u32 = 2048;
/// The first bytes of a GLB file.
const GLB: &[u8] = b"glTF";

/// What another application passes to the activity with the intent that starts it.
pub enum Given {
    /// A text or an address.
    Text(String),
    /// An open file, and its name.
    File(File, String),
    /// A file that yoro is not permitted to read.
    Closed,
}

/// What was shared, ready for use.
#[derive(Clone, Debug, PartialEq)]
pub enum Shared {
    /// A viewer's URI.
    Viewer(String),
    /// The file name of a model, which is now in the scene folder.
    Scene(String),
}

/// A thread that reads what was shared, since its owner may be slow and a model large.
pub struct Reading {
    outcome: Receiver<Result<Shared, String>>,
    /// The number of bytes read so far. The thread gives up once this is dropped.
    bytes: Arc<AtomicU64>,
    /// The number of megabytes that the user has last seen.
    shown_megabytes: Option<u64>,
}

impl Reading {
    /// Starts the thread. `open` asks the owner for the data; a model is copied into `folder`.
    pub fn begin(folder: Option<PathBuf>, open: impl FnOnce() -> Given + Send + 'static) -> Reading {
        let (sender, outcome) = mpsc::channel();
        let bytes = Arc::new(AtomicU64::new(0));
        let progress = Arc::downgrade(&bytes);
        let work = move || {
            let read = match (open(), folder) {
                (Given::Text(text), _) => address_in_text(&text),
                (Given::File(file, name), Some(folder)) => read(file, &name, &folder, &progress),
                (Given::File(..), None) => {
                    Err("There is no folder for what is shared: make room, and share it again.".into())
                }
                (Given::Closed, _) => {
                    Err("The shared file cannot be opened: share it from another application.".into())
                }
            };
            // The receiver may be gone with the activity.
            _ = sender.send(read);
        };
        if let Err(error) = thread::Builder::new().name("yoro-shared".into()).spawn(work) {
            log::warn!("no thread for what was shared: {error}");
        }
        Reading { outcome, bytes, shown_megabytes: None }
    }

    /// Returns what was shared once it is read, or why it cannot be used.
    pub fn poll(&self) -> Option<Result<Shared, String>> {
        match self.outcome.try_recv() {
            Ok(read) => Some(read),
            Err(TryRecvError::Empty) => None,
            Err(TryRecvError::Disconnected) => Some(Err("It was not read: share it again.".into())),
        }
    }

    /// Returns a sentence about the progress; `None` if it has not changed.
    pub fn news(&mut self) -> Option<String> {
        let megabytes = self.bytes.load(Ordering::Relaxed) >> 20;
        if self.shown_megabytes.replace(megabytes) == Some(megabytes) {
            return None;
        }
        Some(match megabytes {
            0 => "What was shared is being read.".into(),
            _ => format!("What was shared is being read: {megabytes} MB."),
        })
    }
}

/// A reader whose bytes are counted while somebody waits for them.
struct Counted<R> {
    from: R,
    bytes: Weak<AtomicU64>,
}

impl<R: Read> Read for Counted<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let bytes = self.bytes.upgrade().ok_or_else(|| io::Error::other("yoro was left"))?;
        let count = self.from.read(buffer)?;
        bytes.fetch_add(count as u64, Ordering::Relaxed);
        Ok(count)
    }
}

/// The longest address accepted, in bytes.
const MAX_ADDRESS: usize = 2048;

/// Finds a viewer's URI among the words of a text.
///
/// # Errors
/// A sentence with the remedy.
pub fn address_in_text(text: &str) -> Result<Shared, String> {
    let is_address = |word: &&str| word.contains('.') && word.contains('/');
    let is_viewer = |word: &&str| is_address(word) && word.contains("/cardboard");
    // Without surrounding brackets and punctuation, and without anything after the first parameter.
    let words = || {
        text.split_whitespace().map(|word| {
            let word = word.trim_matches(|c: char| "()<>[]{}\"'.,;!".contains(c));
            word.split(['&', '#']).next().unwrap_or_default()
        })
    };
    let found = words().find(is_viewer).or_else(|| words().find(is_address));
    let word = found.ok_or("That has no address: share the address that the viewer's code leads to.")?;
    if word.len() > MAX_ADDRESS || !is_viewer(&word) {
        return Err(format!(
            "{} may be a shortened address: open it in the browser, and share the address that it leads to.",
            word.chars().take(60).collect::<String>()
        ));
    }
    match ViewerParams::from_uri(word) {
        Ok(_) => Ok(Shared::Viewer(word.to_owned())),
        Err(error) => Err(error.to_string()),
    }
}

/// Reads a shared file: a picture of a viewer's code, or a model, which is copied into a folder under its name.
///
/// # Errors
/// A sentence with the remedy.
fn read(mut file: File, name: &str, folder: &Path, bytes: &Weak<AtomicU64>) -> Result<Shared, String> {
    let failed = |error: io::Error| format!("The shared file cannot be read ({error}): share it again.");
    let mut head = Vec::new();
    (&mut file).take(GLB.len() as u64).read_to_end(&mut head).map_err(failed)?;
    // Not every provider's file can be rewound.
    let rest: Box<dyn Read> = match file.seek(SeekFrom::Start(0)) {
        Ok(_) => Box::new(file),
        Err(_) => Box::new(io::Cursor::new(head.clone()).chain(file)),
    };
    let mut rest = Counted { from: rest, bytes: bytes.clone() };
    if head == GLB {
        return keep(&mut rest, name, folder);
    }
    let mut bytes = Vec::new();
    rest.take(MAX_PICTURE).read_to_end(&mut bytes).map_err(failed)?;
    let mut limits = image::Limits::default();
    limits.max_alloc = Some(MAX_PIXELS);
    let picture = image::ImageReader::new(io::Cursor::new(&bytes))
        .with_guessed_format()
        .map_err(image::ImageError::IoError)
        .and_then(|mut reader| {
            reader.limits(limits);
            reader.decode()
        })
        .map_err(|_| {
            "The shared file is no model (GLB) and no picture that yoro can read: share a PNG or JPEG of at most 60 megapixels."
                .to_owned()
        })?;
    let small = if picture.width().max(picture.height()) > LONGEST {
        picture.thumbnail(LONGEST, LONGEST)
    } else {
        picture
    };
    drop(bytes);
    let rgba = small.to_rgba8();
    match read_qr(&rgba, rgba.width() as usize) {
        Some(text) => address_in_text(&text),
        None => {
            Err("No QR code can be read in the shared picture: take it from nearer, straight, in even light."
                .into())
        }
    }
}

/// Removes incomplete copies left in a folder by a process that was killed.
pub fn remove_unfinished(folder: &Path) {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    for path in entries.map(|entry| entry.path()).filter(|path| path.extension().is_some_and(|e| e == "new"))
    {
        _ = std::fs::remove_file(path);
    }
}

/// Copies a model into a folder.
fn keep(from: &mut dyn Read, name: &str, folder: &Path) -> Result<Shared, String> {
    let stem = Path::new(name).file_stem().unwrap_or_default().to_string_lossy();
    let plain = |c: char| if c.is_alphanumeric() || matches!(c, '-' | '_') { c } else { '-' };
    let stem: String = stem.chars().take(60).map(plain).collect();
    let stem = if stem.is_empty() { "shared".into() } else { stem };
    let (path, new) = (folder.join(format!("{stem}.glb")), folder.join(format!("{stem}.new")));
    let copied = (|| {
        let length = io::copy(&mut from.take(MAX_MODEL + 1), &mut File::create(&new)?)?;
        if length > MAX_MODEL {
            return Err(io::Error::other("it is larger than 1 GiB"));
        }
        std::fs::rename(&new, &path)
    })();
    match copied {
        Ok(()) => Ok(Shared::Scene(format!("{stem}.glb"))),
        Err(error) => {
            _ = std::fs::remove_file(&new);
            Err(format!("The model {stem} cannot be kept ({error}): make room, and share it again."))
        }
    }
}

#[cfg(test)]
mod tests {
    use image::{GrayImage, Luma};
    use qrcode::{Color, QrCode};

    use super::*;

    const URI: &str = "https://google.com/cardboard/cfg?p=CgRBY21lEghQb2NrZXQgNR3sUTg9JY_CdT0qEAAANEIAADRCAAA0QgAANEI1KVwPPToImpmZPs3MzD4";

    #[test]
    fn a_viewer_is_found_among_words() {
        let viewer = |uri: &str| Ok(Shared::Viewer(uri.into()));
        assert_eq!(address_in_text(&format!("My viewer: {URI} (scanned)")), viewer(URI));
        assert_eq!(address_in_text(&format!("See a.example/x (as {URI}&a,b).")), viewer(URI));
        assert_eq!(address_in_text("http://g.co/cardboard"), viewer("http://g.co/cardboard"));
        for (text, part) in [
            ("https://goo.gl/abc", "shortened"),
            ("hello", "no address"),
            ("https://google.com/cardboard/cfg?p=%%%", "is not a viewer's URI"),
        ] {
            let mistake = address_in_text(text).unwrap_err();
            assert!(mistake.contains(part) && !mistake.contains('\n'), "{mistake}");
        }
    }

    #[test]
    fn files_are_told_apart_by_their_content() {
        let folder = tempfile::tempdir().unwrap();
        let waits = Arc::new(AtomicU64::new(0));
        let read = |content: &[u8], name: &str| {
            let path = folder.path().join("shared");
            std::fs::write(&path, content).unwrap();
            read(File::open(path).unwrap(), name, folder.path(), &Arc::downgrade(&waits))
        };
        let code = QrCode::new(URI).unwrap();
        let (modules, colors) = (code.width() as u32, code.to_colors());
        let side = 40 * (modules + 8);
        let picture = GrayImage::from_fn(side, side, |x, y| {
            let [x, y] = [x, y].map(|n| (n / 40).wrapping_sub(4));
            let is_dark = x < modules && y < modules && colors[(y * modules + x) as usize] == Color::Dark;
            Luma([if is_dark { 20 } else { 230 }])
        });
        assert!(side > LONGEST);
        let mut png = std::io::Cursor::new(Vec::new());
        picture.write_to(&mut png, image::ImageFormat::Png).unwrap();
        assert_eq!(read(png.get_ref(), "photo.png"), Ok(Shared::Viewer(URI.into())));
        let mut blank = std::io::Cursor::new(Vec::new());
        GrayImage::new(50, 50).write_to(&mut blank, image::ImageFormat::Png).unwrap();
        assert!(read(blank.get_ref(), "photo.png").unwrap_err().contains("No QR code"));
        assert!(read(b"", "nothing").unwrap_err().contains("no picture"));

        // An incomplete copy.
        std::fs::write(folder.path().join("room.new"), b"glTF").unwrap();
        remove_unfinished(folder.path());
        assert!(!folder.path().join("room.new").exists() && folder.path().join("shared").exists());
        assert_eq!(read(b"glTF and more", "../my room!.glb"), Ok(Shared::Scene("my-room-.glb".into())));
        assert_eq!(std::fs::read(folder.path().join("my-room-.glb")).unwrap(), b"glTF and more");
        let room = || File::open(folder.path().join("my-room-.glb")).unwrap();
        let mistake = super::read(room(), "a", Path::new("/nowhere"), &Arc::downgrade(&waits));
        assert!(mistake.unwrap_err().contains("cannot be kept"));
        let left = super::read(room(), "a", folder.path(), &Weak::new());
        assert!(left.unwrap_err().contains("yoro was left"));
        assert!(!folder.path().join("a.glb").exists() && !folder.path().join("a.new").exists());
    }

    #[test]
    fn a_slow_owner_is_waited_for_on_a_thread() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("shared");
        std::fs::write(&path, [GLB, &vec![0; 3 << 20]].concat()).unwrap();
        let (answer, asked) = mpsc::channel();
        let file = File::open(path).unwrap();
        let mut reading = Reading::begin(Some(folder.path().to_owned()), move || {
            asked.recv().unwrap();
            Given::File(file, "room.glb".into())
        });
        assert_eq!((reading.poll(), reading.news().is_some(), reading.news()), (None, true, None));
        answer.send(()).unwrap();
        let read = std::iter::repeat_with(thread::yield_now).find_map(|()| reading.poll());
        assert_eq!(read, Some(Ok(Shared::Scene("room.glb".into()))));
        assert_eq!(reading.news().as_deref(), Some("What was shared is being read: 3 MB."));
        for given in [Given::Text("hello".into()), Given::Closed] {
            let reading = Reading::begin(None, || given);
            let read = std::iter::repeat_with(thread::yield_now).find_map(|()| reading.poll());
            assert!(matches!(read, Some(Err(_))), "{read:?}");
        }
    }
}
