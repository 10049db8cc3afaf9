//! yoro on Android: the library that `NativeActivity` loads.
#![cfg(target_os = "android")]

mod surface;

use std::time::Duration;

use android_activity::{AndroidApp, MainEvent, PollEvent};
use log::{LevelFilter, error, info};

use surface::{Display, Surface};

/// Where Android's activity begins; returning ends it. It may run more than once in one process.
#[unsafe(no_mangle)]
fn android_main(app: AndroidApp) {
    // The second time in one process the first logger stays.
    android_logger::init_once(
        android_logger::Config::default().with_max_level(LevelFilter::Info).with_tag("YORO"),
    );
    info!("yoro {} starts", env!("CARGO_PKG_VERSION"));
    match Display::open() {
        Ok(display) => run(&app, &display),
        Err(error) => error!("{error}"),
    }
    info!("yoro ends");
}

fn run(app: &AndroidApp, display: &Display) {
    let mut surface: Option<Surface<'_>> = None;
    let mut resumed = false;
    let mut destroyed = false;
    let mut frames = 0u64;
    while !destroyed {
        let drawing = resumed && surface.is_some();
        let timeout = if drawing { Duration::ZERO } else { Duration::from_millis(250) };
        app.poll_events(Some(timeout), |event| {
            let PollEvent::Main(event) = event else { return };
            info!("event {event:?}");
            match event {
                MainEvent::InitWindow { .. } => {
                    surface = app.native_window().and_then(|window| match display.surface(window) {
                        Ok(surface) => Some(surface),
                        Err(error) => {
                            error!("{error}");
                            None
                        }
                    });
                }
                MainEvent::TerminateWindow { .. } => surface = None,
                MainEvent::Resume { .. } => resumed = true,
                MainEvent::Pause => resumed = false,
                MainEvent::Destroy => destroyed = true,
                _ => {}
            }
        });
        if let Some(surface) = surface.as_ref().filter(|_| resumed) {
            if let Err(error) = surface.clear([0.08, 0.13, 0.24, 1.0]) {
                error!("{error}");
            }
            frames += 1;
            if frames == 1 {
                info!("first frame");
            }
        }
    }
}
