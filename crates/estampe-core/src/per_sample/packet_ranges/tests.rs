//! Classes of packets against the tests of their samples.

use super::*;
use crate::bounds::plane::Plane;
use crate::depth_format::{DepthFormat, StoredDepth};
use crate::fragment::interpolate::{DepthPlane, PlaneOrigin};
use crate::per_sample::stencil::StencilTest;
use crate::raster::{SampleSet, TileShape, packet_origin};
use estampe_format::depth::FixedDepth;
use estampe_simd::{Level, dispatch};
use estampe_types::TextureFormat;
use estampe_types::state::{
    CompareFunction, DepthState, StencilFaceState, StencilOperation, StencilState,
};

const TILE: TileShape = TileShape {
    x: 64,
    y: 0,
    log2: 6,
};

fn tests(
    compare: CompareFunction,
    depth_fail_op: StencilOperation,
    format: DepthFormat,
) -> SampleTests {
    let face = StencilFaceState {
        depth_fail_op,
        ..StencilFaceState::default()
    };
    SampleTests {
        bounds: None,
        stencil: Some(StencilTest {
            state: StencilState::from(face),
            reference: [0; 2],
        }),
        depth: Some(DepthState {
            write_enabled: false,
            compare,
        }),
        stored: StoredDepth {
            range: [0.0, 1.0],
            format,
        },
    }
}

#[inline(always)]
fn classes<S: Lanes>(
    s: S,
    look: &HizQuery<'_, 1>,
    (ranges, block): (&PacketRanges, usize),
) -> [u16; 2] {
    PacketQuery::new(s, look, ranges, Margin::of(look.tests)).of_block(s, block, u16::MAX)
}

#[test]
fn a_shadow_volume_counts_where_it_fails_and_changes_nothing_elsewhere() {
    // The first packet of a block holds 0.25, the others 0.75.
    let mut stored = [[0.75; LANES]; 256];
    stored[16] = [0.25; LANES];
    let mut ranges = PacketRanges::default();
    ranges.refresh(0b10, 1, &stored);
    for level in Level::all_available() {
        let of = |depth: f32, depth_fail_op| {
            let tests = tests(CompareFunction::Less, depth_fail_op, DepthFormat::Float);
            let look = HizQuery {
                tests: &tests,
                plane: DepthPlane {
                    origin: PlaneOrigin { x: 0.0, y: 0.0 },
                    z: Plane {
                        origin: depth,
                        ..Plane::default()
                    },
                },
                tile: TILE,
                samples: SampleSet::<1>::new(1),
                passes_in_vain: tests.passing_keeps(true),
            };
            dispatch!(level, s => classes(s, &look, (&ranges, 1)))
        };
        let counting = |depth| of(depth, StencilOperation::IncrementWrap);
        assert_eq!(counting(0.5), [0, 1], "{level:?}");
        assert_eq!(counting(0.9), [0, 0xFFFF], "{level:?}");
        assert_eq!(counting(0.25), [1, 0], "{level:?}: equal depths are tested");
        assert_eq!(of(0.5, StencilOperation::Keep), [0, 0], "{level:?}");
    }
}

/// NaN becomes 0.
fn clamped(depth: f32) -> f32 {
    if depth > 0.0 { depth.min(1.0) } else { 0.0 }
}

