//! The early rise of the force in a first ramp, whatever relaxes in it, and where it begins.

use super::estimators::{Approach, FEWEST, residuals};
use super::loading_curve::Touch;
use crate::contact::Specimen;
use crate::statistics::{dot, effective_count, lag_one_correlation};

/// Where the early rise begins.
///
/// With s = d − d₀ the travel since first touch and g the equilibrium force of the body, a body whose relaxation is smooth at first has
///
/// ```text
/// F(s) = F₀ + A g(s) (1 + b s)
/// ```
///
/// in the first part of a ramp at constant speed. Half of the travel in contact is fitted, and half of that; where these find different
/// touches, the body relaxes too fast for this curve, and shorter parts are tried. The error is that of the shorter part with the change from
/// there, since what the curve lacks grows with the travel.
pub(super) struct EarlyRise {
    /// Displacement of first touch, m.
    pub(super) displacement: f64,
    /// Its standard error with that of the model, m.
    pub(super) error: f64,
    part: Part,
}

/// The part of a ramp up to some travel with the rest before it, and its least-squares curve.
struct Part {
    /// Samples of the ramp.
    end: usize,
    travel: Vec<f64>,
    force: Vec<f64>,
    /// d₀ and its standard error by the scatter, m.
    touch: f64,
    error: f64,
    /// Sum of squared residuals, and their variance where each counts as independent, N².
    square: f64,
    variance: f64,
}

/// Shares of the travel in contact that are fitted, the longest first; half of each judges its curve.
const SHARES: [f64; 3] = [0.5, 0.25, 0.125];
/// Combined standard errors by which the two may differ.
const AGREE: f64 = 2.0;
/// Samples of a part, at most.
const MOST: usize = 400;

impl EarlyRise {
    /// `None` where the force does not rise, does so within too few samples, or the body relaxes too fast.
    pub(super) fn of(approach: &Approach, body: Option<&Specimen>) -> Option<Self> {
        let (beyond, crossed) = approach.threshold()?;
        let last = approach.displacement[approach.displacement.len() - 1];
        let part_of = |share: f64| {
            let until = crossed + share * (last - crossed);
            let end = approach.displacement.iter().rposition(|d| *d <= until)? + 1;
            if end < beyond + FEWEST { None } else { Part::of(approach, body, end) }
        };
        SHARES.into_iter().find_map(|share| {
            let (short, part) = (part_of(0.5 * share)?, part_of(share)?);
            let change = part.touch - short.touch;
            (change.abs() <= AGREE * part.error.hypot(short.error)).then_some(Self {
                displacement: part.touch,
                error: short.error.max(part.error).hypot(change),
                part,
            })
        })
    }

    /// The standard error of the touch that Hertz's rule gives, `place` (m), in a record without a hold: the error of that curve, or that of the
    /// early rise with the distance from there, each as likely as it makes the early rise.
    pub(super) fn error_of_hertz(&self, approach: &Approach, place: f64) -> f64 {
        let apart = self.error.hypot(place - self.displacement);
        let Some(hertz) = Part::of_hertz(approach, self.part.end) else {
            return apart;
        };
        let share = self.part.share_over(hertz.square);
        ((1.0 - share) * hertz.error.hypot(place - hertz.touch).powi(2) + share * apart.powi(2)).sqrt()
    }

    /// The touch that a curve of the whole ramp and the early rise give together, each weighted by how likely it makes the early rise.
    pub(super) fn with(&self, mut touch: Touch, curve: impl Fn(f64) -> f64) -> Touch {
        let Part {
            travel, force, square, ..
        } = &self.part;
        let pairs = travel.iter().zip(force);
        let of_curve: f64 = pairs.map(|(d, force)| (force - curve(*d)).powi(2)).sum();
        if of_curve <= *square {
            return touch;
        }
        let share = self.part.share_over(of_curve);
        let mean = touch.displacement + share * (self.displacement - touch.displacement);
        let second = |place: f64, error: f64| error * error + (place - mean).powi(2);
        let own = second(touch.displacement, touch.error);
        touch.error = ((1.0 - share) * own + share * second(self.displacement, self.error)).sqrt();
        touch.displacement = mean;
        touch
    }
}

impl Part {
    /// How likely this part is beside a curve with one number less that leaves that sum of squares, by the Bayesian information criterion.
    fn share_over(&self, square: f64) -> f64 {
        let odds = 0.5 * ((square - self.square) / self.variance - (self.travel.len() as f64).ln());
        1.0 / (1.0 + (-odds).exp())
    }

    /// The ramp up to sample `end`, with as much rest before it, under the curve of a body that relaxes.
    fn of(approach: &Approach, body: Option<&Specimen>, end: usize) -> Option<Self> {
        let unit = |s: f64| body.map_or(1.0, |body| body.stiffness(body.contact_displacement(s)).0) * s;
        Self::under(approach, end, |touch, x| {
            let rise = if x > touch { unit(x - touch) } else { 0.0 };
            [1.0, rise, rise * (x - touch)]
        })
    }

    /// The same under Hertz's curve, of a body that does not relax.
    fn of_hertz(approach: &Approach, end: usize) -> Option<Self> {
        Self::under(approach, end, |touch, x| [1.0, approach.hertz_rise(x, touch), 0.0])
    }

    /// The same under a combination of columns of touch and travel.
    fn under(approach: &Approach, end: usize, columns: impl Fn(f64, f64) -> [f64; 3]) -> Option<Self> {
        let (travel, force) = approach.up_to(end, MOST);
        let residuals = |touch: f64| residuals(&travel, &force, |x| columns(touch, x));
        let square = |touch: f64| residuals(touch).map(|residuals| dot(&residuals, &residuals));
        let touch = approach.best(&travel, &square)?;
        let left = residuals(touch)?;
        let least = dot(&left, &left);
        let count = travel.len();
        // Residuals that go together count less.
        let freedom = effective_count(count, lag_one_correlation(&left)) - 4.0;
        if freedom <= 0.0 {
            return None;
        }
        let variance = (least / freedom).max((1e-9 * approach.rise).powi(2));
        // Where the sum of squares has grown by one variance.
        let reach = travel[count - 1] - travel[0];
        let side = |sign: f64| {
            let grown = |by: f64| square(touch + sign * by).is_none_or(|square| square > least + variance);
            let (mut low, mut high) = (0.0, 1e-6 * reach);
            while !grown(high) && high < reach {
                (low, high) = (high, 2.0 * high);
            }
            for _ in 0..12 {
                let middle = 0.5 * (low + high);
                if grown(middle) { high = middle } else { low = middle }
            }
            high
        };
        let error = 0.5 * (side(-1.0) + side(1.0));
        Some(Self {
            end,
            touch,
            error,
            square: least,
            variance,
            travel,
            force,
        })
    }
}
