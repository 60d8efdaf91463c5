//! A tile of one image, processed from texels to L*a*b* and features.

use estampe_scene::Image;

use super::color::{Colors, HuntLab};
use super::features::{self, Features};
use super::kernel::{Kernels, along_row, down_columns};

/// Size of a tile in pixels. With its surroundings and seven planes it stays within a second-level
/// cache.
pub(super) const TILE_WIDTH: usize = 256;
pub(super) const TILE_HEIGHT: usize = 64;

/// Colour spaces and filters for one viewing distance.
#[derive(Debug)]
pub(super) struct Observer {
    pub(super) kernels: Kernels,
    pub(super) colors: Colors,
}

/// The pixels of a tile, clipped to the image.
#[derive(Debug, Clone, Copy)]
pub(super) struct Area {
    pub(super) left: usize,
    pub(super) top: usize,
    pub(super) width: usize,
    pub(super) height: usize,
}

/// The memory of one tile, reused from tile to tile.
#[derive(Debug, Default)]
pub(super) struct Tile {
    /// A row of each YCxCz axis and of luminance, with its surroundings.
    padded: [Vec<f32>; 4],
    /// The rows with their surroundings above and below, filtered along the rows.
    row_filtered: RowFiltered,
    /// A row of each quantity, filtered along both axes.
    filtered: [Vec<f32>; 8],
    /// The perceived colours, row by row.
    pub(super) colors: Vec<HuntLab>,
    /// The strengths of edges and points, row by row.
    pub(super) features: Vec<Features>,
}

/// One plane for each kernel that is applied along the rows.
#[derive(Debug, Default)]
struct RowFiltered {
    luminance: Vec<f32>,
    red_green: Vec<f32>,
    blue_yellow: [Vec<f32>; 2],
    smooth: Vec<f32>,
    edge: Vec<f32>,
    point: Vec<f32>,
}

impl Tile {
    /// Computes `colors` and `features` of an area of `image` over a grey background. Outside the
    /// image, the border pixels are repeated.
    pub(super) fn fill(&mut self, image: &Image, area: Area, ground: u8, observer: &Observer) {
        self.filter_rows(image, area, ground, observer);
        self.colors.clear();
        self.features.clear();
        for y in 0..area.height {
            self.finish_row(y, area.width, observer);
        }
    }

    /// Filters each row of the area and its surroundings along x.
    fn filter_rows(&mut self, image: &Image, area: Area, ground: u8, observer: &Observer) {
        let Observer { kernels, colors } = observer;
        let (width, reach) = (area.width, kernels.reach);
        let len = (area.height + 2 * reach) * width;
        let planes = &mut self.row_filtered;
        let [narrow, wide] = &mut planes.blue_yellow;
        for plane in [
            &mut planes.luminance,
            &mut planes.red_green,
            narrow,
            wide,
            &mut planes.smooth,
            &mut planes.edge,
            &mut planes.point,
        ] {
            plane.resize(len, 0.0);
        }
        for padded in &mut self.padded {
            padded.resize(width + 2 * reach, 0.0);
        }

        let (picture_width, picture_height) = (image.width as usize, image.height as usize);
        for row in 0..area.height + 2 * reach {
            let y = (area.top + row)
                .saturating_sub(reach)
                .min(picture_height - 1);
            let texels = &image.rgba.as_chunks::<4>().0[y * picture_width..][..picture_width];
            let [luma, cx, cz, luminance] = &mut self.padded;
            for column in 0..width + 2 * reach {
                let x = (area.left + column)
                    .saturating_sub(reach)
                    .min(picture_width - 1);
                let color = colors.ycxcz(texels[x], ground);
                [luma[column], cx[column], cz[column]] = color;
                luminance[column] = (color[0] + 16.0) / 116.0;
            }
            let out = row * width..(row + 1) * width;
            along_row(luma, &kernels.luminance, &mut planes.luminance[out.clone()]);
            along_row(cx, &kernels.red_green, &mut planes.red_green[out.clone()]);
            for (plane, (taps, _)) in planes.blue_yellow.iter_mut().zip(&kernels.blue_yellow) {
                along_row(cz, taps, &mut plane[out.clone()]);
            }
            along_row(luminance, &kernels.smooth, &mut planes.smooth[out.clone()]);
            along_row(luminance, &kernels.edge, &mut planes.edge[out.clone()]);
            along_row(luminance, &kernels.point, &mut planes.point[out]);
        }
    }

    /// Filters row `y` along the columns and computes its colours and features.
    fn finish_row(&mut self, y: usize, width: usize, observer: &Observer) {
        let Observer { kernels, colors } = observer;
        let planes = &self.row_filtered;
        for row in &mut self.filtered {
            row.resize(width, 0.0);
        }
        let [
            luma,
            cx,
            cz_narrow,
            cz_wide,
            edge_x,
            edge_y,
            point_x,
            point_y,
        ] = &mut self.filtered;

        down_columns(&planes.luminance, y, &kernels.luminance, luma);
        down_columns(&planes.red_green, y, &kernels.red_green, cx);
        let [(narrow, narrow_share), (wide, wide_share)] = &kernels.blue_yellow;
        down_columns(&planes.blue_yellow[0], y, narrow, cz_narrow);
        down_columns(&planes.blue_yellow[1], y, wide, cz_wide);
        for x in 0..width {
            let cz = cz_narrow[x] * narrow_share + cz_wide[x] * wide_share;
            self.colors.push(colors.hunt_lab([luma[x], cx[x], cz]));
        }

        down_columns(&planes.edge, y, &kernels.smooth, edge_x);
        down_columns(&planes.smooth, y, &kernels.edge, edge_y);
        down_columns(&planes.point, y, &kernels.smooth, point_x);
        down_columns(&planes.smooth, y, &kernels.point, point_y);
        for x in 0..width {
            let (edge, point) = ([edge_x[x], edge_y[x]], [point_x[x], point_y[x]]);
            self.features.push(features::strengths(edge, point));
        }
    }
}
