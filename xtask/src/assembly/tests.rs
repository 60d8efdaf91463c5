//! The names are those of a real binary built with functions that were, and were not, inlined; the
//! code is made here, so that calls are known.

use super::*;

const AVX2_ENTRY: &str = "<fearless_simd::generated::avx2::Avx2 as \
    fearless_simd::generated::simd_trait::Simd>::vectorize::vectorize_avx2::<estampe_core::raster::\
    run<fearless_simd::generated::avx2::Avx2>::{closure#0}, ()>";
const AVX512_ENTRY: &str = "<fearless_simd::generated::avx512::Avx512 as \
    fearless_simd::generated::simd_trait::Simd>::vectorize::vectorize_avx512::<estampe_core::tiles::\
    {closure#1}, ()>";
const KERNEL: &str = "<fearless_simd::generated::avx2::Avx2 as \
    fearless_simd::generated::simd_trait::Simd>::add_f32x8::kernel::__fearless_simd_kernel";
const HELPER: &str = "estampe_core::raster::edge::<fearless_simd::generated::avx2::Avx2>";
const TRAMPOLINE: &str = "estampe_core::raster::run::<fearless_simd::generated::avx2::Avx2>";

/// Functions at addresses 0, 100, 200, …, each with calls to the addresses given.
fn report_of(functions: &[(&'static str, &[i32])]) -> Result<AssemblyReport, AssemblyError> {
    let codes: Vec<Vec<u8>> = (0..)
        .zip(functions)
        .map(|(index, (_, targets))| {
            let mut code = vec![0x90];
            for target in *targets {
                let next = index * 100 + i32::try_from(code.len()).unwrap() + 5;
                code.push(0xe8);
                code.extend((target - next).to_le_bytes());
            }
            code
        })
        .collect();
    let functions: Vec<Function<'_>> = (0..)
        .zip(functions.iter().zip(&codes))
        .map(|(index, ((name, _), code))| Function {
            name,
            address: index * 100,
            code,
        })
        .collect();
    report(&functions)
}

#[test]
fn inlined_code_passes() {
    let report = report_of(&[
        (AVX2_ENTRY, &[400]),
        (AVX512_ENTRY, &[]),
        (TRAMPOLINE, &[0]),
        ("core::core_arch::x86::xsave::_xgetbv", &[]),
        ("estampe_core::tiles::push", &[]),
        ("core::panicking::panic_bounds_check", &[]),
    ])
    .unwrap();
    assert_eq!(report.entries, 2);
    assert_eq!(report.offences, [""; 0]);
    assert_eq!(report.calls.len(), 1);
    assert!(report.calls[0].starts_with("`estampe_core::tiles::push`, called by"));
}

#[test]
fn a_lane_operation_with_a_symbol_is_an_offence() {
    for operation in [
        KERNEL,
        "core::core_arch::x86::avx512f::_mm512_add_ps",
        "estampe_simd::gather::single::avx2::kernel::__fearless_simd_kernel",
    ] {
        let report = report_of(&[
            (AVX2_ENTRY, &[]),
            (AVX512_ENTRY, &[]),
            (operation, &[]),
            (HELPER, &[200]),
        ])
        .unwrap();
        let (caller, operation) = (shown_name(HELPER), shown_name(operation));
        assert_eq!(
            report.offences,
            [format!(
                "lane operations are not inlined into `{caller}`: {operation}"
            )]
        );
    }
}

#[test]
fn a_baseline_operation_with_a_symbol_is_none() {
    let kernel = "<fearless_simd::generated::sse2::Sse2 as fearless_simd::generated::simd_trait::\
                  Simd>::floor_f32x4::kernel::__fearless_simd_kernel";
    let report = report_of(&[(AVX2_ENTRY, &[]), (AVX512_ENTRY, &[]), (kernel, &[])]).unwrap();
    assert_eq!(report.offences, [""; 0]);
}

#[test]
fn leaving_the_level_is_an_offence() {
    let report = report_of(&[(AVX2_ENTRY, &[200]), (AVX512_ENTRY, &[]), (HELPER, &[])]).unwrap();
    assert_eq!(report.offences.len(), 1);
    assert!(report.offences[0].starts_with(&format!("`{}` leaves its level", shown_name(HELPER))));
}

#[test]
fn entering_a_level_again_is_none() {
    let report = report_of(&[
        (AVX2_ENTRY, &[200]),
        (AVX512_ENTRY, &[]),
        (TRAMPOLINE, &[0]),
    ])
    .unwrap();
    assert_eq!(report.offences, [""; 0]);
}

#[test]
fn a_lane_operation_that_nothing_calls_directly_is_an_offence() {
    let report = report_of(&[(AVX2_ENTRY, &[]), (AVX512_ENTRY, &[]), (KERNEL, &[])]).unwrap();
    assert!(report.offences[0].contains("an unknown function"));
}

#[test]
fn a_binary_without_a_level_is_an_error() {
    let wanted = "::vectorize::vectorize_avx512";
    let error = report_of(&[(AVX2_ENTRY, &[]), (HELPER, &[])]).unwrap_err();
    assert_eq!(error, AssemblyError::NoEntry { wanted });
}

#[test]
fn malformed_files_are_errors() {
    let header = [0x7f, b'E', b'L', b'F', 2, 1];
    for file in [
        &b"MZ"[..],
        &[],
        &header,
        &[&header[..], &[0xff; 200]].concat(),
    ] {
        assert!(matches!(
            check_binary(file),
            Err(AssemblyError::Malformed(_))
        ));
    }
}

/// A function that the next test looks for: a test itself may be inlined into its caller.
#[inline(never)]
fn a_function_of_this_file() -> usize {
    std::hint::black_box(7)
}

/// This test's own binary has a symbol table, and a function of this file is in it.
#[test]
#[cfg(all(target_os = "linux", target_arch = "x86_64"))]
fn the_functions_of_a_real_file_are_found() {
    let file = std::fs::read(std::env::current_exe().unwrap()).unwrap();
    let parsed = object::File::parse(&*file).unwrap();
    let functions = functions_of(&parsed);
    let own = "a_function_of_this_file";
    assert_eq!(a_function_of_this_file(), 7);
    let found = functions
        .iter()
        .find(|function| function.name.contains(own))
        .unwrap();
    assert!(!found.code.is_empty());
    let calls = calls(&functions);
    assert!(
        calls.iter().any(|callees| callees.len() > 2),
        "no calls found in a real file"
    );
}
