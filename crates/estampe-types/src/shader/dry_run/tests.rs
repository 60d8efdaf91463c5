//! Tests of the findings and refusals of dry runs.

use crate::shader::{FragmentIn, FragmentOut, VertexIn, VertexOut, interface_of};
use crate::{Interface, Quad, ShaderError, ShadowMap, Vec2, Vec4};

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

/// A shader with promises, which its field may break.
struct Promising {
    breaks: Breaks,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Breaks {
    Nothing,
    ByDdx,
    ByQuadLane,
    ByNeighbours,
    ByFactor,
    ByClamp,
    ByDiscard,
}

impl Promising {
    /// A table that is read at a place that depends on the whole quad, as a texture is.
    #[inline(always)]
    fn looked_up<R: crate::Real>(x: R) -> R {
        let spread = x.lane(1) - x.lane(0);
        x.splat(spread)
    }
}

macro_rules! promising {
    ($($constant:ident $module:ident)*) => {$(
        mod $module {
            use super::*;

            pub(super) struct Shaded(pub(super) Promising);

            crate::shader! {
                impl Shader for Shaded {
                    type Attributes<R: Real> = Vec4<R>;
                    type Varyings<R: Real> = (Vec4<R>, Vec2<R>);
                    const $constant: bool = true;

                    fn vertex<R: Real>(
                        &self,
                        _: VertexIn<'_, R>,
                        at: Vec4<R>,
                    ) -> VertexOut<R, (Vec4<R>, Vec2<R>)> {
                        VertexOut::new(at, (at, at.xy()))
                    }

                    fn fragment<R: Real>(
                        &self,
                        _: FragmentIn<'_, R>,
                        (color, uv): (Vec4<R>, Vec2<R>),
                    ) -> FragmentOut<R> {
                        let out = FragmentOut::color(color);
                        match self.0.breaks {
                            Breaks::Nothing => out,
                            Breaks::ByDdx => FragmentOut::color(color + uv.x.ddx()),
                            Breaks::ByQuadLane => FragmentOut::color(color + uv.x.quad_lane(0)),
                            Breaks::ByNeighbours => {
                                FragmentOut::color(color + Promising::looked_up(uv.x))
                            }
                            Breaks::ByFactor => FragmentOut::color(color * 0.5),
                            Breaks::ByClamp => FragmentOut::color(color.saturate()),
                            Breaks::ByDiscard => out.discard_unless(uv.x.ge(0.0)),
                        }
                    }
                }
            }
        }
    )*};
}
promising! { NO_DERIVATIVES without_derivatives COLOR_PASSTHROUGH passthrough }

#[test]
fn a_false_promise_of_no_derivatives_is_refused() {
    let of = |breaks| {
        let found = interface_of(&without_derivatives::Shaded(Promising { breaks }));
        found.map(|interface| interface.no_derivatives)
    };
    for breaks in [Breaks::ByDdx, Breaks::ByQuadLane, Breaks::ByNeighbours] {
        assert_eq!(of(breaks), Err(ShaderError::Derivatives), "{breaks:?}");
    }
    for breaks in [Breaks::Nothing, Breaks::ByFactor, Breaks::ByDiscard] {
        assert_eq!(of(breaks), Ok(true), "{breaks:?}");
    }
}

#[test]
fn a_false_promise_of_passthrough_is_refused() {
    let of = |breaks| {
        let found = interface_of(&passthrough::Shaded(Promising { breaks }));
        found.map(|interface| interface.color_passthrough)
    };
    assert_eq!(of(Breaks::Nothing), Ok(true));
    for breaks in [Breaks::ByFactor, Breaks::ByClamp, Breaks::ByDiscard] {
        assert_eq!(of(breaks), Err(ShaderError::NoPassthrough), "{breaks:?}");
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
            match input.bindings.shadow_map(0, 0).map(ShadowMap::width) {
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
