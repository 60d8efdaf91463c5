//! Every operation runs, with the same bytes at every SIMD level.

use super::kernel::Size;
use super::table::{Row, markdown, to_json};
use super::*;
use clap::Parser;
use std::collections::HashSet;

#[derive(Debug, Parser)]
struct Line {
    #[command(flatten)]
    arguments: OperationsArguments,
}

fn parsed(line: &str) -> OperationsArguments {
    Line::try_parse_from(line.split(' ')).unwrap().arguments
}

#[test]
fn operations_are_chosen_by_name_or_group() {
    let all = parsed("operations");
    assert_eq!(all.operations().unwrap(), Operation::all());
    assert!(all.is_complete() && !parsed("operations --quick").is_complete());
    let some = parsed("operations --operations sqrt,subgroups");
    let names = some.operations().unwrap();
    let names: Vec<_> = names.iter().map(|one| one.name).collect();
    assert_eq!(names[0], "sqrt");
    assert_eq!(names.len(), 5);
    let unknown = parsed("operations --operations sqare").operations();
    let message = unknown.unwrap_err().to_string();
    assert!(
        message.contains("'sqare'") && message.contains("countOneBits"),
        "{message}"
    );
    assert!(parsed("operations --simd mmx").levels().is_err());
}

#[test]
fn names_are_unique() {
    let all = Operation::all();
    let names: HashSet<&str> = all.iter().map(|one| one.name).collect();
    assert_eq!(names.len(), all.len());
    assert!(all.len() > 120, "{} operations", all.len());
}

/// Rows: U3.
#[test]
fn every_operation_gives_the_same_bytes_at_every_level() {
    let operations = Operation::all();
    let mut expected: Vec<Vec<u8>> = Vec::new();
    let mut changed = 0;
    for level in Level::all_available() {
        let device = Device::new(&DeviceDescriptor {
            threads: 1,
            level,
            ..DeviceDescriptor::default()
        })
        .unwrap();
        for (index, operation) in operations.iter().enumerate() {
            let kernel = Kernel::new(&device, operation, Size::TESTED).unwrap();
            let before = kernel.words();
            kernel.dispatch().unwrap();
            let words = kernel.words();
            changed += usize::from(words != before);
            if expected.len() == index {
                expected.push(words);
                continue;
            }
            let place = format!("{} at {}", operation.name, level.name());
            assert!(words == expected[index], "{place}");
        }
    }
    assert_eq!(changed, operations.len() * Level::all_available().len());
}

#[test]
fn the_table_has_a_column_for_each_level() {
    let operations = parsed("operations --operations sqrt,branch")
        .operations()
        .unwrap();
    let row = |operation, level, ns| Row {
        operation,
        level,
        ns,
    };
    let rows = [
        row("sqrt", "avx2", 6.789),
        row("sqrt", "avx512", 5.0),
        row("branch", "avx512", 123.4),
    ];
    let expected = "\
| operation | avx2 | avx512 |
|---|--:|--:|
| **floats** | | |
| sqrt | 6.79 | 5.00 |
| **control-flow** | | |
| branch |  | 123 |
";
    assert_eq!(markdown(&operations, &["avx2", "avx512"], &rows), expected);
    let value: serde_json::Value = serde_json::from_str(&to_json(&rows[..1])).unwrap();
    let expected = serde_json::json!([{"operation": "sqrt", "level": "avx2", "ns": 6.789}]);
    assert_eq!(value, expected);
}
