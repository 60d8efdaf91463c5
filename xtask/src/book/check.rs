//! The rules of a chapter. The check of documents reads the book too and finds its dead links.

use std::path::{Path, PathBuf};

use super::chapters::{Chapter, SOURCES, chapters};
use crate::markdown::{Document, Pointer};
use crate::{Finding, Repository};

/// The headings of a chapter about a stage, in this order; others may stand between them.
const SECTIONS: &[&str] = &[
    "The idea",
    "The formula",
    "The wrong version",
    "Where the code is",
    "Exercises",
];

/// The pictures that chapters may show: their folder, the test that draws each anew and compares it
/// byte for byte, and the text by which the test names the folder.
const KEPT_PICTURES: &[(&str, &str, &str)] = &[
    (
        "docs/images/ladder",
        "crates/estampe-ladder/tests/pictures.rs",
        "docs/images/ladder",
    ),
    (
        "docs/images/shapes",
        "crates/estampe/tests/command/shapes_page.rs",
        "check_page(\"shapes\")",
    ),
    (
        "docs/images/render",
        "crates/estampe/tests/command/render_page.rs",
        "check_page(\"render\")",
    ),
    (
        "docs/images/depth",
        "crates/estampe/tests/command/depth_page.rs",
        "check_page(\"depth\")",
    ),
    (
        "docs/images/examples",
        "crates/estampe-gpu/examples/scene/kept.rs",
        "docs/images/examples",
    ),
    (
        "book/src/images",
        "crates/estampe/tests/command/book.rs",
        "book/src",
    ),
];

/// Checks that every chapter is listed and has its sections, that every picture is one that a test
/// keeps and has a caption in both languages, and that every command is one that a test can run.
#[must_use]
pub fn check_book(repository: &Repository) -> Vec<Finding> {
    let mut findings = Vec::new();
    for (folder, test, name) in KEPT_PICTURES {
        let names_it = |text: &str| text.contains(name);
        if !repository
            .file(test)
            .is_some_and(|file| names_it(&file.text))
        {
            let message = format!("this test must keep the pictures of `{folder}`");
            findings.push(Finding::error(*test, 0, message));
        }
    }
    for chapter in chapters(repository, &mut findings) {
        findings.extend(check_sections(&chapter));
        findings.extend(check_pictures(&chapter));
        findings.extend(check_commands(repository, &chapter));
    }
    findings
}

fn check_sections(chapter: &Chapter<'_>) -> Option<Finding> {
    if !chapter.is_stage() {
        return None;
    }
    let headings: Vec<&str> = chapter
        .file
        .text
        .lines()
        .filter_map(|line| line.strip_prefix("## "))
        .collect();
    let mut rest = headings.iter();
    let missing = SECTIONS
        .iter()
        .find(|section| !rest.any(|heading| heading == *section))?;
    let message = format!("the section `## {missing}` is missing, or not in its place");
    Some(Finding::error(&chapter.file.path, 0, message))
}

/// Each picture is kept by a test and followed by a caption `*English · French*`, perhaps after
/// other pictures.
fn check_pictures(chapter: &Chapter<'_>) -> Vec<Finding> {
    let mut findings = Vec::new();
    let mut object = |line: usize, message: String| {
        findings.push(Finding::error(&chapter.file.path, line, message));
    };
    for (line, pointer) in Document::parse(&chapter.file.text).pointers {
        let Pointer::Image(target) = pointer else {
            continue;
        };
        let is_kept = picture_path(&target).is_some_and(|path| {
            KEPT_PICTURES
                .iter()
                .any(|(folder, _, _)| path.starts_with(folder))
        });
        if !is_kept {
            object(line, format!("no test keeps the picture `{target}`"));
        }
        let after = chapter.file.text.lines().skip(line - 1);
        let caption: Vec<&str> = after
            .skip_while(|text| text.is_empty() || text.starts_with("!["))
            .take_while(|text| !text.is_empty())
            .collect();
        // Pairs of pictures stand in tables, whose rows name them in both languages.
        let has_caption = caption.first().is_some_and(|text| {
            text.starts_with('|') && text.contains(" · ")
                || text.starts_with('*') && caption.join(" ").contains(" · ")
        });
        if !has_caption {
            object(
                line,
                "a caption `*English · French*` must follow the picture".to_owned(),
            );
        }
    }
    findings
}

/// The path of a picture from the root of the repository.
pub(super) fn picture_path(target: &str) -> Option<PathBuf> {
    if let Some(rest) = target.strip_prefix("../../") {
        return Some(PathBuf::from(rest));
    }
    (!target.starts_with('.')).then(|| Path::new(SOURCES).join(target))
}

