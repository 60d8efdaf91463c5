//! Functions of GLSL that the front end writes itself: their results are those of Rust, or of the
//! same functions in WGSL.
#![expect(
    clippy::cast_possible_truncation,
    reason = "numbers are small, or their lower words are meant"
)]

use super::compute::{buffer, group, run, words};
use super::picture::{drawn, pipeline};
use super::{devices, module};
use estampe::state::CompareFunction;
use estampe::{
    BindGroupDescriptor, BindingResource, ComputePipeline, ComputePipelineDescriptor, Device,
    EntryPointDescriptor, SamplerDescriptor, ShaderSource, ShaderStage, TextureDescriptor,
    TextureFormat,
};
use estampe_tests::Random;

fn compiled(device: &Device, text: &str) -> ComputePipeline {
    let stage = ShaderStage::Compute;
    let module = module(device, ShaderSource::GlslStage { stage, text });
    let program = device.create_compute_program(&EntryPointDescriptor::new(&module));
    let program = program.unwrap_or_else(|error| panic!("{error}"));
    let pipeline = device.create_compute_pipeline(&ComputePipelineDescriptor::new(program));
    pipeline.unwrap_or_else(|error| panic!("{error}"))
}

/// A word of each function's results, for two words.
const NUMBERS: &str = "#version 450
layout(local_size_x = 16) in;
layout(std430, binding = 0) readonly buffer Given { uvec2 given[]; };
layout(std430, binding = 1) writeonly buffer Results { uint results[]; };
void main() {
    uint n = gl_GlobalInvocationID.x;
    uvec2 ab = given[n];
    float x = uintBitsToFloat(ab.x);
    uint at = n * 14u;
    int power; float whole; uint carry, high, low; int signed_high, signed_low;
    results[at] = floatBitsToUint(frexp(x, power));
    results[at + 1u] = uint(power);
    results[at + 2u] = floatBitsToUint(modf(x, whole));
    results[at + 3u] = floatBitsToUint(whole);
    results[at + 4u] = uaddCarry(ab.x, ab.y, carry);
    results[at + 5u] = carry;
    results[at + 6u] = usubBorrow(ab.x, ab.y, carry);
    results[at + 7u] = carry;
    umulExtended(ab.x, ab.y, high, low);
    results[at + 8u] = high;
    results[at + 9u] = low;
    imulExtended(int(ab.x), int(ab.y), signed_high, signed_low);
    results[at + 10u] = uint(signed_high);
    results[at + 11u] = uint(signed_low);
    ivec2 powers; uvec2 carries;
    vec2 parts = frexp(vec2(1.0, x), powers);
    uvec2 sums = uaddCarry(ab, ab.yy, carries);
    results[at + 12u] = floatBitsToUint(parts.y) ^ uint(powers.y) ^ uint(powers.x) << 8;
    results[at + 13u] = sums.x ^ sums.y ^ carries.x << 1 ^ carries.y;
}
";

/// A significand from a half to one, and the exponent, of GLSL 4.60, section 8.3.
fn frexp(x: f32) -> (f32, i32) {
    if x == 0.0 || !x.is_finite() {
        return (x, 0);
    }
    let (mut part, mut power) = (f64::from(x), 0);
    while part.abs() >= 1.0 {
        (part, power) = (part / 2.0, power + 1);
    }
    while part.abs() < 0.5 {
        (part, power) = (part * 2.0, power - 1);
    }
    (part as f32, power)
}

