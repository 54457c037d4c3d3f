//! The impedance of a soft constraint: MuJoCo.

use super::loading::LoadingSample;
use super::minimax::{fit, fit_rounds};
use super::{CardError, ExportError, Loading};

/// A contact of MuJoCo: `solref` in its direct form, −K and −B, and `solimp`.
///
/// With the impedance d(r), between 0 and 1, and masses whose sum of inverses is 1/M, a contact that alone resists the motion has the force
///
/// F = M d (b u̇ + k d u + a₀),  b = B/d_w,  k = K/d_w²,
///
/// d_w the impedance at the width and a₀ the approach without contact (MuJoCo, "Computation", sections "Constraint model" and
/// "Parameters"). Impedances of at most [`SoftConstraint::LARGEST`] make M d a₀ small, and the contact a spring and a damper: a body
/// between two jaws, whose contact forces balance, then has M d/(1 − d) in place of M d, which is what is fitted here; one contact alone has
/// less force by 1 − d.
///
/// The impedance goes from d_0 at first touch to d_w at the width by a curve of two powers that meet at the midpoint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SoftConstraint {
    /// K in 1/s², the first number of `solref` with the sign changed.
    pub stiffness: f64,
    /// B in 1/s, the second.
    pub damping: f64,
    /// Impedance at first touch, the first number of `solimp`.
    pub first: f64,
    /// Impedance at the width, the second.
    pub last: f64,
    /// Indentation at which it is reached, m, the third.
    pub width: f64,
    /// Where the two powers meet, as a share of the width, the fourth.
    pub midpoint: f64,
    /// The power, the fifth.
    pub power: f64,
    /// Mass of the body, kg; the jaw is much heavier.
    pub mass: f64,
    /// Its error in loading and hold.
    pub error: CardError,
}

/// What is searched: ln(d_0/d_w), midpoint, power, ln(width/indentation at the end).
type Curve = [f64; 4];

/// Ranges of what is searched; MuJoCo takes no impedance below 1e-4 and no power below 1.
const RANGES: [(f64, f64); 4] = [(-4.5, 4.5), (0.002, 0.998), (1.0, 6.0), (-3.0, 3.0)];

/// Values of each on the grid of the search.
const GRID: [usize; 4] = [9, 5, 5, 6];

/// Points of the grid from which the search goes on, and ends of it from which it goes on to the end: the error has many valleys.
const STARTS: usize = 60;
const BEST: usize = 10;

/// First steps of the search, and the shares of them at which it is broken off and at which it ends.
const STEPS: Curve = [0.4, 0.12, 0.6, 0.3];
const ROUGH: f64 = 0.12;
const ENOUGH: f64 = 2e-3;

/// Rounds of the fit that a curve is compared by, on the grid and in the search.
const FIRST_ROUNDS: usize = 3;
const ROUNDS: usize = 8;

impl SoftConstraint {
    /// Largest impedance of a fit.
    pub const LARGEST: f64 = 0.01;

    /// Fits the contact of a body of a mass (kg) to a loading, so that the largest error is least.
    ///
    /// # Errors
    /// [`ExportError::NoFit`] for forces that determine none; [`ExportError::Condition`] for a mass that is not above 0.
    pub fn fit(loading: &Loading, mass: f64) -> Result<Self, ExportError> {
        if !(mass.is_finite() && mass > 0.0) {
            return Err(ExportError::Condition {
                name: "mass",
                expected: "a finite number above 0",
                found: mass,
                unit: " kg",
            });
        }
        let engine = "MuJoCo";
        let curve = searched(loading).ok_or(ExportError::NoFit { engine })?;
        let rows = rows(loading, curve);
        let [spring, damper] = fit(&rows, [None, Some(0)]).ok_or(ExportError::NoFit { engine })?;
        let (first, last) = ends(curve);
        let mut found = Self {
            stiffness: spring / mass,
            damping: damper / mass,
            first,
            last,
            width: loading.indentation * curve[3].exp(),
            midpoint: curve[1],
            power: curve[2],
            mass,
            error: loading.error(|_, _| 0.0),
        };
        found.error = loading.error(|u, speed| found.force(u, speed));
        Ok(found)
    }

    /// The impedance at an indentation (m).
    #[must_use]
    pub fn impedance(&self, indentation: f64) -> f64 {
        self.first + way(indentation / self.width, self.midpoint, self.power) * (self.last - self.first)
    }

