//! Shows how the strain travels from the contact to the middle of the ball.

use palpate::simulate::{Sampling, Separation, strain_wave};
use palpate::test_problems::{paper_ball, paper_test_a};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let times = vec![0.3, 0.6, 1.0, 3.0, 10.0];
    let wave = strain_wave(&paper_test_a(), &paper_ball(Separation::Bonded), &Sampling::Times(times))?;
    print!("layer ");
    for time in &wave.time {
        print!("{time:9.1} s");
    }
    println!();
    for (i, strain) in wave.strain.iter().enumerate() {
        print!("{:5} ", i + 1);
        for value in strain {
            print!("{value:11.5}");
        }
        println!();
    }
    Ok(())
}
