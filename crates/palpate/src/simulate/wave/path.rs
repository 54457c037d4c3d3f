//! The way of one node through a stretch, between the ends of its steps.
//!
//! The integrator's own dense output is of no use here: where the fastest mode of the layers limits the steps, that mode has died out at their
//! ends and not within them. So the way is taken from values and slopes at the ends of several steps: Hermite's polynomial through the four
//! that are nearest, of degree seven.

use std::cell::RefCell;

/// Where the node is at the end of a step.
#[derive(Debug, Clone, Copy)]
pub(super) struct Knot {
    /// s from the start of the stretch.
    pub(super) time: f64,
    /// m
    pub(super) value: f64,
    /// m/s
    pub(super) slope: f64,
}

/// Displacement of a node over time.
#[derive(Debug)]
pub(super) struct Path {
    /// Where it is before it moves.
    before: f64,
    knots: Vec<Knot>,
    last: RefCell<Piece>,
}

/// Knots that a polynomial goes through.
const KNOTS: usize = 4;

/// The polynomial between two neighbouring knots, in Newton's form.
#[derive(Debug, Default)]
struct Piece {
    /// The first of the two; `None` before the first use.
    index: Option<usize>,
    /// Times of the knots, each of them twice.
    times: [f64; 2 * KNOTS],
    differences: [f64; 2 * KNOTS],
    terms: usize,
}

impl Path {
    /// Through two knots or more, or none of a node that stays.
    pub(super) fn new(before: f64, knots: Vec<Knot>) -> Self {
        Self {
            before,
            knots,
            last: RefCell::default(),
        }
    }

    /// Whether the node moves at all.
    pub(super) fn moves(&self) -> bool {
        !self.knots.is_empty()
    }

    /// Displacement at `time` (s from the start of the stretch), m.
    pub(super) fn at(&self, time: f64) -> f64 {
        if self.knots.first().is_none_or(|first| time < first.time) {
            return self.before;
        }
        let mut piece = self.last.borrow_mut();
        // Nearly always it is the piece of the last time or the one after.
        let mut index = piece.index.unwrap_or(0);
        while index > 0 && time < self.knots[index].time {
            index -= 1;
        }
        while index + 2 < self.knots.len() && time > self.knots[index + 1].time {
            index += 1;
        }
        if piece.index != Some(index) {
            *piece = Piece::new(&self.knots, index);
        }
        piece.at(time)
    }
}

impl Piece {
    fn new(knots: &[Knot], index: usize) -> Self {
        let count = knots.len().min(KNOTS);
        let from = index.saturating_sub(KNOTS / 2 - 1).min(knots.len() - count);
        let near = &knots[from..from + count];
        let (mut times, mut differences) = ([0.0; 2 * KNOTS], [0.0; 2 * KNOTS]);
        for (slot, knot) in near.iter().enumerate() {
            times[2 * slot..2 * slot + 2].fill(knot.time);
            differences[2 * slot..2 * slot + 2].fill(knot.value);
        }
        let terms = 2 * count;
        for order in 1..terms {
            for term in (order..terms).rev() {
                let run = times[term] - times[term - order];
                let rise = differences[term] - differences[term - 1];
                differences[term] = if run == 0.0 { near[term / 2].slope } else { rise / run };
            }
        }
        Self {
            index: Some(index),
            times,
            differences,
            terms,
        }
    }

    fn at(&self, time: f64) -> f64 {
        let terms = self.times[..self.terms].iter().zip(&self.differences[..self.terms]);
        terms.rev().fold(0.0, |sum, (knot, difference)| sum * (time - knot) + difference)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn path(times: &[f64], function: impl Fn(f64) -> (f64, f64)) -> Path {
        let knot = |&time: &f64| Knot {
            time,
            value: function(time).0,
            slope: function(time).1,
        };
        Path::new(0.25, times.iter().map(knot).collect())
    }

    #[test]
    fn polynomials_of_degree_seven_are_met_between_uneven_knots() {
        let times = [0.5, 0.6, 0.9, 1.0, 1.6, 1.7, 2.0];
        let seventh = path(&times, |t| ((t - 1.0).powi(7) + t, 7.0 * (t - 1.0).powi(6) + 1.0));
        // Back and forth, as the stages of steps ask.
        for i in [0, 3, 7, 2, 15, 9, 11, 14, 4, 15, 1] {
            let t = 0.5 + 0.1 * f64::from(i);
            let off = seventh.at(t) - ((t - 1.0).powi(7) + t);
            assert!(off.abs() < 1e-13, "t = {t}: {off:e}");
        }
        assert_eq!(seventh.at(0.4), 0.25);
        let cubic = path(&times[..2], |t| (t * t * t, 3.0 * t * t));
        assert!((cubic.at(0.57) - 0.57f64.powi(3)).abs() < 1e-15);
    }

    #[test]
    fn the_error_falls_with_the_eighth_power_of_the_step() {
        let error = |steps: i32| {
            let times: Vec<f64> = (0..=steps).map(|i| 3.0 * f64::from(i) / f64::from(steps)).collect();
            let sine = path(&times, |t| (t.sin(), t.cos()));
            (0..=3000).map(|i| 1e-3 * f64::from(i)).map(|t| (sine.at(t) - t.sin()).abs()).fold(0.0, f64::max)
        };
        let order = (error(6) / error(12)).log2();
        assert!((7.5..9.0).contains(&order), "{order}");
    }
}
