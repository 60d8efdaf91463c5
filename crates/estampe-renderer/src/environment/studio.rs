//! The studio: a room of soft grey with boxes of light, for models that bring no surroundings.
//!
//! The camera is at +Z. The key light is above on the left, a weaker one fills from the right, two
//! upright strips behind draw the edges of dark and shiny models, and a box overhead shapes what
//! points up. A white surface that faces the camera has a radiance of about 0.7.

use glam::Vec3;

/// The side of a face: lights have soft edges, so that mirrors show no texels.
pub(super) const SIDE: usize = 64;

/// A rectangle of light, far away.
struct Panel {
    /// Towards its middle; need not be unit.
    towards: Vec3,
    /// Tangents of half of its angles, to the side and upwards.
    half: [f32; 2],
    /// Width of the soft edge, in the same unit.
    edge: f32,
    radiance: [f32; 3],
}

const PANELS: [Panel; 5] = [
    // Key.
    Panel {
        towards: Vec3::new(-0.75, 0.72, 0.75),
        half: [0.50, 0.42],
        edge: 0.22,
        radiance: [4.50, 4.42, 4.29],
    },
    // Fill.
    Panel {
        towards: Vec3::new(1.0, 0.18, 0.62),
        half: [0.26, 0.62],
        edge: 0.20,
        radiance: [0.89, 0.93, 0.95],
    },
    // Overhead.
    Panel {
        towards: Vec3::new(0.05, 1.0, -0.15),
        half: [0.60, 0.34],
        edge: 0.18,
        radiance: [1.61, 1.61, 1.61],
    },
    // Strips behind, left and right.
    Panel {
        towards: Vec3::new(-0.9, 0.25, -0.75),
        half: [0.14, 0.75],
        edge: 0.12,
        radiance: [2.46, 2.51, 2.55],
    },
    Panel {
        towards: Vec3::new(0.95, 0.35, -0.7),
        half: [0.18, 0.75],
        edge: 0.12,
        radiance: [3.06, 3.06, 2.98],
    },
];

/// Radiance of the room below, at the height of the eyes, and above.
const ROOM: [[f32; 3]; 3] = [[0.12, 0.115, 0.11], [0.21, 0.21, 0.21], [0.27, 0.275, 0.28]];

/// The radiance that comes from a unit direction.
pub(super) fn radiance(direction: Vec3) -> Vec3 {
    let [below, level, above] = ROOM.map(Vec3::from);
    let height = direction.y;
    let room = if height < 0.0 {
        level.lerp(below, smoothstep(-height))
    } else {
        level.lerp(above, smoothstep(height))
    };
    let lights = PANELS.iter().map(|panel| panel.radiance(direction));
    lights.fold(room, |sum, light| sum + light)
}

impl Panel {
    fn radiance(&self, direction: Vec3) -> Vec3 {
        let towards = self.towards / self.towards.length();
        let side = Vec3::Y.cross(towards);
        let side = side / side.length();
        let up = towards.cross(side);
        let forward = direction.dot(towards);
        if forward <= 0.0 {
            return Vec3::ZERO;
        }
        let cover = |axis: Vec3, half: f32| {
            let outside = (direction.dot(axis) / forward).abs() - half;
            smoothstep(0.5 - outside / self.edge)
        };
        Vec3::from(self.radiance) * (cover(side, self.half[0]) * cover(up, self.half[1]))
    }
}

/// 3t² − 2t³ of t clamped to 0..1.
fn smoothstep(t: f32) -> f32 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}
