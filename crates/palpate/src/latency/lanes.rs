//! The law, lane by lane: functions without branches for kernels over many contacts or layers.

use crate::vector::elementary::{exp, ln};

/// Excess strains below this count as none in a power of whole n: their fifth power is not a normal double, which
/// processors multiply a hundred times more slowly, and moves nothing.
const NEGLIGIBLE: f64 = 1e-60;

/// Which power a group of lanes needs: one that all share, or one each.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Power {
    One,
    Two,
    Three,
    Five,
    Any,
}

impl Power {
    /// The cheapest that serves all exponents.
    pub(crate) fn of(exponents: &[f64]) -> Self {
        let all = |n: f64| exponents.iter().all(|found| *found == n);
        match () {
            () if all(1.0) => Self::One,
            () if all(2.0) => Self::Two,
            () if all(3.0) => Self::Three,
            () if all(5.0) => Self::Five,
            () => Self::Any,
        }
    }
}

/// Runs a loop over lanes with the power of a group as a constant, so that the choice stands outside the loop.
macro_rules! by_power {
    ($power:expr, $name:ident => $lanes:expr) => {
        match $power {
            Power::One => {
                let $name = Power::One;
                $lanes
            }
            Power::Two => {
                let $name = Power::Two;
                $lanes
            }
            Power::Three => {
                let $name = Power::Three;
                $lanes
            }
            Power::Five => {
                let $name = Power::Five;
                $lanes
            }
            Power::Any => {
                let $name = Power::Any;
                $lanes
            }
        }
    };
}

pub(crate) use by_power;

/// Numbers that become one vector, or two.
pub(crate) const BLOCK: usize = 8;

/// One block of a column, by value: what the compiler knows not to overlap, it turns into vectors.
#[inline(always)]
pub(crate) fn block(column: &[f64], at: usize) -> [f64; BLOCK] {
    let mut copy = [0.0; BLOCK];
    copy.copy_from_slice(&column[at..at + BLOCK]);
    copy
}

/// `f` of every lane of a block.
#[inline(always)]
pub(crate) fn each(f: impl Fn(usize) -> f64) -> [f64; BLOCK] {
    let mut out = [0.0; BLOCK];
    for (lane, out) in out.iter_mut().enumerate() {
        *out = f(lane);
    }
    out
}

/// Excess strains below this move nothing: not only their fifth powers are normal doubles, but the squares of errors made of them.
const STILL: f64 = 1e-30;

/// sgn(x)|x|ⁿ; `rest` is where the law is made linear (0: nowhere).
#[inline(always)]
pub(crate) fn signed_power(power: Power, x: f64, n: f64, rest: f64) -> f64 {
    let x = if x.abs() < STILL { 0.0 } else { x };
    match power {
        Power::One => x,
        Power::Two => x * x.abs(),
        Power::Three => x * x * x,
        Power::Five => (x * x) * (x * x) * x,
        Power::Any => {
            let size = x.abs();
            let base = if size < rest { rest } else { size };
            let base = if base < NEGLIGIBLE { NEGLIGIBLE } else { base };
            let value = exp(n * ln(base));
            let value = if size < rest { value * (size / rest) } else { value };
            let value = if size == 0.0 { 0.0 } else { value };
            if x < 0.0 { -value } else { value }
        }
    }
}
