//! The texts of instructions, in the manner of Intel's manual: the destination first.

use super::element::Element;
use super::scalar::Width;
use super::{
    Address, Base, Condition, Gpr, Label, Length, Rm, VectorInstruction, VectorOp, vector_op,
};

/// A text at a place of the code.
#[derive(Debug, Clone)]
pub(crate) struct Note {
    /// The byte before which it stands.
    pub(crate) at: usize,
    pub(crate) text: Text,
}

/// A text of a listing.
#[derive(Debug, Clone)]
pub(crate) enum Text {
    /// The start of a part of the code.
    Part(&'static str),
    /// A place that jumps name.
    Label(Label),
    /// An instruction.
    Instruction(String),
}

fn gpr(register: Gpr, width: Width) -> String {
    const LOW: [&str; 8] = ["ax", "cx", "dx", "bx", "sp", "bp", "si", "di"];
    match (LOW.get(usize::from(register.0)), width) {
        (Some(name), Width::Qword) => format!("r{name}"),
        (Some(name), Width::Dword) => format!("e{name}"),
        (None, Width::Qword) => format!("r{}", register.0),
        (None, Width::Dword) => format!("r{}d", register.0),
    }
}

/// A memory operand; `index` is the kind of its vector of indices.
fn memory(address: Address, index: &str) -> String {
    let base = match address.base {
        Base::Gpr(base) => gpr(base, Width::Qword),
        Base::Pool => "constants".to_owned(),
    };
    let index = address
        .index
        .map_or(String::new(), |number| format!(" + 4*{index}{number}"));
    let displacement = match address.displacement {
        0 => String::new(),
        below @ ..0 => format!(" - {:#x}", below.unsigned_abs()),
        bytes => format!(" + {bytes:#x}"),
    };
    format!("[{base}{index}{displacement}]")
}

fn instruction(text: String) -> Text {
    Text::Instruction(text)
}

pub(super) fn plain(name: &str) -> Text {
    instruction(name.to_owned())
}

pub(super) fn one(name: &str, register: Gpr) -> Text {
    instruction(format!("{name} {}", gpr(register, Width::Qword)))
}

pub(super) fn narrow(name: &str, register: Gpr) -> Text {
    instruction(format!("{name} {}", gpr(register, Width::Dword)))
}

pub(super) fn two(name: &str, width: Width, to: Gpr, from: Gpr) -> Text {
    instruction(format!("{name} {}, {}", gpr(to, width), gpr(from, width)))
}

pub(super) fn immediate_of(name: &str, register: Gpr, immediate: impl Into<u32>) -> Text {
    let register = gpr(register, Width::Dword);
    instruction(format!("{name} {register}, {:#x}", immediate.into()))
}

pub(super) fn load(name: &str, width: Width, to: Gpr, address: Address) -> Text {
    instruction(format!(
        "{name} {}, {}",
        gpr(to, width),
        memory(address, "")
    ))
}

pub(super) fn store(name: &str, width: Width, address: Address, from: Gpr) -> Text {
    instruction(format!(
        "{name} {}, {}",
        memory(address, ""),
        gpr(from, width)
    ))
}

pub(super) fn store_byte(address: Address, from: Gpr) -> Text {
    let from = gpr(from, Width::Dword);
    instruction(format!(
        "mov byte {}, {from} (lowest byte)",
        memory(address, "")
    ))
}

pub(super) fn lea_label(to: Gpr, label: Label) -> Text {
    instruction(format!("lea {}, [L{}]", gpr(to, Width::Qword), label.0))
}

pub(super) fn lea_element(to: Gpr, base: Gpr, index: Gpr) -> Text {
    let [to, base, index] = [to, base, index].map(|one| gpr(one, Width::Qword));
    instruction(format!("lea {to}, [{base} + 4*{index}]"))
}

fn element(of: Element) -> String {
    scaled_element(of, 4)
}

fn scaled_element(of: Element, scale: u8) -> String {
    let [base, index] = [of.base, of.index].map(|one| gpr(one, Width::Qword));
    format!("[{base} + {scale}*{index} + {:#x}]", of.displacement)
}

pub(super) fn store_half_element(to: Element, from: Gpr) -> Text {
    // The disassembly gives registers by their 32-bit names.
    let (to, from) = (scaled_element(to, 2), gpr(from, Width::Dword));
    instruction(format!("mov word {to}, {from}"))
}

pub(super) fn load_element(to: Gpr, from: Element) -> Text {
    instruction(format!("mov {}, {}", gpr(to, Width::Dword), element(from)))
}

pub(super) fn of_element(name: &str, to: Element, from: Gpr) -> Text {
    locked(name, false, to, from)
}

pub(super) fn locked(name: &str, is_locked: bool, to: Element, from: Gpr) -> Text {
    let prefix = if is_locked { "lock " } else { "" };
    let (to, from) = (element(to), gpr(from, Width::Dword));
    instruction(format!("{prefix}{name} {to}, {from}"))
}

pub(super) fn imul(to: Gpr, from: Gpr, immediate: u8) -> Text {
    let [to, from] = [to, from].map(|one| gpr(one, Width::Dword));
    instruction(format!("imul {to}, {from}, {immediate:#x}"))
}

pub(super) fn cmov(condition: Condition, width: Width, [to, from]: [Gpr; 2]) -> Text {
    let [to, from] = [to, from].map(|one| gpr(one, width));
    instruction(format!("cmov{} {to}, {from}", suffix(condition)))
}

pub(super) fn sub_memory(address: Address, immediate: u8) -> Text {
    instruction(format!("sub qword {}, {immediate:#x}", memory(address, "")))
}

pub(super) fn jump_to(address: Address) -> Text {
    instruction(format!("jmp {}", memory(address, "")))
}

pub(super) fn call(address: Address) -> Text {
    instruction(format!("call {}", memory(address, "")))
}

pub(super) fn jump(name: &str, label: Label) -> Text {
    instruction(format!("{name} L{}", label.0))
}

pub(super) fn jump_if(condition: Condition, label: Label) -> Text {
    jump(&format!("j{}", suffix(condition)), label)
}

fn suffix(condition: Condition) -> &'static str {
    match condition {
        Condition::Below => "b",
        Condition::NotBelow => "ae",
        Condition::Zero => "e",
        Condition::NotZero => "ne",
        Condition::Above => "a",
        Condition::Less => "l",
        Condition::Greater => "g",
    }
}

