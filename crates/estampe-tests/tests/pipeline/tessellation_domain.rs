//! The tessellator against exact rationals, and against what its primitives must be.

use estampe::TessellatedDomain;
use estampe_reference::tessellation::{Domain, Edge, Fraction, divide};
use estampe_tests::Random;
use estampe_types::state::{
    FrontFace, TessellationDomain as D, TessellationMode, TessellationSpacing as S,
};
use std::collections::{BTreeMap, BTreeSet};

/// 1, in units of 2⁻²⁴.
const ONE: i64 = 1 << 24;

fn modes() -> Vec<TessellationMode> {
    let mut modes = Vec::new();
    for domain in [D::Triangles, D::Quads, D::Isolines] {
        for spacing in [S::Equal, S::FractionalOdd, S::FractionalEven] {
            for winding in [FrontFace::Ccw, FrontFace::Cw] {
                for point_mode in [false, true] {
                    modes.push(TessellationMode {
                        domain,
                        spacing,
                        winding,
                        point_mode,
                    });
                }
            }
        }
    }
    modes
}

/// A level: whole, in between, or a special one.
fn level(random: &mut Random) -> f32 {
    match random.below(8) {
        0 => 1.0,
        1 => random.pick(&[0.25, 1.000_000_1, 2.000_000_2, 63.0, 63.999, 64.0, 1e9]),
        2 => 1.0 + random.below(64) as f32,
        3 => random.below(8000) as f32 / 100.0 + 0.001,
        _ => 1.0 + random.below(8000) as f32 / 1000.0,
    }
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "a whole number, at most 2²⁴"
)]
fn units(coordinates: &[[f32; 3]]) -> Vec<[i64; 3]> {
    let unit = |at: &f32| {
        let scaled = f64::from(*at) * ONE as f64;
        assert!(scaled.fract() == 0.0, "{at} is no multiple of 2⁻²⁴");
        scaled as i64
    };
    coordinates
        .iter()
        .map(|at| at.each_ref().map(unit))
        .collect()
}

/// The primitives by the places of their corners, each beginning with its least one.
fn primitives(places: &[[i64; 3]], corners: usize, indices: &[u32]) -> Vec<Vec<[i64; 3]>> {
    let primitives = indices.chunks(corners).map(|primitive| {
        let mut at: Vec<_> = primitive.iter().map(|at| places[*at as usize]).collect();
        if corners == 3 {
            let least = (0..3).min_by_key(|k| at[*k]).unwrap_or_default();
            at.rotate_left(least);
        }
        at
    });
    let mut all: Vec<_> = primitives.collect();
    all.sort_unstable();
    all
}

/// Compares a domain with the oracle's.
fn compare(mode: &TessellationMode, outer: [f32; 4], inner: [f32; 2]) -> TessellatedDomain {
    let got = TessellatedDomain::new(mode, outer, inner);
    let Domain {
        points,
        primitives: wanted,
    } = divide(mode, outer, inner);
    let corners = TessellatedDomain::corners_of(mode);
    let places: Vec<[i64; 3]> = points.iter().map(|place| place.map(i64::from)).collect();
    let flat: Vec<u32> = wanted
        .iter()
        .flatten()
        .map(|at| u32::try_from(*at).unwrap())
        .collect();
    let got_places = units(&got.coordinates);
    let sorted = |places: &[[i64; 3]]| {
        let mut places = places.to_vec();
        places.sort_unstable();
        places
    };
    assert!(
        sorted(&got_places) == sorted(&places),
        "{mode:?} {outer:?} {inner:?}: other points"
    );
    assert!(
        primitives(&got_places, corners, &got.indices) == primitives(&places, corners, &flat),
        "{mode:?} {outer:?} {inner:?}: other primitives"
    );
    got
}

/// Every domain, spacing, winding and point mode at random levels has the points of exact
/// rationals, and the primitives that the definition of stitching gives.
///
/// Rows: V3
#[test]
fn domains_are_those_of_exact_rationals() {
    let mut random = Random::new("tessellation_domain", 1);
    let (mut greatest, mut dropped) = (0, 0);
    for mode in modes() {
        let rounds = if mode.point_mode { 12 } else { 40 };
        for round in 0..rounds {
            let mut outer = [0; 4].map(|_| level(&mut random));
            let mut inner = [0; 2].map(|_| level(&mut random));
            if round == 0 {
                (outer, inner) = ([64.0; 4], [64.0; 2]);
            }
            if round == 1 {
                outer[random.below(2) as usize] = random.pick(&[0.0, -1.0, f32::NAN]);
            }
            let got = compare(&mode, outer, inner);
            greatest = greatest.max(got.coordinates.len());
            dropped += u32::from(got.indices.is_empty());
        }
    }
    assert_eq!(greatest, 65 * 65, "a quad at level 64");
    assert_eq!(dropped, 36, "one for each mode");
}

