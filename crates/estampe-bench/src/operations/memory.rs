//! Control flow, arrays, memory and subgroups.

/// A name, and an expression of a word x.
pub(super) const CONTROL_FLOW: &[(&str, &str)] = &[
    ("branch", "branched(x)"),
    ("switch", "switched(x) * 3u + x"),
    ("loop", "repeated(x)"),
];

/// The same, of an invocation whose number in its work-group is i.
pub(super) const MEMORY: &[(&str, &str)] = &[
    ("constants-8", "eight[x & 7u] * 3u + x"),
    ("constants-16", "sixteen[x & 15u] * 3u + x"),
    ("constants-private", "primes[x & 7u] * 3u + x"),
    ("constants-local", "of_squares(x)"),
    ("array-of-values", "of_values(x)"),
    ("array-stored", "stored(x)"),
    ("array-of-structs", "of_structs(x)"),
    ("array-sorted", "sorted(x)"),
    ("matrix-column", "column(x)"),
    ("vector-component", "vec4u(x, 3u, 4u, 5u)[x & 3u] * 3u + x"),
    ("buffer-load", "words[x & 1023u] * 3u + 1u"),
    ("buffer-store", "kept(x)"),
    (
        "buffer-atomicAdd",
        "atomicAdd(&counters[x & 1023u], 1u) * 3u + x",
    ),
    ("workgroup-load", "tile[x & 63u] * 3u + 1u"),
    ("workgroup-store", "shared_word(x, i)"),
    (
        "workgroup-atomicAdd",
        "atomicAdd(&sums[x & 63u], 1u) * 3u + x",
    ),
];

/// The same, of subgroups.
pub(super) const SUBGROUPS: &[(&str, &str)] = &[
    ("subgroupAdd", "subgroupAdd(x) * 3u"),
    (
        "subgroupBroadcastFirst",
        "subgroupBroadcastFirst(x) * 3u + i",
    ),
    ("subgroupShuffleXor", "subgroupShuffleXor(x, 1u) * 3u + 1u"),
    ("subgroupBallot", "subgroupBallot(x > 77u).x * 3u + x"),
];

/// What the expressions need.
pub(super) const DECLARATIONS: &str = "
@group(0) @binding(0) var<storage, read_write> words: array<u32>;
@group(0) @binding(1) var<storage, read_write> counters: array<atomic<u32>, 1024>;
@group(0) @binding(2) var<uniform> settings: vec4u;
var<workgroup> tile: array<u32, 64>;
var<workgroup> sums: array<atomic<u32>, 64>;
var<private> invocation: u32;
var<private> primes: array<u32, 8> = array(2u, 3u, 5u, 7u, 11u, 13u, 17u, 19u);
const eight = array(2u, 3u, 5u, 7u, 11u, 13u, 17u, 19u);
const sixteen = array(2u, 3u, 5u, 7u, 11u, 13u, 17u, 19u, 23u, 29u, 31u, 37u, 41u, 43u, 47u, 53u);
struct Light { at: vec3f, power: f32 }

fn branched(x: u32) -> u32 {
    if (x & 1u) == 0u { return x / 2u; }
    return x * 3u + 1u;
}
fn switched(x: u32) -> u32 {
    switch x & 3u {
        case 0u: { return x + 1u; }
        case 1u: { return x * 3u; }
        case 2u: { return x ^ 99u; }
        default: { return 7u; }
    }
}
fn repeated(x: u32) -> u32 {
    var y = x;
    for (var n = 0u; n < 6u && (y & 7u) != 0u; n++) { y = y * 5u + 3u; }
    return y + 1u;
}
fn of_squares(x: u32) -> u32 {
    var squares = array(0u, 1u, 4u, 9u, 16u, 25u, 36u, 49u);
    return squares[x & 7u] * 3u + x;
}
fn of_values(x: u32) -> u32 {
    var values = array(x, x + 1u, x * 3u, 7u);
    return values[x & 3u] * 3u + 1u;
}
fn stored(x: u32) -> u32 {
    var values: array<u32, 8>;
    values[x & 7u] = x;
    values[(x >> 3u) & 7u] += 3u;
    return values[(x >> 6u) & 7u] + x;
}
fn of_structs(x: u32) -> u32 {
    var lights = array(Light(vec3f(1.0), 2.0), Light(vec3f(3.0), 4.0), Light(vec3f(5.0), 6.0));
    let light = x % 3u;
    return u32(lights[light].at.y + lights[light].power) * 3u + x;
}
fn sorted(x: u32) -> u32 {
    var bytes = array(x & 255u, (x >> 8u) & 255u, (x >> 16u) & 255u, x >> 24u);
    for (var end = 3u; end > 0u; end--) {
        for (var at = 0u; at < end; at++) {
            if bytes[at] > bytes[at + 1u] {
                let less = bytes[at + 1u];
                bytes[at + 1u] = bytes[at];
                bytes[at] = less;
            }
        }
    }
    return bytes[0] * 3u + bytes[3] * 77u + x * 5u;
}
fn column(x: u32) -> u32 {
    let columns = mat3x3f(vec3f(f32(x & 15u)), vec3f(2.0), vec3f(3.0));
    let at = x % 3u;
    return u32(columns[at].y + columns[at].x) * 3u + x;
}
fn kept(x: u32) -> u32 {
    words[settings.y + invocation] = x;
    return words[settings.y + invocation] * 3u;
}
fn shared_word(x: u32, i: u32) -> u32 {
    tile[i] = x;
    return tile[i] * 3u;
}
";
