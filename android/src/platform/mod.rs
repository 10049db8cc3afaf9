//! What exists on Android only: the activity, and everything by NDK and JNI.

mod activity;
mod camera;
mod configuration;
mod display;
mod input;
mod java;
mod measure;
mod motion;
mod system;

/// The application's entry point. Returning from it ends the activity. It may run more than once in one process, even
/// while an earlier run is about to return.
#[unsafe(no_mangle)]
fn android_main(app: android_activity::AndroidApp) {
    // Scripts read these lines, so only the message may follow the tag. In a second run the first logger stays.
    measure::results::init_log(
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
