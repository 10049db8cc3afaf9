//! A phone behind the lenses of a Cardboard-compatible viewer, and panels of text and tiles in front of both eyes.
//!
//! From a viewer's parameters and a screen's size this crate computes the eyes' frusta and the mesh that undoes the
//! lenses' distortion, and draws both eyes through that mesh. It reads the parameters also from a picture of the
//! viewer's QR code. From motion samples it computes the head's orientation.
//!
//! This crate must never know a renderer, a scene, settings, or where a GL context comes from. It builds for phones and
//! browsers alike.

mod board;
mod head;
mod hud;
mod lens;
mod optics;
mod params;
mod qr;
mod text;

pub use board::{
    Board, HEADING_COLUMNS, PICTURE_COLUMNS, ROW, TILE_COLUMNS, Tiles, board_hit, board_metres, board_pose,
    flat_hit, tile_at,
};
pub use head::{HeadTracker, MotionSample, neck_offset};
pub use hud::{COLUMNS, Content, Hud, Panel, Placement};
pub use lens::LensPass;
pub use optics::{Optics, Rotation, Screen};
pub use params::{ParamsError, VerticalAlignment, ViewerParams};
pub use qr::{read_qr, read_qr_in_luma};
