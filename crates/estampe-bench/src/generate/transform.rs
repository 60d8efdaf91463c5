//! Vectors and matrices in binary64, for column vectors.

use super::sin_cos_turns;

/// A direction or a position.
pub type Vector = [f64; 3];

/// Inner product, summed from the first component on.
#[must_use]
pub fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The vector divided by its length.
#[must_use]
pub fn normalize(v: Vector) -> Vector {
    let length = dot(v, v).sqrt();
    v.map(|component| component / length)
}

/// Outer product.
#[must_use]
pub fn cross(a: Vector, b: Vector) -> Vector {
    let minor = |i: usize, j: usize| a[i] * b[j] - a[j] * b[i];
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}

/// A 4×4 matrix.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Matrix {
    /// Its columns.
    pub columns: [[f64; 4]; 4],
}

impl Matrix {
    /// The identity matrix.
    pub const IDENTITY: Self = Self {
        columns: [
            [1.0, 0.0, 0.0, 0.0],
            [0.0, 1.0, 0.0, 0.0],
            [0.0, 0.0, 1.0, 0.0],
            [0.0, 0.0, 0.0, 1.0],
        ],
    };

    /// Moves by `offset`.
    #[must_use]
    pub fn translation([x, y, z]: Vector) -> Self {
        let mut matrix = Self::IDENTITY;
        matrix.columns[3] = [x, y, z, 1.0];
        matrix
    }

    /// Uniform scaling by `factor`.
    #[must_use]
    pub fn scaling(factor: f64) -> Self {
        let mut matrix = Self::IDENTITY;
        for axis in 0..3 {
            matrix.columns[axis][axis] = factor;
        }
        matrix
    }

    /// Rotation about the x axis, from y towards z.
    #[must_use]
    pub fn rotation_x(turns: f64) -> Self {
        let (sine, cosine) = sin_cos_turns(turns);
        let mut matrix = Self::IDENTITY;
        matrix.columns[1] = [0.0, cosine, sine, 0.0];
        matrix.columns[2] = [0.0, -sine, cosine, 0.0];
        matrix
    }

    /// Rotation about the y axis, from z towards x.
    #[must_use]
    pub fn rotation_y(turns: f64) -> Self {
        let (sine, cosine) = sin_cos_turns(turns);
        let mut matrix = Self::IDENTITY;
        matrix.columns[0] = [cosine, 0.0, -sine, 0.0];
        matrix.columns[2] = [sine, 0.0, cosine, 0.0];
        matrix
    }

    /// The product `self · first`, which applies `first` first. Each element's products are summed
    /// in order.
    #[must_use]
    pub fn times(&self, first: &Self) -> Self {
        let a = &self.columns;
        let columns = first.columns.map(|[x, y, z, w]| {
            [0, 1, 2, 3].map(|row| a[0][row] * x + a[1][row] * y + a[2][row] * z + a[3][row] * w)
        });
        Self { columns }
    }

    /// A point under an affine matrix; the products are summed in order.
    #[must_use]
    pub fn point(&self, [x, y, z]: Vector) -> Vector {
        let a = &self.columns;
        [0, 1, 2].map(|row| a[0][row] * x + a[1][row] * y + a[2][row] * z + a[3][row])
    }
}

/// The view rays of a perspective camera: at normalised device coordinates (x, y) it looks along
/// `x · [0] + y · [1] + [2]` in world space, which has length 1 along the view axis.
#[must_use]
pub fn view_rays(view_from_world: &Matrix, clip_from_view: &Matrix) -> [Vector; 3] {
    let axes = &view_from_world.columns;
    let scales = &clip_from_view.columns;
    let row = |row: usize, scale: f64| [0, 1, 2].map(|column: usize| axes[column][row] * scale);
    [
        row(0, 1.0 / scales[0][0]),
        row(1, 1.0 / scales[1][1]),
        row(2, -1.0),
    ]
}

/// View from world: the camera at `eye` looks down −z at `target`.
#[must_use]
pub fn look_at(eye: Vector, target: Vector, up: Vector) -> Matrix {
    let forward = normalize([target[0] - eye[0], target[1] - eye[1], target[2] - eye[2]]);
    let right = normalize(cross(forward, up));
    let upward = cross(right, forward);
    let column = |axis: usize| [right[axis], upward[axis], -forward[axis], 0.0];
    Matrix {
        columns: [
            column(0),
            column(1),
            column(2),
            [-dot(right, eye), -dot(upward, eye), dot(forward, eye), 1.0],
        ],
    }
}

/// Clip from view, z from 0 at `near` to w at `far`; `view_turns` is the vertical angle of view.
#[must_use]
pub fn perspective(view_turns: f64, aspect: f64, near: f64, far: f64) -> Matrix {
    let (sine, cosine) = sin_cos_turns(view_turns * 0.5);
    let focal = cosine / sine;
    let depth = near - far;
    Matrix {
        columns: [
            [focal / aspect, 0.0, 0.0, 0.0],
            [0.0, focal, 0.0, 0.0],
            [0.0, 0.0, far / depth, -1.0],
            [0.0, 0.0, near * far / depth, 0.0],
        ],
    }
}

/// Clip from view without perspective: x and y from −`half_side` to `half_side`, z from 0 at `near`
/// to 1 at `far`.
#[must_use]
pub fn orthographic(half_side: f64, near: f64, far: f64) -> Matrix {
    let depth = near - far;
    Matrix {
        columns: [
            [1.0 / half_side, 0.0, 0.0, 0.0],
            [0.0, 1.0 / half_side, 0.0, 0.0],
            [0.0, 0.0, 1.0 / depth, 0.0],
            [0.0, 0.0, near / depth, 1.0],
        ],
    }
}
