//! `cargo xtask maintain estimate`: what whole frames cost on mobile GPUs that are not here, and the shaders' own costs.
//!
//! The library builds all programs in a context on this machine, `shader-programs` of tests/ prints their texts, and
//! [`Compilers`] compile them. The results are committed as `xtask/helpers/estimate/shader-cost.csv`, from which the
//! program in that folder computes the cost of frames that it renders and counts. See docs/performance.md.

mod compilers;
mod gpus;
mod listing;
mod patches;
mod table;

use std::fs;
use std::path::Path;
use std::process::Stdio;
use std::thread;

use anyhow::{Context as _, bail, ensure};
use serde_json::Value;

pub use compilers::Compilers;
pub use gpus::Gpu;

use crate::cargo;
use crate::folders::{root, write};

use compilers::Run;
use gpus::{GPUS, IN_TABLE};
pub use table::{Row, Table};

/// The committed table, relative to the workspace.
const TABLE: &str = "xtask/helpers/estimate/shader-cost.csv";

/// The GPUs and programs, by their beginning, that may have fewer than half of the waves in flight.
const FEW_WAVES: [(&str, &str); 1] = [
    // It gathers twice as much; one fragment for each 128 pixels.
    ("a650", "synthesis/gather/tiles.frag DEPTH_PAIRS"),
];

/// Which programs and GPUs to compile for, and what to do with the results.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Compile only programs whose names contain this.
    pub filter: Option<String>,
    /// GPUs to use instead of those in the table.
    pub gpus: Vec<Gpu>,
    /// Update the table.
    pub bless: bool,
}

/// Compiles programs, which are JSON as written by `shader-programs`. Returns a text, and true if no program has a fault.
///
/// # Errors
/// Fails if the compilers do not work, or no program matches the filter.
pub fn report(
    options: &Options,
    compilers: &Compilers,
    programs: Vec<Value>,
) -> anyhow::Result<(String, bool)> {
    let gpus = if options.gpus.is_empty() { GPUS[..IN_TABLE].to_vec() } else { options.gpus.clone() };
    let programs = chosen(programs, options.filter.as_deref())?;
    let names: Vec<String> = programs.iter().map(|program| text_of(program, "name")).collect();
    let file = compilers.folder().join(format!("programs-{}.json", std::process::id()));
    write(&file, serde_json::to_string(&programs)?)?;
    let runs = compile(compilers, &gpus, &file);
    fs::remove_file(&file).ok();
    let mut found = Table::default();
    let mut faults = Vec::new();
    for (gpu, run) in gpus.iter().zip(runs?) {
        faults.extend(refusals(gpu, &names, &run));
        for (program, said) in programs.iter().zip(&run.programs).filter(|(_, said)| said.ok) {
            let mut rows = Row::all(gpu, &text_of(program, "name"), said);
            // The cost of three vertices is negligible.
            let vertex = text_of(&program["stages"][0], "file");
            let screen = ["screen.vert", "synthesis/march.vert"].contains(&vertex.as_str());
            rows.retain(|row| !screen || row.stage == "fragment");
            found.rows.extend(rows);
        }
        found.mesa = run.mesa;
    }
    let mut text = described(&gpus, &found) + "\n";
    faults.extend(found.rows.iter().filter_map(fault));
    for fault in &faults {
        text += &format!("FAULT: {fault}\n");
    }
    if options.bless {
        let path = root().join(TABLE);
        let mut table = match fs::read_to_string(&path) {
            Ok(text) => {
                Table::parse(&text).with_context(|| format!("{TABLE} is damaged: restore it from git"))?
            }
            Err(_) => Table::default(),
        };
        // Rows of removed programs are only deleted if all programs have been compiled.
        table.rows.retain(|row| options.filter.is_some() || !gpus.iter().any(|gpu| gpu.name == row.gpu));
        table.mesa = found.mesa;
        table.take_over(found.rows);
        write(&path, table.to_text())?;
        text += &format!("{TABLE} renewed: look at `git diff -- {TABLE}`\n");
    }
    Ok((text, faults.is_empty()))
}

/// Returns the texts of all programs, as written by `shader-programs` of tests/, and of the march in parts.
///
/// # Errors
/// Fails if it does not compile or run.
pub fn programs() -> anyhow::Result<Vec<Value>> {
    cargo::succeeds(&["xtask", "setup"], &[]);
    let text = cargo::output(&["run", "--quiet", "--package", "yoro-tests", "--bin", "shader-programs"])?;
    let programs = serde_json::from_str(&text);
    let mut programs =
        programs.context("shader-programs has written something else than a list of programs")?;
    patches::add_parts(&mut programs)?;
    Ok(programs)
}

/// Returns what whole frames cost. `arguments` are those of the program in `xtask/helpers/estimate`.
///
/// # Errors
/// Fails if it does not compile or run.
pub fn frames(arguments: &[String]) -> anyhow::Result<String> {
    let mut command = cargo::program("yoro-estimate")?;
    command.args(arguments).env("YORO_SHADERS", patches::counting_shaders()?).stderr(Stdio::inherit());
    let output = command.output().context("yoro-estimate cannot be started")?;
    ensure!(output.status.success(), "yoro-estimate failed: see above");
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}

