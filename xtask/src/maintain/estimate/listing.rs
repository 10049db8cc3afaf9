//! Parses the compilers' output: statistics and disassembled shaders.

use std::collections::HashMap;
use std::collections::{BTreeMap, btree_map};

use super::gpus::Compiler;

/// The kind of a compiled shader.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Stage {
    /// A vertex shader. On Mali, the part that runs after triangles have been culled.
    Vertex,
    /// On Mali, the part of a vertex shader that runs before culling.
    Position,
    Fragment,
    Compute,
}

impl Stage {
    /// Returns the stage's name in the table.
    pub fn name(self) -> &'static str {
        match self {
            Self::Vertex => "vertex",
            Self::Position => "position",
            Self::Fragment => "fragment",
            Self::Compute => "compute",
        }
    }

    /// Parses the stage in a line of statistics. Adreno's BVERT, for the binning pass, is part of VERT and ignored.
    fn of_statistics(name: &str) -> Option<Self> {
        Some(match name {
            "VERT" | "MESA_SHADER_VERTEX" | "MESA_SHADER_VARYING" => Self::Vertex,
            "MESA_SHADER_POSITION" => Self::Position,
            "FRAG" | "MESA_SHADER_FRAGMENT" => Self::Fragment,
            "CL" | "COMP" | "MESA_SHADER_COMPUTE" => Self::Compute,
            _ => return None,
        })
    }
}

/// The named numbers of a line of statistics.
#[derive(Clone, Debug, PartialEq)]
pub struct Statistics(HashMap<String, f64>);

impl Statistics {
    /// Parses `FRAG shader: 437 inst, 191 nops, ...`. Returns `None` for any other message.
    pub fn parse(message: &str) -> Option<(Stage, Self)> {
        let (name, list) = message.trim().split_once(" shader: ")?;
        let mut values = HashMap::new();
        for item in list.split(", ") {
            let (number, name) = item.split_once(' ')?;
            if let (Some((a, b)), Some((name_a, name_b))) = (number.split_once(':'), name.split_once(':')) {
                values.insert(name_a.to_owned(), a.parse().ok()?);
                values.insert(name_b.to_owned(), b.parse().ok()?);
            } else {
                values.insert(name.to_owned(), number.parse().ok()?);
            }
        }
        Some((Stage::of_statistics(name)?, Self(values)))
    }

    /// Returns a number by name, or 0 if the line does not have it.
    pub fn get(&self, name: &str) -> f64 {
        self.0.get(name).copied().unwrap_or(0.0)
    }
}

/// A disassembled shader.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Code {
    instructions: Vec<Instruction>,
    /// Jumps from an instruction to an earlier one, as indices.
    back_edges: Vec<(usize, usize)>,
    /// On Adreno, the number of instructions at the beginning that run only once per draw call.
    preamble: usize,
    /// On Adreno, the number of fetches that start before the first instruction, at coordinates not computed.
    prefetches: u32,
    /// On Adreno, true if waves have 128 lanes instead of 64.
    pub double_wave: bool,
}

/// One line of the listing. On Bifrost, a tuple of instructions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Instruction {
    /// Issue slots, including repetitions and pauses that the instruction encodes.
    slots: u32,
    fetch: bool,
}

/// The cost of executing a loop's body once, including the loops inside it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Loop {
    /// Number of enclosing loops.
    pub depth: usize,
    /// Issue slots per lane.
    pub slots: u32,
    pub fetches: u32,
}

impl Code {
    /// Parses the last fragment or compute shader in the compiler's output for one program.
    pub fn parse(compiler: Compiler, listing: &str) -> Option<Self> {
        match compiler {
            Compiler::Ir3 => Self::ir3(listing),
            Compiler::Bifrost | Compiler::Valhall => {
                let kinds = ["MESA_SHADER_FRAGMENT shader:", "MESA_SHADER_COMPUTE shader:"];
                let end = kinds.iter().filter_map(|kind| listing.rfind(&format!("\n{kind}"))).max()?;
                let listing = &listing[..end];
                Some(match compiler {
                    Compiler::Bifrost => Self::bifrost(&listing[listing.rfind("\nclause_0:")?..]),
                    _ => Self::valhall(&listing[listing.rfind("\n}").map_or(0, |at| at + 1)..]),
                })
            }
        }
    }

