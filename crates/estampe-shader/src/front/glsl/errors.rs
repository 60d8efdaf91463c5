//! naga's errors in the words of GLSL, at the author's places.

use std::collections::BTreeSet;

use naga::front::glsl::{Error, ErrorKind, ExpectedToken};

use super::super::reflect::Names;
use super::super::suggest;
use super::super::validate;
use super::Fault;
use super::functions::{FUNCTIONS, UNSUPPORTED};
use super::output::Output;
use super::token::Place;
use super::types;
use super::unit::{Function, Unit};

/// What maps errors to the author's text.
pub(super) struct Origin<'a> {
    pub text: &'a str,
    pub unit: &'a Unit,
    pub output: &'a Output,
    pub names: &'a Names,
}

/// An error of naga's parser.
pub(super) fn parse_fault(origin: &Origin<'_>, error: &Error) -> Fault {
    let place = error
        .meta
        .to_range()
        .and_then(|range| origin.output.place(range));
    let written = place.and_then(|place| {
        let text = origin.text.get(place.start as usize..place.end as usize)?;
        let one_line = text.split_whitespace().collect::<Vec<_>>().join(" ");
        (!one_line.is_empty() && one_line.len() <= 60).then_some(one_line)
    });
    let (message, help) = describe(origin, &error.kind, written.as_deref(), place);
    let fault = Fault::at(origin.names.in_message(&message), place);
    match help {
        Some(help) => fault.help(origin.names.in_message(&help)),
        None => fault,
    }
}

/// An error of naga's validator.
pub(super) fn validation_fault(origin: &Origin<'_>, fault: validate::Fault) -> Fault {
    let ranges = fault.spans.iter().filter_map(|span| span.to_range());
    let place = ranges.filter_map(|range| origin.output.place(range)).next();
    let main = || {
        fault.entry_point.as_ref()?;
        let mut functions = origin.unit.functions();
        functions.find(|function| &*function.name == "main" && !function.body.is_empty())
    };
    let place = place.or_else(|| main().map(|main| main.place));
    let found = Fault::at(origin.names.in_message(&fault.message), place);
    match fault.help {
        Some(help) => found.help(origin.names.in_message(&help)),
        None => found,
    }
}

fn describe(
    origin: &Origin<'_>,
    kind: &ErrorKind,
    written: Option<&str>,
    place: Option<Place>,
) -> (String, Option<String>) {
    let near = |name: &str| {
        let names = names_of(origin);
        suggest::nearest(name, names).map(|near| format!("did you mean `{near}`?"))
    };
    let help = |text: &str| Some(text.to_owned());
    match kind {
        ErrorKind::EndOfFile => (
            "the shader ends too early".to_owned(),
            help("close what is open: `}`, `)` or `;`"),
        ),
        ErrorKind::InvalidToken(_, expected) => {
            let found = written.map_or("something else".to_owned(), |text| format!("`{text}`"));
            expectation(origin, expected, &found, place)
        }
        // A name before a name is meant to be a type.
        ErrorKind::UnknownVariable(name) if is_before_name(origin, place) => {
            let known = origin
                .unit
                .structures
                .names()
                .chain(types::TYPES.iter().copied());
            let near = suggest::nearest(name, known);
            (
                format!("there is no type `{name}`"),
                near.map(|near| format!("did you mean `{near}`?")),
            )
        }
        ErrorKind::UnknownVariable(name) => (
            format!("`{name}` is not declared"),
            near(name).or_else(|| help("declare it before it is used")),
        ),
        ErrorKind::UnknownType(name) => (format!("there is no type `{name}`"), near(name)),
        ErrorKind::UnknownField(name) => (format!("there is no member `{name}`"), near(name)),
        ErrorKind::VariableAlreadyDeclared(name) => (
            format!("`{name}` is declared twice"),
            help("rename one of them"),
        ),
        ErrorKind::SemanticError(text) => semantic(origin, text, place),
        ErrorKind::UnsupportedMatrixWithTwoRowsInStd140 { columns } => (
            format!("a structure cannot hold a matrix of {columns} columns and 2 rows"),
            help("hold its columns, each as a `vec2`, and build the matrix where it is used"),
        ),
        ErrorKind::NotImplemented(what) => (format!("{what}: not supported"), None),
        other => (validate::plain(&other.to_string()), None),
    }
}

/// True if a name follows a place.
fn is_before_name(origin: &Origin<'_>, place: Option<Place>) -> bool {
    let rest = place.and_then(|place| origin.text.get(place.end as usize..));
    let is_letter = |first: char| first.is_ascii_alphabetic() || first == '_';
    rest.is_some_and(|rest| rest.trim_start().starts_with(is_letter))
}

