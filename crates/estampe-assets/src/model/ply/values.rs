//! The body as a stream of scalars.

use super::header::{Element, Encoding, Header, Kind, Scalar};
use super::triangle_rows;
use crate::model::number::{parse_f32, parse_i64};
use crate::model::statements::Statements;
use crate::{AssetError, Location};
use estampe_scene::Workers;

/// The reason why a value could not be read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Fault {
    /// The file ends here.
    End,
    /// The text is not a number.
    NoNumber,
    /// A list with a negative length.
    NegativeLength,
}

/// Marks an index that is not the index of a vertex.
pub(super) const NO_VERTEX: u32 = u32::MAX;

/// The index, if it is one of `count` vertices.
#[inline]
pub(super) fn vertex_index(index: f64, count: usize) -> Option<u32> {
    let is_vertex = index >= 0.0 && index < count as f64 && index < f64::from(NO_VERTEX);
    #[expect(clippy::cast_possible_truncation, reason = "it is below 2^32")]
    #[expect(clippy::cast_sign_loss, reason = "it is not negative")]
    is_vertex.then_some(index as u32)
}

/// A reader of values, one after the other. All types fit f64 exactly.
pub(super) trait Values: Sized + Send {
    /// The next value.
    fn next(&mut self, scalar: Scalar) -> Result<f64, Fault>;

    /// Skips `count` values.
    fn skip(&mut self, count: u64, scalar: Scalar) -> Result<(), Fault>;

    /// Appends `count` indices to `out`; those that are not below `vertex_count` become
    /// [`NO_VERTEX`].
    #[inline]
    fn next_indices(
        &mut self,
        scalar: Scalar,
        count: u64,
        vertex_count: usize,
        out: &mut Vec<u32>,
    ) -> Result<(), Fault> {
        for _ in 0..count {
            let index = self.next(scalar)?;
            out.push(vertex_index(index, vertex_count).unwrap_or(NO_VERTEX));
        }
        Ok(())
    }

    /// Readers of the next `count` rows of `row_bytes`, which are skipped, with `rows_each` rows
    /// per reader except the last. `None`, with nothing skipped, if the encoding has no rows of
    /// constant length, or the file is too short.
    fn take_rows(
        &mut self,
        _count: u64,
        _row_bytes: usize,
        _rows_each: usize,
    ) -> Option<Vec<Self>> {
        None
    }

    /// Reads and skips faces up to the first that is not a plain triangle, if the encoding has rows
    /// of known length; the element must satisfy [`triangle_rows::can_be_rows`].
    fn take_triangles(
        &mut self,
        _count: u64,
        _vertex_count: usize,
        _workers: Workers,
    ) -> Vec<[u32; 3]> {
        Vec::new()
    }

    /// Called after each element: in ASCII, each element is a line.
    fn end_row(&mut self);

    /// Location of the next value.
    fn location(&self) -> Location;

    /// Number of remaining bytes.
    fn len_bytes(&self) -> usize;

    fn encoding(&self) -> Encoding;

