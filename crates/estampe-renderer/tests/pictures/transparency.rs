//! The methods of transparency against the fragments of each pixel, which the oracle lists.

use crate::support::{DEVICES, drawn_alike};
use estampe::state::BlendState;
use estampe::{PixelHistory, TestOutcome, TextureFormat};
use estampe_reference::blending::{BlendInputs, blend};
use estampe_reference::color::{Codes, decode, encode, resolve};
use estampe_renderer::{
    CameraOptions, Eye, ProjectionKind, RenderError, RenderOptions, Shading, Transparency,
    TransparentLayers, inspect, inspect_stages,
};
use estampe_scene::{AlphaMode, Material, Mesh, Scene, Surface};
use fastrand::Rng;
use glam::{DVec3, Vec3};

const SIZE: [u32; 2] = [26, 22];
const FORMAT: TextureFormat = TextureFormat::Rgba8UnormSrgb;

/// A triangle with its linear colour; it is transparent if its opacity is less than 1.
#[derive(Debug, Clone, Copy)]
struct Pane {
    corners: [Vec3; 3],
    color: Vec3,
    opacity: f32,
}

impl Pane {
    fn random(random: &mut Rng, opacity: f32) -> Self {
        let mut vector =
            |size: f32| Vec3::from([(); 3].map(|()| (random.f32() * 2.0 - 1.0) * size));
        let middle = vector(0.4);
        Self {
            corners: [(); 3].map(|()| middle + vector(2.2)),
            color: vector(0.5) + 0.5,
            opacity,
        }
    }

    /// A triangle over most of the picture at this height, parallel to it.
    fn level(z: f32, color: Vec3, opacity: f32) -> Self {
        let corners = [(-2.0, -1.0), (2.0, -1.0), (0.0, 2.0)];
        Self {
            corners: corners.map(|(x, y)| Vec3::new(x, y, z)),
            color,
            opacity,
        }
    }
}

/// A mesh of triangles, each with its own material.
fn scene(panes: &[Pane]) -> Scene {
    let indices = 0..u32::try_from(panes.len()).expect("few");
    let mesh = Mesh {
        positions: panes.iter().flat_map(|pane| pane.corners).collect(),
        normals: vec![Vec3::Z; panes.len() * 3],
        triangles: indices.map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(),
        surfaces: (0..panes.len())
            .map(|index| Surface {
                material: Some(index),
                triangles: index..index + 1,
            })
            .collect(),
        ..Mesh::default()
    };
    let material = |pane: &Pane| Material {
        base_color: pane.color,
        opacity: pane.opacity,
        alpha_mode: match pane.opacity < 1.0 {
            true => AlphaMode::Blend,
            false => AlphaMode::Opaque,
        },
        ..Material::default()
    };
    Scene {
        meshes: vec![mesh],
        materials: panes.iter().map(material).collect(),
        ..Scene::default()
    }
}

/// Base colours, seen along −z.
fn options(samples: u32, transparency: Transparency) -> RenderOptions {
    RenderOptions {
        width: SIZE[0],
        height: SIZE[1],
        samples,
        shading: Shading::Unlit,
        camera: CameraOptions {
            eye: Eye::At(DVec3::new(0.0, 0.0, 5.0)),
            target_world: Some(DVec3::ZERO),
            projection: ProjectionKind::Perspective { fov_y_deg: 40.0 },
            ..CameraOptions::default()
        },
        transparency,
        ..RenderOptions::default()
    }
}

/// A transparent fragment at a sample: its depth, colour and alpha, and the depth at the pixel's
/// centre.
#[derive(Debug, Clone, Copy)]
struct Layer {
    depth: f32,
    color: [f32; 4],
    depth_at_center: f32,
}

/// What the oracle has at one sample of a pixel.
#[derive(Debug, Clone, Default)]
struct SampleLayers {
    /// The codes of the opaque surfaces.
    behind: Codes,
    /// The transparent fragments before them, in the order of the draws.
    layers: Vec<Layer>,
}

