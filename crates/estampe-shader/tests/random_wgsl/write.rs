//! Programs as WGSL.

use crate::program::{
    Binary, Expression, Function, PRIVATE_ARRAY, PRIVATE_NUMBER, Place, Program, Statement, Type,
    Unary, Value,
};
use std::fmt::Write;

pub(crate) fn wgsl(program: &Program) -> String {
    let mut text = format!(
        "var<private> v{PRIVATE_NUMBER}: i32;\nvar<private> v{PRIVATE_ARRAY}: array<i32, 4>;\n"
    );
    for (number, function) in program.functions.iter().enumerate() {
        text += &declaration(number, function);
    }
    text += "@fragment fn main(@location(0) a: vec4f) -> @location(0) vec4u {\n";
    text += "  let v0 = i32(a.x); let v1 = u32(i32(a.y)); let v2 = a.z; let v3 = a.w > 0.0;\n";
    statements(&mut text, &program.main, 1);
    for (at, (ty, output)) in program.outputs.iter().enumerate() {
        let value = expression(output);
        let _ = match ty {
            Type::F32 => writeln!(
                text,
                "  let n{at} = {value}; let o{at} = select(bitcast<u32>(n{at}), 1u, n{at} != n{at});"
            ),
            _ => writeln!(text, "  let o{at} = u32({value});"),
        };
    }
    text + "  return vec4u(o0, o1, o2, o3);\n}\n"
}

fn declaration(number: usize, function: &Function) -> String {
    let mut text = format!("fn f{number}(");
    for (variable, ty) in &function.parameters {
        let _ = write!(text, "v{variable}: {}, ", name(*ty));
    }
    let result = name(function.result);
    let _ = writeln!(
        text,
        "p{}: ptr<function, i32>) -> {result} {{",
        function.pointer
    );
    statements(&mut text, &function.body, 1);
    text + "}\n"
}

fn name(ty: Type) -> &'static str {
    match ty {
        Type::I32 => "i32",
        Type::U32 => "u32",
        Type::F32 => "f32",
        Type::Bool => "bool",
        Type::Array => "array<i32, 4>",
        Type::Vector => "vec3f",
    }
}

fn statements(text: &mut String, all: &[Statement], depth: usize) {
    for statement in all {
        for line in of_statement(statement).lines() {
            let _ = writeln!(text, "{:1$}{line}", "", depth * 2);
        }
    }
}

fn block(all: &[Statement]) -> String {
    let mut text = "{\n".to_owned();
    statements(&mut text, all, 1);
    text + "}"
}

fn of_statement(statement: &Statement) -> String {
    match statement {
        Statement::Declare(at, ty, values) => {
            let values: Vec<_> = values.iter().map(expression).collect();
            match ty {
                Type::Array | Type::Vector => {
                    format!("var v{at} = {}({});", name(*ty), values.join(", "))
                }
                _ => format!("var v{at}: {} = {};", name(*ty), values[0]),
            }
        }
        Statement::Let(at, value) => format!("let v{at} = {};", expression(value)),
        Statement::Assign(to, value) => format!("{} = {};", place(to), expression(value)),
        Statement::Compound(to, sign, value) => {
            format!("{} {}= {};", place(to), operator(*sign), expression(value))
        }
        Statement::If(condition, yes, no) if no.is_empty() => {
            format!("if {} {}", expression(condition), block(yes))
        }
        Statement::If(condition, yes, no) => {
            format!(
                "if {} {} else {}",
                expression(condition),
                block(yes),
                block(no)
            )
        }
        Statement::Loop {
            counter,
            most,
            body,
            continuing,
            break_if,
        } => {
            let mut text = format!("var v{counter} = 0;\nloop {{\n");
            let _ = writeln!(
                text,
                "  if v{counter} >= {most} {{ break; }}\n  v{counter}++;"
            );
            statements(&mut text, body, 1);
            text += "  continuing {\n";
            statements(&mut text, continuing, 2);
            if let Some(condition) = break_if {
                let _ = writeln!(text, "    break if {};", expression(condition));
            }
            text + "  }\n}"
        }
        Statement::For(at, end, body) => format!(
            "for (var v{at} = 0; v{at} < ({} & 3); v{at}++) {}",
            expression(end),
            block(body)
        ),
        Statement::While(counter, condition, body) => {
            let condition = expression(condition);
            let mut text = format!("var v{counter} = 0;\nwhile v{counter} < 3 && {condition} {{\n");
            let _ = writeln!(text, "  v{counter}++;");
            statements(&mut text, body, 1);
            text + "}"
        }
        Statement::Switch(selector, cases, default) => {
            let mut text = format!("switch {} {{\n", expression(selector));
            for (at, (selectors, body)) in cases.iter().enumerate() {
                let mut names: Vec<_> = selectors.iter().map(ToString::to_string).collect();
                if at == *default {
                    names.push("default".to_owned());
                }
                let _ = writeln!(text, "  case {}: {}", names.join(", "), block(body));
            }
            text + "}"
        }
        Statement::Break => "break;".to_owned(),
        Statement::Continue => "continue;".to_owned(),
        Statement::Return(value) => format!("return {};", expression(value)),
        Statement::Block(body) => block(body),
    }
}

