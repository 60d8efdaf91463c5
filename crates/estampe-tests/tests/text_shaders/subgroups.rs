//! Subgroups, which are quads: against a plain loop over the invocations of each.
#![expect(
    clippy::cast_possible_truncation,
    reason = "numbers are small, or their lower words are meant"
)]

use super::compute::{buffer, compiled, group, run, words};
use super::picture::{drawn, pipeline};
use super::{devices, module};
use estampe::ShaderSource;

/// The invocations of a work-group: the last subgroup has one alone.
const GROUP: usize = 13;
const GROUPS: usize = 5;
const INVOCATIONS: usize = GROUP * GROUPS;
/// The words that an invocation writes.
const RESULTS: usize = 30;

/// Invocations whose number is in `takes_part` run the operations, in a branch; then each runs some
/// of them in a loop that it leaves after its number's turns.
const COMPUTE: &str = "
enable subgroups;
@group(0) @binding(0) var<storage, read> numbers: array<u32>;
@group(0) @binding(1) var<storage, read_write> results: array<u32>;
@compute @workgroup_size(13) fn main(
    @builtin(workgroup_id) group: vec3u,
    @builtin(local_invocation_index) index: u32,
    @builtin(subgroup_invocation_id) lane: u32,
    @builtin(subgroup_size) size: u32,
    @builtin(subgroup_id) subgroup: u32,
    @builtin(num_subgroups) subgroups: u32,
) {
    let id = group.x * 13u + index;
    let n = numbers[id];
    let x = f32(n) * 0.37 + 1.0;
    let at = id * 30u;
    results[at] = lane;
    results[at + 1u] = size;
    results[at + 2u] = subgroup;
    results[at + 3u] = subgroups;
    if (n & 7u) != 0u {
        results[at + 4u] = subgroupBallot((n & 1u) == 1u).x;
        results[at + 5u] = u32(subgroupAll((n & 3u) != 2u));
        results[at + 6u] = u32(subgroupAny((n & 3u) == 2u));
        results[at + 7u] = subgroupAdd(n);
        results[at + 8u] = subgroupMul(n | 1u);
        results[at + 9u] = subgroupMin(n);
        results[at + 10u] = bitcast<u32>(subgroupMax(bitcast<i32>(n) - 9));
        results[at + 11u] = subgroupAnd(n);
        results[at + 12u] = subgroupOr(n);
        results[at + 13u] = subgroupXor(n);
        results[at + 14u] = bitcast<u32>(subgroupAdd(x));
        results[at + 15u] = bitcast<u32>(subgroupMin(-x));
        results[at + 16u] = subgroupInclusiveAdd(n);
        results[at + 17u] = subgroupExclusiveAdd(n);
        results[at + 18u] = bitcast<u32>(subgroupExclusiveMul(x));
        results[at + 19u] = subgroupBroadcastFirst(n);
        results[at + 20u] = subgroupBroadcast(n, 2u);
        results[at + 21u] = subgroupShuffle(n, n % 5u);
        results[at + 22u] = subgroupShuffleDown(n, 1u);
        results[at + 23u] = subgroupShuffleUp(n, 1u);
        results[at + 24u] = subgroupShuffleXor(n, n & 3u);
        results[at + 25u] = quadBroadcast(n, 1u);
        let swapped = vec3(quadSwapX(vec2u(n, id)).y, quadSwapY(n), quadSwapDiagonal(n));
        results[at + 26u] = swapped.x + swapped.y * 1000u + swapped.z * 1000000u;
        results[at + 27u] = subgroupBallot().x;
    }
    subgroupBarrier();
    var sum = 0u;
    for (var turn = 0u; turn < n % 6u; turn++) {
        sum = sum * 31u + subgroupAdd(turn + n);
    }
    results[at + 28u] = sum;
    results[at + 29u] = subgroupAdd(1u);
}
";

/// What the lanes of a subgroup that run have, in their order; others have nothing.
type Lanes<T> = [Option<T>; 4];

fn reduced<T: Copy>(lanes: &Lanes<T>, start: T, combine: impl Fn(T, T) -> T) -> T {
    lanes
        .iter()
        .flatten()
        .fold(start, |sum, one| combine(sum, *one))
}

/// The first lanes, those before `end`.
fn before<T: Copy>(lanes: &Lanes<T>, end: usize) -> Lanes<T> {
    std::array::from_fn(|at| lanes[at].filter(|_| at < end))
}

