//! Images of six faces, in the order and orientation of cube textures (WebGPU, "Texture view
//! dimension cube"; Vulkan, "Cube map face selection").

use estampe_scene::Workers;
use glam::Vec3;

/// Six square faces of radiance: +X, −X, +Y, −Y, +Z, −Z, each row after row.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct CubeImage {
    side: usize,
    radiance: Vec<Vec3>,
}

/// The number of faces.
const FACES: usize = 6;

impl CubeImage {
    /// The radiance at the middle of each texel.
    pub(super) fn new(
        side: usize,
        radiance: impl Fn(Vec3) -> Vec3 + Sync,
        workers: Workers,
    ) -> Self {
        let rows = workers.map(0..FACES * side, |row| {
            let (face, y) = (row / side, row % side);
            let texel = |x: usize| radiance(direction(face, [x, y], side));
            (0..side).map(texel).collect::<Vec<_>>()
        });
        Self {
            side,
            radiance: rows.concat(),
        }
    }

    /// Texels along an edge.
    pub(super) fn side(&self) -> usize {
        self.side
    }

    /// The image and its mip levels down to one texel a face, each texel the mean of four.
    pub(super) fn levels(self) -> Vec<Self> {
        let mut levels = vec![self];
        while let Some(last) = levels.last()
            && last.side > 1
        {
            let half = last.half();
            levels.push(half);
        }
        levels
    }

    /// Texels count by their solid angles, so that a small light has the same power in all levels.
    fn half(&self) -> Self {
        let side = self.side / 2;
        let mut radiance = Vec::with_capacity(FACES * side * side);
        for row in 0..FACES * side {
            for x in 0..side {
                let (mut sum, mut whole) = (Vec3::ZERO, 0.0);
                for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                    let (x, row) = (2 * x + dx, 2 * row + dy);
                    let weight = solid_angle([x, row % self.side], self.side);
                    sum += self.radiance[row * self.side + x] * weight;
                    whole += weight;
                }
                radiance.push(sum / whole);
            }
        }
        Self { side, radiance }
    }

    /// The radiance towards a direction, interpolated between texels of one face.
    pub(super) fn sample(&self, direction: Vec3) -> Vec3 {
        let (face, s, t) = face_of(direction);
        let last = self.side - 1;
        let scale = side_f32(self.side);
        let split = |coordinate: f32| {
            let texel = (coordinate * scale - 0.5).clamp(0.0, side_f32(last));
            let low = whole(texel).min(last);
            (low, (low + 1).min(last), texel - side_f32(low))
        };
        let ((x0, x1, fx), (y0, y1, fy)) = (split(s), split(t));
        let at = |x: usize, y: usize| self.radiance[(face * self.side + y) * self.side + x];
        let above = at(x0, y0).lerp(at(x1, y0), fx);
        above.lerp(at(x0, y1).lerp(at(x1, y1), fx), fy)
    }

    /// Each texel with its direction and the solid angle that it covers; the angles' sum is about
    /// 4π.
    pub(super) fn texels_with_solid_angles(&self) -> impl Iterator<Item = (Vec3, Vec3, f32)> {
        let side = self.side;
        self.radiance
            .iter()
            .enumerate()
            .map(move |(index, &texel)| {
                let (row, x) = (index / side, index % side);
                let (face, y) = (row / side, row % side);
                let angle = solid_angle([x, y], side);
                (direction(face, [x, y], side), texel, angle)
            })
    }

    /// The side, and the bytes of the texels times a factor as four 32-bit floats.
    pub(super) fn texels(&self, factor: f32) -> (u32, Vec<u8>) {
        let mut bytes = Vec::with_capacity(self.radiance.len() * 16);
        for &texel in &self.radiance {
            let numbers = (texel * factor).extend(1.0).to_array();
            bytes.extend(numbers.map(f32::to_le_bytes).as_flattened());
        }
        let side = u32::try_from(self.side).unwrap_or(u32::MAX);
        (side, bytes)
    }
}

/// The middle of a texel on its face, −1..1.
fn centre(texel: [usize; 2], side: usize) -> [f32; 2] {
    texel.map(|index| (side_f32(index) + 0.5) * 2.0 / side_f32(side) - 1.0)
}

/// The solid angle that a texel covers, about.
fn solid_angle(texel: [usize; 2], side: usize) -> f32 {
    let [s, t] = centre(texel, side);
    let squared = 1.0 + s * s + t * t;
    4.0 / (side_f32(side) * side_f32(side) * squared * squared.sqrt())
}

/// The unit direction of the middle of a texel.
pub(super) fn direction(face: usize, texel: [usize; 2], side: usize) -> Vec3 {
    let [s, t] = centre(texel, side);
    let towards = match face {
        0 => Vec3::new(1.0, -t, -s),
        1 => Vec3::new(-1.0, -t, s),
        2 => Vec3::new(s, 1.0, t),
        3 => Vec3::new(s, -1.0, -t),
        4 => Vec3::new(s, -t, 1.0),
        _ => Vec3::new(-s, -t, -1.0),
    };
    towards / towards.length()
}

/// The face that a direction meets, and where, 0..1 from the left and from the top.
fn face_of(d: Vec3) -> (usize, f32, f32) {
    let size = d.abs();
    let (face, s, t, axis) = if size.z >= size.x && size.z >= size.y {
        if d.z >= 0.0 {
            (4, d.x, -d.y, size.z)
        } else {
            (5, -d.x, -d.y, size.z)
        }
    } else if size.y >= size.x {
        if d.y >= 0.0 {
            (2, d.x, d.z, size.y)
        } else {
            (3, d.x, -d.z, size.y)
        }
    } else if d.x >= 0.0 {
        (0, -d.z, -d.y, size.x)
    } else {
        (1, d.z, -d.y, size.x)
    };
    let place = |c: f32| (c / axis.max(f32::MIN_POSITIVE) + 1.0) * 0.5;
    (face, place(s), place(t))
}

/// A number of texels as a float.
#[expect(clippy::cast_precision_loss, reason = "sides are at most 1024")]
pub(super) fn side_f32(count: usize) -> f32 {
    count as f32
}

/// A number of texels from a float that is not negative.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to 0..=side by callers; NaN gives 0"
)]
pub(super) fn whole(texels: f32) -> usize {
    texels as usize
}
