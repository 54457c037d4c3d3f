//! Corrections of a record against known truth: clocks, baseline, compliance, first touch.
#![expect(clippy::unwrap_used, reason = "a test that cannot run has failed")]

use palpate::analysis::{AnalysisOptions, ClockSkew, Finding, analyze, clock_skew};
use palpate::contact::{Layers, Shape, Sides, Specimen};
use palpate::latency::LatencyLaw;
use palpate::record::{Baseline, Compliance, Correction, CorrectionOptions, Record, SkewChoice};
use palpate::segment::{ContactChoice, SegmentOptions, TouchMethod, find_contact_of, find_phases};
use palpate::simulate::{ContactModel, Motion, ProtocolStep, Separation, protocol, simulate_force};
use palpate::test_problems::{PAPER_RATE, Rng, paper_ball};

/// A strip that relaxes over seconds, stretched in stairs.
fn strip() -> ContactModel {
    let shape = Shape::Prism {
        area: 1e-4,
        length: 0.05,
    };
    ContactModel {
        specimen: Specimen::new(shape, 1e6, Sides::One).unwrap(),
        law: LatencyLaw::new(2.0, 20.0).unwrap(),
        layers: Layers::new(4.0).unwrap(),
        separation: Separation::Bonded,
    }
}

/// Six stairs of 2 mm in 1 s, each held for 4 s, then back at once; stamps at `rate` with a jitter of ± 0.3 intervals.
fn stairs(rate: f64, noise: f64, skew: f64, seed: u64) -> Record {
    let step = |to: f64, rate: f64| ProtocolStep { to, rate, hold: 4.0 };
    let ups = (1..=6).map(|i| step(2e-3 * f64::from(i), 2e-3));
    let motion = protocol(&ups.chain([step(0.0, 6e-3)]).collect::<Vec<_>>()).unwrap();
    let mut random = Rng::new(seed);
    let end = motion.end() - 0.5;
    let late = skew.max(0.0);
    let stamp = |i: u32| (f64::from(i) + 0.6 * random.uniform()) / rate + 0.2 + if late > 0.1 { late } else { 0.0 };
    let until = end - 0.3 - if skew.abs() > 0.1 { skew.abs() } else { 0.0 };
    let time: Vec<f64> = (0..(rate * until) as u32).map(stamp).collect();
    let true_times: Vec<f64> = time.iter().map(|t| t - skew).collect();
    let force = simulate_force(&motion, &strip(), &true_times).unwrap();
    let largest = force.iter().fold(0.0f64, |most, f| most.max(f.abs()));
    let force: Vec<f64> = force.iter().map(|f| f + noise * largest * random.normal()).collect();
    let displacement: Vec<f64> = time.iter().map(|t| motion.displacement_at(*t)).collect();
    Record::from_two_clocks(&time, &displacement, &time, &force).unwrap()
}

/// The same record with one clock.
fn of_one_clock(record: &Record) -> Record {
    Record::new(record.time().to_vec(), record.displacement().map(<[f64]>::to_vec), record.force().to_vec()).unwrap()
}

fn skew_of(record: &Record) -> Option<ClockSkew> {
    clock_skew(record, &find_phases(record, &SegmentOptions::default()).unwrap())
}

#[test]
fn a_known_skew_is_found_within_its_error() {
    for (rate, noise) in [(50.0, 0.01), (200.0, 0.01), (50.0, 0.001)] {
        for skew in [0.035, -0.02, 0.0] {
            let found: Vec<ClockSkew> =
                (0..20).map(|seed| skew_of(&stairs(rate, noise, skew, seed)).unwrap()).collect();
            let pulls: Vec<f64> = found.iter().map(|found| (found.skew - skew) / found.standard_error).collect();
            let square = pulls.iter().map(|pull| pull * pull).sum::<f64>() / pulls.len() as f64;
            let mut errors: Vec<f64> = found.iter().map(|found| found.standard_error).collect();
            errors.sort_by(f64::total_cmp);
            let mean = found.iter().map(|found| found.skew - skew).sum::<f64>() / 20.0;
            println!(
                "{rate} Hz, noise {noise}, skew {skew} s: off by {:.2} ms on average, stated error {:.2} ms, pull {:.2}, edges {}",
                1e3 * mean,
                1e3 * errors[10],
                square.sqrt(),
                found[0].edges
            );
            assert!(square.sqrt() < 1.5, "{rate} {noise} {skew}: {pulls:?}");
            assert!(pulls.iter().filter(|pull| pull.abs() < 3.0).count() >= 18, "{pulls:?}");
            assert!(errors[10] < 0.02, "{errors:?}");
        }
    }
}

