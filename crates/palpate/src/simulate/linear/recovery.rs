//! What fades while no force changes: the surface once the jaw has left it, and creep of a body of constant section.

use super::contact::LinearContact;
use super::law::LinearLaw;

/// A stress-free surface on its way back: q + Σ x_k = 0, so that q̇ = Σ λ_k x_k/(1 + Σ g_k); or one under a constant force, less where it
/// tends to.
///
/// The x_k then obey ẋ = A x with A = −Λ + g λᵀ/(1 + Σ g). Its rates μ are the retardation rates of the law, the roots of
///
/// ```text
/// Σ g_k λ_k/(λ_k − μ) = 1 + Σ g_k
/// ```
///
/// one below each λ_k (Gross 1953), with right and left vectors g_k/(λ_k − μ) and λ_k/(λ_k − μ).
#[derive(Debug, Clone)]
pub(super) struct Recovery {
    modes: Vec<Mode>,
}

#[derive(Debug, Clone)]
struct Mode {
    /// μ, 1/s.
    rate: f64,
    /// Part of every x_k that fades at this rate.
    parts: Vec<f64>,
    /// Their sum.
    sum: f64,
}

/// The rates and vectors of a law's recovery, whatever it starts from.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Modes {
    modes: Vec<FreeMode>,
}

#[derive(Debug, Clone, PartialEq)]
struct FreeMode {
    /// μ, 1/s.
    rate: f64,
    /// λ_k − μ, 1/s.
    gaps: Vec<f64>,
    /// Σ g_k λ_k/(λ_k − μ)².
    size: f64,
}

impl Modes {
    pub(super) fn new(law: &LinearLaw) -> Self {
        let terms = law.terms();
        let whole = 1.0 + law.overshoot();
        let mode = |index: usize| {
            // In the distance δ = λ_i − μ from the rate above, which keeps its digits where the two are close.
            let own = terms[index].rate;
            let gap = if index == 0 { own } else { own - terms[index - 1].rate };
            let off = |k: usize, delta: f64| (terms[k].rate - own) + delta;
            let excess_of_sum = |delta: f64| {
                let sum: f64 = (0..terms.len()).map(|k| terms[k].overshoot * terms[k].rate / off(k, delta)).sum();
                sum - whole
            };
            let delta = root(gap, excess_of_sum);
            let gaps: Vec<f64> = (0..terms.len()).map(|k| off(k, delta)).collect();
            let size = terms.iter().zip(&gaps).map(|(term, gap)| term.overshoot * term.rate / (gap * gap)).sum();
            FreeMode {
                rate: own - delta,
                gaps,
                size,
            }
        };
        Self {
            modes: (0..terms.len()).map(mode).collect(),
        }
    }

    /// How much of a mode there is in excess strains.
    fn amount(mode: &FreeMode, law: &LinearLaw, excess: &[f64]) -> f64 {
        let terms = law.terms().iter().zip(excess).zip(&mode.gaps);
        terms.map(|((term, x), gap)| term.rate * x / gap).sum::<f64>() / mode.size
    }

    /// Excess strains after some time (s) in which no force changes, without allocation: `excess` to `after`.
    pub(super) fn fade(&self, law: &LinearLaw, excess: &[f64], elapsed: f64, after: &mut [f64]) {
        after.fill(0.0);
        for mode in &self.modes {
            let left = Self::amount(mode, law, excess) * (-mode.rate * elapsed).exp();
            let parts = law.terms().iter().zip(&mode.gaps);
            after.iter_mut().zip(parts).for_each(|(x, (term, gap))| *x += left * term.overshoot / gap);
        }
    }
}

impl Recovery {
    /// From the excess strains at the moment when the jaw left.
    pub(super) fn new(law: &LinearLaw, excess: &[f64]) -> Self {
        let started = |mode: &FreeMode| {
            let amount = Modes::amount(mode, law, excess);
            let parts: Vec<f64> =
                law.terms().iter().zip(&mode.gaps).map(|(term, gap)| amount * term.overshoot / gap).collect();
            Mode {
                rate: mode.rate,
                sum: parts.iter().sum(),
                parts,
            }
        };
        Self {
            modes: Modes::new(law).modes.iter().map(started).collect(),
        }
    }

    /// q a time `elapsed` (s) after the force was gone.
    pub(super) fn value(&self, elapsed: f64) -> f64 {
        -self.modes.iter().map(|mode| mode.sum * (-mode.rate * elapsed).exp()).sum::<f64>()
    }

    /// q̇ there.
    pub(super) fn slope(&self, elapsed: f64) -> f64 {
        self.modes.iter().map(|mode| mode.rate * mode.sum * (-mode.rate * elapsed).exp()).sum()
    }

    /// The sum of the sizes of all modes at the start: what the rounding of their sum is relative to.
    pub(super) fn size(&self) -> f64 {
        self.modes.iter().map(|mode| mode.sum.abs()).sum()
    }

    /// A lower bound of q between two times: every mode fades.
    pub(super) fn least(&self, from: f64, until: f64) -> f64 {
        let each = |mode: &Mode| {
            let (early, late) = ((-mode.rate * from).exp(), (-mode.rate * until).exp());
            (-mode.sum * early).min(-mode.sum * late)
        };
        self.modes.iter().map(each).sum()
    }

    /// By how much q is above its chord at most between two times: every mode bends ever less.
    pub(super) fn above_chord(&self, from: f64, until: f64) -> f64 {
        let bend = |mode: &Mode| mode.rate * mode.rate * (mode.sum * (-mode.rate * from).exp()).abs();
        0.125 * (until - from).powi(2) * self.modes.iter().map(bend).sum::<f64>()
    }

