//! Finding views that show nothing to measure.

use std::rc::Rc;

use yoro::eyes::{DepthRange, EyePair, View};
use yoro_gl::{Context, GlError};
use yoro_render::{DepthReader, GpuScene, PreparedScene, ViewTargets};

/// The longest edge in pixels of the image that is examined. Whatever is smaller on the screen is negligible.
const EDGE: u32 = 256;

/// The reason why a view shows nothing of a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Blank {
    /// It looks elsewhere.
    Elsewhere,
    /// Everything is cut off by the far plane. Both in metres.
    Beyond {
        /// The far plane.
        far: f32,
        /// One that lies behind everything.
        enough: f32,
    },
    /// Everything is cut off by the near plane. Both in metres.
    Before {
        /// The near plane.
        near: f32,
        /// One that lies in front of most things.
        enough: f32,
    },
}

impl Blank {
    /// Returns the reason and the remedy in a scene of this name.
    pub fn remedy(&self, scene: &str) -> String {
        match self {
            Blank::Elsewhere => {
                format!("write viewpoints that show the model into {scene}.camera.json beside it")
            }
            Blank::Beyond { far, enough } => {
                format!("all of it lies beyond the far plane of {far} m: move that to {enough} m")
            }
            Blank::Before { near, enough } => {
                format!("all of it lies before the near plane of {near} m: move that to {enough} m")
            }
        }
    }
}

/// The error for a view that shows nothing.
#[derive(Debug, thiserror::Error)]
#[error("{view} of {scene} shows nothing, so there is nothing to measure: {}", blank.remedy(scene))]
pub struct BlankView {
    /// The view's name.
    pub view: String,
    /// The scene's name.
    pub scene: String,
    /// The reason.
    pub blank: Blank,
}

/// Finds views that show only the sky, in which every method is perfect.
pub struct BlankFinder {
    targets: ViewTargets,
    depth: DepthReader,
}

impl BlankFinder {
    /// Makes the targets.
    ///
    /// # Errors
    /// [`GlError`] when the driver refuses a program or a target.
    pub fn new(gl: &Rc<Context>) -> Result<BlankFinder, GlError> {
        Ok(BlankFinder { targets: ViewTargets::default(), depth: DepthReader::new(gl)? })
    }

    /// Refuses a scene if one of its `views`, given by name and eyes, shows nothing.
    ///
    /// # Errors
    /// [`BlankView`] with the remedy; [`GlError`] if the driver has no memory for the targets.
    pub fn refuse_blank<'v>(
        &mut self,
        prepared: &mut PreparedScene,
        views: impl IntoIterator<Item = (String, &'v EyePair)>,
    ) -> anyhow::Result<()> {
        for (view, pair) in views {
            if let Some(blank) = self.blank(prepared, pair)? {
                return Err(BlankView { view, scene: prepared.scene.name.clone(), blank }.into());
            }
        }
        Ok(())
    }

    /// Returns why the dominant eye sees no surface, opaque or blended; `None` if it sees one.
    ///
    /// # Errors
    /// [`GlError`] when the driver has no memory for the targets.
    pub fn blank(&mut self, prepared: &mut PreparedScene, pair: &EyePair) -> Result<Option<Blank>, GlError> {
        let view = pair.view(pair.dominant);
        if self.sees(prepared, &view)? {
            return Ok(None);
        }
        let DepthRange { near, far, .. } = view.depth;
        let with = |depth: DepthRange| View { depth, ..view };
        if self.sees(prepared, &with(DepthRange { far: f32::INFINITY, ..view.depth }))? {
            return Ok(Some(Blank::Beyond { far, enough: behind(&prepared.scene, &view) }));
        }
        if self.sees(prepared, &with(DepthRange { near: near * 1e-3, ..view.depth }))? {
            let usual = DepthRange::PAPER.near;
            let enough = if near > usual { usual } else { near * 0.1 };
            return Ok(Some(Blank::Before { near, enough }));
        }
        Ok(Some(Blank::Elsewhere))
    }

    fn sees(&mut self, prepared: &mut PreparedScene, view: &View) -> Result<bool, GlError> {
        let mut view = *view;
        let longest = view.size[0].max(view.size[1]);
        if longest > EDGE {
            view.size = view.size.map(|n| (n * EDGE / longest).max(1));
        }
        let PreparedScene { renderer, scene } = prepared;
        // Blended surfaces have no depth.
        if scene.is_transparent_in(&view) {
            return Ok(true);
        }
        let rendered = renderer.render(&mut self.targets, scene, &view)?;
        self.depth.copy(&rendered.depth, view.size)?;
        let far = view.depth.clear_value();
        Ok(self.depth.read().iter().any(|depth| *depth != far))
    }
}

/// Returns a distance that a person would choose, in metres, behind everything in the scene.
fn behind(scene: &GpuScene, view: &View) -> f32 {
    let (bounds, eye) = (scene.bounds(), view.pose.position);
    let farthest = (bounds.min - eye).abs().max((bounds.max - eye).abs()).length();
    let power = 10f32.powf(farthest.max(1e-3).log10().floor());
    [1.0, 2.0, 5.0, 10.0].map(|n| n * power).into_iter().find(|n| *n > farthest).unwrap_or(f32::INFINITY)
}