#[test]
fn a_skew_is_reported_and_removed_when_requested() {
    let record = stairs(200.0, 0.001, 0.035, 1);
    let analysis = analyze(&record, &AnalysisOptions::default()).unwrap();
    assert!(analysis.findings.iter().any(|finding| matches!(finding, Finding::ClocksSkewed { .. })));
    assert!(matches!(analysis.record.corrections(), [Correction::ClocksJoined { .. }]));
    for choice in [SkewChoice::Auto, SkewChoice::Given(0.035)] {
        let options = AnalysisOptions {
            corrections: CorrectionOptions {
                skew: choice,
                ..CorrectionOptions::default()
            },
            ..AnalysisOptions::default()
        };
        let analysis = analyze(&record, &options).unwrap();
        let [Correction::ClocksJoined { .. }, Correction::SkewRemoved { skew, left_out, .. }] =
            analysis.record.corrections()
        else {
            panic!("{:?}", analysis.record.corrections())
        };
        assert!((skew - 0.035).abs() < 3e-3 && *left_out > 0, "{skew}");
        assert!(!analysis.findings.iter().any(|finding| matches!(finding, Finding::ClocksSkewed { .. })));
        let left = skew_of(&analysis.record).unwrap();
        assert!(left.skew.abs() < 3.0 * left.standard_error, "{left:?}");
    }
    // Without a skew nothing is stated, and nothing done.
    let good = stairs(200.0, 0.001, 0.0, 2);
    let analysis = analyze(&good, &AnalysisOptions::default()).unwrap();
    assert!(
        !analysis.findings.iter().any(|finding| matches!(finding, Finding::ClocksSkewed { .. })),
        "{:?}",
        analysis.skew
    );
}

/// What only looked like a skew moved the force of a record with one clock by seconds, or was a finding.
#[test]
fn one_clock_has_no_skew() {
    for skew in [0.035, 0.6] {
        let record = of_one_clock(&stairs(200.0, 0.001, skew, 3));
        let with = |skew: SkewChoice| AnalysisOptions {
            corrections: CorrectionOptions {
                skew,
                ..CorrectionOptions::default()
            },
            ..AnalysisOptions::default()
        };
        let analysis = analyze(&record, &with(SkewChoice::Auto)).unwrap();
        assert!(analysis.record.corrections().is_empty(), "{:?}", analysis.record.corrections());
        let stated = |finding: &Finding| matches!(finding, Finding::ClocksOpen { one_clock: true, .. });
        assert!(analysis.findings.iter().any(stated), "{:?}", analysis.findings);
        let analysis = analyze(&record, &with(SkewChoice::Report)).unwrap();
        let clocks = |finding: &Finding| finding.code().starts_with("clocks");
        assert!(!analysis.findings.iter().any(clocks) && analysis.skew.is_none(), "{:?}", analysis.findings);
        // Who knows of a delay says so.
        let analysis = analyze(&record, &with(SkewChoice::Given(skew))).unwrap();
        assert!(matches!(analysis.record.corrections(), [Correction::SkewRemoved { .. }]));
        assert!(!analysis.findings.iter().any(clocks), "{:?}", analysis.findings);
    }
}

#[test]
fn a_skew_longer_than_a_ramp_is_found_too() {
    for skew in [-0.4, 0.6, 1.5] {
        let found = skew_of(&stairs(50.0, 0.002, skew, 3)).unwrap();
        assert!(
            (found.skew - skew).abs() < 0.01 && found.standard_error < 0.01 && found.is_observed(),
            "{skew}: {found:?}"
        );
    }
}

