//! Matrices of cameras: intrinsics and rotations, checked.

use estampe_renderer::Intrinsics;
use glam::{DMat3, DVec3};

/// The greatest focal length and coordinate of a principal point, in pixels.
const MOST_PX: f64 = 1e9;

/// By how much the product of a rotation and its transpose may differ from the identity: rotations
/// in print have four digits.
const TOLERANCE: f64 = 1e-3;

/// The intrinsics of K.
pub(super) fn intrinsics(k: [[f64; 3]; 3]) -> Result<Intrinsics, String> {
    let [[fx, skew, cx], [below, fy, cy], last] = k;
    if last != [0.0, 0.0, 1.0] {
        return Err(format!("its last row is {last:?}; write 0, 0, 1"));
    }
    if skew != 0.0 || below != 0.0 {
        let skew = if skew == 0.0 { below } else { skew };
        return Err(format!(
            "a skew of {skew}; pixels are upright here, so remove the skew from the images first"
        ));
    }
    if !(fx > 0.0 && fy > 0.0 && fx <= MOST_PX && fy <= MOST_PX) {
        return Err(format!(
            "focal lengths of {fx} and {fy} pixels; write lengths above 0, as in 800"
        ));
    }
    if cx.abs() > MOST_PX || cy.abs() > MOST_PX {
        return Err(format!(
            "a principal point at {cx}, {cy}; write pixels from the upper left corner"
        ));
    }
    Ok(Intrinsics {
        focal_px: [fx, fy],
        principal_px: [cx, cy],
    })
}

/// The orthonormal rows of R. What is a rotation to four digits is made one (Gram-Schmidt).
pub(super) fn rotation(rows: [[f64; 3]; 3]) -> Result<[DVec3; 3], String> {
    let r = DMat3::from_cols_array_2d(&rows);
    // The rows of R are the columns here.
    let off = (r.transpose() * r - DMat3::IDENTITY).to_cols_array();
    let worst = off.into_iter().map(f64::abs).fold(0.0, f64::max);
    let determinant = r.determinant();
    // What is not a number is no rotation either.
    if !off.iter().all(|one| one.abs() <= TOLERANCE) {
        return Err(format!(
            "this is no rotation: R times its transpose differs from the identity by {worst:.3} \
             (determinant {determinant:.3}); its rows are the unit vectors right, down and forward"
        ));
    }
    if determinant < 0.0 {
        return Err(format!(
            "this is a reflection, of determinant {determinant:.3}: x points right, y down and z forward; negate \
             the row that points the other way"
        ));
    }
    let [right, down, _] = rows.map(DVec3::from_array);
    let right = right.normalize();
    let down = (down - right * down.dot(right)).normalize();
    Ok([right, down, right.cross(down)])
}

#[cfg(test)]
mod tests {
    use super::{intrinsics, rotation};

    #[test]
    fn rotations_are_orthonormal() {
        let rows = [[0.0, 0.0, -1.0], [0.0, -1.0, 0.0], [-1.0, 0.0, 0.0]];
        let turned = rotation(rows).expect("a rotation");
        assert_eq!(turned.map(|row| row.to_array()), rows);
        // Four digits.
        let rows = [[0.8, -0.6004, 0.0], [0.6, 0.8, 0.0], [0.0, 0.0, 1.0]];
        let turned = rotation(rows).expect("nearly a rotation");
        for (at, row) in turned.iter().enumerate() {
            assert!((row.length() - 1.0).abs() < 1e-15, "{row}");
            assert!(row.dot(turned[(at + 1) % 3]).abs() < 1e-15, "{row}");
        }
        let error = |rows| rotation(rows).expect_err("no rotation");
        let scaled = [[2.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        assert!(error(scaled).contains("by 3.000 (determinant 2.000)"));
        let mirrored = [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]];
        assert!(error(mirrored).contains("determinant -1.000"));
        assert!(rotation([[f64::MAX; 3]; 3]).is_err());
        assert!(rotation([[0.0; 3]; 3]).is_err());
    }

    #[test]
    fn intrinsics_have_no_skew() {
        let k = |fx, skew, fy| intrinsics([[fx, skew, 9.5], [0.0, fy, -7.0], [0.0, 0.0, 1.0]]);
        let right = k(800.0, 0.0, 750.0).expect("right");
        assert_eq!(right.focal_px, [800.0, 750.0]);
        assert_eq!(right.principal_px, [9.5, -7.0]);
        assert!(k(800.0, 0.1, 800.0).is_err_and(|error| error.contains("skew of 0.1")));
        assert!(k(-800.0, 0.0, 800.0).is_err_and(|error| error.contains("focal lengths")));
        assert!(k(1e300, 0.0, 800.0).is_err());
        assert!(intrinsics([[1.0; 3]; 3]).is_err_and(|error| error.contains("last row")));
    }
}
