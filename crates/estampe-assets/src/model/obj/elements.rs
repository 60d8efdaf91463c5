//! Faces, lines and points: indices resolved, polygons split into triangles.

use super::plain::Run;
use crate::model::load::Context;
use crate::model::number::parse_i64;
use crate::model::polygons::{Polygons, SPENT};
use crate::{AssetError, Limits, Location};
use glam::Vec3;

/// Marks an attribute that a corner does not have.
pub(super) const ABSENT: u32 = u32::MAX;

/// A corner of an element: indices from 0 into the file's positions, texture coordinates, normals.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Corner {
    pub(super) position: u32,
    pub(super) uv: u32,
    pub(super) normal: u32,
}

/// The keyword of an element.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Face,
    Line,
    Points,
}

/// A corner as written, counted from 0, with negative indices resolved.
#[derive(Debug, Clone, Copy)]
struct WrittenCorner {
    /// Position, texture coordinate, normal; [`NOT_WRITTEN`], [`IMPOSSIBLE`], or an index from 0
    /// that may be too large.
    indices: [i64; 3],
}

const NOT_WRITTEN: i64 = -1;
const IMPOSSIBLE: i64 = -2;

/// Numbers of positions, texture coordinates and normals.
pub(super) type Counts = [usize; 3];

/// Part and smoothing group of an element.
#[derive(Debug, Clone, Copy)]
pub(super) struct Membership {
    /// Number of the part.
    pub(super) part: u32,
    /// Smoothing group; 0 is none.
    pub(super) smoothing_group: u32,
    pub(super) location: Location,
}

/// The elements of a file, in file order.
#[derive(Debug, Default)]
pub(super) struct Elements {
    /// Positions of the triangles' corners.
    pub(super) triangles: Vec<[u32; 3]>,
    /// Texture coordinates of the triangles' corners; empty until a corner has one.
    pub(super) triangle_uvs: Vec<[u32; 3]>,
    /// Normals of the triangles' corners; empty until a corner has one.
    pub(super) triangle_normals: Vec<[u32; 3]>,
    /// Smoothing group of each triangle; empty while all are 0.
    pub(super) smoothing_groups: Vec<u32>,
    /// Starts of the runs of triangles of one part: first triangle, part.
    pub(super) runs: Vec<(usize, u32)>,
    /// Segments, each with its part.
    pub(super) lines: Vec<(u32, [Corner; 2])>,
    /// Points, each with its part.
    pub(super) points: Vec<(u32, Corner)>,
    /// Elements that refer to later vertices.
    deferred: Vec<Deferred>,
    scratch: Scratch,
}

#[derive(Debug)]
struct Deferred {
    kind: Kind,
    membership: Membership,
    corners: Vec<WrittenCorner>,
}

#[derive(Debug, Default)]
struct Scratch {
    written: Vec<WrittenCorner>,
    corners: Vec<Corner>,
    points: Vec<Vec3>,
    polygons: Polygons,
}

impl Elements {
    /// Starts an element.
    pub(super) fn begin(&mut self) {
        self.scratch.written.clear();
    }

    /// Adds the corner at the start of `text` to the element; returns its length in bytes. `None`
    /// if it has none of the four forms.
    #[inline]
    pub(super) fn add_corner(&mut self, text: &[u8], counts: Counts) -> Option<usize> {
        let mut indices = [NOT_WRITTEN; 3];
        let (position, mut at) = parse_i64(text)?;
        indices[0] = from_zero(position, counts[0]);
        for attribute in 1..3 {
            if text.get(at) != Some(&b'/') {
                break;
            }
            at += 1;
            if let Some((index, length)) = parse_i64(&text[at..]) {
                // Some exporters write 0 for "none".
                if index != 0 {
                    indices[attribute] = from_zero(index, counts[attribute]);
                }
                at += length;
            }
        }
        let ends = text
            .get(at)
            .is_none_or(|&byte| byte <= b' ' || byte == b'\\');
        self.scratch.written.push(WrittenCorner { indices });
        ends.then_some(at)
    }

    /// Number of corners of the element so far.
    pub(super) fn corner_count(&self) -> usize {
        self.scratch.written.len()
    }

