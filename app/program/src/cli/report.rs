//! `yoro report`: turns results of `yoro bench` into a page and tables.

use std::path::PathBuf;

use super::Subcommand;
use super::outputs::Files;
use yoro_bench::bench::Results;
use yoro_bench::report::bench::BenchReport;
use yoro_files as files;

/// Turn results of `yoro bench` into a self-contained page and Markdown tables
#[derive(clap::Args, Clone, Debug)]
pub struct ReportArgs {
    /// Result files (JSON lines) of `yoro bench`; suites measured on several machines stand side by side
    #[arg(required = true, value_name = "FILE.jsonl")]
    files: Vec<PathBuf>,
    /// Folder for report.html and report.md
    #[arg(long, default_value = "out", value_name = "FOLDER")]
    out: PathBuf,
}

impl Subcommand for ReportArgs {
    fn files(&self) -> anyhow::Result<Files> {
        let mut files = Files::default();
        files.read(&self.files);
        for path in BenchReport::files(&self.out).paths() {
            files.write(path, "the report");
        }
        Ok(files)
    }

    /// Reads the results, writes the report and prints where it is.
    fn run(&self) -> anyhow::Result<()> {
        let results = self.files.iter().map(|path| Results::read(path)).collect::<Result<Vec<_>, _>>()?;
        let report = BenchReport::new(results)?;
        // Drawing figures takes a while, so that a folder that cannot be created is reported first.
        files::create_folder(&self.out)?;
        print!("{}", report.write(&self.out)?);
        Ok(())
    }
}