/// The layers of each sample, from the history of the frame whose transparent triangles are sorted.
fn layers(history: &PixelHistory) -> Vec<SampleLayers> {
    let mut samples: Vec<SampleLayers> = history
        .initial
        .iter()
        .map(|values| SampleLayers {
            behind: values.codes[0].expect("a colour attachment"),
            layers: Vec::new(),
        })
        .collect();
    for fragment in history
        .primitives
        .iter()
        .flat_map(|record| &record.fragments)
    {
        for test in &fragment.samples {
            if test.outcome != TestOutcome::Passed {
                continue;
            }
            let sample = &mut samples[test.sample as usize];
            let color = fragment.colors[0];
            if color[3] < 1.0 {
                sample.layers.push(Layer {
                    depth: test.depth,
                    color,
                    depth_at_center: fragment.position[2],
                });
            } else {
                sample.behind = test.after.codes[0].expect("a colour attachment");
            }
        }
    }
    samples
}

impl SampleLayers {
    /// The layers blended from the farthest on, rounded to the attachment's codes each time.
    fn composite(&self) -> Codes {
        let mut sorted = self.layers.clone();
        sorted.sort_by(|a, b| b.depth.total_cmp(&a.depth));
        let over = |behind, layer: &Layer| {
            let inputs = BlendInputs {
                source: layer.color,
                second: [0.0; 4],
                constant: [0.0; 4],
                destination: decode(FORMAT, behind),
            };
            encode(FORMAT, blend(&BlendState::ALPHA_BLENDING, &inputs))
        };
        sorted.iter().fold(self.behind, over)
    }

    /// The weighted composite by the formulas of McGuire and Bavoil, in f64, linear.
    fn weighted(&self) -> [f64; 3] {
        let (mut sum, mut sum_of_alphas, mut revealage) = (DVec3::ZERO, 0.0, 1.0);
        for layer in &self.layers {
            let [r, g, b, alpha] = layer.color.map(f64::from);
            let near = 1.0 - f64::from(layer.depth_at_center);
            let weight = alpha * (3e3 * near * near * near).max(1e-2);
            sum += DVec3::new(r, g, b) * alpha * weight;
            sum_of_alphas += alpha * weight;
            revealage *= 1.0 - alpha;
        }
        let [r, g, b, _] = decode(FORMAT, self.behind).map(f64::from);
        let behind = DVec3::new(r, g, b);
        if self.layers.is_empty() {
            return behind.to_array();
        }
        (sum / sum_of_alphas * (1.0 - revealage) + behind * revealage).to_array()
    }
}

fn pixels() -> impl Iterator<Item = [u32; 2]> {
    (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| [x, y]))
}

/// Opaque and transparent triangles that cross; one transparent one is there twice, in two colours.
fn random_panes(random: &mut Rng) -> Vec<Pane> {
    let mut panes: Vec<Pane> = (0..3).map(|_| Pane::random(random, 1.0)).collect();
    for _ in 0..9 {
        let opacity = 0.15 + 0.75 * random.f32();
        panes.push(Pane::random(random, opacity));
    }
    let twin = Pane {
        color: Vec3::new(1.0, 0.1, 0.4),
        ..panes[5]
    };
    panes.push(twin);
    panes
}

/// Each pixel of exact transparency is the composite of its own fragments in the order of their
/// depths, byte for byte, in colours of 8 bits, at every SIMD level; sorted triangles are not.
///
/// Rows: D6, U3.
#[test]
fn exact_is_the_composite_of_each_samples_sorted_fragments() {
    let mut random = Rng::with_seed(0xD6_2026);
    let (mut deepest, mut ties, mut hidden, mut sorted_differs) = (0, 0, 0, 0);
    for (number, samples) in [1, 4, 1, 4, 1].into_iter().enumerate() {
        let scene = scene(&random_panes(&mut random));
        let sorted_options = options(samples, Transparency::Sorted);
        let sorted = drawn_alike(&scene, &sorted_options);
        let exact = drawn_alike(&scene, &options(samples, Transparency::Exact));
        let mut most = 0;
        for pixel in pixels() {
            let history = inspect(&scene, &sorted_options, &DEVICES[0], pixel);
            let found = layers(&history.expect("small").history);
            let codes: Vec<Codes> = found.iter().map(SampleLayers::composite).collect();
            let expected = resolve(FORMAT, &codes).map(|code| u8::try_from(code).expect("8 bits"));
            let [x, y] = pixel;
            let drawn = exact.image.texel(x, y);
            assert_eq!(
                drawn, expected,
                "scene {number}, pixel {pixel:?}: {found:?}"
            );
            sorted_differs += u32::from(sorted.image.texel(x, y) != drawn);
            for sample in &found {
                most = most.max(sample.layers.len());
                let is_hidden = sample.layers.is_empty() && sample.behind[0] != 0xf2;
                hidden += u32::from(is_hidden);
                let mut depths: Vec<f32> = sample.layers.iter().map(|layer| layer.depth).collect();
                depths.sort_by(f32::total_cmp);
                ties += u32::from(depths.windows(2).any(|pair| pair[0] == pair[1]));
            }
        }
        let peeled = exact.layers.expect("it was peeled");
        assert!(peeled.is_complete);
        assert!(peeled.count as usize >= most - 1, "{peeled:?} {most}");
        assert_eq!(sorted.layers, None);
        deepest = deepest.max(most);
    }
    assert!(deepest >= 6, "{deepest} layers");
    assert!(ties > 50, "{ties} samples have two fragments of one depth");
    assert!(hidden > 50, "{hidden} samples show opaque triangles alone");
    assert!(sorted_differs > 200, "{sorted_differs} pixels");
}

