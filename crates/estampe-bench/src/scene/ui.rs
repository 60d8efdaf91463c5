//! `ui`: what an immediate-mode user interface draws, with the states of egui: 30 windows over each
//! other, 600 rounded panels and 6,000 glyphs, in 150 draws with a scissor rectangle each.
//!
//! No depth; the picture is BGRA8, cleared to 32, 32, 40 of 255. Blending is premultiplied: colour
//! (one, one minus source alpha), alpha (one minus destination alpha, one). The only texture is an
//! atlas of 1024² texels with one channel and one level, linear, clamped. A vertex has a position
//! in pixels and a texture coordinate (2 floats each) and a premultiplied colour (4 bytes): 20
//! bytes. The uniform is the frame's width and height.
//!
//! Places are in points, of which 1280 are the frame's width. Windows with even numbers lie between
//! pixels, so that their text is filtered.

use super::passes::{Binding, ColorTarget, Frame, FrameDraw, FramePipeline, PICTURE, Pass, Step};
use super::{Detail, Scene, vertex_layout};
use crate::frame::FrameSize;
use crate::generate::{LittleEndian, MipChain, hash32, sin_cos_turns, unit_hash};
use estampe::state::{BlendComponent, BlendFactor, BlendState, ScissorRect};
use estampe::{TextureFormat, VertexFormat, ViewDimension};

const CLEAR: [f64; 4] = [32.0 / 255.0, 32.0 / 255.0, 40.0 / 255.0, 1.0];
/// The side of the atlas in texels.
const ATLAS: u32 = 1024;
/// The atlas's cells have this many texels on each side.
const CELL: u32 = 16;
/// Text has this many sizes; glyphs of size `n` are 8 + `n` points high.
const SIZES: u32 = 7;
/// The number of different glyphs of a size.
const GLYPHS: u32 = 512;

pub(super) fn scene(detail: Detail, size: FrameSize) -> Scene {
    let mut painter = Painter::new(size);
    for window in 0..detail.of(30, 8) {
        paint_window(&mut painter, window);
    }
    let mut uniforms = LittleEndian::default();
    uniforms.reals(&[f64::from(size.width), f64::from(size.height), 0.0, 0.0]);

    let text = include_str!("wgsl/ui.wgsl");
    let mut frame = Frame::new(size, TextureFormat::Bgra8Unorm, text);
    frame.textures = vec![(TextureFormat::R8Unorm, ViewDimension::D2)];
    let add = |src_factor, dst_factor| BlendComponent {
        src_factor,
        dst_factor,
        ..BlendComponent::default()
    };
    frame.pipeline(FramePipeline {
        vertex_buffers: vec![vertex_layout(
            20,
            &[
                (VertexFormat::Float32x2, 0),
                (VertexFormat::Float32x2, 8),
                (VertexFormat::Unorm8x4, 16),
            ],
        )],
        blend: Some(BlendState {
            color: add(BlendFactor::One, BlendFactor::OneMinusSrcAlpha),
            alpha: add(BlendFactor::OneMinusDstAlpha, BlendFactor::One),
        }),
        bindings: vec![
            Binding::Uniform(2),
            Binding::trilinear_clamp(),
            Binding::Texture(0),
        ],
        ..FramePipeline::default()
    });
    frame.steps.push(Step::Pass(Pass {
        colors: vec![ColorTarget::cleared(PICTURE, CLEAR)],
        depth: None,
        draws: painter.draws,
    }));
    let atlas = MipChain {
        size: ATLAS,
        levels: vec![atlas()],
    };
    let buffers = vec![
        painter.vertices.into_bytes(),
        painter.indices.into_bytes(),
        uniforms.into_bytes(),
    ];
    Scene::of_frame("ui", buffers, vec![atlas], frame)
}

/// A rectangle in points: its upper left corner and its size.
#[derive(Clone, Copy)]
struct Rectangle {
    x: f64,
    y: f64,
    width: f64,
    height: f64,
}

/// Triangles and draws so far.
struct Painter {
    size: FrameSize,
    pixels_per_point: f64,
    vertices: LittleEndian,
    vertex_count: u32,
    indices: LittleEndian,
    index_count: u32,
    draws: Vec<FrameDraw>,
}

impl Painter {
    fn new(size: FrameSize) -> Self {
        Self {
            size,
            pixels_per_point: f64::from(size.width) / 1280.0,
            vertices: LittleEndian::default(),
            vertex_count: 0,
            indices: LittleEndian::default(),
            index_count: 0,
            draws: Vec::new(),
        }
    }

    fn vertex(&mut self, position: [f64; 2], uv: [f64; 2], color: [u8; 4]) {
        let pixels = position.map(|coordinate| coordinate * self.pixels_per_point);
        self.vertices.reals(&pixels);
        self.vertices.reals(&uv);
        self.vertices.raw(&color);
        self.vertex_count += 1;
    }

