//! Fragments that are given derivatives: machine code and the interpreter, at every level, give
//! what `sample_grad` gives for each fragment.

use super::program;
use estampe_simd::{LANES, Level, Packet};
use estampe_texture::{
    BoundTexture, Coordinates, FilterMode, LevelData, Lod, MipGeneration, SampledTexture,
    SamplerDescriptor, TexelData, TexelDescriptor, TexelView, TexelViewDescriptor,
    TextureDimension, TextureFormat, TiledTexels, TiledWords, ViewDimension,
};
use estampe_types::bindings::{BoundGroup, BoundResource, BoundResources, OtherResource};
use estampe_types::morton::spread;
use estampe_types::state::CompareFunction;
use estampe_types::{Bindings, BufferData, FragmentBatch, Limits, Program, Vec2, Vec3, Vec4};
use std::sync::Arc;

const PACKETS: usize = 33;

/// Lanes that run; the others have coordinates and derivatives that are NaN.
const COVER: [u16; PACKETS] = {
    let mut cover = [0xFFFF; PACKETS];
    cover[3] = 0x7E1B;
    cover[17] = 0x8001;
    cover
};

/// The view of each binding number of the shader, and its two samplers.
#[derive(Debug)]
pub(super) struct Textures {
    views: Vec<(u32, TexelView)>,
    sampler: SamplerDescriptor,
    compared: SamplerDescriptor,
}

fn view(
    (dimension, view): (TextureDimension, ViewDimension),
    [width, height, depth_or_layers]: [u32; 3],
    random: &mut fastrand::Rng,
) -> TexelView {
    let descriptor = TexelDescriptor {
        dimension,
        depth_or_layers,
        ..TexelDescriptor::new_2d(width, height, TextureFormat::Rgba8Unorm)
    };
    let texels = width * height * depth_or_layers;
    // Half of the texels are transparent.
    let byte = |at: u32| {
        if at % 4 == 3 && at < texels * 2 {
            0
        } else {
            random.u8(..)
        }
    };
    let bytes: Vec<u8> = (0..texels * 4).map(byte).collect();
    let descriptor = match dimension {
        TextureDimension::D1 => descriptor,
        _ => descriptor.with_all_levels(),
    };
    let (data, limits) = ([LevelData::tight(&bytes)], Limits::default());
    let texture = descriptor.create(&data, MipGeneration::Full, &limits);
    let shown = TexelViewDescriptor {
        dimension: Some(view),
        ..TexelViewDescriptor::default()
    };
    TexelView::new(texture.expect("it is small"), &shown).expect("the texture has this dimension")
}

fn depths(random: &mut fastrand::Rng) -> TexelView {
    let descriptor = TexelDescriptor {
        mip_level_count: 3,
        ..TexelDescriptor::new_2d(16, 16, TextureFormat::Depth32Float)
    };
    let mut level = |side: usize| -> Vec<u8> {
        let texels = (0..side * side).map(|_| random.f32().to_le_bytes());
        texels.flatten().collect()
    };
    let levels = [16, 8, 4].map(&mut level);
    let data = levels.each_ref().map(|bytes| LevelData::tight(bytes));
    let texture = descriptor.create(&data, MipGeneration::None, &Limits::default());
    TexelView::of(texture.expect("it is small")).expect("it has a level")
}

/// The finest level of a texture in storage order.
fn tiles_of(texture: &TexelData) -> TiledTexels {
    let (level, words) = (texture.levels[0], texture.words_per_texel());
    assert!(level.width.max(level.height) <= 64, "one block");
    let mut tiled = vec![0x1234_5678; 4096 * words];
    for (y, x) in (0..level.height).flat_map(|y| (0..level.width).map(move |x| (y, x))) {
        let pixel = (spread(x) | spread(y) << 1) as usize;
        let texel = (y * level.width + x) as usize * words;
        for word in 0..words {
            let at = (pixel / LANES * words + word) * LANES + pixel % LANES;
            tiled[at] = texture.texels[texel + word];
        }
    }
    let words = match texture.format.has_depth() {
        true => {
            let depths: Vec<f32> = tiled.into_iter().map(f32::from_bits).collect();
            TiledWords::Depths(Arc::new(depths.into()))
        }
        false => TiledWords::Colors(Arc::new(tiled.into())),
    };
    let tiles = TiledTexels::new(texture.format, [level.width, level.height], words);
    tiles.expect("a format that is read in tiles")
}

