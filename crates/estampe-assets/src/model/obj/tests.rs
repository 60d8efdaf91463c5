//! Windows and threads change nothing: what is read, warnings, errors and their lines.

use super::reader::{Contents, read_in_windows};
use super::windows::Text;
use crate::model::load::Context;
use crate::model::options::ModelOptions;
use crate::model::resources::NoResources;
use crate::{AssetError, Limits};
use fastrand::Rng;
use std::io::Read;

/// What is compared of a file's contents.
fn shown(contents: &Contents) -> String {
    let Contents {
        positions,
        colors,
        uvs,
        normals,
        parameter_points,
        elements,
        parts,
        libraries,
        material_uses,
    } = contents;
    let names = [&parts.objects, &parts.groups, &parts.materials].map(|names| &names.list);
    format!(
        "{positions:?} {colors:?} {uvs:?} {normals:?} {parameter_points:?} {:?} {:?} {:?} {:?} {:?} {:?} \
         {:?} {names:?} {:?} {libraries:?} {material_uses:?}",
        elements.triangles,
        elements.triangle_uvs,
        elements.triangle_normals,
        elements.smoothing_groups,
        elements.runs,
        elements.lines,
        elements.points,
        parts.list,
    )
}

/// Contents and warnings, or the error.
fn read(text: Text<'_>, size: usize, limits: &Limits) -> String {
    let options = ModelOptions::default();
    let mut context = Context::new("a.obj", &NoResources, &options, limits);
    let read = read_in_windows(text, size, &mut context);
    let read = read.map(|contents| shown(&contents));
    let (warnings, count) = context.warnings.finish();
    match read {
        Ok(contents) => format!("{contents} {count} {warnings:?}"),
        Err(error) => format!("{error} {warnings:?}"),
    }
}

/// A stream that gives few bytes at a time.
struct Dripping<'a>(&'a [u8], usize);

impl Read for Dripping<'_> {
    fn read(&mut self, to: &mut [u8]) -> std::io::Result<usize> {
        let most = self.1.min(to.len());
        self.0.read(&mut to[..most])
    }
}

/// Compares windows of several sizes with one window on one thread.
fn assert_same(bytes: &[u8], limits: &Limits) {
    let with = |threads| Limits {
        threads,
        ..limits.clone()
    };
    let expected = read(Text::Memory(bytes), usize::MAX >> 1, &with(1));
    for size in [1, 7, 64, 1000, 30_000] {
        for threads in [1, 3] {
            let found = read(Text::Memory(bytes), size, &with(threads));
            let at = || format!("{size} {threads} {:?}", String::from_utf8_lossy(bytes));
            assert!(found == expected, "{}", at());
            let mut stream = Dripping(bytes, 1 + size * 2 / 3);
            let found = read(Text::Stream(&mut stream, None), size, &with(threads));
            assert!(found == expected, "a stream {}", at());
        }
    }
}

/// A statement, which may be wrong.
fn statement(random: &mut Rng, vertices: &mut u32) -> String {
    let number = |random: &mut Rng| match random.u8(..12) {
        0 => "nan".to_owned(),
        1 => format!("{:e}", random.f32()),
        2 => format!("{}", random.i32(-99_999_999..99_999_999)),
        3 => "-0".to_owned(),
        4 => "1.5x".to_owned(),
        _ => format!("{:.6}", random.f32() * 20.0 - 10.0),
    };
    let corner = |random: &mut Rng, vertices: u32| {
        let index = match random.u8(..12) {
            0 => -1_i64,
            1 => 0,
            2 => i64::from(vertices) + 2,
            3 => 123_456_789,
            _ => i64::from(random.u32(1..=vertices.max(1))),
        };
        match random.u8(..6) {
            0 => format!("{index}/{index}"),
            1 => format!("{index}//{index}"),
            2 => format!("{index}/{index}/{index}"),
            3 => format!("{index}/"),
            _ => format!("{index}"),
        }
    };
    match random.u8(..20) {
        0..5 => {
            *vertices += 1;
            let count = random.usize(2..8);
            let numbers: Vec<String> = (0..count).map(|_| number(random)).collect();
            format!("v {}", numbers.join([" ", "  ", "\t"][random.usize(..3)]))
        }
        5 => format!("vt {} {}", number(random), number(random)),
        6 => format!(
            "vn {} {} {}",
            number(random),
            number(random),
            number(random)
        ),
        7..12 => {
            let count = random.usize(2..6);
            let corners: Vec<String> = (0..count).map(|_| corner(random, *vertices)).collect();
            let keyword = ["f", "l", "p", "f"][random.usize(..4)];
            format!("{keyword} {}", corners.join(" "))
        }
        12 => format!("o part{}", random.u8(..4)),
        13 => format!("g group {}", random.u8(..3)),
        14 => format!("usemtl m{}", random.u8(..3)),
        15 => format!("s {}", random.u8(..3)),
        16 => "# a comment \\".to_owned(),
        17 => "v 1 2 \\\n 3".to_owned(),
        18 => "unknown words".to_owned(),
        _ => String::new(),
    }
}