    /// The excess strains there.
    pub(super) fn excess(&self, elapsed: f64) -> Vec<f64> {
        let count = self.modes.len();
        let mut excess = vec![0.0; count];
        for mode in &self.modes {
            let left = (-mode.rate * elapsed).exp();
            excess.iter_mut().zip(&mode.parts).for_each(|(x, part)| *x += part * left);
        }
        excess
    }
}

/// Where a falling function changes sign between 0, where it is +∞, and `gap`, by bisection to the last bit.
fn root(gap: f64, f: impl Fn(f64) -> f64) -> f64 {
    let (mut above, mut below) = (0.0, gap);
    loop {
        // Geometric first: the root may be many orders of magnitude below the gap.
        let middle = if above > 0.0 { (above * below).sqrt() } else { below * 1e-4 };
        let middle = if above > 0.5 * below { 0.5 * (above + below) } else { middle };
        if middle <= above || middle >= below {
            return above.max(f64::MIN_POSITIVE);
        }
        if f(middle) > 0.0 {
            above = middle;
        } else {
            below = middle;
        }
    }
}

/// A stress-free surface on its way back, from the moment when the jaw left.
#[derive(Debug, Clone)]
pub(crate) struct Surface {
    contact: LinearContact,
    recovery: Recovery,
}

impl Surface {
    pub(super) fn new(contact: &LinearContact, memory: &[f64]) -> Self {
        Self {
            contact: contact.clone(),
            recovery: Recovery::new(&contact.law, memory),
        }
    }

    /// Displacement of the surface, m.
    pub(super) fn displacement(&self, elapsed: f64) -> f64 {
        self.place(self.recovery.value(elapsed))
    }

    /// x_k.
    pub(super) fn memory(&self, elapsed: f64) -> Vec<f64> {
        self.recovery.excess(elapsed)
    }

    /// A round body has nothing beyond first touch for its surface to go to.
    fn place(&self, value: f64) -> f64 {
        self.contact.place(value).unwrap_or(0.0)
    }

    /// By how much what the jaw, which moves straight, requests differs from its chord at most, where its slope goes one way.
    fn above_chord(&self, (start, end): (f64, f64), jaw: &impl Fn(f64) -> f64) -> f64 {
        let (from, to) = (jaw(start), jaw(end));
        0.25 * (to - from).abs() * (self.contact.slope(to) - self.contact.slope(from)).abs()
    }

    /// When between two times (s) the jaw at `jaw` (m) meets the surface, which is on its own since `since` (s).
    ///
    /// They are compared in what is remembered: the displacement of a body that is soft at first touch is a root of rounding there.
    pub(super) fn meeting(&self, since: f64, (start, end): (f64, f64), jaw: &impl Fn(f64) -> f64) -> Option<f64> {
        let requested = |time: f64| self.contact.value(jaw(time));
        let most = requested(start).max(requested(end));
        let rounding = 4.0 * f64::EPSILON * (most.abs() + self.recovery.size());
        if self.recovery.least(start - since, end - since) - most >= -rounding {
            return None;
        }
        // Large modes that cancel: the surface and the jaw are compared over their chords.
        let free = |time: f64| self.recovery.value(time - since) - requested(time);
        let bent = self.recovery.above_chord(start - since, end - since) + self.above_chord((start, end), jaw);
        if free(start).min(free(end)) - bent >= -rounding {
            return None;
        }
        let middle = 0.5 * (start + end);
        if middle <= start || middle >= end {
            return (self.recovery.value(end - since) < requested(end)).then_some(end);
        }
        self.meeting(since, (start, middle), jaw).or_else(|| self.meeting(since, (middle, end), jaw))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulate::LinearTerm;

    #[test]
    fn recovery_begins_as_the_jaw_left_and_obeys_its_equation() {
        let terms: Vec<LinearTerm> = [(2.0, 0.01), (1e-6, 0.5), (0.7, 0.51), (3.0, 40.0)]
            .map(|(overshoot, rate)| LinearTerm { overshoot, rate })
            .into();
        let law = LinearLaw::new(&terms).unwrap();
        let start = [0.03, -1e-7, 0.01, -0.2];
        let recovery = Recovery::new(&law, &start);
        for (found, expected) in recovery.excess(0.0).iter().zip(start) {
            assert!((found - expected).abs() < 1e-12, "{found} {expected}");
        }
        let whole = 1.0 + law.overshoot();
        for t in [0.0, 0.01, 1.0, 100.0] {
            let x = recovery.excess(t);
            assert!((recovery.value(t) + x.iter().sum::<f64>()).abs() < 1e-15);
            let step = 1e-6 * (0.1 + t);
            let (before, after) = (recovery.excess((t - step).max(0.0)), recovery.excess(t + step));
            let width = t + step - (t - step).max(0.0);
            let pushed = terms.iter().zip(&x).map(|(term, x)| term.rate * x).sum::<f64>() / whole;
            for k in 0..4 {
                let slope = (after[k] - before[k]) / width;
                let expected = terms[k].overshoot * pushed - terms[k].rate * x[k];
                let size = terms[k].rate * (x[k].abs() + 1e-3) + terms[k].overshoot * pushed.abs();
                assert!((slope - expected).abs() < 1e-4 * size, "t = {t}, term {k}: {slope} {expected}");
            }
        }
    }
}