#[test]
fn a_skew_that_was_to_be_found_and_cannot_be_reported_is_stated() {
    // One ramp and one hold: two edges, of which the first is no kink of the force.
    let motion = protocol(&[ProtocolStep {
        to: 2e-3,
        rate: 2e-3,
        hold: 10.0,
    }])
    .unwrap();
    let time: Vec<f64> = (0..550).map(|i| 0.02 * f64::from(i)).collect();
    let force = simulate_force(&motion, &strip(), &time).unwrap();
    let displacement = time.iter().map(|t| motion.displacement_at(*t)).collect();
    let record = Record::new(time, Some(displacement), force).unwrap();
    let found = |skew: SkewChoice| {
        let options = AnalysisOptions {
            corrections: CorrectionOptions {
                skew,
                ..CorrectionOptions::default()
            },
            ..AnalysisOptions::default()
        };
        let findings = analyze(&record, &options).unwrap().findings;
        findings.iter().any(|finding| matches!(finding, Finding::ClocksOpen { skew: None, .. }))
    };
    assert!(found(SkewChoice::Auto) && !found(SkewChoice::Report) && !found(SkewChoice::Given(0.1)));
}

#[test]
fn a_skew_of_less_than_a_sample_interval_is_no_finding() {
    let found = |rate: f64| {
        let record = stairs(rate, 0.001, 0.035, 1);
        let analysis = analyze(&record, &AnalysisOptions::default()).unwrap();
        let skew = analysis.skew.unwrap();
        assert!(skew.is_observed() && (skew.interval - 1.0 / rate).abs() < 0.1 / rate, "{skew:?}");
        analysis.findings.iter().any(|finding| matches!(finding, Finding::ClocksSkewed { .. }))
    };
    assert!(found(50.0), "two samples late");
    assert!(!found(20.0), "less than a sample late");
}

#[test]
fn a_record_of_averaged_rows_says_so() {
    let averaged = Correction::RowsAveraged {
        rows: 40_000_000,
        averaged: 4,
    };
    let record = of_one_clock(&stairs(50.0, 0.001, 0.0, 1)).corrected_before([averaged.clone()]);
    assert_eq!(record.corrections(), [averaged]);
    let analysis = analyze(&record, &AnalysisOptions::default()).unwrap();
    let finding = analysis.findings.iter().find(|finding| finding.code() == "rows_averaged").unwrap();
    let observed = finding.observation();
    assert!(
        observed.contains("40000000 rows") && observed.contains("each 4 ") && observed.contains("10000000 samples"),
        "{observed}"
    );
}

#[test]
fn a_skew_that_cannot_be_reported_is_not_reported() {
    // One ramp and one hold have one edge.
    let record = stairs(50.0, 0.001, 0.035, 3);
    let until = record.time().partition_point(|t| *t < 4.5);
    let short = Record::new(
        record.time()[..until].to_vec(),
        record.displacement().map(|d| d[..until].to_vec()),
        record.force()[..until].to_vec(),
    );
    assert_eq!(skew_of(&short.unwrap()), None);
    // A force that is noise alone bends nowhere.
    let mut random = Rng::new(9);
    let force = record.time().iter().map(|_| random.normal()).collect();
    let noise = Record::new(record.time().to_vec(), record.displacement().map(<[f64]>::to_vec), force).unwrap();
    assert!(skew_of(&noise).is_none_or(|skew| !skew.is_observed()));
}

