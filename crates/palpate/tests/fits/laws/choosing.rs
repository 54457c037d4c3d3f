//! The law that made a hold is the one that is chosen, and short or noisy holds are not judged beyond what they say.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the verdict")]

use palpate::fit::{LawOptions, Samples, forecast};
use palpate::forecast::{Certainty, CompareOptions, Comparison, Ranking, compare_laws, pooled};
use palpate::laws::Law;
use palpate::test_problems::Rng;

/// `samples` samples of `signal` over `duration` s with noise.
fn hold(samples: usize, duration: f64, noise: f64, signal: impl Fn(f64) -> f64) -> (Vec<f64>, Vec<f64>) {
    let mut random = Rng::new(11);
    let times: Vec<f64> = (0..samples).map(|i| duration * i as f64 / (samples - 1) as f64).collect();
    let values = times.iter().map(|t| signal(*t) + noise * random.normal()).collect();
    (times, values)
}

fn compared(times: &[f64], values: &[f64]) -> Comparison {
    compare_laws(&Samples::new(times, values), &CompareOptions::default()).unwrap()
}

#[test]
fn the_law_that_made_the_hold_is_chosen() {
    let latency = |t: f64| 5.0 + 3.0 * (1.0 + 3.3 * 0.8 * t).powf(-1.0 / 3.3);
    let two = |t: f64| 5.0 + 1.5 * (-t / 2.0).exp() + 1.5 * (-t / 40.0).exp();
    let stretched = |t: f64| 5.0 + 3.0 * (-(t / 20.0).powf(0.45)).exp();
    let one = |t: f64| 5.0 + 3.0 * (-t / 30.0).exp();
    let truths: [(&str, &dyn Fn(f64) -> f64); 4] =
        [("latency", &latency), ("prony:2", &two), ("stretched", &stretched), ("standard-linear-solid", &one)];
    for (name, signal) in truths {
        let (times, values) = hold(4000, 300.0, 1e-3, signal);
        let comparison = compared(&times, &values);
        assert_eq!(comparison.ranking, Ranking::Forward, "{name}");
        let verdict = comparison.verdict.as_ref().unwrap();
        assert!(verdict.indistinguishable.contains(&name.parse().unwrap()), "{name}: {verdict:?}");
        let chosen = comparison.rows.iter().find(|row| row.law == verdict.law).unwrap();
        println!("{name}: {} at {:.5}, {:?}", verdict.law, chosen.forward.score.unwrap(), verdict.certainty);
        // The noise of what is predicted is in every error; a good law adds little to it.
        assert!(chosen.forward.score.unwrap() < 2.0 * 1e-3 / 3.0, "{name}: {:?}", chosen.forward);
    }
}

#[test]
fn laws_that_miss_the_shape_cost_what_the_verdict_says() {
    let (times, values) = hold(4000, 300.0, 1e-3, |t| 5.0 + 3.0 * (1.0 + 4.0 * t).powf(-0.25));
    let comparison = compared(&times, &values);
    let verdict = comparison.verdict.as_ref().unwrap();
    let cost = |law: Law| verdict.costs.iter().find(|(other, _)| *other == law).unwrap().1;
    let scores = |law: Law| comparison.rows.iter().find(|row| row.law == law).unwrap().forward.score.unwrap();
    let ratio = scores(Law::StandardLinearSolid) / scores(verdict.law);
    assert!((cost(Law::StandardLinearSolid) / ratio - 1.0).abs() < 1e-12);
    assert!(ratio > 20.0, "{ratio}");
    assert_ne!(verdict.certainty, Certainty::Open);
}

#[test]
fn a_forecast_is_that_of_the_samples_and_not_only_of_their_nodes() {
    let (times, values) = hold(3000, 60.0, 2e-3, |t| 1.0 + 2.0 * (-t / 9.0).exp());
    let law = Law::StandardLinearSolid;
    let options = LawOptions::default();
    let forecast = forecast(&Samples::new(&times, &values), law, &options, 20.0).unwrap();
    let first = forecast.fitted;
    let fit = palpate::fit::fit_law(&Samples::new(&times[..first], &values[..first]), law, &options).unwrap();
    let errors: Vec<f64> = times[first..].iter().zip(&values[first..]).map(|(t, y)| fit.predict(*t) - y).collect();
    let rmse = (errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64).sqrt();
    println!("forecast {:e}, samples {rmse:e}", forecast.rmse);
    assert!((forecast.rmse / rmse - 1.0).abs() < 5e-3, "{} {rmse}", forecast.rmse);
    assert_eq!(forecast.fitted + forecast.held_out, 3000);
}

