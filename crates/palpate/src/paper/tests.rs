//! Verdicts that turn when a number is changed.

use super::claims::{half_travel, strain_error};
use super::*;
use crate::watch::Unwatched;

const FEW: LaboratoryOptions = LaboratoryOptions {
    seeds: 6,
    sample_rate: 20.0,
    repeatability: 0.02,
};

fn made(paper: &Published) -> Reproduction {
    reproduce(paper, &FEW, &mut Unwatched).unwrap()
}

fn verdict(study: &Reproduction, place: Place, start: &str) -> Verdict {
    let claims = study.claims.iter();
    let found: Vec<&Claim> =
        claims.filter(|claim| claim.place == place && claim.statement.starts_with(start)).collect();
    assert_eq!(found.len(), 1, "{place}: {start}");
    found[0].verdict()
}

const MATCH: (Place, &str) = (Place::Section("Abstract"), "Simulation and experiment");
const STRAINS: (Place, &str) = (Place::Table("I"), "εₑ at the five steps");
const TIMING: (Place, &str) = (Place::Section("III-B"), "Five steps");
const CONSTANT: (Place, &str) = (Place::Section("II"), "v and n are constants");
const FORCE: (Place, &str) = (Place::Equation("11"), "");
const ORDER: (Place, &str) = (
    Place::Equation("10"),
    "n = 5 is the lowest order that fits best (closed form fitted against time; independent",
);

/// One test, since each study is made of two simulated and analysed tests.
#[test]
fn verdicts_turn_when_a_number_is_changed() {
    let paper = Published::default();
    let study = made(&paper);
    every_number_has_a_claim(&study);
    use Verdict::{NotReproduced, Reproduced};
    let of = |study: &Reproduction, (place, start): (Place, &str)| verdict(study, place, start);
    let all = [MATCH, STRAINS, CONSTANT, TIMING, FORCE, ORDER];
    let as_printed = all.map(|claim| of(&study, claim));
    assert_eq!(as_printed, [NotReproduced, NotReproduced, NotReproduced, Reproduced, Reproduced, Reproduced]);
    // A stiffer ball, shorter holds, and a table with the strains of the simulation.
    let other = made(&Published {
        modulus: 40e3,
        hold: 9.0,
        equilibria: paper.uniform_strains().unwrap(),
        coefficients: [None, Some(2e4), Some(2e4), None, None],
        ..paper.clone()
    });
    let changed = all.map(|claim| of(&other, claim));
    assert_eq!(changed, [Reproduced, Reproduced, Reproduced, NotReproduced, NotReproduced, Reproduced]);
    // The cubic law, with v for about the same excess strain after the first ramp.
    let cubic = made(&Published {
        exponent: 3.0,
        simulated_coefficient: 350.0,
        coefficients: [None, Some(460.0), Some(350.0), None, None],
        ..paper
    });
    assert_eq!(of(&cubic, ORDER), NotReproduced);
    assert_eq!(of(&cubic, FORCE), NotReproduced);
    // The full travel is not that of one contact, in equation (8) and in section IV.
    assert!(strain_error(&study, 0.5) < 1e-9 && strain_error(&study, 1.0) > 0.4);
    assert!(half_travel(&study, 0.5).unwrap() < 1e-9 && half_travel(&study, 1.0).unwrap() > 1.0);
    // Seeds are numbered: whoever counts them finds the same laboratories.
    assert_eq!(laboratories(&study.published, &FEW, &mut Unwatched).unwrap(), study.laboratories);
}

fn every_number_has_a_claim(study: &Reproduction) {
    let has = |place: Place| study.claims.iter().any(|claim| claim.place == place);
    for number in ["1", "2", "3", "4", "5", "6", "7", "8", "9", "10", "11"] {
        assert!(has(Place::Equation(number)), "equation {number}");
    }
    for number in ["1(a)", "1(b)", "2", "3", "4(a)", "4(b)", "5", "6(a)", "6(b)", "7", "8"] {
        assert!(has(Place::Figure(number)), "figure {number}");
    }
    assert!(has(Place::Table("I")) && has(Place::Table("II")));
    for claim in &study.claims {
        assert!(claim.verdict() != Verdict::CannotBeChecked || claim.remark.len() > 10, "{}", claim.statement);
        assert!(claim.comparisons.iter().all(|comparison| !comparison.reason.is_empty()), "{}", claim.statement);
        assert!(claim.comparisons.iter().all(|c| c.ours.value.is_finite() && c.paper.value.is_finite()), "{claim:?}");
    }
    // What is not reproduced stands first.
    let count = study.count(Verdict::NotReproduced);
    assert!(study.claims[..count].iter().all(|claim| claim.verdict() == Verdict::NotReproduced));
    assert_eq!(count + study.count(Verdict::Reproduced) + study.count(Verdict::CannotBeChecked), study.claims.len());
}

#[test]
fn options_out_of_range_are_refused() {
    let refused =
        |options: LaboratoryOptions| laboratories(&Published::default(), &options, &mut Unwatched).unwrap_err();
    assert!(matches!(refused(LaboratoryOptions { seeds: 0, ..FEW }), PaperError::Seeds { found: 0, .. }));
    for rate in [0.0, -1.0, 1.0, f64::NAN, f64::INFINITY] {
        let error = refused(LaboratoryOptions {
            sample_rate: rate,
            ..FEW
        });
        assert!(matches!(error, PaperError::SampleRate { least: 2.0, .. }), "{error}");
    }
    for repeatability in [-0.01, 0.21, f64::NAN] {
        let error = refused(LaboratoryOptions { repeatability, ..FEW });
        assert!(matches!(error, PaperError::Repeatability { most: 0.2, .. }), "{error}");
    }
    let fast = refused(LaboratoryOptions {
        sample_rate: 1e6,
        ..FEW
    });
    assert_eq!(fast.to_string(), "sampling rate: at most 10000 Hz, found 1000000 Hz");
}
