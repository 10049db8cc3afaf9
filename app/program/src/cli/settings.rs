//! Options for settings of the viewer, generated from the table of settings.

use std::ffi::OsStr;
use std::marker::PhantomData;
use std::path::PathBuf;

use clap::builder::{PossibleValue, StringValueParser, TypedValueParser};
use clap::{Arg, ArgAction, ArgMatches, Command};

use yoro::eyes::Foveation;
use yoro_render::RenderSettings;
use yoro_render::stereo::{Pipeline, PipelineOptions, StereoOptions};
use yoro_settings::{Setting, Settings};
use yoro_viewer::stereo_options;

/// A group of settings that a subcommand has options for.
pub trait Group {
    /// The keys of the settings, in the order of the help.
    const KEYS: &'static [&'static str];
    /// Defaults other than those of the table, as `key=value`.
    const DEFAULTS: &'static [&'static str];
}

/// Defines groups by their keys, and defaults other than the table's.
macro_rules! groups {
    ($($(#[$doc:meta])* $name:ident $keys:tt $defaults:tt;)*) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug)]
        pub struct $name;

        impl Group for $name {
            const KEYS: &'static [&'static str] = &$keys;
            const DEFAULTS: &'static [&'static str] = &$defaults;
        }
    )*};
}

groups! {
    /// The settings of the renderer.
    Renderer ["msaa"] [];
    /// The settings of the renderer that `yoro xr` has options for.
    HeadsetRenderer ["msaa", "foveation"] [];
    /// The settings of the renderer of image groups: each pixel belongs to one surface by default.
    OneSample ["msaa"] ["msaa=1"];
    /// The settings of the synthesis pipeline.
    Synthesis ["pipeline", "imbuffer", "linear-interpolation", "strict"] [];
    /// The settings of stereo frames.
    Stereo ["pipeline", "imbuffer", "linear-interpolation", "strict", "guard-band", "holes", "switch"] [];
    /// The settings of stereo frames whose pipelines are compared, each as its name says: none is switched to two renders.
    Compared ["imbuffer", "linear-interpolation", "strict", "guard-band"] [];
    /// The settings of the picture behind lenses that `yoro view` has options for. Its own `--screen` is in pixels; the
    /// setting `screen` is in millimetres.
    Lenses ["viewer", "method", "foveation"] ["method=yoro", "foveation=off"];
    /// The setting of frames in levels.
    Foveated ["foveation"] ["foveation=off"];
}

impl SettingOptions<Compared> {
    /// Returns the options with a pipeline.
    pub fn options(&self, pipeline: Pipeline) -> StereoOptions {
        StereoOptions { policy: None, ..stereo_options(&self.settings, pipeline) }
    }
}

/// The options of a [`Group`]: `--KEY VALUE`; for switches `--KEY`, or `--no-KEY` if they are on by default.
#[derive(Clone, Debug)]
pub struct SettingOptions<G> {
    /// The defaults, changed by the given options.
    settings: Settings,
    given: Vec<(&'static str, String)>,
    group: PhantomData<G>,
}

impl<G: Group> SettingOptions<G> {
    /// Returns the given options as `key=value`.
    pub fn pairs(&self) -> impl Iterator<Item = String> {
        self.given.iter().map(|(key, value)| format!("{key}={value}"))
    }

    /// Returns the values of all options as `key=value`.
    pub fn summary(&self) -> String {
        let values = Self::rows().map(|setting| format!("{}={}", setting.key, setting.text(&self.settings)));
        values.collect::<Vec<_>>().join(" ")
    }

    /// Returns the default settings, changed by the given options.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    fn rows() -> impl Iterator<Item = &'static Setting> {
        G::KEYS.iter().map(|key| Setting::find(key).expect("a key of the table"))
    }

    /// Returns the default of a setting that differs from the table's.
    fn default_of(setting: &Setting) -> Option<String> {
        let mut pairs = G::DEFAULTS.iter().filter_map(|pair| pair.split_once('='));
        pairs.find(|(key, _)| *key == setting.key).map(|(_, value)| value.to_owned())
    }
}

impl<G: Group> SettingOptions<G> {
    /// Returns the renderer's settings. Those without an option have the desktop's defaults.
    pub fn render_settings(&self) -> RenderSettings {
        RenderSettings { msaa: self.settings.msaa, ..RenderSettings::default() }
    }
}

impl SettingOptions<Synthesis> {
    /// Returns the options of the pipeline.
    pub fn options(&self) -> PipelineOptions {
        stereo_options(&self.settings, self.settings.pipeline).synthesis
    }
}

impl SettingOptions<Foveated> {
    /// Returns the foveation, if any.
    pub fn foveation(&self) -> Option<Foveation> {
        self.settings.foveation.unwrap_or_default().foveation()
    }
}

impl SettingOptions<Stereo> {
    /// Returns the options with the chosen pipeline.
    pub fn options(&self) -> StereoOptions {
        stereo_options(&self.settings, self.settings.pipeline)
    }
}