fn chosen(mut programs: Vec<Value>, filter: Option<&str>) -> anyhow::Result<Vec<Value>> {
    if let Some(filter) = filter {
        programs.retain(|program| text_of(program, "name").contains(filter));
    }
    if programs.is_empty() {
        bail!("no shader program is called so: say less of its name, such as gather");
    }
    Ok(programs)
}

fn text_of(value: &Value, name: &str) -> String {
    value[name].as_str().unwrap_or_default().to_owned()
}

/// Compiles for all GPUs at the same time, in a process each. Returns the runs in the order of the GPUs.
fn compile(compilers: &Compilers, gpus: &[Gpu], programs: &Path) -> anyhow::Result<Vec<Run>> {
    thread::scope(|scope| {
        let start = |gpu| scope.spawn(move || compilers.run(gpu, programs));
        let running: Vec<_> = gpus.iter().map(start).collect();
        running.into_iter().map(|thread| thread.join().expect("no compiler panics")).collect()
    })
}

/// Returns messages about programs that do not compile or link, or that crash the compiler.
fn refusals(gpu: &Gpu, names: &[String], run: &Run) -> Vec<String> {
    let refused = names.iter().zip(&run.programs).filter(|(_, said)| !said.ok);
    let mut faults: Vec<String> = refused
        .map(|(name, said)| format!("{name} is refused on {}: {}", gpu.title, said.log.replace('\n', "; ")))
        .collect();
    if let Some(name) = names.get(run.programs.len()) {
        faults.push(format!("{name} crashes the compiler for {}; what follows was not compiled", gpu.title));
    }
    faults
}

/// Returns what is wrong with a compiled shader, if anything: it spills, or fewer than half of the waves that the GPU can
/// have in flight are in flight.
fn fault(row: &Row) -> Option<String> {
    let gpu: Gpu = row.gpu.parse().ok()?;
    let most = gpu.compiler.most_waves();
    let is_known = FEW_WAVES.iter().any(|(gpu, program)| row.gpu == *gpu && row.program.starts_with(program));
    let what = if row.spills > 0 {
        format!("spills: {} accesses to memory in the place of registers", row.spills)
    } else if 2 * row.waves < most && !is_known {
        format!("has only {} of {most} waves in flight", row.waves)
    } else {
        return None;
    };
    let Row { program, stage, .. } = row;
    let remedy = "make it smaller, or name it with a reason in xtask/src/maintain/estimate/mod.rs";
    Some(format!("{program} ({stage}) on {} {what}: {remedy}", gpu.title))
}

/// Returns a paragraph per GPU, with a line for each shader.
fn described(gpus: &[Gpu], found: &Table) -> String {
    let width = found.rows.iter().map(|row| row.program.len()).max().unwrap_or(0);
    let mut text = format!("Mesa {}; loops: issue slots/fetches of each body, once through\n", found.mesa);
    for gpu in gpus {
        text += &format!(
            "\n{} ({})\n{:width$}  {:8} {:>6} {:>5} {:>6} {:>6} {:>7} {:>6}  {}\n",
            gpu.title,
            gpu.name,
            "program",
            "stage",
            "instr",
            "slots",
            "regs",
            "waves",
            "fetches",
            "spills",
            "loops; cycles",
        );
        for row in found.rows.iter().filter(|row| row.gpu == gpu.name) {
            let optional = |number: Option<u32>| number.map_or_else(|| "-".to_owned(), |n| n.to_string());
            let end = [row.loops.as_str(), row.cycles.as_str()].join("; ");
            let line = format!(
                "{:width$}  {:8} {:>6} {:>5} {:>6} {:>6} {:>7} {:>6}  {}",
                row.program,
                row.stage,
                row.instructions,
                optional(row.slots),
                row.registers,
                format!("{}/{}", row.waves, gpu.compiler.most_waves()),
                optional(row.fetches),
                row.spills,
                end.trim_matches([';', ' ']),
            );
            text += line.trim_end();
            text += "\n";
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::compilers::DriverOutput;
    use super::table::tests::row;
    use super::*;

    #[test]
    fn spills_and_few_waves_are_faults_unless_accepted() {
        assert_eq!(fault(&row("a650", "x.frag", 8, 0)), None);
        let few = fault(&row("a650", "x.frag", 7, 0)).unwrap();
        assert!(few.contains("7 of 16 waves"), "{few}");
        assert!(fault(&row("g57", "x.frag", 2, 3)).is_some());
        assert_eq!(fault(&row("g57", "x.frag", 1, 0)), None);
        assert_eq!(fault(&row("a650", FEW_WAVES[0].1, 7, 0)), None);
        assert!(fault(&row("a650", FEW_WAVES[0].1, 16, 2)).is_some());
        assert!(fault(&row("g52", FEW_WAVES[0].1, 0, 0)).is_some());
    }

    #[test]
    fn refused_programs_and_crashes_are_faults() {
        let said = |ok| DriverOutput { ok, log: "0:1: no".into(), messages: vec![], listing: String::new() };
        let names = ["a", "b", "c", "d"].map(str::to_owned);
        let run = Run { mesa: "26".into(), programs: vec![said(true), said(false)] };
        let faults = refusals(&"g52".parse().unwrap(), &names, &run);
        assert_eq!(faults.len(), 2, "{faults:?}");
        assert!(faults[0].starts_with("b is refused on Mali-G52: 0:1: no"), "{}", faults[0]);
        assert!(faults[1].starts_with("c crashes"), "{}", faults[1]);
    }
}
