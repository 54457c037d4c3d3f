//! How often the 95 % intervals of fits contain the truth; prints one JSON object a parameter (read by `validation/interval_coverage.py`).
//!
//! Run it with `cargo run --release -p palpate --example coverage_study [repetitions] [repetitions of the slow methods]`.

#[path = "../tests/common/coverage.rs"]
mod coverage;

use std::time::Instant;

use coverage::{Case, Method, Tally, cases, tally};

fn main() {
    let repetitions = |place: usize, usual: u64| -> u64 {
        std::env::args().nth(place).and_then(|text| text.parse().ok()).unwrap_or(usual)
    };
    let (many, few) = (repetitions(1, 1000), repetitions(2, 300));
    for (method, holds) in [(Method::Curvature, many), (Method::Profile, few), (Method::Bootstrap, few)] {
        for case in cases() {
            report(&case, method, holds);
        }
    }
}

fn report(case: &Case, method: Method, holds: u64) {
    let start = Instant::now();
    let (first, second) = std::thread::scope(|scope| {
        let first = scope.spawn(|| tally(case, method, 0..holds / 2));
        let second = tally(case, method, holds / 2..holds);
        (first.join().expect("the first half"), second)
    });
    let each = 2.0 * start.elapsed().as_secs_f64() / holds as f64;
    for (((name, _), a), b) in case.truth.iter().zip(first).zip(second) {
        let sum = |part: fn(&Tally) -> usize| part(&a) + part(&b);
        // Parameters that follow from others have no profile.
        if sum(|tally| tally.open) as u64 == holds {
            continue;
        }
        let counts = [
            ("covered", sum(|tally| tally.covered)),
            ("below", sum(|tally| tally.below)),
            ("above", sum(|tally| tally.above)),
            ("by_error", sum(|tally| tally.by_error)),
            ("by_white_error", sum(|tally| tally.by_white_error)),
            ("open", sum(|tally| tally.open)),
        ];
        let counts = counts.map(|(what, count)| format!("\"{what}\":{count}")).join(",");
        println!(
            "{{\"method\":\"{method:?}\",\"case\":\"{}\",\"noise\":{},\"parameter\":\"{name}\",\"holds\":{holds},{counts},\
             \"relative_width\":{:.3e},\"seconds_a_hold\":{each:.2e}}}",
            case.name,
            case.correlation,
            (a.width + b.width) / holds as f64,
        );
    }
}
