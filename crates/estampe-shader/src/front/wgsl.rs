//! WGSL: parsed by naga, whose messages speak of the text.

use std::collections::BTreeSet;

use naga::front::wgsl;

use super::lines::Lines;
use super::validate::CAPABILITIES;
use super::{ShaderError, ShaderErrors, suggest, validate, wgsl_enable};

/// Parses WGSL.
pub(super) fn parse(text: &str) -> Result<naga::Module, ShaderErrors> {
    let options = wgsl::Options {
        parse_doc_comments: false,
        capabilities: CAPABILITIES,
    };
    let mut frontend = wgsl::Frontend::new_with_options(options);
    frontend
        .parse(&wgsl_enable::without_subgroups(text))
        .map_err(|error| describe(text, &error).into())
}

fn describe(text: &str, error: &wgsl::ParseError) -> ShaderError {
    let lines = Lines::new(text);
    let mut labels_and_notes = error.labels().map(|(_, label)| label).chain(error.notes());
    let nests = labels_and_notes.any(|text| text.contains("recursion limit"));
    let message = match missing_extension(error.message()) {
        _ if nests => TOO_DEEP.to_owned(),
        Some((message, _)) => message,
        None => plain(error.message()),
    };
    let mut described = ShaderError::new(message.trim_end_matches('.'));
    let mut labels = error.labels();
    // Some labels are of what the text does not have.
    let first = labels.find_map(|(span, label)| Some((span.to_range()?, label)));
    let Some((range, label)) = first else {
        return match nests {
            true => {
                let start = deepest(text);
                described.at(&lines, start, start + 1)
            }
            false => described,
        };
    };
    described = described.at(&lines, range.start, range.end);
    let mut advice: Vec<String> = Vec::new();
    if let Some(near) = near_name(text, &message) {
        advice.push(format!("did you mean `{near}`?"));
    }
    let adds_nothing = USELESS_LABELS.contains(&label)
        || label.starts_with("definition of")
        || missing_extension(error.message()).is_some();
    if !label.is_empty() && !message.contains(label) && !adds_nothing && !nests {
        advice.push(label.to_owned());
    }
    for (span, label) in labels.filter(|(_, label)| !label.is_empty()) {
        if let Some(range) = span.to_range() {
            let line = lines.place(range.start, range.end).line;
            advice.push(format!("line {line}: {label}"));
        }
    }
    if let Some((_, help)) = missing_extension(error.message()) {
        advice.extend(help);
    } else if !nests {
        advice.extend(notes(error));
    }
    if let Some(word) = preprocessed(text, range.start) {
        advice.push(match word {
            "#version" => "`#version` is of GLSL, and this is read as WGSL".to_owned(),
            _ => format!(
                "`{word}` is of a preprocessor, and WGSL has none: give the text that the preprocessor makes of it"
            ),
        });
    }
    if text[range.start..].starts_with("[[") {
        advice.push("write attributes as in `@location(0)`".to_owned());
    }
    if !advice.is_empty() {
        described = described.help(advice.join("; "));
    }
    described
}

/// The bracket inside most others, which naga's limit on nesting does not name.
fn deepest(text: &str) -> usize {
    let (mut depth, mut most, mut place) = (0_usize, 0, 0);
    for (at, byte) in text.bytes().enumerate() {
        match byte {
            b'(' | b'[' | b'{' => depth += 1,
            b')' | b']' | b'}' => depth = depth.saturating_sub(1),
            _ => {}
        }
        if depth > most {
            (most, place) = (depth, at);
        }
    }
    place
}

/// The word of a preprocessor at a place where WGSL has none: a directive of naga_oil, of the C
/// preprocessor and its like, an import or a condition of WESL, or the bracket of a template.
fn preprocessed(text: &str, start: usize) -> Option<&str> {
    let (before, rest) = text.split_at(start);
    let line = rest.lines().next().unwrap_or_default();
    let is_word = |character: char| character.is_alphanumeric() || character == '_';
    if let Some(directive) = line.strip_prefix('#') {
        let name = directive.trim_start();
        let length = name.find(|one| !is_word(one)).unwrap_or(name.len());
        let end = line.len() - name.len() + length;
        return (length > 0).then(|| &line[..end]);
    }
    let mut brackets = ["{{", "{%", "{$", "${", "$$"].into_iter();
    if let Some(bracket) = brackets.find(|open| line.starts_with(open)) {
        return Some(bracket);
    }
    let end = line.find(|one| !is_word(one)).unwrap_or(line.len());
    let word = &line[..end];
    let is_wesl = match word {
        "import" => {
            before.is_empty()
                || before.trim_end().ends_with([';', '}', '/'])
                || before.ends_with('\n')
        }
        "if" | "elif" | "else" => before.ends_with('@'),
        _ => false,
    };
    is_wesl.then_some(word)
}

/// What is said of texts that nest more deeply than naga follows.
const TOO_DEEP: &str = "expressions or statements nest too deeply";

/// Labels of naga that repeat the message, or say nothing of the text.
const USELESS_LABELS: &[&str] = &[
    "see msg",
    "unsupported enable-extension",
    "type is not constructible",
    "invalid accessor",
    "unknown identifier",
    "cannot assign to this expression",
];

