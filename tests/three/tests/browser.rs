//! The package for three.js in Chromium: pictures against three's own stereo, emulated headsets, and what frames leave.

use std::fs;
use std::path::Path;

use glam::{Mat4, Quat, Vec3};
use rand::{Rng, SeedableRng};
use serde_json::{Value, json};

use yoro::eyes::{DepthConvention, DepthRange, Eye, EyePair, Frustum, GuardBand, Pose};
use yoro::synthesis::Uniforms;
use yoro_test_support::browser::Browser;
use yoro_three_tests::{emulator, modules, open};

const NEWEST: &str = "/test/page.html";
const OLDEST: &str = "/test/page.html?three=three-oldest";

fn page(address: &str, before: &str) -> Option<Browser> {
    open(&modules()?, Path::new("none"), address, before)
}

/// Fails if a script threw or the console says anything but what reading pictures back causes.
fn expect_nothing_but_reading(browser: &mut Browser) {
    browser.expect_silence_but("ReadPixels");
}

fn number(value: &Value, name: &str) -> f64 {
    value[name].as_f64().unwrap_or_else(|| panic!("{name} of {value}"))
}

/// Checks a picture: it is synthesized, its rendered eye is three's own, and the other one is as good as `psnr` and
/// `ssim` say, and better than the same image to both eyes by `better`, in dB.
#[track_caller]
fn is_good(value: &Value, [psnr, ssim, better]: [f64; 3]) {
    println!("{value}");
    assert_eq!(
        (&value["trouble"], &value["way"], &value["error"]),
        (&json!(null), &json!("synthesized"), &json!(0))
    );
    assert!(number(value, "own") > 30.0, "the rendered eye: {value}");
    assert!(number(value, "psnr") >= psnr && number(value, "ssim") >= ssim, "{value}");
    assert!(number(value, "psnr") >= number(value, "same") + better, "{value}");
}

