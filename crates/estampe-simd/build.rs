//! Decides which levels are built in, of those that are not in every build: the scalar one with its
//! feature, and for targets without SIMD; AVX-512 but in dev builds by a processor that lacks it.

use std::env::var;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rustc-check-cfg=cfg(scalar_level)");
    let architecture = var("CARGO_CFG_TARGET_ARCH").unwrap_or_default();
    let features = var("CARGO_CFG_TARGET_FEATURE").unwrap_or_default();
    let has_simd = match architecture.as_str() {
        "x86_64" | "aarch64" => true,
        "wasm32" => features.split(',').any(|feature| feature == "simd128"),
        _ => false,
    };
    if !has_simd || var("CARGO_FEATURE_SCALAR_LEVEL").is_ok() {
        println!("cargo::rustc-cfg=scalar_level");
    }
    println!("cargo::rustc-check-cfg=cfg(avx512_level)");
    if architecture == "x86_64" && !is_dev_build_without_avx512() {
        println!("cargo::rustc-cfg=avx512_level");
    }
}

/// True for a dev build for this machine, if its processor lacks AVX-512: it could not run the
/// third of the machine code of lanes that is of this level.
fn is_dev_build_without_avx512() -> bool {
    #[cfg(target_arch = "x86_64")]
    let lacks_avx512 = !std::arch::is_x86_feature_detected!("avx512f");
    #[cfg(not(target_arch = "x86_64"))]
    let lacks_avx512 = false;
    let is_dev = var("PROFILE").is_ok_and(|profile| profile == "debug");
    let is_for_this_machine = var("HOST").ok() == var("TARGET").ok();
    lacks_avx512 && is_dev && is_for_this_machine
}
