//! The role of a view in its frame: where its pixels lie, which of them are lit, and what the others show.

use glam::{IVec2, Vec2};

use super::g_buffer::Layout;
use super::scene::FREE_UNIT;
use yoro::eyes::{DisparityLaw, Eye, View};
use yoro_gl::{Program, Texture};

/// First texture unit for the textures that a role reads: after g-buffer, occlusion and shadow map.
const ROLE_UNIT: u32 = FREE_UNIT + 2;

/// A kind of [`Role`]: a shader variant of ambient occlusion and lighting.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RoleKind {
    Whole,
    Half,
    Layer,
    NearField,
    FarField,
    Reprojected,
}

impl RoleKind {
    /// Number of kinds.
    pub const COUNT: usize = 6;

    /// Returns the index among the kinds.
    pub fn index(self) -> usize {
        self as usize
    }

    /// Returns the define of `include/g_buffer.glsl` and `include/role.glsl`.
    pub fn define(self) -> Option<(&'static str, String)> {
        let name = match self {
            RoleKind::Whole => return None,
            RoleKind::Half => "HALF",
            RoleKind::Layer => "LAYER",
            RoleKind::NearField => "NEAR_FIELD",
            RoleKind::FarField => "FAR_FIELD",
            RoleKind::Reprojected => "REPROJECTED",
        };
        Some((name, String::new()))
    }
}

/// The role of a view in its frame.
#[derive(Clone, Copy)]
pub enum Role<'a> {
    /// A view by itself: drawn pixels are lit, the others show the sky.
    Whole,
    /// Like `Whole`, but in a part of the g-buffer with this lower left corner.
    Half([u32; 2]),
    /// Like `Whole`, but in this layer of the g-buffer.
    Layer(u32),
    /// Pixels where nothing is drawn show the far field.
    NearField {
        /// Scene-referred colour of the far field.
        far: &'a Texture,
        /// Pixel of the far field that corresponds to the view's lower left pixel.
        crop: IVec2,
    },
    /// Pixels with the near plane's depth are hidden and stay black.
    FarField,
    /// Pixels that the dominant eye also sees take its colour.
    Reprojected(Reprojection<'a>),
}

/// How the second eye's pixels map to those of the dominant eye.
#[derive(Clone, Copy)]
pub struct Reprojection<'a> {
    /// Scene-referred colour of the dominant eye, filtered linearly.
    pub color: &'a Texture,
    /// The output of `stereo/disocclusion.frag`.
    pub disocclusion: &'a Texture,
    /// Maps a column of the dominant eye to that of the second.
    pub law: DisparityLaw,
    /// Row of the second eye minus that of the dominant.
    pub row_offset: i32,
}

impl Reprojection<'_> {
    /// Sets the uniforms of `include/reprojection.glsl`.
    pub fn set_law(&self, program: &Program) {
        program
            .set("law", Vec2::new(self.law.offset as f32, self.law.scale as f32))
            .set("row_offset", self.row_offset);
    }
}

impl Role<'_> {
    /// Returns the role of an eye in a g-buffer of this layout.
    pub fn of_eye(layout: Layout, size: [u32; 2], eye: Eye) -> Role<'static> {
        match layout {
            Layout::Single => Role::Whole,
            Layout::DoubleWide(_) => Role::Half(layout.origin(size, eye)),
            Layout::Layered => Role::Layer(eye.index() as u32),
        }
    }

    /// Returns its kind.
    pub fn kind(&self) -> RoleKind {
        match self {
            Role::Whole => RoleKind::Whole,
            Role::Half(_) => RoleKind::Half,
            Role::Layer(_) => RoleKind::Layer,
            Role::NearField { .. } => RoleKind::NearField,
            Role::FarField => RoleKind::FarField,
            Role::Reprojected(_) => RoleKind::Reprojected,
        }
    }

    /// Sets the uniforms and textures of `include/g_buffer.glsl` and `include/role.glsl`.
    pub fn set(&self, program: &Program, view: &View) {
        let vector = |v: [u32; 2]| IVec2::from(v.map(|n| n as i32));
        match *self {
            Role::Whole | Role::FarField => {}
            Role::Half(origin) => {
                program.set("view_origin", vector(origin)).set("view_size", vector(view.size));
            }
            Role::Layer(layer) => {
                program.set("view_layer", layer as i32);
            }
            Role::NearField { far, crop } => {
                program.texture_of("far_field", ROLE_UNIT, far).set("far_field_crop", crop);
            }
            Role::Reprojected(reprojection) => {
                program.texture_of("dominant_color", ROLE_UNIT, reprojection.color).texture_of(
                    "disocclusion",
                    ROLE_UNIT + 1,
                    reprojection.disocclusion,
                );
                reprojection.set_law(program);
            }
        }
    }
}
