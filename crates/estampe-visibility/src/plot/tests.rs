//! Plots are drawn, the same at every SIMD level, and no number breaks them.

use super::*;
use estampe::{Device, DeviceDescriptor, Level};

fn plot(points: Vec<[f64; 2]>) -> Plot {
    Plot {
        size: [320, 240],
        title: "A plot, 1 <= x & more".to_owned(),
        x_name: "distance".to_owned(),
        y_name: "least separation".to_owned(),
        curves: vec![Curve {
            name: "a curve".to_owned(),
            color: [200, 30, 30],
            width: 2.0,
            is_dashed: true,
            points,
        }],
    }
}

#[test]
fn images_are_the_same_everywhere() {
    let drawing = plot((1..100).map(|i| [f64::from(i), f64::from(i * i)]).collect()).drawing();
    let mut images = Vec::new();
    for level in Level::all_available() {
        for threads in [1, 3] {
            let device = Device::new(&DeviceDescriptor {
                level,
                threads,
                ..DeviceDescriptor::default()
            });
            let device = device.expect("the system starts threads");
            images.push(drawing.to_image(&device).expect("it is small"));
        }
    }
    let first = &images[0];
    assert!(images.iter().all(|image| image == first));
    let pixels = first.rgba.as_chunks::<4>().0;
    let is_red = |pixel: &&[u8; 4]| pixel[0] > 150 && pixel[1] < 100;
    assert!(
        pixels.iter().filter(is_red).count() > 100,
        "the curve is there"
    );
    assert!(pixels.iter().all(|pixel| pixel[3] == 255));
}

#[test]
fn svg_has_curves_and_escaped_text() {
    let svg = plot(vec![[1.0, 1.0], [10.0, 100.0]]).drawing().to_svg();
    assert!(svg.starts_with("<svg ") && svg.ends_with("</svg>\n"));
    assert!(svg.contains("1 &lt;= x &amp; more") && svg.contains("#c81e1e"));
    assert!(!svg.contains("NaN") && !svg.contains("inf"));
}

#[test]
fn any_number_is_drawn_or_left_out() {
    let odd = [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-300, 1e300, 1.0];
    let points = odd.iter().flat_map(|x| odd.map(|y| [*x, y])).collect();
    let device = Device::new(&DeviceDescriptor::default()).expect("the system starts threads");
    for points in [
        points,
        Vec::new(),
        vec![[1.0, 1.0]],
        vec![[5.0, 5.0], [5.0, 5.0]],
    ] {
        let mut plot = plot(points);
        plot.size = [0, 0];
        let drawing = plot.drawing();
        let numbers = drawing
            .strokes
            .iter()
            .flat_map(|stroke| stroke.points.iter().flatten());
        assert!(
            numbers
                .into_iter()
                .all(|number| number.is_finite() && number.abs() < 1000.0)
        );
        drawing.to_image(&device).expect("it is small");
    }
}

#[test]
fn a_drawing_over_an_image_keeps_it_where_nothing_is_drawn() {
    let device = Device::new(&DeviceDescriptor::default()).expect("the system starts threads");
    let mut drawing = Drawing {
        size: [9, 5],
        ..Drawing::default()
    };
    let rgba: Vec<u8> = (0..45).flat_map(|at| [at, 200 - at, 7, 255]).collect();
    let below = estampe_scene::Image {
        width: 9,
        height: 5,
        rgba,
    };
    assert_eq!(drawing.over(&device, &below).expect("it is small"), below);
    drawing.strokes.push(Stroke {
        points: vec![[0.0, 2.5], [9.0, 2.5]],
        color: [1, 2, 3],
        width: 1.0,
    });
    let drawn = drawing.over(&device, &below).expect("it is small");
    let row = |image: &estampe_scene::Image, y: usize| image.rgba[y * 36..][..36].to_vec();
    assert_eq!(row(&drawn, 2), [1, 2, 3, 255].repeat(9));
    for y in [0, 1, 3, 4] {
        assert_eq!(row(&drawn, y), row(&below, y));
    }
}
