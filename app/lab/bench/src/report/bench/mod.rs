//! The report of `yoro bench`: result files as one self-contained page and as Markdown.

mod data;
mod sections;
#[cfg(test)]
mod tests;

use std::fmt::Write as _;
use std::path::{Component, Path, PathBuf};

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
use yoro_report::stats::unique;
use yoro_report::text::slug;

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

/// The folders that a report is written to.
#[derive(Clone, Copy, Debug)]
pub struct Places<'a> {
    /// The folder of the page and of the files with all tables.
    pub report: &'a Path,
    /// The folder of the figures as SVG files, if they are wanted.
    pub figures: Option<&'a Path>,
    /// The folder of a Markdown file for each suite, if they are wanted.
    pub results: Option<&'a Path>,
}

/// The files that were written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Written {
    /// The page.
    pub page: PathBuf,
    /// All tables, in the order of the page.
    pub results: PathBuf,
    /// The first table of each experiment, for a README.
    pub summary: PathBuf,
    /// The figures as SVG.
    pub figures: Vec<PathBuf>,
    /// The tables of each suite, one file per suite.
    pub suites: Vec<PathBuf>,
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

    /// Returns all tables. Figures are linked from the folder `figures`, if it is given.
    pub fn to_markdown(&self, figures: Option<&str>) -> String {
        let mut out = format!("{PAPERS_MARK}\n");
        for (suite, section) in sections::sections(&self.suites) {
            self.heading(&mut out, suite, &section);
            self.content(&mut out, suite, &section, figures);
        }
        out
    }

    /// Returns a document with the tables of each suite, by the suite's name, headed by machine, command and method.
    /// `figures` as in [`BenchReport::to_markdown`].
    pub fn to_documents(&self, figures: Option<&str>) -> Vec<(String, String)> {
        let sections = sections::sections(&self.suites);
        let names = unique(sections.iter().map(|(suite, _)| suite.name.as_str()));
        names.into_iter().map(|name| (name.to_owned(), self.document(&sections, name, figures))).collect()
    }

    fn document(&self, sections: &[(&Suite, Section)], name: &str, figures: Option<&str>) -> String {
        let of_suite: Vec<_> = sections.iter().filter(|(suite, _)| suite.name == name).collect();
        let titles = unique(of_suite.iter().map(|(_, section)| section.title.to_lowercase()));
        let title = match &of_suite[..] {
            [(_, section)] => section.title.clone(),
            _ => format!("{}{}: {}", name[..1].to_uppercase(), &name[1..], titles.join(", ")),
        };
        let mut out = format!(
            "# {title}\n\n<!-- Written by yoro report --results: change nothing here by hand. -->\n\n"
        );
        for suite in self.suites.iter().filter(|suite| suite.name == name) {
            source(&mut out, suite);
        }
        let _ = writeln!(out, "\n{QUALITY_METHOD}\n\n{TIME_METHOD}\n\n{PAPERS_MARK}");
        for (suite, section) in &of_suite {
            match of_suite.len() {
                1 => {
                    let _ = writeln!(out, "\n{}\n", section.intro);
                }
                _ => self.heading(&mut out, suite, section),
            }
            self.content(&mut out, suite, section, figures);
        }
        out
    }

    /// Writes a section's figures, tables and source.
    fn content(&self, out: &mut String, suite: &Suite, section: &Section, figures: Option<&str>) {
        if let Some(folder) = figures {
            for figure in &section.figures {
                let _ = writeln!(out, "![{}]({folder}/{}.svg)", figure.title, figure.id);
                let _ = writeln!(out, "\n*{}. {}*\n", figure.title, figure.caption);
            }
        }
        for table in &section.tables {
            let _ = writeln!(out, "{}", table.markdown());
        }
        source(out, suite);
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

    /// Writes [`FILES`] and, if they are wanted, the figures as SVG files and a `SUITE.md` for each suite.
    ///
    /// # Errors
    /// [`ReportError`]; existing files are then unchanged.
    pub fn write(&self, places: Places) -> Result<Written, ReportError> {
        // Everything is made before anything is written.
        let link = |from: &Path| places.figures.map(|figures| link_from(from, figures));
        let html = self.to_html()?;
        let tables = self.to_markdown(link(places.report).as_deref());
        let mut drawn = Vec::new();
        if let Some(to) = places.figures {
            for (_, section) in sections::sections(&self.suites) {
                for figure in &section.figures {
                    drawn.push((to.join(format!("{}.svg", figure.id)), figure.svg()?));
                }
            }
        }
        let mut suites = Vec::new();
        if let Some(to) = places.results {
            let documents = self.to_documents(link(to).as_deref());
            suites.extend(documents.into_iter().map(|(name, text)| (to.join(slug(&name) + ".md"), text)));
        }
        for (path, text) in drawn.iter().chain(&suites) {
            files::write(path, text.as_bytes())?;
        }
        let paths = |files: Vec<(PathBuf, String)>| files.into_iter().map(|(path, _)| path).collect();
        let [page, results, summary] = FILES.map(|name| places.report.join(name));
        let written = Written { page, results, summary, figures: paths(drawn), suites: paths(suites) };
        files::write(&written.results, tables.as_bytes())?;
        files::write(&written.summary, self.to_summary().as_bytes())?;
        files::write(&written.page, html.as_bytes())?;
        Ok(written)
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

/// Returns the relative path, with slashes, from a file in `folder` to `target`.
fn link_from(folder: &Path, target: &Path) -> String {
    let normal = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.to_path_buf());
    let (folder, target) = (normal(folder), normal(target));
    let (from, to): (Vec<Component>, Vec<Component>) =
        (folder.components().collect(), target.components().collect());
    let common = from.iter().zip(&to).take_while(|(a, b)| a == b).count();
    let up = from[common..].iter().map(|_| "..".to_owned());
    let down = to[common..].iter().map(|part| part.as_os_str().to_string_lossy().into_owned());
    let parts: Vec<String> = up.chain(down).collect();
    if parts.is_empty() { ".".into() } else { parts.join("/") }
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
