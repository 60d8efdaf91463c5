//! Random draws of different pipelines over the same pixels of one target.
//!
//! A pass of a renderer has draws that test depth in different ways, blend, discard, write and test
//! the stencil, and often draw the same triangles again. [`Mixture`] describes the draws of a case;
//! [`Mixture::case`] makes one.

use crate::geometry::{Style, Vertex, triangles};
use crate::shaders::{
    Colored, CutLayers, Cutout, CutoutDepth, DepthGiven, DepthOnly, FlatColored, GivenDepth,
    Halved, Layers, Probe,
};
use crate::{Case, CaseDraw, Random, TestShader};
use estampe_types::state::{
    BlendComponent, BlendFactor, BlendOperation, BlendState, ColorWrites, CompareFunction,
    CullMode, DepthBiasState, DepthState, FrontFace, PrimitiveTopology, ScissorRect,
    StencilFaceState, StencilOperation, StencilState, Viewport,
};
use estampe_types::{SampleType, TextureFormat};

/// All comparison functions; those that order depths occur more often.
const COMPARISONS: [CompareFunction; 12] = [
    CompareFunction::Less,
    CompareFunction::Less,
    CompareFunction::LessEqual,
    CompareFunction::LessEqual,
    CompareFunction::Greater,
    CompareFunction::GreaterEqual,
    CompareFunction::Equal,
    CompareFunction::Equal,
    CompareFunction::NotEqual,
    CompareFunction::Always,
    CompareFunction::Always,
    CompareFunction::Never,
];

const OPERATIONS: [StencilOperation; 8] = [
    StencilOperation::Keep,
    StencilOperation::Zero,
    StencilOperation::Replace,
    StencilOperation::Invert,
    StencilOperation::IncrementClamp,
    StencilOperation::DecrementClamp,
    StencilOperation::IncrementWrap,
    StencilOperation::DecrementWrap,
];

const FACTORS: [BlendFactor; 9] = [
    BlendFactor::Zero,
    BlendFactor::One,
    BlendFactor::Src,
    BlendFactor::SrcAlpha,
    BlendFactor::OneMinusSrcAlpha,
    BlendFactor::Dst,
    BlendFactor::OneMinusDstAlpha,
    BlendFactor::SrcAlphaSaturated,
    BlendFactor::Constant,
];

/// Depths for whole triangles, so that many samples of different draws are equal.
const DEPTHS: [f32; 6] = [0.0, 0.25, 0.5, 0.500_001, 0.75, 1.0];

/// The target and the kinds of draws of a case.
#[derive(Debug, Clone)]
pub struct Mixture {
    /// Formats of the colour attachments; none for a target without colour.
    pub formats: Vec<TextureFormat>,
    /// Format of the depth-stencil attachment, if there is one.
    pub depth_stencil: Option<TextureFormat>,
    /// Samples per pixel.
    pub samples: u32,
    /// Styles of the triangles.
    pub styles: Vec<Style>,
    /// The greatest number of triangles per draw.
    pub triangles: u32,
    /// The number of draws.
    pub draws: u32,
}

impl Mixture {
    /// Six draws of a few large and small triangles.
    #[must_use]
    pub fn new(
        formats: &[TextureFormat],
        depth_stencil: Option<TextureFormat>,
        samples: u32,
    ) -> Self {
        Self {
            formats: formats.to_vec(),
            depth_stencil,
            samples,
            styles: vec![Style::Large, Style::Large, Style::Small, Style::OnGrid],
            triangles: 6,
            draws: 6,
        }
    }

    /// A random case of such draws.
    ///
    /// # Panics
    /// With more than four formats: no shader has that many colours.
    pub fn case(&self, random: &mut Random) -> Case {
        let sizes = [[64, 64], [33, 20], [70, 41], [130, 66], [19, 21]];
        let mut case = Case::new(random.pick(&sizes), self.samples);
        case.format = self.formats.first().copied();
        case.more_formats = self.formats.iter().skip(1).copied().collect();
        case.depth_stencil = self.depth_stencil;
        case.clear_color = random.four(0.0, 1.0);
        case.clear_depth = random.pick(&[1.0, 1.0, 0.5, 0.0]);
        case.clear_stencil = random.pick(&[0, 0, 1, 2, 0xFF]);
        let mut before: Option<Vec<Vertex>> = None;
        for _ in 0..self.draws {
            // A third of the draws repeats the triangles of the previous one: their depths are
            // equal to the bit.
            let vertices = match before.take() {
                Some(vertices) if random.once_in(3) => vertices,
                _ => self.vertices(random, case.size),
            };
            let draw = self.draw(random, &case, &vertices);
            before = Some(vertices);
            case.draws.push(draw);
        }
        if random.once_in(4) {
            case.second_pass = random.index(case.draws.len());
        }
        case
    }

