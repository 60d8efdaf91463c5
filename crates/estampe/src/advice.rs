//! Advice for words of the command line that no option takes.
//!
//! The parser's own advice for an unknown word is to pass it as a value after `--`, which is never
//! what was meant. Here words are compared with mistakes that people make: names of other programs'
//! options, a vector with spaces, a picture without `-o`.

use clap::builder::StyledStr;
use clap::error::{ContextKind, ContextValue, ErrorKind};
use std::path::Path;

/// Names that options have elsewhere, with the words that do the same here.
const ELSEWHERE: [(&str, &str); 22] = [
    ("--aa", "--samples 4"),
    ("--angle", "--azimuth 30"),
    ("--anti-aliasing", "--samples 4"),
    ("--antialias", "--samples 4"),
    ("--camera-position", "--eye X,Y,Z"),
    ("--center", "--target X,Y,Z"),
    ("--dir", "--eye X,Y,Z or --view NAME"),
    ("--distance", "--zoom FACTOR or --margin FRACTION"),
    ("--dpi", "--size WxH, in pixels"),
    ("--height", "--size WxH"),
    ("--lookat", "--target X,Y,Z"),
    ("--msaa", "--samples 4"),
    ("--orthographic", "--ortho"),
    ("--pitch", "--elevation DEG"),
    ("--position", "--eye X,Y,Z"),
    ("--resolution", "--size WxH"),
    ("--rotate", "--azimuth DEG and --elevation DEG"),
    ("--scale", "--zoom FACTOR"),
    ("--transparent", "--background none"),
    ("--verbose", "--json, a report of everything"),
    ("--width", "--size WxH"),
    ("--yaw", "--azimuth DEG"),
];

/// The error with advice for its word, in place of the parser's.
pub(crate) fn advised(mut error: clap::Error) -> clap::Error {
    if error.kind() != ErrorKind::UnknownArgument {
        return error;
    }
    let Some(ContextValue::String(word)) = error.get(ContextKind::InvalidArg) else {
        return error;
    };
    let advice = advice_for(word);
    if error.get(ContextKind::SuggestedArg).is_some() && advice.is_none() {
        return error;
    }
    error.remove(ContextKind::Suggested);
    if let Some(advice) = advice {
        error.remove(ContextKind::SuggestedArg);
        let tip = ContextValue::StyledStrs(vec![StyledStr::from(advice)]);
        error.insert(ContextKind::Suggested, tip);
    }
    error
}

/// The advice for a word.
fn advice_for(word: &str) -> Option<String> {
    let known = ELSEWHERE.iter().find(|(name, _)| *name == word);
    if let Some((_, here)) = known {
        return Some(format!("here it is {here}"));
    }
    if word.starts_with('-') {
        return None;
    }
    if word.parse::<f64>().is_ok() {
        return Some(format!(
            "numbers of one value have commas and no spaces between, as in 1,{word},2"
        ));
    }
    let extension = Path::new(word).extension()?.to_str()?.to_ascii_lowercase();
    match extension.as_str() {
        "png" | "jpg" | "jpeg" | "tga" | "webp" | "exr" | "hdr" | "gif" | "svg" | "y4m" => {
            Some(format!("to write this file: -o {word}"))
        }
        "gltf" | "glb" | "obj" | "stl" | "ply" | "off" | "3mf" => Some(
            "one model is drawn at a time; `estampe batch` draws many: estampe batch MODELS -o \
             '{stem}.png'"
                .to_owned(),
        ),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::{ELSEWHERE, advice_for};

    #[test]
    fn mistakes_have_advice() {
        assert!(ELSEWHERE.is_sorted());
        for (word, part) in [
            ("--width", "--size"),
            ("2.5", "1,2.5,2"),
            ("out.PNG", "-o out.PNG"),
            ("b.stl", "batch"),
        ] {
            let advice = advice_for(word).expect(word);
            assert!(advice.contains(part), "{word}: {advice}");
        }
        for word in ["-x", "--glow", "word", "a.b"] {
            assert_eq!(advice_for(word), None, "{word}");
        }
    }
}
