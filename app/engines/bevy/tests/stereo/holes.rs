//! Rendered holes, against Bevy's own second camera.

use bevy::camera::Hdr;
use bevy::prelude::*;
use bevy_yoro::{Foveation, Holes, StereoMode};

use crate::support::{halves, psnr};
use crate::{Stage, save};

impl Stage {
    /// Compares rendered holes with filled ones, and returns what they gain in dB.
    fn check_holes(&mut self, what: &str) -> f64 {
        let truth = halves(&self.in_mode(StereoMode::Rendered));
        let [filled, rendered] = [Holes::Filled, Holes::Rendered].map(|holes| {
            self.stereo().holes = holes;
            let picture = self.in_mode(StereoMode::Opaque);
            save(&picture, &format!("{what} {holes:?}"), StereoMode::Opaque);
            halves(&picture)
        });
        assert!(filled[1] == rendered[1], "{what}: the rendered eye changed");
        let [filled, rendered] = [filled, rendered].map(|eyes| psnr(&eyes[0], &truth[0]));
        println!("{what}: filled {filled:.2} dB, rendered {rendered:.2} dB");
        rendered - filled
    }
}

#[test]
fn holes_are_rendered_without_touching_materials() {
    let mut stage = Stage::new();
    let gain = stage.check_holes("holes");
    assert!(gain > 1.0, "{gain:.2} dB");
    stage.stereo().foveation = Some(Foveation::MEDIUM);
    let gain = stage.check_holes("holes of an inset");
    assert!(gain > 0.2, "in the inset: {gain:.2} dB");
    stage.stereo().foveation = None;
    let camera = stage.camera;
    stage.app.world_mut().entity_mut(camera).insert(Hdr);
    let gain = stage.check_holes("holes with Hdr");
    assert!(gain > 1.0, "Hdr: {gain:.2} dB");
    stage.app.world_mut().entity_mut(camera).insert(Msaa::Sample4).remove::<Hdr>();
    let gain = stage.check_holes("holes with 4 samples");
    assert_eq!(gain, 0.0, "holes are filled with several samples");
}
