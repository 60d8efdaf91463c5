//! Steps of grids and labels of sizes.

use super::bounding_box::label;
use super::grid::Steps;

#[test]
fn steps_are_1_2_or_5_times_a_power_of_ten() {
    for (length, step, major) in [
        (5.0, 1.0, 5.0),
        (9.9, 1.0, 5.0),
        (10.1, 2.0, 5.0),
        (26.0, 5.0, 2.0),
        (49.0, 5.0, 2.0),
        (51.0, 10.0, 5.0),
        (0.06, 0.01, 5.0),
        (3.1e7, 5e6, 2.0),
    ] {
        let steps = Steps::of(length);
        assert!(
            (steps.step / step - 1.0).abs() < 1e-9,
            "{length}: {steps:?}"
        );
        assert_eq!(steps.major, major, "{length}");
    }
    for extreme in [0.0, f64::MIN_POSITIVE, 1e300, f64::INFINITY, f64::NAN] {
        assert!(Steps::of(extreme).step > 0.0, "{extreme}");
    }
}

#[test]
fn labels_have_four_digits_and_the_unit() {
    for (length, text) in [
        (20.0, "20"),
        (20.25, "20.25"),
        (6.434_33, "6.434"),
        (1234.56, "1235"),
        (0.012_345, "0.0123"),
        (0.0, "0"),
        (100.0, "100"),
        (1e7, "1.000e7"),
        (3e-5, "3.000e-5"),
    ] {
        assert_eq!(label(length, None), text);
    }
    assert_eq!(label(20.0, Some("mm")), "20 mm");
}
