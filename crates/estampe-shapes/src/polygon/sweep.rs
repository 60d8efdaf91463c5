//! The sweep that triangulates an arrangement by a fill rule.
//!
//! A line moves upwards over the vertices, by y and among equal y by x. The pieces that it crosses
//! are kept from left to right, with the winding number on their right. Where the fill rule
//! changes its answer across a piece, the piece is a border; a left and a right border bound a span
//! of the inside, which carries its chains ([`super::monotone`]):
//!
//! ```text
//!   below a vertex         what happens to the spans around it
//!   ╲   ╱   inside         both sides go on: the right border of the left span and the
//!    ╲ ╱    left and       left border of the right one end here. If no border leaves
//!     v     right          upwards the spans merge: both chains wait for the next vertex
//!
//!     │     a border       the vertex joins the chain of that side
//!     v
//!
//!     v     inside         if borders leave upwards the span is divided, by a diagonal to
//!           all around     its last vertex
//! ```
//!
//! (Lee and Preparata 1977 for the diagonals; de Berg et al., "Computational Geometry", chapter 3.)
//! Vertices that touch, holes, and borders that coincide need no special treatment: only the order
//! of the pieces matters, and exact predicates tell it.

use std::cmp::Ordering;

use super::arrangement::Arrangement;
use super::exact::ExactPoint;
use super::measure::FillRule;
use super::monotone::{Chain, Side, Triangles};

/// A piece that the sweep line crosses.
#[derive(Debug)]
struct ActivePiece {
    low: usize,
    high: usize,
    winding: i32,
    /// The winding number on the right.
    winding_right: i32,
    /// True if the inside begins or ends here.
    is_border: bool,
    /// The span on the right, if this is its left border.
    span: Option<Span>,
}

/// The chains of a span: one, or two that meet in a vertex at which spans have merged.
#[derive(Debug)]
enum Span {
    One(Chain),
    Merged(Chain, Chain),
}

impl Span {
    /// A vertex on one of the borders, which goes on.
    fn add(self, vertex: usize, side: Side, out: &mut Triangles<'_>) -> Chain {
        let mut chain = match (self, side) {
            (Self::One(chain), _) => chain,
            // The diagonal from the merging vertex to this one is the end of one polygon.
            (Self::Merged(left, right), Side::Right) => {
                right.close(vertex, out);
                left
            }
            (Self::Merged(left, right), Side::Left) => {
                left.close(vertex, out);
                right
            }
        };
        chain.add(vertex, side, out);
        chain
    }

    /// The vertex at which both borders end.
    fn close(self, vertex: usize, out: &mut Triangles<'_>) {
        match self {
            Self::One(chain) => chain.close(vertex, out),
            Self::Merged(left, right) => {
                left.close(vertex, out);
                right.close(vertex, out);
            }
        }
    }

    /// A vertex between the borders from which borders start; returns the parts on both sides.
    fn divide(self, vertex: usize, out: &mut Triangles<'_>) -> [Chain; 2] {
        match self {
            Self::One(chain) => chain.divide(vertex, out),
            Self::Merged(mut left, mut right) => {
                left.add(vertex, Side::Right, out);
                right.add(vertex, Side::Left, out);
                [left, right]
            }
        }
    }
}

/// The triangles of the inside, counter-clockwise with y up, by numbers of vertices.
pub(super) fn triangulate(arrangement: &Arrangement, rule: FillRule) -> Vec<[usize; 3]> {
    let vertices = &arrangement.vertices;
    let mut out = Triangles {
        vertices,
        triangles: Vec::new(),
    };
    let mut active: Vec<ActivePiece> = Vec::new();
    let mut pieces = arrangement.pieces.iter().peekable();
    for vertex in 0..vertices.len() {
        let mut starting = Vec::new();
        while let Some(piece) = pieces.next_if(|piece| piece.low == vertex) {
            starting.push(ActivePiece {
                low: piece.low,
                high: piece.high,
                winding: piece.winding,
                winding_right: 0,
                is_border: false,
                span: None,
            });
        }
        // Counter-clockwise is to the left.
        starting.sort_by(|a, b| {
            let [from, a, b] = [vertex, a.high, b.high].map(|vertex| &vertices[vertex]);
            ExactPoint::orientation(from, a, b)
        });
        pass(vertex, starting, rule, &mut active, &mut out);
    }
    debug_assert!(active.is_empty(), "every piece ends at a vertex");
    out.triangles
}

