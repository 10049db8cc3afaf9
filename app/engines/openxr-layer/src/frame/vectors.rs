//! Motion vectors of both eyes, made of those of one rendered view.

use std::sync::Arc;
use std::time::Duration;

use openxr_sys as sys;
use yoro::eyes::MotionWarp;

use super::chain::sub_image;
use super::level::{COLOR, DEPTH};
use super::output::Output;
use super::synthesized::Images;
use super::target::Acquired;
use super::{Source, submitted_images};
use crate::binding::Binding;
use crate::geometry::{Rectangle, Split};
use crate::motion::{MotionInfo, MotionSplit, Place, Scaling};
use crate::reason::Reason;
use crate::session::Session;
use crate::swapchain::Swapchain;
use crate::synthesizer::Job;

/// What is kept from frame to frame for the vectors of one of the application's rendered views.
#[derive(Default)]
pub struct Vectors {
    /// The dominant eye's, if it needs its own, and the other eye's.
    pub outputs: [Output<MotionWarp>; 2],
    /// The place in the last synthesized frame, if it had vectors.
    pub former: Option<Place>,
    /// True if the runtime gets no more.
    pub are_refused: bool,
}

/// The vectors of both eyes, which the targets still hold.
#[derive(Clone, Copy)]
pub struct EyeVectors {
    /// The application's images that they were made of.
    images: Images,
    /// Images of vectors and depth, and their scaling, by [`Eye::index`](yoro::eyes::Eye::index).
    eyes: [([sys::SwapchainSubImage; 2], Scaling); 2],
}

impl EyeVectors {
    /// Returns the structures of both eyes for the application's, if that has the images that these were made of.
    pub fn infos(&self, swapchains: &[Arc<Swapchain>], info: &MotionInfo) -> Option<[MotionInfo; 2]> {
        let same = self.images == Images::new(swapchains, info.images());
        same.then(|| self.eyes.map(|(images, scaling)| info.with(images, &scaling)))
    }
}

impl Vectors {
    /// Makes the vectors of both eyes. Returns them, and the GPU time of an earlier frame once it is known.
    ///
    /// # Safety
    /// The structure belongs to a view of a call of xrEndFrame, which was split so. `source` is its colour.
    pub unsafe fn make(
        &mut self,
        session: &Session,
        binding: Binding,
        swapchains: &[Arc<Swapchain>],
        info: &MotionInfo,
        (source, split): (&Source, &Split),
    ) -> Result<(EyeVectors, Option<Duration>), Reason> {
        let former = self.former.take();
        let whats = ["the image of motion vectors", "the depth of motion vectors"];
        let (contents, images, part) = submitted_images(swapchains, info.images(), whats)?;
        info.check(contents[COLOR].format)?;
        let from_top = binding.rows_from_top();
        let motion = MotionSplit::new(info, split, source.part.size, part.size, !from_top, former)?;
        self.former = Some(motion.place);
        let crop = part.part(motion.crop, from_top);
        let own_crop = info.images().map(|image| sub_image(image.swapchain, crop, image.image_array_index));

        let (mut made, mut time) = ([own_crop; 2], Some(Duration::ZERO));
        let is_scaled = matches!(info, MotionInfo::FrameSynthesis(_));
        for (which, output) in self.outputs.iter_mut().enumerate().skip(usize::from(is_scaled)) {
            output.synthesizer(binding)?;
            for kind in [COLOR, DEPTH] {
                output.fit(session, &binding, kind, contents[kind])?;
            }
            let acquired @ (vectors, depth) = output.acquire(session, true)?;
            let job = Job {
                color: images[COLOR],
                depth: images[DEPTH],
                source: part,
                warp: &motion.warps[which],
                target: vectors.image,
                target_depth: depth.map(|depth| depth.image),
            };
            // SAFETY: as in `Level::synthesize`.
            let result = unsafe { output.synthesizer(binding)?.synthesize(&job) };
            output.release(session, acquired)?;
            time = time.zip(result?).map(|(time, more)| time + more);
            let whole = Rectangle { origin: [0; 2], size: motion.crop.size };
            let target = |acquired: Acquired| sub_image(acquired.swapchain, whole, 0);
            made[which] = [target(vectors), depth.map_or(own_crop[DEPTH], target)];
        }
        let mut eyes = [(made[1], motion.scalings[1]); 2];
        eyes[session.instance.settings.dominant.index()] = (made[0], motion.scalings[0]);
        Ok((EyeVectors { images: Images::new(swapchains, info.images()), eyes }, time))
    }
}
