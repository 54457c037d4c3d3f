//! What an observer says after a tick: its state as an observation, and warnings.

use super::observer::{FALLS, NOISE, PATIENCE};
use super::signal::Smooth;
use super::{ContactPhase, Held, Normal, Observation, Observer, Slip, SlipForecast};
use crate::grip::TimeToSlip;

/// Slip that cannot be excluded is no warning where the best value is so many times farther than the warning is wanted: in the first moments
/// of a hold nothing can be excluded.
const FALSE_ALARM: f64 = 2.0;

/// Nor where it is so many times farther than the hold has lasted: the best value of the first moments changes by as much with every few readings.
const REACHES: f64 = 10.0;

/// How many times longer the time to slip has to be for a warning to be taken back.
const STAYS: f64 = 2.0;

impl Observer {
    /// What is stated after the tick at `time` (s).
    pub(super) fn say(&self, time: f64, began: bool) -> Observation {
        let phase = match &self.observed.hold {
            Some(_) => ContactPhase::Holding,
            None if self.is_open() => ContactPhase::Free,
            None if self.direction() < 0.0 => ContactPhase::Unloading,
            None => ContactPhase::Loading,
        };
        let mut stated = Observation {
            time,
            phase,
            began,
            force: self.observed.smooth.level,
            time_to_slip: self.options.slip_force.map(|_| SlipForecast::Unknown),
            ..Observation::default()
        };
        if let Some(hold) = &self.observed.hold {
            stated.held = Some(hold.held);
            stated.held_since = Some(hold.since);
            stated.held_force = Some(hold.force);
            stated.creep_rate = hold.creep.map(Into::into);
            let elapsed = time - self.observed.relaxes_from;
            if let Some(fit) = &hold.fit {
                stated.force = fit.force(elapsed);
                let equilibrium = fit.equilibrium();
                stated.equilibrium_force = equilibrium.map(Into::into);
                stated.excess_force = equilibrium
                    .map(|equilibrium| Normal::new(stated.force - equilibrium.mean, equilibrium.deviation).into());
                stated.relative_rate = fit.relaxes().then(|| fit.relative_rate(elapsed));
            }
            self.say_filtered(&mut stated, hold.held);
            stated.force = self.as_read(stated.force);
            if let Some(slip) = self.options.slip_force {
                stated.time_to_slip = Some(match (hold.held, hold.crossing) {
                    // Whether a force is held that may be at its peak, or has begun to fall, has yet to show.
                    (Held::Force, _) if !hold.is_borne || self.falls() => SlipForecast::Unknown,
                    (Held::Force, _) => SlipForecast::NEVER,
                    (_, Some(crossing)) => crossing.observed(elapsed),
                    _ => SlipForecast::Unknown,
                });
                // A law by which it slips now does not forecast readings that are clearly above it.
                let is_past = matches!(stated.time_to_slip, Some(SlipForecast::Known { best: TimeToSlip::After(best), .. }) if best <= 0.0);
                if is_past && stated.force > slip + self.margin() {
                    stated.time_to_slip = Some(SlipForecast::Unknown);
                }
            }
        }
        stated.slip = self.warning(&stated);
        stated
    }

    /// The force of a law or a material, if the readings follow it; else that of the readings.
    fn as_read(&self, force: f64) -> f64 {
        let read = self.observed.smooth.level;
        // A reading off the place where the jaw stands says nothing of the hold until the next tells whether it was left.
        let is_off = self.observed.force_noise.deviation().is_some() && (force - read).abs() > self.margin();
        if is_off && !self.observed.jaw.is_doubtful() { read } else { force }
    }

