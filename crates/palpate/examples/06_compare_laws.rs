//! Which law to use: every law fitted to the first part of a hold and held against the rest.

use palpate::fit::{LawOptions, Samples, fit_law, profile_interval};
use palpate::forecast::{CompareOptions, compare_laws};
use palpate::laws::Law;
use palpate::test_problems::noisy_hold;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // A hold of 10 s that the latency law with n = 4.3 made, with noise of a thousandth.
    let (times, values) = noisy_hold(2000, 4.3, 1e-3);
    let samples = Samples::new(&times, &values);
    let comparison = compare_laws(&samples, &CompareOptions::default())?;
    println!("{:<24} {:>7}  {:>7}  {:>9}", "law", "parameters", "score", "delta BIC");
    for row in &comparison.rows {
        let score = row.forward.score.map_or("-".to_owned(), |score| format!("{:.2} %", 100.0 * score));
        let delta = row.delta_bic.map_or("-".to_owned(), |delta| format!("{delta:.1}"));
        println!("{:<24} {:>7.1}  {score:>7}  {delta:>9}", row.law.to_string(), row.effective_parameters);
    }
    println!("\n{}\n", comparison.sentence().unwrap_or_default());

    // Its parameters, with the interval of the curvature and that of the likelihood.
    let law: Law = "latency".parse()?;
    let options = LawOptions::default();
    let fit = fit_law(&samples, law, &options)?;
    for name in ["equilibrium", "exponent"] {
        let estimate = fit.estimate(name).ok_or("no such parameter")?;
        let profile = profile_interval(&samples, law, &options, name)?;
        println!(
            "{name}: {:.4}, {:?}, profile {:?} to {:?}",
            estimate.value, estimate.interval, profile.low, profile.high
        );
    }
    let later = fit.predict_interval(60.0);
    println!("a minute after the start: {:.4}, {:?}", later.value, later.interval);
    Ok(())
}