/// Half floats, which filters sample in blocks.
fn halves(random: &mut fastrand::Rng) -> TexelView {
    let descriptor = TexelDescriptor::new_2d(64, 32, TextureFormat::Rgba16Float);
    // From 2⁻⁷ to 2.
    let texels = (0..64 * 32 * 4).map(|_| random.u16(0x2000..0x4000).to_le_bytes());
    let bytes: Vec<u8> = texels.flatten().collect();
    let (data, limits) = ([LevelData::tight(&bytes)], Limits::default());
    let texture = descriptor.create(&data, MipGeneration::None, &limits);
    TexelView::of(texture.expect("it is small")).expect("it has a level")
}

impl Textures {
    pub(super) fn new(sampler: SamplerDescriptor) -> Self {
        use TextureDimension as T;
        use ViewDimension as V;
        let random = &mut fastrand::Rng::with_seed(7);
        let plane = (T::D2, V::D2);
        let views = vec![
            (1, view(plane, [32, 32, 1], random)),
            (2, view(plane, [16, 64, 1], random)),
            (3, view(plane, [8, 8, 1], random)),
            (4, view((T::D2, V::D2Array), [16, 16, 5], random)),
            (5, view((T::D2, V::Cube), [16, 16, 6], random)),
            (6, view((T::D3, V::D3), [8, 8, 8], random)),
            (7, view((T::D1, V::D1), [64, 1, 1], random)),
            (8, depths(random)),
            (10, halves(random)),
        ];
        Self {
            views,
            sampler,
            compared: SamplerDescriptor {
                compare: Some(CompareFunction::Less),
                ..SamplerDescriptor::trilinear_repeat()
            },
        }
    }

    pub(super) fn bindings(&self, level: Level) -> Bindings {
        self.bindings_with(level, [0.03, -0.02, 1.5, 1e30])
    }

    /// The bindings, with `numbers` as the uniform.
    pub(super) fn bindings_with(&self, level: Level, numbers: [f32; 4]) -> Bindings {
        self.bindings_in_tiles(level, numbers, &[])
    }

    /// The same, of which the textures at some places are bound in tiles.
    pub(super) fn bindings_in_tiles(
        &self,
        level: Level,
        numbers: [f32; 4],
        in_tiles: &[u32],
    ) -> Bindings {
        let bound = |(binding, view): &(u32, TexelView)| {
            let texture = match in_tiles.contains(binding) {
                true => {
                    let mut shape = (**view.texture()).clone();
                    let _ = shape.take_texels();
                    let shape = TexelView::of(shape).expect("it has a level");
                    let tiles = Some(tiles_of(view.texture()));
                    BoundTexture::without_texels(shape, (None, tiles), level)
                }
                false => BoundTexture::new(view.clone(), None, level),
            };
            (
                *binding,
                BoundResource::Other(OtherResource(Arc::new(texture))),
            )
        };
        let mut entries: Vec<_> = self.views.iter().map(bound).collect();
        entries.push((0, BoundResource::Sampler(self.sampler)));
        entries.push((9, BoundResource::Sampler(self.compared)));
        let numbers = numbers.map(f32::to_bits);
        let numbers = BoundResource::Buffer {
            buffer: BufferData::from_words(numbers.to_vec()),
            offset: 0,
            size: 16,
            dynamic_offset: None,
        };
        entries.push((11, numbers));
        Bindings {
            groups: vec![BoundGroup {
                group: Arc::new(BoundResources { entries }),
                ..BoundGroup::default()
            }],
            ..Bindings::default()
        }
    }

    fn texture(&self, binding: u32) -> SampledTexture {
        let mut views = self.views.iter();
        let (_, view) = views.find(|(at, _)| *at == binding).expect("it is bound");
        let sampler = match binding {
            8 => self.compared,
            _ => self.sampler,
        };
        SampledTexture::new(view.clone(), sampler).expect("the texture can be sampled so")
    }

    fn sample(&self, binding: u32, at: Coordinates<f32>, [x, y]: [Vec3<f32>; 2]) -> Vec4<f32> {
        self.texture(binding).sample_grad(at, x, y)
    }
}

/// A fragment: its scalars, as the program's interface lists them.
#[derive(Debug)]
struct Fragment<'a> {
    varyings: &'a [f32],
    /// Along x, then along y.
    derivatives: [&'a [f32]; 2],
}

