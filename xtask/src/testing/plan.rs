//! Which tests run together in one process, and in which order: long ones first, so that no core is left with one at the end.

use std::collections::HashMap;
use std::fmt::Write as _;

use super::binaries::{Binary, Program};

/// Tests that must not run beside others, by a part of `program name`, and why.
///
/// Almost none have to: each has folders of its own, ports are pipes, and time is measured in processor time or is simulated.
const ALONE: [(&str, &str); 2] = [
    ("yoro-app::program memory::", "with a second large scene a small machine would have no room for both"),
    (
        "yoro-android-host::apk the_arm64_library",
        "in qemu beside others, the first frames take longer than a minute",
    ),
];

/// Longer than this a test has a process for itself, in seconds.
const LONG: f64 = 1.0;
/// Shorter tests share a process, until they take this long together: a process costs some hundredths of a second, most of
/// them for loading the drivers.
const SHARED: f64 = 3.0;
/// For a test that has never run here.
const INTEGRATION: f64 = 5.0;
const UNIT: f64 = 0.1;
/// Documentation tests are compiled when they are run.
const DOCUMENTATION: f64 = 60.0;

/// Seconds that tests took when they ran last, by program and name.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Times(HashMap<(String, String), f64>);

impl Times {
    /// Of `seconds program name` lines; what is none is left out.
    pub fn parse(text: &str) -> Self {
        let entry = |line: &str| {
            let mut words = line.splitn(3, ' ');
            let seconds = words.next()?.parse().ok()?;
            Some(((words.next()?.to_owned(), words.next()?.to_owned()), seconds))
        };
        Self(text.lines().filter_map(entry).collect())
    }

    /// As [`Times::parse`] reads it.
    pub fn to_text(&self) -> String {
        let mut entries: Vec<_> = self.0.iter().collect();
        entries.sort_by(|a, b| a.0.cmp(b.0));
        let mut text = String::new();
        for ((program, name), seconds) in entries {
            // Writing to a string cannot fail.
            let _ = writeln!(text, "{seconds:.2} {program} {name}");
        }
        text
    }

    /// Remembers a test.
    pub fn set(&mut self, program: &str, name: &str, seconds: f64) {
        self.0.insert((program.to_owned(), name.to_owned()), seconds);
    }

    fn of(&self, binary: &Binary, name: &str) -> f64 {
        let known = self.0.get(&(binary.label.clone(), name.to_owned()));
        known.copied().unwrap_or(if binary.integration { INTEGRATION } else { UNIT })
    }
}

/// What one process does.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Job {
    /// Some tests of a program, in its order.
    Tests {
        /// Its place among all.
        binary: usize,
        /// The tests' names.
        names: Vec<String>,
    },
    /// The tests in the documentation of all libraries.
    Documentation,
}

/// All of it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Plan {
    /// In any number of processes at the same time, the first ones first.
    pub together: Vec<Job>,
    /// One after the other, with nothing beside them.
    pub alone: Vec<Job>,
}

/// Puts programs with the names of their tests into an order.
pub fn plan(programs: &[Program], documentation: bool, times: &Times) -> Plan {
    let mut plan = Plan::default();
    let mut together: Vec<(f64, Job)> = Vec::new();
    if documentation {
        together.push((DOCUMENTATION, Job::Documentation));
    }
    for (binary, (program, names)) in programs.iter().enumerate() {
        let mut shared = (0.0, Vec::new());
        for name in names {
            let seconds = times.of(program, name);
            if is_alone(program, name) {
                plan.alone.push(Job::Tests { binary, names: vec![name.clone()] });
            } else if seconds >= LONG {
                together.push((seconds, Job::Tests { binary, names: vec![name.clone()] }));
            } else {
                shared.0 += seconds;
                shared.1.push(name.clone());
                if shared.0 >= SHARED {
                    let (seconds, names) = std::mem::take(&mut shared);
                    together.push((seconds, Job::Tests { binary, names }));
                }
            }
        }
        if !shared.1.is_empty() {
            together.push((shared.0, Job::Tests { binary, names: shared.1 }));
        }
    }
    together.sort_by(|a, b| b.0.total_cmp(&a.0));
    plan.together = together.into_iter().map(|(_, job)| job).collect();
    plan
}

fn is_alone(program: &Binary, name: &str) -> bool {
    let full = format!("{} {name}", program.label);
    ALONE.iter().any(|(part, _)| full.contains(part))
}

/// Patterns of the table that fit no test: the tests have other names by now.
pub fn stale(programs: &[Program]) -> Vec<&'static str> {
    let fits = |part: &str| {
        programs.iter().any(|(program, names)| {
            names.iter().any(|name| format!("{} {name}", program.label).contains(part))
        })
    };
    ALONE.iter().map(|(part, _)| *part).filter(|part| !fits(part)).collect()
}

#[cfg(test)]
mod tests {
    use super::super::binaries::tests::binary;
    use super::*;

    fn names(names: &[&str]) -> Vec<String> {
        names.iter().map(|&name| name.to_owned()).collect()
    }

    fn job(binary: usize, list: &[&str]) -> Job {
        Job::Tests { binary, names: names(list) }
    }

    #[test]
    fn long_tests_go_first_and_short_ones_share() {
        let programs = [
            (binary("yoro", "lib"), names(&["a", "b", "c"])),
            (binary("yoro-app", "test"), names(&["long", "new", "short"])),
        ];
        let times = Times::parse("2.5 yoro b\n60.25 yoro-app::program long\n0.2 yoro-app::program short\n");
        let plan = plan(&programs, true, &times);
        let expected = [
            job(1, &["long"]),
            Job::Documentation,
            job(1, &["new"]),
            job(0, &["b"]),
            job(0, &["a", "c"]),
            job(1, &["short"]),
        ];
        assert_eq!(plan.together, expected);
        assert!(plan.alone.is_empty());
    }

    #[test]
    fn a_process_is_not_shared_by_too_many() {
        let many: Vec<String> = (0..70).map(|i| format!("test{i:02}")).collect();
        let plan = plan(&[(binary("yoro", "lib"), many.clone())], false, &Times::default());
        let mut all = Vec::new();
        for job in plan.together {
            let Job::Tests { names, .. } = job else { panic!("{job:?}") };
            assert!((1..=31).contains(&names.len()), "{}", names.len());
            all.extend(names);
        }
        all.sort();
        assert_eq!(all, many);
    }

    #[test]
    fn what_must_be_alone_is_alone() {
        let programs = [(binary("yoro-app", "test"), names(&["memory::largest", "xr::memory"]))];
        let plan = plan(&programs, false, &Times::default());
        assert_eq!(plan.alone, [job(0, &["memory::largest"])]);
        assert_eq!(plan.together, [job(0, &["xr::memory"])]);
        assert_eq!(stale(&programs), [ALONE[1].0]);
        assert_eq!(stale(&[]).len(), ALONE.len());
    }

    #[test]
    fn times_are_kept() {
        let mut times = Times::parse("1.50 yoro a::b\nnonsense\n2 yoro\n");
        times.set("xtask", "src/lib.rs - x (line 3)", 0.251);
        assert_eq!(times.to_text(), "0.25 xtask src/lib.rs - x (line 3)\n1.50 yoro a::b\n");
        assert_eq!(Times::parse(&times.to_text()).0.len(), 2);
    }
}
