//! The settings in use, and where they come from.

use std::path::PathBuf;
use std::rc::Rc;

use android_activity::AndroidApp;
use yoro_gl::Context;
use yoro_scenes::BUILTINS;
use yoro_settings::Settings;
use yoro_viewer::{Cardboard, Viewer, ViewerError, list_scenes};

use crate::measure::game_loop::GameLoop;
use crate::measure::pictures;
use crate::platform::display::Display;
use crate::platform::java::Java;
use crate::platform::measure::results;
use crate::platform::system;
use crate::settings::writer::Writer;
use crate::settings::{self, Pair, Sources};
use crate::share::{self, Reading, Shared};

/// The file with the menu's changes, in the application's internal folder.
const MENU_FILE_NAME: &str = "settings-user";

/// Settings from outside, and the folders that are searched for scenes and viewers.
pub struct Configuration {
    sources: Sources,
    /// The settings that were last resolved from the sources.
    settings: Settings,
    folders: Vec<PathBuf>,
    /// The file of the menu's settings, and its writer once something was written.
    menu_file: Option<PathBuf>,
    writer: Option<Writer>,
    /// True until the user has been shown the explanation: the menu's file does not exist yet.
    is_first_start: bool,
    /// The mistakes in the settings when they were last read.
    mistakes: Vec<String>,
    game_loop: Option<GameLoop>,
    /// True if a scenario was requested that does not exist: the activity has nothing to do.
    pub is_unknown_scenario: bool,
    /// What another application has shared, while it is being read.
    reading: Option<Reading>,
}

impl Configuration {
    /// Asks Android for all sources, and creates the folder to which scenes can be pushed.
    pub fn new(app: &AndroidApp, java: &Java) -> Configuration {
        let external = app.external_data_path();
        let folders: Vec<PathBuf> =
            external.iter().flat_map(|folder| [folder.join("scenes"), folder.clone()]).collect();
        if let Some(scenes) = folders.first()
            && let Err(error) = std::fs::create_dir_all(scenes)
        {
            log::warn!(
                "the folder {} cannot be made ({error}): scenes cannot be pushed there",
                scenes.display()
            );
        }
        if let Some(scenes) = folders.first() {
            share::remove_unfinished(scenes);
        }
        let reading = java.is_shared().then(|| {
            let java = java.clone();
            Reading::begin(folders.first().cloned(), move || java.given())
        });
        // The extras of an intent that shares something are not settings.
        let mut extras = if reading.is_some() { Vec::new() } else { java.extras() };
        let scenario = java.scenario();
        let game_loop = scenario.and_then(|scenario| GameLoop::new(scenario, extras.clone()));
        if let Some(scenario) = scenario {
            results::begin(java.results());
            match &game_loop {
                Some(_) => log::info!("game loop: scenario {scenario}"),
                None => log::error!("there is no scenario {scenario}: take 1, 2 or 3"),
            }
        }
        if let Some(game_loop) = &game_loop {
            extras = game_loop.settings();
        }
        // A scenario is a measurement, which the user's menu settings must not affect.
        let folder = app.internal_data_path().filter(|_| scenario.is_none());
        let menu_file = folder.map(|folder| folder.join(MENU_FILE_NAME));
        let menu = menu_file.as_ref().and_then(|file| std::fs::read(file).ok());
        let is_first_start = menu.is_none();
        let sources = Sources {
            menu: menu.map_or_else(Vec::new, |bytes| settings::restore(&bytes)),
            file: external.map(|folder| folder.join(settings::FILE_NAME)),
            extras,
            properties: settings::properties(system::property),
            saved: Vec::new(),
        };
        let is_unknown_scenario = scenario.is_some() && game_loop.is_none();
        let (settings, mistakes) = (Settings::default(), Vec::new());
        Configuration {
            sources,
            settings,
            folders,
            menu_file,
            writer: None,
            is_first_start,
            mistakes,
            game_loop,
            is_unknown_scenario,
            reading,
        }
    }

    /// True if a person has started the application by hand.
    pub fn is_by_hand(&self) -> bool {
        self.game_loop.is_none() && self.sources.is_by_hand()
    }

