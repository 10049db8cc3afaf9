//! The report of `yoro bench`: files of results as sections of tables, plots and pictures.

use std::path::Path;

use anyhow::{anyhow, bail};
use yoro::eyes::Eye;
use yoro_report::{Pictures, Report, ReportFiles, Section, Text};

use super::pictures::{QUALITY_METHOD, Viewpoint, picture_folder};
use super::record::{Results, metric};
use super::results::{self, CONVENTIONAL, MONO, SuiteData};
use super::suites::EXPERIMENTS;
use super::tables;
use crate::machine::{Machine, Parameter};

/// The heading of the page.
const TITLE: &str = "yoro: every method side by side";

/// Explains the marks by which the paper's figures are recognized.
const PAPERS_MARK: &str = "What is in italics, hollow or dashed is the paper's (\"You Only Render Once\", MobiSys '25): \
its own scenes, six phones and a Quest 2.";

/// Explains how frame times are measured.
const TIME_METHOD: &str = "Frame times: wall clock of a whole stereo frame up to glFinish. Methods take turns within \
each round, so that ratios pair frames of the same round; means of ratios over scenes are geometric.";

/// The combined contents of files of results.
pub struct BenchReport {
    files: Vec<Results>,
    suites: Vec<SuiteData>,
    pictures: Vec<Pictures>,
}

impl BenchReport {
    /// Combines files and loads the pictures beside them.
    ///
    /// # Errors
    /// One sentence, for a file without a finished round and for damaged pictures.
    pub fn new(files: Vec<Results>) -> anyhow::Result<BenchReport> {
        if let Some(empty) = files.iter().find(|file| file.measurements().next().is_none()) {
            bail!("{} holds no finished round: let yoro bench finish one, then report", empty.path.display());
        }
        let pictures: Vec<Vec<Pictures>> = files.iter().map(load_pictures).collect::<Result<_, _>>()?;
        Ok(BenchReport { suites: results::suites(&files), files, pictures: pictures.concat() })
    }

    /// Returns the sections of all suites in the order of [`EXPERIMENTS`], then those of suites that are not known, the
    /// pictures, and how everything was measured.
    pub fn report(&self) -> Report {
        let mut sections = Vec::new();
        for experiment in EXPERIMENTS {
            for suite in self.suites.iter().filter(|suite| suite.name == experiment.name()) {
                let of_suite = experiment.sections(suite).into_iter();
                sections.extend(of_suite.map(|section| self.finished(section, suite)));
            }
        }
        let is_known = |suite: &&SuiteData| EXPERIMENTS.iter().any(|known| known.name() == suite.name);
        let unknown = self.suites.iter().filter(|suite| !is_known(suite));
        sections.extend(unknown.map(|suite| self.finished(tables::everything("", suite), suite)));
        let mut pictures = Section::new("Pictures", QUALITY_METHOD);
        self.pictures.iter().for_each(|view| pictures.pictures(view.clone()));
        sections.push(pictures);
        sections.retain(|section| !section.is_empty());
        sections.push(self.method());
        let mut summary: Vec<Text> = self.suites.iter().flat_map(answers).map(Text::from).collect();
        summary.push(PAPERS_MARK.into());
        Report { title: TITLE.into(), summary, sections }
    }

    /// Writes `report.html` and `report.md` into a folder.
    ///
    /// # Errors
    /// One sentence; existing files are then unchanged.
    pub fn write(&self, folder: &Path) -> anyhow::Result<ReportFiles> {
        self.report().write(folder, "report", None)
    }

    /// Adds how and where a suite was measured.
    fn finished(&self, mut section: Section, suite: &SuiteData) -> Section {
        section.place = self.place(suite).unwrap_or_default();
        let machine = &suite.header.machine;
        if !section.is_empty() {
            section.text(Text::quiet(format!(
                "`{}` on {}, {} cores, {}, {}.",
                machine.command, machine.cpu, machine.cores, machine.gl_renderer, machine.date
            )));
        }
        section
    }

