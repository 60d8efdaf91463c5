//! The header: elements, properties and encoding of the body.

use crate::model::detect::is_ply;
use crate::model::load::Context;
use crate::model::textures::text_of_name;
use crate::{AssetError, Limits, Location};

/// Encoding of the body's values.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Encoding {
    Ascii,
    Little,
    Big,
}

/// The type of a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

/// One value, or a list with its length before it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    One(Scalar),
    List { length: Scalar, item: Scalar },
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Property {
    pub(super) name: String,
    pub(super) kind: Kind,
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Element {
    pub(super) name: String,
    /// As stated; the body may be shorter.
    pub(super) count: u64,
    pub(super) properties: Vec<Property>,
    /// The line of the header, from 1.
    pub(super) line: Location,
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Header {
    pub(super) encoding: Encoding,
    pub(super) elements: Vec<Element>,
    /// The names given by `comment TextureFile`.
    pub(super) texture_files: Vec<(String, Location)>,
    /// Start of the body, in bytes.
    pub(super) body_byte: usize,
    pub(super) body_line: u64,
}

impl Scalar {
    /// The type by its name, old or new.
    fn from_name(name: &str) -> Option<Self> {
        Some(match name {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => return None,
        })
    }

    pub(super) fn len_bytes(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    pub(super) fn is_integer(self) -> bool {
        !matches!(self, Self::F32 | Self::F64)
    }
}

impl Element {
    /// The index of the property with one of these names.
    pub(super) fn position(&self, names: &[&str]) -> Option<usize> {
        self.properties
            .iter()
            .position(|property| names.contains(&property.name.as_str()))
    }

    /// The fewest plausible bytes of one element in the body, with three items per list.
    pub(super) fn least_bytes(&self, encoding: Encoding) -> usize {
        let least = |property: &Property| match (encoding, property.kind) {
            // A digit and a blank per value.
            (Encoding::Ascii, Kind::One(_)) => 2,
            (Encoding::Ascii, Kind::List { .. }) => 8,
            (_, Kind::One(scalar)) => scalar.len_bytes(),
            (_, Kind::List { length, item }) => length.len_bytes() + 3 * item.len_bytes(),
        };
        self.properties.iter().map(least).sum()
    }
}

impl Header {
    const MAX_ELEMENTS: u64 = 256;
    const MAX_PROPERTIES: u64 = 1024;

    /// Reads the header at the start of `bytes`.
    pub(super) fn read(bytes: &[u8], context: &Context<'_>) -> Result<Self, AssetError> {
        if !is_ply(bytes) {
            return Err(AssetError::malformed(
                "it does not start with `ply`",
                "check that it is a PLY file",
            )
            .at(Location::Line(1)));
        }
        let mut header = Self {
            encoding: Encoding::Ascii,
            elements: Vec::new(),
            texture_files: Vec::new(),
            body_byte: 0,
            body_line: 0,
        };
        let mut has_format = false;
        let mut lines = Lines {
            bytes,
            at: 0,
            line: 0,
        };
        while let Some(line) = lines.next() {
            let text = text_of_name(line);
            let mut words = text.split_ascii_whitespace();
            let location = Location::Line(lines.line);
            let malformed = |what: String| {
                AssetError::malformed(what, "export the model again, or correct the header")
                    .at(location)
            };
            match words.next() {
                Some("end_header") if has_format => {
                    header.body_byte = lines.at;
                    header.body_line = lines.line + 1;
                    return Ok(header);
                }
                Some("end_header") => {
                    return Err(malformed("the header has no format".to_owned()));
                }
                Some("format") => {
                    has_format = true;
                    header.encoding = match words.next() {
                        Some("ascii") => Encoding::Ascii,
                        Some("binary_little_endian") => Encoding::Little,
                        Some("binary_big_endian") => Encoding::Big,
                        other => {
                            let name = other.unwrap_or_default();
                            return Err(malformed(format!("`{name}` is not a PLY format")));
                        }
                    };
                }
                Some("comment") => {
                    if let Some(name) = text.trim().strip_prefix("comment").map(str::trim_start)
                        && let Some(name) = name.strip_prefix("TextureFile")
                        && (header.texture_files.len() as u64) < context.limits.max_materials
                    {
                        header
                            .texture_files
                            .push((name.trim().to_owned(), location));
                    }
                }
                Some("element") => {
                    let element = read_element(&mut words, location).map_err(malformed)?;
                    header.elements.push(element);
                    let count = header.elements.len() as u64;
                    Limits::check("elements", count, Self::MAX_ELEMENTS)?;
                }
                Some("property") => {
                    let property = read_property(&mut words).map_err(malformed)?;
                    let Some(element) = header.elements.last_mut() else {
                        return Err(malformed("a property precedes all elements".to_owned()));
                    };
                    element.properties.push(property);
                    let count = element.properties.len() as u64;
                    Limits::check("properties", count, Self::MAX_PROPERTIES)?;
                }
                // `obj_info`, and unknown lines.
                _ => {}
            }
        }
        Err(AssetError::malformed(
            "the header has no `end_header`",
            "check that the file is complete",
        )
        .at(Location::Line(lines.line)))
    }
}

/// `NAME COUNT`
fn read_element<'a>(
    words: &mut impl Iterator<Item = &'a str>,
    line: Location,
) -> Result<Element, String> {
    let name = words.next().ok_or("an element has no name")?.to_owned();
    let count = words.next().unwrap_or_default();
    let count = count
        .parse()
        .map_err(|_| format!("`{count}` is not a number of `{name}` elements"))?;
    Ok(Element {
        name,
        count,
        properties: Vec::new(),
        line,
    })
}

/// `TYPE NAME` or `list LENGTH_TYPE ITEM_TYPE NAME`
fn read_property<'a>(words: &mut impl Iterator<Item = &'a str>) -> Result<Property, String> {
    fn scalar(name: Option<&str>) -> Result<Scalar, String> {
        let name = name.unwrap_or_default();
        Scalar::from_name(name).ok_or_else(|| format!("`{name}` is not a type of values"))
    }
    let first = words.next();
    let kind = if first == Some("list") {
        let length = scalar(words.next())?;
        let item = scalar(words.next())?;
        if !length.is_integer() {
            return Err("the length of a list must be an integer".to_owned());
        }
        Kind::List { length, item }
    } else {
        Kind::One(scalar(first)?)
    };
    let name = words.next().ok_or("a property has no name")?.to_owned();
    Ok(Property { name, kind })
}

/// The lines of a header, which end with LF, CR LF or CR.
struct Lines<'a> {
    bytes: &'a [u8],
    at: usize,
    /// Number of the last returned line.
    line: u64,
}

impl<'a> Lines<'a> {
    fn next(&mut self) -> Option<&'a [u8]> {
        let rest = &self.bytes[self.at..];
        let length = rest
            .iter()
            .position(|&byte| byte == b'\n' || byte == b'\r')?;
        let is_pair = rest[length..].starts_with(b"\r\n");
        // A binary body may start with a byte that looks like LF: CR LF counts as one end only if
        // the first line ended so too.
        let is_pair = is_pair && (self.line == 0 || self.ends_with_pairs());
        self.at += length + 1 + usize::from(is_pair);
        self.line += 1;
        Some(&rest[..length])
    }

    fn ends_with_pairs(&self) -> bool {
        let first_end = self
            .bytes
            .iter()
            .position(|&byte| byte == b'\n' || byte == b'\r');
        first_end.is_some_and(|at| self.bytes[at..].starts_with(b"\r\n"))
    }
}
