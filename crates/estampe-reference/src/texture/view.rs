//! Sampling of texture views of every dimension and format, texel by texel.
//!
//! In · Out: coordinates of one lane, or derivatives of a quad · filtered values, results of
//! comparisons, gathered or fetched texels. Precision: f32 in the order of NUMERICS.md, *Textures*.

use super::cube;
use super::texel::TexelReader;
use super::{log2, mix, whole};
use crate::arithmetic::{clamp, max, min};
use crate::compare;
use estampe_types::shader::Sample2d;
use estampe_types::{
    AddressMode, BorderColor, FilterMode, Real, SamplerDescriptor, TexelData, TexelEncoding,
    TextureAspect, TextureDimension, Vec2, Vec4, ViewDimension,
};
use std::sync::Arc;

/// A texture view and its sampler.
#[derive(Debug, Clone)]
pub struct ReferenceView {
    /// The texture.
    pub texture: Arc<TexelData>,
    /// The dimension of the view.
    pub dimension: ViewDimension,
    /// The first mip level and the number of levels.
    pub levels: [usize; 2],
    /// The first layer and the number of layers (six for each cube).
    pub layers: [u32; 2],
    /// The aspect of a depth-stencil texture that is read.
    pub aspect: TextureAspect,
    /// Addressing, filtering and comparison.
    pub sampler: SamplerDescriptor,
}

/// The coordinates, level of detail and footprint of one lane's sample.
#[derive(Debug, Clone, Copy)]
pub struct Sample {
    /// (u, v, w), or the direction for cubes.
    pub at: [f32; 3],
    /// The array layer, or the number of the cube.
    pub layer: i32,
    /// λ with its bias, before it is clamped.
    pub lod: f32,
    /// The number of anisotropic probes.
    pub probes: u16,
    /// The derivative of the coordinates along which the probes are placed.
    pub step: [f32; 3],
    /// The offset in texels.
    pub offset: [i32; 3],
    /// The reference of a comparison; `None` returns the texels' channels.
    pub reference: Option<f32>,
}

impl Sample2d for ReferenceView {
    fn sample<R: Real>(&self, uv: Vec2<R>) -> Vec4<R> {
        // Two packet pairs have sixty-four lanes; a single fragment is its own quad.
        let mut texels = [[0.0; 4]; 64];
        let gradients = [uv.x.ddx(), uv.y.ddx(), uv.x.ddy(), uv.y.ddy()];
        for (lane, texel) in texels.iter_mut().enumerate().take(R::LANES) {
            let first = if R::LANES >= 4 { lane / 4 * 4 } else { lane };
            let at = |lane: usize| [uv.x.lane(lane), uv.y.lane(lane), 0.0];
            let [u_x, v_x, u_y, v_y] = gradients.map(|gradient| gradient.lane(first));
            let (lod, probes, step) = self.footprint(at(first), [u_x, v_x, 0.0], [u_y, v_y, 0.0]);
            *texel = self.sample(&Sample {
                at: at(lane),
                layer: 0,
                lod: self.biased(lod, 0.0),
                probes,
                step,
                offset: [0; 3],
                reference: None,
            });
        }
        let channel = |k: usize| uv.x.with_lanes(|lane| texels[lane][k]);
        Vec4::new(channel(0), channel(1), channel(2), channel(3))
    }
}

impl ReferenceView {
    /// The 2D view of all mip levels of a texture's first layer.
    #[must_use]
    pub fn of_image(texture: Arc<TexelData>, sampler: SamplerDescriptor) -> Self {
        Self {
            dimension: ViewDimension::D2,
            levels: [0, texture.levels.len()],
            layers: [0, 1],
            aspect: TextureAspect::All,
            sampler,
            texture,
        }
    }

    fn reader(&self) -> TexelReader {
        TexelReader {
            format: self.texture.stored_format(),
            aspect: self.aspect,
        }
    }

    fn is_cube(&self) -> bool {
        use ViewDimension::{Cube, CubeArray};
        matches!(self.dimension, Cube | CubeArray)
    }

    /// Width, height and depth of a mip level of the view, in texels.
    fn sides(&self, level: usize) -> [u32; 3] {
        let of_level = &self.texture.levels[self.levels[0] + level];
        let depth = match self.texture.shape.dimension {
            TextureDimension::D3 => self.texture.shape.slices(self.levels[0] + level),
            TextureDimension::D1 | TextureDimension::D2 => 1,
        };
        [of_level.width, of_level.height, depth]
    }

    /// The number of layers, or of cubes.
    fn layer_count(&self) -> u32 {
        if self.is_cube() {
            self.layers[1] / 6
        } else {
            self.layers[1]
        }
    }

    /// λ without bias, the number of probes, and the derivative along which they are placed, from
    /// the coordinates and their derivatives along x and y.
    #[must_use]
    pub fn footprint(&self, at: [f32; 3], dx: [f32; 3], dy: [f32; 3]) -> (f32, u16, [f32; 3]) {
        use ViewDimension::{D1, D3};
        let sides = self.sides(0).map(|side| side as f32);
        let squared = |d: [f32; 3]| {
            let d = if self.is_cube() {
                let [s, t] = cube::derivatives(cube::face(at), at, d);
                [s, t, 0.0]
            } else {
                d
            };
            let texels: [f32; 3] = std::array::from_fn(|k| d[k] * sides[k]);
            let one = texels[0] * texels[0];
            let two = one + texels[1] * texels[1];
            match self.dimension {
                D1 => one,
                D3 => two + texels[2] * texels[2],
                _ => two,
            }
        };
        let (x, y) = (squared(dx), squared(dy));
        let limit = f32::from(self.sampler.max_anisotropy);
        if limit <= 1.0 || matches!(self.dimension, D1 | D3) {
            return (0.5 * log2(max(max(x, y), 0.0)), 1, [0.0; 3]);
        }
        let (x, y) = (max(x, 0.0), max(y, 0.0));
        let (larger, smaller, step) = if y > x { (y, x, dy) } else { (x, y, dx) };
        let r = (larger / smaller).sqrt();
        let eta = if r >= 1.0 { min(r, limit) } else { 1.0 };
        let probes = (1..=16).find(|&n| f32::from(n) >= eta).unwrap_or(16);
        (0.5 * log2(larger / (eta * eta)), probes, step)
    }

    /// λ plus the sampler's and the shader's bias, whose sum is clamped to −16..=15.99.
    #[must_use]
    pub fn biased(&self, lod: f32, shader_bias: f32) -> f32 {
        lod + clamp(self.sampler.lod_bias + shader_bias, -16.0, 15.99)
    }

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
    fn finished(&self, units: [f32; 4]) -> [f32; 4] {
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
    fn slice(&self, layer: i32) -> i64 {
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
    fn place(
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
                FilterMode::Nearest => ([super::nearest(mode, u, n); 2], 0.0),
                FilterMode::Linear => super::linear(mode, u, n),
            };
            return (texels.map(|texel| Some(i64::from(texel))), fraction);
        }
        self.place_in_integers(level, axis, filter, sample)
    }

    /// As [`place`](Self::place), but each of the two texels is wrapped separately: for offsets,
    /// borders and gathering.
    fn place_in_integers(
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

    fn mode(&self, axis: usize) -> AddressMode {
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
    fn four_of_cube(&self, level: usize, sample: &Sample) -> ([[f32; 4]; 4], [f32; 2]) {
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

    /// A texel in units, or the result of its comparison (0 or 1); a coordinate `None` selects the
    /// border.
    fn answer(&self, level: usize, at: [Option<i64>; 3], reference: Option<f32>) -> [f32; 4] {
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