/// Small levels in all combinations, where rings become points and levels count as 1 + ε.
///
/// Rows: V3
#[test]
fn small_levels_are_those_of_exact_rationals() {
    let levels = [1.0, 1.5, 2.0, 3.0];
    for mode in modes() {
        for code in 0..4_usize.pow(5) {
            let at = |k: u32| levels[code / 4_usize.pow(k) % 4];
            let _ = compare(&mode, [at(0), at(1), at(2), at(0)], [at(3), at(4)]);
        }
    }
}

/// Triangles fill the domain exactly: none has a negative area, the areas sum to that of the
/// domain, each edge inside belongs to one triangle in each direction, and the others are those of
/// the outer levels.
///
/// Rows: V3
#[test]
fn triangles_fill_the_domain_exactly() {
    let mut random = Random::new("tessellation_domain", 2);
    for mode in modes() {
        if mode.point_mode || mode.domain == D::Isolines {
            continue;
        }
        for _ in 0..60 {
            let outer = [0; 4].map(|_| level(&mut random));
            let inner = [0; 2].map(|_| level(&mut random));
            let domain = TessellatedDomain::new(&mode, outer, inner);
            let places = units(&domain.coordinates);
            let turn = if mode.winding == FrontFace::Ccw {
                1
            } else {
                -1
            };
            let mut edges = BTreeMap::new();
            let mut area = 0;
            for triangle in domain.indices.chunks(3) {
                let [a, b, c] = [0, 1, 2].map(|k| places[triangle[k] as usize]);
                let [[ux, uy], [vx, vy]] = [b, c].map(|p| [p[0] - a[0], p[1] - a[1]]);
                let doubled = turn * (ux * vy - uy * vx);
                assert!(
                    doubled >= 0,
                    "{mode:?} {outer:?} {inner:?} turns a triangle"
                );
                area += doubled;
                for k in 0..3 {
                    *edges
                        .entry([triangle[k], triangle[(k + 1) % 3]])
                        .or_insert(0) += 1;
                }
            }
            let whole = match mode.domain {
                D::Quads => 2 * ONE * ONE,
                _ => ONE * ONE,
            };
            assert_eq!(area, whole, "{mode:?} {outer:?} {inner:?}");
            let mut border = BTreeSet::new();
            for (&[a, b], count) in &edges {
                assert_eq!(*count, 1, "{mode:?} {outer:?} {inner:?}: an edge twice");
                if !edges.contains_key(&[b, a]) {
                    let ends = [places[a as usize], places[b as usize]];
                    border.insert(if mode.winding == FrontFace::Ccw {
                        ends
                    } else {
                        [ends[1], ends[0]]
                    });
                }
            }
            assert_eq!(
                border,
                outer_edges(&mode, outer),
                "{mode:?} {outer:?} {inner:?}"
            );
        }
    }
}

/// The segments of the domain's border, counter-clockwise.
fn outer_edges(mode: &TessellationMode, outer: [f32; 4]) -> BTreeSet<[[i64; 3]; 2]> {
    type Place = fn(i64) -> [i64; 3];
    let sides: &[(usize, Place)] = match mode.domain {
        D::Quads => &[
            (1, |at| [at, 0, 0]),
            (2, |at| [ONE, at, 0]),
            (3, |at| [ONE - at, ONE, 0]),
            (0, |at| [0, ONE - at, 0]),
        ],
        _ => &[
            (2, |at| [ONE - at, at, 0]),
            (0, |at| [0, ONE - at, at]),
            (1, |at| [at, 0, ONE - at]),
        ],
    };
    let segments = sides.iter().flat_map(|(level, place)| {
        let edge = Edge::new(mode.spacing, outer[*level], false);
        let at = move |j| place(i64::from(edge.place(j)));
        let count = Edge::new(mode.spacing, outer[*level], false).segments();
        (0..count)
            .map(move |j| [at(j), at(j + 1)])
            .collect::<Vec<_>>()
    });
    segments.collect()
}

/// The points of an equally divided edge are j/n to the nearest 2⁻²⁴, and lie symmetrically to the
/// bit.
///
/// Rows: V3
#[test]
fn equal_edges_are_rationals() {
    for n in 1..=64_u32 {
        let mode = TessellationMode {
            domain: D::Isolines,
            ..TessellationMode::default()
        };
        let domain = TessellatedDomain::new(&mode, [1.0, n as f32, 1.0, 1.0], [1.0; 2]);
        assert_eq!(domain.coordinates.len(), n as usize + 1);
        for (j, [u, ..]) in (0..).zip(&domain.coordinates) {
            let error = (f64::from(*u) - f64::from(j) / f64::from(n)).abs();
            assert!(error <= 1.0 / f64::from(1 << 25), "{j}/{n}");
            let mirrored = domain.coordinates[(n - j) as usize][0];
            assert_eq!((1.0 - u).to_bits(), mirrored.to_bits(), "{j}/{n}");
            let exact = Fraction::new(i128::from(j.min(n - j)), i128::from(n)).rounded();
            let exact = if 2 * j > n { (1 << 24) - exact } else { exact };
            assert_eq!(u.to_bits(), (exact as f32 / 16_777_216.0).to_bits());
        }
    }
}
