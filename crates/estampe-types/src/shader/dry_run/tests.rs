//! Tests of the findings and refusals of dry runs.

use crate::shader::{FragmentIn, FragmentOut, VertexIn, VertexOut, interface_of};
use crate::{Interface, Quad, Vec2, Vec4};

/// The effects of a fragment, apart from its colour.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Does {
    Nothing,
    NoColor,
    TwoColors,
    Colors(usize),
    Discard,
    Depth,
    SampleMask,
    SecondColor,
    ReadPosition,
    CopyPosition,
    BranchOnPosition,
    IgnorePosition,
    ReadCoverage,
    ReadSampleIndex,
    Store,
    SkipHelpers,
    DiscardOnBranch,
    DepthOnOtherBranch,
    LoopForever,
    Panic,
    PanicOnBranch,
    PointSize,
    ClipDistance(usize),
    CullDistance(usize),
}

/// A shader whose body depends on its field.
struct Doing(Does);

crate::shader! {
    impl Shader for Doing {
        type Attributes<R: Real> = Vec4<R>;
        type Varyings<R: Real> = R;

        fn vertex<R: Real>(&self, _: VertexIn<'_, R>, at: Vec4<R>) -> VertexOut<R, R> {
            let out = VertexOut::new(at, at.x);
            match self.0 {
                Does::PointSize => out.with_point_size(at.y),
                Does::ClipDistance(index) => out.with_clip_distance(index, at.y),
                Does::CullDistance(index) => out.with_cull_distance(index, at.y),
                _ => out,
            }
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, x: R) -> FragmentOut<R> {
            let color = Vec4::repeat(x);
            let (out, at) = (FragmentOut::color(color), input.position);
            // True in no lane.
            let never = x.lt(-1.0);
            match self.0 {
                Does::NoColor => FragmentOut::none(),
                Does::TwoColors => out.with_color(1, color),
                Does::Colors(index) => out.with_color(index, color),
                Does::Discard => out.discard_unless(never),
                Does::Depth => out.with_depth(x),
                Does::SampleMask => out.with_sample_mask(x.to_int()),
                Does::SecondColor => out.with_second_color(color),
                Does::ReadPosition => FragmentOut::color(color * at.w),
                Does::CopyPosition => FragmentOut::color(color.xyz().extend(at.x)),
                Does::BranchOnPosition if R::all(at.x.gt(0.0)) => out,
                Does::IgnorePosition => FragmentOut::color(Vec4::repeat(at.x.splat(1.0))),
                Does::ReadCoverage => FragmentOut::color(color * input.coverage.to_real()),
                Does::ReadSampleIndex => FragmentOut::color(color * input.sample_index.to_real()),
                Does::Store => {
                    let stored = !input.is_helper & x.gt(0.0);
                    assert_eq!(R::mask_bits(stored), 0, "helpers do not store");
                    out
                }
                Does::SkipHelpers if R::all(input.is_helper) => out,
                Does::DiscardOnBranch if R::any(never) => out.discard_unless(never),
                Does::DepthOnOtherBranch if R::all(!never) => out,
                Does::DepthOnOtherBranch => out.with_depth(x),
                Does::LoopForever => {
                    while R::any(!never) || R::mask_bits(!never) != 0 {}
                    out
                }
                Does::Panic => panic!("it is tired"),
                Does::PanicOnBranch if R::any(never) => panic!("the branch is never taken"),
                _ => out,
            }
        }
    }
}

fn found(does: Does) -> Interface {
    interface_of(&Doing(does)).unwrap_or_else(|error| panic!("{does:?}: {error}"))
}

fn refused(does: Does) -> String {
    interface_of(&Doing(does)).unwrap_err().to_string()
}

/// The parts of an interface beyond that of a shader that only returns a colour.
fn beyond(does: Does) -> Interface {
    let mut interface = found(does);
    let nothing = found(Does::Nothing);
    assert_eq!(nothing.attributes, [4]);
    assert_eq!(nothing.color_targets, 1);
    interface.attributes.clear();
    interface.varyings.clear();
    interface.sampling.clear();
    // Tests of their own look at it.
    interface.no_derivatives = false;
    interface
}

#[test]
fn outputs_are_found() {
    use crate::shader::DepthOutput;
    let plain = || Interface {
        color_targets: 1,
        ..Interface::default()
    };
    assert_eq!(beyond(Does::Nothing), plain());
    assert_eq!(found(Does::NoColor).color_targets, 0);
    assert_eq!(found(Does::TwoColors).color_targets, 2);
    assert_eq!(found(Does::Colors(7)).color_targets, 8);
    let discards = Interface {
        discards: true,
        ..plain()
    };
    assert_eq!(beyond(Does::Discard), discards);
    assert_eq!(beyond(Does::DiscardOnBranch), discards);
    let depth = Interface {
        depth_output: DepthOutput::Any,
        ..plain()
    };
    assert_eq!(beyond(Does::Depth), depth);
    // The interpolated depth is z of the position.
    let sometimes = Interface {
        reads_position: true,
        ..depth
    };
    assert_eq!(beyond(Does::DepthOnOtherBranch), sometimes);
    assert!(found(Does::SampleMask).writes_sample_mask);
    assert!(found(Does::SecondColor).dual_source);
    assert!(found(Does::PointSize).writes_point_size);
    assert_eq!(found(Does::ClipDistance(0)).clip_distances, 1);
    assert_eq!(found(Does::ClipDistance(7)).clip_distances, 8);
    assert_eq!(found(Does::CullDistance(2)).cull_distances, 3);
}