/// Random eyes, as cameras of three's: the uniforms are the core's.
#[test]
fn the_uniforms_are_those_of_the_core() {
    let mut random = rand_pcg::Pcg32::seed_from_u64(5);
    let mut cases = Vec::new();
    let mut wanted = Vec::new();
    for i in 0..60 {
        let reversed = i % 3 == 0;
        let convention = if reversed { DepthConvention::Reversed } else { DepthConvention::Standard };
        let depth = DepthRange {
            near: random.random_range(0.05..0.5),
            far: random.random_range(10.0..1000.0),
            convention,
        };
        let size = [random.random_range(60..900), random.random_range(60..900)];
        let dominant = if i % 2 == 0 { Eye::Right } else { Eye::Left };
        let turn = Quat::from_euler(
            glam::EulerRot::YXZ,
            random.random_range(-3.0..3.0),
            random.random_range(-1.0..1.0),
            0.3,
        );
        let head = Pose { position: Vec3::new(random.random_range(-5.0..5.0), 1.6, 2.0), orientation: turn };
        let [outer, inner, up, down] = [0; 4].map(|_| random.random_range(0.5..1.4f32));
        let frustum = Frustum { left: -outer, right: inner, bottom: -down, top: up };
        let ipd = random.random_range(0.0..0.08);
        let mut pair = EyePair::parallel(head, frustum, ipd, depth, size, dominant);
        if i % 4 > 1 {
            pair.frusta[1] = Frustum { left: -inner, right: outer, ..frustum };
        }
        let guard_band = if i % 5 == 0 { 0.0 } else { random.random_range(0.4..3.0f32) };
        let guard = if guard_band > 0.0 { GuardBand::Distance(guard_band) } else { GuardBand::None };
        let views = pair.synthesis_views(guard).unwrap();
        let port = [random.random_range(0..700), random.random_range(0..9)];
        let (c, m) = depth.inverse_distance_law();
        let cameras = Eye::BOTH.map(|eye| {
            let view = pair.view(eye);
            let mut projection = view.projection().to_cols_array();
            if reversed {
                // Clip space from 0 to 1, as three has it then.
                (projection[10], projection[14]) = ((c / m) as f32, (1.0 / m) as f32);
            }
            let pose =
                Mat4::from_rotation_translation(view.pose.orientation, view.pose.position).to_cols_array();
            (pose, projection)
        });
        let viewport = [port[0], port[1], size[0], size[1]];
        cases.push(json!({
            "poses": cameras.map(|(pose, _)| pose), "projections": cameras.map(|(_, projection)| projection),
            "viewports": [viewport, viewport], "rendered": dominant.index(), "guardBand": guard_band, "reversed": reversed,
        }));
        wanted.push((Uniforms::new(&views.warp, port), views));
    }
    let Some(mut browser) = page(NEWEST, "") else { return };
    let got = browser.evaluate(&format!("check.views({})", Value::from(cases)));
    for (got, (want, views)) in got.as_array().unwrap().iter().zip(&wanted) {
        assert!(got.is_object(), "{got}: {views:?}");
        let u = &got["uniforms"];
        let list = |value: &Value| -> Vec<f64> {
            match value {
                Value::Array(all) => all.iter().map(|each| each.as_f64().unwrap()).collect(),
                Value::Bool(is) => vec![f64::from(u8::from(*is))],
                one => vec![one.as_f64().unwrap()],
            }
        };
        let size = views.source.size.map(f64::from);
        assert_eq!(list(&got["size"]), size, "{views:?}");
        let ints = |v: glam::IVec2| vec![f64::from(v.x), f64::from(v.y)];
        let pair = |v: glam::Vec2| vec![f64::from(v.x), f64::from(v.y)];
        for (name, want) in [
            ("source_size", ints(want.source_size)),
            ("target_size", ints(want.target_size)),
            ("mirrored", vec![f64::from(want.mirrored)]),
            ("row_offset", vec![f64::from(want.row_offset)]),
            ("target_origin", ints(want.target_origin)),
            ("law", pair(want.law)),
            ("far_displacement", vec![f64::from(want.far_displacement)]),
            ("near_displacement", vec![f64::from(want.near_displacement)]),
            ("columns", pair(want.columns)),
            ("origins", pair(want.origins)),
            ("span_place", want.span_place.to_array().map(f64::from).to_vec()),
            ("rows", pair(want.rows)),
            ("first_row", vec![f64::from(want.first_row)]),
            ("farthest", vec![f64::from(want.farthest)]),
            ("texel", pair(want.texel)),
        ] {
            for (got, want) in list(&u[name]).into_iter().zip(want) {
                // Displacements are differences of large numbers, here of matrices in f32.
                assert!(
                    (got - want).abs() <= 2e-3 + 1e-5 * want.abs(),
                    "{name}: {got}, not {want}: {views:?}"
                );
            }
        }
    }
    browser.expect_silence();
}

#[test]
fn scenes_are_like_threes_own_stereo() {
    let Some(mut browser) = page(NEWEST, "") else { return };
    // PSNR in dB, SSIM, and how much better than the same image to both eyes.
    let floors = json!({
        "cubes": [27, 0.93, 9], "balls": [28, 0.94, 9], "coaster": [30, 0.96, 10], "clearcoat": [29, 0.95, 8],
        "teapots": [33, 0.97, 12], "glass": [33, 0.97, 12], "transmission": [32, 0.96, 8], "mirror": [33, 0.97, 12],
        "street": [33, 0.96, 9], "garden": [40, 0.99, 10],
    });
    let names = browser.evaluate("check.names");
    assert_eq!(names.as_array().unwrap().len(), 10);
    for name in names.as_array().unwrap() {
        let value =
            browser.evaluate(&format!("check.compare({{ scene: {name}, renderer: {{ antialias: true }} }})"));
        let floor = &floors[name.as_str().unwrap()];
        is_good(&value, [0, 1, 2].map(|i| floor[i].as_f64().unwrap()));
        assert!(number(&value, "calls") < number(&value, "callsOwn") + 3.0, "{value}");
    }
    // Materials that ask the renderer for its viewport or its size: lines are as wide as three's own.
    for what in ["{}", "{ deep: true }"] {
        let value = browser.evaluate(&format!("check.lines({what})"));
        is_good(&value, [28.0, 0.96, 10.0]);
        assert!(number(&value, "own") > 50.0, "the rendered eye: {value}");
    }
    let behind = browser.evaluate("check.behind()");
    for (name, floor) in
        [("panorama", [29.0, 0.95, 12.0]), ("half", [29.0, 0.93, 7.0]), ("filled", [29.0, 0.95, 10.0])]
    {
        println!("behind everything: {name}");
        is_good(&behind[name], floor);
        assert!(number(&behind[name], "own") > 36.0, "the rendered eye: {}", behind[name]);
    }
    let models = "check.controllers(check.rendererOf(512, 256, { antialias: true }))\
                  .then((scene) => check.compare({ scene, renderer: { antialias: true } }))";
    is_good(&browser.evaluate(models), [34.0, 0.98, 10.0]);
    expect_nothing_but_reading(&mut browser);
}

