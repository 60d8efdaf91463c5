//! A fragment that is lit: Blinn-Phong with two lights, about 300 operations.

use estampe_ir::interface::{BufferSlot, Input, Output, Stage};
use estampe_ir::op::{Binary, Math2, Unary};
use estampe_ir::tree::{Builder, Tree};
use estampe_ir::{Op, Value};

type Vec3 = [Value; 3];

struct Shader(Builder);

impl Shader {
    fn op(&mut self, kind: Binary, a: Value, b: Value) -> Value {
        self.0.binary(kind, a, b)
    }

    fn each(&mut self, kind: Binary, a: Vec3, b: Vec3) -> Vec3 {
        [0, 1, 2].map(|k| self.op(kind, a[k], b[k]))
    }

    fn scaled(&mut self, a: Vec3, by: Value) -> Vec3 {
        a.map(|a| self.op(Binary::FMul, a, by))
    }

    fn dot(&mut self, a: Vec3, b: Vec3) -> Value {
        let [x, y, z] = self.each(Binary::FMul, a, b);
        let sum = self.op(Binary::FAdd, x, y);
        self.op(Binary::FAdd, sum, z)
    }

    fn inverse_sqrt(&mut self, x: Value) -> Value {
        let one = self.0.float(1.0);
        let root = self.0.unary(Unary::FSqrt, x);
        self.op(Binary::FDiv, one, root)
    }

    fn normalized(&mut self, a: Vec3) -> Vec3 {
        let square = self.dot(a, a);
        let inverse = self.inverse_sqrt(square);
        self.scaled(a, inverse)
    }

    fn clamped(&mut self, x: Value) -> Value {
        let [zero, one] = [0.0, 1.0].map(|number| self.0.float(number));
        let x = self.op(Binary::FMax, x, zero);
        self.op(Binary::FMin, x, one)
    }

    /// Three floats of the buffer of uniforms.
    fn uniform(&mut self, word: u32) -> Vec3 {
        [0, 1, 2].map(|k| {
            let offset = self.0.word((word + k) * 4);
            self.0.op1(Op::LoadBuffer { buffer: 0, offset })
        })
    }

    fn varying(&mut self, first: u32) -> Vec3 {
        [0, 1, 2].map(|k| self.0.input(Input::Varying(first + k)))
    }
}

pub(crate) fn blinn_phong() -> Tree {
    let mut s = Shader(Builder::new(Stage::Fragment));
    s.0.interface_mut().buffers.push(BufferSlot {
        group: 0,
        binding: 0,
        is_written: false,
    });
    let [world, normal, albedo] = [0, 3, 6].map(|first| s.varying(first));
    let eye = s.uniform(0);
    let normal = s.normalized(normal);
    let view = s.each(Binary::FSub, eye, world);
    let view = s.normalized(view);
    let ambient = s.uniform(3);
    let mut color = s.each(Binary::FMul, ambient, albedo);
    for light in 0..2 {
        let [place, intensity, specular] = [0, 3, 6].map(|part| s.uniform(8 + light * 12 + part));
        let towards = s.each(Binary::FSub, place, world);
        let square = s.dot(towards, towards);
        let inverse = s.inverse_sqrt(square);
        let towards = s.scaled(towards, inverse);
        let fading = s.op(Binary::FMul, inverse, inverse);
        let half = s.each(Binary::FAdd, towards, view);
        let half = s.normalized(half);
        let diffuse = s.dot(normal, towards);
        let diffuse = s.clamped(diffuse);
        let shine = s.dot(normal, half);
        let shine = s.clamped(shine);
        let power = s.0.float(32.0);
        let shine = s.0.op1(Op::Math2(Math2::Pow, [shine, power]));
        for k in 0..3 {
            let matte = s.op(Binary::FMul, albedo[k], diffuse);
            let gloss = s.op(Binary::FMul, specular[k], shine);
            let both = s.op(Binary::FAdd, matte, gloss);
            let strength = s.op(Binary::FMul, intensity[k], fading);
            let both = s.op(Binary::FMul, both, strength);
            color[k] = s.op(Binary::FAdd, color[k], both);
        }
    }
    // A filmic curve (Narkowicz 2015) and a rim light, to about 300 operations.
    for (k, channel) in color.iter_mut().enumerate() {
        let x = *channel;
        let [a, b, c, d, e] = [2.51, 0.03, 2.43, 0.59, 0.14].map(|number| s.0.float(number));
        let upper = s.op(Binary::FMul, x, a);
        let upper = s.op(Binary::FAdd, upper, b);
        let upper = s.op(Binary::FMul, upper, x);
        let lower = s.op(Binary::FMul, x, c);
        let lower = s.op(Binary::FAdd, lower, d);
        let lower = s.op(Binary::FMul, lower, x);
        let lower = s.op(Binary::FAdd, lower, e);
        let curve = s.op(Binary::FDiv, upper, lower);
        let rim = s.dot(normal, view);
        let one = s.0.float(1.0);
        let rim = s.op(Binary::FSub, one, rim);
        let cube = s.op(Binary::FMul, rim, rim);
        let cube = s.op(Binary::FMul, cube, ambient[k]);
        let sum = s.op(Binary::FAdd, curve, cube);
        *channel = s.clamped(sum);
    }
    let alpha = s.0.float(1.0);
    let [r, g, b] = color;
    let component = |component| Output::Color {
        target: 0,
        component,
    };
    let outputs = [r, g, b, alpha].into_iter().zip(0..);
    let outputs = outputs.map(|(value, at)| (component(at), value)).collect();
    s.0.finish(outputs)
}
