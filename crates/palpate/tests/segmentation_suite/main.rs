//! Holds in a thousand records whose truth is known. By default the first few are searched; `PALPATE_SUITE=1000` asks for
//! more, and `cargo run --release -p palpate --example segmentation_suite` prints the table of `validation/results/segmentation.md`.
#![allow(clippy::unwrap_used, reason = "in a test a panic is the verdict")]

mod others;
mod protocols;
mod record;
mod score;
mod suite;

use score::{Score, quantile, rows, scored, table};

fn records() -> u64 {
    std::env::var("PALPATE_SUITE").ok().and_then(|text| text.parse().ok()).unwrap_or(100)
}

#[test]
fn holds_of_constant_displacement_or_force_are_found() {
    let all: Vec<_> = (0..records()).map(|number| scored(&suite::labelled(number), false)).collect();
    let rows = rows(&all);
    println!("{}", table(&rows));
    let total: &Score = &rows.last().unwrap().1;
    assert!(total.found_share() >= 0.99, "{total:?}");
}
