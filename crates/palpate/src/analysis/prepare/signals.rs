//! What the columns of a record, and what was done to them, give cause to say.

use super::{rest::baseline_drifts, seam::continued_apart};
use crate::analysis::{AnalysisOptions, Corrected, Finding, Prepared};
use crate::contact::Specimen;
use crate::record::{Astray, Column, Correction, Record, SignalReport, Values};
use crate::segment::{
    ContactChoice, ContactPoint, HoldMode, Phase, Segment, SegmentOptions, Segmentation, TouchMethod, find_contact_of,
    find_phases,
};
use crate::statistics::{mean, median, noise};

/// Levels between the smallest and the largest value below which rounding is worth a word.
const FEW_LEVELS: f64 = 200.0;
/// Share of rows that repeat the row before above which noise does not smooth the rounding.
const REPEATING: f64 = 0.5;

/// All findings on the columns of a record: as they were measured, as they were corrected, and counted from first touch.
pub(crate) fn signal_findings(
    measured: (&Record, &SignalReport),
    corrected: &Corrected,
    prepared: &Prepared,
    options: &AnalysisOptions,
) -> Vec<Finding> {
    let Prepared {
        record,
        segmentation,
        contact,
    } = prepared;
    let mut findings = record_findings(&corrected.record);
    // Of clocks that differ the force goes on while the jaw stands already: that is no saturation.
    let aligned = corrected.aligned(measured.0);
    let aligned = aligned.as_ref().map_or(measured, |(record, signals)| (record, signals));
    findings.extend(column_findings(aligned, segmentation, record));
    findings.extend(corrected.skew_finding().into_iter().chain(corrected.lag.map(Finding::from)));
    findings.extend(baseline_drifts(&corrected.record, segmentation));
    if !segmentation.settings.from_displacement {
        findings.push(Finding::PhasesFromForce);
    }
    if segmentation.is_one_hold() {
        findings.push(Finding::OneHold);
    }
    findings.extend(segmentation.labels.map(Finding::LabelsDisagree));
    let doubtful = segmentation.holds().zip(1..).filter(|(hold, _)| hold.doubtful).map(|(_, number)| number);
    let doubtful: Vec<usize> = doubtful.collect();
    if !doubtful.is_empty() {
        findings.push(Finding::HoldsDoubtful {
            holds: doubtful,
            of: segmentation.holds().count(),
        });
    }
    findings.extend(segmentation.ripple.map(Finding::JawHunts));
    findings.extend(segmentation.ruptures.iter().copied().map(Finding::Ruptured));
    if contact.air_travel > 0.0 {
        findings.push(Finding::AirTravel {
            travel: contact.air_travel,
        });
    }
    findings.extend(touch_findings(record, contact, options.touch));
    let is_stated = matches!(options.touch, ContactChoice::AsRecorded | ContactChoice::Displacement(_));
    if options.geometry.is_some() && is_stated {
        let zero = wrong_zero(record, segmentation);
        let body = options.geometry.as_ref().and_then(|geometry| geometry.specimen(1.0).ok());
        findings.extend(zero.or_else(|| air_as_travel(record, segmentation, body.as_ref())));
    }
    findings
}

/// Findings on a record whatever its phases: what was done to it, rows of the force that stray, and columns that may have the wrong sign.
#[must_use]
pub fn record_findings(record: &Record) -> Vec<Finding> {
    let mut findings = correction_findings(record);
    findings.extend(continued_apart(record));
    findings.extend(rows_astray(record));
    findings.extend(suspicious_signs(record));
    findings
}

/// A hold: from when to when it lasts, and what is held in it.
type Held = (f64, f64, Option<HoldMode>);

/// Findings on the columns of a record as they are, of which `segmentation` gives the holds on the times of `cut`.
fn column_findings(
    (record, signals): (&Record, &SignalReport),
    segmentation: &Segmentation,
    cut: &Record,
) -> Vec<Finding> {
    let time = cut.time();
    let holds: Vec<Held> = segmentation.holds().map(|hold| (time[hold.start], time[hold.end - 1], hold.mode)).collect();
    let mut findings = Vec::new();
    let gaps = signals.stamps.gaps;
    if let Some(from) = gaps.from {
        findings.push(Finding::Gaps {
            count: gaps.count,
            longest: gaps.longest,
            from,
        });
    }
    let displacement = signals.displacement.as_ref().map(|values| (Column::Displacement, values));
    for (column, values) in displacement.into_iter().chain([(Column::Force, &signals.force)]) {
        findings.extend(clipped(record, column, values, &holds));
        findings.extend(rounded(column, values));
    }
    findings
}