/// Moves the sweep line over a vertex, from which the `starting` pieces leave.
fn pass(
    vertex: usize,
    mut starting: Vec<ActivePiece>,
    rule: FillRule,
    active: &mut Vec<ActivePiece>,
    out: &mut Triangles<'_>,
) {
    let vertices = out.vertices;
    let side_of = |piece: &ActivePiece| {
        let [low, high] = [piece.low, piece.high].map(|vertex| &vertices[vertex]);
        ExactPoint::orientation(low, high, &vertices[vertex])
    };
    // The vertex is to the right of pieces before it, and the end of those that end here.
    let first = active.partition_point(|piece| side_of(piece) == Ordering::Less);
    let ending = active[first..].partition_point(|piece| piece.high == vertex);

    let is_inside = |winding: i32| match rule {
        FillRule::EvenOdd => winding % 2 != 0,
        FillRule::NonZero => winding != 0,
    };
    let winding_left = match active[..first].last() {
        Some(piece) => piece.winding_right,
        None => 0,
    };
    let mut winding = winding_left;
    for piece in &mut starting {
        let before = winding;
        // Upward edges have the inside of a counter-clockwise ring on their left.
        winding -= piece.winding;
        piece.winding_right = winding;
        piece.is_border = is_inside(before) != is_inside(winding);
    }
    let (is_inside_left, is_inside_right) = (is_inside(winding_left), is_inside(winding));

    let ended: Vec<ActivePiece> = active.drain(first..first + ending).collect();
    let has_ended_border = ended.iter().any(|piece| piece.is_border);
    // Spans of which both borders end here close; the last one may reach on to the right.
    let mut spans = ended.into_iter().filter_map(|piece| piece.span);
    let mut right = None;
    if has_ended_border && is_inside_right {
        let mut rest: Vec<Span> = spans.collect();
        right = rest.pop();
        rest.into_iter().for_each(|span| span.close(vertex, out));
    } else {
        spans.by_ref().for_each(|span| span.close(vertex, out));
    }

    let mut borders = starting
        .iter_mut()
        .filter(|piece| piece.is_border)
        .peekable();
    let starts_border = borders.peek().is_some();
    if is_inside_left && (has_ended_border || starts_border) {
        let holder = active[..first]
            .iter_mut()
            .rev()
            .find(|piece| piece.is_border);
        let slot = &mut holder.expect("the inside has a left border").span;
        let left = slot.take().expect("a left border holds its span");
        if !has_ended_border {
            let [left, right_part] = left.divide(vertex, out);
            *slot = Some(Span::One(left));
            right = Some(Span::One(right_part));
        } else {
            let chain = left.add(vertex, Side::Right, out);
            *slot = Some(match (starts_border, right.take()) {
                (false, Some(other)) => Span::Merged(chain, other.add(vertex, Side::Left, out)),
                (_, other) => {
                    right = other.map(|other| Span::One(other.add(vertex, Side::Left, out)));
                    Span::One(chain)
                }
            });
        }
        // The first border is the right one of the span on the left.
        borders.next();
    } else if let Some(span) = right.take() {
        right = Some(Span::One(span.add(vertex, Side::Left, out)));
    }
    // Spans between two borders begin here; the last border may be the left one of the span on
    // the right.
    while let Some(border) = borders.next() {
        let is_last = borders.next().is_none();
        border.span = match right.take_if(|_| is_last) {
            Some(span) => Some(span),
            None => Some(Span::One(Chain::new(vertex))),
        };
    }
    debug_assert!(right.is_none(), "a span on the right has a left border");
    drop(borders);
    active.splice(first..first, starting);
}
