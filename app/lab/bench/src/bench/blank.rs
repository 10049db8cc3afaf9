//! Finding views that show nothing to measure.

use std::rc::Rc;

use anyhow::ensure;

use yoro::eyes::EyePair;
use yoro_gl::{Context, GlError};
use yoro_render::{DepthReader, PreparedScene, Selection, ViewTargets};

/// The longest edge in pixels of the image that is examined. Whatever is smaller on the screen is negligible.
const EDGE: u32 = 256;

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
    /// One sentence with the remedy; [`GlError`] if the driver has no memory for the targets.
    pub fn refuse_blank<'v>(
        &mut self,
        prepared: &mut PreparedScene,
        views: impl IntoIterator<Item = (String, &'v EyePair)>,
    ) -> anyhow::Result<()> {
        for (name, pair) in views {
            ensure!(
                !self.is_blank(prepared, pair)?,
                "{name} of {0} shows nothing, so there is nothing to measure: write viewpoints that show the model into {0}.camera.json beside it",
                prepared.scene.name
            );
        }
        Ok(())
    }

    /// True if the dominant eye sees no surface. Transparent surfaces do not count: they have no depth, so that
    /// synthesis does nothing for them.
    ///
    /// # Errors
    /// [`GlError`] when the driver has no memory for the targets.
    pub fn is_blank(&mut self, prepared: &mut PreparedScene, pair: &EyePair) -> Result<bool, GlError> {
        let mut view = pair.view(pair.dominant);
        let longest = view.size[0].max(view.size[1]);
        if longest > EDGE {
            view.size = view.size.map(|n| (n * EDGE / longest).max(1));
        }
        let PreparedScene { renderer, scene } = prepared;
        let rendered = renderer.render(&mut self.targets, scene, &view, Selection::All)?;
        self.depth.copy(&rendered.depth, view.size)?;
        let far = view.depth.clear_value();
        Ok(self.depth.read().iter().all(|depth| *depth == far))
    }
}