/// The letters of vector registers.
fn vectors(length: Length) -> &'static str {
    match length {
        Length::L128 => "xmm",
        Length::L256 => "ymm",
        Length::L512 => "zmm",
    }
}

pub(super) fn vector(one: &VectorInstruction) -> Text {
    use vector_op as v;
    let VectorInstruction { op, is_evex, .. } = *one;
    let is = |other: &VectorOp| *op == *other;
    let of_vectors = vectors(one.length);
    let is_mask = op.name.starts_with('k');
    let reg = if is(&v::GPR_FROM_MASK) || is(&v::SIGNS) {
        gpr(Gpr(one.reg), Width::Dword)
    } else if is_mask || is_evex && op.name.contains("cmp") {
        format!("k{}", one.reg)
    } else {
        format!("{of_vectors}{}", one.reg)
    };
    let rm = match one.rm {
        Rm::Memory(address) => {
            let place = memory(address, of_vectors);
            let lanes = one.length.bytes() / 4;
            let broadcast = if address.is_broadcast {
                format!("{{1to{lanes}}}")
            } else {
                String::new()
            };
            format!("{place}{broadcast}")
        }
        Rm::Register(number) if is(&v::MASK_FROM_GPR) || is(&v::STORE_LOWEST) => {
            gpr(Gpr(number), Width::Dword)
        }
        Rm::Register(number) if is_mask => format!("k{number}"),
        Rm::Register(number) => format!("{of_vectors}{number}"),
    };
    let vvvv = if is_mask {
        format!("k{}", one.vvvv)
    } else {
        format!("{of_vectors}{}", one.vvvv)
    };
    let mut operands = if op.digit.is_some() {
        vec![vvvv, rm]
    } else if op.has_vvvv() {
        vec![reg, vvvv, rm]
    } else {
        vec![reg, rm]
    };
    let stores = [
        &v::STORE,
        &v::STORE_LOWEST,
        &v::SCATTER,
        &v::MASK_STORE,
        &v::F16_FROM_F32,
        &v::HALVES_FROM_WORDS,
    ];
    if stores.into_iter().any(is) {
        operands.reverse();
    }
    if one.mask != 0 {
        operands[0].push_str(&format!("{{k{}}}", one.mask));
    }
    match one.immediate {
        Some(register) if is(&v::BLEND_BY_SIGN) => {
            operands.push(format!("{of_vectors}{}", register >> 4));
        }
        Some(immediate) => operands.push(format!("{immediate:#x}")),
        None => {}
    }
    if op.rounds_up {
        operands.push("{ru-sae}".to_owned());
    }
    let name = if is_evex { op.evex_name } else { op.name };
    instruction(format!("{name} {}", operands.join(", ")))
}