    /// What a material tells of a hold, where the forces are its.
    fn say_filtered(&self, stated: &mut Observation, held: Held) {
        let Some(filter) = self.informed() else { return };
        stated.excess_strain = Some(filter.excess_strain().into());
        let equilibrium = filter.equilibrium();
        let itself = stated.equilibrium_force.and_then(|itself| itself.standard_error);
        if itself.is_some_and(|itself| equilibrium.deviation > itself) {
            return;
        }
        stated.excess_force = Some(filter.excess_force().into());
        stated.relative_rate = Some(filter.relative_rate());
        if held == Held::Displacement {
            stated.equilibrium_force = Some(equilibrium.into());
            stated.force = filter.force_after(0.0).mean;
        }
    }

    fn direction(&self) -> f64 {
        if self.observed.displacement_observed {
            self.observed.jaw.direction
        } else {
            self.observed.grip.direction
        }
    }

    /// Whether something is held that may slip: its force was clearly above noise and the force of slip, or a jaw that came holds it. A
    /// weak force alone may be a drift of its zero.
    ///
    /// It is let go where the force ends as the jaw moves; where it ends though the jaw stands, what was held is lost.
    pub(super) fn grip(&mut self, jaw_tolerance: Option<f64>, reported: bool) {
        let observed = &self.observed;
        if self.is_open() && !observed.jaw.stands {
            self.observed.is_gripped = false;
            return;
        }
        let travel = observed.reached[0].1 - observed.reached[0].0;
        let came =
            observed.jaw.direction > 0.0 && jaw_tolerance.is_some_and(|tolerance| travel > PATIENCE.0 * tolerance);
        let enough = self.options.slip_force.is_some_and(|slip| observed.smooth.level > slip + self.margin());
        self.observed.is_gripped |= reported && (enough || (came && observed.hold.is_some()));
    }

    /// How far a filtered force has to be from another to differ clearly, N.
    pub(super) fn margin(&self) -> f64 {
        NOISE * self.observed.force_noise.deviation().unwrap_or(0.0) * Smooth::kept()
    }

    /// Whether the force, falling on as it does while the jaw does not open, is at that of slip within `soon` (s). A force that begins to fall may
    /// only wander.
    fn falls_to(&self, slip: f64, time: f64, soon: f64) -> bool {
        let (observed, level) = (&self.observed, self.observed.smooth.level);
        let far = if observed.grip.stands { FALLS.0 } else { FALLS.1 };
        let allowance = self.allowance();
        let falls = observed.slip == Slip::Soon || observed.grip.below(level) > far * allowance;
        falls && observed.jaw.direction > 0.0 && level - soon * observed.grip.fall_rate(time, level, allowance) <= slip
    }

    fn warning(&self, stated: &Observation) -> Slip {
        let Some(slip) = self.options.slip_force else {
            return Slip::None;
        };
        if !self.observed.is_gripped {
            return Slip::None;
        }
        let noise = self.observed.force_noise.deviation().unwrap_or(0.0) * Smooth::kept();
        let before = self.observed.slip;
        // A warning stays until there is clearly no cause for it any more.
        let early = if before == Slip::None { 1.0 } else { STAYS };
        let margin = if before == Slip::Slipping { self.margin() } else { 0.0 };
        let near = (FALSE_ALARM * self.options.warn_before).min(REACHES * (stated.time - self.observed.relaxes_from));
        match stated.time_to_slip {
            _ if stated.force <= slip + margin => Slip::Slipping,
            // A force that falls though the jaw does not open, with no hold yet whose law tells more.
            None | Some(SlipForecast::Unknown)
                if (stated.held != Some(Held::Displacement) || before == Slip::Soon)
                    && self.falls_to(slip, stated.time, early * FALSE_ALARM * self.options.warn_before) =>
            {
                Slip::Soon
            }
            // Any other is of a hold.
            _ if stated.held.is_none() => Slip::None,
            Some(SlipForecast::Known {
                best: TimeToSlip::After(value),
                low: TimeToSlip::After(low),
                ..
            }) if low <= early * self.options.warn_before && value <= early * near => Slip::Soon,
            // Before the first fit there is the margin alone.
            Some(SlipForecast::Unknown) if stated.force - 3.0 * early * noise <= slip => Slip::Soon,
            _ => Slip::None,
        }
    }
}
