//! Many laboratories with the paper's instrument: which conclusions they draw, and how often.
//!
//! | file | what |
//! |---|---|
//! | `ball.rs` | the balls that are measured, and what is true of them |
//! | `bench.rs` | one laboratory: readings, fits, conclusions |

mod ball;
mod bench;

pub use ball::Ball;

use serde::Serialize;

use crate::parallel::for_each;
use crate::statistics::{median, normal_factor};
use crate::watch::{Progress, Watch};

use super::published::STEPS;
use super::{PaperError, Published};
use bench::{Bench, Drawn};

/// Orders that a laboratory tries: the odd ones, as the paper does.
pub const ORDERS: [f64; 5] = [1.0, 3.0, 5.0, 7.0, 9.0];
/// Largest number of seeds.
pub const MOST_SEEDS: usize = 100_000;
/// Largest sampling rate, Hz.
pub const HIGHEST_RATE: f64 = 1e4;
/// Samples that a hold needs for its fits.
const LEAST_SAMPLES: usize = 20;
/// Laboratories between two reports.
const AT_ONCE: usize = 16;

/// How many laboratories, and how fast they sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LaboratoryOptions {
    /// Laboratories for each ball: one seed each.
    pub seeds: usize,
    /// Sampling rate, Hz. The paper does not state its own.
    pub sample_rate: f64,
    /// Error of a reading of the force that is not shared by its neighbours, N, at most, where the accuracy is that of the zero
    /// ([`Readings::Repeatable`]). The paper calls it “high repeatability” without a number.
    pub repeatability: f64,
}

impl Default for LaboratoryOptions {
    fn default() -> Self {
        Self {
            seeds: 32,
            sample_rate: 50.0,
            repeatability: 0.02,
        }
    }
}

impl LaboratoryOptions {
    fn check(&self, paper: &Published) -> Result<(), PaperError> {
        if !(1..=MOST_SEEDS).contains(&self.seeds) {
            return Err(PaperError::Seeds {
                found: self.seeds,
                most: MOST_SEEDS,
            });
        }
        let (found, least) = (self.sample_rate, LEAST_SAMPLES as f64 / paper.hold);
        if !(found >= least && found.is_finite()) {
            return Err(PaperError::SampleRate {
                found,
                least,
                samples: LEAST_SAMPLES,
            });
        }
        if found > HIGHEST_RATE {
            return Err(PaperError::SampleRateTooHigh {
                found,
                most: HIGHEST_RATE,
            });
        }
        if !(0.0..=paper.force_accuracy).contains(&self.repeatability) {
            return Err(PaperError::Repeatability {
                found: self.repeatability,
                most: paper.force_accuracy,
            });
        }
        Ok(())
    }
}

/// A conclusion of the paper that a laboratory draws or does not draw.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Conclusion {
    /// n = 5 is the lowest odd order that fits best: the sum of the information criteria of all ten holds is within 2 of the lowest, and at no
    /// lower order.
    OrderFive,
    /// v falls from each step of test (a) to the next, with n = 5.
    FallingCoefficient,
    /// At 5, 10, 15 and 20 mm, ε_e of test (a) and of test (b) with n = 5 differ by less than the load cell's accuracy amounts to in strain.
    EqualEquilibria,
}

impl Conclusion {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::OrderFive, Self::FallingCoefficient, Self::EqualEquilibria];

    /// As people read it.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::OrderFive => "n = 5 is the lowest order that fits best",
            Self::FallingCoefficient => "v falls from step to step",
            Self::EqualEquilibria => "εₑ agrees between loading and unloading",
        }
    }
}

/// What the accuracy of force and displacement that the paper states means for readings.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Readings {
    /// Every reading is off by an error of its own.
    Independent,
    /// All readings of a test are off by one error, that of the zero, and each by a further one of its own within the repeatability.
    Repeatable,
}

impl Readings {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Independent, Self::Repeatable];

    /// As people read it.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Independent => "independent errors",
            Self::Repeatable => "one error a test",
        }
    }
}

/// How the law is fitted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Method {
    /// Strain rate against strain, as in the paper: equations (9) and (10).
    Rates,
    /// The closed form against time: equations (4) and (5).
    Time,
}

/// A number of laboratories among all of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Share {
    /// Those that drew the conclusion.
    pub drawn: usize,
    /// All.
    pub of: usize,
}

