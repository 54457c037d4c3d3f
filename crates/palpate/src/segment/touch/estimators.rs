//! First touch by rules that know no law: each looks at the force over the travel of the first ramp.

use std::ops::Range;

use serde::{Deserialize, Serialize};

use super::loading_curve::solved;
use crate::contact::Specimen;
use crate::statistics::{dot, median, noise};

/// Rule for first touch from the force over the travel of the first ramp.
///
/// None is best for every record: a threshold is late by the noise, a line is late on a force that grows like a power, and a
/// power misses a body that relaxes. Their spread says how much first touch hangs on the rule (compared for atomic force
/// microscopy by Lin, Dimitriadis and Horkay, J. Biomech. Eng. 129, 2007, and by Gavara, Sci. Rep. 6, 2016).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TouchMethod {
    /// Where the loading curve of a body under the latency law begins, with the law of the hold behind the ramp.
    LoadingCurve,
    /// Where the force leaves its baseline by five standard deviations of its noise, and stays beyond.
    Threshold,
    /// Where two straight lines through the first third of the rise meet, by least squares.
    TwoLines,
    /// Where Hertz's F₀ + k (d − d₀)^p begins (with a sloping F₀ where that is the likelier), by least squares over the
    /// first third of the rise; p is 3/2, that of the tip of an indenter, or 1 for a constant section.
    Hertz,
    /// Where the variance of the force right behind, over that right before, is largest.
    VarianceRatio,
}

impl TouchMethod {
    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::LoadingCurve => "loading curve",
            Self::Threshold => "threshold",
            Self::TwoLines => "two lines",
            Self::Hertz => "hertz",
            Self::VarianceRatio => "ratio of variances",
        }
    }
}

/// Estimate of one rule.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct TouchEstimate {
    /// The rule.
    pub method: TouchMethod,
    /// Displacement of first touch, m.
    pub displacement: f64,
}

/// The force over the travel of the first ramp.
pub(super) struct Approach {
    /// Rising, m.
    pub(super) displacement: Vec<f64>,
    pub(super) force: Vec<f64>,
    /// Force before the ramp, N.
    rest: Vec<f64>,
    /// Force without contact, its noise, and the rise above it, N.
    base: f64,
    noise: f64,
    pub(super) rise: f64,
    /// p of Hertz's law.
    power: f64,
}

/// Samples of a ramp that are fitted, at most.
const MOST: usize = 400;
/// Standard deviations beyond which a force is no noise.
const BEYOND: f64 = 5.0;
/// Share of the rise up to which curves are fitted.
const FIRST: f64 = 0.3;
/// Fewest samples that a curve is fitted to.
pub(super) const FEWEST: usize = 8;

impl Approach {
    /// The samples `ramp` (its foot first), and the force in `rest` before them. `None` for too few, or without a rise.
    pub(super) fn of(
        displacement: &[f64],
        force: &[f64],
        rest: Range<usize>,
        ramp: Range<usize>,
        body: Option<&Specimen>,
    ) -> Option<Self> {
        if ramp.len() < FEWEST {
            return None;
        }
        let rest = force[rest].to_vec();
        let (displacement, force) = (displacement[ramp.clone()].to_vec(), force[ramp].to_vec());
        // Without a rest the first samples of the ramp are the baseline.
        let first = if rest.len() >= 5 { rest.clone() } else { force[..(force.len() / 20).max(3)].to_vec() };
        let base = median(&mut first.clone());
        let deviation = if rest.len() >= 20 { noise(&rest) } else { noise(&force) };
        let rise = force.iter().fold(f64::MIN, |most, f| most.max(*f)) - base;
        let noise = deviation.max(1e-3 * rise / BEYOND);
        (rise > 2.0 * BEYOND * noise).then_some(Self {
            displacement,
            force,
            rest,
            base,
            noise,
            rise,
            power: body.and_then(Specimen::hertz_power).unwrap_or(1.5),
        })
    }

    /// What a rule says; `None` where it finds nothing. The loading curve is not one of them.
    pub(super) fn estimate(&self, method: TouchMethod) -> Option<TouchEstimate> {
        let displacement = match method {
            TouchMethod::LoadingCurve => None,
            TouchMethod::Threshold => self.threshold().map(|(_, displacement)| displacement),
            TouchMethod::TwoLines => self.two_lines(),
            TouchMethod::Hertz => self.hertz(),
            TouchMethod::VarianceRatio => self.variance_ratio(),
        }?;
        Some(TouchEstimate { method, displacement })
    }

    /// First sample beyond the noise for good, and where the force crosses the threshold before it.
    pub(super) fn threshold(&self) -> Option<(usize, f64)> {
        let level = self.base + BEYOND * self.noise;
        let index = self.force.windows(3).position(|three| three.iter().all(|force| *force > level))?;
        let Some(before) = index.checked_sub(1) else {
            return Some((0, self.displacement[0]));
        };
        let (f0, f1) = (self.force[before], self.force[index]);
        let share = ((level - f0) / (f1 - f0)).clamp(0.0, 1.0);
        Some((index, self.displacement[before] + share * (self.displacement[index] - self.displacement[before])))
    }