fn clipped(record: &Record, column: Column, values: &Values, holds: &[Held]) -> Option<Finding> {
    let saturation = values.saturation.filter(|saturation| saturation.clipped)?;
    let measured = match column {
        Column::Displacement => record.displacement()?,
        Column::Force => record.force(),
    };
    let time = record.time();
    let at_level = |(from, until, _): &Held| {
        let rows = time.partition_point(|t| t < from)..time.partition_point(|t| t <= until);
        measured[rows]
            .iter()
            .filter(|value| (**value - saturation.level).abs() <= saturation.spread)
            .count()
    };
    // A force that the machine holds is commanded.
    let pressed = holds.iter().filter(|(_, _, mode)| column == Column::Force && *mode == Some(HoldMode::ForceHeld));
    if pressed.map(at_level).sum::<usize>() >= saturation.rows {
        return None;
    }
    Some(Finding::Saturated {
        column,
        level: saturation.level,
        rows: saturation.rows,
        holds: (1..).zip(holds).filter(|(_, hold)| at_level(hold) > 0).map(|(number, _)| number).collect(),
    })
}

/// A jaw stands still in a hold; only a force that repeats itself is rounded too coarsely.
fn rounded(column: Column, values: &Values) -> Option<Finding> {
    let step = values.step.filter(|step| values.range < FEW_LEVELS * step)?;
    (column == Column::Force && values.repeating > REPEATING).then_some(Finding::Quantised { column, step })
}

/// [`Finding::SignSuspicious`] for columns that fall first, where a test loads first.
///
/// What counts is the first time that a column is half as far from its start as it ever comes: many small steps up and one large
/// one down are no reason for doubt. Nor is a force that swings as a mass is set in motion, or a jaw that draws back first, where what is
/// held then lies above the start.
pub fn suspicious_signs(record: &Record) -> Vec<Finding> {
    let force = record.force();
    let (low, high) = force.iter().fold((f64::MAX, f64::MIN), |(low, high), f| (low.min(*f), high.max(*f)));
    let observed = (0.05 * (high - low)).max(8.0 * noise(force));
    let columns = [("displacement", record.displacement(), 0.0), ("force", Some(force), observed)];
    let falls = columns.into_iter().filter_map(|(column, values, least)| {
        let values = values?;
        let start = median(&mut values[..values.len().min(5)].to_vec());
        let most = values.iter().fold(0.0, |most: f64, value| most.max((value - start).abs()));
        let first = values.iter().find(|value| (**value - start).abs() >= 0.5 * most)?;
        let fall = start - values.iter().copied().fold(f64::MAX, f64::min);
        // A record that begins in its hold has lost the loading: what is pressed relaxes, and is let go.
        let is_right = || {
            find_phases(record, &SegmentOptions::default()).is_ok_and(|found| {
                let is_pressed = start > 0.0 && record.force()[0] > 0.0;
                let begins = found.segments.first().is_some_and(|first| first.phase == Phase::Hold);
                begins && (is_pressed || column != "force" && found.is_one_hold())
                    || !found.is_one_hold() && holds_above_start(values, &found)
            })
        };
        (*first < start && fall > least && !is_right()).then(|| Finding::SignSuspicious {
            column: column.to_owned(),
            fall,
        })
    });
    falls.collect()
}

/// Whether the first level that is held and lies as far from the start as half of the farthest lies above it.
fn holds_above_start(values: &[f64], found: &Segmentation) -> bool {
    // A jaw may move from the second row on.
    let level = |hold: &Segment| median(&mut values[hold.fit_start..hold.end].to_vec()) - values[0];
    let levels: Vec<f64> = found.holds().map(level).collect();
    let most = levels.iter().fold(0.0, |most: f64, level| most.max(level.abs()));
    levels.iter().find(|level| level.abs() >= 0.5 * most).is_some_and(|level| *level > 0.0)
}

