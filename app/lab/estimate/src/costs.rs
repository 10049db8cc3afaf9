//! The cost of one invocation of each shader, from `shader-cost.csv`.

use anyhow::{Context as _, ensure};
use yoro_gl::ProgramRecipe;

/// The table that `cargo xtask maintain shader-cost --bless` writes.
const TABLE: &str = include_str!("../shader-cost.csv");
/// The macros of maps. The table has materials without maps and with all of these.
const MAPS: [&str; 4] = ["DIFFUSE_MAP", "SPECULAR_MAP", "EMISSIVE_MAP", "NORMAL_MAP"];

/// The cost of a fragment shader.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Fragment {
    /// Issue slots of an invocation without its loop over lamps; other loops are counted once.
    pub slots: f64,
    /// Issue slots per lamp.
    pub lamp: f64,
    /// The number of pixels in a wave.
    pub lanes: u32,
}

/// Issue slots and texture instructions.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Work {
    /// Issue slots.
    pub slots: f64,
    /// Texture instructions.
    pub fetches: f64,
}

impl Work {
    /// Returns this work and `times` executions of other work.
    pub fn plus(self, times: f64, other: Work) -> Work {
        Work { slots: self.slots + times * other.slots, fetches: self.fetches + times * other.fetches }
    }

    /// Returns this work without one execution of other work.
    pub fn minus(self, other: Work) -> Work {
        self.plus(-1.0, other)
    }
}

/// The work of executing each part of a shader once.
#[derive(Clone, Debug, PartialEq)]
pub struct Parts {
    /// The code outside of all loops.
    pub straight: Work,
    /// The bodies of all loops in the order of the listing, each without the loops inside it.
    pub loops: Vec<Work>,
    /// The number of pixels in a wave.
    pub lanes: u32,
}

impl Parts {
    /// Returns the work of executing all parts once.
    pub fn total(&self) -> Work {
        self.loops.iter().fold(self.straight, |sum, body| sum.plus(1.0, *body))
    }
}

/// A row of the table.
struct Row {
    file: &'static str,
    macros: Vec<&'static str>,
    stage: &'static str,
    instructions: f64,
    fetches: f64,
    fragment: Fragment,
    loops: &'static str,
}

/// The costs on one GPU.
pub struct Costs {
    rows: Vec<Row>,
    /// The number of pixels in a wave, for shaders without this number in the table.
    lanes: u32,
}

impl Costs {
    /// Reads the costs on a GPU.
    ///
    /// # Errors
    /// If the table has no entry for this GPU.
    pub fn of(gpu: &str) -> anyhow::Result<Costs> {
        let rows: Vec<Row> = TABLE.lines().filter_map(|line| row(gpu, line)).collect();
        ensure!(
            !rows.is_empty(),
            "app/lab/estimate/shader-cost.csv has nothing of {gpu}: run cargo xtask maintain shader-cost --bless"
        );
        Ok(Costs { rows, lanes: if gpu == "g52" { 8 } else { 16 } })
    }

    /// Returns the cost of a program's fragment shader. With some of the maps it lies between that without maps and
    /// that with all of them.
    ///
    /// # Errors
    /// If the table lacks the shader.
    pub fn fragment(&self, program: &ProgramRecipe) -> anyhow::Result<Fragment> {
        let [none, all] = [false, true].map(|maps| self.find(program, "fragment", maps));
        let none = none.or(all);
        ensure!(
            none.is_some(),
            "app/lab/estimate/shader-cost.csv lacks {:?}: run cargo xtask maintain shader-cost --bless",
            program.files
        );
        let [none, all] = [none, all].map(|row| row.map(|row| row.fragment).unwrap_or_default());
        let maps = MAPS.iter().filter(|map| program.defines.iter().any(|(name, _)| name == *map)).count();
        let share = if all.slots > 0.0 { maps as f64 / MAPS.len() as f64 } else { 0.0 };
        Ok(Fragment {
            slots: none.slots + share * (all.slots - none.slots),
            lamp: none.lamp + share * (all.lamp - none.lamp),
            lanes: if none.lanes > 0 { none.lanes } else { self.lanes },
        })
    }

    /// Returns the parts of a fragment shader with exactly these macros.
    ///
    /// # Errors
    /// If the table lacks the shader.
    pub fn parts(&self, file: &str, macros: &[&str]) -> anyhow::Result<Parts> {
        let found =
            self.rows.iter().find(|row| row.stage == "fragment" && row.file == file && row.macros == macros);
        let row = found.with_context(|| {
            format!(
                "app/lab/estimate/shader-cost.csv lacks {file} {macros:?}: run cargo xtask maintain shader-cost --bless"
            )
        })?;
        let lanes = if row.fragment.lanes > 0 { row.fragment.lanes } else { self.lanes };
        let straight = Work { slots: row.fragment.slots, fetches: row.fetches };
        let mut parts = Parts { straight, loops: Vec::new(), lanes };
        let mut outermost = 0;
        for text in row.loops.split_whitespace() {
            let (is_inner, body) = text.strip_prefix('>').map_or((false, text), |body| (true, body));
            let body = work(body).filter(|_| !is_inner || !parts.loops.is_empty());
            let body = body.with_context(|| {
                format!("app/lab/estimate/shader-cost.csv has unreadable loops of {file}: {}", row.loops)
            })?;
            let around = if is_inner { &mut parts.loops[outermost] } else { &mut parts.straight };
            *around = around.minus(body);
            if !is_inner {
                outermost = parts.loops.len();
            }
            parts.loops.push(body);
        }
        Ok(parts)
    }

