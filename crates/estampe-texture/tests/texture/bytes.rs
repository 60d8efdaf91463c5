//! Linear filtering of formats of bytes in views that are not of the common kind: packets of any
//! mip levels, layers and faces are sampled as their quads alone, by packet code.

use super::Random;
use estampe_simd::{LANES, Level, Packet};
use estampe_texture::{
    AddressMode, BoundTexture, FilterMode, LevelData, Limits, MipGeneration, PacketLod,
    PacketRequest, SampledTexture, SamplerDescriptor, TexelDescriptor, TexelView,
    TexelViewDescriptor, TextureFormat, ViewDimension,
};

type Colors = [Packet<f32>; 4];

const FORMATS: [TextureFormat; 3] = [
    TextureFormat::Rgba8Unorm,
    TextureFormat::Rgba8UnormSrgb,
    TextureFormat::R8Unorm,
];

/// A view of a texture of noise.
fn view(dimension: ViewDimension, size: [u32; 2], format: TextureFormat) -> TexelView {
    let descriptor = TexelDescriptor {
        depth_or_layers: match dimension {
            ViewDimension::Cube => 6,
            ViewDimension::CubeArray => 12,
            _ => 5,
        },
        ..TexelDescriptor::new_2d(size[0], size[1], format)
    };
    let descriptor = descriptor.with_all_levels();
    let bytes_per_texel = match format {
        TextureFormat::R8Unorm => 1,
        _ => 4,
    };
    let random = &mut Random::new(size[0] * 31 + size[1]);
    let levels: Vec<Vec<u8>> = (0..descriptor.mip_level_count)
        .map(|level| {
            let [width, height] = size.map(|side| (side >> level).max(1));
            random.bytes((width * height * descriptor.depth_or_layers * bytes_per_texel) as usize)
        })
        .collect();
    let levels: Vec<LevelData<'_>> = levels.iter().map(|level| LevelData::tight(level)).collect();
    let texture = descriptor.create(&levels, MipGeneration::None, &Limits::default());
    let descriptor = TexelViewDescriptor {
        dimension: Some(dimension),
        // So that no view is of the common kind, and the first layer counts.
        base_array_layer: u32::from(dimension == ViewDimension::D2),
        ..TexelViewDescriptor::default()
    };
    TexelView::new(texture.expect("a small texture"), &descriptor).expect("valid")
}

fn samplers() -> Vec<SamplerDescriptor> {
    let trilinear = SamplerDescriptor::trilinear_repeat();
    let modes = |u, v| SamplerDescriptor {
        address_mode_u: u,
        address_mode_v: v,
        ..trilinear
    };
    let (clamp, mirror) = (AddressMode::ClampToEdge, AddressMode::MirrorRepeat);
    vec![
        trilinear,
        modes(clamp, clamp),
        SamplerDescriptor {
            mipmap_filter: FilterMode::Nearest,
            ..modes(mirror, AddressMode::Repeat)
        },
        SamplerDescriptor {
            lod_min_clamp: 0.5,
            lod_max_clamp: 2.25,
            lod_bias: 0.7,
            ..modes(clamp, mirror)
        },
        SamplerDescriptor {
            max_anisotropy: 16,
            ..trilinear
        },
        SamplerDescriptor {
            max_anisotropy: 3,
            ..modes(clamp, AddressMode::Repeat)
        },
    ]
}

/// The numbers of a request.
struct Asked {
    at: [Packet<f32>; 3],
    layer: Packet<u32>,
    value: Packet<f32>,
    gradients: [Packet<f32>; 6],
    lod: PacketLod,
}

