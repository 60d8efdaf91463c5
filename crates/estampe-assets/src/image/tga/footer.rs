//! The footer and extension area of TGA 2, for the meaning of alpha.

use super::header::HEADER_LEN;

/// The last 18 bytes of a TGA 2 file.
const SIGNATURE: &[u8; 18] = b"TRUEVISION-XFILE.\0";

/// Footer: extension area offset (4), developer area offset (4), signature (18).
const FOOTER_LEN: usize = 26;

/// Offset of the attributes type in the extension area, whose length is at least one more.
const ATTRIBUTES_TYPE_AT: usize = 494;

/// Meaning of alpha by the extension area (field 24).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum AttributesType {
    /// 0, 1, 2: no alpha, or data to ignore or to keep.
    Meaningless,
    /// 3: alpha.
    Alpha,
    /// 4: alpha; the colours are premultiplied by it.
    PremultipliedAlpha,
}

/// The footer of a file without extension and developer areas.
pub(super) fn plain_footer() -> [u8; FOOTER_LEN] {
    let mut footer = [0; FOOTER_LEN];
    footer[8..].copy_from_slice(SIGNATURE);
    footer
}

/// The footer, if the file ends in one.
pub(super) fn find(bytes: &[u8]) -> Option<&[u8; FOOTER_LEN]> {
    bytes
        .last_chunk::<FOOTER_LEN>()
        .filter(|footer| footer.ends_with(SIGNATURE))
}

/// The attributes type, if a footer points to an extension area that lies inside the file.
///
/// The area is optional, so a wrong offset is ignored and no error: the colours do not depend on
/// it.
pub(super) fn attributes_type(bytes: &[u8]) -> Option<AttributesType> {
    let footer = find(bytes)?;
    let offset = u32::from_le_bytes([footer[0], footer[1], footer[2], footer[3]]) as usize;
    if offset < HEADER_LEN {
        return None;
    }
    let area = bytes.get(offset..bytes.len() - FOOTER_LEN)?;
    let len = usize::from(u16::from_le_bytes([*area.first()?, *area.get(1)?]));
    if len <= ATTRIBUTES_TYPE_AT {
        return None;
    }
    match *area.get(ATTRIBUTES_TYPE_AT)? {
        0..=2 => Some(AttributesType::Meaningless),
        3 => Some(AttributesType::Alpha),
        4 => Some(AttributesType::PremultipliedAlpha),
        _ => None,
    }
}
