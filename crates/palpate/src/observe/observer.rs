//! From tick to tick: phase, hold, fit, warning.

use super::filter::ModelFilter;
use super::hold::{Bins, Crossing, FEWEST, HoldFit};
use super::signal::{Alone, Change, Correlation, NoiseMeter, Smooth, Stand};
use super::{Held, Kept, Normal, Observation, ObserveError, ObserverOptions, Slip, kept};
use crate::statistics::coverage_factor;

/// Readings from which on what is made of them may be infinite.
const LARGEST: f64 = 1e302;
/// Noise (standard deviations of one reading) within which a signal stands.
pub(super) const NOISE: f64 = 5.0;
/// Share of its range within which a jaw stands that has no noise.
const SERVO: f64 = 0.001;
/// Share of its range within which a controller holds a force.
const CONTROLLER: f64 = 0.015;
/// Steps of rounded readings within which a signal stands.
const FIGURE: f64 = 1.01;
/// Share of the largest force below which there is no contact, and noise below which there is none.
const OPEN: (f64, f64) = (0.02, 4.0);
/// A jaw, and a force, stand once they would have gone so many tolerances at their last speed. A controller that sets a force goes in
/// steps, and stands between them.
pub(super) const PATIENCE: (f64, f64) = (4.0, 8.0);
/// A force is held once the jaw has gone so far that without a controller, at the mean stiffness so far, it would have risen by so many times
/// [`CONTROLLER`] and so many times what it may fall; or once it has stood for so many times as long as it takes to rise from nothing at its highest
/// speed. The peak of a force whose jaw still comes is as flat, but not for as long.
const BORNE: (f64, f64, f64) = (10.0, 4.0, 8.0);
/// A force gives way once it falls this many times farther than it has before and come back.
const WANDERS: f64 = 1.5;
/// How many times farther than it may wander a force falls before it is on its way: from where it stood, and from where it was on the way, where
/// its place follows it.
pub(super) const FALLS: (f64, f64) = (2.0, 0.8);
/// How many times more patience a jaw needs that slowed down before: one that comes with a lag hardly moves on the last of its way.
const LAG: f64 = 4.0;
/// Tolerances of the force above which a force may be held: below, noise hides how it moves.
const PLAIN: f64 = 2.0;
/// A fit is made again once the hold is longer by this share.
const AGAIN: f64 = 0.04;
/// Fewest readings of a fit.
const READINGS: u32 = 8;

/// What the bytes of an observer begin with.
const FORMAT: [u8; 8] = *b"observe7";

/// A hold that goes on.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Hold {
    pub(super) held: Held,
    pub(super) since: f64,
    /// Filtered force by then, N.
    pub(super) force: f64,
    pub(super) fit: Option<HoldFit>,
    /// Of readings with what the last fit before them predicted.
    correlation: Correlation,
    pub(super) crossing: Option<Crossing>,
    pub(super) creep: Option<Normal>,
    /// Time since the hold began at which the next fit is due, s.
    pub(super) due: f64,
    pub(super) readings: u32,
    /// Of a force that a controller holds, or held: how far it fell and came back, and how far it lies below its place, N.
    pub(super) wanders: Option<(f64, f64)>,
    /// Since when it has been clearly below, s.
    falls_since: Option<f64>,
    /// Whether only a controller can hold the force.
    pub(super) is_borne: bool,
}
kept!(Hold: held, since, force, fit, correlation, crossing, creep, due, readings, wanders, falls_since, is_borne);

impl Hold {
    fn new(held: Held, (since, force): (f64, f64)) -> Self {
        Self {
            held,
            since,
            force,
            wanders: (held == Held::Force).then_some((0.0, 0.0)),
            ..Self::default()
        }
    }

    /// The same with the other variable held since a time (s).
    fn change(&mut self, held: Held, since: f64) {
        let (wanders, is_borne) = (self.wanders, self.is_borne);
        *self = Self::new(held, (since, self.force));
        (self.wanders, self.is_borne) = (wanders.or(self.wanders), is_borne);
    }