    fn vertices(&self, random: &mut Random, size: [u32; 2]) -> Vec<Vertex> {
        let style = random.pick(&self.styles);
        let count = 1 + random.below(self.triangles);
        let mut vertices = triangles(random, style, size, count);
        for triangle in vertices.chunks_exact_mut(3) {
            if random.once_in(2) {
                let depth = random.pick(&DEPTHS);
                for vertex in triangle {
                    vertex.position[2] = depth * vertex.position[3];
                }
            }
        }
        vertices
    }

    /// One draw with a pipeline of its own.
    pub fn draw(&self, random: &mut Random, case: &Case, vertices: &[Vertex]) -> CaseDraw {
        let mut draw = CaseDraw::new(self.shader(random), vertices);
        let has = |what: fn(TextureFormat) -> bool| self.depth_stencil.is_some_and(what);
        draw.depth = (has(TextureFormat::has_depth) && !random.once_in(6)).then(|| depth(random));
        if has(TextureFormat::has_stencil) && !random.once_in(3) {
            draw.stencil = Some(stencil(random));
            draw.stencil_reference = [random.pick(&[0, 1, 1, 2, 0xFF]), random.pick(&[0, 1, 2])];
        }
        self.set_targets(random, &mut draw);
        set_primitives(random, &mut draw);
        set_window(random, case.size, &mut draw);
        draw.is_counted = random.once_in(2);
        if self.samples > 1 && random.once_in(6) {
            draw.sample_mask = random.bits();
        }
        if self.samples > 1 && random.once_in(8) {
            draw.alpha_to_coverage = true;
        }
        if has(TextureFormat::has_depth) && random.once_in(10) {
            draw.depth_bounds = Some(random.pick(&[[0.0, 0.5], [0.25, 1.0], [0.3, 0.7]]));
        }
        draw
    }

    /// A shader with a colour for each format: opaque, discarding, or writing depth.
    fn shader(&self, random: &mut Random) -> TestShader {
        let integers = self
            .formats
            .iter()
            .enumerate()
            .fold(0, |bits, (k, format)| {
                bits | u8::from(format.sample_type() != SampleType::Float) << k
            });
        let discards = random.once_in(4);
        match self.formats.len() {
            0 => DepthOnly.into(),
            1 if integers == 0 => shader_of_one(random),
            1 if discards => CutLayers::<1>(integers).into(),
            1 => Layers::<1>(integers).into(),
            2 if discards => CutLayers::<2>(integers).into(),
            2 => Layers::<2>(integers).into(),
            3 => Layers::<3>(integers).into(),
            4 if discards => CutLayers::<4>(integers).into(),
            4 => Layers::<4>(integers).into(),
            more => panic!("no shader has {more} colours"),
        }
    }

    /// Sets blending and write masks: often none, often the common ones.
    fn set_targets(&self, random: &mut Random, draw: &mut CaseDraw) {
        let mut state = |format: TextureFormat| {
            let blend = match random.below(6) {
                0 => Some(BlendState::ALPHA_BLENDING),
                1 => Some(BlendState::PREMULTIPLIED_ALPHA_BLENDING),
                2 => Some(any_blend(random)),
                _ => None,
            };
            let writes = match random.below(8) {
                0 => ColorWrites::NONE,
                1 => ColorWrites(random.byte() & 0xF),
                _ => ColorWrites::ALL,
            };
            (blend.filter(|_| format.is_blendable()), writes)
        };
        let states: Vec<_> = self.formats.iter().map(|&format| state(format)).collect();
        if let Some((&(blend, write_mask), more)) = states.split_first() {
            (draw.blend, draw.write_mask) = (blend, write_mask);
            draw.more_targets = more.to_vec();
        }
        draw.blend_constant = random.four(0.0, 1.0);
    }
}

