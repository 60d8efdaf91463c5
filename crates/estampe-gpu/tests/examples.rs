//! Every example draws its picture in `docs/images/examples`, byte for byte, at the narrowest SIMD
//! level on one thread, and at the widest on two.
//!
//! `UPDATE_PICTURES=1 cargo test -p estampe-gpu --test examples` writes the pictures anew: look at
//! each that changed.

#![expect(dead_code, reason = "the examples' `main` is not called")]
#![expect(
    clippy::duplicate_mod,
    reason = "each example is a program with its own modules"
)]

#[path = "../examples/bloom.rs"]
mod bloom;
#[path = "../examples/cube_map_one_pass.rs"]
mod cube_map_one_pass;
#[path = "../examples/deferred.rs"]
mod deferred;
#[path = "../examples/instancing.rs"]
mod instancing;
#[path = "../examples/mandelbrot.rs"]
mod mandelbrot;
#[path = "../examples/multisampling.rs"]
mod multisampling;
#[path = "../examples/normals.rs"]
mod normals;
#[path = "../examples/picking.rs"]
mod picking;
#[path = "../examples/reflections.rs"]
mod reflections;
#[path = "../examples/shadow_map.rs"]
mod shadow_map;
#[path = "../examples/silhouette.rs"]
mod silhouette;
#[path = "../examples/tessellated_teapot.rs"]
mod tessellated_teapot;
#[path = "../examples/textured_cube.rs"]
mod textured_cube;
#[path = "../examples/triangle.rs"]
mod triangle;
#[path = "../examples/ui.rs"]
mod ui;

use estampe::{Device, DeviceDescriptor, Level, Texture};
use std::error::Error;
use std::path::Path;

#[test]
fn bloom_draws_its_picture() {
    check("bloom", bloom::picture);
}

#[test]
fn cube_map_one_pass_draws_its_picture() {
    check("cube_map_one_pass", cube_map_one_pass::picture);
}

#[test]
fn deferred_draws_its_picture() {
    check("deferred", deferred::picture);
}

#[test]
fn instancing_draws_its_picture() {
    check("instancing", instancing::picture);
}

#[test]
fn mandelbrot_draws_its_picture() {
    check("mandelbrot", mandelbrot::picture);
}

#[test]
fn multisampling_draws_its_picture() {
    check("multisampling", multisampling::picture);
}

#[test]
fn normals_draws_its_picture() {
    check("normals", normals::picture);
}

#[test]
fn picking_draws_its_picture() {
    check("picking", picking::picture);
}

#[test]
fn reflections_draws_its_picture() {
    check("reflections", reflections::picture);
}

#[test]
fn shadow_map_draws_its_picture() {
    check("shadow_map", shadow_map::picture);
}

#[test]
fn silhouette_draws_its_picture() {
    check("silhouette", silhouette::picture);
}

#[test]
fn tessellated_teapot_draws_its_picture() {
    check("tessellated_teapot", tessellated_teapot::picture);
}

#[test]
fn textured_cube_draws_its_picture() {
    check("textured_cube", textured_cube::picture);
}

#[test]
fn triangle_draws_its_picture() {
    check("triangle", triangle::picture);
}

#[test]
fn ui_draws_its_picture() {
    check("ui", ui::picture);
}

fn check(name: &str, picture: fn(&Device) -> Result<Texture, Box<dyn Error>>) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/images/examples");
    let path = folder.join(format!("{name}.png"));
    let levels = Level::all_available();
    let narrowest = *levels.first().expect("there is a level");
    for (level, threads) in [(Level::best(), 2), (narrowest, 1)] {
        let device = Device::new(&DeviceDescriptor {
            threads,
            level,
            ..DeviceDescriptor::default()
        });
        let device = device.expect("the system starts two threads");
        let picture = picture(&device).expect("the example runs");
        let drawn = device.encode_png(&picture).expect("it can be encoded");
        if std::env::var_os("UPDATE_PICTURES").is_some() && threads == 2 {
            std::fs::write(&path, &drawn).expect("the picture can be written");
        }
        let expected = std::fs::read(&path).expect("the example has a picture");
        assert!(
            drawn == expected,
            "{name} draws another picture than {} at {level:?} on {threads} threads. If the \
             change is meant, write it anew: UPDATE_PICTURES=1 cargo test -p estampe-gpu --test examples",
            path.display()
        );
    }
}
