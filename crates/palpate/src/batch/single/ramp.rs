//! Ramps in single precision: times by quadrature, and the place at a time by Newton's method.
//!
//! In units of the steady excess, z = x/x*, and of time x*/|g| a ramp is dz/dτ = a(z) = 1 − sgn(z)|z|ⁿ, so that the time from one place to
//! another is an integral that no step depends on:
//!
//! τ = ∫ dz/a(z) = ∫ 2 s ds/a(±s²) = ∫ (1 − z)/a(z) dy,  z = ±s²,  y = −ln|1 − z|.
//!
//! The second form is smooth through z = 0, where |z|ⁿ is not, the third to the steady state, where a vanishes. The way is cut into
//! pieces that Gauss's rule of five points gives to a few 10⁻⁷: up to z = ¼, and from there on thirds of the distance to the steady
//! state; a reversal comes back in parts of 1.6. In the piece that holds the end, Newton's method finds it.

use crate::latency::lanes::{Power, by_power};
use crate::vector::single::{exp, exp_m1, ln, ln_1p, ln_of_sum};

/// Contacts that go through a ramp together: one vector of AVX-512, two of AVX2.
pub(super) const LANES: usize = 16;

/// A number for every lane.
pub(super) type Column = [f32; LANES];

/// Gauss's rule of five points on 0 … 1: place, weight, and 3^(−place).
const GAUSS: [(f32, f32, f32); 5] = [
    (0.046_910_077, 0.118_463_44, 0.949_769_5),
    (0.230_765_34, 0.239_314_34, 0.776_062_97),
    (0.5, 0.284_444_45, 0.577_350_3),
    (0.769_234_66, 0.239_314_34, 0.429_518_43),
    (0.953_089_9, 0.118_463_44, 0.350_962_37),
];

/// Where z = ±s² ends and y begins.
const BORDER: f32 = 0.25;

/// ln 3: how far y goes in a piece.
const PIECE: f32 = 1.098_612_3;

/// Below this excess a reversal comes back to 0 in one piece.
const LAST_BACK: f32 = 0.3;

/// What a piece leaves of a larger one.
const BACK: f32 = 0.625;

/// Distance from the steady state, times n, below which the law expanded to second order is exact to 10⁻⁷.
const NEAR: f32 = 0.015;

/// Excess, in units of the steady one, from which pieces would be too many.
pub(super) const FARTHEST: f32 = 1e6;

/// Pieces from there to the steady state are fewer.
const MOST_PIECES: usize = 48;

/// Iterations of Newton's method after a guess that is good to some per cent.
const ITERATIONS: usize = 2;

/// Where lanes are, in units of the steady excess.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    /// z, of use up to the border.
    pub(super) excess: Column,
    /// 1 − z, of use beyond it.
    pub(super) distance: Column,
}

/// What z of every lane gains in `time` (in units of x*/|g|) under laws of the exponents `n`; lanes without time gain nothing, and
/// lanes that are not numbers stay so.
#[inline(always)]
pub(super) fn gained(power: Power, n: &Column, place: Place, time: Column) -> Column {
    by_power!(power, power => gained_by(power, n, place, time))
}

#[inline(always)]
fn gained_by(power: Power, n: &Column, mut place: Place, mut left: Column) -> Column {
    let mut gain = [0.0; LANES];
    let (mut way, mut takes) = ([0.0; LANES], [0.0; LANES]);
    for _ in 0..MOST_PIECES {
        way = pieces(&place);
        takes = duration(
            power,
            n,
            &place,
            &way,
            #[inline(always)]
            |_, decay, _| decay,
        );
        let mut passed = 0;
        for lane in 0..LANES {
            let (z, d) = (place.excess[lane], place.distance[lane]);
            let passes = (left[lane] > 0.0) & (n[lane] * d.abs() > NEAR) & (takes[lane] <= left[lane]);
            let is_early = z < BORDER;
            let along = if is_early { way[lane] } else { d * (2.0 / 3.0) };
            let back = if z > -LAST_BACK { 0.0 } else { z * BACK };
            let early = if z < 0.0 { back } else { BORDER };
            let distance = if is_early { 1.0 - early } else { d * (1.0 / 3.0) };
            let excess = if is_early { early } else { 1.0 - distance };
            gain[lane] += if passes { along } else { 0.0 };
            left[lane] -= if passes { takes[lane] } else { 0.0 };
            place.excess[lane] = if passes { excess } else { z };
            place.distance[lane] = if passes { distance } else { d };
            passed += i32::from(passes);
        }
        if passed == 0 {
            break;
        }
    }
    let inside = found(power, n, &place, (&way, &takes), &left);
    for lane in 0..LANES {
        let d = place.distance[lane];
        let lost = exp_m1(-n[lane] * left[lane]);
        let half = 0.5 * (n[lane] - 1.0) * d;
        let settled = -d * lost * (1.0 - half) / (1.0 + half * lost);
        // Time left for a whole piece: the pieces were too many.
        let inside = if takes[lane] >= left[lane] { inside[lane] } else { f32::NAN };
        let last = if n[lane] * d.abs() > NEAR { inside } else { settled };
        gain[lane] += if left[lane] > 0.0 { last } else { 0.0 };
    }
    gain
}

