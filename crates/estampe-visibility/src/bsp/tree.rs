//! The tree, and its orders.

use super::splitter::Splitter;
use crate::eye::Eye;
use crate::polygon::Corner;
use std::cmp::Ordering;

/// A polygon, or the part of one that the tree's planes left.
#[derive(Debug, Clone, PartialEq)]
pub struct Piece<const N: usize> {
    /// The corners, in the winding of the polygon; convex.
    pub corners: Vec<Corner<N>>,
    /// The number of the polygon in the tree's input.
    pub source: u32,
}

/// A node, its pieces and the nodes below it.
#[derive(Debug, Clone)]
pub(super) struct Node {
    pub(super) splitter: Splitter,
    /// The pieces in the splitter's plane.
    pub(super) pieces: std::ops::Range<u32>,
    /// The nodes in front of the plane and behind it; [`NONE`] where there is nothing.
    pub(super) children: [u32; 2],
}

/// No node.
pub(super) const NONE: u32 = u32::MAX;

/// A BSP tree of convex polygons with `N` attributes.
#[derive(Debug, Clone, Default)]
pub struct BspTree<const N: usize> {
    /// The root is the first.
    pub(super) nodes: Vec<Node>,
    pub(super) pieces: Vec<Piece<N>>,
}

/// One step of a traversal.
enum Step {
    Visit(u32),
    Emit(u32),
}

impl<const N: usize> BspTree<N> {
    /// The pieces in the order of the tree.
    #[must_use]
    pub fn pieces(&self) -> &[Piece<N>] {
        &self.pieces
    }

    /// Number of the tree's planes.
    #[must_use]
    pub fn node_count(&self) -> usize {
        self.nodes.len()
    }

    /// The most planes that lie between the root and a piece, the root included.
    #[must_use]
    pub fn depth(&self) -> usize {
        // Children come after their parent.
        let mut depths = vec![1_usize; self.nodes.len()];
        for (number, node) in self.nodes.iter().enumerate() {
            for child in node.children.into_iter().filter(|child| *child != NONE) {
                depths[child as usize] = depths[number] + 1;
            }
        }
        depths.into_iter().max().unwrap_or(0)
    }

    /// Bytes of the tree: nodes, pieces and their corners.
    #[must_use]
    pub fn memory(&self) -> usize {
        let corners: usize = self
            .pieces
            .iter()
            .map(|piece| piece.corners.capacity())
            .sum();
        self.nodes.capacity() * size_of::<Node>()
            + self.pieces.capacity() * size_of::<Piece<N>>()
            + corners * size_of::<Corner<N>>()
    }

    /// Calls `show` for each piece, from the farthest on: no piece hides one after it. Pieces in
    /// one plane come in the order of the input.
    pub fn back_to_front<'t>(&'t self, eye: Eye, show: impl FnMut(&'t Piece<N>)) {
        self.traverse(eye, [1, 0], show);
    }

    /// Calls `show` for each piece, from the nearest on: no piece hides one before it.
    pub fn front_to_back<'t>(&'t self, eye: Eye, show: impl FnMut(&'t Piece<N>)) {
        self.traverse(eye, [0, 1], show);
    }

    /// `order` is the order of the eye's side (0) and of the other side (1).
    fn traverse<'t>(&'t self, eye: Eye, order: [usize; 2], mut show: impl FnMut(&'t Piece<N>)) {
        let mut steps = Vec::new();
        if !self.nodes.is_empty() {
            steps.push(Step::Visit(0));
        }
        while let Some(step) = steps.pop() {
            match step {
                Step::Emit(node) => {
                    let range = &self.nodes[node as usize].pieces;
                    let pieces = &self.pieces[range.start as usize..range.end as usize];
                    pieces.iter().for_each(&mut show);
                }
                Step::Visit(number) => {
                    let node = &self.nodes[number as usize];
                    // An eye in the plane sees its pieces as lines: either order is right.
                    let sides = if node.splitter.side_of_eye(eye) == Ordering::Less {
                        [node.children[1], node.children[0]]
                    } else {
                        node.children
                    };
                    let [first, last] = order.map(|side| sides[side]);
                    let visit = |child: u32| (child != NONE).then_some(Step::Visit(child));
                    // The stack takes the last step first.
                    steps.extend(visit(last));
                    steps.push(Step::Emit(number));
                    steps.extend(visit(first));
                }
            }
        }
    }
}
