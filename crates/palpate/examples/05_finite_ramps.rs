//! One stretch of cardiac muscle at four ramp times: fitted as if each ramp were a step, and with the ramp known.
//!
//! Reads `titin-ramps/AvgRelaxed_{0.1,1,10,100}s.csv` in the folder that `PALPATE_DATA` names.

#[path = "../tests/common/titin.rs"]
mod titin;

use palpate::fit::{LawOptions, fit_law};
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
    Ok(())
}

/// The parameters from every ramp, and how far each set is from the holds after all four.
fn print_law(law: &str, (name, loadings): &Way, records: &[Record]) -> Result<(), Box<dyn std::error::Error>> {
    println!("{law}, loading {name}");
    for (record, loading) in records.iter().zip(loadings) {
        let options = LawOptions {
            loading: loading.clone(),
            ..LawOptions::default()
        };
        let fit = fit_law(&record.samples(), law.parse()?, &options)?;
        print!("{:>7} s", record.ramp);
        for parameter in &fit.parameters {
            print!("  {} {:.3}", parameter.name, parameter.estimate.value);
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
