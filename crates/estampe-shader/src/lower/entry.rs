//! Inputs and outputs of an entry point.

use super::call::Uses;
use super::half::is_half;
use super::pointer::{Base, InWord, Pointer};
use super::types::{is_wide, kinds, scalars_of};
use super::{LowerError, Lowered, Lowering, Operand};
use crate::program::VaryingSlot;
use estampe_ir::Value;
use estampe_ir::interface::{BufferSlot, Input, Output, Stage};
use estampe_ir::op::Binary;
use estampe_types::SampleType;
use estampe_types::shader::{Interpolation, Sampling};
use naga::{
    AddressSpace, Binding, BuiltIn, EntryPoint, Handle, Module, ScalarKind, StorageAccess,
    TypeInner,
};

/// The largest location, far more than any limit of a device.
const MAX_LOCATION: u32 = 255;

impl<'a> Lowering<'a> {
    pub(super) fn entry_point(
        &mut self,
        point: &'a EntryPoint,
        info: &'a naga::valid::FunctionInfo,
    ) -> Lowered<()> {
        let cover = self.builder.input(Input::Cover);
        self.cover = self.slots.len();
        self.slots.push(cover);
        self.global_variables(info)?;
        let mut arguments = Vec::new();
        for argument in &point.function.arguments {
            let mut values = Vec::new();
            self.inputs(argument.ty, argument.binding.as_ref(), &mut values)?;
            arguments.push(Operand::Scalars(values));
        }
        let results = self.inline(&point.function, info, arguments)?;
        if let Some(result) = &point.function.result {
            let mut results = results.into_iter();
            self.outputs(result.ty, result.binding.as_ref(), &mut results)?;
        }
        if self.builder.stage() == Stage::Fragment {
            self.fill_colors();
            self.outputs.push((Output::Cover, self.slots[self.cover]));
        }
        Ok(())
    }

    /// Colours of fewer than four components have zeros and an alpha of 1 for the others, as
    /// numbers of their type.
    fn fill_colors(&mut self) {
        let colors = self.outputs.iter().filter_map(|(output, _)| match output {
            Output::Color { target, .. } => Some(*target),
            _ => None,
        });
        let targets: std::collections::BTreeSet<u32> = colors.collect();
        for target in targets {
            for component in 0..4 {
                let output = Output::Color { target, component };
                if self.outputs.iter().all(|(one, _)| *one != output) {
                    let is_float = self.color_types[target as usize] == Some(SampleType::Float);
                    let value = match (component, is_float) {
                        (3, true) => self.builder.float(1.0),
                        (3, false) => self.builder.word(1),
                        _ => self.builder.word(0),
                    };
                    self.outputs.push((output, value));
                }
            }
        }
    }

    /// Makes the global variables that the entry point uses.
    fn global_variables(&mut self, info: &naga::valid::FunctionInfo) -> Lowered<()> {
        for (handle, global) in self.module.global_variables.iter() {
            if info[handle].is_empty() {
                continue;
            }
            let inner = self.module.types[global.ty].inner.clone();
            let operand = match global.space {
                AddressSpace::Handle => Operand::Resource(handle),
                AddressSpace::Private => {
                    let initial = match global.init {
                        Some(init) => self.constant(init)?,
                        None => {
                            let types = kinds(self.module, global.ty)?;
                            self.zeros(&types)
                        }
                    };
                    let uses = Uses {
                        is_indexed: self.summaries.is_indexed(handle),
                        is_stored: self.summaries.is_stored(handle),
                    };
                    Operand::Pointer(self.variable(global.ty, &initial, uses)?)
                }
                AddressSpace::WorkGroup => {
                    let words = scalars_of(self.module, global.ty)?.len();
                    let words = u32::try_from(words).unwrap_or(u32::MAX);
                    let first = self.builder.interface().workgroup_words;
                    self.builder.interface_mut().workgroup_words = first.saturating_add(words);
                    let base = Base::Workgroup(self.builder.word(first));
                    Operand::Pointer(Pointer { base, inner })
                }
                AddressSpace::Uniform => self.buffer(handle, false, inner)?,
                AddressSpace::Storage { access } => {
                    self.buffer(handle, access.contains(StorageAccess::STORE), inner)?
                }
                AddressSpace::Immediate => {
                    let base = Base::Immediates(self.builder.word(0));
                    Operand::Pointer(Pointer { base, inner })
                }
                _ => return Err(LowerError::Unsupported("variables of this address space")),
            };
            self.globals.insert(handle, operand);
        }
        Ok(())
    }

