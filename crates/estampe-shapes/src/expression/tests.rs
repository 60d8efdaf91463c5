use std::f64::consts::{E, PI, TAU};

use fastrand::Rng;

use super::function::{CALLABLES, Callable};
use super::*;

const XY: &[&str] = &["x", "y"];

fn parsed(text: &str) -> Expression {
    Expression::parse(text, XY).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn values_follow_the_grammar() {
    for (text, expected) in [
        ("1 + 2 * 3", 7.0),
        ("(1 + 2) * 3", 9.0),
        ("2^3^2", 512.0),
        ("-2^2", -4.0),
        ("(-2)^2", 4.0),
        ("2^-1", 0.5),
        ("--3 - -+2", 5.0),
        ("10 - 4 - 3", 3.0),
        ("64 / 4 / 2", 8.0),
        ("2*3^2", 18.0),
        ("1e3 + 2.5E-1 + .5 + 3.", 1003.75),
        ("e", E),
        ("2*e - 2*e", 0.0),
        ("tau / pi", 2.0),
        ("x - 10*y", 3.0 - 70.0),
        ("min(3, x, 5) + max(1, 2, y)", 3.0 + 7.0),
        ("atan2(1, -1)", 0.75 * PI),
        ("floor(-1.5) + sign(-2) + abs(-3) + sign(0)", 0.0),
        ("log2(8) + ln(e) + sqrt(16) + exp(0)", 9.0),
        ("pow(2, 10) + 2^0.5*2^0.5", 1024.0 + 2.0),
        (
            "sin(pi/2) + cos(0) + tan(0) + asin(1) + acos(1) + atan(1)",
            2.0 + 0.75 * PI,
        ),
        ("sinh(0) + cosh(0) + tanh(0)", 1.0),
        (" \tx\r\n+ y ", 10.0),
        ("x^20 / x^19", 3.0),
    ] {
        let value = parsed(text).value(&[3.0, 7.0]);
        assert!((value - expected).abs() < 1e-12, "{text} is {value}");
    }
    for text in [
        "sqrt(-x)",
        "ln(-1)",
        "min(0/0, 1)",
        "max(1, 0/0)",
        "sign(0/0)",
        "asin(2)",
    ] {
        assert!(parsed(text).value(&[3.0, 7.0]).is_nan(), "{text}");
    }
    assert!(parsed("x + y").value(&[1.0]).is_nan(), "a missing argument");
}

#[test]
fn lists_and_equations() {
    let list = Expression::parse_list(" x, atan2(y, x) ,2", XY).unwrap();
    let texts: Vec<&str> = list.iter().map(Expression::text).collect();
    assert_eq!(texts, ["x", "atan2(y, x)", "2"]);
    assert!(list[1].uses(0) && list[1].uses(1) && !list[0].uses(1) && !list[2].uses(0));
    let circle = Expression::parse_equation("x^2 + y^2 = 25", XY).unwrap();
    assert_eq!(circle.value(&[3.0, 4.0]), 0.0);
    assert_eq!(circle.value(&[3.0, 5.0]), 9.0);
    assert_eq!(
        Expression::parse_equation("x - y", XY)
            .unwrap()
            .value(&[3.0, 1.0]),
        2.0
    );
}

/// Every kind of mistake, with its message and the text under the carets.
#[test]
fn mistakes_are_shown_with_a_caret() {
    for (text, marked, said) in [
        ("", "", "is empty"),
        ("  ", "", "is empty"),
        (
            "sni(x) + 1",
            "sni",
            "unknown function `sni`; did you mean `sin`?",
        ),
        ("1 + squrt(x)", "squrt", "did you mean `sqrt`?"),
        ("gamma(x)", "gamma", "there are sin, cos"),
        ("tua + 1", "tua", "did you mean `tau`?"),
        ("x + u", "u", "the variables are `x` and `y`"),
        ("sin x", "sin", "write its argument"),
        ("x(3)", "x", "is not a function; to multiply, write `x*(`"),
        ("2x + 1", "x", "an operator is missing between `2` and `x`"),
        ("x y", "y", "an operator is missing"),
        ("(x) (y)", "(", "an operator is missing"),
        ("1.2.3", ".3", "an operator is missing"),
        ("2 ** 3", "*", "for a power write `^`"),
        ("x +", "", "ends too early"),
        ("x + * y", "*", "before this `*`"),
        ("(x + 1", "(", "is not closed"),
        ("sin(x", "(", "is not closed"),
        ("x + 1)", ")", "there is no `(`"),
        ("(x, y)", ",", "is not possible here"),
        ("sin()", "sin", "needs an argument"),
        ("sin(x, y)", "sin(x, y)", "takes 1 argument, not 2"),
        ("1 + atan2(x)", "atan2(x)", "takes 2 arguments, not 1"),
        ("max(x)", "max(x)", "takes 2 or more arguments, not 1"),
        ("x = 1", "=", "an equation is not possible here"),
        ("x, y", ",", "one expression"),
        ("x # y", "#", "unknown character `#`"),
        ("x − y", "−", "unknown character `−`; write `-`"),
        ("2*π", "π", "write `pi`"),
        ("1e999", "1e999", "too large"),
        (".", ".", "is not a number"),
    ] {
        let error = Expression::parse(text, XY).unwrap_err();
        assert!(
            error.message().contains(said),
            "{text}: {}",
            error.message()
        );
        assert_eq!(&text[error.span()], marked, "{text}: {}", error.message());
        let shown = error.to_string();
        let [message, line, carets] = shown.lines().collect::<Vec<_>>()[..] else {
            panic!("three lines: {shown}");
        };
        assert_eq!(message, error.message());
        assert_eq!(line.trim_end(), format!("  {text}").trim_end());
        let before = text[..error.span().start].chars().count();
        let marks = marked.chars().count().max(1);
        assert_eq!(
            carets,
            format!("  {}{}", " ".repeat(before), "^".repeat(marks))
        );
    }
    assert_eq!(
        Expression::parse("sni(x) + 1", XY).unwrap_err().to_string(),
        "unknown function `sni`; did you mean `sin`?\n  sni(x) + 1\n  ^^^"
    );
}

#[test]
fn long_and_deep_texts_are_errors_with_a_short_picture() {
    let long = "x+".repeat(MAX_LENGTH);
    let deep = "(".repeat(10_000);
    let signs = "-".repeat(10_000);
    let powers = "x^".repeat(4_000) + "x";
    let name = "a".repeat(9_000);
    let wide = format!("min({}x)", "x,".repeat(4_000));
    let right = format!("{}x{}", "1-x*(".repeat(60), ")".repeat(60));
    for text in [&long, &deep, &signs, &powers, &name, &wide, &right] {
        let error = Expression::parse(text, XY).unwrap_err();
        let shown = error.to_string();
        assert!(
            shown.lines().all(|line| line.chars().count() < 250),
            "{shown}"
        );
        assert_eq!(shown.lines().count(), 3, "{shown}");
    }
    let sum = "x+".repeat(4_000) + "1";
    assert_eq!(parsed(&sum).value(&[0.25, 0.0]), 1001.0);
    // The mistake stays in the window, wherever it is in a long text.
    for before in [0, 10, 40, 100, 1_500] {
        let text = format!(
            "{}1 + oops + 1{}",
            "x + ".repeat(before),
            " + y".repeat(500)
        );
        let shown = Expression::parse(&text, XY).unwrap_err().to_string();
        let lines: Vec<Vec<char>> = shown.lines().map(|line| line.chars().collect()).collect();
        let first = lines[2].iter().position(|c| *c == '^').unwrap();
        let marked: String = lines[1][first..lines[2].len()].iter().collect();
        assert_eq!(marked, "oops", "{shown}");
    }
}

/// A random expression; `depth` limits its nesting.
fn random_expression(random: &mut Rng, depth: u32) -> String {
    if depth == 0 || random.u32(..6) == 0 {
        return match random.u32(..6) {
            0 => format!("{}", random.u32(..9)),
            1 => format!("{:.3}", random.f64() * 4.0),
            2 => ["pi", "e", "tau"][random.usize(..3)].to_owned(),
            3 | 4 => "x".to_owned(),
            _ => "y".to_owned(),
        };
    }
    let mut part = || random_expression(random, depth - 1);
    let (a, b, c) = (part(), part(), part());
    match random.u32(..10) {
        0 => format!("({a} + {b})"),
        1 => format!("({a} - {b})"),
        2 => format!("{a}*({b})"),
        3 => format!("({a})/({b} + 2)"),
        4 => format!("({a})^{}", random.i32(-3..5)).replace("^-", "^ -"),
        5 => format!("(abs({a}) + 0.5)^({b})"),
        6 => format!("-({a})"),
        _ => {
            let (name, callable) = CALLABLES[random.usize(..CALLABLES.len())];
            match callable {
                Callable::One(_) => format!("{name}({a})"),
                Callable::Two(_) => format!("{name}({a}, {b})"),
                Callable::Many(_) => format!("{name}({a}, {b}, {c})"),
            }
        }
    }
}

/// The derivative of `f` at 0 by central differences; `None` where two steps disagree, which is at
/// kinks and jumps and where rounding is too large.
fn difference(f: impl Fn(f64) -> f64) -> Option<f64> {
    let at = |h: f64| (f(h) - f(-h)) / (2.0 * h);
    // Richardson's extrapolation, from two pairs of steps.
    let extrapolated = |h: f64| (4.0 * at(h) - at(2.0 * h)) / 3.0;
    let (fine, coarse) = (extrapolated(1e-4), extrapolated(3e-4));
    let is_stable = (fine - coarse).abs() <= 1e-6 * (1.0 + fine.abs());
    (fine.is_finite() && is_stable).then_some(fine)
}

/// Exact derivatives of random expressions agree with central differences, first and second ones.
#[test]
fn derivatives_agree_with_differences() {
    let mut random = Rng::with_seed(7);
    let (mut compared, mut compared_seconds) = (0_u32, 0_u32);
    let (mut skipped, mut overflown) = (0_u32, 0_u32);
    let mut uses = vec![0_u32; CALLABLES.len()];
    for _ in 0..20_000 {
        let text = random_expression(&mut random, 4);
        let expression = parsed(&text);
        let [x, y] = [0; 2].map(|_| random.f64() * 4.0 - 2.0);
        let value = expression.value(&[x, y]);
        let dual = expression.dual([x, y]);
        let jet = expression.jet([x, y]);
        for carried in [dual.value, jet.value] {
            assert!(
                carried == value || value.is_nan() && carried.is_nan(),
                "{text}"
            );
        }
        for (same, other) in dual.partials.iter().zip(jet.partials) {
            assert!(*same == other || same.is_nan() && other.is_nan(), "{text}");
        }
        if value.is_nan() || value.abs() >= 1e3 {
            skipped += 1;
            continue;
        }
        let along = [
            difference(|h| expression.value(&[x + h, y])),
            difference(|h| expression.value(&[x, y + h])),
        ];
        for (exact, numeric) in dual.partials.into_iter().zip(along) {
            let Some(numeric) = numeric.filter(|numeric| numeric.abs() < 1e4) else {
                skipped += 1;
                continue;
            };
            if !exact.is_finite() {
                // A part that overflows, as in (10^400)^(0*x).
                overflown += 1;
                continue;
            }
            let error = (exact - numeric).abs();
            assert!(
                error <= 1e-5 * (1.0 + numeric.abs()),
                "{text} at {x} {y}: {exact} {numeric}"
            );
            compared += 1;
        }
        for (count, (name, _)) in uses.iter_mut().zip(CALLABLES) {
            *count += u32::from(text.contains(&format!("{name}(")));
        }
        let seconds = [
            difference(|h| expression.dual([x + h, y]).partials[0]),
            difference(|h| expression.dual([x, y + h]).partials[0]),
            difference(|h| expression.dual([x, y + h]).partials[1]),
        ];
        for (exact, numeric) in jet.seconds.into_iter().zip(seconds) {
            let Some(numeric) = numeric.filter(|numeric| numeric.abs() < 1e4) else {
                continue;
            };
            if !exact.is_finite() {
                overflown += 1;
                continue;
            }
            let error = (exact - numeric).abs();
            assert!(
                error <= 1e-4 * (1.0 + numeric.abs()),
                "{text} at {x} {y}: {exact} {numeric}"
            );
            compared_seconds += 1;
        }
    }
    assert!(
        compared > 25_000 && compared_seconds > 25_000,
        "{compared} {compared_seconds}"
    );
    assert!(skipped < 12_000 && overflown < 100, "{skipped} {overflown}");
    assert!(uses.iter().all(|count| *count > 100), "{uses:?}");
}

/// Random text never panics, and where it is an expression, so is its evaluation.
#[test]
fn hostile_texts() {
    let words = [
        "x", "y", "(", ")", "+", "-", "*", "/", "^", ",", "=", " ", "1", "2.5", "1e", "e", "pi",
        "sin", "atan2(", "max(", "log2", ".", "é", "\u{0}", "\t", "𝒳", "x^", "(((", "e9", "_",
    ];
    let mut random = Rng::with_seed(3);
    let (mut valid, mut invalid) = (0_u32, 0_u32);
    for _ in 0..40_000 {
        let count = random.usize(..12);
        let text: String = match random.u32(..3) {
            0 => (0..count).map(|_| random.char(..)).collect(),
            1 => (0..count)
                .map(|_| words[random.usize(..words.len())])
                .collect(),
            _ => {
                // A valid expression with a part removed or doubled.
                let whole = random_expression(&mut random, 3);
                let (a, b) = (random.usize(..=whole.len()), random.usize(..=whole.len()));
                format!("{}{}", &whole[..a], &whole[b..])
            }
        };
        for result in [
            Expression::parse(&text, XY).map(|one| vec![one]),
            Expression::parse_list(&text, XY),
            Expression::parse_equation(&text, XY).map(|one| vec![one]),
        ] {
            match result {
                Ok(list) => {
                    valid += 1;
                    for expression in list {
                        let arguments = [f64::from_bits(random.u64(..)), random.f64()];
                        let value = expression.value(&arguments);
                        let jet = expression.jet(arguments).value;
                        assert!(value == jet || value.is_nan() && jet.is_nan(), "{text:?}");
                    }
                }
                Err(error) => {
                    invalid += 1;
                    let span = error.span();
                    assert!(text.is_char_boundary(span.start) && text.is_char_boundary(span.end));
                    assert_eq!(error.to_string().lines().count(), 3, "{text:?}");
                }
            }
        }
    }
    assert!(
        valid > 5_000 && invalid > 50_000,
        "{valid} valid, {invalid} invalid"
    );
}

/// Values and derivatives have the same bits on every machine.
#[test]
fn bits_are_fixed() {
    let mut random = Rng::with_seed(1);
    let mut hash = 0xCBF2_9CE4_8422_2325_u64;
    for _ in 0..2_000 {
        let expression = parsed(&random_expression(&mut random, 4));
        let jet = expression.jet([random.f64() * TAU, random.f64()]);
        let numbers = [jet.value]
            .into_iter()
            .chain(jet.partials)
            .chain(jet.seconds);
        for number in numbers {
            // The bits of a NaN are not defined.
            let bits = if number.is_nan() { 1 } else { number.to_bits() };
            hash = (hash ^ bits).wrapping_mul(0x0100_0000_01B3);
        }
    }
    assert_eq!(hash, 0x5E8F_E575_7D97_7307, "{hash:#X}");
}