/// A shader with one colour of floats.
fn shader_of_one(random: &mut Random) -> TestShader {
    match random.below(10) {
        0 | 1 => Cutout.into(),
        2 => DepthGiven(random.pick(&[GivenDepth::Value, GivenDepth::Moved])).into(),
        3 => CutoutDepth(GivenDepth::Moved).into(),
        4 => FlatColored.into(),
        5 => Halved.into(),
        6 => Probe::random(random).into(),
        _ => Colored.into(),
    }
}

fn any_blend(random: &mut Random) -> BlendState {
    let mut component = || BlendComponent {
        operation: random.pick(&[
            BlendOperation::Add,
            BlendOperation::Add,
            BlendOperation::Subtract,
            BlendOperation::ReverseSubtract,
            BlendOperation::Min,
            BlendOperation::Max,
        ]),
        src_factor: random.pick(&FACTORS),
        dst_factor: random.pick(&FACTORS),
    };
    BlendState {
        color: component(),
        alpha: component(),
    }
}

fn depth(random: &mut Random) -> DepthState {
    DepthState {
        compare: random.pick(&COMPARISONS),
        write_enabled: !random.once_in(4),
    }
}

/// A common use of stencil (write a mark where something is drawn, draw where it is marked, count
/// faces), or a random one.
fn stencil(random: &mut Random) -> StencilState {
    let keep = StencilFaceState::default();
    match random.below(5) {
        0 => StencilState::from(StencilFaceState {
            pass_op: StencilOperation::Replace,
            ..keep
        }),
        1 => StencilState::from(StencilFaceState {
            compare: random.pick(&[CompareFunction::Equal, CompareFunction::NotEqual]),
            write_mask: 0,
            ..keep
        }),
        2 => StencilState {
            front: StencilFaceState {
                depth_fail_op: StencilOperation::DecrementWrap,
                ..keep
            },
            back: StencilFaceState {
                depth_fail_op: StencilOperation::IncrementWrap,
                ..keep
            },
        },
        3 => StencilState::from(StencilFaceState {
            compare: CompareFunction::Equal,
            pass_op: StencilOperation::IncrementClamp,
            ..keep
        }),
        _ => StencilState {
            front: any_face(random),
            back: any_face(random),
        },
    }
}

fn any_face(random: &mut Random) -> StencilFaceState {
    StencilFaceState {
        compare: random.pick(&COMPARISONS),
        fail_op: random.pick(&OPERATIONS),
        depth_fail_op: random.pick(&OPERATIONS),
        pass_op: random.pick(&OPERATIONS),
        read_mask: random.pick(&[0xFF, 0xFF, 0x03, 0xF0]),
        write_mask: random.pick(&[0xFF, 0xFF, 0x01, 0x7F, 0]),
    }
}

fn set_primitives(random: &mut Random, draw: &mut CaseDraw) {
    use PrimitiveTopology as T;
    if random.once_in(8) {
        let topologies = [T::TriangleStrip, T::LineList, T::LineStrip, T::PointList];
        draw.primitive.topology = random.pick(&topologies);
    }
    draw.primitive.cull_mode = random.pick(&[
        CullMode::None,
        CullMode::None,
        CullMode::None,
        CullMode::Back,
        CullMode::Front,
    ]);
    draw.primitive.front_face = random.pick(&[FrontFace::Ccw, FrontFace::Cw]);
    if random.once_in(8) {
        draw.depth_bias = DepthBiasState {
            constant: random.pick(&[1.0, -2.0, 300.0]),
            slope_scale: random.pick(&[0.0, 1.0]),
            clamp: 0.0,
        };
    }
}

/// Sometimes sets a scissor or a viewport that is a part of the target.
fn set_window(random: &mut Random, [width, height]: [u32; 2], draw: &mut CaseDraw) {
    if random.once_in(3) {
        let (x, y) = (random.below(width), random.below(height));
        draw.scissor = Some(ScissorRect {
            x,
            y,
            width: 1 + random.below(width - x),
            height: 1 + random.below(height - y),
        });
    }
    if random.once_in(8) {
        draw.viewport = Some(Viewport {
            x: random.range(0.0, width as f32 / 2.0),
            y: random.range(0.0, height as f32 / 2.0),
            width: width as f32 / 2.0,
            height: height as f32 / 2.0,
            min_depth: random.pick(&[0.0, 0.25]),
            max_depth: random.pick(&[1.0, 0.75]),
        });
    }
}
