//! `yoro device report`: captures in, a page and tables out.

use std::path::PathBuf;

use crate::cli::machine;
use crate::device::capture;
use crate::device::report::DeviceReport;
use crate::files;

/// Figures of captures: power, frame rate, temperature and the rest, each method against the baseline
#[derive(clap::Args, Clone, Debug)]
pub struct ReportArgs {
    /// Folders with captures, at any depth; the same repetition in another folder counts as another one
    #[arg(required = true, value_name = "FOLDER")]
    folders: Vec<PathBuf>,
    /// The method that the others are held against
    #[arg(long, default_value = "conventional", value_name = "METHOD")]
    baseline: String,
    /// Folder for report.html, report.md and report.json
    #[arg(long, default_value = "out/device", value_name = "FOLDER")]
    out: PathBuf,
}

/// Reads the captures, writes the report and prints what matters.
pub fn run(args: &ReportArgs) -> anyhow::Result<()> {
    let mut sets = Vec::new();
    for folder in &args.folders {
        let mut captures = Vec::new();
        for run in capture::find(std::slice::from_ref(folder))? {
            let capture = capture::read(&run)?;
            captures.push((run, capture));
        }
        sets.push(captures);
    }
    files::create_folder(&args.out)?;
    let report = DeviceReport::new(&sets, &args.baseline, machine::made_by());
    let written = report.write(&args.out)?;
    print!("{}", report.to_text());
    println!("page:   {}", written.page.display());
    println!("tables: {}", written.markdown.display());
    println!("json:   {}", written.json.display());
    Ok(())
}
