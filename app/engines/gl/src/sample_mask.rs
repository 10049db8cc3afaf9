//! Masks of samples, which glow does not wrap.

use glow::HasContext;

use crate::Context;

/// glSampleMaski.
pub(crate) type SetMask = unsafe extern "system" fn(word: u32, mask: u32);
/// glGetMultisamplefv.
pub(crate) type GetSample = unsafe extern "system" fn(name: u32, index: u32, place: *mut f32);

/// The entry points, both of which a driver with sample masks has.
#[derive(Clone, Copy)]
pub(crate) struct SampleMasks {
    pub set_mask: SetMask,
    pub get_sample: GetSample,
}

/// GL_SAMPLE_POSITION, which is not in glow.
const SAMPLE_POSITION: u32 = 0x8E50;

impl Context {
    /// Limits the following draws to the samples whose bits are set; `None` draws into all. Does nothing without
    /// [`crate::Capabilities::sample_masks`]. Set `None` afterwards.
    pub fn mask_samples(&self, mask: Option<u32>) {
        let Some(masks) = &self.sample_masks else { return };
        // SAFETY: the entry point of OpenGL ES 3.1, and an enum of the same version.
        unsafe {
            match mask {
                Some(mask) => {
                    self.raw().enable(glow::SAMPLE_MASK);
                    (masks.set_mask)(0, mask);
                }
                None => self.raw().disable(glow::SAMPLE_MASK),
            }
        }
    }

    /// Returns the indices of the leftmost and the rightmost of the bound framebuffer's `samples` samples.
    pub fn outermost_samples(&self, samples: u32) -> [u32; 2] {
        let Some(masks) = &self.sample_masks else { return [0, samples.saturating_sub(1)] };
        let place = |i: u32| {
            let mut place = [0.5; 2];
            // SAFETY: GL writes two floats, or nothing for an index that the framebuffer does not have.
            unsafe { (masks.get_sample)(SAMPLE_POSITION, i, place.as_mut_ptr()) };
            place[0]
        };
        let by_column = |a: &u32, b: &u32| place(*a).total_cmp(&place(*b));
        [(0..samples).min_by(by_column).unwrap_or(0), (0..samples).max_by(by_column).unwrap_or(0)]
    }
}