/// Rows: G1
#[test]
fn functions_of_two_results_are_those_of_rust() {
    let mut random = Random::new("glsl functions", 1);
    let edges = [
        0.0_f32,
        -0.0,
        1.0,
        -0.5,
        0.75,
        1e-40,
        -1e-45,
        f32::MIN_POSITIVE,
        f32::MAX,
        3.75,
        -1e20,
        f32::INFINITY,
    ];
    let mut given: Vec<u32> = edges
        .into_iter()
        .flat_map(|x| [x.to_bits(), u32::MAX])
        .collect();
    let words_of = |random: &mut Random| random.bits();
    while given.len() < 320 {
        given.extend([words_of(&mut random) | 3, words_of(&mut random)]);
    }
    given.retain(|word| !f32::from_bits(*word).is_nan() || *word == u32::MAX);
    given.truncate(given.len() / 32 * 32);
    let mut wanted = Vec::new();
    for pair in given.chunks(2) {
        let [a, b] = [pair[0], pair[1]];
        let x = f32::from_bits(a);
        let (part, power) = frexp(x);
        let whole = x.trunc();
        let product = u64::from(a) * u64::from(b);
        let signed = i64::from(a.cast_signed()) * i64::from(b.cast_signed());
        let (sum, carry) = a.overflowing_add(b);
        let (doubled, carry_of_b) = b.overflowing_add(b);
        let (difference, borrow) = a.overflowing_sub(b);
        wanted.extend([
            part.to_bits(),
            power.cast_unsigned(),
            (x - whole).to_bits(),
            whole.to_bits(),
            sum,
            u32::from(carry),
            difference,
            u32::from(borrow),
            (product >> 32) as u32,
            product as u32,
            (signed >> 32) as u32,
            signed as u32,
            part.to_bits() ^ power.cast_unsigned() ^ 1 << 8,
            sum ^ doubled ^ u32::from(carry) << 1 ^ u32::from(carry_of_b),
        ]);
    }
    let is_nan = |word: u32| f32::from_bits(word).is_nan();
    for (name, device) in devices() {
        let pipeline = compiled(&device, NUMBERS);
        let results = buffer(&device, &vec![0; wanted.len()]);
        let groups = [group(
            &device,
            &pipeline,
            &[&buffer(&device, &given), &results],
        )];
        run(&device, &pipeline, &groups, [given.len() as u32 / 32, 1, 1]);
        for (at, (got, wanted)) in words(&results).into_iter().zip(&wanted).enumerate() {
            let is_same = got == *wanted || at % 14 < 4 && is_nan(got) && is_nan(*wanted);
            let pair = &given[at / 14 * 2..][..2];
            assert!(
                is_same,
                "{name}: result {} of {pair:X?}: {got:X} {wanted:X}",
                at % 14
            );
        }
    }
}

/// Counts in a buffer and in shared memory, whose members are structures and arrays.
const ATOMICS: &str = "#version 430
layout(local_size_x = 32) in;
struct Bin { int least; uint count[2]; };
layout(std430, binding = 0) readonly buffer Given { int given[]; };
layout(std430, binding = 1) buffer Bins { Bin bins[4]; uint owners; uint bits; uint tickets[]; } all;
shared uint in_group[4];
void main() {
    uint local = gl_LocalInvocationIndex;
    if (local < 4u) { in_group[local] = 0u; }
    barrier();
    int n = given[gl_GlobalInvocationID.x];
    int bin = n & 3;
    atomicMin(all.bins[bin].least, n);
    atomicAdd(all.bins[bin].count[(n >> 2) & 1], 1);
    atomicAdd(in_group[bin], 1u);
    atomicOr(all.bits, 1u << uint(n & 31));
    barrier();
    if (local == 0u) {
        uint seen = atomicCompSwap(all.owners, gl_WorkGroupID.x, gl_WorkGroupID.x + 1u);
        all.tickets[gl_WorkGroupID.x * 3u] = seen;
        all.tickets[gl_WorkGroupID.x * 3u + 1u] = in_group[1] + in_group[3];
        all.tickets[gl_WorkGroupID.x * 3u + 2u] = atomicExchange(in_group[2], 7u) + in_group[2];
    }
}
";

