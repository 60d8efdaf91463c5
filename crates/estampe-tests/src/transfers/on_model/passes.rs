//! Passes on the oracle's plain textures.

use super::Model;
use crate::geometry::{Vertex, vertex_buffer, vertex_layout};
use crate::oracle;
use crate::shaders::{Textured, value_at};
use crate::transfers::sequence::{
    ColorUse, ComparedDraw, DepthUse, Draws, ImageAt, Pass, TexturedDraw,
};
use crate::{Case, CaseDraw};
use estampe::ResolveMode;
use estampe_reference::depth_map::DepthMap;
use estampe_reference::texture::ReferenceView;
use estampe_reference::transfer::attachment;
use estampe_reference::{Draw, State, Target, color};
use estampe_types::shader::{Shader, VertexOut};
use estampe_types::{
    Bindings, FragmentIn, FragmentOut, SampleType, TextureFormat, Vec2, Vec4, VertexIn,
};

impl Model {
    /// Draws a pass.
    pub(super) fn render(&mut self, pass: &Pass) {
        let depth_format = pass.depth_stencil.map(|depth| self.format(depth.image));
        let mut target =
            Target::with_attachments(pass.size, pass.samples, &pass.formats(), depth_format);
        for (number, color) in pass.colors.iter().enumerate() {
            match color.clear {
                Some(value) => target.clear_color(number, value),
                None => attachment::load_color(&mut target, number, self.image(color.image)),
            }
        }
        if let Some(depth) = &pass.depth_stencil {
            attachment::load_depth_stencil(&mut target, self.image(depth.image));
            if let Some(value) = depth.depth.and_then(|depth| depth.clear) {
                target.clear_depth(value);
            }
            if let Some(value) = depth.stencil.and_then(|stencil| stencil.clear) {
                target.clear_stencil(value);
            }
        }
        match &pass.draws {
            Draws::Cases(draws) => {
                let case = case_of(pass, depth_format);
                for draw in draws {
                    oracle::draw_one(&mut target, draw, &case);
                }
            }
            Draws::Textured(draw) => self.draw_textured(&mut target, draw),
            Draws::Compared(draw) => self.draw_compared(&mut target, draw),
        }
        for (number, color) in pass.colors.iter().enumerate() {
            self.store_color(&target, number, color);
        }
        if let Some(depth) = &pass.depth_stencil {
            self.store_depth_stencil(&target, depth);
        }
    }

    fn format(&self, image: ImageAt) -> TextureFormat {
        self.textures[image.texture].format
    }

    fn draw_textured(&self, target: &mut Target, draw: &TexturedDraw) {
        let [first, count] = draw.levels;
        let shader = Textured {
            texels: ReferenceView {
                levels: [first as usize, count as usize],
                layers: [draw.layer, 1],
                ..ReferenceView::of_image(self.sampled(draw.texture, draw.format), draw.sampler)
            },
            channel: None,
        };
        draw_list(target, &shader, &draw.vertices);
    }

    fn draw_compared(&self, target: &mut Target, draw: &ComparedDraw) {
        let image = self.image(draw.image);
        let format = self.format(draw.image);
        let texels = image.rows.iter().flat_map(|row| {
            let texels = row.chunks(format.block_bytes() as usize);
            texels.map(|texel| attachment::depth(format, texel))
        });
        let shader = Compared {
            map: DepthMap {
                width: image.size[0],
                height: image.size[1],
                rows: texels.collect(),
            },
            reference: draw.reference,
        };
        draw_list(target, &shader, &draw.vertices);
    }

    /// Stores the value of each place to an image.
    pub(super) fn store(&mut self, at: ImageAt) {
        let format = self.format(at);
        let is_integer = format.sample_type() != SampleType::Float;
        let image = self.image_mut(at);
        for (y, row) in image.rows.iter_mut().enumerate() {
            let texels = row.chunks_mut(format.block_bytes() as usize);
            for (x, texel) in texels.enumerate() {
                let [x, y] = [x, y].map(|place| place as f32 + 0.5);
                let Vec4 { x, y, z, w } = value_at(x, y, is_integer);
                let codes = color::encode(format, [x, y, z, w]);
                texel.copy_from_slice(&color::bytes(format, codes));
            }
        }
    }

    fn store_color(&mut self, target: &Target, number: usize, color: &ColorUse) {
        if let Some(resolve) = color.resolve {
            attachment::resolve_color(target, number, self.image_mut(resolve));
        }
        let image = self.image_mut(color.image);
        if color.is_stored {
            attachment::store_color(target, number, image);
        } else {
            image.rows.iter_mut().for_each(|row| row.fill(0));
        }
    }

