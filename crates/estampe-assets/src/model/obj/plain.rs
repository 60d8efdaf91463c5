//! Plain lines, read ahead by several threads.
//!
//! Nearly all lines of a large file have four forms: `v x y z`, `vt u v`, `vn x y z`, and `f` with
//! three corners of indices from 1. Their meaning does not depend on the lines before them, so
//! threads read runs of them; any other line, and any irregularity, ends a run. The reader
//! processes the statements in order. At the start of a run it takes the whole run at once, if the
//! run's faces refer to existing vertices and the limits allow it. Otherwise it reads the lines
//! itself. Errors, warnings and the order of elements are therefore decided by the reader alone.

use super::elements::{ABSENT, Counts, push_attribute};
use super::reader::Contents;
use crate::model::number::parse_i64;
use crate::model::statements::Statements;
use estampe_scene::{Workers, pieces};
use glam::{Vec2, Vec3};

/// Bytes of a piece: a millisecond of work.
const PIECE: usize = 1 << 20;
/// Shorter runs cost more than they save.
const LEAST_LINES: u64 = 256;

/// A run of plain lines.
#[derive(Debug, Default)]
pub(super) struct Run {
    /// Start of its first line.
    pub(super) start: usize,
    /// End of its last line, before the line end.
    pub(super) end: usize,
    /// Number of line ends in between.
    pub(super) line_ends: u64,
    pub(super) positions: Vec<Vec3>,
    pub(super) uvs: Vec<Vec2>,
    pub(super) normals: Vec<Vec3>,
    pub(super) triangles: Vec<[u32; 3]>,
    /// As long as `triangles`, or empty if no corner has one.
    pub(super) triangle_uvs: Vec<[u32; 3]>,
    pub(super) triangle_normals: Vec<[u32; 3]>,
    /// Number of vertices of each kind that must exist before the run.
    needed: Counts,
}

/// The runs of a file, in order.
pub(super) fn runs(bytes: &[u8], workers: Workers) -> Vec<Run> {
    if bytes.len() < PIECE {
        return Vec::new();
    }
    let of_pieces = workers.map(pieces(bytes.len(), PIECE), |range| {
        let mut runs = Vec::new();
        // A piece has the lines that start in it.
        let mut at = match range.start.checked_sub(1) {
            None => 0,
            Some(before) => next_line(bytes, before),
        };
        while at < range.end {
            let (run, next) = Run::read(bytes, at, range.end);
            if run.line_ends >= LEAST_LINES {
                runs.push(run);
            }
            at = next_line(bytes, next);
        }
        runs
    });
    of_pieces.into_iter().flatten().collect()
}

/// The start of the line after the one that `at` is in.
fn next_line(bytes: &[u8], at: usize) -> usize {
    let rest = bytes.get(at..).unwrap_or(&[]);
    match rest.iter().position(|&byte| byte == b'\n') {
        Some(length) => at + length + 1,
        None => bytes.len(),
    }
}

impl Run {
    /// The run from the line at `start` up to the first line that is not plain or starts at `limit`
    /// or later; also returns the start of that line.
    fn read(bytes: &[u8], start: usize, limit: usize) -> (Self, usize) {
        let mut run = Self {
            start,
            end: start,
            ..Self::default()
        };
        let mut statements = Statements::starting_at(bytes, start, 0);
        let mut next = start;
        while next < limit {
            let line = statements.line();
            if run.read_line(&mut statements).is_none() {
                break;
            }
            run.end = statements.at();
            run.line_ends = line;
            if !statements.take_line_feed() {
                next = bytes.len();
                break;
            }
            next = statements.at();
        }
        (run, next)
    }

    /// Reads a plain line up to its end; leaves the run unchanged if the line is not plain.
    #[inline]
    fn read_line(&mut self, statements: &mut Statements<'_>) -> Option<()> {
        let text = statements.remaining();
        match *text.first_chunk()? {
            [b'v', b' '] => {
                let position = Vec3::from_array(numbers(statements, 2)?);
                // Other values need a warning.
                position.is_finite().then(|| self.positions.push(position))
            }
            [b'v', b't'] if text.get(2) == Some(&b' ') => {
                self.uvs.push(Vec2::from_array(numbers(statements, 3)?));
                Some(())
            }
            [b'v', b'n'] if text.get(2) == Some(&b' ') => {
                self.normals.push(Vec3::from_array(numbers(statements, 3)?));
                Some(())
            }
            [b'f', b' '] => self.read_triangle(statements),
            _ => None,
        }
    }

