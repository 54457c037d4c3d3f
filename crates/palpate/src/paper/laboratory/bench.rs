//! One laboratory: readings, fits, conclusions.

use crate::contact::Specimen;
use crate::fit::{
    ExponentChoice, FitOptions, IntervalMethod, LatencyFit, LawOptions, NoiseChoice, OrderSelection, Samples, fit_law,
    fit_rates, select_order,
};
use crate::laws::Law;
use crate::random::{Rng, seed_of};
use crate::strain::{RateWindow, contact_strain, strain_rates};

use super::super::published::STEPS;
use super::super::{PaperError, Published};
use super::{Ball, LaboratoryOptions, ORDERS, Readings};

/// Points of a hold at which the strain rate is taken, evenly spaced in the logarithm of time.
const RATE_POINTS: usize = 100;

/// What one laboratory concludes by one method.
pub(super) struct Drawn {
    pub(super) conclusions: [bool; 3],
    /// Index of the order that it chose.
    pub(super) order: Option<usize>,
    /// v at each step of test (a), 1/s.
    pub(super) coefficients: [Option<f64>; STEPS],
}

/// A hold without errors of measurement.
struct CleanHold {
    level: usize,
    descending: bool,
    force: Vec<f64>,
}

/// A ball in the machine, read without errors.
pub(super) struct Bench<'a> {
    paper: &'a Published,
    specimen: Specimen,
    /// Share of the accuracy that a reading does not repeat.
    rest: f64,
    /// Times since the start of a hold, s.
    times: Vec<f64>,
    holds: Vec<CleanHold>,
}

impl<'a> Bench<'a> {
    pub(super) fn new(paper: &'a Published, ball: Ball, options: &LaboratoryOptions) -> Result<Self, PaperError> {
        let rate = options.sample_rate;
        let times: Vec<f64> = (0..=(paper.hold * rate).floor() as usize).map(|i| i as f64 / rate).collect();
        let mut holds = Vec::with_capacity(2 * STEPS);
        for descending in [false, true] {
            let motion = if descending { paper.test_b()? } else { paper.test_a()? };
            for (start, level) in paper.holds(descending) {
                // Rounding may put the last sample of a hold behind its end.
                let at: Vec<f64> = times.iter().map(|time| start + time.min(paper.hold * (1.0 - 1e-12))).collect();
                holds.push(CleanHold {
                    level,
                    descending,
                    force: ball.forces(paper, &motion, descending, &at)?,
                });
            }
        }
        Ok(Self {
            paper,
            specimen: paper.specimen()?,
            rest: options.repeatability / paper.force_accuracy,
            times,
            holds,
        })
    }

    /// What the laboratory with this seed concludes by both methods.
    pub(super) fn measured(&self, readings: Readings, seed: u64) -> [Drawn; 2] {
        let mut random = Rng::new(seed_of(0x7a_b1e, seed));
        let mut drawn = || 2.0 * random.uniform() - 1.0;
        // Of force and displacement, in shares of the accuracy: one error for each of the two tests, and the part that every reading draws.
        let (shared, own) = match readings {
            Readings::Independent => ([[0.0; 2]; 2], 1.0),
            Readings::Repeatable => ([0, 1].map(|_| [drawn(), drawn()]), self.rest),
        };
        let fits: Vec<[Vec<LatencyFit>; 2]> = self
            .holds
            .iter()
            .map(|hold| self.fitted(hold, |quantity| shared[usize::from(hold.descending)][quantity] + own * drawn()))
            .collect();
        [0, 1].map(|method| self.concluded(&fits.iter().map(|both| &both[method]).collect::<Vec<_>>()))
    }

    /// One hold read with errors and fitted with every order, by rates and over time; an order that cannot be fitted is left out.
    ///
    /// `off` draws the error of a reading of the force (0) or the displacement (1), in shares of the accuracy.
    fn fitted(&self, hold: &CleanHold, mut off: impl FnMut(usize) -> f64) -> [Vec<LatencyFit>; 2] {
        let level = self.paper.levels[hold.level];
        let strains: Vec<f64> = hold
            .force
            .iter()
            .map(|force| {
                let force = force + self.paper.force_accuracy * off(0);
                let displacement = level + self.paper.displacement_accuracy * off(1);
                contact_strain(force, displacement, &self.specimen).unwrap_or(0.0)
            })
            .collect();
        // The errors of the readings are independent, and no interval of a fit is looked at.
        let options = LawOptions {
            intervals: IntervalMethod::Curvature,
            noise: NoiseChoice::White,
            ..LawOptions::default()
        };
        let samples = Samples::new(&self.times, &strains);
        let over_time = |choice| {
            let fit = fit_law(&samples, Law::Latency { exponent: choice }, &options);
            fit.ok().and_then(LatencyFit::new)
        };
        let window = RateWindow {
            most_points: RATE_POINTS,
            ..RateWindow::default()
        };
        let rates = strain_rates(&self.times, &strains, &window);
        // Before, a window of as many samples is wider than a share of the time, and flattens the start of the relaxation.
        let interval = self.times[1] - self.times[0];
        let first = rates.time.partition_point(|time| *time * window.share < window.samples as f64 * interval);
        let by_rates =
            |choice| fit_rates(&rates.strain[first..], &rates.rate[first..], choice, &FitOptions::default()).ok();
        let fits = |fit: &dyn Fn(ExponentChoice) -> Option<LatencyFit>| {
            ORDERS.iter().filter_map(|n| fit(ExponentChoice::Fixed(*n))).collect()
        };
        [fits(&by_rates), fits(&over_time)]
    }

    fn concluded(&self, fits: &[&Vec<LatencyFit>]) -> Drawn {
        let order = self.order(fits);
        let five = |descending: bool, level: usize| {
            let index = self.holds.iter().position(|hold| hold.descending == descending && hold.level == level)?;
            fits[index].iter().find(|fit| fit.exponent().value == 5.0)
        };
        let loaded: [Option<f64>; STEPS] =
            std::array::from_fn(|step| five(false, step).map(|fit| fit.rate_coefficient().value));
        let falling = loaded.windows(2).all(|pair| matches!(pair, [Some(a), Some(b)] if b < a));
        let equal = (0..STEPS - 1).all(|level| {
            let both = five(false, level).zip(five(true, level));
            let u = self.specimen.contact_displacement(self.paper.levels[level]);
            both.is_some_and(|(a, b)| {
                let off = (a.equilibrium().value - b.equilibrium().value).abs();
                off <= self.paper.accuracy_in_strain(&self.specimen, u)
            })
        });
        Drawn {
            conclusions: [order.is_some_and(|order| ORDERS[order] == 5.0), falling, equal],
            order,
            coefficients: loaded,
        }
    }

    /// The lowest order whose summed criterion is within 2 of the lowest; only orders that fit every hold count.
    fn order(&self, fits: &[&Vec<LatencyFit>]) -> Option<usize> {
        let selections: Vec<_> = fits.iter().map(|fits| select_order(fits)).collect();
        let sum = |n: f64| -> Option<f64> {
            let of_hold = |selection: &OrderSelection| {
                selection.candidates.iter().find(|candidate| candidate.exponent == n).map(|found| found.delta_bic)
            };
            selections.iter().map(of_hold).sum()
        };
        let sums = ORDERS.map(sum);
        let lowest = sums.iter().flatten().copied().fold(f64::INFINITY, f64::min);
        sums.iter().position(|sum| sum.is_some_and(|sum| sum <= lowest + 2.0))
    }
}
