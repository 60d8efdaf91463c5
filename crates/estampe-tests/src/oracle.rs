//! The image that the oracle draws of a case.

use crate::case::{Case, CaseDraw};
use estampe_reference::{Draw, State, Target, TargetState, color};
use estampe_types::TextureFormat;

/// What both sides must agree on.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Image {
    /// RGBA, rows from the top, resolved; empty without a colour attachment.
    pub color: Vec<u8>,
    /// The bits of the first sample's depths, rows from the top.
    pub depth: Vec<u32>,
    /// Of each pixel of four samples, how many samples hold the oracle's depth of sample 0, 1, 2 and 3, as
    /// codes of a resolved target; empty where that is not asked. So the depths of all samples are compared.
    pub matches: Vec<[u8; 4]>,
}

/// The largest target, in pixels, of which the depths of all samples are compared.
const MATCHED_PIXELS: u32 = 400;

/// The depths of all samples of every pixel, if they are to be compared one by one.
pub type SampleDepths = Option<Vec<[f32; 4]>>;

/// Draws a case.
#[must_use]
pub fn draw(case: &Case) -> (Image, SampleDepths) {
    let [width, height] = case.size;
    let format = case.format.unwrap_or(TextureFormat::Rgba8Unorm);
    let mut target = Target::new(width, height, case.samples, format);
    target.clear(case.clear_color, case.clear_depth);
    for draw in &case.draws {
        draw_one(&mut target, draw);
    }
    let color = match case.format {
        Some(format) => {
            let texels = target.resolve(0).into_iter();
            texels.flat_map(|codes| color::bytes(format, codes)).collect()
        }
        None => Vec::new(),
    };
    let first_samples = target.depth.iter().step_by(case.samples as usize);
    let is_matched = case.samples == 4 && case.format.is_some() && width * height <= MATCHED_PIXELS;
    let depths = is_matched.then(|| target.depth.as_chunks::<4>().0.to_vec());
    let image = Image {
        color,
        depth: first_samples.map(|depth| depth.to_bits()).collect(),
        matches: depths.iter().flatten().map(matches).collect(),
    };
    (image, depths)
}

/// How many of four depths equal each of them, as the mean of four codes 0 or 255.
fn matches(depths: &[f32; 4]) -> [u8; 4] {
    depths.map(|wanted| {
        let equal = depths.iter().filter(|&&depth| depth == wanted).count();
        [0, 64, 128, 191, 255][equal]
    })
}

fn draw_one(target: &mut Target, draw: &CaseDraw) {
    let whole = State::new(target.width, target.height);
    let state = State {
        primitive: draw.primitive,
        depth: draw.depth,
        targets: vec![TargetState {
            blend: draw.blend,
            write_mask: draw.write_mask,
        }],
        blend_constant: draw.blend_constant,
        viewport: draw.viewport.unwrap_or(whole.viewport),
        scissor: draw.scissor.unwrap_or(whole.scissor),
        ..whole
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
