//! Lines of a label and a value, aligned.

use std::fmt::Write as _;

/// Columns of the labels, after two spaces.
const LABEL_COLUMNS: usize = 11;
/// Lists are wrapped to so many columns, long words are not.
const COLUMNS: usize = 100;

/// A text that is being written. Writing into a `String` cannot fail.
#[derive(Debug)]
pub(super) struct Lines {
    pub(super) text: String,
}

impl Lines {
    /// A text of its title.
    pub(super) fn new(title: &str) -> Self {
        let text = format!("{title}\n");
        Self { text }
    }

    pub(super) fn add(&mut self, label: &str, value: &str) {
        let _ = writeln!(self.text, "  {label:LABEL_COLUMNS$}{value}");
    }

    /// Adds a list after a name, in as many lines as it takes.
    pub(super) fn add_list<T: AsRef<str>>(&mut self, label: &str, name: &str, values: &[T]) {
        let mut line = name.to_owned();
        let mut label = label;
        for (at, value) in values.iter().enumerate() {
            let comma = if at + 1 < values.len() { "," } else { "" };
            let value = value.as_ref();
            let columns = 2 + LABEL_COLUMNS + line.chars().count() + value.chars().count() + 2;
            if !line.is_empty() && columns > COLUMNS {
                self.add(label, &line);
                (label, line) = ("", String::new());
            }
            let space = if line.is_empty() { "" } else { " " };
            let _ = write!(line, "{space}{value}{comma}");
        }
        self.add(label, &line);
    }

    /// Says how many more there are than the listed ones.
    pub(super) fn add_rest(&mut self, count: usize, listed: usize, what: &str) {
        if count > listed {
            self.add("", &format!("and {} more {what}", count - listed));
        }
    }
}

/// A number of things: `1 texture`, `2 textures`, `1 mesh`, `2 meshes`.
pub(super) fn counted(count: u64, plural: &str) -> String {
    let singular = match plural {
        "vertices" => "vertex",
        "meshes" => "mesh",
        plural => plural.strip_suffix('s').unwrap_or(plural),
    };
    let word = if count == 1 { singular } else { plural };
    format!("{count} {word}")
}

/// A size in words.
pub(super) fn bytes(count: u64) -> String {
    const KIB: f64 = 1024.0;
    match count {
        0..10_240 => counted(count, "bytes"),
        10_240..1_048_576 => format!("{:.1} KiB", count as f64 / KIB),
        _ => format!("{:.1} MiB", count as f64 / (KIB * KIB)),
    }
}

/// A number with at most three decimals.
pub(super) fn rounded(number: f32) -> String {
    let text = format!("{number:.3}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    text.to_owned()
}

#[cfg(test)]
mod tests {
    use super::{Lines, bytes, counted, rounded};

    #[test]
    fn numbers_are_words() {
        assert_eq!(counted(1, "vertices"), "1 vertex");
        assert_eq!(counted(2, "meshes"), "2 meshes");
        assert_eq!(counted(1, "meshes"), "1 mesh");
        assert_eq!(counted(1, "textures"), "1 texture");
        assert_eq!(bytes(1), "1 byte");
        assert_eq!(bytes(10_239), "10239 bytes");
        assert_eq!(bytes(10_240), "10.0 KiB");
        assert_eq!(bytes(15 << 20), "15.0 MiB");
        assert_eq!(
            [2.0, 1.666_666_6, 100.0].map(rounded),
            ["2", "1.667", "100"]
        );
    }

    #[test]
    fn lists_are_wrapped_and_aligned() {
        let mut lines = Lines::new("m: OBJ");
        let (long, short) = ("a".repeat(50), "b".repeat(34));
        lines.add_list("material", "x:", &[&long, &short, &long]);
        lines.add_list("mesh", "", &[&"c".repeat(120)]);
        lines.add_rest(25, 20, "meshes");
        let blank = " ".repeat(13);
        let expected = [
            "m: OBJ".to_owned(),
            format!("  material   x: {long},"),
            format!("{blank}{short}, {long}"),
            format!("  mesh       {}", "c".repeat(120)),
            format!("{blank}and 5 more meshes"),
        ];
        assert_eq!(lines.text.lines().collect::<Vec<_>>(), expected);
    }
}
