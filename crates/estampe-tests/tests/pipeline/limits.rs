//! The greatest width and height, and the greatest numbers of attributes, buffers and varyings.
//! (Corners of the largest targets: `crates/estampe-gpu/tests/large_targets.rs`.)

use estampe_tests::geometry::{Style, Vertex, clip_at, triangles};
use estampe_tests::shaders::{Colored, Crowded};
use estampe_tests::{Case, CaseDraw, Random, check, check_some};
use estampe_types::BufferData;

/// Rows: N1, R1.
#[test]
fn the_longest_sides() {
    for size in [[16_384, 4], [4, 16_384], [16_383, 3]] {
        let mut random = Random::new("limits/sides", u64::from(size[0]));
        let mut case = Case::new(size, 1);
        let mut vertices = triangles(&mut random, Style::Large, size, 3);
        // Points at both ends.
        let ends = [[0.0, 0.0], size.map(|side| side as f32)];
        for [x, y] in ends {
            for [dx, dy] in [[-3.0, -3.0], [-3.0, 3.5], [3.5, -3.0]] {
                vertices.push(Vertex {
                    position: clip_at(size, [x + dx, y + dy], 0.25, 1.0),
                    values: [1.0, 0.5, 0.25, 1.0],
                });
            }
        }
        case.draws.push(CaseDraw::new(Colored, &vertices));
        check_some("limits/sides", &case);
    }
}

/// Rows: N1, V1, V2.
#[test]
fn all_attributes_of_all_buffers_and_all_varyings() {
    check("limits/inputs", 20, |random| {
        let mut case = Case::random_target(random);
        let style = random.pick(&[Style::Large, Style::Small, Style::AroundEye]);
        let vertices = triangles(random, style, case.size, 4);
        let mut draw = CaseDraw::new(Crowded, &vertices);
        // Two attributes in each of eight buffers; the first buffer's are position and values.
        for buffer in 1..8 {
            let mut layout = draw.buffers[0].0.clone();
            for attribute in &mut layout.attributes {
                attribute.shader_location += 2 * buffer;
            }
            let values = vertices.iter().flat_map(|_| [0; 8].map(|_| random.unit()));
            let values: Vec<f32> = values.collect();
            draw.buffers.push((layout, BufferData::from_f32s(&values)));
        }
        case.draws.push(draw);
        case
    });
}
