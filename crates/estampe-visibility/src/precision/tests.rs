//! The depths against the pipeline's own, the separations against the formulas.

use super::*;
use estampe::state::{CompareFunction, DepthState, PrimitiveTopology, VertexBufferLayout};
use estampe::{
    DepthStencilAttachment, Device, DeviceDescriptor, Draw, FragmentIn, FragmentOut, Level,
    RenderPass, RenderPipelineDescriptor, TextureDescriptor, Vec3, Vec4, VertexFormat, VertexIn,
    VertexOut, bytes_of,
};
use fastrand::Rng;

/// Points at pixels, each at a distance.
struct Hyperbolic(DepthMethod);

/// [`Hyperbolic`] with the depth of the fragment shader.
struct Logarithmic(Hyperbolic);

estampe::shader! {
    impl Shader for Hyperbolic {
        type Attributes<R: Real> = Vec3<R>; // x and y in NDC, distance
        type Varyings<R: Real> = R; // w

        fn vertex<R: Real>(&self, input: VertexIn<'_, R>, a: Vec3<R>) -> VertexOut<R, R> {
            let zero = input.real(0.0);
            let matrix = self.0.clip_from_view(1.0, 1.0);
            let clip = matrix.transform_point(Vec3::new(zero, zero, -a.z));
            let w = clip.w;
            VertexOut::new(Vec4::new(a.x * w, a.y * w, clip.z, w), w)
        }

        fn fragment<R: Real>(&self, _: FragmentIn<'_, R>, w: R) -> FragmentOut<R> {
            let _ = w;
            FragmentOut::none()
        }
    }
}

estampe::shader! {
    impl Shader for Logarithmic {
        type Attributes<R: Real> = Vec3<R>;
        type Varyings<R: Real> = R;

        fn vertex<R: Real>(&self, input: VertexIn<'_, R>, a: Vec3<R>) -> VertexOut<R, R> {
            self.0.vertex(input, a)
        }

        fn fragment<R: Real>(&self, _: FragmentIn<'_, R>, w: R) -> FragmentOut<R> {
            FragmentOut::none().with_depth(self.0.0.logarithmic_depth(w))
        }
    }
}

const SIDE: usize = 64;

/// The depths that the pipeline stores for surfaces at distances, one pixel each.
fn drawn(device: &Device, method: DepthMethod, distances: &[f32]) -> Vec<f32> {
    assert_eq!(distances.len(), SIDE * SIDE);
    let ndc = |at: usize| (at as f32 + 0.5) * (2.0 / SIDE as f32) - 1.0;
    let vertex = |(i, z): (usize, &f32)| [ndc(i % SIDE), -ndc(i / SIDE), *z];
    let numbers: Vec<f32> = distances.iter().enumerate().flat_map(vertex).collect();
    let vertices = device
        .create_buffer_with_contents(bytes_of(&numbers))
        .expect("small");
    let mut descriptor = if method.mapping.is_logarithmic {
        RenderPipelineDescriptor::new(Logarithmic(Hyperbolic(method)))
    } else {
        RenderPipelineDescriptor::new(Hyperbolic(method))
    };
    descriptor.vertex_buffers = vec![VertexBufferLayout::packed(&[VertexFormat::Float32x3])];
    descriptor.primitive.topology = PrimitiveTopology::PointList;
    descriptor.targets = Vec::new();
    let always = DepthState {
        write_enabled: true,
        compare: CompareFunction::Always,
    };
    descriptor.depth_stencil = Some(always.into());
    let pipeline = device
        .create_render_pipeline(&descriptor)
        .expect("a valid pipeline");
    let side = u32::try_from(SIDE).expect("small");
    let texture = TextureDescriptor::new_2d(side, side, method.format.texture_format());
    let texture = device.create_texture(&texture).expect("small");
    // A depth that no surface has.
    let clear = DepthStencilAttachment::clear(&texture.view(), 0.625);
    let buffers = [(&vertices).into()];
    let draw = Draw {
        vertex_buffers: &buffers,
        ..Draw::new(&pipeline, 0..side * side)
    };
    let pass = RenderPass {
        depth_stencil_attachment: Some(clear),
        draws: &[draw],
        ..RenderPass::default()
    };
    device.render(&pass).expect("a valid pass");
    let bytes = device.read_sample(&texture.view(), 0).expect("readable");
    if method.format == DepthFormat::Unorm16 {
        let codes = bytes.as_chunks::<2>().0.iter();
        codes
            .map(|code| f32::from(u16::from_le_bytes(*code)) / 65_535.0)
            .collect()
    } else {
        let words = bytes
            .as_chunks::<4>()
            .0
            .iter()
            .map(|word| u32::from_le_bytes(*word));
        if method.format == DepthFormat::Unorm24 {
            words.map(|code| code as f32 / 16_777_215.0).collect()
        } else {
            words.map(f32::from_bits).collect()
        }
    }
}

