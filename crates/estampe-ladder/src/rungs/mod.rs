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
#[path = "../../examples/ladder_08_diffuse_texture.rs"]
pub mod ladder_08_diffuse_texture;
#[path = "../../examples/ladder_09_gouraud.rs"]
pub mod ladder_09_gouraud;
#[path = "../../examples/ladder_10_viewport.rs"]
pub mod ladder_10_viewport;
#[path = "../../examples/ladder_11_projection.rs"]
pub mod ladder_11_projection;
#[path = "../../examples/ladder_12_look_at.rs"]
pub mod ladder_12_look_at;
#[path = "../../examples/ladder_13_four_shaders.rs"]
pub mod ladder_13_four_shaders;
#[path = "../../examples/ladder_14_quantised.rs"]
pub mod ladder_14_quantised;
#[path = "../../examples/ladder_15_phong.rs"]
pub mod ladder_15_phong;
#[path = "../../examples/ladder_16_near_clipping.rs"]
pub mod ladder_16_near_clipping;
#[path = "../../examples/ladder_17_top_left_rule.rs"]
pub mod ladder_17_top_left_rule;
#[path = "../../examples/ladder_18_z_fighting.rs"]
pub mod ladder_18_z_fighting;
#[path = "../../examples/ladder_19_visibility.rs"]
pub mod ladder_19_visibility;
#[path = "../../examples/ladder_20_transparency.rs"]
pub mod ladder_20_transparency;
#[path = "../../examples/ladder_21_stencil_logic.rs"]
pub mod ladder_21_stencil_logic;
#[path = "../../examples/ladder_22_glsl.rs"]
pub mod ladder_22_glsl;
#[path = "../../examples/ladder_23_shapes.rs"]
pub mod ladder_23_shapes;

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

/// All rungs in order.
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
    Rung {
        number: 8,
        name: "ladder_08_diffuse_texture",
        title: "a diffuse texture",
        draw: ladder_08_diffuse_texture::draw,
    },
    Rung {
        number: 9,
        name: "ladder_09_gouraud",
        title: "Gouraud shading beside flat shading",
        draw: ladder_09_gouraud::draw,
    },
    Rung {
        number: 10,
        name: "ladder_10_viewport",
        title: "the viewport matrix",
        draw: ladder_10_viewport::draw,
    },
    Rung {
        number: 11,
        name: "ladder_11_projection",
        title: "central projection, and texture coordinates in it",
        draw: ladder_11_projection::draw,
    },
    Rung {
        number: 12,
        name: "ladder_12_look_at",
        title: "a camera that looks at the model",
        draw: ladder_12_look_at::draw,
    },
    Rung {
        number: 13,
        name: "ladder_13_four_shaders",
        title: "four shaders in one picture",
        draw: ladder_13_four_shaders::draw,
    },
    Rung {
        number: 14,
        name: "ladder_14_quantised",
        title: "quantised Gouraud shading",
        draw: ladder_14_quantised::draw,
    },
    Rung {
        number: 15,
        name: "ladder_15_phong",
        title: "Phong shading, several lights, attenuation, fog, toon",
        draw: ladder_15_phong::draw,
    },
    Rung {
        number: 16,
        name: "ladder_16_near_clipping",
        title: "clipping by the near plane",
        draw: ladder_16_near_clipping::draw,
    },
    Rung {
        number: 17,
        name: "ladder_17_top_left_rule",
        title: "the top-left rule, magnified",
        draw: ladder_17_top_left_rule::draw,
    },
    Rung {
        number: 18,
        name: "ladder_18_z_fighting",
        title: "z-fighting and its cures",
        draw: ladder_18_z_fighting::draw,
    },
    Rung {
        number: 19,
        name: "ladder_19_visibility",
        title: "painter, BSP tree and z-buffer",
        draw: ladder_19_visibility::draw,
    },
    Rung {
        number: 20,
        name: "ladder_20_transparency",
        title: "transparency: terrain, then water",
        draw: ladder_20_transparency::draw,
    },
    Rung {
        number: 21,
        name: "ladder_21_stencil_logic",
        title: "stencil and logic operations",
        draw: ladder_21_stencil_logic::draw,
    },
    Rung {
        number: 22,
        name: "ladder_22_glsl",
        title: "shaders in GLSL, with uniforms by name",
        draw: ladder_22_glsl::draw,
    },
    Rung {
        number: 23,
        name: "ladder_23_shapes",
        title: "shapes: explicit, parametric, implicit, polygons",
        draw: ladder_23_shapes::draw,
    },
];

/// The rung with a number.
///
/// # Errors
/// If no rung has the number.
pub fn rung(number: u32) -> Result<&'static Rung, LadderError> {
    let found = RUNGS.iter().find(|rung| rung.number == number);
    found.ok_or(LadderError::NoSuchRung { number })
}