#[test]
fn inputs_are_found_if_they_are_used() {
    for does in [
        Does::ReadPosition,
        Does::CopyPosition,
        Does::BranchOnPosition,
    ] {
        assert!(found(does).reads_position, "{does:?}");
    }
    assert!(!found(Does::IgnorePosition).reads_position);
    assert!(found(Does::ReadCoverage).reads_coverage);
    assert!(found(Does::ReadSampleIndex).per_sample);
    assert!(found(Does::Store).stores);
    assert!(!found(Does::SkipHelpers).stores);
}

#[test]
fn loops_end_and_branches_may_rely_on_their_condition() {
    assert_eq!(found(Does::LoopForever).color_targets, 1);
    assert_eq!(found(Does::PanicOnBranch).color_targets, 1);
}

#[test]
fn errors_name_what_to_do() {
    assert_eq!(
        refused(Does::Colors(8)),
        "the fragment sets the colour of target 8 (with_color); targets are 0 to 7"
    );
    assert_eq!(
        refused(Does::ClipDistance(9)),
        "the vertex sets clip distance 9 (with_clip_distance); they are 0 to 7"
    );
    assert_eq!(
        refused(Does::CullDistance(usize::MAX)),
        format!(
            "the vertex sets cull distance {} (with_cull_distance); they are 0 to 7",
            usize::MAX
        )
    );
    assert_eq!(
        refused(Does::Panic),
        "the shader panicked: it is tired; a pipeline runs it once when it is created, with \
         nothing bound, and it must not panic then either"
    );
}

/// What a fragment does with its varyings, (colour, uv).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Shades {
    Passes,
    Halves,
    Turns,
    Clamps,
    Discards,
    AddsDdx,
    AddsQuadLane,
    LooksAtLane,
    AsksAMask,
    DerivesIfBound,
    DerivesByAMap,
    ReadsAMap,
    DerivesIfTwo,
    DerivesIfHalf,
    PanicsIfTwo,
    ReadsANumber,
}

struct Shading<const DECLARED: bool>(Shades);

crate::shader! {
    impl<const DECLARED: bool> Shader for Shading<DECLARED> {
        type Attributes<R: Real> = Vec4<R>;
        type Varyings<R: Real> = (Vec4<R>, Vec2<R>);
        const TAKES_DERIVATIVES: bool = DECLARED;

        fn vertex<R: Real>(
            &self,
            _: VertexIn<'_, R>,
            at: Vec4<R>,
        ) -> VertexOut<R, (Vec4<R>, Vec2<R>)> {
            VertexOut::new(at, (at, at.xy()))
        }

        fn fragment<R: Real>(
            &self,
            input: FragmentIn<'_, R>,
            (color, uv): (Vec4<R>, Vec2<R>),
        ) -> FragmentOut<R> {
            let derived = || FragmentOut::color(color + uv.x.ddx());
            let [integer]: [u32; 1] = match self.0 {
                Shades::DerivesIfTwo | Shades::PanicsIfTwo | Shades::ReadsANumber => input.bindings.u32s(0, 0, 0),
                _ => [0],
            };
            match self.0 {
                Shades::Halves => FragmentOut::color(color * 0.5),
                Shades::Turns => FragmentOut::color(Vec4::new(color.w, color.y, color.z, color.x)),
                Shades::Clamps => FragmentOut::color(color.clamp(-1e9, 1e9)),
                Shades::Discards => FragmentOut::color(color).discard_unless(uv.x.ge(0.0)),
                Shades::AddsDdx => derived(),
                Shades::AddsQuadLane => FragmentOut::color(color + uv.x.quad_lane(0)),
                Shades::LooksAtLane => FragmentOut::color(color + uv.x.lane(1)),
                Shades::AsksAMask if R::any(uv.x.lt(-1.0)) && R::all(uv.y.lt(2.0)) => derived(),
                Shades::DerivesIfBound if input.bindings.sampler(0, 0).is_some() => derived(),
                Shades::DerivesByAMap if input.bindings.shadow_map(0, 0).is_some() => derived(),
                Shades::ReadsAMap => match input.bindings.shadow_map(0, 0) {
                    Some(map) => FragmentOut::color(color * map.texel(0, 0)),
                    None => FragmentOut::color(color),
                },
                Shades::DerivesIfTwo if integer == 2 => derived(),
                Shades::PanicsIfTwo if integer == 2 => panic!("only 0, 1 and 3 are bound"),
                Shades::DerivesIfHalf if input.bindings.f32s::<1>(0, 0, 0)[0] > 0.5 => derived(),
                _ => FragmentOut::color(color),
            }
        }
    }
}

