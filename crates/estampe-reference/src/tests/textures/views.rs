//! Texture views against specifications and textbooks: cubes, anisotropy, borders, offsets,
//! gathering, comparison.

use crate::tests::Random;
use crate::texture::cube;
use crate::texture::view::{ReferenceView, Sample};
use estampe_types::state::CompareFunction;
use estampe_types::{
    AddressMode, BorderColor, FilterMode, MipLevel, SamplerDescriptor, TexelData, TextureAspect,
    TextureDimension, TextureFormat, TextureShape, ViewDimension,
};
use std::sync::Arc;

/// A view of one-channel floats; `value` gives them by mip level and texel.
fn view(
    dimension: ViewDimension,
    [width, height, slices]: [u32; 3],
    levels: usize,
    sampler: SamplerDescriptor,
    mut value: impl FnMut(usize, [u32; 3]) -> f32,
) -> ReferenceView {
    let is_3d = dimension == ViewDimension::D3;
    let mut texels = Vec::new();
    let levels = (0..levels).map(|level| {
        let half = |side: u32| (side >> level).max(1);
        let placed = MipLevel {
            width: half(width),
            height: half(height),
            offset: u32::try_from(texels.len()).expect("small"),
        };
        let slices = if is_3d { half(slices) } else { slices };
        for slice in 0..slices {
            for y in 0..placed.height {
                texels.extend((0..placed.width).map(|x| value(level, [x, y, slice]).to_bits()));
            }
        }
        placed
    });
    let levels: Vec<_> = levels.collect();
    let texture = TexelData {
        format: TextureFormat::R32Float,
        shape: TextureShape {
            dimension: match dimension {
                ViewDimension::D1 => TextureDimension::D1,
                ViewDimension::D3 => TextureDimension::D3,
                _ => TextureDimension::D2,
            },
            depth_or_layers: slices,
            samples: 1,
        },
        texels: std::sync::Arc::new(texels.into()),
        is_opaque: false,
        alpha_maps: Arc::default(),
        squares: Arc::default(),
        levels: levels.clone(),
    };
    ReferenceView {
        texture: Arc::new(texture),
        dimension,
        levels: [0, levels.len()],
        layers: [0, if is_3d { 1 } else { slices }],
        aspect: TextureAspect::All,
        sampler,
    }
}

fn at(at: [f32; 3], lod: f32) -> Sample {
    Sample {
        at,
        layer: 0,
        lod,
        probes: 1,
        step: [0.0; 3],
        offset: [0; 3],
        reference: None,
    }
}

fn linear() -> SamplerDescriptor {
    SamplerDescriptor {
        mag_filter: FilterMode::Linear,
        min_filter: FilterMode::Linear,
        mipmap_filter: FilterMode::Linear,
        ..SamplerDescriptor::default()
    }
}

#[expect(clippy::cast_possible_truncation, reason = "small")]
fn whole(value: f64) -> i64 {
    value as i64
}

/// Rows: F2.
#[test]
fn blocks_of_texels_are_near_the_exact_mean() {
    let sides = [8_u32, 4, 16];
    let mut random = Random::new(5);
    let tiled = SamplerDescriptor {
        address_mode_w: AddressMode::Repeat,
        ..SamplerDescriptor::trilinear_repeat()
    };
    let mut noise = Vec::new();
    let block = view(ViewDimension::D3, sides, 2, tiled, |_, _| {
        noise.push(random.unit());
        noise[noise.len() - 1]
    });
    let texel = |level: usize, x: [i64; 3]| {
        let sides = sides.map(|side| i64::from(side >> level));
        let [x, y, z] = [0, 1, 2].map(|k| x[k].rem_euclid(sides[k]));
        let begin = if level == 0 { 0 } else { 8 * 4 * 16 };
        let index = begin + (z * sides[1] + y) * sides[0] + x;
        f64::from(noise[usize::try_from(index).expect("inside")])
    };
    for _ in 0..500 {
        let uvw = [0; 3].map(|_| random.unit() * 4.0 - 2.0);
        let lod = random.unit();
        let of_level = |level: usize| {
            let q = [0, 1, 2].map(|k| f64::from(uvw[k]) * f64::from(sides[k] >> level) - 0.5);
            let mut sum = 0.0;
            for corner in 0..8 {
                let step = [corner & 1, corner >> 1 & 1, corner >> 2];
                let mut weight = 1.0;
                let mut place = [0; 3];
                for k in 0..3 {
                    let fraction = q[k] - q[k].floor();
                    weight *= if step[k] == 1 {
                        fraction
                    } else {
                        1.0 - fraction
                    };
                    place[k] = whole(q[k].floor()) + step[k];
                }
                sum += weight * texel(level, place);
            }
            sum
        };
        let t = f64::from(lod);
        let exact = of_level(0) * (1.0 - t) + of_level(1) * t;
        let got = f64::from(block.sample(&at(uvw, lod))[0]);
        // Positions are within 2⁻²² · 16 texels; per texel of error the mean changes by at most 1,
        // in each of three axes.
        assert!(
            (got - exact).abs() < 3e-5,
            "{got} is not {exact} at {uvw:?}"
        );
    }
}

