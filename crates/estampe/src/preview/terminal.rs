//! What a terminal shows, by its environment.

/// Kinds of pictures in a terminal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    Kitty,
    Sixel,
    Blocks,
}

/// Colours of text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Colors {
    /// 8 bits a channel.
    True,
    /// The 256 colours of xterm.
    Indexed,
    /// None: characters of different darkness.
    None,
}

/// A terminal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Terminal {
    pub(super) kind: Kind,
    pub(super) colors: Colors,
    /// Characters in a line.
    pub(super) columns: u32,
    /// Lines that a picture may take.
    pub(super) rows: u32,
}

/// Lines for the command and the prompt after the picture.
const OTHER_LINES: u32 = 2;

/// The most characters in a line, and lines, that are believed.
const MOST: u32 = 4096;

impl Terminal {
    /// A terminal of this size, in characters; without a size that of COLUMNS and LINES, else
    /// 80x24.
    pub(super) fn new(
        kind: Kind,
        size: Option<(u32, u32)>,
        variable: impl Fn(&str) -> Option<String>,
    ) -> Self {
        let number = |name: &str| variable(name)?.trim().parse().ok();
        let given = || {
            (
                number("COLUMNS").unwrap_or(80),
                number("LINES").unwrap_or(24),
            )
        };
        let (columns, lines) = size.unwrap_or_else(given);
        Self {
            kind,
            colors: Colors::of(&variable),
            columns: columns.clamp(1, MOST),
            rows: lines.min(MOST).saturating_sub(OTHER_LINES).max(1),
        }
    }
}

impl Kind {
    /// What the environment says that the terminal shows.
    pub(super) fn detected(variable: impl Fn(&str) -> Option<String>) -> Self {
        let is_set = |name: &str| variable(name).is_some_and(|value| !value.is_empty());
        let term = variable("TERM").unwrap_or_default();
        let program = variable("TERM_PROGRAM").unwrap_or_default();
        let starts = |names: &[&str]| names.iter().any(|name| term.starts_with(name));
        // Pictures do not pass through multiplexers, whose variables those of the terminal outlive.
        if is_set("TMUX") || is_set("STY") || starts(&["tmux", "screen", "dumb"]) {
            return Self::Blocks;
        }
        let is_kitty = is_set("KITTY_WINDOW_ID")
            || is_set("GHOSTTY_RESOURCES_DIR")
            || starts(&["xterm-kitty", "xterm-ghostty"])
            || program == "ghostty";
        if is_kitty {
            return Self::Kitty;
        }
        let is_sixel = term.contains("sixel")
            || starts(&["foot", "mlterm", "yaft", "contour"])
            || ["WezTerm", "mintty", "contour", "iTerm.app"].contains(&program.as_str());
        if is_sixel { Self::Sixel } else { Self::Blocks }
    }
}

impl Colors {
    fn of(variable: &impl Fn(&str) -> Option<String>) -> Self {
        let term = variable("TERM").unwrap_or_default();
        // https://no-color.org: any value but an empty one.
        let is_without = variable("NO_COLOR").is_some_and(|value| !value.is_empty());
        if is_without || term == "dumb" {
            return Self::None;
        }
        let has_all = variable("COLORTERM")
            .is_some_and(|value| value == "truecolor" || value == "24bit")
            || term.ends_with("-direct");
        if has_all { Self::True } else { Self::Indexed }
    }
}

#[cfg(test)]
mod tests {
    use super::{Colors, Kind, Terminal};

    fn kind(variables: &[(&str, &str)]) -> Kind {
        Kind::detected(|name| value(variables, name))
    }

    fn value(variables: &[(&str, &str)], name: &str) -> Option<String> {
        let found = variables.iter().find(|(of, _)| *of == name);
        found.map(|(_, value)| (*value).to_owned())
    }

    #[test]
    fn the_environment_says_what_is_shown() {
        let kitty = ("KITTY_WINDOW_ID", "1");
        assert_eq!(kind(&[kitty, ("TERM", "xterm-256color")]), Kind::Kitty);
        assert_eq!(kind(&[("TERM", "xterm-ghostty")]), Kind::Kitty);
        assert_eq!(kind(&[("TERM", "foot-extra")]), Kind::Sixel);
        assert_eq!(kind(&[("TERM_PROGRAM", "WezTerm")]), Kind::Sixel);
        assert_eq!(kind(&[("TERM", "xterm-256color")]), Kind::Blocks);
        assert_eq!(kind(&[]), Kind::Blocks);
        // Inside tmux, the variables of the terminal are there too.
        let tmux = ("TMUX", "/tmp/tmux-0/default,1,0");
        assert_eq!(kind(&[kitty, tmux]), Kind::Blocks);
        assert_eq!(
            kind(&[("TERM", "screen"), ("TERM_PROGRAM", "WezTerm")]),
            Kind::Blocks
        );
    }

    #[test]
    fn colours_and_sizes_are_those_of_the_environment() {
        let terminal = |size, variables: &[(&str, &str)]| {
            let terminal = Terminal::new(Kind::Blocks, size, |name| value(variables, name));
            (terminal.colors, terminal.columns, terminal.rows)
        };
        let all = ("COLORTERM", "truecolor");
        assert_eq!(terminal(None, &[all]), (Colors::True, 80, 22));
        let lines = [("COLUMNS", "40"), ("LINES", "0"), ("NO_COLOR", "")];
        assert_eq!(terminal(None, &lines), (Colors::Indexed, 40, 1));
        assert_eq!(terminal(Some((9, 12)), &lines), (Colors::Indexed, 9, 10));
        assert_eq!(terminal(None, &[all, ("NO_COLOR", "1")]).0, Colors::None);
        assert_eq!(terminal(Some((u32::MAX, u32::MAX)), &[]).1, 4096);
    }
}