    fn ir3(listing: &str) -> Option<Self> {
        let (_, native) = listing.rsplit_once("MESA: info: Native code for ")?;
        let double_wave = native.contains(", 1 double_threadsize");
        let mut code = Self { double_wave, ..Self::default() };
        let (mut labels, mut jumps) = (HashMap::new(), Vec::new());
        for line in native.lines().skip(1) {
            let line = line.strip_prefix("MESA: info: ").unwrap_or(line).trim();
            if line.starts_with("@tex(") {
                code.prefetches += 1;
            }
            if line.is_empty() || line.starts_with([';', '@', '-']) || line.starts_with("SIMD") {
                continue;
            }
            if let Some(label) = line.strip_suffix(':') {
                labels.insert(label.to_owned(), code.instructions.len());
                continue;
            }
            let (flags, operation) = flags(line);
            let fetches = ["sam", "isam", "gather"];
            let fetch = fetches.iter().any(|name| operation.starts_with(name));
            code.instructions.push(Instruction { slots: 1 + flags, fetch });
            if operation == "shpe" {
                code.preamble = code.instructions.len();
            }
            if let Some((_, target)) = line.split_once('#')
                && target.starts_with('l')
            {
                let end = target.find(|c: char| !c.is_ascii_alphanumeric()).unwrap_or(target.len());
                jumps.push((code.instructions.len() - 1, target[..end].to_owned()));
            }
            if operation == "end" {
                break;
            }
        }
        code.add_jumps(jumps.into_iter().filter_map(|(from, to)| Some((from, *labels.get(&to)?))));
        Some(code)
    }

    fn valhall(listing: &str) -> Self {
        let mut code = Self::default();
        let mut jumps = Vec::new();
        for line in listing.lines().skip(1).map(str::trim).filter(|line| !line.is_empty()) {
            let at = code.instructions.len();
            let fetch = line.starts_with("TEX_") || line.starts_with("VAR_TEX");
            code.instructions.push(Instruction { slots: 1, fetch });
            if let Some((_, offset)) = line.split_once("offset:-")
                && (line.starts_with("BRANCH") || line.starts_with("JUMP"))
            {
                let offset: usize = offset.trim().parse().unwrap_or(0);
                jumps.push((at, (at + 1).saturating_sub(offset)));
            }
        }
        code.add_jumps(jumps.into_iter());
        code
    }

    fn bifrost(listing: &str) -> Self {
        let mut code = Self::default();
        let (mut labels, mut jumps) = (HashMap::new(), Vec::new());
        for line in listing.lines().map(str::trim) {
            if let Some(label) = line.strip_suffix(':').filter(|label| label.starts_with("clause_")) {
                labels.insert(label.to_owned(), code.instructions.len());
            } else if line.starts_with('*') {
                code.instructions.push(Instruction { slots: 1, fetch: false });
            } else if let Some(operation) = line.strip_prefix('+')
                && let Some(tuple) = code.instructions.last_mut()
            {
                tuple.fetch |= operation.starts_with("TEX") || operation.starts_with("VAR_TEX");
                if let Some(target) = line.split(' ').next_back().filter(|word| word.starts_with("clause_")) {
                    jumps.push((code.instructions.len() - 1, target.to_owned()));
                }
            }
        }
        code.add_jumps(jumps.into_iter().filter_map(|(from, to)| Some((from, *labels.get(&to)?))));
        code
    }

    fn add_jumps(&mut self, jumps: impl Iterator<Item = (usize, usize)>) {
        self.back_edges.extend(jumps.filter(|(from, to)| to <= from));
    }

    /// Returns the issue slots per lane if each loop's body and both sides of each branch run once.
    pub fn slots(&self) -> u32 {
        self.instructions[self.preamble..].iter().map(|instruction| instruction.slots).sum()
    }

    /// Returns the number of texture instructions in the code, however often they run.
    pub fn fetches(&self) -> u32 {
        let fetches = self.instructions.iter().map(|instruction| u32::from(instruction.fetch));
        self.prefetches + fetches.sum::<u32>()
    }

    /// Returns the loops in the order of their first instructions.
    pub fn loops(&self) -> Vec<Loop> {
        let mut spans: BTreeMap<usize, usize> = BTreeMap::new();
        for &(tail, head) in &self.back_edges {
            match spans.entry(head) {
                btree_map::Entry::Vacant(vacant) => {
                    vacant.insert(tail);
                }
                btree_map::Entry::Occupied(mut last) => *last.get_mut() = tail.max(*last.get()),
            }
        }
        let around =
            |head: usize, tail: usize| spans.iter().filter(|&(&h, &t)| h < head && tail <= t).count();
        let bodies = spans.iter().map(|(&head, &tail)| {
            let body = &self.instructions[head..=tail];
            Loop {
                depth: around(head, tail),
                slots: body.iter().map(|instruction| instruction.slots).sum(),
                fetches: body.iter().map(|instruction| u32::from(instruction.fetch)).sum(),
            }
        });
        bodies.collect()
    }
}

