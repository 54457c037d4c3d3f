//! What a model is fitted to: the motion of the jaw and the force it met.

use std::borrow::Cow;
use std::ops::Range;

use super::range::{HeldSpans, Span};
use super::{CalibrateError, EquilibriumLaw};
use crate::analysis::{AnalysisOptions, Finding, Geometry, Prepared, corrected, measured_motion, signal_findings};
use crate::contact::{Specimen, SpecimenError};
use crate::instrument::Instrument;
use crate::record::Record;
use crate::segment::{HoldMode, Phase, Segment, force_delay, ramps_before};
use crate::simulate::{MeasuredMotion, Motion, Separation};
use crate::statistics::{bounds, median};

/// Samples of force along a motion of the jaw that starts at first touch, ready to be fitted; SI units, loading positive.
#[derive(Debug, Clone, PartialEq)]
pub struct CalibrationData {
    pub(super) geometry: Geometry,
    pub(super) separation: Separation,
    motion: Motion,
    /// How the motion was measured; `None` where it is exact.
    measured: Option<MeasuredMotion>,
    /// The uncertainty of the instrument and of the body.
    instrument: Instrument,
    times: Vec<f64>,
    forces: Vec<f64>,
    /// Samples that are fitted; the rest is held out.
    fitted: usize,
    /// Samples of the record that these were chosen from.
    samples: usize,
    /// Contact displacements (m) at which the jaw was held, rising.
    levels: Vec<f64>,
    /// Spans in which displacement or force was held, in order.
    held: HeldSpans,
    /// What the columns of the record give cause to say.
    findings: Vec<Finding>,
}

/// Samples that are fitted at most; of more, evenly chosen ones.
const MOST_SAMPLES: usize = 20_000;

/// Share of the deepest squeeze that a row of a table stands for at most.
const WIDE: f64 = 0.3;

/// Farthest displacement of the jaw over which a held one, a median of noisy readings, lies at most.
const BEYOND: f64 = 2.0;

/// Share of the deepest squeeze by which two levels differ at least.
const APART: f64 = 0.02;

/// Share of the way on one side of first touch up to which a way on the other is noise.
const NOISE: f64 = 0.02;

/// Refuses a displacement that goes against the direction of loading alone: above first touch there is noise.
fn never_pressed(displacement: &[f64]) -> Result<(), CalibrateError> {
    let (lowest, highest) =
        displacement.iter().fold((0.0, 0.0), |(low, high): (f64, f64), d| (low.min(*d), high.max(*d)));
    if highest < -NOISE * lowest { Err(CalibrateError::NeverPressed { lowest }) } else { Ok(()) }
}

impl CalibrationData {
    /// Forces (N) at rising `times` (s) inside `motion`, whose first knot is at first touch of a relaxed body. `held` are the displacements
    /// of the jaw (m) at which it was held; a table of equilibrium forces has its rows there.
    ///
    /// ```
    /// use palpate::analysis::Geometry;
    /// use palpate::calibrate::CalibrationData;
    /// use palpate::contact::{Shape, Sides};
    /// use palpate::simulate::{ProtocolStep, Separation, protocol};
    /// let motion = protocol(&[ProtocolStep { to: 0.005, rate: 0.5 / 60.0, hold: 10.0 }])?;
    /// let ball = Geometry { shape: Shape::Ball { radius: 0.035 }, sides: Sides::Two, modulus: None, equilibrium: Default::default() };
    /// let times: Vec<f64> = (0..=100).map(|i| 0.1 * f64::from(i)).collect();
    /// let forces = times.iter().map(|t| 1.5 * t.min(0.6)).collect();
    /// let data = CalibrationData::new(ball, Separation::Unilateral, motion, times, forces, &[0.005])?;
    /// assert_eq!(data.times().len(), 101);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`CalibrateError`] for columns of different lengths or without a sample, numbers that are not finite, times that do not rise or lie outside
    /// the motion, held displacements more than twice as far as the jaw goes, and a geometry that is none or that the jaw goes through.
    pub fn new(
        geometry: Geometry,
        separation: Separation,
        motion: Motion,
        times: Vec<f64>,
        forces: Vec<f64>,
        held: &[f64],
    ) -> Result<Self, CalibrateError> {
        if times.len() != forces.len() {
            return Err(CalibrateError::Lengths {
                times: times.len(),
                forces: forces.len(),
            });
        }
        if times.is_empty() {
            return Err(CalibrateError::TooFewSamples {
                samples: 0,
                parameters: 1,
            });
        }
        if let Some(index) = (0..times.len()).find(|i| !(times[*i].is_finite() && forces[*i].is_finite())) {
            return Err(CalibrateError::NotFinite { sample: index + 1 });
        }
        let inside = |time: f64| time >= motion.start() && time <= motion.end();
        let misplaced = |i: &usize| !inside(times[*i]) || (*i > 0 && times[*i] <= times[*i - 1]);
        if let Some(index) = (0..times.len()).find(misplaced) {
            return Err(CalibrateError::SampleTime {
                sample: index + 1,
                found: times[index],
                from: motion.start(),
                until: motion.end(),
            });
        }
        let body = geometry.specimen(geometry.modulus.unwrap_or(1.0))?;
        deep_enough(&body, &motion, separation)?;
        let farthest = motion.displacements().iter().copied().fold(0.0, f64::max);
        if let Some(&found) = held.iter().find(|found| !(found.is_finite() && **found <= BEYOND * farthest)) {
            return Err(CalibrateError::Held { found, farthest });
        }
        let samples = times.len();
        let every = samples.div_ceil(MOST_SAMPLES).max(1);
        let (times, forces): (Vec<f64>, Vec<f64>) = times.into_iter().zip(forces).step_by(every).unzip();
        Ok(Self {
            levels: levels(&body, &motion, held),
            fitted: times.len(),
            geometry,
            separation,
            motion,
            measured: None,
            instrument: Instrument::default(),
            held: HeldSpans::default(),
            findings: Vec::new(),
            times,
            forces,
            samples,
        })
    }

