//! The costs of the parts of the pipeline `gather` by name, which `yoro bench shader-cost` reads.
//!
//! Compilers list loops in an order of their own. Here, each loop gets a name for what it does in the shader.

use anyhow::{Context as _, bail};

use super::table::Table;

/// The file with the costs, relative to the workspace.
pub const FILE: &str = "app/lab/src/bench/gather-cost.csv";
/// The GPUs of the devices that the benchmark supports.
const GPUS: [&str; 5] = ["a650", "a740", "g52", "g57", "g610"];
/// Lanes per wave: Mali's waves have 16 lanes, those of the G52 have 8. The table does not contain this.
const MALI_LANES: u32 = 16;
const G52_LANES: u32 = 8;
/// Numbers of issue slots and texture instructions.
type Work = [i64; 2];

/// The cost of executing a program's parts once: the code outside of its loops, and each loop's body without the loops
/// inside it, in the order of the listing.
struct Program<const LOOPS: usize> {
    outside: Work,
    loops: [Work; LOOPS],
}

impl<const LOOPS: usize> Program<LOOPS> {
    fn total(&self) -> Work {
        self.loops.iter().fold(self.outside, |sum, body| plus(sum, *body))
    }
}

/// Returns the file's text: the cost of executing each part once, without the loops inside it.
///
/// # Errors
/// Fails if the table lacks a program, or a program has an unexpected number of loops.
pub fn text(table: &Table) -> anyhow::Result<String> {
    let mut text = "# Written by cargo tools shader-cost --bless\ngpu,lanes,part,slots,fetches\n".to_owned();
    for gpu in GPUS {
        for (lanes, part, [slots, fetches]) in parts(table, gpu)? {
            text += &format!("{gpu},{lanes},{part},{slots},{fetches}\n");
        }
    }
    Ok(text)
}

/// Returns lanes per wave, name and cost of each part on a GPU.
fn parts(table: &Table, gpu: &str) -> anyhow::Result<Vec<(u32, &'static str, Work)>> {
    let of = |file: &str| format!("synthesis/gather/{file}.frag TEXTURE_GATHER SHORT_WAY");
    let (tile_lanes, tiles) = program::<1>(table, gpu, &of("tiles"))?;
    let (span_lanes, spans) = program::<3>(table, gpu, &of("spans"))?;
    let (lanes, _) = program::<3>(table, gpu, &of("march"))?;
    // Each program adds one part to the previous one: see tests/src/programs.rs.
    let march = |parts: u32| format!("{} PARTS={parts}", of("march"));
    let (_, law) = program::<0>(table, gpu, &march(1))?;
    let (_, short) = program::<1>(table, gpu, &march(2))?;
    let (_, segments) = program::<2>(table, gpu, &march(6))?;
    let (_, events) = program::<2>(table, gpu, &march(14))?;
    let (_, fill) = program::<2>(table, gpu, &march(30))?;
    let (_, all) = program::<3>(table, gpu, &march(62))?;
    // The loop over segments is the second one, the loop to a crossing is the last. Events are handled in two places,
    // one of them before the loop.
    let event = minus(events.loops[1], segments.loops[1]);
    let crossing = minus(all.outside, fill.outside);
    let long = minus(minus(plus(events.outside, crossing), event), short.outside);
    Ok(vec![
        (tile_lanes, "tiles", tiles.outside),
        (tile_lanes, "tiles: two rows", tiles.loops[0]),
        (span_lanes, "spans", spans.outside),
        (span_lanes, "spans: tile", spans.loops[0]),
        (span_lanes, "spans: plane", spans.loops[1]),
        (span_lanes, "spans: joint", spans.loops[2]),
        (lanes, "march: law", law.outside),
        (lanes, "march: short way", short.outside),
        (lanes, "march: short step", short.loops[0]),
        (lanes, "march: long way", long),
        (lanes, "march: segment", segments.loops[1]),
        (lanes, "march: event", event),
        (lanes, "march: fill", minus(fill.total(), events.total())),
        (lanes, "march: crossing", all.loops[2]),
    ])
}

/// Returns the lanes per wave and the cost of a program with `LOOPS` loops.
fn program<const LOOPS: usize>(
    table: &Table,
    gpu: &str,
    name: &str,
) -> anyhow::Result<(u32, Program<LOOPS>)> {
    let row = table.rows.iter().find(|row| row.gpu == gpu && row.program == name);
    let row = row.with_context(|| format!("there is no row {gpu},{name}"))?;
    let bodies = bodies(&row.loops).with_context(|| format!("unreadable loops \"{}\"", row.loops))?;
    let count = bodies.len();
    let Ok(loops) = bodies.try_into() else {
        bail!(
            "{name} has {count} loops on {gpu}, and {LOOPS} are named: name them anew in tools/src/shader_cost/gather.rs"
        );
    };
    let all = [row.slots, row.fetches].map(|count| i64::from(count.unwrap_or(0)));
    let loops: [Work; LOOPS] = loops;
    let outside = loops.iter().fold(all, |rest, body| minus(rest, *body));
    Ok((
        row.lanes_per_wave.unwrap_or(if gpu == "g52" { G52_LANES } else { MALI_LANES }),
        Program { outside, loops },
    ))
}

fn plus(a: Work, b: Work) -> Work {
    [a[0] + b[0], a[1] + b[1]]
}

fn minus(a: Work, b: Work) -> Work {
    [a[0] - b[0], a[1] - b[1]]
}

/// Parses the cost of executing each loop's body once, without the loops inside it.
fn bodies(loops: &str) -> Option<Vec<Work>> {
    let mut bodies: Vec<Work> = Vec::new();
    let mut outermost = 0;
    for text in loops.split_whitespace() {
        let body = text.trim_start_matches('>');
        let (slots, fetches) = body.split_once('/')?;
        let work = [slots.parse().ok()?, fetches.parse().ok()?];
        match text.len() - body.len() {
            0 => outermost = bodies.len(),
            1 => {
                let around = bodies.get_mut(outermost)?;
                *around = minus(*around, work);
            }
            _ => return None,
        }
        bodies.push(work);
    }
    Some(bodies)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::folders::root;

    #[test]
    fn inner_loops_are_not_counted_twice() {
        assert_eq!(bodies("64/1 178/3 >71/1 >65/1 81/4").unwrap()[..3], [[64, 1], [42, 1], [71, 1]]);
        assert_eq!(bodies("1/1 >>2/2"), None);
        assert_eq!(bodies(">1/1"), None);
    }

    #[test]
    fn the_committed_costs_agree_with_the_committed_table() {
        let read = |path: &str| std::fs::read_to_string(root().join(path)).unwrap();
        let table = Table::parse(&read("docs/shader-cost.csv")).unwrap();
        assert_eq!(text(&table).unwrap(), read(FILE), "cargo tools shader-cost --bless renews it");
    }
}