fn place(place: &Place) -> String {
    match place {
        Place::Variable(at) => format!("v{at}"),
        Place::Element(at, ty, index) => element(*at, *ty, index),
        Place::Pointee(at) => format!("*p{at}"),
    }
}

fn element(at: usize, ty: Type, index: &Expression) -> String {
    format!("v{at}[{} % {}u]", expression(index), ty.len())
}

fn operator(sign: Binary) -> &'static str {
    match sign {
        Binary::Add => "+",
        Binary::Subtract => "-",
        Binary::Multiply => "*",
        Binary::Divide => "/",
        Binary::Remainder => "%",
        Binary::And => "&",
        Binary::Or => "|",
        Binary::Xor => "^",
        Binary::ShiftLeft => "<<",
        Binary::ShiftRight => ">>",
        Binary::Equal => "==",
        Binary::Less => "<",
        Binary::LazyAnd => "&&",
        Binary::LazyOr => "||",
    }
}

fn expression(value: &Expression) -> String {
    match value {
        Expression::Literal(Value::I32(number)) => format!("i32({number})"),
        Expression::Literal(Value::U32(number)) => format!("{number}u"),
        Expression::Literal(Value::F32(number)) => format!("f32({number:?})"),
        Expression::Literal(Value::Bool(is_true)) => is_true.to_string(),
        Expression::Variable(at) => format!("v{at}"),
        Expression::Element(at, ty, index) => element(*at, *ty, index),
        Expression::Unary(kind, a) => {
            let a = expression(a);
            match kind {
                Unary::Negate => format!("(-{a})"),
                Unary::Complement => format!("(~{a})"),
                Unary::Not => format!("(!{a})"),
                Unary::Abs => format!("abs({a})"),
                Unary::Floor => format!("floor({a})"),
                Unary::Sqrt => format!("sqrt({a})"),
            }
        }
        Expression::Binary(sign, operands) => {
            let [a, b] = operands.each_ref().map(expression);
            match sign {
                Binary::ShiftLeft | Binary::ShiftRight => {
                    format!("({a} {} ({b} & 31u))", operator(*sign))
                }
                _ => format!("({a} {} {b})", operator(*sign)),
            }
        }
        Expression::Select(operands) => {
            let [no, yes, condition] = operands.each_ref().map(expression);
            format!("select({no}, {yes}, {condition})")
        }
        Expression::Convert(ty, a) => format!("{}({})", name(*ty), expression(a)),
        Expression::Call(function, values, pointer) => {
            let mut text = format!("f{function}(");
            for value in values {
                let _ = write!(text, "{}, ", expression(value));
            }
            text + &format!("&v{pointer})")
        }
    }
}