fn expectation(
    origin: &Origin<'_>,
    expected: &[ExpectedToken],
    found: &str,
    place: Option<Place>,
) -> (String, Option<String>) {
    let names: Vec<String> = expected.iter().map(expected_name).collect();
    let is = |name: &str| names.iter().any(|one| one == name);
    // Where a value is expected, naga lists what begins one.
    if is("an integer") || names.is_empty() {
        let help = "write a number, a name, or `(`".to_owned();
        return (format!("expected a value, found {found}"), Some(help));
    }
    let list = match names.split_last() {
        Some((last, [])) => last.clone(),
        Some((last, rest)) => format!("{} or {last}", rest.join(", ")),
        None => String::new(),
    };
    let keyword = found.trim_matches('`');
    if is("a name") && super::declare::is_keyword(keyword) {
        let help = "choose another name".to_owned();
        return (format!("{found} is a word of the language"), Some(help));
    }
    let mut help = None;
    if is("`;`") {
        let line = place.and_then(|place| {
            let before = origin.text.get(..place.start as usize)?;
            let is_first = before.rsplit('\n').next()?.trim().is_empty();
            is_first.then_some(())
        });
        help = Some(match line {
            Some(()) => "a `;` is missing at the end of the line before".to_owned(),
            None => format!("a `;` or an operator is missing before {found}"),
        });
    }
    (format!("expected {list}, found {found}"), help)
}

/// The signs and words by naga's names of them.
const SIGNS: &[(&str, &str)] = &[
    ("Assign", "="),
    ("Comma", ","),
    ("Semicolon", ";"),
    ("Colon", ":"),
    ("Dot", "."),
    ("LeftBrace", "{"),
    ("RightBrace", "}"),
    ("LeftParen", "("),
    ("RightParen", ")"),
    ("LeftBracket", "["),
    ("RightBracket", "]"),
    ("Void", "void"),
    ("Struct", "struct"),
    ("While", "while"),
    ("Case", "case"),
    ("Default", "default"),
];

fn expected_name(expected: &ExpectedToken) -> String {
    match expected {
        ExpectedToken::Token(token) => {
            let name = format!("{token:?}");
            let sign = SIGNS.iter().find(|(known, _)| *known == name);
            sign.map_or(name.to_lowercase(), |(_, sign)| format!("`{sign}`"))
        }
        ExpectedToken::TypeName => "a type".to_owned(),
        ExpectedToken::Identifier => "a name".to_owned(),
        ExpectedToken::IntLiteral => "an integer".to_owned(),
        ExpectedToken::FloatLiteral => "a number".to_owned(),
        ExpectedToken::BoolLiteral => "`true` or `false`".to_owned(),
        ExpectedToken::Eof => "the end of the shader".to_owned(),
    }
}

/// How naga's messages begin, what is said instead, and what to do.
const SEMANTIC: &[(&str, &str, &str)] = &[
    (
        "Missing entry point",
        "the shader has no `main`",
        "add `void main() { … }`",
    ),
    (
        "Ambiguous best function",
        "several functions take these arguments",
        "convert arguments",
    ),
    (
        "Constructor: Too many arguments",
        "the constructor has too many arguments",
        "remove some",
    ),
    (
        "Expression returns void",
        "the function returns nothing",
        "call it as a statement",
    ),
    (
        "Function already defined",
        "there are two functions with this name and parameters",
        "rename one of them",
    ),
    (
        "Variable cannot be used in LHS",
        "this cannot be assigned to",
        "inputs, uniforms and constants are read only: copy them to a variable",
    ),
    (
        "const values must have",
        "a constant has no value",
        "add `= …`",
    ),
    (
        "Increment/decrement only",
        "`++` and `--` need a number",
        "use a variable",
    ),
    (
        "swizzle cannot have duplicate",
        "a component is assigned twice",
        "name each one once",
    ),
    (
        "Bad type constructor",
        "this type cannot be built from values",
        "use another type",
    ),
    (
        "Not a valid texture",
        "this is no texture",
        "use a `sampler2D` or another sampler",
    ),
    (
        "Array size must be",
        "an array needs at least one element",
        "use a larger size",
    ),
];

fn semantic(origin: &Origin<'_>, text: &str, place: Option<Place>) -> (String, Option<String>) {
    let quoted = || text.split('\'').nth(1).unwrap_or_default().to_owned();
    let help = |text: &str| Some(text.to_owned());
    if text.starts_with("Unknown function") {
        let name = quoted();
        let author = origin.names.name(Some(&name));
        if let Some(found) = own_function(origin, &author, place) {
            return found;
        }
        if UNSUPPORTED.contains(&name.as_str()) {
            return (format!("`{name}` is not supported"), help("do without it"));
        }
        if FUNCTIONS.contains(&name.as_str()) {
            return (
                format!("`{name}` does not take these arguments"),
                help("compare the number of the arguments and their types with the language's"),
            );
        }
        let names = names_of(origin)
            .into_iter()
            .chain(FUNCTIONS.iter().copied());
        let near = suggest::nearest(&name, names);
        return (
            format!("there is no function `{name}`"),
            near.map(|near| format!("did you mean `{near}`?")),
        );
    }
    if let Some(rest) = text.strip_prefix("Cannot apply operation to ") {
        let types = rest.split(" and ").map(glsl_type).collect::<Vec<_>>();
        return (
            format!("this operator does not work with {}", types.join(" and ")),
            help("convert one of them, for example with `float(…)` or `vec3(…)`"),
        );
    }
    if let Some((_, message, advice)) = SEMANTIC.iter().find(|(start, ..)| text.starts_with(start))
    {
        return ((*message).to_owned(), help(advice));
    }
    if text.starts_with("Invalid swizzle") {
        let name = text.split('"').nth(1).unwrap_or_default();
        return (
            format!("the vector has no components `{name}`"),
            help("use x, y, z, w or r, g, b, a, as many as the vector has"),
        );
    }
    if text.starts_with("Can't lookup field") {
        let name = text.split('"').nth(1).unwrap_or_default();
        return (
            format!("this has no member `{name}`"),
            help("only structures and vectors have members"),
        );
    }
    if text.contains("image needs StorageAccess") {
        return (
            format!("`{}` does not go with the image's declaration", quoted()),
            help("`writeonly` images are not read, and `readonly` ones are not written"),
        );
    }
    if text.contains("cannot be in the left hand side") {
        return (
            "this cannot be assigned to".to_owned(),
            help("assign to a variable"),
        );
    }
    (validate::plain(text), None)
}

