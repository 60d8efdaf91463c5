//! `clear`: clears and stores colour and depth without draws: the fixed cost of a frame.

use super::Scene;

pub(super) fn scene() -> Scene {
    Scene {
        name: "clear",
        buffers: Vec::new(),
        textures: Vec::new(),
        samples: 1,
        pipelines: Vec::new(),
        uniforms: None,
        depth_map: None,
        draws: Vec::new(),
        wgsl: None,
        strict_math: true,
        frame: None,
    }
}
