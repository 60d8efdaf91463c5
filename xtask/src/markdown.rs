//! Documents as the checks read them: fenced blocks, links, images, code, headings, tables.

use pulldown_cmark::{CodeBlockKind, Event, Options, Parser, Tag, TagEnd};

/// A fenced block.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Fence {
    /// The text after the opening fence, such as `sh`.
    pub(crate) language: String,
    /// The lines inside.
    pub(crate) lines: Vec<String>,
    /// The line of the opening fence, from 1.
    pub(crate) line: usize,
}

/// A part of a document that may name a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Pointer {
    /// The target of `[text](target)`.
    Link(String),
    /// The target of `![text](target)` or `<img src="target">`.
    Image(String),
    /// The text of a code span.
    Code(String),
    /// Other text.
    Text(String),
}

/// The contents of a document, each part in the order of the text.
#[derive(Debug, Clone, Default)]
pub(crate) struct Document {
    pub(crate) fences: Vec<Fence>,
    /// The pointers and their lines, from 1.
    pub(crate) pointers: Vec<(usize, Pointer)>,
    /// The anchors of the headings, as GitHub makes them.
    pub(crate) anchors: Vec<String>,
    /// The rows of all tables, headings left out, and their lines, from 1.
    pub(crate) rows: Vec<(usize, Vec<String>)>,
}

/// The elements that enclose the current place in the text.
#[derive(Debug, Default)]
struct Open {
    heading: Option<String>,
    fence: Option<Fence>,
    row: Option<(usize, Vec<String>)>,
}

impl Document {
    /// Reads a document. Every text is valid Markdown.
    pub(crate) fn parse(text: &str) -> Self {
        let line_starts: Vec<usize> = text.match_indices('\n').map(|(at, _)| at + 1).collect();
        let line_of = |at: usize| line_starts.partition_point(|start| *start <= at) + 1;
        let mut document = Self::default();
        let mut open = Open::default();
        for (event, range) in Parser::new_ext(text, Options::ENABLE_TABLES).into_offset_iter() {
            document.read(event, line_of(range.start), &mut open);
        }
        document
    }

    fn read(&mut self, event: Event<'_>, line: usize, open: &mut Open) {
        let mut point = |pointer| self.pointers.push((line, pointer));
        match event {
            Event::Start(Tag::Link { dest_url, .. }) => {
                point(Pointer::Link(dest_url.into_string()))
            }
            Event::Start(Tag::Image { dest_url, .. }) => {
                point(Pointer::Image(dest_url.into_string()));
            }
            Event::Html(html) | Event::InlineHtml(html) => {
                let sources = html.split("src=\"").skip(1);
                let targets = sources.filter_map(|rest| rest.split('"').next());
                targets.for_each(|target| point(Pointer::Image(target.to_owned())));
            }
            Event::Start(Tag::CodeBlock(CodeBlockKind::Fenced(language))) => {
                open.fence = Some(Fence {
                    language: language.into_string(),
                    lines: Vec::new(),
                    line,
                });
            }
            Event::End(TagEnd::CodeBlock) => self.fences.extend(open.fence.take()),
            Event::Start(Tag::Heading { .. }) => open.heading = Some(String::new()),
            Event::End(TagEnd::Heading(_)) => {
                self.anchors
                    .extend(open.heading.take().map(|heading| anchor(&heading)));
            }
            Event::Start(Tag::TableRow) => open.row = Some((line, Vec::new())),
            Event::End(TagEnd::TableRow) => self.rows.extend(open.row.take()),
            Event::Start(Tag::TableCell) => {
                if let Some((_, cells)) = &mut open.row {
                    cells.push(String::new());
                }
            }
            Event::Text(text) => {
                if let Some(fence) = &mut open.fence {
                    fence.lines.extend(text.lines().map(str::to_owned));
                } else {
                    open.add_text(&text);
                    point(Pointer::Text(text.into_string()));
                }
            }
            Event::Code(code) => {
                open.add_text(&code);
                point(Pointer::Code(code.into_string()));
            }
            _ => {}
        }
    }
}

impl Open {
    fn add_text(&mut self, text: &str) {
        if let Some(heading) = &mut self.heading {
            heading.push_str(text);
        }
        let cells = self.row.as_mut().map(|(_, cells)| cells);
        if let Some(cell) = cells.and_then(|cells| cells.last_mut()) {
            cell.push_str(text);
        }
    }
}

/// The anchor of a heading: lower case, letters and digits, `-` for spaces.
pub(crate) fn anchor(heading: &str) -> String {
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
        let text = "# The *Big* one, `twice`\n![a](b.png) and [c](d.md#e) and `f/g`\n\
                    [![h](i.svg)](j)\n<img src=\"k.png\" width=\"3\">\n```sh\n# [l](m)\nn\n```\n\
                    [reference]\n\n[reference]: o.md\n";
        let document = Document::parse(text);
        assert_eq!(document.anchors, ["the-big-one-twice"]);
        let is_text = |pointer: &Pointer| matches!(pointer, Pointer::Text(_));
        let pointers: Vec<_> = document
            .pointers
            .iter()
            .filter(|(_, pointer)| !is_text(pointer))
            .cloned()
            .collect();
        let owned = str::to_owned;
        assert_eq!(
            pointers,
            [
                (1, Pointer::Code(owned("twice"))),
                (2, Pointer::Image(owned("b.png"))),
                (2, Pointer::Link(owned("d.md#e"))),
                (2, Pointer::Code(owned("f/g"))),
                (3, Pointer::Link(owned("j"))),
                (3, Pointer::Image(owned("i.svg"))),
                (4, Pointer::Image(owned("k.png"))),
                (9, Pointer::Link(owned("o.md"))),
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
    fn tables_are_read() {
        let text = "| a | b |\n|---|---|\n| c **d** `e` | [f](g) |\n| h | |\n";
        let owned = |cells: [&str; 2]| cells.map(str::to_owned).to_vec();
        assert_eq!(
            Document::parse(text).rows,
            [(3, owned(["c d e", "f"])), (4, owned(["h", ""]))]
        );
    }

    /// The reader takes every text; this looks for panics alone.
    #[test]
    fn malformed_text_is_text() {
        for text in [
            "](",
            "`",
            "```",
            "[a](b",
            "<img src=\"",
            "![](",
            "]()",
            "|",
            "| a |\n|-",
        ] {
            let _ = Document::parse(text);
        }
    }
}
