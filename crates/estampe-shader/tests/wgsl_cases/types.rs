//! Types and values of the cases.

use serde_json::Value;

/// The numbers of a type.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Scalar {
    F32,
    F16,
    I32,
    U32,
    Bool,
    /// Abstract numbers.
    Other,
}

/// A scalar (1 column of 1), vector (1 of 2 to 4) or matrix.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Type {
    pub(crate) scalar: Scalar,
    pub(crate) columns: usize,
    pub(crate) rows: usize,
}

impl Type {
    /// The type of a name such as `mat2x3<f32>`.
    pub(crate) fn named(name: &str) -> Self {
        let (shape, scalar) = match name.strip_suffix('>').and_then(|name| name.split_once('<')) {
            Some((shape, scalar)) => (shape, scalar),
            None => ("", name),
        };
        let digit = |at: usize| usize::from(shape.as_bytes()[at] - b'0');
        let (columns, rows) = match &shape[..shape.len().min(3)] {
            "mat" => (digit(3), digit(5)),
            "vec" => (1, digit(3)),
            _ => (1, 1),
        };
        let scalar = match scalar {
            "f32" => Scalar::F32,
            "f16" => Scalar::F16,
            "i32" => Scalar::I32,
            "u32" => Scalar::U32,
            "bool" => Scalar::Bool,
            _ => Scalar::Other,
        };
        Self {
            scalar,
            columns,
            rows,
        }
    }

    pub(crate) fn words(&self) -> usize {
        self.columns * self.rows
    }

    /// The name of a matrix of this shape of `f32`.
    pub(crate) fn name(&self) -> String {
        format!("mat{}x{}f", self.columns, self.rows)
    }

    /// A value made of the words from `first` on.
    pub(crate) fn loaded(&self, first: usize) -> String {
        let word = |at: usize| {
            let word = format!("data[first + {}u]", first + at);
            match self.scalar {
                Scalar::F32 => format!("bitcast<f32>({word})"),
                Scalar::F16 => format!("f16(bitcast<f32>({word}))"),
                Scalar::I32 => format!("bitcast<i32>({word})"),
                Scalar::U32 | Scalar::Other => word,
                Scalar::Bool => format!("({word} != 0u)"),
            }
        };
        let scalar = match self.scalar {
            Scalar::F32 => "f32",
            Scalar::F16 => "f16",
            Scalar::I32 => "i32",
            Scalar::U32 | Scalar::Other => "u32",
            Scalar::Bool => "bool",
        };
        let words: Vec<String> = (0..self.words()).map(word).collect();
        match (self.columns, self.rows) {
            (1, 1) => words.concat(),
            (1, rows) => format!("vec{rows}<{scalar}>({})", words.join(", ")),
            (columns, rows) => format!("mat{columns}x{rows}<{scalar}>({})", words.join(", ")),
        }
    }
}

/// The words of a value.
pub(crate) fn words(value: &Value, scalar: Scalar) -> Vec<u32> {
    match value {
        Value::Array(parts) => parts.iter().flat_map(|part| words(part, scalar)).collect(),
        Value::Bool(is) => vec![u32::from(*is)],
        _ => vec![match scalar {
            #[expect(clippy::cast_possible_truncation, reason = "values of f32")]
            Scalar::F32 | Scalar::F16 => (number(value) as f32).to_bits(),
            Scalar::I32 => {
                let number = value.as_i64().and_then(|number| i32::try_from(number).ok());
                number.expect("an i32").cast_unsigned()
            }
            _ => {
                let number = value.as_u64().and_then(|number| u32::try_from(number).ok());
                number.expect("a u32")
            }
        }],
    }
}

/// A number, which may be text.
pub(crate) fn number(value: &Value) -> f64 {
    match value {
        Value::String(text) => text.parse().expect("a number"),
        _ => value.as_f64().expect("a number"),
    }
}

/// What is accepted: the first alternative.
fn first(accepted: &Value) -> &Value {
    accepted
        .get("data")
        .map_or(accepted, |data| first(&data[0]))
}

/// Statements that store the result `r`, whose shape is that of what is accepted.
pub(crate) fn stored(accepted: &Value) -> String {
    let accepted = first(accepted);
    let scalar = |value: &str, at: usize, ty: Scalar| match ty {
        Scalar::Bool => format!("results[to + {at}u] = select(0u, 1u, {value});\n"),
        Scalar::F32 | Scalar::F16 => {
            format!("results[to + {at}u] = bitcast<u32>(f32({value}));\n")
        }
        _ => format!("results[to + {at}u] = bitcast<u32>({value});\n"),
    };
    if let Some(value) = accepted.get("val") {
        let ty = Type::named(value["t"].as_str().expect("a type"));
        return match ty.rows {
            1 => scalar("r", 0, ty.scalar),
            rows => (0..rows)
                .map(|at| scalar(&format!("r[{at}]"), at, ty.scalar))
                .collect(),
        };
    }
    if let Some(rows) = accepted.get("ivv").and_then(Value::as_array) {
        let row = |at: usize| scalar(&format!("r[{at}]"), at, Scalar::F32);
        return (0..rows.len()).map(row).collect();
    }
    if let Some(columns) = accepted.get("ivm").and_then(Value::as_array) {
        let rows = columns[0].as_array().expect("a column").len();
        let places = (0..columns.len()).flat_map(|column| (0..rows).map(move |row| (column, row)));
        return places
            .map(|(column, row)| {
                scalar(
                    &format!("r[{column}][{row}]"),
                    column * rows + row,
                    Scalar::F32,
                )
            })
            .collect();
    }
    scalar("r", 0, Scalar::F32)
}
