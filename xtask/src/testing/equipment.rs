//! What some tests need, and others can do without: it is fetched and installed while cargo compiles the tests.

use std::env;
use std::path::PathBuf;
use std::process::Command;
use std::thread::{Scope, ScopedJoinHandle};
use std::time::{Duration, Instant};

use anyhow::anyhow;
use yoro_tools::shader_cost::Compilers;
use yoro_tools::{apt, arm64, hello_xr, monado};

use super::summary::Summary;

use crate::{android, package, setup, web};

/// What is here.
#[derive(Clone, Debug, Default)]
pub struct Equipment {
    /// Mesa's rasterizer without a window system.
    osmesa: bool,
    /// A Vulkan driver and the validation layer.
    vulkan: bool,
    /// The Android application.
    apk: Equipped,
    /// The OpenXR API layer for Android.
    layer: Equipped,
    /// The simulated Android host for arm64.
    arm64: Equipped,
    /// A browser for report pages.
    browser: Equipped,
    /// The folder of Monado, an OpenXR runtime.
    monado: Equipped,
    /// The folder of an OpenXR application for it.
    hello_xr: Equipped,
    /// The folder of compilers for mobile GPUs.
    shader_compilers: Equipped,
    /// This program, which has built the page.
    web: Equipped,
    /// A script that plays a headset to browsers.
    webxr: Equipped,
}

/// Is a file for tests here?
#[derive(Clone, Debug, Default)]
enum Equipped {
    /// No test that runs asks for it.
    #[default]
    NotWanted,
    /// It cannot be had on this machine: its tests are left out.
    Missing,
    /// Here.
    At(PathBuf),
}

impl Equipped {
    /// Tells the tests: by `YORO_TEST_name` where it is, or by `YORO_TEST_WITHOUT_name` that they are left out.
    fn tell(&self, name: &str, command: &mut Command) {
        match self {
            Self::At(path) => command.env(format!("YORO_TEST_{name}"), path),
            Self::Missing | Self::NotWanted => command.env(format!("YORO_TEST_WITHOUT_{name}"), "1"),
        };
    }

    fn or_missing(result: anyhow::Result<PathBuf>, what: &str) -> Self {
        match result {
            Ok(path) => Self::At(path),
            Err(error) => {
                eprintln!("warning: {what}, so that its tests are left out: {error:#}");
                Self::Missing
            }
        }
    }
}

impl Equipment {
    /// Tells the tests what is here.
    pub fn tell(&self, command: &mut Command) {
        if !self.osmesa {
            command.env("YORO_TEST_WITHOUT_OSMESA", "1");
        }
        if !self.vulkan {
            command.env("YORO_TEST_WITHOUT_VULKAN", "1");
        }
        self.apk.tell("APK", command);
        self.layer.tell("ANDROID_LAYER", command);
        self.arm64.tell("ARM64_HOST", command);
        self.browser.tell("CHROMIUM", command);
        self.monado.tell("MONADO", command);
        self.hello_xr.tell("HELLO_XR", command);
        self.shader_compilers.tell("SHADER_COMPILERS", command);
        self.web.tell("WEB", command);
        self.webxr.tell("WEBXR", command);
    }

    /// What cannot be had, a sentence each.
    pub fn absent(&self) -> Vec<&'static str> {
        let missing = |equipped: &Equipped| matches!(equipped, Equipped::Missing);
        let sentences = [
            (!self.osmesa, "OSMesa is not here"),
            (!self.vulkan, "Vulkan or its validation layer is not here"),
            (missing(&self.apk), "The APK cannot be built here (cargo xtask doctor)"),
            (
                missing(&self.arm64),
                "The simulated Android host for arm64 cannot be set up here (see the warning above)",
            ),
            (missing(&self.browser), "Chromium is not here"),
            (missing(&self.monado), "Monado cannot be set up here (see the warning above)"),
            (missing(&self.hello_xr), "hello_xr cannot be set up here (see the warning above)"),
            (
                missing(&self.shader_compilers),
                "Shader compilers for mobile GPUs cannot be set up here (see the warning above)",
            ),
            (missing(&self.web), "The page cannot be built here (see the warning above)"),
            (missing(&self.webxr), "The WebXR emulator cannot be fetched here (see the warning above)"),
        ];
        sentences.into_iter().filter(|(absent, _)| *absent).map(|(_, sentence)| sentence).collect()
    }
}

