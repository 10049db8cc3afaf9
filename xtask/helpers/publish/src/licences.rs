//! The licences that what we distribute may have.

use anyhow::Context as _;
use spdx::{Expression, LicenseReq, Licensee, ParseMode};

use crate::packages::Package;

/// What may be in our files, in the order of preference: the first needs a single text for all who chose it.
const ACCEPTED: [&str; 13] = [
    "Apache-2.0",
    "Apache-2.0 WITH LLVM-exception",
    "MIT",
    "MIT-0",
    "Zlib",
    "ISC",
    "BSD-2-Clause",
    "BSD-3-Clause",
    "Unicode-3.0",
    "BSL-1.0",
    "0BSD",
    "CC0-1.0",
    "Unlicense",
];
/// Returns the licences under which a package is used: the preferred ones that its expression demands together.
pub fn chosen(package: &Package) -> anyhow::Result<Vec<LicenseReq>> {
    let Package { name, version, licence, .. } = package;
    let accepted = ACCEPTED.iter().map(|name| Licensee::parse(name)).collect::<Result<Vec<_>, _>>();
    let accepted = accepted.context("a name in the list of licences is not SPDX's")?;
    let expression = Expression::parse_mode(licence, ParseMode::LAX);
    let expression =
        expression.with_context(|| format!("{name} {version}: {licence:?} is no licence's name"))?;
    expression.minimized_requirements(&accepted).with_context(|| {
        format!(
            "{name} {version} is {licence}, which is not in the list of xtask/helpers/publish/src/licences.rs"
        )
    })
}

#[cfg(test)]
pub mod tests {
    use super::*;

    pub fn package(licence: &str) -> Package {
        let [name, version] = ["some", "1.0.0"].map(str::to_owned);
        Package { name, version, licence: licence.to_owned(), authors: Vec::new(), folder: "/none".into() }
    }

    #[test]
    fn the_preferred_licence_is_chosen_and_others_are_refused() {
        let of = |licence| {
            let chosen = chosen(&package(licence)).map_err(|error| error.to_string())?;
            Ok::<_, String>(chosen.iter().map(ToString::to_string).collect::<Vec<_>>().join(" "))
        };
        assert_eq!(of("MIT/Apache-2.0").unwrap(), "Apache-2.0");
        assert_eq!(of("MIT OR Apache-2.0 OR LGPL-2.1-or-later").unwrap(), "Apache-2.0");
        let mut both: Vec<_> =
            of("(MIT OR Apache-2.0) AND ISC").unwrap().split(' ').map(str::to_owned).collect();
        both.sort();
        assert_eq!(both, ["Apache-2.0", "ISC"]);
        for refused in ["GPL-3.0-only", "MIT AND GPL-2.0-only", "MPL-2.0", ""] {
            assert!(of(refused).unwrap_err().starts_with("some 1.0.0"), "{refused}");
        }
    }
}
