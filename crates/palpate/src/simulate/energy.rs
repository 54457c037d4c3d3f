//! Work of the jaw, and what becomes of it.

use serde::{Deserialize, Serialize};

use super::trajectory::sample_times;
use super::{ContactRef, Course, Drive, InMotion, Layer, Sampling, SimulateError, Stretch, StretchState, by_law, walk};
use crate::contact::UnderForce;
use crate::watch::{Stages, Unwatched, Watch};

/// Energy of a simulated body over time, in J; both contacts of a body that is squeezed from two sides.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Energy {
    /// Time, s.
    pub time: Vec<f64>,
    /// Work that the jaw has done on the body so far, ∫ F dd, less what the body gave back.
    pub work: Vec<f64>,
    /// What the body has given back of it so far: work at which force and travel were opposed.
    pub given_back: Vec<f64>,
    /// What is stored in the body and what it has lost to heat; `None` of a body whose area grows with the squeeze, where this law does
    /// not say how much of the difference is stored.
    pub split: Option<EnergySplit>,
}

/// Work split into what can be had back and what cannot.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct EnergySplit {
    /// Stored: E A u²/(2 depth) + E A depth x²/(2 (m − 1)) a contact; by a linear law E A u²/(2 depth) + E A depth Σ x_k²/(2 g_k).
    pub stored: Vec<f64>,
    /// Lost, at the rate E A depth v |x|ⁿ⁺¹/(m − 1) a contact; by a linear law E A depth Σ λ_k x_k²/g_k.
    pub lost: Vec<f64>,
}

/// Energy of `model` under a motion, a force or a program.
///
/// Work is integrated along with the contact, not from samples: its error is that of the force.
///
/// ```
/// use palpate::contact::{Layers, Shape, Sides, Specimen};
/// use palpate::latency::LatencyLaw;
/// use palpate::simulate::{ContactModel, Motion, Sampling, Separation, energy};
///
/// let block = Shape::Prism { area: 1e-3, length: 0.04 };
/// let model = ContactModel {
///     specimen: Specimen::new(block, 1e5, Sides::One)?,
///     law: LatencyLaw::new(3.0, 100.0)?,
///     layers: Layers::new(8.0)?,
///     separation: Separation::Bonded,
/// };
/// // 4 mm in 1 s, held for 1000 s: in the end what is stored is elastic, E A d²/(2 L) = 20 mJ.
/// let squeeze = Motion::new(vec![0.0, 1.0, 1001.0], vec![0.0, 0.004, 0.004])?;
/// let energy = energy(&squeeze, &model, &Sampling::Times(vec![1.0, 1001.0]))?;
/// let split = energy.split.as_ref().unwrap();
/// assert_eq!(energy.work[0], energy.work[1]); // a jaw that stands still does no work
/// assert!((split.stored[1] - 0.02).abs() < 1e-4 && split.stored[0] > split.stored[1]);
/// assert!((split.stored[1] + split.lost[1] - energy.work[1]).abs() < 1e-15);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// As for [`simulate`](super::simulate()).
pub fn energy<'a, 'b>(
    drive: impl Into<Drive<'a>>,
    contact: impl Into<ContactRef<'b>>,
    sampling: &Sampling,
) -> Result<Energy, SimulateError> {
    energy_watched(drive, contact, sampling, &mut Unwatched)
}

/// As [`energy`], heard by `watch` at every straight piece of the drive and every sample.
///
/// # Errors
/// As for [`energy`], and [`SimulateError::Cancelled`].
pub fn energy_watched<'a, 'b>(
    drive: impl Into<Drive<'a>>,
    contact: impl Into<ContactRef<'b>>,
    sampling: &Sampling,
    watch: &mut dyn Watch,
) -> Result<Energy, SimulateError> {
    integrated(drive.into(), contact.into(), sampling, watch)
}

/// Without generics, so that it is compiled here, once, and not wherever it is called.
fn integrated(
    drive: Drive<'_>,
    contact: ContactRef<'_>,
    sampling: &Sampling,
    watch: &mut dyn Watch,
) -> Result<Energy, SimulateError> {
    let mut stages = Stages::new("integrating work".to_owned(), watch);
    let result = by_law!(contact, contact => energy_of(drive, contact, sampling, &mut stages))?;
    stages.finish()?;
    Ok(result)
}

