//! Hidden light against formulas.

use super::GroundFrame;
use super::columns::{Columns, SIDE as COLUMNS};
use super::occlusion::{SIDE, hidden_light};
use super::sky::Sky;
use crate::environment::EnvironmentMap;
use estampe_scene::Workers;
use glam::{DMat3, DVec3};
use std::sync::Arc;

/// The ground y = 0 with columns over −half..half.
fn frame(half: f64, height: f64) -> GroundFrame {
    GroundFrame {
        axes: [DVec3::X, DVec3::NEG_Z, DVec3::Y],
        middle: DVec3::ZERO,
        half,
        height,
    }
}

/// Columns whose heights are those of a function of the place.
fn columns(half: f32, heights: impl Fn(f32, f32) -> Option<[f32; 2]>) -> Columns {
    let side = u16::try_from(COLUMNS).expect("a small number");
    let place = |k: u16| (f32::from(k) + 0.5) / f32::from(side) * 2.0 - 1.0;
    let rows = (0..side).flat_map(|row| (0..side).map(move |column| (column, row)));
    let at = |(column, row)| heights(place(column) * half, -place(row) * half);
    Columns {
        side: usize::from(side),
        half,
        heights: rows
            .map(|k| at(k).unwrap_or([f32::INFINITY, 0.0]))
            .collect(),
    }
}

fn uniform() -> Sky {
    Sky {
        map: Arc::new(EnvironmentMap::uniform([0.7; 3])),
        map_from_world: DMat3::IDENTITY,
        lights: Vec::new(),
    }
}

/// The hidden share at the texel nearest to a place.
fn at(hidden: &[f32], frame: &GroundFrame, [x, y]: [f64; 2]) -> f64 {
    let texel = |along: f64| {
        let share = (along / frame.reach() + 1.0) / 2.0;
        let middle = |k: usize| (f64::from(u32::try_from(k).expect("small")) + 0.5) / 128.0;
        let distance = |k: usize| (middle(k) - share).abs();
        (0..SIDE)
            .min_by(|&a, &b| distance(a).total_cmp(&distance(b)))
            .expect("texels")
    };
    f64::from(hidden[texel(-y) * SIDE + texel(x)])
}

/// The share of a uniform sky that a level square above a place hides (the view factor of an
/// element under the corner of a parallel rectangle, four times).
fn square_above(half: f64, height: f64) -> f64 {
    let x = half / height;
    let root = (1.0 + x * x).sqrt();
    let corner = 2.0 * x / root * libm::atan(x / root) / std::f64::consts::TAU;
    4.0 * corner
}

#[test]
fn a_table_hides_what_the_view_factor_says() {
    for height in [0.3_f32, 0.8, 2.0] {
        let table = columns(1.0, |_, _| Some([height, height + 0.05]));
        let frame = frame(1.0, f64::from(height) + 0.05);
        let hidden = hidden_light(&frame, &table, &uniform(), Workers::ONE);
        let (own, right) = (
            at(&hidden, &frame, [0.0, 0.0]),
            square_above(1.0, f64::from(height)),
        );
        assert!(
            (own - right).abs() < 0.03,
            "height {height}: {own}, not {right}"
        );
    }
}

#[test]
fn a_wide_wall_hides_half_of_the_sky_beside_it() {
    let wall = columns(8.0, |_, y| (y > 0.0).then_some([0.0, 80.0]));
    let frame = frame(8.0, 1.0);
    let hidden = hidden_light(&frame, &wall, &uniform(), Workers::ONE);
    let beside = at(&hidden, &frame, [0.0, -0.2]);
    assert!((beside - 0.5).abs() < 0.03, "{beside}");
    // Under the wall all is hidden.
    assert!(at(&hidden, &frame, [0.0, 2.0]) > 0.98);
}

#[test]
fn parallel_light_leaves_its_shadow_on_the_other_side() {
    let pillar = columns(0.2, |x, y| {
        (x.abs().max(y.abs()) < 0.2).then_some([0.0, 1.0])
    });
    let frame = frame(0.2, 1.0);
    let lit = Sky {
        map: Arc::new(EnvironmentMap::uniform([0.01; 3])),
        lights: vec![(DVec3::new(1.0, 1.0, 0.0).normalize(), 1.0)],
        ..uniform()
    };
    let hidden = hidden_light(&frame, &pillar, &lit, Workers::new(3));
    // The light comes from +X at 45°: the shadow is one height long, towards −X.
    let shaded = at(&hidden, &frame, [-0.6, 0.0]);
    let bright = at(&hidden, &frame, [0.6, 0.0]);
    assert!(shaded > 0.5 && bright < 0.1, "{shaded} and {bright}");
    let beyond = at(&hidden, &frame, [-1.25, 0.0]);
    assert!(beyond < 0.5 * shaded, "{beyond} beyond {shaded}");
    assert_eq!(hidden, hidden_light(&frame, &pillar, &lit, Workers::ONE));
}

#[test]
fn nothing_hides_nothing() {
    let hidden = hidden_light(
        &frame(1.0, 1.0),
        &columns(1.0, |_, _| None),
        &uniform(),
        Workers::ONE,
    );
    assert!(hidden.iter().all(|&share| share == 0.0));
}
