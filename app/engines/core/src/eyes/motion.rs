//! Motion vectors of one eye, from those of the other: what runtimes that make frames ask for beside colour and depth.

use super::{EyesError, SynthesisViews, Warp};

/// The depth of normalized device coordinates (NDC). X and Y run from -1 to 1; Y may point up or down.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ndc {
    /// 0 to 1, as in Vulkan, wgpu and Direct3D, and as OpenXR asks of all applications.
    ZeroToOne,
    /// -1 to 1, as in OpenGL.
    MinusOneToOne,
}

/// The image in whose normalized device coordinates vectors are given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VectorsOf {
    /// The rendered view, with its guard band: what an engine writes with the view's own projection. The dominant eye's
    /// own vectors then need [`SynthesisViews::motion_scale`].
    Source,
    /// The dominant eye, without the guard band: its own vectors are a crop of the image.
    Eye,
}

/// How vectors are given. A vector is the place of a surface minus its place in the previous frame, both in NDC, each with
/// the view of its own frame: a head's motion is in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct VectorSpace {
    /// The meaning of the third component.
    pub ndc: Ndc,
    /// The image that X and Y refer to.
    pub of: VectorsOf,
}

/// The vector of a surface in a synthesized eye, from its vector `v` and stored depth `d` in the source:
/// `(scale · v.x + per_z · v.z + per_depth · d + constant, scale_y · v.y, v.z)`.
///
/// Between parallel eyes, NDC x of the other eye is `a · x + o + s · z`. So a surface that comes nearer moves sideways
/// there (`per_z = s`), and all other terms are those by which frusta and the distance of the eyes changed between the
/// frames.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionMap {
    /// X per unit of the vector's z.
    pub per_z: f64,
    /// X per unit of stored depth; 0 unless the eyes' distance, focal length or depth planes changed.
    pub per_depth: f64,
    /// X that is added to all; 0 unless the eyes' frusta moved against each other.
    pub constant: f64,
    /// The image that the source's vectors refer to.
    pub of: VectorsOf,
}

/// How motion vectors of an eye are made: a [`Warp`] between images of the vectors' size, and what happens to vectors on
/// the way. `opengl::Motion`, `vulkan::Motion` and `yoro_wgpu::Motion` draw it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionWarp {
    /// From the source's image to the eye's.
    pub warp: Warp,
    /// From the source's vectors to the eye's.
    pub law: MotionMap,
}

impl MotionWarp {
    /// Returns the vector in the eye of a surface with this vector and stored depth in the source, in f64.
    pub fn vector(&self, [x, y, z]: [f64; 3], depth: f64) -> [f64; 3] {
        let scale = |i: usize| match self.law.of {
            VectorsOf::Eye => 1.0,
            VectorsOf::Source => f64::from(self.warp.source_size[i]) / f64::from(self.warp.target_size[i]),
        };
        let MotionMap { per_z, per_depth, constant, .. } = self.law;
        [scale(0) * x + per_z * z + per_depth * depth + constant, scale(1) * y, z]
    }
}

/// NDC x of an eye as `x + constant + per_depth * depth`, with the x of the image that vectors refer to.
struct Place {
    constant: f64,
    per_depth: f64,
    /// Rows from the dominant eye's image to this eye's, as a part of the height.
    rows: f64,
    /// Width of the source, of the eye's.
    width: f64,
}

impl Place {
    fn new(views: &SynthesisViews, warp: &Warp, of: VectorsOf) -> Place {
        let [width, height] = warp.target_size.map(f64::from);
        let crop = views.dominant_crop.map(f64::from);
        let wide = f64::from(warp.source_size[0]) / width;
        Place {
            constant: match of {
                VectorsOf::Eye => 2.0 * (crop[0] + warp.law.offset) / width,
                VectorsOf::Source => wide - 1.0 + 2.0 * warp.law.offset / width,
            },
            per_depth: 2.0 * warp.law.scale / width,
            rows: (crop[1] + f64::from(warp.row_offset)) / height,
            width: wide,
        }
    }
}

/// The largest change between two frames, in pixels, that is rounding.
const ROUNDING: f64 = 0.05;

impl SynthesisViews {
    /// Returns how vectors of the rendered view become those of the synthesized eye. Make `self` and `previous`, the views
    /// of the frame that vectors point to, of [`EyePair`](super::EyePair)s whose size is that of an eye's vectors, which
    /// runtimes recommend. Eyes' distance, frusta and depth planes may have changed between the frames.
    ///
    /// # Errors
    /// [`EyesError::OtherFrame`] if the frames have no law in common: mark the frame as not to be extrapolated.
    pub fn motion(&self, previous: &SynthesisViews, vectors: VectorSpace) -> Result<MotionWarp, EyesError> {
        self.motion_of(&self.warp, previous, &previous.warp, vectors)
    }

    /// Returns how vectors of the rendered view become the dominant eye's own, for hosts that can neither show a crop of an
    /// image nor scale vectors.
    ///
    /// # Errors
    /// Those of [`SynthesisViews::motion`].
    pub fn own_motion(
        &self,
        previous: &SynthesisViews,
        vectors: VectorSpace,
    ) -> Result<MotionWarp, EyesError> {
        self.motion_of(&self.own_warp(), previous, &previous.own_warp(), vectors)
    }

    /// Returns the factors on X and Y that make the source's vectors the dominant eye's own: with the guard band, a pixel
    /// is a smaller part of the view. For XR_EXT_frame_synthesis they are those of `motionVectorScale`.
    pub fn motion_scale(&self) -> [f32; 2] {
        [0, 1].map(|i| self.source.size[i] as f32 / self.target.size[i] as f32)
    }

    /// Returns the warp to the dominant eye's own image.
    fn own_warp(&self) -> Warp {
        let [x, y] = self.dominant_crop;
        let law = super::DisparityMap { offset: -f64::from(x), scale: 0.0 };
        Warp { law, row_offset: -(y as i32), ..self.warp }
    }

    fn motion_of(
        &self,
        warp: &Warp,
        previous_views: &SynthesisViews,
        previous: &Warp,
        VectorSpace { ndc, of }: VectorSpace,
    ) -> Result<MotionWarp, EyesError> {
        let (now, then) = (Place::new(self, warp, of), Place::new(previous_views, previous, of));
        let [width, height] = warp.target_size.map(f64::from);
        let other = |what| Err(EyesError::OtherFrame { what });
        if previous.target_eye != warp.target_eye {
            return other("the rendered eye");
        }
        if (now.rows - then.rows).abs() * height > ROUNDING {
            return other("the rows of one eye against the other's");
        }
        if of == VectorsOf::Source && (now.width - then.width).abs() * width > ROUNDING {
            return other("the width of the guard band");
        }
        let per_unit = match ndc {
            Ndc::ZeroToOne => 1.0,
            Ndc::MinusOneToOne => 2.0,
        };
        let law = MotionMap {
            per_z: then.per_depth / per_unit,
            per_depth: now.per_depth - then.per_depth,
            constant: now.constant - then.constant,
            of,
        };
        Ok(MotionWarp { warp: *warp, law })
    }
}
