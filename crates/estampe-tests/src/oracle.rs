//! The image that the oracle draws of a case.

use crate::case::{Case, CaseDraw};
use estampe_reference::{Draw, State, Target};
use estampe_types::TextureFormat;

/// What both sides must agree on.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Image {
    /// RGBA, rows from the top, resolved; empty without a colour attachment.
    pub color: Vec<u8>,
    /// The bits of the first sample's depths, rows from the top.
    pub depth: Vec<u32>,
}

/// Draws a case.
#[must_use]
pub fn draw(case: &Case) -> Image {
    let [width, height] = case.size;
    let format = case.format.unwrap_or(TextureFormat::Rgba8Unorm);
    let mut target = Target::new(width, height, case.samples, format);
    target.clear(case.clear_color, case.clear_depth);
    for draw in &case.draws {
        draw_one(&mut target, draw);
    }
    let color = match case.format {
        Some(_) => target.resolve().into_flattened(),
        None => Vec::new(),
    };
    let first_samples = target.depth.iter().step_by(case.samples as usize);
    Image {
        color,
        depth: first_samples.map(|depth| depth.to_bits()).collect(),
    }
}

fn draw_one(target: &mut Target, draw: &CaseDraw) {
    let whole = State::new(target.width, target.height);
    let state = State {
        primitive: draw.primitive,
        depth: draw.depth,
        blend: draw.blend,
        blend_constant: draw.blend_constant,
        write_mask: draw.write_mask,
        viewport: draw.viewport.unwrap_or(whole.viewport),
        scissor: draw.scissor.unwrap_or(whole.scissor),
    };
    let indices = draw.indices.as_ref();
    let command = Draw {
        buffers: &draw.buffers,
        indices: indices.map(|(format, buffer)| (*format, buffer)),
        vertices: draw.elements.clone(),
        instances: draw.instances.clone(),
        base_vertex: draw.base_vertex,
        bindings: &draw.bindings,
    };
    draw.shader.draw_oracle(target, &state, &command);
}
