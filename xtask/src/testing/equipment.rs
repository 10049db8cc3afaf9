//! Programs and packages that some tests need. They are fetched while cargo compiles the tests, and built afterwards.

use std::path::PathBuf;
use std::process::Command;
use std::thread::{Scope, ScopedJoinHandle};

use anyhow::{Context as _, anyhow};

use crate::maintain::estimate::Compilers;

use super::Program;
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

const fn item(what: &'static str, variable: &'static str, users: &'static str, fetch: Make) -> Item {
    Item { what, variable, users, fetch, build: None }
}

impl Item {
    const fn built(self, build: Make) -> Self {
        Self { build: Some(build), ..self }
    }

    fn is_for(&self, package: &str, test: &str) -> bool {
        let mut users = self.users.split("; ").filter_map(|user| user.split_once(' '));
        users.any(|(user, part)| user == package && test.contains(part))
    }
}

static ITEMS: [Item; 15] = [
    item("the page", "WEB", "yoro-cli web::", web::ready_for_tests)
        .built(|| web::page_for_tests().and(this_program())),
    item("the example of yoro-wgpu", "WGPU_WEB", "yoro-wgpu the_example_in_a_browser", web::ready_for_tests)
        .built(|| web::build_example(web::TESTED).and(this_program())),
    item("the WebXR emulator", "WEBXR", "yoro-cli web::; yoro-three-tests headsets", web::emulator),
    item("three.js", "THREE", "yoro-three-tests ", web::three_modules),
    // The names of the program's tests do not show which of them open a page.
    item("Chromium", "CHROMIUM", "yoro-cli ; yoro-three-tests ", || {
        setup::browser().context("it cannot be installed")
    }),
    item("Monado", "MONADO", "yoro-cli monado", monado::make),
    // Monado's drivers, and its launcher for this machine's programs.
    item("Mesa 25", "MULTIVIEW", "yoro-tests multiview::", || Ok(monado::make()?.join("run"))),
    item("hello_xr", "HELLO_XR", "yoro-openxr-layer hello_xr; yoro-cli through_the_layer", hello_xr::make),
    item("vkd3d and DXVK", "DIRECT3D", "yoro-c direct3d_", direct3d::make),
    item("shader compilers for mobile GPUs", "SHADER_COMPILERS", "yoro-tests shader_cost::", || {
        Ok(Compilers::make()?.folder().to_owned())
    }),
    item("the C library's package", "C_PACKAGE", "yoro-c the_package", package::fetch_users_tools)
        .built(|| package::package(&[package::Target::Linux])?.pop().context("no package was made")),
    item("mono, for C#", "MONO", "yoro-c csharp_calls", setup::mono),
    item("the APK (cargo xtask doctor)", "APK", "yoro-android-host ", android::ready_for_tests)
        .built(android::apk_for_tests),
    item("the Android layer", "ANDROID_LAYER", "yoro-android-host layer", android::ready_for_tests)
        .built(package::layer_for_tests),
    item("Android on arm64", "ARM64_HOST", "yoro-android-host arm64", arm64::fetch).built(arm64::build_host),
];

fn this_program() -> anyhow::Result<PathBuf> {
    Ok(std::env::current_exe()?)
}

/// True if a test needs any of the items that are built.
pub fn is_built(package: &str, test: &str) -> bool {
    ITEMS.iter().any(|item| item.build.is_some() && item.is_for(package, test))
}

/// Installations and downloads that are running in threads.
pub struct Preparation<'scope> {
    libraries: Option<ScopedJoinHandle<'scope, anyhow::Result<Equipment>>>,
    fetching: Vec<(&'static Item, ScopedJoinHandle<'scope, anyhow::Result<PathBuf>>)>,
    /// What is to be built.
    fetched: Vec<&'static Item>,
}

/// The equipment of this machine.
#[derive(Debug, Default)]
pub struct Equipment {
    /// Names and variables with their paths; `None` if the item is not available.
    pub items: Vec<(&'static str, &'static str, Option<PathBuf>)>,
}

impl<'scope> Preparation<'scope> {
    /// Starts the preparation for the selected tests, or for all tests.
    pub fn begin(scope: &'scope Scope<'scope, '_>, programs: Option<&[Program]>) -> anyhow::Result<Self> {
        // sudo may ask for a password, and other systems get instructions: not in the background of cargo.
        if !apt::installs_by_itself() {
            setup::ensure()?;
        }
        let libraries = || {
            let osmesa = ("OSMesa", "OSMESA", setup::ensure()?.then(PathBuf::new));
            let vulkan = ("Vulkan or its validation layer", "VULKAN", setup::vulkan().then(PathBuf::new));
            Ok(Equipment { items: vec![osmesa, vulkan] })
        };
        // A few selected tests are not worth the wait for a browser, so they only use an installed one.
        let wanted = |item: &&Item| {
            programs.is_none_or(|programs| {
                let mut tests =
                    programs.iter().flat_map(|one| one.tests.iter().map(|test| (&one.package, test)));
                item.variable != "CHROMIUM" && tests.any(|(package, test)| item.is_for(package, test))
            })
        };
        let fetching = ITEMS.iter().filter(wanted).map(|item| (item, scope.spawn(item.fetch))).collect();
        Ok(Self { libraries: Some(scope.spawn(libraries)), fetching, fetched: Vec::new() })
    }

    /// Waits for the system libraries, which all tests need.
    pub fn libraries(&mut self) -> anyhow::Result<Equipment> {
        self.libraries.take().map_or_else(|| Ok(Equipment::default()), join)
    }

    /// Waits for the other items, and returns those that need not be built.
    pub fn fetched(&mut self) -> Equipment {
        let mut equipment = Equipment::default();
        for (item, fetching) in self.fetching.drain(..) {
            match join(fetching) {
                Ok(_) if item.build.is_some() => self.fetched.push(item),
                Ok(path) => equipment.add(item, Some(path)),
                Err(error) => {
                    eprintln!("warning: {}: {error:#}", item.what);
                    equipment.add(item, None);
                }
            }
        }
        equipment
    }

    /// Builds the items that have to be built.
    pub fn built(self) -> anyhow::Result<Equipment> {
        let mut equipment = Equipment::default();
        for item in self.fetched {
            equipment.add(item, item.build.map(|build| build()).transpose()?);
        }
        Ok(equipment)
    }
}

fn join<T>(handle: ScopedJoinHandle<'_, anyhow::Result<T>>) -> anyhow::Result<T> {
    handle.join().map_err(|_| anyhow!("the set-up has failed in an unexpected way: see above"))?
}

impl Equipment {
    fn add(&mut self, item: &Item, path: Option<PathBuf>) {
        self.items.push((item.what, item.variable, path));
    }

    /// Sets the variables that tell a test program what is available.
    pub fn set_variables(&self, command: &mut Command) {
        for (_, variable, path) in &self.items {
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
        assert_eq!(needed("yoro-cli", "web::a_headset"), "WEB WEBXR CHROMIUM");
    }
}
