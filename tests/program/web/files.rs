//! The user's own files.

use std::env;
use std::path::PathBuf;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use image::{DynamicImage, GrayImage, ImageFormat, Luma, Rgb, RgbImage};
use serde_json::{Value, json};
use yoro_media::{DepthImage, save_depth};
use yoro_test_support::glb;

use super::{Page, close, draw, sum};
use crate::program::succeed;

fn png(image: impl Into<DynamicImage>) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    image.into().write_to(&mut bytes, ImageFormat::Png).unwrap();
    bytes.into_inner()
}

const ROOM: &str = "mtllib room.mtl\nv -2 0 -4\nv 2 0 -4\nv 2 3 -4\nv -2 3 -4\nv -2 0 2\nv 2 0 2\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n\
                    usemtl wall\nf 1/1 2/2 3/3 4/4\nf 5/1 6/2 2/3 1/4\n";

/// Makes a JPEG of this size with a smaller embedded depth map, as in phones' portrait photos. The left is near.
fn portrait(size: [u32; 2]) -> Vec<u8> {
    let mut jpeg = std::io::Cursor::new(Vec::new());
    let color = RgbImage::from_fn(size[0], size[1], |x, y| Rgb([(x * 2) as u8, (y * 3) as u8, 90]));
    DynamicImage::from(color).write_to(&mut jpeg, ImageFormat::Jpeg).unwrap();
    let depth = STANDARD.encode(png(GrayImage::from_fn(6, 4, |x, _| Luma([(x * 40) as u8]))));
    let (first, second) = depth.split_at(depth.len() / 2);
    let xmp = |text: String| {
        let length = (text.len() + 2) as u16;
        [&[0xff, 0xe1][..], &length.to_be_bytes(), text.as_bytes()].concat()
    };
    let mut out = jpeg.get_ref()[..2].to_vec();
    let head =
        "GDepth:Format=\"RangeInverse\" GDepth:Near=\"0.5\" GDepth:Far=\"9\" GDepth:Mime=\"image/png\"";
    out.extend(xmp(format!("http://ns.adobe.com/xap/1.0/\0<rdf {head}/>")));
    // XMP that does not fit into one segment is split into parts, which may come in any order.
    let part = |offset: u8, text: &str| {
        let id = "0".repeat(32);
        xmp(format!("http://ns.adobe.com/xmp/extension/\0{id}\0\0\0\0\0\0\0{}{text}", char::from(offset)))
    };
    out.extend(part(9, &format!("{second}\"/>")));
    out.extend(part(0, &format!("<rdf GDepth:Data=\"{first}")));
    out.extend(&jpeg.get_ref()[2..]);
    out
}

/// Makes the same as Dynamic Depth: files behind the JPEG, listed in its directory.
fn dynamic_portrait(size: [u32; 2]) -> Vec<u8> {
    let jpeg = |image: DynamicImage| {
        let mut bytes = std::io::Cursor::new(Vec::new());
        image.write_to(&mut bytes, ImageFormat::Jpeg).unwrap();
        bytes.into_inner()
    };
    let color =
        jpeg(RgbImage::from_fn(size[0], size[1], |x, y| Rgb([(x * 2) as u8, (y * 3) as u8, 90])).into());
    let depth = jpeg(GrayImage::from_fn(6, 4, |x, _| Luma([(x * 40) as u8])).into());
    let sure = jpeg(GrayImage::from_pixel(6, 4, Luma([255])).into());
    let item = |length: usize, address: &str| {
        format!(
            "<rdf:li rdf:parseType=\"Resource\"><Container:Item Item:Mime=\"image/jpeg\" Item:Length=\"{length}\" Item:DataURI=\"{address}\"/></rdf:li>"
        )
    };
    let text = format!(
        "http://ns.adobe.com/xap/1.0/\0<x:xmpmeta><Container:Directory><rdf:Seq>{}{}{}</rdf:Seq></Container:Directory>\
         <Camera:DepthMap DepthMap:Format=\"RangeInverse\" DepthMap:Near=\"0.7\" DepthMap:Far=\"11\" DepthMap:DepthURI=\"android/depthmap\"/>\
         </x:xmpmeta>",
        item(0, "primary_image"),
        item(depth.len(), "android/depthmap"),
        item(sure.len(), "android/confidencemap"),
    );
    let length = ((text.len() + 2) as u16).to_be_bytes();
    [&color[..2], &[0xff, 0xe1], &length, text.as_bytes(), &color[2..], &depth, &sure].concat()
}