    /// Returns the number of instructions of a program's vertex shader, including those of its position shader on Mali.
    pub fn vertex(&self, program: &ProgramRecipe) -> f64 {
        ["position", "vertex"]
            .iter()
            .filter_map(|stage| self.find(program, stage, false))
            .map(|row| row.instructions)
            .sum()
    }

    /// Returns the row of the shader that is most similar to a program's. The table has each style and each way of
    /// drawing both eyes, but no combination of them, and no scene without a sun.
    fn find(&self, program: &ProgramRecipe, stage: &str, maps: bool) -> Option<&Row> {
        let file = program.files.last()?;
        let has = |text: &&&str| {
            let (name, value) = text.split_once('=').unwrap_or((text, ""));
            program.defines.iter().any(|(own, other)| own == name && other == value)
        };
        let alike = |row: &&Row| {
            let macros = row.macros.iter().filter(|name| !MAPS.contains(name));
            let (shared, all) = (macros.clone().filter(has).count() as i32, macros.count() as i32);
            (2 * shared - all, shared)
        };
        let fits = |row: &&Row| {
            row.file == file
                && row.stage == stage
                && row.macros.iter().any(|name| MAPS.contains(name)) == maps
        };
        self.rows.iter().filter(fits).max_by_key(alike)
    }
}

/// Reads a line of the table if it belongs to this GPU.
fn row(gpu: &str, line: &'static str) -> Option<Row> {
    let cells: Vec<&str> = line.split(',').collect();
    let [of, program, stage, instructions, slots, _, _, lanes, fetches, .., loops] = cells[..] else {
        return None;
    };
    if of != gpu {
        return None;
    }
    let mut words = program.split(' ');
    let (file, macros) = (words.next()?, words.collect());
    let number = |text: &str| text.parse().unwrap_or(0.0);
    let lamp = if is_lit(file) { loops.split(['/', ' ']).next().map_or(0.0, number) } else { 0.0 };
    let fragment = Fragment { slots: number(slots) - lamp, lamp, lanes: lanes.parse().unwrap_or(0) };
    let (instructions, fetches) = (number(instructions), number(fetches));
    Some(Row { file, macros, stage, instructions, fetches, fragment, loops })
}

/// Parses the work of a loop's body: slots and fetches, such as `64/1`.
fn work(text: &str) -> Option<Work> {
    let (slots, fetches) = text.split_once('/')?;
    Some(Work { slots: slots.parse().ok()?, fetches: fetches.parse().ok()? })
}

/// True if the shader's only loop is the one over lamps.
fn is_lit(file: &str) -> bool {
    ["render/forward.frag", "render/transparent.frag"].contains(&file)
}

#[cfg(test)]
mod tests {
    use super::*;

    const GPUS: [&str; 6] = ["a650", "a740", "a750", "g52", "g57", "g610"];

    fn recipe(file: &str, defines: &[&str]) -> ProgramRecipe {
        let define = |text: &&str| {
            let (name, value) = text.split_once('=').unwrap_or((text, ""));
            (name.to_owned(), value.to_owned())
        };
        ProgramRecipe {
            files: vec!["render/geometry.vert".into(), file.into()],
            defines: defines.iter().map(define).collect(),
        }
    }

    #[test]
    fn a_program_with_some_maps_costs_something_between_none_and_all() {
        for gpu in GPUS {
            let costs = Costs::of(gpu).unwrap();
            let slots =
                |count: usize| costs.fragment(&recipe("render/forward.frag", &MAPS[..count])).unwrap().slots;
            assert!(slots(4) > slots(0) + 10.0, "{gpu}");
            assert!((slots(1) - (slots(0) + 0.25 * (slots(4) - slots(0)))).abs() < 1e-9, "{gpu}");
        }
    }

    #[test]
    fn the_loop_over_lamps_is_counted_for_each_lamp() {
        let costs = Costs::of("a740").unwrap();
        const PROGRAM: &str = "render/forward.frag SUN SHADOWS MAX_POINT_LIGHTS=24 LIGHT_TILES=128 LIGHT_TILE_COLUMNS=16 MULTISAMPLE CARRIED=4";
        let whole = TABLE.lines().find(|line| line.starts_with(&format!("a740,{PROGRAM},fragment,")));
        let total: f64 = whole.unwrap().split(',').nth(4).unwrap().parse().unwrap();
        let words: Vec<&str> = PROGRAM.split(' ').collect();
        let Fragment { slots, lamp, lanes } = costs.fragment(&recipe(words[0], &words[1..])).unwrap();
        assert!(lamp > 50.0 && (slots + lamp - total).abs() < 1e-9 && lanes == 128, "{slots} {lamp} {lanes}");
    }

    #[test]
    fn parts_are_counted_once() {
        for gpu in GPUS {
            let costs = Costs::of(gpu).unwrap();
            let march = costs.parts("synthesis/any_view/march.frag", &[]).unwrap();
            let fragment = costs.find(&recipe("synthesis/any_view/march.frag", &[]), "fragment", false);
            assert_eq!(march.total().slots, fragment.unwrap().fragment.slots, "{gpu}");
            assert_eq!(march.loops.len(), 3, "{gpu}: the second loop is the one inside of the first");
            assert!(march.loops.iter().all(|body| body.slots > 0.0), "{gpu}: {march:?}");
        }
        assert_eq!(work("64/1"), Some(Work { slots: 64.0, fetches: 1.0 }));
        assert_eq!((work("64"), work(">64/1")), (None, None));
    }

    #[test]
    fn each_way_to_draw_both_eyes_has_its_own_vertex_shader() {
        let costs = Costs::of("g57").unwrap();
        let [one, both] =
            [&[][..], &["STEREO", "MULTIVIEW"]].map(|d| costs.vertex(&recipe("render/forward.frag", d)));
        assert!(both > one && one > 20.0, "{one} {both}");
    }
}
