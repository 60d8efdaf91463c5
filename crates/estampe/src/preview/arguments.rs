//! The option of previews.

use super::terminal::{Kind, Terminal};
use super::{blocks, kitty, sixel};
use crate::failure::Failure;
use clap::{Args, ValueEnum};
use estampe_scene::Image;
use std::io::IsTerminal;

/// Whether the picture is shown in the terminal.
#[derive(Debug, Clone, Args)]
pub(crate) struct PreviewArgs {
    /// Show the picture in the terminal, instead of -o or besides: auto, kitty, sixel or blocks
    ///
    /// kitty: the kitty graphics protocol; sixel: up to 255 colours; blocks: half blocks in 24-bit
    /// colour, or in 256 colours if COLORTERM does not say truecolor; with NO_COLOR or TERM=dumb
    /// characters, darker ones for darker colours; auto: by the environment (TERM, TERM_PROGRAM,
    /// KITTY_WINDOW_ID), and blocks inside tmux and screen. Kinds other than auto are written to
    /// files and pipes too, for COLUMNS x LINES characters, else 80x24.
    #[arg(long, value_name = "KIND", value_enum, num_args = 0..=1, require_equals = true)]
    #[arg(default_missing_value = "auto", hide_possible_values = true)]
    #[arg(conflicts_with_all = ["json", "pass", "cameras"], help_heading = "Preview")]
    pub(crate) preview: Option<PreviewName>,
}

/// Names of kinds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum PreviewName {
    /// What the terminal shows
    Auto,
    /// The kitty graphics protocol
    Kitty,
    /// Sixel
    Sixel,
    /// Half blocks
    Blocks,
}

impl PreviewArgs {
    /// The terminal that shows the preview, if one is asked for.
    pub(crate) fn terminal(&self) -> Result<Option<Terminal>, Failure> {
        let Some(name) = self.preview else {
            return Ok(None);
        };
        let variable = |name: &str| std::env::var(name).ok();
        let kind = match name {
            PreviewName::Kitty => Kind::Kitty,
            PreviewName::Sixel => Kind::Sixel,
            PreviewName::Blocks => Kind::Blocks,
            PreviewName::Auto if std::io::stdout().is_terminal() => Kind::detected(variable),
            PreviewName::Auto => {
                return Err(Failure::Usage(
                    "--preview shows the picture in a terminal, and standard output is none; write a \
                     file by -o, or name the kind, as in --preview=blocks"
                        .to_owned(),
                ));
            }
        };
        let size = terminal_size::terminal_size();
        let size = size.map(|(width, height)| (u32::from(width.0), u32::from(height.0)));
        Ok(Some(Terminal::new(kind, size, variable)))
    }
}

impl Terminal {
    /// The bytes that show a picture, with straight alpha.
    pub(crate) fn bytes(&self, image: &Image) -> Result<Vec<u8>, Failure> {
        match self.kind {
            Kind::Kitty => kitty::bytes(image, self),
            Kind::Sixel => Ok(sixel::bytes(image, self)),
            Kind::Blocks => Ok(blocks::text(image, self).into_bytes()),
        }
    }
}
