//! The reasons why an implicit curve or surface cannot be meshed.

use std::fmt;

use super::MAX_ELEMENTS;

/// The reason why an implicit curve or surface cannot be meshed.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum ImplicitError {
    /// A side of the box is empty, infinite or NaN.
    Bounds {
        /// The number of the axis.
        axis: usize,
    },
    /// The box is so far from the origin, and its cells are so small, that f32 cannot tell their
    /// vertices apart.
    TooFine {
        /// The number of the axis.
        axis: usize,
        /// The length of a cell.
        cell: f64,
        /// The largest coordinate.
        coordinate: f64,
    },
    /// More than [`MAX_ELEMENTS`] triangles or segments.
    TooManyElements,
}

impl fmt::Display for ImplicitError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = |axis: usize| ["x", "y", "z"][axis.min(2)];
        match *self {
            Self::Bounds { axis } => {
                let name = name(axis);
                write!(
                    f,
                    "the range of {name} is empty or not finite; choose two finite numbers"
                )
            }
            Self::TooFine {
                axis,
                cell,
                coordinate,
            } => {
                let name = name(axis);
                write!(
                    f,
                    "cells of length {cell} cannot be told apart at {name} = {coordinate}, because \
                     coordinates are 32-bit floats; choose fewer cells or a box nearer to the origin"
                )
            }
            Self::TooManyElements => write!(
                f,
                "the function has more than {MAX_ELEMENTS} triangles or segments in this box; \
                 choose a lower resolution or a smaller box"
            ),
        }
    }
}

impl std::error::Error for ImplicitError {}
