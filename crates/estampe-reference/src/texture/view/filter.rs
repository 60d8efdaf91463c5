//! Filtering: the probes of a sample, the mip levels of each, and the texels along each axis or on
//! a cube's faces.

use super::{ReferenceView, Sample};
use crate::arithmetic::clamp;
use crate::texture::{cube, linear, mix, nearest, whole};
use estampe_types::{AddressMode, FilterMode, ViewDimension};

impl ReferenceView {
    /// The filtered value; with a reference, the filtered results of the comparisons in the first
    /// channel.
    #[must_use]
    pub fn sample(&self, sample: &Sample) -> [f32; 4] {
        let mut sum = [0.0; 4];
        for i in 1..=sample.probes {
            let t = f32::from(i) / f32::from(sample.probes + 1) - 0.5;
            let at = std::array::from_fn(|k| {
                if sample.probes == 1 {
                    sample.at[k]
                } else {
                    sample.at[k] + sample.step[k] * t
                }
            });
            let color = self.mixture(&Sample { at, ..*sample });
            sum = std::array::from_fn(|k| if i == 1 { color[k] } else { sum[k] + color[k] });
        }
        if sample.probes > 1 {
            sum = sum.map(|channel| channel * (1.0 / f32::from(sample.probes)));
        }
        match sample.reference {
            Some(_) => sum,
            None => self.finished(sum),
        }
    }

    /// Units as values.
    pub(super) fn finished(&self, units: [f32; 4]) -> [f32; 4] {
        let factors = self.reader().factors();
        std::array::from_fn(|k| {
            if self.reader().is_integer() {
                units[k]
            } else {
                units[k] * factors[k]
            }
        })
    }

    /// One probe: the mixture of one or two mip levels.
    fn mixture(&self, sample: &Sample) -> [f32; 4] {
        let sampler = &self.sampler;
        let lod = clamp(sample.lod, sampler.lod_min_clamp, sampler.lod_max_clamp);
        let filter = if lod <= 0.0 {
            sampler.mag_filter
        } else {
            sampler.min_filter
        };
        let lod = clamp(lod, 0.0, self.levels[1] as f32 - 1.0);
        let level = |level: f32| {
            let level = usize::try_from(whole(level)).unwrap_or_default();
            self.filtered(level, filter, sample)
        };
        match sampler.mipmap_filter {
            FilterMode::Nearest => level((lod + 0.5).floor()),
            FilterMode::Linear if lod == lod.floor() => level(lod),
            FilterMode::Linear => {
                let first = lod.floor();
                mix(level(first), level(first + 1.0), lod - first)
            }
        }
    }

    /// The texture layer of a sample; for cubes, that of the face +x.
    pub(super) fn slice(&self, layer: i32) -> i64 {
        let layer = i64::from(layer).clamp(0, i64::from(self.layer_count()) - 1);
        i64::from(self.layers[0]) + layer * if self.is_cube() { 6 } else { 1 }
    }

    /// The filtered value of one mip level, in units.
    fn filtered(&self, level: usize, filter: FilterMode, sample: &Sample) -> [f32; 4] {
        if self.is_cube() {
            return self.filtered_cube(level, filter, sample);
        }
        let axes = match self.dimension {
            ViewDimension::D1 => 1,
            ViewDimension::D3 => 3,
            _ => 2,
        };
        // Nearest is linear filtering with only the first texel.
        let places: [_; 3] = std::array::from_fn(|k| {
            if k < axes {
                self.place(level, k, filter, sample)
            } else {
                ([Some(0); 2], 0.0)
            }
        });
        let texel = |x: usize, y: usize, z: usize| {
            let [x, y, z] = [places[0].0[x], places[1].0[y], places[2].0[z]];
            let slice = if axes == 3 {
                z
            } else {
                Some(self.slice(sample.layer))
            };
            self.answer(level, [x, y, slice], sample.reference)
        };
        if filter == FilterMode::Nearest {
            return texel(0, 0, 0);
        }
        let row = |y, z| mix(texel(0, y, z), texel(1, y, z), places[0].1);
        let image = |z| {
            if axes == 1 {
                row(0, z)
            } else {
                mix(row(0, z), row(1, z), places[1].1)
            }
        };
        if axes == 3 {
            mix(image(0), image(1), places[2].1)
        } else {
            image(0)
        }
    }

