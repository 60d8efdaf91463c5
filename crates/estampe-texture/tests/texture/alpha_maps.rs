//! Maps of where alpha may pass a test, against each texel that filtering reads.

use super::Random;
use estampe_texture::{
    AddressMode, FilterMode, LevelData, Limits, MipGeneration, SampledTexture, SamplerDescriptor,
    TexelDescriptor, TexelView, TexelViewDescriptor, TextureDimension, TextureFormat,
    ViewDimension,
};
use estampe_types::shader::{ALPHA_CELLS, ALPHA_STEPS};

const CELLS: i64 = ALPHA_CELLS as i64;

/// An array of which most texels have small alphas, those of the upper half 0, and its sampler.
fn texture(random: &mut Random, sides: [u32; 3], sampler: SamplerDescriptor) -> SampledTexture {
    let [width, height, layers] = sides;
    let mut bytes = random.bytes((width * height * layers * 4) as usize);
    for (at, texel) in (0..).zip(bytes.as_chunks_mut::<4>().0) {
        let is_upper = at / width % height < height / 2;
        texel[3] = match random.bits() % 200 {
            0 => 255,
            1..8 if !is_upper => 255,
            _ if is_upper => 0,
            _ => texel[3] / 4,
        };
    }
    let descriptor = TexelDescriptor {
        dimension: TextureDimension::D2,
        depth_or_layers: layers,
        ..TexelDescriptor::new_2d(width, height, TextureFormat::Rgba8Unorm)
    };
    let data = [LevelData::tight(&bytes)];
    let limits = Limits::default();
    let data = descriptor
        .with_all_levels()
        .create(&data, MipGeneration::Full, &limits);
    let view = TexelViewDescriptor {
        dimension: Some(ViewDimension::D2Array),
        ..TexelViewDescriptor::default()
    };
    let view = TexelView::new(data.unwrap(), &view).unwrap();
    SampledTexture::new(view, sampler).unwrap()
}

/// The texels along an axis that linear filtering reads at the places of a cell. Coordinates are
/// multiples of 1/64 texel, half a texel less than those of the cell's edges.
fn texels_of(cell: i64, count: i64, repeats: bool) -> Vec<i64> {
    let places = cell * count * 2 - CELLS..(cell + 1) * count * 2 - CELLS;
    let texels = places.flat_map(|at| {
        let first = at.div_euclid(2 * CELLS);
        [first, first + 1].map(|texel| match repeats {
            true => texel.rem_euclid(count),
            false => texel.clamp(0, count - 1),
        })
    });
    let mut texels: Vec<i64> = texels.collect();
    texels.sort_unstable();
    texels.dedup();
    texels
}

