//! Holds of constant force: the displacement creeps.

use super::compared::{add_forecasts, comparison_findings, recommended};
use super::drive::drive_changes;
use super::end_value::{beyond_original, extrapolated, original_displacement};
use super::imposed::imposed_force;
use crate::analysis::finding::Finding;
use crate::fit::{LawOptions, Samples, fitted};
use crate::forecast::{CompareOptions, Comparison, RampChoice, Reservation, compare_laws_watched};
use crate::laws::Response;
use crate::record::{Record, RecordError};
use crate::segment::{
    After, GivenHold, HoldMode, Phase, Segment, SegmentError, SegmentOptions, Segmentation, creeps, phases_watched,
    stands_in,
};
use crate::simulate::Separation;
use crate::statistics::{median, noise, range};
use crate::watch::{Cancelled, Watch};

/// One hold of constant force, with the laws of creep compared on it.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct CreepHold {
    /// Number of the hold in the record, from 1.
    pub number: usize,
    /// Time of its first sample, s.
    pub start: f64,
    /// Time of its last sample, s.
    pub end: f64,
    /// Time from which the laws are fitted, s.
    pub fit_start: f64,
    /// Force (median), N.
    pub force: f64,
    /// Whether the force had grown or fallen before.
    pub after: Option<After>,
    /// Times since the start of the fit, s.
    pub times: Vec<f64>,
    /// Displacement at those times, m.
    pub displacement: Vec<f64>,
    /// Laws compared; `None` where nothing could be fitted.
    pub comparison: Option<Comparison>,
    /// What to know about this hold.
    pub findings: Vec<Finding>,
}

/// Why a record holds no creep.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CreepError {
    /// The watch ended the work.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// No displacement was recorded.
    #[error("creep is displacement at constant force, but the record has no displacement")]
    NoDisplacement,
    /// A displacement that never changes.
    #[error("the displacement cannot creep: {0}")]
    Still(RecordError),
    /// Where the force stays, the displacement stays, too.
    #[error("no hold found in which the force is constant and the displacement changes by more than its noise")]
    DisplacementHeld,
    /// No hold of constant force.
    #[error("of the force: {0}")]
    Segment(SegmentError),
    /// Limits that make no hold.
    #[error(transparent)]
    Given(SegmentError),
}

impl CreepError {
    /// A remedy; options stand between `⟨` and `⟩`, for each interface to spell.
    #[must_use]
    pub fn hint(&self) -> &'static str {
        match self {
            Self::NoDisplacement | Self::Still(_) => "name the displacement under columns.displacement",
            Self::Cancelled(_) => "",
            Self::Given(error) => error.hint(),
            Self::DisplacementHeld | Self::Segment(_) => {
                "where the force drifts, give the hold (phases.hold in the test description); without ⟨creep⟩ palpate fits holds of constant \
                 displacement"
            }
        }
    }
}

/// Share of the range of the force by which it may stray from its level and count as held.
const RINGING: f64 = 0.02;

/// The same error in the words of the column that was searched.
fn of_force(error: SegmentError) -> CreepError {
    CreepError::Segment(match error {
        SegmentError::NoMotion { range, noise, .. } => SegmentError::NoMotion {
            column: "force",
            range,
            noise,
            unit: "N",
        },
        other => other,
    })
}