/// Which of it tests ask for. All of them need the system's libraries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wanted {
    /// The Android application.
    pub apk: bool,
    /// The OpenXR API layer for Android, which is of no use without the application.
    pub layer: bool,
    /// The simulated Android host for arm64, which is of no use without the application.
    pub arm64: bool,
    /// An OpenXR runtime.
    pub monado: bool,
    /// An OpenXR application, which is of no use without the runtime.
    pub hello_xr: bool,
    /// A browser, even if it has to be installed.
    pub browser: bool,
    /// Compilers for mobile GPUs.
    pub shader_compilers: bool,
    /// A Vulkan driver and the validation layer.
    pub vulkan: bool,
    /// The page.
    pub web: bool,
}

impl Wanted {
    /// For all tests.
    pub const ALL: Self = Self {
        apk: true,
        layer: true,
        arm64: true,
        monado: true,
        hello_xr: true,
        browser: true,
        shader_compilers: true,
        vulkan: true,
        web: true,
    };
    const NONE: Self = Self {
        apk: false,
        layer: false,
        arm64: false,
        monado: false,
        hello_xr: false,
        browser: false,
        shader_compilers: false,
        vulkan: false,
        web: false,
    };

    /// For tests with these packages and names. A few chosen ones are not worth the wait for a browser's installation.
    pub fn by<'a>(tests: impl IntoIterator<Item = (&'a str, &'a str)>) -> Self {
        let mut wanted = Self::NONE;
        for (package, name) in tests {
            wanted.apk |= package == "yoro-android-host";
            wanted.layer |= package == "yoro-android-host" && name.contains("layer");
            wanted.arm64 |= package == "yoro-android-host" && name.contains("arm64");
            wanted.monado |= package == "yoro-app" && name.contains("monado");
            wanted.web |= package == "yoro-app" && name.starts_with("web::");
            wanted.hello_xr |= package == "yoro-layer" && name.contains("hello_xr");
            wanted.hello_xr |= package == "yoro-app" && name.contains("through_the_layer");
            wanted.shader_compilers |= package == "yoro-tests" && name.starts_with("shader_cost::");
            wanted.vulkan |= package == "yoro"
                || package == "yoro-layer"
                || (package == "yoro-tests" && name.starts_with("vulkan::"));
        }
        wanted
    }
}

/// Installing and fetching that goes on.
pub struct Preparation<'scope> {
    wanted: Wanted,
    system: ScopedJoinHandle<'scope, (anyhow::Result<System>, Duration)>,
    /// Monado, and hello_xr, which begins with it.
    xr: Option<ScopedJoinHandle<'scope, ([Equipped; 2], Duration)>>,
    shader_compilers: Option<ScopedJoinHandle<'scope, (Equipped, Duration)>>,
    host: Option<ScopedJoinHandle<'scope, (anyhow::Result<arm64::Host>, Duration)>>,
    webxr: Option<ScopedJoinHandle<'scope, (Equipped, Duration)>>,
}

/// What the system's package manager has brought.
struct System {
    osmesa: bool,
    vulkan: bool,
    apk: Option<anyhow::Result<()>>,
    arm64: Option<anyhow::Result<()>>,
    browser: Equipped,
}

impl System {
    fn install(wanted: Wanted) -> anyhow::Result<Self> {
        let osmesa = setup::ensure()?.osmesa;
        let vulkan = !wanted.vulkan || setup::vulkan();
        let apk = wanted.apk.then(android::ready_for_tests);
        let arm64 = wants_arm64(wanted).then(arm64::Host::ready);
        let absent = if wanted.browser { Equipped::Missing } else { Equipped::NotWanted };
        let browser = setup::browser(wanted.browser).map_or(absent, Equipped::At);
        Ok(Self { osmesa, vulkan, apk, arm64, browser })
    }
}