/// Methods of all formats and mappings, with random planes.
fn methods(random: &mut Rng) -> Vec<DepthMethod> {
    let mut methods = Vec::new();
    for format in DepthFormat::ALL {
        for mapping in DepthMapping::ALL {
            let near = libm::exp10f(random.f32() * 6.0 - 4.0);
            let far = near * (1.5 + libm::exp10f(random.f32() * 6.0));
            methods.extend(DepthMethod::new([near, far], format, mapping));
            methods.extend(DepthMethod::new([near, f32::INFINITY], format, mapping));
        }
    }
    assert_eq!(methods.len(), 3 * (4 + 2));
    methods
}

/// A distance between the planes, evenly in its logarithm.
fn distance(random: &mut Rng, method: &DepthMethod) -> f32 {
    let [near, far] = method.planes();
    let far = far.min(near * 1e7);
    let share = random.f32();
    (near * libm::powf(far / near, share)).clamp(near, far)
}

/// The stored depths are the pipeline's, bit for bit, at every SIMD level and number of threads.
/// Rows: D2.
#[test]
fn stored_depths_are_those_that_the_pipeline_stores() {
    let mut random = Rng::with_seed(18);
    let (mut compared, mut clipped) = (0, 0);
    for level in Level::all_available() {
        for threads in [1, 3] {
            let device = Device::new(&DeviceDescriptor {
                level,
                threads,
                ..DeviceDescriptor::default()
            });
            let device = device.expect("the system starts threads");
            for method in methods(&mut random) {
                let distances: Vec<f32> = (0..SIDE * SIDE)
                    .map(|_| distance(&mut random, &method))
                    .collect();
                let stored = drawn(&device, method, &distances);
                for (distance, stored) in distances.iter().zip(stored) {
                    let [a, b] = method.clip;
                    // Next to a plane, rounding moves some surfaces out of the volume.
                    let z = -distance * a + b;
                    if !(0.0..=*distance).contains(&z) {
                        clipped += 1;
                        continue;
                    }
                    compared += 1;
                    assert_eq!(method.stored(*distance), stored, "{method:?} at {distance}");
                }
            }
        }
    }
    assert!(
        compared > 100_000 && clipped < compared / 50,
        "{compared} {clipped}"
    );
}

