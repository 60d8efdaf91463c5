//! A view's sampling functions are computed by the fast path, for packets at every SIMD level,
//! pairs of quads, quads and single numbers, and compared with the oracle.

use estampe_reference::texture::ReferenceView;
use estampe_reference::texture::view::Sample;
use estampe_simd::{LANES, Lanes, Level, SimdBase, dispatch, f32x16};
use estampe_texture::{Coordinates, Lod, SampledTexture};
use estampe_types::{Pair, Quad, Real, Vec2, Vec3, Vec4, ViewDimension};

/// The sampling functions of a view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Function {
    Sample,
    Bias,
    Level,
    Gradients,
    Compare,
    CompareLevel,
    Gather(usize),
    GatherCompare,
}

/// The arguments of a sampling function, for the lanes of a packet.
#[derive(Clone, Debug)]
pub(super) struct Ask {
    pub(super) function: Function,
    pub(super) at: [[f32; LANES]; 3],
    pub(super) layer: [i32; LANES],
    /// The bias, or the level of detail.
    pub(super) value: [f32; LANES],
    pub(super) gradients: [[f32; LANES]; 6],
    pub(super) reference: [f32; LANES],
    pub(super) offset: [i32; 3],
}

type Answers = [[f32; 4]; LANES];

/// A kind of number that can be built from the lanes from `first` on.
trait Kind: Real {
    fn real(self, from: &[f32; LANES], first: usize) -> Self;
    fn int(self, from: &[i32; LANES], first: usize) -> Self::Int;
}

macro_rules! kinds {
    ($(($($generic:tt)*) $kind:ty;)*) => {$(
        impl $($generic)* Kind for $kind {
            #[inline(always)]
            fn real(self, from: &[f32; LANES], first: usize) -> Self {
                self.with_lanes(
                    #[inline(always)]
                    |lane| from[(first + lane) % LANES],
                )
            }
            #[inline(always)]
            fn int(self, from: &[i32; LANES], first: usize) -> Self::Int {
                let bits = self.with_lanes(
                    #[inline(always)]
                    |lane| f32::from_bits(from[(first + lane) % LANES].cast_unsigned()),
                );
                Real::to_bits(bits)
            }
        }
    )*};
}

kinds! {
    () f32;
    () Quad;
    (<S: Lanes>) f32x16<S>;
    () Pair<Quad>;
}

#[inline(always)]
fn ask<R: Kind>(view: &SampledTexture, ask: &Ask, like: R, first: usize, answers: &mut Answers) {
    let [u, v, w] = [
        like.real(&ask.at[0], first),
        like.real(&ask.at[1], first),
        like.real(&ask.at[2], first),
    ];
    let layer = like.int(&ask.layer, first);
    let at = match view.view().dimension() {
        ViewDimension::D1 => Coordinates::d1(u),
        ViewDimension::D2 => Coordinates::d2(Vec2::new(u, v)),
        ViewDimension::D2Array => Coordinates::d2_array(Vec2::new(u, v), layer),
        ViewDimension::D3 => Coordinates::d3(Vec3::new(u, v, w)),
        ViewDimension::Cube => Coordinates::cube(Vec3::new(u, v, w)),
        ViewDimension::CubeArray => Coordinates::cube_array(Vec3::new(u, v, w), layer),
    };
    let gradient = |k: usize| {
        Vec3::new(
            like.real(&ask.gradients[k], first),
            like.real(&ask.gradients[k + 1], first),
            like.real(&ask.gradients[k + 2], first),
        )
    };
    let value = like.real(&ask.value, first);
    let reference = like.real(&ask.reference, first);
    let flat = [ask.offset[0], ask.offset[1]];
    let only = |answer: R| Vec4::new(answer, like, like, like);
    let color = match ask.function {
        Function::Sample if ask.offset == [0; 3] => view.sample(at),
        Function::Sample => view.sample_with(at, Lod::Implicit, ask.offset),
        Function::Bias => view.sample_with(at, Lod::Bias(value), ask.offset),
        Function::Level => view.sample_with(at, Lod::Level(value), ask.offset),
        Function::Gradients => {
            view.sample_with(at, Lod::Gradients(gradient(0), gradient(3)), ask.offset)
        }
        Function::Compare => only(view.sample_compare(at, reference, Lod::Implicit, flat)),
        Function::CompareLevel => only(view.sample_compare(at, reference, Lod::Level(value), flat)),
        Function::Gather(channel) => view.gather(at, channel, flat),
        Function::GatherCompare => view.gather_compare(at, reference, flat),
    };
    for lane in 0..R::LANES {
        if first + lane < LANES {
            let Vec4 { x, y, z, w } = color;
            answers[first + lane] = [x.lane(lane), y.lane(lane), z.lane(lane), w.lane(lane)];
        }
    }
}