/// A machine of arm64 runs that library by itself.
fn wants_arm64(wanted: Wanted) -> bool {
    cfg!(target_arch = "x86_64") && wanted.apk && wanted.arm64
}

fn timed<T>(work: impl FnOnce() -> T) -> (T, Duration) {
    let start = Instant::now();
    (work(), start.elapsed())
}

impl<'scope> Preparation<'scope> {
    /// Begins, in threads: one for the system's packages, since only one at a time can be installed, and one for each of
    /// the folders of unpacked packages.
    ///
    /// # Errors
    /// When a library is missing that somebody else has to install.
    pub fn begin(scope: &'scope Scope<'scope, '_>, wanted: Wanted) -> anyhow::Result<Self> {
        // sudo may ask for a password, and others say what to install: not behind cargo's back.
        if !apt::installs_by_itself() {
            setup::ensure()?;
        }
        let fetch_xr = move || {
            let monado = Equipped::or_missing(monado::make(), "Monado cannot be set up here");
            let hello_xr = match wanted.hello_xr {
                true => Equipped::or_missing(hello_xr::make(), "hello_xr cannot be set up here"),
                false => Equipped::NotWanted,
            };
            [monado, hello_xr]
        };
        let wants_xr = wanted.monado || wanted.hello_xr;
        let fetch_compilers = || {
            let folder = Compilers::make().map(|compilers| compilers.folder().to_owned());
            Equipped::or_missing(folder, "shader compilers for mobile GPUs cannot be set up here")
        };
        let fetch_webxr =
            || Equipped::or_missing(web::emulator(), "the WebXR emulator cannot be fetched here");
        Ok(Self {
            wanted,
            system: scope.spawn(move || timed(|| System::install(wanted))),
            xr: wants_xr.then(|| scope.spawn(move || timed(fetch_xr))),
            shader_compilers: wanted.shader_compilers.then(|| scope.spawn(move || timed(fetch_compilers))),
            webxr: wanted.web.then(|| scope.spawn(move || timed(fetch_webxr))),
            host: wants_arm64(wanted).then(|| scope.spawn(|| timed(arm64::Host::fetch))),
        })
    }

