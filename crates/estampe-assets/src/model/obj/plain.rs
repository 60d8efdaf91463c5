//! Plain lines, read ahead by several threads.
//!
//! Nearly all lines of a large file have four forms: `v x y z`, `vt u v`, `vn x y z`, and `f` with
//! three corners of indices from 1. Their meaning does not depend on the lines before them, so
//! threads read runs of them, window by window; any other line, and any irregularity, ends a run.
//! The reader processes the statements in order. At the start of a run it takes the whole run at
//! once, if the run's faces refer to existing vertices and the limits allow it. Otherwise it reads
//! the lines itself. Errors, warnings and the order of elements are therefore decided by the reader
//! alone.

use super::elements::{ABSENT, Counts, push_attribute};
use super::reader::Contents;
use crate::model::number::{leading_digits, parse_f32, parse_i64, parse_usual_f32};
use crate::model::statements::Statements;
use glam::{Vec2, Vec3};

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

/// Reads the runs of a window in order; memory of `spare` runs is used again.
pub(super) fn read_runs(bytes: &[u8], runs: &mut Vec<Run>, spare: &mut Vec<Run>) {
    let mut at = 0;
    while at < bytes.len() {
        let mut run = spare.pop().unwrap_or_default();
        let next = run.read(bytes, at);
        at = next_line(bytes, next);
        if run.line_ends >= LEAST_LINES {
            runs.push(run);
        } else {
            spare.push(run);
        }
    }
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
    /// Reads a run from the line at `start` up to the first line that is not plain; returns the
    /// start of that line.
    fn read(&mut self, bytes: &[u8], start: usize) -> usize {
        self.clear();
        (self.start, self.end) = (start, start);
        let mut next = start;
        // The lines before `next`.
        let mut lines = 0;
        while next < bytes.len() {
            if let Some(length) = self.read_usual_line(&bytes[next..]) {
                self.end = next + length;
                self.line_ends = lines;
                next = self.end + 1;
            } else {
                let mut statements = Statements::starting_at(bytes, next, lines);
                if self.read_line(&mut statements).is_none() {
                    break;
                }
                self.end = statements.at();
                self.line_ends = lines;
                if !statements.take_line_feed() {
                    return bytes.len();
                }
                next = statements.at();
            }
            lines += 1;
        }
        next
    }

    /// Forgets the contents and keeps the memory.
    fn clear(&mut self) {
        self.line_ends = 0;
        self.positions.clear();
        self.uvs.clear();
        self.normals.clear();
        self.triangles.clear();
        self.triangle_uvs.clear();
        self.triangle_normals.clear();
        self.needed = [0; 3];
    }

    /// Reads a plain line as nearly all programs write it: with spaces between words alone. Returns
    /// the place of its line feed; `None`, with the run unchanged, if it is any other line.
    #[inline]
    fn read_usual_line(&mut self, text: &[u8]) -> Option<usize> {
        match *text.first_chunk()? {
            [b'v', b' ', _] => {
                let (position, end) = usual_numbers(text, 2)?;
                let position = Vec3::from_array(position);
                // Other values need a warning.
                position
                    .is_finite()
                    .then(|| self.positions.push(position))?;
                Some(end)
            }
            [b'v', b't', b' '] => {
                let (uv, end) = usual_numbers(text, 3)?;
                self.uvs.push(Vec2::from_array(uv));
                Some(end)
            }
            [b'v', b'n', b' '] => {
                let (normal, end) = usual_numbers(text, 3)?;
                self.normals.push(Vec3::from_array(normal));
                Some(end)
            }
            [b'f', b' ', _] => {
                let mut corners = [[ABSENT; 3]; 3];
                let mut at = 1;
                for corner in &mut corners {
                    at = skip_spaces(text, at)?;
                    at = usual_corner(text, at, corner)?;
                }
                let end = usual_end(text, at)?;
                self.keep_triangle(corners);
                Some(end)
            }
            _ => None,
        }
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
        self.keep_triangle(corners);
        Some(())
    }

    #[inline]
    fn keep_triangle(&mut self, corners: [[u32; 3]; 3]) {
        let [positions, uvs, normals] =
            [0, 1, 2].map(|attribute| corners.map(|corner: [u32; 3]| corner[attribute]));
        let known = [self.positions.len(), self.uvs.len(), self.normals.len()];
        for ((needed, known), indices) in self
            .needed
            .iter_mut()
            .zip(known)
            .zip([positions, uvs, normals])
        {
            // An absent index becomes 0.
            let [a, b, c] = indices.map(|index| index.wrapping_add(1));
            let count = a.max(b).max(c) as usize;
            *needed = (*needed).max(count.saturating_sub(known));
        }
        let before = self.triangles.len();
        self.triangles.push(positions);
        push_attribute(&mut self.triangle_uvs, before, uvs);
        push_attribute(&mut self.triangle_normals, before, normals);
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

impl Contents {
    /// Appends a run's vertices.
    pub(super) fn append_vertices(&mut self, run: &Run) {
        self.positions.extend_from_slice(&run.positions);
        self.uvs.extend_from_slice(&run.uvs);
        self.normals.extend_from_slice(&run.normals);
        if !self.colors.is_empty() {
            self.colors.resize(self.positions.len(), Vec3::ONE);
        }
    }
}

/// The place after the spaces at `at`, of which there is at least one.
#[inline]
fn skip_spaces(text: &[u8], mut at: usize) -> Option<usize> {
    if text.get(at) != Some(&b' ') {
        return None;
    }
    while text.get(at) == Some(&b' ') {
        at += 1;
    }
    Some(at)
}

/// The place of the line feed that ends a line at `at`.
#[inline]
fn usual_end(text: &[u8], mut at: usize) -> Option<usize> {
    while text.get(at) == Some(&b' ') {
        at += 1;
    }
    at += usize::from(text.get(at) == Some(&b'\r'));
    (text.get(at) == Some(&b'\n')).then_some(at)
}

/// The numbers of a line after its keyword, exactly `N` of them, and the place of the line feed.
#[inline]
fn usual_numbers<const N: usize>(text: &[u8], keyword: usize) -> Option<([f32; N], usize)> {
    let mut numbers = [0.0; N];
    let mut at = keyword - 1;
    for slot in &mut numbers {
        at = skip_spaces(text, at)?;
        let number = text.get(at..)?;
        let (value, length) = parse_usual_f32(number).or_else(|| parse_f32(number))?;
        *slot = value;
        at += length;
    }
    Some((numbers, usual_end(text, at)?))
}

/// Reads a corner as [`plain_corner`] does, with indices of at most seven digits; returns the place
/// after it.
#[inline]
fn usual_corner(text: &[u8], mut at: usize, indices: &mut [u32; 3]) -> Option<usize> {
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
        let (index, length) = leading_digits(text.get(at..)?)?;
        // Eight digits may be followed by more. 0 depends on earlier lines.
        if length == 8 {
            return None;
        }
        *slot = u32::try_from(index).ok()?.checked_sub(1)?;
        at += length;
    }
    Some(at)
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
