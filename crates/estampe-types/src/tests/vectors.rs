//! Operators, functions and swizzles of vectors.

use crate::maths::*;
use crate::{Mat4, Quad, Real, Vec2, Vec3, Vec4, vec2, vec3, vec4};

const V: Vec3<f32> = Vec3::new(1.0, 2.0, 3.0);
const W: Vec3<f32> = Vec3::new(4.0, -5.0, 6.0);

#[test]
fn operators_are_componentwise() {
    assert_eq!(V + W, vec3(5.0, -3.0, 9.0));
    assert_eq!(V - W, vec3(-3.0, 7.0, -3.0));
    assert_eq!(V * W, vec3(4.0, -10.0, 18.0));
    assert_eq!(W / V, vec3(4.0, -2.5, 2.0));
    assert_eq!(-V, vec3(-1.0, -2.0, -3.0));
    assert_eq!(
        (V + 1.0, 1.0 - V),
        (vec3(2.0, 3.0, 4.0), vec3(0.0, -1.0, -2.0))
    );
    assert_eq!((2.0 * V, V * 2.0), (V + V, V + V));
    assert_eq!(
        (V / 2.0, 6.0 / V),
        (vec3(0.5, 1.0, 1.5), vec3(6.0, 3.0, 2.0))
    );
    let mut sum = V;
    sum += W;
    sum *= 2.0;
    sum -= 1.0;
    sum /= vec3(1.0, 7.0, 17.0);
    assert_eq!(sum, vec3(9.0, -1.0, 1.0));
}

/// Numbers of a kind, constants, and fields of a shader in one expression.
#[test]
fn numbers_and_constants_mix() {
    struct Shader {
        strength: f32,
        tint: Vec3<f32>,
    }
    fn shade<R: Real>(shader: &Shader, light: R, v: Vec3<R>) -> Vec4<R> {
        let half = shader.strength * 0.5;
        let color = shader.tint * v * shader.strength + light * shader.tint;
        let rim = light - v + (light / v) * half;
        let bright = light * vec3(1.0, 0.5, 0.25) * (1.0 - light) + vec3(light, 0.0, 1.0) - rim;
        (color + bright)
            .max(0.0)
            .min(light + half)
            .extend(1.0 - shader.strength)
    }
    let shader = Shader {
        strength: 0.5,
        tint: vec3(0.1, 0.2, 0.3),
    };
    let one = shade(&shader, 0.7, vec3(0.3, 0.6, 0.9));
    let four = |value| Quad([value; 4]);
    let quad = shade(&shader, four(0.7), vec3(four(0.3), 0.6, 0.9));
    for (lane, value) in <[f32; 4]>::from(one).into_iter().enumerate() {
        assert_eq!(
            <[Quad; 4]>::from(quad)[lane],
            four(value),
            "component {lane}"
        );
    }
}

/// With an `f32` on both sides, functions of any kind compute with `f32`.
#[test]
fn constants_stay_f32_in_generic_functions() {
    fn mixed<R: Real>(x: R, table: &[f32], index: usize) -> R {
        let third = index as f32 / 3.0 * 2.0;
        let sum: f32 = table.iter().map(|&t| 1.0 - t * 2.0 + third * t).sum();
        let peak = table
            .iter()
            .fold(0.0, |a, &b| if a > b { a } else { b * 1.0 });
        let double = (f64::from(sum) * 2.0 - 1.0) as f32;
        x * sum * (1.0 - peak) + double * x - sum * peak * 0.5
    }
    assert_eq!(
        mixed(2.0, &[0.5, 0.25], 3),
        mixed(Quad([2.0; 4]), &[0.5, 0.25], 3).0[1]
    );
}

#[test]
fn geometry_is_that_of_the_specification() {
    assert_eq!((dot(V, W), V.dot(2.0)), (12.0, 12.0));
    assert_eq!(cross(V, W), vec3(27.0, 6.0, -13.0));
    assert_eq!(
        (length(vec2(3.0, 4.0)), distance(V, V + vec3(0.0, 3.0, 4.0))),
        (5.0, 5.0)
    );
    assert_eq!(
        normalize(vec4(0.0, 0.0, 4.0, 0.0)),
        vec4(0.0, 0.0, 1.0, 0.0)
    );
    let up = vec3(0.0, 1.0, 0.0);
    assert_eq!(reflect(vec3(1.0, -1.0, 0.0), up), vec3(1.0, 1.0, 0.0));
    assert_eq!(face_forward(up, V, up), -up);
    assert_eq!(face_forward(up, W, up), up);
    // Snell's law: sin 30° · 1.5 = sin of the refracted angle.
    let incident = vec3(0.5, -0.866_025_4, 0.0);
    let refracted = refract(incident, up, 1.5);
    assert!(
        (refracted - vec3(0.75, -0.661_437_8, 0.0)).length() < 1e-6,
        "{refracted:?}"
    );
    assert_eq!(
        refract(incident, up, 2.5),
        vec3(0.0, 0.0, 0.0),
        "total internal reflection"
    );
    assert_eq!(refract(-up, up, 1.5), -up);
}

