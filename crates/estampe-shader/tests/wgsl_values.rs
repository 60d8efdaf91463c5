//! WGSL against the same formulas in Rust: one invocation at a time, and on lanes at every SIMD
//! level.
#![expect(
    clippy::cast_possible_truncation,
    reason = "the formulas convert as WGSL does"
)]

use estampe_ir::interface::{Input, Output};
use estampe_ir::interpreter::{Code, InputData, OutputData, Run, Scratch, cells};
use estampe_ir::lanes::{self, Kernel};
use estampe_ir::op::TextureOp;
use estampe_ir::tree::{self, Surroundings, Tree, evaluate};
use estampe_shader::lower::lower;
use estampe_simd::{Level, Packet};
use estampe_types::maths;
use naga::valid::{Capabilities, ValidationFlags, Validator};

const LANES: usize = 16;

/// The tree of the fragment shader of a module.
fn lowered(source: &str) -> Tree {
    let module = naga::front::wgsl::parse_str(source);
    let module = module.unwrap_or_else(|error| panic!("{}", error.emit_to_string(source)));
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::all());
    let info = validator.validate(&module).expect("a valid module");
    let stage = lower(&module, &info, 0).unwrap_or_else(|error| panic!("{error}: {source}"));
    tree::verify(&stage.tree).unwrap_or_else(|error| panic!("{error}: {source}"));
    stage.tree
}

/// A fragment whose varyings are four numbers.
struct Fragment<'a> {
    tree: &'a Tree,
    varyings: [f32; 4],
    none: Vec<u32>,
}

impl Surroundings for Fragment<'_> {
    fn input(&mut self, at: usize) -> u32 {
        match self.tree.interface.inputs[at] {
            Input::Varying(scalar) => self.varyings[scalar as usize].to_bits(),
            Input::Cover => 1,
            other => panic!("{other:?} is not given"),
        }
    }
    fn buffer(&mut self, _at: usize) -> &mut Vec<u32> {
        &mut self.none
    }
    fn workgroup(&mut self) -> &mut Vec<u32> {
        &mut self.none
    }
    fn texture(&mut self, _op: &TextureOp, _operands: &[u32]) -> Vec<u32> {
        Vec::new()
    }
}

/// The first colour of sixteen fragments, as lanes.
fn on_lanes(tree: &Tree, level: Level, varyings: &[[f32; 4]; LANES]) -> [[u32; 4]; LANES] {
    let kernel = Kernel::from_tree(tree);
    lanes::verify(&kernel).expect("a kernel that is one");
    let packets: Vec<_> = (0..4)
        .map(|scalar| Packet(std::array::from_fn(|lane| varyings[lane][scalar])))
        .collect();
    let inputs = kernel.interface.inputs.iter().map(|input| match *input {
        Input::Varying(scalar) => InputData::floats(&packets, scalar as usize, 4),
        Input::Cover => InputData::Uniform(1),
        other => panic!("{other:?} is not given"),
    });
    let inputs: Vec<_> = inputs.collect();
    let mut colors = [Packet([0; LANES]); 4];
    let to = cells(&mut colors);
    let outputs = kernel.interface.outputs.iter().map(|output| match *output {
        Output::Color { component, .. } => OutputData::words(to, component as usize, 4),
        _ => OutputData::Dropped,
    });
    let outputs: Vec<_> = outputs.collect();
    let run = Run {
        inputs: &inputs,
        outputs: &outputs,
        ..Run::new(1)
    };
    let code = Code::new(&kernel);
    code.run(level, &run, &mut Scratch::default())
        .expect("it ends");
    std::array::from_fn(|lane| [0, 1, 2, 3].map(|k: usize| colors[k].0[lane]))
}

/// Inputs that reach every branch: small whole numbers, fractions, signs, zeros and large ones.
fn inputs() -> [[f32; 4]; LANES] {
    std::array::from_fn(|lane| {
        let n = lane as f32;
        let second = if lane % 3 == 0 { -n } else { n * 0.37 };
        [
            n - 4.0,
            second,
            0.25 + n * 0.11,
            if lane == 7 { 0.0 } else { 3.5 - n },
        ]
    })
}

