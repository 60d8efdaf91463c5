//! Options of a job as a table: each key is the long name of an option of `estampe render`.
//!
//! Names and values are checked as they are read, so that an error has its line.

use super::look::{JobOptions, first_line};
use clap::{Arg, ArgAction, CommandFactory, Parser, error::ErrorKind};
use serde::Deserialize;
use serde::de::{DeserializeSeed, Deserializer, Error, MapAccess, SeqAccess, Visitor};
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;
use std::fmt;

/// Options of the machine, which the command line has for all jobs.
const OF_THE_COMMAND_LINE: [&str; 6] = ["threads", "simd", "via", "preset", "config", "no-config"];

/// The words of the command line for each option.
#[derive(Debug, Clone, Default)]
pub(crate) struct OptionTable(BTreeMap<String, Vec<String>>);

impl OptionTable {
    /// These options; where the other table has the same one, or one that excludes it, that of the
    /// other.
    pub(crate) fn overridden_by(&self, other: &Self) -> Self {
        let mut command = JobOptions::command();
        command.build();
        let named = |name: &String| {
            let mut all = command.get_arguments();
            all.find(|arg| name_of(arg).as_ref() == Some(name))
        };
        let excludes = |one: &Arg, other: &Arg| {
            let conflicts = command.get_arg_conflicts_with(one);
            conflicts.iter().any(|arg| arg.get_id() == other.get_id())
        };
        let mut options = self.0.clone();
        options.retain(|name, _| {
            let Some(own) = named(name) else {
                return true;
            };
            let mut others = other.0.keys().filter_map(named);
            !others.any(|other| excludes(own, other) || excludes(other, own))
        });
        options.extend(other.0.clone());
        Self(options)
    }

    pub(super) fn words(&self) -> impl Iterator<Item = &String> {
        self.0.values().flatten()
    }

    /// The names of the options with their words.
    pub(crate) fn entries(&self) -> impl Iterator<Item = (&String, &Vec<String>)> {
        self.0.iter()
    }
}

/// The name of an option in a table: its long name, else its letter.
fn name_of(arg: &Arg) -> Option<String> {
    let letter = || arg.get_short().map(String::from);
    arg.get_long().map(str::to_owned).or_else(letter)
}

/// The options, with the name that each has in a table.
fn options() -> Vec<(String, Arg)> {
    let command = JobOptions::command();
    let named = command.get_arguments().filter_map(|arg| {
        let name = name_of(arg)?;
        (!OF_THE_COMMAND_LINE.contains(&name.as_str())).then(|| (name, arg.clone()))
    });
    named.collect()
}

/// The JSON Schema of job files.
pub(crate) fn schema() -> Value {
    let properties = options().into_iter().map(|(name, arg)| {
        let one = json!({ "type": ["string", "number"] });
        let mut property = match arg.get_action() {
            ArgAction::SetTrue => json!({ "type": "boolean" }),
            ArgAction::Append => {
                json!({ "anyOf": [one, { "type": "array", "items": one }] })
            }
            _ => one,
        };
        property["description"] = json!(arg.get_help().map(ToString::to_string));
        (name, property)
    });
    let options = json!({
        "type": "object",
        "properties": properties.collect::<Map<_, _>>(),
        "additionalProperties": false,
    });
    json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "Job file of estampe batch",
        "type": "object",
        "required": ["jobs"],
        "additionalProperties": false,
        "properties": {
            "options": { "$ref": "#/$defs/options", "description": "Options of all jobs" },
            "jobs": { "type": "array", "items": { "$ref": "#/$defs/job" } },
        },
        "$defs": {
            "options": options,
            "job": {
                "type": "object",
                "required": ["input", "output"],
                "additionalProperties": false,
                "properties": {
                    "input": { "type": "string", "description": "The model's path" },
                    "output": { "type": "string", "description": "The template of the picture's name" },
                    "options": { "$ref": "#/$defs/options" },
                },
            },
        },
    })
}

impl<'de> Deserialize<'de> for OptionTable {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_map(TableVisitor)
    }
}

struct TableVisitor;

impl<'de> Visitor<'de> for TableVisitor {
    type Value = OptionTable;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a table of options")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<OptionTable, A::Error> {
        let mut table = OptionTable::default();
        while let Some(OptionName { name, arg }) = map.next_key()? {
            let words = map.next_value_seed(ValueSeed { name: &name, arg })?;
            if table.0.insert(name.clone(), words).is_some() {
                return Err(A::Error::custom(format!("`{name}` is given twice")));
            }
        }
        Ok(table)
    }
}

/// The name of an option that exists.
struct OptionName {
    name: String,
    arg: Arg,
}

impl<'de> Deserialize<'de> for OptionName {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = String::deserialize(deserializer)?;
        let found = options().into_iter().find(|(name, _)| *name == text);
        match found {
            Some((name, arg)) => Ok(Self { name, arg }),
            None if OF_THE_COMMAND_LINE.contains(&text.as_str()) => Err(D::Error::custom(format!(
                "`{text}` is an option of the command line, for all jobs"
            ))),
            None => Err(D::Error::custom(format!(
                "unknown option `{text}`; `estampe schema` lists all"
            ))),
        }
    }
}

/// Reads the value of an option, and checks it.
struct ValueSeed<'n> {
    name: &'n str,
    arg: Arg,
}

impl ValueSeed<'_> {
    fn word<E: Error>(&self, value: impl fmt::Display) -> Result<Vec<String>, E> {
        let word = match self.arg.get_long() {
            Some(name) => format!("--{name}={value}"),
            None => format!("-{}{value}", self.name),
        };
        match (self.arg.get_action(), JobOptions::try_parse_from([&word])) {
            (ArgAction::SetTrue, _) => Err(E::custom(format!(
                "`{}` is true or false, without quotation marks",
                self.name
            ))),
            // Options that need others are checked when all of a job are known.
            (_, Err(error))
                if matches!(
                    error.kind(),
                    ErrorKind::ValueValidation | ErrorKind::InvalidValue
                ) =>
            {
                Err(E::custom(first_line(&error)))
            }
            _ => Ok(vec![word]),
        }
    }
}

impl<'de> DeserializeSeed<'de> for ValueSeed<'_> {
    type Value = Vec<String>;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Vec<String>, D::Error> {
        deserializer.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for ValueSeed<'_> {
    type Value = Vec<String>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "a value of `{}`", self.name)
    }

    fn visit_bool<E: Error>(self, value: bool) -> Result<Vec<String>, E> {
        match self.arg.get_action() {
            ArgAction::SetTrue if value => Ok(vec![format!("--{}", self.name)]),
            ArgAction::SetTrue => Ok(Vec::new()),
            _ => Err(E::custom(format!(
                "`{}` has a value, not true or false",
                self.name
            ))),
        }
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<Vec<String>, E> {
        self.word(value)
    }

    fn visit_u64<E: Error>(self, value: u64) -> Result<Vec<String>, E> {
        self.word(value)
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<Vec<String>, E> {
        self.word(value)
    }

    fn visit_str<E: Error>(self, value: &str) -> Result<Vec<String>, E> {
        self.word(value)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Vec<String>, A::Error> {
        if !matches!(self.arg.get_action(), ArgAction::Append) {
            return Err(A::Error::custom(format!("`{}` has one value", self.name)));
        }
        let mut words = Vec::new();
        while let Some(one) = list.next_element_seed(ValueSeed {
            name: self.name,
            arg: self.arg.clone(),
        })? {
            words.extend(one);
        }
        Ok(words)
    }
}
