//! Shifts at the SIMD levels: by one distance, or by one for each lane.

use super::packets::{map, map2, splat};
use super::state::{Operand, Words};
use super::wide::Wide;
use crate::op::Binary;
use estampe_simd::{Bytes, Lanes, i32x16};

impl<S: Lanes> Wide<S> {
    #[inline(always)]
    pub(super) fn shift(self, kind: Binary, to: Words<'_>, pair: [Operand<'_>; 2]) {
        let s = self.0;
        // One distance for all lanes is an instruction at every SIMD level.
        if let [Operand::Many(a), Operand::One(by)] = pair {
            let by = by & 31;
            return match kind {
                Binary::Shl => map(
                    s,
                    to,
                    a,
                    #[inline(always)]
                    |a| a << by,
                ),
                Binary::UShr => map(
                    s,
                    to,
                    a,
                    #[inline(always)]
                    |a| a >> by,
                ),
                _ => map(
                    s,
                    to,
                    a,
                    #[inline(always)]
                    |a| {
                        let a: i32x16<S> = a.bitcast();
                        (a >> by).bitcast()
                    },
                ),
            };
        }
        match kind {
            Binary::Shl => map2(
                s,
                to,
                pair,
                #[inline(always)]
                |a, b| a << (b & splat(s, 31)),
            ),
            Binary::UShr => map2(
                s,
                to,
                pair,
                #[inline(always)]
                |a, b| a >> (b & splat(s, 31)),
            ),
            _ => map2(
                s,
                to,
                pair,
                #[inline(always)]
                |a, b| {
                    let (a, b): (i32x16<S>, i32x16<S>) =
                        (a.bitcast(), (b & splat(s, 31)).bitcast());
                    (a >> b).bitcast()
                },
            ),
        }
    }
}
