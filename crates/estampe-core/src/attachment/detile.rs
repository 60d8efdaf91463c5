//! From storage order to rows of texels, sixteen columns at a time.
//!
//! A packet's sixteen lanes are in Morton order, so each row of four pixels is two pairs of lanes:
//!
//! ```text
//!     lanes  0  1  4  5     pairs  0 2     row 0 = pair 0, pair 2
//!            2  3  6  7            1 3     row 1 = pair 1, pair 3
//!            8  9 12 13            4 6     row 2 = pair 4, pair 6
//!           10 11 14 15            5 7     row 3 = pair 5, pair 7
//! ```
//!
//! With pairs as elements of 64 bits, a register of 128 bits holds two pairs in order, and a row is
//! the zip of two registers: four loads, four zips and four stores move a packet. Rows that are
//! built from single lanes in memory and then loaded as a whole take three times as long, because
//! each load waits for the smaller stores before it. Where one register holds the sixteen lanes,
//! texels of two words are brought into the order of rows by four permutations of whole registers.
//!
//! A job is sixteen rows: sixteen packets of a 16×16 square lie one after the other, so reading and
//! writing go through whole cache lines.

use super::DepthStencilTexels;
use super::resolve::{MAX_PACKET, Mean};
use crate::layout::TileGrid;
use estampe_simd::{
    Bytes, LANES, Lanes, Level, SimdBase, SimdSplit, dispatch, f64x2, outline, u8x16, u8x32, u16x8,
    u32x4, u32x8, u32x16,
};

/// Columns, and rows, that are written together.
pub(super) const SQUARE: usize = 16;

/// Rows of a packet, and columns.
pub(super) const PACKET_SIDE: usize = 4;

/// The most bytes of a texel.
pub(super) const MAX_BYTES: usize = 16;

/// An attachment as it is stored.
#[derive(Debug, Clone, Copy)]
pub(super) struct StoredTexels<'a> {
    /// What the words of a packet are made of.
    pub(super) words: StoredWords<'a>,
    /// The tile layout, which gives the position of each packet.
    pub(super) grid: TileGrid,
    /// Words of a texel: 1, 2 or 4.
    pub(super) words_each: usize,
}

/// Where the words of a packet's texels come from.
#[derive(Debug, Clone, Copy)]
pub(super) enum StoredWords<'a> {
    /// Stored as they are, by packet, word of the texel and lane.
    One(&'a [u32]),
    /// The mean of several samples, which are stored by packet, sample, word of the texel and lane.
    Mean {
        words: &'a [u32],
        samples: usize,
        mean: Mean,
    },
    /// The words in row order of depths and stencil values.
    DepthStencil(&'a DepthStencilTexels),
}

impl StoredTexels<'_> {
    /// The words of a packet's texels; they are made in `scratch` where they are not stored.
    #[inline(always)]
    fn packet<'s, S: Lanes>(
        &'s self,
        s: S,
        packet: usize,
        scratch: &'s mut [u32; MAX_PACKET],
    ) -> &'s [u32] {
        outline!(s, {
            let elements = LANES * self.words_each;
            match &self.words {
                StoredWords::One(words) => &words[packet * elements..][..elements],
                StoredWords::Mean {
                    words,
                    samples,
                    mean,
                } => {
                    let texels = &mut scratch[..elements];
                    mean.write(
                        s,
                        &words[packet * elements * samples..][..elements * samples],
                        texels,
                    );
                    texels
                }
                StoredWords::DepthStencil(image) => {
                    let texels = &mut scratch[..elements];
                    image.write_packet(s, packet, texels);
                    texels
                }
            }
        })
    }
}

/// Rows of an image, up to sixteen, that one worker fills.
#[derive(Debug)]
pub(crate) struct RowsJob<'a> {
    stored: StoredTexels<'a>,
    /// Bytes of a texel: 1, 2, 4, 8 or 16.
    bytes_each: usize,
    /// Texels of a row.
    width: usize,
    /// The number of the first row, a multiple of sixteen.
    first_y: u32,
    /// The rows' bytes.
    rows: &'a mut [u8],
}

impl<'a> RowsJob<'a> {
    /// Cuts the filling of an image, whose bytes are whole rows of `width` texels, into jobs.
    pub(super) fn all(
        stored: StoredTexels<'a>,
        width: usize,
        bytes_each: usize,
        image: &'a mut [u8],
    ) -> impl Iterator<Item = Self> {
        let rows = image.chunks_mut(width * bytes_each * SQUARE);
        rows.zip((0..).step_by(SQUARE))
            .map(move |(rows, first_y)| Self {
                stored,
                bytes_each,
                width,
                first_y,
                rows,
            })
    }

    /// The bytes of the rows.
    pub(super) fn bytes_mut(&mut self) -> &mut [u8] {
        self.rows
    }

