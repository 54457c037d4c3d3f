//! Holds in records whose truth is known. By default the first hundred are searched, `PALPATE_SUITE=1000` asks for more, and
//! `cargo run --release -p palpate --example segmentation_suite` prints the tables of `validation/results/segmentation.md`.
#![allow(clippy::unwrap_used, reason = "in a test a panic is the verdict")]
#![allow(unreachable_pub, dead_code, reason = "the example uses the rest of these modules")]

mod others;
mod protocols;
mod quirks;
mod record;
mod score;
mod suite;

use score::{Score, quantile, scored};
use suite::Kind;

fn records() -> u64 {
    std::env::var("PALPATE_SUITE").ok().and_then(|text| text.parse().ok()).unwrap_or(100)
}

#[test]
fn holds_of_a_force_alone_are_found() {
    let mut score = Score::default();
    (0..records()).for_each(|number| score.add(&scored(&suite::labelled(number), true).score));
    assert!(score.found_share() >= 0.9, "{}", reported(&score));
    assert!(score.extra <= score.holds / 15, "{}", reported(&score));
    assert!(quantile(&score.sharp[0], 0.9).unwrap() <= 4.0, "{}", reported(&score));
}

/// The scores of records of some kinds, added.
fn sum(keep: impl Fn(Kind, f64) -> bool) -> Score {
    let mut sum = Score::default();
    for number in 0..records() {
        let labelled = suite::labelled(number);
        if keep(labelled.kind, labelled.noise) {
            sum.add(&scored(&labelled, false).score);
        }
    }
    sum
}

fn reported(score: &Score) -> String {
    format!("{} of {} holds, {} extra, {} turned", score.found, score.holds, score.extra, score.turned)
}

#[test]
fn holds_of_constant_displacement_are_found() {
    let score = sum(|kind, _| kind != Kind::ForceHeld);
    println!("{}", reported(&score));
    assert!(score.found_share() >= 0.99, "{}", reported(&score));
    assert_eq!(score.extra, 0, "{}", reported(&score));
}

/// The crosshead of one hold was cut into nine, free air was a hold, and so were waves of a ramp.
#[test]
fn machines_with_quirks_are_read_as_what_they_do() {
    let mut all = Score::default();
    (0..records()).for_each(|number| all.add(&scored(&quirks::quirky(number), false).score));
    assert!(all.found_share() >= 0.98 && all.extra == 0, "{}", reported(&all));
}

/// Steps of a drift that was rounded; a standstill of the jaw cut in two by a level of the force; the force on a hard sample, up to and over its
/// turn; the last wave of a ramp; and the samples in which a force leaves its level: each was a hold.
#[test]
fn what_was_a_hold_and_is_none() {
    let records = [639, 864].map(suite::labelled).into_iter().chain([59, 374, 962].map(quirks::quirky));
    for labelled in records {
        let score = scored(&labelled, false).score;
        assert_eq!(score.extra, 0, "{:?}: {}", labelled.kind, reported(&score));
    }
}

#[test]
fn no_hold_is_found_where_there_is_none() {
    let score = sum(|kind, _| matches!(kind, Kind::Triangle | Kind::Sine | Kind::Ramps | Kind::Still | Kind::Creeping));
    assert_eq!(score.extra, 0, "{}", reported(&score));
}

#[test]
fn edges_are_within_two_samples_at_one_per_cent_of_noise() {
    let score = sum(|kind, noise| kind != Kind::ForceHeld && noise == 1e-2);
    assert!(score.found_share() >= 0.98, "{}", reported(&score));
    for errors in &score.sharp {
        assert!(quantile(errors, 0.95).unwrap() <= 2.0, "{}", reported(&score));
    }
    assert!(quantile(&score.blunt, 0.95).unwrap() <= 6.0, "{}", reported(&score));
}

#[test]
fn holds_of_constant_force_are_found() {
    let score = sum(|kind, _| kind == Kind::ForceHeld);
    assert!(score.found_share() >= 0.98, "{}", reported(&score));
    assert_eq!(score.extra, 0, "{}", reported(&score));
}
