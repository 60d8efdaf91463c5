//! Instructions on one of many words in memory, and on registers of 32 bits: lane loops are made of
//! them.

use super::{Assembler, Condition, Gpr, scalar::Width, text};

/// A word in memory: `displacement` bytes and four times `index` after where `base` points.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Element {
    pub(crate) base: Gpr,
    /// Not `rsp`.
    pub(crate) index: Gpr,
    pub(crate) displacement: i32,
}

/// An operation on two words, by the opcode of the form whose destination is in memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Arithmetic {
    Add = 0x01,
    Or = 0x09,
    And = 0x21,
    Sub = 0x29,
    Xor = 0x31,
}

impl Arithmetic {
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Add => "add",
            Self::Or => "or",
            Self::And => "and",
            Self::Sub => "sub",
            Self::Xor => "xor",
        }
    }
}

impl Assembler {
    /// An instruction `opcode element, reg` on 32 bits.
    fn element(&mut self, opcode: &[u8], reg: Gpr, element: Element) {
        self.scaled_element(opcode, reg, (element, 2));
    }

    /// The same, with an index times a power of two.
    fn scaled_element(&mut self, opcode: &[u8], reg: Gpr, (element, scale_log2): (Element, u8)) {
        let Element {
            base,
            index,
            displacement,
        } = element;
        let rex = 0x40 | (reg.0 >> 3) << 2 | (index.0 >> 3) << 1 | base.0 >> 3;
        if rex != 0x40 {
            self.byte(rex);
        }
        self.bytes.extend(opcode);
        self.byte(0b10 << 6 | (reg.0 & 7) << 3 | 0b100);
        self.byte(scale_log2 << 6 | (index.0 & 7) << 3 | base.0 & 7);
        self.dword(displacement.cast_unsigned());
    }

    fn lock(&mut self, is_locked: bool) {
        if is_locked {
            self.byte(0xF0);
        }
    }

    /// `mov to, element`.
    pub(crate) fn load_element(&mut self, to: Gpr, element: Element) {
        self.note(|| text::load_element(to, element));
        self.element(&[0x8B], to, element);
    }

    /// `mov element, from`.
    pub(crate) fn store_element(&mut self, element: Element, from: Gpr) {
        self.note(|| text::of_element("mov", element, from));
        self.element(&[0x89], from, element);
    }

    /// `mov word [base + 2·index + displacement], from`, the low 16 bits.
    pub(crate) fn store_half_element(&mut self, element: Element, from: Gpr) {
        self.note(|| text::store_half_element(element, from));
        self.byte(0x66);
        self.scaled_element(&[0x89], from, (element, 1));
    }

    /// `add element, from` and the like; with a prefix `lock` if other threads use the word.
    pub(crate) fn update_element(
        &mut self,
        kind: Arithmetic,
        is_locked: bool,
        (element, from): (Element, Gpr),
    ) {
        self.note(|| text::locked(kind.name(), is_locked, element, from));
        self.lock(is_locked);
        self.element(&[kind as u8], from, element);
    }

    /// `xadd element, register`: the register is given the word that was there.
    pub(crate) fn exchange_and_add(&mut self, is_locked: bool, element: Element, register: Gpr) {
        self.note(|| text::locked("xadd", is_locked, element, register));
        self.lock(is_locked);
        self.element(&[0x0F, 0xC1], register, element);
    }

    /// `xchg element, register`, which is always as with `lock`.
    pub(crate) fn exchange_element(&mut self, element: Element, register: Gpr) {
        self.note(|| text::of_element("xchg", element, register));
        self.element(&[0x87], register, element);
    }

    /// `add to, from` and the like, 32 bits.
    pub(crate) fn arithmetic(&mut self, kind: Arithmetic, to: Gpr, from: Gpr) {
        self.note(|| text::two(kind.name(), Width::Dword, to, from));
        // The form whose source is the register in ModRM.rm.
        self.registers(Width::Dword, &[kind as u8 | 2], to.0, from);
    }

    /// `cmp a, b`, 32 bits.
    pub(crate) fn cmp(&mut self, a: Gpr, b: Gpr) {
        self.note(|| text::two("cmp", Width::Dword, a, b));
        self.registers(Width::Dword, &[0x3B], a.0, b);
    }

    /// `cmovcc to, from`, 32 bits.
    pub(crate) fn cmov_word(&mut self, condition: Condition, to: Gpr, from: Gpr) {
        self.note(|| text::cmov(condition, Width::Dword, [to, from]));
        let opcode = [0x0F, 0x40 | condition as u8];
        self.registers(Width::Dword, &opcode, to.0, from);
    }

    /// `bsf to, from`, 32 bits: the number of the lowest bit that is set, of which there is one.
    pub(crate) fn lowest_bit(&mut self, to: Gpr, from: Gpr) {
        self.note(|| text::two("bsf", Width::Dword, to, from));
        self.registers(Width::Dword, &[0x0F, 0xBC], to.0, from);
    }
}