/// A cube whose texels hold a smooth function of their direction gives that function in every
/// direction. A face in the wrong position, rotated, or joined to the wrong edge would be found.
/// Rows: F2.
#[test]
fn cubes_sample_their_direction() {
    const N: u32 = 24;
    let smooth = |direction: [f32; 3]| {
        let length = direction.map(|x| x * x).iter().sum::<f32>().sqrt();
        let [x, y, z] = direction.map(|x| x / length);
        x + 2.0 * y + 3.0 * z + x * y - 2.0 * y * z
    };
    // The direction of (s, t) on a face: the inverse of OpenGL's table.
    let direction = |face: u32, s: f32, t: f32| match face {
        0 => [1.0, -t, -s],
        1 => [-1.0, -t, s],
        2 => [s, 1.0, t],
        3 => [s, -1.0, -t],
        4 => [s, -t, 1.0],
        _ => [-s, -t, -1.0],
    };
    let cube = view(
        ViewDimension::Cube,
        [N, N, 6],
        1,
        linear(),
        |_, [x, y, face]| {
            let centre = |x: u32| (x as f32 + 0.5) / N as f32 * 2.0 - 1.0;
            smooth(direction(face, centre(x), centre(y)))
        },
    );
    let mut random = Random::new(9);
    let mut beyond_edges = 0;
    for round in 0..6000 {
        let mut v = [0; 3].map(|_| random.unit() * 2.0 - 1.0);
        if round % 2 == 0 {
            // Near an edge, or near a corner.
            let axis = round / 2 % 3;
            v[axis] = v[(axis + 1) % 3] * (1.0 + (random.unit() - 0.5) * 0.1);
            if round % 4 == 0 {
                v[(axis + 2) % 3] = v[axis] * (1.0 + (random.unit() - 0.5) * 0.1);
            }
        }
        let face = cube::face(v);
        let [s, t] = cube::coordinates(face, v);
        let margin = 0.5 / N as f32;
        let is_near = |s: f32| s < margin || s > 1.0 - margin;
        beyond_edges += u32::from(is_near(s) || is_near(t));
        // Half a texel (1/24) times the function's slope, about 4 at most, where edges bend the
        // grid.
        let (got, wanted) = (cube.sample(&at(v, 0.0))[0], smooth(v));
        assert!(
            (got - wanted).abs() < 0.06,
            "{got} is not {wanted} at {v:?}"
        );
    }
    assert!(beyond_edges > 1000);
}

#[test]
fn every_texel_beyond_an_edge_has_a_neighbor_that_has_it() {
    for n in [1, 2, 5] {
        for face in 0..6 {
            for k in 0..n {
                for (inside, beyond) in [
                    ((0, k), (-1, k)),
                    ((n - 1, k), (n, k)),
                    ((k, 0), (k, -1)),
                    ((k, n - 1), (k, n)),
                ] {
                    let (other, x, y) = cube::neighbor(face, beyond.0, beyond.1, n).expect("one");
                    assert_ne!(other, face);
                    // One of the four steps from there leads back.
                    let steps = [(x - 1, y), (x + 1, y), (x, y - 1), (x, y + 1)];
                    let leads_back = steps.iter().any(|&(x, y)| {
                        cube::neighbor(other, x, y, n) == Some((face, inside.0, inside.1))
                    });
                    assert!(leads_back, "{n}: {face} {beyond:?}");
                }
            }
            assert_eq!(cube::neighbor(face, -1, n, n), None);
        }
    }
}

