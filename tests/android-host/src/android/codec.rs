//! AMediaCodec and AMediaFormat of libmediandk.so: an H.264 decoder (openh264) with semi-planar, padded pictures.

#![allow(non_snake_case)]

use std::collections::{BTreeMap, VecDeque};
use std::ffi::{CString, c_char, c_int, c_void};

use yoro_media::video::Planes;

use crate::bionic::text;
use crate::exports::{Export, System, exports};
use crate::host::host;

/// `AMEDIA_ERROR_UNKNOWN`, and two results of `dequeueOutputBuffer`.
const UNKNOWN: c_int = -10000;
const TRY_AGAIN_LATER: isize = -1;
const OUTPUT_FORMAT_CHANGED: isize = -2;
/// `COLOR_FormatYUV420SemiPlanar`.
const SEMI_PLANAR: i32 = 21;
/// Unused bytes per row of luma, and unused rows per plane of luma.
const PADDING: [usize; 2] = [24, 6];
/// Size of the only input buffer in bytes.
const INPUT: usize = 1 << 20;

/// Decodes a frame. Returns `None` if it is damaged.
type Decode = Box<dyn FnMut(&[u8]) -> Option<Planes>>;

/// Creates a decoder, or returns `None` if the host has none.
#[cfg(target_arch = "x86_64")]
fn decoder() -> Option<Decode> {
    let mut decoder = yoro_media::video::Decoder::new().ok()?;
    Some(Box::new(move |frame| decoder.decode(frame).ok()))
}

#[cfg(not(target_arch = "x86_64"))]
fn decoder() -> Option<Decode> {
    None
}

/// `AMediaFormat`.
#[derive(Default)]
struct Format {
    numbers: BTreeMap<String, i32>,
    text: CString,
}

/// `AMediaCodec`.
struct Codec {
    decode: Option<Decode>,
    input: Vec<u8>,
    is_filling: bool,
    /// Decoded pictures with their times. The application holds the first one while `is_read` is true.
    output: VecDeque<(u64, Vec<u8>)>,
    is_read: bool,
    /// Width and height of the pictures, and whether the application has been told.
    size: [usize; 2],
    is_size_told: bool,
}

/// Returns the functions of this module.
pub fn exports() -> Vec<Export> {
    exports![System::Media, 21: [
        AMediaCodec_createDecoderByType, AMediaCodec_delete, AMediaCodec_configure, AMediaCodec_start,
        AMediaCodec_dequeueInputBuffer, AMediaCodec_getInputBuffer, AMediaCodec_queueInputBuffer,
        AMediaCodec_dequeueOutputBuffer, AMediaCodec_getOutputBuffer, AMediaCodec_getOutputFormat,
        AMediaCodec_releaseOutputBuffer, AMediaFormat_new, AMediaFormat_delete, AMediaFormat_getInt32,
        AMediaFormat_setInt32, AMediaFormat_setString, AMediaFormat_toString,
    ]]
}

fn expect(is_allowed: bool, what: &str) {
    if !is_allowed {
        host().violation(format!("decoder: {what}"));
    }
}

unsafe extern "C" fn AMediaCodec_createDecoderByType(kind: *const c_char) -> *mut Codec {
    // SAFETY: a terminated text.
    if unsafe { text(kind) } != "video/avc" {
        return std::ptr::null_mut();
    }
    host().count("decoders", 1);
    Box::into_raw(Box::new(Codec {
        decode: None,
        input: vec![0; INPUT],
        is_filling: false,
        output: VecDeque::new(),
        is_read: false,
        size: [0; 2],
        is_size_told: false,
    }))
}

unsafe extern "C" fn AMediaCodec_delete(codec: *mut Codec) -> c_int {
    host().count("decoders", -1);
    // SAFETY: the codec was made by the function above, and is deleted once.
    drop(unsafe { Box::from_raw(codec) });
    0
}

extern "C" fn AMediaCodec_configure(
    _: &mut Codec,
    format: &Format,
    window: *mut c_void,
    _: *mut c_void,
    flags: u32,
) -> c_int {
    let has_size = ["width", "height"].iter().all(|key| format.numbers.get(*key).is_some_and(|n| *n > 0));
    expect(
        has_size && window.is_null() && flags == 0,
        "configured without a size, or with what the host has not",
    );
    0
}

extern "C" fn AMediaCodec_start(codec: &mut Codec) -> c_int {
    codec.decode = decoder();
    if codec.decode.is_some() { 0 } else { UNKNOWN }
}

extern "C" fn AMediaCodec_dequeueInputBuffer(codec: &mut Codec, _: i64) -> isize {
    expect(codec.decode.is_some(), "used before its start");
    if std::mem::replace(&mut codec.is_filling, true) { TRY_AGAIN_LATER } else { 0 }
}

extern "C" fn AMediaCodec_getInputBuffer(codec: &mut Codec, _: usize, size: &mut usize) -> *mut u8 {
    *size = INPUT;
    codec.input.as_mut_ptr()
}