/// Holds of constant force: of given ones all but those in which the displacement is held; else, where the force is held in one, the same of those
/// that are found; or else all in which the force stays, or at last both move. All phases, and which of them.
fn force_held(
    record: &Record,
    exchanged: &Record,
    segment: &SegmentOptions,
    given: &[GivenHold],
    watch: &mut dyn Watch,
) -> Result<(Vec<Segment>, Vec<usize>), CreepError> {
    let mut phases = |record: &Record, segment: &SegmentOptions, given: &[GivenHold]| {
        SegmentError::unless_cancelled(phases_watched(record, segment, given, watch))
    };
    if !given.is_empty() {
        let found = phases(record, segment, given)?.map_err(CreepError::Given)?;
        return creeping(found, |hold| hold.mode != Some(HoldMode::DisplacementHeld));
    }
    let held = |segment: &Segment| segment.mode == Some(HoldMode::ForceHeld);
    let observed = phases(record, segment, &[])?.ok();
    let is_any_held = observed.as_ref().is_some_and(|observed| observed.holds().any(held));
    // A force that drifts is held badly, and that is stated.
    let observed = observed.map(|found| creeping(found, |hold| hold.mode != Some(HoldMode::DisplacementHeld)));
    if let Some(observed) = observed.clone().filter(|_| is_any_held) {
        return observed;
    }
    // The tolerance of a test is a length; a controller that rings about its set force still holds it.
    let exchanged_options = SegmentOptions {
        tolerance: Some(RINGING * range(record.force())),
        ..*segment
    };
    let found = match phases(exchanged, &exchanged_options, &[])? {
        // Who asks for creep, and has a force that stays throughout, means the whole record.
        Err(SegmentError::NoMotion { .. }) if is_pressed_throughout(record) => {
            let (from, to) = (record.time()[0], record.time()[record.len() - 1]);
            let mode = Some(HoldMode::ForceHeld);
            phases(record, &exchanged_options, &[GivenHold { from, to, mode }])?
        }
        found => found,
    };
    let creeping_holds = found.iter().flat_map(Segmentation::holds).map(|hold| (hold.start, hold.end));
    let creeping_holds = creeping_holds.filter(|(start, end)| creeps(record, *start, *end)).collect();
    let rests = stands_in(record, creeping_holds, segment, watch)?;
    let found = found.map_err(of_force).and_then(|found| {
        creeping(found, |hold| creeps(record, hold.start, hold.end) && !rests.contains(&(hold.start, hold.end)))
    });
    found.or_else(|error| observed.and_then(Result::ok).ok_or(error))
}

/// Whether a force stays from the first sample to the last, and is one, while the displacement moves.
fn is_pressed_throughout(record: &Record) -> bool {
    let level = median(&mut record.force().to_vec()).abs();
    let moves = record.displacement().is_some_and(|displacement| range(displacement) > 10.0 * noise(displacement));
    moves && level > 0.0 && range(record.force()) <= RINGING * level
}

/// All phases, and the holds of them that are a creep.
fn creeping(
    found: Segmentation,
    is_creep: impl Fn(&Segment) -> bool,
) -> Result<(Vec<Segment>, Vec<usize>), CreepError> {
    let segments = found.segments;
    let is_held = |index: &usize| segments[*index].phase == Phase::Hold && is_creep(&segments[*index]);
    let held: Vec<usize> = (0..segments.len()).filter(is_held).collect();
    if held.is_empty() { Err(CreepError::DisplacementHeld) } else { Ok((segments, held)) }
}