/// Checks the colour that a module gives against `wanted`, to the last bit but for NaN.
#[track_caller]
fn check(source: &str, wanted: impl Fn([f32; 4]) -> [f32; 4]) {
    let tree = lowered(source);
    let inputs = inputs();
    let all_lanes: Vec<_> = Level::all_available()
        .into_iter()
        .map(|level| on_lanes(&tree, level, &inputs))
        .collect();
    for (lane, varyings) in inputs.into_iter().enumerate() {
        let wanted = wanted(varyings);
        let mut fragment = Fragment {
            tree: &tree,
            varyings,
            none: Vec::new(),
        };
        let words = evaluate(&tree, &mut fragment, 1 << 20).expect("it ends");
        let alone = [0, 1, 2, 3].map(|component| {
            let color = Output::Color {
                target: 0,
                component,
            };
            let at = tree.interface.outputs.iter().position(|one| *one == color);
            words[at.expect("a colour")]
        });
        for of_lanes in &all_lanes {
            for component in 0..4 {
                let number = wanted[component];
                for got in [alone[component], of_lanes[lane][component]] {
                    let got_number = f32::from_bits(got);
                    assert!(
                        got == number.to_bits() || got_number.is_nan() && number.is_nan(),
                        "{source}\n{varyings:?}, component {component}: {got_number}, not {number}"
                    );
                }
            }
        }
    }
}

/// Checks one expression of the inputs `v`, of x, y, z and w.
#[track_caller]
fn check_expression(expression: &str, wanted: impl Fn([f32; 4]) -> [f32; 4]) {
    let source = format!(
        "@fragment fn main(@location(0) v: vec4f) -> @location(0) vec4f {{\n\
         let x = v.x; let y = v.y; let z = v.z; let w = v.w;\n\
         let i = i32(x); let u = u32(abs(y));\n\
         return {expression};\n}}"
    );
    check(&source, wanted);
}

#[test]
fn operators_and_conversions() {
    check_expression("v + vec4f(1.0, 2.0, 3.0, 4.0) * 2.0", |[x, y, z, w]| {
        [x + 2.0, y + 4.0, z + 6.0, w + 8.0]
    });
    check_expression("vec4f(x / y, x % z, -w, x - y * z)", |[x, y, z, w]| {
        [x / y, x - z * (x / z).trunc(), -w, x - y * z]
    });
    check_expression(
        "vec4f(f32(i / 3), f32(i % 3), f32(u << 2u), f32(i >> 1u))",
        |[x, y, ..]| {
            let i = x as i32;
            [
                (i / 3) as f32,
                (i % 3) as f32,
                ((y.abs() as u32) << 2) as f32,
                (i >> 1) as f32,
            ]
        },
    );
    check_expression(
        "vec4f(f32(i / (i - i)), f32(u % (u - u)), f32(i & 5), f32(~i))",
        |[x, ..]| {
            let i = x as i32;
            [i as f32, 0.0, (i & 5) as f32, !i as f32]
        },
    );
    check_expression("select(v, v.wzyx, x < y)", |[x, y, z, w]| {
        if x < y { [w, z, y, x] } else { [x, y, z, w] }
    });
    check_expression("vec4f(vec4<bool>(v)) + f32(any(v > vec4f(2.0)))", |v| {
        let any = if v.iter().any(|one| *one > 2.0) {
            1.0
        } else {
            0.0
        };
        v.map(|one| (if one != 0.0 { 1.0 } else { 0.0 }) + any)
    });
    check_expression(
        "bitcast<vec4f>(bitcast<vec4u>(v) & vec4u(0xffff0000u))",
        |v| v.map(|one| f32::from_bits(one.to_bits() & 0xFFFF_0000)),
    );
}