    /// Returns the GL renderer if several machines measured the same suite, with its version if only that differs.
    fn place(&self, suite: &SuiteData) -> Option<String> {
        let Machine { gl_renderer, gl_version, .. } = &suite.header.machine;
        let others = || self.suites.iter().filter(|other| other.name == suite.name);
        let machines = others().map(|other| &other.header.machine);
        let mut versions = machines.filter(|m| m.gl_renderer == *gl_renderer).map(|m| &m.gl_version);
        match (others().count() > 1, versions.any(|version| version != gl_version)) {
            (false, _) => None,
            (true, false) => Some(gl_renderer.clone()),
            (true, true) => Some(format!("{gl_renderer}, {gl_version}")),
        }
    }

    /// Returns how figures are measured, and the parameters of each file.
    fn method(&self) -> Section {
        let mut section = Section::new("How it was measured", TIME_METHOD);
        section.text(QUALITY_METHOD);
        for Results { path, header, .. } in &self.files {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            let Machine { gl_version, os, yoro, .. } = &header.machine;
            let parameters = header.parameters.iter().map(|p| format!("{}: {}", p.name, p.value));
            let parameters = parameters.collect::<Vec<_>>().join("; ");
            let machine = format!("GL: {gl_version}; OS: {os}; yoro: {yoro}");
            section.text(Text::quiet(format!("`{name}`: {machine}; {parameters}.")));
        }
        section
    }
}

/// Returns a sentence for each pipeline on the suite `scenes`: its quality and its cost, each beside its baseline.
fn answers(suite: &SuiteData) -> Vec<String> {
    let of = |name: &str| {
        let mean = |contender: &str, metric| suite.mean(contender, metric);
        let both = |contender: &str| Some((mean(contender, metric::PSNR)?, mean(contender, metric::SSIM)?));
        let ((psnr, ssim), (same_psnr, same_ssim)) = (both(name)?, both(MONO)?);
        Some(format!(
            "**{name}**: the synthesized eye has PSNR **{psnr:.2} dB**, SSIM **{ssim:.4}** (same image to both eyes: \
             {same_psnr:.2} dB, {same_ssim:.4}); a stereo frame takes **{:.2}** of the time of two full renders. Means \
             over {}.",
            suite.mean_cost(name)?,
            suite.scenes().join(", ")
        ))
    };
    let names = suite.compared(metric::SSIM).into_iter();
    names.filter(|name| suite.name == "scenes" && name.starts_with("yoro")).filter_map(of).collect()
}

/// Loads the pictures beside a file, in the order of its settings.
fn load_pictures(file: &Results) -> anyhow::Result<Vec<Pictures>> {
    let mut all = Vec::new();
    let is_left = |p: &Parameter| p.name == "dominant eye" && p.value == Eye::Left.name();
    let dominant_eye = if file.header.parameters.iter().any(is_left) { Eye::Left } else { Eye::Right };
    for facts in file.scenes() {
        let folder = picture_folder(&file.path, &facts.conditions);
        // Not every suite's pictures include the dominant eye.
        if !["truth.png", "dominant.png"].iter().all(|name| folder.join(name).is_file()) {
            continue;
        }
        let load = |name: &str| yoro_media::load_color(&folder.join(format!("{name}.png")));
        let names = file.measurements().filter(|m| m.conditions == facts.conditions && m.round == 0);
        let names = names.map(|measurement| measurement.contender.as_str());
        let mut views = Vec::new();
        for name in names.filter(|name| ![CONVENTIONAL, MONO].contains(name)) {
            if folder.join(format!("{name}.png")).is_file() {
                views.push((name.to_owned(), load(name)?));
            }
        }
        let setting = &facts.conditions;
        let point = setting.label.clone().or(setting.point.map(|point| point.to_string()));
        let frame = facts.frames.first().cloned().unwrap_or_else(|| "first frame".into());
        let note = [Some(setting.suite.clone()), point, Some(frame)].into_iter().flatten();
        let viewpoint = Viewpoint { dominant_eye, dominant: load("dominant")?, truth: load("truth")?, views };
        let shown = viewpoint.shown(setting.scene.clone(), note.collect::<Vec<_>>().join(", "));
        let folder = folder.display();
        all.push(shown.map_err(|error| {
            anyhow!(
                "the pictures in {folder} do not go together ({error}): measure again, or remove the folder"
            )
        })?);
    }
    Ok(all)
}
