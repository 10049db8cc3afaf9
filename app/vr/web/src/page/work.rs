//! Slow work for a worker: generates or loads scenes, as bytes for [`crate::Page::set_scene`].

use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use js_sys::{Array, Function, Uint8Array};
use wasm_bindgen::prelude::*;
use yoro_assets::Scene;
use yoro_scenes::build::Progress;
use yoro_scenes::{BUILTINS, DEFAULT_SEED};

use super::error::sentence;

#[wasm_bindgen]
extern "C" {
    #[wasm_bindgen(js_namespace = console, js_name = error)]
    fn console_error(text: &str);
}

/// Warnings of loaders.
struct Warnings(Mutex<Vec<String>>);

static WARNINGS: Warnings = Warnings(Mutex::new(Vec::new()));

impl log::Log for Warnings {
    fn enabled(&self, metadata: &log::Metadata) -> bool {
        metadata.level() <= log::Level::Warn
    }

    fn log(&self, record: &log::Record) {
        if self.enabled(record.metadata()) {
            self.0.lock().unwrap_or_else(PoisonError::into_inner).push(record.args().to_string());
        }
    }

    fn flush(&self) {}
}

/// Prints panics to the console, since the browser itself only reports that the module has ended.
#[wasm_bindgen(start)]
fn start() {
    std::panic::set_hook(Box::new(|panic| console_error(&panic.to_string())));
    if log::set_logger(&WARNINGS).is_ok() {
        log::set_max_level(log::LevelFilter::Warn);
    }
}

/// Returns the warnings since the last call, each a sentence.
#[wasm_bindgen(js_name = takeWarnings)]
pub fn take_warnings() -> Vec<String> {
    std::mem::take(&mut *WARNINGS.0.lock().unwrap_or_else(PoisonError::into_inner))
}

fn pack(scene: &Scene) -> Result<Vec<u8>, JsError> {
    postcard::to_allocvec(scene).map_err(sentence)
}

/// Returns the built-in scenes as JSON: `[{"name", "title", "kiloTriangles"}]`, the smallest first.
#[wasm_bindgen(js_name = builtinScenes)]
pub fn builtin_scenes() -> String {
    let mut scenes: Vec<_> = BUILTINS.iter().collect();
    scenes.sort_by_key(|scene| scene.kilo_triangles);
    let entry = |scene: &&yoro_scenes::Builtin| serde_json::json!({ "name": scene.name, "title": scene.title, "kiloTriangles": scene.kilo_triangles });
    serde_json::Value::from_iter(scenes.iter().map(entry)).to_string()
}

/// Generates a built-in scene. `progress` is called repeatedly with the numbers of textures and triangles.
///
/// # Errors
/// A sentence, for a name that does not exist.
#[wasm_bindgen(js_name = buildScene)]
pub fn build_scene(name: &str, progress: Function) -> Result<Vec<u8>, JsError> {
    let watch = move |done: Progress| {
        let [textures, triangles] = [done.textures, done.triangles].map(|n| JsValue::from(n as f64));
        // An exception in it would be a bug of the worker.
        let _ = progress.call2(&JsValue::NULL, &textures, &triangles);
    };
    pack(&yoro_scenes::build_watched(name, DEFAULT_SEED, watch).map_err(sentence)?)
}

/// Loads the scene in the file `main`, which is one of `names`; `contents` (`Uint8Array`s) are the files' contents.
///
/// # Errors
/// A sentence that names the file and the remedy.
#[wasm_bindgen(js_name = loadScene)]
pub fn load_scene(main: &str, names: Vec<String>, contents: &Array) -> Result<Vec<u8>, JsError> {
    let names = names.into_iter().map(PathBuf::from);
    let contents = contents.iter().map(|bytes| Uint8Array::from(bytes).to_vec());
    yoro_files::provide(names.zip(contents));
    let scene = yoro_assets::load(Path::new(main));
    yoro_files::provide([]);
    pack(&scene.map_err(sentence)?)
}