/// The paper's ball after `air` m of air, on a load cell that drifts by `drift` N/s from `zero` N; the jaw leaves again.
fn ball(air: f64, zero: f64, drift: f64, noise: f64, seed: u64) -> Record {
    let late = 1.0 + air / PAPER_RATE;
    let steps = [(5e-3, 8.0), (0.0, 2.0)].map(|(to, hold)| ProtocolStep {
        to,
        rate: PAPER_RATE,
        hold,
    });
    let touching = protocol(&steps).unwrap();
    let motion = Motion::new(
        std::iter::once(-late)
            .chain(touching.times().iter().copied())
            .chain([touching.end() + 4.0])
            .collect(),
        std::iter::once(0.0).chain(touching.displacements().iter().copied()).chain([0.0]).collect(),
    )
    .unwrap();
    let model = ContactModel {
        separation: Separation::Unilateral,
        ..paper_ball(Separation::Unilateral)
    };
    let mut random = Rng::new(seed);
    let time: Vec<f64> = (0..((touching.end() + late + 3.5) * 100.0) as u32).map(|i| f64::from(i) / 100.0).collect();
    let clean = simulate_force(&motion, &model, &time.iter().map(|t| t - late).collect::<Vec<_>>()).unwrap();
    let away = touching.end() + late;
    let place = |t: &f64| {
        let approach = PAPER_RATE * (t - 1.0).max(0.0);
        let retreat = PAPER_RATE * (t - away).max(0.0);
        if *t < late { approach } else { (air + touching.displacement_at(t - late) - retreat).max(0.0) }
    };
    let displacement: Vec<f64> = time.iter().map(place).collect();
    let force = time.iter().zip(clean).map(|(t, f)| f + zero + drift * t + noise * random.normal()).collect();
    Record::new(time, Some(displacement), force).unwrap()
}

fn with(corrections: CorrectionOptions) -> AnalysisOptions {
    AnalysisOptions {
        corrections,
        touch: ContactChoice::Auto,
        compare: None,
        ..AnalysisOptions::default()
    }
}