    /// Waits for the rest, and builds what has to be built of it.
    ///
    /// # Errors
    /// When a library is missing, or something cannot be built although everything for it is there.
    pub fn finish(self, summary: &mut Summary) -> anyhow::Result<Equipment> {
        let start = Instant::now();
        let (system, taken) = join(self.system)?;
        summary.beside("system libraries, tools, browser", taken);
        let system = system?;
        let [mut monado, mut hello_xr] = [Equipped::NotWanted, Equipped::NotWanted];
        if let Some(handle) = self.xr {
            let (equipped, taken) = join(handle)?;
            summary.beside("Monado, hello_xr", taken);
            [monado, hello_xr] = equipped;
        }
        let mut shader_compilers = Equipped::NotWanted;
        if let Some(handle) = self.shader_compilers {
            let (equipped, taken) = join(handle)?;
            summary.beside("shader compilers", taken);
            shader_compilers = equipped;
        }
        let mut webxr = Equipped::NotWanted;
        if let Some(handle) = self.webxr {
            let (equipped, taken) = join(handle)?;
            summary.beside("WebXR emulator", taken);
            webxr = equipped;
        }
        let mut host = None;
        if let Some(handle) = self.host {
            let (fetched, taken) = join(handle)?;
            summary.beside("Debian for arm64", taken);
            host = Some(fetched);
        }
        summary.phase("waiting for the set-up", start.elapsed());

        let apk = match system.apk {
            None => Equipped::NotWanted,
            Some(Ok(())) => {
                let options = android::Options { release: true, yes: true, openxr_loaders: Vec::new() };
                Equipped::At(summary.measure("building the APK", || android::apk(&options))?)
            }
            Some(Err(error)) => Equipped::or_missing(Err(error), "the APK cannot be built here"),
        };
        let layer = match apk {
            Equipped::At(_) if self.wanted.layer => {
                Equipped::At(summary.measure("building the Android layer", package::layer_for_tests)?)
            }
            _ => Equipped::NotWanted,
        };
        let host = match (system.arm64, host) {
            (Some(Err(error)), _) => Some(Err(error)),
            (_, host) => host,
        };
        let arm64 = match host.filter(|_| matches!(apk, Equipped::At(_))) {
            None => Equipped::NotWanted,
            Some(Ok(host)) => Equipped::At(summary.measure("building the arm64 host", || host.build())?),
            Some(Err(error)) => Equipped::or_missing(Err(error), "the arm64 library cannot be run here"),
        };
        let web = match webxr {
            Equipped::NotWanted => Equipped::NotWanted,
            _ if !web::can_be_built() => Equipped::or_missing(
                Err(anyhow!("no Rust can compile for browsers")),
                "the page cannot be built here",
            ),
            _ => {
                summary.measure("building the page", web::build)?;
                Equipped::At(env::current_exe()?)
            }
        };
        let System { osmesa, vulkan, browser, .. } = system;
        Ok(Equipment {
            osmesa,
            vulkan,
            apk,
            layer,
            arm64,
            browser,
            monado,
            hello_xr,
            shader_compilers,
            web,
            webxr,
        })
    }
}

fn join<T>(handle: ScopedJoinHandle<'_, T>) -> anyhow::Result<T> {
    handle.join().map_err(|_| anyhow!("the set-up has failed in an unexpected way: see above"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_tests_ask_for_is_told_by_their_names() {
        assert_eq!(Wanted::by([("yoro-lab", "monado::arm64"), ("yoro-app", "shader_cost::x")]), Wanted::NONE);
        assert_eq!(Wanted::by([("yoro-android-host", "boots")]), Wanted { apk: true, ..Wanted::NONE });
        let tests = [
            ("yoro-android-host", "the_arm64_library"),
            ("yoro-android-host", "through_the_layer"),
            ("yoro-app", "xr::monado_shows"),
            ("yoro-layer", "monado_and_hello_xr"),
            ("yoro-tests", "shader_cost::synthesis"),
            ("yoro-tests", "vulkan::scenes"),
            ("yoro-app", "web::a_headset_shows_both_eyes"),
        ];
        assert_eq!(Wanted::by(tests), Wanted { browser: false, ..Wanted::ALL });
    }

    #[test]
    fn tests_are_told_what_is_here_and_what_is_not() {
        let equipment = Equipment {
            osmesa: true,
            vulkan: true,
            apk: Equipped::At("yoro.apk".into()),
            ..Equipment::default()
        };
        let mut command = Command::new("test");
        equipment.tell(&mut command);
        let set: Vec<_> = command.get_envs().filter_map(|(name, _)| name.to_str()).collect();
        assert_eq!(
            set,
            [
                "YORO_TEST_APK",
                "YORO_TEST_WITHOUT_ANDROID_LAYER",
                "YORO_TEST_WITHOUT_ARM64_HOST",
                "YORO_TEST_WITHOUT_CHROMIUM",
                "YORO_TEST_WITHOUT_HELLO_XR",
                "YORO_TEST_WITHOUT_MONADO",
                "YORO_TEST_WITHOUT_SHADER_COMPILERS",
                "YORO_TEST_WITHOUT_WEB",
                "YORO_TEST_WITHOUT_WEBXR"
            ]
        );
        assert!(equipment.absent().is_empty());
        let missing = Equipment { apk: Equipped::Missing, ..equipment };
        assert_eq!(missing.absent(), ["The APK cannot be built here (cargo xtask doctor)"]);
    }
}
