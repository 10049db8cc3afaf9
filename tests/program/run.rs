//! `yoro run`.

use std::fs;

use crate::browser::{Browser, check_report_with_pictures};
use crate::program::{run, succeed};

#[test]
fn a_report_of_every_method() {
    let dir = tempfile::tempdir().unwrap();
    let said = succeed(dir.path(), "run prototype --pipelines gather,paper --size 96x96").stdout;
    for needed in
        ["the first picture: out/prototype.yoro-paper.png", "conventional", "yoro-gather", "out/report.html"]
    {
        assert!(said.contains(needed), "{needed}: {said}");
    }
    for contender in ["conventional", "yoro-gather", "yoro-paper"] {
        let pair =
            yoro_media::load_color(&dir.path().join(format!("out/prototype.{contender}.png"))).unwrap();
        assert_eq!(pair.dimensions(), (192, 96), "{contender}");
    }
    let page = fs::read_to_string(dir.path().join("out/report.html")).unwrap();
    assert!(page.contains("data:image/"), "no pictures in the page");
    for outside in ["src=\"http", "href=\"http://", "url(http", "<link", "src=\"/", "@import"] {
        assert!(!page.contains(outside), "the page needs {outside}");
    }
    if let Some(mut browser) = Browser::start() {
        check_report_with_pictures(&mut browser, &dir.path().join("out/report.html"));
    }
}

/// Two triangles around the origin.
const SQUARE: &str = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n";

/// On an empty view every method would be perfect.
#[test]
fn a_view_of_nothing_is_not_measured() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("square.obj"), SQUARE).unwrap();
    let views =
        r#"[{"position": [0, 0, 5], "target": [0, 0, 0]}, {"position": [0, 0, 5], "target": [0, 0, 9]}]"#;
    fs::write(dir.path().join("square.camera.json"), views).unwrap();
    let refused = ["viewpoint 1 of square shows nothing", "square.camera.json"];
    run(dir.path(), "run square.obj --size 64 --viewpoints 2 --pipelines gather").refuses(&refused);
    run(dir.path(), "bench scenes --quick --scene square.obj --viewpoints 2 --size 64").refuses(&refused);
    let rendered = succeed(dir.path(), "render square.obj --size 64 --pose 1 --outputs left");
    assert!(rendered.stderr.contains("1 of 1 frames of square show nothing"), "{}", rendered.stderr);
    let rendered = succeed(dir.path(), "render square.obj --size 64 --pose 0 --outputs left");
    assert_eq!(rendered.stderr, "");
}
