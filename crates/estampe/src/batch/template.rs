//! Templates of names: text with placeholders in braces.

use super::inputs::{Input, folder_below};
use std::ffi::OsString;
use std::path::PathBuf;

/// A template, read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Template(Vec<Piece>);

#[derive(Debug, Clone, PartialEq, Eq)]
enum Piece {
    Text(String),
    Stem,
    Name,
    Ext,
    Dir,
    Index,
    View,
    Camera,
    Pass,
}

impl Template {
    /// Reads a template; `{{` and `}}` are braces.
    pub(super) fn parse(text: &str) -> Result<Self, String> {
        let mut pieces = Vec::new();
        let mut plain = String::new();
        let mut rest = text;
        while let Some(at) = rest.find(['{', '}']) {
            plain.push_str(&rest[..at]);
            let brace = &rest[at..=at];
            rest = &rest[at + 1..];
            if let Some(after) = rest.strip_prefix(brace) {
                plain.push_str(brace);
                rest = after;
                continue;
            }
            let end = rest.find('}').filter(|_| brace == "{");
            let Some(end) = end else {
                return Err(format!(
                    "{text}: a brace without its counterpart; write {{{{ or }}}} for a brace itself"
                ));
            };
            pieces.push(Piece::Text(std::mem::take(&mut plain)));
            pieces.push(match &rest[..end] {
                "stem" => Piece::Stem,
                "name" => Piece::Name,
                "ext" => Piece::Ext,
                "dir" => Piece::Dir,
                "index" => Piece::Index,
                "view" => Piece::View,
                "camera" => Piece::Camera,
                "pass" => Piece::Pass,
                other => {
                    return Err(format!(
                        "{text}: {{{other}}} is unknown; there are {{stem}}, {{name}}, {{ext}}, \
                         {{dir}}, {{index}}, {{view}}, {{camera}} and {{pass}}"
                    ));
                }
            });
            rest = &rest[end + 1..];
        }
        plain.push_str(rest);
        pieces.push(Piece::Text(plain));
        Ok(Self(pieces))
    }

    /// True if names differ by view.
    pub(super) fn has_view(&self) -> bool {
        self.0.contains(&Piece::View)
    }

    /// True if names differ by camera.
    pub(super) fn has_camera(&self) -> bool {
        self.0.contains(&Piece::Camera)
    }

    /// True if names differ by pass.
    pub(super) fn has_pass(&self) -> bool {
        self.0.contains(&Piece::Pass)
    }

    /// The name for an input, its number, and a view or a camera; `{pass}` stays.
    pub(super) fn name(
        &self,
        input: &Input,
        index: usize,
        (view, camera): (Option<&str>, Option<&str>),
    ) -> PathBuf {
        let mut name = OsString::new();
        let path = &input.path;
        for piece in &self.0 {
            match piece {
                Piece::Text(text) => name.push(text),
                Piece::Stem => name.push(path.file_stem().unwrap_or_default()),
                Piece::Name => name.push(path.file_name().unwrap_or_default()),
                Piece::Ext => name.push(path.extension().unwrap_or_default()),
                Piece::Dir => match folder_below(input) {
                    folder if folder.as_os_str().is_empty() => name.push("."),
                    folder => name.push(folder),
                },
                Piece::Index => name.push(index.to_string()),
                Piece::View => name.push(view.unwrap_or("view")),
                Piece::Camera => name.push(camera.unwrap_or("camera")),
                Piece::Pass => name.push("{pass}"),
            }
        }
        PathBuf::from(name).components().collect()
    }
}

#[cfg(test)]
mod tests {
    use super::Template;
    use crate::batch::inputs::Input;
    use std::path::{Path, PathBuf};

    #[test]
    fn placeholders_are_parts_of_the_path() {
        let input = Input {
            path: PathBuf::from("in/a/b/robot.v2.glb"),
            base: PathBuf::from("in/"),
        };
        let name = |template: &str| {
            let template = Template::parse(template).expect("right");
            template.name(&input, 7, (Some("iso"), Some("left")))
        };
        assert_eq!(name("out/{stem}.png"), Path::new("out/robot.v2.png"));
        assert_eq!(
            name("{dir}/{name}-{view}.jpg"),
            Path::new("a/b/robot.v2.glb-iso.jpg")
        );
        assert_eq!(name("o/{index}{ext}.tga"), Path::new("o/7glb.tga"));
        assert_eq!(name("{{{stem}}}.png"), Path::new("{robot.v2}.png"));
        assert_eq!(name("{stem}/{pass}.png"), Path::new("robot.v2/{pass}.png"));
        assert_eq!(name("{camera}/{stem}.png"), Path::new("left/robot.v2.png"));
    }

    #[test]
    fn wrong_templates_are_errors_that_say_what_there_is() {
        let error = |text| Template::parse(text).expect_err("wrong");
        assert!(error("{frame}.png").contains("{frame} is unknown; there are {stem}"));
        for text in ["{stem.png", "a}b.png", "{"] {
            assert!(error(text).contains("without its counterpart"), "{text}");
        }
    }

    #[test]
    fn files_beside_the_glob_and_above_it_have_no_folder() {
        for (path, base) in [
            ("robot.glb", ""),
            ("../x/robot.glb", "../x/"),
            ("/m/r.glb", "in"),
        ] {
            let input = Input {
                path: PathBuf::from(path),
                base: PathBuf::from(base),
            };
            let template = Template::parse("out/{dir}/p.png").expect("right");
            assert_eq!(
                template.name(&input, 0, (None, None)),
                Path::new("out/p.png"),
                "{path}"
            );
        }
    }
}
