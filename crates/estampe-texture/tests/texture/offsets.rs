//! Samples and comparisons of sixteen lanes with an offset give what each lane gives alone, and
//! need the scalar code for borders alone.

use super::Random;
use estampe_format::TexelCodec;
use estampe_simd::{LANES, Level, Packet};
use estampe_texture::{
    AddressMode, FilterMode, Limits, MipGeneration, PacketLod, PacketRequest, SampledTexture,
    SamplerDescriptor, TexelDescriptor, TexelView, TexelViewDescriptor, TextureDimension,
    TextureFormat, ViewDimension,
};
use estampe_types::state::CompareFunction;
use estampe_types::{BorderColor, SampleType};

const SIZES: [[u32; 2]; 8] = [
    [1, 1],
    [1, 7],
    [5, 1],
    [2, 2],
    [3, 6],
    [37, 5],
    [8, 8],
    [16, 33],
];

const MODES: [AddressMode; 5] = [
    AddressMode::ClampToEdge,
    AddressMode::Repeat,
    AddressMode::MirrorRepeat,
    AddressMode::MirrorOnce,
    AddressMode::ClampToBorder,
];

const FUNCTIONS: [CompareFunction; 8] = [
    CompareFunction::Never,
    CompareFunction::Less,
    CompareFunction::Equal,
    CompareFunction::LessEqual,
    CompareFunction::Greater,
    CompareFunction::NotEqual,
    CompareFunction::GreaterEqual,
    CompareFunction::Always,
];

const ODD: [f32; 14] = [
    f32::NAN,
    f32::INFINITY,
    f32::NEG_INFINITY,
    f32::MAX,
    -1e30,
    16_777_217.0,
    -16_777_216.0,
    8_388_609.0,
    -1e6,
    -0.0,
    1.0,
    -1.0,
    1e-40,
    0.999_999_94,
];

/// An element of a list.
pub(super) fn any_of<T: Copy>(all: &[T], random: &mut Random) -> T {
    all[random.bits() as usize % all.len()]
}

/// A sampled view of random texels, in two levels, without the texture's first layer; `None` if the
/// format does not have the dimension. Depths have comparisons.
pub(super) fn sampled_of(
    format: TextureFormat,
    dimension: ViewDimension,
    random: &mut Random,
) -> Option<SampledTexture> {
    use ViewDimension as V;
    let (of_texture, layers) = match dimension {
        V::D1 => (TextureDimension::D1, 1),
        V::D3 => (TextureDimension::D3, 5),
        _ => (TextureDimension::D2, 4),
    };
    let create = |[width, height]: [u32; 2]| {
        let has_levels = dimension != V::D1 && width.max(height) > 1;
        let descriptor = TexelDescriptor {
            dimension: of_texture,
            width,
            height: if dimension == V::D1 { 1 } else { height },
            depth_or_layers: layers,
            mip_level_count: if has_levels { 2 } else { 1 },
            sample_count: 1,
            format,
        };
        let limits = Limits::default();
        descriptor.create(&[], MipGeneration::None, &limits).ok()
    };
    // Formats of blocks have sides of whole blocks only.
    let mut texture = create(any_of(&SIZES, random)).or_else(|| create([8, 8]))?;
    let is_depth = texture.stored_format().has_depth();
    let common = [0, 0xFFFF, 0xFF_FFFF, 0.5_f32.to_bits(), 1.0_f32.to_bits()];
    let mut word = || {
        let of_noise = (random.bits() << 8) ^ random.bits();
        if is_depth && random.bits().is_multiple_of(2) {
            any_of(&common, random)
        } else {
            of_noise
        }
    };
    let words: Vec<u32> = texture.texels.iter().map(|_| word()).collect();
    texture.texels = std::sync::Arc::new(words.into());
    let is_layered = matches!(dimension, V::D2 | V::D2Array);
    let descriptor = TexelViewDescriptor {
        dimension: Some(dimension),
        base_array_layer: u32::from(is_layered),
        ..TexelViewDescriptor::default()
    };
    let view = TexelView::new(texture, &descriptor).ok()?;
    let filters = [FilterMode::Nearest, FilterMode::Linear];
    let mut filter = || {
        if has_packet_code(format) {
            any_of(&filters, random)
        } else {
            FilterMode::Nearest
        }
    };
    let [mag_filter, min_filter, mipmap_filter] = [filter(), filter(), filter()];
    let is_compared = TexelCodec::new(format).sample_type() == SampleType::Depth;
    let sampler = SamplerDescriptor {
        address_mode_u: any_of(&MODES, random),
        address_mode_v: any_of(&MODES, random),
        address_mode_w: any_of(&MODES, random),
        mag_filter,
        min_filter,
        mipmap_filter,
        compare: (is_compared && dimension != V::D3).then(|| any_of(&FUNCTIONS, random)),
        border_color: any_of(
            &[
                BorderColor::TransparentBlack,
                BorderColor::OpaqueBlack,
                BorderColor::OpaqueWhite,
            ],
            random,
        ),
        ..SamplerDescriptor::default()
    };
    Some(SampledTexture::new(view, sampler).expect("a valid sampler"))
}

/// Returns true if packet code reads the format: it is one of numbers.
pub(super) fn has_packet_code(format: TextureFormat) -> bool {
    let sample_type = TexelCodec::new(format).sample_type();
    matches!(sample_type, SampleType::Float | SampleType::Depth)
}

/// Returns true if one of the first axes has borders.
pub(super) fn has_borders(sampled: &SampledTexture, axes: usize) -> bool {
    let sampler = sampled.sampler();
    let modes = [
        sampler.address_mode_u,
        sampler.address_mode_v,
        sampler.address_mode_w,
    ];
    modes[..axes].contains(&AddressMode::ClampToBorder)
}

