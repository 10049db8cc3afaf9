//! `yoro study`: plans a user study, collects its ratings, analyses them.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::{Context as _, bail, ensure};

use crate::cli::Subcommand;
use crate::cli::args;
use crate::cli::machine;
use yoro_devices::study::{Collected, Condition, Plan, Ratings, Study, read_trials};
use yoro_files as files;
use yoro_render::stereo::Method;
use yoro_scenes::{BUILTINS, DEFAULT_SEED, replacements};
use yoro_settings::Settings;

/// Plan a user study, collect its ratings, analyse them
#[derive(clap::Args, Clone, Debug)]
pub struct StudyArgs {
    #[command(subcommand)]
    command: Command,
}

#[derive(clap::Subcommand, Clone, Debug)]
enum Command {
    Plan(PlanArgs),
    Collect(CollectArgs),
    Analyse(AnalyseArgs),
}

/// Draw the order of scenes and methods for each participant
#[derive(clap::Args, Clone, Debug)]
struct PlanArgs {
    /// Number of participants
    #[arg(long, default_value_t = 14, value_parser = args::whole::<u16>(1..=1000))]
    participants: u16,
    /// Methods to be compared, separated by commas
    #[arg(long, value_delimiter = ',', default_value = "conventional,yoro", value_name = "METHOD,...")]
    methods: Vec<String>,
    /// A setting of the viewer for one of the methods, such as paper:pipeline=paper; a name that is not a stereo method
    /// needs one of method=
    #[arg(long = "set", value_name = "METHOD:KEY=VALUE")]
    settings: Vec<String>,
    /// Scenes, separated by commas; by default the eight that replace the paper's
    #[arg(long, value_delimiter = ',', value_name = "SCENE,...")]
    scenes: Vec<String>,
    /// Questions that the viewer asks after each trial, separated by commas
    #[arg(
        long,
        value_delimiter = ',',
        default_value = "image-quality,user-experience",
        value_name = "QUESTION,..."
    )]
    questions: Vec<String>,
    /// Random seed of the orders
    #[arg(long, default_value_t = DEFAULT_SEED, value_parser = args::whole::<u64>(0..=u64::MAX), value_name = "N")]
    seed: u64,
    /// The plan, as CSV or, if the name ends in .json, as JSON
    #[arg(long, default_value = "plan.csv", value_name = "FILE")]
    out: PathBuf,
}

/// Collect the ratings from logs of the viewer
#[derive(clap::Args, Clone, Debug)]
struct CollectArgs {
    /// Logs, - for standard input
    #[arg(required = true, value_name = "LOG")]
    logs: Vec<PathBuf>,
    /// The plan that the participants followed: methods get its names, and what is not in it is left out
    #[arg(long, value_name = "PLAN.csv")]
    plan: Option<PathBuf>,
    /// The ratings
    #[arg(long, default_value = "ratings.csv", value_name = "FILE.csv")]
    out: PathBuf,
}

/// Compare each method with the baseline, question by question
#[derive(clap::Args, Clone, Debug)]
struct AnalyseArgs {
    /// Table with the columns participant, method, scene, question and rating
    #[arg(value_name = "RATINGS.csv")]
    ratings: PathBuf,
    /// The method that the others are compared with
    #[arg(long, default_value = "conventional", value_name = "METHOD")]
    baseline: String,
    /// Lowest and highest rating
    #[arg(long, default_value = "1..5", value_parser = parse_scale, value_name = "LOW..HIGH")]
    scale: Scale,
    /// Folder for study.html, study.md and study.json
    #[arg(long, default_value = "out/study", value_name = "FOLDER")]
    out: PathBuf,
}

#[derive(Clone, Copy, Debug)]
struct Scale([f64; 2]);

fn parse_scale(text: &str) -> Result<Scale, String> {
    let ends = text.split_once("..").and_then(|(low, high)| Some([low.parse().ok()?, high.parse().ok()?]));
    let scale: Option<[f64; 2]> =
        ends.filter(|[low, high]: &[f64; 2]| low < high && (high - low).is_finite());
    scale.map(Scale).ok_or_else(|| "give the lowest and the highest rating: 1..5".into())
}

impl Subcommand for StudyArgs {
    fn run(&self) -> anyhow::Result<()> {
        match &self.command {
            Command::Plan(args) => plan(args),
            Command::Collect(args) => collect(args),
            Command::Analyse(args) => analyse(args),
        }
    }
}