    /// Reads the length of a list.
    #[inline]
    fn next_length(&mut self, scalar: Scalar) -> Result<u64, Fault> {
        let length = self.next(scalar)?;
        if length < 0.0 {
            return Err(Fault::NegativeLength);
        }
        #[expect(
            clippy::cast_possible_truncation,
            reason = "lengths are integers below 2^32"
        )]
        #[expect(clippy::cast_sign_loss, reason = "it is not negative")]
        Ok(length as u64)
    }

    /// Skips a property.
    fn skip_property(&mut self, kind: Kind) -> Result<(), Fault> {
        match kind {
            Kind::One(scalar) => self.skip(1, scalar),
            Kind::List { length, item } => {
                let length = self.next_length(length)?;
                self.skip(length, item)
            }
        }
    }

    /// Skips an unknown element; `false` if the file ends in it.
    fn skip_element(&mut self, element: &Element) -> Result<bool, AssetError> {
        if element.properties.is_empty() {
            return Ok(true);
        }
        for _ in 0..element.count {
            for property in &element.properties {
                match self.skip_property(property.kind) {
                    Ok(()) => {}
                    Err(fault) => return self.ends_here(fault),
                }
            }
            self.end_row();
        }
        Ok(true)
    }

    /// `false` for the end of the file, an error for any other fault.
    fn ends_here(&self, fault: Fault) -> Result<bool, AssetError> {
        match fault {
            Fault::End => Ok(false),
            other => Err(self.error(other)),
        }
    }

    /// The error for the user.
    fn error(&self, fault: Fault) -> AssetError {
        let (what, advice) = match fault {
            Fault::End => ("the file ends too early", "check that the file is complete"),
            Fault::NoNumber => ("a number was expected", "export the model again"),
            Fault::NegativeLength => ("a list has a negative length", "export the model again"),
        };
        AssetError::malformed(what, advice).at(self.location())
    }

    /// Upper bound of the number of `element`: at most the stated one, and at most what the bytes
    /// suffice for. Memory for so many may be reserved.
    fn plausible_count(&self, element: &Element) -> usize {
        let least = element.least_bytes(self.encoding()).max(1);
        let possible = self.len_bytes() / least + 1;
        usize::try_from(element.count)
            .unwrap_or(usize::MAX)
            .min(possible)
    }
}

/// Values in text.
#[derive(Debug)]
pub(super) struct Ascii<'a> {
    statements: Statements<'a>,
}

impl<'a> Ascii<'a> {
    pub(super) fn new(bytes: &'a [u8], header: &Header) -> Self {
        Self {
            statements: Statements::starting_at(bytes, header.body_byte, header.body_line),
        }
    }
}

impl Values for Ascii<'_> {
    #[inline]
    fn next(&mut self, scalar: Scalar) -> Result<f64, Fault> {
        if !self.statements.find_word() {
            return Err(Fault::End);
        }
        let text = self.statements.remaining();
        if scalar.is_integer()
            && let Some((value, length)) = parse_i64(text)
            && text.get(length).is_none_or(|&byte| byte <= b' ')
        {
            self.statements.advance(length);
            // No value beyond 2^32 is meaningful.
            return Ok(value.clamp(-(1 << 40), 1 << 40) as f64);
        }
        let (value, length) = parse_f32(text).ok_or(Fault::NoNumber)?;
        if text.get(length).is_some_and(|&byte| byte > b' ') {
            return Err(Fault::NoNumber);
        }
        self.statements.advance(length);
        Ok(f64::from(value))
    }

    fn skip(&mut self, count: u64, scalar: Scalar) -> Result<(), Fault> {
        for _ in 0..count {
            self.next(scalar)?;
        }
        Ok(())
    }

    #[inline]
    fn end_row(&mut self) {
        self.statements.skip_statement();
    }

    fn location(&self) -> Location {
        self.statements.location()
    }

    fn len_bytes(&self) -> usize {
        self.statements.remaining().len()
    }

    fn encoding(&self) -> Encoding {
        Encoding::Ascii
    }
}

/// Values in binary, most significant byte first if `BIG`.
#[derive(Debug)]
pub(super) struct Binary<'a, const BIG: bool> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a, const BIG: bool> Binary<'a, BIG> {
    pub(super) fn new(bytes: &'a [u8], header: &Header) -> Self {
        Self {
            bytes,
            at: header.body_byte,
        }
    }

    #[inline]
    fn take<const N: usize>(&mut self) -> Result<[u8; N], Fault> {
        let chunk = self.bytes.get(self.at..).and_then(<[u8]>::first_chunk);
        let mut chunk = *chunk.ok_or(Fault::End)?;
        self.at += N;
        if BIG {
            chunk.reverse();
        }
        Ok(chunk)
    }
}

