//! A room in both eyes without a window: all ways, compared with two rendered cameras.
//!
//! `cargo run --example headless -- FOLDER` writes pictures into the folder, and prints quality, speed and shaded fragments.

mod support;

use std::time::Instant;

use bevy::prelude::*;
use bevy_yoro::{Foveation, StereoCamera, StereoMode};

const SIZE: [u32; 2] = [1024, 512];
/// The number of frames that are timed for each way, in turn.
const ROUNDS: usize = 9;
/// A name, the settings, and how many cameras render opaque objects.
const WAYS: [(&str, StereoMode, Option<Foveation>, f64); 5] = [
    ("rendered", StereoMode::Rendered, None, 2.0),
    ("opaque", StereoMode::Opaque, None, 1.0),
    ("finished", StereoMode::Finished, None, 1.0),
    ("rendered-foveated", StereoMode::Rendered, Some(Foveation::MEDIUM), 4.0),
    ("opaque-foveated", StereoMode::Opaque, Some(Foveation::MEDIUM), 2.0),
];

fn main() -> Result {
    let folder = std::env::args().nth(1).map_or("out/bevy".into(), std::path::PathBuf::from);
    std::fs::create_dir_all(&folder)?;
    let mut app = support::headless();
    let image = support::target(&mut app, SIZE);
    let camera = app
        .world_mut()
        .spawn((
            Camera3d::default(),
            support::into_image(&image),
            support::viewpoint(),
            Msaa::Off,
            StereoCamera { fov_y: 75f32.to_radians(), ..default() },
        ))
        .id();

    let set = |app: &mut App, mode, foveation| {
        let mut stereo = app.world_mut().get_mut::<StereoCamera>(camera).unwrap();
        (stereo.mode, stereo.foveation) = (mode, foveation);
    };
    let pictures = WAYS.map(|(_, mode, foveation, cameras)| {
        set(&mut app, mode, foveation);
        let picture = support::picture(&mut app, &image);
        (picture, cameras * support::shaded(&mut app, "main_opaque_pass_3d"))
    });
    let mut times = WAYS.map(|_| Vec::new());
    for _ in 0..ROUNDS {
        for ((_, mode, foveation, _), times) in WAYS.into_iter().zip(&mut times) {
            set(&mut app, mode, foveation);
            // Cameras of the other way are spawned or despawned.
            app.update();
            app.update();
            let begin = Instant::now();
            support::picture(&mut app, &image);
            times.push(begin.elapsed().as_secs_f64());
        }
    }
    let (truth, all) = &pictures[0];
    let [left, right] = support::halves(truth);
    println!("left eye: the right one in its place {:.2} dB", support::psnr(&right, &left));
    let medians = times.map(|mut times| {
        times.sort_by(f64::total_cmp);
        times[ROUNDS / 2]
    });
    for (((name, ..), (picture, shaded)), time) in WAYS.into_iter().zip(&pictures).zip(medians) {
        picture.save(folder.join(format!("{name}.png")))?;
        println!(
            "{name}: {:.2} dB, {:.2} of the time of two rendered eyes, {:.2} of their shaded fragments",
            support::psnr(&support::halves(picture)[0], &left),
            time / medians[0],
            shaded / all
        );
    }
    println!("pictures: {}", folder.display());
    Ok(())
}
