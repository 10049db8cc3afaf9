//! Eyes of two levels, with what a composer makes of them in f64. Rows run from the bottom.

use glam::{Quat, Vec3};
use rand::{Rng, SeedableRng};

use yoro::eyes::{
    Composition, DepthConvention, DepthRange, Eye, EyePair, Foveation, Frustum, Gaze, GuardBand, Pose,
    StereoViews, ViewLayer,
};

/// The image of a level: a part of a larger one with noise around it.
pub struct LevelPicture {
    /// RGBA of the whole image.
    pub rgba: Vec<u8>,
    /// Lower left corner of the level, and its size.
    pub origin: [u32; 2],
    pub size: [u32; 2],
    /// Size of the whole image.
    pub image_size: [u32; 2],
}

impl LevelPicture {
    fn new(size: [u32; 2], margins: [[u32; 2]; 2], rng: &mut impl Rng) -> LevelPicture {
        let image_size = [0, 1].map(|i| margins[0][i] + size[i] + margins[1][i]);
        let rgba = (0..image_size[0] * image_size[1] * 4).map(|_| rng.random()).collect();
        LevelPicture { rgba, origin: margins[0], size, image_size }
    }

    /// Returns the upper left corner of the level, counted from the top.
    pub fn origin_from_top(&self) -> [u32; 2] {
        [self.origin[0], self.image_size[1] - self.origin[1] - self.size[1]]
    }

    /// Returns the colour at a place in pixels of the level, interpolated between the middles of its pixels.
    fn at(&self, place: [f64; 2]) -> [f64; 4] {
        let [[x, s], [y, t]] = [0, 1].map(|i| {
            let at = (place[i] - 0.5).clamp(0.0, f64::from(self.size[i] - 1));
            [at.floor(), at.fract()]
        });
        let texel = |x: f64, y: f64, c: usize| {
            let [x, y] = [x.min(f64::from(self.size[0] - 1)), y.min(f64::from(self.size[1] - 1))];
            let row = self.origin[1] as usize + y as usize;
            let column = self.origin[0] as usize + x as usize;
            f64::from(self.rgba[(row * self.image_size[0] as usize + column) * 4 + c])
        };
        std::array::from_fn(|c| {
            let row = |y: f64| texel(x, y, c) * (1.0 - s) + texel(x + 1.0, y, c) * s;
            row(y) * (1.0 - t) + row(y + 1.0) * t
        })
    }
}

/// An eye and its levels.
pub struct Case {
    pub name: String,
    pub levels: StereoViews,
    pub eye: Eye,
    pub wide: LevelPicture,
    pub inset: Option<LevelPicture>,
    /// Stored depth of the inset, in an image of the size of its colour's.
    pub depth: Option<Vec<f32>>,
}

impl Case {
    fn new(name: &str, levels: StereoViews, eye: Eye, with_depth: bool, seed: u64) -> Case {
        let mut rng = rand_pcg::Pcg32::seed_from_u64(seed);
        let margins = if seed.is_multiple_of(2) { [[3, 5], [4, 1]] } else { [[0; 2]; 2] };
        let wide = LevelPicture::new(levels.wide.eyes.size, margins, &mut rng);
        let inset = levels.inset.map(|level| LevelPicture::new(level.eyes.size, margins, &mut rng));
        let depth = inset.as_ref().filter(|_| with_depth).map(|inset| {
            // Rows of one distance each, from nearer to farther than where the inset is complete.
            let rows = 0..inset.image_size[1];
            let of_row = rows.map(|row| levels.shown.depth.depth(0.12 + 0.01 * row as f32));
            of_row.flat_map(|depth| vec![depth; inset.image_size[0] as usize]).collect()
        });
        Case { name: format!("{name}, {eye:?}"), levels, eye, wide, inset, depth }
    }

    pub fn composition(&self) -> Composition {
        self.levels.composition(self.eye)
    }

    /// Returns the share of the inset at a place in its pixels, from its borders and from where what it shows was
    /// rendered. `None` within rounding of the border of what was rendered.
    fn share(&self, level: &ViewLayer, picture: &LevelPicture, place: [f64; 2]) -> Option<f64> {
        let within = [0, 1].map(|i| {
            let inside = place[i].min(f64::from(picture.size[i]) - place[i]);
            match self.levels.fade[i] {
                fade if fade > 0.0 => inside / f64::from(fade),
                _ => {
                    if inside > 0.0 {
                        1.0
                    } else {
                        0.0
                    }
                }
            }
        });
        let share = within[0].min(within[1]).clamp(0.0, 1.0);
        let Some(depth) =
            self.depth.as_ref().filter(|_| share > 0.0 && self.eye != self.levels.shown.dominant)
        else {
            return Some(share);
        };
        let [x, y] = [0, 1].map(|i| picture.origin[i] as usize + place[i] as usize);
        let depth = f64::from(depth[y * picture.image_size[0] as usize + x]);
        let warp = level.synthesis_views(GuardBand::None).unwrap().warp;
        let from_border = place[0] - 0.5 - warp.law.displacement(depth) + 0.5;
        let inside = from_border.min(f64::from(warp.source_size[0]) - from_border);
        (inside.abs() > 0.01).then_some(if inside > 0.0 { share } else { 0.0 })
    }

