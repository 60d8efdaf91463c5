//! Copies, clears, mip levels, blits and passes in any order: the bytes of every texture and buffer
//! are those of the oracle.

use estampe_tests::transfers;
use estampe_tests::transfers::reached::Reached;
use estampe_tests::transfers::roles::{FormatClass, Newest, Role};
use estampe_types::TextureFormat;

/// Rows: F2, O8, D1, U3.
#[test]
fn random_sequences_give_the_oracles_bytes() {
    let reached = transfers::check("transfers", 1500);
    eprintln!("{}", reached.described());
    // One seed alone does not reach everything.
    if std::env::var("ESTAMPE_TEST_SEED").is_err() {
        assert_reached(&reached);
    }
}

/// Asserts that the sequences had every role with every place of the newest texels, every role with
/// every class of formats that can have it, and every format and number of samples.
fn assert_reached(reached: &Reached) {
    for newest in Newest::ALL {
        for role in Role::ALL {
            let count = reached.roles.get(&(newest, role)).copied();
            assert!(count >= Some(2), "{newest:?} texels {role:?}: {count:?}");
        }
    }
    for &format in TextureFormat::ALL {
        let name = format.name();
        assert!(reached.formats.contains(name), "no operation on {name}");
        let class = FormatClass::of(format);
        for role in Role::ALL
            .into_iter()
            .filter(|role| is_possible(*role, format))
        {
            let count = reached.classes.get(&(role, class)).copied();
            assert!(count >= Some(2), "{class:?} {role:?} ({name}): {count:?}");
        }
    }
    assert!(reached.samples.iter().eq(&[1, 2, 4, 8, 16]));
    assert!(reached.refused > 1000 && reached.buffers > 500);
}

/// Returns true if images of the format can have the role.
fn is_possible(role: Role, format: TextureFormat) -> bool {
    let is_number = format.is_color() && format.sample_type() == estampe::SampleType::Float;
    match role {
        Role::Read | Role::CopiedFrom | Role::CopiedInto | Role::Cleared | Role::Held => true,
        Role::MipSource | Role::MipMade => is_number && !format.is_compressed(),
        Role::BlittedFrom => is_number,
        Role::Loaded | Role::ClearedByPass | Role::ResolvedInto => {
            format.is_renderable() || !format.is_color()
        }
        Role::ReadOnly => !format.is_color(),
        Role::Sampled => is_number || format.has_depth(),
        Role::Compared => format.has_depth(),
        Role::Stored => format.is_renderable() && !format.is_srgb(),
    }
}