    /// Shows the explanation if a person has started the application by hand, for the first time.
    pub fn greet(&mut self, viewer: &mut Viewer) {
        if self.is_by_hand() && std::mem::take(&mut self.is_first_start) {
            viewer.explain();
            self.write_menu_file();
        }
    }

    /// Handles a start by hand on a phone: shows the start screen while something shared is being read, or if no viewer
    /// was chosen yet. Does nothing for a start by a computer.
    pub fn begin(&mut self, cardboard: &mut Cardboard) {
        if !self.is_by_hand() {
            return;
        }
        self.greet(cardboard.viewer_mut());
        cardboard.viewer_mut().offer_start_screen();
        let message = match &mut self.reading {
            Some(reading) => reading.news().unwrap_or_default(),
            None if self.sources.has_viewer() => return,
            None => String::new(),
        };
        log::info!("{}", cardboard.viewer_mut().show_start_screen(&message));
    }

    /// Applies what was shared once it has been read.
    pub fn take_shared(&mut self, display: &mut Display) {
        let Some(reading) = &mut self.reading else { return };
        let Some(read) = reading.poll() else {
            if let Some(cardboard) = display.cardboard_mut().filter(|c| c.viewer().is_start_screen())
                && let Some(news) = reading.news()
            {
                cardboard.viewer_mut().show_start_screen(&news);
            }
            return;
        };
        self.reading = None;
        let message = match read {
            Ok(Shared::Viewer(uri)) => {
                log::info!("shared: the viewer {uri}");
                match display.cardboard_mut() {
                    Some(cardboard) => choose_viewer(cardboard, &uri),
                    None => String::new(),
                }
            }
            // Saved only when the user leaves: a model too large for the memory would end every later start.
            Ok(Shared::Scene(name)) => {
                log::info!("shared: the model {name}");
                let pairs = [("scene", name.as_str()), ("viewpoint", "0")];
                self.sources.keep(pairs.map(|(key, value)| (key.to_owned(), value.to_owned())));
                let settings = self.resolve();
                self.apply(settings, display);
                format!("The model {name} was opened: touch Start to stand in it.")
            }
            Err(mistake) => {
                log::warn!("shared: {mistake}");
                mistake
            }
        };
        if self.is_by_hand()
            && let Some(cardboard) = display.cardboard_mut()
        {
            log::info!("{}", cardboard.viewer_mut().show_start_screen(&message));
        }
    }

    /// Compares pictures, if the game loop's scenario does that.
    pub fn check_pictures(&self, gl: &Rc<Context>) {
        if self.game_loop.as_ref().is_some_and(GameLoop::checks_pictures) {
            pictures::check(gl).iter().for_each(|pictures| log::info!("{pictures}"));
        }
    }

    /// Goes to the next step of a game loop and returns its settings; `None` after the last step or without one.
    pub fn next_step(&mut self) -> Option<Settings> {
        let game_loop = self.game_loop.as_mut()?;
        if !game_loop.advance() {
            return None;
        }
        self.sources.extras = game_loop.settings();
        Some(self.resolve())
    }

    /// Restores the changes that were saved when Android stopped the activity.
    pub fn restore(&mut self, saved: &[u8]) {
        self.sources.saved = settings::restore(saved);
    }

    /// Returns the user's changes since the settings were resolved, for Android to save.
    pub fn save(&self, viewer: Option<&Viewer>) -> Vec<u8> {
        settings::save(&self.changes(viewer))
    }

    fn changes(&self, viewer: Option<&Viewer>) -> Vec<Pair> {
        let Some(viewer) = viewer else { return self.sources.saved.clone() };
        let method =
            (viewer.method() != self.settings.method).then(|| ("method", viewer.method().name().to_owned()));
        let ipd = viewer.chosen_ipd().filter(|ipd| Some(*ipd) != self.settings.ipd);
        let ipd = ipd.map(|ipd| ("ipd", ipd.to_string()));
        [method, ipd].into_iter().flatten().map(|(key, value)| (key.to_owned(), value)).collect()
    }

    /// Stores the menu's changes for the next start; a named run stores nothing. Returns true if the menu was reset.
    pub fn keep(&mut self, viewer: &mut Viewer) -> bool {
        let Some(kept) = viewer.take_kept() else { return false };
        let is_reset = kept.is_empty();
        if is_reset {
            self.sources.menu.clear();
        }
        self.sources.keep(kept.into_iter().map(|(key, value)| (key.to_owned(), value)));
        self.write_menu_file();
        is_reset
    }