    /// Travel and force up to a third of the rise, with as much rest before it.
    fn start(&self) -> Option<(Vec<f64>, Vec<f64>)> {
        let (beyond, _) = self.threshold()?;
        let third = self.force.iter().position(|force| *force > self.base + FIRST * self.rise)?;
        Some(self.up_to(third.max(beyond + FEWEST).min(self.force.len()), MOST))
    }

    /// Travel and force up to sample `end` of the ramp, at most `most`, with as much rest before it.
    pub(super) fn up_to(&self, end: usize, most: usize) -> (Vec<f64>, Vec<f64>) {
        let every = end.div_ceil(most);
        let ramp = (0..end).step_by(every);
        let rest = self.rest.iter().rev().step_by(every).take(end.div_ceil(every));
        let travel = rest.clone().map(|_| self.displacement[0]).chain(ramp.clone().map(|i| self.displacement[i]));
        let force = rest.copied().chain(ramp.map(|i| self.force[i]));
        (travel.collect(), force.collect())
    }

    fn two_lines(&self) -> Option<f64> {
        let (travel, force) = self.start()?;
        self.best(&travel, &|touch| fitted(&travel, &force, |x| [1.0, (x - touch).min(0.0), (x - touch).max(0.0)]))
    }

    /// Hertz's force of a touch at travel x, but for its factor.
    pub(super) fn hertz_rise(&self, x: f64, touch: f64) -> f64 {
        if x > touch { (x - touch).powf(self.power) } else { 0.0 }
    }

    /// With a level baseline, or a sloping one if that lowers the Bayesian information criterion.
    fn hertz(&self) -> Option<f64> {
        let (travel, force) = self.start()?;
        let from = travel[0];
        let level = |touch: f64| fitted(&travel, &force, |x| [1.0, self.hertz_rise(x, touch), 0.0]);
        let sloping = |touch: f64| fitted(&travel, &force, |x| [1.0, self.hertz_rise(x, touch), x - from]);
        let flat = self.best(&travel, &level)?;
        let Some(tilted) = self.best(&travel, &sloping) else {
            return Some(flat);
        };
        let gain = force.len() as f64 * (level(flat)? / sloping(tilted)?).ln();
        Some(if gain > (force.len() as f64).ln() { tilted } else { flat })
    }

    /// The touch with the smallest sum of squares: on a grid, then by golden section.
    pub(super) fn best(&self, travel: &[f64], square: &dyn Fn(f64) -> Option<f64>) -> Option<f64> {
        const GRID: u32 = 100;
        const SHARE: f64 = 0.381_966;
        let (low, high) = (travel[0], travel[travel.len() - 1]);
        let square = |touch: f64| square(touch).unwrap_or(f64::INFINITY);
        let place = |i: u32| low + (high - low) * f64::from(i) / f64::from(GRID);
        let best = (0..GRID).min_by(|a, b| square(place(*a)).total_cmp(&square(place(*b))))?;
        let (mut a, mut b) = (place(best.saturating_sub(1)), place(best + 1));
        for _ in 0..30 {
            let (c, d) = (a + SHARE * (b - a), b - SHARE * (b - a));
            if square(c) < square(d) { b = d } else { a = c }
        }
        let touch = 0.5 * (a + b);
        square(touch).is_finite().then_some(touch)
    }

    fn variance_ratio(&self) -> Option<f64> {
        let window = (self.force.len() / 10).clamp(4, 50);
        let rest = self.rest.len().min(window);
        let force: Vec<f64> = self.rest[self.rest.len() - rest..].iter().chain(&self.force).copied().collect();
        let variance = |values: &[f64]| {
            let mean = values.iter().sum::<f64>() / values.len() as f64;
            values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / values.len() as f64
        };
        // A baseline without noise must not make any ratio endless.
        let least = (0.1 * self.noise).powi(2);
        let ratio = |i: &usize| variance(&force[*i..i + window]) / (variance(&force[i - window..*i]) + least);
        let best = (window..(force.len() + 1).saturating_sub(window)).max_by(|a, b| ratio(a).total_cmp(&ratio(b)))?;
        Some(self.displacement[best.saturating_sub(rest + 1)])
    }
}

/// Residuals of the least-squares combination of three columns of x, the last of which may be none.
pub(super) fn residuals(travel: &[f64], force: &[f64], columns: impl Fn(f64) -> [f64; 3]) -> Option<Vec<f64>> {
    let rows: Vec<[f64; 3]> = travel.iter().map(|x| columns(*x)).collect();
    let mut normal = [[0.0; 3]; 3];
    let mut right = [0.0; 3];
    for ([a, b, c], y) in rows.iter().zip(force) {
        let products = [[a * a, a * b, a * c], [b * a, b * b, b * c], [c * a, c * b, c * c]];
        for (entries, products) in normal.iter_mut().zip(products) {
            entries.iter_mut().zip(products).for_each(|(entry, product)| *entry += product);
        }
        right.iter_mut().zip([a, b, c]).for_each(|(sum, own)| *sum += own * y);
    }
    if normal[2][2] == 0.0 {
        normal[2][2] = 1.0;
    }
    let [k, l, m] = solved(normal, right)?;
    Some(rows.iter().zip(force).map(|([a, b, c], y)| y - (a * k + b * l + c * m)).collect())
}