/// Finds the holds of constant force in a record and compares laws of creep on the displacement of each.
///
/// Where holds are `given` they are those, less any whose mode is [`HoldMode::DisplacementHeld`]. Else, where one is found whose mode
/// is [`HoldMode::ForceHeld`], they are those found, less the same. Where there is none, phases are found as for a squeeze, with force and displacement exchanged: the
/// force is what the machine holds, to a fiftieth of its range, whatever tolerance `segment` has. `until` (s) limits how much of
/// each hold is fitted.
///
/// ```
/// use palpate::analysis::creep_holds;
/// use palpate::forecast::CompareOptions;
/// use palpate::record::Record;
/// use palpate::segment::SegmentOptions;
/// // 6 N reached in 1 s and held, while the jaw goes on by 0.3 mm with a time of 5 s
/// let time: Vec<f64> = (0..600).map(|i| 0.05 * f64::from(i)).collect();
/// let force: Vec<f64> = time.iter().map(|t| 6.0 * t.min(1.0)).collect();
/// let jaw: Vec<f64> = time.iter().map(|t| 1e-3 * t.min(1.0) + 3e-4 * (1.0 - (-(t - 1.0f64).max(0.0) / 5.0).exp())).collect();
/// let record = Record::new(time, Some(jaw), force)?;
/// # use palpate::watch::Unwatched;
/// let holds = creep_holds(&record, (&SegmentOptions::default(), &[]), &CompareOptions::default(), None, &mut Unwatched)?;
/// assert_eq!(holds.len(), 1);
/// assert!((holds[0].force - 6.0).abs() < 1e-9);
/// let best = &holds[0].comparison.as_ref().unwrap().verdict.as_ref().unwrap().law;
/// assert_eq!(best.to_string(), "standard-linear-solid");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`CreepError`] for a record without displacement, or without a hold of constant force.
pub fn creep_holds(
    record: &Record,
    (segment, given): (&SegmentOptions, &[GivenHold]),
    compare: &CompareOptions,
    until: Option<f64>,
    watch: &mut dyn Watch,
) -> Result<Vec<CreepHold>, CreepError> {
    let record = record.repaired();
    let exchanged = record.exchanged().ok_or(CreepError::NoDisplacement)?.map_err(CreepError::Still)?;
    let (segments, held) = force_held(&record, &exchanged, segment, given, watch)?;
    let mut each = compare.clone();
    each.fit.response = Response::Creep;
    // All holds are forecast together.
    each.forecast = false;
    let time = exchanged.time();
    let until = |times: &[f64]| until.map_or(times.len(), |until| times.partition_point(|t| *t <= until));
    let is_measured = compare.ramps == RampChoice::Measured;
    let fits: Vec<LawOptions> = held
        .iter()
        .map(|place| {
            let loading = is_measured.then(|| imposed_force(&record, &segments, *place, Separation::Unilateral));
            LawOptions {
                loading: loading.flatten().or(each.fit.loading.clone()),
                ..each.fit.clone()
            }
        })
        .collect();
    let original = original_displacement(&record);
    let holds = held.iter().enumerate().map(|(index, place)| {
        let hold = &segments[*place];
        let from = hold.fit_start;
        let times: Vec<f64> = time[from..hold.end].iter().map(|t| t - time[from]).collect();
        let displacement = exchanged.force()[from..hold.end].to_vec();
        let last = until(&times);
        let samples = Samples::new(&times[..last], &displacement[..last]);
        let compare = CompareOptions {
            fit: fits[index].clone(),
            ..each.clone()
        };
        let mut comparison = fitted(compare_laws_watched(&samples, &compare, &[], watch))?;
        let mut findings = comparison.as_ref().map_or_else(Vec::new, |found| comparison_findings(found, times[1]));
        if let Some(fit) = comparison.as_ref().and_then(recommended)
            && let Some(end) = times[..last].last()
        {
            let original = original.filter(|_| hold.after == Some(After::Unloading));
            findings.extend(extrapolated(fit, *end));
            findings.extend(original.and_then(|original| beyond_original(fit, *end, original)));
        }
        if let Some(changes) = drive_changes(&record, (&segments, *place), HoldMode::ForceHeld, from + last) {
            // No law of a constant force is the law of a body under this one.
            if let Some(verdict) = comparison.as_mut().and_then(|found| found.verdict.as_mut()) {
                verdict.reserve(Reservation::DriveChanges);
            }
            findings.insert(0, changes);
        }
        Ok(CreepHold {
            number: index + 1,
            start: time[hold.start],
            end: time[hold.end - 1],
            fit_start: time[from],
            force: median(&mut record.force()[hold.start..hold.end].to_vec()),
            after: hold.after,
            findings,
            times,
            displacement,
            comparison,
        })
    });
    let mut holds: Vec<CreepHold> = holds.collect::<Result<_, CreepError>>()?;
    let compared = holds.iter_mut().zip(fits).filter_map(|(hold, fit)| {
        let last = until(&hold.times);
        let samples = Samples::new(&hold.times[..last], &hold.displacement[..last]);
        Some((samples, fit, hold.comparison.as_mut()?))
    });
    if compare.forecast {
        add_forecasts(compared.collect(), &each.laws(), watch)?;
    }
    Ok(holds)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::Law;
    use crate::test_problems::Rng;
    use crate::watch::Unwatched;

    #[test]
    fn a_record_without_displacement_says_so() {
        let record = Record::new(vec![0.0, 1.0, 2.0], None, vec![0.0, 1.0, 1.0]).unwrap();
        let found =
            creep_holds(&record, (&SegmentOptions::default(), &[]), &CompareOptions::default(), None, &mut Unwatched);
        assert_eq!(found, Err(CreepError::NoDisplacement));
    }

    /// It was "nothing moves", stated of the force.
    #[test]
    fn a_flow_under_a_force_that_never_varies_is_creep() {
        let time: Vec<f64> = (0..300).map(f64::from).collect();
        let jaw = time.iter().map(|t| 1e-5 * t + 2e-4 * (1.0 - (-t / 20.0).exp())).collect();
        let record = Record::new(time, Some(jaw), vec![10.0; 300]).unwrap();
        let found =
            creep_holds(&record, (&SegmentOptions::default(), &[]), &CompareOptions::default(), None, &mut Unwatched);
        let holds = found.unwrap();
        assert_eq!((holds.len(), holds[0].start, holds[0].end, holds[0].force), (1, 0.0, 299.0, 10.0));
    }

    #[test]
    fn a_jaw_that_stands_still_cannot_creep() {
        let time: Vec<f64> = (0..100).map(f64::from).collect();
        let force: Vec<f64> = time.iter().map(|t| t.min(10.0)).collect();
        let record = Record::new(time, Some(vec![1e-3; 100]), force).unwrap();
        let found =
            creep_holds(&record, (&SegmentOptions::default(), &[]), &CompareOptions::default(), None, &mut Unwatched);
        assert_eq!(found, Err(CreepError::DisplacementHeld));
    }

    /// The creep of a standard linear solid, 1 mm at once and 1.5 mm more with a time of 8 s under 5 N, under this force over 5 N; with noise of 0.2 µm and
    /// 2 mN.
    fn under(force: impl Fn(f64) -> f64) -> Vec<CreepHold> {
        let (mut random, mut slow, mut last) = (Rng::new(5), 0.0, 0.0);
        let kept = (-0.05f64 / 8.0).exp();
        let rows: Vec<[f64; 3]> = (0..3200)
            .map(|i| {
                let t = 0.05 * f64::from(i);
                let now = force(t);
                // Of a force along a line within each step.
                let mean = 0.5 * (now + last);
                slow = mean + (slow - mean) * kept;
                last = now;
                [t, 1e-3 * now + 1.5e-3 * slow + 2e-7 * random.normal(), 5.0 * now + 2e-3 * random.normal()]
            })
            .collect();
        let of = |column: usize| rows.iter().map(|row| row[column]).collect::<Vec<f64>>();
        let record = Record::new(of(0), Some(of(1)), of(2)).unwrap();
        creep_holds(&record, (&SegmentOptions::default(), &[]), &CompareOptions::default(), None, &mut Unwatched)
            .unwrap()
    }

    /// The lag of a controller was the second time of a series that was "clear".
    #[test]
    fn a_force_that_goes_on_in_a_creep_is_stated_and_no_law_recommended() {
        let ramp = |t: f64| (t - 2.0).clamp(0.0, 0.5) / 0.5;
        let lag = |t: f64, share: f64, time: f64| ramp(t) * (1.0 - share * (-(t - 2.5).max(0.0) / time).exp());
        let stated = |holds: &[CreepHold]| -> Vec<(bool, bool)> {
            let of = |hold: &CreepHold| {
                let verdict = hold.comparison.as_ref().unwrap().verdict.as_ref().unwrap();
                let finds = hold.findings.iter().any(|finding| finding.code() == "drive_changes");
                (finds, verdict.reservation == Some(Reservation::DriveChanges))
            };
            holds.iter().map(of).collect()
        };
        for (share, time) in [(0.03, 60.0), (0.02, 20.0)] {
            assert_eq!(stated(&under(|t| lag(t, share, time))), [(true, true)], "{share} {time}");
        }
        assert_eq!(stated(&under(ramp)), [(false, false)]);
    }

    /// The way of a jaw that was let go, once the force was down to that of air, was a creep.
    #[test]
    fn a_jaw_that_leaves_the_body_and_rests_does_not_creep() {
        let place = |t: f64| (t - 5.0).clamp(0.0, 3.0) - (t - 128.0).clamp(0.0, 3.0);
        for seed in 0..4 {
            let (mut random, mut arm) = (Rng::new(seed), 0.0);
            let kept = (-0.1f64 / 10.0).exp();
            let rows: Vec<[f64; 3]> = (0..1610)
                .map(|i| {
                    let t = 0.1 * f64::from(i);
                    arm = arm * kept + 25.0 * (place(t) - place(t - 0.1));
                    let force = (80.0 * place(t) + arm).max(0.0) + 0.2 * random.normal();
                    [t, 1e-3 * place(t) + 3e-7 * random.normal(), force]
                })
                .collect();
            let of = |column: usize| rows.iter().map(|row| row[column]).collect::<Vec<f64>>();
            let record = Record::new(of(0), Some(of(1)), of(2)).unwrap();
            let (options, laws) = (SegmentOptions::default(), CompareOptions::default());
            let found = creep_holds(&record, (&options, &[]), &laws, None, &mut Unwatched);
            assert_eq!(found, Err(CreepError::DisplacementHeld), "{seed}");
        }
    }

    /// It was refused: a creep after a ramp of 4 s had 79 % of its amplitude.
    #[test]
    fn a_creep_knows_the_ramp_of_its_force() {
        let mut random = Rng::new(8);
        for (ramp, noise) in [(4.0, 0.0), (4.0, 1e-3), (12.0, 1e-3)] {
            let force = |t: f64| 5.0 * (t - 2.0).clamp(0.0, ramp) / ramp;
            // J(t) = 1 + 1.5 (1 − exp(−t/8)) mm for 5 N, after a ramp.
            let slow = |t: f64| {
                let (since, on) = ((t - 2.0).max(0.0), (t - 2.0).clamp(0.0, ramp));
                on / ramp - 8.0 / ramp * ((-(since - on) / 8.0).exp() - (-since / 8.0).exp())
            };
            let time: Vec<f64> = (0..1600).map(|i| 0.05 * f64::from(i)).collect();
            let jaw = time.iter().map(|t| 2e-4 * force(*t) + 1.5e-3 * slow(*t)).collect();
            let forces = time.iter().map(|t| force(*t) + noise * random.normal()).collect();
            let record = Record::new(time, Some(jaw), forces).unwrap();
            let laws = CompareOptions {
                laws: vec![Law::StandardLinearSolid],
                ramps: RampChoice::Measured,
                forecast: false,
                ..CompareOptions::default()
            };
            let holds = creep_holds(&record, (&SegmentOptions::default(), &[]), &laws, None, &mut Unwatched).unwrap();
            let fit = holds[0].comparison.as_ref().unwrap().rows[0].fit.as_ref().unwrap();
            let [amplitude, time] = ["amplitude", "time_constant_s"].map(|name| fit.value(name).unwrap());
            let within = if noise > 0.0 { 2e-3 } else { 1e-5 };
            println!("{ramp} s, {noise} N: {amplitude} m, {time} s");
            assert!((amplitude / 1.5e-3 - 1.0).abs() < within, "{ramp} {noise}: {amplitude}");
            assert!((time / 8.0 - 1.0).abs() < within, "{ramp} {noise}: {time}");
        }
    }

    /// The displacement (m) under a force (N), with noise of 1 µm and 0.2 N, of a test of so long (s) at 2 Hz.
    fn crept(until: u32, force: impl Fn(f64) -> f64, jaw: impl Fn(f64) -> f64) -> Vec<CreepHold> {
        let mut random = Rng::new(3);
        let time: Vec<f64> = (0..2 * until).map(|i| 0.5 * f64::from(i)).collect();
        let places = time.iter().map(|t| jaw(*t) + 1e-6 * random.normal()).collect();
        let mut random = Rng::new(4);
        let forces = time.iter().map(|t| force(*t) + 0.2 * random.normal()).collect();
        let record = Record::new(time, Some(places), forces).unwrap();
        let compare = CompareOptions {
            laws: ["standard-linear-solid", "prony:2", "latency:5", "power"].map(|law| law.parse().unwrap()).to_vec(),
            forecast: false,
            ..CompareOptions::default()
        };
        creep_holds(&record, (&SegmentOptions::default(), &[]), &compare, None, &mut Unwatched).unwrap()
    }

    fn codes(hold: &CreepHold) -> Vec<&'static str> {
        hold.findings.iter().map(Finding::code).collect()
    }

    /// Nothing was stated of the final displacement, of which a relaxation of the same course has its finding.
    #[test]
    fn a_final_displacement_beyond_the_hold_is_stated() {
        let force = |t: f64| 100.0 * ((t - 10.0) / 2.0).clamp(0.0, 1.0);
        let solid = |time: f64| {
            let slow = move |t: f64| 6e-4 * (1.0 - (-(t - 12.0).max(0.0) / time).exp());
            crept(612, force, move |t| 4e-6 * force(t) + slow(t))
        };
        let (far, near) = (solid(500.0), solid(60.0));
        assert!(codes(&far[0]).contains(&"equilibrium_extrapolated"), "{:?}", codes(&far[0]));
        let stated = far[0].findings.iter().find(|finding| finding.code() == "equilibrium_extrapolated").unwrap();
        assert!(stated.observation().contains("of the creep") && !stated.meaning().contains("equilibrium"));
        assert!(!codes(&near[0]).contains(&"equilibrium_extrapolated"), "{:?}", codes(&near[0]));
    }

    /// "final −24.7 [−32.8, −16.7] µm" of a body that goes back to 0 had no finding.
    #[test]
    fn a_recovery_beyond_the_original_height_is_stated() {
        let force = |t: f64| 100.0 * ((t - 10.0) / 2.0).clamp(0.0, 1.0) - 100.0 * ((t - 612.0) / 2.0).clamp(0.0, 1.0);
        let power = |t: f64| 8e-5 * t.max(0.0).powf(0.25);
        let solid = |t: f64| -4e-4 * (-t.max(0.0) / 60.0).exp_m1();
        let holds = crept(1500, force, |t| 4e-6 * force(t) + power(t - 11.0) - power(t - 613.0));
        assert!(codes(&holds[1]).contains(&"recovery_beyond_original"), "{:?}", codes(&holds[1]));
        let holds = crept(1500, force, |t| 4e-6 * force(t) + solid(t - 11.0) - solid(t - 613.0));
        assert!(!codes(&holds[1]).contains(&"recovery_beyond_original"), "{:?}", codes(&holds[1]));
    }

    /// It was "no creep", though a hundred times the noise.
    #[test]
    fn a_stiff_body_creeps_by_a_thousandth_of_the_way() {
        for creep in [3e-6, 1e-6] {
            let mut random = Rng::new(2);
            let time: Vec<f64> = (0..1600).map(|i| 0.05 * f64::from(i)).collect();
            let held = |t: &f64| (t - 2.0).clamp(0.0, 1.0);
            let slow = |t: &f64| creep * (1.0 - (-(t - 3.0).max(0.0) / 8.0).exp());
            let jaw = time.iter().map(|t| 1e-3 * held(t) + slow(t) + 2e-8 * random.normal()).collect();
            let mut random = Rng::new(3);
            let force = time.iter().map(|t| 5.0 * held(t) + 0.01 * random.normal()).collect();
            let record = Record::new(time, Some(jaw), force).unwrap();
            let (options, laws) = (SegmentOptions::default(), CompareOptions::default());
            let holds = creep_holds(&record, (&options, &[]), &laws, None, &mut Unwatched).unwrap();
            assert_eq!(holds.len(), 1);
            let best =
                holds[0].comparison.as_ref().unwrap().rows.iter().find(|row| row.law == Law::StandardLinearSolid);
            let fit = best.unwrap().fit.as_ref().unwrap();
            assert!((fit.value("time_constant_s").unwrap() / 8.0 - 1.0).abs() < 0.1, "{creep}: {fit:?}");
        }
    }
}
