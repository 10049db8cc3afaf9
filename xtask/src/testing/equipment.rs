//! Programs and packages that some tests need. They are fetched while cargo compiles the tests, and built afterwards.

use std::path::PathBuf;
use std::process::Command;
use std::thread::{Scope, ScopedJoinHandle};
use std::time::Instant;

use anyhow::{Context as _, anyhow, bail};

use crate::maintain::estimate::Compilers;

use super::binaries::Program;
use crate::maintain::{direct3d, hello_xr, monado};
use crate::{android, apt, arm64, package, setup, web};

/// A program or package that some tests need.
struct Item {
    /// The name in messages.
    what: &'static str,
    /// `YORO_TEST_variable` tells the tests its path. If `YORO_TEST_WITHOUT_variable` is set, the tests skip it.
    variable: &'static str,
    /// The tests that need it: packages, each with a part of the tests' names.
    users: &'static str,
    /// Installs and fetches it, or what it is built from. If this fails, its tests are skipped.
    fetch: Make,
    /// Builds it. If this fails, no tests run.
    build: Option<Make>,
}

type Make = fn() -> anyhow::Result<PathBuf>;

const fn fetched(what: &'static str, variable: &'static str, users: &'static str, fetch: Make) -> Item {
    Item { what, variable, users, fetch, build: None }
}

const fn built(
    what: &'static str,
    variable: &'static str,
    users: &'static str,
    fetch: Make,
    build: Make,
) -> Item {
    Item { what, variable, users, fetch, build: Some(build) }
}

static ITEMS: [Item; 15] = [
    built("the page", "WEB", "yoro-cli web::", page_can_be_built, || web::build().and(this_program())),
    built(
        "the example of yoro-wgpu",
        "WGPU_WEB",
        "yoro-wgpu the_example_in_a_browser",
        page_can_be_built,
        || web::build_example().and(this_program()),
    ),
    fetched("the WebXR emulator", "WEBXR", "yoro-cli web::; yoro-three-tests headsets", web::emulator),
    fetched("three.js", "THREE", "yoro-three-tests ", web::three_modules),
    // The names of the program's tests do not show which of them open a page.
    fetched("Chromium", "CHROMIUM", "yoro-cli ; yoro-three-tests ", || {
        setup::browser().context("it cannot be installed")
    }),
    fetched("Monado", "MONADO", "yoro-cli monado", monado::make),
    // Monado's drivers, and its launcher for this machine's programs.
    fetched("Mesa 25", "MULTIVIEW", "yoro-tests multiview::", || Ok(monado::make()?.join("run"))),
    fetched("hello_xr", "HELLO_XR", "yoro-openxr-layer hello_xr; yoro-cli through_the_layer", hello_xr::make),
    fetched("vkd3d and DXVK", "DIRECT3D", "yoro-c direct3d_", direct3d::make),
    fetched("shader compilers for mobile GPUs", "SHADER_COMPILERS", "yoro-tests shader_cost::", || {
        Ok(Compilers::make()?.folder().to_owned())
    }),
    built("the C library's package", "C_PACKAGE", "yoro-c the_package", package::fetch_users_tools, || {
        package::package(&[package::Target::Linux])?.pop().context("no package was made")
    }),
    fetched("mono, for C#", "MONO", "yoro-c csharp_calls", setup::mono),
    built(
        "the APK (cargo xtask doctor)",
        "APK",
        "yoro-android-host ",
        android::ready_for_tests,
        android::apk_for_tests,
    ),
    built(
        "the Android layer",
        "ANDROID_LAYER",
        "yoro-android-host layer",
        android::ready_for_tests,
        package::layer_for_tests,
    ),
    built("Android on arm64", "ARM64_HOST", "yoro-android-host arm64", arm64::fetch, arm64::build_host),
];

fn this_program() -> anyhow::Result<PathBuf> {
    Ok(std::env::current_exe()?)
}

fn page_can_be_built() -> anyhow::Result<PathBuf> {
    if web::can_be_built() { Ok(PathBuf::new()) } else { bail!("no Rust can compile for browsers") }
}

impl Item {
    fn is_for(&self, package: &str, test: &str) -> bool {
        self.users().any(|(user, part)| user == package && test.contains(part))
    }

