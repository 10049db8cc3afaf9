//! The results of checks, as a table.

use std::fmt;

/// One line of the table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Row {
    /// What was checked.
    pub what: String,
    /// The value that was found.
    pub found: String,
    /// The problem with it, if there is one.
    pub problem: Option<String>,
}

/// The result of a check.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Report {
    /// Rows in the order of the checks.
    pub rows: Vec<Row>,
}

impl Report {
    /// True if no row has a problem.
    pub fn passed(&self) -> bool {
        self.rows.iter().all(|row| row.problem.is_none())
    }

    /// Adds a row.
    pub fn row(&mut self, what: impl Into<String>, found: impl Into<String>, problem: Option<String>) {
        self.rows.push(Row { what: what.into(), found: found.into(), problem });
    }

    /// Adds a row, with a problem unless `found` equals `wanted`.
    pub fn equal(&mut self, what: impl Into<String>, found: &str, wanted: &str) {
        let problem = (found != wanted).then(|| format!("should be {wanted}"));
        self.row(what, if found.is_empty() { "none" } else { found }, problem);
    }

    /// Returns what was checked in the rows with a problem.
    #[cfg(test)]
    pub fn problems(&self) -> Vec<&str> {
        let wrong = self.rows.iter().filter(|row| row.problem.is_some());
        wrong.map(|row| row.what.as_str()).collect()
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let width = self.rows.iter().map(|row| row.what.len()).max().unwrap_or(0);
        for Row { what, found, problem } in &self.rows {
            match problem {
                None => writeln!(f, "  ok    {what:width$}  {found}")?,
                Some(problem) => writeln!(f, "  FAIL  {what:width$}  {found}: {problem}")?,
            }
        }
        Ok(())
    }
}

/// Joins names to a list, which is shortened if there are too many.
pub fn some(names: &[&str]) -> String {
    const SHOWN: usize = 5;
    match names.len().checked_sub(SHOWN) {
        Some(more @ 1..) => format!("{} and {more} more", names[..SHOWN].join(", ")),
        _ => names.join(", "),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_lists_are_cut() {
        assert_eq!(some(&["a", "b"]), "a, b");
        assert_eq!(some(&["a", "b", "c", "d", "e"]), "a, b, c, d, e");
        assert_eq!(some(&["a", "b", "c", "d", "e", "f", "g"]), "a, b, c, d, e and 2 more");
    }

    #[test]
    fn one_problem_is_enough() {
        let mut report = Report::default();
        report.equal("first", "as it should be", "as it should be");
        assert!(report.passed());
        report.equal("second", "", "something");
        assert!(!report.passed());
        assert_eq!(
            report.to_string(),
            "  ok    first   as it should be\n  FAIL  second  none: should be something\n"
        );
    }
}
