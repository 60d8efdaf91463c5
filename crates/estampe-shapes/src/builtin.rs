//! The built-in models, by name.

use std::fmt;
use std::str::FromStr;

use crate::mesh::ShapeMesh;
use crate::parametric::{plane, sphere, torus};
use crate::{cube, teapot};

/// A built-in model.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum BuiltinShape {
    /// The Utah teapot with its bottom, standing on y = 0: 6.43 wide, 3.15 high, spout towards +x.
    Teapot,
    /// The sphere of radius 1 around the origin, its poles on the Y axis.
    Sphere,
    /// The torus around the Y axis: ring of radius 1, tube of radius 0.45.
    Torus,
    /// The cube from −1 to 1; every face shows the whole image.
    Cube,
    /// The square from −1 to 1 in x and z that faces +Y.
    Plane,
}

impl BuiltinShape {
    /// Every built-in model, in the order in which listings show them.
    pub const ALL: [Self; 5] = [
        Self::Teapot,
        Self::Sphere,
        Self::Torus,
        Self::Cube,
        Self::Plane,
    ];

    /// The name that [`FromStr`] accepts.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Teapot => "teapot",
            Self::Sphere => "sphere",
            Self::Torus => "torus",
            Self::Cube => "cube",
            Self::Plane => "plane",
        }
    }

    /// Builds the model, fine enough for an image of a thousand pixels.
    #[must_use]
    pub fn build(self) -> ShapeMesh {
        match self {
            Self::Teapot => teapot::teapot(teapot::DEFAULT_CELLS),
            Self::Sphere => sphere(1.0, 96, 48),
            Self::Torus => torus(1.0, 0.45, 96, 48),
            Self::Cube => cube::cube(2.0),
            Self::Plane => plane(2.0, 2.0, [1, 1]),
        }
    }
}

impl fmt::Display for BuiltinShape {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for BuiltinShape {
    type Err = UnknownShape;

    fn from_str(name: &str) -> Result<Self, UnknownShape> {
        let named = Self::ALL
            .into_iter()
            .find(|shape| shape.name().eq_ignore_ascii_case(name));
        named.ok_or_else(|| UnknownShape {
            name: name.to_owned(),
        })
    }
}

/// Error: no built-in model has this name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownShape {
    /// The given name.
    pub name: String,
}

impl fmt::Display for UnknownShape {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "no built-in model is called {:?}; there are ", self.name)?;
        for (i, shape) in BuiltinShape::ALL.into_iter().enumerate() {
            let separator = match i {
                0 => "",
                _ if i + 1 == BuiltinShape::ALL.len() => " and ",
                _ => ", ",
            };
            write!(f, "{separator}{shape}")?;
        }
        Ok(())
    }
}

impl std::error::Error for UnknownShape {}
