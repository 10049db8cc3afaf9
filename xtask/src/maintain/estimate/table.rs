//! The rows of `shader-cost.csv`: the cost of each compiled shader on each GPU.

use std::fmt::Write as _;
use std::str::FromStr;

use anyhow::{Context as _, bail};

use super::compilers::DriverOutput;
use super::gpus::{Compiler, Gpu};
use super::listing::{Code, Loop, Stage, Statistics};

/// The second line of the file, its header.
const COLUMNS: &str =
    "gpu,program,stage,instructions,slots,registers,waves,lanes_per_wave,fetches,spills,cycles,loops";

/// One compiled shader.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// The GPU, as in [`Gpu::name`].
    pub gpu: String,
    /// The file of the last stage and the macros, such as `synthesis/gather/march.frag WRITE_DEPTH`.
    pub program: String,
    /// The stage, as in `Stage::name`.
    pub stage: String,
    /// Number of instructions, as counted by the compiler; on Adreno issue slots.
    pub instructions: u32,
    /// Issue slots per lane if each loop's body and each side of a branch run once. Not for vertex shaders.
    pub slots: Option<u32>,
    /// Number of full registers: four times 32 bits on Adreno, 32 bits on Mali.
    pub registers: u32,
    /// Waves in flight at the same time, at most `Compiler::most_waves`.
    pub waves: u32,
    /// Lanes per wave on Adreno, which has two sizes. `None` on Mali.
    pub lanes_per_wave: Option<u32>,
    /// Number of texture instructions. Only for fragment and compute shaders.
    pub fetches: Option<u32>,
    /// Number of loads and stores of registers that are kept in memory.
    pub spills: u32,
    /// On Mali, the cycles of the busiest unit per lane if each loop's body runs once, and the unit.
    pub cycles: String,
    /// The loops' bodies in the order of the listing, as `SLOTS/FETCHES` with a `>` for each enclosing loop.
    pub loops: String,
}

/// Mali's units by their names in the statistics. Valhall's arithmetic is the busiest of three.
const UNITS: [(&str, &str); 8] = [
    ("arith", "arithmetic"),
    ("fma", "arithmetic"),
    ("cvt", "arithmetic"),
    ("sfu", "special functions"),
    ("t", "texture"),
    ("ldst", "load/store"),
    ("ls", "load/store"),
    ("v", "varyings"),
];

impl Row {
    /// Parses the driver's output for a program. Omits stages that the compiler has removed.
    pub fn all(gpu: &Gpu, program: &str, said: &DriverOutput) -> Vec<Self> {
        let mut rows: Vec<Self> = Vec::new();
        for (stage, statistics) in said.messages.iter().filter_map(|message| Statistics::parse(message)) {
            let row = Self::new(gpu, program, stage, &statistics, &said.listing);
            // If there are several variants, the last one is that of the listing.
            rows.retain(|other| other.stage != row.stage);
            if row.instructions > 0 {
                rows.push(row);
            }
        }
        rows
    }

    fn new(gpu: &Gpu, program: &str, stage: Stage, statistics: &Statistics, listing: &str) -> Self {
        let sum = |names: &[&str]| names.iter().map(|name| statistics.get(name) as u32).sum();
        let code = match stage {
            Stage::Fragment | Stage::Compute => Code::parse(gpu.compiler, listing),
            Stage::Vertex | Stage::Position => None,
        };
        let (instructions, registers, waves) = match gpu.compiler {
            Compiler::Ir3 => (sum(&["inst"]), sum(&["full"]), sum(&["waves"])),
            Compiler::Bifrost | Compiler::Valhall => {
                (sum(&["instrs"]), sum(&["registers used"]), sum(&["threads"]))
            }
        };
        let busiest = UNITS.into_iter().max_by(|a, b| statistics.get(a.0).total_cmp(&statistics.get(b.0)));
        let cycles = match (gpu.compiler, busiest) {
            (Compiler::Bifrost | Compiler::Valhall, Some((_, unit))) => {
                format!("{:.2} {unit}", statistics.get("cycles"))
            }
            _ => String::new(),
        };
        let lanes = |code: &Code| if code.double_wave { 128 } else { 64 };
        Self {
            gpu: gpu.name.to_owned(),
            program: program.to_owned(),
            stage: stage.name().to_owned(),
            instructions,
            slots: code.as_ref().map(Code::slots),
            registers,
            waves,
            lanes_per_wave: code.as_ref().filter(|_| gpu.compiler == Compiler::Ir3).map(lanes),
            fetches: code.as_ref().map(Code::fetches),
            spills: sum(&["stp", "ldp", "spills", "fills"]),
            cycles,
            loops: code.map_or_else(String::new, |code| loops_text(&code.loops())),
        }
    }

    fn key(&self) -> (&str, &str, &str) {
        (&self.gpu, &self.program, &self.stage)
    }
}

fn loops_text(loops: &[Loop]) -> String {
    let words: Vec<String> = loops
        .iter()
        .map(|body| format!("{}{}/{}", ">".repeat(body.depth), body.slots, body.fetches))
        .collect();
    words.join(" ")
}

impl FromStr for Row {
    type Err = anyhow::Error;

