//! Analyses a whole record: phases, laws per hold, and what the holds say together.

use palpate::analysis::{AnalysisOptions, Geometry, analyze};
use palpate::contact::{Equilibrium, Shape, Sides};
use palpate::record::Record;
use palpate::simulate::{Sampling, Separation, simulate};
use palpate::test_problems::{Rng, paper_ball, paper_test_b};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // A record as a machine would write it: the paper's test (b) with 0.02 N of noise.
    let series = simulate(&paper_test_b(), &paper_ball(Separation::Bonded), &Sampling::Rate(50.0))?;
    let mut noise = Rng::new(3);
    let force = series.force.iter().map(|force| force + 0.02 * noise.normal()).collect();
    let record = Record::new(series.time, Some(series.displacement), force)?;

    let options = AnalysisOptions {
        geometry: Some(Geometry {
            shape: Shape::Ball { radius: 0.035 },
            sides: Sides::Two,
            modulus: Some(28e3),
            equilibrium: Equilibrium::UniformStrain,
        }),
        separation: Separation::Bonded,
        ..AnalysisOptions::default()
    };
    let analysis = analyze(&record, &options)?;
    for hold in &analysis.holds {
        let after = hold.after.map_or(String::new(), |after| format!("{after:?}"));
        print!("hold {} after {after:9} {:6.2} to {:6.2} s", hold.number, hold.start, hold.end);
        match hold.fit_with(5.0) {
            Some(fit) => {
                println!("  ε_e = {:.4}  v = {:.0} 1/s", fit.equilibrium().value, fit.rate_coefficient().value);
            }
            None => println!("  not fitted"),
        }
    }
    println!("common exponent: {:?}", analysis.across.common_exponent);
    Ok(())
}