extern "C" fn AMediaCodec_queueInputBuffer(
    codec: &mut Codec,
    _: usize,
    offset: i64,
    size: usize,
    time: u64,
    _: u32,
) -> c_int {
    expect(std::mem::take(&mut codec.is_filling), "a buffer for input is queued that was not asked for");
    let Codec { decode: Some(decode), input, .. } = codec else { return UNKNOWN };
    let Some(picture) = input.get(offset as usize..).and_then(|input| input.get(..size)) else {
        return UNKNOWN;
    };
    match decode(picture) {
        Some(planes) => {
            codec.is_size_told &= codec.size == planes.size;
            codec.size = planes.size;
            codec.output.push_back((time, padded(&planes)));
            0
        }
        None => UNKNOWN,
    }
}

/// Returns a picture with the layout that a phone's decoder may use.
fn padded(planes: &Planes) -> Vec<u8> {
    let [width, height] = planes.size;
    let (stride, rows) = (width + PADDING[0], height + PADDING[1]);
    let [luma, blue, red] = &planes.planes;
    let mut bytes = vec![0; stride * (rows + height / 2)];
    let (above, below) = bytes.split_at_mut(stride * rows);
    for (to, row) in above.chunks_mut(stride).zip(luma.chunks(width)) {
        to[..width].copy_from_slice(row);
    }
    let chroma = blue.chunks(width / 2).zip(red.chunks(width / 2));
    for (to, (blue, red)) in below.chunks_mut(stride).zip(chroma) {
        for (to, (blue, red)) in to.chunks_mut(2).zip(blue.iter().zip(red)) {
            to.copy_from_slice(&[*blue, *red]);
        }
    }
    bytes
}

/// `AMediaCodecBufferInfo`.
#[repr(C)]
struct BufferInfo {
    offset: i32,
    size: i32,
    time: i64,
    flags: u32,
}

extern "C" fn AMediaCodec_dequeueOutputBuffer(codec: &mut Codec, info: &mut BufferInfo, _: i64) -> isize {
    match codec.output.front() {
        None => TRY_AGAIN_LATER,
        Some(_) if codec.is_read => TRY_AGAIN_LATER,
        Some(_) if !std::mem::replace(&mut codec.is_size_told, true) => OUTPUT_FORMAT_CHANGED,
        Some((time, bytes)) => {
            *info = BufferInfo { offset: 0, size: bytes.len() as i32, time: *time as i64, flags: 0 };
            codec.is_read = true;
            0
        }
    }
}

extern "C" fn AMediaCodec_getOutputBuffer(codec: &mut Codec, _: usize, size: &mut usize) -> *mut u8 {
    expect(codec.is_read, "a picture is read that was not asked for");
    let Some((_, bytes)) = codec.output.front_mut() else { return std::ptr::null_mut() };
    *size = bytes.len();
    bytes.as_mut_ptr()
}

extern "C" fn AMediaCodec_releaseOutputBuffer(codec: &mut Codec, _: usize, _: bool) -> c_int {
    expect(std::mem::take(&mut codec.is_read), "a picture is given back that was not asked for");
    codec.output.pop_front();
    0
}

extern "C" fn AMediaCodec_getOutputFormat(codec: &mut Codec) -> *mut Format {
    let [width, height] = codec.size;
    let numbers = [
        ("width", width),
        ("height", height),
        ("stride", width + PADDING[0]),
        ("slice-height", height + PADDING[1]),
        ("color-format", SEMI_PLANAR as usize),
    ];
    let format = AMediaFormat_new();
    // SAFETY: the format has just been made.
    unsafe { &mut *format }.numbers = numbers.map(|(key, n)| (key.to_owned(), n as i32)).into();
    format
}

extern "C" fn AMediaFormat_new() -> *mut Format {
    host().count("media formats", 1);
    Box::into_raw(Box::default())
}

unsafe extern "C" fn AMediaFormat_delete(format: *mut Format) -> c_int {
    host().count("media formats", -1);
    // SAFETY: the format was made by the function above, and is deleted once.
    drop(unsafe { Box::from_raw(format) });
    0
}

unsafe extern "C" fn AMediaFormat_getInt32(format: &Format, key: *const c_char, to: &mut i32) -> bool {
    // SAFETY: a terminated text.
    let found = format.numbers.get(&unsafe { text(key) });
    found.inspect(|number| *to = **number).is_some()
}

unsafe extern "C" fn AMediaFormat_setInt32(format: &mut Format, key: *const c_char, value: i32) {
    // SAFETY: a terminated text.
    format.numbers.insert(unsafe { text(key) }, value);
}

extern "C" fn AMediaFormat_setString(_: &mut Format, _: *const c_char, _: *const c_char) {}

extern "C" fn AMediaFormat_toString(format: &mut Format) -> *const c_char {
    format.text = CString::new(format!("{:?}", format.numbers)).unwrap_or_default();
    format.text.as_ptr()
}