    fn buffer(
        &mut self,
        handle: Handle<naga::GlobalVariable>,
        is_written: bool,
        inner: TypeInner,
    ) -> Lowered<Operand> {
        let binding = self.module.global_variables[handle].binding;
        let binding = binding.ok_or(LowerError::Unsupported("buffers without a binding"))?;
        let buffers = &mut self.builder.interface_mut().buffers;
        buffers.push(BufferSlot {
            group: binding.group,
            binding: binding.binding,
            is_written,
        });
        let buffer = u32::try_from(buffers.len() - 1).expect("few buffers");
        let byte = self.builder.word(0);
        let base = Base::Buffer {
            buffer,
            byte,
            place: InWord::After(0),
        };
        Ok(Operand::Pointer(Pointer { base, inner }))
    }

    fn inputs(
        &mut self,
        ty: Handle<naga::Type>,
        binding: Option<&Binding>,
        values: &mut Vec<Value>,
    ) -> Lowered<()> {
        let module = self.module;
        match binding {
            None => {
                let TypeInner::Struct { members, .. } = &module.types[ty].inner else {
                    return Err(LowerError::Unsupported("inputs without a binding"));
                };
                for member in members {
                    self.inputs(member.ty, member.binding.as_ref(), values)?;
                }
            }
            Some(Binding::BuiltIn(built_in)) => values.extend(self.built_in(*built_in)?),
            Some(Binding::Location { location, .. }) => {
                check_location(*location)?;
                let scalars = scalars_of(module, ty)?;
                let count = components(module, ty)?;
                let is_vertex = self.builder.stage() == Stage::Vertex;
                let first = if is_vertex {
                    0
                } else {
                    self.varying(*location, count, binding)
                };
                for (component, scalar) in (0..).zip(scalars) {
                    let input = if is_vertex {
                        Input::Attribute {
                            location: *location,
                            component,
                        }
                    } else {
                        Input::Varying(first + component)
                    };
                    let value = vec![self.builder.input(input)];
                    // Attributes and interpolated numbers are binary32.
                    values.extend(if is_half(scalar) {
                        self.rounded_to_half(value)
                    } else {
                        value
                    });
                }
            }
        }
        Ok(())
    }

    /// Adds a varying. Returns its first scalar.
    fn varying(&mut self, location: u32, components: u32, binding: Option<&Binding>) -> u32 {
        let first = self.varyings.iter().map(|slot| slot.components).sum();
        let (interpolation, sampling) = match binding {
            Some(Binding::Location {
                interpolation,
                sampling,
                ..
            }) => (*interpolation, *sampling),
            _ => (None, None),
        };
        self.varyings.push(VaryingSlot {
            location,
            components,
            first,
            interpolation: match interpolation {
                Some(naga::Interpolation::Flat) => Interpolation::Flat,
                Some(naga::Interpolation::Linear) => Interpolation::NoPerspective,
                _ => Interpolation::Smooth,
            },
            sampling: match sampling {
                Some(naga::Sampling::Centroid) => Sampling::Centroid,
                Some(naga::Sampling::Sample) => Sampling::Sample,
                _ => Sampling::Center,
            },
        });
        first
    }