fn energy_of<L: Layer>(
    drive: Drive<'_>,
    model: &L,
    sampling: &Sampling,
    stages: &mut Stages<'_>,
) -> Result<Energy, SimulateError> {
    let course = Course::new(drive, model, stages)?;
    stages.enter(1.0);
    let time = sample_times(&course, sampling)?;
    let contacts = 1.0 / model.specimen().contact_displacement(1.0);
    let mut account = Account::default();
    let (mut work, mut given_back, mut stored) = (Vec::new(), Vec::new(), Vec::new());
    let last = course.end();
    walk(course.drive, model, &mut |stretch| {
        let inside = |time: f64| time < stretch.end || stretch.end == last;
        let mut at = stretch.start;
        while let Some(&next) = time.get(work.len()).filter(|time| inside(**time)) {
            account.add(stretch, model, (at, next));
            at = next;
            stages.reach(course.share(at))?;
            work.push(account.work * contacts);
            given_back.push(account.given_back * contacts);
            stored.push(stored_at(stretch, model, next) * contacts);
        }
        account.add(stretch, model, (at, stretch.end));
        Ok(stages.reach(course.share(stretch.end))?)
    })?;
    let split = model.specimen().has_constant_section().then(|| EnergySplit {
        lost: work.iter().zip(&stored).map(|(work, stored)| work - stored).collect(),
        stored,
    });
    match work.iter().position(|work| !work.is_finite()) {
        Some(index) => Err(SimulateError::OutOfRange { time: time[index] }),
        None => Ok(Energy {
            time,
            work,
            given_back,
            split,
        }),
    }
}

/// What one contact's share of the jaw has done so far, J.
#[derive(Default)]
pub(super) struct Account {
    pub(super) work: f64,
    pub(super) given_back: f64,
}

impl Account {
    /// Adds the work from one time to another inside a stretch.
    pub(super) fn add<L: Layer>(&mut self, stretch: &Stretch<L>, model: &L, (from, to): (f64, f64)) {
        let duration = stretch.end - stretch.start;
        let kinks: Vec<f64> = match &stretch.state {
            StretchState::Touching(piece) if stretch.contact_speed != 0.0 => {
                let mut kinks = piece.step_ends();
                // What follows the last step decays: pieces that grow.
                let last = kinks.last().copied().unwrap_or(0.0);
                let mut width = kinks.first().copied().unwrap_or(duration).max(1e-6 * duration);
                let mut next = last + width;
                while next < duration {
                    kinks.push(next);
                    width *= 1.5;
                    next += width;
                }
                // Where the body does not get stiffer evenly.
                let when = |u: f64| (u - stretch.contact_from) / stretch.contact_speed;
                let reach = stretch.contact_from.max(stretch.jaw_at(stretch.end));
                kinks.extend(model.specimen().bends(reach).into_iter().map(when));
                kinks.sort_by(f64::total_cmp);
                kinks
            }
            StretchState::Forced(forced) => forced.step_ends(),
            StretchState::Touching(_) | StretchState::Free { .. } => return,
        };
        let kinks = kinks.into_iter().map(|elapsed| stretch.start + elapsed);
        let mut before = from;
        for end in kinks.filter(|kink| from < *kink && *kink < to).chain([to]) {
            let turn = turning(stretch, model, (before, end));
            for (from, to) in [(before, turn), (turn, end)] {
                if to > from {
                    let work = work_between(stretch, model, (from, to));
                    self.work += work;
                    self.given_back += (-work).max(0.0);
                }
            }
            before = end;
        }
    }
}

/// Power F u̇ of one contact's share of the jaw at a time inside a stretch, W.
fn power_at<L: Layer>(stretch: &Stretch<L>, model: &L, time: f64) -> f64 {
    let (specimen, elapsed) = (model.specimen(), time - stretch.start);
    match &stretch.state {
        StretchState::Touching(piece) => {
            let u = stretch.jaw_at(time);
            specimen.force(piece.strain_at(elapsed) + specimen.equilibrium_strain(u), u) * stretch.contact_speed
        }
        StretchState::Forced(forced) => forced.force_at(elapsed) * forced.at(elapsed).speed,
        StretchState::Free { .. } => 0.0,
    }
}