    fn store_depth_stencil(&mut self, target: &Target, depth: &DepthUse) {
        let format = self.format(depth.image);
        if let Some((into, modes)) = depth.resolve {
            let mut resolved = Target::with_attachments(
                [target.width, target.height],
                1,
                &[],
                target.depth_stencil,
            );
            attachment::load_depth_stencil(&mut resolved, self.image(into));
            resolve(target, &mut resolved, modes);
            attachment::store_depth_stencil(&resolved, self.image_mut(into));
        }
        if !depth.is_written(format) {
            return;
        }
        let mut target = target.clone();
        if depth.depth.is_some_and(|depth| !depth.is_stored) {
            target.depth.fill(0.0);
        }
        if depth.stencil.is_some_and(|stencil| !stencil.is_stored) {
            target.stencil.fill(0);
        }
        attachment::store_depth_stencil(&target, self.image_mut(depth.image));
    }
}

/// Draws a triangle list over a target.
fn draw_list(target: &mut Target, shader: &impl Shader, vertices: &[Vertex]) {
    let state = State::new(target.width, target.height);
    let buffers = [(vertex_layout(), vertex_buffer(vertices))];
    let command = Draw {
        buffers: &buffers,
        indices: None,
        vertices: 0..u32::try_from(vertices.len()).expect("few vertices"),
        instances: 0..1,
        base_vertex: 0,
        bindings: &Bindings::default(),
    };
    estampe_reference::draw(target, shader, &state, &command);
}

/// The oracle's form of [`BoundDepth`](crate::shaders::BoundDepth).
#[derive(Debug)]
struct Compared {
    map: DepthMap,
    reference: f32,
}

estampe_types::shader! {
    impl Shader for Compared {
        type Attributes<R: Real> = (Vec4<R>, Vec4<R>);
        type Varyings<R: Real> = Vec2<R>;

        fn vertex<R: Real>(
            &self,
            _input: VertexIn<'_, R>,
            (position, values): (Vec4<R>, Vec4<R>),
        ) -> VertexOut<R, Vec2<R>> {
            VertexOut::new(position, Vec2::new(values.x, values.y))
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, uv: Vec2<R>) -> FragmentOut<R> {
            let share = uv.x.with_lanes(|lane| {
                let at = [uv.x.lane(lane), uv.y.lane(lane)];
                self.map.sample_compare_level(at, self.reference)
            });
            FragmentOut::color(Vec4::new(share, share * 0.5, input.real(0.25), input.real(1.0)))
        }
    }
}

/// The case of which the draws of a pass are.
#[must_use]
pub fn case_of(pass: &Pass, depth_stencil: Option<TextureFormat>) -> Case {
    let formats = pass.formats();
    let draws: Vec<CaseDraw> = match &pass.draws {
        Draws::Cases(draws) => draws.clone(),
        Draws::Textured(_) | Draws::Compared(_) => Vec::new(),
    };
    Case {
        format: formats.first().copied(),
        more_formats: formats.iter().skip(1).copied().collect(),
        depth_stencil,
        draws,
        ..Case::new(pass.size, pass.samples)
    }
}

/// The values of the samples of each pixel, by the modes of depth and stencil.
fn resolve(from: &Target, into: &mut Target, [depth, stencil]: [Option<ResolveMode>; 2]) {
    let samples = from.samples as usize;
    if let Some(mode) = depth {
        for (to, samples) in into.depth.iter_mut().zip(from.depth.chunks(samples)) {
            *to = match mode {
                ResolveMode::SampleZero => samples[0],
                ResolveMode::Min => samples.iter().copied().fold(1.0, f32::min),
                ResolveMode::Max => samples.iter().copied().fold(0.0, f32::max),
                _ => {
                    let sum = samples.iter().copied().reduce(|sum, depth| sum + depth);
                    from.quantised(sum.unwrap_or_default() / samples.len() as f32)
                }
            };
        }
    }
    if let Some(mode) = stencil {
        for (to, samples) in into.stencil.iter_mut().zip(from.stencil.chunks(samples)) {
            *to = match mode {
                ResolveMode::Min => samples.iter().copied().min().unwrap_or_default(),
                ResolveMode::Max => samples.iter().copied().max().unwrap_or_default(),
                _ => samples[0],
            };
        }
    }
}