    fn built_in(&mut self, built_in: BuiltIn) -> Lowered<Vec<Value>> {
        Ok(match built_in {
            BuiltIn::LocalInvocationId => self.three(Input::LocalInvocationId),
            BuiltIn::WorkGroupId => self.three(Input::WorkgroupId),
            BuiltIn::NumWorkGroups => self.three(Input::NumWorkgroups),
            BuiltIn::GlobalInvocationId => {
                let groups = self.three(Input::WorkgroupId);
                let locals = self.three(Input::LocalInvocationId);
                let sizes = self.builder.interface().workgroup_size;
                let axis = |at: usize| {
                    let size = self.builder.word(sizes[at]);
                    let first = self.builder.binary(Binary::Mul, groups[at], size);
                    self.builder.binary(Binary::Add, first, locals[at])
                };
                [0, 1, 2].map(axis).to_vec()
            }
            BuiltIn::Position { .. } => {
                let part = |part| self.builder.input(Input::Position(part));
                [0, 1, 2, 3].map(part).to_vec()
            }
            BuiltIn::VertexIndex => vec![self.builder.input(Input::VertexIndex)],
            BuiltIn::InstanceIndex => vec![self.builder.input(Input::InstanceIndex)],
            BuiltIn::FrontFacing => vec![self.builder.input(Input::FrontFacing)],
            BuiltIn::SampleIndex => vec![self.builder.input(Input::SampleIndex)],
            BuiltIn::SampleMask => vec![self.builder.input(Input::SampleMask)],
            BuiltIn::LocalInvocationIndex => vec![self.builder.input(Input::LocalInvocationIndex)],
            _ => vec![self.subgroup_input(built_in)?],
        })
    }

    fn three(&mut self, input: fn(u32) -> Input) -> Vec<Value> {
        let axis = |axis| self.builder.input(input(axis));
        [0, 1, 2].map(axis).to_vec()
    }

    fn outputs(
        &mut self,
        ty: Handle<naga::Type>,
        binding: Option<&Binding>,
        values: &mut std::vec::IntoIter<Value>,
    ) -> Lowered<()> {
        let module = self.module;
        match binding {
            None => {
                let TypeInner::Struct { members, .. } = &module.types[ty].inner else {
                    return Err(LowerError::Unsupported("outputs without a binding"));
                };
                for member in members {
                    self.outputs(member.ty, member.binding.as_ref(), values)?;
                }
            }
            Some(Binding::BuiltIn(built_in)) => {
                for part in 0..components(module, ty)? {
                    let output = match built_in {
                        BuiltIn::Position { .. } => Output::Position(part),
                        BuiltIn::PointSize => Output::PointSize,
                        BuiltIn::ClipDistances => Output::ClipDistance(part),
                        BuiltIn::FragDepth => Output::Depth,
                        BuiltIn::SampleMask => Output::SampleMask,
                        _ => return Err(LowerError::Unsupported("built-in outputs of this kind")),
                    };
                    self.outputs
                        .extend(values.next().map(|value| (output, value)));
                }
            }
            Some(Binding::Location {
                location,
                blend_src,
                ..
            }) => {
                check_location(*location)?;
                let count = components(module, ty)?;
                let is_vertex = self.builder.stage() == Stage::Vertex;
                let first = if is_vertex {
                    self.varying(*location, count, binding)
                } else {
                    self.color_type(*location, ty);
                    0
                };
                for component in 0..count {
                    let output = match (is_vertex, blend_src) {
                        (true, _) => Output::Varying(first + component),
                        (false, Some(1)) => Output::SecondColor(component),
                        (false, _) => Output::Color {
                            target: *location,
                            component,
                        },
                    };
                    self.outputs
                        .extend(values.next().map(|value| (output, value)));
                }
            }
        }
        Ok(())
    }

    /// Notes the type of the numbers of a colour.
    fn color_type(&mut self, location: u32, ty: Handle<naga::Type>) {
        let kind = match self.module.types[ty].inner.scalar_kind() {
            Some(ScalarKind::Uint) => SampleType::Uint,
            Some(ScalarKind::Sint) => SampleType::Sint,
            _ => SampleType::Float,
        };
        let at = location as usize;
        if self.color_types.len() <= at {
            self.color_types.resize(at + 1, None);
        }
        self.color_types[at] = Some(kind);
    }
}

/// Refuses large locations: lists by location must stay short, whatever the text says.
fn check_location(location: u32) -> Lowered<()> {
    if location > MAX_LOCATION {
        return Err(LowerError::Unsupported("locations above 255"));
    }
    Ok(())
}

/// The number of 32-bit components of an input or output. Attributes, varyings and targets have no
/// integers of 64 bits.
fn components(module: &Module, ty: Handle<naga::Type>) -> Lowered<u32> {
    if module.types[ty].inner.scalar().is_some_and(is_wide) {
        return Err(LowerError::Unsupported("64-bit inputs and outputs"));
    }
    Ok(u32::try_from(scalars_of(module, ty)?.len()).unwrap_or(u32::MAX))
}
