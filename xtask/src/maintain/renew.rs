//! Everything that is generated and committed, so that building requires no more than Rust.

use anyhow::ensure;

use super::estimate;
use crate::{cargo, setup};

/// Something that a test knows the sources of. The test detects that it is outdated, and renews it if a variable is set.
struct Generated {
    what: &'static str,
    test: &'static [&'static str],
    variable: &'static str,
}

const GENERATED: [Generated; 5] = [
    Generated {
        what: "what is made of the synthesis shaders",
        test: &[
            "--package",
            "yoro",
            "--package",
            "yoro-wgpu",
            "--package",
            "yoro-three-tests",
            "--lib",
            "shaders",
        ],
        variable: "YORO_BLESS_SHADERS",
    },
    Generated {
        what: "the header of the C library",
        test: &["--package", "yoro-c", "--test", "header"],
        variable: "YORO_BLESS",
    },
    Generated {
        what: "the table in docs/settings.md",
        test: &["--package", "yoro-settings", "the_document_has_the_table"],
        variable: "YORO_BLESS",
    },
    Generated {
        what: "the tables of what works where",
        test: &["--package", "yoro-tests", "--test", "features"],
        variable: "YORO_BLESS",
    },
    RESULTS,
];

const RESULTS: Generated = Generated {
    what: "the tables of what was measured",
    test: &["--package", "yoro-tests", "--test", "results"],
    variable: "YORO_BLESS",
};

impl Generated {
    fn renew(&self) -> anyhow::Result<()> {
        let Generated { what, test, variable } = self;
        ensure!(
            cargo::succeeds(&[&["test", "--quiet"], *test].concat(), &[(variable, "1")]),
            "{what} cannot be renewed: see above"
        );
        Ok(())
    }
}

/// Writes the documents' tables of what was measured.
pub fn renew_results() -> anyhow::Result<()> {
    RESULTS.renew()
}

/// Renews all of it. Returns a text on what to check next, and false if a shader has a fault.
pub fn renew() -> anyhow::Result<(String, bool)> {
    setup::vulkan();
    GENERATED.iter().try_for_each(Generated::renew)?;
    let (costs, passed) = match estimate::Compilers::make() {
        Ok(compilers) => {
            let options = estimate::Options { filter: None, gpus: Vec::new(), bless: true };
            estimate::report(&options, &compilers, estimate::programs()?)?
        }
        Err(error) => (format!("the costs of shaders were not renewed: {error:#}\n"), true),
    };
    Ok((format!("{costs}renewed: look at `git diff --stat`\n"), passed))
}