    /// Force (N) at an indentation (m) and its speed (m/s), of a body between two jaws.
    #[must_use]
    pub fn force(&self, indentation: f64, speed: f64) -> f64 {
        if indentation <= 0.0 {
            return 0.0;
        }
        let impedance = self.impedance(indentation);
        let [spring, damper] = functions(impedance, self.last, (indentation, speed));
        (self.mass * (self.stiffness * spring + self.damping * damper)).max(0.0)
    }
}

/// Impedances at first touch and at the width.
fn ends([log_ratio, ..]: Curve) -> (f64, f64) {
    let last = SoftConstraint::LARGEST * (-log_ratio).exp().min(1.0);
    (last * log_ratio.exp(), last)
}

/// Share of the way from the first impedance to the last, at a share of the width.
fn way(x: f64, midpoint: f64, power: f64) -> f64 {
    if x >= 1.0 {
        1.0
    } else if power == 1.0 {
        x
    } else if x <= midpoint {
        x.powf(power) / midpoint.powf(power - 1.0)
    } else {
        1.0 - (1.0 - x).powf(power) / (1.0 - midpoint).powf(power - 1.0)
    }
}

/// What K and B are multiplied by at an impedance, for a mass of 1 kg: d/(1 − d) times d/d_w² u, and d/(1 − d) times u̇/d_w.
fn functions(impedance: f64, last: f64, (u, speed): (f64, f64)) -> [f64; 2] {
    let share = impedance / last;
    [share * share * u / (1.0 - impedance), share * speed / (1.0 - impedance)]
}

fn rows(loading: &Loading, curve: Curve) -> Vec<([f64; 2], f64)> {
    let (first, last) = ends(curve);
    let width = loading.indentation * curve[3].exp();
    let row = |sample: &LoadingSample| {
        let impedance = first + way(sample.indentation / width, curve[1], curve[2]) * (last - first);
        (functions(impedance, last, (sample.indentation, sample.speed)), sample.force)
    };
    loading.fitted().map(row).collect()
}

/// Largest error of a curve with the best K and B after some rounds, N.
fn largest_error(loading: &Loading, curve: Curve, rounds: usize) -> f64 {
    fit_rounds(&rows(loading, curve), [None, Some(0)], rounds).map_or(f64::INFINITY, |(_, error)| error)
}

/// The curve whose largest error is least: a grid, then compass searches from its best points, the best of them to the end.
fn searched(loading: &Loading) -> Option<Curve> {
    let value = |axis: usize, index: usize| {
        let (low, high) = RANGES[axis];
        low + (high - low) * (index as f64 + 0.5) / GRID[axis] as f64
    };
    let start = |index: usize| {
        let mut left = index;
        let curve: Curve = core::array::from_fn(|axis| {
            let at = left % GRID[axis];
            left /= GRID[axis];
            value(axis, at)
        });
        (curve, largest_error(loading, curve, FIRST_ROUNDS))
    };
    let mut starts: Vec<(Curve, f64)> = (0..GRID.iter().product()).map(start).collect();
    starts.sort_by(|(_, a), (_, b)| a.total_cmp(b));
    let rough = starts.iter().take(STARTS).map(|(curve, _)| descended(loading, *curve, (1.0, ROUGH)));
    let mut rough: Vec<(Curve, f64)> = rough.collect();
    rough.sort_by(|(_, a), (_, b)| a.total_cmp(b));
    let ended = rough.iter().take(BEST).map(|(curve, _)| descended(loading, *curve, (ROUGH, ENOUGH)));
    let (best, error) = ended.min_by(|(_, a), (_, b)| a.total_cmp(b))?;
    error.is_finite().then_some(best)
}

/// A compass search from a curve, from one share of the first steps to another.
fn descended(loading: &Loading, start: Curve, (first, end): (f64, f64)) -> (Curve, f64) {
    let (mut here, mut least) = (start, largest_error(loading, start, ROUNDS));
    let mut share = first;
    while share > end {
        let mut has_moved = false;
        for (axis, sign) in (0..STEPS.len()).flat_map(|axis| [(axis, 1.0), (axis, -1.0)]) {
            let mut next = here;
            next[axis] = (here[axis] + sign * share * STEPS[axis]).clamp(RANGES[axis].0, RANGES[axis].1);
            let error = largest_error(loading, next, ROUNDS);
            if error < least {
                (here, least, has_moved) = (next, error, true);
            }
        }
        if !has_moved {
            share *= 0.5;
        }
    }
    (here, least)
}
