//! Instructions on general-purpose registers, jumps and calls.

use super::{Address, Assembler, Base, Label, text};

/// A general-purpose register, by its number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Gpr(pub(crate) u8);

impl Gpr {
    pub(crate) const RAX: Self = Self(0);
    pub(crate) const RBX: Self = Self(3);
    pub(crate) const R12: Self = Self(12);
    pub(crate) const RSI: Self = Self(6);
    pub(crate) const RDI: Self = Self(7);

    fn high(self) -> u8 {
        self.0 >> 3
    }
}

/// What a conditional jump or move asks of the flags.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Condition {
    /// The subtraction borrowed: unsigned less.
    Below = 2,
    /// Unsigned greater or equal.
    NotBelow = 3,
    /// Equal, zero.
    Zero = 4,
    NotZero = 5,
    /// Unsigned greater.
    Above = 7,
    /// Signed less.
    Less = 12,
    /// Signed greater.
    Greater = 15,
}

/// The width of a scalar operation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Width {
    /// 32 bits; the upper half of the register becomes 0.
    Dword,
    /// 64 bits.
    Qword,
}

impl Assembler {
    fn rex(&mut self, width: Width, reg: u8, rm: u8) {
        let w = u8::from(width == Width::Qword);
        let rex = 0x40 | w << 3 | (reg >> 3) << 2 | rm >> 3;
        if rex != 0x40 {
            self.byte(rex);
        }
    }

    /// An instruction `opcode reg, rm` of two registers.
    pub(super) fn registers(&mut self, width: Width, opcode: &[u8], reg: u8, rm: Gpr) {
        self.rex(width, reg, rm.0);
        self.bytes.extend(opcode);
        self.modrm_register(reg, rm.0);
    }

    /// An instruction `opcode reg, [address]`, followed by `trailing` bytes.
    fn memory(
        &mut self,
        width: Width,
        opcode: &[u8],
        reg: u8,
        (address, trailing): (Address, usize),
    ) {
        let base = match address.base {
            Base::Gpr(base) => base.0,
            Base::Pool => 0,
        };
        self.rex(width, reg, base);
        self.bytes.extend(opcode);
        self.modrm_memory(reg, address, 1, trailing);
    }

    /// `push r64`.
    pub(crate) fn push(&mut self, register: Gpr) {
        self.note(|| text::one("push", register));
        self.rex(Width::Dword, 0, register.0);
        self.byte(0x50 | register.0 & 7);
    }

    /// `pop r64`.
    pub(crate) fn pop(&mut self, register: Gpr) {
        self.note(|| text::one("pop", register));
        self.rex(Width::Dword, 0, register.0);
        self.byte(0x58 | register.0 & 7);
    }

    /// `mov to, from`.
    pub(crate) fn mov(&mut self, width: Width, to: Gpr, from: Gpr) {
        self.note(|| text::two("mov", width, to, from));
        self.registers(width, &[0x8B], to.0, from);
    }

    /// `mov r32, immediate`.
    pub(crate) fn mov_immediate(&mut self, to: Gpr, immediate: u32) {
        self.note(|| text::immediate_of("mov", to, immediate));
        if to.high() != 0 {
            self.byte(0x41);
        }
        self.byte(0xB8 | to.0 & 7);
        self.dword(immediate);
    }

    /// `mov to, [address]`.
    pub(crate) fn load(&mut self, width: Width, to: Gpr, address: Address) {
        self.note(|| text::load("mov", width, to, address));
        self.memory(width, &[0x8B], to.0, (address, 0));
    }

    /// `mov [address], from`.
    pub(crate) fn store(&mut self, width: Width, address: Address, from: Gpr) {
        self.note(|| text::store("mov", width, address, from));
        self.memory(width, &[0x89], from.0, (address, 0));
    }

    /// `mov byte [address], from`.
    pub(crate) fn store_byte(&mut self, address: Address, from: Gpr) {
        self.note(|| text::store_byte(address, from));
        // A prefix even where it is empty: without one, numbers 4 to 7 are ah to bh.
        let base = match address.base {
            Base::Gpr(base) => base.high(),
            Base::Pool => 0,
        };
        self.byte(0x40 | from.high() << 2 | base);
        self.byte(0x88);
        self.modrm_memory(from.0, address, 1, 0);
    }

    /// `lea to, [address]`.
    pub(crate) fn lea(&mut self, to: Gpr, address: Address) {
        self.note(|| text::load("lea", Width::Qword, to, address));
        self.memory(Width::Qword, &[0x8D], to.0, (address, 0));
    }

    /// `lea to, [label]`: the address of a place in the code.
    pub(crate) fn lea_label(&mut self, to: Gpr, label: Label) {
        self.note(|| text::lea_label(to, label));
        self.byte(0x48 | to.high() << 2);
        self.byte(0x8D);
        self.modrm_relative(to.0);
        self.distance_to(label);
    }