    #[inline]
    fn read_triangle(&mut self, statements: &mut Statements<'_>) -> Option<()> {
        let line = statements.line();
        statements.advance(2);
        let mut corners = [[ABSENT; 3]; 3];
        for corner in &mut corners {
            if statements.is_at_end() {
                return None;
            }
            let (indices, length) = plain_corner(statements.remaining())?;
            statements.advance(length);
            *corner = indices;
        }
        if !ends(statements, line) {
            return None;
        }
        let [positions, uvs, normals] =
            [0, 1, 2].map(|attribute| corners.map(|corner: [u32; 3]| corner[attribute]));
        let known = [self.positions.len(), self.uvs.len(), self.normals.len()];
        for ((needed, known), indices) in self
            .needed
            .iter_mut()
            .zip(known)
            .zip([positions, uvs, normals])
        {
            for index in indices.into_iter().filter(|&index| index != ABSENT) {
                *needed = (*needed).max((index as usize + 1).saturating_sub(known));
            }
        }
        let before = self.triangles.len();
        self.triangles.push(positions);
        push_attribute(&mut self.triangle_uvs, before, uvs);
        push_attribute(&mut self.triangle_normals, before, normals);
        Some(())
    }

    /// True if taking the run after `contents` gives the same result as reading it line by line.
    pub(super) fn fits(&self, counts: Counts, triangles: usize, most: (u64, u64)) -> bool {
        let own = [self.positions.len(), self.uvs.len(), self.normals.len()];
        let (max_vertices, max_triangles) = most;
        let mut kinds = counts.iter().zip(own).zip(self.needed);
        kinds.all(|((&before, own), needed)| {
            before >= needed && (before + own) as u64 <= max_vertices
        }) && (triangles + self.triangles.len()) as u64 <= max_triangles
    }
}

impl Contents<'_> {
    /// Appends a run's vertices.
    pub(super) fn append_vertices(&mut self, run: &Run) {
        self.positions.extend_from_slice(&run.positions);
        self.uvs.extend_from_slice(&run.uvs);
        self.normals.extend_from_slice(&run.normals);
        if !self.colors.is_empty() {
            self.colors.resize(self.positions.len(), Vec3::ONE);
        }
    }

    /// Reserves memory for all runs at once: they are most of the file, or few.
    pub(super) fn reserve(&mut self, runs: &[Run]) {
        let sum = |count: fn(&Run) -> usize| runs.iter().map(count).sum();
        self.positions.reserve_exact(sum(|run| run.positions.len()));
        self.uvs.reserve_exact(sum(|run| run.uvs.len()));
        self.normals.reserve_exact(sum(|run| run.normals.len()));
        let elements = &mut self.elements;
        let triangles = &mut elements.triangles;
        triangles.reserve_exact(sum(|run| run.triangles.len()));
        let uvs = sum(|run| run.triangle_uvs.len());
        elements.triangle_uvs.reserve_exact(uvs);
        let normals = sum(|run| run.triangle_normals.len());
        elements.triangle_normals.reserve_exact(normals);
    }
}

/// True if the statement ends here, without a comment, in the line in which it began.
#[inline]
fn ends(statements: &mut Statements<'_>, line: u64) -> bool {
    // A statement that goes on over a line's end has changed the number of the line.
    statements.is_at_end() && statements.line() == line && !statements.remaining().starts_with(b"#")
}

/// The numbers of a line after its keyword, exactly `N` of them.
#[inline]
fn numbers<const N: usize>(statements: &mut Statements<'_>, keyword: usize) -> Option<[f32; N]> {
    let line = statements.line();
    statements.advance(keyword);
    let mut numbers = [0.0; N];
    for slot in &mut numbers {
        *slot = statements.number()??;
    }
    ends(statements, line).then_some(numbers)
}

/// A corner `v`, `v/vt`, `v//vn` or `v/vt/vn` of indices from 1, as indices from 0; and its length.
#[inline]
fn plain_corner(text: &[u8]) -> Option<([u32; 3], usize)> {
    let mut indices = [ABSENT; 3];
    let mut at = 0;
    for (attribute, slot) in indices.iter_mut().enumerate() {
        if attribute > 0 {
            if text.get(at) != Some(&b'/') {
                break;
            }
            at += 1;
            if attribute == 1 && text.get(at) == Some(&b'/') {
                continue;
            }
        }
        let (index, length) = parse_i64(text.get(at..)?)?;
        // 0 and indices from the end depend on earlier lines.
        *slot = u32::try_from(index.checked_sub(1)?).ok()?;
        if *slot == ABSENT {
            return None;
        }
        at += length;
    }
    let ends = text.get(at).is_none_or(|&byte| byte <= b' ');
    ends.then_some((indices, at))
}