/// How far the next piece goes: in z up to the border, in y beyond it.
#[inline(always)]
fn pieces(place: &Place) -> Column {
    let mut way = [0.0; LANES];
    for (way, &z) in way.iter_mut().zip(&place.excess) {
        let back = if z > -LAST_BACK { -z } else { z * (BACK - 1.0) };
        let early = if z < 0.0 { back } else { BORDER - z };
        *way = if z < BORDER { early } else { PIECE };
    }
    way
}

/// The time that a way from `place` takes; `decay` (lane, 3^(−c), c) is e^(−c way) at the part c of a way in y.
#[inline(always)]
fn duration(power: Power, n: &Column, place: &Place, way: &Column, decay: impl Fn(usize, f32, f32) -> f32) -> Column {
    let (mut root, mut rise, mut sum) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
    for lane in 0..LANES {
        let z = place.excess[lane];
        root[lane] = z.abs().sqrt();
        let both = root[lane] + (z + way[lane]).abs().sqrt();
        let both = if both > 1e-15 { both } else { 1e-15 };
        rise[lane] = if z < 0.0 { -way[lane] } else { way[lane] } / both;
    }
    for (part, weight, third) in GAUSS {
        for lane in 0..LANES {
            let z = place.excess[lane];
            let is_early = z < BORDER;
            let s = root[lane] + part * rise[lane];
            let square = if z < 0.0 { -s * s } else { s * s };
            let distance = place.distance[lane] * decay(lane, third, part);
            let distance = if is_early { 1.0 - square } else { distance };
            let above = if is_early { 2.0 * s } else { distance };
            sum[lane] += weight * (above / rate(power, is_early, square, distance, n[lane]));
        }
    }
    for lane in 0..LANES {
        let length = if place.excess[lane] < BORDER { rise[lane].abs() } else { way[lane] };
        sum[lane] *= length;
    }
    sum
}

/// dz/dτ = 1 − sgn(z)|z|ⁿ, from z if `is_early` and else from `distance` = 1 − z.
#[inline(always)]
fn rate(power: Power, is_early: bool, z: f32, distance: f32, n: f32) -> f32 {
    let z = if is_early { z } else { 1.0 - distance };
    let square = z * z;
    match power {
        Power::One => distance,
        Power::Two => {
            if z > 0.0 {
                distance * (1.0 + z)
            } else {
                1.0 + square
            }
        }
        Power::Three => distance * ((1.0 + z) + square),
        Power::Five => distance * ((1.0 + z) + square * ((1.0 + z) + square)),
        Power::Any => {
            let lost = if is_early { 0.0 } else { -distance - (z - 1.0) };
            let size = z.abs();
            let size = if size > 1e-30 { size } else { 1e-30 };
            let beyond = exp_m1(n * ln_of_sum(size, lost));
            if z > 0.0 { -beyond } else { 2.0 + beyond }
        }
    }
}

/// d way/dτ after a part `way` of a piece.
#[inline(always)]
fn speed(power: Power, n: f32, (z, d): (f32, f32), way: f32) -> f32 {
    let is_early = z < BORDER;
    let distance = if is_early { 1.0 - (z + way) } else { d * exp(-way) };
    let rate = rate(power, is_early, z + way, distance, n);
    if is_early { rate } else { rate / distance }
}

/// What z gains until `left` has passed, less than what the piece `takes`.
#[inline(always)]
fn found(power: Power, n: &Column, place: &Place, (piece, takes): (&Column, &Column), left: &Column) -> Column {
    let mut way = [0.0; LANES];
    for lane in 0..LANES {
        let here = (place.excess[lane], place.distance[lane]);
        // A rate that falls or rises exponentially along the way has the same speeds at both ends.
        let ratio = speed(power, n[lane], here, 0.0) / speed(power, n[lane], here, piece[lane]);
        let log = ln(if ratio > 1e-30 { ratio } else { 1e-30 });
        let part = left[lane] / takes[lane];
        let part = if part < 1.0 { part } else { 1.0 };
        let bent = ln_1p(part * (ratio - 1.0)) / log;
        let part = if log.abs() < 0.01 { part } else { bent };
        way[lane] = piece[lane] * part;
    }
    for _ in 0..ITERATIONS {
        let takes = duration(
            power,
            n,
            place,
            &way,
            #[inline(always)]
            |lane, _, part| exp(-part * way[lane]),
        );
        for lane in 0..LANES {
            let here = (place.excess[lane], place.distance[lane]);
            let better = way[lane] - (takes[lane] - left[lane]) * speed(power, n[lane], here, way[lane]);
            let better = if better > 0.0 { better } else { 0.0 };
            way[lane] = if better < piece[lane] { better } else { piece[lane] };
        }
    }
    let mut gain = [0.0; LANES];
    for lane in 0..LANES {
        let late = -place.distance[lane] * exp_m1(-way[lane]);
        gain[lane] = if place.excess[lane] < BORDER { way[lane] } else { late };
    }
    gain
}
