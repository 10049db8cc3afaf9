//! The choice between one render with synthesis and two renders.

use bevy::prelude::*;
use bevy::time::TimeUpdateStrategy;
use bevy_yoro::yoro_wgpu::yoro::choice::{Reason, StereoPath};
use bevy_yoro::{AutoChoice, StereoMode};

use crate::{Stage, support::rendered};

/// Returns the images, and the number of cameras.
fn held(stage: &mut Stage) -> (Vec<AssetId<Image>>, usize) {
    let world = stage.app.world_mut();
    let cameras = world.query::<&Camera>().iter(world).count();
    (world.resource::<Assets<Image>>().ids().collect(), cameras)
}

#[test]
fn auto_shows_either_way_in_turns_and_takes_the_cheaper_one() {
    let mut stage = Stage::new();
    let named = [StereoMode::Rendered, StereoMode::Opaque].map(|mode| stage.in_mode(mode));
    let before = held(&mut stage);
    // A frame every 0.2 s.
    stage.app.insert_resource(TimeUpdateStrategy::FixedTimesteps(13));
    stage.stereo().mode = StereoMode::Auto;

    let (mut frames, mut kept) = ([0; 2], None);
    let choice = loop {
        stage.app.update();
        let shown = rendered(&stage.app, &stage.image);
        let way = named.iter().position(|named| *named == shown);
        frames[way.unwrap_or_else(|| panic!("frame {frames:?} is neither"))] += 1;
        if frames[0] > 0 {
            let now = held(&mut stage);
            assert_eq!(
                kept.get_or_insert_with(|| now.clone()),
                &now,
                "each way keeps its images, at {frames:?}"
            );
        }
        let chooser = stage.app.world().resource::<AutoChoice>().chooser();
        if !chooser.is_measuring() {
            break chooser.choice();
        }
    };
    println!("auto: {choice:?} after {frames:?} frames");
    assert!(frames.iter().all(|frames| *frames >= 21), "three turns each: {frames:?}");
    assert_eq!((choice.path, choice.reason), (StereoPath::Synthesis, Reason::Cheaper));
    let [Some(two), None, Some(one)] = choice.costs_ms else { panic!("{choice:?}") };
    assert!(0.0 < one && one < two, "the GPU's times, not those between frames: {choice:?}");

    // The chosen way stays, and with its name nothing of the other one.
    assert_eq!([stage.picture(), stage.in_mode(StereoMode::Opaque)], [named[1].clone(), named[1].clone()]);
    assert_eq!(held(&mut stage), before);
}
