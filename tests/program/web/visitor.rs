//! What the page tells visitors: which method is cheaper on their device, and why synthesis works. Also scans a
//! viewer's code.

use std::io::Write as _;
use std::path::Path;

use qrcode::{Color, QrCode};
use serde_json::{Value, json};

use super::{GL, Page};

/// The code of a viewer that was given away in 2015.
const VIEWER: &str = "https://google.com/cardboard/cfg?p=CgZHb29nbGUSEkNhcmRib2FyZCBJL08gMjAxNR0J-SA9JQHegj0qEAAAcEIAAHBCAABwQgAAcEJYADUpXA89OghX8as-YrENP1AAYAM";
/// Width and height of the camera's picture in pixels.
const CAMERA: [usize; 2] = [640, 480];

/// Writes the picture of a QR code for Chromium's simulated camera, as a Y4M file with one frame.
fn film(path: &Path, text: &str) {
    let code = QrCode::new(text).unwrap();
    let (modules, colors) = (code.width(), code.to_colors());
    let side = 5;
    let [width, height] = CAMERA;
    let corner = CAMERA.map(|n| (n - side * modules) / 2);
    let luma = (0..width * height).map(|i| {
        let at = [i % width, i / width];
        let inside = (0..2).all(|axis| (corner[axis]..corner[axis] + side * modules).contains(&at[axis]));
        let module = || (0..2).map(|axis| (at[axis] - corner[axis]) / side).collect::<Vec<_>>();
        let is_dark = inside && {
            let module = module();
            colors[module[1] * modules + module[0]] == Color::Dark
        };
        if is_dark { 40 } else { 210 }
    });
    let mut file = std::fs::File::create(path).unwrap();
    write!(file, "YUV4MPEG2 W{width} H{height} F10:1 Ip A1:1 C420jpeg\nFRAME\n").unwrap();
    file.write_all(&luma.collect::<Vec<u8>>()).unwrap();
    file.write_all(&vec![128; width * height / 2]).unwrap();
}