impl Asked {
    /// Quads in one place, or each somewhere else; each has derivatives of its own, in its layer.
    fn random(random: &mut Random, is_cube: bool) -> Self {
        let mut at = [Packet([0.0; LANES]); 3];
        let (mut layer, mut value) = (Packet([0; LANES]), Packet([0.0; LANES]));
        let are_near = random.bits().is_multiple_of(2);
        let mut of_quad = 0;
        let mut place = [0.0; 3];
        let mut step = [[0.0; 3]; 2];
        for lane in 0..LANES {
            if lane == 0 || (lane.is_multiple_of(4) && !are_near) {
                place = std::array::from_fn(|_| random.unit() * 1.4 - 0.2);
                if is_cube {
                    place = place_on_cube(random);
                }
                let length = random.unit() * random.unit() * 0.3;
                step = [0, 1].map(|_| {
                    std::array::from_fn(|_| (random.unit() - 0.5) * length * random.unit())
                });
                of_quad = random.bits() % 7;
            }
            layer.0[lane] = of_quad;
            let [x, y] = [estampe_simd::LANE_X[lane], estampe_simd::LANE_Y[lane]].map(f32::from);
            for k in 0..3 {
                at[k].0[lane] = place[k] + step[0][k] * x + step[1][k] * y;
            }
            value.0[lane] = random.unit() * 6.0 - 1.0;
        }
        if random.bits().is_multiple_of(8) {
            let odd = [f32::NAN, f32::INFINITY, -1e30, 0.0];
            at[0].0[random.bits() as usize % LANES] = odd[random.bits() as usize % 4];
        }
        let lods = [
            PacketLod::Implicit,
            PacketLod::Bias,
            PacketLod::Level,
            PacketLod::Gradients,
        ];
        Self {
            at,
            layer,
            value,
            gradients: [0; 6].map(|_| Packet([0; LANES].map(|_| (random.unit() - 0.5) * 0.1))),
            lod: lods[random.bits() as usize % 4],
        }
    }

    fn request(&self) -> PacketRequest<'_> {
        PacketRequest {
            at: self.at.each_ref(),
            layer: &self.layer,
            value: &self.value,
            gradients: self.gradients.each_ref(),
            lod: self.lod,
            ..PacketRequest::ZEROS
        }
    }

    /// The lanes of a quad, as the first ones.
    fn quad(&self, first: usize) -> Self {
        let of =
            |packet: &Packet<f32>| Packet(std::array::from_fn(|lane| packet.0[first + lane % 4]));
        Self {
            at: self.at.each_ref().map(of),
            layer: Packet(std::array::from_fn(|lane| self.layer.0[first + lane % 4])),
            value: of(&self.value),
            gradients: self.gradients.each_ref().map(of),
            lod: self.lod,
        }
    }
}

/// A direction, often near an edge of the cube, sometimes near a corner.
fn place_on_cube(random: &mut Random) -> [f32; 3] {
    let mut near = |share: u32| {
        if random.bits() % 4 < share {
            0.9 + random.unit() * 0.2
        } else {
            random.unit() * 2.0 - 1.0
        }
    };
    let place = [1.0, near(3), near(1)];
    let turn = random.bits() as usize % 3;
    let mut at = [place[turn], place[(turn + 1) % 3], place[(turn + 2) % 3]];
    for component in &mut at {
        if random.bits().is_multiple_of(2) {
            *component = -*component;
        }
    }
    at
}

/// A texture that a pass before has sampled: squares of texels of one byte are made.
pub(super) fn sampled_again(view: &TexelView, sampler: SamplerDescriptor) -> SampledTexture {
    let bound = || BoundTexture::new(view.clone(), None, Level::best());
    bound().sampled(&sampler).expect("valid");
    let again = bound();
    again.sampled(&sampler).expect("valid").clone()
}

/// The colours of sixteen lanes, each quad sampled alone, which packet code does not do.
fn by_quads(texture: &SampledTexture, asked: &Asked) -> Colors {
    let mut colors = Colors::default();
    for first in (0..LANES).step_by(4) {
        let quad = asked.quad(first);
        let mut alone = Colors::default();
        let request = PacketRequest {
            count: 4,
            ..quad.request()
        };
        texture.sample_request(&request, &mut alone);
        for (colors, alone) in colors.iter_mut().zip(&alone) {
            colors.0[first..first + 4].copy_from_slice(&alone.0[..4]);
        }
    }
    colors
}

