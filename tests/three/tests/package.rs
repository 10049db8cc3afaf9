//! The package as its users have it: types, size, frameworks with a loop of their own, the example page.

use std::fs;
use std::path::Path;
use std::process::Command;

use yoro_three_tests::{modules, open, package};

/// What a page that has three.js already loads at most, minified and compressed with brotli, in bytes.
const LARGEST: u64 = 14_000;

/// Runs a script of an npm package, and returns its output.
fn node(modules: &Path, script: &str, arguments: &[&str]) -> String {
    let mut command = Command::new("node");
    command.arg(modules.join(script)).args(arguments).env("NODE_PATH", modules);
    let output = command.output().expect("node is here if npm is");
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(
        output.status.success(),
        "{script} {arguments:?}: {text}{}",
        String::from_utf8_lossy(&output.stderr)
    );
    text
}

fn bundle(modules: &Path, source: &str, out: &Path, options: &[&str]) {
    let source = package().join(source);
    let alias = format!("--alias:yoro-three={}", package().join("src/index.js").display());
    let out = format!("--outfile={}", out.display());
    let always =
        [source.to_str().unwrap(), &alias, &out, "--bundle", "--minify", "--format=esm", "--log-level=error"];
    node(modules, "esbuild/bin/esbuild", &[&always, options].concat());
}

#[test]
fn the_types_are_those_of_threes_own() {
    let Some(modules) = modules() else { return };
    let folder = tempfile::tempdir().unwrap();
    let config = serde_json::json!({
        "compilerOptions": {
            "noEmit": true, "strict": true, "skipLibCheck": true, "target": "es2022", "module": "esnext",
            "moduleResolution": "bundler", "lib": ["es2022", "dom"], "types": [], "typeRoots": [],
            "paths": {
                "yoro-three": [package().canonicalize().unwrap().join("index.d.ts")],
                "three": [modules.join("@types/three/index.d.ts")],
                "*": [modules.join("*"), modules.join("@types/*")],
            },
        },
        "files": [package().canonicalize().unwrap().join("test/types.ts")],
    });
    let file = folder.path().join("tsconfig.json");
    fs::write(&file, config.to_string()).unwrap();
    node(&modules, "typescript/lib/tsc.js", &["--project", file.to_str().unwrap()]);
}

#[test]
fn the_package_is_small() {
    let Some(modules) = modules() else { return };
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("small.js");
    bundle(&modules, "src/index.js", &out, &["--external:three", "--legal-comments=none"]);
    let script = "const b = require('zlib').brotliCompressSync(require('fs').readFileSync(process.argv[1])); console.log(b.length)";
    let output = Command::new("node").args(["-e", script]).arg(&out).output().unwrap();
    let size: u64 = String::from_utf8_lossy(&output.stdout).trim().parse().unwrap();
    println!("{size} bytes");
    assert!(size <= LARGEST, "{size} bytes are more than {LARGEST}");
}

/// A-Frame and React Three Fiber draw both eyes by `install`, with what the examples say.
#[test]
fn frameworks_with_a_loop_of_their_own() {
    let Some(modules) = modules() else { return };
    let folder = tempfile::tempdir().unwrap();
    bundle(
        &modules,
        "test/react.jsx",
        &folder.path().join("react.js"),
        &["--jsx=automatic", "--define:process.env.NODE_ENV=\"production\""],
    );
    for page in ["/test/aframe.html", "/test/react.html"] {
        let Some(mut browser) = open(&modules, folder.path(), page, "") else { return };
        let result = browser.evaluate("globalThis.compared");
        println!("{page}: {result}");
        let number = |name: &str| result[name].as_f64().unwrap();
        assert_eq!(
            (&result["way"], result["trouble"].is_null()),
            (&serde_json::json!("synthesized"), true),
            "{result}"
        );
        assert_eq!(result["size"], serde_json::json!([256, 256]));
        assert!(number("own") > 35.0 && number("psnr") > number("same") + 3.0, "{page}: {result}");
        browser.expect_no_error();
    }
}

/// The page that `cargo xtask web` builds: it draws, its panel tells, and its switches work.
#[test]
fn the_example_page() {
    let Some(modules) = modules() else { return };
    let folder = tempfile::tempdir().unwrap();
    bundle(&modules, "examples/main.js", &folder.path().join("main.js"), &[]);
    for name in ["index.html", "style.css"] {
        fs::copy(package().join("examples").join(name), folder.path().join(name)).unwrap();
    }
    let page = fs::read_to_string(folder.path().join("index.html")).unwrap();
    let small = page.replace(
        "</html>",
        "<script>addEventListener('load', () => { globalThis.ready = true; });</script></html>",
    );
    fs::write(folder.path().join("index.html"), small).unwrap();
    let Some(mut browser) = open(&modules, folder.path(), "/made/index.html", "") else { return };
    browser.resize(512, 256);
    let told = "new Promise((done) => { (function look() { const { textContent } = document.getElementById('figures'); \
                /WORD/.test(textContent) ? done(textContent) : setTimeout(look, 50); })(); })";
    let choose = |id: &str, value: &str| {
        format!(
            "{{ const s = document.getElementById('{id}'); s.value = '{value}'; s.dispatchEvent(new Event('change')); 0 }}"
        )
    };
    browser.evaluate(&choose("scene", "balls"));
    for (mode, word) in [
        ("rendered", "both eyes rendered\\n3\\d\\d draw"),
        ("synthesized", "the other synthesized\\n1\\d\\d draw"),
    ] {
        browser.evaluate(&choose("mode", mode));
        println!("{}", browser.evaluate(&told.replace("WORD", word)));
    }
    // Without a GPU, the browser itself reads the canvas back to show it.
    browser.expect_silence_but("ReadPixels");
}