#[test]
fn functions_take_vectors_numbers_and_constants() {
    assert_eq!(mix(V, W, vec3(0.0, 0.5, 1.0)), vec3(1.0, -1.5, 6.0));
    assert_eq!(mix(V, 0.0, 0.5), vec3(0.5, 1.0, 1.5));
    assert_eq!(step(2.0, V), vec3(0.0, 1.0, 1.0));
    assert_eq!(clamp(W, 0.0, vec3(1.0, 2.0, 3.0)), vec3(1.0, 0.0, 3.0));
    assert_eq!(
        (min(V, 2.0), max(2.0, V)),
        (vec3(1.0, 2.0, 2.0), vec3(2.0, 2.0, 3.0))
    );
    assert_eq!(pow(vec2(2.0, 4.0), vec2(3.0, 0.5)), vec2(8.0, 2.0));
    assert_eq!(
        smoothstep(0.0, vec2(1.0, 2.0), vec2(1.0, 1.0)),
        vec2(1.0, 0.5)
    );
    assert_eq!(abs(W).x + sign(W).y + floor(W * 0.3).z, 4.0 - 1.0 + 1.0);
    assert_eq!(select(V, 0.0, true), vec3(0.0, 0.0, 0.0));
    assert_eq!(V.mix(W, 0.5).clamp(0.0, 3.0), vec3(2.5, 0.0, 3.0));
    assert_eq!(sqrt(vec2(4.0, 9.0)).modulo(2.0), vec2(0.0, 1.0));
}

#[test]
fn swizzles_pick_components() {
    let v = Vec4::new(1.0, 2.0, 3.0, 4.0);
    assert_eq!(
        (v.xy(), v.zw(), v.xz()),
        (vec2(1.0, 2.0), vec2(3.0, 4.0), vec2(1.0, 3.0))
    );
    assert_eq!(
        (v.zyx(), v.rgb(), v.xxx()),
        (vec3(3.0, 2.0, 1.0), v.xyz(), vec3(1.0, 1.0, 1.0))
    );
    assert_eq!(
        (v.bgra(), v.wzyx()),
        (vec4(3.0, 2.0, 1.0, 4.0), vec4(4.0, 3.0, 2.0, 1.0))
    );
    assert_eq!((v.r(), v.g(), v.b(), v.a()), (1.0, 2.0, 3.0, 4.0));
    assert_eq!(V.xy().extend(9.0).yzx(), vec3(2.0, 9.0, 1.0));
    assert_eq!(vec2(1.0, 2.0).yxyx(), vec4(2.0, 1.0, 2.0, 1.0));
}

#[test]
fn constructors_take_numbers_and_constants() {
    fn corner<R: Real>(x: R) -> Vec4<R> {
        vec4(x, 0.5, 2.0 * x, 1.0) + vec4(0.0, x, 0.0, 0.0) + vec2(0.0, x).extend(0.5).extend(x)
    }
    assert_eq!(corner(1.0), vec4(1.0, 2.5, 2.5, 2.0));
    assert_eq!(corner(Quad([1.0; 4])).y, Quad([2.5; 4]));
    let constant: Vec3<f32> = vec3(0.2, 0.4, 0.6);
    assert_eq!(Vec3::uniform(Quad([0.0; 4]), constant).z, Quad([0.6; 4]));
    assert_eq!(Mat4::IDENTITY.transform_point(constant), constant.point());
    assert_eq!(Vec2::from([1.0, 2.0]), vec2(1.0, 2.0));
}

#[test]
fn masks_hold_in_all_or_any_lane() {
    let x = Quad([0.0, 1.0, 2.0, 3.0]);
    assert!(Quad::any(x.gt(2.5)) && !Quad::any(x.gt(3.0)));
    assert!(Quad::all(x.ge(0.0)) && !Quad::all(x.ge(1.0)));
    assert_eq!(Quad::mask_bits(x.lt(1.5) | x.eq(3.0)), 0b1011);
}
