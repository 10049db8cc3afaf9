//! A room in both eyes without a window: both modes, compared with two rendered cameras.
//!
//! `cargo run --example headless -- FOLDER` writes pictures into the folder, and prints the modes' quality and speed.

mod support;

use std::time::Instant;

use bevy::prelude::*;
use bevy_yoro::{StereoCamera, StereoMode};

const SIZE: [u32; 2] = [1024, 512];
/// The number of frames that are timed for each mode, in turn.
const ROUNDS: usize = 9;

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

    let modes = [StereoMode::Rendered, StereoMode::Opaque, StereoMode::Finished];
    let set = |app: &mut App, mode| app.world_mut().get_mut::<StereoCamera>(camera).unwrap().mode = mode;
    let pictures = modes.map(|mode| {
        set(&mut app, mode);
        support::picture(&mut app, &image)
    });
    let mut times = [const { Vec::new() }; 3];
    for _ in 0..ROUNDS {
        for (mode, times) in modes.into_iter().zip(&mut times) {
            set(&mut app, mode);
            // Cameras of the other mode are spawned or despawned.
            app.update();
            app.update();
            let begin = Instant::now();
            support::picture(&mut app, &image);
            times.push(begin.elapsed().as_secs_f64());
        }
    }
    let [left, right] = support::halves(&pictures[0]);
    println!("left eye: the right one in its place {:.2} dB", support::psnr(&right, &left));
    let medians = times.map(|mut times| {
        times.sort_by(f64::total_cmp);
        times[ROUNDS / 2]
    });
    for ((mode, picture), time) in modes.into_iter().zip(&pictures).zip(medians) {
        let name = format!("{mode:?}").to_lowercase();
        picture.save(folder.join(format!("{name}.png")))?;
        println!(
            "{name}: {:.2} dB, {:.2} of the time of two rendered eyes",
            support::psnr(&support::halves(picture)[0], &left),
            time / medians[0]
        );
    }
    println!("pictures: {}", folder.display());
    Ok(())
}
