//! Programs and packages that some tests need. They are fetched while cargo compiles the tests, and built afterwards.

use std::path::PathBuf;
use std::process::Command;
use std::thread::{Scope, ScopedJoinHandle};

use anyhow::{Context as _, anyhow, bail};

use crate::maintain::estimate::Compilers;

use super::binaries::Program;
use super::summary::Summary;
use crate::maintain::{hello_xr, monado};
use crate::{android, apt, arm64, package, setup, web};

/// A program or package that some tests need.
struct Item {
    /// The name in messages.
    what: &'static str,
    /// `YORO_TEST_variable` tells the tests its path. If `YORO_TEST_WITHOUT_variable` is set, the tests skip it.
    variable: &'static str,
    /// The tests that need it: the package, and a part of the tests' names.
    users: &'static [(&'static str, &'static str)],
    /// Installs and fetches it, or what it is built from. If this fails, its tests are skipped.
    fetch: fn() -> anyhow::Result<PathBuf>,
    /// Builds it. If this fails, no tests run.
    build: Option<fn() -> anyhow::Result<PathBuf>>,
}

static ITEMS: [Item; 13] = [
    Item {
        what: "the page",
        variable: "WEB",
        users: &[("yoro-cli", "web::")],
        fetch: page_can_be_built,
        build: Some(|| web::build().and_then(|_| Ok(std::env::current_exe()?))),
    },
    Item {
        what: "the example of yoro-wgpu for browsers",
        variable: "WGPU_WEB",
        users: &[("yoro-wgpu", "the_example_in_a_browser")],
        fetch: page_can_be_built,
        build: Some(|| web::build_example().and_then(|_| Ok(std::env::current_exe()?))),
    },
    Item {
        what: "the WebXR emulator",
        variable: "WEBXR",
        users: &[("yoro-cli", "web::"), ("yoro-three-tests", "headsets")],
        fetch: web::emulator,
        build: None,
    },
    Item {
        what: "three.js",
        variable: "THREE",
        users: &[("yoro-three-tests", "")],
        fetch: web::three_modules,
        build: None,
    },
    Item {
        what: "Chromium",
        variable: "CHROMIUM",
        // The test names of this program do not show which of them open a page.
        users: &[("yoro-cli", ""), ("yoro-three-tests", "")],
        fetch: || setup::browser().context("it cannot be installed"),
        build: None,
    },
    Item {
        what: "Monado",
        variable: "MONADO",
        users: &[("yoro-cli", "monado")],
        fetch: monado::make,
        build: None,
    },
    Item {
        what: "Mesa 25",
        variable: "MULTIVIEW",
        users: &[("yoro-tests", "multiview::")],
        // Monado's drivers, and its launcher for this machine's programs.
        fetch: || Ok(monado::make()?.join("run")),
        build: None,
    },
    Item {
        what: "hello_xr",
        variable: "HELLO_XR",
        users: &[("yoro-openxr-layer", "hello_xr"), ("yoro-cli", "through_the_layer")],
        fetch: hello_xr::make,
        build: None,
    },
    Item {
        what: "shader compilers for mobile GPUs",
        variable: "SHADER_COMPILERS",
        users: &[("yoro-tests", "shader_cost::")],
        fetch: || Ok(Compilers::make()?.folder().to_owned()),
        build: None,
    },
    Item {
        what: "the C library's package",
        variable: "C_PACKAGE",
        users: &[("yoro-c", "the_package")],
        fetch: package::fetch_users_tools,
        build: Some(|| package::package(&[package::Target::Linux])?.pop().context("no package was made")),
    },
    Item {
        what: "the APK (cargo xtask doctor)",
        variable: "APK",
        users: &[("yoro-android-host", "")],
        fetch: || android::ready_for_tests().map(|()| PathBuf::new()),
        build: Some(|| {
            android::apk(&android::Options {
                release: true,
                yes: true,
                openxr_loaders: Vec::new(),
                bundle: false,
                quest: true,
            })
        }),
    },
    Item {
        what: "the Android layer",
        variable: "ANDROID_LAYER",
        users: &[("yoro-android-host", "layer")],
        fetch: || android::ready_for_tests().map(|()| PathBuf::new()),
        build: Some(package::layer_for_tests),
    },
    Item {
        what: "the simulated Android host for arm64",
        variable: "ARM64_HOST",
        users: &[("yoro-android-host", "arm64")],
        fetch: arm64::fetch,
        build: Some(arm64::build_host),
    },
];

fn page_can_be_built() -> anyhow::Result<PathBuf> {
    if web::can_be_built() { Ok(PathBuf::new()) } else { bail!("no Rust can compile for browsers") }
}

impl Item {
    fn is_for(&self, package: &str, test: &str) -> bool {
        self.users.iter().any(|(user, part)| *user == package && test.contains(part))
    }
}

/// True if a test needs any of the items.
pub fn is_needed(package: &str, test: &str) -> bool {
    ITEMS.iter().any(|item| item.is_for(package, test))
}

/// Returns patterns in the table that match no test, for example because it was renamed.
pub fn stale(programs: &[Program]) -> Vec<String> {
    let users = ITEMS.iter().flat_map(|item| item.users);
    let fits = |(package, part): &(&str, &str)| {
        programs
            .iter()
            .any(|(binary, names)| binary.package == *package && names.iter().any(|name| name.contains(part)))
    };
    users.filter(|user| !fits(user)).map(|(package, part)| format!("{package} {part}")).collect()
}

