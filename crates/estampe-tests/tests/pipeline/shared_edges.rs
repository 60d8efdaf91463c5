//! Triangles that share edges cover each sample once: one second of `cargo xtask fuzz raster`.

use std::time::Duration;

/// Rows: R1, R6, A3.
#[test]
fn triangles_that_share_edges_cover_each_sample_once() {
    match estampe_tests::fuzz::run(Duration::from_secs(1), 0) {
        Ok(tally) => assert!(tally.primitives > 0, "nothing was drawn"),
        Err(failure) => panic!("{failure}"),
    }
}
