//! The observer that writes the history of a pixel.

use super::amplified::Made;
use super::history::{
    FragmentRecord, InspectedVertex, PieceVertex, PrimitiveKind, PrimitiveRecord, SampleRecord,
    SampleValues,
};
use estampe_reference::cull::Face;
use estampe_reference::fragment::quad_input;
use estampe_reference::observer::{Assembled, FragmentEvent, Observer, SampleEvent};
use estampe_reference::program::Shaders;
use estampe_reference::raster::{sample_positions, sample_subpixel};
use estampe_reference::shading::fetch_attributes;
use estampe_reference::{Draw, PixelBounds, StoredSample, WindowVertex, channel, color, raster};
use estampe_types::TextureFormat;

/// Writes the primitives of one draw that cover a pixel.
pub(super) struct Recorder<'a> {
    pub(super) pixel: [u32; 2],
    pub(super) draw_number: usize,
    pub(super) draw: &'a Draw<'a>,
    pub(super) shaders: &'a dyn Shaders,
    pub(super) samples: u32,
    pub(super) formats: &'a [Option<TextureFormat>],
    pub(super) primitives: Vec<PrimitiveRecord>,
    /// What the one primitive that is drawn was made of, if it was.
    made: Option<Made<'a>>,
    /// The primitive at hand.
    current: Current,
    /// True if the piece at hand is the last of `primitives`.
    is_recorded: bool,
}

/// The primitive at hand, and its piece.
#[derive(Default)]
struct Current {
    number: u64,
    instance: u32,
    positions: Vec<u32>,
    clip: Vec<([f32; 4], Vec<f32>)>,
    piece: Vec<PieceVertex>,
    snapped: Vec<[i32; 2]>,
    front_facing: bool,
}

impl<'a> Recorder<'a> {
    pub(super) fn new(
        (pixel, samples): ([u32; 2], u32),
        draw_number: usize,
        draw: &'a Draw<'a>,
        shaders: &'a dyn Shaders,
        formats: &'a [Option<TextureFormat>],
    ) -> Self {
        Self {
            pixel,
            draw_number,
            draw,
            shaders,
            samples,
            formats,
            primitives: Vec::new(),
            made: None,
            current: Current::default(),
            is_recorded: false,
        }
    }

    /// A recorder of one primitive that was made.
    pub(super) fn of_made(mut self, made: Made<'a>) -> Self {
        self.made = Some(made);
        self
    }

    fn set_piece(&mut self, vertices: &[WindowVertex], face: Face) {
        self.is_recorded = false;
        let current = &mut self.current;
        current.front_facing = face == Face::Front;
        current.snapped = vertices.iter().map(|vertex| vertex.snapped).collect();
        let piece = vertices.iter().map(|vertex| PieceVertex {
            position: vertex.snapped.map(|subpixels| subpixels as f32 / 256.0),
            depth: vertex.z,
            inverse_w: vertex.inverse_w,
        });
        current.piece = piece.collect();
    }

    /// The record of the piece at hand.
    fn record(&mut self) -> &mut PrimitiveRecord {
        if !self.is_recorded {
            let record = self.new_record();
            self.primitives.push(record);
            self.is_recorded = true;
        }
        self.primitives.last_mut().expect("just pushed")
    }

    fn new_record(&self) -> PrimitiveRecord {
        let current = &self.current;
        let positions = current.positions.iter().zip(&current.clip);
        let vertices = positions.map(|(&position, (clip, varyings))| match self.made {
            Some(_) => InspectedVertex {
                index: position,
                attributes: Vec::new(),
                clip: *clip,
                varyings: varyings.clone(),
            },
            None => InspectedVertex {
                index: self.draw.vertex_index(position),
                attributes: fetch_attributes(self.shaders, self.draw, position, current.instance),
                clip: *clip,
                varyings: varyings.clone(),
            },
        });
        let edges = <[[i32; 2]; 3]>::try_from(&current.snapped[..]).ok();
        let edges = edges.map(|corners| edge_functions(corners, self.pixel));
        let inverse_ws = |piece: &PieceVertex| piece.inverse_w.to_bits();
        let of_primitive = |(clip, _): &([f32; 4], Vec<f32>)| (1.0 / clip[3]).to_bits();
        let is_whole = current.piece.len() == current.clip.len()
            && current
                .piece
                .iter()
                .map(inverse_ws)
                .eq(current.clip.iter().map(of_primitive));
        PrimitiveRecord {
            draw: self.draw_number,
            primitive: self.made.map_or(current.number, |made| made.number),
            instance: self
                .made
                .map_or(current.instance, |made| made.primitive.instance),
            origin: self.made.map(|made| made.origin(self.draw)),
            vertices: vertices.collect(),
            kind: match current.piece.len() {
                1 => PrimitiveKind::Point,
                2 => PrimitiveKind::Line,
                _ => PrimitiveKind::Triangle,
            },
            piece: current.piece.clone(),
            is_clipped: current.piece.len() == current.clip.len() && !is_whole,
            front_facing: current.front_facing,
            is_culled: false,
            barycentrics: edges.map(|edges| {
                let sum: f64 = edges.iter().sum();
                edges.map(|edge| edge / sum)
            }),
            edges,
            fragments: Vec::new(),
        }
    }

