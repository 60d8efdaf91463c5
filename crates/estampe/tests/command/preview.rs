//! Pictures in the terminal: the bytes, decoded again.

use crate::support::picture::Picture;
use crate::support::{Folder, Run, machines};
use std::process::Command;

/// Runs `estampe render` in an environment of these variables.
fn render(words: &str, folder: &Folder, variables: &[(&str, &str)]) -> Run {
    let mut command = Command::new(env!("CARGO_BIN_EXE_estampe"));
    command.arg("render").args(words.split_whitespace());
    for name in ["NO_COLOR", "COLORTERM", "TERM", "TMUX", "COLUMNS", "LINES"] {
        command.env_remove(name);
    }
    command.envs(variables.iter().copied());
    let output = command.current_dir(folder.path("")).output();
    output.expect("the command starts").into()
}

fn from_base64(text: &[u8]) -> Vec<u8> {
    let digit = |c: &u8| match c {
        b'A'..=b'Z' => u32::from(c - b'A'),
        b'a'..=b'z' => u32::from(c - b'a') + 26,
        b'0'..=b'9' => u32::from(c - b'0') + 52,
        b'+' => 62,
        b'/' => 63,
        _ => 0,
    };
    let groups = text.chunks(4);
    let bytes = groups.flat_map(|group| {
        let bits = group.iter().fold(0, |bits, c| bits << 6 | digit(c));
        let padding = group.iter().filter(|c| **c == b'=').count();
        bits.to_be_bytes()[1..4 - padding].to_vec()
    });
    bytes.collect()
}

#[test]
fn kitty_shows_the_picture_as_png() {
    let folder = Folder::new();
    let run = render(
        "builtin:teapot --size 200x150 --preview=kitty -q",
        &folder,
        &[],
    );
    assert_eq!((run.code, run.err.as_str()), (0, ""));
    let text = String::from_utf8(run.out).expect("ASCII");
    let pieces = text
        .strip_suffix("\x1b\\\n")
        .expect("an end")
        .split("\x1b\\");
    let pieces: Vec<(&str, &str)> = pieces
        .map(|piece| {
            piece
                .strip_prefix("\x1b_G")
                .and_then(|piece| piece.split_once(';'))
        })
        .map(|piece| piece.expect("keys and data"))
        .collect();
    let (last, others) = pieces.split_last().expect("pieces");
    assert!(others.len() > 1, "{} pieces", pieces.len());
    assert_eq!(others[0].0, "a=T,f=100,q=2,c=25,m=1");
    assert!(others[1..].iter().all(|piece| piece.0 == "m=1") && last.0 == "m=0");
    assert!(others.iter().all(|piece| piece.1.len() == 4096));
    let data: String = pieces.iter().map(|piece| piece.1).collect();
    let shown = from_base64(data.as_bytes());
    let run = render("builtin:teapot --size 200x150 -o t.png -q", &folder, &[]);
    assert_eq!(run.code, 0, "{}", run.err);
    let file = std::fs::read(folder.path("t.png")).expect("written");
    assert!(shown == file);
}

/// The size and the pixels of a sixel picture; those without a colour are `None`.
fn from_sixel(bytes: &[u8]) -> (usize, usize, Vec<Option<[u8; 3]>>) {
    let text = std::str::from_utf8(bytes).expect("ASCII");
    let text = text.strip_prefix("\x1bP0;1;0q\"1;1;").expect("a beginning");
    let text = text.strip_suffix("\x1b\\\n").expect("an end");
    let mut rest = text.as_bytes();
    let numbers = |rest: &mut &[u8]| {
        let mut numbers = vec![0_usize];
        while let Some((&c, after)) = rest.split_first() {
            match c {
                b'0'..=b'9' => {
                    let last = numbers.last_mut().expect("one");
                    *last = *last * 10 + usize::from(c - b'0');
                }
                b';' => numbers.push(0),
                _ => break,
            }
            *rest = after;
        }
        numbers
    };
    let size = numbers(&mut rest);
    let (width, height) = (size[0], size[1]);
    let mut pixels = vec![None; width * height];
    let mut palette = vec![[0; 3]; 256];
    let (mut color, mut x, mut y) = (0, 0, 0);
    while let Some((&c, after)) = rest.split_first() {
        rest = after;
        let mut count = 1;
        let mut sixel = c;
        match c {
            b'#' => {
                let values = numbers(&mut rest);
                color = values[0];
                if let [_, 2, r, g, b] = values[..] {
                    palette[color] =
                        [r, g, b].map(|percent| u8::try_from(percent * 255 / 100).expect("8 bits"));
                }
                continue;
            }
            b'$' => {
                x = 0;
                continue;
            }
            b'-' => {
                (x, y) = (0, y + 6);
                continue;
            }
            b'!' => {
                count = numbers(&mut rest)[0];
                sixel = rest[0];
                rest = &rest[1..];
            }
            _ => {}
        }
        for _ in 0..count {
            for row in 0..6 {
                if (sixel - b'?') >> row & 1 == 1 {
                    pixels[(y + row) * width + x] = Some(palette[color]);
                }
            }
            x += 1;
        }
    }
    (width, height, pixels)
}

