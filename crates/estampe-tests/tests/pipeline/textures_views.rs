//! Texture views of every dimension, format and sampler, with every sampling function, against the
//! oracle: equal bits at every SIMD level and for every kind of number.

#![expect(
    clippy::cast_possible_truncation,
    reason = "sizes and masks of small textures"
)]

use estampe_reference::texture::ReferenceView;
use estampe_reference::texture::view::Sample;
use estampe_simd::{LANES, Lanes, Level, SimdBase, dispatch, f32x16};
use estampe_tests::Random;
use estampe_texture::{
    Coordinates, LevelData, Lod, MipGeneration, SampledTexture, TexelDescriptor, TexelView,
};
use estampe_types::state::CompareFunction;
use estampe_types::{
    AddressMode, BorderColor, FilterMode, Limits, Pair, Quad, Real, SampleType, SamplerDescriptor,
    TexelData, TexelViewDescriptor, TextureAspect, TextureDimension, TextureFormat, Vec2, Vec3,
    Vec4, ViewDimension,
};
use std::sync::Arc;

/// The sampling functions of a view.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Function {
    Sample,
    Bias,
    Level,
    Gradients,
    Compare,
    CompareLevel,
    Gather(usize),
    GatherCompare,
}

/// The arguments of a sampling function, for the lanes of a packet.
#[derive(Clone, Debug)]
struct Ask {
    function: Function,
    at: [[f32; LANES]; 3],
    layer: [i32; LANES],
    /// The bias, or the level of detail.
    value: [f32; LANES],
    gradients: [[f32; LANES]; 6],
    reference: [f32; LANES],
    offset: [i32; 3],
}

type Answers = [[f32; 4]; LANES];

/// A kind of number that can be built from the lanes from `first` on.
trait Kind: Real {
    fn real(self, from: &[f32; LANES], first: usize) -> Self;
    fn int(self, from: &[i32; LANES], first: usize) -> Self::Int;
}

macro_rules! kinds {
    ($(($($generic:tt)*) $kind:ty;)*) => {$(
        impl $($generic)* Kind for $kind {
            #[inline(always)]
            fn real(self, from: &[f32; LANES], first: usize) -> Self {
                self.with_lanes(
                    #[inline(always)]
                    |lane| from[(first + lane) % LANES],
                )
            }
            #[inline(always)]
            fn int(self, from: &[i32; LANES], first: usize) -> Self::Int {
                let bits = self.with_lanes(
                    #[inline(always)]
                    |lane| f32::from_bits(from[(first + lane) % LANES].cast_unsigned()),
                );
                Real::to_bits(bits)
            }
        }
    )*};
}
kinds! {
    () f32;
    () Quad;
    (<S: Lanes>) f32x16<S>;
    () Pair<Quad>;
}

#[inline(always)]
fn ask<R: Kind>(view: &SampledTexture, ask: &Ask, like: R, first: usize, answers: &mut Answers) {
    let [u, v, w] = [
        like.real(&ask.at[0], first),
        like.real(&ask.at[1], first),
        like.real(&ask.at[2], first),
    ];
    let layer = like.int(&ask.layer, first);
    let at = match view.view().dimension() {
        ViewDimension::D1 => Coordinates::d1(u),
        ViewDimension::D2 => Coordinates::d2(Vec2::new(u, v)),
        ViewDimension::D2Array => Coordinates::d2_array(Vec2::new(u, v), layer),
        ViewDimension::D3 => Coordinates::d3(Vec3::new(u, v, w)),
        ViewDimension::Cube => Coordinates::cube(Vec3::new(u, v, w)),
        ViewDimension::CubeArray => Coordinates::cube_array(Vec3::new(u, v, w), layer),
    };
    let gradient = |k: usize| {
        Vec3::new(
            like.real(&ask.gradients[k], first),
            like.real(&ask.gradients[k + 1], first),
            like.real(&ask.gradients[k + 2], first),
        )
    };
    let value = like.real(&ask.value, first);
    let reference = like.real(&ask.reference, first);
    let flat = [ask.offset[0], ask.offset[1]];
    let only = |answer: R| Vec4::new(answer, like, like, like);
    let color = match ask.function {
        Function::Sample if ask.offset == [0; 3] => view.sample(at),
        Function::Sample => view.sample_with(at, Lod::Implicit, ask.offset),
        Function::Bias => view.sample_with(at, Lod::Bias(value), ask.offset),
        Function::Level => view.sample_with(at, Lod::Level(value), ask.offset),
        Function::Gradients => {
            view.sample_with(at, Lod::Gradients(gradient(0), gradient(3)), ask.offset)
        }
        Function::Compare => only(view.sample_compare(at, reference, Lod::Implicit, flat)),
        Function::CompareLevel => only(view.sample_compare(at, reference, Lod::Level(value), flat)),
        Function::Gather(channel) => view.gather(at, channel, flat),
        Function::GatherCompare => view.gather_compare(at, reference, flat),
    };
    for lane in 0..R::LANES {
        if first + lane < LANES {
            let Vec4 { x, y, z, w } = color;
            answers[first + lane] = [x.lane(lane), y.lane(lane), z.lane(lane), w.lane(lane)];
        }
    }
}

