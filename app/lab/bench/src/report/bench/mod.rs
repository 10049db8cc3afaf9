//! The report of `yoro bench`: result files as one self-contained page and as Markdown.

mod data;
mod sections;
#[cfg(test)]
mod tests;

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use minijinja::context;

use crate::bench::{Results, picture_folder};
use crate::report::error::ReportError;
use crate::report::page::{PICTURE_BUDGET, Pictures};
use crate::report::run::{QUALITY_METHOD, Viewpoint};
use data::Suite;
use sections::Section;
use yoro::eyes::Eye;
use yoro_files as files;
use yoro_report::page::{self, Template};

const TEMPLATE: Template =
    Template { name: "bench.html.j2", text: include_str!("../templates/bench.html.j2") };

/// The page, all tables, and the main tables.
pub const FILES: [&str; 3] = ["report.html", "results.md", "summary.md"];

/// The heading of the page.
const TITLE: &str = "yoro: every method side by side";

/// The combined contents of result files.
pub struct BenchReport {
    files: Vec<Results>,
    suites: Vec<Suite>,
    pictures: Vec<Pictured>,
}

/// The pictures that a run saved for one setting.
struct Pictured {
    name: String,
    note: String,
    viewpoint: Viewpoint,
}

/// Explains the marks by which the paper's figures are recognized.
const PAPERS_MARK: &str = "What is *in italics*, hollow or dashed is the paper's (\"You Only Render Once\", MobiSys '25): \
its own scenes, six phones and a Quest 2.";

/// Explains how frame times are measured; printed wherever they are shown.
const TIME_METHOD: &str = "Frame times: wall clock of a whole stereo frame up to glFinish. Methods take turns within \
each round, so that ratios pair frames of the same round; means of ratios over scenes are geometric.";

/// The files that were written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Written {
    /// The page.
    pub page: PathBuf,
    /// All tables, in the order of the page.
    pub results: PathBuf,
    /// The first table of each experiment, for a README.
    pub summary: PathBuf,
}

impl BenchReport {
    /// Combines files and loads the pictures beside them.
    ///
    /// # Errors
    /// [`ReportError::Empty`] for a file without a finished round; [`ReportError::PictureFile`] for a damaged picture.
    pub fn new(files: Vec<Results>) -> Result<BenchReport, ReportError> {
        if let Some(empty) = files.iter().find(|file| file.measurements().next().is_none()) {
            return Err(ReportError::Empty { path: empty.path.clone() });
        }
        let suites = data::suites(&files);
        let mut pictures = Vec::new();
        for file in &files {
            pictures.extend(load_pictures(file)?);
        }
        Ok(BenchReport { files, suites, pictures })
    }

    /// Returns the self-contained page.
    ///
    /// # Errors
    /// [`ReportError`] if a figure or a picture cannot be made.
    pub fn to_html(&self) -> Result<String, ReportError> {
        let viewpoints: Vec<&[Viewpoint]> =
            self.pictures.iter().map(|pictured| std::slice::from_ref(&pictured.viewpoint)).collect();
        let pictures = Pictures::encode(&viewpoints, PICTURE_BUDGET)?;
        let sections = sections::sections(&self.suites);
        let section = |(suite, section): &(&Suite, Section)| -> Result<minijinja::Value, ReportError> {
            Ok(context! {
                id => &section.id,
                title => &section.title,
                where => self.place(suite),
                intro => &section.intro,
                figures => page::figures(&section.figures)?,
                tables => &section.tables,
                command => &suite.header.machine.command,
                date => &suite.header.machine.date,
            })
        };
        let page = context! {
            sections => sections.iter().map(section).collect::<Result<Vec<_>, _>>()?,
            quality_method => QUALITY_METHOD,
            time_method => TIME_METHOD,
            picture_note => pictures.note,
            scenes => self
                .pictures
                .iter()
                .zip(pictures.scenes)
                .map(|(pictured, viewpoints)| context! {
                    name => &pictured.name,
                    note => &pictured.note,
                    viewpoints => viewpoints,
                })
                .collect::<Vec<_>>(),
            runs => self
                .files
                .iter()
                .map(|file| context! {
                    file => file_name(&file.path),
                    machine => &file.header.machine,
                    parameters => &file.header.parameters,
                })
                .collect::<Vec<_>>(),
        };
        Ok(page::fill(TEMPLATE, TITLE, page)?)
    }