    /// `lea to, [base + 4·index]`.
    pub(crate) fn lea_element(&mut self, to: Gpr, base: Gpr, index: Gpr) {
        self.note(|| text::lea_element(to, base, index));
        self.byte(0x48 | to.high() << 2 | index.high() << 1 | base.high());
        self.byte(0x8D);
        self.byte(0x44 | (to.0 & 7) << 3);
        self.byte(0b10 << 6 | (index.0 & 7) << 3 | base.0 & 7);
        self.byte(0);
    }

    /// `sbb to, from`, 32 bits.
    pub(crate) fn sbb(&mut self, to: Gpr, from: Gpr) {
        self.note(|| text::two("sbb", Width::Dword, to, from));
        self.registers(Width::Dword, &[0x1B], to.0, from);
    }

    /// `neg register`, 32 bits.
    pub(crate) fn neg(&mut self, register: Gpr) {
        self.note(|| text::narrow("neg", register));
        self.registers(Width::Dword, &[0xF7], 3, register);
    }

    /// `and register, immediate`, 32 bits.
    pub(crate) fn and_immediate(&mut self, register: Gpr, immediate: u32) {
        self.note(|| text::immediate_of("and", register, immediate));
        self.registers(Width::Dword, &[0x81], 4, register);
        self.dword(immediate);
    }

    /// `shr register, count`, 32 bits.
    pub(crate) fn shr(&mut self, register: Gpr, count: u8) {
        self.note(|| text::immediate_of("shr", register, count));
        self.registers(Width::Dword, &[0xC1], 5, register);
        self.byte(count);
    }

    /// `imul to, from, immediate`, 32 bits.
    pub(crate) fn imul(&mut self, to: Gpr, from: Gpr, immediate: u8) {
        self.note(|| text::imul(to, from, immediate));
        self.registers(Width::Dword, &[0x6B], to.0, from);
        self.byte(immediate);
    }

    /// `cmp register, [address]`, 32 bits.
    pub(crate) fn cmp_memory(&mut self, register: Gpr, address: Address) {
        self.note(|| text::load("cmp", Width::Dword, register, address));
        self.memory(Width::Dword, &[0x3B], register.0, (address, 0));
    }

    /// `cmp register, [address]`, 64 bits.
    pub(crate) fn cmp_memory_wide(&mut self, register: Gpr, address: Address) {
        self.note(|| text::load("cmp", Width::Qword, register, address));
        self.memory(Width::Qword, &[0x3B], register.0, (address, 0));
    }

    /// `test register, register`, 32 bits.
    pub(crate) fn test(&mut self, register: Gpr) {
        self.note(|| text::two("test", Width::Dword, register, register));
        self.registers(Width::Dword, &[0x85], register.0, register);
    }

    /// `cmovcc to, from`, 64 bits.
    pub(crate) fn cmov(&mut self, condition: Condition, to: Gpr, from: Gpr) {
        self.note(|| text::cmov(condition, Width::Qword, [to, from]));
        self.registers(Width::Qword, &[0x0F, 0x40 | condition as u8], to.0, from);
    }

    /// `sub qword [address], immediate`.
    pub(crate) fn sub_memory(&mut self, address: Address, immediate: u8) {
        self.note(|| text::sub_memory(address, immediate));
        self.memory(Width::Qword, &[0x83], 5, (address, 1));
        self.byte(immediate);
    }

    /// `call [address]`.
    pub(crate) fn call(&mut self, address: Address) {
        self.note(|| text::call(address));
        self.memory(Width::Dword, &[0xFF], 2, (address, 0));
    }

    /// `jmp [address]`.
    pub(crate) fn jump_to(&mut self, address: Address) {
        self.note(|| text::jump_to(address));
        self.memory(Width::Dword, &[0xFF], 4, (address, 0));
    }

    /// `ret`.
    pub(crate) fn ret(&mut self) {
        self.note(|| text::plain("ret"));
        self.byte(0xC3);
    }

    /// `jmp label`.
    pub(crate) fn jump(&mut self, label: Label) {
        self.note(|| text::jump("jmp", label));
        self.byte(0xE9);
        self.distance_to(label);
    }

    /// `jcc label`.
    pub(crate) fn jump_if(&mut self, condition: Condition, label: Label) {
        self.note(|| text::jump_if(condition, label));
        self.byte(0x0F);
        self.byte(0x80 | condition as u8);
        self.distance_to(label);
    }

    /// `vzeroupper`.
    pub(crate) fn vzeroupper(&mut self) {
        self.note(|| text::plain("vzeroupper"));
        self.bytes.extend([0xC5, 0xF8, 0x77]);
    }
}