impl<G: Group> clap::Args for SettingOptions<G> {
    fn augment_args(command: Command) -> Command {
        command.args(Self::rows().map(|setting| option(setting, Self::default_of(setting))))
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl<G: Group> clap::FromArgMatches for SettingOptions<G> {
    fn from_arg_matches(matches: &ArgMatches) -> Result<SettingOptions<G>, clap::Error> {
        let value = |setting: &'static Setting| {
            let value = if setting.is_bool {
                matches.get_flag(setting.key).then(|| setting.off_help.is_none().to_string())
            } else {
                matches.get_one::<String>(setting.key).cloned()
            };
            Some((setting.key, value?))
        };
        let given: Vec<_> = Self::rows().filter_map(value).collect();
        let pairs = given.iter().map(|(key, value)| format!("{key}={value}"));
        let settings =
            Settings::resolve(None, G::DEFAULTS.iter().map(|pair| (*pair).to_owned()).chain(pairs))
                .map_err(|error| clap::Error::raw(clap::error::ErrorKind::ValueValidation, error))?;
        Ok(SettingOptions { settings, given, group: PhantomData })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

/// Returns the command-line option for a setting, whose default may differ from the table's.
fn option(setting: &'static Setting, default: Option<String>) -> Arg {
    let help = setting.help().replace('`', "");
    if setting.is_bool {
        let (name, help) = match setting.off_help {
            Some(help) => (format!("no-{}", setting.key), help.to_owned()),
            None => (setting.key.to_owned(), help),
        };
        return Arg::new(setting.key).long(name).help(help).action(ArgAction::SetTrue);
    }
    let default = default.or_else(|| match setting.auto {
        Some(default) => Some(default.to_owned()),
        None => Some(setting.default()).filter(|_| !setting.is_optional),
    });
    let default = default.map_or_else(String::new, |default| format!(" [default: {default}]"));
    let name = setting.value_name.map_or_else(|| setting.key.to_uppercase().replace('-', "_"), str::to_owned);
    Arg::new(setting.key)
        .long(setting.key)
        .help(help + &default)
        .value_name(name)
        .value_parser(ValueOf { setting, fits: |_| true })
        .allow_negative_numbers(true)
}

/// Checks the value of a setting, which stays a text.
#[derive(Clone, Copy)]
struct ValueOf {
    setting: &'static Setting,
    /// True for the names that the option accepts.
    fits: fn(&str) -> bool,
}

impl TypedValueParser for ValueOf {
    type Value = String;

    fn parse_ref(&self, command: &Command, arg: Option<&Arg>, value: &OsStr) -> Result<String, clap::Error> {
        let setting = self.setting;
        let check = move |text: String| {
            // On the command line, the guard band `auto` is the one that sets its own width.
            let text = if setting.key == "guard-band" && text == "auto" { "auto:1".into() } else { text };
            match setting.parse_into(&mut Settings::default(), &text) {
                Ok(()) => Ok(text),
                Err((_, remedy)) => Err(remedy),
            }
        };
        StringValueParser::new().try_map(check).parse_ref(command, arg, value)
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        let choices = self.setting.choices.iter().filter(|choice| (self.fits)(choice.name));
        (!self.setting.choices.is_empty())
            .then(|| Box::new(choices.map(|choice| PossibleValue::new(choice.name).help(choice.help()))) as _)
    }
}

/// Returns a parser for a type whose names are among the values of a setting.
pub fn value_of<T>(key: &'static str) -> impl TypedValueParser<Value = T>
where
    T: std::str::FromStr<Err: std::error::Error + Send + Sync + 'static> + Clone + Send + Sync + 'static,
{
    let setting = Setting::find(key).expect("a key of the table");
    ValueOf { setting, fits: |name| name.parse::<T>().is_ok() }.try_map(|text| text.parse::<T>())
}

/// Settings of the viewer on the command line
#[derive(clap::Args, Clone, Debug)]
pub struct SettingsArgs {
    /// Hide the HUD
    #[arg(long)]
    no_hud: bool,
    /// Settings of the viewer in a TOML file
    #[arg(long, value_name = "FILE")]
    settings: Option<PathBuf>,
    /// One setting of the viewer; more than once for several
    #[arg(long = "set", value_name = "KEY=VALUE")]
    overrides: Vec<String>,
}

impl SettingsArgs {
    /// Returns `defaults` changed by the given settings. Settings with options of their own, given as `key=value`, take
    /// precedence over `--set`.
    pub fn resolve(
        &self,
        defaults: Settings,
        named: impl IntoIterator<Item = String>,
    ) -> anyhow::Result<Settings> {
        let hud = self.no_hud.then(|| "hud=false".to_owned());
        // Android's properties may be empty; here a script's variable is.
        if let Some(empty) = self.overrides.iter().find(|pair| pair.trim_end().ends_with('=')) {
            anyhow::bail!("--set {empty} has no value: give one, or leave it out");
        }
        let overrides = self.overrides.iter().cloned().chain(named).chain(hud);
        Ok(defaults.changed(self.settings.as_deref(), overrides)?)
    }
}
