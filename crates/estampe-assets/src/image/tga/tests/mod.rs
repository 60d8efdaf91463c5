//! TGA: fixtures written by hand, round trips, and damaged files.

mod hostile;
mod read;
mod write;

/// A TGA file assembled field by field; each test changes the fields that it tests.
#[derive(Debug, Clone)]
struct Fixture {
    kind: u8,
    depth: u8,
    descriptor: u8,
    width: u16,
    height: u16,
    id: Vec<u8>,
    /// First index, number of entries, bits of an entry.
    map: Option<(u16, u16, u8)>,
    map_bytes: Vec<u8>,
    texels: Vec<u8>,
    /// The attributes type of a TGA 2 extension area.
    attributes: Option<u8>,
}

/// Rows run from the top, columns from the left.
const TOP_LEFT: u8 = 0x20;

impl Fixture {
    fn new(kind: u8, depth: u8, (width, height): (u16, u16), texels: &[u8]) -> Self {
        Self {
            kind,
            depth,
            descriptor: TOP_LEFT,
            width,
            height,
            id: Vec::new(),
            map: None,
            map_bytes: Vec::new(),
            texels: texels.to_vec(),
            attributes: None,
        }
    }

    fn bytes(&self) -> Vec<u8> {
        let (first, len, bits) = self.map.unwrap_or_default();
        let mut out = vec![self.id.len() as u8, u8::from(self.map.is_some()), self.kind];
        out.extend_from_slice(&first.to_le_bytes());
        out.extend_from_slice(&len.to_le_bytes());
        out.push(bits);
        // Origin on the screen: not used, so it must have no effect.
        out.extend_from_slice(&[17, 0, 99, 2]);
        out.extend_from_slice(&self.width.to_le_bytes());
        out.extend_from_slice(&self.height.to_le_bytes());
        out.extend_from_slice(&[self.depth, self.descriptor]);
        out.extend_from_slice(&self.id);
        out.extend_from_slice(&self.map_bytes);
        out.extend_from_slice(&self.texels);
        if let Some(attributes) = self.attributes {
            let offset = out.len() as u32;
            let mut area = [0; 495];
            area[..2].copy_from_slice(&495_u16.to_le_bytes());
            area[494] = attributes;
            out.extend_from_slice(&area);
            out.extend_from_slice(&offset.to_le_bytes());
            out.extend_from_slice(&[0; 4]);
            out.extend_from_slice(b"TRUEVISION-XFILE.\0");
        }
        out
    }
}
