//! Everything a person or CI types: set-up, run, tests, lint.

fn main() {}
