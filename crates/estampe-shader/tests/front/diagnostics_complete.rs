//! Each message of the crate's source is in a test, or in the list of those that no text reaches.
//!
//! The source is read as text. A string literal is a message if it stands right behind one of
//! [`MAKERS`], or in one of [`TABLES`], the files that translate naga's errors. `{…}` in a message
//! stands for anything; a message is tested if a line of the tests has its other parts in order.

use std::fs;
use std::path::{Path, PathBuf};

/// What a message stands behind.
const MAKERS: &[&str] = &[
    "Fault::new(",
    "Fault::at(",
    "ShaderError::new(",
    "Unsupported(",
    "#[error(",
    "help(",
    "fault(",
    "too_deep(",
    "expected(",
    "let message =",
    "help = Some(",
];

/// Files in which each literal of several words is a message.
const TABLES: &[&str] = &[
    "front/validate/entry.rs",
    "front/validate/function.rs",
    "front/validate/mod.rs",
    "front/validate/words.rs",
    "front/glsl/errors.rs",
    "front/constants.rs",
    "front/spirv.rs",
    "front/module.rs",
];

/// Messages that no test has, by the reason.
const UNREACHED: &[(&str, &[&str])] = &[
    ("naga's words, which are looked for and not shown", NAGA),
    ("the front end refuses it before, with its place", LOWER),
    ("only an error of the compiler or the system", BROKEN),
    (
        "brackets, calls and names are checked before naga reads the text",
        CHECKED,
    ),
    (
        "naga's front ends find it first, with words of their own",
        PARSED,
    ),
    (
        "the extensions and capabilities that could name it are refused",
        REFUSED,
    ),
];

/// What naga says of its representation.
const NAGA: &[&str] = &[
    "Unknown function",
    "Cannot apply operation to ",
    "Missing entry point",
    "Ambiguous best function",
    "Constructor: Too many arguments",
    "Expression returns void",
    "Function already defined",
    "Variable cannot be used in LHS",
    "const values must have",
    "Increment/decrement only",
    "swizzle cannot have duplicate",
    "Bad type constructor",
    "Not a valid texture",
    "Array size must be",
    "Invalid swizzle",
    "Can't lookup field",
    "image needs StorageAccess",
    "cannot be in the left hand side",
    "kind: {kind}",
    "naga::ir::Function [",
    "invalid access into expression",
    "can't resolve type: InvalidSubAccess",
    "can't resolve type: IncompatibleOperands",
    "Cannot apply the unary op",
    "cannot apply math function",
    "Array length of",
    "Loading of",
    "invalid sub-access into type",
    "Unable to operate on image class",
    "Image array index type",
    "Image other index type",
    " values requires the `naga::valid::",
    " for expression",
];

/// What lowering does not have and validation does not let through.
const LOWER: &[&str] = &[
    "operations on structs",
    "16-bit integers",
    "numbers of this width",
    "expressions of this kind",
    "conversions of this kind",
    "operators of this kind",
    "resources of this type",
    "arrays of 1D or 3D textures",
    "storage textures of this format",
    "variables of this address space",
    "buffers without a binding",
    "inputs without a binding",
    "outputs without a binding",
    "built-in outputs of this kind",
    "64-bit inputs and outputs",
    "pointers as values",
    "empty values",
    "values as pointers",
    "arrays of textures",
    "missing arguments",
    "variables of this kind",
    "stray variables",
    "indices beyond the end",
    "64-bit floats",
    "constants of this kind",
    "lengths of this memory",
    "accesses of this kind",
    "textures in arrays",
    "textures without a binding",
    "computed offsets",
    "textures of this type",
    "functions of this kind",
    "matrices of this type",
    "mesh, task and ray shaders",
    "computed indices of this variable",
    "values of unknown size",
    "switches on 64-bit integers",
    "stray breaks",
    "stray continues",
    "64-bit atomics",
    "atomics in this memory",
    "built-in inputs of this kind",
    "statements of this kind",
    "subgroup operations of this kind",
    "values of this type",
    "indices of structs",
    "members that do not exist",
    "indices of this type",
];

const BROKEN: &[&str] = &[
    "the shader compiler cannot handle this shader: an assertion of it failed",
    "this is an error of the compiler; please report the shader",
    "the system gave no thread to compile the shader on",
];

const CHECKED: &[&str] = &[
    "the shader ends too early",
    "close what is open: `}`, `)` or `;`",
    "{what}: not supported",
    "`true` or `false`",
    "convert one of them, for example with `float(…)` or `vec3(…)`",
    "a constant has no value",
    "this type cannot be built from values",
    "use another type",
    "this is no texture",
    "use a `sampler2D` or another sampler",
    "`{name}` has no set and binding",
];

const PARSED: &[&str] = &[
    "the header is not that of SPIR-V",
    "the SPIR-V ends in the middle",
    "there are two entry points `{name}` of one stage",
    "call of `{name}`: {}",
    "both choices must have one type, but these are {} and {}",
    "{} has no elements or members",
    "`{}` is called with a wrong number of arguments",
    "{built} cannot be built from values",
    "a value of unknown type",
    "the size of an array must be at least 1",
    "value of another kind",
];

const REFUSED: &[&str] = &[
    "entry point `{name}`: the {stage} stage is not supported",
    "changed by atomic operations",
    "the type {kind} is not supported",
    "the index of the primitive",
    "the index of the draw",
    "mesh shaders",
    "ray queries",
    "arrays of textures and samplers",
    "arrays of uniform buffers",
    "arrays of storage buffers",
];