/// No pair at the measured separation or more is confused, and some pair of little less is.
/// Rows: D2.
#[test]
fn the_measured_separation_is_the_least() {
    let mut random = Rng::with_seed(2);
    let (mut finite, mut infinite) = (0, 0);
    for _ in 0..12 {
        for method in methods(&mut random) {
            let at = distance(&mut random, &method);
            let [_, far] = method.planes();
            let Some(least) = method.least_separation(f64::from(at)) else {
                // The farthest surface is confused with one at or before `at`.
                infinite += 1;
                let farthest = far.min(1e30);
                assert!(
                    !method.tells_apart(at, farthest) || confused_before(&method, at, farthest),
                    "{method:?} at {at}"
                );
                continue;
            };
            finite += 1;
            for _ in 0..400 {
                let wider = least * 1.002 + random.f64() * least;
                #[expect(
                    clippy::cast_possible_truncation,
                    reason = "a distance of the pipeline"
                )]
                let [a, b] = {
                    let from = f64::from(at) - random.f64() * wider;
                    [from, from + wider].map(|z| z as f32)
                };
                if a >= method.planes()[0] && b <= far && a <= at && at <= b {
                    assert!(
                        method.tells_apart(a, b),
                        "{method:?}: {a} and {b} around {at}"
                    );
                }
            }
        }
    }
    assert!(finite > 150 && infinite >= 10, "{finite} {infinite}");
}

/// True if some distance a little before `at` is confused with the farthest.
fn confused_before(method: &DepthMethod, at: f32, farthest: f32) -> bool {
    let near = method.planes()[0];
    let shares = (0..2000).map(|i| i as f32 / 2000.0);
    let mut distances = shares.map(|share| at - (at - near) * share * share);
    distances.any(|from| !method.tells_apart(from, farthest))
}

/// The measurement is one step of the format, wherever the steps lie, give or take the rounding of
/// f32: for 16 bits that is nothing.
/// Rows: D2.
#[test]
fn the_measurement_follows_the_formula() {
    let mut random = Rng::with_seed(4);
    let mut compared = [0; 3];
    for _ in 0..40 {
        for method in methods(&mut random) {
            let at = f64::from(distance(&mut random, &method));
            let (Some(least), Some(formula)) = (method.least_separation(at), method.formula(at))
            else {
                continue;
            };
            // The step that contains the distance starts at most one step before it.
            let depth = method.depth(at);
            let step = method.format().step(depth);
            let before = if method.mapping().is_reversed {
                depth + step
            } else {
                depth - step
            };
            let first = method.distance(before).max(f64::from(method.planes()[0]));
            let Some(lower) = method.formula(first) else {
                continue;
            };
            let ulp = at / 8_388_608.0;
            let slack = match method.format() {
                DepthFormat::Unorm16 => 1.03,
                // Rounding of f32 is as large as the steps, or larger next to the near plane.
                DepthFormat::Unorm24 | DepthFormat::Float32 => 20.0,
            };
            let is_rounding = method.format() == DepthFormat::Float32
                && !method.mapping().is_reversed
                || method.format() != DepthFormat::Unorm16 && method.mapping().is_logarithmic;
            compared[0] += 1;
            if !is_rounding {
                compared[1] += 1;
                assert!(
                    least <= formula * slack + 4.0 * ulp,
                    "{method:?} at {at}: {least} {formula}"
                );
            }
            if method.format() == DepthFormat::Unorm16 {
                compared[2] += 1;
                assert!(
                    least * 1.03 + 2.0 * ulp >= lower,
                    "{method:?} at {at}: {least} {lower}"
                );
            }
        }
    }
    assert!(compared.iter().all(|count| *count > 150), "{compared:?}");
}

/// Claims of `docs/depth.md`.
/// Rows: D2.
#[test]
fn sixteen_bits_do_not_resolve_a_centimetre_at_a_kilometre() {
    let (distance, separation) = (1000.0, 0.01);
    let near = DepthFormat::Unorm16.least_near(distance, separation, f64::INFINITY);
    assert!(
        near.is_some_and(|near| near > 1500.0),
        "beyond the surfaces: {near:?}"
    );
    // The far plane right behind the surfaces: the near plane is 600 m away.
    let near = DepthFormat::Unorm16.least_near(distance, separation, 1000.02);
    assert!(
        near.is_some_and(|near| (600.0..610.0).contains(&near)),
        "{near:?}"
    );
    let plain = DepthMapping::default();
    for near in [0.01, 0.1, 1.0, 10.0, 100.0, 500.0] {
        let method = DepthMethod::new([near, 1001.0], DepthFormat::Unorm16, plain).expect("valid");
        let least = method.least_separation(distance);
        assert!(
            least.is_none_or(|least| least > 0.0105),
            "{near}: {least:?}"
        );
    }
    let method = DepthMethod::new([620.0, 1001.0], DepthFormat::Unorm16, plain).expect("valid");
    assert!(
        method
            .least_separation(distance)
            .is_some_and(|least| least < 0.01)
    );
}

