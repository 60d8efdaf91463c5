//! The contents of every sample of every attachment, in one form for the oracle and the fast path.

use crate::case::Case;
use estampe_types::TextureFormat;

/// Returns true if `read_color` gives the bytes of an attachment with this format.
#[must_use]
pub fn is_read_as_color(format: TextureFormat) -> bool {
    matches!(
        format,
        TextureFormat::Rgba8Unorm | TextureFormat::Rgba8UnormSrgb
    )
}

/// The contents of a target.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Stored {
    /// Rows of texels, for each attachment and each of its samples, attachment 0 first.
    pub texels: Vec<Vec<u8>>,
    /// Rows of resolved texels of each attachment, if the target is multisampled.
    pub resolved: Vec<Vec<u8>>,
    /// The bits of the depths, by sample.
    pub depths: Vec<Vec<u32>>,
    /// The stencil values, by sample.
    pub stencils: Vec<Vec<u8>>,
}

impl Stored {
    /// A description of the first difference from `wanted`; `None` if they are equal.
    #[must_use]
    pub fn difference(&self, wanted: &Self, case: &Case) -> Option<String> {
        let (samples, pixels) = (case.samples as usize, case.size[0] * case.size[1]);
        let place = |byte: usize, len: usize| {
            let texel = byte / (len / pixels as usize).max(1);
            let width = case.size[0] as usize;
            (texel % width, texel / width)
        };
        for (name, got, wanted) in [
            ("texels", &self.texels, &wanted.texels),
            ("resolved texels", &self.resolved, &wanted.resolved),
            ("stencils", &self.stencils, &wanted.stencils),
        ] {
            for (number, (got, wanted)) in got.iter().zip(wanted).enumerate() {
                let mut bytes = got.iter().zip(wanted);
                if let Some(at) = bytes.position(|(got, wanted)| got != wanted) {
                    let size = (wanted.len() / pixels as usize).max(1);
                    let texel = at - at % size..at - at % size + size;
                    return Some(format!(
                        "{name} {number} (attachment and sample: {} and {}): at {:?} fast path {:02x?}, oracle {:02x?}",
                        number / samples,
                        number % samples,
                        place(at, wanted.len()),
                        got.get(texel.clone()),
                        wanted.get(texel),
                    ));
                }
                if got.len() != wanted.len() {
                    return Some(format!(
                        "{name} {number}: {} bytes, oracle {}",
                        got.len(),
                        wanted.len()
                    ));
                }
            }
            if got.len() != wanted.len() {
                return Some(format!(
                    "{name}: {} lists, oracle {}",
                    got.len(),
                    wanted.len()
                ));
            }
        }
        for (sample, (got, wanted)) in self.depths.iter().zip(&wanted.depths).enumerate() {
            let mut depths = got.iter().zip(wanted);
            if let Some(at) = depths.position(|(got, wanted)| got != wanted) {
                return Some(format!(
                    "depths of sample {sample}: at {:?} fast path {}, oracle {}",
                    place(at, wanted.len()),
                    f32::from_bits(got[at]),
                    f32::from_bits(wanted[at]),
                ));
            }
        }
        (self != wanted).then(|| "the lists of depths differ in number or length".to_owned())
    }
}
