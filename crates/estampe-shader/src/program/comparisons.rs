//! Soft shadows: comparisons with one depth texture at uniform shifts from a varying, made before
//! the shader runs.
//!
//! In · Out: a tree of the fragment stage · the comparisons that can be made before it runs; the
//! inputs of a batch · the shares that pass.
//!
//! In the code each packet's comparisons are a call that is given all coordinates, of which most
//! packets need the corners of the filter alone: there all texels are lit, or none is.

use super::batch::Widths;
use super::read_place::scalars;
use super::taps::{MOST_TAPS, Shift, Shifted};
use super::textures::BoundTextures;
use super::uniforms::Finder;
use estampe_ir::op::{LevelOfDetail, TextureOp, TextureQuery};
use estampe_ir::tree::{Node, Tree};
use estampe_ir::{Op, Value};
use estampe_simd::Packet;
use estampe_texture::{PacketLod, PacketPlaces, PacketRequest, compare_shifted, shifted};

/// A comparison that is made before.
pub(super) struct Comparison {
    /// Its result.
    pub(super) first: Value,
    at: ShadowPlace<Value>,
    shifts: [Shift<Value>; 2],
}

/// What comparisons of one filter have in common.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct ShadowPlace<V> {
    /// The scalars of varyings from which the coordinates are shifted.
    coordinates: [usize; 2],
    /// The scalar of the reference, and what is added to it.
    reference: (usize, Shift<V>),
    /// The positions in the interface of the texture and the sampler.
    texture: [u32; 2],
}

/// The comparisons of a tree's outermost body that are made before, so many at most.
pub(super) fn found(
    tree: &Tree,
    widths: Widths,
    gradients: &[usize],
    most: usize,
) -> Vec<Comparison> {
    let scalars = scalars(tree, widths, gradients);
    let uniform = Finder::new(tree);
    let shifted = Shifted::new(tree, &scalars, &uniform);
    let comparison = |node: &Node| match node {
        Node::Op {
            op: Op::Texture(op),
            first,
        } => comparison(op, *first, &shifted),
        _ => None,
    };
    tree.body.iter().filter_map(comparison).take(most).collect()
}

/// A comparison in the base level of a two-dimensional texture, if its operands are scalars at
/// uniform shifts.
fn comparison(op: &TextureOp, first: Value, shifted: &Shifted<'_>) -> Option<Comparison> {
    let is_flat = op.layer.is_none() && op.offset == [0; 3];
    let is_base = op.level == LevelOfDetail::Zero;
    let (TextureQuery::SampleCompare, &[u, v], true) =
        (op.query, &op.coordinates[..], is_flat && is_base)
    else {
        return None;
    };
    let ((u, shift_u), (v, shift_v)) = (shifted.of(u)?, shifted.of(v)?);
    Some(Comparison {
        first,
        at: ShadowPlace {
            coordinates: [u, v],
            reference: shifted.of(op.reference?)?,
            texture: [op.texture, op.sampler?],
        },
        shifts: [shift_u, shift_v],
    })
}

/// Comparisons with one reference at shifts from a place.
#[derive(Debug)]
pub(super) struct ShadowFilter {
    at: ShadowPlace<usize>,
    /// Of each comparison.
    shifts: Vec<[Shift<usize>; 2]>,
}

impl ShadowFilter {
    /// The filters of some comparisons, and for each of these its filter and its place there.
    pub(super) fn of_all(
        tree: &Tree,
        comparisons: &[Comparison],
        uniforms: &mut Finder<'_>,
    ) -> (Vec<Self>, Vec<(usize, usize)>) {
        let mut number =
            |shift: Shift<Value>| shift.numbered(|value| uniforms.number_of(tree, value));
        let (mut places, mut filters) = (Vec::new(), Vec::<Self>::new());
        let mut of_filters: Vec<ShadowPlace<Value>> = Vec::new();
        for comparison in comparisons {
            let at = comparison.at;
            let known = of_filters.iter().position(|known| *known == at);
            let filter = known.unwrap_or_else(|| {
                of_filters.push(at);
                let (scalar, shift) = at.reference;
                filters.push(Self {
                    at: ShadowPlace {
                        coordinates: at.coordinates,
                        reference: (scalar, number(shift)),
                        texture: at.texture,
                    },
                    shifts: Vec::new(),
                });
                filters.len() - 1
            });
            let shifts = &mut filters[filter].shifts;
            shifts.push(comparison.shifts.map(&mut number));
            places.push((filter, shifts.len() - 1));
        }
        (filters, places)
    }

    /// True if the texture at this position in the interface is compared.
    pub(super) fn is_of(&self, texture: u32) -> bool {
        self.at.texture[0] == texture
    }

    /// The number of comparisons of a packet.
    pub(super) fn count(&self) -> usize {
        self.shifts.len()
    }

    /// Compares for packets of `stride` scalars; the shares of a packet are those of its
    /// comparisons.
    pub(super) fn compare(
        &self,
        (textures, values): (&BoundTextures<'_>, &[u32]),
        (scalars, stride): (&[Packet<f32>], usize),
        shares: &mut [Packet<f32>],
    ) {
        let [texture, sampler] = self.at.texture;
        let Some(texture) = textures.sampled(texture, sampler) else {
            shares.fill(Packet::default());
            return;
        };
        let mut amounts = [[0.0; 2]; MOST_TAPS];
        for (to, shifts) in amounts.iter_mut().zip(&self.shifts) {
            *to = shifts.map(|shift| shift.amount(values));
        }
        let amounts = &amounts[..self.count().min(MOST_TAPS)];
        let (reference, shift) = self.at.reference;
        let above = shift.amount(values);
        if let Some(depths) = texture.depths() {
            let places = PacketPlaces {
                scalars,
                stride,
                at: self.at.coordinates,
                gradients: None,
            };
            compare_shifted(
                depths,
                texture.level(),
                (&places, (reference, above)),
                amounts,
                shares,
            );
            return;
        }
        let [u, v] = self.at.coordinates;
        let packets = scalars.chunks_exact(stride.max(1));
        for (scalars, shares) in packets.zip(shares.chunks_exact_mut(self.count().max(1))) {
            let zeros = PacketRequest::ZEROS;
            let [reference, _] = shifted([&scalars[reference], zeros.reference], [above, -0.0]);
            for (amount, share) in amounts.iter().zip(shares) {
                let [u, v] = &shifted([&scalars[u], &scalars[v]], *amount);
                let asked = PacketRequest {
                    at: [u, v, zeros.at[2]],
                    lod: PacketLod::Level,
                    reference: &reference,
                    ..zeros
                };
                texture.compare_request(&asked, share);
            }
        }
    }
}