/// What is wrong with a call of a function of the author, if the name is of one.
fn own_function(
    origin: &Origin<'_>,
    name: &str,
    place: Option<Place>,
) -> Option<(String, Option<String>)> {
    let start = place.map_or(u32::MAX, |place| place.start);
    origin.unit.functions().find(|one| &*one.name == name)?;
    let is_inside = |function: &&Function| {
        let ends = function.body.first().zip(function.body.last());
        ends.is_some_and(|(open, close)| (open.place.start..close.place.end).contains(&start))
    };
    let caller = origin.unit.functions().find(is_inside);
    Some(if caller.is_some_and(|caller| &*caller.name == name) {
        (
            format!("`{name}` calls itself, or is called with other arguments than it takes"),
            Some("functions of GLSL cannot call themselves: use a loop".to_owned()),
        )
    } else if let Some(caller) = caller.filter(|caller| calls(origin.unit, name, &caller.name)) {
        (
            format!("`{name}` calls itself by way of `{}`", caller.name),
            Some("functions of GLSL cannot call themselves: use a loop".to_owned()),
        )
    } else {
        (
            format!("no function `{name}` takes these arguments"),
            Some(
                "compare the number of the arguments and their types with its parameters"
                    .to_owned(),
            ),
        )
    })
}

/// True if a function calls another one, or calls one that does.
fn calls(unit: &Unit, from: &str, to: &str) -> bool {
    let mut seen = BTreeSet::from([from]);
    let mut open = vec![from];
    while let Some(name) = open.pop() {
        let functions = unit.functions().filter(|function| &*function.name == name);
        for token in functions.flat_map(|function| &function.body) {
            if token.is(to) {
                return true;
            }
            if unit.has_function(&token.text) && seen.insert(&token.text) {
                open.push(&token.text);
            }
        }
    }
    false
}

/// GLSL's name of a type that naga writes as its own.
fn glsl_type(text: &str) -> String {
    let scalar = ["Float", "Sint", "Uint", "Bool"]
        .iter()
        .position(|kind| text.contains(&format!("kind: {kind}")));
    let Some(scalar) = scalar else {
        return "this".to_owned();
    };
    let digit = |word: &str| {
        let rest = text.split(word).nth(1).unwrap_or_default();
        ["Bi", "Tri", "Quad"]
            .iter()
            .position(|size| rest.starts_with(size))
            .map(|at| at + 2)
    };
    let prefix = ["", "i", "u", "b"][scalar];
    let name = match (digit("columns: "), digit("rows: "), digit("size: ")) {
        (Some(columns), Some(rows), _) if columns == rows => format!("mat{columns}"),
        (Some(columns), Some(rows), _) => format!("mat{columns}x{rows}"),
        (_, _, Some(size)) => format!("{prefix}vec{size}"),
        _ => ["float", "int", "uint", "bool"][scalar].to_owned(),
    };
    format!("`{name}`")
}

/// The names that a shader declares or uses.
fn names_of<'a>(origin: &Origin<'a>) -> BTreeSet<&'a str> {
    let unit = origin.unit;
    let functions = unit.functions().map(|function| &*function.name);
    let parameters = unit.functions().flat_map(|function| {
        function
            .parameters
            .iter()
            .filter_map(|parameter| parameter.name.as_deref())
    });
    let variables = unit.variables().map(|variable| &*variable.name);
    let locals = unit.functions().flat_map(|function| {
        let pairs = function.body.windows(2);
        pairs.filter_map(|pair| {
            let declares = unit.structures.is_type(&pair[0].text) && pair[1].is_word();
            declares.then_some(&*pair[1].text)
        })
    });
    let structures = unit.structures.order.iter();
    let members = structures
        .filter_map(|(name, _)| unit.structures.get(name))
        .flat_map(|members| members.iter().map(|member| &*member.name));
    functions
        .chain(parameters)
        .chain(variables)
        .chain(locals)
        .chain(members)
        .collect()
}
