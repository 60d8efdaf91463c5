//! The words of a command line with those of its preset.

use super::PresetArgs;
use super::file::Config;
use crate::failure::Failure;
use clap::{Arg, Command};
use std::collections::HashSet;
use std::ffi::OsString;

/// The words, with those of the preset and of the default table after the command's name. Commands
/// without `--preset` have none.
pub(crate) fn with_presets(
    parser: &Command,
    words: Vec<OsString>,
) -> Result<Vec<OsString>, Failure> {
    let name = words.get(1).and_then(|name| name.to_str());
    let command = name.and_then(|name| parser.find_subcommand(name));
    let Some(command) = command.filter(|command| named(command, "preset").is_some()) else {
        return Ok(words);
    };
    let given = Given::of(&words[2..]);
    // Job files have tables of their own, which are merged with the preset's.
    if given.names.contains("help") || given.names.contains("h") || given.names.contains("job-file")
    {
        return Ok(words);
    }
    let Some(config) = Config::find(&given.presets)? else {
        return Ok(words);
    };
    let table = config.table(given.presets.preset.as_deref())?;
    let mut command = command.clone();
    command.build();
    let on_command_line: Vec<&Arg> = { given.names.iter() }
        .filter_map(|name| named(&command, name))
        .collect();
    let mut all = words[..2].to_vec();
    for (name, of_option) in table.entries() {
        let Some(option) = named(&command, name) else {
            continue;
        };
        let is_replaced = on_command_line.iter().any(|other| {
            let excludes = |one: &Arg, other: &Arg| {
                let conflicts = command.get_arg_conflicts_with(one);
                conflicts
                    .iter()
                    .any(|found| found.get_id() == other.get_id())
            };
            option.get_id() == other.get_id() || excludes(option, other) || excludes(other, option)
        });
        if !is_replaced {
            all.extend(of_option.iter().map(OsString::from));
        }
    }
    all.extend_from_slice(&words[2..]);
    Ok(all)
}

/// The option of this long name, or letter.
fn named<'c>(command: &'c Command, name: &str) -> Option<&'c Arg> {
    command.get_arguments().find(|arg| {
        let is_letter = || name.len() == 1 && arg.get_short() == name.chars().next();
        arg.get_long() == Some(name) || is_letter()
    })
}

/// The options that words give: names without hyphens, and the choice of the preset.
#[derive(Default)]
struct Given {
    names: HashSet<String>,
    presets: PresetArgs,
}

impl Given {
    /// Of the words after the command's name. The parser checks them later: words that are no
    /// options are left alone.
    fn of(words: &[OsString]) -> Self {
        let mut given = Self::default();
        let mut words = words.iter().take_while(|word| *word != "--").peekable();
        while let Some(word) = words.next() {
            let Some(text) = word.to_str() else {
                continue;
            };
            let Some(long) = text.strip_prefix("--") else {
                let letter = text.strip_prefix('-').and_then(|rest| rest.chars().next());
                given.names.extend(letter.map(String::from));
                continue;
            };
            let (name, value) = match long.split_once('=') {
                Some((name, value)) => (name, Some(OsString::from(value))),
                None => (long, None),
            };
            given.names.insert(name.to_owned());
            let mut value = || {
                value
                    .clone()
                    .or_else(|| words.peek().map(|next| (*next).clone()))
            };
            match name {
                "preset" => {
                    let name = value().map(|name| name.to_string_lossy().into_owned());
                    given.presets.preset = name;
                }
                "config" => given.presets.config = value().map(Into::into),
                "no-config" => given.presets.no_config = true,
                _ => {}
            }
        }
        given
    }
}