/// The fast path's results for a packet at a SIMD level.
fn packets(level: Level, view: &SampledTexture, question: &Ask) -> Answers {
    #[inline(always)]
    fn wide<S: Lanes>(simd: S, view: &SampledTexture, question: &Ask) -> Answers {
        let mut answers = [[0.0; 4]; LANES];
        let zero: f32x16<S> = SimdBase::splat(simd, 0.0);
        ask(view, question, zero, 0, &mut answers);
        answers
    }
    dispatch!(level, s => wide(s, view, question))
}

/// The oracle's result for a lane, with its quad's derivatives, or without derivatives if
/// `is_alone`.
fn oracle(view: &ReferenceView, ask: &Ask, lane: usize, is_alone: bool) -> [f32; 4] {
    let at_lane = |lane: usize| [0, 1, 2].map(|k| ask.at[k][lane]);
    let quad = if is_alone { lane } else { lane & !3 };
    let difference = |other: usize| {
        let (a, b) = (
            at_lane(quad),
            at_lane(quad + if is_alone { 0 } else { other }),
        );
        [0, 1, 2].map(|k| if is_alone { 0.0 } else { b[k] - a[k] })
    };
    let implicit = || view.footprint(at_lane(quad), difference(1), difference(2));
    let given = |k: usize| [0, 1, 2].map(|i| ask.gradients[k + i][lane]);
    let reference = ask.reference[lane];
    let none = (0.0, 1, [0.0; 3]);
    let ((lod, probes, step), bias) = match ask.function {
        Function::Sample | Function::Compare => (implicit(), 0.0),
        Function::Bias => (implicit(), ask.value[lane]),
        Function::Level | Function::CompareLevel => ((ask.value[lane], 1, [0.0; 3]), 0.0),
        Function::Gradients => (view.footprint(at_lane(lane), given(0), given(3)), 0.0),
        Function::Gather(_) | Function::GatherCompare => (none, 0.0),
    };
    let compares = matches!(
        ask.function,
        Function::Compare | Function::CompareLevel | Function::GatherCompare
    );
    let sample = Sample {
        at: at_lane(lane),
        layer: ask.layer[lane],
        lod: view.biased(lod, bias),
        probes: if compares { 1 } else { probes },
        step,
        offset: ask.offset,
        reference: compares.then_some(reference),
    };
    match ask.function {
        Function::Gather(channel) => view.gather(&sample, channel),
        Function::GatherCompare => view.gather(&sample, 0),
        Function::Compare | Function::CompareLevel => [view.sample(&sample)[0], 0.0, 0.0, 0.0],
        _ => view.sample(&sample),
    }
}

/// The bits, with one pattern for all NaNs: their payloads depend on the processor.
fn bits(channels: [f32; 4]) -> [u32; 4] {
    channels.map(|x| if x.is_nan() { 0x7FC0_0000 } else { x.to_bits() })
}

