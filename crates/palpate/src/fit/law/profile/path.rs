//! The way along a profile to where it meets its bound.

use crate::fit::law::fitted::Point;
use crate::fit::{Condensed, Fitted, Model};
use crate::optimise::{Effort, Ending, Shapes, Target, refine};
use crate::watch::Cancelled;

/// Valleys that an end is looked for in, one behind the other.
const VALLEYS: usize = 6;

/// Standard errors from the best value beyond which an end counts as open.
const FARTHEST: f64 = 2000.0;

/// How closely an end is sought.
#[derive(Clone, Copy)]
pub(super) struct Closeness {
    /// Share of the bound by which z may miss it.
    share: f64,
    /// Relative fall of the residual square below which a step counts as none.
    gain: f64,
}

impl Closeness {
    /// As far as double precision goes.
    pub(super) const EXACT: Self = Self {
        share: 5e-10,
        gain: 1e-14,
    };

    /// A ten thousandth of half an interval.
    pub(super) const USUAL: Self = Self {
        share: 1e-4,
        gain: 1e-10,
    };

    /// On condensed samples, which only show where to look.
    const ROUGH: Self = Self {
        share: 5e-5,
        gain: 1e-9,
    };
}

/// Ends of a profile; none of one that cannot be followed.
#[derive(Default)]
pub(super) struct Ends {
    pub(super) low: Option<End>,
    pub(super) high: Option<End>,
}

/// Where a way along a profile ended.
pub(super) struct End {
    /// The farthest point that the data allow, as far as it is known.
    pub(super) last: Reached,
    /// Whether the profile meets its bound there: else it is open.
    is_met: bool,
    /// How fast z rises there with the distance, where that is known.
    slope: f64,
}

impl End {
    fn open(last: Reached) -> Self {
        Self {
            last,
            is_met: false,
            slope: f64::NAN,
        }
    }

    fn met(last: Reached, slope: f64) -> Self {
        Self {
            last,
            is_met: true,
            slope,
        }
    }

    /// Where the profile meets its bound.
    pub(super) fn bound(&self) -> Option<&Reached> {
        self.is_met.then_some(&self.last)
    }
}

/// Which of the searched parameters.
#[derive(Clone, Copy)]
pub(super) enum Searched {
    /// Place among the linear ones.
    Linear(usize),
    /// Place among all nonlinear ones, and among those that are free.
    Nonlinear(usize, usize),
}

/// The profile of one parameter.
pub(super) struct Profile<'a> {
    pub(super) fitted: &'a Fitted,
    pub(super) nodes: &'a Condensed,
    /// Places of the times of doubtful terms among the free nonlinear parameters.
    pub(super) doubtful: &'a [usize],
    pub(super) parameter: Searched,
    /// Standard error for white noise, in the units of the fit.
    pub(super) error: f64,
    /// z at the ends.
    pub(super) target: f64,
    pub(super) freedom: f64,
    pub(super) most_iterations: usize,
    pub(super) closeness: Closeness,
}

/// A point of a profile: its residual square, z, and the parameters there.
#[derive(Clone)]
pub(super) struct Reached {
    distance: f64,
    square: f64,
    z: f64,
    linear: Vec<f64>,
    /// All free nonlinear ones, that which is held with them.
    nonlinear: Vec<f64>,
    /// A free parameter lies at the edge of its range.
    at_edge: bool,
}

impl Reached {
    pub(super) fn at(&self) -> Point<'_> {
        Point {
            linear: &self.linear,
            nonlinear: &self.nonlinear,
        }
    }
}

/// Samples or the nodes that stand for them.
struct Field<'a> {
    times: &'a [f64],
    target: Target<'a>,
    /// Square that the nodes leave out.
    inside: f64,
    /// Residual square at the optimum.
    least: f64,
}