    /// Returns all tables.
    pub fn to_markdown(&self) -> String {
        let mut out = format!("{PAPERS_MARK}\n");
        for (suite, section) in sections::sections(&self.suites) {
            self.heading(&mut out, suite, &section);
            for table in &section.tables {
                let _ = writeln!(out, "{}", table.markdown());
            }
            source(&mut out, suite);
        }
        out
    }

    /// Returns the first table of each experiment.
    pub fn to_summary(&self) -> String {
        let mut out = String::new();
        for (suite, section) in sections::sections(&self.suites) {
            if let Some(table) = section.tables.first() {
                self.heading(&mut out, suite, &section);
                let _ = writeln!(out, "{}", table.markdown());
                source(&mut out, suite);
            }
        }
        out
    }

    fn heading(&self, out: &mut String, suite: &Suite, section: &Section) {
        let place = self.place(suite).map(|place| format!(" ({place})")).unwrap_or_default();
        let _ = writeln!(out, "\n## {}{place}\n\n{}\n", section.title, section.intro);
    }

    /// Returns the GL renderer if several machines measured the same suite, with its version if only that differs.
    fn place(&self, suite: &Suite) -> Option<String> {
        let (renderer, version) = gl(suite);
        let same_suite = |other: &&Suite| other.name == suite.name;
        let others: Vec<_> = self.suites.iter().filter(same_suite).map(gl).collect();
        let another_version = others.iter().any(|(r, v)| *r == renderer && *v != version);
        match (others.len() > 1, another_version) {
            (false, _) => None,
            (true, false) => Some(renderer.to_owned()),
            (true, true) => Some(format!("{renderer}, {version}")),
        }
    }

    /// Writes [`FILES`] into a folder.
    ///
    /// # Errors
    /// [`ReportError`]; existing files are then unchanged.
    pub fn write(&self, folder: &Path) -> Result<Written, ReportError> {
        // Everything is made before anything is written.
        let texts = [self.to_html()?, self.to_markdown(), self.to_summary()];
        let [page, results, summary] = FILES.map(|name| folder.join(name));
        for (path, text) in [&page, &results, &summary].into_iter().zip(&texts).rev() {
            files::write(path, text.as_bytes())?;
        }
        Ok(Written { page, results, summary })
    }
}

/// Writes how a suite was measured: command, machine, date.
fn source(out: &mut String, suite: &Suite) {
    let machine = &suite.header.machine;
    let _ = writeln!(
        out,
        "`{}` on {}, {} cores, {}, {}.",
        machine.command, machine.cpu, machine.cores, machine.gl_renderer, machine.date
    );
}

/// Returns the renderer and version of GL with which a suite was measured.
fn gl(suite: &Suite) -> (&str, &str) {
    let machine = &suite.header.machine;
    (&machine.gl_renderer, &machine.gl_version)
}

fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// Loads the pictures beside a file, in the order of its settings.
fn load_pictures(file: &Results) -> Result<Vec<Pictured>, ReportError> {
    let mut pictures = Vec::new();
    let dominant_eye = file.header.parameters.iter().find(|parameter| parameter.name == "dominant eye");
    let dominant_eye = match dominant_eye {
        Some(parameter) if parameter.value == Eye::Left.name() => Eye::Left,
        _ => Eye::Right,
    };
    for facts in file.scenes() {
        let folder = picture_folder(&file.path, &facts.conditions);
        // The pictures of a stream do not include the dominant eye.
        if !["truth.png", "dominant.png"].iter().all(|name| folder.join(name).is_file()) {
            continue;
        }
        let load = |name: &str| yoro_media::load_color(&folder.join(format!("{name}.png")));
        let names = file.measurements().filter(|m| m.conditions == facts.conditions && m.round == 0);
        let names = names.map(|measurement| measurement.contender.as_str());
        let mut views = Vec::new();
        for name in names.filter(|name| ![sections::CONVENTIONAL, sections::MONO].contains(name)) {
            if folder.join(format!("{name}.png")).is_file() {
                views.push((name.to_owned(), load(name)?));
            }
        }
        let frame = facts.frames.first().cloned().unwrap_or_else(|| "first frame".into());
        let (dominant, truth) = (load("dominant")?, load("truth")?);
        let viewpoint = Viewpoint::measure(frame, dominant_eye, dominant, truth, views)
            .map_err(|source| ReportError::Sizes { path: folder.clone(), source })?;
        let setting = &facts.conditions;
        let point = setting.label.clone().or(setting.point.map(|point| point.to_string()));
        let note = match point {
            Some(point) => format!("{}, {point}", setting.suite),
            None => setting.suite.clone(),
        };
        pictures.push(Pictured { name: setting.scene.clone(), note, viewpoint });
    }
    Ok(pictures)
}
