//! Two renders in place of a method that cannot use a pair of eyes.

use super::method::StereoMethod;
use yoro::eyes::{EyePair, EyesError, GuardBand};
use yoro_gl::GlError;
use yoro_settings::Method;

/// Renders both eyes if neither can be synthesized from the other, as with canted eyes. Compiled when first needed.
#[derive(Default)]
pub struct Substitute(Option<Box<dyn StereoMethod>>);

impl Substitute {
    /// Returns the reason why a method cannot use a pair of eyes, or `None` if it can.
    pub fn reason(method: Method, pair: &EyePair) -> Option<EyesError> {
        if method.needs_aligned_eyes() { pair.synthesis_views(GuardBand::None).err() } else { None }
    }

    /// Returns the substitute, which `create` makes on the first call.
    ///
    /// # Errors
    /// Those of `create`.
    pub fn get(
        &mut self,
        create: impl FnOnce(Method) -> Result<Box<dyn StereoMethod>, GlError>,
    ) -> Result<&mut dyn StereoMethod, GlError> {
        let made = match self.0.take() {
            Some(made) => made,
            None => create(Method::Conventional)?,
        };
        Ok(self.0.insert(made).as_mut())
    }
}
