//! Scenes of tests: random polygons, and pictures of them at every SIMD level.

use crate::eye::Eye;
use crate::picture::View;
use crate::polygon::{Corner, Polygon};
use estampe::{Device, DeviceDescriptor, Mat4};
use fastrand::Rng;

/// Random triangles and quadrangles of one colour each in the cube −1..1; `size` is their extent.
pub(crate) fn polygons(random: &mut Rng, count: usize, size: f32) -> Vec<Polygon<3>> {
    let mut polygons = Vec::new();
    while polygons.len() < count {
        let color = [random.f32(), random.f32(), random.f32()];
        let mut vector = |scale: f32| [0; 3].map(|_| (random.f32() * 2.0 - 1.0) * scale);
        let (middle, u, v) = (vector(1.0 - size), vector(size), vector(size));
        let at = |s: f32, t: f32| [0, 1, 2].map(|k: usize| middle[k] + s * u[k] + t * v[k]);
        let corners = [at(0.0, 0.0), at(1.0, 0.0), at(0.8, 0.9), at(0.0, 1.0)];
        let count = 3 + usize::from(random.bool());
        let corners: Vec<_> = corners[..count].iter().map(|p| (*p, color)).collect();
        polygons.extend(Polygon::new(&corners));
    }
    polygons
}

/// A view of the cube with its eye; parallel or perspective.
pub(crate) fn view(random: &mut Rng, size: [u32; 2]) -> (View, Eye) {
    let direction = loop {
        let v = [0; 3].map(|_| random.f32() * 2.0 - 1.0);
        let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
        if (0.2..1.0).contains(&length) {
            break v.map(|x| x / length);
        }
    };
    let at = direction.map(|x| x * 4.0);
    let view_from_world = Mat4::look_at(at, [0.0; 3], [0.1, 0.9, 0.3]);
    let (clip_from_view, eye) = if random.bool() {
        let clip = Mat4::orthographic_reversed(-1.8, 1.8, -1.8, 1.8, 1.0, 8.0);
        (clip, Eye::Direction(direction.map(f64::from)))
    } else {
        let clip = Mat4::perspective_reversed(0.9, 1.0, 1.0, 8.0);
        (clip, Eye::Point(at.map(f64::from)))
    };
    let view = View {
        clip_from_world: clip_from_view * view_from_world,
        size,
        background: [1.0; 3],
    };
    (view, eye)
}

/// A device of the machine's best level.
pub(crate) fn device() -> Device {
    Device::new(&DeviceDescriptor::default()).expect("the system starts threads")
}

/// The corners of a polygon in the picture, in pixels.
pub(crate) fn in_pixels(view: &View, corners: &[Corner<3>]) -> Vec<[f64; 2]> {
    let matrix = view.clip_from_world.0.map(|column| column.map(f64::from));
    let [width, height] = view.size.map(f64::from);
    let project = |corner: &Corner<3>| {
        let p = corner.position;
        let row = |k: usize| {
            matrix[0][k] * p[0] + matrix[1][k] * p[1] + matrix[2][k] * p[2] + matrix[3][k]
        };
        let [x, y, w] = [row(0), row(1), row(3)];
        [(x / w + 1.0) * 0.5 * width, (1.0 - y / w) * 0.5 * height]
    };
    corners.iter().map(project).collect()
}