/// Of random planes and depths: every sample of a packet that is left out passes, and of one
/// that fails, fails.
#[test]
fn packets_are_decided_as_their_samples_are() {
    let mut state = 3u32;
    let mut random = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) as f32 / 16_777_216.0
    };
    let formats = [
        DepthFormat::Float,
        DepthFormat::new(Some(TextureFormat::Depth24Plus)),
        DepthFormat::Fixed(FixedDepth::new(TextureFormat::Depth16Unorm).expect("16 bits")),
    ];
    let compares = [
        CompareFunction::Less,
        CompareFunction::LessEqual,
        CompareFunction::Greater,
        CompareFunction::GreaterEqual,
    ];
    let mut counts = [[0; 3]; 3];
    for round in 0..600 {
        let format = formats[round % 3];
        let tests = tests(
            compares[round / 3 % 4],
            StencilOperation::IncrementWrap,
            format,
        );
        // Planes as most are, those whose sums are rounded far more coarsely than depths are, and
        // those whose sums overflow.
        let steepness = round / 36 % 3;
        let slope = [0.04, 400.0, 3e38][steepness];
        let plane = DepthPlane {
            origin: PlaneOrigin {
                x: 64.0 + (random() * 64.0).floor(),
                y: (random() * 64.0).floor(),
            },
            z: Plane {
                origin: random(),
                dx: (random() - 0.5) * slope,
                dy: (random() - 0.5) * slope,
            },
        };
        // Depths near the plane's, some of them as near as codes. Half of the last ones are a
        // packet's own extremes, which a bound must not be within.
        let spread = [0.1, 1e-3, 1e-6][round / 12 % 3];
        let mut stored = [[0.0; LANES]; 256];
        let mut depths = [[0.0; LANES]; 256];
        for (packet, (stored, depths)) in (0..).zip(stored.iter_mut().zip(&mut depths)) {
            let (x, y) = packet_origin(packet);
            let moved = (random() - 0.5) * spread * 4.0;
            for lane in 0..LANES {
                let x = (TILE.x + x) as f32 + f32::from(estampe_simd::LANE_X[lane]) + 0.5;
                let y = (TILE.y + y) as f32 + f32::from(estampe_simd::LANE_Y[lane]) + 0.5;
                let (x, y) = (x - plane.origin.x, y - plane.origin.y);
                let z = plane.z.origin + (x * plane.z.dx + y * plane.z.dy);
                depths[lane] = format.stored(clamped(z));
                let near = clamped(z) + moved + (random() - 0.5) * spread;
                stored[lane] = format.stored(clamped(near));
            }
            if spread < 1e-3 && random() < 0.5 {
                let extreme: fn(f32, f32) -> f32 = if random() < 0.5 { f32::min } else { f32::max };
                stored.fill(depths.iter().copied().fold(depths[0], extreme));
            }
        }
        let mut ranges = PacketRanges::default();
        ranges.refresh(u16::MAX, 1, &stored);
        let look = HizQuery {
            tests: &tests,
            plane,
            tile: TILE,
            samples: SampleSet::<1>::new(1),
            passes_in_vain: true,
        };
        for level in Level::all_available() {
            for block in 0..BLOCKS {
                let [tested, failing] = dispatch!(level, s => classes(s, &look, (&ranges, block)));
                for lane in 0..LANES {
                    let packet = block * LANES + lane;
                    let pairs = depths[packet].iter().zip(&stored[packet]);
                    let compare = tests.depth.expect("a depth test").compare;
                    let passing = pairs
                        .filter(|(new, old)| {
                            crate::per_sample::compare::compare(compare, **new, **old)
                        })
                        .count();
                    let bit = |mask: u16| mask >> lane & 1 == 1;
                    assert!(!bit(tested & failing));
                    if bit(failing) {
                        assert_eq!(passing, 0, "{level:?} {round} {packet}");
                    } else if !bit(tested) {
                        assert_eq!(passing, LANES, "{level:?} {round} {packet}");
                    }
                    let kind = 2 * usize::from(bit(tested)) + usize::from(bit(failing));
                    counts[steepness][kind] += 1;
                }
            }
        }
    }
    let [usual, steep, overflowing] = counts;
    assert!(usual.iter().all(|count| *count > 2000), "{counts:?}");
    assert!(steep.iter().all(|count| *count > 2000), "{counts:?}");
    // Bounds are infinite: every packet is tested.
    assert_eq!(overflowing[..2], [0; 2], "{counts:?}");
}