fn texture(
    random: &mut Random,
    dimension: ViewDimension,
    formats: &[TextureFormat],
) -> Arc<TexelData> {
    use ViewDimension as V;
    let sides = [1, 2, 3, 5, 8, 13, 16];
    let format = random.pick(formats);
    let width = random.pick(&sides);
    let (height, slices) = match dimension {
        V::D1 => (1, 1),
        V::D2 => (random.pick(&sides), 1 + random.below(2)),
        V::D2Array => (random.pick(&sides), 1 + random.below(5)),
        V::Cube => (width, 6 + random.below(3)),
        V::CubeArray => (width, 6 * (1 + random.below(3))),
        V::D3 => (random.pick(&sides), random.pick(&sides)),
    };
    let descriptor = TexelDescriptor {
        dimension: match dimension {
            V::D1 => TextureDimension::D1,
            V::D3 => TextureDimension::D3,
            _ => TextureDimension::D2,
        },
        depth_or_layers: slices,
        ..TexelDescriptor::new_2d(width, height, format)
    };
    let mut descriptor = descriptor.with_all_levels();
    descriptor.mip_level_count -= random.below(descriptor.mip_level_count);
    let shape = estampe_types::TextureShape {
        dimension: descriptor.dimension,
        depth_or_layers: slices,
        samples: 1,
    };
    // Different noise in each mip level, so that no level can be mistaken for another.
    let levels: Vec<Vec<u8>> = (0..descriptor.mip_level_count as usize)
        .map(|level| {
            let [block_width, block_height] = format.block_size();
            let columns = (width >> level).max(1).div_ceil(block_width);
            let rows = (height >> level).max(1).div_ceil(block_height);
            let blocks = columns * rows * shape.slices(level);
            noise(random, format, blocks as usize)
        })
        .collect();
    let data: Vec<_> = levels.iter().map(|bytes| LevelData::tight(bytes)).collect();
    let made = descriptor.create(&data, MipGeneration::None, &Limits::default());
    Arc::new(made.expect("a valid texture"))
}

/// Random bytes of this many blocks; floats are mostly of ordinary magnitude.
fn noise(random: &mut Random, format: TextureFormat, blocks: usize) -> Vec<u8> {
    use estampe_types::TexelEncoding as E;
    let count = blocks * format.block_bytes() as usize;
    let is_odd = random.once_in(4);
    match format.encoding() {
        E::Float32 | E::Depth32 if !is_odd => (0..count / 4)
            .flat_map(|_| random.unit().to_le_bytes())
            .collect(),
        E::Float16 if !is_odd => (0..count / 2)
            .flat_map(|_| [random.byte(), 0x30 | random.byte() & 0x8F])
            .collect(),
        _ => (0..count).map(|_| random.byte()).collect(),
    }
}

fn sampler(random: &mut Random, view: &TexelView) -> SamplerDescriptor {
    use AddressMode as A;
    let modes = [
        A::ClampToEdge,
        A::Repeat,
        A::MirrorRepeat,
        A::MirrorOnce,
        A::ClampToBorder,
    ];
    let kind = view.texture().format.sample_type();
    let filters = match kind {
        SampleType::Uint | SampleType::Sint => [FilterMode::Nearest; 2],
        SampleType::Float | SampleType::Depth => [FilterMode::Nearest, FilterMode::Linear],
    };
    use CompareFunction as C;
    let functions = [
        C::Never,
        C::Less,
        C::Equal,
        C::LessEqual,
        C::Greater,
        C::NotEqual,
        C::GreaterEqual,
        C::Always,
    ];
    let is_anisotropic = filters[1] == FilterMode::Linear && random.once_in(3);
    let mut filter = || {
        if is_anisotropic {
            FilterMode::Linear
        } else {
            random.pick(&filters)
        }
    };
    let [mag_filter, min_filter, mipmap_filter] = [filter(), filter(), filter()];
    SamplerDescriptor {
        address_mode_u: random.pick(&modes),
        address_mode_v: random.pick(&modes),
        address_mode_w: random.pick(&modes),
        mag_filter,
        min_filter,
        mipmap_filter,
        lod_min_clamp: random.pick(&[0.0, 0.0, 0.5, 2.0]),
        lod_max_clamp: random.pick(&[32.0, 32.0, 2.0]),
        lod_bias: random.pick(&[0.0, 0.0, 0.7, -1.3, 40.0]),
        max_anisotropy: if is_anisotropic {
            random.pick(&[2, 3, 8, 16])
        } else {
            1
        },
        border_color: random.pick(&[
            BorderColor::TransparentBlack,
            BorderColor::OpaqueBlack,
            BorderColor::OpaqueWhite,
        ]),
        compare: (kind == SampleType::Depth).then(|| random.pick(&functions)),
    }
}

