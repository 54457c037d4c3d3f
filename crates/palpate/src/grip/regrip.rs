//! When to squeeze again, so that the force stays in a band.

use serde::{Deserialize, Serialize};

use super::{Grip, GripError, above_zero, at_least, beyond, bisected, check, check_duration};
use crate::calibrate::Prediction;
use crate::simulate::ProgramStep;

/// What a schedule should have least of.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", tag = "kind")]
pub enum Regrip {
    /// Moves: each goes to the upper edge of the band, where the pauses are longest.
    FewestMoves {
        /// The shortest pause between two moves, s; 0 for any.
        shortest_pause: f64,
    },
    /// Work: moves go only as far up as pauses of a least length need.
    LeastWork {
        /// The shortest pause between two moves, s; above 0.
        shortest_pause: f64,
    },
}

impl Default for Regrip {
    fn default() -> Self {
        Self::FewestMoves { shortest_pause: 0.0 }
    }
}

/// Forces between which the grasp is kept, N.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Band {
    /// Lower edge.
    pub low: f64,
    /// Upper edge.
    pub high: f64,
}

/// A squeeze of a schedule.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Move {
    /// When it begins, s since first touch.
    pub time: f64,
    /// Displacement before it, m.
    pub from: f64,
    /// Displacement behind it, m.
    pub to: f64,
    /// Force before it, N.
    pub force_from: f64,
    /// Force behind it, N.
    pub force_to: f64,
}

/// Squeezes with pauses between them.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Schedule {
    /// What it has least of.
    pub objective: Regrip,
    /// The band.
    pub band: Band,
    /// The moves, the first squeeze among them.
    pub moves: Vec<Move>,
    /// The steps.
    pub steps: Vec<ProgramStep>,
    /// How long it lasts behind the first squeeze, s.
    pub duration: f64,
    /// Force at its end, N.
    pub end_force: f64,
    /// Displacement at its end, m.
    pub end_displacement: f64,
    /// Work done by the jaws, J.
    pub work: f64,
}

/// Moves that a schedule may have.
const MOST: usize = 60;

/// Upper targets that are tried for the least work.
const TARGETS: u32 = 16;

impl Grip<'_> {
    /// A schedule that keeps the force in a band for `duration` (s) behind the first squeeze; the jaw moves at the speed of the gripper and stands
    /// between moves. A move comes as late as it may: when the force has fallen to the lower edge.
    ///
    /// The higher a move goes, the longer the pause behind it, for the force falls from farther up and the squeeze is deeper: with all moves up to the
    /// upper edge there are fewest of them. Each move lower costs less work and is needed more often; of [`Regrip::LeastWork`] the best of 16 equal
    /// targets between the edges is taken. Pauses, but for the last, are as long as is requested.
    ///
    /// # Errors
    /// [`GripError::Number`] for edges that are none, [`GripError::BeyondLimit`] where band or squeeze go beyond the limits or the body,
    /// [`GripError::BandSlips`] where less is allowed than is needed, [`GripError::TooManyMoves`] beyond 60 moves and where a pause is too short.
    pub fn regrip(&self, band: Band, objective: Regrip, duration: f64) -> Result<Schedule, GripError> {
        check_duration(duration)?;
        above_zero("lower edge of the band", band.low, " N")?;
        let is_above = band.high.is_finite() && band.high > band.low * (1.0 + 1e-6);
        check("upper edge of the band", band.high, " N", "finite and above the lower edge", is_above)?;
        check("time to hold", duration, " s", "finite for a schedule", duration.is_finite())?;
        if let Some(limit) = self.limits.force.filter(|limit| band.high > *limit) {
            return Err(beyond("force", band.high, limit, " N"));
        }
        let found = match objective {
            Regrip::FewestMoves { shortest_pause } => {
                at_least("shortest pause", shortest_pause, 0.0, " s")?;
                self.schedule(band, band.high, objective, duration, shortest_pause)?
            }
            Regrip::LeastWork { shortest_pause } => {
                above_zero("shortest pause", shortest_pause, " s")?;
                let mut best = self.schedule(band, band.high, objective, duration, shortest_pause)?;
                for i in 1..TARGETS {
                    let target = band.low + (band.high - band.low) * f64::from(i) / f64::from(TARGETS);
                    match self.schedule(band, target, objective, duration, shortest_pause) {
                        Ok(found) if found.work < best.work => best = found,
                        Ok(_) | Err(GripError::TooManyMoves { .. }) => {}
                        Err(error) => return Err(error),
                    }
                }
                best
            }
        };
        self.check_reach(found.end_displacement)?;
        let needed = found.moves.iter().map(|made| self.needed_force(made.to)).fold(0.0, f64::max);
        if band.low < needed * (1.0 - 1e-9) {
            return Err(GripError::BandSlips { low: band.low, needed });
        }
        Ok(found)
    }

    /// Its course, with bands.
    ///
    /// # Errors
    /// [`GripError::Simulate`].
    pub fn schedule_course(&self, schedule: &Schedule, samples: usize) -> Result<Prediction, GripError> {
        self.course_of(&schedule.steps, samples)
    }

    fn schedule(
        &self,
        band: Band,
        target: f64,
        objective: Regrip,
        duration: f64,
        shortest: f64,
    ) -> Result<Schedule, GripError> {
        let squeeze = ProgramStep::MoveToForce {
            force: target,
            rate: self.limits.speed,
        };
        let mut steps = vec![squeeze];
        let first = self.ends(&steps).map_err(|error| self.not_carried(target, error))?[0];
        let end = first.time + duration;
        let mut now = first;
        let mut moves = vec![Move {
            time: 0.0,
            from: 0.0,
            to: first.displacement,
            force_from: 0.0,
            force_to: target,
        }];
        loop {
            let left = end - now.time;
            let mut tried = steps.clone();
            let mut after = |pause: f64| -> Result<f64, GripError> {
                tried.truncate(steps.len());
                tried.push(ProgramStep::HoldPosition { duration: pause });
                Ok(self.ends(&tried)?.last().map_or(0.0, |end| end.force))
            };
            if left <= 0.0 {
                break;
            }
            if after(left)? >= band.low {
                steps.push(ProgramStep::HoldPosition { duration: left });
                break;
            }
            let pause = bisected(0.0, left, |pause| Ok(after(pause)? < band.low))?.0;
            if pause <= 0.0 || pause < shortest || moves.len() >= MOST {
                return Err(GripError::TooManyMoves {
                    time: now.time,
                    moves: moves.len(),
                    low: band.low,
                    high: target,
                });
            }
            steps.push(ProgramStep::HoldPosition { duration: pause });
            steps.push(squeeze);
            let ends = self.ends(&steps).map_err(|error| self.not_carried(target, error))?;
            let (before, behind) = (ends[ends.len() - 2], ends[ends.len() - 1]);
            moves.push(Move {
                time: before.time,
                from: before.displacement,
                to: behind.displacement,
                force_from: before.force,
                force_to: behind.force,
            });
            now = behind;
        }
        let last = self.ends(&steps)?.last().copied().unwrap_or(now);
        Ok(Schedule {
            objective,
            band,
            moves,
            work: self.work(&steps)?,
            steps,
            duration,
            end_force: last.force,
            end_displacement: last.displacement,
        })
    }
}