    /// Ends an element: keeps it, or defers it if it refers to later vertices.
    #[inline]
    pub(super) fn end(
        &mut self,
        kind: Kind,
        membership: Membership,
        positions: &[Vec3],
        counts: Counts,
        context: &mut Context<'_>,
    ) -> Result<(), AssetError> {
        let written = std::mem::take(&mut self.scratch.written);
        let refers_ahead = written.iter().any(|corner| {
            corner
                .indices
                .iter()
                .zip(counts)
                .any(|(&index, count)| index >= count as i64)
        });
        if refers_ahead {
            self.deferred.push(Deferred {
                kind,
                membership,
                corners: written,
            });
            return Ok(());
        }
        let result = self.keep(kind, membership, &written, (positions, counts), context);
        self.scratch.written = written;
        result
    }

    /// Keeps the deferred elements, now that all vertices are known.
    pub(super) fn end_of_file(
        &mut self,
        positions: &[Vec3],
        counts: Counts,
        context: &mut Context<'_>,
    ) -> Result<(), AssetError> {
        for Deferred {
            kind,
            membership,
            corners,
        } in std::mem::take(&mut self.deferred)
        {
            self.keep(kind, membership, &corners, (positions, counts), context)?;
        }
        Ok(())
    }

    #[inline]
    fn keep(
        &mut self,
        kind: Kind,
        membership: Membership,
        written: &[WrittenCorner],
        (positions, counts): (&[Vec3], Counts),
        context: &mut Context<'_>,
    ) -> Result<(), AssetError> {
        self.scratch.corners.clear();
        for corner in written {
            let location = membership.location;
            let Some(corner) = corner.resolve(counts, location, context) else {
                return Ok(());
            };
            self.scratch.corners.push(corner);
        }
        match kind {
            Kind::Face => self.keep_face(membership, positions, context),
            Kind::Line => {
                let ends = self.scratch.corners.as_slice();
                let count = self.lines.len() + ends.len().saturating_sub(1);
                Limits::check("lines", count as u64, context.limits.max_triangles)?;
                let segments = ends
                    .windows(2)
                    .map(|ends| (membership.part, [ends[0], ends[1]]));
                self.lines.extend(segments);
                Ok(())
            }
            Kind::Points => {
                let corners = self.scratch.corners.iter();
                let count = self.points.len() + corners.len();
                Limits::check("points", count as u64, context.limits.max_triangles)?;
                self.points
                    .extend(corners.map(|&corner| (membership.part, corner)));
                Ok(())
            }
        }
    }

    #[inline]
    fn keep_face(
        &mut self,
        membership: Membership,
        positions: &[Vec3],
        context: &mut Context<'_>,
    ) -> Result<(), AssetError> {
        let first = self.triangles.len();
        if let &[a, b, c] = self.scratch.corners.as_slice() {
            self.push_triangle(a, b, c);
        } else {
            self.split_polygon(membership, positions, context);
        }
        let count = self.triangles.len();
        if count == first {
            return Ok(());
        }
        Limits::check("triangles", count as u64, context.limits.max_triangles)
            .map_err(|error| error.at(membership.location))?;
        self.end_triangles(first, membership.part, membership.smoothing_group);
        Ok(())
    }

    /// Keeps a run's triangles, as if each face were read here.
    pub(super) fn append(&mut self, run: &Run, part: u32, smoothing_group: u32) {
        let first = self.triangles.len();
        self.triangles.extend_from_slice(&run.triangles);
        let count = self.triangles.len();
        if count == first {
            return;
        }
        append_attributes(&mut self.triangle_uvs, first, &run.triangle_uvs, count);
        append_attributes(
            &mut self.triangle_normals,
            first,
            &run.triangle_normals,
            count,
        );
        self.end_triangles(first, part, smoothing_group);
    }

    /// Records the part and group of the triangles from `first` on.
    #[inline]
    fn end_triangles(&mut self, first: usize, part: u32, group: u32) {
        if self.runs.last().is_none_or(|&(_, last)| last != part) {
            self.runs.push((first, part));
        }
        if group != 0 || !self.smoothing_groups.is_empty() {
            self.smoothing_groups.resize(first, 0);
            self.smoothing_groups.resize(self.triangles.len(), group);
        }
    }