#[test]
fn sixels_are_the_picture() {
    let folder = Folder::new();
    let words = "builtin:teapot --size 100x76 --background none -q";
    let run = render(&format!("{words} --preview=sixel -o t.png"), &folder, &[]);
    assert_eq!((run.code, run.err.as_str()), (0, ""));
    let (width, height, pixels) = from_sixel(&run.out);
    assert_eq!((width, height), (100, 76));
    let picture = Picture::open(&folder.path("t.png"));
    let (mut sum, mut count) = (0_u64, 0_u64);
    for (at, pixel) in pixels.iter().enumerate() {
        let [r, g, b, a] = picture.pixel(at % width, at / width);
        assert_eq!(pixel.is_some(), a >= 128, "pixel {at}");
        if let Some(shown) = pixel {
            let channels = shown.iter().zip([r, g, b]);
            sum += channels.map(|(a, b)| u64::from(a.abs_diff(b))).sum::<u64>();
            count += 3;
        }
    }
    assert!(count > 5000 && sum < 3 * count, "{sum} of {count}");
    // Larger pictures are reduced to the terminal: 40 columns of 8 pixels, 10 rows of 16.
    let run = render(
        "builtin:teapot --size 800x600 -q --preview=sixel",
        &folder,
        &[("COLUMNS", "40"), ("LINES", "12")],
    );
    let (width, height, _) = from_sixel(&run.out);
    assert_eq!((width, height), (213, 160));
}

#[test]
fn blocks_have_the_colours_of_the_environment() {
    let folder = Folder::new();
    let show = |variables: &[(&str, &str)]| {
        let words = "builtin:cube --size 80x60 --preview=blocks -q";
        let run = render(words, &folder, variables);
        assert_eq!((run.code, run.err.as_str()), (0, ""));
        String::from_utf8(run.out).expect("UTF-8")
    };
    let all = show(&[("COLORTERM", "truecolor")]);
    // 22 lines of the terminal's 24.
    assert_eq!(all.lines().count(), 22);
    assert!(all.starts_with("\x1b[48;2;242;242;242m "), "{all:?}");
    assert!(show(&[]).starts_with("\x1b[48;5;255m "), "256 colours");
    for without in [("NO_COLOR", "1"), ("TERM", "dumb")] {
        let plain = show(&[without, ("COLORTERM", "truecolor")]);
        assert!(
            plain.bytes().all(|c| b" .:-=+*#%@\n".contains(&c)),
            "{plain}"
        );
        assert!(
            plain.contains('=') && plain.lines().count() == 22,
            "{plain}"
        );
    }
}

#[test]
fn previews_do_not_depend_on_threads_or_simd_level() {
    let folder = Folder::new();
    for kind in ["kitty", "sixel", "blocks"] {
        let mut first = None;
        for machine in machines() {
            let words = format!("builtin:torus --size 90x60 --preview={kind} -q {machine}");
            let run = render(&words, &folder, &[]);
            assert_eq!(run.code, 0, "{}", run.err);
            assert!(*first.get_or_insert(run.out.clone()) == run.out, "{words}");
        }
    }
}

#[test]
fn previews_that_nobody_would_see_are_errors() {
    let folder = Folder::new();
    for (words, problem) in [
        ("--preview", "standard output is none; write a file by -o"),
        ("--preview=blocks -o -", "both write to standard output"),
        ("--preview=blocks -o t.exr", "8 bits a channel"),
        ("--preview=blocks --json", "cannot be used with"),
        (
            "--preview=blocks -o {pass}.png --pass depth",
            "cannot be used with",
        ),
        ("--preview=ascii", "invalid value"),
        ("-q", "--output <OUT>"),
    ] {
        let run = render(&format!("builtin:cube {words}"), &folder, &[]);
        assert_eq!(run.code, 2, "{words}: {}", run.err);
        assert!(run.err.contains(problem), "{words}: {}", run.err);
        assert!(run.out.is_empty() && folder.names().is_empty(), "{words}");
    }
}
