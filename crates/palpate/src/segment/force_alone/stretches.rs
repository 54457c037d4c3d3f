//! The level of noise, and what speaks for each hold.

use super::breaks::sharpen;
use super::chain::{self, Force, Link, chain, goes_on};
use super::points::points;
use super::shapes::{Shape, Shapes};
use crate::optimise::BoundedSolver;
use crate::segment::hear;
use crate::statistics::{at, least_change, noise_in_time, quantum, range, updates};
use crate::watch::{Cancelled, Watch};

/// Levels of noise that are tried, in standard deviations of what differs from sample to sample: what a controller leaves, or an
/// amplifier, goes together over many samples.
const LEVELS: [f64; 3] = [1.0, 3.0, 10.0];
/// Least noise, as a share of the range: of the force, and of what shapes follow.
const LEAST: (f64, f64) = (1e-5, 1e-4);
/// A single sample is a spike beyond this many standard deviations and this many times the range of its neighbours.
const SPIKE: (f64, f64) = (8.0, 2.0);
/// Most samples that are searched; of a longer record means are.
const MOST: usize = 40_000;
/// How far shapes may be off when a hold is weighed against the chain without it, as a share of the range of the stretch.
const OFF: f64 = 0.02;
/// A hold is doubtful when the chain without it costs fewer prices of a parameter more.
const DOUBTFUL: f64 = 3.0;
/// A hold is doubtful where it and the ramps beside it stay within so many of the least changes: what drifts and is rounded makes such stairs.
const STAIRS: f64 = 3.0;
/// Points of a stretch that is weighed again.
const POINTS: usize = 400;

/// A hold or a ramp, in samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::segment) struct Stretch {
    pub(in crate::segment) start: usize,
    pub(in crate::segment) end: usize,
    pub(in crate::segment) holds: bool,
    /// Whether the record can be explained nearly as well without this hold; or it goes on the way of the ramp before it, as where ramps last
    /// longer than the relaxation and look like holds; or it is a stair of the rounding.
    pub(in crate::segment) doubtful: bool,
}

/// The stretches of a force, in order and without gaps, and the standard deviation of what is left of it, N. Of a force that is read more often than it
/// is updated the new values count.
pub(in crate::segment) fn stretches(
    time: &[f64],
    force: &[f64],
    watch: &mut dyn Watch,
) -> Result<(Vec<Stretch>, f64), Cancelled> {
    let Some(rows) = updates(force) else {
        return stretches_of_new(time, force, watch);
    };
    let (mut found, noise) = stretches_of_new(&at(time, &rows), &at(force, &rows), watch)?;
    let row = |place: usize| rows.get(place).copied().unwrap_or(force.len());
    for stretch in &mut found {
        (stretch.start, stretch.end) = (row(stretch.start), row(stretch.end));
    }
    Ok((found, noise))
}

fn stretches_of_new(time: &[f64], force: &[f64], watch: &mut dyn Watch) -> Result<(Vec<Stretch>, f64), Cancelled> {
    let values = without_spikes(time, force);
    let together = values.len().div_ceil(MOST);
    if together == 1 {
        return searched(time, &values, watch);
    }
    let mean = |column: &[f64]| -> Vec<f64> {
        column.chunks(together).map(|part| part.iter().sum::<f64>() / part.len() as f64).collect()
    };
    let (mut found, noise) = searched(&mean(time), &mean(&values), watch)?;
    let mut ends: Vec<usize> = found.iter().map(|stretch| stretch.start * together).collect();
    ends.push(values.len());
    sharpen(time, &values, &mut ends);
    for (stretch, ends) in found.iter_mut().zip(ends.windows(2)) {
        (stretch.start, stretch.end) = (ends[0], ends[1]);
    }
    Ok((found, noise))
}