fn question(random: &mut Random, function: Function, view: &TexelView) -> Ask {
    let is_cube = matches!(
        view.dimension(),
        ViewDimension::Cube | ViewDimension::CubeArray
    );
    let spread = random.pick(&[0.001, 0.02, 0.2, 2.0]);
    let origin = [0; 3].map(|_| random.range(-2.0, 2.0));
    let with_odd = random.once_in(3);
    let at = origin.map(|origin| {
        std::array::from_fn(|_| {
            if with_odd && random.once_in(8) {
                random.odd_number()
            } else if random.once_in(6) {
                // Between texels, on edges and on corners.
                (random.below(33) as f32 - 16.0) / 8.0
            } else {
                origin + random.range(-spread, spread)
            }
        })
    });
    let slope = random.pick(&[0.01, 0.1, 1.0]);
    let mut offset = [0; 3];
    if !is_cube && random.once_in(2) {
        offset = offset.map(|_| random.below(17).cast_signed() - 8);
    }
    Ask {
        function,
        at,
        layer: std::array::from_fn(|_| random.below(8).cast_signed() - 1),
        value: std::array::from_fn(|_| {
            if with_odd && random.once_in(9) {
                random.odd_number()
            } else if random.once_in(3) {
                // Exactly one mip level.
                random.below(4) as f32
            } else {
                random.range(-2.0, 6.0)
            }
        }),
        gradients: [0; 6].map(|_| {
            let skew = random.pick(&[0.05, 1.0]);
            std::array::from_fn(|_| random.range(-slope, slope) * skew)
        }),
        reference: std::array::from_fn(|_| {
            if random.once_in(5) {
                random.odd_number()
            } else {
                random.range(-0.1, 1.1)
            }
        }),
        offset,
    }
}

/// Compares the fast path's results with the oracle's.
fn check(view: &SampledTexture, reference: &ReferenceView, question: &Ask) {
    let compares = !matches!(
        question.function,
        Function::Sample
            | Function::Bias
            | Function::Level
            | Function::Gradients
            | Function::Gather(_)
            | Function::GatherCompare
    );
    let used = |answer: [f32; 4]| {
        if compares {
            [answer[0], 0.0, 0.0, 0.0]
        } else {
            answer
        }
    };
    let same = |kind: &str, lane: usize, got: [f32; 4], wanted: [f32; 4]| {
        let texture = view.view().texture();
        assert_eq!(
            bits(used(got)),
            bits(wanted),
            "{kind}, lane {lane}: {got:?} is not {wanted:?}: {:?} of {:?} {:?}, {:?}, {:?}, at {:?}, {question:?}",
            view.view().dimension(),
            texture.format,
            texture.levels,
            texture.shape,
            view.sampler(),
            [0, 1, 2].map(|k| question.at[k][lane]),
        );
    };
    let wanted: Answers = std::array::from_fn(|lane| oracle(reference, question, lane, false));
    for level in Level::all_available() {
        let view = &view.clone().at_level(level);
        let got = packets(level, view, question);
        for lane in 0..LANES {
            same(level.name(), lane, got[lane], wanted[lane]);
        }
    }
    let mut got = [[0.0; 4]; LANES];
    for first in (0..LANES).step_by(4) {
        ask(view, question, Quad([0.0; 4]), first, &mut got);
    }
    let mut of_pairs = [[0.0; 4]; LANES];
    for first in [0, 8] {
        let pair = Pair(Quad([0.0; 4]), Quad([0.0; 4]));
        ask(view, question, pair, first, &mut of_pairs);
    }
    for lane in 0..LANES {
        same("pair", lane, of_pairs[lane], wanted[lane]);
        same("quad", lane, got[lane], wanted[lane]);
        ask(view, question, 0.0_f32, lane, &mut got);
        let alone = oracle(reference, question, lane, true);
        same("alone", lane, got[lane], alone);
    }
}

