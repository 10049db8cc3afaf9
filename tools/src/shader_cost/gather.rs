//! The costs of the pipeline gather's parts by name, as `yoro bench shader-cost` reads them.
//!
//! The compilers list loops in their own order. Here each loop gets the name of what it does in the shader.

use anyhow::{Context as _, ensure};

use super::table::Table;

/// The file of the costs, in the workspace.
pub const FILE: &str = "app/lab/src/bench/gather-cost.csv";
/// The GPUs of the devices that the suite knows.
const GPUS: [&str; 3] = ["a650", "a740", "g57"];
/// Mali's waves have 16 lanes; its rows do not say so.
const MALI_LANES: u32 = 16;
/// The programs: a name for what stands outside of their loops, the program, and names for its loops in the order of the
/// listing.
const PROGRAMS: [(&str, &str, &[&str]); 4] = [
    ("tiles", "synthesis/gather/tiles.frag TEXTURE_GATHER", &["tiles: two rows"]),
    ("spans", "synthesis/gather/spans.frag", &["spans: tile"]),
    (
        "march",
        "synthesis/gather/march.frag TEXTURE_GATHER SHORT_WAY",
        // The columns' loop is there twice, of the first tiles and in each later round.
        &[
            "march: short step",
            "march: column",
            "march: round",
            "march: tile",
            "march: later column",
            "march: fill",
        ],
    ),
    (
        "march: short way",
        "synthesis/gather/march.frag TEXTURE_GATHER SHORT_WAY SHORT_WAY_ALONE",
        &["march: short way's step"],
    ),
];

/// Issue slots and texture instructions.
type Work = [i64; 2];

/// Returns the file's text: of each part what it executes once, without the loops inside.
///
/// # Errors
/// When the table lacks a program, or a program has other loops than those named here.
pub fn text(table: &Table) -> anyhow::Result<String> {
    let mut text = "# Written by cargo tools shader-cost --bless\ngpu,lanes,part,slots,fetches\n".to_owned();
    for gpu in GPUS {
        for (name, program, loops) in PROGRAMS {
            let row = table.rows.iter().find(|row| row.gpu == gpu && row.program == program);
            let row = row.with_context(|| format!("there is no row {gpu},{program}"))?;
            let lanes = row.lanes_per_wave.unwrap_or(MALI_LANES);
            let bodies = bodies(&row.loops).with_context(|| format!("unreadable loops \"{}\"", row.loops))?;
            ensure!(
                bodies.len() == loops.len(),
                "{program} has {} loops on {gpu}, and {} are named: name them anew in tools/src/shader_cost/gather.rs",
                bodies.len(),
                loops.len()
            );
            let mut outside = [row.slots, row.fetches].map(|count| i64::from(count.unwrap_or(0)));
            bodies.iter().for_each(|body| subtract(&mut outside, *body));
            for (part, [slots, fetches]) in std::iter::once((&name, outside)).chain(loops.iter().zip(bodies))
            {
                text += &format!("{gpu},{lanes},{part},{slots},{fetches}\n");
            }
        }
    }
    Ok(text)
}

fn subtract(from: &mut Work, what: Work) {
    from.iter_mut().zip(what).for_each(|(from, what)| *from -= what);
}

/// Returns what each loop of a row executes once, without the loops inside.
fn bodies(loops: &str) -> Option<Vec<Work>> {
    let mut bodies: Vec<Work> = Vec::new();
    let mut outermost = 0;
    for text in loops.split_whitespace() {
        let body = text.trim_start_matches('>');
        let (slots, fetches) = body.split_once('/')?;
        let work = [slots.parse().ok()?, fetches.parse().ok()?];
        match text.len() - body.len() {
            0 => outermost = bodies.len(),
            1 => subtract(bodies.get_mut(outermost)?, work),
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