    fn triangles(&mut self, indices: &[u32]) {
        self.indices.words(indices);
        self.index_count += u32::try_from(indices.len()).expect("six at most");
    }

    /// A rounded rectangle: a fan of 18 triangles up to half of `feather` inside its outline, and
    /// 40 triangles from there to nothing, half of it outside.
    fn panel(&mut self, area: Rectangle, radius: f64, feather: f64, color: [u8; 4]) {
        let first = self.vertex_count;
        let white = [8.0 / f64::from(ATLAS); 2];
        for corner in 0..4 {
            let center_x = match corner {
                0 | 3 => area.x + area.width - radius,
                _ => area.x + radius,
            };
            let center_y = match corner {
                0 | 1 => area.y + area.height - radius,
                _ => area.y + radius,
            };
            for step in 0..5 {
                let turns = f64::from(corner) * 0.25 + f64::from(step) * 0.0625;
                let (sine, cosine) = sin_cos_turns(turns);
                for (side, color) in [(-0.5, color), (0.5, [0; 4])] {
                    let distance = radius + feather * side;
                    let place = [center_x + cosine * distance, center_y + sine * distance];
                    self.vertex(place, white, color);
                }
            }
        }
        for step in 1..19 {
            self.triangles(&[first, first + 2 * step, first + 2 * step + 2]);
        }
        for step in 0..20 {
            let (here, next) = (first + 2 * step, first + 2 * ((step + 1) % 20));
            self.triangles(&[here, here + 1, next + 1, here, next + 1, next]);
        }
    }

    /// A line of glyphs from a place on; their characters follow from `seed`.
    fn text(&mut self, [left, y]: [f64; 2], size: u32, count: u32, seed: u32, color: [u8; 4]) {
        let mut x = left;
        for number in 0..count {
            let glyph = Glyph {
                size,
                character: hash32(seed + number) % GLYPHS,
            };
            let [u, v] = glyph.atlas_place();
            let first = self.vertex_count;
            for [right, down] in [[0, 0], [1, 0], [1, 1], [0, 1]] {
                let [dx, dy] = [right * glyph.width(), down * glyph.height()];
                let uv = [u + dx, v + dy].map(|texel| f64::from(texel) / f64::from(ATLAS));
                self.vertex([x + f64::from(dx), y + f64::from(dy)], uv, color);
            }
            self.triangles(&[0, 1, 2, 0, 2, 3].map(|corner| first + corner));
            x += f64::from(glyph.width()) + 1.0;
        }
    }

    /// Ends a draw of all triangles from an index on.
    fn draw(&mut self, first: u32, clip: Rectangle) {
        let scissor = self.scissor(clip);
        self.draws.push(FrameDraw {
            elements: first..self.index_count,
            scissor: Some(scissor),
            ..FrameDraw::indexed(0, 0, 1, 0)
        });
    }

    /// The pixels that a rectangle touches.
    fn scissor(&self, clip: Rectangle) -> ScissorRect {
        let scale = self.pixels_per_point;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a whole number between 0 and the frame's side"
        )]
        let edge = |place: f64, end: u32| place.clamp(0.0, f64::from(end)) as u32;
        let FrameSize { width, height } = self.size;
        let left = edge((clip.x * scale).floor(), width);
        let right = edge(((clip.x + clip.width) * scale).ceil(), width);
        let top = edge((clip.y * scale).floor(), height);
        let bottom = edge(((clip.y + clip.height) * scale).ceil(), height);
        ScissorRect {
            x: left,
            y: top,
            width: right - left,
            height: bottom - top,
        }
    }
}

/// A window of five draws: its frame with the title, then four rows of panels and text.
fn paint_window(painter: &mut Painter, number: u32) {
    let random = |k: u32| unit_hash(6000 + 8 * number + k);
    let width = 260.0 + (140.0 * random(0)).floor();
    let height = 190.0 + (90.0 * random(1)).floor();
    let mut x = (random(2) * (1280.0 - width)).floor();
    let mut y = (random(3) * (720.0 - height)).floor();
    if number.is_multiple_of(2) {
        (x, y) = (x + 0.25, y + 0.375);
    }
    let window = Rectangle {
        x,
        y,
        width,
        height,
    };
    let first = painter.index_count;
    paint_frame(painter, number, window, 30.0 + 80.0 * random(4));
    let clip = Rectangle {
        x: x - 12.0,
        y: y - 12.0,
        width: width + 24.0,
        height: height + 24.0,
    };
    painter.draw(first, clip);
    let row_height = (height - 32.0) / 4.0;
    for row in 0..4 {
        let first = painter.index_count;
        let clip = Rectangle {
            x: x + 6.0,
            y: y + 26.0 + f64::from(row) * row_height,
            width: width - 18.0,
            height: row_height - 4.0,
        };
        paint_row(painter, 4 * number + row, clip);
        painter.draw(first, clip);
    }
}

