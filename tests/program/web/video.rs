//! An RGBD video on the page.

use std::time::Duration;
use std::{fs, thread};

use image::{RgbImage, imageops};
use serde_json::json;
use yoro::eyes::Eye;
use yoro_lab::metrics::{Channels, psnr};
use yoro_lab::picture;

use super::{Page, sum};
use crate::program::succeed;

const SIZE: [u32; 2] = [192, 128];
const FRAMES: u32 = 6;

#[test]
fn an_rgbd_video_plays_over_and_over_until_it_is_paused() {
    let Some(mut page) = Page::open("#display=side-by-side", None) else { return };
    let dir = tempfile::tempdir().unwrap();
    let at = dir.path();
    let scene = format!("render prototype --frames {FRAMES} --size {}x{}", SIZE[0], SIZE[1]);
    succeed(at, &format!("{scene} --video rgbd.mp4 --frame-rate 6 --quantizer 16"));
    succeed(at, &format!("{scene} --method conventional --outputs left,right --out truth"));
    succeed(at, "synthesize rgbd.mp4 --out stereo.mp4");
    let read = |name: &str| fs::read(at.join(name)).unwrap();

    // What is no such video leaves the scene where it is.
    let whole = read("rgbd.mp4");
    let half = whole[..whole.len() / 2].to_vec();
    for (name, bytes, what) in [
        ("half.mp4", half, "half.mp4 cannot be read as a video"),
        ("stereo.mp4", read("stereo.mp4"), "stereo.mp4 has no depth"),
    ] {
        page.drop_files(&[(name, bytes)]);
        page.until(&format!("document.getElementById('message-text').textContent.includes('{what}')"));
        assert_eq!(page.evaluate("[yoro.source.builtin, yoro.stream]"), json!(["prototype", null]), "{name}");
    }

    page.drop_files(&[("rgbd.mp4", whole)]);
    page.until(&format!("yoro.stream?.frames > {}", 2 * FRAMES));
    assert_eq!(page.message(), None);
    page.evaluate("document.getElementById('play').click(); 0");
    thread::sleep(Duration::from_millis(400));
    let frames = page.evaluate("yoro.stream.frames");
    let eyes = page.eyes(SIZE);
    thread::sleep(Duration::from_millis(600));
    assert_eq!(page.evaluate("yoro.stream.frames"), frames, "it is paused");

    // The picture is one of the video's: both eyes, against real renders.
    // Its border is black, so that nothing is smeared beyond it.
    let inner = |image: &RgbImage| imageops::crop_imm(image, 4, 4, SIZE[0] - 8, SIZE[1] - 8).to_image();
    let db = |a: &RgbImage, b: &RgbImage| psnr(&inner(a), &inner(b), Channels::Luma).unwrap().0;
    let truth = |frame: u32, eye: &str| {
        picture::load_color(&at.join(format!("truth/prototype-{frame:04}.{eye}.png"))).unwrap()
    };
    let [left, right] = Eye::BOTH.map(|eye| &eyes[eye.index()]);
    let rendered = |frame: &u32| db(right, &truth(*frame, "right"));
    let frame = (0..FRAMES).max_by(|a, b| rendered(a).total_cmp(&rendered(b))).unwrap();
    let (synthesized, same) =
        (db(left, &truth(frame, "left")), db(&truth(frame, "right"), &truth(frame, "left")));
    eprintln!(
        "frame {frame}: rendered {:.1} dB, synthesized {synthesized:.1} dB, same image to both eyes {same:.1} dB",
        rendered(&frame)
    );
    assert!(rendered(&frame) > 30.0, "{:.1} dB", rendered(&frame));
    assert!(synthesized > same + 2.0, "{synthesized:.1} dB, same image {same:.1} dB");

    // Every display shows it.
    for display in
        ["divider", "difference", "side-by-side", "cross-eyed", "anaglyph", "left", "right", "flicker"]
    {
        let sum = page.evaluate(&sum(display)).as_u64().unwrap();
        // No error is known: that display shows what the divider does, or black.
        assert_eq!(sum > 0, display != "difference", "{display}: {sum}");
    }
    page.evaluate("document.getElementById('play').click(); 0");
    page.until(&format!("yoro.stream.frames > {frames} + 3"));
    page.choose("scene", "prototype");
    page.until("yoro.source?.builtin === 'prototype' && yoro.stream === null");
    assert_eq!((page.message(), page.evaluate("yoro.page.takeErrors() ?? null")), (None, json!(null)));
    page.browser.expect_silence();
}
