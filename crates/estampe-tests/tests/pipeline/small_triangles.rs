//! Many small triangles: listed pixels, fragments that share packets across triangles, and edges
//! that are set up sixteen at a time.

use estampe_tests::geometry::{Style, triangles};
use estampe_tests::shaders::{Colored, FlatColored, Halved, Probe};
use estampe_tests::{Case, CaseDraw, ExpectedPaths, Random, TestShader, check_paths};
use estampe_types::state::{CompareFunction, CullMode, DepthState};

/// Triangles of a few pixels, some drawn twice at the same depths, so that only their order tells
/// which is visible; in between a few larger ones.
fn case(random: &mut Random, shader: TestShader, size: [u32; 2], samples: u32) -> Case {
    let mut case = Case::new(size, samples);
    for _ in 0..2 {
        let mut vertices = Vec::new();
        for _ in 0..6 {
            let style = random.pick(&[Style::Small, Style::Tiny, Style::OnGrid]);
            let some = triangles(random, style, case.size, 40);
            vertices.extend_from_slice(&some);
            if random.once_in(2) {
                let mut others = triangles(random, style, case.size, 40);
                for (other, vertex) in others.iter_mut().zip(&some) {
                    other.position = vertex.position;
                }
                vertices.extend(others);
            }
            if random.once_in(3) {
                vertices.extend(triangles(random, Style::Large, case.size, 2));
            }
        }
        let mut draw = CaseDraw::new(shader.clone(), &vertices);
        let compare = random.pick(&[
            CompareFunction::Less,
            CompareFunction::Less,
            CompareFunction::LessEqual,
            CompareFunction::Always,
        ]);
        draw.depth = Some(DepthState {
            compare,
            write_enabled: !random.once_in(4),
        });
        draw.primitive.cull_mode = random.pick(&[CullMode::None, CullMode::Back]);
        draw.is_counted = random.once_in(4);
        case.draws.push(draw);
    }
    case
}

/// Rows: R1, O3.
#[test]
fn fragments_of_small_triangles_fill_packets() {
    let statistics = check_paths(
        "small_triangles/across",
        12,
        ExpectedPaths::default(),
        |random| {
            let shader = match random.below(2) {
                0 => Colored.into(),
                _ => Halved.into(),
            };
            case(random, shader, [150, 100], 1)
        },
    );
    let pixels = statistics.small_triangle_pixels;
    assert!(pixels > 0, "no pixels of small triangles were listed");
    let [fragments, packets] = statistics.fragments_across_triangles;
    // The last packet of a run is not full, and the runs are short. With one lane for each
    // triangle, half of the lanes and more would be empty.
    assert!(
        packets > 0 && fragments > packets * 10,
        "{fragments} fragments are in {packets} packets"
    );
}

/// Rows: R1, R6, O3.
#[test]
fn small_triangles_have_ids_where_their_shader_takes_derivatives() {
    for samples in [1, 4] {
        let topic = format!("small_triangles/ids_{samples}");
        let statistics = check_paths(&topic, 12, ExpectedPaths::default(), |random| {
            let shader = match random.below(3) {
                0 => FlatColored.into(),
                _ => Probe::random(random).into(),
            };
            case(random, shader, [150, 100], samples)
        });
        let listed = statistics.small_triangle_pixels;
        assert!(listed > 0, "no samples of small triangles were listed");
    }
}

/// Rows: R1, R6.
#[test]
fn edges_of_a_packets_triangles_are_set_up_together() {
    for samples in [1, 4] {
        let topic = format!("small_triangles/edges_{samples}");
        let statistics = check_paths(&topic, 8, ExpectedPaths::default(), |random| {
            // No triangle has 64 pixels in a row, so that nearly all are set up so.
            let mut case = case(random, Colored.into(), [60, 50], samples);
            let vertices = triangles(random, Style::Large, case.size, 24);
            case.draws.push(CaseDraw::new(Colored, &vertices));
            case
        });
        assert!(
            statistics.triangles_set_up_in_lanes > 0,
            "no edges were set up sixteen at a time"
        );
    }
}
