//! The list of exponents that is fitted to every hold, and its extension.
#![expect(clippy::unwrap_used, reason = "a test that cannot run has failed")]

use palpate::analysis::{Analysis, AnalysisOptions, Finding, analyze};
use palpate::latency::decay;
use palpate::record::Record;
use palpate::segment::GivenHold;
use palpate::test_problems::Rng;

/// Two holds of 20 s with these exponents, noise of 1e-4 of the drop, fitted with a list.
fn analysis(exponents: [f64; 2], listed: &[f64]) -> Analysis {
    analysis_above(1.0, exponents, listed)
}

/// The same with another equilibrium.
fn analysis_above(equilibrium: f64, exponents: [f64; 2], listed: &[f64]) -> Analysis {
    let mut random = Rng::new(7);
    let time: Vec<f64> = (0..2000).map(|i| 0.02 * f64::from(i)).collect();
    let value = |t: &f64| {
        let (start, exponent) = if *t < 20.0 { (0.0, exponents[0]) } else { (20.0, exponents[1]) };
        equilibrium + decay(5.0 * (t - start), exponent) + 1e-4 * random.normal()
    };
    let force = time.iter().map(value).collect();
    let hold = |from, to| GivenHold { from, to, mode: None };
    let options = AnalysisOptions {
        given_holds: vec![hold(0.0, 19.97), hold(20.0, 39.97)],
        exponents: listed.to_vec(),
        compare: None,
        ..AnalysisOptions::default()
    };
    analyze(&Record::new(time, None, force).unwrap(), &options).unwrap()
}

fn extension(analysis: &Analysis) -> Option<(Vec<f64>, Vec<usize>, bool)> {
    analysis.findings.iter().find_map(|finding| match finding {
        Finding::ExponentListExtended { added, holds, open, .. } => Some((added.clone(), holds.clone(), *open)),
        _ => None,
    })
}

#[test]
fn a_list_that_ends_too_early_is_extended_until_the_criterion_turns() {
    // Mistake: "--exponents 1,2,3" for a body with n = 5 reported n = 3 without remark.
    let analysis = analysis([5.0, 5.0], &[1.0, 2.0, 3.0]);
    assert_eq!(extension(&analysis), Some((vec![5.0, 7.0], vec![1, 2], false)));
    assert_eq!(analysis.across.common_exponent, Some(5.0));
    for hold in &analysis.holds {
        let fitted: Vec<f64> = hold.order.as_ref().unwrap().candidates.iter().map(|one| one.exponent).collect();
        assert_eq!(fitted[..5], [1.0, 2.0, 3.0, 5.0, 7.0]);
        assert!((fitted[5] - 5.0).abs() < 0.2, "{fitted:?}");
        assert_eq!((hold.fits.len(), hold.rate_fits.len(), hold.predictions.len()), (6, 6, 6));
    }
}

#[test]
fn all_holds_are_fitted_with_the_exponents_that_one_of_them_needs() {
    let analysis = analysis([2.0, 10.0], &[2.0, 3.0]);
    // The first hold is at the lower end of the list, the second at the upper one.
    assert_eq!(extension(&analysis), Some((vec![1.0, 5.0, 7.0, 10.0, 14.0], vec![1, 2], false)));
    assert!(analysis.holds.iter().all(|hold| hold.fits.len() == 8));
    assert_eq!(analysis.across.evidence.len(), 7);
}

#[test]
fn a_list_that_brackets_the_best_exponent_and_a_list_of_one_stay() {
    assert_eq!(extension(&analysis([3.0, 3.0], &[1.0, 2.0, 3.0, 5.0])), None);
    let one = analysis([3.0, 3.0], &[2.0]);
    assert_eq!((extension(&one), one.holds[0].fits.len()), (None, 2));
}

#[test]
fn a_criterion_that_never_turns_is_reported_as_open() {
    let analysis = analysis([30.0, 30.0], &[14.0, 20.0]);
    assert_eq!(extension(&analysis), Some((vec![30.0], vec![1, 2], true)));
    let finding = analysis.findings.iter().find(|finding| finding.code() == "exponent_list_extended").unwrap();
    assert_eq!(
        finding.observation(),
        "the information criterion of holds 1, 2 was lowest at an end of the listed exponents 14, 20; 30 was added, and it is still lowest at the largest"
    );
}

#[test]
fn an_exponent_that_the_data_contradict_is_reported() {
    // Mistake: n = 5 was "the lowest order not distinguishable from the best" for a body of n = 4, which the free exponent shows.
    let reported = |exponents, listed: &[f64]| {
        let analysis = analysis(exponents, listed);
        analysis.findings.into_iter().find(|finding| finding.code() == "exponent_not_listed")
    };
    let Some(Finding::ExponentNotListed { free, delta_bic, .. }) = reported([4.0, 4.0], &[1.0, 2.0, 3.0, 5.0, 7.0])
    else {
        panic!("no finding")
    };
    assert!(delta_bic > 100.0 && free.len() == 2, "{free:?} {delta_bic}");
    assert!(free.iter().all(|(_, exponent)| (exponent - 4.0).abs() < 0.1), "{free:?}");
    assert_eq!(reported([5.0, 5.0], &[1.0, 2.0, 3.0, 5.0, 7.0]), None);
    assert_eq!(reported([5.0, 3.0], &[3.0, 5.0]).map(|finding| finding.code()), Some("exponent_not_listed"));
}

#[test]
fn an_equilibrium_at_which_a_pressed_body_would_pull_is_reported() {
    // An indentation of 10 s had an equilibrium of −2.6 [−3.3, −1.8] N without a word.
    let codes = |equilibrium| {
        let analysis = analysis_above(equilibrium, [3.0, 3.0], &[2.0, 3.0, 5.0]);
        let of_hold = |hold: &palpate::analysis::HoldAnalysis| {
            hold.findings.iter().find(|finding| finding.code() == "equilibrium_beyond_zero").cloned()
        };
        analysis.holds.iter().map(of_hold).collect::<Vec<_>>()
    };
    for finding in codes(-0.03) {
        let Some(Finding::EquilibriumBeyondZero { share, interval, .. }) = finding else {
            panic!("no finding")
        };
        // The force at the end is −0.03 + (1 + 2 · 5 · 20)^−½ = 0.0405.
        assert!((share + 0.74).abs() < 0.05 && interval.0 < share && share < interval.1, "{share} {interval:?}");
        assert!(interval.1 < 0.0, "{interval:?}");
    }
    assert_eq!(codes(0.0), [None, None]);
}
