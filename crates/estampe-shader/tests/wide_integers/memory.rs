//! Control flow and memory.

use super::run::{GROUP, run_all};
use estampe_shader::front::Source;

const COUNT: usize = 128;

/// Random numbers, among them small ones.
fn random(seed: u64, count: usize) -> Vec<u64> {
    let mut random = fastrand::Rng::with_seed(seed);
    (0..count)
        .map(|_| random.u64(..) >> random.u32(0..64))
        .collect()
}

#[track_caller]
fn check(source: &str, read: &[&[u64]], wanted: &[u64]) {
    for (how, out) in run_all(Source::Wgsl(source), read, wanted.len(), COUNT) {
        assert_eq!(out, wanted, "{how}");
    }
}

#[test]
fn loops_count_beyond_32_bits() {
    let source = format!(
        "@group(0) @binding(0) var<storage, read_write> out: array<u64>;
        @group(0) @binding(1) var<storage, read> data: array<u64>;
        fn collatz(start: u64) -> u64 {{
            var n = start; var steps = 0lu;
            while n > 1lu && steps < 300lu {{
                if n % 2lu == 0lu {{ n /= 2lu; }} else {{ n = 3lu * n + 1lu; }}
                steps++;
            }}
            return steps;
        }}
        fn sum(first: i64) -> i64 {{
            var total = 0li;
            for (var i = first; i <= first + 20li; i += 3li) {{
                if i % 2li == 0li {{ continue; }}
                if total > 40000000000li {{ return total - 1li; }}
                total += i;
            }}
            return total;
        }}
        @compute @workgroup_size({GROUP})
        fn main(@builtin(global_invocation_id) id: vec3u) {{
            let n = data[id.x];
            out[id.x] = (collatz(n) << 48u) + u64(sum(i64(id.x) + 8589934588li));
        }}"
    );
    let data = random(1, COUNT);
    let row = |(id, &n): (usize, &u64)| {
        let (mut n, mut steps) = (n, 0_u64);
        while n > 1 && steps < 300 {
            n = if n % 2 == 0 {
                n / 2
            } else {
                n.wrapping_mul(3).wrapping_add(1)
            };
            steps += 1;
        }
        let first = id as u64 + 8_589_934_588;
        let mut total = 0_u64;
        for i in (first..=first + 20).step_by(3) {
            if i % 2 == 0 {
                continue;
            }
            if total > 40_000_000_000 {
                total -= 1;
                break;
            }
            total += i;
        }
        (steps << 48).wrapping_add(total)
    };
    let wanted: Vec<_> = data.iter().enumerate().map(row).collect();
    check(&source, &[&data], &wanted);
}

