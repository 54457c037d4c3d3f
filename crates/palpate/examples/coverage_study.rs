//! How often the 95 % intervals of fits contain the truth; prints one JSON object a number (read by `validation/coverage.py`).
//!
//! Run it with `cargo run --release -p palpate --example coverage_study [repetitions]`.

#[path = "../tests/common/coverage.rs"]
mod coverage;

use std::time::Instant;

use coverage::{Tally, cases, tally};

fn main() {
    let repetitions: u64 = std::env::args().nth(1).and_then(|text| text.parse().ok()).unwrap_or(1000);
    for case in cases() {
        let start = Instant::now();
        let half = repetitions / 2;
        let (first, second) = std::thread::scope(|scope| {
            let first = scope.spawn(|| tally(&case, 0..half));
            let second = tally(&case, half..repetitions);
            (first.join().expect("the first half"), second)
        });
        let each = start.elapsed().as_secs_f64() / repetitions as f64;
        for (((name, _), a), b) in case.truth.iter().zip(first).zip(second) {
            let sum = |part: fn(&Tally) -> usize| part(&a) + part(&b);
            println!(
                "{{\"case\":\"{}\",\"noise\":{},\"number\":\"{name}\",\"repetitions\":{repetitions},\"covered\":{},\
                 \"below\":{},\"above\":{},\"white\":{},\"open\":{},\"relative_width\":{:.3e},\"seconds\":{each:.2e}}}",
                case.name,
                case.correlation,
                sum(|tally| tally.covered),
                sum(|tally| tally.below),
                sum(|tally| tally.above),
                sum(|tally| tally.naive),
                sum(|tally| tally.open),
                (a.width + b.width) / repetitions as f64,
            );
        }
    }
}
