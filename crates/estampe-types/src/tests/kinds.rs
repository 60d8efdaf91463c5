//! Every function gives the same bits for every kind of number.

use super::*;
use crate::maths::*;

#[test]
fn kinds_agree_on_functions_of_one_number() {
    agrees!("sign", x => sign(x));
    agrees!("ceil", x => ceil(x * 9.0));
    agrees!("trunc", x => trunc(x * 9.0));
    agrees!("round", x => round(x * 8.0));
    agrees!("fract", x => fract(x * 9.0));
    agrees!("inverse_sqrt", x => inverse_sqrt(x));
    agrees!("sin", x => sin(x * 70.0));
    agrees!("cos", x => cos(x * 70.0));
    agrees!("tan", x => tan(x * 70.0));
    agrees!("asin", x => asin(x));
    agrees!("acos", x => acos(x));
    agrees!("atan", x => atan(x * 9.0));
    agrees!("sinh", x => sinh(x * 45.0));
    agrees!("cosh", x => cosh(x * 45.0));
    agrees!("tanh", x => tanh(x * 5.0));
    agrees!("exp", x => exp(x * 45.0));
    agrees!("exp2", x => exp2(x * 65.0));
    agrees!("log", x => log(x));
    agrees!("log2", x => log2(x));
    agrees!("angles", x => radians(x) - degrees(x));
}

#[test]
fn kinds_agree_on_functions_of_several_numbers() {
    agrees!("atan2", x => atan2(x, 0.3) + atan2(0.3, x) + atan2(x, -x * x));
    agrees!("pow", x => pow(x, 2.2) + pow(2.2, x));
    agrees!("remainder", x => remainder(x * 7.0, 0.7) + remainder(x, -x));
    agrees!("modulo", x => modulo(x * 7.0, 0.7) + modulo(-3.0, x));
    agrees!("mix", x => mix(x, 2.0, 0.3) + mix(1.0, 2.0, x));
    agrees!("step", x => step(0.5, x) - step(x, 0.25));
    agrees!("smoothstep", x => smoothstep(-1.0, 0.5, x) - smoothstep(x, 1.0, x * 0.5));
    agrees!("select", x => select(x, -1.0, x.lt(0.5)));
    agrees!("bounds", x => clamp(min(x, 0.5), -0.7, max(0.3, x)));
}

#[test]
fn kinds_agree_on_operators_with_constants() {
    agrees!("left", x => (1.0 - x) * (2.0 + x) / (3.0 * x) - 1.0 / x);
    agrees!("assigned", x => {
        let mut y = x;
        y += 1.0;
        y *= 0.7;
        y -= 0.3;
        y /= 3.0;
        y
    });
    agrees!("compared", x => {
        let inside = x.ge(-0.5) & x.le(0.5) & !x.eq(0.25);
        R::select(inside | x.gt(1.0), x.max(0.1), x.min(-0.1))
    });
}

#[test]
fn kinds_agree_on_vectors() {
    agrees!("operators", x => {
        let mut v = vec3(x, 0.5, x * x);
        v += x;
        v *= vec3(1.0, 2.0, 3.0);
        v -= 0.25;
        v = (1.0 - v) * 2.0 + x * v - v / x + x * vec3(0.1, 0.2, 0.3);
        v.x + v.y + v.z
    });
    agrees!("geometry", x => {
        let (v, n) = (vec3(x, 0.5, -0.2), vec3(0.2, 0.3, x).normalize());
        let w = reflect(v, n) + refract(v, n, 0.7) + cross(n, v) + face_forward(n, v, n);
        dot(w, v) + distance(w, v) + length(w.xy())
    });
    agrees!("componentwise", x => {
        let v = vec4(x, 1.5, x * 3.0, -0.5);
        let w = sin(v) + exp(v) * atan(v) - smoothstep(0.0, 1.0, v) + mix(v, 1.0, 0.3);
        w.saturate().dot(v.wzyx()) + clamp(v, -0.5, 0.5).length()
    });
    agrees!("matrices", x => {
        let m = Mat3::from_columns(vec3(x, 0.0, 1.0), vec3(0.5, x, 0.2), vec3(0.1, 0.2, x));
        let rotation = Mat4::rotation([1.0, 2.0, 3.0], 0.7);
        let v = rotation.to_mat3() * m * m.transpose() * vec3(x, 1.0, 2.0);
        let p = rotation.transform_point(v) + rotation * v.extend(0.5);
        p.dot(vec4(1.0, 2.0, 3.0, 4.0)) + m.determinant()
    });
}