    fn from_str(line: &str) -> anyhow::Result<Self> {
        let cells: Vec<&str> = line.split(',').collect();
        let [
            gpu,
            program,
            stage,
            instructions,
            slots,
            registers,
            waves,
            lanes,
            fetches,
            spills,
            cycles,
            loops,
        ] = cells[..]
        else {
            bail!("a line has {} columns instead of {}", cells.len(), COLUMNS.split(',').count());
        };
        let number = |cell: &str| cell.parse::<u32>().with_context(|| format!("\"{cell}\" is no number"));
        let optional = |cell: &str| if cell.is_empty() { Ok(None) } else { number(cell).map(Some) };
        Ok(Self {
            gpu: gpu.to_owned(),
            program: program.to_owned(),
            stage: stage.to_owned(),
            instructions: number(instructions)?,
            slots: optional(slots)?,
            registers: number(registers)?,
            waves: number(waves)?,
            lanes_per_wave: optional(lanes)?,
            fetches: optional(fetches)?,
            spills: number(spills)?,
            cycles: cycles.to_owned(),
            loops: loops.to_owned(),
        })
    }
}

/// The rows that a version of Mesa has produced.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// Mesa's version.
    pub mesa: String,
    /// The rows, sorted by GPU, program and stage.
    pub rows: Vec<Row>,
}

impl Table {
    /// Adds rows, which replace those of the same shader and GPU, and sorts the table.
    pub fn take_over(&mut self, rows: impl IntoIterator<Item = Row>) {
        for row in rows {
            self.rows.retain(|old| old.key() != row.key());
            self.rows.push(row);
        }
        self.rows.sort_by(|a, b| a.key().cmp(&b.key()));
    }

    /// Returns the table as the text that [`Table::parse`] reads.
    pub fn to_text(&self) -> String {
        let mut text =
            format!("# Mesa {}; cargo xtask maintain estimate --shaders --bless\n{COLUMNS}\n", self.mesa);
        let optional = |number: Option<u32>| number.map_or_else(String::new, |number| number.to_string());
        for row in &self.rows {
            // Writing to a string cannot fail.
            let _ = writeln!(
                text,
                "{},{},{},{},{},{},{},{},{},{},{},{}",
                row.gpu,
                row.program,
                row.stage,
                row.instructions,
                optional(row.slots),
                row.registers,
                row.waves,
                optional(row.lanes_per_wave),
                optional(row.fetches),
                row.spills,
                row.cycles,
                row.loops
            );
        }
        text
    }

    /// Parses the text of a table.
    ///
    /// # Errors
    /// Fails if the text is not such a table.
    pub fn parse(text: &str) -> anyhow::Result<Self> {
        let mut lines = text.lines();
        let mesa = lines.next().and_then(|line| line.strip_prefix("# Mesa ")?.split(';').next());
        let mesa = mesa.context("the first line does not name a version of Mesa")?.to_owned();
        if lines.next() != Some(COLUMNS) {
            bail!("the columns are not {COLUMNS}");
        }
        Ok(Self { mesa, rows: lines.map(Row::from_str).collect::<anyhow::Result<_>>()? })
    }
}

#[cfg(test)]
pub mod tests {
    use super::*;

    pub fn row(gpu: &str, program: &str, waves: u32, spills: u32) -> Row {
        Row {
            gpu: gpu.to_owned(),
            program: program.to_owned(),
            stage: "fragment".to_owned(),
            instructions: 437,
            slots: Some(440),
            registers: 6,
            waves,
            lanes_per_wave: Some(128),
            fetches: Some(7),
            spills,
            cycles: String::new(),
            loops: "126/1 >71/2".to_owned(),
        }
    }

    #[test]
    fn a_table_is_read_as_it_was_written() {
        let mut table = Table { mesa: "26.1.6".to_owned(), rows: vec![row("g57", "b", 2, 0)] };
        let vertex = Row { slots: None, lanes_per_wave: None, fetches: None, ..row("a650", "a", 16, 0) };
        table.take_over([vertex, Row { instructions: 500, ..row("g57", "b", 2, 0) }]);
        assert_eq!(table.rows.iter().map(|row| row.instructions).collect::<Vec<_>>(), [437, 500]);
        assert_eq!(Table::parse(&table.to_text()).unwrap(), table);
        let damaged = table.to_text().replace(",500,", ",many,");
        assert!(Table::parse(&damaged).unwrap_err().to_string().contains("many"));
    }

    #[test]
    fn rows_come_from_statistics_and_listing() {
        let said = DriverOutput {
            ok: true,
            log: String::new(),
            messages: vec![
                "MESA_SHADER_POSITION shader: 16 instrs, 1.000000 cycles, 1.000000 ls, 2 threads".to_owned(),
                "MESA_SHADER_VERTEX shader: 0 instrs".to_owned(),
                "MESA_SHADER_FRAGMENT shader: 3 instrs, 1.750000 cycles, 1.750000 t, 0.5 cvt, 1 threads, \
                 1:2 spills:fills, 40 registers used"
                    .to_owned(),
            ],
            listing: "}\n TEX_FETCH r0\n MOV r0\n BLEND r0\nMESA_SHADER_FRAGMENT shader: 3 instrs".to_owned(),
        };
        let rows = Row::all(&"g57".parse().unwrap(), "x.frag", &said);
        assert_eq!(rows.iter().map(|row| row.stage.as_str()).collect::<Vec<_>>(), ["position", "fragment"]);
        let expected = Row {
            instructions: 3,
            slots: Some(3),
            registers: 40,
            lanes_per_wave: None,
            fetches: Some(1),
            cycles: "1.75 texture".to_owned(),
            loops: String::new(),
            ..row("g57", "x.frag", 1, 3)
        };
        assert_eq!(rows[1], expected);
    }
}
