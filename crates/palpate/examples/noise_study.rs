//! How 95 % intervals do under noise of many kinds; prints one JSON object a parameter (read by `validation/noise_kinds.py`).
//!
//! Run it with `cargo run --release -p palpate --example noise_study [holds] [samples] [kind …]`.

#[path = "../tests/common/noises.rs"]
mod noises;

use std::time::Instant;

use noises::{KINDS, Known, Noise, laws, truth_over};
use palpate::fit::{LawOptions, Samples, fit_law};
use palpate::test_problems::Rng;

/// Standard deviation of the noise; the drop is 1.
const SIZE: f64 = 3e-3;

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let number = |place: usize, usual: usize| words.get(place).and_then(|word| word.parse().ok()).unwrap_or(usual);
    let (holds, samples) = (number(0, 300), number(1, 400));
    for (name, noise) in KINDS.iter().filter(|(name, _)| words.len() < 3 || words[2..].iter().any(|word| word == name))
    {
        for known in laws() {
            report(name, *noise, &known, holds, samples);
        }
    }
}

fn report(name: &str, noise: Noise, known: &Known, holds: usize, samples: usize) {
    let mut found: Vec<Vec<[f64; 3]>> = vec![Vec::new(); known.truth.len()];
    let mut seconds = 0.0;
    let (times, clean) = truth_over(10.0, known, noise, samples);
    for hold in 0..holds {
        let mut random = Rng::new(77 + ((hold as u64) << 20));
        let values = noise.added(&times, &clean, SIZE, &mut random);
        let begin = Instant::now();
        let fit = fit_law(&Samples::new(&times, &values), known.law, &LawOptions::default());
        seconds += begin.elapsed().as_secs_f64();
        let Ok(fit) = fit else { continue };
        for ((parameter, _), found) in known.truth.iter().zip(&mut found) {
            if let Some((value, (low, high))) = fit.estimate(parameter).and_then(|one| Some((one.value, one.interval?)))
            {
                found.push([value, low, high]);
            }
        }
    }
    for ((parameter, truth), found) in known.truth.iter().zip(&found) {
        let covered = found.iter().filter(|[_, low, high]| low <= truth && truth <= high).count();
        let sorted = |of: &dyn Fn(&[f64; 3]) -> f64| {
            let mut all: Vec<f64> = found.iter().map(of).collect();
            all.sort_by(f64::total_cmp);
            all
        };
        let (values, widths) = (sorted(&|found| found[0]), sorted(&|found| found[2] - found[1]));
        let at = |all: &[f64], share: f64| all[((all.len() - 1) as f64 * share) as usize];
        // An interval that knows the spread of the estimates is 2 · 1.96 standard deviations wide.
        let right = 1.96 * (at(&values, 0.841) - at(&values, 0.159));
        println!(
            "{{\"noise\":\"{name}\",\"law\":\"{}\",\"parameter\":\"{parameter}\",\"holds\":{holds},\"samples\":{samples},\
             \"found\":{},\"covered\":{covered},\"width\":{},\"milliseconds\":{:.3}}}",
            known.name,
            found.len(),
            // Most of them may be open.
            Some(at(&widths, 0.5) / right)
                .filter(|width| width.is_finite())
                .map_or("null".to_owned(), |width| format!("{width:.3}")),
            1e3 * seconds / holds as f64,
        );
    }
}