#[test]
fn packets_are_sampled_as_their_quads() {
    use ViewDimension as V;
    let random = &mut Random::new(91);
    let views = [
        (V::D2, [40, 24]),
        (V::D2Array, [128, 128]),
        (V::D2Array, [3, 17]),
        (V::Cube, [32, 32]),
        (V::CubeArray, [5, 5]),
    ];
    for (dimension, size) in views {
        let is_cube = matches!(dimension, V::Cube | V::CubeArray);
        let [mut sampled, mut alone] = [0; 2];
        for format in FORMATS {
            let views = [(); 2].map(|()| view(dimension, size, format));
            for sampler in samplers() {
                let texture = SampledTexture::new(views[0].clone(), sampler).expect("valid");
                assert!(texture.common().is_none());
                let again = sampled_again(&views[1], sampler);
                let has_squares = again.view().texture().squares.get().is_some();
                assert_eq!(has_squares, format == TextureFormat::R8Unorm && !is_cube);
                for number in 0..60 {
                    let asked = Asked::random(random, is_cube);
                    let expected = by_quads(&texture, &asked);
                    let texture = if number % 2 == 0 { &texture } else { &again };
                    for level in Level::all_available() {
                        let texture = texture.clone().at_level(level);
                        let mut colors = [Packet([7.0; LANES]); 4];
                        texture.sample_request(&asked.request(), &mut colors);
                        for (channel, (got, expected)) in colors.iter().zip(&expected).enumerate() {
                            assert_eq!(
                                got.0.map(f32::to_bits),
                                expected.0.map(f32::to_bits),
                                "{level:?} {dimension:?} {format:?} {sampler:?} {channel} {:?} {:?} \
                                 {:?} {got:?} {expected:?}",
                                asked.at,
                                asked.layer,
                                asked.lod
                            );
                        }
                        let beside = texture.lanes_beside_bytes(&asked.request());
                        if !level.is_specialized() {
                            assert_eq!(beside, None);
                        } else {
                            sampled += LANES;
                            alone += beside.expect("packet code").count_ones() as usize;
                        }
                    }
                }
            }
        }
        // Lanes where three faces meet: many in faces of few texels, all in a face of one.
        let most_alone = match dimension {
            V::Cube => sampled / 2,
            V::CubeArray => sampled / 10 * 6,
            _ => 0,
        };
        assert!(alone <= most_alone, "{dimension:?} {alone} of {sampled}");
    }
}

#[test]
fn requests_are_sampled_together_as_alone() {
    use ViewDimension as V;
    let random = &mut Random::new(92);
    let untouched = [Packet([7.0; LANES]); 4];
    let views = [(V::D2, [40, 24]), (V::D2Array, [3, 17]), (V::Cube, [8, 8])];
    for ((dimension, size), format) in views
        .into_iter()
        .flat_map(|view| FORMATS.map(|format| (view, format)))
    {
        let view = view(dimension, size, format);
        for (number, sampler) in samplers().into_iter().enumerate() {
            let texture = match number % 2 {
                0 => SampledTexture::new(view.clone(), sampler).expect("valid"),
                _ => sampled_again(&view, sampler),
            };
            let asked: Vec<_> = (0..21)
                .map(|_| Asked::random(random, dimension == V::Cube))
                .collect();
            let requests: Vec<_> = asked.iter().map(Asked::request).collect();
            for level in Level::all_available() {
                let texture = texture.clone().at_level(level);
                let mut together = vec![untouched; 2 * requests.len()];
                let is_one_entry = texture.sample_requests(&requests, &mut together, 2);
                let has_code = level.is_specialized() && sampler.max_anisotropy <= 1;
                assert_eq!(is_one_entry, has_code, "{level:?} {sampler:?}");
                for (request, colors) in requests.iter().zip(together.chunks(2)) {
                    let mut alone = untouched;
                    texture.sample_request(request, &mut alone);
                    let bits = |color: &[Packet<f32>; 4]| {
                        color.each_ref().map(|channel| channel.0.map(f32::to_bits))
                    };
                    assert_eq!(
                        bits(&colors[0]),
                        bits(&alone),
                        "{level:?} {dimension:?} {format:?} {sampler:?}"
                    );
                    assert_eq!(colors[1], untouched);
                }
            }
        }
    }
}

#[test]
fn lanes_across_an_edge_of_a_cube_stay_in_their_packet() {
    let view = view(ViewDimension::Cube, [32, 32], TextureFormat::Rgba8Unorm);
    let sampler = SamplerDescriptor::trilinear_repeat();
    let texture = SampledTexture::new(view, sampler).expect("valid");
    let ones = Packet([1.0; LANES]);
    for level in Level::all_available()
        .into_iter()
        .filter(|level| level.is_specialized())
    {
        let texture = texture.clone().at_level(level);
        let beside = |y: f32, z: f32| {
            let [y, z] = [y, z].map(|at| Packet([at; LANES]));
            let request = PacketRequest {
                at: [&ones, &y, &z],
                lod: PacketLod::Level,
                ..PacketRequest::ZEROS
            };
            texture.lanes_beside_bytes(&request)
        };
        let middle = [beside(0.2, 0.1), beside(0.999, 0.1), beside(0.2, -0.999)];
        assert_eq!(middle, [Some(0); 3], "{level:?}");
        assert_eq!(beside(0.999, 0.999), Some(0xFFFF), "{level:?}");
    }
}
