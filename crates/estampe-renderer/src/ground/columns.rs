//! What is filled above each place of the ground: from the lowest to the highest surface. Two
//! passes draw it, one from below and one from above. A table keeps its legs, and the light between
//! them; what is hollow inside counts as full.

use super::GroundFrame;
use crate::draw_plan::DrawPlan;
use crate::render_error::RenderError;
use crate::shading::shadow::MAX_SHADOW_MAPS;
use crate::transforms::projection::{self, DepthConvention, Frustum};
use crate::transforms::{round_to_f32, to_f32};
use estampe::{
    DepthStencilAttachment, Device, Mat4, RenderPass, Statistics, Texture, TextureDescriptor,
    TextureFormat,
};
use glam::DMat4;

/// The side of the maps, in columns.
pub(super) const SIDE: u32 = 256;

/// The maps of heights, from below and from above.
#[derive(Debug, Clone)]
pub(crate) struct ColumnMaps {
    pub(crate) frame: GroundFrame,
    /// The clip spaces from below and from above: x and y are along the ground, depth is the height
    /// or what it lacks to the highest.
    clip_from_unit: [Mat4; 2],
    depths: [Texture; 2],
    /// The height of depth 1.
    range: f64,
}

/// Columns above a square of the ground, in unit space.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Columns {
    pub(super) side: usize,
    /// Half of the square's side.
    pub(super) half: f32,
    /// The lowest and the highest surface of each column, rows along the second axis; the lowest is
    /// infinite where there is none.
    pub(super) heights: Vec<[f32; 2]>,
}

impl ColumnMaps {
    /// The number of the first map among those that casters are drawn into.
    pub(crate) const FIRST_SLOT: usize = MAX_SHADOW_MAPS;

    pub(crate) fn new(device: &Device, frame: GroundFrame) -> Result<Self, RenderError> {
        let [x, y, up] = frame.axes;
        let range = frame.height * 1.02;
        let from_unit = |up_sign: f64, origin: f64| {
            let rows = DMat4::from_cols(
                x.extend(0.0),
                y.extend(0.0),
                (up * up_sign).extend(0.0),
                glam::DVec4::W,
            )
            .transpose();
            let middle = frame.middle;
            let moved = DMat4::from_translation(glam::DVec3::new(
                -middle.dot(x),
                -middle.dot(y),
                -middle.dot(up) * up_sign + origin,
            ));
            // Clip depth grows along −z.
            let clip = projection::orthographic(
                &Frustum {
                    left: -frame.half,
                    right: frame.half,
                    bottom: -frame.half,
                    top: frame.half,
                    near: -range * 0.005,
                    far: range * 0.995,
                },
                DepthConvention::ZeroToOne,
            );
            to_f32(&(clip * moved * rows)).into()
        };
        let texture = || {
            let format = TextureFormat::Depth32Float;
            device.create_texture(&TextureDescriptor::new_2d(SIDE, SIDE, format))
        };
        Ok(Self {
            frame,
            // Heights count downwards from below, so that the lowest is the nearest.
            clip_from_unit: [from_unit(-1.0, 0.0), from_unit(1.0, -frame.height)],
            depths: [texture()?, texture()?],
            range,
        })
    }

    /// The clip space of a slot of the plan's casters.
    pub(crate) fn clip_from_unit(&self, slot: usize) -> Mat4 {
        self.clip_from_unit[slot - Self::FIRST_SLOT]
    }

    /// Draws the maps.
    pub(crate) fn draw(
        &self,
        device: &Device,
        plan: &DrawPlan,
    ) -> Result<(Columns, Statistics), RenderError> {
        let mut statistics = Statistics::default();
        let mut maps = [Vec::new(), Vec::new()];
        for (number, (texture, map)) in self.depths.iter().zip(&mut maps).enumerate() {
            statistics += device.render(&RenderPass {
                depth_stencil_attachment: Some(DepthStencilAttachment::clear(&texture.view(), 1.0)),
                draws: &plan.casters(Self::FIRST_SLOT + number),
                ..RenderPass::default()
            })?;
            let bytes = device.read_texture(texture)?;
            let depths = bytes
                .as_chunks()
                .0
                .iter()
                .map(|&bytes| f32::from_le_bytes(bytes));
            map.extend(depths);
        }
        let [below, above] = maps;
        let (range, height) = (round_to_f32(self.range), round_to_f32(self.frame.height));
        let nearest = range * 0.005;
        let heights = below.iter().zip(&above).map(|(&below, &above)| {
            if below >= 1.0 {
                return [f32::INFINITY, 0.0];
            }
            let low = (below * range - nearest).max(0.0);
            [low, (height - (above * range - nearest)).max(low)]
        });
        let columns = Columns {
            side: SIDE as usize,
            half: round_to_f32(self.frame.half),
            heights: heights.collect(),
        };
        Ok((columns, statistics))
    }
}

impl Columns {
    /// The column at a place, by its coordinates along the ground.
    #[inline]
    pub(super) fn at(&self, x: f32, y: f32) -> Option<[f32; 2]> {
        let scale = columns_f32(self.side) / (2.0 * self.half);
        let (column, row) = ((x + self.half) * scale, (self.half - y) * scale);
        let side = columns_f32(self.side);
        let inside = (0.0..side).contains(&column) && (0.0..side).contains(&row);
        let found = || {
            self.heights
                .get(whole(row) * self.side + whole(column))
                .copied()
        };
        found()
            .filter(|_| inside)
            .filter(|[low, _]| low.is_finite())
    }
}

#[expect(clippy::cast_precision_loss, reason = "sides are at most some hundred")]
pub(super) fn columns_f32(count: usize) -> f32 {
    count as f32
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "callers check the range; NaN gives 0"
)]
fn whole(number: f32) -> usize {
    number as usize
}
