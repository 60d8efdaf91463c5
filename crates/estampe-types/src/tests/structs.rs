//! The structs that `varyings!` and `attributes!` accept.

#![deny(warnings)]

use crate::shader::{Sink, Source};
use crate::{Attributes, Interpolation, Sampling, Varyings, Vec2, Vec3, Vec4, WithGradient};

crate::attributes! {
    /// A corner.
    struct Corner<R> {
        /// The position.
        position: Vec3<R>,
        weight: R,
        pub(crate) uv: Vec2<R>
    }
}

crate::varyings! {
    /// Seven fields, more than a tuple has.
    #[derive(PartialEq)]
    pub(crate) struct Surface<R> {
        /// The index of the material.
        #[flat]
        pub(crate) id: R,
        normal: Vec3<R>,
        #[no_perspective]
        uv: Vec2<R>,
        #[centroid]
        color: Vec4<R>,
        #[no_perspective]
        /// Documented between two attributes.
        #[sample]
        weight: R,
        nested: Inner<R>,
        #[flat]
        all_flat: Inner<R>,
    }
}

crate::varyings! {
    #[derive(PartialEq)]
    struct Inner<R> { a: R, #[no_perspective] b: R }
}

crate::varyings! { struct Nothing<R> { marker: std::marker::PhantomData<R> } }

impl<R: crate::Real> Varyings<R> for std::marker::PhantomData<R> {
    fn modes(_: &mut Vec<Interpolation>) {}
    fn load(_: &mut impl Source<R>) -> Self {
        Self
    }
    fn store(self, _: &mut impl Sink<R>) {}
}

/// Scalars in order, both ways.
struct List(Vec<f32>);

impl Source<f32> for List {
    fn take(&mut self) -> f32 {
        self.0.remove(0)
    }
}

impl Sink<f32> for List {
    fn put(&mut self, value: f32) {
        self.0.push(value);
    }
}

#[test]
fn fields_are_scalars_in_order() {
    let mut components = Vec::new();
    Corner::<f32>::components(&mut components);
    assert_eq!(components, [3, 1, 2]);
    let corner = Corner::load(&mut List(vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0]));
    assert_eq!(corner.position, Vec3::new(1.0, 2.0, 3.0));
    assert_eq!((corner.weight, corner.uv), (4.0, Vec2::new(5.0, 6.0)));

    let scalars: Vec<f32> = (0..15).map(|k| k as f32).collect();
    let surface = Surface::load(&mut List(scalars.clone()));
    assert_eq!(surface.id, 0.0);
    assert_eq!(surface.color, Vec4::new(6.0, 7.0, 8.0, 9.0));
    assert_eq!(surface.all_flat.b, 14.0);
    let mut stored = List(Vec::new());
    surface.store(&mut stored);
    assert_eq!(stored.0, scalars);
}

#[test]
fn attributes_of_fields_choose_the_interpolation() {
    use Interpolation::{Flat as F, NoPerspective as N, Smooth as S};
    let mut modes = Vec::new();
    Surface::<f32>::modes(&mut modes);
    assert_eq!(modes, [F, S, S, S, N, N, S, S, S, S, N, S, N, F, F]);
    let (c, s) = (Sampling::Centroid, Sampling::Sample);
    let mut sampling = Vec::new();
    Surface::<f32>::sampling(&mut sampling);
    let expected = [[Sampling::Center; 6].as_slice(), &[c; 4], &[s]].concat();
    assert_eq!(sampling[..11], expected);
    assert_eq!(sampling[11..], [Sampling::Center; 4]);
    let mut none = Vec::new();
    Nothing::<f32>::modes(&mut none);
    assert!(none.is_empty());
}

crate::varyings! {
    struct Textured<R> { before: R, #[no_perspective] uv: WithGradient<Vec2<R>>, after: R }
}

/// Scalars, and derivatives along x and y.
struct Lists {
    values: List,
    derivatives: [List; 2],
}

impl Source<f32> for Lists {
    fn take(&mut self) -> f32 {
        self.values.take()
    }

    fn take_derivative(&mut self, axis: usize, _like: f32) -> f32 {
        self.derivatives[axis].take()
    }
}

#[test]
fn derivatives_follow_their_scalars() {
    let mut gradients = Vec::new();
    Textured::<f32>::gradients(&mut gradients);
    assert_eq!(gradients, [false, true, true, false]);
    let mut lists = Lists {
        values: List(vec![1.0, 2.0, 3.0, 4.0]),
        derivatives: [List(vec![5.0, 6.0]), List(vec![7.0, 8.0])],
    };
    let all = Textured::load(&mut lists);
    assert_eq!((all.before, all.after), (1.0, 4.0));
    let uv = WithGradient {
        value: Vec2::new(2.0, 3.0),
        ddx: Vec2::new(5.0, 6.0),
        ddy: Vec2::new(7.0, 8.0),
    };
    assert_eq!(all.uv, uv);
    let mut stored = List(Vec::new());
    all.store(&mut stored);
    assert_eq!(stored.0, [1.0, 2.0, 3.0, 4.0]);
    // A source without derivatives, as of vertices, gives zeros.
    let all = Textured::load(&mut stored);
    assert_eq!([all.uv.ddx, all.uv.ddy], [Vec2::new(0.0, 0.0); 2]);
}
