//! The history of a pixel against the image that was drawn.

mod stages;

pub use stages::{StagesTold, check_stages};

use crate::case::Case;
use crate::fast_path::{draw_pass, with_pass};
use crate::oracle::Image;
use crate::target::Target;
use estampe::{Device, PixelHistory, SampleValues, TestOutcome};
use estampe_reference::color;

/// What the histories of a topic had in them, so that a topic can assert that they tell something.
#[derive(Debug, Clone, Copy, Default)]
pub struct Told {
    /// Primitives that cover the pixel.
    pub primitives: u64,
    /// Those that were culled.
    pub culled: u64,
    /// Those that were clipped.
    pub clipped: u64,
    /// Fragments that were discarded.
    pub discarded: u64,
    /// Samples that passed every test.
    pub passed: u64,
    /// Samples that failed the depth test, the stencil test, or the depth bounds.
    pub failed: [u64; 3],
}

impl std::ops::AddAssign for Told {
    fn add_assign(&mut self, other: Self) {
        self.primitives += other.primitives;
        self.culled += other.culled;
        self.clipped += other.clipped;
        self.discarded += other.discarded;
        self.passed += other.passed;
        for (sum, count) in self.failed.iter_mut().zip(other.failed) {
            *sum += count;
        }
    }
}

/// Inspects a pixel of a case on a device, and compares what it ends with to the image.
///
/// # Errors
/// How the history differs.
pub fn check_pixel(
    device: &Device,
    case: &Case,
    image: &Image,
    pixel: [u32; 2],
) -> Result<Told, String> {
    let target = Target::of_case(device, case);
    let first_draws = case.passes()[0].len();
    let mut told = Told::default();
    for (number, draws) in case.passes().into_iter().enumerate() {
        let first_draw = if number == 0 { 0 } else { first_draws };
        let attachments = target.pass(case, number == 0);
        let queries = estampe::OcclusionQueries::new(case.draws.len());
        let pass = || estampe::RenderPass {
            occlusion_queries: Some(&queries),
            ..attachments.pass()
        };
        let history = with_pass(device, case, (draws, first_draw), pass(), |pass| {
            device.inspect(pass, pixel).expect("a pass that fits")
        });
        follow(&history)?;
        told += told_by(&history);
        compare(
            case,
            image,
            &history,
            pixel,
            number + 1 == case.passes().len(),
        )?;
        draw_pass(device, case, (draws, first_draw), pass());
    }
    Ok(told)
}

/// Each stored value is that which the record before left.
///
/// # Errors
/// The first that is not.
pub fn follow(history: &PixelHistory) -> Result<(), String> {
    let mut stored = history.initial.clone();
    let fragments = history.primitives.iter().flat_map(|one| &one.fragments);
    for record in fragments.flat_map(|fragment| &fragment.samples) {
        let of_sample = &mut stored[record.sample as usize];
        if !is_same(&record.before, of_sample) {
            let before = &record.before;
            return Err(format!("{before:?} is not the value before: {of_sample:?}"));
        }
        of_sample.clone_from(&record.after);
    }
    let is_end = stored.iter().zip(&history.last).all(|(a, b)| is_same(a, b));
    let last = &history.last;
    is_end
        .then_some(())
        .ok_or_else(|| format!("it ends with {last:?}, and its records with {stored:?}"))
}

/// True if the bits agree: NaN is itself.
fn is_same(a: &SampleValues, b: &SampleValues) -> bool {
    let bits = |values: &SampleValues| values.depth.map(f32::to_bits);
    a.codes == b.codes && bits(a) == bits(b) && a.stencil == b.stencil
}

fn told_by(history: &PixelHistory) -> Told {
    let count = |outcome: TestOutcome| {
        let fragments = history.primitives.iter().flat_map(|one| &one.fragments);
        let samples = fragments.flat_map(|fragment| &fragment.samples);
        samples.filter(|sample| sample.outcome == outcome).count() as u64
    };
    let primitives = history.primitives.iter();
    let fragments = primitives.clone().flat_map(|one| &one.fragments);
    Told {
        primitives: primitives.len() as u64,
        culled: primitives.clone().filter(|one| one.is_culled).count() as u64,
        clipped: primitives.filter(|one| one.is_clipped).count() as u64,
        discarded: fragments.filter(|fragment| fragment.is_discarded).count() as u64,
        passed: count(TestOutcome::Passed),
        failed: [
            count(TestOutcome::Depth),
            count(TestOutcome::Stencil),
            count(TestOutcome::DepthBounds),
        ],
    }
}

/// The last values of a history against the image of the last pass.
fn compare(
    case: &Case,
    image: &Image,
    history: &PixelHistory,
    [x, y]: [u32; 2],
    is_last: bool,
) -> Result<(), String> {
    if !is_last {
        return Ok(());
    }
    let at = y as usize * case.size[0] as usize + x as usize;
    let formats = case.formats();
    let samples = case.samples as usize;
    for (attachment, &format) in formats.iter().enumerate() {
        let bytes = format.block_bytes() as usize;
        let part = |texels: &[u8]| texels[at * bytes..][..bytes].to_vec();
        for (sample, values) in history.last.iter().enumerate() {
            let stored = part(&image.stored.texels[attachment * samples + sample]);
            let codes = values.codes[attachment].expect("cases have no holes");
            if color::bytes(format, codes) != stored {
                return Err(format!(
                    "attachment {attachment}, sample {sample}: {codes:?}, drawn {stored:?}"
                ));
            }
        }
        let whole = match image.stored.resolved.get(attachment) {
            Some(resolved) => part(resolved),
            None => part(&image.stored.texels[attachment * samples]),
        };
        if history.texels[attachment].as_ref() != Some(&whole) {
            let texel = &history.texels[attachment];
            return Err(format!(
                "attachment {attachment}: {texel:?}, drawn {whole:?}"
            ));
        }
    }
    for (sample, values) in history.last.iter().enumerate() {
        let depth = image.stored.depths[sample].get(at).copied();
        if values.depth.map(f32::to_bits) != depth {
            let drawn = depth.map(f32::from_bits);
            let depth = values.depth;
            return Err(format!("sample {sample}: depth {depth:?}, drawn {drawn:?}"));
        }
        let stencil = image.stored.stencils[sample].get(at).copied();
        if values.stencil != stencil {
            let stored = values.stencil;
            return Err(format!(
                "sample {sample}: stencil {stored:?}, drawn {stencil:?}"
            ));
        }
    }
    Ok(())
}