#[test]
fn a_visitor_is_told_what_is_cheaper_and_why() {
    let folder = tempfile::tempdir().unwrap();
    let camera = folder.path().join("camera.y4m");
    film(&camera, VIEWER);
    let capture = format!("--use-file-for-fake-video-capture={}", camera.display());
    let seen = ["--use-fake-ui-for-media-stream", "--use-fake-device-for-media-stream", &capture];
    let options: Vec<&str> = GL.into_iter().chain(seen).collect();
    let Some(mut page) = Page::open_with(&options, "#scale=0.5", None) else { return };

    // A comparison shows both of its methods. A picture alone is drawn by the cheaper method, once both are measured.
    let method = "[yoro.settings.method, yoro.page.methodInUse, yoro.page.reason ?? null]";
    assert_eq!(page.evaluate(method), json!(["auto", "yoro", null]));
    page.browser.resize(320, 300);
    page.choose("display", "side-by-side");
    page.until(
        "/^auto:\\w+ \\d+\\.\\d\\/\\d+\\.\\dms\\. /.test(document.getElementById('figures').textContent)",
    );
    let costs = page.evaluate("[...yoro.page.costs]");
    let [two, one] = [0, 1].map(|i| costs[i].as_f64().unwrap());
    let cheaper = if two < one { "conventional" } else { "yoro" };
    assert_eq!(page.evaluate("yoro.page.methodInUse"), cheaper, "{costs}");
    let output = page.evaluate("document.getElementById('figures').textContent");
    let output = output.as_str().unwrap();
    assert_eq!(output.contains("Two renders are cheaper"), two <= one, "{output}");
    page.until("!document.getElementById('label-left').hidden");
    let label = page.evaluate("document.getElementById('label-left').textContent");
    assert_eq!(label, if two < one { "Left eye: rendered" } else { "Left eye: synthesized" });
    // Nothing is drawn while nothing moves. Another place requires another choice.
    let frames = "new Promise((done) => { const draw = yoro.page.draw; let frames = 0; \
                  yoro.page.draw = function(...all) { frames++; return draw.apply(this, all); }; \
                  setTimeout(() => { delete yoro.page.draw; done(frames); }, 300); })";
    assert_eq!(page.evaluate(frames), 0);
    // If frames come too slowly to measure, the page says so, and does not draw more of them.
    page.evaluate(
        "import([...document.querySelectorAll('link[rel=modulepreload]')].find(({ href }) => href.endsWith('figures.js')).href)\
         .then(({ choosing }) => { yoro.choosing = choosing; return 0; })",
    );
    page.choose("viewpoint", "1");
    page.until(
        "yoro.page.isMeasuring && !yoro.choosing(true) \
         && document.getElementById('figures').textContent.includes('longer than a second')",
    );
    page.choose("display", "divider");
    assert_eq!(page.evaluate(method), json!(["auto", "yoro", null]));

    // The sentence below the divider is consistent: the share follows from its times, and the baseline is named.
    page.until("document.getElementById('figures').textContent.includes('the same image to both eyes')");
    let numbers = page.evaluate(
        "document.getElementById('figures').textContent.match(/[\\d.]+(?= %| ms| dB)/g).map(Number)",
    );
    let numbers: Vec<f64> =
        numbers.as_array().unwrap().iter().map(|number| number.as_f64().unwrap()).collect();
    let [share, made, real, psnr, same] = numbers[..] else { panic!("{numbers:?}") };
    assert!((100.0 * made / real - share).abs() < 2.0, "{numbers:?}");
    assert!(psnr > same, "{numbers:?}");

    // Four pictures explain the reason, once they are visible.
    assert_eq!(page.evaluate("document.getElementById('why-holes').textContent"), "");
    page.evaluate("document.getElementById('why').scrollIntoView()");
    page.until("document.getElementById('why-holes').textContent !== ''");
    let share = |which: usize, test: &str| {
        format!(
            "(() => {{ const c = document.querySelectorAll('#why canvas')[{which}]; \
             const {{ data }} = c.getContext('2d').getImageData(0, 0, c.width, c.height); let n = 0; \
             for (let i = 0; i < data.length; i += 4) n += Number((([r, g, b]) => {test})(data.subarray(i, i + 3))); \
             return n / (data.length / 4); }})()"
        )
    };
    let mut part = |which, test| page.evaluate(&share(which, test)).as_f64().unwrap();
    let [gray, black, colored] = ["r === g && g === b", "r + g + b === 0", "r !== g || g !== b"];
    assert!(part(0, colored) > 0.3, "the rendered eye has its colours");
    assert_eq!(part(1, gray), 1.0, "depth is grey");
    let holes = part(2, black);
    assert!((0.001..0.2).contains(&holes), "{holes}");
    let filled = part(3, colored);
    assert!(
        filled > 0.2 * holes && filled <= holes,
        "what is filled, and nothing else, has its colour: {filled}"
    );
    let output = page.evaluate("Number(document.getElementById('why-holes').textContent)").as_f64().unwrap();
    assert!((output / 100.0 - holes).abs() < 0.001, "{output} % is not {holes}");
    assert_eq!((page.message(), page.evaluate("yoro.page.takeErrors() ?? null")), (None, Value::Null));

    // Both eyes in turn are saved as an animation.
    let saved = page.evaluate(
        "(async () => { const make = URL.createObjectURL; let blob; \
         URL.createObjectURL = (b) => { blob = b; return make.call(URL, b); }; \
         document.getElementById('wiggle').click(); URL.createObjectURL = make; \
         const { width, height } = await createImageBitmap(blob); return [blob.type, width, height]; })()",
    );
    let size = page.evaluate("[yoro.canvas.width, yoro.canvas.height]");
    assert_eq!(saved, json!(["image/gif", size[0], size[1]]));

    // The camera reads the viewer's code, which is stored.
    page.evaluate("document.getElementById('phone-scan').click(); 0");
    page.until("document.getElementById('phone-viewer').value.startsWith('https')");
    let kept = "[document.getElementById('phone-viewer').value, localStorage.getItem('viewer'), document.getElementById('scan').open]";
    assert_eq!(page.evaluate(kept), json!([VIEWER, VIEWER, false]));
    let name = page.evaluate("document.getElementById('phone-name').textContent");
    assert!(name.as_str().unwrap().contains("Cardboard"), "{name}");
    assert_eq!(page.message(), None);

    // The link contains everything that was selected, including the divider's position.
    page.evaluate(
        "const d = document.getElementById('divider'); d.value = 30; d.dispatchEvent(new Event('change')); 0",
    );
    page.until("location.hash === '#viewpoint=1&divider=30&scale=0.5'");
    page.browser.expect_silence();
}
