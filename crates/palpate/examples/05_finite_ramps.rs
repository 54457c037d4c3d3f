//! One stretch of cardiac muscle at four ramp times: fitted as if each ramp were a step, and with the ramp known.
//!
//! Reads `titin-ramps/AvgRelaxed_{0.1,1,10,100}s.csv` in the folder that `PALPATE_DATA` names.

#[path = "../tests/common/titin.rs"]
mod titin;

use palpate::fit::{EquilibriumChoice, ExponentChoice, FitOptions, LawOptions, RampHold, fit_law, fit_ramps};
use palpate::laws::Loading;
use titin::{Record, records};

/// How the loading is understood: a name, and the loading of every record if it is known.
type Way = (&'static str, Vec<Option<Loading>>);

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let Some(records) = records() else { return Ok(()) };
    let slowest = &records[3];
    let ways: [Way; 3] = [
        ("a step", vec![None; 4]),
        ("by length", records.iter().map(|record| Some(record.by_length())).collect()),
        ("by elastic force", records.iter().map(|record| Some(record.by_elastic_force(slowest))).collect()),
    ];
    for law in ["standard-linear-solid", "prony:2", "stretched", "fractional-zener", "power"] {
        for way in &ways {
            print_law(law, way, &records)?;
        }
    }
    for (name, loadings) in &ways[1..] {
        print_latency(name, loadings, &records)?;
    }
    Ok(())
}

/// The numbers from every ramp, and how far each set is from the holds after all four.
fn print_law(law: &str, (name, loadings): &Way, records: &[Record]) -> Result<(), Box<dyn std::error::Error>> {
    println!("{law}, loading {name}");
    for (record, loading) in records.iter().zip(loadings) {
        let options = LawOptions {
            loading: loading.clone(),
            ..LawOptions::default()
        };
        let fit = fit_law(&record.samples(), law.parse()?, &options)?;
        print!("{:>7} s", record.ramp);
        for number in &fit.parameters {
            print!("  {} {:.3}", number.name, number.estimate.value);
        }
        print!("  0.01 s after a step {:.2}  off", fit.curve.at(0.01));
        for (other, loading) in records.iter().zip(loadings) {
            let predicted = match loading {
                None => fit.curve.values(&other.hold[0]),
                Some(loading) => fit.curve.after(loading, &other.hold[0]),
            };
            print!(" {:.3}", other.distance(&predicted));
        }
        println!("  {:?}", fit.termination);
    }
    Ok(())
}

/// The latency law of all four holds together.
fn print_latency(
    name: &str,
    loadings: &[Option<Loading>],
    records: &[Record],
) -> Result<(), Box<dyn std::error::Error>> {
    let known = records.iter().zip(loadings.iter().flatten());
    let holds: Vec<RampHold<'_>> = known
        .map(|(record, loading)| RampHold {
            loading,
            samples: record.samples(),
        })
        .collect();
    let fit = fit_ramps(&holds, ExponentChoice::Free, EquilibriumChoice::Each, &FitOptions::default())?;
    let error = |estimate: palpate::fit::Estimate| estimate.standard_error.unwrap_or(f64::NAN);
    println!("latency, loading {name}: {:?}", fit.termination);
    println!("  n {:.2} ± {:.2}", fit.exponent.value, error(fit.exponent));
    println!("  amplitude of a step {:.2} ± {:.2}", fit.step_amplitude.value, error(fit.step_amplitude));
    println!("  relative rate after a step {:.1} ± {:.1} 1/s", fit.step_rate.value, error(fit.step_rate));
    for ((record, hold), numbers) in records.iter().zip(&holds).zip(&fit.holds) {
        let predicted: Vec<f64> =
            record.hold[0].iter().map(|elapsed| fit.excess_after(hold.loading, *elapsed)).collect();
        let (equilibrium, amplitude) = (numbers.equilibrium.value, numbers.amplitude.value);
        let off = record.distance(&predicted);
        println!("{:>7} s  equilibrium {equilibrium:.2}  amplitude {amplitude:.2}  off {off:.3}", record.ramp);
    }
    Ok(())
}