/// [`Finding::RowsStray`] for rows of the force that stray and were not repaired.
fn rows_astray(record: &Record) -> Option<Finding> {
    let rows = Astray::of_force(record.force(), record.displacement()).rows();
    let first = *rows.first()?;
    Some(Finding::RowsStray {
        count: rows.len(),
        time: record.time()[first],
        force: record.force()[first],
    })
}

/// Findings on what was done to a record before its analysis and in it.
fn correction_findings(record: &Record) -> Vec<Finding> {
    let finding = |done: &Correction| match *done {
        Correction::StampsSorted { rows, largest, .. } => Some(Finding::StampsSorted { rows, largest }),
        Correction::StampsMerged { rows, merged, .. } => Some(Finding::StampsMerged { rows, merged }),
        Correction::StampsSpread { rows, stamps, step, .. } => Some(Finding::StampsSpread { rows, stamps, step }),
        Correction::RowsAveraged { rows, averaged } => Some(Finding::RowsAveraged { rows, averaged }),
        Correction::StressAsForce => Some(Finding::StressAsForce),
        Correction::DropoutsReplaced { column, count } => Some(Finding::DropoutsRepaired { column, count }),
        _ => None,
    };
    record.corrections().iter().filter_map(finding).collect()
}

/// Share of the largest squeeze by which the rules for first touch may differ.
const SPREAD: f64 = 0.05;

/// Share of the largest squeeze by which the loading curve may lie apart from the other rules.
const APART: f64 = 0.05;

/// Findings on first touch in a record that counts from it.
fn touch_findings(record: &Record, contact: &ContactPoint, requested: ContactChoice) -> Vec<Finding> {
    let mut findings = Vec::new();
    let squeeze = record.displacement().into_iter().flatten().fold(0.0f64, |most, d| most.max(*d));
    if let Some(spread) = contact.spread.filter(|spread| *spread > SPREAD * squeeze) {
        findings.push(Finding::TouchSpread { spread, squeeze });
    }
    // The error contains the distance where the curve misses the ramp: one that describes it is right, and the other rules are not.
    let misses = |apart: &f64| contact.displacement_error.is_some_and(|error| error >= apart.abs());
    findings.extend(contact.tilt.map(Finding::BaselineTilts));
    findings.extend(contact.open.map(|behind| Finding::TouchOpen { behind, squeeze }));
    if let Some((without, with)) = contact.between {
        let between = (without - contact.tare.displacement, with - contact.tare.displacement);
        findings.push(Finding::TouchBetweenSamples { between, squeeze });
    }
    let by_curve = contact.method == Some(TouchMethod::LoadingCurve);
    if let Some(apart) = contact
        .apart()
        .filter(|apart| requested == ContactChoice::Auto && by_curve && apart.abs() > APART * squeeze && misses(apart))
    {
        findings.push(Finding::TouchApart { apart, squeeze });
    }
    if let ContactChoice::By(method) = requested
        && contact.method != Some(method)
    {
        findings.push(Finding::TouchNotFound { method });
    }
    findings
}

/// [`Finding::DisplacementNotZero`] or [`Finding::ForceNotZero`] by the rows before the first ramp of a record whose first touch is stated
/// ([`ContactChoice::AsRecorded`], [`ContactChoice::Displacement`]).
fn wrong_zero(record: &Record, segmentation: &Segmentation) -> Option<Finding> {
    /// Shares of the travel: what is a displacement, and what is none.
    const MOVED: (f64, f64) = (0.2, 0.01);
    /// Shares of the largest force that the first row has to have, and a rest.
    const PRESSED: (f64, f64) = (0.03, 0.01);
    /// How many times stiffer a body is that grows stiffer as it is pressed, at most, from first touch to the first row and from there on.
    const STIFFENS: f64 = 20.0;
    /// Fewest rows of a rest.
    const REST: usize = 10;
    let (force, displacement) = (record.force(), record.displacement()?);
    let rows = segmentation.first_loading().map_or(0, |ramp| ramp.start).saturating_sub(1);
    // A ramp of few rows has left its beginning in the second.
    let (first_force, first, share, error) = match rows >= REST {
        true => {
            let error = noise(&force[..rows]) / (rows as f64 / REST as f64).sqrt();
            (mean(&force[..rows]), median(&mut displacement[..rows].to_vec()), PRESSED.1, error)
        }
        false => (*force.first()?, *displacement.first()?, PRESSED.0, noise(force)),
    };
    let farthest =
        |values: &[f64], from: f64| values.iter().fold(0.0, |most: f64, value| most.max((value - from).abs()));
    let (travel, largest) = (farthest(displacement, first), farthest(force, 0.0));
    // A preload on a specimen between grips that are far apart already.
    let is_light = || first_force.abs() / first * STIFFENS < (largest - first_force.abs()) / travel;
    let is_free = || first_force.abs() <= (PRESSED.1 * largest).max(3.0 * error);
    if first > MOVED.0 * travel && (is_free() || is_light()) {
        return Some(Finding::DisplacementNotZero { start: first });
    }
    let is_pressed = first.abs() <= MOVED.1 * travel && first_force.abs() > (share * largest).max(8.0 * error);
    is_pressed.then_some(Finding::ForceNotZero { start: first_force })
}