fn searched(time: &[f64], values: &[f64], watch: &mut dyn Watch) -> Result<(Vec<Stretch>, f64), Cancelled> {
    let range = range(values);
    let noise = noise_in_time(time, values).max(LEAST.0 * range);
    let mut best: Option<(f64, Force<'_>, Vec<Link>)> = None;
    for level in LEVELS {
        let force = Force {
            time,
            values,
            rounding: quantum(values) / 12f64.sqrt(),
            step: least_change(values),
            noise: level * noise,
            least: LEAST.1 * range,
        };
        let links = chain(&force, watch)?;
        let cost = criterion(&force, &links);
        if best.as_ref().is_none_or(|(least, ..)| cost < *least) {
            best = Some((cost, force, links));
        }
    }
    let Some((_, force, links)) = best else {
        return Ok((Vec::new(), noise));
    };
    let mut found = Vec::with_capacity(links.len());
    for (index, link) in links.iter().enumerate() {
        hear(watch)?;
        found.push(Stretch {
            start: link.start,
            end: link.end,
            holds: link.holds,
            doubtful: link.holds && is_doubtful(&force, &links, index),
        });
    }
    Ok((found, force.noise))
}

/// Schwarz's criterion of a chain whose residuals are taken for an autoregressive process of the first order.
fn criterion(force: &Force<'_>, links: &[Link]) -> f64 {
    let mut solver = BoundedSolver::new(Shapes::DECAYS);
    let mut parameters = 0.0;
    let mut left = |link: &Link| -> Vec<f64> {
        let shape = shape(force, link, chain::OFF, &mut solver);
        parameters += shape.parameters + 1.0;
        (link.start..link.end).map(|i| force.values[i] - shape.at(force.time[i])).collect()
    };
    let residuals: Vec<Vec<f64>> = links.iter().map(&mut left).collect();
    let (mut together, mut squares) = (0.0, f64::MIN_POSITIVE);
    for pair in residuals.iter().flat_map(|stretch| stretch.windows(2)) {
        together += pair[0] * pair[1];
        squares += pair[0] * pair[0];
    }
    let correlation = (together / squares).clamp(0.0, 0.98);
    let new: f64 = residuals
        .iter()
        .map(|stretch| {
            let first = stretch.first().map_or(0.0, |r| r * r * (1.0 - correlation * correlation));
            first + stretch.windows(2).map(|pair| (pair[1] - correlation * pair[0]).powi(2)).sum::<f64>()
        })
        .sum();
    let samples = force.values.len() as f64;
    samples * (new / samples).max(force.least * force.least).ln() + parameters * samples.ln()
}

/// Whether a hold may be none; see [`Stretch::doubtful`].
fn is_doubtful(force: &Force<'_>, links: &[Link], hold: usize) -> bool {
    let beside = &links[hold.saturating_sub(1)..links.len().min(hold + 2)];
    let values = &force.values[beside[0].start..beside[beside.len() - 1].end];
    if range(values) < STAIRS * force.step {
        return true;
    }
    let mut solver = BoundedSolver::new(Shapes::DECAYS);
    let mut shape = |link: &Link| shape(force, link, OFF, &mut solver);
    if let [ramp, hold, ..] = beside
        && hold.holds
        && !ramp.holds
        && goes_on(&shape(ramp), &shape(hold), force.noise)
    {
        return true;
    }
    evidence(force, links, hold) < DOUBTFUL
}

/// The shape of a stretch.
fn shape(force: &Force<'_>, link: &Link, off: f64, solver: &mut BoundedSolver) -> Shape {
    let shapes = shapes(force, (link.start, link.end), off, solver);
    if link.holds { shapes.hold } else { shapes.ramp }
}

/// The best hold and the best ramp from one sample to another.
fn shapes(force: &Force<'_>, (start, end): (usize, usize), off: f64, solver: &mut BoundedSolver) -> Shapes {
    let stretch = points(force.time, force.values, (start, end), POINTS);
    Shapes::of(&stretch, (force.time[start], force.time[end - 1]), force.weighing(off), solver)
}

/// What the chain costs more when a hold is one stretch with its neighbours, in prices of a parameter.
fn evidence(force: &Force<'_>, links: &[Link], hold: usize) -> f64 {
    let mut solver = BoundedSolver::new(Shapes::DECAYS);
    let (lowest, highest) = (hold.saturating_sub(2), (hold + 2).min(links.len() - 1));
    let costs: Vec<f64> =
        links[lowest..=highest].iter().map(|link| shape(force, link, OFF, &mut solver).cost).collect();
    let mut least = f64::INFINITY;
    for (before, after) in [(1, 0), (0, 1), (1, 1), (2, 0), (0, 2)] {
        let (Some(first), last) = (hold.checked_sub(before), hold + after) else {
            continue;
        };
        if last > highest {
            continue;
        }
        let apart = costs[first - lowest..=last - lowest].iter().sum::<f64>() + (last - first) as f64 * force.price();
        let joined = shapes(force, (links[first].start, links[last].end), OFF, &mut solver);
        least = least.min(joined.hold.cost.min(joined.ramp.cost) - apart);
    }
    least / force.price()
}

/// The force with single samples that lie far off replaced by the means of their neighbours.
fn without_spikes(time: &[f64], force: &[f64]) -> Vec<f64> {
    let noise = noise_in_time(time, force);
    let mut values = force.to_vec();
    for (i, five) in force.windows(5).enumerate() {
        let [a, b, here, c, d] = *five else { continue };
        let (low, high) = [a, b, c, d].iter().fold((f64::MAX, f64::MIN), |(l, h), v| (l.min(*v), h.max(*v)));
        if (here - high).max(low - here) > SPIKE.0 * noise + SPIKE.1 * (high - low) {
            values[i + 2] = 0.5 * (b + c);
        }
    }
    values
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Rng;
    use crate::watch::Unwatched;

    /// Steps of 2 s up and 8 s of relaxation by a half, in steps of 10 ms, with noise of this standard deviation.
    fn stairs(noise: impl FnMut() -> f64) -> (Vec<f64>, Vec<f64>) {
        let time: Vec<f64> = (0..4000).map(|i| 0.01 * f64::from(i)).collect();
        let mut noise = noise;
        let force = time.iter().map(|t| {
            let (step, t) = ((t / 10.0).floor(), t % 10.0);
            let relaxed = if t < 2.0 { t } else { 1.0 + (-(t - 2.0) / 1.5).exp() };
            step + relaxed + noise()
        });
        let force = force.collect();
        (time, force)
    }

    fn holds(time: &[f64], force: &[f64]) -> Vec<Stretch> {
        let (found, _) = stretches(time, force, &mut Unwatched).unwrap();
        assert!(found.windows(2).all(|pair| pair[0].end == pair[1].start), "{found:?}");
        found.into_iter().filter(|stretch| stretch.holds).collect()
    }

    #[test]
    fn stairs_are_ramps_and_holds() {
        let mut random = Rng::new(3);
        let (time, force) = stairs(|| 0.01 * random.normal());
        let found = holds(&time, &force);
        assert_eq!(found.len(), 4, "{found:?}");
        for (step, hold) in found.iter().enumerate() {
            assert!(hold.start.abs_diff(1000 * step + 200) < 8, "{hold:?}");
            assert!(hold.end.abs_diff(1000 * (step + 1)) < 8, "{hold:?}");
            assert!(!hold.doubtful, "{hold:?}");
        }
    }

    #[test]
    fn a_force_that_levels_off_on_the_way_of_its_ramp_and_a_drift_that_is_rounded_are_doubtful() {
        let mut random = Rng::new(7);
        let time: Vec<f64> = (0..1000).map(|i| 0.01 * f64::from(i)).collect();
        let mut force = |way: f64| -> Vec<f64> {
            let levels = |t: f64| if t < 2.0 { 2.0 * t } else { 4.0 + way * (1.0 - (-(t - 2.0) / 1.5).exp()) };
            time.iter().map(|t| levels(*t) + 0.002 * random.normal()).collect()
        };
        let doubtful = |force: &[f64]| holds(&time, force).iter().map(|hold| hold.doubtful).collect::<Vec<_>>();
        assert_eq!((doubtful(&force(-1.0)), doubtful(&force(1.0))), (vec![false], vec![true]));
        let drift: Vec<f64> = time.iter().map(|t| (0.7 * t + 0.05 * random.normal()).round()).collect();
        let drift = doubtful(&drift);
        assert!(drift.len() > 3 && !drift.contains(&false), "{drift:?}");
    }

    #[test]
    fn noise_that_goes_together_cuts_no_hold() {
        let (mut random, mut slow) = (Rng::new(4), 0.0);
        let (time, force) = stairs(|| {
            slow = 0.9 * slow + 0.01 * random.normal();
            slow
        });
        assert_eq!(holds(&time, &force).len(), 4);
    }

    #[test]
    fn a_long_record_is_searched_by_means_and_its_ends_are_sharp() {
        let mut random = Rng::new(5);
        let (few, values) = stairs(|| 0.0);
        let time: Vec<f64> = (0..120_000).map(|i| few[3999] * f64::from(i) / 119_999.0).collect();
        let at = |t: f64| values[(t / 0.01).round() as usize];
        let force: Vec<f64> = time.iter().map(|t| at(*t) + 0.005 * random.normal()).collect();
        let found = holds(&time, &force);
        assert_eq!(found.len(), 4, "{found:?}");
        assert!((time[found[1].start] - 12.0).abs() < 0.05, "{}", time[found[1].start]);
    }

    #[test]
    fn a_force_that_repeats_its_values_has_the_holds_of_one_that_does_not() {
        let mut random = Rng::new(8);
        let (time, force) = stairs(|| 0.01 * random.normal());
        let repeated: Vec<f64> = (0..force.len()).map(|i| force[i - i % 8]).collect();
        let found = holds(&time, &repeated);
        assert_eq!(found.len(), 4, "{found:?}");
        for (step, hold) in found.iter().enumerate() {
            assert!(hold.start.abs_diff(1000 * step + 200) < 24, "{hold:?}");
            assert!(hold.end.abs_diff(1000 * (step + 1)) < 24, "{hold:?}");
        }
    }

    #[test]
    fn a_spike_is_no_stretch() {
        let mut random = Rng::new(6);
        let (time, mut force) = stairs(|| 0.01 * random.normal());
        force[500] = 0.0;
        assert_eq!(holds(&time, &force).len(), 4);
    }
}