/// Rows: F2.
#[test]
fn a_cubes_derivatives_are_those_of_its_coordinates() {
    let mut random = Random::new(3);
    for _ in 0..1000 {
        let v = [0; 3].map(|_| random.unit() * 2.0 - 1.0);
        let d = [0; 3].map(|_| random.unit() * 2.0 - 1.0);
        let face = cube::face(v);
        let major = cube::on_face(face, v)[2];
        if major < 0.2 {
            continue;
        }
        let step = 1e-3;
        let moved = |sign: f32| {
            let v: [f32; 3] = std::array::from_fn(|k| v[k] + d[k] * step * sign);
            cube::coordinates(face, v)
        };
        let (after, before) = (moved(1.0), moved(-1.0));
        let found = cube::derivatives(face, v, d);
        for k in 0..2 {
            let difference = (after[k] - before[k]) / (2.0 * step);
            let tolerance = 0.01 * (1.0 + found[k].abs());
            assert!((found[k] - difference).abs() < tolerance, "{v:?} {d:?}");
        }
    }
}

/// Rows: F2.
#[test]
fn anisotropic_probes_keep_what_isotropic_filtering_blurs() {
    // Rows of 0 and 1, viewed at a grazing angle along the rows.
    let levels = 7;
    let rows = |max_anisotropy| {
        let sampler = SamplerDescriptor {
            max_anisotropy,
            ..SamplerDescriptor::trilinear_repeat()
        };
        view(
            ViewDimension::D2,
            [64, 64, 1],
            levels,
            sampler,
            |level, [_, y, _]| {
                if level == 0 { (y % 2) as f32 } else { 0.5 }
            },
        )
    };
    let (along, across) = ([16.0 / 64.0, 0.0, 0.0], [0.0, 1.0 / 64.0, 0.0]);
    let color = |view: &ReferenceView| {
        let place = [0.3, 7.5 / 64.0, 0.0];
        let (lod, probes, step) = view.footprint(place, along, across);
        let sample = Sample {
            probes,
            step,
            ..at(place, lod)
        };
        (lod, probes, view.sample(&sample)[0])
    };
    assert_eq!(color(&rows(1)), (4.0, 1, 0.5));
    assert_eq!(color(&rows(16)), (0.0, 16, 1.0));
    // Half the number of probes: λ is greater by 1.
    assert_eq!(color(&rows(8)), (1.0, 8, 0.5));
    // A round footprint has one probe, and so no anisotropy.
    let round = rows(16).footprint([0.0; 3], along, [0.0, 0.25, 0.0]);
    assert_eq!((round.0, round.1), (4.0, 1));
    assert_eq!(rows(16).footprint([0.0; 3], [0.0; 3], [0.0; 3]).1, 1);
    // An infinitely thin footprint has the greatest number of probes.
    assert_eq!(rows(16).footprint([0.0; 3], along, [0.0; 3]).1, 16);
    // Probes are placed evenly around the coordinates: of a ramp they give its middle.
    let ramp = view(ViewDimension::D2, [64, 1, 1], 1, linear(), |_, [x, ..]| {
        x as f32
    });
    let sample = Sample {
        probes: 5,
        step: [0.2, 0.0, 0.0],
        ..at([0.5, 0.5, 0.0], 0.0)
    };
    assert!((ramp.sample(&sample)[0] - 31.5).abs() < 1e-4);
}