/// Plain lines, enough for a run.
fn plain_lines(random: &mut Rng, vertices: &mut u32, end: &str) -> String {
    let mut text = String::new();
    for _ in 0..random.usize(250..700) {
        let line = if *vertices < 4 || random.bool() {
            *vertices += 1;
            format!(
                "v {:.6} {} {:.3}",
                random.f32(),
                random.i8(..),
                random.f32() * 100.0
            )
        } else {
            let mut corner = || random.u32(1..=*vertices);
            format!("f {} {} {}", corner(), corner(), corner())
        };
        text.push_str(&line);
        text.push_str(end);
    }
    text
}

#[test]
fn windows_and_threads_change_nothing() {
    let mut random = Rng::with_seed(11);
    for case in 0..60 {
        let mut text = String::new();
        if case % 7 == 0 {
            text.push('\u{feff}');
        }
        let mut vertices = 0;
        for _ in 0..random.usize(1..60) {
            let end = ["\n", "\r\n", "\n", "\r"][random.usize(..4)];
            if random.u8(..20) == 0 {
                text.push_str(&plain_lines(&mut random, &mut vertices, end));
            } else {
                text.push_str(&statement(&mut random, &mut vertices));
                text.push_str(end);
            }
        }
        if case % 3 == 0 {
            text.push_str("v 7 8 9");
        }
        assert_same(text.as_bytes(), &Limits::default());
    }
}

#[test]
fn errors_name_the_same_lines() {
    let mut text = "v 1 2 3\n".repeat(1000);
    text.push_str(&"f 1 2 3\n".repeat(1000));
    for (max_vertices, max_triangles) in [(999, 9999), (500, 9999), (1000, 700), (1, 1)] {
        let limits = Limits {
            max_vertices,
            max_triangles,
            ..Limits::default()
        };
        assert_same(text.as_bytes(), &limits);
    }
}

#[test]
fn text_without_statements_and_line_ends_is_read_in_windows() {
    let long = [b"# ".as_slice(), &[b'x'; 100_000], b"\nv 1 2 3\n"].concat();
    let continued = "v 1 \\\n".repeat(2000);
    let cases: [&[u8]; 7] = [
        b"",
        b"\n\n\n",
        b"\xef\xbb\xbf",
        b"nothing that is known\n",
        &long,
        continued.as_bytes(),
        &[b'\n'; 5000],
    ];
    for bytes in cases {
        assert_same(bytes, &Limits::default());
    }
}

/// UTF-16 in memory is decoded before it is read.
#[test]
fn streams_of_utf16_are_decoded() {
    let text = "# é\nv 1 2 3\nv 4 5 6\nv 7 8 9\nf 1 2 3\n";
    let expected = read(Text::Memory(text.as_bytes()), 1000, &Limits::default());
    let units = "\u{feff}".encode_utf16().chain(text.encode_utf16());
    let bytes: Vec<u8> = units.flat_map(u16::to_be_bytes).collect();
    for size in [1, 5, 1000] {
        let mut stream = bytes.as_slice();
        let found = read(Text::Stream(&mut stream, None), size, &Limits::default());
        assert!(found == expected, "{size}");
    }
}

#[test]
fn streams_that_are_too_long_or_fail_are_errors() {
    struct Failing;
    impl Read for Failing {
        fn read(&mut self, _: &mut [u8]) -> std::io::Result<usize> {
            Err(std::io::Error::other("the disk is gone"))
        }
    }
    let limits = Limits {
        max_file_bytes: 100,
        ..Limits::default()
    };
    let options = ModelOptions::default();
    let text = "v 1 2 3\n".repeat(50);
    let mut context = Context::new("a.obj", &NoResources, &options, &limits);
    let mut stream = text.as_bytes();
    let read = read_in_windows(Text::Stream(&mut stream, None), 30, &mut context);
    assert!(
        matches!(read, Err(AssetError::LimitExceeded(_))),
        "{read:?}"
    );
    let mut stream = text.as_bytes().chain(Failing);
    let limits = Limits::default();
    let mut context = Context::new("a.obj", &NoResources, &options, &limits);
    let read = read_in_windows(Text::Stream(&mut stream, None), 30, &mut context);
    let Err(AssetError::Io(fault)) = read else {
        panic!("{read:?}")
    };
    assert!(fault.what.contains("the disk is gone"), "{fault}");
}
