//! Every function gives the same bits for every kind of number.

use super::*;
use crate::maths::*;

#[test]
fn kinds_agree_on_functions_of_one_number() {
    agrees!(no emulated lanes "sign", x => sign(x));
    agrees!(no emulated lanes "ceil", x => ceil(x * 9.0));
    agrees!(no emulated lanes "trunc", x => trunc(x * 9.0));
    agrees!(no emulated lanes "round", x => round(x * 8.0));
    agrees!(no emulated lanes "fract", x => fract(x * 9.0));
    agrees!(no emulated lanes "inverse_sqrt", x => inverse_sqrt(x));
    agrees!(no emulated lanes "sin", x => sin(x * 70.0));
    agrees!(no emulated lanes "cos", x => cos(x * 70.0));
    agrees!(no emulated lanes "tan", x => tan(x * 70.0));
    agrees!(no emulated lanes "asin", x => asin(x));
    agrees!(no emulated lanes "acos", x => acos(x));
    agrees!(no emulated lanes "atan", x => atan(x * 9.0));
    agrees!(no emulated lanes "sinh", x => sinh(x * 45.0));
    agrees!(no emulated lanes "cosh", x => cosh(x * 45.0));
    agrees!(no emulated lanes "tanh", x => tanh(x * 5.0));
    agrees!(no emulated lanes "exp", x => exp(x * 45.0));
    agrees!(no emulated lanes "exp2", x => exp2(x * 65.0));
    agrees!(no emulated lanes "log", x => log(x));
    agrees!(no emulated lanes "log2", x => log2(x));
    agrees!(no emulated lanes "angles", x => radians(x) - degrees(x));
}

#[test]
fn kinds_agree_on_functions_of_several_numbers() {
    agrees!(no emulated lanes "atan2", x => atan2(x, 0.3) + atan2(0.3, x) + atan2(x, -x * x));
    agrees!(no emulated lanes "pow", x => pow(x, 2.2) + pow(2.2, x));
    agrees!(no emulated lanes "remainder", x => remainder(x * 7.0, 0.7) + remainder(x, -x));
    agrees!(no emulated lanes "modulo", x => modulo(x * 7.0, 0.7) + modulo(-3.0, x));
    agrees!(no emulated lanes "mix", x => mix(x, 2.0, 0.3) + mix(1.0, 2.0, x));
    agrees!(no emulated lanes "step", x => step(0.5, x) - step(x, 0.25));
    agrees!(no emulated lanes "smoothstep", x => smoothstep(-1.0, 0.5, x) - smoothstep(x, 1.0, x * 0.5));
    agrees!(no emulated lanes "select", x => select(x, -1.0, x.lt(0.5)));
    agrees!(no emulated lanes "bounds", x => clamp(min(x, 0.5), -0.7, max(0.3, x)));
}

#[test]
fn kinds_agree_on_operators_with_constants() {
    agrees!("left", x => (1.0 - x) * (2.0 + x) / (3.0 * x) - 1.0 / x);
    agrees!(no emulated lanes "assigned", x => {
        let mut y = x;
        y += 1.0;
        y *= 0.7;
        y -= 0.3;
        y /= 3.0;
        y
    });
    agrees!(no emulated lanes "compared", x => {
        let inside = x.ge(-0.5) & x.le(0.5) & !x.eq(0.25);
        R::select(inside | x.gt(1.0), x.max(0.1), x.min(-0.1))
    });
}

#[test]
fn kinds_agree_on_vectors() {
    agrees!(no emulated lanes "operators", x => {
        let mut v = vec3(x, 0.5, x * x);
        v += x;
        v *= vec3(1.0, 2.0, 3.0);
        v -= 0.25;
        v = (1.0 - v) * 2.0 + x * v - v / x + x * vec3(0.1, 0.2, 0.3);
        v.x + v.y + v.z
    });
    agrees!(no emulated lanes "geometry", x => {
        let (v, n) = (vec3(x, 0.5, -0.2), vec3(0.2, 0.3, x).normalize());
        let w = reflect(v, n) + refract(v, n, 0.7) + cross(n, v) + face_forward(n, v, n);
        dot(w, v) + distance(w, v) + length(w.xy())
    });
    agrees!(no emulated lanes "componentwise", x => {
        let v = vec4(x, 1.5, x * 3.0, -0.5);
        let w = sin(v) + exp(v) * atan(v) - smoothstep(0.0, 1.0, v) + mix(v, 1.0, 0.3);
        w.saturate().dot(v.wzyx()) + clamp(v, -0.5, 0.5).length()
    });
    agrees!(no emulated lanes "matrices", x => {
        let m = Mat3::from_columns(vec3(x, 0.0, 1.0), vec3(0.5, x, 0.2), vec3(0.1, 0.2, x));
        let rotation = Mat4::rotation([1.0, 2.0, 3.0], 0.7);
        let v = rotation.to_mat3() * m * m.transpose() * vec3(x, 1.0, 2.0);
        let p = rotation.transform_point(v) + rotation * v.extend(0.5);
        p.dot(vec4(1.0, 2.0, 3.0, 4.0)) + m.determinant()
    });
}