/// What an invocation writes, which is lane `lane` of a subgroup with these numbers.
fn expected(numbers: &Lanes<u32>, lane: usize, [subgroup, id]: [usize; 2]) -> Vec<u32> {
    let own = numbers[lane].expect("an invocation that there is");
    let mut results = vec![lane as u32, 4, subgroup as u32, GROUP.div_ceil(4) as u32];
    let lanes = numbers.map(|n| n.filter(|n| n & 7 != 0));
    if own & 7 == 0 {
        results.resize(28, 0);
    } else {
        let bits = |vote: &dyn Fn(u32) -> bool| {
            let votes = (0..4).filter(|lane| lanes[*lane].is_some_and(vote));
            votes.fold(0, |bits, lane| bits | 1 << lane)
        };
        let at = |lane: usize| lanes.get(lane).copied().flatten().unwrap_or(0);
        let of = |n: u32| n as f32 * 0.37 + 1.0;
        let floats = lanes.map(|n| n.map(of));
        let all = bits(&|_| true);
        results.extend([
            bits(&|n| n & 1 == 1),
            u32::from(bits(&|n| n & 3 != 2) == all),
            u32::from(bits(&|n| n & 3 == 2) != 0),
            reduced(&lanes, 0, u32::wrapping_add),
            reduced(&lanes.map(|n| n.map(|n| n | 1)), 1, u32::wrapping_mul),
            reduced(&lanes, u32::MAX, u32::min),
            reduced(&lanes.map(|n| n.map(|n| n as i32 - 9)), i32::MIN, i32::max) as u32,
            reduced(&lanes, u32::MAX, |a, b| a & b),
            reduced(&lanes, 0, |a, b| a | b),
            reduced(&lanes, 0, |a, b| a ^ b),
            reduced(&floats, 0.0, |a, b| a + b).to_bits(),
            reduced(&floats.map(|x| x.map(|x| -x)), f32::INFINITY, f32::min).to_bits(),
            reduced(&before(&lanes, lane + 1), 0, u32::wrapping_add),
            reduced(&before(&lanes, lane), 0, u32::wrapping_add),
            reduced(&before(&floats, lane), 1.0, |a, b| a * b).to_bits(),
            *lanes.iter().flatten().next().expect("a lane"),
            at(2),
            at(own as usize % 5),
            at(lane + 1),
            at(lane.wrapping_sub(1)),
            at(lane ^ (own as usize & 3)),
            at(1),
            lanes[lane ^ 1]
                .map_or(0, |_| (id - lane + (lane ^ 1)) as u32)
                .wrapping_add(at(lane ^ 2).wrapping_mul(1000))
                .wrapping_add(at(lane ^ 3).wrapping_mul(1_000_000)),
            all,
        ]);
    }
    let mut sum = 0_u32;
    for turn in 0..own % 6 {
        let running = numbers.map(|n| n.filter(|n| turn < n % 6));
        let added = reduced(&running.map(|n| n.map(|n| turn + n)), 0, u32::wrapping_add);
        sum = sum.wrapping_mul(31).wrapping_add(added);
    }
    results.extend([sum, numbers.iter().flatten().count() as u32]);
    results
}

/// Rows: G5
#[test]
fn subgroups_of_compute_shaders_are_four_invocations() {
    let numbers: Vec<u32> = (0..INVOCATIONS as u32)
        .map(|n| (n.wrapping_mul(2_654_435_761) >> 20) % 97)
        .collect();
    let mut wanted = Vec::new();
    for (group, numbers) in numbers.chunks(GROUP).enumerate() {
        for index in 0..GROUP {
            let (subgroup, lane) = (index / 4, index % 4);
            let of_lanes = std::array::from_fn(|lane| numbers.get(subgroup * 4 + lane).copied());
            let id = group * GROUP + index;
            let results = expected(&of_lanes, lane, [subgroup, id]);
            wanted.extend(results);
        }
    }
    let taking_part = numbers.iter().filter(|n| **n & 7 != 0).count();
    assert!((1..INVOCATIONS).contains(&taking_part));
    for (name, device) in devices() {
        let pipeline = compiled(&device, COMPUTE);
        let results = buffer(&device, &[0; INVOCATIONS * RESULTS]);
        let groups = [group(
            &device,
            &pipeline,
            &[&buffer(&device, &numbers), &results],
        )];
        run(&device, &pipeline, &groups, [GROUPS as u32, 1, 1]);
        let results = words(&results);
        for (id, (got, wanted)) in results
            .chunks(RESULTS)
            .zip(wanted.chunks(RESULTS))
            .enumerate()
        {
            assert_eq!(got, wanted, "{name}: invocation {id}");
        }
    }
}

const QUADS: &str = "
enable subgroups;
@vertex fn vs(@builtin(vertex_index) n: u32) -> @builtin(position) vec4f {
    return vec4f(f32(n & 1u) * 4.0 - 1.0, f32(n >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}
@fragment fn fs(
    @builtin(position) at: vec4f,
    @builtin(subgroup_invocation_id) lane: u32,
) -> @location(0) vec4f {
    let own = floor(at.x) + floor(at.y) * 16.0;
    let across = vec3(quadSwapX(own), quadSwapY(own), quadSwapDiagonal(own));
    return vec4f(across, f32(lane) + subgroupAdd(1.0) * 16.0) / 255.0;
}
";

/// Rows: G5
#[test]
fn subgroups_of_fragment_shaders_are_quads() {
    let size = [16, 10];
    for (name, device) in devices() {
        let module = module(&device, ShaderSource::Wgsl(QUADS));
        let drawn = drawn(&device, &pipeline(&device, &module), &[], size);
        for (at, pixel) in drawn.chunks(4).enumerate() {
            let (x, y) = (at as u32 % size[0], at as u32 / size[0]);
            let number = |x: u32, y: u32| (x + y * 16) as u8;
            let lane = (x & 1 | (y & 1) << 1) as u8;
            let across = [number(x ^ 1, y), number(x, y ^ 1), number(x ^ 1, y ^ 1)];
            let wanted = [across[0], across[1], across[2], 64 + lane];
            assert_eq!(pixel, wanted, "{name}: {x}, {y}");
        }
    }
}