    /// The two texels along an axis, `None` for the border, and the weight of the second.
    pub(super) fn place(
        &self,
        level: usize,
        axis: usize,
        filter: FilterMode,
        sample: &Sample,
    ) -> ([Option<i64>; 2], f32) {
        use AddressMode as A;
        let mode = self.mode(axis);
        let (u, n) = (sample.at[axis], self.sides(level)[axis]);
        if sample.offset[axis] == 0 && matches!(mode, A::Repeat | A::MirrorRepeat | A::ClampToEdge)
        {
            let (texels, fraction) = match filter {
                FilterMode::Nearest => ([nearest(mode, u, n); 2], 0.0),
                FilterMode::Linear => linear(mode, u, n),
            };
            return (texels.map(|texel| Some(i64::from(texel))), fraction);
        }
        self.place_in_integers(level, axis, filter, sample)
    }

    /// As [`place`](Self::place), but each of the two texels is wrapped separately: for offsets,
    /// borders and gathering.
    pub(super) fn place_in_integers(
        &self,
        level: usize,
        axis: usize,
        filter: FilterMode,
        sample: &Sample,
    ) -> ([Option<i64>; 2], f32) {
        use AddressMode as A;
        let mode = self.mode(axis);
        let (u, n) = (sample.at[axis], self.sides(level)[axis]);
        let half = match filter {
            FilterMode::Nearest => 0.0,
            FilterMode::Linear => 0.5,
        };
        let q = clamp(u * n as f32 - half, -16_777_216.0, 16_777_216.0);
        let first = whole(q.floor()) + i64::from(sample.offset[axis].clamp(-1024, 1024));
        let n = i64::from(n);
        let mirror = |i: i64| if i >= 0 { i } else { -1 - i };
        let wrap = |i: i64| match mode {
            A::Repeat => Some(i.rem_euclid(n)),
            A::MirrorRepeat => Some((n - 1) - mirror(i.rem_euclid(2 * n) - n)),
            A::ClampToEdge => Some(i.clamp(0, n - 1)),
            A::MirrorOnce => Some(mirror(i).min(n - 1)),
            A::ClampToBorder => (0..n).contains(&i).then_some(i),
        };
        ([wrap(first), wrap(first + 1)], q - q.floor())
    }

    pub(super) fn mode(&self, axis: usize) -> AddressMode {
        let sampler = &self.sampler;
        match axis {
            0 => sampler.address_mode_u,
            1 => sampler.address_mode_v,
            _ => sampler.address_mode_w,
        }
    }

    /// The filtered value of one mip level of a cube, in units.
    fn filtered_cube(&self, level: usize, filter: FilterMode, sample: &Sample) -> [f32; 4] {
        if filter == FilterMode::Linear {
            let (four, [fx, fy]) = self.four_of_cube(level, sample);
            return mix(mix(four[0], four[1], fx), mix(four[2], four[3], fx), fy);
        }
        let face = cube::face(sample.at);
        let n = self.sides(level)[0] as f32;
        let texel = cube::coordinates(face, sample.at)
            .map(|s| Some(whole(clamp((s * n).floor(), 0.0, n - 1.0))));
        let slice = self.slice(sample.layer) + face as i64;
        self.answer(level, [texel[0], texel[1], Some(slice)], sample.reference)
    }

    /// The four texels around a direction, and the weights of the second column and row.
    pub(super) fn four_of_cube(&self, level: usize, sample: &Sample) -> ([[f32; 4]; 4], [f32; 2]) {
        let face = cube::face(sample.at);
        let n = self.sides(level)[0];
        let q = cube::coordinates(face, sample.at)
            .map(|s| clamp(s * n as f32 - 0.5, -0.5, n as f32 - 0.5));
        let first = q.map(|q| whole(q.floor()));
        let n = i64::from(n);
        let places = [[0, 0], [1, 0], [0, 1], [1, 1]].map(|[x, y]| [first[0] + x, first[1] + y]);
        let texel = |face: usize, x: i64, y: i64| {
            let slice = self.slice(sample.layer) + face as i64;
            self.answer(level, [Some(x), Some(y), Some(slice)], sample.reference)
        };
        let found = places.map(|[x, y]| {
            let corner = |at: i64| at.clamp(0, n - 1);
            cube::neighbor(face, x, y, n)
                .or_else(|| {
                    let is_integer = self.reader().is_integer();
                    is_integer.then(|| (face, corner(x), corner(y)))
                })
                .map(|(face, x, y)| texel(face, x, y))
        });
        let there: Vec<_> = found.iter().flatten().collect();
        let mean = || {
            let third = 1.0 / 3.0;
            std::array::from_fn(|k| ((there[0][k] + there[1][k]) + there[2][k]) * third)
        };
        (
            found.map(|texel| texel.unwrap_or_else(mean)),
            q.map(|q| q - q.floor()),
        )
    }
}
