//! A visit to the page: links, displays, lost contexts, a viewer, no network.

use std::time::Duration;

use serde_json::{Value, json};

use super::{Page, draw};

/// A script that makes the page's second load receive the module with a MIME type that browsers do not stream.
const WRONG_TYPE: &str = "if (location.search === '?again') {
    const ask = fetch;
    globalThis.fetch = async (...what) => {
        const answer = await ask(...what);
        return new Response(answer.body, { headers: { 'Content-Type': 'application/octet-stream' } });
    };
}";

#[test]
fn a_link_sets_everything_and_the_page_lasts() {
    let fragment =
        "#viewpoint=2&method=hybrid&msaa=1&holes=rendered&ipd=70&dominant=left&display=anaglyph&scale=0.5";
    let Some(mut page) = Page::open(fragment, Some(WRONG_TYPE)) else { return };
    let shown = "['viewpoint', 'method', 'msaa', 'holes', 'ipd', 'dominant', 'display', 'scale'].map((id) => \
                 document.getElementById(id).value).join()";
    assert_eq!(page.evaluate(shown), "2,hybrid,1,rendered,70,left,anaglyph,0.5");
    assert_eq!(page.message(), None);
    page.until("performance.getEntriesByName('first-picture').length === 1");
    let first = page.evaluate("performance.getEntriesByName('first-picture')[0].startTime");
    eprintln!("first picture after {:.0} ms", first.as_f64().unwrap());
    // The walked distance is stored in the link.
    page.evaluate("document.getElementById('canvas').focus()");
    page.browser.hold("KeyW", Duration::from_millis(300));
    page.until("location.hash.includes('at=')");
    let fragment = page.evaluate("location.hash");
    assert!(fragment.as_str().unwrap().contains("method=hybrid"), "{fragment}");

    // A default is left out of the link. An unsupported choice is refused, and the previous one stays.
    page.choose("msaa", "4");
    page.until("location.hash.includes('ipd=70') && !location.hash.includes('msaa')");
    page.evaluate("document.getElementById('msaa').append(new Option('2')); 0");
    page.choose("msaa", "2");
    assert!(page.message().unwrap().contains("samples"));
    assert_eq!(page.evaluate("yoro.settings.msaa"), 4);
    page.evaluate(&draw([64, 48]));
    assert_eq!(page.evaluate("yoro.page.takeErrors() ?? null"), Value::Null);

    // Every display draws, also after the page has been turned and resized as on a phone.
    for display in
        ["side-by-side", "cross-eyed", "left", "right", "divider", "difference", "flicker", "anaglyph"]
    {
        page.choose("display", display);
        page.evaluate("yoro.page.draw(64, 48, 0.5)");
        page.until("!document.getElementById('label-left').hidden");
    }
    for (width, height) in [(390, 844), (844, 390), (320, 500), (1000, 900)] {
        page.browser.resize(width, height);
        page.until("Math.abs(yoro.canvas.width - yoro.canvas.clientWidth * 0.5) <= 1");
        // Errors are visible where the user has scrolled to, whatever their length, and do not move the page.
        let seen = "(() => { scrollTo(0, 1e6); const before = document.body.scrollHeight; yoro.say('x'.repeat(300)); \
                    const b = document.getElementById('message').getBoundingClientRect(); \
                    const moved = document.body.scrollHeight - before; \
                    return moved === 0 && b.top >= 0 && b.bottom <= innerHeight && b.height > 20; })()";
        assert_eq!(page.evaluate(seen), json!(true), "{width}x{height}");
        let wide = page.evaluate("document.documentElement.scrollWidth");
        assert!(wide.as_u64().unwrap() <= u64::from(width), "{wide} pixels wide in a window of {width}");
    }
    page.evaluate("document.getElementById('message-close').click()");
    assert_eq!(page.message(), None);

    // Controls have labels. A missing feature is explained for browsers.
    assert_eq!(page.evaluate("document.getElementById('ipd').labels[0].textContent"), "Eyes apart");
    let reason = page.evaluate("document.querySelector('#method [value=multiview]').title");
    assert!(!reason.as_str().unwrap().contains("Mesa"), "{reason}");

    // The copied link contains everything. After it is followed, an earlier error is no longer shown.
    let facts = page.evaluate("document.getElementById('facts').textContent");
    assert!(facts.as_str().unwrap().contains("23,558 triangles"), "{facts}");
    page.evaluate("document.getElementById('share').click()");
    page.evaluate("location.hash = '#nonsense=1'; 0");
    page.until("document.getElementById('message-text').textContent.includes('nonsense')");
    page.evaluate("location.hash = '#display=left&scale=0.5'; 0");
    page.until("document.getElementById('message').hidden");
    assert_eq!(page.evaluate("document.getElementById('facts').textContent"), facts);

    // The page shows progress while a scene is generated.
    let output = page.evaluate(
        "(async () => { const bar = document.getElementById('progress'), seen = []; \
         const watch = new MutationObserver(() => seen.push(bar.position)); watch.observe(bar, { attributes: true }); \
         await yoro.showSource({ builtin: 'conference' }); watch.disconnect(); return seen; })()",
    );
    let output: Vec<f64> = output.as_array().unwrap().iter().map(|part| part.as_f64().unwrap()).collect();
    let parts: Vec<f64> = output.into_iter().filter(|part| *part >= 0.0).collect();
    assert!(
        parts.len() > 5 && parts.is_sorted() && parts[0] < 0.5 && parts[parts.len() - 1] > 0.9,
        "{parts:?}"
    );
    page.evaluate("yoro.showSource({ builtin: 'prototype' })");

    // A thousand frames use the same number of objects as ten.
    let frames = |count: u32| {
        format!(
            "(() => {{ for (let i = 0; i < {count}; i++) {{ yoro.page.turn(0.01, 0); yoro.page.draw(32, 24, false); }} \
                 return [...yoro.page.held]; }})()"
        )
    };
    page.choose("method", "yoro");
    for samples in ["1", "4"] {
        page.choose("msaa", samples);
        let before = page.evaluate(&frames(10));
        for _ in 0..5 {
            assert_eq!(page.evaluate(&frames(100)), before);
        }
    }

    // The context is lost and restored with the scene.
    page.evaluate("yoro.lose = yoro.gl.getExtension('WEBGL_lose_context'); yoro.lose.loseContext(); 0");
    page.until("yoro.page === null");
    assert!(page.message().unwrap().contains("lost"));
    page.evaluate("yoro.lose.restoreContext(); 0");
    page.until("yoro.page !== null && document.getElementById('loading').hidden");
    assert_eq!(page.message(), None);
    page.evaluate(&draw([32, 24]));
    assert_eq!(page.evaluate("yoro.page.takeErrors() ?? null"), Value::Null);
    page.browser.expect_silence();

    // An invalid viewer or screen is marked at its field, and the viewer mode does not start.
    page.evaluate("Object.defineProperty(screen, 'width', { value: 844 }); Object.defineProperty(screen, 'height', { value: 390 }); 0");
    for (id, value, part) in [
        ("phone-viewer", "goo.gl/abc", "shortened"),
        ("phone-viewer", "V1", "no viewer"),
        ("phone-width", "60", "2.8 cm"),
    ] {
        let field = format!("document.getElementById('{id}')");
        let before = page.evaluate(&format!("{field}.value"));
        page.evaluate(&format!("{field}.value = '{value}'"));
        let output =
            page.evaluate(&format!("document.getElementById('phone').click(); {field}.validationMessage"));
        assert!(output.as_str().unwrap().contains(part), "{value}: {output}");
        assert_eq!((page.evaluate("yoro.busy"), page.message()), (Value::Null, None), "{value}");
        page.evaluate(&format!("{field}.value = {before}; {field}.dispatchEvent(new Event('input')); 0"));
    }

    // In the viewer mode, the page says how to hold the phone, is turned by the sensors, and can be left again.
    page.choose("method", "yoro");
    page.evaluate("document.getElementById('phone').click()");
    page.until("yoro.busy?.name === 'phone'");
    let over = "['divider', 'label-left', 'label-right'].some((id) => document.getElementById(id).checkVisibility())";
    assert_eq!(page.evaluate(over), json!(false), "nothing of the page lies over the eyes");
    page.browser.resize(300, 640);
    page.until("!document.getElementById('phone-upright').hidden");
    page.browser.resize(640, 300);
    page.until("yoro.canvas.width === 640 && document.getElementById('phone-upright').hidden");
    page.until("document.getElementById('message-text').textContent.includes('sensors')");
    page.evaluate("dispatchEvent(new DeviceOrientationEvent('deviceorientation', { alpha: 150, beta: 0, gamma: -90 })); yoro.clear(); 0");
    page.evaluate("document.getElementById('measure').click()");
    assert!(page.message().unwrap().contains("leave it first"));
    page.evaluate("yoro.clear(); document.getElementById('phone-leave').click()");
    page.until("yoro.busy === null && document.fullscreenElement === null");
    assert_eq!(page.message(), None);
    page.browser.expect_silence();

    // Invalid parts of a link are reported, and the rest is applied, even if another scene is selected while the first
    // one loads. A wrong MIME type of the module does not matter.
    let link = "?again#scene=conference&viewpoint=1&ipd=%20&method=none&size=3&msaa=3&toString=1&__proto__=1&at=1e9,,0,0,0";
    page.browser.go(&format!("{}{link}", page.server.address));
    page.until("globalThis.yoro?.wanted?.builtin === 'conference'");
    let output = page.message().unwrap();
    for part in [
        "ipd is “ ”",
        "method is “none”",
        "“size”",
        "msaa is “3”",
        "“toString”",
        "“__proto__”",
        "place is “1e9",
    ] {
        assert!(output.contains(part), "{part}: {output}");
    }
    page.choose("scene", "prototype");
    page.until("yoro.ready === true");
    page.until("yoro.source?.builtin === 'prototype' && yoro.wanted === null");
    page.evaluate("location.hash = '#viewpoint=98&display=left'; 0");
    page.until("document.getElementById('message-text').textContent.includes('viewpoint is 99')");

    // Once loaded, the page needs no network, under any of its names. A network that never answers counts as none.
    page.until("navigator.serviceWorker.controller !== null");
    page.until("caches.match(performance.getEntriesByType('resource').find(({ name }) => name.endsWith('wasm')).name).then(Boolean)");
    page.server.fall_silent();
    page.go_and_lose("index.html?offline#viewpoint=3&display=left");
    assert_eq!((page.message(), page.evaluate("yoro.settings.viewpoint")), (None, json!(3)));
}
