//! Texts that fit: long names without their middle, sentences in lines.

/// What stands for the text that is left out.
const OMISSION: &str = "...";

/// The text with at most `most` characters: a long one without its middle, so that beginning and
/// extension stay.
pub(super) fn shortened(text: &str, most: usize) -> String {
    let count = text.chars().count();
    if count <= most {
        return text.to_owned();
    }
    let kept = most.saturating_sub(OMISSION.len());
    if kept < 2 {
        return text.chars().take(most).collect();
    }
    let after = kept / 2;
    let mut out: String = text.chars().take(kept - after).collect();
    out.push_str(OMISSION);
    out.extend(text.chars().skip(count - after));
    out
}

/// The text in at most `lines` lines of at most `most` characters: broken at spaces, and inside of
/// words that are longer than a line. What does not fit is left out.
pub(super) fn wrapped(text: &str, most: usize, lines: usize) -> Vec<String> {
    if most == 0 || lines == 0 {
        return Vec::new();
    }
    let mut out: Vec<String> = Vec::new();
    let mut line = String::new();
    for word in text.split_whitespace() {
        let fits = |line: &str, word: &str| {
            let space = usize::from(!line.is_empty());
            line.chars().count() + space + word.chars().count() <= most
        };
        if !fits(&line, word) && !line.is_empty() {
            out.push(std::mem::take(&mut line));
        }
        let mut rest = word;
        while !fits(&line, rest) {
            let end = rest
                .char_indices()
                .nth(most)
                .map_or(rest.len(), |(at, _)| at);
            out.push(rest[..end].to_owned());
            rest = &rest[end..];
        }
        if !line.is_empty() && !rest.is_empty() {
            line.push(' ');
        }
        line.push_str(rest);
        if out.len() > lines {
            break;
        }
    }
    if !line.is_empty() {
        out.push(line);
    }
    if out.len() > lines {
        out.truncate(lines);
        if let Some(last) = out.last_mut() {
            let kept = most.saturating_sub(OMISSION.len());
            *last = last.chars().take(kept).collect();
            last.push_str(&OMISSION[..OMISSION.len().min(most)]);
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::{shortened, wrapped};

    #[test]
    fn long_names_keep_both_ends() {
        assert_eq!(shortened("robot.glb", 9), "robot.glb");
        assert_eq!(shortened("a-long-name.glb", 10), "a-lo...glb");
        assert_eq!(shortened("äöüßäöüß", 7), "äö...üß");
        assert_eq!(shortened("abcdef", 3), "abc");
        assert_eq!(shortened("abcdef", 0), "");
    }

    #[test]
    fn sentences_are_broken_at_spaces() {
        let text = "no triangle, line or point";
        assert_eq!(wrapped(text, 12, 9), ["no triangle,", "line or", "point"]);
        assert_eq!(wrapped(text, 12, 2), ["no triangle,", "line or..."]);
        assert_eq!(wrapped("abcdefgh ij", 3, 9), ["abc", "def", "gh", "ij"]);
        assert_eq!(wrapped("ab cdefgh", 3, 2), ["ab", "..."]);
        assert_eq!(wrapped("", 3, 2), [""; 0]);
        assert_eq!(wrapped("a b", 0, 2), [""; 0]);
        let long = "x".repeat(100_000);
        assert_eq!(wrapped(&long, 7, 1), ["xxxx..."]);
    }
}
