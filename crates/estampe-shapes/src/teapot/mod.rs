//! The Utah teapot, from the control points that Martin Newell published in 1975.
//!
//! 32 bicubic Bézier patches over 306 points ("The Origins of the Teapot", Crow, IEEE Computer
//! Graphics and Applications 7(1), 1987, has the table; the four patches of the bottom were added
//! later). These are the usual, squashed proportions: the real pot is 1.3 times higher.
//!
//! ```text
//!             knob 20–23                    y
//!          ___╭─╮___   lid 24–27            │
//!    ╭─╮  ╱_________╲  rim 0–3     ╱        └── x
//!   ╱ ╭──│           │────╮      ╱╱        (z towards the reader)
//!   │ │  │  body     │     ╲___╱ ╱  spout 16–19
//!   ╲ ╰──│  4–7,     │          ╱
//! handle  ╲ 8–11    ╱──────────╯
//! 12–15    ╰───────╯  bottom 28–31
//! ```
//!
//! The published axes have z up; here (x, y, z) becomes (x, z, −y). The texture coordinates of each
//! part cover whole images: rim and body together four times around, as are the lid and the bottom;
//! handle and spout once. The teapot is not a closed solid: the lid rests on the rim unconnected,
//! and handle and spout extend into the body.

mod control_points;
mod tessellate;

pub use control_points::{PATCHES, POINTS};
pub use tessellate::{DEFAULT_CELLS, patch, teapot};

#[cfg(test)]
mod tests;