#[test]
fn functions_are_those_of_maths() {
    check_expression("vec4f(sin(x), cos(y), tan(z), exp(w))", |[x, y, z, w]| {
        [maths::sin(x), maths::cos(y), maths::tan(z), maths::exp(w)]
    });
    check_expression(
        "vec4f(pow(z, w), log(z), exp2(x), atan2(y, x))",
        |[x, y, z, w]| {
            [
                maths::pow(z, w),
                maths::log(z),
                maths::exp2(x),
                maths::atan2(y, x),
            ]
        },
    );
    check_expression(
        "vec4f(floor(y), ceil(y), round(y), fract(y))",
        |[_, y, ..]| [y.floor(), y.ceil(), y.round_ties_even(), y - y.floor()],
    );
    check_expression(
        "vec4f(mix(x, y, z), clamp(x, 0.0, 1.0), step(x, y), sign(w))",
        |[x, y, z, w]| {
            [
                maths::mix(x, y, z),
                maths::clamp(x, 0.0, 1.0),
                maths::step(x, y),
                maths::sign(w),
            ]
        },
    );
    check_expression(
        "vec4f(smoothstep(-2.0, 2.0, x), inverseSqrt(z), abs(x), min(x, y))",
        |[x, y, z, _]| {
            [
                maths::smoothstep(-2.0_f32, 2.0, x),
                1.0 / z.sqrt(),
                x.abs(),
                if x < y { x } else { y },
            ]
        },
    );
    check_expression("vec4f(normalize(v.xyz), length(v))", |[x, y, z, w]| {
        let factor = 1.0 / (x * x + y * y + z * z).sqrt();
        [
            x * factor,
            y * factor,
            z * factor,
            (x * x + y * y + z * z + w * w).sqrt(),
        ]
    });
    check_expression(
        "vec4f(cross(v.xyz, v.yzw), dot(v, v.wzyx))",
        |[x, y, z, w]| {
            [
                y * w - z * z,
                z * y - x * w,
                x * z - y * y,
                x * w + y * z + z * y + w * x,
            ]
        },
    );
    check_expression(
        "vec4f(f32(countOneBits(u)), f32(firstLeadingBit(u)), f32(reverseBits(u)), f32(extractBits(i, 1u, 3u)))",
        |[x, y, ..]| {
            let (i, u) = (x as i32, y.abs() as u32);
            let leading = if u == 0 {
                u32::MAX
            } else {
                31 - u.leading_zeros()
            };
            [
                u.count_ones() as f32,
                leading as f32,
                u.reverse_bits() as f32,
                ((i << 28) >> 29) as f32,
            ]
        },
    );
    check_expression(
        "vec4f(vec4i(sign(vec2i(i)), vec2i(sign(vec2u(u, u | 0x80000000u)))))",
        |[x, y, ..]| {
            let (i, u) = (x as i32, y.abs() as u32);
            let sign = i.signum() as f32;
            [sign, sign, u.min(1) as f32, 1.0]
        },
    );
    check_expression("vec4f(unpack4xI8(pack4xI8(vec4i(v * 100.0))))", |v| {
        v.map(|one| f32::from((one * 100.0) as i32 as i8))
    });
    check_expression("vec4f(unpack4xU8(pack4xU8(vec4u(abs(v) * 100.0))))", |v| {
        v.map(|one| f32::from((one.abs() * 100.0) as u32 as u8))
    });
    check_expression("vec4f(unpack4xI8(pack4xI8Clamp(vec4i(v * 100.0))))", |v| {
        v.map(|one| ((one * 100.0) as i32).clamp(-128, 127) as f32)
    });
    check_expression(
        "vec4f(unpack4xU8(pack4xU8Clamp(vec4u(abs(v) * 100.0))))",
        |v| v.map(|one| ((one.abs() * 100.0) as u32).min(255) as f32),
    );
    check_expression(
        "vec4f(f32(dot4I8Packed(pack4xI8(vec4i(v * 9.0)), 0xFE03FF7Fu)), \
         f32(dot4U8Packed(pack4xU8(vec4u(abs(v) * 9.0)), 0xFE03FF7Fu)), 0, 0)",
        |v| {
            let dot = |bytes: [i32; 4], by: [i32; 4]| {
                bytes.iter().zip(by).map(|(a, b)| a * b).sum::<i32>() as f32
            };
            let signed = v.map(|one| i32::from((one * 9.0) as i32 as i8));
            let unsigned = v.map(|one| i32::from((one.abs() * 9.0) as u32 as u8));
            [
                dot(signed, [127, -1, 3, -2]),
                dot(unsigned, [127, 255, 3, 254]),
                0.0,
                0.0,
            ]
        },
    );
    check_expression("unpack4x8unorm(pack4x8unorm(v))", |v| {
        v.map(|one| (0.5 + one.clamp(0.0, 1.0) * 255.0).floor() / 255.0)
    });
}

/// The fraction from ½ to 1 and the exponent of a number, by division.
fn frexp(x: f32) -> (f32, i32) {
    if x == 0.0 || !x.is_finite() {
        return (x, 0);
    }
    let (mut fraction, mut exponent) = (f64::from(x), 0);
    while fraction.abs() >= 1.0 {
        (fraction, exponent) = (fraction / 2.0, exponent + 1);
    }
    while fraction.abs() < 0.5 {
        (fraction, exponent) = (fraction * 2.0, exponent - 1);
    }
    (fraction as f32, exponent)
}