    /// Takes how far the force lies below its place, N.
    fn wander(&mut self, below: f64) {
        if let Some((most, now)) = &mut self.wanders {
            if below <= 0.0 {
                *most = most.max(*now);
                *now = 0.0;
            } else {
                *now = now.max(below);
            }
        }
    }
}

/// Watches a contact tick by tick; see [the module](super).
#[derive(Debug, Clone)]
pub struct Observer {
    pub(super) options: ObserverOptions,
    pub(super) observed: Observed,
    pub(super) filter: Option<ModelFilter>,
}

/// All that readings have changed, but for what a material makes of them.
#[derive(Debug, Clone, Default)]
pub(super) struct Observed {
    pub(super) last: Option<f64>,
    pub(super) displacement_noise: NoiseMeter,
    pub(super) force_noise: NoiseMeter,
    pub(super) smooth: Smooth,
    pub(super) jaw: Stand,
    pub(super) grip: Stand,
    /// Least and largest displacement and force that two readings one after the other have reached, m and N: one alone may be none.
    pub(super) reached: [(f64, f64); 2],
    /// The last of each.
    before: [Option<f64>; 2],
    /// The force since the jaw stands, from `relaxes_from` (s) on, and the filtered force by then, N.
    pub(super) relaxation: Bins,
    pub(super) relaxes_from: f64,
    pub(super) relaxes_at: f64,
    /// The displacement since the force stands, and the filtered force by then, N.
    pub(super) creep: Bins,
    pub(super) creeps_at: f64,
    pub(super) displacement_observed: bool,
    pub(super) alone: Alone,
    pub(super) hold: Option<Hold>,
    /// Whether something is held that may slip.
    pub(super) is_gripped: bool,
    /// The warning after the last tick.
    pub(super) slip: Slip,
    /// Readings off a place that the jaw has perhaps not left, kept from the material until the next tells: time (s), and displacement (m) and force (N).
    pub(super) doubted: Option<(f64, (f64, f64))>,
}
kept!(
    Observed: last, displacement_noise, force_noise, smooth, jaw, grip, reached, before, relaxation, relaxes_from, relaxes_at,
    creep, creeps_at, displacement_observed, alone, hold, is_gripped, slip, doubted
);

impl Observer {
    /// An observer without readings.
    ///
    /// # Errors
    /// [`ObserveError::Option`] for an option out of its range, [`ObserveError::LinearMaterial`] for a material that obeys a linear law.
    pub fn new(options: ObserverOptions) -> Result<Self, ObserveError> {
        options.check()?;
        let noise = options.noise;
        let filter = options.material.as_ref().map(|material| ModelFilter::new(material, &options)).transpose()?;
        let observed = Observed {
            displacement_noise: NoiseMeter::new(noise.map(|noise| noise.0)),
            force_noise: NoiseMeter::new(noise.map(|noise| noise.1)),
            reached: [(f64::INFINITY, f64::NEG_INFINITY); 2],
            ..Observed::default()
        };
        Ok(Self {
            options,
            observed,
            filter,
        })
    }