/// Rows: G5
#[test]
fn atomic_functions_act_on_buffers_and_shared_memory() {
    const GROUPS: usize = 9;
    let mut random = Random::new("glsl functions", 2);
    let given: Vec<i32> = (0..GROUPS * 32)
        .map(|_| random.below(4000).cast_signed() - 2000)
        .collect();
    let mut bins = [[i32::MAX.cast_unsigned(), 0, 0]; 4];
    let (mut bits, mut tickets) = (0, Vec::new());
    for (at, group) in given.chunks(32).enumerate() {
        let mut in_group = [0; 4];
        for &n in group {
            let bin = (n & 3) as usize;
            bins[bin][0] = bins[bin][0].cast_signed().min(n).cast_unsigned();
            bins[bin][1 + (n >> 2 & 1) as usize] += 1;
            in_group[bin] += 1;
            bits |= 1 << (n & 31);
        }
        tickets.extend([at as u32, in_group[1] + in_group[3], in_group[2] + 7]);
    }
    let mut wanted = bins.as_flattened().to_vec();
    wanted.extend([GROUPS as u32, bits]);
    wanted.extend(tickets);
    let mut start = [i32::MAX.cast_unsigned(), 0, 0].repeat(4);
    start.resize(wanted.len(), 0);
    let given: Vec<u32> = given.into_iter().map(i32::cast_unsigned).collect();
    for (name, device) in devices() {
        let pipeline = compiled(&device, ATOMICS);
        let results = buffer(&device, &start);
        let groups = [group(
            &device,
            &pipeline,
            &[&buffer(&device, &given), &results],
        )];
        run(&device, &pipeline, &groups, [GROUPS as u32, 1, 1]);
        assert_eq!(words(&results), wanted, "{name}");
    }
}

const VERTEX: &str = "#version 450
void main() {
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0;
    gl_Position = vec4(corner, 0.0, 1.0);
}";

const GATHERS: &str = "#version 450
uniform sampler2D image;
uniform sampler2DShadow depth;
const ivec2 BESIDE = ivec2(2, -1);
layout(location = 0) out vec4 color;
vec4 second(sampler2D from, vec2 at) { return textureGather(from, at, 2 - 1); }
void main() {
    vec2 at = gl_FragCoord.xy / vec2(37.0, 29.0) * 1.25 - 0.1;
    color = textureGather(image, at).wzyx * 0.25 + second(image, at) * 0.25;
    color += textureGatherOffset(image, at, BESIDE, 3).yxwz * 0.25;
    color *= 0.75 + textureGather(depth, at, 0.5) * 0.125 + textureGatherOffset(depth, at, at.x, ivec2(1, 1)) * 0.125;
}";

const GATHERS_IN_WGSL: &str = "
@group(0) @binding(0) var image: texture_2d<f32>;
@group(0) @binding(1) var image_sampler: sampler;
@group(0) @binding(2) var depth: texture_depth_2d;
@group(0) @binding(3) var depth_sampler: sampler_comparison;
@vertex fn vs(@builtin(vertex_index) n: u32) -> @builtin(position) vec4f {
    return vec4f(vec2f(f32(n & 1u), f32(n >> 1u)) * 4.0 - 1.0, 0.5, 1.0);
}
@fragment fn fs(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let at = position.xy / vec2f(37.0, 29.0) * 1.25 - 0.1;
    var color = textureGather(0, image, image_sampler, at).wzyx * 0.25;
    color = color + textureGather(1, image, image_sampler, at) * 0.25;
    color += textureGather(3, image, image_sampler, at, vec2i(2, -1)).yxwz * 0.25;
    color *= 0.75 + textureGatherCompare(depth, depth_sampler, at, 0.5) * 0.125
        + textureGatherCompare(depth, depth_sampler, at, at.x, vec2i(1, 1)) * 0.125;
    return color;
}
";

/// The picture of a module that gathers.
fn gathered(device: &Device, source: ShaderSource<'_>) -> Vec<u8> {
    let pipeline = pipeline(device, &module(device, source));
    let mut random = Random::new("glsl functions", 3);
    let mut noise = |format, bytes| {
        let texels: Vec<u8> = (0..7 * 5 * bytes)
            .map(|_| random.pick(&[0, 30, 63, 90, 200, 255]))
            .collect();
        let descriptor = TextureDescriptor::new_2d(7, 5, format);
        device.create_texture_with_data(&descriptor, &[&texels])
    };
    let image = noise(TextureFormat::Rgba8Unorm, 4).expect("a small texture");
    let depth = noise(TextureFormat::Depth16Unorm, 2).expect("a small texture");
    let sampler = device.create_sampler(&SamplerDescriptor::default());
    let comparing = device.create_sampler(&SamplerDescriptor {
        compare: Some(CompareFunction::Less),
        ..SamplerDescriptor::default()
    });
    let group = device.create_bind_group(&BindGroupDescriptor {
        label: None,
        layout: &pipeline.descriptor().bind_group_layouts[0],
        entries: &[
            (0, BindingResource::Texture(image.view())),
            (1, BindingResource::Sampler(sampler.expect("the default"))),
            (2, BindingResource::Texture(depth.view())),
            (
                3,
                BindingResource::Sampler(comparing.expect("one that compares")),
            ),
        ],
    });
    let group = group.unwrap_or_else(|error| panic!("{error}"));
    drawn(device, &pipeline, &[group], [37, 29])
}

