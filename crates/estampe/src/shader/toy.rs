//! Shaders in the style of shader toys: a function `mainImage` in GLSL without `main`, whose
//! uniforms nobody declares.

use super::place::function;
use estampe::ShaderErrors;
use std::fmt::Write;

/// The uniforms of shader toys that a text need not declare.
const UNIFORMS: &[(&str, &str)] = &[
    ("iResolution", "vec3 iResolution"),
    ("iTime", "float iTime"),
    ("iGlobalTime", "float iGlobalTime"),
    ("iTimeDelta", "float iTimeDelta"),
    ("iFrame", "int iFrame"),
    ("iFrameRate", "float iFrameRate"),
    ("iMouse", "vec4 iMouse"),
    ("iDate", "vec4 iDate"),
    ("iSampleRate", "float iSampleRate"),
    ("iChannelTime", "float iChannelTime[4]"),
    ("iChannelResolution", "vec3 iChannelResolution[4]"),
    ("iChannel0", "sampler2D iChannel0"),
    ("iChannel1", "sampler2D iChannel1"),
    ("iChannel2", "sampler2D iChannel2"),
    ("iChannel3", "sampler2D iChannel3"),
];

/// The lines that were added to a text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Wrapping {
    /// The author's lines before those that were inserted.
    before: u32,
    inserted: u32,
    /// All lines of the author.
    lines: u32,
}

/// The text with a `main` and the uniforms that it uses without declaring them, if it has a
/// `mainImage` and no `main`.
pub(super) fn wrap(text: &str) -> Option<(String, Wrapping)> {
    if function(text, "void", "main").is_some() || function(text, "void", "mainImage").is_none() {
        return None;
    }
    // Declarations come after the version, which must be first.
    let is_version = |line: &str| line.trim_start().starts_with("#version");
    let version = text.lines().position(is_version);
    let before = version.map_or(0, |line| line + 1);
    let named = text.lines().nth(before.wrapping_sub(1)).unwrap_or_default();
    let has_outputs = version.is_none() || !["100", "110", "120"].iter().any(|n| named.contains(n));

    let mut inserted = String::new();
    if version.is_none() {
        inserted.push_str("#version 330 core\n");
    }
    for (name, declaration) in UNIFORMS {
        if uses(text, name) && !declares(text, name) {
            // Writing to a string cannot fail.
            let _ = writeln!(inserted, "uniform {declaration};");
        }
    }
    let output = if has_outputs {
        inserted.push_str("out vec4 estampe_color;\n");
        "estampe_color"
    } else {
        "gl_FragColor"
    };
    let start: usize = text.split_inclusive('\n').take(before).map(str::len).sum();
    let (head, tail) = text.split_at(start);
    let count = |text: &str| u32::try_from(text.lines().count()).unwrap_or(u32::MAX);
    let wrapping = Wrapping {
        before: count(head),
        inserted: count(&inserted),
        lines: count(text),
    };
    let wrapped = format!(
        "{head}{inserted}{tail}\nvoid main() {{\n  vec4 estampe_of_image = vec4(0.0, 0.0, 0.0, 1.0);\n  \
         mainImage(estampe_of_image, gl_FragCoord.xy);\n  {output} = vec4(estampe_of_image.rgb, 1.0);\n}}\n"
    );
    Some((wrapped, wrapping))
}

/// True if a word is in a text.
fn uses(text: &str, word: &str) -> bool {
    let is_name = |c: char| c.is_alphanumeric() || c == '_';
    text.match_indices(word).any(|(start, _)| {
        let before = text[..start].chars().next_back();
        let after = text[start + word.len()..].chars().next();
        !before.is_some_and(is_name) && !after.is_some_and(is_name)
    })
}

/// True if a declaration of uniforms has a name.
fn declares(text: &str, name: &str) -> bool {
    let declarations = text.split("uniform ").skip(1);
    let declared = |rest: &str| rest.split(';').next().is_some_and(|one| uses(one, name));
    declarations.into_iter().any(declared)
}

impl Wrapping {
    /// Errors with the lines that the author counts; those in lines that were added have no place.
    pub(super) fn in_authors_lines(&self, mut errors: ShaderErrors) -> ShaderErrors {
        for error in &mut errors.errors {
            if error.line <= self.before {
                continue;
            }
            let line = error.line.checked_sub(self.inserted);
            let line = line.filter(|line| (self.before + 1..=self.lines).contains(line));
            error.line = line.unwrap_or(0);
            if line.is_none() {
                (error.column, error.length) = (0, 0);
                error.line_text = String::new();
            }
        }
        errors
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use estampe::ShaderSourceError;

    const TOY: &str = "// waves\nvoid mainImage(out vec4 c, in vec2 p) {\n  c = vec4(p / iResolution.xy, iTime, 1.0);\n}";

    #[test]
    fn only_shaders_without_a_main_are_wrapped() {
        assert_eq!(wrap("void main() {}"), None);
        assert_eq!(
            wrap("void mainImage(out vec4 c, in vec2 p) {}\nvoid main() {}"),
            None
        );
        let (text, wrapping) = wrap(TOY).expect("a toy");
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(
            lines[..3],
            [
                "#version 330 core",
                "uniform vec3 iResolution;",
                "uniform float iTime;"
            ]
        );
        assert_eq!(
            wrapping,
            Wrapping {
                before: 0,
                inserted: 4,
                lines: 4
            }
        );
        // What the text declares is not declared again, and its version stays first.
        let (text, wrapping) =
            wrap(&format!("#version 120\nuniform float a, iTime;\n{TOY}")).expect("a toy");
        assert!(text.starts_with("#version 120\nuniform vec3 iResolution;\nuniform float a"));
        assert!(text.contains("gl_FragColor"));
        assert_eq!(
            wrapping,
            Wrapping {
                before: 1,
                inserted: 1,
                lines: 6
            }
        );
    }

    #[test]
    fn errors_are_in_the_lines_of_the_author() {
        let (text, wrapping) = wrap(TOY).expect("a toy");
        let line_of = |line| ShaderErrors {
            errors: vec![ShaderSourceError {
                line,
                column: 1,
                ..ShaderSourceError::default()
            }],
        };
        let places = |line| wrapping.in_authors_lines(line_of(line)).errors[0].line;
        let lines: Vec<&str> = text.lines().collect();
        assert!(lines[6].contains("iResolution.xy"));
        assert_eq!((places(7), places(1), places(10)), (3, 0, 0));
    }
}