    pub(super) fn values(&self, stored: &StoredSample) -> SampleValues {
        values(self.formats, stored)
    }
}

impl Observer for Recorder<'_> {
    fn primitive(&mut self, assembled: &Assembled<'_>) {
        let vertices = assembled.vertices.iter();
        self.current = Current {
            number: assembled.number,
            instance: assembled.instance,
            positions: assembled.positions.to_vec(),
            clip: vertices
                .map(|vertex| (vertex.position, vertex.varyings.clone()))
                .collect(),
            ..Current::default()
        };
        self.is_recorded = false;
    }

    fn piece(&mut self, vertices: &[WindowVertex], face: Face) {
        self.set_piece(vertices, face);
    }

    fn culled(&mut self, vertices: &[WindowVertex], face: Face) {
        self.set_piece(vertices, face);
        let Ok(mut corners) = <[[i32; 2]; 3]>::try_from(&self.current.snapped[..]) else {
            return;
        };
        corners.sort_by_key(|corner| [corner[1], corner[0]]);
        let [x, y] = self.pixel;
        let pixel = PixelBounds {
            x: x..x + 1,
            y: y..y + 1,
        };
        let quads = raster::triangle(corners, &pixel, self.samples);
        if quads.iter().any(|quad| quad.samples != [0; 4]) {
            self.record().is_culled = true;
        }
    }

    fn fragment(&mut self, event: &FragmentEvent<'_>) {
        if event.pixel != self.pixel {
            return;
        }
        let invocation = event.invocation;
        let mut input = quad_input(
            self.shaders,
            event.bindings,
            event.surface,
            invocation,
            event.clamp_depth,
        );
        let varyings = self.shaders.interface().varyings.len();
        let fragment = FragmentRecord {
            sample: invocation.sample,
            covered: event.covered,
            position: input.positions[event.lane],
            // Without the derivatives that follow them.
            varyings: input.varyings[event.lane].drain(..varyings).collect(),
            colors: event.fragment.colors.clone(),
            depth: event.fragment.depth,
            is_discarded: event.fragment.is_discarded,
            kept: event.stored,
            samples: Vec::new(),
        };
        self.record().fragments.push(fragment);
    }

    fn wants(&self, pixel: [u32; 2]) -> bool {
        pixel == self.pixel
    }

    fn sample(&mut self, event: SampleEvent) {
        let record = SampleRecord {
            sample: event.sample,
            depth: event.depth,
            outcome: event.outcome,
            before: self.values(&event.before),
            after: self.values(&event.after),
        };
        let fragments = &mut self.record().fragments;
        let fragment = fragments.last_mut().expect("its fragment was recorded");
        fragment.samples.push(record);
    }
}

/// The stored values as numbers.
pub(super) fn values(formats: &[Option<TextureFormat>], stored: &StoredSample) -> SampleValues {
    let colors = || formats.iter().zip(&stored.colors);
    SampleValues {
        colors: colors()
            .map(|(format, &codes)| format.map(|format| numbers(format, codes)))
            .collect(),
        codes: colors()
            .map(|(format, &codes)| format.map(|_| codes))
            .collect(),
        depth: stored.depth,
        stencil: stored.stencil,
    }
}

/// The numbers that codes stand for. Integer channels decode to the bits of an f32.
fn numbers(format: TextureFormat, codes: color::Codes) -> [f64; 4] {
    let decoded = color::decode(format, codes);
    let channels = channel::channels(format);
    std::array::from_fn(|k| match channels[k] {
        channel::Channel::Uint(_) => f64::from(decoded[k].to_bits()),
        channel::Channel::Sint(_) => f64::from(decoded[k].to_bits().cast_signed()),
        _ => f64::from(decoded[k]),
    })
}

/// Twice the areas that a pixel's centre makes with the edges opposite to each corner, positive
/// inside, in pixels².
fn edge_functions(corners: [[i32; 2]; 3], pixel: [u32; 2]) -> [f64; 3] {
    let corners = corners.map(|corner| corner.map(i64::from));
    let at = sample_subpixel(pixel.map(i64::from), sample_positions(1)[0]);
    let edge =
        |a: [i64; 2], b: [i64; 2]| (b[0] - a[0]) * (at[1] - a[1]) - (b[1] - a[1]) * (at[0] - a[0]);
    let [a, b, c] = corners;
    let edges = [edge(b, c), edge(c, a), edge(a, b)];
    let sign = if edges.iter().sum::<i64>() < 0 { -1 } else { 1 };
    edges.map(|value| (sign * value) as f64 / 65_536.0)
}