/// Shadow, frame, title bar, scroll bar and title.
fn paint_frame(painter: &mut Painter, number: u32, window: Rectangle, scroll_height: f64) {
    let Rectangle { x, y, width, .. } = window;
    let look = hash32(6300 + number);
    painter.panel(window, 14.0, 24.0, [0, 0, 0, 140]);
    painter.panel(window, 8.0, 1.0, tint(look, 24, 236));
    let title = Rectangle {
        x: x + 2.0,
        y: y + 2.0,
        width: width - 4.0,
        height: 20.0,
    };
    painter.panel(title, 7.0, 1.0, tint(look >> 2, 96, 255));
    let scroll = Rectangle {
        x: x + width - 9.0,
        y: y + 26.0,
        width: 6.0,
        height: scroll_height,
    };
    painter.panel(scroll, 3.0, 1.0, tint(look >> 4, 80, 160));
    painter.text([x + 10.0, y + 5.0], 5, 20, 20_000 + 32 * number, [255; 4]);
}

/// Four panels with a line of text over them, and a line below.
fn paint_row(painter: &mut Painter, row: u32, clip: Rectangle) {
    let seed = 30_000 + 512 * row;
    let y = clip.y + 2.0 - (10.0 * unit_hash(6500 + row)).floor();
    let spacing = clip.width / 4.0;
    for panel in 0..4 {
        let alpha = if panel == 3 { 150 } else { 255 };
        let area = Rectangle {
            x: clip.x + f64::from(panel) * spacing + 1.0,
            y,
            width: spacing - 4.0,
            height: 22.0,
        };
        let radius = 2.0 + 2.0 * f64::from(panel);
        painter.panel(area, radius, 1.0, tint(hash32(seed + panel), 64, alpha));
    }
    let size = hash32(seed + 8) % SIZES;
    let light = [240, 240, 240, 255];
    painter.text([clip.x + 6.0, y + 4.0], size, 22, seed + 16, light);
    let color = tint(hash32(seed + 9), 150, 220);
    let below = [clip.x + 2.0, y + 26.0];
    painter.text(below, (size + 3) % SIZES, 23, seed + 64, color);
}

/// A premultiplied colour from the three low bytes of a hash: each `base` to `base` + 63.
fn tint(hash: u32, base: u32, alpha: u32) -> [u8; 4] {
    let [red, green, blue, _] = hash.to_le_bytes();
    let [red, green, blue] =
        [red, green, blue].map(|bits| byte((base + u32::from(bits & 63)) * alpha / 255));
    [red, green, blue, byte(alpha)]
}

/// A glyph of the atlas.
#[derive(Clone, Copy)]
struct Glyph {
    /// Below [`SIZES`].
    size: u32,
    /// Below [`GLYPHS`].
    character: u32,
}

impl Glyph {
    /// In points, and in texels of the atlas.
    fn height(self) -> u32 {
        8 + self.size
    }

    fn width(self) -> u32 {
        self.height() - self.character % 4
    }

    /// Its upper left texel, one inside its cell.
    fn atlas_place(self) -> [u32; 2] {
        let (column, row) = (self.character % 64, self.character / 64);
        [column * CELL + 1, (1 + 8 * self.size + row) * CELL + 1]
    }

    /// Random bits on a lattice of 5 × 7 places, interpolated bilinearly, with more contrast.
    fn texel(self, x: u32, y: u32) -> u8 {
        let key = 7000 + GLYPHS * self.size + self.character;
        let node = |column: u32, row: u32| hash32(key + 65_536 * (5 * row + column)) >> 31;
        // The place in the lattice, in 64ths.
        let [across, down] = [x * 4 * 64 / self.width(), y * 6 * 64 / self.height()];
        let (column, right) = (across / 64, across % 64);
        let (row, below) = (down / 64, down % 64);
        let along = |row: u32| node(column, row) * (64 - right) + node(column + 1, row) * right;
        let value = (along(row) * (64 - below) + along(row + 1) * below) / 16;
        byte((value.saturating_sub(64) * 2).min(255))
    }
}

/// White in the first cell, then every glyph in a cell of its own.
fn atlas() -> Vec<u8> {
    let mut texels = vec![0; (ATLAS * ATLAS) as usize];
    let place = |x: u32, y: u32| (y * ATLAS + x) as usize;
    for y in 0..CELL {
        texels[place(0, y)..place(CELL, y)].fill(255);
    }
    for size in 0..SIZES {
        for character in 0..GLYPHS {
            let glyph = Glyph { size, character };
            let [left, top] = glyph.atlas_place();
            for y in 0..glyph.height() {
                for x in 0..glyph.width() {
                    texels[place(left + x, top + y)] = glyph.texel(x, y);
                }
            }
        }
    }
    texels
}

/// A number of at most 255 as a byte.
fn byte(value: u32) -> u8 {
    u8::try_from(value).expect("colours and texels are at most 255")
}
