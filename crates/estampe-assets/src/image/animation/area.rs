//! The part of a frame that differs from the frame before.

use estampe_scene::Image;

/// A rectangle of texels, which is not empty.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::image) struct Area {
    pub(in crate::image) x: u32,
    pub(in crate::image) y: u32,
    pub(in crate::image) width: u32,
    pub(in crate::image) height: u32,
}

impl Area {
    /// The whole image.
    pub(in crate::image) fn of(image: &Image) -> Self {
        Self {
            x: 0,
            y: 0,
            width: image.width,
            height: image.height,
        }
    }

    /// The area, grown to the left and to the top so that it begins at even coordinates.
    pub(super) fn with_even_corner(self) -> Self {
        let (x, y) = (self.x & !1, self.y & !1);
        Self {
            x,
            y,
            width: self.width + (self.x - x),
            height: self.height + (self.y - y),
        }
    }
}

/// The smallest area that holds every texel for which `is_in(column, row)`; the first texel if
/// there is none, because formats know no empty frames.
pub(in crate::image) fn area_of(image: &Image, is_in: impl Fn(usize) -> bool) -> Area {
    let width = image.width as usize;
    let (mut left, mut right) = (image.width, 0);
    let (mut top, mut bottom) = (image.height, 0);
    for y in 0..image.height {
        let row = y as usize * width;
        let columns = 0..image.width;
        let Some(first) = { columns.clone() }.find(|&x| is_in(row + x as usize)) else {
            continue;
        };
        let last = { columns }.rfind(|&x| is_in(row + x as usize));
        (left, right) = (left.min(first), right.max(last.unwrap_or(first) + 1));
        (top, bottom) = (top.min(y), y + 1);
    }
    if right == 0 {
        return Area {
            x: 0,
            y: 0,
            width: 1,
            height: 1,
        };
    }
    Area {
        x: left,
        y: top,
        width: right - left,
        height: bottom - top,
    }
}

/// The area in which a frame differs from the one before, of the same size.
pub(in crate::image) fn changed_area(before: &Image, frame: &Image) -> Area {
    let (old, new) = (
        before.rgba.as_chunks::<4>().0,
        frame.rgba.as_chunks::<4>().0,
    );
    area_of(frame, |at| old.get(at) != new.get(at))
}

/// The texels of an area.
pub(in crate::image) fn crop(image: &Image, area: Area) -> Image {
    let (row, from) = (image.width as usize * 4, area.x as usize * 4);
    let rows = image.rgba.chunks_exact(row.max(4));
    let rows = rows.skip(area.y as usize).take(area.height as usize);
    let parts = rows.flat_map(|row| &row[from..from + area.width as usize * 4]);
    Image {
        width: area.width,
        height: area.height,
        rgba: parts.copied().collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_area_holds_all_changes_and_no_more() {
        let before = Image::filled(7, 5, [9; 4]);
        let mut frame = before.clone();
        assert_eq!(changed_area(&before, &frame).width, 1, "none");
        for (x, y) in [(3, 1), (5, 3), (2, 2)] {
            frame.rgba[(y * 7 + x) * 4 + 2] = 8;
        }
        let area = changed_area(&before, &frame);
        let expected = Area {
            x: 2,
            y: 1,
            width: 4,
            height: 3,
        };
        assert_eq!(area, expected);
        let part = crop(&frame, area);
        assert_eq!((part.width, part.height, part.rgba.len()), (4, 3, 48));
        for y in 0..3 {
            for x in 0..4 {
                assert_eq!(part.texel(x, y), frame.texel(x + 2, y + 1));
            }
        }
        assert_eq!(area.with_even_corner().y, 0);
        assert_eq!(area.with_even_corner().height, 4);
        assert_eq!(area.with_even_corner().x, 2);
    }
}