    /// The same from a record: corrected, cut and set to zero at first touch as [`analyze`](crate::analysis::analyze) does.
    ///
    /// # Errors
    /// Those of the corrections; [`CalibrateError::NoDisplacement`] and [`CalibrateError::NoGeometry`] for what has no model.
    pub fn of_record(record: &Record, options: &AnalysisOptions) -> Result<Self, CalibrateError> {
        let geometry = options.geometry.clone().ok_or(CalibrateError::NoGeometry)?;
        let corrected = corrected(record, options)?;
        let prepared = corrected.prepared(options, options.touch)?;
        let mut findings = signal_findings((record, &record.signals()), &corrected, &prepared, options);
        let Prepared {
            record,
            segmentation,
            contact,
        } = prepared;
        let body = geometry.specimen(1.0)?;
        let measured = measured_motion(&record, &segmentation, &contact, &body, options.separation)
            .ok_or(CalibrateError::NoDisplacement)??;
        let displacement = record.displacement().unwrap_or_default();
        never_pressed(displacement)?;
        let levels: Vec<f64> =
            segmentation.holds().map(|hold| median(&mut displacement[hold.start..hold.end].to_vec())).collect();
        let segments = &segmentation.segments;
        let delays = (0..segments.len()).filter_map(|index| force_delay(&record, segments, index));
        let delay = delays.max_by(|a, b| a.time_constant_s.total_cmp(&b.time_constant_s));
        let fades_s = delay.map(|delay| record.time()[delay.settled] - delay.stop_s);
        findings.extend(delay.zip(fades_s).map(|(delay, fades)| Finding::of_delay(&delay, delay.stop_s + fades)));
        findings.extend(between_samples(&record, segments));
        let (times, forces) = (record.time(), record.force());
        let spans = |is_pressed: bool| -> Vec<Span> {
            let holds = segmentation.holds().filter(|hold| (hold.mode == Some(HoldMode::ForceHeld)) == is_pressed);
            holds.map(|hold| (times[hold.start], times[hold.end - 1])).collect()
        };
        let (force, still) = (spans(true), spans(false));
        let motion = measured.motion.clone();
        // Behind a filter the force of a ramp is that of an earlier moment.
        let ramps = segments.iter().filter(|segment| segment.is_ramp());
        let delayed: Vec<Range<f64>> = fades_s
            .map_or_else(Vec::new, |fades| ramps.map(|ramp| times[ramp.start]..times[ramp.end - 1] + fades).collect());
        let (times, forces) = (times.iter().zip(forces))
            .filter(|(time, _)| !delayed.iter().any(|span| span.contains(*time)))
            .unzip();
        Ok(Self {
            measured: Some(measured),
            instrument: options.instrument.with_found(&contact),
            held: HeldSpans {
                force,
                displacement: still,
            },
            findings,
            ..Self::new(geometry, options.separation, motion, times, forces, &levels)?
        })
    }

