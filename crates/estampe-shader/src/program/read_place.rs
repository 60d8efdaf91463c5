//! Where a non-dependent texture read samples: scalars of varyings, with uniform shifts.
//!
//! In · Out: a tree of the fragment stage · the samples that can be made before it runs.

use super::batch::Widths;
use super::taps::{MOST_TAPS, Shift, Shifted};
use super::uniforms::Finder;
use estampe_ir::interface::Input;
use estampe_ir::op::{Axis, LevelOfDetail, TextureOp, TextureQuery};
use estampe_ir::tree::{Node, Tree};
use estampe_ir::{Op, Value};
use estampe_simd::{Packet, words_of};
use estampe_texture::{PacketLod, PacketPlaces, PacketRequest};
use std::collections::HashMap;

/// The most reads of a stage, and of a filter: the texels of sixteen packets, 4 kB for each read,
/// stay near the processor. Other samples stay in the code.
pub(super) const MOST: usize = MOST_TAPS;

/// The scalars of a fragment's varyings, derivatives after them, that a read's operands are.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Place {
    coordinates: Vec<usize>,
    layer: Option<usize>,
    level: Level,
    offset: [i32; 3],
}

#[derive(Debug, Clone, PartialEq, Eq)]
enum Level {
    /// The base level.
    Zero,
    /// That of the quad.
    Implicit,
    /// That of the derivatives along x, then along y.
    Gradients([Vec<usize>; 2]),
}

impl Place {
    /// Two coordinates, and where the level of detail comes from, if the place is no more.
    pub(super) fn flat<'a>(
        &self,
        scalars: &'a [Packet<f32>],
        stride: usize,
    ) -> Option<(PacketPlaces<'a>, PacketLod)> {
        let &[u, v] = &self.coordinates[..] else {
            return None;
        };
        let (gradients, lod) = match &self.level {
            Level::Zero => (None, PacketLod::Level),
            Level::Implicit => (None, PacketLod::Implicit),
            Level::Gradients([x, y]) => match (&x[..], &y[..]) {
                (&[ux, vx], &[uy, vy]) => (Some([ux, vx, uy, vy]), PacketLod::Gradients),
                _ => return None,
            },
        };
        let is_plain = self.layer.is_none() && self.offset == [0; 3];
        let places = PacketPlaces {
            scalars,
            stride,
            at: [u, v],
            gradients,
        };
        is_plain.then_some((places, lod))
    }

    /// The scalars that are two coordinates, and the layer, and true if the level of detail is that
    /// of the quad; `None` unless the level comes from there or from the derivatives of these
    /// coordinates.
    pub(super) fn of_alpha(
        &self,
        widths: Widths,
        gradients: &[usize],
    ) -> Option<([usize; 2], Option<usize>, bool)> {
        let &[u, v] = &self.coordinates[..] else {
            return None;
        };
        let of_quads = match &self.level {
            Level::Implicit => true,
            Level::Gradients(axes) => {
                let firsts = [widths.varyings, widths.varyings + gradients.len()];
                let are_own = axes.iter().zip(firsts).all(|(axis, first)| {
                    let own = [u, v].map(|scalar| gradients.binary_search(&scalar).ok());
                    own.iter()
                        .zip(axis)
                        .all(|(own, scalar)| own.map(|own| first + own) == Some(*scalar))
                        && axis.len() == own.len()
                });
                if !are_own {
                    return None;
                }
                false
            }
            Level::Zero => return None,
        };
        (u < widths.varyings && v < widths.varyings && self.offset == [0; 3]).then_some((
            [u, v],
            self.layer,
            of_quads,
        ))
    }

    /// Sets what a packet with these scalars asks for, in a request of zeros.
    #[inline]
    pub(super) fn ask<'a>(&self, scalars: &'a [Packet<f32>], asked: &mut PacketRequest<'a>) {
        for (to, scalar) in asked.at.iter_mut().zip(&self.coordinates) {
            *to = &scalars[*scalar];
        }
        asked.offset = self.offset;
        if let Some(layer) = self.layer {
            asked.layer = &words_of(scalars)[layer];
        }
        match &self.level {
            Level::Zero => asked.lod = PacketLod::Level,
            Level::Implicit => {}
            Level::Gradients(axes) => {
                asked.lod = PacketLod::Gradients;
                for (along, axis) in asked.gradients.chunks_mut(3).zip(axes) {
                    for (to, scalar) in along.iter_mut().zip(axis) {
                        *to = &scalars[*scalar];
                    }
                }
            }
        }
    }
}