/// Two triangles that cross along the picture's middle: sorting blends one of them wrongly on one
/// side; triangles that do not cross are right.
///
/// Rows: D6.
#[test]
fn sorted_is_wrong_where_triangles_cross() {
    let tilted = |slope: f32, color| {
        let corners = [(-2.0, -2.0), (2.0, -2.0), (0.0, 2.5)];
        Pane {
            corners: corners.map(|(x, y)| Vec3::new(x, y, x * slope)),
            color,
            opacity: 0.5,
        }
    };
    let crossing = [tilted(0.4, Vec3::X), tilted(-0.4, Vec3::Y)];
    let apart = [
        Pane::level(0.2, Vec3::X, 0.5),
        Pane::level(-0.2, Vec3::Y, 0.5),
    ];
    let mut wrong = [0, 0];
    for (panes, wrong) in [crossing, apart].iter().zip(&mut wrong) {
        let scene = scene(panes);
        let [sorted, exact] = [Transparency::Sorted, Transparency::Exact]
            .map(|method| drawn_alike(&scene, &options(1, method)).image);
        *wrong = pixels()
            .filter(|&[x, y]| sorted.texel(x, y) != exact.texel(x, y))
            .map(|[x, _]| x)
            .collect::<Vec<_>>()
            .len();
    }
    // Each triangle is in front in one half of the pixels that both cover.
    let area = (SIZE[0] * SIZE[1]) as usize;
    assert!((area / 5..area * 3 / 5).contains(&wrong[0]), "{wrong:?}");
    assert_eq!(wrong[1], 0);
}

/// The pictures of weighted and of exact transparency do not depend on the order of the triangles;
/// weighted sums round by their order, by at most one code.
///
/// Rows: D6, U3.
#[test]
fn the_order_of_the_triangles_is_of_no_effect() {
    let mut random = Rng::with_seed(0xD6_0DE5);
    let mut rounded = 0;
    for samples in [1, 4, 1, 4] {
        let mut panes = random_panes(&mut random);
        // Fragments of one depth have an order: that of the scene.
        panes.pop();
        let picture =
            |panes: &[Pane], method| drawn_alike(&scene(panes), &options(samples, method));
        let weighted = picture(&panes, Transparency::Weighted).image;
        let exact = picture(&panes, Transparency::Exact).image;
        assert!(weighted != exact);
        for _ in 0..3 {
            random.shuffle(&mut panes);
            assert!(picture(&panes, Transparency::Exact).image == exact);
            let again = picture(&panes, Transparency::Weighted).image;
            for (a, b) in again.rgba.iter().zip(&weighted.rgba) {
                assert!(a.abs_diff(*b) <= 1, "{a} {b}");
                rounded += u32::from(a != b);
            }
        }
    }
    assert!(rounded < 20, "{rounded} codes differ");
}