    fn users(&self) -> impl Iterator<Item = (&'static str, &'static str)> {
        self.users.split("; ").filter_map(|user| user.split_once(' '))
    }
}

/// True if a test needs any of the items.
pub fn is_needed(package: &str, test: &str) -> bool {
    ITEMS.iter().any(|item| item.is_for(package, test))
}

/// Returns patterns in the table that match no test, for example because it was renamed.
pub fn stale(programs: &[Program]) -> Vec<String> {
    let fits = |(package, part): &(&str, &str)| {
        let mut own = programs.iter().filter(|(binary, _)| binary.package == *package);
        own.any(|(_, names)| names.iter().any(|name| name.contains(part)))
    };
    let users = ITEMS.iter().flat_map(Item::users).filter(|user| !fits(user));
    users.map(|(package, part)| format!("{package} {part}")).collect()
}

/// Installations and downloads that are running in threads.
pub struct Preparation<'scope> {
    system: Option<ScopedJoinHandle<'scope, anyhow::Result<Equipment>>>,
    items: Vec<(&'static Item, ScopedJoinHandle<'scope, anyhow::Result<PathBuf>>)>,
}

/// The equipment of this machine.
#[derive(Debug, Default)]
pub struct Equipment {
    /// Paths by variable; `None` if the item is not available.
    items: Vec<(&'static str, Option<PathBuf>)>,
    /// A sentence for each item that is not available.
    pub absent: Vec<String>,
    /// How long each item was built, in seconds.
    pub seconds: Vec<(&'static str, f64)>,
}

impl<'scope> Preparation<'scope> {
    /// Starts the preparation for the selected tests, or for all tests.
    pub fn begin(scope: &'scope Scope<'scope, '_>, programs: Option<&[Program]>) -> anyhow::Result<Self> {
        // sudo may ask for a password, and other systems get instructions: not in the background of cargo.
        if !apt::installs_by_itself() {
            setup::ensure()?;
        }
        let libraries = || {
            let mut equipment = Equipment::default();
            equipment.add("OSMesa", "OSMESA", setup::ensure()?.then(PathBuf::new));
            equipment.add("Vulkan or its validation layer", "VULKAN", setup::vulkan().then(PathBuf::new));
            Ok(equipment)
        };
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
    pub fn libraries(&mut self) -> anyhow::Result<Equipment> {
        self.system.take().map_or_else(|| Ok(Equipment::default()), join)
    }

    /// Waits for the other items, and builds those that have to be built.
    pub fn finish(self) -> anyhow::Result<Equipment> {
        let mut equipment = Equipment::default();
        for (item, fetching) in self.items {
            let fetched = join(fetching);
            let start = Instant::now();
            let path = match (fetched, item.build) {
                (Ok(_), Some(build)) => Some(build()?),
                (Ok(path), None) => Some(path),
                (Err(error), _) => {
                    eprintln!("warning: {}: {error:#}", item.what);
                    None
                }
            };
            equipment.add(item.what, item.variable, path);
            equipment.seconds.push((item.what, start.elapsed().as_secs_f64()));
        }
        Ok(equipment)
    }
}

fn join<T>(handle: ScopedJoinHandle<'_, anyhow::Result<T>>) -> anyhow::Result<T> {
    handle.join().map_err(|_| anyhow!("the set-up has failed in an unexpected way: see above"))?
}

impl Equipment {
    fn add(&mut self, what: &str, variable: &'static str, path: Option<PathBuf>) {
        if path.is_none() {
            self.absent.push(format!("{what} cannot be had here: its tests were left out"));
        }
        self.items.push((variable, path));
    }

    /// Adds what was prepared meanwhile.
    pub fn extend(&mut self, other: Self) {
        self.items.extend(other.items);
        self.absent.extend(other.absent);
    }

    /// Sets the variables that tell a test program what is available.
    pub fn set_variables(&self, command: &mut Command) {
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
        let items = vec![("APK", Some("yoro.apk".into())), ("MONADO", None)];
        let equipment = Equipment { items, ..Equipment::default() };
        let mut command = Command::new("test");
        equipment.set_variables(&mut command);
        let set: Vec<_> = command.get_envs().filter_map(|(name, _)| name.to_str()).collect();
        assert_eq!(set, ["YORO_TEST_APK", "YORO_TEST_WITHOUT_MONADO"]);
    }
}
