//! Scenes by name, loaded in the background.

use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::thread;

use crate::error::ViewerError;
use yoro_assets::Scene;
use yoro_scenes::BUILTINS;

/// File extensions of scenes.
const EXTENSIONS: [&str; 3] = ["obj", "gltf", "glb"];

/// Stack size of the loading thread in bytes: that of a main thread, on which scenes are loaded elsewhere.
const STACK: usize = 8 << 20;

/// Where a scene comes from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SceneSource {
    /// A built-in one, by its name.
    Builtin(&'static str),
    /// Loaded from a file.
    File(PathBuf),
}

impl SceneSource {
    /// Finds a scene: a built-in one by its name, or a file by its path, by its name (with or without extension) in one
    /// of the folders or their direct subfolders, or by the name of the folder that contains it.
    ///
    /// # Errors
    /// [`ViewerError::NoScene`], which lists the available scenes.
    pub fn find(name: &str, folders: &[PathBuf]) -> Result<SceneSource, ViewerError> {
        if let Some(builtin) = BUILTINS.iter().find(|b| b.name == name) {
            return Ok(SceneSource::Builtin(builtin.name));
        }
        if Path::new(name).is_file() {
            return Ok(SceneSource::File(name.into()));
        }
        let files = list_scenes(folders);
        let fits = |path: &&PathBuf| {
            path.file_name().is_some_and(|n| n == name)
                || path.file_stem().is_some_and(|n| n == name)
                || path.ends_with(name)
        };
        let is_in = |path: &&PathBuf| path.parent().and_then(Path::file_name).is_some_and(|n| n == name);
        if let Some(path) = files.iter().find(fits).or_else(|| files.iter().find(is_in)) {
            return Ok(SceneSource::File(path.clone()));
        }
        let builtins = BUILTINS.iter().map(|b| b.name.to_owned());
        let names = files.iter().filter_map(|p| Some(p.file_name()?.to_string_lossy().into_owned()));
        let all: Vec<String> = builtins.chain(names).collect();
        Err(ViewerError::NoScene(format!(
            "there is no scene \"{name}\"; choose one of {}, or give the path of an OBJ, glTF or GLB file",
            all.join(", ")
        )))
    }

    /// Returns all scenes: the built-in ones, then the files in the folders and their direct subfolders.
    pub fn all(folders: &[PathBuf]) -> Vec<SceneSource> {
        let builtin = BUILTINS.iter().map(|b| SceneSource::Builtin(b.name));
        builtin.chain(list_scenes(folders).into_iter().map(SceneSource::File)).collect()
    }

    /// The scene's name.
    pub fn name(&self) -> String {
        match self {
            SceneSource::Builtin(name) => (*name).to_owned(),
            SceneSource::File(path) => path.file_stem().unwrap_or_default().to_string_lossy().into_owned(),
        }
    }

    fn load(&self) -> Result<Scene, String> {
        match self {
            SceneSource::Builtin(name) => {
                yoro_scenes::build(name, yoro_scenes::DEFAULT_SEED).map_err(|e| e.to_string())
            }
            SceneSource::File(path) => yoro_assets::load(path).map_err(|e| e.to_string()),
        }
    }
}

/// Returns the scene files in the folders and their direct subfolders, sorted. Unreadable folders count as empty.
pub fn list_scenes(folders: &[PathBuf]) -> Vec<PathBuf> {
    fn collect(folder: &Path, depth: u32, files: &mut Vec<PathBuf>) {
        for path in std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path()) {
            let extension = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
            if path.is_dir() && depth > 0 {
                collect(&path, depth - 1, files);
            } else if EXTENSIONS.contains(&extension.as_str()) && path.is_file() {
                files.push(path);
            }
        }
    }
    let mut files = Vec::new();
    folders.iter().for_each(|folder| collect(folder, 1, &mut files));
    files.sort();
    files
}

/// A scene that is being loaded. If this is dropped, the thread runs to its end unobserved.
pub(crate) struct Loader {
    result: Receiver<Result<Scene, String>>,
}

impl Loader {
    /// Starts to load a scene on a thread of its own.
    pub fn start(source: &SceneSource) -> Loader {
        let (sender, result) = channel();
        let source = source.clone();
        // Sending fails if the viewer is gone, which is fine.
        let work = move || drop(sender.send(source.load()));
        let thread = thread::Builder::new().name("yoro scene".into()).stack_size(STACK);
        if let Err(error) = thread.spawn(work) {
            log::error!("no thread for loading: {error}");
        }
        Loader { result }
    }

    /// Returns the scene or the error, once, when loading has finished.
    pub fn poll(&self) -> Option<Result<Scene, String>> {
        match self.result.try_recv() {
            Ok(result) => Some(result),
            Err(TryRecvError::Empty) => None,
            Err(TryRecvError::Disconnected) => Some(Err(
                "the scene could not be loaded: its thread has ended; the memory may be full".into(),
            )),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scenes_are_found_by_name() {
        let folder = tempfile::tempdir().unwrap();
        let room = folder.path().join("rooms/room.obj");
        std::fs::create_dir(folder.path().join("rooms")).unwrap();
        std::fs::write(&room, "").unwrap();
        std::fs::write(folder.path().join("notes.txt"), "").unwrap();
        let folders = [folder.path().to_owned(), folder.path().join("missing")];
        assert_eq!(list_scenes(&folders), std::slice::from_ref(&room));
        for name in ["room", "room.obj", "rooms", "rooms/room.obj", room.to_str().unwrap()] {
            let source = SceneSource::find(name, &folders).unwrap();
            assert_eq!((&source, source.name().as_str()), (&SceneSource::File(room.clone()), "room"));
        }
        let builtin = SceneSource::find("prototype", &folders).unwrap();
        assert_eq!(builtin, SceneSource::Builtin("prototype"));
        let message = SceneSource::find("palace", &folders).unwrap_err().to_string();
        assert!(message.contains("palace") && message.contains("prototype") && message.contains("room.obj"));
    }
}
