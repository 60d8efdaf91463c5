//! The text of bytecode.

use super::{Code, parsed};

#[test]
fn bytecode_names_registers_and_scalars() {
    let kernel = parsed(
        "kernel fragment
         input varying(0)
         output color(0, 0)
         b0:
           v0 = input 0
           uv1 = const 2.5
           v2 = fadd v0, uv1
           return v2",
    );
    let text = Code::new(&kernel).to_string();
    for line in [
        "chunks of 16 packets\n",
        "registers: 1 of words, 0 of masks\n",
        "= 0x40200000 (2.5)\n",
        "for each chunk:\n   0  Input(r0, 0)\n   1  Binary(FAdd, r0, [r0, s",
        "  Return\n",
    ] {
        assert!(text.contains(line), "{line} in\n{text}");
    }
}
