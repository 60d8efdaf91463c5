//! The generated data are equal to `peerbench`'s, byte for byte.

use crate::frame::FrameSize;
use crate::scene::{ALL, Detail, SceneEntry};

/// Scene, triangles and fingerprint, as `peerbench` prints them at 1280×720.
const PEERBENCH: &[(&str, u64, u64)] = &[
    ("clear", 0, 0xcbf2_9ce4_8422_2325),
    ("fill", 64, 0x0252_fe24_63db_7e25),
    ("fill_front", 64, 0xdccc_736e_8875_b8a5),
    ("blend", 64, 0x3618_fd3a_0431_1e4e),
    ("small_tris", 998_000, 0xf719_cfc8_43a1_db9e),
    ("mid_tris", 69_696, 0x5d8f_b7d2_93ba_0559),
    ("textured", 32, 0x392a_b9bc_6e9e_47aa),
    ("heavy_fs", 2, 0x0ff2_2474_dcca_6243),
    ("shadow", 139_394, 0xf1e6_0395_f911_3e8e),
    ("msaa4", 69_696, 0x5d8f_b7d2_93ba_0559),
    ("instances", 1_000_000, 0x34e0_1eb1_75a5_2260),
    ("ui", 46_800, 0xcb64_b33a_4df9_dd87),
    ("gbuffer", 69_700, 0x8462_d60c_b6d7_ba33),
    ("stencil", 69_357, 0xcd6c_3b25_95ed_2160),
    ("postfx", 1_514, 0x7262_7d75_a138_4335),
    ("particles", 209_025, 0x6f1c_b5be_7577_9cd8),
    ("foliage", 120_002, 0xd68a_be44_4ffb_5395),
    ("wire", 150_152, 0x8d7c_50f1_66d4_577e),
    ("skybox", 100_003, 0x639e_4624_b8de_9215),
    ("mandelbrot_compute", 0, 0xcbf2_9ce4_8422_2325),
    ("blur_compute", 0, 0x49f1_355e_3fb0_6a86),
    ("nbody_compute", 0, 0xce4c_c442_3d5c_df9f),
    ("histogram_compute", 0, 0xc045_1a31_cc81_6c17),
    ("fill_draws", 64, 0x0252_fe24_63db_7e25),
    ("textured_draws", 32, 0x392a_b9bc_6e9e_47aa),
    ("many_draws", 1_000_000, 0x34e0_1eb1_75a5_2260),
];

/// Triangles and fingerprints of scenes that `peerbench` does not have, so that changes of their
/// data are detected.
const OURS: &[(&str, u64, u64)] = &[("quad_draws", 20_000, 0x2a65_8d6c_788e_f3ba)];

#[test]
fn the_data_equal_those_of_peerbench() {
    let size = FrameSize {
        width: 1280,
        height: 720,
    };
    for &(name, triangles, fingerprint) in PEERBENCH.iter().chain(OURS) {
        let scene = SceneEntry::named(name)
            .expect(name)
            .make(Detail::Full, size);
        assert_eq!(scene.triangles(), triangles, "{name}");
        assert_eq!(
            scene.fingerprint(),
            fingerprint,
            "{name}: {:016x}, not {fingerprint:016x}",
            scene.fingerprint()
        );
    }
    let is_peers = |name: &str| PEERBENCH.iter().any(|(peers, ..)| *peers == name);
    for entry in ALL {
        assert_eq!(entry.is_peers, is_peers(entry.name), "{}", entry.name);
    }
}