/// Weighted pictures are those of the formulas, within one code.
///
/// Rows: D6.
#[test]
fn weighted_is_its_formula() {
    let mut random = Rng::with_seed(0xD6_3E19);
    let mut blended = 0;
    for _ in 0..3 {
        let scene = scene(&random_panes(&mut random));
        let sorted = options(1, Transparency::Sorted);
        let weighted = drawn_alike(&scene, &options(1, Transparency::Weighted)).image;
        for pixel in pixels() {
            let history = inspect(&scene, &sorted, &DEVICES[0], pixel).expect("small");
            let found = &layers(&history.history)[0];
            #[expect(clippy::cast_possible_truncation, reason = "rounded on purpose")]
            let [r, g, b] = found.weighted().map(|channel| channel as f32);
            let expected = encode(FORMAT, [r, g, b, 1.0]);
            let drawn = weighted.texel(pixel[0], pixel[1]).map(u32::from);
            let near = drawn.iter().zip(expected).all(|(a, b)| a.abs_diff(b) <= 1);
            assert!(near, "{pixel:?}: {drawn:?} {expected:?} {found:?}");
            if found.layers.is_empty() {
                assert_eq!(drawn, expected, "no fragment changes nothing");
            }
            blended += u32::from(found.layers.len() > 1);
        }
    }
    assert!(blended > 200, "{blended}");
}

/// One layer is the same by exact and by sorted transparency, byte for byte; so is a scene without
/// any, by all methods, and pictures with a transparent background.
///
/// Rows: D6.
#[test]
fn methods_agree_where_they_must() {
    let opaque = scene(&[
        Pane::level(0.3, Vec3::X, 1.0),
        Pane::level(0.0, Vec3::Y, 1.0),
    ]);
    let one = scene(&[
        Pane::level(0.3, Vec3::new(0.2, 0.5, 0.7), 0.3),
        Pane::level(0.0, Vec3::Y, 1.0),
    ]);
    for background in [None, Some([10, 200, 90])] {
        for samples in [1, 4] {
            let picture = |scene, method| {
                let options = RenderOptions {
                    background,
                    ..options(samples, method)
                };
                drawn_alike(scene, &options).image
            };
            for method in [Transparency::Exact, Transparency::Weighted] {
                let sorted = picture(&opaque, Transparency::Sorted);
                assert!(picture(&opaque, method) == sorted, "{method:?}");
            }
            let sorted = picture(&one, Transparency::Sorted);
            assert!(picture(&one, Transparency::Exact) == sorted);
            let weighted = picture(&one, Transparency::Weighted);
            let codes = weighted.rgba.iter().zip(&sorted.rgba);
            let greatest = codes.map(|(a, b)| a.abs_diff(*b)).max();
            assert!(
                greatest <= Some(1),
                "one layer is its own mean: {greatest:?}"
            );
        }
    }
}

/// Layers beyond the most that are peeled are not lost: their triangles are sorted.
///
/// Rows: D6.
#[test]
fn more_layers_than_are_peeled_are_sorted() {
    let stack = |count: u16| -> Vec<Pane> {
        let pane = |index: u16| {
            let share = f32::from(index) / f32::from(count);
            Pane::level(share - 0.5, Vec3::new(share, 0.5, 1.0 - share), 0.06)
        };
        (0..count).map(pane).collect()
    };
    for (count, is_complete) in [(128, true), (129, false)] {
        let scene = scene(&stack(count));
        let sorted = drawn_alike(&scene, &options(1, Transparency::Sorted)).image;
        let exact = drawn_alike(&scene, &options(1, Transparency::Exact));
        assert!(exact.image == sorted, "{count} layers");
        let expected = TransparentLayers {
            count: Transparency::MOST_LAYERS,
            is_complete,
        };
        assert_eq!(exact.layers, Some(expected), "{count}");
    }
}

/// Frames of several passes cannot be inspected, which the error says.
#[test]
fn only_one_pass_is_inspected() {
    let glass = scene(&[Pane::level(0.0, Vec3::X, 0.5)]);
    let wall = scene(&[Pane::level(0.0, Vec3::X, 1.0)]);
    for method in [Transparency::Exact, Transparency::Weighted] {
        let options = options(1, method);
        let pixel = inspect(&glass, &options, &DEVICES[0], [3, 3]);
        assert_eq!(pixel, Err(RenderError::InspectUnsorted));
        let stages = inspect_stages(&glass, &options, &DEVICES[0]);
        assert_eq!(stages, Err(RenderError::InspectUnsorted));
        assert!(inspect(&wall, &options, &DEVICES[0], [3, 3]).is_ok());
        assert!(inspect_stages(&wall, &options, &DEVICES[0]).is_ok());
    }
    let said = RenderError::InspectUnsorted.to_string();
    assert!(said.contains("sorted"), "{said}");
}