/// A message of naga in plain words.
fn plain(message: &str) -> String {
    if message.contains("nesting limit") {
        return TOO_DEEP.to_owned();
    }
    let in_words = validate::plain(message);
    if !in_words.eq_ignore_ascii_case(message.trim_end_matches('.')) {
        return in_words;
    }
    if let Some(before) = message.strip_suffix("found \"\"") {
        return format!("{before}found the end of the file");
    }
    let mut characters = message.chars();
    match characters.next() {
        Some(first) => first.to_lowercase().chain(characters).collect(),
        None => String::new(),
    }
}

/// What is said of a word that needs an extension, and what to do.
fn missing_extension(message: &str) -> Option<(String, Option<String>)> {
    let is_missing = message.ends_with("enable extension is not enabled");
    let is_unknown = message.ends_with("is not supported in the current environment");
    let name = message
        .split('`')
        .nth(1)
        .filter(|_| is_missing || is_unknown)?;
    if is_missing && EXTENSIONS.contains(&name) {
        let help = format!("add `enable {name};` before all declarations");
        return Some((
            format!("this needs the extension `{name}`, which is not enabled"),
            Some(help),
        ));
    }
    Some(match is_missing {
        true => (
            format!("this needs the extension `{name}`, which is not supported"),
            None,
        ),
        false => (format!("the extension `{name}` is not supported"), None),
    })
}

/// The extensions of WGSL that estampe has.
const EXTENSIONS: &[&str] = &["f16", "clip_distances", "dual_source_blending", "subgroups"];

/// The notes of an error. Types that an argument may have are one note, without those that no
/// variable has.
fn notes(error: &wgsl::ParseError) -> Vec<String> {
    let mut notes: Vec<String> = Vec::new();
    let mut allowed = Vec::new();
    for note in error.notes() {
        match note.strip_prefix("allowed type: ") {
            Some(ty) if ty.contains("Abstract") || ty.contains("f64") => {}
            Some(ty) => allowed.push(ty),
            None => notes.push(note.trim_end_matches([':', '.']).to_owned()),
        }
    }
    match notes.last_mut() {
        Some(last) if !allowed.is_empty() => *last = format!("{last}: {}", allowed.join(", ")),
        _ => {}
    }
    notes
}

/// A name of the text or of the language near the unknown one that the message quotes.
fn near_name<'a>(text: &'a str, message: &str) -> Option<&'a str> {
    let unknown = [
        "no definition in scope for identifier",
        "unknown type",
        "unknown builtin",
        "unknown attribute",
    ];
    if !unknown.iter().any(|start| message.starts_with(start)) {
        return None;
    }
    let name = message.split('`').nth(1)?;
    let name = name.trim_matches('\'');
    let words = words(text);
    let known = words.into_iter().chain(BUILTINS.iter().copied());
    suggest::nearest(name, known)
}

/// The distinct identifiers of a text.
fn words(text: &str) -> BTreeSet<&str> {
    text.split(|character: char| !character.is_alphanumeric() && character != '_')
        .filter(|word| word.starts_with(|first: char| first.is_alphabetic() || first == '_'))
        .collect()
}

/// Names of the language that are mistyped most.
const BUILTINS: &[&str] = &[
    "abs",
    "acos",
    "all",
    "any",
    "array",
    "asin",
    "atan",
    "atan2",
    "bool",
    "ceil",
    "clamp",
    "cos",
    "cross",
    "degrees",
    "distance",
    "dot",
    "dpdx",
    "dpdy",
    "exp",
    "exp2",
    "f16",
    "f32",
    "floor",
    "fract",
    "fwidth",
    "i32",
    "inverseSqrt",
    "length",
    "log",
    "log2",
    "mat2x2f",
    "mat3x3f",
    "mat4x4f",
    "max",
    "min",
    "mix",
    "normalize",
    "pow",
    "radians",
    "reflect",
    "refract",
    "round",
    "saturate",
    "select",
    "sign",
    "sin",
    "smoothstep",
    "sqrt",
    "step",
    "tan",
    "tanh",
    "textureDimensions",
    "textureLoad",
    "textureSample",
    "textureSampleCompare",
    "textureSampleLevel",
    "textureStore",
    "transpose",
    "trunc",
    "u32",
    "vec2",
    "vec2f",
    "vec2i",
    "vec2u",
    "vec3",
    "vec3f",
    "vec3i",
    "vec3u",
    "vec4",
    "vec4f",
    "vec4i",
    "vec4u",
];

/// The bytes of a function's name where the text declares it.
pub(super) fn declaration(text: &str, name: &str) -> Option<core::ops::Range<usize>> {
    let is_word = |character: char| character.is_alphanumeric() || character == '_';
    let mut from = 0;
    while let Some(found) = text[from..].find(name) {
        let start = from + found;
        let end = start + name.len();
        let before = text[..start].trim_end();
        let is_whole = !text[end..].starts_with(is_word) && before.len() < start;
        if is_whole && before.ends_with("fn") && !before[..before.len() - 2].ends_with(is_word) {
            return Some(start..end);
        }
        from = end.max(start + 1);
    }
    None
}
