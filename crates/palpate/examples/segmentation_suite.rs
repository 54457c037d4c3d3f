//! Holds found in records whose truth is known; prints the tables of `validation/results/segmentation.md`.
//!
//! Run it with `cargo run --release -p palpate --example segmentation_suite [records] [first]`; `each` as a third word lists every
//! record in which something is missed or extra.

#![allow(unreachable_pub, dead_code, reason = "these modules are those of the test")]

#[path = "../tests/records/segmentation_suite/others.rs"]
mod others;
#[path = "../tests/records/segmentation_suite/protocols.rs"]
mod protocols;
#[path = "../tests/records/segmentation_suite/quirks.rs"]
mod quirks;
#[path = "../tests/records/segmentation_suite/record.rs"]
mod record;
#[path = "../tests/records/segmentation_suite/score.rs"]
mod score;
#[path = "../tests/records/segmentation_suite/suite.rs"]
mod suite;

use score::{Scored, rows, scored, table};

/// True and found holds of one record, in samples.
fn one(labelled: &suite::Labelled) {
    let time = labelled.record.time();
    for hold in &labelled.holds {
        let samples = [hold.start, hold.end].map(|t| time.partition_point(|time| *time < t));
        println!("true  {samples:?} after {:?}, limits {:.2?}", hold.after, hold.limits);
    }
    match palpate::segment::find_phases(&labelled.record.repaired(), &palpate::segment::SegmentOptions::default()) {
        Ok(found) => {
            for hold in found.holds() {
                println!("found [{}, {}] after {:?}", hold.start, hold.end, hold.after);
            }
            println!("{:?}", found.settings);
        }
        Err(error) => println!("{error}"),
    }
}

/// Records by number.
type Source = fn(u64) -> suite::Labelled;

fn main() {
    let argument = |place: usize, usual: u64| -> u64 {
        std::env::args().nth(place).and_then(|text| text.parse().ok()).unwrap_or(usual)
    };
    let (count, first) = (argument(1, 1000), argument(2, 0));
    let each = std::env::args().nth(3).is_some();
    if count == 1 {
        return one(&if each { quirks::quirky(first) } else { suite::labelled(first) });
    }
    let suites: [(Source, bool, &str); 3] = [
        (suite::labelled, false, "Displacement and force"),
        (quirks::quirky, false, "Machines with quirks"),
        (suite::labelled, true, "Force alone"),
    ];
    for (source, force_only, title) in suites {
        let mut all: Vec<Scored> = Vec::new();
        for parameter in first..first + count {
            let labelled = source(parameter);
            let scored = scored(&labelled, force_only);
            let (score, worst) = (&scored.score, |errors: &[f64]| score::quantile(errors, 1.0).unwrap_or(0.0));
            let off = worst(&score.sharp[0]).max(worst(&score.sharp[1]));
            if each && (score.found < score.holds || score.extra > 0 || score.turned > 0 || off > 4.0) {
                println!(
                    "{parameter}: {} noise {} samples {}: {} of {}, {} extra ({} not marked), {} turned, off {off}",
                    scored.kind.name(),
                    scored.noise,
                    labelled.record.len(),
                    score.found,
                    score.holds,
                    score.extra,
                    score.unmarked,
                    score.turned
                );
            }
            all.push(scored);
        }
        println!("## {title}\n\n{}", table(&rows(&all)));
    }
}