#[test]
fn dropped_files_are_shown_or_refused() {
    let Some(mut page) = Page::open("#display=left", None) else { return };
    let dropped = "const text = new DataTransfer(); text.setData('text/plain', 'words'); \
                   dispatchEvent(new DragEvent('drop', { dataTransfer: text, cancelable: true }))";
    assert_eq!(page.evaluate(dropped), json!(false), "the browser opens nothing");
    page.until("document.getElementById('message-text').textContent.includes('no file')");
    let texture = png(RgbImage::from_fn(8, 8, |x, y| Rgb([(x * 30) as u8, (y * 30) as u8, 90])));
    let mtl = b"newmtl wall\nKd 1 1 1\nmap_Kd bricks.png\n".to_vec();
    page.drop_files(&[("room.obj", ROOM.into()), ("room.mtl", mtl), ("bricks.png", texture)]);
    assert_eq!((page.message(), page.evaluate("yoro.facts.triangles")), (None, json!(4)));
    page.evaluate(&draw([48, 32]));
    page.drop_files(&[("one.glb", glb::triangle())]);
    assert_eq!((page.message(), page.evaluate("yoro.facts.triangles")), (None, json!(1)));

    // The user moves around a single object, unless walking is selected, but walks in a built-in scene.
    let walks = |page: &mut Page| {
        page.evaluate(
            "yoro.page.turn(0.2, 0); var before = [...yoro.page.place]; yoro.page.turn(0.2, 0); \
                       before.slice(0, 3).join() === [...yoro.page.place].slice(0, 3).join()",
        )
    };
    let orbit =
        "[document.getElementById('orbit').checked, document.getElementById('orbit').labels[0].hidden]";
    assert_eq!((page.evaluate(orbit), walks(&mut page)), (json!([true, false]), json!(false)));
    page.evaluate("document.getElementById('orbit').click()");
    assert_eq!(walks(&mut page), json!(true));

    // The list of scenes shows that the user's files are open. A link contains neither them nor a place in them. A
    // failed attempt changes nothing.
    let scene = "document.getElementById('scene').value";
    assert_eq!(page.evaluate(scene), "own");
    page.evaluate("yoro.page.walk(0, 0, 1); document.getElementById('share').click(); 0");
    let link = page.evaluate("location.hash");
    assert!(!link.as_str().unwrap().contains("at=") && !link.as_str().unwrap().contains("scene="), "{link}");
    page.evaluate("yoro.showSource({ builtin: 'nowhere' })");
    assert_eq!((page.message().is_some(), page.evaluate(scene)), (true, json!("own")));

    // The page shows pictures as `yoro synthesize` renders them.
    let size = [96u32, 64];
    let color = RgbImage::from_fn(size[0], size[1], |x, y| {
        Rgb([(x * 2) as u8, (y * 3) as u8, if x / 8 % 2 == y / 8 % 2 { 200 } else { 40 }])
    });
    let near = |x: u32, y: u32| (30..60).contains(&x) && (20..50).contains(&y);
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let gray = GrayImage::from_fn(size[0], size[1], |x, y| Luma([if near(x, y) { 200 } else { 20 }]));
    gray.save(path("depth.png")).unwrap();
    let metres = DepthImage::from_fn(size[0], size[1], |x, y| Luma([if near(x, y) { 0.7 } else { 4.0 }]));
    save_depth(&path("metres.exr"), &metres).unwrap();
    // A distance that 8 bits cannot store exactly.
    let tenths = DepthImage::from_fn(size[0], size[1], |x, y| Luma([if near(x, y) { 0.0713 } else { 0.4 }]));
    save_depth(&path("tenths-depth.png"), &tenths).unwrap();
    color.save(path("view.png")).unwrap();
    // The encoding of the depth is guessed from a brighter bottom, the file format, or 16 bits per value.
    for (depth, encoding, key, value) in [
        ("depth.png", "disparity", "disparity-scale", "12"),
        ("metres.exr", "metres", "metres-at-white", "3"),
        ("tenths-depth.png", "metres", "metres-at-white", "10"),
    ] {
        let files = ["view.png", depth].map(|name| (name, std::fs::read(path(name)).unwrap()));
        page.drop_files(&files);
        assert_eq!(page.message(), None, "{depth}");
        assert_eq!(page.evaluate("yoro.source.depth.name"), depth);
        assert_eq!(page.evaluate("document.getElementById('picture-encoding').value"), encoding, "{depth}");
        page.choose("picture-encoding", encoding);
        page.evaluate(&format!(
            "document.getElementById('picture-{key}').value = {value}; \
             document.getElementById('picture-options').dispatchEvent(new Event('change')); 0"
        ));
        assert_eq!(page.message(), None, "{depth}");
        let options = format!("--depth-encoding {encoding} --{key} {value}");
        succeed(
            folder.path(),
            &format!("synthesize --color view.png --depth {depth} --out left.png {options}"),
        );
        let desktop = image::open(path("left.png")).unwrap().into_rgb8();
        assert_ne!(desktop, color, "{depth}: something moves");
        close(depth, &page.eyes(size)[0], &desktop);
    }

    // Settings that do not apply to pictures cannot be changed.
    let without = "['method', 'viewpoint', 'msaa'].every((id) => document.getElementById(id).disabled)";
    assert_eq!(page.evaluate(without), json!(true));
    for (value, part) in
        [("''", Some("Metres at white: ")), ("1e30", Some("Metres at white: ")), ("10", None)]
    {
        page.evaluate(&format!(
            "document.getElementById('picture-metres-at-white').value = {value}; \
             document.getElementById('picture-options').dispatchEvent(new Event('change')); 0"
        ));
        let output = page.message();
        assert_eq!(output.is_some(), part.is_some(), "{value}");
        assert!(output.is_none_or(|output| output.starts_with(part.unwrap())), "{value}");
    }
    let hidden = "['near', 'far', 'disparity-scale'].every((key) => document.getElementById(`picture-${key}`).labels[0].hidden)";
    assert_eq!(page.evaluate(hidden), json!(true), "fields that distances have no use for");

    // The true image of the other eye is unknown, so instead of a difference the eye itself is shown.
    let synthesized = page.evaluate(&sum("left"));
    assert!(synthesized.as_u64().unwrap() > 0);
    assert_eq!(page.evaluate(&sum("difference")), synthesized);

    // Each of these invalid inputs is answered with one sentence, and the previous content stays.
    type Files<'a> = &'a [(&'a str, Vec<u8>)];
    let gray = |w, h| png(GrayImage::new(w, h));
    let broken: [(Files, &str); 7] = [
        (&[("a.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n".to_vec())], "a.obj"),
        (&[("a.glb", glb::triangle()[..30].to_vec())], "a.glb"),
        (
            &[(
                "a.gltf",
                b"{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"uri\":\"gone.bin\",\"byteLength\":9}]}"
                    .to_vec(),
            )],
            "gone.bin",
        ),
        (&[("a.png", gray(4, 4))], "One picture is not enough"),
        (&[("a.png", gray(4, 4)), ("b.png", gray(4, 4)), ("c.png", gray(4, 4))], "3 pictures are too many"),
        (&[("a.png", gray(4, 4)), ("a-depth.png", gray(5, 4))], "4x4"),
        (&[("a.txt", b"text".to_vec())], "neither a model"),
    ];
    for (files, part) in broken {
        page.drop_files(files);
        let output = page.message().unwrap_or_default();
        assert!(output.contains(part) && output.ends_with('.'), "{part}: {output}");
        assert_eq!(page.evaluate("Boolean(yoro.source.color)"), json!(true), "{part}: the pictures stay");
    }

    // A photo with an embedded depth map.
    page.drop_files(&[("portrait.jpg", portrait([96, 64]))]);
    assert_eq!((page.message(), page.evaluate("yoro.source.color.name")), (None, json!("portrait.jpg")));
    let fields = "['source', 'encoding', 'near', 'far'].map((key) => document.getElementById(`picture-${key}`).value).join()";
    assert_eq!(page.evaluate(fields), "center,standard-z,0.5,9");
    page.drop_files(&[("dynamic.jpg", dynamic_portrait([96, 64]))]);
    assert_eq!((page.message(), page.evaluate("yoro.source.color.name")), (None, json!("dynamic.jpg")));
    assert_eq!(page.evaluate(fields), "center,standard-z,0.7,11");
    let moved = page.eyes([96, 64]);
    assert_ne!(moved[0], moved[1], "something is near");

    // The page's own examples, then back to a built-in scene.
    page.evaluate("document.getElementById('example-pictures').click()");
    page.until("yoro.source.color?.name === 'example-color.jpg'");
    assert_eq!(
        (page.message(), page.evaluate("document.getElementById('picture-encoding').value")),
        (None, json!("standard-z"))
    );
    page.evaluate("document.getElementById('example-model').click()");
    page.until("yoro.source.main === 'example.obj'");
    assert_eq!((page.message(), page.evaluate("yoro.wanted")), (None, Value::Null));
    page.choose("scene", "prototype");
    page.until("yoro.source.builtin === 'prototype'");
    assert_eq!((page.evaluate(orbit), walks(&mut page)), (json!([false, true]), json!(true)));
    page.browser.expect_silence();

    // If the page is opened as a file, it says what to do.
    let xtask = PathBuf::from(env::var_os("YORO_TEST_WEB").unwrap());
    let folder = xtask.ancestors().nth(2).unwrap().join("web");
    page.browser.open(&folder.join("index.html"));
    page.until("!document.getElementById('message').hidden");
    assert!(page.message().unwrap().contains("serve its folder"));

    // It carries the licences of what is in its module and in the example beside it.
    let notices = std::fs::read_to_string(folder.join("NOTICES.txt")).unwrap();
    for name in ["\n  wasm-bindgen ", "\nrqrr ", "\nthree.js"] {
        assert!(notices.contains(name), "{name}: {notices}");
    }
}