/// Each session has a page of its own, since the emulated headset is part of it.
#[test]
fn headsets_show_what_three_would_have_shown() {
    let (Some(modules), Some(emulator)) = (modules(), emulator()) else { return };
    let script = |path: &Path| fs::read_to_string(path).unwrap();
    let emulator = script(&emulator);
    let layers = script(&modules.join("webxr-layers-polyfill/build/webxr-layers-polyfill.js"));
    let completed = script(&yoro_three_tests::package().join("test/headset.js"));
    let session = |address: &str, headset: Value, what: &str| {
        let layers = if headset["hasLayers"] == true { layers.as_str() } else { "" };
        let before = format!("{emulator}\n{layers}\n{completed}\ninstallHeadset({headset});");
        let mut browser = page(address, &before)?;
        let result = browser.evaluate(&format!("check.session({what})"));
        browser.expect_no_error();
        assert_eq!(result["states"], 1, "frames leave what they found: {result}");
        Some(result)
    };
    // As Quest 3's displays are, with rendered holes.
    let quest = json!({ "size": 256, "skew": 0.2425, "lift": -0.125 });
    let what = "{ scene: 'street', options: { samples: 4, foveation: 'off', holes: 'rendered' } }";
    let Some(value) = session(NEWEST, quest.clone(), what) else { return };
    is_good(&value, [32.0, 0.96, 10.0]);
    assert_eq!(value["foveation"], 0, "three's own is set likewise");
    let centre = number(&value, "centre");
    assert!(number(&value, "after") > 30.0, "the canvas after the session: {value}");
    // A projection layer, the left eye rendered, hands and transparent objects, objects of one eye.
    let projection = json!({ "size": 256, "skew": 0.15, "hasLayers": true });
    let what = "{ scene: 'glass', hands: true, options: { dominantEye: 'left', foveation: 'off' }, renderer: { antialias: true } }";
    let value = session(NEWEST, projection, what).unwrap();
    assert_eq!(value["layer"], "XRProjectionLayer");
    is_good(&value, [36.0, 0.98, 15.0]);
    let value = session(
        OLDEST,
        json!({ "size": 256, "skew": 0.15, "lift": 0.1 }),
        "{ scene: 'street', hands: true, options: { samples: 4, foveation: 'off' } }",
    )
    .unwrap();
    is_good(&value, [31.0, 0.95, 8.0]);
    assert!(number(&value, "calls") < 0.65 * number(&value, "callsOwn"), "{value}");
    // Without a word, as three asks the headset: its maximum.
    let value =
        session(NEWEST, quest, "{ scene: 'street', options: { samples: 4, holes: 'rendered' } }").unwrap();
    println!("{value}");
    assert_eq!(
        (&value["way"], &value["trouble"], &value["error"]),
        (&json!("synthesized"), &json!(null), &json!(0))
    );
    assert_eq!(value["foveation"], 1);
    assert!(number(&value, "own") < 40.0, "fewer pixels: {value}");
    assert!(number(&value, "centre") >= centre - 0.1, "where the eyes look: {value}, not {centre}");
    let value = session(NEWEST, json!({ "size": 256, "cant": 0.1 }), "{ scene: 'cubes' }").unwrap();
    assert_eq!(value["trouble"], "the displays are turned against each other");
    assert_eq!((&value["own"], &value["psnr"]), (&json!(99), &json!(99)), "three's own picture: {value}");
}

