//! `estampe completions`: a script for each shell.

use crate::support::{estampe, subcommands};
use std::io::{ErrorKind, Write};
use std::process::{Command, Stdio};

const SHELLS: [&str; 5] = ["bash", "zsh", "fish", "powershell", "elvish"];

fn script(shell: &str) -> String {
    let run = estampe(&format!("completions {shell}"), &[]);
    assert_eq!((run.code, run.err.as_str()), (0, ""), "{shell}");
    String::from_utf8(run.out).expect("UTF-8")
}

#[test]
fn the_script_of_each_shell_names_every_subcommand() {
    let subcommands = subcommands("");
    assert!(
        subcommands.contains(&"render".to_owned()),
        "{subcommands:?}"
    );
    for shell in SHELLS {
        let script = script(shell);
        for subcommand in &subcommands {
            let is_named = script
                .split(|c: char| !c.is_alphanumeric() && c != '-')
                .any(|word| word == subcommand);
            assert!(is_named, "{shell} does not name {subcommand}");
        }
        // Options too, no hidden subcommand, and nothing that the output escaped.
        assert!(script.contains("shading"), "{shell}");
        assert!(!script.contains("manual page"), "{shell}");
        assert!(!script.contains("\\u{"), "{shell}");
    }
}

/// Where bash is installed.
#[test]
fn bash_parses_its_script() {
    let bash = Command::new("bash")
        .arg("-n")
        .stdin(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn();
    let mut bash = match bash {
        Ok(bash) => bash,
        Err(error) if error.kind() == ErrorKind::NotFound => return,
        Err(error) => panic!("bash: {error}"),
    };
    let mut input = bash.stdin.take().expect("piped");
    input
        .write_all(script("bash").as_bytes())
        .expect("bash reads its input");
    drop(input);
    let output = bash.wait_with_output().expect("bash ends");
    let messages = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && messages.is_empty(), "{messages}");
}

#[test]
fn the_help_explains_each_shell() {
    let help = String::from_utf8(estampe("completions --help", &[]).out).expect("UTF-8");
    for shell in SHELLS {
        assert!(
            help.contains(&format!("estampe completions {shell}")),
            "{shell}"
        );
    }
}

#[test]
fn an_unknown_shell_is_refused() {
    let run = estampe("completions tcsh", &[]);
    assert_eq!(run.code, 2);
    assert!(run.err.contains("tcsh"), "{}", run.err);
}