#[test]
fn a_cell_passes_where_filtering_reads_a_greater_alpha() {
    let random = &mut Random::new(77);
    let (mut set, mut clear, mut without) = (0, 0, 0);
    for _ in 0..24 {
        let sides = [70, 70, 3].map(|most| 1 + random.bits() % most);
        let repeats = [(); 2].map(|()| random.bits().is_multiple_of(2));
        let [u, v] = repeats.map(|repeats| match repeats {
            true => AddressMode::Repeat,
            false => AddressMode::ClampToEdge,
        });
        let mipmap_filter = match random.bits() % 4 {
            0 => FilterMode::Nearest,
            _ => FilterMode::Linear,
        };
        let texture = texture(
            random,
            sides,
            SamplerDescriptor {
                address_mode_u: u,
                address_mode_v: v,
                mipmap_filter,
                ..SamplerDescriptor::trilinear_repeat()
            },
        );
        let failing = [60, 0, 127, 30][random.bits() as usize % 4];
        let Some(map) = texture.alpha_map(failing, usize::MAX) else {
            without += 1;
            continue;
        };
        let data = texture.view().texture();
        assert_eq!(map.size, [sides[0] as f32, sides[1] as f32]);
        let greatest = |level: usize, layer: u32, [column, row]: [i64; 2]| {
            let of = data.levels[level.min(data.levels.len() - 1)];
            let [across, down] = [of.width, of.height].map(i64::from);
            let columns = texels_of(column, across, repeats[0]);
            let rows = texels_of(row, down, repeats[1]);
            let texels = rows
                .iter()
                .flat_map(|y| columns.iter().map(move |x| [x, y]));
            let alphas = texels.map(|[x, y]| {
                let texel = (i64::from(layer) * down + y) * across + x;
                let at = i64::from(of.offset) + texel;
                data.texels[usize::try_from(at).unwrap()] >> 24
            });
            f64::from(alphas.max().unwrap())
        };
        let steps = (data.levels.len() - 1) * ALPHA_STEPS + 1;
        assert_eq!(map.rows.len(), steps * sides[2] as usize * ALPHA_CELLS);
        let mut rows = map.rows.iter();
        for step in 0..steps {
            let level = step / ALPHA_STEPS;
            // The parts of the level of detail at the ends, from those of ρ².
            let ends = [step % ALPHA_STEPS, step % ALPHA_STEPS + 1]
                .map(|end| libm::log2([1.0, 1.5, 2.0, 3.0, 4.0][end]) * 0.5);
            for layer in 0..sides[2] {
                for row in 0..CELLS {
                    let bits = rows.next().unwrap();
                    for column in 0..CELLS {
                        let at = [column, row];
                        let [fine, coarse] = [level, level + 1].map(|of| greatest(of, layer, at));
                        let most = match mipmap_filter {
                            FilterMode::Nearest => fine.max(coarse),
                            FilterMode::Linear => {
                                let mixed = ends.map(|end| fine * (1.0 - end) + coarse * end);
                                mixed[0].max(mixed[1])
                            }
                        };
                        let is_set = bits >> column & 1 == 1;
                        // Mixtures that are the code itself, but for rounding, may be either.
                        let is_exact = (most - f64::from(failing)).abs() > 1e-4 || most == fine;
                        let expected = most > f64::from(failing);
                        assert!(
                            is_set == expected || !is_exact,
                            "{sides:?} step {step} {layer} {at:?} {failing}: {most}"
                        );
                        *if is_set { &mut set } else { &mut clear } += 1;
                    }
                }
            }
        }
    }
    assert!(
        set > 10_000 && clear > 10_000,
        "{set} cells pass, {clear} fail"
    );
    // Those in which nearly all cells pass.
    assert!((1..12).contains(&without), "{without} have no map");
}

/// Few primitives are drawn with a texture of many texels: it is not looked through for them.
#[test]
fn maps_are_made_when_they_are_likely_to_be_worth_it() {
    let random = &mut Random::new(78);
    let texture = texture(random, [64, 64, 1], SamplerDescriptor::trilinear_repeat());
    assert_eq!(texture.alpha_map(9, 60), None);
    assert_eq!(texture.alpha_map(9, 60), None);
    let map = texture
        .alpha_map(9, 60)
        .expect("180 primitives, 5461 texels");
    assert!(std::sync::Arc::ptr_eq(
        &map,
        &texture.alpha_map(9, 0).unwrap()
    ));
    // Another threshold has to be worth it again.
    assert_eq!(texture.alpha_map(8, 100), None);
    assert!(texture.alpha_map(8, 100).is_some());
    // Of other texels there are no maps yet.
    let mut other = estampe_types::TexelData::clone(texture.view().texture());
    other.texels = other.take_texels();
    let other = SampledTexture::new(TexelView::of(other).unwrap(), *texture.sampler()).unwrap();
    assert_eq!(other.alpha_map(9, 60), None);
}

#[test]
fn kinds_that_have_no_map_give_none() {
    let random = &mut Random::new(79);
    let mut of = |sampler| texture(random, [32, 32, 1], sampler).alpha_map(9, usize::MAX);
    let repeated = SamplerDescriptor::trilinear_repeat();
    assert!(of(repeated).is_some());
    for sampler in [
        SamplerDescriptor {
            address_mode_v: AddressMode::MirrorRepeat,
            ..repeated
        },
        SamplerDescriptor {
            max_anisotropy: 4,
            ..repeated
        },
        SamplerDescriptor {
            lod_bias: -0.5,
            ..repeated
        },
    ] {
        assert_eq!(of(sampler), None, "{sampler:?}");
    }
}