    /// Splits the polygon in `scratch.corners`.
    fn split_polygon(
        &mut self,
        membership: Membership,
        positions: &[Vec3],
        context: &mut Context<'_>,
    ) {
        let corners = std::mem::take(&mut self.scratch.corners);
        let mut polygons = std::mem::take(&mut self.scratch.polygons);
        self.scratch.points.clear();
        let points = corners
            .iter()
            .map(|corner| positions[corner.position as usize]);
        self.scratch.points.extend(points);
        let (triangles, is_spent) = polygons.split(&self.scratch.points);
        if is_spent {
            context
                .warnings
                .add(context.name, membership.location, || SPENT.to_owned());
        }
        for &[a, b, c] in triangles {
            self.push_triangle(
                corners[a as usize],
                corners[b as usize],
                corners[c as usize],
            );
        }
        self.scratch.polygons = polygons;
        self.scratch.corners = corners;
    }

    #[inline]
    fn push_triangle(&mut self, a: Corner, b: Corner, c: Corner) {
        let before = self.triangles.len();
        self.triangles.push([a.position, b.position, c.position]);
        push_attribute(&mut self.triangle_uvs, before, [a.uv, b.uv, c.uv]);
        push_attribute(
            &mut self.triangle_normals,
            before,
            [a.normal, b.normal, c.normal],
        );
    }
}

/// Appends an attribute of the triangle that follows `before` others, unless it and all before are
/// absent.
#[inline]
pub(super) fn push_attribute(attributes: &mut Vec<[u32; 3]>, before: usize, indices: [u32; 3]) {
    if attributes.is_empty() {
        if indices == [ABSENT; 3] {
            return;
        }
        attributes.resize(before, [ABSENT; 3]);
    }
    attributes.push(indices);
}

/// Appends the attributes of a run of triangles, which are `first..count`; none if all are absent.
fn append_attributes(
    attributes: &mut Vec<[u32; 3]>,
    first: usize,
    of_run: &[[u32; 3]],
    count: usize,
) {
    if attributes.is_empty() && of_run.is_empty() {
        return;
    }
    attributes.resize(first, [ABSENT; 3]);
    attributes.extend_from_slice(of_run);
    attributes.resize(count, [ABSENT; 3]);
}

/// An index from 0; negative ones count back from the end of the `count` elements known so far.
#[inline]
fn from_zero(index: i64, count: usize) -> i64 {
    match index {
        1.. => index - 1,
        0 => IMPOSSIBLE,
        _ => {
            let index = (count as i64).saturating_add(index);
            if index < 0 { IMPOSSIBLE } else { index }
        }
    }
}

impl WrittenCorner {
    /// The corner, if its position exists; attributes that do not exist become absent.
    #[inline]
    fn resolve(
        self,
        counts: Counts,
        location: Location,
        context: &mut Context<'_>,
    ) -> Option<Corner> {
        const NAMES: [&str; 3] = ["vertex", "texture coordinate", "normal"];
        let mut resolved = [ABSENT; 3];
        for (attribute, &index) in self.indices.iter().enumerate() {
            if index == NOT_WRITTEN {
                continue;
            }
            match u32::try_from(index) {
                Ok(small) if (small as usize) < counts[attribute] => resolved[attribute] = small,
                _ => context.warnings.add(context.name, location, || {
                    let outcome = if attribute == 0 {
                        "the element is omitted"
                    } else {
                        "it is ignored"
                    };
                    let (name, count) = (NAMES[attribute], counts[attribute]);
                    let which = if index == IMPOSSIBLE {
                        "its index is 0 or before the first".to_owned()
                    } else {
                        format!("number {} of {count}", index + 1)
                    };
                    format!("the {name} does not exist ({which}); {outcome}")
                }),
            }
        }
        let [position, uv, normal] = resolved;
        (position != ABSENT).then_some(Corner {
            position,
            uv,
            normal,
        })
    }
}