#[test]
fn fractions_and_exponents_are_those_of_division() {
    // From the smallest subnormal number to the largest number, infinities and NaN.
    for scale in [0_u32, 1, 0x0040_0001, 0x0080_0000, 0x3F7F_FFFF, 0x7F00_0000] {
        let number = f32::from_bits(scale);
        let expression = format!(
            "vec4f(frexp(v * bitcast<f32>({scale}u)).fract.xy, \
             vec2f(frexp(v.zw * bitcast<f32>({scale}u)).exp))"
        );
        check_expression(&expression, |v| {
            let [x, y, z, w] = v.map(|one| frexp(one * number));
            [x.0, y.0, z.1 as f32, w.1 as f32]
        });
    }
    check_expression(
        "vec4f(frexp(x / 0.0 * z).fract, f32(frexp(1.0 / (y - y)).exp), frexp(w).fract, 0)",
        |v| {
            let [x, _, z, w] = v;
            [frexp(x / 0.0 * z).0, 0.0, frexp(w).0, 0.0]
        },
    );
}

#[test]
fn matrices_are_columns() {
    check_expression("mat4x4f(v, v.yzwx, v.zwxy, v.wxyz) * v", |v| {
        let [x, y, z, w] = v;
        let columns = [[x, y, z, w], [y, z, w, x], [z, w, x, y], [w, x, y, z]];
        [0, 1, 2, 3].map(|row: usize| {
            columns[0][row] * x + columns[1][row] * y + columns[2][row] * z + columns[3][row] * w
        })
    });
    check_expression(
        "vec4f(determinant(mat2x2f(v.xy, v.zw)), transpose(mat2x3f(v.xyz, v.yzw))[1], 0.0)",
        |[x, y, z, w]| [x * w - y * z, y, z, 0.0],
    );
}

#[test]
fn control_flow_of_every_form() {
    let source = "
        fn collatz(start: u32) -> u32 {
            var n = start; var steps = 0u;
            loop {
                if n <= 1u { break; }
                if n % 2u == 0u { n = n / 2u; steps++; continue; }
                n = 3u * n + 1u;
                steps++;
                if steps > 100u { return 1000u; }
            }
            return steps;
        }
        fn kind(n: i32) -> f32 {
            switch n {
                case 0: { return 10.0; }
                case 1, 2: { if n == 1 { break; } return 20.0; }
                case -3: { return 30.0; }
                default: { return 40.0; }
            }
            return 50.0;
        }
        fn sum(limit: i32) -> f32 {
            var total = 0.0;
            for (var i = 0; i < 10; i++) {
                for (var j = 0; j < i; j++) {
                    if j == 2 { continue; }
                    if i + j > limit { return total; }
                    total += f32(i * j);
                }
            }
            return total;
        }
        fn swap(a: ptr<function, f32>, b: ptr<function, f32>) {
            let t = *a; *a = *b; *b = t;
        }
        @fragment fn main(@location(0) v: vec4f) -> @location(0) vec4f {
            var p = v.z; var q = v.w;
            if v.x > 0.0 { swap(&p, &q); }
            while p > 2.0 { p -= 1.0; }
            return vec4f(f32(collatz(u32(abs(v.x)) + 1u)), kind(i32(v.x)), sum(i32(v.w) + 8), p);
        }";
    check(source, |[x, _, z, w]| {
        let mut n = x.abs() as u32 + 1;
        let mut steps = 0;
        while n > 1 {
            n = if n.is_multiple_of(2) {
                n / 2
            } else {
                3 * n + 1
            };
            steps += 1;
        }
        let kind = match x as i32 {
            0 => 10.0,
            1 => 50.0,
            2 => 20.0,
            -3 => 30.0,
            _ => 40.0,
        };
        let limit = w as i32 + 8;
        let mut total = 0.0;
        'all: for i in 0..10 {
            for j in 0..i {
                if j == 2 {
                    continue;
                }
                if i + j > limit {
                    break 'all;
                }
                total += (i * j) as f32;
            }
        }
        let mut p = if x > 0.0 { w } else { z };
        while p > 2.0 {
            p -= 1.0;
        }
        [steps as f32, kind, total, p]
    });
}

