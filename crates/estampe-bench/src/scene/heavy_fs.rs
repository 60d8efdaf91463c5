//! `heavy_fs`: a full-screen quad whose fragments trace a ray through a field of rounded boxes,
//! warped by sines.
//!
//! A ray has at most 64 steps; it ends when it hits or is too long. Hits are shaded with four
//! octaves of value noise. The uniform is the frame's size in pixels, and two zeros. A vertex is
//! its position (2 floats).

use super::{Scene, uniforms, vertex_layout};
use crate::frame::FrameSize;
use crate::generate::{LittleEndian, QUAD_CORNERS, quad_indices};
use estampe::{
    FragmentIn, FragmentOut, Int, Real, RenderPipelineDescriptor, Vec2, Vec3, Vec4, VertexFormat,
    VertexIn, VertexOut, maths,
};

/// The greatest number of steps of a ray.
const STEPS: u32 = 64;
/// A ray this close to a surface has hit it.
const HIT_DISTANCE: f32 = 0.001;
/// A ray this long hits nothing.
const FAR: f32 = 24.0;
const EYE: [f32; 3] = [1.0, 1.0, 3.0];
const TOWARDS_LIGHT: [f32; 3] = [0.48, 0.64, 0.6];
const BACKGROUND: [f32; 3] = [0.05, 0.07, 0.1];

/// Sphere tracing (Hart 1996).
struct Field {
    size_px: [f32; 2],
}

estampe::shader! {
    impl Shader for Field {
        type Attributes<R: Real> = Vec2<R>; // position
        type Varyings<R: Real> = ();

        fn vertex<R: Real>(&self, input: VertexIn<'_, R>, at: Vec2<R>) -> VertexOut<R, ()> {
            let position = Vec4::new(at.x, at.y, input.real(0.5), input.real(1.0));
            VertexOut::new(position, ())
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, (): ()) -> FragmentOut<R> {
            let [width, height] = self.size_px;
            let x = (input.position.x * 2.0 - width) / height;
            let y = (input.position.y * 2.0 - height) / height;
            let ray = Vec3::new(x, -y, input.real(-1.6)).normalize();
            let eye = Vec3::uniform(input.zero, EYE);
            let (distance, hit) = trace(eye, ray);
            let background = Vec3::uniform(input.zero, BACKGROUND);
            if !R::any(hit) {
                return FragmentOut::color(background.point());
            }
            let surface = surface_color(eye + ray * distance);
            let color = background.mix(surface, maths::exp(distance * -0.12));
            FragmentOut::color(Vec3::select(hit, color, background).point())
        }
    }
}

/// The length of each lane's ray, and whether it hits. A packet continues until its last lane is
/// done.
///
/// A lane that has hit stays in place, so its next step is small again. A lane that is too far
/// continues, which does no harm, because its distance is not used. So lanes that are done need no
/// mask, on which every step would depend.
#[inline(always)]
fn trace<R: Real>(eye: Vec3<R>, ray: Vec3<R>) -> (R, R::SelectMask) {
    let mut distance = eye.x.splat(0.0);
    let mut near = eye.x.splat_mask(false);
    for _ in 0..STEPS {
        let step = distance_to_boxes(eye + ray * distance);
        near = step.lt(step.splat(HIT_DISTANCE));
        distance = R::select(near, distance, distance + step);
        if !R::any(!(near | distance.gt(step.splat(FAR)))) {
            break;
        }
    }
    (distance, near & !distance.gt(distance.splat(FAR)))
}

/// A lower bound of the distance to rounded boxes that repeat every two units.
#[inline(always)]
fn distance_to_boxes<R: Real>(p: Vec3<R>) -> R {
    let x = outside_box(p.x + maths::sin(p.y * 2.0) * 0.15);
    let y = outside_box(p.y + maths::sin(p.z * 2.0) * 0.15);
    let z = outside_box(p.z + maths::sin(p.x * 2.0) * 0.15);
    (Vec3::new(x, y, z).length() - 0.12) * 0.8
}

/// The distance by which a coordinate is outside the nearest box.
#[inline(always)]
fn outside_box<R: Real>(w: R) -> R {
    let cell = (w * 0.5 + 0.5).floor();
    ((w - cell * 2.0).abs() - 0.4).max(w.splat(0.0))
}

