//! Decides whether the scalar level is built in: with its feature, and for targets without SIMD.

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
}
