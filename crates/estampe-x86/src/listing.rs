//! Machine code as text, for people who read it.

use crate::encoder::text::{Note, Text};
use std::fmt::Write;

/// The bytes on a line.
const BYTES: usize = 11;

/// The listing of code of which the first `code_bytes` are instructions.
pub(crate) fn listing(bytes: &[u8], code_bytes: usize, notes: &[Note]) -> String {
    let mut text = String::new();
    let ends = notes.iter().skip(1).map(|note| note.at);
    let ends = ends.chain([code_bytes]);
    for (Note { at, text: note }, end) in notes.iter().zip(ends) {
        // Writing to a string cannot fail.
        let _ = match note {
            Text::Part(name) => writeln!(text, "; {name}"),
            Text::Label(label) => writeln!(text, "L{}:", label.0),
            Text::Instruction(instruction) => {
                let bytes = bytes.get(*at..end).unwrap_or_default();
                let hex: Vec<String> = bytes.iter().map(|byte| format!("{byte:02x}")).collect();
                let hex = hex.join(" ");
                let width = BYTES * 3;
                writeln!(text, "  {at:06x}  {hex:width$} {instruction}")
            }
        };
    }
    let constants = bytes.get(code_bytes.next_multiple_of(64)..);
    let (words, _) = constants.unwrap_or_default().as_chunks::<4>();
    if !words.is_empty() {
        text.push_str("; constants\n");
    }
    for (row, words) in words.chunks(4).enumerate() {
        let hex = words
            .iter()
            .map(|word| format!("{:08x}", u32::from_le_bytes(*word)));
        let hex = hex.collect::<Vec<_>>().join(" ");
        let _ = writeln!(text, "  constants + {:#05x}  {hex}", row * 16);
    }
    text
}