impl Share {
    /// The share, from 0 to 1.
    #[must_use]
    pub fn value(self) -> f64 {
        self.drawn as f64 / self.of as f64
    }

    /// The 95 % interval of the probability behind it (Wilson 1927).
    ///
    /// ```
    /// use palpate::paper::Share;
    /// // SciPy: binomtest(29, 32).proportion_ci(method="wilson")
    /// let (low, high) = Share { drawn: 29, of: 32 }.interval();
    /// assert!((low - 0.757_818_452_7).abs() < 1e-9 && (high - 0.967_598_448_7).abs() < 1e-9);
    /// ```
    #[must_use]
    pub fn interval(self) -> (f64, f64) {
        let z = normal_factor(0.95);
        let (n, p) = (self.of as f64, self.value());
        let middle = (p + z * z / (2.0 * n)) / (1.0 + z * z / n);
        let half = z / (1.0 + z * z / n) * (p * (1.0 - p) / n + z * z / (4.0 * n * n)).sqrt();
        ((middle - half).max(0.0), (middle + half).min(1.0))
    }
}

/// What the laboratories with one ball and one kind of readings conclude.
#[derive(Debug, Clone, PartialEq)]
pub struct Laboratories {
    /// The ball that they measured.
    pub ball: Ball,
    /// How their readings are off.
    pub readings: Readings,
    /// How they fitted.
    pub method: Method,
    /// How many drew each conclusion, in the order of [`Conclusion::ALL`].
    pub conclusions: [Share; 3],
    /// How many chose each of the [`ORDERS`].
    pub orders: [usize; ORDERS.len()],
    /// Median of v over the laboratories at each step of test (a), 1/s, n = 5; `None` where no fit was possible.
    pub coefficients: [Option<f64>; STEPS],
}

impl Laboratories {
    /// How many drew a conclusion.
    #[must_use]
    pub fn share(&self, conclusion: Conclusion) -> Share {
        self.conclusions[conclusion as usize]
    }
}

/// Simulates laboratories that measure each of the [balls](Ball::ALL) with the paper's instrument, and lets them conclude.
///
/// Readings of force and displacement are off by random errors, uniform within the accuracy that the paper states: independent from sample to
/// sample, or one a test with a rest within the repeatability ([`Readings`]); the motion and the limits of the holds are known. Strain and
/// strain rate follow equations (8) and (9), the latter by [`strain_rates`](crate::strain::strain_rates). The same seeds are drawn for every
/// ball.
///
/// # Errors
/// [`PaperError`] for options that are out of range, numbers that make no body, and a watch that ends it.
pub fn laboratories(
    paper: &Published,
    options: &LaboratoryOptions,
    watch: &mut dyn Watch,
) -> Result<Vec<Laboratories>, PaperError> {
    options.check(paper)?;
    let kinds = Ball::ALL.len() * Readings::ALL.len();
    let mut all = Vec::with_capacity(2 * kinds);
    for ball in Ball::ALL {
        let bench = Bench::new(paper, ball, options)?;
        for readings in Readings::ALL {
            let mut found: Vec<[Drawn; 2]> = Vec::with_capacity(options.seeds);
            for first in (0..options.seeds).step_by(AT_ONCE) {
                let done = all.len() / 2 * options.seeds + first;
                watch.report(Progress::counted("simulating laboratories", done, options.seeds * kinds))?;
                let count = AT_ONCE.min(options.seeds - first);
                found.extend(for_each(count, |seed| bench.measured(readings, (first + seed) as u64)));
            }
            all.extend([Method::Rates, Method::Time].map(|method| summed_up(ball, readings, method, &found)));
        }
    }
    Ok(all)
}

fn summed_up(ball: Ball, readings: Readings, method: Method, found: &[[Drawn; 2]]) -> Laboratories {
    let drawn = || found.iter().map(|both| &both[method as usize]);
    let of = found.len();
    let share = |conclusion: Conclusion| Share {
        drawn: drawn().filter(|drawn| drawn.conclusions[conclusion as usize]).count(),
        of,
    };
    Laboratories {
        ball,
        readings,
        method,
        conclusions: Conclusion::ALL.map(share),
        orders: std::array::from_fn(|order| drawn().filter(|drawn| drawn.order == Some(order)).count()),
        coefficients: std::array::from_fn(|step| {
            let mut found: Vec<f64> = drawn().filter_map(|drawn| drawn.coefficients[step]).collect();
            (!found.is_empty()).then(|| median(&mut found))
        }),
    }
}
