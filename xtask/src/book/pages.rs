//! The pages of the book: one HTML file per chapter, with the table of contents at its side, and
//! the pictures beside them. Nothing is loaded from elsewhere.

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{fs, io};

use pulldown_cmark::{CowStr, Event, Options, Parser, Tag, TagEnd, html};

use super::chapters::{Chapter, chapters};
use super::check::picture_path;
use crate::Repository;
use crate::markdown::anchor;

/// The folder of pictures, relative to the pages.
const PICTURES: &str = "images";

const STYLE: &str = "\
body{display:flex;gap:2em;max-width:72em;margin:1em auto;padding:0 1em;line-height:1.5;\
font-family:Georgia,serif;color:#222;background:#fdfdfb}\
nav{flex:0 0 15em;font-size:.9em}nav ol{padding-left:1.5em}main{min-width:0;flex:1}\
img{max-width:100%;image-rendering:auto}a{color:#235a97}em{color:#555}\
pre{background:#f1f0ea;padding:.7em;overflow:auto}code{font-size:.9em}\
table{border-collapse:collapse}td,th{border:1px solid #ccc;padding:.3em .6em;text-align:left}\
@media(max-width:50em){body{display:block}}";

/// A page or a picture of the book could not be written.
#[derive(Debug)]
pub struct BookError {
    path: PathBuf,
    source: io::Error,
}

impl std::fmt::Display for BookError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            f,
            "the book's file {}: {}",
            self.path.display(),
            self.source
        )
    }
}

impl std::error::Error for BookError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        Some(&self.source)
    }
}

/// Writes the pages of the book into `folder`, and returns the number of chapters.
///
/// # Errors
/// A picture that cannot be read, or a file that cannot be written.
pub fn write_book(repository: &Repository, folder: &Path) -> Result<usize, BookError> {
    let chapters = chapters(repository, &mut Vec::new());
    let mut pictures = BTreeSet::new();
    let pages: Vec<(String, String)> = chapters
        .iter()
        .map(|chapter| {
            let page = page(chapter, &chapters, &mut pictures);
            (page_name(chapter.name()), page)
        })
        .collect();
    let located = |path: &Path| {
        let path = path.to_owned();
        move |source| BookError { path, source }
    };
    let picture_folder = folder.join(PICTURES);
    fs::create_dir_all(&picture_folder).map_err(located(&picture_folder))?;
    for (name, text) in &pages {
        let path = folder.join(name);
        fs::write(&path, text).map_err(located(&path))?;
    }
    if let Some((_, first)) = pages.first() {
        let path = folder.join("index.html");
        fs::write(&path, first).map_err(located(&path))?;
    }
    for picture in &pictures {
        let path = repository.root().join(picture);
        let copy = picture_folder.join(flat_name(picture));
        fs::copy(&path, copy).map_err(located(&path))?;
    }
    Ok(pages.len())
}

/// The name of the page that a source becomes: it ends in `.html`.
fn page_name(source: &str) -> String {
    source.strip_suffix(".md").unwrap_or(source).to_owned() + ".html"
}

/// The name of a picture's copy: its path, with `-` for `/`, for names repeat in folders.
fn flat_name(picture: &Path) -> String {
    picture.to_string_lossy().replace('/', "-")
}

fn page(chapter: &Chapter<'_>, all: &[Chapter<'_>], pictures: &mut BTreeSet<PathBuf>) -> String {
    let mut body = String::new();
    html::push_html(&mut body, events(&chapter.file.text, pictures).into_iter());
    let mut contents = String::new();
    for other in all {
        let (name, title) = (page_name(other.name()), escaped(other.title));
        let title_fr = escaped(other.title_fr);
        // Writing to a string cannot fail.
        let _ = if other.name() == chapter.name() {
            writeln!(contents, "<li><b title=\"{title_fr}\">{title}</b></li>")
        } else {
            writeln!(
                contents,
                "<li><a href=\"{name}\" title=\"{title_fr}\">{title}</a></li>"
            )
        };
    }
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width\">\n\
         <title>{} – estampe</title>\n<style>{STYLE}</style>\n\
         <body>\n<nav>\n<ol>\n{contents}</ol>\n</nav>\n<main>\n{body}</main>\n</body>\n</html>\n",
        escaped(chapter.title),
    )
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('"', "&quot;")
}

/// The events of a chapter with links to pages instead of sources, pictures beside the pages, and
/// anchors at headings.
fn events<'a>(text: &'a str, pictures: &mut BTreeSet<PathBuf>) -> Vec<Event<'a>> {
    let mut events: Vec<Event<'a>> = Parser::new_ext(text, Options::ENABLE_TABLES).collect();
    for at in 0..events.len() {
        let anchor = heading_text(&events[at..]).map(|text| anchor(&text));
        match &mut events[at] {
            Event::Start(Tag::Heading { id, .. }) => *id = anchor.map(CowStr::from),
            Event::Start(Tag::Link { dest_url, .. }) => {
                let target = dest_url.to_string();
                let (file, section) = target.split_once('#').unwrap_or((&target, ""));
                if file.ends_with(".md") && !file.contains('/') {
                    let section = if section.is_empty() {
                        String::new()
                    } else {
                        format!("#{section}")
                    };
                    *dest_url = format!("{}{section}", page_name(file)).into();
                }
            }
            Event::Start(Tag::Image { dest_url, .. }) => {
                if let Some(path) = picture_path(dest_url) {
                    *dest_url = format!("{PICTURES}/{}", flat_name(&path)).into();
                    pictures.insert(path);
                }
            }
            _ => {}
        }
    }
    events
}

/// The text of the heading that the events start with.
fn heading_text(events: &[Event<'_>]) -> Option<String> {
    let Some(Event::Start(Tag::Heading { .. })) = events.first() else {
        return None;
    };
    let inside = events
        .iter()
        .take_while(|event| !matches!(event, Event::End(TagEnd::Heading(_))));
    let texts = inside.filter_map(|event| match event {
        Event::Text(text) | Event::Code(text) => Some(text.as_ref()),
        _ => None,
    });
    Some(texts.collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_chapter_becomes_a_page() {
        let text = "# One & *two*\n\n*En français : Un*\n\n[a](b.md#c-d) [e](../../f/g.md) \
                    [h](https://h.org/i.md)\n\n![j](../../docs/images/k.png)\n\n## Le `l` é\n";
        let files = [
            ("book/src/SUMMARY.md", "- [A](a.md)\n- [B](b.md)\n"),
            ("book/src/a.md", text),
            ("book/src/b.md", "# B\n"),
        ];
        let repository = Repository::synthetic(&files);
        let chapters = chapters(&repository, &mut Vec::new());
        let mut pictures = BTreeSet::new();
        let page = page(&chapters[0], &chapters, &mut pictures);
        for part in [
            "<h1 id=\"one--two\">One &amp; <em>two</em></h1>",
            "<a href=\"b.html#c-d\">a</a>",
            "<a href=\"../../f/g.md\">e</a>",
            "<a href=\"https://h.org/i.md\">h</a>",
            "<img src=\"images/docs-images-k.png\" alt=\"j\"",
            "<h2 id=\"le-l-é\">Le <code>l</code> é</h2>",
            "<li><a href=\"b.html\" title=\"\">B</a></li>",
        ] {
            assert!(page.contains(part), "{part} is not in {page}");
        }
        assert_eq!(
            pictures.into_iter().collect::<Vec<_>>(),
            [PathBuf::from("docs/images/k.png")]
        );
    }
}
