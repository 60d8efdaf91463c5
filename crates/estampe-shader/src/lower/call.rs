//! Calls: functions are inlined, and their variables become slots or arrays.

use super::flow::Exit;
use super::pointer::{Base, Pointer};
use super::summary::{Root, Summary};
use super::types::{kinds, scalars_of};
use super::{Frame, LowerError, Lowered, Lowering, MAX_CALLS, Operand};
use estampe_ir::interface::LocalArray;
use estampe_ir::tree::Label;
use estampe_ir::{Type, Value};
use naga::Handle;
use std::collections::HashMap;

/// What functions do with a variable.
#[derive(Debug, Clone, Copy)]
pub(super) struct Uses {
    /// It is indexed by a number that is computed.
    pub(super) is_indexed: bool,
    /// It is stored to, after its initial value.
    pub(super) is_stored: bool,
}

impl<'a> Lowering<'a> {
    /// Inlines a function. Returns the scalars that it returns.
    pub(super) fn inline(
        &mut self,
        function: &'a naga::Function,
        info: &'a naga::valid::FunctionInfo,
        arguments: Vec<Operand>,
    ) -> Lowered<Vec<Value>> {
        self.calls += 1;
        if self.calls > MAX_CALLS {
            return Err(LowerError::TooLarge);
        }
        let result = function.result.as_ref();
        let types = result.map_or(Ok(Vec::new()), |result| kinds(self.module, result.ty))?;
        let summary = self.summaries.of(function, &function.body);
        let mut frame = Frame {
            function,
            info,
            arguments,
            locals: HashMap::new(),
            done: HashMap::new(),
            leave: Exit {
                label: Label(u32::MAX),
                slots: Vec::new(),
            },
            breaks: Vec::new(),
            continues: Vec::new(),
        };
        let changed = self.changed(&frame, &summary, false)?;
        frame.leave = self.begin(changed, &types);
        self.declare(&mut frame, &summary)?;
        self.block(&mut frame, &function.body)?;
        let leave = frame.leave.clone();
        if !self.builder.has_ended() {
            let nothing = self.zeros(&types);
            self.leave(&leave, &nothing);
        }
        self.calls -= 1;
        Ok(self.end(&leave))
    }

    /// Makes the variables of a function.
    fn declare(&mut self, frame: &mut Frame<'a>, summary: &Summary) -> Lowered<()> {
        for (handle, local) in frame.function.local_variables.iter() {
            let initial = match local.init {
                Some(init) => self.values(frame, init)?,
                None => {
                    let types = kinds(self.module, local.ty)?;
                    self.zeros(&types)
                }
            };
            let root = Root::Local(handle);
            let uses = Uses {
                is_indexed: summary.indexed.contains(&root),
                is_stored: summary.stored.contains(&root),
            };
            let pointer = self.variable(local.ty, &initial, uses)?;
            frame.locals.insert(handle, pointer);
        }
        Ok(())
    }

    /// Memory of the invocation: slots, or if it is indexed by computed numbers an array, of
    /// constants if nothing is stored to it.
    pub(super) fn variable(
        &mut self,
        ty: Handle<naga::Type>,
        initial: &[Value],
        uses: Uses,
    ) -> Lowered<Pointer> {
        let inner = self.module.types[ty].inner.clone();
        if !uses.is_indexed {
            let base = Base::Slots(self.slots.len());
            self.slots.extend(initial);
            return Ok(Pointer { base, inner });
        }
        if let (false, Some(base)) = (uses.is_stored, self.table(initial)) {
            return Ok(Pointer { base, inner });
        }
        let words = u32::try_from(scalars_of(self.module, ty)?.len()).unwrap_or(u32::MAX);
        let base = self.array(words);
        let pointer = Pointer { base, inner };
        self.store(&pointer, initial)?;
        Ok(pointer)
    }

    /// An array of constants, to which nothing is stored, if these are words that are known.
    pub(super) fn table(&mut self, values: &[Value]) -> Option<Base> {
        let words = values.iter().map(|value| self.builder.constant_of(*value));
        let init: Vec<u32> = words.collect::<Option<_>>()?;
        let known = self.tables.get(&init).copied();
        let array = known.unwrap_or_else(|| {
            let array = self.local_array(LocalArray {
                words: u32::try_from(init.len()).unwrap_or(u32::MAX).max(1),
                init: init.clone(),
            });
            self.tables.insert(init, array);
            array
        });
        let word = self.builder.word(0);
        Some(Base::Local { array, word })
    }

    /// A new array of the invocation.
    pub(super) fn array(&mut self, words: u32) -> Base {
        let array = self.local_array(LocalArray {
            words: words.max(1),
            init: Vec::new(),
        });
        let word = self.builder.word(0);
        Base::Local { array, word }
    }

    fn local_array(&mut self, array: LocalArray) -> u32 {
        let locals = &mut self.builder.interface_mut().locals;
        locals.push(array);
        u32::try_from(locals.len() - 1).expect("fewer than 2^32 arrays")
    }

    pub(super) fn zeros(&mut self, types: &[Type]) -> Vec<Value> {
        let zero = |kind: &Type| match kind {
            Type::Word => self.builder.word(0),
            Type::Mask => self.builder.mask(false),
        };
        types.iter().map(zero).collect()
    }
}