fn plan(args: &PlanArgs) -> anyhow::Result<()> {
    let builtin = || replacements().map(|builtin| builtin.name.to_owned()).collect();
    let scenes = if args.scenes.is_empty() { builtin() } else { args.scenes.clone() };
    for scene in &scenes {
        let file = files::has_extension(Path::new(scene), &["obj", "gltf", "glb"]);
        let known = file || BUILTINS.iter().any(|builtin| builtin.name == *scene);
        ensure!(known, "there is no scene {scene}: name one that yoro scenes lists, or a file of the device");
    }
    let methods = conditions(&args.methods, &args.settings)?;
    refuse_twice("scene", &scenes)?;
    refuse_twice("method", &args.methods)?;
    ensure!(methods.len() > 1, "one method cannot be compared: name two with --methods");
    let participants = usize::from(args.participants);
    let plan = Plan::new(participants, &scenes, &methods, &args.questions, args.seed);
    let is_json = files::has_extension(&args.out, &["json"]);
    let text = if is_json { serde_json::to_string_pretty(&plan)? } else { plan.to_csv() };
    files::write(&args.out, text.as_bytes())?;
    println!(
        "{}: {} participants, {} trials each",
        args.out.display(),
        participants,
        scenes.len() * methods.len()
    );
    if !participants.is_multiple_of(plan.balanced_at) {
        println!(
            "fully balanced with a multiple of {} participants; with {participants} the orders are as even as they can be",
            plan.balanced_at
        );
    }
    Ok(())
}

fn refuse_twice(what: &str, names: &[String]) -> anyhow::Result<()> {
    for (i, name) in names.iter().enumerate() {
        ensure!(!names[..i].contains(name), "the {what} {name} is named twice: name it once");
    }
    Ok(())
}

fn conditions(names: &[String], settings: &[String]) -> anyhow::Result<Vec<Condition>> {
    let mut given: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for setting in settings {
        let Some((method, pair)) = setting.split_once(':').filter(|(_, pair)| pair.contains('=')) else {
            bail!(
                "\"{setting}\" is not a setting of a method: write METHOD:KEY=VALUE, such as paper:pipeline=paper"
            );
        };
        ensure!(names.iter().any(|name| name == method), "{setting}: {method} is not among the --methods");
        given.entry(method).or_default().push(pair);
    }
    let condition = |name: &String| {
        let mut settings = BTreeMap::new();
        if Method::ALL.iter().any(|method| method.name() == name) {
            settings.insert("method".to_owned(), name.clone());
        }
        // Settings that the viewer would refuse are reported now.
        let mut check = Settings::default();
        for pair in given.get(name.as_str()).into_iter().flatten() {
            check.apply(pair)?;
            let (key, value) = pair.split_once('=').context("it was checked to have one")?;
            ensure!(key != "scene", "{pair}: scenes are named by --scenes");
            settings.insert(key.trim().to_owned(), value.trim().to_owned());
        }
        ensure!(
            settings.contains_key("method"),
            "{name} is not a stereo method: add --set {name}:method=yoro, or another method and more settings"
        );
        Ok(Condition { name: name.clone(), settings })
    };
    names.iter().map(condition).collect()
}

/// The number of damaged lines that are listed individually.
const DAMAGED_SHOWN: usize = 10;

fn collect(args: &CollectArgs) -> anyhow::Result<()> {
    let plan = args.plan.as_deref().map(read_trials).transpose()?;
    let mut collected = Collected::default();
    for path in &args.logs {
        let bytes = args::read_log(path)?;
        collected.add(&path.display().to_string(), &String::from_utf8_lossy(&bytes), plan.as_ref());
    }
    for (name, line, what) in collected.damaged.iter().take(DAMAGED_SHOWN) {
        log::warn!("{name}, line {line}: {what}");
    }
    if collected.ratings.is_empty() {
        let names: Vec<String> = args.logs.iter().map(|path| path.display().to_string()).collect();
        bail!(
            "there is no rating in {}: ratings are lines of the viewer's log that begin with rating,v=2, and name a participant",
            names.join(", ")
        );
    }
    files::write(&args.out, collected.to_csv().as_bytes())?;
    println!(
        "{}: {} ratings; {} were replaced by later ones, {} damaged lines were left out",
        args.out.display(),
        collected.ratings.len(),
        collected.replaced,
        collected.damaged.len()
    );
    Ok(())
}

fn analyse(args: &AnalyseArgs) -> anyhow::Result<()> {
    let Scale(scale) = args.scale;
    let ratings = Ratings::read(&args.ratings, scale)?;
    let study = Study::new(&ratings, &args.baseline, scale, machine::made_by())?;
    files::create_folder(&args.out)?;
    let written = study.write(&args.out)?;
    print!("{}{written}", study.to_text());
    Ok(())
}
