//! Comparisons at shifts from a place, which soft shadows ask for, give what each gives alone.

use super::Random;
use super::requests::{bits, packets};
use estampe_simd::{LANES, Level, Packet};
use estampe_texture::{
    PacketPlaces, ShadowMap, compare_packets, compare_shifted, sample_compare_sum, shifted,
};
use estampe_types::shader::{VertexOut, interface_of};
use estampe_types::{FragmentIn, FragmentOut, Vec2, Vec3, Vec4, VertexIn};

#[test]
fn comparisons_at_shifts_are_those_at_shifted_coordinates() {
    // A plane at ½ with a rough square in it.
    let random = &mut Random::new(9);
    let rows: Vec<f32> = (0..64 * 64)
        .map(|at| match [at % 64, at / 64] {
            [20..40, 20..40] => random.unit(),
            _ => 0.5,
        })
        .collect();
    let map = ShadowMap::from_rows(64, 64, &rows);
    let square = |side: usize| -> Vec<[f32; 2]> {
        let at = |tap: usize| [tap % side, tap / side].map(|at| at as f32 / 64.0 - 1.0 / 64.0);
        (0..side * side).map(at).collect()
    };
    let filters = [
        vec![[-0.0; 2]],
        square(2),
        square(3),
        square(4),
        vec![[0.1, 0.0], [f32::INFINITY, f32::NAN], [-0.1, -0.2]],
    ];
    let [mut lit, mut dark, mut mixed] = [0; 3];
    for level in Level::all_available() {
        for round in 0..200 {
            let shifts = &filters[round % filters.len()];
            let step = [0.0, 1.0 / 64.0, 0.2][round % 3];
            // For each packet something else, the reference, u and v.
            let of_packets: Vec<[Packet<f32>; 4]> = (0..5)
                .map(|number| {
                    let place = [random.unit() * 1.4 - 0.2, random.unit() * 1.4 - 0.2];
                    let [mut u, v] = packets(place, step);
                    if round % 20 == number {
                        u.0[5] = f32::NAN;
                    }
                    let reference = Packet([0.4 + random.unit() * 0.4; LANES]);
                    [Packet([7.0; LANES]), reference, u, v]
                })
                .collect();
            let places = PacketPlaces {
                scalars: of_packets.as_flattened(),
                stride: 4,
                at: [2, 3],
                gradients: None,
            };
            let mut together = vec![Packet([7.0; LANES]); of_packets.len() * shifts.len()];
            compare_shifted(&map, level, (&places, (1, -0.1)), shifts, &mut together);
            let mut alone = Vec::new();
            for [_, reference, u, v] in &of_packets {
                let reference = Packet(reference.0.map(|depth| depth - 0.1));
                for shift in shifts {
                    let [u, v] = &shifted([u, v], *shift);
                    let mut share = [Packet([7.0; LANES])];
                    compare_packets(&map, level, (&[[u, v]], &reference), &mut share);
                    alone.extend(share);
                }
            }
            assert_eq!(bits(&together), bits(&alone), "{level:?} {shifts:?}");
            for share in together.iter().flat_map(|packet| packet.0) {
                match share {
                    1.0 => lit += 1,
                    0.0 => dark += 1,
                    _ => mixed += 1,
                }
            }
        }
    }
    assert!(
        lit > 1000 && dark > 1000 && mixed > 1000,
        "{lit} {dark} {mixed}"
    );
}

/// The shadow of a map that is bound.
struct Shadowed;

estampe_types::shader! {
    impl Shader for Shadowed {
        type Attributes<R: Real> = Vec4<R>;
        type Varyings<R: Real> = Vec3<R>;

        fn vertex<R: Real>(&self, _: VertexIn<'_, R>, at: Vec4<R>) -> VertexOut<R, Vec3<R>> {
            VertexOut::new(at, at.xyz())
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, at: Vec3<R>) -> FragmentOut<R> {
            let offsets = [[0.0, 0.0], [0.25, 0.0]];
            let lit = match input.bindings.shadow_map(0, 0) {
                Some(map) => sample_compare_sum(map, Vec2::new(at.x, at.y), &offsets, at.z),
                None => at.x,
            };
            FragmentOut::color(Vec4::repeat(lit))
        }
    }
}

/// So fragments of several triangles are shaded in one packet.
#[test]
fn comparisons_with_a_map_that_is_bound_take_no_derivatives() {
    let interface = interface_of(&Shadowed).expect("it is valid");
    assert!(interface.no_derivatives && !interface.color_passthrough);
}