/// [`Finding::AirAsTravel`] where the jaw goes on through air from the first touch that is stated.
fn air_as_travel(record: &Record, segmentation: &Segmentation, body: Option<&Specimen>) -> Option<Finding> {
    /// Share of the largest squeeze, and standard errors of where the force begins.
    const MATTERS: f64 = 0.03;
    const SURE: f64 = 5.0;
    let squeeze = record.displacement()?.iter().fold(0.0f64, |most, d| most.max(*d));
    let found = find_contact_of(record, segmentation, body, ContactChoice::Auto);
    let (air, error) = (found.tare.displacement, found.displacement_error?);
    (air > (MATTERS * squeeze).max(SURE * error)).then_some(Finding::AirAsTravel { air, squeeze })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stairs(sign: f64) -> Record {
        let knots = [
            (0.0, 0.0),
            (1.0, 5.0),
            (5.0, 5.0),
            (6.0, 10.0),
            (10.0, 10.0),
            (11.0, 15.0),
            (15.0, 15.0),
            (17.0, -1.0),
        ];
        let at = |t: f64| {
            let next = knots.iter().position(|knot| knot.0 >= t).unwrap_or(knots.len() - 1).max(1);
            let ((t0, y0), (t1, y1)) = (knots[next - 1], knots[next]);
            y0 + (y1 - y0) * (t - t0) / (t1 - t0)
        };
        let time: Vec<f64> = (0..170).map(|i| 0.1 * f64::from(i)).collect();
        let travel: Vec<f64> = time.iter().map(|t| sign * at(*t)).collect();
        Record::new(time, Some(travel.clone()), travel).unwrap()
    }

    /// A specimen between grips at 12.3 mm under a preload of 0.5 N had a modulus of 5.5 MPa in place of 72.
    #[test]
    fn a_preload_far_from_first_touch_is_no_strain() {
        let time: Vec<f64> = (0..500).map(|i| 0.1 * f64::from(i)).collect();
        let ramp = |t: f64| 1.2e-3 * ((t - 3.0) / 4.0).clamp(0.0, 1.0);
        let found = |start: f64, preload: f64| {
            let displacement = time.iter().map(|t| start + ramp(*t)).collect();
            let relaxes = |t: f64| if t > 7.0 { 0.3 * ((7.0 - t) / 5.0).exp_m1() } else { 0.0 };
            let force = time.iter().map(|t| preload + 1.4e4 * ramp(*t) * (1.0 + relaxes(*t))).collect();
            let record = Record::new(time.clone(), Some(displacement), force).unwrap();
            let found = crate::segment::find_phases(&record, &crate::segment::SegmentOptions::default()).unwrap();
            wrong_zero(&record, &found).map(|finding| finding.code())
        };
        for preload in [0.0, 0.1, 0.5, 1.0] {
            assert_eq!(found(12.3e-3, preload), Some("displacement_not_zero"), "{preload} N");
        }
        // That far pressed the force is in proportion, or a fifth of that in a body that grows stiffer.
        assert_eq!((found(1.2e-3, 16.8), found(1.2e-3, 3.4)), (None, None));
    }

    /// A load cell clipped at 30 N of 42 N with the noise of its amplifier gave no finding; without noise it did.
    #[test]
    fn a_clipped_load_cell_is_stated_with_and_without_noise() {
        let time: Vec<f64> = (0..3000).map(|i| 0.02 * f64::from(i)).collect();
        let displacement: Vec<f64> = time.iter().map(|t| 2e-3 * (t - 2.0).clamp(0.0, 2.0)).collect();
        let decay = (-0.02_f64 / 3.0).exp();
        let mut transient = 0.0;
        let mut force = vec![0.0];
        force.extend(displacement.windows(2).map(|pair| {
            transient = decay * transient + 7.5e3 * (pair[1] - pair[0]) / 0.02 * 3.0 * (1.0 - decay);
            5e3 * pair[1] + transient
        }));
        let found = |noise: f64, most: f64| {
            let mut random = crate::random::Rng::new(11);
            let force = force.iter().map(|force| force.min(most) + noise * random.normal()).collect();
            let record = Record::new(time.clone(), Some(displacement.clone()), force).unwrap();
            let analysis = crate::analysis::analyze(&record, &AnalysisOptions::default()).unwrap();
            analysis.findings.into_iter().find(|finding| finding.code() == "saturated")
        };
        for noise in [0.0, 0.005, 0.02, 0.1] {
            let Some(Finding::Saturated { level, rows, .. }) = found(noise, 30.0) else {
                panic!("not found under {noise} N");
            };
            assert!((level - 30.0).abs() < 0.02 && (145..=155).contains(&rows), "{noise}: {level} {rows}");
            assert_eq!(found(noise, 100.0), None);
        }
    }

    /// Steps up of a third each and a release in one go looked like a test that begins downwards.
    #[test]
    fn a_release_larger_than_the_steps_is_no_wrong_sign() {
        assert_eq!(suspicious_signs(&stairs(1.0)), []);
        let codes: Vec<&str> = suspicious_signs(&stairs(-1.0)).iter().map(Finding::code).collect();
        assert_eq!(codes, ["sign_suspicious", "sign_suspicious"]);
    }

    #[test]
    fn columns_that_do_not_count_from_first_touch_are_reported() {
        let shifted = |travel: f64, force: f64| {
            let record = stairs(1.0);
            let displacement = record.displacement().unwrap().iter().map(|d| d + travel).collect();
            let force = record.force().iter().map(|f| f + force).collect();
            let record = Record::new(record.time().to_vec(), Some(displacement), force).unwrap();
            wrong_zero(&record, &find_phases(&record, &SegmentOptions::default()).unwrap())
        };
        assert_eq!((shifted(0.0, 0.0), shifted(-6.0, 0.0), shifted(0.0, 0.05)), (None, None, None));
        assert_eq!(shifted(6.0, 0.0).map(|finding| finding.code()), Some("displacement_not_zero"));
        assert_eq!(shifted(0.0, -1.0).map(|finding| finding.code()), Some("force_not_zero"));
    }

    /// The torque that sets a rotor in motion, and brakes it, was a force that falls first.
    #[test]
    fn a_mass_that_is_set_in_motion_is_no_wrong_sign() {
        let time: Vec<f64> = (0..600).map(|i| 1e-3 * f64::from(i) + 1e-3 * 1.028f64.powi(i)).collect();
        let step = |sign: f64| {
            let strain = |t: f64| 4.5e-3 * (1.0 - (-60.0 * t).exp() * (300.0 * t).cos());
            let torque = |t: f64| {
                1.0 / (1.0 + 30.0 * t).powf(0.3) - 1.0 / (1.0 + 3e3 * t) + 25.0 * (-60.0 * t).exp() * (600.0 * t).sin()
            };
            let column =
                |shape: &dyn Fn(f64) -> f64| time.iter().map(|t| sign * shape(t - time[0])).collect::<Vec<f64>>();
            Record::new(time.clone(), Some(column(&strain)), column(&torque)).unwrap()
        };
        let force = step(1.0);
        let start = median(&mut force.force()[..5].to_vec());
        assert!(force.force()[0] < start, "the record shows what it is to show");
        assert_eq!(suspicious_signs(&force), []);
        let turned = suspicious_signs(&step(-1.0));
        assert!(turned.iter().any(|finding| finding.code() == "sign_suspicious"), "{turned:?}");
    }
}
