//! Machine code of a stage, made when it is first run, and made better when it runs often.

use super::workspaces::with_workspace;
use estampe_ir::interpreter::{Run, Stopped};
use estampe_ir::lanes::Kernel;
use estampe_simd::Level;
use estampe_x86::{Code, Isa, Tier};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU64, Ordering};

/// The packets, or their iterations of loops, after which a stage is worth the time that better
/// code takes to make: that of some thousand packets.
const OFTEN: u64 = 4096;

/// True if there is machine code for a level.
pub(super) fn has_machine_code(level: Level) -> bool {
    Isa::of(level).is_some()
}

/// The code of a stage for each instruction set.
#[derive(Debug, Default)]
pub(super) struct MachineCode {
    of_isa: [OfIsa; Isa::ALL.len()],
}

#[derive(Debug, Default)]
struct OfIsa {
    /// `None` inside: the kernel cannot be compiled.
    fast: OnceLock<Option<Code>>,
    optimised: OnceLock<Option<Code>>,
    /// Packets that the fast code has run, and their jumps backwards, about.
    work: AtomicU64,
}

impl MachineCode {
    /// Runs a kernel by machine code, for work-groups with these ids if there are any; `None` if
    /// there is none for the level.
    pub(super) fn run(
        &self,
        kernel: &Kernel,
        level: Level,
        (run, ids): (&Run<'_>, &[[u32; 3]]),
    ) -> Option<Result<(), Stopped>> {
        let isa = Isa::of(level)?;
        let of_isa = &self.of_isa[isa as usize];
        let code = of_isa.code(kernel, isa)?;
        Some(with_workspace(code, |scratch| {
            let stopped = code.run_workgroups(level, run, ids, scratch);
            of_isa.count(kernel, isa, || {
                let of_run = (run.packets as u64).saturating_add(scratch.jumps(code, run));
                of_run.saturating_mul(ids.len().max(1) as u64)
            });
            stopped
        }))
    }
}

impl OfIsa {
    /// The best code there is.
    fn code(&self, kernel: &Kernel, isa: Isa) -> Option<&Code> {
        if let Some(Some(code)) = self.optimised.get() {
            return Some(code);
        }
        let compile = || Code::compile(kernel, isa, Tier::Fast).ok();
        self.fast.get_or_init(compile).as_ref()
    }

    /// Counts what a run did. The one that makes a stage one that runs often compiles it again,
    /// while others go on with the fast code.
    #[inline]
    fn count(&self, kernel: &Kernel, isa: Isa, work: impl FnOnce() -> u64) {
        if self.work.load(Ordering::Relaxed) >= OFTEN {
            return;
        }
        let work = work();
        let before = self.work.fetch_add(work, Ordering::Relaxed);
        if before < OFTEN && before.saturating_add(work) >= OFTEN {
            let code = Code::compile(kernel, isa, Tier::Optimised).ok();
            // Only one run counts from below to above.
            let _ = self.optimised.set(code);
        }
    }
}