impl<const BIG: bool> Values for Binary<'_, BIG> {
    #[inline]
    fn next(&mut self, scalar: Scalar) -> Result<f64, Fault> {
        // `take` has turned the bytes to little-endian.
        Ok(match scalar {
            Scalar::I8 => f64::from(i8::from_le_bytes(self.take()?)),
            Scalar::U8 => f64::from(u8::from_le_bytes(self.take()?)),
            Scalar::I16 => f64::from(i16::from_le_bytes(self.take()?)),
            Scalar::U16 => f64::from(u16::from_le_bytes(self.take()?)),
            Scalar::I32 => f64::from(i32::from_le_bytes(self.take()?)),
            Scalar::U32 => f64::from(u32::from_le_bytes(self.take()?)),
            Scalar::F32 => f64::from(f32::from_le_bytes(self.take()?)),
            Scalar::F64 => f64::from_le_bytes(self.take()?),
        })
    }

    /// The usual types are read at once: one check of the length, and no conversion through f64.
    #[inline]
    fn next_indices(
        &mut self,
        scalar: Scalar,
        count: u64,
        vertex_count: usize,
        out: &mut Vec<u32>,
    ) -> Result<(), Fault> {
        if !matches!(scalar, Scalar::I32 | Scalar::U32) {
            for _ in 0..count {
                let index = self.next(scalar)?;
                out.push(vertex_index(index, vertex_count).unwrap_or(NO_VERTEX));
            }
            return Ok(());
        }
        let rest = self.bytes.get(self.at..).unwrap_or(&[]);
        let bytes = usize::try_from(count)
            .ok()
            .and_then(|count| count.checked_mul(4));
        let bytes = bytes
            .and_then(|bytes| rest.get(..bytes))
            .ok_or(Fault::End)?;
        self.at += bytes.len();
        out.extend(bytes.as_chunks::<4>().0.iter().map(|&chunk| {
            let index = if BIG {
                u32::from_be_bytes(chunk)
            } else {
                u32::from_le_bytes(chunk)
            };
            // A negative i32 is a u32 beyond all vertices.
            if (index as usize) < vertex_count {
                index
            } else {
                NO_VERTEX
            }
        }));
        Ok(())
    }

    fn take_rows(&mut self, count: u64, row_bytes: usize, rows_each: usize) -> Option<Vec<Self>> {
        let bytes = usize::try_from(count).ok()?.checked_mul(row_bytes)?;
        let rows = self.bytes.get(self.at..)?.get(..bytes)?;
        self.at += bytes;
        let parts = rows.chunks(row_bytes.checked_mul(rows_each)?.max(1));
        Some(parts.map(|bytes| Self { bytes, at: 0 }).collect())
    }

    fn take_triangles(
        &mut self,
        count: u64,
        vertex_count: usize,
        workers: Workers,
    ) -> Vec<[u32; 3]> {
        // A closure, not a pointer to a function, which would be called for each index.
        let index = |bytes| {
            if BIG {
                u32::from_be_bytes(bytes)
            } else {
                u32::from_le_bytes(bytes)
            }
        };
        let rest = self.bytes.get(self.at..).unwrap_or(&[]);
        let triangles = triangle_rows::read(rest, count, vertex_count, index, workers);
        self.at += triangles.len() * triangle_rows::ROW_BYTES;
        triangles
    }

    fn skip(&mut self, count: u64, scalar: Scalar) -> Result<(), Fault> {
        let bytes = usize::try_from(count)
            .ok()
            .and_then(|count| count.checked_mul(scalar.len_bytes()))
            .filter(|&bytes| bytes <= self.len_bytes())
            .ok_or(Fault::End)?;
        self.at += bytes;
        Ok(())
    }

    #[inline]
    fn end_row(&mut self) {}

    fn location(&self) -> Location {
        Location::Byte(self.at as u64)
    }

    fn len_bytes(&self) -> usize {
        self.bytes.len().saturating_sub(self.at)
    }

    fn encoding(&self) -> Encoding {
        if BIG { Encoding::Big } else { Encoding::Little }
    }
}