/// Levels: where the eyes look as without them, around it like two renders of the same levels, and fewer draw calls than for
/// three's two eyes. The gaze moves without new textures or programs.
#[test]
fn levels_are_sharp_where_the_eyes_look() {
    let Some(mut browser) = page(NEWEST, "") else { return };
    let ahead = json!([[0, 0]]);
    for (scene, foveation, gazes, periphery) in [
        ("street", "medium", json!([[0, 0], [12, 8], [-14, -10]]), 36.0),
        ("teapots", "high", ahead.clone(), 38.0),
        ("glass", "medium", ahead.clone(), 38.0),
        ("transmission", "medium", ahead, 36.0),
    ] {
        let values = browser.evaluate(&format!(
            "check.levels({{ scene: '{scene}', foveation: '{foveation}', gazes: {gazes}, options: {{ dominantEye: '{}' }} }})",
            if scene == "glass" { "left" } else { "right" }
        ));
        for value in values.as_array().unwrap() {
            println!("{value}");
            assert_eq!(
                (&value["way"], &value["trouble"], &value["error"]),
                (&json!("synthesized"), &json!(null), &json!(0))
            );
            assert!(number(value, "fovea") >= number(value, "foveaFull") - 0.1, "{value}");
            assert!(number(value, "ownFovea") > 42.0, "{value}");
            assert!(
                number(value, "periphery") > periphery && number(value, "ownPeriphery") > 44.0,
                "{value}"
            );
            assert!(number(value, "sources") < number(value, "callsOwn"), "{value}");
            assert_eq!(value["memory"], values[0]["memory"], "the gaze takes nothing new");
        }
    }
    // Wide lines are as wide in both levels.
    let value = browser.evaluate("check.lines({ options: { foveation: 'medium' } })");
    println!("{value}");
    assert!(number(&value, "own") > 29.0, "{value}");
    expect_nothing_but_reading(&mut browser);
}

/// Holes that are rendered are as in three's own second eye, and nothing else changes: transparent objects lie where they
/// lay, mirrors show what they showed, and masks of layers come back.
#[test]
fn rendered_holes_are_as_in_threes_own_second_eye() {
    let Some(mut browser) = page(NEWEST, "") else { return };
    let mut look = |what: &str, better: f64| {
        let value = browser.evaluate(&format!("check.holes({what})"));
        println!("{value}");
        assert_eq!(
            (&value["way"], &value["trouble"], &value["error"], &value["restored"]),
            (&json!("synthesized"), &json!(null), &json!(0), &json!(true))
        );
        assert_eq!((&value["own"], &value["again"]), (&json!(99), &json!(99)), "{value}");
        assert_eq!(value["wrong"], 0, "pixels that changed and are not three's own: {value}");
        assert!(number(&value, "rendered") >= number(&value, "filled") + better, "{value}");
        assert!(number(&value, "changed") < 16.0, "{value}");
        value
    };
    let value = look("{ scene: 'glass', options: { dominantEye: 'left' } }", 2.0);
    assert!(number(&value, "calls") < number(&value, "callsOwn") + 10.0, "{value}");
    look("{ scene: 'cubes' }", 8.0);
    look("{ scene: 'mirror' }", 1.0);
    look("{ scene: 'street', attributes: { reversedDepthBuffer: true, antialias: true } }", 1.0);
    // In the inset alone.
    look("{ scene: 'glass', options: { foveation: 'medium' } }", 0.2);
    // What is seen through something cannot be drawn apart.
    let value = look("{ scene: 'transmission' }", 0.0);
    assert_eq!((&value["changed"], &value["calls"]), (&json!(0), &value["callsFilled"]));
    expect_nothing_but_reading(&mut browser);
}

/// What three promises nobody has a public way beside it, in the oldest and in the newest version.
#[test]
fn special_renderers_and_both_versions_of_three() {
    for address in [NEWEST, OLDEST] {
        let Some(mut browser) = page(address, "") else { return };
        let results = browser.evaluate("check.special()");
        for (name, value) in results.as_object().unwrap() {
            println!("{address}, {name}");
            // Normals as colours have the hardest edges.
            let floor = if name == "overridden" { [26.0, 0.95, 4.0] } else { [34.0, 0.97, 4.0] };
            is_good(value, floor);
            assert!(number(value, "opacity") < 0.02, "{value}");
        }
        assert_eq!(results.as_object().unwrap().len(), if address == NEWEST { 6 } else { 4 });
        expect_nothing_but_reading(&mut browser);
    }
}

