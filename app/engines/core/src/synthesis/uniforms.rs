//! The inputs of the passes: uniforms in OpenGL, one block in Vulkan.

use bytemuck::{Pod, Zeroable};
use glam::{IVec2, Vec2, Vec4};

use super::backend::{Places, UniformBlock, tiles};
use super::forward::ForwardLaw;
use crate::eyes::{MotionMap, PoseWarp, VectorsOf, Warp};

/// Columns and rows of a tile, as in `include/source.glsl`.
pub(super) const TILE: [u32; 2] = [16, 8];

macro_rules! uniforms {
    ($(#[doc = $about:literal])* $block:ident { $($(#[doc = $doc:literal])* $name:ident: $ty:ty = $glsl:literal,)* }) => {
        $(#[doc = $about])*
        #[repr(C)]
        #[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
        pub struct $block {
            $($(#[doc = $doc])* pub $name: $ty,)*
        }

        impl $block {
            /// Name, GLSL type and offset in bytes of each member.
            pub const LAYOUT: &[(&str, &str, usize)] =
                &[$((stringify!($name), $glsl, std::mem::offset_of!($block, $name)),)*];

            /// Sets the uniforms that the program has. The program must be current.
            #[cfg(feature = "gl")]
            pub fn set(&self, program: &yoro_gl::Program) {
                $(program.set(stringify!($name), self.$name);)*
            }
        }

        impl UniformBlock for $block {
            #[cfg(feature = "gl")]
            fn set(&self, program: &yoro_gl::Program) {
                $block::set(self, program);
            }
        }
    };
}

uniforms! {
    /// All uniforms of the synthesis passes for parallel eyes except textures, with the layout of a std140 block:
    /// `include/uniforms.glsl` of `yoro-shaders`. "Forward" columns are counted from the left for a synthesized
    /// left eye and from the right for a right eye. Rows are counted from row 0: from the bottom in OpenGL, from
    /// the top in Vulkan.
    Uniforms {
        /// Size of the source in pixels.
        source_size: IVec2 = "ivec2",
        /// Size of the target in pixels.
        target_size: IVec2 = "ivec2",
        /// Displacement in pixels, in forward columns: `law.x + law.y * depth`.
        law: Vec2 = "vec2",
        /// 1 if forward columns are counted from the right.
        mirrored: u32 = "bool",
        /// Target row minus source row.
        row_offset: i32 = "int",
        /// Corner of the target in its framebuffer or image.
        target_origin: IVec2 = "ivec2",
        /// Displacement of the far plane in pixels.
        far_displacement: f32 = "float",
        /// Displacement of the near plane in pixels.
        near_displacement: f32 = "float",
        /// Texture coordinate of the source at forward column x: `columns.x * x + columns.y`.
        columns: Vec2 = "vec2",
        /// Source column that the displacement's offset alone moves to a fragment:
        /// `origins.x * gl_FragCoord.x + origins.y`.
        origins: Vec2 = "vec2",
        /// Place of a fragment's span in the span map: `span_place.xy * gl_FragCoord.xy + span_place.zw`. A texture
        /// coordinate, or a number of tiles if the source is a part of its image.
        span_place: Vec4 = "vec4",
        /// Texture coordinate of a fragment's source row: `rows.x * gl_FragCoord.y + rows.y`.
        rows: Vec2 = "vec2",
        /// Centre of a fragment's source row: `gl_FragCoord.y - first_row`.
        first_row: f32 = "float",
        /// Displacement of the far plane beyond the law's offset, in pixels, plus a hundredth of a pixel for rounding.
        farthest: f32 = "float",
        /// Corner of the source in its image, if the source is a part of it.
        source_origin: IVec2 = "ivec2",
        /// One pixel of the source's image in texture coordinates, if the source is a part of it.
        texel: Vec2 = "vec2",
        /// For motion vectors: x of the target per unit of the vector's z and of stored depth, x that is added, and 1 if
        /// the vectors are those of the whole source (0 if of the dominant eye).
        motion: Vec4 = "vec4",
    }
}

uniforms! {
    /// All uniforms of the passes for any view except textures, with the layout of a std140 block:
    /// `include/any_view.glsl` of `yoro-shaders`. Rows are counted from row 0, as in [`Uniforms`].
    PoseUniforms {
        /// Size of the source in pixels.
        source_size: IVec2 = "ivec2",
        /// Corner of the target in its framebuffer or image.
        target_origin: IVec2 = "ivec2",
        /// First row of the homography from target to source, and first component of the epipole ([`PoseWarp`]).
        to_source_x: Vec4 = "vec4",
        /// Second row of the homography, and second component of the epipole.
        to_source_y: Vec4 = "vec4",
        /// Third row of the homography, and third component of the epipole.
        to_source_w: Vec4 = "vec4",
        /// The source's `1 / distance = source_law.x + source_law.y * depth`.
        source_law: Vec2 = "vec2",
        /// The same for the target.
        target_law: Vec2 = "vec2",
        /// Stored depth, in the source, of the nearest surface that the target may show.
        nearest: f32 = "float",
        /// Stored depth of the source's far plane.
        far_depth: f32 = "float",
        /// Corner of the source in its image.
        source_origin: IVec2 = "ivec2",
        /// One pixel of the source's image in texture coordinates.
        texel: Vec2 = "vec2",
        /// Unused: blocks have a size of a multiple of 16 bytes.
        padding: Vec2 = "vec2",
    }
}

uniforms! {
    /// All uniforms of the composer except textures, with the layout of a std140 block: `include/levels.glsl` of
    /// `yoro-shaders`. Places are from 0 to 1 from the side of row 0, as in [`Uniforms`].
    LevelUniforms {
        /// Place in the eye's image of a fragment of the composer's pass: `eye_place.xy * gl_FragCoord.xy + eye_place.zw`.
        eye_place: Vec4 = "vec4",
        /// Texture coordinates of the wide view at a place in the eye's image.
        wide_place: Vec4 = "vec4",
        /// Texture coordinates of the middles of the wide view's first and last pixel.
        wide_bounds: Vec4 = "vec4",
        /// Place in the inset at a place in the eye's image.
        inset_place: Vec4 = "vec4",
        /// Texture coordinates of the inset at one of its places.
        inset_part: Vec4 = "vec4",
        /// Texture coordinates of the middles of the inset's first and last pixel.
        inset_bounds: Vec4 = "vec4",
        /// The numbers of [`InsetPlace::source`](crate::eyes::InsetPlace::source), which are 0 without the inset's
        /// depth, and an unused one.
        inset_source: Vec4 = "vec4",
        /// The inverse of the place at which the inset is fully seen.
        inset_ramp: Vec2 = "vec2",
        /// Unused: blocks have a size of a multiple of 16 bytes.
        padding: Vec2 = "vec2",
    }
}

fn size(size: [u32; 2]) -> IVec2 {
    IVec2::from(size.map(|n| n as i32))
}

fn pair(x: f64, y: f64) -> Vec2 {
    Vec2::new(x as f32, y as f32)
}

impl Uniforms {
    /// Returns the uniforms for a source that fills its textures, and maps of the [`Warp`]'s size.
    pub fn new(warp: &Warp, target_origin: [u32; 2]) -> Uniforms {
        let places =
            Places { source_origin: [0, 0], image_size: warp.source_size, target_origin, part: false };
        Uniforms::of_part(warp, &places)
    }

    /// Returns the uniforms for these places. Columns and rows are affine in `gl_FragCoord`. Their factors are computed
    /// here rather than in each fragment, and in f64, since they are differences of large numbers.
    pub fn of_part(warp: &Warp, places: &Places) -> Uniforms {
        let law = ForwardLaw::new(warp);
        let [image_width, image_height] = places.image_size.map(f64::from);
        let [source_left, source_row] = places.source_origin.map(f64::from);
        let [left, row] = places.target_origin.map(f64::from);
        let source_right = source_left + f64::from(warp.source_size[0]);
        let columns = if law.mirrored {
            pair(-1.0 / image_width, source_right / image_width)
        } else {
            pair(1.0 / image_width, source_left / image_width)
        };
        // Forward target column: sense * x + first.
        let (sense, first) = if law.mirrored {
            (-1.0, f64::from(warp.target_size[0]) + left - 0.5)
        } else {
            (1.0, -left - 0.5)
        };
        let first_row = row + f64::from(warp.row_offset);
        // Maps consist of whole tiles, so they may extend beyond the image.
        let [across, up] = if places.part {
            TILE.map(f64::from)
        } else {
            let tiles = tiles([warp.target_size[0], warp.source_size[1]]);
            [0, 1].map(|i| f64::from(tiles[i] * TILE[i]))
        };
        let span_place = [sense / across, 1.0 / up, (first + 0.5) / across, -first_row / up];
        Uniforms {
            source_size: size(warp.source_size),
            target_size: size(warp.target_size),
            law: pair(law.offset, law.scale),
            mirrored: law.mirrored.into(),
            row_offset: warp.row_offset,
            target_origin: size(places.target_origin),
            far_displacement: law.far as f32,
            near_displacement: law.near as f32,
            columns,
            origins: pair(sense, first - law.offset),
            span_place: Vec4::from(span_place.map(|n| n as f32)),
            rows: pair(1.0 / image_height, (source_row - first_row) / image_height),
            first_row: first_row as f32,
            farthest: (law.far - law.offset + 0.01) as f32,
            source_origin: size(places.source_origin),
            texel: pair(1.0 / image_width, 1.0 / image_height),
            motion: Vec4::ZERO,
        }
    }

    /// Returns the uniforms with the law of motion vectors.
    pub(super) fn with_motion(self, law: &MotionMap) -> Uniforms {
        let of_source = f64::from(u8::from(law.of == VectorsOf::Source));
        let motion = [law.per_z, law.per_depth, law.constant, of_source].map(|n| n as f32);
        Uniforms { motion: Vec4::from(motion), ..self }
    }
}

impl PoseUniforms {
    /// Returns the uniforms for these places.
    pub fn new(warp: &PoseWarp, places: &Places) -> PoseUniforms {
        let row = |i: usize| warp.homography.row(i).extend(warp.epipole[i]).as_vec4();
        let [image_width, image_height] = places.image_size.map(f64::from);
        let law = |[c, m]: [f64; 2]| pair(c, m);
        PoseUniforms {
            source_size: size(warp.source_size),
            target_origin: size(places.target_origin),
            to_source_x: row(0),
            to_source_y: row(1),
            to_source_w: row(2),
            source_law: law(warp.source_law),
            target_law: law(warp.target_law),
            nearest: warp.nearest as f32,
            far_depth: warp.far_depth as f32,
            source_origin: size(places.source_origin),
            texel: pair(1.0 / image_width, 1.0 / image_height),
            padding: Vec2::ZERO,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the alignment and size of a type in std140 (OpenGL ES 3.2, section 7.6.2.2).
    fn std140(glsl: &str) -> [usize; 2] {
        match glsl {
            "bool" | "int" | "float" => [4, 4],
            "ivec2" | "vec2" => [8, 8],
            "vec4" => [16, 16],
            _ => panic!("no rule for {glsl}"),
        }
    }

    /// A uniform block: the file that declares it, its layout and its size.
    type Block = (&'static str, &'static [(&'static str, &'static str, usize)], usize);

    const BLOCKS: [Block; 3] = [
        ("include/uniforms.glsl", Uniforms::LAYOUT, size_of::<Uniforms>()),
        ("include/any_view.glsl", PoseUniforms::LAYOUT, size_of::<PoseUniforms>()),
        ("include/levels.glsl", LevelUniforms::LAYOUT, size_of::<LevelUniforms>()),
    ];

    /// Returns the type and name of each member of a block in the shader's text.
    fn declared(file: &str) -> Vec<(String, String)> {
        let text = yoro_shaders::assemble(file, "310 es", &[]).unwrap().text;
        let members = text.lines().filter_map(|line| line.strip_prefix("UNIFORM ")?.strip_suffix(';'));
        members.map(|member| member.split_once(' ').unwrap()).map(|(a, b)| (a.into(), b.into())).collect()
    }

    #[test]
    fn the_layout_is_std140() {
        for (file, layout, bytes) in BLOCKS {
            let mut end: usize = 0;
            let mut expected = Vec::new();
            for (glsl, name) in declared(file) {
                let [alignment, size] = std140(&glsl);
                let offset = end.next_multiple_of(alignment);
                end = offset + size;
                expected.push((name, glsl, offset));
            }
            let members = layout.iter().filter(|(name, ..)| *name != "padding");
            let members: Vec<_> = members.map(|&(n, t, o)| (n.to_owned(), t.to_owned(), o)).collect();
            assert_eq!(members, expected, "{file}");
            assert_eq!(bytes, end.next_multiple_of(16), "{file}");
            assert!(bytes <= 128, "every Vulkan device has 128 bytes of push constants, some no more");
        }
    }
}