#[test]
fn derivatives_are_found() {
    let of = |shades| interface_of(&Shading::<false>(shades)).map(|found| found.no_derivatives);
    for shades in [
        Shades::AddsDdx,
        Shades::AddsQuadLane,
        Shades::DerivesIfTwo,
        Shades::DerivesIfHalf,
        Shades::DerivesByAMap,
    ] {
        assert_eq!(of(shades), Ok(false), "{shades:?}");
    }
    for shades in [
        Shades::Passes,
        Shades::Halves,
        Shades::Turns,
        Shades::Clamps,
        Shades::Discards,
        Shades::ReadsANumber,
        Shades::ReadsAMap,
    ] {
        assert_eq!(of(shades), Ok(true), "{shades:?}");
    }
    let declared = interface_of(&Shading::<true>(Shades::Passes)).expect("valid");
    assert!(!declared.no_derivatives && !declared.color_passthrough);
}

#[test]
fn what_a_dry_run_cannot_know_may_take_derivatives() {
    for shades in [
        Shades::LooksAtLane,
        Shades::AsksAMask,
        Shades::PanicsIfTwo,
        Shades::DerivesIfBound,
    ] {
        let found = interface_of(&Shading::<false>(shades)).expect("valid");
        assert!(!found.no_derivatives, "{shades:?}");
        assert!(!found.color_passthrough, "{shades:?}");
    }
}

#[test]
fn colors_that_are_passed_through_are_found() {
    let of = |shades| interface_of(&Shading::<false>(shades)).map(|found| found.color_passthrough);
    assert_eq!(of(Shades::Passes), Ok(true));
    assert_eq!(of(Shades::ReadsANumber), Ok(true));
    for shades in [
        Shades::Halves,
        Shades::Turns,
        Shades::Clamps,
        Shades::Discards,
        Shades::AddsDdx,
        Shades::DerivesIfTwo,
        Shades::ReadsAMap,
    ] {
        assert_eq!(of(shades), Ok(false), "{shades:?}");
    }
}

/// Uses that bindings decide, which constants declare.
struct Bound<const DECLARED: bool>;

crate::shader! {
    impl<const DECLARED: bool> Shader for Bound<DECLARED> {
        type Attributes<R: Real> = Vec4<R>;
        type Varyings<R: Real> = R;
        const COLOR_TARGETS: usize = if DECLARED { 3 } else { 0 };
        const DISCARDS: bool = DECLARED;
        const READS_POSITION: bool = DECLARED;

        fn vertex<R: Real>(&self, _: VertexIn<'_, R>, at: Vec4<R>) -> VertexOut<R, R> {
            VertexOut::new(at, at.x)
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, x: R) -> FragmentOut<R> {
            let out = FragmentOut::color(Vec4::repeat(x));
            match input.bindings.storage_texture(0, 0) {
                Some(_) => out
                    .with_color(2, input.position)
                    .discard_unless(x.lt(0.5)),
                None => out,
            }
        }
    }
}

#[test]
fn constants_widen_the_interface() {
    let declared = interface_of(&Bound::<true>).expect("it is right");
    assert_eq!(declared.color_targets, 3);
    assert!(declared.discards && declared.reads_position);
    let undeclared = interface_of(&Bound::<false>).expect("it is right");
    assert_eq!(undeclared.color_targets, 1);
    assert!(!undeclared.discards && !undeclared.reads_position);
}

#[test]
fn a_dry_run_computes_what_quads_compute() {
    use super::number::Recorded;
    use super::recorder::{Answers, Facts, Recorder};
    use crate::{Int, Real};
    fn compute<R: Real>(x: R) -> [R; 4] {
        let y = x.sin() * 2.0 - 1.0 / (x + x.exp2());
        let bits = (x * 100.0).to_int() ^ x.splat_int(5) << 2;
        let index = Int::min(bits.shr_unsigned(1), x.splat_int(3));
        let table = index.gather(&[7, 8, 9, 10]).to_real();
        let chosen = R::select(x.lt(y) | !x.ge(0.3), y.atan2(x), table.sqrt());
        [y, bits.to_real(), chosen, chosen.ddx() + x.ddy_coarse()]
    }
    let quad = Quad([0.25, -1.5, 3.0, 0.125]);
    let recorder = Recorder::new(Answers::True);
    let recorded = compute(Recorded::new(quad, Facts::POSITION, &recorder));
    assert_eq!(recorded.map(Recorded::used), compute(quad));
    assert_eq!(recorder.facts(), Facts::POSITION.and(Facts::DERIVATIVES));
}

#[test]
fn long_loops_are_those_that_ask_often() {
    let is_long = |does| super::examine(&Doing(does)).map(|examined| examined.loops_long);
    for does in [Does::Nothing, Does::DiscardOnBranch, Does::Store] {
        assert_eq!(is_long(does), Ok(false), "{does:?}");
    }
    assert_eq!(is_long(Does::LoopForever), Ok(true));
}
