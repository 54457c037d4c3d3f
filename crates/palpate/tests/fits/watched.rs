//! A watch hears of a fit as it goes on, changes nothing, and ends it at any time.

use palpate::fit::{
    BootstrapOptions, FitError, IntervalMethod, JointOptions, LawOptions, Loss, Samples, fit_joint, fit_joint_watched,
    fit_law, fit_law_watched,
};
use palpate::laws::{ExponentChoice, Law};
use palpate::watch::{Cancelled, Progress};

/// A relaxation of 60 s with two times, and a ripple that no law has.
fn hold(samples: u32) -> (Vec<f64>, Vec<f64>) {
    let times: Vec<f64> = (0..samples).map(|i| 60.0 * f64::from(i) / f64::from(samples - 1)).collect();
    let value = |t: &f64| 1.0 + (-t / 2.0).exp() + 0.5 * (-t / 20.0).exp() + 1e-3 * (37.0 * t).sin();
    let values = times.iter().map(value).collect();
    (times, values)
}

/// Runs `fit` watched to its end, and then ended at several of its reports; returns what it found and how often it reported.
fn ended<T: std::fmt::Debug>(
    fit: impl Fn(&mut dyn FnMut(Progress<'_>) -> Result<(), Cancelled>) -> Result<T, FitError>,
) -> (T, usize) {
    let mut reports = 0;
    let whole = fit(&mut |_| {
        reports += 1;
        Ok(())
    });
    for stop in [1, 2, reports / 3, reports / 2, reports - 1, reports] {
        let mut heard = 0;
        let error = fit(&mut |_| {
            heard += 1;
            if heard < stop { Ok(()) } else { Err(Cancelled) }
        });
        assert_eq!(
            error.expect_err("the watch ended it"),
            FitError::Cancelled(Cancelled),
            "at report {stop} of {reports}"
        );
        assert_eq!(heard, stop, "it goes on after report {stop} of {reports}");
    }
    (whole.expect("nothing ended it"), reports)
}

/// Nobody heard of the errors of a fit, which take as long as the search where samples are millions.
#[test]
fn errors_of_a_fit_are_heard_of_after_its_search() {
    let (times, values) = hold(800);
    let options = LawOptions::default();
    let mut at_evaluations = Vec::new();
    let mut watch = |progress: Progress<'_>| {
        at_evaluations.push(progress.done);
        Ok::<(), Cancelled>(())
    };
    fit_law_watched(&Samples::new(&times, &values), Law::StandardLinearSolid, &options, &mut watch).unwrap();
    let last = at_evaluations.last().unwrap();
    let after = at_evaluations.iter().filter(|done| *done == last).count();
    assert!(after >= 4, "{after} reports at {last} evaluations");
}

#[test]
fn a_fit_ends_between_any_two_evaluations() {
    let (times, values) = hold(800);
    let samples = Samples::new(&times, &values);
    let latency = Law::Latency {
        exponent: ExponentChoice::Free,
    };
    let plain = LawOptions::default();
    let cases = [
        (latency, plain.clone()),
        (Law::Prony { terms: 4 }, plain.clone()),
        (
            Law::Prony { terms: 2 },
            LawOptions {
                loss: Loss::Tukey,
                ..plain.clone()
            },
        ),
        (
            Law::StandardLinearSolid,
            LawOptions {
                intervals: IntervalMethod::Profile,
                ..plain.clone()
            },
        ),
        (
            Law::StandardLinearSolid,
            LawOptions {
                intervals: IntervalMethod::Bootstrap(BootstrapOptions {
                    repetitions: 99,
                    ..BootstrapOptions::default()
                }),
                ..plain
            },
        ),
    ];
    for (law, options) in cases {
        let (fit, reports) = ended(|mut watch| fit_law_watched(&samples, law, &options, &mut watch));
        assert_eq!(fit, fit_law(&samples, law, &options).unwrap());
        // Every evaluation of the columns over the samples is heard, and those over condensed ones.
        assert!(reports as u64 >= fit.work.evaluations + fit.work.condensed, "{law:?}: {reports} {:?}", fit.work);
    }
}

#[test]
fn a_joint_fit_ends_between_any_two_evaluations() {
    let ((times, first), (_, second)) = (hold(200), hold(200));
    let second: Vec<f64> = second.iter().map(|value| 3.0 - 0.5 * value).collect();
    let holds = [Samples::new(&times, &first), Samples::new(&times, &second)];
    let options = JointOptions::default();
    for law in [
        Law::Prony { terms: 2 },
        Law::Latency {
            exponent: ExponentChoice::Free,
        },
    ] {
        let (fit, reports) = ended(|mut watch| fit_joint_watched(&holds, law, &options, &mut watch));
        assert_eq!(fit, fit_joint(&holds, law, &options).unwrap());
        assert!(reports as u64 >= fit.work.evaluations + fit.work.condensed, "{law:?}: {reports} {:?}", fit.work);
    }
}