/// Every line of a `sh` block is a command that the test of the book runs. Examples that the text
/// names exist; tests of their crates run them.
fn check_commands(repository: &Repository, chapter: &Chapter<'_>) -> Vec<Finding> {
    let document = Document::parse(&chapter.file.text);
    let shell = document
        .fences
        .into_iter()
        .filter(|fence| fence.language == "sh");
    let mut findings = Vec::new();
    for fence in shell {
        let others = fence
            .lines
            .iter()
            .filter(|line| !line.is_empty() && !line.starts_with("estampe "));
        for line in others {
            let message = format!("`{line}` does not begin with `estampe `, so no test runs it");
            findings.push(Finding::error(&chapter.file.path, fence.line, message));
        }
    }
    for (line, pointer) in document.pointers {
        let Pointer::Code(text) = pointer else {
            continue;
        };
        let mut words = text.split(' ').skip_while(|word| *word != "--example");
        let Some(name) = words.nth(1) else {
            continue;
        };
        let file = format!("examples/{name}.rs");
        if !repository
            .rust_files()
            .any(|source| source.path.ends_with(&file))
        {
            let message = format!("there is no example `{name}`");
            findings.push(Finding::error(&chapter.file.path, line, message));
        }
    }
    findings
}

#[cfg(test)]
mod tests {
    use super::*;

    const TITLES: &str = "# A\n\n*En français : B*\n\n";
    const STAGE: &str = "## The idea\n## The formula\n## More\n## The wrong version\n\
                         ## Where the code is\n## Exercises\n";

    /// The messages about a book of one chapter.
    fn messages(name: &str, text: &str) -> Vec<String> {
        let (path, summary) = (format!("{SOURCES}/{name}"), format!("- [A]({name})\n"));
        let mut files = vec![
            (path.as_str(), text),
            ("book/src/SUMMARY.md", summary.as_str()),
        ];
        files.extend(KEPT_PICTURES.iter().map(|(_, test, name)| (*test, *name)));
        let findings = check_book(&Repository::synthetic(&files));
        findings
            .into_iter()
            .map(|finding| finding.message)
            .collect()
    }

    #[test]
    fn stages_have_their_sections_in_order() {
        let whole = format!("{TITLES}{STAGE}");
        assert_eq!(messages("01_a.md", &whole), [""; 0]);
        assert_eq!(messages("glossary.md", TITLES), [""; 0]);
        let swapped = whole.replace("## The idea\n", "") + "## The idea\n";
        assert!(messages("01_a.md", &swapped)[0].contains("`## The formula`"));
        assert_eq!(messages("01_a.md", STAGE).len(), 2, "no titles");
    }

    #[test]
    fn pictures_are_kept_by_tests_and_have_captions_in_two_languages() {
        let shown = |body: &str| messages("a.md", &format!("{TITLES}{body}\n"));
        let ladder = "![x](../../docs/images/ladder/a.png)";
        assert_eq!(shown(&format!("{ladder}\n\n*one · un*")), [""; 0]);
        assert_eq!(
            shown(&format!("{ladder}\n![y](images/b.png)\n\n*one\n· un*")),
            [""; 0]
        );
        assert!(shown(&format!("{ladder}\n\n*one*"))[0].contains("caption"));
        let found = shown("![x](../../docs/images/teapot.png)\n\n*one · un*");
        assert!(found[0].contains("no test keeps"), "{found:?}");
        assert_eq!(shown("| a · b | ![x](images/b.png) |"), [""; 0]);
    }

    #[test]
    fn other_commands_and_unlisted_chapters_are_found() {
        let block = |line: &str| messages("a.md", &format!("{TITLES}```sh\n{line}\n```\n"));
        assert_eq!(block("estampe ladder 1 -o ladder"), [""; 0]);
        assert!(block("rm -r .")[0].contains("no test runs it"));
        let found = messages("a.md", &format!("{TITLES}`cargo run --example b`\n"));
        assert!(found[0].contains("no example `b`"), "{found:?}");
        let files = [
            (
                "book/src/SUMMARY.md",
                "- [A](a.md)\n- [A](a.md)\n- [C](c.md)\n",
            ),
            ("book/src/a.md", TITLES),
            ("book/src/b.md", TITLES),
        ];
        let findings = check_book(&Repository::synthetic(&files));
        let count = |part: &str| {
            let found = findings.iter().filter(|one| one.message.contains(part));
            found.count()
        };
        assert_eq!(count("listed twice"), 1);
        assert_eq!(count("there is no chapter `c.md`"), 1);
        assert_eq!(count("does not list this chapter"), 1);
        assert_eq!(count("must keep the pictures"), KEPT_PICTURES.len());
    }
}