fn checks(
    topic: &str,
    count: u64,
    dimensions: &[ViewDimension],
    formats: &[TextureFormat],
    functions: &[Function],
) {
    for seed in 0..count {
        let random = &mut Random::new(topic, seed);
        let dimension = random.pick(dimensions);
        let texture = texture(random, dimension, formats);
        let all = texture.levels.len();
        let base = random.below(2).min(all as u32 - 1) as usize;
        let first = random.below(2).min(match dimension {
            ViewDimension::D1 | ViewDimension::D3 => 0,
            ViewDimension::Cube => texture.shape.depth_or_layers - 6,
            ViewDimension::CubeArray => 0,
            _ => texture.shape.depth_or_layers - 1,
        });
        let aspect = if texture.format.has_stencil() && random.once_in(2) {
            TextureAspect::Stencil
        } else {
            TextureAspect::All
        };
        let descriptor = TexelViewDescriptor {
            dimension: Some(dimension),
            base_mip_level: base as u32,
            base_array_layer: first,
            aspect,
            ..TexelViewDescriptor::default()
        };
        let view = TexelView::new(texture.clone(), &descriptor).expect("a view");
        let mut sampler = sampler(random, &view);
        if aspect == TextureAspect::Stencil {
            sampler = SamplerDescriptor {
                mag_filter: FilterMode::Nearest,
                min_filter: FilterMode::Nearest,
                mipmap_filter: FilterMode::Nearest,
                max_anisotropy: 1,
                compare: None,
                ..sampler
            };
        }
        let rest = texture.shape.depth_or_layers - first;
        let reference = ReferenceView {
            dimension,
            levels: [base, all - base],
            layers: match dimension {
                ViewDimension::D1 | ViewDimension::D2 | ViewDimension::D3 => [first, 1],
                ViewDimension::Cube => [first, 6],
                _ => [first, rest],
            },
            aspect,
            sampler,
            texture,
        };
        let view = SampledTexture::new(view, sampler).expect("a sampler");
        for &function in functions {
            let question = question(random, function, view.view());
            check(&view, &reference, &question);
        }
    }
}

const FUNCTIONS: [Function; 6] = [
    Function::Sample,
    Function::Bias,
    Function::Level,
    Function::Gradients,
    Function::Gather(1),
    Function::Gather(3),
];

fn formats(keep: impl Fn(TextureFormat) -> bool) -> Vec<TextureFormat> {
    let all = TextureFormat::ALL.iter().copied();
    all.filter(|&format| keep(format)).collect()
}

fn is_plain(format: TextureFormat) -> bool {
    format.is_color() && !format.is_compressed()
}

/// Rows: F2.
#[test]
fn images_and_arrays_of_every_format() {
    use ViewDimension::{D2, D2Array};
    checks(
        "views/2d",
        1200,
        &[D2, D2Array],
        TextureFormat::ALL,
        &FUNCTIONS,
    );
}

/// Rows: F2.
#[test]
fn rows_and_blocks_of_texels() {
    use ViewDimension::{D1, D3};
    checks(
        "views/1d 3d",
        900,
        &[D1, D3],
        &formats(is_plain),
        &FUNCTIONS,
    );
}

/// Rows: F2.
#[test]
fn cubes_without_seams() {
    use ViewDimension::{Cube, CubeArray};
    let formats = formats(|format| is_plain(format) || format.block_size() == [4, 4]);
    checks(
        "views/cubes",
        1200,
        &[Cube, CubeArray],
        &formats,
        &FUNCTIONS,
    );
}

