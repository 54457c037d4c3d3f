//! Relaxation of seals over days: readings ever more rarely, every ten minutes, and again after a release.

use super::phases;
use palpate::analysis::{AnalysisOptions, Finding, analyze};
use palpate::fit::ParameterKind;
use palpate::record::Record;
use palpate::segment::After;
use palpate::test_problems::Rng;

const HOUR_S: f64 = 3600.0;

/// Force in N at a time after the compression, s: a logarithm of time, and the latency law with n = 5, of 300 N.
const LAWS: [fn(f64) -> f64; 2] =
    [|t| 300.0 - 6.0 * (1.0 + t).ln(), |t| 180.0 + 120.0 * (1.0 + 4.0 * t / 50.0).powf(-0.25)];

fn with_noise(force: impl Iterator<Item = f64>, noise: f64, seed: u64) -> Vec<f64> {
    let mut numbers = Rng::new(seed);
    force.map(|force| force + noise * numbers.normal()).collect()
}

#[test]
fn a_force_read_ever_more_rarely_for_a_week_was_a_hold_of_hours() {
    for law in LAWS {
        for (hours, seed) in [(24.0, 1), (168.0, 2)] {
            let ramp = (0..300).map(|i| 0.01 * f64::from(i));
            let decades = (hours * HOUR_S / 0.05f64).ln();
            let hold = (0..400).map(|i| 3.0 + 0.05 * (decades * f64::from(i) / 399.0).exp());
            let time: Vec<f64> = ramp.chain(hold).collect();
            let force = |t: &f64| {
                if *t < 1.0 {
                    0.0
                } else if *t < 3.0 {
                    150.0 * (t - 1.0)
                } else {
                    law(t - 3.0)
                }
            };
            let force = with_noise(time.iter().map(force), 0.15, seed);
            let found = phases(&Record::new(time.clone(), None, force).unwrap()).unwrap();
            let holds: Vec<_> = found.holds().collect();
            assert_eq!(holds.len(), 1, "{hours} h: {found:?}");
            assert!(
                (time[holds[0].start] - 3.0).abs() < 0.1 && holds[0].end == time.len(),
                "{hours} h: {:?}",
                holds[0]
            );
        }
    }
}

#[test]
fn a_relaxation_whose_first_reading_shows_a_third_of_it_was_no_hold() {
    for law in LAWS {
        let time: Vec<f64> = (0..1009).map(|i| 600.0 * f64::from(i)).collect();
        for noise in [0.02, 0.1, 0.3] {
            let force = with_noise(time.iter().map(|t| law(t + 60.0)), noise, 3);
            let found = phases(&Record::new(time.clone(), None, force).unwrap()).unwrap();
            assert_eq!(found.segments.len(), 1, "{noise} N: {found:?}");
        }
    }
}

/// A seal at 1.6 mm read every minute, let go between two rows for some rows and pressed again, three times.
fn recompressed(rows: usize, seed: u64) -> (Record, usize) {
    let (mut jaw, mut pressed_for) = (vec![0.0; 10], vec![]);
    for _ in 0..3 {
        jaw.extend(vec![1.6e-3; 240]);
        pressed_for.extend((0..240).map(|i| 60.0 * f64::from(i)));
        jaw.extend(vec![0.0; rows]);
    }
    let mut pressed_for = pressed_for.into_iter();
    let force = jaw.iter().map(|jaw| if *jaw > 0.0 { LAWS[0](pressed_for.next().unwrap()) } else { 0.0 });
    let force = with_noise(force.collect::<Vec<_>>().into_iter(), 0.15, seed);
    let displacement = with_noise(jaw.iter().copied(), 5e-7, seed + 1);
    let time = (0..jaw.len()).map(|i| 60.0 * i as f64).collect();
    (Record::new(time, Some(displacement), force).unwrap(), 3)
}

#[test]
fn a_seal_pressed_again_between_two_rows_was_held_after_unloading() {
    for rows in [2, 3, 5, 12] {
        let (record, count) = recompressed(rows, 7);
        let analysis = analyze(&record, &AnalysisOptions::default()).unwrap();
        let loaded: Vec<_> = analysis.holds.iter().filter(|hold| hold.displacement > Some(1e-3)).collect();
        assert_eq!(loaded.len(), count, "{rows} rows: {:?}", analysis.segmentation);
        assert!(loaded.iter().all(|hold| hold.after == Some(After::Loading)), "{rows} rows");
        // Rows in which the jaw has gone away, too, are no outliers of the force.
        let strays = analysis.findings.iter().find(|finding| matches!(finding, Finding::RowsStray { .. }));
        assert!(strays.is_none(), "{rows} rows: {strays:?}");
    }
}

#[test]
fn the_equilibrium_of_a_series_that_lacks_its_slowest_term_was_sure() {
    // The slowest term takes four times as long as the hold, of 24 h read at even steps of ln t.
    let force = |t: f64| {
        let terms = [(30.0, 60.0), (30.0, 1500.0), (36.0, 3e4), (54.0, 4.0 * 24.0 * HOUR_S)];
        150.0 + terms.iter().map(|(size, time)| size * (-t / time).exp()).sum::<f64>()
    };
    let time: Vec<f64> = (0..400).map(|i| (24.0 * HOUR_S).powf(f64::from(i) / 399.0)).collect();
    let options = AnalysisOptions::default();
    // The law, whether its interval leaves the truth out, and the findings.
    let found = |force: Vec<f64>| {
        let displacement = Some(vec![1.6e-3; time.len()]);
        let analysis = analyze(&Record::new(time.clone(), displacement, force).unwrap(), &options).unwrap();
        let hold = &analysis.holds[0];
        let comparison = hold.comparison.as_ref().unwrap();
        let law = comparison.verdict.as_ref().unwrap().law;
        let fit = comparison.rows.iter().find(|row| row.law == law).and_then(|row| row.fit.as_ref().ok());
        let interval = fit.and_then(|fit| fit.parameter(ParameterKind::Equilibrium)?.estimate.interval);
        let misses = interval.is_some_and(|(low, high)| !(low..=high).contains(&150.0));
        (law, misses, hold.findings.clone())
    };
    let by_law = |finding: &Finding| matches!(finding, Finding::EquilibriumByLaw { .. });
    let is_open = |finding: &Finding| {
        by_law(finding) || matches!(finding, Finding::EquilibriumExtrapolated { .. } | Finding::TimeBeyondHold { .. })
    };
    let mut series = 0;
    for seed in 0..4 {
        let (law, misses, findings) = found(with_noise(time.iter().map(|t| force(*t)), 0.15, seed));
        assert!(!misses || findings.iter().any(is_open), "{seed}: {law}: {findings:?}");
        series += usize::from(misses && findings.iter().any(by_law));
        // A series that has ended is known as well as its interval says.
        let ended = |t: &f64| 150.0 + 50.0 * (-t / 60.0).exp() + 60.0 * (-t / 5000.0).exp();
        let (law, _, findings) = found(with_noise(time.iter().map(ended), 0.15, seed));
        assert!(!findings.iter().any(is_open), "{seed}: {law}: {findings:?}");
    }
    assert!(series > 0);
}
