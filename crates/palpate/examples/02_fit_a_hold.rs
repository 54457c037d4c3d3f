//! Fits the law to a noisy hold: exponents given, exponent free, and which one the data ask for.

use palpate::fit::{ExponentChoice, FitOptions, fit_hold, select_order};
use palpate::test_problems::noisy_hold;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // n = 5, 1000 samples over 10 s, noise of half a percent of the drop.
    let (times, strains) = noisy_hold(1000, 5.0, 5e-3);
    let choices = [1.0, 3.0, 5.0, 7.0].map(ExponentChoice::Fixed).into_iter().chain([ExponentChoice::Free]);
    let fits = choices
        .map(|choice| fit_hold(&times, &strains, choice, &FitOptions::default()))
        .collect::<Result<Vec<_>, _>>()?;
    let order = select_order(&fits);
    println!("    n   equilibrium strain       v (1/s)      RMSE   ΔBIC");
    for (fit, candidate) in fits.iter().zip(&order.candidates) {
        println!(
            "{:5.2} {:12.5} ± {:.5} {:13.0} {:9.6} {:6.1}",
            fit.exponent().value,
            fit.equilibrium().value,
            fit.equilibrium().standard_error.unwrap_or(f64::NAN),
            fit.rate_coefficient().value,
            fit.rmse,
            candidate.delta_bic
        );
    }
    let lowest = order.lowest_order.map(|i| fits[i].exponent().value);
    println!("lowest order that fits best: {lowest:?}");
    Ok(())
}
