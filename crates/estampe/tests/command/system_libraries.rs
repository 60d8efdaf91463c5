//! The command needs no system library but those of every Rust program: the names in the program's
//! dynamic section (System V ABI, "Dynamic Section"), read from the file of the command itself.
#![cfg(all(
    target_os = "linux",
    target_pointer_width = "64",
    target_endian = "little"
))]

use std::fs;

/// Libraries of the C run time, by the start of their names.
const RUN_TIME: &[&str] = &[
    "libc.so",
    "libm.so",
    "libgcc_s.so",
    "libdl.so",
    "librt.so",
    "libpthread.so",
    "ld-linux",
    "ld64.so",
];

fn word<const N: usize>(file: &[u8], at: usize) -> [u8; N] {
    file[at..at + N].try_into().expect("N bytes")
}

fn u16_at(file: &[u8], at: usize) -> usize {
    u16::from_le_bytes(word(file, at)).into()
}

fn u64_at(file: &[u8], at: usize) -> usize {
    usize::try_from(u64::from_le_bytes(word(file, at))).expect("64 bits")
}

/// The names of the libraries that a program needs, from its `DT_NEEDED` entries.
fn needed_libraries(file: &[u8]) -> Vec<String> {
    const LOAD: u32 = 1;
    const DYNAMIC: u32 = 2;
    const NEEDED: usize = 1;
    const STRING_TABLE: usize = 5;
    assert!(
        file.starts_with(b"\x7fELF\x02\x01"),
        "64 bits, little-endian"
    );
    let (start, size, count) = (u64_at(file, 32), u16_at(file, 54), u16_at(file, 56));
    let headers = || (0..count).map(|index| start + index * size);
    let kind = |header: usize| u32::from_le_bytes(word(file, header));
    let offset_of = |address: usize| {
        let mut segments = headers().filter(|&header| kind(header) == LOAD);
        let holds = |&header: &usize| {
            let (first, len) = (u64_at(file, header + 16), u64_at(file, header + 32));
            (first..first + len).contains(&address)
        };
        let segment = segments.find(holds).expect("the address is in the file");
        u64_at(file, segment + 8) + address - u64_at(file, segment + 16)
    };
    let Some(dynamic) = headers().find(|&header| kind(header) == DYNAMIC) else {
        return Vec::new(); // a static program
    };
    let (first, len) = (u64_at(file, dynamic + 8), u64_at(file, dynamic + 32));
    let entries = || {
        (first..first + len)
            .step_by(16)
            .map(|at| (u64_at(file, at), u64_at(file, at + 8)))
    };
    let (_, strings) = entries()
        .find(|&(tag, _)| tag == STRING_TABLE)
        .expect("a dynamic program has a string table");
    let strings = offset_of(strings);
    let names = entries().filter(|&(tag, _)| tag == NEEDED);
    let names = names.map(|(_, at)| {
        let name = file[strings + at..].split(|&byte| byte == 0).next();
        String::from_utf8_lossy(name.expect("a split has a first part")).into_owned()
    });
    names.collect()
}

/// No driver, display or other library; xtask checks that no package compiles C.
///
/// Rows: U4.
#[test]
fn the_command_needs_the_c_run_time_and_nothing_else() {
    let file = fs::read(env!("CARGO_BIN_EXE_estampe")).expect("the command is built");
    let needed = needed_libraries(&file);
    let is_expected = |name: &&String| !RUN_TIME.iter().any(|known| name.starts_with(known));
    let others: Vec<&String> = needed.iter().filter(is_expected).collect();
    assert!(others.is_empty(), "{others:?}");
    let is_musl = cfg!(target_env = "musl");
    assert!(
        is_musl || needed.iter().any(|name| name.starts_with("libc.so")),
        "{needed:?}"
    );
}