    /// The same with the uncertainty of the instrument and of the body.
    #[must_use]
    pub fn with_instrument(self, instrument: Instrument) -> Self {
        Self { instrument, ..self }
    }

    /// The same for a law of the equilibrium force: a table begins at first touch, and what noise moves a jaw that is bonded below it, or away
    /// from it and back before the first ramp, counts as standing there.
    pub(super) fn with_law(&self, equilibrium: EquilibriumLaw) -> Cow<'_, Self> {
        let (lowest, highest) = bounds(self.motion.displacements());
        let is_noise = lowest <= 0.0 && lowest >= -NOISE * highest;
        if equilibrium != EquilibriumLaw::Table || self.separation != Separation::Bonded || !is_noise {
            return Cow::Borrowed(self);
        }
        Cow::Owned(Self {
            motion: self.motion.standing_at_touch(NOISE * highest),
            measured: self.measured.clone().map(|measured| measured.standing_at_touch(NOISE * highest)),
            ..self.clone()
        })
    }

    /// The same, fitted up to a time (s) and predicted from there on.
    ///
    /// # Errors
    /// [`CalibrateError::Split`] where either part has fewer than eight samples.
    pub fn fitted_until(mut self, time: f64) -> Result<Self, CalibrateError> {
        const FEWEST: usize = 8;
        let fitted = self.times.partition_point(|at| *at <= time);
        if fitted < FEWEST || self.times.len() - fitted < FEWEST {
            return Err(CalibrateError::Split {
                at: time,
                before: fitted,
                after: self.times.len() - fitted,
            });
        }
        self.fitted = fitted;
        Ok(self)
    }

    /// Number of held displacements in the fitted part; first touch is one where the jaw can pull.
    #[must_use]
    pub fn depths_held(&self) -> usize {
        /// Depths nearer to each other than this share of the deepest are one.
        const NEAR: f64 = 0.05;
        let until = self.times[self.fitted - 1];
        let deepest = self.motion.displacements().iter().copied().fold(0.0, f64::max);
        let motion = self.motion.simplified(0.01 * deepest);
        let mut depths: Vec<f64> = Vec::new();
        for (times, knots) in motion.times().windows(2).zip(motion.displacements().windows(2)) {
            let stands = times[0] < until && (knots[1] - knots[0]).abs() <= 0.02 * deepest;
            let is_pressed = knots[0] > NEAR * deepest || (self.separation == Separation::Bonded && !depths.is_empty());
            if stands && is_pressed && depths.iter().all(|depth| (depth - knots[0]).abs() > NEAR * deepest) {
                depths.push(knots[0]);
            }
        }
        depths.len()
    }

    /// Shape and sides of the body.
    #[must_use]
    pub fn geometry(&self) -> &Geometry {
        &self.geometry
    }

    /// The motion of the jaw.
    #[must_use]
    pub fn motion(&self) -> &Motion {
        &self.motion
    }

    /// How the motion was measured; `None` where it is exact.
    pub(super) fn measured(&self) -> Option<&MeasuredMotion> {
        self.measured.as_ref()
    }

    /// The uncertainty of the instrument and of the body.
    #[must_use]
    pub fn instrument(&self) -> &Instrument {
        &self.instrument
    }

    /// Spans (s) in which displacement or force was held, in order; none in data of no record.
    pub(super) fn held(&self) -> &HeldSpans {
        &self.held
    }

    /// The measured force at a time, N: straight between the samples.
    pub(super) fn force_at(&self, time: f64) -> f64 {
        let after = self.times.partition_point(|sample| *sample < time);
        match (after.checked_sub(1), self.times.get(after)) {
            (Some(before), Some(next)) => {
                let share = (time - self.times[before]) / (next - self.times[before]);
                self.forces[before] + share * (self.forces[after] - self.forces[before])
            }
            (before, _) => self.forces[before.unwrap_or(0)],
        }
    }

    /// What the columns of the record give cause to say, as [`analyze`](crate::analysis::analyze) states it; empty for data of no record.
    #[must_use]
    pub fn findings(&self) -> &[Finding] {
        &self.findings
    }

    /// Times of all samples, s.
    #[must_use]
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// Forces then, N.
    #[must_use]
    pub fn forces(&self) -> &[f64] {
        &self.forces
    }

    /// How many samples, from the first on, are fitted.
    #[must_use]
    pub fn fitted(&self) -> usize {
        self.fitted
    }

    /// Samples of the record that these were evenly chosen from.
    #[must_use]
    pub fn samples(&self) -> usize {
        self.samples
    }

    /// Contact displacements (m) of the rows of a table of equilibrium forces: where the jaw was held, the deepest, and some between
    /// where these are far apart.
    #[must_use]
    pub fn levels(&self) -> &[f64] {
        &self.levels
    }
}

