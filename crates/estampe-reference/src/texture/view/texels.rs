//! The texels of a view: their units, the border and comparisons; gathering and fetching.

use super::{ReferenceView, Sample};
use crate::arithmetic::clamp;
use crate::compare;
use estampe_types::{AddressMode, BorderColor, FilterMode, TexelEncoding, ViewDimension};

impl ReferenceView {
    /// A texel in units, or the result of its comparison (0 or 1); a coordinate `None` selects the
    /// border.
    pub(super) fn answer(
        &self,
        level: usize,
        at: [Option<i64>; 3],
        reference: Option<f32>,
    ) -> [f32; 4] {
        let units = match at {
            [Some(x), Some(y), Some(slice)] => self.units(level, [x, y, slice], 0),
            _ => self.border(),
        };
        let Some(reference) = reference else {
            return units;
        };
        let encoding = self.texture.stored_format().encoding();
        let reference = match encoding {
            TexelEncoding::Depth16 | TexelEncoding::Depth24 => clamp(reference, 0.0, 1.0),
            _ => reference,
        };
        let passes = self
            .sampler
            .compare
            .is_some_and(|function| compare::passes(function, reference, units[0]));
        [f32::from(u8::from(passes)), 0.0, 0.0, 0.0]
    }

    fn border(&self) -> [f32; 4] {
        let reader = self.reader();
        let nothing = reader.units(&[]);
        std::array::from_fn(|k| {
            let is_one = match self.sampler.border_color {
                BorderColor::TransparentBlack => false,
                BorderColor::OpaqueBlack => k == 3,
                BorderColor::OpaqueWhite => true,
            };
            if k >= reader.format.components() {
                nothing[k]
            } else if is_one {
                reader.one(k)
            } else {
                0.0
            }
        })
    }

    /// A texel inside a mip level, in units.
    fn units(&self, level: usize, [x, y, slice]: [i64; 3], sample: i64) -> [f32; 4] {
        let of_level = &self.texture.levels[self.levels[0] + level];
        let [width, height] = [of_level.width, of_level.height].map(i64::from);
        let samples = i64::from(self.texture.shape.samples);
        let texel = ((slice * height + y) * width + x) * samples + sample;
        let words = self.texture.words_per_texel();
        let at = usize::try_from(i64::from(of_level.offset) + texel).unwrap_or(usize::MAX / 8);
        let words: Vec<u32> = (at * words..(at + 1) * words)
            .map(|at| self.texture.texels.get(at).copied().unwrap_or_default())
            .collect();
        self.reader().units(&words)
    }

    /// One channel of the four texels around a point in the base level, or the results of their
    /// comparisons, in the order c₀₁, c₁₁, c₁₀, c₀₀. Each texel wraps separately. Zeros for 1D and
    /// 3D views.
    #[must_use]
    pub fn gather(&self, sample: &Sample, channel: usize) -> [f32; 4] {
        if matches!(self.dimension, ViewDimension::D1 | ViewDimension::D3) {
            return [0.0; 4];
        }
        let four = if self.is_cube() {
            self.four_of_cube(0, sample).0
        } else {
            let [x, y] = [0, 1].map(|axis| match self.mode(axis) {
                AddressMode::Repeat => self.place(0, axis, FilterMode::Linear, sample).0,
                _ => {
                    self.place_in_integers(0, axis, FilterMode::Linear, sample)
                        .0
                }
            });
            let slice = Some(self.slice(sample.layer));
            [[0, 0], [1, 0], [0, 1], [1, 1]]
                .map(|[i, j]| self.answer(0, [x[i], y[j], slice], sample.reference))
        };
        let value = |units: [f32; 4]| match sample.reference {
            Some(_) => units[0],
            None => self.finished(units)[channel],
        };
        [four[2], four[3], four[1], four[0]].map(value)
    }

    /// A texel by integer coordinates; zeros outside. `z` is the depth slice, or the layer (six for
    /// each cube).
    #[must_use]
    pub fn fetch(&self, [x, y, z]: [i32; 3], level: i32, sample: i32) -> [f32; 4] {
        use ViewDimension::{D1, D2, D3};
        let y = if self.dimension == D1 { 0 } else { y };
        let z = if matches!(self.dimension, D1 | D2) {
            0
        } else {
            z
        };
        let Ok(level) = usize::try_from(level) else {
            return [0.0; 4];
        };
        if level >= self.levels[1] {
            return [0.0; 4];
        }
        let [width, height, depth] = self.sides(level);
        let slices = if self.dimension == D3 {
            depth
        } else {
            self.layers[1]
        };
        let beyond = |at: i32, count: u32| at < 0 || i64::from(at) >= i64::from(count);
        if beyond(x, width)
            || beyond(y, height)
            || beyond(z, slices)
            || beyond(sample, self.texture.shape.samples)
        {
            return [0.0; 4];
        }
        let slice = i64::from(self.layers[0]) + i64::from(z);
        let texel = [i64::from(x), i64::from(y), slice];
        self.finished(self.units(level, texel, i64::from(sample)))
    }
}