/// Rows: F2.
#[test]
fn comparisons_with_every_function() {
    use ViewDimension::{Cube, CubeArray, D2, D2Array};
    let depths = formats(TextureFormat::has_depth);
    let functions = [
        Function::Compare,
        Function::CompareLevel,
        Function::GatherCompare,
        Function::Sample,
        Function::Gather(0),
    ];
    let dimensions = [D2, D2Array, Cube, CubeArray];
    checks("views/compare", 900, &dimensions, &depths, &functions);
}

/// Rows: F2.
#[test]
fn common_2d_views_equal_the_oracle() {
    // `SampledTexture` passes these views to `Rgba8Texture`; the oracle samples all views with the
    // same code.
    let formats = [
        TextureFormat::Rgba8Unorm,
        TextureFormat::Bgra8UnormSrgb,
        TextureFormat::Bc1RgbaUnorm,
    ];
    for seed in 0..400 {
        let random = &mut Random::new("views/common", seed);
        let texture = texture(random, ViewDimension::D2Array, &formats);
        let texture = TexelData {
            shape: estampe_types::TextureShape::default(),
            ..TexelData::clone(&texture)
        };
        // The first layer with its first mip level.
        let texture = Arc::new(TexelData {
            levels: texture.levels[..1].to_vec(),
            ..texture
        });
        let view = TexelView::of(texture.clone()).expect("a view");
        let sampler = SamplerDescriptor {
            mag_filter: random.pick(&[FilterMode::Nearest, FilterMode::Linear]),
            address_mode_u: random.pick(&[AddressMode::Repeat, AddressMode::MirrorRepeat]),
            ..SamplerDescriptor::default()
        };
        let reference = ReferenceView {
            texture,
            dimension: ViewDimension::D2,
            levels: [0, 1],
            layers: [0, 1],
            aspect: TextureAspect::All,
            sampler,
        };
        let view = SampledTexture::new(view, sampler).expect("a sampler");
        let question = Ask {
            offset: [0; 3],
            ..question(random, Function::Sample, view.view())
        };
        check(&view, &reference, &question);
    }
}

#[test]
fn a_mip_level_of_weight_zero_has_no_effect() {
    // In lanes beside some that mix two levels: ∞ times a weight of 0 would be NaN.
    let bytes = [0.5_f32; 16].map(f32::to_le_bytes);
    let (one, infinity) = (
        [1.0_f32; 4].map(f32::to_le_bytes),
        f32::INFINITY.to_le_bytes(),
    );
    let data = [
        LevelData::tight(bytes.as_flattened()),
        LevelData::tight(one.as_flattened()),
        LevelData::tight(&infinity),
    ];
    let descriptor = TexelDescriptor::new_2d(4, 4, TextureFormat::R32Float).with_all_levels();
    let texture = descriptor.create(&data, MipGeneration::None, &Limits::default());
    let texture = Arc::new(texture.expect("a texture"));
    let sampler = SamplerDescriptor {
        mipmap_filter: FilterMode::Linear,
        ..SamplerDescriptor::default()
    };
    let reference = ReferenceView::of_image(texture.clone(), sampler);
    let view = TexelView::of(texture).expect("a view");
    let view = SampledTexture::new(view, sampler).expect("a sampler");
    let question = Ask {
        function: Function::Level,
        at: [[0.25; LANES]; 3],
        layer: [0; LANES],
        value: std::array::from_fn(|lane| 1.0 + (lane % 3) as f32 * 0.25),
        gradients: [[0.0; LANES]; 6],
        reference: [0.0; LANES],
        offset: [0; 3],
    };
    check(&view, &reference, &question);
    assert_eq!(
        oracle(&reference, &question, 0, false),
        [1.0, 0.0, 0.0, 1.0]
    );
    assert_eq!(oracle(&reference, &question, 1, false)[0], f32::INFINITY);
}
