//! The scenes' shaders as WGSL: the same formulas as in Rust, as their author would write them.
//!
//! Group 0 has the uniforms in binding 0, the sampler in 1 and the textures from 2 on; group 1 has
//! the depth map and its comparison sampler.

/// The module of a scene.
#[derive(Debug)]
pub(crate) struct WgslShaders {
    /// Its text.
    pub text: &'static str,
    /// The vertex and the fragment entry point of each pipeline; the latter is not used by
    /// pipelines without colours.
    pub entry_points: &'static [[&'static str; 2]],
}

const VERTEX_AND_FRAGMENT: &[[&str; 2]] = &[["vertex", "fragment"]];

macro_rules! shaders {
    ($file:literal) => {
        shaders!($file, VERTEX_AND_FRAGMENT)
    };
    ($file:literal, $entry_points:expr) => {
        &WgslShaders {
            text: include_str!(concat!("wgsl/", $file)),
            entry_points: $entry_points,
        }
    };
}

/// The module of the scene with this name.
pub(super) fn of(name: &str) -> Option<&'static WgslShaders> {
    Some(match name {
        "fill" | "fill_front" | "fill_draws" => shaders!("flat_color.wgsl"),
        "blend" => shaders!("vertex_color.wgsl"),
        "small_tris" => shaders!("gouraud.wgsl"),
        "mid_tris" | "msaa4" => shaders!("normal_mapped.wgsl"),
        "textured" | "textured_draws" => shaders!("textured.wgsl"),
        "heavy_fs" => shaders!("field.wgsl"),
        "shadow" => shaders!(
            "shadow.wgsl",
            &[["depth_vertex", "fragment"], ["vertex", "fragment"]]
        ),
        "instances" | "many_draws" => shaders!("lambert.wgsl"),
        "quad_draws" => shaders!("bound_color.wgsl"),
        _ => return None,
    })
}
