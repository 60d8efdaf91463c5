//! Loads that stress one stage each, through the public API: the cost of a vertex, of a triangle by
//! its size, of a fragment by the operations on it, and of a texture's change of role.
//!
//! Triangles are grids of square cells, two triangles each, that fill the frame. Cells of a third
//! of a pixel are mostly culled before binning; cells of 64 pixels cost mostly rasterization. The
//! statistics of a pass separate geometry from tiles.
//!
//! A texture that was rendered to is converted from tiles to rows when it is sampled, and back when
//! it is written and rendered to again: [`conversions`] compares both with memcpy.

pub mod conversions;
mod grid;
mod layers;
mod loads;
mod table;

pub use loads::{Load, loads};
pub use table::{HEADER, line};

use crate::frame::FrameSize;

/// The frame size of the loads.
pub const SIZE: FrameSize = FrameSize {
    width: 1280,
    height: 720,
};