impl Fragment<'_> {
    /// The derivatives of up to three scalars that begin at the `first` that has some.
    fn gradients(&self, first: usize, count: usize) -> [Vec3<f32>; 2] {
        self.derivatives.map(|along| {
            let of = |at: usize| if at < count { along[first + at] } else { 0.0 };
            Vec3::new(of(0), of(1), of(2))
        })
    }

    fn uv(&self) -> Vec2<f32> {
        Vec2::new(self.varyings[0], self.varyings[1])
    }

    fn direction(&self, first: usize) -> Vec3<f32> {
        let [x, y, z] = [0, 1, 2].map(|at| self.varyings[first + at]);
        Vec3::new(x, y, z)
    }
}

fn sum(a: Vec4<f32>, b: Vec4<f32>) -> Vec4<f32> {
    Vec4::new(a.x + b.x, a.y + b.y, a.z + b.z, a.w + b.w)
}

/// Runs the fragment shader of these statements, and compares each fragment's colour with what is
/// expected of it.
#[track_caller]
fn check(
    statements: &str,
    sampler: SamplerDescriptor,
    expected: impl Fn(&Textures, &Fragment<'_>) -> Vec4<f32>,
) {
    let textures = Textures::new(sampler);
    let programs = [program(statements).interpreted(), program(statements)];
    let interface = programs[0].interface().clone();
    assert!(interface.no_derivatives, "{statements}");
    let scalars = interface.fragment_scalars();
    let (varyings, gradients) = (interface.varyings.len(), interface.gradients.len());
    let random = &mut fastrand::Rng::with_seed(11);
    let mut packets = vec![Packet([f32::NAN; LANES]); PACKETS * scalars];
    for (at, packet) in packets.iter_mut().enumerate() {
        let cover = COVER[at / scalars];
        // Packets in which all lanes have about the same level, and others in which they do not.
        let size = 0.7_f32.powi(random.i32(0..20));
        let is_mixed = random.bool();
        for lane in (0..LANES).filter(|lane| cover >> lane & 1 == 1) {
            let number = random.f32() * 2.0 - 1.0;
            packet.0[lane] = match at % scalars < varyings {
                true => number * 3.0,
                false if is_mixed => number * 0.7_f32.powi(random.i32(0..20)),
                false => number * size,
            };
        }
    }
    let fragment = |packet: usize, lane: usize| -> Vec<f32> {
        let packets = packets[packet * scalars..][..scalars].iter();
        packets.map(|packet| packet.0[lane]).collect()
    };
    for level in Level::all_available() {
        let bindings = textures.bindings(level);
        for (program, runs) in programs.iter().zip([1, 4096 / PACKETS + 2]) {
            let mut colors = vec![Packet::default(); PACKETS * 4];
            // Code that runs often is compiled again.
            for _ in 0..runs {
                let batch = FragmentBatch {
                    varyings: &packets,
                    coverage: &mut COVER.clone(),
                    colors: &mut colors,
                    ..FragmentBatch::default()
                };
                program.run_fragments(level, &bindings, batch);
            }
            for (packet, cover) in COVER.into_iter().enumerate() {
                for lane in (0..LANES).filter(|lane| cover >> lane & 1 == 1) {
                    let of_lane = fragment(packet, lane);
                    let (of_varyings, derivatives) = of_lane.split_at(varyings);
                    let (along_x, along_y) = derivatives.split_at(gradients);
                    let derivatives = [along_x, along_y];
                    let varyings = of_varyings;
                    let Vec4 { x, y, z, w } = expected(
                        &textures,
                        &Fragment {
                            varyings,
                            derivatives,
                        },
                    );
                    let found = [0, 1, 2, 3].map(|at| colors[packet * 4 + at].0[lane]);
                    assert_eq!(
                        found.map(f32::to_bits),
                        [x, y, z, w].map(f32::to_bits),
                        "{statements}: {found:?} in lane {lane} of packet {packet}, {}",
                        level.name()
                    );
                }
            }
        }
    }
}

pub(super) fn samplers() -> [SamplerDescriptor; 3] {
    let linear = SamplerDescriptor::trilinear_repeat();
    let nearest = SamplerDescriptor {
        mipmap_filter: FilterMode::Nearest,
        ..SamplerDescriptor::default()
    };
    let anisotropic = SamplerDescriptor {
        max_anisotropy: 4,
        ..linear
    };
    [linear, nearest, anisotropic]
}

#[test]
fn planes() {
    for sampler in samplers() {
        check(
            "return textureSample(map, s, in.uv);",
            sampler,
            |textures, fragment| {
                let at = Coordinates::d2(fragment.uv());
                textures.sample(1, at, fragment.gradients(0, 2))
            },
        );
    }
}

#[test]
fn base_levels() {
    for sampler in samplers() {
        check(
            "return textureSampleLevel(map, s, in.uv, 0.0);",
            sampler,
            |textures, fragment| {
                let at = Coordinates::d2(fragment.uv());
                textures.texture(1).sample_level(at, 0.0)
            },
        );
    }
}

#[test]
fn several_textures_at_the_same_coordinates() {
    for sampler in samplers() {
        check(
            "return textureSample(map, s, in.uv) + textureSample(other, s, in.uv)
                + textureSample(third, s, in.uv);",
            sampler,
            |textures, fragment| {
                let at = Coordinates::d2(fragment.uv());
                let sample = |binding| textures.sample(binding, at, fragment.gradients(0, 2));
                sum(sum(sample(1), sample(2)), sample(3))
            },
        );
    }
}

#[test]
fn textures_at_different_varyings() {
    check(
        "return textureSample(map, s, in.uv) + textureSample(other, s, in.on_screen)
            + textureSample(map, s, in.uv);",
        SamplerDescriptor::trilinear_repeat(),
        |textures, fragment| {
            let plane = |binding, first: usize| {
                let [u, v] = [0, 1].map(|at| fragment.varyings[first + at]);
                let at = Coordinates::d2(Vec2::new(u, v));
                textures.sample(binding, at, fragment.gradients(first, 2))
            };
            sum(sum(plane(1, 0), plane(2, 2)), plane(1, 0))
        },
    );
}

#[test]
fn layers_cubes_volumes_and_lines() {
    let sampler = SamplerDescriptor::trilinear_repeat();
    check(
        "return textureSample(layers, s, in.uv, i32(in.direction.z));",
        sampler,
        |textures, fragment| {
            let layer = [-3, -2, -1, 0, 1, 2, 3]
                .into_iter()
                .find(|layer: &i16| f32::from(*layer) == fragment.varyings[2].trunc());
            let layer = i32::from(layer.expect("no varying is larger"));
            let at = Coordinates::d2_array(fragment.uv(), layer);
            textures.sample(4, at, fragment.gradients(0, 2))
        },
    );
    check(
        "return textureSample(sky, s, in.direction);",
        sampler,
        |textures, fragment| {
            let at = Coordinates::cube(fragment.direction(0));
            textures.sample(5, at, fragment.gradients(0, 3))
        },
    );
    check(
        "return textureSample(volume, s, in.direction);",
        sampler,
        |textures, fragment| {
            let at = Coordinates::d3(fragment.direction(0));
            textures.sample(6, at, fragment.gradients(0, 3))
        },
    );
    check(
        "return textureSample(line, s, in.uv.y);",
        sampler,
        |textures, fragment| {
            let at = Coordinates::d1(fragment.varyings[0]);
            textures.sample(7, at, fragment.gradients(0, 1))
        },
    );
}

/// Lanes that do not run may have any numbers; no quad need be whole.
#[test]
fn samples_under_conditions() {
    check(
        "if in.direction.x > 0.3 { return textureSample(map, s, in.uv); }
        var color = vec4f(0.0);
        for (var turn = 0; turn < i32(in.direction.y * 3.0); turn += 1) {
            color += textureSample(other, s, in.uv) + textureSample(third, s, in.uv);
        }
        return color;",
        SamplerDescriptor::trilinear_repeat(),
        |textures, fragment| {
            let at = Coordinates::d2(fragment.uv());
            let sample = |binding| textures.sample(binding, at, fragment.gradients(0, 2));
            if fragment.varyings[2] > 0.3 {
                return sample(1);
            }
            let mut color = Vec4::new(0.0, 0.0, 0.0, 0.0);
            let mut turn = 1.0;
            while turn <= fragment.varyings[3] * 3.0 {
                color = sum(color, sum(sample(2), sample(3)));
                turn += 1.0;
            }
            color
        },
    );
}

#[test]
fn comparisons() {
    check(
        "return vec4f(textureSampleCompare(depths, compared, in.uv, in.direction.z));",
        SamplerDescriptor::default(),
        |textures, fragment| {
            let [dx, dy] = fragment.gradients(0, 2);
            let texture = textures.texture(8);
            let (uv, reference) = (fragment.uv(), fragment.varyings[2]);
            let lod = Lod::Gradients(dx, dy);
            let share = texture.sample_compare(uv, reference, lod, [0; 2]);
            Vec4::new(share, share, share, share)
        },
    );
}
