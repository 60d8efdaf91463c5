//! Square matrices of `f32` (uniforms, and the host's transforms) or of lanes.
//! The conventions are in the documentation of [`Mat4`].

mod inverse;
mod products;
mod projections;
mod transforms;

use crate::{Real, Vec2, Vec3, Vec4};

macro_rules! matrix {
    (
        $(#[$doc:meta])*
        $name:ident of $n:literal $vector:ident: $($column:ident $index:tt)+; $rows:tt
    ) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq)]
        pub struct $name<R = f32>(pub [[R; $n]; $n]);

        impl<R: Real> $name<R> {
            /// The matrix with these columns.
            #[inline(always)]
            pub fn from_columns($($column: $vector<R>),+) -> Self {
                Self([$($column.into()),+])
            }

            /// The matrix with these rows.
            #[inline(always)]
            pub fn from_rows($($column: $vector<R>),+) -> Self {
                Self::from_columns($($column),+).transpose()
            }

            /// The columns.
            #[inline(always)]
            pub fn columns(&self) -> [$vector<R>; $n] {
                [$($vector::from(self.0[$index])),+]
            }

            /// The matrix whose columns are the rows of this one.
            #[inline(always)]
            #[must_use]
            pub fn transpose(&self) -> Self {
                Self(self.rows())
            }

            /// The matrix by rows.
            #[inline(always)]
            fn rows(&self) -> [[R; $n]; $n] {
                matrix! { @rows self $rows $($index)+ }
            }
        }

        impl<R> From<[[R; $n]; $n]> for $name<R> {
            /// The matrix with these columns.
            fn from(columns: [[R; $n]; $n]) -> Self {
                Self(columns)
            }
        }

        impl<R> From<$name<R>> for [[R; $n]; $n] {
            /// The columns.
            fn from(matrix: $name<R>) -> Self {
                matrix.0
            }
        }
    };
    // Rows by explicit components: `map` and `from_fn` may leave the SIMD level.
    (@rows $m:ident ($($row:tt)+) $($index:tt)+) => {
        matrix! { @each $m ($($row)+) ($($index)+) }
    };
    (@each $m:ident ($($row:tt)+) $columns:tt) => {
        [$(matrix! { @row $m $row $columns }),+]
    };
    (@row $m:ident $row:tt ($($column:tt)+)) => {
        [$($m.0[$column][$row]),+]
    };
}

matrix! {
    /// A 2×2 matrix by columns.
    Mat2 of 2 Vec2: x 0 y 1; (0 1)
}
matrix! {
    /// A 3×3 matrix by columns, such as the transform of directions, or a tangent frame of lanes.
    Mat3 of 3 Vec3: x 0 y 1 z 2; (0 1 2)
}
matrix! {
    /// A 4×4 matrix by columns: `clip = m * position`.
    ///
    /// # Conventions
    ///
    /// Vectors are columns, `clip = clip_from_view * view_from_world * p_world`; a matrix is an
    /// array of its columns, `m.0[column][row]`. Object, world and view space are right-handed, and
    /// the camera looks down −z with y up. NDC has x to the right, y up, and z from 0 (near) to 1
    /// (far); functions whose name ends in `_gl` have OpenGL's z, −1 to 1.
    ///
    /// ```
    /// use estampe_types::{Mat4, vec3};
    ///
    /// let view_from_world = Mat4::look_at([0.0, 0.0, 5.0], [0.0; 3], [0.0, 1.0, 0.0]);
    /// let clip_from_view = Mat4::perspective(1.0, 16.0 / 9.0, 0.1, 100.0);
    /// let world_from_object = Mat4::rotation_y(0.5) * Mat4::scale([2.0; 3]);
    /// let clip_from_object = clip_from_view * view_from_world * world_from_object;
    /// assert_eq!(clip_from_object.transform_point(vec3(0.0, 0.0, 0.0)).w, 5.0);
    /// ```
    ///
    /// # Other libraries
    ///
    /// glam, cgmath and nalgebra store columns too: `Mat4(m.to_cols_array_2d())` is the same
    /// matrix, and `glam::Mat4::from_cols_array_2d(&m.0)` is the way back. An array of rows needs a
    /// [`transpose`](Mat4::transpose).
    Mat4 of 4 Vec4: x 0 y 1 z 2 w 3; (0 1 2 3)
}

impl Mat2 {
    /// The identity matrix.
    pub const IDENTITY: Self = Self([[1.0, 0.0], [0.0, 1.0]]);
}

impl Mat3 {
    /// The identity matrix.
    pub const IDENTITY: Self = Self([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
}

impl Mat4 {
    /// The identity matrix.
    pub const IDENTITY: Self = Self([
        [1.0, 0.0, 0.0, 0.0],
        [0.0, 1.0, 0.0, 0.0],
        [0.0, 0.0, 1.0, 0.0],
        [0.0, 0.0, 0.0, 1.0],
    ]);
}

impl<R: Real> Mat4<R> {
    /// The upper left 3×3 part, which transforms directions.
    #[inline(always)]
    pub fn to_mat3(&self) -> Mat3<R> {
        let [x, y, z, _] = self.columns();
        Mat3::from_columns(x.xyz(), y.xyz(), z.xyz())
    }
}

impl From<glam::Mat4> for Mat4 {
    fn from(matrix: glam::Mat4) -> Self {
        Self(matrix.to_cols_array_2d())
    }
}

impl From<glam::Mat3> for Mat3 {
    fn from(matrix: glam::Mat3) -> Self {
        Self(matrix.to_cols_array_2d())
    }
}