impl Profile<'_> {
    /// Both ends.
    pub(super) fn ends(&self, effort: &mut Effort<'_>) -> Result<Ends, Cancelled> {
        let few = self.few(effort)?;
        let mut end = |side: f64| match self.doubtful.is_empty() {
            true => self.end(few.as_ref(), side, effort),
            false => self.end_among_valleys(few.as_ref(), side, effort),
        };
        Ok(Ends {
            low: Some(end(-1.0)?),
            high: Some(end(1.0)?),
        })
    }

    /// All samples.
    fn all(&self) -> Field<'_> {
        Field {
            times: &self.fitted.scaled.times,
            target: self.fitted.scaled.target(),
            inside: 0.0,
            least: self.fitted.solution.residual_square,
        }
    }

    /// The nodes, if there are few of them beside the samples.
    fn few(&self, effort: &mut Effort<'_>) -> Result<Option<Field<'_>>, Cancelled> {
        let nodes = self.nodes;
        if 4 * nodes.times.len() >= self.fitted.scaled.times.len() {
            return Ok(None);
        }
        let field = Field {
            times: &nodes.times,
            target: nodes.target(),
            inside: nodes.inside,
            least: 1.0,
        };
        let least = self.at(&field, 1.0, 0.0, &self.start(), Closeness::EXACT, effort)?.square;
        Ok(Some(Field { least, ..field }))
    }

    /// Where the profile meets its bound on one side.
    fn end(&self, few: Option<&Field<'_>>, side: f64, effort: &mut Effort<'_>) -> Result<End, Cancelled> {
        let start = self.start();
        let guess = match few {
            Some(few) => Some(self.meet(few, side, &start, (self.target, f64::NAN), Closeness::ROUGH, effort)?),
            None => None,
        };
        let guess = guess.as_ref().filter(|guess| guess.last.distance > 0.0);
        let first = guess.map_or((self.target, f64::NAN), |guess| (guess.last.distance, guess.slope));
        let nonlinear = guess.map_or_else(|| start.nonlinear.clone(), |guess| guess.last.nonlinear.clone());
        self.meet(&self.all(), side, &Reached { nonlinear, ..start }, first, self.closeness, effort)
    }

    /// The same beside doubtful terms: each lies in one of many valleys, of which another may be the lowest when a parameter is held
    /// elsewhere. The profile jumps from one to the next, and is followed roughly.
    fn end_among_valleys(&self, few: Option<&Field<'_>>, side: f64, effort: &mut Effort<'_>) -> Result<End, Cancelled> {
        let all = self.all();
        let field = few.unwrap_or(&all);
        let mut met = self.meet(field, side, &self.start(), (self.target, f64::NAN), Closeness::ROUGH, effort)?;
        for _ in 1..VALLEYS {
            let Some(end) = met.bound() else { break };
            let Some(lower) = self.elsewhere(field, side, end, effort)? else {
                break;
            };
            met = self.meet(field, side, &lower, (1.2 * end.distance, f64::NAN), Closeness::ROUGH, effort)?;
        }
        Ok(met)
    }

    /// A lower point of the profile at the same place, with a doubtful term at another time; `None` if there is none below the bound.
    fn elsewhere(
        &self,
        field: &Field<'_>,
        side: f64,
        met: &Reached,
        effort: &mut Effort<'_>,
    ) -> Result<Option<Reached>, Cancelled> {
        /// ln of rates over that of the hold.
        const PLACES: [f64; 5] = [-2.0, 0.0, 1.5, 3.0, 5.0];
        /// Of the bound; below it is worth going on.
        const LOWER: f64 = 0.98;
        let mut lowest: Option<Reached> = None;
        for &term in self.doubtful {
            for place in PLACES {
                let mut start = met.clone();
                start.nonlinear[term] = place;
                let found = self.at(field, side, met.distance, &start, Closeness::ROUGH, effort)?;
                if found.z < lowest.as_ref().map_or(LOWER * self.target, |lowest| lowest.z) {
                    lowest = Some(found);
                }
            }
        }
        Ok(lowest)
    }

    /// The optimum.
    fn start(&self) -> Reached {
        Reached {
            distance: 0.0,
            square: self.fitted.solution.residual_square,
            z: 0.0,
            linear: self.fitted.solution.linear.clone(),
            nonlinear: self.fitted.solution.nonlinear.clone(),
            at_edge: false,
        }
    }

    fn value(&self, side: f64, distance: f64) -> f64 {
        let best = match self.parameter {
            Searched::Linear(place) => self.fitted.solution.linear[place],
            Searched::Nonlinear(_, free) => self.fitted.solution.nonlinear[free],
        };
        best + side * distance * self.error
    }

    /// The farthest distance to look at, in standard errors.
    fn farthest(&self, side: f64) -> f64 {
        let Searched::Nonlinear(place, _) = self.parameter else {
            return FARTHEST;
        };
        let (low, high) = self.fitted.model.parameters[place].bounds;
        let room = if side < 0.0 { self.value(side, 0.0) - low } else { high - self.value(side, 0.0) };
        (room / self.error).min(FARTHEST)
    }

    /// Widens until z exceeds its bound, then closes in by secants, and by regula falsi (Illinois) where those lead nowhere: z is nearly straight
    /// in the parameter. `slope` is how fast it rises at the first distance, if that is known.
    ///
    /// The far end may lie in a valley of its own: places between are looked for from the near one, and from the far one where that leads well
    /// beyond the bound. Where z jumps over its bound, what lies between is not known, and the end counts as open.
    fn meet(
        &self,
        field: &Field<'_>,
        side: f64,
        start: &Reached,
        (first, mut slope): (f64, f64),
        closeness: Closeness,
        effort: &mut Effort<'_>,
    ) -> Result<End, Cancelled> {
        /// Halvings of what is left, if no secant leads anywhere.
        const ROUNDS: usize = 40;
        /// Secants until then.
        const SECANTS: usize = 5;
        /// Share of the bound by which z may miss it, and of what z rises by between two ends by which it may miss their chord.
        const MISSES: f64 = 0.1;
        let (farthest, close) = (self.farthest(side), closeness.share * self.target);
        let slope_of = |one: &Reached, other: &Reached| (other.z - one.z) / (other.distance - one.distance);
        let secant = |from: &Reached, slope: f64| from.distance + (self.target - from.z) / slope;
        let mut near = start.clone();
        let mut far = self.at(field, side, first.min(farthest), &near, closeness, effort)?;
        let mut widened = 0;
        while far.z < self.target - close {
            if far.distance >= farthest {
                return Ok(End::open(far));
            }
            if slope.is_nan() {
                slope = slope_of(&near, &far);
            }
            let least = if widened < SECANTS { 1.0 + closeness.share } else { 1.1 };
            let growth = secant(&far, slope) / far.distance;
            let growth = if growth >= 1.0 { growth.clamp(least, 2.0) } else { 2.0 };
            near = far;
            far = self.at(field, side, (near.distance * growth).min(farthest), &near, closeness, effort)?;
            slope = slope_of(&near, &far);
            widened += 1;
        }
        if far.z - self.target < close && !far.at_edge {
            return Ok(End::met(far, slope));
        }
        // What is missing at the near end, what is over at the far one.
        let (mut missing, mut over) = (self.target - near.z, far.z - self.target);
        let mut next = secant(&far, slope);
        for round in 0..ROUNDS {
            let width = far.distance - near.distance;
            let is_between = near.distance < next && next < far.distance;
            let middle = match round < SECANTS && is_between {
                true => next,
                false => near.distance + missing / (missing + over) * width,
            };
            let mut trial = self.at(field, side, middle, &near, closeness, effort)?;
            if trial.z - self.target > close.max(MISSES * (far.z - near.z)) {
                let other = self.at(field, side, middle, &far, closeness, effort)?;
                trial = if other.z < trial.z { other } else { trial };
            }
            let left = self.target - trial.z;
            let nearest = if far.z - self.target < self.target - near.z { &far } else { &near };
            slope = slope_of(nearest, &trial);
            if width < close * (1.0 + middle) || left.abs() < close {
                let is_met = left.abs() <= MISSES * self.target && !trial.at_edge;
                return Ok(if is_met { End::met(trial, slope) } else { End::open(near) });
            }
            next = secant(&trial, slope);
            if left > 0.0 {
                (near, missing, over) = (trial, left, 0.5 * over);
            } else {
                (far, over, missing) = (trial, -left, 0.5 * missing);
            }
        }
        let is_met = far.z - self.target <= MISSES * self.target && !far.at_edge;
        Ok(if is_met { End::met(far, f64::NAN) } else { End::open(near) })
    }

    /// The profile at a distance in standard errors.
    fn at(
        &self,
        field: &Field<'_>,
        side: f64,
        distance: f64,
        near: &Reached,
        closeness: Closeness,
        effort: &mut Effort<'_>,
    ) -> Result<Reached, Cancelled> {
        let value = self.value(side, distance);
        let model = self.held(value);
        let shapes = model.at(field.times);
        let mut theta = near.nonlinear.clone();
        if let Searched::Nonlinear(_, free) = self.parameter {
            theta.remove(free);
        }
        let ending = Ending::new(closeness.gain, self.most_iterations);
        let point = refine(&shapes, field.target, &theta, ending, effort)?.point;
        let square = point.square + field.inside;
        let at_edge = point.theta.iter().enumerate().any(|(i, value)| {
            let (low, high) = shapes.bounds(i);
            let near = 1e-6 * (high - low);
            *value <= low + near || *value >= high - near
        });
        let mut nonlinear = point.theta.to_vec();
        if let Searched::Nonlinear(_, free) = self.parameter {
            nonlinear.insert(free, value);
        }
        Ok(Reached {
            distance,
            square,
            z: ((square / field.least - 1.0).max(0.0) * self.freedom).sqrt(),
            linear: point.linear.to_vec(),
            nonlinear,
            at_edge,
        })
    }

    /// The model with the parameter held: a nonlinear one fixed, a linear one between equal bounds.
    fn held(&self, value: f64) -> Model {
        let model = &self.fitted.model;
        let (mut parameters, mut bounds) = (model.parameters.clone(), model.linear_bounds.clone());
        match self.parameter {
            Searched::Linear(place) => {
                bounds.resize(model.linear(), (f64::NEG_INFINITY, f64::INFINITY));
                bounds[place] = (value, value);
            }
            Searched::Nonlinear(place, _) => parameters[place].fixed = Some(value),
        }
        Model::new(model.form.clone(), model.constant, parameters, bounds)
    }
}
