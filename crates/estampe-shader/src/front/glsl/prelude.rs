//! Functions that naga does not have, written in GLSL.

use std::fmt::Write as _;

use super::unit::Unit;

/// A function of numbers that works on vectors component by component.
struct OfNumbers {
    name: &'static str,
    /// The type of the result.
    result: Number,
    /// The type of each parameter, and whether it is a second result. They are called `a` to `d`.
    parameters: &'static [(Number, bool)],
    /// The body for numbers.
    body: &'static str,
}

#[derive(Clone, Copy)]
enum Number {
    Float,
    Int,
    Uint,
}

use Number::{Float, Int, Uint};

impl Number {
    /// The type of so many.
    fn of(self, count: usize) -> String {
        let (number, prefix) = match self {
            Float => ("float", ""),
            Int => ("int", "i"),
            Uint => ("uint", "u"),
        };
        match count {
            1 => number.to_owned(),
            _ => format!("{prefix}vec{count}"),
        }
    }
}

const NAMES: [char; 4] = ['a', 'b', 'c', 'd'];
const COMPONENTS: [char; 4] = ['x', 'y', 'z', 'w'];

/// GLSL 4.60, sections 8.3 and 8.8. `frexp` of 0, an infinity or NaN gives it back, with an
/// exponent of 0; numbers below the smallest normal one are made larger first.
const OF_NUMBERS: [OfNumbers; 6] = [
    OfNumbers {
        name: "modf",
        result: Float,
        parameters: &[(Float, false), (Float, true)],
        body: "b = trunc(a); return a - b;",
    },
    OfNumbers {
        name: "frexp",
        result: Float,
        parameters: &[(Float, false), (Int, true)],
        body: "int low = 0; float x = a; \
               if (abs(x) < 1.1754944e-38) { x *= 16777216.0; low = 24; } \
               uint bits = floatBitsToUint(x); int power = int((bits >> 23) & 255u); \
               if (x == 0.0 || power == 255) { b = 0; return a; } \
               b = power - 126 - low; \
               return uintBitsToFloat((bits & 0x807FFFFFu) | 0x3F000000u);",
    },
    OfNumbers {
        name: "uaddCarry",
        result: Uint,
        parameters: &[(Uint, false), (Uint, false), (Uint, true)],
        body: "uint sum = a + b; c = uint(sum < a); return sum;",
    },
    OfNumbers {
        name: "usubBorrow",
        result: Uint,
        parameters: &[(Uint, false), (Uint, false), (Uint, true)],
        body: "c = uint(a < b); return a - b;",
    },
    // The upper word of a product is made of those of the halves of its factors.
    OfNumbers {
        name: "umulExtended",
        result: Uint,
        parameters: &[(Uint, false), (Uint, false), (Uint, true), (Uint, true)],
        body: "uint p = a & 65535u; uint q = a >> 16; uint r = b & 65535u; uint s = b >> 16; \
               uint low = q * r + ((p * r) >> 16); uint mid = p * s + (low & 65535u); \
               c = q * s + (low >> 16) + (mid >> 16); d = a * b; return;",
    },
    OfNumbers {
        name: "imulExtended",
        result: Int,
        parameters: &[(Int, false), (Int, false), (Int, true), (Int, true)],
        body: "uint p = uint(a) & 65535u; uint q = uint(a) >> 16; \
               uint r = uint(b) & 65535u; uint s = uint(b) >> 16; \
               uint low = q * r + ((p * r) >> 16); uint mid = p * s + (low & 65535u); \
               uint high = q * s + (low >> 16) + (mid >> 16); \
               if (a < 0) { high -= uint(b); } if (b < 0) { high -= uint(a); } \
               c = int(high); d = a * b; return;",
    },
];

/// The functions that have no result but their last parameters.
fn is_void(function: &OfNumbers) -> bool {
    function.body.ends_with("return;")
}

/// The text of the functions that a shader uses and naga does not have.
pub(super) fn functions(unit: &Unit) -> String {
    let is_needed = |name: &str| unit.used.contains(name) && !unit.has_function(name);
    let mut text = String::new();
    for function in OF_NUMBERS.iter().filter(|one| is_needed(one.name)) {
        for count in 1..=4 {
            add_of_numbers(&mut text, function, count);
        }
    }
    for columns in 2..=4 {
        for rows in 2..=4 {
            if is_needed("matrixCompMult") {
                add_product(&mut text, columns, rows);
            }
        }
    }
    text
}

/// A function for numbers, or for vectors by that for numbers.
fn add_of_numbers(text: &mut String, function: &OfNumbers, count: usize) {
    let name = function.name;
    let result = match is_void(function) {
        true => "void".to_owned(),
        false => function.result.of(count),
    };
    let parameters = || NAMES.into_iter().zip(function.parameters);
    let declared: Vec<_> = parameters()
        .map(|(name, (number, is_out))| {
            let way = if *is_out { "out " } else { "" };
            format!("{way}{} {name}", number.of(count))
        })
        .collect();
    let _ = write!(text, "{result} {name}({}) {{ ", declared.join(", "));
    if count == 1 {
        let _ = write!(text, "{} }} ", function.body);
        return;
    }
    // Second results are numbers of their own: `b0`.
    let of_component = |at: usize| {
        let arguments = parameters().map(|(name, (_, is_out))| match is_out {
            true => format!("{name}{at}"),
            false => format!("{name}.{}", COMPONENTS[at]),
        });
        format!("{name}({})", arguments.collect::<Vec<_>>().join(", "))
    };
    let outs = || parameters().filter(|(_, (_, is_out))| *is_out);
    for (name, (number, _)) in outs() {
        for at in 0..count {
            let _ = write!(text, "{} {name}{at}; ", number.of(1));
        }
    }
    for at in 0..count {
        let _ = match is_void(function) {
            true => write!(text, "{}; ", of_component(at)),
            false => write!(
                text,
                "{} r{at} = {}; ",
                function.result.of(1),
                of_component(at)
            ),
        };
    }
    let all = |name: char| {
        (0..count)
            .map(|at| format!("{name}{at}"))
            .collect::<Vec<_>>()
    };
    for (name, (number, _)) in outs() {
        let _ = write!(
            text,
            "{name} = {}({}); ",
            number.of(count),
            all(name).join(", ")
        );
    }
    if !is_void(function) {
        let _ = write!(text, "return {result}({}); ", all('r').join(", "));
    }
    text.push_str("} ");
}

/// `matrixCompMult`, column by column.
fn add_product(text: &mut String, columns: usize, rows: usize) {
    let ty = match columns == rows {
        true => format!("mat{columns}"),
        false => format!("mat{columns}x{rows}"),
    };
    let products: Vec<_> = (0..columns)
        .map(|at| format!("a[{at}] * b[{at}]"))
        .collect();
    let products = products.join(", ");
    let _ = write!(
        text,
        "{ty} matrixCompMult({ty} a, {ty} b) {{ return {ty}({products}); }} "
    );
}