    /// Returns the number of the inset's pixels that are holes at the border of what was rendered.
    pub fn border_holes(&self) -> usize {
        let Some((level, picture)) = self.levels.inset.as_ref().zip(self.inset.as_ref()) else { return 0 };
        let [width, height] = picture.size;
        let pixels = (0..width * height).map(|i| [f64::from(i % width) + 0.5, f64::from(i / width) + 0.5]);
        pixels.filter(|&at| self.share(level, picture, at) == Some(0.0)).count()
    }

    /// Returns the eye's colours, `None` where they depend on rounding.
    pub fn reference(&self) -> Vec<Option<[f64; 4]>> {
        let shown = &self.levels.shown;
        let frustum = &shown.frusta[self.eye.index()];
        let [width, height] = shown.size;
        let place = |level: &ViewLayer, size: [u32; 2], [x, y]: [u32; 2]| {
            let own = &level.eyes.frusta[self.eye.index()];
            let along = |pixel: u32, pixels: u32, [low, high, own_low, own_high]: [f32; 4], size: u32| {
                let [low, high, own_low, own_high] = [low, high, own_low, own_high].map(f64::from);
                let tangent = low + (f64::from(pixel) + 0.5) / f64::from(pixels) * (high - low);
                (tangent - own_low) / (own_high - own_low) * f64::from(size)
            };
            [
                along(x, width, [frustum.left, frustum.right, own.left, own.right], size[0]),
                along(y, height, [frustum.bottom, frustum.top, own.bottom, own.top], size[1]),
            ]
        };
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| [x, y]));
        let color = |pixel: [u32; 2]| {
            let wide = self.wide.at(place(&self.levels.wide, self.wide.size, pixel));
            let Some((level, picture)) = self.levels.inset.as_ref().zip(self.inset.as_ref()) else {
                return Some(wide);
            };
            let at = place(level, picture.size, pixel);
            let share = self.share(level, picture, at)?;
            let inset = if share > 0.0 { picture.at(at) } else { wide };
            Some(std::array::from_fn(|c| inset[c] * share + wide[c] * (1.0 - share)))
        };
        pixels.map(color).collect()
    }

    /// Checks what a composer has drawn.
    pub fn check(&self, rgba: &[u8], what: &str) {
        let reference = self.reference();
        assert_eq!(rgba.len(), reference.len() * 4);
        let decided = reference.iter().flatten().count();
        assert!(decided * 100 >= reference.len() * 99, "{what}, {}: {decided}", self.name);
        let width = self.levels.shown.size[0] as usize;
        for (i, want) in reference.into_iter().enumerate() {
            let (got, Some(want)) = (&rgba[i * 4..][..4], want) else { continue };
            // Filters have fractions of 8 bits, in two directions.
            let differs = got.iter().zip(want).any(|(got, want)| (f64::from(*got) - want).abs() > 2.6);
            assert!(!differs, "{what}, {}, ({}, {}): {got:?} for {want:?}", self.name, i % width, i / width);
        }
    }
}

/// Eyes with asymmetric frusta.
pub fn eyes(size: [u32; 2], dominant: Eye, convention: DepthConvention) -> EyePair {
    let depth = DepthRange { near: 0.1, far: 100.0, convention };
    let mut eyes =
        EyePair::parallel(Pose::IDENTITY, Frustum::symmetric(1.5, 1.0), 0.063, depth, size, dominant);
    eyes.frusta = [
        Frustum { left: -1.2, right: 0.9, bottom: -1.1, top: 1.0 },
        Frustum { left: -0.9, right: 1.2, bottom: -1.1, top: 1.0 },
    ];
    eyes
}

/// Returns eyes of one and of two levels, fixed and with a gaze, with hard seams and faded ones, whole and in parts of
/// larger images, with and without depth.
pub fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for (i, dominant) in Eye::BOTH.into_iter().enumerate() {
        let convention = [DepthConvention::Standard, DepthConvention::Reversed][i];
        let own = eyes([121, 110], dominant, convention);
        let mut shifted = own;
        let row = own.frusta[0].height() / 110.0;
        (shifted.frusta[0].bottom, shifted.frusta[0].top) = (-1.1 + 3.0 * row, 1.0 + 3.0 * row);
        let medium = Foveation::MEDIUM;
        let faded = Foveation { radius: 0.3, density: 0.3, fade: 0.08, ..medium };
        let aside = Quat::from_rotation_y(0.7) * Quat::from_rotation_x(-0.5) * Vec3::NEG_Z;
        for (name, eyes, foveation, gaze) in [
            ("one level", own, None, Gaze::Axes(own.axes())),
            ("fixed", own, Some(medium), Gaze::Axes(own.axes())),
            ("faded", own, Some(faded), Gaze::Axes(own.axes())),
            ("gaze at the border", own, Some(medium), Gaze::Direction(aside)),
            ("other rows", shifted, Some(faded), Gaze::Direction(aside)),
        ] {
            let levels = eyes.stereo_views(foveation.as_ref(), gaze).unwrap();
            for eye in Eye::BOTH {
                for with_depth in [false, true] {
                    let seed = cases.len() as u64 / 2 + u64::from(with_depth);
                    cases.push(Case::new(name, levels, eye, with_depth, seed));
                }
            }
        }
    }
    cases
}
