//! `yoro report`: turns results of `yoro bench` into a page and tables.

use std::path::PathBuf;

use super::Subcommand;
use super::outputs::Files;
use yoro_bench::bench::Results;
use yoro_bench::report::bench::{self, BenchReport, Places};
use yoro_files as files;

/// Turn results of `yoro bench` into a self-contained page, Markdown tables and figures
#[derive(clap::Args, Clone, Debug)]
pub struct ReportArgs {
    /// Result files (JSON lines) of `yoro bench`; suites measured on several machines stand side by side
    #[arg(required = true, value_name = "FILE.jsonl")]
    files: Vec<PathBuf>,
    /// Folder for report.html, results.md (all tables) and summary.md (the main ones)
    #[arg(long, default_value = "out", value_name = "FOLDER")]
    out: PathBuf,
    /// Also write the figures as SVG files into this folder, and link them in results.md
    #[arg(long, value_name = "FOLDER")]
    figures: Option<PathBuf>,
    /// Also write the tables of each suite into a file of its own, SUITE.md, in this folder
    #[arg(long, value_name = "FOLDER")]
    results: Option<PathBuf>,
}

impl Subcommand for ReportArgs {
    fn files(&self) -> anyhow::Result<Files> {
        let mut files = Files::default();
        files.read(&self.files);
        for name in bench::FILES {
            files.write(self.out.join(name), format!("the report's {name}"));
        }
        // The names of figures and suites are known only after reading the results, but their extensions are known now.
        for (folder, extension) in [(&self.figures, "svg"), (&self.results, "md")] {
            let Some(folder) = folder else { continue };
            let same = self.files.iter().filter(|file| files::has_extension(file, &[extension]));
            for name in same.filter_map(|file| file.file_name()) {
                files.write(folder.join(name), format!("the report's .{extension} files"));
            }
        }
        Ok(files)
    }

    /// Reads the results, writes the report and prints where it is.
    fn run(&self) -> anyhow::Result<()> {
        let results = self.files.iter().map(|path| Results::read(path)).collect::<Result<Vec<_>, _>>()?;
        let report = BenchReport::new(results)?;
        // Drawing figures takes a while, so that a folder that cannot be created is reported first.
        for folder in [Some(&self.out), self.figures.as_ref(), self.results.as_ref()].into_iter().flatten() {
            files::create_folder(folder)?;
        }
        let places =
            Places { report: &self.out, figures: self.figures.as_deref(), results: self.results.as_deref() };
        let written = report.write(places)?;
        println!("page:    {}", written.page.display());
        println!("tables:  {}", written.results.display());
        println!("summary: {}", written.summary.display());
        if let Some(folder) = &self.figures {
            println!("figures: {} in {}", written.figures.len(), folder.display());
        }
        if let Some(folder) = &self.results {
            println!("suites:  {} in {}", written.suites.len(), folder.display());
        }
        Ok(())
    }
}