/// Checks that the body is deep enough for the motion.
fn deep_enough(body: &Specimen, motion: &Motion, separation: Separation) -> Result<(), SpecimenError> {
    let bonded = separation == Separation::Bonded;
    motion
        .displacements()
        .iter()
        .try_for_each(|d| body.check_contact_displacement(body.contact_displacement(*d), bonded))
}

/// The held levels that differ, and the deepest place; where these leave wide gaps, places in them, which ramps pass.
fn levels(body: &Specimen, motion: &Motion, held: &[f64]) -> Vec<f64> {
    let share = |d: f64| body.contact_displacement(d);
    // A touch that is fitted moves places a little.
    let deepest = 1.02 * motion.displacements().iter().copied().map(share).fold(0.0, f64::max);
    let mut levels: Vec<f64> = held.iter().copied().map(share).filter(|u| *u > APART * deepest).collect();
    levels.push(deepest);
    levels.sort_by(f64::total_cmp);
    let mut apart: Vec<f64> = Vec::new();
    for level in levels {
        match apart.last_mut() {
            Some(last) if level - *last < APART * deepest => *last = level,
            _ => apart.push(level),
        }
    }
    let mut filled = Vec::new();
    let mut before = 0.0;
    for level in apart {
        let parts = ((level - before) / (WIDE * deepest)).ceil().max(1.0);
        filled.extend((1..parts as u32).map(|part| before + (level - before) * f64::from(part) / parts));
        filled.push(level);
        before = level;
    }
    filled
}

/// [`Finding::RampBetweenSamples`] where the jaw has gone most of its way between two samples.
fn between_samples(record: &Record, segments: &[Segment]) -> Option<Finding> {
    /// Samples of a ramp that say when it began and ended.
    const FEWEST: usize = 2;
    /// Share of the way within which a sample is one of the rest.
    const AT_REST: f64 = 0.02;
    let displacement = record.displacement()?;
    let mut holds = Vec::new();
    let mut number = 0;
    for (index, hold) in segments.iter().enumerate().filter(|(_, segment)| segment.phase == Phase::Hold) {
        number += 1;
        let Some(first) = ramps_before(segments, index).last().map(|ramp| ramp.start) else {
            continue;
        };
        let from = displacement[first.saturating_sub(1)];
        let to = median(&mut displacement[hold.start..hold.end].to_vec());
        let moves = |at: &&f64| (**at - from).abs().min((**at - to).abs()) > AT_REST * (to - from).abs();
        if displacement[first..hold.start].iter().filter(moves).count() < FEWEST {
            holds.push(number);
        }
    }
    (!holds.is_empty()).then(|| Finding::RampBetweenSamples {
        holds,
        interval: record.sample_interval(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_problems::{paper_ball, paper_test_a};

    fn with(times: Vec<f64>, held: &[f64]) -> Result<CalibrationData, CalibrateError> {
        let model = paper_ball(Separation::Unilateral);
        let body = Geometry {
            shape: model.specimen.shape().clone(),
            sides: model.specimen.sides(),
            modulus: None,
            equilibrium: crate::contact::Equilibrium::default(),
        };
        CalibrationData::new(body, model.separation, paper_test_a(), times.clone(), times, held)
    }

    /// No sample made `calibrate` subtract with overflow; an infinite held displacement took 34 GB, and mm for m made 1635 levels.
    #[test]
    fn data_without_a_sample_and_holds_where_no_jaw_was_are_refused() {
        assert!(with(vec![0.0, 1.0], &[0.005, -0.001]).is_ok());
        assert!(matches!(with(Vec::new(), &[]), Err(CalibrateError::TooFewSamples { samples: 0, .. })));
        for held in [f64::INFINITY, f64::NAN, 5.0] {
            assert!(matches!(with(vec![0.0, 1.0], &[held]), Err(CalibrateError::Held { .. })), "{held}");
        }
    }
}
