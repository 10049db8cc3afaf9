//! An RGBD video on the page.

use std::time::Duration;
use std::{fs, thread};

use image::{Rgb, RgbImage, imageops};
use serde_json::json;
use yoro::eyes::Eye;
use yoro_media::video::{Format, Planes, Rgbd, VideoError};
use yoro_metrics::{Channels, psnr};

use super::{Page, sum};
use crate::program::{folder, succeed};

const SIZE: [u32; 2] = [192, 128];
const FRAMES: u32 = 6;

#[test]
fn an_rgbd_video_plays_over_and_over_until_it_is_paused() {
    let Some(mut page) = Page::open("#display=side-by-side", None) else { return };
    let at = &folder();
    let scene = format!("render prototype --frames {FRAMES} --size {}x{}", SIZE[0], SIZE[1]);
    succeed(at, &format!("{scene} --video rgbd.mp4 --frame-rate 6 --quantizer 16"));
    succeed(at, &format!("{scene} --method conventional --outputs left,right --out truth"));
    succeed(at, "synthesize rgbd.mp4 --out stereo.mp4");
    let read = |name: &str| fs::read(at.join(name)).unwrap();

    // A file that is not such a video leaves the scene unchanged.
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

    // The picture is one of the video's frames: both eyes are compared with real renders. The border is excluded: it is
    // black, so that nothing is smeared beyond it.
    let inner = |image: &RgbImage| imageops::crop_imm(image, 4, 4, SIZE[0] - 8, SIZE[1] - 8).to_image();
    let db = |a: &RgbImage, b: &RgbImage| psnr(&inner(a), &inner(b), Channels::Luma).unwrap().0;
    let truth = |frame: u32, eye: &str| {
        yoro_media::load_color(&at.join(format!("truth/prototype-{frame:04}.{eye}.png"))).unwrap()
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

    // Every display shows the video.
    for display in
        ["divider", "difference", "side-by-side", "cross-eyed", "anaglyph", "left", "right", "flicker"]
    {
        let sum = page.evaluate(&sum(display)).as_u64().unwrap();
        // The error is unknown, so this display shows what the divider does, or black.
        assert_eq!(sum > 0, display != "difference", "{display}: {sum}");
    }
    page.evaluate("document.getElementById('play').click(); 0");
    page.until(&format!("yoro.stream.frames > {frames} + 3"));
    page.choose("scene", "prototype");
    page.until("yoro.source?.builtin === 'prototype' && yoro.stream === null");
    assert_eq!((page.message(), page.evaluate("yoro.page.takeErrors() ?? null")), (None, json!(null)));
    page.browser.expect_silence();
}

/// Squares of one shade, side by side.
const SQUARE: u32 = 16;

/// Writes a video with all 256 shades, each in a square, as colour and as depth, followed by coloured squares.
fn ramp(path: &std::path::Path) {
    let side = 16 * SQUARE;
    let rgbd = Rgbd {
        size: [side; 2],
        eye: Eye::Right,
        guard_columns: 0,
        outer_columns: 0,
        fov_y: 1.0,
        outer_inner: None,
        mirrored: true,
        ipd: 0.063,
        nearest: 1.0,
        farthest: 2.0,
    };
    let shade = |x: u32, y: u32| (y / SQUARE * 16 + x / SQUARE) as u8;
    let gray = Planes::of_rgb(&RgbImage::from_fn(side, side, |x, y| Rgb([shade(x, y); 3])));
    let colors = RgbImage::from_fn(side, side, |x, y| {
        let shade = shade(x, y);
        Rgb([shade, shade.wrapping_mul(37), 255 - shade])
    });
    let mut pictures = [gray.clone(), Planes::of_rgb(&colors)].map(|color| color.beside(&gray)).into_iter();
    let format = Format { frame_rate: 4, quantizer: 12, durations: None, frames: 2, rgbd: Some(rgbd) };
    yoro_media::video::write::<VideoError>(path, &format, || Ok(pictures.next())).unwrap();
}

#[test]
fn pictures_come_as_planes_or_as_the_browser_has_them_and_every_shade_is_exact() {
    let Some(mut page) = Page::open("#display=side-by-side", None) else { return };
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("ramp.mp4");
    ramp(&path);
    page.drop_files(&[("ramp.mp4", fs::read(&path).unwrap())]);
    page.until("yoro.stream?.frames > 0");
    let side = 16 * SQUARE;
    let mut seen = Vec::new();
    for way in ["planes", "frame"] {
        page.evaluate(&format!("yoro.stream.choose('{way}'); 0"));
        let mut of_way = [None, None];
        while of_way.contains(&None) {
            let before = page.evaluate("yoro.stream.frames").as_u64().unwrap();
            page.until(&format!("yoro.stream.frames > {before}"));
            if page.evaluate("yoro.stream.way") != way {
                continue;
            }
            let [_, right] = page.eyes([side; 2]);
            // The second shade is grey.
            let [r, g, b] = right.get_pixel(SQUARE * 3 / 2, SQUARE / 2).0;
            of_way[usize::from(r.abs_diff(g).max(g.abs_diff(b)) > 8)] = Some(right);
        }
        seen.push(of_way.map(Option::unwrap));
    }
    let center = |shade: u32| (shade % 16 * SQUARE + SQUARE / 2, shade / 16 * SQUARE + SQUARE / 2);
    for [gray, _] in &seen {
        for shade in 0..256 {
            let (x, y) = center(shade);
            assert_eq!(gray.get_pixel(x, y).0, [shade as u8; 3]);
        }
    }
    for shade in 0..256 {
        let (x, y) = center(shade);
        let [planes, frame] = [0, 1].map(|way: usize| seen[way][1].get_pixel(x, y).0);
        let worst = planes.iter().zip(frame).map(|(a, b)| a.abs_diff(b)).max();
        assert!(worst <= Some(2), "{planes:?} as planes, {frame:?} as the browser has it");
    }
    assert_eq!((page.message(), page.evaluate("yoro.page.takeErrors() ?? null")), (None, json!(null)));
    page.browser.expect_silence();
}