/// Lambert's cosine law and noise at a point of a surface.
#[inline(always)]
fn surface_color<R: Real>(p: Vec3<R>) -> Vec3<R> {
    // The gradient of the distance, from the four corners of a tetrahedron.
    let (near, far) = (0.001, -0.001);
    let mut gradient = Vec3::repeat(p.x.splat(0.0));
    for corner in [
        [near, far, far],
        [far, far, near],
        [far, near, far],
        [near, near, near],
    ] {
        let corner = Vec3::uniform(p.x, corner);
        gradient += corner * distance_to_boxes(p + corner);
    }
    let light = gradient.normalize().dot_uniform(TOWARDS_LIGHT);
    let light = light.max(p.x.splat(0.0)) * 0.85 + 0.15;
    let noise = layered_noise(Vec2::new(p.x + p.z, p.y - p.z) * p.x.splat(6.0));
    Vec3::new(p.x.splat(0.9), noise * 0.4 + 0.55, noise * 0.6 + 0.3) * light
}

/// Four octaves of noise, each rotated and twice as fine as the previous one.
#[inline(always)]
fn layered_noise<R: Real>(mut p: Vec2<R>) -> R {
    let mut sum = p.x.splat(0.0);
    let mut weight = 0.5;
    for _ in 0..4 {
        sum += value_noise(p) * weight;
        p = Vec2::new(p.x * 1.6 + p.y * 1.2, p.y * 1.6 - p.x * 1.2);
        weight *= 0.5;
    }
    sum
}

/// Random values at integer points, interpolated smoothly.
#[inline(always)]
fn value_noise<R: Real>(p: Vec2<R>) -> R {
    let (left, upper) = (p.x.floor(), p.y.floor());
    let (fx, fy) = (p.x - left, p.y - upper);
    let (wx, wy) = (smooth(fx), smooth(fy));
    let (x, y) = (left.to_int(), upper.to_int());
    let (right, lower) = (x + x.splat(1), y + y.splat(1));
    let a = mix(unit_hash::<R>(x, y), unit_hash::<R>(right, y), wx);
    let b = mix(unit_hash::<R>(x, lower), unit_hash::<R>(right, lower), wx);
    mix(a, b, wy)
}

/// 3f² − 2f³.
#[inline(always)]
fn smooth<R: Real>(f: R) -> R {
    f * f * (f.splat(3.0) - f * 2.0)
}

#[inline(always)]
fn mix<R: Real>(a: R, b: R, t: R) -> R {
    a + (b - a) * t
}

/// A pseudo-random number in 0..1 for an integer point.
#[inline(always)]
fn unit_hash<R: Real>(x: R::Int, y: R::Int) -> R {
    let times = |value: R::Int, by: u32| value.wrapping_mul(value.splat(by.cast_signed()));
    let mixed = times(x, 0x9E37_79B9) ^ times(y, 0x85EB_CA6B);
    let mixed = times(mixed ^ mixed.shr_unsigned(16), 0x7FEB_352D);
    let mixed = times(mixed ^ mixed.shr_unsigned(15), 0x846C_A68B);
    let mixed = mixed ^ mixed.shr_unsigned(16);
    mixed.shr_unsigned(8).to_real() * (1.0 / 16_777_216.0)
}

pub(super) fn scene(size: FrameSize) -> Scene {
    let mut vertices = LittleEndian::default();
    for corner in QUAD_CORNERS {
        vertices.reals(&corner);
    }
    let mut uniform_bytes = LittleEndian::default();
    uniform_bytes.reals(&[size.width.into(), size.height.into(), 0.0, 0.0]);
    let uniform_bytes = uniform_bytes.into_bytes();
    let [width, height, _] = uniforms::vector(&uniform_bytes, 0);
    let shader = Field {
        size_px: [width, height],
    };
    let pipeline = RenderPipelineDescriptor {
        vertex_buffers: vec![vertex_layout(8, &[(VertexFormat::Float32x2, 0)])],
        ..RenderPipelineDescriptor::new(shader)
    };
    let buffers = vec![vertices.into_bytes(), quad_indices(1), uniform_bytes];
    Scene::of_one_draw("heavy_fs", buffers, Vec::new(), pipeline)
}