/// Rows: G1
#[test]
fn gathers_are_those_of_wgsl() {
    for (name, device) in devices() {
        let glsl = ShaderSource::Glsl {
            vertex: VERTEX,
            fragment: GATHERS,
        };
        let of_glsl = gathered(&device, glsl);
        let of_wgsl = gathered(&device, ShaderSource::Wgsl(GATHERS_IN_WGSL));
        let colors: std::collections::BTreeSet<_> = of_glsl.chunks(4).collect();
        assert!(colors.len() > 30, "{}", colors.len());
        assert!(of_glsl == of_wgsl, "{name}");
    }
}

const CHOICES: &str = "#version 330 core
struct Material { sampler2D images[3]; float gain; };
uniform Material materials[2];
uniform sampler2D plain[2];
out vec4 color;
void main() {
    int column = int(gl_FragCoord.x) / 4;
    vec4 first = texture(materials[1].images[column % 3], vec2(0.5, 0.25));
    vec4 second = texture2D(plain[gl_FragCoord.y > 4.0 ? 1 : 0], first.xy + vec2(0.1));
    color = vec4(first.x, second.x, float(textureSize(plain[column & 1], 0).x) / 255.0, 1.0);
}";

/// Rows: G1
#[test]
fn samplers_are_chosen_by_computed_indices() {
    let size = [24, 8];
    for (name, device) in devices() {
        let glsl = ShaderSource::Glsl {
            vertex: VERTEX,
            fragment: CHOICES,
        };
        let module = module(&device, glsl);
        let pipeline = pipeline(&device, &module);
        // A texture of one value and size for each sampler.
        let level = |path: &str| match path {
            "materials[1].images[0]" => 10,
            "materials[1].images[1]" => 20,
            "materials[1].images[2]" => 30,
            "plain[0]" => 40,
            "plain[1]" => 50,
            _ => 99,
        };
        let layout = &pipeline.descriptor().bind_group_layouts[0];
        let samplers = module
            .reflections()
            .flat_map(|reflection| &reflection.combined_samplers);
        let is_used = |binding: u32| layout.entries().iter().any(|one| one.binding == binding);
        let mut entries = Vec::new();
        for pair in samplers {
            let value: u8 = level(&pair.name);
            let descriptor = TextureDescriptor::new_2d(value.into(), 1, TextureFormat::R8Unorm);
            let texels = vec![value; value.into()];
            let texture = device.create_texture_with_data(&descriptor, &[&texels]);
            let view = texture.expect("a small texture").view();
            let sampler = device.create_sampler(&SamplerDescriptor::default());
            let sampler = sampler.expect("the default");
            entries.push((pair.texture.1, BindingResource::Texture(view)));
            entries.push((pair.sampler.1, BindingResource::Sampler(sampler)));
        }
        assert_eq!(entries.len(), 5 * 2 + 3 * 2);
        entries.retain(|(binding, _)| is_used(*binding));
        let group = device.create_bind_group(&BindGroupDescriptor {
            label: None,
            layout,
            entries: &entries,
        });
        let group = group.unwrap_or_else(|error| panic!("{error}"));
        let drawn = drawn(&device, &pipeline, &[group], size);
        for (at, pixel) in drawn.chunks(4).enumerate() {
            let (x, y) = (at % size[0] as usize, at / size[0] as usize);
            let column = x / 4;
            let wanted = [
                [10, 20, 30][column % 3],
                if y >= 4 { 50 } else { 40 },
                if column & 1 == 1 { 50 } else { 40 },
                255,
            ];
            assert_eq!(pixel, wanted, "{name}: {x}, {y}");
        }
    }
}