#[test]
fn each_message_is_tested() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let tests: Vec<String> = rust_files(&root.join("tests/front"))
        .iter()
        .filter(|path| !path.ends_with("diagnostics_complete.rs"))
        .flat_map(|path| literals(&read(path)))
        .map(|(_, literal)| literal)
        .collect();
    let lines: Vec<&str> = tests.iter().flat_map(|literal| literal.lines()).collect();
    let source = root.join("src");
    let mut count = 0;
    let mut missing = Vec::new();
    let mut reached = Vec::new();
    for path in rust_files(&source) {
        let name = path.strip_prefix(&source).expect("a file of the crate");
        let name = name.to_string_lossy().replace('\\', "/");
        let text = read(&path);
        // Modules of tests are at the end of a file.
        let code = text.split("#[cfg(test)]").next().unwrap_or_default();
        for message in messages(code, TABLES.contains(&&*name)) {
            count += 1;
            let is_tested = lines.iter().any(|line| says(line, &message));
            let mut known = UNREACHED.iter().flat_map(|(_, messages)| *messages);
            match (is_tested, known.any(|one| *one == message)) {
                (false, false) => missing.push(format!("{name}: {message}")),
                (true, true) => reached.push(message),
                _ => {}
            }
        }
    }
    assert!(count > 250, "only {count} messages were found");
    assert!(missing.is_empty(), "no test has\n{}", missing.join("\n"));
    assert!(reached.is_empty(), "tests do have\n{}", reached.join("\n"));
}

/// The messages of UNREACHED are still in the source.
#[test]
fn no_unreached_message_is_gone() {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let all: Vec<String> = rust_files(&source)
        .iter()
        .flat_map(|path| literals(&read(path)))
        .map(|(_, literal)| literal)
        .collect();
    for (_, messages) in UNREACHED {
        for message in *messages {
            assert!(all.iter().any(|one| one == message), "{message}");
        }
    }
}

/// The messages of a file.
fn messages(code: &str, is_table: bool) -> Vec<String> {
    let found = literals(code).into_iter().filter(|(start, literal)| {
        let before = code[..*start].trim_end();
        let before = before.strip_suffix("format!(").unwrap_or(before).trim_end();
        let is_message = MAKERS.iter().any(|maker| before.ends_with(maker));
        let is_words = literal.trim().contains(' ') && !literal.ends_with("! ");
        is_words && (is_message || is_table)
    });
    found.map(|(_, literal)| literal).collect()
}

/// True if a line has the parts of a message, in order.
fn says(line: &str, message: &str) -> bool {
    let mut rest = line;
    parts(message).iter().all(|part| {
        let found = rest.find(part.as_str());
        rest = found.map_or("", |at| &rest[at + part.len()..]);
        found.is_some()
    })
}

/// What a message has between its `{…}`.
fn parts(message: &str) -> Vec<String> {
    let mut parts = vec![String::new()];
    let mut inside = false;
    let mut characters = message.chars().peekable();
    while let Some(character) = characters.next() {
        let is_double = matches!(character, '{' | '}') && characters.peek() == Some(&character);
        match character {
            '{' | '}' if !inside && is_double => {
                characters.next();
                parts.last_mut().expect("never empty").push(character);
            }
            '{' => inside = true,
            '}' => {
                inside = false;
                parts.push(String::new());
            }
            _ if inside => {}
            _ => parts.last_mut().expect("never empty").push(character),
        }
    }
    parts
}

/// The string literals of a file, with the byte at which each begins. Comments have none, nor have
/// character literals.
fn literals(code: &str) -> Vec<(usize, String)> {
    let bytes = code.as_bytes();
    let mut found = Vec::new();
    let mut at = 0;
    while at < bytes.len() {
        let rest = &code[at..];
        if rest.starts_with("//") {
            at += rest.find('\n').unwrap_or(rest.len());
        } else if rest.starts_with("'\"'") {
            at += 3;
        } else if rest.starts_with("'\\\"'") {
            at += 4;
        } else if let Some((hashes, start)) = raw_start(rest).filter(|_| !is_word_before(code, at))
        {
            let end = format!("\"{}", "#".repeat(hashes));
            let length = rest[start..].find(&end).unwrap_or(rest.len() - start);
            found.push((at, rest[start..start + length].to_owned()));
            at += (start + length + end.len()).min(rest.len());
        } else if bytes[at] == b'"' {
            let (literal, length) = literal(&rest[1..]);
            found.push((at, literal));
            at += length + 2;
        } else {
            at += rest.chars().next().map_or(1, char::len_utf8);
        }
    }
    found
}

/// The `#` of a raw string that begins here, and the bytes before its text.
fn raw_start(rest: &str) -> Option<(usize, usize)> {
    let after = rest.strip_prefix('r')?;
    let text = after.trim_start_matches('#');
    let hashes = after.len() - text.len();
    text.starts_with('"').then_some((hashes, hashes + 2))
}

fn is_word_before(code: &str, at: usize) -> bool {
    code[..at].ends_with(|before: char| before.is_alphanumeric() || before == '_')
}

/// The literal up to the closing quote, and its bytes in the source.
fn literal(rest: &str) -> (String, usize) {
    let mut text = String::new();
    let mut characters = rest.char_indices().peekable();
    while let Some((at, character)) = characters.next() {
        match character {
            '"' => return (text, at),
            '\\' => match characters.next() {
                // A line that goes on in the next one.
                Some((_, '\n')) => {
                    while characters
                        .next_if(|(_, next)| next.is_whitespace())
                        .is_some()
                    {}
                }
                Some((_, 'n')) => text.push('\n'),
                Some((_, other)) => text.push(other),
                None => {}
            },
            _ => text.push(character),
        }
    }
    (text, rest.len())
}

fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).expect("a folder of the crate") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|ending| ending == "rs") {
                files.push(path);
            }
        }
    }
    files.sort();
    files
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}
