//! The rungs, in order. Each module is the file of an example.

#![expect(dead_code, reason = "the `main` of the examples is not called")]

#[path = "../../examples/ladder_01_pixel.rs"]
pub mod ladder_01_pixel;
#[path = "../../examples/ladder_02_lines.rs"]
pub mod ladder_02_lines;
#[path = "../../examples/ladder_03_wireframe.rs"]
pub mod ladder_03_wireframe;
#[path = "../../examples/ladder_04_triangles.rs"]
pub mod ladder_04_triangles;
#[path = "../../examples/ladder_05_random_colors.rs"]
pub mod ladder_05_random_colors;
#[path = "../../examples/ladder_06_flat_shading.rs"]
pub mod ladder_06_flat_shading;
#[path = "../../examples/ladder_07_z_buffer.rs"]
pub mod ladder_07_z_buffer;

use crate::{Course, LadderError, Picture};

/// A rung of the ladder.
#[derive(Debug, Clone, Copy)]
pub struct Rung {
    /// Its number in the course, 1 to 23.
    pub number: u32,
    /// The name of its example and, with an extension, of its picture.
    pub name: &'static str,
    /// What it shows.
    pub title: &'static str,
    /// Draws its picture.
    pub draw: fn(&Course) -> Result<Picture, LadderError>,
}

/// All rungs in order, without rung 22, which needs shaders in GLSL.
pub const RUNGS: &[Rung] = &[
    Rung {
        number: 1,
        name: "ladder_01_pixel",
        title: "one red pixel",
        draw: ladder_01_pixel::draw,
    },
    Rung {
        number: 2,
        name: "ladder_02_lines",
        title: "lines, from the naive versions to Bresenham's",
        draw: ladder_02_lines::draw,
    },
    Rung {
        number: 3,
        name: "ladder_03_wireframe",
        title: "a model in wireframe",
        draw: ladder_03_wireframe::draw,
    },
    Rung {
        number: 4,
        name: "ladder_04_triangles",
        title: "filled triangles, by sweeping and by bounding box",
        draw: ladder_04_triangles::draw,
    },
    Rung {
        number: 5,
        name: "ladder_05_random_colors",
        title: "faces in random colours",
        draw: ladder_05_random_colors::draw,
    },
    Rung {
        number: 6,
        name: "ladder_06_flat_shading",
        title: "flat shading, the light from the eye",
        draw: ladder_06_flat_shading::draw,
    },
    Rung {
        number: 7,
        name: "ladder_07_z_buffer",
        title: "the z-buffer: never written, right, and its contents",
        draw: ladder_07_z_buffer::draw,
    },
];

/// The rung with a number.
///
/// # Errors
/// If no rung has the number, or it is 22, which needs shaders in GLSL.
pub fn rung(number: u32) -> Result<&'static Rung, LadderError> {
    if number == 22 {
        return Err(LadderError::WaitsForGlsl);
    }
    let found = RUNGS.iter().find(|rung| rung.number == number);
    found.ok_or(LadderError::NoSuchRung { number })
}