/// Sum of squared residuals of the least-squares combination of such columns.
fn fitted(travel: &[f64], force: &[f64], columns: impl Fn(f64) -> [f64; 3]) -> Option<f64> {
    residuals(travel, force, columns).map(|residuals| dot(&residuals, &residuals))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::{Base, Shape, Sides, ThinLayer, Tip};
    use crate::random::Rng;

    /// A ramp of 2 mm that meets the body at 0.8 mm; force `law`(d − d₀ in mm) in N.
    fn approach(law: impl Fn(f64) -> f64, noise: f64, tilt: f64, seed: u64) -> Approach {
        approach_of(law, noise, tilt, seed, None)
    }

    fn approach_of(law: impl Fn(f64) -> f64, noise: f64, tilt: f64, seed: u64, body: Option<&Specimen>) -> Approach {
        let mut random = Rng::new(seed);
        let travel = |i: u32| 2e-3 * f64::from(i.saturating_sub(100)) / 400.0;
        let displacement: Vec<f64> = (0..500).map(travel).collect();
        let force: Vec<f64> = displacement
            .iter()
            .map(|d| 0.2 + tilt * 1e3 * d + law((1e3 * d - 0.8).max(0.0)) + noise * random.normal())
            .collect();
        Approach::of(&displacement, &force, 0..99, 99..500, body).unwrap()
    }

    #[track_caller]
    fn within(approach: &Approach, method: TouchMethod, early: f64, late: f64) {
        let found = 1e3 * approach.estimate(method).unwrap().displacement - 0.8;
        assert!((-early..=late).contains(&found), "{method:?}: {found} mm");
    }

    #[test]
    fn each_rule_is_right_on_its_own_curve() {
        for seed in 0..5 {
            let line = approach(|s| 3.0 * s, 0.01, 0.0, seed);
            within(&line, TouchMethod::TwoLines, 0.02, 0.02);
            within(&line, TouchMethod::Threshold, 0.005, 0.05);
            within(&line, TouchMethod::VarianceRatio, 0.05, 0.05);
            let hertz = approach(|s| 3.0 * s.powf(1.5), 0.01, 0.0, seed);
            within(&hertz, TouchMethod::Hertz, 0.03, 0.03);
            within(&hertz, TouchMethod::Threshold, 0.0, 0.12);
        }
    }

    /// Without the tip the power is 3/2, and first touch of a parabola comes late.
    #[test]
    fn the_power_is_that_of_the_tip() {
        let layer = Some(ThinLayer {
            thickness: 1.0,
            base: Base::Bonded,
        });
        let tip = Tip::Cone { half_angle: 0.6 };
        let cone = Specimen::new(Shape::Indenter { tip, layer }, 1.0, Sides::One).unwrap();
        let parabola = |body| approach_of(|s| 3.0 * s * s, 0.0, 0.0, 1, body);
        within(&parabola(Some(&cone)), TouchMethod::Hertz, 1e-4, 1e-4);
        assert!(parabola(None).estimate(TouchMethod::Hertz).unwrap().displacement > 0.82e-3);
    }

    #[test]
    fn a_sloping_baseline_is_observed_by_curves() {
        for seed in 0..5 {
            let line = approach(|s| 3.0 * s, 0.01, 0.05, seed);
            within(&line, TouchMethod::TwoLines, 0.02, 0.02);
            let hertz = approach(|s| 3.0 * s.powf(1.5), 0.01, 0.05, seed);
            within(&hertz, TouchMethod::Hertz, 0.05, 0.05);
        }
    }

    #[test]
    fn lines_are_late_on_a_power_and_without_noise_all_is_well() {
        let hertz = approach(|s| 3.0 * s.powf(1.5), 0.0, 0.0, 1);
        within(&hertz, TouchMethod::Hertz, 1e-4, 1e-4);
        let late = hertz.estimate(TouchMethod::TwoLines).unwrap().displacement - 0.8e-3;
        assert!(late > 5e-6, "{late}");
        within(&hertz, TouchMethod::Threshold, 0.0, 0.03);
    }

    #[test]
    fn without_a_rise_there_is_no_touch() {
        let flat: Vec<f64> = (0..50).map(|i| f64::from(i * 7 % 5)).collect();
        let travel: Vec<f64> = (0..50).map(f64::from).collect();
        assert!(Approach::of(&travel, &flat, 0..10, 10..50, None).is_none());
        assert!(Approach::of(&travel, &travel, 0..1, 1..4, None).is_none());
    }
}
