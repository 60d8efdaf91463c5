//! Painter's algorithm, BSP tree and depth buffer, measured: order, time, memory.
//!
//! ```text
//! cargo run --release -p estampe-visibility --example compare_visibility [POLYGONS]
//! ```
//!
//! The first table grows the number of polygons up to `POLYGONS` (100000), of constant total area,
//! in a picture of 640×512. The second grows the picture, with 1000 polygons. Times are the best of
//! three, in milliseconds, on all threads for drawing.

#![expect(clippy::print_stdout, reason = "examples print their results")]

use estampe::{Device, DeviceDescriptor, Mat4};
use estampe_scene::Image;
use estampe_visibility::bsp::{BspOptions, BspTree};
use estampe_visibility::eye::Eye;
use estampe_visibility::painter::by_centre;
use estampe_visibility::picture::{Hiding, View, differing_pixels, draw};
use estampe_visibility::polygon::{Corner, Polygon};
use fastrand::Rng;
use std::error::Error;
use std::time::Instant;

const EYE: [f32; 3] = [1.5, 2.0, 4.0];

/// Random triangles in the cube −1..1, of an extent that keeps the sum of their areas.
fn scene(count: usize, random: &mut Rng) -> Vec<Polygon<3>> {
    let size = (6.0 / libm::sqrtf(count as f32)).min(0.8);
    let mut polygons = Vec::with_capacity(count);
    while polygons.len() < count {
        let mut vector = |scale: f32| [0; 3].map(|_| (random.f32() * 2.0 - 1.0) * scale);
        let (at, u, v) = (vector(0.9), vector(size), vector(size));
        let color = vector(0.5).map(|x| x + 0.5);
        let plus = |d: [f32; 3]| [0, 1, 2].map(|k: usize| at[k] + d[k]);
        let corners = [at, plus(u), plus(v)].map(|position| (position, color));
        polygons.extend(Polygon::new(&corners));
    }
    polygons
}

fn view(size: [u32; 2]) -> View {
    let [width, height] = size.map(|side| side as f32);
    let clip_from_view = Mat4::perspective_reversed(0.6, width / height, 1.0, 10.0);
    View {
        clip_from_world: clip_from_view * Mat4::look_at(EYE, [0.0; 3], [0.0, 1.0, 0.0]),
        size,
        background: [1.0; 3],
    }
}

/// The best of three times, in milliseconds, and a result.
fn timed<T>(mut work: impl FnMut() -> T) -> (f64, T) {
    let mut run = || {
        let start = Instant::now();
        let result = work();
        (start.elapsed().as_secs_f64() * 1e3, result)
    };
    let first = run();
    let others = [run(), run()];
    others.into_iter().fold(
        first,
        |best, other| if other.0 < best.0 { other } else { best },
    )
}

/// One method on one scene.
struct Measured {
    /// Milliseconds of the order that holds for every eye.
    build: f64,
    /// Milliseconds of the order for one eye.
    order: f64,
    /// Milliseconds of drawing.
    draw: f64,
    /// Polygons that are drawn.
    polygons: usize,
    /// Bytes beyond polygons and colours.
    memory: usize,
    picture: Image,
}

