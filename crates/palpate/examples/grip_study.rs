//! How often grips hold that are stated to hold, and how often those of a stated probability do; prints a table in Markdown.
//!
//! The paper's ball, calibrated on the paper's test (a) as its machine would have recorded it (20 Hz, 0.2 N, 1 µm, standard deviations) or on
//! another noise, with questions: does this squeeze hold this load so long? and: what is the least squeeze that does? The truth is the simulation
//! with the true parameters. Run it with `cargo run --release -p palpate --example grip_study [records]`.

#[path = "calibration_study/instrument.rs"]
mod instrument;

use instrument::{Force, Instrument};
use palpate::calibrate::{Candidate, EquilibriumLaw, calibrate};
use palpate::grip::{Grasp, Grip, Limits, Objective, Plan, Question};
use palpate::simulate::{Separation, step_ends};
use palpate::test_problems::{PAPER_RATE, Rng, paper_ball, paper_test_a};
use palpate::watch::Unwatched;

/// Questions to every calibration.
const QUESTIONS: usize = 4;

/// Edges of the classes of probability.
const EDGES: [f64; 7] = [0.0, 0.05, 0.25, 0.5, 0.75, 0.95, 1.000_001];

#[derive(Default)]
struct Counts {
    /// Of each class: questions, those that hold, and the sum of the probabilities.
    classes: [(u32, u32, f64); 6],
    /// Questions with Yes, and those that hold; the same by the best estimate.
    yes: (u32, u32),
    best: (u32, u32),
    /// Least squeezes that were found, and those that hold.
    least: (u32, u32),
    least_best: (u32, u32),
}

fn main() {
    let records: u64 = std::env::args().nth(1).and_then(|text| text.parse().ok()).unwrap_or(200);
    println!("| noise | answer | answers | hold | mean probability |\n|---|---|--:|--:|--:|");
    for (name, force) in [("white", Force::White), ("AR(1) 0.9", Force::Autoregressive(0.9))] {
        let halves = std::thread::scope(|scope| {
            let halves = [0..records / 2, records / 2..records];
            let work = halves.map(|seeds| scope.spawn(move || counted(force, seeds)));
            work.map(|half| half.join().expect("a half"))
        });
        report(name, &halves);
    }
}

fn report(noise: &str, halves: &[Counts; 2]) {
    let [a, b] = halves;
    let line = |answer: &str, (all, hold): (u32, u32), mean: f64| {
        if all > 0 {
            let share = 100.0 * f64::from(hold) / f64::from(all);
            let mean = if mean.is_finite() { format!("{:.0} %", 100.0 * mean) } else { String::new() };
            println!("| {noise} | {answer} | {all} | {share:.0} % | {mean} |");
        }
    };
    let both = |of: fn(&Counts) -> (u32, u32)| (of(a).0 + of(b).0, of(a).1 + of(b).1);
    line("Yes", both(|counts| counts.yes), f64::NAN);
    line("Yes by the best estimate", both(|counts| counts.best), f64::NAN);
    line("least squeeze", both(|counts| counts.least), f64::NAN);
    line("least squeeze by the best estimate", both(|counts| counts.least_best), f64::NAN);
    for (class, edges) in EDGES.windows(2).enumerate() {
        let (a, b) = (a.classes[class], b.classes[class]);
        let title = format!("stated {:.0} to {:.0} %", 100.0 * edges[0], 100.0 * edges[1]);
        line(&title, (a.0 + b.0, a.1 + b.1), (a.2 + b.2) / f64::from(a.0 + b.0));
    }
}

fn counted(force: Force, seeds: std::ops::Range<u64>) -> Counts {
    let mut counts = Counts::default();
    let truth = paper_ball(Separation::Unilateral);
    let candidate = Candidate::new("latency".parse().expect("a law"), EquilibriumLaw::UniformStrain);
    for seed in seeds {
        let instrument = Instrument {
            force,
            ..Instrument::default()
        };
        let found = calibrate(&instrument.record(&paper_test_a(), seed), candidate, 0.95, &mut Unwatched);
        let material = found.expect("a calibration").material;
        let mut random = Rng::new(seed + 90_001);
        for question_number in 0..QUESTIONS {
            let mut uniform = |low: f64, high: f64| low + (high - low) * random.uniform();
            let load = Grasp::new(uniform(0.1, 0.4), 0.6).expect("a load");
            let duration = uniform(2f64.ln(), 300f64.ln()).exp();
            let grip = Grip::new(&material, load, Limits::new(PAPER_RATE).expect("limits"), 0.95).expect("a grip");
            let holds = |plan: &Plan| {
                let ends = step_ends(&plan.held(duration), &truth).expect("a simulation");
                let end = ends[ends.len() - 1];
                end.force >= grip.needed_force(end.displacement)
            };
            // About the squeeze that truly just holds: questions without doubt say little.
            let (mut slips, mut enough) = (1e-3, 15e-3);
            for _ in 0..40 {
                let middle = 0.5 * (slips + enough);
                if holds(&Plan::squeeze(middle, PAPER_RATE)) { enough = middle } else { slips = middle }
            }
            let squeeze = enough * (1.0 + uniform(-0.02, 0.02));
            let plan = Plan::squeeze(squeeze, PAPER_RATE);
            let probability = grip.probability(&plan, duration).expect("a simulation").expect("intervals");
            let class = EDGES.partition_point(|edge| *edge <= probability) - 1;
            let is_holding = u32::from(holds(&plan));
            let count = &mut counts.classes[class];
            *count = (count.0 + 1, count.1 + is_holding, count.2 + probability);
            if probability >= Question::CONFIDENCE {
                counts.yes = (counts.yes.0 + 1, counts.yes.1 + is_holding);
            }
            if grip.position_hold(&plan).expect("a hold").time_to_slip.covers(duration) {
                counts.best = (counts.best.0 + 1, counts.best.1 + is_holding);
            }
            // A search takes long: one a record.
            if question_number == 0 {
                let least = |level| grip.least(Objective::Squeeze, duration, level).expect("a squeeze");
                let (sure, best) = (least(Some(0.95)), least(None));
                counts.least = (counts.least.0 + 1, counts.least.1 + u32::from(holds(&sure.plan)));
                counts.least_best = (counts.least_best.0 + 1, counts.least_best.1 + u32::from(holds(&best.plan)));
            }
        }
    }
    counts
}
