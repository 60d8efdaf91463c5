//! Per-sample shading, centroids, and sample masks of shaders and state.

use super::*;
use crate::raster::sample_positions;
use estampe_types::shader::{Centroid, PerSample};

/// Two triangles over the target's part left of `right`, in pixels; the values are the window's x
/// and y.
fn left_of(target: &Target, right: f32) -> Vec<Vertex> {
    let corner = |x: f32, y: f32| (at(target, x, y, 0.5), [x, y, 0.0]);
    let (top, bottom) = (-8.0, 16.0);
    // Two triangles: a rectangle.
    let [a, b, c, d] = [
        corner(-8.0, top),
        corner(-8.0, bottom),
        corner(right, bottom),
        corner(right, top),
    ];
    vec![a, b, c, a, c, d]
}

/// Outputs the sample's number, the coverage and the position.
struct BySample;

estampe_types::shader! {
    impl Shader for BySample {
        type Attributes<R: Real> = (Vec4<R>, Vec3<R>);
        type Varyings<R: Real> = NoPerspective<Vec3<R>>;

        fn vertex<R: Real>(
            &self,
            _input: shader::VertexIn<'_, R>,
            (position, value): (Vec4<R>, Vec3<R>),
        ) -> shader::VertexOut<R, Self::Varyings<R>> {
            shader::VertexOut::new(position, NoPerspective(value))
        }

        fn fragment<R: Real>(
            &self,
            input: FragmentIn<'_, R>,
            NoPerspective(value): Self::Varyings<R>,
        ) -> FragmentOut<R> {
            let (number, coverage) = (input.sample_index.to_real(), input.coverage.to_real());
            FragmentOut::color(Vec4::new(number, coverage, value.x, input.position.y))
        }
    }
}

/// Rows: R6, F1.
#[test]
fn shading_by_sample_runs_at_each_sample() {
    for samples in [1, 2, 4, 8, 16] {
        let mut target = Target::new(3, 2, samples, TextureFormat::Rgba32Float);
        let vertices = left_of(&target, 9.0);
        let counts = draw_with(&mut target, &BySample, &State::new(3, 2), &vertices);
        assert_eq!(counts.fragments, 6 * u64::from(samples));
        for y in 0..2_u8 {
            for x in 0..3_u8 {
                for (s, &[dx, dy]) in (0_u32..).zip(sample_positions(samples)) {
                    let index = target.index([u32::from(x), u32::from(y)], s);
                    let [number, coverage, at_x, at_y] = target.color[index].map(f32::from_bits);
                    assert_eq!((number, coverage), (s as f32, (1 << s) as f32));
                    let place = |pixel: u8, offset: u8| f32::from(pixel) + f32::from(offset) / 16.0;
                    assert!((at_x - place(x, dx)).abs() < 1e-5);
                    assert_eq!(at_y, place(y, dy));
                }
            }
        }
    }
}

/// Two varyings of the window's x: at the centre and at the centroid. Keeps the samples of a mask.
struct Places;

estampe_types::shader! {
    impl Shader for Places {
        type Attributes<R: Real> = (Vec4<R>, Vec3<R>);
        type Varyings<R: Real> = (NoPerspective<[R; 1]>, Centroid<NoPerspective<[R; 1]>>);

        fn vertex<R: Real>(
            &self,
            _input: shader::VertexIn<'_, R>,
            (position, value): (Vec4<R>, Vec3<R>),
        ) -> shader::VertexOut<R, Self::Varyings<R>> {
            let x = NoPerspective([value.x]);
            shader::VertexOut::new(position, (x, Centroid(x)))
        }

        fn fragment<R: Real>(
            &self,
            input: FragmentIn<'_, R>,
            (NoPerspective([center]), Centroid(NoPerspective([centroid]))): Self::Varyings<R>,
        ) -> FragmentOut<R> {
            let coverage = input.coverage.to_real();
            FragmentOut::color(Vec4::new(center, centroid, coverage, input.real(1.0)))
                .with_sample_mask(input.coverage.splat(0b0111))
        }
    }
}

/// Rows: R6.
#[test]
fn centroids_lie_where_the_pixel_is_covered() {
    // Of pixel 1, the left 7/16: samples 0 (6/16) and 2 (2/16) of four.
    let mut target = Target::new(3, 1, 4, TextureFormat::Rgba32Float);
    let vertices = left_of(&target, 1.4375);
    let state = State {
        sample_mask: 0b1110,
        ..State::new(3, 1)
    };
    let read = |target: &Target, pixel: u32, sample: u32| {
        target.color[target.index([pixel, 0], sample)].map(f32::from_bits)
    };
    draw_with(&mut target, &Places, &state, &vertices);
    // The state's mask keeps 1, 2, 3 of pixel 0 and 2 of pixel 1; the shader's then drops 3.
    let [center, centroid, coverage, _] = read(&target, 1, 2);
    assert!((center - 1.5).abs() < 1e-5 && (centroid - 1.125).abs() < 1e-5);
    assert_eq!(coverage, 4.0);
    assert_eq!(read(&target, 0, 1)[2], 14.0);
    // Not all samples are kept, so the centroid is the first of the kept ones.
    assert!((read(&target, 0, 1)[1] - 0.875).abs() < 1e-5);
    for (pixel, sample) in [(0, 0), (0, 3), (1, 0), (1, 1), (1, 3), (2, 0)] {
        assert_eq!(
            read(&target, pixel, sample),
            [0.0; 4],
            "sample {sample} of pixel {pixel}"
        );
    }

    // With all samples covered the centroid is the centre.
    let mut target = Target::new(3, 1, 4, TextureFormat::Rgba32Float);
    draw_with(&mut target, &Places, &State::new(3, 1), &vertices);
    let [center, centroid, coverage, _] = read(&target, 0, 0);
    assert_eq!((center, coverage), (centroid, 15.0));
}

/// A varying at each sample, and one at the centre.
struct Interpolated;

estampe_types::shader! {
    impl Shader for Interpolated {
        type Attributes<R: Real> = (Vec4<R>, Vec3<R>);
        type Varyings<R: Real> = (PerSample<[R; 1]>, [R; 1]);

        fn vertex<R: Real>(
            &self,
            _input: shader::VertexIn<'_, R>,
            (position, value): (Vec4<R>, Vec3<R>),
        ) -> shader::VertexOut<R, Self::Varyings<R>> {
            shader::VertexOut::new(position, (PerSample([value.x]), [value.y]))
        }

        fn fragment<R: Real>(
            &self,
            _input: FragmentIn<'_, R>,
            (PerSample([x]), [y]): Self::Varyings<R>,
        ) -> FragmentOut<R> {
            FragmentOut::color(Vec4::new(x, y, x.ddx(), y.ddy()))
        }
    }
}

/// Rows: R6, R7.
#[test]
fn one_per_sample_varying_makes_shading_per_sample() {
    let mut target = Target::new(2, 2, 8, TextureFormat::Rgba32Float);
    let vertices = left_of(&target, 9.0);
    draw_with(&mut target, &Interpolated, &State::new(2, 2), &vertices);
    for (s, &[dx, dy]) in (0_u32..).zip(sample_positions(8)) {
        let index = target.index([1, 0], s);
        let [x, y, per_x, per_y] = target.color[index].map(f32::from_bits);
        let wanted = [1.0 + f32::from(dx) / 16.0, f32::from(dy) / 16.0];
        assert!((x - wanted[0]).abs() < 1e-5 && (y - wanted[1]).abs() < 1e-5);
        assert!((per_x - 1.0).abs() < 1e-4 && (per_y - 1.0).abs() < 1e-4);
    }
}
