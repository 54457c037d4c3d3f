//! The chain of holds and ramps of least cost for one level of noise.

use super::breaks::breaks;
use super::points::{Point, points, thinned};
use super::shapes::{Shape, Shapes, Weighing};
use crate::optimise::BoundedSolver;
use crate::segment::hear;
use crate::watch::{Cancelled, Watch};

/// Fewest samples of a hold.
const FEWEST: usize = 6;
/// Most points of a piece, and of a stretch.
const POINTS: (usize, usize) = (5, 96);
/// What a parameter costs, as a share of the logarithm of the number of samples.
const PRICE: f64 = 0.8;
/// How far a shape may be off, as a share of the range of its stretch.
pub(super) const OFF: f64 = 0.008;
/// Price of a ramp after a ramp: tests alternate between ramps and holds.
const RAMP_AFTER_RAMP: f64 = 4.0;
/// Price of a ramp that goes on as the hold before it ended, and from which share of its slope on it does so.
const NO_CORNER: (f64, f64) = (4.0, 0.25);
/// Price of a hold that goes on the way of the ramp before it, and from how many standard deviations of the noise on it does so: what relaxes turns
/// back.
const SAME_WAY: (f64, f64) = (2.0, 3.0);
/// Price of a ramp between two holds in which no sample lies.
const STEP: f64 = 2.0;
/// Noise and the change of its neighbours that a step must exceed.
const STEPS: (f64, f64) = (6.0, 2.0);
/// Squares beyond which no shape that fits can follow when a stretch grows.
const HOPELESS: f64 = 4000.0;

/// What is sought of a force, and how it is weighed.
#[derive(Debug, Clone, Copy)]
pub(super) struct Force<'a> {
    pub(super) time: &'a [f64],
    pub(super) values: &'a [f64],
    /// What rounding leaves unsure, N.
    pub(super) rounding: f64,
    /// Least change from a sample to the next, N.
    pub(super) step: f64,
    /// Standard deviation of a sample, N.
    pub(super) noise: f64,
    /// Least noise to which shapes follow the force, N.
    pub(super) least: f64,
}

impl Force<'_> {
    /// Price of a parameter or a stretch, in squares of the noise.
    pub(super) fn price(&self) -> f64 {
        PRICE * (self.values.len() as f64).ln()
    }

    /// How points of a stretch are weighed when shapes may be `off` by this share of its range.
    pub(super) fn weighing(&self, off: f64) -> Weighing {
        Weighing {
            noise: self.noise,
            rounding: self.rounding,
            off,
            price: self.price(),
        }
    }

    /// Whether the force steps from one sample to the next.
    fn steps(&self, at: usize) -> bool {
        let change = |i: usize| (self.values[i] - self.values[i - 1]).abs();
        let beside = change(at - 1).max(if at + 1 < self.values.len() { change(at + 1) } else { f64::INFINITY });
        change(at) > STEPS.0 * self.noise && change(at) > STEPS.1 * beside
    }
}

/// A stretch of the chain.
#[derive(Debug, Clone, Copy)]
pub(super) struct Link {
    pub(super) start: usize,
    pub(super) end: usize,
    pub(super) holds: bool,
}

/// The cheapest chain that ends at a break in a hold or in a ramp.
#[derive(Debug, Clone, Copy)]
struct Best {
    cost: f64,
    /// Where its last stretch begins, and whether a hold comes before it.
    from: usize,
    after_hold: bool,
    /// The last stretch; `None` before the first.
    shape: Option<Shape>,
}

impl Best {
    const NONE: Self = Self {
        cost: f64::INFINITY,
        from: 0,
        after_hold: false,
        shape: None,
    };

    fn improve(&mut self, cost: f64, from: usize, after_hold: bool, shape: Shape) {
        if cost < self.cost {
            *self = Self {
                cost,
                from,
                after_hold,
                shape: Some(shape),
            };
        }
    }
}

/// Whether a hold goes on the way of the ramp before it.
pub(super) fn goes_on(ramp: &Shape, hold: &Shape, noise: f64) -> bool {
    let change = hold.change();
    change.abs() > SAME_WAY.1 * noise && change * ramp.change() > 0.0
}

/// The cheapest chain.
pub(super) fn chain(force: &Force<'_>, watch: &mut dyn Watch) -> Result<Vec<Link>, Cancelled> {
    let (time, values) = (force.time, force.values);
    let breaks = breaks(time, values, force.noise.max(force.least));
    let (price, weighing) = (force.price(), force.weighing(OFF));
    let pieces: Vec<Vec<Point>> =
        breaks.windows(2).map(|ends| points(time, values, (ends[0], ends[1]), POINTS.0)).collect();
    let mut best = vec![[Best::NONE; 2]; breaks.len()];
    best[0] = [Best {
        cost: 0.0,
        ..Best::NONE
    }; 2];
    let mut solver = BoundedSolver::new(Shapes::DECAYS);
    for i in 0..pieces.len() {
        hear(watch)?;
        let [hold, ramp] = best[i];
        let step = match breaks[i] {
            0 => 0.0,
            1 => f64::INFINITY,
            at if force.steps(at) => STEP * price,
            _ => f64::INFINITY,
        };
        let mut stretch: Vec<Point> = Vec::new();
        for j in i + 1..breaks.len() {
            stretch.extend(&pieces[j - 1]);
            if stretch.len() > POINTS.1 {
                stretch = thinned(&stretch);
            }
            let shapes = Shapes::of(&stretch, (time[breaks[i]], time[breaks[j] - 1]), weighing, &mut solver);
            if breaks[j] - breaks[i] >= FEWEST {
                let goes_on = ramp.shape.is_some_and(|ramp| goes_on(&ramp, &shapes.hold, force.noise));
                let after_ramp = ramp.cost + if goes_on { SAME_WAY.0 * price } else { 0.0 };
                let before_hold =
                    if hold.cost + step < after_ramp { (hold.cost + step, true) } else { (after_ramp, false) };
                best[j][0].improve(before_hold.0 + shapes.hold.cost + price, i, before_hold.1, shapes.hold);
            }
            let no_corner =
                hold.shape.is_some_and(|hold| hold.slope(1.0).abs() > NO_CORNER.1 * shapes.ramp.slope(0.0).abs());
            let after_hold = hold.cost + if no_corner { NO_CORNER.0 * price } else { 0.0 };
            let after_ramp = ramp.cost + if i > 0 { RAMP_AFTER_RAMP * price } else { 0.0 };
            best[j][1].improve(
                after_hold.min(after_ramp) + shapes.ramp.cost + price,
                i,
                after_hold <= after_ramp,
                shapes.ramp,
            );
            if j > i + 3 && shapes.hold.cost.min(shapes.ramp.cost) > HOPELESS {
                break;
            }
        }
    }
    let last = best[breaks.len() - 1];
    let (mut end, mut holds) = (breaks.len() - 1, last[0].cost < last[1].cost);
    let mut links = Vec::new();
    while let Best {
        cost: _,
        from,
        after_hold,
        shape: Some(_),
    } = best[end][usize::from(!holds)]
    {
        links.push(Link {
            start: breaks[from],
            end: breaks[end],
            holds,
        });
        (end, holds) = (from, after_hold);
    }
    links.reverse();
    Ok(links)
}
