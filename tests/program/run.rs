//! `yoro run`.

use std::fs;

use crate::browser::{Browser, check_page};
use crate::program::succeed;

#[test]
fn a_report_of_every_method() {
    let dir = tempfile::tempdir().unwrap();
    let json = succeed(dir.path(), "run prototype --viewpoints 1 --size 96x96 --json").json();
    let scene = &json["scenes"][0];
    assert!(scene.to_string().contains("prototype"), "{json:#}");
    for method in ["conventional", "gather", "rowgroup", "paper"] {
        assert!(scene.to_string().to_lowercase().contains(method), "{method}: {json:#}");
    }
    let page = fs::read_to_string(dir.path().join("out/report.html")).unwrap();
    assert!(page.contains("data:image/"), "no pictures in the page");
    for outside in ["src=\"http", "href=\"http://", "url(http", "<link", "src=\"/", "@import"] {
        assert!(!page.contains(outside), "the page needs {outside}");
    }
    if let Some(mut browser) = Browser::start() {
        check_page(&mut browser, &dir.path().join("out/report.html"));
    }
}