/// The formulas are their own inverses and differences.
/// Rows: D2.
#[test]
fn formulas_agree_with_each_other() {
    let mut random = Rng::with_seed(5);
    for _ in 0..100 {
        for method in methods(&mut random) {
            let z = f64::from(distance(&mut random, &method));
            let depth = method.depth(z);
            assert!(
                (-1e-12..1.0 + 1e-12).contains(&depth),
                "{method:?} {z} {depth}"
            );
            let back = method.distance(depth);
            let [near, far] = method.planes().map(f64::from);
            // The depths of hyperbolas crowd at one end.
            let tolerance = if method.mapping().is_reversed && !method.mapping().is_logarithmic {
                1e-9
            } else {
                1e-9 * (z / near).max(1.0)
            };
            assert!((back - z).abs() <= tolerance * z, "{method:?}: {z} {back}");
            if let Some(separation) = method.formula(z) {
                assert!(z + separation <= far * (1.0 + 1e-12));
                let next = method.depth(z + separation);
                let step = method.format().step(depth);
                assert!(
                    ((next - depth).abs() / step - 1.0).abs() < 0.01 + 1e-15 / step,
                    "{method:?} {z}"
                );
            }
        }
    }
    // A hyperbola of b bits: about z²/(n·2ᵇ).
    let method = DepthMethod::new(
        [0.01, f32::INFINITY],
        DepthFormat::Unorm24,
        DepthMapping::default(),
    );
    let separation = method.expect("valid").formula(50.0).expect("resolved");
    let expected = 2500.0 / (0.01 * 16_777_216.0);
    assert!(
        (separation / expected - 1.0).abs() < 1e-3,
        "{separation} {expected}"
    );
}

#[test]
fn impossible_planes_are_errors() {
    use PrecisionError::{Far, InfiniteLogarithm, Near};
    let plain = DepthMapping::default();
    let new = |planes, mapping| DepthMethod::new(planes, DepthFormat::Unorm24, mapping);
    for near in [0.0, -1.0, f32::NAN, f32::INFINITY, 1e-31, 1e31] {
        assert!(matches!(new([near, 1e5], plain), Err(Near(_))), "{near}");
    }
    for far in [1.0, 0.5, -1.0, f32::NAN, 1e31, f32::NEG_INFINITY] {
        assert!(matches!(new([1.0, far], plain), Err(Far { .. })), "{far}");
    }
    let logarithmic = DepthMapping::ALL[2];
    assert_eq!(
        new([1.0, f32::INFINITY], logarithmic),
        Err(InfiniteLogarithm)
    );
    // The extremes work, and distances outside of the planes have no separation.
    for mapping in DepthMapping::ALL {
        for format in DepthFormat::ALL {
            for planes in [
                [1e-30, 1e30],
                [1.0, 1.000_000_1],
                [1e-30, 2e-30],
                [9e29, 1e30],
            ] {
                let method = DepthMethod::new(planes, format, mapping).expect("valid");
                for z in [
                    planes[0],
                    1.0,
                    planes[1],
                    0.0,
                    f32::NAN,
                    f32::INFINITY,
                    -1.0,
                ] {
                    let z = f64::from(z);
                    let least = method.least_separation(z);
                    assert!(
                        least.is_none_or(|least| least > 0.0),
                        "{method:?} {z} {least:?}"
                    );
                    let _ = (method.formula(z), method.depth(z), method.distance(z));
                }
            }
        }
    }
}