    /// Takes the readings at `time` (s): the displacement of the jaw (m, growing as it closes; `None` where there is no reading) and the
    /// force (N, above 0 as the jaw presses), and returns the observation.
    ///
    /// Most ticks cost well under a microsecond; those on which a hold is fitted anew, each time it has become 4 % longer, some hundred, and
    /// three times that where the exponent has a standard error. The step does not allocate, and the observer has a constant size.
    ///
    /// # Errors
    /// [`ObserveError::NotFinite`], [`ObserveError::TimeNotRising`] and, with a material, [`ObserveError::Displacement`]; the observer is then
    /// as before.
    pub fn feed(&mut self, time: f64, displacement: Option<f64>, force: f64) -> Result<Observation, ObserveError> {
        self.check(time, displacement, force)?;
        let dt = self.observed.last.map_or(0.0, |last| time - last);
        self.observed.last = Some(time);
        self.observed.force_noise.feed(time, force);
        self.observed.smooth.feed(dt, force, self.observed.force_noise.deviation());
        self.observed.reach(1, force);
        if let Some(displacement) = displacement {
            self.observed.displacement_noise.feed(time, displacement);
            self.observed.reach(0, displacement);
            self.observed.displacement_observed = true;
        }
        let began = self.follow(time, displacement, force);
        if let Some(displacement) = displacement {
            self.believe(time, displacement, force);
        }
        if !self.observed.jaw.is_doubtful() {
            self.fit(time);
        }
        let stated = self.say(time, began);
        self.observed.slip = stated.slip;
        Ok(stated)
    }

    /// What a material says of readings, but for one that is off the place where the jaw stands: the hold is reported from there until the next
    /// reading says whether it was left.
    fn believe(&mut self, time: f64, displacement: f64, force: f64) {
        let Some(filter) = &mut self.filter else { return };
        if self.observed.jaw.is_doubtful() {
            self.observed.doubted = Some((time, (displacement, force)));
            return;
        }
        let noise = self.observed.displacement_noise.deviation().zip(self.observed.force_noise.deviation());
        let of_jaw = noise.map_or(0.0, |noise| noise.0);
        let mut feed = |time: f64, displacement: f64, force: f64| {
            filter.feed(time, self.observed.jaw.at(displacement, of_jaw), force, noise);
        };
        if let Some((time, (displacement, force))) = self.observed.doubted.take()
            && !self.observed.jaw.stands
        {
            feed(time, displacement, force);
        }
        feed(time, displacement, force);
    }

    /// The material, once it has observed where the jaw is.
    pub(super) fn informed(&self) -> Option<&ModelFilter> {
        self.filter.as_ref().filter(|filter| self.observed.displacement_observed && filter.is_met())
    }

    /// Its options.
    #[must_use]
    pub fn options(&self) -> &ObserverOptions {
        &self.options
    }