/// The fast path's results for a packet at a SIMD level.
fn packets(level: Level, view: &SampledTexture, question: &Ask) -> Answers {
    #[inline(always)]
    fn wide<S: Lanes>(simd: S, view: &SampledTexture, question: &Ask) -> Answers {
        let mut answers = [[0.0; 4]; LANES];
        let zero: f32x16<S> = SimdBase::splat(simd, 0.0);
        ask(view, question, zero, 0, &mut answers);
        answers
    }
    dispatch!(level, s => wide(s, view, question))
}

/// The oracle's result for a lane, with its quad's derivatives, or without derivatives if
/// `is_alone`.
pub(super) fn oracle(view: &ReferenceView, ask: &Ask, lane: usize, is_alone: bool) -> [f32; 4] {
    let at_lane = |lane: usize| [0, 1, 2].map(|k| ask.at[k][lane]);
    let quad = if is_alone { lane } else { lane & !3 };
    let difference = |other: usize| {
        let (a, b) = (
            at_lane(quad),
            at_lane(quad + if is_alone { 0 } else { other }),
        );
        [0, 1, 2].map(|k| if is_alone { 0.0 } else { b[k] - a[k] })
    };
    let implicit = || view.footprint(at_lane(quad), difference(1), difference(2));
    let given = |k: usize| [0, 1, 2].map(|i| ask.gradients[k + i][lane]);
    let reference = ask.reference[lane];
    let none = (0.0, 1, [0.0; 3]);
    let ((lod, probes, step), bias) = match ask.function {
        Function::Sample | Function::Compare => (implicit(), 0.0),
        Function::Bias => (implicit(), ask.value[lane]),
        Function::Level | Function::CompareLevel => ((ask.value[lane], 1, [0.0; 3]), 0.0),
        Function::Gradients => (view.footprint(at_lane(lane), given(0), given(3)), 0.0),
        Function::Gather(_) | Function::GatherCompare => (none, 0.0),
    };
    let compares = matches!(
        ask.function,
        Function::Compare | Function::CompareLevel | Function::GatherCompare
    );
    let sample = Sample {
        at: at_lane(lane),
        layer: ask.layer[lane],
        lod: view.biased(lod, bias),
        probes: if compares { 1 } else { probes },
        step,
        offset: ask.offset,
        reference: compares.then_some(reference),
    };
    match ask.function {
        Function::Gather(channel) => view.gather(&sample, channel),
        Function::GatherCompare => view.gather(&sample, 0),
        Function::Compare | Function::CompareLevel => [view.sample(&sample)[0], 0.0, 0.0, 0.0],
        _ => view.sample(&sample),
    }
}

/// The bits, with one pattern for all NaNs: their payloads depend on the processor.
fn bits(channels: [f32; 4]) -> [u32; 4] {
    channels.map(|x| if x.is_nan() { 0x7FC0_0000 } else { x.to_bits() })
}

/// Compares the fast path's results with the oracle's.
pub(super) fn check(view: &SampledTexture, reference: &ReferenceView, question: &Ask) {
    let compares = !matches!(
        question.function,
        Function::Sample
            | Function::Bias
            | Function::Level
            | Function::Gradients
            | Function::Gather(_)
            | Function::GatherCompare
    );
    let used = |answer: [f32; 4]| {
        if compares {
            [answer[0], 0.0, 0.0, 0.0]
        } else {
            answer
        }
    };
    let same = |kind: &str, lane: usize, got: [f32; 4], wanted: [f32; 4]| {
        let texture = view.view().texture();
        assert_eq!(
            bits(used(got)),
            bits(wanted),
            "{kind}, lane {lane}: {got:?} is not {wanted:?}: {:?} of {:?} {:?}, {:?}, {:?}, at {:?}, {question:?}",
            view.view().dimension(),
            texture.format,
            texture.levels,
            texture.shape,
            view.sampler(),
            [0, 1, 2].map(|k| question.at[k][lane]),
        );
    };
    let wanted: Answers = std::array::from_fn(|lane| oracle(reference, question, lane, false));
    for level in Level::all_available() {
        let view = &view.clone().at_level(level);
        let got = packets(level, view, question);
        for lane in 0..LANES {
            same(level.name(), lane, got[lane], wanted[lane]);
        }
    }
    let mut got = [[0.0; 4]; LANES];
    for first in (0..LANES).step_by(4) {
        ask(view, question, Quad([0.0; 4]), first, &mut got);
    }
    let mut of_pairs = [[0.0; 4]; LANES];
    for first in [0, 8] {
        let pair = Pair(Quad([0.0; 4]), Quad([0.0; 4]));
        ask(view, question, pair, first, &mut of_pairs);
    }
    for lane in 0..LANES {
        same("pair", lane, of_pairs[lane], wanted[lane]);
        same("quad", lane, got[lane], wanted[lane]);
        ask(view, question, 0.0_f32, lane, &mut got);
        let alone = oracle(reference, question, lane, true);
        same("alone", lane, got[lane], alone);
    }
}