#[test]
fn holds_that_predict_nothing_are_ranked_by_information() {
    // Over after a second: nothing changes after the first cut.
    let (times, values) = hold(2000, 100.0, 1e-2, |t| 1.0 + (-t / 0.3).exp());
    let over = compared(&times, &values);
    assert_eq!(over.ranking, Ranking::Information);
    assert!(over.cuts.is_empty() && over.verdict.is_some());
    // Thirty samples are too few to cut.
    let (times, values) = hold(30, 10.0, 1e-3, |t| 1.0 + (-t / 3.0).exp());
    assert_eq!(compared(&times, &values).ranking, Ranking::Information);
}

#[test]
fn a_noisy_hold_is_given_the_simplest_law_that_does() {
    let (times, values) = hold(300, 10.0, 0.1, |t| 1.0 + (-t / 3.0).exp());
    let verdict = compared(&times, &values).verdict.unwrap();
    assert!(
        verdict.indistinguishable.len() > 1 && verdict.indistinguishable.contains(&Law::StandardLinearSolid),
        "{verdict:?}"
    );
    assert_ne!(verdict.law, Law::Spectrum);
}

#[test]
fn holds_together_distinguish_what_one_leaves_open() {
    let mut random = Rng::new(5);
    let truth: Law = "latency:5".parse().unwrap();
    let holds: Vec<Comparison> = (0..8)
        .map(|_| {
            let times: Vec<f64> = (0..400).map(|i| 0.1 * f64::from(i)).collect();
            let values: Vec<f64> =
                times.iter().map(|t| 1.0 + (1.0 + 4.0 * t).powf(-0.25) + 0.02 * random.normal()).collect();
            compared(&times, &values)
        })
        .collect();
    let alone: usize = holds.iter().map(|hold| hold.verdict.as_ref().unwrap().indistinguishable.len()).sum();
    let together = pooled(&holds.iter().collect::<Vec<_>>()).unwrap();
    println!("{:.1} laws of one hold, together {together:?}", alone as f64 / 8.0);
    assert!(together.indistinguishable.contains(&truth), "{together:?}");
    assert!(8 * together.indistinguishable.len() < alone, "{together:?} {alone}");
    assert_eq!(together.law, truth);
    // Two holds say nothing of the scatter between holds.
    assert!(pooled(&holds.iter().take(2).collect::<Vec<_>>()).is_none());
}

/// Three holds of 16 samples, of which nothing is held out, distinguished the dense spectrum "from every other law".
#[test]
fn short_holds_together_distinguish_no_laws_that_fit_alike() {
    let mut random = Rng::new(1);
    for _ in 0..10 {
        let hold = |level: f64, random: &mut Rng| {
            let times: Vec<f64> = (0..16).map(|i| 0.02 * f64::from(i)).collect();
            let values: Vec<f64> =
                times.iter().map(|t| level * (1.2 + 1.8 * (-t / 4.0).exp()) + 2e-3 * random.normal()).collect();
            compare_laws(&Samples::new(&times, &values), &CompareOptions::default()).unwrap()
        };
        let holds = [1.0, 2.0, 3.0].map(|level| hold(level, &mut random));
        assert!(holds.iter().all(|hold| hold.ranking == Ranking::Information));
        let found = pooled(&holds.iter().collect::<Vec<_>>());
        assert!(found.as_ref().is_none_or(|found| found.indistinguishable.len() > 1), "{found:?}");
    }
}