#[test]
fn variables_of_every_kind() {
    let source = format!(
        "struct Item {{ first: u32, many: array<i64, 3>, pair: vec2<u64>, flag: bool, last: u64 }}
        @group(0) @binding(0) var<storage, read_write> out: array<u64>;
        @group(0) @binding(1) var<storage, read> data: array<u64>;
        var<private> counter: u64 = 0xFFFFFFFFlu;
        var<private> table: array<u64, 12>;
        var<workgroup> shared_sums: array<vec2<u64>, {GROUP}>;
        const primes = array<u64, 10>(2lu, 3lu, 5lu, 7lu, 11lu, 13lu, 17lu, 19lu, 23lu, 0x1D00000000lu);
        fn swap(a: ptr<function, u64>, b: ptr<function, u64>) {{ let t = *a; *a = *b; *b = t; }}
        fn bump(by: ptr<function, u64>) -> u64 {{ counter += *by; *by += 1lu; return counter; }}
        @compute @workgroup_size({GROUP})
        fn main(@builtin(global_invocation_id) id: vec3u, @builtin(local_invocation_index) i: u32) {{
            let n = data[id.x];
            let at = id.x % 12u;
            for (var k = 0u; k < 12u; k++) {{ table[k] = n + u64(k); }}
            table[at] ^= 0xFF00000000lu;
            var a = n; var b = 5lu;
            if n % 3lu == 0lu {{ swap(&a, &b); }}
            let bumped = bump(&a) + bump(&a);
            var item = Item(1u, array<i64, 3>(1li, -2li, 3li), vec2(a, b), true, 9lu);
            item.many[at % 3u] -= i64(n);
            item.pair[id.x % 2u] += 0x100000000lu;
            item.pair.y *= 3lu;
            if item.flag {{ item.last = u64(item.many[(at + 1u) % 3u]); }}
            var copy = item;
            copy.many[2] = 77li;
            shared_sums[i] = vec2(n, item.last);
            workgroupBarrier();
            let other = shared_sums[{GROUP}u - 1u - i];
            let value = array<u64, 3>(a, b, n);
            out[id.x] = table[(at + 5u) % 12u] + table[at] * 3lu + bumped + item.pair.x * 5lu
                + item.pair.y * 7lu + item.last * 11lu + u64(item.many[2]) * 13lu
                + u64(copy.many[0]) * 17lu + other.x * 19lu + other.y * 23lu
                + primes[id.x % 10u] * 29lu + value[n % 3lu] * 31lu + counter;
        }}"
    );
    let data = random(2, COUNT);
    let last = |id: usize| {
        let mut many = [1_i64, -2, 3];
        let at = id % 12;
        many[at % 3] = many[at % 3].wrapping_sub(data[id].cast_signed());
        (many, many[(at + 1) % 3].cast_unsigned())
    };
    let row = |id: usize| {
        let n = data[id];
        let at = id % 12;
        let mut table: [u64; 12] = std::array::from_fn(|k| n.wrapping_add(k as u64));
        table[at] ^= 0xFF_0000_0000;
        let (mut a, b) = if n.is_multiple_of(3) { (5, n) } else { (n, 5) };
        let mut counter = 0xFFFF_FFFF_u64;
        let mut bumped = 0_u64;
        for _ in 0..2 {
            counter = counter.wrapping_add(a);
            a = a.wrapping_add(1);
            bumped = bumped.wrapping_add(counter);
        }
        let mut pair = [a, b];
        pair[id % 2] = pair[id % 2].wrapping_add(1 << 32);
        pair[1] = pair[1].wrapping_mul(3);
        let (many, of_item) = last(id);
        let other = id / GROUP * GROUP + GROUP - 1 - id % GROUP;
        let primes = [2, 3, 5, 7, 11, 13, 17, 19, 23, 0x1D_0000_0000];
        let value = [a, b, n][usize::try_from(n % 3).expect("it is below 3")];
        let terms = [
            (table[(at + 5) % 12], 1),
            (table[at], 3),
            (bumped, 1),
            (pair[0], 5),
            (pair[1], 7),
            (of_item, 11),
            (many[2].cast_unsigned(), 13),
            (many[0].cast_unsigned(), 17),
            (data[other], 19),
            (last(other).1, 23),
            (primes[id % 10], 29),
            (value, 31),
            (counter, 1),
        ];
        let products = terms.into_iter().map(|(x, factor)| x.wrapping_mul(factor));
        products.fold(0, u64::wrapping_add)
    };
    let wanted: Vec<_> = (0..COUNT).map(row).collect();
    check(&source, &[&data], &wanted);
}

#[test]
fn buffers_have_the_layout_of_the_host() {
    let source = format!(
        "struct Row {{ small: u32, wide: i64, three: vec3<u64>, tail: u32 }}
        @group(0) @binding(0) var<storage, read_write> out: array<array<vec2<u64>, 2>>;
        @group(0) @binding(1) var<uniform> factors: vec4<u64>;
        @group(0) @binding(2) var<storage, read> rows: array<Row>;
        @compute @workgroup_size({GROUP})
        fn main(@builtin(global_invocation_id) id: vec3u) {{
            let row = rows[id.x];
            let at = u64(id.x) + 0x700000000lu * u64(id.x % 2u);
            var parts: array<u64, 9>;
            for (var k = 0u; k < 9u; k++) {{ parts[k] = row.three.x * u64(k); }}
            out[id.x][0] = vec2(u64(row.small) * factors.x, u64(row.wide) + factors[id.x % 4u]);
            out[id.x][1].x = row.three.y + row.three[id.x % 3u];
            // Indices of 64 bits that are too large, or negative, give the last part.
            let part = parts[at] + array<u64, 3>(1lu, 2lu, 3lu)[i64(at) - 1li];
            out[id.x][1].y = part + u64(row.tail) + u64(arrayLength(&rows)) + rows[u32(min(at, 127lu))].three.z;
        }}"
    );
    // small, wide, padding of 16 bytes, three, tail: the alignment of a `vec3<u64>` is 32.
    let rows = random(3, COUNT * 8);
    let factors = random(4, 4);
    let mut wanted = Vec::new();
    for id in 0..COUNT {
        let row = &rows[id * 8..][..8];
        let low = |at: usize| row[at] & 0xFFFF_FFFF;
        let three = [row[4], row[5], row[6]];
        let is_beyond = id % 2 == 1;
        let at = if is_beyond { 8 } else { id.min(8) };
        let small = if is_beyond || id == 0 {
            2
        } else {
            (id - 1).min(2)
        };
        let part = three[0]
            .wrapping_mul(at as u64)
            .wrapping_add(small as u64 + 1);
        wanted.extend([
            low(0).wrapping_mul(factors[0]),
            row[1].wrapping_add(factors[id % 4]),
            three[1].wrapping_add(three[id % 3]),
            part.wrapping_add(low(7) + COUNT as u64)
                .wrapping_add(if id % 2 == 0 {
                    three[2]
                } else {
                    rows[127 * 8 + 6]
                }),
        ]);
    }
    check(&source, &[&factors, &rows], &wanted);
}