    /// Fills the rows.
    pub(crate) fn run(&mut self, level: Level) {
        match self.bytes_each {
            1 => dispatch!(level, s => self.fill::<_, 1, 1>(s)),
            2 => dispatch!(level, s => self.fill::<_, 1, 2>(s)),
            4 => dispatch!(level, s => self.fill::<_, 1, 4>(s)),
            8 => dispatch!(level, s => self.fill::<_, 2, 8>(s)),
            16 => dispatch!(level, s => self.fill::<_, 4, 16>(s)),
            bytes => unreachable!("a renderable texel has 1, 2, 4, 8 or 16 bytes, not {bytes}"),
        }
    }

    #[inline(always)]
    fn fill<S: Lanes, const WORDS: usize, const BYTES: usize>(&mut self, s: S) {
        let row_bytes = self.width * BYTES;
        let mut scratch = [[0; MAX_PACKET]; 4];
        let mut edge = [[0_u8; SQUARE * MAX_BYTES]; PACKET_SIDE];
        let mut x = 0;
        while x < self.width {
            let columns = (self.width - x).min(SQUARE);
            let bands = self.rows.chunks_mut(row_bytes * PACKET_SIDE);
            for (band, y) in bands.zip((self.first_y..).step_by(PACKET_SIDE)) {
                #[expect(
                    clippy::cast_possible_truncation,
                    reason = "a target's side has 15 bits"
                )]
                let first = self.stored.grid.packet_of(x as u32, y);
                let [a, b, c, d] = &mut scratch;
                // Four packets beside each other, in Morton order.
                let packets = [
                    self.stored.packet(s, first, a),
                    self.stored.packet(s, first + 1, b),
                    self.stored.packet(s, first + 4, c),
                    self.stored.packet(s, first + 5, d),
                ];
                if columns == SQUARE && band.len() == row_bytes * PACKET_SIDE {
                    let to = rows_of_band(band, row_bytes, x * BYTES, SQUARE * BYTES);
                    write_rows::<S, WORDS, BYTES>(s, packets, to);
                } else {
                    write_rows::<S, WORDS, BYTES>(
                        s,
                        packets,
                        edge.each_mut().map(|row| &mut row[..]),
                    );
                    for (row, from) in band.chunks_mut(row_bytes).zip(&edge) {
                        let to = &mut row[x * BYTES..][..columns * BYTES];
                        to.copy_from_slice(&from[..columns * BYTES]);
                    }
                }
            }
            x += SQUARE;
        }
    }
}

/// So many bytes of each of a band's four rows, from a byte on. With a constant length, stores into
/// them need no test.
#[inline(always)]
pub(super) fn rows_of_band(
    band: &mut [u8],
    row_bytes: usize,
    from: usize,
    len: usize,
) -> [&mut [u8]; PACKET_SIDE] {
    let (upper, lower) = band.split_at_mut(row_bytes * 2);
    let (first, second) = upper.split_at_mut(row_bytes);
    let (third, fourth) = lower.split_at_mut(row_bytes);
    [
        &mut first[from..][..len],
        &mut second[from..][..len],
        &mut third[from..][..len],
        &mut fourth[from..][..len],
    ]
}

/// Writes four packets that lie beside each other: sixteen texels at the begin of each of four
/// rows.
#[inline(always)]
pub(super) fn write_rows<S: Lanes, const WORDS: usize, const BYTES: usize>(
    s: S,
    packets: [&[u32]; 4],
    to: [&mut [u8]; PACKET_SIDE],
) {
    if const { S::REGISTERS == 1 && WORDS == 2 && cfg!(target_endian = "little") } {
        return write_rows_of_pairs(s, packets, to);
    }
    outline!(s, {
        // Words that are not stored as a whole wait for those of the other packets.
        let mut narrow = [[u32x4::splat(s, 0); 4]; PACKET_SIDE];
        let mut packet = 0;
        while packet < 4 {
            let mut planes = [[u32x4::splat(s, 0); PACKET_SIDE]; WORDS];
            let mut word = 0;
            while word < WORDS {
                planes[word] = rows_of_plane(s, &packets[packet][word * LANES..][..LANES]);
                word += 1;
            }
            let mut row = 0;
            while row < PACKET_SIDE {
                if BYTES < 4 {
                    narrow[row][packet] = planes[0][row];
                } else {
                    let mut words = [u32x4::splat(s, 0); WORDS];
                    let mut word = 0;
                    while word < WORDS {
                        words[word] = planes[word][row];
                        word += 1;
                    }
                    let size = PACKET_SIDE * BYTES;
                    write_whole(words, &mut to[row][packet * size..][..size]);
                }
                row += 1;
            }
            packet += 1;
        }
        if BYTES < 4 {
            let mut row = 0;
            while row < PACKET_SIDE {
                write_narrow::<S, BYTES>(narrow[row], &mut to[row][..SQUARE * BYTES]);
                row += 1;
            }
        }
    })
}

