//! What all stages made of a pass against the histories of some of its pixels.

use crate::case::{Case, CaseDraw};
use crate::fast_path::{draw_pass, with_pass};
use crate::target::Target;
use estampe::{
    ClipOutcome, Device, PassStages, PixelHistory, PrimitiveKind, PrimitiveRecord, StagePiece,
    TestOutcome,
};
use estampe_types::state::ColorWrites;

/// What the stages of a topic's passes had in them, so that a topic can assert that they tell
/// something.
#[derive(Debug, Clone, Copy, Default)]
pub struct StagesTold {
    /// Primitives that are inside, clipped and dropped.
    pub clipped: [u64; 3],
    /// Vertices and edges that clipping made.
    pub new: [u64; 2],
    /// Pieces that are points, lines and triangles.
    pub kinds: [u64; 3],
    /// Pieces whose facing is culled.
    pub culled: u64,
    /// Tiles with pieces.
    pub tiles: u64,
    /// Blocks in which triangles were tested, and rejected.
    pub blocks: [u64; 2],
    /// Pixels whose history was compared, and those of them that show a piece.
    pub pixels: [u64; 2],
    /// Pieces that were stored to the compared pixels.
    pub stored: u64,
}

impl std::ops::AddAssign for StagesTold {
    fn add_assign(&mut self, other: Self) {
        fn add<const N: usize>(sums: &mut [u64; N], others: [u64; N]) {
            for (sum, other) in sums.iter_mut().zip(others) {
                *sum += other;
            }
        }
        add(&mut self.clipped, other.clipped);
        add(&mut self.new, other.new);
        add(&mut self.kinds, other.kinds);
        add(&mut self.blocks, other.blocks);
        add(&mut self.pixels, other.pixels);
        self.culled += other.culled;
        self.tiles += other.tiles;
        self.stored += other.stored;
    }
}

/// Inspects the stages of a case on devices, which must agree, and compares them with the histories
/// of some pixels.
///
/// # Errors
/// How they differ.
pub fn check_stages(
    devices: &[&Device],
    case: &Case,
    pixels: &[[u32; 2]],
) -> Result<StagesTold, String> {
    let device = devices[0];
    let target = Target::of_case(device, case);
    let first_draws = case.passes()[0].len();
    let mut told = StagesTold::default();
    for (number, draws) in case.passes().into_iter().enumerate() {
        let first_draw = if number == 0 { 0 } else { first_draws };
        let attachments = target.pass(case, number == 0);
        let queries = estampe::OcclusionQueries::new(case.draws.len());
        let pass = || estampe::RenderPass {
            occlusion_queries: Some(&queries),
            ..attachments.pass()
        };
        let compared = with_pass(device, case, (draws, first_draw), pass(), |pass| {
            let stages = |device: &Device| device.inspect_stages(pass).expect("a pass that fits");
            let of_first = stages(device);
            // As text, in which NaN is equal to itself.
            let text = format!("{of_first:?}");
            for other in &devices[1..] {
                let differs = format!("{:?}", stages(other)) != text;
                let threads = [device.threads(), other.threads()];
                if differs {
                    return Err(format!("{threads:?} threads give other stages"));
                }
            }
            let mut told = totals(&of_first);
            for &pixel in pixels {
                let history = device.inspect(pass, pixel).expect("a pass that fits");
                let of_pixel = compare(case, draws, &of_first, &history);
                told += of_pixel.map_err(|how| format!("pixel {pixel:?}: {how}"))?;
            }
            Ok(told)
        });
        told += compared?;
        draw_pass(device, case, (draws, first_draw), pass());
    }
    Ok(told)
}

fn totals(stages: &PassStages) -> StagesTold {
    let clipped = |outcome: ClipOutcome| {
        let primitives = stages.primitives.iter();
        primitives.filter(|one| one.clipped == outcome).count() as u64
    };
    let kind = |kind: PrimitiveKind| {
        let pieces = stages.pieces.iter();
        pieces.filter(|piece| piece.kind == kind).count() as u64
    };
    let polygons = || stages.primitives.iter().flat_map(|one| &one.polygon);
    let blocks = || stages.blocks.iter();
    StagesTold {
        clipped: [
            ClipOutcome::Inside,
            ClipOutcome::Clipped,
            ClipOutcome::Dropped,
        ]
        .map(clipped),
        new: [
            polygons().filter(|vertex| vertex.is_new).count() as u64,
            polygons().filter(|vertex| vertex.is_cut).count() as u64,
        ],
        kinds: [
            PrimitiveKind::Point,
            PrimitiveKind::Line,
            PrimitiveKind::Triangle,
        ]
        .map(kind),
        culled: stages.pieces.iter().filter(|one| one.is_culled).count() as u64,
        tiles: stages.tiles.iter().filter(|&&count| count > 0).count() as u64,
        blocks: [
            blocks().map(|block| u64::from(block.tested)).sum(),
            blocks().map(|block| u64::from(block.rejected)).sum(),
        ],
        ..StagesTold::default()
    }
}

