//! Just enough of Markdown for the checks: fenced blocks, links, images, code spans, headings.

/// A fenced block.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Fence {
    /// What follows the opening fence, such as `sh`.
    pub(crate) language: String,
    /// The lines inside.
    pub(crate) lines: Vec<String>,
    /// The line of the opening fence, from 1.
    pub(crate) line: usize,
}

/// Something outside fenced blocks that a document points with.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Pointer {
    /// The target of `[text](target)`.
    Link(String),
    /// The target of `![text](target)` or `<img src="target">`.
    Image(String),
    /// The text of a code span.
    Code(String),
}

/// What a document holds, in its order.
#[derive(Debug, Clone, Default)]
pub(crate) struct Document {
    /// The fenced blocks.
    pub(crate) fences: Vec<Fence>,
    /// The pointers and their lines, from 1.
    pub(crate) pointers: Vec<(usize, Pointer)>,
    /// The anchors of the headings, as GitHub makes them.
    pub(crate) anchors: Vec<String>,
}

impl Document {
    /// Reads a document; what is malformed is text.
    pub(crate) fn parse(text: &str) -> Self {
        let mut document = Self::default();
        let mut open: Option<Fence> = None;
        for (index, line) in text.lines().enumerate() {
            let line_number = index + 1;
            let fence = line.trim_start().strip_prefix("```");
            match (&mut open, fence) {
                (None, Some(language)) => {
                    let language = language.trim().to_owned();
                    open = Some(Fence {
                        language,
                        lines: Vec::new(),
                        line: line_number,
                    });
                }
                (Some(_), Some(_)) => document.fences.extend(open.take()),
                (Some(fence), None) => fence.lines.push(line.to_owned()),
                (None, None) => document.read_line(line, line_number),
            }
        }
        document.fences.extend(open);
        document
    }

    fn read_line(&mut self, line: &str, line_number: usize) {
        if let Some(heading) = line.strip_prefix('#') {
            self.anchors.push(anchor(heading.trim_start_matches('#')));
        }
        // Code spans are the odd pieces between backticks; links are looked for in the others.
        for (index, piece) in line.split('`').enumerate() {
            if index % 2 == 1 {
                self.pointers
                    .push((line_number, Pointer::Code(piece.to_owned())));
            }
        }
        for (at, _) in line.match_indices("](") {
            let target = line[at + 2..]
                .split([')', ' '])
                .next()
                .unwrap_or_default()
                .to_owned();
            let is_image = line[..opening_bracket(line, at)].ends_with('!');
            let pointer = if is_image {
                Pointer::Image(target)
            } else {
                Pointer::Link(target)
            };
            self.pointers.push((line_number, pointer));
        }
        for (at, start) in line.match_indices("src=\"") {
            let target = line[at + start.len()..]
                .split('"')
                .next()
                .unwrap_or_default();
            self.pointers
                .push((line_number, Pointer::Image(target.to_owned())));
        }
    }
}

/// Where the bracket opens that closes at `closing`; `closing` itself where none does.
fn opening_bracket(line: &str, closing: usize) -> usize {
    let mut depth = 0_usize;
    for (at, bracket) in line[..closing].rmatch_indices(['[', ']']) {
        match (bracket, depth) {
            ("[", 0) => return at,
            ("[", _) => depth -= 1,
            _ => depth += 1,
        }
    }
    closing
}

/// The anchor of a heading: lower case, letters and digits, `-` for spaces.
fn anchor(heading: &str) -> String {
    heading
        .trim()
        .chars()
        .filter(|c| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_'))
        .map(|c| if c == ' ' { '-' } else { c })
        .flat_map(char::to_lowercase)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_part_is_read() {
        let text = "# The *Big* one, twice\n![a](b.png) and [c](d.md#e) and `f/g`\n\
                    [![h](i.svg)](j)\n<img src=\"k.png\" width=\"3\">\n```sh\n# [l](m)\nn\n```\n";
        let document = Document::parse(text);
        assert_eq!(document.anchors, ["the-big-one-twice"]);
        let pointers: Vec<_> = document
            .pointers
            .iter()
            .map(|(_, pointer)| pointer.clone())
            .collect();
        let owned = str::to_owned;
        assert_eq!(
            pointers,
            [
                Pointer::Code(owned("f/g")),
                Pointer::Image(owned("b.png")),
                Pointer::Link(owned("d.md#e")),
                Pointer::Image(owned("i.svg")),
                Pointer::Link(owned("j")),
                Pointer::Image(owned("k.png")),
            ]
        );
        let fence = Fence {
            language: owned("sh"),
            lines: vec![owned("# [l](m)"), owned("n")],
            line: 5,
        };
        assert_eq!(document.fences, [fence]);
    }

    #[test]
    fn malformed_text_is_text() {
        for text in ["](", "`", "```", "[a](b", "src=\"", "![](", "]()"] {
            let _ = Document::parse(text);
        }
    }
}
