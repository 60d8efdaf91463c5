//! The methods, from polygons to a picture.

use super::passes::Passes;
use crate::DrawError;
use crate::eye::Eye;
use crate::painter::by_centre;
use crate::picture::View;
use crate::polygon::{Corner, Polygon};
use estampe::Device;
use estampe_scene::Image;

/// The method by which transparent polygons are blended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Transparency {
    /// Polygons from the one with the farthest centre on.
    Sorted,
    /// Fragments of each pixel from the farthest on, whatever the order of the polygons.
    Exact,
    /// Weighted sums of all fragments: an approximation that needs no order and one pass.
    Weighted,
}

/// Draws opaque polygons (red, green, blue) and transparent ones (red, green, blue, alpha, not
/// premultiplied) before them; numbers from 0 to 1 as the picture stores them. Blending is in
/// 32-bit floats, rounded once to the picture's 8 bits. `eye` sorts, if the method does.
/// Transparent fragments at the depth of an opaque one are hidden.
///
/// # Errors
/// [`DrawError`] if the picture or the polygons do not fit the device.
pub fn draw(
    device: &Device,
    (view, eye): (&View, Eye),
    opaque: &[Polygon<3>],
    transparent: &[Polygon<4>],
    method: Transparency,
) -> Result<Image, DrawError> {
    let all = || transparent.iter().map(Polygon::corners);
    let passes = Passes::new(device, view, opaque)?;
    match method {
        Transparency::Sorted => {
            let order = by_centre(transparent, eye);
            passes.blend(
                order
                    .iter()
                    .map(|number| transparent[*number as usize].corners()),
            )?;
        }
        Transparency::Exact => passes.peel(all())?,
        Transparency::Weighted => passes.weigh(all())?,
    }
    passes.image()
}

/// Draws as [`draw`] does, transparent convex polygons in the order in which they come, such as
/// that of a [BSP tree](crate::bsp).
///
/// # Errors
/// [`DrawError`] as for [`draw`].
pub fn draw_in_order<'p>(
    device: &Device,
    view: &View,
    opaque: &[Polygon<3>],
    transparent: impl Iterator<Item = &'p [Corner<4>]>,
) -> Result<Image, DrawError> {
    let passes = Passes::new(device, view, opaque)?;
    passes.blend(transparent)?;
    passes.image()
}