/// The values of a tree's outermost body that are scalars of the fragment's varyings or their
/// derivatives.
pub(super) fn scalars(tree: &Tree, widths: Widths, gradients: &[usize]) -> HashMap<Value, usize> {
    let scalar = |node: &Node| {
        let Node::Op {
            op: Op::Input(at),
            first,
        } = node
        else {
            return None;
        };
        let input = tree.interface.inputs.get(*at as usize)?;
        Some((*first, scalar_of(*input, widths, gradients)?))
    };
    tree.body.iter().filter_map(scalar).collect()
}

/// The scalar of the fragments' varyings, derivatives after them, that an input is.
pub(super) fn scalar_of(input: Input, widths: Widths, gradients: &[usize]) -> Option<usize> {
    match input {
        Input::Varying(scalar) => Some(scalar as usize),
        Input::Derivative { scalar, axis } => {
            let first = match axis {
                Axis::X => widths.varyings,
                Axis::Y => widths.varyings + gradients.len(),
            };
            Some(first + gradients.binary_search(&(scalar as usize)).ok()?)
        }
        _ => None,
    }
}

/// A sample that is made before.
pub(super) struct Read {
    /// Its first result.
    pub(super) first: Value,
    pub(super) place: Place,
    /// The shift of each coordinate.
    pub(super) shifts: Vec<Shift<Value>>,
    /// The positions in the interface of its texture and sampler.
    pub(super) texture: [u32; 2],
}

impl Read {
    /// True if a coordinate is not the varying itself.
    pub(super) fn is_shifted(&self) -> bool {
        self.shifts.iter().any(|shift| *shift != Shift::Zero)
    }
}

/// The samples of a tree that are made before, as many as there may be.
pub(super) fn found(tree: &Tree, widths: Widths, gradients: &[usize]) -> Vec<Read> {
    let scalars = scalars(tree, widths, gradients);
    let uniform = Finder::new(tree);
    let shifted = Shifted::new(tree, &scalars, &uniform);
    let read = |node: &Node| {
        let Node::Op {
            op: Op::Texture(op),
            first,
        } = node
        else {
            return None;
        };
        let (place, shifts) = place(tree, op, (&scalars, &shifted))?;
        Some(Read {
            first: *first,
            place,
            shifts,
            texture: [op.texture, op.sampler?],
        })
    };
    tree.body.iter().filter_map(read).take(MOST).collect()
}

/// The place of a sample and the shifts from it, if its operands are scalars.
fn place(
    tree: &Tree,
    op: &TextureOp,
    (scalars, shifted): (&HashMap<Value, usize>, &Shifted<'_>),
) -> Option<(Place, Vec<Shift<Value>>)> {
    let of = |value: &Value| scalars.get(value).copied();
    let all = |values: &[Value]| values.iter().map(of).collect::<Option<Vec<_>>>();
    let runs_everywhere = || {
        let is_all = |node: &Node| matches!(node, Node::Op { op: Op::MaskConstant(true), first } if *first == op.mask);
        tree.body.iter().any(is_all)
    };
    if op.query != TextureQuery::Sample || op.coordinates.len() > 3 {
        return None;
    }
    let coordinates = op.coordinates.iter().map(|value| shifted.of(*value));
    let (coordinates, shifts): (Vec<_>, Vec<_>) =
        coordinates.collect::<Option<Vec<_>>>()?.into_iter().unzip();
    let level = match &op.level {
        LevelOfDetail::Zero => Level::Zero,
        LevelOfDetail::Implicit if runs_everywhere() => Level::Implicit,
        LevelOfDetail::Gradient { x, y } => Level::Gradients([all(x)?, all(y)?]),
        _ => return None,
    };
    let is_flat = coordinates.len() == 2 && op.layer.is_none() && op.offset == [0; 3];
    let may_be_shifted = is_flat && !matches!(level, Level::Gradients(_));
    if !may_be_shifted && shifts.iter().any(|shift| *shift != Shift::Zero) {
        return None;
    }
    let place = Place {
        coordinates,
        layer: match &op.layer {
            Some(layer) => Some(of(layer)?),
            None => None,
        },
        level,
        offset: op.offset,
    };
    Some((place, shifts))
}
