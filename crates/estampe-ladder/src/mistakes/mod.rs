//! Where the course is mistaken, as pictures: what its formula draws, and what is right.
//!
//! The page `docs/mistakes.md` shows them with the formulas. The mistakes come first in each
//! picture, on the left or above, and the right version last.

mod clipping;
mod depth;
mod lines;
mod shading;
mod texture;
mod transforms;

use crate::{Course, LadderError, Picture};

/// A mistake with its picture.
#[derive(Debug, Clone, Copy)]
pub struct Mistake {
    /// The name of its picture, without an extension.
    pub name: &'static str,
    /// Draws its picture.
    pub draw: fn(&Course) -> Result<Picture, LadderError>,
}

/// All mistakes that a picture can show, in the order of the page.
pub const MISTAKES: &[Mistake] = &[
    Mistake {
        name: "bresenham_steps_first",
        draw: lines::stepping_first,
    },
    Mistake {
        name: "ties",
        draw: lines::ties,
    },
    Mistake {
        name: "look_at",
        draw: transforms::look_at,
    },
    Mistake {
        name: "horizontal_angle",
        draw: transforms::horizontal_angle,
    },
    Mistake {
        name: "window_z",
        draw: depth::window_z,
    },
    Mistake {
        name: "normals",
        draw: transforms::normals,
    },
    Mistake {
        name: "clip_loop",
        draw: clipping::clip_loop,
    },
    Mistake {
        name: "toon",
        draw: shading::toon,
    },
    Mistake {
        name: "face_normal",
        draw: shading::face_normal,
    },
    Mistake {
        name: "texel",
        draw: texture::texel,
    },
    Mistake {
        name: "depth_precision",
        draw: depth::precision,
    },
];