    /// All that readings have changed, to send an observer elsewhere; [`from_bytes`](Self::from_bytes) goes on with it to the last bit.
    #[must_use]
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = FORMAT.to_vec();
        self.observed.keep(&mut bytes);
        if let Some(filter) = &self.filter {
            filter.keep(&mut bytes);
        }
        bytes
    }

    /// An observer that goes on where the one of [`to_bytes`](Self::to_bytes) was, which had the same options.
    ///
    /// # Errors
    /// As for [`new`](Self::new), and [`ObserveError::Bytes`] for bytes that come from no such observer.
    pub fn from_bytes(options: ObserverOptions, bytes: &[u8]) -> Result<Self, ObserveError> {
        let mut observer = Self::new(options)?;
        let mut from = bytes.strip_prefix(&FORMAT).ok_or(ObserveError::Bytes)?;
        observer.read(&mut from).filter(|()| from.is_empty()).ok_or(ObserveError::Bytes)?;
        Ok(observer)
    }

    fn read(&mut self, from: &mut &[u8]) -> Option<()> {
        self.observed = Kept::read(from)?;
        self.filter.as_mut().map_or(Some(()), |filter| filter.read(from))
    }

    fn check(&self, time: f64, displacement: Option<f64>, force: f64) -> Result<(), ObserveError> {
        let place = self.observed.last.unwrap_or(0.0);
        let readings =
            [("time", place, time), ("displacement", time, displacement.unwrap_or(0.0)), ("force", time, force)];
        for (what, at, found) in readings {
            if found.is_nan() || found.abs() >= LARGEST {
                return Err(ObserveError::NotFinite { what, time: at, found });
            }
        }
        match self.observed.last {
            Some(last) if time <= last => return Err(ObserveError::TimeNotRising { last, found: time }),
            _ => {}
        }
        match (&self.filter, displacement) {
            (Some(filter), Some(displacement)) => filter.check(time, displacement),
            _ => Ok(()),
        }
    }

    /// Brings the stands and the hold up to date; true where a hold began.
    fn follow(&mut self, time: f64, displacement: Option<f64>, force: f64) -> bool {
        let tolerance = |meter: &NoiseMeter, reached: (f64, f64), share: f64| {
            let noise = meter.deviation()?;
            Some(
                (NOISE * noise)
                    .max(share * (reached.1 - reached.0))
                    .max(FIGURE * meter.quantum().min(reached.1 - reached.0)),
            )
        };
        let jaw_tolerance = tolerance(&self.observed.displacement_noise, self.observed.reached[0], SERVO);
        let force_tolerance = tolerance(&self.observed.force_noise, self.observed.reached[1], CONTROLLER);
        let grip = self.observed.grip.feed(time, force, force_tolerance, PATIENCE.1);
        if matches!(grip, Change::Moved | Change::Left | Change::Crept) {
            self.observed.creep.clear();
            self.observed.creeps_at = self.observed.smooth.level;
        } else if let Some(displacement) = displacement {
            self.observed.creep.push(time - self.observed.grip.start, displacement);
        }
        let is_free = self.observed.hold.as_ref().is_none_or(|hold| hold.held == Held::Force && !hold.is_borne);
        let lags = is_free && self.observed.jaw.slowed();
        let patience = if lags { LAG * PATIENCE.0 } else { PATIENCE.0 };
        let jaw = match displacement {
            Some(displacement) => self.observed.jaw.feed(time, displacement, jaw_tolerance, patience),
            None if self.observed.displacement_observed => Change::Same,
            None => {
                let tolerance = self.observed.force_noise.deviation().map(|noise| NOISE * noise);
                let off = tolerance.zip(self.observed.hold.and_then(|hold| hold.fit)).map(|(tolerance, fit)| {
                    let elapsed = time - self.observed.relaxes_from;
                    if (force - fit.force(elapsed)).abs() <= tolerance {
                        return 0.0;
                    }
                    let (low, high) = fit.interval(elapsed);
                    (force - force.clamp(low, high)) / tolerance
                });
                let tolerance = tolerance.map(|tolerance| tolerance * Smooth::kept());
                self.observed.alone.feed(time, self.observed.smooth.level, tolerance, off)
            }
        };
        let arrives = jaw_tolerance.is_some_and(|tolerance| {
            self.observed.jaw.arrives(time, if lags { patience * tolerance } else { tolerance })
        });
        if matches!(jaw, Change::Moved | Change::Left | Change::Crept) || arrives || self.is_open() {
            // The first readings at a place may still belong to the way there.
            self.observed.relaxation.clear();
            (self.observed.relaxes_from, self.observed.relaxes_at) = (time, self.observed.smooth.level);
        } else if !self.observed.jaw.is_doubtful() {
            let elapsed = time - self.observed.relaxes_from;
            if !self.observed.smooth.is_doubtful {
                self.observed.relaxation.push(elapsed, force);
            }
            if let Some(hold) = &mut self.observed.hold
                && let Some(fit) = &hold.fit
            {
                hold.correlation.feed(force - fit.force(elapsed));
            }
        }
        let reported = force_tolerance.is_some_and(|tolerance| self.observed.smooth.level.abs() > PLAIN * tolerance);
        self.settle(time);
        let began = self.begin_or_end(jaw, grip, reported);
        self.grip(jaw_tolerance, reported);
        began
    }

    /// A force that fell from its place, and rests, has another: a controller was set to it, or overshot.
    fn settle(&mut self, time: f64) {
        let level = self.observed.smooth.level;
        let Some(hold) = self.observed.hold.as_ref().filter(|hold| hold.wanders.is_some()) else {
            return;
        };
        let (falls, since) = (self.falls(), hold.falls_since.unwrap_or(time));
        let rests = falls && hold.is_borne && self.has_stood(since, time);
        // A force that still rises is not held yet.
        let rises = !hold.is_borne && self.observed.grip.below(level) < -self.allowance();
        if rests || rises {
            self.observed.grip.settle(time, level);
            self.observed.creep.clear();
        }
        let is_borne = hold.is_borne || (!falls && self.is_borne(time));
        if let Some(hold) = &mut self.observed.hold {
            hold.is_borne = is_borne;
            hold.wander(self.observed.grip.below(level));
            hold.falls_since = (falls && !rests).then_some(since);
        }
    }

    /// `reported` is whether the force is large enough for its standing still to mean anything.
    fn begin_or_end(&mut self, jaw: Change, grip: Change, reported: bool) -> bool {
        let jaw_stands = self.observed.displacement_observed && self.observed.jaw.stands;
        let stands = jaw_stands || (!self.observed.displacement_observed && self.observed.alone.stands && reported);
        // A controller that lets the force wander moves the jaw.
        let lets_go = self.observed.relaxes_at - self.observed.smooth.level > self.allowance();
        let gives_way = |hold: &Hold| hold.falls_since.is_some() && (lets_go || !hold.is_borne);
        if let Some(hold) = &mut self.observed.hold {
            hold.readings = hold.readings.saturating_add(1);
            let goes_on = match hold.held {
                // The controller that held the force takes it up again: that it gave way was how it wanders.
                Held::Displacement if hold.wanders.is_some() && jaw != Change::Same && self.observed.grip.stands => {
                    hold.change(Held::Force, self.observed.grip.start);
                    hold.wander(0.0);
                    true
                }
                Held::Displacement if jaw == Change::Crept && self.observed.grip.stands => {
                    *hold = Hold::new(Held::Force, (self.observed.grip.start, self.observed.creeps_at));
                    true
                }
                Held::Displacement => !matches!(jaw, Change::Left | Change::Crept),
                // The force gives way, the jaw does not: since it stands, the displacement has been held.
                Held::Force if jaw_stands && (gives_way(hold) || grip != Change::Same) => {
                    hold.change(Held::Displacement, self.observed.jaw.start);
                    true
                }
                Held::Force => grip == Change::Same,
            };
            if !goes_on || self.is_open() {
                self.observed.hold = None;
            }
            return false;
        }
        // A reading off the place where the jaw stood may be the first of a ramp.
        if self.is_open() || self.observed.jaw.is_doubtful() {
            return false;
        }
        self.observed.hold = if stands {
            Some(Hold::new(Held::Displacement, (self.observed.relaxes_from, self.observed.relaxes_at)))
        } else if self.observed.displacement_observed
            && self.observed.grip.stands
            && self.observed.jaw.slowed()
            && reported
        {
            Some(Hold::new(Held::Force, (self.observed.grip.start, self.observed.creeps_at)))
        } else {
            None
        };
        self.observed.hold.is_some()
    }

    /// Whether the force stood for so long, or though the jaw went on so far, that only a controller can have held it.
    fn is_borne(&self, time: f64) -> bool {
        let [(least, most), (weakest, strongest)] = self.observed.reached;
        let creep = self.observed.creep.as_slice();
        let gone = creep.first().zip(creep.last()).map_or(0.0, |(first, last)| last.value - first.value);
        let (allowance, level) = (self.allowance(), self.observed.smooth.level);
        let steady = self.observed.grip.below(level).abs() <= allowance;
        let far = (BORNE.0 * CONTROLLER * (strongest - weakest)).max(BORNE.1 * allowance);
        (steady && gone * (strongest - weakest) > far * (most - least))
            || self.has_stood(self.observed.grip.start, time)
    }

    /// Whether a time is so long ago that a force that stood since then is held.
    fn has_stood(&self, since: f64, time: f64) -> bool {
        self.observed.grip.would_have_gone(since, time) > BORNE.2 * self.observed.smooth.level.abs()
    }

    /// How far a filtered force may fall and still be held, N: by its noise, or as a controller lets it.
    pub(super) fn allowance(&self) -> f64 {
        let (weakest, strongest) = self.observed.reached[1];
        let range = strongest - weakest;
        let wanders = self.observed.hold.as_ref().and_then(|hold| hold.wanders).map_or(0.0, |wanders| wanders.0);
        self.margin()
            .max(CONTROLLER * range)
            .max(FIGURE * self.observed.force_noise.quantum().min(range))
            .max(WANDERS * wanders)
    }

    /// Whether the force has fallen from where it stood.
    pub(super) fn falls(&self) -> bool {
        self.observed.grip.stands && self.observed.grip.below(self.observed.smooth.level) > self.allowance()
    }

    /// Whether there is no contact.
    pub(super) fn is_open(&self) -> bool {
        let Some(noise) = self.observed.force_noise.deviation() else {
            return true;
        };
        let noise = noise * Smooth::kept();
        let largest = self.observed.reached[1].1.abs().max(self.observed.reached[1].0.abs());
        let edge = (OPEN.0 * largest).max(OPEN.1 * noise);
        // What is held has to fall further to be lost.
        self.observed.smooth.level.abs() <= if self.observed.hold.is_some() { 0.5 * edge } else { edge }
    }

    fn fit(&mut self, time: f64) {
        let Some(mut hold) = self.observed.hold else { return };
        let from = if hold.held == Held::Displacement { self.observed.relaxes_from } else { self.observed.grip.start };
        let elapsed = time - from;
        if elapsed < hold.due {
            return;
        }
        if hold.held == Held::Force {
            hold.creep = self.observed.creep.late_slope();
            hold.due = (1.0 + AGAIN) * elapsed;
            self.observed.hold = Some(hold);
            return;
        }
        let slip = self.options.slip_force;
        let by_material = self.informed().zip(slip).map(|(filter, slip)| {
            let factor = coverage_factor(self.options.confidence, filter.freedom);
            Crossing::find(elapsed, slip, |time| {
                let force = filter.force_after(time - elapsed);
                let half = factor * force.deviation;
                (force.mean - half, force.mean, force.mean + half)
            })
        });
        hold.due = (1.0 + AGAIN) * elapsed;
        let bins = self.observed.relaxation.as_slice();
        let readings: f64 = bins.iter().map(|bin| bin.count).sum();
        if let Some(noise) = self.observed.force_noise.deviation()
            && bins.len() > FEWEST
            && readings >= f64::from(READINGS)
        {
            let confidence = self.options.confidence;
            let exponent = self.filter.as_ref().map_or(
                Normal::new(self.options.exponent, self.options.exponent_standard_error),
                ModelFilter::exponent,
            );
            let factor = |freedom| coverage_factor(confidence, freedom);
            hold.fit = HoldFit::new(bins, exponent, noise, hold.correlation.long_run_variance(), factor);
        } else {
            // Every tick, until there are enough.
            hold.due = elapsed;
        }
        let by_itself = hold.fit.zip(slip).map(|(fit, slip)| {
            Crossing::find(elapsed, slip, |time| {
                let (low, high) = fit.interval(time);
                (low, fit.force(time), high)
            })
        });
        // What a material tells of a hold it tells at once; what the hold tells of itself becomes the sharper of the two.
        hold.crossing = match (by_material, by_itself) {
            (Some(material), Some(itself)) if itself.width(elapsed) < material.width(elapsed) => Some(itself),
            (material, itself) => material.or(itself),
        };
        self.observed.hold = Some(hold);
    }
}

impl Observed {
    fn reach(&mut self, column: usize, value: f64) {
        let before = self.before[column].replace(value).unwrap_or(value);
        let (least, most) = self.reached[column];
        self.reached[column] = (least.min(before.max(value)), most.max(before.min(value)));
    }
}
