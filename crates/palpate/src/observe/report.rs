//! What an observer says after a tick: its state as an observation, and warnings.

use super::signal::Smooth;
use super::{ContactPhase, Held, Normal, Observation, Observer, Slip, SlipForecast};
use crate::grip::TimeToSlip;

/// Slip that cannot be excluded is no warning where the best value is so many times farther than the warning is wanted: in the first moments
/// of a hold nothing can be excluded.
const FALSE_ALARM: f64 = 4.0;

/// Standard deviations of the filtered readings within which they follow a law.
const FOLLOWS: f64 = 5.0;

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
                    (Held::Force, _) => SlipForecast::NEVER,
                    (_, Some(crossing)) => crossing.observed(elapsed),
                    _ => SlipForecast::Unknown,
                });
                // A law by which it slips now does not forecast readings that are clearly above it.
                let is_past = matches!(stated.time_to_slip, Some(SlipForecast::Known { best: TimeToSlip::After(best), .. }) if best <= 0.0);
                let noise = self.observed.force_noise.deviation().unwrap_or(0.0) * Smooth::kept();
                if is_past && stated.force > slip + FOLLOWS * noise {
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
        let noise = self.observed.force_noise.deviation().map(|noise| noise * Smooth::kept());
        // A reading off the place where the jaw stands says nothing of the hold until the next tells whether it was left.
        let is_off = noise.is_some_and(|noise| (force - read).abs() > FOLLOWS * noise);
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

    fn warning(&self, stated: &Observation) -> Slip {
        let Some(slip) = self.options.slip_force else {
            return Slip::None;
        };
        if stated.phase != ContactPhase::Holding {
            return Slip::None;
        }
        let noise = self.observed.force_noise.deviation().unwrap_or(0.0) * Smooth::kept();
        let before = self.observed.hold.map_or(Slip::None, |hold| hold.slip);
        // A warning stays until there is clearly no cause for it any more.
        let early = if before == Slip::None { 1.0 } else { STAYS };
        let margin = if before == Slip::Slipping { 3.0 * noise } else { 0.0 };
        match stated.time_to_slip {
            _ if stated.force <= slip + margin => Slip::Slipping,
            Some(SlipForecast::Known {
                best: TimeToSlip::After(value),
                low: TimeToSlip::After(low),
                ..
            }) if low <= early * self.options.warn_before
                && value <= early * FALSE_ALARM * self.options.warn_before =>
            {
                Slip::Soon
            }
            // Before the first fit there is the margin alone.
            Some(SlipForecast::Unknown) if stated.force - 3.0 * early * noise <= slip => Slip::Soon,
            _ => Slip::None,
        }
    }
}