/// Rows: F2.
#[test]
fn borders_mirrors_and_offsets_find_their_texels() {
    use AddressMode::{ClampToBorder, ClampToEdge, MirrorOnce, MirrorRepeat, Repeat};
    let row = |mode, border_color, u: f32, offset: i32| {
        let sampler = SamplerDescriptor {
            address_mode_u: mode,
            border_color,
            ..SamplerDescriptor::default()
        };
        let row = view(ViewDimension::D1, [4, 1, 1], 1, sampler, |_, [x, ..]| {
            10.0 + x as f32
        });
        let sample = Sample {
            offset: [offset, 0, 0],
            ..at([u, 0.0, 0.0], 0.0)
        };
        row.sample(&sample)
    };
    // Texel k, by Vulkan's table, with texels 0 to 3.
    for k in -9_i32..9 {
        let expected = |mode| match mode {
            Repeat => Some(k.rem_euclid(4)),
            MirrorRepeat => {
                let twice = k.rem_euclid(8);
                Some(twice.min(7 - twice))
            }
            ClampToEdge => Some(k.clamp(0, 3)),
            MirrorOnce => Some(if k >= 0 { k.min(3) } else { (-1 - k).min(3) }),
            ClampToBorder => (0..4).contains(&k).then_some(k),
        };
        for mode in [Repeat, MirrorRepeat, ClampToEdge, MirrorOnce, ClampToBorder] {
            let wanted = expected(mode).map_or(1.0, |texel| 10.0 + texel as f32);
            let u = (k as f32 + 0.5) / 4.0;
            let white = BorderColor::OpaqueWhite;
            // The format has only red: green and blue stay 0, alpha 1.
            let wanted = [wanted, 0.0, 0.0, 1.0];
            assert_eq!(row(mode, white, u, 0), wanted, "{mode:?} {k}");
            // The same texel by an offset from texel 1.
            assert_eq!(row(mode, white, 1.5 / 4.0, k - 1), wanted, "{mode:?} {k}");
        }
    }
    assert_eq!(
        row(ClampToBorder, BorderColor::OpaqueBlack, -1.0, 0),
        [0.0, 0.0, 0.0, 1.0]
    );
    for u in [f32::NAN, f32::INFINITY, -f32::INFINITY, 3e38] {
        assert_eq!(
            row(ClampToBorder, BorderColor::TransparentBlack, u, 0)[0],
            0.0
        );
        assert!(row(MirrorOnce, BorderColor::OpaqueWhite, u, 3)[0] >= 10.0);
    }
}

/// Rows: F2.
#[test]
fn gathering_goes_around_from_the_lower_left() {
    let square = view(ViewDimension::D2, [2, 2, 1], 1, linear(), |_, [x, y, _]| {
        (10 * y + x) as f32
    });
    let centre = at([0.5, 0.5, 0.0], 0.0);
    // (umin, vmax), (umax, vmax), (umax, vmin), (umin, vmin).
    assert_eq!(square.gather(&centre, 0), [10.0, 11.0, 1.0, 0.0]);
    assert_eq!(square.gather(&centre, 1), [0.0; 4]);
    assert_eq!(square.gather(&centre, 3), [1.0; 4]);
}

/// Rows: F2.
#[test]
fn gathered_texels_wrap_each_by_itself() {
    let gathered = |mode, u| {
        let sampler = SamplerDescriptor {
            address_mode_u: mode,
            ..linear()
        };
        let row = view(ViewDimension::D2, [4, 1, 1], 1, sampler, |_, [x, _, _]| {
            x as f32
        });
        row.gather(&at([u, 0.5, 0.0], 0.0), 0)
    };
    // Vulkan, Texel Gathering: i₀ = ⌊u − ½⌋ and i₁ = i₀ + 1, each wrapped (u in texels).
    use AddressMode as A;
    assert_eq!(gathered(A::ClampToEdge, 0.0), [0.0; 4]);
    assert_eq!(gathered(A::ClampToEdge, 1.0), [3.0; 4]);
    assert_eq!(gathered(A::MirrorRepeat, 0.0), [0.0; 4]);
    assert_eq!(gathered(A::MirrorRepeat, 1.5), [2.0, 1.0, 1.0, 2.0]);
    assert_eq!(gathered(A::Repeat, 0.0), [3.0, 0.0, 0.0, 3.0]);
}

/// Rows: F2.
#[test]
fn comparisons_are_filtered_not_depths() {
    let with = |function, reference| {
        let sampler = SamplerDescriptor {
            compare: Some(function),
            ..linear()
        };
        let square = view(ViewDimension::D2, [2, 2, 1], 1, sampler, |_, [x, y, _]| {
            [0.2, 0.4, 0.6, 0.8][(2 * y + x) as usize]
        });
        let sample = Sample {
            reference: Some(reference),
            ..at([0.5, 0.5, 0.0], 0.0)
        };
        square.sample(&sample)[0]
    };
    use CompareFunction as C;
    for (function, quarters) in [
        (C::Never, 0.0),
        (C::Less, 2.0),
        (C::LessEqual, 3.0),
        (C::Equal, 1.0),
        (C::NotEqual, 3.0),
        (C::GreaterEqual, 2.0),
        (C::Greater, 1.0),
        (C::Always, 4.0),
    ] {
        assert_eq!(with(function, 0.4), quarters / 4.0, "{function:?}");
    }
    assert_eq!(with(C::LessEqual, f32::NAN), 0.0);
}