/// What sixteen lanes ask for.
pub(super) struct Asked {
    at: [Packet<f32>; 3],
    layer: Packet<u32>,
    lod: Packet<f32>,
    reference: Packet<f32>,
    offset: [i32; 3],
}

impl Asked {
    /// Coordinates near the first tile, at borders and centres of texels, far away, and no numbers.
    pub(super) fn new(sampled: &SampledTexture, random: &mut Random) -> Self {
        let size = sampled.view().size(0).map(|side| side as f32);
        let kind = random.bits() % 6;
        let mut coordinate = |length: f32| match (kind, random.bits() % 5) {
            (0, _) => random.unit(),
            (_, 0) => random.unit() * 1.4 - 0.2,
            (_, 1) => (random.bits() % 65) as f32 * 0.5 / length - 8.0 / length,
            (_, 2) => random.unit() * 2000.0 - 1000.0,
            (1, _) => any_of(&ODD, random),
            (2, _) => any_of(&ODD, random) / length,
            _ => random.unit() * 8.0 - 4.0,
        };
        let mut axis = |length: f32| Packet([0.0; LANES].map(|_: f32| coordinate(length)));
        let at = [axis(size[0]), axis(size[1]), axis(size[2])];
        let references = [0.0, 1.0, 0.5, -1.0, 2.0, f32::NAN];
        let mut offset = || match random.bits() % 20 {
            0 => any_of(&[i32::MIN, -1024, 1023, 5000], random),
            1..4 => 0,
            _ => (random.bits() % 17).cast_signed() - 8,
        };
        Self {
            at,
            offset: [offset(), offset(), offset()],
            layer: Packet([0; LANES].map(|_: u32| (random.bits() % 6).wrapping_sub(1))),
            lod: Packet([0.0; LANES].map(|_: f32| random.unit() * 3.0 - 1.0)),
            reference: Packet([0.0; LANES].map(|_: f32| any_of(&references, random))),
        }
    }

    pub(super) fn request(&self) -> PacketRequest<'_> {
        PacketRequest {
            at: self.at.each_ref(),
            layer: &self.layer,
            lod: PacketLod::Level,
            value: &self.lod,
            reference: &self.reference,
            offset: self.offset,
            ..PacketRequest::ZEROS
        }
    }

    /// The results of lanes that ask one by one, for which there is no packet code.
    pub(super) fn one_by_one(
        &self,
        ask: impl Fn(&PacketRequest<'_>, &mut [Packet<f32>; 4]),
    ) -> [Packet<f32>; 4] {
        let mut results = [Packet::default(); 4];
        for lane in 0..LANES {
            let alone = |packet: &Packet<f32>| Packet([packet.0[lane]; LANES]);
            let one = Self {
                at: self.at.each_ref().map(alone),
                layer: Packet([self.layer.0[lane]; LANES]),
                lod: alone(&self.lod),
                reference: alone(&self.reference),
                offset: self.offset,
            };
            let request = PacketRequest {
                count: 1,
                ..one.request()
            };
            let mut result = [Packet::default(); 4];
            ask(&request, &mut result);
            for (to, from) in results.iter_mut().zip(result) {
                to.0[lane] = from.0[0];
            }
        }
        results
    }
}

/// The bits of numbers. Mixing two NaNs gives either of them.
fn bits(channels: &[Packet<f32>]) -> Vec<[u32; LANES]> {
    let of = |number: f32| if number.is_nan() { f32::NAN } else { number }.to_bits();
    channels.iter().map(|packet| packet.0.map(of)).collect()
}

#[test]
fn lanes_with_an_offset_are_sampled_as_alone() {
    use ViewDimension as V;
    let random = &mut Random::new(51);
    let (mut without_borders, mut outside, mut inside) = (0, 0, 0);
    for &format in TextureFormat::ALL {
        for (axes, dimension) in [(1, V::D1), (2, V::D2), (2, V::D2Array), (3, V::D3)] {
            for _ in 0..8 {
                let Some(sampled) = sampled_of(format, dimension, random) else {
                    break;
                };
                let asked = Asked::new(&sampled, random);
                let compares =
                    sampled.sampler().compare.is_some() && random.bits().is_multiple_of(2);
                let alone = asked.one_by_one(|request, colors| {
                    if compares {
                        sampled.compare_request(request, &mut colors[0]);
                    } else {
                        sampled.sample_request(request, colors);
                    }
                });
                for level in Level::all_available() {
                    let sampled = sampled.clone().at_level(level);
                    let mut colors = [Packet([7.0; LANES]); 4];
                    let again = sampled.sample_by_packet(&asked.request(), compares, &mut colors);
                    let has_code = has_packet_code(format) && !level.is_scalar();
                    assert_eq!(again.is_some(), has_code, "{format:?} {}", level.name());
                    let Some(again) = again else {
                        continue;
                    };
                    if has_borders(&sampled, axes) {
                        outside += again.count_ones();
                        inside += again.count_zeros() - 16;
                    } else {
                        assert_eq!(again, 0, "{format:?} {:?}", sampled.sampler());
                        without_borders += 1;
                    }
                    let channels = if compares { 1 } else { 4 };
                    assert_eq!(
                        bits(&colors[..channels]),
                        bits(&alone[..channels]),
                        "{format:?} {dimension:?} {:?} at {}: {:?} + {:?}, {:?}",
                        sampled.view().size(0),
                        level.name(),
                        asked.at,
                        asked.offset,
                        sampled.sampler()
                    );
                }
            }
        }
    }
    assert!(
        without_borders > 500 && outside > 1000 && inside > 1000,
        "{without_borders} {outside} {inside}"
    );
}