    /// Also stores what the user has changed by tap and volume keys, since the user leaves.
    pub fn leave(&mut self, viewer: Option<&Viewer>) {
        let changes = self.changes(viewer);
        self.sources.keep(changes);
        self.write_menu_file();
        // Waits for the writer: the process may be killed at any time from now on, and the next start reads the file.
        self.writer = None;
    }

    fn write_menu_file(&mut self) {
        let Some(file) = self.menu_file.as_ref().filter(|_| !self.sources.is_named_run()) else { return };
        let writer = self.writer.get_or_insert_with(|| Writer::new(file.clone()));
        writer.write(settings::save(&self.sources.menu));
    }

    /// Resolves the settings from outside; each mistake is logged once.
    pub fn resolve(&mut self) -> Settings {
        let (settings, mistakes) = self.sources.resolve();
        mistakes.iter().filter(|m| !self.mistakes.contains(m)).for_each(|mistake| log::warn!("{mistake}"));
        self.mistakes = mistakes;
        settings
    }

    /// Creates a viewer with the settings from outside. Mistakes in them are logged and replaced by the defaults.
    ///
    /// # Errors
    /// The viewer cannot be created with the defaults either.
    pub fn make_viewer<T>(
        &mut self,
        new: impl Fn(Settings, &[PathBuf]) -> Result<T, ViewerError>,
    ) -> Result<T, ViewerError> {
        let settings = self.resolve();
        self.log_scenes();
        self.settings = settings.clone();
        let mut possible = settings;
        let defaults = Settings::default();
        loop {
            let error = match new(possible.clone(), &self.folders) {
                Ok(viewer) => return Ok(viewer),
                Err(error) => error,
            };
            let (setting, default) = match error {
                ViewerError::NoScene(_) => (&mut possible.scene, &defaults.scene),
                ViewerError::Params(_) => (&mut possible.viewer, &defaults.viewer),
                error => return Err(error),
            };
            if setting == default {
                return Err(error);
            }
            log::warn!("{error}; {default} is taken");
            setting.clone_from(default);
        }
    }

    fn log_scenes(&self) {
        let builtin: Vec<&str> = BUILTINS.iter().map(|scene| scene.name).collect();
        log::info!("built-in scenes: {}", builtin.join(", "));
        let mut files = list_scenes(&self.folders);
        files.dedup();
        files.iter().for_each(|file| log::info!("scene file: {}", file.display()));
    }

    /// Returns the settings if system properties have changed them while the application runs.
    pub fn poll_properties(&mut self) -> Option<Settings> {
        let have_changed = self.sources.set_properties(settings::properties(system::property));
        let settings = have_changed.then(|| self.resolve())?;
        (settings != self.settings).then_some(settings)
    }

    /// True if these settings name another scene than those in use.
    pub fn is_other_scene(&self, settings: &Settings) -> bool {
        settings.scene != self.settings.scene
    }

    /// Applies settings to a display; if it rejects them, the previous ones stay.
    pub fn apply(&mut self, settings: Settings, display: &mut Display) {
        let Some(viewer) = display.viewer() else { return };
        // A scene or viewer that was not found at the start is not searched for again with every change.
        let mut possible = settings.clone();
        if settings.scene == self.settings.scene {
            possible.scene.clone_from(&viewer.settings().scene);
        }
        if settings.viewer == self.settings.viewer {
            possible.viewer.clone_from(&viewer.settings().viewer);
        }
        match display.configure(possible, &self.folders) {
            Ok(()) => {
                if let Some(viewer) = display.viewer() {
                    log::info!("settings: {}", viewer.settings());
                }
                self.settings = settings;
            }
            Err(error) => log::warn!("{error}; the settings stay as they were"),
        }
    }
}

/// Chooses a viewer by its URI, and returns a sentence for the user.
pub fn choose_viewer(cardboard: &mut Cardboard, uri: &str) -> String {
    match cardboard.choose_viewer(uri) {
        Ok(()) => "This is your viewer now. Touch Start.".into(),
        Err(error) => error.to_string(),
    }
}
