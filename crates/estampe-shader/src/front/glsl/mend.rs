//! Mending the modules that naga's GLSL front end makes.
//!
//! naga leaves the size of `gl_ClipDistance` open, which its validator then refuses, makes
//! `barrier()` a barrier of subgroups too, which it does not allow in all stages, and lets
//! `texture` choose a level of detail by derivatives in stages without them.

use estampe_ir::interface::Stage;
use naga::{
    ArraySize, Barrier, Binding, Block, BuiltIn, Expression, SampleLevel, Statement, StructMember,
    Type, TypeInner,
};

use super::super::validate;
use super::unit::Unit;
use super::{atomics, gather, indices};

/// The most clip distances (OpenGL 4.6, `GL_MAX_CLIP_DISTANCES`).
const MOST_DISTANCES: u32 = 8;

/// Mends a module.
pub(super) fn mend(module: &mut naga::Module, unit: &Unit) -> Result<(), validate::Fault> {
    size_clip_distances(module, unit);
    for (_, function) in module.functions.iter_mut() {
        mend_barriers(&mut function.body);
        gather::mend(function, unit);
        if unit.stage != Stage::Fragment {
            sample_the_base(function);
        }
    }
    atomics::mend(module, unit)
}

/// Takes the base level where a shader of a stage without derivatives leaves the choice of the
/// level (GLSL 4.60, section 8.9).
fn sample_the_base(function: &mut naga::Function) {
    for (_, expression) in function.expressions.iter_mut() {
        if let Expression::ImageSample { level, .. } = expression
            && matches!(level, SampleLevel::Auto | SampleLevel::Bias(_))
        {
            *level = SampleLevel::Zero;
        }
    }
}

/// Leaves subgroups out of barriers.
fn mend_barriers(block: &mut Block) {
    for statement in block.iter_mut() {
        match statement {
            Statement::ControlBarrier(barrier) | Statement::MemoryBarrier(barrier) => {
                *barrier &= Barrier::WORK_GROUP | Barrier::STORAGE;
            }
            Statement::Block(inner) => mend_barriers(inner),
            Statement::If { accept, reject, .. } => {
                mend_barriers(accept);
                mend_barriers(reject);
            }
            Statement::Switch { cases, .. } => {
                cases
                    .iter_mut()
                    .for_each(|case| mend_barriers(&mut case.body));
            }
            Statement::Loop {
                body, continuing, ..
            } => {
                mend_barriers(body);
                mend_barriers(continuing);
            }
            _ => {}
        }
    }
}

/// Gives the array of clip distances the size that is declared, or that its indices ask for.
fn size_clip_distances(module: &mut naga::Module, unit: &Unit) {
    let variable = module.global_variables.iter().find_map(|(_, variable)| {
        (variable.name.as_deref() == Some("gl_ClipDistance")).then_some(variable.ty)
    });
    let Some(ty) = variable else {
        return;
    };
    let used =
        indices::largest_index(unit, "gl_ClipDistance").map_or(MOST_DISTANCES, |last| last + 1);
    let wanted = if unit.clip_distances > 0 {
        unit.clip_distances
    } else {
        used
    };
    let Some(size) = core::num::NonZeroU32::new(wanted.min(MOST_DISTANCES)) else {
        return;
    };
    if let TypeInner::Array { base, stride, .. } = module.types[ty].inner {
        let inner = TypeInner::Array {
            base,
            size: ArraySize::Constant(size),
            stride,
        };
        // The name sets it apart from an array of the author: types are unique.
        let name = Some("distances".to_owned());
        module.types.replace(ty, Type { name, inner });
    }
    // The outputs follow each other without a gap.
    let results: Vec<_> = module
        .entry_points
        .iter()
        .filter_map(|entry| entry.function.result.as_ref().map(|result| result.ty))
        .collect();
    for result in results {
        let TypeInner::Struct { members, .. } = &module.types[result].inner else {
            continue;
        };
        let is_clip = |member: &StructMember| {
            matches!(
                member.binding,
                Some(Binding::BuiltIn(BuiltIn::ClipDistances))
            )
        };
        if !members.iter().any(is_clip) {
            continue;
        }
        let mut members = members.clone();
        let mut span = 0_u32;
        for member in &mut members {
            member.offset = span;
            span += module.types[member.ty].inner.size(module.to_ctx());
        }
        let name = module.types[result].name.clone();
        let inner = TypeInner::Struct { members, span };
        let mended = Type { name, inner };
        if module.types[result] != mended {
            module.types.replace(result, mended);
        }
    }
}