/// A series of three exponentials that followed the noise left residuals like a walk: 3 of 600 samples counted, and no law was refuted.
#[test]
fn white_noise_counts_in_full_whatever_the_closest_law_leaves() {
    let mut random = Rng::new(9);
    let laws = ["latency:3", "prony:3", "sls"].map(|name| name.parse().unwrap()).to_vec();
    let options = CompareOptions {
        laws,
        forecast: false,
        ..CompareOptions::default()
    };
    let mut collapsed = 0;
    for hold in 0..300 {
        let times: Vec<f64> = (0..600).map(|i| 0.1 * f64::from(i)).collect();
        let values: Vec<f64> = times.iter().map(|t| 4.9 + 2.1 / (1.0 + t).sqrt() + 1e-2 * random.normal()).collect();
        let found = compare_laws(&Samples::new(&times, &values), &options).unwrap();
        let fit = |law: &str| found.rows.iter().find(|row| row.law.to_string() == law).unwrap().fit.as_ref().unwrap();
        let (truth, series) = (fit("latency:3"), fit("prony:3"));
        collapsed +=
            usize::from(series.rmse < truth.rmse && series.effective_samples() < 0.1 * truth.effective_samples());
        assert!(found.effective_samples >= truth.effective_samples(), "{hold}: {}", found.effective_samples);
    }
    assert!(collapsed > 0, "the test shows what it is to show");
}

/// The claim that the project rests on, on a record measured by others.
#[test]
fn four_numbers_predict_half_an_hour_of_tape_as_well_as_a_dense_spectrum() {
    let folder = std::env::var("PALPATE_DATA")
        .unwrap_or_else(|_| concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/data").to_owned());
    let Ok(bytes) = std::fs::read(format!("{folder}/vhb4910/relax_3d0.csv")) else {
        println!("skipped: no measured records in {folder} (set PALPATE_DATA)");
        return;
    };
    // One header in another encoding; the parameters are plain.
    let rows: Vec<[f64; 3]> = bytes
        .split(|byte| *byte == b'\n')
        .filter_map(|line| {
            let text = String::from_utf8_lossy(line).replace('"', "");
            let mut fields = text.trim().split(',').map(str::parse::<f64>);
            Some([fields.next()?.ok()?, fields.next()?.ok()?, fields.next()?.ok()?])
        })
        .collect();
    let peak = (0..rows.len()).max_by(|a, b| rows[*a][2].total_cmp(&rows[*b][2])).unwrap();
    let start = rows[peak][0] + 0.5;
    let kept: Vec<&[f64; 3]> = rows[peak..].iter().filter(|row| row[0] >= start).collect();
    let mut times: Vec<f64> = kept.iter().map(|row| row[0] - start).collect();
    let mut values: Vec<f64> = kept.iter().map(|row| row[2]).collect();
    let rising = times.windows(2).take_while(|pair| pair[1] > pair[0]).count() + 1;
    times.truncate(rising);
    values.truncate(rising);
    let comparison = compared(&times, &values);
    let score = |law: &str| {
        let law: Law = law.parse().unwrap();
        comparison.rows.iter().find(|row| row.law == law).unwrap().forward.score.unwrap()
    };
    for row in &comparison.rows {
        println!(
            "{:22} {:5.1} parameters, forward error {:.5}",
            row.law.to_string(),
            row.effective_parameters,
            row.forward.score.unwrap()
        );
    }
    assert!(score("latency") < 0.004);
    assert!(score("latency") < 1.5 * score("spectrum"));
    assert!(score("prony:2") > 10.0 * score("latency") && score("stretched") > 10.0 * score("latency"));
    assert_eq!(comparison.verdict.unwrap().law.to_string(), "latency");
}

/// The spectrum took every sample for one of a standard deviation of 1, and its information criterion stood beside those of laws that did not: a constant
/// weight of 50 refuted the law that made the hold, by 1553.
#[test]
fn a_constant_standard_deviation_changes_no_comparison() {
    let (times, values) = hold(201, 40.0, 0.02, |t| 5.0 + 1.5 * (-t / 2.0).exp() + 1.5 * (-t / 20.0).exp());
    let plain = compared(&times, &values);
    for deviation in [1e-3, 0.02, 50.0] {
        let deviations = vec![deviation; 201];
        let samples = Samples::new(&times, &values).with_standard_deviations(&deviations);
        let weighted = compare_laws(&samples, &CompareOptions::default()).unwrap();
        for row in &weighted.rows {
            let same = plain.rows.iter().find(|other| other.law == row.law).unwrap();
            let [found, expected] = [row.delta_bic, same.delta_bic].map(Option::unwrap_or_default);
            assert!((found - expected).abs() < 1e-6 * (1.0 + expected), "{deviation} {}: {found} {expected}", row.law);
        }
        assert_eq!(weighted.verdict.map(|verdict| verdict.law), plain.verdict.as_ref().map(|verdict| verdict.law));
    }
}
