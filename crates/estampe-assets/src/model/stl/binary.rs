//! Binary STL.

use super::joined;
use crate::model::detect::binary_stl_length;
use crate::model::load::Context;
use crate::model::srgb::linear_from_srgb;
use crate::model::textures::text_of_name;
use crate::{AssetError, Limits, Location};
use estampe_scene::Mesh;
use glam::Vec3;

const HEADER_BYTES: usize = 84;
const TRIANGLE_BYTES: usize = 50;
type Record = [u8; TRIANGLE_BYTES];

/// Reads the existing triangles, even if the header states more or fewer.
pub(super) fn read(bytes: &[u8], context: &mut Context<'_>) -> Result<Mesh, AssetError> {
    let Some(announced_bytes) = binary_stl_length(bytes) else {
        return Err(AssetError::malformed(
            "it neither starts with `solid` nor is long enough to be a binary STL file",
            "check that it is an STL file and complete",
        )
        .at(Location::Byte(bytes.len() as u64)));
    };
    let (header, body) = bytes.split_at(HEADER_BYTES);
    let records = body.as_chunks::<TRIANGLE_BYTES>().0;
    let announced = (announced_bytes - HEADER_BYTES as u64) / TRIANGLE_BYTES as u64;
    if records.is_empty() && announced > 0 {
        return Err(AssetError::malformed(
            format!("the header states {announced} triangles and the file has none"),
            "check that it is an STL file and complete",
        )
        .at(Location::Byte(bytes.len() as u64)));
    }
    let count = records
        .len()
        .min(usize::try_from(announced).unwrap_or(usize::MAX));
    let records = &records[..count];
    Limits::check("triangles", count as u64, context.limits.max_triangles)?;
    Limits::check("triangles' corners", 3 * count as u64, u64::from(u32::MAX))?;
    if !is_plausible(records) {
        return Err(AssetError::malformed(
            "the magnitudes of its coordinates are spread like random bytes",
            "check that it is an STL file",
        )
        .at(Location::Byte(HEADER_BYTES as u64)));
    }
    if (count as u64) < announced {
        context
            .warnings
            .add(context.name, Location::Byte(bytes.len() as u64), || {
                format!("the header states {announced} triangles, the file ends after {count}")
            });
    } else if announced_bytes < bytes.len() as u64 {
        let extra = bytes.len() as u64 - announced_bytes;
        context
            .warnings
            .add(context.name, Location::Byte(announced_bytes), || {
                format!("{extra} bytes follow the stated triangles; they are ignored")
            });
    }

    let colors = Colors::of(header, records);
    let corner = |index: usize| {
        let record = &records[index / 3];
        let tag = colors.map_or(0, |_| attribute(record));
        (corner(record, 12 + index % 3 * 12), tag)
    };
    let (mut mesh, tags) = joined(name(header), count, corner, context.workers);
    if let Some(colors) = colors {
        mesh.colors = tags.iter().map(|&tag| colors.linear(tag)).collect();
    }
    Ok(mesh)
}

/// False if the positions are not those of any object.
///
/// A binary STL has no magic word: every file with this extension is one, and random bytes of the
/// right length are one by content. The exponents of random floats are uniform, so the third
/// quartile of the corners' greatest coordinates is some 10²⁰ times the first, and many are not
/// finite. Corners of an object have magnitudes of a few orders, wherever it is; those at the
/// origin are left out.
fn is_plausible(records: &[Record]) -> bool {
    const EXAMINED: usize = 4096;
    /// With fewer corners quartiles mean nothing.
    const LEAST: usize = 24;
    const MOST_SPREAD: f32 = 1e9;
    let step = (records.len() / EXAMINED).max(1);
    let corners = records
        .iter()
        .step_by(step)
        .flat_map(|record| [12, 24, 36].map(|at| corner(record, at)));
    let sizes = corners.map(|corner| corner.abs().max_element());
    let mut sizes: Vec<f32> = sizes
        .filter(|size| *size > 0.0 && size.is_finite())
        .collect();
    if sizes.len() < LEAST {
        return true;
    }
    let at = sizes.len() / 4;
    let (_, &mut third, _) = sizes.select_nth_unstable_by(at * 3, f32::total_cmp);
    let (_, &mut first, _) = sizes[..at * 3].select_nth_unstable_by(at, f32::total_cmp);
    third / first <= MOST_SPREAD
}

/// The header's text up to the first control character.
fn name(header: &[u8]) -> String {
    let text = header[..80]
        .split(|&byte| byte < b' ')
        .next()
        .unwrap_or(&[])
        .trim_ascii();
    text_of_name(text)
}

#[inline]
fn corner(record: &Record, at: usize) -> Vec3 {
    let component = |at: usize| {
        f32::from_le_bytes([record[at], record[at + 1], record[at + 2], record[at + 3]])
    };
    Vec3::new(component(at), component(at + 4), component(at + 8))
}

#[inline]
fn attribute(record: &Record) -> u16 {
    u16::from_le_bytes([record[48], record[49]])
}

/// Colour convention of the attributes.
#[derive(Debug, Clone, Copy)]
enum Colors {
    VisCam,
    Magics { default: [u8; 4] },
}

impl Colors {
    const VALID: u16 = 1 << 15;

    /// `None` if the attributes are not colours.
    fn of(header: &[u8], records: &[Record]) -> Option<Self> {
        let marked = header[..80]
            .windows(10)
            .find(|window| window.starts_with(b"COLOR="));
        if let Some(&[.., r, g, b, a]) = marked {
            return Some(Self::Magics {
                default: [r, g, b, a],
            });
        }
        // Without a mark the attributes could have any meaning; colours have bit 15, and triangles
        // without a colour have 0.
        let mut attributes = records.iter().map(attribute);
        let is_plausible = attributes.all(|value| value == 0 || value & Self::VALID != 0);
        let first = records.first().map(attribute)?;
        let is_constant = records.iter().all(|record| attribute(record) == first);
        (is_plausible && !(is_constant && (first == 0 || first == u16::MAX)))
            .then_some(Self::VisCam)
    }

    fn linear(self, attribute: u16) -> [f32; 4] {
        let five_bits = |shift: u16| f32::from(attribute >> shift & 31) / 31.0;
        let is_bit_set = attribute & Self::VALID != 0;
        let (rgb, alpha) = match self {
            Self::VisCam if is_bit_set => ([five_bits(10), five_bits(5), five_bits(0)], 1.0),
            Self::VisCam => ([1.0; 3], 1.0),
            Self::Magics {
                default: [r, g, b, a],
            } if is_bit_set => (
                [r, g, b].map(|value| f32::from(value) / 255.0),
                f32::from(a) / 255.0,
            ),
            Self::Magics { .. } => ([five_bits(0), five_bits(5), five_bits(10)], 1.0),
        };
        let [r, g, b] = rgb.map(linear_from_srgb);
        [r, g, b, alpha]
    }
}