/// The stages at a pixel against its history.
fn compare(
    case: &Case,
    draws: &[CaseDraw],
    stages: &PassStages,
    history: &PixelHistory,
) -> Result<StagesTold, String> {
    let [x, y] = history.pixel;
    let counts = stages.pixel(history.pixel).ok_or("it is outside")?;
    let drawn = || history.primitives.iter().filter(|one| !one.is_culled);
    let fragments = || drawn().flat_map(|one| &one.fragments);
    let samples = || fragments().flat_map(|fragment| &fragment.samples);
    let number = |count: usize| u32::try_from(count).unwrap_or(u32::MAX);
    let outcome =
        |outcome: TestOutcome| number(samples().filter(|sample| sample.outcome == outcome).count());
    let passes = |one: &&PrimitiveRecord| {
        let mut samples = one.fragments.iter().flat_map(|fragment| &fragment.samples);
        samples.any(|sample| sample.outcome == TestOutcome::Passed)
    };
    let writes = |one: &&PrimitiveRecord| {
        let attachments = 0..case.formats().len();
        attachments
            .into_iter()
            .any(|at| draws[one.draw].target(at).1 != ColorWrites::NONE)
    };
    let expected = [
        number(drawn().count()),
        number(fragments().count()),
        number(fragments().filter(|fragment| fragment.is_discarded).count()),
        outcome(TestOutcome::DepthBounds),
        outcome(TestOutcome::Stencil),
        outcome(TestOutcome::Depth),
        outcome(TestOutcome::Passed),
        number(drawn().filter(passes).filter(writes).count()),
    ];
    let found = [
        counts.covered,
        counts.shaded,
        counts.discarded,
        counts.failed_depth_bounds,
        counts.failed_stencil,
        counts.failed_depth,
        counts.passed,
        counts.stored,
    ];
    if found != expected {
        return Err(format!("counts {found:?}, in the history {expected:?}"));
    }

    let tile = y / stages.tile_side * stages.tile_columns_rows()[0] + x / stages.tile_side;
    let mut pieces = (0u32..).zip(&stages.pieces);
    let mut last_passed = None;
    for record in &history.primitives {
        let found = pieces.find(|(_, piece)| is_of(stages, piece, record));
        let Some((at, piece)) = found else {
            return Err(format!("no piece is {record:?}"));
        };
        let primitive = &stages.primitives[piece.primitive as usize];
        if record.is_clipped && primitive.clipped != ClipOutcome::Clipped {
            return Err(format!("{primitive:?} is not clipped"));
        }
        if !record.is_culled && !stages.tiles_of(piece).contains(&tile) {
            return Err(format!("{piece:?} is not in tile {tile}"));
        }
        if !record.is_culled && passes(&record) {
            last_passed = Some(at);
        }
    }
    if counts.visible != last_passed {
        let visible = counts.visible;
        return Err(format!(
            "{visible:?} is visible, in the history {last_passed:?}"
        ));
    }
    let first = (y as usize * stages.size[0] as usize + x as usize) * stages.samples as usize;
    for (sample, values) in history.last.iter().enumerate() {
        let depth = stages.depths.get(first + sample);
        if depth.map(|depth| depth.to_bits()) != values.depth.map(f32::to_bits) {
            return Err(format!(
                "depth {depth:?}, in the history {:?}",
                values.depth
            ));
        }
    }
    Ok(StagesTold {
        pixels: [1, u64::from(last_passed.is_some())],
        stored: u64::from(counts.stored),
        ..StagesTold::default()
    })
}

/// True if a record of a history is about this piece.
fn is_of(stages: &PassStages, piece: &StagePiece, record: &PrimitiveRecord) -> bool {
    let primitive = &stages.primitives[piece.primitive as usize];
    let bits = |clip: [f32; 4]| clip.map(f32::to_bits);
    let vertices = primitive.vertices().iter().map(|&at| {
        let vertex = &stages.vertices[at as usize];
        (vertex.instance, vertex.index, bits(vertex.clip))
    });
    let recorded = record.vertices.iter();
    let recorded = recorded.map(|vertex| (record.instance, vertex.index, bits(vertex.clip)));
    primitive.draw as usize == record.draw
        && primitive.number == record.primitive
        && piece.kind == record.kind
        && piece.is_culled == record.is_culled
        && piece.front_facing == record.front_facing
        && piece.vertices() == record.piece
        && vertices.eq(recorded)
}