/// [`write_rows`] of texels of two words, in whole registers.
#[inline(always)]
fn write_rows_of_pairs<S: Lanes>(s: S, packets: [&[u32]; 4], to: [&mut [u8]; PACKET_SIDE]) {
    /// The lanes of a packet row by row.
    const ROWS: [u32; LANES] = [0, 1, 4, 5, 2, 3, 6, 7, 8, 9, 12, 13, 10, 11, 14, 15];
    /// The bytes of a packet's row.
    const BYTES: usize = PACKET_SIDE * 8;
    let order = u32x16::load_array(s, ROWS);
    let [a, b, c, d] = to;
    let mut packet = 0;
    while packet < 4 {
        let words = packets[packet];
        let first = s.permute(u32x16::from_slice(s, &words[..LANES]), order);
        let second = s.permute(u32x16::from_slice(s, &words[LANES..][..LANES]), order);
        let (upper, lower) = (first.zip_low(second), first.zip_high(second));
        let ((row_a, row_b), (row_c, row_d)) = (upper.split(), lower.split());
        let at = packet * BYTES;
        store_row(row_a, &mut a[at..][..BYTES]);
        store_row(row_b, &mut b[at..][..BYTES]);
        store_row(row_c, &mut c[at..][..BYTES]);
        store_row(row_d, &mut d[at..][..BYTES]);
        packet += 1;
    }
}

#[inline(always)]
fn store_row<S: Lanes>(row: u32x8<S>, to: &mut [u8]) {
    let bytes: u8x32<S> = row.bitcast();
    bytes.store_slice(to);
}

/// The four rows of one word of a packet's texels.
#[inline(always)]
fn rows_of_plane<S: Lanes>(s: S, lanes: &[u32]) -> [u32x4<S>; PACKET_SIDE] {
    let mut pairs = [f64x2::splat(s, 0.0); 4];
    let mut block = 0;
    while block < 4 {
        let mut words = [0; 4];
        let mut lane = 0;
        while lane < 4 {
            words[lane] = lanes[block * 4 + lane].to_le();
            lane += 1;
        }
        pairs[block] = u32x4::load_array(s, words).bitcast();
        block += 1;
    }
    let [upper_left, upper_right, lower_left, lower_right] = pairs;
    [
        upper_left.zip_low(upper_right).bitcast(),
        upper_left.zip_high(upper_right).bitcast(),
        lower_left.zip_low(lower_right).bitcast(),
        lower_left.zip_high(lower_right).bitcast(),
    ]
}

/// Four texels of whole words: their words one after the other.
#[inline(always)]
fn write_whole<S: Lanes, const WORDS: usize>(words: [u32x4<S>; WORDS], to: &mut [u8]) {
    match words[..] {
        [one] => store(one, to, 0),
        [first, second] => {
            store(first.zip_low(second), to, 0);
            store(first.zip_high(second), to, 1);
        }
        [a, b, c, d] => {
            let left: [f64x2<S>; 2] = [a.zip_low(b).bitcast(), c.zip_low(d).bitcast()];
            let right: [f64x2<S>; 2] = [a.zip_high(b).bitcast(), c.zip_high(d).bitcast()];
            store(left[0].zip_low(left[1]).bitcast(), to, 0);
            store(left[0].zip_high(left[1]).bitcast(), to, 1);
            store(right[0].zip_low(right[1]).bitcast(), to, 2);
            store(right[0].zip_high(right[1]).bitcast(), to, 3);
        }
        _ => unreachable!("a texel has 1, 2 or 4 words"),
    }
}

/// Sixteen texels of one or two bytes: the low bytes of their words.
#[inline(always)]
fn write_narrow<S: Lanes, const BYTES: usize>(words: [u32x4<S>; 4], to: &mut [u8]) {
    let [a, b, c, d] = words;
    let halves = |a: u32x4<S>, b: u32x4<S>| {
        let (a, b): (u16x8<S>, u16x8<S>) = (a.bitcast(), b.bitcast());
        a.unzip_low(b)
    };
    let (left, right) = (halves(a, b), halves(c, d));
    if BYTES == 2 {
        store(left.bitcast(), to, 0);
        store(right.bitcast(), to, 1);
    } else {
        let (left, right): (u8x16<S>, u8x16<S>) = (left.bitcast(), right.bitcast());
        store(left.unzip_low(right).bitcast(), to, 0);
    }
}

/// Stores sixteen bytes at a multiple of sixteen.
#[inline(always)]
fn store<S: Lanes>(words: u32x4<S>, to: &mut [u8], block: usize) {
    let bytes: u8x16<S> = words.bitcast();
    bytes.store_slice(&mut to[block * 16..][..16]);
}
