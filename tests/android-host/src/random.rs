//! Random events that Android can send in the activity's current state.

use rand::Rng;

use crate::player::Stage;
use crate::script::{Battery, Key, Step, Thermal};

/// Returns the next event.
pub fn step(generator: &mut impl Rng, stage: Stage, width: i32, height: i32) -> Step {
    if !stage.created {
        return Step::Launch;
    }
    if !stage.started {
        return match generator.random_range(0..10) {
            0 => Step::Destroy,
            1 => Step::LowMemory,
            2 if stage.window => Step::WindowLost,
            _ => Step::Start,
        };
    }
    if !stage.resumed {
        return match generator.random_range(0..8) {
            0 | 1 => Step::Stop,
            2 => Step::SaveState,
            3 if stage.window => Step::WindowLost,
            4 => Step::LowMemory,
            5 if stage.focus => Step::Unfocus,
            _ => Step::Resume,
        };
    }
    if !stage.window {
        return match generator.random_range(0..6) {
            0 => Step::Pause,
            1 => Step::ConfigurationChanged,
            _ => Step::Window,
        };
    }
    match generator.random_range(0..26) {
        0..=4 => Step::Frames(generator.random_range(1..=3)),
        5..=8 => Step::Tap { x: generator.random_range(0.0..1.0), y: generator.random_range(0.0..1.0) },
        9 => Step::LongPress { x: 0.5, y: 0.5, seconds: 0.6 },
        10..=12 => {
            let keys = [
                Key::VolumeUp,
                Key::VolumeDown,
                Key::Headset,
                Key::DpadCenter,
                Key::Enter,
                Key::Menu,
                Key::ButtonA,
            ];
            Step::Key(keys[generator.random_range(0..keys.len())])
        }
        13 | 14 => {
            let divisor = generator.random_range(1..=2);
            let (width, height) =
                if generator.random_range(0..4) == 0 { (height, width) } else { (width, height) };
            Step::Resize { width: (width / divisor).max(1), height: (height / divisor).max(1) }
        }
        15 => Step::Head {
            yaw: generator.random_range(-90.0..90.0),
            pitch: generator.random_range(-45.0..45.0),
            roll: 0.0,
            seconds: 0.05,
            go_on: false,
        },
        16 => Step::Battery(Battery {
            level: generator.random_range(0..=100),
            plugged: generator.random_range(0..=2),
            ..Battery::default()
        }),
        17 => Step::Thermal(Thermal {
            status: generator.random_range(0..=6),
            headroom: generator.random_range(0.0..1.5),
        }),
        18 => Step::LowMemory,
        19 => Step::ConfigurationChanged,
        20 => Step::WindowLost,
        21 => Step::ContextLoss,
        22 if stage.focus => Step::Unfocus,
        22 => Step::Focus,
        23 | 24 => Step::Pause,
        _ => Step::SaveState,
    }
}

/// Returns the steps that lead from this state to one in which the activity shows frames.
pub fn back_to_running(stage: Stage) -> Vec<Step> {
    if !stage.created {
        return vec![Step::Launch];
    }
    let mut steps = Vec::new();
    for (there, step) in [
        (stage.started, Step::Start),
        (stage.resumed, Step::Resume),
        (stage.window, Step::Window),
        (stage.focus, Step::Focus),
    ] {
        if !there {
            steps.push(step);
        }
    }
    steps
}
