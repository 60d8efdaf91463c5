//! Functions of vectors.

use crate::lower::Lowering;
use estampe_ir::Value;
use estampe_ir::op::{Binary, Compare, Unary};

impl Lowering<'_> {
    pub(super) fn each(&mut self, kind: Binary, a: &[Value], b: &[Value]) -> Vec<Value> {
        let at = |list: &[Value], at: usize| list[at.min(list.len() - 1)];
        let count = a.len().max(b.len());
        (0..count)
            .map(|k| self.builder.binary(kind, at(a, k), at(b, k)))
            .collect()
    }

    pub(super) fn integer_dot(&mut self, arguments: &[Vec<Value>]) -> Value {
        let products = self.each(Binary::Mul, &arguments[0], &arguments[1]);
        let zero = self.builder.word(0);
        products
            .into_iter()
            .fold(zero, |sum, one| self.builder.binary(Binary::Add, sum, one))
    }

    pub(super) fn length(&mut self, v: &[Value]) -> Value {
        if let [x] = v {
            return self.builder.unary(Unary::FAbs, *x);
        }
        let square = self.dot(v, v);
        self.builder.unary(Unary::FSqrt, square)
    }

    pub(super) fn normalize(&mut self, v: &[Value]) -> Vec<Value> {
        let (one, length) = (self.builder.float(1.0), self.length(v));
        let factor = self.builder.binary(Binary::FDiv, one, length);
        self.each(Binary::FMul, v, &[factor])
    }

    pub(super) fn cross(&mut self, a: &[Value], b: &[Value]) -> Vec<Value> {
        let part = |k: usize| {
            let [i, j] = [(k + 1) % 3, (k + 2) % 3];
            let first = self.builder.binary(Binary::FMul, a[i], b[j]);
            let second = self.builder.binary(Binary::FMul, a[j], b[i]);
            self.builder.binary(Binary::FSub, first, second)
        };
        [0, 1, 2].map(part).to_vec()
    }

    /// v − n·(n·v·2).
    pub(super) fn reflect(&mut self, v: &[Value], n: &[Value]) -> Vec<Value> {
        let along = self.dot(n, v);
        let double = self.times(along, 2.0);
        let back = self.each(Binary::FMul, n, &[double]);
        self.each(Binary::FSub, v, &back)
    }

    /// k = 1 − η²(1 − (n·v)²); η·v − (η·(n·v) + √k)·n, or zeros where k is negative.
    pub(super) fn refract(&mut self, arguments: &[Vec<Value>]) -> Vec<Value> {
        let (v, n, eta) = (&arguments[0], &arguments[1], arguments[2][0]);
        let (one, zero) = (self.builder.float(1.0), self.builder.float(0.0));
        let along = self.dot(n, v);
        let square = self.builder.binary(Binary::FMul, along, along);
        let across = self.builder.binary(Binary::FSub, one, square);
        let ratio = self.builder.binary(Binary::FMul, eta, eta);
        let bent = self.builder.binary(Binary::FMul, ratio, across);
        let k = self.builder.binary(Binary::FSub, one, bent);
        let is_inside = self.builder.compare(Compare::FLt, k, zero);
        let root = self.builder.unary(Unary::FSqrt, k);
        let part = self.builder.binary(Binary::FMul, eta, along);
        let normal = self.builder.binary(Binary::FAdd, part, root);
        let forward = self.each(Binary::FMul, v, &[eta]);
        let back = self.each(Binary::FMul, n, &[normal]);
        let through = self.each(Binary::FSub, &forward, &back);
        through
            .into_iter()
            .map(|one| self.builder.select(is_inside, zero, one))
            .collect()
    }

    pub(super) fn face_forward(&mut self, arguments: &[Vec<Value>]) -> Vec<Value> {
        let (n, incident, reference) = (&arguments[0], &arguments[1], &arguments[2]);
        let (along, zero) = (self.dot(reference, incident), self.builder.float(0.0));
        let faces = self.builder.compare(Compare::FLt, along, zero);
        let one = |&n: &Value| {
            let away = self.builder.unary(Unary::FNeg, n);
            self.builder.select(faces, n, away)
        };
        n.iter().map(one).collect()
    }

    pub(super) fn outer(&mut self, column: &[Value], row: &[Value]) -> Vec<Value> {
        let columns = row
            .iter()
            .map(|&factor| self.each(Binary::FMul, column, &[factor]));
        columns.flatten().collect()
    }
}
