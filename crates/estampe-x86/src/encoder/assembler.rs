//! Bytes of machine code, labels, and the pool of constants behind the code.

use super::text::{Note, Text};
use std::collections::HashMap;

/// A place in the code, known or not yet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Label(pub(crate) u32);

/// Four bytes that say how far away something is, to be set at the end.
#[derive(Debug, Clone, Copy)]
struct Fixup {
    /// The position of the four bytes.
    at: usize,
    /// The end of the instruction, from which distances count.
    end: usize,
    target: Target,
}

#[derive(Debug, Clone, Copy)]
enum Target {
    Label(Label),
    /// A byte of the pool.
    Pool(u32),
}

/// The pool starts at a multiple of a cache line.
const POOL_ALIGNMENT: usize = 64;

/// Machine code that grows.
#[derive(Debug, Default)]
pub(crate) struct Assembler {
    pub(super) bytes: Vec<u8>,
    labels: Vec<Option<usize>>,
    fixups: Vec<Fixup>,
    pool: Vec<u32>,
    splats: HashMap<(u32, u32), u32>,
    lanes: HashMap<Vec<u32>, u32>,
    /// The texts of a listing, if one is made.
    notes: Option<Vec<Note>>,
}

impl Assembler {
    /// An assembler that keeps the text of each instruction.
    pub(crate) fn with_notes() -> Self {
        Self {
            notes: Some(Vec::new()),
            ..Self::default()
        }
    }

    /// Keeps the text of what comes next, if a listing is made.
    pub(crate) fn note(&mut self, text: impl FnOnce() -> Text) {
        let at = self.bytes.len();
        if let Some(notes) = &mut self.notes {
            notes.push(Note { at, text: text() });
        }
    }

    /// The number of bytes so far.
    pub(crate) fn len(&self) -> usize {
        self.bytes.len()
    }

    pub(super) fn byte(&mut self, byte: u8) {
        self.bytes.push(byte);
    }

    pub(super) fn dword(&mut self, word: u32) {
        self.bytes.extend(word.to_le_bytes());
    }

    /// A label whose place is not known yet.
    pub(crate) fn new_label(&mut self) -> Label {
        self.labels.push(None);
        Label(u32::try_from(self.labels.len() - 1).expect("fewer labels than bytes"))
    }

    /// Says that a label is here.
    pub(crate) fn bind(&mut self, label: Label) {
        self.note(|| Text::Label(label));
        self.labels[label.0 as usize] = Some(self.bytes.len());
    }

    /// Four bytes: the distance from the end of the instruction, which is these bytes' end, to a
    /// label.
    pub(super) fn distance_to(&mut self, label: Label) {
        self.fixup(Target::Label(label), 0);
    }

    /// Four bytes: the distance from the end of the instruction, which comes `trailing` bytes after
    /// these, to a byte of the pool.
    pub(super) fn distance_to_pool(&mut self, offset: u32, trailing: usize) {
        self.fixup(Target::Pool(offset), trailing);
    }

    fn fixup(&mut self, target: Target, trailing: usize) {
        let at = self.bytes.len();
        let end = at + 4 + trailing;
        self.fixups.push(Fixup { at, end, target });
        self.dword(0);
    }

    /// The place in the pool of so many copies of a word, in bytes.
    pub(crate) fn pool_splat(&mut self, word: u32, copies: u32) -> u32 {
        let pool = &mut self.pool;
        *self.splats.entry((word, copies)).or_insert_with(|| {
            let at = pool.len();
            pool.extend((0..copies).map(|_| word));
            u32::try_from(at * 4).expect("a small pool")
        })
    }

    /// The place in the pool of the words of a register's lanes, in bytes.
    pub(crate) fn pool_lanes(&mut self, words: &[u32]) -> u32 {
        if let Some(&at) = self.lanes.get(words) {
            return at;
        }
        let at = self.pool_words(words);
        self.lanes.insert(words.to_vec(), at);
        at
    }

    /// The place in the pool of these words, which are added, in bytes.
    pub(crate) fn pool_words(&mut self, words: &[u32]) -> u32 {
        let at = self.pool.len();
        self.pool.extend(words);
        u32::try_from(at * 4).expect("a small pool")
    }

    /// The code, with the pool behind it.
    pub(crate) fn finish(mut self) -> Finished {
        let code_bytes = self.bytes.len();
        let pool = code_bytes.next_multiple_of(POOL_ALIGNMENT);
        for Fixup { at, end, target } in self.fixups {
            let to = match target {
                Target::Label(label) => self.labels[label.0 as usize].unwrap_or(end),
                Target::Pool(offset) => pool + offset as usize,
            };
            let distance = i64::try_from(to).unwrap_or(0) - i64::try_from(end).unwrap_or(0);
            let distance = i32::try_from(distance).expect("code is limited to far less than 2 GiB");
            self.bytes[at..at + 4].copy_from_slice(&distance.to_le_bytes());
        }
        self.bytes.resize(pool, 0xCC);
        self.bytes
            .extend(self.pool.iter().flat_map(|word| word.to_le_bytes()));
        Finished {
            bytes: self.bytes,
            code_bytes,
            notes: self.notes.unwrap_or_default(),
        }
    }
}

/// Code and its constants.
#[derive(Debug)]
pub(crate) struct Finished {
    /// Instructions, then constants.
    pub(crate) bytes: Vec<u8>,
    /// The number of bytes that are instructions.
    pub(crate) code_bytes: usize,
    /// The texts of a listing, in the order of the bytes.
    pub(crate) notes: Vec<Note>,
}
