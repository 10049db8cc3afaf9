//! yoro on Android: the library that `NativeActivity` loads.
//!
//! It connects Android's window, sensors, touch input, settings and the state of battery and heat to [`yoro_viewer`],
//! which is the application itself. It must not depend on how eyes are synthesized or measured, except for `pictures`,
//! which compares a driver's pictures with stored ones. Other systems build only the parts without Android, for tests.

#[cfg(any(target_os = "android", test))]
mod game_loop;
#[cfg(any(target_os = "android", test))]
mod pace;
#[cfg(any(target_os = "android", test))]
mod pictures;
#[cfg(any(target_os = "android", test))]
mod press;
#[cfg(any(target_os = "android", test))]
mod scan;
#[cfg(any(target_os = "android", test))]
mod settings;
#[cfg(any(target_os = "android", test))]
mod shared;
#[cfg(any(target_os = "android", test))]
mod writer;

#[cfg(target_os = "android")]
mod activity;
#[cfg(target_os = "android")]
mod bindings;
#[cfg(target_os = "android")]
mod camera;
#[cfg(target_os = "android")]
mod configuration;
#[cfg(target_os = "android")]
mod device;
#[cfg(target_os = "android")]
mod display;
#[cfg(target_os = "android")]
mod dynamic;
#[cfg(target_os = "android")]
mod input;
#[cfg(target_os = "android")]
mod java;
#[cfg(target_os = "android")]
mod performance;
#[cfg(target_os = "android")]
mod pulse;
#[cfg(target_os = "android")]
mod results;
#[cfg(target_os = "android")]
mod screen;
#[cfg(target_os = "android")]
mod sensors;
#[cfg(target_os = "android")]
mod system;
#[cfg(target_os = "android")]
mod thermal;

/// The application's entry point. Returning from it ends the activity. It may run more than once in one process, even
/// while an earlier run is about to return.
#[cfg(target_os = "android")]
#[unsafe(no_mangle)]
fn android_main(app: android_activity::AndroidApp) {
    // Scripts read these lines, so only the message may follow the tag. In a second run the first logger stays.
    results::init_log(
        android_logger::Config::default()
            .with_max_level(log::LevelFilter::Info)
            .with_tag(yoro_settings::telemetry::LOG_TAG)
            .format(|writer, record| write!(writer, "{}", record.args())),
    );
    // A panic never unwinds into Android's code: the build aborts after this hook.
    std::panic::set_hook(Box::new(|panic| {
        log::error!("yoro has a bug and ends: {panic}\n{}", std::backtrace::Backtrace::force_capture());
    }));
    log::info!("yoro {} starts", env!("CARGO_PKG_VERSION"));
    activity::run(&app);
    log::info!("yoro ends");
}
