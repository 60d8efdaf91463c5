//! Functions of matrices.

use crate::lower::{LowerError, Lowered, Lowering};
use estampe_ir::Value;
use estampe_ir::op::{Binary, Unary};
use naga::{MathFunction, TypeInner};

impl Lowering<'_> {
    pub(super) fn of_matrix(
        &mut self,
        function: MathFunction,
        inner: &TypeInner,
        matrix: &[Value],
    ) -> Lowered<Vec<Value>> {
        let &TypeInner::Matrix { columns, rows, .. } = inner else {
            return Err(LowerError::Unsupported("matrices of this type"));
        };
        let (columns, rows) = (columns as usize, rows as usize);
        match function {
            MathFunction::Transpose => {
                let row = |row: usize| matrix.iter().skip(row).step_by(rows).copied();
                Ok((0..rows).flat_map(row).collect())
            }
            MathFunction::Determinant => Ok(vec![self.determinant(matrix, columns)]),
            _ => Ok(self.inverse(matrix, columns)),
        }
    }

    /// By the first column, from its first row on.
    fn determinant(&mut self, matrix: &[Value], size: usize) -> Value {
        if size == 1 {
            return matrix[0];
        }
        let mut sum = None;
        for row in 0..size {
            let minor = self.minor(matrix, size, [0, row]);
            let term = self.builder.binary(Binary::FMul, matrix[row], minor);
            sum = Some(match sum {
                None => term,
                Some(sum) if row % 2 == 1 => self.builder.binary(Binary::FSub, sum, term),
                Some(sum) => self.builder.binary(Binary::FAdd, sum, term),
            });
        }
        sum.unwrap_or(matrix[0])
    }

    /// The determinant without a column and a row.
    fn minor(&mut self, matrix: &[Value], size: usize, [column, row]: [usize; 2]) -> Value {
        let kept = matrix.iter().enumerate();
        let kept = kept.filter(|(at, _)| at / size != column && at % size != row);
        let kept: Vec<_> = kept.map(|(_, &value)| value).collect();
        self.determinant(&kept, size - 1)
    }

    /// The cofactors, transposed, each divided by the determinant.
    fn inverse(&mut self, matrix: &[Value], size: usize) -> Vec<Value> {
        let determinant = self.determinant(matrix, size);
        let mut inverse = Vec::new();
        for at in 0..size * size {
            let (column, row) = (at / size, at % size);
            let minor = self.minor(matrix, size, [row, column]);
            let cofactor = if (column + row) % 2 == 1 {
                self.builder.unary(Unary::FNeg, minor)
            } else {
                minor
            };
            inverse.push(self.builder.binary(Binary::FDiv, cofactor, determinant));
        }
        inverse
    }
}