/// Installations and downloads that are running in threads.
pub struct Preparation<'scope> {
    system: Option<ScopedJoinHandle<'scope, anyhow::Result<Libraries>>>,
    items: Vec<(&'static Item, ScopedJoinHandle<'scope, anyhow::Result<PathBuf>>)>,
}

/// The optional system libraries, true if available.
#[derive(Clone, Copy, Debug, Default)]
struct Libraries {
    osmesa: bool,
    vulkan: bool,
}

/// The equipment available on this machine.
#[derive(Debug, Default)]
pub struct Equipment {
    libraries: Libraries,
    /// Paths by variable; `None` if the item is not available.
    items: Vec<(&'static str, Option<PathBuf>)>,
    /// A sentence for each item that is not available.
    pub absent: Vec<String>,
}

impl<'scope> Preparation<'scope> {
    /// Starts the preparation for the selected tests, or for all tests.
    ///
    /// # Errors
    /// Fails if a library is missing that this program cannot install.
    pub fn begin(scope: &'scope Scope<'scope, '_>, programs: Option<&[Program]>) -> anyhow::Result<Self> {
        // sudo may ask for a password, and other systems get instructions: not in the background of cargo.
        if !apt::installs_by_itself() {
            setup::ensure()?;
        }
        let libraries = || Ok(Libraries { osmesa: setup::ensure()?.osmesa, vulkan: setup::vulkan() });
        let wanted = |item: &&Item| match programs {
            None => true,
            // A few selected tests are not worth the wait for a browser, so they only use an installed one.
            Some(programs) => {
                let is_user =
                    |(binary, names): &Program| names.iter().any(|name| item.is_for(&binary.package, name));
                item.variable != "CHROMIUM" && programs.iter().any(is_user)
            }
        };
        let items = ITEMS.iter().filter(wanted).map(|item| (item, scope.spawn(item.fetch))).collect();
        Ok(Self { system: Some(scope.spawn(libraries)), items })
    }

    /// Waits for the system libraries, which all tests need.
    ///
    /// # Errors
    /// Fails if one is missing.
    pub fn libraries(&mut self) -> anyhow::Result<Equipment> {
        let mut equipment = Equipment::default();
        if let Some(system) = self.system.take() {
            equipment.libraries = join(system)?;
        }
        for (here, what) in [
            (equipment.libraries.osmesa, "OSMesa"),
            (equipment.libraries.vulkan, "Vulkan or its validation layer"),
        ] {
            if !here {
                equipment.absent.push(format!("{what} is not here: what needs it was left out"));
            }
        }
        Ok(equipment)
    }

    /// Waits for the other items, and builds those that have to be built.
    ///
    /// # Errors
    /// Fails if something cannot be built.
    pub fn finish(self, equipment: &mut Equipment, summary: &mut Summary) -> anyhow::Result<()> {
        for (item, fetching) in self.items {
            let fetched = summary.measure(&format!("waiting for {}", item.what), || join(fetching));
            let path = match (fetched, item.build) {
                (Ok(_), Some(build)) => Some(summary.measure(&format!("building {}", item.what), build)?),
                (Ok(path), None) => Some(path),
                (Err(error), _) => {
                    let sentence = format!("{} cannot be had here: its tests were left out", item.what);
                    eprintln!("warning: {sentence}: {error:#}");
                    equipment.absent.push(sentence);
                    None
                }
            };
            equipment.items.push((item.variable, path));
        }
        Ok(())
    }
}

fn join<T>(handle: ScopedJoinHandle<'_, anyhow::Result<T>>) -> anyhow::Result<T> {
    handle.join().map_err(|_| anyhow!("the set-up has failed in an unexpected way: see above"))?
}

impl Equipment {
    /// Sets the variables that tell a test program what is available.
    pub fn set_variables(&self, command: &mut Command) {
        if !self.libraries.osmesa {
            command.env("YORO_TEST_WITHOUT_OSMESA", "1");
        }
        if !self.libraries.vulkan {
            command.env("YORO_TEST_WITHOUT_VULKAN", "1");
        }
        for (variable, path) in &self.items {
            match path {
                Some(path) => command.env(format!("YORO_TEST_{variable}"), path),
                None => command.env(format!("YORO_TEST_WITHOUT_{variable}"), "1"),
            };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tests_are_known_by_package_and_name() {
        let needed = |package: &str, name: &str| {
            let items = ITEMS.iter().filter(|item| item.is_for(package, name));
            items.map(|item| item.variable).collect::<Vec<_>>().join(" ")
        };
        assert_eq!(needed("yoro-bench", "monado::arm64"), "");
        assert_eq!(needed("yoro-android-host", "the_arm64_library"), "APK ARM64_HOST");
        assert_eq!(needed("yoro-openxr-layer", "monado_and_hello_xr"), "HELLO_XR");
        assert_eq!(needed("yoro-cli", "web::a_headset"), "WEB WEBXR CHROMIUM");
    }

    #[test]
    fn variables_say_what_is_here_and_what_is_not() {
        let equipment = Equipment {
            libraries: Libraries { osmesa: true, vulkan: false },
            items: vec![("APK", Some("yoro.apk".into())), ("MONADO", None)],
            ..Equipment::default()
        };
        let mut command = Command::new("test");
        equipment.set_variables(&mut command);
        let set: Vec<_> = command.get_envs().filter_map(|(name, _)| name.to_str()).collect();
        assert_eq!(set, ["YORO_TEST_APK", "YORO_TEST_WITHOUT_MONADO", "YORO_TEST_WITHOUT_VULKAN"]);
    }
}
