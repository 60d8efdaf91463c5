//! Which derivatives of varyings the pipeline must supply.

use crate::shader::{VertexOut, interface_of};
use crate::{
    FragmentIn, FragmentOut, Interface, NoPerspective, Vec2, Vec3, Vec4, VertexIn, WithGradient,
};

#[derive(Debug, Clone, Copy)]
enum Reads {
    Value,
    Ddx,
    Ddy,
    OnBranch,
    BesideMissing,
    OnlyIfBound,
    BesideMap,
    OnlyWithMap,
}

struct Reading(Reads);

crate::shader! {
    impl Shader for Reading {
        type Attributes<R: Real> = (Vec4<R>, WithGradient<Vec2<R>>);
        type Varyings<R: Real> = (Vec3<R>, WithGradient<Vec2<R>>, R, NoPerspective<WithGradient<R>>);

        fn vertex<R: Real>(
            &self,
            _input: VertexIn<'_, R>,
            (position, uv): (Vec4<R>, WithGradient<Vec2<R>>),
        ) -> VertexOut<R, Self::Varyings<R>> {
            let varyings = (position.xyz(), uv, position.w, NoPerspective(position.x.into()));
            VertexOut::new(position, varyings)
        }

        fn fragment<R: Real>(
            &self,
            input: FragmentIn<'_, R>,
            (_, uv, _, NoPerspective(t)): Self::Varyings<R>,
        ) -> FragmentOut<R> {
            let shown = match self.0 {
                Reads::Value => uv.value.x,
                Reads::Ddx => uv.ddx.y,
                Reads::Ddy => t.ddy,
                Reads::OnBranch if R::any(uv.value.x.gt(2.0)) => uv.ddx.x,
                Reads::OnBranch => uv.value.x,
                Reads::BesideMissing | Reads::OnlyIfBound => {
                    match (self.0, input.bindings.sampler(0, 0)) {
                        (Reads::OnlyIfBound, Some(_)) => uv.ddx.x,
                        _ => uv.value.x,
                    }
                }
                Reads::BesideMap | Reads::OnlyWithMap => {
                    match (self.0, input.bindings.shadow_map(0, 0)) {
                        (Reads::OnlyWithMap, Some(_)) => uv.ddx.x,
                        _ => uv.value.x,
                    }
                }
            };
            FragmentOut::color(Vec4::repeat(shown + 1.0))
        }
    }
}

fn found(reads: Reads) -> Interface {
    interface_of(&Reading(reads)).unwrap_or_else(|error| panic!("{reads:?}: {error}"))
}

#[test]
fn derivatives_that_are_used_are_supplied() {
    for reads in [Reads::Ddx, Reads::Ddy, Reads::OnBranch] {
        assert_eq!(found(reads).gradients, [3, 4, 6], "{reads:?}");
    }
    let interface = found(Reads::Value);
    assert_eq!(interface.gradients, [0; 0]);
    assert_eq!(
        (interface.varyings.len(), interface.fragment_scalars()),
        (7, 7)
    );
    assert_eq!(interface.attributes, [4, 2]);
    assert_eq!(found(Reads::Ddx).fragment_scalars(), 7 + 2 * 3);
}

/// What is done with a resource is not tried, and may use derivatives.
#[test]
fn derivatives_are_supplied_if_a_resource_is_missing() {
    for reads in [Reads::BesideMissing, Reads::OnlyIfBound] {
        assert_eq!(found(reads).gradients, [3, 4, 6], "{reads:?}");
    }
}

/// What is done with a shadow map is tried.
#[test]
fn derivatives_are_supplied_if_they_are_used_where_there_is_a_map() {
    assert_eq!(found(Reads::OnlyWithMap).gradients, [3, 4, 6]);
    assert_eq!(found(Reads::BesideMap).gradients, [0; 0]);
}

#[test]
fn derivatives_of_varyings_need_no_quads() {
    assert!(found(Reads::Ddx).no_derivatives);
    assert!(found(Reads::Ddy).no_derivatives);
}
