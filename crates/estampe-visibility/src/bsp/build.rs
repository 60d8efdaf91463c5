//! Building a tree, without recursion.

use super::cut::cut;
use super::splitter::{Side, Splitter};
use super::tree::{BspTree, NONE, Node, Piece};
use crate::exact::Plane;
use crate::polygon::Polygon;
use fastrand::Rng;

/// The choices of a build. The same input and options give the same tree.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BspOptions {
    /// The most pieces that cuts may leave; the default, 2²², is about 1 GiB.
    pub max_pieces: usize,
    /// The seed of the random candidates.
    pub seed: u64,
}

impl Default for BspOptions {
    fn default() -> Self {
        Self {
            max_pieces: 1 << 22,
            seed: 1,
        }
    }
}

/// The reason why there is no tree.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum BspError {
    /// The polygons, or what cuts made of them, are more than the options allow.
    #[error(
        "the {polygons} polygons become more than {max_pieces} pieces; allow more pieces, or use a \
         depth buffer"
    )]
    TooManyPieces {
        /// Number of polygons.
        polygons: usize,
        /// The limit of the options.
        max_pieces: usize,
    },
}

/// Polygons whose planes are candidates for a splitter.
const CANDIDATES: usize = 6;
/// The most pieces on which candidates are tried.
const TRIED_ON: usize = 96;
/// From this number of pieces on, planes across the axes are candidates.
const AXES_FROM: usize = 128;
/// The cost of a cut, in pieces that one side has more than the other.
const COST_OF_CUT: usize = 8;

/// Pieces that wait for a node, and the link to it.
struct Waiting<const N: usize> {
    pieces: Vec<Piece<N>>,
    /// The parent and its side; `None` for the root.
    parent: Option<(u32, usize)>,
}

impl<const N: usize> BspTree<N> {
    /// The tree of polygons.
    ///
    /// # Errors
    /// [`BspError`] if the pieces exceed the limit: polygons that all cross each other become up to
    /// n³ pieces.
    pub fn new(polygons: &[Polygon<N>], options: BspOptions) -> Result<Self, BspError> {
        let too_many = BspError::TooManyPieces {
            polygons: polygons.len(),
            max_pieces: options.max_pieces,
        };
        let limit = options.max_pieces.min(NONE as usize - 1);
        if polygons.len() > limit {
            return Err(too_many);
        }
        let planes: Vec<Plane> = polygons.iter().map(Polygon::plane).collect();
        let mut random = Rng::with_seed(options.seed);
        let mut tree = Self {
            nodes: Vec::new(),
            pieces: Vec::new(),
        };
        let pieces = (0..).zip(polygons).map(|(source, polygon)| Piece {
            corners: polygon.corners().to_vec(),
            source,
        });
        let mut waiting = vec![Waiting {
            pieces: pieces.collect(),
            parent: None,
        }];
        let mut count = polygons.len();
        while let Some(Waiting { pieces, parent }) = waiting.pop() {
            if pieces.is_empty() {
                continue;
            }
            let number = tree.nodes.len();
            let splitter = choose(&pieces, &planes, &mut random);
            let [on, front, back] = divide(pieces, &planes, &splitter, &mut count);
            if count > limit {
                return Err(too_many);
            }
            #[expect(clippy::cast_possible_truncation, reason = "the limit is below 2³²")]
            let [number, start, end] =
                [number, tree.pieces.len(), tree.pieces.len() + on.len()].map(|count| count as u32);
            if let Some((parent, side)) = parent {
                tree.nodes[parent as usize].children[side] = number;
            }
            tree.pieces.extend(on);
            tree.nodes.push(Node {
                splitter,
                pieces: start..end,
                children: [NONE; 2],
            });
            for (side, pieces) in [front, back].into_iter().enumerate() {
                waiting.push(Waiting {
                    pieces,
                    parent: Some((number, side)),
                });
            }
        }
        Ok(tree)
    }
}

/// The splitter of least cost among a few: planes of random pieces, and across the axes. Every
/// splitter leaves each side fewer pieces than there are.
fn choose<const N: usize>(pieces: &[Piece<N>], planes: &[Plane], random: &mut Rng) -> Splitter {
    let of_piece = |index: usize| {
        let source = pieces[index].source;
        Splitter::Polygon {
            source,
            plane: planes[source as usize],
        }
    };
    let first = of_piece(random.usize(..pieces.len()));
    if pieces.len() == 1 {
        return first;
    }
    let stride = pieces.len().div_ceil(TRIED_ON);
    let tried: Vec<&Piece<N>> = pieces.iter().step_by(stride).collect();
    let mut best = (cost(&first, &tried, planes).0, first);
    let mut compare = |candidate: Splitter, is_axis: bool| {
        let (cost, [front, back]) = cost(&candidate, &tried, planes);
        // Axes need a piece that is on one side only on both sides.
        if cost < best.0 && (!is_axis || front > 0 && back > 0) {
            best = (cost, candidate);
        }
    };
    for _ in 1..CANDIDATES.min(pieces.len()) {
        compare(of_piece(random.usize(..pieces.len())), false);
    }
    if pieces.len() >= AXES_FROM {
        for axis in 0..3 {
            let mut middles: Vec<f64> = tried.iter().map(|piece| middle(piece, axis)).collect();
            let half = middles.len() / 2;
            let (_, at, _) = middles.select_nth_unstable_by(half, f64::total_cmp);
            compare(Splitter::Axis { axis, at: *at }, true);
        }
    }
    best.1
}

/// The middle of a piece along an axis.
fn middle<const N: usize>(piece: &Piece<N>, axis: usize) -> f64 {
    let sum: f64 = piece
        .corners
        .iter()
        .map(|corner| corner.position[axis])
        .sum();
    sum / piece.corners.len() as f64
}

/// The cost of a splitter, and the pieces that are in front of it and behind it as a whole.
fn cost<const N: usize>(
    splitter: &Splitter,
    pieces: &[&Piece<N>],
    planes: &[Plane],
) -> (usize, [usize; 2]) {
    let (mut front, mut back, mut cuts) = (0_usize, 0, 0);
    for piece in pieces {
        match splitter.classify(piece, &planes[piece.source as usize]) {
            Side::Front => front += 1,
            Side::Back => back += 1,
            Side::Across => cuts += 1,
            Side::On => {}
        }
    }
    (front.abs_diff(back) + cuts * COST_OF_CUT, [front, back])
}

/// The pieces in the splitter's plane, in front of it and behind it; adds new pieces to `count`.
fn divide<const N: usize>(
    pieces: Vec<Piece<N>>,
    planes: &[Plane],
    splitter: &Splitter,
    count: &mut usize,
) -> [Vec<Piece<N>>; 3] {
    let [mut on, mut front, mut back] = [(); 3].map(|()| Vec::new());
    for piece in pieces {
        match splitter.classify(&piece, &planes[piece.source as usize]) {
            Side::On => on.push(piece),
            Side::Front => front.push(piece),
            Side::Back => back.push(piece),
            Side::Across => {
                let [before, behind] = cut(&piece, splitter);
                front.push(before);
                back.push(behind);
                *count += 1;
            }
        }
    }
    on.sort_by_key(|piece| piece.source);
    [on, front, back]
}