/// Splits an Adreno instruction into the slots that its flags `(rptN)` and `(nopN)` add, and the operation.
fn flags(line: &str) -> (u32, &str) {
    let (mut rest, mut slots) = (line, 0);
    while let Some((flag, after)) = rest.strip_prefix('(').and_then(|rest| rest.split_once(')')) {
        let number = flag.strip_prefix("rpt").or_else(|| flag.strip_prefix("nop"));
        slots += number.and_then(|number| number.parse::<u32>().ok()).unwrap_or(0);
        rest = after.trim_start();
    }
    (slots, rest.split(' ').next().unwrap_or(rest))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn statistics_are_read_by_name() {
        let (stage, adreno) = Statistics::parse("FRAG shader: 437 inst, 10 waves, 0 stp\n").unwrap();
        assert_eq!((stage, adreno.get("inst"), adreno.get("waves")), (Stage::Fragment, 437.0, 10.0));
        let line = "MESA_SHADER_COMPUTE shader: 9 instrs, 1.750000 t, 2:3 spills:fills, 30 registers used";
        let (stage, mali) = Statistics::parse(line).unwrap();
        assert_eq!((stage, mali.get("t"), mali.get("registers used")), (Stage::Compute, 1.75, 30.0));
        assert_eq!((mali.get("spills"), mali.get("fills"), mali.get("absent")), (2.0, 3.0, 0.0));
        assert_eq!(Statistics::parse("BVERT shader: 11 inst"), None);
        assert_eq!(Statistics::parse("something else"), None);
    }

    #[test]
    fn loops_of_adreno_are_found_with_their_slots() {
        let listing = "MESA: info: Native code for unnamed FRAG shader\n\
                       MESA: info: @tex(r0.x)\tsrc=0, samp=0, tex=0, wrmask=0x8, cmd=SAM\n\
                       MESA: info: shps #l1\n\
                       MESA: info: (sy)(ss)shpe\n\
                       MESA: info: l1:\n\
                       MESA: info: (jp)(rpt2)nop\n\
                       MESA: info: l2:\n\
                       MESA: info: isam.1d (f32)(x)r0.w, r2.z, s#0, t#0\n\
                       MESA: info: l3:\n\
                       MESA: info: (nop2) add.f r0.x, r0.y, r0.z\n\
                       MESA: info: br p0.x, #l3\n\
                       MESA: info: jump #l2\n\
                       MESA: info: end\n\
                       MESA: info: nop\n\
                       MESA: info: ; FRAG prog 10/1: 10 max_waves, 1 double_threadsize\n";
        let code = Code::parse(Compiler::Ir3, listing).unwrap();
        assert!(code.double_wave);
        assert_eq!((code.slots(), code.fetches()), (10, 2));
        let loops = [Loop { depth: 0, slots: 6, fetches: 1 }, Loop { depth: 1, slots: 4, fetches: 0 }];
        assert_eq!(code.loops(), loops);
    }

    #[test]
    fn loops_of_mali_are_found_with_their_slots() {
        let valhall = "block0 {\n   old\n} -> block1\n   MOV.i32 r0, r1\n   TEX_FETCH.slot0 @r0\n\n   \
                       BRANCHZ.eq.reconverge 0x0, offset:-2\n   BLEND.end\n\
                       MESA_SHADER_FRAGMENT shader: 4 instrs\n";
        let code = Code::parse(Compiler::Valhall, valhall).unwrap();
        assert_eq!((code.slots(), code.fetches()), (4, 1));
        assert_eq!(code.loops(), [Loop { depth: 0, slots: 2, fetches: 1 }]);
        let bifrost = "\nclause_0:\nds(0) \n{\n    *NOP t0\n    +NOP t1\n}\n\nclause_2:\n{\n    *NOP t0\n    \
                       +TEXC.skip t1, r49\n    *NOP t0\n    +JUMP t1, clause_2\n}\n\n\
                       MESA_SHADER_COMPUTE shader: 4 instrs\n";
        let code = Code::parse(Compiler::Bifrost, bifrost).unwrap();
        assert_eq!((code.slots(), code.fetches()), (3, 1));
        assert_eq!(code.loops(), [Loop { depth: 0, slots: 2, fetches: 1 }]);
        assert_eq!(Code::parse(Compiler::Valhall, "MESA_SHADER_POSITION shader: 1 instrs"), None);
    }
}
