//! How 95 % intervals do where a hold ends before the body has relaxed; prints one JSON object a parameter (read by
//! `validation/short_holds.py`).
//!
//! Run it with `cargo run --release -p palpate --example short_holds [holds] [samples] [curvature]`.

#[path = "../tests/common/noises.rs"]
mod noises;

use std::time::Instant;

use noises::{KINDS, Known, laws, truth_over};
use palpate::fit::{IntervalMethod, LawOptions, Samples, fit_law};
use palpate::test_problems::Rng;

/// Durations of the holds, s: times of the laws are 0.3 to 3 s.
const DURATIONS: [f64; 6] = [0.3, 1.0, 2.0, 3.0, 4.0, 10.0];

/// Times of predictions, in durations of the hold.
const AHEAD: [f64; 2] = [1.5, 5.0];

/// Standard deviations of the noise; the drop is 1.
const SIZES: [f64; 3] = [1e-2, 1e-3, 1e-4];

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let number = |place: usize, usual: usize| words.get(place).and_then(|word| word.parse().ok()).unwrap_or(usual);
    let (holds, samples) = (number(0, 300), number(1, 400));
    let is_curvature = words.iter().any(|word| word == "curvature");
    let intervals = if is_curvature { IntervalMethod::Curvature } else { IntervalMethod::Automatic };
    for size in SIZES {
        for duration in DURATIONS {
            for known in laws() {
                report(&known, duration, size, (holds, samples), intervals);
            }
        }
    }
}

fn report(known: &Known, duration: f64, size: f64, (holds, samples): (usize, usize), intervals: IntervalMethod) {
    let white = KINDS[0].1;
    let (times, clean) = truth_over(duration, known, white, samples);
    let mut found: Vec<Vec<(f64, f64)>> = vec![Vec::new(); known.truth.len()];
    let options = LawOptions {
        intervals,
        ..LawOptions::default()
    };
    let (mut profiles, mut seconds) = (0, 0.0);
    let ahead = AHEAD.map(|ahead| ahead * duration);
    let later = ahead.map(|time| truth_over(time, known, white, 2).1[1]);
    let (mut predictions, mut predicted) = (0, [0; 2]);
    for hold in 0..holds {
        let values = white.added(&times, &clean, size, &mut Rng::new(41 + ((hold as u64) << 20)));
        let begin = Instant::now();
        let fit = fit_law(&Samples::new(&times, &values), known.law, &options);
        seconds += begin.elapsed().as_secs_f64();
        let Ok(fit) = fit else { continue };
        profiles += usize::from(fit.interval_method == IntervalMethod::Profile);
        let bands: Option<Vec<_>> = fit.predict_intervals(&ahead).iter().map(|band| band.interval).collect();
        for (count, ((low, high), truth)) in predicted.iter_mut().zip(bands.iter().flatten().zip(later)) {
            *count += usize::from((*low..=*high).contains(&truth));
        }
        predictions += usize::from(bands.is_some());
        for ((parameter, _), found) in known.truth.iter().zip(&mut found) {
            found.extend(fit.estimate(parameter).and_then(|estimate| estimate.interval));
        }
    }
    for ((parameter, truth), found) in known.truth.iter().zip(&found) {
        let count = |is: &dyn Fn(f64, f64) -> bool| found.iter().filter(|(low, high)| is(*low, *high)).count();
        let (below, above) = (count(&|_, high| high < *truth), count(&|low, _| low > *truth));
        let open = count(&|low, high| low == 0.0 || !(low.is_finite() && high.is_finite()));
        println!(
            "{{\"seconds\":{duration},\"noise\":{size},\"law\":\"{}\",\"parameter\":\"{parameter}\",\"holds\":{holds},\
             \"found\":{},\"profiles\":{profiles},\"below\":{below},\"above\":{above},\"open\":{open},\"predictions\":{predictions},\"predicted\":{predicted:?},\"milliseconds\":{:.3}}}",
            known.name,
            found.len(),
            1e3 * seconds / holds as f64,
        );
    }
}