/// Where work begins to be given back, or ends to be, inside a smooth piece; its end if nowhere.
fn turning<L: Layer>(stretch: &Stretch<L>, model: &L, (from, to): (f64, f64)) -> f64 {
    let power = |time: f64| power_at(stretch, model, time);
    let gives = power(to) < 0.0;
    if (power(from) < 0.0) == gives {
        return to;
    }
    let (mut before, mut after) = (from, to);
    for _ in 0..60 {
        let middle = 0.5 * (before + after);
        if (power(middle) < 0.0) == gives {
            after = middle;
        } else {
            before = middle;
        }
    }
    after
}

/// ∫ F du over a smooth piece. Under a force by parts, since it is u that begins like √t at first touch.
fn work_between<L: Layer>(stretch: &Stretch<L>, model: &L, (from, to): (f64, f64)) -> f64 {
    match &stretch.state {
        StretchState::Touching(_) => integral(|time| power_at(stretch, model, time), from, to),
        StretchState::Forced(forced) => {
            let force = |time: f64| forced.force_at(time - stretch.start);
            let u = |time: f64| stretch.jaw_at(time);
            let rise = force(to) - force(from);
            // Against the displacement at one end, so that a held force keeps its digits.
            let (start, end) = (u(from), u(to));
            let held = force(to) * (end - start);
            if rise == 0.0 {
                return held;
            }
            // The displacement begins like a root of time at first touch, and bends at the rows of tables.
            let way = |time: f64| u(time) - start;
            let allowed = (to - from) * (1e-12 * (end - start).abs() + 1e-14 * end.abs());
            held - rise / (to - from) * refined(&way, (from, to), integral(way, from, to), allowed, HALVINGS)
        }
        StretchState::Free { .. } => 0.0,
    }
}

/// What one contact of a body of constant section stores, J.
pub(super) fn stored_at<L: Layer>(stretch: &Stretch<L>, model: &L, time: f64) -> f64 {
    let (u, excess) = surface_at(stretch, model, time);
    model.stored(&excess, u, model.specimen().stiffness(u).0)
}

/// Displacement of the surface of the body (m), and the excess of the layer.
pub(super) fn surface_at<L: Layer>(stretch: &Stretch<L>, model: &L, time: f64) -> (f64, L::Excess) {
    let elapsed = time - stretch.start;
    match &stretch.state {
        StretchState::Touching(piece) => (stretch.jaw_at(time), piece.excess_at(elapsed)),
        StretchState::Forced(forced) => (stretch.jaw_at(time), forced.excess_at(elapsed)),
        StretchState::Free { surface, since } => {
            let u = model.surface(surface, time - since);
            (u, model.met(surface, time - since, u))
        }
    }
}

/// Most halvings of a piece.
const HALVINGS: u32 = 30;

/// An integral whose value by the rule over the whole piece is `whole`, by the rule over halves of it until they agree to `allowed`.
fn refined(f: &impl Fn(f64) -> f64, (from, to): (f64, f64), whole: f64, allowed: f64, halvings: u32) -> f64 {
    let middle = 0.5 * (from + to);
    let (early, late) = (integral(f, from, middle), integral(f, middle, to));
    if halvings == 0 || (early + late - whole).abs() <= allowed {
        return early + late;
    }
    let early = refined(f, (from, middle), early, allowed, halvings - 1);
    early + refined(f, (middle, to), late, allowed, halvings - 1)
}

/// Gauss and Legendre's rule with eight points.
fn integral(f: impl Fn(f64) -> f64, from: f64, to: f64) -> f64 {
    const NODES: [(f64, f64); 4] = [
        (0.183_434_642_495_649_8, 0.362_683_783_378_362),
        (0.525_532_409_916_329, 0.313_706_645_877_887_3),
        (0.796_666_477_413_626_7, 0.222_381_034_453_374_5),
        (0.960_289_856_497_536_3, 0.101_228_536_290_376_26),
    ];
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    half * NODES.iter().map(|(x, weight)| weight * (f(middle - half * x) + f(middle + half * x))).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rule_integrates_polynomials_of_degree_15() {
        let exact = (3f64.powi(16) - 1.0) / 16.0;
        assert!((integral(|x| x.powi(15), 1.0, 3.0) / exact - 1.0).abs() < 1e-14);
    }
}
