//! A measurement on the page, and its report.

use serde_json::json;

use super::Page;
use crate::program::succeed;

#[test]
fn a_measurement_is_reported() {
    let Some(mut page) = Page::open("#display=left&msaa=1", None) else { return };
    page.evaluate(
        "document.getElementById('measure-size').append(new Option('64x48')); \
         document.getElementById('measure-seconds').append(new Option('4', 4)); 0",
    );
    page.choose("measure-size", "64x48");
    page.choose("measure-seconds", "4");
    let places = "JSON.stringify(['own', 'phone-viewer', 'headset'].map((id) => document.getElementById(id).getBoundingClientRect()))";
    let before = page.evaluate(places);
    page.evaluate("document.getElementById('measure').click()");
    page.until("yoro.busy !== null || yoro.measured !== undefined");
    // Settings that affect the measurement cannot be changed meanwhile, neither by controls nor by links.
    for id in ["scene", "msaa", "ipd", "dominant", "measure-size", "files"] {
        let locked = format!("document.getElementById('{id}').matches(':disabled')");
        assert_eq!(page.evaluate(&locked), json!(true), "{id}");
    }
    page.evaluate("location.hash = '#scene=talk&ipd=0'; 0");
    page.until("document.getElementById('message-text').textContent.includes('stop it first')");
    page.evaluate("yoro.clear()");
    page.until("yoro.busy === null");
    assert_eq!((page.message(), page.evaluate("yoro.settings.ipd")), (None, json!(63)));
    assert_eq!(page.evaluate(places), before, "the panels stay where they are");
    // Stopping a second measurement keeps the results of the first.
    page.evaluate("document.getElementById('measure').click(); document.getElementById('measure').click()");
    page.until("yoro.busy === null");
    assert_eq!(page.evaluate("document.getElementById('measure-save').hidden"), json!(false));
    let table = page.evaluate("document.querySelector('#measure-result table').innerText");
    let table = table.as_str().unwrap();
    assert!(
        table.contains("yoro-gather") && table.contains("100 %") && table.contains("not told"),
        "{table}"
    );
    page.browser.expect_silence();
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("web.jsonl"), page.evaluate("yoro.measured").as_str().unwrap())
        .unwrap();
    drop(page);
    succeed(folder.path(), "report web.jsonl");
    let results = std::fs::read_to_string(folder.path().join("out/report.md")).unwrap();
    for part in ["prototype", "yoro-gather", "shading-reprojection", "multiview"] {
        assert!(results.contains(part), "{part}: {results}");
    }
    assert!(!results.contains("Image quality"), "the page measures none: {results}");
}