#[test]
fn frames_leave_nothing_behind_and_say_why_they_are_threes() {
    let Some(mut browser) = page(NEWEST, "") else { return };
    assert_eq!(browser.evaluate("check.quiet()"), 0);
    browser.expect_silence();

    let troubles = browser.evaluate("check.fallbacks()");
    let sentence =
        |name: &str| troubles[name][0].as_str().unwrap_or_else(|| panic!("{name}: {troubles}")).to_owned();
    assert!(sentence("logarithmic").contains("logarithmic"));
    assert!(sentence("autoClear").contains("autoClear"));
    assert!(sentence("orthographic").contains("perspective"));
    assert!(sentence("transmission").contains("transmission"));
    for name in ["logarithmic", "autoClear", "lists", "transmission"] {
        assert_eq!(troubles[name], json!([sentence(name), "rendered", true]), "three's own picture");
    }

    // What the user asks the headset for comes back.
    let foveations = browser.evaluate("check.foveations()");
    let third = 1.0 / 3.0;
    let asked = json!([
        ["medium", 0.5],
        ["low", third],
        ["high", 1],
        ["medium", 0.5],
        ["off", 0],
        ["off", 0],
        ["high", 1]
    ]);
    assert_eq!(foveations, asked);

    let state = browser.evaluate("check.state()");
    println!("{state}");
    assert_eq!(
        (&state["differing"], &state["picture"], &state["error"]),
        (&json!([]), &json!(99), &json!(0))
    );
    assert_eq!(state["few"], state["many"], "nothing grows");
    assert_eq!(state["few"], state["back"], "also after another size");
    assert_eq!(state["begin"], state["end"], "dispose frees everything");

    assert_eq!(browser.evaluate("check.near()"), json!(["synthesized", "rendered", "synthesized"]));
    let composed = browser.evaluate("check.composed()");
    assert_eq!(composed["isDrawn"], true);
    assert!(
        number(&composed, "psnr") > 29.0 && number(&composed, "psnr") > number(&composed, "same") + 12.0,
        "{}",
        composed["psnr"]
    );
    assert_eq!(browser.evaluate("check.lost()"), json!([99, 99]));

    // By a timer, by the display's rate, and not at all.
    let choice = |browser: &mut Browser, device: &str| browser.evaluate(&format!("check.choose({device})"));
    for (gpu, late, way) in [("[8.9, 6.1]", 0, "synthesized"), ("[6.1, 8.9]", 12, "rendered")] {
        let choice = choice(&mut browser, &format!("{{ gpu: {gpu}, late: {late} }}"));
        assert_eq!((&choice["way"], &choice["reason"]), (&json!(way), &json!("cheaper")), "{choice}");
    }
    let equal = choice(&mut browser, "{ gpu: [8, 8], noise: 0.1, seconds: 3600 }");
    assert!(equal["changes"].as_u64().unwrap() <= 1, "{equal}");
    let dear = choice(&mut browser, "{ gpu: [16, 8], seconds: 3600 }");
    assert!(number(&dear, "dear") < 0.002 * 3600.0 * 60.0, "{dear}");
    for (device, reason) in [("[14, 20]", "holds the rate"), ("[5, 6]", "both hold the rate")] {
        let choice = choice(&mut browser, &format!("{{ gpu: {device}, timed: false }}"));
        assert_eq!(choice["reason"], reason, "{choice}");
    }
    // The best of three ways that holds the rate, otherwise the cheapest one.
    for (gpu, way, reason) in [
        ("[13, 12, 9]", "rendered", "holds the rate"),
        // Without room, a frame that takes longer is late.
        ("[14, 12, 9]", "synthesized", "holds the rate"),
        ("[20, 13, 9]", "synthesized", "holds the rate"),
        ("[30, 22, 18]", "filled", "cheaper"),
    ] {
        let device = format!(
            "{{ gpu: {gpu}, ways: ['rendered', 'synthesized', 'filled'], isRanked: true, seconds: 900 }}"
        );
        let choice = choice(&mut browser, &device);
        assert_eq!((&choice["way"], &choice["reason"]), (&json!(way), &json!(reason)), "{choice}");
        assert!(number(&choice, "shortest") > 999.0, "nothing flickers: {choice}");
    }
    // Without samples only if neither two eyes nor one with samples hold the rate.
    for (gpu, way) in [("[10, 12, 6]", "rendered"), ("[22, 20, 9]", "aliased")] {
        let choice =
            choice(&mut browser, &format!("{{ gpu: {gpu}, ways: ['rendered', 'synthesized', 'aliased'] }}"));
        assert_eq!(choice["way"], way, "{choice}");
    }
    expect_nothing_but_reading(&mut browser);
}