#[test]
fn arrays_structs_and_private_variables() {
    let source = "
        struct Item { weight: f32, parts: array<vec2f, 3> }
        var<private> count: i32 = 2;
        const table = array<f32, 12>(1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0, 128.0, 256.0, 512.0, 1024.0, 2048.0);
        fn bump() -> i32 { count += 3; return count; }
        @fragment fn main(@location(0) v: vec4f) -> @location(0) vec4f {
            var item = Item(v.x, array<vec2f, 3>(v.xy, v.yz, v.zw));
            let at = u32(abs(v.y)) % 3u;
            item.parts[at].y = 9.0;
            item.parts[1] += vec2f(1.0);
            var grid: array<array<f32, 4>, 4>;
            grid[at][2] = v.w;
            let b = bump() + bump();
            return vec4f(item.parts[at].y, table[at * 4u + 1u] + item.weight, f32(b + count), grid[1][2] + v[at]);
        }";
    check(source, |v| {
        let [x, y, z, w] = v;
        let at = y.abs() as usize % 3;
        let mut parts = [[x, y], [y, z], [z, w]];
        parts[at][1] = 9.0;
        parts[1] = parts[1].map(|part| part + 1.0);
        let table = 2.0_f32.powi(at as i32 * 4 + 1);
        let grid = if at == 1 { w } else { 0.0 };
        [parts[at][1], table + x, 21.0, grid + v[at]]
    });
}

/// Arrays to which nothing is stored are tables, one for the same words; those that are stored to,
/// also through pointers, are not.
#[test]
fn arrays_of_constants() {
    let source = "
        var<private> primes: array<u32, 9> = array(2u, 3u, 5u, 7u, 11u, 13u, 17u, 19u, 23u);
        var<private> counts: array<u32, 9> = array(2u, 3u, 5u, 7u, 11u, 13u, 17u, 19u, 23u);
        const halves = array(0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 4.5);
        fn count(i: u32) { counts[i] += 1u; }
        fn replace(list: ptr<function, array<f32, 4>>, i: u32) { (*list)[i] = -1.0; }
        fn square(i: u32) -> f32 { var list = array(0.0, 1.0, 4.0, 9.0); return list[i]; }
        @fragment fn main(@location(0) v: vec4f) -> @location(0) vec4f {
            let at = u32(abs(v.y)) % 3u;
            var changed = array(0.0, 1.0, 4.0, 9.0);
            replace(&changed, at);
            var pairs = array(vec2f(1.0, 2.0), vec2f(3.0, 4.0), vec2f(5.0, 6.0));
            var flags = array(true, false, true);
            count(at);
            return vec4f(
                changed[at] + changed[at + 1u],
                square(at + 1u) + square(at) + pairs[at].y,
                f32(primes[at * 4u] + counts[at] + primes[at + 99u]),
                halves[at + 7u] + select(10.0, 20.0, flags[at]));
        }";
    check(source, |[_, y, ..]| {
        let at = y.abs() as usize % 3;
        let primes = [2.0, 3.0, 5.0, 7.0, 11.0, 13.0, 17.0, 19.0, 23.0];
        let square = |n: usize| (n * n) as f32;
        [
            square(at + 1) - 1.0,
            square(at + 1) + square(at) + (2 * at + 2) as f32,
            primes[at * 4] + primes[at] + 1.0 + 23.0,
            [4.0, 4.5, 4.5][at] + if at == 1 { 10.0 } else { 20.0 },
        ]
    });
    let tree = lowered(source);
    let tables = tree.interface.locals.iter().map(|array| &array.init);
    let mut tables: Vec<usize> = tables
        .filter(|init| !init.is_empty())
        .map(Vec::len)
        .collect();
    tables.sort_unstable();
    // The squares, the pairs, the halves and the primes.
    assert_eq!(tables, [4, 6, 9, 9]);
}

#[test]
fn discarded_fragments_are_not_covered() {
    let tree = lowered(
        "@fragment fn main(@location(0) v: vec4f) -> @location(0) vec4f {
            if v.x < 0.0 { discard; }
            return v;
        }",
    );
    let at = tree
        .interface
        .outputs
        .iter()
        .position(|one| *one == Output::Cover);
    for (x, covered) in [(-1.0, 0), (1.0, 1)] {
        let mut fragment = Fragment {
            tree: &tree,
            varyings: [x, 0.0, 0.0, 0.0],
            none: Vec::new(),
        };
        let outputs = evaluate(&tree, &mut fragment, 1000).expect("it ends");
        assert_eq!(outputs[at.expect("the cover is an output")], covered);
    }
}
