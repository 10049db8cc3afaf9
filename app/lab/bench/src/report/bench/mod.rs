//! The report of `yoro bench`: what its result files say, suite by suite.

mod data;
mod sections;
#[cfg(test)]
mod tests;

use std::path::Path;

use crate::bench::{Results, picture_folder};
use crate::machine::Machine;
use crate::report::error::ReportError;
use crate::report::page;
use crate::report::run::{QUALITY_METHOD, Viewpoint};
use data::Suite;
use yoro::eyes::Eye;
use yoro_report::{Report, ReportFiles, Section, Text};

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
const PAPERS_MARK: &str = "Every method side by side, in the paper's order of experiments. What is hollow, dashed or in italics is the \
paper's (\"You Only Render Once\", MobiSys '25): its own scenes, six phones and a Quest 2.";

/// Explains how frame times are measured; printed wherever they are shown.
const TIME_METHOD: &str = "Frame times: wall clock of a whole stereo frame up to glFinish. Methods take turns within \
each round, so that ratios pair frames of the same round; means of ratios over scenes are geometric.";

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

    /// Returns the report.
    pub fn report(&self) -> Report {
        let mut sections = Vec::new();
        for (suite, mut section) in sections::sections(&self.suites) {
            let Machine { command, cpu, cores, gl_renderer, date, .. } = &suite.header.machine;
            section.text(Text::quiet(format!("`{command}` on {cpu}, {cores} cores, {gl_renderer}, {date}.")));
            section.place = self.place(suite).unwrap_or_default();
            sections.push(section);
        }
        let mut pictures = Section::new("Pictures", "");
        for Pictured { name, note, viewpoint } in &self.pictures {
            pictures.pictures(page::pictures(viewpoint, name.clone(), note.clone()));
        }
        if !pictures.is_empty() {
            sections.push(pictures);
        }
        let mut measured = Section::new("How it was measured", QUALITY_METHOD);
        measured.text(TIME_METHOD);
        for file in &self.files {
            let name = file.path.file_name().unwrap_or_default().to_string_lossy();
            measured.table(page::machine(&name, &file.header.machine, &file.header.parameters));
        }
        sections.push(measured);
        Report { title: TITLE.into(), summary: vec![PAPERS_MARK.into()], sections }
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

    /// Returns the files that [`BenchReport::write`] writes into `folder`.
    pub fn files(folder: &Path) -> ReportFiles {
        ReportFiles::of(folder, "report", false)
    }

    /// Writes the page and its tables into `folder`.
    ///
    /// # Errors
    /// [`ReportError`]; existing files are then unchanged.
    pub fn write(&self, folder: &Path) -> Result<ReportFiles, ReportError> {
        Ok(self.report().write(folder, "report", None)?)
    }
}

/// Returns the renderer and version of GL with which a suite was measured.
fn gl(suite: &Suite) -> (&str, &str) {
    let machine = &suite.header.machine;
    (&machine.gl_renderer, &machine.gl_version)
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