fn measure(
    device: &Device,
    view: &View,
    polygons: &[Polygon<3>],
) -> Result<[Measured; 3], Box<dyn Error>> {
    let eye = Eye::Point(EYE.map(f64::from));
    let pixels = view.size[0] as usize * view.size[1] as usize;
    let drawn = |corners: &[&[Corner<3>]], hiding| {
        timed(|| draw(device, view, corners.iter().copied(), hiding))
    };
    let all: Vec<&[Corner<3>]> = polygons.iter().map(Polygon::corners).collect();

    let (order, sorted) = timed(|| by_centre(polygons, eye));
    let in_order: Vec<_> = sorted.iter().map(|number| all[*number as usize]).collect();
    let (draw_time, picture) = drawn(&in_order, Hiding::ByOrder);
    let painter = Measured {
        build: 0.0,
        order,
        draw: draw_time,
        polygons: polygons.len(),
        memory: sorted.len() * size_of::<(f64, u32)>(),
        picture: picture?,
    };

    let (build, tree) = timed(|| BspTree::new(polygons, BspOptions::default()));
    let tree = tree?;
    let (order, in_order) = timed(|| {
        let mut order = Vec::with_capacity(tree.pieces().len());
        tree.back_to_front(eye, |piece| order.push(piece.corners.as_slice()));
        order
    });
    let (draw_time, picture) = drawn(&in_order, Hiding::ByOrder);
    let bsp = Measured {
        build,
        order,
        draw: draw_time,
        polygons: tree.pieces().len(),
        memory: tree.memory(),
        picture: picture?,
    };

    let (draw_time, picture) = drawn(&all, Hiding::ByDepth);
    let depth = Measured {
        build: 0.0,
        order: 0.0,
        draw: draw_time,
        polygons: polygons.len(),
        memory: pixels * size_of::<f32>(),
        picture: picture?,
    };
    Ok([painter, bsp, depth])
}

/// Prints the lines of one scene; `name` is the first column.
fn report(
    device: &Device,
    name: &str,
    view: &View,
    polygons: &[Polygon<3>],
    random: &mut Rng,
) -> Result<(), Box<dyn Error>> {
    let methods = measure(device, view, polygons)?;
    // The same polygons given in another order.
    let mut shuffled = polygons.to_vec();
    random.shuffle(&mut shuffled);
    let others = measure(device, view, &shuffled)?;
    let as_given = |polygons: &[Polygon<3>]| {
        draw(
            device,
            view,
            polygons.iter().map(Polygon::corners),
            Hiding::ByOrder,
        )
    };
    let [given, other] = [as_given(polygons)?, as_given(&shuffled)?];
    let right = &methods[2].picture;
    let (wrong, changed) = (
        differing_pixels(right, &given),
        differing_pixels(&given, &other),
    );
    println!("| {name} | as given | | | | | | {wrong} | {changed} |");
    let names = ["painter", "BSP tree", "depth buffer"];
    for ((method, measured), other) in names.iter().zip(&methods).zip(&others) {
        println!(
            "| {name} | {method} | {:.1} | {:.2} | {:.1} | {} | {} | {} | {} |",
            measured.build,
            measured.order,
            measured.draw,
            measured.polygons,
            measured.memory / 1024,
            differing_pixels(right, &measured.picture),
            differing_pixels(&measured.picture, &other.picture),
        );
    }
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let most = match std::env::args().nth(1) {
        Some(text) => text.parse::<usize>()?,
        None => 100_000,
    };
    let device = Device::new(&DeviceDescriptor::default())?;
    let mut random = Rng::with_seed(1);
    let heads = "| build ms | order ms | draw ms | drawn polygons | KiB | pixels unlike the depth \
                 buffer | pixels that change if given in another order |";
    println!("| polygons | method {heads}\n|---:|---|---:|---:|---:|---:|---:|---:|---:|");
    let counts = std::iter::successors(Some(100), |count| Some(count * 10));
    for count in counts.take_while(|count| *count <= most) {
        let polygons = scene(count, &mut random);
        report(
            &device,
            &count.to_string(),
            &view([640, 512]),
            &polygons,
            &mut random,
        )?;
    }
    println!("\n| pixels | method {heads}\n|---:|---|---:|---:|---:|---:|---:|---:|---:|");
    let polygons = scene(1000.min(most), &mut random);
    for size in [[320, 256], [640, 512], [1280, 1024], [2560, 2048]] {
        let name = format!("{}×{}", size[0], size[1]);
        report(&device, &name, &view(size), &polygons, &mut random)?;
    }
    Ok(())
}
