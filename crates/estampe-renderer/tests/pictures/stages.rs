//! The stages that a frame reports, and gradients in several passes.

use crate::support::{DEVICES, drawn_alike};
use estampe_renderer::{
    FrameStage, Gradient, GradientShape, Ground, RenderOptions, Transparency, inspect,
    render_watched,
};
use estampe_scene::{Mesh, Scene};
use estampe_shapes::BuiltinShape;
use std::sync::Mutex;

fn torus() -> Scene {
    let built = BuiltinShape::Torus.build();
    let mesh = Mesh {
        name: built.name,
        positions: built.positions,
        normals: built.normals,
        uvs: built.uvs,
        triangles: built.triangles,
        ..Mesh::default()
    };
    Scene {
        meshes: vec![mesh],
        ..Scene::default()
    }
}

fn small() -> RenderOptions {
    RenderOptions {
        width: 40,
        height: 30,
        ..RenderOptions::default()
    }
}

#[test]
fn stages_come_in_order_and_change_no_byte() {
    let scene = torus();
    let options = RenderOptions {
        ground: Ground::Shadow,
        ..small()
    };
    let plain = drawn_alike(&scene, &options);
    for device in DEVICES.iter() {
        let seen = Mutex::new(Vec::new());
        let on_stage = |stage| seen.lock().expect("no panic").push(stage);
        let frame = render_watched(&scene, &options, device, &on_stage).expect("small");
        assert!(frame.image == plain.image);
        let seen = seen.into_inner().expect("no panic");
        assert_eq!(seen[..2], [FrameStage::Preparing, FrameStage::Shadows]);
        assert_eq!(seen.last(), Some(&FrameStage::ReadingBack));
        let middle = &seen[2..seen.len() - 1];
        let is_drawing = |stage: &FrameStage| matches!(stage, FrameStage::Drawing { begun, all } if begun <= all);
        assert!(
            !middle.is_empty() && middle.iter().all(is_drawing),
            "{seen:?}"
        );
    }
}

#[test]
fn a_gradient_is_the_same_behind_every_method_of_transparency() {
    let gradient = Gradient::new(
        GradientShape::Radial,
        &[[250, 240, 200, 255], [10, 40, 90, 255]],
    );
    let of = |transparency, color| RenderOptions {
        gradient,
        background: gradient.map(|gradient| gradient.middle()),
        transparency,
        color,
        ..small()
    };
    let scene = torus();
    let sorted = drawn_alike(&scene, &of(Transparency::Sorted, None));
    let clear = Some([255, 0, 0, 100]);
    for transparency in [Transparency::Exact, Transparency::Weighted] {
        assert!(drawn_alike(&scene, &of(transparency, None)).image == sorted.image);
        let through = drawn_alike(&scene, &of(transparency, clear));
        assert!(through.image != sorted.image);
        assert_eq!(through.image.texel(0, 0), sorted.image.texel(0, 0));
    }
    // The pixel that is explained is the one that is drawn.
    for pixel in [[0, 0], [20, 15], [33, 7]] {
        let options = of(Transparency::Sorted, clear);
        let drawn = drawn_alike(&scene, &options);
        let explained = inspect(&scene, &options, &DEVICES[0], pixel).expect("one pass");
        assert_eq!(explained.final_rgba8, drawn.image.texel(pixel[0], pixel[1]));
    }
}
