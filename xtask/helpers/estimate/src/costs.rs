//! The cost of one invocation of each shader, from `shader-cost.csv`.

use anyhow::{Context as _, ensure};
use xtask::maintain::estimate::{Row, Table};
use yoro_gl::ProgramRecipe;

/// The table that `cargo xtask maintain estimate --shaders --bless` writes.
const TABLE: &str = include_str!("../shader-cost.csv");
/// What to do if it lacks something.
const RENEW: &str = "run cargo xtask maintain estimate --shaders --bless";
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
    /// If the table is damaged, or has nothing of this GPU.
    pub fn of(gpu: &str) -> anyhow::Result<Costs> {
        let mut rows = Table::parse(TABLE)?.rows;
        rows.retain(|row| row.gpu == gpu);
        ensure!(!rows.is_empty(), "shader-cost.csv has nothing of {gpu}: {RENEW}");
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
        ensure!(none.is_some(), "shader-cost.csv lacks {:?}: {RENEW}", program.files);
        let of = |row: &Row| {
            // The only loop of these shaders is the one over lamps.
            let is_lit = ["render/forward.frag", "render/transparent.frag"].contains(&file(row));
            let lamp = row.loops.split(['/', ' ']).next().and_then(|slots| slots.parse().ok());
            let lamp = if is_lit { lamp.unwrap_or(0.0) } else { 0.0 };
            let slots = f64::from(row.slots.unwrap_or(0)) - lamp;
            Fragment { slots, lamp, lanes: row.lanes_per_wave.unwrap_or(self.lanes) }
        };
        let [none, all] = [none, all].map(|row| row.map(of).unwrap_or_default());
        let maps = MAPS.iter().filter(|map| program.defines.iter().any(|(name, _)| name == *map)).count();
        let share = if all.slots > 0.0 { maps as f64 / MAPS.len() as f64 } else { 0.0 };
        Ok(Fragment {
            slots: none.slots + share * (all.slots - none.slots),
            lamp: none.lamp + share * (all.lamp - none.lamp),
            lanes: none.lanes,
        })
    }

    /// Returns the parts of a fragment shader with exactly these macros.
    ///
    /// # Errors
    /// If the table lacks the shader.
    pub fn parts(&self, file: &str, macros: &[&str]) -> anyhow::Result<Parts> {
        let name = [&[file], macros].concat().join(" ");
        let row = self.rows.iter().find(|row| row.stage == "fragment" && row.program == name);
        let row = row.with_context(|| format!("shader-cost.csv lacks {name}: {RENEW}"))?;
        let work = |slots: u32, fetches: u32| Work { slots: slots.into(), fetches: fetches.into() };
        let straight = work(row.slots.unwrap_or(0), row.fetches.unwrap_or(0));
        let lanes = row.lanes_per_wave.unwrap_or(self.lanes);
        let mut parts = Parts { straight, loops: Vec::new(), lanes };
        let mut outermost = 0;
        for text in row.loops.split_whitespace() {
            let (is_inner, body) = text.strip_prefix('>').map_or((false, text), |body| (true, body));
            let body = body
                .split_once('/')
                .and_then(|(slots, fetches)| Some(work(slots.parse().ok()?, fetches.parse().ok()?)));
            let body = body.filter(|_| !is_inner || !parts.loops.is_empty());
            let body = body.with_context(|| format!("unreadable loops of {name}: {}", row.loops))?;
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
        let stages = ["position", "vertex"].iter().filter_map(|stage| self.find(program, stage, false));
        stages.map(|row| f64::from(row.instructions)).sum()
    }

    /// Returns the row of the shader that is most similar to a program's. The table has each style and each way of
    /// drawing both eyes, but no combination of them, and no scene without a sun.
    fn find(&self, program: &ProgramRecipe, stage: &str, maps: bool) -> Option<&Row> {
        let own_file = program.files.last()?;
        let has = |text: &&str| {
            let (name, value) = text.split_once('=').unwrap_or((text, ""));
            program.defines.iter().any(|(own, other)| own == name && other == value)
        };
        let similarity = |row: &&Row| {
            let all: Vec<&str> = macros(row).filter(|name| !MAPS.contains(name)).collect();
            let shared = all.iter().filter(|name| has(name)).count() as i32;
            (2 * shared - all.len() as i32, shared)
        };
        let fits = |row: &&Row| {
            file(row) == own_file
                && row.stage == stage
                && macros(row).any(|name| MAPS.contains(&name)) == maps
        };
        self.rows.iter().filter(fits).max_by_key(similarity)
    }
}

fn file(row: &Row) -> &str {
    row.program.split(' ').next().unwrap_or_default()
}

fn macros(row: &Row) -> impl Iterator<Item = &str> {
    row.program.split(' ').skip(1)
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
    fn parts_are_counted_once() {
        for gpu in GPUS {
            let costs = Costs::of(gpu).unwrap();
            let march = costs.parts("synthesis/any_view/march.frag", &[]).unwrap();
            let fragment = costs.find(&recipe("synthesis/any_view/march.frag", &[]), "fragment", false);
            assert_eq!(march.total().slots, f64::from(fragment.unwrap().slots.unwrap()), "{gpu}");
            assert_eq!(march.loops.len(), 2, "{gpu}: the second loop is the one inside of the first");
            assert!(march.loops.iter().all(|body| body.slots > 0.0), "{gpu}: {march:?}");
        }
    }

    #[test]
    fn each_way_to_draw_both_eyes_has_its_own_vertex_shader() {
        let costs = Costs::of("g57").unwrap();
        let [one, both] =
            [&[][..], &["STEREO", "MULTIVIEW"]].map(|d| costs.vertex(&recipe("render/forward.frag", d)));
        assert!(both > one && one > 20.0, "{one} {both}");
    }
}