#[test]
fn a_drifting_zero_is_taken_off_by_both_ends() {
    let truth = ball(3e-3, 0.0, 0.0, 0.0, 4);
    let record = ball(3e-3, 0.4, 0.05, 5e-3, 4);
    let requested = CorrectionOptions {
        baseline: Some(Baseline::Sloped),
        ..CorrectionOptions::default()
    };
    let analysis = analyze(&record, &with(requested)).unwrap();
    let Some(Correction::BaselineRemoved {
        level, slope, samples, ..
    }) = analysis.record.corrections().first()
    else {
        panic!("{:?}", analysis.record.corrections())
    };
    assert!(
        (slope - 0.05).abs() < 1e-3 && (level - 0.4).abs() < 5e-3 && *samples > 100,
        "{level} {slope} {samples}"
    );
    let off = analysis.record.force().iter().zip(truth.force()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(off < 0.03, "{off}");
    // A window is taken at its word.
    let requested = CorrectionOptions {
        baseline: Some(Baseline::Constant),
        baseline_window: Some((0.0, 0.5)),
        ..CorrectionOptions::default()
    };
    let analysis = analyze(&record, &with(requested)).unwrap();
    let Some(Correction::BaselineRemoved { level, samples: 50, .. }) = analysis.record.corrections().first() else {
        panic!("{:?}", analysis.record.corrections())
    };
    assert!((level - 0.4125).abs() < 5e-3, "{level}");
    let empty = CorrectionOptions {
        baseline: Some(Baseline::Constant),
        baseline_window: Some((900.0, 950.0)),
        ..CorrectionOptions::default()
    };
    let error = analyze(&record, &with(empty)).unwrap_err();
    assert!(error.to_string().contains("found 0") && error.hint().contains("baseline_window"), "{error}");
}

#[test]
fn what_the_machine_gives_way_is_not_the_body() {
    let record = ball(0.0, 0.0, 0.0, 0.0, 5);
    let compliance = 2e-5;
    let measured: Vec<f64> =
        record.displacement().unwrap().iter().zip(record.force()).map(|(d, f)| d + compliance * f).collect();
    let measured = Record::new(record.time().to_vec(), Some(measured), record.force().to_vec()).unwrap();
    let requested = CorrectionOptions {
        compliance: Some(Compliance::Constant(compliance)),
        ..CorrectionOptions::default()
    };
    let as_recorded = AnalysisOptions {
        touch: ContactChoice::AsRecorded,
        ..with(requested)
    };
    let analysis = analyze(&measured, &as_recorded).unwrap();
    assert!(matches!(analysis.record.corrections()[0], Correction::ComplianceRemoved { largest } if largest > 1e-5));
    let hold = &analysis.holds[0];
    assert!((hold.displacement.unwrap() - 5e-3).abs() < 1e-6, "{:?}", hold.displacement);
}

#[test]
fn every_rule_finds_the_ball_behind_the_air() {
    let body = paper_ball(Separation::Unilateral).specimen;
    for seed in 0..3 {
        let record = ball(3e-3, 0.1, 0.0, 5e-3, seed);
        let phases = find_phases(&record, &SegmentOptions::default()).unwrap();
        let auto = find_contact_of(&record, &phases, Some(&body), ContactChoice::Auto);
        assert!(auto.estimates.len() >= 4 && auto.spread.unwrap() < 0.25e-3, "{auto:?}");
        for estimate in &auto.estimates {
            println!("{}: {:.3} mm", estimate.method.name(), 1e3 * (estimate.displacement - 3e-3));
            assert!((estimate.displacement - 3e-3).abs() < 0.5e-3, "{estimate:?}");
            let by = find_contact_of(&record, &phases, Some(&body), ContactChoice::By(estimate.method));
            assert_eq!((by.method, by.tare.displacement), (Some(estimate.method), estimate.displacement));
            assert_eq!(by.displacement_error, by.spread);
            assert!((by.tare.force - 0.1).abs() < 5e-3, "{by:?}");
        }
    }
}

#[test]
fn rules_that_disagree_or_find_nothing_are_reported() {
    // A lump that is met before the body.
    let record = ball(3e-3, 0.0, 0.0, 0.0, 6);
    let lump = |d: f64| if d > 0.5e-3 { 0.05 } else { 0.0 };
    let force = record.force().iter().zip(record.displacement().unwrap()).map(|(f, d)| f + lump(*d)).collect();
    let lumpy = Record::new(record.time().to_vec(), record.displacement().map(<[f64]>::to_vec), force).unwrap();
    let analysis = analyze(&lumpy, &with(CorrectionOptions::default())).unwrap();
    println!("{:?}", analysis.contact);
    assert!(analysis.findings.iter().any(|finding| finding.code() == "touch_spread"), "{:?}", analysis.contact);
    // Without a hold behind the ramp no law says what the loading curve is.
    let stretch = AnalysisOptions {
        touch: ContactChoice::By(TouchMethod::LoadingCurve),
        ..with(CorrectionOptions::default())
    };
    let analysis = analyze(&record, &stretch).unwrap();
    let fell_back = analysis.findings.iter().any(|finding| finding.code() == "touch_not_found");
    assert_eq!(fell_back, analysis.contact.method != Some(TouchMethod::LoadingCurve));
}

#[test]
fn holds_at_the_end_of_a_load_cell_are_named() {
    let record = stairs(50.0, 0.001, 0.0, 1);
    let largest = record.force().iter().fold(0.0f64, |most, force| most.max(*force));
    let clip = 0.7 * largest;
    let force = record.force().iter().map(|force| force.min(clip)).collect();
    let clipped = Record::new(record.time().to_vec(), record.displacement().map(<[f64]>::to_vec), force).unwrap();
    let analysis = analyze(&clipped, &AnalysisOptions::default()).unwrap();
    let reached: Vec<usize> = (1..)
        .zip(analysis.segmentation.holds())
        .filter(|(_, hold)| record.force()[hold.start..hold.end].iter().any(|force| *force >= clip))
        .map(|(number, _)| number)
        .collect();
    assert!(!reached.is_empty() && reached.len() < 6, "{reached:?}");
    let named = analysis.findings.iter().find_map(|finding| match finding {
        Finding::Saturated { holds, .. } => Some(holds.clone()),
        _ => None,
    });
    assert_eq!(named, Some(reached));
}
